"""The fake robots of `benchmarks.from_map` on ROS: they answer as move_base does, and drive on a map.

Parameters: ~map (its yaml file), ~radius (metres), ~seed, ~robots: of each the pose at which it starts (`start`), and
`nature` (benchmarks.robots_on_map).
"""

from __future__ import annotations

from pathlib import Path
from random import Random
from typing import Any, Dict, List, Tuple

import rospy
from std_msgs.msg import String

from benchmarks.robots_on_map import Floor, Moment, Nature, Pose, drive, pose_after, varied
from pursue_gen.drawing.ground import read_ground
from tests.ros.fake_move_base import Body, FakeMoveBase


class BodyOnMap(Body):
    """A robot that drives as it is, around walls."""

    def __init__(self, name: str, start: List[float], floor: Floor, robot: Nature, random: Random) -> None:
        super().__init__(name, start)
        self._shown_at = -1.0
        self._floor, self._robot, self._random = floor, robot, random
        self._since, self._moments = 0.0, [Moment(0.0, self.at)]

    def go(self, target: Tuple[float, float, float], travel: float) -> None:
        """Set out; how long it takes follows from the way."""
        self._since = rospy.get_time()
        self._moments = drive(self._floor, self.at, target, self._robot, self._random)
        self.way = (self._since, self._moments[-1].after, self.at, target)

    def show(self) -> None:
        """Publish where it is, once for each time of a simulated clock."""
        now = rospy.get_time()
        if now != self._shown_at:
            self._shown_at = now
            super().show()

    def move(self) -> bool:
        """Move on; return True on arrival."""
        if self.way is None:
            return False
        seconds = rospy.get_time() - self._since
        self.at: Pose = pose_after(seconds, self._moments)
        arrived: bool = seconds >= self._moments[-1].after
        self.way = None if arrived else self.way
        return arrived


class RobotOnMap(FakeMoveBase):
    """A robot with its move_base; its actions take as long as they take."""

    def __init__(self, name: str, settings: Dict[str, Any], floor: Floor, seed: str) -> None:
        self._robot, self._random = Nature(**settings["nature"]), Random(f"{seed} {name}")
        super().__init__(name, settings, BodyOnMap(name, settings["start"], floor, self._robot, self._random))

    def on_action(self, message: String) -> None:
        event, _, _ = message.data.partition("@")  # the number of the order
        self.acts = varied(self._robot.acts[event], self._random)
        super().on_action(message)


if __name__ == "__main__":
    rospy.init_node("fake_move_base")
    ground = Floor(read_ground(Path(rospy.get_param("~map")), whole=True), rospy.get_param("~radius"))
    described = rospy.get_param("~robots").items()
    robots = [RobotOnMap(name, settings, ground, str(rospy.get_param("~seed"))) for name, settings in described]
    rospy.spin()
