"""Plans for missions in which somebody is lost who takes part in what another one does."""

from __future__ import annotations

from typing import Any, Dict

from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import solution
from pursue_gen.tga import scenario_objective
from pursue_gen.tga.network import Network, Test
from pursue_gen.tools.replanning.request import read_request
from pursue_gen.tools.replanning.start import network_from
from tests.together import HOTEL, scenario, solved
from tests.tools.replanning.plays import game_of

TWO_WAITERS = HOTEL.replace(
    'agent "guest"', 'agent "waiter2" controllable mobile 1 location lift can_do serve reacts_to ride\nagent "guest"'
)
RIDE = "doing_ride_in_lift"
AT_LIFT, AT_WORK = 2, -22


def network(text: str, where: Dict[str, str], values: Dict[str, int], excused: Any, clock: float = 2.0) -> Network:
    """The game from there; the clocks of all are the same."""
    won = solved(text)
    locations = {automaton.name: where.get(automaton.name, automaton.initial) for automaton in won.network.automata}
    request = {
        "format": 1, "game": game_of(scenario(text)), "locations": locations,
        "values": {**dict(won.network.variables), **values}, "clocks": dict.fromkeys(won.network.clocks, clock),
        "ahead": 0.0, "excused": list(excused), "limit": 1200.0,
    }  # fmt: skip
    return network_from(won.network, read_request(request))


def test_nobody_relies_on_a_lost_partner_but_it_is_moved_with_the_others() -> None:
    there = {"waiter": "lift"}
    made = network(TWO_WAITERS, there, {"Pwaiter": AT_LIFT}, ["waiter"])
    (start,) = [e for e in made.automaton("porter").edges if e.sync and e.sync.channel == "ride"]
    assert (Test("Pwaiter2", AT_LIFT),) in start.guard.integers
    (joins,) = [e for e in made.automaton("waiter").edges if e.sync and e.sync.channel == "ride"]
    assert joins.source == "lift", "the observer moves it as well"


def test_where_the_only_partner_is_lost_nothing_is_done_together() -> None:
    made = network(HOTEL, {"waiter": "lift"}, {"Pwaiter": AT_LIFT}, ["waiter"])
    assert not [e for e in made.automaton("porter").edges if e.sync and e.sync.channel == "ride"]


def test_without_a_lost_partner_the_mission_goes_on_with_another_one() -> None:
    made = network(TWO_WAITERS, {"waiter": "lift"}, {"Pwaiter": AT_LIFT}, ["waiter"])
    assert solution(made, scenario_objective(scenario(TWO_WAITERS)), Rules()).strategy


def test_a_partner_that_is_lost_meanwhile_does_not_keep_the_event_from_ending() -> None:
    riding = {name: RIDE for name in ("porter", "waiter", "waiter2")}
    places = [place.name for place in solved(TWO_WAITERS).network.automaton("way").locations]
    number = next(number for number, place in enumerate(places) if place.endswith("_doing_ride"))
    values = {**{f"P{name}": AT_WORK for name in riding}, "Pway": number}
    made = network(TWO_WAITERS, {**riding, "way": places[number]}, values, ["waiter"])
    porter = next(place for place in made.automaton("porter").locations if place.name == RIDE)
    assert porter.invariant, "its own report comes in time"
    assert solution(made, scenario_objective(scenario(TWO_WAITERS)), Rules()).strategy
