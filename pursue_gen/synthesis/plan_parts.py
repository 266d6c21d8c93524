"""The lines of a plan that say what it does not speak of, or which stages or shares it has, written and read:

    -- Left out: visitor Pvisitor
    -- Left out clocks: Cguest
    -- Stage: Slocked=1
    -- Stage: rule1.rule10 rule2.rule20
    -- Stage: reachObj.win
    -- Watcher: obj3 bot1
    -- Share: obj.lose obj3_for_bot1.lose obj3.lose
    -- Passage: hall2 bot1 bot3 bot1
    -- Passage again: hall2 bot1 bot3
    -- Tour: bot1 2 dock hall1 room1

In a plan with stages, shares or passages each block names what matters to it. A stage's milestones are locations of
automata and values of variables; a share's places are what it avoids. A watcher is an objective's automaton, and the
robots for whom alone another one (here `obj3_for_bot1`) watches the same; a passage is a place, and the robots that are
there one after the other, over and over if `again`. A tour is a robot and the places that it comes to one after the
other, behind the number, from 1, of the one that follows the last.
"""

from __future__ import annotations

import re
from functools import partial
from typing import Callable, List, Match, Optional, Pattern, Set, Tuple, TypeVar

from pursue_gen.diagnostics import PursueError, Span, error
from pursue_gen.outcomes import Invalid
from pursue_gen.synthesis.strategy import Place, Strategy
from pursue_gen.tga.ending import is_value
from pursue_gen.tga.network import Automaton, Network
from pursue_gen.tga.part import part_of
from pursue_gen.tga.tours import Passage, Tour, passage_automaton, tour_automaton
from pursue_gen.tga.watchers import Watcher, watched_by

Own = TypeVar("Own", Watcher, Passage, Tour)

_STAGE = re.compile(r"^ -- Stage:(.*)$", re.MULTILINE)
_OWN = {
    what: re.compile(rf"^ -- {what.capitalize()}:(.*)$", re.MULTILINE)
    for what in ("watcher", "passage", "passage again", "tour")
}
_SHARE = re.compile(r"^ -- Share:(.*)$", re.MULTILINE)
_LEFT_OUT_CLOCKS = re.compile(r"^ -- Left out clocks:(.*)$", re.MULTILINE)
_LEFT_OUT = re.compile(r"^ -- Left out:(.*)$", re.MULTILINE)


def left_out_lines(strategy: Strategy, network: Network) -> List[str]:
    """The lines with the automata, variables and clocks that the strategy leaves out; none where there are none.

    Of a strategy in stages a line for each of them, with its milestones; of one in shares with what each avoids; of one
    with passages with their robots.
    """
    if not strategy.blocks:
        return []
    clocks = [f" -- Left out clocks: {' '.join(strategy.left_out_clocks)}"] if strategy.left_out_clocks else []
    if strategy.passages:
        return [
            f" -- Passage{' again' * each.again}: {' '.join((each.place, *each.robots))}" for each in strategy.passages
        ]
    if strategy.shares:
        shares = [f" -- Share: {' '.join(map('.'.join, avoided))}" for avoided in strategy.shares]
        return [*follower_lines(strategy), *shares, *clocks]
    if strategy.stages:
        variables = dict(network.variables)
        return [
            f" -- Stage: {' '.join(('=' if name in variables else '.').join((name, at)) for name, at in milestones)}"
            for milestones in strategy.stages
        ]
    state = strategy.blocks[0].state
    named = {name for name, _ in (*state.locations, *state.values)}
    every = (*(automaton.name for automaton in network.automata), *(name for name, _ in network.variables))
    left = [name for name in every if name not in named]
    return [*([f" -- Left out: {' '.join(left)}"] if left else []), *clocks]


def follower_lines(strategy: Strategy) -> List[str]:
    """The lines with the watchers and tours of a strategy."""
    watchers = [f" -- Watcher: {' '.join((each.objective, *each.team))}" for each in strategy.watchers]
    tours = [f" -- Tour: {' '.join((t.robot, str(t.again + 1), *t.stops))}" for t in strategy.tours]
    return [*watchers, *tours]


def read_stages(text: str, network: Network, file: str) -> Tuple[Tuple[Place, ...], ...]:
    """The stages of a plan, whose text above its title this is. Raises PursueError for an unknown milestone."""
    return _read_places(text, network, file, _STAGE, "milestone")


def read_shares(text: str, network: Network, file: str) -> Tuple[Tuple[Place, ...], ...]:
    """The shares of such a plan. Raises PursueError for an unknown place."""
    return _read_places(text, network, file, _SHARE, "share for")


def read_watchers(text: str, network: Network, file: str) -> Tuple[Watcher, ...]:
    """The watchers of such a plan. Raises PursueError for one that nobody can be."""
    return _read_own(text, network, file, "watcher", lambda each: Watcher(each[0], tuple(each[1:])), watched_by)


def read_passages(text: str, network: Network, file: str) -> Tuple[Passage, ...]:
    """The passages of such a plan. Raises PursueError for one that cannot be."""
    once, again = (
        _read_own(text, network, file, what, partial(_passage, again=again), passage_automaton)
        for what, again in (("passage", False), ("passage again", True))
    )
    return (*once, *again)


def _passage(words: List[str], again: bool) -> Passage:
    return Passage(words[0], tuple(words[1:]), again)


def read_tours(text: str, network: Network, file: str) -> Tuple[Tour, ...]:
    """The tours of such a plan. Raises PursueError for one that cannot be."""

    def tour(words: List[str]) -> Tour:
        again = words[1] if len(words) > 1 and words[1].isascii() and words[1].isdigit() else "0"
        return Tour(words[0], tuple(words[2:]), int(again[:9]) - 1)

    return _read_own(text, network, file, "tour", tour, tour_automaton)


def _read_own(
    text: str,
    network: Network,
    file: str,
    what: str,
    made: Callable[[List[str]], Own],
    automaton_of: Callable[[Network, Own], Optional[Automaton]],
) -> Tuple[Own, ...]:
    """The strategy's own automata of one kind, as the words of their lines say."""
    found: List[Own] = []
    for match in _OWN[what].finditer(text):
        words = match.group(1).split()
        own = made(words) if words else None
        if own is None or (automaton_of(network, own) is None and own.name not in network.names):
            message = f"the plan has a {what} '{' '.join(words)}', which the network cannot have"
            raise _unknown(text, match, message, file)
        found.append(own)
    return tuple(found)


def _read_places(
    text: str, network: Network, file: str, line: Pattern[str], what: str
) -> Tuple[Tuple[Place, ...], ...]:
    known = {(automaton.name, location.name) for automaton in network.automata for location in automaton.locations}
    stages: List[Tuple[Place, ...]] = []
    for match in line.finditer(text):
        milestones = []
        for word in match.group(1).split():
            name, sign, value = re.split(r"([.=]|$)", word, maxsplit=1)
            if not (is_value(network, (name, value)) if sign == "=" else (name, value) in known):
                raise _unknown(text, match, f"the plan has a {what} '{word}', which the network does not have", file)
            milestones.append((name, value))
        stages.append(tuple(milestones))
    return tuple(stages)


def read_left_out_clocks(text: str, network: Network, file: str) -> Tuple[str, ...]:
    """The clocks that a plan leaves out, whose text above its title this is. Raises PursueError for an unknown one."""
    clocks: List[str] = []
    for match in _LEFT_OUT_CLOCKS.finditer(text):
        clocks += match.group(1).split()
        unknown = [clock for clock in clocks if clock not in network.clocks]
        if unknown:
            message = f"the plan leaves out the clock '{unknown[0]}', which the network does not have"
            raise _unknown(text, match, message, file)
    return tuple(clocks)


def _unknown(text: str, match: Match[str], message: str, file: str) -> PursueError:
    line = text.count("\n", 0, match.start()) + 1
    span = Span(file, line, 1, line, len(match.group()) + 1)
    return Invalid([error("PLN005", message, span, "read the plan with the network that it was made for")])


def spoken_of(text: str, network: Network, file: str) -> Network:
    """The part of the network that a plan speaks of, whose text above its title this is.

    Raises PursueError where it leaves out what the network does not have.
    """
    left: Set[str] = set()
    automata, variables = {a.name for a in network.automata}, {name for name, _ in network.variables}
    for match in _LEFT_OUT.finditer(text):
        left.update(match.group(1).split())
        unknown = sorted(left - automata - variables)
        if unknown:
            message = f"the plan leaves out '{unknown[0]}', which the network does not have"
            raise _unknown(text, match, message, file)
    return part_of(network, automata - left, variables - left)
