"""Answers to conditions, and conditions as answers: an automaton listens to the moves that change them."""

from __future__ import annotations

import random
from typing import List, Optional

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.language import network_names as names
from pursue_gen.language import parse
from pursue_gen.language.scenario import Ref, Respond, Scenario
from pursue_gen.solving.rules import Rules, played
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Edge, Guard, Sync, Test
from pursue_gen.tga.uppaal import read_network, write_network
from pursue_gen.tools.simulation.meaning import holds
from pursue_gen.workspace.model_file import model_data
from pursue_runtime.model import Model

PLACES = """\
poi "hall"
poi "lab"
connect hall and lab distance 2
event "open" location lab
event "close" location lab duration 1
event "dance" collaborative together location hall duration 2
state "isOpen": initially false, true_if open false_if close
agent "bot" controllable mobile 1 location hall can_do close, dance
agent "kid" mobile 1 location lab can_do open reacts_to dance
objective: {}
"""


def scenario(objective: str) -> Scenario:
    return parse(PLACES.format(objective), "x.pur", "x")


def edges(objective: str) -> List[Edge]:
    return list(translate(scenario(objective)).automaton("obj").edges)


def test_an_arrival_that_makes_a_condition_hold_has_to_be_answered() -> None:
    comes, there = Sync("kid_going_lab_to_hall2hall", False), Sync("bot_going_hall_to_lab2lab", False)
    at_hall = tuple(Test("Pbot", code) for code in (1, -12, -21, -11))
    (begins, answered, lost) = edges("if kid at hall then bot at lab within 9")
    assert (begins.source, begins.sync, begins.resets) == ("idle", comes, ("Cobj",))
    assert set(begins.guard.integers[0]) == set(at_hall), "at once where the bot is there already"
    assert answered == Edge("atRisk", "idle", Guard(), there)
    assert lost == Edge("atRisk", "lose")


def test_events_that_set_a_state_are_listened_to() -> None:
    closed = (Test("SisOpen", 0),)
    assert edges("if isOpen is_true then isOpen is_false within 9")[:2] == [
        Edge("idle", "atRisk", Guard(integers=(closed,)), Sync("open", False), resets=("Cobj",)),
        Edge("atRisk", "idle", Guard(), Sync("close", False)),
    ]


@pytest.mark.parametrize(
    ("objective", "initial"),
    [
        ("if kid at lab then bot at lab within 9", "atRisk"),
        ("if kid at lab then bot at hall within 9", "idle"),
        ("if kid at hall then bot at lab within 9", "idle"),
        ("if kid at lab then open within 9", "atRisk"),
        ("if open then bot at hall within 9", "idle"),
    ],
)
def test_a_condition_that_holds_at_the_start_is_due_then(objective: str, initial: str) -> None:
    assert translate(scenario(objective)).automaton("obj").initial == initial


FORMS = [
    "if kid at hall then bot at lab within 1000",
    "if kid at lab then open within 1000",
    "if open then bot at lab within 1000",
    "if open then bot doing close within 1000",
    "if bot doing close then close within 1000",
    "if kid doing dance then isOpen is_false within 1000",
    "if any agent on_way then no agent on_way within 1000",
    "if bot at hall and kid at hall then isOpen is_true and not kid at hall within 1000",
    "if isOpen is_true or kid at hall then (bot at lab and isOpen is_false) or kid on_way within 1000",
    "if not any agent at lab then any agent at lab and isOpen is_true within 1000",
]


@pytest.mark.parametrize("form", FORMS)
@given(seed=st.integers(0, 10**6))
@settings(max_examples=15)
def test_it_is_at_risk_exactly_from_what_is_to_be_answered_to_the_answer(form: str, seed: int) -> None:
    """Random plays, against the meaning of conditions said of places and states."""
    story, rules = scenario(form), Rules()
    (duty,) = story.safety
    assert isinstance(duty, Respond)
    model = Model(model_data(played(translate(story), rules), scenario_objective(story), story, rules.reaction))
    happened = {names.has_happened(event): event.name for event in story.events}
    rng, here = random.Random(seed), model.initial()

    def true(what: object, event: str) -> bool:
        if isinstance(what, Ref):
            return happened.get(event) == what.name
        return holds(what, story, here.locations, here.values)  # type: ignore[arg-type]

    word: Optional[str] = ""
    held = due = False
    for _ in range(40):
        begun = true(duty.trigger, word or "")
        if true(duty.response, word or ""):
            due = False
        elif begun and not held:
            due = True
        held = begun and not isinstance(duty.trigger, Ref)
        assert here.locations["obj"] == ("atRisk" if due else "idle"), (word, here)
        able = [each for each in model.possible(here, timed=False) if not each.startswith("obj")]
        word = rng.choice(able)
        moves = model.joint_move(here, word, timed=False)
        assert moves is not None
        here = model.after(moves, here)


def test_uppaal_reads_it_back() -> None:
    story = scenario("if kid at hall then bot at lab and isOpen is_false within 20")
    made = translate(story)
    assert read_network(write_network(made, scenario_objective(story)), "x.xml") == made


def test_events_alone_need_no_arrivals() -> None:
    network = translate(scenario("if open then close within 20"))
    assert not any("going" in channel for channel in network.channels)
