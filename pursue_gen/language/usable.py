"""Which names the language accepts, and a name to propose in place of one that it does not accept."""

from __future__ import annotations

import keyword
import re
import unicodedata
from itertools import chain, count
from typing import Container

GENERATED = frozenset("observer UI controllerObj controller simulator reachObj obj states".split())
_FORM = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
LONGEST = 60
"""Letters of a name: with what is added to it a name becomes a file name and a topic."""
_PREFIXES = ("going_", "doing_")


def well_formed(name: str) -> bool:
    """True for a name that can stand in a ROS topic, Python and UPPAAL (whose own words get another name there)."""
    return _FORM.fullmatch(name) is not None


def reserved(name: str, words: Container[str]) -> str:
    """Why a well-formed name cannot be used; the empty string: it can. `words`: the language's own."""
    if name in GENERATED:
        return f"{name} is the name of a generated part of every mission"
    if name in words:
        return f"{name} is a word of the language and cannot be a name"
    if keyword.iskeyword(name):
        return f"{name} is a word of Python and cannot be a name"
    if name.endswith("DONE"):
        return f"{name} ends in DONE, as the words for the ends of actions do"
    if name.startswith(_PREFIXES):
        return f"{name} begins as the words for movements (going_…) and actions (doing_…) do"
    return ""


def fitting(name: str) -> str:
    """A well-formed name like this one; it may be reserved, or too long."""
    letters = unicodedata.normalize("NFKD", name)
    plain = "".join(letter for letter in letters if not unicodedata.combining(letter))
    changed = re.sub(r"[^A-Za-z0-9]+", "_", plain).strip("_")
    return changed if well_formed(changed) else ("n_" + changed).rstrip("_")


def proposal(name: str, words: Container[str], taken: Container[str] = ()) -> str:
    """A name like this one that the language accepts and that is not taken; if that is so, the name itself."""
    start = (name if well_formed(name) else fitting(name[:LONGEST]))[:LONGEST]
    while start.startswith(_PREFIXES):
        start = fitting(start[len(_PREFIXES[0]) :])
    numbered = (f"{start[: LONGEST - 6]}{number}" for number in count(1))
    return next(word for word in chain([start], numbered) if not reserved(word, words) and word not in taken)
