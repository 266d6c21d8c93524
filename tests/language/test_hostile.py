"""Whatever is in a file: never a crash, never a hang, always a message that says what to do.

Nothing here measures speed: a watchdog ends what does not come to an end by itself.
"""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any, Callable, Dict, List, Tuple

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import Diagnostic, PursueError, Severity, render
from pursue_gen.language import kinds
from pursue_gen.language.checks import check_reading
from pursue_gen.language.kinds import KEYWORDS
from pursue_gen.language.parser import read, read_text

from .texts import STATEMENTS

ROOT = Path(__file__).resolve().parents[2]
PATIENCE = 300
"""Seconds after which something hangs; all of it takes a few at most, and some more on a busy machine."""


def watched(work: Callable[[], Any]) -> Any:
    """What `work` gives; fails where it does not end."""
    result: List[Any] = []
    failure: List[BaseException] = []

    def run() -> None:
        try:
            result.append(work())
        except BaseException as problem:
            failure.append(problem)

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    thread.join(PATIENCE)
    assert not thread.is_alive(), "it hangs"
    if failure:
        raise failure[0]
    return result[0]


def told(text: str) -> Tuple[Diagnostic, ...]:
    """The findings about a text, each of them fit to be shown."""
    found: Tuple[Diagnostic, ...] = watched(lambda: check_reading(read(text, "some.pur")))
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    for finding in found:
        assert finding.message and finding.hint and finding.code.startswith("PML")
        assert finding.message.isprintable() and finding.hint.isprintable()
        assert len(finding.message) < 400 and len(finding.hint) < 1500
        if finding.span is not None:
            assert 1 <= finding.span.line <= len(lines) and finding.span.column >= 1
    shown = watched(lambda: [render(finding, text) for finding in found[:20]])
    for one in shown:
        assert len(one) < 3000
        assert one.replace("\n", "").replace("\t", "").isprintable()
    return found


def codes(text: str) -> List[str]:
    return [finding.code for finding in told(text)]


NESTED = 'event "e"\nrule "r": ' + "(" * 10_000 + "e" + ")" * 10_000
CHAIN = "".join(f'rule "r{n}": e{n} before e{n + 1}\n' for n in range(6000))
HAND_OVER = "".join(
    f'agent "b{n}" controllable location a can_do e\nagent "c{n}" location a reacts_to e\n' for n in range(6000)
)
LARGE: Dict[str, Tuple[str, List[str]]] = {
    "10,000 brackets": (NESTED, ["PML016"]),
    "brackets without rule": ("(" * 90_000, ["PML011"]),
    "a million statements": ('poi "a"\n' * 1_000_000, ["PML003"]),
    "more words than are read": ("a " * 150_000, ["PML003"]),
    "a long name": ('poi "' + "x" * 900_000 + '"', ["PML101"]),
    "a long word": ("x" * 900_000, ["PML011"]),
    "a long word inside": ("connect a and " + "y" * 900_000, ["PML010"]),
    "a long name that is used": ("connect a and " + "y" * 900_000 + " distance 2", ["PML110"]),
    "a huge number": ("connect a and b distance " + "9" * 900_000, ["PML014"]),
    "a huge number in a pose": ('poi "a" //[' + "1" * 900_000 + "x]", ["PML020"]),
    "a pose of commas": ('poi "a" //[' + "," * 900_000 + "]", ["PML020"]),
    "a comment that never ends": ("/* " + "*" * 900_000, ["PML013"]),
    "comments that never end": ("/* /" * 200_000, ["PML013"]),
    "signs": (";" * 900_000, ["PML011"]),
    "quotes": ('"' * 150_001, ["PML011"]),
    "zeros": ("\0" * 900_000, ["PML015"]),
    "empty lines": ("\n" * 900_000, ["PML130", "PML132", "PML171"]),
    "carriage returns": ("\r" * 900_000, ["PML130", "PML132", "PML171"]),
    "errors": ("poi a\n" * 30_000, ["PML010", "PML018"]),
    "names that nobody declares": ("".join(f"connect p{n} and q{n} distance 3\n" for n in range(5000)), ["PML018"]),
    "similar names": ("".join(f'poi "p{n}"\nconnect p{n} and q{n} distance 3\n' for n in range(5000)), ["PML018"]),
    "a star": ("".join(f'poi "p{n}"\nconnect p0 and p{n} distance 3\n' for n in range(9000)), ["PML145"]),
    "an event again and again": ('agent "b" location a can_do ' + ", ".join(["e"] * 20_000), ["PML018"]),
    "a rule with too many events": ('rule "r": ' + " or ".join(["(a or b)"] * 2) + " or c" * 9000, ["PML016"]),
    "a chain of rules": (CHAIN, ["PML018"]),
    "many who hand over to many": ('poi "a" event "e" collaborative\n' + HAND_OVER, []),
    "names in names": (
        'poi "a" poi "b" connect a and b distance 1 '
        + "".join(f'agent "{"a_" * (n % 29)}x{n // 29}" controllable mobile 1 location a\n' for n in range(6000)),
        [],
    ),
}


@pytest.mark.parametrize("name", LARGE)
def test_large_texts(name: str) -> None:
    text, expected = LARGE[name]
    found = codes(text)
    for code in expected:
        assert code in found
    assert len(found) <= 1001


SIGNS = ["\0", "\x07", "\x0b", "\x0c", "\x1b[31m", "\x7f", "\x85", "\xa0", "\xad", "\u200b", "\u2028", "\u202e"]
SIGNS += ["\u2066", "\ufeff", "\ufffe", "\ud800", "\U000e0001", "\U0010ffff", "e\u0301", "\u212a"]
SIGNS += ["😀", "ﷺ", "٣", "Ⅷ", "µ", "ß", "İ"]


@pytest.mark.parametrize("sign", SIGNS, ids=[ascii(sign) for sign in SIGNS])
def test_strange_signs_anywhere(sign: str) -> None:
    sound = "\n".join(STATEMENTS.values())
    declared = [f'{kind} "{sign}" location a reacts_to x' for kind in ("poi", "event", "rule", "state", "agent")]
    for text in (sign, sign + sound, sound + sign, f"poi {sign}", f"connect a{sign} and b distance 3", *declared):
        told(text)
    told(sound + f'\npoi "{sign}" event "{sign}" event "b{sign}" collaborative agent "{sign}" mobile 0 location a')
    assert "PML101" in codes(sound + f'\npoi "x{sign}"')
    assert codes(sound + f"\n// {sign}\n/* {sign} */") == []
    assert any(finding.severity is Severity.ERROR for finding in told(sound + f"\nconnect a and b distance 1{sign}2"))


def test_line_ends_of_all_machines_are_the_same() -> None:
    sound = "\n".join(STATEMENTS.values())
    for end in ("\r", "\r\n", "\n"):
        assert codes(sound.replace("\n", end)) == []
        (finding,) = told((sound + "\npoi a").replace("\n", end))
        assert finding.span is not None and finding.span.line == len(STATEMENTS) + 1


# Files ----------------------------------------------------------------------------------------------------------------


def refused(file: object) -> Diagnostic:
    with pytest.raises(PursueError) as caught:
        watched(lambda: read_text(str(file)))
    (finding,) = caught.value.diagnostics
    assert finding.hint
    return finding


CONTENTS = {
    "UTF-16 with its mark": ('poi "a"'.encode("utf-16"), "PML002", "UTF-16"),
    "UTF-16 without it": ('poi "a"'.encode("utf-16-le"), "PML002", "plain text"),
    "UTF-32": ('poi "a"'.encode("utf-32"), "PML002", ""),
    "Latin-1": ('poi "a" // Küche'.encode("latin-1"), "PML002", "UTF-8"),
    "a program": (b"\x7fELF\x02\x01\x01" + bytes(range(256)) * 100, "PML002", "plain text"),
    "a surrogate": (b'poi "\xed\xa0\x80"', "PML002", ""),
    "a large program": (b"\x7fELF" + bytes(5_000_000), "PML002", "plain text"),
    "too large": (b"x" * 4_000_002, "PML003", "scenario"),
}


@pytest.mark.parametrize("name", CONTENTS)
def test_files_that_are_no_text(name: str, tmp_path: Path) -> None:
    content, code, hint = CONTENTS[name]
    file = tmp_path / "some.pur"
    file.write_bytes(content)
    finding = refused(file)
    assert finding.code == code
    assert hint in finding.hint


def test_things_that_are_no_files(tmp_path: Path) -> None:
    assert refused(tmp_path).code == "PML001"
    assert refused(tmp_path / "nothing.pur").code == "PML001"
    assert refused("\0").code == "PML001"
    assert refused("x" * 5000).code == "PML001"
    assert refused("/dev/zero").code == "PML002"
    assert watched(lambda: read_text("/dev/null")) == ""


def test_a_pipe_into_which_nobody_writes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pursue_gen.language.parser._PATIENCE", 0.2)
    pipe = tmp_path / "pipe.pur"
    os.mkfifo(str(pipe))
    finding = refused(pipe)
    assert finding.code == "PML001" and "nothing came" in finding.message


def test_a_pipe_into_which_somebody_writes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pursue_gen.language.parser._PATIENCE", PATIENCE)
    pipe = tmp_path / "pipe.pur"
    os.mkfifo(str(pipe))
    text = 'poi "a"\n' * 50_000  # more than a pipe holds
    writer = threading.Thread(target=lambda: pipe.write_text(text, encoding="utf-8"), daemon=True)
    writer.start()
    assert watched(lambda: read_text(str(pipe))) == text
    writer.join(PATIENCE)


def test_a_mark_at_the_start_is_no_sign(tmp_path: Path) -> None:
    file = tmp_path / "some.pur"
    file.write_bytes(b'\xef\xbb\xbfpoi "a"')
    assert read_text(str(file)) == 'poi "a"'


def test_an_empty_file_is_reported_what_is_missing(tmp_path: Path) -> None:
    file = tmp_path / "some.pur"
    file.write_bytes(b"")
    command = [sys.executable, "-m", "pursue_gen", "check", str(file)]
    done = subprocess.run(command, cwd=str(ROOT), stdout=subprocess.PIPE, timeout=PATIENCE, check=False)
    assert done.returncode == 3
    assert [code in done.stdout for code in (b"PML130", b"PML132", b"PML171")] == [True] * 3


# At random ------------------------------------------------------------------------------------------------------------

WORDS = [*KEYWORDS.values(), *"a b bot man work hand tired order human 3 0 9999999 2.5 -1 1e9".split()]
WORDS += ['"a"', '"b"', '"e"', '"', "“a”", ":", ",", "(", ")", ";", ".", "//", "/*", "*/", "\n"]
WORDS += ["//[0,0,0,0,0,0,1]", "//[x]", "//[1,2", '"\x1b[31m"', '"' + "n" * 90 + '"']
WORDS += ["control: A<> x", "\0", "\u202e", "\ufeff", "\r"]
FORM_WORDS = [kind.form().split("(")[0].replace("·", "\n").split() for kind in kinds.STATEMENTS.values()]

lists_of_words = st.lists(st.sampled_from(WORDS), max_size=40)


@st.composite
def scenarios(draw: st.DrawFn) -> str:
    """Statements after the grammar, then some of their words left out, doubled, exchanged or replaced."""
    words: List[str] = []
    for statement in draw(st.lists(st.sampled_from([*STATEMENTS.values()]), min_size=1, max_size=14)):
        words += [*statement.replace(":", " : ").replace(",", " , ").split(), "\n"]
    for _ in range(draw(st.integers(0, 6))):
        place = draw(st.integers(0, len(words) - 1))
        other = draw(st.integers(0, len(words) - 1))
        change = draw(st.sampled_from(["leave out", "double", "exchange", "replace", "insert", "statement"]))
        if change == "leave out" and len(words) > 1:
            del words[place]
        elif change == "double":
            words.insert(place, words[place])
        elif change == "exchange":
            words[place], words[other] = words[other], words[place]
        elif change == "replace":
            words[place] = draw(st.sampled_from(WORDS))
        elif change == "insert":
            words.insert(place, draw(st.text(max_size=5)))
        else:
            words[place:place] = draw(st.sampled_from(FORM_WORDS))
    return " ".join(words)


FUZZ = settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))


@FUZZ
@given(scenarios())
def test_scenarios_with_slips(text: str) -> None:
    found = told(text)
    places = [(f.span.line, f.span.column) for f in found if f.span is not None]
    assert places == sorted(places)


@FUZZ
@given(lists_of_words)
def test_words_in_any_order(words: List[str]) -> None:
    told(" ".join(words))


@FUZZ
@given(st.text(max_size=200))
def test_any_text(text: str) -> None:
    told(text)


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.binary(max_size=200))
def test_any_bytes(tmp_path: Path, content: bytes) -> None:
    file = tmp_path / "some.pur"
    file.write_bytes(content)
    try:
        text = read_text(str(file))
    except PursueError as problem:
        assert all(finding.hint for finding in problem.diagnostics)
    else:
        told(text)
