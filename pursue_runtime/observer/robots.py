"""Robots that cannot go on as the state has it (held by a person, or not where the state has them), and those that
people take out of service while a mission is under way, and bring back.

Nothing is sent to a robot that is out of service; it stands where it is, and counts there. Only a plan that is proven
without it takes it out.
"""

from __future__ import annotations

from typing import Collection, Dict, FrozenSet, Iterable, List, Mapping, Optional, Sequence, Set, Tuple

from pursue_runtime.event_words import BACK, DISPLACED, HELD, RESUME, RobotReport
from pursue_runtime.locations import is_action, is_movement, is_under_way, position_variable
from pursue_runtime.model import Edge, Model, Move, Position
from pursue_runtime.observer.ordering import LEAVE, PersonOrder, Refused
from pursue_runtime.sentences import as_sentence, marked
from pursue_runtime.state import SystemState


class Robots:
    """The robots that are `held` (and why), `displaced` (and why), and of these the ones that are `returning`.

    A goal of a held robot was cancelled by another node: it waits for `_resume_`. A displaced robot is not known to be
    where the state has it. No action begins with it: the command is refused, and the robot returns first.
    """

    def __init__(self, model: Model) -> None:
        self.held: Dict[str, str] = {}
        self.displaced: Dict[str, str] = {}
        self.returning: Set[str] = set()
        self._robots = {position_variable(automaton.name): automaton.name for automaton in model.of_kind("robot")}
        self._names = frozenset(self._robots.values())

    def adopt(self, state: SystemState) -> None:
        """Take the robots as they are in a state."""
        self.held = dict.fromkeys(state.held, "is held")
        self.displaced = dict.fromkeys({*state.displaced, *state.returning}, "is not where the state has it")
        self.returning = set(state.returning)

    def on_report(self, report: RobotReport, location: str) -> str:
        """Take a report about a robot at this location; return why it cannot be ("": it can)."""
        name = report.agent
        if name not in self._names:
            return "expected the name of a robot"
        if report.event == HELD:
            if not is_under_way(location) and name not in self.displaced:
                return f"{name} has no goal"
            self.held.setdefault(name, as_sentence(report.text) or "is held")
        elif report.event == RESUME:
            if self.held.pop(name, None) is None:
                return f"{name} is not held"
        elif report.event == DISPLACED:
            if is_movement(location):
                return f"{name} is on its way"
            self.displaced.setdefault(name, as_sentence(report.text) or "is not where the state has it")
            self.returning |= {name} if is_action(location) else set()
        elif report.event == BACK:
            self._place(name)
        return ""

    def drop(self, name: str) -> None:
        """Wait for this robot no more: it is lost."""
        self.held.pop(name, None)
        self._place(name)

    def on_moves(self, moves: Tuple[Move, ...]) -> None:
        """Take the moves of an event: who sets off need not be where it was."""
        for name, edge in moves:
            if is_movement(edge.target):
                self._place(name)

    def refuse(self, moves: Tuple[Move, ...], values: Mapping[str, int]) -> bool:
        """Return True for a command that begins an action for which a robot is not in its place: it returns first."""
        missing: Set[str] = set()
        for name, edge in moves:
            if not is_under_way(edge.source) and not is_movement(edge.target):
                missing |= {name} & set(self.displaced)
                missing |= self._missing_partners(name, edge, values)
        self.returning |= missing
        return bool(missing)

    def reasons(self) -> List[str]:
        """Return why the mission holds for robots."""
        held = [f"{marked(name)} {why}; publish {name}:{RESUME} to continue" for name, why in sorted(self.held.items())]
        away = sorted(self.returning - set(self.held))
        missing = [f"{marked(name)} {self.displaced[name]}, where the state has it: it is sent back" for name in away]
        return held + missing

    def waiting(self) -> Set[str]:
        """Return the robots for which the mission holds."""
        return set(self.held) | self.returning

    def revision(self) -> Tuple[Tuple[str, ...], Tuple[str, ...], Tuple[str, ...]]:
        """Return the robots that are held, displaced and returning, by name."""
        return tuple(sorted(self.held)), tuple(sorted(self.displaced)), tuple(sorted(self.returning))

    def _place(self, name: str) -> None:
        self.displaced.pop(name, None)
        self.returning.discard(name)

    def _missing_partners(self, doer: str, edge: Edge, values: Mapping[str, int]) -> Set[str]:
        """Return the displaced robots with which `doer` would do this, unless another partner is in its place."""
        missing: Set[str] = set()
        for clause in edge.tests:
            there = {variable for variable, value in clause if values[variable] == value}
            partners = {self._robots.get(variable, "") for variable in there} - {doer}
            if partners and partners <= set(self.displaced):
                missing |= partners
        return missing


class Service:
    """The robots that are `out` of service."""

    def __init__(self, model: Model) -> None:
        self.out: Set[str] = set()
        self._robots = tuple(automaton.name for automaton in model.of_kind("robot"))

    def adopt(self, out: Iterable[str]) -> None:
        """Take the robots as they are in a state."""
        self.out = set(out)

    def after(self, order: Optional[PersonOrder] = None) -> FrozenSet[str]:
        """The robots that are out of service once an order is taken; without one those of now."""
        if order is None or not order.is_service:
            return frozenset(self.out)
        return frozenset(self.out | {order.event} if order.how == LEAVE else self.out - {order.event})

    def check(self, order: PersonOrder, displaced: Mapping[str, str], silent: Collection[str]) -> None:
        """Raise Refused where a robot cannot leave or join now."""
        robot = order.event
        if robot not in self._robots:
            raise Refused(f"there is no robot {robot}; expected one of {', '.join(map(marked, self._robots))}")
        if order.how == LEAVE:
            if robot in self.out:
                raise Refused(f"{marked(robot)} is out of service already")
        elif robot not in self.out:
            raise Refused(f"{marked(robot)} is in service already")
        elif robot in displaced:
            raise Refused(f"{marked(robot)} {displaced[robot]}: bring it back to where it left, and order it again")
        elif controller_of(robot) in silent:
            raise Refused(f"{controller_of(robot)} is silent: start it, and order it again")

    def take(self, order: PersonOrder, position: Position) -> str:
        """Take a robot out of service, or bring it back, and return that as a sentence."""
        self.out, robot = set(self.after(order)), marked(order.event)
        if order.how != LEAVE:
            return f"{robot} is in service again"
        place = position.locations[order.event]
        if is_under_way(place):
            return f"{robot} is out of service: it ends what it does, and nothing else is sent to it"
        return f"{robot} is out of service: nothing is sent to it; it stands at {marked(place)}, and counts there"

    def commanded(self, moves: Sequence[Move]) -> str:
        """Return whom of them the moves of a command would have do something; "": nobody."""
        return next((name for name, edge in moves if name in self.out and not edge.is_end), "")

    @staticmethod
    def unneeded(out: Iterable[str], locations: Mapping[str, str]) -> FrozenSet[str]:
        """Return the controllers of those that stand: they may be silent, unless they command others."""
        return frozenset(controller_of(name) for name in out if not is_under_way(locations[name]))


def controller_of(robot: str) -> str:
    """Return the node that commands a robot, where each has its own."""
    return f"controller_{robot}"
