"""Robots that take part in a collaborative event of another agent are ordered to do so, once."""

from __future__ import annotations

from pathlib import Path
from typing import Dict, List, Tuple

import pytest

from pursue_gen.language import load
from pursue_gen.partition import partition, strategy_file
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import solve_scenario
from pursue_runtime.controller.scheduler import CommandScheduler
from pursue_runtime.state import SystemState
from pursue_runtime.strategy import Strategy
from tests.runtime.texts import read

SCENARIO = Path(__file__).resolve().parents[3] / "scenarios" / "thesis" / "scenario_2.pur"

STRATEGY = """
format: 1
controller: controller_taker
commands_agents: [taker]
reacts_to: {taker: {handOver: [giver], lift: [giver, person], greet: []}}
reaction: 0.1
strategy: []
"""


def state(seq: int, event: str = "", agent: str = "", commanded: bool = True, **locations: str) -> SystemState:
    """A state in which everybody is at mid, but for these."""
    where: Dict[str, str] = {"giver": "mid", "taker": "mid", "visitor": "mid", **locations}
    return SystemState(seq, float(seq), where, {}, {}, event, agent, commanded=commanded)


class Taker:
    """A controller whose robot takes part in events of others."""

    def __init__(self) -> None:
        self.scheduler = CommandScheduler(Strategy(read(STRATEGY)))

    def sees(self, state: SystemState) -> List[str]:
        """What its robot is to do because of the state."""
        self.scheduler.on_state(state, state.stamp)
        assert all(order.origin == order.target == "mid" for order in self.scheduler.joined)
        return [order.trigger for order in self.scheduler.joined]


@pytest.fixture
def taker() -> Taker:
    """A controller that has seen a first state."""
    made = Taker()
    assert made.sees(state(1)) == []
    return made


def test_a_partner_joins_what_is_done_at_once(taker: Taker) -> None:
    handed_over = state(2, "handOver", "giver")
    assert taker.sees(handed_over) == ["handOver"]
    assert taker.sees(handed_over._replace(stamp=2.5)) == [], "a heartbeat"
    assert taker.sees(state(3)) == [] and taker.sees(state(4, "handOver", "giver")) == ["handOver"]


def test_a_partner_joins_what_takes_a_while_once(taker: Taker) -> None:
    lifting = state(2, "lift", "giver", giver="doing_lift_in_mid")
    assert taker.sees(lifting) == ["lift"]
    assert taker.sees(state(3, "visitor_leaves", "visitor", False, giver="doing_lift_in_mid")) == []
    assert taker.sees(state(4, "liftDONE", "giver", False)) == []


def test_states_may_be_missed(taker: Taker) -> None:
    assert taker.sees(state(5, "visitor_leaves", "visitor", False, giver="doing_lift_in_mid")) == ["lift"]


def test_a_controller_that_starts_during_the_event_sends_what_goes_on_once() -> None:
    taker = Taker()
    assert taker.sees(state(5, "lift", "giver", giver="doing_lift_in_mid")) == ["lift"]
    assert taker.sees(state(6, "x", "visitor", False, giver="doing_lift_in_mid")) == []
    late = Taker()
    assert late.sees(state(5, "handOver", "giver")) == [], "it may have been done"


@pytest.mark.parametrize(
    "elsewhere", [{"giver": "end"}, {"taker": "end"}, {"giver": "doing_lift_in_end"}, {"taker": "going_mid_to_end"}]
)
def test_who_is_elsewhere_is_no_partner(taker: Taker, elsewhere: Dict[str, str]) -> None:
    for seq, event in ((2, "handOver"), (3, "lift")):
        assert taker.sees(state(seq, event, "giver", **elsewhere)) == []


def test_an_event_of_a_robot_that_a_person_published_by_hand_is_no_order(taker: Taker) -> None:
    assert taker.sees(state(2, "handOver", "giver", commanded=False)) == []
    assert taker.sees(state(3, "lift", "giver", commanded=False, giver="doing_lift_in_mid")) == []


def test_what_an_uncontrollable_agent_begins_is_an_order(taker: Taker) -> None:
    assert taker.sees(state(2, "greet", "visitor", commanded=False)) == ["greet"]


def test_strategies_name_the_partners() -> None:
    scenario = load(str(SCENARIO))
    won = solve_scenario(scenario, Rules())
    data = {
        sub.controller: read(strategy_file.render(sub, scenario.name, "0", Rules().reaction))
        for sub in partition(won.strategy, won.network, scenario.agents)
    }
    assert data["controller_bot3"]["reacts_to"] == {"bot3": {"bot2_ina": ["bot2"]}}
    assert "reacts_to" not in data["controller_bot1"]
    assert Strategy(data["controller_bot3"]).reacts_to == {"bot3": {"bot2_ina": ("bot2",)}}


# Where the event keeps its partners busy, their own location says that they take part ---------------------------------

LIFTS = "doing_lift_in_mid"


def begun(taker: Taker, state: SystemState) -> List[Tuple[str, str, str]]:
    """The orders to its robot because of the state: what, from where, to where."""
    orders = taker.scheduler.on_state(state, state.stamp)
    assert taker.scheduler.joined == []
    return [(order.trigger, order.origin, order.target) for order in orders]


def test_a_partner_that_is_busy_as_well_gets_one_order(taker: Taker) -> None:
    lifting = {"giver": LIFTS, "taker": LIFTS}
    assert begun(taker, state(2, "lift", "giver", **lifting)) == [("lift", "mid", LIFTS)]
    assert begun(taker, state(3, "visitor_leaves", "visitor", False, **lifting)) == []
    assert begun(taker, state(4, "liftDONE", "giver", False)) == []
    assert begun(taker, state(5, "lift", "giver", **lifting)) == [("lift", "mid", LIFTS)]


def test_it_gets_it_also_where_states_were_missed_or_its_controller_was_restarted(taker: Taker) -> None:
    lifting = {"giver": LIFTS, "taker": LIFTS}
    assert begun(taker, state(7, "visitor_leaves", "visitor", False, **lifting)) == [("lift", "mid", LIFTS)]
    assert begun(Taker(), state(7, "lift", "giver", **lifting)) == [("lift", "", LIFTS)]


def test_what_a_person_began_by_hand_is_no_order_to_a_busy_partner(taker: Taker) -> None:
    assert begun(taker, state(2, "lift", "giver", False, giver=LIFTS, taker=LIFTS)) == []
    greeting = "doing_greet_in_mid"
    assert begun(taker, state(3, "greet", "visitor", False, visitor=greeting, taker=greeting)) == [
        ("greet", LIFTS, greeting)
    ]


def test_a_partner_that_is_lost_gets_no_order(taker: Taker) -> None:
    """It is where the event is, so the observer moves it with the others; nobody waits for it."""
    lifting = state(2, "lift", "giver", giver=LIFTS, taker=LIFTS)
    assert begun(taker, lifting._replace(lost=("taker",))) == []
    assert begun(Taker(), lifting._replace(lost=("taker",), event="visitor_leaves", agent="visitor")) == []


def test_the_event_is_known_where_its_place_has_a_similar_name(taker: Taker) -> None:
    there = {"giver": "doing_lift_in_car_in_hall", "taker": "doing_lift_in_car_in_hall"}
    assert begun(taker, state(2, "lift", "giver", **there)) == [("lift", "mid", "doing_lift_in_car_in_hall")]
