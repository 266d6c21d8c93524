"""A recording on the disk → its Record: a bag by its first bytes, a journal by its first line."""

from __future__ import annotations

import math
import re
import struct
from dataclasses import replace
from pathlib import Path
from typing import AbstractSet, Any, BinaryIO, Dict, List, Mapping, Optional, Sequence, Tuple, Union

from pursue_gen.diagnostics import PursueError, error
from pursue_gen.files import reason_of
from pursue_gen.tools.replay.bag import MAGIC, Damage, Message, read_bag
from pursue_gen.tools.replay.journal import Journal, read_journal
from pursue_gen.tools.replay.record import MissionRecord, RecordedWord, RobotOrder, ordered, read_word
from pursue_runtime.bounded import json_object
from pursue_runtime.drives.report import DRIVES, Drive, parse_drive
from pursue_runtime.event_words import parse_word
from pursue_runtime.named_files import open_regular, read_all
from pursue_runtime.state import SystemState, parse_state

EXPECTED = "name a bag of ROS 1 (launch the mission with record:=true), or an observer's journal (journal-….jsonl)"

RECORD = re.compile(rb"[0-9a-f]{8} 0 \d+ \{")
"""How a journal of format 2 begins."""

LARGEST_JOURNAL = 256 << 20
"""Bytes of a journal; bags may be larger, and are read piece by piece."""

BEHIND = 2.0
"""Seconds by which the recorder's clock may be seen to be behind the observer's; more is another clock."""

_BAG = b"#ROSBAG"
_FOREIGN = {
    b"#ROSRECORD": "a bag of ROS 1 before version 2.0",
    b"SQLite format 3\0": "a bag of ROS 2 (sqlite3)",
    b"\x89MCAP0\r\n": "a bag of ROS 2 (mcap)",
}
"""How files begin that are bags, too, and cannot be read."""

_CONVERT = "convert it to a bag of ROS 1, version 2.0, for example with rosbags-convert (rosbag fix before version 2.0)"
CONNECTING = 5.0
"""Seconds within which a recorder that is started during a mission is connected to every node."""

_SIMPLE, _ACTION = "/move_base_simple/goal", "/move_base/goal"
_ORDERS = (_SIMPLE, "/pursue/actions", "/move_base_flex" + _ACTION, _ACTION)
"""Topics of a robot, below its namespace."""
_MISSION = ("pursue/events", "pursue/system_state", "pursue/plan", "pursue/game")
_SHOWN = 40  # topics that a message names


def read_recording(file: Path, drives: bool = False) -> Union[MissionRecord, Journal]:
    """What is in the file. Raises PursueError (exit status 2) where that is no mission; with `drives` a bag may hold
    drives without one, or nothing yet.
    """
    try:
        if (file / "metadata.yaml").is_file():
            raise _unreadable(f"{file} is a bag of ROS 2, a folder", "RPL003", _CONVERT)
        with open_regular(file) as stream:
            begin = stream.read(max(map(len, _FOREIGN)))
            stream.seek(len(_BAG))
            if begin.startswith(_BAG):
                return _bag(file, stream, drives)
        for start, what in _FOREIGN.items():
            if begin.startswith(start):
                raise _unreadable(f"{file} is {what}", "RPL003", _CONVERT)
        content = read_all(file, LARGEST_JOURNAL)
    except (OSError, ValueError) as problem:
        raise _unreadable(f"cannot read {file}: {reason_of(problem)}", "RPL001") from None
    if content.lstrip()[:1] == b"{" or RECORD.match(content):
        journal = read_journal(content)
        if isinstance(journal, str):
            raise _unreadable(f"{file} is no journal: {journal}", "RPL002")
        return journal
    raise _unreadable(f"{file} is neither a bag nor a journal", "RPL002")


def _bag(file: Path, stream: BinaryIO, drives: bool) -> MissionRecord:
    try:
        bag = read_bag(stream, _is_ours)
    except Damage as damage:
        known = MAGIC.decode().strip()
        raise _unreadable(f"{file} is a bag of another format than {known}: {damage}", "RPL003") from None
    record = from_messages(bag.messages, bag.problems)
    if record.drives and not record.states and not drives:
        message = f"{file} holds drives that were measured, and no mission"
        raise _unreadable(message, "RPL004", f"for times of drives: pursue-gen calibrate SCENARIO.pur {file}")
    if not record.states and not (drives and (record.drives or record.game)):
        found = ", ".join(bag.topics[:_SHOWN]) + (", …" if len(bag.topics) > _SHOWN else "") or "no messages"
        hint = "; ".join([*bag.problems, EXPECTED + (", or one of drives (rosrun UI drive_legs)" if drives else "")])
        missing = "no state of a mission on pursue/system_state" + (" and no drives on pursue/drives" if drives else "")
        raise _unreadable(f"{file} holds {missing}; it has {found}", "RPL004", hint)
    return record


def _is_ours(topic: str) -> bool:
    """True for a topic whose messages `from_messages` does not pass over."""
    return ("/" + topic.strip("/")).endswith((*_ORDERS, DRIVES, *_MISSION))


def from_messages(messages: Sequence[Message], problems: Sequence[str] = ()) -> MissionRecord:
    """What the messages of a bag hold; those that are not ours are passed over.

    What was recorded after a state is not dated before it, where the recorder's clock was a little behind.
    """
    states: List[SystemState] = []
    words: List[RecordedWord] = []
    orders: List[RobotOrder] = []
    plans: Dict[int, Mapping[str, Any]] = {}
    game: Optional[Mapping[str, Any]] = None
    drives: List[Drive] = []
    received: Dict[int, float] = {}
    strange, latest, robot_at = 0, -math.inf, _namespaces(messages)
    # without `seq`, which counts what was sent to one subscriber alone, too
    simple = {(_name(each), each.data[4:]) for each in messages if _name(each).endswith(_SIMPLE)}
    for message in messages:
        topic = _name(message)
        sent = _sent(message.data) if topic.endswith((_SIMPLE, _ACTION)) else latest
        for moment in (latest, sent):  # /clock may reach the recorder later than a state, and that later than a goal
            if message.at < moment <= message.at + BEHIND:
                message = replace(message, at=moment)
        if topic.endswith(_ORDERS):
            orders += [] if _is_published_again(message, topic, simple) else [_order(message, topic, robot_at)]
        elif topic.endswith(DRIVES):
            drive = parse_drive(_text(message.data))
            drives += [] if drive is None else [drive]
            strange += drive is None
        elif topic.endswith(_MISSION):
            text = _text(message.data)
            state = parse_state(text) if topic.endswith("system_state") else None
            data = json_object(text) if topic.endswith(("plan", "game")) else None
            if topic.endswith("events"):
                words.append(read_word(message.at, text, message.node))
            elif state is not None:
                states.append(state)
                received.setdefault(state.seq, message.at)
                latest = state.stamp
            elif data is not None and topic.endswith("plan"):
                plans[_whole(data.get("plan"))] = data
            elif data is not None:
                game = data
            else:
                strange += 1
    found = [*problems, *([f"{strange} messages on our topics could not be read"] if strange else [])]
    known = ordered(iter(states))
    record = MissionRecord(
        known, tuple(words), tuple(orders), plans, game, tuple(found), drives=tuple(drives), received=received
    )
    return replace(record, whole_from=_connected(messages)) if known and record.is_late else record


def _name(message: Message) -> str:
    """The topic of a message, with a slash before it."""
    return "/" + message.topic.strip("/")


def _connected(messages: Sequence[Message]) -> float:
    """The moment from which on a recorder that came late has the messages of all nodes: when it has one of each, and a
    second more for the other topics of the last one."""
    first: Dict[str, float] = {}
    for message in messages:
        first.setdefault(message.node, message.at)
    begin = min(first.values())
    return max(at for at in first.values() if at <= begin + CONNECTING) + 1.0


def _is_published_again(message: Message, topic: str, simple: AbstractSet[Tuple[str, bytes]]) -> bool:
    """Return True for an action goal that ends with a simple goal: move_base publishes those so, for itself."""
    if not topic.endswith(_ACTION):
        return False
    own = topic[: -len(_ACTION)] + _SIMPLE
    return any((own, message.data[-size:]) in simple for size in {len(data) for _, data in simple})


def _namespaces(messages: Sequence[Message]) -> Dict[str, str]:
    """Namespaces, and the robots that have them, where they are not the robots' names."""
    games = [json_object(_text(each.data)) for each in messages if _name(each).endswith("pursue/game")]
    found = [game.get("namespaces") for game in games if game is not None]
    return {str(at).strip("/"): name for each in found if isinstance(each, dict) for name, at in each.items()}


def _order(message: Message, topic: str, robot_at: Mapping[str, str]) -> RobotOrder:
    """An order to a robot, whose namespace stands first in the topic's last parts."""
    kind = next(kind for kind in _ORDERS if topic.endswith(kind))
    before = topic[: -len(kind)]
    own = max((at for at in robot_at if at == before or (at and before.endswith(f"/{at}"))), key=len, default=None)
    robot = before.rpartition("/")[2] if own is None else robot_at[own]
    if kind == "/pursue/actions":
        text = _text(message.data).strip() or "?"
        word = parse_word(text)
        action, seq = (text, None) if word is None else (word.event, word.seq)
        return RobotOrder(message.at, robot, message.node, action=action, seq=seq)
    goal = _position(message.data) if kind == _SIMPLE else None
    return RobotOrder(message.at, robot, message.node, goal)


def _text(data: bytes) -> str:
    """The text of a std_msgs/String, as far as it is there."""
    return data[4:].decode("utf-8", "replace")


def _sent(data: bytes) -> float:
    """When a message with a header was sent (seconds, by its sender's clock); 0 where it is cut."""
    seconds, nanoseconds = struct.unpack_from("<LL", data, 4) if len(data) >= 12 else (0, 0)
    return float(seconds + nanoseconds / 1e9)


def _position(data: bytes) -> Optional[Tuple[float, float, float]]:
    """x, y and z of a geometry_msgs/PoseStamped; None where it is cut."""
    try:
        (length,) = struct.unpack_from("<L", data, 12)
        x, y, z = struct.unpack_from("<ddd", data, 16 + length)
    except struct.error:
        return None
    return x, y, z


def _whole(value: Any) -> int:
    return value if isinstance(value, int) else -1


def _unreadable(message: str, code: str, hint: str = EXPECTED) -> PursueError:
    return PursueError([error(code, message, hint=hint)])
