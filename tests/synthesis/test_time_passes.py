"""Who is said to let time pass is never stuck at the end of a stay: random agents, and all that they may do."""

from __future__ import annotations

import operator
from typing import Dict, List, Tuple

from hypothesis import event, given, settings
from hypothesis import strategies as st

from pursue_gen.proof.independence import why_it_matters
from pursue_gen.synthesis.cone import lets_time_pass
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Kind, Location, Network, Objective
from pursue_gen.tga.part import part_of
from tests.choices import member_of

OPERATORS = {"<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge}
STEPS, LONGEST = 4, 8
"""Steps of time in a unit, more than two clocks can tell apart; more units than any bound."""

GOAL = Automaton("A", (Location("start"), Location("goal")), "start", (Edge("start", "goal"),))
REACH = Objective(Kind.REACH, goal=(("A", "goal"),))

bounds = st.builds(ClockBound, st.sampled_from("yz"), st.sampled_from(sorted(OPERATORS)), st.integers(0, 4))


def edges(source: str, target: str) -> st.SearchStrategy[Edge]:
    guards = st.builds(Guard, st.lists(bounds, max_size=2).map(tuple))
    resets = st.sampled_from(["", "y", "z", "yz"]).map(tuple)
    return st.builds(Edge, st.just(source), st.just(target), guards, resets=resets, controllable=st.just(False))


@st.composite
def walkers(draw: st.DrawFn) -> Automaton:
    """Who comes, does things while there, and leaves; how long it stays is bounded by the clock z."""
    loops = draw(st.lists(edges("there", "there"), max_size=2))
    some = (draw(edges("here", "there")), *loops, draw(edges("there", "here")))
    places = Location("here"), Location("there", (ClockBound("z", "<=", draw(st.integers(1, 5))),))
    return Automaton("walker", places, draw(member_of(["here", "there"])), some)


def is_stuck(walker: Automaton) -> bool:
    """Whether it comes to the end of a stay and can neither leave nor begin the stay anew."""
    last = STEPS * int(walker.locations[1].invariant[0].bound)
    found = {(walker.initial, 0, 0)}
    pending = list(found)
    while pending:
        place, y, z = pending.pop()
        now: Dict[str, int] = {"y": y, "z": z}
        after: List[Tuple[str, int, int]] = []
        for edge in walker.edges:
            if edge.source == place and all(OPERATORS[b.op](now[b.clock], STEPS * b.bound) for b in edge.guard.clocks):
                moved = (0 if "y" in edge.resets else y), (0 if "z" in edge.resets else z)
                after += [(edge.target, *moved)] if edge.target == "here" or moved[1] <= last else []
        if place == "there" and z == last and all(to == "there" and then == last for to, _, then in after):
            return True
        if place == "here" or z < last:
            after.append((place, min(y + 1, STEPS * LONGEST), min(z + 1, STEPS * LONGEST)))
        pending += set(after) - found
        found.update(after)
    return False


@settings(max_examples=100, deadline=None)
@given(walkers())
def test_who_lets_time_pass_is_never_stuck(walker: Automaton) -> None:
    network = Network(("y", "z"), (), (), (GOAL, walker))
    passes = lets_time_pass(walker, network)
    is_free = why_it_matters(network, REACH, part_of(network, {"A"}, set())) == ""
    event(f"left out: {passes}, the checker agrees: {is_free}")
    assert is_free or not passes
    assert not is_free or not is_stuck(walker)
