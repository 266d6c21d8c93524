"""Faults are named, drawn from the seed, and happen to the messages that they are drawn for."""

from __future__ import annotations

from typing import Any, List

import pytest

from pursue_gen.diagnostics import PursueError
from pursue_gen.tools.simulation.connections import Connections, drawn_share
from pursue_gen.tools.simulation.event_queue import EventQueue, Timer
from pursue_gen.tools.simulation.faults import FAULTS, FaultPlan, read_faults


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


def test_faults_of_messages_may_have_another_probability() -> None:
    assert read_faults("junk, loss=0.5") == ("loss=0.5", "junk")
    assert 120 < len(sent(trouble("loss=0.5"))) < 280
    for text in ("loss=2", "loss=often", "junk=0.5", "rain=0.5", "loss=", "late=0.1", "late=inf", "late=long"):
        with pytest.raises(PursueError) as refused:
            read_faults(text)
        assert refused.value.exit_status == 2
        assert "no fault with such a number" in refused.value.diagnostics[0].message


def test_who_is_late_may_be_so_by_another_time() -> None:
    assert read_faults("late=60") == ("late=60",)
    for kind, most in (("late", 15.0), ("late=60", 60.0)):
        about = trouble(kind)
        late = [took - 8.0 for took in (about.duration(5.0, 8.0, 6.0) for _ in range(400)) if took != 6.0]
        assert min(late) >= 0.2 and most / 2 < max(late) <= most and about.happened == {"late": len(late)}


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


def test_a_message_comes_in_time_even_if_the_one_before_it_takes_longer() -> None:
    """Two messages, the first with a later deadline: the second one is not held up beyond its own."""
    queue, came = EventQueue(1000.0), []
    for seed in range(20):
        connections = Connections(queue, trouble(), str(seed))
        connections.send("word:x", 0.1, lambda: came.append(("first", queue.now)))
        connections.send("word:x", 0.02, lambda: came.append(("second", queue.now)))
    while queue.step():
        pass
    assert [name for name, _ in came].count("first") == [name for name, _ in came].count("second") == 20
    assert all(moment <= 1000.02 for name, moment in came if name == "second")
    assert any(moment > 1000.02 for name, moment in came if name == "first")


def test_where_messages_are_lost_the_others_leave_time_to_send_one_again() -> None:
    queue, came = EventQueue(1000.0), []
    connections = Connections(queue, trouble("loss"), "1", 0.1)
    for _ in range(200):
        connections.send("word:x", 0.1, lambda: came.append(queue.now))
    while queue.step():
        pass
    assert 150 < len(came) < 200
    assert max(came) <= 1000.02


def test_an_order_reaches_a_robot_that_is_disconnected_when_it_has_connected_again() -> None:
    queue, came = EventQueue(1000.0), []
    connections = Connections(queue, trouble("orders"), "1")
    for _ in range(200):
        connections.send_order(lambda: came.append(queue.now))
    while queue.step():
        pass
    assert len(came) == 200
    assert came.count(1000.0) > 150
    assert all(1000.5 <= moment <= 1002.0 for moment in came if moment != 1000.0)


def test_a_restart_lies_within_the_margin_and_there_is_none_where_that_is_too_short() -> None:
    def restarts(absence: float) -> List[float]:
        plans = [FaultPlan(("restart",), str(seed), 0.0, 30.0, ("controller_bot",), (), absence) for seed in range(50)]
        return [crash.seconds for plan in plans for crash in plan.crashes]

    assert len(restarts(0.5)) == 50 and max(restarts(0.5)) <= 0.5
    assert max(restarts(100.0)) <= 3.0
    assert restarts(0.0) == restarts(-1.0) == []


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
