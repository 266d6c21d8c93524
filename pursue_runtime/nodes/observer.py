"""The observer: hears events, keeps the state of the system, publishes it, and so says which mission is
played: with ~received the one that came last from the desk, else the workspace's own.

With ~again it ends after a mission, is started again, and waits for the next one.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import queue
import threading
import time
from functools import partial
from typing import Any, Dict, List, Tuple

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from pursue_msgs.msg import SystemState as SystemStateMessage
from std_msgs.msg import String

from pursue_runtime.data import DataError, Package
from pursue_runtime.missions import Missions, Source, own_source, ros_home
from pursue_runtime.model import Model
from pursue_runtime.nodes.links import Links
from pursue_runtime.nodes.node import ERROR, OK, WARN, Alarm, Diagnostics, Ending, Report, begin_anew, listeners
from pursue_runtime.nodes.state_message import message_of
from pursue_runtime.observer.journal import Journal, journals_folder, unfinished
from pursue_runtime.observer.mission import Mission
from pursue_runtime.observer.planner import Answer, Planner
from pursue_runtime.state import ENDED, HOLDING, LIVE, LOST, STOPPED, WAITING, WON, SystemState, format_state
from pursue_runtime.strategy import read_cover
from pursue_runtime.words import EVENTS, FINISH, PLAN, STATE, SYSTEM_STATE

LOGS = {"info": rospy.loginfo, "warn": rospy.logwarn, "err": rospy.logerr}

CLOCK = 10.0
"""Seconds of real time for which a mission that goes on waits for simulated time."""


def log(level: str, text: str) -> None:
    """Logs a sentence."""
    LOGS[level]("%s", text)


def setting(name: str, otherwise: str) -> str:
    """A parameter that is text: for ROS, on and off are not."""
    value = rospy.get_param(name, otherwise)
    return ("off", "on")[value] if isinstance(value, bool) else str(value)


class Observer:
    """The mission on ROS: one lock, so that events are taken one by one, in the order of their arrival."""

    def __init__(self, package: Package) -> None:
        self.package = package
        self.lock = threading.RLock()
        self.ending = Ending()
        self.remarks: queue.SimpleQueue[Tuple[str, str]] = queue.SimpleQueue()
        threading.Thread(target=self.write_log, name="log", daemon=True).start()
        own = own_source(package, "model.yaml", rospy.get_param("~config", ""))
        home = ros_home(os.environ) if rospy.get_param("~received", False) else ""
        self.missions = Missions(own, package.name, home)
        self.launch = str(rospy.get_param("~launch", ""))
        self.again = bool(rospy.get_param("~again", False))
        self.source = self._source()
        self.controllers: List[str] = self.source.read("controllers.yaml")["controllers"]
        self.mission = self._mission()
        self.journal = self._journal()
        self.planner = self._planner()
        self.silence = float(rospy.get_param("~silence", 20.0))
        self.heartbeat = float(rospy.get_param("~heartbeat", 1.0))
        self.heard = dict.fromkeys(self.controllers, time.monotonic())
        self.spoke = time.monotonic()
        self.proposed = 0
        self.over = False
        self.states = rospy.Publisher(STATE, SystemStateMessage, queue_size=1000, latch=True, tcp_nodelay=True)
        self.texts = rospy.Publisher(SYSTEM_STATE, String, queue_size=1000, latch=True, tcp_nodelay=True)
        self.plans = rospy.Publisher(PLAN, String, queue_size=10, latch=True, tcp_nodelay=True)
        self.events = rospy.Publisher(EVENTS, String, queue_size=10, tcp_nodelay=True)
        self.alarm = Alarm(self.ring)
        self.await_clock()
        self.publish([self.mission.state(self.now())])
        self.ears = rospy.Subscriber(EVENTS, String, self.hear, tcp_nodelay=True)
        pulses = rospy.Subscriber("/diagnostics", DiagnosticArray, self.on_diagnostics, queue_size=100)
        threading.Thread(target=self.beat, name="heart", daemon=True).start()
        Diagnostics(self.report, Links(pulses, lost=partial(self.call, "stop")))

    def _source(self) -> Source:
        """Where the data are. A mission that was under way when an observer of this launch died goes on, whatever has
        been received meanwhile; else the current one is played. Raises DataError."""
        going_on, source = unfinished(self._journal_path(), self._journal_name()), None
        if going_on is not None:
            try:
                source = self.missions.find(going_on)
                why = "this machine does not have it any more"
            except DataError as problem:
                why = str(problem)
            if source is None:
                self.remark("err", f"mission {going_on or 'own'} was under way, and cannot go on: {why}")
        return source or self.missions.current()

    def _mission(self) -> Mission:
        return Mission(
            Model(self.source.read("model.yaml")),
            read_cover(self.source.read("cover.yaml")),
            log=self.remark,
            unit=float(rospy.get_param("~time_unit", 1.0)),
            tolerance=float(rospy.get_param("~tolerance", 0.1)),
            on_uncovered=rospy.get_param("~on_uncovered", "plan"),
            lost_after=float(rospy.get_param("~lost_after", 30.0)),
            controllers=self.controllers,
            name=self.source.mission,
        )

    def _planner(self) -> Planner:
        command = setting("~planner", "pursue-gen replan")
        limit = float(rospy.get_param("~planning_limit", 10.0))
        return Planner(command, self.source.read("game.yaml"), limit, self.answer)

    def _journal_name(self) -> str:
        """One for each launch (~launch), or for each roscore: an observer that is started again goes on with it."""
        launch = self.launch or rospy.get_param("/run_id", "")
        return "".join(sign if sign.isalnum() else "_" for sign in launch)

    def _journal_path(self) -> str:
        path = setting("~journal", "on")
        on = os.path.join(journals_folder(os.environ, self.package.scenario), f"journal-{self._journal_name()}.jsonl")
        return {"on": on, "off": ""}.get(path, path)

    def _journal(self) -> Journal:
        model = json.dumps(self.source.read("model.yaml"), sort_keys=True)
        settings = {name: value for name, value in sorted(rospy.get_param("~", {}).items()) if name != "launch"}
        digest = hashlib.sha256(model.encode()).hexdigest()
        header: Dict[str, object] = {"scenario": self.mission.model.scenario, "model": digest, "settings": settings}
        header.update({"mission": self.source.mission, "launch": self._journal_name()})
        return Journal(self.mission, self._journal_path(), header, self.remark)

    def now(self) -> float:
        """ROS time in seconds, but nothing comes before what is written down."""
        return max(float(rospy.get_time()), self.journal.last)

    def await_clock(self) -> None:
        """Where a mission goes on, simulated time is 0 until the clock was heard."""
        deadline = time.monotonic() + CLOCK
        while rospy.get_time() < self.journal.last and time.monotonic() < deadline and not self.ending.called:
            time.sleep(0.02)

    # What is heard: each takes the lock, calls the mission, and publishes what follows -------------------------------

    def hear(self, message: String) -> None:
        """A word on pursue/events. A controller that does not hear our states speaks of another mission, or of an
        earlier turn of this one: what is due there may be wrong here. It says it again as soon as it hears us."""
        speaker = message._connection_header.get("callerid", "")
        if speaker.strip("/") in self.heard and speaker not in listeners(self.states):
            self.remark("warn", f"{speaker} does not hear the states; what it says does not count: {message.data[:80]}")
            return
        self.call("hear", message.data)

    def ring(self) -> None:
        """The alarm: a deadline, or a step that an objective takes by itself."""
        self.call("tick")

    def answer(self, answer: Answer) -> None:
        """The planner is done."""
        number, plan, why = answer
        self.call(*(("unplanned", number, why) if plan is None else ("planned", number, plan)))

    def on_diagnostics(self, message: DiagnosticArray) -> None:
        """A node is there; a controller that does not have this mission is as good as silent."""
        for status in message.status:
            node, said = status.hardware_id, {value.key: value.value for value in status.values}
            if node in self.heard and said.get("mission", self.mission.name) == self.mission.name:
                self.heard[node] = time.monotonic()
                if node in self.mission.away:
                    self.call("back", node)

    def beat(self) -> None:
        """Says the state again where nothing happens, so that others know that they hear us; looks who is silent."""
        while not rospy.is_shutdown():
            time.sleep(min(1.0, self.heartbeat))
            now = time.monotonic()
            self.look_for_another()
            for node, heard in list(self.heard.items()):
                if now > heard + self.silence and node not in self.mission.away and self.mission.status in LIVE:
                    self.call("silent", node)
            with self.lock:
                if now >= self.spoke + self.heartbeat and self.mission.status not in ENDED:
                    if self.mission.proposal is not None:
                        self.proposed = 0  # somebody has not said that it has the plan: it goes out again
                    self.publish([self.mission.state(self.now())])

    def look_for_another(self) -> None:
        """Begins anew with the mission that is current now, unless one is under way."""
        if self.mission.status != WAITING or not self.missions.changed():
            return
        try:
            current = self.missions.current()
        except DataError as problem:
            self.remark("err", f"goes on with mission {self.source.mission or 'own'}: {problem}")
            return
        with self.lock:
            if self.mission.status == WAITING and current != self.source:
                self.over = True  # nothing that is heard from here on begins a mission
                self.ending.renew()

    def call(self, name: str, *args: Any) -> None:
        """Calls the mission, by way of the journal."""
        with self.lock:
            if self.over and self.mission.status == WAITING:
                return
            self.publish(self.journal.call(name, *args, now=self.now()))

    # What is said -----------------------------------------------------------------------------------------------------

    def publish(self, states: List[SystemState]) -> None:
        """Publishes the states, looks ahead, and ends the node after the last one."""
        for state in states:
            self.say(self.states, message_of(state))
            self.say(self.texts, format_state(state))
            self.spoke = time.monotonic()
        proposal = self.mission.proposal or self.mission.in_force  # who comes later needs it as well
        if proposal is not None and proposal["plan"] != self.proposed:
            self.proposed = proposal["plan"]
            self.say(self.plans, json.dumps({**proposal, "mission": self.mission.name}))
        self.planner.want(self.mission.wanted)
        self.alarm.set(self.mission.next_moment(self.now()))
        if self.mission.status in ENDED and not self.over:
            self.over = True
            if self.mission.status == WON:
                self.say(self.events, FINISH)
            self.ending.end(0 if self.mission.status == WON else 1)

    def remark(self, level: str, text: str) -> None:
        """Logs a sentence soon."""
        self.remarks.put((level, text))

    def write_log(self) -> None:
        """Logs what was remarked, a moment later: a line takes as long as a reaction, and the next word may be near."""
        while True:
            remark = self.remarks.get()
            time.sleep(0.01)
            log(*remark)

    @staticmethod
    def say(publisher: rospy.Publisher, what: object) -> None:
        """Publishes it, unless the node is going down."""
        with contextlib.suppress(rospy.ROSException):
            publisher.publish(what)

    def report(self) -> Report:
        """For /diagnostics. It is ready as soon as somebody's words can reach it."""
        with self.lock:
            mission = self.mission
            late, lost, away = (" ".join(sorted(names)) for names in (mission.late, mission.lost, mission.away))
            values: Dict[str, object] = {"mission": mission.name, "seq": mission.seq, "status": mission.status}
            values.update({"plan": mission.plan})
            values.update({"late": late, "lost": lost, "silent": away, "journal": self.journal.works, **mission.counts})
            message = mission.status + (f": {mission.reason}" if mission.reason else "")
            warns = mission.late or mission.lost or mission.status == HOLDING
            level = ERROR if mission.status in (LOST, STOPPED) else WARN if warns else OK
        return Report(self.ears.get_num_connections() > 0, level, message, values)

    def run(self) -> int:
        """Runs until the mission ends; returns the exit status."""
        name = self.source.mission or "own"
        rospy.loginfo("the observer of %s, mission %s: %s", self.mission.model.scenario, name, self.mission.status)
        status = self.ending.wait(linger=float(rospy.get_param("~linger", 1.0)))
        if self.mission.status in ENDED and (self.again or not self.launch):
            self.journal.told()  # a roscore may see another mission; a launch has one, unless told otherwise
        if self.ending.renewed:
            begin_anew()
        return status


def main(package: Package) -> int:
    """Runs the node of this package until it ends; returns its exit status."""
    rospy.init_node(package.name)
    try:
        return Observer(package).run()
    except DataError as problem:
        rospy.logfatal("%s", problem)
        return 3
