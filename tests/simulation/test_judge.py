"""The judge sees what must never be: each part of the run time is sabotaged in turn."""

from __future__ import annotations

import inspect
import sys
import textwrap
from typing import Any, Dict, Mapping, Sequence, Tuple

import pytest
from stages import THIEF, files, missions, sabotaged, solved, stage

from pursue_gen.simulation.commands import commands_of
from pursue_gen.simulation.judge import Judge, TakenStep
from pursue_gen.simulation.outcome import FAILED, Outcome, Settings
from pursue_runtime.controller.scheduler import CommandScheduler
from pursue_runtime.observer.automata import Automata
from pursue_runtime.observer.mission import Mission
from pursue_runtime.orders import Order
from pursue_runtime.state import SystemState

SABOTAGE: Mapping[str, Tuple[type, str, str, str, str]] = {
    "a clock that is not reset": (
        Automata, "take", "dict.fromkeys(edge.resets, now)", "dict.fromkeys(edge.resets[:0], now)", ", not 0.0"
    ),
    "a variable that is not set": (
        Automata, "take", "self._values.update(edge.assign)", "self._values.update({})", "is no step of the network"
    ),
    "a number that is skipped": (Mission, "_take", "self.seq + 1", "self.seq + 2", "state 3 follows state 1"),
    "an order for another place": (
        CommandScheduler,
        "_new_orders",
        "return [order for order in standing",
        'return [order._replace(location="going_a_to_b_") for order in standing',
        "wrong order: polBot1 gets the order",
    ),
}  # fmt: skip
"""A class of the run time, its method, a part of its code, what takes the place of that, and what the judge reports."""


@pytest.mark.parametrize("what", SABOTAGE)
def test_sabotage_of_the_run_time_is_seen(what: str, monkeypatch: pytest.MonkeyPatch) -> None:
    kind, method, old, new, problem = SABOTAGE[what]
    source = textwrap.dedent(inspect.getsource(getattr(kind, method)))
    assert old in source
    scope = dict(vars(sys.modules[kind.__module__]))
    exec(compile("from __future__ import annotations\n" + source.replace(old, new), method, "exec"), scope)
    monkeypatch.setattr(kind, method, scope[method])
    assert_seen(missions(THIEF, 10, Settings("random")), problem)


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
    assert any("was not due there" in o.reason or "the observer warns" in o.reason for o in outcomes if o.end == FAILED)


# The judge alone ------------------------------------------------------------------------------------------------------


def judge(faults: bool = False) -> Judge:
    on, (_, won) = stage(THIEF), solved(THIEF)
    return Judge(on.arena, commands_of(won.strategy), won.objective.bad, 0.1, faults)


def first(seq: int = 1, now: float = 0.0, **more: Any) -> Any:
    on = stage(THIEF)
    at: Dict[str, str] = {automaton.name: automaton.initial for automaton in on.model.automata}
    clocks = dict.fromkeys(on.model.clocks, now)
    state = SystemState(seq, now, at, dict(on.model.variables), clocks)
    return state._replace(**more)


def leaving(now: float, **more: Any) -> Any:
    """polBot1 leaves for b, which no strategy commands before reachObj is unlocked."""
    state = first(2, now)
    state.locations["polBot1"] = "going_a_to_b"
    state.values["PpolBot1"] = -12
    state.clocks["CpolBot1"] = 0.0
    return state._replace(event="polBot1_a2b", agent="polBot1", **more)


def test_a_mission_begins_where_the_network_does() -> None:
    watching = judge()
    watching.on_state(first(), 0.0)
    assert watching.problems == []
    watching = judge()
    watching.on_state(first(3), 0.0)
    assert "not where the network starts" in watching.problems[0]


def test_a_step_too_early_is_a_problem_without_faults_and_with_them_where_it_is_a_command() -> None:
    for faults in (False, True):
        watching = judge(faults)
        watching.on_state(first(), 0.0)
        watching.on_state(leaving(0.5), 0.5)
        assert "polBot1_a2b" in watching.problems[0]


def test_what_is_held_is_ordered_once_and_only_while_it_lasts() -> None:
    watching = judge()
    watching.on_state(first(), 0.0)
    watching.on_order(Order("polBot1", "polBot1_a2b", 2, "going_a_to_b"), 1, 1, False)
    assert "not what was last commanded" in watching.problems[0]


def test_an_order_as_of_an_old_state_is_a_problem() -> None:
    watching = judge()
    watching.on_state(first(), 0.0)
    watching.on_order(Order("polBot1", "polBot1_a2b", 2, "going_a_to_b"), 1, 2, False)
    assert "though state 2 is known" in watching.problems[0]


def test_a_state_may_be_published_again_but_not_another_one() -> None:
    watching = judge()
    watching.on_state(first(), 0.0)
    watching.on_state(first(now=1.0), 1.0)
    assert watching.problems == []
    changed = first(now=2.0)
    changed.locations["thief"] = "d"
    watching.on_state(changed, 2.0)
    assert "published again" in watching.problems[0]


@pytest.mark.parametrize("status, wrong", [("running", True), ("stopped", False)])
def test_the_clocks_of_a_mission_stand_still_once_it_has_ended(status: str, wrong: bool) -> None:
    watching = judge(faults=True)
    watching.on_state(first(), 0.0)
    ended = first(now=1.0, status=status)
    watching.on_state(ended, 1.0)
    assert watching.problems == []
    watching.on_state(ended._replace(stamp=2.0), 2.0)  # an observer that is back has heard a ping
    assert bool(watching.problems) is wrong
    assert not wrong or "is 1.0, not 2.0" in watching.problems[0]


def test_what_is_done_at_once_may_be_ordered_after_the_next_step_but_only_once() -> None:
    halt = Order("polBot1", "halt", 7, "going_a_to_b", at_once=True)
    for order, again, problem in (
        (halt, False, ""),
        (halt, True, ""),
        (halt._replace(seq=6), False, "not what was last commanded"),
        (halt._replace(location="b"), False, "not what was last commanded"),
    ):
        watching = judge(faults=True)
        watching.steps.append(TakenStep(7, "polBot1", "halt", "going_a_to_b", True))
        watching.steps.append(TakenStep(8, "polBot1", "polBot1_going_a_to_b2b", "b", False))
        watching.on_order(order, 9, 9, again)
        assert [problem in found for found in watching.problems] == ([True] if problem else [])
    watching = judge(faults=True)
    watching.steps.append(TakenStep(7, "polBot1", "halt", "going_a_to_b", True))
    watching.on_order(halt, 9, 9, False)
    watching.on_order(halt, 9, 9, False)
    assert "for the second time" in watching.problems[0]
