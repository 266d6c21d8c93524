"""Promises that cannot be kept even where nothing else is wanted: alone, or two that exclude each other.

With fewer promises the controller has less to do, so a loss of these is a loss of all. It is looked for in games in
which the environment has fewer moves, none of which it is ever obliged to make: what it wins so it wins. (Games with
hidden agents, which have more moves than there are, say nothing about a loss.)
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import combinations, islice
from typing import Dict, Iterable, List, Optional, Sequence, Tuple

from pursue_gen.diagnostics import listed
from pursue_gen.language.scenario import Scenario, StatedObjective
from pursue_gen.outcomes import LimitHit, Lost
from pursue_gen.solving.freer import standing, with_one_walk, without_turns
from pursue_gen.solving.options import SolveOptions
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.limits import Limits, Listener
from pursue_gen.tga.apart import without_pauses
from pursue_gen.tga.ends import is_agent
from pursue_gen.tga.network import Network, Objective
from pursue_gen.tga.objectives import stated
from pursue_gen.tga.part import part_of
from pursue_gen.tga.pauses import acting_at_most

WORK = 60_000_000
"""The work that is spent on all games of one or two promises. Not measured."""

_ALONE, _SHARE = 0.5, 0.05
"""The part of it for those of one, and the part of what is left that one game gets. Not measured."""

_STATES = 20_000
"""So many discrete states it may have. Not measured."""

_WALK, _WALK_STATES = 3_000_000, 60_000
"""The work of all games in which one person walks at once, and the discrete states of each. Measured on errands beside
a visitor."""

_QUICK, _QUICK_GAME, _FEW_STATES = 6_000_000, 1_000_000, 4000
"""The work of all games of single promises that are tried first, that of each, and its states. Not measured."""


def promises(objective: Objective) -> Tuple[Objective, ...]:
    """What the objective asks for, each alone: a place to be avoided, or one to be reached, in its own time."""
    if not objective.reaches:
        return tuple(Objective.of((), [place]) for place in objective.bad)
    late = {goal: [place for place in objective.bad if place[0] == goal[0]] for goal in objective.goal}
    return tuple(Objective.of([goal], bad) for goal, bad in late.items())


def has_promises(objective: Objective) -> bool:
    """True for a goal beside promises that are to be kept until it is reached."""
    return objective.reaches and not {name for name, _ in objective.bad} <= dict(objective.goal).keys()


def lost_alone(
    network: Network, objective: Objective, reaction: Fraction, options: SolveOptions
) -> Tuple[Objective, ...]:
    """The promises that are lost alone, as far as very little work finds that."""
    budget = Budget(replace(options.limits, work=_QUICK, states=_FEW_STATES), options.progress, options.engine)
    found: List[Objective] = []
    for wanted in promises(objective):
        game = _games(only_promises(network, objective, wanted), wanted)[0]
        if _won(game, wanted, reaction, budget, _QUICK_GAME / max(_QUICK_GAME, budget.work)) is False:
            found.append(wanted)
    return tuple(found)


def lost_promises(
    network: Network, objective: Objective, reaction: Fraction, options: SolveOptions
) -> Tuple[Objective, ...]:
    """The promises that are lost alone; where there are none, two that are lost together, or one beside the goal; ()
    where little work finds none of these."""
    budget = Budget(replace(options.limits, work=WORK, states=_STATES), options.progress, options.engine)
    single, some = promises(objective), budget.split(_ALONE)
    alone = tuple(wanted for wanted in single if _is_lost(network, objective, wanted, reaction, some))
    if alone or (len(single) < 3 and not has_promises(objective)):
        return alone
    pairs = [Objective.of((*a.goal, *b.goal), (*a.bad, *b.bad)) for a, b in combinations(single, 2)]
    beside = [place for place in objective.bad if objective.goal and place[0] not in dict(objective.goal)]
    pairs += [Objective.of(wanted.goal, (*wanted.bad, place)) for wanted in single for place in beside]
    lost = (wanted for wanted in pairs if _is_lost(network, objective, wanted, reaction, budget))
    return tuple(islice(lost, 1))


def lost_to_one_walk(
    game: Network, objective: Objective, reaction: Fraction, limits: Limits, progress: Optional[Listener] = None
) -> Optional[Network]:
    """A game in which somebody whom nobody controls wins by going to one place at once, and staying there; None where
    little work finds none."""
    budget = Budget(replace(limits, work=_WALK, states=_WALK_STATES), progress)
    walks = (acting_at_most(w, objective, 1) for w in with_one_walk(game, watched(objective), hurried=True))
    return next((walk for walk in walks if _won(walk, objective, reaction, budget, 1.0) is False), None)


def _is_lost(network: Network, objective: Objective, wanted: Objective, reaction: Fraction, budget: Budget) -> bool:
    """True if this part of the objective is known to be lost."""
    game = only_promises(network, objective, wanted)
    for part in _games(game, wanted):
        won = _won(part, wanted, reaction, budget, _SHARE)
        if won is False:
            return True
        if won and part == game:
            return False
    return False


def _won(game: Network, wanted: Objective, reaction: Fraction, budget: Budget, share: float) -> Optional[bool]:
    """Whether it is won; None: that is not decided with that share of what is left of the budget."""
    try:
        return budget.verdict(game, wanted, reaction, share).won
    except LimitHit:
        return None


def _games(game: Network, wanted: Objective) -> Sequence[Network]:
    """Games of these promises that are no harder for the controller, small ones first, then the game itself."""
    freer = without_turns(game, watched(wanted))
    found = []
    for some in (freer, game):
        found += [acting_at_most(standing(some), wanted, 1)]
        found += [acting_at_most(walk, wanted, 1) for walk in with_one_walk(some, watched(wanted))]
        found += [acting_at_most(some, wanted, 1), some]
    return tuple(dict.fromkeys(found))


def only_promises(network: Network, objective: Objective, wanted: Objective) -> Network:
    """The network without the automata of other parts of the objective, and without their pauses. These automata only
    watch, and stop time where they are broken."""
    kept = {name for name, _ in (*wanted.goal, *wanted.bad)}
    others = {name for name, _ in (*objective.goal, *objective.bad)} - kept
    some = {a.name for a in network.automata if a.name not in others or is_agent(a) or a.assigned}
    return part_of(without_pauses(network, others), some)


def watched(wanted: Objective) -> Tuple[str, ...]:
    """The automata that watch what is wanted."""
    return tuple(dict.fromkeys(name for name, _ in (*wanted.goal, *wanted.bad)))


def cannot_be_promised(names: Iterable[str]) -> str:
    """That these cannot be promised, even if nothing else is."""
    some = tuple(dict.fromkeys(names))
    return f"{listed(some)} cannot be promised{' together' if len(some) > 1 else ''}, even if nothing else is"


def in_words(problem: Lost, scenario: Scenario) -> Lost:
    """The error with the scenario's statements, and their places, in place of the automata that watch them; each once,
    where several automata watch one."""
    objectives = stated(scenario)
    if not problem.parts:
        return problem
    parts: Dict[Tuple[str, ...], Tuple[str, ...]] = {}
    findings = []
    for finding, names in zip(problem.diagnostics, problem.parts):
        some = [objectives[name] for name in names]
        said = quoted(some)
        if said not in parts:
            message = cannot_be_promised(said) + finding.message[len(cannot_be_promised(names)) :]
            findings.append(replace(finding, message=message, span=some[0].span))
        parts.setdefault(said, names)
    return Lost(findings, tuple(parts.values()))


def quoted(objectives: Sequence[StatedObjective]) -> Tuple[str, ...]:
    """Objectives as they are written, with their lines: one of several in a line is named behind the last of these."""
    lines = {f'"{each.text}"': each.span.line for each in objectives}
    behind = [*list(lines.values())[1:], 0]
    return tuple(text + f" (line {line})" * (line != after) for (text, line), after in zip(lines.items(), behind))
