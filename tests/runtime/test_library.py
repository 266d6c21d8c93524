"""What the generated nodes share: the texts on the topics, zones, and the moment at which a command is due."""

from __future__ import annotations

import math
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from pursue_runtime import zones as runtime_zones
from pursue_runtime.data import DataError, Package, data_file, read_data
from pursue_runtime.event_words import (
    BACK,
    FAILED,
    RobotReport,
    Word,
    event_in,
    format_report,
    format_word,
    parse_report,
    parse_word,
    said_at,
)
from pursue_runtime.sentences import in_words
from pursue_runtime.state import SystemState, format_state, older, parse_state
from pursue_runtime.strategy import Strategy
from pursue_runtime.zones import due, parse_zone
from tests.runtime.texts import read

MARGIN = 0.02
CLOCKS = ("Cx", "Cy", "Cz")
names = st.from_regex(r"[A-Za-z_][A-Za-z0-9_]{0,8}", fullmatch=True)

# Values and bounds are multiples of 1/4: exact as floats, so that the brute force below decides every bound.
quarters = st.integers(0, 24).map(lambda n: n / 4)
valuations = st.fixed_dictionaries(dict.fromkeys(CLOCKS, quarters))


@st.composite
def comparisons(draw: st.DrawFn) -> str:
    """A comparison as strategy files have it, or as models have it."""
    first, second = draw(st.permutations(CLOCKS))[:2]
    bound, operator = draw(st.integers(-24, 24)), draw(st.sampled_from(("<", "<=", "==", ">", ">=")))
    number = str(Fraction(abs(bound), 4)) if draw(st.booleans()) else f"{abs(bound) / 4:g}"
    sides = draw(
        st.sampled_from(
            (
                (first, number),
                (number, first),
                (f"{first} - {second}", f"-{number}" if bound < 0 else number),
                (first, second),
            )
        )
    )
    return f"{sides[0]} {operator} {sides[1]}"


zone_texts = st.lists(comparisons(), min_size=1, max_size=4).map(" && ".join)


def true_at(text: str, clocks: dict, delay: float) -> bool:
    """The zone's text as Python reads it, so to speak: an evaluation that shares nothing with the library."""
    moved = {clock: value + delay for clock, value in clocks.items()}  # exact: eighths
    python = text.replace("&&", "and")
    for clock in CLOCKS:
        python = python.replace(clock, f"c['{clock}']")
    return bool(eval(python, {"c": moved}))


@settings(deadline=None)
@given(zone_texts, valuations)
def test_a_zone_holds_where_its_text_says(text: str, clocks: dict) -> None:
    assert runtime_zones.holds(parse_zone(text), clocks) == true_at(text, clocks, 0.0)


@settings(deadline=None)  # a busy machine is no failure
@given(st.lists(zone_texts, min_size=1, max_size=3), valuations)
def test_due_agrees_with_stepping_through_time(texts: list, clocks: dict) -> None:
    zones = [parse_zone(text) for text in texts]
    delay = due(zones, clocks, MARGIN)
    # Bounds and clocks are quarters: between two quarters nothing changes, so quarters and what lies between suffice.
    steps = [step / 8 for step in range(8 * 13)]
    first = next((s for s in steps if any(true_at(text, clocks, s) for text in texts)), None)
    if first is None:
        assert delay is None
        return
    assert delay is not None
    assert any(true_at(text, clocks, delay) for text in texts)
    opens = first * 4 != math.floor(first * 4)  # first true strictly between two quarters
    assert delay == pytest.approx(first - 1 / 8 + MARGIN if opens else first, abs=1e-12)


@settings(deadline=None)
@given(zone_texts, valuations, quarters)
def test_what_is_due_stays_due_while_time_passes(text: str, clocks: dict, passed: float) -> None:
    zones = [parse_zone(text)]
    delay = due(zones, clocks, MARGIN)
    assume(delay is not None and passed <= delay)
    later = due(zones, {clock: value + passed for clock, value in clocks.items()}, MARGIN)
    assert later is not None and passed + later <= delay + MARGIN + 1e-9


def test_a_command_is_due_inside_a_window_that_opens_strictly_and_is_narrow() -> None:
    zone = parse_zone("1 < Cx && Cx < 1.01")
    assert due([zone], {"Cx": 0.0}, MARGIN) == pytest.approx(1.005)
    assert due([zone], {"Cx": 1.0}, MARGIN) == pytest.approx(0.005)
    assert due([zone], {"Cx": 1.01}, MARGIN) is None


def test_always_is_due_now() -> None:
    assert due([parse_zone("always")], {"Cx": 3.0}) == 0.0
    assert due([], {"Cx": 3.0}) is None


def test_fractions_are_bounds() -> None:
    assert due([parse_zone("4/3 <= Cx")], {"Cx": 1.0}) == pytest.approx(1 / 3)


def test_the_decimals_of_a_message_do_not_break_an_equality() -> None:
    zone = parse_zone("Cx - Cy == 3 && Cx == 5")
    assert due([zone], {"Cx": 4.123456789, "Cy": 1.123456788}) == pytest.approx(0.876543211)


@pytest.mark.parametrize(
    "text", ["", "Cx", "Cx < ", "1 < 2", "Cx - Cy < Cz", "1 < Cx <= 2", "Cx = 3", "Cx < 1 || Cy < 1"]
)
def test_what_is_no_zone_is_reported(text: str) -> None:
    with pytest.raises(DataError):
        parse_zone(text)


def test_a_zone_holds_with_slack_a_little_beside_it() -> None:
    zone = parse_zone("1 < Cx && Cx - Cy <= 3")
    assert runtime_zones.holds(zone, {"Cx": 0.95, "Cy": 0.0}, slack=0.1)
    assert runtime_zones.holds(zone, {"Cx": 3.05, "Cy": 0.0}, slack=0.1)
    assert not runtime_zones.holds(zone, {"Cx": 3.2, "Cy": 0.0}, slack=0.1)


@pytest.mark.parametrize("text, clock, slack, is_held", [
    ("Cx < 4", 4.0, 0.0, False), ("Cx <= 4", 4.0, 0.0, True), ("Cx < 4", 4.5, 0.5, True), ("Cx <= 4", 4.5, 0.5, True),
])
def test_a_strict_bound_is_strict_without_slack_alone(text: str, clock: float, slack: float, is_held: bool) -> None:
    assert runtime_zones.holds(parse_zone(text), {"Cx": clock}, slack) == is_held


# Words and states


@settings(deadline=None)
@given(st.one_of(st.just(""), names), names, st.none() | st.integers(0, 10**6))
def test_words_come_back(agent: str, event: str, seq: object) -> None:
    word = Word(agent, event, seq)
    assert parse_word(format_word(word)) == word
    assert parse_word(format_word(word._replace(seq=None, as_of=seq))) == (agent, event, None, seq, None)
    assert event_in(format_word(word)) == event_in(format_word(word._replace(seq=None, as_of=seq))) == event


times = st.none() | st.integers(0, 10**16).map(lambda micros: micros / 10**6)


@settings(deadline=None)
@given(names, st.integers(0, 10**6), times)
def test_a_report_carries_the_time_at_which_it_became_true(event: str, as_of: int, at: object) -> None:
    read = parse_word(format_word(Word("", event, as_of=as_of, at=at)))
    assert read is not None and (read.event, read.as_of) == (event, as_of)
    assert read.at == (at if at is None else pytest.approx(at, abs=1e-6))
    assert said_at(format_word(read)) == read.at


@settings(deadline=None)
@given(
    names, st.sampled_from((FAILED, BACK)), st.none() | st.integers(0, 10**6), times,
    st.sampled_from(("", "no way", "#7", "~1.0")),
)
def test_reports_about_robots_come_back(robot: str, event: str, as_of: object, at: object, why: str) -> None:
    report = RobotReport(robot, event, why, as_of, None if as_of is None else at)
    read = parse_report(format_report(report))
    assert read is not None and read._replace(at=report.at) == report
    assert said_at(format_report(report)) == (None if report.at is None else pytest.approx(report.at, abs=1e-6))


@pytest.mark.parametrize(
    "text, agent, event, seq",
    [
        ("catch", "", "catch", None),
        ("catch@7", "", "catch", 7),
        ("polBot2:catch@7", "polBot2", "catch", 7),
        (" bot1_c2b! ", "", "bot1_c2b", None),
        ("catch@99999999999999999999", "", "catch", 10**20 - 1),
        ("polBot2:catchDONE#7", "polBot2", "catchDONE", None),
        ("polBot2:catchDONE#7~12.5", "polBot2", "catchDONE", None),
    ],
)
def test_words_by_hand_are_understood(text: str, agent: str, event: str, seq: object) -> None:
    as_of, at = 7 if "#" in text else None, 12.5 if "~" in text else None
    assert parse_word(text) == (agent, event, seq, as_of, at)


@pytest.mark.parametrize(
    "text",
    ["", "two words", "catch@", "catch@x", ":catch", "a:b:c", "\x00", "…", "a@" + 5000 * "9", "a@1#2", "a#", "a#1@2",
     "a~1.0", "a@1~", "a#1~", "a#1~x", "a#1~1", "a#1~-1.0", "a#1~nan", "a#1~1e3", "a#1~" + 13 * "9" + ".0"],
)
def test_what_is_no_word_is_none(text: str) -> None:
    assert parse_word(text) is None


@settings(deadline=None)
@given(
    st.integers(0, 10**6),
    st.floats(0, 2e9),
    st.dictionaries(names, names, max_size=4),
    st.dictionaries(names, st.integers(-999, 999), max_size=4),
    st.dictionaries(names, st.floats(0, 1e4), max_size=4),
    names,
    st.sampled_from(("waiting", "running", "won", "lost", "stopped")),
    st.text(st.characters(codec="ascii", exclude_categories=("C", "Z")), max_size=9),
)
def test_states_come_back(  # type: ignore[no-untyped-def]
    seq, stamp, locations, values, clocks, event, status, reason
) -> None:
    assume(not set(locations) & set(values))
    state = SystemState(seq, stamp, locations, values, clocks, event, event, status, reason, 0.1)
    back = parse_state(format_state(state))
    assert back._replace(stamp=0, clocks={}, reason="") == state._replace(stamp=0, clocks={}, reason="")
    assert in_words(back.reason) == in_words(state.reason)
    assert back.stamp == pytest.approx(stamp, abs=1e-6)
    assert back.clocks == pytest.approx(clocks, abs=1e-9)


def test_a_state_is_the_thesiss_text_under_one_line_of_ours() -> None:
    state = SystemState(7, 12.25, {"bot1": "going_c_to_b"}, {"Pbot1": -32}, {"Cbot1": 0.5}, "bot1_c2b", "bot1")
    assert format_state(state).splitlines() == [
        "seq=7 stamp=12.250000 unit=1.0 event=bot1_c2b agent=bot1 status=running",
        "bot1=going_c_to_b",
        "Pbot1=-32",
        "",
        "Cbot1=0.500000000",
    ]


def test_a_reason_takes_the_rest_of_its_line() -> None:
    state = SystemState(3, 1.0, {}, {}, {}, status="stopped", reason="no strategy: a=b\nCx=1")
    assert parse_state(format_state(state)).reason == "no strategy: a=b Cx=1"


def test_lines_that_nobody_knows_are_skipped() -> None:
    state = parse_state("seq=2 stamp=1 colour=red\nbot=a\nwhat is this\nPbot=1\n\nCbot=1.5\nCother=soon")
    assert (state.seq, state.locations, state.values, state.clocks) == (2, {"bot": "a"}, {"Pbot": 1}, {"Cbot": 1.5})


@pytest.mark.parametrize(
    "text",
    [
        "",
        "hello",
        "seq=x stamp=1",
        "bot=a\n\nCbot=1",
        "seq=-1 stamp=1",
        "seq=1 stamp=inf",
        "seq=1 stamp=nan",
        "seq=1 stamp=1 unit=0",
        "seq=1 stamp=1 unit=nan",
    ],
)
def test_what_is_no_state_is_none(text: str) -> None:
    assert parse_state(text) is None


def test_what_is_discrete_of_a_state_is_said_as_text() -> None:
    found = SystemState(7, 100.0, {"bot": "a"}, {"Prule": -1}, {"Cbot": 3.0})
    assert found.discrete() == {"bot": "a", "Prule": "-1"}


def test_clocks_go_on_from_the_stamp_in_the_states_own_unit() -> None:
    state = SystemState(1, 100.0, {}, {}, {"Cx": 2.0}, unit=0.5)
    assert state.clocks_at(101.0) == {"Cx": 4.0}
    assert state.clocks_at(99.0) == {"Cx": 2.0}


# Strategies -----------------------------------------------------------------------------------------------------------

STRATEGY = """
format: 1
controller: controller_bot1
commands_agents: [bot1]
reaction: 0.1
strategy:
- state: {bot1: c, rule1: start, Sopen: 1}
  commands:
  - {do: bot1_c2b, agent: bot1, from: c, to: going_c_to_b, when: ["5 <= Cx && Cx < 6"]}
  - {do: bot1_c2a, agent: bot1, from: c, to: going_c_to_a, when: ["3 <= Cx && Cx - Cy <= 0", "8 <= Cx"]}
"""


def state(seq: int = 1, stamp: float = 10.0, clocks=(0.0, 0.0), **holds: object):  # type: ignore[no-untyped-def]
    everything = {"bot1": "c", "rule1": "start", "Sopen": 1, "Pbot1": 3, **holds}
    locations = {name: value for name, value in everything.items() if isinstance(value, str)}
    values = {name: value for name, value in everything.items() if isinstance(value, int)}
    return SystemState(seq, stamp, locations, values, {"Cx": clocks[0], "Cy": clocks[1]}, unit=2.0)


def test_the_first_of_several_commands_is_next() -> None:
    strategy = Strategy(read(STRATEGY))
    moment, command = strategy.next_command(state(), now=10.0)
    assert (moment, command.event) == (10.0 + 2.0 * 3, "bot1_c2a")
    moment, command = strategy.next_command(state(clocks=(1.0, 0.0)), now=10.0)
    assert (moment, command.event) == (10.0 + 2.0 * 4, "bot1_c2b")


def test_a_state_without_commands_has_no_next_one() -> None:
    strategy = Strategy(read(STRATEGY))
    assert strategy.next_command(state(Sopen=0), now=10.0) is None
    assert strategy.next_command(state(bot1="a"), now=10.0) is None


def test_a_strategy_with_something_amiss_is_reported() -> None:
    for broken in (STRATEGY.replace("Cx < 6", "Cx ~ 6"), STRATEGY.replace("do:", "doo:"), "format: 1\nstrategy: []"):
        with pytest.raises(DataError):
            Strategy(read(broken))


def test_a_file_of_another_format_is_reported(tmp_path: Path) -> None:
    (tmp_path / "strategy.yaml").write_text("format: 3")
    with pytest.raises(DataError, match=r"strategy\.yaml has format 3, and pursue_runtime [\d.]+ reads format"):
        read_data(str(tmp_path / "strategy.yaml"))
    for text in ("format: 0", "[1, 2]", "format: [", "{"):
        (tmp_path / "strategy.yaml").write_text(text)
        with pytest.raises(DataError, match=r"strategy\.yaml"):
            read_data(str(tmp_path / "strategy.yaml"))


def test_data_is_found_in_the_source_and_in_the_install_space(tmp_path: Path) -> None:
    source, install = tmp_path / "src" / "bot" / "scripts" / "bot", tmp_path / "install" / "lib" / "bot" / "bot"
    places = source.parent.parent / "config", tmp_path / "install" / "share" / "bot" / "config"
    for script, place in zip((source, install), places):
        for folder in (script.parent, place):
            folder.mkdir(parents=True)
        (place / "model.yaml").write_text("format: 1")
        assert data_file(Package("bot", "example", str(script)), "model.yaml") == str(place / "model.yaml")
    package = Package("bot", "example", str(source))
    assert data_file(package, "model.yaml", str(places[1])) == str(places[1] / "model.yaml")
    with pytest.raises(DataError, match="--config"):
        data_file(package, "nothing.yaml")


@pytest.mark.parametrize(
    ("seq", "stamp", "late"),
    [(5, 9.0, True), (5, 10.0, True), (6, 9.0, True), (6, 10.0, False), (6, 11.0, False), (7, 10.0, False),
     (5, 11.0, False), (7, 9.0, False)],
)  # fmt: skip
def test_a_state_that_was_published_before_the_known_one_is_older(seq: int, stamp: float, late: bool) -> None:
    known = SystemState(6, 10.0, {}, {}, {})
    assert older(known._replace(seq=seq, stamp=stamp), known) is late
