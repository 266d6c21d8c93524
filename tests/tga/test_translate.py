"""The translation of whole scenarios: equal to what the original translator made of the published ones."""

from __future__ import annotations

from pathlib import Path
from typing import Set

import pytest

from pursue_gen.diagnostics import PursueError, Severity
from pursue_gen.language import load
from pursue_gen.solving.periods import with_period
from pursue_gen.tga import scenario_objective, translate, translation_notes
from pursue_gen.tga.network import Automaton, Network
from pursue_gen.tga.uppaal import read_network, read_query
from tests.conftest import ROOT
from tests.tga.networks import REFERENCES, scenario

SCENARIOS = sorted((ROOT / "scenarios").rglob("*.pur"))


def reference(folder: Path) -> Network:
    return read_network((folder / "TGA.xml").read_text(encoding="utf-8"), str(folder / "TGA.xml"))


@pytest.mark.parametrize("name", REFERENCES)
def test_network_is_the_reference_network(reference_dir: Path, name: str) -> None:
    # Equal in everything, the order of declarations, automata, locations and edges included. One difference is allowed,
    # and the reader makes it: a `states` automaton without edges (an older translator wrote one) is no automaton.
    # CT1's text lacks the `after` of its objective: its reference has `after 0`, which is what we take it for.
    folder = reference_dir / name
    assert translate(load(folder / "scenario.pur")) == reference(folder)


@pytest.mark.parametrize("name", REFERENCES)
def test_objective_is_the_reference_query(reference_dir: Path, name: str) -> None:
    folder = reference_dir / name
    query = read_query((folder / "TCTL.q").read_text(encoding="utf-8"), str(folder / "TCTL.q"))
    assert scenario_objective(load(folder / "scenario.pur")) == query


@pytest.mark.parametrize("name", REFERENCES)
def test_published_scenarios_need_no_note(reference_dir: Path, name: str) -> None:
    assert translation_notes(load(reference_dir / name / "scenario.pur")) == ()


@pytest.mark.parametrize("path", SCENARIOS, ids=lambda path: path.stem)
def test_translation_is_deterministic(path: Path) -> None:
    assert translate(with_period(load(path), 30)) == translate(with_period(load(path), 30))


@pytest.mark.parametrize("path", SCENARIOS, ids=lambda path: path.stem)
def test_networks_are_closed(path: Path) -> None:
    """Every name that is used is declared, once."""
    network = translate(with_period(load(path), 30))
    declared = [*network.clocks, *(name for name, _ in network.variables), *network.channels]
    assert len(set(declared)) == len(declared)
    variables = {name for name, _ in network.variables}
    for automaton in network.automata:
        assert_closed(automaton, network, variables)


def assert_closed(automaton: Automaton, network: Network, variables: Set[str]) -> None:
    locations = [location.name for location in automaton.locations]
    assert len(set(locations)) == len(locations)
    assert automaton.initial in locations
    for edge in automaton.edges:
        assert {edge.source, edge.target} <= set(locations)
        assert {test.variable for clause in edge.guard.integers for test in clause} <= variables
        assert {variable for variable, _ in edge.assign} <= variables
        assert {bound.clock for bound in edge.guard.clocks} | set(edge.resets) <= set(network.clocks)
        assert edge.sync is None or edge.sync.channel in network.channels
        assert edge.sync is None or edge.sync.sends or not edge.guard.clocks


TWO = """
poi "a"
poi "b"
connect a and b distance 2
event "meet" collaborative
event "rest" duration 4
rule "day": rest before meet
agent "anna" controllable mobile 1 location a can_do meet, rest
agent "bert" mobile 3 location b reacts_to meet
objective: anna never_with bert
reach_objective: do rest after 5
"""


def test_order_of_declarations_and_of_the_system() -> None:
    network = translate(scenario(TWO))
    assert network.clocks == ("Canna", "Cbert", "Cobj", "Creach")
    assert network.variables == (("Pday", 0), ("Panna", 1), ("Pbert", 2))
    assert network.channels == ("anna_a2b", "anna_b2a", "bert_a2b", "bert_b2a", "meet", "rest", "restDONE")
    assert [automaton.name for automaton in network.automata] == ["anna", "bert", "obj", "reachObj", "day"]


def test_names_that_would_stand_for_two_things_are_an_error() -> None:
    # parse checks nothing: the agent's movement a_a2b and the event of that name would share a channel.
    text = TWO.replace('event "meet"', 'event "anna_a2b"\nevent "meet"')
    with pytest.raises(PursueError) as raised:
        translate(scenario(text))
    assert [d.code for d in raised.value.diagnostics] == ["TGA010"]
    assert "anna_a2b" in raised.value.diagnostics[0].message


def test_a_collaborative_event_without_anyone_else_is_left_out_and_reported() -> None:
    text = TWO.replace("location b reacts_to meet", "location b")
    text = text.replace("can_do meet, rest", "can_do meet, rest reacts_to meet")
    lonely = scenario(text)
    assert not [e for e in translate(lonely).automaton("anna").edges if e.sync and e.sync.channel == "meet"]
    (note,) = translation_notes(lonely)
    assert note.severity is Severity.WARNING
    assert note.code == "TGA013"
    assert note.span == lonely.agents[0].can_do[0].span
