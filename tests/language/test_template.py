"""What follows from the template of a statement."""

from __future__ import annotations

from dataclasses import dataclass, fields, is_dataclass
from typing import Optional, Tuple, Type

import pytest
from lark import Lark

from pursue_gen.diagnostics import NOWHERE, Span
from pursue_gen.language.assumptions import KINDS as ASSUMPTIONS
from pursue_gen.language.conditions import Holds
from pursue_gen.language.kinds import STATEMENTS
from pursue_gen.language.objectives import KINDS as OBJECTIVES
from pursue_gen.language.objectives import Always, Avoid, Patrol, Reach
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.base import Written
from pursue_gen.language.statements.connect import Connection
from pursue_gen.language.template import Template
from pursue_gen.language.tree_reader import TreeReader

GREET = Template('greet {name="x"} [twice] [from {a,b:window=1 to 2} units]: {who:agent=bot} [in {place:POI}]')
GRAMMAR = f"""{GREET.grammar("greet")}
ref: WORD
window: NUMBER [TO NUMBER]
TWICE: "twice"
TO: "to"
NAME: /"[^"]*"/
WORD: /[a-z]\\w*/
NUMBER: /[0-9]+/
%ignore " "
"""


@dataclass(frozen=True)
class Greet(Written):
    name: str
    who: Ref
    twice: bool = False
    a: Optional[int] = None
    b: Optional[int] = None
    place: Optional[Ref] = None
    span: Span = NOWHERE
    template = GREET


TEXTS = (
    'greet "x": bot', 'greet "x" twice: bot', 'greet "y" from 3 units: bot', 'greet "x" from 1 to 2 units: bot in hall',
    'greet "x" twice from 1 to 2 units: bot in hall',
)  # fmt: skip


@pytest.mark.parametrize("text", TEXTS)
def test_a_text_is_read_and_written_again(text: str) -> None:
    tree = Lark(GRAMMAR, parser="lalr", start="greet", propagate_positions=True).parse(text)
    found = Greet(**GREET.read(TreeReader("x.pur", {}), tree.children))
    assert found.text == text
    assert found.twice == ("twice" in text) and (found.place is None) == ("hall" not in text)
    named = [("agent", "bot")] + [("POI", "hall")] * ("hall" in text)
    assert [(kind, ref.name) for kind, ref in found.names()] == named


def test_what_is_left_out_without_an_example_is_not_shown() -> None:
    assert GREET.example == 'greet "x" twice from 1 to 2 units: bot'
    assert GREET.to_fill_in == 'greet "{=x}" twice from {=1} to {=2} units: {agent}'


def test_names_are_known_by_the_word_before_them() -> None:
    assert GREET.used() == {"units": "agent", "in": "POI"}
    assert Template("{who:agent} waves").used("assume") == {"assume": "agent"}
    assert GREET.begins == ("GREET", "TWICE", "FROM", "ref", "IN")


def test_one_field_can_be_written_otherwise() -> None:
    assert GREET.written(Greet("x", Ref("bot")), who="…") == 'greet "x": …'


def test_conditions_are_found_where_they_stand() -> None:
    way = Connection("a", "b", 3, only_if=Holds(Ref("open"), True))
    assert way.conditions == (way.only_if,) and Connection("a", "b", 3).conditions == ()
    assert Avoid(Ref("e")).conditions == () and Always(Holds(Ref("open"), True)).text == "always open is_true"


_ALL: Tuple[Type[Written], ...] = (
    *(kind for kind in STATEMENTS.values() if is_dataclass(kind)), *OBJECTIVES.values(), Reach, *ASSUMPTIONS.values(),
)  # fmt: skip
_ELSEWHERE = {"span", "ends", "optional", "least", "number", "building"}
"""Fields that say where something stands, or what another statement or solving says."""


@pytest.mark.parametrize("kind", _ALL, ids=lambda kind: kind.__name__)
def test_each_field_is_in_the_template(kind: Type[Written]) -> None:
    holes = {name for hole in kind.template.holes for name in hole.fields}
    own = {field.name for field in fields(kind)}  # type: ignore[arg-type] # each is a dataclass
    assert own - holes <= _ELSEWHERE | ({"holds"} if kind is Always else set())
    assert holes <= own and (kind is not Patrol or "order" in holes)
