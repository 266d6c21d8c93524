"""Where the automata are at a moment: what was computed for it once is right as long as nothing has happened."""

from __future__ import annotations

from typing import Callable

import pytest

from pursue_runtime.model import Model, Move, Position
from pursue_runtime.observer.automata import Automata
from pursue_runtime.state import SystemState
from tests.runtime.models import model_data, mover

MODEL = Model(model_data(mover("bot", "robot", 3)))
SETS_OFF = (Move("bot", MODEL.automaton("bot").edges_from("a")[0]),)
NOW = 105.0


def automata() -> Automata:
    """They started five seconds ago, and a time unit lasts two seconds."""
    found = Automata(MODEL, 2.0)
    found.start(100.0)
    return found


def adopt(found: Automata) -> None:
    state = SystemState(7, NOW - 2.0, {"bot": "going_a_to_b", "reachObj": "unlocked"}, {"Prule": 0, "Pbot": -12},
                        {"Cbot": 0.0, "Creach": 3.0})
    found.adopt(state)


@pytest.mark.parametrize("change, expected", [
    (lambda found: found.take(SETS_OFF, NOW), ("going_a_to_b", -12, 0.0, 2.5)),
    (lambda found: found.turn(SETS_OFF, NOW - 1.0), ("going_a_to_b", -12, 0.5, 2.5)),
    (adopt, ("going_a_to_b", -12, 1.0, 4.0)),
    (lambda found: found.start(NOW - 1.0), ("a", 1, 0.5, 0.5)),
])
def test_what_happens_is_in_the_position_of_the_same_moment(
    change: Callable[[Automata], None], expected: object
) -> None:
    found = automata()
    before = found.position(NOW)
    assert shown(before) == ("a", 1, 2.5, 2.5)
    change(found)
    assert shown(found.position(NOW)) == expected
    assert shown(before) == ("a", 1, 2.5, 2.5), "states that were published stay as they are"


def test_another_moment_has_other_clocks() -> None:
    found = automata()
    clocks = [found.position(moment).clocks["Cbot"] for moment in (NOW, NOW + 1.0, NOW)]
    assert clocks == [2.5, 3.0, 2.5]


def shown(position: Position) -> object:
    return position.locations["bot"], position.values["Pbot"], position.clocks["Cbot"], position.clocks["Creach"]
