"""Events that can never happen because of an assumption.

Clocks are left out of the search, which makes more possible: what it finds impossible is impossible. Where there are
few discrete states, all of them are explored. Where there are many, automata and variables keep their earlier values
beside the new ones (delete relaxation, Hoffmann and Nebel 2001), which is quick and finds fewer such events.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Callable, Dict, Iterable, Iterator, Optional, Set, Tuple

from pursue_gen.diagnostics import Diagnostic, listed, warning
from pursue_gen.language.scenario import Assumption, Scenario
from pursue_gen.proof.relaxed_reachability import live
from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.synthesis.game import initial_state, joint_moves
from pursue_gen.tga import translate
from pursue_gen.tga.network import Edge, Kind, Network, Objective

_MOST_MOVES = 10_000
"""The moves between discrete states that are looked at: some tenths of a second. Not measured."""

_MOST_EDGES = 20_000
"""The edges of a network that is looked at; beyond that nothing is reported. Not measured."""

_Edges = Iterable[Tuple[str, Edge]]
"""Edges, each with its automaton."""

_Search = Callable[[Network], Optional[_Edges]]
"""The edges of a network that can be taken, or more; None: that would take too long."""

_Deeds = Set[Tuple[str, str]]
"""Agents with events that they begin."""


def check_forbidden(scenario: Scenario) -> Iterator[Diagnostic]:
    """A warning for each assumption that rules out events which are possible without any assumption."""
    if not scenario.assumptions:
        return
    for search in (_by_states, _relaxed):
        usual, kept = _possible(scenario, (), search), _possible(scenario, scenario.assumptions, search)
        if usual is not None and kept is not None:
            yield from _findings(scenario, usual, kept, search)
            return


def _findings(scenario: Scenario, usual: _Deeds, kept: _Deeds, search: _Search) -> Iterator[Diagnostic]:
    lost: Dict[Tuple[Assumption, ...], _Deeds] = {}
    alone = {(one,): _possible(scenario, (one,), search) for one in scenario.assumptions} if usual - kept else {}
    for deed in usual - kept:
        enough = next((one for one, done in alone.items() if done is not None and deed not in done), None)
        lost.setdefault(enough or scenario.assumptions, set()).add(deed)
    for assumed in sorted(lost, key=lambda some: (scenario.assumptions.index(some[0]), len(some))):
        # Of "does call at_most 0 times" nobody has to be told that there is no call.
        said = {each.excluded for each in assumed}
        words = _words(scenario, kept, lost[assumed] - said)
        if words:
            why = " and ".join(each.clause for each in assumed)
            hint = "correct what is assumed, or add what makes these events possible; if this is meant, delete them"
            yield warning("PML266", f"as long as {why}, {words}", assumed[0].span, hint)


def _words(scenario: Scenario, kept: _Deeds, lost: _Deeds) -> str:
    """Which events are impossible, and which agents have no possible event left; "" where there are none."""
    gone = {event for _, event in lost} - {event for _, event in kept}
    idle = {agent for agent, _ in lost} - {agent for agent, _ in kept}
    events = [event.name for event in scenario.events if event.name in gone]
    words = [f"{listed(events)} can never happen"] if events else []
    for agent in scenario.agents:
        if agent.name in idle:
            words.append(f"{agent.name} can do nothing{' but move' if scenario.movements(agent) else ''}")
    return ", and ".join(words)


def _possible(scenario: Scenario, assumed: Tuple[Assumption, ...], search: _Search) -> Optional[_Deeds]:
    """All edges that agents may ever take under the assumption, or more than these; None: too many to look at."""
    network = translate(replace(scenario, safety=(), reach=(), assumptions=assumed))  # objectives forbid no move
    if sum(len(automaton.edges) for automaton in network.automata) > _MOST_EDGES:
        return None
    taken = search(network)
    events = {event.name for event in scenario.events}
    return None if taken is None else {(name, edge.sent) for name, edge in taken if edge.sent in events}


def _by_states(network: Network) -> Optional[_Edges]:
    """The edges that are taken from discrete states that can be reached whatever the clocks are."""
    anywhere = network.automata[0].name, network.automata[0].initial  # a game has an objective
    game = compile_game(network, Objective(Kind.SAFETY, bad=(anywhere,)))
    first = initial_state(game)
    found, pending, moves = {first}, [first], 0
    taken: Set[int] = set()
    while pending:
        for move in joint_moves(game, pending.pop()):
            moves += 1
            if moves > _MOST_MOVES:
                return None
            taken.update(move.edges)
            if move.target not in found:
                found.add(move.target)
                pending.append(move.target)
    return [network.edges[k] for k in taken]


def _relaxed(network: Network) -> _Edges:
    """The edges that can be taken where nothing is lost that has been reached once."""
    return live(network, set(network.edges))[0].edges
