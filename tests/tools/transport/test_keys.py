"""Keys at the desk: made once, for their owner's eyes only, and never replaced unasked. The commands `keys …` too."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
from pathlib import Path
from typing import Callable, Dict, List

import pytest

pytest.importorskip("cryptography", reason="cryptography is not installed")

from cryptography.hazmat.backends import default_backend
from cryptography.hazmat.primitives.asymmetric import ec, ed25519
from cryptography.hazmat.primitives.serialization import BestAvailableEncryption, Encoding, NoEncryption, PrivateFormat

from pursue_gen.diagnostics import PursueError
from pursue_gen.tools.transport.keys import default_key, key_names, keys_folder, load_private, load_public, new_key
from pursue_runtime.bundle import fingerprint, read_keys
from tests.tools.authoring.commands import pursue
from tests.waiting import PATIENCE

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of keys of somebody who has none yet."""
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    return tmp_path / "config" / "pursue" / "keys"


def code_of(call: Callable[[], object]) -> str:
    with pytest.raises(PursueError) as caught:
        call()
    (finding,) = caught.value.diagnostics
    assert finding.hint and caught.value.exit_status == 2
    return finding.code


# The folder -----------------------------------------------------------------------------------------------------------


def test_keys_are_in_the_configuration_of_their_owner(monkeypatch: pytest.MonkeyPatch, home: Path) -> None:
    assert keys_folder() == home
    monkeypatch.setenv("HOME", "/home/ada")
    for relative in ("", "config"):  # the standard ignores what is no absolute path
        monkeypatch.setenv("XDG_CONFIG_HOME", relative)
        assert keys_folder() == Path("/home/ada/.config/pursue/keys")
    monkeypatch.delenv("XDG_CONFIG_HOME")
    assert keys_folder() == Path("/home/ada/.config/pursue/keys")


# Making and reading ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("umask", [0o022, 0o000, 0o077])
def test_a_private_key_is_for_its_owner_alone(home: Path, umask: int) -> None:
    before = os.umask(umask)
    try:
        private, public = new_key("lab", home)
    finally:
        os.umask(before)
    assert stat.S_IMODE(private.stat().st_mode) == 0o600
    assert stat.S_IMODE(home.stat().st_mode) == 0o700
    assert stat.S_IMODE(public.stat().st_mode) == 0o666 & ~umask
    assert sorted(file.name for file in home.iterdir()) == ["lab.key", "lab.pub"]


def test_both_halves_belong_together(home: Path) -> None:
    _, public = new_key("lab", home)
    key = load_private("lab", home)
    assert fingerprint(load_public("lab", home)) == fingerprint(key.public_key())
    assert set(read_keys(str(home))[0]) == {fingerprint(key.public_key())}
    assert public.read_text().split()[2] == "lab"
    new_key("other", home)
    assert fingerprint(load_private("other", home).public_key()) != fingerprint(key.public_key())


def test_a_key_is_found_by_name_by_path_and_alone(home: Path) -> None:
    private, _ = new_key("lab", home)
    keys = [load_private("lab"), load_private(str(private)), load_private(), load_private("lab", home)]
    assert len({fingerprint(key.public_key()) for key in keys}) == 1 and default_key(home) == "lab"


def test_there_may_be_no_key_or_several(home: Path) -> None:
    assert code_of(load_private) == "TRN002"
    new_key("lab", home)
    new_key("home", home)
    assert key_names(home) == ["home", "lab"]
    assert code_of(load_private) == "TRN006"
    assert code_of(lambda: load_private("laab")) == "TRN002"
    assert code_of(lambda: load_private("/nowhere/lab.key")) == "TRN002"


@pytest.mark.parametrize("name", ["", "../lab", "a/b", ".hidden", "-f", "a b", "ä", "x" * 65, "a\n"])
def test_a_name_is_a_plain_word(home: Path, name: str) -> None:
    assert code_of(lambda: new_key(name, home)) == "TRN002"
    assert not home.exists()


def test_a_key_is_not_replaced_unasked(home: Path) -> None:
    private, public = new_key("lab", home)
    before = (private.read_bytes(), public.read_bytes())
    assert code_of(lambda: new_key("lab", home)) == "TRN005"
    private.unlink()
    assert code_of(lambda: new_key("lab", home)) == "TRN005"  # the public one may be a friend's
    assert not private.exists() and public.read_bytes() == before[1]
    public.unlink()
    private.write_bytes(before[0])
    assert code_of(lambda: new_key("lab", home)) == "TRN005"
    assert private.read_bytes() == before[0] and not public.exists()
    new_key("lab", home, force=True)
    assert private.read_bytes() != before[0] and stat.S_IMODE(private.stat().st_mode) == 0o600
    assert sorted(file.name for file in home.iterdir()) == ["lab.key", "lab.pub"]


def test_a_folder_that_cannot_be_made_is_reported(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("x")
    assert code_of(lambda: new_key("lab", tmp_path / "file" / "keys")) == "CLI003"


@pytest.mark.parametrize("mode", [0o640, 0o604, 0o620, 0o602, 0o666, 0o610])
def test_a_key_that_others_may_read_is_not_used(home: Path, mode: int) -> None:
    private, _ = new_key("lab", home)
    private.chmod(mode)
    told = pursue("keys", "show", "lab")
    assert (told.status, told.out) == (2, "") and f"chmod 600 {private}" in told.err and "TRN003" in told.err
    assert code_of(lambda: load_private("lab")) == "TRN003"
    private.chmod(0o400)
    load_private("lab")


def wrong_keys() -> Dict[str, bytes]:
    plain = (Encoding.PEM, PrivateFormat.PKCS8)
    key = ed25519.Ed25519PrivateKey.generate()
    other = ec.generate_private_key(ec.SECP256R1(), default_backend())
    return {
        "nothing": b"", "a letter": b"x", "no text": b"\xff" * 100,
        "no key in it": b"-----BEGIN PRIVATE KEY-----\nAAAA\n-----END PRIVATE KEY-----\n",
        "with a password": key.private_bytes(*plain, BestAvailableEncryption(b"secret")),
        "another kind": other.private_bytes(*plain, NoEncryption()),
        "cut off": key.private_bytes(*plain, NoEncryption())[:-40],
    }


@pytest.mark.parametrize("what", wrong_keys())
def test_what_is_no_private_key_is_reported(home: Path, what: str) -> None:
    content = wrong_keys()[what]
    home.mkdir(parents=True)
    (home / "lab.key").write_bytes(content)
    (home / "lab.key").chmod(0o600)
    assert code_of(load_private) == "TRN004"


def test_the_public_half_signs_nothing(home: Path) -> None:
    _, public = new_key("lab", home)
    assert code_of(lambda: load_private(str(public))) == "TRN004"


def test_a_public_key_of_somebody_else_is_noticed(home: Path) -> None:
    new_key("lab", home)
    new_key("friend", home)
    (home / "friend.key").unlink()
    load_public("friend", home)
    (home / "lab.pub").write_bytes((home / "friend.pub").read_bytes())
    assert code_of(lambda: load_public("lab", home)) == "TRN007"
    (home / "lab.pub").write_bytes(b"\xff")
    assert code_of(lambda: load_public("lab", home)) == "TRN007"
    (home / "lab.pub").unlink()
    assert fingerprint(load_public("lab", home)) == fingerprint(load_private("lab", home).public_key())
    assert code_of(lambda: load_public("../lab", home)) == "TRN002"


# The commands ---------------------------------------------------------------------------------------------------------


def test_a_new_key_and_what_to_do_with_it(home: Path) -> None:
    told = pursue("keys", "new", "lab")
    assert (told.status, told.out) == (0, f"{home / 'lab.key'}\n")
    assert "pursue/keys" in told.err and str(home / "lab.pub") in told.err
    shown = pursue("keys", "show", "lab")
    assert shown.out == (home / "lab.pub").read_text() and shown.status == 0
    assert fingerprint(load_public("lab", home)) in shown.err and "$ROS_HOME/pursue/keys" in shown.err
    assert pursue("keys", "new", "lab").status == 2
    assert pursue("keys", "new", "lab", "--force").status == 0


def test_the_list_of_keys(home: Path, tmp_path: Path) -> None:
    told = pursue("keys", "list")
    assert (told.status, told.out) == (0, "") and "keys new" in told.err
    elsewhere = tmp_path / "elsewhere"
    pursue("keys", "new", "lab", "--folder", elsewhere)
    pursue("keys", "new", "friend", "--folder", elsewhere)
    (elsewhere / "friend.key").unlink()
    (elsewhere / "broken.pub").write_text("nothing")
    told = pursue("keys", "list", "--folder", elsewhere)
    rows = [line.split(None, 2) for line in told.out.splitlines()]
    assert [(row[0], row[2]) for row in rows] == [("friend", "public only"), ("lab", "private and public")]
    assert rows[1][1] == fingerprint(load_public("lab", elsewhere)) and told.status == 0
    assert "warning TRN008" in told.err and "broken.pub" in told.err


def test_a_key_that_is_not_there_is_reported() -> None:
    told = pursue("keys", "show", "lab")
    assert (told.status, told.out) == (2, "") and "TRN002" in told.err


def test_a_private_key_is_never_printed(home: Path) -> None:
    told = [pursue("keys", *words) for words in (("new", "lab"), ("list",), ("show", "lab"))]
    secret = (home / "lab.key").read_text().splitlines()[1]
    assert all(secret not in one.out + one.err for one in told)


def without_cryptography(*words: object) -> "subprocess.CompletedProcess[str]":
    program = "import sys; sys.modules['cryptography'] = None; from pursue_gen.cli.app import main; main()"
    command = [sys.executable, "-c", program, *map(str, words)]
    return subprocess.run(command, cwd=str(ROOT), capture_output=True, text=True, timeout=2 * PATIENCE, check=False)


@pytest.mark.parametrize(
    "words", [["keys", "new", "lab"], ["keys", "list"], ["keys", "show", "lab"], ["bundle", "floor.pur"]]
)
def test_without_cryptography_it_is_reported_what_to_install(words: List[str], home: Path) -> None:
    done = without_cryptography(*words)
    assert (done.returncode, done.stdout) == (6, "")
    assert "TRN001" in done.stderr and "pip install cryptography" in done.stderr and "Traceback" not in done.stderr
    assert not home.exists()


def test_a_workspace_needs_no_cryptography(tmp_path: Path) -> None:
    done = without_cryptography("ws", "scenarios/thesis/scenario_1.pur", "-o", tmp_path / "ws")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "ws/src/observer/config/mission.yaml").is_file()
