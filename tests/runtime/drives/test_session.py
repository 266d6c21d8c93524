"""A robot drives all ways without a mission: with a simulated robot, in simulated time, without ROS."""

from __future__ import annotations

import heapq
from typing import Any, Dict, List, Optional, Tuple

import pytest

from pursue_runtime.controller.goal import Answer, Goal
from pursue_runtime.controller.settings import Settings
from pursue_runtime.controller.whereabouts import Place, Position
from pursue_runtime.drives.actions import Act, Acts
from pursue_runtime.drives.report import ARRIVED, FAILED, INTERRUPTED, LATE, Drive, format_drive, parse_drive
from pursue_runtime.drives.session import Plan, Session
from pursue_runtime.drives.tour import Way
from pursue_runtime.locations import movement

PLACES = {name: Place(name, float(x), 0.0) for x, name in enumerate("abc")}
WAYS: Tuple[Way, ...] = (("a", "b"), ("b", "a"), ("b", "c"), ("c", "b"))
TAKES: Dict[Way, float] = {("a", "b"): 4.0, ("b", "a"): 5.0, ("b", "c"): 6.0, ("c", "b"): 7.0}
RESULT = Settings(goals="action", ends="result", on_stop="cancel", retries=1)

SUCCEEDED, PREEMPTED, ABORTED = 3, 2, 4


class Robot:
    """A robot with move_base: it takes its time for each way, and fails on those that are blocked."""

    def __init__(
        self, session: Session, at: str = "a", blocked: Tuple[Way, ...] = (), acts: Optional[Acts] = None
    ) -> None:
        self.session, self.at, self.blocked = session, at, blocked
        self.acts = acts or Acts("bot", (), 0, None)
        self.now = 100.0
        self.drives: List[Drive] = []
        self.goals: List[str] = []
        self.cancelled: List[str] = []
        self.acted: List[str] = []
        self.silent: Tuple[str, ...] = ()  # what it does not report
        self._words: List[Tuple[float, str]] = []
        self._answers: List[Tuple[float, int, str, str, int]] = []

    def run(self, until: float = 10_000.0) -> None:
        """Until the session is over, or that moment has come."""
        for _ in range(10_000):
            if not self.step(until):
                return
        raise AssertionError("it does not end")

    def step(self, until: float) -> bool:
        due = self.session.due(self.now, self.now)
        if due.goal is not None:
            self.take(due.goal)
        if due.cancel is not None:
            self.cancelled.append(due.cancel)
        if due.drive is not None:
            self.drives.append(due.drive)
        if due.act is not None:
            self.acted.append(str(due.act))
            assert self.session.location == f"doing_{due.act.event}_in_{self.at}"
            words = [] if due.act.event in self.silent else ["someone_elseDONE", f"bot:{due.act.event}DONE"]
            self._words = [(self.now + 2.5, word) for word in words]
            partner = f"{due.act.partner}:{due.act.event}DONE"
            self._words += [(self.now + 3.5, partner)] * (due.act.busy and due.act.partner not in self.silent)
        if self.session.is_over:
            return False
        if due.goal is None and due.drive is None:
            moments = [self._answers[0][0]] if self._answers else []
            moments += [moment for moment, _ in self._words]
            moment = self.session.next_moment()
            moments += [] if moment is None else [moment]
            self.now = max(self.now, min(moments))
            if self.now > until:
                return False
            while self._answers and self._answers[0][0] <= self.now:
                _, _, name, to, status = heapq.heappop(self._answers)
                self.at = to if status == SUCCEEDED else self.at
                self.answer(name, status)
            while self._words and self._words[0][0] <= self.now:
                self.session.on_word(self._words.pop(0)[1])
        return True

    def take(self, goal: Goal) -> None:
        """A goal: it is answered when the robot is there."""
        to = goal.movement.place.poi
        self.goals.append(to)
        way = (self.at, to)
        status = ABORTED if way in self.blocked else SUCCEEDED
        heapq.heappush(self._answers, (self.now + self.takes(way), len(self.goals), goal.name, to, status))

    def takes(self, way: Way) -> float:
        """How long a drive takes."""
        return TAKES.get(way, 1.0)

    def answer(self, goal: str, status: int) -> None:
        """A result of move_base."""
        answer = Answer(goal, self.now, status, "no way" if status == ABORTED else "")
        self.session.navigation.on_result(answer, self.now)


def robot(
    plan: Optional[Plan] = None, settings: Settings = RESULT, at: str = "a", blocked: Tuple[Way, ...] = (),
    **more: Any,
) -> Robot:
    session = Session("bot", PLACES, "a", plan or Plan(WAYS, times=3), settings, lambda level, text: None, **more)
    return Robot(session, at, blocked)


def test_each_way_is_driven_so_often_and_its_time_is_measured() -> None:
    found = robot()
    found.run()
    assert found.session.is_complete and not found.session.problem
    assert found.session.measured == {way: [pytest.approx(TAKES[way])] * 3 for way in WAYS}
    assert [(drive.a, drive.b) for drive in found.drives].count(("c", "b")) == 3
    assert all(drive.outcome == ARRIVED and drive.goals == 1 for drive in found.drives)
    assert len(found.goals) == 1 + 3 * len(WAYS)  # the first one is to where it begins
    assert next(found.session.summary()) == "bot from a to b: 3 of 3 drives, 4.0 to 4.0 s"


def test_it_comes_to_its_start_first_and_that_does_not_count() -> None:
    found = robot(at="c")
    found.run()
    assert found.goals[0] == "a" and found.drives[0].a == "a"
    assert found.session.is_complete


def test_a_way_that_fails_is_reported_and_the_tour_goes_on() -> None:
    found = robot(blocked=(("b", "c"),))
    found.run()
    measured = {way: len(times) for way, times in found.session.measured.items()}
    assert measured == {("a", "b"): 3, ("b", "a"): 3, ("b", "c"): 0, ("c", "b"): 0}
    failed = [drive for drive in found.drives if drive.outcome == FAILED]
    assert [(drive.a, drive.b, drive.goals) for drive in failed] == [("b", "c", 2)] * 2
    assert "no way" in failed[0].text
    assert not found.session.is_complete
    why = "the way from b to c was given up: on its way to c: its goal was aborted: no way, in 2 attempts"
    assert found.session.problem == why and failed[0].text == why.partition(": ")[2], "one reason, and no marks in it"


def test_a_robot_that_stands_on_a_goal_is_named() -> None:
    found = robot(blocked=(("b", "c"),), who_is_near=lambda place: "mate stands there" if place.poi == "c" else "")
    found.run()
    assert found.session.problem.endswith("in 2 attempts; mate stands there")
    late = robot(Plan(WAYS, times=1, limit=6.5), who_is_near=lambda place: "mate stands there")
    late.run()
    texts = {drive.text for drive in late.drives if drive.outcome == LATE}
    assert texts == {"not there after 6.5 s; mate stands there"}


def test_from_where_it_cannot_go_on_is_said_where_no_way_has_failed() -> None:
    found = robot(Plan((("a", "b"), ("c", "b")), times=1))
    found.run()
    assert found.session.problem == "from b it gets to no place from which a way is left, such as c"


def test_the_first_ways_are_driven_before_the_others() -> None:
    first = frozenset({("b", "c"), ("c", "b")})
    found = robot(Plan(WAYS, times=3, first=first))
    found.run()
    assert found.session.is_complete
    driven = [(drive.a, drive.b) for drive in found.drives]
    assert driven[:7] == [("a", "b"), *[("b", "c"), ("c", "b")] * 3], "a to b leads there"
    assert found.session.plan.words("a") == "drives 4 ways 3 times each, the 2 that the strategy uses first, from a on"


def test_a_robot_that_is_where_it_begins_is_not_sent_there() -> None:
    found = robot(at_start=True)
    found.run()
    assert len(found.goals) == 3 * len(WAYS) and found.session.is_complete and found.session.place == "a"


@pytest.mark.parametrize("blocked", [(), (("c", "a"),)])
def test_a_robot_that_only_goes_to_where_it_begins_measures_nothing(blocked: Tuple[Way, ...]) -> None:
    found = robot(Plan((), only_goes="where it begins"), at="c", blocked=blocked)
    found.run()
    assert set(found.goals) == {"a"} and found.drives == []
    assert found.session.place == ("" if blocked else "a")
    assert found.session.problem == ("it does not get to a" if blocked else "")
    assert found.session.plan.words("a") == "goes to a, where it begins"


def test_a_robot_that_does_not_come_is_called_back_and_goes_on_from_another_place() -> None:
    found = robot(Plan(WAYS, times=1, limit=6.5))
    found.run()
    late = [drive for drive in found.drives if drive.outcome == LATE]
    assert {(drive.a, drive.b) for drive in late} == {("c", "b")}
    assert len(found.cancelled) == len(late) == 2
    assert len(found.session.measured["b", "c"]) >= 1


def test_what_was_measured_stays_when_it_is_stopped() -> None:
    found = robot()
    found.run(until=120.0)
    due = found.session.stop(found.now)
    assert due.drive is not None and due.drive.outcome == INTERRUPTED and due.cancel
    assert found.drives and found.session.is_over
    assert found.session.stop(found.now) == found.session.due(found.now, found.now)


def test_a_robot_that_a_person_calls_back_is_left_to_that() -> None:
    found = robot()
    found.run(until=110.0)
    found.answer(found.session.goal, PREEMPTED)
    found.run()
    assert found.drives[-1].outcome == INTERRUPTED
    assert "preempted" in found.session.problem and not found.session.is_complete


def test_a_drive_on_which_another_node_sent_the_robot_elsewhere_is_made_once_more() -> None:
    found = robot()
    found.run(until=110.0)
    ours, way = found.session.goal, found.session.location
    found.answer(ours, PREEMPTED)
    theirs = [Answer(ours, found.now, PREEMPTED), Answer("of another node", found.now, 1)]
    found.session.navigation.on_status(theirs, found.now, found.now)
    found.run()
    disturbed = [drive for drive in found.drives if drive.outcome != ARRIVED]
    assert [(movement(drive.a, drive.b), drive.outcome, drive.goals) for drive in disturbed] == [(way, INTERRUPTED, 2)]
    assert "another node" in disturbed[0].text
    assert found.session.is_complete and not found.session.problem
    assert all(set(times) == {TAKES[way]} for way, times in found.session.measured.items())


def test_a_robot_that_gets_nowhere_ends_it() -> None:
    found = robot(blocked=tuple(("a", place) for place in PLACES))
    found.run()
    assert found.drives == [] and found.session.problem == "it gets to no place"


def test_arrivals_are_those_of_a_mission_with_positions() -> None:
    settings = Settings(goals="simple", ends="pose", end_settle=0.5)
    session = Session("bot", PLACES, "a", Plan((("a", "b"),), times=1), settings, lambda level, text: None)

    def stand(x: float, since: float) -> Optional[Drive]:
        session.navigation.on_position(Position(x, 0.0, 0.0), since)
        session.due(since, since)
        return session.due(since + 0.6, since + 0.6).drive

    assert session.due(10.0, 10.0).goal is not None
    assert stand(0.0, 12.0) is None  # it is at its start
    goal = session.due(14.0, 14.0).goal
    assert goal is not None and goal.movement.place.poi == "b"
    assert stand(0.5, 16.0) is None
    drive = stand(1.0, 18.0)
    assert drive is not None and (drive.outcome, drive.seconds) == (ARRIVED, pytest.approx(4.6))


def test_arrivals_may_be_words() -> None:
    session = Session("bot", PLACES, "a", Plan((("a", "b"),), times=1), Settings(), lambda level, text: None)
    session.due(10.0, 10.0)
    session.on_word("bot_going_b_to_a2a")
    session.due(12.0, 12.0)
    session.due(14.0, 14.0)
    session.on_word("other_going_a_to_b2b")
    assert session.due(15.0, 15.0).drive is None
    session.on_word("bot_going_a_to_b2b")
    drive = session.due(18.0, 18.0).drive
    assert drive is not None and drive.seconds == 4.0
    assert session.due(19.0, 19.0).drive is None and session.is_over


FETCH, DROP = Act("fetch", "c"), Act("drop", "a")


class Turns:
    """Rules: drop after fetch, in turns; as `pursue_runtime.drives.actions.Rules`."""

    def __init__(self) -> None:
        self.next = FETCH

    def allow(self, robot: str, act: Act) -> bool:
        return act == self.next

    def done(self, robot: str, act: Act) -> None:
        self.next = DROP if act == FETCH else FETCH


def acting(times: int, actions: int, ways: Tuple[Way, ...] = WAYS, *silent: str) -> Robot:
    plan = Plan(ways, times, 20.0, 1.0, (DROP, FETCH), actions)
    acts = Acts("bot", plan.acts, actions, Turns())  # type: ignore[arg-type]
    found = Robot(Session("bot", PLACES, "a", plan, RESULT, lambda level, text: None, acts), acts=acts)
    found.silent = silent
    return found


def test_actions_are_done_where_the_tour_passes_and_in_the_order_of_the_rules() -> None:
    found = acting(3, 2)
    found.run()
    assert found.session.is_complete and found.acts.is_complete and not found.session.problem
    assert found.acted == ["fetch at c", "drop at a"] * 2
    acts = [drive for drive in found.drives if drive.action]
    assert [(drive.action, drive.a, drive.b, drive.outcome) for drive in acts[:2]] == [
        ("fetch", "c", "c", ARRIVED), ("drop", "a", "a", ARRIVED)
    ]  # fmt: skip
    assert all(drive.seconds == pytest.approx(2.5) for drive in acts)
    assert "bot does fetch at c: 2 of 2 times, 2.5 to 2.5 s" in found.acts.summary()


def test_more_is_driven_where_actions_are_left_when_all_ways_are_done() -> None:
    found = acting(1, 3)
    found.run()
    assert found.acts.is_complete and len(found.acted) == 6


def test_an_action_that_nobody_reports_is_given_up_and_what_follows_it_is_not_done() -> None:
    found = acting(2, 2, WAYS, "fetch")
    found.run()
    assert found.acted == ["fetch at c"] * 2
    assert found.acts.why_not_all() == "fetch at c was given up, as it did not come to its end"
    late = [(drive.outcome, drive.text) for drive in found.drives if drive.action]
    assert late == [(LATE, "not done after 20 s")] * 2
    assert all(len(times) == 2 for times in found.session.measured.values())


def test_a_robot_that_does_not_drive_does_its_actions_where_it_stands() -> None:
    plan = Plan((), 1, 20.0, 1.0, (FETCH,), 3)
    acts = Acts("bot", plan.acts, 3, None)
    found = Robot(Session("bot", PLACES, "c", plan, RESULT, lambda level, text: None, acts), at="c", acts=acts)
    found.run()
    assert found.acted == ["fetch at c"] * 3 and found.goals == [] and acts.is_complete


def carrying(busy: bool, *silent: str) -> Robot:
    carry = Act("carry", "c", "mate", busy)
    acts = Acts("bot", (carry, FETCH), 2, None)
    plan = Plan((), 1, 20.0, 1.0, (carry,))
    found = Robot(Session("bot", PLACES, "c", plan, RESULT, lambda level, text: None, acts), at="c", acts=acts)
    found.silent = silent
    found.run()
    return found


def test_what_two_do_together_ends_when_all_who_are_busy_with_it_have_reported_it() -> None:
    for busy, seconds in ((True, 3.5), (False, 2.5)):
        found = carrying(busy)
        assert found.acted == ["carry at c with mate"] * 2, "that alone, as often as is wanted"
        assert [(one.action, one.outcome, one.seconds) for one in found.drives] == [
            ("carry", ARRIVED, pytest.approx(seconds))
        ] * 2
    silent = carrying(True, "mate")
    assert [one.text for one in silent.drives] == ["mate has not done it after 20 s"] * 2
    assert silent.acts.why_not_all() == "carry at c with mate was given up, as it did not come to its end"


def test_a_partner_that_fails_ends_it() -> None:
    acts = Acts("bot", (Act("carry", "c", "mate", True),), 1, None)
    plan = Plan((), 1, 20.0, 1.0, tuple(acts.measured))
    session = Session("bot", PLACES, "c", plan, RESULT, lambda level, text: None, acts)
    assert session.due(5.0, 5.0).act is not None
    for who, outcome in (("stranger", None), ("mate", FAILED)):
        session.on_word(f"{who}:_failed_ dropped it")
        drive = session.due(6.0, 6.0).drive
        assert (drive.outcome if drive else None) == outcome and (drive is None or drive.text == "dropped it")


@pytest.mark.parametrize("outcome", [ARRIVED, FAILED])
@pytest.mark.parametrize("action", ["", "fetch"])
def test_what_is_published_of_a_drive_is_read_again(outcome: str, action: str) -> None:
    drive = Drive("bot", "a", "b", 1.5, 7.25, outcome, 2, "why" if outcome == FAILED else "", action)
    assert parse_drive(format_drive(drive)) == drive


@pytest.mark.parametrize(
    "text",
    [
        "", "[]", "{}", '{"format": 2}',
        '{"format": 1, "robot": "b", "from": "a", "to": "b", "start": 2, "end": 1, "outcome": "arrived"}',
        '{"format": 1, "robot": "b", "from": "a", "to": "b", "start": 1, "end": true, "outcome": "arrived"}',
        '{"format": 1, "robot": "", "from": "a", "to": "b", "start": 1, "end": 2, "outcome": "arrived"}',
        '{"format": 1, "robot": "b", "from": "a", "to": "b", "start": 1, "end": 2, "outcome": "flew"}',
        '{"format": 1, "robot": "b", "from": "a", "to": "b", "start": 1, "end": 1e400, "outcome": "late"}',
        '{"format": 1, "robot": "b", "from": "a", "to": "a", "start": 1, "end": 2, "outcome": "late", "action": 3}',
    ],
)  # fmt: skip
def test_what_is_no_drive_is_not_taken_for_one(text: str) -> None:
    assert parse_drive(text) is None
