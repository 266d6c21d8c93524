"""What the terminal shows of the topics, in the thesis's modes `e` (only events) and `f` (all communication)."""

from __future__ import annotations

from typing import Sequence, Tuple

import rospy
from std_msgs.msg import String

from pursue_runtime.event_words import EVENTS, SYSTEM_STATE
from pursue_runtime.nodes.node import subscribe
from pursue_runtime.nodes.positions import settings_of
from pursue_runtime.nodes.ui_state import UIState
from pursue_runtime.state import parse_state
from pursue_runtime.ui.mission_view import traffic_lines
from pursue_runtime.ui.options import ALL_TOPICS, IN_WORDS


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
