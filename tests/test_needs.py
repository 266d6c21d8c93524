"""Packages that are missing or too old: the program and the nodes say so at once, with versions and what to do."""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
from pathlib import Path
from typing import Dict

import pytest

from pursue_gen.needs import NEEDS
from pursue_runtime import needs
from pursue_runtime.needs import PYYAML, TORNADO, TRANSITIONS, Need, NeedError, found_version, require
from tests.conftest import ROOT, thesis_scenario

OLD = {
    "catkin_pkg": "0.3.9", "jinja2": "2.10", "lark": "1.1.4", "PyYAML": "5.2", "transitions": "0.6.9",
    "tornado": "5.1.1", "typer": "0.6.1",
}  # fmt: skip


def installed(folder: Path, name: str, version: str) -> Path:
    """The folder with the metadata of a package, as pip leaves them."""
    told = folder / f"{name}-{version}.dist-info"
    told.mkdir(parents=True)
    (told / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n", encoding="utf-8")
    return folder


def called(words: "list[object]", first: Path, **more: str) -> "subprocess.CompletedProcess[str]":
    """A program of this Python that finds modules and metadata in the folder `first`."""
    environment: Dict[str, str] = {**os.environ, "PYTHONPATH": f"{first}{os.pathsep}{ROOT}", **more}
    command = [sys.executable, *map(str, words)]
    return subprocess.run(command, env=environment, capture_output=True, text=True, timeout=600, check=False)


@pytest.mark.parametrize("need", NEEDS, ids=[need.name for need in NEEDS])
def test_the_program_names_what_is_too_old_and_the_line_that_installs_it(need: Need, tmp_path: Path) -> None:
    folder = installed(tmp_path / "old", need.name, OLD[need.name])
    done = called(["-m", "pursue_gen", "check", thesis_scenario("1")], folder)
    told = f"pursue-gen: {need.name} {OLD[need.name]} is too old ({need.oldest} or newer is needed)\n"
    assert (done.returncode, done.stdout) == (6, "")
    assert done.stderr == f"{told}    help: {sys.executable} -m pip install '{need.requirement}'\n"


def test_all_that_is_too_old_is_named_at_once(tmp_path: Path) -> None:
    for name in ("lark", "jinja2"):
        installed(tmp_path, name, OLD[name])
    done = called(["-m", "pursue_gen", "--version"], tmp_path)
    assert "jinja2 2.10 is too old (2.10.1 or newer is needed); lark 1.1.4 is too old" in done.stderr
    assert "pip install 'jinja2>=2.10.1' 'lark>=1.1.5'\n" in done.stderr


@pytest.mark.parametrize(
    ("need", "module"),
    [(PYYAML, "bounded"), (TRANSITIONS, "observer.automata"), (TORNADO, "http_server")],
    ids=["PyYAML", "transitions", "tornado"],
)
def test_what_a_node_imports_refuses_a_package_that_is_too_old(need: Need, module: str, tmp_path: Path) -> None:
    pytest.importorskip(need.module)
    folder = installed(tmp_path, need.name, OLD[need.name])
    done = called(["-c", f"import pursue_runtime.{module}"], folder)
    told = f"NeedError: {need.name} {OLD[need.name]} is too old ({need.oldest} or newer is needed)\n"
    assert done.stderr.endswith(told)


def test_a_node_says_what_is_too_old_and_does_not_start(tmp_path: Path) -> None:
    made = called(["-m", "pursue_gen", "ws", thesis_scenario("1"), "-o", tmp_path / "ws"], tmp_path)
    assert made.returncode == 0, made.stderr
    source = tmp_path / "ws" / "src"
    folder = installed(tmp_path / "old", "PyYAML", "5.2")
    path = os.pathsep.join(map(str, (folder, source / "pursue_runtime" / "src")))
    done = called([source / "observer" / "scripts" / "observer"], folder, PYTHONPATH=path)
    told = "observer: PyYAML 5.2 is too old (5.3 or newer is needed)\n"
    assert (done.returncode, done.stderr) == (1, f"{told}    help: {sys.executable} -m pip install 'PyYAML>=5.3'\n")


def test_what_is_missing_has_the_names_that_debian_has_for_it() -> None:
    missing = Need("no-such-package", "1.2", "no_such_module", "python3-no-such-package")
    assert found_version(missing) is None
    with pytest.raises(NeedError, match=r"^no-such-package is missing \(1\.2 or newer is needed\)$") as caught:
        require(PYYAML, missing)
    debian = "(Debian 12: sudo apt install python3-no-such-package)"
    assert caught.value.hint.endswith(f"pip install 'no-such-package>=1.2' {debian}")


def test_a_module_of_a_package_with_another_name_tells_its_version(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Ubuntu 20.04's python3-lark-parser has the module lark, and no package lark."""
    (tmp_path / "parser_of_old.py").write_text('__version__ = "0.8.1"\n', encoding="utf-8")
    (tmp_path / "quiet_module.py").write_text("", encoding="utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    importlib.invalidate_caches()
    old = Need("parser-now", "1.1.5", "parser_of_old", "")
    with pytest.raises(NeedError, match=r"parser-now 0\.8\.1 is too old"):
        require(old)
    require(Need("quiet", "3", "quiet_module", ""))  # nobody knows: it may do


@pytest.mark.parametrize(
    ("found", "oldest", "does"),
    [
        ("1.1.5", "1.1.5", True), ("1.1.10", "1.1.5", True), ("1.1", "1.1.5", False), ("2", "1.1.5", True),
        ("0.8.11", "0.7", True), ("0.10", "0.9", True), ("5.3.0", "5.3", True), ("5.3", "5.3.0", True),
        ("6.0rc1", "6.0", True), ("6.0+deb12u1", "6.0", True), ("10", "9.9", True), ("unknown", "1", True),
    ],
)  # fmt: skip
def test_versions_are_compared_by_their_numbers(
    found: str, oldest: str, does: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(needs, "found_version", lambda need: found)
    need = Need("some", oldest, "some", "")
    if does:
        require(need)
    else:
        with pytest.raises(NeedError):
            require(need)
