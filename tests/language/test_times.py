"""Units of time: how times are read and given back, and that the game is that of the same numbers without units."""

from __future__ import annotations

import copy
import json
import pickle
from fractions import Fraction
from pathlib import Path
from typing import Optional, Tuple

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen import api
from pursue_gen.diagnostics import units
from pursue_gen.explanation.explain import explain, render
from pursue_gen.explanation.repairs import repairs
from pursue_gen.language import load, parse
from pursue_gen.language.checks import check, check_reading
from pursue_gen.language.document import Document, edited, written
from pursue_gen.language.formatter import format_text
from pursue_gen.language.numbers import Number, exact, is_fine
from pursue_gen.language.parser import read
from pursue_gen.language.rewriting import Rewriting
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.sentences import objective_words
from pursue_gen.language.times import SECONDS, TIMES, Time, duration_text, in_unit, like, moment, unit_name
from pursue_gen.language.writer import scenario_text
from pursue_gen.outcomes import Lost
from pursue_gen.proof.checker import verify
from pursue_gen.solving.periods import with_period
from pursue_gen.solving.rules import Rules
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Network, Objective
from pursue_gen.tga.uppaal import write_network
from tests.stories import files
from tests.whole_stories import stories

TEXT = """\
unit second

poi "desk"
poi "shelf"

connect desk and shelf distance 4

event "call"
event "fetch" location shelf duration 30 s
event "pack" location shelf duration 1 min to 1 min 30 s

agent "bot" controllable mobile 1 location desk can_do fetch, pack
agent "guest" mobile 60 location desk can_do call

travel "bot" from desk to shelf takes 5 s to 8.5 s

assume: guest waits 5 min between call
assume: guest stays 90 to 20 min at each place

objective: if call then fetch within 2 min
objective: patrol shelf every 8 h by bot
reach_objective: do pack after 10 within 1 h
"""

seconds = st.builds(lambda number: exact(Fraction(number, 1000)), st.integers(0, 10**9))


@given(seconds)
def test_a_time_that_is_shown_can_be_read(number: Number) -> None:
    assert TIMES.read(duration_text(number)).value == number


@pytest.mark.parametrize(
    ("number", "text"),
    [(90, "90 s"), (120, "2 min"), (127, "2 min 7 s"), (3600, "1 h"), (5400, "90 min"), (9000, "2 h 30 min")],
)
def test_times_are_shown_as_people_say_them(number: int, text: str) -> None:
    assert duration_text(number) == text


def test_a_scenario_says_its_times_as_they_were_written() -> None:
    scenario = parse(TEXT, "story.pur")
    assert not check(scenario)
    assert format_text(TEXT.replace(" min 30", "  min\t30"), "story.pur") == TEXT == scenario_text(scenario)
    assert scenario.unit == 1
    assert scenario.events[2].window == (60, 90)
    assert scenario.travels[0].window == (5, Fraction(17, 2))
    assert [each.limit for each in scenario.objectives] == [120, 8 * 3600, 3600]
    assert objective_words(scenario) == [
        "Whenever call happens, fetch happens within 2 min.",
        "bot is at shelf at least every 8 h.",
        "pack happens later than 10 s after the start and within 1 h after the start.",
    ]
    assert [each.clause for each in scenario.assumptions] == [
        "guest waits 5 min between one call and the next",
        "guest stays 90 s to 20 min at each place",
    ]


@pytest.mark.parametrize("unit", ["second", "10 s", "minute", "0.5 s", "hour"])
def test_a_time_with_a_unit_is_the_same_in_each_unit_of_time(unit: str) -> None:
    found = read(TEXT.replace("unit second", f"unit {unit}").replace("8.5 s", "18 s"), "story.pur")
    known, wrong = found.partial, [finding.code for finding in found.diagnostics]
    assert known.unit is not None and known.objectives[1].known_limit * Fraction(known.unit) == 8 * 3600
    assert set(wrong) <= {"PML280"}, "what is no number of units is an error, and nothing is rounded"
    assert bool(wrong) == (unit in ("minute", "hour"))


def wrong(text: str) -> Tuple[Tuple[str, int, str], ...]:
    found = check_reading(read(text, "x.pur"))
    return tuple((each.code, each.span.line if each.span else 0, each.hint) for each in found)


@pytest.mark.parametrize(
    ("old", "new", "code", "line", "hint"),
    [
        ("unit second\n", "\n", "PML420", 9, "unit second"),
        ("unit second\n", "unit 3\n", "PML014", 1, "write unit 3 s"),
        ("unit second\n", "unit 2 minutes\n", "PML014", 1, "write 2 min"),
        ("unit second\n", "unit two\n", "PML010", 1, "the form is: unit second"),
        ("unit second\n", "unit 0 s\n", "PML421", 1, "unit second"),
        ("unit second\n", "unit second unit minute\n", "PML422", 1, "delete one"),
        ("duration 30 s", "duration 30 seconds", "PML014", 9, "write 30 s"),
        ("duration 30 s", "duration 30s", "PML014", 9, "write 30 s"),
        ("duration 30 s", "duration 30 s 1 min", "PML014", 9, "write 90 s"),
        ("duration 30 s", "duration 1.2.3 s", "PML014", 9, "30 s, 2 min"),
        ("duration 30 s", "duration 0.0001 s", "PML280", 9, "nothing is rounded"),
        ("every 8 h", "every 300 h", "PML014", 21, "larger unit"),
        ("within 2 min", "within 2 m", "PML014", 20, "write 2 min where these are minutes"),
        ("mobile 1 ", "mobile 1 s ", "PML014", 12, "write 1: a unit stands behind times and lengths only"),
        ("distance 4", "distance 4 min", "PML014", 6, "12 m"),
        ("5 s to 8.5 s", "8 s to 5 s", "PML200", 15, "takes 5 s to 8 s"),
        ("5 s to 8.5 s", "2 min to 2 min", "PML200", 15, "takes 2 min to 2 min 1 s"),
        ("after 10 within 1 h", "after 2 min within 1 min", "PML223", 22, "within 2 min 1 s or more"),
        ("90 to 20 min", "20 min to 90", "PML200", 18, "stays 90 to 20 min"),
    ],
)
def test_what_is_wrong_with_a_time_is_said(old: str, new: str, code: str, line: int, hint: str) -> None:
    assert old in TEXT
    found = wrong(TEXT.replace(old, new))
    assert found and found[0][:2] == (code, line) and hint in found[0][2], found
    assert len(found) == 1 or code == "PML420"


def test_names_may_be_words_of_times() -> None:
    text = TEXT.replace("call", "second").replace("fetch", "s").replace("pack", "min").replace("guest", "unit")
    assert not check(parse(text.replace('"shelf"', '"h"').replace("shelf", "h"), "story.pur"))


# What is computed ----------------------------------------------------------------------------------------------------

TIMED = frozenset(("DURATION", "TAKES", "WITHIN", "EVERY", "AFTER", "WAITS", "STAYS", "BY", "TO"))


def in_seconds(text: str, unit: int) -> str:
    """The text with `unit`, and each of its times with a unit behind it."""
    tokens = Document(text).tokens
    triples = zip(tokens, tokens[1:], [*tokens[2:], ""])
    times = [two for one, two, three in triples if one.type in TIMED and two.type == "NUMBER" and three != "box"]
    edits = [written(number, duration_text(exact(Fraction(number) * unit))) for number in times]
    return f"unit {unit} s\n{edited(text, edits)}"


def game(scenario: Scenario) -> Tuple[Network, Objective]:
    return translate(scenario), scenario_objective(scenario)


@settings(max_examples=25)
@given(stories(small=True), st.sampled_from((1, 10, 60)))
def test_units_change_nothing_in_the_game(story: Tuple[str, Scenario], unit: int) -> None:
    text, plain = story
    timed = parse(in_seconds(text, unit), "story.pur", plain.name)
    assert timed.unit == unit
    assert any(isinstance(each.limit, Time) for each in timed.objectives if each.limit is not None) or not any(
        each.limit for each in plain.objectives
    )
    assert write_network(*game(timed)) == write_network(*game(plain))
    assert repr(game(timed)) == repr(game(plain)), "numbers in networks know nothing of units"


def test_what_is_computed_from_a_time_is_a_plain_number() -> None:
    time = Time(120, 1, "2 min")
    assert type(exact(time)) is int and type(time + 1) is Fraction
    assert str(time) == "120" and units(time) == "2 min" and units(Time(120, 1, "120")) == "2 min"
    assert str(like(127, time)) == "127" and units(like(127, time)) == "2 min 7 s"
    assert like(3, 5) == 3 and not isinstance(like(3, 5), Time)
    for same in (copy.copy(time), copy.deepcopy(time), pickle.loads(pickle.dumps(time))):
        assert (same, same.unit, same.written) == (120, 1, "2 min")
    assert time < 120.5 and time == 120.0 and max(time, 3.5) is time and float(time) == 120
    assert SECONDS == {"s": 1, "min": 60, "h": 3600}


def test_changes_are_told_in_the_units_of_the_text() -> None:
    said = {repair.what: repair.say(repair.values[0]) for repair in repairs(parse(TEXT, "story.pur"), Rules())}
    assert said["deadline"] == "a patrol of shelf every 8 h 1 s instead of 8 h"
    assert said["within"] == "pack within 1 h 1 s instead of 1 h" or said["within"].startswith("pack within")
    assert said["travel"] == "bot going from desk to shelf in 5 s to 8 s instead of 5 s to 8.5 s"
    assert said["latest"] == "pack lasting 1 min to 89 s instead of 1 min to 90 s"
    assert said["after"] == "pack after 9 instead of 10"


def test_what_commands_write_has_units_where_the_text_has_them() -> None:
    scenario = parse(TEXT, "story.pur")
    rewriting = Rewriting(scenario)
    edits = rewriting.windows({("bot", "desk", "shelf"): (6, exact(Fraction(19, 2)), "calibrate: here")})
    edits += rewriting.windows({("bot", "shelf", "desk"): (100, 130, "calibrate: back")})
    text = edited(TEXT, [*edits, *rewriting.duration(scenario.events[1], 29, 31, "calibrate: work")])
    assert "takes 6 s to 9.5 s // calibrate: here" in text
    assert "travel bot from shelf to desk takes 100 s to 2 min 10 s // calibrate: back" in text
    assert "duration 29 s to 31 s // calibrate: work" in text


def test_a_period_that_is_found_is_written_with_its_unit() -> None:
    found = with_period(parse(TEXT.replace(" every 8 h", ""), "story.pur"), 200)
    assert "patrol shelf every 3 min 20 s by bot" in found.text
    assert objective_words(found)[1] == "bot is at shelf at least every 3 min 20 s."
    assert parse(found.text, "story.pur").patrols[0].every == 200


def test_a_period_that_is_found_is_told_with_its_unit() -> None:
    rounds = 'agent "bot" controllable speed 0.5 location desk'
    text = DRIVES.split("event")[0] + f"{rounds}\n\nobjective: patrol desk, shelf by bot\n"
    solved = api.solve(parse(text, "rounds.pur"))
    every = solved.scenario.patrols[0].known_limit
    assert f"patrol desk, shelf every {duration_text(every)} by bot" in solved.scenario.text
    assert json.loads(json.dumps(solved.as_json()))["period"]["every"] == every
    assert any(f"is {duration_text(every)}." in line for line in solved.in_words()), solved.in_words()


def test_the_workspace_begins_with_the_unit_of_the_scenario() -> None:
    text = TEXT.replace("unit second", "unit 0.5 s").replace("objective: patrol shelf every 8 h by bot\n", "")
    made = files(text)
    launch = next(content for name, content in made.items() if name.endswith("launch/mission.launch"))
    assert b'<arg name="time_unit" default="0.5"' in launch


# Speeds --------------------------------------------------------------------------------------------------------------

DRIVES = """\
unit second

poi "desk"
poi "shelf"
poi "door"

connect desk and shelf distance 12
connect shelf and door distance 7

event "fetch" location shelf duration 30 s

agent "bot" controllable speed 0.5 location desk can_do fetch

reach_objective: do fetch within 2 min
"""


@pytest.mark.parametrize(
    ("unit", "speed", "window"),
    [
        ("second", "0.5", (24, 25)),
        ("second", "0.8", (15, 16)),
        ("minute", "0.5", (Fraction(2, 5), Fraction(7, 5))),
        ("10 s", "0.64", (Fraction(15, 8), Fraction(23, 8))),
        ("second", "0.7", (Fraction(171, 10), Fraction(182, 10))),
        ("minute", "0.7", (Fraction(2, 10), Fraction(13, 10))),
    ],
)
def test_a_speed_says_how_long_a_way_takes(unit: str, speed: str, window: Tuple[Number, Number]) -> None:
    scenario = parse(DRIVES.replace("second", unit).replace("0.5", speed), "drives.pur")
    agent = scenario.agents[0]
    found = scenario.movements(agent)["desk", "shelf"]
    assert found == window
    metres, seconds_of = Fraction(12) / Fraction(speed), Fraction(scenario.unit or 0)
    assert found[0] * seconds_of <= metres and metres + seconds_of <= found[1] * seconds_of, "never too narrow"
    assert agent.text == f'agent "bot" controllable speed {speed} location desk can_do fetch'
    assert scenario_text(scenario) == scenario.text
    rounded = [finding for finding in check(scenario) if finding.code == "PML424"]
    ends = (Fraction(way) / Fraction(speed) / seconds_of for way in (12, 7))
    assert bool(rounded) == (not all(map(is_fine, ends)))


@given(st.integers(1, 9999), st.integers(1, 9999), st.sampled_from((1, 60)))
def test_what_comes_of_a_speed_is_never_narrower_than_it_says(thousandths: int, distance: int, unit: int) -> None:
    text = DRIVES.replace("unit second", f"unit {unit} s").replace("speed 0.5", f"speed {thousandths / 1000:.3f}")
    agent = read(text, "drives.pur").partial.agents[0]
    low, high = agent.window_on(exact(Fraction(distance, 10)))
    time = Fraction(distance, 10) / Fraction(thousandths, 1000) / unit
    assert low <= time and time + 1 <= high and high - low <= Fraction(12, 10)
    assert is_fine(low) and is_fine(high)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("unit second\n", "\n", "nothing says what a unit of time is"),
        ("speed 0.5", "mobile 2 speed 0.5", "bot has mobile and speed"),
        ("speed 0.5", "speed 0", "bot would never arrive"),
    ],
)
def test_a_speed_that_cannot_be_meant(old: str, new: str, said: str) -> None:
    found = check_reading(read(DRIVES.replace("30 s", "30").replace("2 min", "120").replace(old, new), "x.pur"))
    assert [(each.code, said in each.message) for each in found] == [("PML423", True)]


def test_a_way_with_a_time_of_its_own_is_not_rounded() -> None:
    text = DRIVES.replace("0.5", "0.7").replace("distance 7", "distance 7 one_way")
    (finding,) = check(parse(text, "drives.pur"))
    assert finding.code == "PML424" and "about 17.143 s from desk to shelf: 17.1 s to 18.2 s" in finding.message
    own = "travel bot from desk to shelf takes 17 s to 19 s\ntravel bot from shelf to desk takes 17 s to 19 s\n"
    assert not check(parse(text.replace("reach_obj", own + "reach_obj"), "drives.pur"))


def test_a_faster_robot_is_told_by_its_speed() -> None:
    changes = [each for each in repairs(parse(DRIVES, "drives.pur"), Rules()) if each.what == "agent"]
    assert [each.say(each.values[0]) for each in changes] == ["a faster bot, speed 0.55 instead of 0.5"]
    made = changes[0].make(changes[0].values[0])
    assert isinstance(made, Scenario) and made.agents[0].text.startswith('agent "bot" controllable speed 0.55')
    assert parse(scenario_text(made), "x.pur").movements(made.agents[0]) == made.movements(made.agents[0])


# What gives times back -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("unit", "name", "five", "one", "at"),
    [
        (None, "time units", "5 units", "1 unit", "61.5"),
        (1, "seconds", "5 seconds", "1 second", "61.5 s"),
        (60, "minutes", "5 minutes", "1 minute", "61.5 min"),
        (3600, "hours", "5 hours", "1 hour", "61.5 h"),
        (10, "units of 10 s", "5 units of 10 s", "1 unit of 10 s", "61.5"),
    ],
)
def test_numbers_of_time_units_are_told_with_what_they_count(
    unit: Optional[int], name: str, five: str, one: str, at: str
) -> None:
    assert (unit_name(unit), in_unit("5", unit), in_unit("1", unit)) == (name, five, one)
    assert moment(Fraction(123, 2), unit) == at


def test_a_verdict_has_the_units_of_its_scenario() -> None:
    home = load(str(Path(__file__).resolve().parents[2] / "scenarios" / "home" / "medicine.pur"))
    solved = api.solve(home)
    assert isinstance(solved, api.Solved)
    assert "if call then give within 4 min: answered within 2 min 5.5 s of 4 min, at worst." in solved.in_words()
    assert "time units" not in "\n".join([*solved.in_words(), solved.margin_text()])
    reach = parse(DRIVES, "drives.pur")
    timed = api.solve(reach, api.request(optimize="time"))
    assert isinstance(timed, api.Solved)
    assert "Time to the goal: at most 58.3 s; nothing below" in timed.in_words()[0]


def test_what_would_change_a_verdict_has_the_units_of_its_scenario() -> None:
    home = load(str(Path(__file__).resolve().parents[2] / "scenarios" / "home" / "wet_floor.pur"))
    text = render(explain(home, Rules()), 200)
    assert "(times in seconds):" in text and "(give is due by 181.1 s)" in text
    assert "a deadline of 3 min 21 s instead of 3 min for give (3 min 20 s is not enough; line 22)" in text
    assert "a faster medicine robot, speed 0.39 instead of 0.3 (0.36 is not enough; line 17)" in text
    assert "load lasting 30 s to 39 s instead of 30 s to 1 min (40 s is not enough; line 12)" in text


# Rests ---------------------------------------------------------------------------------------------------------------

HURRY = DRIVES.replace("unit second\n", "unit second\nrest 0.1 s\n").replace("within 2 min", "within 58 s")


def test_a_short_rest_is_what_wins_a_game() -> None:
    won = api.solve(parse(HURRY, "hurry.pur"))
    assert won.worst_time is not None and won.worst_time < 57
    assert verify(won.solution.network, won.solution.objective, won.solution.strategy, won.solution.reaction).ok
    with pytest.raises(Lost):
        api.solve(parse(HURRY.replace("rest 0.1 s\n", ""), "hurry.pur"))


@given(stories(small=True))
@settings(max_examples=15)
def test_a_rest_of_one_time_unit_is_what_holds_without_it(story: Tuple[str, Scenario]) -> None:
    text, plain = story
    assert repr(game(parse(f"rest 1\n{text}", "story.pur", plain.name))) == repr(game(plain))


@pytest.mark.parametrize(
    ("new", "said"),
    [("rest 0", "endlessly many things at once"), ("rest 0.1\nrest 0.1", "line 2 says already how long agents rest")],
)
def test_a_rest_that_cannot_be_meant(new: str, said: str) -> None:
    found = check_reading(read(HURRY.replace("rest 0.1 s", new), "x.pur"))
    assert [(each.code, said in each.message) for each in found] == [("PML425", True)]


def test_who_leaves_in_time_has_time_to_rest() -> None:
    text = TEXT.replace("unit second\n", "unit second\nrest 10 s\n").replace("stays 90 to 20 min", "stays 5 to {}")
    assert not check(parse(text.format("20 s"), "x.pur"))
    found = check_reading(read(text.format("19 s"), "x.pur"))
    assert [each.code for each in found] == ["PML251"]
    assert "whoever arrives rests for 10 s" in found[0].message and "write to 20 s or more" in found[0].hint
