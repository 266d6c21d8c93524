"""States: one automaton keeps the variables of all of them."""

from __future__ import annotations

from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.tga import translate
from tests.tga.networks import scenario

DOOR = """
poi "a"
event "unlock"
event "lock"
event "enter"
state "open": initially false, true_if unlock false_if lock
state "used": initially true, true_if enter false_if unlock
stateDependency: lock only_if used is_false
stateDependency: enter only_if open is_true
agent "bot" controllable location a can_do unlock, lock, enter
reach_objective: do lock
"""
"""Nobody can lock before it was unlocked: that sets both states."""


def test_an_event_sets_all_its_states_at_once() -> None:
    states = translate(scenario(DOOR)).automaton("states")
    assert [(edge.sync.channel, edge.assign) for edge in states.edges if edge.sync is not None] == [
        ("unlock", (("Sopen", 1), ("Sused", 0))), ("lock", (("Sopen", 0),)), ("enter", (("Sused", 1),))
    ]  # fmt: skip
    assert all(edge.source == edge.target == "base" and edge.controllable for edge in states.edges)


def test_what_needs_two_of_these_states_can_be_done() -> None:
    both = DOOR.replace("stateDependency: enter", "stateDependency: lock only_if open is_true\nstateDependency: enter")
    assert solve_scenario(scenario(both), Rules()).strategy.blocks


def test_where_no_event_sets_a_state_there_is_no_automaton() -> None:
    text = DOOR.replace(", true_if unlock false_if lock", "").replace(", true_if enter false_if unlock", "")
    names = [automaton.name for automaton in translate(scenario(text)).automata]
    assert names == ["bot", "reachObj"]
