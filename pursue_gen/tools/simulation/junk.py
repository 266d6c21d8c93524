"""Words on pursue/events that must change nothing."""

from __future__ import annotations

import random
from typing import Optional, Sequence

from pursue_runtime.event_words import parse_word
from pursue_runtime.observer.assumptions import without
from pursue_runtime.observer.mission import Mission

JUNK = ("", "\u2603", "bot1 goes", "_start_", "_ping_", "unknown:nothing@3", "_plan_@1", "@@", ":_failed_", "x" * 3000)
"""Words that mean nothing in any state of a mission that is under way."""


def junk_word(
    draw: random.Random, mission: Mission, published: Sequence[str], now: float, is_returning: bool
) -> Optional[str]:
    """One of JUNK, a command for another state (of those that were `published`), or what cannot happen now; None where
    the one that is drawn may be meant. While the observer `is_returning`, nobody knows what can happen."""
    words = [*JUNK, *(text for text in published if not text.endswith(f"@{mission.seq}"))]
    if not is_returning:
        model, here = mission.model, mission.position(now)
        possible = {*model.possible(here, timed=False), *model.possible(without(here, model.assumptions), timed=False)}
        words += [e.word for a in model.automata for e in a.edges if e.word not in possible]
    text = draw.choice(words)
    word = parse_word(text)
    return None if word is not None and word.seq == mission.seq else text
