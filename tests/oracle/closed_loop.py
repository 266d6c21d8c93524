"""Network and strategy put together: from the points at which a discrete state is entered, all that may follow."""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property
from typing import Dict, Iterator, List, Optional, Sequence, Set, Tuple

from pursue_gen.diagnostics import error
from pursue_gen.outcomes import Invalid
from pursue_gen.proof import reasons
from pursue_gen.proof.closed_loop import ClosedLoop, Entry
from pursue_gen.proof.moves import JointMove, Situation, State, in_words, joint_move
from pursue_gen.synthesis.strategy import Zone, ZoneKey
from pursue_gen.zones.dbm import Dbm, raw
from tests.oracle.delays import Act, Advice, Broken, Passage, Rules, pass_time
from tests.oracle.extrapolation import Described, MaxConstants
from tests.oracle.unions import without
from tests.oracle.zones import reset


class LoopInPython:
    """A closed loop's network and strategy; it records which zones of the strategy are used."""

    def __init__(self, loop: ClosedLoop) -> None:
        self.arena, self.strategy, self.ranks = loop.arena, loop.strategy, loop.ranks
        self.goal, self.bad = loop.goal, loop.bad
        self.rules = Rules(loop.rules.reaction, loop.rules.instant > 0, loop.rules.must_end, loop.rules.instant)
        self.used: Set[ZoneKey] = set()
        self._advice: Dict[State, Advice] = {}

    @cached_property
    def _blocks(self) -> Dict[State, List[int]]:
        """The blocks of each discrete state."""
        found: Dict[State, List[int]] = {}
        for b, block in enumerate(self.strategy.blocks):
            state = self.arena.state_of(block.state)
            if state is not None:
                found.setdefault(state, []).append(b)
        return found

    @cached_property
    def max_constants(self) -> MaxConstants:
        """The constants by which zones are extrapolated."""
        return MaxConstants(self.arena, self._described, self.rules.reaction)

    def won(self, state: State) -> bool:
        """True in the goal: in all of its locations at once."""
        return bool(self.goal) and all(state[0][k] == location for k, location in self.goal)

    def lost(self, state: State) -> bool:
        """True in a bad location."""
        return any(state[0][k] == location for k, location in self.bad)

    def successors(self, entry: Entry) -> List[Tuple[JointMove, Entry]]:
        """All next entries. Raises Broken where the strategy fails on the way to them."""
        state, zone = entry
        if self.won(state):
            return []
        if self.lost(state):
            raise Broken(reasons.BAD, zone)
        if state not in self._blocks:
            raise Broken(reasons.NO_BLOCK, zone)
        if self.ranks is None:
            return self._steps(state, zone)
        steps: List[Tuple[JointMove, Entry]] = []
        for rank, part in self._ranked(state, zone):
            for move, (target, after) in self._steps(state, part):
                if not self.won(target) and not self._is_lower(target, after, rank):
                    raise Broken(reasons.NO_PROGRESS.format(in_words(move.moves)), part)
                steps.append((move, (target, after)))
        return steps

    def _ranked(self, state: State, zone: Dbm) -> Iterator[Tuple[int, Dbm]]:
        """The parts of the zone with their ranks; what the strategy does not cover fails when time passes there."""
        assert self.ranks is not None
        rest = [zone]
        for other, key in self._advice_in(state, self.arena.situation(state)).zones():
            common = zone.intersect(other)
            if common is not None:
                yield self.ranks.get(key, 0), common
                rest = without(rest, other)
        for part in rest:
            yield 0, part

    def _is_lower(self, state: State, zone: Dbm, rank: int) -> bool:
        assert self.ranks is not None
        rest = [zone]
        if state in self._blocks:
            for other, key in self._advice_in(state, self.arena.situation(state)).zones():
                if self.ranks.get(key, 0) < rank:
                    rest = [] if other.includes(zone) else without(rest, other)
                    if not rest:
                        return True
        return False

    def covered(self, state: State) -> Tuple[Dbm, ...]:
        """The points of the discrete state for which there is advice; none where the game is lost."""
        if self.lost(state) or state not in self._blocks:
            return ()
        return self._advice_in(state, self.arena.situation(state)).covered

    def steps_from_all(self, state: State) -> List[Tuple[JointMove, Entry]]:
        """All that may follow if each of the covered points may be entered. Raises Broken where the strategy fails."""
        situation, covered = self.arena.situation(state), self.covered(state)
        passage = self._passage(state, covered, self._advice_in(state, situation).waits)
        # Nobody waits or decides elsewhere.
        flights = (part for _, part in passage.taken if not any(zone.includes(part) for zone in covered))
        return self._entries(situation, passage, (*covered, *flights))

    def _steps(self, state: State, zone: Dbm) -> List[Tuple[JointMove, Entry]]:
        passage = self._passage(state, (zone,), (zone,))
        return self._entries(self.arena.situation(state), passage, passage.active)

    def _passage(self, state: State, entries: Sequence[Dbm], pieces: Sequence[Dbm]) -> Passage:
        situation = self.arena.situation(state)
        passage = pass_time(entries, pieces, situation, self._advice_in(state, situation), self.rules)
        self.used.update(passage.used)
        return passage

    @staticmethod
    def _entries(situation: Situation, passage: Passage, active: Sequence[Dbm]) -> List[Tuple[JointMove, Entry]]:
        """Where commands lead that take effect, and what the environment may do at the active points."""
        steps = list(passage.taken)
        for move in situation.moves:
            if not move.controllable and move.enabled is not None:
                common = (part.intersect(move.enabled) for part in active)
                steps += [(move, part) for part in common if part is not None]
        return [(move, (move.target, reset(part, move.resets))) for move, part in steps]

    def _advice_in(self, state: State, situation: Situation) -> Advice:
        found = self._advice.get(state)
        if found is None:
            wait: List[Tuple[Dbm, ZoneKey]] = []
            acts: List[Act] = []
            for b in self._blocks[state]:
                block = self.strategy.blocks[b]
                wait += [(zone, (b, "wait", n)) for n, zone in self._zones(block.wait, situation)]
                for k, command in enumerate(block.commands):
                    move, fault = joint_move(command, situation)
                    acts += [Act(zone, (b, k, n), move, fault) for n, zone in self._zones(command.zones, situation)]
            found = self._advice[state] = Advice.of(wait, acts, self.rules.reaction)
        return found

    def _zones(self, zones: Sequence[Zone], situation: Situation) -> Iterator[Tuple[int, Dbm]]:
        """The zones within the invariant, those without a point left out, with their numbers."""
        for n, zone in enumerate(zones):
            dbm = situation.invariant
            for c in zone:
                if dbm is not None:
                    bound = raw(self._scaled(c.bound), c.strict)
                    dbm = dbm.constrained(self._index(c.left), self._index(c.right), bound)
            if dbm is not None:
                yield n, dbm

    def _index(self, clock: Optional[str]) -> int:
        if clock is None:
            return 0
        if clock not in self.arena.clock:
            hint = f"the clocks are {', '.join(self.arena.clock)}"
            raise Invalid([error("SYN104", f"the strategy speaks of a clock {clock}", hint=hint)])
        return self.arena.clock[clock]

    def _scaled(self, bound: Fraction) -> int:
        return bound.numerator * (self.arena.scale // bound.denominator)

    def _described(self, state: State) -> Described:
        """What may happen in a state, and which constants the strategy compares clocks with there."""
        if self.won(state) or self.lost(state) or state not in self._blocks:
            return (), ()
        situation = self.arena.situation(state)
        moves = {id(move): move for move in situation.moves if not move.controllable and move.enabled is not None}
        compared: List[Tuple[int, int]] = []
        for b in self._blocks[state]:
            block = self.strategy.blocks[b]
            commanded = (joint_move(command, situation)[0] for command in block.commands)
            moves.update((id(move), move) for move in commanded if move is not None and move.enabled is not None)
            for c in (c for zone in block.zones for c in zone):
                size = abs(self._scaled(c.bound))
                compared += [(x, size) for x in (self._index(c.left), self._index(c.right)) if x]
        return tuple(moves.values()), compared
