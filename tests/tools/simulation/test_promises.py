"""What objectives mean for a mission, found out without the network: a mission that ends otherwise is a problem."""

from __future__ import annotations

from dataclasses import replace
from typing import List, Tuple

import pytest

from pursue_gen.language import parse
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.tools.simulation.duties import Duty
from pursue_gen.tools.simulation.mission import simulate_mission
from pursue_gen.tools.simulation.outcome import Settings
from pursue_gen.tools.simulation.promises import Promises
from pursue_gen.tools.simulation.stage import stage_of
from pursue_gen.workspace import Options
from pursue_runtime.state import SystemState

PLACES = """
poi "hall"
poi "lab"
connect hall and lab distance 2
event "load" location hall duration 1
event "wave" location lab
agent "bot" controllable mobile 1 location hall can_do load, wave
agent "kid" mobile 1 location lab can_do fall
event "fall"
"""
Step = Tuple[float, str, str, str]
"""When (time units), an event, and where bot and kid are then."""


def ended(objectives: str, status: str, *steps: Step) -> List[str]:
    """The problems of a mission with these steps that ends so with the last of them."""
    return watched(objectives, status, *steps).problems


def watched(objectives: str, status: str, *steps: Step) -> Promises:
    """What was seen of such a mission."""
    promises = Promises(parse(PLACES + objectives, "x.pur", "x"))
    promises.on_state(SystemState(1, 5.0, {"bot": "hall", "kid": "lab"}, {}, {}, status="running", unit=2.0), 5.0)
    for number, (at, event, bot, kid) in enumerate(steps, 2):
        now, place = 5.0 + 2.0 * at, {"bot": bot, "kid": kid}
        last = status if number == len(steps) + 1 else "running"
        promises.on_state(SystemState(number, now, place, {}, {}, event, "bot", last, unit=2.0), now)
    return promises


LOAD, WAVE, FALL = "loadDONE", "wave", "fall"
ONE = "reach_objective: do load"
BOTH = "reach_objective: do load and wave after 2 within 9"
DUTY = "objective: if fall then wave within 4"
REQUESTS = "objective: if fall then wave within 4, at_most 2 open"
ROOM = "objective: place lab holds 1 agent"
WAY = "objective: way lab to hall holds 1 agent"
APART = "objective: bot never_with kid"
PAUSE = "objective: at_least 4 between load and wave"
TWICE = "reach_objective: do load twice at_least 4 apart within 9"
AGAIN = "objective: at_least 4 between load"


def test_how_often_an_objective_is_called_upon_is_counted_with_its_latest_answer() -> None:
    patrol = "objective: patrol hall every 9 by bot"
    calls = [(1.0, FALL, "hall", "lab"), (1.5, FALL, "hall", "lab"), (3.0, WAVE, "hall", "lab")]
    more = [(4.0, FALL, "hall", "lab"), (7.5, WAVE, "hall", "lab"), (9.0, FALL, "hall", "lab")]
    assert watched(f"{DUTY}\n{patrol}", "running").duties == (Duty(0, None), Duty(0, None))
    duty, round_ = watched(f"{DUTY}\n{patrol}\n{APART}\n{ONE}", "running", *calls, *more).duties
    assert (duty.calls, duty.latest) == (3, pytest.approx(3.5)), "a call that waits for its answer is not counted twice"
    assert round_ == Duty(0, None)
    gone = [(1.0, "bot_hall2lab", "going_hall_to_lab", "lab"), (6.0, "bot_lab2hall", "hall", "lab")]
    (round_,) = watched(patrol, "running", *gone).duties
    assert (round_.calls, round_.latest) == (1, pytest.approx(5.0))


def test_requests_are_counted_one_by_one_and_the_oldest_is_answered() -> None:
    asked = [(1.0, FALL, "hall", "lab"), (2.0, FALL, "hall", "lab"), (4.5, WAVE, "lab", "lab")]
    (duty,) = watched(REQUESTS, "running", *asked).duties
    assert (duty.calls, duty.latest) == (2, pytest.approx(3.5))
    assert not ended(REQUESTS, "running", *asked, (5.5, WAVE, "lab", "lab"))
    assert not ended(REQUESTS, "lost", *asked, (6.0, "bot_lab2hall", "going_lab_to_hall", "lab"))
    early = ended(REQUESTS, "lost", *asked, (5.5, "bot_lab2hall", "going_lab_to_hall", "lab"))
    assert early == ["the mission is lost, but no objective is broken"]


def test_one_more_than_may_be_open_is_a_problem_where_that_is_still_assumed() -> None:
    def more(assumed: int) -> List[str]:
        promises = Promises(parse(PLACES + REQUESTS, "x.pur", "x"))
        for number, event in enumerate(["", FALL, FALL, FALL], 1):
            place, values = {"bot": "hall", "kid": "lab"}, {"assume1": assumed}
            state = SystemState(number, float(number), place, values, {}, event, "kid", "running")
            promises.on_state(state, float(number))
        return promises.problems

    assert more(1) == ["state 4: not so that fall happens only while fewer than 2 wait for wave, but not broken"]
    assert more(0) == []


@pytest.mark.parametrize(
    ("objectives", "steps"),
    [
        ("reach_objective: do load", [(1, LOAD, "hall", "lab")]),
        (BOTH, [(3, WAVE, "lab", "lab"), (8.5, LOAD, "hall", "lab")]),
        (f"{DUTY}\n{ONE}", [(1, FALL, "hall", "lab"), (5, WAVE, "lab", "lab"), (9, LOAD, "hall", "lab")]),
        (f"{APART}\n{ONE}", [(1, "bot_hall2lab", "going_hall_to_lab", "lab"), (3, LOAD, "hall", "lab")]),
        ("reach_objective: do load twice", [(1, LOAD, "hall", "lab"), (2, LOAD, "hall", "lab")]),
        (TWICE, [(1, LOAD, "hall", "lab"), (4, LOAD, "hall", "lab"), (5, LOAD, "hall", "lab")]),
        (f"{PAUSE}\n{BOTH}", [(3, WAVE, "lab", "lab"), (4, LOAD, "hall", "lab")]),
        (f"{PAUSE}\n{BOTH}", [(3, LOAD, "hall", "lab"), (7.5, WAVE, "lab", "lab")]),
        (f"{AGAIN}\n{BOTH}", [(1, LOAD, "hall", "lab"), (5, "load", "hall", "lab"), (6, LOAD, "hall", "lab"),
                              (8, WAVE, "lab", "lab")]),
        (f"{ROOM}\n{WAY}\n{ONE}", [(1, "bot_hall2lab", "going_hall_to_lab", "lab"), (3, LOAD, "hall", "lab")]),
    ],
)  # fmt: skip
def test_a_mission_that_keeps_its_promises_is_won_and_not_lost(objectives: str, steps: List[Step]) -> None:
    assert ended(objectives, "won", *steps) == []
    assert ended(objectives, "lost", *steps) == ["the mission is lost, but no objective is broken"]


@pytest.mark.parametrize(
    ("objectives", "steps", "broken"),
    [
        ("reach_objective: do load", [(1, "load", "doing_load_in_hall", "lab")], "not 'do load'"),
        (BOTH, [(1, WAVE, "lab", "lab"), (9, LOAD, "hall", "lab")], "not 'do load and wave after 2 within 9'"),
        (BOTH, [(3, LOAD, "hall", "lab")], "not 'do load and wave"),
        (TWICE, [(1, LOAD, "hall", "lab"), (4, LOAD, "hall", "lab")], "not 'do load twice"),
        (TWICE, [(1, LOAD, "hall", "lab"), (10, LOAD, "hall", "lab")], "within 9' was broken"),
        (f"{DUTY}\n{ONE}", [(1, FALL, "hall", "lab"), (6, LOAD, "hall", "lab")], "wave within 4' was"),
        (f"objective: avoid fall\n{ONE}", [(1, FALL, "hall", "lab"), (2, LOAD, "hall", "lab")], "avoid"),
        (f"{APART}\n{ONE}", [(1, "x", "lab", "lab"), (2, LOAD, "hall", "lab")], "never_with kid' was"),
        (f"{ROOM}\n{ONE}", [(1, "x", "lab", "lab"), (2, LOAD, "hall", "lab")], "holds 1 agent' was"),
        (
            f"{WAY}\n{ONE}",
            [(1, "x", "going_hall_to_lab", "going_lab_to_hall"), (2, LOAD, "hall", "hall")],
            "holds 1 agent' was",
        ),
        (
            f"{APART}\n{ONE}",
            [(1, "x", "going_hall_to_lab", "going_lab_to_hall"), (2, LOAD, "hall", "lab")],
            "never_with kid' was",
        ),
        (f"{PAUSE}\n{BOTH}", [(1, LOAD, "hall", "lab"), (3, WAVE, "lab", "lab"), (8, LOAD, "hall", "lab")], "wave' w"),
        (f"{AGAIN}\n{BOTH}", [(1, LOAD, "hall", "lab"), (4, "load", "hall", "lab"), (6, LOAD, "hall", "lab"),
                              (8, WAVE, "lab", "lab")], "between load' was"),
        (BOTH, [(3, WAVE, "lab", "lab"), (10, LOAD, "hall", "lab")], "within 9' was broken"),
    ],
)  # fmt: skip
def test_a_mission_that_is_won_with_a_promise_broken_is_a_problem(
    objectives: str, steps: List[Step], broken: str
) -> None:
    assert any(broken in problem for problem in ended(objectives, "won", *steps))


@pytest.mark.parametrize(
    ("objectives", "steps"),
    [
        (BOTH, [(3, WAVE, "lab", "lab"), (9, "reachObj_going_unlocked2late", "hall", "lab")]),
        (DUTY, [(1, FALL, "hall", "lab"), (5, "obj_atRisk2lose", "hall", "lab")]),
        ("objective: avoid fall", [(1, FALL, "hall", "lab")]),
        (PAUSE, [(1, LOAD, "hall", "lab"), (5, WAVE, "lab", "lab")]),
    ],
)
def test_a_mission_is_lost_with_what_is_broken(objectives: str, steps: List[Step]) -> None:
    assert ended(objectives, "lost", *steps) == []


ROUND = "objective: patrol hall, lab in order every 5 by bot"
TO_LAB = "bot_hall2lab"


@pytest.mark.parametrize(
    ("steps", "broken"),
    [
        ([(1, TO_LAB, "going_hall_to_lab", "lab"), (3, "x", "lab", "lab"), (5.9, "y", "lab", "lab")], False),
        ([(1, TO_LAB, "going_hall_to_lab", "lab"), (3, "x", "lab", "lab"), (6.5, "y", "lab", "lab")], True),
        ([(5.5, "x", "hall", "lab")], True),
        # to come back to the hall, whose turn it is not, and to leave it again gives it no more time
        (
            [
                (1, TO_LAB, "going_hall_to_lab", "lab"), (2, "x", "hall", "lab"),
                (3, TO_LAB, "going_hall_to_lab", "lab"), (4, "x", "lab", "lab"), (6.5, "y", "lab", "lab"),
            ],
            True,
        ),
    ],
)  # fmt: skip
def test_a_patrol_in_order_counts_visits_in_their_turn(steps: List[Step], broken: bool) -> None:
    excused: List[str] = [] if broken else ["the mission is lost, but no objective is broken"]
    assert ended(ROUND, "lost", *steps) == excused


COME = "objective: if kid at hall then bot at hall within 3"
AWAY = ("bot_hall2lab", "going_hall_to_lab")


@pytest.mark.parametrize(
    ("objective", "steps", "broken"),
    [
        (COME, [(1, *AWAY, "lab"), (2, "x", "lab", "hall"), (6, "y", "lab", "hall")], True),
        (COME, [(1, *AWAY, "lab"), (2, "x", "lab", "hall"), (4, "y", "hall", "hall"), (9, "z", "hall", "hall")], False),
        # the kid goes and comes again: the time runs from when it came first
        (COME, [(1, "", "lab", "hall"), (2, "", "lab", "lab"), (3, "", "lab", "hall"), (5, "", "lab", "hall")], True),
        # while it stays, it need not be answered again
        (COME, [(1, "x", "hall", "hall"), (2, *AWAY, "hall"), (9, "y", "lab", "hall")], False),
        ("objective: if kid at lab then wave within 3", [(4, "x", "hall", "lab")], True),
        ("objective: if fall then bot at lab within 3", [(1, FALL, "lab", "lab"), (9, "x", "hall", "lab")], False),
    ],
)  # fmt: skip
def test_what_comes_to_hold_is_answered_in_time(objective: str, steps: List[Step], broken: bool) -> None:
    excused: List[str] = [] if broken else ["the mission is lost, but no objective is broken"]
    assert ended(objective, "lost", *steps) == excused


def test_simulated_missions_are_held_against_the_objectives() -> None:
    text = f"{PLACES}reach_objective: do load and wave\n"
    read = parse(text, "x.pur", "x")
    stage = stage_of(read, solve_scenario(read, DEFAULT), Options())
    assert simulate_mission(stage, Settings("random"), 1).problems == ()
    stricter = replace(stage, scenario=parse(f"{text}objective: bot never_with kid\n", "x.pur", "x"))
    other = replace(stage, scenario=parse(f"{text}reach_objective: do fall after 900\n", "x.pur", "x"))
    missions = ((changed, seed) for changed in (stricter, other) for seed in range(6))
    found = [simulate_mission(changed, Settings("random"), seed).problems for changed, seed in missions]
    assert any("never_with kid' was broken" in text for problems in found for text in problems)
    assert any("not 'do fall after 900'" in text for problems in found for text in problems)
