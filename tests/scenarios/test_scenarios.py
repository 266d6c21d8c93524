"""The scenarios that come with the project: their pages tell what is found out today, and their missions are won."""

from __future__ import annotations

import functools
import re

import pytest

from docs.scenarios import make
from pursue_gen.language import load
from pursue_gen.language.checks import check_reading
from pursue_gen.language.parser import read, read_text
from pursue_gen.tga import translation_notes
from pursue_gen.tools.simulation.mission import simulate_mission
from pursue_gen.tools.simulation.outcome import GOAL, SAFE
from tests.scenarios.pictures import assert_same_picture

FILES = make.scenario_files()
AGAIN = "run: python -m docs.scenarios.make"
LOST = {
    "blocked_watch", "busy_lift", "closed_gate", "cornered_robot", "dry_herbs", "early_breakfast", "extinguisher",
    "fire_drill", "fleeting_guest", "half_charges", "hasty_belt", "hasty_greeting", "hasty_parcel", "hasty_search",
    "lift_ride", "long_night", "long_rows", "one_box", "one_by_one", "own_load", "pharmacy", "quiet_corridor",
    "restless", "room_service", "roundabout", "rush_hour", "slow_charger", "slow_doors", "staff_door", "trays",
    "two_errands", "two_hasty_bells", "two_officers", "two_rolling_bins", "weak_charger", "wet_floor",
    "wrong_way_round",
}  # fmt: skip
"""Kept on purpose."""
OF_TWO = {
    "ecobot": 1, "drug_delivery": 2, "paper_and_plastic": 2, "rolling_bin": 1, "scenario_2": 1,
    "scenario_4": 1, "two_robot_farm": 1, "two_rolling_bins": 2,
}  # fmt: skip
"""Those that are older than the word `together`, with their lasting events of two: they keep their meaning."""


@functools.lru_cache(maxsize=None)
def facts(name: str) -> make.Facts:
    return make.facts(FILES[name])


def written(name: str) -> str:
    return (make.PAGES / f"{name}.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", sorted(FILES))
def test_the_page_and_its_pictures_tell_what_is_found_out_today(name: str) -> None:
    found = facts(name)
    assert (found.won is None) == (name in LOST)
    page, pictures = make.page(written(name), found)
    assert page == written(name), AGAIN
    assert make.row(found) in make.INDEX.read_text(encoding="utf-8").split("\n"), AGAIN
    for file, svg in pictures.items():
        assert_same_picture(svg, make.PAGES / file, AGAIN)


@pytest.mark.parametrize("name", sorted(set(FILES) - LOST))
def test_ten_missions_are_won(name: str) -> None:
    found = facts(name)
    settings, times = found.case.settings, found.case.worst_times()
    outcomes = [simulate_mission(found.stage, settings, seed, times) for seed in range(1, 11)]
    wanted = SAFE if found.guarantee is None else GOAL
    assert {outcome.end for outcome in outcomes} == {wanted}, [o.reason for o in outcomes if o.end != wanted][:3]
    assert any(outcome.steps > 4 for outcome in outcomes)


@pytest.mark.parametrize("name", sorted(FILES))
def test_the_file_says_what_it_is_and_has_no_finding(name: str) -> None:
    path = FILES[name]
    text = path.read_text(encoding="utf-8")
    first = text.split("\n")[0]
    assert first.startswith("// ") and first.endswith("."), "the first line is a comment that says what it is"
    assert max(map(len, text.split("\n"))) <= 120
    codes = [finding.code for finding in check_reading(read(read_text(str(path)), str(path)))]
    assert codes == ["PML158"] * OF_TWO.get(name, 0)
    assert translation_notes(load(path)) == ()


@pytest.mark.parametrize("name", sorted(FILES))
def test_a_page_tells_the_story_shows_the_map_and_says_what_happens_if(name: str) -> None:
    page = written(name)
    assert {"verdict", "map"} <= set(re.findall(r"<!-- made: (\w+)", page))
    assert ("## Why it cannot be done" if name in LOST else "## What the strategy does") in page
    assert ("## What would change that" if name in LOST else "## What happens if …") in page
    assert len(re.findall(r"\| (?:can|cannot) be done(?:, [^|]+)? \|$", page, re.MULTILINE)) >= 2
    links = re.findall(r"\]\(([^)#]+)", page)
    assert [link for link in links if not (make.PAGES / link).exists()] == []


def test_the_index_lists_every_scenario_and_no_other() -> None:
    assert re.findall(r"^\| \[[\w/]+\]\(scenarios/(\w+)\.md\)", make.INDEX.read_text(), re.MULTILINE) == list(FILES)
    assert {path.stem for path in make.PAGES.glob("*.md")} == set(FILES)
    there = [path for path in make.SCENARIOS.rglob("*.pur") if path.parent != make.PATTERNS]
    assert len(there) == len(FILES), "pages are named by files, so each name is used once"


def test_every_picture_is_on_a_page() -> None:
    shown = {picture for name in FILES for picture in re.findall(r"\((\w+\.svg)\)", written(name))}
    assert {path.name for path in make.PAGES.glob("*.svg")} == shown


# What the generator does ----------------------------------------------------------------------------------------------


TEXT = 'poi "a"\nagent "bot" controllable location a\n      can_do go\nagent "man" location a\nobjective: avoid go\n'


GROUPS = """group "rooms": a, b
for each r in rooms: event "go" of r
for each r in rooms:
  event "do" of r duration 2
for each r in rooms: objective: if go of r then do of r within 9
for each robot r: objective: avoid r at a"""


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ('`for each r in rooms: event "do" of r duration 5`', GROUPS.replace("\n  event", " event").replace("2", "5")),
        ("`for each r in rooms: objective: if go of r then do of r within 7`", GROUPS.replace("within 9", "within 7")),
        ('`group "rooms": a`', GROUPS.replace("a, b", "a")),
        ("without `for each robot r: objective: avoid r at a`", GROUPS[: GROUPS.rindex("for")]),
        ("`for each robot r: objective: avoid r at b`", GROUPS.replace("avoid r at a", "avoid r at b")),
        ("`objective: avoid go_a`", GROUPS + "\nobjective: avoid go_a"),
    ],
)
def test_statements_for_each_take_the_place_of_their_like(changes: str, expected: str) -> None:
    assert make.edited(GROUPS, changes) == expected


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ('`agent "man" mobile 1 location a`', TEXT.replace('"man" location', '"man" mobile 1 location')),
        ('`agent "bot" location a`', TEXT.replace(' controllable location a\n      can_do go', " location a")),
        ("without `objective: avoid go`", TEXT.replace("objective: avoid go", "")),
        ("`objective: avoid go away`", TEXT.replace("avoid go", "avoid go away")),
        ('`poi "b"`, `poi "a" //x`', TEXT.replace('poi "a"', 'poi "a" //x') + '\npoi "b"'),
    ],
)
def test_statements_take_the_place_of_those_on_the_same_thing(changes: str, expected: str) -> None:
    assert make.edited(TEXT, changes) == expected


def test_what_is_not_there_cannot_be_taken_away() -> None:
    with pytest.raises(ValueError, match="no such statement"):
        make.edited(TEXT, 'without `agent "dog"`')


def test_a_verdict_that_is_out_of_date_is_made_anew() -> None:
    page = written("work_cell")
    wrong = page.replace("| cannot be done |", "| can be done |").replace("can be done**", "cannot be done**")
    assert wrong != page
    assert make.page(wrong, facts("work_cell"))[0] == page


def test_a_change_that_changes_nothing_is_refused() -> None:
    line = next(line for line in facts("work_cell").scenario.text.split("\n") if line.startswith("objective"))
    with pytest.raises(ValueError, match="changes nothing"):
        make.page(f"| nothing | `{line}` | |\n", facts("work_cell"))
