"""From a request to its answer: a proven plan from where a mission is, or why there is none."""

from __future__ import annotations

import time
from contextlib import suppress
from dataclasses import replace
from fractions import Fraction
from functools import partial
from math import ceil
from typing import AbstractSet, Any, Callable, Dict, Iterator, Mapping, Optional, Sequence

from pursue_gen.diagnostics import PursueError
from pursue_gen.language.document import statement_text
from pursue_gen.language.network_names import AT_RISK
from pursue_gen.language.scenario import Scenario, StatedObjective
from pursue_gen.language.written_orders import NoOrder
from pursue_gen.outcomes import LimitHit, NotProven
from pursue_gen.partition import partition
from pursue_gen.partition.split import UI
from pursue_gen.partition.strategy_data import cover_data, strategy_data
from pursue_gen.proof.checker import LIMIT
from pursue_gen.proof.worst_case import counting_clock, worst_case
from pursue_gen.solving.due_moves import patrols
from pursue_gen.solving.efforts import EFFORTS, Effort
from pursue_gen.solving.group_games import Group
from pursue_gen.solving.lost_promises import has_promises
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.proving import prove
from pursue_gen.solving.rules import played
from pursue_gen.solving.shares import Known, SharesSearch, can_be_shared, won_in_shares
from pursue_gen.solving.subgoals import commanded_agents
from pursue_gen.solving.tours import PATROL
from pursue_gen.solving.tours_again import is_too_much
from pursue_gen.solving.without_pauses import verdict_of, won_without_pauses
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.limits import Limits, careful_memory
from pursue_gen.synthesis.solve import Verdict, solve
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Network, Objective
from pursue_gen.tga.objectives import clock_of, stated
from pursue_gen.tga.pauses import pauses
from pursue_gen.tools.replanning.out_of_service import drawn_in, kept_no_more
from pursue_gen.tools.replanning.request import Request, read_request
from pursue_gen.tools.replanning.start import around, network_from, passed_bounds, start_clocks
from pursue_gen.tools.replanning.tours import followers, tours_from_here
from pursue_gen.tools.replanning.waiting import sooner
from pursue_gen.tools.replanning.written import additions, as_written, with_asked
from pursue_runtime.observer.ordering import Refused
from pursue_runtime.sentences import marked, quoted

_LITTLE = 100_000_000
"""The work of a search that is not for the game as it is alone: some five seconds. Not measured."""


_COUNTED = 200_000_000
"""The same where states are counted, so that no search lasts for minutes. Measured on simulated orders with faults."""

_FOR_AN_ORDER = 20_000_000
"""The work of each search for an order of a person, who waits: about a second. Not measured."""

_FEW = 2_000
"""Where many places are patrolled only so many states are looked at if states are counted: each takes long. Measured on
a patrol of six rooms by two robots."""


_ENOUGH = " within the limits of a search"
"""What is said where a search has done all the work that it may do."""

_MOMENTS = ((1, 10), (1, 2), (0, 10), (0, 2), (0, Fraction(1, 2)))
"""When a plan may come into force for its time to be known, tried in this order: as a share of `ahead` before it
begins, and time units after that. Not measured."""

_STATES = 500
"""Symbolic states of the checker that tell this time: some hundredths of a second. Not measured."""


def replan(data: Mapping[str, Any], states: int = 0) -> Dict[str, Any]:
    """The answer to a request, both as JSON holds them (see docs/run_time.md).

    Where an order of a person cannot be promised so soon, it says what could be: `possible`.
    `states`: limits the work to so many discrete states for the solver and as many symbolic ones for each look of the
    checker, in the place of time and memory, so that the answer does not depend on the machine; 0: it may depend.
    Every plan in an answer has been proven by the checker. Raises PursueError (exit status 2) for a request that cannot
    be used.
    """
    return answer_to(read_request(data), states, time.monotonic())


def answer_to(request: Request, states: int = 0, begun: Optional[float] = None) -> Dict[str, Any]:
    """The same for a request that was read; `begun`: when that began, on the monotonic clock, now by default."""
    start = time.monotonic() if begun is None else begun
    limits = Limits(states=states) if states else Limits(request.seconds, careful_memory(), wall=True).since(start)
    limits = replace(limits, work=_FOR_AN_ORDER if request.window else _COUNTED if states else 0)
    try:
        there = with_asked(request)
        answer = _answer(there, limits, states)
        if answer["won"]:
            return {**answer, "adds": additions(there)} if there.written else answer
        whole = with_asked(request, longer=True)  # what may take longer, else the request itself
    except (NoOrder, Refused) as problem:
        return _lost(str(problem))
    if any(whole.sooner.values()):
        later = longer(whole, lambda more: bool(_answer(more, limits.since(start), states)["won"]))
        return {**answer, **({} if later is None else {"possible": later})}
    return answer


def _answer(request: Request, limits: Limits, states: int) -> Dict[str, Any]:
    """The answer to a request within these limits, `states` as for `replan`."""
    ideal, objective = translate(request.scenario), scenario_objective(request.scenario)
    try:
        game = played(ideal, request.rules)
    except PursueError as problem:  # a slack that is none
        raise PursueError(problem.diagnostics) from None
    network = network_from(game, request, told_apart=bool(request.awaited))
    reason = _reason_lost(network, objective, request.scenario)
    reason = reason or drawn_in(network.automata, request.scenario, request.out_of_service)
    if reason:
        return _lost(reason)
    own = followers(game, request)
    start, little = limits.now(), min(limits.work or _LITTLE, _LITTLE)
    options = SolveOptions(limits)
    try:
        on = tours_from_here(game, objective, own, request, options)
        if on is not None:
            return _won(*on, request, None)
        clocks = start_clocks(network, request)
        if is_too_much(network, objective, request.rules.reaction, clocks, request.excused | request.out_of_service):
            return _lost(_cannot_be_met(game, request, network, limits.since(start)))
        many = _patrolled(game, objective)
        if many and len(many) == len(objective.bad):  # nothing in between does better than tours
            most = replace(limits, states=min(states, _FEW))
            verdict = solve(network, objective, request.rules.reaction, limits=most.since(start))
        elif many and own.tours and states:  # the same beside other promises: each game takes long there
            return _undecided(game, request, network, limits.since(start), _at_limit(limits))
        else:
            shared = _won_in_shares(network, objective, request, options, little)
            if shared is not None:
                return _won(shared, network, request, None)
            free = won_without_pauses(network, objective, request.rules.reaction, little, options, states or LIMIT)
            if free is None and has_promises(objective):
                limited = replace(options, limits=replace(options.limits, work=little))
                free = won_in_shares(network, objective, request.rules.reaction, limited)
            if free is not None:
                return _won(free.strategy, network, request, None if states else objective)
            verdict = _verdict(network, objective, request.rules.reaction, limits.since(start))
        if verdict.strategy is None:
            return _lost(_cannot_be_met(game, request, network, limits.since(start)))
        left = SolveOptions(limits.since(start))
        strategy = prove(
            network, objective, verdict.strategy, request.rules.reaction, verdict.ranks, left, states=states or LIMIT,
            otherwise=verdict.cautious,
        )  # fmt: skip
        if request.awaited:
            strategy = sooner(strategy, network, objective, request.rules.reaction, limits.since(start))
    except NotProven as problem:
        return _lost(f"the plan that was found is not proven: {quoted(str(problem))}")
    except PursueError as problem:
        at_work = _ENOUGH if limits.work and isinstance(problem, LimitHit) else ""
        why = _at_limit(limits.since(start)) or at_work or f": {problem.diagnostics[0].message}"
        return _undecided(game, request, network, limits.since(start), quoted(why))
    return _won(strategy, network, request, None if states else objective)


def _won_in_shares(
    network: Network, objective: Objective, request: Request, options: SolveOptions, work: int
) -> Optional[Strategy]:
    """A proven strategy in shares that so much work finds; None where it finds none. For an order they are shared out
    as before if that wins, and little effort finds nothing else; as before at first where nothing is to be sooner: who
    leaves or joins moves but the promises of one robot."""
    if not can_be_shared(network, objective):
        return None
    limited, known = replace(options, limits=replace(options.limits, work=work)), Known()
    search = partial(won_in_shares, network, objective, request.rules.reaction, limited, known=known)
    before = partial(shared_as_before, network, objective, request, options, known)
    strategy = before() if request.window and not request.sooner else None
    found = search(EFFORTS[:1]) if strategy is None else None
    strategy = strategy if found is None else found.strategy
    if strategy is None and request.sooner:
        strategy = before()
    if strategy is not None:
        return strategy
    found = search(EFFORTS[1:])
    return None if found is None else found.strategy


def _patrolled(game: Network, objective: Objective) -> AbstractSet[str]:
    """The automata of patrols where so many places are to be visited that tours are looked for first; else none."""
    names = {name for name, _ in objective.bad} & patrols(game)
    return names if not objective.reaches and len(names) >= PATROL else frozenset()


def _verdict(network: Network, objective: Objective, reaction: Fraction, limits: Limits) -> Verdict:
    """The verdict; where agents rest between calls, first with so much work in the ways that may be less."""
    start = limits.now()
    if pauses(network):
        try:
            return verdict_of(Budget(replace(limits, work=limits.work or _LITTLE)), network, objective, reaction)
        except LimitHit:
            pass
    return solve(network, objective, reaction, limits=limits.since(start))


def _won(strategy: Strategy, network: Network, request: Request, timed: Optional[Objective]) -> Dict[str, Any]:
    """The answer; `timed`: the objective whose time is to be found out, None: none is."""
    subs = partition(strategy, network, request.scenario.agents, request.controllers, request.reach_obj)
    data = {sub.controller: strategy_data(sub, request.rules.reaction) for sub in subs}
    people = data.pop(UI, None)
    answer = {"format": 1, "won": True, "strategies": data, "people": people, "cover": cover_data(strategy)}
    takes = None if timed is None else _takes(strategy, network, timed, request)
    answer = answer if takes is None else {**answer, "takes": takes}
    return {**answer, "turning": sorted(request.turning)} if request.turning else answer


def _takes(strategy: Strategy, network: Network, objective: Objective, request: Request) -> Optional[Dict[str, float]]:
    """In how many time units at most the plan comes to the goal, from when it comes into force on: if that is not
    `early` time units before its begin, nor `late` ones after. None where that is not quickly found out."""
    if request.turning or request.awaited:  # their clocks begin with the plan; it takes as long as these are late
        return None
    clock = counting_clock(network)
    for share, late in _MOMENTS:
        early = share * request.ahead
        there = replace(network, start=around(network.start, early, Fraction(late)))
        most = worst_case(there, objective, strategy, request.rules.reaction, _STATES)
        if most is not None:
            begun = start_clocks(network, request)[clock] - early if clock is not None else Fraction(0)
            return {"most": ceil((most - begun) * 1000) / 1000, "early": float(early), "late": float(late)}
    return None


def _at_limit(limits: Limits) -> str:
    """Which limit of the request has ended the search; "" for others."""
    if limits.states:
        return _ENOUGH
    return f" within {limits.seconds:g} s" if 0 < limits.seconds <= limits.spent else ""


def _lost(why: str) -> Dict[str, Any]:
    return {"format": 1, "won": False, "why": why}


def _reason_lost(network: Network, objective: Objective, scenario: Scenario) -> str:
    """Why the mission is lost already; "" if it is not."""
    places = {(automaton.name, automaton.initial) for automaton in network.automata}
    if objective.goal and set(objective.goal) <= places:
        return ""
    broken = next((place for place in objective.bad if place in places), None)
    if broken is None:
        return ""
    missed = stated(scenario).get(broken[0])
    return f"the mission is lost already: {_objectives(scenario, [missed] if missed else None)} is broken"


def _leaves(request: Request) -> bool:
    """True where a robot is to go out of service, and all that is promised is to be kept without it."""
    return bool(request.window and request.out_of_service and not request.sooner)


def _undecided(game: Network, request: Request, network: Network, limits: Limits, why: str) -> Dict[str, Any]:
    """The answer where no plan was found; for a robot that is to leave with an objective that is lost by itself, as far
    as very little work finds one."""
    what = f"no plan was found{why}"
    return _lost(_cannot_be_met(game, request, network, limits, what) if _leaves(request) else what)


def _cannot_be_met(game: Network, request: Request, network: Network, limits: Limits, undecided: str = "") -> str:
    """One sentence: the objective that cannot be guaranteed from here, and the agents on which it depends; or
    `undecided`, where that is given and no objective is known to be lost by itself."""
    clocks = start_clocks(game, request)
    agents = [*(agent.name for agent in request.scenario.agents), *request.scenario.facts]
    over = [each.name for each in game.automata if passed_bounds(each, request.locations[each.name], clocks)]
    for name in over:
        if name not in agents:
            missed = stated(request.scenario).get(name)
            what = as_written(_objectives(request.scenario, [missed] if missed else None), request)
            return f"{what} cannot be met any more: its time is over"
    absent = [name for name in agents if name in request.excused or (name in over and name not in request.awaited)]
    without = [f"without relying on {' and '.join(map(marked, absent))}"] if absent else []
    for a, b, *alone in sorted(request.blocked):
        for_whom = "".join(f" for {marked(name)}" for name in alone)
        without.append(f"without the way between {marked(a)} and {marked(b)}{for_whom}")
    without += [f"while {marked(name)} is out of service" for name in sorted(request.out_of_service)]
    ordered = [each for name, each in stated(request.scenario).items() if clock_of(name) in request.sooner]
    if _leaves(request):
        objective, reaction = scenario_objective(request.scenario), request.rules.reaction
        lost = kept_no_more(network, objective, request.scenario, reaction, limits, bool(undecided))
        what = undecided if undecided and not lost else f"{_objectives(request.scenario, lost)} cannot be kept"
    elif request.window:
        asked = as_written(_objectives(request.scenario, ordered), request)
        what = f"{asked} cannot be promised beside all that is promised already"
    else:
        what = f"{_objectives(request.scenario)} cannot be guaranteed from here"
    return " ".join([what, " and ".join(without)]).strip()


def _objectives(scenario: Scenario, some: Optional[Sequence[StatedObjective]] = None) -> str:
    """What is to be met, or these of it, in the author's words."""
    spans = dict.fromkeys(part.span for part in some or (*scenario.reach, *scenario.safety))
    return " and ".join(f"'{quoted(statement_text(scenario.text, span))}'" for span in spans)


_SHARES_WORK, _SHARES_GAME = 10_000_000, 4_000_000
"""The work of promises shared out as before at most, and of each of their games. Measured on an order in a ward with
two robots."""


def shared_as_before(
    network: Network, objective: Objective, request: Request, options: SolveOptions, known: Known
) -> Optional[Strategy]:
    """A proven strategy in such shares that little work finds; None where it finds none. `known`: what that found."""
    groups = tuple(_groups(network, objective, request))
    if not groups:
        return None
    effort = Effort(_SHARES_WORK, game=_SHARES_GAME, guess=_SHARES_GAME // 4, joins=False)
    with suppress(LimitHit):
        return SharesSearch(network, objective, request.rules.reaction, options, effort, known).found(groups)
    return None


def _groups(network: Network, objective: Objective, request: Request) -> Iterator[Group]:
    """Those of the shares, without what nobody has seen to so far and is asked for now."""
    robots = commanded_agents(network)
    asked = {automaton.name for automaton in network.automata if automaton.initial == AT_RISK}
    ordered = {name for name in asked if clock_of(name) in request.sooner}
    for sent, keeps in request.shares:
        team = sent.intersection(robots)
        mine = keeps - (ordered if team else asked)
        bad = tuple(place for place in objective.bad if place[0] in mine)
        if bad:
            yield Group(team, bad)


_HALVINGS = 6
"""How often the time is halved in which an order could be promised: each step is a search. Not measured."""


def longer(request: Request, is_won: Callable[[Request], bool]) -> Optional[float]:
    """How many time units later than it is wanted an order could be promised, rounded up to tenths; None: not at all,
    as far as it is known. A search for a request with that order is asked, at most 7 times."""
    most = max(request.sooner.values())
    if not is_won(_later(request, most)):
        return None
    least = Fraction(0)
    for _ in range(_HALVINGS):
        if most - least <= max(Fraction(1), most / 50):
            break
        middle = (least + most) / 2
        if is_won(_later(request, middle)):
            most = middle
        else:
            least = middle
    return float(-(-most * 10 // 1) / 10)


def _later(request: Request, by: Fraction) -> Request:
    """The request with an order that may be answered later, but no later than the scenario promises."""
    clocks = dict(request.clocks)
    for name, ahead in request.sooner.items():
        if name in clocks:
            clocks[name] = max(Fraction(0), clocks[name] - min(ahead, by))
    return replace(request, clocks=clocks)
