"""`lift "name" at hall0, hall1 comes within 40 takes 10 to 20`: a lift that robots call and ride by themselves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, Iterator, Optional, Tuple

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error, listed
from pursue_gen.language.numbers import Number, Window, window_of
from pursue_gen.language.poses import Pose, Spot
from pursue_gen.language.refs import Ref, twice
from pursue_gen.language.statements.base import Labelled, check_window
from pursue_gen.language.statements.poi import POSES
from pursue_gen.language.template import Template
from pursue_gen.language.times import window_text, written_time
from pursue_gen.language.word import Form, Word


@dataclass(frozen=True)
class Lift(Labelled):
    """A lift by which ways lead between its `floors`, the places before its door from the lowest one up.

    A robot that sets off calls it, and it is open at the robot's floor `comes_within` time units later at most. With
    the robot in it, it takes more than `earliest` and at most `latest` time units (None: one more) to another floor.
    `pose`: the middle of its cabin; `cabins`: where that is at single floors, if it is elsewhere on the map. `label`:
    what people read; None: the name.
    """

    name: str
    floors: Tuple[Ref, ...]
    comes_within: Number
    earliest: Number
    latest: Optional[Number] = None
    span: Span = NOWHERE
    label: Optional[str] = None
    pose: Optional[Pose] = None
    cabins: Tuple[Spot, ...] = ()

    listed_in = "lifts"
    symbol = "Interface"
    own_words = (
        Word("lift", "A lift that robots call by themselves when they set off by it.", True),
        Word("comes", "How long after it was called the lift is open there, at most: comes within 40.", True),
    )
    template = Template(
        'lift {name="lift1"} [label {label:name}] at {floors:POIs=a, b} comes within {comes_within:time=40} '
        "takes {earliest,latest:window=10 to 20} [{pose,cabins:poses}]",
        poses=POSES,
    )
    note = "the places before its door, from the lowest up; ways go by it: connect a and b … by lift1"
    forms = (Form("a lift", 'lift "{=lift1}" at {POI}, {POI} comes within {=40} takes {=10} to {=20}'),)
    numbers = {"within": "A way by it takes up to {} longer, as whoever sets off may have to wait for it.".format}
    declares = "lift"
    described = "a lift"
    aside = ("pose", "cabins")

    @property
    def ride(self) -> Window:
        """Between which times it takes somebody to another floor."""
        return window_of(self.earliest, self.latest)

    @property
    def times(self) -> str:
        """How long it takes, in words."""
        return f"comes within {written_time(self.comes_within)}, takes {window_text(self.earliest, self.latest)}"

    @property
    def in_words(self) -> str:
        """What people read of it on a way."""
        return f"by {self.shown} ({self.times})"

    def cabin_at(self, floor: str) -> Optional[Pose]:
        """Where its cabin is when it is at a floor; None: that is not known."""
        return next((each.pose for each in self.cabins if each.robot.name == floor), self.pose)

    def names(self) -> Iterator[Tuple[str, Ref]]:
        return (("POI", ref) for ref in (*self.floors, *(each.robot for each in self.cabins)))

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        if (kind, name) == ("lift", self.name):
            yield self.times
            yield f"from the lowest floor up: {listed(ref.shown for ref in self.floors)}"
        if kind == "POI" and any(ref.name == name for ref in self.floors):
            yield f"a floor of {self.shown}"

    def check(self) -> Iterator[Diagnostic]:
        names = [ref.name for ref in self.floors]
        for ref in twice(self.floors):
            yield error("PML470", f"{ref.name} stands twice behind at", ref.span, "delete one of the two")
        if len(set(names)) < 2:
            hint = "name the places before its door, from the lowest floor up: at hall0, hall1"
            yield error("PML470", f"{self.name} has one floor only", self.span, hint)
        if self.comes_within <= 0:
            message = f"{self.name} would be there at once, always"
            yield error("PML470", message, self.span, "write how long it takes to come, such as comes within 40")
        if self.latest is not None:
            yield from check_window(f"a ride in {self.name}", self.earliest, self.latest, "takes", self.span)
        for each in (each.robot for each in self.cabins if each.robot.name not in names):
            message = f"the cabin of {self.name} has a pose at {each.name}, which is none of its floors"
            yield error("PML470", message, each.span, f"write one of {', '.join(dict.fromkeys(names))}, or delete it")
