"""Whatever stands in an editor, every question gets an answer."""

from __future__ import annotations

import io
import subprocess
import sys
from typing import Tuple

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.language.document import edited
from pursue_gen.language.draft import Draft, definition, rename, same_name
from pursue_gen.tools.lsp.completion import complete
from pursue_gen.tools.lsp.fixes import fixes
from pursue_gen.tools.lsp.fixes_meaning import ordered
from pursue_gen.tools.lsp.hover import hover
from pursue_gen.tools.lsp.open_document import picture
from pursue_gen.tools.lsp.outline import folds, symbols
from pursue_gen.tools.lsp.server import BoundedInput

from .client import PATIENCE
from .scenarios import SCENARIOS, SMALL

GROUPS = """\
for each r in places: event "call" of r location r
group "places": a, b
for each r in places: event "look" of r location r duration 2
agent "cart" controllable mobile 1 location b can_do look of places
for each two x, y in robots: objective: avoid all of robots at b and x at a and y doing look of a
"""
PIECES = SMALL.split() + GROUPS.split() + list('",:()/*\n\t é😀\u200b\x0c\u2028\x00')
PIECES += ["//", "/*", "*/", '"', "control: x", "//[1,2]"]


@st.composite
def texts(draw: st.DrawFn) -> str:
    """A scenario that was hacked to pieces, or pieces that never were one."""
    if draw(st.booleans()):
        return draw(st.sampled_from([" ", ""])).join(draw(st.lists(st.sampled_from(PIECES), max_size=40)))
    text = draw(st.sampled_from([SMALL, SMALL + GROUPS, GROUPS + SMALL, *SCENARIOS.values()]))
    for _ in range(draw(st.integers(1, 5))):
        start = draw(st.integers(0, len(text)))
        end = min(len(text), start + draw(st.integers(0, 30)))
        text = text[:start] + draw(st.sampled_from(["", *PIECES])) + text[end:]
    return text


def asked(text: str, offset: int) -> Draft:
    document = Draft.of(text, "x.pur")
    complete(document, offset)
    hover(document, offset)
    definition(document, offset)
    same_name(document, offset)
    symbols(document)
    folds(document)
    try:
        rename(document, offset, "new_name")
    except PursueError as problem:
        assert problem.diagnostics
    try:
        assert picture(document).startswith("<svg")
    except PursueError as problem:
        assert problem.diagnostics[0].code in ("LSP003", "LSP004")
    return document


@given(texts(), st.data())
def test_no_question_fails(text: str, data: st.DataObject) -> None:
    document = asked(text, data.draw(st.integers(0, len(text))))
    for fix in fixes(document, 0, len(document.text)):
        for edit in fix.edits:
            assert 0 <= edit.start <= edit.end <= len(document.text)
        assert Draft.of(edited(document.text, fix.edits), "x.pur").findings is not None


@given(texts())
@example('poi "a" agent "b" location a\npoi "c" // c\n')
@example('"a" poi "a" /*')
def test_sorting_loses_nothing(text: str) -> None:
    document = Draft.of(text, "x.pur")
    after = Draft.of(edited(document.text, ordered(document)), "x.pur")
    assert sorted(map(str, after.tokens)) == sorted(map(str, document.tokens))


@pytest.mark.parametrize(
    "text",
    [
        'rule "r": ' + "(" * 5000,
        'rule "r": ' + "a before (" * 3000 + "b" + ")" * 3000,
        '"' * 5000,
        "/*" * 5000,
        "poi " * 3000,
        "\ud83d poi \udc00",
        "connect a and b distance " + "9" * 5000,
        "x" * 1_100_000,
        "\n" * 10_000,
    ],
    ids=["brackets", "nested", "quotes", "comments", "words", "surrogates", "digits", "large", "lines"],
)
def test_hostile_texts(text: str) -> None:
    asked(text, len(text) // 2)
    asked(text, len(text))


def large(lines: int) -> Tuple[str, int]:
    """A scenario of about so many lines, and a place in the middle of it."""
    pois = lines // 2
    text = "".join(f'poi "p{n}" // place {n}\n' for n in range(pois))
    text += "".join(f"connect p{n} and p{n + 1} distance 3\n" for n in range(pois - 1))
    text += 'event "e"\nagent "bot" controllable mobile 1 location p0 can_do e\nreach_objective: do e\n'
    return text, text.index(f"p{pois // 2} and")


def test_ten_thousand_lines() -> None:
    text, at = large(10_000)
    document = Draft.of(text, "x.pur")
    assert document.findings == ()
    assert len(complete(document, at)) == 5_000
    assert hover(document, at) is not None
    assert len(symbols(document)) == 10_002
    assert len(rename(document, at, "middle")) == 3


HEADS = {
    "a length of 100 GB": b"Content-Length: 99999999999\r\n\r\n{}",
    "a length in small letters": b"content-length : 99999999999\r\n\r\n{}",
    "a length of many digits": b"Content-Length: " + b"9" * 5000 + b"\r\n\r\n{}",
    "a length below zero": b"Content-Length: -1\r\n\r\n{}",
    "no length": b"Content-Length: \r\n\r\n{}",
    "a length in words": b"Content-Length: many\r\n\r\n{}",
    "a line without end": b"x" * 1_000_000,
}


@pytest.mark.parametrize("name", HEADS)
def test_a_message_whose_head_says_no_good_length_is_refused(name: str) -> None:
    stream = io.BytesIO(HEADS[name])
    bounded = BoundedInput(stream)
    assert bounded.readline() == b"" == bounded.readline()
    assert bounded.refusal is not None and bounded.refusal.code == "LSP005"
    assert "is refused" in bounded.refusal.message
    assert stream.tell() <= len(HEADS[name].partition(b"\n")[0]) + 1, "nothing is read because of it"


def test_who_is_refused_is_told_and_the_server_ends() -> None:
    words = [sys.executable, "-m", "pursue_gen", "lsp"]
    with subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as server:
        assert server.stdin is not None and server.stderr is not None
        server.stdin.write(HEADS["a length of many digits"])
        server.stdin.flush()  # and stays open: it is the head that ends the server
        assert server.wait(PATIENCE) == 2
        told = server.stderr.read().decode()
    assert "LSP005" in told and "is refused" in told and "Traceback" not in told
