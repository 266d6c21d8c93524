"""What editors say and propose of groups, of variables, and of what is for each of a group."""

from __future__ import annotations

import re
from typing import List

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import check, parse
from pursue_gen.language.document import edited
from pursue_gen.language.draft import Draft, definition, rename, same_name
from pursue_gen.language.writer import _meaning
from pursue_gen.tools.lsp.completion import complete
from pursue_gen.tools.lsp.convert import inlay_hints
from pursue_gen.tools.lsp.hover import hover
from pursue_gen.tools.lsp.open_document import OpenDocument

HOTEL = """\
poi "hall"
poi "room1"
poi "room2"
group "rooms": room1, room2
for each r in rooms: connect hall and r distance 3
for each r in rooms: event "call" of r location r
for each r in rooms: event "look" of r location r duration 2
for each r in rooms: agent "guest" of r mobile 3 location r can_do call of r
agent "bob" controllable mobile 1 location hall can_do look of rooms
agent "ida" controllable mobile 1 location hall can_do look of rooms
for each r in rooms: objective: if call of r then look of r within 60
for each two robots a, b: objective: a never_with b at room1
objective: avoid any of robots at any of rooms and guest_room1 on_way
"""


def at(before: str) -> int:
    return HOTEL.index(before) + len(before)


def labels(line: str) -> List[str]:
    return [item.label for item in complete(Draft.of(HOTEL + line, "x.pur"), len(HOTEL + line))]


# Names ----------------------------------------------------------------------------------------------------------------


def test_a_group_is_found_wherever_it_is_named() -> None:
    document = Draft.of(HOTEL, "x.pur")
    places = same_name(document, at("in ro"))
    assert [HOTEL[p.start : p.end] for p in places] == ["rooms"] * 9
    assert [p.start for p in places] == [match.start() for match in re.finditer("rooms", HOTEL)]
    (declared,) = definition(document, at("can_do look of ro"))
    assert declared.start == at('group "')


def test_a_variable_is_found_in_its_statement_only() -> None:
    document = Draft.of(HOTEL, "x.pur")
    line = HOTEL.index("for each r in rooms: agent")
    places = same_name(document, at("can_do call of "))
    assert [HOTEL[p.start : p.end] for p in places] == ["r"] * 4
    assert all(line <= p.start < line + 80 for p in places)
    (declared,) = definition(document, at("can_do call of "))
    assert declared.start == line + 9


@pytest.mark.parametrize(("before", "old"), [('group "', "rooms"), ("connect hall and ", "r"), ("objective: ", "r")])
def test_another_name_changes_nothing_else(before: str, old: str) -> None:
    document = Draft.of(HOTEL, "x.pur")
    place = at('group "') if old == "rooms" else at(before if before != "objective: " else "if call of ")
    renamed = edited(HOTEL, rename(document, place, "suite"))
    assert _meaning(parse(renamed, "x.pur")) == _meaning(parse(HOTEL, "x.pur"))
    changed = [line for line, before in zip(renamed.split("\n"), HOTEL.split("\n")) if line != before]
    assert len(changed) == (len([line for line in HOTEL.split("\n") if "rooms" in line]) if old == "rooms" else 1)
    assert not any(re.search(rf"\b{old}\b", line) for line in changed)


@given(st.sampled_from(["rooms", "r", "a", "room1", "hall", "bob"]), st.sampled_from(
    ["suite", "r", "a", "b", "rooms", "hall", "guest", "call", "robots", "all", "at", "for", "x y", "call_room1", "2"]
), st.data())  # fmt: skip
def test_a_new_name_keeps_the_meaning_or_is_refused(old: str, new: str, data: st.DataObject) -> None:
    document = Draft.of(HOTEL, "x.pur")
    place = data.draw(st.sampled_from([match.start() for match in re.finditer(rf"\b{old}\b", HOTEL)]))
    before = parse(HOTEL, "x.pur")
    try:
        renamed = edited(HOTEL, rename(document, place, new))
    except PursueError as refused:
        assert refused.diagnostics[0].message
        return
    after = parse(renamed, "x.pur")
    assert not check(after)
    if old in ("rooms", "r", "a"):
        assert _meaning(after) == _meaning(before)
    assert [len(getattr(after, field)) for field in ("events", "safety")] == [
        len(getattr(before, field)) for field in ("events", "safety")
    ]


@pytest.mark.parametrize(
    ("before", "words"),
    [
        ('group "ro', "**rooms**: a group of places\n\n- room1 and room2"),
        ("in ro", "**rooms**: a group of places\n\n- room1 and room2"),
        ("each ", "**r**: each of rooms in turn\n\n- room1 and room2"),
        ("connect hall and ", "**r**: each of rooms in turn\n\n- room1 and room2"),
        ("two robots ", "**a**: one of robots, beside b: every pair once\n\n- bob and ida"),
        ("distance ", "A way of 3 units of distance"),
        ("duration ", "It takes 2 to 3 units of time"),
        ("within ", "The answer must have come 60 units of time later at most"),
        ("any of rob", "**robots**: All agents that are controllable and not human"),
    ],
)
def test_they_are_explained(before: str, words: str) -> None:
    found = hover(Draft.of(HOTEL, "x.pur"), at(before))
    assert found is not None and found.markdown.startswith(words)


def test_what_is_wrong_with_them_is_explained_too() -> None:
    text = 'group "empty":\nfor each x of empty: poi "a"\nfor each y in : poi "b" of y\n'
    for place in range(len(text) + 1):
        hover(Draft.of(text, "x.pur"), place)
        complete(Draft.of(text, "x.pur"), place)
        same_name(Draft.of(text, "x.pur"), place)


# Completion -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("line", "offered", "not_offered"),
    [
        ("for each ", {"two", "robot"}, {"rooms"}),
        ("for each two ", {"robots"}, {"robot"}),
        ("for each r in ", {"rooms", "robots"}, {"room1", "call", "all"}),
        ("for each two r, s in ro", {"rooms", "robots"}, {"room1"}),
        ("for each r in rooms: connect hall and ", {"r", "room1"}, {"rooms"}),
        ("for each r in rooms: objective: if ", {"call of r", "look of r", "bob"}, {"r"}),
        ("for each robot k: objective: k never_with ", {"k", "bob"}, {"rooms"}),
        ('for each r in rooms: event "sing" of ', {"r"}, {"rooms", "robots"}),
        ('agent "eve" location hall can_do ', {"look of rooms", "call of rooms"}, {"look of r"}),
        ('agent "eve" location hall can_do look of ', {"rooms", "robots"}, {"r", "hall"}),
        ("objective: patrol ", {"rooms", "hall"}, {"bob"}),
        ("objective: avoid ", {"any", "all", "none", "no"}, {"rooms"}),
        ("objective: avoid none ", {"of"}, set()),
        ("objective: avoid none of ", {"robots", "rooms"}, {"bob"}),
        ("objective: avoid bob at ", {"any", "hall"}, {"rooms", "none"}),
        ("objective: avoid bob at any ", {"of"}, set()),
        ('rule "trip": call_room1 before ', {"any", "all"}, {"none", "rooms"}),
        ('rule "trip": call_room1 before all ', {"of"}, set()),
        ('rule "trip": call_room1 before all of ', {"rooms"}, {"bob"}),
    ],
)
def test_what_is_proposed(line: str, offered: "set[str]", not_offered: "set[str]") -> None:
    found = set(labels(line))
    assert offered <= found and not (not_offered & found), found


@pytest.mark.parametrize(
    "line",
    [
        "for each r in rooms: objective: if call of r then look of r within 9",
        "for each two robots a, b: objective: a never_with b",
        "objective: avoid none of robots at any of rooms and bob at hall",
        'for each r in rooms, robot b: travel b from hall to r takes 3 to 4',
        'agent "eve" controllable location hall can_do look of rooms',
    ],
)
def test_whoever_follows_the_proposals_can_write_it(line: str) -> None:
    """Each word of the language, group and variable is among what is proposed at its place."""
    for match in re.finditer(r"[a-z_]+", line):
        before, word = line[: match.start()], match[0]
        own = re.search(r"(each|two|robots?|,) \Z", before) and word in ("r", "a", "b")
        if before and not own and not before.endswith(('"', "call ", "look ")):
            found = labels(before)
            assert any(label == word or label.startswith(f"{word} ") for label in found), (before, word)


def test_what_a_line_costs_stands_behind_it_once() -> None:
    document = OpenDocument(HOTEL, "x.pur")
    hints = inlay_hints(document, 0, len(HOTEL))
    lines = [hint.position.line for hint in hints]
    assert len(lines) == len(set(lines)) and any(str(hint.label).endswith(" each") for hint in hints)
