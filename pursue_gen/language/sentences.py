"""Sentences on a whole scenario: what is wanted, what was promised, as long as what, how fast agents are; whether
several of an event that has to be answered may be answered by one."""

from __future__ import annotations

from typing import Dict, List, Optional

from pursue_gen.diagnostics import listed
from pursue_gen.language.measures import unit_of_distance
from pursue_gen.language.numbers import Number, Window
from pursue_gen.language.scenario import Agent, Event, Scenario, StatedObjective
from pursue_gen.language.times import in_units, window_text, words_for


def objective_words(scenario: Scenario) -> List[str]:
    """What is wanted, a sentence for each objective."""
    return [objective_sentence(scenario, objective) for objective, *_ in scenario.statements]


def end_words(scenario: Scenario) -> List[str]:
    """When a mission ends, in a sentence, where the scenario says so."""
    return [end.sentence for end in scenario.ends[:1]]


def objective_sentence(scenario: Scenario, objective: StatedObjective) -> str:
    """What one objective wants, as a sentence, with its number where it is optional; where one answer may be enough for
    several, it says so."""
    text = objective.sentence(scenario.shown)
    if is_one_for_all(objective, scenario):
        text = f"{text[:-1]}, once for all that come before it."
    return f"Optional {objective.optional}: {text}" if objective.optional else text


def promise_words(scenario: Scenario) -> List[str]:
    """What has become of each number behind `optional` in a scenario that is solved, a sentence for each of them.

    Empty where nothing is optional.
    """
    said: Dict[int, str] = {}
    for number in scenario.optional:
        texts = (each.text for each in scenario.objectives if each.optional == number)
        said[number] = f"optional {number} is promised: {'; '.join(texts)}"
    for one in scenario.given_up:
        number = one.objective.optional
        texts = (each.objective.text for each in scenario.given_up if each.objective.optional == number)
        said[number] = f"optional {number} is given up, it {one.why.value}: {'; '.join(texts)}"
    return [said[number] for number in sorted(said)]


def periods_found(scenario: Scenario, won: bool = True) -> List[str]:
    """A sentence for each patrol whose period was found by solving, as far as the verdict says something about it."""
    return list(dict.fromkeys(sentence for each in scenario.patrols for sentence in each.period_found(won)))


def condition_of_promise(scenario: Scenario) -> str:
    """All that is assumed of agents that are not controlled, in one clause; "" where nothing is."""
    says = [assumption.clause for assumption in scenario.assumed]
    return f"as long as {', and '.join(says)}" if says else ""


def speed_words(agent: Agent, scenario: Scenario) -> str:
    """How fast an agent is, in words, what its battery holds, what it carries at most and at the start."""
    also = [battery.in_words for battery in scenario.powered if battery.agent.name == agent.name]
    also += [] if agent.carries is None else [f"carries {agent.carries}"]
    also += [f"has {listed([ref.shown for ref in agent.has])}"] if agent.has else []
    if agent.mobile is None:
        return ", ".join(["stays there", *also])
    pace = f"{words_for(agent.mobile, scenario.unit)} per {unit_of_distance(scenario.in_metres)}"
    words = [pace if agent.speed is None else f"{agent.speed} m/s"]
    own = [travel for travel in scenario.travels if travel.agent.name == agent.name]
    words += [f"{travel.a.shown} to {travel.b.shown} in {window_words(travel.window, scenario.unit)}" for travel in own]
    return ", ".join(words + also)


def window_words(window: Window, unit: Optional[Number]) -> str:
    """Between which times something ends; a window of one time unit, which is the usual one, by its first time.

    `unit`: the seconds of a time unit, None: the scenario does not say.
    """
    low, high = window
    return window_text(in_units(low, unit), None if high == low + 1 else in_units(high, unit))


def is_one_for_all(objective: StatedObjective, scenario: Scenario) -> bool:
    """True for `if e then f within T` where somebody who is not controlled may do e again before T is over, as far as
    statements alone say: then one f answers several of them. False where that is not sure."""
    name = objective.called_by
    if not name or objective.order:
        return False
    event = next((each for each in scenario.events if each.name == name), None)
    if event is None or not _is_free(event, scenario) or objective.known_limit <= scenario.rest:
        return False
    doers = [agent for agent in scenario.doers(name) if not agent.controllable]
    return bool(doers) and all(each.allows(name, objective.known_limit) for each in scenario.assumed)


def _is_free(event: Event, scenario: Scenario) -> bool:
    """True if nothing but who can do it restricts an event that takes no time."""
    ruled = any(ref.name == event.name for rule in scenario.rules for ref in rule.events)
    needs = any(need.event.name == event.name for need in scenario.dependencies)
    alone = event.duration is None and not event.collaborative and event.only_if is None
    return alone and event.at_most != 1 and not ruled and not needs
