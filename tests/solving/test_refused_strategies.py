"""A strategy that the checker refuses is no end: the game is won, and another one is proven."""

from __future__ import annotations

from fractions import Fraction

from benchmarks.random_games import random_game
from pursue_gen.proof.checker import verify
from pursue_gen.solving.rules import Rules, played
from pursue_gen.solving.solution import solution
from pursue_gen.synthesis.solve import solve
from pursue_gen.tga.network import Kind


def test_where_the_first_strategy_goes_round_in_circles_one_in_the_order_of_time_is_proven() -> None:
    network, objective = random_game(356, Kind.REACH_WHILE_SAFE)
    rules = Rules(reaction=Fraction(1))
    first = solve(played(network, rules), objective, rules.reaction)
    assert first.won and first.strategy is not None
    won = solution(network, objective, rules)
    assert verify(won.network, objective, won.strategy, rules.reaction).ok
