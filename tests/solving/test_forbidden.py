"""Events that an assumption forbids for ever."""

from __future__ import annotations

from pathlib import Path
from typing import Tuple

import pytest
from hypothesis import given, settings

from pursue_gen.language.scenario import Scenario
from pursue_gen.solving import forbidden
from pursue_gen.solving.forbidden import check_forbidden
from pursue_gen.tga import translate
from tests.assumptions import APART, CAFE, LEAVES, MUSEUM, ONCE, ROOMS, scenario
from tests.tools.authoring.commands import pursue
from tests.whole_stories import stories

WORKSHOP = """\
poi "m1"
poi "m2"
connect m1 and m2 distance 3
event "break1" location m1
event "repair1" location m1 duration 2
event "look" location m2
event "fetch" location m2
state "broken1": initially true, true_if break1 false_if repair1
stateDependency: repair1 only_if broken1 is_true
agent "bot" controllable mobile 1 location m1 can_do fetch
agent "machine" location m1 can_do break1
agent "mechanic" mobile 1 location m2 can_do repair1{}
{}
reach_objective: do fetch
"""
NO_VISITS = "assume: not (mechanic at m1 and broken1 is_false)"


@pytest.mark.parametrize("search", ["states", "relaxed"])
def test_events_that_never_happen_are_named_with_those_who_can_do_nothing_then(
    search: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    if search == "relaxed":
        monkeypatch.setattr(forbidden, "_MOST_MOVES", 3)
    story = scenario(WORKSHOP.format("", NO_VISITS))
    (found,) = check_forbidden(story)
    assert found.code == "PML266" and found.span == story.assumptions[0].span and found.hint
    assert found.message == (
        "as long as it never holds that mechanic is at m1 and broken1 is false, repair1 can never happen, "
        "and mechanic can do nothing but move"
    )


def test_whoever_can_still_do_something_is_not_named() -> None:
    (found,) = check_forbidden(scenario(WORKSHOP.format(", look", NO_VISITS)))
    assert found.message.endswith("repair1 can never happen")


def test_what_two_facts_together_forbid_is_found_where_there_are_few_states() -> None:
    wrong = "assume: not (mechanic at m1 and broken1 is_true)"
    (found,) = check_forbidden(scenario(WORKSHOP.format("", wrong)))
    assert "repair1 can never happen" in found.message


def test_an_event_that_is_assumed_away_is_no_surprise_but_what_needs_it_is() -> None:
    never = "assume: guest does call at_most 0 times"
    (found,) = check_forbidden(scenario(CAFE.format(f'rule "order": call before serve\n{never}')))
    assert found.message == "as long as guest never does call, serve can never happen"
    (found,) = check_forbidden(scenario(WORKSHOP.format("", "assume: mechanic never at m1")))
    assert "repair1 can never happen" in found.message


def test_several_assumptions_are_named_where_none_alone_forbids_it() -> None:
    both = "assume: guest does call at_most 0 times\nassume: clerk does call at_most 0 times"
    clerk = 'agent "clerk" location room can_do call'
    (found,) = check_forbidden(scenario(CAFE.format(f'{clerk}\nrule "order": call before serve\n{both}')))
    assert "as long as guest never does call and clerk never does call, serve can never" in found.message


@pytest.mark.parametrize("text", [CAFE.format(ONCE), ROOMS.format(APART), MUSEUM.format(LEAVES), CAFE.format("")])
def test_what_can_still_happen_is_not_reported(text: str) -> None:
    assert list(check_forbidden(scenario(text))) == []


def test_nothing_is_reported_of_a_network_that_is_too_large(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(forbidden, "_MOST_EDGES", 3)
    assert list(check_forbidden(scenario(WORKSHOP.format("", NO_VISITS)))) == []


@settings(max_examples=15)
@given(stories())
def test_the_relaxed_search_finds_every_edge_that_states_lead_to(story: Tuple[str, Scenario]) -> None:
    network = translate(story[1])
    taken = forbidden._by_states(network)
    assert taken is None or set(taken) <= set(forbidden._relaxed(network))


def test_check_and_solve_warn(tmp_path: Path) -> None:
    file = tmp_path / "workshop.pur"
    file.write_text(WORKSHOP.format("", NO_VISITS), encoding="utf-8")
    assert "workshop.pur:13:1: warning PML266" in pursue("check", file).out
    assert "warning PML266" in pursue("solve", file).err
