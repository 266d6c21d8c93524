"""The independent judge of a mission: by the network and the strategy as the solver had them, not by the run time.

Each state that the observer publishes must follow from the one before by one joint move of the network, at clocks that
allow it; what is not so may be a report that a fault has put off the model, but never a command. A command must be
held by the strategy in force in the state before, and have been due there since the state began (without faults: no
longer ago than the reaction). A robot gets only such commands as orders, and only while they are still to be done.
"""

from __future__ import annotations

from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Sequence, Set, Tuple

from pursue_gen.language.network_names import is_assumption, is_doing, is_under_way
from pursue_gen.proof.moves import Arena, JointMove, State
from pursue_gen.simulation.commands import EPSILON, Commands, Entry, commands_in
from pursue_gen.simulation.meaning import Broken
from pursue_gen.tga.network import ClockBound
from pursue_gen.tga.words import event_word
from pursue_gen.zones.dbm import INF, Dbm, constant
from pursue_runtime.orders import Order
from pursue_runtime.state import ENDED, LIVE, SystemState


class TakenStep(NamedTuple):
    """What led to the state of this number, and whether the strategy commanded it."""

    seq: int
    agent: str
    event: str
    target: str
    commanded: bool


class Judge:
    """Checks one mission. `problems`: what must never be; `off_model`: how often the world left the model."""

    def __init__(self, arena: Arena, commands: Commands, bad: Sequence[Tuple[str, str]], reaction: float,
                 faults: bool = False, offset: float = 0.0, broken: Optional[Broken] = None) -> None:
        """`reaction` in time units; `offset`: by how much (time units) the clock of a controller may be wrong;
        `broken`: what an objective on a condition means, directly."""
        self.problems: List[str] = []
        self.off_model = 0
        self.steps: List[TakenStep] = []
        self._joined: List[TakenStep] = []  # the same for those who take part in a step of another agent
        self._arena, self._bad = arena, bad
        self._names = [automaton.name for automaton in arena.network.automata]
        self._plans: Dict[int, Commands] = {0: commands}
        self._reaction, self._faults, self._offset = reaction, faults, offset
        self._before: Optional[SystemState] = None
        self._entered: Dict[Entry, float] = {}  # when what each block that holds decides was decided at the earliest
        self._moved = self._decided_since = 0.0
        self._zeros: Dict[str, float] = {}
        self._ordered: Set[Tuple[str, int]] = set()
        self._broken, self._was_broken = broken, False
        self.lateness = 0.0
        """The time units for which a command was due at most before something happened; counted with faults only."""
        self.latest = ""
        """Which command that was."""
        self.overdue: List[str] = []
        """The ends that came outside the model's window, with the time units by which they did."""

    def on_plan(self, number: int, strategies: Mapping[str, Any], people: Optional[Mapping[str, Any]]) -> None:
        """A new plan has been published under this number."""
        parts = [*strategies.values(), *([people] if people else [])]
        self._plans[number] = commands_in(parts)

    # States -----------------------------------------------------------------------------------------------------------

    def on_state(self, state: SystemState, now: float) -> None:
        """The observer publishes a state, at this moment (seconds)."""
        before, self._before = self._before, state
        self._check_condition(state)
        if self._faults and before is not None and state.seq != before.seq:
            self.note_lateness(before, now)
            if state.plan != before.plan:
                self._decided_since = now
        if before is None or before.seq == 0:
            if state.seq > 0:
                self._check_start(state, now)
            return
        if state.seq == before.seq:
            if (state.locations, state.values) != (before.locations, before.values):
                self._problem(f"state {state.seq} is published again, but with other locations or values")
        elif state.seq != before.seq + 1:
            self._problem(f"state {state.seq} follows state {before.seq}")
        elif state.event:
            self._check_step(before, state, now)
        elif (state.locations, state.values) != (before.locations, self._with_broken(before, state)):
            self._problem(f"state {state.seq} differs from the one before, but nothing has happened")
        if state.status != "waiting" and before.status not in ENDED:  # the clocks of an ended mission stand still
            self._check_clocks(state, now)

    def _check_condition(self, state: SystemState) -> None:
        """A mission is lost if and only if the condition of its objective says so, in the next state at the latest."""
        if self._broken is None or state.seq == 0:
            return
        broken = self._broken(state.locations, state.values)
        watching = ((name, location) for name, location in self._bad if name in self._broken.automata)
        lost = any(state.locations.get(name) == location for name, location in watching)
        if lost and not broken:
            self._problem(f"state {state.seq} counts as lost, but the condition of the objective is not broken there")
        elif self._was_broken and not lost:
            self._problem(f"the objective is broken before state {state.seq}, which does not count as lost")
        self._was_broken = broken and not lost

    def note_lateness(self, state: SystemState, now: float) -> None:
        """Takes that nothing has happened in the state until now. While a mission holds its commands are late, too."""
        plan = self._plans.get(state.plan) if state.status in LIVE else None
        if plan is None:
            return
        clocks = {clock: (now - zero) / state.unit for clock, zero in self._zeros.items()}
        for block in plan.holding(state.discrete()):
            stay = (now - max(self._decided_since, self._entered.get(block, self._moved))) / state.unit
            for command in plan.held_by(block):
                due = command.first_due(clocks, -stay, 0.0)
                if due is not None and -due > self.lateness:
                    self.lateness, self.latest = -due, f"{command.event} in state {state.seq}"

    def _check_start(self, state: SystemState, now: float) -> None:
        self._zeros = dict.fromkeys(self._arena.network.clocks, now)
        self._moved = self._decided_since = now
        if (state.seq, self._key(state)) != (1, self._arena.initial):
            self._problem(f"the mission starts with state {state.seq}, not where the network starts")
        self._check_clocks(state, now)

    def _check_step(self, before: SystemState, state: SystemState, now: float) -> None:
        clocks = {clock: (now - zero) / state.unit for clock, zero in self._zeros.items()}
        what = f"{state.event} by {state.agent} (state {state.seq})"
        matching = [
            move
            for move in self._arena.situation(self._key(before._replace(values=self._with_broken(before, state)))).moves
            if (move.moves[0].automaton, _word(move)) == (state.agent, state.event) and move.target == self._key(state)
        ]
        if not matching:
            self._problem(f"{what} is no step of the network")
            return
        point = self._point(clocks)
        move = next((m for m in matching if m.enabled and inside(m.enabled, self._arena.scale, point)), None)
        if move is None:
            move = matching[0]
            self._off_model(move, clocks, what)
        commanded = move.controllable and not self._is_deadline(move)
        if commanded:
            self._check_command(before, state, clocks, what, now)
        target = move.moves[0].edge.target
        self.steps.append(TakenStep(state.seq, state.agent, state.event, target, commanded))
        for part in move.moves[1:]:  # whoever takes part in what another agent begins is ordered to do so as well
            joins = is_doing(part.edge.target) and part.edge.source != part.edge.target
            if joins and part.automaton not in state.lost:
                self._joined.append(TakenStep(state.seq, part.automaton, state.event, part.edge.target, True))
        self._zeros.update((self._arena.network.clocks[index - 1], now) for index in move.resets)
        self._entered = self._standing(before, state, move, now)
        self._moved = now

    def _standing(self, before: SystemState, state: SystemState, move: JointMove, now: float) -> Dict[Entry, float]:
        """For each block that holds now, since when: what it decided stands if it held before as well, and the move
        resets no clock of an automaton that it names, but those that the plan leaves out."""
        plan = self._plans.get(state.plan)
        if plan is None:
            return {}
        network = self._arena.network
        reset = {network.clocks[index - 1] for index in move.resets} - plan.left_out_clocks
        touched = {automaton.name for automaton in network.automata if reset & automaton.clocks}
        goes_on = (before.status, state.status, before.plan) == ("running", "running", state.plan)
        held = plan.holding(before.discrete()) if goes_on else []
        return {
            block: self._entered.get(block, self._moved) if block in held and touched.isdisjoint(block[0]) else now
            for block in plan.holding(state.discrete())
        }

    def _off_model(self, move: JointMove, clocks: Mapping[str, float], what: str) -> None:
        guard = move.moves[0].edge.guard.clocks
        if not self._faults:
            self._problem(f"{what} comes at clocks at which the network does not allow it")
        elif move.controllable and not all(_holds(bound, clocks) for bound in guard):
            self._problem(f"{what} is a command at clocks that its guard forbids")
        self.off_model += 1
        if not self._is_deadline(move):
            self.overdue.append(what)

    def _with_broken(self, before: SystemState, state: SystemState) -> Dict[str, int]:
        """The values before, with 0 for the assumptions that are broken now."""
        broken = [name for name, value in before.values.items() if is_assumption(name) and state.values[name] < value]
        if broken and not self._faults:
            self._problem(f"state {state.seq}: {' and '.join(broken)} broken, but everybody keeps to what is assumed")
        return {**before.values, **dict.fromkeys(broken, 0)}

    def _is_deadline(self, move: JointMove) -> bool:
        """True for the step that marks a passed deadline: it is no command, though no other agent owns it."""
        first = move.moves[0]
        return (first.automaton, first.edge.target) in self._bad

    def _check_command(
        self, before: SystemState, state: SystemState, clocks: Mapping[str, float], what: str, now: float
    ) -> None:
        if before.status != "running":
            self._problem(f"{what} is a command, but the mission was {before.status}")
        plan = self._plans.get(before.plan)
        if plan is None:
            self._problem(f"plan {before.plan} is in force, which was never published")
            return
        held = {block: plan.held_by(block, state.agent, state.event) for block in plan.holding(before.discrete())}
        if not any(held.values()):
            self._problem(f"wrong command: the strategy does not hold {what} there")
            return
        for block, commands in held.items():
            stay = (now - self._entered.get(block, self._moved)) / state.unit
            back = stay + self._offset if self._faults else min(stay, self._reaction)
            if any(command.due_between(clocks, -back, self._offset) for command in commands):
                return
        self._problem(f"wrong command: {what} was not due there")

    def _check_clocks(self, state: SystemState, now: float) -> None:
        for clock, zero in self._zeros.items():
            stated, value = state.clocks.get(clock, -1.0), (now - zero) / state.unit
            if abs(stated - value) > EPSILON:
                self._problem(f"state {state.seq}: {clock} is {stated}, not {value}")
                return

    # Orders -----------------------------------------------------------------------------------------------------------

    def on_order(self, order: Order, seq: int, newest: int, again: bool) -> None:
        """A controller sends its robot an order, because of state `seq`, when `newest` is the newest that it knows.

        `again`: it was restarted, and may send it once more, while the state that follows is on its way. An order of
        something that is done at once stands until it is acknowledged, whatever the robot does next.
        """
        agent, trigger, target = order.agent, order.event, order.location
        partners = {(step.seq, step.event) for step in self.steps if step.agent != agent}
        if order.at_once and (order.seq, trigger) in partners:
            return  # it takes part in what another agent has done
        newest_step = min(seq, order.seq) if order.at_once else seq
        steps = (step for step in (*self.steps, *self._joined) if step.seq <= newest_step and step.agent == agent)
        last = max(steps, key=lambda step: step.seq, default=None)
        what = f"{agent} gets the order {trigger} ({target})"
        if seq < newest:
            self._problem(f"wrong order: {what}, as of state {seq}, though state {newest} is known")
        elif last is None or (last.target, True) != (target, last.commanded):
            self._problem(f"wrong order: {what}, which is not what was last commanded")
        elif is_under_way(target) and not order.at_once:
            here = self._before.locations.get(agent) if self._before is not None else None
            lost = self._before is not None and agent in self._before.lost  # what it did together does not wait for it
            if here != target and not again and not lost:
                self._problem(f"wrong order: {what}, which is over already")
        elif (agent, last.seq) in self._ordered and not again:
            self._problem(f"wrong order: {what}, for the second time")
        if last is not None:
            self._ordered.add((agent, last.seq))

    # What they need ---------------------------------------------------------------------------------------------------

    def _problem(self, text: str) -> None:
        self.problems.append(text)

    def _key(self, state: SystemState) -> State:
        variables = (name for name, _ in self._arena.network.variables)
        locations = tuple(state.locations.get(name, "") for name in self._names)
        return locations, tuple(state.values.get(name, -1) for name in variables)

    def _point(self, clocks: Mapping[str, float]) -> Tuple[float, ...]:
        return (0.0, *(clocks[clock] for clock in self._arena.network.clocks))


def inside(zone: Dbm, scale: int, point: Tuple[float, ...]) -> bool:
    """True where the point (0, clocks in order) is in the zone, or not farther beside it than clocks are exact.

    The zone's bounds have that scale.
    """
    dim = zone.dim
    return all(
        bound >= INF or point[k // dim] - point[k % dim] <= constant(bound) / scale + EPSILON
        for k, bound in enumerate(zone.m)
    )


def _word(move: JointMove) -> str:
    first = move.moves[0]
    return event_word(first.automaton, first.edge)


def _holds(bound: ClockBound, clocks: Mapping[str, float]) -> bool:
    over = clocks[bound.clock] - bound.bound
    return (">" in bound.op or over <= EPSILON) and ("<" in bound.op or over >= -EPSILON)
