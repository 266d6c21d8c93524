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
from dataclasses import replace
from typing import Any, Callable, Dict, List, Mapping, Match, Optional, Set, Tuple

from pursue_gen.diagnostics import PursueError, Span, error
from pursue_gen.outcomes import Invalid
from pursue_gen.synthesis.strategy import Place, Strategy
from pursue_gen.tga.ending import is_value
from pursue_gen.tga.network import Automaton, Network
from pursue_gen.tga.part import part_of
from pursue_gen.tga.passages import Passage, passage_automaton
from pursue_gen.tga.tours import Tour, tour_automaton
from pursue_gen.tga.watchers import Watcher, watched_by

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


def read_own(text: str, network: Network, file: str) -> Strategy:
    """A strategy without blocks, with the watchers, passages and tours of a plan, whose text above its first state this
    is. Raises PursueError for one that cannot be."""
    found: Dict[str, List[Any]] = {}
    for what, (made, automaton_of) in _OWN.items():
        found[what] = []
        for match in re.finditer(rf"^ -- {what.capitalize()}:(.*)$", text, re.MULTILINE):
            words = match.group(1).split()
            own = made(words) if words else None
            if own is None or (automaton_of(network, own) is None and own.name not in network.names):
                message = f"the plan has a {what} '{' '.join(words)}', which the network cannot have"
                raise _unknown(text, match, message, file)
            found[what].append(own)
    watchers, *passages, tours = map(tuple, found.values())
    return Strategy((), watchers=watchers, passages=sum(passages, ()), tours=tours)


def _tour(words: List[str]) -> Tour:
    again = words[1] if len(words) > 1 and words[1].isascii() and words[1].isdigit() else "0"
    return Tour(words[0], tuple(words[2:]), int(again[:9]) - 1)


_OWN: Mapping[str, Tuple[Callable[[List[str]], Any], Callable[[Network, Any], Optional[Automaton]]]] = {
    "watcher": (lambda words: Watcher(words[0], tuple(words[1:])), watched_by),
    "passage": (lambda words: Passage(words[0], tuple(words[1:])), passage_automaton),
    "passage again": (lambda words: Passage(words[0], tuple(words[1:]), True), passage_automaton),
    "tour": (_tour, tour_automaton),
}
"""By the kind of a strategy's own automata what the words of its line mean, and its automaton."""


def read_parts(text: str, network: Network, file: str, own: Strategy) -> Strategy:
    """The strategy with the stages or shares of a plan, whose text above its title this is, and the clocks that it
    leaves out. Raises PursueError for an unknown milestone, place or clock."""
    given = text, network, file
    stages, shares = _read_places(*given, "Stage", "milestone"), _read_places(*given, "Share", "share for")
    return replace(own, stages=stages, shares=shares, left_out_clocks=_read_left_out_clocks(*given))


def _read_places(text: str, network: Network, file: str, line: str, what: str) -> Tuple[Tuple[Place, ...], ...]:
    known = {(automaton.name, location.name) for automaton in network.automata for location in automaton.locations}
    stages: List[Tuple[Place, ...]] = []
    for match in re.finditer(rf"^ -- {line}:(.*)$", text, re.MULTILINE):
        milestones = []
        for word in match.group(1).split():
            name, sign, value = re.split(r"([.=]|$)", word, maxsplit=1)
            if not (is_value(network, (name, value)) if sign == "=" else (name, value) in known):
                raise _unknown(text, match, f"the plan has a {what} '{word}', which the network does not have", file)
            milestones.append((name, value))
        stages.append(tuple(milestones))
    return tuple(stages)


def _read_left_out_clocks(text: str, network: Network, file: str) -> Tuple[str, ...]:
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
