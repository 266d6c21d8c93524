"""Who wins a game, by everybody who can tell, and every strategy held against both checkers.

Limits count work, states and zones, never seconds, so a game ends the same on every machine.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from typing import Callable, Dict, List, Optional, Sequence, Union

from pursue_gen.diagnostics import PursueError
from pursue_gen.outcomes import LimitHit, Lost
from pursue_gen.proof.checker import verify
from pursue_gen.solving.attempts import decided_by_attempts
from pursue_gen.solving.decomposition import won_by_some
from pursue_gen.solving.found import Found
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.rules import Rules, played
from pursue_gen.solving.solution import Solution, solution
from pursue_gen.solving.solvers import solved
from pursue_gen.solving.without_pauses import lost_to_few_calls, won_without_pauses
from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.synthesis.engine import Engine
from pursue_gen.synthesis.game import Game
from pursue_gen.synthesis.limits import Limits
from pursue_gen.synthesis.native.engine import NativeEngine
from pursue_gen.synthesis.solve import solve
from pursue_gen.tga.network import Kind, Network, Objective
from tests.oracle.checker import in_python
from tests.oracle.engine import ReferenceEngine
from tests.oracle.zone_graph import max_constants

PLAIN, TWIN, NATIVE, IN_TURN, SOONEST, REGIONS = "plain", "python", "native", "in turn", "soonest", "regions"
COMMAND, WHOLE, COMPOSED, NO_RESTS, FEW_CALLS = "command", "whole", "composed", "no rests", "few calls"
ATTEMPTS = "attempts"

MOST = 500
"""Random games have at most so many discrete states."""

_NATIVE_WORK, _WORK = 20_000_000, 60_000
"""The work that an engine may take: the native one, and those in Python."""

_POSITIONS, _CLOCKS = 1_200, 2
"""Brute force on regions takes games of about so many positions, and so many clocks."""

_PROOF, _PROOF_TWIN = 20_000, 1_500
"""The symbolic states of a proof; the checker in Python looks at those where the native one took so many."""

_SCENARIO = Limits(states=60_000, work=40_000_000)
"""How far the game of a scenario is solved in one piece."""

_VARIED = Limits(states=60_000, work=3_000_000)
"""How far a varied scenario's game is solved in one piece. What takes longer is not compared."""

_VARIED_TWIN = 200
"""The checker in Python looks at their strategies where the native one took so many symbolic states."""

_ATTEMPTS = Limits(states=60_000, work=20_000_000)
"""How far attempts go at the game of a varied scenario."""

_TWIN_STATES = 250
"""The engine in Python solves games of scenarios with so many discrete states."""

_BY_SOME_WORK = 10_000_000
"""The work on a scenario's game without rests."""

Verdict = Optional[bool]


@dataclass
class Opinions:
    """What was found of one game.

    `verdicts`: who says that the controller wins, None where a limit was hit; `states`: its discrete states, as far as
    they were looked at; `proven`: strategies that both checkers found winning, `half_proven`: the native one alone,
    `unproven`: those that took more than a proof may; `stages`: the composed strategy has stages; `faults`: what else
    must not be.
    """

    states: int = 0
    verdicts: Dict[str, Verdict] = field(default_factory=dict)
    proven: int = 0
    half_proven: int = 0
    unproven: int = 0
    stages: bool = False
    faults: List[str] = field(default_factory=list)

    @property
    def won(self) -> Verdict:
        """The verdict, of the first who has one; None where nobody has."""
        return next((verdict for verdict in self.verdicts.values() if verdict is not None), None)

    @property
    def agreed(self) -> bool:
        """True if no two verdicts differ, and there are no faults."""
        return len({verdict for verdict in self.verdicts.values() if verdict is not None}) <= 1 and not self.faults

    def ask(self, who: str, decide: Callable[[], Verdict]) -> Verdict:
        """Adds the verdict of one, who raises PursueError where the game is lost, or at a limit."""
        verdict = None
        try:
            verdict = decide()
        except Lost:
            verdict = False
        except LimitHit:
            pass
        except PursueError as problem:
            self.faults.append(f"{who}: {problem.diagnostics[0].message}")
        self.verdicts[who] = verdict
        return verdict

    def check(self, who: str, won: Solution, twin: int = _PROOF_TWIN) -> bool:
        """True; both checkers look at the strategy, the one in Python if the native one took so many symbolic states
        at most."""
        how = won.network, won.objective, won.strategy, won.reaction, _PROOF
        report = verify(*how)
        if report.reason.startswith("limit"):
            self.unproven += 1
        elif not report.ok:
            self.faults.append(f"{who}: the native checker refuses it: {report.reason}")
        elif report.states > twin:
            self.half_proven += 1
        else:
            self.proven += 1
            with in_python():
                again = verify(*how)
            if again != report:
                self.faults.append(f"{who}: the checkers differ: {report.states} and {again.states}, {again.reason}")
        return True


# Random games ---------------------------------------------------------------------------------------------------------


def on_game(network: Network, objective: Objective, rules: Rules, least: int) -> Optional[Opinions]:
    """What engines, the command and brute force say of a small game; None for one with fewer discrete states than
    `least`, or more than MOST."""
    found = Opinions()
    game = compile_game(played(network, rules), objective, rules.reaction)
    try:
        outcome = ReferenceEngine(directed=False).solve(game, Limits(states=MOST + 1, work=_WORK))
    except PursueError as problem:
        if "discrete states;" in problem.diagnostics[0].message:
            return None
        found.verdicts[PLAIN] = None
    else:
        found.states, found.verdicts[PLAIN] = outcome.stats.discrete_states, outcome.won
        if not least <= found.states <= MOST:
            return None
    found.ask(TWIN, lambda: _decided(ReferenceEngine(), game, _WORK))
    found.ask(NATIVE, lambda: _decided(NativeEngine(), game, _NATIVE_WORK))
    found.ask(IN_TURN, lambda: _decided(NativeEngine(0.0), game, _NATIVE_WORK))
    if game.kind is not Kind.SAFETY:
        found.ask(SOONEST, lambda: _decided(NativeEngine(), game, _NATIVE_WORK, soonest=True))
    if len(game.clocks) <= _CLOCKS and 0 < _positions(game, found.states) <= _POSITIONS:
        found.verdicts[REGIONS] = _on_regions(game)
    by_twin = SolveOptions(Limits(work=_WORK), engine=ReferenceEngine())
    command = SolveOptions(most_work=_NATIVE_WORK)
    found.ask(f"{TWIN}, proven", lambda: found.check(TWIN, solution(network, objective, rules, by_twin)))
    found.ask(COMMAND, lambda: found.check(COMMAND, solved(network, objective, rules, command)))
    return found


def _decided(engine: Engine, game: Game, work: int, soonest: bool = False) -> bool:
    return engine.solve(game, Limits(work=work), soonest=soonest).won


def _positions(game: Game, states: int) -> int:
    """About so many positions at most: a time on the way of each clock, or between two of them, up to its constant."""
    positions = states
    for largest in max_constants(game)[1:]:
        positions *= 2 * (largest + game.delta) + 2
    return positions


def _on_regions(game: Game) -> bool:
    from tests.synthesis.region_game import RegionGame

    regions = RegionGame(game)
    return regions.won(regions.winning())


# Random scenarios -----------------------------------------------------------------------------------------------------


def on_scenario(network: Network, objective: Objective, rules: Rules) -> Opinions:
    """What the solver says of a scenario's game with all that is in it and in one piece, and those who leave agents,
    rests or calls out of it, or play it in stages."""
    found = Opinions()
    game, reaction = played(network, rules), rules.reaction

    def by_some(who: str, some: Optional[Found]) -> Verdict:
        return None if some is None else found.check(who, Solution(game, objective, some.strategy, reaction))

    def composed() -> Verdict:
        some = won_by_some(game, objective, reaction, SolveOptions())
        found.stages = some is not None and bool(some.strategy.stages)
        return by_some(COMPOSED, some)

    def no_rests() -> Verdict:
        return by_some(NO_RESTS, won_without_pauses(game, objective, reaction, _BY_SOME_WORK, SolveOptions()))

    found.ask(WHOLE, lambda: _in_one_piece(found, game, objective, reaction, _SCENARIO))
    found.ask(COMPOSED, composed)
    found.ask(NO_RESTS, no_rests)
    found.ask(FEW_CALLS, lambda: False if lost_to_few_calls(game, objective, reaction, SolveOptions()) else None)
    command = SolveOptions(most_work=_SCENARIO.work)
    found.ask(COMMAND, lambda: found.check(COMMAND, solved(network, objective, rules, command)))
    if 0 < found.states <= _TWIN_STATES:
        by_twin = SolveOptions(Limits(work=_WORK), engine=ReferenceEngine())
        found.ask(TWIN, lambda: found.check(TWIN, solution(network, objective, rules, by_twin)))
    return found


def on_varied(network: Network, objective: Objective, rules: Rules) -> Optional[Opinions]:
    """What the solver says of a small scenario's game in one piece, as the command plays it, and in parts and by
    policies alone (`decided_by_attempts`, or what wins a goal in stages or by some of the robots); None for a game that
    takes more in one piece than is looked at here."""
    found = Opinions()
    game, reaction = played(network, rules), rules.reaction

    def apart() -> Verdict:
        options = SolveOptions(_ATTEMPTS)
        if objective.reaches:
            some: Union[Found, Sequence[Objective], None] = won_by_some(game, objective, reaction, options)
        else:
            some = decided_by_attempts(game, objective, reaction, options)
        if not isinstance(some, Found):
            return False if some else None
        found.stages = bool(some.strategy.stages)
        return found.check(ATTEMPTS, Solution(game, objective, some.strategy, reaction), _VARIED_TWIN)

    one = found.ask(WHOLE, lambda: _in_one_piece(found, game, objective, reaction, _VARIED))
    if one is None and not found.faults:
        return None
    found.ask(ATTEMPTS, apart)
    command = SolveOptions(most_work=_SCENARIO.work)
    found.ask(COMMAND, lambda: found.check(COMMAND, solved(network, objective, rules, command), _VARIED_TWIN))
    return found


def _in_one_piece(found: Opinions, game: Network, objective: Objective, reaction: Fraction, limits: Limits) -> bool:
    """The verdict on the whole game; its discrete states are noted."""
    verdict = solve(game, objective, reaction, NativeEngine(), limits, whole=True)
    found.states = verdict.stats.discrete_states
    return verdict.won
