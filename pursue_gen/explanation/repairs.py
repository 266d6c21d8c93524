"""What can be changed in a lost game, each by steps from the smallest change to the largest."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Callable, Iterable, Iterator, Optional, Sequence, Tuple

from pursue_gen.diagnostics import Span, listed
from pursue_gen.explanation.ablations import without_conditions
from pursue_gen.explanation.assumption_changes import assumption_changes
from pursue_gen.explanation.number_changes import (
    SLOWER,
    NumberChange,
    battery_changes,
    count_changes,
    event_changes,
    travel_changes,
)
from pursue_gen.language.numbers import Number, decimal_text, whole_above, whole_below
from pursue_gen.language.scenario import Agent, Connection, Event, Reach, Scenario, StatedObjective
from pursue_gen.solving.rules import CONTROLLABLE, IDEAL, REPORTED, Rules
from pursue_gen.tga.counts import counted

_FINEST = 1000
"""The largest denominator of a reaction that the command line takes."""

Variant = Tuple[Scenario, Rules]


@dataclass(frozen=True)
class Knob:
    """Something that can be changed, by the steps `values`: texts from the smallest change to the largest."""

    what: str
    name: str
    label: str
    before: str
    values: Sequence[str]
    make: Callable[[str], Variant]
    say: Callable[[str], str]
    span: Optional[Span] = None
    helps: int = 0
    """How well a strategy that wins the changed game serves in the game as it is; 0: not at all."""


def knobs(scenario: Scenario, rules: Rules) -> Iterator[Knob]:
    """All that can be changed, in the order in which they are worth knowing (and the quick ones first)."""
    yield from _rules_knobs(scenario, rules)
    yield from _objective_knobs(scenario, rules)
    for agent in scenario.agents:
        yield from _agent_knobs(scenario, rules, agent)
    for event in scenario.events:
        yield from _duration_knobs(scenario, rules, event)
    for connection in scenario.connections:
        yield from _distance_knobs(scenario, rules, connection)
    for travel in scenario.travels:
        yield from _number_knobs(rules, travel_changes(scenario, travel))
    for battery in scenario.batteries:
        yield from _number_knobs(rules, battery_changes(scenario, battery))
    yield from _order_knobs(scenario, rules)
    yield from _number_knobs(rules, assumption_changes(scenario, 2 * _all_time(scenario)))
    for agent in scenario.agents:
        yield from _control_knobs(scenario, rules, agent)


def _rules_knobs(scenario: Scenario, rules: Rules) -> Iterator[Knob]:
    ideal = rules.ends == CONTROLLABLE
    if rules.ends == REPORTED:
        yield Knob(
            "ends", "", "ends chosen by the plan", REPORTED, (CONTROLLABLE,),
            lambda value: (scenario, replace(rules, ends=CONTROLLABLE, slack={})),
            lambda value: "ends chosen by the plan instead of reported by the robots (--ends controllable)",
            helps=4,
        )
    if rules.reaction > 0:
        yield Knob(
            "reaction", "", "a shorter reaction", _decimal(rules.reaction), _reactions(rules.reaction),
            lambda value: (scenario, replace(rules, reaction=Fraction(value))),
            lambda value: f"a reaction of {_decimal(Fraction(value))} instead of {_decimal(rules.reaction)} time units",
            helps=5,
        )
    for agent, late in rules.slack.items():
        yield _slack_knob(scenario, rules, agent, late)
    if rules.reaction > 0 and not ideal:
        yield Knob(
            "game", "", "ends chosen by the plan and no reaction", "", ("ideal",), lambda value: (scenario, IDEAL),
            lambda value: "ends chosen by the plan and no reaction at all, as no real robot plays "
            "(--ends controllable --reaction 0)",
            helps=3,
        )


def _slack_knob(scenario: Scenario, rules: Rules, agent: str, late: int) -> Knob:
    shown = scenario.shown(agent)
    return _number(
        "slack", agent, f"{shown} less late", late, range(late - 1, -1, -1),
        lambda k: (scenario, replace(rules, slack={**rules.slack, agent: k})),
        lambda k: f"{shown} late by at most {k} instead of {late}", None, 5,
    )  # fmt: skip


def _objective_knobs(scenario: Scenario, rules: Rules) -> Iterator[Knob]:
    for safety in scenario.safety:
        yield from _limit_knobs(scenario, rules, safety)
    for reach in scenario.reach:
        if reach.after > 0:
            yield _after_knob(scenario, rules, reach)
        yield from _limit_knobs(scenario, rules, reach)


def _limit_knobs(scenario: Scenario, rules: Rules, objective: StatedObjective) -> Iterator[Knob]:
    """A larger limit for all objectives of the statement that begins with this one."""
    before, statement = objective.limit, objective.statement(scenario.objectives)
    if before is None or statement.objectives[0] is not objective:
        return
    together, _, change, about, label, begins, ends = statement
    yield _number(
        change, about, label, before, whole_above(before, before + max(before, 2 * _all_time(scenario))),
        lambda k: (scenario.with_each(lambda each: each.with_limit(k) if each in together else each), rules),
        lambda k: f"{begins} {k} instead of {before}{ends}", objective.span, 1,
    )  # fmt: skip


def _after_knob(scenario: Scenario, rules: Rules, reach: Reach) -> Knob:
    due, names, before = reach.words.due, listed(ref.name for ref in reach.events), reach.after
    return _number(
        "after", names, f"an earlier {due}", before, whole_below(before, 0),
        lambda k: (scenario.with_each(lambda each: replace(reach, after=k) if each is reach else each), rules),
        lambda k: f"{due} after {k} instead of {before}", reach.span, 1,
    )  # fmt: skip


def _agent_knobs(scenario: Scenario, rules: Rules, agent: Agent) -> Iterator[Knob]:
    pace = agent.mobile
    if pace is None or not scenario.connections:
        return

    word = "faster" if agent.controllable else "slower"
    values = whole_below(pace, 1) if agent.controllable else whole_above(pace, pace * SLOWER)
    what = f"a {word} {agent.shown}"
    if values:
        yield _number(
            "agent", agent.name, what, pace, values,
            lambda k: (scenario.with_instead(agent, replace(agent, mobile=k)), rules),
            lambda k: f"{what}, mobile {k} instead of {pace}", agent.span, 2,
        )  # fmt: skip


def _duration_knobs(scenario: Scenario, rules: Rules, event: Event) -> Iterator[Knob]:
    duration = event.duration or 0
    if event.latest is not None:
        yield from _number_knobs(rules, event_changes(scenario, event))
        return

    def make(k: int) -> Variant:
        return scenario.with_instead(event, replace(event, duration=k)), rules

    def say(k: int) -> str:
        return f"{event.shown} lasting {k} instead of {duration or 'no time'}"

    if event.duration is None:
        if scenario.reach and _may_be_endless(scenario, event):
            yield _number("duration", event.name, f"a longer {event.shown}", 0, (1,), make, say, event.span, 0)
        return
    if duration > 1:
        values = whole_below(duration, 1)
        yield _number("duration", event.name, f"a shorter {event.shown}", duration, values, make, say, event.span, 2)
    doers = [agent for agent in scenario.agents if any(ref.name == event.name for ref in agent.can_do)]
    if doers and not any(agent.controllable for agent in doers):
        longer = whole_above(duration, max(duration * 2, 2 * _all_time(scenario)))
        yield _number("duration", event.name, f"a longer {event.shown}", duration, longer, make, say, event.span, 2)


def _number_knobs(rules: Rules, changes: Iterable[NumberChange]) -> Iterator[Knob]:
    for one in changes:

        def make(k: int, one: NumberChange = one) -> Variant:
            return one.make(k), rules

        yield _number(one.what, one.name, one.label, one.before, one.values, make, one.say, one.span, 2)


def _may_be_endless(scenario: Scenario, event: Event) -> bool:
    """True if the environment alone can do the event, on its ways as often as it likes without time passing."""
    doers = [agent for agent in scenario.agents if any(ref.name == event.name for ref in agent.can_do)]
    moving = any(agent.mobile is not None for agent in doers) and bool(scenario.connections)
    return moving and event.location is None and not any(agent.controllable for agent in doers)


def _distance_knobs(scenario: Scenario, rules: Rules, connection: Connection) -> Iterator[Knob]:
    ends, ways = f"{scenario.shown(connection.a)} and {scenario.shown(connection.b)}", scenario.connections
    if connection.distance > 1:
        yield _number(
            "distance", ends, f"a shorter way between {ends}", connection.distance, whole_below(connection.distance, 1),
            lambda k: (scenario.with_instead(connection, replace(connection, distance=k)), rules),
            lambda k: f"{ends} at distance {k} instead of {connection.distance}", connection.span, 2,
        )  # fmt: skip
    if connection.one_way and not any((w.a, w.b) == (connection.b, connection.a) for w in ways):
        freer = scenario.with_instead(connection, replace(connection, one_way=False))
        label = f"a way between {ends} in both directions"
        yield _switch("direction", ends, label, "one_way", (freer, rules), connection.span)


def _order_knobs(scenario: Scenario, rules: Rules) -> Iterator[Knob]:
    for rule in scenario.rules:
        fewer = replace(scenario, rules=tuple(r for r in scenario.rules if r != rule))
        yield _switch("rule", rule.name, f"without rule {rule.name}", rule.name, (fewer, rules), rule.span)
    for event, most in counted(scenario):
        yield from _number_knobs(rules, count_changes(scenario, event, most))
    for need in scenario.dependencies:
        freer = replace(scenario, dependencies=tuple(d for d in scenario.dependencies if d != need))
        text = f"{need.event.name} only_if {need.state.name} is_{'true' if need.value else 'false'}"
        label = f"without stateDependency {text}"
        yield _switch("dependency", need.event.name, label, text, (freer, rules), need.span, 1)
    spans = [span for _, span in scenario.conditions()]
    for (what, text, left_out), span in zip(without_conditions(scenario), spans):
        label = f"{what} without only_if {text}"
        yield _switch("condition", what, label, text, (left_out(scenario), rules), span, 1)


def _control_knobs(scenario: Scenario, rules: Rules, agent: Agent) -> Iterator[Knob]:
    if not agent.controllable and (agent.can_do or agent.mobile is not None):
        changed = scenario.with_instead(agent, replace(agent, human=True, controllable=True))
        label = f"{agent.shown} following instructions (human controllable)"
        yield _switch("control", agent.name, label, "not controllable", (changed, rules), agent.span)


def _switch(
    what: str, name: str, label: str, before: str, variant: Variant, span: Optional[Span], helps: int = 0
) -> Knob:
    return Knob(what, name, label, before, ("",), lambda _: variant, lambda _: label, span, helps)


def _number(
    what: str,
    name: str,
    label: str,
    before: Number,
    values: Sequence[int],
    make: Callable[[int], Variant],
    say: Callable[[int], str],
    span: Optional[Span],
    helps: int,
) -> Knob:
    texts = tuple(str(k) for k in values)
    return Knob(
        what, name, label, str(before), texts, lambda text: make(int(text)), lambda text: say(int(text)), span, helps
    )


def _reactions(reaction: Fraction) -> Tuple[str, ...]:
    """Nine tenths of it, eight tenths, … and none; none alone where the tenths would be too fine to ask for."""
    tenths = [reaction * k / 10 for k in range(9, -1, -1)]
    return tuple(decimal_text(tenth) for tenth in tenths if tenth.denominator <= _FINEST)


def _all_time(scenario: Scenario) -> Number:
    """More than it takes to do everything once and to go each way in both directions, waiting included."""
    slowest = max((agent.mobile or 0 for agent in scenario.agents), default=0)
    working = sum((event.latest or event.duration or 0) + 2 for event in scenario.events)
    working += sum(travel.window[1] for travel in scenario.travels)
    return working + sum(2 * (way.distance * slowest + 2) for way in scenario.connections)


def _decimal(value: Fraction) -> str:
    return f"{float(value):g}"
