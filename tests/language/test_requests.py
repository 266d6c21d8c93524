"""Requests, each of which is answered: read, told, written again, what is wrong with them, and what editors say."""

from __future__ import annotations

from typing import List

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.language import check, parse
from pursue_gen.language.checks import check_reading
from pursue_gen.language.draft import Draft
from pursue_gen.language.formatter import format_text
from pursue_gen.language.parser import read
from pursue_gen.language.scenario import MostOpen, Request, Respond
from pursue_gen.language.sentences import condition_of_promise, objective_words
from pursue_gen.language.writer import scenario_text, written
from pursue_gen.tools.lsp.completion import complete
from pursue_gen.tools.lsp.hover import hover

SHOP = """\
poi "desk"
poi "room1"
poi "room2"
group "rooms": room1, room2
connect desk and room1 distance 3
connect desk and room2 distance 3
event "order" label "an order"
event "pack" location desk duration 2
event "tidy" location desk duration 2
agent "bot" controllable mobile 1 location desk can_do pack, tidy
agent "shop" label "the shop" location desk can_do order
"""
WORDS = "if order then pack within 30, at_most 3 open"


def test_it_is_read_and_told_and_written() -> None:
    scenario = parse(f"{SHOP}objective: {WORDS}\n", "x.pur")
    assert [type(each) for each in scenario.safety] == [Request] * 3
    assert {each.text for each in scenario.safety} == {WORDS} and len(scenario.statements) == 1
    assert objective_words(scenario) == [
        "Whenever an order happens, pack answers it within 30 units, also where it happens again before that: the "
        "oldest is answered first."
    ]
    assert condition_of_promise(scenario) == "as long as an order happens only while fewer than 3 wait for pack"
    assert scenario.safety[1].broken(str) == "no pack within 30 of an order, the oldest that waits"
    assert list(check(scenario)) == []
    assert scenario_text(scenario).count(f"objective: {WORDS}\n") == 1
    assert f"objective: {WORDS}\n" in format_text(scenario.text, "x.pur")
    assert format_text(f"objective :\n{WORDS}".replace(",", " ,"), "x.pur").strip() == f"objective: {WORDS}"


def test_without_a_number_that_are_open_it_is_one_answer_to_several() -> None:
    (safety,) = parse(f"{SHOP}objective: if order then pack within 30\n", "x.pur").safety
    assert isinstance(safety, Respond)


@given(st.integers(1, 6), st.integers(1, 6))
def test_a_scenario_with_fewer_is_the_one_that_is_written_so(most: int, fewer: int) -> None:
    one, other = (
        parse(f"{SHOP}objective: if order then pack within 30, at_most {k} open\n", "x.pur")
        for k in (max(most, fewer), min(most, fewer))
    )
    (change, *_) = one.safety[0].easier(lambda _: {})
    assert list(change.values) == list(range(max(most, fewer) - 1, 0, -1))
    changed = one.with_each(lambda each: change.make(each, min(most, fewer)))
    assert scenario_text(changed) == scenario_text(other)
    assert len(written(changed).safety) == len(changed.safety) == min(most, fewer)


def test_what_is_assumed_is_behind_the_statements_and_goes_with_an_objective_that_is_given_up() -> None:
    text = f"{SHOP}optional 1 objective: {WORDS}\nassume: shop does order after 9\nobjective: avoid tidy\n"
    scenario = parse(text, "x.pur")
    assert [type(each).__name__ for each in scenario.assumed] == ["NotBefore", "MostOpen"]
    (_, most) = scenario.assumed
    assert isinstance(most, MostOpen) and most.most == 3 and len(scenario.assumptions) == 1
    assert scenario.giving_up([1]).assumed == scenario.assumptions
    assert len(scenario.giving_up([1]).given_up) == 3


def test_for_each_room_there_is_a_statement() -> None:
    text = f"""{SHOP}\
for each r in rooms: event "ask" of r
for each r in rooms: event "bring" of r location desk
agent "other" controllable location desk can_do bring of rooms
agent "guest" location desk can_do ask of rooms
for each r in rooms: objective: if ask of r then bring of r within 60, at_most 2 open
"""
    scenario = parse(text, "x.pur")
    assert {finding.code for finding in check(scenario)} <= {"PML190"}
    assert len(scenario.safety) == 4 and len(scenario.statements) == 2 and len(scenario.assumed) == 2


def test_its_words_may_be_names() -> None:
    text = """\
poi "a"
event "order" only_if open is_true
event "at_first"
state "open": initially true, false_if order
agent "bot" controllable location a can_do at_first
agent "shop" location a can_do order
objective: if order then at_first within 9, at_most 2 open
objective: if open is_false then at_first within 9
objective: avoid open is_false and open is_true
"""
    scenario = parse(text, "x.pur")
    assert [type(each) for each in scenario.safety[:3]] == [Request, Request, Respond]
    assert [finding.code for finding in check(scenario)] == ["PML232"]


@pytest.mark.parametrize(
    ("objective", "code", "says"),
    [
        ("if order then pack within 0, at_most 3 open", "PML143", "leaves no time to answer"),
        ("if order then order within 9, at_most 3 open", "PML172", "cannot be its own answer"),
        ("if order then pack within 9, at_most 0 open", "PML226", "expected 1 to 20"),
        ("if order then pack within 9, at_most 21 open", "PML226", "expected 1 to 20"),
        ("if tidy then pack within 9, at_most 2 open", "PML227", "has a duration"),
        ("if tidy then pack within 9, at_most 2 open", "PML250", "bot is controlled and can do tidy"),
        ("if call then pack within 9, at_most 2 open", "PML110", "no event call"),
        ("if order then pack within 9 at_most 2 open", "PML010", "expected `,`"),
        ("if order then pack within 9, at_most 2", "PML010", "expected `open`"),
        ("if order then pack within 9, at_most 1.5 open", "PML014", ""),
        ("if shop at desk then pack within 9, at_most 2 open", "PML010", ""),
    ],
)
def test_what_is_wrong_with_it(objective: str, code: str, says: str) -> None:
    findings = check_reading(read(SHOP + f"objective: {objective}\n", "x.pur", "x"))
    found = [finding for finding in findings if finding.code == code]
    assert found, findings
    assert says in found[0].message and found[0].hint and found[0].span and found[0].span.line == 12


def test_the_same_twice_is_one_too_many_and_another_answer_is_not() -> None:
    twice = parse(f"{SHOP}objective: {WORDS}\nobjective: {WORDS}\n", "x.pur")
    assert [finding.code for finding in check(twice)] == ["PML220"]
    other = parse(f"{SHOP}objective: {WORDS}\nobjective: {WORDS.replace('pack', 'tidy')}\n", "x.pur")
    assert list(check(other)) == [] and len(other.assumed) == 2


def labels(text: str) -> List[str]:
    return [each.label for each in complete(Draft.of(text.replace("|", ""), "x"), text.index("|"))]


def test_editors_complete_and_explain_it() -> None:
    assert "at_most" in labels(SHOP + "objective: if order then pack within 30, |")
    assert "open" in labels(SHOP + "objective: if order then pack within 30, at_most 3 |")
    text = f"{SHOP}objective: {WORDS}\n"
    word, event = (hover(Draft.of(text, "x"), text.rindex(what)) for what in ("open", "order"))
    assert word is not None and "the oldest first" in word.markdown
    assert event is not None and "each time it must be answered by pack within 30 units of time" in event.markdown
