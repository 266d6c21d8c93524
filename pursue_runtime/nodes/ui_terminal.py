"""The terminal's side of the UI: what a person types there, what is offered (what agents may do, ends that can be
reported), and in the thesis's modes `e` (only events) and `f` (all communication) the messages on topics."""

from __future__ import annotations

import sys
from typing import Iterator, List, Sequence, Set, Tuple

import rospy
from std_msgs.msg import String

from pursue_runtime.event_words import EVENTS, SYSTEM_STATE
from pursue_runtime.nodes.node import start_thread, subscribe
from pursue_runtime.nodes.positions import settings_of
from pursue_runtime.nodes.ui_state import UIState
from pursue_runtime.state import parse_state
from pursue_runtime.ui.mission_view import (
    PossibleWord,
    Task,
    done_hints,
    menu,
    possible_words,
    read_line,
    report_text,
    tasks,
    traffic_lines,
)
from pursue_runtime.ui.options import ALL_TOPICS, IN_WORDS
from pursue_runtime.ui.requests import numbered
from pursue_runtime.ui.terminal import on_terminal


class Typed:
    """The person at the terminal of a UI. `offers` and `given` are what can be typed, as `find` has seen it last."""

    def __init__(self, ui: UIState, reporting: Sequence[str]) -> None:
        """`reporting`: the agents whose ends are reported here."""
        self._ui, self._reporting = ui, reporting
        self._words: Set[str] = {edge.word for automaton in ui.model.automata for edge in automaton.edges}
        self.offers: List[PossibleWord] = []
        self.given: List[Task] = []

    @property
    def is_read(self) -> bool:
        """True when a person may type here."""
        return sys.stdin is not None and not sys.stdin.closed and (self._ui.options.mode == "ask" or on_terminal())

    def start(self) -> None:
        """Handle what is typed from now on, until the input ends."""
        if self.is_read:
            start_thread("typed", self._read, self._ui.ending)

    def _read(self) -> None:
        for line in typed_lines():
            self.on_line(line)

    def on_line(self, text: str) -> None:
        """The person at the terminal typed a line."""
        ui = self._ui
        with ui.lock:
            if ui.verdict is not None:
                ui.terminal.line("          the mission has ended; Ctrl-C ends the page as well")
            elif ui.can_start() and not text.strip():
                ui.start()
            elif ui.is_running and not text.strip():
                self.show(again=True)
            elif ui.is_running and ui.orders.typed(text.strip()):
                pass  # its answer is shown when it comes
            else:
                self.find()
                word, answer_text = read_line(text, self.offers, self._words, self.given)
                if answer_text:
                    ui.terminal.line(f"          {answer_text}")
                if word:
                    state, ends = ui.mission.state, {task.word for task in self.given}
                    ui.events.publish(numbered(word, state.seq) if state is not None and word in ends else word)

    def show(self, again: bool = False) -> None:
        """Show in mode ask what can be typed, if that has changed."""
        before, given = [offer.word for offer in self.offers], self.given
        self.find()
        if self.given and self.given != given and self.is_read:
            for hint in done_hints(self.given):
                self._ui.terminal.line(f"          {hint}")
        if self._ui.options.mode == "ask" and (again or before != [offer.word for offer in self.offers]):
            for line in menu(self.offers, not self._ui.model.goal):
                self._ui.terminal.line(line)

    def find(self) -> None:
        """Find what the uncontrollable agents can do now, and which ends can be reported here."""
        model, state = self._ui.model, self._ui.mission.state
        if state is not None:
            self.given = tasks(model, state, self._reporting)
            reports = [PossibleWord(task.word, 0.0, float("inf"), task.agent, report_text(task)) for task in self.given]
            self.offers = [*possible_words(model, state, state.clocks_at(rospy.get_time())), *reports]


def typed_lines() -> Iterator[str]:
    """Yield the lines of standard input; where it fails, log why and end: the mission goes on without a terminal."""
    try:
        yield from sys.stdin
    except (OSError, ValueError) as problem:  # the terminal is gone, or what was typed is no text
        rospy.logwarn("standard input is not read any more: %s", problem)


class Traffic:
    """Prints messages as they are published, beside the sentences of the UI; nothing where the options want words."""

    def __init__(self, ui: UIState) -> None:
        self._ui = ui
        self._last: Tuple[object, ...] = ()
        known = settings_of(robot.name for robot in ui.model.of_kind("robot"))
        robots = [each.topic("pursue/actions") for each in known.values()]
        more = [*robots, SYSTEM_STATE] if ui.options.show == ALL_TOPICS else []
        for topic in [] if ui.options.show == IN_WORDS else [EVENTS, *more]:
            subscribe(topic, String, self.on_message, ui.ending, topic, queue_size=1000, tcp_nodelay=True)
        if ui.membership.printer.write is not None:
            ui.membership.printer.write = self.print_lines

    def on_message(self, message: String, topic: str) -> None:
        """Print a message; of the states those that are new: the observer publishes each again, as a heartbeat."""
        with self._ui.lock:
            if topic == SYSTEM_STATE:
                state = parse_state(message.data)
                key = (state.mission, state.seq, state.status) if state is not None else (message.data,)
                if key == self._last:
                    return
                self._last = key
            self.print_lines(traffic_lines(topic, message.data, self._ui.mission.elapsed(rospy.get_time())))

    def print_lines(self, lines: Sequence[str]) -> None:
        """Print lines above the progress line of the terminal."""
        with self._ui.lock:
            for line in lines:
                self._ui.terminal.line(line)
