"""Groups and `for each`: what they stand for, where findings about it point, and what is refused."""

from __future__ import annotations

import re
from itertools import combinations, product
from time import process_time
from typing import Any, Dict, List, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import parse
from pursue_gen.language.checks import check_reading
from pursue_gen.language.conditions import condition_text
from pursue_gen.language.document import Document, statement_text
from pursue_gen.language.draft import Draft, rename
from pursue_gen.language.formatter import format_text
from pursue_gen.language.parser import read
from pursue_gen.language.rewriting import Rewriting
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.writer import _meaning, scenario_text, written
from pursue_gen.tools.draw.view import view
from pursue_gen.tools.lsp.completion import complete
from pursue_gen.tools.lsp.fixes import fixes
from pursue_gen.tools.lsp.outline import symbols

HOTEL = """\
poi "hall"
poi "room1"
poi "room2"
poi "room3"
group "rooms": room1, room2, room3
for each r in rooms: connect hall and r distance 3 // as the plan says
for each r in rooms: event "call" of r location r
for each r in rooms:
  event "look" of r location r duration 2
for each r in rooms: agent "guest" of r location r can_do call of r
agent "bob" controllable mobile 1 location hall can_do look of rooms
for each r in rooms: objective: if call of r then look of r within 60
"""

WRITTEN_OUT = """\
poi "hall"
poi "room1"
poi "room2"
poi "room3"
connect hall and room1 distance 3
connect hall and room2 distance 3
connect hall and room3 distance 3
event "call_room1" location room1
event "call_room2" location room2
event "call_room3" location room3
event "look_room1" location room1 duration 2
event "look_room2" location room2 duration 2
event "look_room3" location room3 duration 2
agent "guest_room1" location room1 can_do call_room1
agent "guest_room2" location room2 can_do call_room2
agent "guest_room3" location room3 can_do call_room3
agent "bob" controllable mobile 1 location hall can_do look_room1, look_room2, look_room3
objective: if call_room1 then look_room1 within 60
objective: if call_room2 then look_room2 within 60
objective: if call_room3 then look_room3 within 60
"""


def meaning(text: str) -> Any:
    return _meaning(parse(text, "story.pur"))


def found(text: str) -> List[Tuple[str, int, int, str]]:
    """Code, line, column and message of each finding."""
    findings = check_reading(read(text, "story.pur"))
    return [(f.code, f.span.line if f.span else 0, f.span.column if f.span else 0, f.message) for f in findings]


def scenario(*lines: str) -> Scenario:
    return read("\n".join(lines), "story.pur").partial


# What it stands for ---------------------------------------------------------------------------------------------------


def test_a_story_means_what_it_means_written_out() -> None:
    assert meaning(HOTEL) == meaning(WRITTEN_OUT)
    assert found(HOTEL) == found(WRITTEN_OUT) == []


def test_every_pair_once() -> None:
    agents = [f'agent "cart{n}" controllable mobile 1 location a' for n in range(1, 5)]
    text = "for each two x, y in carts: objective: x never_with y"
    story = scenario('poi "a"', *agents, 'group "carts": cart1, cart2, cart3, cart4', text)
    pairs = [f"cart{a} never_with cart{b}" for a, b in combinations(range(1, 5), 2)]
    assert [each.text for each in story.safety] == pairs


def test_each_of_one_group_with_each_of_another() -> None:
    story = scenario(
        'poi "a"', 'poi "b"', 'group "places": a, b',
        'for each p in places, q in places: event "go" of p of q location p',
    )  # fmt: skip
    assert [each.name for each in story.events] == ["go_a_a", "go_a_b", "go_b_a", "go_b_b"]
    assert [each.location and each.location.name for each in story.events] == ["a", "a", "b", "b"]


def test_a_group_stands_for_its_members_in_lists() -> None:
    story = scenario(
        'poi "a"', 'poi "b"', 'poi "c"', 'group "some": a, b', 'group "more": some, c',
        "objective: patrol more every 9 by any robot",
    )  # fmt: skip
    assert [each.place.name for each in story.patrols] == ["a", "b", "c"]


def test_robots_are_a_group_that_is_not_declared() -> None:
    story = scenario(
        'poi "a"', 'poi "b"', 'group "docks": a, b',
        "for each two x, y in robots: objective: x never_with y",
        'for each d in docks: agent "bot" of d controllable mobile 1 location d',
        'agent "nurse" human controllable location a', 'agent "guest" location a',
        'agent "cart" controllable mobile 2 location b',
    )  # fmt: skip
    assert [each.text for each in story.safety] == [
        "bot_a never_with bot_b", "bot_a never_with cart", "bot_b never_with cart"
    ]  # fmt: skip


def test_a_rule_names_one_of_a_group_of_events_or_each_of_them() -> None:
    text = HOTEL + 'event "load" location hall\nagent "eve" controllable location hall can_do load\n'
    said = 'rule "trip" for each robot: load before any of look of rooms\n'
    written = 'rule "trip" for each robot: load before (look_room1 or look_room2 or look_room3)\n'
    assert meaning(text + said) == meaning(text + written)
    assert meaning(text + said.replace("any of", "all of")) == meaning(text + written.replace(" or ", " and "))
    assert said in format_text(text + said, "hotel.pur")


def test_a_group_lists_what_is_of_another_one() -> None:
    text = HOTEL + 'group "looks": look of rooms\nagent "eve" controllable location hall can_do looks\n'
    story = parse(text, "hotel.pur")
    assert [ref.name for ref in story.agents[-1].can_do] == ["look_room1", "look_room2", "look_room3"]
    assert 'group "looks": look of rooms\n' in format_text(text, "hotel.pur")


def test_robots_may_be_a_name() -> None:
    story = scenario('poi "robots"', 'poi "b"', 'group "places": robots, b', 'for each p in places: event "go" of p')
    assert [each.name for each in story.events] == ["go_robots", "go_b"]


@pytest.mark.parametrize(
    ("said", "meant"),
    [
        ("any of carts at door", "cart1 at door or cart2 at door"),
        ("all of carts on_way and guest at door", "(cart1 on_way and cart2 on_way) and guest at door"),
        ("not any of carts doing load", "not (cart1 doing load or cart2 doing load)"),
        (
            "none of carts between door and hall and guest at door",
            "(not cart1 between door and hall and not cart2 between door and hall) and guest at door",
        ),
        ("any of carts on_way from hall to door", "cart1 on_way from hall to door or cart2 on_way from hall to door"),
        ("at_most 1 of carts at door", "at_most 1 of cart1, cart2 at door"),
        ("at_most 1 of carts at any of places", "at_most 1 of cart1, cart2 at hall, door"),
        ("at_most 2 robots at any of places", "at_most 2 robots at hall, door"),
        ("at_most 1 of carts at places", "at_most 1 of cart1, cart2 at hall, door"),
        ("at_most 1 of carts, guest on_way", "at_most 1 of cart1, cart2, guest on_way"),
        ("not at_most 2 robots at door", "not at_most 2 robots at door"),
        ("at_most 1 of wet of rooms is_true", "at_most 1 of wet_a, wet_b is_true"),
        ("guest at door and all of wet of rooms is_true", "guest at door and (wet_a is_true and wet_b is_true)"),
    ],
)
def test_conditions_on_members(said: str, meant: str) -> None:
    groups = ('group "carts": cart1, cart2', 'group "rooms": a, b', 'group "places": hall, door')
    story = scenario(*groups, f"objective: avoid {said}")
    assert story.safety[0].conditions and condition_text(story.safety[0].conditions[0]) == meant


def test_text_without_groups_is_read_as_before() -> None:
    names = 'poi "of"\npoi "two"\nevent "group" location of\nagent "all" location two can_do\n group\n'
    story = read(names, "story.pur")
    assert story.diagnostics == () and [ref.name for ref in story.partial.agents[0].can_do] == ["group"]


NAMES = [f"p{n}" for n in range(6)]
TEMPLATES = [
    'event "see" of {a} location {a}',
    "connect hall and {a} distance 2",
    'state "wet" of {a}: initially false',
    'agent "guest" of {a} location {a} can_do see of {a}',
    "objective: if see of {a} then go within 9",
    'rule "r" of {a} for each robot: see of {a} before go',
    "optional 2 objective: avoid see of {a}",
    "travel bot from hall to {a} takes 3 to 4",
    "objective: patrol {a}, hall in order every 60 by bot",
]


@given(st.lists(st.sampled_from(NAMES), min_size=1, max_size=5, unique=True), st.data())
def test_it_means_what_is_written_out_by_hand(members: List[str], data: st.DataObject) -> None:
    templates = data.draw(st.lists(st.sampled_from(TEMPLATES), unique=True))
    head = [f'poi "{name}"' for name in ("hall", *NAMES)]
    head += ['event "go"', 'agent "bot" controllable location hall can_do go']
    groups = [f'group "some": {", ".join(members)}']
    short = ["for each m in some: " + template.format(a="m") for template in templates]
    plain = [template.replace('" of {a}', '_{a}"').replace(" of {a}", "_{a}") for template in templates]
    long = [template.format(a=member) for template in plain for member in members]
    position = data.draw(st.integers(0, len(head)))
    text = "\n".join([*head[:position], *groups, *head[position:], *short])
    assert _meaning(read(text, "s.pur").scenario) == _meaning(read("\n".join([*head, *long]), "s.pur").scenario)
    laid_out = format_text(text, "s.pur")
    assert format_text(laid_out, "s.pur") == laid_out and laid_out.split() == text.split()


@given(
    st.lists(st.sampled_from(NAMES), min_size=2, max_size=5, unique=True),
    st.lists(st.sampled_from(NAMES), min_size=1, unique=True),
)
def test_all_choices_in_order(members: List[str], others: List[str]) -> None:
    places = [f'poi "{name}"' for name in NAMES]
    groups = [f'group "some": {", ".join(members)}', f'group "others": {", ".join(others)}']
    each = scenario(*places, *groups, 'for each m in some, n in others: event "e" of m of n')
    assert [event.name for event in each.events] == [f"e_{a}_{b}" for a, b in product(members, others)]
    two = scenario(*places, *groups, 'for each two m, n in some: event "e" of m of n')
    assert [event.name for event in two.events] == [f"e_{a}_{b}" for a, b in combinations(members, 2)]


# Findings -------------------------------------------------------------------------------------------------------------


def changed(old: str, new: str) -> str:
    assert old in HOTEL
    return HOTEL.replace(old, new, 1)


@pytest.mark.parametrize(
    ("text", "code", "line", "column", "message"),
    [
        (changed("in rooms: connect", "in roms: connect"), "PML400", 6, 15, "there is no group roms"),
        (changed("in rooms: connect", "in room1: connect"), "PML400", 6, 15, "room1 is a POI, of line 2, and no group"),
        (changed(": room1, room2, room3", ":"), "PML401", 5, 7, "nothing is in rooms"),
        ('poi "a"\nfor each b in robots: battery b capacity 9 uses 1 per unit recharges 1 per unit at a', "PML401", 2,
         15, "nothing is in robots"),
        (changed("room2, room3", "room2, bob"), "PML402", 5, 30, "bob is an agent, and room1 is a POI"),
        (changed("room2, room3", "room2, room2"), "PML403", 5, 30, "room2 is in rooms twice"),
        (changed("each r in rooms: connect hall and r", "each bob in rooms: connect hall and bob"), "PML404", 6, 10,
         "bob is an agent already, of line 11"),
        (changed("each r in rooms: connect hall and r", "each r in rooms, r in rooms: connect r and r"), "PML404", 6,
         22, "r stands here twice"),
        (changed("each r in rooms: connect hall and r", "each rooms in rooms: connect hall and rooms"), "PML404", 6, 10,
         "rooms is a group already, of line 5"),
        (changed("connect hall and r", "connect hall and room1"), "PML405", 6, 10, "r is not used"),
        (changed("can_do look of rooms", "can_do look of hall"), "PML406", 11, 64, "hall is no group, in none"),
        (changed("location r can_do call of r", "location r can_do call of s"), "PML406", 10, 67, "s is no group"),
        (HOTEL + 'group "one": bob\nfor each two a, b in one: objective: a never_with b', "PML407", 14, 22, "no pair"),
        (changed("location hall can_do", "location rooms can_do"), "PML409", 11, 44, "rooms is a group, and one thing"),
        (HOTEL + "objective: if call of rooms then look_room1 within 60", "PML409", 13, 15, "rooms is a group"),
        (HOTEL + 'event "x" of rooms', "PML409", 13, 14, "a statement declares one thing"),
        (HOTEL + "for each r in rooms: for each s in rooms: connect r and s distance 2", "PML410", 13, 22, "`for`"),
        (HOTEL + 'for each r in rooms: group "x": r', "PML410", 13, 22, "`group`"),
        (HOTEL + "objective: avoid any of rooms", "PML411", 13, 18, "`any of`"),
        (changed('group "rooms"', 'group "bob"'), "PML104", 5, 7, "bob is an agent in line 11 and a group here"),
        (HOTEL + 'group "rooms": room1', "PML103", 13, 7, "rooms is declared twice; line 5"),
        (HOTEL + 'group "all": room1\nmission ends when all is answered', "PML102", 13, 7, "all is a word"),
        (changed('group "rooms"', 'group "my rooms"'), "PML101", 5, 7, '"my rooms" cannot be the name of a group'),
        (changed("room2, room3", "room2, rom3"), "PML110", 5, 30, "nothing is called rom3"),
        (changed("for each r in rooms: connect", "for each r of rooms: connect"), "PML010", 6, 12, "expected `in`"),
        (changed("for each r in rooms: connect", "for each r in rooms connect"), "PML010", 6, 20, "expected `:`"),
        (HOTEL + "for each r in rooms:", "PML010", 13, 21, "but the statement ends here"),
        (HOTEL + "for each two a in rooms: connect hall and a distance 1", "PML010", 13, 16, "expected `,`"),
        (changed('room3\nfor', 'room3,\nfor'), "PML010", 5, 36, "but the statement ends here"),
        (HOTEL + 'event "call_room1"', "PML103", 13, 7, "call_room1 is declared twice; line 7 (r is room1) declares"),
        (HOTEL + "objective: avoid call of hall", "PML406", 13, 26, "hall is no group"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_where_it_stands(text: str, code: str, line: int, column: int, message: str) -> None:
    first = found(text)[0]
    assert first[:3] == (code, line, column) and message in first[3], found(text)


def test_a_member_is_named_behind_of_by_its_own_name() -> None:
    text = changed("can_do look of rooms", "can_do look of room1, look of room2, look_room3")
    assert _meaning(parse(text, "story.pur")) == _meaning(parse(HOTEL, "story.pur"))
    more = parse(HOTEL + "objective: if call of room2 then look of room2 within 90\n", "story.pur")
    assert more.objectives[-1].text == "if call_room2 then look_room2 within 90"


def test_nothing_else_is_said_while_a_group_is_wrong() -> None:
    assert [code for code, *_ in found(changed("room2, room3", "room2, room2"))] == ["PML403"]
    assert [code for code, *_ in found(changed('group "rooms":', 'group "rooms"'))] == ["PML010"]


def test_what_is_the_same_for_each_is_said_once() -> None:
    assert found(changed("location r duration", "location rom duration")) == [
        ("PML110", 9, 30, "there is no POI rom"),
    ]  # fmt: skip
    assert found(changed("location r duration", "locatoin r duration"))[0][:3] == ("PML010", 9, 21)


def test_else_the_member_is_named() -> None:
    text = changed("agent \"bob\" controllable mobile 1 location hall can_do look of rooms",
                   'agent "bob" controllable mobile 1 location hall can_do look_room1, look_room2')  # fmt: skip
    (only,) = found(text)
    assert only[1] == 9 and only[3].endswith("(r is room3)") and "look_room3" in only[3]
    assert check_reading(read(text, "story.pur"))[0].hint.endswith("; the line is for each of its group")


def test_of_alone_is_explained() -> None:
    ((code, line, column, _),) = found('poi "a"\nevent "call" of a\n')[:1]
    assert (code, line, column) == ("PML406", 2, 17)


@pytest.mark.parametrize(
    "line",
    [
        'for each a in g, b in g, c in g, d in g: event "e" of a of b of c of d',
        'for each two a, b in g: event "e" of a of b',
        "objective: patrol g, g, g, g, g, g, g, g, g, g, g, g, g, g, g, g, g, g, g, g, g, g, g, g, g by any robot",
        "".join(f'group "h{n}": x of h{n - 1}, y of h{n - 1}\n' for n in range(1, 40)),
    ],
)
def test_too_much_is_refused_soon(line: str) -> None:
    members = [f"m{n}" for n in range(2000)]
    text = f'group "g": {", ".join(members)}\ngroup "h0": m0\n{line}'
    begun = process_time()
    assert "PML408" in [code for code, *_ in found(text)]
    assert process_time() - begun < 20


# What changes a text --------------------------------------------------------------------------------------------------


def test_the_layout_keeps_it() -> None:
    laid_out = format_text(HOTEL, "story.pur")
    assert format_text(laid_out, "story.pur") == laid_out
    assert laid_out.split() == HOTEL.split() and meaning(laid_out) == meaning(HOTEL)
    assert 'for each r in rooms: event "call" of r location r\nfor each r in rooms: event "look"' in laid_out
    assert "for each r in rooms: connect hall and r distance 3 // as the plan says\n" in laid_out


def test_a_scenario_that_is_not_changed_keeps_its_text() -> None:
    story = parse(HOTEL, "story.pur")
    assert written(story) is story
    assert meaning(scenario_text(story)) == meaning(HOTEL)


def test_a_new_statement_stands_among_those_of_its_kind() -> None:
    document = Document(HOTEL)
    after = document.changed(document.inserted('event "sing"')).text
    assert 'duration 2\nevent "sing"\nfor each r in rooms: agent' in after and meaning(after)


def test_a_number_of_one_member_is_not_written() -> None:
    story = parse(HOTEL, "story.pur")
    with pytest.raises(PursueError) as raised:
        Rewriting(story).distance(story.connections[1], 4, "survey: 4")
    (finding,) = raised.value.diagnostics
    assert finding.code == "PML412" and "r is room2" in finding.message and finding.span and finding.span.line == 6


def names(text: str) -> Dict[str, List[int]]:
    """The lines of each name that editors know."""
    document = Draft.of(text, "story.pur")
    lines: Dict[str, List[int]] = {}
    for one in document.occurrences:
        assert document.text[one.start : one.end] == one.name
        lines.setdefault(one.name, []).append(document.lines.of(one.start) + 1)
    return lines


def test_editors_know_the_names_that_stand_there() -> None:
    assert names(HOTEL) == {
        "hall": [1, 6, 11], "room1": [2, 5], "room2": [3, 5], "room3": [4, 5], "bob": [11],
        "rooms": [5, 6, 7, 8, 10, 11, 12], "r": [6, 6, 7, 7, 7, 8, 9, 9, 10, 10, 10, 10, 12, 12, 12],
    }  # fmt: skip


def test_a_member_gets_another_name_everywhere() -> None:
    document = Draft.of(HOTEL, "story.pur")
    after = document.changed(*rename(document, HOTEL.index("room2"), "suite")).text
    assert after == re.sub(r"\broom2\b", "suite", HOTEL)
    assert meaning(after) == meaning(re.sub(r"room2\b", "suite", WRITTEN_OUT))


def test_a_member_behind_of_gets_another_name_too() -> None:
    text = changed("can_do look of rooms", "can_do look of room1, look of room2, look of room3")
    document = Draft.of(text, "story.pur")
    for place in ("room2", "of room2"):
        edits = rename(document, text.index(place) + len(place) - 1, "suite")
        assert document.changed(*edits).text == re.sub(r"\broom2\b", "suite", text)


@pytest.mark.parametrize(("place", "new"), [('"room2', "r"), ('"room2', "rooms"), ('"hall', "r")])
def test_a_name_that_would_mean_something_else_is_refused(place: str, new: str) -> None:
    document = Draft.of(HOTEL, "story.pur")
    with pytest.raises(PursueError):
        rename(document, HOTEL.index(place) + 1, new)


def test_a_member_keeps_its_name_where_a_name_made_of_it_is_used() -> None:
    text = HOTEL + "objective: avoid look_room2\n"
    document = Draft.of(text, "story.pur")
    with pytest.raises(PursueError, match="look_room2"):
        rename(document, text.index("room2"), "suite")


def test_a_statement_is_quoted_with_its_member() -> None:
    story = parse(HOTEL, "story.pur")
    said = "objective: if call of r then look of r within 60 (r is room3)"
    assert statement_text(HOTEL, story.safety[2].span) == said


def test_patrols_in_order_are_one_for_each() -> None:
    story = scenario(
        'poi "a"', 'poi "b"', 'poi "hall"', 'group "rooms": a, b', 'agent "bot" controllable mobile 1 location hall',
        "for each r in rooms: objective: patrol r, hall in order every 60 by bot",
    )  # fmt: skip
    assert [[each.text for each in statement] for statement in story.statements] == [
        ["patrol a, hall in order every 60 by bot"] * 2, ["patrol b, hall in order every 60 by bot"] * 2
    ]  # fmt: skip


# Editors --------------------------------------------------------------------------------------------------------------


def labels(text: str) -> List[str]:
    return [item.label for item in complete(Draft.of(text, "story.pur"), len(text))]


def test_editors_propose_groups_and_what_goes_on() -> None:
    start = labels(HOTEL)
    assert any(label.startswith("group … ") for label in start) and any(label.startswith("for … ") for label in start)
    assert "each" in labels(HOTEL + "for ") and "in" in labels(HOTEL + "for each r ")
    assert {"event", "objective"} <= set(labels(HOTEL + "for each r in rooms: "))
    assert "hall" in labels(HOTEL + 'for each r in rooms: event "sing" of r location ')
    assert {"room1", "bob"} <= set(labels(HOTEL + 'group "more": '))


def test_the_outline_and_the_page_list_them_as_they_are_written() -> None:
    words = "for each r in rooms: connect hall and r distance 3"
    assert words in [symbol.name for symbol in symbols(Draft.of(HOTEL, "story.pur"))]
    shown = view(HOTEL)
    assert words in [other["words"] for other in shown["others"]] and shown["errors"] == 0


def test_a_quick_fix_does_not_change_what_is_for_each() -> None:
    document = Draft.of(changed("location r duration", "location rom duration"), "story.pur")
    assert document.findings and fixes(document, 0, len(document.text)) == ()
