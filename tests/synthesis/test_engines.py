"""What every engine has to do: one class of tests, run on all of them.

Against brute force on regions for small random games; by hand, a game for each rule; published verdicts.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Set, Tuple

import pytest
from hypothesis import HealthCheck, given, settings

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import load
from pursue_gen.proof.checker import verify
from pursue_gen.proof.worst_case import worst_case
from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.synthesis.engine import Engine, Outcome
from pursue_gen.synthesis.game import Game, State, joint_moves
from pursue_gen.synthesis.limits import Limits
from pursue_gen.synthesis.native.engine import NativeEngine
from pursue_gen.synthesis.solve import to_strategy
from pursue_gen.tga import ends_reported, scenario_objective, translate
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Kind, Location, Network, Objective, Sync
from pursue_gen.tga.uppaal import read_network, read_query
from pursue_gen.zones.dbm import Dbm
from pursue_gen.zones.federation import Federation
from tests.conftest import thesis_scenario
from tests.oracle.engine import ReferenceEngine
from tests.synthesis.random_games import games
from tests.synthesis.region_game import Position, RegionGame

EVERY_KIND = (Kind.REACH, Kind.REACH_WHILE_SAFE, Kind.SAFETY)
DEFAULT = Fraction(1, 10)
RANDOM = settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))

ALL: Tuple[Engine, ...] = (
    NativeEngine(), NativeEngine(small_budget=0), ReferenceEngine(), ReferenceEngine(directed=False),
)  # fmt: skip
"""For properties that cost more than a solve: each game that is drawn is for all engines."""
ENGINES = [
    pytest.param(NativeEngine(), id="native"),
    pytest.param(NativeEngine(small_budget=0), id="native, searches with few moves"),
    pytest.param(ReferenceEngine(), id="reference"),
    pytest.param(ReferenceEngine(directed=False), id="reference, all moves at once"),
]

def published(folder: Path, name: str, default: bool) -> Tuple[Network, Objective, Fraction]:
    network = read_network((folder / name / "TGA.xml").read_text(), "TGA.xml")
    objective = read_query((folder / name / "TCTL.q").read_text(), "TCTL.q")
    return (ends_reported(network, {}), objective, DEFAULT) if default else (network, objective, Fraction(0))


def agrees(outcome: Outcome, regions: RegionGame, winning: Set[Position]) -> None:
    """The verdict is that of regions, what is called won is, and commands are usable where they are given."""
    game = regions.game
    assert outcome.won == regions.won(winning)
    for locations, values, pieces in outcome.blocks:
        state = State(locations, values)
        zones = [(Dbm(game.dim, matrix), action) for matrix, action in pieces]
        whole = Federation(tuple(zone for zone, _ in zones))
        moves = {move.edges: move for move in joint_moves(game, state)}
        for position in (p for p in regions.positions if p[0] == state):
            if whole.contains(position[1]):
                assert position in winning, "nothing that is lost is called won"
            for zone, action in zones:
                if action is not None and zone.contains(position[1]):
                    assert regions.usable(position, moves[action], winning)


def is_well_formed(game: Game, outcome: Outcome) -> None:
    """One block per discrete state, disjoint zones, commands that are the controller's moves; ranks for each zone."""
    states = [State(locations, values) for locations, values, _ in outcome.blocks]
    assert len(set(states)) == len(states) <= outcome.stats.discrete_states
    assert outcome.won or not outcome.blocks
    for state, (_, _, pieces) in zip(states, outcome.blocks):
        moves = {move.edges for move in joint_moves(game, state) if move.controllable}
        zones = [Dbm(game.dim, matrix) for matrix, _ in pieces]
        for k, (zone, (_, action)) in enumerate(zip(zones, pieces)):
            assert action is None or action in moves
            assert all(zone.intersect(other) is None for other in zones[:k])
    if outcome.ranks is not None:
        assert [len(ranks) for ranks in outcome.ranks] == [len(pieces) for _, _, pieces in outcome.blocks]


def _network(*automata: Automaton, channels: Tuple[str, ...] = (), clocks: Tuple[str, ...] = ("x",)) -> Network:
    return Network(clocks, (), channels, automata)


PLACES = (Location("start"), Location("goal"), Location("bad"))


def _automaton(name: str, invariant: int, *edges: Edge) -> Automaton:
    places = (
        Location("start", (ClockBound("x", "<=", invariant),) if invariant else ()),
        Location("goal"),
        Location("bad"),
    )
    return Automaton(name, places, "start", edges)


def _edge(target: str, op: str, bound: int, controllable: bool) -> Edge:
    return Edge("start", target, Guard((ClockBound("x", op, bound),)), controllable=controllable)


def _step(source: str, target: str, after: int) -> Edge:
    return Edge(source, target, Guard((ClockBound("x", ">", after),)), resets=("x",))


REACH = Objective(Kind.REACH, goal=(("A", "goal"),))
SAFETY = Objective(Kind.SAFETY, bad=(("A", "bad"),))
BOTH = Objective(Kind.REACH_WHILE_SAFE, goal=(("A", "goal"),), bad=(("A", "bad"),))


def _won(engine: Engine, objective: Objective, *automata: Automaton, reaction: Fraction = Fraction(0)) -> bool:
    return engine.solve(compile_game(_network(*automata), objective, reaction)).won


@RANDOM
@given(game=games(EVERY_KIND, (0, 0, 1)))
def test_engines_agree_with_brute_force_in_the_order_of_time_too(game: Game) -> None:
    regions = RegionGame(game)
    winning = regions.winning()
    for engine in ALL:
        agrees(engine.solve(game), regions, winning)
        soonest = engine.solve(game, soonest=True)
        agrees(soonest, regions, winning)
        is_well_formed(game, soonest)


@pytest.mark.parametrize("engine", ENGINES)
class TestEngine:
    """The contract, see `synthesis.engine`."""

    @RANDOM
    @given(game=games(EVERY_KIND, (0, 1)))
    def test_an_outcome_is_well_formed(self, engine: Engine, game: Game) -> None:
        is_well_formed(game, engine.solve(game))

    def test_in_the_order_of_time_it_takes_the_quick_way(self, engine: Engine) -> None:
        places = ("start", "first", "second", "goal")
        steps = [_step(*ends, after=1) for ends in zip(places, places[1:])]
        robot = Automaton("A", tuple(map(Location, places)), "start", (_step("start", "goal", after=50), *steps))
        game = compile_game(_network(robot), REACH, Fraction(0))
        strategy = to_strategy(game, engine.solve(game, soonest=True).blocks)
        took = worst_case(_network(robot), REACH, strategy)
        assert took is not None and 3 <= took < 4

    @settings(RANDOM, max_examples=30)
    @given(game=games(EVERY_KIND, (0, 1)))
    def test_a_game_is_decided_the_same_twice(self, engine: Engine, game: Game) -> None:
        outcomes = (engine.solve(game) for _ in range(2))
        first, second = (replace(each, stats=replace(each.stats, seconds=0.0)) for each in outcomes)
        assert first == second

    @pytest.mark.parametrize("default", [False, True])
    @pytest.mark.parametrize(
        ("name", "ideal", "robots"),
        [
            ("CT1", True, True),
            ("CT2a", True, True),
            ("WC1", True, True),
            ("WC2a", False, False),
            ("EB1", True, False),
        ],
    )
    def test_verdicts_of_published_scenarios(
        self, engine: Engine, reference_dir: Path, name: str, ideal: bool, robots: bool, default: bool
    ) -> None:
        network, objective, reaction = published(reference_dir, name, default)
        game = compile_game(network, objective, reaction)
        outcome = engine.solve(game)
        assert outcome.won == (robots if default else ideal) == bool(outcome.blocks)
        is_well_formed(game, outcome)
        if outcome.won and reaction == 0:
            report = verify(network, objective, to_strategy(game, outcome.blocks), reaction)
            assert report.ok, report.reason

    def test_the_environment_wins_ties(self, engine: Engine) -> None:
        mine, loss = _edge("goal", ">=", 1, True), _edge("bad", ">=", 1, False)
        assert not _won(engine, REACH, _automaton("A", 0, mine, loss))
        assert _won(engine, REACH, _automaton("A", 0, mine, _edge("bad", ">=", 2, False)))
        assert not _won(engine, REACH, _automaton("A", 0, _edge("goal", ">", 1, True), _edge("bad", ">", 1, False)))

    def test_an_automaton_of_the_environment_at_its_bound_must_move(self, engine: Engine) -> None:
        assert _won(engine, REACH, _automaton("A", 2, _edge("goal", ">", 1, False)))
        assert not _won(engine, REACH, _automaton("A", 0, _edge("goal", ">", 1, False))), "without a bound it need not"
        assert not _won(engine, REACH, _automaton("A", 2, _edge("goal", ">", 1, False), _edge("bad", ">", 1, False)))

    def test_blocked_by_an_automaton_that_the_environment_cannot_move(self, engine: Engine) -> None:
        blocker = Automaton("B", (Location("start", (ClockBound("x", "<=", 1),)),), "start", ())
        lazy = _automaton("A", 0, _edge("goal", ">", 0, False))
        assert not _won(engine, REACH, lazy, blocker), "no automaton of the environment is at its bound"
        assert not _won(engine, SAFETY, _automaton("A", 0), blocker), "a time lock that nobody can leave loses"
        assert not _won(engine, SAFETY, _automaton("A", 2, _edge("bad", ">", 1, True))), "a deadline"
        assert _won(engine, SAFETY, _automaton("A", 2, _edge("bad", ">", 1, True), _edge("goal", ">", 1, True)))
        assert _won(engine, SAFETY, _automaton("A", 0, _edge("bad", ">", 1, True))), "waiting for ever is fine"

    def test_reach_while_safe_counts_only_what_stays_safe(self, engine: Engine) -> None:
        detour = Edge("bad", "goal")
        assert _won(engine, REACH, _automaton("A", 0, _edge("bad", ">", 1, True), detour))
        assert not _won(engine, BOTH, _automaton("A", 0, _edge("bad", ">", 1, True), detour))
        assert _won(engine, BOTH, _automaton("A", 0, _edge("bad", ">", 1, True), detour, _edge("goal", ">", 3, True)))

    def test_a_goal_of_several_locations_is_reached_where_all_hold_at_once(self, engine: Engine) -> None:
        both = Objective(Kind.REACH, goal=(("A", "goal"), ("B", "goal")))
        go, stay = _edge("goal", ">=", 1, True), _edge("bad", ">=", 1, True)
        assert _won(engine, both, _automaton("A", 0, go), _automaton("B", 0, go))
        assert not _won(engine, both, _automaton("A", 0, go), _automaton("B", 0, stay))
        # Each is reached in turn, and never both.
        back = Edge("goal", "start")
        a = Automaton("A", PLACES, "start", (replace(go, sync=Sync("a", True)), replace(back, sync=Sync("b", False))))
        b = Automaton("B", PLACES, "start", (replace(go, sync=Sync("b", True)), replace(back, sync=Sync("a", False))))
        turns = _network(a, b, channels=("a", "b"))
        assert not engine.solve(compile_game(turns, both)).won
        for place in both.goal:
            assert engine.solve(compile_game(turns, replace(both, goal=(place,)))).won

    def test_any_of_several_bad_locations_is_avoided(self, engine: Engine) -> None:
        neither = Objective(Kind.SAFETY, bad=(("A", "bad"), ("B", "bad")))
        away, loss = _edge("goal", ">=", 1, True), _edge("bad", ">=", 2, False)
        assert _won(engine, neither, _automaton("A", 0, away, loss), _automaton("B", 0, away, loss))
        assert not _won(engine, neither, _automaton("A", 0, away, loss), _automaton("B", 0, loss))
        assert not _won(engine, neither, _automaton("A", 0, loss), _automaton("B", 0, away, loss))

    def test_what_is_bad_counts_until_the_last_location_of_the_goal_is_reached(self, engine: Engine) -> None:
        both = Objective(Kind.REACH_WHILE_SAFE, goal=(("A", "goal"), ("B", "goal")), bad=(("C", "bad"),))
        fast, slow = _edge("goal", ">=", 1, True), _edge("goal", ">=", 5, True)
        for late, won in ((6, True), (3, False)):
            danger = _automaton("C", 0, _edge("bad", ">=", late, False))
            assert _won(engine, both, _automaton("A", 0, fast), _automaton("B", 0, slow), danger) is won

    def test_a_late_command_needs_room(self, engine: Engine) -> None:
        window = Edge("start", "goal", Guard((ClockBound("x", ">=", 1), ClockBound("x", "<=", 2))))
        assert _won(engine, REACH, _automaton("A", 0, window), reaction=Fraction(1))
        assert not _won(engine, REACH, _automaton("A", 0, window), reaction=Fraction(11, 10))
        # The environment may come first as long as the command is on its way.
        loss = _edge("bad", ">=", 2, False)
        assert _won(engine, REACH, _automaton("A", 0, window, loss), reaction=Fraction(1, 2))
        assert not _won(engine, REACH, _automaton("A", 0, window, loss), reaction=Fraction(1))

    def test_a_game_that_starts_at_the_goal(self, engine: Engine) -> None:
        here = Objective(Kind.REACH, goal=(("A", "start"),))
        outcome = engine.solve(compile_game(_network(_automaton("A", 0)), here))
        assert outcome.won
        assert not outcome.blocks, "nothing is left to do"

    def test_a_limit_on_states_is_exact(self, engine: Engine) -> None:
        scenario = load(thesis_scenario("1"))
        game = compile_game(translate(scenario), scenario_objective(scenario))
        states = engine.solve(game).stats.discrete_states
        assert engine.solve(game, Limits(states=states)).stats.discrete_states == states
        with pytest.raises(PursueError) as failure:
            engine.solve(game, Limits(states=3))
        assert failure.value.exit_status == 5
        message = failure.value.diagnostics[0].message
        assert "within the limit of 3 discrete states; 3 discrete states were reached" in message
