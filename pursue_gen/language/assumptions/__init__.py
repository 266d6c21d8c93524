"""What a strategy may rely on that agents do at most, at least or never. A module for each kind of assumption."""

from __future__ import annotations

from typing import Mapping, Type

from pursue_gen.language.assumptions.at_most import AtMost
from pursue_gen.language.assumptions.base import AboutOne, Assumption, Departure
from pursue_gen.language.assumptions.every import Every
from pursue_gen.language.assumptions.in_all import InAll
from pursue_gen.language.assumptions.leaves import Leaves
from pursue_gen.language.assumptions.most_open import MostOpen
from pursue_gen.language.assumptions.never_at import NeverAt
from pursue_gen.language.assumptions.never_holds import NeverHolds
from pursue_gen.language.assumptions.not_before import NotBefore
from pursue_gen.language.assumptions.reaches import Reaches
from pursue_gen.language.assumptions.stays import Stays
from pursue_gen.language.assumptions.there_by import ThereBy
from pursue_gen.language.assumptions.waits import Waits

__all__ = [
    "AboutOne", "Assumption", "AtMost", "Departure", "Every", "InAll", "Leaves", "MostOpen", "NeverAt", "NeverHolds",
    "NotBefore", "Reaches", "Stays", "ThereBy", "Waits",
]  # fmt: skip
"""Parts of scenarios: `language.scenario` hands them on."""

KINDS: Mapping[str, Type[Assumption]] = {
    "at_most": AtMost, "not_before": NotBefore, "waits": Waits, "leaves": Leaves, "stays": Stays,
    "reaches": Reaches, "there_by": ThereBy, "never_at": NeverAt, "never_holds": NeverHolds, "in_all": InAll,
    "every_so_often": Every,
}  # fmt: skip
"""The kinds of assumptions, by their rules in the grammar; `MostOpen` stands behind an objective."""

NUMBERED: Mapping[str, Type[Assumption]] = {word.upper(): kind for kind in KINDS.values() for word in kind.numbers}
"""A kind of assumption with a number, by the token of the word before it."""
