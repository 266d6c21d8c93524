"""What is to be achieved, what of it is achieved, and the time that the strategy guarantees, from ui.yaml.

Times are time units since the start of the mission.
"""

from __future__ import annotations

import math
from typing import Any, Dict, FrozenSet, List, Mapping, NamedTuple, Optional, Sequence, Tuple

from pursue_runtime.data import DataError, reading
from pursue_runtime.locations import breaks_off, is_end
from pursue_runtime.model import Model
from pursue_runtime.sentences import listed
from pursue_runtime.simulator.simulator import end_window
from pursue_runtime.state import HOLDING, LIVE, SystemState
from pursue_runtime.ui.statuses import Status, deadline

REACHED, KEPT, BROKEN, OPEN, NOT_PROMISED = "reached", "kept", "broken", "open", "not promised"
"""What has become of an objective: `open` is what is still to be reached, `kept` what has to hold until the end."""

TOLERANCE = 0.2
"""Time units by which an end may miss its window: clocks are those of several machines."""


class Objective(NamedTuple):
    """An objective as a sentence, and the automata that watch it; none where the mission does not promise it. `worst`:
    how late, in time units, the workspace's own strategy keeps it at worst; None where that is not known. `name`: a
    short one, which tells it from the others; "" where there is none."""

    says: str
    of: Tuple[str, ...]
    worst: Optional[float] = None
    name: str = ""

    def now(self, state: SystemState, counts: str = "") -> str:
        """The sentence, with that time while the workspace's own strategy is in force. `counts`: as in `Promise`."""
        if self.worst is None or state.plan:
            return self.says
        return f"{self.says} At worst after {f'{self.worst:g} {counts}'.rstrip()}."


class Promise(NamedTuple):
    """The objectives of a mission. `most`: in how many time units the workspace's own strategy comes to the goal at
    worst, if everybody keeps to the model; None where that is not known. `unneeded`: the agents that it never commands,
    and that nobody needs; `counts`: what times count, as in `seconds`, "" where the scenario does not say that."""

    objectives: Tuple[Objective, ...] = ()
    most: Optional[float] = None
    unneeded: Tuple[str, ...] = ()
    counts: str = ""


NOTHING = Promise()
"""Of a mission of which nothing is known."""


def read_promise(settings: Mapping[str, Any]) -> Promise:
    """The promise in ui.yaml; an empty one where it is of a version that had none. Raises DataError."""
    with reading("ui.yaml", "objectives, guarantee, counts or not_needed"):
        given = [_objective(each) for each in settings.get("objectives", ())]
        most = settings.get("guarantee")
        number = None if most is None else float(most)
        unneeded = tuple(map(str, settings.get("not_needed", ())))
        counts = str(settings.get("counts", ""))
    if number is not None and not (math.isfinite(number) and number >= 0):
        raise DataError(f"ui.yaml: guarantee is {most!r}; expected a number of time units")
    return Promise(tuple(given), number, unneeded, counts)


def _objective(data: Mapping[str, Any]) -> Objective:
    worst = data.get("worst")
    number = None if worst is None else float(worst)
    return Objective(str(data["says"]), tuple(map(str, data["of"])), number, str(data.get("name", "")))


def objectives_now(
    promise: Promise, statuses: Sequence[Status], model: Model, state: SystemState, at: float
) -> List[Dict[str, Any]]:
    """What has become of each objective in a state that began at `at`: its name and its sentence, one of the words
    above, what it is at, in words ("" where that says no more), when the first of what is due has to come (`due`), and
    how long that may take in all (`limit`; both None where nothing is due)."""
    found = []
    for objective in promise.objectives:
        own = [status for status in statuses if status.of in objective.of]
        texts = dict.fromkeys(status.text(state.locations, state.values) for status in own)
        become = _become(objective, model, state)
        now = [text for text in texts if text is not None and text != become]
        ends = [deadline(name, model, state, at) for name in objective.of] if become in (OPEN, KEPT) else []
        due = min((each for each in ends if each is not None), default=None)
        found.append({
            "name": objective.name, "says": objective.now(state, promise.counts), "is": become, "now": "; ".join(now),
            "due": None if due is None else round(due.moment, 3), "limit": None if due is None else due.limit,
        })  # fmt: skip
    return found


def with_written(promise: Promise, model: Model, state: SystemState) -> Promise:
    """The promise with what people have written and waits for its answer."""
    found = []
    for order in model.written:
        for automaton in model.of_kind("safety"):
            asks = any(edge.word == order.event and edge.sync == "receive" for edge in automaton.edges)
            if asks and automaton.invariants.get(state.locations.get(automaton.name, "")):
                found.append(Objective(model.shown(order.event), (automaton.name,)))
    return promise._replace(objectives=(*promise.objectives, *found)) if found else promise


def _become(objective: Objective, model: Model, state: SystemState) -> str:
    """What has become of an objective."""
    goals = {name for name, _ in model.goal} & {each.name for each in model.of_kind("reach")}
    there = {(name, state.locations.get(name, "")) for name in objective.of}
    if not objective.of:
        return NOT_PROMISED
    if there & set(model.bad):
        return BROKEN
    if all(name in goals for name in objective.of):
        return REACHED if there <= set(model.goal) else OPEN
    return KEPT


class PlanTime(NamedTuple):
    """In how many time units a new plan comes to the goal at most, if it comes into force between `first` and `last`
    (seconds, as stamps of states) and everybody but the agents in `excused` keeps to the model."""

    most: float
    first: float
    last: float
    excused: FrozenSet[str]


def read_plan_time(plan: Mapping[str, Any], unit: float) -> Optional[PlanTime]:
    """The time of a new plan, as `parse_plan` returns it, in time units of so many seconds; None where it says none."""
    takes: Any = plan.get("takes")
    try:
        most, early, late, stamp, ahead = (float(takes[key]) for key in ("most", "early", "late", "stamp", "ahead"))
        excused = frozenset(map(str, takes["excused"]))
    except (KeyError, TypeError, ValueError, OverflowError):
        return None
    begin = stamp + ahead * unit
    found = PlanTime(most, begin - early * unit, begin + late * unit, excused)
    return found if all(map(math.isfinite, found[:3])) else None


class Guarantee:
    """Whether the guaranteed time still holds: it is that of the workspace's own strategy from the start on, or that of
    a new plan from when it came into force, as long as everybody keeps to the model."""

    def __init__(self, promise: Promise, model: Model) -> None:
        self._own, self._most = promise.most, promise.most
        self._model = model
        self._last: Optional[SystemState] = None
        self._void = ""  # why it does not hold any more in this mission
        self._plans: Dict[int, Mapping[str, Any]] = {}
        self._excused: FrozenSet[str] = frozenset()  # who the plan does not rely on, and is not back yet
        self._broken: FrozenSet[str] = frozenset()  # assumptions on which it does not rely

    def add_plan(self, number: int, plan: Mapping[str, Any]) -> None:
        """Take a new plan, as `parse_plan` returns it."""
        self._plans[number] = plan

    def on_state(self, state: SystemState, at: float = 0.0) -> None:
        """A state came that began `at` time units after the start."""
        last, self._last = self._last, state
        if state.status not in LIVE or (last is not None and state.seq < last.seq):
            self._void, self._most, self._excused, self._broken = "", self._own, frozenset(), frozenset()
        elif last is None and state.seq > 1:
            self._void = "what happened before this page was served is not known"
            self._most = None if state.plan else self._own
        elif last is not None and state.plan != last.plan:
            self._take_up(state, at, is_next=state.seq <= last.seq + 1)
        if state.status in LIVE:
            self._void = self._void or self._reason(state, last)
            self._excused &= {*state.late, *state.lost}

    def _take_up(self, state: SystemState, at: float, is_next: bool) -> None:
        """Another plan is in force; `is_next`: since this state."""
        time = read_plan_time(self._plans.get(state.plan, {}), state.unit)
        known = time is not None and is_next and time.first <= state.stamp <= time.last
        self._most = at + time.most if time is not None and known else None
        self._excused = time.excused if time is not None else frozenset()
        self._broken = frozenset(self._assumptions(state))
        self._void = ""

    def _assumptions(self, state: SystemState) -> List[str]:
        """What was assumed, and has been broken."""
        return [each.says for each in self._model.assumptions if state.values.get(each.variable) == 0]

    def now(self, state: SystemState) -> Dict[str, Any]:
        """For the page: `most` (None: not known) and why it does not hold (`void`, "" if it does); empty where the
        mission has no goal."""
        if not self._model.goal:
            return {}
        if state.plan and (self._most is None or self._last is None or self._last.plan != state.plan):
            names = self._plans.get(state.plan, {}).get("awaited")
            late = [self._model.shown(str(name)) for name in names] if isinstance(names, list) else []
            provided = f", provided that {listed(late)} {'go' if late[1:] else 'goes'} on" if late else ""
            return {"most": None, "void": f"a new plan is in force, which leads to the goal{provided}"}
        return {"most": self._most, "void": self._void}

    def _reason(self, state: SystemState, last: Optional[SystemState]) -> str:
        shown = self._model.shown
        lists = {"late": state.late, "lost": state.lost, "held": state.held, "not in its place": state.displaced}
        for what, agents in lists.items():
            present = [name for name in agents if name not in self._excused]
            if present:
                return f"{shown(present[0])} was {what}"
        if state.status == HOLDING:
            return "the mission was held"
        broken = [says for says in self._assumptions(state) if says not in self._broken]
        if broken:
            return f"an assumption was broken: {broken[0]}"
        return self._off_time(state, last)

    def _off_time(self, state: SystemState, last: Optional[SystemState]) -> str:
        """Who has ended something outside the window of its model with this event."""
        agent = next((each for each in self._model.acting if each.name == state.agent), None)
        if last is None or agent is None or last.seq != state.seq - 1 or agent.name in self._excused:
            return ""
        before, here = last.locations.get(agent.name, ""), state.locations.get(agent.name, "")
        off = breaks_off(before, state.event)
        window = end_window(self._model, agent, before) if is_end(before, here) and not off else None
        if window is None or window.clock not in last.clocks:
            return ""
        took = last.clocks_at(state.stamp)[window.clock]
        if window.low - TOLERANCE <= took <= window.high + TOLERANCE:
            return ""
        return f"{self._model.shown(agent.name)} was {'earlier' if took < window.low else 'later'} than its model"
