"""Changes of what is for each of a group: each is what comes of a change of the one line that is written."""

from __future__ import annotations

import re
from typing import Any, List

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.explanation.explain import explain, render
from pursue_gen.explanation.number_changes import Repair
from pursue_gen.explanation.offers import cheaper, longer
from pursue_gen.explanation.repairs import repairs
from pursue_gen.language import parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.writer import _meaning
from pursue_gen.outcomes import Lost
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.limits import Limits

RULES = Rules()

HOTEL = """\
poi "hall"
poi "room1"
poi "room2"
group "rooms": room1, room2
for each r in rooms: connect hall and r distance 3
for each r in rooms: event "call" of r location r at_most 2 times
for each r in rooms: event "look" of r location r duration 2
for each r in rooms: agent "guest" of r mobile 4 location r can_do call of r
agent "bob" controllable mobile 1 location hall can_do look of rooms
for each r in rooms: travel bob from hall to r takes 3 to 5
for each r in rooms: assume: guest of r waits 5 between call of r
for each r in rooms: objective: if call of r then look of r within 9
"""


def hotel(text: str = HOTEL) -> Scenario:
    return parse(text, "hotel.pur")


def meaning(scenario: Scenario) -> Any:
    return _meaning(scenario)


def of_lines(scenario: Scenario) -> List[Repair]:
    return [repair for repair in repairs(scenario, RULES) if repair.span is not None and not repair.span.member]


NUMBERS = {
    "distance": ("distance", 5), "times": ("at_most", 6), "duration": ("duration", 7), "agent": ("mobile", 8),
    "assumption": ("waits", 11), "deadline": ("within", 12),
}  # fmt: skip
"""By the kind of change the word before the number, and its line."""


@given(st.data())
def test_it_is_the_number_of_the_line_that_changes(data: st.DataObject) -> None:
    scenario = hotel()
    found = [repair for repair in of_lines(scenario) if (repair.what, repair.span and repair.span.line) in {
        (what, line) for what, (_, line) in NUMBERS.items()}]  # fmt: skip
    assert {repair.what for repair in found} == set(NUMBERS)
    repair = data.draw(st.sampled_from(found))
    value = data.draw(st.sampled_from(list(repair.values)[:20]))
    word, line = NUMBERS[repair.what]
    lines = HOTEL.split("\n")
    lines[line - 1] = re.sub(rf"\b{word} \d+", f"{word} {value}", lines[line - 1])
    changed = repair.make(value)
    assert isinstance(changed, Scenario) and meaning(changed) == meaning(hotel("\n".join(lines)))
    assert repair.say(value).endswith(", and so for each other r") and str(value) in repair.say(value)


def test_each_line_is_changed_once_and_all_members_with_it() -> None:
    scenario = hotel()
    places = [(repair.what, repair.span, tuple(repair.values)) for repair in of_lines(scenario)]
    assert len(places) == len(set(places))
    assert not [repair for repair in repairs(scenario, RULES) if repair.span and repair.span.member]
    (control,) = (repair for repair in of_lines(scenario) if repair.what == "control")
    followed = control.make("")
    assert isinstance(followed, Scenario) and [agent.human for agent in followed.agents] == [True, True, False]


def test_what_may_be_assumed_is_assumed_of_all() -> None:
    scenario = hotel(re.sub("for each r in rooms: assume.*\n| at_most 2 times", "", HOTEL))
    missing = next(repair for repair in of_lines(scenario) if repair.what == "assumption")
    changed = missing.make(missing.values[0])
    assert isinstance(changed, Scenario) and len(changed.assumptions) == 2


def test_what_differs_between_members_names_its_own() -> None:
    pairs = '\nevent "go"\nfor each a in rooms, b in rooms: travel bob from a to b takes 3 to 4\nobjective: avoid go'
    scenario = hotel(HOTEL + pairs)
    said = next(repair.say(repair.values[0]) for repair in of_lines(scenario) if repair.span and repair.span.line == 15)
    assert said.endswith("and so for each other a and b")


def test_a_limit_that_wins_is_one_for_all_members() -> None:
    scenario = hotel(HOTEL.replace("mobile 4 ", ""))
    with pytest.raises(Lost) as raised:
        solve_scenario(scenario, RULES)
    said = raised.value.diagnostics[0].message
    assert said.count("line 12") <= 1, said
    found = explain(scenario, RULES, Limits(60.0))
    (deadline,) = (change for change in found.changes if change.what == "deadline")
    assert f"a deadline of {deadline.after} instead of 9 for look_room1, and so for each other r" in deadline.sentence
    assert re.search(r"line 12\)", render(found)) and "line 12 (" not in render(found)
    assert solve_scenario(hotel(scenario.text.replace("within 9", f"within {deadline.after}")), RULES).strategy.blocks


def test_more_time_is_said_as_the_line_is_written() -> None:
    scenario = hotel(HOTEL.replace("mobile 4 ", ""))
    (only,) = longer(scenario, RULES, Limits(60.0))
    text = re.fullmatch(r"objective: if call of r then look of r within (\d+)", only.text)
    assert text and (only.line, only.asked) == (12, 9)
    assert solve_scenario(hotel(scenario.text.replace("within 9", f"within {text[1]}")), RULES).strategy.blocks


def test_a_cheaper_form_is_that_of_the_line() -> None:
    text = re.sub("for each r in rooms: (travel|assume|objective).*\n|at_most 2 times", "", HOTEL)
    text += 'agent "ida" controllable mobile 1 location hall\n'
    text += "for each r in rooms: objective: if call of r then look of r within 60\n"
    scenario = hotel(text + "for each r in rooms: objective: patrol r, hall every 90 by any robot\n")
    found = {form.line: form for form in cheaper(scenario, RULES, Budget(Limits(work=50_000_000)))}
    assert found[6].meaning == "only the first call_room1 and the first call_room2 are answered then"
    assert re.fullmatch("objective: patrol r, hall every 90 by (bob|ida)", found[12].text)
