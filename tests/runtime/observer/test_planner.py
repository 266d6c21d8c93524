"""The planner is a process of its own: whatever becomes of it, the observer gets an answer, and nobody stays behind."""

from __future__ import annotations

import json
import queue
import shlex
import sys
import threading
from pathlib import Path
from typing import Any, List, Tuple

import pytest

from pursue_runtime.observer.planner import ORDER_LIMIT, Planner
from pursue_runtime.observer.planning import Ordered, PlanRequest
from tests.runtime.test_again import gone
from tests.waiting import PATIENCE, until

FOUND = {"format": 1, "won": True, "strategies": {}, "people": None, "cover": {}}


def request(number: int = 1) -> Any:
    return PlanRequest(number, {"bot": "a"}, {"Pbot": 1}, {"Cbot": 2.5}, 100.0, 1.5, ("dog",), (("a", "b"),), ("cat",))


class Office:
    """A planner with a program of ours, and what it has answered."""

    def __init__(self, program: str, limit: float = PATIENCE) -> None:
        self.answers: "queue.Queue[Any]" = queue.Queue()
        command = f"{shlex.quote(sys.executable)} -c {shlex.quote(program)}" if program.count(" ") else program
        self.searching: "queue.Queue[Any]" = queue.Queue()
        report = lambda number, seconds: self.searching.put((number, seconds))
        self.planner = Planner(command, {"name": "chase"}, limit, self.answers.put, report)

    def ask(self, number: int = 1) -> Tuple[str, int, Any]:
        self.planner.request_plan(request(number))
        answer: Tuple[str, int, Any] = self.answers.get(timeout=2 * PATIENCE)
        return answer


@pytest.fixture
def thrown(monkeypatch: pytest.MonkeyPatch) -> List[Any]:
    """What threads have thrown."""
    found: List[Any] = []
    monkeypatch.setattr(threading, "excepthook", found.append)
    return found


def test_it_is_asked_from_where_the_mission_is_and_its_plan_is_read(tmp_path: Path) -> None:
    copy = tmp_path / "request"
    program = f"import sys; open({str(copy)!r}, 'w').write(sys.stdin.read()); print({json.dumps(FOUND)!r})"
    assert Office(program).ask(7) == ("planned", 7, FOUND)
    assert json.loads(copy.read_text()) == {
        "format": 1, "game": {"name": "chase"}, "locations": {"bot": "a"}, "values": {"Pbot": 1},
        "clocks": {"Cbot": 2.5}, "ahead": 1.5, "excused": ["dog"], "blocked": [["a", "b"]], "turning": ["cat"],
        "awaited": None, "out_of_service": [],
    }


@pytest.mark.parametrize(
    ("program", "why"),
    [
        ("print('{\"won\": false, \"why\": \"nobody can\"}' )", "nobody can"),
        ("print('what?' )", "the planner failed (status 0)"),
        ("import sys; sys.exit('no such game')", "the planner failed (status 1): no such game"),
        ("import os; os.kill(os.getpid(), 9)", "the planner failed (status -9)"),
        ("no-such-planner", "no-such-planner cannot be run here"),
        ("off", "planning is switched off"),
    ],
)
def test_without_a_plan_it_says_why(program: str, why: str, thrown: List[Any]) -> None:
    name, number, said = Office(program).ask()
    assert (name, number) == ("unplanned", 1) and why in said
    assert not thrown


def test_an_order_is_asked_with_a_limit_and_what_could_be_promised_is_told(tmp_path: Path) -> None:
    copy = tmp_path / "request"
    answer = json.dumps({"won": False, "why": "too soon", "possible": 12.5})
    program = f"import sys; open({str(copy)!r}, 'w').write(sys.stdin.read()); print({answer!r})"
    office = Office(program)
    spread = {"Cbot": {"0": 0.5}}
    office.planner.request_plan(request(3)._replace(order=Ordered("tea", 1.0, {"Cobj": 20.0}, 2.0, spread)))
    assert office.answers.get(timeout=2 * PATIENCE) == ("refused", 3, "too soon", 12.5)
    asked = json.loads(copy.read_text())
    assert (asked["limit"], asked["window"], asked["sooner"]) == (ORDER_LIMIT, 2.0, {"Cobj": 20.0})
    assert (asked["spread"], asked["ahead"]) == (spread, 0.0)  # its clocks are those at its begin


def test_one_that_takes_longer_than_the_limit_goes_on_and_says_so_each_time_later(tmp_path: Path) -> None:
    leave = tmp_path / "leave"
    program = (
        f"import os, sys, time\nwhile not os.path.exists({str(leave)!r}): time.sleep(0.01)\n"
        f"print({json.dumps(FOUND)!r} if len(sys.stdin.read()) > 100000 else 'no request' )"
    )
    office = Office(program, limit=0.1)
    office.planner.request_plan(request(5)._replace(locations={"bot": "a" * 200000}))  # more than a pipe holds
    assert [office.searching.get(timeout=PATIENCE) for _ in range(3)] == [(5, 0.1), (5, 0.2), (5, 0.4)]
    assert office.planner.seconds >= 0.4
    leave.touch()
    assert office.answers.get(timeout=PATIENCE) == ("planned", 5, FOUND)
    assert office.planner.seconds == 0.0


def test_one_that_is_not_needed_any_more_is_killed_with_its_children(tmp_path: Path, thrown: List[Any]) -> None:
    note = tmp_path / "note"
    program = (
        "import subprocess, time; child = subprocess.Popen(['sleep', '1000']); "
        f"open({str(note)!r}, 'w').write(f'{{child.pid}} '); time.sleep(1000)"
    )
    office = Office(program)
    office.planner.request_plan(request())
    until(lambda: note.exists() and note.read_text().endswith(" "), "its note")
    office.planner.request_plan(None)
    assert gone(int(note.read_text())) and not thrown


def test_who_is_not_wanted_any_more_is_killed(tmp_path: Path, thrown: List[Any]) -> None:
    note = tmp_path / "note"
    program = f"import os, time; open({str(note)!r}, 'a').write(str(os.getpid()) + ' '); time.sleep(1000)"
    office = Office(program)
    for number in (1, 2):
        office.planner.request_plan(request(number))
        until(lambda: note.exists() and note.read_text().count(" ") == number, f"note {number}")  # noqa: B023 (called at once)
    office.planner.request_plan(None)
    first, second = (int(number) for number in note.read_text().split())
    assert gone(first) and gone(second)
    answers = [office.answers.get(timeout=PATIENCE) for _ in range(2)]
    assert sorted(number for _, number, _ in answers) == [1, 2] and {name for name, *_ in answers} == {"unplanned"}
    assert not thrown, thrown
