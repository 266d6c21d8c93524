"""Statements that are a word and one of several kinds behind it: objectives and assumptions, which have a colon between
them, and batteries."""

from __future__ import annotations

from typing import Any, ClassVar, Dict, Mapping, Sequence, Tuple, Type

from pursue_gen.language.assumptions import KINDS as ASSUMPTIONS
from pursue_gen.language.numbers import Number
from pursue_gen.language.objectives import KINDS as OBJECTIVES
from pursue_gen.language.objectives import Endurance, Reach
from pursue_gen.language.statements.base import StatementKind
from pursue_gen.language.statements.battery import Battery
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word


class Headed(StatementKind):
    """A statement that is a word, a colon, and one of several kinds of what stands behind it."""

    head: ClassVar[Word]
    """The word."""
    colon = ":"
    """The colon behind it; "": there is none."""
    kinds: ClassVar[Mapping[str, Type[Any]]]
    """These kinds, classes of `Written`, by their rules in the grammar."""

    def __init_subclass__(cls) -> None:
        kinds = cls.kinds.values()
        cls.own_words = (cls.head, *(word for kind in kinds for word in kind.own_words))
        begins = cls.head.text + cls.colon
        cls.forms = tuple(Form(form.title, f"{begins} {form.words}") for kind in kinds for form in kind.forms)

    @classmethod
    def form(cls) -> str:
        return " · ".join(f"{cls.head.text}{cls.colon} {kind.form()}" for kind in cls.kinds.values())

    @classmethod
    def form_behind(cls, words: Sequence[str]) -> str:
        own = words[words.index(cls.head.text) + 1 + len(cls.colon) :]
        kinds = [kind for kind in cls.kinds.values() if kind.template.words[0] in own[:1]]
        kinds = kinds or [kind for kind in cls.kinds.values() if own and not kind.template.words[0]]
        said = [sum(word in kind.template.words for word in own) for kind in kinds]
        fitting = [kind for kind, number in zip(kinds, said) if number == max(said)]
        whole = [f"{cls.head.text}{cls.colon} {kind.form()}" for kind in fitting]
        return " · ".join(whole) or cls.form()

    @classmethod
    def grammar(cls) -> str:
        rules = (kind.template.grammar(rule) for rule, kind in cls.kinds.items())
        colon = f'"{cls.colon}" ' if cls.colon else ""
        return "\n".join((f'{cls.rule()}: "{cls.head.text}" {colon}({" | ".join(cls.kinds)})', *rules))

    @classmethod
    def used(cls) -> Dict[str, str]:
        found = (kind.template.used(cls.head.text) for kind in cls.kinds.values())
        return {word: thing for words in found for word, thing in words.items()}

    @classmethod
    def conditions_behind(cls) -> Tuple[str, ...]:
        return tuple(word for kind in cls.kinds.values() for word in kind.template.conditions_behind)

    @classmethod
    def number_words(cls, word: str, number: Number) -> str:
        return next(filter(None, (kind.number_words(word, number) for kind in cls.kinds.values())), "")

    @classmethod
    def read(cls, reader: TreeReader, *children: Any, **at: Any) -> Any:
        (tree,) = children
        return cls.kinds[tree.data].read(reader, *tree.children, **at)


class Batteries(Headed):
    """How long a robot lasts until it has to charge."""

    listed_in = "batteries"
    kinds = {"endurance": Endurance, "levels": Battery}
    colon = ""
    head = Word(
        "battery",
        "The battery of a robot: how long it lasts, or what it holds and uses, and where it is charged. It never runs "
        "empty.",
        True,
    )
    second = ("lasts", "capacity")


class Assume(Headed):
    """What agents that are not controlled do, or do not do."""

    listed_in = "assumptions"
    kinds = ASSUMPTIONS
    head = Word("assume", "What an agent that is not controlled is assumed to do, or not to do. A mission watches it.")


class Objective(Headed):
    """What always holds."""

    kinds = OBJECTIVES
    head = Word(
        "objective", "What must always hold: an answer in time, an event that never happens, two agents who never meet."
    )


class ReachObjective(Headed):
    """What is reached once."""

    among = "OBJECTIVE"
    kinds = {"reach": Reach}
    head = Word("reach_objective", "What is to be achieved once.")
