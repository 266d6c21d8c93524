"""Random strategies in stages: whatever the checker takes stage by stage wins the game as a whole."""

from __future__ import annotations

from fractions import Fraction
from typing import Optional

import pytest
from hypothesis import HealthCheck, event, given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.proof.checker import ProofReport, verify
from pursue_gen.synthesis.strategy import Strategy
from tests.oracle.checker import in_python
from tests.proof.staged_games import Game, damaged, games, staged
from tests.proof.staged_play import StagedPlay
from tests.proof.test_stages import of_the_whole

HALF = Fraction(1, 2)
RANDOM = settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))


@pytest.fixture(scope="module", autouse=True)
def twin() -> None:
    """Each test uses both checkers."""


def judged(game: Game, strategy: Strategy, reaction: Fraction = Fraction(0)) -> Optional[ProofReport]:
    """What both checkers say; None where the strategy speaks of clocks that its stage does not have."""
    network, objective = game
    try:
        found = verify(network, objective, strategy, reaction)
    except PursueError:
        return None
    with in_python():
        assert verify(network, objective, strategy, reaction) == found
    return found


def wins_as_a_whole_if_it_passes(game: Game, strategy: Strategy) -> None:
    found = judged(game, strategy)
    event("refused" if found is None else found.reason.split(":")[0] or "proven")
    if found is not None and found.ok:
        network, objective = game
        report = verify(network, objective, of_the_whole(network, strategy))
        assert report.ok, (report.reason, report.play)


@RANDOM
@given(data=st.data(), game=games())
def test_what_passes_stage_by_stage_wins_as_a_whole(data: st.DataObject, game: Game) -> None:
    strategy = data.draw(staged(game))
    if strategy is not None:
        wins_as_a_whole_if_it_passes(game, strategy)


@RANDOM
@given(data=st.data(), game=games(), seed=st.integers(0, 1000), damages=st.sampled_from((0, 0, 1)))
def test_what_passes_comes_to_the_goal_however_late_commands_are(
    data: st.DataObject, game: Game, seed: int, damages: int
) -> None:
    strategy = data.draw(staged(game, HALF))
    for _ in range(damages if strategy else 0):
        strategy = data.draw(damaged(game[0], strategy))
    found = None if strategy is None else judged(game, strategy, HALF)
    if strategy is not None and found is not None and found.ok:
        event("played")
        play = StagedPlay(*game, strategy, HALF)
        assert [play.broken(5 * seed + n) for n in range(5)] == [None] * 5


@RANDOM
@given(data=st.data(), game=games())
def test_what_is_damaged_and_passes_still_wins_as_a_whole(data: st.DataObject, game: Game) -> None:
    strategy = data.draw(staged(game))
    if strategy is None:
        return
    for _ in range(data.draw(st.integers(1, 2))):
        strategy = data.draw(damaged(game[0], strategy))
    wins_as_a_whole_if_it_passes(game, strategy)
