"""The least worst-case time: known values, brute force on small random games, what is proven and what only found."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Optional, Tuple

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import load
from pursue_gen.proof.checker import verify
from pursue_gen.proof.worst_case import (
    INSTANT,
    LIMIT,
    LONGEST,
    counting_clock,
    with_counter,
    with_deadline,
    worst_case,
)
from pursue_gen.solving.deadlines import fastest_solution
from pursue_gen.solving.least_time import TOLERANCE, fastest, unscaled
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.rules import IDEAL, Rules
from pursue_gen.solving.solution import guaranteed, solution
from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.synthesis.limits import Limits
from pursue_gen.synthesis.relaxed import least_time
from pursue_gen.synthesis.solve import solve
from pursue_gen.synthesis.strategy import Block, Command, Move, Strategy, Zone
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Kind, Location, Network, Objective
from pursue_gen.tga.scale import scaled
from pursue_gen.tga.uppaal import read_network, read_query
from tests.conftest import thesis_scenario
from tests.oracle import ENGINES
from tests.synthesis.random_games import networks
from tests.synthesis.region_game import RegionGame

REPORTED, DEFAULT = Rules(reaction=Fraction(0)), Rules()
PLENTY = SolveOptions(Limits(3600.0))


def _thesis(number: str) -> Tuple[Network, Objective]:
    scenario = load(str(thesis_scenario(number)))
    return translate(scenario), scenario_objective(scenario)


def _published(folder: Path, name: str) -> Tuple[Network, Objective]:
    network = read_network((folder / name / "TGA.xml").read_text(), "TGA.xml")
    return network, read_query((folder / name / "TCTL.q").read_text(), "TCTL.q")


def _is_least(network: Network, objective: Objective, rules: Rules, least: Fraction) -> None:
    """It is found, and the strategy that is made for it wins and keeps it, as the checker sees it."""
    found = fastest_solution(network, objective, rules, PLENTY)
    guarantee = found.guarantee
    assert guarantee is not None and guarantee.worst is not None
    assert guarantee.exact
    assert guarantee.least == least
    assert least <= guarantee.worst <= least + TOLERANCE
    assert verify(found.network, objective, found.strategy, rules.reaction, prompt=True).ok
    fine = 1000
    kept = with_deadline(scaled(with_counter(found.network), fine), objective, int(guarantee.worst * fine) + 1)
    strategy = _finer(found.strategy, found.network, fine)
    report = verify(kept, objective, strategy, rules.reaction * fine, prompt=True)
    assert report.ok, report.reason


def _finer(strategy: Strategy, network: Network, factor: int) -> Strategy:
    """The strategy for `scaled(network, factor)`."""
    pairs = zip(network.automata, scaled(network, factor).automata)
    edges = {own.name: dict(zip(own.edges, fine.edges)) for own, fine in pairs}

    def zones(some: Tuple[Zone, ...]) -> Tuple[Zone, ...]:
        return tuple(tuple(replace(one, bound=one.bound * factor) for one in zone) for zone in some)

    def command(one: Command) -> Command:
        return Command(zones(one.zones), tuple(Move(m.automaton, edges[m.automaton][m.edge]) for m in one.moves))

    blocks = (Block(b.state, zones(b.wait), tuple(map(command, b.commands))) for b in strategy.blocks)
    return Strategy(tuple(blocks))


@pytest.mark.parametrize(
    ("number", "ideal", "reported", "default"),
    [("1", "20", "23", "23.3"), ("2", "20", "23", "23.3"), ("3", "19", "23", "23.4"), ("4", "22", "26", "26.4")],
)
def test_the_thesis_scenarios(number: str, ideal: str, reported: str, default: str) -> None:
    network, objective = _thesis(number)
    for rules, least in ((IDEAL, ideal), (REPORTED, reported), (DEFAULT, default)):
        _is_least(network, objective, rules, Fraction(least))


@pytest.mark.parametrize(("name", "least"), [("CT1", 56), ("CT2a", 70)])
def test_published_scenarios_with_an_opponent(reference_dir: Path, name: str, least: int) -> None:
    _is_least(*_published(reference_dir, name), IDEAL, Fraction(least))


def test_published_scenario_with_reported_ends_and_delay(reference_dir: Path) -> None:
    _is_least(*_published(reference_dir, "CT1"), DEFAULT, Fraction(619, 10))


# Small games by hand.

REACH = Objective(Kind.REACH, goal=(("A", "goal"),))


def _race(*edges: Edge, invariant: Tuple[ClockBound, ...] = ()) -> Network:
    places = (Location("start", invariant), Location("half"), Location("goal"))
    return Network(("x",), (), (), (Automaton("A", places, "start", edges),))


def _edge(source: str, target: str, op: str, bound: int, controllable: bool = True, reset: bool = False) -> Edge:
    guard = Guard((ClockBound("x", op, bound),))
    return Edge(source, target, guard, resets=("x",) if reset else (), controllable=controllable)


def _least(network: Network, reaction: Fraction = Fraction(0)) -> Fraction:
    guarantee, _ = fastest(network, REACH, reaction, None, PLENTY)
    assert guarantee.exact
    return guarantee.least


def test_the_least_time_of_small_games() -> None:
    slow, quick = _edge("start", "goal", ">", 7), _edge("start", "half", ">", 2, reset=True)
    rest = _edge("half", "goal", ">=", 3)
    assert _least(_race(slow)) == 7
    assert _least(_race(slow, quick, rest)) == 5
    assert _least(_race(slow, quick, rest), Fraction(1, 4)) == Fraction(11, 2), "two commands that come late"
    lazy = _edge("start", "goal", ">", 2, controllable=False)
    assert _least(_race(lazy, invariant=(ClockBound("x", "<=", 4),))) == 4, "the environment takes its time"
    assert _least(_race(Edge("start", "goal"))) == 0


def test_the_time_to_several_locations_is_that_to_the_last_of_them() -> None:
    both = Objective(Kind.REACH, goal=(("A", "goal"), ("B", "goal")))
    mine = Automaton("A", (Location("start"), Location("goal")), "start", (_edge("start", "goal", ">", 3),))
    within = (Location("start", (ClockBound("x", "<=", 9),)), Location("goal"))
    theirs = Automaton("B", within, "start", (_edge("start", "goal", ">=", 5, controllable=False),))
    network = Network(("x",), (), (), (mine, theirs))
    guarantee, _ = fastest(network, both, Fraction(0), None, PLENTY)
    assert guarantee.exact and guarantee.least == 9, "nobody is forced to come sooner because somebody waits"
    found = fastest_solution(network, both, IDEAL, PLENTY)
    assert found.guarantee is not None and found.guarantee.worst == 9
    assert verify(found.network, both, found.strategy).ok


def test_a_strategy_may_use_the_whole_tolerance() -> None:
    network = _race(_edge("start", "half", ">", 2, reset=True), _edge("half", "goal", ">=", 3))
    for reaction in (Fraction(0), Fraction(1, 10), Fraction(1, 4)):
        guarantee, faster = fastest(network, REACH, reaction, None, PLENTY)
        assert faster is not None
        assert faster.kept == guarantee.least + TOLERANCE


def test_the_strategy_of_a_network_without_a_counting_clock_brings_one() -> None:
    quick = _edge("start", "half", ">", 2, reset=True)
    network = _race(_edge("start", "goal", ">", 7), quick, _edge("half", "goal", ">", 3))
    assert counting_clock(network) is None
    found = fastest_solution(network, REACH, IDEAL, PLENTY)
    assert found.guarantee is not None and found.guarantee.least == 5
    assert verify(found.network, REACH, found.strategy).ok


def test_a_safety_objective_has_no_time() -> None:
    network = _race(_edge("start", "goal", ">", 7))
    with pytest.raises(PursueError, match="no time to the goal") as problem:
        fastest_solution(network, Objective(Kind.SAFETY, bad=(("A", "half"),)), IDEAL)
    assert problem.value.exit_status == 2


def test_a_lost_game_stays_lost() -> None:
    with pytest.raises(PursueError) as problem:
        fastest_solution(_race(_edge("start", "goal", ">", 7, controllable=False)), REACH, IDEAL)
    assert problem.value.exit_status == 4


def test_what_is_reported_without_time_is_true(reference_dir: Path) -> None:
    network, objective = _published(reference_dir, "CT1")
    won = solution(network, objective, IDEAL)
    first = guaranteed(won)
    assert first.worst is not None and first.most is not None
    assert first.least <= 56 <= first.most <= first.worst
    guarantee, faster = fastest(network, objective, Fraction(0), first.worst, SolveOptions(Limits(work=1)))
    assert faster is None
    assert (guarantee.least, guarantee.most) == (first.least, first.most)
    assert not guarantee.exact and f"nothing below {float(first.least):g} can" in guarantee.in_words()


def test_a_strategy_keeps_its_worst_case_and_nothing_less(reference_dir: Path) -> None:
    network, objective = _published(reference_dir, "CT1")
    won = solution(network, objective, IDEAL)
    worst = worst_case(network, objective, won.strategy)
    assert worst is not None
    for deadline, keeps in ((int(worst) + 1, True), (int(worst) - 1, False)):
        report = verify(with_deadline(network, objective, deadline), objective, won.strategy, prompt=True)
        assert report.ok == keeps
    assert worst_case(network, objective, won.strategy, limit=3) is None


@pytest.mark.parametrize("longest", [7, 998, 1_001, 90_000])
def test_a_long_worst_case_is_found_as_a_short_one_is(longest: int) -> None:
    network = _race(_edge("start", "goal", ">", longest))
    won = solution(network, REACH, IDEAL)
    assert worst_case(network, REACH, won.strategy) == longest + INSTANT


def test_far_more_blocks_than_states_to_spend_are_not_played(monkeypatch: pytest.MonkeyPatch) -> None:
    def played(*_: object) -> None:
        raise AssertionError("each of the blocks takes a state, and there are far more than may be spent")

    network, objective = _thesis("1")
    won = solution(network, objective, DEFAULT)
    large = replace(won.strategy, blocks=(2 * LIMIT // len(won.strategy.blocks) + 1) * won.strategy.blocks)
    monkeypatch.setattr("pursue_gen.proof.worst_case.ClosedLoop", played)
    assert worst_case(won.network, objective, large, won.reaction) is None


def test_what_takes_too_long_to_tell_has_no_worst_case() -> None:
    network = _race(_edge("start", "goal", ">", LONGEST + 1))
    assert worst_case(network, REACH, solution(network, REACH, IDEAL).strategy) is None


# Random small games.

RANDOM = settings(max_examples=25, deadline=None, suppress_health_check=list(HealthCheck))
KINDS = (Kind.REACH, Kind.REACH_WHILE_SAFE)


def _won_by_regions(network: Network, objective: Objective, reaction: Fraction, deadline: Optional[int]) -> bool:
    game = network if deadline is None else with_deadline(with_counter(network), objective, deadline)
    regions = RegionGame(compile_game(game, objective, reaction))
    return regions.won(regions.winning())


@pytest.mark.parametrize("engine", ENGINES)
@RANDOM
@given(networks(KINDS, most_clocks=1), st.sampled_from((0, 0, 1)), st.integers(0, 5))
def test_games_with_a_deadline_agree_with_brute_force(
    engine: str, drawn: Tuple[Network, Objective], delay: int, deadline: int
) -> None:
    (network, objective), reaction = drawn, Fraction(delay)
    limited = with_deadline(with_counter(network), objective, deadline)
    verdict = solve(limited, objective, reaction, ENGINES[engine])
    assert verdict.won == _won_by_regions(network, objective, reaction, deadline)
    if verdict.strategy is not None:
        report = verify(limited, objective, verdict.strategy, reaction)
        assert report.ok, report.reason


@RANDOM
@given(networks(KINDS, most_clocks=1), st.sampled_from((0, 0, 1)))
def test_the_least_time_agrees_with_brute_force(drawn: Tuple[Network, Objective], delay: int) -> None:
    (network, objective), reaction = drawn, Fraction(delay)
    assume(_won_by_regions(network, objective, reaction, None))
    guarantee, _ = fastest(network, objective, reaction, None, PLENTY)
    assert guarantee.exact
    value = int(guarantee.least)
    assume(value <= 6)
    assert _won_by_regions(network, objective, reaction, value + 1)
    assert value == 0 or not _won_by_regions(network, objective, reaction, value - 1)


@RANDOM
@given(networks(KINDS), st.sampled_from((0, 0, 1)))
def test_no_game_is_faster_than_against_a_lazy_environment(drawn: Tuple[Network, Objective], delay: int) -> None:
    (network, objective), reaction = drawn, Fraction(delay)
    game = compile_game(network, objective, reaction)
    least = least_time(game)
    if least is None:
        assert not solve(network, objective, reaction).won
    elif least:
        assert not solve(with_deadline(with_counter(network), objective, least - 1), objective, reaction).won


@RANDOM
@given(networks(KINDS), st.integers(1, 30))
def test_a_finer_unit_changes_no_verdict_and_strategies_return(drawn: Tuple[Network, Objective], factor: int) -> None:
    network, objective = drawn
    verdict = solve(scaled(network, factor), objective)
    assert verdict.won == solve(network, objective).won
    if verdict.strategy is not None:
        assert verify(network, objective, unscaled(verdict.strategy, network, factor)).ok
