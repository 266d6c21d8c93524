"""Drives the robots of a mission along all ways, without the mission, has them do their actions if that is wanted, and
records how long all that takes: for `pursue-gen calibrate`. One robot after the other; the others stand. What two of
them do together comes last: both are brought to its place.

Parameters: ~robots (names; all by default), ~times (how often each way, 5), ~actions (how often each action
of robots, 0), ~start (where the first robot begins; by
default each where the scenario has it), ~limit (seconds that a drive may take, 300), ~pause (seconds between two of
them, 1), and how robots are connected, as for controllers: ~goals (action), ~ends (result), ~on_stop (cancel), and the
others. Arguments: --file (a path; by default pursue/<scenario>/drives.bag under ROS_HOME; no file is ever overwritten,
the name gets a number), --config (another folder of data).
"""

from __future__ import annotations

import contextlib
import json
import os
import threading
import time
from functools import partial
from typing import Any, Callable, Dict, List, Mapping, Optional, Tuple

import rosbag
import rosgraph
import rospy
from std_msgs.msg import String

from pursue_runtime.arguments import BAG, CONFIG
from pursue_runtime.controller.goal import Answer
from pursue_runtime.controller.settings import Settings, read_settings
from pursue_runtime.controller.whereabouts import MapFrames, Place, Position, place_of
from pursue_runtime.data import DataError, Package
from pursue_runtime.drives.report import DRIVES, Drive, format_drive
from pursue_runtime.drives.robots import Driven, driven_robots, duration, next_action, who_is_near
from pursue_runtime.drives.session import Due, Session
from pursue_runtime.event_words import EVENTS, STATE
from pursue_runtime.folders import scenario_folder
from pursue_runtime.missions import own_source
from pursue_runtime.nodes.alarm import Alarm, Later
from pursue_runtime.nodes.node import REFUSED, Ending, run_node, subscribe
from pursue_runtime.nodes.recorder import CHUNK, stamp
from pursue_runtime.nodes.robot_link import RobotLink
from pursue_runtime.orders import Order
from pursue_runtime.ui.recording import ACTIVE, GAME, keep_file, reserve_file

DEFAULTS: Mapping[str, Any] = {"goals": "action", "ends": "result", "on_stop": "cancel"}
"""Those of real robots, as `mission.launch simulate:=false` has them."""

LOOKS = 0.2
"""Seconds of real time between two looks at tf."""

PATIENCE = 5.0
"""Seconds of real time for which a robot has to be connected, so that it can be called back, before it is sent."""

LAST_WORDS = 0.5
"""Seconds for which a robot that is called back stays connected: rospy sends messages in a thread of its own."""


class DriveLegs:
    """The node on ROS: one lock, the topics of one robot at a time, a bag."""

    def __init__(self, package: Package, told: Mapping[str, str]) -> None:
        self.ending = Ending()
        self._given = {**DEFAULTS, **rospy.get_param("~", {})}
        source = own_source(package, "model.yaml", told["config"])
        robots = driven_robots(source.read, self._given, _package_folder)
        self._duration = duration(robots)
        # Everybody goes to its own place first: who stands anywhere else may be on the goal of another one.
        self._robots = robots
        self._waiting = [*(robot.to(robot.start) for robot in robots if robot.plan.ways)]
        self._waiting += [robot for robot in robots if robot.plan.ways or robot.plan.acts]
        self._standing: Dict[str, Place] = {}  # where those are that do not drive now
        check_no_mission()
        folder = scenario_folder(os.environ, package.scenario)
        self.path = reserve_file(told["file"] or os.path.join(folder, "drives.bag"), folder)
        self._lock = threading.RLock()
        self._bag: Optional[rosbag.Bag] = rosbag.Bag(self.path + ACTIVE, "w", chunk_threshold=CHUNK)
        with contextlib.suppress(DataError):
            self._bag.write(rospy.resolve_name(GAME), String(json.dumps(source.read("game.yaml"))), stamp())
        self._drives = rospy.Publisher(DRIVES, String, queue_size=100, latch=True)
        self._log = Later("log", self.ending).log
        self._alarm = Alarm(self._act, self.ending)
        self._robot: Optional[Tuple[Driven, Settings, Session, RobotLink]] = None
        self._partner: Optional[RobotLink] = None  # of the robot that takes part in what is done
        self._done: List[Session] = []
        self._has_driven = self._is_over = False  # all ways; everything
        self._acts = 0  # so many actions were ordered
        self._next_look = self._patient_until = 0.0  # on the monotonic clock
        self._count = 0  # drives in the bag
        subscribe(EVENTS, String, self._on_word, self.ending, queue_size=100)
        subscribe(STATE, rospy.AnyMsg, self._on_mission, self.ending)
        rospy.on_shutdown(self._stop)

    def run(self) -> int:
        """Runs until all robots are done; the exit status is 0 where all is measured so often as was wanted."""
        rospy.loginfo("recording %s; %s", self.path, self._duration)
        try:
            self._next_robot()
            status = self.ending.wait(linger=0.5)
        finally:
            self._stop()
            with self._lock:
                if self._bag is not None:
                    self._bag.close()
                    self._bag = None
                    self._keep()
        return status or (0 if self._is_complete else 1)

    @property
    def _is_complete(self) -> bool:
        acts = all(robot.acts.is_complete for robot in self._robots)
        return acts and not self._waiting and all(session.is_complete for session in self._done)

    def _keep(self) -> None:
        """Gives the bag its name, and logs what is in it; a bag without drives is removed."""
        if not self._count:
            os.remove(self.path + ACTIVE)
            rospy.logwarn("nothing was measured")
            return
        wanted, self.path = self.path, keep_file(self.path)
        if self.path != wanted:
            rospy.logwarn("%s has come meanwhile, and stays as it is", wanted)
        drives = (text for session in self._done for text in session.summary())
        actions = (text for robot in self._robots for text in robot.acts.summary())
        for text in (*drives, *actions):
            rospy.loginfo("%s", text)
        told = {session.robot for session in self._done if session.problem}  # of which all else is a consequence
        for robot in self._robots if self._is_over else ():
            if robot.acts.why_not_all() and robot.name not in told:
                rospy.logwarn("%s: %s", robot.name, robot.acts.why_not_all())
        text = "%d drives and actions are in %s: pursue-gen calibrate SCENARIO.pur %s"
        rospy.loginfo(text, self._count, self.path, self.path)

    # One robot after the other ----------------------------------------------------------------------------------------

    def _next_robot(self) -> None:
        with self._lock:
            if not self._waiting:
                self._waiting, self._has_driven = next_action(self._robots, self._standing), True
            self._is_over = not self._waiting
            if self._is_over:
                self.ending.end(0 if self._is_complete else 1)
                return
            robot = self._waiting.pop(0)
            settings = read_settings(robot.name, self._given)
            places = {poi: place_of(poi, pose) for poi, pose in robot.poses.items()}
            at = self._standing.pop(robot.name, None)
            is_there = at is not None and at.poi == robot.start
            near = partial(who_is_near, standing=self._standing)
            what = robot.plan, settings, self._log, robot.acts, is_there, near
            session = Session(robot.name, places, robot.start, *what)
            take = self._on_result, self._on_statuses, self._on_position, lambda: None
            link = RobotLink(robot.name, settings, self.ending, self._log, *take)
            link.frames = MapFrames(settings.map_frame, robot.levels)
            self._robot = robot, settings, session, link
            if robot.plan.partner:
                its = read_settings(robot.plan.partner, self._given)
                ignored = _ignore, _ignore, _ignore, lambda: None
                self._partner = RobotLink(robot.plan.partner, its, self.ending, self._log, *ignored)
            self._patient_until = time.monotonic() + PATIENCE
            self._log("info", f"{robot.name} {robot.plan.words(robot.start)}")
        link.watch()
        self._alarm.set(None, 0.0)

    def _act(self) -> None:
        """Looks where the robot is, and does what is due."""
        with self._lock:
            if self._robot is None:
                return
            _, _, session, link = self._robot
            why = self._deaf() if self._patient_until else ""
            if (why or not link.can_cancel) and time.monotonic() < self._patient_until:
                self._alarm.set(None, 0.1)
                return
            self._patient_until = 0.0  # it was connected once: what comes later is as in a mission
        if why:
            rospy.logfatal("%s", why)
            self.ending.end(REFUSED)
            return
        if time.monotonic() >= self._next_look:
            self._next_look = time.monotonic() + LOOKS
            position = link.look()
            if position is not None or link.has_lost_position:
                self._on_position(position)
        with self._lock:
            self._carry_out(session.due(rospy.get_time(), time.monotonic()))
            patience = LOOKS if link.looks else 1.0
            is_over = session.is_over
            if is_over:
                self._finish()
            else:
                self._alarm.set(session.next_moment(), patience)
        if is_over:
            self._next_robot()

    def _deaf(self) -> str:
        """Why the robot that is to be driven, or its partner, cannot be told what to do, and what helps; "": it can."""
        assert self._robot is not None, "a robot is driven"
        robot, _, _, link = self._robot
        other, partner = self._partner, robot.plan.partner
        drives, acts = bool(robot.plan.ways) or bool(robot.plan.only_goes), bool(robot.plan.acts)
        whys = [(robot.name, link.missing_subscriber(is_goal=True) if drives else "")]
        whys += [(robot.name, link.missing_subscriber(is_goal=False))] if acts else []
        whys += [(partner, other.missing_subscriber(is_goal=False))] if other is not None else []
        helps = "start its nodes; if their namespace is not its name, say so: rosparam load robots.yaml drive_legs"
        return next((f"{name} {why}: {helps}, with {name}: {{namespace: NAME}} in it" for name, why in whys if why), "")

    def _finish(self) -> None:
        assert self._robot is not None, "a robot is driven"
        robot, _, session, link = self._robot
        self._robot = None
        self._done.append(session)
        if session.place:
            self._standing[robot.name] = place_of(session.place, robot.poses[session.place])
        elif robot.plan.only_goes and self._has_driven and self._waiting:
            doer = self._waiting[-1]  # it does not come: nothing can be done now
            doer.acts.failed(doer.plan.acts[0])
            self._waiting = []
        if session.problem:
            self._log("warn", f"{robot.name}: {session.problem}")
        link.close()
        if self._partner is not None:
            self._partner.close()
        self._partner = None

    def _carry_out(self, due: Due) -> None:
        assert self._robot is not None, "a robot is driven"
        robot, settings, session, link = self._robot
        link.keep(session.location, True, session.goal)
        if due.cancel and settings.on_stop == "cancel":
            link.cancel(due.cancel)
        if due.goal is not None:
            link.go(due.goal, robot.poses[due.goal.movement.place.poi])
        if due.act is not None:
            self._acts += 1
            order = Order(robot.name, due.act.event, self._acts, session.location, given=rospy.get_time())
            link.do(order)
            if self._partner is not None:
                self._partner.do(order._replace(agent=due.act.partner))
        if due.drive is not None:
            self._publish(due.drive)

    def _publish(self, drive: Drive) -> None:
        message = String(format_drive(drive))
        if self._bag is not None:
            self._bag.write(rospy.resolve_name(DRIVES), message, stamp())
            self._bag.flush()  # drives are few, and take long to be made again
            self._count += 1
        with contextlib.suppress(rospy.ROSException):  # the node is going down
            self._drives.publish(message)

    # From the robot ---------------------------------------------------------------------------------------------------

    def _on_result(self, answer: Answer) -> None:
        self._take(lambda session: session.navigation.on_result(answer, rospy.get_time()))

    def _on_statuses(self, answers: List[Answer]) -> None:
        self._take(lambda session: session.navigation.on_status(answers, rospy.get_time(), time.monotonic()))

    def _on_position(self, position: Optional[Position]) -> None:
        self._take(lambda session: session.navigation.on_position(position, rospy.get_time()), is_due=False)

    def _on_word(self, message: String) -> None:
        self._take(lambda session: session.on_word(message.data))

    def _take(self, take: Callable[[Session], None], is_due: bool = True) -> None:
        """Passes something to the session; looks what `is_due` then."""
        with self._lock:
            if self._robot is not None:
                take(self._robot[2])
        if is_due:
            self._alarm.set(None, 0.0)

    def _on_mission(self, _: rospy.AnyMsg) -> None:
        rospy.logerr("a mission has been started: the drives end here")
        self.ending.end(1)

    def _stop(self) -> None:
        """The node ends: what is under way is called back, and what was measured stays."""
        with self._lock:
            if self._robot is not None:
                due = self._robot[2].stop(rospy.get_time())
                self._carry_out(due)
                time.sleep(LAST_WORDS if due.cancel else 0.0)
                self._finish()


def _ignore(_: Any) -> None:
    """What a partner's navigation says does not matter: it stands."""


def check_no_mission() -> None:
    """Raises DataError while an observer runs: its controllers command the same robots."""
    topic = rospy.resolve_name(STATE)
    publishers: Dict[str, List[str]] = dict(rosgraph.Master(rospy.get_name()).getSystemState()[0])
    if publishers.get(topic):
        nodes = ", ".join(publishers[topic])
        raise DataError(
            f"{nodes} runs, and its mission commands the same robots: end its launch first"
            " (if it was killed, the master forgets it with: rosnode cleanup)"
        )


def _package_folder(package: str) -> Optional[str]:
    """The folder of a package on this machine; None where it is not here."""
    import rospkg

    try:
        return str(rospkg.RosPack().get_path(package))
    except rospkg.ResourceNotFound:
        return None


def main(package: Package) -> int:
    """Runs the node of this package until it ends; returns its exit status."""
    return run_node("drive_legs", [CONFIG, BAG], lambda told: DriveLegs(package, told).run(), OSError)
