"""Networks as integer tables, and joint moves."""

from __future__ import annotations

from fractions import Fraction
from typing import Optional, Tuple

import pytest

from pursue_gen.diagnostics import PursueError
from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.synthesis.game import Game, initial_state, invariant, is_bad, is_goal, joint_moves
from pursue_gen.tga.network import (
    Automaton,
    ClockBound,
    Edge,
    Guard,
    Kind,
    Location,
    Network,
    Objective,
    Sync,
    Test,
)
from pursue_gen.zones.dbm import raw
from tests.oracle.zone_graph import max_constants

REACH = Objective(Kind.REACH, goal=(("S", "b"),))


def _receiver(name: str, *edges: Edge) -> Automaton:
    return Automaton(name, (Location("a"), Location("b"), Location("c")), "a", edges)


def _receive(target: str, controllable: bool = True, needs: Optional[int] = None, sets: Optional[int] = None) -> Edge:
    return Edge(
        "a",
        target,
        Guard((), () if needs is None else ((Test("v", needs),),)),
        Sync("go", False),
        () if sets is None else (("v", sets),),
        controllable=controllable,
    )


def _network(*receivers: Automaton, guard: Tuple[ClockBound, ...] = (), bound: int = 5) -> Network:
    sender = Automaton(
        "S",
        (Location("a", (ClockBound("x", "<=", bound),)), Location("b")),
        "a",
        (Edge("a", "b", Guard(guard), Sync("go", True), (("v", 1),), ("x",)),),
    )
    return Network(("x", "y"), (("v", 0),), ("go",), (sender, *receivers))


def _game(*receivers: Automaton, guard: Tuple[ClockBound, ...] = (), reaction: Fraction = Fraction(0)) -> Game:
    return compile_game(_network(*receivers, guard=guard), REACH, reaction)


def test_the_delay_is_an_integer_and_all_constants_are_scaled_with_it() -> None:
    game = _game(guard=(ClockBound("y", ">", 2), ClockBound("x", "==", 3)), reaction=Fraction(2, 10))
    assert (game.scale, game.delta, game.dim) == (5, 1, 3)
    assert game.edges[0].bounds == ((0, 2, raw(-10, True)), (1, 0, raw(15, False)), (0, 1, raw(-15, False)))
    assert game.edges[0].duration == 15
    assert max_constants(game) == (0, 25, 10)
    assert invariant(game, initial_state(game)) == ((1, 0, raw(25, False)),)


def test_a_sender_takes_along_all_who_can_receive_and_never_blocks() -> None:
    willing, unable = _receiver("R", _receive("b")), _receiver("Q", _receive("b", needs=1))
    (move,) = joint_moves(_game(willing, unable), initial_state(_game(willing, unable)))
    assert move.edges == (0, 1)
    assert move.target.locations == (1, 1, 0), "the second receiver's test reads the value before the sender sets it"
    assert move.resets == (1,)
    alone = _game(unable)
    assert [move.edges for move in joint_moves(alone, initial_state(alone))] == [(0,)]


def test_one_edge_of_each_receiver_and_all_combinations() -> None:
    game = _game(_receiver("R", _receive("b"), _receive("c")), _receiver("Q", _receive("b"), _receive("c")))
    moves = list(joint_moves(game, initial_state(game)))
    assert [move.target.locations[1:] for move in moves] == [(1, 1), (1, 2), (2, 1), (2, 2)]


def test_receivers_assign_after_the_sender_in_system_order() -> None:
    game = _game(_receiver("R", _receive("b", sets=2)), _receiver("Q", _receive("b", sets=3)))
    (move,) = joint_moves(game, initial_state(game))
    assert move.target.values == (3,)


def test_one_uncontrollable_edge_makes_the_move_uncontrollable() -> None:
    game = _game(_receiver("R", _receive("b", controllable=False)))
    (move,) = joint_moves(game, initial_state(game))
    assert not move.controllable
    assert move.owner == 0


def test_goal_and_bad_count_only_where_the_objective_asks_for_them() -> None:
    both = Objective(Kind.REACH, goal=(("S", "b"),), bad=(("S", "a"),))
    reach = compile_game(_network(), both)
    (move,) = joint_moves(reach, initial_state(reach))
    assert is_goal(reach, move.target)
    assert not is_bad(reach, initial_state(reach))
    safe = compile_game(_network(), Objective(Kind.SAFETY, goal=(("S", "b"),), bad=(("S", "a"),)))
    assert is_bad(safe, initial_state(safe))
    assert not is_goal(safe, move.target)


@pytest.mark.parametrize(
    ("network", "objective", "code", "words"),
    [
        (
            _network(
                Automaton(
                    "R", (Location("a"),), "a", (Edge("a", "a", Guard((ClockBound("x", ">", 1),)), Sync("go", False)),)
                )
            ),
            REACH,
            "SYN006",
            "receiving edge has a clock guard (R: a -> a)",
        ),
        (
            _network(Automaton("R", (Location("a", (ClockBound("x", ">=", 1),)),), "a", ())),
            REACH,
            "SYN005",
            "invariant x >= 1 of R.a",
        ),
        (_network(_receiver("R", Edge("a", "nowhere"))), REACH, "SYN004", "location of R 'nowhere'"),
        (_network(), Objective(Kind.REACH, goal=(("S", "z"),)), "SYN004", "location of S 'z'"),
        (_network(), Objective(Kind.REACH, goal=(("T", "b"),)), "SYN004", "automaton 'T'"),
        (_network(), Objective(Kind.REACH), "SYN002", "no location to reach"),
        (_network(), Objective(Kind.SAFETY), "SYN003", "no location to avoid"),
        (_network(guard=(ClockBound("z", ">", 1),)), REACH, "SYN004", "clock 'z'"),
        (_network(guard=(ClockBound("x", "!=", 1),)), REACH, "SYN007", "comparison '!='"),
    ],
)
def test_what_is_not_supported_is_said(network: Network, objective: Objective, code: str, words: str) -> None:
    with pytest.raises(PursueError) as raised:
        compile_game(network, objective)
    assert code in [diagnostic.code for diagnostic in raised.value.diagnostics]
    assert words in str(raised.value)


def test_a_negative_delay_is_refused() -> None:
    with pytest.raises(PursueError, match="reaction delay is -1"):
        _game(reaction=Fraction(-1))
