"""Objectives have short names, which tell one from the others."""

from __future__ import annotations

from typing import List

from pursue_gen.language.parser import parse
from pursue_gen.vocabulary.promises import promise_names, short_name

HEAD = """
poi "a"
poi "b"
connect a and b distance 2
event "call" location a
event "ring" location b
event "look" location a
agent "guest" location a can_do call
agent "boy" location b can_do ring
agent "bot" controllable mobile 1 location a can_do look
"""


def named(*objectives: str) -> List[str]:
    return list(promise_names(parse(HEAD + "\n".join(objectives) + "\n", "x.pur")).values())


def test_what_is_due_is_the_name() -> None:
    respond, patrol = "objective: if call then look within 9", "objective: patrol a, b every 20 by bot"
    found = named(respond, patrol, "reach_objective: do look")
    assert found == ["if call then look within 9", "visits: a", "visits: b", "do look"]
    assert named("objective: if call then look within 9", "reach_objective: do ring") == ["look", "ring"]


def test_where_that_is_the_same_the_texts_tell_them_apart_and_equal_ones_are_counted() -> None:
    first, second = "if call then look within 9", "if ring then look within 9"
    assert named(f"objective: {first}", f"objective: {second}") == [first, second]
    assert named(*[f"objective: {first}"] * 2) == [f"{first} (1)", f"{first} (2)"]


def test_a_statement_of_many_has_a_name_that_is_not_long() -> None:
    assert short_name(["x"]) == short_name(["x", "x"]) == "x"
    assert short_name(list("abcde")) == "a, b, c, …"
