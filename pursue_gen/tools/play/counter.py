"""The person plays the robots of a game that is lost; the program answers so that it stays lost.

Of each position that an answer leaves behind the solver decides whether it is lost, so the robots never win. Where
something has to be kept up (a safety objective) they are to lose within a horizon, so the answers make headway; where
no near horizon is found, the others do what they can as soon as they can.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import chain
from typing import Iterator, List, Optional, Set, Tuple

from pursue_gen.explanation.policy import (
    COARSE,
    Choice,
    Window,
    Windows,
    is_driven,
    longest,
    moments,
    preferred,
    window,
)
from pursue_gen.explanation.position import Position, PositionSolver
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.game import JointMove, is_bad, is_goal
from pursue_gen.synthesis.limits import EXPLAINING, Limits, Listener
from pursue_gen.thresholds import narrowed
from pursue_gen.tools.play.state import CHANCE, GRAIN, LOST, OTHERS, ROBOTS, PlannedMove, PlayState, Setup
from pursue_gen.tools.play.world import Offer

_FARTHEST = 32
"""Horizons beyond so many time units are not looked for: that can take minutes. Not measured."""

_SCAN = 400
"""So many moments are looked at in turn where the likely ones hold no answer. Not measured."""


@dataclass(frozen=True)
class CounterPlay:
    """One game of this kind. `horizon`: the time by which the robots are to have lost; None: it is not known, or they
    have something to reach and never get there."""

    setup: Setup
    oracle: PositionSolver
    horizon: Optional[int] = None

    def offers(self, play: PlayState) -> Tuple[Offer, ...]:
        """What the robots can do now or later, in the order of the agents."""
        if play.over:
            return ()
        agents, game = self.setup.agents, self.setup.game
        found = [
            Offer(self.setup.owner(move), self.setup.word(move), move, self.setup.own_window(play, move))
            for move, _ in self.setup.open_moves(play, True)
            if self.setup.owner(move) in agents and not is_bad(game, move.target)
        ]
        return tuple(sorted(found, key=lambda offer: agents.index(offer.agent)))

    def planned(self, play: PlayState, plan: PlannedMove) -> PlayState:
        """The play with the next order of the person; there is one at a time."""
        return replace(play, plans=(plan,))

    def advance(self, play: PlayState, until: Optional[Fraction] = None) -> PlayState:
        """The play after what happens next; or at the time `until`, if that comes first.

        Where nothing would ever happen (and no time is named), the play itself.
        """
        order, room = self._order(play), longest(self.setup.game, play.position)
        rest = None if until is None else until - play.now
        # An order for later than `room` has to wait: another agent has to move before.
        if order is not None and all(bound is None or order[1] <= bound for bound in (rest, room)):
            return self._ordered(play, *order)
        answer = self._waited(play, rest)
        if answer is not None:
            return self._made(play, answer)
        last = self.setup.last_moment(play)
        if last is not None and (until is None or until > last):
            return self.setup.ended(play.passed(last))
        return play if until is None else play.passed(until)

    # What the robots want ---------------------------------------------------------------------------------------------

    def _order(self, play: PlayState) -> Optional[Choice]:
        """The robots' next move: what the person has ordered; before that, that the goal counts as soon as it can."""
        found: List[Choice] = []
        for move, open_ in self.setup.open_moves(play, True):
            key = self.setup.owner(move), self.setup.word(move)
            for plan in play.plans:
                delay = plan.at - play.now
                if key == (plan.agent, plan.word) and self.setup.own_window(play, move).holds(delay):
                    found.append((move, delay))
            earliest = open_.earliest(GRAIN)
            if key[0] not in self.setup.agents and not is_bad(self.setup.game, move.target) and earliest is not None:
                found.append((move, earliest))
        return min(found, key=lambda pair: pair[1], default=None)

    def _ordered(self, play: PlayState, move: JointMove, delay: Fraction) -> PlayState:
        """The robots decide for a move after that delay: the others are faster, or it takes effect, at once or late."""
        room, reaction = longest(self.setup.game, play.position), self.setup.rules.reaction
        open_ = window(self.setup.game, play.position, move)
        for late in _lateness(reaction):
            if open_.holds(delay + late) and self._leaves_lost(play, move, delay + late):
                return self.setup.taken(play, move, play.now + delay + late, ROBOTS)
        limit = delay + reaction if room is None else min(delay + reaction, room)
        answer = self._faster(play, limit)
        if answer is not None:
            return self._made(play, answer)
        for late in _lateness(reaction):  # too late to be obeyed
            if not open_.holds(delay + late) and delay + late <= limit and self._stays_lost(play, delay + late):
                return replace(play.passed(play.now + delay + late), plans=())
        return self.setup.taken(play, move, play.now + delay, ROBOTS)

    # What the others do -----------------------------------------------------------------------------------------------

    def _waited(self, play: PlayState, delay: Optional[Fraction]) -> Optional[Choice]:
        """What the others do while the robots wait for so long (None: for ever); None: nothing."""
        here = play.position
        room = longest(self.setup.game, here)
        theirs = self._theirs(play)
        driven = [(move, open_) for move, open_ in theirs if is_driven(self.setup.game, here, move)]
        if self.setup.safety and self.horizon is None:
            driven = theirs
        ours = {agent.name for agent in self.setup.scenario.agents if agent.controllable}
        robots = {k for k, automaton in enumerate(self.setup.game.automata) if automaton.name in ours}
        for move, moment in preferred(driven, robots, GRAIN):
            if delay is not None and moment > delay and self._stays_lost(play, delay):
                return None
            if self._in_vain(play, move, moment):
                continue
            if (delay is None or moment <= delay) and self._leaves_lost(play, move, moment):
                return move, moment
        if room is not None and (delay is None or room <= delay):
            at_end = play.passed(play.now + room)
            if self.setup.overdue(at_end) and self.setup.ended(at_end).status == LOST:
                return None
        limit = delay
        if limit is None:
            limit = self._patience(play) if room is None else room
        elif room is not None:
            limit = min(limit, room)
        if limit is None or (delay is not None and self._stays_lost(play, limit)):
            return None
        return self._faster(play, limit)

    def _patience(self, play: PlayState) -> Optional[Fraction]:
        """For how long the others may do nothing: for ever where the robots have to reach something."""
        return None if self.horizon is None else max(Fraction(0), self.horizon - play.now)

    def _faster(self, play: PlayState, limit: Fraction) -> Optional[Choice]:
        """A move of the others within that delay that leaves the game lost."""
        theirs = self._theirs(play)
        likely = {Fraction(0), limit, *moments(theirs, COARSE), *moments(theirs, GRAIN)}
        step = max(limit / _SCAN, GRAIN)
        scanned = (min(step * k, limit) for k in range(_SCAN + 1))
        all_ = chain(sorted(moment for moment in likely if moment <= limit), self._boundary(play, limit), scanned)
        return next(filter(None, (self._at(play, theirs, moment) for moment in all_)), None)

    def _boundary(self, play: PlayState, limit: Fraction) -> Iterator[Fraction]:
        """The moments around the first at which it would not be lost any more if no agent did anything."""
        ends = narrowed(0, int(limit / GRAIN), lambda k: not self._stays_lost(play, k * GRAIN))
        yield from (k * GRAIN for k in ends if k * GRAIN <= limit)

    def _at(self, play: PlayState, theirs: Windows, delay: Fraction) -> Optional[Choice]:
        """A move at that moment; what ends the game first, and nothing that leads nowhere."""
        game = self.setup.game
        for move, open_ in sorted(theirs, key=lambda pair: not is_bad(game, pair[0].target)):
            if open_.holds(delay) and not self._in_vain(play, move, delay) and self._leaves_lost(play, move, delay):
                return move, delay
        return None

    def _made(self, play: PlayState, answer: Choice) -> PlayState:
        move, delay = answer
        by = CHANCE if self.setup.is_end(move) else OTHERS
        return self.setup.taken(play, move, play.now + delay, by)

    def _theirs(self, play: PlayState) -> List[Tuple[JointMove, Window]]:
        moves = self.setup.open_moves(play, False)
        return [pair for pair in moves if not pair[0].changes_nothing]

    # What the solver finds --------------------------------------------------------------------------------------------

    def _leaves_lost(self, play: PlayState, move: JointMove, delay: Fraction) -> bool:
        there = play.position.after(move, delay)
        if is_goal(self.setup.game, there.state):
            return False
        return is_bad(self.setup.game, there.state) or self._lost(there, play.now + delay)

    def _stays_lost(self, play: PlayState, delay: Fraction) -> bool:
        room = longest(self.setup.game, play.position)
        if room is not None and delay > room:
            return False
        return self._lost(play.position.later(delay), play.now + delay)

    def _lost(self, position: Position, at: Fraction) -> bool:
        # Past the horizon the others could still win ties, and would put off their work for ever.
        return (self.horizon is None or at <= self.horizon) and self.oracle.lost(position, at, self.horizon)

    def _in_vain(self, play: PlayState, move: JointMove, delay: Fraction) -> bool:
        """True if the move only leads to where the game has been at the same time."""
        at, there = play.now + delay, self.oracle.same(play.position.after(move, delay))
        met: Set[Position] = {self.oracle.same(deed.after) for deed in play.deeds if deed.at == at}
        return there in met or (delay == 0 and there == self.oracle.same(play.position))

    def repeats(self, play: PlayState) -> Optional[Fraction]:
        """Since when everything is as it was once before: it can go on so for ever. None: it is not."""
        if self.horizon is not None or not play.deeds:
            return None
        if self.setup.safety:
            return None
        now = self.oracle.same(play.deeds[-1].after)
        met = [deed.at for deed in play.deeds[:-1] if self.oracle.same(deed.after) == now]
        return met[-1] if met else None


def counter_game(setup: Setup, memory: int = 0, progress: Optional[Listener] = None) -> CounterPlay:
    """The game against the counter-strategy, for a setup that is lost for the robots.

    `memory`: MiB for each question to the solver (0: no limit). Raises LimitHit.
    """
    budget = Budget(Limits(memory=memory), progress, phase=EXPLAINING)
    oracle = PositionSolver(setup.network, setup.objective, setup.rules.reaction, budget)
    return CounterPlay(setup, oracle, oracle.horizon(setup.beginning().entry, _FARTHEST) if setup.safety else None)


def _lateness(reaction: Fraction) -> Tuple[Fraction, ...]:
    """How late a command may take effect: at once and as late as can be first, then in between."""
    between = (reaction * k / 20 for k in range(1, 20))
    return tuple(dict.fromkeys((Fraction(0), reaction, *between)))
