"""A mission whose journal is lost goes on from what other nodes have seen, or stops: no robot does anything twice."""

from __future__ import annotations

import os
import resource
import signal
from pathlib import Path
from typing import Callable, Tuple

import pytest
from launched_mission import LaunchedMission, launched
from ros_world import Ros
from test_faults import FOR_EVER, NODES, ORDERS, check_steps, check_time, orders_of

from pursue_runtime.observer.records import MARK, read_records

Build = Callable[..., Path]

pytestmark = pytest.mark.ros

STRANGE_STATES = Path(__file__).resolve().parent / "publish_states.py"


@pytest.fixture(scope="module")
def scenario(built: Build) -> Path:
    """The workspace."""
    return built("thesis/scenario_1")


def journal_of(run: LaunchedMission) -> Path:
    """The journal of the launch; those that were set aside have a number."""
    folder = run.folder / "home" / "pursue" / "scenario_1"
    (journal,) = [path for path in folder.glob("journal-*.jsonl") if path.name.count("-") == 1]
    return journal


def check_won(run: LaunchedMission) -> None:
    """The mission was won, each step was taken once, and each robot got each order once."""
    assert run.now().status == "won" and "The goal is reached" in run.verdict(), run.output()
    check_steps(run)
    check_time(run)
    assert orders_of(run) == ORDERS, run.output()


def test_a_journal_that_cannot_be_written_does_not_take_the_mission_back(
    ros: Ros, scenario: Path, tmp_path: Path
) -> None:
    with launched(ros, scenario, tmp_path, use_sim_time=True, delays="middle", speed=1, lost_after=FOR_EVER) as run:
        run.until_step("bot2_c2a")
        journal = journal_of(run)
        size = journal.stat().st_size  # no file of the observer may be longer from now on, as if the disk was full
        observer = run.pid("observer")
        resource.prlimit(observer, resource.RLIMIT_FSIZE, (size, size))
        run.until_step("bot1_inb")
        assert not journal.exists() and journal.with_name(journal.name + ".failed").stat().st_size <= size
        run.until(lambda: run.values("observer").get("journal") == "False")
        before = run.now()
        run.until_back("observer", run.kill("observer"))
        assert run.now().seq >= before.seq and run.values("observer")["journal"] == "True"
        run.until_over()
    check_won(run)


def emptied(journal: Path) -> None:
    """As after a power cut."""
    journal.write_bytes(b"")


def without_head(journal: Path) -> None:
    """Its first line is damaged."""
    content = bytearray(journal.read_bytes())
    content[20] ^= 1
    journal.write_bytes(content)


def full_of_brackets(journal: Path) -> None:
    """A line that no reader of JSON survives, in the middle."""
    first, *lines = journal.read_bytes().splitlines(keepends=True)
    journal.write_bytes(first + b"[" * 200000 + b"\n" + b"".join(lines))


DAMAGES: Tuple[Tuple[str, Callable[[Path], None]], ...] = (
    ("bot2_c2a", os.remove), ("bot1_going_c_to_b2b", emptied), ("bot1_inb", without_head),
    ("bot2_ina", full_of_brackets),
)
"""After which step what becomes of the journal, in one mission."""


def test_a_journal_that_is_lost_or_damaged_does_not_take_the_mission_back(
    ros: Ros, scenario: Path, tmp_path: Path
) -> None:
    with launched(ros, scenario, tmp_path, use_sim_time=True, delays="middle", speed=0.5, lost_after=FOR_EVER) as run:
        for step, damage in DAMAGES:
            run.until_step(step)
            before = run.now()
            journal, processes = journal_of(run), {node: run.kill(node) for node in ("observer", "UI")}
            damage(journal)
            for node, process in processes.items():
                run.until_back(node, process)
            assert run.now().seq >= before.seq, (step, run.output())
        run.until_over()
        kept = {path.name for path in journal_of(run).parent.glob("journal-*.jsonl")} - {journal_of(run).name}
    check_won(run)
    assert len(kept) == len(DAMAGES) - 1, "what was damaged is set aside"


def without_its_mark(journal: Path) -> None:
    """As with a backup of an hour ago: the journal is cut at the end of a record, and the master alone knows better."""
    cut(journal)
    os.remove(f"{journal}{MARK}")


def cut(journal: Path) -> None:
    """The first steps are left, each record whole."""
    journal.write_bytes(b"".join(journal.read_bytes().splitlines(keepends=True)[:3]))
    assert not read_records(str(journal)).damage


@pytest.mark.parametrize("damage", [without_head, os.remove, cut, without_its_mark])
def test_where_nobody_knows_the_mission_any_more_it_stops_with_the_reason(
    ros: Ros, scenario: Path, tmp_path: Path, damage: Callable[[Path], None]
) -> None:
    with launched(ros, scenario, tmp_path, use_sim_time=True, delays="middle", speed=1, lost_after=FOR_EVER) as run:
        run.until_step("bot1_inb")
        run.until(lambda: ("bot1", "bot1_inb") in run.orders())  # recorded later, perhaps
        journal = journal_of(run)
        for node in NODES:
            if node != "sim_clock":
                run.kill(node)
        damage(journal)
        orders = len(run.orders())
        status = run.until_over()
        reason = run.now()["reason"]
    assert status == "stopped" and "journal is not complete" in reason and "no other node" in reason, run.output()
    assert len(run.orders()) == orders and "The mission was stopped" in run.verdict()
    assert run.crashes() == [], run.output()


def test_a_node_that_knows_more_stops_an_observer_that_has_lost_the_mission(
    ros: Ros, scenario: Path, tmp_path: Path
) -> None:
    """One controller stands still while everything else is lost, also what the master knows of the launch. It goes on
    when the observer waits for a start."""
    with launched(ros, scenario, tmp_path, use_sim_time=True, delays="middle", speed=1, lost_after=FOR_EVER) as run:
        known = run.until_step("bot1_inb")
        frozen = run.kill("controller_bot1", signal.SIGSTOP)
        journal = journal_of(run)
        for node in NODES:
            if node not in ("sim_clock", "controller_bot1"):
                run.kill(node)
        os.remove(journal)
        os.remove(f"{journal}{MARK}")
        run.delete_parameter("/pursue/newest")
        run.until(lambda: run.now().status == "waiting")
        orders = len(run.orders())
        os.kill(frozen, signal.SIGCONT)
        status = run.until_over()
        reason = run.now()["reason"]
    assert status == "stopped", run.output()
    assert "controller_bot1 knows of a state" in reason and int(reason.split(" state ")[1].split()[0]) >= known.seq
    assert len(run.orders()) == orders


def test_states_that_no_observer_publishes_change_nothing(ros: Ros, scenario: Path, tmp_path: Path) -> None:
    with launched(ros, scenario, tmp_path, use_sim_time=True, delays="middle", speed=1, lost_after=FOR_EVER) as run:
        run.until_step("bot2_c2a")
        processes = {node: run.pid(node) for node in NODES}
        with run.script(STRANGE_STATES) as strange:
            assert strange.wait() == 0 and "published" in strange.output(), strange.output()
        for node in ("controller_bot1", "controllerObj", "simulator", "UI"):
            run.until(lambda node=node: run.values(node).get("malformed") == "5")
        assert "not a system state" in run.output() and "refused" in run.output()
        run.until_step("bot1_inb")
        assert {node: run.pid(node) for node in NODES} == processes
        run.until_over()
    check_won(run)
    assert run.crashes() == [], run.output()
