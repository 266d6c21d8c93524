"""A strategy with orders of passage: all of its plays are one course of events (see `course`).

The blocks of such a strategy name what their agent needs to know, and hold whatever the rest does. First one play is
followed to its end. Then it is shown that every other one is the same course: whatever could happen where its needs
are met is the event that the course has there, nobody else hears of it, and nothing ends a state that another event
still needs. So no command grows stale and none is in the way of another; what is to be avoided never happens if its
guard holds in no states that can be so at the same time; and all plays come to the end of the course. How late that is
at worst is the longest way through the events.
"""

from __future__ import annotations

from collections import deque
from typing import AbstractSet, Deque, Dict, List, Mapping, NamedTuple, Optional, Sequence, Set, Tuple

from pursue_gen.proof.course import Course, Event, Stay, Value
from pursue_gen.proof.independence import why_it_matters
from pursue_gen.proof.relaxed_reachability import commanded, is_controllers, live
from pursue_gen.synthesis.limits import LimitMonitor
from pursue_gen.synthesis.strategy import Block, Command, Strategy
from pursue_gen.tga.network import Clause, Edge, Network, Objective
from pursue_gen.tga.part import part_of

_MOST = 20_000
"""So many events a course may have. Measured on 30 robots that change places."""

_AHEAD = 6
"""So many rounds a robot may be ahead of another one on whom it waits. Not measured."""


class Fault(Exception):
    """Why the strategy is not proven."""


Here = Tuple[str, str]
"""An automaton and its location."""


class Played(NamedTuple):
    """The part of a network that a strategy speaks of, without dead edges, what it avoids there, and its course.

    `checked`: what begins with one of so many first events is looked at; what follows is there to meet it, and goes on
    like it.
    """

    part: Network
    objective: Objective
    course: Course
    checked: int


_last: List[Tuple[Network, Objective, Strategy, Played]] = []
"""What was asked for last: proof, worst case and margin look at the same course, one after the other."""


def played(network: Network, objective: Objective, strategy: Strategy, monitor: LimitMonitor) -> Played:
    """The course of a strategy, once it is shown to be that of all its plays, and to avoid what is to be avoided.

    Times are not looked at (see `timing`). Raises Fault, and LimitHit at a limit.
    """
    if _last and all(old is new or old == new for old, new in zip(_last[0], (network, objective, strategy))):
        return _last[0][3]
    if any(passage.again is objective.reaches for passage in strategy.passages):
        raise Fault("robots go round where there is no goal, and nowhere else")
    if strategy.stages or strategy.shares or strategy.left_out_clocks or network.start:
        raise Fault("it has stages, shares, clocks that it leaves out, or a start in the middle")
    alive, extent = live(network, commanded(strategy.blocks))
    bad = tuple((name, place) for name, place in objective.bad if place in extent.places[name])
    wanted = Objective.of(objective.goal if objective.reaches else (), bad)
    part = _part(alive, wanted, strategy, [name for name, _ in objective.bad if alive.automaton(name).stays])
    why = why_it_matters(alive, wanted, part, extent.places)
    if why:
        raise Fault(f"it does not speak of what matters: {why}")
    search = _CommandedSearch(part, wanted, strategy, network.taken_over, monitor)
    checked = search.follow() if objective.reaches else search.follow_rounds()
    search.check(checked)
    found = Played(part, wanted, search.course, checked)
    _last[:] = [(network, objective, strategy, found)]
    return found


def _part(alive: Network, wanted: Objective, strategy: Strategy, due: Sequence[str]) -> Network:
    """What the blocks name and the objective is about, what has a deadline (`due`), with all variables of that."""
    automata = {*due, *(name for block in strategy.blocks for name in block.state.names[0])}
    automata.update(name for name, _ in (*wanted.goal, *wanted.bad))
    unknown = automata.difference(automaton.name for automaton in alive.automata)
    if unknown:
        raise Fault(f"there is no {min(unknown)}")
    variables = {name for block in strategy.blocks for name in block.state.names[1]}
    variables.update(name for owner, edge in alive.edges if owner in automata for name in edge.variables)
    if not variables.issubset(dict(alive.variables)):
        raise Fault("a block names a variable that there is not")
    return part_of(alive, automata, variables)


class _CommandedSearch:
    def __init__(
        self, part: Network, objective: Objective, strategy: Strategy, taken: AbstractSet[str], monitor: LimitMonitor
    ) -> None:
        self._part, self._objective, self._strategy, self._monitor = part, objective, strategy, monitor
        self._automata = {automaton.name: automaton for automaton in part.automata}
        self._first = {p.name: self._automata[p.name].initial for p in strategy.passages if p.name in self._automata}
        self._bad = set(objective.bad)
        self._free: Dict[Here, List[Edge]] = {}
        self._threats: List[Tuple[str, Edge]] = []
        for name, edge in part.edges:
            if edge.received is not None:
                if edge.guard.clocks:
                    raise Fault(f"when {name} receives depends on a clock")
            elif is_controllers(edge, taken):
                continue
            elif (name, edge.target) in self._bad:
                self._threats.append((name, edge))
            else:
                self._free.setdefault((name, edge.source), []).append(edge)
        self._said: Dict[Here, List[Tuple[int, Command]]] = {}
        self._interested: Dict[str, Dict[str, None]] = {}
        self._named: List[Dict[str, Value]] = []
        for number, block in enumerate(strategy.blocks):
            self._take(number, block)
        for (name, _), edges in self._free.items():
            for edge in edges:
                self._interested.setdefault(name, {})[name] = None
                for variable in edge.variables:
                    self._interested.setdefault(variable, {})[name] = None
        start: Dict[str, Value] = {automaton.name: automaton.initial for automaton in part.automata}
        start.update(part.variables)
        self.course = Course(start)

    def _take(self, number: int, block: Block) -> None:
        named: Dict[str, Value] = {**dict(block.state.locations), **dict(block.state.values)}
        self._named.append(named)
        for command in block.commands:
            sender = command.moves[0].automaton if command.moves else ""
            if sender not in dict(block.state.locations):
                raise Fault("a block commands an agent that it does not name")
            for clause in command.moves[0].edge.guard.integers:
                if not any(named.get(test.variable) == test.value for test in clause):
                    raise Fault(f"a block that commands {sender} does not name what that needs")
            self._said.setdefault((sender, str(named[sender])), []).append((number, command))
            for name in (*named, *command.moves[0].edge.variables):
                self._interested.setdefault(name, {})[sender] = None

    # One play ------------------------------------------------------------------------------------------------------

    def follow(self) -> int:
        """Follows one play to its end; what reaches the goal comes after all else. Returns the number of events."""
        waiting: Deque[str] = deque(self._automata)
        queued, last = set(waiting), ""
        while waiting or last:
            name, last = (waiting.popleft(), last) if waiting else (last, "")
            queued.discard(name)
            event = self._possible(name)
            if event is None:
                continue
            changed = self._changed(event)
            if self._is_won(changed):
                if waiting:
                    last = name
                    continue
                self.course.add(event, changed)
                break
            self._add(event, changed)
            for other in (name, *(who for what in changed for who in self._interested.get(what, ()))):
                if other not in queued:
                    queued.add(other)
                    waiting.append(other)
        return len(self.course.events)

    def follow_rounds(self) -> int:
        """Follows one play for as many rounds as show all others. Returns how many events are to be looked at: what
        begins with others, up to the end of the play, is there to meet them."""
        ends = [self._round() for _ in range(3)]
        while not self.course.is_bounded(ends[0], ends[1], ends[-2]):
            if len(ends) - 2 >= _AHEAD:
                raise Fault("a robot may be any number of rounds ahead of another one on whom it waits")
            ends.append(self._round())
        ahead = len(ends) - 2
        # What begins in a round meets what begins up to `ahead` + 1 rounds later or before. So the rounds from
        # `ahead` + 2 on are alike: the first one has been there when what begins in them begins.
        while len(ends) < 2 * ahead + 5:
            ends.append(self._round())
        return ends[ahead + 2]

    def _round(self) -> int:
        """Follows the play until it has come back to where it began: all passages have been left once. Returns the
        number of events so far."""
        begin = {name: self.course.now(name) for name in self.course.values}
        left: Set[str] = set()
        waiting: Deque[str] = deque(self._automata)
        while waiting:
            name = waiting.popleft()
            event = self._possible(name)
            if event is None:
                continue
            passed = {other for other, _ in event.receivers if self.course.now(other) == self._first.get(other)}
            if passed & left:
                continue  # it begins the next round
            left |= passed
            changed = self._changed(event)
            self._add(event, changed)
            waiting.extend(dict.fromkeys((name, *(o for what in changed for o in self._interested.get(what, ())))))
        for name, value in begin.items():
            if self.course.now(name) != value:
                raise Fault(f"{name} is {self.course.now(name)} at the end of a round, which it begins {value}")
        return len(self.course.events)

    def _add(self, event: Event, changed: Mapping[str, Value]) -> None:
        self.course.add(event, changed)
        self._monitor.check(len(self.course.events), 0)
        if len(self.course.events) > _MOST:
            raise Fault("a play has too many events")

    def _is_won(self, changed: Mapping[str, Value]) -> bool:
        """True if the goal is reached when this has changed."""
        return all(changed.get(name, self.course.now(name)) == place for name, place in self._objective.goal)

    def _possible(self, sender: str) -> Optional[Event]:
        """What the sender can do after all events so far; None: nothing."""
        here = sender, str(self.course.now(sender))
        for edge in self._free.get(here, ()):
            if self.course.holds(edge.guard):
                return self._event(sender, edge, {}, None)
        for number, command in self._said.get(here, ()):
            named = self._named[number]
            if all(self.course.now(name) == value for name, value in named.items()):
                edge = command.moves[0].edge
                if edge not in self._automata[sender].edges or edge.source != here[1]:
                    raise Fault(f"{sender} is commanded what it cannot do in {here[1]}")
                if not self.course.holds(edge.guard):
                    raise Fault(f"{sender} is commanded what it may not do in {here[1]}")
                event = self._event(sender, edge, named, number)
                if {(move.automaton, move.edge) for move in command.moves[1:]} != set(event.receivers):
                    raise Fault(f"others receive what {sender} does in {here[1]} than its command says")
                return event
        return None

    def _event(self, sender: str, edge: Edge, named: Dict[str, Value], block: Optional[int]) -> Event:
        course = self.course
        needed = dict.fromkeys((sender, *named))
        for clause in edge.guard.integers:
            needed[next(test.variable for test in clause if course.now(test.variable) == test.value)] = None
        receivers: Dict[str, Edge] = {}
        for name, other in self._part.receivers.get(edge.channel, ()):
            if name != sender and other.source == course.now(name) and course.holds(other.guard):
                if name in receivers:
                    raise Fault(f"{name} may receive what {sender} does in two ways")
                receivers[name] = other
        moves = (edge, *receivers.values())
        ends = {name: course.last(name) for name in (sender, *receivers)}
        ends.update((name, course.last(name)) for move in moves for name, _ in move.assign)
        resets = tuple(dict.fromkeys(clock for move in moves for clock in move.resets))
        needs = {name: course.last(name) for name in needed}
        return Event(sender, edge, tuple(receivers.items()), needs, ends, resets, block)

    @staticmethod
    def _changed(event: Event) -> Dict[str, Value]:
        changed: Dict[str, Value] = {event.sender: event.edge.target}
        changed.update((name, edge.target) for name, edge in event.receivers)
        for edge in (event.edge, *(edge for _, edge in event.receivers)):
            for name, value in edge.assign:
                if changed.setdefault(name, value) != value:
                    raise Fault(f"{name} is set twice at once")
        return changed

    # All plays -----------------------------------------------------------------------------------------------------

    def check(self, checked: int) -> None:
        """Shows that all plays are this one, of what is there at first or begins with one of so many first events.
        Raises Fault."""
        course = self.course
        for number, event in enumerate(course.events[:checked]):
            self._monitor.check(number, 0)
            self._check_event(event)
            for stay in event.needs.items():
                end = course.end(stay)
                if end not in (None, number) and not course.is_before(number, end or 0):
                    raise Fault(f"{_words(stay, course)} may end before {event.sender} has done what needs it")
        for name in self._automata:
            for k, value in enumerate(course.values[name]):
                self._monitor.check(len(course.events), 0)
                if course.begin((name, k)) >= checked:
                    break
                if (name, value) in self._bad:
                    raise Fault(f"{name} comes to {value}")
                self._check_stay((name, k), str(value))
        for sender in {sender for sender, _ in self._said}:
            for k, value in enumerate(course.values[sender]):
                if course.begin((sender, k)) >= checked:
                    break
                if not any(self._is_sure((sender, k), named) for named in self._named if named.get(sender) == value):
                    raise Fault(f"no block says what {sender} does in {value} whatever the others do")
        for name, edge in self._threats:
            for k in course.stays(name, edge.source):
                self._monitor.check(len(course.events), 0)
                if course.begin((name, k)) >= checked:
                    break
                met = next(course.meetings(course.tested(edge.guard), ((name, k),)), None)
                if met is not None:
                    together = " while ".join(_words(stay, course) for stay in met[1:])
                    raise Fault(f"{name} may come to {edge.target}: {together}")
        for name, place in self._objective.goal:
            if course.now(name) != place:
                raise Fault(f"{name} is in {course.now(name)} at the end, not in {place}")

    def _is_sure(self, stay: Stay, named: Mapping[str, Value]) -> bool:
        """True if all states that the block names hold as long as this state lasts."""
        course = self.course
        return all(
            value == wanted or not course.may_meet(stay, (name, k))
            for name, wanted in named.items()
            for k, value in enumerate(course.values[name])
        )

    def _is_open(self, met: Sequence[Stay]) -> bool:
        """True if the goal may be still to be reached while these states hold; without a goal all goes on."""
        course = self.course
        return not self._objective.goal or any(
            value != place and course.may_all_meet((name, k), met)
            for name, place in self._objective.goal
            for k, value in enumerate(course.values[name])
        )

    def _check_event(self, event: Event) -> None:
        """Whenever its needs are met it is this one: all that it changes is as it was, and nobody else receives it."""
        course, needs = self.course, tuple(event.needs.items())
        tested = {
            test.variable
            for _, edge in event.receivers
            for clause in edge.guard.integers
            if not self._surely(clause, needs)
            for test in clause
        }
        for name in {*event.ends, *tested}.difference(event.needs):
            wanted = event.ends.get(name)
            meeting = [k for k in range(len(course.values[name])) if course.may_all_meet((name, k), needs)]
            if len(meeting) != 1 or wanted not in (None, meeting[0]):
                raise Fault(f"{name} may be otherwise when {event.sender} leaves {event.edge.source}")
        for name, edge in self._part.receivers.get(event.edge.channel, ()):
            if name == event.sender or (name, edge) in event.receivers:
                continue
            for k in course.stays(name, edge.source):
                if course.may_all_meet((name, k), needs):
                    known = (*needs, *(() if name in event.needs else ((name, k),)))
                    if next(course.meetings(course.tested(edge.guard), known), None) is not None:
                        raise Fault(f"{name} may receive {event.edge.channel}, or not")

    def _surely(self, clause: Clause, needs: Sequence[Stay]) -> bool:
        """True if a test of a clause holds whenever these states do: all are of one variable, of each of its values."""
        name, values = clause[0].variable, {test.value for test in clause}
        return all(test.variable == name for test in clause) and all(
            value in values or not self.course.may_all_meet((name, k), needs)
            for k, value in enumerate(self.course.values[name])
        )

    def _check_stay(self, stay: Stay, place: str) -> None:
        """Whatever its automaton may do in a state is what it does there."""
        name = stay[0]
        for edge in self._free.get((name, place), ()):
            self._check_move(stay, edge, {})
        for number, command in self._said.get((name, place), ()):
            self._check_move(stay, command.moves[0].edge, self._named[number])

    def _check_move(self, stay: Stay, edge: Edge, named: Dict[str, Value]) -> None:
        course = self.course
        end = course.end(stay)
        event = None if end is None else course.events[end]
        choices = [[(n, k) for k in course.stays(n, value)] for n, value in named.items() if n != stay[0]]
        if any(not course.stays(n, value) for n, value in named.items()):
            return
        for met in course.meetings([*choices, *course.tested(edge.guard)], (stay,)):
            if not self._is_open(met):
                continue
            if event is None or (event.sender, event.edge) != (stay[0], edge) or dict(met) != event.needs:
                raise Fault(f"{stay[0]} may do in {edge.source} what it does not do in the first play")


def _words(stay: Stay, course: Course) -> str:
    return f"{stay[0]} is {course.values[stay[0]][stay[1]]}"
