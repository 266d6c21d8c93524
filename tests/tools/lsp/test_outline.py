"""The outline of a scenario, and what folds."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.language.draft import Draft
from pursue_gen.tools.lsp.outline import folds, symbols

from .scenarios import SCENARIOS, SMALL


def test_every_statement_is_in_the_outline() -> None:
    found = symbols(Draft.of(SMALL + "nonsense: x\n", "x.pur"))
    assert [(s.name, s.detail) for s in found[:5]] == [
        ("a", "poi"), ("b", "poi"), ("connect a and b distance 3", ""), ("work", "event"), ("hand", "event"),
    ]  # fmt: skip
    assert len(found) == SMALL.count("\n")


def test_a_label_is_in_the_outline() -> None:
    found = symbols(Draft.of('poi "door2" label "security door"\npoi "a" label\n', "x.pur"))
    assert [(s.name, s.detail) for s in found] == [("door2", 'poi "security door"'), ("a", "poi")]


@given(st.sampled_from(sorted(SCENARIOS)))
def test_a_symbol_lies_in_its_statement(name: str) -> None:
    for symbol in symbols(Draft.of(SCENARIOS[name], name)):
        assert symbol.start <= symbol.name_start < symbol.name_end <= symbol.end


TEXT = """\
// one
// two

poi "a" // here
poi "b"
/* three
four */
event "e"
rule "r":
    a before b
// five
"""


def test_sections_statements_and_comments_fold() -> None:
    found = [(fold.first, fold.last, fold.comment) for fold in folds(Draft.of(TEXT, "x.pur"))]
    assert found == [(0, 1, True), (3, 4, False), (5, 6, True), (8, 9, False)]


def test_no_fold_is_reported_twice() -> None:
    found = folds(Draft.of('rule "r":\n a before b\n', "x.pur"))
    assert [(fold.first, fold.last) for fold in found] == [(0, 1)]
