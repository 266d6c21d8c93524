"""An observer that was killed goes on where it was: the journal holds all that changed the mission."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any, List, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime.folders import scenario_folder
from pursue_runtime.model import Model
from pursue_runtime.observer.journal import Journal, unfinished_mission
from pursue_runtime.observer.mission import Mission
from pursue_runtime.state import format_state
from pursue_runtime.strategy import read_cover
from tests.runtime.observer.test_holding import COVER, EVERYWHERE, answer
from tests.runtime.observer.test_mission import CHASE
from tests.runtime.texts import read

HEADER = {"scenario": "chase", "model": "1", "launch": "x"}
PLAY = [
    *[("hear", word) for word in ("_start_", "bot_a2b", "nonsense", "bot_going_a_to_b2b")],
    *[("silent", "one"), ("searching", 1, 10.0), ("planned", 1, answer(EVERYWHERE))],
    *[("hear", "one:_plan_@1"), ("back", "one")],
    *[("tick",), ("hear", "dog:catch@7")],
]


class Life:
    """One observer: a fresh mission, and its journal."""

    def __init__(self, path: Path, header: Any = None) -> None:
        self.logs: List[Tuple[str, str]] = []
        log = lambda level, message: self.logs.append((level, message))
        cover = read_cover(read(COVER))
        chase = Model(read(CHASE))
        self.mission = Mission(chase, cover, log, on_uncovered="plan", controllers=["one"])
        self.journal = Journal(self.mission, str(path), header or HEADER, log)

    def play(self, *calls: Any, first: int = 0) -> List[Any]:
        """Calls, one time unit after the other; what was published."""
        states = []
        for moment, (name, *arguments) in enumerate(calls, start=first):
            states += self.journal.call(name, *arguments, now=1000.0 + moment)
        return states

    def state(self) -> str:
        """Everything that is published, but for the clocks of the moment."""
        text: str = format_state(self.mission.state(2000.0))
        return text


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "pursue" / "chase" / "journal-x.jsonl"


@pytest.mark.parametrize("death", range(len(PLAY) + 1))
def test_a_new_observer_is_where_the_old_one_was(path: Path, death: int) -> None:
    whole, before = Life(path.with_name("journal-y.jsonl")), Life(path)
    told = whole.play(*PLAY)
    assert told[-1].seq == 8 and told[-1].plan == 1
    published = before.play(*PLAY[:death])
    after = Life(path)
    assert after.state() == before.state()
    assert [state.seq for state in published + after.play(*PLAY[death:], first=death)] == [state.seq for state in told]
    assert after.state() == whole.state()


def test_a_new_observer_still_has_the_plan_in_force_for_those_who_come_later(path: Path) -> None:
    before = Life(path)
    before.play(*PLAY)
    assert before.mission.in_force["plan"] == 1
    assert Life(path).mission.in_force == before.mission.in_force


def test_a_new_observer_knows_the_ways_that_are_blocked(path: Path) -> None:
    before = Life(path)
    before.play(*PLAY[:2], ("hear", "bot:_blocked_"), ("hear", "going_a_to_b:_free_"))
    assert Life(path).mission.blocked == set()
    before.play(("hear", "going_a_to_b:_blocked_"), first=4)
    again = Life(path).mission
    assert again.blocked == {("a", "b")} and again.plan_request == before.mission.plan_request


def test_a_new_observer_knows_when_something_was_last_written(path: Path) -> None:
    assert Life(path).journal.last == 0.0
    before = Life(path)
    before.play(("hear", "_start_"), ("hear", "nonsense"))
    assert Life(path).journal.last == before.journal.last == 1000.0


def test_what_changes_nothing_is_not_written(path: Path) -> None:
    life = Life(path)
    life.play(("hear", "_start_"))
    size = path.stat().st_size
    life.play(("hear", "_ping_"), ("hear", "nonsense"), ("hear", "dog:catch@9"), ("tick",), first=1)
    assert path.stat().st_size == size


def test_a_line_is_written_before_anybody_hears_of_the_state(path: Path) -> None:
    life = Life(path)
    states = life.play(("hear", "_start_"))
    assert json.loads(path.read_text().splitlines()[-1])["seq"] == states[-1].seq


def test_a_torn_last_line_is_as_if_it_had_not_happened(path: Path) -> None:
    life = Life(path)
    life.play(*PLAY[:4])
    lines = path.read_bytes().splitlines(keepends=True)
    path.write_bytes(b"".join(lines[:-1]) + lines[-1][:20])
    again = Life(path)
    assert again.mission.seq == 2 and not [text for level, text in again.logs if level == "err"]
    again.play(*PLAY[3:], first=3)
    assert Life(path).state() == again.state()


def test_a_journal_that_cannot_be_played_again_ends_in_a_safe_stop(path: Path) -> None:
    Life(path).play(*PLAY[:4])
    lines = path.read_text().splitlines()
    for broken in ("{}", "rubbish", lines[2].replace('"seq": 2', '"seq": 5'), lines[2].replace("hear", "mark")):
        path.write_text("\n".join([*lines[:2], broken, *lines[3:]]) + "\n")
        life = Life(path)
        assert life.mission.status == "stopped" and "journal" in life.mission.reason


@given(st.data())
def test_no_damage_ends_in_an_exception(tmp_path_factory: pytest.TempPathFactory, data: st.DataObject) -> None:
    path = tmp_path_factory.mktemp("journal") / "journal-x.jsonl"
    Life(path).play(*PLAY)
    content = path.read_bytes()
    start = data.draw(st.integers(0, len(content)))
    end = data.draw(st.integers(start, len(content)))
    path.write_bytes(content[:start] + data.draw(st.binary(max_size=20)) + content[end:])
    assert Life(path).mission.status in ("waiting", "running", "holding", "stopped", "won")


@pytest.mark.parametrize("header", [{**HEADER, "launch": "z"}, {**HEADER, "model": "2"}])
def test_another_launch_or_model_is_another_mission(path: Path, header: Any) -> None:
    Life(path).play(*PLAY[:4])
    assert Life(path, header).mission.status == "waiting"
    assert len(os.listdir(path.parent)) == 2


def test_an_end_that_was_not_told_is_told_again_and_then_it_is_over(path: Path) -> None:
    Life(path).play(("hear", "_start_"), ("hear", "_stop_"))
    again = Life(path)
    assert again.mission.status == "stopped"
    again.journal.end()
    assert Life(path).mission.status == "waiting"


MISSION = {**HEADER, "mission": "0123456789ab"}


def test_a_new_observer_learns_whose_mission_was_under_way(path: Path) -> None:
    assert unfinished_mission(str(path), "x") is None
    life = Life(path, MISSION)
    assert unfinished_mission(str(path), "x") is None, "it has not begun"
    life.play(("hear", "_start_"))
    assert unfinished_mission(str(path), "x") == "0123456789ab"
    assert unfinished_mission(str(path), "y") is None, "that was in another launch"
    life.play(("hear", "_stop_"), first=1)
    assert unfinished_mission(str(path), "x") == "0123456789ab", "nobody may have heard of its end"
    life.journal.end()
    assert unfinished_mission(str(path), "x") is None


def test_the_workspaces_own_mission_may_have_no_name(path: Path) -> None:
    Life(path).play(("hear", "_start_"))
    assert unfinished_mission(str(path), "x") == ""


@pytest.mark.parametrize("text", ["", "rubbish\nrubbish\n", "[]\n{}\n", '{"format": 1}\n{"call": "hear"}\n'])
def test_what_is_no_journal_says_of_no_mission_that_it_is_under_way(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True)
    path.write_text(text)
    assert unfinished_mission(str(path), "x") is None


def test_a_journal_of_a_mission_that_never_began_leaves_nothing_behind(path: Path) -> None:
    Life(path, MISSION)
    Life(path).play(("hear", "_start_"))
    assert os.listdir(path.parent) == [path.name]
    assert Life(path).mission.seq == 1


def test_the_newest_journals_are_kept(path: Path) -> None:
    path.parent.mkdir(parents=True)
    for number in range(30):
        old = path.with_name(f"journal-{number:02}.jsonl")
        old.write_text("")
        os.utime(old, (number, number))
    Life(path)
    kept = sorted(entry for entry in os.listdir(path.parent) if entry != path.name)
    assert kept == [f"journal-{number:02}.jsonl" for number in range(10, 30)]


def test_without_a_place_for_it_the_mission_runs_and_says_so(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    life = Life(tmp_path / "file" / "journal.jsonl")
    assert life.play(("hear", "_start_"))[-1].seq == 1
    assert not life.journal.is_open and any(level == "err" for level, _ in life.logs)


def test_the_journals_are_under_ros_home() -> None:
    assert scenario_folder({"ROS_HOME": "/some/where"}, "example") == "/some/where/pursue/example"
    assert scenario_folder({}, "example").endswith("/.ros/pursue/example")
