"""Batteries: a variable for the level of each, which movements and actions test and set.

An edge that begins something has an instance for each level that suffices, and takes off what that may use at most; one
that ends an action at the dock has an instance for each level, and adds what was recharged at least.
"""

from __future__ import annotations

from typing import Dict, List, Tuple

from pursue_gen.language import network_names as names
from pursue_gen.language.batteries import actions_use, full, levels, movements_use, recharges
from pursue_gen.language.scenario import Battery, Scenario
from pursue_gen.tga.network import Automaton, Edge, Test


def battery_variables(scenario: Scenario) -> Tuple[Tuple[str, int], ...]:
    """The variables of the batteries, all full."""
    return tuple((names.level(battery.agent.name), full(scenario, battery)) for battery in scenario.batteries)


def powered(automaton: Automaton, scenario: Scenario) -> Automaton:
    """The automaton of an agent that keeps to its battery, if it has one."""
    for battery in scenario.batteries:
        if battery.agent.name == automaton.name:
            return _with_battery(automaton, scenario, battery)
    return automaton


def _with_battery(automaton: Automaton, scenario: Scenario, battery: Battery) -> Automaton:
    uses: Dict[str, int] = {names.going(*way): use for way, use in movements_use(scenario, battery).items()}
    uses.update((names.doing(*action), use) for action, use in actions_use(scenario, battery).items())
    gains: Dict[str, int] = {names.doing(*action): gain for action, gain in recharges(scenario, battery).items()}
    possible, most = levels(scenario, battery), full(scenario, battery)

    def edges(edge: Edge) -> List[Edge]:
        if edge.source == edge.target:
            return [edge]
        use, gain = uses.get(edge.target, 0), 0 if edge.breaks_off else gains.get(edge.source, 0)
        if not use and not gain:
            return [edge]
        after = ((level, min(most, level - use + gain)) for level in possible if level >= use)
        return [_at_level(edge, battery, before, then) for before, then in after]

    return automaton.with_each(edges)


def _at_level(edge: Edge, battery: Battery, before: int, then: int) -> Edge:
    """The edge at this level of the battery, and the level that it leads to."""
    variable = names.level(battery.agent.name)
    return edge.plus((Test(variable, before),), assign=((variable, then),) if then != before else ())
