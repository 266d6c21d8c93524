"""Doors are open for who is on the way through them, and only then; none is closed on anybody."""

from __future__ import annotations

from typing import Dict, FrozenSet, List, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime.data import DataError
from pursue_runtime.doors.keeper import REPEAT, SETTLE, DoorData, DoorKeeper, Word, read_doors
from pursue_runtime.state import RUNNING, WAITING, SystemState

WAYS = ("going_hall_to_lab", "going_lab_to_hall")
DOORS = {"d1": DoorData(8.0, {"bot1": WAYS, "bot2": WAYS})}


def state(seq: int, bot1: str = "hall", bot2: str = "lab", status: str = RUNNING) -> SystemState:
    return SystemState(seq, 0.0, {"bot1": bot1, "bot2": bot2}, {}, {}, status=status, mission="m")


class World:
    """A keeper with a clock."""

    def __init__(self) -> None:
        self.keeper = DoorKeeper(DOORS)
        self.now = 100.0

    def see(self, *args: object, **more: object) -> List[Tuple[str, Word]]:
        self.keeper.on_state(state(*args, **more), self.now)  # type: ignore[arg-type]
        return self.keeper.due(self.now)

    def open_for(self) -> FrozenSet[str]:
        return self.keeper.opened(self.now).doors.get("d1", frozenset())


def test_it_is_asked_to_open_for_who_sets_off_and_is_open_when_it_reports_that() -> None:
    world = World()
    assert world.see(0, status=WAITING) == []
    assert world.see(1, bot1=WAYS[0]) == [("d1", True)] and world.open_for() == frozenset()
    world.now += 3
    assert world.keeper.waited_for(world.now) == {"d1": 3.0}
    world.keeper.on_report("d1", True, world.now)
    assert world.open_for() == {"bot1"} and world.keeper.opened(world.now).seq == 1
    assert world.keeper.waited_for(world.now) == {}


def test_it_stays_open_until_the_last_one_has_passed() -> None:
    world = World()
    world.see(1, bot1=WAYS[0])
    world.now += 1
    world.keeper.on_report("d1", True, world.now)
    assert world.see(2, bot1=WAYS[0], bot2=WAYS[1]) == [] and world.open_for() == {"bot1", "bot2"}
    assert world.see(3, bot1="lab", bot2=WAYS[1]) == [] and world.open_for() == {"bot2"}
    assert world.see(4, bot1="lab", bot2="hall") == [("d1", False)] and world.open_for() == frozenset()


def test_what_it_reported_before_it_was_asked_counts_when_it_has_stayed_so() -> None:
    world = World()
    world.see(1, bot1=WAYS[0])
    world.now += 1
    world.keeper.on_report("d1", True, world.now)
    world.see(2, bot1="lab")
    world.now += 0.1  # it has been asked to close, and has not begun to
    world.see(3, bot1=WAYS[1])
    assert world.open_for() == frozenset()
    assert world.keeper.next_moment(world.now) == pytest.approx(world.now + min(REPEAT, SETTLE))
    world.now += SETTLE
    assert world.open_for() == {"bot1"}
    assert world.keeper.next_moment(world.now) is None, "there is nothing to look at while somebody passes"
    world.keeper.on_report("d1", False, world.now)
    assert world.open_for() == frozenset()


def test_a_door_that_opens_quickly_is_not_watched_for_longer_than_it_may_take() -> None:
    keeper = DoorKeeper({"d1": DoorData(0.5, {"bot1": WAYS})})
    keeper.on_report("d1", True, 90.0)
    keeper.on_state(state(1, bot1=WAYS[0]), 100.0)
    assert not keeper.opened(100.2).doors and keeper.opened(100.25).doors == {"d1": {"bot1"}}


def test_it_is_asked_again_until_it_has_done_it() -> None:
    world = World()
    world.see(1, bot1=WAYS[0])
    assert world.keeper.due(world.now + REPEAT / 2) == []
    assert world.keeper.due(world.now + REPEAT) == [("d1", True)]
    world.keeper.on_report("d1", True, world.now + REPEAT)
    assert world.keeper.due(world.now + 10 * REPEAT) == []


def test_a_keeper_that_begins_in_the_middle_of_a_mission_closes_what_nobody_needs() -> None:
    assert World().see(7) == [("d1", False)]
    assert World().see(7, bot2=WAYS[1]) == [("d1", True)]


@given(
    st.lists(
        st.tuples(
            st.sampled_from(["hall", "lab", *WAYS]), st.sampled_from(["hall", "lab", *WAYS]),
            st.sampled_from([None, True, False]), st.sampled_from([0.0, 0.3, 1.0, 5.0]),
        ),
        max_size=20,
    )
)  # fmt: skip
def test_it_is_open_only_for_who_is_on_the_way_and_reported_open_and_never_asked_to_close_on_anybody(
    steps: List[Tuple[str, str, object, float]]
) -> None:
    world = World()
    reported: object = None
    for seq, (bot1, bot2, said, passes) in enumerate(steps, 1):
        asked: Dict[str, bool] = dict(world.see(seq, bot1, bot2))
        on_way = {name for name, where in (("bot1", bot1), ("bot2", bot2)) if where in WAYS}
        assert not on_way or asked.get("d1", True)
        if said is not None:
            reported = said
            world.keeper.on_report("d1", bool(said), world.now)
        world.now += passes
        assert world.open_for() in (frozenset(), on_way)
        assert not world.open_for() or reported is True
        assert not on_way or dict(world.keeper.due(world.now)).get("d1", True)


@pytest.mark.parametrize(
    "doors", [[], {"d1": []}, {"d1": {"within": 3}}, {"d1": {"within": "x", "asked_by": {}}}]
)
def test_data_that_are_none_are_refused(doors: object) -> None:
    with pytest.raises(DataError, match=r"ui\.yaml"):
        read_doors({"doors": doors})


def test_without_doors_there_are_none() -> None:
    assert read_doors({}) == {}
    assert read_doors({"doors": {"d1": {"within": 3, "asked_by": {"b": ["x"]}}}})["d1"].within == 3.0
