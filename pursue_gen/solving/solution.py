"""The chain from a scenario to a proven strategy, as one value: what the commands and the workspace start from."""

from __future__ import annotations

import time
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Mapping, Optional

from pursue_gen.diagnostics import Diagnostic, PursueError, error
from pursue_gen.language.scenario import Scenario
from pursue_gen.proof.checker import pruned, pruned_ranks, verify
from pursue_gen.proof.smaller import smaller
from pursue_gen.proof.worst_case import LIMIT, with_counter, worst_case
from pursue_gen.solving.least_time import SECONDS, Guarantee, bounds, fastest, unscaled
from pursue_gen.synthesis.limits import NO_LIMITS, Limits, Listener
from pursue_gen.synthesis.solve import Stats, solve
from pursue_gen.synthesis.strategy import Strategy, ZoneKey
from pursue_gen.tga import ends_reported, scenario_objective, translate
from pursue_gen.tga.network import Kind, Network, Objective

_LITTLE = 6_000
"""A proof with so many symbolic states takes a second or two: then a strategy in fewer zones is proven as well."""

REPORTED, CONTROLLABLE = "reported", "controllable"


@dataclass(frozen=True)
class Rules:
    """Which game is played.

    `ends`: who controls the end of a controllable agent's movement or action, "reported" (the robot tells) or
    "controllable" (the original's game). `reaction`: how late a command may take effect, in time units. `slack`: how
    many time units later than the model an agent may end, per agent.
    """

    ends: str = REPORTED
    reaction: Fraction = Fraction(1, 10)
    slack: Mapping[str, int] = field(default_factory=dict)


IDEAL = Rules(CONTROLLABLE, Fraction(0))
"""The game that UPPAAL-TIGA plays."""


@dataclass(frozen=True)
class Solution:
    """A proven strategy for the objective in `network` (the game as it is played, ends and slack included).

    `rules` are those of that game; `guarantee`: how long it takes at worst, where that was looked for.
    """

    network: Network
    objective: Objective
    strategy: Strategy
    reaction: Fraction
    stats: Optional[Stats] = None
    guarantee: Optional[Guarantee] = None
    rules: Rules = Rules()


def played(network: Network, rules: Rules) -> Network:
    """The network with the ends and the slack of the rules."""
    return ends_reported(network, rules.slack) if rules.ends == REPORTED else network


def solution(
    network: Network,
    objective: Objective,
    rules: Rules,
    limits: Limits = NO_LIMITS,
    engine: Optional[str] = None,
    progress: Optional[Listener] = None,
) -> Solution:
    """Solves the game and proves the strategy with the independent checker, both together within the limits.

    `engine` and `progress` as in `solve`. Raises PursueError with exit status 4 when the objective cannot be met under
    these rules; it says so plainly when the ideal game, which no robot can play, would be won. With exit status 5 at a
    limit.
    """
    start = time.monotonic()
    game = played(network, rules)
    verdict = solve(game, objective, rules.reaction, engine, limits, progress)
    if verdict.strategy is None:
        finding = _cannot_be_met(network, objective, rules, limits.since(start), engine, progress)
        raise PursueError([finding], exit_status=4)
    strategy = prove(
        game, objective, verdict.strategy, rules.reaction, verdict.ranks, limits.since(start), progress
    )
    return Solution(game, objective, strategy, rules.reaction, verdict.stats, rules=rules)


def fastest_solution(
    network: Network,
    objective: Objective,
    rules: Rules,
    limits: Limits = NO_LIMITS,
    engine: Optional[str] = None,
    progress: Optional[Listener] = None,
) -> Solution:
    """As `solution`, with the proven strategy that takes the least time to the goal at worst, as far as it is found.

    Raises as `solution`, and with exit status 2 for an objective without a goal. A limit that is hit after the first
    strategy ends the search, and the best one that is proven counts.
    """
    if objective.kind is Kind.SAFETY:
        hint = "leave --optimize time out; it is for objectives with a goal: reach_objective: do ..."
        raise PursueError([error("SYN022", "a safety objective has no time to the goal", hint=hint)], exit_status=2)
    start = time.monotonic()
    won = solution(network, objective, rules, limits, engine, progress)
    known = guaranteed(won, LIMIT, limits.since(start))
    found, faster = fastest(won.network, objective, rules.reaction, known.worst, limits.since(start), engine, progress)
    if faster is None:
        return replace(won, guarantee=found)
    delay = rules.reaction * faster.fine
    left = limits.since(start) if limits.seconds else Limits(SECONDS, limits.memory)
    try:
        strategy = prove(faster.game, objective, faster.strategy, delay, faster.ranks, left, progress)
    except PursueError as problem:
        if problem.exit_status != 5:
            raise
        return replace(won, guarantee=replace(found, worst=known.worst, most=known.most))
    counted = with_counter(won.network)
    fast = replace(won, network=counted, strategy=unscaled(strategy, counted, faster.fine))
    took = guaranteed(fast, LIMIT, left)
    if took.worst is None or took.most is None or found.most is None:
        return replace(fast, guarantee=found)
    most = min(found.most, max(took.most, found.least))
    return replace(fast, guarantee=replace(found, worst=min(took.worst, faster.kept), most=most))


def guaranteed(won: Solution, states: int = 500, limits: Limits = NO_LIMITS) -> Guarantee:
    """How long the strategy of a reach game takes at worst, if so many symbolic states of the checker tell it."""
    worst = worst_case(won.network, won.objective, won.strategy, won.reaction, states, limits)
    return bounds(won.network, won.objective, won.reaction, worst)


def prove(
    network: Network,
    objective: Objective,
    strategy: Strategy,
    reaction: Fraction,
    ranks: Optional[Mapping[ZoneKey, int]] = None,
    limits: Limits = NO_LIMITS,
    progress: Optional[Listener] = None,
    simpler: bool = True,
) -> Strategy:
    """The part of the strategy that plays can reach, once the checker has found it winning (with `ranks`: sooner).

    `simpler`: in fewer zones and bounds, proven once more, where that costs little. Raises PursueError with the play
    that breaks it; with exit status 5 at a limit, the checker's own one on symbolic states included.
    """
    start = time.monotonic()
    report = verify(network, objective, strategy, reaction, ranks=ranks, limits=limits, progress=progress)
    if not report.ok and ranks is not None:
        ranks = None
        report = verify(network, objective, strategy, reaction, limits=limits.since(start), progress=progress)
    if report.reason.startswith("limit"):
        hint = "the strategy may win, but only what is proven is used; make the scenario smaller: fewer agents or POIs"
        raise PursueError([error("SYN010", f"the strategy is not proven: {report.reason}", hint=hint)], exit_status=5)
    if not report.ok:
        play = "".join(f"\n      {step}" for step in report.play)
        hint = "this is a fault of the strategy, not of the scenario; the play that shows it:" + play
        raise PursueError([error("SYN020", f"the strategy does not win: {report.reason}", hint=hint)], exit_status=4)
    kept = pruned(strategy, report)
    if not simpler or report.states > _LITTLE:
        return kept
    left = None if ranks is None else pruned_ranks(strategy, report, ranks)
    fewer = smaller(network, kept, reaction, left)
    try:
        again = verify(network, objective, fewer, reaction, 2 * _LITTLE, limits=limits.since(start), progress=progress)
    except PursueError as problem:
        if problem.exit_status != 5:
            raise
        return kept  # what is proven stays so when there is no time left to make it smaller
    return pruned(fewer, again) if again.ok else kept


def solve_scenario(
    scenario: Scenario,
    rules: Rules,
    limits: Limits = NO_LIMITS,
    engine: Optional[str] = None,
    progress: Optional[Listener] = None,
) -> Solution:
    """The proven strategy of a scenario. Raises as `solution` does."""
    return solution(translate(scenario), scenario_objective(scenario), rules, limits, engine, progress)


def _cannot_be_met(
    network: Network,
    objective: Objective,
    rules: Rules,
    limits: Limits,
    engine: Optional[str],
    progress: Optional[Listener],
) -> Diagnostic:
    reaction = _decimal(rules.reaction)
    message = f"the objective cannot be met with ends {rules.ends} and a reaction of {reaction} time units"
    hint = "the agents that nobody controls can always prevent it: give the robots more time or speed, or fewer duties"
    if rules != IDEAL and _won_ideally(network, objective, limits, engine, progress):
        message += "; only the ideal game (ends controllable, reaction 0) is won, which no real robot can play"
        hint = "give the robots more time or speed; to see the ideal strategy: --ends controllable --reaction 0"
    return error("SYN021", message, hint=hint)


def _won_ideally(
    network: Network, objective: Objective, limits: Limits, engine: Optional[str], progress: Optional[Listener]
) -> bool:
    """True if the ideal game is known to be won; that it is not decided in time takes nothing from the verdict."""
    try:
        return solve(network, objective, engine=engine, limits=limits, progress=progress).won
    except PursueError:
        return False


def _decimal(value: Fraction) -> str:
    return f"{float(value):g}"
