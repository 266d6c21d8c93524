"""What has to happen several times, and apart: won, lost, what would help, and missions in which it does."""

from __future__ import annotations

from pathlib import Path

import pytest

from pursue_gen.explanation.explain import explain
from pursue_gen.outcomes import Lost
from pursue_gen.proof.checker import verify
from pursue_gen.solving.rules import Rules
from pursue_gen.synthesis.limits import Limits
from pursue_gen.tools.simulation.opponents import OPPONENTS
from pursue_gen.tools.simulation.outcome import GOAL, Settings
from tests.stories import files, missions, scenario, solved

SEEDLINGS = (Path(__file__).resolve().parents[2] / "scenarios" / "fields" / "seedlings.pur").read_text()

MAIL = """\
poi "desk"
poi "gate"
connect desk and gate distance 4
event "fetch" location gate
event "sort" location desk duration 2
agent "bot" controllable mobile 1 location desk can_do fetch, sort
reach_objective: do fetch {}
"""


def test_a_story_is_won_and_proven_and_lost_where_it_is_to_happen_once_more() -> None:
    won = solved(SEEDLINGS)
    assert verify(won.network, won.objective, won.strategy, won.reaction).ok
    with pytest.raises(Lost):
        solved(SEEDLINGS.replace("3 times", "4 times"))


@pytest.mark.parametrize(
    ("words", "wins"),
    [
        ("3 times within 12", True),
        ("3 times within 8", False),
        ("twice at_least 10 apart within 20", True),
        ("twice at_least 20 apart within 24", False),
        ("twice at_least 10 apart after 20 within 33", True),
    ],
)
def test_it_takes_as_long_as_it_says(words: str, wins: bool) -> None:
    if wins:
        assert solved(MAIL.format(words))
    else:
        with pytest.raises(Lost):
            solved(MAIL.format(words))


def test_less_often_and_less_far_apart_are_proposed() -> None:
    def changes(words: str) -> str:
        lost = explain(scenario(MAIL.format(words)), Rules(), Limits(1200.0))
        return "\n".join(change.sentence for change in lost.changes)

    assert "fetch once instead of 3 times" in changes("3 times within 8")
    found = changes("3 times at_least 10 apart within 22")
    assert "fetch twice instead of 3 times" in found and "instead of 10 apart" in found


@pytest.mark.parametrize("kind", sorted(OPPONENTS))
def test_simulated_missions_reach_it(kind: str) -> None:
    outcomes = missions(SEEDLINGS, 6, Settings(kind))
    assert {outcome.end for outcome in outcomes} == {GOAL} and not any(each.problems for each in outcomes)


def test_a_workspace_says_it() -> None:
    readme = files(SEEDLINGS)["README.md"].decode()
    assert "reaches `photo` 3 times, at least 25 time units apart, within 90 time units" in readme
