"""The part of a scenario that decides whether some of its objectives can be promised; which of them exclude each other:
found by solving with fewer of them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Collection, FrozenSet, List, Optional, Sequence, Set, Tuple

from pursue_gen.diagnostics import listed
from pursue_gen.explanation.ablations import without_agent
from pursue_gen.language.names import events_used
from pursue_gen.language.scenario import Rule, Scenario, StatedObjective
from pursue_gen.outcomes import LimitHit
from pursue_gen.solving.one_robot import robot_alone
from pursue_gen.solving.rules import Rules, played
from pursue_gen.solving.without_pauses import verdict_of
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.cone import cone_of_influence
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Network, Objective
from pursue_gen.tga.objectives import stated


def with_objectives(scenario: Scenario, kept: Collection[StatedObjective]) -> Scenario:
    """The scenario with these of its objectives alone."""
    return scenario.with_each(lambda each: each if any(each is other for other in kept) else None)


def statements_of(scenario: Scenario, automata: Collection[str]) -> Tuple[StatedObjective, ...]:
    """The objectives that these automata watch, of a patrol in order with all of its places."""
    named = [objective for name, objective in stated(scenario).items() if name in automata]
    some = (statement for statement in scenario.statements if any(a is b for a in statement for b in named))
    return tuple(objective for statement in some for objective in statement)


def part_of_scenario(scenario: Scenario, objectives: Sequence[StatedObjective], rules: Rules) -> Scenario:
    """The scenario with these objectives alone, without the events and agents that cannot matter to them: it can be
    won if and only if they can be promised."""
    part = _without_events(with_objectives(scenario, objectives))
    matter = {automaton.name for automaton in cone_of_influence(*game_of(part, rules)).automata}
    for agent in part.agents:
        if agent.name not in matter:
            part = without_agent(part, agent.name) or part
    return part


def with_one_robot(scenario: Scenario, rules: Rules) -> Scenario:
    """The scenario in which all robots stand still but the one that alone can do something about what is wanted; the
    scenario itself where there is none."""
    robot = robot_alone(*game_of(scenario, rules))
    if robot is None:
        return scenario
    agents = (
        replace(agent, mobile=None, speed=None, can_do=()) if agent.controllable and agent.name != robot else agent
        for agent in scenario.agents
    )
    return replace(scenario, agents=tuple(agents))


def game_of(scenario: Scenario, rules: Rules) -> Tuple[Network, Objective]:
    """The network of a scenario as it is played under the rules, as far as they are about its agents, and its
    objective."""
    return played(translate(scenario), rules_for(scenario, rules)), scenario_objective(scenario)


def rules_for(scenario: Scenario, rules: Rules) -> Rules:
    """The rules with the slack of the agents that the scenario has."""
    names = {agent.name for agent in scenario.agents}
    return replace(rules, slack={name: late for name, late in rules.slack.items() if name in names})


def _without_events(scenario: Scenario) -> Scenario:
    """The scenario without the events with which robots only pass their time, and without the rules of these alone.

    A robot does such an event alone, and nothing says so. As it takes part in nothing else and has no battery, it can
    as well stand still meanwhile, and is ready sooner then.
    """
    idle = _pastimes(scenario)
    while True:
        bound = {name for rule in scenario.rules for name in _named(rule) if not _named(rule) <= idle}
        if bound.isdisjoint(idle):
            break
        idle -= bound
    return replace(
        scenario,
        events=tuple(event for event in scenario.events if event.name not in idle),
        rules=tuple(rule for rule in scenario.rules if not _named(rule) <= idle),
        dependencies=tuple(need for need in scenario.dependencies if need.event.name not in idle),
        agents=tuple(replace(a, can_do=tuple(r for r in a.can_do if r.name not in idle)) for a in scenario.agents),
    )


def _pastimes(scenario: Scenario) -> Set[str]:
    """The events, rules aside, that only robots do, each alone, who take part in nothing else and have no battery; and
    that change no state, take and give nothing, and are named in no condition and by no
    objective."""
    charged = {battery.agent.name for battery in scenario.powered}
    busy = [a for a in scenario.agents if not a.controllable or a.reacts_to or a.name in charged]
    used = events_used(replace(scenario, rules=(), dependencies=(), agents=()))
    used = used.union(ref.name for agent in busy for ref in (*agent.can_do, *agent.reacts_to))
    alone = (event for event in scenario.events if not event.collaborative and not event.load_words)
    return {event.name for event in alone} - used


def _named(rule: Rule) -> FrozenSet[str]:
    return frozenset(ref.name for ref in rule.events)


_SHARE = 0.5
"""The part of what is left of the budget that one game may take. Measured on the third ecobot."""


@dataclass(frozen=True)
class Conflict:
    """Objectives that cannot be promised together. `least`: without any one of them the others of these can."""

    objectives: Tuple[StatedObjective, ...]
    least: bool
    of: int

    def in_words(self) -> str:
        """A sentence or two."""
        texts = [f"'{objective.full_text}'" for objective in self.objectives]
        if len(texts) == 1:
            return f"{texts[0]} cannot be promised, even as the only objective."
        if self.least and len(texts) == self.of == 2:
            return f"Of {listed(texts)} each alone can be promised, both together cannot."
        rest = " Without any one of them the others of these can." if self.least else ""
        return f"{listed(texts)} cannot be promised together.{rest}"


def conflict(scenario: Scenario, rules: Rules, budget: Budget) -> Optional[Conflict]:
    """As few objectives of a lost scenario as still cannot be promised together; None where it has one alone.

    What must always hold is left out first: without anything to reach it would have to hold for ever.
    """
    statements = scenario.statements
    if len(statements) < 2:
        return None
    kept: List[StatedObjective] = list(scenario.objectives)
    least = True
    for statement in statements:
        fewer = [other for other in kept if not any(other is one for one in statement)]
        won = _won(scenario, fewer, rules, budget) if fewer else True
        if won is False:
            kept = fewer
        least = least and won is not None
    # Of a patrol in order the first place stands for all of them: they have one text.
    firsts = tuple(statement[0] for statement in statements if any(statement[0] is one for one in kept))
    return Conflict(firsts, least, len(statements))


def _won(scenario: Scenario, objectives: List[StatedObjective], rules: Rules, budget: Budget) -> Optional[bool]:
    """Whether these alone can be promised; None: not decided within the budget."""
    try:
        game = game_of(with_objectives(scenario, objectives), rules)
        return verdict_of(budget, *game, rules.reaction, _SHARE).won
    except LimitHit:
        return None
