"""The page and the terminal say for whom a robot waits at places that hold one, as the strategy's orders say it."""

from __future__ import annotations

from typing import Any, Dict

import pytest

from pursue_runtime.locations import Visit, place_passed, visit_at
from pursue_runtime.model import Model
from pursue_runtime.strategy import Strategy
from pursue_runtime.ui.environment import TraceEnvironment
from pursue_runtime.ui.mission_view import MissionView
from pursue_runtime.ui.outlook import Outlook
from pursue_runtime.ui.waits import Turns
from tests.runtime.models import model_data, mover, state


def order(place: str, *visitors: str) -> Dict[str, Any]:
    """The automaton of an order of passage, without the movements that it follows."""
    stays = [f"{does}_{robot}_{k}" for k, robot in enumerate(visitors, start=1) for does in ("awaits", "has")]
    locations: Dict[str, Any] = {name: [] for name in (*stays, "awaits_nobody")}
    return {"name": f"{place}_passage", "kind": "rule", "initial": stays[0], "edges": [], "locations": locations}


DATA = model_data(mover("bot_1", "robot", 9), mover("bot2", "robot", 9), order("b", "bot_1", "bot2", "bot_1"))
DATA["labels"] = {"bot_1": "Porter", "b": "the hall"}
MODEL = Model(DATA)


def entry(visit: str, robot: str = "bot2") -> Dict[str, Any]:
    command = {"do": f"{robot}_a2b", "agent": robot, "from": "a", "to": "going_a_to_b", "when": [f"1 < C{robot}"]}
    return {"state": {robot: "a", "b_passage": visit}, "commands": [command]}


WAITS = {"state": {"bot2": "a"}, "commands": []}
TWICE = [entry("awaits_bot_1_1", "bot_1"), entry("awaits_bot_1_3", "bot_1"), entry("awaits_bot2_2"), WAITS]
AGENTS: Dict[str, Any] = {"commands_agents": ["bot_1", "bot2"], "reaction": "1/10"}
STRATEGY = Strategy({**AGENTS, "strategy": TWICE})


@pytest.mark.parametrize(
    ("visit", "waits"),
    [
        ("awaits_bot_1_1", {"bot2": "waits for Porter to pass the hall first"}),
        ("has_bot_1_1", {"bot2": "waits for Porter to leave the hall", "bot_1": "waits for Porter to leave the hall"}),
        ("awaits_bot2_2", {"bot_1": "waits for bot2 to pass the hall first"}),
        ("has_bot2_2", {"bot_1": "waits for bot2 to leave the hall"}),
        ("awaits_bot_1_3", {}),
        ("awaits_nobody", {}),
    ],
)
def test_who_waits_for_whom_is_said_as_the_order_is(visit: str, waits: Dict[str, str]) -> None:
    there = {"bot_1": "b"} if visit == "has_bot_1_1" else {}
    waits = {name: text for name, text in waits.items() if name not in there}
    now = state(MODEL, 1, 0.0, {}, b_passage=visit, **there)
    assert Turns(MODEL, {0: (STRATEGY,)}).waits(now) == waits
    sight = Outlook(MODEL, (), {0: (STRATEGY,)}).sight(now, 0.0, ())
    assert {name: agent["why"] for name, agent in sight.agents.items() if agent["why"]} == waits


def test_nobody_waits_on_the_way_or_while_the_mission_holds() -> None:
    turns = Turns(MODEL, {0: (STRATEGY,)})
    assert turns.waits(state(MODEL, 1, 0.0, {}, b_passage="has_bot_1_1", bot_1="b", bot2="going_a_to_b")) == {}
    assert turns.waits(state(MODEL, 1, 0.0, {}, "holding", b_passage="has_bot_1_1", bot_1="b")) == {}


def test_a_new_plan_has_its_own_orders() -> None:
    known: Dict[int, Any] = {0: ()}
    turns = Turns(MODEL, known)
    now = state(MODEL, 1, 0.0, {}, bot_1="b", b_passage="has_bot_1_1")._replace(plan=1)
    assert turns.waits(now) == {}
    known[1] = (STRATEGY,)
    assert turns.waits(now) == {"bot2": "waits for Porter to leave the hall"}


def test_behind_the_last_visit_of_an_order_that_goes_round_comes_the_first_one() -> None:
    passage = order("b", "bot_1", "bot2")
    del passage["locations"]["awaits_nobody"]
    model = Model(model_data(mover("bot_1", "robot", 9), mover("bot2", "robot", 9), passage))
    turns = Turns(model, {0: [Strategy({**AGENTS, "strategy": [entry("awaits_bot_1_1", "bot_1")]})]})
    assert turns.waits(state(model, 1, 0.0, {}, b_passage="has_bot2_2")) == {"bot_1": "waits for bot2 to leave b"}


def test_the_terminal_says_it_too() -> None:
    view = MissionView(MODEL, TraceEnvironment(()), turns=Turns(MODEL, {0: (STRATEGY,)}))
    view.on_state(state(MODEL, 1, 0.0, {}, event="_start_", bot_1="b", b_passage="has_bot_1_1"), 0.0)
    assert "bot2 a (waits for Porter to leave the hall)" in view.progress(3.0)


def test_names_of_other_automata_and_locations_are_no_visits() -> None:
    assert visit_at("has_bot_1_12") == Visit("bot_1", 12, True)
    assert [visit_at(name) for name in ("awaits_nobody", "a", "has_bot", "going_a_to_b", "")] == [None] * 5
    assert [place_passed(name) for name in ("b_passage", "b_passage_of_bot2", "bot2")] == ["b", "b", ""]
