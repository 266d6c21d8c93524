"""Every step of a recorded mission against its scenario: what was kept, where the world or a node left the model."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Dict, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.language import network_names as names
from pursue_gen.language.symbols import Role, Symbol, role_of
from pursue_gen.language.times import unit_name
from pursue_gen.synthesis.lookup import Entry
from pursue_gen.tools.replay.commands import CommandCheck, changed_service, commands_out_of_service
from pursue_gen.tools.replay.ends import wrong_end
from pursue_gen.tools.replay.finding import FAULT, NOTE, UNRECORDED, WORLD, Finding
from pursue_gen.tools.replay.game import Game
from pursue_gen.tools.replay.gaps import EXACT, completed
from pursue_gen.tools.replay.moves import Broken, Move, after, newly_broken, place_of
from pursue_gen.tools.replay.orders import Orders, in_time, of_plan, since_for
from pursue_gen.tools.replay.record import MissionRecord
from pursue_gen.tools.replay.robots import Done, check_robots
from pursue_gen.tools.replay.steps import ReplayedStep, aged, change, delays, longest_due, where
from pursue_gen.tools.replay.word_matches import match_words, unmatched_words
from pursue_gen.tools.replay.written import with_what_was_written
from pursue_runtime.event_words import CANCELLED
from pursue_runtime.sentences import in_words
from pursue_runtime.state import ENDED, HOLDING, LOST, RUNNING, WAITING, WON, SystemState

MARKED = 0.1
"""Time units after a deadline at which the observer takes it for missed: reports are on their way."""


@dataclass(frozen=True)
class Findings:
    """What was found: steps in order, findings in order of their states, how it ended.

    `delays`: how late each command of a controller took effect, in time units since it was due; `reaction`: how late
    the strategy allows that, 0 where it is not known; `longest_due`: for how long a command was due at most before
    something happened, and which one, of simulations in which messages may be late; `times_in`: what times count.
    """

    steps: Tuple[ReplayedStep, ...]
    findings: Tuple[Finding, ...]
    status: str
    reason: str
    start: float
    length: float
    counts: Mapping[str, int] = field(default_factory=dict)
    delays: Tuple[float, ...] = ()
    reaction: float = 0.0
    longest_due: Tuple[float, str] = (0.0, "")
    times_in: str = "time units"

    @property
    def kept(self) -> bool:
        """True where nothing left the model."""
        return all(finding.level == NOTE for finding in self.findings)

    @property
    def won(self) -> bool:
        """True where the mission was won."""
        return self.status == WON


def check(
    record: MissionRecord, game: Game, tolerance: float = 0.1, lateness: float = 0.0, offset: float = 0.0
) -> Findings:
    """Checks the whole record. In time units: `tolerance`: how far events may miss the model's windows; `lateness`: how
    long messages may be on their way beyond the reaction; `offset`: by how much clocks of controllers may be wrong."""
    record, game = with_what_was_written(record, game)
    moves = game.moves
    orders, unread = _orders_in(record, game)
    record, findings = (record, []) if record.is_exact else completed(record, moves, orders, game.objective.goal)
    grace = tolerance + (0.0 if record.is_exact and not lateness else MARKED)
    checker = _Checker(record, game, orders, tolerance, grace)
    checker.run()
    steps = checker.steps
    said = match_words(record, [(step.since, step.before, step.state) for step in steps], moves)
    steps = [replace(step, word=said.of(step.state.seq)) for step in steps]
    commanded = CommandCheck(record, game, orders, lateness + tolerance, offset + tolerance).findings(steps)
    findings += [*unread, *checker.findings, *checker.timing(steps), *commanded]
    findings += [*commands_out_of_service(steps), *unmatched_words(record, said, checker.moves)]
    if not record.by_words:
        done = [*checker.turns, *((s.before, s.state, s.move[0][0], s.is_command) for s in steps)]
        findings += check_robots(record, game, sorted(done, key=lambda step: step[1].seq), checker.orders, lateness)
    findings += [Finding(FAULT, "recording", 0, f"the recording is not whole: {what}") for what in record.problems]
    last = max(record.states, key=lambda state: state.seq)
    last = [state for state in record.states if state.seq == last.seq][-1]
    start = next((state.stamp for state in record.states if state.status != WAITING), last.stamp)
    counts = {
        "states": len({state.seq for state in record.states}),
        "steps": len(steps),
        "commands": sum(step.is_command for step in steps),
        "reports": sum(step.word is not None and not step.is_command for step in steps),
        "dropped": len(said.unmatched),
        "plans": last.plan,
        "holds": checker.holds,
    }
    findings.sort(key=lambda finding: finding.seq)
    length = (last.stamp - start) / last.unit
    how_late = delays(steps, orders), max((known.reaction for known in orders.values()), default=0.0)
    due = 0.0, ""
    if record.exact_until is not None and lateness:
        due = longest_due(record.states, record.exact_until, steps, moves, orders)
    ended = last.status, in_words(last.reason), start, length
    return Findings(tuple(steps), tuple(findings), *ended, counts, *how_late, due, unit_name(game.scenario.unit))


def _orders_in(record: MissionRecord, game: Game) -> Tuple[Dict[int, Orders], List[Finding]]:
    """The strategies that were played, by the number of their plan, and what is to say of those that are not known."""
    orders: Dict[int, Orders] = {}
    findings: List[Finding] = []
    if game.orders is not None:
        orders[0] = game.orders
    else:
        why = f"what was commanded is not checked against a strategy: {game.why_not}"
        findings.append(Finding(NOTE, "strategy", 0, why))
    for number, data in record.plans.items():
        try:
            orders[number] = of_plan(data)
        except ValueError as problem:
            findings.append(Finding(FAULT, "plan", 0, f"plan {number} cannot be read: {problem}"))
    return orders, findings


class _Checker:
    def __init__(
        self, record: MissionRecord, game: Game, orders: Mapping[int, Orders], tolerance: float, grace: float
    ) -> None:
        """`grace`: the time units after a deadline until it is taken for missed."""
        self.moves = game.moves
        self._broken = Broken(game.network, game.objective)
        self.findings: List[Finding] = []
        self.steps: List[ReplayedStep] = []
        self.turns: List[Done] = []
        self.orders = orders
        self.holds = 0
        self._record, self._game, self._tolerance, self._grace = record, game, tolerance, grace
        self._exact = min(EXACT, tolerance) if record.is_exact else EXACT
        self._counts = unit_name(game.scenario.unit)
        self._zeros: Dict[str, float] = {}
        self._since: Dict[Entry, SystemState] = {}  # in which was decided what stands (else: in the one before)
        self._first_of: Dict[int, SystemState] = {}  # each state as it was when it began

    def run(self) -> None:
        """The states one by one."""
        before: Optional[SystemState] = None
        for state in self._record.states:
            if not self.moves.knows(place_of(state)):
                self._report(FAULT, "scenario", state, "this state is not one of the scenario: is it the right one?")
                return
            self._first_of.setdefault(state.seq, state)
            if before is None:
                self._first(state)
            elif state.seq == before.seq:
                self._again(before, state)
            elif state.seq > before.seq + 1:
                self._report(FAULT, "gap", state, f"states after {before.seq} are missing: what led here?")
                self._resume(state)
            else:
                self._next(before, state)
            before = state
        if before is not None:
            self._end(before)

    def _report(self, level: str, kind: str, state: SystemState, text: str) -> None:
        self.findings.append(Finding(level, kind, state.seq, text))

    # One state after the other ----------------------------------------------------------------------------------------

    def _first(self, state: SystemState) -> None:
        if state.seq > 1:
            self._report(UNRECORDED, "gap", state, f"the recording begins with state {state.seq}")
        elif place_of(state) != self.moves.initial:
            self._report(FAULT, "start", state, f"this is not where the scenario begins: {where(state)}")
        self._resume(state)
        if state.seq == 1:
            self._started(state)

    def _resume(self, state: SystemState) -> None:
        """Clocks are believed as they are here."""
        self._since = {}
        self._zeros = {clock: state.stamp - value * state.unit for clock, value in state.clocks.items()}

    def _started(self, state: SystemState) -> None:
        self._zeros, self._since = dict.fromkeys(self.moves.network.clocks, state.stamp), {}
        self._clocks(state)

    def _again(self, before: SystemState, state: SystemState) -> None:
        """The same number: a heartbeat, the answer to a ping, or an end."""
        if state.discrete() != before.discrete():
            self._report(FAULT, "number", state, f"two different states have number {state.seq}")
        elif state.status != before.status:
            self._status(before, state)
        if state.seq and state.status not in ENDED:
            self._clocks(state)

    def _next(self, before: SystemState, state: SystemState) -> None:
        if before.status == WAITING:
            if place_of(state) != self.moves.initial:
                self._report(FAULT, "start", state, f"this is not where the scenario begins: {where(state)}")
            self._started(state)
            return
        if before.status in ENDED:
            self._report(FAULT, "end", state, f"the mission went on after it was {before.status}")
        if state.stamp < before.stamp - EXACT:
            self._report(FAULT, "clock", state, f"time went back by {before.stamp - state.stamp:.3f} s")
        before = self._with_order(self._with_broken(before, state), state)
        move = self._move(before, state)
        since, self._since = self._since, {}
        if move is not None:
            begun = self._first_of[before.seq]
            decided = max(since_for(move[0][0], self.orders.get(before.plan), since, begun), key=lambda each: each.seq)
            self.steps.append(ReplayedStep(before, state, move, decided))
            self._since = self._standing(before, state, move, since)
            resets = after(move, place_of(before))[1]
            self._zeros.update(dict.fromkeys(resets, state.stamp))
            if state.agent == names.ORDER_DESK:
                self._ordered(resets, state)
        elif self._turned(before, state):
            self.turns.append((before, state, "", False))
        elif not self._cancelled(before, state) and state.discrete() != before.discrete():
            could = ", ".join(self.moves.possible(place_of(before))) or "nothing"
            what = f"{state.event} by {state.agent}" if state.event else "what happened"
            changed = change(before, state)
            self._report(FAULT, "step", state, f"{what} is no step of the model ({changed}); possible: {could}")
            self._resume(state)
        self._clocks(state)
        self._status(before, state)

    def _with_broken(self, before: SystemState, state: SystemState) -> SystemState:
        """The state before with the assumptions broken that are broken in the next one; each of them is reported."""
        broken = newly_broken(before.values, state.values)
        for name in broken:
            assumption = self._game.scenario.assumed[int(Symbol.of(name).parts[0]) - 1]
            self._report(WORLD, "assumption", state, f"an assumption is broken: {assumption.clause}")
        return before._replace(values={**before.values, **dict.fromkeys(broken, 0)}) if broken else before

    def _with_order(self, before: SystemState, state: SystemState) -> SystemState:
        """The state before with its desk open where an order of a person is taken, together with the plan for it."""
        plan = self._record.plans.get(state.plan, {})
        if state.agent != names.ORDER_DESK or names.DESK_OPEN not in before.values or state.event.endswith(CANCELLED):
            return before
        if state.plan == before.plan or plan.get("order") != state.event:
            self._report(FAULT, "order", state, f"{state.event} was taken without a plan that is proven with it")
        return before._replace(values={**before.values, names.DESK_OPEN: 1})

    def _move(self, before: SystemState, state: SystemState) -> Optional[Move]:
        """The joint move that leads from one to the other, the one that fits the clocks best."""
        if not state.event:
            return None
        place, clocks = place_of(before), self._clocks_at(state)
        found = [m for m in self.moves.of(place, state.event, state.agent) if after(m, place)[0] == place_of(state)]
        return min(found, key=lambda move: self.moves.untimely(move, place, clocks).amount, default=None)

    def _ordered(self, clocks: Sequence[str], state: SystemState) -> None:
        """An order runs since it came, and may be due sooner than the scenario promises: clocks are believed that are
        later than those of an order that is due as late as can be."""
        self._zeros.update(
            (clock, state.stamp - state.clocks[clock] * state.unit) for clock in clocks if state.clocks[clock] >= 0
        )

    def _standing(
        self, before: SystemState, state: SystemState, move: Move, since: Mapping[Entry, SystemState]
    ) -> Dict[Entry, SystemState]:
        """For each block that holds after a move the state in which was decided what stands."""
        orders = self.orders.get(state.plan)
        if orders is None or (before.status, before.plan, state.status) != (RUNNING, state.plan, RUNNING):
            return {}
        return orders.after(move, place_of(before), self.moves, since, self._first_of[before.seq], state)

    def _turned(self, before: SystemState, state: SystemState) -> bool:
        """True where robots that could not go on turn round with a new plan, as the only change."""
        changed = [name for name, here in state.locations.items() if here != before.locations[name]]
        parts = [self.moves.way_back(place_of(before), name) for name in changed]
        move = tuple(part for part in parts if part is not None)
        place, resets = after(move, place_of(before))
        if not changed or len(move) < len(changed) or state.plan == before.plan or place != place_of(state):
            return False
        for clock in resets:  # the way back begins when the plan does, which may have come later
            zero = state.stamp - state.clocks.get(clock, 0.0) * state.unit
            self._zeros[clock] = zero if self._zeros[clock] <= zero <= state.stamp else state.stamp
        for name in changed:
            self._report(WORLD, "turned", state, f"{name} turned round: it could not go on")
        return True

    def _cancelled(self, before: SystemState, state: SystemState) -> bool:
        """True where an order is wanted no longer, with a plan that does without it."""
        event = state.event[: -len(CANCELLED)]
        if (event + CANCELLED, state.agent) != (state.event, names.ORDER_DESK):
            return False
        if state.plan == before.plan or self._record.plans.get(state.plan, {}).get("order") != state.event:
            self._report(FAULT, "order", state, f"{event} was cancelled without a plan that is proven without it")
        self._report(NOTE, "order", state, f"{event} was cancelled: what it asked for is not due any more")
        return self.moves.is_withdrawn(event, place_of(before), place_of(state))

    def _clocks_at(self, state: SystemState) -> Dict[str, float]:
        return {clock: (state.stamp - zero) / state.unit for clock, zero in self._zeros.items()}

    def _clocks(self, state: SystemState) -> None:
        """The clocks of the state, against the stamps of their last resets."""
        wrong = {
            clock: state.clocks.get(clock, float("inf")) - value
            for clock, value in self._clocks_at(state).items()
            if not abs(state.clocks.get(clock, float("inf")) - value) * state.unit <= self._exact
        }
        if wrong:
            wrong_by = ", ".join(f"{clock} by {off:+.4f}" for clock, off in sorted(wrong.items()))
            self._report(FAULT, "clock", state, f"clocks do not fit the stamps: {wrong_by} {self._counts}")
            self._resume(state)

    def _status(self, before: SystemState, state: SystemState) -> None:
        """Holds, new plans, lost agents."""
        for agent in sorted(set(state.lost) - set(before.lost)):
            self._report(WORLD, "lost", state, f"{agent} counts as lost: nothing is expected of it any more")
        for agent in sorted(set(before.lost) - set(state.lost)):
            self._report(NOTE, "back", state, f"{agent} is back")
        self.findings += changed_service(before, state, self._record.plans)
        if state.plan != before.plan:
            self._report(NOTE, "plan", state, f"plan {state.plan} is in force")
            if state.plan not in self.orders and not self._game.why_not:
                self._report(FAULT, "plan", state, f"plan {state.plan} is not in the recording")
        if state.status == HOLDING and before.status != HOLDING:
            self.holds += 1
            self._report(NOTE, "hold", state, f"the mission holds: {in_words(state.reason) or 'no reason is given'}")
        elif before.status == HOLDING and state.status == RUNNING:
            self._report(NOTE, "hold", state, "the mission goes on")

    def _end(self, last: SystemState) -> None:
        goal, bad = self._game.objective.goal, self._game.objective.bad
        overdue = self.moves.overdue(place_of(last), self._clocks_at(last))
        late = {name: by for name, by in overdue.items() if by > self._tolerance}
        if last.status == WON:
            for text in wrong_end(self._record, self._game, last, self._clocks_at(last), self._tolerance):
                self._report(FAULT, "end", last, text)
            for name, location in goal:
                if last.locations[name] != location:
                    self._report(FAULT, "end", last, f"its status is won, but {name} is not {location}")
            for name, location in bad:
                if last.locations[name] == location:
                    self._report(FAULT, "end", last, f"its status is won, but {name} is {location}")
                elif name in late:
                    text = f"its status is won, but {name} was at its deadline {late[name]:.2f} {self._counts} before"
                    self._report(FAULT, "end", last, text)
        elif last.status == LOST:
            for agent in (name for name in late if name not in dict(bad)):
                self._report(WORLD, "overdue", last, f"{agent} should have left {last.locations[agent]} before")
        elif last.status not in (*ENDED, WAITING):
            for agent, by in late.items():
                text = f"{agent} was {by:.2f} {self._counts} late in {last.locations[agent]} when the recording ended"
                self._report(WORLD, "late", last, text)

    def _is_at_goal(self, state: SystemState) -> bool:
        """True where the goal is reached: nothing is left but acknowledgements of orders."""
        goal = self._game.objective.goal
        return bool(goal) and all(state.locations[name] == location for name, location in goal)

    # What was done, by whom -------------------------------------------------------------------------------------------

    def timing(self, steps: List[ReplayedStep]) -> List[Finding]:
        """Steps that come at a time which the model does not know, and states that the strategy does not."""
        found: List[Finding] = []
        for step in steps:
            before, state = step.before, step.state
            clocks = aged(before, state)
            by, late = self.moves.untimely(step.move, place_of(before), clocks)
            own = self._game.is_deadline(*step.move[0])
            allowed = 0.001 if step.is_command else self._grace if own else self._tolerance
            if own and role_of(step.move[0][0]) is Role.WATCHER:
                allowed += MARKED  # of a strategy that another one has replaced: nobody keeps it any more
            if by > allowed:
                how = "late" if late else "early"
                text = f"{state.event} by {state.agent} comes {by:.2f} {self._counts} {how} for the model"
                found.append(Finding(FAULT if step.is_command else WORLD, how, state.seq, text))
            broken = self._broken.of(before.locations, before.values) if before.status == RUNNING and not own else ""
            if broken and (state.stamp - before.stamp) / state.unit > self._tolerance:
                text = f"{broken} was broken before, and nobody marked it: {where(before)}"
                found.append(Finding(FAULT, "broken", state.seq, text))
            missed = self.moves.overdue(place_of(before), clocks) if not own else {}
            for name, _ in self._game.objective.bad:
                if missed.get(name, 0.0) > self._grace:
                    text = f"{name} was at its deadline {missed[name]:.2f} {self._counts} before"
                    found.append(Finding(FAULT, "deadline", state.seq, text))
            orders = self.orders.get(state.plan)
            if orders is None or state.status != RUNNING or self._is_at_goal(state):
                continue
            cover = [orders.cover.entered(block) for block in orders.cover.holding(place_of(state).facts)]
            parts = ([zone for zones in part for zone in zones] for part in cover)
            back = orders.reaction if self._record.is_exact else 0.0  # what was decided in a zone takes effect after it
            if not cover or not all(in_time(zones, state.clocks, back, self._tolerance) for zones in parts):
                what = "at these clocks" if cover else "in this state"
                text = f"the strategy does not know what to do {what}: {where(state)}{self._game.doubt}"
                found.append(Finding(WORLD, "uncovered", state.seq, text))
        return found
