"""A mission whose strategy has two stages: while the robot loads, it does not matter where the visitor is."""

from __future__ import annotations

import functools
from dataclasses import replace
from fractions import Fraction
from typing import Dict, List, Tuple

from pursue_gen.language import parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import Solution, solve_scenario
from pursue_gen.synthesis.strategy import Block, Command, Constraint, DiscreteState, Strategy

TEXT = """
poi "depot"
poi "hub"
poi "gate"
connect depot and hub distance 2
connect hub and gate distance 2
event "load" location depot duration 2
event "meet" collaborative
rule "order": load before meet
agent "bot" controllable mobile 1 location hub can_do load, meet
agent "visitor" mobile 3 location gate reacts_to meet
reach_objective: do meet after 0
"""
LOADED = "order0"
"""The place of the rule from which on it matters where the visitor is."""


@functools.lru_cache(maxsize=None)
def solved_in_stages() -> Tuple[Scenario, Solution]:
    """The scenario, and its strategy with blocks for the first stage that do not name the visitor: the solver's
    commands of that stage, wherever the visitor is, as soon as their guards allow them, and only then."""
    scenario = parse(TEXT, "two_stages.pur", "two_stages")
    won = solve_scenario(scenario, Rules())
    first: Dict[DiscreteState, List[Block]] = {}
    second = [block for block in won.strategy.blocks if dict(block.state.locations)["order"] == LOADED]
    for block in won.strategy.blocks:
        if block not in second:
            first.setdefault(_without_visitor(block.state), []).append(block)
    blocks = (*(_merged(state, members) for state, members in first.items()), *second)
    return scenario, replace(won, strategy=Strategy(blocks), stats=None)


def _without_visitor(state: DiscreteState) -> DiscreteState:
    locations = tuple((name, place) for name, place in state.locations if name != "visitor")
    return DiscreteState(locations, tuple((name, value) for name, value in state.values if name != "Pvisitor"))


def _merged(state: DiscreteState, blocks: List[Block]) -> Block:
    moves = {command.moves: None for block in blocks for command in block.commands}
    if not moves:
        return Block(state, ((),), ())
    (move,) = moves
    (guard,) = move[0].edge.guard.clocks
    assert guard.op == ">"
    early = Constraint(guard.clock, None, Fraction(guard.bound), False)
    late = Constraint(guard.clock, None, guard.bound + Fraction(1, 20), False)
    due = Constraint(None, guard.clock, Fraction(-guard.bound), True)
    return Block(state, ((early,),), (Command(((due, late),), move),))
