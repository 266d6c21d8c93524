"""All ways of one robot, driven so many times each, and its actions: what is sent, and what is measured. Without ROS.

Goals, retries and arrivals are those of a mission: `Navigation` is shown a state in which the robot is on its way, and
the word with which it would report the end is the end of the drive. Times are seconds of ROS time, `real` of the
monotonic clock. An action goes on from the moment in which it is sent to the word that reports its end.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Callable, Dict, FrozenSet, Iterator, List, Mapping, NamedTuple, Optional, Set, Tuple

from pursue_runtime.controller.goal import Goal, Movement
from pursue_runtime.controller.navigation import Navigation
from pursue_runtime.controller.settings import Settings
from pursue_runtime.controller.view import View
from pursue_runtime.controller.whereabouts import Place
from pursue_runtime.drives.actions import DONE, MOST_FAILURES, Act, Acts, location_of
from pursue_runtime.drives.report import ARRIVED, FAILED, INTERRUPTED, LATE, Drive
from pursue_runtime.drives.tour import Way, next_way, towards
from pursue_runtime.event_words import HELD, parse_report, parse_word
from pursue_runtime.locations import movement
from pursue_runtime.sentences import Log, in_words


class Plan(NamedTuple):
    """What is to be driven: each of the `ways` `times` times, those in `first` before the others. `limit`: the seconds
    that one drive or action may take; `pause`: the seconds between two of them. `acts` are to be done too, each
    `actions` times. `only_goes`: nothing of that, the robot only goes to its start, and why, in words."""

    ways: Tuple[Way, ...]
    times: int = 5
    limit: float = 300.0
    pause: float = 1.0
    acts: Tuple[Act, ...] = ()
    actions: int = 0
    first: FrozenSet[Way] = frozenset()
    only_goes: str = ""

    @property
    def partner(self) -> str:
        """Who takes part in one of the actions; "": all are done alone."""
        return next((act.partner for act in self.acts if act.partner), "")

    def words(self, start: str) -> str:
        """What a robot does that begins at `start`, behind its name."""
        if self.only_goes:
            return f"goes to {start}, {self.only_goes}"
        if not self.ways and len(self.acts) == 1:
            return f"does {self.acts[0]}"
        some = 0 < len(self.first) < len(self.ways)
        first = f", the {len(self.first)} that the strategy uses first" if some else ""
        also = f", and does {len(self.acts)} actions {self.actions} times each" if self.acts else ""
        return f"drives {len(self.ways)} ways {self.times} times each{first}, from {start} on{also}"


class Due(NamedTuple):
    """What is to be done now: a goal to send, the id of a goal to call back, a drive that has ended, an action."""

    goal: Optional[Goal] = None
    cancel: Optional[str] = None
    drive: Optional[Drive] = None
    act: Optional[Act] = None


@dataclass
class _Leg:
    """A drive that is under way, or an action (`act`); `counts`: it is one of the plan, and not one to a place to begin
    at."""

    a: str
    b: str
    start: float
    counts: bool
    goals: int = 0
    act: Optional[Act] = None
    ended: Set[str] = field(default_factory=set)  # who has reported the end of the action

    @property
    def location(self) -> str:
        """The location of the robot in a mission that would be so far."""
        return movement(self.a, self.b) if self.act is None else location_of(self.act)


class Session:
    """The drives and actions of one robot; its `navigation` takes results, statuses and positions.

    It begins with a drive to `start`, which does not count, unless it is there; so it goes on after a failed one, to
    where that began, or to another place. A robot whose goal another node cancels is left to that; a drive on which
    another node sent it elsewhere is made once more. Where the tour passes a place at which an action of its plan is
    left that the rules allow, it is done there.
    """

    def __init__(
        self,
        robot: str,
        places: Mapping[str, Place],
        start: str,
        plan: Plan,
        settings: Settings,
        log: Log,
        acts: Optional[Acts] = None,
        at_start: bool = False,
        who_is_near: Callable[[Place], str] = lambda place: "",
    ) -> None:
        """`acts`: those of the robot, with what was measured of them; None: it has none. `at_start`: the robot is at
        `start`; `who_is_near`: which other robot stands near a goal, in words."""
        self.robot, self.plan = robot, plan
        self.is_over = False
        self.problem = ""  # why it ended before all was driven
        self.measured: Dict[Way, List[float]] = {way: [] for way in plan.ways}
        self.navigation = Navigation(robot, settings, log)
        self._places, self._start, self._log = places, start, log
        self._failures: Dict[Way, int] = {}
        self._why_failed: Dict[Way, str] = {}
        self._who_is_near = who_is_near
        self._leg: Optional[_Leg] = None
        self._acts = acts or Acts(robot, (), 0, None)
        self._place = start if at_start or not (plan.ways or plan.only_goes) else ""  # where it is, "": not known
        others = [place for place in places if place != start and not plan.only_goes]
        self._tries = [start, *others]  # where it may begin
        self._next_at = float("-inf")
        self._seq = 0
        self._word: Optional[str] = None

    @property
    def goal(self) -> str:
        """The id of the goal in progress, "" if none."""
        return self.navigation.goal

    @property
    def place(self) -> str:
        """Where the robot stands; "" if that is not known, or it is under way."""
        return self._place if self._leg is None else ""

    @property
    def location(self) -> str:
        """The location of the robot in a mission that would be so far; "" where it stands."""
        return self._leg.location if self._leg is not None else ""

    # From the robot ---------------------------------------------------------------------------------------------------

    def on_word(self, text: str) -> None:
        """Takes a word on pursue/events: a robot may report by one that it has arrived, from wherever, or failed; and
        whoever does an action reports its end."""
        report, word, leg = parse_report(text), parse_word(text), self._leg
        if leg is None:
            return
        if leg.act is not None:
            if word is not None and word.event == leg.act.event + DONE:
                leg.ended.add(word.agent or self.robot)
            arrives = leg.ended.issuperset(leg.act.robots(self.robot) if leg.act.busy else (self.robot,))
        else:
            ends = {f"{self.robot}_{movement(a, leg.b)}2{leg.b}" for a in (leg.a, *self._places)}
            arrives = word is not None and word.event in ends
        who = (self.robot,) if leg.act is None else leg.act.robots(self.robot)
        if arrives or (report is not None and report.agent in who):
            self._word = text

    # What is due ------------------------------------------------------------------------------------------------------

    def due(self, now: float, real: float) -> Due:
        """What is to be done now."""
        if self.is_over:
            return Due()
        if self._leg is None and (now < self._next_at or not self._begin(now)):
            return Due()
        leg = self._leg
        assert leg is not None, "a drive has begun"
        goal: Optional[Goal] = None
        if leg.act is None:
            due = self.navigation.due(now, real)
            goal, self._word = due.goal, self._word or due.word
        elif not leg.goals:
            leg.goals = 1
            return Due(act=leg.act)
        leg.goals += goal is not None
        word, self._word = self._word, None
        if word is not None:
            return self._ended(leg, word, now)
        if now >= leg.start + self.plan.limit:
            cancel = self.goal or None
            what = "not there" if leg.act is None else "not done"
            if leg.act is not None and leg.act.busy and leg.ended:
                what = f"{self.robot if leg.act.partner in leg.ended else leg.act.partner} has not done it"
            text = f"{what} after {self.plan.limit:g} s{self._near(leg)}"
            return Due(cancel=cancel, drive=self._end(leg, LATE, text, now))
        return Due(goal=goal)

    def next_moment(self) -> Optional[float]:
        """When to call `due` again; None: not before the next input."""
        if self.is_over:
            return None
        if self._leg is None:
            return self._next_at
        moment = self.navigation.next_moments()[0] if self._leg.act is None else None
        limit = self._leg.start + self.plan.limit
        return limit if moment is None else min(moment, limit)

    def stop(self, now: float) -> Due:
        """Ends it at once: what is measured stays."""
        self._stop("stopped")
        leg, cancel = self._leg, self.goal or None
        if leg is None:
            return Due()
        return Due(cancel=cancel, drive=self._end(leg, INTERRUPTED, "", now))

    def summary(self) -> Iterator[str]:
        """What was measured of each way, a sentence each."""
        for way, times in self.measured.items():
            took = f", {min(times):.1f} to {max(times):.1f} s" if times else ""
            failed = self._failures.get(way, 0)
            text = f"{self.robot} from {way[0]} to {way[1]}: {len(times)} of {self.plan.times} drives{took}"
            yield text + (f"; {failed} failed" if failed else "")

    @property
    def is_complete(self) -> bool:
        """True where each way was driven so often as was wanted."""
        return all(len(times) >= self.plan.times for times in self.measured.values())

    # Drives -----------------------------------------------------------------------------------------------------------

    def _begin(self, now: float) -> bool:
        """Begins the next drive or action; False where there is none."""
        self._word = None
        self._seq += 1
        if self._place:
            way = next_way(self._place, self._left(), self._usable())
            act = self._acts.next(self._place, way is None, self.plan.acts)
            if act is not None:
                self._leg = _Leg(act.place, act.place, now, counts=True, act=act)
                return True
            way = way or towards(self._place, self._acts.places(self.plan.acts), self._usable())
            if way is None:
                self._stop(self._why_not_all())
                return False
            self._leg = _Leg(*way, now, counts=True)
        elif self._tries:
            self._leg = _Leg("", self._tries.pop(0), now, counts=False)
        else:
            self._stop(f"it does not get to {self._start}" if self.plan.only_goes else "it gets to no place")
            return False
        leg = self._leg
        way_there = Movement(leg.location, self._places[leg.b])
        self.navigation.on_state(View(way_there.location, way_there, seq=self._seq), now)
        self.navigation.start(way_there, now)
        return True

    def _ended(self, leg: _Leg, word: str, now: float) -> Due:
        report = parse_report(word)
        if report is None and leg.act is None and self.navigation.was_taken_back:
            drive = self._end(leg, INTERRUPTED, "another node sent it elsewhere on its way", now)
            self._place = leg.b  # it is there all the same
            return Due(drive=drive)
        if report is None:
            return Due(drive=self._end(leg, ARRIVED, "", now))
        text = in_words(report.text)
        if report.event == HELD:
            self._stop(f"{text or 'it was called back'}: it is left to that")
            return Due(drive=self._end(leg, INTERRUPTED, text, now))
        cancel, near = self.goal or None, self._near(leg)
        return Due(cancel=cancel, drive=self._end(leg, FAILED, text + near, now))

    def _end(self, leg: _Leg, outcome: str, text: str, now: float) -> Optional[Drive]:
        """The drive or action is over; what it is on `pursue/drives`, None where it does not count."""
        name = "" if leg.act is None else leg.act.event
        drive = Drive(self.robot, leg.a, leg.b, leg.start, now, outcome, leg.goals, text, name)
        self._leg = None
        self._next_at = now + self.plan.pause
        if leg.act is not None:
            self._end_act(leg.act, drive)
            return drive
        arrived = outcome == ARRIVED
        self._place = leg.b if arrived else ""
        self._acts.arrived()
        self.navigation.on_state(View(self._place, seq=self._seq), now)
        if arrived and leg.counts:
            self.measured.setdefault((leg.a, leg.b), []).append(drive.seconds)
            count = sum(min(len(times), self.plan.times) for times in self.measured.values())
            all_ = self.plan.times * len(self.plan.ways)
            took = f"{drive.seconds:.2f} s{f', with {leg.goals} goals' if leg.goals > 1 else ''}"
            self._log("info", f"{self.robot} from {leg.a} to {leg.b}: {took} ({count} of {all_})")
        elif not arrived:
            whence = f" from {leg.a}" if leg.a else ""
            self._log("warn", f"{self.robot}{whence} to {leg.b}: {outcome}{f', {text}' if text else ''}")
        if outcome in (FAILED, LATE) and leg.counts:
            self._failures[leg.a, leg.b] = self._failures.get((leg.a, leg.b), 0) + 1
            self._why_failed[leg.a, leg.b] = text
            self._tries = [leg.a, *(place for place in self._places if place != leg.a)]
        return drive if leg.counts else None

    def _end_act(self, act: Act, drive: Drive) -> None:
        if drive.outcome == ARRIVED:
            self._acts.done(act, drive.seconds)
            self._log("info", f"{self.robot} does {act}: {drive.seconds:.2f} s")
        else:
            self._acts.failed(act)
            self._log("warn", f"{self.robot} does {act}: {drive.outcome}{f', {drive.text}' if drive.text else ''}")

    def _near(self, leg: _Leg) -> str:
        """Who stands on the goal of a drive, behind why it failed; "" if nobody is known to."""
        who = self._who_is_near(self._places[leg.b]) if leg.act is None else ""
        return f"; {who}" if who else ""

    def _left(self) -> Dict[Way, int]:
        """How often each way is still to be driven now: the first ones alone, as long as any of them is left."""
        times, usable = self.plan.times, self._usable()
        left = {way: max(0, times - len(self.measured[way])) for way in self.plan.ways if way in usable}
        first = {way: count for way, count in left.items() if way in self.plan.first}
        return first if any(first.values()) else left

    def _why_not_all(self) -> str:
        """Why not all was driven: one reason, the first that has others as its consequence; "" if all was."""
        missing = [way for way, times in self.measured.items() if len(times) < self.plan.times]
        for a, b in missing:
            if self._failures.get((a, b), 0) >= MOST_FAILURES:
                return f"the way from {a} to {b} was given up: {self._why_failed[a, b]}"
        if missing:
            return f"from {self._place} it gets to no place from which a way is left, such as {missing[0][0]}"
        return ""

    def _usable(self) -> Tuple[Way, ...]:
        return tuple(way for way in self.plan.ways if self._failures.get(way, 0) < MOST_FAILURES)

    def _stop(self, problem: str) -> None:
        self.is_over, self.problem = True, self.problem or problem
