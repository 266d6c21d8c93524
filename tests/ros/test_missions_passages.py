"""Robots that pass each other in a corridor on ROS: whose turn it is outlives the nodes that know it."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Dict, Sequence, Tuple

import pytest
import yaml
from launched_mission import ENDED, PLAYED, State, launched
from ros_world import Ros, lay_over

from benchmarks.ordinary_families import pass_in_a_corridor
from pursue_gen.language import parse
from pursue_gen.language.symbols import UNDER_WAY
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.tga.event_words import event_word
from pursue_gen.tga.network import Network
from pursue_gen.workspace import Options, write_workspace
from pursue_runtime.model import Model
from pursue_runtime.state import SystemState
from pursue_runtime.strategy import read_strategies
from pursue_runtime.ui.waits import Turns
from tests.waiting import PATIENCE

pytestmark = pytest.mark.ros

ROBOTS = ("bot1", "bot2", "bot3", "bot4")


def test_four_robots_change_places_though_observer_and_controllers_are_killed(ros: Ros, tmp_path: Path) -> None:
    read = parse(pass_in_a_corridor(4), "corridor.pur", "corridor")
    won = solve_scenario(read, DEFAULT)
    assert won.strategy.passages
    options = Options(reaction=DEFAULT.reaction)
    folder = write_workspace(read, won.network, won.objective, won.strategy, options, tmp_path / "ws")
    with launched(ros, lay_over(ros, folder), tmp_path, ROBOTS, use_sim_time=True, speed=2, lost_after=1000) as run:
        before = run.until_step("bot1_hall12hall2")
        assert before["places"]["hall2_passage"] == "has_bot1_1"
        run.until_back("observer", run.kill("observer"))
        assert run.now()["places"]["room1_passage"] != "has_bot1_1", "bot1 has left its room, and that is known still"
        run.until_back("controller_bot2", run.kill("controller_bot2"))
        assert run.until_over() == "won", run.output()
        states = run.states()
    apart(states)


def apart(states: Sequence[State]) -> None:
    """No two robots are ever at one place."""
    for state in states:
        rooms = [state["places"][name] for name in ROBOTS if not state["places"][name].startswith("going")]
        rooms = [place.rpartition("_in_")[2] for place in rooms]
        assert len(set(rooms)) == len(rooms), state["places"]


UNIT = 0.25
"""Seconds of a time unit."""

STANDS = 60
"""So many time units bot1 stands on its first way."""


def system_state(state: State) -> SystemState:
    """What a state says, for those who read messages."""
    return SystemState(state.seq, 0.0, state["places"], state["values"], state["clocks"], status=state.status)


def ends_of(network: Network) -> Dict[Tuple[str, str], Tuple[str, float]]:
    """For each robot and what it may be under way to do the word of its end, and after how long that may come."""
    return {
        (name, edge.source): (event_word(name, edge), 0.3 + max(float(bound.bound) for bound in edge.guard.clocks))
        for name in ROBOTS
        for edge in network.automaton(name).edges
        if edge.leaves in UNDER_WAY and edge.is_end
    }


def test_a_robot_that_stands_makes_others_wait_and_nothing_else(ros: Ros, tmp_path: Path) -> None:
    lines = [line for line in pass_in_a_corridor(4).split("\n") if "never_with" not in line]
    text = "\n".join([*lines, "objective: every place holds 1 robot", "objective: every way holds 1 robot"])
    read = parse(text, "corridor.pur", "corridor")
    won = solve_scenario(read, DEFAULT)
    options = Options(reaction=DEFAULT.reaction)
    folder = write_workspace(read, won.network, won.objective, won.strategy, options, tmp_path / "ws")
    ends, since = ends_of(won.network), dict.fromkeys(ROBOTS, ("", 0.0))
    (data,) = folder.glob("src/*/config/strategies.yaml")
    model, strategies = (yaml.safe_load(file.read_text()) for file in (data.with_name("model.yaml"), data))
    turns = Turns(Model(model), {0: read_strategies(strategies)})
    deadline = time.monotonic() + 4 * PATIENCE
    with launched(ros, lay_over(ros, folder), tmp_path, ROBOTS, **PLAYED, time_unit=UNIT, planner="off") as run:
        while (state := run.now()).status not in ENDED:
            assert time.monotonic() < deadline, f"{state}\n{run.steps()}\n{run.output()[-6000:]}"
            for robot, place in state.get("places", {}).items():
                if robot in ROBOTS and since[robot][0] != place:
                    since[robot] = place, time.monotonic()
                word, after = ends.get((robot, place), ("", 0.0))
                after += STANDS if place.startswith("going_room1") and robot == "bot1" else 0
                if word and time.monotonic() > since[robot][1] + after * UNIT:
                    run.publish(f"{robot}:{word}" if word.endswith("DONE") else word)
            time.sleep(0.05)
        assert run.until_over() == "won", run.output()
        states = [state for state in run.states() if "places" in state]
    for state in (state for state in states if state.status == "holding"):
        busy = [robot for robot in ROBOTS if state["places"][robot].startswith(("going", "doing"))]
        assert busy == ["bot1"], "nobody was held up: all others wait for it"
    apart(states)
    stood = [state for state in states if state["places"]["bot1"].startswith("going_room1")]
    waited = {text for state in stood for text in turns.waits(system_state(state)).values()}
    assert "waits for bot1 to pass hall2 first" in waited, waited
