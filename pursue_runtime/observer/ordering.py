"""What people order while a mission is under way: texts, the queue of what is looked at, answers.

An order is an event that no game has. It is accepted once a plan is proven that keeps all promises with it, from the
state behind it. Times are seconds of ROS time, unless they are said to be time units.
"""

from __future__ import annotations

import re
from typing import Collection, Dict, Iterator, List, NamedTuple, Optional, Tuple

from pursue_runtime.event_words import CANCELLED, JOINS, LEAVES, one_line
from pursue_runtime.locations import event_of, is_movement
from pursue_runtime.model import ORDER_DESK, Automaton, Edge, Model, Move, Position
from pursue_runtime.sentences import marked

MOST_WAITING = 20
"""So many orders wait for their answer at most: each takes a search of its own."""

ATTEMPTS = 20
"""So often a plan for an order is looked for, each time from another state, before the order is refused."""

WINDOW = 2.0
"""Seconds for which such a plan may come into force, from its begin on."""

QUIET = 0.2
"""Seconds for which nothing may be expected to happen where such a plan begins. Not measured."""

FAR = 5.0
"""Seconds after the first moment at which a plan can come within which one begins that has to come later. Not
measured."""

MOST_LEAD_TIME = 10.0
"""Seconds between a request and the first moment at which its plan can come, at most. Not measured."""

PATIENCE = 60.0
"""Seconds for which an order waits at most for a moment in which it is known what the mission will be at when a plan
can come."""

_UNITS = {"": 0.0, "s": 1.0, "min": 60.0, "h": 3600.0}
"""Units behind the time of an order, in seconds; without one it is in time units of the scenario."""

LONGEST = 200
"""Letters of an order at most."""

CANCEL, URGENT = "cancel", "urgent"
"""The words before an order that withdraw it, or have it looked at before those without such a word."""

LEAVE, JOIN = "leave", "join"
"""The words before a robot that is taken out of service, or is brought back."""

_SERVICE = re.compile(rf"\s*({LEAVE}|{JOIN})\s+([A-Za-z]\w*)\s*", re.ASCII)

_TEXT = re.compile(
    r"\s*(?:(cancel|urgent)\s+)?([A-Za-z(][\w ,()]*?)(?:\s+within\s+(\d{1,6}(?:\.\d{1,6})?)\s*(s|min|h)?)?\s*", re.ASCII
)

EXPECTED = (
    "the name of an order, perhaps with a time, as in: tea within 300 (time units), tea within 5 min, urgent tea; "
    "what is to hold or to happen, with a time: bot1 at room4 within 10 min; or cancel tea; or of a robot: leave bot1, "
    "join bot1"
)

MOST_WRITTEN = 50
"""So many different orders people can write in a mission: each is an automaton with a clock. Not measured."""


class PersonOrder(NamedTuple):
    """An order as it came: its event, within how many time units it is to be answered (None: as the scenario promises),
    when it came, the text that it is called by, and the word before it (CANCEL, URGENT, "": none). Behind LEAVE and
    JOIN the event is the robot.

    `says`: what a person has written, which the scenario has no event for; it has one of its own, "" as long as no plan
    is in force with it.
    """

    event: str
    within: Optional[float]
    came: float
    text: str
    how: str = ""
    says: str = ""

    @property
    def word(self) -> str:
        """Return the event of the state in which it is taken; of what has none so far its text."""
        words = {CANCEL: self.event + CANCELLED, LEAVE: LEAVES, JOIN: JOINS}
        return words.get(self.how, self.event or self.text)

    @property
    def is_service(self) -> bool:
        """Return True where a robot leaves or joins."""
        return self.how in (LEAVE, JOIN)


class OrderAnswer(NamedTuple):
    """The answer to an order: whether it is accepted, by when it is answered at the latest (ROS time; 0: it has no
    deadline, or is refused), within how many time units it could be promised (0: that is not known), and why it is
    refused, a sentence; of a robot that leaves or joins what that means."""

    order: str
    accepted: bool
    by: float = 0.0
    possible: float = 0.0
    why: str = ""

    def text(self, now: float) -> str:
        """Return the answer as a sentence at the time `now`, with names in braces."""
        if self.order.startswith(f"{CANCEL} "):
            return "cancelled" if self.accepted else f"not cancelled: {self.why}"
        if self.accepted and self.why:
            return self.why
        if self.accepted:
            return "accepted" + (f": answered in {max(0.0, self.by - now):.0f} s at the latest" if self.by else "")
        could = f"; it could be promised within {self.possible:g} time units" if self.possible else ""
        return f"refused: {self.why}{could}"


class Effect(NamedTuple):
    """What an order does: the moves, and the clocks that it starts, with the value (time units) that they begin with,
    more than 0 where it is to be answered sooner than the scenario promises."""

    moves: Tuple[Move, ...]
    clocks: Dict[str, float]
    deadline: Optional[float]
    """Time units until the first of its answers is due; None: none is."""

    def after(self, position: Position, passed: float) -> Position:
        """The position that it leads to, where so many time units have passed since it came."""
        after = Model.after(self.moves, position)
        return after._replace(clocks={**after.clocks, **{name: at + passed for name, at in self.clocks.items()}})


class Refused(Exception):
    """An order cannot be taken; its text, a sentence, says why."""


def read_order(text: str, came: float, unit: float, model: Model) -> PersonOrder:
    """Read `event`, `urgent event within 5 min`, `bot1 at room4 within 5 min`, `cancel event`, `leave robot` or
    `join robot`; `unit`: seconds per time unit. Raises Refused."""
    service = _SERVICE.fullmatch(text) if len(text) <= LONGEST else None
    if service is not None:
        return PersonOrder(service[2], None, came, called(text.strip()), service[1])
    match = _TEXT.fullmatch(text) if len(text) <= LONGEST else None
    how, says, number, unit_name = match.groups() if match is not None else ("", "", None, None)
    words = says.split()
    is_service = words[:1] in ([LEAVE], [JOIN]) and words[1:2] in [[each.name] for each in model.of_kind("robot")]
    is_wrong = is_service or "within" in words or (how == CANCEL and number is not None and says in model.orders)
    if match is None or is_wrong:
        raise Refused(f"this is no order; expected {EXPECTED}")
    seconds = _UNITS[unit_name or ""]
    within = None if number is None else float(number) * seconds / unit if seconds else float(number)
    order = PersonOrder(says, within, came, called(text.strip()), how or "")
    if says in model.orders or not _is_written(says, model):
        return order
    if within is None and how != CANCEL:
        raise Refused(f"it says no time; expected one behind it, as in: {says} within 10 min")
    return order._replace(event="", says=" ".join(says.split()), within=None if within is None else round(within, 3))


def is_order(text: str, menu: Collection[str]) -> bool:
    """Return True for what only an order can be: one of the menu, or what is written with a time, or cancelled; or a
    robot that leaves or joins."""
    if len(text) <= LONGEST and _SERVICE.fullmatch(text):
        return True
    match = _TEXT.fullmatch(text) if len(text) <= LONGEST else None
    how, says, number, _ = match.groups() if match is not None else ("", "", None, None)
    return says in menu or (match is not None and (number is not None or (bool(how) and " " in says)))


def _is_written(says: str, model: Model) -> bool:
    """Return True for what is no name alone, or is that of something that happens."""
    return not says.isidentifier() or any(edge.word == says for each in model.automata for edge in each.edges)


def meant(model: Model, position: Position, order: PersonOrder) -> PersonOrder:
    """Return an order that was written with the event of the same one before: of one that allows as much time, or that
    waits for its answer where it is to be cancelled. Raises Refused where there are too many."""
    alike = [each for each in model.written if each.says == order.says]
    if not order.says or order.event:
        return order
    if order.how == CANCEL:
        waiting = [each.event for each in alike if _waits(model, position, each.event)]
        return order._replace(event=waiting[-1] if waiting else "")
    known = [each.event for each in alike if each.within >= (order.within or 0.0)]
    if not known and len(model.written) == MOST_WRITTEN:
        raise Refused(f"{MOST_WRITTEN} different orders were written in this mission; order one of them again")
    return order._replace(event=known[0] if known else "")


def _waits(model: Model, position: Position, event: str) -> bool:
    """Return True where an objective of the order waits for its answer."""
    asked = [automaton for automaton in model.of_kind("safety") if _listens(automaton.edges, event)]
    return any(automaton.invariants[position.locations[automaton.name]] for automaton in asked)


def called(text: str) -> str:
    """Return what an order is called by in its answer: its text on one line."""
    return one_line(text)[:80]


def effect(model: Model, position: Position, order: PersonOrder) -> Effect:
    """Return what an order does in this position. Raises Refused."""
    orders = model.orders
    if order.says and not order.event:
        if order.how == CANCEL:
            raise Refused(f"nobody waits for {order.says}")
        return Effect((), {}, order.within)  # what it does is known with its plan
    if order.event not in (*orders, *(each.event for each in model.written)):
        known = f"expected one of {', '.join(map(marked, orders))}" if orders else "this scenario has no orders"
        raise Refused(f"nobody can order {order.event}; {known}")
    if order.how == CANCEL:
        return Effect(tuple(_withdrawn(model, position, order.event)), {}, None)
    (desk,) = model.of_kind(ORDER_DESK)
    closed = _edge(desk.edges, order.event).assign
    open_ = position._replace(values={**position.values, **dict.fromkeys(closed, 1)})
    moves = model.joint_move(open_, order.event, desk.name)
    if moves is None:
        raise Refused(f"{marked(order.event)} cannot be ordered now: it is not its turn, or as many wait as may")
    limits = {
        clock: bound.bound
        for name, edge in moves
        for bound in model.bounds_of(name, edge.target, open_.values)
        for clock in edge.resets
        if bound.left == clock
    }
    asked = any(_listens(automaton.edges, order.event) for automaton in model.of_kind("safety"))
    if len(moves) == 1 and (asked or order.says):
        if _waits(model, position, order.event):
            raise Refused(f"{marked(order.event)} was ordered already, and waits for its answer")
        raise Refused("what is asked for is so already")
    if order.within is None:
        return Effect(moves, dict.fromkeys(limits, 0.0), min(limits.values(), default=None))
    if not limits:
        raise Refused(f"the scenario gives {marked(order.event)} no deadline: order it without within")
    if order.within > min(limits.values()):
        most = f"{min(limits.values()):g}"
        why = f"the scenario promises {marked(order.event)} within {most} time units: order it within that"
        raise Refused(why + _with_more_time(model, order))
    return Effect(moves, {clock: limit - order.within for clock, limit in limits.items()}, order.within)


def _with_more_time(model: Model, order: PersonOrder) -> str:
    """How what an order asks for can be had with more time than the scenario gives it; "" where it is not one event."""
    asked = [each for each in model.of_kind("safety") if _listens(each.edges, order.event)]
    words = {
        edge.word
        for each in asked
        for edge in each.edges
        if each.invariants[edge.source] and edge.sync == "receive" and edge.word != order.event
    }
    doing = {edge.word for each in model.automata for edge in each.edges if edge.word in words and _is_deed(edge)}
    if len(words) != 1 or words != doing:
        return ""
    return f", or with more time what is to happen: do {event_of(words.pop())} within {order.within:g}"


def _is_deed(edge: Edge) -> bool:
    """Return True for what somebody does at a place, or ends there."""
    return edge.sync == "send" and not is_movement(edge.source) and not is_movement(edge.target)


def _withdrawn(model: Model, position: Position, event: str) -> List[Move]:
    """Return what the objectives of an order do when it is withdrawn: each as if the one that waits longest had its
    answer. Raises Refused where none waits for one, or somebody is at it."""
    moves: List[Move] = []
    for automaton in model.of_kind("safety"):
        answers = list(_answers(model, automaton, position)) if _listens(automaton.edges, event) else []
        for ends in (model.joint_move(position, edge.word, timed=False) for edge in answers):
            if ends is not None and ends[0].edge.is_end:
                raise Refused(f"{marked(ends[0].automaton)} is at it already")
        moves += [Move(automaton.name, edge) for edge in answers[:1]]
    if not moves:
        raise Refused(f"no {marked(event)} waits for its answer")
    return moves


def _answers(model: Model, automaton: Automaton, position: Position) -> Iterator[Edge]:
    """The edges with which what an objective waits for comes in time."""
    here, bounds = position.locations[automaton.name], automaton.invariants
    for edge in automaton.edges_from(here) if bounds[here] else ():
        answered = edge.sync == "receive" and not bounds[edge.target] and (automaton.name, edge.target) not in model.bad
        if answered and edge.allowed(position.values):
            yield edge


def _edge(edges: Tuple[Edge, ...], event: str) -> Edge:
    return next(edge for edge in edges if edge.word == event)


def _listens(edges: Tuple[Edge, ...], event: str) -> bool:
    return any(edge.word == event and edge.sync == "receive" for edge in edges)


class Ordering:
    """The orders that wait for their answer, the first of which is looked at, and the answers that were given.

    `attempts`: how often a plan was looked for with the first one; `lead_time`: seconds that this has taken so far.
    """

    def __init__(self) -> None:
        self.waiting: List[PersonOrder] = []
        self.attempts, self.lead_time = 0, 0.0
        self._count = 0
        self._answers: List[OrderAnswer] = []

    @property
    def first(self) -> Optional[PersonOrder]:
        """Return the order that is looked at; None: there is none."""
        return self.waiting[0] if self.waiting else None

    @property
    def revision(self) -> Tuple[int, int, int]:
        """Return a value that changes with what is ordered and answered."""
        return self._count, len(self.waiting), self.attempts

    def add(self, order: PersonOrder) -> None:
        """Take an order. Raises Refused where too many wait."""
        if len(self.waiting) == MOST_WAITING:
            raise Refused(f"{MOST_WAITING} orders wait for their answer already; order it again later")
        first = sum(bool(each.how) for each in self.waiting) if order.how else len(self.waiting)
        self.waiting.insert(first, order)
        self._count += 1
        if first == 0:
            self.attempts, self.lead_time = 0, 0.0

    def withdraw(self, cancel: PersonOrder) -> Optional[PersonOrder]:
        """Take back the newest order of the same that waits for its answer, and return it; None: none waits."""
        same = cancel.says or cancel.event
        for order in sorted(self.waiting, key=lambda each: -each.came):
            if (order.says or order.event) == same and order.how in ("", URGENT):
                if order is self.first:
                    self.attempts, self.lead_time = 0, 0.0
                self.waiting.remove(order)
                self._count += 1
                return order
        return None

    def answer(self, answer: OrderAnswer) -> None:
        """Answer the first order. Requires that there is one."""
        self.waiting.pop(0)
        self.attempts, self.lead_time = 0, 0.0
        self.say(answer)

    def say(self, answer: OrderAnswer) -> None:
        """Give an answer; of an order that was not taken nothing is kept, so strangers fill no journal."""
        self._answers.append(answer)

    def drain(self) -> List[OrderAnswer]:
        """Return the answers that were given since the last call."""
        answers, self._answers = self._answers, []
        return answers
