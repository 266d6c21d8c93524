"""UPPAAL's XML as a tree of elements that know their place in the text, read by expat.

A network needs no declarations in its document type, so a text that has some is refused: nothing in it can define
entities, which other readers expand without end or fetch from elsewhere. Depth and size are bounded as well.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Dict, List, NoReturn, Optional, Tuple
from xml.parsers import expat

from pursue_gen.diagnostics import Span, error
from pursue_gen.outcomes import Invalid

_LETTERS, _ELEMENTS, _DEPTH = 10_000_000, 100_000, 20
"""How much a text may hold. Networks of a hundred automata stay far below; UPPAAL's own files are 6 elements deep."""
_MESSAGE = 300
"""Letters of a message."""
_EXPECTED = "an UPPAAL network (<nta>…</nta>) was expected"
_ESCAPES = "in texts and attributes & is written &amp; and < is written &lt;"


@dataclass
class Element:
    """One element: its attributes, its own text (without its children's), its children and its place."""

    name: str
    attributes: Dict[str, str]
    span: Span
    text: str = ""
    children: List[Element] = field(default_factory=list)

    def all(self, name: str) -> List[Element]:
        """The children of that name."""
        return [child for child in self.children if child.name == name]

    def one(self, name: str) -> Optional[Element]:
        """The first child of that name, or None."""
        return next((child for child in self.children if child.name == name), None)

    def attribute(self, name: str) -> str:
        """The attribute. Raises PursueError where it is missing."""
        if name not in self.attributes:
            self.fail("TGA001", f"<{self.name}> lacks the attribute {name}")
        return self.attributes[name]

    def fail(self, code: str, message: str, hint: str = "") -> NoReturn:
        """Raises a PursueError at this element."""
        raise Invalid([error(code, shortened(message), self.span, hint)])


def shortened(text: str, most: int = _MESSAGE) -> str:
    """The text of a message, or a part of it, cut where it repeats a long one."""
    return text if len(text) <= most else text[: most - 1] + "…"


def read_markup(text: str, file: str) -> Element:
    """The outermost element of the text. Raises PursueError where it is not well-formed XML, or refused as above."""
    return _MarkupReader(text, file).root()


class _MarkupReader:
    """Builds the tree while expat reads."""

    def __init__(self, text: str, file: str) -> None:
        self._lines = re.split(r"\r\n|\r|\n", text)
        self._text, self._file = text, file
        self._outermost: Optional[Element] = None
        self._open: List[Element] = []
        self._pieces: List[List[str]] = []  # the text of each open element
        self._elements = 0
        self._expat = expat.ParserCreate("utf-8")
        self._expat.buffer_text = True
        self._expat.StartElementHandler = self._start
        self._expat.EndElementHandler = self._end
        self._expat.CharacterDataHandler = lambda data: self._pieces[-1].append(data)
        self._expat.StartDoctypeDeclHandler = self._document_type
        self._expat.SkippedEntityHandler = self._unknown_entity

    def root(self) -> Element:
        """Reads the text."""
        if len(self._text) > _LETTERS:
            self._fail(1, 1, f"this file has more than {_LETTERS} letters", _EXPECTED)
        try:
            self._expat.Parse(self._text.encode("utf-8", "replace"), True)
        except expat.ExpatError as problem:
            self._not_well_formed(problem)
        assert self._outermost is not None, "expat refuses a text without an element"
        return self._outermost

    def _start(self, name: str, attributes: Dict[str, str]) -> None:
        line, column = self._place()
        self._elements += 1
        if len(self._open) == _DEPTH or self._elements > _ELEMENTS:
            what = f"elements are nested more than {_DEPTH} deep" if len(self._open) == _DEPTH else "too many elements"
            self._fail(line, column, f"{what} for a network", f"{_EXPECTED}, of {_ELEMENTS} elements at most")
        element = Element(name, attributes, self._span(line, column, len(name) + 1))
        if self._open:
            self._open[-1].children.append(element)
        else:
            self._outermost = element
        self._open.append(element)
        self._pieces.append([])

    def _end(self, name: str) -> None:
        element = self._open.pop()
        element.text = "".join(self._pieces.pop())
        line, column = self._place()
        closed = self._lines[line - 1].startswith("</", column - 1)  # else it is empty, and this is behind it
        end = column + len(name) + 3 if closed else column
        element.span = Span(self._file, element.span.line, element.span.column, line, end)

    def _document_type(self, name: str, system: Optional[str], public: Optional[str], internal: bool) -> None:
        if internal:
            self._fail(*self._place(), "the document type has declarations of its own", "remove them: [ … ] and within")

    def _unknown_entity(self, name: str, parameter: bool) -> None:
        self._fail(*self._place(), f"&{name}; is not defined", _ESCAPES)

    def _not_well_formed(self, problem: expat.ExpatError) -> NoReturn:
        line, column = problem.lineno, problem.offset + 1
        inner = self._open[-1] if self._open else None
        if inner and problem.code == expat.errors.codes[expat.errors.XML_ERROR_NO_ELEMENTS]:
            inner.fail("TGA001", f"<{inner.name}> is never closed", f"write </{inner.name}> where it ends")
        if inner and problem.code == expat.errors.codes[expat.errors.XML_ERROR_TAG_MISMATCH]:
            found = re.compile(r"[^\s>]*").match(self._lines[line - 1], column - 1)
            message = f"</{found.group() if found else ''}> stands where </{inner.name}> was expected"
            self._fail(line, column, message, f"close <{inner.name}> of line {inner.span.line} first")
        hint = _ESCAPES if inner else _EXPECTED
        self._fail(line, column, f"this is not well-formed XML: {expat.ErrorString(problem.code)}", hint)

    def _place(self) -> Tuple[int, int]:
        return self._expat.CurrentLineNumber, self._expat.CurrentColumnNumber + 1

    def _span(self, line: int, column: int, width: int) -> Span:
        return Span(self._file, line, column, line, column + width)

    def _fail(self, line: int, column: int, message: str, hint: str) -> NoReturn:
        raise Invalid([error("TGA001", message, self._span(line, column, 1), hint)])
