"""What every kind of statement has."""

from __future__ import annotations

from typing import Any, ClassVar, Iterable, Iterator, Mapping, Optional, Tuple

from pursue_gen.language.conditions import Condition, condition_text
from pursue_gen.language.refs import Ref
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word


class StatementKind:
    """A kind of statement. What it declares is a frozen dataclass of this class, where it declares one thing."""

    listed_in: ClassVar[str] = ""
    """The field of a scenario that has what it declares."""
    words: ClassVar[Tuple[Word, ...]]
    """The word that begins it, and others that no kind before it has."""
    grammar: ClassVar[str]
    """Its rules in Lark's notation; the first one is its own."""
    form: ClassVar[str]
    """What it looks like, for messages."""
    forms: ClassVar[Tuple[Form, ...]] = ()
    """Ways to write it, to fill in."""
    declares: ClassVar[str] = ""
    """The kind of thing that it declares, whose name in quotes is its second word; "": none."""
    shortest: ClassVar[str] = ""
    """How it declares a `{name}` in as few words as possible, an agent at a `{place}`; "": nothing is short enough."""
    refers_to: ClassVar[Mapping[str, str]] = {}
    """The kind of thing that the names in a field stand for, by field."""
    used: ClassVar[Mapping[str, str]] = {}
    """The kind of thing that names stand for, by the last word of the language before them."""
    conditions_behind: ClassVar[Tuple[str, ...]] = ()
    """The words behind which a condition begins."""
    second: ClassVar[str] = ""
    """The word behind the agent that it is about, where its first word may be a name; the agent's may have quotes."""
    among: ClassVar[str] = ""
    """The token of the statements among which it stands; "": it has a section of its own."""
    parts: ClassVar[Tuple[str, ...]] = ()
    """The tokens that begin its parts, in their order, where each part can be written alone (`language.rewriting`)."""

    @classmethod
    def token(cls) -> str:
        """The token of the word that begins it."""
        return cls.words[0].token

    @classmethod
    def rule(cls) -> str:
        """The name of its rule in the grammar, which its trees have."""
        return cls.grammar.split(":", 1)[0].strip()

    @classmethod
    def has_label(cls) -> bool:
        """True if what it declares may have a label."""
        return "[LABEL NAME]" in cls.grammar

    @classmethod
    def read(cls, reader: TreeReader, *children: Any, **at: Any) -> Any:
        """What it declares, one part or several, from its tree. `at`: `span`, its place in the text."""
        raise NotImplementedError

    def names(self) -> Iterator[Tuple[str, Ref]]:
        """Each name that it uses outside its conditions, behind the kind of thing that it stands for."""
        for field, kind in self.refers_to.items():
            value = getattr(self, field)
            yield from ((kind, ref) for ref in (value if isinstance(value, tuple) else (value,)) if ref is not None)

    @property
    def text(self) -> str:
        """The statement, as its author may write it."""
        raise NotImplementedError


# Pieces of texts ------------------------------------------------------------------------------------------------------


def joined(*parts: object) -> str:
    """The parts with blanks between them, without those that are not there."""
    return " ".join(str(part) for part in parts if part not in (None, False, ""))


def behind(word: str, value: object) -> str:
    """The value behind a word; "" where there is none."""
    return "" if value in (None, "", ()) else f"{word} {value}"


def names_text(refs: Iterable[Ref]) -> str:
    """Names as they are listed."""
    return ", ".join(ref.name for ref in refs)


def label_text(label: Optional[str]) -> str:
    """What people read, where it is given."""
    return "" if label is None else f'label "{label}"'


def only_if_text(condition: Optional[Condition]) -> str:
    """The condition under which something may begin."""
    return "" if condition is None else f"only_if {condition_text(condition)}"


def window_text(low: object, high: object) -> str:
    """One number or two, between which something ends."""
    return f"{low}" if high is None else f"{low} to {high}"
