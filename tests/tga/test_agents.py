"""Agents: movements and actions, when they may begin and end, and what they tell the others."""

from __future__ import annotations

from typing import List

from pursue_gen.tga import translate
from pursue_gen.tga.network import ClockBound, Edge, Guard, Network, Sync, Test
from tests.tga.networks import scenario

HOUSE = """
poi "hall"
poi "shed"
connect hall and shed distance 3
event "fetch" location shed duration 5
event "wave"
event "knock" location hall
event "talk" collaborative
event "lift" collaborative duration 2
event "nod"
rule "order": fetch before (wave or lift)
rule "manners": nod before wave
state "open": initially true, true_if knock false_if nod
stateDependency: wave only_if open is_false
stateDependency: fetch only_if open is_true
agent "bot" controllable mobile 4 location shed can_do fetch, wave, knock, talk, lift
agent "guard" location hall can_do nod, lift reacts_to talk
agent "dog" mobile 1 location hall reacts_to talk, lift
objective: avoid nod
"""


def house() -> Network:
    return translate(scenario(HOUSE))


def edges(agent: str, channel: str) -> List[Edge]:
    return [edge for edge in house().automaton(agent).edges if edge.sync and edge.sync.channel == channel]


def test_locations_are_pois_ways_and_work_places() -> None:
    bot, guard = house().automaton("bot"), house().automaton("guard")
    assert [(location.name, location.invariant) for location in bot.locations] == [
        ("hall", ()),
        ("shed", ()),
        ("going_hall_to_shed", (ClockBound("Cbot", "<=", 13),)),
        ("going_shed_to_hall", (ClockBound("Cbot", "<=", 13),)),
        ("doing_fetch_in_shed", (ClockBound("Cbot", "<=", 6),)),
        ("doing_lift_in_hall", (ClockBound("Cbot", "<=", 3),)),
        ("doing_lift_in_shed", (ClockBound("Cbot", "<=", 3),)),
    ]
    assert [location.name for location in guard.locations] == ["hall", "doing_lift_in_hall"]
    assert (bot.initial, guard.initial) == ("shed", "hall")


def test_a_movement_takes_distance_times_the_inverse_speed() -> None:
    start, end = house().automaton("bot").edges[:2]
    assert start == Edge(
        "hall",
        "going_hall_to_shed",
        Guard((ClockBound("Cbot", ">", 1),)),
        Sync("bot_hall2shed", True),
        (("Pbot", -12),),
        ("Cbot",),
    )
    assert end == Edge(
        "going_hall_to_shed", "shed", Guard((ClockBound("Cbot", ">", 12),)), None, (("Pbot", 2),), ("Cbot",)
    )


def test_a_way_that_goes_one_way_has_no_way_back_and_the_numbers_stay() -> None:
    made = translate(scenario(HOUSE.replace("distance 3", "distance 3 one_way")))
    names = [location.name for location in made.automaton("dog").locations]
    assert "going_hall_to_shed" in names and "going_shed_to_hall" not in names
    assert "bot_hall2shed" in made.channels and "bot_shed2hall" not in made.channels
    (start,) = (e for e in made.automaton("bot").edges if e.target == "going_hall_to_shed" and e.source == "hall")
    assert start == house().automaton("bot").edges[0]


def test_a_window_with_two_numbers_is_guard_and_invariant() -> None:
    text = HOUSE.replace("duration 5", "duration 5 to 9") + "travel dog from shed to hall takes 4 to 8\n"
    made = translate(scenario(text))
    bot, dog = made.automaton("bot"), made.automaton("dog")
    places = {place.name: place.invariant for agent in (bot, dog) for place in agent.locations}
    assert places["doing_fetch_in_shed"] == (ClockBound("Cbot", "<=", 9),)
    assert places["going_shed_to_hall"] == (ClockBound("Cdog", "<=", 8),)
    assert places["going_hall_to_shed"] == (ClockBound("Cdog", "<=", 4),)
    ends = {edge.source: edge.guard.clocks for agent in (bot, dog) for edge in agent.edges}
    assert ends["doing_fetch_in_shed"] == (ClockBound("Cbot", ">", 5),)
    assert ends["going_shed_to_hall"] == (ClockBound("Cdog", ">", 4),)


def test_two_ways_in_opposite_directions_differ_in_length() -> None:
    ways = "connect hall and shed distance 3 one_way\nconnect shed and hall distance 9 one_way"
    made = translate(scenario(HOUSE.replace("connect hall and shed distance 3", ways)))
    invariants = {place.name: place.invariant for place in made.automaton("dog").locations}
    assert invariants["going_hall_to_shed"] == (ClockBound("Cdog", "<=", 4),)
    assert invariants["going_shed_to_hall"] == (ClockBound("Cdog", "<=", 10),)


def test_an_action_with_a_duration_waits_for_its_turn_twice() -> None:
    (start,), (end,) = edges("bot", "fetch"), edges("bot", "fetchDONE")
    conditions = ((Test("Porder", 0),), (Test("Sopen", 1),))
    assert start.guard == Guard((ClockBound("Cbot", ">", 1),), conditions)
    assert (start.source, start.target, start.assign, start.resets) == (
        "shed",
        "doing_fetch_in_shed",
        (("Pbot", -22),),
        ("Cbot",),
    )
    assert end.guard == Guard((ClockBound("Cbot", ">", 5),), ((Test("Porder", 1),),))
    assert (end.target, end.assign, end.resets) == ("shed", (("Pbot", 2),), ("Cbot",))


def test_an_instant_action_anywhere_is_possible_on_the_way_too() -> None:
    guards = {edge.source: edge.guard for edge in edges("bot", "wave")}
    conditions = ((Test("Porder", 2),), (Test("Pmanners", 1),), (Test("Sopen", 0),))
    assert guards == {
        "hall": Guard((ClockBound("Cbot", ">", 1),), conditions),
        "shed": Guard((ClockBound("Cbot", ">", 1),), conditions),
        "going_hall_to_shed": Guard((ClockBound("Cbot", ">", 0),), conditions),
        "going_shed_to_hall": Guard((ClockBound("Cbot", ">", 0),), conditions),
    }
    assert all(edge.target == edge.source and not edge.assign for edge in edges("bot", "wave"))
    resets = {edge.source: edge.resets for edge in edges("bot", "wave")}
    assert resets["hall"] == ("Cbot",)
    assert resets["going_hall_to_shed"] == ()


def test_an_instant_action_with_a_location_is_possible_there_only() -> None:
    assert [edge.source for edge in edges("bot", "knock")] == ["hall"]


def test_company_is_at_the_same_poi_or_met_head_on() -> None:
    company = {edge.source: edge.guard.integers[0] for edge in edges("bot", "talk")}
    assert company == {
        "hall": (Test("Pguard", 1), Test("Pdog", 1)),
        "shed": (Test("Pguard", 2), Test("Pdog", 2)),
        "going_hall_to_shed": (Test("Pguard", -21), Test("Pdog", -21)),
        "going_shed_to_hall": (Test("Pguard", -12), Test("Pdog", -12)),
    }


def test_nobody_is_their_own_company() -> None:
    text = HOUSE.replace("reacts_to talk, lift", "can_do lift reacts_to lift").replace(
        "can_do nod, lift reacts_to talk", "can_do nod reacts_to lift"
    )
    dog = translate(scenario(text)).automaton("dog")
    guards = [edge.guard.integers[0] for edge in dog.edges if edge.sync and edge.sync.channel == "lift"]
    assert guards == [(Test("Pguard", 1),), (Test("Pguard", 2),)]


def test_an_agent_that_stays_acts_where_it_is() -> None:
    assert [edge.source for edge in edges("guard", "lift")] == ["hall"]
    assert edges("guard", "lift")[0].guard.integers[0] == (Test("Pdog", 1),)


def test_edges_of_agents_that_nobody_controls_are_the_environments() -> None:
    network = house()
    assert all(edge.controllable for edge in network.automaton("bot").edges)
    for agent in ("guard", "dog"):
        assert network.automaton(agent).edges
        assert not any(edge.controllable for edge in network.automaton(agent).edges)


def test_states_follow_their_events() -> None:
    assert [(e.sync, e.assign, e.source, e.target) for e in house().automaton("states").edges] == [
        (Sync("knock", False), (("Sopen", 1),), "base", "base"),
        (Sync("nod", False), (("Sopen", 0),), "base", "base"),
    ]
    assert dict(house().variables)["Sopen"] == 1
