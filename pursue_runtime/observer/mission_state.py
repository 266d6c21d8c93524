"""What the observer knows of a mission, and the state to publish. Times are seconds of ROS time."""

from __future__ import annotations

from typing import Any, Collection, Dict, List, Optional, Set, Tuple

from pursue_runtime.event_words import Word
from pursue_runtime.model import ACTING, Model, Position
from pursue_runtime.observer.automata import Automata
from pursue_runtime.observer.ending import Ending
from pursue_runtime.observer.life import Life
from pursue_runtime.observer.ordering import Ordering
from pursue_runtime.observer.orders import Orders
from pursue_runtime.observer.planning import Planning
from pursue_runtime.observer.reports import ALL, Beginnings, SharedEnds
from pursue_runtime.observer.robots import Robots, Service
from pursue_runtime.observer.ways import Ways
from pursue_runtime.sentences import Log, Told, in_words
from pursue_runtime.state import RUNNING, WON, SystemState
from pursue_runtime.strategy import Cover, Entry

COUNTED = ("taken", "stale", "held", "uncommanded", "impossible", "untimely", "unreadable", "uncovered")


class MissionState:
    """The state of one mission, whom it waits for, and its end.

    `unit` is the length of a time unit in seconds; `tolerance`, in time units, is how far clocks may be off (a message
    takes its time) before a deadline counts as missed or a state as not covered; `lost_after`, in time units, is how
    late an agent may be before it counts as lost. `on_uncovered` is what follows in a state that the strategy does not
    cover: `plan` again, `stop`, or `warn`. `controllers` are the nodes that have to acknowledge a new plan.
    `name` is the mission's id, which its states carry. `shared_ends` (`all`, `doer`): whose reports end what several do
    together.
    """

    def __init__(
        self,
        model: Model,
        cover: Optional[Cover],
        log: Log,
        unit: float = 1.0,
        tolerance: float = 0.1,
        on_uncovered: str = "stop",
        lost_after: float = 30.0,
        controllers: Collection[str] = (),
        name: str = "",
        shared_ends: str = ALL,
    ) -> None:
        self.model, self.name = model, name
        self.seq = self.plan = 0
        self._since: Dict[Entry, int] = {}  # the number of the state in which was decided what stands (else: this one)
        self.counts = dict.fromkeys(COUNTED, 0)
        self.late: Set[str] = set()
        self.lost: Dict[str, str] = {}  # and why
        self.silent: Set[str] = set()
        self._relying = -1  # after so many moves there was no plan without those who are late
        self._told = Told()  # what was logged of the reason since the mission holds
        self.ways = Ways(model)
        self.robots = Robots(model)
        self.service = Service(model)
        self.orders = Orders(model)
        self.shared_ends = SharedEnds(model, shared_ends)
        self.in_force: Optional[Dict[str, Any]] = None  # the data of the plan, None: the workspace's own
        self._cover, self._log, self._unit, self._tolerance = cover, log, unit, tolerance
        self._on_uncovered, self._lost_after = on_uncovered, lost_after
        self._early: Dict[Word, float] = {}  # and their moments
        self._beginnings = Beginnings()
        self._planning = Planning(controllers)
        self.ordering = Ordering()
        self._warned = False
        self._shown = self.robots.revision()  # in the newest state
        self._automata = Automata(model, unit)
        self._life = Life(lambda: not model.goal or self._automata.is_won(), lambda: bool(self._automata.lost()))
        self.ending = Ending(model)
        self._begun: Optional[float] = None
        self._event = self._agent = ""
        self._commanded = False
        self.taken: Optional[Dict[str, Any]] = None
        """The order that the last call of the journal has taken or cancelled: its event, the number of its plan, and
        since when (seconds) the clocks run that it has started."""
        self._ended: Optional[float] = None
        self.goal_at: Optional[float] = None
        """When the goal was reached; the mission is won once all orders were acknowledged."""

    @property
    def status(self) -> str:
        """Return the status, a word of STATUSES."""
        return self._life.state

    @property
    def reason(self) -> str:
        """Return why it holds or has ended, or what its end waits for, as a sentence; "": there is nothing to say."""
        return self._life.reason or (self.ending.says if self.status == RUNNING else "")

    def position(self, now: float) -> Position:
        """Return locations, variables and clocks at the time `now`, or at the end of the mission if that was before."""
        return self._automata.position(now if self._ended is None else self._ended)

    def state(self, now: float) -> SystemState:
        """Return the state to publish."""
        position = self.position(now)
        late, lost = tuple(sorted(self.late)), tuple(sorted(self.lost))
        what = self._event, self._agent, self.status, self.reason, self._unit, self.plan, lost, self.name, late
        state = SystemState(self.seq, now, position.locations, position.values, position.clocks, *what)
        held, displaced, returning = self.robots.revision()
        finished = tuple(sorted(self.shared_ends.finished))
        out = tuple(sorted(self.service.out))
        robots = state._replace(held=held, displaced=displaced, returning=returning, out_of_service=out)
        return robots._replace(commanded=self._commanded, finished=finished, orders=self.orders.texts())

    def revision(self) -> Tuple[object, ...]:
        """Return a value that a call changes if, and only if, the call has to be in the journal."""
        people = len(self.late), len(self.lost), len(self.silent)
        robots = *self.robots.revision(), *self.ways.revision(), *self.shared_ends.revision(), self.orders.texts()
        others = *people, *robots, *self._early, *self._planning.revision(), *self.ordering.revision
        return (self.seq, self.status, self.reason, *self.ending.revision, *others)

    def _passed(self, now: float) -> float:
        """Return the time units since the start; 0 before it."""
        return 0.0 if self._begun is None else (now - self._begun) / self._unit

    def _new_state(self, now: float) -> List[SystemState]:
        self.seq, self._shown = self.seq + 1, self.robots.revision()
        self._since = {}
        self._event, self._agent, self._commanded = "", "", False
        return [self.state(now)]

    # Who is waited for ------------------------------------------------------------------------------------------------

    def _late_agents(self, position: Position) -> List[Tuple[str, float]]:
        """Return the agents that are late but not lost, with their delays (time units; negative: overdue)."""
        acting = self._bounds(position, *ACTING)
        waiting = self.robots.waiting()
        return [(name, delay) for name, delay in acting if name in self.late and name not in {*self.lost, *waiting}]

    def _bounds(self, position: Position, *kinds: str) -> List[Tuple[str, float]]:
        """Return on whom it waits that locations are left, and the time units until then (negative: overdue)."""
        bounds = self._automata.bounds(position, *kinds)
        return [(who, delay) for name, delay in bounds for who in self.shared_ends.awaited(name, position)]

    # Ends -------------------------------------------------------------------------------------------------------------

    def _end(self, trigger: str, reason: str, now: float) -> List[SystemState]:
        self._event, self._agent, self._commanded = "", "", False
        self._conclude(trigger, reason, now)
        return [self.state(now)]

    def _conclude(self, trigger: str, reason: str, now: float) -> None:
        self._life.take(trigger, reason)
        self._ended = now
        level = "info" if self.status == WON else "err"
        self._log(level, f"the mission is {self.status}" + (f": {in_words(reason)}" if reason else ""))

    def _reject(self, kind: str, message: str, level: str = "warn") -> None:
        self.counts[kind] += 1
        self._log(level, message)
