"""Strategies in fewer zones: the same plays, proven; and how small a strategy can be at all."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Iterator, List, Tuple, Union

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.language import load
from pursue_gen.proof import simplify
from pursue_gen.proof.checker import ProofReport, pruned, pruned_ranks, verify
from pursue_gen.proof.margin import strategy_margin
from pursue_gen.solving.rules import IDEAL, Rules, played
from pursue_gen.solving.solution import solution
from pursue_gen.synthesis.solve import solve
from pursue_gen.synthesis.strategy import Block, Command, Constraint, Strategy, Zone
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Edge, Guard, Network, Objective, Test
from tests.conftest import thesis_scenario
from tests.proof.test_checker import automaton, block, edge, moves, network
from tests.proof.test_checker_random import OBJECTIVES, networks
from tests.synthesis.play_by_play import broken, inside
from tests.synthesis.test_verdicts import published

NOW, HALF = Fraction(0), Fraction(1, 2)


def zones(strategy: Strategy) -> Iterator[Zone]:
    for one in strategy.blocks:
        yield from one.wait
        for command in one.commands:
            yield from command.zones


def size(strategy: Strategy) -> Tuple[int, int]:
    """Zones, and their bounds."""
    return len(list(zones(strategy))), sum(map(len, zones(strategy)))


def advice(one: Block, point: Tuple[Fraction, ...]) -> Tuple[object, ...]:
    """What the block says at a point."""
    clocks = dict(zip(("x", "y"), point))
    waits = any(inside(zone, clocks) for zone in one.wait)
    return (waits, *(c.moves for c in one.commands if any(inside(zone, clocks) for zone in c.zones)))


BOT = automaton("bot", "a win", edge("a", "win", "x>1"))
NET = network(BOT)
GO = moves(NET, ("bot", 0))


def small(*blocks: Block) -> Strategy:
    return simplify.simplified(NET, Strategy(blocks), NOW)


def test_waiting_is_said_in_one_zone_where_no_command_lies_between() -> None:
    split = block(NET, "a", ["x<1,y<1", "x<1,y>=1", "x>=1,x<=3"], ("x>3", GO))
    assert small(split) == Strategy((block(NET, "a", ["x<=3"], ("x>3", GO)),))
    apart = block(NET, "a", ["x<=1", "x>2,x<=3"], ("x>1,x<=2|x>3", GO))
    assert len(small(apart).blocks[0].wait) == 2


def test_where_nothing_is_commanded_waiting_needs_no_bound() -> None:
    assert small(block(NET, "a", ["x<=1,y<=4", "x>1,y<=4"])) == Strategy((block(NET, "a", [""]),))


def test_a_command_keeps_the_end_of_its_window_and_loses_what_tells_nothing_apart() -> None:
    one = block(NET, "a", ["x<=1"], ("x>1,x<=3,y>1", GO))
    assert small(one) == Strategy((block(NET, "a", ["x<=1"], ("x>1,x<=3", GO)),))


def test_zones_of_a_command_that_time_leads_from_one_to_the_other_become_one_only_if_the_rank_allows_it() -> None:
    two = Strategy((block(NET, "a", ["x<=1"], ("x>1,x<=2|x>2", GO)),))
    assert len(simplify.simplified(NET, two, NOW).blocks[0].commands[0].zones) == 2
    for early, late, count in ((1, 2, 2), (2, 1, 1), (1, 1, 1)):
        ranks = {(0, "wait", 0): 3, (0, 0, 0): early, (0, 0, 1): late}
        assert len(simplify.simplified(NET, two, NOW, ranks).blocks[0].commands[0].zones) == count


@given(networks(), OBJECTIVES, st.sampled_from((NOW, HALF)), st.booleans())
def test_in_fewer_zones_it_still_wins(net: Network, objective: Objective, reaction: Fraction, ranked: bool) -> None:
    verdict = solve(net, objective, reaction)
    if verdict.strategy is None:
        return
    report = verify(net, objective, verdict.strategy, reaction, prompt=False)
    kept = pruned(verdict.strategy, report)
    ranks = pruned_ranks(verdict.strategy, report, verdict.ranks) if ranked and verdict.ranks else None
    few = simplify.simplified(net, kept, reaction, ranks)
    assert verify(net, objective, few, reaction, prompt=False).ok
    assert broken(net, objective, few, reaction) is None
    assert all(one <= other for one, other in zip(size(few), size(kept)))


@given(
    networks(),
    OBJECTIVES,
    st.lists(st.tuples(st.integers(0, 20), st.integers(0, 20)), min_size=1, max_size=8),
)
def test_no_zone_shrinks_and_no_point_gets_a_second_action(
    net: Network, objective: Objective, points: object
) -> None:
    strategy = solve(net, objective, NOW).strategy
    if strategy is None:
        return
    for before, after in zip(strategy.blocks, simplify.simplified(net, strategy, NOW).blocks):
        at = before.state.locations
        places = [place for a in net.automata for place in a.locations if (a.name, place.name) in at]
        invariant = [bound for place in places for bound in place.invariant]
        for x, y in points:
            point = (Fraction(x, 4), Fraction(y, 4))
            if all(dict(zip(("x", "y"), point))[b.clock] <= b.bound for b in invariant) and any(advice(before, point)):
                assert set(advice(after, point)) == set(advice(before, point))


def test_ranks_stand_where_their_zones_stand_once_others_are_pruned() -> None:
    early, late = (Constraint("x", None, Fraction(3), False),), (Constraint(None, "x", Fraction(-3), True),)
    state = block(NET, "a").state
    whole = Block(state, (early, late), (Command((early, late), GO), Command((late,), GO)))
    strategy = Strategy((whole,) * 4)
    used = {(0, "wait", 1), (1, "wait", 1), (1, 1, 0), (3, 0, 1)}  # of the third block nothing is left
    report = ProofReport(True, "", (), frozenset(used), 1)
    where: List[Tuple[Union[str, int], int]] = [("wait", 0), ("wait", 1), (0, 0), (0, 1), (1, 0)]
    ranks = {(b, part, n): 100 * b + 10 * where.index((part, n)) for b in range(4) for part, n in where}
    kept, left = pruned(strategy, report), pruned_ranks(strategy, report, ranks)
    go = (Command((late,), GO),)
    assert kept.blocks == (Block(state, (late,), ()), Block(state, (late,), go), Block(state, (), go))
    assert left == {
        (0, "wait", 0): ranks[0, "wait", 1],
        (1, "wait", 0): ranks[1, "wait", 1],
        (1, 0, 0): ranks[1, 1, 0],
        (2, 0, 0): ranks[3, 0, 1],
    }


@given(networks(), OBJECTIVES)
def test_ranks_follow_their_zones_when_others_go(net: Network, objective: Objective) -> None:
    verdict = solve(net, objective, NOW)
    if verdict.strategy is None or not verdict.ranks:
        return
    report = verify(net, objective, verdict.strategy, NOW, prompt=False)
    kept, left = pruned(verdict.strategy, report), pruned_ranks(verdict.strategy, report, verdict.ranks)
    assert sorted(left.values()) == sorted(verdict.ranks.get(key, 0) for key in report.used)
    assert verify(net, objective, kept, NOW, prompt=False, ranks=left).ok


@pytest.mark.parametrize("rules", [IDEAL, Rules()], ids=["ideal", "default"])
@pytest.mark.parametrize("number", ["1", "2", "3", "4", "catch_the_thief"])
def test_the_thesis_s_strategies_get_fewer_zones_and_stand_no_less_delay(number: str, rules: Rules) -> None:
    scenario = load(thesis_scenario(number))
    network, objective = played(translate(scenario), rules), scenario_objective(scenario)
    verdict = solve(network, objective, rules.reaction)
    assert verdict.strategy is not None
    report = verify(network, objective, verdict.strategy, rules.reaction, ranks=verdict.ranks)
    kept = pruned(verdict.strategy, report)
    ranks = pruned_ranks(verdict.strategy, report, verdict.ranks or {})
    few = simplify.simplified(network, kept, rules.reaction, ranks)
    assert size(few)[0] <= size(kept)[0] and size(few)[1] * 2 < size(kept)[1]
    margins = [strategy_margin(network, objective, one, rules.reaction) for one in (kept, few)]
    assert margins[0].wins <= margins[1].wins


TIGA = {"CT1": (164, 194), "CT2a": (588, 751), "EB1": (77, 82), "EB3": (332, 348)}
"""Blocks and commands of UPPAAL-TIGA's plans, as published."""


@pytest.mark.parametrize("name", TIGA)
def test_ideal_strategies_are_at_most_half_of_tiga_s(reference_dir, name: str) -> None:
    network, objective = published(reference_dir, name)
    strategy = solution(network, objective, IDEAL).strategy
    blocks, commands = TIGA[name]
    assert 2 * len(strategy.blocks) <= blocks
    assert 2 * sum(len(one.commands) for one in strategy.blocks) <= commands


def without(net: Network, name: str, source: str, target: str) -> Network:
    """The network without an edge."""
    return replace(
        net,
        automata=tuple(
            replace(a, edges=tuple(e for e in a.edges if (a.name, e.source, e.target) != (name, source, target)))
            for a in net.automata
        ),
    )


def losing_at(net: Network, place: Tuple[str, str], phase: int) -> Network:
    """The network in which the objective is lost where the human is at the place in a phase of the work."""
    human = next(value for e in net.automaton("human").edges if e.target == place[1] for _, value in e.assign)
    guard = Guard((), ((Test("Phuman", human),), (Test("PworkFlow", phase),)))
    fatal = Edge("atRisk", "lose", guard, controllable=False)
    return replace(
        net,
        automata=tuple(replace(a, edges=(*a.edges, fatal)) if a.name == "obj" else a for a in net.automata),
    )


WORK = ("pickUpBox", "screw", "putDownBox")


@pytest.mark.parametrize("event", WORK)
def test_each_of_the_six_commands_for_the_box_is_needed(reference_dir, event: str) -> None:
    """TIGA's plan for WC1 has 6 commands in 10 blocks, and no strategy has fewer.

    A person who only brings boxes leaves all three actions to the robot: each has to be begun and ended by it. Every
    one of these edges can be taken in one discrete state only; without it the game is lost.
    """
    network, objective = published(reference_dir, "WC1")
    doing = f"doing_{event}_in_station"
    assert solve(network, objective).won
    assert not solve(without(network, "bot", "station", doing), objective).won
    assert not solve(without(network, "bot", doing, "station"), objective).won


@pytest.mark.parametrize(("event", "phase"), [(event, 2 * k + 2) for k, event in enumerate(WORK)])
def test_the_person_can_always_be_the_first_to_do_any_of_the_work(reference_dir, event: str, phase: int) -> None:
    """So the three states in which the person works belong to every strategy, beside the seven without that."""
    network, objective = published(reference_dir, "WC1")
    assert not solve(losing_at(network, ("human", f"doing_{event}_in_station"), phase), objective).won


def test_the_strategy_for_the_box_has_the_least_size(reference_dir) -> None:
    network, objective = published(reference_dir, "WC1")
    strategy = solution(network, objective, IDEAL).strategy
    assert (len(strategy.blocks), sum(len(one.commands) for one in strategy.blocks)) == (10, 6)


def test_of_two_zones_that_say_the_same_one_stays() -> None:
    twice = block(NET, "a", [""], ("x>1|x>1", GO))  # contradictory, so the two do not become one
    (command,) = small(twice).blocks[0].commands
    assert len(command.zones) == 1
