"""What one discrete state's part of a strategy means while time passes: where it waits, where it acts, where it breaks.

All sets are exact unions of zones. A controller may act anywhere in a command's zone on its way, not only at the first
instant, but it acts before time leaves that zone.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Dict, Iterator, List, Optional, Sequence, Tuple

from pursue_gen.proof import reasons
from pursue_gen.proof.moves import JointMove, Situation
from pursue_gen.synthesis.strategy import ZoneKey
from pursue_gen.zones.dbm import INF, Dbm, is_strict, raw
from tests.oracle.unions import merged, outside, without


class Broken(Exception):
    """The strategy fails here: why, and the points at which it does."""

    def __init__(self, reason: str, zone: Dbm) -> None:
        super().__init__(reason)
        self.reason, self.zone = reason, zone


@dataclass(frozen=True)
class Act:
    """A command in one of its zones. `move` None: it is no joint move of the controller, and `fault` says why."""

    zone: Dbm
    key: ZoneKey
    move: Optional[JointMove]
    fault: str


@dataclass(frozen=True)
class Advice:
    """What the strategy says in one discrete state, every zone within the invariant."""

    wait: Tuple[Tuple[Dbm, ZoneKey], ...]
    acts: Tuple[Act, ...]
    near: Tuple[Tuple[int, ...], ...]
    """For each act the others whose zones are met while it may be decided or be on its way."""
    disputed: Tuple[Tuple[Dbm, ...], ...]
    """For each act the points at which the strategy says to wait as well."""

    @cached_property
    def waits(self) -> Tuple[Dbm, ...]:
        """All points to wait at, in few zones."""
        return tuple(merged([zone for zone, _ in self.wait]))

    @cached_property
    def covered(self) -> Tuple[Dbm, ...]:
        """All points for which there is advice, in few zones."""
        return (*self.waits, *merged([act.zone for act in self.acts]))

    def zones(self) -> Iterator[Tuple[Dbm, ZoneKey]]:
        """All zones of the advice."""
        yield from self.wait
        yield from ((act.zone, act.key) for act in self.acts)

    @staticmethod
    def of(wait: Sequence[Tuple[Dbm, ZoneKey]], acts: Sequence[Act], reaction: int) -> Advice:
        """The advice from its zones, for commands that may be late by `reaction`."""
        near, disputed = [], []
        for act in acts:
            flight = act.zone.up_within(reaction) if reaction else act.zone
            met = (k for k, other in enumerate(acts) if other is not act and flight.intersect(other.zone) is not None)
            near.append(tuple(met))
            both = (act.zone.intersect(zone) for zone, _ in wait)
            disputed.append(tuple(zone for zone in both if zone is not None))
        return Advice(tuple(wait), tuple(acts), tuple(near), tuple(disputed))


@dataclass(frozen=True)
class Passage:
    """What may happen from an entry: the points that are waited in, and where which command may take effect."""

    waited: Tuple[Dbm, ...]
    taken: Tuple[Tuple[JointMove, Dbm], ...]
    used: Tuple[ZoneKey, ...]

    @property
    def active(self) -> Tuple[Dbm, ...]:
        """All points at which the game may be."""
        return tuple(merged([*self.waited, *(flight for _, flight in self.taken)]))


@dataclass(frozen=True)
class Rules:
    """How the strategy is played.

    `reaction`: the longest delay of a command, in scaled time units. `prompt`: the controller acts before anything that
    the environment could not do when the command's zone was entered becomes possible; otherwise it may act anywhere in
    the zone on its way. `must_end`: waiting has to come to an end (reach), otherwise it may last for ever (safety).
    `instant`: how long after it came into a zone without a first instant a prompt controller acts at the latest; 0:
    before the environment can do anything new.
    """

    reaction: int
    prompt: bool
    must_end: bool
    instant: int = 0


def pass_time(
    entries: Sequence[Dbm], pieces: Sequence[Dbm], situation: Situation, advice: Advice, rules: Rules
) -> Passage:
    """Follow the strategy from the points of the entries until a discrete step. Raises Broken where it fails.

    `pieces`: the entries, or those of their points that are in no command's zone and perhaps others of theirs.
    """
    assert situation.invariant is not None
    acts = advice.acts
    decided: Dict[int, List[Dbm]] = {}
    for k, act in enumerate(acts):
        for entry in entries:
            common = entry.intersect(act.zone)
            if common is not None:
                _insert(decided, k, common if rules.prompt else _future_in(common, act.zone))
        if k in decided:
            pieces = without(pieces, act.zone)
    waiting: List[Dbm] = []
    used: List[ZoneKey] = []
    for piece in sorted(pieces, key=_lateness):
        # Points that were met on the way from another piece were followed with that piece.
        if not any(zone.includes(piece) for zone in waiting):
            waiting += _wait(piece, situation, advice, rules, decided)
    for zone, key in advice.wait:
        if any(not zone.is_disjoint(part) and zone.intersect(part) is not None for part in waiting):
            used.append(key)
    taken: List[Tuple[JointMove, Dbm]] = []
    for k, zones in sorted(decided.items()):
        used.append(acts[k].key)
        flights = [_flight(zone, situation, rules) for zone in zones]
        _check_decided(acts[k], zones, advice.disputed[k])
        for flight in flights:
            taken += _effects(acts[k], flight)
        for other, effect in _met_in_flight(k, flights, advice, rules.reaction):
            used.append(acts[other].key)
            taken += _effects(acts[other], effect)
    return Passage(tuple(waiting), tuple(taken), tuple(used))


def _wait(
    piece: Dbm, situation: Situation, advice: Advice, rules: Rules, decided: Dict[int, List[Dbm]]
) -> List[Dbm]:
    """Let time pass from points outside all commands' zones. Adds to `decided`; the points that are waited in."""
    assert situation.invariant is not None
    future = piece.up().intersect(situation.invariant)
    assert future is not None
    met: List[Tuple[int, Dbm]] = []
    for k, act in enumerate(advice.acts):
        common = future.intersect(act.zone)
        if common is not None:
            met.append((k, common))
    # The piece shares no point with a command's zone, so time meets no such point before one that is waited in.
    waited: List[Dbm] = [future]
    for _, common in met:
        waited = without(waited, common.up())
    uncovered = [part for zone in waited for part in outside(zone, advice.waits)]
    if uncovered:
        raise Broken(reasons.NOT_COVERED, uncovered[0])
    for k, common in met:
        if any(zone.includes(common) for zone in decided.get(k, ())):
            continue
        first: List[Dbm] = [common]
        for other, others in met:
            if other != k:
                for earlier in others.minus(common.up()):
                    first = without(first, earlier.up())
        for zone in first:
            for part in _promptly(zone, situation, rules.instant) if rules.prompt else [zone]:
                _insert(decided, k, part)
    _check_end(piece, waited, [common for _, common in met], situation, rules.must_end)
    return waited


def _promptly(zone: Dbm, situation: Situation, instant: int) -> List[Dbm]:
    """Of a command's zone, which time enters from outside: the first instants, where there are such; where the zone is
    open, the way up to the next time at which a clock reaches a constant or the environment gets a new move.

    To an ideal player all instants so soon after the entry are equivalent. Each way into the zone keeps some of them.
    With `instant` the way is as long as that.
    """
    result: List[Dbm] = []
    for start in _entrances(zone):
        at_once = start.intersect(zone)
        if at_once is not None:
            result.append(at_once)
        for late in [start] if at_once is None else start.minus(at_once):
            soon = (late.up_within(instant) if instant else _soon_after(late)).intersect(zone)
            result += [] if soon is None else [soon] if instant else _before_news(soon, situation)
    return result


def _entrances(zone: Dbm) -> List[Dbm]:
    """The points through which time enters the zone: in it, or just before it where its lower bounds are strict."""
    dim, past = zone.dim, zone.down()
    m = list(zone.m)
    m[1:dim] = [bound | 1 for bound in m[1:dim]]
    closed = past.constrained_all((0, i, m[i]) for i in range(1, dim))
    result: List[Dbm] = []
    for i in range(1, dim):
        face = None if closed is None else closed.constrained(i, 0, raw(-(m[i] >> 1), strict=False))
        if face is not None:
            result.append(face)
    return merged(result)


def _soon_after(zone: Dbm) -> Dbm:
    """What time reaches from the zone before any clock gets to a new constant (a hull of it)."""
    dim, m = zone.dim, list(zone.m)
    for i in range(1, dim):
        m[i] &= ~1
        if m[i * dim] < INF:
            m[i * dim] = (m[i * dim] + 1) & ~1
    later = Dbm.universe(dim).constrained_all((i, j, m[i * dim + j]) for i in range(dim) for j in range(dim) if i != j)
    assert later is not None
    return later


def _before_news(zone: Dbm, situation: Situation) -> List[Dbm]:
    """The points of the zone before a new move becomes possible to the environment."""
    result = [zone]
    enabled = (move.enabled for move in situation.moves if not move.controllable and move.enabled is not None)
    for new in dict.fromkeys(enabled):
        common = zone.intersect(new)
        if common is not None:
            for before in zone.minus(common.up()):
                later = before.up().intersect(common)
                result = result if later is None else without(result, later.up())
    return result


def _check_end(
    piece: Dbm, waited: Sequence[Dbm], met: Sequence[Dbm], situation: Situation, must_end: bool
) -> None:
    """Whoever is at the bound of an invariant must be able to move by itself: no command comes at the points that are
    waited in. From the piece time leads there, and to those of commands that are `met`."""
    strict = any(is_strict(bound) for _, _, bound in situation.bounds)
    if situation.bounds and not strict:
        for part in waited:
            _check_obliged(part, situation, must_end)
    elif strict or must_end:
        never = [piece]
        for common in met:
            never = without(never, common.down())
        if never and strict:
            raise Broken(reasons.NO_END, never[0])
        if never:
            raise Broken(reasons.WAITS_FOR_EVER, never[0])


def _check_obliged(points: Dbm, situation: Situation, must_end: bool) -> None:
    """At each of the points that is at the bound of an invariant someone must be able to move by itself."""
    ends: List[Tuple[int, Dbm]] = []
    for owner, clock, bound in situation.bounds:
        last = points.constrained(0, clock, raw(-(bound >> 1), strict=False))
        if last is not None:
            ends.append((owner, last))
    for owner, last in ends:
        # In a reach game one that must move is enough: it will, whoever else is at a bound as well.
        obliged = ends if must_end else [(owner, last)]
        rest: List[Dbm] = [last]
        for move in situation.moves:
            if move.controllable or move.enabled is None:
                continue
            for mover, end in obliged:
                common = end.intersect(move.enabled) if mover == move.owner else None
                if common is not None:
                    rest = without(rest, common)
        if rest:
            raise Broken(reasons.BLOCKED, rest[0])


def _flight(zone: Dbm, situation: Situation, rules: Rules) -> Dbm:
    """The points at which a command may take effect that is decided in the zone.

    Time does not take it beyond the end of an invariant: who is at its bound there moves, and the command is stale.
    """
    assert situation.invariant is not None
    if not rules.reaction:
        return zone
    reached = zone.up_within(rules.reaction)
    if situation.invariant.includes(reached) or any(is_strict(bound) for _, _, bound in situation.bounds):
        return reached
    within = reached.intersect(situation.invariant)
    assert within is not None
    try:
        _check_obliged(within, situation, rules.must_end)
    except Broken as broken:
        raise Broken(reasons.TOO_LATE, broken.zone) from None
    return within


def _met_in_flight(
    k: int, flights: Sequence[Dbm], advice: Advice, reaction: int
) -> List[Tuple[int, Dbm]]:
    """Other commands that may overtake one that is in flight, and the points at which they then take effect.

    The one that was decided first ends the time that passes here, so its flight bounds theirs.
    """
    result: List[Tuple[int, Dbm]] = []
    for flight in flights:
        for other in advice.near[k]:
            if advice.acts[other].move == advice.acts[k].move:
                continue
            common = flight.intersect(advice.acts[other].zone)
            if common is not None:
                effect = (common.up_within(reaction) if reaction else common).intersect(flight)
                assert effect is not None
                result.append((other, effect))
    return result


def _check_decided(act: Act, zones: Sequence[Dbm], disputed: Sequence[Dbm]) -> None:
    """The command must be a clear one where it is decided, and enabled."""
    for zone in zones:
        for waited in disputed:
            both = waited.intersect(zone)
            if both is not None:
                raise Broken(reasons.CONTRADICTION, both)
        if act.move is not None and act.move.enabled is not None and not act.move.enabled.includes(zone):
            raise Broken(reasons.NOT_ENABLED, zone.minus(act.move.enabled)[0])


def _effects(act: Act, points: Dbm) -> List[Tuple[JointMove, Dbm]]:
    """The command taking effect at these points. Raises Broken where it cannot."""
    if act.move is None:
        raise Broken(act.fault, points)
    if act.move.enabled is None:
        raise Broken(reasons.NOT_ENABLED, points)
    if not act.move.enabled.includes(points):
        raise Broken(reasons.TOO_LATE, points.minus(act.move.enabled)[0])
    return [(act.move, points)]


def _lateness(zone: Dbm) -> int:
    """Less for what time passes first: the sum of the clocks' lower bounds."""
    return -sum(zone.m[: zone.dim])


def _future_in(zone: Dbm, within: Dbm) -> Dbm:
    """What time reaches from the zone inside the other, of which it is a part."""
    future = zone.up().intersect(within)
    assert future is not None
    return future


def _insert(decided: Dict[int, List[Dbm]], k: int, zone: Dbm) -> None:
    """Add the zone unless it is there already."""
    zones = decided.setdefault(k, [])
    if not any(other.includes(zone) for other in zones):
        zones.append(zone)
