"""YAML that a person writes: a tree with places, or one error with a place, whatever stands in it."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError, Span
from pursue_gen.files import compose_yaml, span_of


@given(st.text(max_size=40) | st.text("{}[]:,-&*!|>'\"#%@ \n\tab", max_size=40))
def test_any_text_is_a_tree_or_an_error_with_a_place_in_it(text: str) -> None:
    try:
        root = compose_yaml(text, "some.yaml", "TRN011", "write it so")
    except PursueError as problem:
        (found,) = problem.diagnostics
        assert problem.exit_status == 2 and found.code == "TRN011" and found.hint == "write it so"
        refused = r"this is not YAML: ..|(?:anchors|tags) .*are not read|more than|expected one document"
        assert re.match(refused, found.message)
        assert found.span is not None and 1 <= found.span.line <= len(text.splitlines()) + 1
        return
    span = span_of(root, "some.yaml")
    assert (span.line, span.column) <= (span.end_line, span.end_column)


def test_nodes_know_their_places() -> None:
    root = compose_yaml("a: 1\nbc: [x, yz]\n", "some.yaml", "TRN011", "")
    key, value = root.value[1]
    assert span_of(key, "some.yaml") == Span("some.yaml", 2, 1, 2, 3)
    assert span_of(value.value[1], "some.yaml") == Span("some.yaml", 2, 9, 2, 11)
    assert span_of(None, "some.yaml").line == 1


@pytest.mark.parametrize("text", ["[" * 5000, "{" * 5000])
def test_brackets_without_end_are_an_error(text: str) -> None:
    with pytest.raises(PursueError, match="more than 16 levels are nested"):
        compose_yaml(text, "some.yaml", "TRN011", "")
