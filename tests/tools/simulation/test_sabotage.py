"""What must never be is seen: each part of the run time is sabotaged in turn."""

from __future__ import annotations

import inspect
import sys
import textwrap
from typing import Mapping, Sequence, Tuple

import pytest
from stages import THIEF, files, missions, sabotaged, stage

from pursue_gen.tools.simulation.mission import SimulatedMission
from pursue_gen.tools.simulation.outcome import FAILED, Outcome, Settings
from pursue_runtime.controller.scheduler import CommandScheduler
from pursue_runtime.observer.automata import Automata
from pursue_runtime.observer.mission import Mission
from pursue_runtime.orders import Order

SABOTAGE: Mapping[str, Tuple[type, str, str, str, str]] = {
    "a clock that is not reset": (
        Automata, "take", "dict.fromkeys(edge.resets, now)", "dict.fromkeys(edge.resets[:0], now)", "clocks do not fit"
    ),
    "a variable that is not set": (
        Automata, "take", "self._values.update(edge.assign)", "self._values.update({})", "is no step of the model"
    ),
    "a number that is skipped": (Mission, "_take", "self.seq + 1", "self.seq + 2", "states after 1 are missing"),
    "an order for another place": (
        CommandScheduler,
        "_new_orders",
        "return [order for order in standing",
        'return [order._replace(location="going_a_to_b_") for order in standing',
        "(going_a_to_b_), and began",
    ),
}  # fmt: skip
"""A class of the run time, its method, a part of its code, what takes the place of that, and what is reported."""


@pytest.mark.parametrize("what", SABOTAGE)
def test_sabotage_of_the_run_time_is_seen(what: str, monkeypatch: pytest.MonkeyPatch) -> None:
    kind, method, old, new, problem = SABOTAGE[what]
    source = textwrap.dedent(inspect.getsource(getattr(kind, method)))
    assert old in source
    scope = dict(vars(sys.modules[kind.__module__]))
    exec(compile("from __future__ import annotations\n" + source.replace(old, new), method, "exec"), scope)
    monkeypatch.setattr(kind, method, scope[method])
    assert_seen(missions(THIEF, 10, Settings("random"), stage(THIEF)), problem)


def test_another_command_is_seen() -> None:
    path = "src/controller_polBot1/config/strategy.yaml"
    old = "do: polBot1_a2b\n    agent: polBot1\n    from: a\n    to: going_a_to_b"
    stage = sabotaged(THIEF, path, old, old.replace("a2b", "a2d").replace("a_to_b", "a_to_d"))
    outcomes = missions(THIEF, 10, Settings("random"), stage)
    assert_seen(outcomes, "the strategy does not command it here")


def assert_seen(outcomes: Sequence[Outcome], problem: str) -> None:
    failed = [outcome for outcome in outcomes if outcome.end == FAILED]
    assert failed
    assert any(problem in outcome.reason for outcome in failed), failed[0].reason


def test_a_command_at_another_time_is_seen() -> None:
    """The controller's zone opens sooner than the strategy's."""
    name = "ecobot/ecobot"
    path = "src/controller_ecoBot/config/strategy.yaml"
    text = files(name)[path].decode()
    late = next(line for line in text.splitlines() if " < CecoBot" in line and "- 1 < " in line)
    early = sabotaged(name, path, late, late.replace("1 <", "0 <"))
    outcomes = missions(name, 10, Settings("random", until=100.0), early)
    reasons = [outcome.reason for outcome in outcomes if outcome.end == FAILED]
    assert any("is not what the strategy prescribes" in reason or "the observer warns" in reason for reason in reasons)


def test_an_order_as_of_an_old_state_is_seen() -> None:
    mission = SimulatedMission(stage(THIEF), Settings("random"), 1, None)
    mission.command_robot("controller_polBot1", Order("polBot1", "polBot1_a2b", 2, "going_a_to_b"), 1, 2, False)
    assert any("though it knows state 2" in problem for problem in mission.run().problems)
