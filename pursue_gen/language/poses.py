"""Poses in the thesis's way: a comment `//[x, y, z, qx, qy, qz, qw]` behind a point of interest."""

from __future__ import annotations

import math
import re
from typing import Optional, Tuple

from pursue_gen.diagnostics import Diagnostic, Span, error, warning
from pursue_gen.language.messages import shown
from pursue_gen.language.scenario import Pose

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
_WORD = re.compile(r"[^\W\d]\w*")
_FORM = "write //[x, y, z, qx, qy, qz, qw]: metres and a unit quaternion; //[0, 0, 0, 0, 0, 0, 1] looks along x"
_LONGEST = 40
_LOOSE_UNIT = 0.05  # published poses have two decimals, so their quaternions are a little off unit length
_TILT = 0.001
_FARTHEST = 1e6  # metres; anything beyond is a slip of the pen


def read_pose(comment: str, span: Span) -> Tuple[Optional[Pose], Tuple[Diagnostic, ...]]:
    """The pose that a comment holds and what is wrong with it; None where it holds words only (a placeholder)."""
    inner, bracket, _ = comment[comment.index("[") + 1 :].partition("]")
    items = [item.strip() for item in inner.split(",")]
    if len(items) > 1 and not items[-1]:
        items.pop()
    if all(_WORD.fullmatch(item) for item in items):
        return None, ()
    if not bracket:
        return None, (error("PML020", "this pose is not closed: expected `]` behind its seven numbers", span, _FORM),)
    for number, item in enumerate(items, 1):
        if len(item) > _LONGEST or not _NUMBER.fullmatch(item):
            found = f"'{shown(item)}'" if item else "empty"
            message = f"a pose holds numbers only, but its item {number} is {found}"
            return None, (error("PML020", message, span, _FORM),)
    if len(items) != 7:
        return None, (error("PML020", f"a pose has seven numbers, here are {len(items)}", span, _FORM),)
    numbers = tuple(float(item) for item in items)
    if any(abs(number) > _FARTHEST for number in numbers):
        return None, (error("PML020", "a pose farther than a thousand kilometres away cannot be meant", span, _FORM),)
    return _pose_of(numbers, span)


def _pose_of(numbers: Tuple[float, ...], span: Span) -> Tuple[Optional[Pose], Tuple[Diagnostic, ...]]:
    x, y, z, qx, qy, qz, qw = numbers
    length = math.sqrt(qx * qx + qy * qy + qz * qz + qw * qw)
    if length < _LOOSE_UNIT:
        return None, (error("PML021", "the orientation of this pose is zero: it has no direction", span, _FORM),)
    findings = []
    if abs(length - 1) > _LOOSE_UNIT:
        message = f"the orientation of this pose has length {length:.2f} and is scaled to length 1"
        findings.append(warning("PML120", message, span, "the last four numbers are a unit quaternion qx, qy, qz, qw"))
    if abs(qx) > _TILT * length or abs(qy) > _TILT * length:
        hint = "if these are w, x, y, z, move the first number to the end; if the robot does lean, ignore this"
        message = "this orientation is not a turn about z: a robot that stands on a floor has qx = qy = 0"
        findings.append(warning("PML121", message, span, hint))
    return Pose(x, y, z, qx / length, qy / length, qz / length, qw / length), tuple(findings)
