"""What agents carry: a variable for the load of each, which the events that take and give something test and set.

It is the number of a load. An event begins where its end leads to a load that the agent can have, and sets it then; one
that is instantaneous does both at once.
"""

from __future__ import annotations

from typing import Dict, List, Tuple

from pursue_gen.language import network_names as names
from pursue_gen.language.loads import Carrier, carriers
from pursue_gen.language.scenario import Scenario
from pursue_gen.tga.network import Automaton, Clause, Edge, Test


def load_variables(scenario: Scenario) -> Tuple[Tuple[str, int], ...]:
    """The variables of the loads, with what is carried at the start."""
    return tuple((names.load(one.agent.name), one.loads.index(one.first)) for one in carriers(scenario))


def laden(automaton: Automaton, scenario: Scenario) -> Automaton:
    """The automaton of an agent that gives only what it has taken, and takes only what it has room for."""
    for carrier in carriers(scenario):
        if carrier.agent.name == automaton.name:
            return _carrying(automaton, carrier)
    return automaton


def _carrying(automaton: Automaton, carrier: Carrier) -> Automaton:
    variable, numbers = names.load(carrier.agent.name), {load: k for k, load in enumerate(carrier.loads)}
    begins: Dict[str, Clause] = {}
    ends: Dict[str, List[Tuple[int, int]]] = {}
    for event in carrier.events:
        following = ((number, carrier.after(event, load)) for load, number in numbers.items())
        steps = [(before, numbers[then]) for before, then in following if then is not None]
        if event.duration is not None:
            begins[names.event(event.name)] = tuple(Test(variable, before) for before, _ in steps)
        ends[names.has_happened(event)] = steps

    def edges(edge: Edge) -> List[Edge]:
        if edge.sent in begins:
            return [edge.plus(begins[edge.sent])]
        if edge.sent not in ends:
            return [edge]
        return [edge.plus((Test(variable, before),), assign=((variable, then),)) for before, then in ends[edge.sent]]

    return automaton.with_each(edges)
