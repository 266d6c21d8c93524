"""What rviz shows of a mission: places, ways, spots, where each agent is, where it goes, and what it does next.

Coordinates and sizes are metres, in the frame of the map; colours are red, green and blue from 0 to 1.
"""

from __future__ import annotations

import math
import textwrap
from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple

from pursue_runtime.data import DataError, reading
from pursue_runtime.locations import action_of, is_action, movement, place_of
from pursue_runtime.model import Model
from pursue_runtime.sentences import in_words
from pursue_runtime.state import ENDED, LIVE, SystemState
from pursue_runtime.ui.course import Step, course, first_commands
from pursue_runtime.ui.page import FloorPlan
from pursue_runtime.ui.strategies import Strategies

Point = Tuple[float, float]
Colour = Tuple[float, float, float]

DISC, BALL, LINES, ARROW, TEXT = "disc", "ball", "lines", "arrow", "text"

GREY, DARK = (0.62, 0.65, 0.70), (0.15, 0.17, 0.20)
COLOURS: Mapping[str, Colour] = {"robot": (0.10, 0.40, 0.85), "human": (0.05, 0.55, 0.30), "agent": (0.50, 0.20, 0.65)}
"""Robots and people for whom the strategy decides, and agents that nobody controls."""

LATE, LOST, WAITS = (0.93, 0.45, 0.00), (0.80, 0.08, 0.08), (0.80, 0.65, 0.00)
"""Who is late; who is lost; who is held, or not where the state has it."""

LEAST, MOST, SHARE = 0.15, 1.5, 0.12
"""The diameter of a place: at least, at most, and as a share of the shortest distance between two places."""

LINE = 60
"""Characters in a line of the reason."""


class Mark(NamedTuple):
    """One thing to show. `group` is its namespace in rviz.

    A disc, a ball or a text is at its only point, an arrow goes from its first point to its second one, and lines join
    the points in pairs. `size` is a diameter, the height of a text, or the width of an arrow or a line.
    """

    group: str
    kind: str
    points: Tuple[Point, ...]
    size: float
    colour: Colour
    text: str = ""


Spots = Dict[str, Dict[str, Point]]
"""robot → place → where the robot stands there, if that is not where the place is."""


def read_spots(settings: Mapping[str, Any], plan: FloorPlan) -> Spots:
    """Read the robots' spots in ui.yaml; none if it is of a version that had none. Raises DataError."""
    with reading("ui.yaml", "spots"):
        found = {
            str(robot): {str(place): (float(at[0]), float(at[1])) for place, at in table.items()}
            for robot, table in (settings.get("spots") or {}).items()
        }
    if not all(math.isfinite(number) for table in found.values() for at in table.values() for number in at):
        raise DataError("ui.yaml has a spot that is not a finite number of metres; expected [x, y]")
    return {robot: {at: table[at] for at in table if at in plan.places} for robot, table in found.items()}


class Picture:
    """What there is to show of one mission, by its states."""

    def __init__(self, model: Model, plan: FloorPlan, spots: Spots, strategies: Strategies) -> None:
        """`strategies`: those of all plans, where they are known."""
        self._model, self._plan, self._spots = model, plan, spots
        self._strategies = strategies
        self._size = _size(list(plan.places.values()))
        self._ways = {movement(a, b): (a, b) for a in plan.places for b in plan.places}
        self._still = [*self._way_marks(), *self._place_marks(), *self._spot_marks()]

    def marks(self, state: Optional[SystemState]) -> List[Mark]:
        """Return everything to show in a state; None: none has been received."""
        status = "no state from the observer yet" if state is None else state.status
        reason = in_words(state.reason, self._model.shown) if state is not None else ""
        shown = [*self._still, *self._status_marks(status, reason)]
        if state is None:
            return shown
        strategies = self._strategies.get(state.plan, ())
        following = first_commands(course(self._model, strategies, state)) if strategies else {}
        crowd: Dict[Point, int] = {}  # how many are shown at a point
        for automaton in self._model.acting:
            location = state.locations.get(automaton.name, "")
            step = following.get(automaton.name)
            shown += self._agent_marks(automaton.name, automaton.kind, location, state, crowd, step)
        return shown

    # What stays as it is ----------------------------------------------------------------------------------------------

    def _way_marks(self) -> List[Mark]:
        both = [(a, b) for a, b, _ in self._plan.ways if (a, b) not in self._plan.one_ways]
        ends = tuple(self._plan.places[end] for way in both for end in way)
        lines = [Mark("ways", LINES, ends, self._size / 8, GREY)] if ends else []
        points = [(self._plan.places[a], self._plan.places[b]) for a, b in self._plan.one_ways]
        return lines + [Mark("ways", ARROW, pair, self._size / 6, GREY) for pair in points]

    def _place_marks(self) -> List[Mark]:
        places = self._plan.places.items()
        discs = [Mark("places", DISC, (at,), self._size, GREY) for _, at in places]
        above = 1.1 * self._size
        return discs + [
            Mark("labels", TEXT, ((x, y + above),), 1.1 * self._size, DARK, self._model.shown(name))
            for name, (x, y) in places
        ]

    def _spot_marks(self) -> List[Mark]:
        kinds = {automaton.name: automaton.kind for automaton in self._model.automata}
        return [
            Mark("spots", DISC, (at,), 0.5 * self._size, _pale(COLOURS.get(kinds.get(robot, ""), GREY)))
            for robot, table in self._spots.items()
            for at in table.values()
        ]

    # What changes -----------------------------------------------------------------------------------------------------

    def _status_marks(self, status: str, reason: str) -> List[Mark]:
        """The status of the mission, and why it holds or has ended, above the map."""
        places = list(self._plan.places.values())
        if not places:
            return []
        lines = [f"{self._model.scenario}: {status}", *textwrap.wrap(reason, LINE)]
        x = (min(x for x, _ in places) + max(x for x, _ in places)) / 2
        y = max(y for _, y in places) + (3.0 + 0.8 * len(lines)) * self._size
        return [Mark("mission", TEXT, ((x, y),), 1.2 * self._size, DARK, "\n".join(lines))]

    def _agent_marks(
        self,
        name: str,
        kind: str,
        location: str,
        state: SystemState,
        crowd: Dict[Point, int],
        step: Optional[Step],
    ) -> List[Mark]:
        """An agent: a ball where it stands, or an arrow to where it goes, what it does in words, and its next command
        (`step`)."""
        here = place_of(location, [*self._plan.places, *self._ways])
        colour, what = self._look(name, kind, state)
        shown, does = self._model.shown(name), ""
        if is_action(location):
            does = self._model.shown(action_of(location))
        way = self._ways.get(here)
        if way is not None:
            start, end = (self._spot(name, place) for place in way)
            does = does or f"to {self._model.shown(way[1])}"
            at = _beside((start[0] + end[0]) / 2, (start[1] + end[1]) / 2, crowd, self._size)
            marks = [Mark("movements", ARROW, (start, end), self._size / 4, colour)]
        elif here in self._plan.places:
            at = _beside(*self._spot(name, here), crowd, self._size)
            marks = [Mark("agents", BALL, (at,), 0.7 * self._size, colour)]
        else:
            return []
        words = f"{shown}: {does}{what}" if does else shown + what
        if step is not None:
            words += f", then {step.does}" if does else f", next: {step.does}"
            ahead = self._ways.get(step.location)
            if ahead is not None:
                line = self._spot(name, ahead[0]), self._spot(name, ahead[1])
                marks.append(Mark("next", ARROW, line, self._size / 8, _pale(COLOURS[kind])))
        below = at[0], at[1] - 1.1 * self._size
        return [*marks, Mark("names", TEXT, (below,), 0.9 * self._size, colour, words)]

    def _look(self, name: str, kind: str, state: SystemState) -> Tuple[Colour, str]:
        """The colour of an agent, and what is wrong with it, in words."""
        if state.status not in (*LIVE, *ENDED):
            return COLOURS[kind], ""
        if name in state.lost:
            return LOST, " (lost)"
        if name in state.held:
            return WAITS, " (held)"
        if name in state.out_of_service:
            return WAITS, " (out of service)"
        if name in state.displaced:
            return WAITS, " (returning)" if name in state.returning else " (displaced)"
        return (LATE, " (late)") if name in state.late else (COLOURS[kind], "")

    def _spot(self, name: str, place: str) -> Point:
        """Where an agent stands at a place."""
        return self._spots.get(name, {}).get(place, self._plan.places[place])


def _pale(colour: Colour) -> Colour:
    """The colour, nearer to white."""
    red, green, blue = ((1.0 + part) / 2 for part in colour)
    return red, green, blue


def _size(places: Sequence[Point]) -> float:
    """The diameter of a place on the map."""
    pairs = ((a, b) for number, a in enumerate(places) for b in places[:number])
    gaps = [math.hypot(a[0] - b[0], a[1] - b[1]) for a, b in pairs]
    return min(MOST, max(LEAST, SHARE * min((gap for gap in gaps if gap > 0.0), default=0.0)))


def _beside(x: float, y: float, crowd: Dict[Point, int], size: float) -> Point:
    """The next free point at (x, y): those who are at one point are shown in a column."""
    count = crowd[x, y] = crowd.get((x, y), -1) + 1
    return x, y - 2.0 * size * count
