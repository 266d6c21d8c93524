"""`agent "name" …`: somebody who does something."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Iterator, Optional, Tuple

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error, warning
from pursue_gen.language.measures import metres
from pursue_gen.language.numbers import Number, Window, exact, is_fine, tenths_above, tenths_below, window_of
from pursue_gen.language.refs import Ref, twice
from pursue_gen.language.statements.base import Labelled
from pursue_gen.language.template import Filling, Template, name_text
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word

SIZE = ("radius", "tolerance", "inflation")
"""The words of a robot's size, in the order in which they stand, which is that of the fields of `RobotSize`."""

MOST_METRES = 100
"""The largest number of a robot's size."""


def _read_starts(reader: TreeReader, tree: Any) -> Tuple[Ref, Tuple[Ref, ...]]:
    first, *others = map(reader.ref, tree.children)
    return first, tuple(others)


def _starts_text(first: Ref, others: Tuple[Ref, ...]) -> str:
    return " or ".join(map(name_text, (first, *others)))


@dataclass(frozen=True)
class Agent(Labelled):
    """A robot (controllable), a human ally (controllable and human) or an uncontrollable agent.

    `mobile` is the time units per unit of distance (the inverse of its speed), None: it never moves. `speed`: the
    metres per second from which it was computed; None: it was written itself. `carries`: how many things at one time at
    most; None: not said. `has`: what it carries, or has mounted, at the start. `or_at`: other places at which it may
    start, where that is not known. `label`: what people read; None: the name. `radius`, `tolerance`, `inflation`: of a
    robot, in metres, as `workspace.robot_size` has them; None: not said.
    """

    name: str
    location: Ref
    human: bool = False
    controllable: bool = False
    mobile: Optional[Number] = None
    can_do: Tuple[Ref, ...] = ()
    reacts_to: Tuple[Ref, ...] = ()
    span: Span = NOWHERE
    label: Optional[str] = None
    radius: Optional[Number] = None
    tolerance: Optional[Number] = None
    inflation: Optional[Number] = None
    speed: Optional[Number] = None
    carries: Optional[int] = None
    has: Tuple[Ref, ...] = ()
    or_at: Tuple[Ref, ...] = ()

    listed_in = "agents"
    symbol = "Class"
    own_words = (
        Word("agent", "Somebody who does something: a robot, a person, a thing with a will of its own."),
        Word(
            "human",
            "An ally who follows instructions, but has no robot: the user interface tells the person what to do.",
            True,
        ),
        Word(
            "controllable",
            "The program decides what this agent does. Without it, the agent does as it likes, also the worst.",
        ),
        Word("mobile", "It moves, and needs so many units of time for a unit of distance. A larger number is slower."),
        Word("speed", "It moves so many metres in a second, and distances are metres: in place of mobile.", True),
        Word("radius", "Metres from the middle of the robot to its farthest part: what it needs to turn.", True),
        Word("tolerance", "Metres by which the robot stops beside its goal, at most (xy_goal_tolerance).", True),
        Word("inflation", "Metres around obstacles that the robot's planners avoid (inflation_radius).", True),
        Word("carries", "So many things at one time, and no more. Without it, a robot carries one.", True),
        Word("can_do", "The events that it does.", may_break=True),
        Word("reacts_to", "The collaborative events in which it is the partner.", may_break=True),
    )
    template = Template(
        'agent {name="bot"} [label {label:name}] [human] [controllable] [mobile {mobile:number=3}]'
        " [speed {speed:number}] [radius {radius:metres}] [tolerance {tolerance:metres}] [inflation {inflation:metres}]"
        " [carries {carries:count}] [has {has:things}]"
        " location {location,or_at:starts=a} [can_do {can_do:events=e1, e2}] [reacts_to {reacts_to:events=e3}]",
        starts=Filling("starts", _read_starts, _starts_text, "POI", ("location", "or"), 'starts: ref ("or" ref)*'),
    )
    note = (
        'location is required; behind the name: label "Porter 1"; in place of mobile: speed 0.5; before location, of a '
        "robot: radius 0.2 tolerance 0.1 inflation 0.5; carries 2 has box; where it is not known: location a or b"
    )
    forms = (
        Form("a robot", 'agent "{=bot}" controllable mobile {=1} location {POI} can_do {event}'),
        Form(
            "a robot that carries several things",
            'agent "{=bot}" controllable mobile {=1} carries {=2} location {POI} can_do {event}, {event}',
        ),
        Form("somebody who does as they like", 'agent "{=visitor}" mobile {=1} location {POI} can_do {event}'),
        Form(
            "somebody of whom it is not known where it starts",
            'agent "{=visitor}" mobile {=1} location {POI} or {POI} can_do {event}',
        ),
        Form("a person who helps", 'agent "{=helper}" human controllable mobile {=1} location {POI} can_do {event}'),
    )
    declares = "agent"
    described = "{0.role}"
    shortest = 'agent "{name}" location {place}'
    parts = template.begins

    @classmethod
    def read(cls, reader: TreeReader, *children: Any, **at: Any) -> Agent:
        made: Agent = super().read(reader, *children, **at)
        if made.speed is None:
            return made
        message, hint = "", "write speed and metres per second, such as speed 0.5"
        if made.mobile is not None:
            message, hint = f"{made.name} has mobile and speed", "delete one: both say how fast it moves"
        elif reader.unit is None:
            message = f"{made.name} has a speed in metres per second, and nothing says what a unit of time is"
            hint = "write a line above all others: unit second (and distances in metres)"
        elif not made.speed:
            message, hint = f"{made.name} would never arrive: its speed is 0", f"{hint}, or delete it: it stays there"
        if message:
            reader.findings.append(error("PML423", message, made.span, hint))
            return replace(made, mobile=made.mobile or 1, speed=None)
        return replace(made, mobile=exact(1 / (Fraction(made.speed) * Fraction(reader.unit or 1))))

    @property
    def text(self) -> str:
        return self.template.written(self if self.speed is None else replace(self, mobile=None))

    @property
    def role(self) -> str:
        """Who decides what it does."""
        if self.is_robot:
            return "a robot: the program decides what it does"
        return "a person who follows instructions" if self.human and self.controllable else "nobody controls it"

    @property
    def starts(self) -> Tuple[Ref, ...]:
        """The places of which it starts at one."""
        return (self.location, *self.or_at)

    @property
    def is_somewhere(self) -> bool:
        """True where it is not known at which of several places it starts."""
        return bool(self.or_at)

    @property
    def starts_text(self) -> str:
        """The places at which it may start, as they are written."""
        return _starts_text(self.location, self.or_at)

    @property
    def is_robot(self) -> bool:
        """True for an agent that gets a controller of its own."""
        return self.controllable and not self.human

    def window_on(self, distance: Number) -> Window:
        """Between which times it arrives on a way; one that comes of a speed and has more than MOST_DIGITS digits is
        rounded outwards, to tenths. It has to be mobile."""
        earliest, latest = window_of(exact(distance * (self.mobile or 0)), None)
        if self.speed is None or is_fine(earliest):
            return earliest, latest
        return tenths_below(earliest), tenths_above(latest)

    @property
    def kind_words(self) -> str:
        """What it is, in words."""
        if not self.controllable:
            return "not controlled"
        return "a person who is instructed" if self.human else "a robot"

    @property
    def size_words(self) -> str:
        """What is said of its size; "": nothing."""
        size = {"radius": self.radius, "goal tolerance": self.tolerance, "inflation radius": self.inflation}
        return ", ".join(f"{what} {metres(number)}" for what, number in size.items() if number is not None)

    def check(self) -> Iterator[Diagnostic]:
        yield from self._check_size()
        if self.or_at and self.controllable:
            message = f"{self.name} is controlled, and starts at {self.starts_text}"
            hint = "name one place: it is told where to begin; or delete controllable"
            yield error("PML441", message, self.location.span, hint)
        for ref in twice(self.starts):
            yield error("PML441", f"{self.name} starts at {ref.name} or {ref.name}", ref.span, "delete one of the two")
        if self.mobile is not None and self.mobile <= 0:
            hint = "mobile is the time per unit of distance: write a number above 0, or delete it where nothing moves"
            yield error("PML142", f"{self.name} would take no time for any way", self.span, hint)
        if self.human and not self.controllable:
            message = f"{self.name} is human but not controllable: human changes nothing here"
            hint = "write human controllable for an ally who follows instructions, or delete human"
            yield warning("PML180", message, self.span, hint)
        for word, refs in (("can_do", self.can_do), ("reacts_to", self.reacts_to)):
            for ref in twice(refs):
                yield error("PML156", f"{self.name} has {ref.name} twice behind {word}", ref.span, "delete one")

    def _check_size(self) -> Iterator[Diagnostic]:
        """A size of what is no robot, or of none that there is."""
        said = {word: number for word, number in ((word, getattr(self, word)) for word in SIZE) if number is not None}
        if said and not self.is_robot:
            hint = f"write controllable behind {self.name} (and no human), or delete {' and '.join(said)}"
            yield error("PML148", f"{self.name} is no robot: nothing is sent to places that need room", self.span, hint)
        for word, number in said.items():
            if number > MOST_METRES:
                message = f"{self.name} has {word} {number}: expected {MOST_METRES} metres at most"
                yield error("PML148", message, self.span, f"write {word} in metres, such as 0.3")
