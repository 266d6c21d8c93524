"""A counter-play: one play in which the environment keeps the controller from its objective, whatever it tries.

The controller plays as `policy` has it; the environment answers with a move, a moment, or a lateness that
leaves a lost position behind. The solver decides that each position is lost, so from any of them the environment
can go on, whatever the controller does.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Dict, FrozenSet, Iterator, List, Optional, Sequence, Set, Tuple

from pursue_gen.explanation.endless import may_repeat
from pursue_gen.explanation.policy import (
    COARSE,
    Choice,
    Controller,
    Windows,
    is_driven,
    longest,
    moments,
    preferred,
    window,
)
from pursue_gen.explanation.position import Position, PositionSolver, won_from
from pursue_gen.language.symbols import Role
from pursue_gen.outcomes import LimitHit
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.synthesis.game import Game, JointMove, State, initial_state, is_bad, is_goal, joint_moves
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga.network import Edge, Network, Objective
from pursue_gen.tga.pauses import pauses

_MOST_STEPS, _MOST_BEGINNINGS = 60, 8
"""So many steps of a play are followed, and so many beginnings of the robots at most. Not measured."""

_IN_VAIN = 2
"""After so many beginnings in turn that are not decided no other is looked at: there is about as much work for each.
Measured on errands beside a visitor."""

_FOR_MAIN, _FOR_FEW = 0.7, 0.1
"""The parts of the budget for the play in which the controller begins as it likes, and for whether few events of the
environment are enough for one. Not measured."""

_FINE = Fraction(1, 1000)

@dataclass(frozen=True)
class CounterStep:
    """A joint move, `at` in time units since the start; `edges` are indices into the game's, the owner's first."""

    at: Fraction
    owner: int
    edges: Tuple[int, ...]


@dataclass(frozen=True)
class Play:
    """Steps from the start, and how they end at the time `at`.

    Every position on the way is lost. `end` is "bad" (what is to be avoided has happened with the last step),
    "overdue" (time cannot go on: the automata `overdue` have to move and cannot), "idle" (nobody has to do anything any
    more), "again" (all are as they were at the time `since`), "endless" (an agent that may act without end does so, and
    no time passes) or "open" (cut off). `position` is the last one.

    `first`: with what the controller was to begin, the edges of a joint move; () for waiting, None for what it likes.
    """

    game: Game
    steps: Tuple[CounterStep, ...]
    end: str
    at: Fraction
    position: Position
    overdue: Tuple[int, ...] = ()
    since: Fraction = Fraction(0)
    first: Optional[Tuple[int, ...]] = None


def counter_plays(
    network: Network,
    objective: Objective,
    reaction: Fraction,
    budget: Budget,
    helpful: Sequence[Strategy] = (),
    needs_no_time: bool = False,
) -> Iterator[Play]:
    """A play that shows why a lost game is lost, then one for each other way in which the controller could begin.

    The network is that of the game as it is played. `helpful` are strategies for games that differ in numbers only, for
    the controller to go by; `needs_no_time`: the game is lost by actions without end alone (see `endless`). Raises
    LimitHit if no play is found within the budget; it ends the rest.
    """
    few = _lost_to_few(network, objective, reaction, budget)
    spared = _spared(network, objective, reaction, budget, few)
    oracle = PositionSolver(spared, objective, reaction, budget, few)
    player = _CounterPlayer(network, oracle, objective, reaction, helpful, needs_no_time)
    main = player.play(budget.split(_FOR_MAIN))
    yield main
    beginnings, in_vain = list(_beginnings(main)), 0
    for k, first in enumerate(beginnings):
        play = player.play(budget.split(1 / (len(beginnings) - k)), first)
        in_vain = 0 if play.steps or play.end != "open" else in_vain + 1
        if not in_vain:
            yield play
        elif in_vain == _IN_VAIN:
            return


def _beginnings(main: Play) -> Iterator[Tuple[int, ...]]:
    """The joint moves with which the controller could begin and does not in this play, and waiting if it does not."""
    game = main.game
    start = initial_state(game)
    watching = {automaton for automaton, _ in (*game.goal, *game.bad)}
    agents = {k for k in range(len(game.automata)) if k not in watching}
    done = [step for step in main.steps if game.edges[step.edges[0]].controllable and step.owner in agents]
    known = {done[0].edges[0]} if done else set()
    found: List[Tuple[int, ...]] = [()] if done else []
    for move in joint_moves(game, start):
        useful = move.controllable and move.owner in agents and not move.changes_nothing
        if useful and move.edges[0] not in known and not is_bad(game, move.target):
            known.add(move.edges[0])
            found.append(move.edges)
    yield from found[:_MOST_BEGINNINGS]


def _lost_to_few(network: Network, objective: Objective, reaction: Fraction, budget: Budget) -> bool:
    """True if the environment is known to win where each agent that rests between events does no more than one."""
    try:
        return bool(pauses(network)) and not won_from(budget, network, objective, reaction, True, _FOR_FEW)
    except LimitHit:
        return False


def _spared(network: Network, objective: Objective, reaction: Fraction, budget: Budget, few: bool) -> Network:
    """The network without what the environment can do without, so that the play has less of what does not matter.

    It only loses moves that it need not make (no invariant drives them), so what is lost there is lost in the whole.
    """
    for automaton in network.automata:
        bounded = {place.name for place in automaton.locations if place.invariant}
        sent = [e for e in automaton.edges if e.sync is not None and e.sync.sends]
        free = [e for e in sent if not e.controllable and e.source not in bounded]
        starts = [e for e in free if e.enters is Role.WAY]
        groups = [starts] + [[e for e in free if e.sync == s] for s in {e.sync: 0 for e in free if e not in starts}]
        for group in groups:
            fewer = _without(network, automaton.name, group)
            if group and not won_from(budget, fewer, objective, reaction, few):
                network = fewer
    return network


def _without(network: Network, name: str, edges: Sequence[Edge]) -> Network:
    return network.with_each(lambda a: a.with_edges(e for e in a.edges if e not in edges) if a.name == name else a)


class _CounterPlayer:
    def __init__(
        self,
        whole: Network,
        oracle: PositionSolver,
        objective: Objective,
        reaction: Fraction,
        helpful: Sequence[Strategy],
        needs_no_time: bool,
    ) -> None:
        self._game = game = compile_game(whole, objective)
        self._reaction, self._helpful = reaction, helpful
        self._oracle = oracle
        self._kept = _kept(whole, oracle.network)
        self._robots = {edge.automaton for edge in game.edges if edge.controllable}
        self._repeated = {k for k, edge in enumerate(game.origins) if may_repeat(edge)} if needs_no_time else set()
        self._horizon: Optional[int] = None

    def play(self, budget: Budget, first: Optional[Tuple[int, ...]] = None) -> Play:
        """The play from the start, cut off where the budget is used up. `first`: see `Play`."""
        self._oracle.budget = budget
        here = Position(initial_state(self._game), (Fraction(0),) * len(self._game.clocks))
        if not self._game.goal and self._horizon is None:
            self._horizon = self._oracle.horizon(here)
        self._controller = Controller(self._game, self._helpful)
        self._first, self._now = first, Fraction(0)
        self._met: Dict[Position, Fraction] = {}
        self._been: Set[State] = set()
        return replace(self._played(here), first=first)

    def _played(self, here: Position) -> Play:
        steps: List[CounterStep] = []
        self._circle: Set[State] = set()
        while len(steps) < _MOST_STEPS:
            if self._is_broken(here):
                return self._end("bad", steps, here)
            same = self._oracle.same(here)
            if self._horizon is None and same in self._met:
                return replace(self._end("again", steps, here), since=self._met[same])
            self._met[same] = self._now
            self._been.add(here.state)
            try:
                choice = self._next(here)
            except LimitHit:  # nothing is left of the limits: what has been played holds
                break
            if choice is None:
                return self._finish(steps, here)
            move, delay = choice
            self._now += delay
            steps.append(CounterStep(self._now, move.owner, move.edges))
            if self._first and move.edges[0] == self._first[0]:
                self._first = None
            before, here = here.state, here.after(move, delay)
            if self._goes_in_circles(steps, before, here.state):
                return self._end("endless", steps, here)
        return self._end("open", steps, here)

    def _goes_in_circles(self, steps: Sequence[CounterStep], before: State, after: State) -> bool:
        """True if the last steps, taken without end, led back to where an agent began with them."""
        if steps[-1].edges[0] not in self._repeated:
            self._circle = set()
            return False
        self._circle.add(before)
        return after in self._circle

    def _finish(self, steps: Sequence[CounterStep], here: Position) -> Play:
        if any(move.edges[0] in self._repeated for move in joint_moves(self._game, here.state)):
            return self._end("endless", steps, here)
        room = longest(self._game, here)
        if room is None:
            return self._end("idle" if self._horizon is None else "open", steps, here)
        overdue = self._overdue(here, room)
        if not overdue:
            return self._end("open", steps, here)
        self._now += room
        there = Position(here.state, tuple(value + room for value in here.clocks))
        return replace(self._end("overdue", steps, there), overdue=overdue)

    def _end(self, end: str, steps: Sequence[CounterStep], here: Position) -> Play:
        return Play(self._game, tuple(steps), end, self._now, here)

    # One step ---------------------------------------------------------------------------------------------------------

    def _next(self, here: Position) -> Optional[Choice]:
        """What happens next; None: time just passes, for ever or until something is overdue."""
        moves = [move for move in joint_moves(self._game, here.state) if not move.changes_nothing]
        mine = [move for move in moves if move.controllable]
        theirs = [
            (move, window(self._game, here, move))
            for move in moves
            if not move.controllable and all(k in self._kept for k in move.edges)
        ]
        decision = self._decision(here, mine) or self._last_resort(here, mine)
        if decision is not None:
            answer = self._answer(here, theirs, *decision)
            if answer is not None:
                return answer
        return self._unhurried(here, theirs)

    def _decision(self, here: Position, mine: Sequence[JointMove]) -> Optional[Choice]:
        """What the controller begins with, as soon as it can; then what it likes."""
        if self._first == ():
            return None
        for move in mine:
            delay = window(self._game, here, move).earliest()
            if self._first and move.edges[0] == self._first[0] and delay is not None:
                return move, delay
        return self._controller.decide(here, mine)

    def _last_resort(self, here: Position, mine: Sequence[JointMove]) -> Optional[Choice]:
        """A move at the last moment of an automaton that is overdue then."""
        room = longest(self._game, here)
        if room is None:
            return None
        late = [(move, room) for move in mine if move.owner in self._overdue(here, room)]
        late = [pair for pair in late if window(self._game, here, pair[0]).holds(room)]
        late = [pair for pair in late if not is_bad(self._game, pair[0].target) and not self._in_vain(here, *pair)]
        return late[0] if late else None

    def _answer(self, here: Position, theirs: Windows, move: JointMove, delay: Fraction) -> Optional[Choice]:
        """The controller has decided for a move: it takes effect, at once or late, or the environment is faster."""
        open_ = window(self._game, here, move)
        for late in (Fraction(0), self._reaction):
            if open_.holds(delay + late) and self._leaves_lost(here, move, delay + late):
                return move, delay + late
        limit = delay + self._reaction
        return self._at_some(here, theirs, delay, limit, until=limit)

    def _unhurried(self, here: Position, theirs: Windows) -> Optional[Choice]:
        """The controller waits: the environment does what it must, else nothing if that is enough, else something."""
        room = longest(self._game, here)
        driven = [pair for pair in theirs if is_driven(self._game, here, pair[0])]
        for move, delay in preferred(driven, self._robots):
            if self._leaves_lost(here, move, delay):
                return move, delay
        if self._horizon is None if room is None else bool(self._overdue(here, room)):
            return None
        return self._at_some(here, theirs)

    def _at_some(
        self, here: Position, theirs: Windows, *more: Fraction, until: Optional[Fraction] = None
    ) -> Optional[Choice]:
        """The first move now, at one of these moments, or at a beginning or an end of theirs, up to `until`."""
        some = (moment for grain in (COARSE, _FINE) for moment in sorted({Fraction(0), *more, *moments(theirs, grain)}))
        found = (self._at(here, theirs, moment) for moment in some if until is None or moment <= until)
        return next(filter(None, found), None)

    def _at(self, here: Position, theirs: Windows, delay: Fraction) -> Optional[Choice]:
        # What is new first, and nothing that takes no time and leads nowhere.
        for move, open_ in sorted(theirs, key=lambda pair: pair[0].target in self._been):
            if open_.holds(delay) and not self._in_vain(here, move, delay) and self._leaves_lost(here, move, delay):
                return move, delay
        return None

    def _in_vain(self, here: Position, move: JointMove, delay: Fraction) -> bool:
        """True if the move only leads to where the play has been at the same time."""
        return self._met.get(self._oracle.same(here.after(move, delay))) == self._now + delay

    def _leaves_lost(self, here: Position, move: JointMove, delay: Fraction) -> bool:
        after, at = here.after(move, delay), self._now + delay
        if self._is_broken(after):
            return True
        return self._oracle.lost(after, at, self._horizon)

    def _is_broken(self, here: Position) -> bool:
        return is_bad(self._game, here.state) and not is_goal(self._game, here.state)

    def _overdue(self, here: Position, room: Fraction) -> Tuple[int, ...]:
        """The automata at their bounds after that time that the environment cannot move: the controller is obliged.

        (Where something is to be reached, only if the environment cannot move any other one at its bound either.)
        """
        at_bound = tuple(
            k
            for k, automaton in enumerate(self._game.automata)
            for i, bound in automaton.invariants[here.state.locations[k]]
            if self._game.time(bound) == here.clocks[i - 1] + room
        )
        moves = (move for move in joint_moves(self._game, here.state) if not move.controllable)
        moves = (move for move in moves if not move.changes_nothing)
        able = {move.owner for move in moves if window(self._game, here, move).holds(room)}
        if self._horizon is None and able & set(at_bound):
            return ()
        return tuple(k for k in at_bound if k not in able)


def _kept(whole: Network, spared: Network) -> FrozenSet[int]:
    """The game's indices of the edges that are in both."""
    pairs = [(automaton, edge) for automaton in whole.automata for edge in automaton.edges]
    return frozenset(k for k, (a, edge) in enumerate(pairs) if edge in spared.automaton(a.name).edges)
