"""Python 3.8 with the oldest packages that do, as Ubuntu 20.04 and ROS Noetic have them: quick tests run there, too.

The environment is made once, in .venv38 of the checkout. PURSUE_PYTHON38 names a Python 3.8; else it is looked for on
PATH and among pyenv's.
"""

from __future__ import annotations

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
WITH_THEM = ["MarkupSafe==1.1.1", "cryptography==2.8", "hypothesis==6.113.0", "pytest==8.3.5"]
"""MarkupSafe is what jinja2 2.10 works with; the others run the tests."""
QUICK = [
    "tests/language/test_messages.py", "tests/language/test_parser.py", "tests/language/test_formatter.py",
    "tests/runtime/controller", "tests/runtime/test_bounded.py", "tests/tga/test_translate.py",
    "tests/workspace/test_mission_test.py",
]  # fmt: skip


def candidates() -> Iterator[str]:
    """Where a Python 3.8 may be; a shim of pyenv's on PATH works only where that version is chosen."""
    yield from filter(None, (os.environ.get("PURSUE_PYTHON38"), shutil.which("python3.8")))
    versions = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv")) / "versions"
    yield from map(str, sorted(versions.glob("3.8*/bin/python3.8")))


def said(words: List[str]) -> "subprocess.CompletedProcess[str]":
    environment = {name: value for name, value in os.environ.items() if not name.startswith(("PYTEST_", "PYTHON"))}
    return subprocess.run(
        words, cwd=str(ROOT), env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
        timeout=1800, check=False,
    )  # fmt: skip


def is_38(python: str) -> bool:
    try:
        return said([python, "-c", "import ensurepip, sys; sys.exit(sys.version_info[:2] != (3, 8))"]).returncode == 0
    except OSError:
        return False


@pytest.fixture(scope="module")
def python38() -> str:
    """The Python with the oldest packages; skips where there is no Python 3.8, or no package index."""
    if sys.version_info < (3, 9):
        pytest.skip("all tests run under this old Python")
    base = next(filter(is_38, candidates()), None)
    if base is None:
        pytest.skip("there is no Python 3.8 on PATH or among pyenv's; PURSUE_PYTHON38 can name one")
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


def test_quick_tests_pass_with_the_oldest_packages(python38: str) -> None:
    done = said([python38, "-m", "pytest", "-q", "-p", "no:cacheprovider", *QUICK])
    assert done.returncode == 0, done.stdout[-5000:]
    assert " passed" in done.stdout.splitlines()[-1]


def test_a_workspace_is_the_same_as_with_the_packages_of_today(python38: str, tmp_path: Path) -> None:
    """Of one plan: the native engine, which finds another one than the Python engine, is not built there."""
    command = ["-m", "pursue_gen", "ws", "scenarios/thesis/scenario_3.pur"]
    assert said([sys.executable, *command, "-o", str(tmp_path / "first")]).returncode == 0
    plan, trees = str(tmp_path / "first" / "UPPAAL_plan.txt"), []
    for name, python in (("old", python38), ("today", sys.executable)):
        done = said([python, *command, "--plan", plan, "-o", str(tmp_path / name)])
        assert done.returncode == 0, done.stdout
        files = [path for path in sorted((tmp_path / name).rglob("*")) if path.is_file()]
        trees.append({str(path.relative_to(tmp_path / name)): path.read_bytes() for path in files})
    old, today = trees
    assert sorted(old) == sorted(today) and len(old) > 100
    assert [path for path in old if old[path] != today[path]] == []
