"""Constants of any size: no engine gives a wrong verdict, and what an engine cannot hold it does not take."""

from __future__ import annotations

import re
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import parse
from pursue_gen.outcomes import LimitHit
from pursue_gen.proof.checker import verify
from pursue_gen.synthesis import solve as solving
from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.synthesis.game import Game
from pursue_gen.synthesis.native.engine import NativeEngine
from pursue_gen.tga import ends_reported, scenario_objective, translate
from pursue_gen.tga.network import Network
from pursue_gen.zones.dbm import raw
from tests.cli.test_commands import pursue
from tests.oracle.engine import ReferenceEngine
from tests.synthesis.random_games import games
from tests.synthesis.test_engines import EVERY_KIND
from tests.synthesis.test_native import slower

NATIVE = NativeEngine()

FACTORS = st.sampled_from([10**3, 10**5, 10**6, 10**7, 2**25, 2**26, 2**27, 10**8, 2**28, 2**29, 2**30, 10**12, 10**17])

SCENARIO = """poi "desk"
poi "shelf"
connect desk and shelf distance {distance}
event "callBot"
event "fetch" location shelf
agent "bot" controllable mobile {mobile} location desk can_do fetch
agent "visitor" location desk can_do callBot
objective: if callBot then fetch within {deadline}
"""


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(games(EVERY_KIND, (0, 1)), FACTORS)
def test_long_times_change_no_verdict_of_the_reference(game: Game, factor: int) -> None:
    assert ReferenceEngine().solve(slower(game, factor)).won == ReferenceEngine().solve(game).won


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(games(EVERY_KIND, (0, 1)), FACTORS)
def test_the_native_engine_is_right_or_does_not_take_the_game(game: Game, factor: int) -> None:
    long = slower(game, factor)
    if NATIVE.holds(long):
        assert NATIVE.solve(long).won == NATIVE.solve(game).won
    else:
        with pytest.raises((ValueError, RuntimeError)):  # it would refuse it by itself
            NATIVE.solve(long)


def test_values_and_clocks_that_the_native_engine_does_not_hold() -> None:
    scenario = parse(SCENARIO.format(distance=1, mobile=1, deadline=3), "small.pur")
    game = compile_game(translate(scenario), scenario_objective(scenario))
    assert NATIVE.holds(game)
    assert not NATIVE.holds(replace(game, initial_values=(2**31, *game.initial_values[1:])))
    assert not NATIVE.holds(replace(game, clocks=tuple(f"c{k}" for k in range(128))))


def played(distance: int, mobile: int, deadline: int, reported: bool) -> Network:
    scenario = parse(SCENARIO.format(distance=distance, mobile=mobile, deadline=deadline), "x.pur")
    return ends_reported(translate(scenario), {}) if reported else translate(scenario)


def verdict(network: Network, reaction: Fraction) -> bool:
    """Whether it is won; the strategy is checked. Decided by the reference where the engine does not hold the game."""
    scenario = parse(SCENARIO.format(distance=1, mobile=1, deadline=1), "x.pur")
    objective = scenario_objective(scenario)
    try:
        found = solving.solve(network, objective, reaction)
    except LimitHit as problem:
        assert problem.diagnostics[0].code == "SYN012"
        found = solving.solve(network, objective, reaction, ReferenceEngine())
    if found.won:
        assert found.strategy is not None
        assert verify(network, objective, found.strategy, reaction).ok
    return found.won


@settings(max_examples=30, deadline=None, suppress_health_check=list(HealthCheck))
@given(
    st.sampled_from([1, 7, 999_983, 1_000_000]), st.sampled_from([1, 10, 997, 1_000_000]), st.integers(-3, 5),
    st.booleans(),
)  # fmt: skip
def test_every_scenario_that_the_language_allows_is_decided_rightly(
    distance: int, mobile: int, more: int, reported: bool
) -> None:
    """The way takes distance * mobile to one more; each command waits one first. The deadline decides."""
    way = distance * mobile
    deadline = way + more
    if not 1 <= deadline <= 1_000_000:
        return
    small = verdict(played(5, 1, 5 + more, reported), Fraction(0)) if 5 + more >= 1 else False
    assert verdict(played(distance, mobile, deadline, reported), Fraction(0)) == small


@pytest.mark.parametrize("mobile,status,code", [(1, 4, "SYN021"), (10, 5, "SYN012"), (11, 3, "PML144")])
def test_a_command_ends_with_a_verdict_or_a_code(tmp_path: Path, mobile: int, status: int, code: str) -> None:
    file = tmp_path / "far.pur"
    file.write_text(SCENARIO.format(distance=1_000_000, mobile=mobile, deadline=1_000_000))
    done = pursue("solve", file, "--no-explain")
    assert done.status == status and code in done.err, done.err


def test_a_plan_for_a_game_beyond_the_checker_is_not_decided(tmp_path: Path) -> None:
    file, game, query, plan = (tmp_path / name for name in ("small.pur", "TGA.xml", "TCTL.q", "plan.txt"))
    file.write_text(SCENARIO.format(distance=1, mobile=1, deadline=9))
    assert pursue("tga", file, "-o", tmp_path).status == 0
    assert pursue("solve", game, query, "-o", plan).status == 0
    game.write_text(re.sub(r'(kind="invariant".*;= [1-9])', r"\g<1>" + 16 * "0", game.read_text()))
    done = pursue("verify", game, query, plan)
    assert done.status == 5 and "SYN012: the checker cannot hold the game" in done.err, done.err


def test_numbers_without_end_are_an_error_with_a_code() -> None:
    assert raw(2**199, False) == 2**200 + 1
    for number in (2**200, -(2**200), 10**400):
        with pytest.raises(PursueError, match="too large"):
            raw(number, False)


def test_many_agents_with_a_clock_each_are_no_fault() -> None:
    bystanders = 50
    text = SCENARIO.format(distance=2, mobile=1, deadline=5)
    lines = text.splitlines()
    events = [f'event "wave{k}"' for k in range(bystanders)]
    agents = [f'agent "person{k}" location desk can_do wave{k}' for k in range(bystanders)]
    scenario = parse("\n".join([*lines[:5], *events, *lines[5:-1], *agents, lines[-1]]) + "\n", "crowd.pur")
    game = compile_game(translate(scenario), scenario_objective(scenario))
    assert len(game.clocks) > bystanders and NATIVE.holds(game)
    assert NATIVE.solve(game).won == (verdict(played(2, 1, 5, False), Fraction(0)))
