"""Orders that people write: what can be ordered, and what is said of the rest, with its column in their text."""

from __future__ import annotations

from fractions import Fraction

import pytest

from pursue_gen.diagnostics import Severity
from pursue_gen.language import parse
from pursue_gen.language.checks import check
from pursue_gen.language.written_orders import NoOrder, event_names, with_written

SCENARIO = """\
poi "hall"
poi "room1"
connect hall and room1 distance 10
group "rooms": hall, room1
event "clean" location room1 duration 3
event "opens" location hall
state "open": initially false, true_if opens false_if clean
event "lift"
event "call"
agent "bot" controllable mobile 1 location hall can_do clean, opens
agent "bot2" controllable mobile 1 location room1 can_do clean, lift
agent "guest" location hall can_do call
objective: every place holds 1 robot
"""

STORY = parse(SCENARIO, "story.pur", "story")


@pytest.mark.parametrize(
    ("says", "objective"),
    [
        ("bot at room1", "if order1 then bot at room1 within 10.5"),
        ("any robot at room1 or open is_true", "if order1 then any robot at room1 or open is_true within 10.5"),
        ("not bot at hall", "if order1 then not bot at hall within 10.5"),
        ("clean", "if order1 then clean within 10.5"),
        ("do clean", "if order1 then clean within 10.5"),
        ("do clean at room1 by any robot", "if order1 then clean within 10.5"),
        ("do opens by any robot", "if order1 then opens within 10.5"),
        ("do lift by bot2", "if order1 then lift within 10.5"),
    ],
)
def test_what_can_be_ordered_is_an_objective_behind_the_others(says: str, objective: str) -> None:
    there = with_written(STORY, [(says, Fraction(21, 2))])
    assert there.safety[:-1] == STORY.safety and there.safety[-1].text == objective
    assert [event.name for event in there.orders] == ["order1"]
    assert not [each for each in check(there) if each.severity is Severity.ERROR]


def test_several_have_an_event_each() -> None:
    orders = [("bot at room1", Fraction(10)), ("clean", Fraction(20))]
    both = with_written(STORY, orders)
    assert [each.text for each in both.safety[-2:]] == [
        "if order1 then bot at room1 within 10", "if order2 then clean within 20",
    ]  # fmt: skip
    assert with_written(STORY, []) is STORY
    with pytest.raises(NoOrder, match="column 8: there is no POI room9"):
        with_written(STORY, [*orders, ("bot at room9", Fraction(1))])


@pytest.mark.parametrize(
    ("says", "why"),
    [
        ("bot at room9", "column 8: there is no POI room9; did you mean room1?"),
        ("do cleen", "column 4: there is no event cleen; did you mean clean?"),
        ("bot is room1", "column 5: expected .* found `is`"),
        ("bot at", "column 8: expected a name after `at`"),
        ("do clean at hall", "column 13: clean happens at room1; order it without at"),
        ("do lift at hall", "column 12: lift happens anywhere; order it without at"),
        ("do clean by bot", "column 13: bot2 can do clean, too; order it without by: who does it cannot be chosen"),
        ("do lift by bot", "column 12: bot2 can do lift; order it without by"),
        ("do call by any robot", "column 12: guest can do call; order it without by"),
        ("do nothing by bot", "column 4: there is no event nothing"),
        ("do clean and opens", "column 1: expected a name.*; expected a condition, as in bot1 at room4"),
        ("avoid clean", "column 1: expected a name"),
        ("patrol hall, room1 every 5 by bot", "column 8: expected"),
        ("if clean then opens", "column 1: expected a name"),
        ("bot at hall within 5, at_most 2 open", "column 21: expected the end of the statement"),
        ("bot at hall // so", "column 12: expected .* but the statement ends here"),
        ("bot at hall within 5\nobjective: avoid clean", "."),
        ('bot at hall within 5\nevent "x"\nobjective: if x then clean', "."),
        ("order1", "column 1: order1 cannot be its own answer"),
        ("", "column 2: expected a name"),
    ],
)
def test_what_cannot_be_ordered_is_said_with_its_column(says: str, why: str) -> None:
    with pytest.raises(NoOrder, match=why):
        with_written(STORY, [(says, Fraction(10))])


def test_events_have_names_that_the_scenario_does_not_have() -> None:
    assert event_names(STORY, 2) == ("order1", "order2")
    taken = parse(SCENARIO.replace('"clean"', '"order7"').replace("clean", "order7"), "story.pur", "story")
    assert event_names(taken, 1) == ("order_1",)
    assert with_written(taken, [("order7", Fraction(5))]).safety[-1].text == "if order_1 then order7 within 5"
