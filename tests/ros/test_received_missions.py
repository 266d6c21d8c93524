"""Machines that stay switched on: after one mission they wait for the next, which comes as data into the store, and
everybody plays that one and no other, whoever dies meanwhile.
"""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Dict, List, Mapping, Tuple

import pytest
from launched_mission import GOAL, LaunchedMission, launched, ready
from ros_world import Ros, lay_over

from pursue_gen.language import load
from pursue_gen.solving.solution import Rules, solve_scenario
from pursue_gen.workspace import Options, generate, write_workspace
from pursue_gen.workspace.generate import mission_of
from pursue_runtime.manifest import mission_file, mission_id

pytestmark = pytest.mark.ros

FIRST = """
// bot1 looks at a, then bot2 at b.
poi "home" //[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]
poi "a"    //[1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]
poi "b"    //[0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]
connect home and a distance 1
connect home and b distance 1
event "lookA" location a duration 2
event "lookB" location b duration 2
rule "inTurn": lookA before lookB
agent "bot1" controllable mobile 1 location home can_do lookA
agent "bot2" controllable mobile 1 location home can_do lookB
reach_objective: do lookB
"""

SECOND = """
// Another building: bot2 looks at z, then bot1 at x.
poi "x" //[5.0, 5.0, 0.0, 0.0, 0.0, 0.0, 1.0]
poi "y" //[6.0, 5.0, 0.0, 0.0, 0.0, 0.0, 1.0]
poi "z" //[7.0, 5.0, 0.0, 0.0, 0.0, 0.0, 1.0]
connect x and y distance 1
connect y and z distance 1
event "seeX" location x duration 2
event "seeZ" location z duration 2
rule "inTurn": seeZ before seeX
agent "bot1" controllable mobile 1 location y can_do seeX
agent "bot2" controllable mobile 1 location y can_do seeZ
reach_objective: do seeX
"""


def workspace_of(name: str, text: str, folder: Path) -> Mapping[str, bytes]:
    """The files of a workspace; those of the first are written as well, to folder/ws."""
    path = folder / f"{name}.pur"
    path.write_text(text)
    scenario, rules = load(str(path)), Rules()
    won = solve_scenario(scenario, rules)
    what = scenario, won.network, won.objective, won.strategy, Options(reaction=rules.reaction)
    if name == "first":
        write_workspace(*what, folder / "ws")
    return generate(*what)


class Store:
    """What the reader of this machine would have written."""

    def __init__(self, home: Path) -> None:
        self._folder = home / "pursue" / "missions"
        self._folder.mkdir(parents=True)

    def put(self, name: str, files: Mapping[str, bytes]) -> str:
        """A mission; its digest."""
        manifest, data = mission_of(name, files)
        folder = self._folder / manifest.digest
        for path, content in {**data, "manifest.json": manifest.text()}.items():
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_bytes(content)
        for package in {path.split("/")[0] for path in data}:
            (folder / package / "mission.yaml").write_bytes(mission_file(manifest.digest, name))
        return manifest.digest

    def switch(self, digest: str) -> None:
        """It is current."""
        facts = {"format": 1, "current": digest, "next": None, "prepared": None, "history": []}
        (self._folder / "aside").write_text(json.dumps(facts))
        os.replace(self._folder / "aside", self._folder / "state.json")


class Day:
    """What one machine does from mission to mission."""

    def __init__(self, run: LaunchedMission) -> None:
        self.run = run

    def last(self) -> Tuple[str, str]:
        """Mission and status of the last state."""
        state = self.run.now()
        return str(state.get("mission", "")), state.status

    def until(self, mission: str, status: str) -> None:
        """Waits until such a state is the last one."""
        self.run.until(lambda: self.last() == (mission, status))

    def until_was(self, mission: str, status: str) -> None:
        """Waits until there was such a state: another one may soon follow."""
        wanted = (mission, status)
        self.run.until(lambda: wanted in [(state.get("mission"), state.status) for state in self.run.states()])

    def begin(self, mission: str, scenario: str) -> None:
        """Starts the mission of this scenario once everybody is ready for it."""
        self.until(mission, "waiting")
        self.run.until(lambda: ready(self.run.output(), scenario))
        self.run.publish("_start_")
        self.until_was(mission, "running")

    def events(self, mission: str) -> List[str]:
        """What led to the mission's states, in order."""
        states = [state for state in self.run.states() if state.get("mission") == mission]
        taken = {state.seq: str(state["event"]) for state in states if "event" in state}
        return [taken[seq] for seq in sorted(taken)]

    def goals(self) -> List[Tuple[str, Tuple[float, float]]]:
        """Where robots were sent, in order."""
        return [(entry["robot"], tuple(entry["data"])) for entry in self.run.of(GOAL)]


def test_what_the_desk_sends_is_played_after_the_mission_before_and_by_everybody(ros: Ros, tmp_path: Path) -> None:
    files = workspace_of("first", FIRST, tmp_path)
    first = mission_of("first", files)[0].digest
    workspace = lay_over(ros, tmp_path / "ws")
    store = Store(tmp_path / "run" / "home")
    second = store.put("second", workspace_of("second", SECOND, tmp_path))
    one, two = mission_id(first), mission_id(second)
    lab: Dict[str, object] = {"again": True, "received": True, "use_sim_time": True, "planner": "off"}
    lab.update({"speed": 3, "lost_after": 1000})  # an observer that is started again may take its time
    with launched(ros, workspace, tmp_path / "run", **lab) as run:
        day = Day(run)
        day.begin(one, "first")
        day.until_was(one, "won")
        assert sorted(day.goals()) == [("bot1", (1.0, 0.0)), ("bot2", (0.0, 1.8))]
        day.until(one, "waiting")  # nobody has to start anything

        store.switch(second)
        day.begin(two, "second")
        run.until(lambda: ("bot2", (7.0, 5.8)) in day.goals())
        store.switch("")  # the next one; this one goes on with what it has
        observer, controller = run.kill("observer"), run.kill("controller_bot1")
        run.until_back("observer", observer)
        run.until_back("controller_bot1", controller)
        day.until_was(two, "won")
        assert day.events(two)[-1].startswith("seeX") and "seeZ" in day.events(two)
        assert dict(day.goals()[2:]) == {"bot2": (7.0, 5.8), "bot1": (5.0, 5.0)}
        day.until(one, "waiting")  # by now
        assert run.crashes() == []
