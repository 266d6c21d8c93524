"""What batteries by time mean for the course of a mission, without the network: by where robots are, and since when."""

from __future__ import annotations

from typing import Dict, Mapping, NamedTuple, Optional, Sequence

from pursue_gen.language.scenario import Endurance
from pursue_gen.tools.simulation.recorder import EPSILON
from pursue_runtime.locations import place_of


class _Battery(NamedTuple):
    """`full`: the moment since which it is used; `came`: since when its robot is at the charger, None while away."""

    full: float
    came: Optional[float]


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
                known = _Battery(at, at - float(battery.charge) if there else None)
            elif there and known.came is None:
                known = known._replace(came=at)
            elif not there and known.came is not None:
                full = at - known.came > float(battery.charge) - EPSILON
                known = _Battery(at if full else known.full, None)
            self._known[number] = known

    def since(self, number: int) -> Optional[float]:
        """Since when the battery is used by a robot that is away from its charger; None for one that is there."""
        known = self._known.get(number)
        return None if known is None or known.came is not None else known.full
