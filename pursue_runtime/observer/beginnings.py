"""In which state each agent came to its location, or did something at once; which reports are about what was before."""

from __future__ import annotations

from typing import Dict, Optional, Sequence, Tuple

from pursue_runtime.model import Move


class Beginnings:
    """The numbers of the states in which agents came to their locations, and did what is done at once.

    A report is published until it is answered; one that a cut link brings late must not end what begins after it, and
    what is done at once is not done twice because its word comes twice.
    """

    def __init__(self) -> None:
        self._numbers: Dict[str, int] = {}
        self._done: Dict[Tuple[str, str], int] = {}  # by agent and event

    def of(self, agent: str, event: str = "") -> int:
        """Return the number of the state in which the agent came to its location, or has since then done the event at
        once; 0: at the start, or not known."""
        return max(self._numbers.get(agent, 0), self._done.get((agent, event), 0))

    def on_moves(self, moves: Sequence[Move], seq: int) -> None:
        """Take the moves that lead to the state of this number; the first is that of the one who does it."""
        self._numbers.update({name: seq for name, edge in moves if edge.source != edge.target})
        for name, edge in moves[:1]:
            self._done[name, edge.word] = seq

    def forget(self) -> None:
        """Take that nothing is known of them any more: every report counts."""
        self._numbers.clear()
        self._done.clear()

    def is_over(self, agent: str, event: str, as_of: Optional[int]) -> bool:
        """Return True for a report of the event, by one that knew the state of this number, if the agent has come to
        its location since, or has done that at once; None: a report without a number, which counts in any state."""
        return as_of is not None and as_of < self.of(agent, event)
