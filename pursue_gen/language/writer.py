"""The text of a scenario that was built, or changed, in Python: what is solved and what robots get say the same."""

from __future__ import annotations

import math
from dataclasses import fields, is_dataclass, replace
from fractions import Fraction
from typing import Any, Iterable, Iterator, List

from pursue_gen.diagnostics import NOWHERE, PursueError, Span, error
from pursue_gen.language import scenario as pml
from pursue_gen.language.conditions import condition_text
from pursue_gen.language.formatter import format_text
from pursue_gen.language.numbers import exact
from pursue_gen.language.parser import read
from pursue_gen.language.rewriting import pose_text
from pursue_gen.language.scenario import Patrol, Ref, Scenario
from pursue_gen.language.wording import statement_text


def written(scenario: Scenario) -> Scenario:
    """The scenario itself if it has a text that says the same, poses aside; else as its new text is read.

    Raises as `scenario_text`; whether it makes sense is for `checks` to say.
    """
    if scenario.text and _meaning(read(scenario.text, "", scenario.name).scenario) == _meaning(scenario):
        return scenario
    file = scenario.file or f"{scenario.name}.pur"
    again = read(scenario_text(scenario), file, scenario.name).scenario
    assert again is not None, "a text that was compared can be read"
    return again


def scenario_text(scenario: Scenario) -> str:
    """The scenario in PuRSUE-ML, laid out, without comments but poses; what is given up is left out.

    Raises Invalid where that is no text of the language, and PursueError (API001) where it would mean something else:
    names hold what only a text can, or parts stand where the language has no place for them.
    """
    plain: Scenario = _plain(scenario)
    text = format_text("\n".join(_statements(plain)), plain.file or f"{plain.name}.pur")
    if _meaning(read(text, "", plain.name).scenario) != _meaning(plain):
        message = f"{plain.name} cannot be written in PuRSUE-ML: its text would mean something else"
        hint = "names are letters, digits and _; the places of a patrol in order are one objective for each of them"
        raise PursueError([error("API001", message, hint=hint)])
    return text


def _plain(value: Any) -> Any:
    """A part with numbers that are exact, and tuples; a float is the number that it is shown as."""
    if isinstance(value, (Fraction, float)):
        return exact(Fraction(str(value))) if math.isfinite(value) else value
    if isinstance(value, (tuple, list)):
        return tuple(map(_plain, value))
    if not is_dataclass(value) or isinstance(value, (Span, pml.Pose, type)):
        return value
    return type(value)(**{field.name: _plain(getattr(value, field.name)) for field in fields(value)})


def _meaning(value: Any) -> Any:
    """A part without what does not matter for which game is played: places in the text, poses, files."""
    if isinstance(value, Span):
        return NOWHERE
    if isinstance(value, tuple):
        return tuple(map(_meaning, value))
    if not is_dataclass(value):
        return value
    if isinstance(value, Scenario):
        value = replace(value, file="", text="", given_up=())
    elif isinstance(value, pml.Poi):
        value = replace(value, pose=None, spots=())
    elif isinstance(value, Patrol):
        value = replace(value, least=None)
    elif isinstance(value, Ref):
        return value.name
    return type(value), tuple(_meaning(getattr(value, field.name)) for field in fields(value))


def _statements(scenario: Scenario) -> Iterator[str]:
    yield from map(_poi, scenario.pois)
    yield from map(_connection, scenario.connections)
    yield from map(_event, scenario.events)
    yield from map(_rule, scenario.rules)
    yield from map(_state, scenario.states)
    for needs in scenario.dependencies:
        yield f"stateDependency: {needs.event.name} only_if {needs.state.name} is_{_truth(needs.value)}"
    yield from map(_agent, scenario.agents)
    yield from map(_travel, scenario.travels)
    yield from map(_battery, scenario.batteries)
    yield from (assumption.text for assumption in scenario.assumptions)
    yield from _objectives(scenario.safety)
    yield from _objectives(scenario.reach)


def _joined(*parts: object) -> str:
    """The parts with blanks between them, without those that are not there."""
    return " ".join(str(part) for part in parts if part not in (None, False, ""))


def _word(word: str, value: object) -> str:
    """The value behind a word; "" where there is none."""
    return "" if value in (None, "", ()) else f"{word} {value}"


def _names(refs: Iterable[Ref]) -> str:
    return ", ".join(ref.name for ref in refs)


def _label(label: object) -> str:
    return "" if label is None else f'label "{label}"'


def _truth(value: bool) -> str:
    return "true" if value else "false"


def _window(low: object, high: object) -> str:
    return f"{low}" if high is None else f"{low} to {high}"


def _poi(poi: pml.Poi) -> str:
    spots = "".join(f" {spot.robot.name} {pose_text(spot.pose)}" for spot in poi.spots)
    own = pose_text(poi.pose) if poi.pose is not None else "[none]"
    pose = f"//{own}{spots}" if poi.pose is not None or spots else ""
    return _joined(f'poi "{poi.name}"', _label(poi.label), pose)


def _connection(way: pml.Connection) -> str:
    only_if = None if way.only_if is None else condition_text(way.only_if)
    one_way = "one_way" if way.one_way else ""
    return _joined(f"connect {way.a} and {way.b} distance {way.distance}", one_way, _word("only_if", only_if))


def _event(event: pml.Event) -> str:
    return _joined(
        f'event "{event.name}"',
        _label(event.label),
        event.collaborative and "collaborative",
        event.together and "together",
        _word("location", event.location and event.location.name),
        "" if event.duration is None else f"duration {_window(event.duration, event.latest)}",
        "" if event.at_most is None else f"at_most {event.at_most} times",
        _word("only_if", event.only_if and condition_text(event.only_if)),
    )


def _rule(rule: pml.Rule) -> str:
    who = f" for each {rule.each}" if rule.each else ""
    return f'rule "{rule.name}"{who}: {_body(rule.body)}'


def _body(body: pml.RuleBody) -> str:
    if isinstance(body, Ref):
        return body.name
    word = "before" if isinstance(body, pml.Sequence) else "and" if isinstance(body, pml.Both) else "or"
    sides = (f"({_body(side)})" if not isinstance(side, Ref) else side.name for side in (body.first, body.second))
    return f" {word} ".join(sides)


def _state(state: pml.State) -> str:
    sets = _joined(_word("true_if", _names(state.true_if)), _word("false_if", _names(state.false_if)))
    return f'state "{state.name}": initially {_truth(state.initially)}{sets and f", {sets}"}'


def _agent(agent: pml.Agent) -> str:
    return _joined(
        f'agent "{agent.name}"',
        _label(agent.label),
        agent.human and "human",
        agent.controllable and "controllable",
        *(_word(word, getattr(agent, word)) for word in ("mobile", "radius", "tolerance", "inflation")),
        f"location {agent.location.name}",
        _word("can_do", _names(agent.can_do)),
        _word("reacts_to", _names(agent.reacts_to)),
    )


def _travel(travel: pml.Travel) -> str:
    takes = _window(travel.earliest, travel.latest)
    return f'travel "{travel.agent.name}" from {travel.a.name} to {travel.b.name} takes {takes}'


def _battery(battery: pml.Battery) -> str:
    uses = f'battery "{battery.agent.name}" capacity {battery.capacity} uses {battery.uses} per unit'
    return uses if battery.dock is None else f"{uses} recharges {battery.recharges} per unit at {battery.dock.name}"


def _objectives(objectives: Iterable[pml.StatedObjective]) -> Iterator[str]:
    """A statement for each objective; the places of a patrol in order have one together."""
    turns: List[pml.StatedObjective] = []
    for objective in objectives:
        turns.append(objective)
        if not isinstance(objective, Patrol) or len(turns) >= len(objective.order):
            yield statement_text(objective)
            turns = []
