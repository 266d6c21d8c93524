"""pursue-gen survey: the copy with what was measured, what is reported, and what is refused."""

from __future__ import annotations

import json
import math
import re
import shutil
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import pytest

from pursue_gen.language import check, load
from pursue_gen.language.times import duration_text
from tests.conftest import ROOT
from tests.survey.maps import drawn, three_rooms, write
from tests.tools.authoring.commands import Outcome, pursue

TEXT = """// three rooms
poi "desk" //[1.0, 1.0, 0, 0, 0, 0, 1] by the window
poi "hall" //[6.0, 3.0, 0, 0, 0, 0, 1]
poi "shelf" //[11.0, 5.0, 0, 0, 0, 0.7071068, 0.7071068]

connect desk and hall distance 6 // through the door
connect hall and shelf distance 5.8

event "fetch" location shelf duration 3
event "drop" location desk
rule "order": fetch before drop
agent "bot1" controllable mobile 2.5 location desk can_do fetch, drop
agent "bot2" controllable mobile 2.5 location hall can_do fetch, drop // the old one
travel bot2 from hall to desk takes 9 to 30 // my watch
reach_objective: do drop
"""


CELL = 0.1  # metres: a coarse map is surveyed quickly


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    write(tmp_path, three_rooms(resolution=CELL), CELL)
    Path("rooms.pur").write_text(TEXT)
    return tmp_path


def surveyed(*options: object, text: str = TEXT, status: int = 0) -> Outcome:
    Path("rooms.pur").write_text(text)
    done = pursue("survey", "map.yaml", "rooms.pur", "--force", *options)
    assert done.status == status, done.err
    return done


def copied() -> str:
    return Path("rooms_surveyed.pur").read_text()


def codes(done: Outcome) -> Any:
    return re.findall(r"(?:warning|error) ([A-Z]{3}\d{3})", done.err)


def test_the_copy_has_what_was_measured_and_all_else_as_it_was() -> None:
    done = surveyed("--speed", "bot1=0.4", "--speed", "0.5")
    assert Path("rooms.pur").read_text() == TEXT
    way = r"connect desk and hall distance 6\.\d /\* survey: (6\.\d\d) m on map\.yaml \*/ // through the door"
    metres = re.search(way, copied())
    assert metres and 6.4 < float(metres[1]) < 7
    assert f"desk - hall     {metres[1]}  6 -> 6." in done.out
    assert "\ntravel bot2 from hall to desk takes 9 to 30 // my watch\n" in copied()
    assert re.search(
        r"\ntravel bot1 from desk to hall takes 1\d to \d+ // survey: at 0\.4 m/s on map\.yaml\n", copied()
    )
    assert copied().count("travel bot2") == 4 and "survey: at 0.5 m/s" in copied()
    assert re.search(r"0, 1\] bot2 \[[-\d., ]+\] by the window; survey: bot2 beside it on map\.yaml\n", copied())
    left = re.sub(r" bot2 \[[^\]]*\]|;? survey: bot2[^\n]*| ?(//|/\*) survey: [^*\n]*( \*/)?", "", copied())
    left = re.sub(r"travel bot\d from \w+ to \w+ takes \d+ to \d+\n(?=travel|reach)", "", left)
    words, theirs = re.sub(r"distance \S+", "", left).split(), re.sub(r"distance \S+", "", TEXT).split()
    assert words == theirs
    assert check(load("rooms_surveyed.pur")) == ()


def test_the_copy_of_a_copy_is_the_copy() -> None:
    surveyed("--speed", "0.5", "--ways")
    first = copied()
    again = pursue("survey", "map.yaml", "rooms_surveyed.pur", "--speed", "0.5", "--ways", "-o", "again.pur")
    assert again.status == 0 and Path("again.pur").read_text() == first
    slower = pursue("survey", "map.yaml", "rooms_surveyed.pur", "--speed", "0.25", "-o", "slower.pur")
    assert slower.status == 0 and "0.5 m/s" not in Path("slower.pur").read_text()


def test_a_map_that_is_turned_gives_the_same_lengths(folder: Path) -> None:
    first = json.loads(surveyed("--json").out)["ways"]
    write(
        folder, three_rooms(resolution=CELL), CELL, f"[6.0, 0.0, {math.pi / 2!r}]"
    )  # (x, y) of the image is at (6 - y, x)
    turned = re.sub(r"//\[([\d.]+), ([\d.]+),", lambda at: f"//[{6 - float(at[2])}, {at[1]},", TEXT)
    second = json.loads(surveyed("--json", text=turned).out)["ways"]
    assert [way["metres"] for way in second] == pytest.approx([way["metres"] for way in first], rel=0.01)


def test_places_in_walls_and_too_near_to_them_keep_their_distances() -> None:
    text = TEXT.replace("//[6.0, 3.0", "//[4.0, 1.0").replace("//[11.0, 5.0", "//[11.75, 5.0")
    done = surveyed("--dry-run", text=text)
    assert codes(done) == ["WSP008", "MAP003"]
    assert "rooms.pur:3:5: warning WSP008: the pose of hall (4, 1) is in an obstacle" in done.err
    assert "rooms.pur:4:5: warning MAP003: the pose of shelf (11.75, 5) is nearer than 0.3 m" in done.err
    assert "there is room at 11.45, 5.05, 0.30 m from there" in done.err
    assert "6 stays: hall is not on free ground" in done.out
    assert "Ways that could not be measured are as you wrote them" in done.err and "next:" not in done.err
    assert not Path("rooms_surveyed.pur").exists()


def test_a_place_in_a_wall_is_found_first_and_the_copy_is_written_though_it_has_errors() -> None:
    text = re.sub(r"connect.*\n|travel.*\n", "", TEXT).replace("//[6.0, 3.0", "//[4.0, 1.0")
    text = text.replace("location desk\nrule", "location hall\nrule")
    done = surveyed(text=text, status=3)
    assert codes(done)[0] == "WSP008" and set(codes(done)[1:]) == {"PML153"}
    assert re.search(r"warning WSP008: .*\n.*\n.*\n    help: there is room at 4\.55, 1\.05, 0\.55 m", done.err)
    assert "wrote rooms_surveyed.pur\n" in done.err and "next:" not in done.err
    line = re.search(r"rooms_surveyed\.pur:(\d+):\d+: error PML153: bot1 can never do drop", done.err)
    assert line and "can_do fetch, drop" in copied().splitlines()[int(line[1]) - 1], "as a line of the copy"
    assert re.search(r"\nconnect desk and shelf distance 1\d", copied()), "what can be measured is"
    checked = pursue("check", "rooms.pur", "--map", "map.yaml")
    assert checked.status == 3 and "WSP008: the pose of hall (4, 1) is in an obstacle" in checked.out
    with_json = json.loads(surveyed("--json", "--dry-run", text=text, status=3).out)
    assert {one["code"] for one in with_json["findings"]} == {"WSP008", "PML153"} and with_json["ways"]


@pytest.mark.parametrize(
    ("pose", "told", "remedy"),
    [
        ("12.1, 1.0", "is off the map", "there is room at 11.45, 1.05, 0.65 m from there"),
        ("500, 1.0", "is off the map", "the map reaches from 0.0 to 12.0 in x and from 0.0 to 6.0 in y"),
        ("4.0, 1.0", "is in an obstacle of the map", "there is room at 4.55, 1.05, 0.55 m from there"),
    ],
)
def test_a_place_that_is_not_on_free_ground_is_told_where_there_is_room(pose: str, told: str, remedy: str) -> None:
    done = surveyed("--dry-run", text=TEXT.replace("//[6.0, 3.0", f"//[{pose}"))
    assert f"{told}\n" in done.err and remedy in done.err
    checked = pursue("check", "rooms.pur", "--map", "map.yaml")
    assert f"{told}\n" in checked.out and remedy in checked.out


def test_a_door_that_is_too_narrow_is_reported_with_the_way(folder: Path) -> None:
    write(folder, three_rooms(0.6, CELL), CELL)
    done = surveyed()
    assert codes(done) == ["MAP004", "MAP004"] and "a robot cannot get from desk to hall" in done.err
    assert "6 stays: the map has no path" in done.out and "distance 6 // through" in copied()
    assert codes(surveyed("--radius", "0.2")) == []


def test_the_copy_has_the_size_that_was_told_and_other_commands_find_it_there() -> None:
    Path("costmap.yaml").write_text("footprint: [[0.3, 0.4], [-0.3, -0.4]]\nfootprint_padding: 0\n")
    text = TEXT.replace("location hall", "radius 0.6 location hall")
    done = surveyed("--robot", "bot1=costmap.yaml", "--robot", "0.2", text=text)
    remark = "survey: its radius by --robot"
    assert f'"bot1" controllable mobile 2.5 radius 0.5 location desk can_do fetch, drop // {remark}\n' in copied()
    assert f"radius 0.2 location hall can_do fetch, drop /* {remark} */ // the old one\n" in copied()
    Path("near.pur").write_text(copied().replace("//[1.0, 1.0", "//[0.5, 1.0"))
    checked = pursue("check", "near.pur", "--map", "map.yaml")
    assert "the pose of desk (0.5, 1) is nearer than 0.5 m, the robots' radius, to an obstacle" in checked.out
    assert "nearer than 0.5 m" not in pursue("check", "near.pur", "--map", "map.yaml", "--robot", "0.2").out
    again = surveyed(text=copied())
    assert codes(again) == codes(done) and copied().count("--robot") == 2
    surveyed("--radius", "0.2")
    assert "radius" not in copied(), "that is for one survey only"


def test_places_too_near_for_two_robots_and_ways_through_third_places_are_reported() -> None:
    near = TEXT.replace('poi "shelf"', 'poi "sofa" //[6.0, 3.5, 0, 0, 0, 0, 1]\npoi "shelf"')
    near = near.replace("connect hall and shelf distance 5.8", "connect desk and shelf distance 12")
    done = surveyed(text=near + "")
    assert codes(done).count("MAP005") == 1
    told = "the pose of sofa (6, 3.5) is 0.50 m from the pose of hall: two robots with a radius of 0.3 m and a goal "
    assert f"{told}tolerance of 0.1 m need 0.8 m" in done.err
    assert "MAP006" in codes(done) and re.search("from desk to shelf leads through .*hall, where", done.err)
    assert re.search("connect desk and .*hall and shelf instead", done.err)
    assert "MAP005" not in codes(surveyed("--radius", "0.15", text=near))


def test_a_spot_on_the_way_of_others_is_told_where_it_is_not() -> None:
    text = TEXT.replace("//[1.0, 1.0, 0, 0, 0, 0, 1]", "//[1.0, 1.0, 0, 0, 0, 0, 1] bot2 [9.5, 3.3, 0, 0, 0, 0, 1]")
    done = surveyed(text=text)
    told = r"rooms\.pur:2:\d+: warning MAP006: the spot of bot2 at desk \(9\.5, 3\.3\) is 0\.\d\d m from the way from "
    assert codes(done) == ["MAP006"] and re.search(told + "hall to shelf", done.err)
    x, y = re.search(r"there is room at ([\d.]+), ([\d.]+), ", done.err).groups()  # type: ignore[union-attr]
    assert codes(surveyed(text=text.replace("[9.5, 3.3,", f"[{x}, {y},"))) == []
    one = text.replace('agent "bot1" controllable', 'agent "bot1"')
    assert codes(surveyed(text=one)) == [], "nobody else drives there"


def test_check_and_ws_say_on_a_map_what_survey_says(monkeypatch: pytest.MonkeyPatch) -> None:
    text = TEXT.replace("connect hall and shelf distance 5.8", "connect desk and shelf distance 12")
    text = text.replace("//[6.0, 3.0, 0, 0, 0, 0, 1]", "//[6.0, 3.0, 0, 0, 0, 0, 1] bot2 [9.5, 3.3, 0, 0, 0, 0, 1]")
    text = text.replace("//[11.0, 5.0", "//[11.55, 5.0")
    done = surveyed(text=text, status=0)
    checked = pursue("check", "rooms.pur", "--map", "map.yaml")
    assert {"MAP003", "MAP006"} <= set(codes(done))
    assert set(codes(done)) - {"MAP008"} == set(re.findall(r"warning (MAP\d{3})", checked.out))
    monkeypatch.setitem(sys.modules, "scipy", None)
    alone = pursue("check", "rooms.pur", "--map", "map.yaml")
    assert "MAP003" in alone.out and "MAP006" not in alone.out and "Ways are not looked at" in alone.err


def test_a_place_behind_a_closed_door_is_told_the_nearest_point_that_can_be_reached(folder: Path) -> None:
    write(folder, drawn((12, 6), [(7.9, 0.0, 8.1, 6.0)], resolution=CELL), CELL)
    done = surveyed(text=TEXT.replace("//[11.0, 5.0", "//[8.6, 5.0"))
    assert codes(done) == ["MAP004"] and "a robot cannot get from hall to shelf" in done.err
    assert re.search(r"help: desk reaches 7\.45, 5\.05, 1\.15 m from shelf; or look for a door", done.err)


def test_missing_ways_are_proposed_and_written_on_demand() -> None:
    text = TEXT.replace("connect hall and shelf distance 5.8\n", "connect desk and shelf distance 12\n")
    assert "hall - shelf" in surveyed(text=text).out and "connect hall and shelf" not in copied()
    surveyed("--ways", text=text)
    assert re.search(r"distance 1[23]\S* // survey: .*\nconnect hall and shelf distance \S+ // survey: ", copied())


def test_a_scenario_without_ways_gets_them() -> None:
    surveyed("--speed", "0.5", text=re.sub(r"connect.*\n|travel.*\n", "", TEXT))
    assert len(load("rooms_surveyed.pur").connections) == 2 and len(load("rooms_surveyed.pur").travels) == 8
    assert check(load("rooms_surveyed.pur")) == ()


@pytest.mark.parametrize(
    ("text", "options", "reason"),
    [
        (TEXT.replace("//[6.0, 3.0, 0, 0, 0, 0, 1]", ""), [], "hall has no pose"),
        (TEXT.replace("//[6.0, 3.0, 0", "//[6.0, 3.0, 3"), [], "its places are on different floors"),
        (TEXT, ["--keep", "hall,desk"], "--keep"),
        (
            TEXT.replace("distance 6", "distance 6 one_way connect hall and desk distance 9 one_way"),
            [],
            "each direction has its own",
        ),
    ],
)
def test_a_distance_stays_where_there_is_a_reason(text: str, options: Any, reason: str) -> None:
    assert f"6 stays: {reason}" in surveyed(*options, text=text).out
    assert "connect desk and hall distance 6 " in copied()


def test_distances_are_of_the_unit_and_as_fine_as_the_times_allow() -> None:
    done = surveyed("--unit", "2")
    assert re.search(r"distance 3\.\d /\* survey: 6\.\d\d m on map\.yaml, 2 m per unit \*/", copied())
    surveyed(text=TEXT.replace("mobile 2.5", "mobile 2.125", 1))
    assert "connect desk and hall distance 7 /*" in copied()
    done = surveyed(text=TEXT.replace("distance 6", "distance 1").replace("5.8", "1"))
    assert codes(done) == ["MAP008"] and "bot1 and bot2 will take" in done.err
    assert codes(surveyed("--speed", "1", text=TEXT.replace("distance 6", "distance 1").replace("5.8", "1"))) == []


def test_ways_that_are_equally_wrong_are_no_hindrance() -> None:
    text = TEXT.replace("[6.0, 3.0", "[1.0, 3.0").replace("[11.0, 5.0", "[1.0, 5.0").replace("5.8", "6")
    done = surveyed(text=text)
    assert codes(done) == ["MAP008"] and "ways are 0.3 times as long as written" in done.err


def test_line_ends_stay_as_they_are() -> None:
    Path("rooms.pur").write_bytes(TEXT.replace("\n", "\r\n").encode())
    assert pursue("survey", "map.yaml", "rooms.pur").status == 0
    copy = Path("rooms_surveyed.pur").read_bytes()
    assert copy.count(b"\r\n") == copy.count(b"\n") > 10


def test_nothing_is_replaced_without_force_and_never_through_a_link() -> None:
    Path("rooms_surveyed.pur").write_text("mine")
    done = pursue("survey", "map.yaml", "rooms.pur")
    assert done.status == 2 and "--force" in done.err and copied() == "mine"
    same = pursue("survey", "map.yaml", "rooms.pur", "-o", "rooms.pur")
    assert same.status == 2 and Path("rooms.pur").read_text() == TEXT
    Path("rooms_surveyed.pur").unlink()
    Path("rooms_surveyed.pur").symlink_to("rooms.pur")
    done = pursue("survey", "map.yaml", "rooms.pur", "--force", "--picture", "plan.svg")
    assert not Path("plan.svg").exists()
    assert done.status == 2 and "link" in done.err and Path("rooms.pur").read_text() == TEXT
    assert pursue("survey", "map.yaml", "rooms.pur", "-o", "rooms.pur", "--force").status == 0
    assert "survey: " in Path("rooms.pur").read_text()


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--speed", "bot3=1"], "bot3 is not a robot of the scenario"),
        (["--speed", "bott1=1"], "did you mean bot1?"),
        (["--speed", "bot1=fast"], "expected metres per second"),
        (["--speed", "0"], "expected metres per second"),
        (["--keep", "desk,shelf"], "the scenario has no such way"),
        (["--keep", "desk"], "expected two places"),
        (["--radius", "-1"], "expected a number from 0 to 1000"),
        (["--unit", "nan"], "expected a number from 0.001"),
    ],
)
def test_what_cannot_be_meant_is_refused(options: Any, told: str) -> None:
    done = surveyed(*options, status=2)
    assert told in " ".join(done.err.split()) and not Path("rooms_surveyed.pur").exists()


@pytest.mark.parametrize(
    ("text", "options", "told"),
    [
        (re.sub(r"//\[.*", "", TEXT), [], "rooms.pur:2:5: error MAP001: 0 places of 3 with a pose"),
        (TEXT, ["--radius", "5"], "error MAP001: map.yaml has no free ground"),
        (TEXT.replace("location desk", "location dest"), [], "rooms.pur:12:"),
    ],
)
def test_a_scenario_with_which_nothing_can_be_measured_is_reported(text: str, options: Any, told: str) -> None:
    done = surveyed(*options, text=text, status=3)
    assert told in done.err and not Path("rooms_surveyed.pur").exists()


def test_maps_that_cannot_be_read_are_reported() -> None:
    assert pursue("survey", "none.yaml", "rooms.pur").status == 2
    Path("map.yaml").write_text(Path("map.yaml").read_text() + "mode: wild\n")
    done = pursue("survey", "map.yaml", "rooms.pur")
    assert done.status == 2 and "map.yaml" in done.err and "trinary" in done.err


def test_without_the_packages_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "scipy", None)
    done = pursue("survey", "map.yaml", "rooms.pur")
    assert done.status == 6 and "MAP002" in done.err and "pip install 'pursue-gen[survey]'" in done.err


def test_the_example_of_the_page_is_what_the_program_does(folder: Path) -> None:
    page = (ROOT / "docs" / "survey.md").read_text(encoding="utf-8")
    for file in (ROOT / "docs" / "survey").iterdir():
        shutil.copy(file, folder)
    command = re.search(r"^    pursue-gen (survey .*)$", page, re.M)
    assert command
    done = pursue(*command[1].replace("docs/survey/", "").split(), "--picture", "plan.svg")
    assert done.status == 0
    assert Path("plan.svg").read_text() == (ROOT / "docs" / "pictures" / "survey_three_rooms.svg").read_text()
    table, copy = re.findall(r"```(?:text|pursue-part)\n(.*?)```", page, re.S)
    assert done.out == table
    assert Path("three_rooms_surveyed.pur").read_text() == copy
    for finding in re.findall(r"^    docs/survey/(.*)$", page, re.M):
        assert finding in done.err


def test_the_picture_shows_all_that_has_a_pose_whatever_is_wrong() -> None:
    text = TEXT.replace("//[6.0, 3.0, 0, 0, 0, 0, 1]", "").replace('"desk"', '"desk" label "the <desk>"', 1)
    surveyed("--picture", "plan.svg", "--dry-run", text=text)
    picture = ElementTree.parse("plan.svg").getroot()
    shown = [one.text for one in picture.iter("{http://www.w3.org/2000/svg}text")]
    assert "the <desk>" in shown and "shelf" in shown and "hall" not in shown
    assert len(list(picture.iter("{http://www.w3.org/2000/svg}circle"))) == 4  # two places, bot2 beside each
    again = pursue("survey", "map.yaml", "rooms.pur", "--picture", "plan.svg", "--dry-run")
    assert again.status == 2 and "--force" in again.err


def test_robots_that_shut_each_other_in_are_reported(folder: Path) -> None:
    greys = drawn((12, 6), [(0, 2.0, 5, 6), (0, 0, 5, 1.0)], resolution=CELL)
    write(folder, greys, CELL)
    text = TEXT.replace("//[1.0, 1.0,", "//[1.0, 1.5,")
    done = surveyed(text=text)
    assert "MAP009" in codes(done) and "cannot leave desk while all others stand there" in done.err
    assert "MAP009" not in codes(surveyed(text=text.replace("//[1.0, 1.5,", "//[6.0, 1.0,")))


def test_travel_times_count_in_the_scenarios_unit() -> None:
    surveyed("--speed", "0.5")
    low, high = map(int, re.findall(r"travel bot2 from desk to hall takes (\d+) to (\d+)", copied())[0])
    surveyed("--speed", "0.5", text="unit 2 s\n" + TEXT)
    found = re.findall(r"travel bot2 from desk to hall takes (.*) to (.*) //", copied())
    shown = [[duration_text(2 * (half + more)) for more in (-1, 0, 1)] for half in (low // 2, high // 2)]
    assert len(found) == 1 and all(text in texts for text, texts in zip(found[0], shown)), (found, low, high)
    done = surveyed("--speed", "0.5", "--time-unit", "1", text="unit 2 s\n" + TEXT, status=2)
    assert "the scenario says unit 2 s" in done.err
