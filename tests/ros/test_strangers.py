"""What somebody can do who reaches the ROS graph of a mission, and what not: each row of the table in docs/security.md.

One mission for all rows. Its robots are played by nobody, so they are late, then lost: another plan is needed.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Callable, Dict, Iterator, List, NamedTuple

import pytest
from launched_mission import GOAL, PLAYED, LaunchedMission, launched
from ros_world import Ros

pytest.importorskip("tornado", reason="tornado is not installed: apt install python3-tornado")

pytestmark = pytest.mark.ros

TOKEN = "known-to-the-operator"
NODES = ("observer", "controller_bot1", "controller_bot2", "controllerObj", "UI", "recorder")
FAKE_PLANNER = Path(__file__).resolve().parent / "fake_planner.py"
GOAL_OF_THEIRS = "{header: {frame_id: map}, pose: {position: {x: 7.0}, orientation: {w: 1.0}}}"


class Attacked(NamedTuple):
    """The mission after the attack: its folder, and what the stranger named; the parameters before it."""

    run: LaunchedMission
    folder: Path
    before: object

    @property
    def theirs(self) -> Path:
        """The file that the stranger's program would write."""
        return self.folder / "theirs"

    @property
    def victim(self) -> Path:
        """The file of the user's that the stranger names wherever a node writes or reads one."""
        return self.folder / "victim"

    def warnings(self, name: str) -> List[str]:
        """The lines of the log that say that a parameter of this name is ignored."""
        lines = self.run.output().splitlines()
        return [line for line in lines if re.search(rf"ignored parameters: .*~{name}[,;]", line)]


MINE = "a file of the user's\n"


def wishes(victim: Path, theirs: Path) -> Dict[str, object]:
    """Everything that names a program, a key, a file or an address, as a stranger would like to have it."""
    files = ("journal", "verdict", "file", "trace", "config", "keys", "certificate", "private_key")
    addresses = {"host": "0.0.0.0", "port": 8, "token": "known to the stranger"}
    return {**dict.fromkeys(files, str(victim)), "planner": f"touch {theirs}", "launch": "theirs", **addresses}


@pytest.fixture(scope="module")
def attacked(ros: Ros, built: Callable[..., Path], tmp_path_factory: pytest.TempPathFactory) -> Iterator[Attacked]:
    """A mission that has ended, in which a stranger has set what can be set, and ended what can be ended."""
    folder, workspace = tmp_path_factory.mktemp("attacked"), built("thesis/scenario_1")
    planner = f"python3 {FAKE_PLANNER} {workspace / 'src'} {folder / 'ours'} {folder / 'never'}"
    with launched(
        ros, workspace, folder, **PLAYED, use_sim_time=True, speed=3, lost_after=40, planner=planner, web=True, port=0,
        token=TOKEN, autostart=True, stay=False, record=str(folder / "m.bag"),
    ) as run:
        run.until_step("bot2_c2a")
        found = Attacked(run, folder, run.parameters())
        found.victim.write_text(MINE)
        for node in NODES:
            for name, value in wishes(found.victim, found.theirs).items():
                run.set_parameter(f"/{node}/{name}", value)
        run.set_parameter("/controllerObj/again", "perhaps")
        ended = run.shut_down("controllerObj")
        run.until(lambda: REFUSED in run.output())
        run.set_parameter("/controllerObj/again", False)
        run.until_back("controllerObj", ended)
        for node in ("observer", "UI", "recorder"):
            run.until_back(node, run.kill(node))
        run.publish("bot1:bot1_going_c_to_b2b")
        run.until_step("bot1_going_c_to_b2b")
        command = f"rostopic pub -1 /bot2/{GOAL} geometry_msgs/PoseStamped '{GOAL_OF_THEIRS}'"
        with run.program(f"source devel/setup.bash; exec {command}", "goal") as sender:
            assert sender.wait() == 0, sender.output()
        run.until((folder / "ours").exists)
        run.publish("_stop_")
        run.until_over()
        yield found


REFUSED = "~again is 'perhaps'; expected true or false"


# What somebody can do: ROS does not prevent it ------------------------------------------------------------------------


def test_somebody_can_end_a_node_and_change_its_settings(attacked: Attacked) -> None:
    """The node was started again, and read them."""
    assert REFUSED in attacked.run.output()


def test_somebody_can_report_what_has_not_happened(attacked: Attacked) -> None:
    assert "bot1_going_c_to_b2b" in attacked.run.steps(), "as far as it is possible in the state"


def test_somebody_can_send_a_robot_a_goal(attacked: Attacked) -> None:
    goals = [entry for entry in attacked.run.of(GOAL) if entry["robot"] == "bot2"]
    assert any(entry["from"].startswith("rostopic") for entry in goals)


def test_somebody_can_stop_the_mission(attacked: Attacked) -> None:
    assert attacked.run.now().status == "stopped"


def test_somebody_can_read_topics_and_parameters(attacked: Attacked) -> None:
    assert "time_unit" in str(attacked.before) and attacked.run.states()


# What nobody can do ---------------------------------------------------------------------------------------------------


def test_nobody_can_have_a_program_run(attacked: Attacked) -> None:
    assert (attacked.folder / "ours").exists(), "a plan was needed, and the planner of the launch was asked"
    assert not attacked.theirs.exists() and attacked.warnings("planner")


def test_nobody_can_have_a_file_read_written_or_renamed(attacked: Attacked) -> None:
    assert attacked.victim.read_text() == MINE
    assert [path.name for path in attacked.folder.glob("victim*")] == ["victim"]
    assert all(attacked.warnings(name) for name in ("journal", "verdict", "file", "trace", "config"))


def test_nobody_can_take_the_journal_away_from_the_observer(attacked: Attacked) -> None:
    """It went on where it was, in the file of its launch."""
    (journal,) = (attacked.folder / "home" / "pursue" / "scenario_1").glob("journal-*.jsonl")
    assert journal.name.startswith("journal-mission_") and attacked.warnings("launch")


def test_nobody_can_open_a_port_or_choose_the_token_of_the_page(attacked: Attacked) -> None:
    pages = re.findall(r"The page is at (http://\S+)", attacked.run.output())
    assert len(pages) >= 2 and all(page.startswith("http://127.0.0.1:") for page in pages), pages
    assert ":8/" not in "".join(pages) and all(attacked.warnings(name) for name in ("host", "port", "token"))


def test_nobody_can_read_the_token_of_the_page(attacked: Attacked) -> None:
    assert TOKEN not in str(attacked.before)
