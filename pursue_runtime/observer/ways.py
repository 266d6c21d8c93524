"""Ways of the map in the observer: which of them are blocked, and how robots turn round there."""

from __future__ import annotations

from typing import AbstractSet, Any, Dict, Iterable, Mapping, Optional, Set, Tuple

from pursue_runtime.data import DataError
from pursue_runtime.event_words import BLOCKED, FREE, STUCK, RobotReport
from pursue_runtime.locations import is_movement, movement
from pursue_runtime.model import Model, Move
from pursue_runtime.sentences import as_sentence, marked

Way = Tuple[str, str]
"""The two places that a way connects, in alphabetical order."""

Block = Tuple[str, ...]
"""A way, and behind it the agent that alone cannot take it; where there is none it is blocked for all."""


class Ways:
    """The ways that are `blocked`; `turns`: how the robots that could not go on would set out for where they come from.
    """

    def __init__(self, model: Model) -> None:
        self.blocked: Set[Block] = set()
        self.turns: Dict[str, Move] = {}
        self.model = model
        self._stuck: Set[Block] = set()  # who has been stuck where: the second time it does not get that way again

    def on_report(self, report: RobotReport, location: str, is_lost: bool) -> Tuple[str, str]:
        """Take a report that a way is blocked or free, or that an agent is stuck: of an agent at this location, or ("")
        of the named movement, which is blocked for all.

        Return why it cannot be ("": it can), and why the agent is lost now ("": it is not).
        """
        name, why = report.agent, ""
        way = way_of(self.model, location or name)
        if way is None or (report.event == STUCK and not location):
            return "expected the name of a movement, such as going_a_to_b, or of an agent that moves", ""
        if report.event == FREE:
            self.blocked = {block for block in self.blocked if block[:2] != way}
            self._stuck = {block for block in self._stuck if block[:2] != way}
            return "", ""
        block = (*way, name) if location else way
        if location and not is_lost:
            turn = way_back(self.model, name, location)
            if turn and self.blocked.isdisjoint((way, block)) and self.model.automaton(name).is_robot:
                self.turns[name] = turn
            found = f"has found that {in_words(way)} is blocked" if report.event == BLOCKED else "cannot go on"
            why = f"gave up {as_sentence(report.text)}" if report.text else found
            if block in self._stuck:
                self.blocked.add(block)
            self._stuck.add(block)
        if report.event == BLOCKED:
            self.blocked.add(block)
        return "", why

    def revision(self) -> Tuple[Tuple[Block, ...], Tuple[str, ...]]:
        """Return the blocked ways, and the robots that are to turn round."""
        return tuple(sorted(self.blocked)), tuple(sorted(self.turns))


def way_of(model: Model, location: str) -> Optional[Way]:
    """Return the way that the movement at this location takes; None if no agent of the model moves there."""
    for automaton in model.automata:
        if is_movement(location) and location in automaton.invariants:
            ends = {place for edge in automaton.edges for place in (edge.source, edge.target)
                    if location in (edge.source, edge.target)} - {location}
            if len(ends) == 2:
                return min(ends), max(ends)
    return None


def way_back(model: Model, robot: str, location: str) -> Optional[Move]:
    """Return the move with which this robot, which moves at this location, would set out from there to where it comes
    from; None if the model has none, or other automata take part in it."""
    edges = model.automaton(robot).edges
    origins = {edge.source for edge in edges if edge.target == location}
    for end in edges:
        for edge in model.automaton(robot).edges_from(end.target) if end.source == location else ():
            leads_back = any(other.source == edge.target and other.target in origins for other in edges)
            if is_movement(edge.target) and leads_back and not _has_receivers(model, edge.word):
                return Move(robot, edge)
    return None


def _has_receivers(model: Model, word: str) -> bool:
    return any(edge.word == word and edge.sync == "receive" for automaton in model.automata for edge in automaton.edges)


def in_words(way: Block) -> str:
    """Return the way in words, as in "the way between a and b", as part of a sentence."""
    return f"the way between {marked(way[0])} and {marked(way[1])}"


def blocked_reason(blocks: AbstractSet[Block], avoided: AbstractSet[Block] = frozenset()) -> str:
    """Return that these ways are blocked but for those that are `avoided`; "" if there are none."""
    left = sorted(block for block in blocks - avoided if block[:2] not in avoided)
    who = (" for " + marked(block[2]) if block[2:] else "" for block in left)
    return " and ".join(f"{in_words(block)} is blocked{name}" for block, name in zip(left, who))


def check_avoids(answer: Mapping[str, Any], blocks: Iterable[Block]) -> None:
    """Raise DataError if a command of a planner's answer sends an agent along a way that is blocked for it, or cannot
    be read."""
    for block in blocks:
        movements = {movement(*block[:2]), movement(*reversed(block[:2]))}
        try:
            commands = {
                command["to"]
                for data in (*answer["strategies"].values(), answer["people"] or {})
                for entry in data.get("strategy", ())
                for command in entry["commands"]
                if command["agent"] in (block[2:] or (command["agent"],))
            }
        except (AttributeError, KeyError, TypeError) as problem:
            raise DataError(f"its strategies lack or misspell something: {problem!r}") from problem
        if not movements.isdisjoint(commands):
            raise DataError(f"it uses {in_words(block)}, which is blocked; --planner has to be of this version")
