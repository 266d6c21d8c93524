"""A session in words: what is typed, what is read; and the command, without a terminal."""

from __future__ import annotations

import json
import subprocess
import sys
from fractions import Fraction
from pathlib import Path
from typing import List, Sequence, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st
from players import SCENARIOS, session

from pursue_gen.tools.play.session import HELP, Session, answer, farewell, opening, shown

THIEF = "thesis/catch_the_thief"


def say(at: Session, *lines: str) -> Tuple[Session, str]:
    """The session after these lines, and what the last of them was answered."""
    told: Sequence[str] = ()
    for line in lines:
        reply = answer(at, line)
        at, told = reply.session, reply.lines
    return at, "\n".join(told)


def test_it_begins_with_who_plays_whom() -> None:
    won, lost = "\n".join(opening(session(THIEF))), "\n".join(opening(session("cage")))
    assert "You play all other agents" in won
    assert "You play the robots" in lost
    assert "1  thief: go to b" in won


def test_a_number_and_a_moment() -> None:
    at, told = say(session(THIEF), "1 @ 3.5", "wait")
    assert "thief    on its way from c to b since 3.5; arrives between 15.5 and 16.5" in told
    assert at.play.now == Fraction(7, 2)


def test_waiting_for_a_while_and_until_a_time() -> None:
    assert say(session(THIEF), "wait 0.5")[0].play.now == Fraction(1, 2)
    assert say(session(THIEF), "wait 0.5", "wait @ 0.75")[0].play.now == Fraction(3, 4)


def test_undo_and_redo_lead_to_the_very_same_tables() -> None:
    start = session(THIEF)
    first, _ = say(start, "1")
    second, _ = say(first, "wait")
    back, told = say(second, "undo")
    assert back.play == first.play
    assert told == "\n".join(shown(first))
    assert say(back, "undo")[0].play == start.play
    assert say(back, "redo")[0].play == second.play
    other, _ = say(back, "wait 0.125")
    assert other.future == ()
    assert "where it began" in say(start, "undo")[1]
    assert "nothing to do again" in say(start, "redo")[1]


@pytest.mark.parametrize(
    "line, why",
    [
        ("fly", "'fly' is not known here"),
        ("9", "There is no number 9: the list has 1 to 2"),
        ("0", "There is no number 0"),
        ("1 @ 0.5", "Not at 0.5"),
        ("1 @ 2.12345", "at most three decimals"),
        ("wait -3", "is not clear"),
        ("wait soon", "is not clear"),
        ("wait @ 0", ""),
        ("save", "needs the name of a file"),
        ("1 @ 1e9", "is not clear"),
        ("99999999999999999999", "is not clear"),
    ],
)
def test_wrong_input_is_explained_and_changes_nothing(line: str, why: str) -> None:
    start = session(THIEF)
    reply = answer(start, line)
    assert why in "\n".join(reply.lines)
    assert reply.session.play == start.play
    assert not reply.over


@given(st.lists(st.one_of(st.text(max_size=12), st.sampled_from(
    ["1", "2", "3", "1 @ 4", "2 at 9.5", "wait", "wait 2", "wait @ 12", "undo", "redo", "map", "why", "log", "cancel",
     "help", ""])), max_size=12))
def test_whatever_is_typed_there_is_an_answer(lines: List[str]) -> None:
    at = session(THIEF)
    for line in lines:
        if not line.strip().lower().startswith("save"):
            reply = answer(at, line)
            assert reply.lines
            at = reply.session
    assert farewell(at)


def test_why_names_the_block_and_what_it_says() -> None:
    at, told = say(session(THIEF), "why")
    assert "Block 1 of" in told or "Block" in told
    at, told = say(at, "wait", "why")
    assert "It says to wait" in told


def test_the_strategy_says_what_it_is_about_to_do() -> None:
    assert "The strategy: polBot1 sets off from a to b at 1" in "\n".join(shown(session(THIEF)))


def test_the_map_tells_ways_and_people() -> None:
    told = say(session(THIEF), "map")[1]
    assert "a  to b (3), d (6)   here: polBot1, polBot2" in told


def test_the_map_says_while_what_a_way_is_open() -> None:
    told = say(session("hotel/staff_door"), "map")[1]
    assert "desk     to office (1), kitchen (2, only while clerk is at desk), room (3)   here: waiter, clerk" in told


def test_a_game_is_lost_at_once_where_the_condition_is_broken() -> None:
    at, told = say(session("hotel/quiet_corridor"), "1", "wait")
    assert at.play.over
    assert "any robot is at corridor and guest is at corridor, which must never be" in told + "\n".join(farewell(at))


def test_a_won_game_ends_with_a_clear_sentence() -> None:
    at = session("thesis/scenario_1")
    told = ""
    while not at.play.over:
        at, told = say(at, "wait")
    assert told.splitlines()[-1].startswith("The robots have done it after ")
    assert "The game is over" in say(at, "wait")[1]
    back, told = say(at, "undo")
    assert not back.play.over and "You can do" in told


def test_a_lost_game_ends_with_a_clear_sentence() -> None:
    at, told = session("work_cell/work_cell", "within 30", "within 12"), ""
    while not at.play.over:
        at, told = say(at, "wait")
    assert told.splitlines()[-1].startswith("The robots have lost after ")
    assert "no putDownBox within 12 of newBox" in told


def test_leaving_is_reported_as_it_is() -> None:
    assert "would have reached it" in farewell(session(THIEF))
    assert "so far the robots have kept it" in farewell(session("work_cell/work_cell"))
    assert "could not have been sure" in farewell(session("cage"))


def test_a_trace_holds_what_others_began(tmp_path: Path) -> None:
    yaml = pytest.importorskip("yaml")
    file = tmp_path / "game.yaml"
    _, told = say(session(THIEF), "1 @ 3.5", "wait", "wait", f"save {file}")
    assert "rosrun UI UI --trace" in told
    assert yaml.safe_load(file.read_text(encoding="utf-8")) == [{"at": 3.5, "do": "thief:thief_c2b"}]
    assert "is there already" in say(session(THIEF), f"save {file}")[1]
    assert "cannot write" in say(session(THIEF), "save /proc/nowhere/game.yaml")[1]


def test_a_trace_of_nothing_is_an_empty_list(tmp_path: Path) -> None:
    yaml = pytest.importorskip("yaml")
    say(session(THIEF), f"save {tmp_path / 'game.yaml'}")
    assert yaml.safe_load((tmp_path / "game.yaml").read_text(encoding="utf-8")) == []


def test_a_journal_is_found_right_by_replay(tmp_path: Path) -> None:
    file, at = tmp_path / "game.jsonl", session("thesis/scenario_2")
    while not at.play.over:
        at, _ = say(at, "wait")
    say(at, f"save {file}")
    scenario = SCENARIOS / "thesis" / "scenario_2.pur"
    done = subprocess.run(
        [sys.executable, "-m", "pursue_gen", "replay", str(file), str(scenario), "--json"],
        capture_output=True, text=True, check=False,
    )
    found = json.loads(done.stdout)
    assert (found["kept"], found["won"], done.returncode) == (True, True, 0)


# The command ----------------------------------------------------------------------------------------------------------


def run(scenario: str, text: str, *options: str) -> "subprocess.CompletedProcess[str]":
    """`pursue-gen play` with these lines on stdin."""
    return subprocess.run(
        [sys.executable, "-m", "pursue_gen", "play", str(SCENARIOS / f"{scenario}.pur"), *options],
        input=text, capture_output=True, text=True, check=False,
    )


def test_it_plays_a_script_from_stdin() -> None:
    done = run("thesis/scenario_1", "wait\n" * 12 + "quit\n")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.splitlines()[-1].startswith("The robots have done it after ")


def test_the_end_of_input_ends_it() -> None:
    done = run(THIEF, "")
    assert (done.returncode, done.stderr) == (0, "")
    assert "You have left at 0" in done.stdout


def test_who_asks_for_the_other_side_is_reported_why_not() -> None:
    done = run(THIEF, "", "--as", "robots")
    assert done.returncode == 2
    assert "you can only play the others" in done.stderr
    assert run(THIEF, "quit\n", "--as", "world").returncode == 0


def test_the_rules_may_be_chosen() -> None:
    done = run("work_cell/work_cell", "quit\n", "--reaction", "10")
    assert "You play the robots" in done.stdout


def test_help_has_all_commands() -> None:
    told = say(session(THIEF), "help")[1]
    for word in ("wait", "cancel", "undo", "redo", "map", "why", "log", "save", "quit"):
        assert word in told
    assert tuple(told.splitlines()) == HELP
