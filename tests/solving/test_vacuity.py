"""Objectives that hold because of assumptions alone."""

from __future__ import annotations

from pathlib import Path

import pytest

from pursue_gen.solving.vacuity import check_assumed_alone
from tests.assumptions import APART, AWAY, CAFE, GOODBYE, LEAVES, MUSEUM, ONCE, ROOMS, UNTOUCHED, scenario
from tests.tools.authoring.commands import pursue

NEVER = "assume: guest does call at_most 0 times"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (MUSEUM.format(f"{AWAY}\n{UNTOUCHED}"), "avoid touch: this holds without anything that robots do, as long as "
         "visitor is never at store"),
        (MUSEUM.format(f"{LEAVES}\n{AWAY}\n{UNTOUCHED}\n{GOODBYE}"), "as long as visitor is never at store"),
        (CAFE.format(NEVER), "if call then serve within 20"),
        (MUSEUM.format("assume: not visitor at store\nobjective: avoid visitor at store"), "it never holds that"),
    ],
)  # fmt: skip
def test_an_objective_that_others_keep_alone_is_named_with_what_is_assumed(text: str, words: str) -> None:
    (found,) = check_assumed_alone(scenario(text))
    assert found.code == "PML265" and words in found.message


@pytest.mark.parametrize(
    "text",
    [
        CAFE.format(ONCE),
        CAFE.format(""),
        ROOMS.format(APART),
        MUSEUM.format(f"{LEAVES}\n{UNTOUCHED}"),
        MUSEUM.format(f"{AWAY}\nobjective: bot never_with visitor at store"),
    ],
)
def test_what_robots_have_to_do_or_what_holds_anyway_is_not(text: str) -> None:
    assert list(check_assumed_alone(scenario(text))) == []


def test_several_assumptions_are_named_where_none_alone_suffices() -> None:
    both = "assume: visitor does touch at_most 0 times\nassume: visitor does look at_most 0 times"
    state = 'state "moved": initially false, true_if touch, look'
    (found,) = check_assumed_alone(scenario(MUSEUM.format(f"{state}\n{both}\nobjective: avoid moved is_true")))
    assert "never does touch and visitor never does look" in found.message


def test_check_and_solve_warn(tmp_path: Path) -> None:
    file = tmp_path / "story.pur"
    file.write_text(MUSEUM.format(f"{AWAY}\n{UNTOUCHED}"), encoding="utf-8")
    assert "warning PML265: avoid touch" in pursue("check", file).out
    assert "warning PML265: avoid touch" in pursue("solve", file).err
