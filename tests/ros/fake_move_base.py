#!/usr/bin/env python3
"""Robots as move_base and amcl show them: goals of both kinds, results, positions; and all that may go wrong.

Parameter ~robots; of each of them: start ([x, y]), travel (seconds to any goal), acts (seconds that an action takes),
plays (what becomes of its first goal, of its second …; the last one of all that follow): succeed, abort (at once),
reject (at once), never, twice (the result comes twice), stale (a result of long ago comes first).
It says what it hears: `bot1 goal 1.00 2.00`, `bot1 cancel`, `bot1 action e`.
"""

from __future__ import annotations

import math
import os
import threading
from typing import Any, Dict, List, Optional, Tuple

import rospy
import tf2_ros
from actionlib_msgs.msg import GoalID, GoalStatus
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped, TransformStamped
from move_base_msgs.msg import MoveBaseActionGoal, MoveBaseActionResult
from std_msgs.msg import String

STEP = 0.05
"""Seconds between two positions of a robot that moves."""

SECOND_OPINION = 0.15
"""Metres that a robot moves before amcl tells its pose again."""


class FakeRobot:
    """One robot; its positions go to amcl_pose (latched, only while it moves) and to tf (always)."""

    def __init__(self, name: str, settings: Dict[str, Any]) -> None:
        self.name = name
        self.lock = threading.RLock()
        self.x, self.y = settings.get("start", [0.0, 0.0])
        self.travel = float(settings.get("travel", 1.0))
        self.acts = float(settings.get("acts", 1.0))
        self.plays: List[str] = list(settings.get("plays", ["succeed"]))
        self.goal: Optional[GoalID] = None
        self.way: Optional[Tuple[float, float, float, float, float]] = None
        self.count = 0
        self.told: Tuple[float, float] = (math.inf, math.inf)
        self.frames = tf2_ros.TransformBroadcaster()
        self.words = rospy.Publisher("pursue/events", String, queue_size=10)
        self.results = rospy.Publisher(f"{name}/move_base/result", MoveBaseActionResult, queue_size=10)
        self.poses = rospy.Publisher(f"{name}/amcl_pose", PoseWithCovarianceStamped, queue_size=10, latch=True)
        self.show()
        rospy.Subscriber(f"{name}/move_base_simple/goal", PoseStamped, self.on_simple)
        rospy.Subscriber(f"{name}/move_base/goal", MoveBaseActionGoal, self.on_goal)
        rospy.Subscriber(f"{name}/move_base/cancel", GoalID, self.on_cancel)
        rospy.Subscriber(f"{name}/pursue/actions", String, self.on_action)
        rospy.Timer(rospy.Duration(STEP), self.move)

    def say(self, what: str) -> None:
        os.write(1, f"{self.name} {what}\n".encode())  # in one piece: there are several threads

    def on_simple(self, message: PoseStamped) -> None:
        goal = MoveBaseActionGoal(header=message.header)
        goal.goal.target_pose = message
        self.on_goal(goal)

    def on_goal(self, message: MoveBaseActionGoal) -> None:
        """As actionlib has it: who brings no id or stamp gets one; a new goal preempts the one before."""
        now = rospy.Time.now()
        place = message.goal.target_pose.pose.position
        goal = GoalID(message.goal_id.stamp or now, message.goal_id.id)
        with self.lock:
            self.count += 1
            goal.id = goal.id or f"{self.name}-{self.count}"
            self.say(f"goal {place.x:.2f} {place.y:.2f}")
            if self.goal is not None:
                self.result(GoalStatus.PREEMPTED)
            self.goal = goal
            play = self.plays[min(self.count, len(self.plays)) - 1]
            if play in ("abort", "reject"):
                self.result(GoalStatus.ABORTED if play == "abort" else GoalStatus.REJECTED)
                return
            if play == "stale":
                old = GoalID(now - rospy.Duration(60.0), "of_long_ago")
                self.publish(old, GoalStatus.SUCCEEDED)
            if play != "never":
                self.way = (now.to_sec(), self.x, self.y, place.x, place.y)

    def on_cancel(self, message: GoalID) -> None:
        with self.lock:
            self.say("cancel")
            if self.goal is not None and message.id in ("", self.goal.id):
                self.result(GoalStatus.PREEMPTED)

    def on_action(self, message: String) -> None:
        self.say(f"action {message.data}")
        done = String(f"{message.data}DONE")
        rospy.Timer(rospy.Duration(self.acts), lambda _: self.words.publish(done), oneshot=True)

    def move(self, _: object) -> None:
        with self.lock:
            if self.way is not None:
                since, x, y, goal_x, goal_y = self.way
                share = min(1.0, (rospy.get_time() - since) / self.travel)
                self.x, self.y = x + share * (goal_x - x), y + share * (goal_y - y)
                if share == 1.0:
                    self.result(GoalStatus.SUCCEEDED)
            self.show()

    def show(self) -> None:
        """Tells where it is, to tf and, if it has moved, to amcl's listeners."""
        frame = TransformStamped(child_frame_id=f"{self.name}/base_link")
        frame.header.stamp, frame.header.frame_id = rospy.Time.now(), "map"
        frame.transform.translation.x, frame.transform.translation.y = self.x, self.y
        frame.transform.rotation.w = 1.0
        self.frames.sendTransform(frame)
        if math.hypot(self.x - self.told[0], self.y - self.told[1]) > SECOND_OPINION:
            self.told = self.x, self.y
            pose = PoseWithCovarianceStamped(header=frame.header)
            pose.pose.pose.position.x, pose.pose.pose.position.y = self.x, self.y
            self.poses.publish(pose)

    def result(self, status: int) -> None:
        """The goal of now is over."""
        goal, self.goal, self.way = self.goal, None, None
        play = self.plays[min(self.count, len(self.plays)) - 1]
        for _ in range(2 if play == "twice" else 1):
            self.publish(goal, status)

    def publish(self, goal: Optional[GoalID], status: int) -> None:
        message = MoveBaseActionResult(status=GoalStatus(goal, status, ""))
        message.header.stamp = rospy.Time.now()
        self.results.publish(message)


if __name__ == "__main__":
    rospy.init_node("fake_move_base")
    robots = [FakeRobot(robot, settings) for robot, settings in rospy.get_param("~robots").items()]
    rospy.spin()
