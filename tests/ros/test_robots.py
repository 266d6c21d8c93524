"""Robots as move_base shows them, instead of the simulator: whole missions by results, poses and tf; and failures."""

from __future__ import annotations

import contextlib
import re
import time
from pathlib import Path
from typing import Any

import pytest
from fake_robots import UNIT, Robots, played, playing, robots_workspace, wait_for, well
from ros_world import Ros, end

from pursue_gen.tools.replay import MissionRecord, read_recording

pytestmark = pytest.mark.ros


@pytest.fixture(scope="module")
def workspace(ros: Ros) -> Path:
    return robots_workspace(ros, "thesis/scenario_1", ("bot1", "bot2"))


def test_action_goals_a_failure_on_the_way_and_results_that_come_twice(
    ros: Ros, workspace: Path, tmp_path: Path
) -> None:
    (tmp_path / "own.yaml").write_text("bot1: {retry_delay: 0.1}\n")
    bot1 = {"plays": ["abort", "reject", "succeed"], "travel": 8.5 * UNIT}
    arguments = f"goals:=action ends:=result robots:={tmp_path}/own.yaml"
    robots, said = played(ros, workspace, tmp_path, arguments, bot1=bot1, bot2={"plays": ["twice"]})
    well(said)
    assert robots.heard("bot1") == ["goal b", "goal b", "goal b", "action bot1_inb"]
    assert robots.heard("bot2") == ["goal a", "action bot2_ina"]


def test_simple_goals_an_early_end_and_a_result_of_long_ago(ros: Ros, workspace: Path, tmp_path: Path) -> None:
    arguments = "goals:=simple ends:=result on_uncovered:=warn"
    robots, said = played(ros, workspace, tmp_path, arguments, bot1={"travel": 0.05}, bot2={"plays": ["stale"]})
    well(said)
    early = r"bot1 arrives at b \d+\.\d time units too early; the mission goes on from there"
    assert re.search(early, said) and "bot2 arrives at a " not in said, said[-8000:]
    assert robots.heard("bot2") == ["goal a", "action bot2_ina"]


def test_ends_are_seen_by_pose_and_by_tf(ros: Ros, workspace: Path, tmp_path: Path) -> None:
    own = "end_settle: 0.2\nbot1: {ends: pose, goals: simple}\nbot2: {ends: tf, goals: action}\n"
    (tmp_path / "own.yaml").write_text(own)
    slower = {"travel": 9.2 * UNIT}  # a robot is within the tolerance some moments before its goal
    robots, said = played(ros, workspace, tmp_path, f"robots:={tmp_path}/own.yaml", bot1=slower, bot2=slower)
    well(said)
    assert robots.heard("bot1") == ["goal b", "action bot1_inb"]
    assert robots.heard("bot2") == ["goal a", "action bot2_ina"]


def test_robots_have_namespaces_that_are_not_their_names(ros: Ros, workspace: Path, tmp_path: Path) -> None:
    own = "bot1: {namespace: tb3_0}\nbot2: {namespace: /lab/tb3_1, ends: tf, end_settle: 0.2}\n"
    (tmp_path / "own.yaml").write_text(own)
    bot1, bot2 = {"namespace": "tb3_0"}, {"namespace": "lab/tb3_1", "travel": 9.2 * UNIT}
    arguments = f"robots:={tmp_path}/own.yaml record:={tmp_path}/mission.bag"
    robots, said = played(ros, workspace, tmp_path, arguments, bot1=bot1, bot2=bot2)
    well(said)
    assert robots.heard("bot1") == ["goal b", "action bot1_inb"]
    assert robots.heard("bot2") == ["goal a", "action bot2_ina"]
    record = read_recording(tmp_path / "mission.bag")
    assert isinstance(record, MissionRecord)
    given = [(order.robot, order.is_goal) for order in record.orders]
    assert sorted(given) == [("bot1", False), ("bot1", True), ("bot2", False), ("bot2", True)]


def test_a_robot_that_cannot_go_fails_and_others_are_called_back_when_the_mission_stops(
    ros: Ros, workspace: Path, tmp_path: Path
) -> None:
    (tmp_path / "own.yaml").write_text("retries: 1\nretry_delay: 4\n")  # until then bot2, too, is on its way
    arguments = f"ends:=result on_stop:=cancel planner:=off robots:={tmp_path}/own.yaml"
    bot1, bot2 = {"plays": ["abort"]}, {"plays": ["never"]}
    with playing(ros, workspace, tmp_path, arguments, bot1=bot1, bot2=bot2) as (robots, log, mission):
        failed = r"reports bot1:_stuck_#\d+ on its way to b: it finds no free motion, in 2 attempts"
        wait_for(lambda: bool(re.search(failed, log.read_text())), log, "bot1 has not failed")
        wait_for(lambda: "goal a" in robots.heard("bot2"), log, "bot2 is not sent")
        wait_for(lambda: "cancel" in robots.heard("bot2"), log, "bot2 is not called back")
        wait_for(lambda: mission.poll() is not None, log, "the mission does not end")
        assert robots.heard("bot1") == ["goal b", "goal b"]


def test_a_robot_that_connects_late_is_reported_and_is_called_back_when_its_controller_is_interrupted(
    ros: Ros, workspace: Path, tmp_path: Path
) -> None:
    locations = {"bot1": "going_c_to_b", "bot2": "c", "rule1": "rule1_initial_location", "reachObj": "unlocked"}
    automata = [f"{{name: {name}, location: {location}}}" for name, location in locations.items()]
    clocks = "[{name: Cbot1, value: 1.0}, {name: Cbot2, value: 1.0}]"
    fields = f"seq: 3, stamp: {{secs: 1}}, time_unit: 1.0, automata: [{', '.join(automata)}], clocks: {clocks}"
    fields += ", orders: ['bot1:bot1_c2b@3/going_c_to_b']"
    publish = f"exec rostopic pub -l pursue/state pursue_msgs/SystemState '{{{fields}, status: %s}}'"
    told = {status: publish % status for status in ("holding", "running")}
    command = "exec rosrun controller_bot1 controller_bot1 _goals:=action _on_stop:=cancel"
    with contextlib.ExitStack() as cleanup:
        there = cleanup.enter_context(ros.master())

        def start(command: str, log: Path) -> Any:
            process = ros.start(f"source devel/setup.bash; {command}", workspace, log, **there)
            cleanup.callback(end, process)
            return process

        controller, log = start(command, tmp_path / "controller"), tmp_path / "controller"
        holding = start(told["holding"], tmp_path / "holding")
        robots = Robots(ros, workspace, tmp_path, there)
        cleanup.callback(robots.end)
        wait_for(lambda: "bot1/amcl_pose" in ros.run("rostopic list", workspace, **there).stdout, log, "no robots")
        assert "bot1 goes to b" not in log.read_text() and robots.heard("bot1") == [], "nobody sets out in a hold"
        end(holding)
        start(told["running"], tmp_path / "running")
        wait_for(lambda: robots.heard("bot1") == ["goal b"], log, "bot1 was not told")
        end(controller)
        wait_for(lambda: robots.heard("bot1") == ["goal b", "cancel"], log, "bot1 was not called back")


def test_a_simple_goal_that_a_restarted_move_base_has_lost_is_sent_again(
    ros: Ros, workspace: Path, tmp_path: Path
) -> None:
    # Once more the goal comes as soon as move_base connects: before its action server is up.
    bot1 = {"travel": 6.0, "reboot": 1.5}
    with playing(ros, workspace, tmp_path, "goals:=simple ends:=result", bot1=bot1) as (robots, log, mission):
        wait_for(lambda: robots.heard("bot1") == ["goal b"], log, "bot1 was not sent")
        robots.order("bot1", "restart 0.3")
        wait_for(lambda: mission.poll() is not None, log, "the mission does not end")
    well(log.read_text())
    heard = robots.heard("bot1")
    assert heard[:2] == ["goal b", "lost b"] and "lost b" not in heard[3:], heard
    assert heard[-2:] == ["goal b", "action bot1_inb"], heard
    assert len(heard) <= 5, f"a goal that was taken is not sent again: {heard}"


@pytest.mark.parametrize("goals", ["simple", "action"])
def test_a_robot_that_a_person_sends_elsewhere_is_taken_back_and_held_if_the_person_insists(
    ros: Ros, workspace: Path, tmp_path: Path, goals: str
) -> None:
    (tmp_path / "own.yaml").write_text("retries: 1\n")
    arguments = f"goals:={goals} ends:=result planner:=off robots:={tmp_path}/own.yaml"
    with playing(ros, workspace, tmp_path, arguments, bot1={"travel": 4.0}) as (robots, log, mission):
        wait_for(lambda: robots.heard("bot1") == ["goal b"], log, "bot1 was not sent")
        position = "{x: -7.0, y: 7.0}"
        pose = f"{{header: {{frame_id: map}}, pose: {{position: {position}, orientation: {{w: 1.0}}}}}}"
        robots.publish("bot1/move_base_simple/goal", "geometry_msgs/PoseStamped", pose)
        taken_back = ["goal b", "goal -7.00", "goal b"]
        wait_for(lambda: robots.heard("bot1") == taken_back, log, "it is not taken back")
        again = "bot1 on its way to b: sent elsewhere by another node; its goal is sent again"
        wait_for(lambda: again in log.read_text(), log, "the operator does not see it")
        robots.publish("bot1/move_base_simple/goal", "geometry_msgs/PoseStamped", pose)
        held = "the mission holds: bot1 on its way to b: preempted by another node 2 times: "
        wait_for(lambda: held in log.read_text(), log, "no hold")
        said = log.read_text()
        assert "because another goal was received" in said and "publish bot1:_resume_ to continue" in said
        wait_for(lambda: robots.at("bot1") == (-7.0, 7.0), log, "it does not go where the person sends it")
        robots.publish("pursue/events", "std_msgs/String", "bot1:_resume_")
        wait_for(lambda: mission.poll() is not None, log, "the mission does not end")
    well(log.read_text())
    assert robots.heard("bot1") == [*taken_back, "goal -7.00", "goal b", "action bot1_inb"]
    assert robots.actions("bot1") == ["bot1_inb at b"]


def test_a_cancelled_goal_holds_the_robot_and_does_not_start_again(
    ros: Ros, workspace: Path, tmp_path: Path
) -> None:
    arguments = "goals:=action ends:=result planner:=off"
    with playing(ros, workspace, tmp_path, arguments, bot1={"travel": 4.0}) as (robots, log, mission):
        wait_for(lambda: robots.heard("bot1") == ["goal b"], log, "bot1 was not sent")
        robots.publish("bot1/move_base/cancel", "actionlib_msgs/GoalID", "{}")
        wait_for(lambda: "the mission holds: bot1 on its way to b: preempted" in log.read_text(), log, "no hold")
        time.sleep(3.0)
        assert robots.heard("bot1") == ["goal b", "cancel"]
        robots.publish("pursue/events", "std_msgs/String", "bot1:_resume_")
        wait_for(lambda: mission.poll() is not None, log, "the mission does not end")
    well(log.read_text())
    assert robots.heard("bot1") == ["goal b", "cancel", "goal b", "action bot1_inb"]


@pytest.mark.parametrize("what", ["cancel", "goal"])
def test_what_comes_while_move_base_recovers_is_answered_later(
    ros: Ros, workspace: Path, tmp_path: Path, what: str
) -> None:
    arguments = "goals:=action ends:=result planner:=off lost_after:=2000"
    bot1 = {"plays": ["stuck", "succeed"], "recovery": 25.0}
    with playing(ros, workspace, tmp_path, arguments, bot1=bot1) as (robots, log, mission):
        wait_for(lambda: robots.heard("bot1") == ["goal b"], log, "bot1 was not sent")
        if what == "cancel":
            robots.publish("bot1/move_base/cancel", "actionlib_msgs/GoalID", "{}")
            wait_for(lambda: "the mission holds: bot1 on its way to b: preempted" in log.read_text(), log, "no hold")
            robots.publish("pursue/events", "std_msgs/String", "bot1:_resume_")
        else:
            pose = "{header: {frame_id: map}, pose: {position: {x: -7.0, y: 7.0}, orientation: {w: 1.0}}}"
            robots.publish("bot1/move_base_simple/goal", "geometry_msgs/PoseStamped", pose)
        wait_for(lambda: mission.poll() is not None, log, "the mission does not end")
    well(log.read_text())
    between = ["cancel"] if what == "cancel" else ["goal -7.00"]
    assert robots.heard("bot1") == ["goal b", *between, "goal b", "action bot1_inb"]


def test_the_log_has_the_words_of_move_base_and_the_reason_what_they_mean(
    ros: Ros, workspace: Path, tmp_path: Path
) -> None:
    (tmp_path / "own.yaml").write_text("retries: 0\n")
    arguments = f"goals:=action ends:=result planner:=off robots:={tmp_path}/own.yaml"
    _, said = played(ros, workspace, tmp_path, arguments, bot1={"plays": ["stuck"], "recovery": 1.0})
    own = "(move_base: Failed to find a valid plan. Even after executing recovery behaviors.)"
    assert f"bot1 on its way to b: it finds no way {own}" in said, said[-8000:]
    why = "bot1 gave up on its way to b: it finds no way; no other plan"
    assert re.search(rf"The mission was stopped, .*: {why}", said), said[-8000:]
    assert said.count(why) == 2, "the UI says it, and the log of the observer has it"


@pytest.mark.parametrize("ends", ["result", "pose", "tf"])
def test_a_robot_that_was_taken_away_returns_before_its_action(
    ros: Ros, workspace: Path, tmp_path: Path, ends: str
) -> None:
    (tmp_path / "own.yaml").write_text("end_settle: 0.2\n")
    arguments = f"goals:=action ends:={ends} on_uncovered:=warn lost_after:=2000 robots:={tmp_path}/own.yaml"
    bot1 = {"acts": -1.0}  # bot2 waits at a until a person reports that bot1 has finished
    with playing(ros, workspace, tmp_path, arguments, bot1=bot1) as (robots, log, mission):
        wait_for(lambda: "bot2 arrives at a" in log.read_text(), log, "bot2 has not arrived")
        robots.order("bot2", "put 9.0 9.0 0.0")
        wait_for(lambda: "bot2 is " in log.read_text() and "where the state has it" in log.read_text(), log, "not seen")
        assert robots.heard("bot2") == ["goal a"], "it may stay there while nothing waits for it"
        wait_for(lambda: robots.actions("bot1") != [], log, "bot1 does not act")
        robots.publish("pursue/events", "std_msgs/String", "'bot1_inbDONE'")
        wait_for(lambda: mission.poll() is not None, log, "the mission does not end")
    well(log.read_text())
    assert robots.heard("bot2") == ["goal a", "goal a", "action bot2_ina"]
    assert robots.actions("bot2") == ["bot2_ina at a"]
    assert "where the state has it: it is sent back" in log.read_text()


def test_tf_is_looked_at_however_often_other_messages_come(ros: Ros, workspace: Path, tmp_path: Path) -> None:
    often = {"status": 0.05}
    robots, said = played(ros, workspace, tmp_path, "goals:=action ends:=tf", bot1=often, bot2=often)
    well(said)
    assert robots.actions("bot1") == ["bot1_inb at b"] and robots.actions("bot2") == ["bot2_ina at a"]


def test_a_robot_whose_position_is_not_published_any_more_may_be_elsewhere(
    ros: Ros, workspace: Path, tmp_path: Path
) -> None:
    arguments = "goals:=action ends:=result on_uncovered:=warn lost_after:=2000"
    bot1 = {"acts": -1.0}  # bot2 waits at a until a person reports that bot1 has finished
    with playing(ros, workspace, tmp_path, arguments, bot1=bot1) as (robots, log, mission):
        wait_for(lambda: "bot2 arrives at a" in log.read_text(), log, "bot2 has not arrived")
        robots.order("bot2", "tf off")
        robots.order("bot2", "put 9.0 9.0 0.0")
        wait_for(lambda: "bot2 is not known to be at a: no position" in log.read_text(), log, "it is believed")
        robots.order("bot2", "tf on")
        wait_for(lambda: robots.actions("bot1") != [], log, "bot1 does not act")
        robots.publish("pursue/events", "std_msgs/String", "'bot1_inbDONE'")
        wait_for(lambda: mission.poll() is not None, log, "the mission does not end")
    well(log.read_text())
    assert robots.actions("bot2") == ["bot2_ina at a"]


def test_a_robot_that_looks_the_wrong_way_has_not_arrived(ros: Ros, workspace: Path, tmp_path: Path) -> None:
    (tmp_path / "own.yaml").write_text("end_settle: 0.2\n")
    arguments = f"goals:=action ends:=pose planner:=off robots:={tmp_path}/own.yaml"
    with playing(ros, workspace, tmp_path, arguments, bot1={"plays": ["turned"]}) as (robots, log, mission):
        wait_for(lambda: "goal reached, but the position is not at b yet" in log.read_text(), log, "it is believed")
        time.sleep(1.0)
        assert "reports bot1_going_c_to_b2b" not in log.read_text()
        x, y = robots.at("bot1")
        robots.order("bot1", f"put {x} {y} 0.1")
        wait_for(lambda: mission.poll() is not None, log, "the mission does not end")
    well(log.read_text())


@pytest.mark.parametrize(
    ("parameters", "hidden", "message"),
    [
        ("_simulated:=true _ends:=pose", "", "bot1, which is simulated"),
        ("_ends:=result", "move_base_msgs", "ends:=result needs the ROS package move_base_msgs"),
    ],
)
def test_settings_that_cannot_be_end_the_controller_with_status_3(
    ros: Ros, workspace: Path, tmp_path: Path, parameters: str, hidden: str, message: str
) -> None:
    if hidden:
        (tmp_path / f"{hidden}.py").write_text("raise ImportError('not here')\n")
    command = f"export PYTHONPATH={tmp_path}:$PYTHONPATH; exec rosrun controller_bot1 controller_bot1 {parameters}"
    with ros.master() as there:
        done = ros.run(f"source devel/setup.bash; {command}", workspace, **there)
    assert (done.returncode, message in done.stdout, "Traceback" in done.stdout) == (3, True, False), done.stdout


# Collaborative events -------------------------------------------------------------------------------------------------


def test_a_partner_gets_the_event_once(ros: Ros, tmp_path: Path) -> None:
    pair = robots_workspace(ros, "thesis/scenario_2", ("bot1", "bot2", "bot3"))
    with playing(ros, pair, tmp_path, "goals:=action ends:=result") as (robots, log, mission):
        wait_for(lambda: mission.poll() is not None, log, "the mission does not end")
    assert "The goal is reached" in log.read_text(), log.read_text()[-8000:]
    assert robots.actions("bot2") == ["bot2_ina at a"]
    assert robots.actions("bot3") == ["bot2_ina at a"]
    assert robots.actions("bot1") == ["bot1_inb at b"]


def test_a_partner_that_was_taken_away_returns_before_the_event(ros: Ros, tmp_path: Path) -> None:
    pair = robots_workspace(ros, "thesis/scenario_2", ("bot1", "bot2", "bot3"))
    arguments = "goals:=action ends:=result on_uncovered:=warn"
    with playing(ros, pair, tmp_path, arguments, bot1={"acts": 8.0}) as (robots, log, mission):
        wait_for(lambda: "bot3 arrives at a" in log.read_text(), log, "bot3 has not arrived")
        robots.order("bot3", "put 9.0 9.0 0.0")
        wait_for(lambda: mission.poll() is not None, log, "the mission does not end")
    assert "The goal is reached" in log.read_text(), log.read_text()[-8000:]
    assert "bot3 is" in log.read_text() and "where the state has it: it is sent back" in log.read_text()
    assert (robots.actions("bot2"), robots.actions("bot3")) == (["bot2_ina at a"], ["bot2_ina at a"])
