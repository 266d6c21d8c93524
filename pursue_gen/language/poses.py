"""Poses in the thesis's way: a comment `//[x, y, z, qx, qy, qz, qw]` behind a point of interest.

Behind it in the same comment may stand the poses of single robots at this place: `bot2 [x, y, z, qx, qy, qz, qw]`.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Dict, Iterator, List, Optional, Tuple

from pursue_gen.diagnostics import Diagnostic, Span, error, warning
from pursue_gen.language.numbers import rounded_text
from pursue_gen.language.refs import Ref
from pursue_gen.language.tokens import shown

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
_WORD = re.compile(r"[^\W\d]\w*")
_OPENING = re.compile(r"//[ \t]*(?P<name>[^\W\d]\w*)?[ \t]*\[")
_NEXT = re.compile(r"[ \t]*,?[ \t]*(?P<name>[^\W\d]\w*)[ \t]*\[")
_LIST = re.compile(r"\[([^\]]*)")
_FORM = "write //[x, y, z, qx, qy, qz, qw]: metres and a unit quaternion; //[0, 0, 0, 0, 0, 0, 1] looks along x"
_FORM_OF_ROBOT = "write the robot's name before its pose: //[x, y, z, qx, qy, qz, qw] bot2 [x, y, z, qx, qy, qz, qw]"
_LONGEST = 40
_LOOSE_UNIT = 0.05  # published poses have two decimals, so their quaternions are a little off unit length
_TILT = 0.001
_FARTHEST = 1e6  # metres; anything beyond is a slip of the pen


@dataclass(frozen=True)
class Pose:
    """A pose in frame `map`: position in metres, orientation as a unit quaternion, in the order of geometry_msgs."""

    x: float
    y: float
    z: float
    qx: float
    qy: float
    qz: float
    qw: float


@dataclass(frozen=True)
class Spot:
    """Where one robot stands at a place, instead of at the place's pose."""

    robot: Ref
    pose: Pose


@dataclass(frozen=True)
class _Item:
    """A list in a comment: the name before it ("": the place's own), comment[start:end], and what is in it."""

    name: str
    start: int
    end: int
    inner: str
    closed: bool


def read_poses(comment: str, span: Span, findings: List[Diagnostic]) -> Tuple[Optional[Pose], Tuple[Spot, ...]]:
    """The pose that a comment behind a place holds, and those of single robots there; none where it holds words only (a
    placeholder). `span`: of the comment; what is wrong with it is added to the findings.
    """
    place, *others = list(_items(comment))
    if place.name:
        if _is_pose(place.inner):  # else an ordinary comment
            message = f"the pose of the place has to come before the one of {shown(place.name, 60)}"
            findings.append(error("PML020", message, _part(span, place.start, place.end), _FORM_OF_ROBOT))
        return None, ()
    pose = _read_list(place, span, "a pose", _FORM, findings)
    spots: Dict[str, Spot] = {}
    for item in others:
        here = _part(span, item.start, item.end)
        found = _read_list(item, here, f"the pose of {shown(item.name, 60)}", _FORM_OF_ROBOT, findings)
        if item.name in spots:
            message = f"{shown(item.name, 60)} has two poses at this place"
            findings.append(error("PML022", message, here, "delete one of them"))
        elif found is not None:
            spots[item.name] = Spot(Ref(item.name, _part(span, item.start, item.start + len(item.name))), found)
    for match in _LIST.finditer(comment, (others or [place])[-1].end):
        if _is_pose(match[1]):
            message = "a robot's name is expected before this list of numbers"
            findings.append(error("PML020", message, _part(span, match.start(), match.end()), _FORM_OF_ROBOT))
            break
    return pose, tuple(spots.values())


def robots_in(comment: str) -> List[Tuple[str, int, int]]:
    """The robots that have a pose in such a comment, with the offsets of the name and of what follows the pose."""
    place, *others = list(_items(comment))
    return [] if place.name else [(item.name, item.start, item.end) for item in others]


def end_of_poses(comment: str) -> int:
    """The offset behind the last pose of such a comment, where the pose of a further robot can be written."""
    return list(_items(comment))[-1].end


def _items(comment: str) -> Iterator[_Item]:
    """The lists of a comment, the place's own first, as long as each is closed and the next one follows it."""
    match = _OPENING.match(comment)
    while match is not None:
        inner, bracket, _ = comment[match.end() :].partition("]")
        start = match.start("name") if match["name"] else match.end() - 1
        end = match.end() + len(inner) + len(bracket)
        yield _Item(match["name"] or "", start, end, inner, bool(bracket))
        match = _NEXT.match(comment, end) if bracket else None


def _part(span: Span, start: int, end: int) -> Span:
    """A part of a comment, by its offsets."""
    return Span(span.file, span.line, span.column + start, span.line, span.column + end)


def _split(inner: str) -> List[str]:
    items = [item.strip() for item in inner.split(",")]
    if len(items) > 1 and not items[-1]:
        items.pop()
    return items


def _is_pose(inner: str) -> bool:
    """Is this list meant as a pose? More than two items, a number among them."""
    items = _split(inner)
    return len(items) > 2 and any(_NUMBER.fullmatch(item) for item in items)


def _read_list(item: _Item, span: Span, what: str, form: str, findings: List[Diagnostic]) -> Optional[Pose]:
    """The pose in a list, None for words; `what` it is called in messages, `form`: what to write."""
    items = _split(item.inner)
    if all(_WORD.fullmatch(one) for one in items) or (item.name and item.closed and len(items) == 1):
        return None
    why = _why_no_pose(items, item.closed)
    if why:
        findings.append(error("PML020", f"{what} {why}", span, form))
        return None
    x, y, z, qx, qy, qz, qw = map(float, items)
    length = math.sqrt(qx * qx + qy * qy + qz * qz + qw * qw)
    if length < _LOOSE_UNIT:
        findings.append(error("PML021", "the orientation of this pose is zero: it has no direction", span, _FORM))
        return None
    if abs(length - 1) > _LOOSE_UNIT:
        message = f"the orientation of this pose has length {length:.2f} and is scaled to length 1"
        findings.append(warning("PML120", message, span, "the last four numbers are a unit quaternion qx, qy, qz, qw"))
    if abs(qx) > _TILT * length or abs(qy) > _TILT * length:
        hint = "if these are w, x, y, z, move the first number to the end; if the robot does lean, ignore this"
        message = "this orientation is not a turn about z: a robot that stands on a floor has qx = qy = 0"
        findings.append(warning("PML121", message, span, hint))
    return Pose(x, y, z, qx / length, qy / length, qz / length, qw / length)


def _why_no_pose(items: List[str], closed: bool) -> str:
    """Why a list is no pose; "": it is one."""
    if not closed:
        return "is not closed: expected `]` behind its seven numbers"
    for number, one in enumerate(items, 1):
        if len(one) > _LONGEST or not _NUMBER.fullmatch(one):
            found = f"'{shown(one)}'" if one else "empty"
            return f"holds numbers only, but its item {number} is {found}"
    if len(items) != 7:
        return f"has seven numbers, here are {len(items)}"
    if any(abs(float(one)) > _FARTHEST for one in items):
        return f"is off the map: farther than {_FARTHEST:,.0f} m from its origin"
    return ""


def pose_text(pose: Pose) -> str:
    """The pose as it stands in a comment, with as many digits as it needs."""
    numbers = (pose.x, pose.y, pose.z, pose.qx, pose.qy, pose.qz, pose.qw)
    return "[" + ", ".join(rounded_text(number, 6) for number in numbers) + "]"
