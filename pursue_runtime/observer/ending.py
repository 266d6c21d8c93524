"""When a mission ends in which nothing is to be reached, and what was kept until then.

It ends at its time, at the word of an operator, or when all is answered. What is due when its end begins is answered
first. Times are time units.
"""

from __future__ import annotations

from typing import Dict, Iterator, List, Mapping, NamedTuple, Optional, Set, Tuple

from pursue_runtime.model import Model, Move, Position
from pursue_runtime.sentences import quoted
from pursue_runtime.zones import EPSILON


class Kept(NamedTuple):
    """How often what was due of an objective came in time, and after how many time units at the latest."""

    times: int = 0
    longest: float = 0.0


class Ending:
    """The end of one mission; nothing of it where there is a goal."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self._kept: Dict[str, Kept] = {}
        self._ahead: Dict[str, float] = {}  # time units by which clocks of orders that were wanted sooner are ahead
        self._is_whole = True  # all of the mission was seen
        self._is_quiet = model.ends is not None and model.ends.after is None  # it ends when all is answered
        self._awaited: Optional[Set[str]] = None  # the objectives that are answered first; None: its end has not begun

    @property
    def begins(self) -> Tuple[float, ...]:
        """So many time units after the start its end begins; none where no time has to come any more."""
        ends = self.model.ends
        if ends is None or ends.after is None or self._awaited is not None or self._is_quiet:
            return ()
        return (ends.after,)

    def begin(self, position: Position) -> None:
        """Wait for no answers but those that are due here."""
        if self._awaited is None:
            self._awaited = set(self._due(position))

    def on_time(self, position: Position) -> None:
        """Begin the end: its time has come."""
        if self.model.ends is not None and self.model.ends.answered:
            self._is_quiet = True
        else:
            self.begin(position)

    def on_order(self, clocks: Mapping[str, float]) -> None:
        """Take that an order has started these clocks, with their values when it came."""
        self._ahead.update(clocks)

    def on_cancel(self, moves: Tuple[Move, ...]) -> None:
        """Take that what was due is wanted no longer."""
        for name, edge in moves:
            for bound in self.model.automaton(name).invariants[edge.source]:
                self._ahead.pop(bound.left, None)
            if self._awaited is not None:
                self._awaited.discard(name)

    def on_moves(self, moves: Tuple[Move, ...], clocks: Mapping[str, float]) -> None:
        """Take what an event does, at the time of these clocks: some of it may be an answer."""
        for name, edge in moves:
            bounds = self.model.automaton(name).invariants if name in self.model.promises else {}
            due = bounds.get(edge.source)
            if due and not bounds[edge.target] and (name, edge.target) not in self.model.bad:
                times, longest = self._kept.get(name, Kept())
                clock = due[0].left
                self._kept[name] = Kept(times + 1, max(longest, clocks[clock] - self._ahead.pop(clock, 0.0)))
                if self._awaited is not None:
                    self._awaited.discard(name)

    def adopt(self) -> None:
        """Take that some of the mission was not seen."""
        self._is_whole = False

    def is_over(self, position: Position) -> bool:
        """Return True where nothing is waited for any more."""
        if self._awaited is not None:
            return not self._awaited
        if not self._is_quiet or any(self._due(position)):
            return False
        ends = self.model.ends
        by_time = ends is not None and ends.after is not None
        return by_time or any(name in self._kept for name in self._answered())

    @property
    def revision(self) -> Tuple[object, ...]:
        """Return a value that changes with what is waited for."""
        return self._is_quiet, None if self._awaited is None else tuple(sorted(self._awaited))

    @property
    def says(self) -> str:
        """Return what its end waits for, as a sentence; "" where it has not begun."""
        if self._awaited is None:
            after = self.model.ends is not None and self.model.ends.after is not None
            return "the mission ends as soon as all is answered" if self._is_quiet and after else ""
        texts = "; ".join(self.model.promises[name].says for name in self._answered() if name in self._awaited)
        what = f"what is due is answered: {quoted(texts)}" if texts else "all orders are acknowledged"
        return f"the mission ends as soon as {what}"

    def kept(self) -> str:
        """Return what was kept, as a part of a sentence; "" where that is not known."""
        found: List[str] = []
        for name, promise in self.model.promises.items():
            times, longest = self._kept.get(name, Kept())
            text = promise.says
            if promise.kept and self._is_whole:
                often = "once" if times == 1 else f"{times} times"
                text += (
                    f" ({promise.kept} {often}, after {longest:.1f} at most)" if times else f" (never {promise.kept})"
                )
            found.append(text)
        return quoted("; ".join(found))

    def _answered(self) -> Iterator[str]:
        return (name for name, promise in self.model.promises.items() if promise.is_answered)

    def _due(self, position: Position) -> Iterator[str]:
        """Return the objectives whose answer is due here."""
        for name in self._answered():
            if self.model.automaton(name).invariants[position.locations[name]]:
                yield name


def has_come(moments: Tuple[float, ...], passed: float) -> bool:
    """Return True where one of these moments, in time units since the start, has come after so many of them."""
    return any(passed >= moment - EPSILON for moment in moments)
