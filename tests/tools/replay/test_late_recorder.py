"""A recorder that was killed and started again begins another bag: what is not in it is no node's fault."""

from __future__ import annotations

from typing import List, Tuple

import pytest
import recordings
from hypothesis import given
from hypothesis import strategies as st
from recordings import START, Mission, game, mission

from pursue_gen.tools.replay import Findings, MissionRecord, check
from pursue_gen.tools.replay.bag import Message
from pursue_gen.tools.replay.finding import FAULT, UNRECORDED, WORLD
from pursue_gen.tools.replay.read import from_messages
from pursue_gen.tools.replay.summary import verdict

NODES = ("observer", "controller_bot1", "controller_bot2", "controllerObj", "simulator", "UI")


def late(made: Mission, units: float, lacks: float = 0.5) -> MissionRecord:
    """What a recorder has that is started after so many time units, and connected to all nodes `lacks` seconds later:
    until then it has the latched state only."""
    begin = START + units * made.unit
    latched = [state for state in made.states if state.stamp <= begin][-1]
    shown = (begin, "/pursue/system_state", "observer", recordings.text_of(latched))
    heard = [
        (at, topic, node, what)
        for at, topic, node, what in made.messages()
        if at > begin + (0.0 if node == "observer" else lacks)
    ]
    pulses = [(begin + lacks, "/diagnostics", node, "") for node in NODES]
    messages = []
    for at, topic, node, what in sorted([shown, *heard, *pulses], key=lambda message: message[0]):
        data = recordings._pose(at, what) if topic.endswith("goal") else recordings._string(what)
        messages.append(Message(topic, "", node, at, data))
    return from_messages(messages)


def of_level(findings: Findings, level: str) -> List[Tuple[str, int]]:
    return [(finding.kind, finding.seq) for finding in findings.findings if finding.level == level]


@given(st.floats(0.2, 21.2), st.floats(0.05, 2.0))
def test_whenever_a_recorder_is_started_again_no_node_is_blamed(units: float, lacks: float) -> None:
    made = mission()
    findings = check(late(made, units, lacks), game())
    assert of_level(findings, FAULT) == of_level(findings, WORLD) == []
    assert of_level(findings, UNRECORDED)[0][0] == "gap" and findings.won and not findings.kept
    assert "kept to the model as far as it was recorded, and was won" in verdict(findings)
    assert "Not recorded: state" in verdict(findings)


def test_what_the_recorder_has_missed_is_listed() -> None:
    findings = check(late(mission(), 11.4), game())  # bot1 begins to work at 11.5
    assert of_level(findings, UNRECORDED) == [("gap", 6), ("unsaid", 7)]


def test_after_that_everything_counts() -> None:
    made = mission()
    made.heard = [message for message in made.heard if message[3] not in ("bot2_inaDONE", "bot2_ina")]
    assert of_level(check(late(made, 5.0), game()), FAULT) == [("untold", 9), ("unsaid", 10)]


def test_a_node_that_comes_later_does_not_make_it_longer() -> None:
    made = mission()
    made.say(START + 18.0, "nonsense", "rostopic_7")
    made.heard = [message for message in made.heard if message[3] != "bot2_ina"]
    assert ("untold", 9) in of_level(check(late(made, 5.0), game()), FAULT)


@pytest.mark.parametrize("units", [5.0, 11.4])
def test_a_wrong_order_is_a_fault_also_for_a_recorder_that_came_late(units: float) -> None:
    made = mission()
    made.order(START + 20.0, "bot1", "c")
    assert ("order", 9) in of_level(check(late(made, units), game()), FAULT)


def test_a_robot_that_was_under_way_may_get_its_order_again() -> None:
    made = mission()
    made.order(START + 8.0, "bot1", "b")
    made.order(START + 8.0, "bot2", "a")
    assert of_level(check(late(made, 5.0), game()), FAULT) == []
