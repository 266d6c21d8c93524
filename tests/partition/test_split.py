"""Partitions: every command goes to its own controller, none is lost, none is given twice but by policy."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Iterable, List, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import network_names as names
from pursue_gen.partition import SubStrategy, partition
from pursue_gen.partition.strategy_data import strategy_data
from pursue_gen.synthesis.plan import read_plan
from pursue_gen.synthesis.strategy import Block, Command, DiscreteState, Strategy
from pursue_gen.tga.uppaal import read_network
from tests.partition.games import AGENTS, QUICK, agent, game, joint_moves, random_strategies

SHAPES = ("distributed", "centralized", "general")
POLICIES = ("dedicated", "all", "bot1", "bot2")
OBJECTIVES = ("obj", "reachObj")

Given = Tuple[DiscreteState, Command]


def given_to(subs: Iterable[SubStrategy]) -> "Counter[Given]":
    """How often each command, in its state, is given to somebody."""
    return Counter((state, command) for sub in subs for state, commands in sub.blocks for command in commands)


def all_of(strategy: Strategy, ends: bool) -> "Counter[Given]":
    """How often each command stands in the strategy."""
    return Counter(
        (block.state, command)
        for block in strategy.blocks
        for command in block.commands
        if ends or not command.moves[0].edge.is_end
    )


def every_move() -> Strategy:
    """A strategy that commands each controllable move from the initial state and from the ways."""
    network = game()
    initial = DiscreteState(tuple((a.name, a.initial) for a in network.automata), network.variables)
    blocks: List[Block] = []
    for place in ("a", "going_a_to_b"):
        places = tuple((n, place if n in ("bot1", "nurse") else at) for n, at in initial.locations)
        state = replace(initial, locations=places)
        blocks.append(Block(state, (), tuple(Command(((),), m) for m in joint_moves(network, state, True))))
    return Strategy(tuple(blocks))


def by_name(subs: Iterable[SubStrategy]) -> "dict[str, SubStrategy]":
    """The sub-strategies by the names of their controllers."""
    return {sub.controller: sub for sub in subs}


@QUICK
@given(random_strategies(), st.sampled_from(SHAPES), st.sampled_from(POLICIES))
def test_no_command_is_lost_and_none_given_twice_but_by_policy(strategy: Strategy, shape: str, policy: str) -> None:
    subs = partition(strategy, game(), AGENTS, shape, policy)
    expected = all_of(strategy, ends=shape == "general")
    if shape == "distributed" and policy == "all":
        for (state, command), count in list(expected.items()):
            if command.moves[0].automaton in OBJECTIVES:
                expected[state, command] = 2 * count
    assert given_to(subs) == expected


@QUICK
@given(random_strategies(), st.sampled_from(SHAPES), st.sampled_from(POLICIES))
def test_a_controller_commands_its_agents_only(strategy: Strategy, shape: str, policy: str) -> None:
    subs = partition(strategy, game(), AGENTS, shape, policy)
    for sub in subs:
        assert {c.moves[0].automaton for _, commands in sub.blocks for c in commands} <= set(sub.agents)
        assert all(commands for _, commands in sub.blocks)
    owners = Counter(name for sub in subs for name in sub.agents)
    assert all(owners[name] == 1 for name in ("bot1", "bot2", "nurse"))


@QUICK
@given(random_strategies(), st.sampled_from(SHAPES))
def test_blocks_and_commands_stay_in_order(strategy: Strategy, shape: str) -> None:
    order = [block.state for block in strategy.blocks]
    whole = {block.state: list(block.commands) for block in strategy.blocks}
    for sub in partition(strategy, game(), AGENTS, shape):
        states = [state for state, _ in sub.blocks]
        assert states == [state for state in order if state in states]
        for state, commands in sub.blocks:
            rest = iter(whole[state])
            assert all(command in rest for command in commands)


def test_one_controller_per_robot_and_instructions_for_people() -> None:
    subs = partition(every_move(), game(), AGENTS)
    assert [sub.controller for sub in subs] == ["controller_bot1", "controller_bot2", "controllerObj", "UI"]
    assert [sub.agents for sub in subs] == [("bot1",), ("bot2",), ("reachObj",), ("nurse",)]
    assert [sub.commands for sub in subs] == [2, 2 * 1 + 2 * 1, 2, 2]


def test_policies_for_the_objectives() -> None:
    def with_objective(policy: str) -> List[str]:
        return [
            sub.controller
            for sub in partition(every_move(), game(), AGENTS, reach_obj=policy)
            if "reachObj" in sub.agents
        ]

    assert with_objective("dedicated") == ["controllerObj"]
    assert with_objective("all") == ["controller_bot1", "controller_bot2"]
    assert with_objective("bot2") == ["controller_bot2"]


def test_the_automata_of_several_objectives_belong_together_and_an_agent_of_such_a_name_does_not() -> None:
    """`reachObj2` is an objective's automaton where no agent has that name."""
    network, strategy = game(), every_move()
    second = replace(network.automaton("reachObj"), name="reachObj2")
    network = replace(network, automata=(*network.automata, second))
    subs = by_name(partition(strategy, network, AGENTS))
    assert subs["controllerObj"].agents == subs["controllerObj"].objectives == ("reachObj", "reachObj2")
    everywhere = by_name(partition(strategy, network, AGENTS, reach_obj="bot1"))["controller_bot1"]
    assert (everywhere.agents, everywhere.objectives) == (("bot1", "reachObj", "reachObj2"), ("reachObj", "reachObj2"))
    data = strategy_data(everywhere, Fraction(0))
    assert (data["format"], data["objectives"]) == (2, ["reachObj", "reachObj2"])
    so_called = replace(second, name=names.agent("reachObj2"))
    network = replace(network, automata=(*network.automata[:-1], so_called))
    subs = by_name(partition(strategy, network, (*AGENTS, agent("reachObj2"))))
    assert subs["controllerObj"].agents == ("reachObj",) and subs["controller_reachObj2"].objectives == ()
    assert "objectives" not in strategy_data(subs["controllerObj"], Fraction(0))


def test_one_controller_for_all() -> None:
    central = by_name(partition(every_move(), game(), AGENTS, "centralized"))
    general = by_name(partition(every_move(), game(), AGENTS, "general"))
    assert list(central) == list(general) == ["controller", "UI"]
    assert central["controller"].agents == ("bot1", "bot2", "reachObj")
    assert general["controller"].commands == central["controller"].commands + 1


def test_a_robot_without_commands_has_a_controller() -> None:
    subs = by_name(partition(every_move(), game(), (*AGENTS, agent("bot3"))))
    assert subs["controller_bot3"] == SubStrategy("controller_bot3", ("bot3",), ())


def test_without_people_there_are_no_instructions() -> None:
    strategy = every_move()
    robots = tuple(replace(a, human=False) for a in AGENTS)
    assert "UI" not in by_name(partition(strategy, game(), robots))


def test_without_reach_objective_there_is_no_controller_for_it() -> None:
    network = game()
    safety_only = replace(network, automata=tuple(a for a in network.automata if a.name != "reachObj"))
    assert "controllerObj" not in by_name(partition(Strategy(()), safety_only, AGENTS))
    assert "controllerObj" in by_name(partition(Strategy(()), network, AGENTS))


@pytest.mark.parametrize(
    ("shape", "policy", "message"),
    [("shared", "dedicated", "'shared'"), ("distributed", "bot9", "'bot9'"), ("distributed", "nurse", "'nurse'")],
)
def test_unknown_choices(shape: str, policy: str, message: str) -> None:
    with pytest.raises(PursueError) as caught:
        partition(every_move(), game(), AGENTS, shape, policy)
    assert message in caught.value.diagnostics[0].message
    assert caught.value.exit_status == 2


def test_all_robots_of_none() -> None:
    with pytest.raises(PursueError, match="no controllable robot"):
        partition(Strategy(()), game(), AGENTS[2:], reach_obj="all")


def test_commands_of_somebody_whom_nobody_controls() -> None:
    with pytest.raises(PursueError, match="'bot2' is an agent or rule that nobody controls") as caught:
        partition(every_move(), game(), [a for a in AGENTS if a.name != "bot2"])
    assert "controllable" in caught.value.diagnostics[0].hint
    network = game()
    without = replace(network, automata=tuple(a for a in network.automata if a.name != "bot1"))
    with pytest.raises(PursueError, match="'bot1' is no automaton of the network"):
        partition(every_move(), without, AGENTS[1:])


@QUICK
@given(random_strategies(controllable=False))
def test_counter_strategies_are_refused(strategy: Strategy) -> None:
    with pytest.raises(PursueError, match="counter-strategy"):
        partition(strategy, game(), AGENTS)


@pytest.mark.parametrize(
    ("name", "robots"), [("CT1", ["police"]), ("CT4", ["police"]), ("WC1", ["bot"]), ("EB3", ["ecoBot"])]
)
def test_published_plans(reference_dir: Path, name: str, robots: List[str]) -> None:
    folder = reference_dir / name
    network = read_network((folder / "TGA.xml").read_text(), "TGA.xml")
    strategy = read_plan((folder / "UPPAAL_plan.txt").read_text(), network, "UPPAAL_plan.txt")
    subs = partition(strategy, network, [agent(robot) for robot in robots])
    assert [sub.controller for sub in subs][: len(robots)] == [f"controller_{robot}" for robot in robots]
    assert given_to(subs) == all_of(strategy, ends=False)
    assert 0 < sum(sub.commands for sub in subs) < sum(len(block.commands) for block in strategy.blocks)
