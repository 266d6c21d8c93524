"""Which robots are driven along which ways: by the data of a generated workspace and the node's parameters."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Dict, List, Mapping, Optional

import pytest

from pursue_gen.language import parse
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.workspace import Options, write_workspace
from pursue_runtime.controller.whereabouts import Place
from pursue_runtime.data import DataError, read_data
from pursue_runtime.drives.actions import Act
from pursue_runtime.drives.robots import Driven, driven_robots, duration, next_action, who_is_near

TEXT = """\
poi "hall" //[0, 0, 0, 0, 0, 0, 1]
poi "lab" //[5, 0, 0, 0, 0, 0, 1]
poi "exit" //[9, 0, 0, 0, 0, 0, 1]
connect hall and lab distance 5
connect lab and exit distance 4 one_way
event "scan" location lab
event "fetch" location lab duration 2
event "drop" location exit duration 2
event "lift" collaborative together location lab duration 1
rule "parcel": fetch before drop
agent "bot1" controllable mobile 1 location hall can_do scan, drop, lift
agent "bot2" controllable mobile 1 location lab reacts_to lift
agent "arm" controllable location lab can_do fetch
agent "guest" mobile 1 location hall
reach_objective: do scan
"""


@pytest.fixture(scope="module")
def workspace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    scenario = parse(TEXT, "lab.pur", "lab")
    won = solve_scenario(scenario, Rules())
    folder = tmp_path_factory.mktemp("lab") / "ws"
    write_workspace(scenario, won.network, won.objective, won.strategy, Options(), folder)
    return folder


def robots(workspace: Path, without: str = "", **given: Any) -> List[Driven]:
    def read(name: str) -> Mapping[str, Any]:
        return read_data(str(workspace / "src" / "UI" / "config" / name))

    def folder(package: str) -> Optional[str]:
        place = workspace / "src" / package
        return str(place) if place.is_dir() and package != without else None

    return driven_robots(read, given, folder)


def test_each_mobile_robot_drives_all_its_ways_from_where_the_scenario_has_it(workspace: Path) -> None:
    found = {robot.name: robot for robot in robots(workspace)}
    assert set(found) == {"bot1", "bot2"}
    ways = {("hall", "lab"), ("lab", "hall"), ("lab", "exit")}
    assert all(set(robot.plan.ways) == ways for robot in found.values())
    assert (found["bot1"].start, found["bot2"].start) == ("hall", "lab")


def test_each_robot_has_its_own_poses_as_far_as_its_controller_is_here(workspace: Path) -> None:
    first, second = robots(workspace)
    assert first.poses["lab"][:2] == [5.0, 0.0] != second.poses["lab"][:2]
    assert robots(workspace, without="controller_bot2")[1].poses["lab"][:2] == [5.0, 0.0]


def test_parameters_say_which_robots_how_often_and_from_where(workspace: Path) -> None:
    (found,) = robots(workspace, robots="bot2", times=3, start="exit", limit=60, pause=0)
    assert (found.name, found.start) == ("bot2", "exit")
    assert (found.plan.times, found.plan.limit, found.plan.pause) == (3, 60.0, 0.0)


def test_the_ways_that_the_strategy_uses_are_known_as_far_as_controllers_are_here(workspace: Path) -> None:
    first, second = robots(workspace)
    assert (first.plan.first, second.plan.first) == ({("hall", "lab")}, set()), "bot1 scans at the lab"
    assert robots(workspace, without="controller_bot1")[0].plan.first == set()


def test_how_long_all_takes_is_known_before_it_begins(workspace: Path) -> None:
    """Ways of 5, 5 and 4 metres at speed 1: in 5 to 6 and 4 to 5 time units; drop takes 2 to 3."""
    one = robots(workspace, robots="bot1", times=2, actions=1, pause=0.5)
    assert one[0].seconds == (2 * 14 + 2 + 7 * 0.5, 2 * 17 + 3 + 7 * 0.5)
    takes = "6 drives and 1 action take 34 to 40 seconds by the scenario's windows"
    assert duration(one) == f"{takes} (a time unit: a second), if none fails"
    both = duration(robots(workspace, robots="bot1 bot2", times=10))
    assert both.startswith("60 drives take 6 to 7 minutes by")


def test_who_stands_near_a_goal_is_named_with_the_distance() -> None:
    standing = {"bot1": Place("lab", 5.0, 0.9), "bot2": Place("lab", 5.0, 0.25), "bot3": Place("hall", 0.0, 0.0)}
    assert who_is_near(Place("lab", 5.0, 0.0), standing) == "bot2 stands 0.25 m from its goal"
    assert who_is_near(Place("exit", 9.0, 0.0), standing) == ""


def test_robots_do_what_needs_nobody_else_in_the_order_of_the_rules(workspace: Path) -> None:
    bot1, bot2, arm = robots(workspace, actions=2)
    drop, fetch, lift = Act("drop", "exit"), Act("fetch", "lab"), Act("lift", "lab", "bot2", busy=True)
    assert tuple(bot1.acts.measured) == (drop, lift) and tuple(arm.acts.measured) == (fetch,)
    assert not bot2.acts.measured, "the one who does it has it"
    (alone,) = robots(workspace, actions=2, robots="bot1")
    assert tuple(alone.acts.measured) == (drop,), "nobody is there who takes part"
    assert (bot1.plan.acts, bot2.plan.acts, arm.plan.acts) == ((drop,), (), (fetch,))
    assert arm.plan.ways == () and arm.start == "lab" and arm.plan.actions == 2
    assert (bot1.acts.left(), arm.acts.left()) == ([lift], [fetch])
    arm.acts.done(fetch, 2.0)
    assert (bot1.acts.left(), arm.acts.left()) == ([drop, lift], [])
    bot1.acts.done(drop, 2.0)
    assert (bot1.acts.left(), arm.acts.left()) == ([lift], [fetch])


def jobs(found: List[Driven], **standing: str) -> List[str]:
    there = {name: Place(poi, 0.0, 0.0) for name, poi in standing.items()}
    return [f"{job.name} {job.plan.words(job.start)}" for job in next_action(found, there)]


def test_what_is_left_is_done_by_turns_and_all_who_take_part_are_brought_to_its_place(workspace: Path) -> None:
    found = robots(workspace, actions=2)
    bot1, _, arm = found
    lift = next(act for act in bot1.acts.measured if act.partner)
    meeting = ["bot1 goes to lab, for lift", "bot2 goes to lab, for lift", "bot1 does lift at lab with bot2"]
    assert jobs(found) == meeting and jobs(found, bot1="hall", bot2="lab") == [meeting[0], meeting[2]]
    bot1.acts.done(lift, 1.0)
    assert jobs(found, bot1="lab", bot2="lab") == ["arm does fetch at lab"], "which does not drive"
    arm.acts.done(Act("fetch", "lab"), 1.0)
    assert jobs(found, bot1="lab", bot2="lab") == ["bot1 goes to exit, for drop", "bot1 does drop at exit"]
    for _ in range(2):
        bot1.acts.failed(Act("drop", "exit"))
    bot1.acts.done(lift, 1.0)
    assert jobs(found) == [] and not bot1.acts.is_complete
    assert bot1.acts.why_not_all().startswith("drop at exit was given up")


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"robots": "guest"}, "expected some of bot1, bot2, arm"),
        ({"actions": -1}, "~actions is -1; expected a whole number of at least 0"),
        ({"robots": "arm"}, "no robot of this scenario is mobile"),
        ({"times": 0}, "~times is 0; expected a whole number of at least 1"),
        ({"limit": 0}, "~limit is 0; expected a number greater than 0"),
        ({"start": "attic"}, "~start is 'attic'; expected one of hall, lab, exit"),
    ],
)
def test_what_cannot_be_meant_is_refused(workspace: Path, given: Dict[str, Any], message: str) -> None:
    with pytest.raises(DataError, match=message.replace("~", r"\~")):
        robots(workspace, **given)
