"""Which received states count for a node: those of its mission, in order of publication, that can be used: everything
that a model or a strategy reads is there, with values that exist.

Each `…_problem` returns what is wrong, in words, or "".
"""

from __future__ import annotations

import math
import time
from typing import Any, Callable, Collection, Mapping, Optional, Sequence

from pursue_runtime.data import DataError
from pursue_runtime.model import Model
from pursue_runtime.state import ENDED, LATE, LISTS, LIVE, STATUSES, WAITING, SystemState, older, rewinds
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


OURS, OLD, OTHER, OVER, REFUSED = "ours", "old", "other", "over", "refused"


class StateFilter:
    """Classifies received states for a node that has the data of `mission`.

    `own` is the id of the workspace's mission, which states need not name. Classes: OURS, a state of the node's
    mission; OLD, published before the newest one received; OTHER, of another mission; OVER, the end of a mission in
    which the node took no part, while it waits for the next one (`again`): a node that restarts after the end may
    still receive the latched state of that mission; REFUSED, one to which the mission cannot have come from the newest
    one, or that is none of this mission (`check` returns why, "" otherwise): nothing is changed, and `refused` says
    why until another state counts.

    Where only OLD states arrive for a minute (LATE, on the real `clock`), the observer's clock was set back: then
    `clock_set_back` is True, the state counts, and earlier states do not. The same holds where the observer waits for
    the start of a mission for a minute, and this node knows of one under way: it was cut off when that one ended. Had
    the observer lost a mission, it would have stopped when it learned what this node has seen.
    """

    def __init__(
        self, mission: str, own: str, again: bool = False, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self.mission = mission
        self.newest: Optional[SystemState] = None  # the newest state, of any mission
        self.joined = False  # a state has been OURS
        self.clock_set_back = False  # the last state was the first one of an observer whose clock was set back
        self.refused = ""
        self.malformed = 0  # messages that were no states
        self.check: Callable[[SystemState], str] = lambda _: ""
        self._own, self._again, self._clock = own, again, clock
        self._received = clock()  # when the newest state was published, or published again

    def count_malformed(self) -> None:
        """Count a message that was no state."""
        self.malformed += 1

    def classify(self, state: SystemState) -> str:
        """Return the class of the state, and keep it if it is the newest."""
        ours = (state.mission or self._own) == self.mission
        problem = self.check(state) if ours else ""
        if problem:
            self.refused = f"a state of another model: {problem}"
            return REFUSED
        known, now = self.newest, self._clock()
        old = known is not None and older(state, known)
        rewound = known is not None and not old and rewinds(state, known)
        same = known is not None and not rewound and (state.mission, state.seq) == (known.mission, known.seq)
        late = now >= self._received + LATE and (old or state.status == WAITING)
        self.clock_set_back = (old or rewound) and not same and late
        if known is not None and rewound and not late:
            self.refused = f"state {state.seq}, after state {known.seq} of the same mission: the observer has lost it"
            return REFUSED
        if same or not old or self.clock_set_back:
            self._received = now
        if old and not self.clock_set_back:
            return OLD
        self.newest, self.refused = state, ""
        if not ours:
            return OTHER
        if state.status in ENDED and self._again and not self.joined:
            return OVER
        self.joined = True
        return OURS
