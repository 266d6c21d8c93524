"""How an observer that was away takes up a mission: it hears first what happened meanwhile, then time goes on.

Words are kept until all nodes that may have something to report have said so, and are then taken in the order of the
times that they carry: as if the observer had been there. Times are seconds of ROS time, `real` of the monotonic clock.
"""

from __future__ import annotations

import time
from typing import Any, Callable, Collection, List, Mapping, NamedTuple, Optional, Set, Tuple

from pursue_runtime.data import DataError
from pursue_runtime.event_words import EVENTS, STOP, said_at
from pursue_runtime.observer.journal import Journal
from pursue_runtime.observer.mission import Mission
from pursue_runtime.observer.records import Rank
from pursue_runtime.observer.witnesses import find_state
from pursue_runtime.sentences import Log
from pursue_runtime.state import LIVE, SystemState

PATIENCE = 5.0
"""Seconds of real time for which it waits for these nodes."""

STILL = 1.0
"""Seconds for which nobody has looked at the time, and by which a moment is over that is due: the observer was
suspended, or its machine was. So long it hears then what was published meanwhile."""

AT_ONCE = 0.001
"""Seconds by which a word may come after a moment that is due, and be taken first: they came together."""

MOST = 10_000
"""So many deadlines are handled between two words at most."""


def since_boot() -> float:
    """Return seconds that go on while the machine sleeps."""
    return time.clock_gettime(time.CLOCK_BOOTTIME)


class Heard(NamedTuple):
    """A word, and when what it says counts."""

    moment: float
    text: str


class Returning:
    """The words that were heard since the observer is back.

    `floor`: the time of the newest state that any node has seen. Nothing counts before it: that state says how things
    were then.
    """

    def __init__(
        self, floor: float, awaited: Optional[Collection[str]], real: float, patience: float = PATIENCE
    ) -> None:
        """`awaited`: the nodes that may have something to report, and say when that was all; None: none says so."""
        self.floor = floor
        self.deadline = real + patience
        self._says_so = awaited is not None
        self._awaited: Set[str] = set(awaited or ())
        self._heard: List[Heard] = []

    def is_over(self, real: float) -> bool:
        """Return True if nobody is waited for any more."""
        return (self._says_so and not self._awaited) or real >= self.deadline

    def missing(self) -> List[str]:
        """Return the nodes that have not said that they have reported all."""
        return sorted(self._awaited)

    def hear(self, text: str, now: float) -> None:
        """Keep a word. It counts at the time that it carries, but not before `floor` nor after `now`, at which it was
        received: the clocks of two machines may differ."""
        at = said_at(text)
        self._heard.append(Heard(now if at is None else max(self.floor, min(at, now)), text))

    def on_reported(self, node: str) -> None:
        """Take that a node has reported all that it had to."""
        self._awaited.discard(node)

    def settle(self, mission: Mission, journal: Journal) -> List[SystemState]:
        """Pass what was heard to the mission, through its journal, each word at its moment and after the deadlines
        that were before it; return the states to publish."""
        states: List[SystemState] = []
        for moment, text in sorted(self._heard, key=lambda heard: heard.moment):
            states += _let_time_pass(mission, journal, max(self.floor, journal.last), moment)
            states += journal.call("hear", text, now=max(moment, journal.last))
        self._heard = []
        return states


class Inbox:
    """All that comes to a mission: it goes through the journal, and waits while the observer is `returning`.

    Each method but the last two returns the states to publish. `now` is ROS time; nothing comes before what is written
    down, and no word before the deadlines that have passed.
    """

    def __init__(
        self,
        mission: Mission,
        journal: Journal,
        log: Log,
        returning: Optional[Returning] = None,
        clock: Callable[[], float] = since_boot,
    ) -> None:
        """`returning`: as `take_up` returns it; `log` takes a level and a sentence; `clock` gives seconds, also while
        the machine sleeps."""
        self.returning = returning
        self._mission, self._journal, self._log, self._clock = mission, journal, log, clock
        self._looked, self._looked_at = 0.0, clock()  # when somebody has looked at the time, by both clocks
        self._moment: Optional[float] = None  # when something was due, as of then

    def call(self, name: str, *args: Any, now: float) -> List[SystemState]:
        """Call the mission (a name in CALLS). A word is kept while the observer returns; anything else ends that."""
        self.notice_absence(now)
        if self.returning is not None and name == "hear" and args[0].strip() != STOP:
            self.returning.hear(args[0], now)
            return []
        states = self._settle()
        if self._moment is not None and now > self._moment + AT_ONCE and name != "tick":
            states += _let_time_pass(self._mission, self._journal, self._journal.last, now - AT_ONCE)
        return states + self._journal.call(name, *args, now=max(now, self._journal.last))

    def on_reported(self, node: str, real: float) -> List[SystemState]:
        """Take that a node has reported all that it had to."""
        if self.returning is None:
            return []
        self.returning.on_reported(node)
        return self._settle() if self.returning.is_over(real) else []

    def on_alarm(self, now: float, real: float) -> List[SystemState]:
        """Handle what is due by the time; while the observer returns, only that it has waited long enough."""
        self.notice_absence(now)
        if self.returning is None:
            return self.call("tick", now=now)
        return self._settle() if self.returning.is_over(real) else []

    def next_moments(self, now: float) -> Tuple[Optional[float], Optional[float]]:
        """Return when to call `on_alarm`, in ROS time and on the monotonic clock; None: never."""
        if self.returning is not None:
            return None, self.returning.deadline
        self._moment, self._looked, self._looked_at = self._mission.next_moment(now), now, self._clock()
        return self._moment, None

    def notice_absence(self, now: float) -> None:
        """Hear first what was reported meanwhile if the observer stood still while something became due."""
        was_due = self._moment is not None and now > self._moment + STILL
        away = self._clock() - self._looked_at
        if self.returning is None and was_due and away > STILL:
            self._log("warn", f"the observer stood still for {away:.1f} s: it hears first what was reported meanwhile")
            self.returning = Returning(max(self._looked, self._journal.last), None, time.monotonic(), STILL)

    def _settle(self) -> List[SystemState]:
        """Take what was reported of the time without an observer."""
        returning, self.returning = self.returning, None
        if returning is None:
            return []
        self._moment = None
        if returning.missing():
            self._log("warn", f"no answer on {EVENTS} from {', '.join(returning.missing())}")
        return returning.settle(self._mission, self._journal)


def take_up(
    mission: Mission,
    journal: Journal,
    seen: Mapping[str, SystemState],
    reporting: Collection[str],
    now: float,
    real: float,
    begun: bool = True,
    reached: Rank = (0, False),
) -> Optional[Returning]:
    """Take up the mission where the journal and the other nodes have it; stop it where that is unclear.

    `seen`: the newest state that each node has seen; `reporting`: those of these nodes that may have something to
    report; `begun`, `reached`: as for `find_state`. Return what they have to report of the time in which there was no
    observer; None where nobody has, or none of them has seen the mission: then nobody knows until when the observer was
    there.
    """
    found = find_state(mission.state(now), journal.damage, journal.after, seen, begun, max(journal.reached, reached))
    why = found.stop
    if found.adopt is not None:
        try:
            journal.adopt(found.adopt, found.adopt.stamp if reporting else now)
        except DataError as problem:
            why = f"the observer was restarted, and cannot go on from state {found.adopt.seq}: {problem}"
    goes_on = reporting and not why and mission.status in LIVE
    stamps = (seen[node].stamp for node in reporting)
    floor = max([journal.last, *stamps]) if goes_on else max(now, journal.last)
    journal.call("stop" if why else "restarted", *([why] if why else []), now=floor)
    return Returning(floor, reporting, real) if goes_on else None


def _let_time_pass(mission: Mission, journal: Journal, start: float, end: float) -> List[SystemState]:
    """Handle what is due until `end`, each at its moment."""
    states: List[SystemState] = []
    now, known = start, mission.revision()
    for _ in range(MOST):
        moment = mission.next_moment(now)
        if moment is None or moment > end:
            break
        states += journal.call("tick", now=max(moment, now))
        if moment <= now and mission.revision() == known:
            break  # it waits for something else than time
        now, known = max(moment, now), mission.revision()
    return states
