"""What the environment wins with a single call of each agent is lost, and sooner seen to be."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import HealthCheck, event, given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import parse
from pursue_gen.outcomes import LimitHit
from pursue_gen.proof.checker import verify
from pursue_gen.solving.options import DEFAULT
from pursue_gen.solving.rules import Rules, played
from pursue_gen.solving.without_pauses import lost_to_few_calls, verdict_of
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.limits import Limits
from pursue_gen.synthesis.solve import solve
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Kind, Network, Objective
from pursue_gen.tga.pauses import acting_at_most, pauses, with_calls_that_are_heard
from tests.oracle import ENGINES
from tests.proof.test_left_out_clocks import networks
from tests.solving.test_callers import HOTEL

WANTED = st.sampled_from([Objective(kind, (("A0", "l2"),), (("A0", "l1"),)) for kind in Kind])
LITTLE = Limits(work=8_000_000)
SOON = HOTEL.replace("callOne then serveOne within 20", "callOne then serveOne within 3")


@pytest.mark.parametrize(("text", "won"), [(HOTEL, True), (SOON, False)])
def test_both_verdicts_take_little_work(text: str, won: bool) -> None:
    scenario = parse(text, "hotel.pur", "hotel")
    game, objective, rules = played(translate(scenario), Rules()), scenario_objective(scenario), Rules()
    with pytest.raises(PursueError):
        solve(game, objective, rules.reaction, limits=Limits(work=4_000_000))
    assert verdict_of(Budget(Limits(work=16_000_000)), game, objective, rules.reaction).won is won
    assert lost_to_few_calls(game, objective, rules.reaction, DEFAULT) is not won


NARROW = """poi "hall"
poi "east"
poi "west"
connect hall and east distance 3
connect hall and west distance 3
event "ring"
event "look" location east duration 2
agent "otto" controllable mobile 1 location west can_do look
agent "guest" location hall can_do ring
objective: if ring then look within {deadline}
objective: patrol west every 24 by otto
"""


@pytest.mark.parametrize(("deadline", "won"), [("24.5", False), ("24.7", True), ("25", True)])
def test_calls_that_only_begin_a_pause_lose_no_game_that_is_won_without_them(deadline: str, won: bool) -> None:
    scenario = parse(NARROW.format(deadline=deadline), "narrow.pur", "narrow")
    game, objective, rules = played(translate(scenario), Rules()), scenario_objective(scenario), Rules()
    verdict = solve(game, objective, rules.reaction)
    assert verdict.won is won is verdict_of(Budget(Limits(work=16_000_000)), game, objective, rules.reaction).won
    if verdict.strategy is not None:
        assert verify(game, objective, verdict.strategy, rules.reaction).ok


def test_a_first_call_that_changes_nothing_is_not_counted_as_a_move() -> None:
    # Each of four guests may ring once: rings that only repeat the first one would make four commands late.
    guests = "".join(f'agent "guest{k}" location hall can_do ring\n' for k in range(4))
    scenario = parse(NARROW.format(deadline="24.7") + guests, "narrow.pur", "narrow")
    game, objective, rules = played(translate(scenario), Rules()), scenario_objective(scenario), Rules()
    assert not lost_to_few_calls(game, objective, rules.reaction, DEFAULT)
    assert solve(game, objective, rules.reaction, without_pauses=True).won


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(networks(), WANTED, st.sampled_from((Fraction(0), Fraction(1, 2))))
def test_without_calls_that_nobody_hears_the_environment_has_less_and_without_pauses_more(
    network: Network, objective: Objective, reaction: Fraction
) -> None:
    heard = with_calls_that_are_heard(network)
    event(f"pauses: {bool(pauses(network))}, calls: {heard is not network}")
    less, twin = (solve(heard, objective, reaction, engine, limits=LITTLE).won for engine in ENGINES.values())
    assert less is twin
    assert less or not solve(network, objective, reaction, limits=LITTLE, without_pauses=True).won
    try:
        assert less or not solve(network, objective, reaction, limits=LITTLE).won
    except LimitHit:
        assert less


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(networks(), WANTED, st.sampled_from((Fraction(0), Fraction(1, 2))), st.integers(0, 2))
def test_what_is_lost_to_few_calls_is_lost(
    network: Network, objective: Objective, reaction: Fraction, times: int
) -> None:
    few = solve(acting_at_most(network, objective, times), objective, reaction, limits=LITTLE)
    exact = solve(network, objective, reaction, limits=LITTLE)
    event("both" if few.won is exact.won else "few calls are not enough")
    assert few.won or not exact.won
