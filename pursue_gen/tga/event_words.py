"""The words of events: how a step of the network is called on the topics, in strategies and in the model file."""

from __future__ import annotations

from pursue_gen.language.symbols import UNDER_WAY, Role, role_of
from pursue_gen.tga.network import Edge


def event_word(automaton: str, edge: Edge) -> str:
    """The word of an edge of that automaton: its channel, or for a step of its own `<automaton>_<source>2<target>`.

    So `bot1_a2c` sets off, `bot1_going_a_to_c2c` has arrived. The thesis calls the inner step of reachObj
    `reachObj_going_initial_location2unlocked`; so do we.
    """
    if edge.sync is not None:
        return edge.sync.channel
    counts = role_of(automaton) is Role.REACH and edge.leaves not in UNDER_WAY
    going = "going_" if counts else ""  # as the thesis writes it: no agent is on its way
    return f"{automaton}_{going}{edge.source}2{edge.target}"
