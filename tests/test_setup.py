"""How the project gets onto a machine: the wheel, the catkin package, and `./run` with its set-up."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path
from typing import Dict, Optional, Sequence
from xml.etree import ElementTree

import pytest
from catkin_pkg.package import parse_package

from pursue_gen import __version__
from pursue_gen.needs import NEEDS

ROOT = Path(__file__).resolve().parent.parent
SCENARIO = ROOT / "scenarios" / "thesis" / "scenario_1.pur"
STAMP = ROOT / ".venv" / ".pursue_gen_stamp"


def source(folder: Path) -> Path:
    """A copy of what the project is built from, so that the checkout stays as it is."""
    built = shutil.ignore_patterns("*.so", "__pycache__", "*.egg-info", ".*cache")
    for name in ("pursue_gen", "pursue_runtime", "templates", "bin", "scenarios", "docs"):
        if (ROOT / name).is_dir():
            shutil.copytree(str(ROOT / name), str(folder / name), ignore=built)
    texts = ("README.md", "CONTRIBUTING.md", "LICENSE")
    for name in (*texts, "pyproject.toml", "setup.py", "MANIFEST.in", "package.xml", "CMakeLists.txt"):
        shutil.copy(str(ROOT / name), str(folder / name))
    shutil.copy(str(ROOT / "run"), str(folder / "run"))
    shutil.copytree(str(ROOT / ".ci"), str(folder / ".ci"))
    return folder


def called(
    words: Sequence[object], folder: Path, environment: Dict[str, str], seconds: float = 1200
) -> "subprocess.CompletedProcess[str]":
    return subprocess.run(
        [str(word) for word in words],
        cwd=str(folder),
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=seconds,
        check=False,
    )


def tree(folder: Path, wanted: str = "*") -> Dict[str, bytes]:
    """The files by their paths, without what Python compiles meanwhile."""
    paths = [path for path in sorted(folder.rglob(wanted)) if "__pycache__" not in path.parts]
    return {str(path.relative_to(folder)): path.read_bytes() for path in paths if path.is_file()}


# The source distribution and the wheel --------------------------------------------------------------------------------


def test_the_source_distribution_holds_what_the_project_is_built_from(tmp_path: Path) -> None:
    pytest.importorskip("setuptools")
    folder, built_from = source(tmp_path / "project"), set()
    for name in ("pursue_gen", "pursue_runtime", "templates", "scenarios", "docs/diagnostics"):
        built_from |= {f"{name}/{path}" for path in tree(folder / name) if path.endswith(".pur") or name != "scenarios"}
    assert {"pursue_gen/synthesis/native/module.cpp", "pursue_gen/zones/native/dbm.hpp"} < built_from
    done = called([sys.executable, "setup.py", "-q", "sdist", "-d", tmp_path / "dist"], folder, dict(os.environ))
    assert done.returncode == 0, done.stdout
    (archive,) = (tmp_path / "dist").glob("*.tar.gz")
    with tarfile.open(str(archive)) as packed:
        names = {name.partition("/")[2] for name in packed.getnames()}
    assert not {*built_from, "setup.py", "pyproject.toml", "README.md", "CONTRIBUTING.md", "LICENSE"} - names


@pytest.fixture(scope="module")
def unpacked(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The project as a wheel that was built without a compiler, unpacked."""
    for needed in ("pip", "setuptools", "wheel"):
        pytest.importorskip(needed)
    folder = source(tmp_path_factory.mktemp("source"))
    no_compiler = {**os.environ, "CC": "false", "CXX": "false"}
    words = [sys.executable, "-m", "pip", "wheel", "--no-deps", "--no-build-isolation", "--no-index", "-w", "out", "."]
    done = called(words, folder, no_compiler)
    assert done.returncode == 0, done.stdout
    (wheel,) = (folder / "out").glob("pursue_gen-*.whl")
    place = tmp_path_factory.mktemp("unpacked")
    with zipfile.ZipFile(str(wheel)) as archive:
        archive.extractall(str(place))
    return place


def test_the_wheel_asks_for_what_the_program_checks_at_its_start(unpacked: Path) -> None:
    (metadata,) = unpacked.glob("pursue_gen-*.dist-info/METADATA")
    asked = re.findall(r"^Requires-Dist: ([^;\n]*)$", metadata.read_text(encoding="utf-8"), re.MULTILINE)
    parts = [set(re.findall(r"[<>]=?[\d.]+|[A-Za-z]\w*", requirement.replace("-", "_"))) for requirement in asked]
    wanted = [set(re.findall(r"[<>]=?[\d.]+|[A-Za-z]\w*", need.requirement)) for need in NEEDS]
    assert sorted(map(sorted, parts)) == sorted(map(sorted, wanted))


def test_the_wheel_carries_the_pages_on_messages(unpacked: Path, tmp_path: Path) -> None:
    assert tree(unpacked / "pursue_gen" / "_diagnostics") == tree(ROOT / "docs" / "diagnostics")
    installed = {**os.environ, "PYTHONPATH": str(unpacked)}
    done = called([sys.executable, "-m", "pursue_gen", "explain", "PML110"], tmp_path, installed)
    assert (done.returncode, done.stdout) == (0, (ROOT / "docs" / "diagnostics" / "PML110.md").read_text("utf-8"))


def test_the_wheel_carries_all_templates(unpacked: Path) -> None:
    assert tree(unpacked / "pursue_gen" / "_templates") == tree(ROOT / "templates" / "catkin") != {}


def test_the_wheel_carries_the_scenarios(unpacked: Path, tmp_path: Path) -> None:
    assert tree(unpacked / "pursue_gen" / "_scenarios", "*.pur") == tree(ROOT / "scenarios", "*.pur") != {}
    installed = {**os.environ, "PYTHONPATH": str(unpacked)}
    done = called([sys.executable, "-m", "pursue_gen", "examples", "scenario_1"], tmp_path, installed)
    assert done.returncode == 0, done.stdout
    assert (tmp_path / SCENARIO.name).read_bytes() == SCENARIO.read_bytes()


def test_the_wheel_carries_all_files_of_its_packages(unpacked: Path) -> None:
    for name in ("pursue_gen", "pursue_runtime"):
        left_out = (".so", ".cpp", ".hpp")
        files = {path: content for path, content in tree(ROOT / name).items() if not path.endswith(left_out)}
        assert not files.items() - tree(unpacked / name).items(), name


def test_installed_it_writes_the_same_workspace(unpacked: Path, tmp_path: Path) -> None:
    installed = {**os.environ, "PYTHONPATH": str(unpacked)}
    words = [sys.executable, "-m", "pursue_gen", "ws", SCENARIO, "-o"]
    done = called([*words, tmp_path / "installed"], tmp_path, installed)
    assert done.returncode == 6 and "SYN011" in done.stdout, done.stdout
    for built in (ROOT / "pursue_gen").glob("*/native/*.so"):
        shutil.copy(str(built), str(unpacked / built.relative_to(ROOT)))
    done = called([*words, tmp_path / "installed"], tmp_path, installed)
    assert done.returncode == 0, done.stdout
    checkout = {**os.environ, "PYTHONPATH": str(ROOT)}
    assert called([*words, tmp_path / "checkout"], tmp_path, checkout).returncode == 0
    installed_files, files = tree(tmp_path / "installed"), tree(tmp_path / "checkout")
    assert sorted(installed_files) == sorted(files)
    shared = [path for path in files if path.startswith("src/pursue_runtime/")]
    assert len(shared) > 50
    assert [installed_files[path] for path in shared] == [files[path] for path in shared]


# The catkin package ---------------------------------------------------------------------------------------------------


def test_the_manifest_agrees_with_the_package() -> None:
    manifest = ElementTree.parse(str(ROOT / "package.xml")).getroot()
    assert manifest.findtext("version") == __version__
    assert manifest.findtext("license") == "BSD-3-Clause"


def test_the_manifest_is_valid_for_catkin() -> None:
    assert parse_package(str(ROOT)).name == "pursue_gen"


def test_the_program_names_what_is_missing() -> None:
    nothing = ["env", "-i", sys.executable, "-I", "-S", ROOT / "bin" / "pursue-gen", "--version"]
    done = called(nothing, ROOT, dict(os.environ))
    assert done.returncode == 6
    assert "python3-lark" in done.stdout and "PyYAML" in done.stdout and "Traceback" not in done.stdout


# ./run ----------------------------------------------------------------------------------------------------------------


@pytest.fixture
def machine(tmp_path: Path) -> Path:
    """A folder for PATH with the tools of every machine, but neither Python nor apt."""
    folder = tmp_path / "machine"
    folder.mkdir()
    for name in ("bash", "dirname", "env", "uname", "sed", "grep", "mktemp", "tail", "rm", "cat", "sha256sum"):
        found = shutil.which(name)
        assert found is not None
        (folder / name).symlink_to(found)
    fake(folder, "getent", "exit 0")
    return folder


def fake(folder: Path, name: str, does: str) -> None:
    program = folder / name
    program.write_text(f"#!/bin/bash\n{does}\n", encoding="utf-8")
    program.chmod(0o755)


def run(machine: Path, *words: str, name: str = "project") -> "subprocess.CompletedProcess[str]":
    place = machine.parent / name
    place.mkdir()
    source(place)
    return called(["bash", place / "run", *words], machine.parent, {"PATH": str(machine), "HOME": str(machine.parent)})


def test_run_explains_itself() -> None:
    for words in ([], ["help"], ["--help"], ["mission", "--help"]):
        told = called([ROOT / "run", *words], ROOT, dict(os.environ))
        assert told.returncode == 0
        assert "./run mission" in told.stdout and "./run test" in told.stdout


def test_run_does_not_know_other_words() -> None:
    told = called([ROOT / "run", "away"], ROOT, dict(os.environ))
    assert told.returncode == 2
    assert "There is no ./run away.\n" in told.stdout


@pytest.mark.parametrize(("word", "near"), [("misson", "mission"), ("tests", "test"), ("set-up", "setup")])
def test_run_proposes_the_word_that_is_meant(word: str, near: str) -> None:
    told = called([ROOT / "run", word], ROOT, dict(os.environ))
    assert told.returncode == 2
    assert f"There is no ./run {word}. Did you mean ./run {near}?\n" in told.stdout


def test_the_events_of_a_mission_are_counted(tmp_path: Path) -> None:
    lines = [
        "my_floor: waiting for observer, simulator",
        "     0.0  the mission starts",
        "     0.0  the mission runs",
        "     1.0  bot1 sets off from c to b",
        "    11.6  bot1 arrives at b",
        "    12.0  the mission holds: bot2 is late",
        "          nurse: go from a to b now",
        "   120.4  bot1 does handOver",
        "The goal is reached, after 120.4 time units.",
    ]
    (tmp_path / "UI-1-stdout.log").write_text("\n".join(lines) + "\n", encoding="utf-8")
    words = ["bash", "-c", 'source "$1"; account "$2" 0 "$2/UI-1-stdout.log"', "bash", str(ROOT / "run"), str(tmp_path)]
    done = subprocess.run(words, capture_output=True, text=True, timeout=600, check=False)
    assert "The mission went well: 3 events." in done.stdout + done.stderr


def test_without_apt_there_is_a_list_of_what_to_install(machine: Path) -> None:
    told = run(machine, "setup")
    assert told.returncode == 6
    for word in ("catkin_make", "C++17", "rostest", "venv", "graphviz", "transitions"):
        assert word in told.stdout


def test_a_place_that_catkin_cannot_work_in_is_reported(machine: Path) -> None:
    told = run(machine, "setup", name="my project")
    assert told.returncode == 6
    assert "without blanks" in told.stdout


def test_only_what_is_missing_is_installed_and_a_failure_is_reported(machine: Path) -> None:
    fake(machine, "dpkg-query", "echo 'ii  make'; echo 'ii  python3-rospy:all'; echo 'rc  g++'")
    refuse = "case $* in *install*) echo E: no such package; exit 100; esac"
    fake(machine, "apt-get", f'echo "$@" >>{machine}/told; {refuse}')
    fake(machine, "sudo", '"$@"')
    told = run(machine, "setup")
    assert told.returncode == 6
    assert "E: no such package" in told.stdout and "could not install" in told.stdout
    update, install = (machine / "told").read_text(encoding="utf-8").splitlines()
    assert update.endswith("update")
    wanted = install.split()
    assert "--no-install-recommends" in wanted and "g++" in wanted
    assert "make" not in wanted and "python3-rospy" not in wanted


@pytest.mark.skipif(os.geteuid() == 0, reason="root needs no sudo")
def test_without_root_and_sudo_the_command_is_shown(machine: Path) -> None:
    fake(machine, "dpkg-query", "exit 0")
    fake(machine, "apt-get", "exit 1")
    told = run(machine, "setup")
    assert told.returncode == 6
    assert "apt-get install --no-install-recommends" in told.stdout


def test_a_machine_that_does_not_know_its_name_is_reported_what_to_do(machine: Path) -> None:
    fake(machine, "getent", '[[ $2 == localhost ]]')
    for name in ("tee", "sudo"):  # /etc/hosts cannot be written
        fake(machine, name, "exit 1")
    told = run(machine, "setup")
    assert told.returncode == 6
    assert "/etc/hosts" in told.stdout and "127.0.0.1" in told.stdout


@pytest.mark.parametrize(("fails", "status"), [("none", 0), ("test", 1), ("sanitize", 1)])
def test_continuous_integration_ends_with_the_test_that_is_flaky(fails: str, status: int, tmp_path: Path) -> None:
    (tmp_path / ".ci").mkdir()
    (tmp_path / ".venv" / "bin").mkdir(parents=True)
    shutil.copy(str(ROOT / ".ci" / "run"), str(tmp_path / ".ci" / "run"))
    fake(tmp_path / ".venv" / "bin", "python", "exit 0")
    says = 'case $1 in test) echo "$@"; echo FLAKY tests/test_a.py::test_b ;; sanitize) echo 9 passed ;; esac'
    fake(tmp_path, "run", f"{says}\n[[ $1 != {fails} ]]")
    done = called(["bash", tmp_path / ".ci" / "run"], tmp_path, dict(os.environ))
    assert done.returncode == status
    lines = done.stdout.splitlines()
    assert lines[0] == "test --retry -m ", "the tests of benchmarks, too"
    if status == 0:
        assert lines[-2:] == ["9 passed", "FLAKY tests/test_a.py::test_b"]


@pytest.mark.skipif(not STAMP.is_file(), reason="./run setup has not been run in this checkout")
def test_set_up_again_does_nothing(tmp_path: Path) -> None:
    for name in ("apt-get", "sudo", "pip"):
        fake(tmp_path, name, f"touch {tmp_path}/{name}.used")
    environment = {**os.environ, "PATH": f"{tmp_path}:{os.environ['PATH']}"}
    before = STAMP.stat().st_mtime_ns
    told = called([ROOT / "run", "setup"], ROOT, environment)
    assert told.returncode == 0, told.stdout
    assert told.stdout == "Everything is set up. Next: ./run mission\n"
    assert STAMP.stat().st_mtime_ns == before
    assert not list(tmp_path.glob("*.used"))


# CI -------------------------------------------------------------------------------------------------------------------


@pytest.fixture
def ci(tmp_path: Path) -> Path:
    """The project without its native engine and checker, and a `./run` that only notes what it is called for."""
    folder = source(tmp_path)
    (folder / ".venv" / "bin").mkdir(parents=True)
    fake(folder / ".venv" / "bin", "python", f'exec {sys.executable} "$@"')
    fake(folder, "run", f'echo "$@" >>{folder}/calls')
    return folder


@pytest.mark.parametrize("built", [None, "synthesis/native/_core.py", "proof/native/_proof.py"])
def test_ci_fails_where_native_engine_or_checker_was_not_built(ci: Path, built: Optional[str]) -> None:
    if built is not None:
        (ci / "pursue_gen" / built).touch()
    done = called([ci / ".ci" / "run"], ci, {**os.environ, "PYTHONPATH": str(ci)})
    assert done.returncode == 1
    assert "Native engine or checker was not built" in done.stdout and "Traceback" not in done.stdout
    assert (ci / "calls").read_text(encoding="utf-8").split() == ["setup"]


def test_ci_goes_on_to_the_tests_where_they_were_built(ci: Path) -> None:
    for built in ("synthesis/native/_core.py", "proof/native/_proof.py"):
        (ci / "pursue_gen" / built).touch()  # as good as built: it can be imported
    done = called([ci / ".ci" / "run"], ci, {**os.environ, "PYTHONPATH": str(ci)})
    assert done.returncode == 0, done.stdout
    assert (ci / "calls").read_text(encoding="utf-8").split() == ["setup", "test", "--retry", "-m", "sanitize"]
