"""Recorded missions for tests: scenario 1 played by a script, and written as a bag or as a journal."""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Dict, List, Optional, Tuple

from rosbags.rosbag1 import Writer

from pursue_gen.drawing.layout import poses
from pursue_gen.language import load
from pursue_gen.solving.rules import Rules, played
from pursue_gen.tga import translate
from pursue_gen.tools.replay.game import Game, Source, game_of
from pursue_gen.tools.replay.moves import Moves, after
from pursue_runtime.observer.records import format_record
from pursue_runtime.state import SystemState

SCENARIO = Path(__file__).resolve().parents[3] / "scenarios" / "thesis" / "scenario_1.pur"
START = 100.0
"""ROS time of the start."""

Play = Tuple[Tuple[float, str, str], ...]
"""Moment (time units since the start), word without the number of a state, node."""

PLAY: Play = (
    (0.1, "reachObj:reachObj_going_initial_location2unlocked@", "controllerObj"),
    (1.1, "bot1:bot1_c2b@", "controller_bot1"),
    (1.1, "bot2:bot2_c2a@", "controller_bot2"),
    (10.4, "bot1_going_c_to_b2b", "simulator"),
    (10.9, "bot2_going_c_to_a2a", "simulator"),
    (11.5, "bot1:bot1_inb@", "controller_bot1"),
    (14.8, "bot1_inbDONE", "simulator"),
    (14.9, "bot2:bot2_ina@", "controller_bot2"),
    (21.3, "bot2_inaDONE", "simulator"),
)
"""A mission that is won, as the strategy has it."""

_game: List[Game] = []


def game() -> Game:
    """Scenario 1 in the default game, solved once."""
    if not _game:
        _game.append(game_of(Source("scenario_1", SCENARIO.read_text(encoding="utf-8"), str(SCENARIO), Rules())))
    return _game[0]


@dataclass
class Mission:
    """What was said and shown: (seconds, topic, node, text or pose)."""

    states: List[SystemState] = field(default_factory=list)
    heard: List[Tuple[float, str, str, Any]] = field(default_factory=list)
    unit: float = 1.0
    received: Dict[int, float] = field(default_factory=dict)
    """When states were published that have an earlier stamp, by their numbers."""

    def say(self, at: float, text: str, node: str) -> None:
        """A word."""
        self.heard.append((at, "/pursue/events", node, text))

    def order(self, at: float, robot: str, what: Any, node: str = "") -> None:
        """A goal (a POI) or an action for a robot, from its controller unless another node is named."""
        goal = poses(load(str(SCENARIO)))[0].get(what)
        topic = f"/{robot}/{'move_base_simple/goal' if goal else 'pursue/actions'}"
        self.heard.append((at, topic, node or f"controller_{robot}", goal or what))

    def messages(self) -> List[Tuple[float, str, str, Any]]:
        """Everything, in order of receipt."""
        times = (self.received.get(state.seq, state.stamp) for state in self.states)
        shown = [(at, "/pursue/system_state", "observer", text_of(state)) for at, state in zip(times, self.states)]
        return sorted([*shown, *self.heard], key=lambda message: message[0])

    def change(self, seq: int, **values: Any) -> None:
        """Replaces something of the states with this number."""
        self.states = [state._replace(**values) if state.seq == seq else state for state in self.states]


def mission(play: Play = PLAY, unit: float = 1.0) -> Mission:
    """The mission that these words make, each of them taken, with the orders that follow from commands."""
    network = played(translate(load(str(SCENARIO))), Rules())
    moves, made = Moves(network), Mission(unit=unit)
    place, zeros = moves.initial, dict.fromkeys(network.clocks, START)

    def show(at: float, seq: int, **more: Any) -> None:
        clocks = {clock: (at - zero) / unit for clock, zero in zeros.items()}
        made.states.append(SystemState(seq, at, dict(place.locations), dict(place.values), clocks, unit=unit, **more))

    show(START - 3.0, 0, status="waiting")
    made.say(START - 0.001, "_start_", "UI")
    zeros = dict.fromkeys(network.clocks, START)
    show(START, 1)
    for seq, (units, word, node) in enumerate(play, start=2):
        at = START + units * unit
        agent, _, event = word.rstrip("@").partition("#")[0].rpartition(":")
        move = next(moves.of(place, event, agent))
        place, resets = after(move, place)
        zeros.update(dict.fromkeys(resets, at))
        won = place.locations["reachObj"] == "win"
        show(at, seq, event=event, agent=move[0][0], status="won" if won else "running")
        made.say(at - 0.002, word + (str(seq - 1) if word.endswith("@") else ""), node)
        target = place.locations[move[0][0]]
        if word.endswith("@") and move[0][0] != "reachObj":
            made.order(at + 0.003, move[0][0], target.rpartition("_")[2] if target.startswith("going_") else event)
    return made


def text_of(state: SystemState) -> str:
    """The text on pursue/system_state, as docs/run_time.md has it."""
    head = f"seq={state.seq} stamp={state.stamp:.6f} unit={state.unit!r}"
    facts = {"plan": state.plan, "event": state.event, "agent": state.agent}
    facts.update((name, ",".join(getattr(state, name))) for name in ("lost", "displaced", "returning"))
    head += "".join(f" {name}={value}" for name, value in facts.items() if value) + f" status={state.status}"
    head += f" reason={state.reason}" if state.reason else ""
    lines = [head, *(f"{name}={value}" for name, value in {**state.locations, **state.values}.items()), ""]
    return "\n".join([*lines, *(f"{name}={value:.9f}" for name, value in state.clocks.items())])


def write_bag(made: Mission, path: Path, game_data: Optional[Dict[str, Any]] = None, compression: str = "") -> Path:
    """Writes the mission as a bag, with the Python package rosbags: nothing of it is shared with our reader."""
    connections: Dict[Tuple[str, str], Any] = {}
    messages = made.messages()
    if game_data is not None:
        messages.insert(0, (messages[0][0], "/pursue/game", "recorder", json.dumps(game_data)))
    writer = Writer(path)
    if compression:
        writer.set_compression(Writer.CompressionFormat[compression])
    with writer:
        for at, topic, node, what in messages:
            goal = topic.endswith("move_base_simple/goal")
            kind = "geometry_msgs/msg/PoseStamped" if goal else "std_msgs/msg/String"
            if (topic, node) not in connections:
                connections[topic, node] = writer.add_connection(
                    topic, kind, msgdef="string data", md5sum="0" * 32, callerid=f"/{node}", latching=0
                )
            writer.write(connections[topic, node], round(at * 1e9), _pose(at, what) if goal else _string(what))
    return path


def _string(text: str) -> bytes:
    data = text.encode()
    return struct.pack("<L", len(data)) + data


def _pose(at: float, pose: Any) -> bytes:
    head = struct.pack("<LLL", 0, int(at), 0) + _string("map")
    return head + struct.pack("<7d", pose.x, pose.y, pose.z, pose.qx, pose.qy, pose.qz, pose.qw)


def write_journal(play: Play, path: Path, unit: float = 1.0) -> Path:
    """Writes the mission as the observer's journal."""
    head = {"format": 2, "scenario": "scenario_1", "model": "0", "settings": {"time_unit": unit}}
    lines: List[Dict[str, Any]] = [head]
    lines.append({"at": START, "call": "hear", "args": ["_start_"], "seq": 1, "status": "running"})
    for seq, (units, word, _) in enumerate(play, start=2):
        said = word + (str(seq - 1) if word.endswith("@") else "")
        status = "won" if word == "bot2_inaDONE" else "running"
        lines.append({"at": START + units * unit, "call": "hear", "args": [said], "seq": seq, "status": status})
    lines.append({"call": "told"})
    path.write_bytes(b"".join(format_record(number, line) for number, line in enumerate(lines)))
    return path
