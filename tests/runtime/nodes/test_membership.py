"""Which mission a node belongs to, without a master."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Callable, Dict, List

import pytest

pytest.importorskip("rospy", reason="ROS is not installed")

from pursue_runtime.data import Package
from pursue_runtime.nodes import membership as module
from pursue_runtime.nodes.membership import Membership
from pursue_runtime.nodes.node import ERROR, OK, WARN, NodeReport
from pursue_runtime.state import SystemState
from tests.runtime.models import model_data, mover, worker

DIGEST = "ab" * 32
PEOPLE: Dict[str, Any] = {
    "format": 1, "controller": "UI", "commands_agents": ["nurse"], "reaction": 0.1, "strategy": [],
}  # fmt: skip


class Node:
    """The membership of a node whose data are in a folder, and what becomes of it."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch, **files: Any) -> None:
        mission = {"format": 1, "mission": DIGEST, "scenario": "example"}
        data = model_data(mover("bot", "robot", 9), worker("nurse", "human"))
        for name, content in {"model": data, "mission": mission, **files}.items():
            (folder / f"{name}.yaml").write_text(json.dumps(content))
        self.done: List[str] = []
        note = lambda name: lambda *_: self.done.append(name)
        witness = SimpleNamespace(publish=note("witness"))
        monkeypatch.setattr(module, "Witness", lambda newest: witness)
        monkeypatch.setattr(module, "StatePrinter", lambda _: SimpleNamespace(on_state=note("printed")))
        monkeypatch.setattr(module.rospy, "get_param", lambda *_: {})
        monkeypatch.setattr(module.rospy, "logerr", lambda *_: None)
        callbacks: List[Any] = []
        monkeypatch.setattr(module, "subscribe", lambda topic, kind, callback, *_, **__: callbacks.append(callback))
        ending: Any = SimpleNamespace(renew=note("renewed"))
        self.membership = Membership(Package("UI", "example", str(folder / "script")), ending, str(folder))
        self.said = lambda text: callbacks[0](SimpleNamespace(data=text))

    def state(self, **changes: Any) -> SystemState:
        """A state of this mission."""
        start = self.membership.model.initial()
        made = SystemState(1, 100.0, *start, status="running", mission=self.membership.source.mission)
        return made._replace(**changes)


def test_a_state_of_its_mission_counts_and_one_of_another_that_is_not_here_does_not(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    node = Node(tmp_path, monkeypatch)
    assert node.membership.model.scenario == "example"
    assert node.membership.takes(node.state()) and node.done == ["printed"] and node.membership.trouble == ""
    assert not node.membership.takes(node.state(mission="f" * 12, stamp=200.0, status="waiting", seq=0))
    assert node.membership.trouble == "does not have mission ffffffffffff: send it to this machine"
    assert node.membership.takes(node.state(stamp=300.0, status="waiting", seq=0)) and node.membership.trouble == ""


def test_a_state_that_is_not_of_its_model_is_refused_and_the_observer_learns_what_it_knows(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    node = Node(tmp_path, monkeypatch)
    assert not node.membership.takes(node.state(locations={"bot": "nowhere"}))
    assert node.done == ["witness"] and node.membership.refused


def test_a_node_is_not_ready_while_its_mission_is_not_the_one_of_the_observer(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    node = Node(tmp_path, monkeypatch)
    reports: List[Callable[[], NodeReport]] = []
    for name in ("subscribe_states", "pulses_of_all"):
        monkeypatch.setattr(module, name, lambda *_, **__: None)
    monkeypatch.setattr(module, "Diagnostics", lambda report, *_: reports.append(report))
    node.membership.follow(lambda *_: None, lambda: NodeReport(True, OK, "running", {"reported": 3}))
    mission = node.membership.source.mission
    values = {"mission": mission, "reported": 3, "refused": "", "malformed": 0}
    assert reports[0]() == (True, OK, "running", values)
    node.membership.takes(node.state(mission="f" * 12))
    assert reports[0]()[:3] == (False, WARN, "does not have mission ffffffffffff: send it to this machine")
    node.membership.takes(node.state(locations={"bot": "nowhere"}))
    found = reports[0]()
    assert found[:2] == (False, ERROR) and found.message == f"refused {found.values['refused']}"


def test_people_have_a_part_of_the_strategy_where_there_is_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert Node(tmp_path, monkeypatch).membership.people() is None
    people = Node(tmp_path, monkeypatch, people=PEOPLE).membership.people()
    assert people is not None and list(people.agents) == ["nurse"]


def test_a_state_of_a_plan_that_adds_what_was_written_counts_and_one_without_counts_after_the_end(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    node = Node(tmp_path, monkeypatch)
    plain = node.state()
    watch = {
        "name": "obj9", "kind": "safety", "initial": "idle", "locations": {"idle": [], "atRisk": ["Cobj9 <= 5"]},
        "edges": [{"from": "idle", "to": "atRisk", "word": "order1", "sync": "receive", "controllable": True}],
    }  # fmt: skip
    adds = {
        "automata": [watch], "heard": [], "clocks": ["Cobj9"], "variables": {"order_desk_open": 0},
        "objective": {"goal": None, "bad": None, "says": {}, "promises": {}},
        "written": [{"event": "order1", "says": "bot at a", "within": 5.0}],
    }  # fmt: skip
    written = plain._replace(
        seq=2, stamp=101.0, plan=3, locations={**plain.locations, "obj9": "atRisk"},
        values={**plain.values, "order_desk_open": 0}, clocks={**plain.clocks, "Cobj9": 1.0},
    )  # fmt: skip
    assert node.membership.takes(plain) and not node.membership.takes(written)
    node.said(json.dumps({"format": 1, "plan": 3, "mission": plain.mission, "adds": adds}))
    node.said("no plan")
    assert node.membership.takes(written) and node.membership.model.shown("order1") == "bot at a within 5"
    assert not node.membership.takes(written._replace(seq=3, locations=plain.locations))
    node.membership.takes(plain._replace(seq=0, stamp=300.0, status="waiting"))  # of the next mission
    assert not node.membership.model.has("obj9")
    node.said(json.dumps({"format": 1, "plan": 4, "mission": plain.mission, "adds": {**adds, "automata": 7}}))
    assert not node.membership.takes(written._replace(plan=4)) and "lacks or misspells" in node.membership.refused
