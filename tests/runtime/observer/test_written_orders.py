"""Orders that people write as an objective: taken with a plan that is proven with them, as those of the scenario."""

from __future__ import annotations

import json
from typing import Any, Dict, List, Tuple

import pytest

from pursue_runtime.event_words import CANCELLED
from pursue_runtime.observer.journal import CALLS, replay
from pursue_runtime.observer.ordering import MOST_WAITING, MOST_WRITTEN, OrderAnswer
from tests.runtime.observer.test_ordering import Counter


@pytest.fixture
def counter() -> Counter:
    return Counter()


def driven(counter: Counter, *words: Tuple[str, float]) -> None:
    """What the robot is told, and reports."""
    for word, after in words:
        counter.now += after
        is_report = "going" in word or "DONE" in word
        counter.mission.on_word(f"bot:{word}" + ("" if is_report else f"@{counter.mission.seq}"), counter.now)


SETS_OFF, ARRIVES = ("bot_kitchen2room1", 0.1), ("bot_going_kitchen_to_room12room1", 10.6)


def test_what_is_written_is_taken_with_its_plan_in_one_state(counter: Counter) -> None:
    counter.order("bot at room1 within 60")
    before = counter.mission.state(counter.now)
    assert "obj3" not in before.locations and before.plan == 0
    (answer,) = counter.answered()
    state = counter.mission.state(counter.now)
    assert answer == OrderAnswer("bot at room1 within 60", True, 160.0)
    assert (state.event, state.agent, state.locations["obj3"], state.plan) == ("order1", "order_desk", "atRisk", 1)
    assert state.seq == before.seq + 1 and state.clocks["Cobj3"] == 1.0  # it counts from when it was ordered
    assert state.status == "running" and state.values["order_desk_open"] == 0
    driven(counter, SETS_OFF, ARRIVES)
    assert counter.mission.state(counter.now).locations["obj3"] == "idle"
    ended = counter.mission.finish(counter.now)[-1]
    assert "bot at room1 within 60 (answered once, after 11.7 at most)" in ended.reason


def test_an_event_can_be_ordered_for_longer_than_the_scenario_promises_its_answer(counter: Counter) -> None:
    assert "within 60 time units" in counter.refusal("tea1 within 90")
    counter.order("do serve1 within 1.5 min")
    assert counter.answered() == [OrderAnswer("do serve1 within 1.5 min", True, 190.0)]
    driven(counter, SETS_OFF)
    counter.order("tea2")
    assert counter.answered()[0].accepted
    state = counter.mission.state(counter.now)
    assert (state.locations["obj2"], state.locations["obj3"]) == ("atRisk", "atRisk")


def test_what_cannot_be_promised_is_refused_with_what_could_be(counter: Counter) -> None:
    counter.order("bot at room2 within 10")
    (answer,) = counter.answered()
    assert not answer.accepted and 15 < answer.possible < 22
    assert "'objective: bot at room2 within 10' cannot be promised beside all that is promised already" in answer.why
    assert "obj3" not in counter.mission.state(counter.now).locations
    counter.order(f"bot at room2 within {answer.possible:g}")
    assert counter.answered()[0].accepted


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("bot at room1", "it says no time; expected one behind it, as in: bot at room1 within 10 min"),
        ("bot at room1 within 5 within 7", "this is no order; expected the name of an order"),
        ("bot at room1; rm within 7", "this is no order"),
        ("bot at room1 // within 7", "this is no order"),
        ('bot at "room1" within 7', "this is no order"),
        ("bot at room1 within 9999999", "this is no order"),
        ("bot at room1 and " * 20 + "bot at room1 within 7", "this is no order"),
        ("cancel bot at room1", "nobody waits for bot at room1"),
    ],
)
def test_what_cannot_be_read_is_said_at_once(counter: Counter, text: str, why: str) -> None:
    before = counter.mission.revision()
    assert counter.refusal(text).startswith(why)
    assert counter.mission.revision() == before  # nothing goes to the journal


@pytest.mark.parametrize(
    ("says", "why"),
    [
        ("bot at room9", "column 8: there is no POI room9; did you mean room1?"),
        ("bot is room1", "column 5: expected"),
        ("avoid bot at room1", "column 1: expected"),
        ("bot at kitchen", "what is asked for is so already"),
    ],
)
def test_what_is_no_objective_is_refused_with_its_column(counter: Counter, says: str, why: str) -> None:
    counter.order(f"{says} within 60")
    (answer,) = counter.answered()
    assert not answer.accepted and answer.why.startswith(why)
    assert counter.mission.status == "running" and counter.mission.ordering.first is None


def test_the_same_again_has_no_automaton_of_its_own(counter: Counter) -> None:
    counter.order("bot at room1 within 60")
    counter.answered()
    assert "was ordered already" in counter.refusal("bot at  room1 within 50")
    driven(counter, SETS_OFF, ARRIVES)
    counter.order("bot at kitchen within 60")
    counter.answered()
    driven(counter, ("bot_room12kitchen", 0.1), ("bot_going_room1_to_kitchen2kitchen", 10.6))
    counter.order("bot at room1 within 30")
    asked = counter.now
    assert counter.answered() == [OrderAnswer("bot at room1 within 30", True, asked + 30.0)]
    assert [each.event for each in counter.mission.model.written] == ["order1", "order2"]
    assert counter.mission.state(counter.now).clocks["Cobj3"] == 31.0
    driven(counter, SETS_OFF)
    counter.order("bot at room1 within 70")
    assert counter.answered()[0].accepted
    assert [each.event for each in counter.mission.model.written] == ["order1", "order2", "order3"]


def test_what_was_written_is_cancelled_by_its_text(counter: Counter) -> None:
    counter.order("do serve1 within 60")
    counter.order("bot at room2 within 60")
    counter.order("cancel bot at room2")
    assert [(each.order, each.accepted) for each in counter.mission.ordering.drain()] == [
        ("bot at room2 within 60", False), ("cancel bot at room2", True),
    ]  # fmt: skip
    counter.answered()
    driven(counter, SETS_OFF)
    counter.order("cancel do serve1 within 60")
    assert counter.answered()[0].accepted
    state = counter.mission.state(counter.now)
    assert (state.event, state.locations["obj3"]) == (f"order1{CANCELLED}", "idle")
    counter.order("do serve1 within 60")
    assert counter.answered()[0].accepted


def test_so_many_can_be_written_and_no_more(counter: Counter) -> None:
    counter.order("bot at room1 within 60")
    counter.answered()
    model = counter.mission.model
    model.written = model.written * MOST_WRITTEN
    assert "50 different orders were written" in counter.refusal("bot at room2 within 60")
    model.written = model.written[:1]
    for number in range(MOST_WAITING):
        counter.order(f"bot at room2 within {60 + number}")
    counter.order("bot at room2 within 99")
    assert "orders wait for their answer already" in counter.mission.ordering.drain()[0].why


def test_a_plan_that_lacks_what_it_adds_is_not_used(counter: Counter) -> None:
    for wrong in (None, {}, {"automata": 3}, "x"):
        counter.order("bot at room1 within 60")
        request, answer = counter.mission.plan_request, counter.plan()
        assert request is not None
        answer = {key: value for key, value in answer.items() if key != "adds" or wrong is not None}
        counter.mission.on_plan(request.number, {**answer, **({} if wrong is None else {"adds": wrong})}, counter.now)
        (refused,) = counter.mission.ordering.drain()
        assert not refused.accepted and "the plan cannot be read" in refused.why
    assert counter.mission.status == "running"


def test_a_restarted_observer_goes_on_with_what_was_written() -> None:
    first = Counter()
    entries: List[Dict[str, Any]] = [
        {"call": "hear", "args": ["_start_"], "at": first.now, "seq": 1, "status": "running"}
    ]

    def call(name: str, *args: Any) -> None:
        CALLS[name](first.mission, *args, first.now)
        end = {"seq": first.mission.seq, "status": first.mission.status}
        entries.append(json.loads(json.dumps({"call": name, "args": args, "at": first.now, **end})))

    call("order", "bot at room1 within 60")
    request, answer = first.mission.plan_request, first.plan()
    assert request is not None
    first.now += 1.0
    call("planned", request.number, answer)
    call("hear", f"controller_bot:_plan_@{request.number}")
    call("tick")
    assert first.mission.state(first.now).locations["obj3"] == "atRisk"
    call("hear", f"bot:{SETS_OFF[0]}@{first.mission.seq}")
    call("order", "bot at room2 within 90")
    second = Counter.__new__(Counter)
    second.log, second.now = [], first.now
    second.mission = first.fresh()
    replay(second.mission, entries)
    second.mission.ordering.drain()  # those of before
    assert second.mission.state(first.now) == first.mission.state(first.now)
    assert second.mission.plan_request == first.mission.plan_request
    (answer2,) = second.answered()
    assert answer2.accepted and second.mission.state(second.now).locations["obj4"] == "atRisk"
    driven(second, ARRIVES)
    assert second.mission.state(second.now).locations["obj3"] == "idle"


def test_an_observer_that_is_restarted_before_all_have_the_plan_takes_the_order_with_it() -> None:
    first = Counter()
    first.order("bot at room1 within 60")
    request, answer = first.mission.plan_request, json.loads(json.dumps(first.plan()))
    assert request is not None
    second = Counter.__new__(Counter)
    second.log, second.now = [], first.now + 0.5
    second.mission = first.fresh()
    replay(second.mission, [
        {"call": "hear", "args": ["_start_"], "at": first.now, "seq": 1, "status": "running"},
        {"call": "order", "args": ["bot at room1 within 60"], "at": first.now, "seq": 1, "status": "running"},
        {"call": "planned", "args": [request.number, answer], "at": second.now, "seq": 1, "status": "running"},
    ])  # fmt: skip
    second.mission.on_restart(second.now)
    second.now += 0.6
    second.mission.on_word(f"controller_bot:_plan_@{request.number}", second.now)
    assert second.tick() == [OrderAnswer("bot at room1 within 60", True, 160.0)]
    assert second.mission.state(second.now).locations["obj3"] == "atRisk"
