"""What comes of statements that are for each of a group is drawn, and changed in its statement only."""

from __future__ import annotations

from typing import Any, Dict

import pytest

from pursue_gen.diagnostics import PursueError
from pursue_gen.language.draft import Draft
from pursue_gen.language.parser import parse
from pursue_gen.tools.draw.operations import change
from pursue_gen.tools.draw.view import forms, view

HOTEL = """poi "hall"  //[0, 0, 0, 0, 0, 0, 1]
poi "room1" //[5, 0, 0, 0, 0, 0, 1]
poi "room2" //[0, 5, 0, 0, 0, 0, 1]

group "rooms": room1, room2

for each r in rooms: poi "door" of r

for each r in rooms: connect hall and door of r distance 3 one_way only_if guest_room1 at r
for each r in rooms: connect door of r and r distance 1

for each r in rooms: event "call" of r location r
for each r in rooms: event "look" of r location r duration 2 to 3 at_most 4 times

for each r in rooms: agent "guest" of r label "the guest" location r can_do call of r
agent "bob" controllable mobile 1 location hall can_do look of rooms
agent "ida" controllable mobile 1 location hall

for each r in rooms: objective: if call of r then look of r within 60
"""


def named(shown: Dict[str, Any], kind: str) -> Dict[str, Dict[str, Any]]:
    return {part["name"]: part for part in shown[kind]}


def line(part: Dict[str, Any]) -> str:
    return HOTEL.split("\n")[part["from"] - 1]


def test_they_are_drawn_with_what_their_statement_says() -> None:
    shown = view(HOTEL)
    places, agents, events = (named(shown, kind) for kind in ("places", "agents", "events"))
    assert list(places) == ["hall", "room1", "room2", "door_room1", "door_room2"]
    door = places["door_room2"]
    assert (door["made"], line(door)) == ("r is room2", 'for each r in rooms: poi "door" of r')
    assert "made" not in places["hall"] and not places["door_room1"]["given"] and shown["computed"]
    assert [(way["a"], way["b"], way["distance"], way["one_way"], way["only_if"]) for way in shown["ways"]] == [
        ("hall", "door_room1", "3", True, "guest_room1 at room1"),
        ("hall", "door_room2", "3", True, "guest_room1 at room2"),
        ("door_room1", "room1", "1", False, ""), ("door_room2", "room2", "1", False, ""),
    ]  # fmt: skip
    look = events["look_room2"]
    assert (look["location"], look["duration"], look["at_most"], look["made"]) == ("room2", "2 to 3", "4", "r is room2")
    guest = agents["guest_room1"]
    assert (guest["kind"], guest["location"], guest["label"]) == ("free", "room1", "the guest")
    assert guest["can_do"] == ["call_room1"]
    assert agents["bob"]["can_do"] == ["look_room1", "look_room2"] and "made" not in agents["bob"]
    assert {"door_room1", "hall"} <= set(shown["names"]["POI"]) and shown["names"]["group"] == ["rooms"]
    assert [one["words"] for one in shown["others"]].count('for each r in rooms: poi "door" of r') == 1


def done(do: str, **values: Any) -> str:
    return change(HOTEL, {"do": do, **values}).text


def number(begins: str) -> int:
    document = Draft.of(HOTEL, "a.pur")
    return next(k for k, one in enumerate(document.statements) if document.text[one.start :].startswith(begins))


@pytest.mark.parametrize(
    ("do", "values"),
    [
        ("move place", {"name": "door_room1", "x": 1, "y": 1}),
        ("move spot", {"name": "door_room1", "robot": "bob", "x": 1, "y": 1}),
        ("rename", {"kind": "event", "name": "look_room1", "new": "see"}),
        ("rename", {"kind": "POI", "name": "door_room1", "new": "gate"}),
    ],
)
def test_they_are_not_changed_one_by_one_and_it_is_said_why(do: str, values: Dict[str, Any]) -> None:
    with pytest.raises(PursueError) as caught:
        done(do, **values)
    (finding,) = caught.value.diagnostics
    assert "is one of a group (r is room1): its statement in line" in finding.message and "write it out" in finding.hint


def test_what_stands_alone_is_changed_as_before() -> None:
    assert "door_room1 and hall" in done("connect", a="door_room1", b="hall")
    assert 'agent "bot1" controllable mobile 1 location door_room2' in done("add agent", location="door_room2")
    assert done("connect", a="door_room1", b="room1") == HOTEL
    assert "can_do look_room2\n" in done("set", statement=number('agent "bob"'), fields={"can_do": ["look_room2"]})
    assert 'poi "hall"  //[2, 2,' in done("move place", name="hall", x=2, y=2)
    with pytest.raises(PursueError, match="taken"):
        done("add event", name="look_room1")
    with pytest.raises(PursueError, match="rooms is used in lines 7, 9"):
        done("delete", statement=number("group"))
    assert "poi" not in done("delete", statement=number('for each r in rooms: poi')).split("group")[1]


def test_groups_are_among_the_forms() -> None:
    offered = {(form["kind"], form["form"]): form for form in forms()}
    assert [hole["of"] for hole in offered["FOR", 0]["holes"]].count("group") == 1
    text = done("add form", kind="FOR", form=0, values=["p", "rooms", "sing", "p", "p"])
    assert 'for each p in rooms: event "sing" of p location p\n' in text
    assert [event.name for event in parse(text, "a.pur").events][-2:] == ["sing_room1", "sing_room2"]
    assert 'group "more": hall' in done("add form", kind="GROUP", form=0, values=["more", "hall"])
    pairs = done("add form", kind="FOR", form=1, values=["x", "y", "x", "y"])
    assert "for each two robots x, y: objective: x never_with y\n" in pairs
