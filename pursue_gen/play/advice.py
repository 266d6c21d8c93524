"""What a strategy says at a play: what it does next, when, and which of its blocks holds."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import AbstractSet, List, Mapping, Optional, Tuple

from pursue_gen.explanation.policy import Window, window
from pursue_gen.explanation.policy import span as delays
from pursue_gen.play.state import GRAIN, PlayState, Setup, later
from pursue_gen.synthesis.game import JointMove, State, joint_moves
from pursue_gen.synthesis.lookup import Blocks
from pursue_gen.synthesis.strategy import Block, Command, DiscreteState, Strategy, Zone
from pursue_gen.tga.network import Edge
from pursue_gen.tga.part import clocks_of


@dataclass(frozen=True)
class Decision:
    """The command of the strategy that is due first if nothing happens before, at a time since the start."""

    move: JointMove
    at: Fraction
    command: Command


@dataclass(frozen=True)
class Holding:
    """The block that holds: its number (from 1), and the zone in force (None: the strategy does not know this point).

    `command` None: it says to wait.
    """

    number: int
    block: Block
    command: Optional[Command]
    zone: Optional[Zone]


class Advisor:
    """Reads one strategy for one setup."""

    def __init__(self, setup: Setup, strategy: Strategy) -> None:
        self._setup, self.size = setup, len(strategy.blocks)
        self._blocks = Blocks(strategy)

    def decision(self, play: PlayState) -> Optional[Decision]:
        """What the strategy decided before the last move, where that stands, else what it decides first after it; None:
        it waits for what others do."""
        found = self._blocks.find(self._named(play.entry.state))
        if found is None:
            return None
        game, entry = self._setup.game, play.entry
        named = {name for name, _ in found[1].state.locations}
        moves = {self._keys(move, named): move for move in joint_moves(game, entry.state) if move.controllable}
        if play.standing is not None:
            command, at = play.standing
            return Decision(moves[_keys_of(command)], at, command) if _keys_of(command) in moves else None
        clocks = dict(zip(game.clocks, entry.clocks))
        best: Optional[Decision] = None
        for command in found[1].commands:
            move = moves.get(_keys_of(command))
            if move is None:
                continue
            open_ = window(game, entry, move)
            for zone in command.zones:
                within = span(zone, clocks)
                delay = None if within is None else _both(within, open_).earliest(GRAIN)
                if delay is not None and (best is None or play.since + delay < best.at):
                    best = Decision(move, play.since + delay, command)
        return best

    def sees_nothing_new(self, before: PlayState, play: PlayState) -> bool:
        """True if what was decided before a move stands after it: the same block holds, and no clock of an automaton
        that it names was reset."""
        found, there = (self._blocks.find(self._named(each.entry.state)) for each in (before, play))
        if found is None or found != there:
            return False
        named = {name for name, _ in found[1].state.locations}
        network, game = self._setup.network, self._setup.game
        clocks = {clock for automaton in network.automata if automaton.name in named for clock in clocks_of(automaton)}
        aged = later(before.entry, play.since - before.since)
        was, now = (dict(zip(game.clocks, entry.clocks)) for entry in (aged, play.entry))
        return all(was[clock] == now[clock] for clock in clocks)

    def holding(self, play: PlayState) -> Optional[Holding]:
        """What the strategy says now, or said when it decided what stands; None: it has no block for this state."""
        found = self._blocks.find(self._named(play.entry.state))
        if found is None:
            return None
        number, block = found
        moment = play.now if play.standing is None else play.standing[1]
        clocks = dict(zip(self._setup.game.clocks, later(play.entry, moment - play.since).clocks))
        zones: List[Tuple[Optional[Command], Zone]] = [(None, zone) for zone in block.wait]
        zones += [(command, zone) for command in block.commands for zone in command.zones]
        for command, zone in zones:
            within = span(zone, clocks)
            if within is not None and within.holds(Fraction(0)):
                return Holding(number, block, command, zone)
        return Holding(number, block, None, None)

    def _named(self, state: State) -> DiscreteState:
        game = self._setup.game
        places = zip(game.automata, state.locations)
        return DiscreteState(
            tuple((automaton.name, automaton.locations[k]) for automaton, k in places),
            tuple(zip(game.variables, state.values)),
        )

    def _keys(self, move: JointMove, named: AbstractSet[str]) -> Tuple[Tuple[str, ...], ...]:
        """What the named automata do in the move; the first one makes it."""
        game = self._setup.game
        parts = ((game.automata[game.edges[k].automaton].name, game.origins[k]) for k in move.edges)
        keys = [_key(name, edge) for name, edge in parts if name in named]
        return (*keys[:1], *sorted(keys[1:]))


def _keys_of(command: Command) -> Tuple[Tuple[str, ...], ...]:
    first, *others = (_key(move.automaton, move.edge) for move in command.moves)
    return (first, *sorted(others))


def _key(automaton: str, edge: Edge) -> Tuple[str, ...]:
    return automaton, edge.source, edge.target, str(edge.sync), str(edge.guard)


def span(zone: Zone, clocks: Mapping[str, Fraction]) -> Optional[Window]:
    """The delays after which clocks that have these values now are in a zone; None: time does not get there."""
    reached = delays(zone, clocks)
    return None if reached is None or reached.earliest(GRAIN) is None else reached


def _both(a: Window, b: Window) -> Window:
    common = a.at_least(b.low, b.low_open)
    return common if b.high is None else common.at_most(b.high, b.high_open)


