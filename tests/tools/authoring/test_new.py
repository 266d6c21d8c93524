"""`pursue-gen new`: what it writes is sound, is won, and is what was asked for; and it never harms a file."""

from __future__ import annotations

import io
import sys
from dataclasses import replace
from pathlib import Path
from typing import Dict, List, Optional, Tuple
from unittest import mock

import pytest

from pursue_gen.cli.app import main
from pursue_gen.cli.options import WORDS
from pursue_gen.diagnostics import PursueError
from pursue_gen.language import check, load, parse
from pursue_gen.language.formatter import format_text
from pursue_gen.language.scenario import Avoid, NeverWith, Patrol, Reach, Respond, Scenario
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.tools.authoring.dialog import Dialog, ask_requirements
from pursue_gen.tools.authoring.first_scenario import scenario_text
from pursue_gen.tools.authoring.goals import GOALS
from pursue_gen.tools.authoring.requirements import Requirements, Robot, Task

from .commands import pursue

ROW = ("desk", "shelf", "window", "door", "yard")


def sound_and_won(text: str, file: str = "floor.pur") -> Scenario:
    """The scenario, once it is checked, laid out, and won in the default game."""
    scenario = parse(text, file)
    assert check(scenario) == ()
    assert format_text(text, file) == text
    assert solve_scenario(scenario, Rules()).strategy is not None
    return scenario


def dialog(*lines: str) -> Dialog:
    return Dialog(io.StringIO("".join(line + "\n" for line in lines)), io.StringIO())


# What it writes is won ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("places", [1, 2, 3])
@pytest.mark.parametrize("robots", [1, 2, 3])
@pytest.mark.parametrize("kind", list(GOALS))
def test_every_combination_of_options_is_won(kind: str, robots: int, places: int) -> None:
    quiet, row = Dialog(io.StringIO(), io.StringIO(), quiet=True), ",".join(ROW[:places])
    if places < GOALS[kind].fewest_places:
        with pytest.raises(PursueError) as caught:
            ask_requirements(quiet, kind, row, robots)
        assert "expected 2 to" in str(caught.value)
        return
    scenario = sound_and_won(scenario_text(ask_requirements(quiet, kind, row, robots), "floor.pur"))
    assert [poi.name for poi in scenario.pois] == list(ROW[:places])
    assert sum(agent.controllable for agent in scenario.agents) == robots
    kinds = {"reach": Reach, "catch": Reach, "respond": Respond, "avoid": Avoid, "never-with": NeverWith}
    kinds["patrol"] = Patrol
    assert isinstance(scenario.objectives[0], kinds[kind])


@pytest.mark.parametrize("speeds", [(1,), (3,), (1, 3), (4, 2)])
@pytest.mark.parametrize("distances", [(1,), (1, 5), (7, 2), (2, 1, 3)])
@pytest.mark.parametrize("kind", ["catch", "avoid"])
def test_the_others_may_be_as_fast_as_is_allowed(
    kind: str, distances: Tuple[int, ...], speeds: Tuple[int, ...]
) -> None:
    places = ROW[: len(distances) + 1]
    task = None if kind == "catch" else Task("lock", places[-2], 2)
    robots = tuple(Robot(f"bot{number}", speed, task) for number, speed in enumerate(speeds))
    mobile = GOALS[kind].slow_enough(places, distances, robots)
    event = "grab" if kind == "catch" else "enter"
    sound_and_won(scenario_text(Requirements(kind, places, distances, robots, "thief", mobile, event), "floor.pur"))


@pytest.mark.parametrize("durations", [(0,), (1,), (30,), (0, 5), (4, 4, 1)])
@pytest.mark.parametrize(("distances", "mobile"), [((), 1), ((1,), 1), ((3, 9), 2), ((5,), None)])
def test_the_deadline_can_be_kept(
    distances: Tuple[int, ...], mobile: Optional[int], durations: Tuple[int, ...]
) -> None:
    places = ROW[: len(distances) + 1]
    robots = tuple(
        Robot(f"bot{number}", mobile if number < 2 else None, Task(f"work{number}", places[-1 - number % 2], duration))
        for number, duration in enumerate(durations)
        if distances or not number % 2
    )
    required = Requirements("respond", places, distances, robots, "man", None, "call")
    scenario = sound_and_won(scenario_text(required, "floor.pur"))
    (safety,) = scenario.safety
    assert isinstance(safety, Respond)
    assert safety.deadline == required.deadline


# The questions --------------------------------------------------------------------------------------------------------

ANSWERS: Dict[str, List[str]] = {
    "reach": ["1", "ward, lab, store", "5", "6", "carrier, arm", "take", "lab", "0", "2", "pack", "store", "4", "0",
              "nurse", "150"],
    "respond": ["respond", "ward,lab", "7", "carrier", "bring", "lab", "2", "1", "patient", "ring", "25"],
    "avoid": ["3", "ward, lab, store", "5", "6", "keeper", "shut", "lab", "2", "1", "cat", "eatMouse", "5"],
    "never-with": ["4", "ward, lab, store", "5", "6", "a, b", "take", "ward", "0", "2", "give", "lab", "1", "1"],
    "catch": ["catch", "ward, lab", "5", "dog1, dog2", "1", "2", "cat", "grab", "4"],
    "patrol": ["6", "ward, lab, store", "5", "6", "guard", "2", "60"],
}  # fmt: skip


@pytest.mark.parametrize("kind", list(GOALS))
def test_the_answers_are_in_the_scenario(kind: str) -> None:
    screen = io.StringIO()
    source = io.StringIO("".join(line + "\n" for line in ANSWERS[kind]))
    found = ask_requirements(Dialog(source, screen), None, None, None)
    assert found.kind == kind
    assert source.read() == ""
    scenario = sound_and_won(scenario_text(found, "floor.pur"))
    names = {part.name for part in (*scenario.pois, *scenario.events, *scenario.agents)}
    words = {word.strip() for line in ANSWERS[kind][1:] for word in line.split(",")}
    assert {word for word in words if word[0].isalpha()} <= names
    numbers = [word for word in words if word.isdigit() and word != "0"]
    assert all(f" {number}" in scenario.text for number in numbers)
    for meaning in (goal.meaning for goal in GOALS.values()):
        assert meaning in screen.getvalue()


def test_what_is_given_is_not_asked() -> None:
    screen = io.StringIO()
    found = ask_requirements(Dialog(io.StringIO("\n" * 30), screen), "reach", "a,b", 2)
    assert (found.kind, found.places, len(found.robots)) == ("reach", ("a", "b"), 2)
    for question in ("What is the goal?", "What places", "Which robots"):
        assert question not in screen.getvalue()


@pytest.mark.parametrize(
    ("answer", "expected"),
    [
        ("7", "a number from 1 to 6"),
        ("²", "a number from 1 to 6"),
        ("", ""),
    ],
)
def test_a_goal_is_asked_until_it_is_one(answer: str, expected: str) -> None:
    screen = io.StringIO()
    source = io.StringIO(f"{answer}\n" + "\n" * 30)
    assert ask_requirements(Dialog(source, screen), None, None, None).kind == "reach"
    assert expected in screen.getvalue()
    assert screen.getvalue().count("Number or word?") == (2 if expected else 1)


@pytest.mark.parametrize(
    ("question", "answer", "expected"),
    [
        ("What places", "a, b, a", "a is taken already"),
        ("What places", "two words, b", "letters, digits and _"),
        ("What places", 'a" poi "b', "letters, digits and _"),
        ("What places", "while, b", "word of Python"),
        ("What places", "agent, b", "word of the language"),
        ("What places", ",", "give it a name"),
        ("What places", ",".join(f"p{number}" for number in range(21)), "1 to 20 names"),
        ("How far", "0", "a whole number from 1 to 100"),
        ("How far", "2.5", "a whole number from 1 to 100"),
        ("How far", "9" * 5000, "a whole number from 1 to 100"),
        ("Which robots", "desk", "desk is taken already"),
        ("What does bot1 do", "bot1", "bot1 is taken already"),
        ("Where", "shelve", "did you mean shelf?"),
        ("does bot1 need", "fast", "a whole number from 0 to 20"),
        ("somebody you do not control", "fetch", "fetch is taken already"),
        ("By when", "3", "expected 0, or a whole number from"),
        ("By when", "tomorrow", "the robots may not be done"),
    ],
)
def test_a_bad_answer_is_reported_and_asked_again(question: str, answer: str, expected: str) -> None:
    usual = io.StringIO()
    plain = ask_requirements(Dialog(io.StringIO("\n" * 30), usual), "reach", None, None)
    asked = [line for line in usual.getvalue().split("\n") if "[" in line]
    place = next(number for number, line in enumerate(asked) if question in line)
    screen = io.StringIO()
    lines = [""] * place + [answer] + [""] * 30
    assert ask_requirements(Dialog(io.StringIO("\n".join(lines)), screen), "reach", None, None) == plain
    assert expected in screen.getvalue()
    assert screen.getvalue().count(asked[place].strip()) == usual.getvalue().count(asked[place].strip()) + 1


@pytest.mark.parametrize(
    ("kind", "answers", "expected"),
    [
        ("respond", ["-1", "soon", "40"], "a whole number from 0 to"),
        ("patrol", ["0", "27", "28"], "a whole number from 28 to 1000000, not '27': the way to all places"),
    ],
)
def test_a_time_that_cannot_be_is_asked_again(kind: str, answers: List[str], expected: str) -> None:
    quiet = Dialog(io.StringIO(), io.StringIO(), quiet=True)
    usual, screen = ask_requirements(quiet, kind, "a,b,c", 1), io.StringIO()
    before = {"respond": 8, "patrol": 3}[kind]
    lines = io.StringIO("\n".join([""] * before + answers))
    found = ask_requirements(Dialog(lines, screen), kind, "a,b,c", 1)
    assert found == (replace(usual, waits=40) if kind == "respond" else usual) and usual.every in (0, 28)
    assert expected in screen.getvalue() and screen.getvalue().count("whole number from") == 2


@pytest.mark.parametrize(("distances", "mobile"), [((1,), (1,)), ((7, 2), (2, 1)), ((3,), (None, 3))])
@pytest.mark.parametrize("other", ["", "nurse"])
def test_the_earliest_deadline_that_is_accepted_can_be_kept(
    distances: Tuple[int, ...], mobile: Tuple[Optional[int], ...], other: str
) -> None:
    places = ROW[: len(distances) + 1]
    robots = tuple(Robot(f"bot{k}", m, Task(f"work{k}", places[-1 - k], 2 * k)) for k, m in enumerate(mobile))
    given = Requirements("reach", places, distances, robots, other, None, "handOver" if other else "")
    least = given.shortest_within
    scenario = sound_and_won(scenario_text(replace(given, within=least), "floor.pur"))
    (reach,) = scenario.reach
    assert isinstance(reach, Reach) and reach.within == least


@pytest.mark.parametrize(("distances", "mobile"), [((1,), (1,)), ((7, 2), (2,)), ((3, 1), (4, 1))])
def test_the_shortest_patrol_that_is_accepted_can_be_walked(
    distances: Tuple[int, ...], mobile: Tuple[int, ...]
) -> None:
    places, robots = ROW[: len(distances) + 1], tuple(Robot(f"bot{k}", speed) for k, speed in enumerate(mobile))
    given = Requirements("patrol", places, distances, robots)
    every = given.shortest_every
    scenario = sound_and_won(scenario_text(replace(given, every=every), "floor.pur"))
    assert {safety.every for safety in scenario.safety if isinstance(safety, Patrol)} == {every}


def test_who_is_too_fast_to_be_caught_is_asked_again() -> None:
    quiet = Dialog(io.StringIO(), io.StringIO(), quiet=True)
    usual = ask_requirements(quiet, "catch", "a,b", 1)
    least = GOALS["catch"].slow_enough(usual.places, usual.distances, usual.robots)
    screen = io.StringIO()
    answers = ["", "", "", "", str(least - 1), str(least), ""]
    found = ask_requirements(Dialog(io.StringIO("\n".join(answers)), screen), "catch", "a,b", 1)
    assert found.mobile == least
    assert "could not be sure" in screen.getvalue()


def test_nobody_answers_so_often_wrongly() -> None:
    with pytest.raises(PursueError) as caught:
        ask_requirements(dialog(*["?"] * 100), None, None, None)
    assert caught.value.exit_status == 2


def test_suggested_names_are_new_ones() -> None:
    quiet = Dialog(io.StringIO(), io.StringIO(), quiet=True)
    for kind in GOALS:
        row = "bot1,fetch,visitor,order,safe,lock,thief,bot1_2"
        found = ask_requirements(quiet, kind, row, 2)
        assert len(set(found.names)) == len(found.names)
        assert check(parse(scenario_text(found, "floor.pur"), "floor.pur")) == ()


# The command ----------------------------------------------------------------------------------------------------------


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_file_is_written_and_named(folder: Path) -> None:
    done = pursue("new", "floor", "--yes")
    assert (done.status, done.out) == (0, "floor.pur\n")
    assert "whatever the others do" in done.err and "next: pursue-gen solve floor.pur" in done.err
    assert "?" not in done.err
    scenario = load(folder / "floor.pur")
    assert scenario.name == "floor"
    assert pursue("fmt", "--check", "floor.pur").status == 0
    assert pursue("new", "other.pur", "--yes", "-o", folder / "sub" / "hall.pur").out == f"{folder}/sub/hall.pur\n"
    assert pursue("new", "third", "--yes", "-o", folder / "sub").out == f"{folder}/sub/third.pur\n"
    assert sorted(path.name for path in folder.rglob("*.pur")) == ["floor.pur", "hall.pur", "third.pur"]


def test_the_same_wishes_give_the_same_file(folder: Path) -> None:
    assert pursue("new", "floor", "--yes").status == 0
    first = (folder / "floor.pur").read_bytes()
    assert pursue("new", "floor", "--force", stdin=b"\n" * 40).status == 0
    assert (folder / "floor.pur").read_bytes() == first


def test_a_file_is_not_replaced_without_force(folder: Path) -> None:
    (folder / "floor.pur").write_text("mine", encoding="utf-8")
    done = pursue("new", "floor", "--yes")
    assert done.status == 2 and "--force" in done.err
    assert (folder / "floor.pur").read_text(encoding="utf-8") == "mine"
    assert pursue("new", "floor", "--yes", "--force", "--kind", "avoid").status == 0
    assert isinstance(load(folder / "floor.pur").safety[0], Avoid)


@pytest.mark.parametrize("answers", [b"", b"1\n", b"1\na,b\n\xff\n"])
def test_when_the_answers_end_nothing_is_written(folder: Path, answers: bytes) -> None:
    done = pursue("new", "floor", stdin=answers)
    assert done.status == 2
    assert "nothing was written" in done.err and "--yes" in done.err
    assert list(folder.iterdir()) == []


def test_an_interrupt_leaves_nothing(folder: Path) -> None:
    class Interrupted(io.StringIO):
        def readline(self, *_: object) -> str:  # type: ignore[override]
            raise KeyboardInterrupt

    words = mock.patch.object(sys, "argv", ["pursue-gen", "new", "floor"])
    with mock.patch.object(sys, "stdin", Interrupted()), words, pytest.raises(SystemExit) as left:
        main()
    assert left.value.code == 130
    assert list(folder.iterdir()) == []


@pytest.mark.parametrize("name", ["my floor", "2nd", "a-b", ".pur", "é"])
def test_a_name_that_no_scenario_can_have_is_refused(folder: Path, name: str) -> None:
    done = pursue("new", name, "--yes")
    assert done.status == 2 and "letters, digits and _" in done.err
    assert list(folder.iterdir()) == []


@pytest.mark.parametrize(
    "options",
    [["--robots", "0"], ["--robots", "10"], ["--kind", "dance"], ["--places", "a,a"], ["--places", "3"],
     ["--kind", "catch", "--places", "a"], ["-o", "/tmp/my floor.pur"]],
)  # fmt: skip
def test_options_that_cannot_be_are_refused(folder: Path, options: List[str]) -> None:
    assert pursue("new", "floor", "--yes", *options).status == 2
    assert list(folder.iterdir()) == []


def test_names_that_collide_in_the_network_are_reported(folder: Path) -> None:
    done = pursue("new", "floor", "--yes", "--places", "Pbot1,b")
    assert done.status == 3 and "PML105" in done.err
    assert list(folder.iterdir()) == []


def test_without_a_verdict_in_time_the_scenario_is_written_and_that_is_reported(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("pursue_gen.tools.authoring.first_scenario._WORK", 1)
    done = pursue("new", "floor", "--yes")
    assert (done.status, done.out) == (0, "floor.pur\n")
    assert "limit" in done.err and "whatever the others do" not in done.err


def test_the_command_line_knows_every_kind() -> None:
    assert WORDS["kind"] == tuple(GOALS)
