"""Scenarios with an event that keeps its partners busy, for tests of every stage."""

from __future__ import annotations

from tests.stories import files, model, scenario, solved

__all__ = ["files", "model", "scenario", "solved"]

HOTEL = """\
poi "lobby"
poi "lift"
poi "floor"
connect lobby and lift distance 2
connect lift and floor distance 1
event "call"
event "ride" collaborative together location lift duration 4
event "serve" location floor
rule "way": ride before serve
agent "porter" controllable location lift can_do ride
agent "waiter" controllable mobile 1 location lobby can_do serve reacts_to ride
agent "guest" mobile 2 location floor can_do call
reach_objective: do serve
"""
"""A waiter rides in a lift that a porter operates; both are robots."""

TWO_PORTERS = HOTEL.replace(
    'agent "waiter"', 'agent "porter2" controllable mobile 1 location lobby can_do ride\nagent "waiter"'
)
"""Another porter may do it as well."""

CARRY = """\
poi "store"
poi "ramp"
poi "van"
connect store and ramp distance 2
connect ramp and van distance 1
event "lift" collaborative together duration 3
event "load" location van
event "shout"
rule "order": lift before load
agent "bot1" controllable mobile 1 location store can_do lift
agent "bot2" controllable mobile 2 location ramp can_do load reacts_to lift
agent "child" mobile 2 location van can_do shout reacts_to lift
reach_objective: do load
"""
"""An event without a place, with a robot and an uncontrollable agent as partners."""

