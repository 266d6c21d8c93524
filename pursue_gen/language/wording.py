"""Scenarios in English sentences: objectives, speeds, kinds of agents."""

from __future__ import annotations

from typing import List

from pursue_gen.language.conditions import condition_words
from pursue_gen.language.scenario import (
    Agent,
    Always,
    Assumption,
    AtMost,
    Avoid,
    Leaves,
    NeverWith,
    Respond,
    Scenario,
    Waits,
)


def units(amount: str) -> str:
    """`1 unit`, `2 units`."""
    return f"{amount} unit{'' if amount == '1' else 's'}"


def objective_words(scenario: Scenario) -> List[str]:
    """What is wanted, a sentence for each objective."""
    safety, reach, result = scenario.safety, scenario.reach, []
    if isinstance(safety, Respond):
        deadline = units(str(safety.deadline))
        result.append(f"Whenever {safety.trigger.name} happens, {safety.response.name} happens within {deadline}.")
    elif isinstance(safety, Avoid):
        result.append(f"{safety.event.name} never happens.")
    elif isinstance(safety, NeverWith):
        where = "at one place or on one connection" if safety.place is None else f"both at {safety.place.name}"
        result.append(f"{safety.first.name} and {safety.second.name} are never {where}.")
    elif isinstance(safety, Always):
        result.append(f"It {'always' if safety.holds else 'never'} holds that {condition_words(safety.condition)}.")
    if reach:
        after = f" later than {units(str(reach.after))} after the start" if reach.after else ""
        result.append(f"{reach.event.name} happens{after}.")
    return result


def assumption_words(assumption: Assumption) -> str:
    """What is assumed, as a sentence without its full stop; the same words as in the scenario where they read well."""
    name = assumption.agent.name
    if isinstance(assumption, AtMost):
        times = "once" if assumption.times == 1 else f"{assumption.times} times"
        return (
            f"{name} does {assumption.event.name} at most {times}"
            if assumption.times
            else (f"{name} never does {assumption.event.name}")
        )
    if isinstance(assumption, Waits):
        return f"{name} waits {units(str(assumption.time))} between one {assumption.event.name} and the next"
    if isinstance(assumption, Leaves):
        return f"{name} leaves {assumption.place.name} within {units(str(assumption.time))}"
    return f"{name} is never at {assumption.place.name}"


def condition_of_promise(scenario: Scenario) -> str:
    """All that is assumed of agents that are not controlled, in one clause; "" where nothing is."""
    says = [assumption_words(assumption) for assumption in scenario.assumptions]
    return f"as long as {', and '.join(says)}" if says else ""


def speed_words(agent: Agent, scenario: Scenario) -> str:
    """How fast an agent is, in words."""
    if agent.mobile is None:
        return "stays there"
    words = [f"{agent.mobile} time unit{'' if agent.mobile == 1 else 's'} per unit of distance"]
    own = [travel for travel in scenario.travels if travel.agent.name == agent.name]
    words += [f"{travel.a.name} to {travel.b.name} in {window_words(*travel.window)}" for travel in own]
    return ", ".join(words)


def window_words(low: int, high: int) -> str:
    """Between which times something ends; a window of one time unit, which is the usual one, by its first time."""
    return str(low) if high == low + 1 else f"{low} to {high}"


def kind_words(agent: Agent) -> str:
    """What an agent is, in words."""
    if not agent.controllable:
        return "not controlled"
    return "a person who is instructed" if agent.human else "a robot"
