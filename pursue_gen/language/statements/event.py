"""`event "name" …`: something that agents do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Mapping, Optional, Tuple

from pursue_gen.diagnostics import NOWHERE, Span
from pursue_gen.language.conditions import Condition
from pursue_gen.language.numbers import Number, Window, window_of
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.base import StatementKind, behind, joined, label_text, only_if_text, window_text
from pursue_gen.language.tokens import bare
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word


@dataclass(frozen=True)
class Event(StatementKind):
    """Something that agents do. `duration` is in time units, None: instantaneous; `location` None: anywhere.

    It ends later than `duration`, and at `latest` at the latest; None: within one time unit more. `at_most`: so often
    it can happen in all; None: as often as one likes.
    `together`: whoever takes part in a collaborative event is busy until it ends; else only the one who does it.
    `only_if`: what has to hold when it begins; None: nothing. `label`: what people read; None: the name.
    """

    name: str
    collaborative: bool = False
    location: Optional[Ref] = None
    duration: Optional[Number] = None
    span: Span = NOWHERE
    together: bool = False
    latest: Optional[Number] = None
    at_most: Optional[int] = None
    only_if: Optional[Condition] = None
    label: Optional[str] = None

    listed_in: ClassVar[str] = "events"
    words: ClassVar[Tuple[Word, ...]] = (
        Word("event", "Something that can happen: what an agent does, alone or with a partner."),
        Word("collaborative", "It takes two at one place: one who can do it, and one who reacts to it."),
        Word("together", "Whoever takes part is busy until it ends. Without it, only the one who does it is.", True),
        Word("location", "Where it happens (events), or where it starts (agents)."),
        Word(
            "duration",
            "How long it takes, in the unit of time that you chose: 3 is up to 4. Without it, it takes no time.",
        ),
        Word("to", "Where the agent arrives; or, behind a number, the latest time.", True),
        Word("at_most", "How many times it happens in the whole mission, and no more.", True),
        Word("times", "In the whole mission.", True),
    )
    grammar: ClassVar[str] = (
        'event: "event" NAME [LABEL NAME] [COLLABORATIVE] [TOGETHER] ["location" ref] ["duration" window]'
        ' [AT_MOST NUMBER TIMES] ["only_if" condition]'
    )
    form: ClassVar[str] = (
        'event "work" collaborative together location a duration 6 at_most 2 times only_if open is_true '
        '(all but the name is optional; or: duration 6 to 9; behind the name: label "do the work")'
    )
    forms: ClassVar[Tuple[Form, ...]] = (
        Form("something that can happen at a place", 'event "{=work}" location {POI} duration {=1}'),
        Form("something that takes more or less time", 'event "{=work}" location {POI} duration {=3} to {=5}'),
        Form("something that happens so many times only", 'event "{=call}" at_most {=2} times'),
        Form(
            "something that can happen only while something holds",
            'event "{=work}" location {POI} only_if {agent} at {POI}',
        ),
        Form("something that two do at once", 'event "{=handOver}" collaborative'),
        Form(
            "something that two do together for a while",
            'event "{=ride}" collaborative together location {POI} duration {=4}',
        ),
    )
    declares: ClassVar[str] = "event"
    shortest: ClassVar[str] = 'event "{name}"'
    refers_to: ClassVar[Mapping[str, str]] = {"location": "POI"}
    used: ClassVar[Mapping[str, str]] = {"location": "POI"}
    conditions_behind: ClassVar[Tuple[str, ...]] = ("only_if",)
    parts: ClassVar[Tuple[str, ...]] = (
        "EVENT", "LABEL", "COLLABORATIVE", "TOGETHER", "LOCATION", "DURATION", "AT_MOST", "ONLY_IF",
    )  # fmt: skip

    @classmethod
    def read(cls, reader: TreeReader, *children: Any, **at: Any) -> Event:
        name, _, label, collaborative, together, location, duration, _at_most, most, _times, only_if = children
        earliest, latest = (None, None) if duration is None else reader.window(duration)
        return cls(
            bare(name),
            collaborative is not None,
            reader.ref_or_none(location),
            earliest,
            reader.at(name),
            together is not None,
            latest,
            None if most is None else reader.count(most),
            reader.condition_or_none(only_if),
            reader.label(label),
        )

    @property
    def shown(self) -> str:
        """What people read."""
        return self.label or self.name

    @property
    def is_shared(self) -> bool:
        """True for an event that lasts for its partners as well."""
        return self.together and self.collaborative and self.duration is not None

    @property
    def window(self) -> Optional[Window]:
        """Between which times it ends; None for an event that is instantaneous."""
        return None if self.duration is None else window_of(self.duration, self.latest)

    @property
    def text(self) -> str:
        return joined(
            f'event "{self.name}"',
            label_text(self.label),
            self.collaborative and "collaborative",
            self.together and "together",
            behind("location", self.location and self.location.name),
            "" if self.duration is None else f"duration {window_text(self.duration, self.latest)}",
            "" if self.at_most is None else f"at_most {self.at_most} times",
            only_if_text(self.only_if),
        )
