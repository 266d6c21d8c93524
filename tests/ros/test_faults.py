"""What may go wrong in a mission, done to it on purpose: see docs/faults.md for what has to happen then."""

from __future__ import annotations

import json
import os
import re
import signal
import time
from pathlib import Path
from typing import Callable, Dict, List, NamedTuple, Tuple

import pytest
from launched_mission import EVENTS, PLAYED, LaunchedMission, launched
from ros_world import Ros, generated, lay_over

from pursue_runtime.observer.records import read_records

Build = Callable[..., Path]

pytestmark = pytest.mark.ros

STEPS = [
    "reachObj_going_initial_location2unlocked", "bot1_c2b", "bot2_c2a", "bot1_going_c_to_b2b", "bot2_going_c_to_a2a",
    "bot1_inb", "bot1_inbDONE", "bot2_ina", "bot2_inaDONE",
]
"""Scenario 1 from start to goal, where every movement takes the middle of its window, and commands no time."""

ORDERS = {"bot1": ["[0.0, 3.1]", "bot1_inb"], "bot2": ["[5.13, 0.8]", "bot2_ina"]}
"""The orders that each robot gets in it."""

FAKE_PLANNER = Path(__file__).resolve().parent / "fake_planner.py"

FOR_EVER = 1000
"""Time units after which who is late counts as lost, where nobody is to: nodes that are started anew take a while."""

NODES = ("observer", "controller_bot1", "controller_bot2", "controllerObj", "simulator", "sim_clock", "UI")


@pytest.fixture(scope="module")
def scenario(built: Build) -> Path:
    """The workspace in which things go wrong."""
    return built("thesis/scenario_1")


def orders_of(run: LaunchedMission) -> Dict[str, List[str]]:
    """The orders that each robot got, by robot."""
    return {robot: [order for who, order in run.orders() if who == robot] for robot in ORDERS}


def check_steps(run: LaunchedMission) -> None:
    """Each step was taken once, each robot's in their order, and bot2 has waited for bot1. Apart from that either robot
    may be the first: commands may come late."""
    steps = run.steps()
    for who in ("reachObj", "bot1", "bot2"):
        own, wanted = ([step for step in some if step.startswith(who)] for some in (steps, STEPS))
        assert own == wanted, steps
    assert len(steps) == len(STEPS) and steps.index("bot1_inbDONE") < steps.index("bot2_ina"), steps


def check_time(run: LaunchedMission) -> None:
    """The states are one mission: numbers and stamps never go back, and clocks run with the stamps."""
    states = [state for state in run.states() if state.seq > 0]
    for before, after in zip(states, states[1:]):
        passed = float(after["stamp"]) - float(before["stamp"])
        assert passed >= -1e-6 and after.seq >= before.seq, (before, after)
        if before.seq == after.seq and after.status == "running":
            for clock, value in after["clocks"].items():
                assert value == pytest.approx(before["clocks"][clock] + passed / float(after["unit"]), abs=1e-3)


# Nodes that are killed ------------------------------------------------------------------------------------------------

TURNS = (
    ("bot2_c2a", signal.SIGKILL, ("simulator", "UI")),
    ("bot2_c2a", signal.SIGKILL, ("observer",)),
    ("bot1_going_c_to_b2b", signal.SIGKILL, ("controller_bot1",)),
    ("bot1_inb", signal.SIGKILL, ("sim_clock",)),
    ("bot1_inb", signal.SIGKILL, ("controller_bot2", "controllerObj")),
    ("bot2_ina", signal.SIGTERM, ("observer",)),
)
"""After which step which nodes get which signal, in one mission."""


class Turn(NamedTuple):
    """The number of the state before a node was killed, and the numbers heard until it was back."""

    before: int
    heard: List[int]


@pytest.fixture(scope="module")
def turns(ros: Ros, scenario: Path, tmp_path_factory: pytest.TempPathFactory) -> Tuple[LaunchedMission, List[Turn]]:
    """One mission in which each node is killed in turn; a slow one, so that nodes are back before the next turn."""
    found = []
    folder = tmp_path_factory.mktemp("turns")
    with launched(ros, scenario, folder, use_sim_time=True, speed=0.5, delays="middle", lost_after=FOR_EVER) as run:
        for step, sign, nodes in TURNS:
            run.until_step(step)
            states = run.states()
            before, known = states[-1].seq, len(states)
            killed = [(node, run.kill(node, sign)) for node in nodes]
            for node, process in killed:
                run.until_back(node, process)
            heard = run.until(lambda known=known: run.states()[known:])
            found.append(Turn(before, [state.seq for state in heard]))
        run.until_over()
    return run, found


@pytest.mark.parametrize("turn", range(len(TURNS)), ids=[f"{sign.name} {' '.join(nodes)}" for _, sign, nodes in TURNS])
def test_after_a_kill_the_mission_goes_on_from_the_same_state(
    turns: Tuple[LaunchedMission, List[Turn]], turn: int
) -> None:
    before, heard = turns[1][turn]
    assert heard, "no state was heard until the node was back"
    assert heard[0] in (before, before + 1)


def test_where_each_node_is_killed_in_turn_every_step_is_taken_once_and_in_order(
    turns: Tuple[LaunchedMission, List[Turn]]
) -> None:
    run = turns[0]
    check_steps(run)
    assert run.now().status == "won" and "The goal is reached" in run.verdict(), run.output()
    check_time(run)
    for robot, orders in orders_of(run).items():
        assert list(dict.fromkeys(orders)) == ORDERS[robot]  # a controller that comes back says again what is under way
        assert len(orders) <= len(ORDERS[robot]) + 1
    assert run.crashes() == [], run.output()


def test_a_command_that_nobody_received_is_said_until_it_is_answered(ros: Ros, scenario: Path, tmp_path: Path) -> None:
    """The observer is away when the first commands come, for longer than until they are said for the second time."""
    with launched(ros, scenario, tmp_path, use_sim_time=True, speed=3, delays="middle") as run:
        run.until_step("reachObj_going_initial_location2unlocked")
        run.kill("observer")
        assert run.until_over() == "won", run.output()
    check_steps(run)


def test_all_nodes_may_be_killed_at_once(ros: Ros, scenario: Path, tmp_path: Path) -> None:
    with launched(
        ros, scenario, tmp_path, use_sim_time=True, speed=2, delays="middle", lost_after=FOR_EVER
    ) as run:
        before = run.until_step("bot2_c2a")
        run.until(lambda: float(run.now()["stamp"]) > float(before["stamp"]))
        processes = {node: run.pid(node) for node in NODES}
        for node in NODES:
            run.kill(node)
        for node, process in processes.items():
            run.until_back(node, process)
        run.until_step("bot2_ina")
        sleeping = run.kill("UI", signal.SIGSTOP)
        run.until(lambda: run.now().status == "won")
        os.kill(sleeping, signal.SIGKILL)  # it never knew, and the observer is about to end
        status = run.until_over()
    assert status == "won" and "The goal is reached" in run.verdict(), run.output()
    # The clock may be back long before the others: who is late then may make the mission hold.
    holds = {state.seq for state in run.states() if state.seq > before.seq and "event" not in state}
    assert run.now().seq == before.seq + 6 + len(holds)
    check_steps(run)
    check_time(run)
    assert run.crashes() == [], run.output()


# Words that should not be ---------------------------------------------------------------------------------------------

UNREADABLE = [
    "", "   ", "\x00\x01\x02", "🤖 →", "a:b:c", "@7", "bot1_inb@", "bot1_inb@-1", "bot1_inb@٣",
    "x" * 1000000, "é" * 500000,
]
IMPOSSIBLE = [
    "nonsense", "nobody:bot1_c2b", "x" * 900, "bot1_inbDONE", "bot2_inaDONE", "bot2_going_a_to_c2c", "rule1:bot1_inb",
    "reachObj:reachObj_unlocked2win", "nobody:_failed_", "_start_", "Finish!",
]
"""Before anybody has arrived."""
STALE = ["bot1_c2b@2", "bot2:bot2_c2a@3", "bot1_c2b@0", "bot1:bot1_inb@99999999999999999999"]
NO_TEXT = ["ff", "c3", "eda080", "00ff00ff"]
"""Bytes that are not UTF-8."""


def test_words_that_should_not_be_harm_nothing(ros: Ros, scenario: Path, tmp_path: Path) -> None:
    """Each word of the mission comes three times, and among them is everything that nobody should say."""
    with launched(ros, scenario, tmp_path, use_sim_time=True, speed=3, delays="middle") as run:
        run.order({"repeat": [0.0, 1.0]})
        run.until_step("bot2_c2a")
        processes = {node: run.pid(node) for node in NODES}
        # Of what is impossible two are ignored without a count.
        more = {"unreadable": len(UNREADABLE), "impossible": len(IMPOSSIBLE) - 2, "stale": len(STALE)}
        least = {name: int(run.values("observer").get(name, 0)) + number for name, number in more.items()}
        run.publish(*UNREADABLE, *IMPOSSIBLE, *STALE)
        run.order({"bytes": NO_TEXT})
        run.until(lambda: all(int(run.values("observer").get(name, 0)) >= count for name, count in least.items()))
        run.until_step("bot1_inb")
        run.publish("bot1_going_c_to_b2b", "bot2_going_c_to_a2a", "bot2_ina@7", *UNREADABLE, *STALE)
        assert {node: run.pid(node) for node in NODES} == processes
        status = run.until_over()
        run.until(lambda: run.of(EVENTS, "observer"))
    assert (status, orders_of(run)) == ("won", ORDERS), run.output()
    check_steps(run)
    check_time(run)
    assert [entry["data"] for entry in run.of(EVENTS, "observer")] == ["Finish!"]
    assert run.crashes() == [] and len(run.output()) < 200000


# Robots that do not do what they should -------------------------------------------------------------------------------

EITHER = """
poi "a"
poi "b"
poi "c"
connect a and b distance 3
connect b and c distance 3
event "fetch" location a duration 3
agent "bot1" controllable mobile 3 location b can_do fetch
agent "bot2" controllable mobile 3 location c can_do fetch
reach_objective: do fetch after 0
"""
"""Each robot could do the work alone; bot1 is nearer."""


@pytest.fixture(scope="module")
def either(ros: Ros, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A workspace in which one robot can do another one's work."""
    folder = tmp_path_factory.mktemp("either")
    (folder / "either.pur").write_text(EITHER)
    return lay_over(ros, generated(str(folder / "either"), folder / "ws"))


def test_early_and_late_robots_are_followed_failed_ones_replaced_and_where_nobody_is_left_it_stops(
    ros: Ros, either: Path, tmp_path: Path
) -> None:
    """The test plays the robots: it reports what becomes of their orders, each while the model has time for it."""
    with launched(ros, either, tmp_path, **PLAYED, use_sim_time=True, speed=2, lost_after=FOR_EVER) as run:
        run.until_step("bot1_b2a")
        run.publish("bot1_going_b_to_a2a")
        assert run.until_step("bot1_going_b_to_a2a")["clocks"]["Cbot2"] < 9, "the model says 10 and more"
        run.until(lambda: run.values("observer").get("untimely") == "1")
        run.until_step("fetch")
        assert orders_of(run)["bot2"] == []

        run.publish("bot1:_failed_")
        run.until(lambda: "plan" in run.now())
        hold = next(state for state in run.states() if state.status == "holding" and "lost" in state)
        assert (hold["lost"], hold["reason"]) == ("bot1", "bot1 has failed; looking for another plan")
        run.until_step("bot2_c2b")

        run.until(lambda: "bot2" in run.values("observer").get("late", "").split())
        assert (run.now().status, run.now()["lost"]) == ("running", "bot1")
        run.publish("bot2_going_c_to_b2b")
        run.until_step("bot2_b2a")
        orders = len(run.orders())
        run.publish("bot2:_failed_")
        status = run.until_over()
        last = run.now()
    assert status == "stopped" and last["lost"] == "bot1,bot2", last
    assert "bot2 has failed" in last["reason"] and "no other plan: " in last["reason"]
    assert len(run.orders()) == orders and "The mission was stopped" in run.verdict()
    assert "The mission was stopped" in run.output() and last["reason"] in run.output()


def test_a_robot_that_is_lost_is_planned_without_and_counts_again_when_it_reports(
    ros: Ros, scenario: Path, tmp_path: Path
) -> None:
    """The plan goes to everybody before it is in force, and outlives the observer for who comes later."""
    request, leave = tmp_path / "request", tmp_path / "leave"
    planner = f"python3 {FAKE_PLANNER} {scenario / 'src'} {request} {leave}"
    with launched(
        ros, scenario, tmp_path, **PLAYED, use_sim_time=True, speed=3, lost_after=8, planner=planner,
        planning_limit=1,
    ) as run:
        run.until_step("bot2_c2a")
        observer = run.pid("observer")
        run.publish("bot1_going_c_to_b2b")
        run.until_step("bot1_inb")
        run.publish("bot1_inbDONE")
        hold = run.until(lambda: run.now().status == "holding" and run.now())
        assert hold["lost"] == "bot2" and "looking for another plan" in hold["reason"]
        run.publish(f"bot1:bot1_b2c@{hold.seq}")  # at another time it could be
        run.until(lambda: run.values("observer").get("held") == "1")
        for seconds in (1, 2):
            slow = f"no other plan was found in {seconds} s (~planning_limit), still looking"
            run.until(lambda slow=slow: any(slow in state["reason"] for state in run.states()))
        assert (run.now().status, run.pid("observer")) == ("holding", observer)
        run.until(lambda: float(run.values("observer")["planning"].split()[0]) >= 3)
        leave.touch()
        running = run.until(lambda: run.now().status == "running" and run.now())
        before = [state for state in run.states() if state.seq < running.seq][-1]
        assert before.status == "holding" and running.seq == before.seq + 1
        plan = running["plan"]  # the first one that was looked for relies on bot2, which was late
        assert (running["lost"], running["reason"]) == ("bot2", "")
        (journal,) = (tmp_path / "home" / "pursue" / "scenario_1").glob("journal-*.jsonl")
        calls = read_records(str(journal)).records[1:]
        swap = next(number for number, call in enumerate(calls) if call["seq"] == running.seq)
        has = {word for call in calls[:swap + 1] for word in call["args"] if str(word).endswith(f":_plan_@{plan}")}
        assert has == {f"{node}:_plan_@{plan}" for node in ("controller_bot1", "controller_bot2", "controllerObj")}
        assert json.loads(request.read_text())["excused"] == ["bot2"]

        run.until_back("observer", run.kill("observer"))
        run.until_back("controller_bot2", run.kill("controller_bot2"))
        assert (run.now()["plan"], run.now().seq) == (plan, running.seq)
        run.publish("bot2_going_c_to_a2a")
        assert "lost" not in run.until_step("bot2_ina")
        run.publish("bot2_inaDONE")
        status = run.until_over()
    assert (status, run.steps()) == ("won", [step for step in STEPS if step != "bot2_going_c_to_a2a"][:6] + [
        "bot2_going_c_to_a2a", "bot2_ina", "bot2_inaDONE"]), run.output()
    check_time(run)


# Nodes that are gone for longer ---------------------------------------------------------------------------------------


def test_without_a_controller_the_mission_holds_and_goes_on_when_it_is_back(
    ros: Ros, scenario: Path, tmp_path: Path
) -> None:
    with launched(
        ros, scenario, tmp_path, use_sim_time=True, speed=2, delays="middle", silence=4, respawn=False
    ) as run:
        run.until_step("bot2_c2a")
        frozen = run.kill("controller_bot1", signal.SIGSTOP)
        why = "controller_bot1 is silent"
        hold = run.until(lambda: next((state for state in run.states() if state["reason"] == why), None))
        before = [state for state in run.states() if state.seq < hold.seq][-1]  # robots may have arrived meanwhile
        assert hold.status == "holding" and hold.seq == before.seq + 1
        os.kill(frozen, signal.SIGCONT)
        run.until(lambda: run.now().status == "running")

        run.until_step("bot1_inb")
        run.kill("controller_bot2")
        hold = run.until(lambda: run.now()["reason"] == "controller_bot2 is silent" and run.now())
        assert hold.status == "holding" and "bot2_ina" not in run.steps()
        with run.node("controller_bot2", "controller_bot2"):
            run.until_step("bot2_ina")
            status = run.until_over()
    assert (status, orders_of(run)) == ("won", ORDERS), run.output()
    check_steps(run)
    check_time(run)


def test_a_late_node_sees_the_mission_and_a_stop_ends_all_nodes_with_status_1(
    ros: Ros, scenario: Path, tmp_path: Path
) -> None:
    """Nothing is started again here but by hand."""
    with launched(ros, scenario, tmp_path, required=False, respawn=False, time_unit=6) as run:
        before = run.until_step("bot2_c2a")
        (journal,) = (tmp_path / "home" / "pursue" / "scenario_1").glob("journal-*.jsonl")
        launch = journal.stem.replace("journal-", "--launch=")
        run.kill("observer")
        run.publish("Finish!")  # not the observer's
        time.sleep(2.5)
        known = len(run.states())
        with run.node("observer", "observer", launch) as observer, run.node("UI", "UI", "__name:=UI2") as late:
            run.until(lambda: "the mission runs" in late.output())
            after = run.until(lambda: run.states()[known:])[-1]
            assert (after.seq, after.status) == (before.seq, "running")
            assert run.pid("UI") and run.pid("controller_bot1")
            orders = run.orders()
            run.publish("_stop_")
            stopped = time.monotonic()
            assert (late.wait(), observer.wait()) == (1, 1)
            run.until_over()
            assert time.monotonic() - stopped < 60  # some seconds, on a machine that does nothing else
    assert "The mission was stopped" in late.output() and run.orders() == orders
    ended = dict(re.findall(r"\[(\w+)-\d+\] process has died \[pid \d+, exit code (-?\d+)", run.output()))
    nodes = [node for node in NODES if node != "sim_clock"]
    assert ended == {**dict.fromkeys(nodes, "1"), "observer": "-9"}, run.output()
    assert run.output().count("the mission is stopped") <= len(nodes), "each node says it once"
