"""Numbers and statements written into a text: they mean what they should, and the rest of the text stays as it is."""

from __future__ import annotations

import re
from fractions import Fraction
from typing import List

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.language.document import Edit, edited
from pursue_gen.language.numbers import exact
from pursue_gen.language.parser import parse
from pursue_gen.language.rewriting import Rewriting
from pursue_gen.language.scenario import Pose, Scenario

TEXT = """// the floor
poi "desk" label "the desk" //[0, 0, 0, 0, 0, 0, 1] by the window
poi "hall" /* wide */ //[4.0, 0, 0, 0, 0, 0, 1]
poi "shelf"

connect desk and hall distance 4 // through the door
connect hall and shelf /* 7? */ distance 6 one_way connect shelf and desk distance 9
event "fetch" location shelf duration 3 // quick
event "drop" location desk duration 3 to 9
agent "bot" controllable mobile 1 location desk can_do fetch, drop /* one
of two */
travel bot from desk to hall
    takes 5 // my watch
reach_objective: do drop"""
FAR = Pose(1.5, -2.25, 0, 0, 0, 0.5**0.5, 0.5**0.5)


def read(text: str = TEXT) -> Scenario:
    return parse(text, "test.pur")


def test_a_distance_is_replaced_and_the_remark_stands_behind_the_statement() -> None:
    scenario = read()
    desk, hall, _ = scenario.connections
    rewriting = Rewriting(scenario)
    text = edited(
        TEXT, [*rewriting.distance(desk, 4, "survey: 4 m"), *rewriting.distance(hall, exact(Fraction("6.5")), "")]
    )
    assert "connect desk and hall distance 4 /* survey: 4 m */ // through the door\n" in text
    assert "connect hall and shelf /* 7? */ distance 6.5 one_way connect shelf and desk distance 9\n" in text
    assert [way.distance for way in read(text).connections] == [4, Fraction("6.5"), 9]


def test_a_remark_goes_to_the_end_of_the_line_where_nothing_else_is_and_replaces_the_one_before() -> None:
    scenario = read()
    text = edited(TEXT, Rewriting(scenario).distance(scenario.connections[2], 8, "survey: 8 m"))
    assert "distance 6 one_way connect shelf and desk distance 8 // survey: 8 m\n" in text
    again = read(text)
    assert Rewriting(again).written_by(again.connections[2].span) == "survey"
    assert Rewriting(again).written_by(again.connections[0].span) is None
    text = edited(text, Rewriting(again).distance(again.connections[2], 7, "calibrate: 30 drives"))
    assert "distance 7 // calibrate: 30 drives\n" in text and "survey" not in text
    last = read(text)
    assert edited(text, Rewriting(last).distance(last.connections[2], 9, "")).split() == TEXT.split()


def test_a_comment_of_the_author_is_no_remark_even_where_it_looks_like_one() -> None:
    scenario = read(TEXT.replace("// through the door", "// note: through the door"))
    found = edited(scenario.text, Rewriting(scenario).distance(scenario.connections[0], 5, "survey: 5 m"))
    assert "distance 5 /* survey: 5 m */ // note: through the door\n" in found


def test_windows_of_movements_and_actions_are_replaced_with_one_number_or_two() -> None:
    scenario = read()
    rewriting = Rewriting(scenario)
    fetch, drop = scenario.events
    text = edited(
        TEXT,
        [
            *rewriting.windows({("bot", "desk", "hall"): (6, 8, "calibrate: 40 drives")}),
            *rewriting.duration(fetch, 2, exact(Fraction("4.5")), ""),
            *rewriting.duration(drop, 4, 7, "calibrate: 12 times"),
        ],
    )
    assert "    takes 6 to 8 /* calibrate: 40 drives */ // my watch\n" in text
    assert "duration 4 to 7 // calibrate: 12 times\n" in text and "duration 2 to 4.5 // quick\n" in text
    again = read(text)
    assert [event.window for event in again.events] == [(2, Fraction("4.5")), (4, 7)]
    assert again.travels[0].window == (6, 8)
    assert Rewriting(again).written_by(again.events[1].span) == "calibrate"


def test_a_window_is_replaced_where_a_name_is_the_word_before_it() -> None:
    text = 'poi "a" poi "to" connect a and to distance 1\nagent "takes" mobile 1 location a\n'
    scenario = read(text + "travel takes from a to to takes 5 to 6")
    found = edited(scenario.text, Rewriting(scenario).windows({("takes", "a", "to"): (7, 9, "")}))
    assert found == text + "travel takes from a to to takes 7 to 9"


def test_sizes_are_replaced_or_come_before_the_location() -> None:
    text = 'poi "a"\nagent "radius" /* old */ controllable radius 0.3 inflation 1 // mine\n  location a\n'
    text += 'agent "b" controllable location a\n'
    scenario = read(text)
    first, second = scenario.agents
    rewriting, size = Rewriting(scenario), {"radius": exact(Fraction("0.21")), "tolerance": exact(Fraction("0.1"))}
    done = edited(text, [*rewriting.size(first, size, ""), *rewriting.size(second, size, "survey: its radius")])
    assert '/* old */ controllable radius 0.21 tolerance 0.1 inflation 1 // mine\n  location a\n' in done
    assert done.endswith('"b" controllable radius 0.21 tolerance 0.1 location a // survey: its radius\n')
    assert [one.radius for one in read(done).agents] == [Fraction("0.21")] * 2


def test_spots_come_behind_the_pose_and_the_rest_of_the_comment_stays() -> None:
    scenario = read()
    rewriting = Rewriting(scenario)
    desk, hall, _ = scenario.pois
    text = edited(
        TEXT, [*rewriting.spots(desk, [("bot", FAR)], "survey: bot"), *rewriting.spots(hall, [("bot", FAR)], "")]
    )
    pose = "[1.5, -2.25, 0, 0, 0, 0.707107, 0.707107]"
    assert f"//[0, 0, 0, 0, 0, 0, 1] bot {pose} by the window; survey: bot\n" in text
    assert f"/* wide */ //[4.0, 0, 0, 0, 0, 0, 1] bot {pose}\n" in text
    for poi in read(text).pois[:2]:
        (spot,) = poi.spots
        assert spot.robot.name == "bot" and (spot.pose.x, spot.pose.y) == (1.5, -2.25)


@pytest.mark.parametrize(
    ("behind", "before", "after"),
    [
        (("TRAVEL", "AGENT"), "takes 5 // my watch\n", "\nreach_objective"),
        (("AGENT",), "of two */\n", "\ntravel bot"),
        (("CONNECT",), "shelf and desk distance 9\n", "\nevent"),
        (("POI",), 'poi "shelf"\n', "\n\nconnect"),
        ((), "reach_objective: do drop\n", "\n"),
    ],
)
def test_new_statements_come_below_the_last_one_of_their_kind(behind: List[str], before: str, after: str) -> None:
    line = "// new"
    text = edited(TEXT, Rewriting(read()).statements(behind, [line, line]))
    assert f"{before}{line}\n{line}{after}" in text
    assert edited(TEXT, Rewriting(read()).statements(behind, [])) == TEXT


def test_a_statement_added_to_a_text_without_travel_times_is_read() -> None:
    text = re.sub(r"travel.*\n.*\n", "", TEXT)
    added = edited(
        text, Rewriting(read(text)).statements(("TRAVEL", "AGENT"), ["travel bot from hall to desk takes 1 to 2"])
    )
    assert [travel.window for travel in read(added).travels] == [(1, 2)]


NUMBERS = st.integers(1, 10**6).map(lambda thousandths: exact(Fraction(thousandths, 1000)))
REMARKS = st.sampled_from(["", "survey: 4 m on map.yaml", "calibrate: 12 drives"])
BEHIND = st.sampled_from(
    ["", " // mine", " /* mine */", " /* survey: 1 m */", " // survey: 1 m", "\n// alone", " /* a\nb */ // c"]
)


@given(st.lists(st.tuples(NUMBERS, NUMBERS, REMARKS, BEHIND), min_size=1, max_size=6))
def test_what_is_written_is_read_again_and_all_other_words_and_comments_stay(ways: List[tuple]) -> None:  # type: ignore[type-arg]
    text = "".join(f'poi "p{k}"\n' for k in range(len(ways) + 1))
    text += "".join(f"connect p{k} and p{k + 1} distance {old}{behind}\n" for k, (old, _, _, behind) in enumerate(ways))
    scenario = read(text)
    rewriting = Rewriting(scenario)
    edits: List[Edit] = []
    for way, (_, new, remark, _) in zip(scenario.connections, ways):
        edits += rewriting.distance(way, new, remark)
    found = edited(text, edits)
    assert [way.distance for way in read(found).connections] == [new for _, new, _, _ in ways]
    theirs = re.compile(r"// ?mine|/\* mine \*/|// alone|/\* a\nb \*/ // c")
    assert theirs.findall(found) == theirs.findall(text)
    for way, (_, _, remark, _) in zip(read(found).connections, ways):
        assert (Rewriting(read(found)).written_by(way.span) or "") == remark.partition(":")[0]
