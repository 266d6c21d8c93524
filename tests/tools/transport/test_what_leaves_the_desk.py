"""What the desk says to robots, and to whom it speaks."""

from __future__ import annotations

import base64
import socket
import ssl
import threading
from pathlib import Path
from typing import Any, List

import pytest
from cryptography.hazmat.primitives.serialization import Encoding, NoEncryption, PrivateFormat
from fake_robot import KEY, FakeRobot, certificate, serving

from pursue_gen.cli.app import main
from pursue_gen.tools.transport.client import Robot, Unreached, health
from tests.waiting import PATIENCE

SCENARIO = str(Path(__file__).resolve().parents[3] / "scenarios" / "thesis" / "scenario_1.pur")


def test_the_private_key_is_in_nothing_that_is_sent(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """All bytes that go through sockets while a scenario is solved, signed, sent, and called back."""
    said: List[bytes] = []
    sendall = socket.socket.sendall

    def heard(line: socket.socket, data: Any, *flags: int) -> None:
        said.append(bytes(data))
        sendall(line, data, *flags)

    pem = KEY.private_bytes(Encoding.PEM, PrivateFormat.PKCS8, NoEncryption())
    secret = KEY.private_bytes(Encoding.Raw, PrivateFormat.Raw, NoEncryption())
    keys = tmp_path / "pursue" / "keys"
    keys.mkdir(parents=True)
    (keys / "lab.key").write_bytes(pem)
    (keys / "lab.key").chmod(0o600)
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    monkeypatch.setattr(socket.socket, "sendall", heard)
    to = tmp_path / "robots.yaml"
    robot = FakeRobot("base", ("UI", "observer", "controllerObj", "controller_bot1", "controller_bot2"))
    with serving([robot]) as (place,):
        line = f"  base: {{host: 127.0.0.1, port: {place.port}}}\n"
        to.write_text(f"format: 1\ntimeout: {PATIENCE}\nrobots:\n{line}")
        for words in ((SCENARIO, "--computed-poses"), ("--back",), ("--status",)):
            monkeypatch.setattr("sys.argv", ["pursue-gen", "send", *words, "--to", str(to)])
            with pytest.raises(SystemExit) as end:
                main()
            assert not end.value.code, words
    assert robot.uploads == 1 and robot.requests.count("commit") == 2
    everything = b"".join(said)
    assert b"manifest.json" in everything, "the bundle was heard"
    for form in (secret, base64.b64encode(secret)[:-2], secret.hex().encode(), *pem.splitlines()):
        assert form not in everything


@pytest.mark.filterwarnings("ignore:ssl.TLSVersion:DeprecationWarning")
def test_the_desk_speaks_no_old_tls(tmp_path: Path) -> None:
    """A robot, or somebody between, that has nothing newer than TLS 1.1 is not spoken to."""
    file = tmp_path / "bot1.pem"
    file.write_bytes(certificate("127.0.0.1"))
    old = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    old.set_ciphers("ALL:@SECLEVEL=0")
    old.load_cert_chain(str(file))
    old.minimum_version = ssl.TLSVersion.TLSv1
    old.maximum_version = ssl.TLSVersion.TLSv1_1
    heard: List[bytes] = []
    with socket.create_server(("127.0.0.1", 0)) as server:

        def answer() -> None:
            line, _ = server.accept()
            try:
                with old.wrap_socket(line, server_side=True) as inside:
                    heard.append(inside.recv(1000))
            except OSError:
                line.close()

        thread = threading.Thread(target=answer)
        thread.start()
        with pytest.raises(Unreached, match="no TLS with it"):
            health(Robot("bot1", "127.0.0.1", server.getsockname()[1], tls=True, ca=file, timeout=PATIENCE))
        thread.join()
    assert heard == []
