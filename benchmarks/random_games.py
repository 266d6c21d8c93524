"""Random small games: the whole of solving beside a plain exhaustive solver, which looks at all moves at once.

`python -m benchmarks.random_games 40` measures so many games of each kind, and prints a line of JSON for each kind of
objective and game. The same number gives the same games.

The plain solver is the reference engine with all moves at once (`ReferenceEngine(directed=False)`): fixpoints over the
zones of all discrete states, without a search order, and without a proof. Where a game is small enough brute force on
regions, from the tests, gives a third verdict.
"""

from __future__ import annotations

import json
import random
import statistics
import sys
import time
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Iterator, List, Optional, Tuple

from benchmarks.measure import GAMES, Row
from benchmarks.random_page import LIMIT, MOST, PLUS, TIMES
from pursue_gen.diagnostics import PursueError
from pursue_gen.outcomes import Lost
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solvers import solved
from pursue_gen.solving.verdict import margins
from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.synthesis.limits import Limits
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
from tests.oracle.engine import ReferenceEngine

LEAST = 20
"""The games have at least so many discrete states."""

_ON_REGIONS = 30
"""Brute force on regions takes games of so many discrete states, and two clocks."""

_CHANNELS = ("a", "b")


# Games ----------------------------------------------------------------------------------------------------------------


def random_game(number: int, kind: Kind) -> Tuple[Network, Objective]:
    """A network of two to five automata with one to three clocks, two channels, a variable and small constants.

    The first half of the automata has most of the controller's edges, the others have most of the environment's. The
    same number gives the same game.
    """
    draw = random.Random(f"{kind.value} {number}")
    clocks = ("x", "y", "z")[: draw.randint(1, 3)]
    places = tuple(f"l{k}" for k in range(draw.randint(3, 5)))
    count = draw.randint(2, 5)
    automata = tuple(_automaton(draw, clocks, places, k, 2 * k < count) for k in range(count))
    network = Network(clocks, (("v", 0),), _CHANNELS, automata)
    losing = draw.choice(("A0", f"A{count - 1}"))
    if kind is Kind.REACH_WHILE_SAFE:
        losing = f"A{count - 1}"
    return network, Objective(kind, goal=(("A0", places[-1]),), bad=((losing, places[-1]),))


def _automaton(
    draw: random.Random, clocks: Tuple[str, ...], places: Tuple[str, ...], number: int, robot: bool
) -> Automaton:
    locations = []
    for place in places:
        bound = ClockBound(draw.choice(clocks), "<=", draw.randint(1, 6))
        locations.append(Location(place, (bound,) if draw.random() < 1 / 3 else ()))
    edges = [
        _edge(draw, clocks, places, places[k % (len(places) - 1)], robot)
        for k in range(draw.randint(4, 8) if robot else draw.randint(2, 6))
    ]
    return Automaton(f"A{number}", tuple(locations), places[0], tuple(edges))


def _edge(draw: random.Random, clocks: Tuple[str, ...], places: Tuple[str, ...], source: str, robot: bool) -> Edge:
    sync = None if draw.random() < 0.5 else Sync(draw.choice(_CHANNELS), draw.random() < 0.5)
    bounds: List[ClockBound] = []
    if sync is None or sync.sends:
        if draw.random() < 0.5:
            bounds.append(ClockBound(draw.choice(clocks), draw.choice((">", ">=")), draw.randint(0, 4)))
        if draw.random() < 1 / 3:
            bounds.append(ClockBound(draw.choice(clocks), draw.choice(("<", "<=", "==")), draw.randint(1, 6)))
    return Edge(
        source=source,
        target=places[-1] if draw.random() < 1 / 8 else draw.choice(places[:-1]),
        guard=Guard(tuple(bounds), ((Test("v", draw.randint(0, 1)),),) if draw.random() < 1 / 4 else ()),
        sync=sync,
        assign=(("v", draw.randint(0, 1)),) if draw.random() < 1 / 4 else (),
        resets=tuple(clock for clock in clocks if draw.random() < 1 / 3),
        controllable=draw.random() < (3 / 4 if robot else 1 / 4),
    )


# Measuring ------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Played:
    """One game: discrete states, verdicts and processor seconds of all of our solving and of the plain solver.

    A verdict is None where a limit was hit; `regions` also where the game is too large for brute force.
    """

    number: int
    states: int
    won: Optional[bool]
    seconds: float
    plainly_won: Optional[bool]
    plain_seconds: float
    regions: Optional[bool]

    @property
    def allowed(self) -> float:
        """The seconds that it should take at most."""
        return TIMES * self.plain_seconds + PLUS

    @property
    def agreed(self) -> bool:
        """True if no two verdicts differ."""
        return len({verdict for verdict in (self.won, self.plainly_won, self.regions) if verdict is not None}) <= 1


def played(number: int, kind: Kind, rules: Rules) -> Optional[Played]:
    """The game of this number; None where it has too few or too many discrete states."""
    network, objective = random_game(number, kind)
    game = compile_game(network, objective, rules.reaction)
    start = time.process_time()
    try:
        outcome = ReferenceEngine(directed=False).solve(game, Limits(seconds=LIMIT, states=MOST + 1))
    except PursueError as problem:
        if "discrete states;" in problem.diagnostics[0].message:
            return None
        plainly_won, states = None, 0
    else:
        plainly_won, states = outcome.won, outcome.stats.discrete_states
    plain_seconds = time.process_time() - start
    if plainly_won is not None and not LEAST <= states <= MOST:
        return None
    start = time.process_time()
    won = _solved(network, objective, rules)
    taken = time.process_time() - start
    small = 0 < states <= _ON_REGIONS and len(network.clocks) <= 2 and game.delta == 0
    return Played(number, states, won, taken, plainly_won, plain_seconds, _on_regions(game) if small else None)


def _solved(network: Network, objective: Objective, rules: Rules) -> Optional[bool]:
    """The verdict of what the command `solve` does: solving, proof, guaranteed time and margin."""
    limits = Limits(seconds=LIMIT, by_default=True)
    try:
        won = solved(network, objective, rules, SolveOptions(limits))
        margins(won, False, limits)
    except Lost:
        return False
    except PursueError:
        return None
    return True


def _on_regions(game: Any) -> bool:
    from tests.synthesis.region_game import RegionGame

    regions = RegionGame(game)
    return regions.won(regions.winning())


def summary(kind: Kind, game: str, games: List[Played]) -> Row:
    """The row of all games of a kind."""
    slowest = max(games, key=lambda one: one.seconds)
    closest = max(games, key=lambda one: one.seconds / one.allowed)
    return {
        "group": "random", "name": kind.value, "size": None, "game": game, "outcome": "", "games": len(games),
        "states_median": statistics.median(one.states for one in games), "states": max(one.states for one in games),
        "won": sum(one.won is True for one in games),
        "undecided": sum(one.won is None for one in games),
        "disagreed": sum(not one.agreed for one in games),
        "on_regions": sum(one.regions is not None for one in games),
        "above": sum(one.won is None or one.seconds > one.allowed for one in games),
        "seconds": round(statistics.median(one.seconds for one in games), 4),
        "plain": round(statistics.median(one.plain_seconds for one in games), 4),
        "slowest": {"number": slowest.number, "states": slowest.states, "seconds": round(slowest.seconds, 3),
                    "plain": round(slowest.plain_seconds, 3)},
        "closest": {"number": closest.number, "states": closest.states, "seconds": round(closest.seconds, 3),
                    "plain": round(closest.plain_seconds, 3), "part": round(closest.seconds / closest.allowed, 3)},
    }  # fmt: skip


def drawn(count: int, kind: Kind, rules: Rules) -> Iterator[Played]:
    """The first so many games that have the right size."""
    number, found = 0, 0
    while found < count:
        one = played(number, kind, rules)
        number += 1
        if one is not None:
            found += 1
            yield one


def main() -> None:
    """Prints a row for each kind of objective and game."""
    count = int(sys.argv[1])
    for kind in Kind:
        for game, (ends, reaction) in GAMES.items():
            rules = Rules(ends, Fraction(reaction))
            print(json.dumps(summary(kind, game, list(drawn(count, kind, rules)))), flush=True)


if __name__ == "__main__":
    main()
