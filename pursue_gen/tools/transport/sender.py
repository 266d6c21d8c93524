"""Missions to several robots at once (thesis: MissionSender): all of them change, or none.

First the status of every robot is queried; then all are ordered to prepare the mission, in parallel; only when all
have it are they ordered to commit, the observer's machine last, since the observer decides which mission is played.
Where one fails before that, the others drop what they prepared; where one fails while committing, the others go back.
"""

from __future__ import annotations

import contextlib
import hashlib
import signal
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from types import FrameType
from typing import Callable, Dict, Iterator, List, Optional, Sequence, Tuple

from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

from pursue_gen.tools.transport.client import Listener, Robot, Status, Unreached, health, send_order
from pursue_runtime.bundle import ABORT, COMMIT, PREPARE, Order, write_order

PAUSES = (0.3, 0.7, 1.5)
"""Seconds between one try and the next; one try more than these."""

OBSERVER = "observer"
"""The package whose machine commits last."""

Progress = Callable[[Robot, int, int], None]
"""Called with the robot, how many bytes it has got, and of how many."""
Check = Callable[[Sequence[Status]], None]
"""Looks at all robots before anything is sent; raises what is in the way."""

_AGAIN = (408, 409, 503, 504)
"""HTTP's statuses after which another try may do: too slow, another ticket is out, busy, the reader did not answer."""
_UNDECIDED = 504
"""The one after which the order may still be carried out."""


_OTHER_DESK = "another desk has sent it another mission meanwhile"


class Trouble(Exception):
    """A robot cannot be brought to something; the text says why."""


@dataclass(frozen=True)
class Row:
    """How one robot stands at the end. `before` and `after` are None where they are not known.

    `outcome` is a sentence; `same` whether it stands where it stood before.
    """

    robot: Robot
    before: Optional[Status]
    after: Optional[Status]
    outcome: str
    same: bool


@dataclass(frozen=True)
class Sent:
    """What came of it: `done` where all robots have the mission; else `unchanged`, or they differ, or it is not known.

    `trouble` says in a sentence why it was not done.
    """

    mission: str
    done: bool
    rows: Tuple[Row, ...]
    trouble: str = ""

    @property
    def unchanged(self) -> bool:
        """Every robot stands where it stood."""
        return all(row.same for row in self.rows)


def look(robots: Sequence[Robot], pauses: Sequence[float] = PAUSES) -> Tuple[Row, ...]:
    """The robots' statuses; nothing is changed."""
    sessions = [_Session(robot, None, pauses) for robot in robots]
    troubles = _side_by_side(_Session.look, sessions)
    return tuple(_row(session, troubles.get(session, "")) for session in sessions)


def send(
    robots: Sequence[Robot],
    mission: str,
    content: bytes,
    key: Ed25519PrivateKey,
    check: Check,
    progress: Optional[Progress] = None,
    pauses: Sequence[float] = PAUSES,
    report: Callable[[str], None] = lambda text: None,
) -> Sent:
    """Brings all robots to a mission, or none.

    `content` is the mission's bundle, empty where the robots are known to have it. `check` gets the robots' statuses
    in the same order before anything is sent. `report` is called with a sentence before what was sent is taken back,
    which may take a minute where robots do not answer.
    """
    sessions = [_Session(robot, key, pauses, progress) for robot in robots]
    troubles = _side_by_side(_Session.look, sessions)
    if troubles:
        return _result(mission, sessions, troubles)
    check([session.now for session in sessions])
    try:
        with _ctrl_c_noticed() as check_ctrl_c:
            # Those that have it already, too: what they have may be damaged by now.
            troubles = _side_by_side(lambda session: session.prepare(mission, content), sessions)
            check_ctrl_c()
        if not troubles:
            troubles = _commit(sessions, mission)
    except KeyboardInterrupt:
        troubles = {session: "interrupted" for session in sessions}
        report("Interrupted: what was sent is taken back. Ctrl-C once more leaves the robots as they are.")
    with contextlib.suppress(KeyboardInterrupt):  # a second Ctrl-C ends the wait; the table is still printed
        if troubles:
            _take_back(sessions, mission)
        else:
            troubles = _side_by_side(lambda session: session.confirm(mission), sessions)
    return _result(mission, sessions, troubles)


@contextlib.contextmanager
def _ctrl_c_noticed() -> Iterator[Callable[[], None]]:
    """Gives what raises KeyboardInterrupt if Ctrl-C was pressed since: Python may notice that while it tidies up, as a
    pool of threads does at its end, and ignores exceptions there."""
    pressed: List[int] = []
    before = signal.getsignal(signal.SIGINT)

    def notice(number: int, frame: Optional[FrameType]) -> None:
        pressed.append(number)
        assert callable(before)
        before(number, frame)

    def check() -> None:
        if pressed:
            raise KeyboardInterrupt

    if not callable(before) or threading.current_thread() is not threading.main_thread():  # it is nobody's
        yield check
        return
    signal.signal(signal.SIGINT, notice)
    try:
        yield check
    finally:
        signal.signal(signal.SIGINT, before)


def wait(robots: Sequence[Robot], mission: str, seconds: float, every: float = 0.5) -> Tuple[Row, ...]:
    """Looks until all robots play the mission (none waits for the end of another), or for so many seconds."""
    end = time.monotonic() + seconds
    while True:
        rows = look(robots, ())
        there = all(row.after and row.after.current == mission and row.after.next is None for row in rows)
        if there or time.monotonic() >= end:
            return rows
        time.sleep(max(0.0, min(every, end - time.monotonic())))


# The two phases -------------------------------------------------------------------------------------------------------


def _commit(sessions: Sequence[_Session], mission: str) -> Dict[_Session, str]:
    """One after the other, observers last; stops at the first that fails, and says why."""
    for session in sorted(sessions, key=lambda session: OBSERVER in session.now.packages):
        try:
            session.bring(COMMIT, mission, lambda status: status.standing == mission != status.prepared)
        except Trouble as trouble:
            return {session: str(trouble)}
    return {}


def _take_back(sessions: Sequence[_Session], mission: str) -> None:
    """All to where they stood, observers first: while one of these may play the mission, the others have to keep it."""
    first = [session for session in sessions if OBSERVER in session.now.packages and not session.same]
    _side_by_side(lambda session: session.restore(mission), first)
    if all(session.same for session in first):
        _side_by_side(lambda session: session.restore(mission), [one for one in sessions if one not in first])


def _side_by_side(act: Callable[[_Session], None], sessions: Sequence[_Session]) -> Dict[_Session, str]:
    """Does something with all robots at once; what is in the way, by robot."""

    def trouble(session: _Session) -> str:
        try:
            act(session)
        except Trouble as problem:
            return str(problem)
        return ""

    if not sessions:
        return {}
    with ThreadPoolExecutor(max_workers=min(32, len(sessions))) as pool:
        found = list(pool.map(trouble, sessions))
    return {session: text for session, text in zip(sessions, found) if text}


class _Session:
    """The exchange with one robot, and what is known of it."""

    def __init__(
        self,
        robot: Robot,
        key: Optional[Ed25519PrivateKey],
        pauses: Sequence[float],
        progress: Optional[Progress] = None,
    ) -> None:
        self.robot = robot
        self.before: Optional[Status] = None
        self.last: Optional[Status] = None  # its last status
        self.back = ""  # why it could not be brought back
        self._stale = True  # something was sent since then
        self._open: Optional[Tuple[str, str]] = None  # an order without an answer: its action and ticket
        self._whole = False  # the bundle is sent, whatever its status lists
        self._key, self._pauses, self._progress = key, pauses, progress

    @property
    def now(self) -> Status:
        """Its last status."""
        assert self.last is not None
        return self.last

    @property
    def same(self) -> bool:
        """It is certain to stand where it stood: no order that could change that is without an answer."""
        if self.before is None or self.last is None:
            return True  # nothing has been sent
        return self.last.standing == self.before.standing and not self.unknown

    @property
    def unknown(self) -> bool:
        """It may have changed: an order to commit is without an answer."""
        return self._open is not None and self._open[0] == COMMIT

    def look(self) -> None:
        """Queries its status. Raises Trouble."""

        def step() -> bool:
            self._query()
            return True

        self._retry(step)
        self.before = self.last

    def prepare(self, mission: str, content: bytes) -> None:
        """Has the mission prepared there. Raises Trouble."""
        self.bring(PREPARE, mission, lambda status: status.prepared == mission, content)

    def confirm(self, mission: str) -> None:
        """Queries once more where all have it: another desk may have sent another mission meanwhile. Raises Trouble."""
        with contextlib.suppress(Unreached):
            self._query()
        if self.now.standing != mission:
            raise Trouble(_OTHER_DESK)

    def restore(self, mission: str) -> None:
        """Back to where it stood before. Raises Trouble; so where it is another desk that has changed it since."""
        assert self.before is not None
        old = self.before.standing

        def ours(status: Status) -> bool:
            if status.standing not in (old, mission):
                raise Trouble(_OTHER_DESK)
            return True

        try:
            if old == mission:
                self.bring(COMMIT, mission, lambda status: ours(status) and status.prepared != mission)
                return
            if self.now.standing != old:
                self.bring(PREPARE, old, lambda status: ours(status) and old in (status.prepared, status.standing))
                self.bring(COMMIT, old, lambda status: ours(status) and status.standing == old)
            # An order that is still on its way counts no more, once its ticket is used up by this one.
            self.bring(ABORT, mission, lambda status: mission not in (status.prepared, status.next))
            if self.now.standing != old:
                raise Trouble(_OTHER_DESK)
        except Trouble as trouble:
            self.back = str(trouble)
            raise

    def bring(self, action: str, mission: str, there: Callable[[Status], bool], content: bytes = b"") -> None:
        """Repeats an order until the status shows that it is carried out. Raises Trouble."""

        def step() -> bool:
            if self._stale:
                self._query()
            if self._open is None and there(self.now):
                return True
            self._order(action, mission, content)
            return self._open is None and not self._stale and there(self.now)

        self._retry(step)

    def _retry(self, step: Callable[[], bool]) -> None:
        """Tries until it is done, with pauses that grow."""
        why = ""
        for pause in (*self._pauses, None):
            try:
                if step():
                    return
                why = "it reports success, but its status has not changed"
            except Unreached as problem:
                why = str(problem)
            if pause is not None:
                time.sleep(pause)
        raise Trouble(why)

    def _query(self) -> None:
        self._update(health(self.robot))

    def _update(self, status: Status) -> None:
        if status.robot != self.robot.name:
            raise Trouble(f"there is a robot called {status.robot} at {self.robot.address}")
        self.last, self._stale = status, False
        if self._open is not None and self._open[1] != status.ticket:
            self._open = None

    def _order(self, action: str, mission: str, content: bytes) -> None:
        """Sends one order. Raises Unreached where another try may do, Trouble where not."""
        assert self._key is not None
        bundle = content if self._whole or not self.now.holds(mission) else b""
        digest = hashlib.sha256(bundle).hexdigest() if bundle else ""
        text = write_order(Order(action, mission, self.robot.name, self.now.ticket, len(bundle), digest), self._key)
        before, self._stale = self._open, True
        self._open = (COMMIT if COMMIT in (action, before and before[0]) else action, self.now.ticket)
        try:
            answer = send_order(self.robot, text, bundle, self._listener(len(bundle)))
        except Unreached as problem:
            if not problem.sent:
                self._open = before
            raise
        if answer.http != _UNDECIDED:
            self._open = before
        if answer.status is not None:
            self._update(answer.status)
        if not answer.ok:
            # What its status lists may be damaged: the next try sends the whole bundle.
            again, self._whole = bool(content) and not bundle, bool(content)
            message = answer.message or f"answers with status {answer.http}"
            raise (Unreached(message, True) if again or answer.http in _AGAIN else Trouble(message))

    def _listener(self, size: int) -> Optional[Listener]:
        progress = self._progress
        if progress is None or not size:
            return None
        return lambda sent: progress(self.robot, sent, size)


# The end --------------------------------------------------------------------------------------------------------------


def _result(mission: str, sessions: Sequence[_Session], troubles: Dict[_Session, str]) -> Sent:
    """The result for all robots."""
    outcome = _failed if troubles else _done
    rows = tuple(_row(session, outcome(mission, session, troubles.get(session, ""))) for session in sessions)
    trouble = "; ".join(f"{session.robot.name}: {text}" for session, text in troubles.items())
    return Sent(mission, not troubles, rows, trouble)


def _row(session: _Session, outcome: str) -> Row:
    return Row(session.robot, session.before, None if session.unknown else session.last, outcome, session.same)


def _done(mission: str, session: _Session, _: str) -> str:
    if session.now.current != mission:
        return "takes effect as soon as no mission is under way"
    return "had it already" if session.same else "changed"


def _failed(mission: str, session: _Session, trouble: str) -> str:
    """Where the robot stands after something went wrong, there or elsewhere."""
    if session.last is None:
        return f"not reached: {trouble}"
    if session.same:
        left = f"; still has it prepared: {session.back}" if session.back else ""
        return f"nothing changed{left or (trouble and f': {trouble}')}"
    why = session.back or trouble
    if session.unknown:
        return f"not known, it may have changed: {why}"
    if session.now.standing != mission:
        return f"has another mission than before: {why}"
    return f"changed, and cannot be taken back: {why}" if why else "changed, and left so: the observer may have it too"
