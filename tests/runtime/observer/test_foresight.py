"""Where a mission will be in a few seconds: what is expected to happen until then has happened."""

from __future__ import annotations

from typing import Optional

import pytest

from pursue_runtime.observer.foresight import Foreseen, Foresight
from pursue_runtime.observer.planning import apart
from tests.runtime.observer.test_ordering import Counter

ROOM1 = "going_kitchen_to_room1"


@pytest.fixture
def under_way() -> Counter:
    """Tea was ordered, and the robot is on its way to the room since a moment."""
    counter = Counter()
    counter.order("tea1")
    counter.answered()
    counter.mission.on_word(f"bot:bot_kitchen2room1@{counter.mission.seq}", counter.now)
    return counter


def foreseen(counter: Counter, least: float, most: float = 100.0, gone: str = "") -> Optional[Foreseen]:
    mission = counter.mission
    foresight = Foresight(mission._automata, mission._cover, [gone] if gone else [])
    return foresight.find(mission.position(counter.now), least, most, 0.2)


def test_nothing_happens_before_a_robot_can_be_there(under_way: Counter) -> None:
    found = foreseen(under_way, 5.0)
    assert found is not None and (found.begins, found.spread) == (5.0, {})
    assert found.position == under_way.mission.position(under_way.now).aged(5.0)


def test_it_will_have_come_and_will_have_got_its_command(under_way: Counter) -> None:
    """Its way takes 10 to 11; serving begins about 1 later."""
    found = foreseen(under_way, 9.9)
    assert found is not None and found.position.locations["bot"] == "doing_serve1_in_room1"
    assert 12.0 <= found.begins <= 12.2
    assert apart(found.spread["Cbot"], {}) == pytest.approx(0.58, abs=0.01)
    assert found.position.clocks["Cbot"] == pytest.approx(found.begins - 11.57, abs=0.03)
    assert "Cobj" not in found.spread


def test_when_that_is_too_late_nothing_is_foreseen(under_way: Counter) -> None:
    assert foreseen(under_way, 9.9, 10.5) is None


def test_nobody_waits_for_who_is_gone(under_way: Counter) -> None:
    found = foreseen(under_way, 30.0, gone="bot")
    assert found is not None and found.position.locations["bot"] == ROOM1


def test_what_is_answered_until_then_is_answered(under_way: Counter) -> None:
    found = foreseen(under_way, 14.0)
    assert found is not None and found.position.locations["obj"] == "idle"
    assert found.position.locations["bot"] == "room1"


def test_an_order_is_taken_in_the_state_that_was_foreseen(under_way: Counter) -> None:
    """The robot comes while the plan is looked for, which is for the state behind that."""
    counter = under_way
    counter.now += 10.0
    counter.order("tea2")
    request, answer = counter.mission.plan_request, counter.plan()
    assert request is not None and answer["won"]
    assert request.locations["bot"] == "doing_serve1_in_room1" and request.locations["obj2"] == "atRisk"
    counter.now += 0.7
    counter.mission.on_word(f"bot:bot_{ROOM1}2room1", counter.now)
    assert counter.mission.plan_request == request
    counter.mission.on_plan(request.number, answer, counter.now + 0.1)
    counter.mission.on_word(f"controller_bot:_plan_@{request.number}", counter.now + 0.1)
    begins = counter.mission.order_begins()
    assert begins is not None and counter.mission.next_moment(counter.now + 0.1) == begins
    counter.mission.on_word(f"bot:serve1@{counter.mission.seq}", counter.now + 1.05)
    counter.now = begins
    (taken,) = counter.tick()
    state = counter.mission.state(counter.now)
    assert (taken.order, taken.accepted, state.plan, state.event) == ("tea2", True, 2, "tea2")
    assert state.locations["bot"] == "doing_serve1_in_room1"


def test_where_it_comes_otherwise_another_plan_is_asked_for(under_way: Counter) -> None:
    counter = under_way
    counter.now += 10.0
    counter.order("tea2")
    first = counter.mission.plan_request
    counter.now += 0.1
    counter.mission.on_word(f"bot:bot_{ROOM1}2room1", counter.now)
    counter.mission.on_word(f"bot:serve1@{counter.mission.seq}", counter.now + 2.5)  # later than it should
    second = counter.mission.plan_request
    assert first is not None and second is not None and second.number > first.number
