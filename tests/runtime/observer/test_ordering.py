"""A mission that takes orders of people: with a plan that is proven with them, and no other."""

from __future__ import annotations

import json
from typing import Any, Dict, List

import pytest

from pursue_gen.language import parse
from pursue_gen.partition.strategy_data import cover_data
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import Solution, solve_scenario
from pursue_gen.tools.replanning import replan
from pursue_gen.workspace.model_file import model_data
from pursue_runtime.model import Model
from pursue_runtime.observer.journal import CALLS, replay
from pursue_runtime.observer.mission import Mission
from pursue_runtime.observer.ordering import MOST_WAITING, WINDOW, OrderAnswer, Refused, effect, read_order
from pursue_runtime.strategy import read_cover

TEA = """\
poi "kitchen"
poi "room1"
poi "room2"
connect kitchen and room1 distance 10
connect kitchen and room2 distance 15
event "tea1" on_order
event "tea2" on_order
event "serve1" location room1 duration 3
event "serve2" location room2 duration 3
agent "bot" controllable mobile 1 location kitchen can_do serve1, serve2
objective: if tea1 then serve1 within 60
objective: if tea2 then serve2 within 60
"""

STORY = parse(TEA, "tea.pur", "tea")
WON: Solution = solve_scenario(STORY, DEFAULT)
GAME = {
    "format": 1, "name": "tea", "rules": {"ends": "reported", "reaction": "0.1"}, "controllers": "distributed",
    "reach_obj": "dedicated", "scenario": TEA,
}  # fmt: skip


def plain(data: Any) -> Any:
    """Data as a file holds them."""
    if isinstance(data, dict):
        return {key: plain(value) for key, value in data.items()}
    return [plain(value) for value in data] if isinstance(data, (list, tuple)) else data


MODEL = Model(plain(model_data(WON.network, WON.objective, STORY, DEFAULT.reaction)))


class Counter:
    """A mission under way, and people who order."""

    def __init__(self) -> None:
        self.log: List[str] = []
        self.mission = self.fresh()
        self.now = 100.0
        self.mission.on_word("_start_", self.now)

    def fresh(self) -> Mission:
        """A mission that has not begun."""
        model = Model(plain(model_data(WON.network, WON.objective, STORY, DEFAULT.reaction)))
        cover, say = read_cover(plain(cover_data(WON.strategy))), lambda _, text: self.log.append(text)
        return Mission(model, cover, say, on_uncovered="plan", controllers=("controller_bot",))

    def order(self, text: str) -> None:
        self.mission.on_order(text, self.now)

    def plan(self) -> Dict[str, Any]:
        """What the planner answers to the request of now."""
        request = self.mission.plan_request
        assert request is not None
        return replan({"format": 1, "game": GAME, **plain(request.data())}, states=5000)

    def answered(self, after: float = 1.0) -> List[OrderAnswer]:
        """The answers once the planner has answered, the controller has the plan, and it may come into force."""
        request, answer = self.mission.plan_request, self.plan()
        assert request is not None
        self.now += after
        if answer["won"]:
            self.mission.on_plan(request.number, answer, self.now)
            self.mission.on_word(f"controller_bot:_plan_@{request.number}", self.now)
        else:
            self.mission.on_refused(request.number, answer["why"], answer.get("possible", 0.0), self.now)
        return self.tick()

    def tick(self) -> List[OrderAnswer]:
        self.mission.on_time(self.now)
        return self.mission.ordering.drain()

    def refusal(self, text: str) -> str:
        self.order(text)
        (answer,) = self.mission.ordering.drain()
        assert not answer.accepted and self.mission.ordering.first is None
        return answer.why


@pytest.fixture
def counter() -> Counter:
    return Counter()


def test_an_order_is_taken_with_its_plan_in_one_state(counter: Counter) -> None:
    counter.order("tea1")
    before = counter.mission.state(counter.now)
    assert (before.locations["obj"], before.plan) == ("idle", 0)  # nothing is promised yet
    (answer,) = counter.answered()
    state = counter.mission.state(counter.now)
    assert answer == OrderAnswer("tea1", True, 160.0)
    assert (state.event, state.agent, state.locations["obj"], state.plan) == ("tea1", "order_desk", "atRisk", 1)
    assert state.seq == before.seq + 1 and state.clocks["Cobj"] == 1.0  # it counts from when it was ordered
    assert state.status == "running" and state.values["order_desk_open"] == 0


def test_who_wants_it_sooner_gets_it_sooner(counter: Counter) -> None:
    counter.order("tea1 within 30")
    (answer,) = counter.answered()
    assert (answer.accepted, answer.by) == (True, 130.0)
    assert counter.mission.state(counter.now).clocks["Cobj"] == 31.0


def test_at_the_end_is_said_after_how_long_it_was_answered(counter: Counter) -> None:
    counter.order("tea1 within 30")
    counter.answered()
    for word, after in (("bot_kitchen2room1", 0.5), ("bot_going_kitchen_to_room12room1", 10.6), ("serve1", 1.1),
                        ("serve1DONE", 3.5)):  # fmt: skip
        counter.now += after
        commanded = f"@{counter.mission.seq}" if "DONE" not in word and "going" not in word else ""
        counter.mission.on_word(f"bot:{word}{commanded}", counter.now)
        if word == "serve1":
            counter.mission.on_word(f"bot:_order_@{counter.mission.seq}", counter.now)
    state = counter.mission.finish(counter.now)[-1]
    assert "if tea1 then serve1 within 60 (answered once, after 16.7 at most)" in state.reason


def test_what_cannot_be_promised_is_refused_with_what_could_be(counter: Counter) -> None:
    counter.order("tea2 within 10")
    (answer,) = counter.answered()
    assert not answer.accepted and 20 < answer.possible < 30
    assert "cannot be promised beside all that is promised already" in answer.why
    state = counter.mission.state(counter.now)
    assert (state.status, state.plan, state.locations["obj2"], state.seq) == ("running", 0, "idle", 1)
    counter.order(f"tea2 within {answer.possible:g}")
    assert counter.answered()[0].accepted


def test_a_plan_comes_into_force_when_its_proof_begins_and_no_later_than_that_holds(counter: Counter) -> None:
    counter.order("tea1")
    request = counter.mission.plan_request
    assert request is not None
    assert counter.answered(0.5) == []
    assert counter.mission.next_moment(counter.now) == request.stamp + request.ahead
    counter.now = request.stamp + request.ahead + WINDOW + 0.1
    assert counter.tick() == [] and counter.mission.state(counter.now).plan == 0
    again = counter.mission.plan_request
    assert again is not None and again.number > request.number and again.ahead > request.ahead
    assert again.clocks["Cobj"] == pytest.approx(counter.now + again.ahead - 100.0)


def test_what_happens_meanwhile_is_looked_at_again(counter: Counter) -> None:
    counter.order("tea1")
    counter.answered()
    counter.order("tea2")
    first = counter.mission.plan_request
    counter.now += 0.5
    counter.mission.on_word(f"bot:bot_kitchen2room1@{counter.mission.seq}", counter.now)
    second = counter.mission.plan_request
    assert first is not None and second is not None and second.number > first.number
    assert second.locations["bot"] == "going_kitchen_to_room1"
    assert counter.answered()[0].accepted


def test_a_plan_for_another_state_is_not_put_in_force(counter: Counter) -> None:
    counter.order("tea1")
    request, answer = counter.mission.plan_request, counter.plan()
    assert request is not None
    counter.mission._automata.set_values({"Pbot": 9})  # as a broken assumption changes a value, without an event
    counter.mission.on_plan(request.number, answer, counter.now)
    counter.now += 1.0
    counter.mission.on_word(f"controller_bot:_plan_@{request.number}", counter.now)
    state = counter.mission.state(counter.now)
    assert (state.plan, state.locations["obj"]) == (0, "idle") and counter.mission.ordering.drain() == []


def test_a_restarted_observer_goes_on_with_what_was_ordered_and_accepted() -> None:
    first = Counter()
    entries: List[Dict[str, Any]] = []

    def call(name: str, *args: Any) -> None:
        CALLS[name](first.mission, *args, first.now)
        end = {"seq": first.mission.seq, "status": first.mission.status}
        entries.append(json.loads(json.dumps({"call": name, "args": args, "at": first.now, **end})))

    entries.append({"call": "hear", "args": ["_start_"], "at": first.now, "seq": 1, "status": "running"})
    call("order", "tea1 within 50")
    request, answer = first.mission.plan_request, first.plan()
    assert request is not None
    first.now += 1.0
    call("planned", request.number, answer)
    call("hear", f"controller_bot:_plan_@{request.number}")
    call("order", "tea2")
    call("order", "urgent tea2 within 40")
    call("order", "cancel tea1")
    call("order", "cancel tea2")
    second = Counter.__new__(Counter)
    second.log, second.now = [], first.now
    second.mission = first.fresh()
    replay(second.mission, entries)
    assert second.mission.state(first.now) == first.mission.state(first.now)
    assert second.mission.plan_request == first.mission.plan_request
    assert [each.text for each in second.mission.ordering.waiting] == ["cancel tea1", "tea2"]
    assert second.mission.state(first.now).clocks["Cobj"] == 11.0


def test_orders_are_looked_at_one_after_the_other(counter: Counter) -> None:
    counter.order("tea1")
    counter.order("tea2")
    assert [each.order for each in counter.answered()] == ["tea1"]
    counter.mission.on_word(f"bot:bot_kitchen2room1@{counter.mission.seq}", counter.now)
    assert [each.order for each in counter.answered()] == ["tea2"]
    assert counter.mission.state(counter.now).plan == 2 and counter.mission.plan_request is None


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("coffee", "nobody can order coffee; expected one of {tea1}, {tea2}"),
        ("serve1", "it says no time; expected one behind it, as in: serve1 within 10 min"),
        ("tea1 within", "this is no order; expected the name of an order"),
        ("tea1 within 5 days", "this is no order"),
        ("", "this is no order"),
        ("tea1 " * 100, "this is no order"),
        (
            "tea1 within 61",
            "the scenario promises {tea1} within 60 time units: order it within that, or with more time what is to "
            "happen: do serve1 within 61",
        ),
    ],
)
def test_what_cannot_be_ordered_is_said_at_once(counter: Counter, text: str, why: str) -> None:
    assert counter.refusal(text).startswith(why)


def test_what_is_refused_at_once_is_not_written_down(counter: Counter) -> None:
    before = counter.mission.revision()
    counter.refusal("coffee")
    assert counter.mission.revision() == before


def test_what_waits_for_its_answer_is_not_ordered_again(counter: Counter) -> None:
    counter.order("tea1")
    counter.answered()
    assert counter.refusal("tea1") == "{tea1} was ordered already, and waits for its answer"


def test_nothing_is_ordered_before_the_start_while_it_holds_and_after_the_end(counter: Counter) -> None:
    counter.mission.on_controller_silent("controller_bot", counter.now)
    assert "the mission is holding: controller_bot is silent" in counter.refusal("tea1")
    counter.mission.on_controller_back("controller_bot", counter.now)
    counter.order("tea1")
    counter.mission.stop("enough", counter.now)
    (answer,) = counter.mission.ordering.drain()
    assert (answer.order, answer.accepted, answer.why) == ("tea1", False, "the mission is stopped")
    assert "the mission is stopped" in counter.refusal("tea2")


def test_too_many_orders_are_refused(counter: Counter) -> None:
    for _ in range(MOST_WAITING):
        counter.order("tea1")
    assert counter.mission.ordering.drain() == []
    counter.order("tea1")
    assert [(each.order, each.accepted) for each in counter.mission.ordering.drain()] == [("tea1", False)]
    assert len(counter.mission.ordering.waiting) == MOST_WAITING


def test_a_command_for_the_state_before_is_stale(counter: Counter) -> None:
    counter.order("tea1")
    counter.answered()
    old = counter.mission.seq - 1
    counter.mission.on_word(f"bot:bot_kitchen2room1@{old}", counter.now)
    assert counter.mission.counts["stale"] == 1 and counter.mission.state(counter.now).locations["bot"] == "kitchen"


def test_an_answer_is_a_sentence() -> None:
    assert OrderAnswer("tea", True, 160.0).text(100.0) == "accepted: answered in 60 s at the latest"
    assert OrderAnswer("lamp", True).text(100.0) == "accepted"
    assert OrderAnswer("tea", False, why="no", possible=9.5).text(0) == (
        "refused: no; it could be promised within 9.5 time units"
    )


@pytest.mark.parametrize(("text", "within"), [("tea", None), ("tea within 90", 90), (" tea  within 3 min ", 90)])
def test_times_have_units(text: str, within: Any) -> None:
    assert read_order(text, 1.0, 2.0, MODEL).within == within


def test_no_text_is_taken_for_an_order() -> None:
    for text in ("tea within -3", "tea within 1e3", "tea; rm", "tea\n\nwithin", "Tea within 3 minutes", "7"):
        with pytest.raises(Refused):
            read_order(text, 1.0, 1.0, MODEL)


# Cancelled, and urgent ------------------------------------------------------------------------------------------------


def test_what_waits_is_taken_back_at_once(counter: Counter) -> None:
    counter.order("tea1")
    counter.order("cancel tea1")
    cancelled, answer = counter.mission.ordering.drain()
    assert (cancelled.order, cancelled.accepted, cancelled.why) == ("tea1", False, "it was cancelled")
    assert (answer.order, answer.text(0.0)) == ("cancel tea1", "cancelled")
    assert counter.mission.plan_request is None and counter.mission.ordering.first is None


def test_a_promise_falls_away_with_a_plan_that_does_without_it(counter: Counter) -> None:
    counter.order("tea1")
    counter.answered()
    before = counter.mission.seq
    counter.mission.on_word(f"bot:bot_kitchen2room1@{before}", counter.now)
    counter.order("cancel tea1")
    assert counter.mission.state(counter.now).locations["obj"] == "atRisk"  # until then it is kept
    (answer,) = counter.answered()
    state = counter.mission.state(counter.now)
    assert (answer.order, answer.accepted) == ("cancel tea1", True)
    assert (state.event, state.agent, state.plan) == ("tea1_cancelled_", "order_desk", 2)
    assert (state.locations["obj"], state.locations["bot"], state.seq) == (
        "idle", "going_kitchen_to_room1", before + 2
    )  # fmt: skip
    counter.order("tea1")
    assert counter.answered()[0].accepted


def test_at_the_end_what_was_cancelled_was_not_answered(counter: Counter) -> None:
    counter.order("tea1")
    counter.answered()
    counter.mission.on_word(f"bot:bot_kitchen2room1@{counter.mission.seq}", counter.now)
    counter.order("cancel tea1")
    counter.answered()
    assert "if tea1 then serve1 within 60 (never answered)" in counter.mission.finish(counter.now)[-1].reason


def test_what_is_not_due_or_is_being_done_is_not_cancelled(counter: Counter) -> None:
    assert counter.refusal("cancel tea1") == "no {tea1} waits for its answer"
    assert "nobody can order coffee" in counter.refusal("cancel coffee")
    assert "this is no order" in counter.refusal("cancel tea1 within 5")
    counter.order("tea1")
    counter.answered()
    for word, after in (("bot_kitchen2room1", 0.1), ("bot_going_kitchen_to_room12room1", 10.5), ("serve1", 1.1)):
        counter.now += after
        commanded = "" if "going" in word else f"@{counter.mission.seq}"
        counter.mission.on_word(f"bot:{word}{commanded}", counter.now)
    assert counter.refusal("cancel tea1") == "{bot} is at it already"


def test_what_is_answered_before_the_plan_comes_is_not_cancelled(counter: Counter) -> None:
    counter.order("tea1")
    counter.answered()
    counter.mission.on_word(f"bot:bot_kitchen2room1@{counter.mission.seq}", counter.now)
    counter.now += 10.5
    counter.mission.on_word("bot:bot_going_kitchen_to_room12room1", counter.now)
    counter.order("cancel tea1")
    counter.now += 1.1
    counter.mission.on_word(f"bot:serve1@{counter.mission.seq}", counter.now)
    (answer,) = counter.mission.ordering.drain()
    assert answer.text(0.0) == "not cancelled: {bot} is at it already"


def test_where_no_plan_is_found_the_promise_stands(counter: Counter) -> None:
    counter.order("tea1")
    counter.answered()
    counter.order("cancel tea1")
    request = counter.mission.plan_request
    assert request is not None
    counter.mission.on_no_plan(request.number, "no plan was found within 5 s", counter.now)
    (answer,) = counter.mission.ordering.drain()
    assert answer.text(0.0).startswith("not cancelled: no plan without it was found, so it goes on: no plan was found")
    assert counter.mission.state(counter.now).locations["obj"] == "atRisk"


def test_what_is_urgent_is_looked_at_first(counter: Counter) -> None:
    counter.order("tea1")
    counter.order("urgent tea2")
    counter.order("urgent tea1")
    assert [each.text for each in counter.mission.ordering.waiting] == ["urgent tea2", "urgent tea1", "tea1"]
    assert [each.order for each in counter.answered()] == ["urgent tea2"]


def test_of_several_that_wait_the_oldest_is_cancelled() -> None:
    text = TEA.replace("serve1 within 60", "serve1 within 60, at_most 3 open")
    story = parse(text, "tea.pur", "tea")
    won = solve_scenario(story, DEFAULT)
    model = Model(plain(model_data(won.network, won.objective, story, DEFAULT.reaction)))
    here = model.initial()
    for _ in range(2):
        here = effect(model, here, read_order("tea1", 0.0, 1.0, model)).after(here.aged(1.0), 0.0)
    left = effect(model, here, read_order("cancel tea1", 0.0, 1.0, model)).after(here, 0.0)
    assert [left.locations[name] for name in ("obj", "obj2", "obj3")] == ["idle", "atRisk", "idle"]
