"""Faults are named, drawn from the seed, and happen to the messages that they are drawn for."""

from __future__ import annotations

from typing import Any, List

import pytest

from pursue_gen.diagnostics import PursueError
from pursue_gen.simulation.connections import Connections, drawn_share
from pursue_gen.simulation.event_queue import EventQueue, Timer
from pursue_gen.simulation.faults import FAULTS, FaultPlan, read_faults


def trouble(*kinds: str, seed: str = "1") -> FaultPlan:
    return FaultPlan(kinds, seed, 1000.0, 30.0, ("controller_bot1", "controller_bot2"), ("bot1", "bot2"))


def sent(about: FaultPlan, number: int = 400, latest: float = 0.1, machine: str = "", at: float = 0.0) -> List[Any]:
    """The number of each message that comes, and how long it took; one is sent each 0.05 s."""
    clockwork = EventQueue(1000.0 + at)
    wires, came = Connections(clockwork, about, "1"), []

    def send(k: int) -> None:
        moment = clockwork.now
        wires.send("word:x", latest, lambda: came.append((k, clockwork.now - moment)), machine)

    for k in range(number):
        clockwork.schedule(1000.0 + at + 0.05 * k, lambda k=k: send(k))
    while clockwork.step():
        pass
    return came


def test_names_all_and_none() -> None:
    assert read_faults("none") == read_faults("") == ()
    assert read_faults("all") == tuple(FAULTS)
    assert read_faults("loss, delay") == ("delay", "loss")


def test_an_unknown_name_is_refused_with_those_there_are() -> None:
    with pytest.raises(PursueError) as refused:
        read_faults("delay,rain")
    assert refused.value.exit_status == 2
    assert "rain" in refused.value.diagnostics[0].message
    assert "duplicates" in str(refused.value.diagnostics[0].hint)


def test_without_faults_messages_come_in_order_and_as_promised_at_the_latest() -> None:
    came = sent(trouble())
    assert [k for k, _ in came] == list(range(400))
    assert all(took <= 0.1 + 1e-9 for _, took in came)
    assert any(took == pytest.approx(0.1, abs=1e-5) for _, took in came)
    assert any(took < 1e-9 for _, took in came)


def test_what_happens_to_messages() -> None:
    lost, late, twice, overtaken = (sent(trouble(kind)) for kind in ("loss", "delay", "duplicates", "reorder"))
    assert 350 < len(lost) < 400
    assert [k for k, _ in late] == list(range(400))
    assert max(took for _, took in late) > 3.0
    assert 410 < len(twice) < 480
    assert sorted(k for k, _ in overtaken) == list(range(400))
    assert [k for k, _ in overtaken] != list(range(400))


def test_a_machine_that_is_cut_off_gets_all_messages_later() -> None:
    about = trouble("cut")
    assert about.cut is not None
    machine, begin, end = about.cut
    assert 1.0 <= end - begin <= 60.0
    came = sent(about, 20, machine=machine, at=begin - 1000.0 + 0.01)
    assert [k for k, _ in came] == list(range(20))
    assert came[0][1] >= end - begin - 0.02
    assert sent(about, 20, machine="another", at=begin - 1000.0)[0][1] <= 0.1


def test_the_same_seed_draws_the_same() -> None:
    kinds = tuple(FAULTS)
    one, other, third = trouble(*kinds, seed="7"), trouble(*kinds, seed="7"), trouble(*kinds, seed="8")
    facts = [(t.kinds, t.crashes, t.cut, t.breakdown, t.junk, t.offsets) for t in (one, other, third)]
    assert facts[0] == facts[1] != facts[2]


def test_each_of_several_kinds_is_in_some_missions_and_one_in_each() -> None:
    found = [trouble(*FAULTS, seed=str(seed)).kinds for seed in range(200)]
    assert all(found)
    assert all(60 < sum(kind in kinds for kinds in found) < 140 for kind in FAULTS)


def test_shares_have_extremes() -> None:
    import random

    draw = random.Random(1)
    shares = [drawn_share(draw) for _ in range(1000)]
    assert 180 < shares.count(0.0) < 320
    assert 180 < shares.count(1.0) < 320
    assert all(0.0 <= part <= 1.0 for part in shares)


def test_the_last_setting_of_an_alarm_counts() -> None:
    clockwork, rung = EventQueue(0.0), []
    alarm = Timer(clockwork, lambda: rung.append(clockwork.now))
    alarm.set(5.0)
    alarm.set(None, 3.0)
    alarm.set(7.0, 4.0)
    while clockwork.step():
        pass
    assert rung == [4.0]
    alarm.set()
    assert not clockwork.step()
