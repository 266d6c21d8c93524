"""The reference engine: the rules of the game as fixpoints over one federation per discrete state.

With X the positions won so far, `cPre` and `uPre` the discrete predecessors by the controller's and by uncontrollable
moves, and Predt the timed predecessor (a tie is lost):

- reach: the least X with X = Goal + Predt(X + cPre(X) + F, uPre(not X)), F where an automaton at its bound must move
  and the environment can move it, into X whatever it does;
- safety: the complement of the least L with L = Bad + (past(E) - Predt(cPre(not L), E)), E = L + uPre(L) + Stuck, Stuck
  where an automaton is at its bound, the environment cannot move it and the controller has no safe move.

A command may take effect late by up to the reaction delay, so cPre holds the positions from which the move is right at
every time of the delay and no uncontrollable move out of X comes first.
"""

from __future__ import annotations

import heapq
import itertools
from abc import ABC, abstractmethod
from collections import deque
from dataclasses import dataclass
from typing import ClassVar, Deque, Dict, Iterable, List, Optional, Sequence, Set, Tuple

from pursue_gen.synthesis.engine import Engine, Outcome, Stats
from pursue_gen.synthesis.game import Action, Game, RawBlock, State, initial_state, is_bad, is_goal, joint_moves
from pursue_gen.synthesis.limits import NO_LIMITS, Limits, Listener
from pursue_gen.synthesis.relaxed import RelaxedPlanner
from pursue_gen.zones.dbm import Dbm
from pursue_gen.zones.federation import Federation, predt
from tests.oracle.zone_graph import Monitor, Node, Transition, ZoneGraph
from tests.oracle.zones import includes_zone, lasting, past

Piece = Tuple[Dbm, Action]


@dataclass(frozen=True)
class ReferenceEngine(Engine):
    """The engine in Python, the readable twin of the native one.

    `directed` (reach only): at first one of the controller's moves in each discrete state, the first of a relaxed plan,
    or none; where that does not win, all of them. Without it all moves at once. The verdict is the same.
    """

    name: ClassVar[str] = "python"
    directed: bool = True

    def solve(
        self,
        game: Game,
        limits: Limits = NO_LIMITS,
        progress: Optional[Listener] = None,
        soonest: bool = False,
    ) -> Outcome:
        """Decide the game, see `Engine`. It keeps no ranks."""
        start = limits.now()
        monitor = Monitor(limits, progress)
        try:
            with monitor:
                fixpoint: _Fixpoint
                if not game.goal:
                    fixpoint = _Safety(game, monitor)
                else:
                    fixpoint = _Soonest(game, monitor) if soonest else _Reach(game, monitor, self.directed)
                won = fixpoint.solve()
                blocks = fixpoint.blocks() if won else ()
                blocks = tuple(blocks[k] for k in followed(game, blocks))
        except MemoryError:
            raise monitor.stopped("memory") from None
        zones = sum(len(federation.zones) for federation in fixpoint.found)
        stats = Stats(self.name, len(fixpoint.graph.nodes), zones, limits.now() - start, work=monitor.work)
        return Outcome(won, blocks, None, stats)


class _Fixpoint(ABC):
    """A federation per node that only grows, and a FIFO of the nodes to evaluate again."""

    def __init__(self, graph: ZoneGraph) -> None:
        self.graph = graph
        self.found: List[Federation] = []
        self.rest: List[Federation] = []
        self._queue: Deque[int] = deque()
        self._queued: Set[int] = set()

    @abstractmethod
    def solve(self) -> bool:
        """Whether the controller wins."""

    @abstractmethod
    def blocks(self) -> Tuple[RawBlock, ...]:
        """What the controller does, after a win."""

    def push(self, numbers: Iterable[int]) -> None:
        """Look at these nodes (again)."""
        for number in numbers:
            if number not in self._queued and self.rest[number]:
                self._queued.add(number)
                self._queue.append(number)

    def pop(self) -> Optional[int]:
        """The next node; None: a fixpoint."""
        if not self._queue:
            return None
        number = self._queue.popleft()
        self._queued.discard(number)
        self.check(1 + self._pairs(number))
        return number

    def check(self, work: int = 1) -> None:
        """Raises PursueError at a limit; `work` counts for what comes next."""
        self.graph.monitor.check(len(self.graph.nodes), len(self._queue), work)

    def _pairs(self, number: int) -> int:
        """Pairs of zones that an evaluation of the node combines."""
        node = self.graph.nodes[number]
        targets = {move.target for move in node.controllable + node.uncontrollable if move.target >= 0}
        led_to = sum(len(self.found[k].zones) + len(self.rest[k].zones) for k in targets)
        return len(self.rest[number].zones) * led_to

    def grow(self, number: int, new: Federation) -> None:
        """Add the new positions (disjoint from what was found), and look again at what leads to the node."""
        self.found[number] = self.found[number].union(new).reduced()
        self.rest[number] = self.rest[number].minus(new).reduced()
        self.again(number)

    def again(self, number: int) -> None:
        """Look again at a node that has grown, and at what leads to it."""
        self.push(self.graph.nodes[number].sources | {number})

    def cpre(self, number: int, targets: List[Federation], upre: Federation) -> List[Tuple[Transition, Federation]]:
        """cPre by move of the controller: from where it leads into the targets, however late within the delay.

        Not where an uncontrollable move may come first (`upre`) while the command is on its way.
        """
        delay, graph = self.graph.game.delta, self.graph
        result: List[Tuple[Transition, Federation]] = []
        for move in graph.nodes[number].controllable:
            if move.target >= 0 and targets[move.target]:
                before = graph.pre(number, move, targets[move.target])
                if delay:
                    before = lasting(before.minus(upre).reduced(), delay, graph.nodes[number].reach)
                if before:
                    result.append((move, before))
        return result

    def upre(self, number: int, targets: List[Federation]) -> Federation:
        """uPre: from where an uncontrollable move leads into the targets."""
        result = Federation()
        for move in self.graph.nodes[number].uncontrollable:
            if move.target >= 0 and targets[move.target]:
                result = result.union(self.graph.pre(number, move, targets[move.target]))
        return result.reduced()


def _union(parts: Iterable[Federation]) -> Federation:
    result = Federation()
    for part in parts:
        result = result.union(part)
    return result


def _assign(region: Federation, cpre: Iterable[Tuple[Transition, Federation]]) -> List[Piece]:
    """Disjoint pieces of the region with the first move whose predecessor holds there; where there is none: wait."""
    pieces: List[Piece] = []
    for move, before in cpre:
        part = region.intersect(before)
        if part:
            pieces += [(zone, move.joint.edges) for zone in part.disjoint()]
            region = region.minus(part)
    return pieces + [(zone, None) for zone in region.disjoint()]


def _block(state: State, pieces: Iterable[Piece]) -> RawBlock:
    return state.locations, state.values, tuple((zone.m, action) for zone, action in pieces)


def _tidied(pieces: List[Piece]) -> Tuple[Piece, ...]:
    """The same advice with fewer zones to wait in.

    Commands stay as they were found: time may take a command's zone into one that was found later, and a controller
    that is slow to act must not drift there and lose what it had gained.
    """
    commands = tuple(piece for piece in pieces if piece[1] is not None)
    waits = Federation(tuple(zone for zone, action in pieces if action is None))
    return commands + tuple((zone, None) for zone in waits.disjoint())


class _Reach(_Fixpoint):
    """`found` is what is won, `rest` what is reached and not won (yet)."""

    def __init__(self, game: Game, monitor: Monitor, directed: bool) -> None:
        super().__init__(ZoneGraph(game, monitor, RelaxedPlanner(game).choose if directed else None))
        self._pieces: Dict[int, List[Piece]] = {}
        self._forced: Dict[int, Tuple[Dbm, Federation]] = {}

    def solve(self) -> bool:
        """The fixpoint; after each round without a win, nodes that are not won get all their moves."""
        self._refresh(self.graph.explore())
        self._run()
        while not self._won():
            narrow = [k for k, node in enumerate(self.graph.nodes) if node.omitted and self.rest[k]]
            if not narrow:
                return False
            for number in narrow:
                self.graph.widen(number)
            self._refresh(self.graph.explore())
            self.push(narrow)
            self._run()
        return True

    def blocks(self) -> Tuple[RawBlock, ...]:
        """The pieces in the order in which they were won."""
        return tuple(_block(self.graph.nodes[k].state, _tidied(pieces)) for k, pieces in sorted(self._pieces.items()))

    def _won(self) -> bool:
        """True if all of the start is won."""
        return bool(self.found) and includes_zone(self.found[0], self.graph.start)

    def _refresh(self, changed: Set[int]) -> None:
        """Take in new nodes, and those in which more is reached: what was won there stays won."""
        nodes = self.graph.nodes
        for _ in range(len(self.found), len(nodes)):
            self.found.append(Federation())
            self.rest.append(Federation())
        for number in sorted(changed):
            reach = Federation((nodes[number].reach,))
            if is_goal(self.graph.game, nodes[number].state):
                self.found[number] = reach
            else:
                self.rest[number] = reach.minus(self.found[number])
        for number in sorted(changed):
            self.push([number])
            if self.found[number]:
                self.push(sorted(nodes[number].sources))

    def _run(self) -> None:
        number = self.pop()
        while number is not None and not self._won():
            if not is_bad(self.graph.game, self.graph.nodes[number].state):
                self._evaluate(number)
            number = self.pop()
        # Left early: what was taken out is evaluated if the search goes on.
        if number is not None:
            self.push([number])

    def _evaluate(self, number: int) -> None:
        node = self.graph.nodes[number]
        moves = node.controllable + node.uncontrollable
        if not any(move.target >= 0 and self.found[move.target] for move in moves):
            return
        upre = self.upre(number, self.rest)
        cpre = self.cpre(number, self.found, upre)
        targets = _union([self.found[number], self._forced_moves(number, node), *(before for _, before in cpre)])
        new = predt(targets, upre).intersect(self.rest[number]).reduced()
        if new:
            self._pieces.setdefault(number, []).extend(_assign(new, cpre))
            self.grow(number, new)

    def _forced_moves(self, number: int, node: Node) -> Federation:
        """Where an automaton is at its bound and the environment, that can move it, has to."""
        known = self._forced.get(number)
        if known is None or known[0] is not node.reach:
            owners = self.graph.limited(number)
            forced = _union(self.graph.at_bound(number, k).intersect(self.graph.own_moves(number, k)) for k in owners)
            known = self._forced[number] = (node.reach, forced)
        return known[1]


class _Soonest(_Reach):
    """With all moves, in Dijkstra's order: by some time to the goal, in hundredths.

    The moves of each agent add up, while agents move at the same time: the longest counts, and a part of the others.
    With a reaction delay that part is all, since else commands are more often overtaken by such as lead less far. A
    move that takes no time counts as one.
    """

    def __init__(self, game: Game, monitor: Monitor) -> None:
        super().__init__(game, monitor, directed=False)
        self._due: Dict[int, int] = {}
        self._busy: Dict[int, Tuple[int, ...]] = {}
        self._others = 100 if game.delta else 25
        self._waiting: List[Tuple[int, int, int]] = []
        self._order = itertools.count()
        self._now = 0

    def push(self, numbers: Iterable[int]) -> None:
        """Look at what leads to those of these nodes in which something is won; the others wait for that."""
        for number in numbers:
            if self.found[number]:
                self.again(number)

    def _push(self, number: int, when: int) -> None:
        if self.rest[number] and when < self._due.get(number, when + 1):
            self._due[number] = when
            heapq.heappush(self._waiting, (when, next(self._order), number))

    def pop(self) -> Optional[int]:
        """The next node; None: a fixpoint."""
        while self._waiting:
            self._now, _, number = heapq.heappop(self._waiting)
            if self._due.get(number) == self._now:
                del self._due[number]
                self.check(1 + self._pairs(number))
                return number
        return None

    def again(self, number: int) -> None:
        """What leads to the node is as much later as the way to it takes."""
        self._push(number, self._now)
        game = self.graph.game
        count = len(game.automata)
        for source in self.graph.nodes[number].sources:
            node = self.graph.nodes[source]
            ways: List[Tuple[int, Tuple[int, ...]]] = []
            for move in node.controllable + node.uncontrollable:
                if move.target == number:
                    takes = max(game.edges[k].duration for k in move.joint.edges)
                    times = list(self._busy.get(number, (0,) * (count + 1)))  # of agents, and the number of other moves
                    times[move.joint.owner if takes else count] += takes or 1
                    longest, total = max(times[:count]), sum(times[:count])
                    due = 100 * longest + self._others * (total - longest) + times[count]
                    ways.append((max(self._now, due), tuple(times)))
            when, busy = min(ways)
            if when < self._due.get(source, when + 1):
                self._busy[source] = busy
            self._push(source, when)


class _Safety(_Fixpoint):
    """`found` is what is lost, `rest` what is reached and not lost (yet)."""

    def __init__(self, game: Game, monitor: Monitor) -> None:
        super().__init__(ZoneGraph(game, monitor))
        self._unforced: List[Federation] = []

    def solve(self) -> bool:
        """The fixpoint, given up as soon as some of the start is lost."""
        graph = self.graph
        graph.explore()
        for k, node in enumerate(graph.nodes):
            self.check()
            reach, bad = Federation((node.reach,)), is_bad(graph.game, node.state)
            self.found.append(reach if bad else Federation())
            self.rest.append(Federation() if bad else reach)
            unforced = (graph.at_bound(k, owner).minus(graph.own_moves(k, owner)) for owner in graph.limited(k))
            self._unforced.append(_union(unforced))
        # What can be lost first is found from the end.
        self.push(reversed(range(len(graph.nodes))))
        number = self.pop()
        while number is not None and not self._lost():
            danger, cpre = self._dangers(number)
            lost = past(danger).minus(predt(_union(before for _, before in cpre), danger))
            new = lost.intersect(self.rest[number]).reduced()
            if new:
                self.grow(number, new)
            number = self.pop()
        return not self._lost()

    def _lost(self) -> bool:
        return not self.rest or not includes_zone(self.rest[0], self.graph.start)

    def _dangers(self, number: int) -> Tuple[Federation, List[Tuple[Transition, Federation]]]:
        """E, where something bad is at hand, and where each of the controller's moves is safe."""
        upre = self.upre(number, self.found)
        cpre = self.cpre(number, self.rest, upre)
        stuck = self._unforced[number].minus(_union(before for _, before in cpre))
        return _union([self.found[number], upre, stuck]).reduced(), cpre

    def blocks(self) -> Tuple[RawBlock, ...]:
        """Wait where that may go on for ever; else take a safe move where there is one; else wait for one."""
        blocks: List[RawBlock] = []
        for number, node in enumerate(self.graph.nodes):
            self.check()
            safe = self.rest[number]
            if safe:
                danger, cpre = self._dangers(number)
                # At a bound that only the controller can leave, waiting on is not possible.
                threatened = safe.intersect(past(danger.union(self._unforced[number])))
                pieces: List[Piece] = [(zone, None) for zone in safe.minus(threatened).disjoint()]
                blocks.append(_block(node.state, [*pieces, *_assign(threatened, cpre)]))
        return tuple(blocks)


def followed(game: Game, blocks: Sequence[RawBlock]) -> List[int]:
    """The numbers of the blocks whose discrete states a play by the strategy can come to (whatever the clocks)."""
    by_state = {State(tuple(block[0]), tuple(block[1])): number for number, block in enumerate(blocks)}
    start = initial_state(game)
    met: Set[State] = {start}
    waiting: Deque[State] = deque([start])
    while waiting:
        state = waiting.popleft()
        if is_goal(game, state) or is_bad(game, state) or state not in by_state:
            continue
        commanded = {tuple(action) for _, action in blocks[by_state[state]][2] if action is not None}
        for move in joint_moves(game, state):
            if move.target not in met and (not move.controllable or move.edges in commanded):
                met.add(move.target)
                waiting.append(move.target)
    return [number for state, number in by_state.items() if state in met]
