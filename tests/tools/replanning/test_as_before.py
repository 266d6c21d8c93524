"""An order for one of several robots that share the promises: these stay where they are."""

from __future__ import annotations

import sys
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


@lru_cache(maxsize=None)
def won() -> api.Solved:
    return api.solve(api.parse(WARD))


def requested(monkeypatch: pytest.MonkeyPatch) -> Request:
    """What is asked of the planner for an order at the start."""
    asked = []

    def answer(request: Request, states: int) -> Dict[str, Any]:
        asked.append(request)
        return {"won": True}

    monkeypatch.setattr(menu, "answer_to", answer)
    list(menu.at_start(won().scenario, won().solution))
    return asked[0]


def test_an_order_is_promised_with_little_work_where_promises_stay_shared_out(monkeypatch: pytest.MonkeyPatch) -> None:
    request = requested(monkeypatch)
    assert {robot for robots, _ in request.shares for robot in robots} == {"amy", "bob"}
    monkeypatch.setattr(sys.modules[answer_to.__module__], "_FOR_AN_ORDER", 8_000_000)
    assert answer_to(request, 12_000)["won"], "shared out anew it takes more than that"


def test_the_workspace_says_how_promises_are_shared_out(monkeypatch: pytest.MonkeyPatch) -> None:
    game = yaml.safe_load(render(won().scenario, Options(), won().solution.strategy, "", "0"))
    data = {"format": 1, "game": game, "locations": {}, "values": {}, "clocks": {}, "ahead": 0, "excused": []}
    assert read_request(data).shares == requested(monkeypatch).shares
    for wrong in ("amy", [["amy"]], [[["amy"], "obj"]], [[["amy"], [3]]]):
        with pytest.raises(PursueError, match="shares is "):
            read_request({**data, "game": {**game, "shares": wrong}})
