"""Where a strategy in stages knows what to do: each part of the present stage has to."""

from __future__ import annotations

from typing import Any, Dict

from pursue_runtime.state import SystemState
from pursue_runtime.strategy import read_cover

DATA: Dict[str, Any] = {
    "format": 1,
    "stages": [[["left", "done"], ["right", "done"]], [["goal", "win"]]],
    "cover": [
        {"state": {"one": "a", "left": "open"}, "wait": ["always"]},
        {"state": {"two": "a", "right": "open"}, "wait": ["Cx <= 5"]},
        {"state": {"one": "a", "left": "done", "right": "done", "goal": "run"}, "wait": ["always"]},
    ],
}


def zones(**places: str) -> int:
    """How many entries apply; 0 where a part has none."""
    everywhere = {"one": "a", "two": "a", "left": "open", "right": "open", "goal": "run", **places}
    return len(read_cover(DATA).zones(SystemState(1, 0.0, everywhere, {}, {"Cx": 0.0})))


def test_each_part_of_a_stage_has_its_entry() -> None:
    assert zones() == 2
    assert zones(left="done") == 1, "that part has ended, and the other goes on"
    assert zones(left="done", right="done") == 1, "the last stage"


def test_a_part_without_an_entry_does_not_hide_behind_another() -> None:
    assert zones(one="b") == 0 and zones(two="b") == 0
    assert zones(left="done", two="b") == 0
    assert zones(one="b", left="done") == 1


def test_a_cover_without_stages_is_covered_where_an_entry_applies() -> None:
    plain = {**DATA, "stages": []}
    state = SystemState(1, 0.0, {"one": "b", "two": "a", "left": "open", "right": "open", "goal": "run"}, {}, {})
    assert len(read_cover(plain).zones(state)) == 1


def test_each_share_has_to_know_what_to_do_all_the_time() -> None:
    entries = [
        {"state": {"bot1": "a", "obj": "idle"}, "wait": ["always"]},
        {"state": {"bot2": "c", "obj2": "idle"}, "wait": ["Cbot2 <= 3"]},
    ]
    cover = read_cover({"shares": [[["obj", "lose"]], [["obj2", "lose"]]], "cover": entries})
    both = {"bot1": "a", "bot2": "c", "obj": "idle", "obj2": "idle"}
    assert len(cover.zones(SystemState(1, 0.0, both, {}, {}))) == 2
    assert cover.zones(SystemState(1, 0.0, {**both, "bot2": "elsewhere"}, {}, {})) == []
