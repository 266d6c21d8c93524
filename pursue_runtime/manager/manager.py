"""The decisions of communication_manager: which orders are accepted, and the answers.

All that is known of the robot is the last status of its pursue_reader. That node checks everything once more.
"""

from __future__ import annotations

import base64
import hashlib
import json
import re
import time
from typing import Any, Callable, Dict, List, Mapping, NamedTuple, Optional, Tuple

from pursue_runtime.bounded import DATA, json_object
from pursue_runtime.bundle import LIMIT, ORDER_LENGTH, KeyFolder, Order, Refused, read_order
from pursue_runtime.rate_limited_log import RateLimitedLog

LOCAL_MISSION, MISSION_STATUS = "local_mission", "mission_status"
LONGEST_HEADER = 4 * ORDER_LENGTH  # bytes of all headers of a request
STATUS_LENGTH = 1 << 20  # characters of the longest status that is read

HTTP = {
    "bad_order": 400, "bad_request": 400, "bad_length": 400,
    "unknown_key": 401, "bad_signature": 401,
    "wrong_robot": 403,
    "not_found": 404,
    "bad_method": 405,
    "too_slow": 408,
    "old_ticket": 409,
    "no_length": 411,
    "too_large": 413,
    "bad_bundle": 422, "bad_version": 422,
    "no_reader": 503, "no_keys": 503, "busy": 503,
    "no_answer": 504,
    "internal": 500,
}
"""The HTTP status for each word that says why something is refused."""

REFUSED_BY_READER = 409
"""The HTTP status where the reader refuses with a word of its own."""


class HttpAnswer(NamedTuple):
    """The answer to a client: HTTP status, a code for programs, a sentence for people; `ok` if the order was done."""

    http: int
    code: str
    message: str
    ok: bool = False


class RequestRefused(Exception):
    """A request is refused, with this answer."""

    def __init__(self, code: str, message: str) -> None:
        super().__init__(message)
        self.answer = HttpAnswer(HTTP[code], code, message)


# What comes -----------------------------------------------------------------------------------------------------------


def parse_status(text: str) -> Optional[Dict[str, Any]]:
    """The reader's status from its topic; None for anything else that is published there."""
    status = json_object(text, DATA._replace(size=STATUS_LENGTH))
    if status is None or status.get("format") != 1:
        return None
    named = isinstance(status.get("robot"), str) and isinstance(status.get("ticket"), str)
    return status if named else None


def parse_length(text: Optional[str]) -> Optional[int]:
    """Return the length of a body from its header, None without one. Raises RequestRefused where it is no number."""
    if text is None:
        return None
    if not re.fullmatch(r"[0-9]{1,15}", text, re.ASCII):
        raise RequestRefused("bad_length", "Content-Length is not a number")
    return int(text)


def topic_names(text: str) -> List[str]:
    """The topics in a text with commas between, each once. Raises ValueError for what is not the name of a topic."""
    names = list(dict.fromkeys(name.strip() for name in text.split(",") if name.strip()))
    for name in names:
        if not re.fullmatch(r"[/~]?[A-Za-z][A-Za-z0-9_/]*", name, re.ASCII):
            raise ValueError(f"{name!r} is not the name of a topic")
    return names


# Decisions ------------------------------------------------------------------------------------------------------------


class Manager:
    """Checks requests against this robot's name, its trusted keys, and the last status of its reader.

    `reader` tells whether the reader is connected, `limit` is the largest bundle in bytes. With `exposed`, where other
    machines reach the server, every request is refused until a key is trusted.
    """

    def __init__(
        self, robot: str, keys: KeyFolder, reader: Callable[[], bool], limit: int = LIMIT, exposed: bool = False
    ) -> None:
        self.robot, self.limit, self.exposed = robot, limit, exposed
        self._folder, self._reader = keys, reader
        self._status: Optional[Dict[str, Any]] = None

    def on_status(self, text: str) -> None:
        """Take a status of the reader; one for another robot is ignored."""
        status = parse_status(text)
        if status is not None and status["robot"] == self.robot:
            self._status = status

    @property
    def trusts_any_key(self) -> bool:
        """Return True if any key is trusted."""
        return bool(self._folder.keys())

    def condition(self) -> Tuple[str, str]:
        """For /diagnostics: `ready`, or how bad it is (`warn`, `error`), and a sentence about it."""
        if not self.trusts_any_key:
            what_to_do = f"put the desk's public key into {self._folder.folder}"
            return ("error" if self.exposed else "warn"), f"no key is trusted, every order is refused: {what_to_do}"
        if not self.reader_connected:
            return "warn", "pursue_reader is silent"
        if self._folder.problems:
            return "warn", "takes missions; not a key: " + "; ".join(self._folder.problems)
        return "ready", "takes missions"

    @property
    def reader_connected(self) -> bool:
        """True when the reader is connected and has spoken."""
        return self._status is not None and self._reader()

    def status(self) -> Mapping[str, Any]:
        """The reader's last status; empty while it is silent."""
        return self._status if self._status is not None and self.reader_connected else {}

    def check_trust(self) -> None:
        """Raise RequestRefused while the server is exposed and no key is trusted."""
        if self.exposed and not self.trusts_any_key:
            raise RequestRefused("no_keys", "this robot trusts no key yet: everything is refused")

    def health(self) -> Tuple[int, Dict[str, Any]]:
        """HTTP status and answer of /health."""
        there = self.reader_connected
        return (200 if there else HTTP["no_reader"]), {**self.status(), "robot": self.robot, "reader": there}

    def check_order(self, text: Optional[str], length: Optional[int], chunked: bool) -> Order:
        """The order of a request whose body is still to come. Raises RequestRefused unless it is signed by a
        trusted key, for this robot, with the current ticket.

        `length` is the announced length of the body; nothing of the body is needed for this.
        """
        if not text:
            raise RequestRefused("bad_order", "the header Pursue-Order is missing")
        try:
            order = read_order(text, self._folder.keys())
        except Refused as refused:
            code = "bad_order" if refused.code == "bad_version" else refused.code
            raise RequestRefused(code if code in HTTP else "bad_order", str(refused)) from refused
        if order.robot != self.robot:
            raise RequestRefused("wrong_robot", f"the order is for {order.robot[:100]!r}, and this is {self.robot!r}")
        self.check_ticket(order)
        self._check_length(order, length, chunked)
        return order

    def check_ticket(self, order: Order) -> None:
        """Raises RequestRefused unless the reader would take the order now."""
        if not self.reader_connected:
            raise RequestRefused("no_reader", "pursue_reader is silent: nobody can carry the order out")
        if order.ticket != self.status().get("ticket"):
            raise RequestRefused("old_ticket", "the ticket is not the one that is out; the status has that")

    def _check_length(self, order: Order, length: Optional[int], chunked: bool) -> None:
        if chunked or (length is None and order.size):
            raise RequestRefused("no_length", "Content-Length is needed, and no chunks")
        reported = self.status().get("limit")
        limit = min(self.limit, reported) if type(reported) is int else self.limit
        if order.size > limit:
            raise RequestRefused("too_large", f"the bundle has {order.size} bytes; at most {limit} are taken")
        if (length or 0) != order.size:
            sizes = f"the order is about {order.size} bytes, and {length or 0} are announced"
            raise RequestRefused("bad_length", sizes)

    def answer_to(self, ticket: str) -> Optional[HttpAnswer]:
        """What the reader has made of the order with this ticket; None while it has not spoken since."""
        status = self._status or {}
        answer = status.get("answer")
        if isinstance(answer, dict) and answer.get("ticket") == ticket:
            code, message = str(answer.get("code"))[:100], str(answer.get("message"))[:1000]
            if answer.get("ok") is True:
                return HttpAnswer(200, code, message, True)
            return HttpAnswer(HTTP.get(code, REFUSED_BY_READER), code, message)
        if status.get("ticket") != ticket:  # each ticket is answered in turn, but for one that began anew
            return HttpAnswer(HTTP["no_answer"], "no_answer", "pursue_reader has begun anew: ask it what it has")
        return None


def check_bundle(order: Order, body: bytes) -> None:
    """Raises RequestRefused where the body is not the one that the order is about."""
    if len(body) != order.size or (order.size and hashlib.sha256(body).hexdigest() != order.bundle):
        raise RequestRefused("bad_bundle", "what came is not the bundle that the order is about")


def mission_message(order_text: str, body: bytes) -> str:
    """What is published on local_mission: the order as it came, and its bundle."""
    message = {"order": order_text}
    if body:
        message["bundle"] = base64.b64encode(body).decode()
    return json.dumps(message)


# Counts and log -------------------------------------------------------------------------------------------------------


class RequestLog(RateLimitedLog):
    """Counts requests by kind; what clients cause is logged at a limited rate.

    `warn(text)` and `note(text)` write to the log, `clock()` returns seconds.
    """

    def __init__(
        self, warn: Callable[[str], None], note: Callable[[str], None], clock: Callable[[], float] = time.monotonic
    ) -> None:
        super().__init__(warn, clock)
        self._info = note

    def log(self, word: str, text: str) -> None:
        """Count an event and log it in any case: only trusted orders cause it."""
        self.count(word)
        self._info(text)
