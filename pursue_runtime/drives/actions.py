"""Actions that robots do without a mission, so that their durations are measured: which, where, and in which order.

An action is done only where the rules of the scenario let it be done after those before: nothing is dropped that was
not fetched. What people and uncontrollable agents take part in is left to missions. Without ROS.
"""

from __future__ import annotations

from typing import Collection, Dict, Iterator, List, NamedTuple, Optional, Sequence, Set, Tuple

from pursue_runtime.locations import action, action_of, is_action, position_variable
from pursue_runtime.model import Automaton, Model, Position

DONE = "DONE"
"""Ends the word with which the end of an action is reported."""

MOST_FAILURES = 2
"""So often something is tried that fails; then it is given up."""


class Act(NamedTuple):
    """An event with a duration, and the place where a robot does it. `partner`: another robot that takes part, "": it
    is done alone. `busy`: the partner is so until the end, and reports it, too."""

    event: str
    place: str
    partner: str = ""
    busy: bool = False

    def __str__(self) -> str:
        return f"{self.event} at {self.place}" + (f" with {self.partner}" if self.partner else "")

    def robots(self, doer: str) -> Tuple[str, ...]:
        """Who is there."""
        return (doer, self.partner) if self.partner else (doer,)


def acts_of(robot: Automaton, model: Model, partners: Collection[str] = ()) -> Tuple[Act, ...]:
    """The actions with a duration that this robot does alone, or with the first of the `partners` that can take
    part."""
    others = [each for each in model.acting if each is not robot]
    shared = {edge.word for other in others for edge in other.edges if edge.sync == "receive"}
    found = []
    for edge in robot.edges:
        if edge.sync == "receive" or is_action(edge.source) or not is_action(edge.target):
            continue
        act = Act(action_of(edge.target), edge.source)
        joins = [
            act._replace(partner=other.name, busy=is_action(one.target))
            for other in others
            for one in other.edges
            if other.name in partners and (one.sync, one.word, one.source) == ("receive", edge.word, edge.source)
        ]
        found += joins[:1] if edge.word in shared else [act]
    return tuple(dict.fromkeys(found))


class Rules:
    """What the robots have done so far, and what the rules let them do next."""

    def __init__(self, model: Model) -> None:
        self._model, self._position = model, model.initial()

    def allow(self, robot: str, act: Act) -> bool:
        """True where the robot may do this now, as far as others than itself are concerned."""
        return self._after(robot, act) is not None

    def done(self, robot: str, act: Act) -> None:
        """The robot has done it."""
        self._position = self._after(robot, act) or self._position

    def _after(self, robot: str, act: Act) -> Optional[Position]:
        position: Optional[Position] = self._position
        for name in act.robots(robot):
            assert position is not None
            position = self._at(position, name, act.place)
        for word in (act.event, act.event + DONE):
            assert position is not None
            moves = self._model.joint_move(position, word, robot, timed=False)
            if moves is None:
                return None
            position = self._model.after(moves, position)
        return position

    def _at(self, position: Position, robot: str, place: str) -> Position:
        """The position with this robot at the place."""
        variable = position_variable(robot)
        arrivals = (edge for edge in self._model.automaton(robot).edges if edge.target == place)
        locations, values, clocks = position
        values = dict(values)
        for edge in arrivals:
            values.update({name: number for name, number in edge.assign.items() if name == variable})
        return Position({**locations, robot: place}, values, clocks)


class Acts:
    """What one robot has to do, each so many times. `measured` has the seconds of each."""

    def __init__(self, robot: str, acts: Sequence[Act], times: int, rules: Optional[Rules]) -> None:
        self.measured: Dict[Act, List[float]] = {act: [] for act in acts}
        self._robot, self._times, self._rules = robot, times, rules
        self._failures: Dict[Act, int] = {}
        self._here: Set[Act] = set()  # done since the robot has arrived

    def arrived(self) -> None:
        """The robot has come to a place."""
        self._here.clear()

    def next(self, place: str, again: bool, among: Collection[Act]) -> Optional[Act]:
        """What the robot does now at this place: each once in one stay, `again` where nothing else is left to do."""
        here = [act for act in self.left() if act.place == place and (again or act not in self._here)]
        return min((act for act in here if act in among), key=self.count, default=None)

    def places(self, among: Collection[Act]) -> Set[str]:
        """Where one of these is left that may be done now."""
        return {act.place for act in self.left() if act in among}

    def count(self, act: Act) -> int:
        """How often it was measured."""
        return len(self.measured[act])

    def done(self, act: Act, seconds: float) -> None:
        """It has been done, and took so long."""
        self.measured[act].append(seconds)
        self._here.add(act)
        if self._rules is not None:
            self._rules.done(self._robot, act)

    def failed(self, act: Act) -> None:
        """It did not come to its end."""
        self._failures[act] = self._failures.get(act, 0) + 1
        self._here.add(act)

    def why_not_all(self) -> str:
        """Why not each was done so often as was wanted: one reason; "" if each was."""
        missing = [act for act in self.measured if self.count(act) < self._times]
        given_up = [act for act in missing if self._failures.get(act, 0) >= MOST_FAILURES]
        if given_up:
            return f"{given_up[0]} was given up, as it did not come to its end"
        return f"{missing[0]} needs something else to be done before" if missing else ""

    @property
    def is_complete(self) -> bool:
        """True where each was done so often as was wanted."""
        return all(len(times) >= self._times for times in self.measured.values())

    def summary(self) -> Iterator[str]:
        """What was measured of each, a sentence each."""
        for act, times in self.measured.items():
            took = f", {min(times):.1f} to {max(times):.1f} s" if times else ""
            failed = f"; {self._failures[act]} failed" if act in self._failures else ""
            yield f"{self._robot} does {act}: {len(times)} of {self._times} times{took}{failed}"

    def left(self) -> List[Act]:
        """What is to be done still, and may be done now."""
        return [
            act
            for act, times in self.measured.items()
            if len(times) < self._times
            and self._failures.get(act, 0) < MOST_FAILURES
            and (self._rules is None or self._rules.allow(self._robot, act))
        ]


def location_of(act: Act) -> str:
    """The location of a robot that does it."""
    return action(act.event, act.place)
