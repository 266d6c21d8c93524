"""A workspace of a task that people do alone: the UI instructs them, and there is no robot."""

from __future__ import annotations

from fractions import Fraction

from pursue_gen.language import parse
from pursue_gen.synthesis.solve import solve
from pursue_gen.tga import ends_reported, scenario_objective, translate
from pursue_gen.workspace import Options, generate

NURSE = """
poi "a"
poi "b"
connect a and b distance 3
event "call"
event "sign" location b
agent "nurse" human controllable mobile 2 location a can_do sign
agent "guest" location b can_do call
objective: if call then sign within 30
"""


def test_it_has_no_controller_of_a_robot() -> None:
    scenario = parse(NURSE, "ward.pur", "ward")
    network, objective = ends_reported(translate(scenario), {}), scenario_objective(scenario)
    delay = Fraction(1, 10)
    strategy = solve(network, objective, delay).strategy
    assert strategy is not None
    files = generate(scenario, network, objective, strategy, Options("distributed", "dedicated", delay, "reported"))
    packages = {path.split("/")[1] for path in files if path.startswith("src/")}
    assert {"UI", "observer", "ward_bringup"} <= packages
    assert not any(name.startswith("controller") for name in packages)
    assert b"nodes:=observer" in files["src/ward_bringup/launch/robot.launch"]
