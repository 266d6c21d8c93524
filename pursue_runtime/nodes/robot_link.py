"""The topics between a controller and one robot: goals and actions to it; results and positions from it."""

from __future__ import annotations

import contextlib
import importlib
import threading
from typing import Any, Callable, Dict, List, NamedTuple, Optional, Sequence, Tuple

import rospy
from geometry_msgs.msg import Pose, PoseStamped, PoseWithCovarianceStamped
from std_msgs.msg import String

from pursue_runtime.controller.answers import outcome_name
from pursue_runtime.controller.goal import ABORTED, Answer, Goal
from pursue_runtime.controller.settings import Settings
from pursue_runtime.controller.whereabouts import LEVEL, NO_LEVELS, STOREY, MapFrames, Position, yaw_of
from pursue_runtime.data import DataError
from pursue_runtime.nodes.node import Ending, subscribe
from pursue_runtime.nodes.publishing import ServedFirst, is_recorder, listeners, publish_to_one
from pursue_runtime.orders import Order, order_text
from pursue_runtime.sentences import Log

STALE = 1.0
"""Seconds of ROS time after which a transform that was not renewed does not say any more where the robot is."""

_NOT_DEBIANS = ("mbf_msgs",)
"""ROS packages that Debian does not have."""

_KNOWN = 20
"""So many goals have a known outcome; a status lists those of the last five seconds."""

PublishToOne = Callable[[Any], None]
"""Publishes to one subscriber alone."""


class Message(NamedTuple):
    """What a robot is sent: it stands as long as the state shows it at `location` ("": it does not)."""

    location: str
    publisher: rospy.Publisher
    message: Any

    def publish(self, peer_publish: Optional[PublishToOne] = None) -> None:
        """Publish it to all subscribers, or to the one of `peer_publish`; do nothing when the node is going down."""
        with contextlib.suppress(rospy.ROSException):
            if peer_publish is None:
                self.publisher.publish(self.message)
            else:
                publish_to_one(self.publisher, peer_publish, self.message)


def needed(package: str, module: str, why: str) -> Any:
    """A module of a ROS package that is needed by some settings only. Raises DataError where it is not installed."""
    try:
        return importlib.import_module(module)
    except ImportError as problem:
        name = package.replace("_", "-")
        debian = "" if package in _NOT_DEBIANS else f", or python3-{name} on Debian"
        raise DataError(
            f"{why} needs the ROS package {package}, which is not here ({problem}): install ros-noetic-{name}{debian}"
        ) from problem


def _messages_for(settings: Settings) -> Any:
    """The messages of the robot's navigation; None where it gets simple goals, and its results do not count."""
    if settings.navigation == "move_base_flex":
        return needed("mbf_msgs", "mbf_msgs.msg", "navigation: move_base_flex")
    why = "goals:=action" if settings.goals == "action" else "ends:=result"
    return needed("move_base_msgs", "move_base_msgs.msg", why) if settings.uses_results else None


def _tf_for(settings: Settings) -> Any:
    """tf, where positions come from it; None where it is missing, and they come from a pose as well."""
    if "tf" not in settings.sources:
        return None
    with contextlib.suppress(*([DataError] if "pose" in settings.sources else [])):  # one of them is enough
        return needed("tf2_ros", "tf2_ros", "a position by tf")


class RobotLink(rospy.SubscribeListener):
    """One robot's topics. `result` gets each result, `statuses` the goals in each status, `place` each position.

    A robot that connects later gets then the order that still stands: a controller that was started again learns from
    the first state what its robot should be doing, some milliseconds before the robot is connected.
    """

    def __init__(
        self,
        robot: str,
        settings: Settings,
        ending: Ending,
        log: Log,
        result: Callable[[Answer], None],
        statuses: Callable[[List[Answer]], None],
        place: Callable[[Position], None],
        connected: Callable[[], None],
    ) -> None:
        """`log` gets what is worth a line once it is sent; it does not wait. `connected` is called, in any thread, when
        a node has subscribed to the actions."""
        super().__init__()
        self.watched = not settings.sources
        self._robot, self._settings, self._ending, self._log = robot, settings, ending, log
        self._on_result, self._on_statuses, self._place, self._on_connected = result, statuses, place, connected
        self.frames = MapFrames(settings.map_frame.replace(LEVEL, ""), NO_LEVELS)
        self._done: Optional[Order] = None  # the last order that was published without its number
        self._logged: Optional[Order] = None  # the last order that the log has
        self._lock = threading.Lock()
        self._standing: Dict[str, Message] = {}
        self._open = True
        self._late: List[Tuple[str, Optional[PublishToOne]]] = []
        self._positions: List[Any] = []
        self._cancel: Any = None
        self._results: Any = None
        self._status: Any = None
        self._frames: Any = None
        self._seen_by_tf = False  # then amcl_pose, which is published now and then, does not count
        self._stamp, self._renewed = 0.0, 0.0  # of the newest transform, and when it came
        self.has_lost_position = False
        self._outcomes: Dict[str, str] = {}  # of the last goals of a move_base_flex
        self._messages, self._tf = _messages_for(settings), _tf_for(settings)
        self._act = rospy.Publisher(settings.topic("pursue/actions"), String, self, queue_size=10)
        if settings.goals == "action":
            topic, kind = f"{settings.action}/goal", self._messages.MoveBaseActionGoal
        else:
            topic, kind = settings.topic("move_base_simple/goal"), PoseStamped
        self._move = rospy.Publisher(topic, kind, self, queue_size=10)
        for orders in (self._act, self._move):
            ServedFirst(orders, lambda _: True)
        if settings.on_stop == "cancel":
            self._ids = needed("actionlib_msgs", "actionlib_msgs.msg", "on_stop:=cancel").GoalID
            self._cancel = rospy.Publisher(f"{settings.action}/cancel", self._ids, queue_size=10)
        if settings.uses_results:
            kind = self._messages.MoveBaseActionResult
            topic = f"{settings.action}/result"
            self._results = subscribe(topic, kind, self._result, ending, queue_size=100, tcp_nodelay=True)
        if not settings.simulated:
            with contextlib.suppress(DataError):  # without these messages the robot has no such status either
                kind = needed("actionlib_msgs", "actionlib_msgs.msg", "move_base/status").GoalStatusArray
                topic = f"{settings.action}/status"
                self._status = subscribe(topic, kind, self._statuses, ending, queue_size=10, tcp_nodelay=True)

    # To the robot -----------------------------------------------------------------------------------------------------

    def go(self, goal: Goal, pose: Sequence[float]) -> None:
        """Sends the goal: a pose [x, y, z, qx, qy, qz, qw] on the map."""
        stamped = PoseStamped(pose=Pose())
        stamped.header.frame_id = self.frames.of(pose[2])
        stamped.header.stamp = rospy.Time.now()
        position, orientation = stamped.pose.position, stamped.pose.orientation
        position.x, position.y, position.z = pose[:3]
        orientation.x, orientation.y, orientation.z, orientation.w = pose[3:] if any(pose[3:]) else (0.0, 0.0, 0.0, 1.0)
        message: Any = stamped
        if self._settings.goals == "action":
            message = self._messages.MoveBaseActionGoal(header=stamped.header)
            message.goal_id.id = goal.name  # its stamp is left to the robot, whose clock orders the goals that it gets
            message.goal.target_pose = stamped
        self._send(Message(goal.movement.location, self._move, message))
        self._log("info", f"{self._robot} goes to {goal.movement.place.poi} ({position.x:.2f}, {position.y:.2f})")

    def do(self, order: Order) -> bool:
        """Send an action, with the number of the order, by which the robot's side knows one that comes again.

        Return True if it takes the place of an acknowledgement that it was sent: where `orders` is not numbered, each
        action is sent once, by its name alone, and nobody acknowledges it.
        """
        is_plain, order = self._settings.orders != "numbered", order._replace(acknowledged=False)
        if is_plain and self._done == order:
            return True
        if is_plain and self.missing_subscriber(is_goal=False):
            return False
        text = order.event if is_plain else order_text(order)
        self._send(Message("" if order.at_once or is_plain else order.location, self._act, String(text)))
        if self._logged != order:
            self._log("info", f"{self._robot} does {order.event}")
        self._logged, self._done = order, order if is_plain else self._done
        return is_plain

    def missing_subscriber(self, is_goal: bool) -> str:
        """Return why the robot cannot get a goal, or an action; "" if a node beside recorders is subscribed to them, or
        a person does what it is ordered."""
        topic = self._move if is_goal else self._act
        if self._settings.orders == "person" or any(not is_recorder(node) for node in listeners(topic)):
            return ""
        return f"cannot get an order: no node is subscribed to {topic.resolved_name}"

    def _send(self, order: Message) -> None:
        topic = order.publisher.resolved_name
        with self._lock:
            if order.location:
                self._standing[topic] = order
                if not self._open:
                    self._late.append((topic, None))
                    return
            order.publish()
            if order.publisher.get_num_connections() == 0:
                self._log("warn", f"no subscriber on {topic} yet")

    def keep(self, location: str, is_open: bool, after: str) -> None:
        """Drops the orders that are over: only what fits the location, and a goal that the robot is `after`, may still
        be sent, and only while the mission `is_open` for orders."""
        with self._lock:
            goal = self._standing.get(self._move.resolved_name)
            for topic, order in list(self._standing.items()):
                if order.location != location or (order is goal and not after):
                    del self._standing[topic]
            self._open = is_open
            late, self._late = (self._late, []) if is_open else ([], self._late)
            due = [(self._standing[topic], peer_publish) for topic, peer_publish in late if topic in self._standing]
        for order, peer_publish in due:
            order.publish(peer_publish)

    def peer_subscribe(self, topic_name: str, topic_publish: PublishToOne, peer_publish: PublishToOne) -> None:
        """A robot has connected (rospy calls this)."""
        with self._lock:
            order = self._standing.get(topic_name) if self._open else None
            if not self._open:
                self._late.append((topic_name, peer_publish))
        if order:
            order.publish(peer_publish)
        if topic_name == self._act.resolved_name:
            self._on_connected()

    def cancel(self, goal: str) -> None:
        """Calls the robot back from where it goes; a simple goal has no id of ours: from wherever it goes."""
        rospy.logwarn("%s is called back", self._robot)
        self._cancel.publish(self._ids(id=goal if self._settings.goals == "action" else ""))

    @property
    def can_cancel(self) -> bool:
        """Return False while nobody is connected who would call the robot back, where that is wanted."""
        return self._cancel is None or self._cancel.get_num_connections() > 0

    def close(self) -> None:
        """The robot is no more for us to command."""
        for topic in (self._act, self._move, self._cancel, self._results, self._status, *self._positions):
            if topic is not None:
                topic.unregister()

    # From the robot ---------------------------------------------------------------------------------------------------

    def _result(self, message: Any) -> None:
        answer = _answer(message.status)
        if self._settings.navigation == "move_base_flex":
            answer = answer._replace(outcome=outcome_name(message.result.outcome))
            self._outcomes = {**dict(list(self._outcomes.items())[-_KNOWN:]), answer.goal: answer.outcome}
        self._on_result(answer)

    def _statuses(self, message: Any) -> None:
        """Of a move_base_flex, a goal that was aborted counts from its result on, which has the outcome."""
        answers = [_answer(status) for status in message.status_list]
        if self._settings.navigation == "move_base_flex":
            known = [each for each in answers if each.status != ABORTED or each.goal in self._outcomes]
            answers = [each._replace(outcome=self._outcomes.get(each.goal, "")) for each in known]
        self._on_statuses(answers)

    def watch(self) -> None:
        """Read the robot's position from now on. What is received first is recent: amcl_pose is latched."""
        if self.watched:
            return
        self.watched = True
        if self._tf is not None:
            self._frames = self._tf.Buffer(debug=False)
            self._positions.append(self._tf.TransformListener(self._frames))
        if "pose" in self._settings.sources:
            topic, kind = self._settings.topic("amcl_pose"), PoseWithCovarianceStamped
            self._positions.append(subscribe(topic, kind, self._pose, self._ending, queue_size=10, tcp_nodelay=True))

    @property
    def looks(self) -> bool:
        """Return True if `look` is to be called now and then."""
        return self._frames is not None

    def _pose(self, message: PoseWithCovarianceStamped) -> None:
        frame, known = message.header.frame_id, self.frames.elevations
        if frame.lstrip("/") not in known:
            wanted = " or ".join(map(repr, known))
            what = f"{self._settings.topic('amcl_pose')} is in frame {frame!r}; expected {wanted} (~map_frame)"
            rospy.logwarn_throttle(10.0, what)
        elif not self._seen_by_tf:
            pose = message.pose.pose
            at = position_of(pose.position, pose.orientation)
            self._place(at._replace(height=self.frames.elevation(frame)))

    def look(self) -> Optional[Position]:
        """Return where tf has the robot now; None where it does not know: `has_lost_position` if it did before."""
        if self._frames is None:
            return None
        found, why = None, ""
        for frame, height in self.frames.elevations.items():
            frames = frame, self._settings.base_frame
            try:
                found = self._frames.lookup_transform(*frames, rospy.Time(0))
            except self._tf.TransformException as problem:
                why = str(problem)
                continue
            if height is None or abs(found.transform.translation.z) <= STOREY:
                break
            found, why = None, "it is on no level"  # the frames of levels are joined, and it is far above this one
        if found is None:
            if self._settings.sources == ("tf",):
                rospy.logwarn_throttle(10.0, f"tf does not know where {self._robot} is: {why}")
            return None
        self._seen_by_tf = True
        self.has_lost_position = self._is_stale(found.header.stamp.to_sec())
        if self.has_lost_position:
            what = f"tf does not know where {self._robot} is: {frames[0]} to {frames[1]} is not published any more"
            rospy.logwarn_throttle(10.0, what)
            return None
        at = position_of(found.transform.translation, found.transform.rotation)
        return at._replace(height=height)

    def _is_stale(self, stamp: float) -> bool:
        """Return True if the transform with this stamp (0: a static one) was not renewed for some time."""
        now = rospy.get_time()
        if stamp != self._stamp or now < self._renewed:
            self._stamp, self._renewed = stamp, now
        return stamp > 0.0 and now > self._renewed + STALE


def _answer(status: Any) -> Answer:
    """What a GoalStatus says."""
    return Answer(status.goal_id.id, status.goal_id.stamp.to_sec(), status.status, status.text)


def position_of(at: Any, orientation: Any) -> Position:
    """The position that a message of geometry_msgs has, from its point and its quaternion."""
    return Position(at.x, at.y, yaw_of(orientation.x, orientation.y, orientation.z, orientation.w))
