"""A small game of every kind of automaton, and random strategies for it, for the tests of plans and partitions.

The game: robots bot1 and bot2, a nurse who is an ally, a thief whom nobody controls; a rule, states and both
objectives.
"""

from __future__ import annotations

import functools
from fractions import Fraction
from typing import Dict, List, Tuple

from hypothesis import settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import Span
from pursue_gen.language.scenario import Agent, Ref
from pursue_gen.synthesis.strategy import Block, Command, Constraint, DiscreteState, Move, Strategy, Zone
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Kind, Location, Network, Objective, Sync, Test
from tests.choices import member_of

QUICK = settings(max_examples=50, deadline=None)
"""For tests that draw whole strategies: on a busy machine one draw may take long."""

SPAN = Span("game.pur", 1, 1, 1, 2)
REACH = Objective(Kind.REACH, goal=(("reachObj", "win"),))
SAFETY = Objective(Kind.SAFETY, bad=(("obj", "lose"),))


def agent(name: str, controllable: bool = True, human: bool = False) -> Agent:
    """An agent as the partition sees it."""
    return Agent(name, Ref("a", SPAN), human, controllable, 1, (), (), SPAN)


AGENTS = (agent("bot1"), agent("bot2"), agent("nurse", human=True), agent("thief", controllable=False))


def _walker(name: str, controllable: bool, action: str) -> Automaton:
    """An agent that goes between a and b, and does the action in a, when it is its turn."""
    clock, at = f"C{name}", f"P{name}"

    def after(bound: int, *clauses: Tuple[Test, ...]) -> Guard:
        return Guard((ClockBound(clock, ">", bound),), clauses)

    edges = []
    for x, y, code, there in (("a", "b", -12, 2), ("b", "a", -21, 1)):
        going = f"going_{x}_to_{y}"
        edges.append(Edge(x, going, after(1), Sync(f"{name}_{x}2{y}", True), ((at, code),), (clock,), controllable))
        edges.append(Edge(going, y, after(9), None, ((at, there),), (clock,), controllable))
    turn = (Test("Prule", 0), Test("Prule", 1))
    doing = f"doing_{action}_in_a"
    edges.append(Edge("a", doing, after(1, turn), Sync(action, True), ((at, -11),), (clock,), controllable))
    edges.append(Edge(doing, "a", after(3), Sync(f"{action}DONE", True), ((at, 1),), (clock,), controllable))
    names = ("a", "b", "going_a_to_b", "going_b_to_a", doing)
    locations = tuple(
        Location(n, () if len(n) == 1 else (ClockBound(clock, "<=", 10 if n[0] == "g" else 4),)) for n in names
    )
    return Automaton(name, locations, "a", tuple(edges))


def _receiver(source: str, target: str, channel: str, *assign: Tuple[str, int]) -> Edge:
    return Edge(source, target, sync=Sync(channel, False), assign=assign)


@functools.lru_cache(maxsize=None)
def game() -> Network:
    """The network."""
    rule = Automaton(
        "rule",
        (Location("rule_initial_location", named=False), Location("rule0", named=False)),
        "rule_initial_location",
        (
            _receiver("rule_initial_location", "rule0", "work1DONE", ("Prule", 1)),
            _receiver("rule0", "rule_initial_location", "work2DONE", ("Prule", 0)),
        ),
    )
    states = Automaton(
        "states",
        (Location("base"),),
        "base",
        (_receiver("base", "base", "work1", ("Sopen", 1)), _receiver("base", "base", "work2", ("Sopen", 0))),
    )
    obj = Automaton(
        "obj",
        (Location("idle"), Location("atRisk", (ClockBound("Cobj", "<=", 30),)), Location("lose")),
        "idle",
        (
            Edge("idle", "atRisk", sync=Sync("steal", False), resets=("Cobj",)),
            _receiver("atRisk", "idle", "work2DONE"),
            Edge("atRisk", "lose"),
        ),
    )
    reach = Automaton(
        "reachObj",
        (Location("initial_location"), Location("unlocked", named=False), Location("win")),
        "initial_location",
        (
            Edge("initial_location", "unlocked", Guard((ClockBound("Creach", ">", 0),))),
            _receiver("unlocked", "win", "work2DONE"),
        ),
    )
    walkers = (
        _walker("bot1", True, "work1"),
        _walker("bot2", True, "work2"),
        _walker("nurse", True, "help"),
        _walker("thief", False, "steal"),
    )
    channels = tuple(dict.fromkeys(e.sync.channel for w in walkers for e in w.edges if e.sync))
    return Network(
        clocks=("Cbot1", "Cbot2", "Cnurse", "Cthief", "Cobj", "Creach"),
        variables=(("Prule", 0), ("Pbot1", 1), ("Pbot2", 1), ("Pnurse", 1), ("Pthief", 1), ("Sopen", 0)),
        channels=channels,
        automata=(states, *walkers, obj, reach, rule),
    )


VALUES: Dict[str, Tuple[int, ...]] = {"Prule": (0, 1), "Sopen": (0, 1)}


def _holds(guard: Guard, values: Dict[str, int]) -> bool:
    return all(any(values[t.variable] == t.value for t in clause) for clause in guard.integers)


def joint_moves(network: Network, state: DiscreteState, controllable: bool) -> List[Tuple[Move, ...]]:
    """The joint moves that one side can start in the state, whatever the clocks."""
    at, values = dict(state.locations), dict(state.values)
    moves = []
    for automaton in network.automata:
        for edge in automaton.edges:
            if (
                edge.source != at[automaton.name]
                or edge.controllable is not controllable
                or not _holds(edge.guard, values)
            ):
                continue
            if edge.sync and not edge.sync.sends:
                continue
            joint = [Move(automaton.name, edge)]
            for other in network.automata if edge.sync else ():
                takes = (
                    e
                    for e in other.edges
                    if edge.sync and e.sync == Sync(edge.sync.channel, False) and e.source == at[other.name]
                )
                joint += [Move(other.name, e) for e in takes][:1]
            moves.append(tuple(joint))
    return moves


def bounds() -> st.SearchStrategy[Fraction]:
    """Bounds: whole, decimal, and fractions that no decimal is equal to."""
    return st.builds(Fraction, st.integers(-40, 40), st.sampled_from((1, 1, 1, 2, 3, 10, 32)))


@functools.lru_cache(maxsize=None)
def constraints(clocks: Tuple[str, ...]) -> st.SearchStrategy[Constraint]:
    """Constraints over two different clocks, one of which may be the constant 0."""
    pairs = [(a, b) for a in (*clocks, None) for b in (*clocks, None) if a != b]
    return st.builds(lambda ab, n, s: Constraint(ab[0], ab[1], n, s), st.sampled_from(pairs), bounds(), st.booleans())


@st.composite
def zones(draw: st.DrawFn, clocks: Tuple[str, ...]) -> Zone:
    """Zones, some of them with a value that is fixed (two constraints)."""
    zone: List[Constraint] = []
    for constraint in draw(st.lists(constraints(clocks), max_size=3)):
        zone.append(constraint)
        if draw(st.booleans()):
            zone.append(Constraint(constraint.right, constraint.left, -constraint.bound, constraint.strict))
    return tuple(zone)


@st.composite
def states(draw: st.DrawFn, network: Network) -> DiscreteState:
    """Discrete states, reachable or not."""
    return DiscreteState(
        tuple((a.name, draw(member_of(tuple(loc.name for loc in a.locations)))) for a in network.automata),
        tuple((name, draw(member_of(VALUES.get(name, (1, 2, -12, -11))))) for name, _ in network.variables),
    )


@functools.lru_cache(maxsize=None)
def _federations() -> Tuple[st.SearchStrategy[Tuple[Zone, ...]], st.SearchStrategy[Tuple[Zone, ...]]]:
    """What commands stand in, and when to wait beside them."""
    some = st.lists(zones(game().clocks), min_size=1, max_size=2).map(tuple)
    return some, st.one_of(st.just(()), some)


@functools.lru_cache(maxsize=None)
def _some_states() -> st.SearchStrategy[List[DiscreteState]]:
    return st.lists(states(game()), min_size=1, max_size=3, unique=True)


@st.composite
def random_strategies(draw: st.DrawFn, controllable: bool = True) -> Strategy:
    """Strategies whose blocks all say something; with `controllable` False counter-strategies."""
    federations, or_none = _federations()
    blocks = []
    for state in draw(_some_states()):
        possible = joint_moves(game(), state, controllable)
        chosen = draw(st.lists(member_of(possible), max_size=3)) if possible else []
        commands = tuple(Command(draw(federations), moves) for moves in chosen)
        wait = draw(federations if not commands else or_none)
        blocks.append(Block(state, wait, commands))
    return Strategy(tuple(blocks), counter=not controllable)
