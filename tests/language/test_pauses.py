"""Pauses between events: read, told, written again, and what is wrong with them."""

from __future__ import annotations

from typing import List

import pytest

from pursue_gen.language import check, parse
from pursue_gen.language.checks import check_reading
from pursue_gen.language.draft import Draft
from pursue_gen.language.formatter import format_text
from pursue_gen.language.parser import read
from pursue_gen.language.scenario import NeverWith, Pause
from pursue_gen.language.writer import scenario_text
from pursue_gen.tools.lsp.completion import complete
from pursue_gen.tools.lsp.hover import hover

GREENHOUSE = """\
poi "rows"
poi "shed"
connect rows and shed distance 2
event "spray" label "the spraying" location rows duration 3
event "look" location rows duration 2
event "ring" location shed
agent "bot" controllable mobile 1 location shed can_do spray, look
agent "gerda" location shed can_do ring
"""
GOAL = "reach_objective: do look\n"


@pytest.mark.parametrize(
    ("words", "told", "broken"),
    [
        (
            "at_least 30 between spray",
            "After each end of the spraying, the spraying begins again 30 units later at the earliest.",
            "the spraying has begun less than 30 after the end of the spraying",
        ),
        (
            "at_least 2.5 between spray and look",
            "After each end of the spraying, look begins 2.5 units later at the earliest.",
            "look has begun less than 2.5 after the end of the spraying",
        ),
        ("at_least 9 between look and look", "look begins again", "look has begun less than 9 after the end of look"),
    ],
)
def test_each_form_is_read_and_told(words: str, told: str, broken: str) -> None:
    scenario = parse(GREENHOUSE + f"objective: {words}\n" + GOAL, "x.pur")
    (safety,) = scenario.safety
    assert isinstance(safety, Pause) and safety.text == words
    assert told in safety.sentence(scenario.shown) and broken in safety.broken(str)
    assert list(check(scenario)) == []
    assert f"objective: {words}\n" in scenario_text(scenario)
    assert f"objective: {words}\n" in format_text(scenario.text, "x.pur")


def test_each_of_a_group_has_a_pause_of_its_own() -> None:
    text = GREENHOUSE + 'group "work": spray, look\nfor each w in work: objective: at_least 9 between w\n' + GOAL
    assert [each.text for each in parse(text, "x.pur").safety] == [
        "at_least 9 between spray", "at_least 9 between look"
    ]  # fmt: skip


def test_its_words_may_be_names() -> None:
    text = """\
poi "a" poi "b"
connect a and b distance 1
event "at_least" location a
agent "bot" controllable mobile 1 location a can_do at_least
agent "between" mobile 1 location b
objective: at_least 5 between at_least and at_least
objective: bot never_with between
"""
    pause, apart = parse(text, "x.pur").safety
    assert pause.text == "at_least 5 between at_least and at_least" and isinstance(apart, NeverWith)
    as_agent = 'poi "a" agent "at_least" location a agent "b" location a objective: at_least never_with b'
    assert isinstance(parse(as_agent, "x.pur").safety[0], NeverWith)


@pytest.mark.parametrize(
    ("objective", "code", "says"),
    [
        ("at_least 0 between look", "PML143", "asks for no pause"),
        ("at_least 5 between rings", "PML110", "there is no event rings"),
        ("at_least 5 between look and shed", "PML110", "shed"),
        ("at_least five between look", "PML010", "expected a number"),
        ("at_least 5 look", "PML010", "expected `between` after `5`"),
        ("at_least 5 between look or spray", "PML010", "found `or`"),
    ],
)
def test_what_is_wrong_with_it(objective: str, code: str, says: str) -> None:
    findings = check_reading(read(GREENHOUSE + f"objective: {objective}\n" + GOAL, "x.pur", "x"))
    found = [finding for finding in findings if finding.code == code]
    assert found and says in found[0].message and found[0].hint and found[0].span and found[0].span.line == 9


def labels(text: str) -> List[str]:
    return [each.label for each in complete(Draft.of(text.replace("|", ""), "x"), text.index("|"))]


def test_editors_complete_and_explain_it() -> None:
    assert "at_least" in labels(GREENHOUSE + "objective: |")
    assert labels(GREENHOUSE + "objective: at_least 5 |")[:1] == ["between"]
    assert labels(GREENHOUSE + "objective: at_least 5 between |")[:3] == ["spray", "look", "ring"]
    assert {"and", "look"} & {*labels(GREENHOUSE + "objective: at_least 5 between spray |")} == {"and"}
    assert "look" in labels(GREENHOUSE + "objective: at_least 5 between spray and |")
    text = GREENHOUSE + "objective: at_least 30 between spray and look\n" + GOAL
    number = hover(Draft.of(text, "x"), text.index("30"))
    assert number is not None and "30 units of time after the end" in number.markdown
    event = hover(Draft.of(text, "x"), text.index("look\n"))
    assert event is not None and "30 units of time after each end of spray, or later" in event.markdown
