"""`assume: visitor stays 10 to 20 at each place`: what is won because of it, and that visitors can always go on."""

from __future__ import annotations

import random
from typing import List, Tuple

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.explanation.explain import explain
from pursue_gen.outcomes import Lost
from pursue_gen.proof.checker import verify
from pursue_gen.solving.rules import Rules
from pursue_gen.synthesis.limits import Limits
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.uppaal import read_network, write_network
from pursue_gen.tools.simulation.opponents import OPPONENTS
from pursue_gen.tools.simulation.outcome import GOAL, Settings
from pursue_runtime.observer.mission import Mission
from pursue_runtime.state import HOLDING
from pursue_runtime.strategy import read_cover
from tests.assumptions import files, free_model, missions, model, scenario, solved
from tests.plays import Play

GALLERY = """\
poi "hall"
poi "east"
poi "west"
connect hall and west distance 2
connect west and east distance 4
event "mop" location west duration 6
event "look" duration 2
event "guide" collaborative together location east duration 4
agent "bot" controllable mobile 1 location hall can_do mop
agent "host" location east can_do guide
agent "visitor" mobile 1 location west can_do look reacts_to guide
{}
assume: visitor never at hall
objective: bot never_with visitor at west
reach_objective: do mop
"""
"""A robot that mops where the visitor is not; the visitor looks, goes to and fro, and may be guided."""

SAID = "assume: visitor stays 10 to 20 at each place"
LONELY = GALLERY.replace("{}", SAID)


def test_it_is_won_because_of_both_numbers_and_proven() -> None:
    won = solved(LONELY)
    assert verify(won.network, won.objective, won.strategy, won.reaction).ok
    for said in ("", SAID.replace("10 to 20", "0 to 20")):
        with pytest.raises(Lost):
            solved(GALLERY.format(said))


def test_a_shorter_stay_is_proposed_where_that_is_what_is_missing() -> None:
    lost = LONELY.replace("reach_objective: do mop", "reach_objective: do mop within 30")
    changes = explain(scenario(lost), Rules(), Limits(1200.0)).changes
    assert "assume: visitor stays 10 to 19 at each place instead of 20" in [each.sentence for each in changes]


def test_uppaal_reads_it_back() -> None:
    made = translate(scenario(LONELY))
    assert read_network(write_network(made, scenario_objective(scenario(LONELY))), "x.xml") == made


@given(st.integers(0, 10**6))
def test_in_random_plays_all_stays_are_as_long_as_it_says(seed: int) -> None:
    Play(scenario(LONELY)).run(20, seed)  # tests.course says how long


@given(st.floats(1.1, 9.9) | st.floats(10.1, 20.0))
def test_the_network_excludes_who_leaves_too_soon_and_nothing_else(moment: float) -> None:
    kept, free = (free_model(GALLERY.format(said)) for said in (SAID, ""))
    assert free.joint_move(free.initial().aged(moment), "visitor_west2east", "visitor")
    may = kept.joint_move(kept.initial().aged(moment), "visitor_west2east", "visitor")
    assert bool(may) == (moment >= 10)


WINDOWS: st.SearchStrategy[Tuple[int, int]] = st.tuples(st.integers(0, 12), st.integers(2, 12)).map(
    lambda two: (min(two), max(two))
)


@given(WINDOWS, st.sampled_from(("", "assume: visitor leaves west within 12")), st.integers(0, 10**6))
@settings(max_examples=40)
def test_time_never_stops(window: Tuple[int, int], also: str, seed: int) -> None:
    """Random plays in which the visitor waits as long as he can: then he, or who guides him, can do something."""
    said = SAID.replace("10 to 20", f"{window[0]} to {window[1]}")
    model, rng = free_model(GALLERY.format(f"{said}\n{also}")), random.Random(seed)
    here = model.initial()
    for _ in range(25):
        places = here.locations.items()
        bounds = [bound for who, place in places for bound in model.bounds_of(who, place, here.values)]
        most = min((bound.bound - here.clocks[bound.left] for bound in bounds), default=5.0)
        here = here.aged(rng.choice((0.0, 0.5, 1.0, 1.0)) * float(most))
        words: List[str] = [word for word in model.possible(here) if not word.startswith(("obj", "reach"))]
        if not words:
            left = min(bound.bound - here.clocks[bound.left] for bound in bounds)
            assert left > 1e-6, f"time stops at {here}"
            continue
        moves = model.joint_move(here, rng.choice(words))
        assert moves
        here = model.after(moves, here)


def mission() -> Mission:
    cover = read_cover(yaml.safe_load(files(LONELY)["src/observer/config/cover.yaml"]))
    return Mission(model(LONELY), cover, lambda level, line: None, on_uncovered="plan", lost_after=10.0)


def test_a_visitor_who_leaves_too_soon_has_left_and_breaks_it() -> None:
    under_way = mission()
    under_way.on_word("_start_", 0.0)
    under_way.on_word("visitor_west2east", 5.0)
    state = under_way.state(5.0)
    assert (state.status, state.locations["visitor"]) == (HOLDING, "going_west_to_east")
    assert state.values["assume1"] == 0 and "visitor stays 10 to 20 units at each place" in state.reason
    assert under_way.counts["untimely"] == 0


def test_a_visitor_who_stays_too_long_breaks_it_and_is_not_late() -> None:
    under_way = mission()
    under_way.on_word("_start_", 0.0)
    under_way.on_time(20.2)
    state = under_way.state(20.2)
    assert (state.values["assume1"], state.late, state.status) == (0, (), HOLDING)
    assert "visitor stays 10 to 20 units at each place" in state.reason


@pytest.mark.parametrize("kind", sorted(OPPONENTS))
def test_simulated_visitors_keep_to_it(kind: str) -> None:
    outcomes = missions(LONELY, 10, Settings(kind))
    assert {outcome.end for outcome in outcomes} == {GOAL}


CLOSED = """\
poi "hall"
poi "gallery"
connect hall and gallery distance 3 only_if open is_true
event "unlock" location hall
event "call" only_if visitor at gallery
event "serve" location hall duration 40
state "open": initially false, true_if unlock
agent "bot" controllable location hall can_do {}
agent "guest" location hall can_do call
agent "visitor" mobile 1 location gallery
assume: visitor stays 0 to 8 at each place
objective: if call then serve within 20
"""


@pytest.mark.parametrize("can_do", ["serve", "serve, unlock"])
def test_robots_win_nothing_by_leaving_nobody_a_way(can_do: str) -> None:
    """No answer is in time, and time would stop before that is seen."""
    with pytest.raises(Lost):
        solved(CLOSED.format(can_do))
