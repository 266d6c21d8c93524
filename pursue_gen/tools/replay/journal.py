"""The observer's journal: lines of JSON (format 2: with checksums), a head, then each call that changed something.

A journal holds no states: `worked_out` walks the scenario's automata by its words.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Dict, Iterator, List, Mapping, NamedTuple, Optional, Tuple, Union

from pursue_gen.language.network_names import DESK_OPEN, ORDER_DESK
from pursue_gen.tga.event_words import event_word
from pursue_gen.tga.network import Objective
from pursue_gen.tools.replay.moves import EXACT, DiscreteState, Move, Moves, after, breach, place_of, without
from pursue_gen.tools.replay.record import MissionRecord, RecordedWord, read_word
from pursue_runtime.bounded import json_object
from pursue_runtime.event_words import CANCELLED, FAILED, FINISH, ORDERED, PLANNED, START, STOP
from pursue_runtime.observer.records import parse_record
from pursue_runtime.state import LOST, RUNNING, STOPPED, WAITING, WON, SystemState

FORMATS = (1, 2)
CALLS = tuple("hear order tick silent back planned unplanned refused searching stop restarted adopted".split())
END = "told"
"""Closes a journal: the end of the mission was published."""

KEPT = 0.5
"""Time units after which a command that came early has been taken or overtaken: the observer's tolerance is smaller."""

MOST = 1000
"""By so many numbers one call may move a mission on; more is damage."""


class Ordered(NamedTuple):
    """An order: the event of its state, the number of its plan, and since when (seconds) clocks run that it starts."""

    event: str
    plan: int
    since: Mapping[str, float]


@dataclass(frozen=True)
class Entry:
    """A call of the observer at a moment (seconds), and number and status ("": not known) of the state after it.
    `ordered`: the order that was taken or cancelled then, as the journal has it; None: none was."""

    at: float
    call: str
    args: Tuple[Any, ...]
    seq: int
    status: str = ""
    ordered: Optional[Ordered] = None


@dataclass(frozen=True)
class Journal:
    """The head (format, scenario, unit …), the entries, and what could not be read."""

    head: Mapping[str, Any]
    entries: Tuple[Entry, ...]
    problems: Tuple[str, ...] = ()

    @property
    def plans_of_orders(self) -> Iterator[Mapping[str, Any]]:
        """The plans with which orders were taken, the newest first."""
        planned = (entry.args for entry in self.entries if entry.call == "planned" and len(entry.args) == 2)
        plans = {str(number): answer for number, answer in planned}
        for entry in reversed(self.entries):
            if entry.ordered is not None and isinstance(plans.get(str(entry.ordered.plan)), dict):
                yield plans[str(entry.ordered.plan)]

    @property
    def unit(self) -> float:
        """Seconds per time unit."""
        return _unit(self.head) or 1.0


def read_journal(content: bytes) -> Union[Journal, str]:
    """The journal in a file; a sentence where it is none."""
    lines = content.decode("utf-8", "replace").splitlines()
    head = _object(lines[0]) if lines else None
    if head is None or head.get("format") not in FORMATS or "scenario" not in head:
        return 'expected a first line such as {"format": 1, "scenario": …}, with or without checksum, number and length'
    if _unit(head) is None:
        return "its first line gives no length of a time unit in seconds"
    entries: List[Entry] = []
    problems: List[str] = []
    for number, line in enumerate(lines[1:], start=2):
        entry = _entry(line)
        if entry is not None:
            entries.append(entry)
        elif line.strip() and (_object(line) or {}).get("call") != END:
            problems.append(f"line {number} cannot be read, what follows was not read: {line[:60]!r}")
            break
    if not entries:
        return "; ".join([*problems, "nothing has happened in it"])
    return Journal(head, tuple(entries), tuple(problems))


def _unit(head: Mapping[str, Any]) -> Optional[float]:
    """Seconds per time unit, 1 where the head does not say; None for what is no length of time."""
    settings = head.get("settings")
    settings = settings if isinstance(settings, dict) else {}
    unit = head.get("unit", settings.get("time_unit", 1.0))
    good = isinstance(unit, (int, float)) and not isinstance(unit, bool) and 1e-9 < unit < 1e9
    return float(unit) if good else None


def _object(line: str) -> Optional[Dict[str, Any]]:
    """The JSON object of a line: of format 1, or of format 2 where its checksum is right."""
    if not line.startswith("{"):
        found = parse_record(f"{line}\n".encode())
        return found[1] if found is not None else None
    return json_object(line)


def _entry(line: str) -> Optional[Entry]:
    data = _object(line) or {}
    at, call, args, seq = (data.get(key) for key in ("at", "call", "args", "seq"))
    if not isinstance(at, (int, float)) or not abs(at) < 1e15 or call not in CALLS:
        return None
    if not isinstance(args, list) or not isinstance(seq, int) or seq < 0:
        return None
    return Entry(float(at), str(call), tuple(args), seq, str(data.get("status", "")), _ordered(data.get("ordered")))


def _ordered(data: Any) -> Optional[Ordered]:
    try:
        since = {str(clock): float(moment) for clock, moment in data["since"].items()}
        return Ordered(str(data["event"]), int(data["plan"]), since)
    except (LookupError, TypeError, ValueError, AttributeError, OverflowError):
        return None


def reconstruct(journal: Journal, moves: Moves, objective: Objective) -> MissionRecord:
    """The journal as a record: the states that its words lead to."""
    walk = _Walk(journal, moves, objective)
    for entry in journal.entries:
        walk.follow(entry)
    return MissionRecord(
        tuple(walk.states), tuple(walk.words), plans=walk.plans, problems=tuple(walk.problems), by_words=True
    )


class _Walk:
    def __init__(self, journal: Journal, moves: Moves, objective: Objective) -> None:
        self.states: List[SystemState] = []
        self.words: List[RecordedWord] = []
        self.plans: Dict[int, Mapping[str, Any]] = {}
        self.problems = list(journal.problems)
        self._unit, self._moves, self._objective = journal.unit, moves, objective
        self._place = moves.initial
        self._zeros: Dict[str, float] = {}
        self._seq, self._plan, self._status = 0, 0, WAITING
        self._event = self._agent = ""
        self._noted: List[RecordedWord] = []  # the ends that others had not reported yet
        self._early: List[RecordedWord] = []  # commands that were kept until they are due

    def follow(self, entry: Entry) -> None:
        """What one call did; the number of the state after it gives the number of steps to look for."""
        word = read_word(entry.at, str(entry.args[0])) if entry.call == "hear" and entry.args else None
        if word is not None:
            self.words.append(word)
        if entry.call == "planned" and len(entry.args) > 1 and isinstance(entry.args[1], dict):
            number = entry.args[0] if isinstance(entry.args[0], int) else -1
            self.plans[number] = {**entry.args[1], "plan": number}
        if entry.call == "adopted":
            self._adopt(entry)
            return
        if not self._seq <= entry.seq <= self._seq + MOST:
            self.problems.append(f"after state {self._seq} the journal goes on with state {entry.seq}")
            self._seq = entry.seq - 1
        if word is not None and entry.seq == self._seq and self._moves.sharing(self._place, word.event, word.agent):
            self._noted.append(word)
        if word is not None and word.seq is not None and entry.seq == self._seq:
            self._early.append(word)
        self._steps(entry, word)
        status = entry.status or self._ending(entry, word)
        if status and self.states and self.states[-1].status != status:
            self._status = status
            if word is None or word.event != ORDERED:  # what won it was done before that was acknowledged
                self._event = self._agent = ""
            self._show(entry.at)

    def _adopt(self, entry: Entry) -> None:
        """The observer did not know the states before this one: it continued from what other nodes had seen."""
        found = entry.args[0] if entry.args and isinstance(entry.args[0], dict) else {}
        try:
            state = SystemState(**found)
            place = place_of(state)
            zeros = {clock: float(state.stamp) - float(value) * self._unit for clock, value in state.clocks.items()}
            known = self._moves.knows(place) and set(zeros) == set(self._moves.network.clocks)
        except (TypeError, ValueError, AttributeError):
            known = False
        if not known:
            self.problems.append(f"the state {entry.seq} from which the observer continued is none of this scenario")
            return
        self.problems.append(f"states {self._seq + 1} to {state.seq} are not in the journal: other nodes had seen them")
        self._place, self._zeros, self._event, self._agent = place, zeros, state.event, state.agent
        self._seq, self._status, self._plan = entry.seq, entry.status or state.status, state.plan
        self._show(entry.at)

    def _steps(self, entry: Entry, word: Optional[RecordedWord]) -> None:
        while self._seq < entry.seq:
            self._seq += 1
            if entry.ordered is not None and entry.ordered.plan != self._plan:
                self._order(entry.ordered, entry.at)
            elif self._status == WAITING:
                self._status, self._zeros = RUNNING, dict.fromkeys(self._moves.network.clocks, entry.at)
                word = None if word and word.event == START else word
                self._event = self._agent = ""
            else:
                move = self._next(entry.at, word)
                if entry.call == "tick" and move is None:
                    move = self._due_command(entry.at)
                if entry.call == "tick" and move is None:
                    self._place = without(self._place, self._moves.overstayed(self._place, self._clocks(entry.at)))
                if entry.call == "tick" or (word is not None and word.event == FAILED):
                    move = move or self._without_lost()
                word = None if word and not word.event.startswith("_") else word
                if move is None:
                    self._event = self._agent = ""
                    if word is not None and word.event == PLANNED and word.seq is not None:
                        self._put_in_force(word.seq, entry.at)
                else:
                    self._take(move, entry.at)
            if self._seq == entry.seq and entry.status:
                self._status = entry.status
            self._show(entry.at)

    def _next(self, at: float, word: Optional[RecordedWord]) -> Optional[Move]:
        """The move of the word, else one that an objective makes by itself; None: the status has changed."""
        clocks = self._clocks(at)
        if word is not None and not word.event.startswith("_"):
            found = list(self._moves.of(self._place, word.event, word.agent))
            if not found:
                self._place, found = breach(self._moves, self._place, word.event, word.agent)
            if found:
                return min(found, key=lambda move: self._moves.untimely(move, self._place, clocks).amount)
        internal = self._moves.internal(self._place, self._objective)
        return next((move for move in internal if self._moves.is_due(move, self._place, clocks)), None)

    def _due_command(self, at: float) -> Optional[Move]:
        """The move of a command that came early, by less than the observer's tolerance, and is due now."""
        clocks = self._clocks(at)
        self._early = [word for word in self._early if at - word.at <= KEPT * self._unit]
        for word in self._early:
            for move in self._moves.of(self._place, word.event, word.agent):
                if self._moves.untimely(move, self._place, clocks).amount <= EXACT:
                    self._early.remove(word)
                    return move
        return None

    def _without_lost(self) -> Optional[Move]:
        """The end of what several did together, where the last who had not reported it is lost."""
        moves = (move for word in self._noted for move in self._moves.of(self._place, word.event, word.agent))
        return next(moves, None)

    def _order(self, order: Ordered, at: float) -> None:
        """An order is taken, or cancelled, together with its plan."""
        self._plan = order.plan
        self.plans[order.plan] = {**self.plans.get(order.plan, {}), "order": order.event}
        event = order.event[: -len(CANCELLED)] if order.event.endswith(CANCELLED) else ""
        if event:
            self._place = self._moves.withdrawn(event, self._place)
            self._agent, self._event = ORDER_DESK, order.event
            return
        place = DiscreteState(self._place.locations, {**self._place.values, DESK_OPEN: 1})
        move = next(self._moves.of(place, order.event, ORDER_DESK), None)
        if move is None:
            self.problems.append(f"{order.event} was ordered, which cannot be ordered here")
            return
        self._place = place
        self._take(move, at)
        self._zeros.update(order.since)

    def _put_in_force(self, number: int, at: float) -> None:
        """The plan is in force, and the robots that it sends back turn round."""
        self._plan = number
        named = self.plans.get(number, {}).get("turning")
        robots = named if isinstance(named, list) else []
        parts = [self._moves.way_back(self._place, str(robot)) for robot in robots]
        self._place, resets = after(tuple(part for part in parts if part is not None), self._place)
        self._zeros.update(dict.fromkeys(resets, at))

    def _take(self, move: Move, at: float) -> None:
        self._place, resets = after(move, self._place)
        self._noted = [word for word in self._noted if self._moves.sharing(self._place, word.event, word.agent)]
        self._zeros.update(dict.fromkeys(resets, at))
        self._agent, self._event = move[0][0], event_word(*move[0])
        goal, bad = self._objective.goal, self._objective.bad
        if goal and all(_at(self._place, where) for where in goal):
            self._status = WON
        elif any(_at(self._place, where) for where in bad):
            self._status = LOST

    def _ending(self, entry: Entry, word: Optional[RecordedWord]) -> str:
        """won or stopped, where this very call ends the mission without a step."""
        if self._status in (WON, LOST):
            return ""
        if entry.call == "stop" or (word is not None and word.text == STOP):
            return STOPPED
        return WON if word is not None and word.text == FINISH and not self._objective.goal else ""

    def _clocks(self, at: float) -> Dict[str, float]:
        return {clock: (at - zero) / self._unit for clock, zero in self._zeros.items()}

    def _show(self, at: float) -> None:
        self.states.append(
            SystemState(
                seq=self._seq,
                stamp=at,
                locations=dict(self._place.locations),
                values=dict(self._place.values),
                clocks=self._clocks(at),
                unit=self._unit,
                plan=self._plan,
                event=self._event,
                agent=self._agent,
                status=self._status,
            )
        )


def _at(place: DiscreteState, where: Tuple[str, str]) -> bool:
    return place.locations.get(where[0]) == where[1]
