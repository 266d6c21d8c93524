"""What makes a scenario too large: each claim is tried again, and depends on no clock."""

from __future__ import annotations

import functools
import json
from dataclasses import replace

import pytest

from pursue_gen.explanation import costs as costs_module
from pursue_gen.explanation.ablations import without_each
from pursue_gen.explanation.costs import Cost, Costs, as_json, costs, in_words
from pursue_gen.language import parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.rules import Rules, played
from pursue_gen.synthesis.limits import Limits
from pursue_gen.synthesis.solve import Verdict, solve
from pursue_gen.tga import scenario_objective, translate
from tests.large_scenarios import many_walkers

CROWD = parse(many_walkers(3, 4), "crowd.pur")
DEFAULT = Rules()

ANTEROOM = """
poi "door"
poi "hall"
connect door and hall distance 2
event "ring"
event "open" location hall
event "serve" location hall
rule "order": (ring or open) before serve
agent "bot" controllable mobile 1 location door can_do serve, open
agent "guest" mobile 1 location hall can_do ring
agent "child" mobile 1 location hall
reach_objective: do serve
"""


def decided(scenario: Scenario) -> Verdict:
    return solve(played(translate(scenario), DEFAULT), scenario_objective(scenario), DEFAULT.reaction)


@pytest.fixture
def little_work(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(costs_module, "WORK", 20_000_000)
    monkeypatch.setattr(costs_module, "_LONGER", 0.05)  # seconds are spent on more time, whatever the work is


@functools.lru_cache(maxsize=None)
def of_crowd() -> Costs:
    """What is found with little work."""
    return costs(CROWD, DEFAULT)


@pytest.mark.usefixtures("little_work")
def test_parts_without_which_it_is_decided_are_named_the_cheapest_first() -> None:
    found = of_crowd()
    lesser = {part.name: smaller for part, smaller in without_each(CROWD)}
    assert found.decided and found.undecided
    assert {name for cost in found.decided for name in cost.without}.isdisjoint(found.undecided)
    assert [cost.work for cost in found.decided] == sorted(cost.work for cost in found.decided)
    for cost in found.decided:
        again = decided(lesser[cost.without[0]])
        assert (again.won, again.stats.discrete_states) == (cost.won, cost.states)


@pytest.mark.usefixtures("little_work")
def test_the_costs_are_the_same_at_each_time() -> None:
    def timeless(found: Costs) -> Costs:
        return replace(found, decided=tuple(replace(cost, seconds=0.0) for cost in found.decided))

    again = costs(CROWD, DEFAULT, Limits(1e-9, by_default=True))
    assert timeless(again) == timeless(of_crowd()) != Costs((), ())


def test_what_cannot_matter_is_not_left_out_in_vain() -> None:
    found = costs(parse(ANTEROOM, "anteroom.pur"), DEFAULT)
    names = {cost.without for cost in found.decided}
    assert names == {("guest",), ("rule order",)} and found.undecided == ()


def test_without_work_nothing_is_claimed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(costs_module, "WORK", 1)
    found = costs(parse(ANTEROOM, "anteroom.pur"), DEFAULT)
    assert found.decided == () and set(found.undecided) == {"guest", "rule order"}


def test_a_persons_limit_on_time_holds() -> None:
    assert costs(parse(ANTEROOM, "anteroom.pur"), DEFAULT, Limits(1e-9)).decided == ()


def test_it_is_over_in_some_seconds_and_within_the_memory_whoever_has_set_no_limit(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    anteroom = parse(ANTEROOM, "anteroom.pur")
    monkeypatch.setattr(costs_module, "ROOM", -(10**6))
    assert costs(anteroom, DEFAULT, Limits(memory=1, by_default=True)).decided == ()
    assert costs(anteroom, DEFAULT, Limits(memory=10**6, by_default=True)).decided != ()
    monkeypatch.setattr(costs_module, "SECONDS", 1e-9)
    assert costs(anteroom, DEFAULT, Limits(by_default=True)).decided == ()


def test_where_no_part_alone_is_enough_several_are_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(costs_module, "_ALONE", 1e-9)
    found = costs(parse(ANTEROOM, "anteroom.pur"), DEFAULT)
    (cost,) = found.decided
    assert sorted(cost.without) == sorted(found.undecided) == ["guest", "rule order"]


def test_an_option_without_which_it_is_decided_is_all_that_is_named() -> None:
    found = costs(parse(ANTEROOM, "anteroom.pur"), DEFAULT, option="--within 60")
    assert [cost.without for cost in found.decided] == [("--within 60",)] and found.undecided == ()


def test_slack_of_an_agent_that_is_left_out_does_no_harm() -> None:
    text = ANTEROOM.replace('agent "guest" mobile', 'agent "guest" controllable mobile')
    found = costs(parse(text, "anteroom.pur"), Rules(slack={"guest": 2}))
    assert ("guest",) in {cost.without for cost in found.decided}


FEW = Cost(("nurse",), True, 1204, 0.24, 5)
MANY = Cost(("rule round",), False, 20011, 3.1, 9)


@pytest.mark.parametrize(
    ("found", "text"),
    [
        (Costs((), ()), ""),
        (Costs((), ("nurse", "rule round")), "Too large without nurse or rule round, and without all of them."),
        (Costs((FEW,), ()), "Without nurse it is decided in 0.2 s (won, 1204 states)."),
        (
            Costs((FEW, MANY), ("porter", "bot2")),
            "Without nurse it is decided in 0.2 s (won, 1204 states); without rule round it is decided in 3.1 s "
            "(lost, 20011 states). Still too large without porter or bot2.",
        ),
        (
            Costs((replace(FEW, without=("nurse", "porter", "rule round")),), ("nurse", "porter", "rule round")),
            "Without nurse, porter and rule round together it is decided in 0.2 s (won, 1204 states). "
            "Without one of these alone it is too large.",
        ),
    ],
)
def test_it_is_said_in_sentences(found: Costs, text: str) -> None:
    assert in_words(found) == text


def test_json_holds_all_of_it() -> None:
    assert json.loads(json.dumps(as_json(Costs((FEW,), ("porter",))))) == {
        "decided": [{"without": ["nurse"], "won": True, "states": 1204, "seconds": 0.24, "work": 5}],
        "undecided": ["porter"],
    }
