"""Conditions: read, written and compared with what they mean."""

from __future__ import annotations

from dataclasses import replace
from typing import List

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.language import check, parse
from pursue_gen.language.clauses import TRUE, Domains, TooMany, Value, clauses_of
from pursue_gen.language.clauses import given as known
from pursue_gen.language.conditions import (
    AllOf,
    AnyOf,
    At,
    AtMostOf,
    Condition,
    Doing,
    Holds,
    Not,
    OnWay,
    Who,
    condition_text,
    condition_words,
    names_in,
)
from pursue_gen.language.formatter import format_text
from pursue_gen.language.scenario import Always, Avoid, NeverWith
from pursue_gen.language.sentences import objective_words
from tests.conditions import CONDITIONS, SCENARIO, ref, with_only_if, without_places

from .texts import findings, text

ANY, ROBOTS = Who(None), Who(None, robots=True)
BOT = Who(ref("anna"))
WAY = (ref("hall"), ref("shop"))


def condition(words: str) -> Condition:
    """The condition that is written so."""
    (event,) = parse(f'event "e" only_if {words}', "x.pur").events
    assert event.only_if is not None
    return without_places(event.only_if)


@pytest.mark.parametrize(
    ("words", "expected", "english"),
    [
        ("anna at hall", At(BOT, ref("hall")), "anna is at hall"),
        ("not anna at hall", Not(At(BOT, ref("hall"))), "anna is not at hall"),
        ("anna on_way", OnWay(BOT), "anna is on its way"),
        ("anna doing clean", Doing(BOT, ref("clean")), "anna is doing clean"),
        ("anna on_way from hall to shop", OnWay(BOT, *WAY), "anna is on its way from hall to shop"),
        ("any robot between hall and shop", OnWay(ROBOTS, *WAY, True), "any robot is between hall and shop"),
        ("no robot on_way from hall to shop", Not(OnWay(ROBOTS, *WAY)), "no robot is on its way from hall to shop"),
        ("at_most 1 robot at hall", AtMostOf(1, (At(ROBOTS, ref("hall")),)), "at most 1 robot is at hall"),
        ("at_most 2 agents on_way", AtMostOf(2, (OnWay(ANY),)), "at most 2 agents are on their way"),
        ("not at_most 0 robots on_way", Not(AtMostOf(0, (OnWay(ROBOTS),))), "more than 0 robots are on their way"),
        (
            "at_most 1 of anna, bert doing clean",
            AtMostOf(1, (Doing(BOT, ref("clean")), Doing(Who(ref("bert")), ref("clean")))),
            "at most 1 of anna and bert is doing clean",
        ),
        (
            "at_most 1 of anna, bert at hall, shop",
            AtMostOf(1, tuple(At(Who(ref(who)), poi) for who in ("anna", "bert") for poi in WAY)),
            "at most 1 of anna and bert is at hall or at shop",
        ),
        (
            "at_most 1 of light, dark is_false",
            AtMostOf(1, (Holds(ref("light"), False), Holds(ref("dark"), False))),
            "at most 1 of light and dark is false",
        ),
        ("light is_true", Holds(ref("light"), True), "light is true"),
        ("not light is_false", Not(Holds(ref("light"), False)), "light is true"),
        ("any robot at hall", At(ROBOTS, ref("hall")), "any robot is at hall"),
        ("no robot at hall", Not(At(ROBOTS, ref("hall"))), "no robot is at hall"),
        ("any agent on_way", OnWay(ANY), "any agent is on its way"),
        ("no agent doing clean", Not(Doing(ANY, ref("clean"))), "no agent is doing clean"),
        (
            "anna on_way and (light is_true or any agent at hall)",
            AllOf((OnWay(BOT), AnyOf((Holds(ref("light"), True), At(ANY, ref("hall")))))),
            "anna is on its way and (light is true or any agent is at hall)",
        ),
        (
            "not (anna on_way or light is_true)",
            Not(AnyOf((OnWay(BOT), Holds(ref("light"), True)))),
            "not (anna is on its way or light is true)",
        ),
    ],
)
def test_each_form_is_read_and_told(words: str, expected: Condition, english: str) -> None:
    assert condition(words) == expected
    assert (condition_text(expected), condition_words(expected)) == (words, english)


def test_words_of_conditions_may_be_names() -> None:
    source = """\
poi "at" poi "doing" poi "on_way"
connect at and doing distance 1 only_if robot at at or no on_way
connect doing and on_way distance 1
event "any" location doing duration 1 only_if any robot doing any and no robot on_way
agent "robot" controllable mobile 1 location at can_do any
agent "no" mobile 1 location at
objective: robot never_with no
"""
    scenario = parse(source, "x.pur")
    first, _ = scenario.connections
    assert first.only_if is not None and scenario.events[0].only_if is not None
    assert [(kind, ref.name) for kind, ref in names_in(first.only_if)] == [
        ("agent", "robot"), ("POI", "at"), ("agent", "no")
    ]  # fmt: skip
    assert condition_text(scenario.events[0].only_if) == "any robot doing any and no robot on_way"
    assert {finding.code for finding in check(scenario)} == {"PML174"}  # both start at one place
    assert format_text(source, "x.pur").count("only_if") == 2


@pytest.mark.parametrize("word", ["robot", "any", "at"])
def test_a_line_that_begins_with_such_a_word_is_a_statement_of_its_own(word: str) -> None:
    found = findings(text(more=f'{word} "x" location a'))
    assert [(finding.code, finding.span.line if finding.span else 0) for finding in found] == [("PML011", 14)]
    assert ("did you mean agent?" in (found[0].hint or "")) is (word == "robot")


def test_objectives_on_conditions_are_read_and_told() -> None:
    for words, told in (
        ("avoid anna at hall", "It never holds that anna is at hall."),
        ("always any robot at hall", "It always holds that any robot is at hall."),
    ):
        scenario = parse(SCENARIO + f"objective: {words}\n", "x.pur")
        (safety,) = scenario.safety
        assert isinstance(safety, Always) and safety.holds is words.startswith("always")
        assert objective_words(scenario)[0] == told
    (plain,) = parse(SCENARIO + "objective: avoid open\n", "x.pur").safety
    assert isinstance(plain, Avoid) and plain.event.name == "open"
    apart = parse(SCENARIO + "objective: anna never_with dora at yard\n", "x.pur")
    (safety,) = apart.safety
    assert isinstance(safety, NeverWith) and safety.place and safety.place.name == "yard"
    assert objective_words(apart)[0] == "anna and dora are never both at yard."


def test_always_may_be_a_name() -> None:
    text = 'poi "a" agent "always" location a agent "x" location a objective: always never_with x at a'
    (safety,) = parse(text, "x.pur").safety
    assert isinstance(safety, NeverWith) and safety.first.name == "always"


@given(CONDITIONS)
def test_what_is_written_is_read_again(drawn: Condition) -> None:
    assert condition(condition_text(drawn)) == drawn
    formatted = format_text(f'event "e" only_if {condition_text(drawn)}', "x.pur")
    assert condition(formatted.partition("only_if")[2]) == drawn


def meaning(part: Condition, domains: Domains, at: "dict[str, Value]") -> bool:
    """A condition for these values of the variables, by its form."""
    if isinstance(part, Not):
        return not meaning(part.part, domains, at)
    if isinstance(part, (AllOf, AnyOf)):
        parts = [meaning(each, domains, at) for each in part.parts]
        return all(parts) if isinstance(part, AllOf) else any(parts)
    if isinstance(part, Holds):
        return (at[part.state.name] == TRUE) is part.value
    if isinstance(part, AtMostOf):
        names = {name for each in part.parts for name in VARIABLES if meaning(_of(each, name, domains), domains, at)}
        return len(names) <= part.most
    values = [at[name] for name in domains.among(part.who)]
    if isinstance(part, OnWay):
        ways = [value[1:] for value in values if value.kind == "way"]
        ends = tuple(ref.name for ref in part.ends)
        return any(not ends or way == ends or (part.either_way and way[::-1] == ends) for way in ways)
    if isinstance(part, At):
        return any(value.kind != "way" and value.where == part.place.name for value in values)
    return any(value.kind == "doing" and value.what == part.event.name for value in values)


def _of(part: Condition, name: str, domains: Domains) -> Condition:
    """The part said of one agent alone; what never holds where the part is not about it."""
    assert not isinstance(part, (Not, AllOf, AnyOf, AtMostOf, Holds))
    return replace(part, who=Who(ref(name))) if name in domains.among(part.who) else AnyOf(())


VARIABLES: List[str] = ["anna", "bert", "cleo", "dora", "light"]


@given(CONDITIONS, st.data())
def test_clauses_mean_what_the_condition_means(drawn: Condition, data: st.DataObject) -> None:
    domains = Domains(parse(SCENARIO, "x.pur"))
    at = {name: data.draw(st.sampled_from(sorted(domains.of(name)))) for name in VARIABLES}
    clauses, contrary = clauses_of(drawn, domains), clauses_of(drawn, domains, value=False)
    told = meaning(drawn, domains, at)
    assert all(any(at[name] in values for name, values in clause.items()) for clause in clauses) is told
    assert all(any(at[name] in values for name, values in clause.items()) for clause in contrary) is not told
    if not clauses or not contrary:
        assert told is (not clauses)
    variable = data.draw(st.sampled_from(VARIABLES))
    rest = known(clauses, variable, at[variable])
    holds = rest is not None and all(any(at[name] in values for name, values in clause.items()) for clause in rest)
    assert holds is told
    assert rest is None or all(variable not in clause for clause in rest)


def test_at_work_is_at_the_place_and_the_ways_are_those_of_the_agent() -> None:
    domains = Domains(parse(SCENARIO, "x.pur"))
    assert domains.of("cleo") == {
        Value("at", "shop"), Value("doing", "shop", "paint"), Value("doing", "shop", "carry")
    }  # fmt: skip
    assert len([value for value in domains.of("anna") if value.kind == "way"]) == 4
    assert domains.of("nobody") == frozenset()


def test_a_condition_with_too_many_clauses_is_refused() -> None:
    states = "".join(f'state "s{k}": initially true, false_if rest\n' for k in range(16))
    pairs = " or ".join(f"(s{k} is_true and s{k + 8} is_true)" for k in range(8))
    source = text(event_rest=f'event "rest" only_if {pairs}', more=states)
    assert [f.code for f in findings(source) if f.code != "PML190"] == ["PML233"]
    scenario = parse(source, "x.pur")
    big = scenario.events[2].only_if
    assert big is not None
    with pytest.raises(TooMany):
        clauses_of(big, Domains(scenario))
    assert len(clauses_of(big, Domains(scenario), value=False)) == 8


def test_a_condition_uses_its_event() -> None:
    plain = with_only_if({"close": "any agent doing paint"})
    assert not [finding for finding in check(parse(plain, "x.pur")) if finding.code == "PML157"]
