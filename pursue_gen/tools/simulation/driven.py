"""How far each robot drives in one mission."""

from __future__ import annotations

from typing import Dict, Tuple

from pursue_gen.language.network_names import going
from pursue_gen.language.scenario import Scenario
from pursue_runtime.state import SystemState


class Driven:
    """The ways that robots have set off on. `units`: their lengths together for each robot, in the scenario's units of
    distance."""

    def __init__(self, scenario: Scenario) -> None:
        self.units = {agent.name: 0.0 for agent in scenario.agents if agent.controllable and agent.mobile is not None}
        self._lengths: Dict[Tuple[str, str], float] = {
            (name, going(*end)): float(way.distance)
            for name in self.units
            for way in scenario.ways_of(name)
            for end in way.directions
        }
        self._places: Dict[str, str] = {}

    def on_state(self, state: SystemState) -> None:
        """The observer publishes a state."""
        for name in self.units:
            place = state.locations.get(name, "")
            if place != self._places.get(name):
                self.units[name] += self._lengths.get((name, place), 0.0)
                self._places[name] = place
