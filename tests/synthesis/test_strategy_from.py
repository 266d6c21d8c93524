"""Strategies by names and time units, from an engine's tables."""

from __future__ import annotations

from fractions import Fraction
from typing import Tuple

from hypothesis import given

from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.synthesis.game import Game
from pursue_gen.synthesis.solve import minimal, to_strategy, zone_text
from pursue_gen.synthesis.strategy import Command, Constraint, DiscreteState, Move
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Kind, Location, Network, Objective
from pursue_gen.zones.dbm import Dbm, raw
from tests.oracle.engine import followed
from tests.oracle.minimal import minimal_in_python
from tests.synthesis.zones import DIM, zones

GO = Edge("a", "b", Guard((ClockBound("x", ">", 1),)))
BACK = Edge("b", "a", resets=("x",))
END = Edge("b", "c", controllable=False)


def _game(reaction: Fraction = Fraction(1, 2)) -> Game:
    places = tuple(Location(name) for name in "abc")
    robot = Automaton("robot", places, "a", (GO, BACK, END))
    network = Network(("x", "y"), (("v", 7),), (), (robot,))
    return compile_game(network, Objective(Kind.REACH, goal=(("robot", "c"),)), reaction)


def _zone(*constraints: Tuple[int, int, int]) -> Dbm:
    zone = Dbm.of(3, constraints)
    assert zone is not None
    return zone


@given(zones)
def test_the_bounds_that_are_kept_make_the_same_zone(zone: Dbm) -> None:
    kept = minimal(DIM, zone.m)
    assert kept == minimal_in_python(DIM, zone.m)
    assert Dbm.of(DIM, kept) == zone
    for left_out in range(len(kept)):
        assert Dbm.of(DIM, kept[:left_out] + kept[left_out + 1 :]) != zone, "and none of them is too many"


def test_bounds_that_are_always_true_are_not_said() -> None:
    game = _game()
    assert zone_text(game, Dbm.universe(3).m) == ()
    assert zone_text(game, Dbm.zero(3).m) == (
        Constraint("x", None, Fraction(0), False),
        Constraint("y", None, Fraction(0), False),
    )


def test_bounds_are_exact_times() -> None:
    zone = _zone((1, 0, raw(3, False)), (0, 2, raw(-5, True)), (2, 1, raw(9, True)))
    assert zone_text(_game(), zone.m) == (
        Constraint(None, "y", Fraction(-5, 2), True),
        Constraint("x", None, Fraction(3, 2), False),
        Constraint("y", "x", Fraction(9, 2), True),
    )


def test_zones_are_gathered_by_what_to_do() -> None:
    game = _game()
    early, late, soon = _zone((1, 0, 5)), _zone((0, 1, -8)), _zone((1, 0, 8), (0, 1, -4))
    pieces = ((early.m, None), (soon.m, (0,)), (late.m, (0,)))
    strategy = to_strategy(game, [((0,), (7,), pieces)])
    assert not strategy.counter
    (block,) = strategy.blocks
    assert block.state == DiscreteState((("robot", "a"),), (("v", 7),))
    assert block.wait == (zone_text(game, early.m),)
    assert block.commands == (Command((zone_text(game, soon.m), zone_text(game, late.m)), (Move("robot", GO),)),)


def test_an_engine_may_hand_over_lists() -> None:
    game = _game()
    assert to_strategy(game, [([0], [7], [(list(Dbm.zero(3).m), [0])])]).blocks[0].commands[0].moves == (  # type: ignore
        Move("robot", GO),
    )


def test_states_that_no_play_comes_to_are_left_out() -> None:
    game = _game()
    everywhere = Dbm.universe(3).m
    at_a, at_b, at_c = (((k,), (7,), ((everywhere, None),)) for k in range(3))
    commanding = ((0,), (7,), ((everywhere, (0,)),))
    assert followed(game, [at_a, at_b, at_c]) == [0], "whoever waits does not come further"
    assert followed(game, [commanding, at_b]) == [0, 1]
    assert 2 in followed(game, [commanding, at_b, at_c]), "by a move of the environment"
