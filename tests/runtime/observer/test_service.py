"""Robots that people take out of service while a mission is under way, and bring back."""

from __future__ import annotations

import json
from typing import Any, Dict, List, Tuple

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
from pursue_runtime.observer.ordering import OrderAnswer
from pursue_runtime.strategy import read_cover
from tests.runtime.observer.test_ordering import plain

WARD = """\
poi "hall"
poi "east"
poi "west"
connect hall and east distance 10
connect hall and west distance 10
event "tea" on_order
event "serve" location east duration 3
event "ring" location hall
event "answer" location hall duration 3
agent "nurse" location hall can_do ring
agent "bot1" controllable mobile 1 location hall can_do serve, answer
agent "bot2" controllable mobile 1 location west can_do serve
objective: if tea then serve within 60
objective: if ring then answer within 60
"""

STORY = parse(WARD, "ward.pur", "ward")
WON: Solution = solve_scenario(STORY, DEFAULT)
GAME = {
    "format": 1, "name": "ward", "rules": {"ends": "reported", "reaction": "0.1"}, "controllers": "distributed",
    "reach_obj": "dedicated", "scenario": WARD,
}  # fmt: skip
NODES = ("controller_bot1", "controller_bot2")


class Ward:
    """A mission under way, and the calls that changed it."""

    def __init__(self) -> None:
        self.log: List[str] = []
        self.calls: List[Dict[str, Any]] = []
        self.mission = self.fresh()
        self.now = 100.0
        self.call("hear", "_start_")

    def fresh(self) -> Mission:
        """A mission that has not begun."""
        model = Model(plain(model_data(WON.network, WON.objective, STORY, DEFAULT.reaction)))
        cover, say = read_cover(plain(cover_data(WON.strategy))), lambda _, text: self.log.append(text)
        return Mission(model, cover, say, on_uncovered="plan", controllers=NODES)

    def call(self, name: str, *args: Any) -> None:
        """Call the mission, and write it down as its journal does."""
        args = tuple(json.loads(json.dumps(args)))
        CALLS[name](self.mission, *args, self.now)
        end = {"seq": self.mission.seq, "status": self.mission.status}
        self.calls.append({"at": self.now, "call": name, "args": args, **end})

    def order(self, text: str, receipts: Tuple[str, ...] = NODES) -> List[OrderAnswer]:
        """The answers to an order, with a plan of the planner's that these nodes acknowledge."""
        self.call("order", text)
        request = self.mission.plan_request
        if request is not None:
            answer = replan({"format": 1, "game": GAME, **plain(request.data())}, states=5000)
            self.now += 1.0
            if answer["won"]:
                self.call("planned", request.number, answer)
            else:
                self.call("unplanned", request.number, answer["why"])
            for node in receipts if answer["won"] else ():
                self.call("hear", f"{node}:_plan_@{request.number}")
        self.call("tick")
        return self.mission.ordering.drain()

    def commanded(self) -> List[str]:
        """Whom the plan in force commands anything, anywhere."""
        plan = self.mission.in_force
        assert plan is not None
        blocks = [block for each in plan["strategies"].values() for block in each["strategy"]]
        return sorted({command["agent"] for block in blocks for command in block["commands"]})


@pytest.fixture
def ward() -> Ward:
    return Ward()


def test_a_robot_leaves_with_a_plan_that_sends_it_nothing(ward: Ward) -> None:
    (answer,) = ward.order("leave bot2")
    state = ward.mission.state(ward.now)
    assert answer.accepted and answer.text(ward.now) == (
        "{bot2} is out of service: nothing is sent to it; it stands at {west}, and counts there"
    )
    assert (state.event, state.agent, state.out_of_service, state.plan) == ("_leaves_", "bot2", ("bot2",), 1)
    assert "bot2" not in ward.commanded() and state.locations["bot2"] == "west"


def test_a_robot_that_is_needed_cannot_leave_and_it_is_said_for_what(ward: Ward) -> None:
    (answer,) = ward.order("leave bot1")
    assert not answer.accepted and "if ring then answer within 60" in answer.why
    assert "if tea" not in answer.why and "while {bot1} is out of service" in answer.why
    assert not ward.mission.state(ward.now).out_of_service and ward.mission.plan == 0


def test_where_no_plan_comes_in_time_that_is_said_with_how_long_a_search_could_take(ward: Ward) -> None:
    ward.call("order", "leave bot2")
    answers: List[OrderAnswer] = []
    while not answers:
        ward.now += 1.0
        ward.call("tick")
        answers = ward.mission.ordering.drain()
    assert answers[0].why.startswith("no plan was found within 10.0 s") and ward.now < 400.0


def test_a_command_to_a_robot_out_of_service_is_not_taken(ward: Ward) -> None:
    ward.order("leave bot2")
    seq = ward.mission.seq
    ward.now += 5.0
    ward.call("hear", f"bot2:bot2_west2hall@{seq}")
    assert ward.mission.seq == seq and ward.mission.state(ward.now).locations["bot2"] == "west"


def test_a_robot_comes_back_with_a_plan_that_may_use_it(ward: Ward) -> None:
    ward.order("leave bot2")
    (answer,) = ward.order("join bot2")
    state = ward.mission.state(ward.now)
    assert answer.accepted and answer.text(ward.now) == "{bot2} is in service again"
    assert (state.event, state.out_of_service, state.plan) == ("_joins_", (), 2)


def test_where_no_plan_with_it_is_found_a_robot_comes_back_under_the_one_in_force(ward: Ward) -> None:
    ward.order("leave bot2")
    ward.call("order", "join bot2")
    request = ward.mission.plan_request
    assert request is not None
    ward.call("unplanned", request.number, "it took too long")
    (answer,) = ward.mission.ordering.drain()
    assert answer.accepted and ward.mission.plan == 1 and not ward.mission.state(ward.now).out_of_service


def test_without_a_plan_it_does_not_come_back_from_elsewhere(ward: Ward) -> None:
    ward.order("leave bot2")
    ward.call("order", "join bot2")
    request = ward.mission.plan_request
    assert request is not None
    ward.call("hear", "bot2:_displaced_ is 4 m from west")
    ward.call("unplanned", request.number, "it took too long")
    (answer,) = ward.mission.ordering.drain()
    assert not answer.accepted and ward.mission.state(ward.now).out_of_service == ("bot2",)


def test_its_controller_may_be_switched_off_while_it_is_away(ward: Ward) -> None:
    ward.order("leave bot2")
    ward.call("silent", "controller_bot2")
    assert ward.mission.status == "running"
    (answer,) = ward.order("join bot2")
    assert not answer.accepted and "controller_bot2 is silent" in answer.why
    (answer,) = ward.order("tea", receipts=NODES[:1])  # a new plan does not wait for it, either
    assert answer.accepted and ward.mission.state(ward.now).out_of_service == ("bot2",)
    assert "bot2" not in ward.commanded()


def test_a_plan_with_which_a_robot_comes_back_waits_for_its_controller(ward: Ward) -> None:
    ward.order("leave bot2")
    assert not ward.order("join bot2", receipts=NODES[:1])
    assert ward.mission.state(ward.now).out_of_service == ("bot2",)
    ward.call("hear", "controller_bot2:_plan_@2")
    ward.call("tick")
    assert [answer.accepted for answer in ward.mission.ordering.drain()] == [True]


def test_a_controller_that_is_silent_holds_the_mission_where_its_robot_serves(ward: Ward) -> None:
    ward.call("silent", "controller_bot2")
    assert ward.mission.status == "holding"


def test_a_robot_joins_where_it_left(ward: Ward) -> None:
    ward.order("leave bot2")
    ward.call("hear", "bot2:_displaced_ is 4 m from west")
    (answer,) = ward.order("join bot2")
    assert not answer.accepted and "is 4 m from west" in answer.why and "bring it back" in answer.why
    ward.call("hear", "bot2:_back_")
    assert ward.order("join bot2")[0].accepted


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("leave bot3", "there is no robot bot3; expected one of {bot1}, {bot2}"),
        ("join bot2", "{bot2} is in service already"),
        ("leave bot2 now", "this is no order"),
        ("join bot2 at hall", "this is no order"),
        ("leave obj", "there is no robot obj"),
    ],
)
def test_what_cannot_be_is_refused_at_once(ward: Ward, text: str, why: str) -> None:
    (answer,) = ward.order(text)
    assert not answer.accepted and why in answer.why and ward.mission.plan_request is None


def test_a_robot_leaves_once(ward: Ward) -> None:
    ward.order("leave bot2")
    (answer,) = ward.order("leave bot2")
    assert answer.why == "{bot2} is out of service already"


def test_a_restarted_observer_knows_who_is_out_of_service(ward: Ward) -> None:
    ward.order("leave bot2")
    again = ward.fresh()
    replay(again, ward.calls)
    assert again.state(ward.now) == ward.mission.state(ward.now)
    ward.order("join bot2")
    again = ward.fresh()
    replay(again, ward.calls)
    assert not again.state(ward.now).out_of_service


def test_a_mission_that_is_taken_up_from_a_state_never_plays_a_plan_that_may_command_it(ward: Ward) -> None:
    state = ward.mission.state(ward.now)._replace(out_of_service=("bot2",))  # of the workspace's own plan
    ward.mission.adopt(json.loads(json.dumps(state._asdict())), ward.now)
    request = ward.mission.plan_request
    assert ward.mission.status == "holding" and request is not None and request.out_of_service == ("bot2",)
