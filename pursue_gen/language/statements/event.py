"""`event "name" …`: something that agents do."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Callable, Iterator, Optional, Tuple

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error, warning
from pursue_gen.language.conditions import Condition, condition_words
from pursue_gen.language.numbers import Number, Window, exact, is_fine, tenths_above, tenths_below, window_of
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.base import Labelled, check_window
from pursue_gen.language.template import Filling, Template
from pursue_gen.language.times import like, window_text
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word

MOST_TIMES = 100
"""How often an event can happen at most that is counted: each count is a location of an automaton."""

MOST_EVENT_PARTS = 20
"""Parts of an event at most: how many are done multiplies the states of the game."""

_OF_WORK = "collaborative together location duration may_stop parts takes gives mounts needs only_if".split()
"""What an event has that somebody does, and no order."""


def _read_counted(reader: TreeReader, tree: Any) -> Tuple[Ref, int]:
    number, name = tree.children
    return reader.ref(name), 1 if number is None else reader.count(number)


def _counted_text(thing: Ref, count: int) -> str:
    return thing.name if count == 1 else f"{count} {thing.name}"


@dataclass(frozen=True)
class Event(Labelled):
    """Something that agents do. `duration` is in time units, None: instantaneous; `location` None: anywhere.

    It ends later than `duration`, and at `latest` at the latest; None: within one time unit more. `at_most`: so often
    it can happen in all; None: as often as one likes.
    `together`: whoever takes part in a collaborative event is busy until it ends; else only the one who does it.
    `only_if`: what has to hold when it begins; None: nothing. `label`: what people read; None: the name.
    `may_stop`: who does it may break it off; it has not happened then. `split`: in so many parts it is done, one after
    the other, each of which stays done; None: as a whole.
    `takes`, `gives`: the thing that whoever does it carries from its end on, and the one that is given away then; so
    many of it (`taken`, `given`) at once.
    `mounts`: the tool that is mounted from its end on, in place of another one; `needs`: what is carried or mounted.
    `on_order`: it happens only when a person orders it during a mission, and where all is proven to be kept with it.
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
    may_stop: bool = False
    split: Optional[int] = None
    takes: Optional[Ref] = None
    taken: int = 1
    gives: Optional[Ref] = None
    given: int = 1
    mounts: Optional[Ref] = None
    needs: Optional[Ref] = None
    on_order: bool = False

    listed_in = "events"
    symbol = "Event"
    own_words = (
        Word("event", "Something that can happen: what an agent does, alone or with a partner."),
        Word("collaborative", "It takes two at one place: one who can do it, and one who reacts to it."),
        Word("together", "Whoever takes part is busy until it ends. Without it, only the one who does it is.", True),
        Word("location", "Where it happens (events), or where it starts (agents)."),
        Word(
            "duration",
            "How long it takes, in the unit of time that you chose: 3 is up to 4. Without it, it takes no time.",
        ),
        Word("to", "Where the agent arrives; or, behind a number, the latest time.", True),
        Word(
            "on_order",
            "People order it during the mission; it is accepted only where all is proven to be kept then, too.",
            True,
        ),
        Word("may_stop", "It may be broken off before it ends, and has not happened then.", True),
        Word("takes", "Of an event, a thing that is carried from its end on; of a way, how long it takes.", True),
        Word("gives", "A thing that is carried until its end, and no longer.", True),
        Word("mounts", "A thing that is a tool, mounted from its end on in place of the one that was.", True),
        Word("needs", "A thing that whoever does it carries, or has mounted.", True),
        Word("at_most", "So many and no more: how often it happens in all, or of how many something holds.", True),
        Word("times", "In the whole mission.", True),
    )
    template = Template(
        'event {name="work"} [label {label:name}] [on_order] [collaborative] [together] [location {location:POI=a}]'
        " [duration {duration,latest:window=6}] [may_stop] [in {split:count=4} parts] [takes {takes,taken:counted}]"
        " [gives {gives,given:counted}] [mounts {mounts:thing}] [needs {needs:thing}] [at_most {at_most:count=2} times]"
        " [only_if {only_if:condition=open is_true}]",
        counted=Filling("counted", _read_counted, _counted_text, "thing", rules="counted: [NUMBER] ref"),
    )
    note = (
        'all but the name is optional; or: duration 6 to 9; behind the name: label "do the work", on_order; behind the '
        "duration: may_stop in 4 parts, takes box, takes 2 box, gives box, mounts brush, needs brush"
    )
    forms = (
        Form("something that can happen at a place", 'event "{=work}" location {POI} duration {=1}'),
        Form("something that takes more or less time", 'event "{=work}" location {POI} duration {=3} to {=5}'),
        Form("something that may be broken off", 'event "{=work}" location {POI} duration {=20} may_stop'),
        Form(
            "something that is done part by part",
            'event "{=work}" location {POI} duration {=20} may_stop in {=4} parts',
        ),
        Form("something that happens so many times only", 'event "{=call}" at_most {=2} times'),
        Form(
            "something that can happen only while something holds",
            'event "{=work}" location {POI} only_if {agent} at {POI}',
        ),
        Form("something that loads a thing", 'event "{=load}" location {POI} duration {=3} takes {thing}'),
        Form("something that unloads a thing", 'event "{=unload}" location {POI} duration {=3} gives {thing}'),
        Form("something that mounts a tool", 'event "{=change}" location {POI} duration {=3} mounts {thing}'),
        Form("something for which a tool is needed", 'event "{=work}" location {POI} duration {=3} needs {thing}'),
        Form("something that people order during a mission", 'event "{=order}" on_order'),
        Form("something that two do at once", 'event "{=handOver}" collaborative'),
        Form(
            "something that two do together for a while",
            'event "{=ride}" collaborative together location {POI} duration {=4}',
        ),
    )
    declares = "event"
    described = "an event"
    shortest = 'event "{name}"'
    numbers = {"at_most": lambda _, times: f"It can happen {'once' if times == 1 else f'{times} times'} in all."}
    parts = template.begins

    @property
    def is_shared(self) -> bool:
        """True for an event that lasts for its partners as well."""
        return self.together and self.collaborative and self.duration is not None

    @property
    def window(self) -> Optional[Window]:
        """Between which times it ends; None for an event that is instantaneous."""
        return None if self.duration is None else window_of(self.duration, self.latest)

    @property
    def part_window(self) -> Optional[Window]:
        """Between which times it ends once it has begun: all of it, or a part, whose window is rounded outwards, to
        tenths, where it has more than MOST_DIGITS digits; None for an event that is instantaneous."""
        whole, parts = self.window, self.split or 1
        if whole is None or parts == 1:
            return whole
        low, high = (Fraction(end) / parts for end in whole)
        if is_fine(low) and is_fine(high):
            return exact(low), exact(high)
        return tenths_below(low), tenths_above(high)

    @property
    def load_words(self) -> str:
        """What it takes, gives, mounts and needs, in words; "": nothing."""
        return ", ".join(f"{words} {ref.shown}" for words, ref in self._moves)

    @property
    def _moves(self) -> Iterator[Tuple[str, Ref]]:
        """The things that it names, behind the words for what it does with them."""
        named = (("takes", self.takes, self.taken), ("gives", self.gives, self.given))
        for word, ref, count in (*named, ("mounts", self.mounts, 1), ("needs", self.needs, 1)):
            if ref is not None:
                yield word if count == 1 else f"{word} {count} of", ref

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        own = (kind, name) == ("event", self.name)
        if own and self.on_order:
            yield "is ordered by people during a mission, and accepted only where all is kept then, too"
        if own and self.may_stop:
            yield "may be broken off, and has not happened then"
        if own and self.split:
            yield f"is done in {self.split} parts, which stay done"
        yield from (f"{self.name} {words} it" for words, ref in self._moves if (kind, name) == ("thing", ref.name))
        if self.only_if is not None and (own or (kind == "state" and self.speaks_of(kind, name))):
            yield f"{'' if own else f'{self.name} '}only while {shown(condition_words(self.only_if))}"

    def check(self) -> Iterator[Diagnostic]:
        name, duration, most = self.name, self.duration, self.at_most
        if self.may_stop and (duration is None or self.collaborative):
            what, hint = "is collaborative", "delete may_stop"
            if duration is None:
                what, hint = "takes no time", "write how long it takes, as in duration 20 may_stop; or delete may_stop"
            yield error("PML433", f"{name} {what}: it cannot be broken off", self.span, hint)
        yield from self._check_parts()
        yield from self._check_order()
        if duration is not None and duration <= 0 and self.latest is None:
            hint = "write duration and a number above 0, or delete duration: then it takes no time"
            yield error("PML141", f"{name} has a duration of 0", self.span, hint)
        if most is not None and not 1 <= most <= MOST_TIMES:
            message = f"{name} can happen at_most {most} times: expected 1 to {MOST_TIMES}"
            never = f"; what must never happen is an objective: avoid {name}" if most < 1 else ""
            yield error("PML204", message, self.span, f"write a number in these limits, or delete it{never}")
        if duration is not None and self.latest is not None:
            yield from check_window(name, duration, self.latest, "duration", self.span)

    def _check_order(self) -> Iterator[Diagnostic]:
        """Whatever an order cannot have: it is said, and takes no time and no place."""
        fields = ((word, "split" if word == "parts" else word) for word in _OF_WORK)
        named = [word for word, field in fields if getattr(self, field) not in (None, False)]
        if self.on_order and named:
            message = f"{self.name} is ordered by people: it has no {', no '.join(named)}"
            hint = f"keep on_order alone; what robots do then is another event: if {self.name} then … within 600"
            yield error("PML450", message, self.span, hint)

    def _check_parts(self) -> Iterator[Diagnostic]:
        """Parts of what has none, too few or too many of them, or parts whose time is rounded."""
        name, parts, window = self.name, self.split, self.part_window
        if parts is None:
            return
        what, hint = "", f"delete in {parts} parts"
        if self.duration is None:
            what = "takes no time"
            hint = f"write how long all of it takes, as in duration 20 in {parts} parts; or {hint}"
        elif self.collaborative:
            what, hint = "is collaborative", f"{hint}, or collaborative"
        elif not 2 <= parts <= MOST_EVENT_PARTS:
            what = f"has {parts} parts: expected 2 to {MOST_EVENT_PARTS}"
            hint = f"write a number in these limits, or {hint}"
        if what:
            yield error("PML440", f"{name} {what}", self.span, hint)
        elif window is not None and tuple(end * parts for end in window) != self.window:
            each, whole = (
                window_text(*(like(exact(end * times), self.duration) for end in window)) for times in (1, parts)
            )
            message = f"each of the {parts} parts of {name} is taken to last {each}: all of them {whole}"
            hint = "that is on the safe side; write times that can be divided, or another number of parts"
            yield warning("PML424", message, self.span, hint)
