"""What a name stands for is known wherever the grammar has a name, and it is what the parser takes it for."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, List, Set, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lark import Token

from pursue_gen.language.draft import Draft
from pursue_gen.language.for_each import body_of
from pursue_gen.language.kinds import DECLARED
from pursue_gen.language.lifts import is_said
from pursue_gen.language.names import KINDS
from pursue_gen.language.occurrences import GROUP, VARIABLE, kinds_behind
from pursue_gen.language.parser import parse
from pursue_gen.language.scenario import Ref, Scenario
from pursue_gen.language.syntax import accepts

from .scenarios import SCENARIOS, SMALL


def parsed(scenario: Scenario) -> Set[Tuple[str, int, int, bool]]:
    """(name, line, column, declared?) of every name as the parser has it."""
    found: Set[Tuple[str, int, int, bool]] = set()

    def visit(value: Any) -> None:
        if isinstance(value, Ref):
            found.add((value.name, value.span.line, value.span.column, False))
        elif isinstance(value, tuple):
            for part in value:
                visit(part)
        elif hasattr(value, "__dataclass_fields__"):
            for field in value.__dataclass_fields__:
                visit(getattr(value, field))

    said = tuple(each for each in scenario.safety if is_said(scenario, each))
    scenario = replace(scenario, safety=said)
    declared = scenario.pois, scenario.doors, scenario.lifts, scenario.events, scenario.rules, scenario.states
    for parts in (*declared, scenario.agents, scenario.things):
        for part in parts:  # type: ignore[attr-defined]
            found.add((part.name, part.span.line, part.span.column + 1, True))
    visit(scenario)
    return found


@pytest.mark.parametrize("text", [*(text for text in SCENARIOS.values() if 'group "' not in text), SMALL])
def test_the_names_are_those_that_the_parser_finds(text: str) -> None:
    document = Draft.of(text, "x.pur")
    ours = set()
    for occurrence in document.occurrences:
        line = document.lines.of(occurrence.start)
        column = occurrence.start - document.lines.start(line)
        assert document.text[occurrence.start : occurrence.end] == occurrence.name
        ours.add((occurrence.name, line + 1, column + 1, occurrence.declares))
    found = parsed(parse(document.text, "x.pur"))
    ways = {o for o in ours - found if document.text.split("\n")[o[1] - 1].startswith("connect")}
    assert ours - ways == found
    assert len(ways) == 2 * len(parse(document.text, "x.pur").connections)


@pytest.mark.parametrize("text", [*SCENARIOS.values(), SMALL])
def test_every_use_has_a_declaration_of_its_kind(text: str) -> None:
    document = Draft.of(text, "x.pur")
    assert all(o.name in document.declared[o.kind] for o in document.occurrences if o.kind != VARIABLE)


def token_of(kind: str) -> Token:
    return Token(kind, {"NAME": '"n"', "WORD": "w", "NUMBER": "3"}.get(kind, kind.lower()))


@given(st.data())
def test_what_a_name_stands_for_is_known_wherever_the_grammar_has_one(data: st.DataObject) -> None:
    tokens: List[Token] = []
    for _ in range(data.draw(st.integers(1, 25))):
        expected = accepts(tokens)
        body = body_of(tokens)
        if "WORD" in expected and (body or not tokens):
            of_groups = {VARIABLE, GROUP} if tokens and tokens[-1].type == "OF" else set()
            assert kinds_behind(tokens) and set(kinds_behind(tokens)) <= {*KINDS, *of_groups}
        if tokens and "NAME" in expected:
            declares = len(body) == 1 and body[0].type in {*DECLARED, "TRAVEL", "BATTERY", "GROUP"}
            assert declares or tokens[-1].type == "LABEL"
        choices = sorted(expected - {"$END"})
        if not choices:
            break
        tokens.append(token_of(data.draw(st.sampled_from(choices))))
        assert accepts(tokens), "what is accepted can be gone on with, or ended"
