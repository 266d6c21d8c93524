"""What the objectives of a scenario mean for the course of a mission, without the network: by its events and places.

A mission may end as won only where everything to be reached has happened in time, and nothing was broken before; and as
lost only where an objective is broken. The batteries of robots are never empty while they need them.
"""

from __future__ import annotations

from typing import Dict, FrozenSet, List, Optional, Set, Tuple

from pursue_gen.diagnostics import Span
from pursue_gen.language import network_names as names
from pursue_gen.language.conditions import EventOrCondition
from pursue_gen.language.network_names import going, has_happened
from pursue_gen.language.objectives.base import Breaks
from pursue_gen.language.objectives.endurance import batteries_in
from pursue_gen.language.scenario import Ref, Safety, Scenario
from pursue_gen.tools.simulation.duties import Charges, Duty, OpenRequests
from pursue_gen.tools.simulation.meaning import holds
from pursue_gen.tools.simulation.recorder import EPSILON
from pursue_runtime.event_words import CANCELLED
from pursue_runtime.locations import is_action, is_under_way, place_of
from pursue_runtime.state import LOST, WON, SystemState


def duties_of(scenario: Scenario) -> Tuple[Tuple[int, Safety], ...]:
    """The objectives that are called upon, each time with a limit for the answer, with their numbers; of requests the
    first of their statement."""
    limited = ((k, each) for k, each in enumerate(scenario.safety) if each.limit is not None)
    return tuple((k, each) for k, each in limited if each.told_with(scenario.safety)[0] is each)


class Promises:
    """The objectives of one mission. `problems`: what must never be; `duties`: those of `duties_of`, in their order."""

    def __init__(self, scenario: Scenario, exact: bool = True) -> None:
        """`exact`: nothing comes late, so that a deadline is either kept or missed; False where there are faults."""
        self.problems: List[str] = []
        self._scenario, self._exact = scenario, exact
        self._events: Dict[str, str] = {has_happened(event): event.name for event in scenario.events}
        ends = (way for connection in scenario.connections for way in connection.directions)
        lengths = {way: float(each.distance) for each in scenario.connections for way in each.directions}
        self._lengths: Dict[str, float] = {going(*way): length for way, length in lengths.items()}
        self._ways: Dict[str, FrozenSet[str]] = {going(*way): frozenset(way) for way in ends}
        self._places = [poi.name for poi in scenario.pois]
        self._done: List[List[str]] = [[] for _ in scenario.reach]
        self._counted: Dict[int, float] = {}
        self._since: Dict[int, float] = {}
        self._ended: Dict[str, float] = {}
        self._held: Set[int] = set()  # whose conditions that are to be answered have held in the state before
        self._how = [safety.breaks for safety in scenario.safety]
        named = ((names.safety_objective(k), how.condition) for k, how in enumerate(self._how))
        self._conditions = {name: condition for name, condition in named if condition is not None}
        firsts = (each for each in scenario.patrols if each.order[:1] == (each.place.name,))
        self._ordered = [(scenario.safety.index(patrol), patrol) for patrol in firsts]
        self._turns: Dict[Span, int] = {}
        self._where: Dict[str, str] = {}
        self._broken: Dict[str, float] = {}
        self._levels: Dict[str, float] = {each.agent.name: float(each.capacity) for each in scenario.batteries}
        self._seen: Dict[str, Tuple[float, str]] = {}
        self._charges = Charges(dict(batteries_in(scenario.safety)), self._places)
        self._open = OpenRequests(scenario)
        self._begun: Optional[float] = None
        self._seq = 0
        self._called: Dict[int, float] = {}
        self._was_broken = False
        self._duties = {number: Duty() for number, _ in duties_of(scenario)}

    @property
    def duties(self) -> Tuple[Duty, ...]:
        """How often each of `duties_of` was called upon so far, and how late it was answered at most."""
        return tuple(self._duties.values())

    def on_state(self, state: SystemState, now: float) -> None:
        """The observer publishes a state, at this moment (seconds)."""
        if state.seq > 0 and self._begun is None:
            self._begun = now
        if self._begun is None:
            return
        at = (now - self._begun) / state.unit
        self._check_conditions(state)
        # A deadline that ends now is missed where the mission is lost, and kept where it is not.
        latest = at + EPSILON if state.status == LOST else at - EPSILON
        word = state.event if state.seq > self._seq else ""
        event = self._events.get(word, "")
        self._seq = max(self._seq, state.seq)
        visited = self._visited(state)
        if word.endswith(CANCELLED) and word not in self._events:
            self._cancel(word[: -len(CANCELLED)])
        late = [number for number in range(len(self._scenario.safety)) if self._is_empty(number, latest)]
        late += self._open.on_event(event, at, latest)
        self._charges.on_state(state.locations, at)
        for number, safety in enumerate(self._scenario.safety):
            too_soon = self._is_too_soon(self._how[number], word, at, latest) and state.status != WON
            if number in late or too_soon or self._breaks(number, safety, event, latest, state):
                self._broken.setdefault(safety.text, at)
            if number in visited:
                self._since.pop(number, None)
        self._ended[event] = at
        self._count(at)
        for number, (reach, done) in enumerate(zip(self._scenario.reach, self._done)):
            in_time = reach.within is None or latest <= reach.within
            soon = reach.apart is not None and at - self._counted.get(number, -1e9) < reach.apart - EPSILON
            if event in {ref.name for ref in reach.events} and at > reach.after - EPSILON and in_time and not soon:
                done.append(event)
                self._counted[number] = at
            if not in_time and not reach.is_done(done):
                self._broken.setdefault(reach.text, at)
        if self._exact:
            self._check(state)
            self._check_batteries(state, at)
            self._check_assumed(state)

    def _cancel(self, event: str) -> None:
        """What an order asks for is wanted no longer."""
        self._open.on_cancel(event)
        for number, safety in enumerate(self._scenario.safety):
            if safety.called_by == event:
                self._since.pop(number, None)
                self._called.pop(number, None)

    def _count(self, at: float) -> None:
        """Counts what is called upon since this moment, and takes down how late it is answered."""
        for number, (calls, latest) in self._duties.items():
            if number in self._since and number not in self._called:
                self._called[number] = self._since[number] if number in self._charges else at
                self._duties[number] = Duty(calls + 1, latest)
            elif number not in self._since and number in self._called:
                self._duties[number] = Duty(calls, max(latest or 0.0, at - self._called.pop(number)))
        self._duties.update(self._open.duties)

    def _check_batteries(self, state: SystemState, at: float) -> None:
        """Takes from each battery what its robot has used since the state before, or adds what it has recharged."""
        for battery in self._scenario.batteries:
            name = battery.agent.name
            here = state.locations.get(name, "")
            before, was = self._seen.get(name, (at, here))
            self._seen[name] = (at, here)
            if not is_under_way(was):
                continue
            rate = -float(battery.uses if battery.driving is None or is_action(was) else 0)
            if battery.dock is not None and is_action(was) and place_of(was, self._places) == battery.dock.name:
                rate = float(battery.recharges)
            level = min(float(battery.capacity), self._levels[name] + rate * (at - before))
            if here != was and battery.driving is not None:
                level -= float(battery.driving) * self._lengths.get(was, 0.0)
            if self._levels[name] >= 0 > level + EPSILON * float(battery.uses + (battery.driving or 1)):
                self.problems.append(f"the battery of {name} has run empty")
            self._levels[name] = level

    def _breaks(self, number: int, safety: Safety, event: str, latest: float, state: SystemState) -> bool:
        """True if the objective is broken now."""
        breaks = self._how[number]
        if safety.called_by and safety.order:
            return False  # which of them is answered depends on turns: `_open` sees to it
        if number in self._charges:
            since_full = self._charges.since(number)
            self._since.pop(number, None)
            if since_full is not None:
                self._since[number] = since_full
            return False
        if safety.limit is None:
            over = state.status == WON
            return self._is(breaks.event, event, state) or (not over and self._is_lost(breaks, state))
        since, before = self._since.get(number), number in self._held
        begun = self._is(breaks.begins, event, state)
        self._held.discard(number)
        if begun and not isinstance(breaks.begins, Ref):
            self._held.add(number)
        if self._is(breaks.ends, event, state):
            self._since.pop(number, None)
        elif begun and not before:
            self._since.setdefault(number, latest)
        return since is not None and latest - since > safety.limit

    def _is_empty(self, number: int, latest: float) -> bool:
        """True if a battery by time was needed for too long until now."""
        since = self._charges.since(number)
        return since is not None and latest - since > self._charges.limit(number)

    def _is_too_soon(self, breaks: Breaks, word: str, at: float, latest: float) -> bool:
        """True if an event begins before the pause after another one is over."""
        if breaks.too_soon is None or breaks.last is None or word != names.event(breaks.too_soon.name):
            return False
        ended = self._ended.get(breaks.last.name)
        return ended is not None and 2 * at - latest - ended < breaks.pause

    def _is_lost(self, breaks: Breaks, state: SystemState) -> bool:
        """True if its condition holds, or may hold, or its two agents are together."""
        if breaks.condition is not None:
            return holds(breaks.condition, self._scenario, state.locations, state.values, any)
        spots = {self._spot(state.locations.get(agent, "")) for agent in breaks.pair}
        return len(spots) == 1 and (breaks.place is None or spots == {frozenset((breaks.place,))})

    def _check_conditions(self, state: SystemState) -> None:
        """A mission is lost if and only if a condition of an objective says so, in the next state at the latest."""
        conditions = self._conditions.values()
        broken = any(holds(one, self._scenario, state.locations, state.values, any) for one in conditions)
        lost = any(state.locations.get(name) == names.LOSE for name in self._conditions)
        if lost and not broken:
            self.problems.append(f"state {state.seq} counts as lost, but no condition of an objective is broken there")
        elif self._was_broken and not lost:
            self.problems.append(f"a condition is broken before state {state.seq}, which does not count as lost")
        self._was_broken = broken and not lost

    def _check_assumed(self, state: SystemState) -> None:
        """What is assumed never to hold, or to come, does not, until a mission has seen it broken."""
        for number, assumption in enumerate(self._scenario.assumed, start=1):
            relied_on = state.values.get(names.assumption(number), 0)
            conditions = assumption.conditions
            holding = (holds(each, self._scenario, state.locations, state.values) for each in conditions)
            if relied_on and (any(holding) or number in self._open.too_many):
                self.problems.append(f"state {state.seq}: not so that {assumption.clause}, but not broken")

    def _is(self, what: Optional[EventOrCondition], event: str, state: SystemState) -> bool:
        """True if the event happens now, or the condition holds."""
        if isinstance(what, Ref):
            return event == what.name
        return what is not None and holds(what, self._scenario, state.locations, state.values)

    def _visited(self, state: SystemState) -> Set[int]:
        """The numbers of the places of patrols in order at which one of them arrives now, in its turn."""
        first, before = not self._where, self._where
        self._where = {name: place_of(location, self._places) for name, location in state.locations.items()}
        found: Set[int] = set()
        for number, patrol in self._ordered:
            names = [agent.name for agent in self._scenario.on_patrol(patrol)]
            come = {self._where.get(name, "") for name in names if self._where.get(name) != before.get(name)}
            turn, count = self._turns.get(patrol.span, 0), len(patrol.order)
            for _ in range(count if first else 1):
                if patrol.order[turn] in come:
                    found.add(number + turn)
                    turn = (turn + 1) % count
            self._turns[patrol.span] = turn
            if first:
                self._since.update((other, 0.0) for other in range(number, number + count) if other not in found)
        return found

    def _check(self, state: SystemState) -> None:
        if state.status == WON:
            for reach, done in zip(self._scenario.reach, self._done):
                if not reach.is_done(done):
                    self.problems.append(f"the mission is won, but not '{reach.text}'")
            for text in self._broken:
                self.problems.append(f"the mission is won, but '{text}' was broken")
        elif state.status == LOST and not self._broken:
            self.problems.append("the mission is lost, but no objective is broken")

    def _spot(self, location: str) -> FrozenSet[str]:
        """Where an agent is: a place, or a way by its two ends."""
        return self._ways.get(location) or frozenset((place_of(location, self._places),))
