"""`at_least T between e1 and e2`: a pause from the end of one event to the beginning of the next."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Callable, Iterator, Mapping, Optional, Sequence, Tuple

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error, units
from pursue_gen.language.numbers import Number, whole_below
from pursue_gen.language.objectives.base import Breaks, Counted, Easier, Safety, StatedObjective, Words
from pursue_gen.language.refs import Ref
from pursue_gen.language.symbols import Role
from pursue_gen.language.template import Template
from pursue_gen.language.times import instead, units_of_time, written_time
from pursue_gen.language.word import Form, Word


@dataclass(frozen=True)
class Pause(Safety):
    """`at_least time between event and then`: so many time units pass from each end of `event` to the next beginning of
    `then` (None: of the same event), or more, whoever does them."""

    time: Number
    event: Ref
    span: Span = NOWHERE
    then: Optional[Ref] = None
    optional: int = 0

    template = Template("at_least {time:time=600} between {event=look1} [and {then:event=look1}]")
    note = "and is optional: it is the same event then"
    own_words = (
        Word("at_least", "So many units of time, or more: what comes sooner breaks it, or does not count.", True),
    )
    numbers = {"at_least": "The next one begins {} after the end of the last, or later.".format}
    forms = (
        Form("a pause before something happens again", "at_least {=600} between {event}"),
        Form("a pause between two events", "at_least {=600} between {event} and {event}"),
    )

    @property
    def following(self) -> Ref:
        """The event that may not begin too soon."""
        return self.event if self.then is None else self.then

    def sentence(self, shown: Callable[[str], str]) -> str:
        begins = "begins again" if self.following.name == self.event.name else "begins"
        later = f"{units(self.time)} later at the earliest"
        return f"After each end of {self.event.shown}, {self.following.shown} {begins} {later}."

    def broken(self, beside: Callable[[str], str]) -> str:
        pause = written_time(self.time)
        return f"{self.following.shown} has begun less than {pause} after the end of {self.event.shown}"

    def check(self) -> Iterator[Diagnostic]:
        if self.time <= 0:
            message = "at_least 0 asks for no pause: expected more than 0"
            yield error("PML143", message, self.span, "write the time units, or delete the objective")

    @property
    def words(self) -> Words:
        return Words(since=f"the end of the last {self.event.shown}")

    @property
    def breaks(self) -> Breaks:
        return Breaks(too_soon=self.following, last=self.event, pause=self.time)

    def variables(self, shown: Callable[[str], str]) -> Iterator[Tuple[Role, Mapping[str, str]]]:
        begun = f"{self.following.shown} has begun too soon"
        yield Role.SAFETY_PAUSE, {"0": "no pause", "1": f"since the end of {self.event.shown}", "2": begun}

    def easier(self, counted: Counted) -> Iterator[Easier]:
        names = " and ".join(dict.fromkeys((self.event.shown, self.following.shown)))
        yield Easier(
            "pause", names, f"a shorter pause between {names}", self.time, whole_below(self.time, 1),
            lambda each, k: replace(each, time=k), lambda k: f"a pause of {instead(k, self.time)} between {names}",
        )  # fmt: skip

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        if kind == "event" and name == self.following.name:
            yield f"begins {units_of_time(self.time)} after each end of {self.event.name}, or later"


def pauses_in(objectives: Sequence[StatedObjective]) -> Iterator[Tuple[int, Pause]]:
    """The pauses, each behind its number among these objectives."""
    return ((k, each) for k, each in enumerate(objectives) if isinstance(each, Pause))
