"""From a scenario to a network of timed game automata (what the original calls DSL2UP)."""

from __future__ import annotations

from collections import Counter
from typing import List, Mapping, Tuple

from pursue_gen.diagnostics import Diagnostic, error, warning
from pursue_gen.language import network_names as names
from pursue_gen.language.scenario import Scenario
from pursue_gen.outcomes import Invalid
from pursue_gen.tga.agents import Surroundings, agent_automaton
from pursue_gen.tga.apart import apart, pause_variables
from pursue_gen.tga.assumptions import assumed, assumption_clocks, assumption_variables, ways_awaited
from pursue_gen.tga.batteries import battery_variables, powered
from pursue_gen.tga.conditions import Conditions
from pursue_gen.tga.endurance import charge_clocks
from pursue_gen.tga.loads import laden, load_variables
from pursue_gen.tga.network import Network
from pursue_gen.tga.objectives import reach_automaton, safety_automaton, unlocking
from pursue_gen.tga.patrols import arrivals, awaited, turns
from pursue_gen.tga.positions import positions
from pursue_gen.tga.requests import order_desk, request_variables
from pursue_gen.tga.rules import bound, count_automaton, counted, own_turns, parts_automaton, rule_of, split
from pursue_gen.tga.states import finding_automata, first_value, found_channels, states_automaton


def translate(scenario: Scenario) -> Network:
    """The network of a scenario that has passed the checks of the language.

    It is the original's game: the ends of a controllable agent's movements and actions are controllable. Raises
    PursueError where two names of the scenario lead to one name of the network.
    """
    codes = positions(scenario.pois, scenario.connections)
    rules = [rule_of(rule, scenario.events) for rule in scenario.rules if not rule.each]
    own = tuple(own_turns(scenario))
    rules += [count_automaton(event, most) for event, most in counted(scenario)]
    rules += [parts_automaton(event, parts) for event, parts in split(scenario)]
    in_turn = tuple((names.rule_turn(automaton.name), turn) for automaton, turn in rules)
    conditions = Conditions(scenario, codes)
    around = Surroundings(scenario, codes, in_turn, conditions, awaited(scenario))
    happened = {event.name: names.has_happened(event) for event in scenario.events}
    states = states_automaton(scenario.states)
    automata = [*([states] if states else []), *finding_automata(scenario)]
    agents = [laden(powered(agent_automaton(agent, around), scenario), scenario) for agent in scenario.agents]
    automata += [apart(assumed(bound(agent, own), scenario, conditions), scenario) for agent in agents]
    desk = order_desk(scenario, in_turn)
    automata += [desk] if desk else []
    automata += ways_awaited(scenario, codes)
    automata += [safety_automaton(each, around, k) for k, each in enumerate(scenario.safety)]
    steps = unlocking(scenario)
    automata += [reach_automaton(each, happened, k, steps[k]) for k, each in enumerate(scenario.reach)]
    automata += [automaton for automaton, _ in rules]
    variables = _variables(scenario, codes.pois) + _busy(around) + conditions.variables()
    variables += assumption_variables(scenario) + turns(scenario)
    variables += tuple((turn.variable, 0) for turn in own)
    variables += (*pause_variables(scenario), *request_variables(scenario))
    variables += ((names.DESK_OPEN, 0),) if desk else ()
    variables += battery_variables(scenario) + load_variables(scenario)
    network = Network(_clocks(scenario), variables, _channels(scenario), tuple(automata))
    _check_names(network)
    return network


def translation_notes(scenario: Scenario) -> Tuple[Diagnostic, ...]:
    """Warnings: position numbers that are not the original's, and actions that the network leaves out."""
    codes = positions(scenario.pois, scenario.connections)
    around = Surroundings(scenario, codes, (), Conditions(scenario, codes))
    notes = [codes.note] if codes.note else []
    for agent in scenario.agents:
        for ref in agent.can_do:
            if not around.can_ever_do(agent, around.event(ref.name)):
                message = f"{agent.name} can never do {ref.name}: it is collaborative and no other agent reacts to it"
                notes.append(warning("TGA013", message, ref.span, f"let another agent react to {ref.name}"))
    return tuple(notes)


def _clocks(scenario: Scenario) -> Tuple[str, ...]:
    clocks = [names.agent_clock(agent.name) for agent in scenario.agents]
    clocks += [names.safety_clock(k) for k, _ in enumerate(scenario.safety)]
    clocks += [names.reach_clock(k) for k, _ in enumerate(scenario.reach)]
    clocks += [names.reach_apart(k) for k, reach in enumerate(scenario.reach) if reach.apart is not None]
    finding = (names.finding_clock(state.name) for state in scenario.states if state.is_found_out)
    return (*clocks, *assumption_clocks(scenario), *charge_clocks(scenario), *finding)


def _variables(scenario: Scenario, pois: Mapping[str, int]) -> Tuple[Tuple[str, int], ...]:
    variables = [(names.rule_turn(rule.name), 0) for rule in scenario.rules if not rule.each]
    for agent in scenario.agents:
        here = names.NOWHERE if agent.is_somewhere else pois[agent.location.name]
        variables.append((names.agent_position(agent.name), here))
    variables += [(names.state_value(state.name), first_value(state)) for state in scenario.states]
    variables += [(names.times(event.name), 0) for event, _ in counted(scenario)]
    variables += [(names.parts_done(event.name), 0) for event, _ in split(scenario)]
    return tuple(variables)


def _busy(around: Surroundings) -> Tuple[Tuple[str, int], ...]:
    """The variables of the events that happen once at a time."""
    return tuple((names.busy(event.name), 0) for event in around.scenario.events if around.is_contested(event))


def _channels(scenario: Scenario) -> Tuple[str, ...]:
    channels: List[str] = [
        names.movement(agent.name, a, b)
        for agent in scenario.agents
        if agent.mobile is not None
        for connection in scenario.ways_of(agent.name)
        for a, b in connection.directions
    ]
    somewhere = [agent for agent in scenario.agents if agent.is_somewhere]
    channels += [names.starts(agent.name, ref.name) for agent in somewhere for ref in agent.starts]
    for event in scenario.events:
        channels += [names.event(event.name), *([names.done(event.name)] if event.duration is not None else [])]
        channels += names.leaves_off(event)
    unlocks = (sync.channel for sync in unlocking(scenario) if sync is not None and sync.sends)
    return (*channels, *arrivals(scenario), *found_channels(scenario), *unlocks)


def _check_names(network: Network) -> None:
    """UPPAAL has one space of names for clocks, variables, channels and automata; locations have one per automaton."""
    shared = [*network.clocks, *(variable for variable, _ in network.variables), *network.channels]
    shared += [automaton.name for automaton in network.automata]
    spaces = [("the network", shared)]
    spaces += [(a.name, [location.name for location in a.locations]) for a in network.automata]
    hint = "rename one of the agents, POIs, events, rules or states that it is made of"
    problems = [
        error("TGA010", f"the name {name} would stand for {count} things in {space}", hint=hint)
        for space, used in spaces
        for name, count in Counter(used).items()
        if count > 1
    ]
    if problems:
        raise Invalid(problems)
