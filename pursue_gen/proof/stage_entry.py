"""What is known of a network when one stage of a strategy has ended and the next begins.

For each automaton it is known where it may be, with which values of the variables that it alone sets; for every other
variable, which values it may have. Clocks may have any value. More may seem possible than is, never less.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import AbstractSet, Dict, FrozenSet, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.proof.relaxed_reachability import Extent, may_hold
from pursue_gen.tga.begin import State as State
from pursue_gen.tga.network import Automaton, Network

Spot = Tuple[str, Tuple[int, ...]]
"""A location of an automaton, and the values of the variables that it alone sets."""

MOST = 5_000
"""So many states a stage may begin in. Measured on six visitors who must be met, and on a delivery by twenty robots."""


@dataclass(frozen=True)
class Known:
    """`owned`: for each automaton the variables that it alone sets; `spots`: where it may be, with their values;
    `values`: for each other variable what it may be."""

    owned: Mapping[str, Tuple[str, ...]]
    spots: Mapping[str, FrozenSet[Spot]]
    values: Mapping[str, FrozenSet[int]]

    @cached_property
    def extent(self) -> Extent:
        """The locations in which the automata may be, and the values that variables may have."""
        values = dict(self.values)
        for name, owned in self.owned.items():
            for k, variable in enumerate(owned):
                values[variable] = frozenset(some[k] for _, some in self.spots[name])
        return Extent({name: {location for location, _ in spots} for name, spots in self.spots.items()}, values)

    def states(self, part: Network) -> Optional[List[State]]:
        """All states of a part of the network that may be; None where these are more than MOST."""
        own = {name for automaton in part.automata for name in self.owned[automaton.name]}
        others = [name for name, _ in part.variables if name not in own]
        choices: List[Sequence[object]] = [sorted(self.spots[a.name]) for a in part.automata]
        choices += [sorted(self.extent.values[name]) for name in others]
        count = 1
        for choice in choices:
            count *= len(choice)
            if count > MOST:
                return None
        return [self._state(part, others, chosen) for chosen in product(*choices)]

    def _state(self, part: Network, others: Sequence[str], chosen: Sequence[object]) -> State:
        values: Dict[str, int] = {}
        locations = []
        for automaton, spot in zip(part.automata, chosen):
            assert isinstance(spot, tuple)
            locations.append(spot[0])
            values.update(zip(self.owned[automaton.name], spot[1]))
        for name, value in zip(others, chosen[len(part.automata) :]):
            assert isinstance(value, int)
            values[name] = value
        return tuple(locations), tuple(values[name] for name, _ in part.variables)


def at_start(network: Network) -> Known:
    """What is known at the start."""
    first = dict(network.variables)
    owned: Dict[str, Tuple[str, ...]] = {
        a.name: tuple(name for name in first if network.setters[name] == {a.name}) for a in network.automata
    }
    spots = {a.name: frozenset([(a.initial, tuple(first[name] for name in owned[a.name]))]) for a in network.automata}
    every = {name for names in owned.values() for name in names}
    return Known(owned, spots, {name: frozenset([value]) for name, value in first.items() if name not in every})


def moved(known: Known, alive: Network) -> Known:
    """What is known after a time in which `alive` could happen."""
    spots = {a.name: _moved(known.spots[a.name], known, alive, a) for a in alive.automata}
    return Known(known.owned, spots, {name: some | _set(alive, name) for name, some in known.values.items()})


def after_part(known: Known, part: Network, ends: Sequence[State], idle: Optional[Network]) -> Known:
    """What is known after a part of a stage that ended in one of the states; `known`: about all that the part does not
    name. `idle`: what could happen between the end of the part and that of the stage; None: they end together."""
    spots, values = dict(known.spots), dict(known.values)
    index = {name: k for k, (name, _) in enumerate(part.variables)}
    for k, automaton in enumerate(part.automata):
        owned = tuple(index[name] for name in known.owned[automaton.name])
        here = frozenset((locations[k], tuple(state[n] for n in owned)) for locations, state in ends)
        name = automaton.name
        spots[name] = here if idle is None else _moved(here, known, idle, idle.automaton(name))
    for name in index:
        if name in values:
            here_values = frozenset(state[index[name]] for _, state in ends)
            values[name] = here_values if idle is None else here_values | _set(idle, name)
    return Known(known.owned, spots, values)


def _set(network: Network, variable: str) -> AbstractSet[int]:
    """The values that edges give a variable."""
    return {value for _, edge in network.edges for name, value in edge.assign if name == variable}


def _moved(spots: FrozenSet[Spot], known: Known, alive: Network, automaton: Automaton) -> FrozenSet[Spot]:
    """Where an automaton may have come to from these spots, whatever the others do."""
    owned = known.owned[automaton.name]
    found = set(spots)
    pending = list(found)
    while pending:
        location, values = pending.pop()
        now = {name: frozenset([value]) for name, value in zip(owned, values)}
        for edge in automaton.edges:
            if edge.source == location and may_hold(edge.guard, now):
                assigned = dict(edge.assign)
                spot = edge.target, tuple(assigned.get(name, value) for name, value in zip(owned, values))
                if spot not in found:
                    found.add(spot)
                    pending.append(spot)
    return frozenset(found)
