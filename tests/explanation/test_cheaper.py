"""Cheaper forms of statements: each that is offered is won when its author writes it so."""

from __future__ import annotations

import functools
import json
from dataclasses import replace
from typing import Dict

import pytest

from pursue_gen.diagnostics import Span
from pursue_gen.explanation import costs as costs_module
from pursue_gen.explanation.costs import Costs, as_json, costs, in_words
from pursue_gen.explanation.decided import Decided
from pursue_gen.explanation.offers import Form, cheaper
from pursue_gen.language import parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.outcomes import Lost
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.limits import Limits

RULES = Rules()

HOUSE = """poi "hall"
poi "east"
poi "west"
connect hall and east distance 3
connect hall and west distance 3
event "ring"
event "look" location east duration 2
agent "nora" controllable mobile 1 location east can_do look
agent "otto" controllable mobile 1 location west
agent "guest" location hall can_do ring
agent "walker" mobile 3 location hall
objective: if ring then look within 30
objective: patrol east, west every {period} by any robot
objective: if walker at west then any robot at west within {there}
objective: always not walker at east or any robot at east
"""


def house(period: int = 90, there: int = 30) -> Scenario:
    return parse(HOUSE.format(period=period, there=there), "house.pur", "house")


@functools.lru_cache(maxsize=None)
def forms(scenario: Scenario, first: int = 0, work: int = 20_000_000) -> Dict[int, Form]:
    return {form.line: form for form in cheaper(scenario, RULES, Budget(Limits(work=work)), first)}


def rewritten(scenario: Scenario, form: Form) -> Scenario:
    """The scenario whose author has written it so."""
    lines = scenario.text.split("\n")
    old = lines[form.line - 1]
    lines[form.line - 1] = f"{old} {form.text}" if old.startswith("event") else f"objective: {form.text}"
    return parse("\n".join(lines), "house.pur", "house")


def test_each_form_that_is_offered_is_won_as_its_author_writes_it() -> None:
    scenario = house()
    found = forms(scenario, first=13)
    assert len(found) == 3
    for form in found.values():
        assert solve_scenario(rewritten(scenario, form), RULES).strategy.blocks and form.states > 0


def test_a_named_robot_keeps_the_promise_as_it_stands_and_the_words_say_what_changes() -> None:
    form = forms(house(), first=13)[13]
    assert form.text in ("patrol east, west every 90 by nora", "patrol east, west every 90 by otto")
    assert form.in_words() == (
        f"Cheaper: with `{form.text}` in line 13 all is won, with {form.states} states; "
        "other robots do not count there then, but the promise is kept as it stands, too."
    )


def test_a_form_that_cannot_be_kept_is_not_offered() -> None:
    scenario = house(period=15)
    with pytest.raises(Lost):
        solve_scenario(parse(scenario.text.replace("15 by any robot", "15 by nora"), "h.pur", "h"), RULES)
    assert 13 not in forms(scenario, first=6)


def test_what_keeps_apart_or_is_avoided_stays_as_it_is() -> None:
    text = HOUSE.format(period=90, there=30).split("objective:")[0]
    only = parse(f"{text}objective: avoid any robot at hall and walker at hall\n", "h.pur", "h")
    assert forms(only) == {}


def test_an_event_of_people_that_has_to_be_answered_may_happen_once() -> None:
    scenario = house(period=15)
    form = forms(scenario, first=6)[6]
    assert (form.text, form.meaning) == ("at_most 1 times", "only the first ring is answered then")
    assert rewritten(scenario, form).events[0].at_most == 1


def test_without_work_nothing_is_offered() -> None:
    assert forms(house(), work=1) == {}


def _line(number: int) -> Span:
    return Span("house.pur", number, 1, number, 2)


def test_they_are_tried_where_something_is_not_decided(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(costs_module, "_LONGER", 0.0)
    monkeypatch.setattr(costs_module, "decided", lambda *_: Decided((), (_line(12),), _line(13)))
    found = costs(house(), RULES)
    assert found.cheaper and found.cheaper[0].line == 13
    assert found.cheaper[0].in_words() in in_words(found).split("\n")
    assert json.loads(json.dumps(as_json(found)))["cheaper"][0]["text"] == found.cheaper[0].text
    monkeypatch.setattr(costs_module, "decided", lambda *_: Decided((), tuple(map(_line, (12, 13, 14, 15)))))
    assert costs(house(), RULES).cheaper == () and "cheaper" not in as_json(replace(found, cheaper=()))
    assert in_words(Costs((), ())) == ""
