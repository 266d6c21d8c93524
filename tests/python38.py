"""Python 3.8 with the oldest packages that do, as Ubuntu 20.04 and ROS Noetic have them, in .venv38 of the checkout.

It is made once, and the native solver and checker are built for it after each change of these. PURSUE_PYTHON38 names a
Python 3.8; else it is looked for on PATH and among pyenv's.
"""

from __future__ import annotations

import contextlib
import fcntl
import hashlib
import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Iterator, List

import pytest

from pursue_gen.needs import NEEDS
from pursue_runtime.needs import TORNADO
from tests.conftest import ROOT

PLACE = ROOT / ".venv38"
OLDEST = [f"{need.name}=={need.oldest}" for need in (*NEEDS, TORNADO)]
WITH_THEM = ["MarkupSafe==1.1.1", "cryptography==2.8", "hypothesis==6.113.0", "pybind11==2.10.0", "pytest==8.3.5"]
"""MarkupSafe is what jinja2 2.10 works with; pybind11 builds solver and checker; the others run the tests."""
MODULES = {"synthesis/native": "_core", "proof/native": "_proof"}
"""Of `pursue_gen`: the folders of solver and checker, and what they are built as."""

ROS_PACKAGES = (
    "actionlib_msgs", "catkin", "diagnostic_msgs", "genmsg", "genpy", "geometry_msgs", "move_base_msgs", "roscpp",
    "rosgraph", "rosgraph_msgs", "roslib", "rospkg", "rospy", "std_msgs",
)  # fmt: skip
"""What nodes import of ROS: pure Python, so that any Python runs it."""


def candidates() -> Iterator[str]:
    """Where a Python 3.8 may be; a shim of pyenv's on PATH works only where that version is chosen."""
    yield from filter(None, (os.environ.get("PURSUE_PYTHON38"), shutil.which("python3.8")))
    versions = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv")) / "versions"
    yield from map(str, sorted(versions.glob("3.8*/bin/python3.8")))


def said(words: List[str]) -> "subprocess.CompletedProcess[str]":
    """What a program says that runs in the checkout, without variables of these tests."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith(("PYTEST_", "PYTHON"))}
    return subprocess.run(
        words, cwd=str(ROOT), env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
        timeout=1800, check=False,
    )  # fmt: skip


def is_38(python: str) -> bool:
    """True if this program is a Python 3.8 that can make virtual environments."""
    try:
        return said([python, "-c", "import ensurepip, sys; sys.exit(sys.version_info[:2] != (3, 8))"]).returncode == 0
    except OSError:
        return False


def oldest_python() -> str:
    """The Python with the oldest packages; skips the test where there is no Python 3.8, or no package index."""
    if sys.version_info < (3, 9):
        pytest.skip("all tests run under this old Python")
    base = next(filter(is_38, candidates()), None)
    if base is None:
        pytest.skip("there is no Python 3.8 on PATH or among pyenv's; PURSUE_PYTHON38 can name one")
    with _alone():
        return _made(base)


@contextlib.contextmanager
def _alone() -> Iterator[None]:
    """No two processes of a test run make the environment, or build, at the same time."""
    with open(__file__, "rb") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def _made(base: str) -> str:
    """The Python of the virtual environment, which is made where it is not there."""
    python, stamp = str(PLACE / "bin" / "python"), PLACE / "installed"
    wanted = "\n".join([base, str(PLACE), *OLDEST, *WITH_THEM])
    if not stamp.is_file() or stamp.read_text(encoding="utf-8") != wanted:
        for words in ([base, "-m", "venv", "--clear", str(PLACE)],
                      [python, "-m", "pip", "install", "-q", *OLDEST, *WITH_THEM]):  # fmt: skip
            done = said(words)
            if done.returncode != 0:
                pytest.skip(f"the oldest packages cannot be installed here: {done.stdout[-500:]}")
        stamp.write_text(wanted, encoding="utf-8")
    return python


def build_engine(python: str) -> None:
    """Builds solver and checker for this Python where that is not done; skips the test where they cannot be built.

    Hardly optimized, with matrices of one size: that takes a sixth of the time, and they are used for small games.
    """
    code = "import pybind11, sysconfig as s; print(s.get_config_var('EXT_SUFFIX'), s.get_path('include')," \
        " pybind11.get_include(), sep='\\n')"  # fmt: skip
    suffix, *headers = said([python, "-c", code]).stdout.splitlines()
    if shutil.which("g++") is None or not Path(headers[0], "Python.h").is_file():
        pytest.skip(f"solver and checker cannot be built here: they need g++ and {headers[0]}/Python.h")
    package, stamp = ROOT / "pursue_gen", PLACE / "engine"
    built = {package / folder: package / folder / f"{name}{suffix}" for folder, name in MODULES.items()}
    sources = sorted(path for end in ("*.hpp", "*.cpp") for path in (ROOT / "pursue_gen").rglob(end))
    wanted = hashlib.sha256(b"".join(path.read_bytes() for path in sources)).hexdigest()
    with _alone():
        there = all(module.is_file() for module in built.values())
        if there and stamp.is_file() and stamp.read_text(encoding="utf-8") == wanted:
            return
        words = ["g++", "-std=c++17", "-O1", "-g0", "-DPURSUE_ONE_SIZE", "-shared", "-fPIC", "-fvisibility=hidden"]
        words += [f"-I{folder}" for folder in ("pursue_gen", *headers)]
        for folder, module in built.items():
            done = said([*words, str(folder / "module.cpp"), "-o", str(module)])
            assert done.returncode == 0, done.stdout[-5000:]
        stamp.write_text(wanted, encoding="utf-8")


def ros_for_it() -> Path:
    """A folder for PYTHONPATH with ROS's packages alone: beside them are others, of another Python.

    They are copies, so that this Python compiles none where the system's are.
    """
    found = {name: importlib.util.find_spec(name) for name in ROS_PACKAGES}
    folders = {name: Path(spec.origin).parent for name, spec in found.items() if spec is not None and spec.origin}
    missing = sorted(set(ROS_PACKAGES) - set(folders))
    if missing:
        pytest.skip(f"the Python of these tests does not find {', '.join(missing)}")
    versions = sorted((name, (folder / "__init__.py").stat().st_mtime) for name, folder in folders.items())
    folder, part = PLACE / f"ros-{hashlib.sha256(repr(versions).encode()).hexdigest()[:16]}", PLACE / "ros-part"
    with _alone():
        if not folder.is_dir():
            shutil.rmtree(str(part), ignore_errors=True)
            for name, place in folders.items():
                shutil.copytree(str(place), str(part / name), ignore=shutil.ignore_patterns("__pycache__"))
            part.rename(folder)
    return folder
