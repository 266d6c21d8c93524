"""Network and strategy put together: from the points at which a discrete state is entered, all that may follow."""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property
from typing import Callable, Dict, Iterator, List, Mapping, Optional, Sequence, Set, Tuple

from pursue_gen.diagnostics import error
from pursue_gen.outcomes import Invalid
from pursue_gen.proof import reasons
from pursue_gen.proof.delays import Act, Advice, Broken, Passage, Rules, pass_time
from pursue_gen.proof.extrapolation import Described, MaxConstants
from pursue_gen.proof.moves import Arena, JointMove, Situation, State
from pursue_gen.proof.zones import without
from pursue_gen.synthesis.strategy import Command, Move, Strategy, Zone, ZoneKey
from pursue_gen.tga.network import Network, Objective
from pursue_gen.tga.scale import common_denominator, least_common_multiple
from pursue_gen.zones.dbm import INF, Dbm, constant, is_strict, raw

INSTANTS = 4
"""Into so many parts a time unit is cut when instants just after another are explored (see `delays`). Not measured."""

Entry = Tuple[State, Dbm]
"""A discrete state and the clocks' values just after the step into it."""


class ClosedLoop:
    """Network and strategy in one time scale; it records which zones of the strategy are used."""

    def __init__(
        self,
        network: Network,
        objective: Objective,
        strategy: Strategy,
        reaction: Fraction,
        ranks: Optional[Mapping[ZoneKey, int]],
        instant: Fraction = Fraction(0),
        arenas: Optional[Callable[[int], Arena]] = None,
    ) -> None:
        """`instant`, in time units: the strategy is played promptly, as `delays.Rules` has it.

        `arenas`: those of the network by their scale (`Arena.kept`), where several loops share them.
        """
        scale = _scale(network, strategy, reaction)
        scale = least_common_multiple((scale, instant.denominator)) if instant else scale * INSTANTS
        self.arena, self.strategy = (arenas or Arena.kept(network))(scale), strategy
        self.rules = Rules(int(reaction * scale), instant > 0, objective.reaches, int(instant * scale))
        self.goal = _places(network, objective.goal) if objective.reaches else ()
        self.bad = _places(network, objective.bad) if objective.avoids else ()
        self.used: Set[ZoneKey] = set()
        self.ranks = ranks if objective.reaches else None
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
    def _entries(
        situation: Situation, passage: Passage, active: Sequence[Dbm]
    ) -> List[Tuple[JointMove, Entry]]:
        """Where commands lead that take effect, and what the environment may do at the active points."""
        steps = list(passage.taken)
        for move in situation.moves:
            if not move.controllable and move.enabled is not None:
                common = (part.intersect(move.enabled) for part in active)
                steps += [(move, part) for part in common if part is not None]
        return [(move, (move.target, part.reset(move.resets))) for move, part in steps]

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


def joint_move(command: Command, situation: Situation) -> Tuple[Optional[JointMove], str]:
    """The joint move that a command names, or None and why there is none."""
    for move in situation.moves:
        if move.moves[:1] == command.moves[:1] and _same(move.moves[1:], command.moves[1:]):
            if move.controllable:
                return move, ""
            return None, reasons.NOT_CONTROLLABLE
    return None, reasons.NO_JOINT_MOVE


def _same(some: Sequence[object], others: Sequence[object]) -> bool:
    return len(some) == len(others) and all(one in others for one in some)


def _places(network: Network, places: Sequence[Tuple[str, str]]) -> Tuple[Tuple[int, str], ...]:
    """Pairs (automaton, location) with the numbers of the automata."""
    if not places:
        raise Invalid([error("SYN105", "the objective names no goal or no location to avoid")])
    unknown = [".".join(place) for place in places if place not in network.places]
    if unknown:
        raise Invalid([error("SYN105", f"the objective speaks of {unknown[0]}, which the network does not have")])
    numbers = {automaton.name: k for k, automaton in enumerate(network.automata)}
    return tuple((numbers[name], location) for name, location in places)


def _scale(network: Network, strategy: Strategy, reaction: Fraction) -> int:
    """What all bounds have to be multiplied by to be integers."""
    return least_common_multiple([strategy.scale, common_denominator([reaction, *network.times])])


def in_words(moves: Sequence[Move]) -> str:
    """The moves that are made together, as a step of a play: who, the event, the edges."""
    who = "controller" if all(move.edge.controllable for move in moves) else "environment"
    sync = moves[0].edge.sync
    event = "tau" if sync is None else sync.channel
    edges = (f"{m.automaton}.{m.edge.source} -> {m.automaton}.{m.edge.target}" for m in moves)
    return f"{who}: {event} ({', '.join(edges)})"


def sample(zone: Dbm) -> Tuple[Fraction, ...]:
    """A valuation in the zone, small and with small denominators."""
    values: List[Fraction] = [Fraction(0)]
    for i in range(1, zone.dim):
        below = [(values[j], zone.m[j * zone.dim + i]) for j in range(i)]
        above = [(values[j], zone.m[i * zone.dim + j]) for j in range(i)]
        low, strict = max((value - constant(b), is_strict(b)) for value, b in below if b < INF)
        tops = [value + constant(b) for value, b in above if b < INF]
        if strict:
            low = (low + min(tops)) / 2 if tops and min(tops) < low + 2 else low + 1
        values.append(low)
    return tuple(values[1:])
