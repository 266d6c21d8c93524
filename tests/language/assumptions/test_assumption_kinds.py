"""What holds for each kind of assumption: its text, its form, its words, and what a mission makes of it."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any, Dict, Iterator, Type

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import Severity
from pursue_gen.language import parse
from pursue_gen.language.assumption_checks import setting_of
from pursue_gen.language.assumptions import KINDS, NUMBERED, Assumption, MostOpen
from pursue_gen.language.checks import check
from pursue_gen.language.conditions import At, Condition, Doing, Not, OnWay, Who
from pursue_gen.language.draft import Draft
from pursue_gen.language.formatter import format_text
from pursue_gen.language.kinds import KEYWORDS, MAY_BE_NAMES, MEANINGS, STATEMENTS
from pursue_gen.language.occurrences import occurrences
from pursue_gen.language.scenario import Ref, Scenario
from pursue_gen.language.word import HOLE
from pursue_gen.tga.assumptions import _KEPT
from pursue_runtime.event_words import Word
from pursue_runtime.observer.assumptions import breach
from tests.course import Course
from tests.plays import Play

STORY = """\
poi "hall"
poi "shop"
connect hall and shop distance 2
event "call"
event "clean" location shop duration 3
agent "bot" controllable mobile 1 location hall can_do clean
agent "guest" mobile 1 location hall can_do call, clean
agent "visitor" mobile 2 location shop can_do call
{}
reach_objective: do clean
"""

AGENTS, PLACES = (st.sampled_from(names).map(Ref) for names in (["guest", "visitor"], ["hall", "shop"]))
EVENTS = st.sampled_from(["call", "clean"]).map(Ref)
WHO = AGENTS.map(Who)
ATOMS: st.SearchStrategy[Condition] = st.builds(At, WHO, PLACES) | st.builds(OnWay, WHO) | st.builds(Doing, WHO, EVENTS)
VALUES: Dict[str, st.SearchStrategy[Any]] = {
    "agent": AGENTS, "event": EVENTS, "then": st.none() | EVENTS, "place": PLACES,
    "times": st.integers(0, 3), "time": st.integers(2, 20),
    "least": st.integers(0, 6), "most": st.integers(6, 20),
    "events": st.lists(EVENTS, min_size=1, max_size=2, unique=True).map(tuple),
    "condition": ATOMS | ATOMS.map(Not),
}  # fmt: skip


def drawn(data: st.DataObject, kind: Type[Assumption]) -> Assumption:
    """An assumption of this kind about STORY."""
    made: Any = kind
    fields = (hole.fields[0] for hole in kind.template.holes)
    found: Assumption = made(**{field: data.draw(VALUES[field]) for field in fields})
    return found


def read(text: str) -> Scenario:
    return parse(text, "story.pur", "story")


def all_kinds(of: Type[Assumption] = Assumption) -> Iterator[Type[Assumption]]:
    for kind in of.__subclasses__():
        yield from [kind] if hasattr(kind, "template") else []
        yield from all_kinds(kind)


each_kind = pytest.mark.parametrize("kind", list(KINDS.values()), ids=list(KINDS))


def test_every_kind_is_in_the_list_and_has_a_meaning() -> None:
    assert {*KINDS.values(), MostOpen} == set(all_kinds()) == set(_KEPT), "one stands behind objectives"


@each_kind
@given(st.data())
def test_its_text_is_read_as_the_same(kind: Type[Assumption], data: st.DataObject) -> None:
    one = drawn(data, kind)
    (again,) = read(STORY.format(one.text)).assumptions
    assert (type(again), again.text, again.clause, again.subject) == (kind, one.text, one.clause, one.subject)
    laid_out = format_text(f"assume :\n{one.text[len('assume:') :]}", "story.pur")
    assert laid_out.strip() == one.text


@each_kind
@given(st.data())
def test_it_names_what_editors_find_in_its_text(kind: Type[Assumption], data: st.DataObject) -> None:
    one = drawn(data, kind)
    assert {(thing, ref.name) for thing, ref in one.names()} <= {
        (found.kind, found.name) for found in occurrences(Draft.of(one.text, "story.pur").statements)
    }
    values = [getattr(one, hole.fields[0]) for hole in kind.template.holes if hole.filling.of]
    outside = [ref.name for value in values if value for ref in (value if isinstance(value, tuple) else (value,))]
    assert [ref.name for _, ref in one.names()] == outside and all(name in one.clause for name in outside)
    assert one.is_about("guest") == ("guest" in re.findall(r"\w+", one.text)) and not one.is_about("bot")


@each_kind
def test_its_form_and_its_example_are_of_the_kind(kind: Type[Assumption]) -> None:
    ((title, words),) = kind.forms
    assert (title, f"assume: {words}") in STATEMENTS["ASSUME"].forms
    fillings = {"agent": "guest", "event": "call", "POI": "hall"}
    filled = HOLE.sub(lambda hole: hole[2] if hole[1] else fillings[hole[2]], words)
    for text in (f"assume: {filled}", f"assume: {kind.form()}"):
        (found,) = read(STORY.format(text)).assumptions
        assert type(found) is kind and found.text.replace("((", "(") == text


@each_kind
def test_its_words_are_known_everywhere(kind: Type[Assumption]) -> None:
    for word in kind.own_words:
        assert KEYWORDS[word.token] == MAY_BE_NAMES[word.token] == word.text and MEANINGS[word.token] == word.meaning
    assert set(re.findall('"([a-z_]+)"', kind.template.grammar("kind"))) <= set(KEYWORDS.values())
    assert all(NUMBERED[word.upper()].nearest == kind.nearest for word in kind.numbers)
    assert all(NUMBERED[word.upper()].in_rests == kind.in_rests for word in kind.numbers)
    assert not kind.number or all(kind.number_words(word, 3).endswith(".") for word in kind.numbers)
    assert bool(kind.number) == bool(kind.numbers)


@each_kind
@given(st.data())
def test_numbers_that_are_proposed_say_more_and_can_be_assumed(kind: Type[Assumption], data: st.DataObject) -> None:
    one = drawn(data, kind)
    whole = replace(read(STORY.format("")), assumptions=(one,))
    for number in one.stronger(30, 2):
        assert set(one.with_number(number).stronger(30, 2)) < set(one.stronger(30, 2))
    for number in (*one.stronger(30, 2), kind.nearest):
        other = one.with_number(number)
        assert other.subject == one.subject
        assert "PML251" not in [finding.code for finding in other.check_in(setting_of(whole))]


@each_kind
@given(st.data(), st.integers(0, 10**6))
@settings(max_examples=10)
def test_what_agents_leave_out_because_of_it_is_what_breaks_it(
    kind: Type[Assumption], data: st.DataObject, seed: int
) -> None:
    scenario = read(STORY.format(drawn(data, kind).text))
    assume(all(finding.severity is not Severity.ERROR for finding in check(scenario)))
    Watched(scenario).run(12, seed)


class Watched(Play):
    """A play that is also one of the scenario without assumptions."""

    def __init__(self, scenario: Scenario) -> None:
        super().__init__(scenario)
        self.free = Course(replace(scenario, assumptions=()))

    def check(self) -> None:
        """What the scenario permits and the network does not is said to break the assumption."""
        super().check()
        for agent in self.scenario.agents:
            words = {ref.name: self.free.may_begin(agent.name, ref.name) for ref in agent.can_do}
            words.update(
                (f"{agent.name}_{a}2{b}", self.free.may_set_off(agent.name, a, b))
                for a, b in self.scenario.movements(agent)
            )
            for name, may in words.items():
                possible = self.model.joint_move(self.position, name, agent.name, timed=False) is not None
                broken = breach(self.model, self.position, Word(agent.name, name), timed=False)
                assert possible or (broken is not None) == may, (name, self.lines)

    def take(self, agent: str, word: str, delay: float) -> bool:
        before = self.course.now
        if not super().take(agent, word, delay):
            return False
        self.free.now += self.course.now - before
        self.free.take(agent, word, self.position.locations[agent])
        return True
