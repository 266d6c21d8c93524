"""`door "name" opens within 8`: a door that opens by itself, for whoever is controlled and sets off through it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable, Iterator, Optional

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error
from pursue_gen.language.numbers import Number
from pursue_gen.language.poses import Pose, pose_text, read_poses
from pursue_gen.language.statements.base import Labelled
from pursue_gen.language.template import Filling, Template
from pursue_gen.language.times import written_time
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word


def _read_pose(reader: TreeReader, comment: Any) -> Optional[Pose]:
    pose, spots = read_poses(str(comment), reader.at(comment), reader.findings)
    for spot in spots:
        message = f"a door has one pose, and {spot.robot.name} has another one here"
        reader.findings.append(error("PML460", message, spot.robot.span, "delete it: robots find their own side"))
    return pose


@dataclass(frozen=True)
class Door(Labelled):
    """A door through which ways lead: it is asked to open when somebody who is controlled sets off, and is open
    `opens_within` time units later at most. `pose`: its middle; None: robots wait for it where they set off. `label`:
    what people read; None: the name.
    """

    name: str
    opens_within: Number
    span: Span = NOWHERE
    label: Optional[str] = None
    pose: Optional[Pose] = None

    listed_in = "doors"
    symbol = "Interface"
    own_words = (
        Word("door", "A door that opens by itself for robots that set off through it.", True),
        Word("opens", "How long after it was asked to the door is open, at most: opens within 8.", True),
    )
    template = Template(
        'door {name="d1"} [label {label:name}] opens within {opens_within:time=8} [{pose:pose}]',
        pose=Filling("POSE", _read_pose, lambda pose: f"//{pose_text(pose)}"),
    )
    note = "behind it, in a comment, the pose of its middle; ways lead through it: connect … through d1"
    forms = (Form("a door that opens by itself", 'door "{=d1}" opens within {=8}'),)
    numbers = {"within": "A way through it takes up to {} longer, as whoever sets off may have to wait for it.".format}
    declares = "door"
    described = "a door that opens by itself"
    aside = ("pose",)
    shortest = 'door "{name}" opens within 5'

    @property
    def in_words(self) -> str:
        """What people read of it on a way."""
        return f"through {self.shown} (opens within {written_time(self.opens_within)})"

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        if (kind, name) == ("door", self.name):
            yield f"opens within {written_time(self.opens_within)}"

    def check(self) -> Iterator[Diagnostic]:
        if self.opens_within <= 0:
            message = f"{self.name} would be open at once, always"
            yield error("PML460", message, self.span, "write how long it takes to open, such as opens within 5")
