"""Where everything is in the mission: a `transitions` machine for each automaton, variables, clocks.

Moments are seconds of ROS time, delays are time units.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Dict, Iterable, List, Optional, Tuple

from transitions import Machine

from pursue_runtime.model import Automaton, Edge, Model, Move, Position
from pursue_runtime.zones import due, holds


class AutomatonMachine:
    """Where one automaton is: a `transitions` machine whose triggers are the words of its edges."""

    def __init__(self, automaton: Automaton) -> None:
        self._model = SimpleNamespace()  # the machine gives it a state, and names that scenarios choose
        self._machine = Machine(
            model=self._model, states=list(automaton.invariants), initial=automaton.initial, auto_transitions=False
        )
        for edge in automaton.edges:
            self._machine.add_transition(edge.word, edge.source, edge.target)

    @property
    def location(self) -> str:
        """The location."""
        return str(self._model.state)

    def take(self, edge: Edge) -> None:
        """Takes the edge, which starts where the automaton is.

        Several edges of a location may have one word, and the model has chosen between them by their guards: so the
        machine is set to the target. Its own way there, by trigger and conditions, took a quarter of a reaction.
        """
        if edge.word not in self._machine.get_triggers(self.location):
            raise AssertionError(f"{edge.word} does not start at {self.location}")
        self._machine.set_state(edge.target, self._model)


class Automata:
    """The automata, the variables and the clocks. `unit` is the length of a time unit in seconds."""

    def __init__(self, model: Model, unit: float) -> None:
        self.model = model
        self.unit = unit
        self._machines = {automaton.name: AutomatonMachine(automaton) for automaton in model.automata}
        self._values = dict(model.variables)
        self._zeros: Dict[str, float] = {}  # the moment of the last reset of each clock

    def start(self, now: float) -> None:
        """Every clock is zero."""
        self._zeros = dict.fromkeys(self.model.clocks, now)

    def location_of(self, name: str) -> str:
        """The location of an automaton, "" if there is none of this name."""
        return self._machines[name].location if name in self._machines else ""

    def is_at(self, place: Optional[Tuple[str, str]]) -> bool:
        """True where the automaton is at this location (never at None)."""
        return place is not None and self.location_of(place[0]) == place[1]

    def position(self, now: float) -> Position:
        """Locations, variables and the clocks of this moment."""
        locations = {name: machine.location for name, machine in self._machines.items()}
        clocks = {clock: (now - self._zeros.get(clock, now)) / self.unit for clock in self.model.clocks}
        return Position(locations, dict(self._values), clocks)

    def take(self, moves: Iterable[Move], now: float) -> None:
        """Moves the automata of one event."""
        for name, edge in moves:
            self._machines[name].take(edge)
            self._values.update(edge.assign)
            self._zeros.update(dict.fromkeys(edge.resets, now))

    def bounds(self, position: Position, *kinds: str) -> List[Tuple[str, float]]:
        """The automata (of these kinds, if any are named) that must move by some moment, and how far that is.

        In time units; negative: the moment has passed.
        """
        return [
            (automaton.name, bound.bound - position.clocks[bound.left])
            for automaton in (self.model.of_kind(*kinds) if kinds else self.model.automata)
            for bound in automaton.invariants[position.locations[automaton.name]]
        ]

    def internal_delays(self, position: Position) -> List[float]:
        """How far the steps are that objectives take by themselves, if only time passes."""
        delays = (due([edge.when], position.clocks) for _, edge in self._internal_edges(position))
        return [delay for delay in delays if delay is not None]

    def internal_move(self, position: Position) -> Optional[Tuple[Move, ...]]:
        """The step that an objective takes by itself now (`never_with`)."""
        for automaton, edge in self._internal_edges(position):
            if holds(edge.when, position.clocks):
                return (Move(automaton.name, edge),)
        return None

    def _internal_edges(self, position: Position) -> List[Tuple[Automaton, Edge]]:
        return [
            (automaton, edge)
            for automaton in self.model.of_kind("safety")
            for edge in automaton.edges_from(position.locations[automaton.name])
            if edge.sync == "own" and not edge.controllable and edge.allowed(position.values)
        ]
