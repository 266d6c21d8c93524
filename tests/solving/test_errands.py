"""Errands that keep a robot from its patrol for too long."""

from __future__ import annotations

from typing import Tuple

import pytest
from hypothesis import event, given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import parse
from pursue_gen.outcomes import Lost
from pursue_gen.solving.errands import excluded_by_an_errand
from pursue_gen.solving.rules import DEFAULT, Rules, played
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.synthesis.solve import solve
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Network, Objective

FLOOR = """
poi "base"
poi "hall"
poi "shop"
connect base and hall distance 2
connect hall and shop distance 3
event "ask"
event "job" location shop duration 1
agent "bot1" controllable mobile 1 location hall can_do job
agent "bot2" controllable mobile 1 location hall
agent "people" location base can_do ask
objective: if ask then job within 90
objective: patrol base every 20 by bot1
"""
"""From base to the shop, the job, and back: 3, 1, 4, 1, 2, 1, 4, 1 and 3 time units at most; each 1 is a rest."""


def game(text: str, rules: Rules = DEFAULT) -> Tuple[Network, Objective]:
    scenario = parse(text, "floor.pur", "floor")
    return played(translate(scenario), rules), scenario_objective(scenario)


def test_who_is_away_for_longer_than_the_period_cannot_do_it() -> None:
    for period, lost in ((19, True), (20, False), (22, False)):
        network, objective = game(FLOOR.replace("every 20", f"every {period}"))
        assert excluded_by_an_errand(network, objective) == ((objective,) if lost else ())
    assert not solve(*game(FLOOR), DEFAULT.reaction).won
    assert solve(*game(FLOOR.replace("every 20", "every 22")), DEFAULT.reaction).won


def test_the_statements_are_named() -> None:
    more = FLOOR.replace("every 20", "every 19") + "objective: bot1 never_with bot2 at shop\n"
    network, objective = game(more)
    (found,) = excluded_by_an_errand(network, objective)
    assert [name for name, _ in found.bad] == ["obj", "obj2"]
    with pytest.raises(PursueError) as problem:
        solve_scenario(parse(more, "floor.pur", "floor"), DEFAULT)
    assert isinstance(problem.value, Lost)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        pytest.param("by bot1", "by any robot", id="another robot visits the place"),
        pytest.param("location hall\nagent", "location hall can_do job\nagent", id="another robot does it"),
        pytest.param("location shop", "location base", id="it is done at the place"),
        pytest.param(" can_do ask", "", id="nobody asks"),
        pytest.param("location base can_do ask", "location base can_do ask\nassume: people does ask at_most 1 times",
                     id="it may have been done before the first visit"),
    ],
)  # fmt: skip
def test_what_may_be_kept_is_not_excluded(old: str, new: str) -> None:
    text = FLOOR.replace("every 20", "every 19")
    assert old in text
    assert excluded_by_an_errand(*game(text.replace(old, new))) == ()


@settings(max_examples=40, deadline=None)
@given(st.tuples(*[st.integers(1, 4)] * 2), st.integers(0, 2), st.integers(5, 24), st.sampled_from(("base", "shop")))
def test_what_is_excluded_is_lost_in_the_exact_game(ways: Tuple[int, int], job: int, period: int, start: str) -> None:
    text = FLOOR.replace("distance 2", f"distance {ways[0]}").replace("distance 3", f"distance {ways[1]}")
    text = text.replace(" duration 1", f" duration {job}" if job else "").replace("every 20", f"every {period}")
    network, objective = game(text.replace("location hall can_do job", f"location {start} can_do job"))
    excluded = bool(excluded_by_an_errand(network, objective))
    won = solve(network, objective, DEFAULT.reaction).won
    event(f"{'excluded' if excluded else 'not excluded'}, {'won' if won else 'lost'}")
    assert not (excluded and won)
