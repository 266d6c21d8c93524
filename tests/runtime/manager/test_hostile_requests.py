"""Ten thousand hostile requests to a robot: store, memory, descriptors and threads stay as they were, and it serves.

The server is the generated one, and behind it is the real reader with its store on the disk; only ROS is missing.
"""

from __future__ import annotations

import contextlib
import gc
import io
import json
import os
import random
import socket
import struct
import threading
import time
import zipfile
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List, NamedTuple, Optional, Set, Tuple

import pytest

from pursue_runtime import bundle as mission_bundle
from pursue_runtime.bundle import KeyFolder
from pursue_runtime.manifest import make_manifest
from pursue_runtime.reader import reader as reader_core
from pursue_runtime.reader.reader import Reader
from pursue_runtime.reader.store import Store
from tests.runtime.manager_stage import ROBOT, Desk, Robot, Sent, ask, head, send
from tests.runtime.reader_stage import POSES, STRATEGY
from tests.waiting import PATIENCE, connected, may_close, rest, until

REQUESTS = 4_000
WARM = 1_000
GROWTH = 20 << 20
"""Bytes of memory that the last nine thousand requests may cost."""
UNHEARD = REQUESTS // 100
"""So many may get no answer: a busy machine may need longer for a head than the second that the server gives it."""
LATER = (0, 408, 409, 503, 504)
"""Answers after which a desk asks once more: none, too slow, another ticket is out, busy, no word of the reader."""
STRANGER = Desk(2)


class RealReader:
    """pursue_reader without ROS."""

    def __init__(self, keys: Path, say: Callable[[str], None]) -> None:
        self.lines: List[str] = []
        self.folder, self.there, self.say = keys.parent / "missions", True, say
        log = lambda level, text: self.lines.append(text)
        self.store = Store(str(self.folder), 5, log)
        facts = reader_core.Machine(ROBOT, "own", ("controller_bot1",), 1 << 20)
        self.core = Reader(facts, self.store, KeyFolder(str(keys)), 0.0, log)

    @property
    def ticket(self) -> str:
        return str(self.core.ticket)

    def status(self) -> str:
        return json.dumps(self.core.status())

    def hear(self, text: str) -> None:
        self.core.on_message(text, time.monotonic())
        self.say(self.status())


def good_mission(desk: Desk, name: str) -> Sent:
    files = {"controller_bot1/strategy.yaml": b"# " + name.encode() + b"\n" + STRATEGY,
             "controller_bot1/poses.yaml": POSES}
    return desk.bundle(name, files)


class Hostile(NamedTuple):
    """What is sent, and what may come back: HTTP statuses, 0 for a closed connection."""

    data: bytes
    expected: Tuple[int, ...]
    reads: bool = True  # waits for the answer


class Attacker:
    """Makes requests from a seed. It has heard all that went over the wire before, and owns a key nobody trusts."""

    def __init__(self, seed: int, robot: Robot, desk: Desk, heard: List[bytes], digest: str) -> None:
        self.random, self.robot, self.desk, self.heard, self.digest = random.Random(seed), robot, desk, heard, digest
        self.kinds: Dict[str, Callable[[], Hostile]] = {
            "random bytes": self.noise, "mutated": self.mutated, "traversal": self.traversal, "headers": self.headers,
            "huge headers": self.huge_headers, "announced gigabytes": self.gigabytes, "chunked": self.chunked,
            "truncated": self.truncated, "replayed": self.replayed, "another robot's": self.misdirected,
            "too large": self.oversized, "zip bomb of a stranger": self.bomb, "malformed": self.malformed,
            "stranger": self.stranger, "cut off": self.cut_off, "pipelined": self.pipelined,
        }
        self.weights = {"malformed": 0.4, "announced gigabytes": 0.4, "too large": 0.4}

    def requests(self, count: int) -> Iterator[Tuple[str, Hostile]]:
        names = list(self.kinds)
        weights = [self.weights.get(name, 1.0) for name in names]
        for name in self.random.choices(names, weights, k=count):
            yield name, self.kinds[name]()

    def bytes(self, most: int) -> bytes:
        return self.random.getrandbits(8 * most).to_bytes(most, "little")[: self.random.randint(0, most)]

    def order(self, desk: Desk, body: bytes = b"", **more: Any) -> str:
        more.setdefault("mission", self.digest)
        return desk.order(self.robot.reader.ticket, body=body, **more)

    def noise(self) -> Hostile:
        return Hostile(self.bytes(600) + self.random.choice([b"", b"\r\n\r\n", b"\n\n", b"\x00" * 50]), (0, 400))

    def mutated(self) -> Hostile:
        data = bytearray(self.random.choice(self.heard))
        for _ in range(self.random.randint(1, 8)):
            place, act = self.random.randrange(len(data)), self.random.randrange(3)
            if act == 0:
                data[place] = self.random.randrange(256)
            elif act == 1:
                del data[place:place + self.random.randint(1, 20)]
            else:
                data[place:place] = self.bytes(20)
            if not data:
                break
        return Hostile(bytes(data), (0, 200, 400, 401, 403, 404, 405, 409, 411, 413, 422))

    def traversal(self) -> Hostile:
        up = self.random.choice(["../", "..%2f", "%2e%2e/", "....//", "..\\", "/", "%00/", "..;/"])
        target = self.random.choice(["etc/passwd", "health", "keys/desk.pub", ".ros/log", "mission"])
        path = "/" + self.random.choice(["", "mission/", "health/"]) + up * self.random.randint(1, 12) + target
        return Hostile(head(path, self.random.choice(["GET", "POST", "PUT"]), Content_Length=0), (400, 404))

    def headers(self) -> Hostile:
        right = self.order(self.desk)
        choice = self.random.choice([
            {"Pursue_Order": right + "," + right}, {"Pursue_Order": right.replace(".", "..", 1)},
            {"Pursue_Order": right[::-1]}, {"Pursue_Order": "\x00" + right}, {"Pursue_Order": right.upper()},
            {"Pursue_Order": "A" * self.random.randint(4000, 5000)}, {"Content_Length": "-1"},
            {"Content_Length": "0x10"}, {"Content_Length": "5, 6"}, {"Content_Length": "1" * 400},
            {"Content_Length": " ٣".encode().decode("latin1")}, {"Host": "evil\x00.example"},
            {"Transfer_Encoding": "gzip, chunked", "Content_Length": 5, "Pursue_Order": right},
            {"Pursue_Order": right.split(".")[0]}, {"Expect": "200-ok", "Content_Length": 10},
            {"X": "\r\n continued", "Pursue_Order": "x"},
        ])
        return Hostile(head(**choice), (0, 400, 401, 411))

    def huge_headers(self) -> Hostile:
        lines = "".join(f"X-{number}: {'y' * 100}\r\n" for number in range(self.random.randint(160, 600)))
        return Hostile(b"GET /health HTTP/1.1\r\n" + lines.encode() + b"\r\n", (0,))

    def gigabytes(self) -> Hostile:
        size = self.random.choice([2**30, 2**40, 10**14])
        order = self.order(self.random.choice([self.desk, STRANGER]), size=size, bundle="a" * 64)
        request = head(Content_Length=size, Pursue_Order=order, Expect="100-continue") + self.bytes(5000)
        return Hostile(request, (0, 401, 413))

    def chunked(self) -> Hostile:
        body = self.random.choice([b"ffffffffffffffff\r\n", b"zz\r\n", b"5\r\nabcde\r\n0\r\n\r\n", b"-1\r\n"])
        return Hostile(head(Transfer_Encoding="chunked", Pursue_Order=self.order(self.desk)) + body, (0, 411))

    def truncated(self) -> Hostile:
        """Rightly signed, and then the connection breaks."""
        content = good_mission(self.desk, f"never{self.random.randrange(10**9)}").content
        request = head(Content_Length=len(content), Pursue_Order=self.order(self.desk, content))
        return Hostile(request + content[: self.random.randrange(len(content))], (), reads=False)

    def replayed(self) -> Hostile:
        return Hostile(self.random.choice(self.heard[1:]), (0, 409))

    def misdirected(self) -> Hostile:
        name = self.random.choice(["bot2", "", "bot1 ", "BOT1", "../bot1", "bot1\x00"])
        action = self.random.choice(mission_bundle.ACTIONS)
        return Hostile(head(Content_Length=0, Pursue_Order=self.order(self.desk, action=action, robot=name)), (403,))

    def oversized(self) -> Hostile:
        size = (1 << 20) + self.random.randint(1, 1000)
        order = self.order(self.desk, size=size, bundle="a" * 64)
        return Hostile(head(Content_Length=size, Pursue_Order=order, Expect="100-continue"), (413,))

    def bomb(self) -> Hostile:
        body = zipped({"manifest.json": b"0" * (1 << 20)}, zipfile.ZIP_DEFLATED)
        order = self.order(STRANGER, body)
        return Hostile(head(Content_Length=len(body), Pursue_Order=order) + body, (401,))

    def malformed(self) -> Hostile:
        """Signed by one who is trusted, and not a mission all the same."""
        text = make_manifest("evil", "0", (), {"a/b.yaml": b"format: 1\n"}).text()
        body = self.random.choice([
            self.bytes(2000) + b"x", zipped({"manifest.json": b"0" * (1 << 20)}, zipfile.ZIP_DEFLATED),
            zipped({"manifest.json": text, "signature.json": b"[" * 5000}), zipped({"../../evil.yaml": b"x"}),
            zipped({"manifest.json": text, "signature.json": b"{}", "a/b.yaml": b"y"}),
            STRANGER.bundle("evil").content, self.desk.bundle("evil", {"../evil.yaml": b"x"}).content,
            self.desk.bundle("evil", {"a/b.yaml": b"format: 1\n", "/etc/evil.yaml": b"x"}).content,
            self.desk.bundle("evil", {"controller_bot1/strategy.yaml": b"format: 1\n"}).content,
            good_mission(self.desk, "another").content + b"\x00", good_mission(self.desk, "another").content,
        ])
        return Hostile(head(Content_Length=len(body), Pursue_Order=self.order(self.desk, body)) + body, (401, 413, 422))

    def stranger(self) -> Hostile:
        action = self.random.choice(mission_bundle.ACTIONS)
        return Hostile(head(Content_Length=0, Pursue_Order=self.order(STRANGER, action=action)), (401,))

    def cut_off(self) -> Hostile:
        data = self.random.choice(self.heard)
        return Hostile(data[: self.random.randrange(len(data))], (), reads=False)

    def pipelined(self) -> Hostile:
        more = self.random.choice([self.bytes(200), head(Transfer_Encoding="chunked") + b"-1\r\n"])
        return Hostile(head("/health", "GET") * 20 + more, (200,))


def zipped(files: Dict[str, bytes], kind: int = zipfile.ZIP_STORED) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", kind) as archive:
        for name, content in files.items():
            archive.writestr(zipfile.ZipInfo(name), content, kind)
    return out.getvalue()


def attack(port: int, hostile: Hostile) -> int:
    """Sends it; the status of the answer, 0 for none. Connections end in all ways that there are."""
    with connected(port) as there:
        with may_close():
            there.sendall(hostile.data)
            if hostile.reads and 0 in hostile.expected:  # it may be waited for what does not come
                there.shutdown(socket.SHUT_WR)
        if not hostile.reads:
            if len(hostile.data) % 2:  # a reset instead of an end
                there.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            return 0
        answer = rest(there)
    assert b"Traceback" not in answer and b"/usr/" not in answer and b"ornado" not in answer
    return int(answer.split()[1]) if answer.startswith(b"HTTP/1.1 ") else 0


class Drips:
    """Connections that stay: nothing said, a head that drips, a right order whose body drips."""

    def __init__(self, robot: Robot, desk: Desk) -> None:
        self.robot, self.desk = robot, desk
        self.over = threading.Event()
        self.opened = 0
        self.problem: Optional[BaseException] = None
        self.thread = threading.Thread(target=self.run)
        self.thread.start()

    def run(self) -> None:
        held: List[socket.socket] = []
        try:
            while not self.over.wait(0.05):
                self.turn(held)
        except BaseException as problem:  # for the thread of the test
            self.problem = problem
        finally:
            for there in held:
                there.close()

    def turn(self, held: List[socket.socket]) -> None:
        self.opened += 1
        order = self.desk.order(self.robot.reader.ticket, size=10**6, bundle="a" * 64, robot=ROBOT)
        start = [b"", b"GET /health HTTP/1.1\r\n", head(Content_Length=10**6, Pursue_Order=order)][self.opened % 3]
        if self.opened % 3 == 2 and self.opened % 30 != 2:
            start = b"POST"  # an upload under way keeps others out: not all the time
        held.append(connected(self.robot.port))
        for there in held[-20:]:
            try:
                there.sendall(start if there is held[-1] else b"X")
            except OSError:
                there.close()
        if len(held) > 20:
            held.pop(0).close()

    def end(self) -> int:
        self.over.set()
        self.thread.join()
        assert self.problem is None, repr(self.problem)
        return self.opened


def obeyed(robot: Robot, desk: Desk, action: str, mission: Sent) -> bytes:
    """Has an order carried out, asking again as desks do; the request that was answered."""
    body = mission.content if action == "prepare" else b""

    def asked() -> bytes:
        order = desk.order(robot.reader.ticket, action, mission.digest, body)
        told = send(robot, order, body)
        assert told.http in (200, *LATER), told
        return head(Content_Length=len(body), Pursue_Order=order) + body if told.http == 200 else b""

    request: bytes = until(asked, action)
    return request


def resident() -> int:
    """Bytes of memory of this process."""
    gc.collect()
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGESIZE")


def tree(folder: Path) -> List[str]:
    return sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*"))


def descriptors() -> Set[Tuple[str, str]]:
    """Whatever is open: its number, and what it is. Mere counts would fall where other tests' garbage is closed."""
    found = set()
    for number in os.listdir("/proc/self/fd"):
        with contextlib.suppress(OSError):
            found.add((number, os.readlink(f"/proc/self/fd/{number}")))
    return found


def gone(left: Callable[[], Set[Any]]) -> None:
    """What is left goes, for connections and threads end in their own time."""
    deadline = time.monotonic() + PATIENCE
    while left() and time.monotonic() < deadline:
        time.sleep(0.05)
    assert left() == set()


@pytest.mark.slow
@pytest.mark.skipif(not os.path.isdir("/proc/self/fd"), reason="needs /proc")
def test_thousands_of_hostile_requests_leave_nothing_and_a_serving_robot(tmp_path: Path) -> None:
    desk = Desk()
    desk.trusted_by(tmp_path / "keys")
    open_before, threads_before, begun = descriptors(), set(threading.enumerate()), time.monotonic()
    robot = Robot(tmp_path, RealReader, limit=1 << 20, header=1.0, window=0.5)
    try:
        first = good_mission(desk, "first")
        heard = [head("/health", "GET"), *(obeyed(robot, desk, action, first) for action in ("prepare", "commit"))]
        place, kept, serving = robot.reader.folder, tree(robot.reader.folder), descriptors()
        state, outside = (place / "state.json").read_bytes(), tree(tmp_path)

        drips, counts, memory, unheard = Drips(robot, desk), {}, 0, 0  # type: ignore[var-annotated]
        try:
            for number, (kind, hostile) in enumerate(Attacker(1, robot, desk, heard, first.digest).requests(REQUESTS)):
                if number == WARM:
                    memory = resident()
                status = attack(robot.port, hostile)
                counts.setdefault(kind, {}).setdefault(status, 0)
                counts[kind][status] += 1
                # 503: a drip keeps the only upload, or the reader's answer to one that was broken off is awaited;
                # 408: a machine that stands still for half a second is too slow with a body
                expected = (*hostile.expected, 503, 408, 0)
                assert not hostile.reads or status in expected, (kind, status, hostile.data[:500])
                unheard += hostile.reads and status == 0 and 0 not in hostile.expected
                if number % 100 == 0:
                    assert tree(place) == kept, kind
        finally:
            opened = drips.end()
        growth = resident() - memory
        assert unheard <= UNHEARD, (unheard, counts)

        assert (tree(place), tree(tmp_path)) == (kept, outside)
        current = json.loads(state)["current"]
        assert json.loads((place / "state.json").read_bytes())["current"] == current == first.digest
        gone(lambda: descriptors() - serving)
        assert growth < GROWTH, growth
        until(lambda: ask(robot).http == 200, "it says how the robot is")
        second = good_mission(desk, "second")
        for action in ("prepare", "commit"):
            obeyed(robot, desk, action, second)
        assert json.loads((place / "state.json").read_bytes())["current"] == second.digest
        assert "errors" not in robot.record.counts, robot.lines
        assert len(robot.lines) <= 2 + (time.monotonic() - begun) / 10, "strangers do not fill the log"
        print(f"\n{REQUESTS} requests and {opened} drips: {growth / 2**20:.1f} MiB more, log lines {len(robot.lines)}")
        print("\n".join(f"{kind}: {counts[kind]}" for kind in sorted(counts)))
        print(robot.record.counts)
    finally:
        robot.close()
        robot.reader.store.close()
    gone(lambda: (descriptors() - open_before) | (set(threading.enumerate()) - threads_before))
