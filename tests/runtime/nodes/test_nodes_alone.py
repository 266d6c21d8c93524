"""What the smaller nodes do with what they receive, without a master."""

from __future__ import annotations

import io
import socket
import threading
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Dict, List, Tuple

import pytest

pytest.importorskip("rospy", reason="ROS is not installed")

import rosbag
import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped
from std_msgs.msg import String

from pursue_runtime.controller.goal import Goal, Movement
from pursue_runtime.controller.settings import Settings
from pursue_runtime.controller.whereabouts import MapFrames, Position, place_of
from pursue_runtime.nodes import mission_test, positions, recorder, robot_link
from pursue_runtime.nodes.communication_manager import CommunicationManager
from pursue_runtime.nodes.drive_legs import DriveLegs
from pursue_runtime.nodes.markers import MarkersNode
from pursue_runtime.nodes.node import OK, WARN, master_is_gone
from pursue_runtime.nodes.pursue_reader import Node as ReaderNode
from pursue_runtime.nodes.recorder import Bag, Recorder
from pursue_runtime.nodes.robot_link import RobotLink
from pursue_runtime.nodes.simulator import SimulatorNode
from pursue_runtime.nodes.state_message import message_of
from pursue_runtime.nodes.ui_page import UIPage
from pursue_runtime.nodes.witness import Witnesses
from pursue_runtime.sentences import Troubles, trouble_values
from pursue_runtime.state import SystemState
from pursue_runtime.ui.markers import BALL, DISC, TEXT
from pursue_runtime.ui.page import BAD

STATE = SystemState(7, 100.0, {"bot": "a"}, {"Pbot": 1}, {"Cbot": 1.0}, status="running")


# The simulator --------------------------------------------------------------------------------------------------------


@pytest.fixture
def simulator(monkeypatch: pytest.MonkeyPatch) -> Any:
    """A simulator that notes what it publishes and when it wakes."""
    made: Any = SimulatorNode.__new__(SimulatorNode)
    made.lock, made.done, made.reported = threading.RLock(), [], 0
    made.events = SimpleNamespace(publish=made.done.append)
    made.alarm = SimpleNamespace(set=lambda *given: made.done.append(given))
    made.simulator = SimpleNamespace(
        on_order=lambda *given: made.done.append(given), due=lambda *_: [], next_moments=lambda: (105.0, 53.0)
    )
    monkeypatch.setattr(rospy, "get_time", lambda: 100.0)
    monkeypatch.setattr("pursue_runtime.nodes.simulator.time.monotonic", lambda: 50.0)
    return made


def test_an_action_is_acknowledged_with_its_number_each_time_and_the_simulator_sleeps_until_there_is_more(
    simulator: Any,
) -> None:
    simulator.on_order(String("ring@7~99.500000"), "bot")
    assert simulator.done == [("bot", 100.0, "ring", 7), "bot:_order_@7~99.500000", (105.0, 3.0)]
    simulator.done.clear()
    simulator.on_order(String("ring"), "bot")
    assert simulator.done == [("bot", 100.0, "ring", 0), (105.0, 3.0)], "it has no number"


# The recorder ---------------------------------------------------------------------------------------------------------


def test_a_bag_keeps_who_has_published_what(tmp_path: Path) -> None:
    bag = Bag(str(tmp_path / "m.bag"))
    header = {"type": "std_msgs/String", "md5sum": String._md5sum, "message_definition": String._full_text}
    for second, node in enumerate(("one", "two", "one"), 1):
        message = rospy.AnyMsg()
        message._buff = b"\x02\x00\x00\x00hi"
        bag.note("/words", message, {**header, "callerid": node}, rospy.Time(second))
    bag.close()
    with rosbag.Bag(str(tmp_path / "m.bag")) as made:
        connections = [each.header["callerid"] for each in made._get_connections()]
        read = [(message.data, at.secs) for _, message, at in made.read_messages()]
    assert sorted(connections) == [b"one", b"two"] and read == [("hi", 1), ("hi", 2), ("hi", 3)]


def test_the_last_states_of_a_mission_before_this_one_are_not_recorded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(recorder, "stamp", lambda: rospy.Time(1))
    made: Any = Recorder.__new__(Recorder)
    made.lock, made.open, made.status, made.count, made.done = threading.Lock(), True, "", 0, []
    made.states, made.texts = "/pursue/state", "/pursue/system_state"
    made.membership = SimpleNamespace(takes=lambda state: state.seq == 7)
    made.bag = SimpleNamespace(note=lambda topic, *_: made.done.append(topic))
    made.ending = SimpleNamespace(end=lambda status: made.done.append(status))

    def receive(topic: str, state: SystemState) -> None:
        message: Any = rospy.AnyMsg()
        buffer = io.BytesIO()
        message_of(state).serialize(buffer)
        message._buff, message._connection_header = buffer.getvalue(), {}
        made.on_message(message, topic)

    receive("/pursue/state", STATE._replace(seq=90))
    assert made.done == [] and made.status == ""
    receive("/pursue/events", STATE)
    receive("/pursue/state", STATE)
    assert made.done == ["/pursue/events", "/pursue/state"] and made.status == "running"
    receive("/pursue/state", STATE._replace(status="won"))
    assert made.done[2:] == ["/pursue/state", 0]


# What is connected, and who has seen a mission ------------------------------------------------------------------------


@pytest.mark.parametrize("orders, sockets, connected", [
    (1, ["open"], True), (1, [None, "open"], True), (1, [None], False), (1, [], False), (0, ["open"], False),
])  # fmt: skip
def test_a_reader_is_connected_both_ways_or_not_at_all(orders: int, sockets: List[Any], connected: bool) -> None:
    made: Any = CommunicationManager.__new__(CommunicationManager)
    made.orders = SimpleNamespace(get_num_connections=lambda: orders)
    made.statuses = SimpleNamespace(impl=SimpleNamespace(connections=[SimpleNamespace(socket=s) for s in sockets]))
    assert made.reader_connected() is connected


def test_an_answer_of_a_witness_is_kept_and_passed_on_once_somebody_follows() -> None:
    made: Any = Witnesses.__new__(Witnesses)
    made.seen, made._on_state, passed = {}, None, []
    made._receive(STATE, "/bot")
    made.follow(lambda *given: passed.append(given))
    made._receive(STATE._replace(seq=8), "/bot")
    assert passed == [(STATE, "/bot"), (STATE._replace(seq=8), "/bot")] and made.seen["/bot"].seq == 8


# Pictures -------------------------------------------------------------------------------------------------------------


@pytest.fixture
def markers() -> Any:
    """The node that shows a mission in rviz."""
    kinds = {"CYLINDER": 3, "SPHERE": 2, "LINE_LIST": 5, "ARROW": 0, "TEXT_VIEW_FACING": 9, "DELETEALL": 3}
    made: Any = MarkersNode.__new__(MarkersNode)
    made.frame, made.lock, made.shown, made.state = "map", threading.Lock(), [], None

    class Marker(SimpleNamespace):
        """A marker of rviz."""

        def __init__(self, **given: Any) -> None:
            where = SimpleNamespace(position=SimpleNamespace(), orientation=SimpleNamespace())
            parts = {"header": SimpleNamespace(), "color": SimpleNamespace(), "pose": where, "scale": SimpleNamespace()}
            super().__init__(**parts, **given)

    for name, number in kinds.items():
        setattr(Marker, name, number)
    made.messages = SimpleNamespace(Marker=Marker)
    return made


@pytest.mark.parametrize("kind, scale", [(TEXT, (0.0, 0.4)), (DISC, (0.4, 0.01)), (BALL, (0.4, 0.4))])
def test_a_text_has_a_height_and_what_lies_on_the_floor_has_none(
    markers: Any, kind: str, scale: Tuple[float, float]
) -> None:
    mark: Any = SimpleNamespace(group="g", kind=kind, text="", colour=(1, 1, 1), points=[(1.0, 2.0)], size=0.4)
    marker = markers.marker(mark, 3)
    assert (marker.scale.x, marker.scale.z) == scale and (marker.id, marker.ns) == (3, "g")


def test_it_reports_why_it_shows_nothing(markers: Any) -> None:
    assert markers.report()[:3] == (False, WARN, "no state from the observer yet")
    markers.state = STATE
    assert markers.report()[:3] == (True, OK, "running")


def test_a_position_is_shown_when_it_has_changed(monkeypatch: pytest.MonkeyPatch) -> None:
    watch: Any = positions._Watch.__new__(positions._Watch)
    watch._settings = {"bot": Settings(simulated=False, ends="pose", namespace="bot")}
    watch._poses, watch._paths, watch._frames, watch._renewed = {}, {}, None, {}
    shown: List[Any] = []
    looks = iter([Position(1.0, 2.0, 0.0), Position(1.001, 2.0, 0.0), Position(3.0, 2.0, 0.0)])
    watch._ending = SimpleNamespace(called=False)

    def sleep(_: float) -> None:
        found = next(looks, None)
        watch._poses = {} if found is None else {"bot": found}
        watch._ending.called = found is None

    monkeypatch.setattr(positions.time, "sleep", sleep)
    watch.run(lambda places, _: shown.append(places))
    assert shown == [{"bot": (1.0, 2.0, 0.0)}, {"bot": (3.0, 2.0, 0.0)}]
    assert watch._transform("bot", watch._settings["bot"]) is None, "nobody listens to tf"


def test_positions_on_the_map_of_any_level_are_shown() -> None:
    is_map = positions.is_map
    assert is_map("/high/map", "{level}/map") and is_map("map", "/map")
    assert not is_map("map", "{level}/map") and not is_map("high/map2", "{level}/map") and not is_map("a/b", "map")


# A robot's topics -----------------------------------------------------------------------------------------------------


@pytest.fixture
def link(monkeypatch: pytest.MonkeyPatch) -> Any:
    """The link to a real robot: `topics` has its subscriptions, `places` what is known of its position."""
    topics: Dict[str, Any] = {}

    class Publisher:
        """Takes the place of rospy's."""

        def __init__(self, topic: str, *_: object, **__: object) -> None:
            self.resolved_name = topic

    monkeypatch.setattr(rospy, "Publisher", Publisher)
    monkeypatch.setattr(robot_link, "ServedFirst", lambda *_: None)
    subscribe = lambda topic, _, callback, *__, **___: topics.update({topic: callback})
    monkeypatch.setattr(robot_link, "subscribe", subscribe)
    places: List[Any] = []
    nothing: Any = lambda *_: None
    statuses: List[Any] = []
    settings = Settings(simulated=False, ends="pose", on_stop="keep", namespace="bot")
    made: Any = RobotLink("bot", settings, nothing, nothing, nothing, statuses.append, places.append, nothing)
    made.topics, made.places, made.statuses = topics, places, statuses
    return made


def test_a_real_robots_goals_are_known_from_its_status(link: Any) -> None:
    pytest.importorskip("actionlib_msgs")
    goal = SimpleNamespace(id="bot-1", stamp=rospy.Time(5))
    answer = SimpleNamespace(goal_id=goal, status=3, text="done")
    link.topics["bot/move_base/status"](SimpleNamespace(status_list=[answer]))
    assert [(each.goal, each.status, each.text) for each in link.statuses[0]] == [("bot-1", 3, "done")]


def test_a_pose_of_amcl_counts_until_tf_has_shown_the_robot(link: Any) -> None:
    message = PoseWithCovarianceStamped()
    message.header.frame_id, message.pose.pose.position.x = "map", 2.0
    message.pose.pose.orientation.w = 1.0
    link._pose(message)
    assert link.places == [Position(2.0, 0.0, 0.0)]
    link._seen_by_tf = True
    link._pose(message)
    assert len(link.places) == 1


def test_a_position_is_on_the_level_of_its_frame_and_goals_are_in_that_of_their_height(
    link: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(rospy.Time, "now", lambda: rospy.Time(7))
    link.frames = MapFrames("{level}/map", {"low": 0.0, "high": 4.0})
    message = PoseWithCovarianceStamped()
    message.header.frame_id, message.pose.pose.orientation.w = "/high/map", 1.0
    link._pose(message)
    message.header.frame_id = "map"
    link._pose(message)
    assert link.places == [Position(0.0, 0.0, 0.0, 4.0)], "map is no frame of these"
    sent: List[Any] = []
    link._send = lambda order: sent.append(order.message)
    for height in (0.0, 4.2):
        place = place_of("room", [1.0, 2.0, height, 0.0, 0.0, 0.0, 1.0])
        link._log = lambda *_: None
        link.go(Goal("bot-1", Movement("going_a_to_room", place)), place.pose)
    assert [each.header.frame_id for each in sent] == ["low/map", "high/map"]


def test_tf_tells_the_level_by_the_frame_that_the_robot_is_in(link: Any) -> None:
    link.frames = MapFrames("{level}/map", {"low": 0.0, "high": 4.0})
    link._tf = SimpleNamespace(TransformException=LookupError)
    known = {"low/map": 4.0, "high/map": 0.0}

    def lookup(frame: str, *_: object) -> Any:
        if frame not in known:
            raise LookupError(frame)
        at = SimpleNamespace(x=1.0, y=2.0, z=known[frame])
        turn = SimpleNamespace(x=0.0, y=0.0, z=0.0, w=1.0)
        stamp = rospy.Time(0)
        return SimpleNamespace(
            header=SimpleNamespace(stamp=stamp), transform=SimpleNamespace(translation=at, rotation=turn)
        )

    link._frames = SimpleNamespace(lookup_transform=lookup)
    link._is_stale = lambda stamp: False
    assert link.look() == Position(1.0, 2.0, 0.0, 4.0), "joined frames: it is high above the lower one"
    del known["low/map"]
    assert link.look() == Position(1.0, 2.0, 0.0, 4.0)
    known.clear()
    assert link.look() is None


# The ends of nodes, and the test of a workspace -----------------------------------------------------------------------


@pytest.mark.parametrize("status, waiting, driven, done, ended", [
    (0, [], True, True, 0), (0, [], False, True, 1), (0, [], True, False, 1), (0, ["bot"], True, True, 1),
    (1, [], True, True, 1),
])  # fmt: skip
def test_drives_end_well_where_all_is_measured(
    status: int, waiting: List[str], driven: bool, done: bool, ended: int
) -> None:
    made: Any = DriveLegs.__new__(DriveLegs)
    made.path, made._lock, made._bag, made._waiting = "drives.bag", threading.RLock(), None, waiting
    made._robots = [SimpleNamespace(acts=SimpleNamespace(is_complete=done))]
    made._done, made._stop, made._next_robot = [SimpleNamespace(is_complete=driven)], lambda: None, lambda: None
    made._duration = "10 drives take 2 to 3 minutes"
    made.ending = SimpleNamespace(wait=lambda linger: status)
    assert made.run() == ended


def test_a_robot_publishes_its_status_after_each_order_and_state_that_changes_it() -> None:
    made: Any = ReaderNode.__new__(ReaderNode)
    made.lock, made.published, made.status, sent, alarms = threading.RLock(), "", 0, [], []

    def change(*_: object) -> bool:
        made.status += 1
        return True

    made.reader = SimpleNamespace(
        on_message=change, on_state=change, on_time=change, status=lambda: made.status, next_check=lambda _: 2.0
    )
    made.statuses, made.alarm = SimpleNamespace(publish=sent.append), SimpleNamespace(set=lambda *g: alarms.append(g))
    made.on_order(String("order"))
    made.on_state(STATE, "/observer")
    made.on_alarm()
    made.publish()
    assert sent == ["1", "2", "3"] and alarms == [(None, 2.0)] * 4


def test_the_page_knows_when_the_last_state_came(monkeypatch: pytest.MonkeyPatch) -> None:
    made: Any = UIPage.__new__(UIPage)
    made._received, made._board = (0.0, 0.0), None
    made._presses = SimpleNamespace(on_state=lambda _: None)
    monkeypatch.setattr(rospy, "get_time", lambda: 100.0)
    made.on_state(STATE, 1.0)
    assert made._received[1] == 100.0 and made._received[0] > 1e9


def test_the_page_notes_what_is_wrong_with_a_robot_until_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    made: Any = UIPage.__new__(UIPage)
    noted: List[Any] = []
    monkeypatch.setattr(rospy, "get_time", lambda: 103.25)
    mission = SimpleNamespace(state=STATE, elapsed=lambda now: now - 100.0)
    shown = {"bot": "Porter 1", "b": "b"}.get
    made._ui = SimpleNamespace(mission=mission, verdict=None, model=SimpleNamespace(shown=shown))
    made._troubles, made._board = Troubles(), SimpleNamespace(note=lambda *entry: noted.append(entry))
    made.on_robots("controller", trouble_values({"bot": "on its way to {b}: its goal is sent again"}))
    assert noted == [(3.25, "Porter 1 on its way to b: its goal is sent again", BAD)]
    made._ui.verdict = (0, "won")
    made.on_robots("controller", trouble_values({"bot": "is 3.0 m from {b}"}))
    assert len(noted) == 1


@pytest.mark.parametrize("values, holds", [("10", True), ("12", False), ("20", False), ("30", True)])
def test_an_edge_is_enabled_where_a_test_of_each_clause_holds(values: str, holds: bool) -> None:
    edge = {"if": [[["r", 1], ["r", 3]], [["s", 0]]]}
    assert mission_test.enabled(edge, {"r": values[0], "s": values[1]}) is holds


@pytest.mark.parametrize("over_at, passed", [(102.0, 2.0), (1e9, 3.0)])
def test_a_mission_that_has_only_to_stay_safe_is_ended_after_its_time_or_when_it_is_over(
    monkeypatch: pytest.MonkeyPatch, over_at: float, passed: float
) -> None:
    now, said = [100.0], []  # type: ignore[var-annotated]
    monkeypatch.setattr(rospy, "get_time", lambda: now[0])
    monkeypatch.setattr(rospy, "sleep", lambda seconds: now.__setitem__(0, now[0] + seconds))
    monkeypatch.setattr(mission_test.MissionTest, "events", SimpleNamespace(publish=said.append), raising=False)
    record = SimpleNamespace(ended=lambda: now[0] >= over_at, wait=lambda *_: True)
    monkeypatch.setattr(mission_test.MissionTest, "record", record, raising=False)
    mission_test.MissionTest.play_on(3.0)
    assert (now[0] - 100.0, said) == (passed, ["Finish!"])


def test_only_a_master_that_refuses_connections_is_gone(monkeypatch: pytest.MonkeyPatch) -> None:
    with socket.create_server(("127.0.0.1", 0)) as there, socket.socket() as held:
        held.bind(("127.0.0.1", 0))  # but it does not listen
        ports = there.getsockname()[1], held.getsockname()[1]
        addresses = [*(f"http://127.0.0.1:{port}" for port in ports), "http://no.such.machine.invalid:1", "nonsense"]
        found = []
        for address in addresses:
            monkeypatch.setenv("ROS_MASTER_URI", address)
            found.append(master_is_gone())
    assert found == [False, True, False, False]
