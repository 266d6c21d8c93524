"""What makes a scenario too large to be decided, and what is decided of it.

All is solved with more time (see `offers`). Of several objectives each is solved alone, then several together (see
`decided`), then all in cheaper forms (see `offers`). Then parts are left out, each alone, and where there is one
objective, several together. Each smaller scenario is solved with a share of a fixed budget of work, the one that seems
smallest first.
"""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from typing import Any, Dict, List, Optional, Sequence, Tuple

from pursue_gen.diagnostics import listed
from pursue_gen.explanation.ablations import Part, without_each
from pursue_gen.explanation.decided import Decided, decided, texts
from pursue_gen.explanation.decided import as_json as decided_json
from pursue_gen.explanation.offers import Form, Longer, cheaper, longer
from pursue_gen.explanation.part import game_of
from pursue_gen.language.scenario import Scenario
from pursue_gen.outcomes import LimitHit
from pursue_gen.solving.rules import Rules
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.cone import cone_of_influence
from pursue_gen.synthesis.enforced import enforced
from pursue_gen.synthesis.limits import EXPLAINING, NO_LIMITS, Limits, Listener, memory_in_use
from pursue_gen.tga.network import Network, Objective
from pursue_gen.thresholds import narrowed

WORK, STATES = 100_000_000, 100_000
"""The work of all games together, and the discrete states of each: ten seconds or so. Not measured."""

SECONDS, _LONGER = 8.0, 0.55
"""Of processor time for all games, as somebody has waited already; the part for more time. Not measured."""

ROOM = 64
"""MiB beside what is in use before. Not measured."""

_OPTION, _OBJECTIVES, _FORMS, _ALONE, _EACH = 0.3, 0.5, 0.5, 0.5, 0.5
"""The part of the work for the scenario without an option; of the rest for single objectives and some of them; of the
then rest for cheaper forms of these; of what is left for parts that are left out alone; and of the then rest for each
attempt without several of them. Not measured."""

_SHOWN, _SEVERAL = 5, 3
"""So many parts are named at most, and so many that are left out together. Not measured."""

_Game = Tuple[Network, Objective]


@dataclass(frozen=True)
class Cost:
    """Without these parts together the scenario is decided: whether it is won, discrete states, seconds, and work."""

    without: Tuple[str, ...]
    won: bool
    states: int
    seconds: float
    work: int


@dataclass(frozen=True)
class Costs:
    """What is decided, the least work first; the parts without which, each alone, the scenario is not decided.

    `objectives`: what is decided of several objectives; None where there is one. `cheaper`: forms of statements with
    which all is won. `longer`: the limits with which all is won, where there are any.
    """

    decided: Tuple[Cost, ...]
    undecided: Tuple[str, ...]
    objectives: Optional[Decided] = None
    cheaper: Tuple[Form, ...] = ()
    longer: Tuple[Longer, ...] = ()


def costs(
    scenario: Scenario,
    rules: Rules,
    limits: Limits = NO_LIMITS,
    progress: Optional[Listener] = None,
    option: str = "",
) -> Costs:
    """Solves a scenario that was not decided without some of its parts.

    `option`: what else was asked for; where the whole scenario is decided without that, nothing else is tried.

    Within WORK and STATES, within SECONDS, or fewer if somebody has set a limit, and within the limit on memory, of
    which there are ROOM at least.
    """
    seconds = min(SECONDS, limits.chosen.left or SECONDS)
    memory = limits.memory and max(limits.memory, memory_in_use() + ROOM)
    few = replace(limits.chosen, seconds=seconds, spent=0.0, memory=memory, states=STATES, work=WORK)
    budget = Budget(few, progress, phase=EXPLAINING)
    found: List[Cost] = []
    undecided: List[Part] = []
    objectives: Optional[Decided] = None
    forms: List[Form] = []
    more: Tuple[Longer, ...] = ()
    with suppress(LimitHit), enforced(few, EXPLAINING):
        if option:
            cost = _cost((option,), game_of(scenario, rules), rules, budget, _OPTION)
            if cost is not None:
                return Costs((cost,), ())
        more = longer(scenario, rules, Limits(_LONGER * seconds, memory), progress)
        objectives = decided(scenario, rules, budget.split(_OBJECTIVES))
        if objectives is not None and objectives.following:
            for form in cheaper(scenario, rules, budget.split(_FORMS), objectives.following.line):
                forms.append(form)  # at once: a limit may end the search
        found, undecided = _alone(scenario, rules, budget.split(_ALONE), objectives is None)
        if not found and objectives is None:
            found = _together(scenario, undecided, rules, budget)
    return Costs(tuple(found), tuple(part.name for part in undecided), objectives, tuple(forms), more)


def in_words(found: Costs) -> str:
    """The costs in sentences, a line for each that is decided; empty where nothing is known."""
    lines = ["All is won with more time:", *(each.in_words() for each in found.longer)] if found.longer else []
    lines += [] if found.objectives is None else texts(found.objectives)
    lines += [form.in_words() for form in found.cheaper]
    return "\n".join([*lines, *filter(None, [_left_out(found)])])


def _left_out(found: Costs) -> str:
    """What is decided without parts of the scenario."""
    some = [cost for cost in found.decided if len(cost.without) <= _SEVERAL]
    undecided = " or ".join(found.undecided[:_SHOWN])
    if len(found.undecided) > _SHOWN:
        undecided += f" or one of {len(found.undecided) - _SHOWN} more"
    if not some:
        said = undecided and found.objectives is None
        return f"Too large without {undecided}, and without all of them." if said else ""
    shown = "; ".join(f"without {_listed(cost.without)} it is decided {_took(cost)}" for cost in some[:_SHOWN])
    if len(some[0].without) > 1:
        return f"W{shown[1:]}. Without one of these alone it is too large."
    still = f" Still too large without {undecided}." if undecided and found.objectives is None else ""
    return f"W{shown[1:]}.{still}"


def as_json(found: Costs) -> Dict[str, Any]:
    """The costs as a JSON object."""
    objectives = {} if found.objectives is None else {"objectives": decided_json(found.objectives)}
    forms = {"cheaper": [asdict(form) for form in found.cheaper]} if found.cheaper else {}
    more = {"longer": [{**asdict(each), "asked": float(each.asked)} for each in found.longer]} if found.longer else {}
    decided_ones = [asdict(cost) for cost in found.decided]
    return {"decided": decided_ones, "undecided": list(found.undecided), **objectives, **forms, **more}


def _alone(scenario: Scenario, rules: Rules, budget: Budget, objectives: bool) -> Tuple[List[Cost], List[Part]]:
    """What is decided without one part that matters, and the parts without which it is not; the smallest game first."""
    parts = list(without_each(scenario, objectives))
    sizes, whole = [_size(*game_of(smaller, rules)) for _, smaller in parts], _size(*game_of(scenario, rules))
    lesser = [parts[k] for k in sorted(range(len(parts)), key=lambda k: sizes[k]) if sizes[k] < whole]
    found: List[Cost] = []
    undecided: List[Part] = []
    for k, (part, smaller) in enumerate(lesser):
        cost = _cost((part.name,), game_of(smaller, rules), rules, budget, 1 / (len(lesser) - k))
        if cost is None:
            undecided.append(part)
        else:
            found.append(cost)
    return sorted(found, key=lambda cost: cost.work), undecided


def _together(scenario: Scenario, parts: Sequence[Part], rules: Rules, budget: Budget) -> List[Cost]:
    """What is decided without several parts, as few of them as are found (the first ones); empty if nothing is."""
    lesser = _without_several(scenario, parts)
    known: Dict[int, Cost] = {}

    def decided(k: int) -> bool:
        without, smaller = lesser[k]
        cost = _cost(without, game_of(smaller, rules), rules, budget, _EACH)
        known.update({} if cost is None else {k: cost})
        return cost is not None

    last = len(lesser) - 1
    return [known[narrowed(-1, last, decided)[1]]] if lesser and decided(last) else []


def _without_several(scenario: Scenario, parts: Sequence[Part]) -> List[Tuple[Tuple[str, ...], Scenario]]:
    """The scenario without the first two parts, without the first three, and so on."""
    found: List[Tuple[Tuple[str, ...], Scenario]] = []
    without: Tuple[str, ...] = ()
    for part in parts:
        smaller = part.left_out(scenario)
        if smaller is None or smaller == scenario:  # it is needed now, or has gone with another part
            continue
        scenario, without = smaller, (*without, part.name)
        found.append((without, scenario))
    return found[1:]





def _size(network: Network, objective: Objective) -> int:
    """Combinations of locations, and of two values for each variable: a rough guess at how large the game is."""
    part = cone_of_influence(network, objective)
    return math.prod(len(automaton.locations) for automaton in part.automata) << len(part.variables)


def _cost(without: Tuple[str, ...], game: _Game, rules: Rules, budget: Budget, share: float) -> Optional[Cost]:
    """What it takes to decide a game with that share of the budget; None: it is not decided."""
    before = budget.work
    try:
        verdict = budget.verdict(*game, rules.reaction, share)
    except LimitHit:
        return None
    stats = verdict.stats
    return Cost(without, verdict.won, stats.discrete_states, round(stats.seconds, 3), int(before - budget.work))


def _listed(names: Sequence[str]) -> str:
    return listed(names) + " together" * (len(names) > 1)


def _took(cost: Cost) -> str:
    return f"in {cost.seconds:.1f} s ({'won' if cost.won else 'lost'}, {cost.states} states)"
