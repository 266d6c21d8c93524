"""The mission as the terminal shows it: which nodes are ready, possible words, events, the end.

Times are seconds of ROS time, `real` ones of the real clock; `at` and `opens` are in time units.
"""

from __future__ import annotations

from typing import Any, Collection, Dict, List, Mapping, NamedTuple, Optional, Protocol, Sequence, Tuple

from pursue_runtime.event_words import (
    FINISH,
    PING,
    RESUME,
    START,
    RobotReport,
    Word,
    event_in,
    format_report,
    format_word,
    one_line,
    parse_word,
)
from pursue_runtime.locations import TO_BE_SAID, is_movement
from pursue_runtime.model import Model
from pursue_runtime.resend import resend_timeout
from pursue_runtime.sentences import Told, in_words
from pursue_runtime.simulator.simulator import report_word, reports
from pursue_runtime.state import ENDED, HOLDING, LIVE, LOST, RUNNING, WON, SystemState, older, rewinds
from pursue_runtime.strategy import Entry, Plans, Strategy
from pursue_runtime.ui.waits import AtDoors, Turns
from pursue_runtime.vocabulary import deed, instruction, is_fact, said_at_start, sentence, where
from pursue_runtime.zones import due

MARGIN = 0.05  # time units: how far inside an open bound something counts as possible


class PossibleWord(NamedTuple):
    """`word` can be published from `opens` to `closes`, time units from now, unless another event comes first; `text`
    says what happens then.
    """

    word: str
    opens: float
    closes: float
    agent: str = ""
    text: str = ""


class Task(NamedTuple):
    """What an agent is doing (a person: what it is to do), in words, and the word that a person reports its end with.

    `label` is for the button: Arrived or Done. `shown`: what people read for the agent.
    """

    agent: str
    kind: str
    text: str
    label: str
    word: str
    shown: str


def possible_words(model: Model, state: SystemState, clocks: Dict[str, float], kinds: Collection[str] = ("agent",),
             ends: bool = False) -> List[PossibleWord]:
    """What agents of these kinds can start (and with `ends` also end) in this state, in system order, and what has
    to be said: what states are found to be, and where agents start."""
    found: Dict[str, PossibleWord] = {}
    for automaton in model.of_kind(*kinds):
        location = state.locations.get(automaton.name, "")
        for edge in automaton.edges_from(location):
            hidden = edge.is_end and location not in TO_BE_SAID and not ends
            if edge.sync == "receive" or hidden:
                continue
            zone = edge.when + automaton.invariants[location]
            opens = due([zone], clocks, MARGIN) if edge.allowed(state.values) else None
            if opens is None:
                continue
            closes = min([bound.bound - clocks[bound.left] for bound in zone if bound.left], default=float("inf"))
            word = report_word(model, automaton.name, edge.word)
            text = f"{model.shown(automaton.name)} {deed(model, automaton, edge).does}"
            found.setdefault(word, PossibleWord(word, opens, closes, automaton.name, text))
    return list(found.values())


def reporters(model: Model, ends: bool, settings: Mapping[str, Any]) -> List[str]:
    """The agents whose ends a person reports: people, and with `ends` all whose ends are reported (`settings` are
    those of ui.yaml), since nobody is simulated then."""
    reported = settings.get("reports", [automaton.name for automaton in model.automata]) if ends else ()
    agents = [agent for agent in model.acting if not is_fact(agent)]
    return [agent.name for agent in agents if agent.is_person or agent.name in reported]


def tasks(model: Model, state: SystemState, agents: Collection[str]) -> List[Task]:
    """Return what those of these agents do that are under way, in system order; the end may be reported at any time.

    A robot that is held has the task to resume.
    """
    found = []
    for automaton in model.acting:
        location = state.locations.get(automaton.name, "")
        if automaton.name not in agents:
            continue
        if automaton.name in state.held:
            resume = format_report(RobotReport(automaton.name, RESUME))
            text, shown = "held, until it is to continue", model.shown(automaton.name)
            found.append(Task(automaton.name, automaton.kind, text, "Resume", resume, shown))
            continue
        begin = next((edge for edge in automaton.edges if edge.target == location != edge.source), None)
        ends = (edge for edge in automaton.edges_from(location) if edge.is_end)
        end = next((edge for edge in ends if reports(automaton, edge)), None)
        if begin is not None and end is not None:
            text = instruction(model, automaton, begin) if automaton.is_person else where(model, automaton, location)
            label = "Arrived" if is_movement(location) and not automaton.is_person else "Done"
            word = report_word(model, automaton.name, end.word)
            found.append(Task(automaton.name, automaton.kind, text, label, word, model.shown(automaton.name)))
    return found


class Readiness:
    """Which of the expected nodes are ready, by their diagnostics."""

    def __init__(self, nodes: Sequence[str]) -> None:
        self._ready = {node.strip("/"): False for node in nodes}
        self._says: Dict[str, str] = {}

    def update(self, node: str, ready: bool, says: str = "") -> None:
        """Take a node's readiness from its diagnostics, with what it `says` of it."""
        if node.strip("/") in self._ready:
            self._ready[node.strip("/")] = ready
            self._says[node.strip("/")] = says

    def missing(self) -> List[str]:
        """The nodes that are not ready, in the order in which they are expected."""
        return [node for node, ready in self._ready.items() if not ready]

    def reasons(self) -> List[str]:
        """The same, each with what it says of that."""
        return [f"{node} ({self._says[node]})" if self._says.get(node) else node for node in self.missing()]


class Environment(Protocol):
    """Plays the uncontrollable agents."""

    def on_state(self, state: SystemState, start: float, now: float) -> None:
        """A state came; the mission started at `start`."""

    def due(self, now: float) -> List[str]:
        """Return the words to publish now."""

    def next_moment(self) -> Optional[float]:
        """Return when to call `due` again if no other state comes."""


def traffic_lines(topic: str, text: str, elapsed: float) -> List[str]:
    """The lines to print of a message on a topic, `elapsed` time units after the start; none for `_ping_`."""
    first, *more = [one_line(line) for line in text.splitlines()] or [""]
    if first == PING:
        return []
    return [f"{elapsed:8.1f}  on {topic}: {first}", *(f"{'':10}{line}" for line in more)]


class MissionView:
    """One mission, from its states: the words to publish, the lines to print, and the verdict."""

    def __init__(
        self, model: Model, player: Environment, orders: Optional[Strategy] = None, turns: Optional[Turns] = None,
        at_doors: Optional[AtDoors] = None,
    ) -> None:  # fmt: skip
        """`orders`: the part of the strategy that people carry out; `turns`: whose turn it is at places; `at_doors`:
        who waits for which door or lift."""
        self.state: Optional[SystemState] = None
        self.start: Optional[float] = None
        self.counts = "time units"  # what times count, as people say it
        self._model, self._told = model, Told()
        self._environment = player
        self._turns, self._at_doors = turns or Turns(model, {}), at_doors or AtDoors({}, str)
        self._orders = None if orders is None else Plans(orders)
        self._since: Dict[Entry, SystemState] = {}  # in which is decided what stands in the present state
        self._ordered: Tuple[int, float, int] = (-1, 0.0, 0)  # the state of the last order, when (real), how often
        self._events = {edge.word for automaton in model.automata for edge in automaton.edges}
        self._people = {automaton.name for automaton in model.of_kind("human")}

    def elapsed(self, now: float) -> float:
        """Time units since the start (0 before it)."""
        if self.start is None or self.state is None:
            return 0.0
        return max(0.0, now - self.start) / self.state.unit

    def add_plan(self, plan: int, orders: Strategy) -> None:
        """What people do by a new plan."""
        if self._orders is not None:
            self._orders.add(plan, orders)

    def on_state(self, state: SystemState, now: float) -> List[str]:
        """A state came; the lines to print."""
        last = self.state
        if last is not None and (older(state, last) or rewinds(state, last)):
            return []
        news = self.state is None or self.state.seq != state.seq or self.state.status != state.status
        orders = self._orders.strategy_for(state) if self._orders is not None and news else None
        if news:
            self._since = orders.since(self._since, self.state, state) if orders is not None else {}
        self.state = state
        if self.start is None and state.seq > 0:
            # After a restart, the oldest clock still shows the time since the start.
            age = 0.0 if state.event == START else max(state.clocks.values(), default=0.0)
            self.start = state.stamp - age * state.unit
        if self.start is None or not news:
            return self._end_lines(state, last)
        if state.status in LIVE:
            self._environment.on_state(state, self.start, now)
        return [*self._lines(state, last), *self._end_lines(state, last)]

    def say_again(self) -> None:
        """Have the last instruction published again at once, unless a state has answered it: an observer has appeared.
        """
        self._ordered = (-1, 0.0, 0)

    def due(self, now: float, real: float) -> List[str]:
        """The words to publish at this moment."""
        if self.state is None or self.state.status not in LIVE:
            return []
        words = [self._numbered(text, self.state.seq) for text in self._environment.due(now)]
        order = self._next_order(now) if real >= self._resend_at() else None
        if order is not None and order[0] <= now + 1e-6:
            count = self._ordered[2] + 1 if self._ordered[0] == self.state.seq else 1
            self._ordered = (self.state.seq, real, count)
            words.append(format_word(order[1]))
        return words

    def _numbered(self, text: str, seq: int) -> str:
        """Return what a player says with the number of the state in which it says it; no events stay as they are."""
        word = parse_word(text)
        return text if word is None or word.event not in self._events else format_word(word._replace(as_of=seq))

    def next_moments(self, now: float) -> Tuple[Optional[float], Optional[float]]:
        """When to ask `due` again: in ROS time, and on the real clock; None: not before the next state."""
        if self.state is None or self.state.status not in LIVE:
            return None, None
        moments = [self._environment.next_moment()]
        order = self._next_order(now)
        given = self._ordered[0] == self.state.seq
        if order is not None and not given:
            moments.append(order[0])
        return (
            min((moment for moment in moments if moment is not None), default=None),
            self._resend_at() if order is not None and given else None,
        )

    def verdict(self) -> Optional[Tuple[int, str]]:
        """Return the exit status and a sentence; None while the mission goes on."""
        state = self.state
        if state is None or state.status not in ENDED:
            return None
        after = f"after {self.elapsed(state.stamp):.1f} {self.counts}"
        reason = in_words(state.reason, self._model.shown)
        if state.status == WON:
            several = len(self._model.says) > 1
            goal = "All goals are reached" if len(self._model.goal) > 1 else "The goal is reached"
            kept = "All objectives were kept to the end" if several else "The objective was kept to the end"
            return 0, f"{goal if self._model.goal else kept}, {after}{f'; {reason}' if reason else ''}."
        if state.status == LOST:
            return 1, f"The mission is lost, {after}: {reason or 'the safety objective is broken'}."
        return 1, f"The mission was stopped, {after}: {reason or '_stop_ was published'}."

    def first_line(self, now: float) -> str:
        """Return what to say when the mission runs, with when it ends, and what it does not promise."""
        return f"{self.elapsed(now):8.1f}  the mission runs{said_at_start(self._model)}"

    def progress(self, now: float) -> str:
        """Return a line with the location of each agent, and for whom it waits."""
        if self.state is None:
            return "waiting for the first state"
        model, at = self._model, self.state.locations
        waits = {**self._turns.waits(self.state), **self._at_doors.says(self.state)}
        places = [
            f"{model.shown(automaton.name)} {where(model, automaton, at.get(automaton.name, '?'))}"
            + (f" ({waits[automaton.name]})" if automaton.name in waits else "")
            for automaton in model.acting
        ]
        return f"{self.elapsed(now):8.1f}  " + "  ".join(places)

    def _resend_at(self) -> float:
        """The real moment before which the last order may still be on its way."""
        seq, real, count = self._ordered
        if self.state is None or self.state.seq != seq:
            return float("-inf")
        return real + resend_timeout(count, self._model.reaction * self.state.unit)

    def _next_order(self, now: float) -> Optional[Tuple[float, Word]]:
        if self._orders is None or self.state is None or self.state.status != RUNNING:
            return None
        orders = self._orders.strategy_for(self.state)
        order = orders.decided(self._since, now) if orders else None
        if order is None:
            return None
        return order[0], Word(order[1].agent, order[1].event, self.state.seq)

    def _lines(self, state: SystemState, last: Optional[SystemState]) -> List[str]:
        lines = []
        if state.event and (last is None or last.seq != state.seq):
            lines.append(f"{self.elapsed(state.stamp):8.1f}  {sentence(self._model, state, last)}")
        if state.status == HOLDING:
            why = in_words(self._told.news(state.reason or "no reason is given"), self._model.shown)
            lines += [f"{self.elapsed(state.stamp):8.1f}  the mission holds: {why}"] if why else []
        if state.status == RUNNING:
            self._told.forget()
            instructions = [self._instruction(person, state, last) for person in sorted(self._people)]
            lines += [f"          {instruction}" for instruction in instructions if instruction]
        return lines

    def _end_lines(self, state: SystemState, last: Optional[SystemState]) -> List[str]:
        """What the end of the mission waits for, when that is news."""
        if self.start is None or state.status != RUNNING or state.reason in ("", "" if last is None else last.reason):
            return []
        return [f"{self.elapsed(state.stamp):8.1f}  {in_words(state.reason, self._model.shown)}"]

    def _instruction(self, person: str, state: SystemState, last: Optional[SystemState]) -> str:
        """What a person must do now whose event this is, or who is busy with it from now on; "" where that is over."""
        automaton, here = self._model.automaton(person), state.locations.get(person)
        if person != state.agent and (last is None or last.locations.get(person) == here):
            return ""
        for edge in automaton.edges:
            if edge.word == state.event and edge.target == here:
                over, text = edge.is_end, instruction(self._model, automaton, edge)
                return "" if over else f"{self._model.shown(person)}: {text} now"
        return ""


def report_text(task: Task) -> str:
    """What the report of the end of a task says."""
    return f"{task.shown} is done: {task.text}" if task.label == "Done" else f"{task.shown}: {task.label.lower()}"


def menu(offers: Sequence[PossibleWord], may_finish: bool = False) -> List[str]:
    """Return the menu of the words that can be published now. `may_finish`: the mission has no goal."""
    lines = []
    for number, (word, opens, closes, _, text) in enumerate(offers, start=1):
        until = f", for {closes - opens:.1f} time units" if closes != float("inf") else ""
        later = f"  (in {opens:.1f} time units{until})" if opens > MARGIN else ""
        lines.append(f"  {number:2}  {f'{text}: ' if text else ''}{word}{later}")
    finish = "finish, " if may_finish else ""
    lines.append(f"  a number, a word for pursue/events, done, {finish}ping or stop; Enter shows this again")
    return lines


def read_done(who: str, given: Sequence[Task]) -> Tuple[str, str]:
    """Return the word that reports the end of an agent's task, and a remark for the terminal. Nobody named: the only
    person with a task, else the only agent with one."""
    people = [task for task in given if task.kind == "human"]
    meant = [task for task in given if task.agent == who] if who else people or list(given)
    if len(meant) == 1:
        return meant[0].word, ""
    if not meant:
        return "", f"{who} has nothing to do now" if who else "there is nothing to do now"
    return "", f"who? expected {' or '.join(f'done {task.agent}' for task in meant)}"


def done_hints(given: Sequence[Task]) -> List[str]:
    """Return what to type at the end of tasks; robots report theirs themselves in most missions."""
    people = [task for task in given if task.kind == "human"]
    others = [task for task in given if task.kind == "agent"]
    hints = []
    if people:
        names = " or ".join(f"done {task.agent}" for task in people)
        hints.append(f"type {'done' if len(people) == 1 else names} when it is done")
    hints += [f"type done {task.agent} when {task.agent} has {'arrived' if task.label == 'Arrived' else 'done it'}"
              for task in others]
    return hints


def read_line(
    text: str, offers: Sequence[PossibleWord], words: Collection[str], given: Sequence[Task] = ()
) -> Tuple[str, str]:
    """Return the word to publish for a typed line ("" for none), and a remark for the terminal ("" for none)."""
    text = text.strip()
    if text in ("ping", "stop"):
        return f"_{text}_", ""
    if text == "finish" and "finish" not in words:
        return FINISH, ""
    if text.split(None, 1)[:1] == ["done"] and "done" not in words:
        return read_done(text[len("done"):].strip(), given)
    if text.isdigit():
        number = int(text)
        if not 1 <= number <= len(offers):
            return "", f"there is no number {number}" + (f"; expected 1 to {len(offers)}" if offers else " now")
        offer = offers[number - 1]
        if offer.opens > MARGIN:
            return "", f"{offer.word} is possible in {offer.opens:.1f} time units, not now"
        return offer.word, ""
    event = event_in(text)
    if event in words or event.startswith("_") or text == FINISH:
        return text, ""
    return text, f"{text} is not a word of this scenario; it was published anyway" if text else ""
