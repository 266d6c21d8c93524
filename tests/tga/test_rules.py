"""Rules: nested sequences and choices become a cycle that admits exactly the words of the rule."""

from __future__ import annotations

from typing import FrozenSet, List, Set, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.diagnostics import Span
from pursue_gen.language.behaviour import locations_of
from pursue_gen.language.scenario import Both, Choice, Ref, Rule, RuleBody, Sequence
from pursue_gen.tga.network import Automaton
from pursue_gen.tga.rules import rule_automaton

NOWHERE = Span("test.pur", 1, 1, 1, 2)
EVENTS = ("a", "b", "c", "work")
LASTING = frozenset(["work"])

Words = Set[Tuple[str, ...]]


def e(name: str) -> Ref:
    return Ref(name, NOWHERE)


def before(first: RuleBody, second: RuleBody) -> Sequence:
    return Sequence(first, second, NOWHERE)


def either(first: RuleBody, second: RuleBody) -> Choice:
    return Choice(first, second, NOWHERE)


def both(first: RuleBody, second: RuleBody) -> Both:
    return Both(first, second, NOWHERE)


def rule(body: RuleBody, name: str = "rule1") -> Rule:
    return Rule(name, body, NOWHERE)


def names(automaton: Automaton) -> List[str]:
    return [location.name for location in automaton.locations]


def test_a_sequence_of_two_lasting_events() -> None:
    automaton, turns = rule_automaton(rule(before(e("go"), e("come"))), frozenset(["go", "come"]))
    assert names(automaton) == [
        "rule1_initial_location",
        "rule10f_doing_go",
        "rule10",
        "rule10s_doing_come",
    ]
    assert turns == {"go": (0,), "goDONE": (1,), "come": (2,), "comeDONE": (3,)}


def test_a_lasting_event_alone() -> None:
    automaton, turns = rule_automaton(rule(e("work")), LASTING)
    assert names(automaton) == ["rule1_initial_location", "rule10_doing_work"]
    assert turns == {"work": (0,), "workDONE": (1,)}


def test_parts_are_named_by_their_depth_and_way() -> None:
    body = before(before(e("a"), either(e("work"), e("work"))), before(e("b"), e("work")))
    automaton, turns = rule_automaton(rule(body, "r"), LASTING)
    assert names(automaton) == [
        "r_initial_location",
        "r1f",
        "r2fs_fir_doing_work",
        "r2fs_sec_doing_work",
        "r0",
        "r1s",
        "r1s_sec_doing_work",
    ]
    assert turns["work"] == (1, 5)
    assert turns["workDONE"] == (2, 3, 6)


def test_choices_of_instantaneous_events_need_no_location() -> None:
    automaton, turns = rule_automaton(
        rule(before(either(either(e("a"), e("b")), e("c")), either(e("d"), e("a")))), LASTING
    )
    assert names(automaton) == ["rule1_initial_location", "rule10"]
    assert turns == {"a": (0, 1), "b": (0,), "c": (0,), "d": (1,)}


def test_an_event_twice_at_one_turn_is_one_turn() -> None:
    _, turns = rule_automaton(rule(either(before(e("a"), e("b")), before(e("a"), e("c")))), LASTING)
    assert turns["a"] == (0,)


@pytest.mark.parametrize("lasting", [frozenset(), LASTING])
def test_locations_have_no_name_and_edges_only_listen(lasting: FrozenSet[str]) -> None:
    automaton, _ = rule_automaton(rule(before(e("work"), either(e("a"), e("b")))), lasting)
    assert not any(location.named for location in automaton.locations)
    assert all(edge.sync and not edge.sync.sends and edge.controllable for edge in automaton.edges)


def test_both_in_any_order() -> None:
    automaton, turns = rule_automaton(rule(before(both(e("a"), e("work")), e("c"))), LASTING)
    assert rounds_of(automaton) == {
        ("a", "work", "workDONE", "c"), ("work", "a", "workDONE", "c"), ("work", "workDONE", "a", "c"),
    }  # fmt: skip
    between = [f"rule11f_{place}" for place in ("0_1", "0_2", "1_0", "1_1")]
    assert names(automaton) == ["rule1_initial_location", *between, "rule10"]
    assert turns == {"a": (0, 1, 2), "work": (0, 3), "workDONE": (1, 4), "c": (5,)}


def test_both_of_two_that_last_go_on_at_the_same_time() -> None:
    automaton, _ = rule_automaton(rule(both(e("go"), e("come"))), frozenset(["go", "come"]))
    assert ("go", "come", "comeDONE", "goDONE") in rounds_of(automaton)
    assert len(rounds_of(automaton)) == 6 and len(names(automaton)) == 8


BODIES_WITH_AND = st.recursive(
    st.sampled_from(EVENTS).map(e),
    lambda inner: st.builds(before, inner, inner) | st.builds(either, inner, inner) | st.builds(both, inner, inner),
    max_leaves=5,
)


@given(BODIES_WITH_AND)
def test_the_automaton_of_a_rule_with_and_allows_the_rounds_of_the_text(body: RuleBody) -> None:
    automaton, _ = rule_automaton(rule(body), LASTING)
    assert rounds_of(automaton) == words_of(body)
    assert len(set(names(automaton))) == len(automaton.locations) == locations_of(body, LASTING) + 1


BODIES = st.recursive(
    st.sampled_from(EVENTS).map(e),
    lambda inner: st.builds(before, inner, inner) | st.builds(either, inner, inner),
    max_leaves=8,
)


def words_of(body: RuleBody) -> Words:
    """The rounds that a rule's text allows."""
    if isinstance(body, Ref):
        return {(body.name, "workDONE") if body.name in LASTING else (body.name,)}
    first, second = words_of(body.first), words_of(body.second)
    if isinstance(body, Both):
        return {word for one in first for two in second for word in shuffles(one, two)}
    return first | second if isinstance(body, Choice) else {one + two for one in first for two in second}


def shuffles(one: Tuple[str, ...], two: Tuple[str, ...]) -> Words:
    """All words in which the letters of both stand in their order."""
    if not one or not two:
        return {one + two}
    return {(one[0], *rest) for rest in shuffles(one[1:], two)} | {(two[0], *rest) for rest in shuffles(one, two[1:])}


def rounds_of(automaton: Automaton) -> Words:
    """The words on the ways from the initial location back to it."""
    result: Words = set()

    def walk(location: str, word: Tuple[str, ...]) -> None:
        for edge in automaton.edges:
            if edge.source == location and edge.sync:
                longer = (*word, edge.sync.channel)
                if edge.target == automaton.initial:
                    result.add(longer)
                else:
                    walk(edge.target, longer)

    walk(automaton.initial, ())
    return result


@given(BODIES)
def test_the_automaton_allows_the_rounds_of_the_text(body: RuleBody) -> None:
    automaton, _ = rule_automaton(rule(body), LASTING)
    assert rounds_of(automaton) == words_of(body)


@given(BODIES)
def test_names_are_unique_and_numbers_follow_their_order(body: RuleBody) -> None:
    automaton, turns = rule_automaton(rule(body), LASTING)
    listed = names(automaton)
    assert len(set(listed)) == len(listed)
    for edge in automaton.edges:
        assert edge.assign == (("Prule1", listed.index(edge.target)),)
        assert edge.sync is not None
        assert listed.index(edge.source) in turns[edge.sync.channel]
