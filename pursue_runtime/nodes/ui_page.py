"""The page's side of the UI: what it shows, what pages ask for, whether the observer answers, and what comes after the
mission: the page stays until it is closed or the next mission of the launch is prepared.
"""

from __future__ import annotations

import os
import time
from typing import Any, Dict, Mapping, Optional, Tuple

import rospy

from pursue_runtime.event_words import FINISH, STOP
from pursue_runtime.folders import scenario_folder
from pursue_runtime.links import LOOK, Presence
from pursue_runtime.nodes.links import traffic
from pursue_runtime.nodes.node import start_thread
from pursue_runtime.nodes.positions import watch_positions
from pursue_runtime.nodes.ui_state import UIState
from pursue_runtime.nodes.ui_terminal import Typed
from pursue_runtime.sentences import Troubles, in_words
from pursue_runtime.state import LIVE, RUNNING, WAITING, SystemState
from pursue_runtime.ui.mission_view import MARGIN
from pursue_runtime.ui.page import BAD, GOOD, NOTE, Facts
from pursue_runtime.ui.page_server import ADDRESS, PageServer, format_address, open_page
from pursue_runtime.ui.past_missions import PastMissions, shown_missions, workspace_of
from pursue_runtime.ui.requests import PageRequest, Presses

NO_ANSWER = "The observer does not answer"

SETTLED = 10.0
"""Seconds of real time after the end after which no observer is expected that renames the journal of the mission."""

LOOKS_AT_FILES = 4
"""So many looks at the connections go by until the next look at the files of earlier missions."""


class UIPage:
    """The page of a UI; without `open` there is none, and nothing happens here."""

    def __init__(self, ui: UIState, typed: Typed) -> None:
        self.lock = ui.lock
        self._ui, self._typed = ui, typed
        self._board: Optional[PageServer] = None
        self._presses, self._presence, self._troubles = Presses(), Presence(), Troubles()
        self._received = (0.0, 0.0)  # when the last state came: Unix time, ROS time
        self._stopping = self._finishing = False
        self._next = False  # the nodes wait for the start of another mission
        self._ended = 0.0  # when the mission has ended, on the monotonic clock
        self._looks = 0
        self._recording = ""  # the file that the recorder writes
        own, scenario = ui.membership.own, ui.membership.scenario
        folder = scenario_folder(os.environ, scenario)
        self._past = PastMissions(folder, own.mission, workspace_of(own.folder))

    def open(self, settings: Mapping[str, Any]) -> None:
        """Serve the page, where one is wanted. Raises ParameterError and other DataErrors."""
        ui = self._ui
        shown = ui.strategies, ui.at_doors
        self._board = open_page(ui.model, ui.options, settings, ui.membership.source, self, *shown)
        if self._board is not None:
            start_thread("presence", self._watch, ui.ending)
            watch_positions([robot.name for robot in ui.model.of_kind("robot")], ui.ending, self._board.on_positions)

    @property
    def stays(self) -> bool:
        """Return True if the page outlives the mission."""
        return self._board is not None and self._ui.options.stay

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
            self._board.page.on_state(state, at)

    def on_plan(self, plan: Mapping[str, Any]) -> None:
        """Take a new plan, as `parse_plan` returns it."""
        if self._board is not None:
            self._board.page.add_plan(plan)

    def show(self) -> None:
        """Send the present view to the page."""
        if self._board is not None:
            self._board.show()

    def end(self, at: float, verdict: Tuple[int, str]) -> None:
        """Show the end of the mission."""
        self._ended, self._looks = time.monotonic(), 0  # now there are other files
        if self._board is not None:
            self._board.note(at, verdict[1], BAD if verdict[0] else GOOD)

    def after_end(self, state: SystemState) -> None:
        """Take a state that comes after the end: the next mission waits, or somebody else has started it."""
        if state.status in LIVE:
            self._ui.ending.renew()
        elif (state.status == WAITING) != self._next:
            self._next, self._looks = state.status == WAITING, 0
            self.show()

    def on_robots(self, node: str, values: Mapping[str, str]) -> None:
        """Show what is wrong with robots: `values` are those of a node's /diagnostics."""
        ui = self._ui
        state = ui.mission.state
        for text in self._troubles.take(node, values, state.reason if state is not None else ""):
            if self._board is not None and ui.verdict is None:
                self._board.note(ui.mission.elapsed(rospy.get_time()), in_words(text, ui.model.shown), BAD)

    def on_answer(self, at: float, order: str, accepted: bool, text: str) -> None:
        """Show the answer to an order."""
        if self._board is not None:
            self._board.page.on_answer(at, order, accepted, text)
            self._board.show()

    def on_recorder(self, file: str) -> None:
        """Take the name of the file that the recorder writes."""
        self._recording = file

    def close(self, why: str) -> Dict[str, str]:
        """Serve no more; return what the environment of a node that begins anew holds for its page."""
        if self._board is None:
            return {}
        web = self._board.web
        web.close(why)
        return {ADDRESS: format_address(web.port, web.token)}

    # What comes from the page -----------------------------------------------------------------------------------------

    def facts(self) -> Facts:
        """Return what the page shows."""
        ui, mission = self._ui, self._ui.mission
        answers = self._presence.answers or ui.verdict is not None
        now = mission.elapsed(rospy.get_time() if answers else self._received[1])
        at = mission.elapsed(mission.state.stamp) if mission.state is not None else 0.0
        known = Facts(ui.phase, ui.missing(), mission.state, at, now, ui.verdict, answers, self._received[0])
        return known._replace(stays=self.stays, offers=self._offers())

    def on_request(self, request: PageRequest) -> str:
        """Carry out a request of a page; return what to show there, "" for nothing."""
        ui, state = self._ui, self._ui.mission.state
        if request.do in self._offers():
            return self._leave(request.do)
        if ui.verdict is not None:
            return f"{request.word or request.do} is not possible now."
        if request.do == "stop":
            self._stopping = True
            ui.events.publish(STOP)
            return "" if self._presence.answers else f"{NO_ANSWER}: the mission is stopped as soon as it does."
        if request.do == "finish" and state is not None and state.status in LIVE and not ui.model.goal:
            self._finishing = True
            ui.events.publish(FINISH)
            return "" if self._presence.answers else f"{NO_ANSWER}: the mission ends as soon as it does."
        if not self._presence.answers:
            return f"{NO_ANSWER}: nothing was sent."
        if request.do == "start" and ui.can_start():
            ui.start()
            return ""
        if request.do == "order" and ui.is_running:
            ui.orders.order(request.word)
            return ""
        if not request.word or state is None or request.do == "order":
            return f"{request.word or request.do} is not possible now."
        self._typed.find()
        ends = {task.word for task in self._typed.given}
        begins = {offer.word for offer in self._typed.offers if offer.opens <= MARGIN}
        word, remark = self._presses.word(request, state, ends if request.do == "done" else begins)
        if word:
            ui.events.publish(word)
        return remark

    def _offers(self) -> Tuple[str, ...]:
        """What a page may ask for after the mission."""
        if not self.stays or self._ui.verdict is None:
            return ()
        is_over = self._ui.mission.state is not None and self._ui.mission.state.status != WAITING
        can_close = not self._ui.membership.again  # else the launch goes on, and would open the page again
        return (*(("next",) if self._next or not is_over else ()), *(("close",) if can_close else ()))

    def _leave(self, do: str) -> str:
        """Prepare the next mission, in a process that begins anew; or end."""
        if do == "next":
            self._ui.ending.renew()
        elif self._ui.verdict is not None:
            self._ui.ending.end(self._ui.verdict[0])
        return ""

    # Whether the observer answers -------------------------------------------------------------------------------------

    def _watch(self) -> None:
        """Look at the connections with the observer; publish `_stop_` again until the mission has ended."""
        while not self._ui.ending.called:
            with self.lock:
                self._look()
                state, start = self._ui.mission.state, self._ui.mission.start
                is_settled = self._next or not self.stays or time.monotonic() > self._ended + SETTLED
            is_live = state is not None and state.status in LIVE
            if self._board is not None and not is_live and self._looks % LOOKS_AT_FILES == 0:
                self._board.show_missions(shown_missions(self._past.read(self._recording), start, is_settled))
            self._looks += 1
            time.sleep(LOOK)

    def _look(self) -> None:
        ui = self._ui
        if not ui.observer or ui.verdict is not None or self._board is None:
            return
        if self._presence.look(*traffic(ui.observer, ui.states, ui.pulses)):
            at, answers = ui.mission.elapsed(self._received[1]), self._presence.answers
            text = "the observer answers again" if answers else "the observer does not answer"
            self._board.note(at, text, NOTE if answers else BAD)
        if self._stopping:
            ui.events.publish(STOP)
        state = ui.mission.state
        if self._finishing and state is not None and state.status == RUNNING and not state.reason:
            ui.events.publish(FINISH)  # no state has answered it
