"""Limits and interrupts end the checker in all that it does, and a limit that is not hit changes nothing."""

from __future__ import annotations

from fractions import Fraction
from typing import Callable, Dict
from unittest import mock

import pytest

from pursue_gen.diagnostics import PursueError
from pursue_gen.outcomes import LimitHit
from pursue_gen.proof import simplify
from pursue_gen.proof.checker import verify
from pursue_gen.proof.closed_loop import ClosedLoop, Depth
from pursue_gen.proof.worst_case import worst_case
from pursue_gen.synthesis.limits import LimitMonitor, Limits
from pursue_gen.synthesis.strategy import Strategy
from tests.proof.test_checker import REACH, automaton, block, edge, moves, network

NOW = Fraction(0)
NET = network(automaton("bot", "a win", edge("a", "a", "x>=1", resets="x"), edge("a", "win", f"y>={10**9}")))
AGAIN, LEAVE = moves(NET, ("bot", 0)), moves(NET, ("bot", 1))
LONG = Strategy((block(NET, "a", [f"x<1,y<{10**9}"], (f"x>=1,y<{10**9}", AGAIN), (f"y>={10**9}", LEAVE)),))
"""Who acts at once wins after 10⁹ moves."""


def loop() -> ClosedLoop:
    return ClosedLoop(NET, REACH, LONG, NOW, None)


USES: Dict[str, Callable[[LimitMonitor], object]] = {
    "everything": lambda monitor: loop().everything(Depth(True, True, 10**9), monitor),
    "ends": lambda monitor: loop().ends(Depth(True, True, 10**9), monitor),
    "covered": lambda monitor: loop().covered(monitor),
    "latest": lambda monitor: loop().latest(1, 10**9, monitor),
}


@pytest.mark.parametrize("use", USES)
def test_what_ends_the_monitor_ends_every_search(use: str) -> None:
    for problem in (KeyboardInterrupt, MemoryError, LimitHit([])):
        with mock.patch.object(LimitMonitor, "check", side_effect=problem), pytest.raises(
            problem if isinstance(problem, type) else type(problem)
        ):
            USES[use](LimitMonitor())


def test_what_ends_the_monitor_ends_the_search_for_fewer_zones() -> None:
    with mock.patch.object(LimitMonitor, "check", side_effect=KeyboardInterrupt), pytest.raises(KeyboardInterrupt):
        simplify.simplified(NET, LONG, NOW)
    with pytest.raises(PursueError) as failure:
        simplify.simplified(NET, LONG, NOW, limits=Limits(seconds=1e-9))
    assert failure.value.exit_status == 5


@pytest.mark.parametrize("use", ["everything", "ends"])
def test_a_search_without_an_end_is_ended_while_it_is_under_way(use: str) -> None:
    with pytest.raises(PursueError) as failure:
        USES[use](LimitMonitor(Limits(seconds=0.3)))
    assert failure.value.exit_status == 5


def test_no_memory_is_a_limit() -> None:
    with mock.patch.object(LimitMonitor, "check", side_effect=MemoryError), pytest.raises(PursueError) as failure:
        verify(NET, REACH, LONG)
    assert "with the memory that there is" in failure.value.diagnostics[0].message


def test_the_worst_time_is_not_known_where_there_is_no_time_to_find_it() -> None:
    assert worst_case(NET, REACH, LONG, limits=Limits(seconds=1e-9)) is None


def test_a_limit_on_states_is_no_failure_of_the_strategy() -> None:
    report = verify(NET, REACH, LONG, limit=7)
    assert not report.ok and report.reason == "limit: not decided within 7 symbolic states"
