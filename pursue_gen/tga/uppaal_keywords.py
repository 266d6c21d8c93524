"""Names that are words of UPPAAL's models: they get another name in its files, and their own when plans are read.

The names of a scenario need not avoid these words: only the files of UPPAAL do.
"""

from __future__ import annotations

import re
from dataclasses import fields, is_dataclass, replace
from typing import Any, Dict, Mapping, TypeVar

from pursue_gen.tga.network import Network

T = TypeVar("T")

WORDS = frozenset(
    "chan clock bool int commit const urgent broadcast init process state guard sync assign system trans deadlock "
    "imply forall exists typedef struct rate before_update after_update meta priority progress scalar select void "
    "default switch case enum string double hybrid dynamic spawn exit branchpoint".split()
)
"""Words of UPPAAL's models that the language lets people use as names."""


def uppaal_names(network: Network) -> Dict[str, str]:
    """For each name of the network that is a word of UPPAAL the name that it gets there; no other name is like it."""
    used = {*network.names, *(location.name for automaton in network.automata for location in automaton.locations)}
    names: Dict[str, str] = {}
    for word in sorted(used & WORDS):
        new = word + "_"
        while new in used:
            new += "_"
        names[word] = new
        used.add(new)
    return names


def renamed(thing: T, names: Mapping[str, str]) -> T:
    """The network, or a part of it, in which these names are other ones; itself where there are none."""
    if not names:
        return thing
    some: Any = thing
    if isinstance(thing, str):
        some = names.get(thing, thing)
    elif isinstance(thing, tuple):
        some = tuple(renamed(part, names) for part in thing)
    elif is_dataclass(thing):
        some = replace(some, **{each.name: renamed(getattr(some, each.name), names) for each in fields(thing)})
    return some  # type: ignore[no-any-return]


def with_own_names(text: str, network: Network) -> str:
    """A plan for the network in which its own names stand in place of those that it has in UPPAAL's files."""
    for word, new in uppaal_names(network).items():
        text = re.sub(rf"\b{new}\b", word, text)
    return text
