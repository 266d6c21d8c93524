"""What robots can do towards a promise: what charges a battery belongs to it, other actions do not."""

from __future__ import annotations

from pursue_gen.language import parse
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.shares import won_in_shares
from pursue_gen.solving.useful import useful
from pursue_gen.tga import scenario_objective, translate
from pursue_runtime.locations import is_action

WARD = """
poi "dock1"
poi "dock2"
poi "hall"
poi "room1"
poi "room2"
poi "room3"
poi "room4"
connect hall and dock1 distance 4
connect hall and dock2 distance 4
connect hall and room1 distance 4
connect hall and room2 distance 4
connect hall and room3 distance 4
connect hall and room4 distance 4
event "charge1" location dock1 duration 10
event "charge2" location dock2 duration 10
event "wave" location hall duration 5
agent "bot1" controllable mobile 1 location dock1 can_do charge1, wave
agent "bot2" controllable mobile 1 location dock2 can_do charge2, wave
battery "bot1" capacity 100 uses 1 per unit recharges 5 per unit at dock1
battery "bot2" capacity 100 uses 1 per unit recharges 5 per unit at dock2
objective: patrol room1, room2, room3, room4 every 200 by any robot
"""


def test_robots_that_share_a_patrol_charge_their_batteries() -> None:
    scenario = parse(WARD, "ward.pur", "ward")
    network, objective = translate(scenario), scenario_objective(scenario)
    found = won_in_shares(network, objective, DEFAULT.reaction, SolveOptions())
    assert found is not None and found.strategy.in_parts
    begun = {command.moves[0].edge.target for block in found.strategy.blocks for command in block.commands}
    assert sum(map(is_action, begun)) == 2


def test_what_changes_no_battery_and_no_promise_is_of_no_use() -> None:
    scenario = parse(WARD, "ward.pur", "ward")
    network, objective = translate(scenario), scenario_objective(scenario)
    actions = {edge.source for name, edge in useful(network, {"bot1"}, objective.bad) if is_action(edge.source)}
    assert len(actions) == 1 and "charge1" in min(actions)
    full = "\n".join(line for line in WARD.splitlines() if not line.startswith("battery"))
    unlimited = parse(full, "ward.pur", "ward")
    network, objective = translate(unlimited), scenario_objective(unlimited)
    assert not any(is_action(edge.source) for _, edge in useful(network, {"bot1"}, objective.bad))
