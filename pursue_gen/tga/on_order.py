"""What people order during a mission: events that happen only with a plan that is proven to keep all with them.

Their automaton has a variable that is 0 in every game, so in none of them an order comes. An observer that takes an
order sets it to 1 for this one event, together with the plan that was proven from the state behind it.
"""

from __future__ import annotations

from typing import Optional, Sequence, Tuple

from pursue_gen.language import network_names as names
from pursue_gen.language.objectives.request import requests_in
from pursue_gen.language.scenario import Event, MostOpen, Scenario
from pursue_gen.tga.network import Automaton, Edge, Guard, Location, Sync, Test
from pursue_gen.tga.requests import fewer_open
from pursue_gen.tga.rules import Turns


def order_desk(scenario: Scenario, in_turn: Sequence[Tuple[str, Turns]]) -> Optional[Automaton]:
    """The automaton of what people order; None where they order nothing. `in_turn`: the variables of rules and counts,
    with their turns."""
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
