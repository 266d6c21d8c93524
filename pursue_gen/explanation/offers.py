"""What is offered where a scenario is not decided as it stands: cheaper forms of statements, and more time.

A form, with what it changes in meaning, is offered only where the scenario with it is solved and won. There are two
kinds: one robot that is named in place of any robot, and an event of people that has to be answered and happens once at
most.

All limits are made longer until a strategy is found. Where it is known how late a promise is kept by that one at worst,
that is enough, and the promise stays as it is where its own limit is, if a strategy is found with these limits, too.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from math import ceil
from typing import Dict, Iterator, Mapping, Optional, Set, Tuple

from pursue_gen.diagnostics import Span, listed
from pursue_gen.explanation.decided import decided_within
from pursue_gen.language.document import Document, statement_text, written
from pursue_gen.language.numbers import Number
from pursue_gen.language.refs import Ref
from pursue_gen.language.scenario import Scenario, StatedObjective
from pursue_gen.language.statements.agent import Agent
from pursue_gen.language.times import like, written_time
from pursue_gen.outcomes import LimitHit, Lost, NotProven
from pursue_gen.solving.answers import answers
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import Solution, solution
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.limits import EXPLAINING, Limits, Listener
from pursue_gen.tga import scenario_objective, translate

_SHOWN = 3
"""So many forms are offered at most. Not measured."""


@dataclass(frozen=True)
class Form:
    """What may stand in that line in place of what does, `text`, for all members of a group where it is for each of
    one, and what that changes; `states`: the discrete states of the scenario's game with it, which is won."""

    line: int
    text: str
    meaning: str
    states: int = 0

    def in_words(self) -> str:
        """The form in a sentence."""
        return f"Cheaper: with `{self.text}` in line {self.line} all is won, with {self.states} states; {self.meaning}."


def cheaper(scenario: Scenario, rules: Rules, budget: Budget, first: int = 0) -> Iterator[Form]:
    """The forms that are won within the budget, one for each line; those of the line `first` are tried first."""
    forms = sorted(_forms(scenario), key=lambda pair: pair[0].line != first)
    found: Set[int] = set()
    for number, (form, changed) in enumerate(forms):
        if len(found) < _SHOWN and form.line not in found:
            won, states = decided_within(changed, changed.objectives, rules, budget, 1 / (len(forms) - number))
            if won:
                found.add(form.line)
                yield replace(form, states=states)


def _forms(scenario: Scenario) -> Iterator[Tuple[Form, Scenario]]:
    """The forms, and the scenario with each of them."""
    for robot in (agent for agent in scenario.agents if agent.is_robot):
        yield from _named(scenario, robot)
    yield from _once(scenario)


def _named(scenario: Scenario, robot: Agent) -> Iterator[Tuple[Form, Scenario]]:
    """This robot in place of any robot, or of several, in one statement: who keeps that, keeps the promise, too."""
    ref = Ref(robot.name, robot.span)
    for span in dict.fromkeys(each.span.written for each in scenario.safety):
        statement = [each for each in scenario.safety if each.span.written == span]
        named = [each.kept_by(ref) for each in statement]
        if named != statement:
            safety = tuple(each.kept_by(ref) if each.span.written == span else each for each in scenario.safety)
            meaning = "other robots do not count there then, but the promise is kept as it stands, too"
            text = named[0].statement(named).text
            if statement[0].span.member:
                written = statement_text(scenario.text, span)
                if "any robot" not in written:  # some robots, or a group of them
                    continue
                text = written.replace("any robot", robot.name)
            yield Form(span.line, text, meaning), replace(scenario, safety=safety)


def _once(scenario: Scenario) -> Iterator[Tuple[Form, Scenario]]:
    """An event that only people do, and that is to be answered, happens once at most."""
    calls = (each.breaks.begins for each in scenario.safety)
    wanted = {call.name for call in calls if isinstance(call, Ref)}
    for span in dict.fromkeys(event.span.written for event in scenario.events):
        events = [event for event in scenario.events if event.span.written == span]
        doers = [agent for event in events for agent in scenario.doers(event.name)]
        asked = [event.name for event in events if event.name in wanted and event.at_most is None]
        if asked and not any(agent.controllable for agent in doers):
            changed = tuple(replace(each, at_most=1) if each in events else each for each in scenario.events)
            firsts = listed(f"the first {name}" for name in asked)
            meaning = f"only {firsts} {'are' if len(asked) > 1 else 'is'} answered then"
            yield Form(span.line, "at_most 1 times", meaning), replace(scenario, events=changed)


_FACTORS = (2, 4)
"""So many times as long all limits are; the first with which a strategy is found counts. Not measured."""

_STATES = 20_000
"""Symbolic states of the checker that the time of a promise may take. Not measured."""


@dataclass(frozen=True)
class Longer:
    """A statement with the limit that a proven strategy keeps, together with all others; `asked`: the one it has."""

    line: int
    text: str
    asked: Number

    def in_words(self) -> str:
        """The statement in a line, with what was asked for."""
        return f"  line {self.line}, {self.text} ({written_time(self.asked)} is asked for)"


def longer(scenario: Scenario, rules: Rules, limits: Limits, progress: Optional[Listener] = None) -> Tuple[Longer, ...]:
    """The statements that need another limit for all to be won together; () where none are found within the limits."""
    if not any(each.limit for each in scenario.objectives):
        return ()
    start = limits.now()
    listener = progress and (lambda reached: progress(replace(reached, phase=EXPLAINING)))

    def won(some: Scenario) -> Solution:
        options = SolveOptions(limits.since(start), progress=listener)
        return solution(translate(some), scenario_objective(some), rules, options)

    for factor in _FACTORS:
        more = scenario.with_each(partial(_times, factor))
        try:
            found = won(more)
        except LimitHit:
            return ()
        except (Lost, NotProven):
            continue
        late: Dict[int, Number] = {}
        with suppress(LimitHit):
            for each in answers(more, found, limits.since(start), _STATES):
                late.update((id(one), each.worst) for one in each.promise.told_with(more.objectives))
        enough = _enough(scenario, more, late)
        # Who writes these limits is to find what is told, and where they are tight it may be too much work.
        with suppress(LimitHit, Lost, NotProven):
            won(scenario.with_each(partial(_within, enough)))
            return tuple(_statements(scenario, enough))
        return tuple(_statements(scenario, {id(each): factor * (each.limit or 0) for each in scenario.objectives}))
    return ()


def _times(factor: int, each: StatedObjective) -> StatedObjective:
    return each.with_limit(ceil(factor * each.limit)) if each.limit else each


def _enough(scenario: Scenario, more: Scenario, late: Mapping[int, Number]) -> Dict[int, Number]:
    """The limit that is enough for each promise, by its identity: how late it is kept at worst, else that of `more`;
    the largest one of those that are written in one statement."""
    largest: Dict[Span, Number] = {}
    for asked, given in zip(scenario.objectives, more.objectives):
        if asked.limit and given.limit:
            needed = max(asked.limit, min(ceil(late.get(id(given), given.limit)), given.limit))
            largest[asked.span.written] = max(needed, largest.get(asked.span.written, 0))
    return {id(each): largest[each.span.written] for each in scenario.objectives if each.limit}


def _within(enough: Mapping[int, Number], each: StatedObjective) -> StatedObjective:
    return each if enough.get(id(each)) == each.limit else each.with_limit(ceil(enough[id(each)]))


def _statements(scenario: Scenario, enough: Mapping[int, Number]) -> Iterator[Longer]:
    """The statements of promises that need more than they have; all promises of one have the same limit."""
    for span in dict.fromkeys(each.span.written for each in scenario.objectives):
        statement = [each for each in scenario.objectives if each.span.written == span and each.limit]
        needed = ceil(max((enough[id(each)] for each in statement), default=0))
        if statement and needed > statement[0].known_limit:
            changed = [each.with_limit(needed) for each in statement]
            text = changed[0].statement(changed).text
            if statement[0].span.member:
                text = _written_with(statement[0], needed, scenario.text)
            yield Longer(span.line, text, statement[0].known_limit)


def _written_with(objective: StatedObjective, limit: int, text: str) -> str:
    """The statement of an objective as it stands in the text, for each of a group, with another limit."""
    document = Document(statement_text(text, objective.span.written))
    pair = document.statements[0].pair(objective.limit_word.upper())
    number = written_time(like(limit, objective.limit))
    return document.changed(written(pair[1], number)).text if pair else document.text
