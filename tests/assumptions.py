"""Scenarios with assumptions, for tests of every stage."""

from __future__ import annotations

from tests.stories import files, free_model, missions, model, scenario, solved

__all__ = ["files", "free_model", "missions", "model", "scenario", "solved"]

PLAYROOM = """\
poi "room"
event "clean" location room duration 5
event "spill" location room
event "inspect" location room
state "tidy": initially false, true_if clean false_if spill
stateDependency: inspect only_if tidy is_true
agent "bot" controllable location room can_do clean, inspect
agent "child" location room can_do spill
{}
reach_objective: do inspect
"""
"""A robot tidies up, and a child spills."""

TWICE = "assume: child does spill at_most 2 times"
SPACED = "assume: child waits 20 between spill"

CAFE = """\
poi "desk"
poi "room"
connect desk and room distance 4
event "call" location room
event "serve" location room duration 2
event "pay" location desk
agent "waiter" controllable mobile 1 location desk can_do serve, pay
agent "guest" location room can_do call
{}
objective: if call then serve within 20
reach_objective: do pay after 15
"""
"""A guest who calls, and a waiter who answers; won without any assumption as well."""

ONCE = "assume: guest does call at_most 1 times"
IN_ALL = "assume: at_most 1 of call in all"

MUSEUM = """\
poi "hall"
poi "gallery"
poi "store"
connect hall and gallery distance 3
connect gallery and store distance 3
event "goodbye" collaborative location hall
event "look" location gallery duration 4
event "touch" location store
agent "bot" controllable location hall can_do goodbye
agent "visitor" mobile 1 location gallery can_do look, touch reacts_to goodbye
{}
"""
"""A visitor who goes where he likes, and a robot that says goodbye to him."""

LEAVES = "assume: visitor leaves gallery within 30"
STAYS = "assume: visitor stays 5 to 20 at each place"
AWAY = "assume: visitor never at store"
GOODBYE = "reach_objective: do goodbye"
UNTOUCHED = "objective: avoid touch"


PLANT = """\
poi "hall"
poi "m1"
poi "canteen"
connect hall and m1 distance 3
connect m1 and canteen distance 4
event "call" location m1 only_if not mechanic at m1
event "handOver" collaborative location m1
event "eat" location canteen duration 5
event "wave"
agent "bot" controllable mobile 1 location m1 can_do handOver
agent "machine" location m1 can_do call
agent "mechanic" mobile 1 location canteen can_do eat, wave reacts_to handOver
{}
objective: if call then handOver within 25
"""
"""A machine that breaks down, and a robot that hands the spare part over to the mechanic, who eats and walks about."""

COMES = "assume: mechanic reaches m1 within 20 after call"

ROOMS = """\
poi "east"
poi "west"
connect east and west distance 3
event "sing" location west duration 2
event "hush" location east
state "loud": initially false, true_if sing false_if hush
agent "cleaner" controllable mobile 1 location east
agent "anna" mobile 4 location west can_do sing
agent "ben" mobile 4 location east can_do hush
{}
objective: cleaner never_with anna at east
objective: cleaner never_with ben at west
"""
"""A cleaner who keeps out of the way of two visitors; lost without an assumption."""

APART = "assume: not (anna at east and ben at west)"
