"""Generated modules are loaded from their texts, find each other, and leave no trace."""

from __future__ import annotations

import sys

import pytest
from stages import THIEF, files, solved, stage

from pursue_gen.diagnostics import PursueError
from pursue_gen.simulation.code import load, sources
from pursue_gen.simulation.stage import stage_from

TEXTS = {"one": "from two import answer\nimport json\n", "two": "answer = 42\n"}


def test_modules_find_each_other_and_are_found_by_nobody_else() -> None:
    before = dict(sys.modules)
    loaded = load(TEXTS, ["one"])
    assert loaded["one"].answer == 42
    assert set(loaded) == {"one", "two"}
    assert {name for name in sys.modules if name in TEXTS} == {name for name in before if name in TEXTS}


def test_two_workspaces_live_side_by_side() -> None:
    first, second = load(TEXTS, ["one"]), load({**TEXTS, "two": "answer = 43\n"}, ["one"])
    assert (first["one"].answer, second["one"].answer) == (42, 43)
    assert stage(THIEF).pursue_library is not stage("thesis/scenario_1").pursue_library


def test_a_module_of_the_same_name_is_put_back() -> None:
    import json

    loaded = load({"json": "mine = True\n", "user": "from json import mine\n"}, ["user"])
    assert loaded["user"].mine
    assert sys.modules["json"] is json


def test_the_modules_of_a_workspace_need_no_ros(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "rospy", None)  # whoever imports it fails
    texts = sources(files(THIEF))
    loaded = load(texts, ["observer_core", "controller_core", "simulator_core"])
    assert {"pursue_library", "pursue_strategy", "pursue_model"} <= set(loaded)


def test_what_is_not_installed_is_said() -> None:
    path = "src/observer/scripts/observer_board.py"
    found = files(THIEF)
    broken = {**found, path: found[path].replace(b"from transitions import", b"from no_such_module import")}
    with pytest.raises(PursueError) as refused:
        stage_from(broken, *solved(THIEF))
    assert refused.value.exit_status == 6
    assert "no_such_module" in refused.value.diagnostics[0].message
