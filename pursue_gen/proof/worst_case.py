"""How long a strategy takes to the goal at worst, when the controller acts as soon as it may.

The closed loop of network and strategy is played as the checker plays it (see `verify`), with one more clock, that
counts from the start and is never reset. The result is the latest time at which a play comes to the goal.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import partial
from typing import Dict, Iterable, Optional, Tuple

from pursue_gen.diagnostics import PursueError
from pursue_gen.language.network_names import AT_RISK
from pursue_gen.proof.closed_loop import ClosedLoop
from pursue_gen.proof.independence import named_part
from pursue_gen.proof.passage_times import INSTANT, deadlines, latest
from pursue_gen.proof.passages import Fault, played
from pursue_gen.proof.shares import shares_of
from pursue_gen.proof.stages import parts_of
from pursue_gen.synthesis.limits import NO_LIMITS, LimitMonitor, Limits
from pursue_gen.synthesis.strategy import Strategy, with_automata_of
from pursue_gen.tga.network import Automaton, ClockBound, Constraint, Location, Network, Objective

LIMIT = 20_000
"""So many symbolic states are explored. Not measured."""

_BLOCKS = 2
"""A strategy with more blocks than so many times the limit is not played: each block takes at least one symbolic state
where plays come to it, and few do not. Measured on a chase through a ring of 150 places."""

_MANY = 8
"""So many zones of a discrete state become their hull: a time may then come out too long. Not measured."""

LONGEST = 100_000
"""Times above this number of time units are not distinguished. Not measured."""

_USUAL = 1_000
"""Most plays end sooner, in time units: with this deadline the checker's narrow numbers do. Measured on CT4."""


def counting_clock(network: Network) -> Optional[str]:
    """A clock of the network that is 0 at the start and that no edge resets, so that it counts the time from there."""
    other = {clock for _, edge in network.edges for clock in edge.resets}
    if network.start:
        other |= {clock for clock in network.clocks if _is_zero(clock) not in network.start}
    return next((clock for clock in network.clocks if clock not in other), None)


def _is_zero(clock: str) -> Constraint:
    return Constraint(clock, None, Fraction(0), False)


def with_counter(network: Network) -> Network:
    """The network, with a clock that counts from the start if it has none. Ensures that `counting_clock` finds one."""
    if counting_clock(network) is not None:
        return network
    name = "elapsed"
    while name in network.clocks:
        name += "_"
    start = (*network.start, _is_zero(name)) if network.start else ()
    return replace(network, clocks=(*network.clocks, name), start=start)


def with_deadline(network: Network, objective: Objective, bound: int) -> Network:
    """The network in which the goal has to be reached while the counting clock is at most `bound` time units.

    Requires such a clock (see `with_counter`), and 0 time units or more.
    """
    clock = counting_clock(network)
    assert clock is not None and bound >= 0
    return with_clock_limit(network, objective, clock, bound)


def with_clock_limit(network: Network, objective: Objective, clock: str, bound: int) -> Network:
    """The network in which the goal has to be reached while the clock is at most `bound` time units.

    Of several locations of the goal each bounds the clock: where one waits for another at the deadline, time is blocked
    and nobody is obliged to move, which does not reach the goal. Requires a clock of the network.
    """
    assert clock in network.clocks
    limit = ClockBound(clock, "<=", bound)

    def limited(automaton: Automaton, location: Location) -> Location:
        if (automaton.name, location.name) not in objective.goal:
            return location
        return replace(location, invariant=(*location.invariant, limit))

    return network.with_each(lambda automaton: automaton.with_locations(partial(limited, automaton)))


def worst_case(
    network: Network,
    objective: Objective,
    strategy: Strategy,
    reaction: Fraction = Fraction(0),
    limit: int = LIMIT,
    limits: Limits = NO_LIMITS,
) -> Optional[Fraction]:
    """The latest time at which the goal is reached, in time units, of a strategy that wins a reach game.

    The controller decides as soon as it comes into the zone of a command, within INSTANT where that has no first
    instant; a command takes effect up to `reaction` after its decision. None where that is not found out with `limit`
    symbolic states or within the limits, where there is no bound, or where the strategy fails when it is played so.
    """
    if not objective.reaches:
        return None
    if strategy.passages:
        return _of_course(network, objective, strategy, reaction, limits)
    if strategy.stages:
        return _of_stages(network, objective, strategy, reaction, limit, limits)
    if strategy.shares:
        games = shares_of(with_automata_of(network, strategy), objective, strategy)
        own = next((part for part in games if part.objective.reaches and not part.fault), None)
        return None if own is None else worst_case(own.game, own.objective, own.strategy, reaction, limit, limits)
    if len(strategy.blocks) > _BLOCKS * max(limit, LIMIT):
        return None
    counted, monitor = with_counter(named_part(network, strategy)), LimitMonitor(limits)
    for longest in (_USUAL, LONGEST):
        game = with_deadline(counted, objective, longest)
        loop = ClosedLoop(game, objective, strategy, reaction, None, INSTANT)
        try:
            with monitor:
                latest = loop.latest(loop.arena.clock[counting_clock(game) or ""], limit, monitor)
        except PursueError:
            return None
        if not latest.fails:
            return None if latest.value is None else Fraction(latest.value, loop.arena.scale)
    return None


def answer_times(
    network: Network,
    objective: Objective,
    strategy: Strategy,
    reaction: Fraction = Fraction(0),
    limit: int = LIMIT,
    limits: Limits = NO_LIMITS,
) -> Dict[str, Fraction]:
    """How long each objective's deadline runs at worst until it is met, by automata, in time units, where a strategy
    that wins is played as `worst_case` says. What was not found out is not in it, nor a deadline that never runs."""
    if strategy.passages:
        course = played(with_automata_of(network, strategy), objective, strategy, LimitMonitor(limits))
        return deadlines(course, strategy, reaction)
    found: Dict[str, Fraction] = {}
    watched = {watcher.name: watcher.objective for watcher in strategy.watchers}
    games: Iterable[Tuple[Network, Objective, Strategy]] = ((network, objective, strategy),)
    if strategy.in_parts:
        games = ((part.game, part.objective, part.strategy) for part in shares_of(network, objective, strategy))
    for whole, wanted, own in games if not strategy.stages else ():
        if len(own.blocks) > _BLOCKS * limit:
            continue
        game = named_part(whole, own)
        loop = ClosedLoop(game, wanted, own, reaction, None, INSTANT)
        for k, automaton in enumerate(game.automata):
            if AT_RISK not in automaton.stays or automaton.name not in dict(wanted.bad):
                continue
            clock, took = loop.arena.clock[automaton.stays[AT_RISK][0].clock], None
            for many in (0, _MANY):
                try:
                    took = took or loop.latest(clock, limit, LimitMonitor(limits), (k, AT_RISK), many).value
                except PursueError:
                    return found
            if took:
                found[watched.get(automaton.name, automaton.name)] = Fraction(took, loop.arena.scale)
    return found


def _of_course(
    network: Network, objective: Objective, strategy: Strategy, reaction: Fraction, limits: Limits
) -> Optional[Fraction]:
    """The longest way through the events of a strategy with orders of passage."""
    try:
        found = played(with_automata_of(network, strategy), objective, strategy, LimitMonitor(limits))
        return latest(found, strategy, reaction)
    except (Fault, PursueError):
        return None


def _of_stages(
    network: Network, objective: Objective, strategy: Strategy, reaction: Fraction, limit: int, limits: Limits
) -> Optional[Fraction]:
    """The stages one after the other; each takes as long as the slowest of its parts."""
    slowest: Dict[int, Fraction] = {}
    start = limits.now()
    for part in parts_of(network, objective, strategy):
        took = worst_case(part.game, part.objective, part.strategy, reaction, limit, limits.since(start))
        if part.fault or took is None:
            return None
        slowest[part.stage] = max(took, slowest.get(part.stage, took))
    return sum(slowest.values(), Fraction(0))
