"""For whom a robot waits at places that hold one (what has to be before its next command, by the strategy's orders of
passage), and what agents do at doors and lifts on their way, by ui.yaml and by what the node for doors says.

An order of passage is an automaton that is called by its place, with a location for each visit: nobody is there yet, or
the robot is. One that has an end has a location more; behind the last visit of others comes the first one again.
"""

from __future__ import annotations

from typing import Any, Callable, Dict, Iterator, List, Mapping, Optional, Sequence, Set, Tuple

from pursue_runtime.doors.keeper import read_doors
from pursue_runtime.doors.lifts import gate_at, read_lifts
from pursue_runtime.doors.opened import NONE_OPENED, Opened
from pursue_runtime.locations import Visit, is_under_way, place_passed, visit_at
from pursue_runtime.model import Model
from pursue_runtime.sentences import listed
from pursue_runtime.state import LIVE, RUNNING, SystemState
from pursue_runtime.strategy import Entry, Strategy
from pursue_runtime.ui.strategies import Strategies


class Turns:
    """Whose turn it is at places, by these strategies."""

    def __init__(self, model: Model, strategies: Strategies) -> None:
        self._model, self._strategies = model, strategies
        self._of: Sequence[Strategy] = ()
        self._leaving: Mapping[Tuple[str, str], List[Entry]] = {}  # by those

    def waits(self, state: SystemState) -> Dict[str, str]:
        """For each agent that waits for others at a place: `waits for bot1 to leave hall2`."""
        if state.status != RUNNING:
            return {}
        strategies = self._strategies.get(state.plan, ())
        if strategies is not self._of:
            self._of, self._leaving = strategies, _leaving(strategies)
        entries = self._leaving
        found = {name: self._waits(state, entries.get((name, here), ())) for name, here in state.locations.items()}
        return {name: text for name, text in found.items() if text}

    def _waits(self, state: SystemState, entries: Sequence[Entry]) -> str:
        """What the first of these commands that is still to come waits for; "": for no visit of another."""
        ahead: List[Tuple[int, List[str]]] = []
        for names, parts in entries:
            visits = [
                (name, visit_at(state.locations.get(name, "")), visit_at(part))
                for name, part in zip(names, parts)
                if place_passed(name)
            ]
            steps = [self._steps(name, now, due) for name, now, due in visits]
            if min(steps, default=0) >= 0:
                missing = [(name, now) for name, now, due in visits if now != due]
                ahead.append((sum(steps), list(self._words(missing))))
        texts = min(ahead, default=(0, []))[1]
        return f"waits for {listed(texts)}" if texts else ""

    def _steps(self, name: str, now: Optional[Visit], due: Optional[Visit]) -> int:
        """How many steps of an order come before this visit; below 0 where it does not come any more."""
        if now is None or due is None:
            return -1
        visits = [visit_at(location) for location in self._model.automaton(name).invariants]
        return (due.rank - now.rank) % len(visits) if all(visits) else due.rank - now.rank

    def _words(self, missing: Sequence[Tuple[str, Optional[Visit]]]) -> Iterator[str]:
        for name, visit in missing:
            if visit is not None:
                robot, place = self._model.shown(visit.robot), self._model.shown(place_passed(name))
                yield f"{robot} to leave {place}" if visit.is_there else f"{robot} to pass {place} first"


def _leaving(strategies: Sequence[Strategy]) -> Mapping[Tuple[str, str], List[Entry]]:
    """For each agent and place the states in which it is commanded to do something there, and which name an order."""
    found: Dict[Tuple[str, str], List[Entry]] = {}
    for strategy in strategies:
        for entry, commands in strategy.all_entries():
            if any(map(place_passed, entry[0])):
                for command in commands:
                    if not is_under_way(command.origin):
                        found.setdefault((command.agent, command.origin), []).append(entry)
    return found


class AtDoors:
    """Who waits for which door or lift, and who rides in one."""

    def __init__(self, settings: Mapping[str, Any], shown: Callable[[str], str]) -> None:
        """`settings`: the content of ui.yaml; `shown`: what people read for a name. Raises DataError."""
        self._doors, self._lifts, self._shown = read_doors(settings), read_lifts(settings), shown
        self._opened = NONE_OPENED
        self._state: Optional[SystemState] = None
        self._let_in: Set[Tuple[str, str]] = set()  # agent and location: its lift was open for it where it gets in

    @property
    def has_some(self) -> bool:
        """Return True if there is a door or a lift."""
        return bool(self._doors or self._lifts)

    def take(self, opened: Opened) -> None:
        """Take for whom doors and lifts are open."""
        self._opened = opened

    def says(self, state: SystemState) -> Dict[str, str]:
        """Return what each agent does that is at one in this state, as in `waits for lift1`."""
        if state.status not in LIVE:
            return {}
        here = state.locations
        self._let_in = {(agent, location) for agent, location in self._let_in if here.get(agent) == location}
        found = {}
        for agent, location in here.items():
            words = " and ".join(self._words(agent, location))
            if words:
                found[agent] = words
        return found

    def _words(self, agent: str, location: str) -> Iterator[str]:
        for name, door in self._doors.items():
            if location in door.asked_by.get(agent, ()) and not self._is_open(name, agent):
                yield f"waits for {self._shown(name)} to open"
        for name, lift in self._lifts.items():
            ends = lift.rides.get(agent, {}).get(location)
            if ends is None:
                continue
            gets_in, gets_out = (self._is_open(gate_at(name, floor), agent) for floor in ends)
            if gets_in:
                self._let_in.add((agent, location))
            rides = (agent, location) in self._let_in
            does = "gets out of" if gets_out else "gets into" if gets_in else "rides in" if rides else "waits for"
            yield f"{does} {self._shown(name)}"

    def _is_open(self, name: str, agent: str) -> bool:
        return agent in self._opened.doors.get(name, ())
