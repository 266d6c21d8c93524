"""Strategies that leave out clocks which only keep the environment from acting: proven for an environment without."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Tuple

import pytest
from hypothesis import HealthCheck, assume, event, given, settings
from hypothesis import strategies as st

from pursue_gen.proof.checker import ProofReport, pruned, verify
from pursue_gen.proof.independence import named_part
from pursue_gen.synthesis.solve import solve
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Location, Network, Objective, Sync
from pursue_gen.tga.pauses import pauses
from tests.choices import member_of
from tests.proof.test_checker_random import OBJECTIVES, _all_keys, _changed
from tests.proof.test_parts import GO, LATER, REACH, before, block, since
from tests.synthesis.play_by_play import broken

BOT = Automaton("A", (Location("start"), Location("done")), "start", (GO,))
SOON = Fraction(1, 2)


def guest(*edges: Edge, stays: Tuple[ClockBound, ...] = ()) -> Automaton:
    """Somebody who calls again at the earliest after two units, and what else he does."""
    calls = Edge("here", "here", Guard((ClockBound("y", ">=", 2),)), Sync("call", True), (), ("y",), False)
    places = Location("here", stays), Location("there", (ClockBound("z", "<=", 3),))
    return Automaton("O", places, "here", (calls, *edges))


def said(other: Automaton, clocks: Tuple[str, ...] = ("y",)) -> ProofReport:
    """What the checker says of one who waits for 7 time units, whatever the other does."""
    wait = block({"A": "start", "O": "here"}, LATER.wait, (since("x", 7), "A", GO))
    network = Network(("x", "y", "z"), (), ("call",), (BOT, other))
    return verify(network, REACH, Strategy((wait,), left_out_clocks=clocks), SOON)


def test_a_call_that_changes_only_the_clock_that_is_left_out_makes_no_command_stale() -> None:
    # With the clock, a command that a call has made stale is given again: the zone that it was in has ended.
    once = block({"A": "start", "O": "here"}, (before("x", 7),), (since("x", 7) + before("x", 8), "A", GO))
    network = Network(("x", "y"), (), ("call",), (BOT, replace(guest(), locations=(Location("here"),))))
    strategy = Strategy((once,))
    assert not verify(network, REACH, strategy, SOON).ok
    assert verify(network, REACH, replace(strategy, left_out_clocks=("y",)), SOON).ok
    assert broken(network, REACH, strategy, SOON) is not None
    assert broken(network, REACH, replace(strategy, left_out_clocks=("y",)), SOON) is None


@pytest.mark.parametrize(
    ("other", "why"),
    [
        (guest(Edge("here", "here", Guard((ClockBound("y", ">", 1),)))), "does not begin"),
        (guest(Edge("here", "here", Guard((ClockBound("y", "<", 1),)), None, (), (), False)), "may oblige"),
        (guest(Edge("there", "here", Guard((ClockBound("y", ">", 1),)), None, (), (), False)), "may oblige"),
        (guest(Edge("here", "there", resets=("y",))), "the controller resets y"),
        (guest(stays=(ClockBound("y", "<=", 9),)), "y bounds a stay of O"),
    ],
)
def test_a_clock_that_does_more_than_keep_the_environment_from_acting_is_not_left_out(
    other: Automaton, why: str
) -> None:
    assert said(guest()).ok
    report = said(other)
    assert report.reason.startswith("left out: ") and why in report.reason


def test_a_clock_that_the_strategy_compares_is_not_left_out() -> None:
    report = said(guest(), ("x",))
    assert report.reason.startswith("left out: ") and "compares x" in report.reason


def test_a_strategy_in_stages_leaves_no_clock_out() -> None:
    stages = Strategy((LATER,), stages=((("A", "done"),),), left_out_clocks=("y",))
    report = verify(Network(("x", "y"), (), ("call",), (BOT, guest())), REACH, stages)
    assert report.reason.startswith("left out: ")


def test_without_the_clock_the_environment_may_act_sooner() -> None:
    gone = Edge("here", "there", Guard((ClockBound("y", ">", 50),)), None, (), ("y", "z"), False)
    wait = block({"A": "start", "O": "here"}, LATER.wait, (since("x", 7) + before("x", 8), "A", GO))
    network = Network(("x", "y", "z"), (), (), (BOT, guest(gone)))
    assert verify(network, REACH, Strategy((wait,))).ok
    assert verify(network, REACH, Strategy((wait,), left_out_clocks=("y",))).reason.startswith("no block")


@st.composite
def networks(draw: st.DrawFn) -> Network:
    """A mostly controllable automaton with clock x, and one of the environment that rests on y between its moves."""
    receives = draw(st.booleans())
    bot = Automaton("A0", _places(draw), "l0", tuple(_edge(draw, k) for k in range(draw(st.integers(4, 6)))))
    calls = tuple(_call(draw, k, receives) for k in range(draw(st.integers(1, 3))))
    caller = Automaton("A1", tuple(map(Location, ("l0", "l1", "l2"))), "l0", calls)
    return Network(("x", "y"), (), ("a", "b"), (bot, caller))


def _places(draw: st.DrawFn) -> Tuple[Location, ...]:
    stays = (ClockBound("x", "<=", draw(st.integers(1, 4))) if draw(st.booleans()) else None for _ in range(3))
    return tuple(Location(f"l{k}", () if stay is None else (stay,)) for k, stay in enumerate(stays))


def _edge(draw: st.DrawFn, k: int) -> Edge:
    role = draw(member_of(("tau", "tau", "a!", "a!", "b?")))
    lowest = (ClockBound("x", draw(member_of((">", ">="))), draw(st.integers(0, 3))),)
    return Edge(
        f"l{k % 2}",
        draw(member_of(("l0", "l1", "l2"))),
        Guard(() if role == "b?" else lowest),
        None if role == "tau" else Sync(role[0], role[1] == "!"),
        resets=("x",) if draw(st.booleans()) else (),
        controllable=draw(st.integers(0, 7)) > 0,
    )


def _call(draw: st.DrawFn, k: int, receives: bool) -> Edge:
    source = f"l{k % 2}"
    if receives and draw(st.integers(0, 2)) == 0:
        target = draw(member_of(("l0", "l1", "l2")))
        return Edge(source, target, sync=Sync("a", False), resets=("y",), controllable=False)
    op, rest = draw(member_of(((">", 0), (">", 1), (">=", 1), (">", 2))))
    target = draw(member_of((source, source, source, "l0", "l1", "l2")))
    sync = draw(member_of((None, Sync("b", True))))
    return Edge(source, target, Guard((ClockBound("y", op, rest),)), sync, resets=("y",), controllable=False)


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.data(), networks(), OBJECTIVES, st.sampled_from((Fraction(0), SOON)))
def test_a_strategy_that_leaves_clocks_out_is_right_in_the_network_with_them(
    data: st.DataObject, network: Network, objective: Objective, reaction: Fraction
) -> None:
    assume(pauses(network) == ("y",))
    verdict = solve(network, objective, reaction, without_pauses=True)
    strategy = verdict.strategy
    if strategy is None or not _all_keys(strategy):
        return
    assert "y" not in named_part(network, strategy).clocks
    if not strategy.left_out_clocks:  # nobody who rests matters
        return
    event(f"won, {objective.kind.value}")
    # Without a delay what is won so is won in the game with the clock, too, where calls cannot follow without end.
    rests = all(bound.bound for edge in network.automata[1].edges for bound in edge.guard.clocks)
    assert reaction or not rests or solve(network, objective, reaction).won
    report = verify(network, objective, strategy, reaction, prompt=False)
    assert report.ok, report
    assert verify(network, objective, pruned(strategy, report), reaction, prompt=False).ok
    assert broken(network, objective, strategy, reaction) is None
    changed = _changed(data.draw, strategy)
    if broken(network, objective, changed, reaction) is not None:
        event("refused")
        assert not verify(network, objective, changed, reaction, prompt=False).ok


