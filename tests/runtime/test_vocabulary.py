"""What agents do and where they are, in words, with labels or with marks."""

from __future__ import annotations

from typing import Any, Dict

import pytest

from pursue_runtime.model import Model
from pursue_runtime.sentences import MARKED
from pursue_runtime.state import SystemState
from pursue_runtime.ui.mission_view import possible_words
from pursue_runtime.ui.page import Facts, FloorPlan, Page
from pursue_runtime.vocabulary import Deed, deed, instruction, place, sentence, where
from tests.runtime.models import desk, model_data, mover, state, worker


def shouter(kind: str) -> Dict[str, Any]:
    """An agent that moves between a and b, and may shout wherever it is, also on its way."""
    made = mover("bot", kind, 9)
    for here in made["locations"]:
        made["edges"].append({"from": here, "to": here, "word": "shout", "sync": "send", "controllable": False})
    return made


LABELS = {"bot": "Porter 1", "a": "front desk", "shout": "call out"}
MODEL = Model({**model_data(shouter("agent"), worker("boy", "agent")), "labels": LABELS})


@pytest.mark.parametrize(("source", "target", "words"), [
    ("a", "going_a_to_b", Deed("sets off from {a} to {b}", "go to {b}")),
    ("going_a_to_b", "b", Deed("arrives at {b}", "arrive at {b}")),
    ("b", "b", Deed("does {shout}", "do {shout}")),
    ("going_a_to_b", "going_a_to_b", Deed("does {shout}", "do {shout}")),
    ("s", "doing_screw_in_s", Deed("begins {screw}", "begin {screw}")),
    ("doing_screw_in_s", "s", Deed("finishes {screw}", "finish {screw}")),
])  # fmt: skip
def test_what_an_agent_does_is_called_by_what_it_is(source: str, target: str, words: Deed) -> None:
    automaton, edge = next(
        (each, edge) for each in MODEL.automata for edge in each.edges if (edge.source, edge.target) == (source, target)
    )
    assert deed(MARKED, automaton, edge) == words


def test_where_an_agent_is_can_be_said_in_few_words() -> None:
    bot, boy = MODEL.automata[:2]
    assert [place(MODEL, bot, here) for here in ("a", "going_a_to_b")] == [
        "at front desk", "on its way from front desk to b"
    ]  # fmt: skip
    assert [where(MODEL, bot, here) for here in ("a", "going_a_to_b")] == ["front desk", "front desk → b"]
    assert (place(MODEL, boy, "doing_screw_in_s"), where(MODEL, boy, "doing_screw_in_s")) == (
        "doing screw at s", "screw at s"
    )  # fmt: skip


def test_a_person_is_told_what_to_do() -> None:
    bot, boy = MODEL.automata[:2]
    edges = {(edge.source, edge.target): edge for edge in (*bot.edges, *boy.edges)}
    assert instruction(MODEL, bot, edges["a", "going_a_to_b"]) == "go to b"
    assert instruction(MODEL, bot, edges["going_a_to_b", "going_a_to_b"]) == "do call out"
    assert instruction(MODEL, boy, edges["s", "doing_screw_in_s"]) == "do screw at s"


def under_way(seq: int, event: str = "") -> SystemState:
    """A state with the agent on its way from a to b."""
    clocks = {name: 2.0 for name in MODEL.clocks}
    now: SystemState = state(MODEL, seq, 100.0, clocks, event=event, agent="bot" * bool(event), bot="going_a_to_b")
    return now


def test_what_is_done_on_the_way_is_no_setting_off_on_the_page_and_the_terminal() -> None:
    now = under_way(3)
    (offer,) = possible_words(MODEL, now, now.clocks, ("agent",))[:1]
    assert (offer.word, offer.text) == ("shout", "Porter 1 does call out")
    page = Page(MODEL, FloorPlan({"a": (0.0, 0.0), "b": (9.0, 0.0), "s": (3.0, 4.0)}, ()))
    bot = page.view(Facts("running", (), now, 20.0, 20.0))["agents"][0]
    assert bot["doing"] == "is on its way from front desk to b" and bot["awaited"] == "arrive at b"
    assert [each["may"] for each in bot["next"]] == ["arrive at b", "do call out"]
    labels = {button["word"]: button["label"] for button in page.scene()["buttons"]}
    assert (labels["shout"], labels["bot_a2b"]) == ("call out", "front desk → b")
    assert sentence(MODEL, under_way(4, "shout"), now) == "Porter 1 does call out"


@pytest.mark.parametrize(("event", "says"), [("_leaves_", "out of service"), ("_joins_", "in service again")])
def test_a_robot_leaves_and_joins(event: str, says: str) -> None:
    model = Model(model_data(mover("bot", "robot", 9)))
    there = SystemState(5, 0.0, {"bot": "a"}, {}, {}, event, "bot")
    assert sentence(model, there, there) == f"bot is {says}"


def test_an_order_is_accepted_or_cancelled() -> None:
    model = Model({**model_data(mover("bot", "robot", 9), desk("tea")), "labels": {"tea": "Green tea"}})
    for event, says in (("tea", "is ordered, and accepted"), ("tea_cancelled_", "is cancelled")):
        now = state(model, 4, 100.0, dict.fromkeys(model.clocks, 2.0), event=event, agent="order_desk")
        assert sentence(model, now, None) == f"Green tea {says}"
