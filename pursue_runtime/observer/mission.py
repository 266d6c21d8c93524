"""The mission in the observer: takes words and time, returns the states to publish. Times are seconds of ROS time."""

from __future__ import annotations

from typing import List, Mapping, Optional, Tuple

from pursue_runtime.event_words import (
    BLOCKED,
    FAILED,
    FINISH,
    FREE,
    ORDERED,
    PING,
    PLANNED,
    START,
    STOP,
    STUCK,
    RobotReport,
    Word,
    format_word,
    parse_report,
    parse_word,
)
from pursue_runtime.locations import is_under_way
from pursue_runtime.model import Assumption, Move, Position
from pursue_runtime.observer import life
from pursue_runtime.observer.assumptions import Breach, breach, overstayed
from pursue_runtime.observer.ending import has_come
from pursue_runtime.observer.mission_orders import NOTHING, MissionOrders
from pursue_runtime.observer.mission_status import IS_LATE
from pursue_runtime.observer.off_plan import late_words, untimely_words
from pursue_runtime.observer.orders import first_overdue
from pursue_runtime.observer.planning import stays
from pursue_runtime.orders import Order
from pursue_runtime.sentences import MARKED, as_sentence, in_words, marked, quoted
from pursue_runtime.state import HOLDING, LIVE, RUNNING, SystemState
from pursue_runtime.vocabulary import deed
from pursue_runtime.zones import EPSILON, INFINITY, due, was_reached

UNACKNOWLEDGED = "has not acknowledged"
"""How the reason begins why a robot counts as lost whose side has not acknowledged an order."""

BEGUN, DEADLINE = "the mission has begun", "a deadline has passed"

MAX_WORD_LENGTH = 1000
"""The most characters of a word; longer texts are dropped."""


class Mission(MissionOrders):
    """One mission: takes words, moves the automata, and returns the states to publish.

    The arguments are those of MissionState.
    """

    def next_moment(self, now: float) -> Optional[float]:
        """Return when to call `on_time` if no input comes before; None: never."""
        if self.status not in LIVE:
            return None
        position = self.position(now)
        overdue = first_overdue(self._unanswered(now), self._lost_after * self._unit)
        if self._is_done(now):
            return overdue
        delays = self._automata.internal_delays(position)
        delays += [] if overdue is None else [(overdue - now) / self._unit]
        begins = self.order_begins()
        moments = [*self._early.values(), *([] if begins is None else [begins])]
        delays += [(moment - now) / self._unit for moment in moments]
        delays += [delay + self._tolerance for name, delay in self._bounds(position) if name not in self.late]
        delays += [delay for _, delay in self._losing(position)]
        if self.status == RUNNING and not self._warned:
            delays.append(stays(self._cover, position, self._tolerance) + self._cover_grace)
        delays += [] if self._begun is None else [begin - self._passed(now) for begin in self.ending.begins]
        first = min(delays, default=INFINITY)
        return None if first == INFINITY else now + max(0.0, first) * self._unit

    # Inputs: each returns the states to publish, in order -------------------------------------------------------------

    def on_word(self, text: str, now: float) -> List[SystemState]:
        """Take a word from pursue/events; a word that is not possible changes nothing."""
        if text.strip() == PING:
            return [self.state(now)]
        if text.strip() == STOP:
            return self.stop(f"{STOP} was published", now)
        if text.strip() in (START, FINISH):
            return self._start(now) if text.strip() == START else self.finish(now)
        readable = len(text) <= MAX_WORD_LENGTH
        report = parse_report(text) if readable else None
        word = parse_word(text) if readable and report is None else None
        said_by = word.agent if word is not None and word.event != PLANNED else ""
        if said_by and not self.model.has(said_by) and self.status in LIVE:
            agents = ", ".join(each.name for each in self.model.of_kind("robot", "agent"))
            expected = f"expected the name of an agent of the scenario before the colon ({agents}), not a namespace"
            self._reject("impossible", f"{text[:80]}: nobody is called {said_by}; {expected}")
            return []
        if word is not None and word.event == ORDERED and word.seq is not None and self.status in LIVE:
            return self._on_order_receipt(word.agent, word.seq, word.at, now)
        if self.status in LIVE and self._is_done(now):
            self._reject("impossible", f"{text[:80]} after all was done", level="info")
        elif report is not None and self.status in LIVE:
            return self._on_robot_report(report, now)
        elif word is None:
            self._reject("unreadable", f"not a word: {text[:80]!r}")
        elif self.status not in LIVE:
            self._reject("impossible", f"{text} while the mission is {self.status}")
        elif word.event == PLANNED and word.seq is not None:
            return self._on_plan_receipt(word.agent, word.seq, now)
        elif word.seq is not None and self.status == HOLDING:
            self._reject("held", f"{text} while the mission holds", level="info")
        elif word.seq is not None and not self._is_current(word):
            self._reject("stale", f"{text}: this is state {self.seq}", level="info")
        elif word.seq is not None:
            command = self._command_of(word, now)
            moves = self._moves_of(command, now) if command is not None else None
            return self._take_command(moves, now) if moves else []
        else:
            return self._on_report(word, now)
        return []

    def on_time(self, now: float) -> List[SystemState]:
        """Handle deadlines, late and lost agents, and internal edges of objectives that are due."""
        if self.status not in LIVE:
            return []
        if any(now >= given + self._lost_after * self._unit for _, given in self._unanswered(now)):
            if self._is_done(now):
                return self.stop(self.orders.awaited(), now)
            for order, _ in self._unanswered(now):
                self._mark_lost(order.agent, f"{UNACKNOWLEDGED} {marked(order.event)}")
        position = self.position(now)
        moves = self._automata.internal_move(position)
        if moves:
            return self._take(moves, now, DEADLINE)
        moves = self._due_command(position, now)
        if moves:
            return self._take_command(moves, now)
        begins = self.order_begins()
        if begins is not None and begins <= now:
            return self._put_plan_in_force(now)
        has_broken, promised = False, {each.name for each in self.model.of_kind("safety")}
        for name, delay in self._bounds(position):
            if name in self.late or delay + self._tolerance > EPSILON:
                continue
            automaton, place = self.model.automaton(name), position.locations[name]
            own = [edge for edge in automaton.edges_from(place) if edge.sync == "own" and edge.allowed(position.values)]
            # A deadline; of an objective, or of a watcher, whose strategy has no decision then.
            lost = [edge for edge in own if name in promised or (name, edge.target) in self.model.bad]
            if lost:
                return self._take((Move(name, lost[0]),), now, DEADLINE)
            overstays = overstayed(self.model, position, name, self._tolerance)
            if overstays:
                self._note_broken(overstays)
                has_broken = True
                continue
            self.late.add(name)
            self._log("warn", in_words(late_words(automaton, position)))
        for name, delay in self._losing(position):
            if delay <= EPSILON:
                self._mark_lost(name, f"{IS_LATE} {self._lost_after:g} time units")
        states = self._after_losses(now)
        states = states or (self._new_state(now) if has_broken else [])  # no two states have one number
        if self.status in LIVE and has_come(self.ending.begins, self._passed(now)):
            self.ending.on_time(self.position(now))
            states = [*states, *self._end_begun(now)]
        return states

    def _start(self, now: float) -> List[SystemState]:
        if not self._life.may(life.START):
            self._log("warn", f"{START} while the mission is {self.status}: ignored")
            return []
        self._automata.start(now)
        self._begun = now
        self._life.take(life.START)
        self.seq = 1
        moves = self._evaluate(now, BEGUN)
        return [self.state(now), *self._take(moves, now, BEGUN)]

    # Moves ------------------------------------------------------------------------------------------------------------

    def _moves_of(self, word: Word, now: float) -> Optional[Tuple[Move, ...]]:
        """Return the moves of a word here; None, and counted, if it is not possible.

        A command that is early by no more than the tolerance is kept until it is due: its machine's clock is ahead.
        """
        position = self.position(now)
        moves = self.model.joint_move(position, word.event, word.agent)
        if moves:
            return moves
        breach = self._breach_of(word, position) if word.seq is None else None
        if breach is not None:
            self._note_broken(breach.assumptions)
            return breach.moves
        untimed = self.model.joint_move(position, word.event, word.agent, timed=False)
        if untimed and word.seq is None:
            self.counts["untimely"] += 1
            doer = self.model.automaton(untimed[0].automaton)
            self._log("warn", in_words(untimely_words(doer, untimed, position)))
            return untimed
        delay = due([untimed[0].edge.when], position.clocks, EPSILON) if untimed else None
        if delay is not None and delay <= self._tolerance:
            self._early[word] = now + delay * self._unit
            return None
        why = "not at this moment" if untimed else "it cannot happen here"
        could = ", ".join(self.model.possible(position, timed=False)) or "nothing"
        self._reject("impossible", f"{word.event}: {why}; what could have happened: {could}")
        return None

    def _breach_of(self, word: Word, position: Position) -> Optional[Breach]:
        """Return what a word does that is possible but for an assumption; None if that is not what excludes it."""
        found = breach(self.model, position, word, timed=True)
        if found is None and self.model.joint_move(position, word.event, word.agent, timed=False) is None:
            found = breach(self.model, position, word, timed=False)
        return found

    def _note_broken(self, assumptions: Tuple[Assumption, ...]) -> None:
        self._automata.set_values({each.variable: 0 for each in assumptions})
        for each in assumptions:
            self._log("err", f"an assumption is broken: {each.says}")

    def _due_command(self, position: Position, now: float) -> Optional[Tuple[Move, ...]]:
        """Return the moves of an early command that is due now; one that another event has overtaken is dropped."""
        for word in [word for word, moment in self._early.items() if now >= moment - EPSILON * self._unit]:
            del self._early[word]
            if self._is_current(word) and self.status == RUNNING:
                return self.model.joint_move(position, word.event, word.agent)
        return None

    def _is_current(self, word: Word) -> bool:
        """Return True for a command for the present state, or for an earlier one: what was decided there stands.

        Others than the entries that hold the command may name the agent, too: in their part nobody commands it.
        """
        known, cover = self._since, self._cover
        since = [known[e] for e in known if cover is not None and cover.holds_command(e, word.agent, word.event)]
        since = since or [known[entry] for entry in known if word.agent in entry[0]] or list(known.values())
        return word.seq is not None and max(since, default=self.seq) <= word.seq <= self.seq

    def _command_of(self, word: Word, now: float) -> Optional[Word]:
        """Return a command with its agent if the strategy commands it in the present state, now or sooner while only
        time passed; else None, and count it. One without an agent is for the first whom the strategy commands it."""
        if self._cover is None:
            return word
        state = self.state(now)
        zones = {
            agent: self._cover.commands(state, agent, word.event)
            for agent in ([word.agent] if word.agent else state.locations)
        }
        for agent, reached in zones.items():
            if was_reached(reached, state.clocks, self._tolerance):
                return word._replace(agent=agent)
        when = "yet" if any(zones.values()) else "here"
        self._reject("uncommanded", f"{format_word(word)}: the strategy does not command it {when}")
        return None

    def _take_command(self, moves: Tuple[Move, ...], now: float) -> List[SystemState]:
        """Apply the moves of a command, unless a robot that takes part is not where the state has it."""
        out = self.service.commanded(moves)
        if out:
            self._reject("uncommanded", f"{moves[0].edge.word}: {out} is out of service")
            return []
        if self.robots.refuse(moves, self.position(now).values):
            self._reject("held", f"{moves[0].edge.word}: {in_words(' and '.join(self.robots.reasons()))}")
            return self._status_changes(now)
        return self._take(moves, now, commanded=True)

    def _take(
        self, moves: Optional[Tuple[Move, ...]], now: float, why: str = "", commanded: bool = False,
        since: Mapping[str, float] = NOTHING,
    ) -> List[SystemState]:
        """Apply the moves, and then internal edges of objectives that are enabled. `why`: the reason if that loses the
        mission, a sentence; "": that the first of them happens. `since`: clocks that run since another time."""
        states: List[SystemState] = []
        if moves and not why:
            name, edge = moves[0]
            why = f"{marked(name)} {deed(MARKED, self.model.automaton(name), edge).does}"
        while moves:
            before = self.state(now)
            self._automata.take(moves, now)
            self._automata.set_clocks(since)
            since = NOTHING
            self.ending.on_moves(moves, before.clocks)
            self.robots.on_moves(moves)
            for name in self.shared_ends.on_moves(moves, self.lost, self._beginnings):
                self.late.discard(name)
                self.lost.pop(name, None)
                self.ways.turns.pop(name, None)
                self._planning.excused -= {name}
            self.seq, self._shown = self.seq + 1, self.robots.revision()
            self._beginnings.on_moves(moves, self.seq)
            self.orders.on_moves(moves, self.seq, commanded, self.lost, self.position(now).locations, now)
            self.counts["taken"] += 1
            self._warned = False
            self._agent, self._event = moves[0].automaton, moves[0].edge.word
            self._commanded, commanded = commanded, False
            self._log("info", f"state {self.seq}: {self._event} by {self._agent}")
            moves = self._evaluate(now, why)
            states.append(self.state(now))
            self._since = self._still_standing(before, states[-1])
        return states

    def _evaluate(self, now: float, why: str) -> Optional[Tuple[Move, ...]]:
        """End the mission if it is won, lost or not covered; else return the enabled internal edge of an objective."""
        position = self.position(now)
        if self._automata.is_won():
            self.goal_at = now
            self._win(now)
        elif self._automata.lost():
            broken = [self.model.says[name] for name in self._automata.lost() if name in self.model.says]
            self._conclude(life.LOSE, f"{why} (broken: {quoted(', '.join(broken))})" if broken else why, now)
        else:
            moves = self._automata.internal_move(position)
            if not moves and self._is_done(now):
                self._win(now)
            elif not moves:
                self._update_status(now, self._tolerance)
            return moves
        return None

    # Orders -----------------------------------------------------------------------------------------------------------

    def _unanswered(self, now: float) -> List[Tuple[Order, float]]:
        """Return the orders whose acknowledgement is still waited for, and when they were given."""
        waits = self._is_done(now)
        return [(order, given) for order, given in self.orders.open_since() if waits or order.agent not in self.lost]

    def _on_order_receipt(self, robot: str, seq: int, given: Optional[float], now: float) -> List[SystemState]:
        """Take that a robot's side has an order; the state that is published again answers it."""
        if self.orders.on_receipt(robot, seq, given):
            if self.lost.get(robot, "").startswith(UNACKNOWLEDGED):
                del self.lost[robot]
            if not self._is_done(now):
                return self._status_changes(now) or [self.state(now)]
            self._win(now)
        return [self.state(now)]

    # Reports ----------------------------------------------------------------------------------------------------------

    def _on_robot_report(self, report: RobotReport, now: float) -> List[SystemState]:
        """Take a report about a robot (failed, stuck, held, resumes, displaced, back) or a way (blocked, free)."""
        agent, location, wrong = report.agent, self._automata.location_of(report.agent), ""
        if self._is_over(agent, report.as_of, report.event):
            return []
        if report.event in (BLOCKED, FREE, STUCK):
            wrong, why = self.ways.on_report(report, location, agent in self.lost)
            if why:
                self._mark_lost(agent, why)
        elif report.event != FAILED:
            wrong = self.robots.on_report(report, location)
        elif not is_under_way(location) and agent not in self.robots.displaced:
            wrong = "expected the name of an agent that is under way"
        elif agent not in self.lost or self.ways.turns.pop(agent, None) is not None:
            self._mark_lost(agent, f"has failed {as_sentence(report.text)}".rstrip())
        else:
            self.robots.drop(agent)
        if wrong:
            self._reject("impossible", f"{agent}:{report.event}: {wrong}")
        return self._after_losses(now)

    def _on_report(self, word: Word, now: float) -> List[SystemState]:
        """Take a report of an event. The end of what several do together counts when all have reported it; that of an
        action in parts is the end of a part while others are left."""
        word = word._replace(event=self.model.reported(self.position(now), word.event, word.agent))
        if self.shared_ends.settles(word):
            self.lost.pop(word.agent, None)
            return self._status_changes(now)
        if self._is_over(word.agent or self._doer_of(word.event, now), word.as_of, word.event):
            return []
        counts = self.shared_ends.take(word, self.position(now), self.lost)
        if counts is not None:
            return self._take(self._moves_of(counts, now), now)
        who = word.agent or "the one who does it"
        self._log("info", f"{word.event}: {who} has finished, others have not")
        self.late.discard(word.agent)
        self.lost.pop(word.agent, None)
        return self._status_changes(now) or [self.state(now)]

    def _is_over(self, agent: str, as_of: Optional[int], event: str) -> bool:
        """Return True, and count it, for a report of what the agent has left since: a cut link brings it late."""
        if not self._beginnings.is_over(agent, event, as_of):
            return False
        begun = self._beginnings.of(agent, event)
        self._reject("stale", f"{event}#{as_of}: {agent} came in state {begun} to what it does now", level="info")
        return True

    def _doer_of(self, event: str, now: float) -> str:
        """Return who reports an event without its name; "" if it cannot happen."""
        moves = self.model.joint_move(self.position(now), event, timed=False)
        return moves[0].automaton if moves else ""

    def _after_losses(self, now: float) -> List[SystemState]:
        """Take an end that does not wait for lost agents any more; return new states, if there are any."""
        word = self.shared_ends.completed(self.position(now), self.lost)
        moves = self._moves_of(word, now) if word is not None else None
        return self._take(moves, now) if moves else self._status_changes(now)

    def _mark_lost(self, agent: str, why: str) -> None:
        self.lost[agent] = why
        self.robots.drop(agent)
        self._log("err", f"{agent} counts as lost: it {in_words(why)}")
