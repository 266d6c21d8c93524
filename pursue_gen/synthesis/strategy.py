"""The value of the synthesis stage: a strategy, as zones and commands for each discrete state of a network.

All bounds are exact (Fraction, in time units): a reaction delay of 1/10 gives bounds in tenths.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Callable, FrozenSet, Iterable, Iterator, List, Mapping, Optional, Tuple, Union

from pursue_gen.tga.network import Constraint as Constraint
from pursue_gen.tga.network import Edge, Network
from pursue_gen.tga.passages import Passage, with_passages
from pursue_gen.tga.scale import common_denominator
from pursue_gen.tga.tours import Tour, with_tours
from pursue_gen.tga.watchers import Watcher, with_watchers

Place = Tuple[str, str]
"""An automaton and one of its locations; as a milestone also a variable and one of its values."""

ZoneKey = Tuple[int, Union[str, int], int]
"""Where a zone stands in a strategy: number of the block, "wait" or number of the command in it, number of the zone."""

Zone = Tuple[Constraint, ...]
"""All of these constraints, and every clock >= 0; the empty zone tuple `()` is: always."""


@dataclass(frozen=True)
class DiscreteState:
    """Where every automaton is, in system order, and the value of every variable, in order of declaration."""

    locations: Tuple[Tuple[str, str], ...]
    values: Tuple[Tuple[str, int], ...]

    @property
    def names(self) -> Tuple[FrozenSet[str], FrozenSet[str]]:
        """The automata that it names, and the variables."""
        return frozenset(name for name, _ in self.locations), frozenset(name for name, _ in self.values)

    @property
    def facts(self) -> Mapping[str, object]:
        """Both, by name."""
        return {**dict(self.locations), **dict(self.values)}


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

    @property
    def zones(self) -> Iterator[Zone]:
        """Its zones, those in which to wait first."""
        yield from self.wait
        for command in self.commands:
            yield from command.zones

    def with_locations(self, locations: Iterable[Place]) -> Block:
        """The same where these automata are."""
        return replace(self, state=replace(self.state, locations=tuple(locations)))


@dataclass(frozen=True)
class Strategy:
    """A strategy for the controller, or (`counter`) one for the environment that shows why the controller loses.

    One in `stages` has for each of them its milestones, locations or values of variables to be reached, the goal last;
    the stage ends when all of them are. A block is for one milestone: the one that it names and is not at, of the first
    stage that is not over.

    One in `shares` has for each of them the places that it is to avoid, of automata that no other share names. Shares
    are played at the same time, by different agents: a block belongs to the one whose places it names, at least one of
    them (see `proof.shares`). A strategy has stages or shares, or neither. `watchers` and `tours`: automata that the
    network has beside its own; a share that names a watcher may have the objective in its place.

    One with `passages` has an automaton for each of them, too (see `tga.tours`). A block is for the one agent that
    it commands, or that it tells to wait, and names what that has to know (see `proof.passages`).

    `left_out_clocks`: pauses of the environment (see `tga.pauses`) on which it does not rely. Its zones do not compare
    them, it wins whatever they are, and what only resets them makes no command stale.
    """

    blocks: Tuple[Block, ...]
    counter: bool = False
    stages: Tuple[Tuple[Place, ...], ...] = ()
    left_out_clocks: Tuple[str, ...] = ()
    shares: Tuple[Tuple[Place, ...], ...] = ()
    watchers: Tuple[Watcher, ...] = ()
    passages: Tuple[Passage, ...] = ()
    tours: Tuple[Tour, ...] = ()

    @property
    def in_parts(self) -> bool:
        """True if its blocks do not all name the same: it has stages, shares or passages."""
        return bool(self.stages or self.shares or self.passages)

    @cached_property
    def commanded(self) -> Tuple[str, ...]:
        """The automata that it commands, in the order of their first commands."""
        return tuple(dict.fromkeys(command.moves[0].automaton for b in self.blocks for command in b.commands))

    def numbers_of(self, stage: int, place: Place) -> Tuple[int, ...]:
        """The numbers of the blocks that lead to a milestone; of a share: `place` is its first one."""
        return tuple(n for n, part in enumerate(self.parts) if part == (stage, place))

    def commanded_by(self, share: int) -> FrozenSet[str]:
        """The automata that a share commands."""
        blocks = (self.blocks[number] for number in self.numbers_of(share, self.shares[share][0]))
        return frozenset(command.moves[0].automaton for block in blocks for command in block.commands)

    def shared_out(self) -> Iterator[Tuple[FrozenSet[str], FrozenSet[str]]]:
        """For each share the automata that it commands, and those of the promises that these keep."""
        followed = {watcher.name for watcher in self.watchers}
        for number, places in enumerate(self.shares):
            yield self.commanded_by(number), frozenset(name for name, _ in places) - followed

    @cached_property
    def parts(self) -> Tuple[Optional[Tuple[int, Place]], ...]:
        """For each block its stage and milestone, or its share and the first place of that, or with passages the number
        of its agent, and that agent; None where it has none."""
        return tuple(map(self._part, self.blocks))

    def _part(self, block: Block) -> Optional[Tuple[int, Place]]:
        places = {**{name: str(value) for name, value in block.state.values}, **dict(block.state.locations)}
        if self.passages:
            senders = {command.moves[0].automaton for command in block.commands}
            agents = [k for k, name in enumerate(self.commanded) if name in (senders or places)]
            return (agents[0], (self.commanded[agents[0]], "")) if len(agents) == 1 else None
        if self.shares:
            own = [k for k, avoided in enumerate(self.shares) if any(name in places for name, _ in avoided)]
            return (own[0], self.shares[own[0]][0]) if len(own) == 1 else None
        for stage, milestones in enumerate(self.stages):
            open_ones = [place for place in milestones if places.get(place[0]) != place[1]]
            if open_ones:
                named = [place for place in open_ones if place[0] in places]
                return (stage, named[0]) if len(named) == 1 else None
        return None

    @cached_property
    def scale(self) -> int:
        """The least scale in which all of its bounds are integers."""
        return common_denominator(constraint.bound for constraint in self.constraints)

    @cached_property
    def constraints(self) -> Tuple[Constraint, ...]:
        """Those of all of its zones; one that stands in many places perhaps once."""
        zones = {id(zone): zone for block in self.blocks for zone in block.zones}
        return tuple({id(constraint): constraint for zone in zones.values() for constraint in zone}.values())

    def keys_of(self, number: int) -> List[ZoneKey]:
        """Where the zones of a block stand, in order: those in which to wait first."""
        block = self.blocks[number]
        parts: List[Tuple[Union[str, int], int]] = [("wait", len(block.wait))]
        parts += [(k, len(command.zones)) for k, command in enumerate(block.commands)]
        return [(number, part, n) for part, count in parts for n in range(count)]

    @property
    def size(self) -> int:
        """The number of its commands, over all states."""
        return sum(len(block.commands) for block in self.blocks)


def with_automata_of(network: Network, strategy: Strategy) -> Network:
    """The network with the strategy's own automata: its watchers, passages and tours."""
    return with_tours(with_passages(with_watchers(network, strategy.watchers), strategy.passages), strategy.tours)


def with_edges(blocks: Iterable[Block], changed: Mapping[Tuple[str, Edge], Edge]) -> Tuple[Block, ...]:
    """The blocks whose commands take other edges in place of these, each of an automaton."""
    if not changed:
        return tuple(blocks)

    def moved(command: Command) -> Command:
        moves = (replace(move, edge=changed.get((move.automaton, move.edge), move.edge)) for move in command.moves)
        return replace(command, moves=tuple(moves))

    return tuple(replace(block, commands=tuple(map(moved, block.commands))) for block in blocks)


def with_zones(blocks: Iterable[Block], changed: Callable[[Zone], Zone]) -> Iterator[Block]:
    """The blocks with what this makes of their zones."""
    for block in blocks:
        commands = (replace(command, zones=tuple(map(changed, command.zones))) for command in block.commands)
        yield replace(block, wait=tuple(map(changed, block.wait)), commands=tuple(commands))
