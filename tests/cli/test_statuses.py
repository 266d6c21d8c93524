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


CANNOT_BE_USED: Dict[str, List[str]] = {
    "fmt of several": ["fmt", "broken.pur", "none.pur"],
    "check of several": ["check", "broken.pur", "none.pur"],
    "a reaction below 0": ["verify", FIRST, "plan.txt", "--reaction=-1"],
    "another key": ["bundle", FIRST, "--keys", "keys", "--key", "other"],
    "a fault that is none": ["sim", FIRST, "--faults", "fire"],
    "a recording that is none": ["replay", "plan.txt"],
}
INVALID: Dict[str, List[str]] = {
    "a slack of nobody": ["solve", FIRST, "--slack", "nobody=1"],
    "no XML": ["solve", "plan.txt.xml", "query.q"],
    "no query": ["solve", "network.xml", "plan.txt"],
    "no plan": ["verify", FIRST, "broken.pur"],
    "a plan of another scenario": ["verify", "other.pur", "plan.txt"],
    "a name that is no package": ["ws", "not-a-package.pur", "-o", "out"],
    "places without poses": ["bundle", "other.pur", "--keys", "keys"],
    "survey of places without poses": ["survey", "map.yaml", "other.pur"],
}


@pytest.fixture
def with_errors(folder: Path) -> Path:
    """That folder, with files that have errors."""
    (folder / "broken.pur").write_text("poi a\n")
    (folder / "plan.txt.xml").write_text("Strategy")
    assert pursue("tga", FIRST, "-o", folder / "out").status == 0
    shutil.copy(str(folder / "out" / "TGA.xml"), str(folder / "network.xml"))
    shutil.rmtree(str(folder / "out"))
    for name in ("other.pur", "not-a-package.pur"):
        (folder / name).write_text(CALLED.format(deadline=5))
    numbers = "resolution: 1\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.2\n"
    (folder / "map.yaml").write_text(f"image: map.pgm\n{numbers}")
    (folder / "map.pgm").write_bytes(b"P5 2 2 255\n\xff\xff\xff\xff")
    return folder


@pytest.mark.parametrize("command", CANNOT_BE_USED)
def test_what_cannot_be_used(with_errors: Path, command: str) -> None:
    assert status(CANNOT_BE_USED[command], with_errors) == 2


@pytest.mark.parametrize("command", INVALID)
def test_what_has_errors(with_errors: Path, command: str) -> None:
    assert status(INVALID[command], with_errors) == 3
