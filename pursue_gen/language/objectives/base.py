"""What every kind of objective has: a kind is a class in a module of its own, which says what is different with it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Callable, ClassVar, Iterator, Mapping, NamedTuple, Optional, Sequence, Tuple, TypeVar, cast

from pursue_gen.diagnostics import Span, listed
from pursue_gen.language.conditions import At, AtMostOf, Condition, EventOrCondition, condition_words
from pursue_gen.language.numbers import Number
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.base import Written
from pursue_gen.language.symbols import Role, role_of
from pursue_gen.language.times import like

Stated = TypeVar("Stated", bound="StatedObjective")

Counted = Callable[[AtMostOf], Mapping[str, object]]
"""The agents that may be where a condition counts them."""


STATUSES = {
    Role.IDLE: "kept", Role.AT_RISK: "a deadline is running", Role.LOSE: "broken",
    Role.START: "not counting yet", Role.UNLOCKED: "to be reached", Role.WIN: "reached", Role.LATE: "too late",
}  # fmt: skip
"""What an objective is at in the locations of its automaton, by their roles."""


class Words(NamedTuple):
    """What an objective is called while a mission goes on; "": nothing is said of that."""

    due: str = ""  # what has to come within its limit
    due_by: str = ""  # the same, with who it is to come from
    lane: str = ""  # the line in a picture of when it was due
    since: str = "the start"  # the moment since which the clock of its automaton counts
    statuses: Mapping[Role, str] = STATUSES  # the same as there, where it says more
    must: str = ""  # what has to be by the end of its limit
    in_time: str = ""  # said where that comes
    there: str = ""  # what is so as long as nothing is due
    kept: str = ""  # what happens within its limit, as in `answered within 5`
    behind: str = ""  # what may be left out behind its text
    which: str = ""  # which of the objectives of its statement it is


class Whole(NamedTuple):
    """A statement as a whole: the objectives that it lists, its text, and what a larger limit is: the kind of change,
    what it is about, its label, and what stands around `5 instead of 4`."""

    objectives: Sequence[StatedObjective]
    text: str
    change: str = ""
    about: str = ""
    label: str = ""
    before: str = ""
    behind: str = ""


class Easier(NamedTuple):
    """Other numbers with which an objective is easier to keep, the smallest change first: the kind of change, what it
    is about, its label, the number that it has and those that it may have. `make`: it, or one that is told with it,
    with such a number; None: it goes."""

    change: str
    about: str
    label: str
    before: Number
    values: Sequence[int]
    make: Callable[[Any, int], Optional[StatedObjective]]
    say: Callable[[int], str]
    helps: int = 2


class StatedObjective(Written):
    """An objective: a frozen dataclass. `optional`: 0 for one that has to be met; else the number behind `optional`, 1
    for what is to be kept longest. `text` is without the word that begins the statement; of a patrol in order it has
    all places.
    """

    span: Span
    optional: int
    listed_in: ClassVar[str] = "safety"
    """The field of a scenario that has it."""
    word: ClassVar[str] = "objective"
    """The word that begins its statement; "": its text begins it."""
    limited_by: ClassVar[str] = ""
    """Its field with its limit; "": it has none."""
    last: ClassVar[bool] = False
    """It stands behind those that stand in other statements, wherever its own one stands."""
    once: ClassVar[bool] = False
    """It is reached once, and its limit counts from the start; else each time that something becomes due."""
    wants: ClassVar[str] = ""
    """What it wants, as `Written.told` has it, where that is one form."""
    is_answered: ClassVar[bool] = False
    """Somebody or something asks for it, and it has to be answered in time."""

    @property
    def full_text(self) -> str:
        """The whole statement, as in `objective: avoid e`."""
        optional = f"optional {self.optional} " if self.optional else ""
        return f"{optional}{self.word}: {self.text}"

    def sentence(self, shown: Callable[[str], str]) -> str:
        """What it wants. `shown`: what people read for a name."""
        return self.told(self.wants)

    def broken(self, beside: Callable[[str], str]) -> str:
        """What has happened where it is broken. `beside`: a clause about where an agent is, by its name."""
        raise NotImplementedError

    @property
    def called_by(self) -> str:
        """The event with which something becomes due, each time that it happens; "": there is none."""
        return ""

    def told_with(self, objectives: Sequence[StatedObjective]) -> Sequence[StatedObjective]:
        """Those of these objectives that answer an event in turns with it, so that one time is told of them all."""
        return self.statement(objectives).objectives if self.called_by else (self,)

    def variables(self, shown: Callable[[str], str]) -> Iterator[Tuple[Role, Mapping[str, str]]]:
        """The roles of its automaton's variables, and what each value says. `shown`: what people read for a name."""
        return iter(())

    def easier(self, counted: Counted) -> Iterator[Easier]:
        """Its numbers but its limit, where others would be easier to keep."""
        return iter(())

    @property
    def order(self) -> Tuple[str, ...]:
        """The places of its statement, where each counts in its turn only; () where there are no turns."""
        return ()

    def statement(self, objectives: Sequence[StatedObjective]) -> Whole:
        """The statement that lists it, found among these objectives."""
        return Whole((self,), self.text)

    @property
    def limit(self) -> Optional[Number]:
        """The time units within which what is due has to come; None: there is no limit."""
        return getattr(self, self.limited_by) if self.limited_by else None

    @property
    def known_limit(self) -> Number:
        """The limit of an objective that has one; the period of a patrol is known from solving on."""
        assert self.limit is not None, "there is no limit, or it has to be found first"
        return self.limit

    def limit_in(self, location: str) -> Optional[Number]:
        """The time units within which what is due has to come, of one that waits for it in this location of its
        automaton, since its clock was set; None: nothing is due there."""
        return self.limit if location == Role.AT_RISK() else None

    def possible_limits(self, limits: Sequence[int]) -> Sequence[int]:
        """Those of these limits that can be written."""
        return limits

    @property
    def limit_word(self) -> str:
        """The word before its limit."""
        return next(hole.behind for hole in self.template.holes if self.limited_by in hole.fields)

    def with_limit(self: Stated, limit: int) -> Stated:
        """The same with another limit."""
        return cast(Stated, replace(cast(Any, self), **{self.limited_by: like(limit, self.limit)}))

    @property
    def words(self) -> Words:
        """What it is called while a mission goes on."""
        return Words()

    def done_in(self, location: str) -> Tuple[Ref, ...]:
        """Those of several events that have happened in a location of its automaton: some and not all."""
        return ()

    def status(self, location: str) -> str:
        """What it is at in a location of its automaton."""
        role, done = role_of(location), self.done_in(location)
        said = f"{listed(ref.shown for ref in done)} done" if done else self.words.statuses.get(role)
        return said or STATUSES.get(role, location)


class Breaks(NamedTuple):
    """How a safety objective is broken: by an event; by a condition; by a pair of agents at one place; by an event that
    comes too soon; or since what is due has not come within its limit."""

    event: Optional[Ref] = None
    condition: Optional[Condition] = None
    pair: Tuple[str, ...] = ()  # the names of two agents who must not be together …
    place: Optional[str] = None  # … at this place; None: nowhere, nor on a connection
    begins: Optional[EventOrCondition] = None  # with what something becomes due …
    ends: Optional[EventOrCondition] = None  # … and with what it has come; None: that depends on turns
    too_soon: Optional[Ref] = None  # an event that may not begin less than a pause …
    last: Optional[Ref] = None  # … after the end of this one …
    pause: Number = 0  # … in time units
    by_robots: bool = False  # nothing but what robots do can keep it
    stands: Tuple[At, ...] = ()  # who is at which place when it is kept, or broken: this has to be possible


class Safety(StatedObjective):
    """An objective that holds until all that is to be reached is reached; for ever where nothing is."""

    @property
    def breaks(self) -> Breaks:
        """How it is broken."""
        raise NotImplementedError

    @property
    def called_by(self) -> str:
        return self.breaks.begins.name if isinstance(self.breaks.begins, Ref) else ""

    def apart(self, one: str, other: str, place: str) -> bool:
        """True where these two agents are never both at this place as long as it is kept."""
        return False

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        broken = self.breaks.condition
        if broken is not None and kind in ("state", "agent") and self.speaks_of(kind, name):
            yield f"must never be: {shown(condition_words(broken))}"

    def in_building(self, places: Sequence[Ref], ways: Sequence[Tuple[Ref, Ref, str]]) -> Safety:
        """The same in a building with these places and ways: from, to, and the lift that they go by; "": none."""
        return self

    def kept_by(self, robot: Ref) -> Safety:
        """The objective kept by this robot; the same where any robot is not what keeps it."""
        return self
