"""Changes on the picture are changes of the text: laid out as fmt does, with every comment, and nothing else."""

from __future__ import annotations

import re
from collections import Counter
from typing import Any, List

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.language.chunks import COMMENTS
from pursue_gen.language.draft import Draft
from pursue_gen.language.formatter import format_text
from pursue_gen.language.kinds import STATEMENTS
from pursue_gen.language.parser import parse
from pursue_gen.tools.draw.operations import change
from pursue_gen.tools.draw.view import view
from tests.conftest import thesis_scenario
from tests.tools.draw.test_draw_groups import HOTEL

COMMENTED = """// the ward at night
poi "pharmacy" // where the medicine is
poi "corridor" /* narrow,
  and dark */
poi "room" //[1.5, 2, 0, 0, 0, 0.7071, 0.7071] beside the window
/* ways */
connect pharmacy and corridor distance 3 // three
connect corridor and room distance /* about */ 4

event "fetch" label "fetch it" location pharmacy duration 3 // slow
event "handOver" collaborative
rule "round": fetch /* first */ before handOver
agent "porter" controllable mobile 1 location corridor // the new one
  can_do fetch, /* then */ handOver
agent "nurse" mobile 3 location room reacts_to handOver
battery porter capacity 100 uses 1 per unit recharges 5 per unit at pharmacy
travel porter from pharmacy to corridor takes 3 to 9
assume: nurse leaves room within 30
reach_objective: do handOver // at last
control : A<>reachObj.win
// the end
"""


def comments(text: str) -> "Counter[str]":
    """The words of all comments but poses."""
    found = (one for one in Draft(text).tokens if one.type in (*COMMENTS, "POSE"))
    words = (re.sub(r"//[ \t]*\[[^\]]*\]", "", one) for one in found)
    return Counter(word for one in words for word in one.replace("//", " ").split())


def done(text: str, do: str, **values: Any) -> str:
    after = change(text, {"do": do, **values}).text
    assert after == format_text(after, "a.pur")
    return after


def number(text: str, begins: str) -> int:
    document = Draft.of(text, "a.pur")
    return next(k for k, one in enumerate(document.statements) if document.text[one.start :].startswith(begins))


def refusal(text: str, do: str, **values: Any) -> str:
    with pytest.raises(PursueError) as caught:
        change(text, {"do": do, **values})
    return f"{caught.value.diagnostics[0].code} {caught.value.diagnostics[0].message}"


def test_a_scenario_is_built_from_nothing() -> None:
    text = done("", "add place", x=1.234, y=-0.001)
    text = done(text, "add place", x=4, y=5.5)
    text = done(text, "connect", a="place1", b="place2")
    text = done(text, "add agent", location="place1")
    text = done(text, "add event", location="place2")
    text = done(text, "set", statement=number(text, "agent"), fields={"can_do": ["work1"]})
    text = done(text, "add form", kind="REACH_OBJECTIVE", form=0, values=["work1"])
    assert text == (
        'poi "place1" //[1.23, 0, 0, 0, 0, 0, 1]\npoi "place2" //[4, 5.5, 0, 0, 0, 0, 1]\n\n'
        "connect place1 and place2 distance 6.2\n\n"
        'event "work1" location place2\n\n'
        'agent "bot1" controllable mobile 1 location place1 can_do work1\n\n'
        "reach_objective: do work1\n"
    )


def test_a_place_that_moves_keeps_its_height_its_direction_and_what_stands_behind() -> None:
    text = 'poi "a" //[1, 2, 0.5, 0, 0, 0.6, 0.8] bot [3, 4, 0, 0, 0, 0, 1] by the door\n'
    assert done(text, "move place", name="a", x=7, y=8.25) == (
        'poi "a" //[7, 8.25, 0.5, 0, 0, 0.6, 0.8] bot [3, 4, 0, 0, 0, 0, 1] by the door\n'
    )
    assert "//[7, 8, 0.5, 0, 0, 1, 0] bot" in done(text, "move place", name="a", x=7, y=8, yaw=180)


def test_a_robots_spot_moves_and_the_rest_of_the_comment_stays() -> None:
    text = 'poi "a" //[1, 2, 0, 0, 0, 0, 1] bot [3, 4, 0.5, 0, 0, 0.6, 0.8] porter [5, 6, 0, 0, 0, 0, 1] by the door\n'
    assert done(text, "move spot", name="a", robot="bot", x=7, y=8.25) == text.replace("[3, 4,", "[7, 8.25,")
    assert done(text, "move spot", name="a", robot="porter", x=-1, y=0) == text.replace("[5, 6,", "[-1, 0,")


@pytest.mark.parametrize(
    ("behind", "expected"),
    [
        ("", "//[1, 2, 0, 0, 0, 0, 1]"),
        ("// a kitchen", "//[1, 2, 0, 0, 0, 0, 1] // a kitchen"),
        ("// kitchen [old]", "//[1, 2, 0, 0, 0, 0, 1] // kitchen [old]"),
        ("//[x, y, z]", "//[1, 2, 0, 0, 0, 0, 1]"),
        ("/* a\nkitchen */", "//[1, 2, 0, 0, 0, 0, 1]\n/* a\nkitchen */"),
        ("//[1, 2", "//[1, 2, 0, 0, 0, 0, 1]"),
    ],
)
def test_a_pose_stands_before_other_comments(behind: str, expected: str) -> None:
    assert done(f'poi "a" {behind}\n', "move place", name="a", x=1, y=2) == f'poi "a" {expected}\n'


def test_computed_positions_are_written_down_with_the_first_one_that_is_given() -> None:
    text = done('poi "a"\npoi "b"\nconnect a and b distance 2\n', "move place", name="b", x=9, y=0)
    assert [poi.pose is not None for poi in parse(text, "a.pur").pois] == [True, True]


def test_a_new_way_is_as_long_as_the_line_in_the_unit_of_the_others() -> None:
    text = 'poi "a" //[0, 0, 0, 0, 0, 0, 1]\npoi "b" //[2, 0, 0, 0, 0, 0, 1]\npoi "c" //[0, 3, 0, 0, 0, 0, 1]\n'
    assert "connect a and c distance 3\n" in done(text, "connect", a="a", b="c")
    text = done(text, "connect", a="a", b="b", distance="20")
    assert "connect c and a distance 30 one_way\n" in done(text, "connect", a="c", b="a", one_way=True)


def test_a_way_that_is_there_is_shown_and_not_written_twice() -> None:
    text = 'poi "a"\npoi "b"\n\nconnect a and b distance 2\n'
    there = change(text, {"do": "connect", "a": "b", "b": "a"})
    assert (there.text, there.statement) == (text, 2)
    one_way = text.replace("distance 2", "distance 2 one_way")
    assert done(one_way, "connect", a="b", b="a", distance="3", one_way=True).count("connect") == 2


def test_a_name_changes_wherever_it_is_used() -> None:
    text = done(COMMENTED, "rename", kind="POI", name="pharmacy", new="store")
    assert "pharmacy" not in text and text.count("store") == 5


def test_a_name_that_is_taken_or_reserved_is_refused() -> None:
    assert refusal(COMMENTED, "rename", kind="POI", name="room", new="corridor").startswith("LSP002")
    assert refusal(COMMENTED, "add place", x=0, y=0, name="porter") == "DRW001 porter is taken"
    assert refusal(COMMENTED, "add place", x=0, y=0, name="observer").startswith("DRW001 observer is the name of")


def test_parts_are_set_and_left_out() -> None:
    text = format_text(COMMENTED, "a.pur")
    porter, fetch = number(text, 'agent "porter"'), number(text, 'event "fetch"')
    after = done(text, "set", statement=porter, fields={"kind": "person", "mobile": "2.5", "can_do": ["handOver"]})
    assert 'agent "porter" human controllable mobile 2.5 location corridor' in after and "can_do handOver" in after
    after = done(after, "set", statement=porter, fields={"kind": "free", "mobile": "", "reacts_to": ["fetch"]})
    assert 'agent "porter" location corridor' in after and "reacts_to fetch" in after
    after = done(text, "set", statement=fetch, fields={"label": "", "duration": "2 to 4", "at_most": "3"})
    assert 'event "fetch" location pharmacy duration 2 to 4 at_most 3 times // slow' in after
    timed = done("unit second\n" + after, "set", statement=fetch + 1, fields={"duration": "30  s to 1 min 30 s"})
    assert "duration 30 s to 1 min 30 s at_most" in timed
    fast = done(timed, "set", statement=porter + 1, fields={"speed": "0.5"})
    assert 'agent "porter" controllable speed 0.5 location corridor' in fast
    again = done(fast, "set", statement=porter + 1, fields={"mobile": "3"})
    assert 'agent "porter" controllable mobile 3 location corridor' in again
    after = done(after, "set", statement=fetch, fields={"location": "", "duration": "", "only_if": "nurse at room"})
    assert 'event "fetch" at_most 3 times only_if nurse at room // slow' in after


def test_a_number_that_a_person_writes_has_no_remark_on_where_it_comes_from() -> None:
    text = 'poi "a"\npoi "b"\nconnect a and b distance 4.2 // survey: 4.16 m on map.yaml\n'
    after = done(text, "set", statement=2, fields={"distance": "5"})
    assert after.endswith("connect a and b distance 5\n")
    after = done(text.replace("survey", "note"), "set", statement=2, fields={"distance": "5"})
    assert after.endswith("connect a and b distance 5 // note: 4.16 m on map.yaml\n")


def test_a_place_goes_with_its_ways_and_an_agent_with_its_battery() -> None:
    text = 'poi "a" poi "b" connect a and b distance 1 agent "bot" controllable location b battery bot capacity 9'
    text = done(text + " uses 1 per unit // 9\ntravel bot from a to b takes 3", "delete", statement=0)
    assert text == 'poi "b"\n\nagent "bot" controllable location b\n\nbattery bot capacity 9 uses 1 per unit // 9\n'
    assert done(text, "delete", statement=1) == 'poi "b"\n\n// 9\n'


def test_what_is_used_is_not_deleted() -> None:
    text = format_text(COMMENTED, "a.pur")
    lines = text.split("\n")
    event, battery = (next(k for k, one in enumerate(lines, 1) if one.startswith(word)) for word in ("event", "batt"))
    assert refusal(text, "delete", statement=0) == f"DRW001 pharmacy is used in lines {event}, {battery}"


def test_the_query_behind_an_objective_goes_with_it() -> None:
    after = done(COMMENTED, "delete", statement=number(COMMENTED, "reach_objective"))
    assert "control :" not in after and "// at last" in after


def test_a_statement_can_be_written_anew() -> None:
    after = done(COMMENTED, "restate", statement=number(COMMENTED, "assume"), words="assume:nurse never at pharmacy")
    assert "assume: nurse never at pharmacy\n" in after

    def why_not(at: int, words: str) -> str:
        return refusal(COMMENTED, "restate", statement=at, words=words)

    at = number(COMMENTED, "assume")
    assert why_not(at, "assume: nurse").startswith("DRW001 this cannot be written")
    assert why_not(at, 'poi "x" poi "y"').startswith("DRW001 expected the words")
    assert why_not(0, 'poi "x"').startswith("DRW001 this statement has a form")


def test_a_text_with_an_error_is_not_changed() -> None:
    assert refusal('poi "a"\npoi b\n', "add place", x=0, y=0).startswith("DRW002 the text has an error in line 2: ")


@pytest.mark.parametrize(
    "operation",
    [
        None, [], {}, {"do": "fly"}, {"do": ["delete"]}, {"do": "delete", "statement": 99},
        {"do": "delete", "statement": -1}, {"do": "delete", "statement": True}, {"do": "delete"},
        {"do": "add place", "x": "1", "y": 2}, {"do": "add place", "x": float("nan"), "y": 2},
        {"do": "add place", "x": 1e9, "y": 2}, {"do": "add place", "x": 1, "y": 2, "name": 'a" poi "b'},
        {"do": "add place", "x": 1, "y": 2, "name": ["a"]}, {"do": "move place", "name": "nowhere", "x": 1, "y": 1},
        {"do": "move place", "name": "room", "x": 1, "y": 1, "yaw": "north"},
        {"do": "move spot", "name": "room", "robot": "ghost", "x": 1, "y": 1},
        {"do": "connect", "a": "room", "b": "room"},
        {"do": "connect", "a": "room", "b": "nowhere"}, {"do": "connect", "a": "room", "b": "a", "distance": "x"},
        {"do": "add agent", "location": "nowhere"}, {"do": "rename", "kind": "thing", "name": "room", "new": "x"},
        {"do": "rename", "kind": "POI", "name": "room", "new": "a b"}, {"do": "set", "statement": 0},
        {"do": "set", "statement": 0, "fields": {"distance": "3"}},
        {"do": "set", "statement": 0, "fields": {"label": '"'}},
        {"do": "set", "statement": 5, "fields": {"can_do": "fetch"}}, {"do": "add form", "kind": "RULE", "form": 99},
        {"do": "add form", "kind": "AGENTS", "form": 0}, {"do": "add form", "kind": "RULE", "form": 0, "values": ["a"]},
        {"do": "add form", "kind": "REACH_OBJECTIVE", "form": 0, "values": ["a // b"]},
        {"do": "restate", "statement": 13, "words": "assume: nurse /* hm */ never at room"},
    ],
)  # fmt: skip
def test_what_makes_no_sense_is_refused_with_a_reason(operation: Any) -> None:
    with pytest.raises(PursueError) as caught:
        change(COMMENTED, operation)
    assert caught.value.diagnostics[0].message


@pytest.mark.parametrize(
    ("kind", "form"),
    [(token, k) for token, kind in STATEMENTS.items() for k in range(len(kind.forms))],
)
def test_every_form_can_be_filled(kind: str, form: int) -> None:
    given_ = {"POI": "room", "event": "fetch", "agent": "nurse", "state": "dark", "group": "rooms", "thing": "tray"}
    given_["door"], given_["lift"] = "d9", "lift9"
    holes = re.findall(r"\{(=?)([^}]*)\}", STATEMENTS[kind].forms[form].words)
    values = [(what if what.isdigit() else f"{what}9") if example else given_[what] for example, what in holes]
    before = HOTEL if kind == "FOR" else COMMENTED
    text = done(before, "add form", kind=kind, form=form, values=values)
    assert len(Draft(text).statements) == len(Draft(before).statements) + 1
    assert comments(text) == comments(before)


# Any changes, one after the other -------------------------------------------------------------------------------------

COORDINATE = st.integers(-100, 100).map(lambda cm: cm / 10)
NAME = st.sampled_from(["a", "b", "hall", "bot", "fetch", "human", "together", "pharmacy", "porter"])
INDEX = st.integers(0, 20)
FIELDS = st.fixed_dictionaries(
    {},
    optional={
        "label": st.sampled_from(["", "the // hall", "Ä 1"]), "distance": st.sampled_from(["1", "2.5"]),
        "one_way": st.booleans(), "only_if": st.sampled_from(["", "nurse at room", "not (a at b or porter on_way)"]),
        "collaborative": st.booleans(), "together": st.booleans(), "may_stop": st.booleans(),
        "location": st.sampled_from(["", "room", "hall"]),
        "duration": st.sampled_from(["", "3", "2 to 4.5"]), "at_most": st.sampled_from(["", "2"]),
        "kind": st.sampled_from(["robot", "person", "free"]), "mobile": st.sampled_from(["", "1", "0.5"]),
        "can_do": st.lists(NAME, max_size=3), "reacts_to": st.lists(NAME, max_size=2),
    },
)  # fmt: skip
OPERATION = st.one_of(
    st.fixed_dictionaries({"do": st.just("add place"), "x": COORDINATE, "y": COORDINATE}),
    st.fixed_dictionaries({"do": st.just("move place"), "name": NAME, "x": COORDINATE, "y": COORDINATE,
                           "yaw": st.none() | COORDINATE}),
    st.fixed_dictionaries({"do": st.just("move spot"), "name": NAME, "robot": NAME, "x": COORDINATE, "y": COORDINATE}),
    st.fixed_dictionaries({"do": st.just("connect"), "a": NAME, "b": NAME, "one_way": st.booleans()}),
    st.fixed_dictionaries({"do": st.just("add agent"), "location": NAME}),
    st.fixed_dictionaries({"do": st.just("add event"), "location": st.just("") | NAME}),
    st.fixed_dictionaries({"do": st.just("rename"), "kind": st.sampled_from(["POI", "event", "agent"]), "name": NAME,
                           "new": NAME}),
    st.fixed_dictionaries({"do": st.just("set"), "statement": INDEX, "fields": FIELDS}),
    st.fixed_dictionaries({"do": st.just("delete"), "statement": INDEX}),
    st.fixed_dictionaries({"do": st.just("restate"), "statement": INDEX,
                           "words": st.sampled_from(["objective: avoid fetch", "assume: nurse never at room"])}),
)


TEXTS = [COMMENTED, "", "// none", thesis_scenario("3").read_text(), HOTEL]


@given(st.sampled_from(TEXTS), st.lists(OPERATION, max_size=8))
def test_any_changes_leave_a_text_as_fmt_writes_it_with_all_comments(text: str, operations: List[Any]) -> None:
    before = comments(text)
    for operation in operations:
        try:
            text = change(text, operation).text
        except PursueError:
            continue
        assert text == format_text(text, "a.pur")
        assert comments(text) == before


def test_the_size_of_a_robot_and_lengths_have_fields() -> None:
    text = 'unit second\n\npoi "a"\npoi "b"\n\nconnect a and b distance 3 m\n\nagent "bot" controllable location a\n'
    at = number(text, "agent")
    after = done(text, "set", statement=at, fields={"inflation": "0.5", "radius": "20  cm"})
    assert 'agent "bot" controllable radius 20 cm inflation 0.5 location a' in after
    (shown,) = view(after)["agents"]
    assert view(after)["pace"] == "seconds per metre" and view("")["pace"] == "time units per unit of distance"
    assert (shown["radius"], shown["tolerance"], shown["inflation"]) == ("20 cm", "", "0.5")
    assert " radius " not in done(after, "set", statement=at, fields={"radius": ""})
    assert refusal(text, "set", statement=at, fields={"radius": "20 s"}).startswith("DRW001 radius is '20 s'")
    assert "distance 80 cm" in done(text, "set", statement=number(text, "connect"), fields={"distance": "80 cm"})
    third = done(text, "add place", x=0, y=4, name="c")
    assert re.search(r"connect a and c distance [0-9.]+ m\n", done(third, "connect", a="a", b="c"))
    filled = {"kind": "CONNECT", "form": 0, "values": ["b", "c", "1.5 m"]}
    assert "connect b and c distance 1.5 m\n" in done(third, "add form", **filled)


def test_the_size_of_a_robot_stays_when_something_else_of_it_changes() -> None:
    size = "radius 0.2 tolerance 0.1 inflation 0.5"
    text = f'poi "a"\n\nagent "bot" controllable mobile 1 {size} location a\n'
    assert view(text)["agents"][0]["mobile"] == "1"
    at = number(text, "agent")
    assert f"mobile 3 {size} location a" in done(text, "set", statement=at, fields={"mobile": "3"})
    assert f'"bot" {size} location a' in done(text, "set", statement=at, fields={"mobile": "", "kind": "free"})
