"""`if order then pack within T, at_most N open`: an automaton with a clock for each of those that may be open.

They take turns. One variable says which is next, N: that none is free; another one which of them waits longest. Where
nothing is open any more the first one is next again, so that games have no states that are alike.
"""

from __future__ import annotations

from typing import Iterator, List, Optional, Sequence, Tuple

from pursue_gen.language import network_names as names
from pursue_gen.language.network_names import AT_RISK, IDLE, LOSE
from pursue_gen.language.numbers import exact
from pursue_gen.language.objectives.request import requests_in
from pursue_gen.language.scenario import Event, MostOpen, Request, Scenario
from pursue_gen.tga.agents import Surroundings
from pursue_gen.tga.network import Automaton, Clause, ClockBound, Edge, Guard, Location, Sync, Test
from pursue_gen.tga.rules import Turns


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


def order_desk(scenario: Scenario, in_turn: Sequence[Tuple[str, Turns]]) -> Optional[Automaton]:
    """The automaton of what people order during a mission: events that happen only with a plan that is proven to keep
    all with them. None where they order nothing. `in_turn`: the variables of rules and counts, with their turns.

    It has a variable that is 0 in every game, so in none of them an order comes. An observer that takes an order sets
    it to 1 for this one event, together with the plan that was proven from the state behind it.
    """
    edges = tuple(_order(event, scenario, in_turn) for event in scenario.orders)
    return Automaton(names.ORDER_DESK, (Location(names.LISTENING),), names.LISTENING, edges) if edges else None


def _order(event: Event, scenario: Scenario, in_turn: Sequence[Tuple[str, Turns]]) -> Edge:
    """The edge of an order: its turn in all rules that name it, and fewer of it open than there may be."""
    turn = (
        tuple(Test(variable, number) for number in turns[event.name])
        for variable, turns in in_turn
        if event.name in turns
    )
    named = (each for _, each in requests_in(scenario.safety) if each.called_by == event.name)
    free = (fewer_open(MostOpen.of(each), scenario) for each in named)
    clauses = ((Test(names.DESK_OPEN, 1),), *turn, *free)
    happens = Sync(names.event(event.name), sends=True)
    closed = ((names.DESK_OPEN, 0),)
    return Edge(names.LISTENING, names.LISTENING, Guard(integers=clauses), happens, closed, controllable=False)
