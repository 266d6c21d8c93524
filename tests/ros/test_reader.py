"""The node pursue_reader: what it makes of messages on local_mission, and that it goes on where it was killed."""

from __future__ import annotations

import base64
import contextlib
import hashlib
import json
import os
import signal
import subprocess
import time
import xmlrpc.client
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List

import pytest
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey
from ros_world import Ros, end, make_whole

from pursue_gen.workspace.generate import mission_of
from pursue_runtime.bundle import COMMIT, PREPARE, Order, pack, write_order, write_public_key
from pursue_runtime.manifest import make_manifest
from tests.waiting import PATIENCE
from tests.workspace.worlds import files

Build = Callable[..., Path]

pytestmark = pytest.mark.ros

BRIDGE = Path(__file__).resolve().parent / "topic_bridge.py"
DESK, STRANGER = (Ed25519PrivateKey.from_private_bytes(bytes([number]) * 32) for number in (1, 2))


def state(seq: int, stamp: int, status: str) -> Dict[str, Any]:
    """The fields of a state."""
    automata = [{"name": "bot1", "location": "a"}]
    stamps = {"secs": stamp, "nsecs": 0}
    return {"seq": seq, "stamp": stamps, "time_unit": 1.0, "status": status, "automata": automata}


class RunningReader:
    """A reader under roslaunch in namespace bot1, and a node that publishes and subscribes."""

    def __init__(self, folder: Path, uri: str, bridge: "subprocess.Popen[bytes]") -> None:
        self.folder, self._uri, self._bridge = folder, uri, bridge

    def publish(self, topic: str, *texts: str) -> None:
        """Publishes these texts."""
        assert self._bridge.stdin is not None
        for text in texts:
            self._bridge.stdin.write(json.dumps({"topic": topic, "data": text}).encode() + b"\n")
        self._bridge.stdin.flush()

    def statuses(self) -> List[Dict[str, Any]]:
        """The statuses that the reader has published so far."""
        text = (self.folder / "statuses").read_bytes()
        lines = text[: text.rfind(b"\n") + 1].splitlines()
        return [json.loads(json.loads(line)["data"]) for line in lines if line.startswith(b"{")]

    def until(self, good: Callable[[Dict[str, Any]], bool]) -> Dict[str, Any]:
        """Waits until the last status is so."""
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline:
            statuses = self.statuses()
            if statuses and good(statuses[-1]):
                return statuses[-1]
            time.sleep(0.05)
        log = (self.folder / "launch.log").read_text(errors="replace")
        raise AssertionError(f"not so after {PATIENCE} s: {self.statuses()[-1:]}\n{log[-4000:]}")

    def order(self, action: str, digest: str, bundle: bytes = b"", **wrong: Any) -> str:
        """What the desk's order is as a message."""
        given = {"robot": "bot1", "ticket": self.statuses()[-1]["ticket"], **wrong}
        key = given.pop("key", DESK)
        size, seal = len(bundle), hashlib.sha256(bundle).hexdigest() if bundle else ""
        text = write_order(Order(action, digest, size=size, bundle=seal, **given), key)
        return json.dumps({"order": text, **({"bundle": base64.b64encode(bundle).decode()} if bundle else {})})

    def set_parameter(self, name: str, value: str) -> None:
        """Set a parameter of the master, as anybody can who reaches it."""
        with xmlrpc.client.ServerProxy(self._uri) as master:
            assert master.setParam("/stranger", name, value)[0] == 1  # type: ignore[index]

    def kill(self) -> None:
        """kill -9."""
        with xmlrpc.client.ServerProxy(self._uri) as master:
            _, _, node = master.lookupNode("/test", "/bot1/pursue_reader")  # type: ignore[misc]
        with xmlrpc.client.ServerProxy(str(node)) as slave:
            os.kill(int(slave.getPid("/test")[2]), signal.SIGKILL)  # type: ignore[index]

    def stored(self) -> List[str]:
        """The files of the store."""
        store = self.folder / "home" / "pursue" / "missions"
        return sorted(path.relative_to(store).as_posix() for path in store.rglob("*") if path.is_file())


@contextlib.contextmanager
def running_reader(ros: Ros, workspace: Path, folder: Path) -> Iterator[RunningReader]:
    keys = folder / "home" / "pursue" / "keys"
    keys.mkdir(parents=True)
    (keys / "desk.pub").write_text(write_public_key(DESK.public_key(), "desk"))
    with ros.master() as there:
        there = {**there, "ROS_HOME": str(folder / "home"), "ROS_LOG_DIR": str(folder / "log")}
        command = "source devel/setup.bash; exec roslaunch --skip-log-check pursue_reader pursue_reader.launch"
        command += " nodes:='observer, UI controller_bot1 controller_bot2'"
        launch = ros.start(command, workspace, folder / "launch.log", ROS_NAMESPACE="bot1", **there)
        with open(folder / "statuses", "wb") as statuses, open(folder / "bridge.log", "wb") as log:
            bridge = subprocess.Popen(
                ["bash", "-c", f"source devel/setup.bash; exec python3 {BRIDGE} /bot1/mission_status"],
                cwd=workspace,
                env={**ros.environment, **there},
                stdin=subprocess.PIPE,
                stdout=statuses,
                stderr=log,
                start_new_session=True,
            )
        try:
            yield RunningReader(folder, there["ROS_MASTER_URI"], bridge)
        finally:
            if bridge.stdin is not None:
                bridge.stdin.close()
            for process in (launch, bridge):
                end(process)


def test_missions_that_come_are_checked_kept_and_survive_the_reader(ros: Ros, built: Build, tmp_path: Path) -> None:
    _, data = mission_of("scenario_1", files("thesis/scenario_1"))
    data["UI/ui.yaml"] += b"# not the workspace's own\n"
    manifest = make_manifest("scenario_1", "0", ("controller_bot1", "controller_bot2"), data)
    digest, bundle = manifest.digest, pack(manifest, data, DESK)
    workspace = built("thesis/scenario_1", "distributed", make_whole)
    with running_reader(ros, workspace, tmp_path) as there:
        first = there.until(lambda status: True)
        assert first["current"] == "" and first["answer"] is None and first["robot"] == "bot1"
        assert first["packages"] == ["UI", "controller_bot1", "controller_bot2", "observer"]

        strange = pack(manifest, data, STRANGER)
        there.publish("/bot1/local_mission", *(f"junk {number}" for number in range(200)))
        there.publish("/bot1/local_mission", there.order(PREPARE, digest, bundle, key=STRANGER))
        there.publish("/bot1/local_mission", there.order(PREPARE, digest, bundle, robot="bot2"))
        there.publish("/bot1/local_mission", there.order(PREPARE, digest, strange))
        refused = there.until(lambda status: status["answer"] is not None)
        assert refused["answer"]["code"] == "unknown_key" and refused["answer"]["ticket"] == first["ticket"]
        assert len(there.statuses()) == 2 and there.stored() == []

        prepare = there.order(PREPARE, digest, bundle)
        there.publish("/bot1/local_mission", prepare, prepare)
        prepared = there.until(lambda status: status["prepared"] == digest)
        assert prepared["answer"]["ok"] and prepared["answer"]["ticket"] == refused["ticket"]
        there.publish("/pursue/state", state(1, 1, "running"))
        there.until(lambda status: bool(status["mission_runs"]))
        commit = there.order(COMMIT, digest)
        there.publish("/bot1/local_mission", commit)
        waiting = there.until(lambda status: status["next"] == digest)
        assert waiting["answer"]["code"] == "waiting" and waiting["current"] == ""

        there.kill()
        again = there.until(lambda status: status["answer"] is None and status["mission_runs"])
        assert (again["current"], again["next"], again["kept"]) == ("", digest, [digest])
        there.publish("/bot1/local_mission", prepare, commit)
        there.publish("/pursue/state", state(2, 9, "won"))
        over = there.until(lambda status: status["current"] == digest)
        assert over["ticket"] == again["ticket"] and over["next"] is None and over["history"] == [""]

        parts = {f"{path.split('/')[0]}/mission.yaml" for path in data}
        assert there.stored() == sorted(
            [*(f"{digest}/{name}" for name in (*data, *parts, "manifest.json", "signature.json")), "state.json"]
        )
        command = "source devel/setup.bash; rosrun pursue_reader missions"
        listed = ros.run(command, workspace, ROS_HOME=str(tmp_path / "home"))
        assert listed.returncode == 0 and any(
            line.split() == [digest[:12], "scenario_1", "current"] for line in listed.stdout.splitlines()
        )
    log = (tmp_path / "launch.log").read_text(errors="replace")
    assert "Traceback" not in log and log.count("refused (") < 10


def test_a_folder_of_keys_that_somebody_sets_as_a_parameter_is_not_trusted(
    ros: Ros, built: Build, tmp_path: Path
) -> None:
    _, data = mission_of("scenario_1", files("thesis/scenario_1"))
    manifest = make_manifest("scenario_1", "0", ("controller_bot1", "controller_bot2"), data)
    theirs = tmp_path / "theirs"
    theirs.mkdir()
    (theirs / "stranger.pub").write_text(write_public_key(STRANGER.public_key(), "stranger"))
    with running_reader(ros, built("thesis/scenario_1", "distributed", make_whole), tmp_path) as there:
        first = there.until(lambda status: True)
        there.set_parameter("/bot1/pursue_reader/keys", str(theirs))
        there.kill()
        there.until(lambda status: status["ticket"] != first["ticket"] and status["answer"] is None)
        strange = pack(manifest, data, STRANGER)
        there.publish("/bot1/local_mission", there.order(PREPARE, manifest.digest, strange, key=STRANGER))
        there.publish("/bot1/local_mission", there.order(PREPARE, manifest.digest, strange))
        refused = there.until(lambda status: status["answer"] is not None)
        assert refused["answer"]["code"] == "unknown_key" and there.stored() == []
    assert "ignored parameters: ~keys" in (tmp_path / "launch.log").read_text(errors="replace")
