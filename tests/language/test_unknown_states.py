"""States that are not known at first, as text: how they are written, what is wrong with them, what is said of them."""

from __future__ import annotations

from typing import List, Tuple

import pytest

from pursue_gen.language import check, parse
from pursue_gen.language.formatter import format_text
from pursue_gen.language.writer import scenario_text
from tests.language.texts import findings

SHELF = """\
poi "dock"
poi "shelf"

connect dock and shelf distance 4

event "look" location shelf duration 2
event "refill" location shelf duration 3 only_if empty is_true
event "call"

state "empty": initially unknown, false_if refill shown_by look

agent "bot" controllable mobile 1 location dock can_do look, refill
agent "guest" location dock can_do call

objective: if empty is_true then refill within 60
objective: if call then look within 60
"""

STATE = "unknown, false_if refill shown_by look"


def found(text: str) -> List[Tuple[str, str]]:
    return [(finding.code, finding.message) for finding in check(parse(text, "x.pur", "x"))]


@pytest.mark.parametrize(
    "state",
    [STATE, "unknown, shown_by look, call", "unknown seen_at shelf", "true, false_if refill",
     "unknown seen_at shelf, true_if call shown_by look", "unknown, true_if call false_if refill shown_by look"],
)  # fmt: skip
def test_it_is_read_as_it_is_written(state: str) -> None:
    text = SHELF.replace(STATE, state)
    scenario = parse(text, "x.pur", "x")
    (one,) = scenario.states
    assert one.text == f'state "empty": initially {state}'
    assert one.is_found_out is state.startswith("unknown")
    assert format_text(text, "x.pur") == text
    again = parse(scenario_text(scenario), "x.pur", "x")
    assert again.states[0].text == one.text
    assert found(text) == []


@pytest.mark.parametrize(
    ("state", "code", "said"),
    [
        ("unknown, false_if refill", "PML430", "nothing says how it is found out"),
        ("false, shown_by look", "PML431", "empty is false at first, so it need not be found out"),
        ("true seen_at shelf", "PML431", "empty is true at first"),
        ("unknown, false_if look shown_by look", "PML431", "look sets empty, so it shows nothing"),
        ("unknown, shown_by dance", "PML110", "there is no event dance"),
        ("unknown seen_at garage", "PML110", "there is no POI garage"),
    ],
)
def test_what_is_wrong_with_it(state: str, code: str, said: str) -> None:
    assert any(each[0] == code and said in each[1] for each in found(SHELF.replace(STATE, state)))


def test_what_is_assumed_does_not_depend_on_it() -> None:
    text = SHELF.replace("objective: if call", "assume: not (guest at dock and empty is_true)\nobjective: if call")
    assert [code for code, _ in found(text)] == ["PML432"]


@pytest.mark.parametrize(
    ("old", "new", "warned"),
    [
        ("objective: if call then look within 60\n", "", True),  # nobody has it look
        ("can_do call", "can_do call, look", False),
        ("if call then look", "if call then bot at shelf", True),  # to be there shows nothing
        (STATE, "unknown seen_at shelf", False),  # to look it has to be there
        (STATE, "unknown seen_at dock, shown_by look", False),  # it starts there
        ("objective: if call then look within 60", "objective: patrol shelf every 90 by bot", True),
    ],
)
def test_what_nobody_need_find_out_is_warned_of(old: str, new: str, warned: bool) -> None:
    assert ("PML434" in [code for code, _ in found(SHELF.replace(old, new))]) is warned


@pytest.mark.parametrize("more", ["patrol shelf every 90 by bot", "if call then bot at shelf within 40"])
def test_who_has_to_be_there_sees_it(more: str) -> None:
    assert found(f"{SHELF.replace(STATE, 'unknown seen_at shelf')}objective: {more}\n") == []


@pytest.mark.parametrize("name", ["unknown", "shown_by", "seen_at", "may_stop"])
def test_its_words_are_names_as_well(name: str) -> None:
    assert list(findings(SHELF.replace("guest", name))) == []


def test_a_name_that_means_two_things_in_the_network_is_refused() -> None:
    text = SHELF.replace('event "call"', 'event "call"\nevent "empty_is_true"')
    text = text.replace("can_do call", "can_do call, empty_is_true")
    assert "PML105" in [code for code, _ in found(text)]
    known = text.replace(STATE, "true, false_if refill")
    assert "PML105" not in [code for code, _ in found(known)]
