"""What requests mean for the course of a mission, without the network: which of them wait, the oldest first."""

from __future__ import annotations

from itertools import count
from typing import Dict, Iterator, List, NamedTuple, Optional, Set, Tuple

from pursue_gen.language.objectives.request import requests_in
from pursue_gen.language.scenario import Scenario


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
