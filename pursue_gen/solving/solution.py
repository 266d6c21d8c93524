"""From a game, or a scenario, to a strategy that is proven to win it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Optional, Sequence, Tuple, Union

from pursue_gen.diagnostics import Diagnostic, PursueError, error
from pursue_gen.language.scenario import Scenario
from pursue_gen.outcomes import Lost, NotProven
from pursue_gen.proof.independence import named_part
from pursue_gen.proof.worst_case import worst_case
from pursue_gen.solving.attempts import BESIDE_A_GOAL, decided_by_attempts
from pursue_gen.solving.cut_off import lost_to_a_stay
from pursue_gen.solving.decomposition import has_parts, little_work, won_by_some, works_in_parallel
from pursue_gen.solving.efforts import EFFORTS
from pursue_gen.solving.found import Found
from pursue_gen.solving.least_time import Guarantee, bounds
from pursue_gen.solving.lost_promises import (
    cannot_be_promised,
    has_promises,
    lost_promises,
    lost_to_one_walk,
    only_promises,
    promises,
    watched,
)
from pursue_gen.solving.options import DEFAULT, SolveOptions
from pursue_gen.solving.passages import crowd_of, without_bad, won_by_passages
from pursue_gen.solving.proving import prove
from pursue_gen.solving.rules import DEFAULT as DEFAULT_RULES
from pursue_gen.solving.rules import IDEAL, Rules, played
from pursue_gen.solving.shares import can_be_shared, won_in_shares
from pursue_gen.solving.stays import LostToAStay
from pursue_gen.solving.tours import PATROL, won_by_tours
from pursue_gen.solving.tours_beside import won_beside_tours
from pursue_gen.solving.without_pauses import lost_to_few_calls, verdict_with, won_without_pauses
from pursue_gen.synthesis.cone import cone_of_influence, out_of_reach
from pursue_gen.synthesis.enforced import enforced
from pursue_gen.synthesis.limits import NO_LIMITS, Limits
from pursue_gen.synthesis.solve import Stats, Verdict, solve
from pursue_gen.synthesis.strategy import Strategy, with_automata_of
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.ends import is_nobodys
from pursue_gen.tga.network import Kind, Network, Objective
from pursue_gen.tga.pauses import pauses

_CANNOT_BE_MET = "SYN021"

_MANY = 100
"""A strategy with more blocks than this is compared with one in stages. Measured on deliveries by three robots."""

_EASY = 100_000
"""With so little work a game is easy: then agents who rest between calls keep their pauses. Else strategies that know
them take long to prove, too. Not measured."""

_CROWD = 4
"""So many robots that must not be at one place are no easy game: an order of passage is looked for first. Measured on
30 robots that change places."""

_SLOWER = Fraction(11, 10)
"""So much longer a smaller strategy may take. Measured on deliveries by three robots."""

_FOR_IDEAL, _IDEAL_STATES = 10_000_000, 2_000
"""The work for whether a lost game is won ideally, and its discrete states: some two seconds. Not measured."""


@dataclass(frozen=True)
class Solution:
    """A proven strategy for the objective in `network` (the game as it is played, ends and slack included).

    The network has the watchers and passages that the strategy follows. `rules` are those of that game, `reaction` is
    theirs, in time units; `guarantee`: how long it takes at worst, where that was computed; `within`: in how many time
    units it has to come to the goal, where that is given; `warnings`: what to know before it is used.
    """

    network: Network
    objective: Objective
    strategy: Strategy
    reaction: Fraction
    stats: Optional[Stats] = None
    guarantee: Optional[Guarantee] = None
    rules: Rules = DEFAULT_RULES
    warnings: Tuple[Diagnostic, ...] = ()
    within: Optional[Fraction] = None

    def with_strategy(self, strategy: Strategy) -> Solution:
        """The same with another strategy, which was proven for the part of the network that this one speaks of."""
        return replace(self, strategy=replace(strategy, left_out_clocks=self.strategy.left_out_clocks))

    @property
    def part(self) -> Network:
        """The part of the network that the strategy speaks of: what is not in it cannot matter."""
        return named_part(self.network, self.strategy)


def solution(network: Network, objective: Objective, rules: Rules, options: SolveOptions = DEFAULT) -> Solution:
    """Solves the game and proves the strategy with the independent checker, both together within the limits.

    Of the options limits, engine and progress count. Raises Lost where the objective cannot be met under these
    rules (the message says so where the ideal game, which no robot can play, would be won), NotProven where the checker
    refuses the strategy, LimitHit at a limit.
    """
    start, in_parts = options.limits.now(), not options.whole and not options.limits.work
    with enforced(options.limits):
        won = _first(network, objective, rules, options, in_parts)
    if won is None:
        left = options.since(start)
        game = played(network, rules)
        some = lost_promises(game, objective, rules.reaction, left) if in_parts and not options.most_work else ()
        raise _lost(network, objective, rules, options.since(start), some)
    if isinstance(won, tuple):
        raise _lost(network, objective, rules, options.since(start), won)
    return won


def _first(
    network: Network, objective: Objective, rules: Rules, options: SolveOptions, in_parts: bool
) -> Union[Solution, Tuple[Objective, ...], None]:
    """The first solution; where it is lost, the parts of the objective that are known to be, None for the whole of it.

    `in_parts`: what is less work is tried before the game in one piece. Raises as `solution`.
    """
    start = options.limits.now()
    game = played(network, rules)
    verdict = None
    # Where there is nothing else to try after little work, the same search goes on.
    alone = in_parts and not options.most_work and not pauses(game) and not has_parts(game, objective)
    if in_parts and not alone:
        known = _with_little_work(game, objective, rules.reaction, options)
        if isinstance(known, (Found, Strategy)):
            strategy, stats = (known.strategy, known.stats) if isinstance(known, Found) else (known, None)
            return Solution(with_automata_of(game, strategy), objective, strategy, rules.reaction, stats, rules=rules)
        if isinstance(known, tuple):
            return known
        verdict = known
    if verdict is None and in_parts and lost_to_few_calls(game, objective, rules.reaction, options.since(start)):
        return ()
    if verdict is None:
        how = options.engine, options.since(start).in_one_piece, options.progress
        first = little_work(game) if alone else 0
        verdict = solve(game, objective, rules.reaction, *how, whole=options.whole, first=first)
    if verdict.strategy is None:
        return None
    won = Solution(game, objective, verdict.strategy, rules.reaction, verdict.stats, rules=rules)
    smaller = _smaller(won, options.since(start)) if in_parts and len(verdict.strategy.blocks) > _MANY else None
    return smaller or replace(won, strategy=_proven(game, objective, rules.reaction, verdict, options.since(start)))


def _proven(
    game: Network, objective: Objective, reaction: Fraction, verdict: Verdict, options: SolveOptions
) -> Strategy:
    """The verdict's strategy, once it is proven; where it is refused, one that is found in the order of time: with long
    reactions commands that are overtaken may go round in circles. Raises as `prove` does."""
    assert verdict.strategy is not None
    start = options.limits.now()
    try:
        return prove(game, objective, verdict.strategy, reaction, verdict.ranks, options, otherwise=verdict.cautious)
    except NotProven as problem:
        if not objective.reaches:
            raise
        refused = problem
    how = options.engine, options.since(start).in_one_piece, options.progress
    again = solve(game, objective, reaction, *how, whole=options.whole, soonest=True)
    if again.strategy is None:
        raise refused
    left = options.since(start)
    return prove(game, objective, again.strategy, reaction, again.ranks, left, otherwise=again.cautious)


def _smaller(won: Solution, options: SolveOptions) -> Optional[Solution]:
    """A proven solution in stages that is much smaller than this one, which is not proven yet, and hardly slower.

    Robots that work at the same time arrive in any order, and a strategy in one piece has blocks for each order: to
    prove it first would take most of the time.
    """
    if len(won.objective.goal) != 1 or not works_in_parallel(won.network, won.objective.goal[0]):
        return None
    some = won_by_some(won.network, won.objective, won.reaction, options)
    if some is None or 2 * len(some.strategy.blocks) > len(won.strategy.blocks):
        return None
    smaller = replace(won, strategy=some.strategy, stats=some.stats)
    takes, took = (guaranteed(each, limits=options.limits).worst for each in (smaller, won))
    return smaller if takes is not None and (took is None or takes <= _SLOWER * took) else None


def _with_little_work(
    game: Network, objective: Objective, reaction: Fraction, options: SolveOptions
) -> Union[Verdict, Found, Strategy, Tuple[Objective, ...], None]:
    """The verdict in one piece, or a proven strategy with orders of passage, or one that leaves out agents, or pauses
    of the environment, or parts of the objective that are lost; None where little work finds neither (see `passages`,
    `shares`, `lost_promises`, `decomposition` and `without_pauses`)."""
    start, work, rests = options.limits.now(), little_work(game), bool(pauses(game))
    several, shared = len(promises(objective)) > 1, can_be_shared(game, objective)
    crowd = crowd_of(game, objective)
    large = crowd is not None and len(crowd.robots) >= _CROWD
    found: Union[Found, Strategy, None] = None
    if not objective.reaches:
        found = won_by_tours(game, objective, reaction, options) if len(promises(objective)) >= PATROL else None
        found = found or won_beside_tours(game, objective, reaction, options)
    if found is None and crowd is not None and large:
        found = won_by_passages(game, objective, crowd, reaction, options)
    if found is not None:
        return found
    verdict = verdict_with(game, objective, reaction, min(work, _EASY) if rests or several else work, options)
    if verdict is None and crowd is not None and not large:
        passed = won_by_passages(game, objective, crowd, reaction, options.since(start))
        if passed is not None:
            return passed
    if verdict is None and rests and objective.reaches:
        found = won_without_pauses(game, objective, reaction, work, options.since(start))
        if found is not None:
            return found
    if verdict is None and has_promises(objective):
        beside = won_in_shares(game, objective, reaction, options.since(start), EFFORTS[1:2])
        if beside is not None:
            return beside
    if verdict is None and (several or shared):
        known = decided_by_attempts(game, objective, reaction, options.since(start))
        if known:
            return known
    walking = reaction, options.since(start).limits, options.progress
    if verdict is None and objective.goal and lost_to_one_walk(game, objective, *walking) is not None:
        return ()
    if verdict is None and rests and not objective.reaches:
        found = won_without_pauses(game, objective, reaction, work, options.since(start))
        if found is not None:
            return found
    if verdict is None and (rests or (several and not shared)):
        verdict = verdict_with(game, objective, reaction, work, options.since(start))
    if verdict is not None:
        return verdict
    some = won_by_some(game, objective, reaction, options.since(start))
    if some is None and has_promises(objective):
        return decided_by_attempts(game, objective, reaction, options.since(start), BESIDE_A_GOAL) or None
    return some


def check_goal(objective: Objective, option: str) -> None:
    """Raises PursueError (exit status 2) for an objective without a goal, where an option is about the time to it."""
    if not objective.reaches:
        hint = f"leave {option} out; it is for objectives with a goal: reach_objective: do ..."
        raise PursueError([error("SYN022", "a safety objective has no time to the goal", hint=hint)])


def guaranteed(won: Solution, states: int = 500, limits: Limits = NO_LIMITS) -> Guarantee:
    """The worst-case time of a reach game's strategy, where at most so many symbolic states of the checker tell it."""
    worst = worst_case(won.network, won.objective, won.strategy, won.reaction, states, limits)
    if not won.strategy.passages:
        return bounds(won.part, won.objective, won.reaction, worst)
    # The automata of what is to be avoided are many where many must not meet, and say nothing of the least time.
    rest = without_bad(won.network, won.objective)
    return bounds(rest, Objective(Kind.REACH, won.objective.goal), won.reaction, worst)


def solve_scenario(scenario: Scenario, rules: Rules, options: SolveOptions = DEFAULT) -> Solution:
    """The proven strategy of a scenario. Raises as `solution` does."""
    return solution(translate(scenario), scenario_objective(scenario), rules, options)


def _lost(
    network: Network, objective: Objective, rules: Rules, options: SolveOptions, parts: Sequence[Objective] = ()
) -> Lost:
    """That the objective cannot be met, because of each of these parts if there are any."""
    some = [wanted for wanted in parts if wanted != objective]
    if not some:
        return Lost([_cannot_be_met(network, objective, rules, options, "the objective cannot be met")])
    start, findings, names = options.limits.now(), [], [watched(wanted) for wanted in some]
    for wanted, who in zip(some, names):
        part = cone_of_influence(only_promises(network, objective, wanted), wanted)
        findings.append(_cannot_be_met(part, wanted, rules, options.since(start), f"{cannot_be_promised(who)},"))
    return Lost(findings, names)


def _cannot_be_met(
    network: Network, objective: Objective, rules: Rules, options: SolveOptions, what: str
) -> Diagnostic:
    message = f"{what} with ends {rules.ends} and a reaction of {float(rules.reaction):g} time units"
    hint = "give the robots more time or speed, or fewer duties"
    if any(map(is_nobodys, network.automata)):
        hint = f"the agents that nobody controls can always prevent it: {hint}"
    alone = out_of_reach(network, objective)
    if alone:
        message += f"; no robot can do anything about it, as it depends on {' and '.join(alone)} alone"
        hint = "let something that a robot does matter to the objective, or make one of these agents controllable"
        return error(_CANNOT_BE_MET, message, hint=hint)
    stay = lost_to_a_stay(played(network, rules), objective)
    if stay is not None:
        return error(_CANNOT_BE_MET, message, hint=_without_the_stay(stay))
    if rules != IDEAL and not options.most_work and _won_ideally(network, objective, options):
        message += "; only the ideal game (ends controllable, reaction 0) is won, which no real robot can play"
        hint = "give the robots more time or speed; to see the ideal strategy: --ends controllable --reaction 0"
    return error(_CANNOT_BE_MET, message, hint=hint)


def _without_the_stay(stay: LostToAStay) -> str:
    """What to do where somebody who stays prevents it."""
    agent, place = stay.agent, stay.place
    prevents = f"{agent} may stay at {place} for ever, and that is enough to prevent it"
    change = f"say that it does not (assume: {agent} leaves {place} within 30), or let robots do without that place"
    if stay.comes:
        prevents = f"{agent} may wait at {place} for ever, and be where a robot goes before the robot is gone"
        change = f"say how far it goes (assume: {agent} never at …), or let robots have another way"
    return f"{prevents}: {change}"


def _won_ideally(network: Network, objective: Objective, options: SolveOptions) -> bool:
    """True if the ideal game is known to be won; that it is not decided with so much work changes no verdict."""
    limits = replace(options.limits.chosen, work=_FOR_IDEAL, states=_IDEAL_STATES)
    try:
        return solve(network, objective, engine=options.engine, limits=limits, progress=options.progress).won
    except PursueError:
        return False
