"""The judge that every workspace carries: it accepts the steps of the model and no others."""

from __future__ import annotations

import importlib
import json
import sys
import unittest.mock
from types import SimpleNamespace
from typing import Any, Dict, Iterator, List

import pytest
from worlds import files

STUBS = (
    "rosgraph", "rosgraph.xmlrpc", "rospy", "rostest",
    "diagnostic_msgs.msg", "geometry_msgs.msg", "pursue_msgs.msg", "rosgraph_msgs.msg", "std_msgs.msg",
)  # fmt: skip


@pytest.fixture(scope="module")
def judge() -> Iterator[Any]:
    """The module mission_test, without ROS."""
    name = "pursue_runtime.nodes.mission_test"
    with unittest.mock.patch.dict(sys.modules, {stub: unittest.mock.MagicMock() for stub in STUBS}):
        sys.modules.pop(name, None)
        yield importlib.import_module(name)
        del sys.modules[name]


@pytest.fixture(scope="module")
def automata() -> Dict[str, Any]:
    expected = json.loads(files("thesis/scenario_1")["src/scenario_1_bringup/test/expected.json"])
    found: Dict[str, Any] = expected["automata"]
    return found


def state(**places: str) -> Dict[str, str]:
    at = {"bot1": "b", "bot2": "a", "reachObj": "unlocked", "rule1": "rule1_initial_location"}
    values = {"Pbot1": "2", "Pbot2": "1", "Prule1": "0"}
    return {**values, **at, **places}


def test_a_step_of_one_agent_is_accepted(judge: Any, automata: Dict[str, Any]) -> None:
    assert judge.explained(automata, state(), state(bot2="going_a_to_c"))
    assert judge.explained(automata, state(bot2="going_a_to_c"), state(bot2="c"))


def test_two_steps_at_once_and_steps_that_are_not_there_are_found(judge: Any, automata: Dict[str, Any]) -> None:
    assert not judge.explained(automata, state(), state(bot2="c"))
    assert not judge.explained(automata, state(), state(bot1="going_b_to_c", bot2="going_a_to_c"))
    assert not judge.explained(automata, state(), state())


WORKING = {"bot1": "doing_bot1_inb_in_b", "rule1": "rule10f_doing_bot1_inb"}


def test_an_event_before_its_turn_is_found(judge: Any, automata: Dict[str, Any]) -> None:
    """The rule: bot1_inb before bot2_ina."""
    assert judge.explained(automata, state(), state(**WORKING))
    assert not judge.explained(automata, state(), state(bot2="doing_bot2_ina_in_a"))


def test_an_automaton_that_does_not_hear_what_concerns_it_is_found(judge: Any, automata: Dict[str, Any]) -> None:
    assert not judge.explained(automata, state(), state(bot1=WORKING["bot1"]))
    assert not judge.explained(automata, state(), state(rule1=WORKING["rule1"]))


def test_locations_and_variables_of_a_state_are_read_as_text(judge: Any) -> None:
    automata = [SimpleNamespace(name="bot1", location="going_a_to_b")]
    message = SimpleNamespace(automata=automata, variables=[SimpleNamespace(name="Pbot1", value=-12)])
    assert judge.values_of(message) == {"bot1": "going_a_to_b", "Pbot1": "-12"}


def test_start_is_published_until_the_observer_answers(judge: Any) -> None:
    published: List[str] = []
    record = judge.Record([])

    def publish(word: str) -> None:
        published.append(word)
        record.status = "running" if len(published) == 3 else "waiting"

    class Played(judge.MissionTest):  # type: ignore[misc, name-defined]
        events = unittest.mock.Mock(publish=publish)

    with unittest.mock.patch.object(record, "wait", lambda done, seconds: done()):
        Played.record = record
        Played.start()
    assert published == ["_start_"] * 3
