"""Strategies in stages played at random, point by point, as controllers play them: with commands that come late.

A deliberately naive reading of the rules. What was decided stands while what its block names stays as it is; whatever
else happens meanwhile. Delays are multiples of a quarter.
"""

from __future__ import annotations

from fractions import Fraction
from random import Random
from typing import Dict, List, Optional, Set, Tuple

from pursue_gen.synthesis.strategy import Block, Command, Strategy
from pursue_gen.tga.network import Network, Objective
from tests.synthesis.play_by_play import HALFWAY, STEP, UNIT, Entry, Move, PlayByPlay, inside

Decided = Dict[Tuple[int, int], int]
"""Commands on their way, by the numbers of their block and in it: so many steps until they take effect."""

LONGEST = 800
"""So many steps a play may have; the games are won with fewer."""


class StagedPlay:
    """Random plays of a strategy for a game with a reaction delay."""

    def __init__(self, network: Network, objective: Objective, strategy: Strategy, reaction: Fraction) -> None:
        self._points = PlayByPlay(network, objective, Strategy(()), reaction)
        self._network, self._objective, self._blocks = network, objective, strategy.blocks
        self._latest = int(reaction * UNIT / STEP)
        self._named = [{name for name, _ in block.state.locations} for block in self._blocks]
        self._clocks = {automaton.name: automaton.clocks for automaton in network.automata}

    def broken(self, seed: int) -> Optional[str]:
        """Why this play fails; None where it comes to the goal."""
        draw = Random(seed)
        now: Entry = (
            tuple(automaton.initial for automaton in self._network.automata),
            tuple(value for _, value in self._network.variables),
            (0,) * len(self._network.clocks),
        )
        decided: Decided = {}
        for _ in range(LONGEST):
            if self._points.won(now):
                return None
            if self._points.lost(now):
                return "bad"
            holding = [n for n, block in enumerate(self._blocks) if self._holds(block, now)]
            decided = {key: left for key, left in decided.items() if key[0] in holding}
            for n in holding:
                if not self._decide(n, now, decided, draw):
                    return "not covered"
            move, key = self._next(now, decided, draw)
            if key is not None and move is None:
                return "not enabled"
            if move is not None:
                decided = {other: left for other, left in decided.items() if other != key and self._stands(other, move)}
                now = self._points.after(now, move)
            elif self._points.lasts(self._points.later(now, STEP)):
                now = self._points.later(now, STEP)
                decided = {key: left - 1 for key, left in decided.items()}
            else:
                return "time is blocked"
        return "never at the goal"

    def _holds(self, block: Block, now: Entry) -> bool:
        places = dict(zip((automaton.name for automaton in self._network.automata), now[0]))
        values = dict(zip((name for name, _ in self._network.variables), now[1]))
        state = block.state
        return all(places[n] == p for n, p in state.locations) and all(values[n] == v for n, v in state.values)

    def _decide(self, n: int, now: Entry, decided: Decided, draw: Random) -> bool:
        """Decide what the block says, at once or as long as there is time to. False where it says nothing."""
        block = self._blocks[n]
        ready = [k for k, command in enumerate(block.commands) if self._is_due(command, now)]
        last = not self._points.lasts(self._points.later(now, STEP))
        for k in ready:
            later = (self._is_due(block.commands[k], self._points.later(now, time)) for time in (HALFWAY, STEP))
            idle = not any(m == n for m, _ in decided)
            if (n, k) not in decided and ((idle and (last or not all(later))) or draw.random() < 0.3):
                decided[n, k] = draw.randint(0, self._latest)
        clocks = self._points.clocks(now)
        return bool(ready) or any(m == n for m, _ in decided) or any(inside(zone, clocks, UNIT) for zone in block.wait)

    def _is_due(self, command: Command, now: Entry) -> bool:
        return any(inside(zone, self._points.clocks(now), UNIT) for zone in command.zones)

    def _next(self, now: Entry, decided: Decided, draw: Random) -> Tuple[Optional[Move], Optional[Tuple[int, int]]]:
        """The next move, and which command it is; no move: time passes, or the command cannot be done."""
        others = self._environments(now)
        stuck = not self._points.lasts(self._points.later(now, STEP))
        due = [key for key, left in decided.items() if left <= 0 or stuck]
        forced = [move for move in others if move[0][0] in self._at_bounds(now)] if stuck else []
        if others and draw.random() < 0.25:
            return draw.choice(others), None
        if due and (not forced or draw.random() < 0.5):
            key = draw.choice(due)
            return self._done(now, key, draw), key
        return (draw.choice(forced) if forced else None), None

    def _environments(self, now: Entry) -> List[Move]:
        moves = [move for move in self._points.moves(now) if not all(edge.controllable for _, edge in move)]
        return [
            move
            for move in moves
            if self._points.after(now, move)[:2] != now[:2] or any(edge.resets for _, edge in move)
        ]

    def _at_bounds(self, now: Entry) -> Set[str]:
        clocks = self._points.clocks(now)
        return {a.name for a, bound in self._points.invariants(now) if clocks[bound.clock] == UNIT * bound.bound}

    def _done(self, now: Entry, key: Tuple[int, int], draw: Random) -> Optional[Move]:
        """A joint move in which those whom the block names do what the command says; None if there is none."""
        n, k = key
        wanted = {(move.automaton, move.edge) for move in self._blocks[n].commands[k].moves}
        moves = [
            move
            for move in self._points.moves(now)
            if {(name, edge) for name, edge in move if name in self._named[n]} == wanted
            and all(edge.controllable for _, edge in move)
        ]
        return draw.choice(moves) if moves else None

    def _stands(self, key: Tuple[int, int], move: Move) -> bool:
        """True where the move resets no clock of an automaton that the block names, and changes nothing there."""
        named = self._named[key[0]]
        resets = {clock for _, edge in move for clock in edge.resets}
        clocks = {clock for name in named for clock in self._clocks[name]}
        values = {name for name, _ in self._blocks[key[0]].state.values}
        assigned = {name for _, edge in move for name, _ in edge.assign}
        return not (resets & clocks or assigned & values or any(name in named for name, _ in move))
