"""model.yaml: what the nodes read is the network, and moves as the network does."""

from __future__ import annotations

import random
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any, Dict, List, Optional, Tuple

import pytest
import yaml

from pursue_gen.language import load, parse
from pursue_gen.tga import ends_reported, scenario_objective, translate
from pursue_gen.tga.event_words import event_word
from pursue_gen.tga.network import Edge, Network
from pursue_gen.workspace.model_file import render
from pursue_runtime.model import Model

THESIS = Path(__file__).resolve().parents[2] / "scenarios" / "thesis"
SCENARIOS = ("scenario_1", "scenario_2", "scenario_3", "scenario_4", "catch_the_thief")
MEETING = """
poi "yes" poi "b" poi "c"
connect yes and b distance 2
connect b and c distance 2
event "call" event "answer" duration 3
state "alarm": initially false, true_if call false_if answer
stateDependency: answer only_if alarm is_true
agent "bot" controllable mobile 1 location yes can_do answer
agent "nurse" human controllable mobile 1 location yes
agent "dog" mobile 1 location c can_do call
objective: {}
"""


def network_of(scenario: Any) -> Network:
    return ends_reported(translate(scenario), {})


def model_of(scenario: Any, network: Network) -> Any:
    return Model(yaml.safe_load(render(network, scenario_objective(scenario), scenario, Fraction(1, 10), "0")))


@pytest.mark.parametrize("number", SCENARIOS)
def test_everything_of_the_network_is_in_the_model(number: str) -> None:
    scenario = load(THESIS / f"{number}.pur")
    network = network_of(scenario)
    read = model_of(scenario, network)
    assert read.clocks == network.clocks and read.variables == dict(network.variables)
    for ours, theirs in zip(read.automata, network.automata):
        assert (ours.name, ours.initial) == (theirs.name, theirs.initial)
        assert list(ours.invariants) == [location.name for location in theirs.locations]
        assert [(e.source, e.target, e.word, e.controllable, e.assign, e.resets) for e in ours.edges] == [
            (e.source, e.target, event_word(theirs.name, e), e.controllable, dict(e.assign), e.resets)
            for e in theirs.edges
        ]


def test_kinds_say_who_is_who() -> None:
    scenario = parse(MEETING.format("if call then answer within 20"), "meeting.pur")
    kinds = {a.name: a.kind for a in model_of(scenario, network_of(scenario)).automata}
    assert kinds == {"states": "states", "bot": "robot", "nurse": "human", "dog": "agent", "obj": "safety"}


def test_names_that_yaml_takes_for_something_else_come_back() -> None:
    scenario = parse(MEETING.format("bot never_with dog"), "meeting.pur")
    read = model_of(scenario, network_of(scenario))
    assert read.automaton("bot").initial == "yes"
    assert (read.objective, read.goal, read.bad) == ("safety", (), (("obj", "lose"),))


def test_several_places_need_a_newer_format() -> None:
    scenario = parse(MEETING.format("bot never_with dog"), "meeting.pur")
    network, alone = network_of(scenario), scenario_objective(scenario)
    both = replace(alone, bad=(*alone.bad, ("dog", "b")))
    for objective, newest in ((alone, 1), (both, 2)):
        data = yaml.safe_load(render(network, objective, scenario, Fraction(1, 10), "0"))
        assert data["format"] == newest
        assert Model(data).bad == objective.bad
    assert data["objective"]["bad"] == [["obj", "lose"], ["dog", "b"]]


# The semantics, once more: a naive evaluation of the network's own edges, to hold the model against.

Position = Tuple[Dict[str, str], Dict[str, int], Dict[str, float]]


def enabled(edge: Edge, position: Position) -> bool:
    _, values, clocks = position
    return all(any(values[t.variable] == t.value for t in clause) for clause in edge.guard.integers) and all(
        eval(f"{clocks[b.clock]!r} {b.op} {b.bound}") for b in edge.guard.clocks
    )


def naive_move(network: Network, position: Position, automaton: str, word: str) -> Optional[List[Tuple[str, Edge]]]:
    here = {
        a.name: [e for e in a.edges if e.source == position[0][a.name] and enabled(e, position)]
        for a in network.automata
    }
    movers = [e for e in here[automaton] if event_word(automaton, e) == word and (e.sync is None or e.sync.sends)]
    if not movers:
        return None
    moves = [(automaton, movers[0])]
    if movers[0].sync is not None:
        for other, edges in here.items():
            answers = [e for e in edges if e.sync and not e.sync.sends and e.sync.channel == movers[0].sync.channel]
            if other != automaton and answers:
                moves.append((other, answers[0]))
    resets = {clock for _, edge in moves for clock in edge.resets}
    bounds = [
        bound
        for name, edge in moves
        for location in network.automaton(name).locations
        for bound in location.invariant
        if location.name == edge.target
    ]
    return moves if all(b.clock in resets or position[2][b.clock] <= b.bound for b in bounds) else None


@pytest.mark.parametrize("number", SCENARIOS)
def test_the_model_moves_as_the_network_does(number: str) -> None:
    scenario = load(THESIS / f"{number}.pur")
    network = network_of(scenario)
    read, draw, taken = model_of(scenario, network), random.Random(number), 0
    position = read.initial()
    for _ in range(120):
        passed = draw.choice((0.003, 0.501, 1.503, 3.507, 9.511))  # never on a bound: there the model has a tolerance
        position = position._replace(clocks={clock: value + passed for clock, value in position.clocks.items()})
        options = []
        for automaton in network.automata:
            for word in sorted({event_word(automaton.name, edge) for edge in automaton.edges}):
                moves = read.joint_move(position, word, automaton.name)
                naive = naive_move(network, position, automaton.name, word)
                found = moves and [(name, edge.source, edge.target, edge.word) for name, edge in moves]
                assert (found or None) == (naive and [(n, e.source, e.target, event_word(n, e)) for n, e in naive])
                options += [moves] if moves else []
        if options:
            position, taken = read.after(draw.choice(options), position), taken + 1
    assert taken > 20
