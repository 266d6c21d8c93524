"""What changes in a mission beside where agents are: conditions, turns, counts, states, deadlines, assumptions."""

from __future__ import annotations

from typing import Dict, List, Tuple

from pursue_gen.language import network_names as names
from pursue_gen.language.conditions import Condition, condition_text
from pursue_gen.language.network_names import has_happened
from pursue_gen.language.objectives.base import Breaks
from pursue_gen.language.scenario import Scenario
from pursue_gen.tools.report.recording import Recording, Stay, Step, lasting
from pursue_gen.tools.simulation.meaning import holds
from pursue_gen.vocabulary.statuses import statuses


def conditions(scenario: Scenario) -> Dict[str, Condition]:
    """The conditions of a scenario by their texts, each once, in its order."""
    found: Dict[str, Condition] = {}
    for condition, _ in scenario.conditions():
        found.setdefault(condition_text(condition), condition)
    return found


def holding(recording: Recording, condition: Condition) -> Tuple[Stay, ...]:
    """When a condition held."""
    changes = ((step.at, str(_holds(recording, condition, step))) for step in recording.steps)
    return tuple(stay for stay in lasting(recording, changes) if stay.what == "True")


def pauses(scenario: Scenario) -> Dict[str, Breaks]:
    """The objectives that want a pause, by the name of a lane."""
    found = [(how, how.last, how.too_soon) for how in (each.breaks for each in scenario.safety)]
    return {f"pause: {last.shown} → {then.shown}": how for how, last, then in found if last and then}


def paused(recording: Recording, how: Breaks) -> Tuple[Tuple[Stay, float], ...]:
    """When an event had to wait until its pause was over, each with the end of the pause."""
    ended = next(has_happened(each) for each in recording.scenario.events if how.last and each.name == how.last.name)
    starts = [step.at for step in recording.steps if step.event == ended]
    found: List[Tuple[Stay, float]] = []
    for start, later in zip(starts, [*starts[1:], float("inf")]):
        until = start + float(how.pause)
        end = min(until, later, recording.end)
        found.append((Stay(start, end, ended, end < recording.end), until))
    return tuple(found)


def broken(recording: Recording) -> Tuple[Tuple[str, Stay], ...]:
    """The assumptions that were broken, in words, and since when."""
    found: List[Tuple[str, Stay]] = []
    for number, assumption in enumerate(recording.scenario.assumed, start=1):
        variable = names.assumption(number)
        changes = ((step.at, str(step.values.get(variable, 1))) for step in recording.steps)
        found += [(assumption.clause, stay) for stay in lasting(recording, changes) if stay.what == "0"]
    return tuple(found)


def changes(recording: Recording) -> Tuple[str, ...]:
    """For each step what it has changed, as in `bag of bot: next: unload`; "" where that is nothing."""
    shown = [_texts(recording, step) for step in recording.steps]
    found = []
    for before, now in zip([{}, *shown], shown):
        found.append("; ".join(f"{label}: {text}" for label, text in now.items() if before.get(label) != text))
    return tuple(found)


def _texts(recording: Recording, step: Step) -> Dict[str, str]:
    """label → what that is at."""
    texts = {}
    for status in statuses(recording.scenario, recording.network):
        value = status.text(step.locations, step.values)
        if value is not None:
            texts[status.label] = value
    for text, condition in conditions(recording.scenario).items():
        texts[text] = "holds" if _holds(recording, condition, step) else "does not hold"
    return texts


def _holds(recording: Recording, condition: Condition, step: Step) -> bool:
    """True if the condition holds in a state; False also where the state is not one of this scenario."""
    try:
        return holds(condition, recording.scenario, step.locations, step.values)
    except KeyError:
        return False
