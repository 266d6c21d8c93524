"""The value of the synthesis stage: a strategy, as zones and commands for each discrete state of a network.

All bounds are exact (Fraction, in time units): a reaction delay of 1/10 gives bounds in tenths.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Tuple, Union

from pursue_gen.tga.network import Constraint as Constraint
from pursue_gen.tga.network import Edge

Zone = Tuple[Constraint, ...]
"""All of these constraints, and every clock >= 0; the empty zone tuple `()` is: always."""


@dataclass(frozen=True)
class DiscreteState:
    """Where every automaton is, in system order, and the value of every variable, in order of declaration."""

    locations: Tuple[Tuple[str, str], ...]
    values: Tuple[Tuple[str, int], ...]


@dataclass(frozen=True)
class Move:
    """One automaton's part of a joint move."""

    automaton: str
    edge: Edge


@dataclass(frozen=True)
class Command:
    """In any of the zones, take the joint move: the sender (or owner of a tau edge) first, then the receivers."""

    zones: Tuple[Zone, ...]
    moves: Tuple[Move, ...]


@dataclass(frozen=True)
class Block:
    """What to do in one discrete state: wait in any of the zones of `wait`, else the command whose zone holds."""

    state: DiscreteState
    wait: Tuple[Zone, ...]
    commands: Tuple[Command, ...]


@dataclass(frozen=True)
class Strategy:
    """A strategy for the controller, or (`counter`) one for the environment that shows why the controller loses."""

    blocks: Tuple[Block, ...]
    counter: bool = False


ZoneKey = Tuple[int, Union[str, int], int]
"""Where a zone stands in a strategy: number of the block, "wait" or number of the command in it, number of the zone."""
