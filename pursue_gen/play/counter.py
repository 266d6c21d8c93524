"""The person plays the robots of a game that is lost; the program answers so that it stays lost.

Of each position that an answer leaves behind the solver is asked whether it is lost, so the robots never win. Where
something has to be kept up (a safety objective) they are to lose within a horizon, so the answers make headway; where
no near horizon is found, the others do what they can as soon as they can.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Iterator, List, Optional, Sequence, Set, Tuple

from pursue_gen.explanation.allowance import Clock
from pursue_gen.explanation.policy import COARSE, Window, longest, moments, window
from pursue_gen.explanation.position import Oracle, Position
from pursue_gen.play.table import (
    CHANCE,
    GRAIN,
    LOST,
    OTHERS,
    ROBOTS,
    Board,
    Plan,
    Table,
    after,
    beginning,
    ended,
    last_moment,
    later,
    open_moves,
    overdue,
    own_window,
    passed,
    taken,
)
from pursue_gen.play.world import Offer
from pursue_gen.synthesis.game import JointMove, is_bad, is_goal
from pursue_gen.synthesis.limits import Limits, Listener

_LONG = 1e6
"""Seconds that a whole game may be thought about."""

_FARTHEST = 32
"""Horizons beyond so many time units are not looked for: that can take minutes."""

_SCAN = 400
"""So many moments are looked at in turn where the likely ones hold no answer."""

Answer = Tuple[JointMove, Fraction]
"""A move and after what delay it is made."""

_Pairs = Sequence[Tuple[JointMove, Window]]


@dataclass(frozen=True)
class Robots:
    """One game of this kind. `horizon`: the time by which the robots are to have lost; None: it is not known, or they
    have something to reach and never get there."""

    board: Board
    oracle: Oracle
    horizon: Optional[int] = None

    def offers(self, table: Table) -> Tuple[Offer, ...]:
        """What the robots can do now or later, in the order of the agents."""
        if table.over:
            return ()
        agents, game = self.board.agents, self.board.game
        found = [
            Offer(self.board.owner(move), self.board.word(move), move, own_window(self.board, table, move))
            for move, _ in open_moves(self.board, table, True)
            if self.board.owner(move) in agents and not is_bad(game, move.target)
        ]
        return tuple(sorted(found, key=lambda offer: agents.index(offer.agent)))

    def planned(self, table: Table, plan: Plan) -> Table:
        """The table with the next order of the person; there is one at a time."""
        return replace(table, plans=(plan,))

    def advance(self, table: Table, until: Optional[Fraction] = None) -> Table:
        """The table after what happens next; or at the time `until`, if that comes first.

        Where nothing would ever happen (and no time is named), the table itself.
        """
        order, room = self._order(table), longest(self.board.game, table.here)
        rest = None if until is None else until - table.now
        # An order for later than `room` has to wait: somebody has to move before.
        if order is not None and all(bound is None or order[1] <= bound for bound in (rest, room)):
            return self._ordered(table, *order)
        answer = self._waited(table, rest)
        if answer is not None:
            return self._made(table, answer)
        last = last_moment(self.board, table)
        if last is not None and (until is None or until > last):
            return ended(self.board, passed(table, last))
        return table if until is None else passed(table, until)

    # What the robots want ---------------------------------------------------------------------------------------------

    def _order(self, table: Table) -> Optional[Answer]:
        """The robots' next move: what the person has ordered; before that, that the goal counts as soon as it can."""
        found: List[Answer] = []
        for move, open_ in open_moves(self.board, table, True):
            key = self.board.owner(move), self.board.word(move)
            for plan in table.plans:
                delay = plan.at - table.now
                if key == (plan.agent, plan.word) and own_window(self.board, table, move).holds(delay):
                    found.append((move, delay))
            earliest = open_.earliest(GRAIN)
            if key[0] not in self.board.agents and not is_bad(self.board.game, move.target) and earliest is not None:
                found.append((move, earliest))
        return min(found, key=lambda pair: pair[1], default=None)

    def _ordered(self, table: Table, move: JointMove, delay: Fraction) -> Table:
        """The robots decide for a move after that delay: the others are faster, or it takes effect, at once or late."""
        room, reaction = longest(self.board.game, table.here), self.board.rules.reaction
        open_ = window(self.board.game, table.here, move)
        for late in _lateness(reaction):
            if open_.holds(delay + late) and self._leaves_lost(table, move, delay + late):
                return taken(self.board, table, move, table.now + delay + late, ROBOTS)
        limit = delay + reaction if room is None else min(delay + reaction, room)
        answer = self._faster(table, limit)
        if answer is not None:
            return self._made(table, answer)
        for late in _lateness(reaction):  # too late to be obeyed
            if not open_.holds(delay + late) and delay + late <= limit and self._stays_lost(table, delay + late):
                return replace(passed(table, table.now + delay + late), plans=())
        return taken(self.board, table, move, table.now + delay, ROBOTS)

    # What the others do -----------------------------------------------------------------------------------------------

    def _waited(self, table: Table, delay: Optional[Fraction]) -> Optional[Answer]:
        """What the others do while the robots wait for so long (None: for ever); None: nothing."""
        here = table.here
        room = longest(self.board.game, here)
        theirs = self._theirs(table)
        driven = [(move, open_) for move, open_ in theirs if self._is_driven(here, move)]
        if self.board.safety and self.horizon is None:
            driven = theirs
        for move, moment in sorted(self._preferred(driven), key=lambda pair: pair[1]):
            if delay is not None and moment > delay and self._stays_lost(table, delay):
                return None
            if self._in_vain(table, move, moment):
                continue
            if (delay is None or moment <= delay) and self._leaves_lost(table, move, moment):
                return move, moment
        if room is not None and (delay is None or room <= delay):
            at_end = passed(table, table.now + room)
            if overdue(self.board, at_end) and ended(self.board, at_end).status == LOST:
                return None
        limit = delay
        if limit is None:
            limit = self._patience(table) if room is None else room
        elif room is not None:
            limit = min(limit, room)
        if limit is None or (delay is not None and self._stays_lost(table, limit)):
            return None
        return self._faster(table, limit)

    def _patience(self, table: Table) -> Optional[Fraction]:
        """For how long the others may do nothing: for ever where the robots have to reach something."""
        return None if self.horizon is None else max(Fraction(0), self.horizon - table.now)

    def _faster(self, table: Table, limit: Fraction) -> Optional[Answer]:
        """A move of the others within that delay that leaves the game lost."""
        theirs = self._theirs(table)
        likely = {Fraction(0), limit, *moments(theirs, COARSE), *moments(theirs, GRAIN)}
        for moment in sorted(moment for moment in likely if moment <= limit):
            found = self._at(table, theirs, moment)
            if found is not None:
                return found
        step = max(limit / _SCAN, GRAIN)
        boundary = self._boundary(table, limit)
        scanned = (min(step * k, limit) for k in range(_SCAN + 1))
        for moment in [*boundary, *scanned]:
            found = self._at(table, theirs, moment)
            if found is not None:
                return found
        return None

    def _boundary(self, table: Table, limit: Fraction) -> Iterator[Fraction]:
        """The moments around the first at which it would not be lost any more if nobody did anything."""
        low, high = 0, int(limit / GRAIN)
        while high - low > 1:
            middle = (low + high) // 2
            if self._stays_lost(table, middle * GRAIN):
                low = middle
            else:
                high = middle
        yield from (k * GRAIN for k in (low, high) if k * GRAIN <= limit)

    def _at(self, table: Table, theirs: _Pairs, delay: Fraction) -> Optional[Answer]:
        """A move at that moment; what ends the game first, and nothing that leads nowhere."""
        game = self.board.game
        for move, open_ in sorted(theirs, key=lambda pair: not is_bad(game, pair[0].target)):
            if open_.holds(delay) and not self._in_vain(table, move, delay) and self._leaves_lost(table, move, delay):
                return move, delay
        return None

    def _made(self, table: Table, answer: Answer) -> Table:
        move, delay = answer
        by = CHANCE if self.board.is_end(move) else OTHERS
        return taken(self.board, table, move, table.now + delay, by)

    def _theirs(self, table: Table) -> List[Tuple[JointMove, Window]]:
        return list(open_moves(self.board, table, False))

    def _preferred(self, driven: _Pairs) -> Iterator[Answer]:
        """Robots end as late as they may, others as soon as they can."""
        ours = {agent.name for agent in self.board.scenario.agents if agent.controllable}
        for move, open_ in driven:
            late = open_.latest() if self.board.owner(move) in ours else None
            delay = open_.earliest(GRAIN) if late is None else late
            if delay is not None:
                yield move, delay

    def _is_driven(self, here: Position, move: JointMove) -> bool:
        bounds = self.board.game.automata[move.owner].invariants[here.state.locations[move.owner]]
        return bool(bounds) and self.board.is_end(move)

    # What the solver says ---------------------------------------------------------------------------------------------

    def _leaves_lost(self, table: Table, move: JointMove, delay: Fraction) -> bool:
        there = after(table.here, move, delay)
        if is_goal(self.board.game, there.state):
            return False
        return is_bad(self.board.game, there.state) or self._lost(there, table.now + delay)

    def _stays_lost(self, table: Table, delay: Fraction) -> bool:
        room = longest(self.board.game, table.here)
        if room is not None and delay > room:
            return False
        return self._lost(later(table.here, delay), table.now + delay)

    def _lost(self, position: Position, at: Fraction) -> bool:
        # Past the horizon the others could still win ties, and would put off their work for ever.
        return (self.horizon is None or at <= self.horizon) and self.oracle.lost(position, at, self.horizon)

    def _in_vain(self, table: Table, move: JointMove, delay: Fraction) -> bool:
        """True if the move only leads to where the game has been at the same time."""
        at, there = table.now + delay, self.oracle.same(after(table.here, move, delay))
        met: Set[Position] = {self.oracle.same(deed.after) for deed in table.deeds if deed.at == at}
        return there in met or (delay == 0 and there == self.oracle.same(table.here))

    def repeats(self, table: Table) -> Optional[Fraction]:
        """Since when everything is as it was once before: it can go on so for ever. None: it is not."""
        if self.horizon is not None or not table.deeds:
            return None
        if self.board.safety:
            return None
        now = self.oracle.same(table.deeds[-1].after)
        met = [deed.at for deed in table.deeds[:-1] if self.oracle.same(deed.after) == now]
        return met[-1] if met else None


def robots_game(board: Board, memory: int = 0, progress: Optional[Listener] = None) -> Robots:
    """The game against the counter-strategy, for a board that is lost for the robots.

    `memory`: MiB for each question to the solver (0: no limit). Raises PursueError with exit status 5 at a limit.
    """
    clock = Clock(Limits(_LONG, memory), progress)
    oracle = Oracle(board.network, board.objective, board.rules.reaction, clock)
    return Robots(board, oracle, _horizon(oracle, beginning(board).entry) if board.safety else None)


def _horizon(oracle: Oracle, start: Position) -> Optional[int]:
    """About the least time in which the robots can be made to lose; None: it is long."""
    safe, lost = 0, 8
    while not oracle.lost(start, Fraction(0), lost):
        safe, lost = lost, 2 * lost
        if lost > _FARTHEST:
            return None
    while lost - safe > max(1, lost // 12):
        middle = (safe + lost) // 2
        if oracle.lost(start, Fraction(0), middle):
            lost = middle
        else:
            safe = middle
    return lost + 1


def _lateness(reaction: Fraction) -> Tuple[Fraction, ...]:
    """How late a command may take effect: at once and as late as can be first, then in between."""
    between = (reaction * k / 20 for k in range(1, 20))
    return tuple(dict.fromkeys((Fraction(0), reaction, *between)))
