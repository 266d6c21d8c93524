"""In which state each agent came to its location, and which reports are about what it did before that."""

from __future__ import annotations

from typing import Dict, Iterable, Optional

from pursue_runtime.model import Move


class Beginnings:
    """The numbers of the states in which agents came to their locations.

    A report is published until it is answered; one that a cut link brings late must not end what begins after it.
    """

    def __init__(self) -> None:
        self._numbers: Dict[str, int] = {}

    def of(self, agent: str) -> int:
        """Return the number of the state in which the agent came to its location; 0: at the start, or not known."""
        return self._numbers.get(agent, 0)

    def on_moves(self, moves: Iterable[Move], seq: int) -> None:
        """Take the moves that lead to the state of this number."""
        self._numbers.update({name: seq for name, edge in moves if edge.source != edge.target})

    def forget(self) -> None:
        """Take that nothing is known of them any more: every report counts."""
        self._numbers.clear()

    def is_over(self, agent: str, as_of: Optional[int]) -> bool:
        """Return True for a report, by one that knew the state of this number, of what the agent had begun before it
        came to its location; None: a report without a number, which counts in any state."""
        return as_of is not None and as_of < self.of(agent)
