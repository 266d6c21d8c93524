"""The state of the automata of a mission: a `transitions` machine for each one, variables, clocks.

Times are seconds of ROS time, delays are time units.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Dict, Iterable, List, Mapping, MutableMapping, Optional, Sequence, Tuple
from weakref import WeakKeyDictionary

from transitions import Machine

from pursue_runtime.model import Automaton, Edge, Model, Move, Position
from pursue_runtime.needs import TRANSITIONS, require
from pursue_runtime.state import SystemState
from pursue_runtime.zones import due, holds

require(TRANSITIONS)

_machines: MutableMapping[Model, Dict[str, Machine]] = WeakKeyDictionary()


def machines_of(model: Model) -> Dict[str, Machine]:
    """Return the `transitions` machine of each automaton, by name: locations are its states, the words of edges its
    triggers. A process builds them once for each model; they keep no location."""
    if model not in _machines:
        _machines[model] = {automaton.name: _machine(automaton) for automaton in model.automata}
    return _machines[model]


def _machine(automaton: Automaton) -> Machine:
    machine = Machine(model=None, states=list(automaton.invariants), initial=automaton.initial, auto_transitions=False)
    for edge in automaton.edges:
        machine.add_transition(edge.word, edge.source, edge.target)
    return machine


class AutomatonMachine:
    """One automaton of a mission: its location, on a `transitions` machine.

    The machine knows which words leave a location; guards, clocks and the receivers of a word belong to several
    automata at once, so the model evaluates them and this class applies the edge that it has chosen.
    """

    def __init__(self, machine: Machine) -> None:
        self._machine = machine
        self._model = SimpleNamespace()
        machine.set_state(str(machine.initial), self._model)

    @property
    def location(self) -> str:
        """Return the current location."""
        return str(self._model.state)

    def take(self, edge: Edge) -> None:
        """Take an edge that leaves the current location.

        The state is set directly: several edges of a location may have the same word, and evaluating the trigger's
        conditions once more took a quarter of a reaction. Raises AssertionError for an edge from another location.
        """
        if self.location not in self._machine.events[edge.word].transitions:
            raise AssertionError(f"{edge.word} does not start at {self.location}")
        self._machine.set_state(edge.target, self._model)

    def set(self, location: str) -> None:
        """Set the location. Raises ValueError if there is none of this name."""
        self._machine.set_state(location, self._model)


class Automata:
    """The automata, variables and clocks of a mission; `unit` is the length of a time unit in seconds.

    Requires times, in seconds, that never go back; ensures that no clock is below 0.
    """

    def __init__(self, model: Model, unit: float) -> None:
        self.model = model
        self.unit = unit
        self._machines = {name: AutomatonMachine(machine) for name, machine in machines_of(model).items()}
        self._values = dict(model.variables)
        self._zeros: Dict[str, float] = {}  # the time of the last reset of each clock
        self._position: Optional[Tuple[float, Position]] = None  # the last that was computed, and its time
        self._internal = {automaton.name: _Internal(automaton) for automaton in model.of_kind("safety")}

    def start(self, now: float) -> None:
        """Set every clock to zero at the time `now`."""
        self._zeros, self._position = dict.fromkeys(self.model.clocks, now), None

    def extend(self, model: Model, now: float) -> None:
        """Go on with a model that has more: what is new is as at the start, with clocks that begin now.

        Requires all that the present model has; ensures that none of it changes.
        """
        locations = {name: machine.location for name, machine in self._machines.items()}
        self.model, self._position = model, None
        self._machines = {name: AutomatonMachine(machine) for name, machine in machines_of(model).items()}
        for name, location in locations.items():
            self._machines[name].set(location)
        self._values = {**model.variables, **self._values}
        self._zeros = {**dict.fromkeys(model.clocks, now), **self._zeros}
        self._internal = {automaton.name: _Internal(automaton) for automaton in model.of_kind("safety")}

    def adopt(self, state: SystemState) -> None:
        """Set locations, variables and clocks as they are in a state. Requires a state of this model; raises ValueError
        for a location that it does not have."""
        for name, location in state.locations.items():
            self._machines[name].set(location)
        self._values = dict(state.values)
        self._zeros = {clock: state.stamp - value * self.unit for clock, value in state.clocks.items()}
        self._position = None

    def location_of(self, name: str) -> str:
        """Return the location of an automaton, "" if there is none of this name."""
        return self._machines[name].location if name in self._machines else ""

    def is_won(self) -> bool:
        """Return True if the goal is reached."""
        goal = self.model.goal
        return bool(goal) and all(self.location_of(name) == location for name, location in goal)

    def lost(self) -> Tuple[str, ...]:
        """Return the automata that are where they must not be."""
        return tuple(name for name, location in self.model.bad if self.location_of(name) == location)

    def position(self, now: float) -> Position:
        """Return the locations, variables and clocks at the time `now`; what is returned is not changed any more.

        A reaction asks for the same moment several times: it is computed once.
        """
        known = self._position
        if known is None or known[0] != now:
            locations = {name: machine.location for name, machine in self._machines.items()}
            clocks = {clock: (now - self._zeros.get(clock, now)) / self.unit for clock in self.model.clocks}
            self._position = known = now, Position(locations, dict(self._values), clocks)
        return known[1]

    def take(self, moves: Iterable[Move], now: float) -> None:
        """Apply the moves of one event. Requires an edge from its location for each automaton (else AssertionError), at
        most one; ensures that the clocks that these reset are 0 at `now`."""
        self._position = None
        for name, edge in moves:
            self._machines[name].take(edge)
            self._values.update(edge.assign)
            self._zeros.update(dict.fromkeys(edge.resets, now))

    def turn(self, moves: Sequence[Move], now: float) -> None:
        """Apply moves of robots that turned round on their way at that time: their edges start at its other end."""
        for name, edge in moves:
            self._machines[name].set(edge.source)
        self.take(moves, now)

    def set_clocks(self, since: Mapping[str, float]) -> None:
        """Set clocks, by the times since which they run. Requires clocks of the model."""
        self._position = None
        self._zeros.update(since)

    def set_values(self, values: Mapping[str, int]) -> None:
        """Set variables. Requires variables of the model."""
        self._position = None
        self._values.update(values)

    def bounds(self, position: Position, *kinds: str) -> List[Tuple[str, float]]:
        """Return the automata whose invariant bounds their stay, and the time units until then (negative: overdue).

        Only automata of the given kinds, if any are given.
        """
        return [
            (automaton.name, bound.bound - position.clocks[bound.left])
            for automaton in (self.model.of_kind(*kinds) if kinds else self.model.automata)
            for bound in self.model.bounds_of(automaton.name, position.locations[automaton.name], position.values)
        ]

    def internal_delays(self, position: Position) -> List[float]:
        """Return the delays (time units) until internal edges of objectives are enabled, if only time passes."""
        delays = (due([edge.when], position.clocks) for _, edge in self._internal_edges(position))
        return [delay for delay in delays if delay is not None]

    def internal_move(self, position: Position) -> Optional[Tuple[Move, ...]]:
        """Return the internal edge of an objective that is enabled now (`never_with`), None if there is none."""
        for automaton, edge in self._internal_edges(position):
            if holds(edge.when, position.clocks):
                return (Move(automaton.name, edge),)
        return None

    def _internal_edges(self, position: Position) -> List[Tuple[Automaton, Edge]]:
        return [
            (automaton, edge)
            for automaton in self.model.of_kind("safety")
            for edge in self._internal[automaton.name].at(position.locations[automaton.name], position.values)
            if edge.allowed(position.values)
        ]


class _Internal:
    """The internal edges of an objective, found by what their first clause tests: where every place holds one robot,
    there are thousands."""

    def __init__(self, automaton: Automaton) -> None:
        self._always: Dict[str, List[Tuple[int, Edge]]] = {}
        self._tested: Dict[str, Dict[str, Dict[int, List[Tuple[int, Edge]]]]] = {}
        for number, edge in enumerate(automaton.edges):
            if edge.sync == "own" and not edge.controllable:
                if not edge.tests:
                    self._always.setdefault(edge.source, []).append((number, edge))
                for name, value in edge.tests[0] if edge.tests else ():
                    by_name = self._tested.setdefault(edge.source, {}).setdefault(name, {})
                    by_name.setdefault(value, []).append((number, edge))

    def at(self, location: str, values: Mapping[str, int]) -> List[Edge]:
        """Those there of which the first clause holds, in order."""
        found = dict(self._always.get(location, ()))
        for name, by_value in self._tested.get(location, {}).items():
            found.update(by_value.get(values[name], ()))
        return [found[number] for number in sorted(found)]
