"""What a strategy says at a play: what it does next, when, and which of its blocks holds."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import AbstractSet, List, Mapping, Optional, Tuple

from pursue_gen.explanation.policy import Window, window
from pursue_gen.explanation.policy import span as delays
from pursue_gen.synthesis.game import JointMove, joint_moves
from pursue_gen.synthesis.lookup import blocks_of, facts_of
from pursue_gen.synthesis.strategy import Block, Command, Strategy, Zone
from pursue_gen.tga.network import Edge
from pursue_gen.tools.play.state import GRAIN, PlayState, Setup, StandingDecision


@dataclass(frozen=True)
class Decision:
    """The command of a block (by its number) that is due first if nothing happens before, at a time since the start."""

    move: JointMove
    at: Fraction
    number: int
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
        self._left_out_clocks = frozenset(strategy.left_out_clocks)
        self._blocks = blocks_of(strategy)
        self._clocks = {automaton.name: automaton.clocks for automaton in setup.network.automata}

    def decision(self, play: PlayState) -> Optional[Decision]:
        """What the strategy decided before the last move, where that stands, or decides first after it; None: it waits
        for what others do."""
        return min(self._decisions(play), key=lambda decision: decision.at, default=None)

    def standing(self, before: PlayState, play: PlayState) -> Tuple[StandingDecision, ...]:
        """What had been decided before a move, and stands after it: the same block holds, and no clock of an automaton
        that it names was reset, but those that the strategy leaves out."""
        game = self._setup.game
        aged = before.entry.later(play.since - before.since)
        reset = {c for c, was, now in zip(game.clocks, aged.clocks, play.entry.clocks) if was != now}
        reset -= self._left_out_clocks
        states = facts_of(game, before.entry.state), facts_of(game, play.entry.state)
        entries = [entry for entry, stands in self._blocks.standing(*states, reset, self._clocks).items() if stands]
        numbers = {number for entry in entries for number, _ in self._blocks.entered(entry)}
        return tuple(
            StandingDecision(decision.number, decision.command, decision.at)
            for decision in self._decisions(before)
            if decision.at <= play.since and decision.number in numbers
        )

    def holdings(self, play: PlayState) -> List[Holding]:
        """What each block that holds says now, or said when it decided what stands; none: the strategy has no block for
        this state."""
        return [self._says(number, block, play) for number, block in self._holding(play)]

    def _holding(self, play: PlayState) -> List[Tuple[int, Block]]:
        return self._blocks.find(facts_of(self._setup.game, play.entry.state))

    def _decisions(self, play: PlayState) -> List[Decision]:
        """What each block that holds has decided or decides first."""
        found = (self._decided(number, block, play) for number, block in self._holding(play))
        return [decision for decision in found if decision is not None]

    def _decided(self, number: int, block: Block, play: PlayState) -> Optional[Decision]:
        game, entry = self._setup.game, play.entry
        named = {name for name, _ in block.state.locations}
        moves = {self._keys(move, named): move for move in joint_moves(game, entry.state) if move.controllable}
        for known in play.standing:
            if known.number == number:
                move = moves.get(_keys_of(known.command))
                return None if move is None else Decision(move, known.at, number, known.command)
        clocks = dict(zip(game.clocks, entry.clocks))
        best: Optional[Decision] = None
        for command in block.commands:
            move = moves.get(_keys_of(command))
            if move is None:
                continue
            open_ = window(game, entry, move)
            for zone in command.zones:
                within = span(zone, clocks)
                delay = None if within is None else within.both(open_).earliest(GRAIN)
                if delay is not None and (best is None or play.since + delay < best.at):
                    best = Decision(move, play.since + delay, number, command)
        return best

    def _says(self, number: int, block: Block, play: PlayState) -> Holding:
        moment = next((known.at for known in play.standing if known.number == number), play.now)
        clocks = dict(zip(self._setup.game.clocks, play.entry.later(moment - play.since).clocks))
        zones: List[Tuple[Optional[Command], Zone]] = [(None, zone) for zone in block.wait]
        zones += [(command, zone) for command in block.commands for zone in command.zones]
        for command, zone in zones:
            within = span(zone, clocks)
            if within is not None and within.holds(Fraction(0)):
                return Holding(number, block, command, zone)
        return Holding(number, block, None, None)

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
