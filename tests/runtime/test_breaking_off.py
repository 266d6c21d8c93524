"""Actions that are broken off, at run time: what robots are ordered, what still counts, and in which words."""

from __future__ import annotations

from typing import Any, Dict

from pursue_runtime.locations import breaks_off
from pursue_runtime.model import Model
from pursue_runtime.observer.mission import Mission
from pursue_runtime.orders import parse_orders
from pursue_runtime.simulator.simulator import Delays, Simulator, end_window
from pursue_runtime.state import SystemState
from pursue_runtime.ui.mission_view import tasks
from pursue_runtime.vocabulary import awaited, deed, instruction, sentence
from tests.runtime.models import everywhere, model_data, state, worker


def who_may_stop(name: str, kind: str) -> Dict[str, Any]:
    """An agent that may break off screwing."""
    made = worker(name, kind)
    stop = {"from": "doing_screw_in_s", "to": "s", "word": "screwSTOP", "sync": "send", "when": [f"C{name} > 1"],
            "reset": [f"C{name}"], "controllable": True}
    return {**made, "edges": [made["edges"][0], stop, made["edges"][1]]}


def made(kind: str) -> Model:
    data = model_data(who_may_stop("bot", kind))
    data["automata"][-1]["edges"][0]["word"] = "screwDONE"
    return Model(data)


MODEL = made("robot")


def under_way() -> Mission:
    """A mission in which the robot has begun to screw, in state 2."""
    mission = Mission(MODEL, everywhere(MODEL), lambda *_: None, on_uncovered="warn")
    mission.on_word("_start_", 100.0)
    mission.on_word("bot:screw@1", 102.0)
    mission.on_word("bot:_order_@2", 102.1)
    return mission


def test_it_is_known_by_its_word() -> None:
    assert breaks_off("doing_screw_in_s", "screwSTOP") and breaks_off("doing_a_b_in_s", "a_bSTOP")
    others = [("doing_screw_in_s", "screwDONE"), ("s", "screwSTOP"), ("doing_screw_in_s", "crewSTOP")]
    assert not any(breaks_off(*each) for each in others)


def test_the_robot_gets_an_order_until_it_has_acknowledged_it() -> None:
    mission = under_way()
    (now,) = mission.on_word("bot:screwSTOP@2", 104.0)
    assert now.locations["bot"] == "s"
    (order,) = parse_orders(now.orders)
    assert (order.event, order.location, order.at_once) == ("screwSTOP", "s", True)
    (after,) = mission.on_word("bot:_order_@3", 104.1)
    assert after.orders == ()


def test_an_end_that_comes_after_it_changes_nothing() -> None:
    mission = under_way()
    mission.on_word("bot:screwSTOP@2", 104.0)
    assert mission.on_word("screwDONE#2", 104.2) == []
    assert mission.state(104.2).status == "running"


def test_an_end_that_comes_first_counts() -> None:
    mission = under_way()
    (done,) = mission.on_word("screwDONE#2", 105.5)
    assert done.locations["reachObj"] == "win"
    assert mission.on_word("bot:screwSTOP@2", 105.6) == []


def test_the_simulator_ends_it_as_before_and_not_once_it_is_broken_off() -> None:
    busy: SystemState = state(MODEL, 2, 102.0, {"Cbot": 0.0}, event="screw", agent="bot", bot="doing_screw_in_s")
    window = end_window(MODEL, MODEL.automaton("bot"), "doing_screw_in_s")
    assert window is not None and (window.event, window.low, window.high) == ("screwDONE", 3.0, 4.0)
    world = Simulator(MODEL, ["bot"], Delays("early"))
    world.on_state(busy, 0.0)
    world.on_order("bot", 102.0, "screw", 2)
    assert world.next_moments()[0] is not None
    world.on_state(state(MODEL, 3, 104.0, {"Cbot": 0.0}, event="screwSTOP", agent="bot", bot="s"), 1.0)
    assert world.next_moments() == (None, None)


def test_it_is_said_in_words() -> None:
    model = made("human")
    nurse = model.automaton("bot")
    stop = next(edge for edge in nurse.edges if edge.breaks_off)
    assert (deed(model, nurse, stop).does, instruction(model, nurse, stop)) == ("breaks off screw", "break off screw")
    assert awaited(model, nurse, "doing_screw_in_s") == "finish screw"
    busy = state(model, 2, 102.0, {"Cbot": 0.0}, event="screw", agent="bot", bot="doing_screw_in_s")
    (task,) = tasks(model, busy, ["bot"])
    assert (task.word, task.label) == ("screwDONE", "Done")
    off = state(model, 3, 104.0, {"Cbot": 0.0}, event="screwSTOP", agent="bot", bot="s")
    assert sentence(model, off, busy) == "bot breaks off screw"
