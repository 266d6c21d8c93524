"""Work as a limit and as a budget of several games: the same on every machine, whatever the time."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import List, Tuple

import pytest

from pursue_gen.diagnostics import PursueError, render
from pursue_gen.language import load, parse
from pursue_gen.outcomes import LimitHit
from pursue_gen.synthesis import limits as limits_module
from pursue_gen.synthesis.budget import Budget, TooLarge
from pursue_gen.synthesis.limits import Limits, Progress
from pursue_gen.synthesis.solve import solve
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Automaton, Guard, Network, Objective
from tests.conftest import thesis_scenario
from tests.large_scenarios import many_walkers
from tests.oracle import ENGINES

NOW = Fraction(0)
engines = pytest.mark.parametrize("engine", ENGINES)


@pytest.fixture(scope="module")
def game() -> Tuple[Network, Objective]:
    scenario = load(thesis_scenario("1"))
    return translate(scenario), scenario_objective(scenario)


@engines
def test_the_same_game_is_the_same_work(game: Tuple[Network, Objective], engine: str) -> None:
    first, second = (solve(*game, engine=ENGINES[engine]).stats.work for _ in range(2))
    assert first == second > 0
    assert solve(*game, engine=ENGINES[engine], limits=Limits(work=first)).won
    with pytest.raises(PursueError) as problem:
        solve(*game, engine=ENGINES[engine], limits=Limits(work=first // 2))
    assert problem.value.exit_status == 5
    assert f"the limit of {first // 2} units of work" in render(problem.value.diagnostics[0])


@engines
def test_a_limit_on_work_ends_a_large_game_at_the_same_state(engine: str) -> None:
    scenario = parse(many_walkers(), "crowd.pur")
    ends = set()
    for _ in range(2):
        with pytest.raises(PursueError) as problem:
            solve(translate(scenario), scenario_objective(scenario), engine=ENGINES[engine], limits=Limits(work=2000))
        ends.add(problem.value.diagnostics[0].message.split(" waiting")[0])
    assert len(ends) == 1


@engines
def test_games_share_a_budget(game: Tuple[Network, Objective], engine: str) -> None:
    work = solve(*game, engine=ENGINES[engine]).stats.work
    budget = Budget(Limits(work=100 * work + 10_000_000), engine=ENGINES[engine])
    before = budget.work
    assert budget.verdict(*game, NOW).won
    spent = before - budget.work
    assert spent > work
    assert budget.split(0.5).verdict(*game, NOW).won
    assert before - budget.work == 2 * spent, "what a part spends is spent of the whole"


def test_what_is_used_up_begins_no_game(game: Tuple[Network, Objective]) -> None:
    budget = Budget(Limits(work=1))
    for _ in range(2):
        with pytest.raises(PursueError) as problem:
            budget.verdict(*game, NOW)
        assert problem.value.exit_status == 5
    assert budget.used_up
    limits = Limits(seconds=1.0)
    assert Budget(limits.since(limits.now() - 2.0)).used_up
    assert not Budget(Limits()).used_up and Budget(Limits()).part().work == 0


def test_errors_of_a_game_are_passed_on(game: Tuple[Network, Objective]) -> None:
    with pytest.raises(PursueError) as refused:
        Budget(Limits()).verdict(*game, Fraction(-1))
    assert [finding.code for finding in refused.value.diagnostics] == ["SYN001"]


def test_progress_has_the_phase(game: Tuple[Network, Objective], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(limits_module, "_CHECK_INTERVAL", 0.0)
    monkeypatch.setattr(limits_module, "_REPORT_INTERVAL", 0.0)
    heard: List[Progress] = []
    assert Budget(Limits(), heard.append, ENGINES["python"], "explaining").verdict(*game, NOW).won
    assert {progress.phase for progress in heard} == {"explaining"}


@engines
def test_a_game_that_is_too_large_is_explored_once(engine: str) -> None:
    scenario = parse(many_walkers(), "crowd.pur")
    network, safe = translate(scenario), scenario_objective(scenario)
    large: List[TooLarge] = []
    budget = Budget(Limits(work=10_000_000, states=300), engine=ENGINES[engine], large=large)

    def spent(some: Network, **how: bool) -> float:
        before = budget.work
        with pytest.raises(LimitHit) as problem:
            budget.verdict(some, safe, NOW, **how)
        assert problem.value.which == "states"
        return before - budget.work

    explored = spent(network)
    assert explored > 300 and [(each.which, each.most) for each in large] == [("states", 300)]
    edges = spent(network)
    assert 0 < edges < explored, "it is not explored again"
    slower = replace(network, automata=tuple(map(_without_guards, network.automata)))
    assert spent(slower) == edges, "nor where only numbers differ"
    for states, tries in ((300, 1), (400, 2)):
        again = Budget(Limits(work=10_000_000, states=states), engine=ENGINES[engine], large=large)
        with pytest.raises(LimitHit):
            again.verdict(network, safe, NOW)
        assert len(large) == tries, "it is explored where more states are allowed"


@engines
def test_a_game_that_takes_too_much_work_is_tried_with_more_only(engine: str) -> None:
    scenario = parse(many_walkers(), "crowd.pur")
    network, safe = translate(scenario), scenario_objective(scenario)
    large: List[TooLarge] = []
    for work, tries in ((3_000_000, 1), (3_000_000, 1), (2_900_000, 1), (3_100_000, 2)):
        budget = Budget(Limits(work=work), engine=ENGINES[engine], large=large)
        with pytest.raises(LimitHit) as problem:
            budget.verdict(network, safe, NOW, 0.001)
        assert problem.value.which == "work" and len(large) == tries


def _without_guards(automaton: Automaton) -> Automaton:
    return replace(automaton, edges=tuple(replace(edge, guard=Guard()) for edge in automaton.edges))
