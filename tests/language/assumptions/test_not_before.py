"""`assume: guest does call after 30`: what is won because of it, and what a mission makes of a guest who is early."""

from __future__ import annotations

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.explanation.explain import explain
from pursue_gen.language.checks import check
from pursue_gen.outcomes import Lost
from pursue_gen.proof.checker import verify
from pursue_gen.solving.rules import Rules
from pursue_gen.synthesis.limits import Limits
from pursue_gen.tools.simulation.opponents import OPPONENTS
from pursue_gen.tools.simulation.outcome import GOAL, Settings
from pursue_runtime.observer.mission import Mission
from pursue_runtime.state import HOLDING
from pursue_runtime.strategy import read_cover
from tests.assumptions import files, free_model, missions, model, scenario, solved
from tests.plays import Play

SHOP = """\
poi "desk"
poi "store"
connect desk and store distance 4
event "stock" location store duration 5
event "call" location desk
event "serve" location desk
agent "bot" controllable mobile 1 location desk can_do stock, serve
agent "guest" location desk can_do call
{}
objective: if call then serve within 4
reach_objective: do stock and serve
"""
"""A robot that fills the shelves before guests come, at whose calls it has to be at the desk."""

LATER = "assume: guest does call after 30"


def test_it_is_won_because_of_the_assumption_and_proven() -> None:
    won = solved(SHOP.format(LATER))
    assert verify(won.network, won.objective, won.strategy, won.reaction).ok
    for said in ("", LATER.replace("30", "10")):
        with pytest.raises(Lost):
            solved(SHOP.format(said))


def test_where_it_is_too_soon_a_later_time_is_proposed() -> None:
    lost = scenario(SHOP.format(LATER.replace("30", "5")))
    changes = explain(lost, Rules(), Limits(1200.0)).changes
    assert [each.sentence for each in changes if each.what == "assumption"] == [
        "assume: guest does call after 11 instead of 5"
    ]


@pytest.mark.parametrize(
    ("said", "code"),
    [
        ("assume: guest does call after 0", "PML251"),
        (f"{LATER}\n{LATER.replace('30', '40')}", "PML253"),
        ("assume: guest does serve after 30", "PML254"),
        ("assume: bot does serve after 30", "PML250"),
    ],
)
def test_what_cannot_be_assumed(said: str, code: str) -> None:
    assert [finding.code for finding in check(scenario(SHOP.format(said)))] == [code]


@given(st.integers(0, 10**6))
def test_in_random_plays_nobody_is_early(seed: int) -> None:
    play = Play(scenario(SHOP.format(LATER)))
    play.run(12, seed)
    times = play.course.done.get(("guest", "call"), [])
    assert all(begun > 30 for begun, _ in times)


@given(st.floats(1.5, 29.9) | st.floats(30.1, 60))
def test_the_network_excludes_what_is_early_and_nothing_else(moment: float) -> None:
    kept, free = (free_model(SHOP.format(said)) for said in (LATER, ""))
    here = kept.initial().aged(moment)
    assert free.joint_move(free.initial().aged(moment), "call", "guest")
    assert bool(kept.joint_move(here, "call", "guest")) == (moment > 30)


def test_a_guest_who_is_early_has_called_and_breaks_it() -> None:
    text = SHOP.format(LATER)
    cover = read_cover(yaml.safe_load(files(text)["src/observer/config/cover.yaml"]))
    mission = Mission(model(text), cover, lambda level, line: None, on_uncovered="plan", lost_after=10.0)
    mission.on_word("_start_", 0.0)
    mission.on_word("call", 20.0)
    state = mission.state(20.0)
    assert (state.status, state.event, state.values["assume1"]) == (HOLDING, "call", 0)
    assert "guest does call only later than 30 units after the start" in state.reason
    assert mission.counts["untimely"] == 0


@pytest.mark.parametrize("kind", sorted(OPPONENTS))
def test_simulated_guests_keep_to_it(kind: str) -> None:
    outcomes = missions(SHOP.format(LATER), 10, Settings(kind))
    assert {outcome.end for outcome in outcomes} == {GOAL}
