"""Scenarios: read, checked, written as texts, and as games."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Optional, Tuple, Union

from pursue_gen.api.requests import File, default_request
from pursue_gen.diagnostics import Diagnostic, PursueError, usage_error
from pursue_gen.language.scenario import Scenario

if TYPE_CHECKING:
    from pursue_gen.solving.request import SolveRequest
    from pursue_gen.synthesis.limits import Listener
    from pursue_gen.tga.network import Network, Objective

Game = Tuple["Network", "Objective"]
"""A network of timed automata, and what is wanted in it."""


def read(file: File) -> Scenario:
    """The scenario in a file. Raises PursueError with every error; warnings are left to `check`.

    >>> floor = read("scenarios/thesis/scenario_1.pur")
    >>> [agent.name for agent in floor.agents]
    ['bot1', 'bot2']
    """
    from pursue_gen import language

    if Path(file).suffix == ".xml":
        raise usage_error(f"{file} is not a scenario", "only solve and verify take UPPAAL's files")
    return language.load(file)


def parse(text: str, name: str = "scenario") -> Scenario:
    """The scenario in a text; `name` is what it is called, as a file's stem. Raises as `read`.

    >>> try:
    ...     parse('poi "hall" agent "bot" controllable location attic objective: avoid bot at hall', "tiny")
    ... except Invalid as problem:
    ...     print(*((finding.code, finding.message, finding.span.line) for finding in problem.diagnostics))
    ('PML110', 'there is no POI attic', 1)
    """
    from pursue_gen.language import parser

    return sound(parser.parse(text, f"{name}.pur", name))


def check(scenario: Union[Scenario, File]) -> Tuple[Diagnostic, ...]:
    """All errors and warnings of a scenario, or of a file, in the order of the text; never raises.

    >>> check("scenarios/thesis/scenario_1.pur")
    ()
    """
    from pursue_gen.language.parser import Reading
    from pursue_gen.language.parser import read as read_text
    from pursue_gen.language.writer import written
    from pursue_gen.solving.inputs import findings_in, findings_of

    if not isinstance(scenario, Scenario):
        return findings_in(Path(scenario))
    try:
        scenario = written(scenario)
    except PursueError as problem:
        return problem.diagnostics
    found = read_text(scenario.text, scenario.file, scenario.name).diagnostics
    return findings_of(Reading(scenario, found, scenario))


def as_text(scenario: Scenario) -> str:
    """The scenario in PuRSUE-ML: its own text if that says the same as its values, else one that is written anew.

    Raises PursueError where no text can say it.

    >>> print(as_text(Scenario("tiny", pois=(Poi("hall"), Poi("lab")), connections=(Connection("hall", "lab", 2),))))
    poi "hall"
    poi "lab"
    <BLANKLINE>
    connect hall and lab distance 2
    <BLANKLINE>
    """
    from pursue_gen.language.writer import written

    return written(scenario).text


def settle(scenario: Scenario, request: Optional[SolveRequest] = None, progress: Optional[Listener] = None) -> Scenario:
    """The scenario with the least period that can be promised for patrols that name none; `solve` does this first.

    Raises as `solve`.
    """
    from pursue_gen.solving.inputs import settled

    return settled(sound(scenario), request or default_request(), progress)


def game(scenario: Scenario, request: Optional[SolveRequest] = None) -> Game:
    """The network of timed game automata that is played, and its objective, with all that is optional.

    By default the ideal game, as UPPAAL-TIGA plays it: with the rules of the request where there is one.

    >>> network, objective = game(read("scenarios/thesis/scenario_1.pur"))
    >>> [automaton.name for automaton in network.automata]
    ['bot1', 'bot2', 'reachObj', 'rule1']
    """
    from pursue_gen.solving.inputs import game_of
    from pursue_gen.solving.rules import played

    network, objective = game_of(settle(scenario, request))
    return (network if request is None else played(network, request.rules(network))), objective


def as_uppaal(scenario: Scenario, request: Optional[SolveRequest] = None) -> Tuple[str, str]:
    """The `game` as UPPAAL's files: the texts of TGA.xml and of TCTL.q.

    >>> network, query = as_uppaal(read("scenarios/thesis/scenario_1.pur"))
    >>> query.strip()
    'control: A<> reachObj.win'
    """
    from pursue_gen.tga.uppaal import write_network, write_query

    network, objective = game(scenario, request)
    return write_network(network, objective), write_query(objective)


def read_game(*files: File) -> Game:
    """The ideal game of UPPAAL's two files, a network and its query. Raises PursueError."""
    from pursue_gen.solving.inputs import load_game

    return load_game([Path(file) for file in files])


def sound(scenario: Scenario) -> Scenario:
    """The scenario with a text that says the same. Raises PursueError with its errors."""
    from pursue_gen.language.checks import check
    from pursue_gen.language.parser import without_errors
    from pursue_gen.language.writer import written

    scenario = written(scenario)
    return without_errors(scenario, check(scenario))
