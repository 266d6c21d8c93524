"""Statements that are a word and one of several kinds behind it: objectives and assumptions, which have a colon between
them, and batteries. And `optional 1 objective: …`: an objective that is given up where it cannot be promised with the
rest."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, ClassVar, Dict, Mapping, Sequence, Tuple, Type

from pursue_gen.diagnostics import error
from pursue_gen.language.assumptions import KINDS as ASSUMPTIONS
from pursue_gen.language.numbers import Number
from pursue_gen.language.objectives import KINDS as OBJECTIVES
from pursue_gen.language.objectives import Endurance, Reach, StatedObjective
from pursue_gen.language.statements.base import StatementKind
from pursue_gen.language.statements.battery import Battery
from pursue_gen.language.template import Filling, Template
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word


class Headed(StatementKind):
    """A statement that is a word, a colon, and one of several kinds of what stands behind it."""

    head: ClassVar[Word]
    """The word."""
    colon: ClassVar[str] = ":"
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


_BEHIND = {kind.rule(): kind for kind in (Objective, ReachObjective)}
"""What stands behind the number, by its rule in the grammar."""


def _objectives(reader: TreeReader, tree: Any) -> Tuple[StatedObjective, ...]:
    found: Any = _BEHIND[tree.data].read(reader, *tree.children, span=reader.span(tree))
    return found if isinstance(found, tuple) else (found,)


class Optional(StatementKind):
    """An objective with a number: 1 for what is to be kept longest."""

    own_words = (
        Word(
            "optional",
            "An objective that is given up where it cannot be promised with the rest; 1 is kept longest.",
            True,
        ),
    )
    template = Template(
        "optional {rank:count=1} {objectives:objectives=reach_objective: do e1}",
        objectives=Filling(f"({' | '.join(_BEHIND)})", _objectives),
    )
    note = "or: optional 1 objective: avoid e; 1 is kept longest"
    forms = (
        Form("achieve something if it can be promised", "optional {=1} reach_objective: do {event}"),
        Form("what always holds if it can be promised", "optional {=1} objective: avoid {event}"),
    )
    numbers = {
        "optional": lambda *_: (
            "The first one to be given up is the one with the greatest number; those with one number go together."
        ),
    }
    among = "OBJECTIVE"

    @classmethod
    def read(cls, reader: TreeReader, *children: Any, **at: Any) -> Tuple[StatedObjective, ...]:
        rank, objectives = cls.template.read(reader, children).values()
        if not rank:
            hint = "1 is kept longest, then 2, and so on; without optional it has to be met in any case"
            message = "the number behind optional is 0; expected 1 or more"
            reader.findings.append(error("PML300", message, reader.at(children[0]), hint))
        return tuple(replace(objective, optional=rank or 1, **at) for objective in objectives)
