"""A robot that finds its way blocked goes back to where it came from, as part of the new plan."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from pursue_runtime.model import Model
from pursue_runtime.observer.journal import Journal
from pursue_runtime.observer.mission import Mission
from pursue_runtime.observer.ways import way_back, way_of
from pursue_runtime.strategy import read_cover
from tests.runtime.observer.test_holding import COVER, EVERYWHERE, NOWHERE, answer, planned
from tests.runtime.observer.test_mission import CHASE, Journey
from tests.runtime.texts import read

BACK = """\
  - {from: b, to: going_b_to_a, word: bot_b2a, sync: send, when: [Cbot > 1], if: [[Prule=7]], set: {Pbot: -21}, reset: [Cbot], controllable: true}
  - {from: going_b_to_a, to: a, word: bot_going_b_to_a2a, sync: own, when: [Cbot > 3], set: {Pbot: 1}, reset: [Cbot], controllable: false}
"""  # noqa: E501 (an edge per line)
CATCH = "  - {from: b, to: b, word: catch, sync: send, when: [Cbot"
RETURN = CHASE.replace(CATCH, BACK + CATCH)
"""The chase, where the bot may also go back."""


def journey(text: str = RETURN, **options: Any) -> Journey:
    """A mission whose robot is on its way from a to b since moment 2."""
    made = Journey(text, COVER, **{"on_uncovered": "plan", "controllers": ("one", "two"), "lost_after": 8.0, **options})
    made.hear("_start_", 0.0)
    made.hear("bot_a2b", 2.0)
    return made


def test_the_way_of_a_movement_and_the_way_back() -> None:
    model = Model(read(RETURN))
    assert way_of(model, "going_a_to_b") == way_of(model, "going_b_to_a") == ("a", "b")
    assert way_of(model, "a") is None and way_of(model, "going_a_to_c") is None
    move = way_back(model, "bot", "going_a_to_b")
    assert move is not None and (move.automaton, move.edge.word) == ("bot", "bot_b2a")
    assert way_back(model, "bot", "b") is None and way_back(Model(read(CHASE)), "bot", "going_a_to_b") is None
    heard = RETURN.replace("to: b, word: catch, sync: receive", "to: b, word: bot_b2a, sync: receive")
    assert way_back(Model(read(heard)), "bot", "going_a_to_b") is None


def test_the_plan_is_to_begin_with_the_robot_on_its_way_back() -> None:
    made = journey()
    state = made.hear("bot:_blocked_", 5.0)
    assert (state.status, state.lost, state.locations["bot"]) == ("holding", ("bot",), "going_a_to_b")
    wanted = made.mission.plan_request
    assert (wanted.excused, wanted.blocked, wanted.turning) == ((), (("a", "b", "bot"),), ("bot",))
    assert (wanted.locations["bot"], wanted.values["Pbot"]) == ("going_b_to_a", -21)
    assert (wanted.clocks["Cbot"], wanted.clocks["Creach"], wanted.ahead) == (0.0, 5.0, 1.0)


def test_the_robot_goes_back_when_the_plan_is_in_force_and_not_before() -> None:
    made = journey()
    made.hear("bot:_blocked_", 3.0)
    (state,) = planned(made, EVERYWHERE, 3.5)
    assert (state.status, state.plan, state.lost, state.event, state.agent) == ("running", 1, (), "", "")
    assert (state.locations["bot"], state.values["Pbot"]) == ("going_b_to_a", -21)
    assert (state.clocks["Cbot"], state.clocks["Creach"]) == (0.0, 3.5)
    state = made.hear("bot_going_b_to_a2a", 4.0)
    assert (state.status, state.locations["bot"]) == ("running", "a"), "it was not far"


def test_the_way_back_begins_when_the_plan_has_it_begin() -> None:
    """The proof begins at moment 4; what is covered are plays from there."""
    made = journey()
    made.hear("bot:_blocked_", 3.0)
    assert made.mission.plan_request.ahead == 1.0
    (state,) = planned(made, EVERYWHERE, 6.5)
    assert (state.clocks["Cbot"], state.clocks["Creach"]) == (2.5, 6.5)


def test_a_plan_that_comes_too_late_for_the_way_back_is_made_again_with_more_time_ahead() -> None:
    cover = {"format": 1, "cover": [{"state": {"bot": "going_b_to_a"}, "wait": ["Cbot <= 4"]}]}
    made = journey()
    made.hear("bot:_blocked_", 3.0)
    assert planned(made, cover, 13.0) == []
    assert made.mission.plan_request.ahead == pytest.approx(10 * 1.3 + 1), "more than the way back takes"
    (state,) = planned(made, cover, 23.0)
    assert (state.status, state.locations["bot"], state.clocks["Cbot"]) == ("running", "going_b_to_a", 0.0)


def test_a_plan_that_does_not_cover_the_way_back_is_not_put_in_force() -> None:
    made = journey()
    made.hear("bot:_blocked_", 3.0)
    assert planned(made, NOWHERE, 3.5) == []
    assert made.mission.plan_request.turning == ("bot",)
    assert made.mission.state(3.5).locations["bot"] == "going_a_to_b"


def test_where_there_is_no_plan_with_its_return_one_without_the_robot_is_looked_for() -> None:
    made = journey()
    made.hear("bot:_blocked_", 3.0)
    assert made.mission.on_no_plan(made.mission.plan_request.number, "the dog bites it at a", 3.5) == []
    wanted = made.mission.plan_request
    assert (wanted.excused, wanted.turning, wanted.locations["bot"]) == (("bot",), (), "going_a_to_b")
    (state,) = made.mission.on_no_plan(wanted.number, "nobody else can", 4.0)
    assert state.status == "stopped" and "nobody else can" in state.reason


@pytest.mark.parametrize("text", [CHASE, RETURN.replace("kind: robot\n  initial: a", "kind: human\n  initial: a")])
def test_who_cannot_be_sent_back_is_lost(text: str) -> None:
    made = journey(text)
    made.hear("bot:_blocked_", 3.0)
    assert (made.mission.plan_request.excused, made.mission.plan_request.turning) == (("bot",), ())


def test_who_finds_a_way_blocked_that_was_blocked_before_is_lost() -> None:
    """As on its way back: it does not go to and fro."""
    made = journey()
    made.hear("bot:_blocked_", 3.0)
    planned(made, EVERYWHERE, 4.0)
    state = made.hear("bot:_blocked_", 5.0)
    assert (state.status, state.lost, state.locations["bot"]) == ("holding", ("bot",), "going_b_to_a")
    assert (made.mission.plan_request.excused, made.mission.plan_request.turning) == (("bot",), ())


def test_a_way_that_one_finds_blocked_is_open_to_others_until_it_is_reported_of_the_way() -> None:
    made = journey()
    made.hear("bot:_blocked_", 3.0)
    assert made.mission.ways.blocked == {("a", "b", "bot")}
    assert planned(made, EVERYWHERE, 4.0)[-1].status == "running"
    state = made.hear("going_b_to_a:_blocked_", 5.0)
    assert (state.status, made.mission.plan_request.blocked) == ("holding", (("a", "b"), ("a", "b", "bot")))
    assert state.reason == "the way between {a} and {b} is blocked; looking for another plan"
    assert planned(made, EVERYWHERE, 5.5)[-1].status == "running"
    assert made.hear("going_a_to_b:_free_", 6.0) is None and made.mission.ways.blocked == set()


def test_what_is_blocked_for_all_is_blocked_for_each() -> None:
    made = journey()
    made.hear("going_a_to_b:_blocked_", 2.5)
    planned(made, EVERYWHERE, 3.0)
    made.hear("bot:_blocked_", 4.0)
    assert made.mission.plan_request.turning == (), "it is said already that nobody gets through"
    planned(made, EVERYWHERE, 5.0)
    assert made.mission.status == "running"


def test_a_plan_may_send_others_along_a_way_that_one_cannot_take_but_not_that_one() -> None:
    for agent, status in (("dog", "holding"), ("bot", "stopped")):
        made = journey()
        made.hear("bot:_blocked_", 3.0)
        plan = answer(EVERYWHERE)
        plan["strategies"]["two"] = {
            "strategy": [{"state": {}, "commands": [{"agent": agent, "to": "going_a_to_b"}]}]
        }
        made.mission.on_plan(made.mission.plan_request.number, plan, 3.5)
        if status == "stopped":  # the next request is for a plan without the robot
            made.mission.on_plan(made.mission.plan_request.number, plan, 3.6)
            assert "it uses the way between {a} and {b}, which is blocked" in made.mission.reason
        assert (made.mission.status, made.mission.proposal is None) == (status, status == "stopped")


# Stuck ----------------------------------------------------------------------------------------------------------------


def test_a_robot_that_is_stuck_goes_back_and_its_way_stays_open() -> None:
    made = journey()
    state = made.hear("bot:_stuck_ on its way to {b}: it moves to and fro, in 3 attempts", 3.0)
    gave_up = "{bot} gave up on its way to {b}: it moves to and fro, in 3 attempts; looking for another plan"
    assert (state.status, state.lost, state.reason) == ("holding", ("bot",), gave_up)
    wanted = made.mission.plan_request
    assert (wanted.excused, wanted.blocked, wanted.turning) == ((), (), ("bot",))
    assert made.hear("bot:_stuck_", 3.2) is None, "its report comes again"
    (state,) = planned(made, EVERYWHERE, 3.5)
    assert (state.status, state.lost, state.locations["bot"]) == ("running", (), "going_b_to_a")
    assert made.mission.ways.blocked == set(), "it may be sent there once more"


def test_who_is_stuck_a_second_time_does_not_get_that_way_again_and_then_it_is_lost() -> None:
    made = journey()
    made.hear("bot:_stuck_", 3.0)
    planned(made, EVERYWHERE, 3.5)
    state = made.hear("bot:_stuck_", 5.0)
    assert state.reason == "{bot} cannot go on; looking for another plan"
    wanted = made.mission.plan_request
    assert (wanted.excused, wanted.blocked, wanted.turning) == ((), (("a", "b", "bot"),), ("bot",))
    (state,) = planned(made, EVERYWHERE, 5.5)
    assert state.locations["bot"] == "going_a_to_b"
    made.hear("bot:_stuck_", 7.0)
    assert (made.mission.plan_request.excused, made.mission.plan_request.turning) == (("bot",), ())


def test_a_way_that_is_free_again_may_be_tried_as_often_as_before() -> None:
    made = journey()
    made.hear("bot:_stuck_", 3.0)
    planned(made, EVERYWHERE, 3.5)
    made.hear("going_a_to_b:_free_", 4.0)
    made.hear("bot:_stuck_", 5.0)
    assert made.mission.plan_request.blocked == ()


def test_only_who_moves_is_stuck() -> None:
    made = journey()
    made.hear("bot_going_a_to_b2b", 5.5)
    for word in ("bot:_stuck_", "going_a_to_b:_stuck_", "nobody:_stuck_"):
        assert made.hear(word, 6.0) is None
        assert made.logs[-1][0] == "warn" and "expected the name of a movement" in made.logs[-1][1]
    assert made.mission.ways.blocked == set() and made.mission.ways.turns == {}


def test_who_fails_before_it_could_go_back_is_lost() -> None:
    made = journey()
    first = made.hear("bot:_blocked_", 3.0) and made.mission.plan_request.number
    state = made.hear("bot:_failed_", 3.5)
    assert state.reason == "{bot} has failed; looking for another plan"
    assert made.mission.plan_request.number > first and made.mission.plan_request.excused == ("bot",)
    assert made.hear("bot:_failed_", 3.6) is None


def test_who_arrives_before_it_could_go_back_has_arrived() -> None:
    made = journey()
    made.hear("bot:_blocked_", 3.0)
    number = made.mission.plan_request.number
    state = made.hear("bot_going_a_to_b2b", 5.5)
    assert (state.lost, state.locations["bot"]) == ((), "b")
    assert made.mission.plan_request.turning == () and made.mission.plan_request.number > number
    made.mission.on_plan(number, answer(EVERYWHERE), 6.0)
    assert made.mission.proposal is None


def test_a_new_observer_has_the_robot_on_its_way_back(tmp_path: Path) -> None:
    def life() -> Journal:
        log = lambda level, text: None
        options = {"on_uncovered": "plan", "controllers": ["one"]}
        mission = Mission(Model(read(RETURN)), read_cover(read(COVER)), log, **options)
        mission.journal = Journal(mission, str(tmp_path / "journal-x.jsonl"), {"launch": "x"}, log)
        return mission

    before = life()
    calls = [("hear", "_start_"), ("hear", "bot_a2b"), ("hear", "bot:_blocked_"), ("planned", 1, answer(EVERYWHERE))]
    for moment, call in enumerate([*calls, ("hear", "one:_plan_@1"), ("hear", "going_a_to_b:_free_")]):
        before.journal.call(*call, now=1000.0 + 2 * moment)
        after = life()
        assert after.state(2000.0) == before.state(2000.0) and after.plan_request == before.plan_request
        assert after.ways.revision() == before.ways.revision()
    assert before.state(2000.0).locations["bot"] == "going_b_to_a"
