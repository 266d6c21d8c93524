"""Which commands a strategy holds in a state, and whether one of them was due there: the judge's own reading."""

from __future__ import annotations

import re
from fractions import Fraction
from typing import Any, Dict, Iterable, List, Mapping, NamedTuple, Optional, Set, Tuple

from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga.words import event_word

EPSILON = 5e-6
"""Moments (in time units) that are closer than this are the same: clocks and stamps travel as decimals."""


class Limit(NamedTuple):
    """`left - right <= bound`; a side that is None is the constant 0."""

    left: Optional[str]
    right: Optional[str]
    bound: float


class ZonedCommand(NamedTuple):
    """In these zones, the agent does the event."""

    agent: str
    event: str
    zones: Tuple[Tuple[Limit, ...], ...]

    def due_between(self, clocks: Mapping[str, float], earliest: float, latest: float) -> bool:
        """True if one of the zones holds at some moment from `earliest` to `latest` (time units from these clocks)."""
        windows = (_window(zone, clocks, earliest - EPSILON, latest + EPSILON) for zone in self.zones)
        return any(first <= last for first, last in windows)

    def first_due(self, clocks: Mapping[str, float], earliest: float, latest: float) -> Optional[float]:
        """The first moment from `earliest` to `latest` at which one of the zones holds; None if there is none.

        A zone that is only touched does not count: its bounds may be strict.
        """
        windows = (_window(zone, clocks, earliest, latest) for zone in self.zones)
        return min((first for first, last in windows if last - first > 3 * EPSILON), default=None)


Entry = Tuple[Tuple[str, ...], Tuple[str, ...]]
"""A block: the automata and variables that it names, and the location or value of each."""


class Commands:
    """The commands of one plan, by discrete state (names of automata and variables to locations and values), and the
    clocks that it leaves out."""

    def __init__(
        self, entries: Iterable[Tuple[Mapping[str, str], ZonedCommand]], left_out_clocks: Iterable[str] = ()
    ) -> None:
        self.left_out_clocks = frozenset(left_out_clocks)
        self._tables: Dict[Tuple[str, ...], Dict[Tuple[str, ...], List[ZonedCommand]]] = {}
        for state, held in entries:
            names = tuple(sorted(state))
            table = self._tables.setdefault(names, {})
            table.setdefault(tuple(state[name] for name in names), []).append(held)

    def holding(self, state: Mapping[str, str]) -> List[Entry]:
        """The blocks with commands that hold in this state."""
        named = ((names, tuple(state.get(name, "") for name in names)) for names in self._tables)
        return [(names, parts) for names, parts in named if parts in self._tables[names]]

    def held_by(self, block: Entry, agent: str = "", event: str = "") -> List[ZonedCommand]:
        """The commands of a block; with an agent, those by which it does the event."""
        held = self._tables[block[0]][block[1]]
        return [command for command in held if not agent or (command.agent, command.event) == (agent, event)]


def commands_of(strategy: Strategy) -> Commands:
    """Those of a strategy as the solver made it."""
    entries = []
    for block in strategy.blocks:
        state = dict(block.state.locations)
        state.update((name, str(value)) for name, value in block.state.values)
        for command in block.commands:
            first = command.moves[0]
            zones = tuple(tuple(Limit(c.left, c.right, float(c.bound)) for c in zone) for zone in command.zones)
            entries.append((state, ZonedCommand(first.automaton, event_word(first.automaton, first.edge), zones)))
    return Commands(entries, strategy.left_out_clocks)


def commands_in(strategies: Iterable[Mapping[str, Any]]) -> Commands:
    """Those of a new plan, from the data that its controllers get (as in strategy.yaml)."""
    entries = []
    left_out: Set[str] = set()
    for data in strategies:
        left_out.update(data.get("left_out_clocks", ()))
        for entry in data["strategy"]:
            state = {str(name): str(value) for name, value in entry["state"].items()}
            for command in entry["commands"]:
                zones = tuple(_zone(text) for text in command["when"])
                entries.append((state, ZonedCommand(str(command["agent"]), str(command["do"]), zones)))
    return Commands(entries, left_out)


_COMPARISON = re.compile(r"(.+?)\s*(<=|<|==)\s*(.+)")


def _zone(text: str) -> Tuple[Limit, ...]:
    """Comparisons as strategy files have them: `a < C`, `C <= b`, `C - D < c`, `C == D`, `C == 5`."""
    limits: List[Limit] = []
    for part in [] if text.strip() == "always" else text.split("&&"):
        match = _COMPARISON.fullmatch(part.strip())
        if match is None:
            raise ValueError(f"not a comparison of clocks: {part!r}")
        (left, minus, low), (right, plus, high) = _side(match.group(1)), _side(match.group(3))
        limits.append(Limit(left or plus, minus or right, high - low))
        if match.group(2) == "==":
            limits.append(Limit(minus or right, left or plus, low - high))
    return tuple(limits)


def _side(text: str) -> Tuple[Optional[str], Optional[str], float]:
    """clock, subtracted clock, number."""
    if re.fullmatch(r"-?\d+(\.\d+)?(/\d+)?", text.strip()):
        return None, None, float(Fraction(text.strip()))
    clock, _, less = text.partition("-")
    return clock.strip(), less.strip() or None, 0.0


def _window(
    zone: Iterable[Limit], clocks: Mapping[str, float], earliest: float, latest: float
) -> Tuple[float, float]:
    """The first and the last moment from `earliest` to `latest` at which the zone holds; never if the last is before
    the first."""
    for left, right, bound in zone:
        if left and right:
            if clocks[left] - clocks[right] > bound + EPSILON:
                return 0.0, -1.0
        elif left:
            latest = min(latest, bound - clocks[left] + EPSILON)
        elif right:
            earliest = max(earliest, -bound - clocks[right] - EPSILON)
    return earliest, latest
