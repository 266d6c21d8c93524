"""Missions to several robots: all have the new one, or none, or it is told that they differ."""

from __future__ import annotations

import contextlib
import signal
import socket
import threading
from dataclasses import replace
from typing import Callable, List, Optional, Sequence, Tuple

import pytest
from fake_robot import BUSY, CUT, GONE, KEY, LATE, LOST, PACKAGES, REFUSED, SLOW, STRANGER, FakeRobot, bundle, serving
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.tools.transport.client import Robot, Status
from pursue_gen.tools.transport.sender import Sent, _ctrl_c_noticed, look, send, wait
from pursue_runtime.manifest import OWN
from tests.waiting import PATIENCE

NEW, CONTENT = bundle("catch")
OLD, _ = bundle("guard")
QUICK = (0.0, 0.0, 0.0)


def fleet() -> List[FakeRobot]:
    """Two robots with a controller each, and the machine of the observer, which stands first in the file."""
    base = FakeRobot("base", ("UI", "observer"))
    return [base, FakeRobot("bot1", ("controller_bot1",)), FakeRobot("bot2", ("controller_bot2",))]


def press_ctrl_c() -> None:
    """A signal, which also ends what the main thread waits for."""
    signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGINT)


def sent(robots: Sequence[FakeRobot], places: Sequence[Robot], mission: str = NEW, content: bytes = CONTENT) -> Sent:
    return send(places, mission, content, KEY, lambda statuses: None, None, QUICK)


def only(action: str, fault: str, times: int = 99) -> Callable[[str, int], Optional[str]]:
    """The fault, the first so many times that this is asked."""
    left = [times]

    def of(what: str, number: int) -> Optional[str]:
        if what != action or not left[0]:
            return None
        left[0] -= 1
        return fault

    return of


def test_all_robots_change_and_the_observer_is_the_last() -> None:
    robots = fleet()
    order: List[str] = []
    for robot in robots:
        robot.on_change = lambda robot=robot: order.append(robot.name) if robot.current == NEW else None  # type: ignore
    with serving(robots) as places:
        result = sent(robots, places)
    assert result.done
    assert [robot.current for robot in robots] == [NEW] * 3
    assert order == ["bot1", "bot2", "base"]
    assert [row.outcome for row in result.rows] == ["changed"] * 3
    assert [row.after.current for row in result.rows if row.after] == [NEW] * 3


def test_progress_is_reported_up_to_the_last_byte() -> None:
    robots = fleet()
    reports: List[Tuple[str, int, int]] = []
    with serving(robots) as places:
        progress = lambda robot, sent, size: reports.append((robot.name, sent, size))
        send(places, NEW, CONTENT, KEY, lambda _: None, progress, QUICK)
    for robot in robots:
        mine = [sent for name, sent, _ in reports if name == robot.name]
        assert mine == sorted(mine)
        assert mine[-1] == len(CONTENT)
    assert {size for _, _, size in reports} == {len(CONTENT)}


def test_one_that_cannot_be_reached_leaves_all_as_they_were() -> None:
    robots = fleet()
    robots[2].dead = True
    with serving(robots) as places:
        result = sent(robots, places)
    assert not result.done
    assert result.unchanged
    assert [(robot.current, robot.prepared, robot.uploads) for robot in robots] == [(OWN, None, 0)] * 3
    assert result.rows[2].outcome.startswith("not reached: it closed the connection")
    assert result.rows[2].after is None


def test_a_port_without_a_server_is_reported_as_refused() -> None:
    robots = fleet()
    with contextlib.ExitStack() as held:
        places = []
        for robot in robots:
            silent = held.enter_context(socket.socket())  # nobody else gets its port, and it does not listen
            silent.bind(("127.0.0.1", 0))
            places.append(Robot(robot.name, "127.0.0.1", silent.getsockname()[1]))
        result = sent(robots, places)
    assert {row.outcome for row in result.rows} == {"not reached: connection refused"}


def test_one_that_refuses_makes_all_forget_what_they_prepared() -> None:
    robots = fleet()
    robots[1].fault = only("prepare", REFUSED)
    with serving(robots) as places:
        result = sent(robots, places)
    assert result.unchanged and not result.done
    assert [(robot.current, robot.prepared) for robot in robots] == [(OWN, None)] * 3
    assert result.trouble == "bot1: the disk is full"
    assert robots[1].requests.count("prepare") == 1  # trying once more would not help


@pytest.mark.parametrize("runs", [False, True])
def test_one_that_dies_between_prepare_and_commit_makes_the_others_go_back(runs: bool) -> None:
    robots = fleet()
    robots[2].fault = only("commit", GONE)
    robots[1].runs = runs
    with serving(robots) as places:
        result = sent(robots, places)
    assert not result.done
    assert "commit" in robots[1].requests
    assert [(robot.standing, robot.prepared) for robot in robots[:2]] == [(OWN, None)] * 2
    # Nobody saw whether the dead one had changed before.
    assert not result.unchanged
    assert result.rows[2].outcome.startswith("not known, it may have changed: ")
    assert result.rows[2].after is None
    assert [row.same for row in result.rows] == [True, True, False]


def test_one_that_is_switched_off_before_its_commit_is_certain_not_to_have_changed() -> None:
    """The connection itself fails: the order cannot have arrived."""
    robots = fleet()
    robots[1].on_change = lambda: robots[2].unplug() if robots[1].current == NEW else None
    with serving(robots) as places:
        result = sent(robots, places)
    assert not result.done and result.unchanged
    assert [robot.current for robot in robots] == [OWN] * 3
    assert robots[1].history == [OWN, NEW]
    assert result.rows[2].outcome == "nothing changed; still has it prepared: connection refused"


def test_where_it_is_not_known_whether_the_observer_changed_the_others_keep_the_mission() -> None:
    robots = fleet()
    robots[0].fault = only("commit", GONE)
    with serving(robots) as places:
        result = sent(robots, places)
    assert not result.done and not result.unchanged
    assert [robot.current for robot in robots[1:]] == [NEW, NEW]
    assert [row.outcome for row in result.rows[1:]] == ["changed, and left so: the observer may have it too"] * 2


def test_where_every_machine_has_the_whole_workspace_none_forgets_what_another_may_play() -> None:
    robots = [FakeRobot(name, PACKAGES) for name in ("base", "bot1", "bot2")]

    def hangs(what: str, number: int) -> Optional[str]:
        return GONE if robots[0].slow else None

    with serving(robots) as places:
        robots[0].fault = lambda what, number: SLOW if what == "commit" else hangs(what, number)
        result = sent(robots, places)
    assert not result.done and not result.unchanged
    assert [robot.has(NEW) for robot in robots] == [True] * 3
    assert [row.same for row in result.rows] == [False, True, True]


def test_where_the_observers_machine_refuses_the_others_go_back() -> None:
    robots = fleet()
    robots[0].fault = only("commit", REFUSED)
    with serving(robots) as places:
        result = sent(robots, places)
    assert result.unchanged and not result.done
    assert [(robot.current, robot.prepared) for robot in robots] == [(OWN, None)] * 3
    assert robots[1].history == [OWN, NEW]  # it was there, and went back


@pytest.mark.parametrize(("fault", "known"), [(BUSY, True), (SLOW, False)])
def test_an_order_that_was_turned_away_has_changed_nothing_but_one_that_takes_long_may(fault: str, known: bool) -> None:
    robots = fleet()
    faults = {"commit": fault, "abort": GONE}
    robots[2].fault = lambda what, number: faults.get(what)
    with serving(robots) as places:
        result = sent(robots, places)
    assert not result.done
    assert result.unchanged == known
    assert result.rows[2].outcome.startswith("nothing changed; still has it prepared" if known else "not known")


def test_it_is_reported_exactly_where_going_back_fails() -> None:
    robots = fleet()
    robots[0].fault = only("commit", REFUSED)
    committed = [False]

    def dies_afterwards(what: str, number: int) -> Optional[str]:
        if committed[0]:
            return GONE
        committed[0] = what == "commit"
        return None

    robots[1].fault = dies_afterwards
    with serving(robots) as places:
        result = sent(robots, places)
    assert not result.unchanged
    assert [row.same for row in result.rows] == [True, False, True]
    assert result.rows[1].outcome.startswith("changed, and cannot be taken back: it closed")
    assert robots[1].current == NEW


@pytest.mark.parametrize("action", ["prepare", "commit"])
@pytest.mark.parametrize("fault", [LOST, CUT, BUSY, LATE, SLOW])
def test_what_passes_is_tried_again(action: str, fault: str) -> None:
    robots = fleet()
    for robot in robots:
        robot.fault = only(action, fault, 2)
    with serving(robots) as places:
        result = sent(robots, places)
    assert result.done
    assert [robot.current for robot in robots] == [NEW] * 3
    assert [robot.uploads for robot in robots] == [1] * 3  # a lost answer does not cost another upload


def test_what_does_not_pass_is_given_up_after_a_few_tries() -> None:
    robots = fleet()
    robots[1].fault = only("prepare", LATE)
    with serving(robots) as places:
        result = sent(robots, places)
    assert result.unchanged and not result.done
    assert robots[1].requests.count("prepare") == len(QUICK) + 1


def test_what_is_there_is_not_sent_again() -> None:
    robots = fleet()
    with serving(robots) as places:
        sent(robots, places)
        again = sent(robots, places)
    assert again.done
    assert [row.outcome for row in again.rows] == ["had it already"] * 3
    assert [robot.uploads for robot in robots] == [1] * 3


def test_a_mission_that_is_kept_is_not_uploaded() -> None:
    robots = fleet()
    robots[1].kept = [NEW]
    with serving(robots) as places:
        assert sent(robots, places).done
    assert [robot.uploads for robot in robots] == [1, 0, 1]


def test_a_mission_that_is_damaged_there_is_uploaded_once_more() -> None:
    robots = fleet()
    robots[1].kept = [NEW]
    robots[1].fault = only("prepare", REFUSED, 1)
    with serving(robots) as places:
        assert sent(robots, places).done
    assert robots[1].uploads == 1


def test_going_back_needs_no_upload() -> None:
    robots = fleet()
    with serving(robots) as places:
        sent(robots, places)
        back = sent(robots, places, OWN, b"")
    assert back.done
    assert [(robot.current, robot.history) for robot in robots] == [(OWN, [OWN, NEW])] * 3


def test_a_mission_under_way_is_ended_first_and_waiting_shows_when() -> None:
    robots = fleet()
    robots[0].runs = True
    with serving(robots) as places:
        result = sent(robots, places)
        assert result.done
        assert result.rows[0].outcome == "takes effect as soon as no mission is under way"
        rows = wait(places, NEW, 0.05, 0.01)
        assert [bool(row.after and row.after.current == NEW) for row in rows] == [False, True, True]
        robots[0].end_mission()
        rows = wait(places, NEW, PATIENCE, 0.01)
        assert all(row.after and row.after.current == NEW for row in rows)


def test_a_failure_leaves_what_waited_for_the_mission_under_way() -> None:
    robots = fleet()
    robots[1].kept, robots[1].next, robots[1].runs = [OLD], OLD, True
    robots[0].fault = only("commit", REFUSED)
    with serving(robots) as places:
        result = sent(robots, places)
    assert result.unchanged and not result.done
    assert (robots[1].current, robots[1].next, robots[1].prepared) == (OWN, OLD, None)


def test_nothing_is_sent_where_the_check_finds_something() -> None:
    robots = fleet()

    def check(statuses: Sequence[Status]) -> None:
        raise PursueError([])

    with serving(robots) as places, pytest.raises(PursueError):
        send(places, NEW, CONTENT, KEY, check, None, QUICK)
    assert [robot.requests for robot in robots] == [["health"]] * 3


def test_a_key_that_the_robots_do_not_trust_changes_nothing() -> None:
    robots = fleet()
    with serving(robots) as places:
        result = send(places, NEW, CONTENT, STRANGER, lambda _: None, None, QUICK)
    assert result.unchanged and not result.done
    assert all("does not trust" in row.outcome for row in result.rows)
    assert all(robot.requests.count("prepare") == 1 for robot in robots)


def test_a_robot_under_the_name_of_another_is_reported() -> None:
    robots = fleet()
    with serving(robots) as places:
        swapped = [places[0], replace(places[1], port=places[2].port), replace(places[2], port=places[1].port)]
        result = sent(robots, swapped)
    assert result.unchanged and not result.done
    assert "there is a robot called bot2 at" in result.rows[1].outcome
    assert all("prepare" not in robot.requests for robot in robots)


def test_ctrl_c_makes_all_forget_what_they_prepared() -> None:
    robots = fleet()
    once = threading.Lock()

    def interrupt() -> None:
        if all(robot.prepared == NEW for robot in robots) and once.acquire(blocking=False):
            press_ctrl_c()

    for robot in robots:
        robot.on_change = interrupt
    said: List[str] = []
    with serving(robots) as places:
        result = send(places, NEW, CONTENT, KEY, lambda _: None, None, QUICK, said.append)
    assert result.unchanged and not result.done
    assert [(robot.current, robot.prepared) for robot in robots] == [(OWN, None)] * 3
    assert len(said) == 1 and "is taken back" in said[0]


def test_ctrl_c_is_noticed_where_its_exception_is_lost() -> None:
    before = signal.getsignal(signal.SIGINT)
    with _ctrl_c_noticed() as check:
        check()
        with contextlib.suppress(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        with pytest.raises(KeyboardInterrupt):
            check()
    assert signal.getsignal(signal.SIGINT) is before


def test_looking_changes_nothing() -> None:
    robots = fleet()
    robots[1].dead = True
    with serving(robots) as places:
        rows = look(places, QUICK)
    assert [row.after is not None for row in rows] == [True, False, True]
    assert all(set(robot.requests) <= {"health"} for robot in robots)


FAULTS = st.sampled_from([CUT, LOST, GONE, BUSY, LATE, REFUSED, SLOW])


@st.composite
def troubled(draw: st.DrawFn) -> List[FakeRobot]:
    """Robots of which some have the mission, wait for one, or play one; each request may go wrong."""
    robots = []
    count = draw(st.integers(1, 4))
    observers = draw(st.sets(st.integers(0, count - 1), min_size=1))  # the whole workspace may be on several machines
    for number in range(count):
        plan = draw(st.lists(st.one_of(st.none(), st.none(), FAULTS), max_size=12))
        robot = FakeRobot(f"bot{number}", PACKAGES[:3] + PACKAGES[3:] * (number in observers))
        robot.fault = lambda what, index, plan=plan: plan[index] if index < len(plan) else None  # type: ignore[misc]
        robot.kept = draw(st.sampled_from([[], [NEW], [OLD], [OLD, NEW]]))
        robot.runs = draw(st.booleans())
        robot.current = draw(st.sampled_from([OWN, *robot.kept]))
        others = [mission for mission in (OWN, *robot.kept) if mission != robot.current]
        robot.next = draw(st.sampled_from([None, *others])) if robot.runs else None
        robots.append(robot)
    return robots


@given(robots=troubled())
def test_all_have_the_new_one_or_none_or_it_is_reported_that_they_differ(robots: List[FakeRobot]) -> None:
    before = [robot.standing for robot in robots]
    broken: List[str] = []

    def watch() -> None:
        for robot in robots:
            if "observer" in robot.packages and robot.standing == NEW != before[robots.index(robot)]:
                broken.extend(other.name for other in robots if not other.has(NEW))

    for robot in robots:
        robot.on_change = watch
    with serving(robots) as places:
        result = send(places, NEW, CONTENT, KEY, lambda _: None, None, QUICK)
    assert not broken
    now = [robot.standing for robot in robots]
    if result.done:
        assert now == [NEW] * len(robots)
    elif result.unchanged:
        assert now == before
    if any("observer" in robot.packages and robot.standing == NEW != old for robot, old in zip(robots, before)):
        assert all(robot.has(NEW) for robot in robots)
    for row, robot, old in zip(result.rows, robots, before):
        assert not row.same or robot.standing == old
        assert row.after is None or row.after.standing == robot.standing
        assert row.before is None or row.before.standing == old
        if row.before is None:
            assert row.outcome.startswith("not reached")
