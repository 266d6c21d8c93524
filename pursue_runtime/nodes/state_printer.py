"""The thesis's `print_state` (its listing 4.4): a node with ~print_state prints each state that it follows."""

from __future__ import annotations

import sys
from functools import partial
from typing import Callable, Optional, Sequence, Tuple

import rospy

from pursue_runtime.nodes.alarm import Later
from pursue_runtime.nodes.node import Ending
from pursue_runtime.parameters import flag
from pursue_runtime.state import SystemState, state_lines


class StatePrinter:
    """Prints on standard output, after the reaction to a state: nothing is delayed by a slow terminal."""

    def __init__(self, ending: Ending) -> None:
        """`write` gets the lines; a node that writes to a terminal itself replaces it. Raises ParameterError."""
        self.write: Optional[Callable[[Sequence[str]], object]] = None
        if flag(rospy.get_param("~", {}), "print_state"):
            later = Later("print_state", ending)
            self.write = lambda lines: later.do(partial(_print, lines))
        self._name = rospy.get_name().strip("/")
        self._last: Tuple[object, ...] = ()

    def on_state(self, state: SystemState) -> None:
        """Print a state that this node has taken, unless it is the last one again, as a heartbeat is."""
        key = (state.mission, state.seq, state.status)
        if self.write is not None and key != self._last:
            self._last = key
            self.write(state_lines(state, self._name))


def _print(lines: Sequence[str]) -> None:
    sys.stdout.write("".join(f"{line}\n" for line in lines))
    sys.stdout.flush()
