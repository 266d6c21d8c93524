#!/usr/bin/env python3
"""Robots as move_base and amcl show them: goals of both kinds, status, feedback, results, positions; and their faults.

Parameter ~robots; of each of them: namespace (of its topics and frames; its name where it is not given), start ([x, y]
or [x, y, yaw]), travel (seconds to any goal), acts (seconds that an action takes; negative: the robot does not report
its end), named (that report names the robot), boot (seconds from the start of move_base until its action server is up),
reboot (the same after a restart; boot where it is not given), recovery (seconds until a robot that is stuck gives up,
and answers other goals and cancellations), status (seconds between two status messages), plays (what becomes of its
first goal, of its second …; the last one of all that follow): succeed, abort (at once), reject (at once), never, stuck
(it finds no plan, and gives up after the recovery), oscillating (gives up then, with that text), twice (the result
comes twice), stale (a result of long ago comes first), turned (it arrives, but looks the wrong way).

Orders of a test on <robot>/test: `put X Y YAW` (a person carries it there), `map FRAME` (its map changes), `restart
SECONDS` (move_base is killed and started again after so long), `play NAME` (what becomes of the goals from now on),
`travel SECONDS`, `tf on`, `tf off` (its position is published on tf, or not any more).

Standard output has what each robot receives: `bot1 goal 1.00 2.00`, `bot1 lost 1.00 2.00` (a simple goal that came
before the action server was up), `bot1 cancel`, `bot1 action e 1.00 2.00` (with its position then); and `bot1 stands
1.00 2.00` on arrival, `bot1 up` when the action server is up.
"""

from __future__ import annotations

import contextlib
import math
import os
import threading
from typing import Any, Dict, List, Optional, Set, Tuple

import rospy
import tf2_ros
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray
from geometry_msgs.msg import Pose, PoseStamped, PoseWithCovarianceStamped, TransformStamped
from move_base_msgs.msg import MoveBaseActionFeedback, MoveBaseActionGoal, MoveBaseActionResult
from std_msgs.msg import String

try:
    from nav_msgs.msg import Path
except ImportError:
    Path = None

STEP = 0.05
"""Seconds between two positions of a robot that moves, and between two feedback messages."""

STATUS_PERIOD, STATUS_TIMEOUT = 0.2, 5.0
"""Seconds between two status messages, and for which a goal that is over stays in them."""

AMCL_DISTANCE, AMCL_ANGLE = 0.2, math.pi / 6
"""Metres and radians that a robot moves or turns before amcl publishes its pose again, by default."""

ACCEPTED = "This goal has been accepted by the simple action server"
TEXTS = {
    "succeed": (GoalStatus.SUCCEEDED, "Goal reached."),
    "stuck": (GoalStatus.ABORTED, "Failed to find a valid plan. Even after executing recovery behaviors."),
    "oscillating": (GoalStatus.ABORTED, "Robot is oscillating. Even after executing recovery behaviors."),
    "abort": (GoalStatus.ABORTED, "Failed to find a valid control. Even after executing recovery behaviors."),
    "reject": (GoalStatus.REJECTED, "This goal was rejected."),
    "cancel": (GoalStatus.PREEMPTED, ""),
    "replace": (
        GoalStatus.PREEMPTED,
        "This goal was canceled because another goal was received by the simple action server",
    ),
}
"""What move_base says of its goals."""


class Body:
    """The robot itself: where it is, and on which way; its pose goes to amcl_pose (when it has moved) and tf."""

    def __init__(self, name: str, start: List[float]) -> None:
        self.name = name
        self.at: Tuple[float, float, float] = (start[0], start[1], start[2] if len(start) > 2 else 0.0)
        self.way: Optional[Tuple[float, float, Tuple[float, float, float], Tuple[float, float, float]]] = None
        self.has_tf, self.frame = True, "map"
        self._shown = (math.inf, math.inf, 0.0)
        self._frames = tf2_ros.TransformBroadcaster()
        self._poses = rospy.Publisher(f"{name}/amcl_pose", PoseWithCovarianceStamped, queue_size=10, latch=True)

    def go(self, target: Tuple[float, float, float], travel: float) -> None:
        """Set out."""
        self.way = (rospy.get_time(), travel, self.at, target)

    def change_map(self, frame: str) -> None:
        """Its map is another one, with this frame."""
        self.frame, self._shown = frame, (math.inf, math.inf, 0.0)

    def put(self, at: Tuple[float, float, float]) -> None:
        """Be carried there; a robot on its way goes on from there."""
        self.at = at
        if self.way is not None:
            _, travel, _, target = self.way
            self.go(target, travel)

    def move(self) -> bool:
        """Move on; return True on arrival."""
        if self.way is None:
            return False
        since, travel, start, target = self.way
        share = min(1.0, (rospy.get_time() - since) / travel) if travel > 0.0 else 1.0
        self.at = tuple(a + share * (b - a) for a, b in zip(start, target))  # type: ignore[assignment]
        self.way = None if share == 1.0 else self.way
        return share == 1.0

    def show(self) -> None:
        """Publish where it is."""
        frame = TransformStamped(child_frame_id=f"{self.name}/base_link")
        frame.header.stamp, frame.header.frame_id = rospy.Time.now(), self.frame
        pose = self.pose()
        frame.transform.translation.x, frame.transform.translation.y = self.at[:2]
        frame.transform.rotation = pose.orientation
        if self.has_tf:
            self._frames.sendTransform(frame)
        x, y, yaw = self._shown
        moved = math.hypot(self.at[0] - x, self.at[1] - y)
        if moved > AMCL_DISTANCE or abs(math.remainder(self.at[2] - yaw, math.tau)) > AMCL_ANGLE:
            self._shown = self.at
            message = PoseWithCovarianceStamped(header=frame.header)
            message.pose.pose = pose
            self._poses.publish(message)

    def pose(self) -> Pose:
        """Return its pose."""
        pose = Pose()
        pose.position.x, pose.position.y = self.at[:2]
        pose.orientation.z, pose.orientation.w = math.sin(self.at[2] / 2), math.cos(self.at[2] / 2)
        return pose


class FakeMoveBase:
    """A move_base, with its simple action server, and the robot that it drives."""

    def __init__(self, name: str, settings: Dict[str, Any], body: Optional[Body] = None) -> None:
        self.name = name
        self.lock = threading.RLock()
        self.namespace = settings.get("namespace", name)
        self.body = body or Body(self.namespace, settings.get("start", [0.0, 0.0]))
        self.body.frame = str(settings.get("frame", "map"))
        self.travel, self.acts = float(settings.get("travel", 1.0)), float(settings.get("acts", 1.0))
        self.named = bool(settings.get("named", False))
        boot, self.recovery = float(settings.get("boot", 0.0)), float(settings.get("recovery", 2.0))
        self.reboot = float(settings.get("reboot", boot))
        self.plays: List[str] = list(settings.get("plays", ["succeed"]))
        self.count = 0
        self.begun: Set[str] = set()  # the numbers of the orders that it has
        self.process: List[Any] = []  # the topics of move_base, which end with it
        self.server = False
        self.goals: List[Tuple[GoalStatus, float]] = []  # and when each is over, inf before that
        self.current: Optional[GoalStatus] = None
        self.pending: Optional[Tuple[GoalStatus, Pose]] = None  # a goal that came while the robot recovers
        self.gives_up = math.inf
        self.words = rospy.Publisher("pursue/events", String, queue_size=10)
        self.body.show()
        rospy.Subscriber(f"{self.namespace}/pursue/actions", String, self.on_action)
        rospy.Subscriber(f"{name}/test", String, self.on_order)
        self.start(boot)
        rospy.Timer(rospy.Duration(STEP), self.step)
        rospy.Timer(rospy.Duration(settings.get("status", STATUS_PERIOD)), lambda _: self.show_status())

    def say(self, what: str) -> None:
        os.write(1, f"{self.name} {what}\n".encode())  # in one piece: there are several threads

    # Its life: the topic of simple goals first, the action server much later ------------------------------------------

    def start(self, boot: float) -> None:
        """The process starts: simple goals are received and published again as action goals, which nobody takes for so
        many seconds."""
        with self.lock:
            topic = f"{self.namespace}/move_base"
            self.republish = rospy.Publisher(f"{topic}/goal", MoveBaseActionGoal, queue_size=1)
            simple = rospy.Subscriber(f"{topic}_simple/goal", PoseStamped, self.on_simple, queue_size=1)
            self.process = [self.republish, simple]
        if boot > 0.0:
            rospy.Timer(rospy.Duration(boot), lambda _: self.start_server(), oneshot=True)
        else:
            self.start_server()

    def start_server(self) -> None:
        """The action server starts."""
        with self.lock:
            topic = f"{self.namespace}/move_base"
            self.results = rospy.Publisher(f"{topic}/result", MoveBaseActionResult, queue_size=50)
            self.feedback = rospy.Publisher(f"{topic}/feedback", MoveBaseActionFeedback, queue_size=50)
            self.plans = rospy.Publisher(f"{topic}/NavfnROS/plan", Path, queue_size=1) if Path is not None else None
            self.statuses = rospy.Publisher(f"{topic}/status", GoalStatusArray, queue_size=50, latch=True)
            goals = rospy.Subscriber(f"{topic}/goal", MoveBaseActionGoal, self.on_goal, queue_size=50)
            cancel = rospy.Subscriber(f"{topic}/cancel", GoalID, self.on_cancel, queue_size=50)
            plans = [] if self.plans is None else [self.plans]
            self.process += [self.results, self.feedback, self.statuses, goals, cancel, *plans]
            self.server = True
        self.show_status()
        self.say("up")

    def kill(self, down: float) -> None:
        """The process is killed, and started again after so many seconds. The robot stands still."""
        with self.lock:
            self.server, self.goals, self.current, self.pending = False, [], None, None
            self.body.way, self.gives_up = None, math.inf
            topics, self.process = self.process, []
        for topic in topics:
            topic.unregister()
        rospy.Timer(rospy.Duration(down), lambda _: self.start(self.reboot), oneshot=True)

    # Goals ------------------------------------------------------------------------------------------------------------

    def on_simple(self, message: PoseStamped) -> None:
        place = message.pose.position
        if not self.server:
            self.say(f"lost {place.x:.2f} {place.y:.2f}")
        goal = MoveBaseActionGoal()
        goal.header.stamp, goal.goal.target_pose = rospy.Time.now(), message
        self.republish.publish(goal)

    def on_goal(self, message: MoveBaseActionGoal) -> None:
        """Who brings no id or stamp gets one; an id that is known is ignored; a new goal preempts the one before."""
        now, target = rospy.Time.now(), message.goal.target_pose.pose
        with self.lock:
            if not self.server or any(message.goal_id.id == status.goal_id.id for status, _ in self.goals):
                return
            self.count += 1
            known = GoalID(message.goal_id.stamp or now, message.goal_id.id or f"/{self.name}-{self.count}-{now}")
            frame = message.goal.target_pose.header.frame_id
            where = "" if frame == "map" else f" in {frame}"
            self.say(f"goal {target.position.x:.2f} {target.position.y:.2f}{where}")
            goal = GoalStatus(known, GoalStatus.PENDING, "")
            self.goals.append((goal, math.inf))
            if self.gives_up < math.inf:  # a recovery behaviour is not interrupted
                self.drop_pending()
                self.pending = (goal, target)
            else:
                if self.current is not None:
                    self.finish("replace")
                self.begin(goal, target)
            self.show_status()

    def drop_pending(self) -> None:
        """A goal that was not begun is recalled."""
        if self.pending is not None:
            (status, _), self.pending = self.pending, None
            self.conclude(status, GoalStatus.RECALLED, TEXTS["replace"][1])

    def begin(self, goal: GoalStatus, target: Pose) -> None:
        """Do what the test has planned for this goal."""
        self.current, goal.status, goal.text = goal, GoalStatus.ACTIVE, ACCEPTED
        play = self.plays[min(self.count, len(self.plays)) - 1]
        yaw = 2.0 * math.atan2(target.orientation.z, target.orientation.w) + (math.pi if play == "turned" else 0.0)
        if play in ("abort", "reject"):
            self.finish(play)
        elif play in ("stuck", "oscillating"):
            self.gives_up = rospy.get_time() + self.recovery
        elif play != "never":
            self.show_plan(target)
            self.body.go((target.position.x, target.position.y, yaw), self.travel)
        if play == "stale":
            old = GoalID(rospy.Time.now() - rospy.Duration(60.0), "of_long_ago")
            self.publish_result(GoalStatus(old, GoalStatus.SUCCEEDED, "Goal reached."))

    def show_plan(self, target: Pose) -> None:
        """Publish the path that is planned."""
        if self.plans is not None:
            message = Path(poses=[PoseStamped(pose=self.body.pose()), PoseStamped(pose=target)])
            message.header.frame_id = "map"
            self.plans.publish(message)

    def on_cancel(self, message: GoalID) -> None:
        with self.lock:
            self.say("cancel")
            current = self.current
            everything = not message.id and not message.stamp
            if current is not None and (everything or message.id == current.goal_id.id):
                current.status = GoalStatus.PREEMPTING
                if self.gives_up == math.inf:  # else it is answered when the recovery behaviour is over
                    self.finish("cancel")
            self.show_status()

    def finish(self, how: str) -> None:
        """The present goal is over."""
        status, self.current, self.body.way, self.gives_up = self.current, None, None, math.inf
        assert status is not None
        self.conclude(status, *TEXTS[how])

    def conclude(self, status: GoalStatus, number: int, text: str) -> None:
        """This goal is over."""
        status.status, status.text = number, text
        self.goals = [(known, rospy.get_time() if known is status else over) for known, over in self.goals]
        play = self.plays[min(self.count, len(self.plays)) - 1]
        for _ in range(2 if play == "twice" else 1):
            self.publish_result(status)
        self.show_status()

    def publish_result(self, status: GoalStatus) -> None:
        message = MoveBaseActionResult(status=status)
        message.header.stamp = rospy.Time.now()
        self.results.publish(message)

    def show_status(self) -> None:
        """Publish the goals of now, and those that are over since a short while."""
        with self.lock:
            if not self.server:
                return
            self.goals = [(status, over) for status, over in self.goals if rospy.get_time() < over + STATUS_TIMEOUT]
            message = GoalStatusArray(status_list=[status for status, _ in self.goals])
            message.header.stamp = rospy.Time.now()
            self.statuses.publish(message)

    # The world --------------------------------------------------------------------------------------------------------

    def step(self, _: object) -> None:
        with self.lock, contextlib.suppress(rospy.ROSException):  # the node is going down
            arrived = self.body.move()
            if arrived:
                self.say(f"stands {self.body.at[0]:.2f} {self.body.at[1]:.2f}")
            if self.current is not None and arrived:
                self.finish("succeed")
            elif self.current is not None and rospy.get_time() >= self.gives_up:
                self.recovered(self.current)
            elif self.current is not None:
                message = MoveBaseActionFeedback(status=self.current)
                message.header.stamp = rospy.Time.now()
                message.feedback.base_position.header.frame_id = "map"
                message.feedback.base_position.pose = self.body.pose()
                self.feedback.publish(message)
            self.body.show()

    def recovered(self, current: GoalStatus) -> None:
        """The recovery behaviours are over: now move_base sees what has come meanwhile."""
        if self.pending is not None:
            (goal, target), self.pending = self.pending, None
            self.finish("replace")
            self.begin(goal, target)
        else:
            play = self.plays[min(self.count, len(self.plays)) - 1]
            self.finish("cancel" if current.status == GoalStatus.PREEMPTING else play)

    def on_action(self, message: String) -> None:
        x, y, _ = self.body.at
        event, _, number = message.data.partition("@")
        if number:
            self.words.publish(String(f"{self.name}:_order_@{number}"))
        if number in self.begun:
            return  # the order was sent again
        self.begun |= {number} if number else set()
        self.say(f"action {event} {x:.2f} {y:.2f}")
        done = String(f"{self.name}:{event}DONE" if self.named else f"{event}DONE")
        if self.acts >= 0.0:
            rospy.Timer(rospy.Duration(self.acts), lambda _: self.words.publish(done), oneshot=True)

    def on_order(self, message: String) -> None:
        what, *rest = message.data.split()
        self.say(f"test {message.data}")
        with self.lock:
            if what == "put":
                x, y, yaw = map(float, rest)
                self.body.put((x, y, yaw))
            elif what == "map":
                self.body.change_map(rest[0])
            elif what == "play":
                self.plays = rest
            elif what == "tf":
                self.body.has_tf = rest == ["on"]
            elif what == "travel":
                self.travel = float(rest[0])
        if what == "restart":
            self.kill(float(rest[0]))


if __name__ == "__main__":
    rospy.init_node("fake_move_base")
    robots = [FakeMoveBase(robot, settings) for robot, settings in rospy.get_param("~robots").items()]
    rospy.spin()
