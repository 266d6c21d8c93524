"""The observer: receives events, keeps the state of the mission, and publishes it; the state names the mission that is
played: with ~received the one that came last from the desk, else the workspace's own.

With ~again it ends after a mission, is started again, and waits for the next one.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import threading
import time
from functools import partial
from typing import Any, Dict, List, Mapping, Optional

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from pursue_msgs.msg import SystemState as SystemStateMessage
from std_msgs.msg import String

from pursue_runtime.data import DataError, Package
from pursue_runtime.event_words import EVENTS, FINISH, PLAN, REPORTED, STATE, SYSTEM_STATE
from pursue_runtime.folders import ros_home, scenario_folder
from pursue_runtime.missions import Missions, Source, own_source
from pursue_runtime.model import Model
from pursue_runtime.nodes.alarm import Alarm, Later
from pursue_runtime.nodes.links import Diagnostics
from pursue_runtime.nodes.newest import Newest
from pursue_runtime.nodes.node import (
    ERROR,
    OK,
    WARN,
    Ending,
    NodeReport,
    restart_process,
    run_node,
    start_thread,
    subscribe,
)
from pursue_runtime.nodes.order_desk import OrderDesk
from pursue_runtime.nodes.publishing import ServedFirst, is_connected
from pursue_runtime.nodes.state_message import PlainWords, StatePrinter, message_of
from pursue_runtime.nodes.witness import Witnesses
from pursue_runtime.observer.journal import Journal, last_mission
from pursue_runtime.observer.mission import Mission
from pursue_runtime.observer.planner import Planner, PlannerAnswer
from pursue_runtime.observer.returning import Inbox, take_up
from pursue_runtime.observer.settings import ARGUMENTS, read_settings
from pursue_runtime.observer.witnesses import contradicts, mission_seen, unknown_state
from pursue_runtime.resend import StateRepeats
from pursue_runtime.sentences import in_words
from pursue_runtime.state import ENDED, HOLDING, LIVE, LOST, STOPPED, WAITING, WON, SystemState, format_state
from pursue_runtime.strategy import read_cover

CLOCK = 10.0
"""Seconds of real time for which a mission that goes on waits for simulated time."""


class Observer:
    """The mission on ROS: one lock, so that events are taken one by one, in the order of their arrival."""

    desk: Optional[OrderDesk] = None
    """Where people order; None before the first state was published."""

    def __init__(self, package: Package, told: Mapping[str, str]) -> None:
        self.package = package
        self.settings = read_settings(rospy.get_param("~", {}), told)
        self.lock = threading.RLock()
        self.ending = Ending()
        self.log_lines, self.after_reaction = Later("log", self.ending), Later("texts", self.ending)
        self.log_soon = self.log_lines.log
        own = own_source(package, "model.yaml", told["config"])
        home = ros_home(os.environ) if self.settings.received else ""
        self.missions = Missions(own, package.name, home)
        self.newest = Newest(self._journal_name(), self.ending)
        self.witnesses = Witnesses(self.ending)
        self.witnesses.gather()
        self.source = self._source()
        self.controllers: List[str] = self.source.read("controllers.yaml")["controllers"]
        self.mission = self._mission()
        self.journal = self._journal()
        self.planner = self._planner()
        self.last_report = dict.fromkeys(self.controllers, time.monotonic())
        self.published_at = time.monotonic()
        self.proposed = 0
        self.over = False
        self.states = rospy.Publisher(STATE, SystemStateMessage, queue_size=1000, latch=True, tcp_nodelay=True)
        ServedFirst(self.states, self.is_controller)
        self.texts = rospy.Publisher(SYSTEM_STATE, String, queue_size=1000, latch=True, tcp_nodelay=True)
        self.plans = rospy.Publisher(PLAN, String, queue_size=10, latch=True, tcp_nodelay=True)
        self.events = rospy.Publisher(EVENTS, String, queue_size=10, tcp_nodelay=True)
        self.printer = StatePrinter(self.ending)
        self.alarm = Alarm(self.on_alarm, self.ending)
        self.inbox = self.take_up()
        self.repeats = StateRepeats(self.mission.model.reaction * self.settings.time_unit)
        self.await_clock()
        self.plain_words = PlainWords(self.mission.state(self.now())) if self.settings.plain_words else None
        self.witnesses.await_subscribers(self.states)
        returning = self.inbox.returning
        self.publish([self.mission.state(returning.floor if returning else self.now())])
        self.mission.ordering.drain()  # those of before a restart
        self.desk = OrderDesk(partial(self.call, "order"), self.now, self.ending)
        self.witnesses.follow(self.on_seen)
        self.words = subscribe(EVENTS, String, self.on_word, self.ending, tcp_nodelay=True)
        pulses = subscribe("/diagnostics", DiagnosticArray, self.on_diagnostics, self.ending, queue_size=100)
        start_thread("journal", self.journal.keep_synced, self.ending)
        start_thread("heartbeat", self.keep_publishing, self.ending)
        Diagnostics(self.report, self.ending, pulses, lost=partial(self.call, "stop"))

    def _source(self) -> Source:
        """Where the data are. A mission that was under way when an observer of this launch died goes on, whatever has
        been received meanwhile; else the current one is played. Raises DataError."""
        source, last = None, last_mission(self._journal_path(), self._journal_name())
        going_on = last.unfinished
        if going_on is None:
            going_on = mission_seen(self.witnesses.seen, last.after)
        if going_on is not None:
            try:
                source = self.missions.find(going_on)
                why = "this machine does not have it any more"
            except DataError as problem:
                why = str(problem)
            if source is None:
                self.log_soon("err", f"mission {going_on or 'own'} was under way, and cannot go on: {why}")
        return source or self.missions.current()

    def _mission(self) -> Mission:
        return Mission(
            Model(self.source.read("model.yaml")),
            read_cover(self.source.read("cover.yaml")),
            log=self.log_soon,
            unit=self.settings.time_unit,
            tolerance=self.settings.tolerance,
            on_uncovered=self.settings.on_uncovered,
            lost_after=self.settings.lost_after,
            controllers=self.controllers,
            name=self.source.mission,
            shared_ends=self.settings.shared_ends,
        )

    def _planner(self) -> Planner:
        game, searching = self.source.read("game.yaml"), partial(self.call, "searching")
        return Planner(self.settings.planner, game, self.settings.planning_limit, self.answer, searching)

    def _journal_name(self) -> str:
        """One for each launch (--launch), or for each roscore: an observer that is started again goes on with it."""
        launch = self.settings.launch or rospy.get_param("/run_id", "")
        return "".join(sign if sign.isalnum() else "_" for sign in launch)

    def _journal_path(self) -> str:
        path = self.settings.journal
        on = os.path.join(scenario_folder(os.environ, self.package.scenario), f"journal-{self._journal_name()}.jsonl")
        return {"on": on, "off": ""}.get(path, path)

    def _journal(self) -> Journal:
        model = json.dumps(self.source.read("model.yaml"), sort_keys=True)
        settings = {name: value for name, value in self.settings._asdict().items() if name != "launch"}
        digest = hashlib.sha256(model.encode()).hexdigest()
        header: Dict[str, object] = {"scenario": self.mission.model.scenario, "model": digest, "settings": settings}
        header.update({"mission": self.source.mission, "launch": self._journal_name()})
        return Journal(self.mission, self._journal_path(), header, self.log_soon, self.newest.begun)

    def now(self) -> float:
        """ROS time in seconds, but nothing comes before what is written down."""
        return max(float(rospy.get_time()), self.journal.last)

    def take_up(self) -> Inbox:
        """Take up the mission where the journal and the other nodes have it; stop it where that is unclear."""
        seen, reporting = self.witnesses.seen, self.witnesses.reporting(self.mission.name)
        begun, reached = self.newest.begun, self.newest.reached(self.journal.after)
        now, real = self.now(), time.monotonic()
        returning = take_up(self.mission, self.journal, seen, reporting, now, real, begun, reached)
        return Inbox(self.mission, self.journal, self.log_soon, returning)

    def await_clock(self) -> None:
        """Wait for simulated time where a mission goes on: it is 0 until /clock was received."""
        deadline = time.monotonic() + CLOCK
        while rospy.get_time() < self.journal.last and time.monotonic() < deadline and not self.ending.called:
            time.sleep(0.02)

    # Callbacks: each takes the lock, calls the mission, and publishes what follows ------------------------------------

    def on_word(self, message: String) -> None:
        """Handle a word on pursue/events.

        A controller that is not subscribed to the states may mean another mission, or an earlier state: its word is
        dropped, and comes again once it receives the states.
        """
        publisher = message._connection_header.get("callerid", "")
        if message.data == REPORTED:
            self.on_reported(publisher)
            return
        if self.is_controller(publisher) and not is_connected(self.states, publisher):
            self.log_soon("warn", f"{publisher} does not receive the states; its word is dropped: {message.data[:80]}")
            return
        self.call("hear", message.data)

    def on_reported(self, node: str) -> None:
        """Handle that a node has reported all that it had to."""
        with self.lock, self.log_lines:
            self.publish(self.inbox.on_reported(node, time.monotonic()))

    def is_controller(self, node: str) -> bool:
        """Return True for the name of a controller of the mission, as rospy has it."""
        return node.strip("/") in self.last_report

    def on_seen(self, state: SystemState, node: str) -> None:
        """Handle what another node has seen last: a state that is not known here stops the mission."""
        with self.lock:
            own = self.mission.state(self.now())
            if contradicts(own, self.journal.after, state):
                self.call("stop", unknown_state(own, node, state))

    def on_alarm(self) -> None:
        """Handle a deadline, or a step that an objective takes by itself; publish a new state once more, for a node
        that did not receive it."""
        with self.lock, self.log_lines:
            state = self.repeats.due(time.monotonic())
            if state is not None:
                self.send(self.states, message_of(state))
            self.publish(self.inbox.on_alarm(self.now(), time.monotonic()))

    def answer(self, answer: PlannerAnswer) -> None:
        """Handle the planner's answer."""
        self.call(*answer)

    def on_diagnostics(self, message: DiagnosticArray) -> None:
        """Handle reports of nodes; a controller that does not have this mission counts as silent."""
        for status in message.status:
            node, values = status.hardware_id, {value.key: value.value for value in status.values}
            if node in self.last_report and values.get("mission", self.mission.name) == self.mission.name:
                self.last_report[node] = time.monotonic()
                if node in self.mission.silent:
                    self.call("back", node)

    def keep_publishing(self) -> None:
        """Publish the state again while nothing happens, as a heartbeat, and find controllers that are silent."""
        while not rospy.is_shutdown():
            time.sleep(min(1.0, self.settings.heartbeat))
            now = time.monotonic()
            with self.lock:
                if self.mission.status != WAITING:
                    self.newest.note((self.mission.seq, self.mission.status in ENDED), self.now())
                if self.inbox.returning is None:
                    self.inbox.notice_absence(self.now())
                    if self.inbox.returning is not None:
                        self.publish([])  # sets the alarm
            self.check_for_another()
            for node, reported in list(self.last_report.items()):
                is_silent = self.inbox.returning is None and now > reported + self.settings.silence
                if is_silent and node not in self.mission.silent and self.mission.status in LIVE:
                    self.call("silent", node)
            with self.lock:
                due = now >= self.published_at + self.settings.heartbeat
                if due and self.inbox.returning is None and self.mission.status not in ENDED:
                    if self.mission.proposal is not None:
                        self.proposed = 0  # a controller has not reported that it has the plan: publish it again
                    self.publish([self.mission.state(self.now())])

    def check_for_another(self) -> None:
        """Begins anew with the mission that is current now, unless one is under way."""
        if self.mission.status != WAITING or not self.missions.changed():
            return
        try:
            current = self.missions.current()
        except DataError as problem:
            self.log_soon("err", f"goes on with mission {self.source.mission or 'own'}: {problem}")
            return
        with self.lock:
            if self.mission.status == WAITING and current != self.source:
                self.over = True  # no word that is received from here on begins a mission
                self.ending.renew()

    def call(self, name: str, *args: Any) -> None:
        """Call the mission by way of the journal, and publish what follows."""
        with self.lock, self.log_lines:
            if self.over and self.mission.status == WAITING:
                return
            self.publish(self.inbox.call(name, *args, now=self.now()))

    # Publishing -------------------------------------------------------------------------------------------------------

    def publish(self, states: List[SystemState]) -> None:
        """Publishes the states, looks ahead, and ends the node after the last one."""
        for state in states:
            self.send(self.states, message_of(state))
            self.after_reaction.do(partial(self.send_text, state))
            self.published_at = time.monotonic()
            self.repeats.on_publish(state, self.published_at)
        proposal = self.mission.proposal or self.mission.in_force  # who comes later needs it as well
        if proposal is not None and proposal["plan"] != self.proposed:
            self.proposed = proposal["plan"]
            self.send(self.plans, json.dumps({**proposal, "mission": self.mission.name}))
        self.journal.sync_soon()
        if self.desk is not None:
            self.desk.answer(self.mission.ordering.drain())
        self.planner.request_plan(self.mission.plan_request)
        moment, real = self.inbox.next_moments(self.now())
        reals = [each for each in (real, self.repeats.next_moment()) if each is not None]
        self.alarm.set(moment, max(0.0, min(reals) - time.monotonic()) if reals else None)
        if self.mission.status in ENDED and not self.over:
            self.over = True
            if self.mission.status == WON:
                self.send(self.events, FINISH)
            # After the last text: what was published then has ~linger to go out.
            self.after_reaction.do(partial(self.ending.end, 0 if self.mission.status == WON else 1))

    def send_text(self, state: SystemState) -> None:
        """Publishes the state as the thesis's text. Controllers react to the message that was published before it."""
        self.send(self.texts, format_state(state))
        if self.plain_words is not None:
            with contextlib.suppress(rospy.ROSException):
                self.plain_words.on_state(state)
        self.printer.on_state(state)

    @staticmethod
    def send(publisher: rospy.Publisher, what: object) -> None:
        """Publishes it, unless the node is going down."""
        with contextlib.suppress(rospy.ROSException):
            publisher.publish(what)

    def report(self) -> NodeReport:
        """Return the report for /diagnostics: ready as soon as a node is connected that publishes words."""
        with self.lock:
            mission = self.mission
            late, lost, away = (" ".join(sorted(names)) for names in (mission.late, mission.lost, mission.silent))
            values: Dict[str, object] = {"mission": mission.name, "seq": mission.seq, "status": mission.status}
            values.update({"plan": mission.plan, "planning": f"{self.planner.seconds:.0f} s"})
            blocked = " ".join("-".join(way[:2]) + ":".join(("", *way[2:])) for way in sorted(mission.ways.blocked))
            values.update({"late": late, "lost": lost, "silent": away, "blocked": blocked})
            robots = {"held": mission.robots.held, "displaced": mission.robots.displaced}
            robots["out_of_service"] = dict.fromkeys(mission.service.out, "")
            robots["finished"] = dict.fromkeys(mission.shared_ends.finished, "")
            values.update({key: " ".join(sorted(names)) for key, names in robots.items()})
            values.update({"journal": self.journal.is_open, **mission.counts})
            message = mission.status + (f": {in_words(mission.reason)}" if mission.reason else "")
            warns = mission.late or mission.lost or mission.ways.blocked or mission.status == HOLDING
            level = ERROR if mission.status in (LOST, STOPPED) else WARN if warns else OK
        return NodeReport(self.words.get_num_connections() > 0, level, message, values)

    def run(self) -> int:
        """Runs until the mission ends; returns the exit status."""
        name = self.source.mission or "own"
        rospy.loginfo("the observer of %s, mission %s: %s", self.mission.model.scenario, name, self.mission.status)
        status = self.ending.wait(linger=self.settings.linger)
        if self.mission.status in ENDED and (self.settings.again or not self.settings.launch):
            self.journal.end(self.now())  # a roscore may see another mission; a launch has one, unless ~again is set
            self.newest.close()
        if self.ending.renewed:
            restart_process()
        return status


def main(package: Package) -> int:
    """Runs the node of this package until it ends; returns its exit status."""
    return run_node(package.name, ARGUMENTS, lambda told: Observer(package, told).run())
