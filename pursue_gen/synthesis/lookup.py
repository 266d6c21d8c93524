"""The blocks of a strategy that hold in a discrete state."""

from __future__ import annotations

from typing import Dict, List, Tuple

from pursue_gen.synthesis.strategy import Block, DiscreteState, Strategy

Names = Tuple[Tuple[str, ...], Tuple[str, ...]]
"""Names of automata, and names of variables."""


class Blocks:
    """The blocks of a strategy by discrete state. One that does not name all automata and variables holds whatever the
    others are."""

    def __init__(self, strategy: Strategy) -> None:
        self._tables: Dict[Names, Dict[DiscreteState, Tuple[int, Block]]] = {}
        for number, block in enumerate(strategy.blocks, start=1):
            self._tables.setdefault(_names(block.state), {})[block.state] = number, block

    def find_all(self, state: DiscreteState) -> List[Tuple[int, Block]]:
        """The number (from 1) and the block, of each that holds there: of parts that are played at the same time, one
        each."""
        places, values = dict(state.locations), dict(state.values)
        found: List[Tuple[int, Block]] = []
        for (automata, variables), table in self._tables.items():
            if not (places.keys() >= set(automata) and values.keys() >= set(variables)):
                continue
            some = DiscreteState(
                tuple((name, places[name]) for name in automata), tuple((name, values[name]) for name in variables)
            )
            if some in table:
                found.append(table[some])
        return found


def _names(state: DiscreteState) -> Names:
    return tuple(name for name, _ in state.locations), tuple(name for name, _ in state.values)
