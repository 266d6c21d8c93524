"""An order for one of several robots that share the promises: these stay where they are."""

from __future__ import annotations

import sys
from dataclasses import replace
from functools import lru_cache
from typing import Any, Dict

import pytest
import yaml

from pursue_gen import api
from pursue_gen.diagnostics import PursueError
from pursue_gen.tools.replanning import menu
from pursue_gen.tools.replanning.replan import answer_to
from pursue_gen.tools.replanning.request import Request, read_request
from pursue_gen.workspace import Options
from pursue_gen.workspace.game_file import render

WARD = """
poi "hall"
poi "desk"
poi "pharmacy"
poi "lab"
poi "room1"
poi "room2"
poi "room3"
poi "dock"
connect hall and desk distance 4
connect hall and pharmacy distance 8
connect hall and lab distance 12
connect hall and room1 distance 5
connect hall and room2 distance 5
connect hall and room3 distance 7
connect desk and dock distance 3
thing "pills"
event "fetch" location pharmacy duration 5 takes pills
event "ask1"
event "ask2"
event "tea" on_order
event "give1" location room1 duration 5 gives pills
event "give2" location room2 duration 5 gives pills
event "serve" location room3 duration 6
agent "amy" controllable mobile 1 carries 1 location dock can_do fetch, give1, give2, serve
agent "bob" controllable mobile 1 carries 1 location desk can_do fetch, give1, give2, serve
agent "patient1" location room1 can_do ask1
agent "patient2" location room2 can_do ask2
assume: patient1 waits 120 between ask1
assume: patient2 waits 120 between ask2
objective: if ask1 then give1 within 110
objective: if ask2 then give2 within 110
objective: if tea then serve within 90
objective: patrol hall, lab every 300 by any robot
"""

HOTEL = """
poi "lobby"
poi "kitchen"
poi "laundry"
poi "corridor"
poi "room1"
poi "room2"
poi "room3"
connect lobby and kitchen distance 5
connect lobby and corridor distance 6
connect corridor and laundry distance 4
for each r in rooms: connect corridor and r distance 3
group "rooms": room1, room2, room3
group "suites": room1, room2
thing "towel"
thing "tea"
event "take_towel" location laundry duration 3 takes towel
event "take_tea" location kitchen duration 3 takes tea
event "towels" on_order
for each r in suites: event "ring" of r
for each r in rooms: event "bring" of r location r duration 4 gives towel
for each r in suites: event "serve" of r location r duration 4 gives tea
agent "r1" controllable mobile 1 carries 1 location lobby can_do take_towel, take_tea, bring of rooms, serve of suites
agent "r2" controllable mobile 1 carries 1 location lobby can_do take_towel, take_tea, bring of rooms, serve of suites
for each r in suites: agent "guest" of r location r can_do ring of r
agent "cleaner" mobile 1 location room3
assume: cleaner stays 60 to 300 at each place
for each r in suites: assume: guest of r waits 200 between ring of r
objective: if towels then bring_room1 within 180
for each r in suites: objective: if ring of r then serve of r within 150
objective: avoid any robot at room3 and cleaner at room3
"""


ROOMS = [f"room{number}" for number in range(16)]

FLEET = "\n".join([
    'poi "hall"', *(f'poi "{room}"\nconnect hall and {room} distance {8 + k % 5}' for k, room in enumerate(ROOMS)),
    f'group "rooms": {", ".join(ROOMS)}', 'event "tea" on_order', 'event "serve" location room0 duration 3',
    *(f'agent "bot{number}" controllable mobile 1 location hall can_do serve' for number in range(8)),
    "objective: patrol rooms every 300 by any robot", "objective: if tea then serve within 300",
])  # fmt: skip


@lru_cache(maxsize=None)
def won(text: str) -> api.Solved:
    return api.solve(api.parse(text))


def requested(monkeypatch: pytest.MonkeyPatch, text: str) -> Request:
    """What is asked of the planner for an order at the start."""
    asked = []

    def answer(request: Request, states: int) -> Dict[str, Any]:
        asked.append(request)
        return {"won": True}

    monkeypatch.setattr(menu, "answer_to", answer)
    list(menu.at_start(won(text).scenario, won(text).solution))
    return asked[0]


def test_an_order_is_promised_with_little_work_where_promises_stay_shared_out(monkeypatch: pytest.MonkeyPatch) -> None:
    request = requested(monkeypatch, WARD)
    assert {robot for robots, _ in request.shares for robot in robots} == {"amy", "bob"}
    monkeypatch.setattr(sys.modules[answer_to.__module__], "_FOR_AN_ORDER", 8_000_000)
    assert answer_to(request, 12_000)["won"], "shared out anew it takes more than that"


def test_who_leaves_has_promises_that_go_to_others_in_turn(monkeypatch: pytest.MonkeyPatch) -> None:
    request = requested(monkeypatch, FLEET)
    (gone,) = next(robots for robots, promises in request.shares if len(robots) == 1 and promises)
    quiet = {name: "idle" if place == "atRisk" else place for name, place in request.locations.items()}
    leaves = replace(request, locations=quiet, sooner={}, out_of_service=frozenset({gone}))
    monkeypatch.setattr(sys.modules[answer_to.__module__], "_FOR_AN_ORDER", 1_000_000)
    monkeypatch.setattr(sys.modules[answer_to.__module__], "won_in_shares", lambda *_, **__: None)  # shared out anew
    answer = answer_to(leaves, 12_000)
    assert answer["won"] and not answer["strategies"][f"controller_{gone}"]["strategy"]


def test_somebody_who_stays_where_an_order_finds_them_is_no_hindrance(monkeypatch: pytest.MonkeyPatch) -> None:
    request = requested(monkeypatch, HOTEL)
    monkeypatch.setattr(sys.modules[answer_to.__module__], "_FOR_AN_ORDER", 1_000_000)
    assert answer_to(request, 1_000)["won"], "the game in one piece has more states"


def test_the_workspace_says_how_promises_are_shared_out(monkeypatch: pytest.MonkeyPatch) -> None:
    game = yaml.safe_load(render(won(WARD).scenario, Options(), won(WARD).solution.strategy, "", "0"))
    data = {"format": 1, "game": game, "locations": {}, "values": {}, "clocks": {}, "ahead": 0, "excused": []}
    assert read_request(data).shares == requested(monkeypatch, WARD).shares
    for wrong in ("amy", [["amy"]], [[["amy"], "obj"]], [[["amy"], [3]]]):
        with pytest.raises(PursueError, match="shares is "):
            read_request({**data, "game": {**game, "shares": wrong}})
