"""States of the mission as messages on `pursue/state`, and the connection of each node to them."""

from __future__ import annotations

from typing import Callable

import rospy
from pursue_msgs.msg import AutomatonLocation, ClockValue, Variable
from pursue_msgs.msg import SystemState as Message

from pursue_runtime.state import AGENT_LISTS, STATUSES, SystemState
from pursue_runtime.words import STATE


def message_of(state: SystemState) -> Message:
    """Return the state as a message."""
    return Message(
        seq=state.seq,
        stamp=rospy.Time.from_sec(state.stamp),
        time_unit=state.unit,
        mission=state.mission,
        status=state.status,
        reason=state.reason,
        event=state.event,
        agent=state.agent,
        plan=state.plan,
        automata=[AutomatonLocation(name, location) for name, location in state.locations.items()],
        variables=[Variable(name, value) for name, value in state.values.items()],
        clocks=[ClockValue(name, value) for name, value in state.clocks.items()],
        **{key: list(getattr(state, key)) for key in AGENT_LISTS},
    )


def state_of(message: Message) -> SystemState:
    """Return the state that a message holds. Raises ValueError for one that no observer publishes."""
    if message.status not in STATUSES:
        raise ValueError(f"status is {message.status!r}; expected one of {', '.join(STATUSES)}")
    if not 0.0 < message.time_unit < float("inf"):
        raise ValueError(f"time_unit is {message.time_unit!r}; expected a number of seconds greater than 0")
    return SystemState(
        seq=message.seq,
        stamp=message.stamp.to_sec(),
        locations={automaton.name: automaton.location for automaton in message.automata},
        values={variable.name: variable.value for variable in message.variables},
        clocks={clock.name: clock.value for clock in message.clocks},
        event=message.event,
        agent=message.agent,
        status=message.status,
        reason=message.reason,
        unit=message.time_unit,
        plan=message.plan,
        mission=message.mission,
        **{key: tuple(getattr(message, key)) for key in AGENT_LISTS},
    )


def subscribe_states(on_state: Callable[[SystemState, str], None], topic: str = STATE) -> rospy.Subscriber:
    """Subscribe to the states of the mission: `on_state` gets each, and the name of the node that published it.

    A message that no observer publishes is logged and changes nothing.
    """

    def receive(message: Message) -> None:
        publisher = message._connection_header.get("callerid", "")
        try:
            state = state_of(message)
        except ValueError as problem:
            rospy.logwarn("not a system state, from %s: %s", publisher, problem)
            return
        on_state(state, publisher)

    return rospy.Subscriber(topic, Message, receive, queue_size=1000, tcp_nodelay=True)
