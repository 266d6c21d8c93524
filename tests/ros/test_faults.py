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
from ros_world import Ros, generated, make
from stage import EVENTS, Stage, staged

from tests.waiting import PATIENCE

Build = Callable[..., Path]

pytestmark = pytest.mark.ros

STEPS = [
    "reachObj_going_initial_location2unlocked", "bot1_c2b", "bot2_c2a", "bot1_going_c_to_b2b", "bot2_going_c_to_a2a",
    "bot1_inb", "bot1_inbDONE", "bot2_ina", "bot2_inaDONE",
]
"""Scenario 1 from start to goal, where every movement takes the middle of its window, and commands no time."""

ORDERS = {"bot1": ["[0.0, 3.1]", "bot1_inb"], "bot2": ["[5.13, 0.0]", "bot2_ina"]}
"""What each robot is told in it."""

FAKE_PLANNER = Path(__file__).resolve().parent / "fake_planner.py"

FOR_EVER = 1000
"""Time units after which who is late counts as lost, where nobody is to: nodes that are started anew take a while."""

NODES = ("observer", "controller_bot1", "controller_bot2", "controllerObj", "simulator", "sim_clock", "UI")


@pytest.fixture(scope="module")
def scenario(built: Build) -> Path:
    """The workspace in which things go wrong."""
    return built("thesis/scenario_1")


def told(stage: Stage) -> Dict[str, List[str]]:
    """What each robot was told, by robot."""
    return {robot: [order for who, order in stage.orders() if who == robot] for robot in ORDERS}


def check_steps(stage: Stage) -> None:
    """Each step was taken once, each robot's in their order, and bot2 has waited for bot1. Apart from that either robot
    may be the first: commands may come late."""
    steps = stage.steps()
    for who in ("reachObj", "bot1", "bot2"):
        own, wanted = ([step for step in some if step.startswith(who)] for some in (steps, STEPS))
        assert own == wanted, steps
    assert len(steps) == len(STEPS) and steps.index("bot1_inbDONE") < steps.index("bot2_ina"), steps


def check_time(stage: Stage) -> None:
    """The states are one mission: numbers and stamps never go back, and clocks run with the stamps."""
    states = [state for state in stage.states() if state.seq > 0]
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
def turns(ros: Ros, scenario: Path, tmp_path_factory: pytest.TempPathFactory) -> Tuple[Stage, List[Turn]]:
    """One mission in which each node is killed in turn; a slow one, so that nodes are back before the next turn."""
    found = []
    folder = tmp_path_factory.mktemp("turns")
    with staged(ros, scenario, folder, use_sim_time=True, speed=0.5, delays="middle", lost_after=FOR_EVER) as stage:
        for step, sign, nodes in TURNS:
            stage.until_step(step)
            states = stage.states()
            before, known = states[-1].seq, len(states)
            killed = [(node, stage.kill(node, sign)) for node in nodes]
            for node, process in killed:
                stage.until_back(node, process)
            heard = stage.until(lambda known=known: stage.states()[known:])
            found.append(Turn(before, [state.seq for state in heard]))
        stage.until_over()
    return stage, found


@pytest.mark.parametrize("turn", range(len(TURNS)), ids=[f"{sign.name} {' '.join(nodes)}" for _, sign, nodes in TURNS])
def test_after_a_kill_the_mission_goes_on_from_the_same_state(turns: Tuple[Stage, List[Turn]], turn: int) -> None:
    before, heard = turns[1][turn]
    assert heard, "no state was heard until the node was back"
    assert heard[0] in (before, before + 1)


def test_where_each_node_is_killed_in_turn_every_step_is_taken_once_and_in_order(
    turns: Tuple[Stage, List[Turn]]
) -> None:
    stage = turns[0]
    check_steps(stage)
    assert stage.now().status == "won" and "finished cleanly" in stage.verdict(), stage.output()
    check_time(stage)
    for robot, orders in told(stage).items():
        assert list(dict.fromkeys(orders)) == ORDERS[robot]  # a controller that comes back says again what is under way
        assert len(orders) <= len(ORDERS[robot]) + 1
    assert stage.crashes() == [], stage.output()


def test_a_command_that_nobody_heard_is_said_until_it_is_answered(ros: Ros, scenario: Path, tmp_path: Path) -> None:
    """The observer is away when the first commands come, for longer than until they are said for the second time."""
    with staged(ros, scenario, tmp_path, use_sim_time=True, speed=3, delays="middle") as stage:
        stage.until_step("reachObj_going_initial_location2unlocked")
        stage.kill("observer")
        assert stage.until_over() == "won", stage.output()
    check_steps(stage)


def test_all_nodes_may_be_killed_at_once(ros: Ros, scenario: Path, tmp_path: Path) -> None:
    with staged(
        ros, scenario, tmp_path, use_sim_time=True, speed=2, delays="middle", lost_after=FOR_EVER
    ) as stage:
        before = stage.until_step("bot2_c2a")
        stage.until(lambda: float(stage.now()["stamp"]) > float(before["stamp"]))
        processes = {node: stage.pid(node) for node in NODES}
        for node in NODES:
            stage.kill(node)
        for node, process in processes.items():
            stage.until_back(node, process)
        stage.until_step("bot2_ina")
        sleeping = stage.kill("UI", signal.SIGSTOP)
        stage.until(lambda: stage.now().status == "won")
        os.kill(sleeping, signal.SIGKILL)  # it never knew, and the observer is about to end
        status = stage.until_over()
    assert status == "won" and "finished cleanly" in stage.verdict(), stage.output()
    # The clock may be back long before the others: who is late then may make the mission hold.
    holds = {state.seq for state in stage.states() if state.seq > before.seq and "event" not in state}
    assert stage.now().seq == before.seq + 6 + len(holds)
    check_steps(stage)
    check_time(stage)
    assert stage.crashes() == [], stage.output()


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
    with staged(ros, scenario, tmp_path, use_sim_time=True, speed=3, delays="middle") as stage:
        stage.tell({"repeat": [0.0, 1.0]})
        stage.until_step("bot2_c2a")
        processes = {node: stage.pid(node) for node in NODES}
        # Of what is impossible two are ignored without a count.
        more = {"unreadable": len(UNREADABLE), "impossible": len(IMPOSSIBLE) - 2, "stale": len(STALE)}
        least = {name: int(stage.values("observer").get(name, 0)) + number for name, number in more.items()}
        stage.say(*UNREADABLE, *IMPOSSIBLE, *STALE)
        stage.tell({"bytes": NO_TEXT})
        stage.until(lambda: all(int(stage.values("observer").get(name, 0)) >= count for name, count in least.items()))
        stage.until_step("bot1_inb")
        stage.say("bot1_going_c_to_b2b", "bot2_going_c_to_a2a", "bot2_ina@7", *UNREADABLE, *STALE)
        assert {node: stage.pid(node) for node in NODES} == processes
        status = stage.until_over()
        stage.until(lambda: stage.of(EVENTS, "observer"))
    assert (status, told(stage)) == ("won", ORDERS), stage.output()
    check_steps(stage)
    check_time(stage)
    assert [entry["data"] for entry in stage.of(EVENTS, "observer")] == ["Finish!"]
    assert stage.crashes() == [] and len(stage.output()) < 200000


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
    return make(ros, generated(str(folder / "either"), folder / "ws"))


def test_early_and_late_robots_are_followed_failed_ones_replaced_and_where_nobody_is_left_it_stops(
    ros: Ros, either: Path, tmp_path: Path
) -> None:
    """The robots are the witness: it says what becomes of their orders, each while the model has time for it."""
    with staged(ros, either, tmp_path, simulate=False, use_sim_time=True, speed=2, lost_after=FOR_EVER) as stage:
        stage.until_step("bot1_b2a")
        stage.say("bot1_going_b_to_a2a")
        assert stage.until_step("bot1_going_b_to_a2a")["clocks"]["Cbot2"] < 9, "the model says 10 and more"
        stage.until(lambda: stage.values("observer").get("untimely") == "1")
        stage.until_step("fetch")
        assert told(stage)["bot2"] == []

        stage.say("bot1:_failed_")
        stage.until(lambda: "plan" in stage.now())
        hold = next(state for state in stage.states() if state.status == "holding" and "lost" in state)
        assert (hold["lost"], hold["reason"]) == ("bot1", "bot1 has failed; looking for another plan")
        stage.until_step("bot2_c2b")

        stage.until(lambda: "bot2" in stage.values("observer").get("late", "").split())
        assert (stage.now().status, stage.now()["lost"]) == ("running", "bot1")
        stage.say("bot2_going_c_to_b2b")
        stage.until_step("bot2_b2a")
        orders = len(stage.orders())
        stage.say("bot2:_failed_")
        status = stage.until_over()
        last = stage.now()
    assert status == "stopped" and last["lost"] == "bot1,bot2", last
    assert "bot2 has failed" in last["reason"] and "no other plan: " in last["reason"]
    assert len(stage.orders()) == orders and "exit code 1" in stage.verdict()
    assert "The mission was stopped" in stage.output() and last["reason"] in stage.output()


def test_a_robot_that_is_lost_is_planned_without_and_counts_again_when_it_reports(
    ros: Ros, scenario: Path, tmp_path: Path
) -> None:
    """The plan goes to everybody before it is in force, and outlives the observer for who comes later."""
    request, leave = tmp_path / "request", tmp_path / "leave"
    planner = f"python3 {FAKE_PLANNER} {scenario / 'src'} {request} {leave}"
    with staged(
        ros, scenario, tmp_path, simulate=False, use_sim_time=True, speed=3, lost_after=8, planner=planner,
        planning_limit=PATIENCE,
    ) as stage:
        stage.until_step("bot2_c2a")
        stage.say("bot1_going_c_to_b2b")
        stage.until_step("bot1_inb")
        stage.say("bot1_inbDONE")
        hold = stage.until(lambda: stage.now().status == "holding" and stage.now())
        assert hold["lost"] == "bot2" and "looking for another plan" in hold["reason"]
        stage.say(f"bot1:bot1_b2c@{hold.seq}")  # at another time it could be
        stage.until(lambda: stage.values("observer").get("held") == "1")
        leave.touch()
        running = stage.until(lambda: stage.now().status == "running" and stage.now())
        assert (running["plan"], running["lost"], running.seq) == ("1", "bot2", hold.seq + 1)
        (journal,) = (tmp_path / "home" / "pursue" / "scenario_1").glob("journal-*")
        calls = [json.loads(line) for line in journal.read_text().rpartition("\n")[0].splitlines()[1:]]
        swap = next(number for number, call in enumerate(calls) if call["seq"] == running.seq)
        has = {word for call in calls[:swap + 1] for word in call["args"] if str(word).endswith(":_plan_@1")}
        assert has == {f"{node}:_plan_@1" for node in ("controller_bot1", "controller_bot2", "controllerObj")}
        assert json.loads(request.read_text())["excused"] == ["bot2"]

        stage.until_back("observer", stage.kill("observer"))
        stage.until_back("controller_bot2", stage.kill("controller_bot2"))
        assert (stage.now()["plan"], stage.now().seq) == ("1", running.seq)
        stage.say("bot2_going_c_to_a2a")
        assert "lost" not in stage.until_step("bot2_ina")
        stage.say("bot2_inaDONE")
        status = stage.until_over()
    assert (status, stage.steps()) == ("won", [step for step in STEPS if step != "bot2_going_c_to_a2a"][:6] + [
        "bot2_going_c_to_a2a", "bot2_ina", "bot2_inaDONE"]), stage.output()
    check_time(stage)


# Nodes that are gone for longer ---------------------------------------------------------------------------------------


def test_without_a_controller_the_mission_holds_and_goes_on_when_it_is_back(
    ros: Ros, scenario: Path, tmp_path: Path
) -> None:
    with staged(
        ros, scenario, tmp_path, use_sim_time=True, speed=2, delays="middle", silence=4, respawn=False
    ) as stage:
        stage.until_step("bot2_c2a")
        frozen = stage.kill("controller_bot1", signal.SIGSTOP)
        why = "controller_bot1 is silent"
        hold = stage.until(lambda: next((state for state in stage.states() if state["reason"] == why), None))
        before = [state for state in stage.states() if state.seq < hold.seq][-1]  # robots may have arrived meanwhile
        assert hold.status == "holding" and hold.seq == before.seq + 1
        os.kill(frozen, signal.SIGCONT)
        stage.until(lambda: stage.now().status == "running")

        stage.until_step("bot1_inb")
        stage.kill("controller_bot2")
        hold = stage.until(lambda: stage.now()["reason"] == "controller_bot2 is silent" and stage.now())
        assert hold.status == "holding" and "bot2_ina" not in stage.steps()
        with stage.node("controller_bot2", "controller_bot2"):
            stage.until_step("bot2_ina")
            status = stage.until_over()
    assert (status, told(stage)) == ("won", ORDERS), stage.output()
    check_steps(stage)
    check_time(stage)


def test_who_comes_later_sees_the_mission_and_a_stop_ends_everybody_with_status_1(
    ros: Ros, scenario: Path, tmp_path: Path
) -> None:
    """Nothing is started again here but by hand."""
    with staged(ros, scenario, tmp_path, required=False, respawn=False, time_unit=6) as stage:
        before = stage.until_step("bot2_c2a")
        stage.kill("observer")
        stage.say("Finish!")  # not the observer's
        time.sleep(2.5)
        known = len(stage.states())
        with stage.node("observer", "observer") as observer, stage.node("UI", "UI", "__name:=UI2") as late:
            stage.until(lambda: "the mission runs" in late.output())
            after = stage.until(lambda: stage.states()[known:])[-1]
            assert (after.seq, after.status) == (before.seq, "running")
            assert stage.pid("UI") and stage.pid("controller_bot1")
            orders = stage.orders()
            stage.say("_stop_")
            stopped = time.monotonic()
            assert (late.wait(), observer.wait()) == (1, 1)
            stage.until_over()
            assert time.monotonic() - stopped < 60  # some seconds, on a machine that does nothing else
    assert "The mission was stopped" in late.output() and stage.orders() == orders
    ended = dict(re.findall(r"\[(\w+)-\d+\] process has died \[pid \d+, exit code (-?\d+)", stage.output()))
    nodes = [node for node in NODES if node != "sim_clock"]
    assert ended == {**dict.fromkeys(nodes, "1"), "observer": "-9"}, stage.output()
