"""Strategies in stages: what the checker proves of them, held against the game as a whole."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import product
from typing import Dict, List, Optional, Tuple

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmarks.families import deliver_by_robots, hand_to_visitors
from pursue_gen.diagnostics import PursueError
from pursue_gen.language import parse
from pursue_gen.proof.checker import ProofReport, pruned, verify
from pursue_gen.proof.moves import Arena, JointMove, State
from pursue_gen.proof.worst_case import worst_case
from pursue_gen.solving.decomposition import won_by_some
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.rules import Rules, played
from pursue_gen.synthesis.strategy import Block, Command, DiscreteState, Place, Strategy
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Network, Objective
from tests.choices import member_of
from tests.oracle.checker import natively

DELAY = Fraction(1, 10)

Game = Tuple[Network, Objective]


def game_of(text: str) -> Game:
    """The default game of a scenario, but for the reaction delay."""
    scenario = parse(text, "crowd.pur", "crowd")
    return played(translate(scenario), Rules()), scenario_objective(scenario)


def in_stages(text: str, reaction: Fraction = DELAY) -> Tuple[Network, Objective, Strategy]:
    """The game, and a strategy in stages that is proven for it."""
    network, objective = game_of(text)
    found = won_by_some(network, objective, reaction, SolveOptions())
    assert found is not None and len(found.strategy.stages) > 1
    return network, objective, found.strategy


def wins_as_a_whole(network: Network, objective: Objective, strategy: Strategy) -> ProofReport:
    """The report on the same strategy without stages, by the native checker: it is the judge here, and not what is
    tested."""
    with natively():
        return verify(network, objective, of_the_whole(network, strategy))


def of_the_whole(network: Network, strategy: Strategy) -> Strategy:
    """The same strategy in blocks that name everything, as far as its plays may lead: it waits where all parts do."""
    arena = Arena(network, 1)
    met: Dict[State, Optional[Block]] = {}
    pending = [arena.initial]
    while pending:
        state = pending.pop()
        if state in met:
            continue
        whole = DiscreteState(
            tuple(zip((automaton.name for automaton in network.automata), state[0])),
            tuple(zip((name for name, _ in network.variables), state[1])),
        )
        found = [block for block in strategy.blocks if applies(block, whole)]
        moves = arena.situation(state).moves
        pending += [move.target for move in moves if not move.controllable]
        met[state] = None
        commands = []
        for block in found:
            for command in block.commands:
                made = [move for move in moves if is_meant(move, command)]
                pending += [move.target for move in made]
                commands += [Command(command.zones, move.moves) for move in made]
        if found:
            waits = tuple(tuple(c for zone in zones for c in zone) for zones in product(*(b.wait for b in found)))
            met[state] = Block(whole, waits, tuple(commands))
    return Strategy(tuple(block for block in met.values() if block is not None))


def applies(block: Block, state: DiscreteState) -> bool:
    """True if all that the block names is so in the state."""
    return set(block.state.locations) <= set(state.locations) and set(block.state.values) <= set(state.values)


def is_meant(move: JointMove, command: Command) -> bool:
    """True if the move is what the command says; others may take part in it of whom its part does not know that."""
    return move.controllable and set(command.moves) <= set(move.moves)


VISITS = hand_to_visitors(2)

GUARDED = """
poi "hall"
poi "vault"
poi "shop"
connect hall and vault distance 6
connect hall and shop distance 3
event "touch" location vault
event "lock" location vault duration 1
event "open" location shop duration 2
event "sweep" location hall
event "report"
rule "ready": open before report
rule "clean": sweep before report
state "locked": initially false, true_if lock
stateDependency: touch only_if locked is_false
agent "clerk" controllable mobile 1 location shop can_do open, report
agent "cleaner" controllable mobile 1 location hall can_do sweep
agent "watchman" controllable mobile 1 location hall can_do lock
agent "guest" mobile 3 location hall can_do touch
objective: avoid touch
reach_objective: do report
"""
"""As soon as the vault is locked, the guest cannot touch what is in it any more."""


@pytest.mark.parametrize("text", [VISITS, GUARDED, deliver_by_robots(2), deliver_by_robots(3)])
def test_what_is_proven_stage_by_stage_wins_the_game_as_a_whole(text: str) -> None:
    network, objective, strategy = in_stages(text, Fraction(0))
    assert verify(network, objective, strategy).ok
    report = wins_as_a_whole(network, objective, strategy)
    assert report.ok, (report.reason, report.play)


@settings(max_examples=10, deadline=None)
@given(data=st.data())
def test_a_damaged_strategy_that_passes_still_wins_the_game_as_a_whole(data: st.DataObject) -> None:
    network, objective, strategy = _visits()
    number = data.draw(st.integers(0, len(strategy.blocks) - 1))
    block = strategy.blocks[number]
    damages = [replace(block, wait=()), replace(block, commands=block.commands[1:]), replace(block, wait=((),))]
    other = data.draw(member_of(strategy.blocks))
    damages += [replace(block, wait=other.wait), replace(other, state=block.state), replace(block, state=other.state)]
    blocks = list(strategy.blocks)
    blocks[number] = data.draw(member_of(damages))
    if data.draw(st.booleans()):
        del blocks[data.draw(st.integers(0, len(blocks) - 1))]
    damaged = replace(strategy, blocks=tuple(blocks))
    if len({block.state for block in blocks}) == len(blocks) and is_proven(network, objective, damaged):
        assert wins_as_a_whole(network, objective, damaged).ok


def is_proven(network: Network, objective: Objective, strategy: Strategy) -> bool:
    """True if the checker takes it; one that speaks of clocks of somebody whom its stage does not name is refused."""
    try:
        return verify(network, objective, strategy).ok
    except PursueError:
        return False


_KEPT: List[Tuple[Network, Objective, Strategy]] = []


def _visits() -> Tuple[Network, Objective, Strategy]:
    if not _KEPT:
        _KEPT.append(in_stages(VISITS, Fraction(0)))
    return _KEPT[0]


def test_robots_that_need_nothing_of_each_other_work_at_the_same_time() -> None:
    network, objective, strategy = in_stages(deliver_by_robots(4))
    assert [len(milestones) for milestones in strategy.stages] == [4, 1]
    took = worst_case(network, objective, strategy, DELAY)
    assert took is not None and took < 25


def fault_of(network: Network, objective: Objective, strategy: Strategy) -> str:
    """Why the checker refuses it."""
    report = verify(network, objective, strategy, DELAY)
    assert not report.ok
    return report.reason


def test_the_order_of_the_stages_is_the_one_that_is_proven() -> None:
    network, objective, strategy = in_stages(VISITS)
    first, second, last = strategy.stages
    assert "leads to no milestone" in fault_of(network, objective, replace(strategy, stages=(second, first, last)))
    assert "does not end at the goal" in fault_of(network, objective, replace(strategy, stages=(first, second)))
    assert "leads to no milestone" in fault_of(network, objective, replace(strategy, stages=(first, last)))
    twice = (first, second, first, last)
    assert "two milestones" in fault_of(network, objective, replace(strategy, stages=twice))
    nowhere = (first, (("rule2", "limbo"),), last)
    assert "there is no rule2.limbo" in fault_of(network, objective, replace(strategy, stages=nowhere))


def test_what_cannot_happen_any_more_needs_no_guard() -> None:
    network, objective, strategy = in_stages(GUARDED)
    assert strategy.stages == ((("Slocked", "1"),), (("ready", "ready0"), ("clean", "clean0")), (("reachObj", "win"),))
    later = strategy.numbers_of(1, ("ready", "ready0"))
    assert {name for name, _ in strategy.blocks[later[0]].state.locations} == {"clerk", "ready"}
    unlocked = replace(strategy, stages=strategy.stages[1:])
    assert "leads to no milestone" in fault_of(network, objective, unlocked)
    blocks = tuple(block for n, block in enumerate(strategy.blocks) if strategy.parts[n] != (0, ("Slocked", "1")))
    never = replace(strategy, blocks=tuple(without(block, "Slocked") for block in blocks), stages=strategy.stages[1:])
    assert "nobody guards" in fault_of(network, objective, never) or "may matter" in fault_of(network, objective, never)


@pytest.mark.parametrize("milestone, why", [
    (("Slocked", "2"), "there is no Slocked.2"), (("Slocked", "0"), "no milestone"), (("Sopen", "1"), "no milestone")
])  # fmt: skip
def test_a_milestone_is_a_value_that_is_given(milestone: Place, why: str) -> None:
    network, objective, strategy = in_stages(GUARDED)
    assert why in fault_of(network, objective, replace(strategy, stages=((milestone,), *strategy.stages[1:])))


def test_a_later_stage_begins_with_the_value_that_a_milestone_gave() -> None:
    """Its blocks name the variable, but not who sets it."""
    network, objective, strategy = in_stages(GUARDED)
    back = []
    for block in strategy.blocks:
        values = tuple((name, 0 if name == "Slocked" else value) for name, value in block.state.values)
        back.append(replace(block, state=replace(block.state, values=values)))
    assert fault_of(network, objective, replace(strategy, blocks=tuple(back))) != ""


def without(block: Block, name: str) -> Block:
    """The block without what it says of an automaton and its variable."""
    state = DiscreteState(
        tuple(pair for pair in block.state.locations if pair[0] != name),
        tuple(pair for pair in block.state.values if pair[0] not in (name, f"P{name}")),
    )
    return replace(block, state=state)


def changed(strategy: Strategy, stage: int, name: str) -> Strategy:
    """The strategy whose blocks of a stage do not name an automaton."""
    numbers = strategy.numbers_of(stage, strategy.stages[stage][0])
    blocks = (without(block, name) if n in numbers else block for n, block in enumerate(strategy.blocks))
    return replace(strategy, blocks=tuple(blocks))


def test_a_stage_names_the_milestones_before_it() -> None:
    network, objective, strategy = in_stages(VISITS)
    assert "leads to no milestone" in fault_of(network, objective, changed(strategy, 1, "rule1"))
    assert "leads to no milestone" in fault_of(network, objective, changed(strategy, 1, "rule2"))


def test_whoever_matters_in_a_stage_is_named_there() -> None:
    network, objective, strategy = in_stages(VISITS)
    assert fault_of(network, objective, changed(strategy, 0, "visitor1")) != ""
    assert fault_of(network, objective, changed(strategy, 0, "bot")) != ""


def test_all_blocks_of_a_stage_name_the_same() -> None:
    network, objective, strategy = in_stages(VISITS)
    first = strategy.numbers_of(0, strategy.stages[0][0])[0]
    blocks = list(strategy.blocks)
    blocks[first] = without(blocks[first], "visitor1")
    assert "do not all name the same" in fault_of(network, objective, replace(strategy, blocks=tuple(blocks)))


def test_nobody_matters_to_two_parts_of_one_stage() -> None:
    network, objective, strategy = in_stages(VISITS)
    places = strategy.stages
    merged = replace(strategy, stages=((*places[0], *places[1]), places[2]))
    assert fault_of(network, objective, merged).endswith(": bot matters to two parts of a stage")


def test_a_strategy_in_stages_is_pruned_to_what_plays_reach() -> None:
    network, objective, strategy = in_stages(VISITS)
    spare = replace(strategy.blocks[0], state=replace(strategy.blocks[0].state, values=strategy.blocks[1].state.values))
    bigger = replace(strategy, blocks=(*strategy.blocks, spare))
    report = verify(network, objective, bigger, DELAY)
    assert report.ok
    kept = pruned(bigger, report)
    assert kept.stages == strategy.stages and set(kept.blocks) <= set(strategy.blocks)
    assert verify(network, objective, kept, DELAY).ok
