"""Random small games of the benchmarks: the same each time, small, judged alike by all solvers; and their table."""

from __future__ import annotations

from dataclasses import replace
from typing import Optional

import pytest

from benchmarks import random_page
from benchmarks.measure import Bounds
from benchmarks.random_games import LEAST, Played, drawn, random_game, summary
from pursue_gen.solving.rules import IDEAL, Rules
from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.tga.network import Kind

pytestmark = pytest.mark.benchmark

GAME = Played(7, 40, True, 0.05, True, 0.01, None)


@pytest.mark.parametrize("kind", list(Kind))
def test_a_number_gives_the_same_game_and_others_give_others(kind: Kind) -> None:
    games = [random_game(number, kind) for number in range(20)]
    assert games == [random_game(number, kind) for number in range(20)]
    assert len({repr(game) for game in games}) == len(games)
    for network, objective in games:
        assert compile_game(network, objective).kind is kind


@pytest.mark.parametrize("rules", [IDEAL, Rules()])
@pytest.mark.parametrize("kind", list(Kind))
def test_solvers_agree_on_games_of_the_size_that_is_wanted(kind: Kind, rules: Rules) -> None:
    for game in drawn(4, kind, rules):
        assert game.won is not None and game.plainly_won is not None and game.agreed
        assert LEAST <= game.states <= random_page.MOST


def test_the_kinds_are_those_of_objectives() -> None:
    assert sorted(random_page.KINDS) == sorted(kind.value for kind in Kind)


@pytest.mark.parametrize(
    ("won", "plainly", "regions", "agreed"),
    [
        (True, True, True, True),
        (False, False, None, True),
        (None, False, None, True),
        (True, False, None, False),
        (True, True, False, False),
        (None, True, False, False),
    ],
)
def test_verdicts_that_differ_are_noticed(
    won: Optional[bool], plainly: Optional[bool], regions: Optional[bool], agreed: bool
) -> None:
    assert replace(GAME, won=won, plainly_won=plainly, regions=regions).agreed is agreed


def test_a_game_may_take_twenty_times_the_plain_solver_and_a_tenth_of_a_second_and_is_decided() -> None:
    slow = replace(GAME, number=8, seconds=0.31)
    row = summary(Kind.REACH, "ideal", [GAME, slow, replace(GAME, won=None)])
    assert (row["games"], row["above"], row["undecided"], row["disagreed"]) == (3, 2, 1, 0)
    assert row["slowest"]["number"] == row["closest"]["number"] == 8
    text = random_page.table([row])
    assert "2 above 20 times the plain solver plus 0.1 s" in text and "| reach | ideal | 3 |" in text
    assert "2 above" in random_page.terminal(row)


def test_they_are_measured_in_another_process() -> None:
    rows = list(random_page.random_measured(1, Bounds(600.0, 4096)))
    assert [(row["name"], row["game"], row["games"]) for row in rows] == [
        (kind.value, game, 1) for kind in Kind for game in ("ideal", "default")
    ]


def test_a_process_that_fails_gives_its_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    from benchmarks.process import Ran

    monkeypatch.setattr(random_page, "run", lambda *_: Ran(1, False, "", "Traceback\nMemoryError", 1.0, 50.0))
    (row,) = random_page.random_measured(1, Bounds(600.0, 4096))
    assert "MemoryError" in random_page.terminal(row)
    assert "0 games" in random_page.table([row])
