"""When what agents report became true: what a returning observer is judged by."""

from __future__ import annotations

from typing import Dict, List, Optional, Set, Tuple

from pursue_runtime.event_words import parse_report, parse_word, said_at
from pursue_runtime.state import SystemState


class BecameTrue:
    """The moments (seconds) at which agents reported something for the first time, by its event."""

    def __init__(self) -> None:
        self._moments: Dict[str, List[float]] = {}
        self._known: Set[Tuple[str, str, Optional[int]]] = set()

    def note(self, agent: str, text: str, now: float) -> None:
        """An agent reports something; from the second time on that is no news."""
        report = parse_report(text) or parse_word(text)
        if report is not None and (agent, report.event, report.as_of) not in self._known:
            self._known.add((agent, report.event, report.as_of))
            self._moments.setdefault(report.event, []).append(now)

    def hear(self, text: str, now: float) -> None:
        """The observer gets a report; one that carries no time may count from now on."""
        report = parse_report(text) or parse_word(text)
        if report is not None and said_at(text) is None:
            self._moments.setdefault(report.event, []).append(now)

    def moment(self, state: SystemState, before: SystemState, now: float) -> float:
        """When what the state shows has happened, if the observer was away after the state `before`: when an agent
        reported it, as far as that is not before that state; what nobody has reported, when the state has it. Nobody
        that an observer reaches may have seen the state that was published last: then it begins before that."""
        reported = self._moments.get(state.event, []) if state.seq > before.seq else []
        moments = [max(before.stamp, min(moment, now)) for moment in reported] or [min(state.stamp, now)]
        return min(moments, key=lambda moment: abs(moment - state.stamp))
