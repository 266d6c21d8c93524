"""`poi "name"`: a place."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, Iterator, Optional, Tuple

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span
from pursue_gen.language.poses import Pose, Spot, pose_text, read_poses
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.base import ForSome, Labelled
from pursue_gen.language.template import Filling, Template
from pursue_gen.language.word import Form, Word


def _poses_text(pose: Optional[Pose], spots: Tuple[Spot, ...]) -> str:
    own = "[none]" if pose is None else pose_text(pose)
    return f"//{own}" + "".join(f" {spot.robot.name} {pose_text(spot.pose)}" for spot in spots)


POSES = Filling("POSE", lambda reader, it: read_poses(str(it), reader.at(it), reader.findings), _poses_text)
"""The pose of a place in a comment behind it, and those behind names."""


@dataclass(frozen=True)
class Poi(Labelled, ForSome):
    """A point of interest; `pose` is None where the author gave none or left the thesis's placeholder.

    `only_for` and `not_for` say which agents may be there, as in `ForSome`. `spots` are the poses that single robots
    have there, each robot once. `label`: what people read; None: the name.
    """

    name: str
    pose: Optional[Pose] = None
    span: Span = NOWHERE
    spots: Tuple[Spot, ...] = ()
    label: Optional[str] = None
    only_for: Tuple[Ref, ...] = ()
    not_for: Tuple[Ref, ...] = ()

    listed_in = "pois"
    symbol = "Constant"
    own_words = (
        Word("poi", "A place where something can happen, or where ways meet."),
        Word("label", "What people read in place of the name: any text without double quotes.", True),
    )
    template = Template(
        'poi {name="a"} [label {label:name}] ' + ForSome.for_whom + " [{pose,spots:poses}]",
        poses=POSES,
    )
    note = (
        'or with what people read: poi "a" label "security door"; for agv, cart or except gerda behind it: '
        "only these, or all but these, may be there"
    )
    forms = (
        Form("a place", 'poi "{=room}"'),
        Form("a place where somebody never is", 'poi "{=room}" except {agent}'),
    )
    declares = "POI"
    described = "a place"
    aside = ("pose", "spots")
    shortest = 'poi "{name}"'
    parts = template.begins

    def names(self) -> Iterator[Tuple[str, Ref]]:
        return (("agent", ref) for ref in (*self.only_for, *self.not_for, *(spot.robot for spot in self.spots)))

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        if kind == "agent" and not self.admits(name):
            yield f"never is at {self.name}"

    @property
    def what(self) -> str:
        return self.name

    def check(self) -> Iterator[Diagnostic]:
        yield from self.check_whom()
