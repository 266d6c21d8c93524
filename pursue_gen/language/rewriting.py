"""Numbers and statements written into a scenario's text; all the rest, comments included, stays as its author wrote it.

A *remark* is a comment that says where a number comes from, such as `// survey: 4.16 m on map.yaml`. It begins with the
name of the command that wrote the number, and is replaced with it.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from typing import Dict, Iterator, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.diagnostics import Span
from pursue_gen.language.edits import Edit
from pursue_gen.language.formatter_items import BLOCK, LINE, Item, items_of
from pursue_gen.language.numbers import Number
from pursue_gen.language.poses import end_of_poses
from pursue_gen.language.scenario import Agent, Connection, Event, Poi, Pose, Scenario, Travel
from pursue_gen.language.syntax import cut

REMARK = re.compile(r"(?://|/\*)[ \t]*(?P<command>survey|calibrate): ")
"""Begins a remark."""

_SIZE = ("RADIUS", "TOLERANCE", "INFLATION")
_STATEMENTS = ("poi", "connection", "agent", "travel")


class Rewriting:
    """What has to be changed in the text of a scenario that has been read without errors, for each of its numbers.

    Numbers are written as they are given: the caller rounds them. A `remark` begins with the command's name and a
    colon, and holds neither line ends nor `*/`; "" writes none.
    """

    def __init__(self, scenario: Scenario) -> None:
        self._text = scenario.text
        self._items = items_of(scenario.text)
        self._starts = [item.start for item in self._items]
        self._lines = [0, *(match.end() for match in re.finditer("\n", scenario.text))]
        self._trees = sorted(
            (tree.meta.start_pos, tree.meta.end_pos, str(tree.data))
            for tree in cut(scenario.text, scenario.file).trees
            if hasattr(tree, "meta")
        )

    # Numbers ----------------------------------------------------------------------------------------------------------

    def distance(self, way: Connection, distance: Number, remark: str) -> List[Edit]:
        """Writes the distance of a way."""
        return self._window(way.span, "DISTANCE", (distance,), remark)

    def travel(self, travel: Travel, earliest: Number, latest: Number, remark: str) -> List[Edit]:
        """Writes the window of a travel time."""
        return self._window(travel.span, "TAKES", (earliest, latest), remark)

    def duration(self, event: Event, earliest: Number, latest: Number, remark: str) -> List[Edit]:
        """Writes the window of an event's duration, which it has already."""
        return self._window(event.span, "DURATION", (earliest, latest), remark)

    def size(self, agent: Agent, numbers: Mapping[str, Number], remark: str) -> List[Edit]:
        """Writes numbers of a robot's size (`radius`, `tolerance`, `inflation` → metres)."""
        start = self._offset(agent.span)
        words = [item for item in self._within(start) if not item.is_comment]
        kinds = [item.kind for item in words]
        kinds = kinds[: kinds.index("LOCATION") + 1]
        edits: List[Edit] = []
        new: Dict[int, str] = {}
        for number, word in enumerate(_SIZE):
            if word.lower() not in numbers:
                continue
            text = str(numbers[word.lower()])
            if word in kinds:
                old = words[kinds.index(word) + 1]
                edits.append(Edit(old.start, old.start + len(old.text), text))
            else:
                following = next(kind for kind in (*_SIZE[number + 1 :], "LOCATION") if kind in kinds)
                at = words[kinds.index(following)].start
                new[at] = f"{new.get(at, '')}{word.lower()} {text} "
        return [*edits, *(Edit(at, at, text) for at, text in new.items()), *self._remarked(self._end(start), remark)]

    def written_by(self, span: Span) -> Optional[str]:
        """The command that wrote the numbers of the statement around this place, as its remark says; None: a person."""
        remark = self._remark(self._end(self._offset(span)))
        match = REMARK.match(remark.text) if remark is not None else None
        return match["command"] if match else None

    def _window(self, span: Span, word: str, numbers: Sequence[Number], remark: str) -> List[Edit]:
        start = self._offset(span)
        words = [item for item in self._within(start) if not item.is_comment]
        here = next(k for k, item in enumerate(words) if item.kind == word)
        first = last = words[here + 1]
        if [item.kind for item in words[here + 2 : here + 4]] == ["TO", "NUMBER"]:
            last = words[here + 3]
        edit = Edit(first.start, last.start + len(last.text), " to ".join(map(str, numbers)))
        return [edit, *self._remarked(self._end(start), remark)]

    # Spots and new statements -----------------------------------------------------------------------------------------

    def spots(self, poi: Poi, spots: Sequence[Tuple[str, Pose]], remark: str) -> List[Edit]:
        """Adds spots of robots, which have none at this place so far, behind the pose of the place."""
        start = self._offset(poi.span)
        comment = next(item for item in self._items[bisect_right(self._starts, start) :] if item.kind == LINE)
        end = comment.start + end_of_poses(comment.text)
        added = "".join(f" {robot} {pose_text(pose)}" for robot, pose in spots)
        last = comment.start + len(comment.text)
        if end == last:
            return [Edit(end, end, f"{added} {remark}" if remark else added)]
        return [Edit(end, end, added), Edit(last, last, f"; {remark}" if remark else "")]

    def statements(self, behind: Sequence[str], lines: Sequence[str]) -> List[Edit]:
        """Adds statements, one a line, below the last statement of the first of these kinds that the scenario has.

        The kinds are `poi`, `connection`, `agent` and `travel`; without any of them they come at the end of the text.
        """
        assert set(behind) <= set(_STATEMENTS)
        if not lines:
            return []
        ends = [max((end for _, end, kind in self._trees if kind == one), default=-1) for one in behind]
        last = next((end for end in ends if end >= 0), len(self._text))
        at = self._line_end(last)
        for item in self._items:  # a comment that goes on in the next line
            if item.kind == BLOCK and last <= item.start < at:
                at = max(at, self._line_end(self._text.index("*/", item.start)))
        blank = "" if self._text[:at].endswith("\n") or not self._text[:at] else "\n"
        return [Edit(at, at, blank + "\n".join(lines) + ("\n" if at == len(self._text) else ""))]

    # Places in the text -----------------------------------------------------------------------------------------------

    def _line_end(self, offset: int) -> int:
        end = self._text.find("\n", offset)
        return len(self._text) if end < 0 else end

    def _offset(self, span: Span) -> int:
        return self._lines[span.line - 1] + span.column - 1

    def _end(self, offset: int) -> int:
        """Where the statement around a place ends."""
        return next(int(end) for start, end, _ in self._trees if start <= offset < end)

    def _within(self, offset: int) -> Iterator[Item]:
        """The items of the statement from a place on."""
        end = self._end(offset)
        for item in self._items[bisect_right(self._starts, offset - 1) :]:
            if item.start >= end:
                return
            yield item

    def _remark(self, end: int) -> Optional[Item]:
        """The remark behind a statement, on its line."""
        for item in self._items[bisect_right(self._starts, end - 1) :]:
            if item.breaks or not item.is_comment:
                return None
            if REMARK.match(item.text):
                return item
        return None

    def _remarked(self, end: int, remark: str) -> Iterator[Edit]:
        """A remark behind a statement that ends here: to the end of the line, where nothing else is on it."""
        old = self._remark(end)
        place = (end, end) if old is None else (old.start, _end(old))
        alone = not self._text[place[1] : self._line_end(place[1])].strip()
        text = f"// {remark}" if alone else f"/* {remark} */"
        if remark:
            yield Edit(*place, text if old is not None else f" {text}")
        elif old is not None:
            yield Edit(*place, "")


def pose_text(pose: Pose) -> str:
    """The pose as it stands in a comment, with as many digits as it needs."""
    numbers = (pose.x, pose.y, pose.z, pose.qx, pose.qy, pose.qz, pose.qw)
    return "[" + ", ".join(_decimal(number) for number in numbers) + "]"


def _decimal(number: float) -> str:
    """The number without an exponent, rounded to a millionth."""
    text = f"{number:.6f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def _end(item: Item) -> int:
    return item.start + len(item.text)
