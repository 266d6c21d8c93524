"""A second opinion on strategies: does every play that agrees with this one meet the objective?

The closed loop of network and strategy is explored symbolically from the start. Nothing here is shared with the solver
but the zone library: network and strategy are read anew (`closed_loop`), and plays are followed in C++ (in `native`
arena.hpp: joint moves; delays.hpp: waiting and acting; closed_loop.hpp: the two together; extrapolation.hpp: of zones;
search.hpp: plays). See the design of the game for the rules.
"""

from __future__ import annotations

import operator
from collections import Counter
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from itertools import count, groupby
from typing import Callable, Dict, FrozenSet, List, Mapping, Optional, Sequence, Set, Tuple

from pursue_gen.diagnostics import PursueError, error
from pursue_gen.proof import reasons
from pursue_gen.proof.closed_loop import ClosedLoop, Depth, Found
from pursue_gen.proof.independence import proven_part
from pursue_gen.proof.moves import Arena, in_words
from pursue_gen.proof.passage_times import latest
from pursue_gen.proof.passages import Fault, played
from pursue_gen.proof.shares import shares_of
from pursue_gen.proof.stages import StagePart, parts_of
from pursue_gen.synthesis.limits import NO_LIMITS, PROVING, LimitMonitor, Limits, Listener
from pursue_gen.synthesis.strategy import Command, Strategy, Zone, ZoneKey, with_automata_of
from pursue_gen.tga.network import Network, Objective
from pursue_gen.zones.dbm import INF, Dbm, constant, is_strict

LIMIT = 1_000_000
"""So many symbolic states are explored unless the caller says otherwise. Measured on the published plans, up to some
30,000, and on a chase through a ring of 150 places, 400,000."""

_LARGE, _SOON = 20_000, 10_000
"""A safety strategy with more zones is checked as an invariant first, others after so many states. Measured on EB4."""

_EXACT = 3_000
"""The states, beside four times those of the first search, for that with exact clock values. Not measured."""

_MANY_ZONES = 8
"""So many zones of a discrete state become their hull, which adds plays; not where one fails. Not measured."""


@dataclass(frozen=True)
class ProofReport:
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
    closed: bool = False,
) -> ProofReport:
    """Check that the strategy wins when each command takes effect up to `reaction` time units after its decision.

    `prompt`: the controller acts as soon as it comes into the zone of a command (the ideal player of UPPAAL-TIGA's
    plans); otherwise it may act anywhere in the zone, before time leaves it. Not given: prompt iff the reaction is 0.

    `ranks` (reach): a number for each zone of the strategy. If from each zone every step leads to lower numbers, plays
    end, and that is quickly seen; the ranks need not be trusted. Without them every play is followed to its end.

    A strategy that loses is never ok. A strategy that compares clock differences may in rare cases be refused
    though it wins, because extrapolation is not exact there. Whoever waits in a reach game may rely on
    one automaton at its bound that can move by itself; in a safety game all that are at their bounds must be able to.
    A strategy that names a part of the network is checked for that part, once nothing else can matter there
    (`independence`). Raises PursueError for a network or strategy that it cannot read; with exit status 5 at a limit on
    time or memory, and where it cannot hold the times or clocks. `progress` is called a few times a second. `closed`:
    no play may leave what the strategy covers (safety): that is looked at first.
    """
    if strategy.counter:
        return _refused("counter-strategy: it shows why the controller loses")
    if reaction < 0:
        raise PursueError([error("SYN103", f"the reaction time is {reaction}", hint="give 0 or more time units")])
    prompt = reaction == 0 if prompt is None else prompt
    network = with_automata_of(network, strategy)
    if strategy.passages:
        return _with_passages(network, objective, strategy, reaction, LimitMonitor(limits, progress, PROVING))
    if strategy.in_parts:
        if strategy.stages and strategy.left_out_clocks:
            return _refused("left out: a strategy in stages leaves no clock out")
        proven = partial(verify, reaction=reaction, prompt=prompt, progress=progress, closed=closed)
        return _in_parts(network, objective, strategy, ranks, proven, limit, limits)
    part, matters = proven_part(network, objective, strategy)
    if matters:
        return _refused(f"left out: the strategy does not speak of what matters: {matters}")
    if not _names_all(part, strategy):
        return _refused(reasons.OTHER_NAMES)
    loop = ClosedLoop(part, objective, strategy, reaction, ranks)
    start = loop.arena.situation(loop.arena.initial).invariant
    if start is None or not start.includes(loop.arena.start):
        return _refused("no start: an invariant of the initial state does not hold")
    monitor = LimitMonitor(limits, progress, PROVING)
    try:
        with monitor:
            return _walked(loop, prompt, closed, limit, monitor)
    except MemoryError:
        raise monitor.stopped("memory") from None


def _refused(reason: str, states: int = 0) -> ProofReport:
    """The outcome without a play that shows it."""
    return ProofReport(False, reason, (), frozenset(), states)


def _walked(loop: ClosedLoop, prompt: bool, closed: bool, limit: int, monitor: LimitMonitor) -> ProofReport:
    """What becomes of all plays; where the strategy fails only because zones are extrapolated, a play that is real."""
    ends = loop.rules.must_end
    report = _played(loop, False, False, limit, monitor) if ends else _safe(loop, closed, limit, monitor)
    if prompt and not report.ok:
        report = _played(loop, True, False, limit, monitor)
    if report.ok or loop.ranks is not None:
        return report
    exact = _played(loop, prompt, True, min(limit, 4 * report.states + _EXACT), monitor)
    return report if exact.reason.startswith("limit") else exact


def _names_all(part: Network, strategy: Strategy) -> bool:
    """True if each block names the automata and variables of the part, in its order: one that names others would hold
    where nobody has looked."""
    automata = tuple(automaton.name for automaton in part.automata)
    variables = tuple(name for name, _ in part.variables)
    states = [block.state for block in strategy.blocks]
    return all(tuple([name for name, _ in state.locations]) == automata for state in states) and all(
        tuple([name for name, _ in state.values]) == variables for state in states
    )


def _with_passages(
    network: Network, objective: Objective, strategy: Strategy, reaction: Fraction, monitor: LimitMonitor
) -> ProofReport:
    """The outcome of a strategy with orders of passage: all of its plays are one course of events."""
    try:
        found = played(network, objective, strategy, monitor)
        latest(found, strategy, reaction)
    except Fault as fault:
        return _refused(f"passages: {fault}")
    used = (key for b in range(len(strategy.blocks)) for key in strategy.keys_of(b))
    return ProofReport(True, "", (), frozenset(used), len(found.course.events))


def _in_parts(
    network: Network,
    objective: Objective,
    strategy: Strategy,
    ranks: Optional[Mapping[ZoneKey, int]],
    proven: Callable[..., ProofReport],
    limit: int,
    limits: Limits,
) -> ProofReport:
    """The outcome of all stages or shares, each of which has to win (`proven`); `ranks` are those within them."""
    used: Set[ZoneKey] = set()
    states, start = 0, limits.now()
    called, taken_apart = ("share", shares_of) if strategy.shares else ("stage", parts_of)
    for part in taken_apart(network, objective, strategy):
        if part.fault:
            return _refused(f"left out: {called} {part.stage + 1} cannot be played: {part.fault}", states)
        own = None if ranks is None else _ranks_of(part, ranks)
        left = max(1, limit - states)
        report = proven(part.game, part.objective, part.strategy, limit=left, ranks=own, limits=limits.since(start))
        states += report.states
        used.update((part.numbers[b], what, n) for b, what, n in report.used if part.numbers[b] >= 0)
        if not report.ok:
            return replace(report, used=frozenset(used), states=states)
    return ProofReport(True, "", (), frozenset(used), states)


def _ranks_of(played: StagePart, ranks: Mapping[ZoneKey, int]) -> Dict[ZoneKey, int]:
    """The ranks of the blocks of a part of a stage; where it begins is before all of them."""
    place = {number: b for b, number in enumerate(played.numbers)}
    found: Dict[ZoneKey, int] = {(place[b], part, n): rank for (b, part, n), rank in ranks.items() if b in place}
    if -1 in place:
        found[(place[-1], "wait", 0)] = max(found.values(), default=0) + 1
    return found


def pruned(strategy: Strategy, report: ProofReport) -> Strategy:
    """The strategy without the blocks, commands and zones that no play reaches. Requires a report on this strategy."""
    used = report.used
    counts = Counter(b for b, _, _ in used)
    assert all(b < len(strategy.blocks) for b in counts)

    def kept(zones: Sequence[Zone], block: int, part: object) -> Tuple[Zone, ...]:
        return tuple([zone for n, zone in enumerate(zones) if (block, part, n) in used])

    blocks = []
    for b, block in enumerate(strategy.blocks):
        sizes = [len(command.zones) for command in block.commands]
        if all(sizes) and 0 < counts[b] == len(block.wait) + sum(sizes):  # as a rule
            blocks.append(block)
            continue
        commands = (Command(kept(c.zones, b, k), c.moves) for k, c in enumerate(block.commands))
        fewer = replace(block, wait=kept(block.wait, b, "wait"), commands=tuple(c for c in commands if c.zones))
        if fewer.wait or fewer.commands:
            blocks.append(fewer)
    same = len(blocks) == len(strategy.blocks) and all(map(operator.is_, blocks, strategy.blocks))
    return strategy if same else replace(strategy, blocks=tuple(blocks))


def pruned_ranks(strategy: Strategy, report: ProofReport, ranks: Mapping[ZoneKey, int]) -> Dict[ZoneKey, int]:
    """The ranks of the zones that are left in the pruned strategy, by where they stand there.

    Requires report and ranks of the strategy as it was before.
    """
    found: Dict[ZoneKey, int] = {}
    used = (key for b in range(len(strategy.blocks)) for key in strategy.keys_of(b) if key in report.used)
    for block, (_, own) in enumerate(groupby(used, key=lambda key: key[0])):
        commands = count()
        for part, keys in groupby(own, key=lambda key: key[1]):
            new = part if part == "wait" else next(commands)
            found.update(((block, new, n), ranks.get(key, 0)) for n, key in enumerate(keys))
    return found


def _played(loop: ClosedLoop, prompt: bool, exact: bool, limit: int, monitor: LimitMonitor) -> ProofReport:
    """What becomes of all plays when the strategy is played so; `exact`: zones are not extrapolated."""
    depth = Depth(prompt, exact, limit, _MANY_ZONES)
    if loop.rules.must_end and loop.ranks is None:
        return _report(loop.arena, loop.ends(depth, monitor))
    return _report(loop.arena, loop.everything(depth, monitor))


def _safe(loop: ClosedLoop, closed: bool, limit: int, monitor: LimitMonitor) -> ProofReport:
    """The same for a safety game, where it may be quicker to see that no play leaves what a strategy covers.

    Nor does extrapolation lead out of it then, as it may on a walk.
    """
    size, walked = sum(1 for block in loop.strategy.blocks for _ in block.zones), None
    if not closed and size <= _LARGE:
        walked = _played(loop, False, False, min(limit, _SOON), monitor)
        if walked.ok or (limit <= _SOON and walked.reason.startswith("limit")):
            return walked
    if size <= limit:
        found = loop.covered(monitor)
        if found is not None:
            return _report(loop.arena, found)
    if walked is not None and not walked.reason.startswith("limit"):
        return walked
    return _played(loop, False, False, limit, monitor)


def _report(arena: Arena, found: Found) -> ProofReport:
    """The outcome of a search, and of a failure the play that leads to it."""
    failure = found.failure
    if failure is None:
        return ProofReport(True, "", (), found.used, found.states)
    network, point = arena.network, sample(failure.zone)
    places = [f"{automaton.name}.{location}" for automaton, location in zip(network.automata, failure.state[0])]
    places += [f"{name}={value}" for (name, _), value in zip(network.variables, failure.state[1])]
    places += [f"{name}={point[x - 1] / arena.scale}" for name, x in arena.clock.items()]
    play = (*map(in_words, failure.play), "then: " + " ".join(places))
    return ProofReport(False, failure.reason, play, found.used, found.states)


def sample(zone: Dbm) -> Tuple[Fraction, ...]:
    """A valuation in the zone (that is ensured), small and with small denominators."""
    values: List[Fraction] = [Fraction(0)]
    for i in range(1, zone.dim):
        below = [(values[j], zone.m[j * zone.dim + i]) for j in range(i)]
        above = [(values[j], zone.m[i * zone.dim + j]) for j in range(i)]
        low, strict = max((value - constant(b), is_strict(b)) for value, b in below if b < INF)
        tops = [value + constant(b) for value, b in above if b < INF]
        if strict:
            low = (low + min(tops)) / 2 if tops and min(tops) < low + 2 else low + 1
        values.append(low)
    point = tuple(values[1:])
    assert zone.contains(point)
    return point
