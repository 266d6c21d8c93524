"""What requests, and batteries by time, mean for the course of a mission, without the network: which requests wait, the
oldest first; where robots are, and since when."""

from __future__ import annotations

from itertools import count
from math import ceil, floor
from typing import Dict, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Set, Tuple

from pursue_gen.language.objectives.request import requests_in
from pursue_gen.language.scenario import Endurance, Scenario
from pursue_gen.tools.simulation.recorder import EPSILON
from pursue_runtime.locations import place_of


class Duty(NamedTuple):
    """How often an objective was called upon in a mission, and how many time units its latest answer took; None where
    there was none."""

    calls: int = 0
    latest: Optional[float] = None


class OpenRequests:
    """The requests of one mission, by the numbers of the first objectives of their statements. Moments are in time
    units."""

    def __init__(self, scenario: Scenario) -> None:
        self._requests = dict(requests_in(scenario.safety))
        self._waiting: Dict[int, List[Tuple[float, float]]] = {number: [] for number in self._requests}
        self._duties = {number: Duty() for number in self._requests}
        self._assumptions = dict(zip(self._requests, count(len(scenario.assumptions) + 1)))
        self.too_many: Set[int] = set()
        """The numbers of the assumptions that the last event has broken: as many were open as may be."""

    @property
    def duties(self) -> Dict[int, Duty]:
        """How often each was called upon so far, and how late it was answered at most."""
        return self._duties

    def on_cancel(self, event: str) -> None:
        """The oldest request with this event is wanted no longer."""
        for number, request in self._requests.items():
            if event == request.trigger.name:
                del self._waiting[number][:1]

    def on_event(self, event: str, at: float, latest: float) -> Iterator[int]:
        """An event happens, "" where none does: the numbers of those whose oldest one has waited for too long now.
        `latest`: the moment as deadlines count it."""
        self.too_many = set()
        for number, request in self._requests.items():
            waiting, duty = self._waiting[number], self._duties[number]
            if waiting and latest - waiting[0][1] > request.deadline:
                yield number
            if event == request.response.name and waiting:
                since, _ = waiting.pop(0)
                self._duties[number] = duty._replace(latest=max(duty.latest or 0.0, at - since))
            elif event == request.trigger.name and len(waiting) < request.most:
                waiting.append((at, latest))
                self._duties[number] = duty._replace(calls=duty.calls + 1)
            elif event == request.trigger.name:
                self.too_many.add(self._assumptions[number])


class _Battery(NamedTuple):
    """`parts`: what was in it at the moment `since`, from which on it is used; `came`: since when its robot is at the
    charger, None while away."""

    since: float
    came: Optional[float]
    parts: int


class Charges:
    """The batteries by time of one mission, by the numbers of their objectives. Moments are in time units."""

    def __init__(self, batteries: Mapping[int, Endurance], places: Sequence[str]) -> None:
        self._batteries, self._places = batteries, places
        self._known: Dict[int, _Battery] = {}

    def __contains__(self, number: int) -> bool:
        return number in self._batteries

    def on_state(self, locations: Mapping[str, str], at: float) -> None:
        """Agents are at these locations from this moment on."""
        for number, battery in self._batteries.items():
            there = place_of(locations.get(battery.agent.name, ""), self._places) == battery.dock.name
            known = self._known.get(number)
            if known is None:
                known = _Battery(at, at - float(battery.charge) if there else None, battery.parts)
            elif there and known.came is None:
                known = known._replace(came=at)
            elif not there and known.came is not None:
                known = _left(battery, known, known.came, at)
            self._known[number] = known

    def since(self, number: int) -> Optional[float]:
        """Since when the battery is used by a robot that is away from its charger; None for one that is there."""
        known = self._known.get(number)
        return None if known is None or known.came is not None else known.since

    def limit(self, number: int) -> float:
        """How long it lasts since then."""
        return float(self._batteries[number].part * self._known[number].parts)


def _left(battery: Endurance, before: _Battery, came: float, at: float) -> _Battery:
    """The battery of a robot that leaves its charger: whole parts that were left are more by those that are done."""
    done = floor((at - came + EPSILON) / float(battery.part_charge))
    if not done:
        return before._replace(came=None)
    left = before.parts - ceil((came - before.since - EPSILON) / float(battery.part))
    return _Battery(at, None, min(battery.parts, left + done))
