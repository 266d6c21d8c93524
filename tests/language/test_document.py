"""A document loses nothing of the text that was read, right or wrong, and an edit changes its own stretch alone."""

from __future__ import annotations

from typing import List

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.language.chunks import COMMENTS
from pursue_gen.language.document import Document, Edit, behind, edited, statement_text, written
from pursue_gen.language.parser import parse, read
from pursue_gen.language.tokens import end_of, start_of

from .texts import STATEMENTS

SOUND = list(STATEMENTS.values())
ODD = (
    "// alone", "/* over\n two lines */", "/* never closed", '"', "(", "optional", "optional 1", "takes", "//[1, 2]",
    "//[0, 0, 0, 0, 0, 0, 1] by the door", "control: A<> won", "distance 3", "é “ \u00a0", "stray ; signs",
)  # fmt: skip
PIECES = st.sampled_from([*SOUND, *ODD])
GAPS = st.sampled_from([" ", "\n", "\n\n", "\t", "\f", "", "  // behind\n", " /* a */ // b\n"])
WRITTEN = st.lists(st.tuples(PIECES, GAPS), max_size=8).map(lambda some: "".join(a + b for a, b in some))
TEXTS = st.one_of(WRITTEN, st.text(alphabet='ab 1"/*\n\t:(),[]é', max_size=60))


@given(TEXTS)
def test_words_comments_and_blanks_are_the_text_that_was_read(text: str) -> None:
    document = Document(text)
    at, rebuilt = 0, ""
    for token in document.tokens:
        gap = text[at : start_of(token)]
        assert not gap.strip(" \t\n\f"), "nothing but blanks is no token"
        rebuilt += gap + str(token)
        at = end_of(token)
    assert rebuilt + text[at:] == text and not text[at:].strip(" \t\n\f")


@given(TEXTS)
def test_every_word_and_comment_belongs_to_one_block(text: str) -> None:
    document = Document(text)
    assert [token for block in document.blocks for token in block] == list(document.tokens)
    starts = [start_of(block[0]) for block in document.blocks]
    assert {statement.start for statement in document.statements} <= set(starts)
    for statement in document.statements:
        around = (*document.comments_in(statement), *document.comments_behind(statement))
        assert all(token.type in (*COMMENTS, "POSE") for token in around)
        assert all(start_of(token) > statement.start for token in around)


@given(TEXTS)
def test_the_parser_reads_the_statements_of_the_document(text: str) -> None:
    document = Document(text)
    trees, errors = document.syntax.trees, document.syntax.findings
    assert len(trees) + len(errors) == len(document.statements)
    assert (read(text, document.file).scenario is None) == bool(errors)


def outside(edit: Edit, before: str, after: str) -> bool:
    """Is everything but the stretch of the edit as it was?"""
    rest = before[edit.end :]
    return after == before[: edit.start] + edit.text + rest


@given(TEXTS, st.data())
def test_an_edit_changes_its_stretch_alone(text: str, data: st.DataObject) -> None:
    document = Document(text)
    edits = [document.inserted(words) for words in ('poi "new"', "connect a and b distance 1", "objective: avoid e")]
    for statement in document.statements:
        token = data.draw(st.sampled_from(statement.tokens))
        edits += [written(token, "other"), behind(token, " more"), document.cut(token, statement.tokens[-1])]
        edits.append(document.deleted(statement))
    for edit in edits:
        assert outside(edit, text, document.changed(edit).text)
    apart: List[Edit] = []
    for edit in sorted(edits, key=lambda one: (one.start, one.end)):
        if not apart or edit.start > apart[-1].end:
            apart.append(edit)
    one_by_one = text
    for edit in reversed(apart):
        one_by_one = edited(one_by_one, [edit])
    assert edited(text, apart) == document.changed(*apart).text == one_by_one


@given(
    st.lists(st.tuples(st.sampled_from(SOUND), st.sampled_from(["\n", " // behind\n", " /* a\nb */\n\n"]))),
    st.data(),
)
def test_comments_and_other_statements_stay_when_one_is_deleted_or_added(
    some: List[List[str]], data: st.DataObject
) -> None:
    document = Document("// head\n\n" + "".join(a + b for a, b in some))
    words = [[str(token) for token in statement.tokens] for statement in document.statements]
    added = document.changed(document.inserted('event "new" duration 3'))
    assert len(added.statements) == len(words) + 1
    assert list(map(str, added.comments)) == list(map(str, document.comments))
    if words:
        number = data.draw(st.integers(0, len(words) - 1))
        if not document.comments_in(document.statements[number]):
            after = document.changed(document.deleted(document.statements[number]))
            assert [[str(token) for token in one.tokens] for one in after.statements] == words[:number] + words[
                number + 1 :
            ]
            assert list(map(str, after.comments)) == list(map(str, document.comments))


def test_edits_that_overlap_are_refused() -> None:
    with pytest.raises(AssertionError, match="overlap"):
        edited("abcdef", [Edit(0, 3, ""), Edit(2, 4, "")])


def test_comments_belong_to_the_statement_on_whose_line_they_begin() -> None:
    text = '// head\npoi /* in */ "a" /* behind,\nfurther */ // still\n// alone\npoi "b"'
    document = Document(text)
    first, second = document.statements
    assert list(map(str, document.comments_in(first))) == ["/* in */"]
    assert list(map(str, document.comments_behind(first))) == ["/* behind,\nfurther */", "// still"]
    assert not document.comments_in(second) and not document.comments_behind(second)
    assert [str(block[0]) for block in document.blocks] == ["// head", "poi", "// alone", "poi"]


def test_a_statement_is_quoted_whole_wherever_it_stands() -> None:
    text = 'poi "a" /* \f \x0b a page */ poi "b"\noptional 1 objective: patrol a, // this one\n  b by bot // again\n'
    (patrol, *_) = parse(text, "x.pur").safety
    assert statement_text(text, patrol.span) == "optional 1 objective: patrol a, b by bot"
