"""A scenario that is open in an editor, and its map as a picture."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Optional, Tuple

from pursue_gen.diagnostics import PursueError, Severity, error
from pursue_gen.drawing import map_svg
from pursue_gen.drawing.layout import MOST_PLACES, drawable, poses
from pursue_gen.language.draft import Draft

if TYPE_CHECKING:
    from pursue_gen.explanation.decided import Size


UTF_16 = "utf-16"
"""What editors count columns in unless they agree on something else."""


@dataclass(frozen=True)
class OpenDocument(Draft):
    """A draft, and how its editor counts: lines from 0, columns in units of `encoding` ("utf-16", "utf-8" or "utf-32");
    `version` for this state of the text."""

    encoding: str = UTF_16
    version: Optional[int] = None

    def offset(self, line: int, column: int) -> int:
        """The offset of a position; a column between the units of one character means the character's start."""
        if line < 0:
            return 0
        if line >= len(self.lines.starts):
            return len(self.text)
        start, end = self.lines.start(line), self.lines.end(line)
        if self.text[start:end].isascii():
            return min(start + max(column, 0), end)
        at, left = start, column
        while at < end:
            left -= self._width(self.text[at])
            if left < 0:
                break
            at += 1
        return at

    def position(self, offset: int) -> Tuple[int, int]:
        """(line, column) of an offset."""
        offset = min(max(offset, 0), len(self.text))
        line = self.lines.of(offset)
        before = self.text[self.lines.starts[line] : offset]
        return line, len(before) if before.isascii() else sum(map(self._width, before))

    def _width(self, character: str) -> int:
        code = ord(character)
        if self.encoding == UTF_16:
            return 2 if code > 0xFFFF else 1
        if self.encoding == "utf-8":
            return 1 + (code > 0x7F) + (code > 0x7FF) + (code > 0xFFFF)
        return 1

    @cached_property
    def sizes(self) -> Tuple[Size, ...]:
        """What the statements of its objectives cost; () while something is wrong with it, or there is none."""
        from pursue_gen.explanation.decided import sizes

        wrong = any(finding.severity is Severity.ERROR for finding in self.findings)
        return () if wrong else sizes(self.scenario)


def picture(document: Draft) -> str:
    """The map as SVG, as far as the text can be read.

    Raises PursueError where there is nothing to draw, or too much.
    """
    scenario = drawable(document.scenario)
    if not scenario.pois:
        raise PursueError([error("LSP003", "there is no place to draw yet", hint='write one: poi "room"')])
    if len(scenario.pois) > MOST_PLACES:
        message = f"the map has {len(scenario.pois)} places: the preview draws {MOST_PLACES} at most"
        raise PursueError([error("LSP004", message, hint="pursue-gen ws draws all of them, in map.svg")])
    where, computed = poses(scenario)
    return map_svg.draw(scenario, where, computed)
