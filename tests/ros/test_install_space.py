"""The repository as a catkin package: built and installed, and used where no source stands beside it."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path
from typing import Callable, Dict, Set

import pytest
from ros_world import Ros

from pursue_gen import __version__
from tests.test_setup import source, tree

pytestmark = [pytest.mark.ros, pytest.mark.slow]
ROOT = Path(__file__).resolve().parent.parent.parent
SCENARIO = ROOT / "scenarios" / "thesis" / "scenario_1.pur"
SYSTEM = {"PATH": "/usr/bin:/bin"}
"""The system's Python, as rospy has it, and no virtual environment."""
MADE_OF = (".cpp", ".hpp", ".so", ".pyc")
ENGINE = "from pursue_gen.synthesis.native import _core"


@pytest.fixture(scope="module")
def place(ros: Ros) -> Dict[str, str]:
    """Variables of a user's: those of SYSTEM, where the system's Python has all modules, as on Debian 12."""
    wanted = "catkin_pkg, jinja2, lark, transitions, typer, yaml"
    return {} if ros.run(f"python3 -c 'import {wanted}'", ros.home, **SYSTEM).returncode else SYSTEM


@pytest.fixture(scope="module")
def workspace(ros: Ros, place: Dict[str, str], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A catkin workspace with a copy of the project, built (which is quickest like this) and installed."""
    folder = tmp_path_factory.mktemp("catkin")
    (folder / "src" / "pursue_gen").mkdir(parents=True)
    source(folder / "src" / "pursue_gen")
    quick = "-DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG='-O0 -DPURSUE_ONE_SIZE'"
    made = ros.run(f"catkin_make install {quick}", folder, **place)
    assert made.returncode == 0, made.stdout
    if "pybind11 is missing" in made.stdout:
        pytest.skip("there is no pybind11: apt install pybind11-dev")
    return folder


Program = Callable[[Path, str, Path], "subprocess.CompletedProcess[str]"]


@pytest.fixture(scope="module")
def rosrun(ros: Ros, place: Dict[str, str]) -> Program:
    """`rosrun(space, words, folder)` runs the program of the devel or install space with these words."""

    def run(space: Path, words: str, folder: Path) -> "subprocess.CompletedProcess[str]":
        done = ros.run(f"source {space}/setup.bash; rosrun pursue_gen pursue-gen {words}", folder, **place)
        assert done.returncode == 0, done.stdout
        return done

    return run


def written(rosrun: Program, space: Path, folder: Path) -> Path:
    """The workspace that is generated there of a scenario that comes with the program."""
    for words in ("examples scenario_1", "ws scenario_1.pur -o ws"):
        rosrun(space, words, folder)
    return folder / "ws"


@pytest.fixture(scope="module")
def from_devel(rosrun: Program, workspace: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The workspace that is generated in the devel space."""
    return written(rosrun, workspace / "devel", tmp_path_factory.mktemp("from_devel"))


@pytest.fixture(scope="module")
def installed(workspace: Path, from_devel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The install space, by itself: the workspace is hidden, once the devel space is not needed any more."""
    hidden = tmp_path_factory.mktemp("hidden") / "catkin"
    workspace.rename(hidden)
    workspace.mkdir()
    (hidden / "install").rename(workspace / "install")
    return workspace / "install"


def test_the_program_runs_in_the_devel_space_with_the_native_engine(
    rosrun: Program, workspace: Path, tmp_path: Path
) -> None:
    assert rosrun(workspace / "devel", "--version", tmp_path).stdout == f"pursue-gen {__version__}\n"
    assert "native engine" in rosrun(workspace / "devel", f"solve {SCENARIO}", tmp_path).stdout


def test_a_message_is_explained_in_the_install_space(rosrun: Program, installed: Path, tmp_path: Path) -> None:
    assert rosrun(installed, "--version", tmp_path).stdout == f"pursue-gen {__version__}\n"
    told = rosrun(installed, "explain PML110", tmp_path).stdout
    assert told == (ROOT / "docs" / "diagnostics" / "PML110.md").read_text(encoding="utf-8")


def test_a_report_is_made_in_the_install_space_with_the_native_engine(
    ros: Ros, place: Dict[str, str], rosrun: Program, installed: Path, tmp_path: Path
) -> None:
    shutil.copy(str(SCENARIO), str(tmp_path))
    rosrun(installed, f"report {SCENARIO.name} --html --runs 5", tmp_path)
    page = (tmp_path / "scenario_1_report.html").read_text(encoding="utf-8")
    style = ROOT / "pursue_gen" / "tools" / "report" / "page.css"
    assert style.read_text(encoding="utf-8").strip().splitlines()[0] in page
    native = ros.run(f"source {installed}/setup.bash; python3 -c '{ENGINE}'", tmp_path, **place)
    assert native.returncode == 0, native.stdout


def test_the_same_workspace_is_generated_in_the_install_space(
    rosrun: Program, installed: Path, from_devel: Path, tmp_path: Path
) -> None:
    found = written(rosrun, installed, tmp_path)
    assert (found / "src" / "observer" / "package.xml").is_file()
    assert tree(found) == tree(from_devel)


def test_the_install_space_holds_what_the_packages_hold(installed: Path) -> None:
    """Files of every kind, but for what the extensions are made of."""

    def files(folder: Path) -> Set[str]:
        found = {path.relative_to(folder) for path in folder.rglob("*") if path.is_file()}
        left_out = ("__pycache__", "_templates", "_diagnostics", "_scenarios", "_runtime")
        return {path.as_posix() for path in found if not set(path.parts) & set(left_out) and path.suffix not in MADE_OF}

    site = next(installed.glob("lib/python3*/dist-packages"))
    assert files(site / "pursue_gen") == files(ROOT / "pursue_gen") and not list(site.rglob("*.hpp"))
    assert files(site / "pursue_gen" / "_runtime" / "pursue_runtime") == files(ROOT / "pursue_runtime")
    assert not (site / "pursue_runtime").exists(), "that is the place of a workspace's run time"


def test_it_shares_an_install_space_with_a_workspace_of_another_version(
    ros: Ros, place: Dict[str, str], rosrun: Program, installed: Path, tmp_path: Path
) -> None:
    """The workspace's run time is for its nodes, the program goes on with its own."""
    older = next(installed.glob("lib/python3*/dist-packages")) / "pursue_runtime"
    older.mkdir()
    try:
        (older / "__init__.py").write_text('__version__ = "0.0.1"\n')
        rosrun(installed, f"ws {SCENARIO} -o ws", tmp_path)
        imported = "import pursue_runtime; print(pursue_runtime.__version__)"
        nodes = ros.run(f"source {installed}/setup.bash; python3 -c '{imported}'", tmp_path, **place)
    finally:
        shutil.rmtree(str(older))
    written = tmp_path / "ws" / "src" / "pursue_runtime" / "src" / "pursue_runtime"
    assert (written / "data.py").read_bytes() == (ROOT / "pursue_runtime" / "data.py").read_bytes()
    assert nodes.stdout.split() == ["0.0.1"]
