"""The end of a mission in which nothing is to be reached: not before its time, and nothing that is due is left open."""

from __future__ import annotations

from typing import Iterator, Mapping, Optional

from pursue_gen.language.network_names import AT_RISK
from pursue_gen.tga.objectives import clock_of, stated
from pursue_gen.tools.replay.game import Game
from pursue_gen.tools.replay.gaps import AROUND, OBSERVER
from pursue_gen.tools.replay.record import MissionRecord
from pursue_runtime.event_words import FINISH
from pursue_runtime.state import WAITING, SystemState


def wrong_end(
    record: MissionRecord, game: Game, last: SystemState, clocks: Mapping[str, float], tolerance: float
) -> Iterator[str]:
    """What is wrong with the last state of a mission that is won, with these clocks; `tolerance`, in time units, is how
    far it may be off."""
    scenario = game.scenario
    if scenario.reach:
        return
    start = next((state.stamp for state in record.states if state.status != WAITING), last.stamp)
    passed, said = (last.stamp - start) / last.unit, _finish(record, last)
    begun = None if said is None else (said - start) / last.unit
    for end in scenario.ends:
        after = float(end.after or 0)
        if begun is None and passed < after - tolerance:
            yield f"its status is won {after - passed:.2f} time units before the mission may end"
        if begun is None:
            begun = passed if end.answered else after
    for name, objective in stated(scenario).items():
        due = objective.is_answered and last.locations[name] == AT_RISK
        if begun is not None and due and passed - clocks[clock_of(name)] < begun - tolerance:
            yield f"its status is won, but {name} waits for an answer that was due when the end began"


def _finish(record: MissionRecord, last: SystemState) -> Optional[float]:
    """When an operator has said that the mission is to end; None: nobody did. The observer says that it has ended."""
    around = 0.0 if record.is_exact else AROUND
    words = (word for word in record.words if word.text == FINISH and word.node != OBSERVER)
    return next((word.at for word in words if word.at <= last.stamp + around), None)
