"""The catalogue of patterns: what each scenario of scenarios/patterns promises is what the pattern's formula says."""

from __future__ import annotations

import functools
import itertools
import re
from dataclasses import replace
from itertools import starmap
from typing import Iterator, Mapping, Tuple

import pytest

from docs.patterns import make
from docs.scenarios import make as scenarios
from pursue_gen.language import load, parse
from pursue_gen.language.checks import check_reading
from pursue_gen.language.parser import read, read_text
from pursue_gen.language.scenario import Scenario
from pursue_gen.tools.report.recording import simulated
from tests.scenarios.missions import Happening, random_play, trace
from tests.scenarios.pictures import assert_same_picture
from tests.scenarios.temporal_logic import Formula, Trace, is_kept, read_formula, trace_of

FILES = make.pattern_files()
AGAIN = "run: python -m docs.patterns.make"


@functools.lru_cache(maxsize=None)
def facts(name: str) -> scenarios.Facts:
    return scenarios.facts(FILES[name])


def formula(name: str) -> Formula:
    return read_formula(make.formula(name))


def known_atoms(scenario: Scenario) -> Iterator[str]:
    """Everything that a letter of a mission may hold."""
    yield from (poi.name for poi in scenario.pois)
    yield from (event.name for event in scenario.events)
    yield from (state.name for state in scenario.states)
    for agent in scenario.agents:
        yield f"begins({agent.name})"
        yield from (f"at({agent.name}, {poi.name})" for poi in scenario.pois)
        yield from (f"doing({agent.name}, {event.name})" for event in scenario.events)


def plays(scenario: Scenario, seeds: int) -> Iterator[Trace]:
    """Random plays that meet the objectives."""
    found = (random_play(scenario, seed, 60.0) for seed in range(seeds))
    return (play for play in found if play is not None)


# Pages ----------------------------------------------------------------------------------------------------------------


def test_all_patterns_of_the_catalogue_have_a_scenario_a_page_and_a_line_in_the_table() -> None:
    assert len(FILES) == 22
    assert {path.stem for path in scenarios.PATTERNS.glob("*.pur")} == set(FILES)
    assert {path.stem for path in make.PAGES.glob("*.md")} == {"README", *FILES}
    listed = re.findall(r"^\| \[[\w ]+\]\((\w+)\.md\)", make.INDEX.read_text(encoding="utf-8"), re.MULTILINE)
    assert listed == list(FILES)
    lines = {*map(make.story, make.STORIES), *starmap(make.statement, make.STATEMENTS.items())}
    assert lines <= set(make.INDEX.read_text(encoding="utf-8").split("\n")), AGAIN
    shown = {picture for name in FILES for picture in re.findall(r"\((\w+\.svg)\)", make.written(name))}
    assert {path.name for path in make.PAGES.glob("*.svg")} == shown


@pytest.mark.parametrize("name", FILES)
def test_the_page_and_its_pictures_tell_what_is_found_out_today(name: str) -> None:
    found = facts(name)
    assert found.won is not None
    page, pictures = scenarios.page(make.written(name), found)
    assert page == make.written(name), AGAIN
    assert make.row(name, True) in make.INDEX.read_text(encoding="utf-8").split("\n"), AGAIN
    for file, svg in pictures.items():
        assert_same_picture(svg, make.PAGES / file, AGAIN)


@pytest.mark.parametrize("name", FILES)
def test_the_scenario_is_short_says_what_it_is_and_has_no_finding(name: str) -> None:
    lines = [line for line in FILES[name].read_text(encoding="utf-8").split("\n") if line]
    assert lines[0].startswith(f"// {make.title(name)}: ") and lines[0].endswith(".")
    assert len(lines) <= 18 and max(map(len, lines)) <= 120
    assert check_reading(read(read_text(str(FILES[name])), str(FILES[name]))) == ()


# Meaning --------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", FILES)
def test_a_formula_is_about_what_there_is(name: str) -> None:
    assert set(formula(name).atoms()) <= set(known_atoms(load(FILES[name])))


@pytest.mark.parametrize("name", FILES)
def test_missions_of_the_strategy_keep_to_the_formula(name: str) -> None:
    case, stage = facts(name).case, facts(name).stage
    for seed, opponent in enumerate(("random", "random", "worst", "still"), 1):
        recording = simulated(replace(case, settings=replace(case.settings, opponent=opponent)), seed, stage)
        happened = [Happening(s.at, s.event, s.agent, s.locations, s.values) for s in recording.steps]
        mission = trace(case.scenario, happened, recording.end, complete=bool(case.scenario.reach))
        assert is_kept(formula(name), mission), mission
        assert recording.status == ("won" if case.scenario.reach else "running")


@pytest.mark.parametrize("name", FILES)
def test_whatever_play_meets_the_objectives_keeps_to_the_formula(name: str) -> None:
    """Robots that follow no strategy: so it is the scenario that says the pattern, and not the strategy's taste."""
    met = list(itertools.islice(plays(load(FILES[name]), 600), 6))
    assert len(met) >= 4
    for play in met:
        assert is_kept(formula(name), play), play


WEAKER: Mapping[str, Tuple[Tuple[str, str], ...]] = {
    "visit": ((" and scanC", ""),),
    "sequenced_visit": (("scanA before (scanB before scanC)", "scanB before scanC"),),
    "ordered_visit": (("objective: avoid bot at shelfB and seenA is_false\n", ""),),
    "strict_ordered_visit": ((" only_if seenA is_false or seenB is_true", ""),),
    "fair_visit": ((" only_if sawA is_false", ""),),
    "patrolling": (("every 20", "every 30"),),
    "sequenced_patrolling": (("every 20", "every 30"),),
    "ordered_patrolling": ((" only_if gateSeen is_true", ""),),
    "strict_ordered_patrolling": ((" only_if gateSeen is_false", ""),),
    "fair_patrolling": ((" only_if sawGate is_false", ""),),
    "past_avoidance": (("objective: avoid bot at ward and washed is_false\n", ""),),
    "global_avoidance": (("objective: avoid bot at laboratory\n", ""),),
    "future_avoidance": (("objective: avoid bot at store and closed is_true\n", ""),),
    "upper_restricted_avoidance": (("at_most 2 times", "at_most 3 times"),),
    "lower_restricted_avoidance": (("(report before secondPicture)", "secondPicture"),),
    "exact_restricted_avoidance": ((' "secondPicture" location nest only_if unlocked is_true', ' "secondPicture"'),),
    "instantaneous_reaction": (("objective: always lit is_true or not bot at cellar\n", ""),),
    "delayed_reaction": (("within 20", "within 30"),),
    "prompt_reaction": (("distance 3 only_if bumped is_false", "distance 3"),),
    "bound_reaction": (
        ("together ", ""),
        ("objective: always (bot doing carry and helper doing carry) or not (bot doing carry\n", ""),
        ("    or helper doing carry)\n", ""),
    ),
    "bound_delay": (('rule "bumps": bump before halt\n', ""),),
    "wait": (("objective: always bot at hall or opened is_true\n", ""),),
}
"""What is taken away from each scenario, so that it does not say its pattern any more."""


@pytest.mark.parametrize("name", FILES)
def test_without_the_statement_that_says_the_pattern_some_play_does_not_keep_to_the_formula(name: str) -> None:
    text = FILES[name].read_text(encoding="utf-8")
    for old, new in WEAKER[name]:
        assert old in text
        text = text.replace(old, new)
    assert any(not is_kept(formula(name), play) for play in plays(parse(text, f"{name}.pur", name), 600))


# The evaluator --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "kept", "broken"),
    [
        ("F a & F b", "- b - a", "- b - b"),
        ("F(a & F(b & F c))", "a d c a b d c", "a d c a d b"),
        ("(!b U a) & (!c U b) & F c", "a d a b d c", "a c a b c"),
        ("!a U (a & X(!a U b))", "a d b d c", "a d a b d c"),
        ("G(a -> X(!a W b))", "a b a c", "a b a c a"),
        ("!l U p", "- - p l", "- l p"),
        ("G(c -> G !l)", "l - c -", "- c - l"),
        ("!F(l & X F(l & X F l))", "l - l - -", "l - l - l"),
        ("F(l & X F l)", "- l - l", "- l - -"),
        ("!l U (l & X(!l U (l & X G !l)))", "- l - l -", "l - l - l"),
        ("G(p -> q)", "p+q - q", "p+q p"),
        ("G(p -> F q)", "p - q", "q - p"),
        ("G(p -> F[2] q)", "p - q", "p - - q"),
        ("G(p -> X q)", "p q - p q", "p - q"),
        ("G(p <-> q)", "p+q - p+q", "p+q q"),
        ("G(p <-> X q)", "p q - -", "- q -"),
        ("l U p", "l l l p -", "l - p"),
        ("l U[2] p", "l l p", "l l l p"),
        ("a | b & c -> d", "a+d", "b+c"),
        ("X X a", "- - a", "- a"),
    ],
)
def test_formulas_tell_traces_apart(text: str, kept: str, broken: str) -> None:
    assert is_kept(read_formula(text), trace_of(kept.split()))
    assert not is_kept(read_formula(text), trace_of(broken.split()))


def test_what_still_has_time_is_not_broken_where_the_recording_ends() -> None:
    formula = read_formula("G(p -> F[3] q)")
    for words, cut, over in (("p - - -", True, False), ("p - - - -", False, False), ("p - - q", True, True)):
        assert is_kept(formula, trace_of(words.split(), complete=False)) is cut
        assert is_kept(formula, trace_of(words.split())) is over
    assert is_kept(read_formula("G(p -> X(!p U[2] q))"), trace_of(["-", "p"], complete=False))
    assert not is_kept(read_formula("F q"), trace_of(["-", "p"], complete=False))


@pytest.mark.parametrize("text", ["", "a &", "(a", "a)", "F", "a b", "& a", "a ~ b", "!F[3] a", "F[3] a -> b", "a U"])
def test_what_is_no_formula_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match="."):
        read_formula(text)
