"""Reported ends: the environment ends movements and actions; everything else stays."""

from __future__ import annotations

from dataclasses import replace
from typing import Dict

import pytest

from pursue_gen.diagnostics import PursueError
from pursue_gen.tga import ends_reported, translate
from pursue_gen.tga.network import Network, with_controllability
from tests.tga.networks import scenario

TEXT = """
poi "a"
poi "b"
connect a and b distance 4
event "lift" collaborative duration 2
event "call"
rule "r": call before lift
agent "bot" controllable mobile 1 location a can_do lift
agent "nurse" human controllable mobile 2 location a can_do call
agent "patient" mobile 3 location b reacts_to lift
agent "desk" location b reacts_to lift
objective: if call then lift within 60
"""


def ideal() -> Network:
    return translate(scenario(TEXT))


def test_only_ends_change_hands() -> None:
    before, after = ideal(), ends_reported(ideal(), {})
    assert [a.name for a in after.automata] == [a.name for a in before.automata]
    for old, new in zip(before.automata, after.automata):
        assert new.locations == old.locations
        agent = old.name in ("bot", "nurse", "patient")
        assert new.edges == tuple(
            with_controllability(edge, edge.controllable and not (agent and edge.is_end)) for edge in old.edges
        )
    assert any(edge.controllable for edge in after.automaton("bot").edges)
    assert any(edge.controllable for edge in after.automaton("obj").edges)
    assert not any(edge.controllable and edge.is_end for edge in after.automaton("nurse").edges)


def test_slack_lets_the_named_agents_be_late() -> None:
    bounds = {
        (automaton.name, location.name): [bound.bound for bound in location.invariant]
        for automaton in ends_reported(ideal(), {"bot": 5}).automata
        for location in automaton.locations
    }
    assert bounds["bot", "going_a_to_b"] == [10]
    assert bounds["bot", "doing_lift_in_a"] == [8]
    assert bounds["bot", "a"] == []
    assert bounds["patient", "going_a_to_b"] == [13]
    assert bounds["obj", "atRisk"] == [60]


def test_guards_of_late_ends_stay() -> None:
    for old, new in zip(ideal().automaton("bot").edges, ends_reported(ideal(), {"bot": 5}).automaton("bot").edges):
        assert replace(new, controllable=True) == old


def test_an_agent_that_never_does_anything_may_have_a_slack() -> None:
    assert ends_reported(ideal(), {"desk": 3}) == ends_reported(ideal(), {})


@pytest.mark.parametrize(("slack", "code"), [({"rover": 1}, "TGA020"), ({"bot": -1}, "TGA021")])
def test_a_slack_without_sense_is_an_error(slack: Dict[str, int], code: str) -> None:
    with pytest.raises(PursueError) as raised:
        ends_reported(ideal(), slack)
    assert [d.code for d in raised.value.diagnostics] == [code]
