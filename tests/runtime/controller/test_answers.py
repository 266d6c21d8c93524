"""What a robot's navigation says when it gives up a goal: what people read, and what follows."""

from __future__ import annotations

import pytest

from pursue_runtime.controller.answers import outcome_name
from pursue_runtime.controller.whereabouts import Place
from tests.runtime.controller.robot_world import (
    ABORTED,
    BLOCKED,
    END,
    FAILED,
    LOST,
    REJECTED,
    STUCK,
    SUCCEEDED,
    WAY,
    B,
    C,
    World,
)

AGAIN, ONCE = 3, 1

MOVE_BASE = [
    ("Failed to find a valid plan. Even after executing recovery behaviors.", BLOCKED, "it finds no way", AGAIN),
    (
        "Failed to find a valid control. Even after executing recovery behaviors.",
        STUCK, "it finds no free motion", AGAIN,
    ),
    ("Robot is oscillating. Even after executing recovery behaviors.", STUCK, "it moves to and fro", AGAIN),
    (
        "Aborting on goal because it was sent with an invalid quaternion",
        BLOCKED, "its navigation refuses the pose of its goal", ONCE,
    ),
    ("Failed to pass global plan to the controller.", STUCK, "it has lost its way", AGAIN),
    ("Aborting on the goal because the node has been killed", FAILED, "its navigation does not work", AGAIN),
    (
        "Reached a case that should not be hit in move_base. This is a bug, please report it.",
        FAILED, "its navigation does not work", AGAIN,
    ),
]  # fmt: skip
"""All texts with which move_base 1.17 aborts a goal."""

MOVE_BASE_FLEX = [
    ("Robot is oscillating for 30.05s!", STUCK, "it moves to and fro", AGAIN),
    ("Oscillation detected!", STUCK, "it moves to and fro", AGAIN),
    ("Global planner returned an empty path!", BLOCKED, "it finds no way", AGAIN),
    ("Global planner exceeded the patience time", BLOCKED, "it finds no way", AGAIN),
    (
        "Robot ignored velocity commands for more than tolerance time!",
        STUCK, "it does not move when it should", AGAIN,
    ),
    ("All recovery behaviors failed.", STUCK, "it finds no free motion", AGAIN),
    ("Could not get the current robot pose!", FAILED, "it does not know where it is", AGAIN),
    ("Could not get the robot pose", FAILED, "it does not know where it is", AGAIN),
    ("Could not transform the plan to the global frame!", FAILED, "it does not know where it is", AGAIN),
    ("Controller started with an invalid plan", FAILED, "its navigation does not work", AGAIN),
    ("Controller has been stopped!", FAILED, "its navigation does not work", AGAIN),
    ("Global planner has been stopped!", FAILED, "its navigation does not work", AGAIN),
    ("Another thread is still planning!", FAILED, "its navigation does not work", AGAIN),
    ("Could not connect to the move_base_flex actions!", FAILED, "its navigation does not work", AGAIN),
    ("No plugins loaded at all!", FAILED, "its navigation does not work", AGAIN),
    ('No plugin loaded with the given name "teb"!', FAILED, "its navigation does not work", AGAIN),
    ('Internal Error: "planner_plugin" pointer should not be a null pointer!', FAILED, "its navigation does not work",
     AGAIN),
]  # fmt: skip
"""The texts of move_base_flex."""

OUTCOMES = {
    (BLOCKED, "it finds no way", AGAIN): ("No path found", "Empty path", "Blocked path", "Out of map"),
    (BLOCKED, "its navigation refuses the pose of its goal", ONCE): ("Invalid goal",),
    (STUCK, "its spot there is occupied", AGAIN): ("Blocked goal", "Blocked Goal", "Goal blocked"),
    (STUCK, "it stands too near to an obstacle", AGAIN): (
        "Blocked start", "Start blocked", "Collision", "Impassable",
    ),
    (STUCK, "it moves to and fro", AGAIN): ("Oscillation",),
    (STUCK, "it does not move when it should", AGAIN): ("Robot stuck",),
    (STUCK, "it finds no free motion", AGAIN): ("No valid command",),
    (STUCK, "it has lost its way", AGAIN): ("Missed Goal", "Missed path", "Invalid path"),
    (FAILED, "it does not know where it is", AGAIN): ("Invalid start", "TF error"),
    (FAILED, "its navigation does not work", AGAIN): (
        "Map error", "Internal error", "Not initialized", "Invalid plugin", "Stopped",
    ),
}  # fmt: skip
"""move_base_flex's names of outcome codes."""

OTHERS = [
    ("", STUCK, "its goal was aborted", AGAIN),
    ("Patience exceeded", STUCK, "its goal was aborted: Patience exceeded", AGAIN),  # of the planner or the controller
    ("No {wheels", STUCK, "its goal was aborted: No {{wheels", AGAIN),
]

NAMED = [(text, *meaning) for meaning, texts in OUTCOMES.items() for text in texts]


@pytest.mark.parametrize(("text", "word", "says", "goals"), [*MOVE_BASE, *MOVE_BASE_FLEX, *NAMED, *OTHERS])
def test_each_text_has_its_reason_and_its_recovery(text: str, word: str, says: str, goals: int) -> None:
    robot = World(goals="action", ends="result")
    robot.go()
    for _ in range(goals):
        assert robot.words == []
        robot.result(ABORTED, text=text)
        robot.wait(1.5 if _ < goals - 1 else 0.0)
    often = f", in {goals} attempts" if goals > 1 else ""
    assert robot.texts == [f"{word}#0 on its way to {{b}}: {says}{often}"]
    assert len(robot.goals) == goals and {goal.movement.place for goal in robot.goals} == {B}
    assert not text or all(text in said for _, said in robot.said)


@pytest.mark.parametrize(
    ("code", "text", "word", "says"),
    [
        (56, "All recovery behaviors failed.", BLOCKED, "it finds no way"),
        (55, "The plugin's own words", STUCK, "its spot there is occupied"),
        (102, "", STUCK, "it finds no free motion"),
        (112, "lookup would require extrapolation", FAILED, "it does not know where it is"),
        (100, "Robot is oscillating for 30.05s!", STUCK, "it moves to and fro"),
        (71, "The plugin's own words", STUCK, "its goal was aborted: The plugin's own words"),
    ],
)
def test_an_outcome_of_move_base_flex_says_more_than_a_text(code: int, text: str, word: str, says: str) -> None:
    robot = World(goals="action", ends="result", retries=0)
    robot.go()
    robot.result(ABORTED, text=text, outcome=outcome_name(code))
    assert robot.texts == [f"{word}#0 on its way to {{b}}: {says}"]


def test_each_outcome_that_has_a_name_has_a_meaning() -> None:
    named = {outcome_name(code) for code in range(256)} - {""}
    assert len(named) == 24
    for name in named:
        robot = World(goals="action", ends="result", retries=0)
        robot.go()
        robot.result(ABORTED, outcome=name)
        assert "its goal was aborted" not in robot.texts[0], name


SPARE = Place("b", 3.0, 5.0, 0.0)


@pytest.mark.parametrize(("text", "word", "says", "goals"), [*MOVE_BASE, *MOVE_BASE_FLEX])
def test_a_robot_with_a_spare_spot_at_the_place_tries_that_last(text: str, word: str, says: str, goals: int) -> None:
    robot = World(goals="action", ends="result")
    robot.go(WAY._replace(spare=SPARE))
    while not robot.words and len(robot.goals) < 9:
        robot.result(ABORTED, text=text)
        robot.wait(1.5)
    places = [goal.movement.place for goal in robot.goals]
    expected = {AGAIN: [B, B, SPARE], ONCE: [B, SPARE]}[goals] if word != FAILED else [B, B, B]
    assert places == expected, "as often as without one, but for a pose that is refused"
    assert robot.words[0] == word


def test_it_arrives_where_it_is_sent_at_last() -> None:
    for ends in ("result", "tf"):
        robot = World(goals="action", ends=ends, retries=1)
        robot.go(WAY._replace(spare=SPARE))
        robot.result(ABORTED, text="Robot is oscillating.")
        assert robot.robot.trouble == "on its way to {b}: it moves to and fro; it tries another spot there"
        robot.wait(1.5)
        assert [goal.movement.place for goal in robot.goals] == [B, SPARE]
        robot.at(SPARE.x, SPARE.y)
        robot.result(SUCCEEDED)
        robot.wait(1.0)
        assert robot.words and set(robot.words) == {END}
        robot.stay(B)
        robot.wait(9.0)
        robot.stay(B, "load")
        robot.order("load", "doing_load_in_b")
        assert robot.actions == ["load"] and set(robot.words) == {END}, "it is at the place"


def test_a_spare_spot_is_not_tried_while_the_mission_holds() -> None:
    robot, way = World(goals="action", ends="result", retries=1), WAY._replace(spare=SPARE)
    robot.go(way)
    robot.state(way, running=False)
    robot.result(ABORTED, text="Robot is oscillating.")
    robot.wait(9.0)
    assert len(robot.goals) == 1
    robot.state(way)
    assert [goal.movement.place for goal in robot.goals] == [B, SPARE]


@pytest.mark.parametrize(("status", "says"), [(REJECTED, "its goal was rejected"), (LOST, "its goal was lost")])
def test_a_goal_that_was_not_taken_says_nothing_of_the_way(status: int, says: str) -> None:
    robot = World(goals="action", ends="result", retries=0)
    robot.go()
    robot.result(status, text="This goal was not taken")
    assert robot.texts == [f"{FAILED}#0 on its way to {{b}}: {says}: This goal was not taken"]


def test_while_it_tries_again_the_trouble_says_so() -> None:
    robot = World(goals="action", ends="result")
    robot.go()
    robot.result(ABORTED, text="Robot is oscillating. Even after executing recovery behaviors.")
    assert robot.robot.trouble == "on its way to {b}: it moves to and fro; it tries again"
    robot.state(lost=True)
    assert robot.words == []


@pytest.mark.parametrize(("text", "says"), [(MOVE_BASE[0][0], MOVE_BASE[0][2]), (MOVE_BASE[2][0], MOVE_BASE[2][2])])
def test_a_robot_that_cannot_return_to_its_place_has_failed(text: str, says: str) -> None:
    """It is at the place in the state, so no way is concerned, and there is none to turn round on."""
    robot = World(goals="action", ends="result", retries=0)
    robot.stay(C, displaced=True, returning=True)
    robot.result(ABORTED, text=text)
    assert robot.texts == [f"{FAILED}#0 on its way back to {{c}}: {says}"]
