"""`poi "name"`: a place."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Iterator, Optional, Tuple

from pursue_gen.diagnostics import NOWHERE, Span
from pursue_gen.language.poses import Pose, PoseComment, Spot, pose_text, read_poses
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.base import StatementKind, joined, label_text
from pursue_gen.language.tokens import bare
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word


@dataclass(frozen=True)
class Poi(StatementKind):
    """A point of interest; `pose` is None where the author gave none or left the thesis's placeholder.

    `spots` are the poses that single robots have there, each robot once. `label`: what people read; None: the name.
    """

    name: str
    pose: Optional[Pose] = None
    span: Span = NOWHERE
    spots: Tuple[Spot, ...] = ()
    label: Optional[str] = None

    listed_in: ClassVar[str] = "pois"
    words: ClassVar[Tuple[Word, ...]] = (
        Word("poi", "A place where something can happen, or where ways meet."),
        Word("label", "What people read in place of the name: any text without double quotes.", True),
    )
    grammar: ClassVar[str] = 'poi: "poi" NAME [LABEL NAME] [POSE]'
    form: ClassVar[str] = 'poi "a" (or with what people read: poi "a" label "security door")'
    forms: ClassVar[Tuple[Form, ...]] = (Form("a place", 'poi "{=room}"'),)
    declares: ClassVar[str] = "POI"
    shortest: ClassVar[str] = 'poi "{name}"'
    parts: ClassVar[Tuple[str, ...]] = ("POI", "LABEL", "POSE")

    @classmethod
    def read(cls, reader: TreeReader, *children: Any, **at: Any) -> Poi:
        name, _, label, pose = children
        found = PoseComment(None) if pose is None else read_poses(str(pose), reader.at(pose))
        reader.findings += found.findings
        return cls(bare(name), found.pose, reader.at(name), found.spots, reader.label(label))

    def names(self) -> Iterator[Tuple[str, Ref]]:
        return (("agent", spot.robot) for spot in self.spots)

    @property
    def shown(self) -> str:
        """What people read."""
        return self.label or self.name

    @property
    def text(self) -> str:
        spots = "".join(f" {spot.robot.name} {pose_text(spot.pose)}" for spot in self.spots)
        own = pose_text(self.pose) if self.pose is not None else "[none]"
        pose = f"//{own}{spots}" if self.pose is not None or spots else ""
        return joined(f'poi "{self.name}"', label_text(self.label), pose)
