"""Whether a mission runs, holds or is stopped, and the plans that let it go on. Times are seconds of ROS time."""

from __future__ import annotations

from typing import AbstractSet, Any, Dict, List, Mapping, Optional, Set, Tuple

from pursue_runtime.data import DataError
from pursue_runtime.event_words import FINISH
from pursue_runtime.locations import is_under_way
from pursue_runtime.model import Model, Position
from pursue_runtime.observer import life
from pursue_runtime.observer.assumptions import broken_reason
from pursue_runtime.observer.mission_state import MissionState
from pursue_runtime.observer.off_plan import uncovered_position, uncovered_reason
from pursue_runtime.observer.planning import PlanRequest, covers, is_uncovered, without_commands
from pursue_runtime.sentences import as_sentence, in_words, marked
from pursue_runtime.state import ENDED, HOLDING, LIVE, RUNNING, SystemState
from pursue_runtime.state_checks import adoptable
from pursue_runtime.strategy import Cover, Entry
from pursue_runtime.zones import due

COVER_GRACE = 2.0
"""Seconds for which clocks may be outside what the strategy covers while no agent is late: words may be lost, and are
published again."""

IS_LATE, WAS_LOST = "is late by", "was lost before"
"""How the reason begins why a robot counts as lost that is late, and one that did before the observer was restarted."""


class MissionStatus(MissionState):
    """A mission that holds while a plan, a node or a robot is missing, and ends where there is no plan."""

    @property
    def plan_request(self) -> Optional[PlanRequest]:
        """Return the request for a plan, None if none is needed."""
        return self._planning.request if self.status in LIVE else None

    @property
    def proposal(self) -> Optional[Dict[str, Any]]:
        """Return the plan to publish; it is in force once every controller has acknowledged it."""
        proposal = self._planning.proposal
        return proposal.data if proposal else None

    # Inputs: each returns the states to publish, in order -------------------------------------------------------------

    def on_controller_silent(self, node: str, now: float) -> List[SystemState]:
        """Hold the mission until this controller, which is silent, is back."""
        self.silent.add(node)
        return self._status_changes(now)

    def on_controller_back(self, node: str, now: float) -> List[SystemState]:
        """Note that a controller is not silent any more."""
        self.silent.discard(node)
        return self._status_changes(now)

    def on_plan(self, number: int, answer: Mapping[str, Any], now: float) -> List[SystemState]:
        """Take the planner's answer to the request of this number."""
        try:
            asked = self._planning.request
            out = () if asked is None else asked.out_of_service
            unneeded = self.service.unneeded(out, self.position(now).locations)
            found = self._planning.on_plan(number, answer, unneeded)
        except (DataError, KeyError, TypeError) as problem:
            return self.on_no_plan(number, f"the plan cannot be read: {problem}", now)
        proposal = self._planning.proposal
        waits = proposal is not None and proposal.request.order is None and self.status == RUNNING
        if found and waits and proposal and not self._has_commands(proposal.cover, self.position(now)):
            self._planning.refuse("nothing can be done before who is late goes on")
        elif found:
            self._log("info", f"plan {number} goes to the controllers")
        return self._put_plan_in_force(now)

    def on_no_plan(self, number: int, why: str, now: float) -> List[SystemState]:
        """Take that there is no plan for the request of this number: stop, unless an agent is only late."""
        request = self._planning.on_no_plan(number, why)
        if request is not None and request.turning:
            self.ways.turns.clear()  # a plan without these robots is the next to look for
        elif request is not None and not request.awaited:
            self._relying = self.counts["taken"]  # then one that relies on those who are late
        return self._status_changes(now)

    def on_long_search(self, number: int, seconds: float, now: float) -> List[SystemState]:
        """Take that the planner has searched for so many seconds for the request of this number, and goes on."""
        self._planning.on_long_search(number, seconds)
        return self._status_changes(now)

    def stop(self, why: str, now: float) -> List[SystemState]:
        """Stop the mission safely: no further commands are taken. `why`: a sentence, or any text."""
        return self._end(life.STOP, as_sentence(why), now) if self._life.may(life.STOP) else []

    def adopt(self, found: Mapping[str, Any], now: float) -> List[SystemState]:
        """Continue from a state (its fields by name) that other nodes have seen. Raises DataError."""
        state = adoptable(found, self.model, self._unit, self.plan)
        self._automata.adopt(state)
        self._life.take(life.ADOPT, "" if state.status == RUNNING else state.reason, state.status)
        self._begun = state.stamp - max(state.clocks.values(), default=0.0) * self._unit  # the oldest clock's age
        self.ending.adopt()
        if state.status == RUNNING and state.reason:
            self.ending.begin(self.position(now))
        self.seq, self._since = state.seq, {}
        self._event, self._agent, self._ended = state.event, state.agent, state.stamp if state.status in ENDED else None
        self.late, self.lost, self.silent = set(state.late), dict.fromkeys(state.lost, WAS_LOST), set()
        self._early, self._warned = {}, False
        self.ways.turns.clear()
        self._relying = -1
        self._planning.adopt(self.late.union(self.lost))
        self.robots.adopt(state)
        self.service.adopt(state.out_of_service)
        self.orders.adopt(state.orders, now)
        self.shared_ends.adopt(state)
        self._beginnings.forget()
        self._commanded = state.commanded
        self._shown = self.robots.revision()
        return [self.state(now), *self._status_changes(now)]

    def on_restart(self, now: float) -> List[SystemState]:
        """Take that the observer was restarted: what it has done last may not be known."""
        if self.status in LIVE:
            self._planning.renumber()
        return []

    # The end --------------------------------------------------------------------------------------------------------

    def finish(self, now: float) -> List[SystemState]:
        """Take the word of an operator: a mission without a goal ends as soon as what is due is answered."""
        if not self._life.may(life.WIN):
            return []  # most often the observer's own word
        if self.model.goal:
            self._log("warn", f"{FINISH} before the goal is reached: ignored")
            return []
        self.ending.begin(self.position(now))
        return self._end_begun(now)

    def _end_begun(self, now: float) -> List[SystemState]:
        """End the mission, or say what that waits for. The number of the state stays: nothing has changed for the
        strategy."""
        if self._is_done(now) and not self.orders.awaited():
            return self._end(life.WIN, self._what_was_kept(), now)
        self._log("info", in_words(self.ending.says))
        return [self.state(now)]

    def _is_done(self, now: float) -> bool:
        """Return True where the goal is reached, or the end has come: nothing is left but acknowledgements."""
        return self._automata.is_won() or self.ending.is_over(self.position(now))

    def _win(self, now: float) -> None:
        """Win the mission, which is done, once all orders were acknowledged; nothing else counts until then."""
        if self.orders.awaited():
            self._log("info", f"all is done, but {in_words(self.orders.awaited())} yet")
        else:
            self._conclude(life.WIN, "" if self.model.goal else self._what_was_kept(), now)

    def _what_was_kept(self) -> str:
        kept = self.ending.kept()
        return f"kept: {kept}" if kept else ""

    # Whether it holds -------------------------------------------------------------------------------------------------

    def _status_changes(self, now: float) -> List[SystemState]:
        """Return a new state if the status, its reason or the waiting robots have changed without an event."""
        if self.status not in LIVE or self._is_done(now):
            return []
        before = self.status, self.reason, self._shown
        self._update_status(now, self._cover_grace if self.status == RUNNING else self._tolerance)
        return [] if before == (self.status, self.reason, self.robots.revision()) else self._new_state(now)

    def _update_status(self, now: float, patience: float) -> None:
        """Set the status: running where the plan in force covers the state, holding where a plan or node is missing.

        `patience`: the time units for which clocks may be outside what the plan covers.
        """
        relied_on = {name: why for name, why in self.lost.items() if self._matters(name, now)}
        trouble = self._planning.unexcused(relied_on)
        trouble = trouble or self._planning.unavoided(self.ways.blocked)
        trouble = trouble or self._planning.commanding(self.service.out)
        trouble = trouble or broken_reason(self.model, self.position(now), self._planning.not_assumed)
        trouble = trouble or self._uncovered(now, patience)
        waits = self.robots.reasons()
        trouble = "" if waits else trouble  # another plan begins when these robots can go on
        self.counts["uncovered"] += bool(trouble) and self.status == RUNNING
        if trouble and self._on_uncovered == "stop":
            self._conclude(life.STOP, trouble, now)
            return
        if trouble and self._on_uncovered == "warn":
            if not self._warned:
                self._log("warn", in_words(trouble))
            self._warned, trouble = True, ""
        reasons = waits + [f"{node} is silent" for node in sorted(self._missed(now))]
        if not trouble and not reasons and self.status == RUNNING and self._look_at_orders(now):
            pass
        elif not trouble and not reasons and self._stands_idle(now):
            self._request_plan(now, meanwhile=True)
        elif not trouble:
            self._planning.reset()
        elif self._request_plan(now):
            reasons.append(f"{trouble}; {self._planning.progress()}")
        else:
            trouble += f"; no other plan: {self._planning.no_plan_reason}"
            late = {name for name, why in self.lost.items() if why.startswith((IS_LATE, WAS_LOST))} & self._in_order
            awaited = " and ".join(map(marked, sorted(self.late - (set(self.lost) - late))))
            if not awaited:
                self._conclude(life.STOP, trouble, now)
                return
            reasons.append(f"{trouble}; waiting for {awaited}")
        reason = "; ".join(reasons)
        if reason == self._life.reason and bool(reasons) == (self.status == HOLDING):
            return
        if reasons:
            news = self._told.news(reason)
            self._log("warn" if news else "debug", f"the mission holds: {in_words(news or reason)}")
            self._life.take(life.HOLD, reason)
        else:
            self._told.forget()
            self._log("info", "the mission goes on")
            self._life.take(life.GO_ON)

    def _uncovered(self, now: float, patience: float) -> str:
        """Return why the plan in force has no decision here, in words; "" if it has one."""
        position, tolerance = self.position(now), self._tolerance
        if self._cover is None or not is_uncovered(self._cover, position, tolerance, patience):
            return ""
        if self.status == RUNNING:
            self._log("debug", f"no strategy in state {self.seq}: {uncovered_position(position)}")
        return uncovered_reason(self.model, self._cover, position, tolerance, self.late - set(self.lost))

    def _missed(self, now: float) -> Set[str]:
        """Return the controllers that are silent, but for those of robots out of service that have nothing to do."""
        unneeded = self.service.unneeded(self.service.out, self.position(now).locations)
        return self.silent - (without_commands(self.in_force, unneeded) if self.in_force else set())

    def _matters(self, name: str, now: float) -> bool:
        """Return True unless what the plan in force does in this state holds whatever the automaton does."""
        if self._cover is None:
            return True
        named = self._cover.names_in(self.state(now)) or self._cover.names
        return not named or name in named

    def _still_standing(self, before: SystemState, state: SystemState) -> Dict[Entry, int]:
        """Return where was decided what stands after a move, for each entry that applies, as controllers see it too."""
        if self._cover is None or (before.status, state.status) != (RUNNING, RUNNING):
            return {}
        standing = self._cover.standing(before, state)
        return {
            entry: self._since.get(entry, before.seq) if entry in standing else state.seq
            for entry in self._cover.applying(state)
        }

    @property
    def _cover_grace(self) -> float:
        return self._tolerance + COVER_GRACE / self._unit

    def _look_at_orders(self, now: float) -> bool:
        """Request a plan for what people have ordered; return False where nothing is."""
        return False

    # New plans --------------------------------------------------------------------------------------------------------

    def _request_plan(self, now: float, meanwhile: bool = False) -> bool:
        """Request another plan from here, or for what to do while somebody is late; return False if there is none."""
        position = Model.after(tuple(self.ways.turns.values()), self.position(now))
        gone = frozenset(self.late | set(self.lost))
        awaited = self._awaited(position) if meanwhile or self._relying == self.counts["taken"] else {}
        excused = gone - set(self.ways.turns) - set(awaited)
        ends = [delay for name, delay in self._bounds(position) if name not in gone]
        ahead = max(0.0, min([self._planning.lead_time / self._unit, *ends]))
        what = position, now, ahead, excused, awaited, self.ways
        self._planning.request_plan(self.counts["taken"], *what, out=self.service.after())
        return not self._planning.no_plan_reason

    def _awaited(self, position: Position) -> Dict[str, float]:
        """Return the agents that are late, and the time units until each counts as lost."""
        late = {name: delay + self._lost_after for name, delay in self._late_agents(position)}
        return {name: left for name, left in late.items() if left > 0 and name not in self.ways.turns}

    def _losing(self, position: Position) -> List[Tuple[str, float]]:
        """Return the late agents that will count as lost, and the time units until then (negative: overdue).

        With orders of passage nobody gets in the way of who is late: the others pass before it or wait, so it counts as
        lost only where all of them wait.
        """
        late = [(name, delay + self._lost_after) for name, delay in self._late_agents(position)]
        if self._in_order.isdisjoint(name for name, _ in late) or self._all_wait(position):
            return late
        return [(name, delay) for name, delay in late if name not in self._in_order]

    @property
    def _in_order(self) -> AbstractSet[str]:
        """Return who passes places in an order; others wait for them."""
        return frozenset() if self._cover is None else self._cover.in_order

    def _stands_idle(self, now: float) -> bool:
        """Return True while nobody does anything but agents that are late, and the plan in force waits for them.

        With orders of passage that is as it should be, as long as they are not lost.
        """
        position = self.position(now)
        if self._cover is None or self._on_uncovered != "plan" or not self._late_agents(position):
            return False
        return not self._in_order and self._all_wait(position)

    def _all_wait(self, position: Position) -> bool:
        """Return True if nobody is under way but agents that are late or lost, and the plan in force has no command."""
        gone = self.late.union(self.lost)
        others = [each.name for each in self.model.acting if each.name not in gone]
        busy = any(is_under_way(position.locations[name]) for name in others)
        return not busy and (self._cover is None or not self._has_commands(self._cover, position))

    @staticmethod
    def _has_commands(cover: Cover, position: Position) -> bool:
        """Return True if the plan has a command here, now or later while only time passes."""
        found = cover.find(SystemState(0, 0.0, *position))
        zones = [zone for covered in found for zones in covered.commands.values() for zone in zones]
        return due(zones, position.clocks) is not None

    def _on_plan_receipt(self, node: str, number: int, now: float) -> List[SystemState]:
        self._planning.on_receipt(node, number)
        return self._put_plan_in_force(now)

    def _put_plan_in_force(self, now: float) -> List[SystemState]:
        """Put an acknowledged plan in force with a new state, if it covers the present clocks."""
        proposal = self._planning.acknowledged()
        if proposal is None or self.status not in LIVE:
            return []
        turns = tuple(self.ways.turns[name] for name in proposal.request.turning)
        start = min(now, proposal.request.stamp + proposal.request.ahead * self._unit)  # there the proof begins
        position = Model.after(turns, self.position(start)).aged((now - start) / self._unit)
        if not covers(proposal.cover, position, self._tolerance):
            self._planning.expire(proposal, now)
            return self._status_changes(now)
        self.in_force = proposal.data
        self.plan, self._cover = proposal.data["plan"], proposal.cover
        self._planning.put_in_force(proposal)
        for name in proposal.request.awaited or ():
            self._log("info", f"plan {self.plan} relies on {name}, which is late, until it counts as lost")
        self._automata.turn(turns, start)
        for name, _ in turns:
            self.late.discard(name)
            self._log("warn", f"{name} goes back: it {in_words(self.lost.pop(name))}")
        self.ways.turns.clear()
        self._update_status(now, self._tolerance)
        self._beginnings.on_moves(turns, self.seq + 1)
        for turn in turns:
            locations = self.position(now).locations
            self.orders.on_moves((turn,), self.seq + 1, True, self.lost, locations, now)
        return self._new_state(now)
