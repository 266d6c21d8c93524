"""How far robots drive: the least of patrols by hand, and what is measured of a won scenario."""

from __future__ import annotations

from unittest import mock

import pytest

from benchmarks import driving, ordinary_page
from benchmarks.driving import driving_measured, least
from pursue_gen.language import parse

FLOOR = """poi "a"
poi "b"
poi "c"
poi "d"
connect a and b distance 2
connect b and c distance 3
connect c and d distance 4
agent "one" controllable mobile 1 location a
agent "two" controllable mobile 1 location d
"""


def bound(*objectives: str) -> float:
    """In 200 time units."""
    return least(parse(FLOOR + "".join(f"objective: {each}\n" for each in objectives), "floor.pur", "floor"), 200.0)


@pytest.mark.parametrize(
    ("objectives", "expected"),
    [
        (["patrol a, c every 60 by one"], 3 * 5),
        (["patrol a, c every 20 by one"], 16 * 5),  # a way takes 8 at worst
        (["patrol a, c every 60 by any robot"], 4),  # each stands at one of them
        (["patrol a, c, d every 60 by any robot"], 3 * 4),
        (["patrol a, c every 60 by one", "patrol b, d every 90 by two"], 3 * 5 + 2 * 7),
        (["patrol a, c every 60 by one", "patrol b every 90 by one"], 3 * 5),  # past b
        (["patrol a, b every 40 by any robot", "patrol c, d every 90 by any robot"], 5 * 2 + 2 * 4),
        (["patrol b, c, d every 60 by one"], 9 + 7 + 7),
        (["one never_with two at a"], 0),
    ],
)
def test_the_least_way_of_patrols(objectives: "list[str]", expected: float) -> None:
    assert bound(*objectives) == expected


@pytest.mark.benchmark
def test_a_robot_that_need_not_move_stands_still_and_one_on_patrol_drives_little_more_than_it_has_to() -> None:
    text = FLOOR + "objective: patrol a, c every 60 by one\n"
    with mock.patch.object(driving, "lab_scenario", lambda seed: text if seed else text.replace("a, c", "a")):
        rows = list(driving_measured(2))
    assert (rows[0]["driven"], rows[0]["least"]) == (0.0, 0.0)
    assert rows[1]["least"] == 19 * 5 <= rows[1]["driven"] <= 1.2 * 19 * 5


def test_the_table_tells_each_that_drives_and_counts_those_that_do_not() -> None:
    made = {"date": "2026-11-27", "version": "abc"}
    rows = [
        {"name": "lab 1", "size": 1, "driven": 0.0, "least": 0.0, **made},
        {"name": "lab 2", "size": 2, "driven": 22.0, "least": 20.0, **made},
        {"name": "lab 3", "size": 3, "driven": 7.0, "least": 0.0, **made},
    ]
    text = ordinary_page.driving({"driving": rows})
    assert "| lab 2 | 22 | 20 | 1.10 |" in text and "| lab 3 | 7 | 0 | - |" in text and "lab 1 " not in text
    assert "Of 3 scenarios that are won, in 1 nobody drives." in text
    assert "In 1 of the other 2 they drive at most 1.2 times the least that is known." in text
    assert "python -m benchmarks.ordinary" in ordinary_page.driving({})
