"""`patrol place every T by who`: places at which somebody is again and again."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Callable, Iterator, Mapping, Optional, Sequence, Tuple

from lark import Token

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error, listed, units
from pursue_gen.language.conditions import Not, Who, by_robot, one_at, stands_at, who_text
from pursue_gen.language.numbers import Number
from pursue_gen.language.objectives.base import Breaks, Safety, StatedObjective, Whole, Words
from pursue_gen.language.refs import Ref, twice
from pursue_gen.language.symbols import Role
from pursue_gen.language.template import Filling, Template
from pursue_gen.language.times import like, written_time
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word


def _read_who(reader: TreeReader, tree: Any) -> Who:
    if isinstance(tree.children[0], Token):
        return Who(None, robots=True)
    first, *others = map(reader.ref, tree.children)
    return Who(first, others=tuple(others))


def check_who(who: Who) -> Iterator[Diagnostic]:
    """An agent that is named twice."""
    for ref in twice(who.named):
        yield error("PML267", f"{ref.name} stands twice behind by", ref.span, "delete one of the two")


PATROLLER = Filling(
    "patroller", _read_who, who_text, "agent", ("by", "or"), 'patroller: ref ("or" ref)* | ANY ROBOT'
)
"""Who has to be there."""


@dataclass(frozen=True)
class Patrol(Safety):
    """`patrol place every T by who`: it is at the place again so many time units after it left, or after the start.

    `who`: an agent, several, or any robot: then one of them. A statement with several places is several of these.
    `every`: in time units; None: the least that can be promised is to be found by solving (`solving.periods`). Then
    `least` says that nothing below it can be promised.
    `order`: the places of the statement, where each counts in its turn only (`in order`); () where all count always.
    """

    place: Ref
    every: Optional[Number]
    who: Who
    span: Span = NOWHERE
    order: Tuple[str, ...] = ()
    least: Optional[int] = None
    optional: int = 0
    limited_by = "every"
    aside = ("least",)

    template = Template(
        "patrol {place:POIs=a, b} [in order] [every {every:time=60}] by {who:patroller=bot1}",
        patroller=PATROLLER,
    )
    note = "or: by bot1 or bot2, by any robot; in order and every are optional"
    own_words = (
        Word("patrol", "Places at which somebody has to be again and again.", True),
        Word("in", "In this order: a visit counts in its turn only."),
        Word(
            "order",
            "A visit counts in its turn only: first at the first place, then at the second, round after round.",
            True,
        ),
        Word(
            "every",
            "So many units of time after somebody left, or after the start, somebody is there again. Without it, the "
            "least that can be promised is found.",
            True,
        ),
        Word("by", "Who has to be there: an agent, one of several, or any robot.", True),
    )
    numbers = {"every": "Somebody is there again {} after the last one left, or after the start.".format}
    forms = (
        Form("somebody who comes again and again", "patrol {POI} every {=60} by {agent}"),
        Form("one of two who come again and again", "patrol {POI} every {=60} by {agent} or {agent}"),
        Form("somebody who comes as often as can be promised", "patrol {POI} by {agent}"),
        Form("somebody who makes rounds", "patrol {POI}, {POI} in order every {=60} by {agent}"),
    )

    @classmethod
    def read(cls, reader: TreeReader, *children: Any, **at: Any) -> Tuple[Safety, ...]:
        values = {"every": None, **cls.template.read(reader, children), **at}
        places, in_order = values.pop("place"), values.pop("order", False)
        order = tuple(place.name for place in places) if in_order else ()
        return tuple(cls(place, order=order, **values) for place in places)

    @property
    def text(self) -> str:
        return self.statement((self,)).text

    def statement(self, objectives: Sequence[StatedObjective]) -> Whole:
        listing = tuple(each for each in patrols_in(objectives) if each.span == self.span)
        places = ", ".join(self.order or (each.place.name for each in listing))
        text = self.template.written(self, place=places)
        about, shown = (
            listed(names) + " in order" * bool(self.order)
            for names in zip(*((each.place.name, each.place.shown) for each in listing))
        )
        return Whole(listing, text, "deadline", about, "a rarer patrol", f"a patrol of {shown} every")

    def variables(self, shown: Callable[[str], str]) -> Iterator[Tuple[Role, Mapping[str, str]]]:
        yield Role.SAFETY_TURN, {str(k): f"next: {shown(place)}" for k, place in enumerate(self.order)}

    def sentence(self, shown: Callable[[str], str]) -> str:
        who = who_text(self.who, shown=True)
        if self.order:
            places = listed(map(shown, self.order))
            return f"{who} visits {places} in this order, each {self._every()}."
        return f"{who} is at {self.place.shown} {self._every()}."

    def _every(self) -> str:
        """How often a place is visited."""
        if self.every is None:
            return "as often as can be promised"
        every = f"at least every {units(self.every)}"
        if self.least is None:
            return every
        if self.least >= self.every:
            return f"{every}, the least that can be promised"
        return f"{every}; nothing below {written_time(like(self.least, self.every))} can be promised"

    def period_found(self, won: bool) -> Iterator[str]:
        """A sentence where its period was found by solving, as far as the verdict says something about it."""
        who, every, least = f"the patrol by {who_text(self.who, shown=True)}", self.every, self.least
        if every is None or least is None:
            return
        if won and least == every:
            yield f"The least period that can be promised for {who} is {units(every)}."
        elif won:
            below = written_time(like(least, every))
            yield f"The least period for {who} is at most {units(every)}; nothing below {below} can be promised."
        elif least > every:
            yield f"No period up to {units(every)} can be promised for {who}."

    def broken(self, beside: Callable[[str], str]) -> str:
        return f"not {self.words.due_by} for {written_time(self.every)}"

    def check(self) -> Iterator[Diagnostic]:
        yield from check_who(self.who)
        again = next((name for k, name in enumerate(self.order) if name in self.order[:k]), "")
        if again:
            message = f"{again} stands twice in this patrol in order: expected each place once in a round"
            yield error("PML261", message, self.span, "delete one of the two")
        elif len(self.order) == 1:
            message = "in order says nothing about one place: expected two or more"
            yield error("PML260", message, self.span, "name the other places, or delete in order")
        if self.every is not None and self.every < 2:
            message = f"every {written_time(self.every)} leaves no time to go away and come back: expected 2 or more"
            yield error("PML143", message, self.span, "write the time units between two visits")

    @property
    def words(self) -> Words:
        place, turn = self.place.shown, ", in its turn" if self.order else ""
        who = who_text(self.who, shown=True)
        there = "a robot is there" if self.who.agent is None else f"{who} is there"
        return Words(
            due=f"a visit of {place}{turn}",
            due_by=f"{who} at {place}{turn and turn + ','}",
            lane=f"visits: {place}",
            since=f"the last visit of {place}{turn.replace(',', '')}, or the start",
            statuses={Role.IDLE: there, Role.AT_RISK: "a visit is due"},
            must=f"{who} has to be back",
            there="there",
            kept="visited again",
            which=turn and f": {place}",
        )

    @property
    def breaks(self) -> Breaks:
        there, stands = one_at(self.who, self.place), stands_at(self.who, self.place)
        return Breaks(begins=Not(there), ends=None if self.order else there, by_robots=True, stands=stands)

    def kept_by(self, robot: Ref) -> Patrol:
        return replace(self, who=by_robot(self.who, robot))


def patrols_in(objectives: Sequence[StatedObjective]) -> Tuple[Patrol, ...]:
    """The patrols among objectives."""
    return tuple(each for each in objectives if isinstance(each, Patrol))
