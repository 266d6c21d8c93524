"""What batteries by time mean for the course of a mission, without the network: by where robots are, and since when."""

from __future__ import annotations

from math import ceil, floor
from typing import Dict, Mapping, NamedTuple, Optional, Sequence

from pursue_gen.language.scenario import Endurance
from pursue_gen.tools.simulation.recorder import EPSILON
from pursue_runtime.locations import place_of


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
