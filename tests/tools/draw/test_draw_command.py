"""The command: an address on stdout, a page until Ctrl-C, and words where it cannot begin."""

from __future__ import annotations

import http.client
import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import List
from urllib.parse import urlsplit

import pytest
import typer

from pursue_gen.tools.commands.draw import draw
from tests.conftest import ROOT
from tests.large_scenarios import many_walkers
from tests.waiting import PATIENCE, until

COMMAND = [sys.executable, "-m", "pursue_gen", "draw"]


def started(folder: Path, *arguments: str) -> "subprocess.Popen[str]":
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    pipe = subprocess.PIPE
    return subprocess.Popen([*COMMAND, *arguments], stdout=pipe, stderr=pipe, text=True, cwd=folder, env=environment)


def asked(address: str, name: str, text: str) -> bytes:
    where = urlsplit(address)
    connection = http.client.HTTPConnection(where.netloc, timeout=PATIENCE)
    headers = {"Origin": f"http://{where.netloc}", "Content-Type": "application/json"}
    connection.request("POST", f"{where.path}{name}", json.dumps({"text": text, "version": ""}), headers)
    answer = connection.getresponse().read()
    connection.close()
    return answer


def workers(pid: int) -> List[int]:
    """The processes that a process has started, but for the one that multiprocessing keeps for itself."""
    children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    lines = ((int(child), Path(f"/proc/{child}/cmdline").read_bytes()) for child in children)
    return [child for child, line in lines if b"spawn_main" in line]


def is_alive(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        return False


def test_it_prints_its_address_saves_and_ends_with_ctrl_c(tmp_path: Path) -> None:
    with started(tmp_path, "new.pur") as program:
        assert program.stdout is not None
        address = program.stdout.readline().strip()
        assert b'"saved": "new.pur"' in asked(address, "save", "// new\n")
        program.send_signal(signal.SIGINT)
        _, said = program.communicate(timeout=PATIENCE)
    assert program.returncode == 0, said
    assert "new.pur is begun there" in said and "next: pursue-gen check new.pur" in said and "Traceback" not in said
    assert (tmp_path / "new.pur").read_text() == "// new\n"


def test_what_solves_ends_with_the_server_even_if_that_is_killed(tmp_path: Path) -> None:
    with started(tmp_path) as program:
        assert program.stdout is not None
        address = program.stdout.readline().strip()
        asked(address, "solve", many_walkers())
        (child,) = until(lambda: workers(program.pid), "the process that solves")
        program.kill()
        program.communicate(timeout=PATIENCE)
    until(lambda: not is_alive(child), "its end")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["a.yaml", "b.yaml"], "at most one map and one scenario"),
        (["a.pur", "b.pur"], "at most one map and one scenario"),
        (["nowhere.yaml"], "cannot read nowhere.yaml"),
        (["nowhere/a.pur"], "there is no folder nowhere"),
        ([], "my_floor.pur is there already"),
        (["latin.pur"], "not text in UTF-8"),
    ],
)
def test_what_it_cannot_begin_with_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], arguments: List[str],
    words: str,
) -> None:
    (tmp_path / "my_floor.pur").write_text("")
    (tmp_path / "latin.pur").write_bytes(b"// \xe9\n")
    monkeypatch.chdir(tmp_path)
    with pytest.raises(typer.Exit) as caught:
        draw([Path(name) for name in arguments], port=0, browser=False, limit=10.0, robot=[], force=False)
    out, said = capsys.readouterr()
    assert (caught.value.exit_code, out) == (2, "") and words in said and "help:" in said
