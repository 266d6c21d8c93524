"""A second opinion on strategies: does every play that agrees with this one meet the objective?

The closed loop of network and strategy is explored symbolically from the start. Nothing here is shared with the solver but
the zone library: network and strategy are read anew (verify_moves, verify_time). See the design of the game for the rules.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, replace
from fractions import Fraction
from math import gcd
from typing import Deque, Dict, FrozenSet, Iterable, Iterator, List, Mapping, Optional, Sequence, Set, Tuple

from pursue_gen.diagnostics import PursueError, error
from pursue_gen.synthesis.dbm import INF, Dbm, constant, is_strict, raw
from pursue_gen.synthesis.strategy import Block, Command, Strategy, Zone, ZoneKey
from pursue_gen.synthesis.verify_clocks import Described, Horizon
from pursue_gen.synthesis.verify_moves import Arena, JointMove, Situation, State
from pursue_gen.synthesis.verify_time import Act, Advice, Broken, Rules, pass_time, without
from pursue_gen.tga.network import Kind, Network, Objective

LIMIT = 300_000
"""So many symbolic states are explored unless the caller says otherwise; the published plans need up to some 30,000."""

_INSTANTS = 4
"""Into so many parts a time unit is cut when instants just after another are looked at (verify_time)."""

_EXACT = 10_000
"""So many states, and four times those of the first look, the second look with exact clock values may take."""

_OFTEN = 8
"""A discrete state that stands so often on one play of a reach game is looked at for a loop that only clocks hide."""


@dataclass(frozen=True)
class Report:
    """The outcome. `reason` starts with the kind of failure; `play` says in words how it comes about, the state last.

    `used` are the zones of the strategy that plays reach (block, 'wait' or command, zone); `states` counts symbolic states.
    """

    ok: bool
    reason: str
    play: Tuple[str, ...]
    used: FrozenSet[ZoneKey]
    states: int


def verify(
    network: Network,
    objective: Objective,
    strategy: Strategy,
    reaction: Fraction = Fraction(0),
    limit: int = LIMIT,
    prompt: Optional[bool] = None,
    ranks: Optional[Mapping[ZoneKey, int]] = None,
) -> Report:
    """Check that the strategy wins when each command takes effect up to `reaction` time units after its decision.

    `prompt`: the controller acts as soon as it comes into the zone of a command (the ideal player of UPPAAL-TIGA's plans);
    otherwise it may act anywhere in the zone, before time leaves it. Where it is not given: prompt iff the reaction is 0.

    `ranks` (reach): a number for each zone of the strategy. If from each zone every step leads to lower numbers, plays end,
    and that is quickly seen; the ranks need not be trusted. Without them every play is followed to its end.

    Never says ok for a strategy that loses. A strategy that compares clock differences may in rare cases be refused though
    it wins, because forgetting large clock values is not exact there.
    Raises PursueError for a network or strategy that it cannot read.
    """
    if strategy.counter:
        return Report(False, "counter-strategy: it shows why the controller loses", (), frozenset(), 0)
    if reaction < 0:
        raise PursueError([error("SYN103", f"the reaction time is {reaction}", hint="give 0 or more time units")], 2)
    prompt = reaction == 0 if prompt is None else prompt
    checker = _Checker(network, objective, strategy, reaction, ranks)
    start = checker.arena.situation(checker.arena.initial).invariant
    zero = Dbm.zero(checker.arena.dim)
    if start is None or not start.includes(zero):
        return Report(False, "no start: an invariant of the initial state does not hold", (), frozenset(), 0)
    report = checker.played(False, False, limit)
    if prompt and not report.ok:
        report = checker.played(True, False, limit)
    if report.ok or ranks is not None:
        return report
    # It may fail only because clock values are forgotten: look again without that, and show a play that is real.
    exact = checker.played(prompt, True, min(limit, 4 * report.states + _EXACT))
    return report if exact.reason.startswith("limit") else exact


def pruned(strategy: Strategy, report: Report) -> Strategy:
    """The strategy without the blocks, commands and zones that no play reaches."""

    def kept(zones: Sequence[Zone], block: int, part: object) -> Tuple[Zone, ...]:
        return tuple(zone for n, zone in enumerate(zones) if (block, part, n) in report.used)

    blocks = []
    for b, block in enumerate(strategy.blocks):
        commands = (Command(kept(c.zones, b, k), c.moves) for k, c in enumerate(block.commands))
        fewer = replace(block, wait=kept(block.wait, b, "wait"), commands=tuple(c for c in commands if c.zones))
        if fewer.wait or fewer.commands:
            blocks.append(fewer)
    return replace(strategy, blocks=tuple(blocks))


_Entry = Tuple[State, Dbm]
"""A discrete state and the clocks' values just after the step into it."""


class _Checker:
    """Network and strategy in one scale, and what has been learnt of the strategy's use."""

    def __init__(
        self,
        network: Network,
        objective: Objective,
        strategy: Strategy,
        reaction: Fraction,
        ranks: Optional[Mapping[ZoneKey, int]],
    ) -> None:
        scale = _common_denominator(strategy, reaction) * _INSTANTS
        self.arena, self.strategy = Arena(network, scale), strategy
        self.rules = Rules(int(reaction * scale), False, objective.kind is not Kind.SAFETY)
        self.goal = None if objective.kind is Kind.SAFETY else _place(network, objective.goal)
        self.bad = None if objective.kind is Kind.REACH else _place(network, objective.bad)
        self.used: Set[ZoneKey] = set()
        self._ranks = None if objective.kind is Kind.SAFETY else ranks
        self._blocks: Dict[State, List[int]] = {}
        for b, block in enumerate(strategy.blocks):
            state = self.arena.state_of(block.state)
            if state is not None:
                self._blocks.setdefault(state, []).append(b)
        self._advice: Dict[State, Advice] = {}
        self.horizon = Horizon(self.arena, self._described, self.rules.reaction)

    def played(self, prompt: bool, exact: bool, limit: int) -> Report:
        """What becomes of all plays when the strategy is played so; `exact`: forget nothing about the clocks."""
        self.rules, self.used = replace(self.rules, prompt=prompt), set()
        search = _check_ends if self.rules.must_end and self._ranks is None else _check_all
        return search(self, (self.arena.initial, Dbm.zero(self.arena.dim)), exact, limit)

    def won(self, state: State) -> bool:
        """True in the goal."""
        return self.goal is not None and state[0][self.goal[0]] == self.goal[1]

    def lost(self, state: State) -> bool:
        """True in the bad location."""
        return self.bad is not None and state[0][self.bad[0]] == self.bad[1]

    def followers(self, entry: _Entry) -> List[Tuple[JointMove, _Entry]]:
        """All next entries. Raises Broken where the strategy fails on the way to them."""
        state, zone = entry
        if self.won(state):
            return []
        if self.lost(state):
            raise Broken("bad: the location that must be avoided is reached", zone)
        if state not in self._blocks:
            raise Broken("no block: the strategy does not know this discrete state", zone)
        if self._ranks is None:
            return self._steps(state, zone)
        steps: List[Tuple[JointMove, _Entry]] = []
        for rank, part in self._ranked(state, zone):
            for move, (target, after) in self._steps(state, part):
                if not self.won(target) and not self._is_lower(target, after, rank):
                    raise Broken(f"no progress: {_in_words(move)} leads no nearer to the goal", part)
                steps.append((move, (target, after)))
        return steps

    def _ranked(self, state: State, zone: Dbm) -> Iterator[Tuple[int, Dbm]]:
        """The parts of the zone with their ranks; what the strategy does not cover fails as soon as time passes there."""
        assert self._ranks is not None
        rest = [zone]
        for other, key in self._advice_in(state, self.arena.situation(state)).zones():
            common = zone.intersect(other)
            if common is not None:
                yield self._ranks[key], common
                rest = without(rest, other)
        for part in rest:
            yield 0, part

    def _is_lower(self, state: State, zone: Dbm, rank: int) -> bool:
        assert self._ranks is not None
        rest = [zone]
        if state in self._blocks:
            for other, key in self._advice_in(state, self.arena.situation(state)).zones():
                if rest and self._ranks[key] < rank:
                    rest = without(rest, other)
        return not rest

    def _steps(self, state: State, zone: Dbm) -> List[Tuple[JointMove, _Entry]]:
        situation = self.arena.situation(state)
        passage = pass_time(zone, situation, self._advice_in(state, situation), self.rules)
        self.used.update(passage.used)
        steps = list(passage.taken)
        for move in situation.moves:
            if not move.controllable and move.enabled is not None:
                common = (part.intersect(move.enabled) for part in passage.active)
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
                    move, fault = _joint_move(command, situation)
                    acts += [Act(zone, (b, k, n), move, fault) for n, zone in self._zones(command.zones, situation)]
            found = self._advice[state] = Advice.of(wait, acts, self.rules.reaction)
        return found

    def _zones(self, zones: Sequence[Zone], situation: Situation) -> Iterator[Tuple[int, Dbm]]:
        """The zones within the invariant, those without a point left out, with their numbers."""
        for n, zone in enumerate(zones):
            dbm = situation.invariant
            for c in zone:
                if dbm is not None:
                    dbm = dbm.constrained(self._index(c.left), self._index(c.right), self._raw(c.bound, c.strict))
            if dbm is not None:
                yield n, dbm

    def _index(self, clock: Optional[str]) -> int:
        if clock is None:
            return 0
        if clock not in self.arena.clock:
            raise PursueError([error(
                "SYN104", f"the strategy speaks of a clock {clock}", hint=f"the clocks are {', '.join(self.arena.clock)}"
            )])
        return self.arena.clock[clock]

    def _raw(self, bound: Fraction, strict: bool) -> int:
        return raw(int(bound * self.arena.scale), strict)

    def _described(self, state: State) -> Described:
        """For the horizon: what may happen in a state, and which constants the strategy compares clocks with there."""
        if self.won(state) or self.lost(state) or state not in self._blocks:
            return (), ()
        situation = self.arena.situation(state)
        moves = [move for move in situation.moves if not move.controllable and move.enabled is not None]
        moves += {act.move: None for act in self._advice_in(state, situation).acts if act.move is not None}
        compared: List[Tuple[int, int]] = []
        for b in self._blocks[state]:
            for c in (c for zone in _zones_of(self.strategy.blocks[b]) for c in zone):
                size = abs(int(c.bound * self.arena.scale))
                compared += [(x, size) for x in (self._index(c.left), self._index(c.right)) if x]
        return moves, compared

    def report(self, reason: str, steps: Iterable[JointMove], state: State, zone: Optional[Dbm], states: int) -> Report:
        """A failure, with the play that leads to it."""
        play = [_in_words(move) for move in steps]
        places = [f"{a.name}.{location}" for a, location in zip(self.arena.network.automata, state[0])]
        places += [f"{name}={value}" for (name, _), value in zip(self.arena.network.variables, state[1])]
        if zone is not None:
            point = _sample(zone)
            places += [f"{name}={point[x - 1] / self.arena.scale}" for name, x in self.arena.clock.items()]
        return Report(False, reason, (*play, "then: " + " ".join(places)), frozenset(self.used), states)


def _check_all(checker: _Checker, start: _Entry, exact: bool, limit: int) -> Report:
    """Everything that is reachable, breadth first."""
    found: List[Tuple[_Entry, int, Optional[JointMove]]] = [(start, -1, None)]
    passed: Dict[State, List[Dbm]] = {start[0]: [start[1]]}
    pending: Deque[int] = deque([0])

    def steps_to(n: int) -> List[JointMove]:
        steps: List[JointMove] = []
        while n >= 0:
            _, n, move = found[n]
            steps += [] if move is None else [move]
        return steps[::-1]

    while pending:
        n = pending.popleft()
        (state, zone), _, _ = found[n]
        if not any(other is zone for other in passed[state]):
            continue
        try:
            followers = checker.followers((state, zone))
        except Broken as broken:
            return checker.report(broken.reason, steps_to(n), state, broken.zone, len(found))
        for move, (target, after) in followers:
            after = after if exact else checker.horizon.forget(after, target)
            known = passed.setdefault(target, [])
            if any(other.includes(after) for other in known):
                continue
            if len(found) >= limit:
                return checker.report(_out_of(limit), steps_to(n) + [move], target, after, len(found))
            known[:] = [other for other in known if not after.includes(other)] + [after]
            found.append(((target, after), n, move))
            pending.append(len(found) - 1)
    return Report(True, "", (), frozenset(checker.used), len(found))


@dataclass
class _Step:
    """An entry on the play that is looked at, with the entries after it that are still to be proven."""

    entry: _Entry
    move: Optional[JointMove]
    left: List[Tuple[JointMove, _Entry]]


def _check_ends(checker: _Checker, start: _Entry, exact: bool, limit: int) -> Report:
    """Depth first: an entry is proven when all that may follow it are, so every play ends in the goal."""
    proven: Dict[State, List[Dbm]] = {}
    open_zones: Dict[State, List[Dbm]] = {}
    path: List[_Step] = []
    states = 0
    coming: Optional[Tuple[Optional[JointMove], _Entry]] = (None, start)

    def failed(reason: str, move: Optional[JointMove], state: State, zone: Dbm) -> Report:
        steps = [step.move for step in path if step.move is not None] + ([] if move is None else [move])
        return checker.report(reason, steps, state, zone, states)

    while coming is not None or path:
        if coming is None:
            step = path[-1]
            if step.left:
                coming = step.left.pop()
            else:
                path.pop()
                state, zone = step.entry
                open_zones[state].pop()
                known = proven.setdefault(state, [])
                known[:] = [other for other in known if not zone.includes(other)] + [zone]
            continue
        move, (state, zone) = coming
        coming = None
        zone = zone if exact else checker.horizon.forget(zone, state)
        if checker.won(state) or any(other.includes(zone) for other in proven.get(state, ())):
            continue
        on_path = open_zones.setdefault(state, [])
        if _comes_back(on_path, zone, checker.horizon, state):
            return failed("for ever: a play comes back to where it was and need not reach the goal", move, state, zone)
        if states >= limit:
            return failed(_out_of(limit), move, state, zone)
        states += 1
        try:
            followers = checker.followers((state, zone))
        except Broken as broken:
            return failed(broken.reason, move, state, broken.zone)
        on_path.append(zone)
        path.append(_Step((state, zone), move, followers))
    return Report(True, "", (), frozenset(checker.used), states)


def _comes_back(on_path: Sequence[Dbm], zone: Dbm, horizon: Horizon, state: State) -> bool:
    """True if a play may go round for ever.

    With exact zones each point of the zone has a predecessor in the earlier one on the path; when the zone includes that
    one, there are plays of every length, and so endless ones. A zone that changes only in what no guard sees does the same.
    """
    if any(zone.includes(other) for other in on_path):
        return True
    if len(on_path) < _OFTEN:
        return False
    blurred = horizon.forget(zone, state)
    return any(blurred == horizon.forget(other, state) for other in on_path)


def _joint_move(command: Command, situation: Situation) -> Tuple[Optional[JointMove], str]:
    """The joint move that a command names, or None and why there is none."""
    for move in situation.moves:
        if move.moves[:1] == command.moves[:1] and _same(move.moves[1:], command.moves[1:]):
            if move.controllable:
                return move, ""
            return None, "not controllable: the command takes an edge of the environment"
    return None, "not a joint move: not exactly the sender and all who receive, or the integers do not allow it"


def _same(some: Sequence[object], others: Sequence[object]) -> bool:
    return len(some) == len(others) and all(one in others for one in some)


def _place(network: Network, place: Optional[Tuple[str, str]]) -> Optional[Tuple[int, str]]:
    """(automaton, location) with the number of the automaton."""
    if place is None:
        raise PursueError([error("SYN105", "the objective names no goal or no location to avoid")])
    for k, automaton in enumerate(network.automata):
        if automaton.name == place[0] and any(location.name == place[1] for location in automaton.locations):
            return k, place[1]
    raise PursueError([error("SYN105", f"the objective speaks of {place[0]}.{place[1]}, which the network does not have")])


def _zones_of(block: Block) -> Iterator[Zone]:
    yield from block.wait
    for command in block.commands:
        yield from command.zones


def _common_denominator(strategy: Strategy, reaction: Fraction) -> int:
    """What all bounds have to be multiplied by to be integers."""
    zones = (zone for block in strategy.blocks for zone in _zones_of(block))
    denominators = {reaction.denominator} | {c.bound.denominator for zone in zones for c in zone}
    scale = 1
    for d in denominators:
        scale = scale * d // gcd(scale, d)
    return scale


def _out_of(limit: int) -> str:
    return f"limit: not decided within {limit} symbolic states"


def _in_words(move: JointMove) -> str:
    who = "controller" if move.controllable else "environment"
    sync = move.moves[0].edge.sync
    event = "tau" if sync is None else sync.channel
    edges = (f"{m.automaton}.{m.edge.source} -> {m.automaton}.{m.edge.target}" for m in move.moves)
    return f"{who}: {event} ({', '.join(edges)})"


def _sample(zone: Dbm) -> Tuple[Fraction, ...]:
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
