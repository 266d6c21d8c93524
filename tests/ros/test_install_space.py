"""The repository as a catkin package: built and installed, and used where no source stands beside it."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path
from typing import Set

import pytest
from ros_world import Ros

from tests.test_setup import source

pytestmark = [pytest.mark.ros, pytest.mark.slow]
ROOT = Path(__file__).resolve().parent.parent.parent
SCENARIO = ROOT / "scenarios" / "thesis" / "scenario_1.pur"
SYSTEM = {"PATH": "/usr/bin:/bin"}  # the system's Python, as rospy has it, and no virtual environment
MODULES = "python3-catkin-pkg python3-jinja2 python3-lark python3-transitions python3-typer python3-yaml"
MADE_OF = (".cpp", ".hpp", ".so", ".pyc")
ENGINE = "from pursue_gen.synthesis.native import _core"


@pytest.fixture(scope="module")
def workspace(ros: Ros, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A catkin workspace with a copy of the project, built (which is quickest like this) and installed."""
    if ros.run("python3 -c 'import catkin_pkg, jinja2, lark, transitions, typer, yaml'", ros.home, **SYSTEM).returncode:
        pytest.skip(f"the system's Python lacks modules: apt install {MODULES}")
    folder = tmp_path_factory.mktemp("catkin")
    (folder / "src" / "pursue_gen").mkdir(parents=True)
    source(folder / "src" / "pursue_gen")
    quick = "-DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG='-O0 -DPURSUE_ONE_SIZE'"
    made = ros.run(f"catkin_make install {quick}", folder, **SYSTEM)
    assert made.returncode == 0, made.stdout
    if "pybind11 is missing" in made.stdout:
        pytest.skip("there is no pybind11: apt install pybind11-dev")
    return folder


@pytest.fixture(scope="module")
def installed(workspace: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The install space, by itself: the workspace is hidden meanwhile."""
    hidden = tmp_path_factory.mktemp("hidden") / "catkin"
    workspace.rename(hidden)
    workspace.mkdir()
    (hidden / "install").rename(workspace / "install")
    return workspace / "install"


def rosrun(ros: Ros, space: Path, words: str, folder: Path) -> "subprocess.CompletedProcess[str]":
    return ros.run(f"source {space}/setup.bash; rosrun pursue_gen pursue-gen {words}", folder, **SYSTEM)


def test_the_program_runs_in_the_devel_space_with_the_native_engine(ros: Ros, workspace: Path, tmp_path: Path) -> None:
    done = rosrun(ros, workspace / "devel", f"solve {SCENARIO}", tmp_path)
    assert done.returncode == 0, done.stdout


def test_a_message_is_explained_in_the_install_space(ros: Ros, installed: Path, tmp_path: Path) -> None:
    done = rosrun(ros, installed, "explain PML110", tmp_path)
    assert done.stdout == (ROOT / "docs" / "diagnostics" / "PML110.md").read_text(encoding="utf-8")
    assert done.returncode == 0


def test_a_report_is_made_in_the_install_space_with_the_native_engine(
    ros: Ros, installed: Path, tmp_path: Path
) -> None:
    shutil.copy(str(SCENARIO), str(tmp_path))
    done = rosrun(ros, installed, f"report {SCENARIO.name} --html --runs 5", tmp_path)
    assert done.returncode == 0, done.stdout
    page = (tmp_path / "scenario_1_report.html").read_text(encoding="utf-8")
    style = ROOT / "pursue_gen" / "tools" / "report" / "page.css"
    assert style.read_text(encoding="utf-8").strip().splitlines()[0] in page
    native = ros.run(f"source {installed}/setup.bash; python3 -c '{ENGINE}'", tmp_path, **SYSTEM)
    assert native.returncode == 0, native.stdout


def test_a_workspace_is_generated_in_the_install_space(ros: Ros, installed: Path, tmp_path: Path) -> None:
    for words in ("examples scenario_1", "ws scenario_1.pur -o ws"):
        done = rosrun(ros, installed, words, tmp_path)
        assert done.returncode == 0, done.stdout
    assert (tmp_path / "ws" / "src" / "observer" / "package.xml").is_file()


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
    ros: Ros, installed: Path, tmp_path: Path
) -> None:
    """The workspace's run time is for its nodes, the program goes on with its own."""
    older = next(installed.glob("lib/python3*/dist-packages")) / "pursue_runtime"
    older.mkdir()
    try:
        (older / "__init__.py").write_text('__version__ = "0.0.1"\n')
        done = rosrun(ros, installed, f"ws {SCENARIO} -o ws", tmp_path)
        imported = "import pursue_runtime; print(pursue_runtime.__version__)"
        nodes = ros.run(f"source {installed}/setup.bash; python3 -c '{imported}'", tmp_path, **SYSTEM)
    finally:
        shutil.rmtree(str(older))
    assert done.returncode == 0, done.stdout
    written = tmp_path / "ws" / "src" / "pursue_runtime" / "src" / "pursue_runtime"
    assert (written / "data.py").read_bytes() == (ROOT / "pursue_runtime" / "data.py").read_bytes()
    assert nodes.stdout.split() == ["0.0.1"]
