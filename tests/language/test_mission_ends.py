"""`mission ends …` as a text: what it is read as, what is wrong with it, and what it is in words."""

from __future__ import annotations

from typing import List

import pytest

from pursue_gen.language import parse
from pursue_gen.language.checks import check_reading
from pursue_gen.language.formatter import format_text
from pursue_gen.language.parser import read
from pursue_gen.language.sentences import end_words
from pursue_gen.language.writer import scenario_text
from pursue_gen.tga import translate

HOUSE = """\
poi "desk"
poi "window"
connect desk and window distance 2
event "call" location window
event "fetch" location desk duration 3
agent "bot" controllable mobile 1 location desk can_do fetch
agent "visitor" mobile 3 location window can_do call
"""
ASKED = HOUSE + "objective: if call then fetch within 30\n"


def codes(text: str) -> List[str]:
    return [finding.code for finding in check_reading(read(text, "x.pur", "x"))]


@pytest.mark.parametrize(
    "line, after, answered, sentence",
    [
        ("mission ends after 480", 480, False,
         "The mission ends 480 units after the start, as soon as what is due then is answered."),
        ("mission ends when all is answered", None, True,
         "The mission ends when an answer has come and no other is due."),
        ("mission ends after 1 when all is answered", 1, True,
         "The mission ends 1 unit after the start, or later, when no answer is due."),
    ],
)  # fmt: skip
def test_an_end_is_read_written_and_said(line: str, after: object, answered: bool, sentence: str) -> None:
    text = f"{ASKED}{line}\n"
    scenario = parse(text, "x.pur", "x")
    (end,) = scenario.ends
    assert (end.after, end.answered, end.text) == (after, answered, line)
    assert codes(text) == [] and end_words(scenario) == [sentence]
    assert line in scenario_text(scenario).splitlines()
    assert format_text(text, "x.pur").splitlines()[-1] == line


@pytest.mark.parametrize(
    "lines, code",
    [
        ("mission ends", "PML331"),
        ("mission ends after 0", "PML331"),
        ("mission ends after 3\nmission ends after 4", "PML330"),
        ("mission ends after 3\nreach_objective: do fetch", "PML330"),
        ("mission ends after 3 when all answered", "PML010"),
        ("mission ends after", "PML010"),
        ("mission ends after soon", "PML010"),
        ("mission end after 3", "PML010"),
    ],
)
def test_what_is_wrong_with_an_end(lines: str, code: str) -> None:
    assert code in codes(f"{ASKED}{lines}\n")


def test_where_nothing_is_to_be_answered_an_end_cannot_wait_for_it() -> None:
    assert codes(f"{HOUSE}objective: avoid call\nmission ends when all is answered\n") == ["PML331"]
    assert codes(f"{HOUSE}objective: avoid call\nmission ends after 5\n") == []


def test_its_words_may_still_be_names() -> None:
    text = ASKED.replace("call", "ends").replace("desk", "mission").replace("visitor", "when")
    assert codes(f"{text}mission ends after 480\n") == []


def test_an_end_is_no_part_of_the_game() -> None:
    with_end, without = parse(f"{ASKED}mission ends after 480\n", "x.pur", "x"), parse(ASKED, "x.pur", "x")
    assert translate(with_end) == translate(without)
