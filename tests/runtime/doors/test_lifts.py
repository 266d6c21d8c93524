"""Lifts come to who waits for them, bring who is aboard to another floor, and never leave anybody in their door."""

from __future__ import annotations

from typing import Dict, FrozenSet, List, Optional, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime.data import DataError
from pursue_runtime.doors.keeper import REPEAT, SETTLE, Word
from pursue_runtime.doors.lifts import NOWHERE, LiftData, LiftKeeper, read_lifts
from pursue_runtime.state import RUNNING, WAITING, SystemState

UP, DOWN = "going_h0_to_h1", "going_h1_to_h0"
WAYS = {UP: ("h0", "h1"), DOWN: ("h1", "h0")}
LIFTS = {"l1": LiftData(40.0, 20.0, ("h0", "h1"), {"bot1": WAYS, "bot2": WAYS})}


def state(seq: int, bot1: str = "h0", bot2: str = "h1", status: str = RUNNING) -> SystemState:
    return SystemState(seq, 0.0, {"bot1": bot1, "bot2": bot2}, {}, {}, status=status, mission="m")


class World:
    """A keeper with a clock."""

    def __init__(self) -> None:
        self.keeper = LiftKeeper(LIFTS)
        self.now = 100.0

    def see(self, *args: object, **more: object) -> List[Tuple[str, Word]]:
        self.keeper.on_state(state(*args, **more), self.now)  # type: ignore[arg-type]
        return self.asked()

    def asked(self) -> List[Tuple[str, Word]]:
        return self.keeper.due(self.now)

    def open_at(self, floor: str, wait: float = 1.0) -> Dict[str, FrozenSet[str]]:
        self.now += wait
        self.keeper.on_report("l1", floor, self.now)
        return self.gates()

    def gates(self) -> Dict[str, FrozenSet[str]]:
        return dict(self.keeper.opened(self.now).doors)

    def aboard(self, agent: str, as_of: Optional[int] = None) -> List[Tuple[str, Word]]:
        self.now += 1.0
        self.keeper.on_aboard(agent, as_of, self.now)
        return self.asked()


def test_it_comes_takes_who_is_aboard_and_is_free_when_it_has_arrived() -> None:
    world = World()
    assert world.see(0, status=WAITING) == []
    assert world.see(1, UP) == [("l1", "h0")] and world.gates() == {}
    assert world.keeper.waited_for(world.now + 3) == {"l1": 3.0}
    assert world.open_at(NOWHERE) == {} and world.open_at("h1") == {}
    assert world.open_at("h0") == {"l1 at h0": {"bot1"}}
    assert world.aboard("bot1", 1) == [("l1", "h1")] and world.gates() == {}
    assert world.open_at(NOWHERE) == {} and world.open_at("h1") == {"l1 at h1": {"bot1"}}
    assert world.see(2, "h1") == [("l1", NOWHERE)] and world.gates() == {}
    world.now += 10 * REPEAT
    assert world.asked() == [], "a lift that nobody needs is left alone"


def test_it_stays_where_somebody_may_be_in_its_door() -> None:
    world = World()
    world.see(1, UP)
    world.open_at("h0")
    assert world.see(2, UP, DOWN) == [], "bot1 may be in it"
    assert world.open_at(NOWHERE) == {}
    world.now += REPEAT
    assert world.asked() == [("l1", "h0")]
    world.open_at("h0")
    assert world.aboard("bot1") == [("l1", "h1")]
    assert world.open_at("h1") == {"l1 at h1": {"bot1", "bot2"}}, "bot2 gets in where bot1 gets out"
    assert world.see(3, "h1", DOWN) == [] and world.aboard("bot2") == [("l1", "h0")]


def test_who_is_aboard_comes_before_who_waits() -> None:
    world = World()
    world.see(1, "h0", DOWN)
    world.see(2, UP, DOWN)
    world.open_at("h1")
    assert world.aboard("bot2") == [("l1", "h0")]
    assert world.open_at("h0") == {"l1 at h0": {"bot1", "bot2"}}
    assert world.aboard("bot1") == [], "bot2 may be in its door"
    assert world.see(3, UP, "h0") == [("l1", "h1")]


def test_what_it_reported_before_it_was_asked_counts_when_it_has_stayed_so() -> None:
    world = World()
    world.open_at("h0")
    world.now += 1
    world.see(1, UP)
    assert world.gates() == {} and world.keeper.next_moment(world.now) == pytest.approx(world.now + min(REPEAT, SETTLE))
    world.now += SETTLE
    assert world.gates() == {"l1 at h0": {"bot1"}} and world.keeper.next_moment(world.now) is None


def test_what_was_said_of_an_earlier_ride_does_not_count() -> None:
    world = World()
    world.see(1)
    world.see(8, UP)
    assert world.aboard("bot1", 7) == world.aboard("bot3") == [("l1", "h0")], "it has not come yet"
    assert world.aboard("bot1", 8) == [("l1", "h1")]


def test_a_keeper_that_begins_with_somebody_in_it_brings_it_to_its_goal() -> None:
    world = World()
    assert world.see(9, UP) == [("l1", "h0")]
    assert world.aboard("bot1", 5) == [("l1", "h1")]
    assert World().see(9) == [("l1", NOWHERE)]


def test_one_that_is_late_is_named() -> None:
    world = World()
    world.see(1, UP)
    assert not list(world.keeper.late(world.now + 39, 1.0))
    assert list(world.keeper.late(world.now + 41, 1.0)) == ["l1 at h0"]
    world.open_at("h0")
    world.aboard("bot1")
    assert list(world.keeper.late(world.now + 21, 1.0)) == ["l1 at h1"]


@given(
    st.lists(
        st.tuples(
            st.sampled_from(["h0", "h1", UP, DOWN]), st.sampled_from(["h0", "h1", UP, DOWN]),
            st.sampled_from([None, NOWHERE, "h0", "h1"]), st.sampled_from(["", "bot1", "bot2"]),
            st.sampled_from([0.0, 0.3, 1.0, 5.0]),
        ),
        max_size=25,
    )
)  # fmt: skip
def test_it_is_open_only_where_it_says_so_and_is_sent_away_from_nobody_in_its_door(
    steps: List[Tuple[str, str, Optional[str], str, float]]
) -> None:
    world = World()
    said: Optional[str] = None
    in_door: Dict[str, Tuple[str, str]] = {}  # who has been let in or out, where it was then, and at which floor

    def look() -> None:
        for _, floor in world.asked():
            assert {at for _, at in in_door.values()} <= {floor}
        for gate, agents in world.gates().items():
            assert gate == f"l1 at {said}" and agents
            in_door.update({agent: (where[agent], str(said)) for agent in agents})

    for seq, (bot1, bot2, floor, aboard, passes) in enumerate(steps, 1):
        where = {"bot1": bot1, "bot2": bot2}
        in_door = {agent: (at, gate) for agent, (at, gate) in in_door.items() if where[agent] == at}
        world.keeper.on_state(state(seq, bot1, bot2), world.now)
        look()
        if floor is not None:
            said = floor
            world.keeper.on_report("l1", floor, world.now)
        look()
        if aboard and aboard in in_door and in_door[aboard][1] == WAYS[where[aboard]][0]:
            del in_door[aboard]
            world.keeper.on_aboard(aboard, seq, world.now)
        look()
        world.now += passes
        look()


@pytest.mark.parametrize(
    "lifts",
    [
        [], {"l1": []}, {"l1": {"within": 3, "takes": 4, "floors": ["a", "b"]}},
        {"l1": {"within": "x", "takes": 4, "floors": ["a"], "rides": {}}},
        {"l1": {"within": 3, "takes": 4, "floors": ["a"], "rides": {"bot": {"going_a_to_b": ["a", "b"]}}}},
        {"l1": {"within": 3, "takes": 4, "floors": ["a", "b"], "rides": {"bot": {"going_a_to_b": "ab"}}}},
    ],
)  # fmt: skip
def test_data_that_are_none_are_refused(lifts: object) -> None:
    with pytest.raises(DataError, match=r"ui\.yaml"):
        read_lifts({"lifts": lifts})


def test_without_lifts_there_are_none() -> None:
    assert read_lifts({}) == {}
    data = {"within": 3, "takes": 4, "floors": ["a", "b"], "rides": {"bot": {"going_a_to_b": ["a", "b"]}}}
    assert read_lifts({"lifts": {"l1": data}})["l1"].rides == {"bot": {"going_a_to_b": ("a", "b")}}
