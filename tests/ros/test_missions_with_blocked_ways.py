"""A way that is blocked, in a mission: the planner finds a plan that avoids it, and robots take the other way."""

from __future__ import annotations

import re
import sys
import time
from pathlib import Path

import pytest
import yaml
from launched_mission import ENDED, PLAYED, LaunchedMission, State, launched
from ros_world import Ros, generated, lay_over

from tests.waiting import PATIENCE

pytestmark = pytest.mark.ros

RING = """
poi "a"
poi "b"
poi "c"
poi "d"
connect a and b distance 2
connect b and c distance 2
connect c and d distance 3
connect d and a distance 3
event "fetch" location c duration 2
agent "bot1" controllable mobile 2 location a can_do fetch
agent "bot2" controllable mobile 2 location a can_do fetch
reach_objective: do fetch after 0
"""
"""Two ways lead from a to c: the one by b is shorter."""

ENDS = {
    **{f"going_{x}_to_{y}": 4 for x, y in ("ab", "ba", "bc", "cb")},
    **{f"going_{x}_to_{y}": 6 for x, y in ("cd", "dc", "da", "ad")},
    "doing_fetch_in_c": 2,
}
"""The time units after which each movement and action may end."""

BLOCKED = ("going_b_to_c", "going_c_to_b")

PLANNER = f"env PYTHONPATH={Path(__file__).resolve().parents[2]} {sys.executable} -m pursue_gen replan"
"""The real one, of these sources."""

FAKE = Path(__file__).resolve().parent / "fake_move_base.py"

LATE = 1000
"""Time units by which robots may be late in their model: the test plays them, and a machine may stand still."""


def workspace(ros: Ros, folder: Path, *robots: str) -> Path:
    """A workspace of the ring with these robots."""
    lines = [line for line in RING.splitlines() if "agent" not in line or any(robot in line for robot in robots)]
    (folder / "ring.pur").write_text("\n".join(lines))
    return lay_over(ros, generated(str(folder / "ring"), folder / "ws", slack=dict.fromkeys(robots, LATE)))


@pytest.fixture(scope="module")
def ring(ros: Ros, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return workspace(ros, tmp_path_factory.mktemp("ring"), "bot1", "bot2")


@pytest.fixture(scope="module")
def alone(ros: Ros, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return workspace(ros, tmp_path_factory.mktemp("alone"), "bot1")


def need_messages(ros: Ros) -> None:
    found = ros.run("python3 -c 'import move_base_msgs.msg, actionlib_msgs.msg, tf2_ros'", ros.home)
    if found.returncode:
        pytest.skip(f"no messages of move_base here: {found.stdout.strip().splitlines()[-1]}")


def drive(run: LaunchedMission, until_location: str = "") -> State:
    """Robots do what the state shows, each in its window, until one is at this location or the mission is over."""
    ended = set()
    deadline = time.monotonic() + 2 * PATIENCE
    while time.monotonic() < deadline:
        state = run.now()
        places = {name: place for name, place in state.get("places", {}).items() if name in ("bot1", "bot2")}
        if until_location in places.values() or state.status in ENDED:
            return state
        for robot, place in places.items():
            key = robot, place, sum(event.startswith(robot) for event in run.steps())
            lost = robot in state.get("lost", "").split(",")
            if place in ENDS and not lost and key not in ended and state["clocks"][f"C{robot}"] > ENDS[place] + 0.2:
                ended.add(key)
                run.publish("fetchDONE" if place.startswith("doing") else f"{robot}_{place}2{place[-1]}")
        time.sleep(0.05)
    raise AssertionError(f"not over: {run.now()}\n{run.steps()}\n{run.output()[-6000:]}")


def test_a_blocked_way_is_avoided_by_the_new_plan(ros: Ros, ring: Path, tmp_path: Path) -> None:
    with launched(ros, ring, tmp_path, **PLAYED, time_unit=0.5, lost_after=LATE, planner=PLANNER) as run:
        drive(run, "going_a_to_b")
        run.publish("going_c_to_b:_blocked_")
        hold = run.until(lambda: next((state for state in run.states() if state.status == "holding"), None))
        assert hold["reason"] == "the way between b and c is blocked; looking for another plan"
        run.until(lambda: "plan" in run.now())
        run.until(lambda: run.values("observer").get("blocked") == "b-c")
        drive(run)
        assert run.until_over() == "won", run.output()
    places = {place for state in run.states() for place in state["places"].values()}
    assert "going_d_to_c" in places and not places & set(BLOCKED)


def test_a_robot_that_finds_its_way_blocked_turns_round_and_takes_the_other_way(
    ros: Ros, alone: Path, tmp_path: Path
) -> None:
    with launched(
        ros, alone, tmp_path, ["bot1"], **PLAYED, time_unit=0.5, lost_after=LATE, planner=PLANNER
    ) as run:
        drive(run, "going_b_to_c")
        run.until(lambda: len(run.orders()) == 2)
        run.publish("bot1:_blocked_")
        hold = run.until(lambda: next((state for state in run.states() if state.status == "holding"), None))
        found = "bot1 has found that the way between b and c is blocked; looking for another plan"
        assert (hold["lost"], hold["reason"], len(run.orders())) == ("bot1", found, 2)
        back = run.until(lambda: next((state for state in run.states() if "plan" in state), None))
        assert (back.status, back["places"]["bot1"], "lost" in back) == ("running", "going_c_to_b", False)
        run.until(lambda: len(run.orders()) == 3)
        drive(run)
        assert run.until_over() == "won", run.output()
    poses = yaml.safe_load((alone / "src/controller_bot1/config/poses.yaml").read_text())["poses"]
    names = {str([round(x, 2), round(y, 2)]): place for place, (x, y, *_) in poses.items()}
    assert [names.get(order, order) for _, order in run.orders()] == ["b", "c", "b", "a", "d", "c", "fetch"]


@pytest.mark.parametrize(
    ("play", "says", "stations"),
    [("stuck", "it finds no way", "badc"), ("oscillating", "it moves to and fro", "bc")],
)
def test_where_its_navigation_gives_up_a_robot_goes_back_and_then_round_or_there_once_more(
    ros: Ros, alone: Path, tmp_path: Path, play: str, says: str, stations: str
) -> None:
    """Goals and results as real robots have them; bot1 cannot go on from b to c."""
    need_messages(ros)
    poses = yaml.safe_load((alone / "src/controller_bot1/config/poses.yaml").read_text())["poses"]
    plays = ["succeed", play, play, play, "succeed"]  # its goal is sent again twice
    bot1 = {"start": poses["a"][:2], "travel": 3.2, "acts": 1.2, "recovery": 0.5, "plays": plays}
    (tmp_path / "fake.yaml").write_text(yaml.safe_dump({"robots": {"bot1": bot1}}))
    arguments = {**PLAYED, "goals": "action", "ends": "result", "time_unit": 0.5, "planner": PLANNER}
    command = f"rosparam load {tmp_path}/fake.yaml /fake_move_base && exec python3 {FAKE}"
    with launched(ros, alone, tmp_path, ["bot1"], **arguments) as run, run.program(command, "fake_move_base") as robot:
        assert run.until_over(4 * PATIENCE) == "won", run.output()
    hold = next(state for state in run.states() if state.status == "holding")
    gave_up = f"bot1 gave up on its way to c: {says}, in 3 attempts; looking for another plan"
    assert hold["reason"] == gave_up
    names = {f"{x:.2f} {y:.2f}": place for place, (x, y, *_) in poses.items()}
    goals = re.findall(r"^bot1 goal (.*)$", robot.output(), re.MULTILINE)
    assert [names.get(goal, goal) for goal in goals] == ["b", "c", "c", "c", *stations]


def test_a_robot_that_cannot_stand_at_its_spot_takes_its_spare_one(ros: Ros, tmp_path: Path) -> None:
    need_messages(ros)
    there = workspace(ros, tmp_path, "bot1")
    file = there / "src/controller_bot1/config/poses.yaml"
    data = yaml.safe_load(file.read_text())
    spare = [data["poses"]["c"][0] + 0.7, *data["poses"]["c"][1:]]
    file.write_text(yaml.safe_dump({**data, "format": 3, "spare": {"bot1": {"c": spare}}}))
    plays = ["succeed", "oscillating", "oscillating", "succeed"]
    bot1 = {"start": data["poses"]["a"][:2], "travel": 3.2, "acts": 1.2, "recovery": 0.5, "plays": plays}
    (tmp_path / "fake.yaml").write_text(yaml.safe_dump({"robots": {"bot1": bot1}}))
    arguments = {**PLAYED, "goals": "action", "ends": "result", "time_unit": 0.5, "planner": PLANNER}
    command = f"rosparam load {tmp_path}/fake.yaml /fake_move_base && exec python3 {FAKE}"
    with launched(ros, there, tmp_path, ["bot1"], **arguments) as run, run.program(command, "fake_move_base") as robot:
        assert run.until_over(4 * PATIENCE) == "won", run.output()
    assert not [state for state in run.states() if state.status == "holding"], "it arrives in time"
    goals = [[float(number) for number in goal.split()] for goal in re.findall(r"bot1 goal (.*)", robot.output())]
    assert goals == [pytest.approx(pose[:2], abs=0.01) for pose in (*map(data["poses"].get, "bcc"), spare)]
    assert re.search(r"bot1 action fetch", robot.output())
