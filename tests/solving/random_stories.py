"""Random scenarios of several robots and people."""

from __future__ import annotations

from typing import Tuple

from hypothesis import assume
from hypothesis import strategies as st

from benchmarks.random_stories import random_story
from pursue_gen.diagnostics import PursueError
from pursue_gen.language import parse
from pursue_gen.language.scenario import Scenario


@st.composite
def stories(draw: st.DrawFn) -> Tuple[str, Scenario]:
    """A scenario without errors of syntax, and its text."""
    text = random_story(draw(st.randoms()))
    try:
        return text, parse(text, "story.pur", "story")
    except PursueError:
        assume(False)
        raise
