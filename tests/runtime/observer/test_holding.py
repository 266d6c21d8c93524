"""The observer holds the mission where a robot, a controller or a plan is missing, and goes on in one step."""

from __future__ import annotations

import json
from typing import Any, Dict, List

import pytest

from pursue_runtime.model import Model
from pursue_runtime.state import format_state, parse_state
from pursue_runtime.strategy import read_cover
from tests.runtime.models import commanding
from tests.runtime.observer.test_mission import CHASE, Journey
from tests.runtime.texts import read

COVER = """
format: 1
cover:
- state: {bot: a}
  wait: [Cbot <= 3]
- state: {bot: going_a_to_b}
  wait: [Cbot <= 4]
- state: {bot: b, Sopen: 0}
  wait: [Cbot - Creach <= -5 && Cbot <= 20]
- state: {bot: b, Sopen: 1}
  wait: [always]
"""
EVERYWHERE = {"format": 1, "cover": [{"state": {}, "wait": ["always"]}]}
MODEL = Model(read(CHASE))
NOWHERE = {"format": 1, "cover": []}


def journey(**options: Any) -> Journey:
    """A mission that plans again, at its start at moment 0."""
    given = {"on_uncovered": "plan", "controllers": ("one", "two"), "lost_after": 8.0}
    made = Journey(CHASE, COVER, **{**given, **options})
    made.hear("_start_", 0.0)
    return made


def answer(cover: Dict[str, Any]) -> Dict[str, Any]:
    """A plan as the planner finds it (through JSON, as it comes)."""
    answered: Dict[str, Any] = json.loads(json.dumps({"format": 1, "won": True, "strategies": {"one": {}, "two": {}},
                                                      "people": None, "cover": commanding(cover, MODEL)}))
    return answered


def uncovered() -> Journey:
    """The robot was faster than its model: the strategy does not know what to do, at moment 4."""
    made = journey()
    made.hear("bot_a2b", 2.0)
    assert made.mission.status == "running"
    state = made.hear("bot_going_a_to_b2b", 4.0)
    assert (state.status, state.seq) == ("holding", 3) and "than the strategy expects; {bot} is at {b}" in state.reason
    return made


def planned(made: Journey, cover: Dict[str, Any], now: float) -> List[Any]:
    """The planner answers, and both controllers have the plan."""
    number = made.mission.plan_request.number
    assert made.mission.on_plan(number, answer(cover), now) == []
    made.mission.on_word(f"one:_plan_@{number}", now)
    states: List[Any] = made.mission.on_word(f"two:_plan_@{number}", now)
    return states


# Planning again -------------------------------------------------------------------------------------------------------


def test_a_plan_is_wanted_from_where_the_mission_is() -> None:
    made = uncovered()
    wanted = made.mission.plan_request
    assert wanted.locations["bot"] == "b" and wanted.values["Pbot"] == 2 and wanted.excused == ()
    assert (wanted.clocks["Cbot"], wanted.clocks["Creach"], wanted.stamp) == (0.0, 4.0, 4.0)
    assert wanted.ahead == 1.0


def test_a_plan_tells_everybody_from_where_on_its_time_counts() -> None:
    made = uncovered()
    takes = {"most": 12.5, "early": 1.0, "late": 2.0}
    assert made.mission.on_plan(made.mission.plan_request.number, {**answer(EVERYWHERE), "takes": takes}, 4.2) == []
    assert made.mission.proposal["takes"] == {**takes, "stamp": 4.0, "ahead": 1.0, "excused": []}


def test_while_the_mission_holds_commands_are_dropped_and_reports_count() -> None:
    made = uncovered()
    assert made.hear("dog:catch@3", 4.5) is None and made.mission.counts["held"] == 1
    state = made.hear("thief:thief_leaves", 11.0)
    assert (state.seq, state.status, state.locations["thief"]) == (4, "holding", "gone")


def test_a_plan_is_in_force_for_everybody_in_one_step() -> None:
    made = uncovered()
    number = made.mission.plan_request.number
    assert made.mission.on_plan(number, answer(EVERYWHERE), 4.2) == []
    assert made.mission.plan_request is None and made.mission.proposal["plan"] == number
    assert made.mission.on_word(f"one:_plan_@{number}", 4.3) == [] and made.mission.status == "holding"
    (state,) = made.mission.on_word(f"two:_plan_@{number}", 4.4)
    assert (state.status, state.seq, state.plan, state.event) == ("running", 4, number, "")
    assert made.mission.proposal is None
    assert parse_state(format_state(state)).plan == number


def test_a_command_from_before_the_new_plan_is_stale() -> None:
    made = uncovered()
    planned(made, EVERYWHERE, 4.4)
    assert made.hear("dog:catch@3", 4.5) is None and made.mission.counts["stale"] == 1
    assert made.hear("dog:catch@4", 4.5).seq == 5


def test_an_event_while_a_plan_is_looked_for_makes_it_look_from_there() -> None:
    made = uncovered()
    first = made.mission.plan_request.number
    made.hear("thief:thief_leaves", 11.0)
    assert made.mission.plan_request.number > first and made.mission.plan_request.locations["thief"] == "gone"
    assert made.mission.on_plan(first, answer(EVERYWHERE), 11.1) == [] and made.mission.proposal is None


def test_an_event_after_the_plan_was_found_makes_it_look_again() -> None:
    made = uncovered()
    number = made.mission.plan_request.number
    made.mission.on_plan(number, answer(EVERYWHERE), 4.2)
    made.hear("thief:thief_leaves", 11.0)
    assert made.mission.proposal is None and made.mission.plan_request.number == number + 1
    for node in ("one", "two"):
        assert made.mission.on_word(f"{node}:_plan_@{number}", 12.0) == []


def test_an_event_that_leads_back_to_what_the_strategy_knows_ends_the_search() -> None:
    made = uncovered()
    assert made.hear("dog:catch", 4.5).status == "running"
    assert made.mission.plan_request is None


def test_a_mission_that_is_over_wants_no_plan() -> None:
    made = uncovered()
    made.hear("_stop_", 4.5)
    assert made.mission.plan_request is None


def test_a_plan_that_comes_too_late_is_made_again_with_more_time_ahead() -> None:
    made = uncovered()
    ahead = made.mission.plan_request.ahead
    for late in range(1, 5):
        assert planned(made, NOWHERE, 4.0 + 3.0 * late) == []
        assert made.mission.plan_request.ahead > ahead
    states = planned(made, NOWHERE, 30.0)
    assert states[-1].status == "stopped" and "too late" in states[-1].reason


def test_an_event_does_not_make_it_forget_how_long_a_plan_takes() -> None:
    made = uncovered()
    ahead = made.mission.plan_request.ahead
    assert planned(made, NOWHERE, 7.0) == []
    longer = made.mission.plan_request.ahead
    made.hear("thief:thief_leaves", 11.0)
    made.hear("going_a_to_b:_blocked_", 11.5)
    assert made.mission.plan_request.locations["thief"] == "gone" and made.mission.plan_request.blocked
    assert made.mission.plan_request.ahead == longer > ahead


def test_where_there_is_no_plan_it_stops_and_says_why() -> None:
    made = uncovered()
    (state,) = made.mission.on_no_plan(made.mission.plan_request.number, "the thief is faster", 4.5)
    assert state.status == "stopped" and "strategy expects" in state.reason and "the thief is faster" in state.reason


def test_a_search_that_takes_long_goes_on_and_the_reason_names_the_parameter() -> None:
    made = uncovered()
    number = made.mission.plan_request.number
    (state,) = made.mission.on_long_search(number, 10.0, 14.0)
    assert (state.status, state.seq) == ("holding", 4) and made.mission.plan_request.number == number
    assert state.reason.endswith("; no other plan was found in 10 s (~planning_limit), still looking")
    (state,) = made.mission.on_long_search(number, 20.0, 24.0)
    assert "in 20 s (~planning_limit)" in state.reason
    assert made.mission.on_long_search(number, 20.0, 25.0) == []
    assert planned(made, EVERYWHERE, 26.0)[-1].status == "running"


def test_a_search_that_begins_anew_has_taken_no_time() -> None:
    made = uncovered()
    first = made.mission.plan_request.number
    made.mission.on_long_search(first, 10.0, 14.0)
    state = made.hear("thief:thief_leaves", 15.0)
    assert state.reason.endswith("; looking for another plan")
    assert made.mission.on_long_search(first, 20.0, 24.0) == [], "that was another search"


def test_a_search_that_was_long_and_finds_that_there_is_no_plan_stops() -> None:
    made = uncovered()
    made.mission.on_long_search(made.mission.plan_request.number, 10.0, 14.0)
    (state,) = made.mission.on_no_plan(made.mission.plan_request.number, "the thief is faster", 15.0)
    assert state.status == "stopped" and "the thief is faster" in state.reason


@pytest.mark.parametrize("cover", [None, {"format": 1}, {"format": 1, "cover": [{"state": {}, "wait": ["?"]}]}])
def test_a_plan_that_cannot_be_read_is_none(cover: Any) -> None:
    made = uncovered()
    (state,) = made.mission.on_plan(made.mission.plan_request.number, {**answer(NOWHERE), "cover": cover}, 4.2)
    assert state.status == "stopped" and "cannot be read" in state.reason


def test_time_that_leaves_what_the_strategy_knows_is_noticed() -> None:
    """No command came (its controller is dead, say): time passes the last moment for one."""
    made = journey()
    moment = made.mission.next_moment(0.0)
    assert moment == pytest.approx(3.0 + 2.0 + 0.1)
    assert made.mission.on_time(moment - 0.5) == []
    (state,) = made.mission.on_time(moment)
    assert (state.status, state.seq) == ("holding", 2)


# Robots ---------------------------------------------------------------------------------------------------------------


def test_who_is_late_for_too_long_is_lost_and_a_plan_without_it_is_wanted() -> None:
    made = journey(on_uncovered="plan")
    made.hear("bot_a2b", 2.0)
    moments = []
    while not made.mission.lost and len(moments) < 5:
        moments.append(made.mission.next_moment(moments[-1] if moments else 2.0))
        made.mission.on_time(moments[-1])
    assert moments[0] == pytest.approx(6.1) and moments[-1] == pytest.approx(6.0 + 8.0)
    assert made.mission.plan_request.excused == ("bot",)
    (state,) = made.mission.on_no_plan(made.mission.plan_request.number, "nobody else can", 15.0)
    assert state.status == "stopped" and "{bot} is late by 8" in state.reason


def test_who_is_only_late_is_waited_for_where_there_is_no_plan_without_it() -> None:
    made = journey()
    made.hear("bot_a2b", 2.0)
    made.mission.on_time(6.1)
    made.mission.on_time(8.2)  # beyond what the strategy knows
    assert made.mission.status == "holding" and made.mission.plan_request.excused == ("bot",)
    assert made.mission.on_no_plan(made.mission.plan_request.number, "nobody else can", 9.0) == []
    (state,) = made.mission.on_no_plan(made.mission.plan_request.number, "nor with it", 9.5)
    assert state.status == "holding" and state.reason.endswith("; no other plan: nor with it; waiting for {bot}")
    assert made.mission.plan_request is None
    assert made.hear("bot_going_a_to_b2b", 10.0).status == "running"


def late_bot() -> Journey:
    """A mission whose bot is late since moment 6, and counts as lost from moment 14 on; there is no plan without it."""
    made = journey()
    made.hear("bot_a2b", 2.0)
    made.mission.on_time(6.1)
    made.mission.on_time(8.2)
    first = made.mission.plan_request
    assert (first.excused, first.awaited) == (("bot",), None)
    assert made.mission.on_no_plan(first.number, "nobody else can", 9.0) == []
    return made


def test_where_there_is_no_plan_without_who_is_late_one_relies_on_it_until_it_counts_as_lost() -> None:
    made = late_bot()
    wanted = made.mission.plan_request
    assert (wanted.excused, wanted.stamp, wanted.awaited) == ((), 9.0, {"bot": pytest.approx(5.0)})
    (state,) = planned(made, EVERYWHERE, 9.5)
    assert (state.status, state.plan, state.late) == ("running", wanted.number, ("bot",))
    assert made.mission.in_force["awaited"] == ["bot"]
    assert any("relies on bot, which is late" in text for _, text in made.logs)
    state = made.hear("bot_going_a_to_b2b", 10.0)
    assert (state.status, state.late) == ("running", ())


def test_once_it_counts_as_lost_nothing_is_expected_of_it() -> None:
    made = late_bot()
    planned(made, EVERYWHERE, 9.5)
    (state,) = made.mission.on_time(14.0)
    assert (state.status, state.lost) == ("holding", ("bot",))
    assert (made.mission.plan_request.excused, made.mission.plan_request.awaited) == (("bot",), None)


def test_after_an_event_a_plan_without_who_is_late_is_looked_for_first() -> None:
    made = late_bot()
    made.hear("thief_leaves", 11.0)
    assert (made.mission.plan_request.excused, made.mission.plan_request.awaited) == (("bot",), None)
    made.mission.on_no_plan(made.mission.plan_request.number, "nobody else can", 12.0)
    assert made.mission.plan_request.awaited == {"bot": pytest.approx(2.0)}


CATCH = {"do": "catch", "agent": "dog", "from": "b", "to": "b", "when": ["Cdog > 1"]}
MEANWHILE = {"format": 1, "cover": [{"state": {}, "wait": ["always"], "commands": [CATCH]}]}
"""A plan that waits everywhere, and one with a command for the dog."""


def waiting(cover: Any = EVERYWHERE) -> Journey:
    """A mission whose plan waits for the bot, which is late since moment 6 and counts as lost from moment 14 on."""
    made = journey()
    made.mission._cover = read_cover(cover)
    made.hear("bot_a2b", 2.0)
    assert made.mission.plan_request is None
    assert made.mission.on_time(6.1) == [] and made.mission.late == {"bot"}
    return made


def test_while_the_plan_waits_for_who_is_late_one_is_looked_for_by_which_others_do_something() -> None:
    made = waiting()
    wanted = made.mission.plan_request
    assert (made.mission.status, wanted.excused, list(wanted.awaited)) == ("running", (), ["bot"])
    assert made.mission.on_plan(wanted.number, {**answer(EVERYWHERE), "cover": MEANWHILE}, 7.0) == []
    made.hear(f"one:_plan_@{wanted.number}", 7.0)
    state = made.hear(f"two:_plan_@{wanted.number}", 7.0)
    assert (state.status, state.plan, state.late) == ("running", wanted.number, ("bot",))
    assert made.mission.plan_request is None, "now there is something to do"
    assert made.hear("catch", 7.5).event == "catch"


def test_a_plan_by_which_nobody_does_anything_meanwhile_is_not_put_in_force() -> None:
    made = waiting()
    number = made.mission.plan_request.number
    assert made.mission.on_plan(number, {**answer(EVERYWHERE), "cover": EVERYWHERE}, 7.0) == []
    assert made.mission.proposal is None and made.mission.status == "running" and made.mission.plan == 0
    assert made.mission.on_time(8.0) == [] and made.mission.plan_request is None, "it is not looked for again"
    (state,) = made.mission.on_time(14.2)
    assert (state.status, state.lost) == ("holding", ("bot",)) and made.mission.plan_request.excused == ("bot",)


def test_where_there_is_none_the_mission_goes_on_waiting() -> None:
    made = waiting()
    assert made.mission.on_no_plan(made.mission.plan_request.number, "not even with it", 7.0) == []
    assert (made.mission.status, made.mission.reason, made.mission.plan_request) == ("running", "", None)


def test_who_arrives_meanwhile_is_not_waited_for_any_more() -> None:
    made = waiting()
    number = made.mission.plan_request.number
    assert made.hear("bot_going_a_to_b2b", 6.5).status == "running" and made.mission.plan_request is None
    assert made.mission.on_plan(number, answer(MEANWHILE), 7.0) == [] and made.mission.proposal is None


def test_where_others_have_something_to_do_no_plan_is_looked_for() -> None:
    assert waiting(MEANWHILE).mission.plan_request is None


def test_who_is_lost_is_not_awaited() -> None:
    made = journey()
    made.hear("bot_a2b", 2.0)
    made.hear("bot:_failed_", 3.0)
    (state,) = made.mission.on_no_plan(made.mission.plan_request.number, "nobody else can", 4.0)
    assert state.status == "stopped"


def test_a_robot_that_has_failed_is_lost_at_once() -> None:
    made = journey()
    made.hear("bot_a2b", 2.0)
    state = made.hear("bot:_failed_", 3.0)
    assert (state.status, state.lost) == ("holding", ("bot",)) and "{bot} has failed" in state.reason
    assert parse_state(format_state(state)).lost == ("bot",)
    assert made.hear("bot:_failed_", 3.5) is None


def test_a_robot_that_is_not_under_way_cannot_fail() -> None:
    made = journey()
    assert made.hear("bot:_failed_", 1.0) is None and made.hear("nobody:_failed_", 1.0) is None
    assert made.mission.counts["impossible"] == 2 and not made.mission.lost


def test_a_lost_robot_that_arrives_is_back() -> None:
    made = journey()
    made.hear("bot_a2b", 2.0)
    made.hear("bot:_failed_", 3.0)
    planned(made, EVERYWHERE, 3.5)
    assert made.mission.status == "running" and set(made.mission.lost) == {"bot"}
    state = made.hear("bot_going_a_to_b2b", 30.0)
    assert state.lost == () and state.status == "running"


# Ways -----------------------------------------------------------------------------------------------------------------


def test_a_robot_that_finds_its_way_blocked_is_lost_and_the_plan_is_to_avoid_that_way() -> None:
    made = journey()
    made.hear("bot_a2b", 2.0)
    state = made.hear("bot:_blocked_", 3.0)
    assert (state.status, state.lost) == ("holding", ("bot",))
    assert state.reason == "{bot} has found that the way between {a} and {b} is blocked; looking for another plan"
    wanted = made.mission.plan_request
    assert (wanted.excused, wanted.blocked) == (("bot",), (("a", "b", "bot"),))
    assert made.hear("bot:_blocked_", 3.5) is None
    assert planned(made, EVERYWHERE, 4.0)[-1].status == "running" and made.mission.ways.blocked == {("a", "b", "bot")}


def test_anybody_may_report_that_a_way_is_blocked() -> None:
    made = journey()
    state = made.hear("going_a_to_b:_blocked_", 1.0)
    assert (state.status, state.lost) == ("holding", ())
    assert state.reason == "the way between {a} and {b} is blocked; looking for another plan"
    assert made.mission.plan_request.blocked == (("a", "b"),) and made.mission.plan_request.excused == ()
    assert planned(made, EVERYWHERE, 1.5)[-1].status == "running"
    assert made.hear("going_a_to_b:_blocked_", 2.0) is None, "the plan avoids it"


def test_a_way_that_is_blocked_while_a_plan_is_looked_for_is_part_of_another_request() -> None:
    made = uncovered()
    first = made.mission.plan_request.number
    made.mission.on_plan(first, answer(EVERYWHERE), 4.2)
    made.hear("going_a_to_b:_blocked_", 4.3)
    assert made.mission.proposal is None and made.mission.plan_request.number == first + 1
    assert made.mission.plan_request.blocked == (("a", "b"),)


def test_a_plan_of_a_planner_that_does_not_know_of_blocked_ways_is_not_used() -> None:
    made = journey()
    made.hear("going_a_to_b:_blocked_", 1.0)
    plan = answer(EVERYWHERE)
    commands = [{"agent": "bot", "to": to} for to in ("b", "going_b_to_a")]
    plan["strategies"]["two"] = {"strategy": [{"state": {}, "commands": commands}]}
    (state,) = made.mission.on_plan(made.mission.plan_request.number, plan, 1.5)
    assert state.status == "stopped" and "it uses the way between {a} and {b}, which is blocked" in state.reason


@pytest.mark.parametrize("strategies", [[], {"one": []}, {"one": {"strategy": [{}]}}, {"one": {"strategy": 7}}])
def test_a_plan_whose_commands_cannot_be_read_is_not_used_where_a_way_is_blocked(strategies: Any) -> None:
    made = journey()
    made.hear("going_a_to_b:_blocked_", 1.0)
    number = made.mission.plan_request.number
    (state,) = made.mission.on_plan(number, {**answer(EVERYWHERE), "strategies": strategies}, 1.5)
    assert state.status == "stopped" and "cannot be read" in state.reason


def test_a_way_that_is_free_again_needs_no_plan() -> None:
    made = journey()
    made.hear("going_a_to_b:_blocked_", 1.0)
    state = made.hear("going_a_to_b:_free_", 1.5)
    assert (state.status, state.reason, made.mission.plan_request) == ("running", "", None)
    made.hear("going_a_to_b:_blocked_", 1.6)
    planned(made, EVERYWHERE, 1.7)
    revision = made.mission.revision()
    assert made.hear("going_a_to_b:_free_", 1.8) is None, "a plan that avoids it is still one"
    assert made.mission.ways.blocked == set() and made.mission.revision() != revision


@pytest.mark.parametrize("who", ["bot", "dog", "rule", "nobody", "going_a_to_c", "a"])
def test_where_nobody_moves_no_way_can_be_blocked(who: str) -> None:
    made = journey()
    assert made.hear(f"{who}:_blocked_", 1.0) is None and made.hear(f"{who}:_free_", 1.0) is None
    assert made.mission.counts["impossible"] == 2 and not made.mission.ways.blocked and not made.mission.lost


# Controllers ----------------------------------------------------------------------------------------------------------


def test_the_mission_holds_while_a_controller_is_silent() -> None:
    made = journey()
    (state,) = made.mission.on_controller_silent("one", 1.0)
    assert (state.status, state.seq, state.reason) == ("holding", 2, "one is silent")
    assert made.hear("bot:bot_a2b@2", 1.5) is None
    assert made.mission.on_controller_silent("one", 1.6) == []
    (state,) = made.mission.on_controller_back("one", 2.0)
    assert (state.status, state.seq, state.reason) == ("running", 3, "")


def test_who_comes_back_too_late_for_the_strategy_finds_a_new_plan() -> None:
    made = journey()
    made.mission.on_controller_silent("one", 1.0)
    made.mission.on_controller_back("one", 9.0)
    assert made.mission.status == "holding" and made.mission.plan_request is not None
    assert planned(made, EVERYWHERE, 9.5)[-1].status == "running"


def test_a_plan_does_not_end_the_waiting_for_a_silent_controller() -> None:
    made = uncovered()
    made.mission.on_controller_silent("one", 4.1)
    number = made.mission.plan_request.number
    made.mission.on_plan(number, answer(EVERYWHERE), 4.2)
    made.hear(f"two:_plan_@{number}", 4.3)
    assert made.mission.status == "holding"
    made.mission.on_controller_back("one", 5.0)
    assert made.mission.status == "holding"
    assert made.hear(f"one:_plan_@{number}", 5.1).status == "running"


def test_a_mission_that_holds_can_be_stopped_and_still_be_won() -> None:
    assert uncovered().hear("_stop_", 5.0).status == "stopped"
    made = uncovered()
    made.hear("reachObj_going_initial_location2unlocked", 7.0)
    assert made.hear("dog:catch", 8.0).status == "won"
