"""What can be changed in a lost game, each by steps from the smallest change to the largest."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any, Iterator, Sequence, Tuple, Union, cast

from pursue_gen.diagnostics import Span
from pursue_gen.explanation.ablations import without_conditions
from pursue_gen.explanation.number_changes import (
    SLOWER,
    Repair,
    as_written,
    assumption_changes,
    battery_changes,
    count_changes,
    event_changes,
    load_changes,
    travel_changes,
)
from pursue_gen.language.clauses import Domains
from pursue_gen.language.loads import carriers
from pursue_gen.language.numbers import Number, decimal_text, exact, whole_above, whole_below
from pursue_gen.language.objectives.base import Easier
from pursue_gen.language.scenario import Agent, Connection, Door, Event, Lift, Ref, Scenario, StatedObjective
from pursue_gen.language.statements.event import MOST_EVENT_PARTS
from pursue_gen.language.template import name_text
from pursue_gen.language.times import instead, like
from pursue_gen.solving.rules import CONTROLLABLE, IDEAL, REPORTED, Rules
from pursue_gen.tga.rules import counted

_FINEST = 1000
"""The largest denominator of a reaction that the command line takes."""


def repairs(scenario: Scenario, rules: Rules) -> Iterator[Repair]:
    """All that can be changed, in the order in which they are worth knowing (and the quick ones first)."""
    yield from as_written(scenario, _repairs(scenario, rules))


def _repairs(scenario: Scenario, rules: Rules) -> Iterator[Repair]:
    yield from _of_rules(scenario, rules)
    yield from _of_objectives(scenario)
    for agent in scenario.agents:
        yield from _of_agent(scenario, agent)
    for event in scenario.events:
        yield from _of_duration(scenario, event)
    for connection in scenario.connections:
        yield from _of_way(scenario, connection)
    for door in scenario.doors:
        yield from _of_waiting(scenario, door, "opens_within", "opening")
    for lift in scenario.lifts:
        yield from _of_waiting(scenario, lift, "comes_within", "coming")
    controlled = [agent.name for agent in scenario.agents if agent.controllable]
    lanes = [way for way in scenario.connections if scenario.is_lane(way)]  # who may take it as well would have two
    for part in scenario.for_some:
        if part not in lanes and not all(map(part.admits, controlled)):
            label, whom = f"{part.what} for all (without {part.whom_text})", part.whom_text
            freer = scenario.with_instead(part, replace(part, only_for=(), not_for=()))
            yield _switch("whom", part.what, label, whom, freer, part.span, 1)
    for travel in scenario.travels:
        yield from travel_changes(scenario, travel)
    for battery in scenario.batteries:
        yield from battery_changes(scenario, battery)
    for carrier in carriers(scenario):
        yield from load_changes(scenario, carrier)
    yield from _of_orders(scenario)
    yield from _of_knowledge(scenario)
    yield from _of_breaking_off(scenario)
    yield from assumption_changes(scenario, 2 * _all_time(scenario))
    for agent in scenario.agents:
        if not agent.controllable and (agent.can_do or agent.mobile is not None):
            changed = scenario.with_instead(agent, replace(agent, human=True, controllable=True))
            label = f"{agent.shown} following instructions (human controllable)"
            yield _switch("control", agent.name, label, "not controllable", changed, agent.span)


def _of_rules(scenario: Scenario, rules: Rules) -> Iterator[Repair]:
    if rules.ends == REPORTED:
        yield Repair(
            "ends", "", "ends chosen by the plan", REPORTED, (CONTROLLABLE,),
            lambda value: replace(rules, ends=CONTROLLABLE, slack={}),
            lambda value: "ends chosen by the plan instead of reported by the robots (--ends controllable)", helps=4,
        )
    if rules.reaction > 0:
        yield Repair(
            "reaction", "", "a shorter reaction", _decimal(rules.reaction), _reactions(rules.reaction),
            lambda value: replace(rules, reaction=Fraction(value)),
            lambda value: f"a reaction of {_decimal(Fraction(value))} instead of {_decimal(rules.reaction)} time units",
            helps=5,
        )
    for agent, late in rules.slack.items():
        yield _of_slack(rules, agent, scenario.shown(agent), late)
    if rules.reaction > 0 and rules.ends != CONTROLLABLE:
        yield Repair(
            "game", "", "ends chosen by the plan and no reaction", "", ("ideal",), lambda value: IDEAL,
            lambda value: "ends chosen by the plan and no reaction at all, as no real robot plays "
            "(--ends controllable --reaction 0)",
            helps=3,
        )


def _of_slack(rules: Rules, agent: str, shown: str, late: int) -> Repair:
    return Repair(
        "slack", agent, f"{shown} less late", late, range(late - 1, -1, -1),
        lambda k: replace(rules, slack={**rules.slack, agent: k}),
        lambda k: f"{shown} late by at most {k} instead of {late}", helps=5,
    )  # fmt: skip


def _of_objectives(scenario: Scenario) -> Iterator[Repair]:
    domains = Domains(scenario)
    for safety in scenario.safety:
        yield from _of_limit(scenario, safety)
        yield from (_easier(scenario, safety, each) for each in safety.easier(domains.counted) if each.values)
    for reach in scenario.reach:
        yield from (_easier(scenario, reach, each) for each in reach.easier(domains.counted) if each.values)
        yield from _of_limit(scenario, reach)


def _easier(scenario: Scenario, objective: StatedObjective, each: Easier) -> Repair:
    """Another number of an objective, or of all that are told with it."""
    whole = objective.told_with(scenario.objectives)
    return Repair(
        each.change, each.about, each.label, each.before, each.values,
        lambda k: scenario.with_each(lambda other: each.make(other, k) if other in whole else other),
        each.say, objective.span, each.helps,
    )  # fmt: skip


def _of_limit(scenario: Scenario, objective: StatedObjective) -> Iterator[Repair]:
    """A larger limit for all objectives of the statement that begins with this one."""
    before, statement = objective.limit, objective.statement(scenario.objectives)
    if before is None or statement.objectives[0] is not objective:
        return
    together, _, change, about, label, begins, ends = statement
    longer = whole_above(before, before + max(before, 2 * _all_time(scenario)))
    yield Repair(
        change, about, label, before, objective.possible_limits(longer),
        lambda k: scenario.with_each(lambda each: each.with_limit(k) if each in together else each),
        lambda k: f"{begins} {instead(k, before)}{ends}", objective.span, 1,
    )  # fmt: skip


def _of_agent(scenario: Scenario, agent: Agent) -> Iterator[Repair]:
    pace = agent.mobile
    if pace is None or not scenario.connections:
        return
    what = f"a {'faster' if agent.controllable else 'slower'} {agent.shown}"
    if agent.speed is not None:
        yield _of_speed(scenario, agent, agent.speed, what)
        return
    values = whole_below(pace, 1) if agent.controllable else whole_above(pace, pace * SLOWER)
    if values:
        yield Repair(
            "agent", agent.name, what, pace, values, lambda k: scenario.with_instead(agent, replace(agent, mobile=k)),
            lambda k: f"{what}, mobile {k} instead of {pace}", agent.span,
        )  # fmt: skip


def _of_speed(scenario: Scenario, agent: Agent, speed: Number, what: str) -> Repair:
    """Tenths of its speed more, up to four times as fast; less, for one that is not controlled."""
    tenths = range(11, 41) if agent.controllable else range(9, 0, -1)
    pace = Fraction(agent.mobile or 0) * Fraction(speed)
    return Repair(
        "agent", agent.name, what, speed, [exact(Fraction(speed) * k / 10) for k in tenths],
        lambda k: scenario.with_instead(agent, replace(agent, speed=k, mobile=exact(pace / k))),
        lambda k: f"{what}, speed {k} instead of {speed}", agent.span,
    )  # fmt: skip


def _of_duration(scenario: Scenario, event: Event) -> Iterator[Repair]:
    duration = event.duration or 0
    if event.latest is not None:
        yield from event_changes(scenario, event)
        return

    def lasting(word: str, values: Sequence[int], helps: int = 2) -> Repair:
        return Repair(
            "duration", event.name, f"a {word} {event.shown}", duration, values,
            lambda k: scenario.with_instead(event, replace(event, duration=like(k, duration))),
            lambda k: f"{event.shown} lasting {instead(k, duration or 'no time')}", event.span, helps,
        )  # fmt: skip

    if event.duration is None:
        if scenario.reach and _may_be_endless(scenario, event):
            yield lasting("longer", (1,), 0)
        return
    if duration > 1:
        yield lasting("shorter", whole_below(duration, 1))
    doers = scenario.doers(event.name)
    if doers and not any(agent.controllable for agent in doers):
        yield lasting("longer", whole_above(duration, max(duration * 2, 2 * _all_time(scenario))))


def _of_breaking_off(scenario: Scenario) -> Iterator[Repair]:
    """What may be broken off, or is done in parts, of what takes longer than something else may wait for its answer."""
    due = [(each.breaks.ends, each.known_limit) for each in scenario.safety if each.is_answered and each.breaks.ends]
    for event in scenario.events:
        doers = scenario.doers(event.name)
        long = [ends for ends, deadline in due if event.window is not None and event.window[1] > deadline]
        others = any(not isinstance(ends, Ref) or ends.name != event.name for ends in long)
        if not others or event.collaborative or not any(agent.controllable for agent in doers):
            continue
        if not event.may_stop:
            label = f"{event.shown} that may be broken off (may_stop)"
            freer = scenario.with_instead(event, replace(event, may_stop=True))
            yield _switch("may_stop", event.name, label, "", freer, event.span)
        yield _in_parts(scenario, event)


def _in_parts(scenario: Scenario, event: Event) -> Repair:
    """More parts of what may be broken off, each of which stays done."""
    now = event.split or 1
    return Repair(
        "parts", event.name, f"{event.shown} in more parts", now, range(now + 1, MOST_EVENT_PARTS + 1),
        lambda k: scenario.with_instead(event, replace(event, may_stop=True, split=k)),
        lambda k: f"{event.shown} in {k} parts, of which each stays done (may_stop in {k} parts)", event.span, 0,
    )  # fmt: skip


def _may_be_endless(scenario: Scenario, event: Event) -> bool:
    """True if the environment alone can do the event, on its ways as often as it likes without time passing."""
    doers = scenario.doers(event.name)
    moving = any(agent.mobile is not None for agent in doers) and bool(scenario.connections)
    return moving and event.location is None and not any(agent.controllable for agent in doers)


def _of_way(scenario: Scenario, way: Connection) -> Iterator[Repair]:
    ends = f"{scenario.shown(way.a)} and {scenario.shown(way.b)}"
    ends += f" ({way.whom_words})" if scenario.is_lane(way) else ""
    if way.distance > 1:
        yield Repair(
            "distance", ends, f"a shorter way between {ends}", way.distance, whole_below(way.distance, 1),
            lambda k: scenario.with_instead(way, replace(way, distance=like(k, way.distance))),
            lambda k: f"{ends} at distance {instead(k, way.distance)}", way.span,
        )  # fmt: skip
    if way.one_way and not any((other.a, other.b) == (way.b, way.a) for other in scenario.connections):
        label = f"a way between {ends} in both directions"
        freer = scenario.with_instead(way, replace(way, one_way=False))
        yield _switch("direction", ends, label, "one_way", freer, way.span)


def _of_waiting(scenario: Scenario, part: Union[Door, Lift], field: str, does: str) -> Iterator[Repair]:
    now = getattr(part, field)
    if now > 1:
        yield Repair(
            part.declares, part.name, f"{part.shown} {does} sooner", now, whole_below(now, 1),
            lambda k: scenario.with_instead(part, replace(cast(Any, part), **{field: like(k, now)})),
            lambda k: f"{part.shown} {does} within {instead(k, now)}", part.span,
        )  # fmt: skip


def _of_orders(scenario: Scenario) -> Iterator[Repair]:
    for rule in scenario.rules:
        fewer = replace(scenario, rules=tuple(r for r in scenario.rules if r != rule))
        yield _switch("rule", rule.name, f"without rule {rule.name}", rule.name, fewer, rule.span)
    for event, most in counted(scenario):
        yield from count_changes(scenario, event, most)
    for need in scenario.dependencies:
        freer = replace(scenario, dependencies=tuple(d for d in scenario.dependencies if d != need))
        text = f"{need.event.name} only_if {need.state.name} is_{'true' if need.value else 'false'}"
        yield _switch("dependency", need.event.name, f"without stateDependency {text}", text, freer, need.span, 1)
    for each in (event for event in scenario.events if event.needs is not None):
        text, freer = f"needs {name_text(each.needs)}", scenario.with_instead(each, replace(each, needs=None))
        yield _switch("condition", each.name, f"{each.shown} without {text}", text, freer, each.span, 1)
    spans = [span for _, span in scenario.conditions()]
    for (what, text, left_out), span in zip(without_conditions(scenario), spans):
        yield _switch("condition", what, f"{what} without only_if {text}", text, left_out(scenario), span, 1)


def _of_knowledge(scenario: Scenario) -> Iterator[Repair]:
    """What is not known at first known from the start: as if a robot saw it there; where somebody starts."""
    for agent in (each for each in scenario.agents if each.is_somewhere):
        for ref in agent.starts:
            known = scenario.with_instead(agent, replace(agent, location=ref, or_at=()))
            label = f"{agent.shown} starting at {ref.shown} (location {ref.name})"
            yield _switch("start", agent.name, label, agent.starts_text, known, agent.location.span)
    robots = [agent for agent in scenario.agents if agent.is_robot]
    for state in (each for each in scenario.states if each.is_found_out):
        for robot in robots[:1]:
            known = scenario.with_instead(state, replace(state, seen_at=robot.location))
            label = f"{state.name} known at the start, whatever it is (seen_at {robot.location.name})"
            if known != scenario:
                yield _switch("knowledge", state.name, label, "unknown", known, state.span)


def _switch(what: str, name: str, label: str, before: str, changed: Scenario, span: Span, helps: int = 0) -> Repair:
    """Something that is left out, or that is so."""
    return Repair(what, name, label, before, ("",), lambda _: changed, lambda _: label, span, helps)


def _reactions(reaction: Fraction) -> Tuple[str, ...]:
    """Nine tenths of it, eight tenths, … and none; none alone where the tenths would be too fine to ask for."""
    tenths = [reaction * k / 10 for k in range(9, -1, -1)]
    return tuple(decimal_text(tenth) for tenth in tenths if tenth.denominator <= _FINEST)


def _all_time(scenario: Scenario) -> Number:
    """More than it takes to do everything once and to go each way in both directions, waiting included."""
    slowest = max((agent.mobile or 0 for agent in scenario.agents), default=0)
    working = sum((event.latest or event.duration or 0) + 2 * (event.split or 1) for event in scenario.events)
    working += sum(travel.window[1] for travel in scenario.travels)
    return working + sum(2 * (way.distance * slowest + 2) for way in scenario.connections)


def _decimal(value: Fraction) -> str:
    return f"{float(value):g}"
