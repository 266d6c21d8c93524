"""`assume: agent does event at_most N times`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Iterator, Mapping, Sequence, Tuple

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, counted, error
from pursue_gen.language.assumptions.base import AboutOne, Assumption, Setting
from pursue_gen.language.numbers import Number
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.agent import Agent
from pursue_gen.language.template import Template
from pursue_gen.language.word import Form, Word

MOST_TIMES = 100
"""The most times that an assumption may allow: each is a value of a variable of its own."""


class Counted(Assumption):
    """An assumption that agents begin events so many times at most, where `counts_what` says which."""

    times: int
    numbers = {"at_most": lambda _, times: f"It begins {counted(times, 'time')} at most in the whole mission."}
    number = "times"
    nearest = MOST_TIMES
    counts = True
    counts_what: ClassVar[str]
    fewer: ClassVar[str] = "write a smaller number"
    """What to do where the number is too large."""

    def too_often(self) -> Iterator[Diagnostic]:
        """An error where so many times cannot be counted."""
        if self.times > MOST_TIMES:
            message = f"at_most {self.times}: expected {MOST_TIMES} or less, as each time is counted"
            yield error("PML251", message, self.span, self.fewer)

    def allows(self, event: str, within: Number) -> bool:
        return self.times > 1 or super().allows(event, within)

    @property
    def counted(self) -> Tuple[str, Mapping[str, str]]:
        done = {str(times): f"{times} of {self.times} times" for times in range(self.times + 1)}
        return (self.told(self.counts_what), done) if self.times else ("", {})

    def stronger(self, longest: Number, shortest_stay: Number) -> Sequence[int]:
        return range(self.times - 1, 0, -1)


@dataclass(frozen=True)
class AtMost(Counted, AboutOne):
    """`assume: agent does event at_most times times`: it begins the event no more often."""

    agent: Ref
    event: Ref
    times: int
    span: Span = NOWHERE
    template = Template("{agent=guest} does {event=call} at_most {times:count=2} times")
    own_words = (Word("does", "The event that the assumption is about.", True),)
    forms = (Form("how often somebody does something", template.to_fill_in),)
    counts_what = "{event} by {agent}"
    fewer = "write a smaller number, or how long it waits: waits 5 between"

    @property
    def clause(self) -> str:
        name, event = self.agent.shown, self.event.shown
        if not self.times:
            return f"{name} never does {event}"
        return f"{name} does {event} at most {'once' if self.times == 1 else f'{self.times} times'}"

    def wrong(self, agent: Agent, setting: Setting) -> Iterator[Diagnostic]:
        yield from self.too_often()
        yield from self.never_does(agent, self.event)

    @property
    def excluded(self) -> Tuple[str, ...]:
        return () if self.times else (self.agent.name, self.event.name)
