"""Limits end whatever is done, also what checks none."""

from __future__ import annotations

import signal
import threading
from typing import List

import pytest

from pursue_gen.outcomes import LimitHit
from pursue_gen.synthesis.enforced import enforced
from pursue_gen.synthesis.limits import PROVING, Limits, memory_in_use, processor_time


def ends() -> None:
    """Works for as long as nothing ends it; then something is wrong."""
    end = processor_time() + 100
    while processor_time() < end:
        pass
    raise AssertionError


def test_work_that_checks_nothing_ends_at_the_limit_on_time() -> None:
    with pytest.raises(LimitHit) as problem, enforced(Limits(0.2), PROVING):
        ends()
    assert "no proof within the limit of 0.2 seconds of processor time" in problem.value.diagnostics[0].message


def test_work_that_checks_nothing_ends_at_the_limit_on_memory() -> None:
    kept: List[bytes] = []
    most = memory_in_use() + 200
    with pytest.raises(LimitHit) as problem, enforced(Limits(100.0, most)):
        while len(kept) < 4000:
            kept.append(bytes(range(256)) * 4096)
    kept.clear()
    assert f"the limit of {most} MiB of memory" in problem.value.diagnostics[0].message


def test_who_goes_on_at_a_limit_is_ended_again() -> None:
    hits = 0
    with pytest.raises(LimitHit), enforced(Limits(0.1)):
        while hits < 3:
            try:
                ends()
            except LimitHit:
                hits += 1
        ends()
    assert hits == 3


def test_afterwards_all_is_as_before() -> None:
    with enforced(Limits(50.0)):
        outer = signal.getsignal(signal.SIGALRM)
        with pytest.raises(LimitHit), enforced(Limits(0.1)):
            ends()
        assert signal.getsignal(signal.SIGALRM) is outer and signal.getitimer(signal.ITIMER_REAL)[1] > 0
    assert signal.getitimer(signal.ITIMER_REAL) == (0.0, 0.0)
    assert signal.getsignal(signal.SIGALRM) is signal.SIG_IGN


@pytest.mark.parametrize("limits", [Limits(), Limits(1e-9, wall=True)])
def test_without_a_limit_of_processor_time_nothing_is_changed(limits: Limits) -> None:
    with enforced(limits):
        assert signal.getitimer(signal.ITIMER_REAL) == (0.0, 0.0)


def test_in_other_threads_it_does_nothing() -> None:
    done: List[bool] = []

    def work() -> None:
        with enforced(Limits(1e-9, 1)):
            end = processor_time() + 0.6
            while processor_time() < end:
                pass
            done.append(True)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert done
