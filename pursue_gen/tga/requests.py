"""`if order then pack within T, at_most N open`: an automaton with a clock for each of those that may be open.

They take turns. One variable says which is next, N: that none is free; another one which of them waits longest. Where
nothing is open any more the first one is next again, so that games have no states that are alike.
"""

from __future__ import annotations

from typing import Iterator, List, Tuple

from pursue_gen.language import network_names as names
from pursue_gen.language.network_names import AT_RISK, IDLE, LOSE
from pursue_gen.language.numbers import exact
from pursue_gen.language.objectives.request import requests_in
from pursue_gen.language.scenario import MostOpen, Request, Scenario
from pursue_gen.tga.agents import Surroundings
from pursue_gen.tga.network import Automaton, Clause, ClockBound, Edge, Guard, Location, Sync, Test


def request_variables(scenario: Scenario) -> Iterator[Tuple[str, int]]:
    """The variables of all such statements with their first values."""
    for number, _ in requests_in(scenario.safety):
        yield from ((names.safety_turn(number), 0), (names.safety_oldest(number), 0))


def fewer_open(assumption: MostOpen, scenario: Scenario) -> Clause:
    """That fewer are open than there may be: one is free for the next."""
    first = next(k for k, each in requests_in(scenario.safety) if MostOpen.of(each) == assumption)
    return tuple(Test(names.safety_turn(first), k) for k in range(assumption.most))


def request_automaton(request: Request, around: Surroundings, number: int) -> Automaton:
    """At risk from a request that takes its turn to the answer that comes when no other one waits longer."""
    events, clock, own, most = around.scenario.events, names.safety_clock(number), request.number, request.most
    turn, oldest = names.safety_turn(number - own), names.safety_oldest(number - own)
    asks, answers = (
        Sync(names.has_happened(event), sends=False)
        for ref in (request.trigger, request.response)
        for event in events
        if event.name == ref.name
    )
    following = (own + 1) % most
    rest = tuple(k for k in range(most) if k not in (own, following))
    edges: List[Edge] = []

    def edge(source: str, sync: Sync, value: int, others: Tuple[int, ...], *sets: Tuple[str, int]) -> None:
        """One that tests that one variable has a value, and that the other one has one of some."""
        asked = source == IDLE
        here, there = (turn, oldest) if asked else (oldest, turn)
        tests = (Test(here, value),), tuple(Test(there, k) for k in others)
        target, resets = (AT_RISK, (clock,)) if asked else (IDLE, ())
        edges.append(Edge(source, target, Guard(integers=tests), sync, sets, resets))

    edge(IDLE, asks, own, (following,), (turn, most))
    if most > 1:
        edge(IDLE, asks, own, (own, *rest), (turn, following))
        edge(AT_RISK, answers, own, (following,), (turn, 0), (oldest, 0))
        edge(AT_RISK, answers, own, (most,), (turn, own), (oldest, following))
    else:
        edge(AT_RISK, answers, own, (most,), (turn, own))
    if rest:
        edge(AT_RISK, answers, own, rest, (oldest, following))
    edges.append(Edge(AT_RISK, LOSE))
    due = Location(AT_RISK, (ClockBound(clock, "<=", exact(request.deadline)),))
    return Automaton(names.safety_objective(number), (Location(IDLE), Location(LOSE), due), IDLE, tuple(edges))
