"""The state of the mission, and its text on `pursue/system_state`.

Clocks are in time units, stamps in seconds of ROS time.
"""

from __future__ import annotations

import re
from typing import Any, Dict, Iterable, List, NamedTuple, Optional, Tuple

from pursue_runtime.numbers import whole
from pursue_runtime.orders import parse_orders
from pursue_runtime.sentences import in_words, quoted

WAITING, RUNNING, HOLDING, WON, LOST, STOPPED = "waiting", "running", "holding", "won", "lost", "stopped"
LIVE, ENDED = (RUNNING, HOLDING), (WON, LOST, STOPPED)
STATUSES = (WAITING, *LIVE, *ENDED)

LISTS = ("late", "lost", "held", "displaced", "returning", "finished", "orders", "out_of_service")
"""The fields of a state that are lists: of agents, and of orders."""

LATE = 60.0
"""Seconds of real time for which a state with an earlier number and stamp counts as older than the last one received;
after that a clock was set back."""


_INTEGER = re.compile(r"-?\d{1,18}", re.ASCII)
_DECIMAL = re.compile(r"-?\d{1,18}(\.\d{1,30})?", re.ASCII)


class SystemState(NamedTuple):
    """One state of the mission: where every automaton is, variables, clocks (at `stamp`), and what led here.

    `reason` says why it holds or has ended: a sentence (sentences.py).
    `unit` is how many seconds a time unit lasts, `plan` the number of the plan in force (0: the workspace's own),
    `mission` the id of the mission whose state this is, "" for the one of the workspace. `late` names the agents that
    should have finished by now, `lost` those that nothing is expected of any more, `held` those that wait for a person.
    `displaced` names the robots that are not known to be where the state has them, `returning` those of them that are
    to go back there. `finished` names those that have reported the end of what they do with others who have not.
    `commanded` is True if the event was a command, not a report. `orders` are what the robots are to do (orders.py).
    `out_of_service` names the robots to which nothing is sent until they are back.
    """

    seq: int
    stamp: float
    locations: Dict[str, str]
    values: Dict[str, int]
    clocks: Dict[str, float]
    event: str = ""
    agent: str = ""
    status: str = RUNNING
    reason: str = ""
    unit: float = 1.0
    plan: int = 0
    lost: Tuple[str, ...] = ()
    mission: str = ""
    late: Tuple[str, ...] = ()
    held: Tuple[str, ...] = ()
    displaced: Tuple[str, ...] = ()
    returning: Tuple[str, ...] = ()
    commanded: bool = False
    finished: Tuple[str, ...] = ()
    orders: Tuple[str, ...] = ()
    out_of_service: Tuple[str, ...] = ()

    def clocks_at(self, stamp: float) -> Dict[str, float]:
        """The clocks at a later moment, if nothing has happened since (never earlier than this state)."""
        passed = max(0.0, stamp - self.stamp) / self.unit
        return {clock: value + passed for clock, value in self.clocks.items()}

    def discrete(self) -> Dict[str, str]:
        """automaton or variable → its location or value, as text."""
        everything = dict(self.locations)
        everything.update((name, str(value)) for name, value in self.values.items())
        return everything


def older(state: SystemState, known: SystemState) -> bool:
    """True for a state that was published before the known one: a link that was cut brings it late.

    Only the stamp: an observer whose clock was set back. Only the number: one that has started anew. Each mission
    counts from 0: of two missions the stamps alone tell which was later. In simulated time two states may have one
    stamp: under one number orders are only acknowledged.
    """
    if state.mission != known.mission:
        return state.stamp < known.stamp
    if state.seq == known.seq:
        if state.stamp == known.stamp:
            return _open_orders(state) > _open_orders(known)
        return state.stamp < known.stamp
    return state.seq < known.seq and state.stamp <= known.stamp


def _open_orders(state: SystemState) -> int:
    return sum(not order.acknowledged for order in parse_orders(state.orders))


def rewinds(state: SystemState, known: SystemState) -> bool:
    """True for a state that the mission of the known one, which is under way, cannot have come to.

    It counts back, or says of the same number something else: as an observer does that has lost its journal. The end
    without the goal counts whatever its number is: a safe stop is always possible.
    """
    if known.status not in LIVE or state.mission != known.mission or state.status in (LOST, STOPPED):
        return False
    if state.seq != known.seq:
        return state.seq < known.seq
    same = (state.locations, state.values) == (known.locations, known.values)
    return not same or (state.status in LIVE and (state.event, state.agent) != (known.event, known.agent))


def format_state(state: SystemState) -> str:
    """The text on pursue/system_state, for people: the thesis's, with a first line for us."""
    head = [f"seq={state.seq} stamp={state.stamp:.6f} unit={state.unit!r}"]
    agents = tuple((key, ",".join(getattr(state, key))) for key in LISTS)
    led_by = ("event", state.event), ("agent", state.agent), *agents
    facts = (("mission", state.mission), ("plan", state.plan), *led_by, ("commanded", int(state.commanded)))
    head += [f"{key}={value}" for key, value in facts if value]
    head.append("status=" + state.status)
    if state.reason:
        head.append("reason=" + " ".join(in_words(state.reason).split()))
    lines = [" ".join(head)]
    lines += [f"{name}={location}" for name, location in state.locations.items()]
    lines += [f"{name}={value}" for name, value in state.values.items()]
    lines.append("")
    lines += [f"{name}={value:.9f}" for name, value in state.clocks.items()]
    return "\n".join(lines)


def state_lines(state: SystemState, node: str) -> List[str]:
    """The lines that a node prints of a state: all automata, variables and clocks, as in the thesis's listing 4.4."""
    facts: List[Tuple[str, object]] = [("seq", state.seq), ("status", state.status)]
    facts += [*state.locations.items(), *state.values.items()]
    facts += [(clock, f"{value:.3f}") for clock, value in state.clocks.items()]
    return [f"{node}: the system state is:", *(f"{node}: {name} is {value}" for name, value in facts)]


def parse_state(text: str) -> Optional[SystemState]:
    """Reads what format_state writes, skipping lines that it does not know; no name is marked in the reason.

    None where the first line is not ours, or has numbers that no state has: seq < 0, unit <= 0, a stamp of infinity.
    """
    discrete, _, continuous = text.strip().partition("\n\n")
    head, _, discrete = discrete.partition("\n")
    head, _, reason = head.partition(" reason=")
    facts = dict(part.split("=", 1) for part in head.split() if "=" in part)
    try:
        seq, stamp, unit = whole(facts["seq"]), _finite(facts["stamp"]), _finite(facts.get("unit", "1"))
        plan = whole(facts.get("plan", "0"))
    except (KeyError, ValueError):
        return None
    if unit <= 0.0 or seq < 0:
        return None
    locations: Dict[str, str] = {}
    values: Dict[str, int] = {}
    for name, value in _pairs(discrete):
        if _INTEGER.fullmatch(value):
            values[name] = int(value)
        else:
            locations[name] = value
    clocks = {name: float(value) for name, value in _pairs(continuous) if _DECIMAL.fullmatch(value)}
    event, agent, status = facts.get("event", ""), facts.get("agent", ""), facts.get("status", RUNNING)
    lists: Dict[str, Any] = {key: tuple(filter(None, facts.get(key, "").split(","))) for key in LISTS}
    led_by = event, agent, status, quoted(reason), unit, plan
    state = SystemState(seq, stamp, locations, values, clocks, *led_by, mission=facts.get("mission", ""))
    return state._replace(commanded=facts.get("commanded") == "1", **lists)


def _finite(text: str) -> float:
    """The number in a text. Raises ValueError for infinity and NaN, and for what cannot be a time."""
    value = float(text)
    if not abs(value) < 1e15:
        raise ValueError(text)
    return value


def _pairs(text: str) -> Iterable[Tuple[str, str]]:
    for line in text.splitlines():
        name, equals, value = line.strip().partition("=")
        if equals and name and value:
            yield name, value
