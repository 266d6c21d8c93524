"""The terminal: starts the mission, plays agents or lets a person play them, instructs people, shows how it goes."""

from __future__ import annotations

import contextlib
import sys
import time
from typing import Dict, Optional, Sequence

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from std_msgs.msg import String

from pursue_runtime.data import DataError, Package
from pursue_runtime.doors.opened import DOORS, read_opened
from pursue_runtime.event_words import EVENTS, FINISH, PLAN, START
from pursue_runtime.model import Model
from pursue_runtime.nodes.alarm import Alarm
from pursue_runtime.nodes.links import Diagnostics
from pursue_runtime.nodes.membership import Membership
from pursue_runtime.nodes.node import (
    ERROR,
    OK,
    WARN,
    Ending,
    NodeReport,
    init_node,
    lower_priority,
    restart_process,
    subscribe,
)
from pursue_runtime.nodes.publishing import Newcomers, listeners
from pursue_runtime.nodes.state_message import subscribe_states
from pursue_runtime.nodes.ui_page import UIPage
from pursue_runtime.nodes.ui_state import GATHERING, READY, RUNNING, STARTING, UIState
from pursue_runtime.nodes.ui_terminal import Traffic, Typed
from pursue_runtime.state import STOPPED, WAITING, WON, SystemState
from pursue_runtime.strategy import Strategy, parse_plan
from pursue_runtime.ui.environment import TraceError, make_player
from pursue_runtime.ui.mission_view import Environment, reporters
from pursue_runtime.ui.options import ARGUMENTS, Options, read_options, read_told
from pursue_runtime.ui.strategies import strategies_in
from pursue_runtime.ui.terminal import BAD, BOLD, GOOD, PLAIN, on_terminal
from pursue_runtime.ui.verdict import ALONE, INTERRUPTED, NOT_STARTED, Verdict, drop_interrupted, write_verdict

RETRY = 1.0  # real seconds until `_start_` is published again
TRIES = 10
REDRAW = 1.0  # real seconds between two progress lines
VANISHED = 2.0  # real seconds after `Finish!` without a message of the observer


class UI(UIState):
    """The UI on ROS: an alarm for whatever comes next, callbacks for messages."""

    def __init__(
        self,
        options: Options,
        membership: Membership,
        ending: Ending,
        player: Environment,
        model: Model,
        reporting: Sequence[str],
    ) -> None:
        """`reporting`: the agents whose ends are reported here."""
        super().__init__(options, membership, ending, player, model)
        self.tries = 0
        self.typed = Typed(self, reporting)
        self.page = UIPage(self, self.typed)
        self.finish_received: Optional[float] = None
        Newcomers(self.events, lambda node: node == self.observer, self.say_again)
        self.alarm = Alarm(self.on_alarm, ending)
        self.alarm.set(patience=options.wait)
        awaited = ", ".join(options.nodes) or "the observer"
        self.terminal.line(f"{model.scenario}: waiting for {awaited}", PLAIN)  # before anything can come
        self.traffic = Traffic(self)
        self.states = subscribe_states(self.on_state, ending, on_malformed=membership.count_malformed)
        subscribe(PLAN, String, self.on_plan, ending, queue_size=10, tcp_nodelay=True)
        subscribe(EVENTS, String, self.on_word, ending, queue_size=1000, tcp_nodelay=True)
        if self.at_doors.has_some:
            subscribe(DOORS, String, self.on_doors, ending, queue_size=10, tcp_nodelay=True)
        self.pulses = subscribe("/diagnostics", DiagnosticArray, self.on_diagnostics, ending, queue_size=100)
        Diagnostics(self.report, ending, self.states, self.pulses, lost=self.master_lost)

    # Callbacks --------------------------------------------------------------------------------------------------------

    def on_diagnostics(self, message: DiagnosticArray) -> None:
        """Handle reports of nodes; when the last one is ready, the mission can start."""
        with self.lock:
            for status in message.status:
                values = {value.key: value.value for value in status.values}
                ours = values.get("mission") in (None, "", self.membership.source.mission)
                ready = ours and values.get("ready") == "true"
                node = status.hardware_id or status.name.partition(":")[0]
                self.readiness.update(node, ready, status.message if ours else "")
                if ours:
                    self.page.on_robots(node, values)
                if node == "recorder" and "file" in values:
                    self.page.on_recorder(values["file"])
            if self.verdict is not None:
                return
            if self.phase == GATHERING and self.connected() and not self.readiness.missing():
                self.gathered()
            elif self.phase == GATHERING:
                self.page.show()

    def on_state(self, state: SystemState, publisher: str) -> None:
        """A state of the mission."""
        with self.lock:
            if not self.membership.takes(state):
                return
            self.observer = publisher
            if self.verdict is not None:
                self.page.after_end(state)
                return
            for line in self.mission.on_state(state, rospy.get_time()):
                self.terminal.line(line)
            if self.mission.state is state:
                self.page.on_state(state, self.mission.elapsed(state.stamp))
            verdict = self.mission.verdict()
            if verdict is not None:
                self.conclude(state.status, verdict[1])
            elif state.status != WAITING:
                if self.phase != RUNNING:
                    self.phase = RUNNING
                    self.terminal.line(self.mission.first_line(rospy.get_time()), BOLD)
                self.act()
                self.typed.show()
            self.page.show()

    def on_plan(self, message: String) -> None:
        """A new plan: what people do in it."""
        try:
            plan = parse_plan(message.data)
            orders = Strategy(plan["people"]) if plan.get("people") else None
        except DataError as problem:
            rospy.logerr("cannot use the new plan: %s", problem)
            return
        if plan.get("mission", "") not in ("", self.membership.source.mission):
            return
        with self.lock:
            with contextlib.suppress(DataError):  # the nodes that need it say what is wrong with it
                self.strategies[plan["plan"]] = strategies_in(plan)
            self.page.on_plan(plan)
            if orders is not None:
                self.mission.add_plan(plan["plan"], orders)
                self.act()

    def on_doors(self, message: String) -> None:
        """Show for whom doors and lifts are open."""
        opened = read_opened(message.data)
        if opened is not None and opened.mission == self.membership.source.mission:
            with self.lock:
                self.at_doors.take(opened)
                self.page.show()

    def on_word(self, message: String) -> None:
        """Handle `Finish!`, the observer's last word: should its last state be lost, the UI ends all the same."""
        if message.data.strip() == FINISH and message._connection_header.get("callerid", "") == self.observer:
            with self.lock:
                self.finish_received = time.monotonic()
                self.act()

    def on_answer(self, order: str, accepted: bool, text: str) -> None:
        """Handle the answer to an order."""
        with self.lock:
            at = self.mission.elapsed(rospy.get_time())
            self.terminal.line(f"{at:8.1f}  {order}: {text}", GOOD if accepted else BAD)
            self.page.on_answer(at, order, accepted, text)

    # What is done -----------------------------------------------------------------------------------------------------

    def gathered(self) -> None:
        """All nodes are ready."""
        self.phase = READY
        self.alarm.set()
        self.page.show()
        if self.options.autostart:
            self.start()
        elif self.page.url:
            here = ", or press Enter" if self.typed.is_read else ""
            self.terminal.line(f"All nodes are ready. Start the mission on the page{here}.", BOLD)
        elif self.typed.is_read:
            self.terminal.line("All nodes are ready. Press Enter to start the mission.", BOLD)
        else:
            self.terminal.line("All nodes are ready; the mission starts when _start_ is published.", BOLD)

    def start(self) -> None:
        """Publish `_start_`, again if no state answers it; never for a mission that has been seen under way."""
        if self.mission.start is not None or self.verdict is not None:
            return
        if self.tries == TRIES:
            self.conclude(NOT_STARTED, f"The observer does not answer {START}.")
            return
        self.phase = STARTING
        self.tries += 1
        self.events.publish(START)
        self.alarm.set(patience=RETRY)
        self.page.show()

    def on_alarm(self) -> None:
        """The alarm."""
        with self.lock:
            if self.phase == GATHERING:
                missing = ", ".join(self.readiness.reasons()) or "the connection to the observer"
                after = f"Not ready after {self.options.wait:g} s: {missing}."
                if self.membership.again:  # a machine may be switched on later
                    self.terminal.line(f"{after} Waiting on.", PLAIN)
                else:
                    self.conclude(NOT_STARTED, f"{after} The mission was not started.")
            elif self.phase == STARTING:
                self.start()
            elif self.phase == RUNNING:
                self.act()

    def say_again(self) -> None:
        """Publish an instruction that no state has answered once more: an observer has connected."""
        with self.lock:
            self.mission.say_again()
            self.act()

    def act(self) -> None:
        """Publishes what is due, and sleeps until there is more."""
        if self.phase != RUNNING or self.verdict is not None:
            return
        now, real = rospy.get_time(), time.monotonic()
        if self.finish_received is not None and real >= self.finish_received + VANISHED:
            self.finish_received = None
            if self.states.get_num_connections() == 0:
                after = f"after {self.mission.elapsed(now):.1f} {self.mission.counts}"
                self.conclude(WON, f"The observer published {FINISH} and is gone, {after}.")
                return
        for word in self.mission.due(now, real):
            self.events.publish(word)
        moment, deadline = self.mission.next_moments(now)
        vanished = self.finish_received and self.finish_received + VANISHED
        deadlines = [at for at in (deadline, vanished) if at is not None]
        if self.terminal.is_terminal and self.options.mode != "ask":
            self.terminal.progress(self.mission.progress(now))
            deadlines.append(real + REDRAW)
        self.alarm.set(moment, max(0.0, min(deadlines) - real) if deadlines else None)

    def conclude(self, outcome: str, sentence: str) -> None:
        """End with this outcome and sentence; only the first call counts."""
        if self.verdict is not None:
            return
        status = 0 if outcome == WON else 1
        self.verdict = (status, sentence)
        save_verdict(self.options.verdict, outcome, sentence)
        self.terminal.close()
        self.terminal.line(sentence, GOOD if status == 0 else BAD)
        self.page.end(self.mission.elapsed(rospy.get_time()), self.verdict)
        if self.page.stays:
            self.membership.leave()
            self.terminal.line(f"The page stays at {self.page.url} until it is closed there, or Ctrl-C.", PLAIN)
        else:
            self.ending.end(status)

    # How it is --------------------------------------------------------------------------------------------------------

    def connected(self) -> bool:
        """True when the observer and this node are connected both ways."""
        return bool(self.observer) and self.observer in listeners(self.events)

    def master_lost(self, why: str) -> None:
        """End the node: without a master no node can start or join."""
        with self.lock:
            self.conclude(STOPPED if self.phase == RUNNING else NOT_STARTED, f"The mission cannot go on: {why}.")
            self.ending.end(self.verdict[0] if self.verdict is not None else 1)

    def report(self) -> NodeReport:
        """For /diagnostics."""
        with self.lock:
            missing = self.missing()
            values: Dict[str, object] = {"phase": self.phase, "mode": self.options.mode, "missing": " ".join(missing)}
            verdict = self.mission.verdict()
            refused, trouble = self.membership.refused, self.membership.trouble
        values.update({"mission": self.membership.source.mission, **self.membership.counts})
        trouble = f"refused {refused}" if refused else trouble
        level = ERROR if refused or (verdict and verdict[0]) else WARN if missing or trouble else OK
        message = verdict[1] if verdict else trouble or self.phase
        return NodeReport(self.connected() and not trouble, level, message, values)

    def run(self) -> int:
        """Runs until the mission ends; returns the exit status."""
        if self.page.url:
            self.terminal.line(f"The page is at {self.page.url}", BOLD)
        self.typed.start()
        status = self.ending.wait(linger=0.3)
        if self.ending.reason:
            self.master_lost(self.ending.reason)
        kept = self.page.close("another mission is prepared" if self.ending.renewed else "the mission has ended")
        if self.ending.renewed:
            self.terminal.close()
            restart_process(kept)
        if self.verdict is None:  # everything ends, or the UI alone: then it is started again
            save_verdict(self.options.verdict, INTERRUPTED, "The UI was interrupted before the mission ended.")
            self.terminal.close()
            return status or ALONE
        return max(status, self.verdict[0])


def save_verdict(path: str, outcome: str, sentence: str) -> None:
    """Writes the verdict for the program that launched the mission; logs why where that is not possible."""
    try:
        write_verdict(path, Verdict(outcome, sentence))
    except OSError as problem:
        rospy.logerr("cannot write the verdict: %s", problem)


def main(package: Package) -> int:
    """Runs the node of this package until it ends; returns its exit status."""
    arguments = rospy.myargv(sys.argv)[1:]
    told = read_told(arguments)  # --help ends here, and needs no roscore
    lower_priority()
    init_node("UI", ARGUMENTS)
    try:
        ending = Ending()
        membership = Membership(package, ending, told["config"])
        model, settings = membership.model, membership.source.read("ui.yaml")
        options = read_options(arguments, rospy.get_param("~", {}), on_terminal(), settings.get("nodes", ()))
        player = make_player(options, model)
        drop_interrupted(options.verdict)
        ui = UI(options, membership, ending, player, model, reporters(model, options.ends, settings))
        ui.mission.counts = str(settings.get("counts", ui.mission.counts))
        ui.page.open(settings)
    except (DataError, TraceError) as problem:
        print(f"UI: {problem}", file=sys.stderr)
        save_verdict(told["verdict"], NOT_STARTED, str(problem))
        return 2
    return ui.run()
