"""Where a place is, written into the comment behind it: everything else in that comment stays."""

from __future__ import annotations

import math
import re
from typing import Optional

from pursue_gen.diagnostics import NOWHERE
from pursue_gen.drawing.layout import yaw_of
from pursue_gen.language.numbers import rounded_text
from pursue_gen.language.poses import read_poses, robots_in
from pursue_gen.language.scenario import Pose

_OWN = re.compile(r"//[ \t]*\[([^\]]*)(\]?)")


def with_position(comment: Optional[str], x: float, y: float, yaw: Optional[float] = None) -> str:
    """The comment of a pose with another position (metres) and direction (degrees; None: as it is).

    Without a comment, or where its list is no pose, height 0 and (None) a direction along x.
    """
    place = f"{metres(x)}, {metres(y)}"
    own = _OWN.match(comment or "")
    if comment is None or own is None:  # a comment that begins with a name is an ordinary one
        pose = f"//[{place}, 0, {_direction(yaw or 0.0)}]"
        return pose if comment is None else f"{pose} {comment}"
    items = [item.strip() for item in own.group(1).split(",")]
    if _is_pose(own.group()):
        z, direction = items[2], ", ".join(items[3:7]) if yaw is None else _direction(yaw)
    else:
        z, direction = "0", _direction(yaw or 0.0)
    return f"//[{place}, {z}, {direction}]{comment[own.end():]}"


def with_spot(comment: str, robot: str, x: float, y: float) -> Optional[str]:
    """The comment of a pose with another position (metres) of a robot's own spot; None where the robot has none."""
    for name, start, end in robots_in(comment):
        if name == robot:
            opening, _, rest = comment[start:end].partition("[")
            _, _, *direction = rest.split(",")
            return f"{comment[:start]}{opening}[{metres(x)}, {metres(y)},{','.join(direction)}{comment[end:]}"
    return None


def heading(pose: Pose) -> float:
    """The direction in which a robot at this pose looks, in degrees from the x axis, above -180 and up to 180."""
    rounded = round(math.degrees(yaw_of(pose)), 1) + 0.0
    return 180.0 if rounded == -180.0 else rounded


def metres(value: float) -> str:
    """A number of metres, in centimetres at the finest."""
    return rounded_text(value, 2)


def _direction(yaw: float) -> str:
    """A turn about z by so many degrees as a unit quaternion."""
    half = math.radians(yaw) / 2
    return f"0, 0, {rounded_text(math.sin(half), 4)}, {rounded_text(math.cos(half), 4)}"


def _is_pose(comment: str) -> bool:
    return read_poses(comment, NOWHERE, [])[0] is not None
