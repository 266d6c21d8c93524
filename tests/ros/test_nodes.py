"""The nodes of a generated workspace as a person starts them: by hand, by launch file, from devel and install space."""

from __future__ import annotations

import contextlib
import functools
import shutil
import subprocess
import time
from pathlib import Path
from typing import Callable, Dict, Iterator, List, Tuple

import pytest
from ros_world import Ros, end, generated, make_whole

from tests.waiting import PATIENCE

Build = Callable[..., Path]
Launched = Callable[[str], "subprocess.CompletedProcess[str]"]

pytestmark = pytest.mark.ros

NODES = ("observer", "controller_bot1", "controller_bot2", "controllerObj")


@pytest.fixture(scope="module")
def own(ros: Ros, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A workspace that no other test looks at, built and installed."""
    return make_whole(ros, generated("thesis/scenario_1", tmp_path_factory.mktemp("own") / "ws"), "install")


@contextlib.contextmanager
def only_installed(own: Path) -> Iterator[Path]:
    """The workspace, while nothing but its install space is there."""
    others = [own / name for name in ("src", "build", "devel")]
    aside = own.parent / "aside"
    aside.mkdir()
    for folder in others:
        folder.rename(aside / folder.name)
    try:
        yield own
    finally:
        for folder in others:
            (aside / folder.name).rename(folder)
        aside.rmdir()


@pytest.fixture
def installed(own: Path) -> Iterator[Path]:
    """The workspace, while nothing but its install space is there."""
    with only_installed(own) as place:
        yield place


@pytest.fixture(scope="module")
def whole(built: Build) -> Path:
    """A workspace that was built as a user does."""
    return built("thesis/scenario_1", "distributed", make_whole)


@pytest.fixture(params=["devel", "install"])
def sourced(request: pytest.FixtureRequest, whole: Path) -> Tuple[Path, str]:
    """A workspace, and what to source in it."""
    if request.param == "install":
        place: Path = request.getfixturevalue("installed")
        return place, "source install/setup.bash; "
    return whole, "source devel/setup.bash; "


def test_nodes_started_by_hand_reach_the_goal_and_end_with_status_0(
    ros: Ros, sourced: Tuple[Path, str], tmp_path: Path
) -> None:
    workspace, source = sourced
    with ros.master() as there:
        ros.run("rosparam set /use_sim_time true", workspace, **there)
        clock = ros.start(f"{source}exec rosrun UI sim_clock _speed:=10", workspace, tmp_path / "clock", **there)
        try:
            commands = {node: f"rosrun {node} {node}" for node in NODES}
            commands["simulator"] = "rosrun UI simulator"
            commands["UI"] = f"rosrun UI UI --autostart --wait {PATIENCE}"
            assert ended(ros, workspace, source, commands, tmp_path, there) == dict.fromkeys(commands, 0)
        finally:
            end(clock)
    assert "The goal is reached" in (tmp_path / "UI").read_text()


def ended(
    ros: Ros, workspace: Path, source: str, commands: Dict[str, str], logs: Path, there: Dict[str, str]
) -> Dict[str, object]:
    """Starts the nodes, waits for their ends; their exit statuses, or what a node said that did not end well."""
    nodes = {
        name: ros.start(f"{source}exec {command}", workspace, logs / name, **there)
        for name, command in commands.items()
    }
    deadline = time.monotonic() + 2 * PATIENCE
    try:
        while any(node.poll() is None for node in nodes.values()) and time.monotonic() < deadline:
            time.sleep(0.1)
    finally:
        found = {name: node.poll() for name, node in nodes.items()}
        for node in nodes.values():
            end(node)
    return {name: status if status == 0 else (status, (logs / name).read_text()) for name, status in found.items()}


@pytest.fixture(scope="module")
def launched(ros: Ros, whole: Path, own: Path, tmp_path_factory: pytest.TempPathFactory) -> Launched:
    """`launched(space)`: what `rosrun … run_mission` with the workspace's devel or install space does; each once."""

    @functools.lru_cache(maxsize=None)
    def play(space: str) -> "subprocess.CompletedProcess[str]":
        with contextlib.ExitStack() as cleanup:
            workspace = whole if space == "devel" else cleanup.enter_context(only_installed(own))
            there = cleanup.enter_context(ros.master())
            home = str(tmp_path_factory.mktemp("home"))
            arguments = f"use_sim_time:=true speed:=10 wait:={PATIENCE:g}"
            command = f"source {space}/setup.bash; exec rosrun scenario_1_bringup run_mission {arguments}"
            return ros.run(command, workspace, ROS_HOME=home, **there)

    return play


@pytest.mark.parametrize("space", ["devel", "install"])
def test_the_launch_file_plays_the_mission_and_ends(launched: Launched, space: str) -> None:
    done = launched(space)
    assert "The goal is reached" in done.stdout, done.stdout
    assert "Traceback" not in done.stdout, done.stdout


@pytest.mark.parametrize("space", ["devel", "install"])
def test_run_mission_exits_with_0_where_the_goal_is_reached(launched: Launched, space: str) -> None:
    done = launched(space)
    last = done.stdout.rstrip().rpartition("\n")[2]
    assert (done.returncode, last.startswith("won: The goal is reached, after ")) == (0, True), done.stdout[-6000:]
    assert "ROS master" not in done.stdout, "nothing is wrong with it"


def test_each_package_builds_alone(ros: Ros, whole: Path, tmp_path: Path) -> None:
    packages: List[Path] = [path.parent for path in (whole / "src").glob("*/package.xml")]
    assert len(packages) == 10
    alike = {"controller_bot2", "controllerObj"}  # as controller_bot1 is, with another strategy
    for package in (each for each in packages if each.name not in alike):
        shutil.copytree(package, tmp_path / package.name / "src" / package.name)
        make_whole(ros, tmp_path / package.name)


def test_a_mission_that_does_not_reach_its_goal_fails_its_test(ros: Ros, own: Path) -> None:
    """One robot's part of the strategy is taken away: the launch test must see it."""
    part = own / "src/controller_bot1/config/strategy.yaml"
    kept = part.read_text()
    part.write_text(kept[: kept.index("strategy:")] + "strategy: []\n")
    try:
        done = ros.run("source devel/setup.bash; rostest scenario_1_bringup mission.test patience:=5", own)
    finally:
        part.write_text(kept)
    assert done.returncode != 0
    assert "test_mission_ends_well][FAILURE]" in done.stdout and "[passed]" in done.stdout


def test_regeneration_keeps_what_was_built(ros: Ros, own: Path) -> None:
    generated("thesis/scenario_1", own)
    assert (own / "devel" / "setup.bash").is_file()
    assert (own / "src" / "CMakeLists.txt").is_symlink()
