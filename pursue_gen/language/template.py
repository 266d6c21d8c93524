"""How statements are written: a template, from which their grammar, their texts and what they say follow.

`connect {a:POI=a} and {b:POI=b} distance {distance:number=3} [one_way]` has words, holes, and in brackets what may be
left out. A hole is {fields:filling=example}: the fields that have its value, what fills it (left out: what the field is
called), and an example; where that is missing, the brackets around it are missing in examples. Brackets without a hole
are a flag: a field that is called like the last word in them.
"""

from __future__ import annotations

import re
from typing import Any, Callable, Dict, Iterable, Iterator, Mapping, NamedTuple, Sequence, Tuple

from pursue_gen.language.conditions import Condition, Who, condition_text, read_condition, read_some, some_text
from pursue_gen.language.refs import Ref
from pursue_gen.language.times import window_text, written_time
from pursue_gen.language.tokens import bare
from pursue_gen.language.tree_reader import TreeReader

_PIECE = re.compile(r"\[([^\]]+)\]|([^\[]+)")
_TOKEN = re.compile(r"\{([\w,]+)(?::([^}=]+))?(?:=([^}]*))?\}|(\w+)|[:,]")
_WORDS = re.compile(r"\w+|[:,]")
_TO_FILL_IN = re.compile(r'[\d.]+|(?<=")[^"]+')


class Filling(NamedTuple):
    """What may stand in a hole."""

    rule: str  # in the grammar
    read: Callable[[TreeReader, Any], Any]  # its value from its tree; of several fields a tuple
    text: Callable[..., str] = str  # the values as they are written
    of: str = ""  # the kind of thing that names there stand for
    behind: Tuple[str, ...] = ()  # the words before such names; (): the last one before the hole
    rules: str = ""  # those that its rule stands on
    is_condition: bool = False  # or may be one


class Hole(NamedTuple):
    """A hole, or a flag."""

    fields: Tuple[str, ...]
    filling: Filling
    example: str
    behind: str  # the last word before it; "": none
    begins: str  # the token with which it begins, its word included

    @property
    def to_fill_in(self) -> str:
        """It in the words of a `Form`."""
        return f"{{{self.filling.of}}}" if self.filling.of else _TO_FILL_IN.sub(r"{=\g<0>}", self.example)


class Piece(NamedTuple):
    """A stretch of a template. `text`: with {} for each hole; `optional`: it stands in brackets."""

    text: str
    holes: Tuple[Hole, ...]
    optional: bool
    grammar: str


def name_text(ref: Any) -> str:
    """A name as it is used."""
    return str(getattr(ref, "name", ref))


def names_text(refs: Iterable[Ref]) -> str:
    """Names as they are listed."""
    return ", ".join(map(name_text, refs))


def _event_or_condition(reader: TreeReader, tree: Any) -> Any:
    return reader.ref(tree) if tree.data == "ref" else read_condition(reader, tree)


def event_or_condition_text(what: Any) -> str:
    """The name of an event, or a condition as it is written."""
    return what.name if isinstance(what, Ref) else condition_text(what)


FILLINGS: Mapping[str, Filling] = {
    **{
        kind: Filling("ref", TreeReader.ref, name_text, kind)
        for kind in ("agent", "event", "state", "thing", "door", "lift", "POI")
    },
    '"agent"': Filling("(ref | NAME)", TreeReader.agent_ref, lambda ref: f'"{ref.name}"', "agent"),
    "agents": Filling("refs", TreeReader.refs, names_text, "agent"),
    "POIs": Filling("refs", TreeReader.refs, names_text, "POI"),
    "doors": Filling("refs", TreeReader.refs, names_text, "door"),
    "things": Filling("refs", TreeReader.refs, names_text, "thing"),
    "events": Filling("refs", TreeReader.refs, names_text, "event"),
    "event or condition": Filling(
        "(ref | condition)", _event_or_condition, event_or_condition_text, "event", is_condition=True
    ),
    "name": Filling("NAME", lambda _, token: bare(token), '"{}"'.format),
    "number": Filling("NUMBER", TreeReader.number),
    "distance": Filling("NUMBER", TreeReader.distance, written_time),
    "metres": Filling("NUMBER", TreeReader.metres, written_time),
    "time": Filling("NUMBER", TreeReader.time, written_time),
    "count": Filling("NUMBER", TreeReader.count),
    "window": Filling("window", TreeReader.window, window_text),
    "some": Filling("some", read_some, some_text, "agent", ("of",)),
    "condition": Filling("condition", read_condition, condition_text, is_condition=True),
    "bracketed": Filling("_plain", read_condition, lambda one: f"({condition_text(one)})", is_condition=True),
    "bool": Filling("(TRUE | FALSE)", lambda _, token: token.type == "TRUE", lambda value: str(value).lower()),
    "is": Filling(
        "(IS_TRUE | IS_FALSE)", lambda _, token: token.type == "IS_TRUE", lambda value: f"is_{str(value).lower()}"
    ),
}  # fmt: skip
"""What may stand in holes; a name in use where it is a kind of thing."""


class Template:
    """A template. `own`: what fills holes in it alone."""

    def __init__(self, text: str, **own: Filling) -> None:
        fillings, word = {**FILLINGS, **own}, ""
        pieces = []
        for optional, needed in _PIECE.findall(text.replace("] [", "][")):
            terms, holes, before = [], [], ""
            for token in _TOKEN.finditer(optional or needed):
                fields, kind, example, found = token.groups()
                if fields:
                    filling = fillings[kind or fields]
                    begins = before.upper() or filling.rule
                    holes.append(Hole(tuple(fields.split(",")), filling, example or "", word, begins))
                terms.append(holes[-1].filling.rule if fields else f'"{token[0]}"')
                word, before = found or word, found or ""
            if optional and not holes:
                first = optional.split()[0].upper()
                terms[0] = first
                holes.append(Hole((word,), Filling(first, lambda *_: True), word, "", first))
            grammar = " ".join(terms)
            plain = re.sub(r"\{[^}]*\}", "{}", optional or needed).strip()
            pieces.append(Piece(plain, tuple(holes), bool(optional), f"[{grammar}]" if optional else grammar))
        self.pieces = tuple(pieces)
        self.holes = tuple(hole for piece in pieces for hole in piece.holes)
        self.rules = [filling.rules for filling in own.values()]

    def grammar(self, rule: str) -> str:
        """Its rule in Lark's notation, and those that it stands on: a tree has a child for each hole and each flag.

        What may be left out doubles the ways in which a rule can be read, so each further four pieces have their own.
        """
        terms = [piece.grammar for piece in self.pieces]
        more = {f"_{rule}_{number}": terms[number : number + 4] for number in range(4, len(terms), 4)}
        rules = {rule: [*terms[:4], *more], **more}.items()
        return "\n".join((*(f"{name}: {' '.join(parts)}" for name, parts in rules), *self.rules))

    @property
    def example(self) -> str:
        """What it looks like."""
        return self._shown(lambda hole: hole.example)

    @property
    def to_fill_in(self) -> str:
        """The same with holes, as the words of a `Form`."""
        return self._shown(lambda hole: hole.to_fill_in)

    def _shown(self, text: Callable[[Hole], str]) -> str:
        pieces = (piece for piece in self.pieces if not piece.optional or all(hole.example for hole in piece.holes))
        return _joined(piece.text.format(*map(text, piece.holes)) for piece in pieces)

    @property
    def words(self) -> Tuple[str, ...]:
        """Its words and signs, in order; "" where it begins with a hole."""
        found = [word for piece in self.pieces for word in _WORDS.findall(piece.text)]
        return (*[""] * self.pieces[0].text.startswith("{"), *found)

    @property
    def begins(self) -> Tuple[str, ...]:
        """The tokens with which its parts begin."""
        return tuple(hole.begins for hole in self.holes)

    def used(self, first: str = "") -> Dict[str, str]:
        """The kind of thing that names stand for, by the last word of the language before them, `first` included."""
        naming = [hole for hole in self.holes if hole.filling.of]
        return {word: hole.filling.of for hole in naming for word in hole.filling.behind or (hole.behind or first,)}

    @property
    def conditions_behind(self) -> Tuple[str, ...]:
        """The words behind which a condition stands, or may stand."""
        return tuple(hole.behind for hole in self.holes if hole.filling.is_condition)

    def read(self, reader: TreeReader, children: Sequence[Any]) -> Dict[str, Any]:
        """The fields that a tree has values for."""
        found: Dict[str, Any] = {}
        for hole, child in zip(self.holes, children):
            if child is not None:
                value = hole.filling.read(reader, child)
                found.update(zip(hole.fields, value if len(hole.fields) > 1 else (value,)))
        return found

    def written(self, part: Any, **instead: str) -> str:
        """The text of what has these fields. `instead`: texts for single fields."""

        def text(hole: Hole) -> str:
            return instead.get(hole.fields[0]) or hole.filling.text(*(getattr(part, name) for name in hole.fields))

        def says(hole: Hole) -> bool:
            return any(getattr(part, name) != getattr(type(part), name, None) for name in hole.fields)

        pieces = (piece for piece in self.pieces if not piece.optional or says(piece.holes[-1]))
        return _joined(piece.text.format(*map(text, piece.holes)) for piece in pieces)

    def names(self, part: Any) -> Iterator[Tuple[str, Ref]]:
        """Each name in the fields, outside of conditions, behind the kind of thing that it stands for."""
        for hole in self.holes:
            for value in (getattr(part, name) for name in hole.fields if hole.filling.of):
                some = value if isinstance(value, tuple) else (value,)
                refs = (ref for one in some for ref in (one.named if isinstance(one, Who) else (one,)))
                yield from ((hole.filling.of, ref) for ref in refs if isinstance(ref, Ref))

    def conditions(self, part: Any) -> Tuple[Condition, ...]:
        """The conditions in the fields."""
        found = (getattr(part, hole.fields[0]) for hole in self.holes if hole.filling.is_condition)
        return tuple(value for value in found if value is not None and not isinstance(value, Ref))


def _joined(texts: Iterable[str]) -> str:
    """The texts with blanks between them, but before signs."""
    return "".join(text if text[0] in ":," else f" {text}" for text in texts).lstrip()
