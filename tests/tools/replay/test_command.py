"""`pursue-gen replay` as a person calls it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from recordings import PLAY, SCENARIO, mission, write_bag, write_journal
from test_read import GAME

from pursue_gen.language import load
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.workspace import Options, write_workspace
from tests.cli.test_commands import Outcome, pursue


def called(*words: Any) -> Outcome:
    """What the command leaves behind."""
    done = pursue("replay", *words)
    assert "Traceback" not in done.err, done.err
    return done


@pytest.fixture(scope="module")
def bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_bag(mission(), tmp_path_factory.mktemp("bag") / "mission.bag", GAME)


def test_a_bag_alone_is_enough(bag: Path) -> None:
    done = called(bag)
    assert done.status == 0, done.out + done.err
    assert done.out.splitlines()[-1] == "The mission kept to the model and was won."
    assert "    10.40      5  bot1 arrives at b, report of simulator" in done.out


def test_it_is_said_how_late_commands_took_effect(bag: Path) -> None:
    done = called(bag)
    assert "Reaction: 5 commands took effect 0.100 time units after they were due (median), 0.100 at most" in done.out
    assert "near the limit: allow more with --reaction 0.2" in done.out
    assert json.loads(called(bag, "--json").out)["reaction"]["commands"] == 5


def test_the_scenario_may_be_named(bag: Path, tmp_path: Path) -> None:
    bare = write_bag(mission(), tmp_path / "bare.bag")
    assert called(bare, SCENARIO).status == 0
    missing = called(bare)
    assert missing.status == 2 and "SCENARIO.pur" in missing.err


def test_what_a_workspace_knows_is_taken(bag: Path, tmp_path: Path) -> None:
    scenario = load(str(SCENARIO))
    won = solve_scenario(scenario, Rules())
    place = write_workspace(scenario, won.network, won.objective, won.strategy, Options(), tmp_path / "ws")
    journal = write_journal(PLAY, tmp_path / "journal-1.jsonl")
    for file in (bag, journal):
        done = called(file, "--workspace", place, "--quiet")
        assert done.status == 0, done.out + done.err
        assert len(done.out.splitlines()) == 2
    assert called(bag, SCENARIO, "--workspace", place).status == 2
    assert called(bag, "--workspace", tmp_path).status == 2


def test_it_is_said_where_the_model_was_left_most_and_what_would_have_held(tmp_path: Path) -> None:
    play = [(at - 1.0 if "c_to_b2b" in word else at, word, node) for at, word, node in PLAY]
    play = [(at + 2.0 if "inaDONE" in word else at, word, node) for at, word, node in play]
    file = write_bag(mission(tuple(play)), tmp_path / "mission.bag", GAME)
    done = called(file, "--quiet")
    lines = done.out.splitlines()
    head = next(number for number, line in enumerate(lines) if line.startswith("Where the model was left most"))
    assert lines[head + 1 : head + 5] == [
        "  bot2_ina, model 6 to 7: 1 of 1 late by 1.40",
        '    event "bot2_ina" … duration 4.1 to 16.8 // 1 action, 8.4, too few for more than a guess',
        "  bot1: c to b, model 9 to 10: 1 of 1 early by 0.70",
        "    travel bot1 from c to b takes 4.1 to 16.6 // 1 drive, 8.3, too few for more than a guess",
    ]
    (late, early) = json.loads(called(file, "--json").out)["left_most"]
    assert (late["event"], late["late"], early["a"], early["early"]) == ("bot2_ina", 1, "c", 1)


def test_a_mission_that_left_the_model_gives_status_1_and_says_where(tmp_path: Path) -> None:
    play = tuple((at - 1.0 if "c_to_b2b" in word else at, word, node) for at, word, node in PLAY)
    bag = write_bag(mission(play), tmp_path / "early.bag", GAME)
    done = called(bag)
    assert done.status == 1
    assert "WORLD: bot1_going_c_to_b2b by bot1 comes 0.70 time units early for the model" in done.out
    assert done.out.splitlines()[-1].startswith("The mission left the model")
    assert called(bag, "--tolerance", "0.8").status == 0


def test_json_holds_everything(bag: Path) -> None:
    done = called(bag, "--json")
    told = json.loads(done.out)
    assert (told["kept"], told["won"], told["status"], told["findings"]) == (True, True, "won", [])
    assert [step["event"] for step in told["steps"]][:2] == ["reachObj_going_initial_location2unlocked", "bot1_c2b"]
    assert told["steps"][1]["said_by"] == "controller_bot1" and told["steps"][1]["command"] is True


def test_a_mission_that_was_not_won_gives_status_1(tmp_path: Path) -> None:
    done = called(write_bag(mission(PLAY[:-1]), tmp_path / "short.bag", GAME))
    assert done.status == 1 and "had not ended when the recording did" in done.out


def test_another_scenario_gives_status_1_and_says_so(bag: Path) -> None:
    done = called(bag, SCENARIO.parent / "scenario_3.pur")
    assert done.status == 1 and "is it the right one?" in done.out


def test_a_file_that_is_no_recording_gives_status_2(tmp_path: Path) -> None:
    done = called(SCENARIO)
    assert done.status == 2 and "neither a bag nor a journal" in done.err
    (tmp_path / "plan.bag").write_bytes(b"#ROSBAG V2.0\n\xff\xff")
    assert called(tmp_path / "plan.bag").status == 2
