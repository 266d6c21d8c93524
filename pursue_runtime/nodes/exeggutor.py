"""A controller's executor (the thesis's exeggutor): orders robots, and reports their ends to the observer."""

from __future__ import annotations

import contextlib
import threading
import time
from functools import partial
from types import MappingProxyType
from typing import Callable, Dict, List, Mapping, Optional, Sequence

import rospy
from std_msgs.msg import String

from pursue_runtime.controller.goal import Answer, Halt, Movement
from pursue_runtime.controller.navigation import Navigation
from pursue_runtime.controller.settings import Settings, read_settings
from pursue_runtime.controller.view import View
from pursue_runtime.controller.whereabouts import NO_LEVELS, Levels, MapFrames, Place, Position, place_of
from pursue_runtime.doors.lifts import ABOARD
from pursue_runtime.doors.opened import DOORS, NONE_OPENED, read_opened
from pursue_runtime.event_words import EVENTS, ORDERED, Word, format_word
from pursue_runtime.locations import is_end, is_movement, is_under_way, movement
from pursue_runtime.locations import place_of as poi_of
from pursue_runtime.nodes.alarm import Alarm, Later
from pursue_runtime.nodes.node import Ending, subscribe
from pursue_runtime.nodes.publishing import Newcomers, ServedFirst, listeners
from pursue_runtime.nodes.robot_link import RobotLink
from pursue_runtime.orders import Order, parse_orders
from pursue_runtime.poses import Doorway, Doorways, Table
from pursue_runtime.sentences import in_words
from pursue_runtime.state import ENDED, LIVE, RUNNING, WON, SystemState
from pursue_runtime.strategy import Command

LOOKS = 0.2
"""Seconds of real time between two looks at tf."""


class Exeggutor:
    """Sends the words to the observer, and goals and actions to each robot on topics of its own."""

    def __init__(self, ending: Ending) -> None:
        self._lock = threading.RLock()
        self._places: Dict[str, Dict[str, Place]] = {}
        self._ways: Dict[str, Dict[str, Movement]] = {}
        self._status, self._reaction = RUNNING, 0.0
        self._events = rospy.Publisher(EVENTS, String, queue_size=100, tcp_nodelay=True)
        self._observer = ""
        self._precedence = ServedFirst(self._events, lambda node: node == self._observer)
        self.on_observer: Callable[[], None] = lambda: None
        """Called when an observer has connected, once the reports of robots were published again."""
        Newcomers(self._events, lambda node: node == self._observer, self._say_again)
        self._robots: Dict[str, Navigation] = {}
        self._unreachable: Dict[str, str] = {}  # robots that cannot get an order, and why; "": they can
        self._links: Dict[str, RobotLink] = {}
        self._ending = ending
        self._log_lines = Later("log", ending)
        self._log = self._log_lines.log
        self._next_look = 0.0  # on the monotonic clock
        self._alarm = Alarm(self._on_alarm, ending)
        self._doors: Optional[rospy.Subscriber] = None  # where some way leads through a door
        self._aboard: Optional[rospy.Publisher] = None  # where some way goes by lift
        rospy.on_shutdown(self._call_back)

    def take_up(
        self,
        poses: Mapping[str, Table],
        reaction: float,
        spare: Mapping[str, Table],
        doors: Mapping[str, Doorways] = MappingProxyType({}),
        levels: Levels = NO_LEVELS,
    ) -> None:
        """Take these robots, each with its poses of the places, `spare` ones, and its ways through `doors`; orders
        given before are over. `levels`: those with maps of their own.
        `reaction`: the time units that the strategy allows a command. Raises DataError, with no robots, where the
        settings of one are wrong."""
        with self._lock:
            self._reaction = reaction
            self._call_back()
            for link in self._links.values():
                link.keep("", False, "")
            positions = {name: robot.position for name, robot in self._robots.items()}
            self._robots, self._status = {}, RUNNING
            self._places = {robot: {poi: place_of(poi, pose) for poi, pose in poses[robot].items()} for robot in poses}
            if any(doors.values()) and self._doors is None:
                self._doors = subscribe(DOORS, String, self._on_doors, self._ending, queue_size=10, tcp_nodelay=True)
            if self._aboard is None and any(len(some) > 1 for ways in doors.values() for some in ways.values()):
                self._aboard = rospy.Publisher(ABOARD, String, queue_size=10, tcp_nodelay=True)
            given = rospy.get_param("~", {})
            settings = {robot: read_settings(robot, given) for robot in poses}
            frames = {robot: MapFrames(each.map_frame, levels) for robot, each in settings.items()}
            self._ways = {
                robot: _ways(places, spare.get(robot, {}), doors.get(robot, {}), settings[robot])
                for robot, places in self._places.items()
            }
            for robot in set(self._links) - set(settings):
                self._links.pop(robot).close()
            for robot in settings:
                if robot not in self._links:
                    callbacks = self._result, self._statuses, self._place, self._connected
                    inputs = (partial(take, robot) for take in callbacks)
                    self._links[robot] = RobotLink(robot, settings[robot], self._ending, self._log, *inputs)
                self._links[robot].frames = frames[robot]
                self._robots[robot] = Navigation(robot, settings[robot], self._log)
                position = positions.get(robot)
                if position is not None:  # amcl does not publish it again while the robot stands
                    self._robots[robot].on_position(position, rospy.get_time())

    # For the controller -----------------------------------------------------------------------------------------------

    def announce(self, word: str) -> None:
        """Publish a command or a report on pursue/events."""
        with contextlib.suppress(rospy.ROSException):  # the node is going down
            self._events.publish(word)

    def serve_first(self, observer: str) -> None:
        """Have words go to this node before all others that are subscribed to them."""
        self._observer = observer
        self._precedence.arrange()

    def observers(self) -> List[str]:
        """The nodes that are subscribed to what is published here."""
        return listeners(self._events)

    def _say_again(self) -> None:
        """Publish reports that no state has shown once more: an observer has connected."""
        with self._lock:
            for robot in self._robots.values():
                robot.say_again()
            self._act()
        self.on_observer()

    def follow(self, state: SystemState, orders: Sequence[Order] = ()) -> None:
        """Handle a state: drop orders that are over, and reports that the state shows; give the new `orders`."""
        with self._lock:
            before, self._status = self._status, state.status
            for name, robot in self._robots.items():
                if state.status in ENDED and before not in ENDED:
                    self._call_back_one(name)
                view = self._view(name, state)
                robot.reaction = self._reaction * state.unit
                if state.status not in LIVE:
                    robot.opened = NONE_OPENED  # the numbers of states begin anew with the next mission
                robot.on_state(view, rospy.get_time())
                self._links[name].keep(view.location, robot.is_open, robot.goal)
            for order in orders:
                self._exeggute(order)
                self._act()
            if not orders:
                self._act()

    def _view(self, name: str, state: SystemState) -> View:
        """What the state says about this robot."""
        here = state.locations.get(name, "") if state.status in LIVE else ""
        lost, held, displaced = (name in names for names in (state.lost, state.held, state.displaced))
        way, post = self._ways[name].get(here), self._places[name].get(poi_of(here, self._places[name]))
        running, returning = state.status == RUNNING, name in state.returning
        unanswered = {o.seq for o in parse_orders(state.orders) if o.agent == name and not o.acknowledged}
        return View(here, way, post, running, lost, held, displaced, returning, state.seq, frozenset(unanswered))

    def may_begin(self, command: Command) -> bool:
        """Return True if the robot of this command can get the order that follows from it, and is known to be where
        the state has it if it begins an action (or the state says that it is not)."""
        with self._lock:
            robot, link = self._robots.get(command.agent), self._links.get(command.agent)
            if robot is None or link is None or is_end(command.origin, command.target):
                return True
            moves = is_movement(command.target) and command.target != command.origin
            self._unreachable[command.agent] = link.missing_subscriber(moves)
            if self._unreachable[command.agent]:
                return False
            return moves or is_under_way(command.origin) or robot.is_placed(rospy.get_time())

    def troubles(self) -> Dict[str, str]:
        """Return what an operator should know about robots, by their names, as parts of sentences."""
        with self._lock:
            found = {name: robot.trouble or self._unreachable.get(name, "") for name, robot in self._robots.items()}
            return {name: trouble for name, trouble in found.items() if trouble}

    def _exeggute(self, order: Order) -> None:
        """Give the order to its robot."""
        robot = self._robots.get(order.agent)
        if robot is None:
            return  # an objective has no robot
        if order.at_once or not is_movement(order.location):
            robot.act(order)
            return
        way = self._ways[order.agent].get(order.location)
        if way is None:
            rospy.logerr("%s should be %s, but poses.yaml does not know these places", order.agent, order.location)
            return
        robot.start(way, rospy.get_time())

    def _connected(self, name: str) -> None:
        """A robot has connected to its actions: what it has not acknowledged is sent at once."""
        self._log_lines.do(partial(self._tell, name, Navigation.give_again))  # rospy holds a lock here

    # From the robots --------------------------------------------------------------------------------------------------

    def _result(self, name: str, answer: Answer) -> None:
        self._tell(name, lambda robot: robot.on_result(answer, rospy.get_time()))

    def _statuses(self, name: str, answers: List[Answer]) -> None:
        self._tell(name, lambda robot: robot.on_status(answers, rospy.get_time(), time.monotonic()))

    def _place(self, name: str, position: Optional[Position]) -> None:
        self._tell(name, lambda robot: robot.on_position(position, rospy.get_time()))

    def _tell(self, name: str, news: Callable[[Navigation], None]) -> None:
        """Pass something on to a robot's navigation, if that robot is taken, and do what is due then."""
        with self._lock:
            robot = self._robots.get(name)
            if robot is not None:
                news(robot)
                self._act()

    def _on_doors(self, message: String) -> None:
        """Take for whom doors are open."""
        opened = read_opened(message.data)
        if opened is None:
            rospy.logwarn_throttle(10.0, f"not what is said of doors: {message.data[:80]!r}")
            return
        with self._lock:
            for robot in self._robots.values():
                robot.opened = opened
            self._act()

    # What is due ------------------------------------------------------------------------------------------------------

    def _act(self) -> None:
        """Does what is due, and sleeps until more is."""
        now, real = rospy.get_time(), time.monotonic()
        moments, patience = [], []
        for name, robot in self._robots.items():
            goal, actions, word, aboard = robot.due(now, real)
            if goal is not None:
                self._links[name].go(goal, goal.movement.place.pose)
            for order in actions:
                if self._links[name].do(order):
                    self.announce(format_word(Word(name, ORDERED, order.seq, at=order.given or None)))
            if word is not None:
                self.announce(word)
                self._log("info", f"reports {in_words(word)}")
            if aboard is not None and self._aboard is not None:
                self._aboard.publish(aboard)
            moment, repeat = robot.next_moments()
            moments += [] if moment is None else [moment]
            patience += [] if repeat is None else [repeat - real]
            if not self._links[name].watched:
                patience.append(0.0)  # topics are changed by the alarm's thread: that may have to wait for the master
            elif self._links[name].looks:  # a fixed moment: messages that come more often must not put it off
                patience.append(self._next_look - real)
        self._alarm.set(min(moments, default=None), max(0.0, min(patience)) if patience else None)

    def _on_alarm(self) -> None:
        """Look where robots are, and do what is due."""
        with self._lock:
            links = {name: self._links[name] for name in self._robots}
            self._next_look = time.monotonic() + LOOKS
        for name, link in links.items():
            link.watch()
            position = link.look()
            if position is not None or link.has_lost_position:
                self._place(name, position)
        with self._lock:
            self._act()

    # The end ----------------------------------------------------------------------------------------------------------

    def _call_back(self) -> None:
        """The node ends: what is under way is called back, if that is wanted, unless all is well."""
        with self._lock:
            for name in self._robots:
                self._call_back_one(name)

    def _call_back_one(self, name: str) -> None:
        robot = self._robots[name]
        if robot.goal and robot.settings.on_stop == "cancel" and self._status != WON:
            self._links[name].cancel(robot.goal)


def _ways(places: Mapping[str, Place], spare: Table, doorways: Doorways, settings: Settings) -> Dict[str, Movement]:
    """A robot's movement for each location in which it is under way. One that reports its ends itself rides in a lift
    by itself, too."""
    by_itself = settings.ends == "words"
    others = {poi: place_of(poi, pose) for poi, pose in spare.items()}
    ways = {movement(x, y): Movement(movement(x, y), places[y], others.get(y)) for x in places for y in places}
    for location in doorways.keys() & ways.keys():
        halts = tuple(_halt(each) for each in doorways[location] if not (each.aboard and by_itself))
        ways[location] = ways[location]._replace(halts=halts)
    return ways


def _halt(doorway: Doorway) -> Halt:
    name = " and ".join(sorted(doorway.doors))
    place, out = (None if pose is None else place_of(name, pose) for pose in (doorway.wait, doorway.out))
    return Halt(doorway.doors, place, doorway.aboard, out)
