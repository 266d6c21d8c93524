"""What has to happen several times, and apart: read, told, written again, and what is wrong with it."""

from __future__ import annotations

from typing import List

import pytest

from pursue_gen.language import check, parse
from pursue_gen.language.draft import Draft
from pursue_gen.language.formatter import format_text
from pursue_gen.language.network_names import apart, did, done_times
from pursue_gen.language.symbols import Symbol
from pursue_gen.language.writer import scenario_text
from pursue_gen.tools.lsp.completion import complete
from pursue_gen.tools.lsp.hover import hover

DESK = """\
poi "desk"
event "look" label "a look" duration 2
event "twice"
agent "bot" controllable location desk can_do look, twice
reach_objective: do {}
"""


@pytest.mark.parametrize(
    ("words", "said", "told"),
    [
        ("look twice", "look twice", "a look happens twice."),
        ("look 2 times", "look twice", "a look happens twice."),
        ("look 3 times at_least 2.5 apart", "", "a look happens 3 times, at least 2.5 units apart."),
        (
            "look twice at_least 9 apart after 5 within 20", "",
            "a look happens twice, at least 9 units apart, later than 5 units after the start and within 20 units",
        ),
        ("twice twice", "", "twice happens twice."),
        ("look 1 times", "look", "a look happens."),
    ],
)  # fmt: skip
def test_each_form_is_read_and_told(words: str, said: str, told: str) -> None:
    scenario = parse(DESK.format(words), "x.pur")
    (reach,) = scenario.reach
    assert reach.text == f"do {said or words}" and told in reach.sentence(scenario.shown)
    assert [finding.code for finding in check(scenario) if finding.code != "PML157"] == []
    assert parse(scenario_text(scenario), "x.pur").reach[0].text == reach.text
    assert f"reach_objective: do {words}\n" in format_text(scenario.text, "x.pur")


@pytest.mark.parametrize(
    ("words", "code", "says"),
    [
        ("look 0 times", "PML225", "expected 1 to 100"),
        ("look 101 times", "PML225", "expected 1 to 100"),
        ("look and twice twice", "PML225", "twice behind several events"),
        ("look at_least 5 apart", "PML225", "happens twice or more"),
        ("look twice at_least 0 apart", "PML225", "expected more than 0"),
        ("look 3 times at_least 10 apart within 20", "PML223", "later than 20"),
        ("look twice at_least 10 apart after 5 within 15", "PML223", "later than 15"),
    ],
)
def test_what_is_wrong_with_it(words: str, code: str, says: str) -> None:
    found = [finding for finding in check(parse(DESK.format(words), "x.pur")) if finding.code != "PML157"]
    assert [finding.code for finding in found] == [code] and says in found[0].message and found[0].hint


def test_its_places_are_told() -> None:
    (reach,) = parse(DESK.format("look 3 times at_least 5 apart"), "x.pur").reach
    assert reach.status(done_times(2)) == "a look done 2 of 3 times"
    assert reach.status(apart(1)) == "a look done 1 of 3 times, too soon for the next"
    for place in (done_times(2), apart(1), did(1)):
        assert (Symbol.of(str(place)).role, Symbol.of(str(place)).parts) == (place.role, place.parts)


def labels(text: str) -> List[str]:
    return [each.label for each in complete(Draft.of(text.replace("|", ""), "x"), text.index("|"))]


def test_editors_complete_and_explain_it() -> None:
    assert {"twice", "at_least", "after", "within", "and"} <= {*labels(DESK.format("look |"))}
    assert labels(DESK.format("look 3 |"))[:1] == ["times"] and "at_least" in labels(DESK.format("look twice |"))
    assert labels(DESK.format("look twice at_least 5 |"))[:1] == ["apart"]
    text = DESK.format("look twice at_least 30 apart")
    number, event = (hover(Draft.of(text, "x"), text.index(word)) for word in ("30", "look twice"))
    assert number is not None and "30 units of time after the last one that counted" in number.markdown
    assert event is not None and "is to be achieved twice, at least 30 units of time apart" in event.markdown


def test_what_stands_below_is_a_statement_of_its_own() -> None:
    for words in ("look twice", "look 3 times", "look twice at_least 5 apart"):
        text = DESK.format(words) + 'agent "eve" location desk\n'
        assert len(parse(text, "x.pur").agents) == 2
