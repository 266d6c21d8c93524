"""What every kind of statement has."""

from __future__ import annotations

import re
from typing import Any, Callable, ClassVar, Dict, Iterator, Optional, Sequence, Tuple

from pursue_gen.diagnostics import Diagnostic, Span, error, listed, units
from pursue_gen.language.conditions import Condition, names_in
from pursue_gen.language.numbers import Number, exact
from pursue_gen.language.refs import Ref, twice
from pursue_gen.language.template import Template
from pursue_gen.language.times import like, units_of_time, window_text, written_time
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Numbers, Word

_FIELD = re.compile(r"\{(\w+)\}")


class Written:
    """What is written by a template: a statement, or what stands behind its word and a colon."""

    span: Span
    template: ClassVar[Template]
    """How it is written."""
    note: ClassVar[str] = ""
    """What messages say behind an example of it."""
    own_words: ClassVar[Tuple[Word, ...]] = ()
    """Its words that no kind before it has; of a statement first the one that begins it."""
    forms: ClassVar[Tuple[Form, ...]] = ()
    """Ways to write it, to fill in."""
    numbers: ClassVar[Numbers] = {}
    """What its numbers mean."""

    aside: ClassVar[Tuple[str, ...]] = ()
    """Its fields that do not matter for which game is played, poses and the like."""

    @classmethod
    def form(cls) -> str:
        """What it looks like, for messages."""
        return cls.template.example + (f" ({cls.note})" if cls.note else "")

    @classmethod
    def read(cls, reader: TreeReader, *children: Any, **at: Any) -> Any:
        """What is declared, one part or several, from its tree. `at`: `span`, its place in the text."""
        return cls(**cls.template.read(reader, children), **at)

    @classmethod
    def number_words(cls, word: str, number: Number) -> str:
        """What a number means behind a word; "": nothing is said of that."""
        return cls.numbers[word](units_of_time(number), number) if word in cls.numbers else ""

    @property
    def text(self) -> str:
        """It as its author may write it."""
        return self.template.written(self)

    def told(self, form: str) -> str:
        """A form such as `{agent} leaves {place} within {time}` with its fields: names as people read them, times."""
        return _FIELD.sub(lambda field: _told(getattr(self, field[1])), form)

    def names(self) -> Iterator[Tuple[str, Ref]]:
        """Each name that it uses outside its conditions, behind the kind of thing that it stands for."""
        return self.template.names(self)

    @property
    def conditions(self) -> Tuple[Condition, ...]:
        """The conditions that it names."""
        return self.template.conditions(self)

    def check(self) -> Iterator[Diagnostic]:
        """What is wrong with it, whatever else stands in the scenario."""
        return iter(())

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        """What it says of a thing of a kind with this name, as in `must never happen`. `shown`: how to show words."""
        return iter(())

    def speaks_of(self, kind: str, name: str) -> bool:
        """True where a condition of it names a thing of a kind."""
        return any((kind, name) == (k, ref.name) for one in self.conditions for k, ref in names_in(one))


class StatementKind(Written):
    """A kind of statement. What it declares is a frozen dataclass of this class, where it declares one thing."""

    listed_in: ClassVar[str] = ""
    """The field of a scenario that has what it declares."""
    declares: ClassVar[str] = ""
    """The kind of thing that it declares, whose name in quotes is its second word; "": none."""
    described: ClassVar[str] = ""
    """What that is, in words, with fields of what it declares, as in `a state, {0.first_words} at the start`."""
    shortest: ClassVar[str] = ""
    """How it declares a `{name}` in as few words as possible, an agent at a `{place}`; "": nothing is short enough."""
    second: ClassVar[Tuple[str, ...]] = ()
    """The words that may stand behind the agent that it is about, where its first word may be a name; the agent's may
    have quotes."""
    among: ClassVar[str] = ""
    """The token of the statements among which it stands; "": it has a section of its own."""
    parts: ClassVar[Tuple[str, ...]] = ()
    """The tokens that begin its parts, in their order, where each part can be written alone (`language.rewriting`)."""

    labelled: ClassVar[bool] = False
    """What it declares may have a label: the second child of its trees."""
    symbol: ClassVar[str] = "Key"
    """The kind of symbol that editors show for it, as the language server protocol calls it."""

    @property
    def details(self) -> Iterator[str]:
        """What it says first of what it declares, before all that `about` says of it."""
        return iter(())

    @classmethod
    def token(cls) -> str:
        """The token of the word that begins it."""
        return cls.own_words[0].token

    @classmethod
    def rule(cls) -> str:
        """The name of its rule in the grammar, which its trees have."""
        return cls.__name__.lower()

    @classmethod
    def form_behind(cls, words: Sequence[str]) -> str:
        """What it looks like, for a message on a statement that is right as far as these words of it."""
        return cls.form()

    @classmethod
    def grammar(cls) -> str:
        """Its rules in Lark's notation."""
        return cls.template.grammar(cls.rule())

    @classmethod
    def used(cls) -> Dict[str, str]:
        """The kind of thing that names stand for, by the last word of the language before them."""
        return cls.template.used()

    @classmethod
    def conditions_behind(cls) -> Tuple[str, ...]:
        """The words behind which a condition begins."""
        return cls.template.conditions_behind

    @classmethod
    def read(cls, reader: TreeReader, *children: Any, **at: Any) -> Any:
        return super().read(reader, *children, span=reader.at(children[0]) if cls.declares else at["span"])


class Labelled(StatementKind):
    """A kind of statement that declares something with a name and, if it has one, a label, which people read."""

    name: str
    label: Optional[str]
    labelled = True

    @property
    def shown(self) -> str:
        """What people read."""
        return self.label or self.name


class ForSome(StatementKind):
    """A kind of statement on a part of the building: for the agents of `only_for` alone, where it has any, and for none
    of `not_for`.
    """

    only_for: Tuple[Ref, ...]
    not_for: Tuple[Ref, ...]
    for_whom: ClassVar[str] = "[for {only_for:agents}] [except {not_for:agents}]"
    """The pieces of a template that say it."""

    def admits(self, agent: str) -> bool:
        """True where it is for the agent of this name."""
        within = not self.only_for or any(ref.name == agent for ref in self.only_for)
        return within and all(ref.name != agent for ref in self.not_for)

    @property
    def what(self) -> str:
        """What this is, in words."""
        raise NotImplementedError

    @property
    def whom_words(self) -> str:
        """For whom it is, as in `only for Porter 1, not for gerda`; "": for all."""
        said = (("only for", self.only_for), ("not for", self.not_for))
        return ", ".join(f"{words} {listed([ref.shown for ref in refs])}" for words, refs in said if refs)

    @property
    def whom_text(self) -> str:
        """The same as it is written."""
        said = (("for", self.only_for), ("except", self.not_for))
        return " ".join(f"{word} {', '.join(ref.name for ref in refs)}" for word, refs in said if refs)

    def check_whom(self) -> Iterator[Diagnostic]:
        """Agents that are named twice, or that are all left out again."""
        for word, refs in (("for", self.only_for), ("except", self.not_for)):
            for ref in twice(refs):
                yield error("PML164", f"{ref.name} stands twice behind {word}", ref.span, "delete one of the two")
        if self.only_for and not any(self.admits(ref.name) for ref in self.only_for):
            message = f"{self.what} is for nobody: all that are named behind for stand behind except"
            yield error("PML164", message, self.span, "name somebody whom it is for, or delete except and what follows")


def _told(value: object) -> str:
    if isinstance(value, Ref):
        return value.shown
    return value if isinstance(value, str) else units(value)


def check_window(name: str, low: Number, high: Number, word: str, span: Span) -> Iterator[Diagnostic]:
    """An error where nothing lies between the two numbers behind a word."""
    if high <= low:
        message = f"{name} ends later than {written_time(low)} and at {written_time(high)} at the latest"
        message += ": there is no such time"
        later = low if low > high else like(exact(high + 1), high)
        hint = f"write the smaller number first: {word} {window_text(high, later)}"
        yield error("PML200", message, span, hint)
