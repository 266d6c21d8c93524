"""Offsets and an editor's positions: both ways, in every encoding."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.diagnostics import Span
from pursue_gen.language.tokens import plain
from pursue_gen.tools.lsp.open_document import OpenDocument

TEXTS = st.text(alphabet="ab \t\né😀\U0001d538\u2028\x0c\x85", max_size=60)
ENCODINGS = st.sampled_from(["utf-16", "utf-8", "utf-32"])


@given(TEXTS, ENCODINGS, st.data())
def test_an_offset_comes_back(text: str, encoding: str, data: st.DataObject) -> None:
    offset = data.draw(st.integers(0, len(text)))
    document = OpenDocument(text, encoding=encoding)
    line, column = document.position(offset)
    assert document.offset(line, column) == offset
    before = text[:offset].split("\n")
    assert line == len(before) - 1
    codec = {"utf-16": "utf-16-le", "utf-8": "utf-8", "utf-32": "utf-32-le"}[encoding]
    width = {"utf-16": 2, "utf-8": 1, "utf-32": 4}[encoding]
    assert column * width == len(before[-1].encode(codec))


@given(TEXTS, ENCODINGS, st.integers(-3, 100), st.integers(-3, 100))
def test_every_position_is_somewhere_in_the_text(text: str, encoding: str, line: int, column: int) -> None:
    offset = OpenDocument(text, encoding=encoding).offset(line, column)
    assert 0 <= offset <= len(text)


def test_a_column_within_a_character_means_its_start() -> None:
    document = OpenDocument("a😀b")
    assert [document.offset(0, column) for column in range(6)] == [0, 1, 1, 2, 3, 3]


def test_a_column_behind_a_line_means_its_end() -> None:
    assert OpenDocument("ab\ncd").offset(0, 99) == 2
    assert OpenDocument("äb\ncd").offset(0, 99) == 2


@pytest.mark.parametrize("text", ["a\r\nb\rc\nd", "a\nb\nc\nd"])
def test_all_line_ends_are_one(text: str) -> None:
    assert plain(text) == "a\nb\nc\nd"


def test_spans_become_offsets() -> None:
    document = OpenDocument('poi "a"\npoi "😀b"\n')
    assert document.lines.of_span(Span("x", 2, 5, 2, 9)) == (12, 16)
    assert document.lines.of_span(Span("x", 99, 1, 99, 9)) == (17, 17)  # what there is not is at the end
