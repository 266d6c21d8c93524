"""A second opinion on strategies: does every play that agrees with this one meet the objective?

The closed loop of network and strategy is explored symbolically from the start. Nothing here is shared with the solver
but the zone library: network and strategy are read anew (`moves`: joint moves; `delays`: waiting and acting;
`closed_loop`: the two together; `extrapolation`: of zones; `invariant`: all that a strategy covers, at once). See the
design of the game for the rules.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import reduce
from typing import Callable, Deque, Dict, FrozenSet, Iterable, List, Mapping, Optional, Sequence, Tuple, Union

from pursue_gen.diagnostics import PursueError, error
from pursue_gen.proof.closed_loop import ClosedLoop, Entry, in_words, sample
from pursue_gen.proof.delays import Broken
from pursue_gen.proof.extrapolation import MaxConstants
from pursue_gen.proof.invariant import is_invariant
from pursue_gen.proof.moves import Arena, JointMove, State
from pursue_gen.proof.zones import with_neighbours
from pursue_gen.synthesis.limits import NO_LIMITS, PROVING, LimitMonitor, Limits, Listener
from pursue_gen.synthesis.strategy import Command, Strategy, Zone, ZoneKey
from pursue_gen.tga.network import Network, Objective
from pursue_gen.zones.dbm import Dbm

LIMIT = 300_000
"""So many symbolic states are explored unless the caller says otherwise; the published plans need up to some 30,000."""

_LARGE, _SOON = 20_000, 10_000
"""A safety strategy with more zones is checked as an invariant first; with fewer, after so many symbolic states."""

_EXACT = 3_000
"""So many states, and four times those of the first search, the second one with exact clock values may take."""

_MANY_ZONES = 8
"""So many zones of a discrete state become their hull, which adds plays; where one of those fails, they do not."""

_OFTEN = 8
"""A discrete state that is so often on one play of a reach game is searched for a loop that only clocks hide."""


@dataclass(frozen=True)
class Report:
    """The outcome. `reason` starts with the kind of failure; `play` says in words how it comes about, the state last.

    `used`: the zones of the strategy that plays reach (block, 'wait' or command, zone); `states`: the symbolic states.
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
    limits: Limits = NO_LIMITS,
    progress: Optional[Listener] = None,
    arenas: Optional[Callable[[int], Arena]] = None,
) -> Report:
    """Check that the strategy wins when each command takes effect up to `reaction` time units after its decision.

    `prompt`: the controller acts as soon as it comes into the zone of a command (the ideal player of UPPAAL-TIGA's
    plans); otherwise it may act anywhere in the zone, before time leaves it. Not given: prompt iff the reaction is 0.

    `ranks` (reach): a number for each zone of the strategy. If from each zone every step leads to lower numbers, plays
    end, and that is quickly seen; the ranks need not be trusted. Without them every play is followed to its end.

    A strategy that loses is never ok. A strategy that compares clock differences may in rare cases be refused
    though it wins, because extrapolation is not exact there. Whoever waits in a reach game may rely on
    one automaton at its bound that can move by itself; in a safety game all that are at their bounds must be able to.
    Raises PursueError for a network or strategy that it cannot read; with exit status 5 at a limit on time or memory.
    `progress` is called a few times a second; `arenas` as for `ClosedLoop`.
    """
    if strategy.counter:
        return Report(False, "counter-strategy: it shows why the controller loses", (), frozenset(), 0)
    if reaction < 0:
        raise PursueError([error("SYN103", f"the reaction time is {reaction}", hint="give 0 or more time units")], 2)
    prompt = reaction == 0 if prompt is None else prompt
    loop = ClosedLoop(network, objective, strategy, reaction, ranks, arenas=arenas)
    start = loop.arena.situation(loop.arena.initial).invariant
    if start is None or not start.includes(loop.arena.start):
        return Report(False, "no start: an invariant of the initial state does not hold", (), frozenset(), 0)
    monitor = LimitMonitor(limits, progress, PROVING)
    try:
        walked = _played if loop.rules.must_end else _safe
        report = walked(loop, False, False, limit, monitor)
        if prompt and not report.ok:
            report = _played(loop, True, False, limit, monitor)
        if report.ok or ranks is not None:
            return report
        # It may fail only because zones are extrapolated: search again without that, and show a play that is real.
        exact = _played(loop, prompt, True, min(limit, 4 * report.states + _EXACT), monitor)
    except MemoryError:
        raise monitor.stopped("memory") from None
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


def pruned_ranks(strategy: Strategy, report: Report, ranks: Mapping[ZoneKey, int]) -> Dict[ZoneKey, int]:
    """The ranks of the zones that are left in the pruned strategy, by where they stand there."""
    found: Dict[ZoneKey, int] = {}
    blocks = 0
    for b, block in enumerate(strategy.blocks):
        commands = -1
        for k in range(-1, len(block.commands)):
            part: Union[str, int] = "wait" if k < 0 else k
            count = len(block.wait) if k < 0 else len(block.commands[k].zones)
            left = [n for n in range(count) if (b, part, n) in report.used]
            commands += bool(left) and k >= 0
            for new, n in enumerate(left):
                found[(blocks, part if k < 0 else commands, new)] = ranks.get((b, part, n), 0)
        blocks += (blocks, "wait", 0) in found or commands >= 0
    return found


def _played(loop: ClosedLoop, prompt: bool, exact: bool, limit: int, monitor: LimitMonitor) -> Report:
    """What becomes of all plays when the strategy is played so; `exact`: zones are not extrapolated."""
    loop.rules, loop.used = replace(loop.rules, prompt=prompt), set()
    search = _check_ends if loop.rules.must_end and loop.ranks is None else _check_all
    return search(loop, (loop.arena.initial, loop.arena.start), exact, limit, monitor)


def _safe(loop: ClosedLoop, prompt: bool, exact: bool, limit: int, monitor: LimitMonitor) -> Report:
    """The same for a safety game, where it may be quicker to see that no play leaves what a strategy covers."""
    size = _size(loop.strategy)
    if size <= _LARGE:
        report = _played(loop, prompt, exact, min(limit, _SOON), monitor)
        if limit <= _SOON or not report.reason.startswith("limit"):
            return report
    if size <= limit:
        loop.rules, loop.used = replace(loop.rules, prompt=False), set()
        zones = is_invariant(loop, monitor)
        if zones is not None:
            return Report(True, "", (), frozenset(loop.used), zones)
    return _played(loop, prompt, exact, limit, monitor)


def _check_all(
    loop: ClosedLoop, start: Entry, exact: bool, limit: int, monitor: LimitMonitor, many: Optional[int] = _MANY_ZONES
) -> Report:
    """Everything that is reachable, breadth first; `many` zones of a discrete state (None: never) become one."""
    hulled = False
    found: List[Tuple[Entry, int, Optional[JointMove]]] = [(start, -1, None)]
    passed: Dict[State, List[Dbm]] = {start[0]: [start[1]]}
    pending: Deque[int] = deque([0])

    def steps_to(n: int) -> List[JointMove]:
        steps: List[JointMove] = []
        while n >= 0:
            _, n, move = found[n]
            steps += [] if move is None else [move]
        return steps[::-1]

    while pending:
        monitor.check(len(found), len(pending))
        n = pending.popleft()
        (state, zone), _, _ = found[n]
        if not any(other is zone for other in passed[state]):
            continue
        try:
            successors = loop.successors((state, zone))
        except Broken as broken:
            if hulled:
                loop.used = set()
                return _check_all(loop, start, exact, limit, monitor, None)
            return _failed(loop, broken.reason, steps_to(n), state, broken.zone, len(found))
        for move, (target, after) in successors:
            after = after if exact else loop.max_constants.extrapolate(after, target)
            known = passed.setdefault(target, [])
            if any(other.includes(after) for other in known):
                continue
            if len(found) >= limit:
                return _failed(loop, _out_of(limit), steps_to(n) + [move], target, after, len(found))
            if not exact:
                if many is not None and len(known) >= many:
                    after, hulled = reduce(Dbm.hull, known, after), True
                else:
                    after = with_neighbours(after, known)
            known[:] = [other for other in known if not after.includes(other)] + [after]
            found.append(((target, after), n, move))
            pending.append(len(found) - 1)
    return Report(True, "", (), frozenset(loop.used), len(found))


@dataclass
class _PathEntry:
    """An entry on the current play, with the entries after it that are still to be proven."""

    entry: Entry
    move: Optional[JointMove]
    left: List[Tuple[JointMove, Entry]]


def _check_ends(loop: ClosedLoop, start: Entry, exact: bool, limit: int, monitor: LimitMonitor) -> Report:
    """Depth first: an entry is proven when all that may follow it are, so every play ends in the goal."""
    proven: Dict[State, List[Dbm]] = {}
    open_zones: Dict[State, List[Dbm]] = {}
    path: List[_PathEntry] = []
    states = 0
    coming: Optional[Tuple[Optional[JointMove], Entry]] = (None, start)

    def failed(reason: str, move: Optional[JointMove], state: State, zone: Dbm) -> Report:
        steps = [step.move for step in path if step.move is not None] + ([] if move is None else [move])
        return _failed(loop, reason, steps, state, zone, states)

    while coming is not None or path:
        monitor.check(states, len(path))
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
        zone = zone if exact else loop.max_constants.extrapolate(zone, state)
        if loop.won(state) or any(other.includes(zone) for other in proven.get(state, ())):
            continue
        on_path = open_zones.setdefault(state, [])
        if _comes_back(on_path, zone, loop.max_constants, state):
            return failed("for ever: a play comes back to where it was and need not reach the goal", move, state, zone)
        if states >= limit:
            return failed(_out_of(limit), move, state, zone)
        states += 1
        try:
            successors = loop.successors((state, zone))
        except Broken as broken:
            return failed(broken.reason, move, state, broken.zone)
        on_path.append(zone)
        path.append(_PathEntry((state, zone), move, successors))
    return Report(True, "", (), frozenset(loop.used), states)


def _comes_back(on_path: Sequence[Dbm], zone: Dbm, max_constants: MaxConstants, state: State) -> bool:
    """True if a play may go round for ever.

    With exact zones each point of the zone has a predecessor in the earlier one on the path. When the zone includes
    that one, there are plays of every length, and so endless ones; likewise if it changes only in what no guard sees.
    """
    if any(zone.includes(other) for other in on_path):
        return True
    if len(on_path) < _OFTEN:
        return False
    widened = max_constants.extrapolate(zone, state)
    return any(widened == max_constants.extrapolate(other, state) for other in on_path)


def _size(strategy: Strategy) -> int:
    """The number of its zones."""
    return sum(len(b.wait) + sum(len(c.zones) for c in b.commands) for b in strategy.blocks)


def _failed(
    loop: ClosedLoop, reason: str, steps: Iterable[JointMove], state: State, zone: Dbm, states: int
) -> Report:
    """A failure, with the play that leads to it."""
    network, point = loop.arena.network, sample(zone)
    places = [f"{automaton.name}.{location}" for automaton, location in zip(network.automata, state[0])]
    places += [f"{name}={value}" for (name, _), value in zip(network.variables, state[1])]
    places += [f"{name}={point[x - 1] / loop.arena.scale}" for name, x in loop.arena.clock.items()]
    play = (*map(in_words, steps), "then: " + " ".join(places))
    return Report(False, reason, play, frozenset(loop.used), states)


def _out_of(limit: int) -> str:
    return f"limit: not decided within {limit} symbolic states"
