"""How late commands may come: margins of strategies and of games."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.language import load
from pursue_gen.proof.checker import verify
from pursue_gen.proof.margin import CAP, STEP, Margin, describe, game_margin, in_words, strategy_margin
from pursue_gen.solving.rules import IDEAL, Rules
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.synthesis.solve import solve
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga.network import Kind, Network, Objective
from tests.cli.test_commands import pursue
from tests.conftest import thesis_scenario
from tests.proof.test_checker import REACH, automaton, block, edge, moves, network
from tests.proof.test_checker_random import networks
from tests.synthesis.random_games import objectives

NOW = Fraction(0)
NET = network(automaton("bot", "a:x<=3 win", edge("a", "win", "x>1")))


def plan(wait: str, act: str) -> Strategy:
    return Strategy((block(NET, "a", [wait], (act, moves(NET, ("bot", 0)))),))


@pytest.mark.parametrize(
    ("wait", "act", "margin"),
    [
        ("x<=1", "x>1", Margin(Fraction(39, 20), Fraction(2))),
        ("x<=2", "x>2", Margin(Fraction(19, 20), Fraction(1))),
        ("x<2", "x>=2", Margin(Fraction(1), Fraction(21, 20))),
        ("x<3", "x>=3", Margin(NOW, STEP)),
    ],
)
def test_the_margin_counts_from_the_moment_at_which_a_command_is_due(wait: str, act: str, margin: Margin) -> None:
    assert strategy_margin(NET, REACH, plan(wait, act), NOW) == margin


def test_a_strategy_that_need_not_hurry_has_the_largest_margin() -> None:
    net = network(automaton("bot", "a win", edge("a", "win", "x>1")))
    calm = Strategy((block(net, "a", ["x<=1"], ("x>1", moves(net, ("bot", 0)))),))
    assert strategy_margin(net, REACH, calm, NOW) == game_margin(net, REACH, NOW) == Margin(CAP, None)


def test_a_game_may_stand_more_delay_than_a_strategy_for_it() -> None:
    assert strategy_margin(NET, REACH, plan("x<=2", "x>2"), NOW).wins < game_margin(NET, REACH, NOW).wins


def test_with_little_to_spend_the_margin_is_at_least_what_is_known() -> None:
    late = plan("x<=1", "x>1")
    assert strategy_margin(NET, REACH, late, Fraction(1, 3), states=0) == Margin(Fraction(1, 3), None)
    assert strategy_margin(NET, REACH, late, NOW, states=3).wins < Fraction(39, 20)


def test_with_far_more_blocks_than_states_to_spend_nothing_is_played(monkeypatch: pytest.MonkeyPatch) -> None:
    def played(*_: object, **__: object) -> None:
        raise AssertionError("each look at such a strategy costs far more than it may tell")

    large = Strategy(11 * plan("x<=1", "x>1").blocks)
    assert strategy_margin(NET, REACH, plan("x<=1", "x>1"), NOW, states=1).fails is None
    monkeypatch.setattr("pursue_gen.proof.margin.verify", played)
    assert strategy_margin(NET, REACH, large, NOW, states=1) == Margin(NOW, None)


@settings(max_examples=40)
@given(networks(), st.sampled_from(list(Kind)).flatmap(objectives))
def test_it_wins_at_the_margin_and_not_beyond_and_no_more_than_the_game(net: Network, objective: Objective) -> None:
    strategy = solve(net, objective).strategy
    if strategy is None or not verify(net, objective, strategy).ok:
        return
    margin = strategy_margin(net, objective, strategy, NOW)
    assert verify(net, objective, strategy, margin.wins, prompt=True).ok
    if margin.fails is not None:
        assert margin.fails <= margin.wins + STEP
        assert not verify(net, objective, strategy, margin.fails, prompt=True).ok


@pytest.mark.parametrize("number", ["1", "2", "3", "4"])
def test_the_thesis_s_scenarios_can_be_played_at_leisure_but_not_in_the_ideal_game(number: str) -> None:
    scenario = load(thesis_scenario(number))
    won = solve_scenario(scenario, Rules())
    assert strategy_margin(won.network, won.objective, won.strategy, won.reaction).wins == CAP
    ideal = solve_scenario(scenario, IDEAL)
    margin = strategy_margin(ideal.network, ideal.objective, ideal.strategy, ideal.reaction)
    assert margin.wins < 1
    assert "no real robot" in describe(margin, ideal.strategy)


def test_the_thief_is_caught_with_commands_that_are_late_but_not_by_the_ideal_strategy() -> None:
    scenario = load(thesis_scenario("catch_the_thief"))
    won, ideal = solve_scenario(scenario, Rules()), solve_scenario(scenario, IDEAL)
    assert strategy_margin(won.network, won.objective, won.strategy, won.reaction).wins >= Fraction(1, 10)
    margin = strategy_margin(ideal.network, ideal.objective, ideal.strategy, ideal.reaction)
    assert margin.wins == 0
    assert describe(margin, ideal.strategy).startswith("Margin 0: it loses when a command takes effect 0.05 time units")


def test_margins_in_words_and_as_json() -> None:
    some, most = Margin(Fraction(7, 20), Fraction(2, 5)), Margin(CAP, None)
    assert in_words(some) == "0.35, not 0.4" and in_words(most) == "at least 10"
    assert some.as_json() == {"wins": 0.35, "fails": 0.4} and most.as_json() == {"wins": 10, "fails": None}
    late = "Margin: it still wins when commands take effect 0.35 time units late, not 0.4."
    assert describe(some, plan("", "")) == late


def test_solve_tells_both_margins_and_what_no_robot_can_play() -> None:
    file = thesis_scenario("1")
    told_ = pursue("solve", file, "--json", "--margin")
    found = json.loads(told_.out)
    assert found["margin"] == found["game_margin"] == {"wins": 10, "fails": None} and found["playable"] is True
    assert "10 time units late" in told_.err and "Margin of the game" in told_.err
    ideal = pursue("solve", file, "--json", "--ends", "controllable", "--reaction", "0")
    found = json.loads(ideal.out)
    assert found["playable"] is False and "game_margin" not in found and "no real robot" in ideal.err


def test_report_and_workspaces_tell_the_margin(tmp_path: Path) -> None:
    file = thesis_scenario("1")
    assert "ideal game: Margin 0: it loses when a command takes effect 0.05" in pursue("report", file).out
    assert json.loads(pursue("report", file, "--json").out)["margins"]["ideal"] == {"wins": 0, "fails": 0.05}
    pursue("ws", file, "-o", tmp_path / "ws")
    assert "it still wins when commands take effect 10 time units late" in (tmp_path / "ws" / "README.md").read_text()
