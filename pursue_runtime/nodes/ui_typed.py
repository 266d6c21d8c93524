"""What a person types at the terminal, and what is offered there: what agents may do, and ends that can be reported."""

from __future__ import annotations

import sys
from typing import Iterator, List, Sequence, Set

import rospy

from pursue_runtime.nodes.node import start_thread
from pursue_runtime.nodes.ui_state import UIState
from pursue_runtime.ui.mission_view import (
    PossibleWord,
    Task,
    done_hints,
    menu,
    possible_words,
    read_line,
    report_text,
    tasks,
)
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
