"""How far robots drive in simulated missions."""

from __future__ import annotations

import json
from pathlib import Path

from pursue_gen.language import parse
from pursue_gen.tools.simulation.recorder import Driven
from tests.cli.test_commands import pursue

TRIP = """poi "a"
poi "b"
poi "c"
connect a and b distance 2.5
connect b and c distance 4 one_way
event "work" location c
agent "bot" controllable mobile 2 location a can_do work
agent "idler" controllable mobile 1 location a
agent "guest" mobile 1 location a
reach_objective: do work
"""


def test_the_ways_that_each_robot_takes_are_added_up(tmp_path: Path) -> None:
    file = tmp_path / "trip.pur"
    file.write_text(TRIP)
    out = pursue("sim", file, "--runs", 6).out
    assert "Driven in a mission, on average, in units of distance: bot 6.5, idler 0.0." in out
    driven = json.loads(pursue("sim", file, "--runs", 6, "--faults", "all", "--json").out)["driven"]
    assert 0 < driven["bot"] <= 6.5 and driven["idler"] == 0


def test_what_is_driven_is_told_in_metres_where_distances_are(tmp_path: Path) -> None:
    file = tmp_path / "trip.pur"
    file.write_text("unit second\n" + TRIP.replace("2.5", "2.5 m"))
    assert "Driven in a mission, on average, in metres: bot 6.5" in pursue("sim", file, "--runs", 2).out


def test_nobody_has_driven_at_the_start() -> None:
    assert Driven(parse(TRIP, "trip.pur")).units == {"bot": 0.0, "idler": 0.0}
