"""Which reports count: those about what was before are over; an end of what several do together waits for all of them.
"""

from __future__ import annotations

from typing import Collection, Dict, List, NamedTuple, Optional, Sequence, Set, Tuple

from pursue_runtime.event_words import Word
from pursue_runtime.locations import is_end
from pursue_runtime.model import Edge, Model, Move, Position
from pursue_runtime.state import SystemState


class Beginnings:
    """The numbers of the states in which agents came to their locations, and did what is done at once.

    A report is published until it is answered; one that a cut link brings late must not end what begins after it, and
    what is done at once is not done twice because its word comes twice.
    """

    def __init__(self) -> None:
        self._numbers: Dict[str, int] = {}
        self._done: Dict[Tuple[str, str], int] = {}  # by agent and event

    def of(self, agent: str, event: str = "") -> int:
        """Return the number of the state in which the agent came to its location, or has since then done the event at
        once; 0: at the start, or not known."""
        return max(self._numbers.get(agent, 0), self._done.get((agent, event), 0))

    def on_moves(self, moves: Sequence[Move], seq: int) -> None:
        """Take the moves that lead to the state of this number; the first is that of the one who does it."""
        self._numbers.update({name: seq for name, edge in moves if edge.source != edge.target})
        for name, edge in moves[:1]:
            self._done[name, edge.word] = seq

    def forget(self) -> None:
        """Take that nothing is known of them any more: every report counts."""
        self._numbers.clear()
        self._done.clear()

    def is_over(self, agent: str, event: str, as_of: Optional[int]) -> bool:
        """Return True for a report of the event, by one that knew the state of this number, if the agent has come to
        its location since, or has done that at once; None: a report without a number, which counts in any state."""
        return as_of is not None and as_of < self.of(agent, event)


ALL, DOER = "all", "doer"
WHOSE = (ALL, DOER)
"""Whose reports end an event: those of all robots that take part, or that of the one who does it alone."""


class Group(NamedTuple):
    """Who does something together that ends with `event`: the one who does it, and the robots that take part."""

    doer: str
    event: str
    robots: Tuple[str, ...]


class OwedReport(NamedTuple):
    """The word of an end that a partner has not reported, and the number of the state in which it began that."""

    event: str
    begun: int


class SharedEnds:
    """The reports of the ends of events that go on.

    `finished`: those who have reported the end; `owing`: partners that were lost when it came: where they report it
    later, they count again. Only robots report for themselves; people and other agents take part until
    the one who does the event has ended it.
    """

    def __init__(self, model: Model, whose: str = ALL) -> None:
        self.finished: Set[str] = set()
        self.owing: Dict[str, OwedReport] = {}
        self._whose = whose
        self._partners: Dict[str, List[str]] = {}  # by location
        self._doers: Dict[str, List[Tuple[str, str]]] = {}  # by location; the word of the end
        for automaton in model.of_kind("robot"):
            for edge in automaton.edges:
                if _ends_with_another(edge):
                    self._partners.setdefault(edge.source, []).append(automaton.name)
        for automaton in model.automata:
            for edge in automaton.edges:
                if edge.source in self._partners and edge.sync == "send" and is_end(edge.source, edge.target):
                    self._doers.setdefault(edge.source, []).append((automaton.name, edge.word))

    def adopt(self, state: SystemState) -> None:
        """Take the reports that a state knows of."""
        self.finished, self.owing = set(state.finished), {}

    def take(self, word: Word, position: Position, lost: Collection[str]) -> Optional[Word]:
        """Take a report; return the one that counts: the same one where it ends nothing that several do.

        None: others still have to report it, or it comes from a robot that reports it for itself alone. A word without
        an agent is that of the one who does it.
        """
        for group in self._groups(position):
            if word.event == group.event and word.agent in ("", group.doer, *group.robots):
                self.finished.add(word.agent or group.doer)
                return self._completed(group, lost)
        return word

    def completed(self, position: Position, lost: Collection[str]) -> Optional[Word]:
        """Return the end that waits for no one any more, now that these are lost; None if there is none."""
        words = (self._completed(group, lost) for group in self._groups(position))
        return next((word for word in words if word is not None), None)

    def awaited(self, name: str, position: Position) -> Tuple[str, ...]:
        """Return on whose reports it waits that this automaton leaves its location."""
        for group in self._groups(position):
            if group.doer == name:
                members = (name, *group.robots) if self._whose == ALL else (name,)
                return tuple(member for member in members if member not in self.finished)
        return (name,)

    def on_moves(self, moves: Tuple[Move, ...], lost: Collection[str], beginnings: Beginnings) -> Set[str]:
        """Take the moves of an event; return who has acted or reported: others were moved by what these did.

        `beginnings`: those of the locations that the moves leave.
        """
        acting: Set[str] = set()
        for name, edge in moves:
            if edge.sync != "receive" or name in self.finished:
                acting.add(name)
            elif _ends_with_another(edge) and name in lost:
                self.owing[name] = OwedReport(edge.word, beginnings.of(name))
            self.finished.discard(name)
        for name in acting:
            self.owing.pop(name, None)
        return acting

    def settles(self, word: Word) -> bool:
        """Return True for a report that its robot owes: it is not lost any more."""
        owed = self.owing.get(word.agent)
        if owed is None or owed.event != word.event or (word.as_of is not None and word.as_of < owed.begun):
            return False
        del self.owing[word.agent]
        return True

    def revision(self) -> Tuple[Tuple[str, ...], Tuple[str, ...]]:
        """Return who has reported, and who owes a report."""
        return tuple(sorted(self.finished)), tuple(sorted(self.owing))

    def _groups(self, position: Position) -> List[Group]:
        """Return those who do something together now, where robots take part in what another one does."""
        groups = []
        for location, partners in self._partners.items():
            robots = tuple(name for name in partners if position.locations[name] == location)
            doers = [doer for doer in self._doers.get(location, ()) if position.locations[doer[0]] == location]
            if robots and doers:
                groups.append(Group(*doers[0], robots))
        return groups

    def _completed(self, group: Group, lost: Collection[str]) -> Optional[Word]:
        waits = group.robots if self._whose == ALL else ()
        missing = {group.doer, *(name for name in waits if name not in lost)} - self.finished
        return None if missing else Word(group.doer, group.event)


def _ends_with_another(edge: Edge) -> bool:
    """Return True for the end of taking part in what another one does."""
    return edge.sync == "receive" and is_end(edge.source, edge.target)
