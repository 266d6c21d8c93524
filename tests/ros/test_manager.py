"""The node communication_manager with pursue_reader behind it: missions over HTTP, deaths of both, forwarded topics."""

from __future__ import annotations

import contextlib
import hashlib
import http.client
import json
import os
import signal
import socket
import time
import xmlrpc.client
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, Tuple

import pytest
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey
from ros_world import Ros, end, free_port, make_whole

from pursue_gen.workspace.generate import mission_of
from pursue_runtime.bundle import COMMIT, PREPARE, Order, pack, write_order, write_public_key
from pursue_runtime.manifest import OWN, make_manifest
from tests.waiting import PATIENCE
from tests.workspace.worlds import files

Build = Callable[..., Path]

pytestmark = pytest.mark.ros

DESK = Ed25519PrivateKey.from_private_bytes(bytes([1]) * 32)
LAUNCH = """<launch><group ns="bot1">
  <include file="$(find communication_manager)/launch/communication_manager.launch">
    <arg name="port" value="{port}"/><arg name="pubsubport" value="{pubsubport}"/>
    <arg name="forwardedtopics" value="mission_status, /pursue/events"/>
  </include>
  <include file="$(find pursue_reader)/launch/pursue_reader.launch"><arg name="patience" value="1"/></include>
</group></launch>
"""


class Machine:
    """A robot's two nodes under roslaunch."""

    def __init__(self, uri: str, log: Path, port: int, pubsubport: int) -> None:
        self.uri, self.log, self.port, self.pubsubport = uri, log, port, pubsubport

    def ask(self, method: str, path: str, body: bytes = b"", **headers: str) -> Tuple[int, Dict[str, Any]]:
        """The answer of the server; status 0 where there is none."""
        there = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE)
        try:
            there.request(method, path, body or None, {key.replace("_", "-"): text for key, text in headers.items()})
            answer = there.getresponse()
            return answer.status, json.loads(answer.read())
        except (OSError, http.client.HTTPException):
            return 0, {}
        finally:
            there.close()

    def until(self, status: int, good: Callable[[Dict[str, Any]], bool] = lambda _: True) -> Dict[str, Any]:
        """Waits until /health says so."""
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline:
            found, facts = self.ask("GET", "/health")
            if found == status and good(facts):
                return facts
            time.sleep(0.05)
        raise AssertionError(f"not {status} after {PATIENCE} s: {found}, {facts}\n{self.log.read_text()[-4000:]}")

    def order(self, action: str, digest: str, body: bytes = b"") -> Tuple[int, Dict[str, Any]]:
        """A right order."""
        ticket = self.until(200)["ticket"]
        seal = hashlib.sha256(body).hexdigest() if body else ""
        order = write_order(Order(action, digest, "bot1", ticket, len(body), seal), DESK)
        return self.ask("POST", "/mission", body, Pursue_Order=order)

    def kill(self, node: str) -> None:
        """kill -9."""
        with xmlrpc.client.ServerProxy(self.uri) as master:
            _, _, address = master.lookupNode("/test", f"/bot1/{node}")  # type: ignore[misc]
        with xmlrpc.client.ServerProxy(str(address)) as slave:
            os.kill(int(slave.getPid("/test")[2]), signal.SIGKILL)  # type: ignore[index]


@contextlib.contextmanager
def machine(ros: Ros, workspace: Path, folder: Path) -> Iterator[Machine]:
    keys = folder / "home" / "pursue" / "keys"
    keys.mkdir(parents=True)
    (keys / "desk.pub").write_text(write_public_key(DESK.public_key(), "desk"))
    port, pubsubport = free_port(), free_port()
    (folder / "both.launch").write_text(LAUNCH.format(port=port, pubsubport=pubsubport))
    with ros.master() as there:
        there = {**there, "ROS_HOME": str(folder / "home"), "ROS_LOG_DIR": str(folder / "log")}
        command = f"source devel/setup.bash; exec roslaunch --skip-log-check {folder}/both.launch"
        launch = ros.start(command, workspace, folder / "launch.log", **there)
        try:
            yield Machine(there["ROS_MASTER_URI"], folder / "launch.log", port, pubsubport)
        finally:
            end(launch)


def test_missions_come_over_http_whoever_is_killed(ros: Ros, built: Build, tmp_path: Path) -> None:
    _, data = mission_of("scenario_1", files("thesis/scenario_1"))
    data["UI/ui.yaml"] += b"# not the workspace's own\n"
    manifest = make_manifest("scenario_1", "0", ("controller_bot1", "controller_bot2"), data)
    digest, bundle = manifest.digest, pack(manifest, data, DESK)
    workspace = built("thesis/scenario_1", "distributed", make_whole)
    with machine(ros, workspace, tmp_path) as there:
        first = there.until(200)
        assert (first["robot"], first["current"], first["reader"]) == ("bot1", OWN, True)
        assert there.ask("POST", "/mission", b"x" * 1000)[0] == 400
        assert there.ask("GET", "/")[0] == 404
        status, told = there.order(PREPARE, digest, bundle)
        assert (status, told["ok"], told["status"]["prepared"]) == (200, True, digest), told

        listener = socket.create_connection(("127.0.0.1", there.pubsubport), timeout=PATIENCE)
        with listener, listener.makefile("rb") as lines:
            heard = map(json.loads, lines)  # the status of before may come first
            statuses = (json.loads(said["data"]) for said in heard if said["topic"] == "mission_status")
            assert any(status["prepared"] == digest for status in statuses)

            there.kill("communication_manager")
            assert list(heard) == [], "nothing but the end of the connection"
        again = there.until(200)
        assert again["prepared"] == digest, "on the same ports, and the robot stands as it stood"
        status, told = there.order(COMMIT, digest)
        assert status == 200 and digest in (told["status"]["current"], told["status"]["next"]), told

        ticket = there.until(200)["ticket"]
        there.kill("pursue_reader")
        assert there.until(503) == {"robot": "bot1", "reader": False}
        back = there.until(200, lambda facts: facts["ticket"] != ticket)
        assert digest in (back["current"], back["next"])
        there.until(200, lambda facts: facts["current"] == digest)
        status, told = there.order(PREPARE, OWN)
        assert (status, told["ok"]) == (200, True), told

        command = f"source devel/setup.bash; rosrun communication_manager communication_manager --port {there.port}"
        second = ros.run(command, workspace, ROS_HOME=str(tmp_path), ROS_MASTER_URI=there.uri)
        assert second.returncode == 3 and "choose another --port" in second.stdout
        assert "Traceback" not in second.stdout
    log = (tmp_path / "launch.log").read_text(errors="replace")
    assert "Traceback" not in log, log
    assert "prepare, mission own" in log and log.count("refused: ") + log.count("refused (") <= 2
