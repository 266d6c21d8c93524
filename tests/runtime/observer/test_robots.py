"""No action begins with a robot that is not in its place; a robot that a person stopped waits for a person."""

# ruff: noqa: E501 (automata, one edge per line)

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime.event_words import RobotReport, format_report, parse_report, parse_word
from pursue_runtime.model import Model
from pursue_runtime.sentences import in_words
from pursue_runtime.state import format_state, parse_state
from tests.runtime.models import commanding
from tests.runtime.observer.test_mission import Journey
from tests.runtime.texts import read

EVERYWHERE = "{format: 1, cover: [{state: {}, wait: [always]}]}"

EVERYWHERE_DATA = {"format": 1, "cover": [{"state": {}, "wait": ["always"]}]}

HANDOVER = """
format: 1
scenario: handover
clocks: [Cgiver, Ctaker, Creach]
variables: {Pgiver: 1, Ptaker: 1, Pother: 1}
automata:
- name: giver
  kind: robot
  initial: mid
  locations: {mid: [], going_mid_to_end: [Cgiver <= 4], end: [], doing_load_in_mid: [Cgiver <= 5]}
  edges:
  - {from: mid, to: mid, word: handOver, sync: send, when: [Cgiver > 1], if: [[Ptaker=1, Pother=1]], reset: [Cgiver], controllable: true}
  - {from: mid, to: doing_load_in_mid, word: load, sync: send, when: [Cgiver > 1], set: {Pgiver: 11}, reset: [Cgiver], controllable: true}
  - {from: doing_load_in_mid, to: mid, word: loadDONE, sync: send, set: {Pgiver: 1}, reset: [Cgiver], controllable: false}
  - {from: mid, to: going_mid_to_end, word: giver_mid2end, sync: send, when: [Cgiver > 1], set: {Pgiver: -12}, reset: [Cgiver], controllable: true}
  - {from: going_mid_to_end, to: end, word: giver_going_mid_to_end2end, sync: own, when: [Cgiver > 3], set: {Pgiver: 2}, reset: [Cgiver], controllable: false}
- name: taker
  kind: robot
  initial: mid
  locations: {mid: []}
  edges: []
- name: other
  kind: robot
  initial: mid
  locations: {mid: [], going_mid_to_end: []}
  edges:
  - {from: mid, to: going_mid_to_end, word: other_mid2end, sync: send, set: {Pother: -12}, controllable: true}
- name: reachObj
  kind: reach
  initial: unlocked
  locations: {unlocked: [], win: []}
  edges:
  - {from: unlocked, to: win, word: handOver, sync: receive, controllable: true}
objective: {kind: reach, goal: [reachObj, win], bad: null}
"""


@pytest.fixture
def made() -> Journey:
    """A mission in which giver hands over to taker or other, all of them at mid."""
    journey = Journey(HANDOVER, EVERYWHERE, on_uncovered="plan", lost_after=8.0)
    journey.hear("_start_", 0.0)
    return journey


# In its place ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("command", ["handOver", "load"])
def test_no_action_begins_with_a_robot_that_is_not_in_its_place(made: Journey, command: str) -> None:
    state = made.hear("giver:_displaced_ is 5.0 m from mid", 2.0)
    assert (state.status, state.displaced, state.returning) == ("running", ("giver",), ())
    state = made.hear(f"giver:{command}@{state.seq}", 2.1)
    assert (state.status, state.returning) == ("holding", ("giver",)) and state.locations["giver"] == "mid"
    assert state.reason == "{giver} is 5.0 m from mid, where the state has it: it is sent back"
    state = made.hear("giver:_back_", 9.0)
    assert (state.status, state.displaced, state.returning, state.reason) == ("running", (), (), "")
    state = made.hear(f"giver:{command}@{state.seq}", 9.1)
    assert state.event == command


def test_a_mission_is_not_won_by_what_a_robot_does_elsewhere(made: Journey) -> None:
    state = made.hear("giver:_displaced_", 2.0)
    for _ in range(3):
        state = made.hear(f"giver:handOver@{state.seq}", 3.0) or state
        assert state.status == "holding" and state.locations["reachObj"] == "unlocked"
    state = made.hear("giver:_back_", 4.0)
    state = made.hear(f"giver:handOver@{state.seq}", 4.1)
    assert made.hear(f"giver:_order_@{state.seq}", 4.2).status == "won"


def test_a_command_that_was_early_is_refused_too_when_it_is_due(made: Journey) -> None:
    state = made.hear("giver:_displaced_", 0.9)
    assert made.hear(f"giver:load@{state.seq}", 0.95) is None
    moment, state = made.tick_from(0.95)
    assert moment == pytest.approx(1.0, abs=1e-6) and (state.status, state.returning) == ("holding", ("giver",))


def test_a_partner_has_to_be_in_its_place_too_but_one_is_enough(made: Journey) -> None:
    state = made.hear("taker:_displaced_", 2.0)
    assert made.hear(f"giver:handOver@{state.seq}", 2.1).locations["reachObj"] == "win"


def test_without_any_partner_in_its_place_the_mission_waits(made: Journey) -> None:
    made.hear("taker:_displaced_", 2.0)
    state = made.hear("other:other_mid2end", 2.1)
    state = made.hear(f"giver:handOver@{state.seq}", 2.2)
    assert (state.status, state.returning) == ("holding", ("taker",))
    assert made.hear("taker:_back_", 5.0).status == "running"


def test_a_robot_may_set_off_from_elsewhere(made: Journey) -> None:
    state = made.hear("giver:_displaced_", 2.0)
    state = made.hear(f"giver:giver_mid2end@{state.seq}", 2.1)
    assert (state.event, state.displaced, state.status) == ("giver_mid2end", (), "running")


def test_what_a_person_reports_counts(made: Journey) -> None:
    made.hear("giver:_displaced_", 2.0)
    assert made.hear("load", 2.1).event == "load"


def test_a_robot_that_is_displaced_in_its_action_returns_at_once(made: Journey) -> None:
    state = made.hear("giver:load@1", 2.0)
    state = made.hear("giver:_displaced_", 2.1)
    assert (state.status, state.returning) == ("holding", ("giver",))
    assert made.hear("giver:_back_", 3.0).status == "running"


def test_a_robot_that_cannot_return_is_lost(made: Journey) -> None:
    state = made.hear("giver:_displaced_ is away", 2.0)
    made.hear(f"giver:load@{state.seq}", 2.1)
    state = made.hear("giver:_failed_ on its way back to mid: aborted", 5.0)
    assert (state.lost, state.displaced, state.returning) == (("giver",), (), ())
    assert "{giver} has failed on its way back to mid: aborted; looking for another plan" in state.reason


def test_a_lost_robot_that_cannot_return_again_does_not_hold_the_mission(made: Journey) -> None:
    made.hear("taker:_displaced_", 2.0)
    made.hear("other:other_mid2end", 2.1)
    made.hear("giver:handOver@3", 2.2)
    state = made.hear("taker:_failed_", 3.0)
    assert state.lost == ("taker",)
    number = made.mission.plan_request.number
    made.mission.on_plan(number, {"strategies": {}, "people": None, "cover": commanding(EVERYWHERE_DATA, Model(read(HANDOVER)))}, 3.1)
    assert made.mission.status == "running"
    state = made.hear("taker:_displaced_", 3.2)
    state = made.hear(f"giver:handOver@{state.seq}", 3.3)
    assert (state.status, state.returning) == ("holding", ("taker",))
    state = made.hear("taker:_failed_", 4.0)
    assert (state.status, state.returning) == ("running", ())


# Held -----------------------------------------------------------------------------------------------------------------


def test_a_held_robot_waits_for_a_person_and_never_counts_as_lost(made: Journey) -> None:
    made.hear("giver:giver_mid2end@1", 2.0)
    state = made.hear("giver:_held_ on its way to end: preempted by another node", 3.0)
    assert (state.status, state.held) == ("holding", ("giver",))
    assert state.reason == "{giver} on its way to end: preempted by another node; publish giver:_resume_ to continue"
    for _ in range(5):
        moment = made.mission.next_moment(3.0)
        if moment is not None:
            made.mission.on_time(moment)
    made.mission.on_time(500.0)
    assert made.mission.status == "holding" and made.mission.plan_request is None and not made.mission.lost
    assert made.mission.state(500.0).late == ("giver",)
    state = made.hear("giver:_resume_", 500.0)
    assert (state.held, state.lost) == ((), ())


def test_held_and_displaced_are_reported_once(made: Journey) -> None:
    made.hear("giver:giver_mid2end@1", 2.0)
    state = made.hear("giver:_held_", 3.0)
    assert made.hear("giver:_held_", 3.5) is None and made.mission.seq == state.seq
    assert made.hear("taker:_displaced_", 3.5).seq == state.seq + 1
    assert made.hear("taker:_displaced_", 3.6) is None


@pytest.mark.parametrize(
    "word",
    ["giver:_held_", "giver:_resume_", "reachObj:_displaced_", "nobody:_held_", "nobody:_back_", "taker:_failed_"],
)
def test_reports_that_cannot_be_change_nothing(made: Journey, word: str) -> None:
    assert made.hear(word, 2.0) is None
    assert made.mission.counts["impossible"] == 1 and made.mission.seq == 1


def test_the_reports_are_in_the_journal(made: Journey) -> None:
    for word in ("giver:_displaced_ away", "giver:load", "taker:_displaced_", "giver:_held_", "giver:_resume_", "giver:_back_"):
        before = made.mission.revision()
        made.hear(word, 2.0)
        assert made.mission.revision() != before, word


def test_the_state_has_them_as_text() -> None:
    journey = Journey(HANDOVER)
    journey.hear("_start_", 0.0)
    journey.hear("giver:_displaced_", 1.0)
    journey.hear("taker:_displaced_", 1.0)
    state: Any = journey.hear("giver:handOver@3", 2.0)
    again = parse_state(format_state(state))
    assert again == state._replace(reason=in_words(state.reason)) and again.displaced == ("giver", "taker")


# The words ------------------------------------------------------------------------------------------------------------


@given(st.sampled_from(["_failed_", "_held_", "_resume_", "_displaced_", "_back_"]), st.text(max_size=400))
def test_a_report_survives_the_wire(event: str, text: str) -> None:
    report = parse_report(format_report(RobotReport("bot1", event, text)))
    assert report is not None and (report.agent, report.event) == ("bot1", event)
    assert "\n" not in report.text and len(report.text) <= 300
    assert report == parse_report(format_report(report))


def test_only_reports_about_robots_have_a_text() -> None:
    assert parse_report("bot1:bot1_inb now") is None and parse_word("bot1:bot1_inb now") is None
    assert parse_report("_held_ why") is None and parse_report("bot1:_held_@3") is None
    assert parse_report(" bot1:_held_  by  a person ") == RobotReport("bot1", "_held_", "by a person")
