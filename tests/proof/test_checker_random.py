"""The checker against plays worked out point by point: what loses somewhere is never passed."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Dict, List, Tuple

from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.proof.checker import pruned, verify
from pursue_gen.synthesis.solve import solve
from pursue_gen.synthesis.strategy import Block, Command, Constraint, Strategy, Zone, ZoneKey
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Kind, Location, Network, Objective, Sync
from tests.choices import member_of
from tests.synthesis.play_by_play import broken
from tests.synthesis.random_games import objectives

PLACES = ("l0", "l1", "l2")
CLOCKS = ("x", "y")


@st.composite
def networks(draw: st.DrawFn) -> Network:
    """A mostly controllable automaton with clock x and a mostly uncontrollable one with clock y."""
    return Network(CLOCKS, (), ("a",), tuple(_automaton(draw, k) for k in range(2)))


def _automaton(draw: st.DrawFn, number: int) -> Automaton:
    clock = CLOCKS[number]
    locations = tuple(
        Location(p, (ClockBound(clock, "<=", draw(st.integers(1, 4))),) if draw(st.booleans()) else ()) for p in PLACES
    )
    edges = []
    for k in range(draw(st.integers(3, 5) if number == 0 else st.integers(1, 3))):
        role = draw(member_of(("tau", "tau", "a!", "a?")))
        bounds = []
        if role != "a?":
            bounds.append(ClockBound(clock, draw(member_of((">", ">="))), draw(st.integers(0, 3))))
            if draw(st.integers(0, 3)) == 0:
                bounds.append(ClockBound(draw(member_of(CLOCKS)), "<=", draw(st.integers(1, 4))))
        edges.append(
            Edge(
                PLACES[k % 2],
                draw(member_of(PLACES)),
                Guard(tuple(bounds)),
                None if role == "tau" else Sync("a", role == "a!"),
                resets=(clock,) if draw(st.booleans()) else (),
                controllable=(draw(st.integers(0, 3)) > 0) == (number == 0),
            )
        )
    return Automaton(f"A{number}", locations, "l0", tuple(edges))


OBJECTIVES = st.sampled_from(list(Kind)).flatmap(objectives)
NEVER_L2 = Objective(Kind.SAFETY, bad=(("A0", "l2"),))


def _all_keys(strategy: Strategy) -> List[ZoneKey]:
    keys: List[ZoneKey] = []
    for b, block in enumerate(strategy.blocks):
        keys += [(b, "wait", n) for n in range(len(block.wait))]
        keys += [(b, k, n) for k, command in enumerate(block.commands) for n in range(len(command.zones))]
    return keys


def _changed(draw: st.DrawFn, strategy: Strategy) -> Strategy:
    """The strategy with one zone removed, moved by a bit, made to wait, or opened wide."""
    key = draw(member_of(_all_keys(strategy)))
    how = draw(member_of(("remove", "shift", "wait", "open")))
    b, part, n = key
    block = strategy.blocks[b]
    zones = block.wait if part == "wait" else block.commands[int(part)].zones
    zone = zones[n]
    changed: Dict[str, Tuple[Zone, ...]] = {
        "remove": (),
        "wait": (),
        "open": ((),),
        "shift": (_shifted(draw, zone),),
    }
    left = zones[:n] + changed[how] + zones[n + 1 :]
    wait = (*block.wait, zone) if how == "wait" and part != "wait" else block.wait
    if part == "wait":
        block = replace(block, wait=left)
    else:
        k = int(part)
        command = Command(left, block.commands[k].moves)
        block = Block(block.state, wait, block.commands[:k] + (command,) + block.commands[k + 1 :])
    return replace(strategy, blocks=strategy.blocks[:b] + (block,) + strategy.blocks[b + 1 :])


def _shifted(draw: st.DrawFn, zone: Zone) -> Zone:
    if not zone:
        return zone
    n = draw(st.integers(0, len(zone) - 1))
    by = draw(member_of((-1, 0, 1)))
    other = Constraint(zone[n].left, zone[n].right, zone[n].bound + by, zone[n].strict != (by == 0))
    return zone[:n] + (other,) + zone[n + 1 :]


@given(st.data(), networks(), OBJECTIVES, st.sampled_from((Fraction(0), Fraction(1, 2))))
def test_a_strategy_with_a_losing_play_is_never_passed(
    data: st.DataObject, network: Network, objective: Objective, reaction: Fraction
) -> None:
    verdict = solve(network, objective, reaction)
    strategy = verdict.strategy
    if strategy is None or not _all_keys(strategy):
        return
    report = verify(network, objective, strategy, reaction, prompt=False)
    assert report.ok, report
    assert broken(network, objective, strategy, reaction) is None
    changed = _changed(data.draw, strategy) if data.draw(st.booleans()) else pruned(strategy, report)
    if broken(network, objective, changed, reaction) is not None:
        assert not verify(network, objective, changed, reaction, prompt=False).ok
        assert not verify(network, objective, changed, reaction, prompt=False, ranks=verdict.ranks or {}).ok


@given(networks(), OBJECTIVES, st.sampled_from((Fraction(0), Fraction(1, 2))))
def test_what_no_play_reaches_may_go(network: Network, objective: Objective, reaction: Fraction) -> None:
    strategy = solve(network, objective, reaction).strategy
    if strategy is None:
        return
    report = verify(network, objective, strategy, reaction)
    assert report.ok, report
    less = pruned(strategy, report)
    assert verify(network, objective, less, reaction).ok
    assert len(_all_keys(less)) == len(report.used)


def test_a_command_on_its_way_stands_whatever_those_do_who_are_left_out() -> None:
    again = Edge("l0", "l0", Guard((ClockBound("x", ">", 0),)), resets=("x",))
    passing = Edge("l0", "l0", Guard((ClockBound("y", ">", 0),)), resets=("y",), controllable=False)
    soon = (Location("l0", (ClockBound("x", "<=", 1),)), Location("l2"))
    both = Automaton("A0", soon, "l0", (again,)), Automaton("A1", (Location("l0"), Location("l2")), "l0", (passing,))
    network, objective = Network(CLOCKS, (), (), both), NEVER_L2
    strategy = solve(network, objective, Fraction(1, 2)).strategy
    assert strategy is not None and [name for name, _ in strategy.blocks[0].state.locations] == ["A0"]
    assert verify(network, objective, strategy, Fraction(1, 2)).ok
    assert broken(network, objective, strategy, Fraction(1, 2)) is None
