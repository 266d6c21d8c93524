"""Short names of objectives, which tell one from the others: for rows of a timeline, and for the page of the UI."""

from __future__ import annotations

from collections import Counter
from typing import Dict, Sequence

from pursue_gen.language.scenario import Scenario
from pursue_gen.tga.objectives import stated

_MOST = 3  # names of one statement that are listed


def promise_names(scenario: Scenario) -> Dict[str, str]:
    """For each automaton that watches an objective: what is due, as in `look` or `visits: office`; its text where that
    says nothing, or is the same with another one. Those with one text are counted."""
    found = {name: each.words.lane or each.words.due or each.text for name, each in stated(scenario).items()}
    for better in ({name: each.text for name, each in stated(scenario).items()}, None):
        shared = {short for short, many in Counter(found.values()).items() if many > 1}
        again: Counter[str] = Counter()
        for name, short in found.items():
            if short in shared:
                again[short] += 1
                found[name] = f"{short} ({again[short]})" if better is None else better[name]
    return found


def short_name(names: Sequence[str]) -> str:
    """One name for the objectives of a statement."""
    known = list(dict.fromkeys(names))
    return ", ".join([*known[:_MOST], *(["…"] if known[_MOST:] else [])])
