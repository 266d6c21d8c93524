"""The same exit status for the same thing, whatever the command."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Dict, List

import pytest

from tests.cli.test_commands import CALLED, FIRST, pursue

COMMANDS: Dict[str, List[str]] = {
    "check": ["check", "FILE"],
    "check of several": ["check", FIRST, "FILE"],
    "check --json": ["check", "--json", "FILE"],
    "fmt": ["fmt", "FILE"],
    "fmt --check": ["fmt", "--check", "FILE"],
    "tga": ["tga", "FILE", "-o", "out"],
    "solve": ["solve", "FILE"],
    "solve --json": ["solve", "--json", "FILE"],
    "verify": ["verify", "FILE", "plan.txt"],
    "report": ["report", "FILE"],
    "report --html": ["report", "FILE", "--html", "out.html"],
    "ws": ["ws", "FILE", "-o", "out"],
    "sim": ["sim", "FILE", "--runs", "1"],
    "play": ["play", "FILE"],
    "calibrate": ["calibrate", "FILE", "mission.bag"],
    "bundle": ["bundle", "FILE", "--keys", "keys"],
    "send": ["send", "FILE", "--to", "robots.yaml", "--keys", "keys"],
}
OTHER_FILES: Dict[str, List[str]] = {
    "verify's plan": ["verify", FIRST, "FILE"],
    "replay": ["replay", "FILE"],
    "calibrate's recording": ["calibrate", FIRST, "FILE"],
    "a network": ["solve", "FILE.xml", "query.q"],
    "ws with a plan": ["ws", FIRST, "--plan", "FILE", "-o", "out"],
    "ws with machines": ["ws", FIRST, "--machines", "FILE", "-o", "out"],
    "bundle --check": ["bundle", "--check", "FILE", "--keys", "keys"],
    "bundle --poses": ["bundle", FIRST, "--poses", "FILE", "--keys", "keys"],
    "send --to": ["send", FIRST, "--to", "FILE", "--keys", "keys"],
    "check --map": ["check", FIRST, "--map", "FILE"],
}
UNREADABLE = {"missing": None, "a folder": None, "no text": b"\xff\xfe\x00", "an archive": b"PK\3\4\0\0\xff"}


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder in which every file of the commands is sound."""
    pytest.importorskip("cryptography", reason="cryptography is not installed")
    made = tmp_path_factory.mktemp("sound")
    (made / "robots.yaml").write_text("format: 1\nrobots: {bot1: {host: localhost, port: 1}}\n")
    assert pursue("keys", "new", "lab", "--folder", made / "keys").status == 0
    assert pursue("solve", FIRST, "-o", made / "plan.txt").status == 0
    return made


@pytest.fixture
def folder(sound: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of that folder, in which the commands run."""
    copy = tmp_path / "folder"
    shutil.copytree(sound, copy)
    monkeypatch.chdir(copy)
    return copy


def status(command: List[str], file: Path) -> int:
    done = pursue(*(str(file) if word == "FILE" else word.replace("FILE", str(file)) for word in command))
    assert "internal error" not in done.err
    assert done.err or done.out
    return done.status


def make(folder: Path, what: str, name: str = "x.pur") -> Path:
    content = UNREADABLE[what]
    if content is not None:
        (folder / name).write_bytes(content)
    elif what == "a folder":
        (folder / name).mkdir()
    return folder / name


@pytest.mark.parametrize("what", UNREADABLE)
@pytest.mark.parametrize("command", COMMANDS)
def test_a_scenario_that_cannot_be_read(folder: Path, command: str, what: str) -> None:
    assert status(COMMANDS[command], make(folder, what)) == 2


@pytest.mark.parametrize("what", ["missing", "a folder"])
@pytest.mark.parametrize("command", OTHER_FILES)
def test_another_file_that_cannot_be_read(folder: Path, command: str, what: str) -> None:
    assert status(OTHER_FILES[command], make(folder, what, "x")) == 2


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("text", ["poi a\n", 'poi "a"\n' * 130_000, CALLED.format(deadline="x")])
def test_a_scenario_with_errors(folder: Path, command: str, text: str) -> None:
    (folder / "x.pur").write_text(text)
    assert status(COMMANDS[command], folder / "x.pur") == 3
