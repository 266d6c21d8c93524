"""`assume: visitor at exit by 60`: what is won because of it, and that whoever has to be there in time always can."""

from __future__ import annotations

import random

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.language.checks import check
from pursue_gen.outcomes import Lost
from pursue_gen.proof.checker import verify
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.uppaal import read_network, write_network
from pursue_gen.tools.simulation.opponents import OPPONENTS
from pursue_gen.tools.simulation.outcome import GOAL, Settings
from pursue_runtime.observer.mission import Mission
from pursue_runtime.state import HOLDING
from pursue_runtime.strategy import read_cover
from tests.assumptions import files, free_model, missions, model, scenario, solved
from tests.plays import Play

CLOSING = """\
poi "office"
poi "gallery"
poi "exit"
poi "garden"
connect office and gallery distance 2
connect gallery and exit distance 3
connect gallery and garden distance 5 one_way
connect garden and exit distance 4 one_way
event "mop" location gallery duration 3
event "look" duration 2
event "wave"
agent "bot" controllable mobile 1 location office can_do mop
agent "visitor" mobile 1 location gallery can_do look, wave
{}
objective: bot never_with visitor at gallery
reach_objective: do mop
"""
"""A robot that mops the gallery after the last visitor has gone; he looks and waves wherever he is, also on the way."""

SAID = "assume: visitor at exit by 60"
CLOSED = CLOSING.replace("{}", SAID)


def test_it_is_won_because_of_the_assumption_and_proven() -> None:
    won = solved(CLOSED)
    assert verify(won.network, won.objective, won.strategy, won.reaction).ok
    with pytest.raises(Lost):
        solved(CLOSING.format(""))
    with pytest.raises(Lost):
        solved(CLOSED.replace("reach_objective: do mop", "reach_objective: do mop within 50"))


@pytest.mark.parametrize(
    ("said", "code"),
    [
        ("assume: visitor at exit by 0", "PML251"),
        ("assume: visitor at exit by 5", "PML252"),
        ("assume: bot at exit by 60", "PML250"),
        (f"{SAID}\nassume: visitor at garden by 90", "PML253"),
        (f"{SAID}\nassume: visitor leaves gallery within 20", "PML264"),
        (f"{SAID}\nassume: visitor never at exit", "PML252"),
        (f"{SAID}\nassume: not visitor at office", "PML264"),
    ],
)
def test_what_cannot_be_assumed(said: str, code: str) -> None:
    assert [finding.code for finding in check(scenario(CLOSING.format(said)))] == [code]


def test_whoever_could_be_kept_by_somebody_else_or_a_closed_way_is_reported() -> None:
    kept = CLOSED.replace('event "wave"', 'event "wave" collaborative together duration 9')
    kept = kept.replace("can_do mop", "can_do mop, wave").replace("can_do look, wave", "can_do look reacts_to wave")
    assert "PML264" in [finding.code for finding in check(scenario(kept))]
    closed = CLOSED.replace("distance 3", "distance 3 only_if bot at office")
    assert not check(scenario(closed)), "he can go through the garden"
    closed = closed.replace("distance 4 one_way", "distance 4 one_way only_if bot on_way")
    assert [finding.code for finding in check(scenario(closed))] == ["PML252"]


def test_uppaal_reads_it_back() -> None:
    story = scenario(CLOSED.replace("exit", "door"))  # a word of UPPAAL
    made = translate(story)
    assert read_network(write_network(made, scenario_objective(story)), "x.xml") == made


@given(st.integers(9, 60), st.integers(0, 10**6))
def test_in_random_plays_he_is_there_in_time(time: int, seed: int) -> None:
    Play(scenario(CLOSED.replace("by 60", f"by {time}"))).run(25, seed)  # tests.course says where he may be


@given(st.integers(6, 30), st.integers(0, 10**6))
@settings(max_examples=60)
def test_time_never_stops_and_he_is_there_in_the_end(time: int, seed: int) -> None:
    """Random plays in which the visitor waits as long as he can."""
    model, rng, now = free_model(CLOSED.replace("by 60", f"by {time}")), random.Random(seed), 0.0
    here = model.initial()
    while now < time + 5:
        bounds = model.bounds_of("visitor", here.locations["visitor"], here.values)
        most = min((bound.bound - here.clocks[bound.left] for bound in bounds), default=5.0)
        delay = rng.choice((0.1, 0.5, 1.0, 1.0)) * float(most)
        here, now = here.aged(delay), now + delay
        assert now <= time + 1e-6 or here.locations["visitor"] in ("exit", "doing_look_in_exit")
        words = [word for word in model.possible(here) if word.startswith(("visitor", "look", "wave"))]
        if not words:
            assert not bounds or most - delay > 1e-6, f"time stops at {here}"
            continue
        moves = model.joint_move(here, rng.choice(words), "visitor")
        assert moves
        here = model.after(moves, here)


def mission() -> Mission:
    cover = read_cover(yaml.safe_load(files(CLOSED)["src/observer/config/cover.yaml"]))
    return Mission(model(CLOSED), cover, lambda level, line: None, on_uncovered="plan", lost_after=10.0)


def test_a_visitor_who_stays_too_long_breaks_it() -> None:
    under_way = mission()
    under_way.on_word("_start_", 0.0)
    under_way.on_time(56.2)  # four units before, he has set off
    state = under_way.state(56.2)
    assert (state.values["assume1"], state.late, state.status) == (0, (), HOLDING)
    assert "visitor is at exit 60 units after the start, and from then on" in state.reason


def test_a_visitor_who_comes_back_too_late_has_come_and_breaks_it() -> None:
    under_way = mission()
    under_way.on_word("_start_", 0.0)
    under_way.on_word("visitor_gallery2exit", 40.0)
    under_way.on_word("visitor_going_gallery_to_exit2exit", 43.5)
    under_way.on_word("visitor_exit2gallery", 58.0)
    state = under_way.state(58.0)
    assert (state.values["assume1"], state.locations["visitor"]) == (0, "going_exit_to_gallery")


@pytest.mark.parametrize("kind", sorted(OPPONENTS))
def test_simulated_visitors_keep_to_it(kind: str) -> None:
    outcomes = missions(CLOSED, 10, Settings(kind))
    assert {outcome.end for outcome in outcomes} == {GOAL}
