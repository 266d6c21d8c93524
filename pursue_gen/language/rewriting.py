"""Numbers and statements written into a scenario's text; all the rest, comments included, stays as its author wrote it.

A *remark* is a comment that says where a number comes from, such as `// survey: 4.16 m on map.yaml`. It begins with the
name of the command that wrote the number, and is replaced with it.
"""

from __future__ import annotations

import re
from itertools import chain
from typing import Dict, Iterator, List, Mapping, Optional, Sequence, Tuple

from lark import Token

from pursue_gen.diagnostics import Span, error
from pursue_gen.language.document import Document, Edit, behind, written
from pursue_gen.language.kinds import KEYWORDS, STATEMENTS
from pursue_gen.language.measures import length_text
from pursue_gen.language.numbers import Number
from pursue_gen.language.occurrences import are_names
from pursue_gen.language.poses import end_of_poses, pose_text
from pursue_gen.language.scenario import Agent, Connection, Event, Poi, Pose, Scenario
from pursue_gen.language.statements.agent import SIZE
from pursue_gen.language.syntax import Statement
from pursue_gen.language.times import has_unit, in_units, written_time
from pursue_gen.language.tokens import end_of, start_of
from pursue_gen.outcomes import Invalid

REMARK = re.compile(r"(?://|/\*)[ \t]*(?P<command>survey|calibrate): ")
"""Begins a remark."""

Movement = Tuple[str, str, str]
"""Agent, from, to."""

Part = Tuple[Token, ...]


class Rewriting:
    """What has to be changed in the text of a scenario that has been read without errors, for each of its numbers.

    Numbers are written as they are given: the caller rounds them. A `remark` begins with the command's name and a
    colon, and holds neither line ends nor `*/`; "" writes none.
    """

    def __init__(self, scenario: Scenario) -> None:
        self._document, self._travels = Document(scenario.text, scenario.file), scenario.travels
        self._unit = scenario.unit

    # Numbers ----------------------------------------------------------------------------------------------------------

    def distance(self, way: Connection, distance: Number, remark: str) -> List[Edit]:
        """Writes the distance of a way."""
        return self._window(way.span, "DISTANCE", (distance,), remark)

    def windows(self, windows: Mapping[Movement, Tuple[Number, Number, str]]) -> List[Edit]:
        """Writes windows of movements (earliest, latest, remark): into the `travel` of each, or as a new one."""
        travels = {(travel.agent.name, *travel.way): travel.span for travel in self._travels}
        edits: List[Edit] = []
        lines: List[str] = []
        for movement, (low, high, remark) in windows.items():
            if movement in travels:
                edits += self._window(travels[movement], "TAKES", (low, high), remark)
            else:
                agent, a, b = movement
                takes = f"takes {self._times(low, high)}"
                lines.append(f"travel {agent} from {a} to {b} {takes} // {remark}")
        return [*edits, *self.statements(("TRAVEL", "AGENT"), lines)]

    def duration(self, event: Event, earliest: Number, latest: Number, remark: str) -> List[Edit]:
        """Writes the window of an event's duration, which it has already."""
        return self._window(event.span, "DURATION", (earliest, latest), remark)

    def size(self, agent: Agent, numbers: Mapping[str, Number], remark: str) -> List[Edit]:
        """Writes numbers of a robot's size (`radius`, `tolerance`, `inflation` → metres)."""
        statement = self._statement(agent.span)
        sizes = [part_edits(statement, word.upper(), str(numbers[word])) for word in SIZE if word in numbers]
        return [*chain.from_iterable(sizes), *self._remarked(statement, remark)]

    def written_by(self, span: Span) -> Optional[str]:
        """The command that wrote the numbers of the statement around this place, as its remark says; None: a person."""
        remark = remark_behind(self._document, self._around(span))
        match = REMARK.match(remark) if remark is not None else None
        return match["command"] if match else None

    def _window(self, span: Span, word: str, numbers: Sequence[Number], remark: str) -> List[Edit]:
        statement = self._statement(span)
        kinds = [token.type for token in statement.tokens]
        here = next(k for k in range(len(kinds)) if kinds[k : k + 2] == [word, "NUMBER"])
        last = here + 3 if kinds[here + 2 : here + 4] == ["TO", "NUMBER"] else here + 1
        place = start_of(statement.tokens[here + 1]), end_of(statement.tokens[last])
        units = has_unit(statement.tokens[here + 1])
        length = units and word == "DISTANCE"
        edit = Edit(*place, length_text(numbers[0]) if length else self._times(*numbers, units=units))
        return [edit, *self._remarked(statement, remark)]

    def _times(self, *numbers: Number, units: bool = True) -> str:
        """A window in words of the language; with `units`, where the scenario says what a unit of time is."""
        unit = self._unit if units else None
        return " to ".join(written_time(in_units(number, unit)) for number in numbers)

    # Spots and new statements -----------------------------------------------------------------------------------------

    def spots(self, poi: Poi, spots: Sequence[Tuple[str, Pose]], remark: str) -> List[Edit]:
        """Adds spots of robots, which have none at this place so far, behind the pose of the place."""
        comment = self._statement(poi.span).tokens[-1]
        words = comment.rstrip()
        end = start_of(comment) + end_of_poses(words)
        added = "".join(f" {robot} {pose_text(pose)}" for robot, pose in spots)
        last = start_of(comment) + len(words)
        if end == last:
            return [Edit(end, end, f"{added} {remark}" if remark else added)]
        return [Edit(end, end, added), Edit(last, last, f"; {remark}" if remark else "")]

    def statements(self, below: Sequence[str], lines: Sequence[str]) -> List[Edit]:
        """Adds statements, one a line, below the last statement of the first of these kinds that the scenario has, else
        at the end of the text.
        """
        if not lines:
            return []
        text = self._document.text
        found = ([one for one in self._document.statements if one.kind == kind] for kind in below)
        last = next((some[-1].end for some in found if some), len(text))
        at = self._document.line_end(last)
        blank = "" if text[:at].endswith("\n") or not text[:at] else "\n"
        return [Edit(at, at, blank + "\n".join(lines) + ("\n" if at == len(text) else ""))]

    def _statement(self, span: Span) -> Statement:
        """The statement around a place. Raises Invalid where it is for each of a group: it has one number for all."""
        if span.member:
            message = f"this statement is for each of a group ({span.member}): it has no number of its own"
            hint = "write it out, a statement for each member, so that numbers can be written into them"
            raise Invalid([error("PML412", message, span, hint)])
        return self._around(span)

    def _around(self, span: Span) -> Statement:
        found = self._document.statement_at(self._document.lines.of_span(span)[0])
        assert found is not None, "the scenario was read from this text"
        return found

    def _remarked(self, statement: Statement, remark: str) -> Iterator[Edit]:
        """A remark behind a statement: to the end of the line, where nothing else is on it."""
        old = remark_behind(self._document, statement)
        last = statement.tokens[-1] if old is None else old
        text = self._document.text
        alone = not text[end_of(last) : self._document.lines.end_at(end_of(last))].strip()
        words = f"// {remark}" if alone else f"/* {remark} */"
        if old is not None:
            yield written(old, words if remark else "")
        elif remark:
            yield behind(last, f" {words}")


def parts_in(kind: str) -> Tuple[str, ...]:
    """The tokens that begin the parts of statements of a kind; (): they have none that are written alone."""
    return STATEMENTS[kind].parts if kind in STATEMENTS else ()


def parts_of(statement: Statement) -> Dict[str, Part]:
    """The parts of a statement with parts that are there: the word that begins each → its tokens, that word first."""
    begins = parts_in(statement.kind)
    found: Dict[str, List[Token]] = {}
    current = ""
    for token, named in zip(statement.tokens, are_names(statement.tokens)):
        if token.type in begins and not named and token.type not in found and current != "ONLY_IF":
            current = token.type
            found[current] = []
        found[current].append(token)
    return {kind: tuple(tokens) for kind, tokens in found.items()}


def part_edits(statement: Statement, kind: str, words: Optional[str]) -> List[Edit]:
    """Writes a part of a statement with parts anew, adds it behind those before it, or leaves it out (None).

    `words` are those behind the word that begins the part; of a POSE they are the comment itself.
    """
    found, begins = parts_of(statement), parts_in(statement.kind)
    old = found.get(kind, ())
    if words is None:
        return [written(token, "") for token in old]
    if old:
        kept = 0 if kind == "POSE" else 1
        return [written(token, "" if number else words) for number, token in enumerate(old[kept:])]
    last = next(found[part][-1] for part in reversed(begins[: begins.index(kind)]) if part in found)
    return [behind(last, f" {words}" if kind == "POSE" else f" {KEYWORDS[kind]} {words}".rstrip())]


def remark_behind(document: Document, statement: Statement) -> Optional[Token]:
    """The remark behind a statement, on its line."""
    return next(filter(REMARK.match, document.comments_behind(statement)), None)
