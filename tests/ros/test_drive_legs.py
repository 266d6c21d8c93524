"""`rosrun UI drive_legs`: robots as move_base shows them are driven along all ways, and calibrate reads the bag."""

from __future__ import annotations

import re
import signal
import textwrap
from pathlib import Path

import pytest
from fake_robots import Robots, robots_workspace, wait_for
from ros_world import Ros, end

from pursue_gen.language import load
from pursue_gen.tools.calibration.recordings import samples_in

pytestmark = pytest.mark.ros

SCENARIO = Path(__file__).resolve().parents[2] / "scenarios" / "thesis" / "scenario_1.pur"
PUBLISHES = "rostopic pub -l pursue/state pursue_msgs/SystemState '{}'"
"""What a mission's observer does, as far as other nodes notice."""

WAYS = ["bot1 from a to c", "bot1 from b to c", "bot1 from c to a", "bot1 from c to b"]


def test_one_robot_after_the_other_drives_all_ways_and_acts_and_ctrl_c_keeps_what_was_measured(
    ros: Ros, tmp_path: Path
) -> None:
    workspace = robots_workspace(ros, "thesis/scenario_1", ("bot1", "bot2"))
    log, bag = tmp_path / "log", tmp_path / "drives.bag"
    log.touch()
    command = f"source devel/setup.bash; exec rosrun UI drive_legs _times:=1 _actions:=1 _pause:=0.05 --file {bag}"
    with ros.master() as there:
        mission = ros.start("source devel/setup.bash; exec " + PUBLISHES, workspace, tmp_path / "mission", **there)
        try:
            named = "rostopic list -p | grep -qx /pursue/state"
            wait_for(lambda: not ros.run(named, workspace, **there).returncode, log, "no state is published")
            refused = ros.run(command, workspace, **there)
            assert refused.returncode == 3 and "end its launch first" in refused.stdout, refused.stdout
        finally:
            end(mission)
        wait_for(lambda: bool(ros.run(named, workspace, **there).returncode), log, "a state is still published")
        own = {"bot1": {"travel": 0.3, "acts": 0.3}, "bot2": {"plays": ["succeed", "never"]}}
        robots = Robots(ros, workspace, tmp_path, there, **own)
        try:
            drives = ros.start(command, workspace, log, **there)
            try:
                wait_for(lambda: len(robots.heard("bot2")) > 1, log, "bot2 is not driven")
                drives.send_signal(signal.SIGINT)
                wait_for(lambda: drives.poll() is not None, log, "it does not end")
            finally:
                end(drives)
            assert drives.returncode == 1, "not each way was driven"
            wait_for(lambda: robots.heard("bot2")[-1] == "cancel", log, "bot2 was not called back")
            assert len(robots.heard("bot2")) == 3, "to its start, on its first way, called back"
        finally:
            robots.end()
    heard = [line.split()[0] for line in robots.heard("bot1")]
    assert (heard.count("goal"), heard.count("action")) == (5, 1), "to its start, four ways, its action"
    found, findings = samples_in([bag], load(str(SCENARIO)))
    assert sorted(str(sample.what) for sample in found.measured) == [*WAYS, "bot1_inb"] and findings == ()
    assert all(sample.seconds > 0.29 for sample in found.measured)
    assert not list(tmp_path.glob("*.active"))
    said = log.read_text()
    assert "bot1 from c to b: 1 of 1 drives" in said
    homes = [said.index(f"{robot} goes to c, where it begins") for robot in ("bot1", "bot2")]
    assert homes == sorted(homes) and homes[-1] < said.index("bot1 drives 4 ways"), "first all are out of the way"
    assert re.search(r"8 drives and 2 actions take \d+ to \d+ \w+ by the scenario's windows", said)


def test_a_robot_that_is_not_there_or_has_another_namespace_ends_it_at_once(ros: Ros, tmp_path: Path) -> None:
    workspace = robots_workspace(ros, "thesis/scenario_1", ("bot1", "bot2"))
    command = f"source devel/setup.bash; exec rosrun UI drive_legs --file {tmp_path}/drives.bag"
    with ros.master() as there:
        refused = ros.run(command, workspace, **there)
    assert refused.returncode == 3, refused.stdout
    assert "bot1 cannot get an order: no node is subscribed to /bot1/move_base/goal: start its nodes" in refused.stdout
    assert "rosparam load robots.yaml drive_legs, with bot1: {namespace: NAME} in it" in refused.stdout
    assert not list(tmp_path.glob("drives.bag*"))


FLOOR = """
poi "a"
poi "b"
poi "c"
connect a and c distance 3
connect c and b distance 3
event "fetch" location b duration 1
"""

ALONE = FLOOR + """\
agent "bot1" controllable mobile 1 location c can_do fetch
reach_objective: do fetch
"""


def test_the_node_for_actions_of_the_page_does_each_one_as_often_as_it_is_ordered(ros: Ros, tmp_path: Path) -> None:
    (tmp_path / "alone.pur").write_text(ALONE)
    workspace = robots_workspace(ros, str(tmp_path / "alone"), ("bot1",))
    page = (SCENARIO.parents[2] / "docs" / "robots.md").read_text(encoding="utf-8")
    (script,) = re.findall(r"(?s)( +#!/usr/bin/env python3\n.*?rospy\.spin\(\)\n)", page)
    (tmp_path / "actions.py").write_text(textwrap.dedent(script))
    log = tmp_path / "log"
    log.touch()
    arguments = f"_times:=1 _actions:=3 _pause:=0.05 _limit:=5 --file {tmp_path}/drives.bag"
    with ros.master() as there:
        robots = Robots(ros, workspace, tmp_path, there, bot1={"travel": 0.3, "acts": -1.0})
        command = f"ROS_NAMESPACE=bot1 exec python3 {tmp_path}/actions.py"
        node = ros.start(command, workspace, tmp_path / "actions", **there)
        try:
            command = f"source devel/setup.bash; exec rosrun UI drive_legs {arguments}"
            drives = ros.start(command, workspace, log, **there)
            wait_for(lambda: drives.poll() is not None, log, "it does not end")
            end(drives)
        finally:
            end(node)
            robots.end()
    assert drives.returncode == 0 and "3 of 3 times" in log.read_text(), log.read_text()


PAIR = FLOOR + """\
event "lift" collaborative together location a duration 2
rule "load": fetch before lift
agent "bot1" controllable mobile 1 location c can_do fetch, lift
agent "bot2" controllable mobile 1 location c reacts_to lift
reach_objective: do lift
"""


def test_what_two_do_together_is_measured_where_both_are_brought_to_its_place(ros: Ros, tmp_path: Path) -> None:
    scenario = tmp_path / "pair.pur"
    scenario.write_text(PAIR)
    workspace = robots_workspace(ros, str(tmp_path / "pair"), ("bot1", "bot2"))
    log, bag = tmp_path / "log", tmp_path / "drives.bag"
    command = f"source devel/setup.bash; exec rosrun UI drive_legs _times:=1 _actions:=2 _pause:=0.05 --file {bag}"
    own = {name: {"travel": 0.3, "acts": acts, "named": True} for name, acts in (("bot1", 0.3), ("bot2", 0.8))}
    with ros.master() as there:
        robots = Robots(ros, workspace, tmp_path, there, **own)
        try:
            drives = ros.start(command, workspace, log, **there)
            try:
                wait_for(lambda: drives.poll() is not None, log, "it does not end")
            finally:
                end(drives)
            assert drives.returncode == 0, log.read_text()
        finally:
            robots.end()
    actions = {robot: [line for line in robots.heard(robot) if "action" in line] for robot in ("bot1", "bot2")}
    assert actions == {"bot1": ["action fetch", "action lift"] * 2, "bot2": ["action lift"] * 2}, "as the rule has it"
    assert robots.heard("bot2")[-2:] == ["action lift"] * 2, "it stays there"
    found, _ = samples_in([bag], load(str(scenario)))
    lifts = [sample.seconds for sample in found.measured if str(sample.what) == "lift"]
    assert len(lifts) == 2 and min(lifts) > 0.79, "until the slower one has reported it"
    assert "8 drives and 4 actions take" in log.read_text()
    assert "bot1 does lift at a with bot2: 2 of 2 times" in log.read_text()
