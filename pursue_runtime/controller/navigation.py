"""When a robot gets its goals and actions, and what of its movements is reported.

Times are seconds of ROS time, `real` of the monotonic clock; distances are metres.
"""

from __future__ import annotations

from typing import List, Optional, Sequence, Tuple

from pursue_runtime.controller.answers import meaning_of
from pursue_runtime.controller.goal import CANCELLED, OVER, SUCCEEDED, Answer, Goal, GoalTracker, Halt, Movement
from pursue_runtime.controller.settings import Settings
from pursue_runtime.controller.trip import Trip
from pursue_runtime.controller.view import Due, View
from pursue_runtime.controller.whereabouts import Position, Whereabouts
from pursue_runtime.doors.lifts import IS_ABOARD
from pursue_runtime.doors.opened import NONE_OPENED
from pursue_runtime.event_words import BACK, DISPLACED, FAILED, HELD, RESUME, RobotReport, Word
from pursue_runtime.locations import is_action
from pursue_runtime.orders import Order
from pursue_runtime.resend import RepeatedReport
from pursue_runtime.sentences import Log, in_words, marked

GRACE = 2.0
"""Seconds for which the position of a robot may be missing, or the robot may move about, before that is reported."""


class Navigation:
    """Goals and actions for one robot, and what follows from its results and positions.

    The robot gets goals for the movement that the state shows, and gets an action only where it is known to be at the
    action's place. If it is not, that is reported; while the state lists it as `returning` it gets a goal for its
    place. A goal that a goal of another node has replaced is sent again, `~retries` times. One that another node has
    cancelled, or replaced once more, is sent again when the state has listed the robot as `held`, and does so no more.
    A goal that fails is sent again, `~retries` times, the last time to the robot's spare pose at the place if it has
    one. No other robot is sent there. On a way through doors it waits in front of them until they are open for it;
    on one by lift also in the cabin.
    """

    def __init__(self, name: str, settings: Settings, log: Log) -> None:
        self.name, self.settings = name, settings
        self.trouble = ""  # what an operator should know, as part of a sentence
        self._log = log
        self._view = View()
        self._saw_begin = False  # this node has seen how the robot came to be where the state has it
        self._as_of = 0  # the number of the first state that has the robot at its location
        self._trip: Optional[Trip] = None
        self._goal = GoalTracker(settings)
        self._at = Whereabouts(settings)
        self._actions: List[Order] = []  # they wait until the robot is known to be at its place
        self._given: List[Tuple[Order, RepeatedReport]] = []  # they are sent again until they are acknowledged
        self.reaction = 0.0
        """The seconds that the strategy allows a command: reports are sent again by it; 0: not known."""
        self._report: Optional[RepeatedReport] = None
        self._aboard: Optional[RepeatedReport] = None  # to its lift, which shows that it has it by opening
        self._doubt: Optional[float] = None  # since when it is not known to be where the state has it
        self._was_sent_away = False  # by another node, from where the state has it
        self.opened = NONE_OPENED
        """For whom which doors are open."""

    @property
    def goal(self) -> str:
        """Return the id of the goal in progress, "" if none."""
        return self._goal.current.name if self._goal.current else ""

    @property
    def position(self) -> Optional[Position]:
        """Return the last position of the robot."""
        return self._at.position

    @property
    def was_taken_back(self) -> bool:
        """Return True if another node sent the robot elsewhere on this trip, and its goal was sent again."""
        return self._trip is not None and self._trip.replaced > 0

    @property
    def is_open(self) -> bool:
        """Return True while the robot may get goals and actions."""
        return (self._may_begin or self._view.returning) and not self._view.held

    def is_placed(self, now: float) -> bool:
        """Return True if the robot is known to be where the state has it, or the state says that it is not."""
        return self._is_known(now) or self._view.displaced

    # What happens -----------------------------------------------------------------------------------------------------

    def on_state(self, view: View, now: float) -> None:
        """Take from a state what it says about the robot."""
        before, self._view = self._view, view
        if view.location != before.location:
            self._saw_begin = bool(before.location)
            self._enter(view, now)
        if self._report is not None and view.shows(self._report.word):
            self._report.confirmed = True
        self._given = [(order, sent) for order, sent in self._given if order.seq in view.unanswered]
        trip = self._trip
        if trip is not None and trip.waits and before.held and not view.held:
            trip.resume(now)
        if self.settings.believes_words and view.displaced != before.displaced:  # also by the controller before this
            self._was_sent_away = view.displaced
        if view.returning and view.post is not None and trip is None:
            self._trip = Trip(Movement(view.location, view.post), now, is_return=True, goal_at=now)
        elif trip is not None and trip.is_return and not view.returning:
            self._trip = None
            self._goal.drop()

    def start(self, way: Movement, now: float) -> None:
        """Start a movement: its goal is due now."""
        self._trip = Trip(way, now, goal_at=now, halts=way.halts)

    def act(self, order: Order) -> None:
        """Start an action: it is due as soon as the robot is known to be at its place."""
        self._actions.append(order)

    def on_result(self, answer: Answer, now: float) -> None:
        """Take a result of move_base."""
        trip = self._trip
        if trip is None or trip.has_arrived or not self._goal.ends(answer):
            return
        if trip.arrives_at is None and answer.status not in CANCELLED:
            return  # it is in front of the door, or as near as it comes
        if answer.status == SUCCEEDED:
            self._on_success(trip)
        elif answer.status in CANCELLED:
            self._on_cancelled(trip, answer, now)
        else:
            self._on_failure(trip, answer, now)

    def on_status(self, answers: Sequence[Answer], now: float, real: float) -> None:
        """Take move_base's status: the goals that it has, and those that are over since a few seconds."""
        for answer in self._goal.on_status(answers, real):
            self.on_result(answer, now)
        trip, has_others = self._trip, self._goal.others(answers)
        if trip is None and has_others:
            self._at.on_departure()
            self._was_sent_away = self._view.post is not None and not self._is_acting
        elif trip is not None and trip.cancelled is not None:
            if has_others:
                self._on_replaced(trip, trip.cancelled, now)
            elif any(answer.goal == trip.cancelled.goal and answer.status in OVER for answer in answers):
                self._hold(trip, trip.cancelled)

    def on_position(self, position: Optional[Position], now: float) -> None:
        """Take a position on the map; None: it is not published any more."""
        self._at.on_position(position, now)

    def say_again(self) -> None:
        """Have the present report published again at once: an observer has appeared."""
        if self._report is not None:
            self._report.say_again()

    def give_again(self) -> None:
        """Have orders that were not acknowledged sent again at once: the robot has connected."""
        for _, sent in self._given:
            sent.say_again()

    # What is to be done -----------------------------------------------------------------------------------------------

    def due(self, now: float, real: float) -> Due:
        """Return what is to be sent and published now, if anything."""
        self._check_post(now)
        trip = self._trip
        goal = None
        if trip is not None:
            if not trip.is_return and now >= self._arrives_at(trip):
                self._arrive(trip)
            if trip.cancelled is not None and now >= trip.decided_at:
                self._hold(trip, trip.cancelled)
            passed = trip.passed(self._may_pass)
            if passed:
                self._aboard = None
                trip.go_on(passed, now)
            goal = self._due_goal(trip, now, real)
        for order in [order for order in self._actions if self._may_act(order, now)]:
            self._actions.remove(order)
            self._given.append((order, RepeatedReport(Word("", order.event, order.seq), self.reaction)))
        actions = [order for order, sent in self._given if sent.due(now, real) and self._may_act(order, now)]
        word, aboard = (None if each is None else each.due(now, real) for each in (self._report, self._aboard))
        return Due(goal, tuple(actions), word, aboard)

    def next_moments(self) -> Tuple[Optional[float], Optional[float]]:
        """Return when to call `due` again, in ROS time and on the real clock; None: not before the next input."""
        moments: List[float] = []
        trip, post = self._trip, self._view.post
        if trip is not None:
            moments += [self._goal_due_at(trip)] if trip.goal_at is not None and self._may_go(trip) else []
            moments += [] if trip.is_return else [self._arrives_at(trip)]
            moments += [trip.decided_at] if trip.cancelled is not None else []
        if post is not None and self._doubt is not None:
            moments += [self._at.stands_at()] if self._at.is_near(post) and not self._goal.is_active else []
            moments += [] if self._reports(DISPLACED) or self._view.displaced else [self._doubt + self._grace]
        finite = [moment for moment in moments if moment < float("inf")]
        repeats = [each.next_moment() for each in (self._report, self._aboard) if each is not None]
        repeats += [sent.next_moment() for _, sent in self._given]
        return min(finite, default=None), min((each for each in repeats if each is not None), default=None)

    # Where it is ------------------------------------------------------------------------------------------------------

    def _is_known(self, now: float) -> bool:
        """Return True if the robot is known to be at the place where the state has it."""
        post = self._view.post
        if post is None or self._believes_words:
            return True
        return not self._goal.is_active and self._at.is_known_at(post, now)

    def _check_post(self, now: float) -> None:
        """Report that the robot is not known to be where the state has it, or that it is there again."""
        post = self._view.post
        if post is None or self._is_acting or (self._believes_words and not self._view.displaced):
            self._doubt = None
            return
        if self._is_known(now):
            self._doubt, self._was_sent_away = None, False
            if (self._view.displaced or self._reports(DISPLACED)) and not self._reports(BACK):
                self.trouble = ""
                self._log("info", f"{self.name} is at {post.poi}")
                self._report = RepeatedReport(self._word(BACK), self.reaction)
            return
        self._at.on_departure()  # it may pass its place again without standing there
        self._doubt = now if self._doubt is None else self._doubt
        is_elsewhere = self._at.position is not None and not self._at.is_near(post)
        if not is_elsewhere and now < self._doubt + self._grace:
            return
        self.trouble = self._at.describe(post)
        if self._was_sent_away and self._at.position is None:
            self.trouble = f"was sent away from {marked(post.poi)} by another node"
        if not self._view.displaced and not self._reports(DISPLACED):
            self._log("warn", f"{self.name} {in_words(self.trouble)}, where the state has it")
            self._report = RepeatedReport(self._word(DISPLACED, self.trouble), self.reaction)

    @property
    def _is_acting(self) -> bool:
        """Return True while the robot does an action: it may move, as that demands."""
        return is_action(self._view.location) and not self._actions

    @property
    def _believes_words(self) -> bool:
        """Return True if the words on pursue/events show where the robot is, and nothing else speaks against them."""
        return self.settings.believes_words and not self._was_sent_away

    @property
    def _grace(self) -> float:
        return GRACE if self.settings.sources else 0.0

    def _arrives_at(self, trip: Trip) -> float:
        """Return when the robot has arrived by its position, if it does not move until then."""
        if not self.settings.ends_by_position or trip.has_arrived or self._goal.is_active:
            return float("inf")  # move_base may still turn the robot, by less than amcl publishes
        if trip.arrives_at is None or not self._at.is_near(trip.arrives_at):
            return float("inf")
        return max(self._at.stands_at(), trip.since + self.settings.end_settle)

    # Goals ------------------------------------------------------------------------------------------------------------

    def _enter(self, view: View, now: float) -> None:
        """Begin with another location: whatever belonged to the one before is over."""
        # Also one that was begun by hand, or before this node: its end counts, and it goes on where doors open.
        self._trip = Trip(view.way, now, halts=view.way.halts) if view.way else None
        self._actions = [order for order in self._actions if order.at_once and view.is_there(order)]
        self._given = [(order, sent) for order, sent in self._given if order.at_once and view.is_there(order)]
        self._report = self._aboard = self._doubt = None
        self._was_sent_away = False
        self._as_of = view.seq
        self.trouble = ""
        self._goal.drop()
        if view.way:
            self._at.on_departure()

    def _may_go(self, trip: Trip) -> bool:
        """Return True if the robot may get a goal for this trip."""
        may_go = self._view.running or (self._may_begin and not trip.is_sent)
        wanted = self._view.returning if trip.is_return else may_go
        return wanted and not (self._view.held or trip.waits or trip.has_arrived)

    @property
    def _may_begin(self) -> bool:
        """Return True if the robot may begin what was decided. While the mission holds nobody sets out but one that was
        commanded just before: the others take it that it has begun, unless it is in trouble."""
        return self._view.running or (self._saw_begin and not (self._view.lost or self._view.displaced))

    def _goal_due_at(self, trip: Trip) -> float:
        """Return when the goal is due: a robot that is being moved is sent back when it stands."""
        moment = trip.goal_at if trip.goal_at is not None else float("inf")
        is_carried = trip.is_return and self._at.position is not None and not trip.replaced
        return max(moment, self._at.stands_at()) if is_carried else moment

    def _due_goal(self, trip: Trip, now: float, real: float) -> Optional[Goal]:
        if not self._may_go(trip):
            return None
        if self._goal.is_lost:
            self._log("warn", f"{self.name} does not have its goal {trip.movement.place.poi}: it is sent again")
            return self._goal.send_again(now, real)
        if now < self._goal_due_at(trip):
            return None
        trip.goal_at = None
        movement = trip.movement
        if trip.halts:
            doors = " and ".join(sorted(trip.halts[0].doors))
            self._log("info", f"{self.name} waits for {doors} to open")
            if trip.goal is None or self.settings.ends == "words":  # who reports its ends itself would report this
                return None
            movement = movement._replace(place=trip.goal)
        trip.attempts, trip.is_sent = trip.attempts + 1, True
        number = f"{'door-' * len(trip.halts)}{trip.attempts}"
        goal = Goal(f"{self.name}-{movement.location}-{number}-{now:.6f}", movement)
        self._goal.send(goal, now, real)
        return goal

    def _may_act(self, order: Order, now: float) -> bool:
        """Return True if the action may be sent: it has been decided, also if the mission holds."""
        if not (self._view.is_there(order) and self._is_known(now)):
            return False
        return order.at_once or (self._may_begin and not self._view.held)

    def _may_pass(self, halt: Halt) -> bool:
        """Return True if its doors are open; out of a lift, when its position is one on the map of that floor."""
        at, way = self._at.position, self._view.way
        knows = halt.out is None or at is None or self._at.is_near(halt.out)
        if halt.aboard and at is not None and way is not None:
            knows = knows and not at.is_below_or_above(way.place)
        return knows and self.opened.all_for(self.name, halt.doors, self._as_of)

    def _on_success(self, trip: Trip) -> None:
        poi = trip.movement.place.poi
        if self.settings.ends_by_position:
            if trip.arrives_at is None or not self._at.is_near(trip.arrives_at):
                self._log("warn", f"{self.name}: goal reached, but the position is not at {poi} yet")
        elif trip.is_return or self.settings.ends == "words":
            self._at.on_arrival(poi)
        else:
            self._arrive(trip)

    def _arrive(self, trip: Trip) -> None:
        """Report the end of the movement until the state shows it; no further goal is due. In the cabin of a lift, say
        so to the lift."""
        if trip.halts:
            trip.is_aboard, self.trouble = True, ""
            self._aboard = RepeatedReport(Word(self.name, IS_ABOARD, as_of=self._as_of), self.reaction)
            return
        poi = trip.movement.place.poi
        self._at.on_arrival(poi)
        trip.has_arrived, trip.goal_at, trip.cancelled, self.trouble = True, None, None, ""
        word = Word("", f"{self.name}_{trip.movement.location}2{poi}", as_of=self._as_of)
        self._report = RepeatedReport(word, self.reaction)

    def _on_failure(self, trip: Trip, answer: Answer, now: float) -> None:
        meaning = meaning_of(answer)
        what, own_text = trip.describe(meaning.says), f" (move_base: {answer.text})" if answer.text else ""
        elsewhere = meaning.event != FAILED and (trip.attempts >= self.settings.retries or not meaning.again)
        spare = trip.movement.spare if elsewhere and not trip.halts else None
        if (meaning.again or spare) and trip.attempts <= self.settings.retries:
            self.trouble = f"{what}; it tries {'another spot there' if spare else 'again'}"
            self._log("warn", f"{self.name} {in_words(self.trouble)}{own_text}")
            trip.goal_at = now + self.settings.retry_delay
            if spare:
                trip.movement = trip.movement._replace(place=spare, spare=None)
        else:
            self.trouble = what + (f", in {trip.attempts} attempts" if trip.attempts > 1 else "")
            self._log("err", f"{self.name} {in_words(self.trouble)}{own_text}")
            word = self._word(FAILED if trip.is_return else meaning.event, self.trouble)
            self._report = RepeatedReport(word, self.reaction)

    def _on_cancelled(self, trip: Trip, answer: Answer, now: float) -> None:
        """Wait for the status that shows whether a goal of another node has taken the place of ours."""
        self.trouble = trip.describe(f"{CANCELLED[answer.status]} by another node", answer.text)
        trip.cancel(answer, now)

    def _on_replaced(self, trip: Trip, answer: Answer, now: float) -> None:
        """Take the robot back, unless it was sent elsewhere too often: then it is held."""
        trip.replaced += 1
        if trip.replaced > self.settings.retries:
            self._hold(trip, answer)
            return
        self.trouble = f"{trip.describe('sent elsewhere by another node')}; its goal is sent again"
        self._log("warn", f"{self.name} {in_words(self.trouble)}")
        trip.cancelled, trip.goal_at = None, now

    def _hold(self, trip: Trip, answer: Answer) -> None:
        """Wait for a person: the goal was cancelled, or another node insists on goals of its own."""
        often = f" {trip.replaced} times" if trip.replaced > 1 else ""
        self.trouble = trip.describe(f"{CANCELLED[answer.status]} by another node{often}", answer.text)
        self._log("warn", f"{self.name} {in_words(self.trouble)}; it is held until {self.name}:{RESUME} is published")
        trip.cancelled, trip.is_held = None, True
        self._report = RepeatedReport(self._word(HELD, self.trouble), self.reaction)

    # Reports ----------------------------------------------------------------------------------------------------------

    def _word(self, event: str, text: str = "") -> RobotReport:
        return RobotReport(self.name, event, text, self._as_of)

    def _reports(self, event: str) -> bool:
        """Return True if the present report is of this kind."""
        return self._report is not None and self._report.word.startswith(f"{self.name}:{event}")
