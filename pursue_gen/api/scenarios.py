"""Scenarios: read, checked, written as texts, and as games; and what the other functions are asked for: rules of the
game, who commands what, limits."""

from __future__ import annotations

import math
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Iterable, Mapping, Optional, Tuple, Union

from pursue_gen.diagnostics import Diagnostic, PursueError, usage_error
from pursue_gen.language.scenario import Scenario

if TYPE_CHECKING:
    from pursue_gen.solving.request import SolveRequest
    from pursue_gen.synthesis.limits import Listener
    from pursue_gen.tga.network import Network, Objective

File = Union[str, Path]


def request(
    *,
    ends: Optional[str] = None,
    reaction: Union[str, float, Fraction, None] = None,
    slack: Union[Mapping[str, int], Iterable[str]] = (),
    within: Union[str, float, Fraction, None] = None,
    optimize: Optional[str] = None,
    controllers: str = "distributed",
    reach_obj: str = "dedicated",
    plan: Optional[File] = None,
    seconds: Optional[float] = None,
    memory: Optional[int] = None,
    work: int = 0,
    whole: bool = False,
    solver: Optional[str] = None,
    verifytga: Optional[File] = None,
) -> SolveRequest:
    """What `solve`, `simulate` and `write_workspace` are asked for; by default what the commands do by default.

    The game: `ends` "reported" (robots report them) or "controllable" (the original's game), `reaction` (time units:
    how late a command may take effect, 0.1 by default), `slack` (agent → time units: how much later than the model it
    may end). `within`: the goal has to be reached in so many time units; `optimize`: "time" for the least worst-case
    time, "none" for the first strategy found. `controllers` ("distributed", "centralized", "general") and `reach_obj`
    ("dedicated", "all", a robot): who commands what. `plan`: a file with a plan to use instead of solving.

    Limits: `seconds` of processor time (60 by default, 0: none), `memory` of the process in MiB (0: none; by
    default 1024 beside what it holds already, or 80 % of what there is), `work` of a game in one piece (0: no limit):
    the same everywhere.
    `whole`, `solver`, `verifytga`: as the command line has them. Raises PursueError for what has no meaning.

    >>> request(reaction=0.05, slack={"bot1": 2}, seconds=10).slack
    ('bot1=2',)
    """
    from pursue_gen.solving.options import SolveOptions
    from pursue_gen.solving.request import SolveRequest
    from pursue_gen.synthesis.limits import DEFAULT_SECONDS, Limits, careful_memory

    check_words(ends=ends, optimize=optimize, controllers=controllers, solver=solver)
    for name, number in {"seconds": seconds, "memory": memory, "work": work}.items():
        if number is not None and not 0 <= number < math.inf:
            raise usage_error(f"{name} is {number}", "expected a number, 0 for no limit")
    memory = careful_memory() if memory is None else memory
    limits = Limits(DEFAULT_SECONDS, memory, by_default=True) if seconds is None else Limits(seconds, memory)
    path = None if verifytga is None else Path(verifytga)
    how = SolveOptions(limits, optimize=optimize, whole=whole, solver=solver, verifytga=path, most_work=work)
    late = tuple(f"{agent}={units}" for agent, units in slack.items()) if isinstance(slack, Mapping) else tuple(slack)
    times = (None if time is None else str(time) for time in (reaction, within))
    file = None if plan is None else Path(plan)
    return SolveRequest(controllers, reach_obj, ends, next(times), late, next(times), file, how)


_WORDS = {
    "ends": ("reported", "controllable"),
    "optimize": ("time", "none"),
    "controllers": ("distributed", "centralized", "general"),
    "solver": ("verifytga",),
    "opponent": ("random", "worst", "still", "mixed"),
}


def check_words(**values: Optional[str]) -> None:
    """Raises PursueError for what is none of the words that there are."""
    for name, value in values.items():
        if value is not None and value not in _WORDS[name]:
            raise usage_error(f"{name} is {value!r}", f"expected one of {', '.join(_WORDS[name])}")


def default_request() -> SolveRequest:
    """What is asked for where nobody says anything."""
    return request()


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
