"""A lenient reader of UPPAAL's markup: a tree of elements that know their place in the text.

The published networks are not well-formed XML (words stand between elements, an id is used in several templates), so
an XML parser refuses them. This reader needs elements to nest and nothing more; text beside the elements that carry
text is ignored by whoever walks the tree.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Dict, List, Match, NoReturn, Optional, Tuple

from pursue_gen.diagnostics import PursueError, Span, error

_TAG = re.compile(
    r"<(?P<close>/?)(?P<name>[A-Za-z][\w.-]*)(?P<attributes>(?:\"[^\"]*\"|'[^']*'|[^<>\"'])*?)(?P<empty>/?)>"
)
_ATTRIBUTE = re.compile(r"([A-Za-z_][\w.:-]*)\s*=\s*(?:\"([^\"]*)\"|'([^']*)')")
_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_ENTITY = re.compile(r"&(?:(lt|gt|amp|quot|apos)|#([0-9]{1,7})|#x([0-9A-Fa-f]{1,6}));")
_NAMED = {"lt": "<", "gt": ">", "amp": "&", "quot": '"', "apos": "'"}


@dataclass(frozen=True)
class Source:
    """A text and the name of the file it came from."""

    text: str
    file: str

    def span(self, start: int, end: int) -> Span:
        """The span of the characters from `start` to `end` (exclusive)."""
        line, column = self._place(start)
        end_line, end_column = self._place(end)
        return Span(self.file, line, column, end_line, end_column)

    def fail(self, code: str, message: str, start: int, end: int, hint: str = "") -> NoReturn:
        """Raises a PursueError at these characters."""
        raise PursueError([error(code, message, self.span(start, end), hint)])

    def _place(self, offset: int) -> Tuple[int, int]:
        before = self.text[:offset]
        return before.count("\n") + 1, offset - (before.rfind("\n") + 1) + 1


@dataclass
class Element:
    """One element: its attributes, its own text (entities resolved), its children and its place in the source."""

    name: str
    attributes: Dict[str, str]
    source: Source
    start: int
    end: int
    text: str = ""
    children: List[Element] = field(default_factory=list)

    def all(self, name: str) -> List[Element]:
        """The children of that name."""
        return [child for child in self.children if child.name == name]

    def one(self, name: str) -> Optional[Element]:
        """The first child of that name, or None."""
        return next(iter(self.all(name)), None)

    def attribute(self, name: str) -> str:
        """The attribute. Raises PursueError where it is missing."""
        if name not in self.attributes:
            self.fail("TGA001", f"<{self.name}> lacks the attribute {name}")
        return self.attributes[name]

    def fail(self, code: str, message: str, hint: str = "") -> NoReturn:
        """Raises a PursueError at this element."""
        self.source.fail(code, message, self.start, self.end, hint)


def read_markup(text: str, file: str) -> Element:
    """The outermost element of the text. Raises PursueError where elements do not nest or there is none."""
    # Comments become blanks, so that places stay what they are.
    source = Source(_COMMENT.sub(lambda match: re.sub(r"[^\n]", " ", match.group()), text), file)
    root = Element("", {}, source, 0, 0)
    open_elements = [root]
    position = 0
    for match in _TAG.finditer(source.text):
        parent = open_elements[-1]
        parent.text += _unescape(source.text[position : match.start()])
        position = match.end()
        if match.group("close"):
            _close(open_elements, match)
            continue
        element = Element(
            match.group("name"), _attributes(match.group("attributes")), source, match.start(), match.end()
        )
        parent.children.append(element)
        if not match.group("empty"):
            open_elements.append(element)
    if len(open_elements) > 1:
        open_elements[-1].fail("TGA001", f"<{open_elements[-1].name}> is never closed")
    if not root.children:
        source.fail("TGA001", "there is no element in this file", 0, 0, "an UPPAAL network (<nta>…</nta>) was expected")
    return root.children[0]


def _close(open_elements: List[Element], match: Match[str]) -> None:
    element = open_elements[-1]
    if element.name != match.group("name"):
        expected = f"</{element.name}>" if element.name else "no closing tag"
        message = f"</{match.group('name')}> stands where {expected} was expected"
        element.source.fail("TGA001", message, match.start(), match.end())
    element.end = match.end()
    open_elements.pop()


def _attributes(text: str) -> Dict[str, str]:
    return {name: _unescape(double or single) for name, double, single in _ATTRIBUTE.findall(text)}


def _unescape(text: str) -> str:
    def character(match: Match[str]) -> str:
        name, decimal, hexadecimal = match.groups()
        if name:
            return _NAMED[name]
        number = int(decimal) if decimal else int(hexadecimal, 16)
        return chr(number) if number <= 0x10FFFF else match.group()

    return _ENTITY.sub(character, text)
