"""What other nodes have seen of the mission: the second witness, beside the journal."""

from __future__ import annotations

from typing import Dict, List, Mapping, NamedTuple, Optional, Tuple

from pursue_runtime.observer.records import Rank
from pursue_runtime.state import ENDED, LIVE, WAITING, SystemState

PATIENCE = 5.0
"""Seconds of real time for which an observer that starts waits for what other nodes have seen."""

SAME = 1e-3
"""Seconds by which two nodes may see the reset of a clock apart: stamps and clocks are rounded in messages."""


class Restart(NamedTuple):
    """How a restarted observer goes on: from the state to `adopt`; else with a safe stop for the reason `stop`; else
    from where its journal leads."""

    adopt: Optional[SystemState] = None
    stop: str = ""


def find_state(
    own: SystemState,
    damage: str,
    after: float,
    seen: Mapping[str, SystemState],
    begun: bool = True,
    reached: Rank = (0, False),
) -> Restart:
    """Return where the mission is, from the state to which the journal leads and those that other nodes have seen last.

    `damage`: why the journal is not complete ("": it is); `after`: states up to that moment (seconds) are of an earlier
    mission; `seen`: by the name of the node; `begun`: a mission has been under way in this launch; `reached`: how far
    this mission has come at least.
    """
    known = max(_rank(own), reached)
    if known != _rank(own) and not damage:
        damage = f"it leads to state {own.seq}, and the mission had {_words(reached)}"
    why = f"the observer was restarted, and its journal is not complete ({damage})" if damage else ""
    if own.status in ENDED and not damage:
        return Restart()
    newest = _newest({node: state for node, state in seen.items() if _counts(state, own, after)})
    if not newest:
        return Restart(stop=f"{why}; no other node has seen a state of this mission" if why else "")
    nodes = " and ".join(sorted(newest))
    state, *others = sorted(newest.values(), key=lambda state: -state.stamp)
    if not begun and not why and own.status == WAITING:
        return Restart(stop=other_launch(nodes, state) if state.status in LIVE else "")
    if why and _rank(state) < known:
        before = f"it leads to state {own.seq}" if known == _rank(own) else f"the mission had {_words(reached)}"
        return Restart(stop=f"{why}; {before}, and {nodes} know of state {state.seq} only")
    if not why and _rank(state) < _rank(own):
        return Restart()
    if any(_differs(state, other) for other in others):
        return Restart(stop=f"{why or 'the observer was restarted'}; {nodes} have seen different states {state.seq}")
    if not why and _rank(state) == _rank(own):
        contradicts = _place(state) != _place(own)
        return Restart(stop=unknown_state(own, nodes, state)) if contradicts else Restart()
    return Restart(adopt=state)


def mission_seen(seen: Mapping[str, SystemState], after: float) -> Optional[str]:
    """Return the id of the mission under way that was seen last; None where there was none after that moment."""
    states = [state for state in seen.values() if state.status in LIVE and state.stamp > after]
    return max(states, key=lambda state: state.stamp).mission if states else None


def contradicts(own: SystemState, after: float, state: SystemState) -> bool:
    """Return True if a state that another node has seen shows that the observer does not know its own mission."""
    if own.status in ENDED or state.status not in LIVE or not _counts(state, own, after):
        return False
    return state.seq > own.seq or (state.seq == own.seq and _place(state) != _place(own))


def unknown_state(own: SystemState, node: str, state: SystemState) -> str:
    """Return the reason of a safe stop."""
    return f"{node} knows of a state {state.seq} that the observer, in state {own.seq}, does not know"


def other_launch(node: str, state: SystemState) -> str:
    """Return the reason of a safe stop."""
    return f"{node} knows of a state {state.seq} of this mission, which is under way in another launch: stop that first"


def _counts(state: SystemState, own: SystemState, after: float) -> bool:
    return state.mission == own.mission and state.status in (*LIVE, *ENDED) and state.stamp > after


def _rank(state: SystemState) -> Rank:
    return state.seq, state.status in ENDED


def _words(rank: Rank) -> str:
    return f"ended in state {rank[0]}" if rank[1] else f"come to state {rank[0]}"


def _newest(states: Mapping[str, SystemState]) -> Dict[str, SystemState]:
    best = max(map(_rank, states.values()), default=None)
    return {node: state for node, state in states.items() if _rank(state) == best}


def _place(state: SystemState) -> Tuple[object, ...]:
    return state.locations, state.values


def _differs(state: SystemState, other: SystemState) -> bool:
    """Return True if two states with one number are not the same one, apart from the time that has passed."""
    # An agent may become late or lost, acknowledge an order, or finish what others have not, without a new number.
    what, others = (
        each._replace(stamp=0.0, clocks={}, reason="", late=(), lost=(), orders=(), finished=())
        for each in (state, other)
    )
    return what != others or any(abs(a - b) > SAME for a, b in zip(_resets(state), _resets(other)))


def _resets(state: SystemState) -> List[float]:
    """The moments (seconds) at which the clocks were zero, in the order of their names."""
    return [state.stamp - value * state.unit for _, value in sorted(state.clocks.items())]
