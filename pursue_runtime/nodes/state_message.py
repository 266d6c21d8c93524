"""States of the mission as messages on `pursue/state`, the connection of each node to them, and what nodes of the
thesis have of them: its `print_state` (its listing 4.4), and plain words."""

from __future__ import annotations

import sys
from functools import partial
from typing import Any, Callable, Dict, Optional, Sequence, Tuple

import rospy
from pursue_msgs.msg import AutomatonLocation, ClockValue, Variable
from pursue_msgs.msg import SystemState as Message
from std_msgs.msg import String

from pursue_runtime.event_words import EVENTS, FINISH, PLAIN_WORDS, STATE
from pursue_runtime.nodes.alarm import Later
from pursue_runtime.nodes.node import Ending, subscribe
from pursue_runtime.parameters import ParameterError, flag
from pursue_runtime.state import ENDED, LISTS, WON, SystemState, state_lines
from pursue_runtime.state_checks import names_problem, state_problem

SAME = ("seq", "mission", "status", "reason", "event", "agent", "commanded", "plan")
"""The fields that a message has as a state has them."""

THROTTLE = 10.0
"""Seconds for which the log has one line about messages that are no states."""


def message_of(state: SystemState) -> Message:
    """Return the state as a message."""
    return Message(
        stamp=rospy.Time.from_sec(state.stamp),
        time_unit=state.unit,
        automata=[AutomatonLocation(name, location) for name, location in state.locations.items()],
        variables=[Variable(name, value) for name, value in state.values.items()],
        clocks=[ClockValue(name, value) for name, value in state.clocks.items()],
        **{key: getattr(state, key) for key in SAME},
        **{key: list(getattr(state, key)) for key in LISTS},
    )


def state_of(message: Message) -> SystemState:
    """Return the state that a message holds. Raises ValueError for one that no observer publishes."""
    lists: Dict[str, Any] = {key: tuple(getattr(message, key)) for key in LISTS}
    parts = {key: [each.name for each in getattr(message, key)] for key in ("automata", "variables", "clocks")}
    problems = [names_problem(key, names) for key, names in (*parts.items(), *lists.items()) if names]
    state = SystemState(
        stamp=message.stamp.to_sec(),
        unit=message.time_unit,
        locations={automaton.name: automaton.location for automaton in message.automata},
        values={variable.name: variable.value for variable in message.variables},
        clocks={clock.name: clock.value for clock in message.clocks},
        **{key: getattr(message, key) for key in SAME},
        **lists,
    )
    problem = next(filter(None, problems), "") or state_problem(state)
    if problem:
        raise ValueError(problem)
    return state


def subscribe_states(
    on_state: Callable[[SystemState, str], None],
    ending: Ending,
    topic: str = STATE,
    on_malformed: Callable[[], None] = lambda: None,
) -> rospy.Subscriber:
    """Subscribe to the states of the mission: `on_state` gets each, and the name of the node that published it.

    A message that no observer publishes is logged and changes nothing; `on_malformed` is called for each of them.
    """

    def receive(message: Message) -> None:
        publisher = message._connection_header.get("callerid", "")
        try:
            state = state_of(message)
        except ValueError as problem:
            rospy.logwarn_throttle(THROTTLE, f"not a system state, from {publisher}: {problem}")
            on_malformed()
            return
        on_state(state, publisher)

    return subscribe(topic, Message, receive, ending, queue_size=1000, tcp_nodelay=True)


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


class PlainWords:
    """Publishes the events of the states that follow `known`, each once, and `Finish!` when the mission is won."""

    def __init__(self, known: SystemState) -> None:
        """Raises ParameterError where the topic is remapped to one on which words count."""
        if rospy.resolve_name(PLAIN_WORDS) == rospy.resolve_name(EVENTS):
            raise ParameterError(f"{PLAIN_WORDS} is remapped to {EVENTS}, where its words would count as reports")
        self._seq, self._ended = known.seq, known.status in ENDED
        self._publisher = rospy.Publisher(PLAIN_WORDS, String, queue_size=1000, tcp_nodelay=True)

    def on_state(self, state: SystemState) -> None:
        """Publish what led to a state. Raises rospy.ROSException while the node is going down."""
        if state.seq > self._seq:
            self._seq = state.seq
            if state.event:
                self._publisher.publish(state.event)
        if state.status in ENDED and not self._ended:
            self._ended = True
            if state.status == WON:
                self._publisher.publish(FINISH)
