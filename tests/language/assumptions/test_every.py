"""`assume: belt does bring every 20 to 30`: what is won because of it, and that the belt can always do so."""

from __future__ import annotations

import random
from typing import List, Tuple

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.explanation.explain import explain
from pursue_gen.language.checks import check
from pursue_gen.outcomes import Lost
from pursue_gen.proof.checker import verify
from pursue_gen.solving.rules import Rules
from pursue_gen.synthesis.limits import Limits
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.uppaal import read_network, write_network
from pursue_gen.tools.simulation.opponents import OPPONENTS
from pursue_gen.tools.simulation.outcome import Settings
from pursue_runtime.observer.mission import Mission
from pursue_runtime.state import HOLDING
from pursue_runtime.strategy import read_cover
from tests.assumptions import files, free_model, missions, model, scenario, solved
from tests.plays import Play

BELT = """\
poi "store"
poi "belt_end"
connect store and belt_end distance 9
event "bring" location belt_end
event "jam" location belt_end duration 3
event "fetch" location belt_end duration 2
event "put" location store duration 2
agent "cart" controllable mobile 1 location store can_do fetch, put
agent "belt" location belt_end can_do bring, jam
{}
objective: if bring then fetch within 6
objective: if fetch then put within 20
"""
"""A cart that has to be at the belt when it brings something, and at the store in between."""

SAID = "assume: belt does bring every 40 to 50"


def test_it_is_won_because_of_the_first_number_and_proven() -> None:
    won = solved(BELT.format(SAID))
    assert verify(won.network, won.objective, won.strategy, won.reaction).ok
    for said in ("", "assume: belt does bring every 15 to 50"):
        with pytest.raises(Lost):
            solved(BELT.format(said))


WAITING = """\
poi "gate"
event "pass" location gate
event "open" location gate
agent "bot" controllable location gate can_do open
agent "guest" location gate can_do pass
{}
state "passed": initially false, true_if pass
stateDependency: open only_if passed is_true
reach_objective: do open within 40
"""


def test_it_is_won_because_of_the_second_number() -> None:
    assert solved(WAITING.format("assume: guest does pass every 10 to 30")).strategy.blocks
    for said in ("", "assume: guest does pass every 10 to 45"):
        with pytest.raises(Lost):
            solved(WAITING.format(said))


def test_a_smaller_number_is_proposed_where_that_is_what_is_missing() -> None:
    lost = scenario(WAITING.format("assume: guest does pass every 10 to 45"))
    changes = explain(lost, Rules(), Limits(1200.0)).changes
    proposed = [each.sentence for each in changes if each.what == "assumption"]
    assert proposed == ["assume: guest does pass every 10 to 39 instead of 45"]


def test_no_assumption_is_proposed_that_would_hinder_it() -> None:
    lost = scenario(BELT.format("assume: belt does bring every 15 to 50"))
    changes = explain(lost, Rules(), Limits(1200.0)).changes
    assert not any("waits" in each.sentence or "at_most" in each.sentence for each in changes)


def test_uppaal_reads_it_back() -> None:
    text = scenario(BELT.format(SAID))
    made = translate(text)
    assert read_network(write_network(made, scenario_objective(text)), "x.xml") == made


@given(st.integers(0, 10**6))
def test_in_random_plays_it_happens_as_often_as_it_says(seed: int) -> None:
    Play(scenario(BELT.format(SAID))).run(20, seed)  # tests.course says how often


@given(st.floats(1.1, 39.9) | st.floats(40.1, 50.0))
def test_the_network_excludes_what_is_too_soon_and_nothing_else(moment: float) -> None:
    kept = free_model(BELT.format(SAID))
    assert bool(kept.joint_move(kept.initial().aged(moment), "bring", "belt")) == (moment >= 40)


@given(st.floats(1.1, 50.0))
def test_nothing_begins_that_would_make_it_late(moment: float) -> None:
    kept = free_model(BELT.format(SAID))
    may = bool(kept.joint_move(kept.initial().aged(moment), "jam", "belt"))
    assert may == (moment < 50 - 1 - 4)  # a jam takes up to 4, and a rest follows


WINDOWS: st.SearchStrategy[Tuple[int, int]] = st.tuples(st.integers(0, 12), st.integers(2, 12)).map(
    lambda two: (min(two), max(two[1], 2))
)


@given(WINDOWS, st.integers(0, 10**6))
@settings(max_examples=40)
def test_time_never_stops(window: Tuple[int, int], seed: int) -> None:
    """Random plays in which the belt waits as long as it can: then it can do something."""
    said = SAID.replace("40 to 50", f"{window[0]} to {window[1]}")
    alone = BELT.format(said).split("objective:")[0] + "reach_objective: do put\n"  # deadlines end plays, too
    model, rng = free_model(alone), random.Random(seed)
    here = model.initial()
    for _ in range(25):
        places = here.locations.items()
        bounds = [bound for who, place in places for bound in model.bounds_of(who, place, here.values)]
        most = min((bound.bound - here.clocks[bound.left] for bound in bounds), default=5.0)
        here = here.aged(rng.choice((0.0, 0.5, 1.0, 1.0)) * float(most))
        words: List[str] = [word for word in model.possible(here) if not word.startswith("reach")]
        if not words:
            left = min(bound.bound - here.clocks[bound.left] for bound in bounds)
            assert left > 1e-6, f"time stops at {here}"
            continue
        moves = model.joint_move(here, rng.choice(words))
        assert moves
        here = model.after(moves, here)


def mission() -> Mission:
    text = BELT.format(SAID)
    cover = read_cover(yaml.safe_load(files(text)["src/observer/config/cover.yaml"]))
    return Mission(model(text), cover, lambda level, line: None, on_uncovered="plan", lost_after=10.0)


def test_what_comes_too_soon_has_happened_and_breaks_it() -> None:
    under_way = mission()
    under_way.on_word("_start_", 0.0)
    under_way.on_word("bring", 20.0)
    state = under_way.state(20.0)
    assert state.values["assume1"] == 0 and "belt does bring every 40 to 50 units" in state.reason


def test_what_does_not_come_breaks_it_and_nobody_is_late() -> None:
    under_way = mission()
    under_way.on_word("_start_", 0.0)
    under_way.on_time(50.2)
    state = under_way.state(50.2)
    assert (state.values["assume1"], state.late, state.status) == (0, (), HOLDING)


@pytest.mark.parametrize("kind", sorted(OPPONENTS))
def test_simulated_belts_keep_to_it(kind: str) -> None:
    outcomes = missions(BELT.format(SAID), 6, Settings(kind))
    assert not any("assumed" in outcome.reason for outcome in outcomes)


@pytest.mark.parametrize(
    "said, why",
    [
        ("assume: belt does fetch every 5 to 9", "it cannot do fetch"),
        ("assume: belt does jam every 5 to 9", "jam has a duration"),
        ('rule "turn": bring before fetch\n' + SAID, "bring is not always allowed"),
        (SAID + "\nassume: belt waits 9 between bring", "line 11 assumes something of that, too"),
        (SAID + "\nassume: at_most 3 of bring in all", "line 11 assumes something of that, too"),
    ],
)
def test_what_could_hinder_it_is_an_error(said: str, why: str) -> None:
    (found,) = [finding for finding in check(scenario(BELT.format(said))) if finding.code == "PML442"]
    assert why in found.message


@pytest.mark.parametrize(
    "before, after, why",
    [
        ("bring\" location belt_end", "bring\" location belt_end at_most 3 times", "bring is not always allowed"),
        ("can_do bring, jam", "can_do bring, jam reacts_to fetch", "it takes part in what others do"),
        ('"belt" location belt_end', '"belt" mobile 1 location belt_end', "it is not always where bring happens"),
        ('bring" location', 'bring" collaborative location', "bring takes two"),
    ],
)
def test_what_the_event_or_the_agent_is_like_may_hinder_it(before: str, after: str, why: str) -> None:
    text = BELT.format(SAID).replace(before, after)
    assert [why in each.message for each in check(scenario(text)) if each.code == "PML442"] == [True]


@pytest.mark.parametrize("window, code", [("40 to 30", "PML200"), ("0 to 1", "PML251")])
def test_numbers_that_mean_nothing_are_errors(window: str, code: str) -> None:
    found = check(scenario(BELT.format(SAID.replace("40 to 50", window))))
    assert [finding.code for finding in found] == [code]
