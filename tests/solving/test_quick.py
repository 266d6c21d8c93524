"""Default strategies are quick missions; `--within` answers whether a time can be kept."""

from __future__ import annotations

import functools
import json
from fractions import Fraction
from pathlib import Path
from typing import Tuple

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import load, parse
from pursue_gen.proof.checker import verify
from pursue_gen.solving import quick as quick_module
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.quick import quick, within
from pursue_gen.solving.rules import DEFAULT, IDEAL, Rules
from pursue_gen.solving.solution import Solution, guaranteed, solution
from pursue_gen.solving.solvers import solved
from pursue_gen.synthesis.limits import Limits
from pursue_gen.synthesis.solve import solve
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Kind, Network, Objective
from pursue_gen.tga.uppaal import read_network, read_query
from tests.cli.test_commands import pursue
from tests.conftest import thesis_scenario
from tests.synthesis.random_games import networks

NOW = SolveOptions()
FIRST, THIEF = thesis_scenario("1"), thesis_scenario("1").with_name("catch_the_thief.pur")
LEAST = {"1": "23.3", "2": "23.3", "3": "23.4", "4": "26.4"}


def _game(file: Path) -> Tuple[Network, Objective]:
    scenario = load(str(file))
    return translate(scenario), scenario_objective(scenario)


def _published(folder: Path, name: str) -> Tuple[Network, Objective]:
    network = read_network((folder / name / "TGA.xml").read_text(), "TGA.xml")
    return network, read_query((folder / name / "TCTL.q").read_text(), "TCTL.q")


@functools.lru_cache(maxsize=None)
def _found(file: Path) -> Solution:
    return solved(*_game(file), Rules())


def _is_quick(found: Solution, least: str) -> None:
    """It takes at most a tenth longer than the least worst-case time, and wins, as the checker sees it."""
    guarantee = found.guarantee
    assert guarantee is not None and guarantee.worst is not None
    assert guarantee.least <= Fraction(least) <= guarantee.worst <= Fraction(11, 10) * Fraction(least)
    assert verify(found.network, found.objective, found.strategy, found.reaction).ok


@pytest.mark.parametrize("number", LEAST)
def test_the_thesis_scenarios_are_quick(number: str) -> None:
    _is_quick(_found(thesis_scenario(number)), LEAST[number])


def test_the_thief_is_caught_quickly() -> None:
    _is_quick(_found(THIEF), "20.6")


@pytest.mark.parametrize(("name", "least"), [("CT1", "61.9"), ("CT2a", "79.2"), ("CT4", "117.8")])
def test_published_scenarios_are_quick(reference_dir: Path, name: str, least: str) -> None:
    _is_quick(solved(*_published(reference_dir, name), Rules()), least)


@pytest.mark.parametrize(("file", "worst"), [("drug_delivery/drug_delivery", "22"), ("fields/two_robot_farm", "76")])
def test_where_the_order_of_time_does_not_help_games_with_a_deadline_do(file: str, worst: str) -> None:
    found = _found(FIRST.parent.parent / f"{file}.pur")
    assert found.guarantee is not None and found.guarantee.worst is not None
    assert found.guarantee.worst <= Fraction(worst) <= Fraction(6, 5) * found.guarantee.least
    assert verify(found.network, found.objective, found.strategy, found.reaction).ok


def test_plans_hold_multiples_of_the_unit_and_of_the_reaction() -> None:
    for file in ("catch_the_thief/one_officer", "fields/two_robot_farm", "thesis/catch_the_thief"):
        strategy = _found(FIRST.parent.parent / f"{file}.pur").strategy
        zones = [zone for block in strategy.blocks for zone in block.wait]
        zones += [zone for block in strategy.blocks for command in block.commands for zone in command.zones]
        assert all((10 * constraint.bound).denominator == 1 for zone in zones for constraint in zone), file


def test_the_same_strategy_comes_out_however_long_it_takes() -> None:
    assert _found(THIEF).strategy == solved(*_game(THIEF), Rules(), SolveOptions(Limits(3600.0))).strategy


def test_without_work_the_first_strategy_stays(monkeypatch: pytest.MonkeyPatch) -> None:
    first = solution(*_game(THIEF), Rules())
    monkeypatch.setattr(quick_module, "WORK", 1)
    found = quick(first, NOW)
    assert found.strategy == first.strategy
    assert found.guarantee is not None and found.guarantee.worst == guaranteed(first, quick_module.STATES).worst


def test_after_a_hard_game_the_first_strategy_stays(monkeypatch: pytest.MonkeyPatch) -> None:
    first = solution(*_game(THIEF), Rules())
    assert first.stats is not None and quick(first, NOW).strategy != first.strategy
    monkeypatch.setattr(quick_module, "_HARD", first.stats.work - 1)
    found = quick(first, NOW)
    assert found.strategy == first.strategy
    assert found.guarantee is not None and found.guarantee.worst is not None


def test_the_first_strategy_can_be_asked_for() -> None:
    game = _game(THIEF)
    assert solved(*game, Rules(), SolveOptions(optimize="none")).strategy == solution(*game, Rules()).strategy


@pytest.mark.parametrize(("deadline", "won"), [("23.2", False), ("23.31", True), ("40", True)])
def test_a_time_can_be_kept_or_not(deadline: str, won: bool) -> None:
    first = solution(*_game(FIRST), Rules())
    if won:
        found = within(first, Fraction(deadline), NOW)
        assert found.within == Fraction(deadline)
        assert found.guarantee is not None and found.guarantee.worst is not None
        assert found.guarantee.worst <= Fraction(deadline)
        return
    with pytest.raises(PursueError, match=f"within {deadline} time units") as problem:
        within(first, Fraction(deadline), NOW)
    assert problem.value.exit_status == 4
    assert problem.value.diagnostics[0].code == "SYN023"


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(networks((Kind.REACH, Kind.REACH_WHILE_SAFE)), st.sampled_from((0, 1)), st.integers(0, 8))
def test_on_random_games_what_is_quick_wins_and_what_is_within_agrees(
    drawn: Tuple[Network, Objective], delay: int, deadline: int
) -> None:
    (network, objective), rules = drawn, Rules("controllable", Fraction(delay))
    if not solve(network, objective, rules.reaction).won:
        return
    first = solution(network, objective, rules)
    found = quick(first, NOW)
    assert verify(found.network, objective, found.strategy, rules.reaction).ok
    guarantee = found.guarantee
    assert guarantee is not None
    assert guarantee.worst is None or guarantee.least <= guarantee.worst
    try:
        kept = within(first, Fraction(deadline), NOW)
    except PursueError as problem:
        assert problem.exit_status == 4
        assert guarantee.worst is None or guarantee.worst > deadline
    else:
        assert kept.guarantee is not None and kept.guarantee.worst is not None
        assert guarantee.least <= deadline and kept.guarantee.worst <= deadline


def test_the_command_answers_with_a_sentence_and_a_status(tmp_path: Path) -> None:
    won = pursue("solve", FIRST, "--within", "23.4", "-o", tmp_path / "plan.txt")
    assert won.status == 0
    assert "won within 23.4 time units" in won.err
    assert "nothing below 23.3 can be promised" in won.err
    lost = pursue("solve", FIRST, "--within", 20, "--json")
    assert lost.status == 4
    verdict = json.loads(lost.out)
    assert verdict["won"] is False
    assert verdict["diagnostics"][0]["code"] == "SYN023"
    assert "it can be guaranteed within 23.4: --within 23.4" in verdict["diagnostics"][0]["hint"]
    assert pursue("ws", FIRST, "--within", 20, "-o", tmp_path / "ws").status == 4
    assert not (tmp_path / "ws").exists()


@pytest.mark.parametrize(
    "options",
    [("--within", "soon"), ("--within", "-1"), ("--within", "30", "--optimize", "time")],
)
def test_what_makes_no_sense_is_refused(options: Tuple[str, ...]) -> None:
    assert pursue("solve", FIRST, *options).status == 2


def test_a_safety_objective_has_no_time_to_keep() -> None:
    done = pursue("solve", FIRST.parent.parent / "work_cell" / "work_cell.pur", "--within", 60)
    assert done.status == 2 and "SYN022" in done.err


def test_solve_and_ws_tell_the_same(tmp_path: Path) -> None:
    first, second = pursue("solve", THIEF), pursue("ws", THIEF, "-o", tmp_path / "thief")
    for begin in ("Time to the goal:", "Margin:"):
        told = [line for text in (first.err, second.err) for line in text.splitlines() if line.startswith(begin)]
        assert len(told) == 2 and told[0] == told[1]


@pytest.mark.parametrize(
    "rest, stays", [("", "mobile 3 location hall or room2"), ("rest 0.4\n", "location hall can_do blink")]
)
def test_a_quicker_strategy_wins_the_game_itself_too_where_others_stay_for_less_than_a_time_unit(
    rest: str, stays: str
) -> None:
    """It is proven in a game whose times are multiples of a smaller unit."""
    text = f"""\
{rest}poi "hall"
poi "room1"
poi "room2"
connect hall and room1 distance 2
connect hall and room2 distance 1
event "call"
event "blink" duration 0.3 to 0.5
event "answer" location room1 duration 3
agent "bot" controllable mobile 2 location room2 can_do answer
agent "child" {stays}
agent "guest" location room1 can_do call
assume: guest does call at_most 1 times
objective: if call then answer within 29
reach_objective: do answer twice at_least 5 apart
"""
    scenario = parse(text, "x.pur")
    for rules in (IDEAL, DEFAULT):
        won = solved(translate(scenario), scenario_objective(scenario), rules)
        assert verify(won.network, won.objective, won.strategy, won.reaction).ok
