"""Names that are fine alone, but from which the generator would make one text for two things: in files there are texts.
"""

from __future__ import annotations

from typing import Dict, Iterator, Sequence, Tuple

from pursue_gen.diagnostics import Diagnostic, Span, error
from pursue_gen.language import network_names as names
from pursue_gen.language.loads import carriers
from pursue_gen.language.objectives.endurance import batteries_in
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.symbols import Role, Symbol

_Stated = Tuple[Span, Sequence[Symbol]]
"""The span of a statement, and the symbols that come from it."""


def check_collisions(scenario: Scenario) -> Iterator[Diagnostic]:
    """An error for each space of names in which a text would mean two things; one pair often collides in many texts."""
    for stated in (_in_network(scenario), _among_locations(scenario), _packages(scenario)):
        seen: Dict[str, Symbol] = {}
        clashes = (
            (seen[symbol], symbol, span)
            for span, symbols in stated
            for symbol in symbols
            if seen.setdefault(symbol, symbol) is not symbol and seen[symbol].meaning != symbol.meaning
        )
        for first, second, span in clashes:
            message = f"{second} would mean both {first.meaning} and {second.meaning}"
            yield error("PML105", message, span, "rename one of them so that the two words differ")
            break


def _in_network(scenario: Scenario) -> Iterator[_Stated]:
    """Whatever shares the names of the network's declarations and of the system state."""
    ways = [way for connection in scenario.connections for way in connection.directions]
    for agent in (agent for agent in scenario.agents if agent.mobile is not None):
        yield agent.span, [make(agent.name, *way) for way in ways for make in (names.movement, names.arrival)]
    yield from _numbered(scenario)
    yield from ((poi.span, [names.at(poi.name)]) for poi in scenario.pois)
    for event in scenario.events:
        yield event.span, [names.event(event.name), names.done(event.name)]
        yield event.span, [names.ORDER_DESK, names.DESK_OPEN] if event.on_order else []
        yield event.span, [names.broken_off(event.name)] if event.may_stop else []
        yield event.span, [names.busy(event.name)] if event.is_shared or event.split else []
        parts = (names.part_done(event.name), names.parts(event.name), names.parts_done(event.name))
        yield event.span, parts if event.split else []
        yield event.span, [names.count(event.name), names.times(event.name)] if event.at_most is not None else []
    for rule in scenario.rules:
        yield rule.span, [names.rule(rule.name), names.rule_turn(rule.name), names.rule_clock(rule.name)]
        yield rule.span, [names.own_turn(rule.name, agent.name) for agent in scenario.bound_by(rule)]
    for state in scenario.states:
        automaton = [names.finding(state.name), names.finding_clock(state.name)]
        automaton += [names.found(state.name, value) for value in (True, False)]
        yield state.span, automaton if state.is_found_out else [names.state(state.name)]
        yield state.span, [names.state_value(state.name)]
    for agent in scenario.agents:
        yield agent.span, [names.agent(agent.name), names.agent_position(agent.name), names.agent_clock(agent.name)]
        starts = [names.starts(agent.name, ref.name) for ref in agent.starts] if agent.is_somewhere else []
        yield agent.span, starts
        yield agent.span, [names.busy_with(agent.name)] if any(scenario.conditions()) else []
    yield from ((battery.span, [names.level(battery.agent.name)]) for battery in scenario.batteries)
    yield from ((carrier.agent.span, [names.load(carrier.agent.name)]) for carrier in carriers(scenario))


def _numbered(scenario: Scenario) -> Iterator[_Stated]:
    """What is made for objectives and assumptions, which have numbers and no names."""
    charged = dict(batteries_in(scenario.safety))
    for number, safety in enumerate(scenario.safety):
        automaton = names.safety_objective(number)
        turn = [names.safety_turn(number), names.safety_oldest(number)] if safety.order else []
        charge = [names.charge_clock(number)] if number in charged else []
        made = [automaton, names.safety_clock(number), names.safety_pause(number), *turn, *charge]
        yield safety.span, made
    for number, reach in enumerate(scenario.reach):
        made = [names.reach_objective(number), names.reach_clock(number), names.unlocking(number)]
        yield reach.span, [*made, *([] if reach.apart is None else [names.reach_apart(number)])]
    for number, assumption in enumerate(scenario.assumed, start=1):
        made = [names.assumption(number), names.assumption_count(number), names.assumption_clock(number)]
        yield assumption.span, [*made, names.assumed_way(number)]


def _among_locations(scenario: Scenario) -> Iterator[_Stated]:
    """The names of an agent's locations, with which its commands are found."""
    for way in scenario.connections:
        yield way.span, [names.going(a, b) for a, b in way.directions]
    for event in (event for event in scenario.events if event.duration is not None):
        yield event.span, [names.doing(event.name, poi.name) for poi in scenario.pois]


def _packages(scenario: Scenario) -> Iterator[_Stated]:
    for agent in scenario.agents:
        yield agent.span, [Role.PACKAGE(agent.name)]
    for agent in scenario.agents[:1]:
        yield agent.span, [Role.BRINGUP(scenario.name)]
