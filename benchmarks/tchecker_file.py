"""Writes a network in TChecker's file format, from its documentation: the same plays, but nobody's game.

TChecker explores; who controls an edge, and how late a command takes effect, is not in its file. All plays end where
the objective's goal, or what it forbids, is reached: there the game is over.

A broadcast is a `sync` of the sender with everybody else who can receive, each with `?`. With `?` an automaton takes
part as soon as an edge leaves its location; that the guard of this edge does not hold would forbid the whole
broadcast. So the receiving edges of a location are written once for each outcome of their guards, and where none of
them is enabled as a loop that changes nothing.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Dict, Iterator, List, Mapping, Optional, Sequence, Set, Tuple

from pursue_gen.tga.network import Automaton, ClockBound, Edge, Kind, Network, Objective, Test

_NAME = re.compile(r"[A-Za-z0-9_]+")

OVER = "over"
"""The variable that is 1 from the end of the game on."""

_TAU = "tau"

_Terms = Tuple[str, ...]
"""What holds together, such as ("i_v==1", "i_w!=2")."""


def written(network: Network, objective: Objective) -> str:
    """The network as text for `tck-reach`.

    Raises ValueError for what the format, or this writer, does not have: a start in the middle of a play, a guard on
    clocks of an edge that receives, names of other characters than letters, digits and `_`.
    """
    if network.start:
        raise ValueError("TChecker's clocks start at 0; this network starts in the middle of a play")
    return "\n".join([*_declarations(network, objective), *_processes(network, objective), *_syncs(network), ""])


def _declarations(network: Network, objective: Objective) -> Iterator[str]:
    yield "system:network"
    yield from (f"event:{event}" for event in _events(network))
    yield from (f"clock:1:{_id('x', clock)}" for clock in network.clocks)
    for name, first in network.variables:
        values = [first, *(v for a in network.automata for edge in a.edges for n, v in edge.assign if n == name)]
        yield f"int:1:{min(values)}:{max(values)}:{first}:{_id('i', name)}"
    at_start = any((automaton.name, automaton.initial) in _ends(objective) for automaton in network.automata)
    yield f"int:1:0:1:{int(at_start)}:{OVER}"


def _events(network: Network) -> List[str]:
    """Each once: of edges without a channel, of senders, and of those who receive from somebody."""
    events = [_TAU]
    for automaton in network.automata:
        for edge in automaton.edges:
            event = _event(edge)
            if event not in events and (_moves(edge) or _can_receive(network, automaton, edge)):
                events.append(event)
    return events


def _processes(network: Network, objective: Objective) -> Iterator[str]:
    ends = _ends(objective)
    for automaton in network.automata:
        process = _id("p", automaton.name)
        yield f"process:{process}"
        for location in automaton.locations:
            known = ["initial:"] * (location.name == automaton.initial)
            if location.invariant:
                known.append(f"invariant: {'&&'.join(map(_bound, location.invariant))}")
            yield f"location:{process}:{_id('l', location.name)}{_attributes(known)}"
        for edge in automaton.edges:
            if _moves(edge):
                over = (automaton.name, edge.target) in ends
                for terms in _ways(edge):
                    yield _edge(process, edge, (f"{OVER}==0", *map(_bound, edge.guard.clocks), *terms), over)
        yield from _receiving(network, automaton, process, ends)


def _receiving(network: Network, automaton: Automaton, process: str, ends: Set[Tuple[str, str]]) -> Iterator[str]:
    """The receiving edges, by location and channel: for each outcome of their guards those that are enabled then."""
    groups: Dict[Tuple[str, str], List[Edge]] = {}
    for edge in automaton.edges:
        if not _moves(edge) and _can_receive(network, automaton, edge):
            if edge.guard.clocks:
                raise ValueError(f"an edge of {automaton.name} that receives has a guard on clocks")
            groups.setdefault((edge.source, _event(edge)), []).append(edge)
    for (source, event), edges in groups.items():
        for terms, enabled in _outcomes([edge.guard.integers for edge in edges]):
            for k in enabled:
                yield _edge(process, edges[k], terms, (automaton.name, edges[k].target) in ends)
            if not enabled:
                here = _id("l", source)
                yield f"edge:{process}:{here}:{here}:{event}{_attributes([_provided(terms)])}"


def _edge(process: str, edge: Edge, terms: Sequence[str], over: bool) -> str:
    changes = [f"{_id('i', name)}={value}" for name, value in edge.assign]
    changes += [f"{_id('x', clock)}=0" for clock in edge.resets]
    changes += [f"{OVER}=1"] * over
    known = [_provided(terms)] * bool(terms) + [f"do: {';'.join(changes)}"] * bool(changes)
    places = f"{_id('l', edge.source)}:{_id('l', edge.target)}"
    return f"edge:{process}:{places}:{_event(edge)}{_attributes(known)}"


def _provided(terms: Sequence[str]) -> str:
    return f"provided: {'&&'.join(terms)}"


def _attributes(known: Sequence[str]) -> str:
    return f"{{{' : '.join(known)}}}" if known else ""


def _syncs(network: Network) -> Iterator[str]:
    """For each automaton that sends on a channel: it, and everybody else who receives there."""
    for sender in network.automata:
        for channel in dict.fromkeys(e.sync.channel for e in sender.edges if e.sync is not None and e.sync.sends):
            receivers = [a.name for a in network.automata if a is not sender and _uses(a, channel, sends=False)]
            if receivers:
                parts = [f"{_id('p', sender.name)}@{_id('send', channel)}"]
                parts += [f"{_id('p', name)}@{_id('receive', channel)}?" for name in receivers]
                yield f"sync:{':'.join(parts)}"


def _moves(edge: Edge) -> bool:
    """True if it moves by itself."""
    return edge.sync is None or edge.sync.sends


def _can_receive(network: Network, automaton: Automaton, edge: Edge) -> bool:
    """True if somebody else sends on the edge's channel; without a `sync` TChecker would let it move by itself."""
    assert edge.sync is not None
    return any(other is not automaton and _uses(other, edge.sync.channel, sends=True) for other in network.automata)


def _uses(automaton: Automaton, channel: str, sends: bool) -> bool:
    return any(e.sync is not None and (e.sync.channel, e.sync.sends) == (channel, sends) for e in automaton.edges)


def _event(edge: Edge) -> str:
    if edge.sync is None:
        return _TAU
    return _id("send" if edge.sync.sends else "receive", edge.sync.channel)


def _ends(objective: Objective) -> Set[Tuple[str, str]]:
    """Where the game is over; an objective may name a place that its kind has no use for."""
    goal = () if objective.kind is Kind.SAFETY else objective.goal
    bad = () if objective.kind is Kind.REACH else objective.bad
    if len(goal) > 1:
        raise ValueError("several goals at once are not written in TChecker's format")
    return {*goal, *bad}


def _bound(bound: ClockBound) -> str:
    return f"{_id('x', bound.clock)}{bound.op}{bound.bound}"


def _id(kind: str, name: str) -> str:
    """A name with its kind before it: there is one scope for all, with words that are reserved."""
    if not _NAME.fullmatch(name):
        raise ValueError(f"'{name}' is no name in TChecker's format")
    return f"{kind}_{name}"


# Guards: the format has "and" and "not equal", but no "or" ------------------------------------------------------------

_Guard = Sequence[Sequence[Test]]
"""All of the clauses, of each at least one test."""


@dataclass(frozen=True)
class _Known:
    """What is known of the variables: equal to a value, or different from some."""

    equal: Mapping[str, int]
    different: Mapping[str, Tuple[int, ...]]

    def says(self, test: Test) -> Optional[bool]:
        """Whether the test holds; None: not known."""
        if test.variable in self.equal:
            return self.equal[test.variable] == test.value
        return False if test.value in self.different.get(test.variable, ()) else None

    def but(self, test: Test, holds: bool) -> _Known:
        """With one more test, of which nothing was known."""
        if holds:
            return _Known({**self.equal, test.variable: test.value}, self.different)
        others = (*self.different.get(test.variable, ()), test.value)
        return _Known(self.equal, {**self.different, test.variable: others})

    def terms(self) -> _Terms:
        """As expressions."""
        same = [f"{_id('i', name)}=={value}" for name, value in self.equal.items()]
        others = [(name, value) for name, values in self.different.items() for value in values]
        return (*same, *(f"{_id('i', name)}!={value}" for name, value in others if name not in self.equal))


def _ways(edge: Edge) -> Iterator[_Terms]:
    """The integer guard as alternatives of which at most one holds."""
    return (terms for terms, enabled in _outcomes([edge.guard.integers]) if enabled)


def _outcomes(guards: Sequence[_Guard], known: _Known = _Known({}, {})) -> Iterator[Tuple[_Terms, List[int]]]:
    """All cases that the guards tell apart: what holds in each, and the indices of the guards that do.

    Exactly one case holds of any values.
    """
    judged = [_judged(guard, known) for guard in guards]
    asked = next((test for _, test in judged if test is not None), None)
    if asked is None:
        yield known.terms(), [k for k, (holds, _) in enumerate(judged) if holds]
        return
    for holds in (True, False):
        yield from _outcomes(guards, known.but(asked, holds))


def _judged(guard: _Guard, known: _Known) -> Tuple[bool, Optional[Test]]:
    """Whether the guard holds, and None; or the first test that has to be known for that."""
    needed: Optional[Test] = None
    for clause in guard:
        says = [known.says(test) for test in clause]
        if True in says:
            continue
        if None not in says:
            return False, None
        needed = needed or clause[says.index(None)]
    return needed is None, needed
