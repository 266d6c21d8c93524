"""`assume: mechanic reaches m1 within 20 after call`: what is won because of it, and that who is awaited always can."""

from __future__ import annotations

import random

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.language.checks import check
from pursue_gen.outcomes import Lost
from pursue_gen.proof.checker import verify
from pursue_gen.solving.vacuity import check_assumed_alone
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.uppaal import read_network, write_network
from pursue_gen.tools.simulation.opponents import OPPONENTS
from pursue_gen.tools.simulation.outcome import SAFE, Settings
from pursue_runtime.observer.mission import Mission
from pursue_runtime.state import HOLDING
from pursue_runtime.strategy import read_cover
from tests.assumptions import COMES as SAID
from tests.assumptions import PLANT, files, free_model, missions, model, scenario, solved
from tests.plays import Play

CALLED = PLANT.replace("{}", SAID)


def test_it_is_won_because_of_the_assumption_and_proven() -> None:
    won = solved(CALLED)
    assert verify(won.network, won.objective, won.strategy, won.reaction).ok
    for text in (PLANT.format(""), CALLED.replace("within 25", "within 19"), CALLED.replace("within 20", "within 25")):
        with pytest.raises(Lost):
            solved(text)


RINGS = """\
poi "hall"
poi "m1"
poi "canteen"
connect hall and m1 distance 3
connect m1 and canteen distance 4
event "ring" location m1{}
event "handOver" collaborative location m1
agent "bot" controllable mobile 1 location hall can_do handOver, ring
agent "other" controllable mobile 1 location canteen
agent "mechanic" mobile 1 location canteen reacts_to handOver
{}
reach_objective: do handOver within 60
"""
"""A robot that rings for the mechanic."""


@pytest.mark.parametrize("lasts", ["", " duration 2"])
def test_a_robot_may_call_for_him_by_an_event_or_its_end(lasts: str) -> None:
    said = "assume: mechanic reaches m1 within 20 after ring"
    won = solved(RINGS.format(lasts, said))
    assert verify(won.network, won.objective, won.strategy, won.reaction).ok
    with pytest.raises(Lost):
        solved(RINGS.format(lasts, ""))


def test_what_is_decided_in_parts_knows_that_he_does_not_stay_where_he_is() -> None:
    another = 'agent "other" controllable mobile 1 location canteen\nagent "machine"'
    won = solved(CALLED.replace('agent "machine"', another).replace("can_do eat, wave ", ""))
    assert verify(won.network, won.objective, won.strategy, won.reaction).ok


def test_check_warns_where_it_alone_is_enough() -> None:
    alone = CALLED.replace("if call then handOver", "if call then mechanic at m1")
    assert [finding.code for finding in check_assumed_alone(scenario(alone))] == ["PML265"]


@pytest.mark.parametrize(
    ("said", "code"),
    [
        ("assume: mechanic reaches m1 within 0 after call", "PML251"),
        ("assume: mechanic reaches m1 within 12 after call", "PML252"),
        ("assume: bot reaches m1 within 20 after call", "PML250"),
        ("assume: mechanic reaches m1 within 20 after rest", "PML110"),
        (f"{SAID}\n{SAID.replace('20', '30')}", "PML253"),
        (f"{SAID}\nassume: mechanic leaves hall within 20", "PML264"),
        (f"{SAID}\nassume: mechanic at hall by 90", "PML264"),
        (f"{SAID}\nassume: mechanic never at m1", "PML252"),
        (f"{SAID}\nassume: not mechanic at hall", "PML264"),
        ("assume: machine reaches m1 within 20 after wave", "PML254"),
    ],
)
def test_what_cannot_be_assumed(said: str, code: str) -> None:
    assert code in [finding.code for finding in check(scenario(PLANT.format(said)))]


def test_what_can_be_assumed_is_no_finding_and_two_places_are_one_too_many() -> None:
    assert not check(scenario(CALLED))
    both = f"{SAID}\nassume: mechanic reaches hall within 30 after wave"
    assert {finding.code for finding in check(scenario(PLANT.format(both)))} == {"PML264"}


def test_whoever_could_be_kept_by_somebody_else_or_a_closed_way_is_reported() -> None:
    kept = CALLED.replace("handOver\" collaborative", "handOver\" collaborative together").replace(
        'location m1\nevent "eat"', 'location m1 duration 3\nevent "eat"'
    )
    assert "PML264" in [finding.code for finding in check(scenario(kept))]
    closed = CALLED.replace("canteen distance 4", "canteen distance 4 only_if bot at m1")
    assert [finding.code for finding in check(scenario(closed))] == ["PML252"]


def test_uppaal_reads_it_back() -> None:
    story = scenario(CALLED)
    made = translate(story)
    assert read_network(write_network(made, scenario_objective(story)), "x.xml") == made


@given(st.integers(13, 60), st.integers(0, 10**6))
def test_in_random_plays_he_is_there_in_time(time: int, seed: int) -> None:
    Play(scenario(CALLED.replace("within 20", f"within {time}"))).run(40, seed)  # tests.course says where he may be


@given(st.integers(13, 40), st.integers(0, 10**6))
@settings(max_examples=60)
def test_time_never_stops_and_he_comes_in_time(time: int, seed: int) -> None:
    """Random plays in which the mechanic waits as long as he can; the machine calls now and then."""
    model, rng, now = free_model(CALLED.replace("within 20", f"within {time}")), random.Random(seed), 0.0
    here, called = model.initial(), 0.0
    for _ in range(60):
        both = "mechanic", "assume1way"
        bounds = [bound for name in both for bound in model.bounds_of(name, here.locations[name], here.values)]
        most = min((bound.bound - here.clocks[bound.left] for bound in bounds), default=9.0)
        delay = rng.choice((0.1, 0.5, 1.0, 1.0)) * float(most)
        here, now = here.aged(delay), now + delay
        assert not here.values["assume1count"] or now - called <= time + 1e-6
        words = ("mechanic", "eat", "wave") if rng.random() < 0.6 or delay == most else ("call",)
        able = [word for word in model.possible(here) if word.startswith(words)]
        if not able:
            assert not bounds or most - delay > 1e-6, f"time stops at {here}"
            continue
        word = rng.choice(able)
        moves = model.joint_move(here, word, "machine" if word == "call" else "mechanic")
        assert moves, "whoever has to leave can do that by himself"
        before, here = here, model.after(moves, here)
        called = called if before.values["assume1count"] else now


def mission() -> Mission:
    cover = read_cover(yaml.safe_load(files(CALLED)["src/observer/config/cover.yaml"]))
    return Mission(model(CALLED), cover, lambda level, line: None, on_uncovered="plan", lost_after=10.0)


def test_a_mechanic_who_stays_too_long_breaks_it() -> None:
    under_way = mission()
    under_way.on_word("_start_", 0.0)
    under_way.on_word("call", 4.0)
    under_way.on_time(18.9)
    assert under_way.state(18.9).values["assume1"] == 1
    under_way.on_time(19.2)  # 15 after the call he has set off
    state = under_way.state(19.2)
    assert (state.values["assume1"], state.late, state.status) == (0, (), HOLDING)
    assert "mechanic reaches m1 within 20 units after call" in state.reason


def test_a_mechanic_who_begins_to_eat_too_late_breaks_it_and_one_who_comes_does_not() -> None:
    under_way = mission()
    under_way.on_word("_start_", 0.0)
    under_way.on_word("call", 4.0)
    under_way.on_word("mechanic:eat", 12.0)
    assert under_way.state(12.0).values["assume1"] == 0
    under_way = mission()
    under_way.on_word("_start_", 0.0)
    for word, at in (("call", 4.0), ("mechanic:eat", 10.0), ("eatDONE", 15.5), ("mechanic_canteen2m1", 18.0)):
        under_way.on_word(word, at)
    state = under_way.on_word("mechanic_going_canteen_to_m12m1", 22.5)[-1]
    assert (state.values["assume1"], state.values["assume1count"]) == (1, 0)


@pytest.mark.parametrize("kind", sorted(OPPONENTS))
def test_simulated_mechanics_keep_to_it(kind: str) -> None:
    outcomes = missions(CALLED, 10, Settings(kind, until=200.0))
    assert {outcome.end for outcome in outcomes} == {SAFE}
