"""Cheaper forms of statements of a scenario that is too large, each with what it changes in meaning.

A form is offered only where the scenario with it is solved and won. There are two kinds: one robot that is named in
place of any robot, and an event of people that has to be answered and happens once at most.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Iterator, Set, Tuple

from pursue_gen.diagnostics import listed
from pursue_gen.explanation.decided import decided_within
from pursue_gen.language.document import statement_text
from pursue_gen.language.refs import Ref
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.statements.agent import Agent
from pursue_gen.solving.rules import Rules
from pursue_gen.synthesis.budget import Budget

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
