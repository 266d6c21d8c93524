"""Optional objectives: what can be promised with the rest, in the order of their numbers, and what is given up."""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any, FrozenSet, List, Tuple

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import parse
from pursue_gen.language.objectives import WhyGivenUp
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.sentences import promise_words
from pursue_gen.proof.checker import ProofReport
from pursue_gen.solving import optional, proving
from pursue_gen.solving.inputs import game_of
from pursue_gen.solving.optional import promised, promised_of, try_plan_of
from pursue_gen.solving.options import DEFAULT, SolveOptions
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import Solution, solution
from pursue_gen.solving.verdict import optional_json
from pursue_gen.synthesis.plan import write_plan
from pursue_gen.tga.network import Network, Objective

OFFICE = """\
poi "lobby"
poi "office"
poi "store"
connect lobby and office distance 3
connect lobby and store distance 4
event "mail" location office duration 1
event "fetch" location store duration 1
event "water" location lobby duration 2
agent "bot" controllable mobile 1 location lobby can_do mail, fetch, water
"""
MAIL = "reach_objective: do mail within 16\n"


def office(wanted: str) -> Scenario:
    return parse(OFFICE + wanted, "office.pur", "office")


def solve(scenario: Scenario, options: SolveOptions) -> Solution:
    return solution(*game_of(scenario), Rules(), options)


def kept(wanted: str) -> Tuple[int, ...]:
    return promised(office(wanted), DEFAULT, solve).scenario.optional


@pytest.mark.parametrize(
    ("more", "promised_numbers"),
    [
        ("", ()),
        ("optional 1 reach_objective: do fetch\noptional 2 reach_objective: do water", (1, 2)),
        ("optional 1 reach_objective: do fetch within 24\noptional 2 reach_objective: do water within 24", (1,)),
        ("optional 2 reach_objective: do fetch within 24\noptional 1 reach_objective: do water within 24", (1,)),
        ("optional 1 reach_objective: do fetch within 6\noptional 2 reach_objective: do water within 24", (2,)),
        ("optional 1 reach_objective: do fetch within 24\noptional 1 reach_objective: do water within 24", ()),
        ("optional 3 objective: avoid bot at store\noptional 7 reach_objective: do fetch", (3,)),
    ],
)
def test_what_cannot_be_promised_with_the_rest_is_given_up_the_greatest_number_first(
    more: str, promised_numbers: Tuple[int, ...]
) -> None:
    assert kept(MAIL + more) == promised_numbers


def test_the_solution_is_that_of_what_is_promised() -> None:
    found = promised(
        office(MAIL + "optional 1 reach_objective: do fetch within 24\noptional 2 reach_objective: do water within 24"),
        DEFAULT,
        solve,
    )
    assert found.solution.objective == game_of(found.scenario)[1]
    assert found.solution.objective.goal == (("reachObj", "win"), ("reachObj2", "win"))
    assert [one.why for one in found.scenario.given_up] == [WhyGivenUp.IMPOSSIBLE]
    assert optional_json(found.scenario) == {"optional": {"promised": [1], "given_up": [2], "undecided": []}}


def test_what_is_not_optional_has_to_be_promised() -> None:
    with pytest.raises(PursueError) as problem:
        kept("reach_objective: do mail within 3\noptional 1 reach_objective: do fetch")
    assert problem.value.exit_status == 4


def test_what_is_too_much_work_is_given_up_and_said_to_be_undecided(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(optional, "WORK", 1)
    # in one piece at once: else little work decides it before
    whole = replace(DEFAULT, whole=True)
    wanted = MAIL + "optional 1 reach_objective: do fetch"
    found = promised(office(wanted), whole, solve).scenario
    assert [one.why for one in found.given_up] == [WhyGivenUp.TOO_MUCH_WORK]
    assert optional_json(found) == {"optional": {"promised": [], "given_up": [1], "undecided": [1]}}


def test_an_optional_objective_whose_strategy_the_checker_refuses_is_not_called_impossible(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    verify = proving.verify

    def refusing(network: Network, objective: Objective, *rest: Any, **more: Any) -> ProofReport:
        report = verify(network, objective, *rest, **more)
        return report if len(objective.goal) == 1 else replace(report, ok=False, reason="no block says what to do")

    monkeypatch.setattr(proving, "verify", refusing)
    found = promised(office(MAIL + "optional 1 reach_objective: do fetch"), DEFAULT, solve).scenario
    assert optional_json(found) == {"optional": {"promised": [], "given_up": [1], "undecided": [1]}}
    (sentence,) = promise_words(found)
    assert "cannot be promised" not in sentence and "too much work" not in sentence
    assert "the independent checker refuses the strategy" in sentence


def test_a_plan_is_proven_for_the_most_that_it_promises(tmp_path: Path) -> None:
    scenario = office(MAIL + "optional 1 reach_objective: do fetch\noptional 2 reach_objective: do water within 3")
    found = promised_of(scenario, SolveRequest())
    assert found.scenario.optional == (1,)
    plan = tmp_path / "plan.txt"
    plan.write_text(write_plan(found.solution.strategy, found.solution.network, found.solution.objective))
    again = promised_of(scenario, SolveRequest(plan=plan))
    assert again.scenario == found.scenario
    choice, tried = try_plan_of(scenario, plan, SolveRequest(), DEFAULT)
    assert choice == found.scenario and tried[-1].solution is not None


WISHES = ["do fetch within 24", "do water within 24", "do water within 13", "do fetch and water within 26"]


@settings(max_examples=12)
@given(st.lists(st.sampled_from(WISHES), min_size=1, max_size=3, unique=True))
def test_no_better_choice_could_be_promised(wishes: List[str]) -> None:
    """Of all choices that can be promised it is the first one, where a smaller number counts more than all greater
    ones."""
    scenario = office(MAIL + "\n".join(f"optional {k} reach_objective: {wish}" for k, wish in enumerate(wishes, 1)))

    def can_be(given_up: FrozenSet[int]) -> bool:
        try:
            return bool(solve(scenario.giving_up(given_up), DEFAULT))
        except PursueError:
            return False

    numbers = range(1, len(wishes) + 1)
    ordered = product((True, False), repeat=len(wishes))
    choices = [frozenset(n for n, keep in zip(numbers, choice) if not keep) for choice in ordered]
    best = next(choice for choice in choices if can_be(choice))
    assert promised(scenario, DEFAULT, solve).scenario == scenario.giving_up(best)
