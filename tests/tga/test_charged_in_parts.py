"""Batteries of which parts of a charge count: never more than a real one has, and who wins because of that."""

from __future__ import annotations

from fractions import Fraction
from typing import Iterator, List, Sequence, Tuple

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.explanation.explain import explain
from pursue_gen.language import parse
from pursue_gen.language.numbers import Number
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.symbols import Role, Symbol
from pursue_gen.solving.rules import Rules
from pursue_gen.synthesis.limits import Limits
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Edge
from pursue_gen.tga.uppaal import read_network, write_network
from pursue_gen.tools.simulation.duties import Charges
from pursue_gen.tools.simulation.outcome import SAFE, Settings
from pursue_gen.tools.simulation.runs import MissionRunner, case_of
from pursue_gen.vocabulary.statuses import statuses
from pursue_gen.workspace import Options
from tests.tga.test_endurance import CALLS, HOUSE, PATROL, house, solved

QUARTER = Fraction(1, 4)
Times = List[Tuple[int, int]]
"""How long a robot is away and at its charger then, in quarters of a time unit."""

TIMES = st.lists(st.tuples(st.integers(1, 120), st.integers(1, 120)), min_size=1, max_size=8)


def parted(lasts: int, charge: int, parts: int, more: str = "objective: avoid ring") -> Scenario:
    text = HOUSE.format(lasts, charge, more)
    return parse(text.replace(f"in {charge} at", f"in {charge} in {parts} parts at"), "x.pur", "x")


class Watched:
    """What the automaton of a battery sees of its robot, which is at the charger at the start."""

    def __init__(self, scenario: Scenario) -> None:
        self.automaton = translate(scenario).automaton("obj2")
        self.location, self.clocks = self.automaton.initial, dict.fromkeys(self.automaton.clocks, Fraction())

    def goes(self, channel: str) -> None:
        (edge,) = (edge for edge in self.automaton.edges if (edge.source, edge.channel) == (self.location, channel))
        self._take(edge)

    def waits(self, quarters: int) -> None:
        for _ in range(quarters):
            self.clocks = {clock: value + QUARTER for clock, value in self.clocks.items()}
            while True:
                found = [each for each in self.automaton.edges if self._passes(each)]
                assert len(found) <= 1, "it is clear what comes"
                if not found:
                    break
                self._take(found[0])

    def _passes(self, edge: Edge) -> bool:
        if edge.source != self.location or edge.sync is not None or edge.controllable:
            return False
        for bound in edge.guard.clocks:
            now = self.clocks[bound.clock]
            if not {"<=": now <= bound.bound, ">": now > bound.bound, ">=": now >= bound.bound}[bound.op]:
                return False
        # What is empty in the very moment in which a part is done may do either.
        becomes_empty = Symbol.of(edge.target).role in (Role.EMPTY, Role.CAME_LATE)
        return not becomes_empty or self.clocks["Ccharge2"] < self._needed()

    def _needed(self) -> Number:
        return next(bound.bound for bound in self.automaton.stays[self.location] if bound.clock == "Ccharge2")

    def _take(self, edge: Edge) -> None:
        self.location = edge.target
        self.clocks.update(dict.fromkeys(edge.resets, Fraction()))

    @property
    def left(self) -> Fraction:
        """How long the battery lasts, as far as this counts on it, of a robot that is away."""
        assert Symbol.of(self.location).role in (Role.AT_RISK, Role.LEFT)
        return self.automaton.stays[self.location][0].bound - self.clocks["Cobj2"]


def leaves(watched: Watched, times: Times) -> Iterator[Tuple[int, int]]:
    """Moves it as long as it is back in time. It is at its charger at each of these, and leaves next."""
    for away, there in times:
        watched.goes("bot_dock2hall")
        if watched.location == "lose" or watched.left < away * QUARTER:
            return
        watched.waits(away)
        watched.goes("bot_going_hall_to_dock2dock")
        watched.waits(there)
        yield away, there


BATTERIES = st.tuples(st.integers(1, 10), st.integers(1, 10), st.integers(2, 6))


@given(BATTERIES, TIMES)
@settings(max_examples=150)
def test_it_never_counts_on_more_than_a_real_battery_has(battery: Tuple[int, int, int], times: Times) -> None:
    part, needs, parts = battery
    watched = Watched(parted(part * parts, needs * parts, parts))
    real = Fraction(part * parts)
    for away, there in leaves(watched, times):
        real -= away * QUARTER
        assert real >= 0
        real = min(Fraction(part * parts), real + there * QUARTER * part / needs)
        symbol = Symbol.of(watched.location)
        assert symbol.role is not Role.CHARGED or real >= int(symbol.parts[0]) * part
        assert watched.location != "idle" or real == part * parts


@given(BATTERIES, st.sampled_from((1, 2, 3)), TIMES)
@settings(max_examples=100)
def test_smaller_parts_never_leave_less(battery: Tuple[int, int, int], parts: int, times: Times) -> None:
    part, needs, finer = battery
    lasts, charge = part * parts * finer, needs * parts * finer
    some, more = Watched(parted(lasts, charge, parts)), Watched(parted(lasts, charge, parts * finer))
    for away, there in times:
        for each in (some, more):
            each.goes("bot_dock2hall")
        if some.location == "lose" or some.left < away * QUARTER:
            return
        assert more.left >= some.left
        for each in (some, more):
            each.waits(away)
            each.goes("bot_going_hall_to_dock2dock")
            each.waits(there)


@given(BATTERIES, TIMES)
@settings(max_examples=100)
def test_the_judge_counts_the_same(battery: Tuple[int, int, int], times: Times) -> None:
    part, needs, parts = battery
    scenario = parted(part * parts, needs * parts, parts)
    watched, now = Watched(scenario), 0.0
    charges = Charges({1: scenario.safety[1]}, ["dock", "hall"])  # type: ignore[dict-item]
    charges.on_state({"bot": "dock"}, now)
    for away, there in times:
        charges.on_state({"bot": "going_dock_to_hall"}, now)
        watched.goes("bot_dock2hall")
        since = charges.since(1)
        assert since is not None
        left = charges.limit(1) - (now - since)
        if watched.location == "lose":
            assert left <= 1e-5
            return
        assert left == pytest.approx(float(watched.left), abs=1e-4)
        if watched.left < away * QUARTER:
            return
        watched.waits(away)
        watched.goes("bot_going_hall_to_dock2dock")
        charges.on_state({"bot": "dock"}, now + away / 4)
        watched.waits(there)
        now += (away + there) / 4


@pytest.mark.parametrize(
    ("lasts", "charge", "parts", "more", "won"),
    [
        (20, 20, 2, PATROL.format(25), True),  # half a charge between two rounds
        (8, 20, 2, PATROL.format(40), False),  # no charge makes it last longer than when it is full
        (60, 30, 3, CALLS.format(25, 10), True),  # it charges between calls, and leaves on one
        (60, 300, 6, CALLS.format(25, 10), False),  # but not enough of it
    ],
)
def test_who_wins(lasts: int, charge: int, parts: int, more: str, won: bool) -> None:
    assert solved(house(lasts, charge, more)) is None
    assert (solved(parted(lasts, charge, parts, more)) is not None) == won


def test_missions_leave_on_a_call_and_come_back_with_what_they_charged() -> None:
    scenario = parted(60, 30, 3, CALLS.format(25, 10))
    won = solved(scenario)
    assert won is not None
    runner = MissionRunner(case_of(scenario, won, Options(), Settings(until=400.0))[0])
    for seed in range(3):
        outcome = runner.run(seed)
        assert outcome.end == SAFE, outcome.reason


@settings(max_examples=12)
@given(st.integers(3, 10), st.integers(1, 8), st.integers(2, 5), st.sampled_from([20, 32, 48]), st.booleans())
def test_missions_of_strategies_keep_them_as_the_judge_counts_them(
    part: int, needs: int, parts: int, within: int, calls: bool
) -> None:
    scenario = parted(part * parts, needs * parts, parts, CALLS.format(40, within) if calls else PATROL.format(within))
    won = solved(scenario)
    if won is None:
        return
    runner = MissionRunner(case_of(scenario, won, Options(), Settings(until=300.0))[0])
    for seed in range(2):
        outcome = runner.run(seed)
        assert outcome.end == SAFE, outcome.reason


def test_it_is_read_as_it_is_written_for_uppaal() -> None:
    scenario = parted(60, 20, 4)
    network = translate(scenario)
    assert read_network(write_network(network, scenario_objective(scenario)), "TGA.xml") == network


def changes(scenario: Scenario) -> Sequence[str]:
    found = explain(scenario, Rules(), Limits(work=20_000_000)).changes
    return [change.sentence for change in found]


def test_a_lost_scenario_says_that_parts_would_do_and_what_would_do_with_parts() -> None:
    assert "a battery of bot that is charged in 2 parts instead of 1" in changes(house(20, 20, PATROL.format(25)))
    found = changes(parted(8, 20, 2, PATROL.format(40)))
    assert any(change.startswith("a battery of bot that lasts ") for change in found), found


def test_its_state_is_said_in_words() -> None:
    scenario = parted(60, 20, 4, PATROL.format(25))
    (known,) = (each for each in statuses(scenario, translate(scenario)) if each.of == "obj2")
    assert known.label == 'battery "bot" lasts 60, charges in 20 in 4 parts at dock'
    assert known.texts["charged_3"] == "bot charges at dock; 3 of 4 parts are full"
    assert known.texts["atRisk_2"] == "bot has to be back at dock in time, since it left with 2 of 4 parts"
