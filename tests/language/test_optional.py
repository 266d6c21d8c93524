"""Optional objectives as a text: what they are read as, what is wrong with them, and what they are in words."""

from __future__ import annotations

from typing import List

import pytest

from pursue_gen.language import parse
from pursue_gen.language.checks import check_reading
from pursue_gen.language.formatter import format_text
from pursue_gen.language.objectives import WhyGivenUp
from pursue_gen.language.parser import read
from pursue_gen.language.sentences import objective_words, promise_words

HOUSE = """\
poi "desk"
poi "door"
connect desk and door distance 2
event "mail" location desk
event "water" location door
agent "bot" controllable mobile 1 location desk can_do mail, water
"""
WANTED = """\
reach_objective: do mail
optional 2 reach_objective: do water within 9
optional 1 objective: patrol desk, door every 20 by bot
optional 1 objective: avoid bot at door
"""


def codes(text: str) -> List[str]:
    return [finding.code for finding in check_reading(read(text, "x.pur", "x"))]


def test_the_number_behind_optional_is_that_of_its_objectives() -> None:
    scenario = parse(HOUSE + WANTED, "x.pur", "x")
    assert [objective.optional for objective in scenario.objectives] == [1, 1, 1, 0, 2]
    assert scenario.optional == (1, 2)
    assert codes(HOUSE + WANTED) == []


def test_what_is_given_up_is_no_objective_any_more_and_is_remembered() -> None:
    scenario = parse(HOUSE + WANTED, "x.pur", "x").giving_up((1,)).giving_up((2,), WhyGivenUp.TOO_MUCH_WORK)
    assert scenario.optional == () and [one.full_text for one in scenario.objectives] == [
        "reach_objective: do mail"
    ]
    assert promise_words(scenario) == [
        "optional 1 is given up, it cannot be promised together with the rest: patrol desk every 20 by bot; "
        "patrol door every 20 by bot; avoid bot at door",
        "optional 2 is given up, it was too much work to decide: do water within 9",
    ]


def test_what_is_promised_is_said() -> None:
    scenario = parse(HOUSE + WANTED, "x.pur", "x").giving_up((1,))
    assert promise_words(scenario)[1] == "optional 2 is promised: do water within 9"
    assert objective_words(scenario)[1] == "Optional 2: water happens within 9 units after the start."
    assert scenario.reach[1].full_text == "optional 2 reach_objective: do water within 9"


def test_where_nothing_is_optional_nothing_is_said() -> None:
    assert promise_words(parse(HOUSE + "reach_objective: do mail", "x.pur", "x")) == []


@pytest.mark.parametrize(
    ("wanted", "code"),
    [
        ("reach_objective: do mail\noptional 0 reach_objective: do water", "PML300"),
        ("optional 1 reach_objective: do mail", "PML301"),
        ("reach_objective: do mail\noptional 1 objective: patrol desk, door by bot", "PML303"),
        ("\n".join(f"optional {k} objective: patrol desk every {k + 20} by bot" for k in range(8)), "PML302"),
    ],
)
def test_what_is_wrong_with_them(wanted: str, code: str) -> None:
    assert code in codes(HOUSE + wanted)


def test_optional_is_a_name_as_well() -> None:
    text = HOUSE.replace("water", "optional") + (
        "reach_objective: do optional within 9\nobjective: avoid optional\noptional 1 reach_objective: do optional\n"
        "optional 2 reach_objective: do mail"
    )
    scenario = parse(text, "x.pur", "x")
    assert [objective.full_text for objective in scenario.objectives] == [
        "objective: avoid optional",
        "reach_objective: do optional within 9",
        "optional 1 reach_objective: do optional",
        "optional 2 reach_objective: do mail",
    ]


def test_a_statement_is_one_line_however_it_was_broken() -> None:
    broken = HOUSE + "\nreach_objective: do mail\noptional\n1\n reach_objective : do water // later\n"
    formatted = format_text(broken, "x.pur")
    assert formatted.endswith("reach_objective: do mail\noptional 1 reach_objective: do water // later\n")
    assert format_text(formatted, "x.pur") == formatted
