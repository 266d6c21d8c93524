"""A second way between two places, for some agents: the first one is no longer for them."""

from __future__ import annotations

from typing import Any

import pytest

from pursue_gen.diagnostics import PursueError
from pursue_gen.language.parser import parse
from pursue_gen.tools.draw.operations import change

TEXT = """poi "a"
poi "b"

connect a and b distance 4 // the corridor

event "e" location b

agent "x" controllable mobile 1 location a can_do e
agent "y" controllable mobile 1 location a
agent "z" controllable mobile 1 location a

reach_objective: do e
"""
FIRST = 2  # the number of the statement of the way


def second(text: str, *agents: str, **more: Any) -> str:
    made = change(text, {"do": "second way", "statement": FIRST, "agents": list(agents), **more})
    parse(made.text, "x.pur")
    return made.text


def test_the_first_way_is_for_all_others() -> None:
    once = second(TEXT, "y", distance="9")
    assert "connect a and b distance 4 except y // the corridor\nconnect a and b distance 9 for y\n" in once
    ways = "except y, z // the corridor\nconnect a and b distance 9 for y\nconnect a and b distance 4 for z\n"
    assert ways in second(once, "z")


def test_a_way_for_some_is_shared_out_among_them_and_keeps_its_direction() -> None:
    given = TEXT.replace("distance 4", "distance 4 one_way for x, y")
    made = second(given, "y", distance="2.5")
    assert "distance 4 one_way for x // the corridor\nconnect a and b distance 2.5 one_way for y\n" in made


@pytest.mark.parametrize(
    ("values", "why"),
    [
        ({"statement": FIRST, "agents": []}, "for nobody"),
        ({"statement": FIRST, "agents": ["nobody"]}, "there is no agent nobody"),
        ({"statement": FIRST, "agents": ["x", "y"]}, "the first way would be for nobody"),
        ({"statement": 0, "agents": ["x"]}, "no way"),
        ({"statement": FIRST, "agents": ["x"], "distance": "far"}, "expected a number"),
    ],
)
def test_what_cannot_be_drawn_is_refused(values: Any, why: str) -> None:
    with pytest.raises(PursueError, match=why):
        change(TEXT.replace("distance 4", "distance 4 for x, y"), {"do": "second way", **values})
