"""The page's side of the UI: what it shows, what pages ask for, and whether the observer answers."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any, Mapping, Optional, Tuple

import rospy

from pursue_runtime.nodes.links import traffic
from pursue_runtime.nodes.node import start_thread
from pursue_runtime.nodes.positions import watch_positions
from pursue_runtime.state import SystemState
from pursue_runtime.ui.mission_view import MARGIN
from pursue_runtime.ui.page import Facts
from pursue_runtime.ui.page_server import PageServer, open_page
from pursue_runtime.ui.presence import LOOK, Presence
from pursue_runtime.ui.requests import PageRequest, Presses
from pursue_runtime.words import STOP

if TYPE_CHECKING:
    from pursue_runtime.nodes.ui import UI

NO_ANSWER = "The observer does not answer"


class UIPage:
    """The page of a UI; without `open` there is none, and nothing happens here."""

    def __init__(self, ui: UI) -> None:
        self.lock = ui.lock
        self._ui = ui
        self._board: Optional[PageServer] = None
        self._presses, self._presence = Presses(), Presence()
        self._received = (0.0, 0.0)  # when the last state came: Unix time, ROS time
        self._stopping = False

    def open(self, settings: Mapping[str, Any]) -> None:
        """Serve the page, where one is wanted. Raises ParameterError and other DataErrors."""
        ui = self._ui
        self._board = open_page(ui.model, ui.options, settings, ui.membership.source, self)
        if self._board is not None:
            start_thread("presence", self._watch, ui.ending)
            watch_positions([robot.name for robot in ui.model.of_kind("robot")], ui.ending, self._board.on_positions)

    @property
    def url(self) -> str:
        """The address of the page, "" where there is none."""
        return str(self._board.web.url) if self._board is not None else ""

    # What comes from the UI -------------------------------------------------------------------------------------------

    def on_state(self, state: SystemState, at: float) -> None:
        """Take a state of the mission, `at` time units after its start."""
        self._received = (time.time(), rospy.get_time())
        self._presses.on_state(state)
        if self._board is not None:
            self._board.on_state(state, at)

    def on_plan(self, plan: Mapping[str, Any]) -> None:
        """Take a new plan, as `parse_plan` returns it."""
        if self._board is not None:
            self._board.on_plan(plan)

    def show(self) -> None:
        """Send the present view to the page."""
        if self._board is not None:
            self._board.show()

    def end(self, at: float, verdict: Tuple[int, str]) -> None:
        """Show the end of the mission."""
        if self._board is not None:
            self._board.end(at, verdict)

    def close(self) -> None:
        """Serve no more."""
        if self._board is not None:
            self._board.web.close()

    # What comes from the page -----------------------------------------------------------------------------------------

    def facts(self) -> Facts:
        """Return what the page shows."""
        ui, mission, answers = self._ui, self._ui.mission, self._presence.answers
        now = mission.elapsed(rospy.get_time() if answers else self._received[1])
        at = mission.elapsed(mission.state.stamp) if mission.state is not None else 0.0
        return Facts(ui.phase, ui.missing(), mission.state, at, now, ui.verdict, answers, self._received[0])

    def on_request(self, request: PageRequest) -> str:
        """Carry out a request of a page; return what to show there, "" for nothing."""
        ui, state = self._ui, self._ui.mission.state
        if ui.verdict is not None:
            return f"{request.word or request.do} is not possible now."
        if request.do == "stop":
            self._stopping = True
            ui.events.publish(STOP)
            return "" if self._presence.answers else f"{NO_ANSWER}: the mission is stopped as soon as it does."
        if not self._presence.answers:
            return f"{NO_ANSWER}: nothing was sent."
        if request.do == "start" and ui.can_start():
            ui.start()
            return ""
        if not request.word or state is None:
            return f"{request.word or request.do} is not possible now."
        ui.find_offers()
        ends = {task.word for task in ui.given}
        begins = {offer.word for offer in ui.offers if offer.opens <= MARGIN}
        word, remark = self._presses.word(request, state, ends if request.do == "done" else begins)
        if word:
            ui.events.publish(word)
        return remark

    # Whether the observer answers -------------------------------------------------------------------------------------

    def _watch(self) -> None:
        """Look at the connections with the observer; publish `_stop_` again until the mission has ended."""
        while not self._ui.ending.called:
            time.sleep(LOOK)
            with self.lock:
                self._look()

    def _look(self) -> None:
        ui = self._ui
        if not ui.observer or ui.verdict is not None or self._board is None:
            return
        if self._presence.look(*traffic(ui.observer, ui.states, ui.pulses)):
            self._board.on_presence(ui.mission.elapsed(self._received[1]), self._presence.answers)
        if self._stopping:
            ui.events.publish(STOP)
