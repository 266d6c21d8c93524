"""The benchmark that kills nodes: which kills are drawn, what an outcome is, and the page. The missions are ROS's."""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import signal
from dataclasses import replace
from pathlib import Path
from typing import Any, Dict, List, Sequence, Tuple

import pytest

from benchmarks import kills
from benchmarks.kills import draw, judge, outcome, text_of
from benchmarks.kills_page import OTHERS, OUTCOMES, RULES, Mission, mismatch, page, results, together
from benchmarks.lab_scenarios import lab_scenario
from benchmarks.ros_world import ROOT, World
from pursue_gen.language import parse
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.tools.replay import Findings
from pursue_gen.tools.replay.finding import FAULT, NOTE, UNRECORDED, WORLD, Finding
from tests.tools.replay.recordings import PLAY, game, mission, write_bag, write_journal
from tests.waiting import until

pytestmark = pytest.mark.benchmark

NODES = ("UI", "controller_bot1", "observer", "simulator")


def findings(status: str, *levels: str, reason: str = "") -> Findings:
    """What was found in a mission that ended so, with one finding for each level."""
    found = tuple(Finding(level, "kind", 3, f"a {level}") for level in levels)
    return Findings((), found, status, reason, 0.0, 1.0)


def test_the_kills_of_a_mission_follow_from_its_number_and_the_seed() -> None:
    drawn = [draw(1, number, NODES, 10.0) for number in range(200)]
    assert drawn == [draw(1, number, NODES, 10.0) for number in range(200)]
    assert drawn != [draw(2, number, NODES, 10.0) for number in range(200)]
    assert {kill.node for kills in drawn for kill in kills} == set(NODES)
    assert {len(kills) for kills in drawn} == {1, 2, 3, 4, 5}
    assert all(0.0 <= kill.after <= 10.0 for kills in drawn for kill in kills)
    assert all(list(kills) == sorted(kills, key=lambda kill: kill.after) for kills in drawn)


@pytest.mark.parametrize(
    ("status", "levels", "expected"),
    [
        ("won", (), "goal"),
        ("won", (NOTE, WORLD), "goal"),
        ("won", (WORLD, FAULT), "wrong"),
        ("stopped", (WORLD,), "stopped"),
        ("stopped", (FAULT,), "wrong"),
        ("lost", (), "wrong"),
        ("running", (), "no end"),
    ],
)
def test_a_mission_is_wrong_where_a_node_did_what_it_must_not(
    status: str, levels: Sequence[str], expected: str
) -> None:
    assert outcome(findings(status, *levels))[0] == expected


def test_a_mission_is_lost_by_right_where_a_robot_was_late_by_its_model_before() -> None:
    late = Finding(WORLD, "late", 7, "bot_end by bot comes 4.29 time units late for the model")
    lost = replace(findings("lost", reason="a deadline has passed"), findings=(late,))
    assert outcome(lost) == ("lost", f"{late.text}; a deadline has passed")
    for other in (replace(late, level=NOTE), replace(late, kind="early")):
        assert outcome(replace(lost, findings=(other,))) == ("wrong", "the mission was lost")
    assert outcome(replace(lost, findings=(late, replace(late, level=FAULT))))[0] == "wrong"


def test_a_mission_is_lost_by_right_while_it_holds_for_a_plan() -> None:
    holds = Finding(NOTE, "hold", 7, "the mission holds: the moment at which the strategy goes on has passed")
    lost = replace(findings("lost", reason="a deadline has passed"), findings=(holds,))
    assert outcome(lost) == ("lost", f"{holds.text}; a deadline has passed")
    goes_on = replace(holds, seq=9, text="the mission goes on")
    assert outcome(replace(lost, findings=(holds, goes_on))) == ("wrong", "the mission was lost")
    assert outcome(replace(lost, findings=(holds, replace(holds, level=FAULT, kind="untold"))))[0] == "wrong"


@pytest.mark.parametrize("level", [FAULT, UNRECORDED])
@pytest.mark.parametrize("kind", ["unsaid", "untold", "command", "gap", "unacknowledged"])
def test_no_kind_of_fault_is_passed_over(kind: str, level: str) -> None:
    missed = Finding(level, kind, 3, "bot1 got no order to begin bot1_inb (an action)")
    assert outcome(replace(findings("won"), findings=(missed,))) == ("wrong", f"state 3: {missed.text}")


def judged(folder: Path, *missing: str, more: Sequence[str] = (), journal: bool = True) -> Tuple[str, str, List[str]]:
    """How a won mission is judged that has two bags, in which these words and orders are missing, and a journal."""
    recorded = mission()
    for text in more:
        recorded.say(recorded.states[-1].stamp - 0.5, text, "simulator")
    recorded.heard = [message for message in recorded.heard if message[3] not in missing]
    bags = [write_bag(recorded, folder / name) for name in ("mission.bag", "second.bag")]
    journals = [write_journal(PLAY, folder / "journal-1.jsonl")] if journal else []
    found, why, missed = judge(bags[0], bags[1], journals, game())
    return found, why, list(missed)


def test_a_word_that_the_observer_has_heard_is_a_gap_of_the_recorders(tmp_path: Path) -> None:
    assert judged(tmp_path, "bot1:bot1_inb@6", "bot1_inbDONE") == (
        "goal", "", ["the word bot1:bot1_inb@6", "the word bot1_inbDONE"]
    )


def test_a_word_that_nobody_has_heard_is_a_fault(tmp_path: Path) -> None:
    found, why, _ = judged(tmp_path, "bot1:bot1_inb@6", journal=False)
    assert (found, why) == ("wrong", "state 7: no word for bot1_inb was recorded")


def test_an_order_that_the_robots_side_has_acknowledged_is_a_gap_of_the_recorders(tmp_path: Path) -> None:
    found, why, missed = judged(tmp_path, "bot1_inb", more=["bot1:_order_@7"])
    assert (found, why) == ("goal", "")
    assert missed == ["state 7: the order to begin bot1_inb was not recorded, but bot1's side has acknowledged it"]


@pytest.mark.parametrize("more", [[], ["bot1:_order_@6"], ["bot2:_order_@7"]])
def test_an_order_that_nobody_has_recorded_or_acknowledged_is_a_fault(tmp_path: Path, more: Sequence[str]) -> None:
    found, why, _ = judged(tmp_path, "bot1_inb", more=more)
    assert (found, why) == ("wrong", "state 7: bot1 got no order to begin bot1_inb (an action)")


def test_what_one_recorder_alone_has_is_no_gap_and_without_a_second_there_is_no_verdict(tmp_path: Path) -> None:
    whole, holed = mission(), mission()
    holed.heard = [message for message in holed.heard if message[3] not in ("bot1_inb", "bot1:bot1_inb@6")]
    first, second = write_bag(holed, tmp_path / "mission.bag"), write_bag(whole, tmp_path / "second.bag")
    assert judge(first, second, [], game()) == ("goal", "", ())
    second.unlink()
    assert judge(first, second, [], game())[0] == "no end"


def made(first: int, done: Sequence[Mission], seed: int = 7) -> Dict[str, Any]:
    """What is kept of these missions."""
    part = {"first": first, "missions": len(done), "date": "a day", "commit": f"after{first}"}
    return {**results(done), "seed": seed, "unit": 0.5, "machine": "a machine", "parts": [part]}


def test_missions_are_added_to_those_that_were_played_before() -> None:
    one = [Mission(0, "one", "goal", "", ("UI after 1.00 s",)), Mission(1, "two", "stopped", "a", ())]
    two = [Mission(2, "two", "goal", "", ()), Mission(3, "three", "wrong", "b", ("UI after 1.00 s",))]
    parts, whole = together(made(0, one), made(2, two)), made(0, [*one, *two])
    assert {**parts, "parts": []} == {**whole, "parts": []}
    lines = [f"- missions {k} to {k + 1}: played a day with commit after{k}" for k in (0, 2)]
    assert "\n".join(lines) in page(parts)
    assert mismatch(made(0, one), made(2, two)) == ""
    for other in (made(1, two), made(3, two), made(2, two, seed=8)):
        assert "cannot be added to what is there: 2 missions, seed 7, unit 0.5" in mismatch(made(0, one), other)


def test_missions_that_have_ended_are_kept_when_those_after_them_are_interrupted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    roscores = [True]

    def play(number: int, *_: object) -> Mission:
        if number == 3 and roscores:
            roscores.clear()
            raise SystemExit("no roscore comes up")
        return Mission(number, "one", "goal", "", ())

    def kept(*more: str) -> List[int]:
        command = ["kills", "--out", str(tmp_path), "--machine", "a machine", "--jobs", "2", *more, "thesis/scenario_1"]
        monkeypatch.setattr("sys.argv", command)
        with contextlib.suppress(SystemExit):
            assert kills.main() == 0
        assert (tmp_path / "kills.md").is_file()
        return [part["missions"] for part in json.loads(file.read_text())["parts"]]

    file = tmp_path / "benchmarks" / "kills.json"
    file.parent.mkdir()
    monkeypatch.setattr(kills, "mission", play)
    monkeypatch.setattr(kills, "generated", lambda *_: tmp_path)
    monkeypatch.setattr(kills, "from_workspace", lambda _: None)
    monkeypatch.setattr(kills, "game_of", lambda _: game())
    assert kept("--missions", "6") == [3]
    assert kept("--missions", "3", "--first", "3") == [3, 3]
    assert json.loads(file.read_text())["missions"] == 6


def test_the_page_says_how_much_both_recorders_have_missed() -> None:
    one = [Mission(0, "one", "goal", "", ())]
    two = [Mission(1, "one", "goal", "", (), ("the word e", "state 3: the order to begin e was not recorded"))]
    text = page(together(made(0, one), made(1, two)))
    assert "both recorders have missed what was published in 1 of them: words 1, orders 1" in " ".join(text.split())
    assert "words 0, orders 0" in page(made(0, one))


def test_the_page_counts_each_outcome_and_names_the_reasons_of_stops() -> None:
    done = [
        Mission(0, "one", "goal", "", ("UI after 1.00 s",)),
        Mission(1, "two", "stopped", "a|b", ("observer after 1.00 s", "UI after 2.00 s")),
        Mission(2, "one", "wrong", "state 3: a fault", ("UI after 1.00 s",)),
    ]
    found = made(0, done)
    assert found["kills"] == 4
    assert [each["number"] for each in found["bad"]] == [2]
    text = page(found)
    assert "| one | 1 | 0 | 0 | 1 | 0 |" in text
    assert "| two | 0 | 1 | 0 | 0 | 0 |" in text
    assert "| a/b | 1 |" in text
    assert all(f"**{head}**" in text for head in OUTCOMES)
    assert max(map(len, text.splitlines())) <= 120


@pytest.mark.parametrize("name", sorted(set(OTHERS) - {"lab/16"}))
def test_the_strategies_of_the_others_are_what_the_page_says(name: str) -> None:
    scenario = parse(text_of(name), "story.pur", "story")
    strategy = solve_scenario(scenario, RULES).strategy
    kinds = ("shares", strategy.shares), ("order of passage", strategy.passages), ("tour", strategy.tours)
    for word, parts in kinds:
        assert (word in OTHERS[name]) == bool(parts)
    assert f"- {name}: {OTHERS[name]}." in page(made(0, [Mission(0, name, "goal", "", ())]))


def test_a_scenario_is_named_by_its_file_its_seed_or_its_size() -> None:
    assert text_of("lab/17") == lab_scenario(17)
    file = ROOT / "scenarios" / "thesis" / "scenario_1.pur"
    assert text_of("thesis/scenario_1") == file.read_text(encoding="utf-8")
    for unknown in ("lab/first", "thesis/scenario_9", "corridor"):
        with pytest.raises(SystemExit, match=f"there is no scenario {unknown}: name a file of scenarios/, lab/SEED or"):
            text_of(unknown)


@pytest.mark.skipif(not shutil.which("roscore"), reason="needs ROS 1: roscore is not on PATH")
def test_what_a_process_has_started_ends_with_it_though_it_has_a_session_of_its_own(tmp_path: Path) -> None:
    """As the nodes of a roslaunch that does not end them in time."""
    there = World(tmp_path)
    there.start("launch", ["bash", "-c", "trap '' INT; setsid sleep 1000 & echo $!; wait; wait"])
    node = int(until(lambda: there.log("launch").strip(), "the process says which one it has started"))
    there.stop()
    until(lambda: not runs(node), "what it has started ends")


def runs(process: int) -> bool:
    """True for a process that has not ended; nobody may have waited for its end yet."""
    try:
        return Path(f"/proc/{process}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


@pytest.mark.skipif(not shutil.which("roscore"), reason="needs ROS 1: roscore is not on PATH")
def test_a_signal_ends_the_missions_that_are_under_way(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    there = World(tmp_path)

    def waiting(number: int, *_: object) -> Mission:
        with kills._open(there):
            launch = there.start("launch", ["sleep", "1000"])
            os.kill(os.getpid(), signal.SIGTERM)
            launch.wait(60.0)
        raise AssertionError("nobody asks for this mission any more")

    monkeypatch.setattr(kills, "mission", waiting)
    before = signal.signal(signal.SIGTERM, kills._leave)
    try:
        with pytest.raises(SystemExit):
            list(kills.measure([0, 1, 2], 1, 1, 0.5, ()))
    finally:
        signal.signal(signal.SIGTERM, before)
    assert not there.running
