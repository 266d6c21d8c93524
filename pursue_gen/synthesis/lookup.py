"""What a strategy has for a discrete state: its entries may leave out automata and variables.

The run time has a table of its own (pursue_runtime/strategy.py): missions are judged by this one.
"""

from __future__ import annotations

from typing import AbstractSet, Dict, Generic, List, Mapping, Tuple, TypeVar

from pursue_gen.synthesis.game import Game, State
from pursue_gen.synthesis.strategy import Block, Strategy

Payload = TypeVar("Payload")

Entry = Tuple[Tuple[str, ...], Tuple[str, ...]]
"""The automata and variables that an entry names, and the location or value of each."""

Facts = Mapping[str, object]
"""Automata and variables with the location or value of each."""


class StateTable(Generic[Payload]):
    """Payloads by discrete state. An entry that leaves out automata and variables holds whatever they are."""

    def __init__(self) -> None:
        self._tables: Dict[Tuple[str, ...], Dict[Tuple[str, ...], List[Payload]]] = {}

    def add(self, state: Facts, payload: Payload) -> None:
        """Adds an entry."""
        names = tuple(sorted(state))
        self._tables.setdefault(names, {}).setdefault(tuple(str(state[name]) for name in names), []).append(payload)

    def find(self, state: Facts) -> List[Payload]:
        """What was put there."""
        return [payload for entry in self.holding(state) for payload in self.entered(entry)]

    def entered(self, entry: Entry) -> List[Payload]:
        """What was put where an entry holds."""
        return self._tables.get(entry[0], {}).get(entry[1], [])

    def holding(self, state: Facts) -> List[Entry]:
        """What the entries name that hold there, each once."""
        named = ((names, tuple([str(state.get(name, "")) for name in names])) for names in self._tables)
        return [(names, parts) for names, parts in named if parts in self._tables[names]]

    def standing(
        self, before: Facts, state: Facts, reset: AbstractSet[str], clocks: Mapping[str, AbstractSet[str]]
    ) -> Dict[Entry, bool]:
        """For each entry that holds in a state, whether what it decided before the last move stands: it held then as
        well, and of the clocks that were `reset` none is of an automaton that it names. `clocks`: those of each."""
        held = self.holding(before)
        touched = {name for name, own in clocks.items() if own & reset}
        return {entry: entry in held and touched.isdisjoint(entry[0]) for entry in self.holding(state)}


def blocks_of(strategy: Strategy) -> StateTable[Tuple[int, Block]]:
    """The blocks of a strategy with their numbers (from 1); of parts that are played at once, one each holds."""
    table: StateTable[Tuple[int, Block]] = StateTable()
    for number, block in enumerate(strategy.blocks, start=1):
        table.add(block.state.facts, (number, block))
    return table


def facts_of(game: Game, state: State) -> Facts:
    """A state of a game, by the names of its automata and variables."""
    places = zip(game.automata, state.locations)
    facts: Dict[str, object] = {automaton.name: automaton.locations[k] for automaton, k in places}
    return {**facts, **dict(zip(game.variables, state.values))}
