"""Which system states can be used: everything that a model or a strategy reads is there, with values that exist.

Each function returns what is wrong, in words, or "".
"""

from __future__ import annotations

import math
from typing import Any, Collection, Mapping, Sequence

from pursue_runtime.data import DataError
from pursue_runtime.model import Model
from pursue_runtime.state import LISTS, LIVE, STATUSES, SystemState
from pursue_runtime.strategy import Strategy

MAX_NAMES = 10000
"""The most automata, variables or clocks of a state."""


def names_problem(what: str, names: Sequence[str]) -> str:
    """Return what is wrong with the names of automata, variables or clocks."""
    if len(names) > MAX_NAMES:
        return f"it has {len(names)} {what}; expected at most {MAX_NAMES}"
    return "" if len(set(names)) == len(names) else f"its {what} have names that are not all different"


def state_problem(state: SystemState) -> str:
    """Return why no observer publishes such a state."""
    if state.status not in STATUSES:
        return f"status is {state.status!r}; expected one of {', '.join(STATUSES)}"
    if not 0.0 < state.unit < math.inf:
        return f"time_unit is {state.unit!r}; expected a number of seconds greater than 0"
    if not math.isfinite(state.stamp):
        return f"stamp is {state.stamp!r}; expected a number of seconds"
    if state.status in LIVE and (state.seq < 1 or not state.locations):
        return f"it is {state.status}, with number {state.seq} and {len(state.locations)} automata"
    wrong = [f"{clock} is {value!r}" for clock, value in state.clocks.items() if not math.isfinite(value)]
    return f"{wrong[0]}; expected a number of time units" if wrong else ""


def model_problem(model: Model, state: SystemState) -> str:
    """Return why a state cannot be one of this model."""
    automata = {automaton.name: automaton for automaton in model.automata}
    for what, names, found in (
        ("automata", automata, state.locations),
        ("variables", model.variables, state.values),
        ("clocks", model.clocks, state.clocks),
    ):
        differs = sorted(set(names) ^ set(found))
        if differs:
            return f"its {what} are not those of the model: {', '.join(differs[:5])}"
    for name, location in state.locations.items():
        if location not in automata[name].invariants:
            return f"{name} has no location {location!r}"
    return state_problem(state)


def adoptable(fields: Mapping[str, Any], model: Model, unit: float, plan: int) -> SystemState:
    """Return the state with these fields (`_asdict`, perhaps from JSON) if a mission can continue from it.

    `unit` (seconds) and `plan` are those of the mission. Raises DataError.
    """
    try:
        state = SystemState(**{**fields, **{key: tuple(fields[key]) for key in LISTS}})
        problem = model_problem(model, state)
    except (KeyError, TypeError, AttributeError) as cause:
        raise DataError(f"not a state: {cause!r}") from cause
    if state.unit != unit:
        problem = problem or f"its time unit is {state.unit:g} s, and ours {unit:g} s"
    if state.plan != plan:
        problem = problem or f"plan {state.plan} is in force in it, and plan {plan} in the journal"
    if problem:
        raise DataError(problem)
    return state


def strategy_problem(strategy: Strategy, state: SystemState) -> str:
    """Return why a strategy cannot decide in a state: an automaton, variable or clock that it reads is not there."""
    missing = _missing(strategy.names, [*state.locations, *state.values]) or _missing(strategy.clocks, state.clocks)
    return f"it lacks {missing}, which the strategy reads" if missing else ""


def _missing(wanted: Collection[str], found: Collection[str]) -> str:
    return ", ".join(sorted(set(wanted) - set(found))[:5])
