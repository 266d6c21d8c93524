"""How pursue_reader checks and executes the orders of the desk. Times are seconds of a monotonic clock.

An order counts once: it holds the ticket that is out, and uses it up. A mission is never exchanged while one runs.
"""

from __future__ import annotations

import base64
import binascii
import hashlib
import os
from typing import Any, Callable, Dict, FrozenSet, Iterable, Mapping, NamedTuple, Optional, Tuple

from pursue_runtime.bounded import DATA, BadText, read_json
from pursue_runtime.bundle import (
    ABORT,
    COMMIT,
    LIMIT,
    ORDER_LENGTH,
    PREPARE,
    KeyFolder,
    Keys,
    Order,
    Refused,
    new_ticket,
    read_order,
    unpack,
)
from pursue_runtime.data import DataError, read_data
from pursue_runtime.manifest import OWN, mission_id
from pursue_runtime.model import Model
from pursue_runtime.poses import POSES, read_poses
from pursue_runtime.rate_limited_log import RateLimitedLog
from pursue_runtime.reader.contents import StoreError, StoreState, is_signed, manifest
from pursue_runtime.reader.store import Store
from pursue_runtime.sentences import Log
from pursue_runtime.state import LATE, LIVE, SystemState, older
from pursue_runtime.strategy import Strategy, read_cover, read_strategies

PATIENCE = 5.0
"""Seconds without a state, at the start or after one of no running mission, after which no mission runs."""

FRESH = 1.5
"""Seconds for which it counts that no mission runs: an observer publishes it once a second, and one that was restarted,
and is not connected to us yet, takes longer to begin."""

KEYS_PERIOD = 2.0
"""Seconds after which `on_time` looks at the trusted keys again."""

RETRY_PERIOD = 10.0
"""Seconds until an exchange of missions that the disk did not take is tried again."""

UNTRUSTED = "was signed with a key that is not trusted any more"

CONTROLLER_FILES = ("strategy.yaml", POSES)
FILES: Mapping[str, Tuple[str, ...]] = {
    "observer": ("model.yaml", "cover.yaml", "controllers.yaml", "game.yaml"),
    "UI": ("model.yaml", POSES, "ui.yaml", "game.yaml"),
}
"""What each package's nodes read; all others are controllers."""


class OrderResult(NamedTuple):
    """What has become of an order: a word for programs, a sentence for people; `ticket` is the one that it used up."""

    ticket: str
    ok: bool
    code: str
    message: str


class Machine(NamedTuple):
    """Where this is: the robot's name, the scenario of its workspace, the packages with data of a mission that this
    machine has, and the bytes of the largest bundle that it takes."""

    name: str
    scenario: str
    packages: Tuple[str, ...]
    limit: int = LIMIT


class Reader:
    """Takes orders and states one by one, keeps the store, and reports its status."""

    def __init__(
        self, robot: Machine, store: Store, keys: KeyFolder, now: float, log: Log, patience: float = PATIENCE
    ) -> None:
        self.robot = robot
        self.ticket = new_ticket()
        self.answer: Optional[OrderResult] = None
        self.refusals = RateLimitedLog(lambda text: log("warn", text))
        self.counts = dict.fromkeys((PREPARE, COMMIT, ABORT, "exchanged"), 0)
        self._store = store
        self._keys = keys
        self._checked: Optional[Keys] = None  # the keys with which `_untrusted` was found
        self._untrusted: FrozenSet[str] = frozenset()
        self._log = log
        self._patience = patience
        self._known: Optional[SystemState] = None
        self._received = now
        self._failures = RateLimitedLog(lambda text: log("err", text))

    # Inputs ----------------------------------------------------------------------------------------------------------

    def on_message(self, text: str, now: float) -> OrderResult:
        """A message on local_mission. Whatever it is, it is answered; only orders that count change anything."""
        try:
            order, bundle = self._read(text)
        except Refused as refused:
            return self._refuse("", refused, now)
        self.ticket = new_ticket()
        try:
            self._check_signatures()
            self.answer = self._execute(order, bundle, now)
        except Refused as refused:
            self.answer = self._refuse(order.ticket, refused, now)
        except StoreError as problem:
            self.answer = self._refuse(order.ticket, Refused("failed", str(problem)), now)
        else:
            self._log("info", self.answer.message)
        return self.answer

    def on_state(self, state: SystemState, now: float) -> bool:
        """A state of the mission. True where it matters: a mission has begun or ended, or was exchanged."""
        known, before = self._known, self.mission_runs
        late = known is not None and now < self._received + LATE and older(state, known)
        if not late or state.status in LIVE:
            self._known, self._received = state, now
        return self.on_time(now) or self.mission_runs != before

    def on_time(self, now: float) -> bool:
        """Exchanges missions if that is wanted, and can be. True if it was done, or missions were dropped."""
        try:
            dropped = self._check_signatures()
        except StoreError as problem:
            self._failures.count("failed", str(problem), now)
            dropped = False
        return self._exchange_next(now) or dropped

    def _exchange_next(self, now: float) -> bool:
        state = self._store.state
        if state.next is None or not self._can_exchange(now):
            return False
        try:
            self._exchange(state, state.next)
        except (Refused, StoreError) as problem:
            self._failures.count("failed", str(problem), now)
            return isinstance(problem, Refused)
        return True

    def next_check(self, now: float) -> Optional[float]:
        """Return in how many seconds to call `on_time` if no input comes; None: no need."""
        if self._store.state.next is None or self.mission_runs:
            return None
        sure = self._received + self._patience
        return sure - now if now < sure else RETRY_PERIOD

    # Status -----------------------------------------------------------------------------------------------------------

    @property
    def mission_runs(self) -> bool:
        """Return True while the newest state is one of a mission that runs or holds."""
        return self._known is not None and self._known.status in LIVE

    def keys(self) -> Keys:
        """Return the trusted keys."""
        return self._keys.keys()

    def problem(self) -> str:
        """What keeps it from taking orders: a sentence, "" for nothing."""
        found = [] if self.keys() else [
            f"no key is trusted, every order is refused: put the desk's public key into {self._keys.folder}"
        ]
        if self._store.state.current in self._untrusted:
            name = mission_id(self._store.state.current)
            found.append(f"mission {name} {UNTRUSTED}: it is replaced when no mission runs")
        return "; ".join([*found, *self._keys.problems])

    def status(self) -> Dict[str, Any]:
        """Return the status for mission_status."""
        state = self._store.state
        return {
            "format": 1,
            "robot": self.robot.name,
            "ticket": self.ticket,
            "current": state.current,
            "next": state.next,
            "prepared": state.prepared,
            "kept": self._store.kept(),
            "history": list(state.history),
            "scenario": self._store.scenario(state.current) if state.current else self.robot.scenario,
            "packages": list(self.robot.packages),
            "mission_runs": self.mission_runs,
            "limit": self.robot.limit,
            "answer": self.answer._asdict() if self.answer else None,
        }

    # Orders -----------------------------------------------------------------------------------------------------------

    def _refuse(self, ticket: str, refused: Refused, now: float) -> OrderResult:
        answer = OrderResult(ticket, False, refused.code, str(refused))
        self.refusals.count(refused.code, f"refused ({refused.code}): {refused}", now)
        return answer

    def _read(self, text: str) -> Tuple[Order, object]:
        """The order in a message, if it counts, and the bundle as it came. Raises Refused."""
        keys = self.keys()
        if not keys:
            raise Refused("no_keys", self.problem())
        if len(text) > 4 * (self.robot.limit // 3 + 1) + ORDER_LENGTH + 100:
            raise Refused("too_large", f"the message has {len(text)} characters")
        if text.count("{") > 1 or text.count(",") > 1 or "[" in text:  # nothing that would grow when it is read
            raise Refused("bad_order", "not a message for this robot")
        try:
            message = read_json(text, DATA._replace(size=len(text)))
        except BadText as problem:
            raise Refused("bad_order", "not a message for this robot") from problem
        if not (isinstance(message, dict) and isinstance(message.get("order"), str)):
            raise Refused("bad_order", "there is no order in the message")
        order = read_order(message["order"], keys)
        if order.robot != self.robot.name:
            raise Refused("wrong_robot", f"the order is for {order.robot[:100]!r}, and this is {self.robot.name!r}")
        if order.ticket != self.ticket:
            raise Refused("old_ticket", "the ticket is not the one that is out; the status has that")
        return order, message.get("bundle")

    def _execute(self, order: Order, bundle: object, now: float) -> OrderResult:
        content = self._content(order, bundle)
        act = {PREPARE: self._prepare, COMMIT: self._commit, ABORT: self._abort}[order.action]
        code, message = act(order.mission, content, now)
        self.counts[order.action] += 1
        return OrderResult(order.ticket, True, code, message)

    def _content(self, order: Order, bundle: object) -> bytes:
        """The bundle that travels with the order, empty for none. Raises Refused."""
        if not order.size:
            if bundle:
                raise Refused("bad_bundle", "the order says nothing of the bundle that came with it")
            return b""
        if order.action != PREPARE:
            raise Refused("bad_order", "a bundle comes with prepare only")
        if order.size > self.robot.limit:
            raise Refused("too_large", f"the bundle has {order.size} bytes; at most {self.robot.limit} are taken")
        content = b""
        if isinstance(bundle, str) and len(bundle) == 4 * ((order.size + 2) // 3):
            try:
                content = base64.b64decode(bundle.encode("ascii"), validate=True)
            except (ValueError, binascii.Error):
                content = b""
        if len(content) != order.size or hashlib.sha256(content).hexdigest() != order.bundle:
            raise Refused("bad_bundle", "what came is not the bundle that the order is about")
        return content

    def _prepare(self, mission: str, content: bytes, now: float) -> Tuple[str, str]:
        name = mission_id(mission)
        if content:
            bundle = unpack(content, self.keys(), self.robot.limit)
            if bundle.digest != mission:
                raise Refused("bad_bundle", "the bundle holds another mission than the order says")
            self._store.put(bundle, content, lambda folder: self._check(folder, bundle.manifest.files))
            self._untrusted -= {bundle.digest}
        elif mission != OWN:
            self._refuse_untrusted(mission)
            if not self._store.is_intact(mission):
                raise Refused("unknown_mission", f"mission {name} is not here: send it with its bundle")
            folder = os.path.join(self._store.folder, mission)
            self._check(folder, manifest(self._store.folder, mission)["files"])
        self._store.save(self._store.state._replace(prepared=mission))
        return "prepared", f"mission {name} is prepared"

    def _commit(self, mission: str, content: bytes, now: float) -> Tuple[str, str]:
        state, name = self._store.state, mission_id(mission)
        self._refuse_untrusted(mission)
        if mission not in (state.current, state.next, state.prepared):
            raise Refused("not_prepared", f"mission {name} is not prepared")
        prepared = None if state.prepared == mission else state.prepared
        if state.next not in (None, mission):
            prepared = state.next  # the desk may take it all back: then that one waits again
        if mission == state.current:
            self._store.save(state._replace(next=None, prepared=prepared))
            return "committed", f"mission {name} counts, as before"
        if self._can_exchange(now):
            self._exchange(state._replace(prepared=prepared), mission)
            return "committed", f"mission {name} counts from now on"
        self._store.save(state._replace(next=mission, prepared=prepared))
        return "waiting", f"mission {name} counts as soon as no mission runs"

    def _abort(self, mission: str, content: bytes, now: float) -> Tuple[str, str]:
        """Forgets that this mission was prepared, or committed and waits; others stay as they are."""
        state = self._store.state
        prepared = None if state.prepared == mission else state.prepared
        following = None if state.next == mission else state.next
        self._store.save(state._replace(prepared=prepared, next=following))
        return "aborted", f"mission {mission_id(mission)} is neither prepared nor next"

    # Missions ---------------------------------------------------------------------------------------------------------

    def _can_exchange(self, now: float) -> bool:
        """Return True if no mission can be running: the observer has just published that, or there is none."""
        fresh = self._known is not None and now <= self._received + FRESH
        return not self.mission_runs and (fresh or now >= self._received + self._patience)

    def _exchange(self, state: StoreState, mission: str) -> None:
        """Makes this mission the current one. Raises Refused where it is damaged: then nothing is next."""
        if mission != OWN and not self._store.is_intact(mission):
            self._store.save(self._store.state._replace(next=None))
            raise Refused("unknown_mission", f"mission {mission_id(mission)} is damaged: send it again with its bundle")
        before = (*state.history, state.current)
        history = [name for name in before if name != mission and name not in self._untrusted]
        history = [name for number, name in enumerate(history) if name not in history[number + 1:]]
        self._store.save(state._replace(current=mission, next=None, history=tuple(history)))
        self.counts["exchanged"] += 1
        self._log("info", f"mission {mission_id(mission)} takes the place of {mission_id(state.current)}")

    def _check_signatures(self) -> bool:
        """Drops the missions that no trusted key has signed; the current one is replaced as soon as none runs.

        True if anything has changed. Raises StoreError.
        """
        keys = self.keys()
        if keys is not self._checked and self._keys.complete():
            kept = self._store.kept()
            self._untrusted = frozenset(name for name in kept if not is_signed(self._store.folder, name, keys))
            self._checked = keys
            for name in sorted(self._untrusted):
                self._log("warn", f"mission {mission_id(name)} {UNTRUSTED}: it is not played")
        state = self._store.state
        if not self._untrusted.intersection(state.named()):
            return False
        history = tuple(name for name in state.history if name not in self._untrusted)
        following = None if state.next in self._untrusted else state.next
        if state.current in self._untrusted and following is None:
            following = history[-1] if history else OWN
        prepared = None if state.prepared in self._untrusted else state.prepared
        self._store.save(state._replace(next=following, prepared=prepared, history=history))
        return self._store.state != state

    def _refuse_untrusted(self, mission: str) -> None:
        if mission in self._untrusted:
            raise Refused("unknown_key", f"mission {mission_id(mission)} {UNTRUSTED}: send it again with its bundle")

    def _check(self, folder: str, files: Iterable[str]) -> None:
        """Raises Refused where the nodes of this machine could not read their part of a mission."""
        packages = {path.split("/")[0] for path in files}
        for package in packages & set(self.robot.packages):
            names = {path.split("/")[1] for path in files if path.split("/")[0] == package}
            for name in sorted({*FILES.get(package, CONTROLLER_FILES), *names}):
                try:
                    check_data(os.path.join(folder, package, name))
                except Exception as problem:  # whatever a reader makes of such data
                    text = str(problem).replace(folder + os.sep, "")
                    raise Refused("bad_bundle", f"{package}/{name} cannot be used: {text}") from problem


def check_data(path: str) -> None:
    """Reads a data file as the nodes do. Raises DataError, or whatever is raised then."""
    data, name = read_data(path), os.path.basename(path)
    readers: Dict[str, Callable[[Mapping[str, Any]], object]] = {
        "strategy.yaml": Strategy,
        "people.yaml": Strategy,
        "strategies.yaml": read_strategies,
        "cover.yaml": read_cover,
        "model.yaml": Model,
        POSES: read_poses,
        "controllers.yaml": _check_controllers,
    }
    if name in readers:
        readers[name](data)


def _check_controllers(data: Mapping[str, Any]) -> None:
    if not all(isinstance(name, str) for name in data["controllers"]):
        raise DataError("controllers are not a list of names")
