"""`assume: at_most 2 of mess in all`: what is won because of it, whose calls are counted, and what breaks it."""

from __future__ import annotations

from typing import List, Tuple

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
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.uppaal import read_network, write_network
from pursue_gen.tools.simulation.opponents import OPPONENTS
from pursue_gen.tools.simulation.outcome import GOAL, Settings
from pursue_runtime.observer.mission import Mission
from pursue_runtime.state import HOLDING
from pursue_runtime.strategy import read_cover
from tests.assumptions import files, free_model, missions, model, scenario, solved
from tests.plays import Play

NURSERY = """\
poi "room"
poi "hall"
connect room and hall distance 2
event "clean" location room duration 5
event "spill" location room
event "scrawl"
event "inspect" location room
group "mess": spill, scrawl
state "tidy": initially false, true_if clean false_if spill, scrawl
stateDependency: inspect only_if tidy is_true
agent "bot" controllable location room can_do clean, inspect
agent "nurse" human controllable mobile 1 location hall can_do scrawl
agent "anna" location room can_do spill, scrawl
agent "ben" mobile 1 location hall can_do spill
{}
reach_objective: do inspect
"""
"""A robot tidies up after two children, who make a mess in two ways."""

SAID = "assume: at_most 3 of mess in all"
FEW = NURSERY.replace("{}", SAID)


def test_it_is_won_because_of_the_number_and_proven() -> None:
    won = solved(FEW)
    assert verify(won.network, won.objective, won.strategy, won.reaction).ok
    with pytest.raises(Lost):
        solved(NURSERY.format(""))


def test_fewer_times_are_proposed_where_that_is_what_is_missing() -> None:
    lost = FEW.replace("do inspect", "do inspect within 16")
    changes = [each.sentence for each in explain(scenario(lost), Rules(), Limits(1200.0)).changes]
    assert "assume: at_most 1 of spill, scrawl in all instead of 3" in changes


def test_uppaal_reads_it_back() -> None:
    made = translate(scenario(FEW))
    assert read_network(write_network(made, scenario_objective(scenario(FEW))), "x.xml") == made


@given(st.integers(0, 10**6))
def test_in_random_plays_there_is_no_more_mess(seed: int) -> None:
    Play(scenario(FEW)).run(25, seed)  # tests.course counts them


def test_what_is_controlled_is_not_counted() -> None:
    kept = free_model(FEW)
    here = kept.initial()
    for _ in range(5):
        here = here.aged(2.0)
        moves = kept.joint_move(here, "scrawl", "nurse")
        assert moves
        here = kept.after(moves, here)
    assert here.values["assume1count"] == 0


@pytest.mark.parametrize(
    ("said", "found"),
    [
        ("assume: at_most 101 of mess in all", [("PML251", "as each time is counted")]),
        ("assume: at_most 2 of spill, spill in all", [("PML253", "stands twice behind of")]),
        ("assume: at_most 2 of spill, clean in all", [("PML250", "all who can do clean are controlled")]),
        (f"{SAID}\nassume: at_most 2 of mess in all", [("PML253", "assumes this already")]),
    ],
)
def test_what_cannot_be_assumed(said: str, found: List[Tuple[str, str]]) -> None:
    findings = check(scenario(NURSERY.format(said)))
    assert [finding.code for finding in findings] == [code for code, _ in found]
    assert all(part in finding.message for finding, (_, part) in zip(findings, found))


def test_one_call_too_many_has_happened_and_breaks_it() -> None:
    cover = read_cover(yaml.safe_load(files(FEW)["src/observer/config/cover.yaml"]))
    under_way = Mission(model(FEW), cover, lambda level, line: None, on_uncovered="plan", lost_after=10.0)
    under_way.on_word("_start_", 0.0)
    for moment, word in ((2.0, "anna:spill"), (3.5, "anna:scrawl"), (5.0, "anna:spill")):
        under_way.on_word(word, moment)
    assert under_way.state(5.0).values["assume1count"] == under_way.state(5.0).values["assume1"] * 3 == 3
    under_way.on_word("anna:scrawl", 7.0)
    state = under_way.state(7.0)
    assert (state.values["assume1"], state.status) == (0, HOLDING)
    assert "others do spill and scrawl at most 3 times in all" in state.reason


@pytest.mark.parametrize("kind", sorted(OPPONENTS))
def test_simulated_children_keep_to_it(kind: str) -> None:
    outcomes = missions(FEW, 10, Settings(kind))
    assert {outcome.end for outcome in outcomes} == {GOAL}
