"""`pursue-gen send`: what a person types, sees, and gets as exit status."""

from __future__ import annotations

import io
import json
import os
import threading
import time
from pathlib import Path
from typing import Any, Iterator, List, Sequence, Tuple

import pytest
from cryptography.hazmat.primitives.serialization import Encoding, NoEncryption, PrivateFormat
from fake_robot import GONE, KEY, REFUSED, FakeRobot, serving
from fake_robot import bundle as make_bundle

from pursue_gen.cli.app import main
from pursue_gen.tools.commands.progress import upload_lines
from pursue_gen.tools.transport.client import Robot, Status
from pursue_gen.tools.transport.send_report import mission_digest, previous
from pursue_runtime.manifest import OWN, mission_id
from tests.waiting import PATIENCE

SCENARIO = str(Path(__file__).resolve().parents[3] / "scenarios" / "thesis" / "scenario_1.pur")
A, B, C = (make_bundle(name)[0] for name in "abc")


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder to work in, with one key, and a bundle `catch.pursue` that it signed."""
    keys = tmp_path / "config" / "pursue" / "keys"
    keys.mkdir(parents=True)
    (keys / "lab.key").write_bytes(KEY.private_bytes(Encoding.PEM, PrivateFormat.PKCS8, NoEncryption()))
    (keys / "lab.key").chmod(0o600)
    (tmp_path / "catch.pursue").write_bytes(make_bundle("catch")[1])
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def robots(desk: Path) -> Iterator[List[FakeRobot]]:
    """Three robots that robots.yaml lists: base with the observer, bot1 and bot2 with a controller each."""
    fleet = [
        FakeRobot("base", ("UI", "observer", "controllerObj")),
        FakeRobot("bot1", ("controller_bot1",)),
        FakeRobot("bot2", ("controller_bot2",)),
    ]
    with serving(fleet) as places:
        lines = [f"  {place.name}: {{host: 127.0.0.1, port: {place.port}}}\n" for place in places]
        (desk / "robots.yaml").write_text(f"format: 1\ntimeout: {PATIENCE}\nrobots:\n" + "".join(lines))
        yield fleet


def run(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, *words: str) -> Tuple[int, str, str]:
    """Exit status, stdout, stderr of `pursue-gen send … --to robots.yaml`."""
    monkeypatch.setattr("sys.argv", ["pursue-gen", "send", *words, "--to", "robots.yaml"])
    with pytest.raises(SystemExit) as end:
        main()
    out, err = capsys.readouterr()
    assert "Traceback" not in err
    return int(str(end.value.code or 0)), out, err


@pytest.fixture
def send(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Any:
    return lambda *words: run(capsys, monkeypatch, *words)


def cells(table: str) -> List[List[str]]:
    """The table's cells, without its head; columns are two blanks apart at least."""
    return [[cell.strip() for cell in line.split("  ") if cell.strip()] for line in table.splitlines()[1:]]


def test_a_bundle_reaches_all_robots(send: Any, robots: List[FakeRobot]) -> None:
    status, out, err = send("catch.pursue")
    mission = make_bundle("catch")[0]
    assert status == 0
    assert [robot.current for robot in robots] == [mission] * 3
    assert out.splitlines()[0].split() == ["robot", "address", "now", "before", "prepared", "outcome"]
    rows = cells(out)
    assert [row[0] for row in rows] == ["base", "bot1", "bot2"]
    assert all(row[2:] == [f"{mission_id(mission)} (catch)", "own", "-", "changed"] for row in rows)
    assert f"have the mission {mission_id(mission)}." in err
    assert "next: pursue-gen send --status --to robots.yaml" in err


def test_the_columns_of_the_table_are_aligned(send: Any, robots: List[FakeRobot]) -> None:
    lines = send("--status")[1].splitlines()
    place = lines[0].index("outcome")
    assert all(line[place:] == "no mission runs" and line[place - 2 : place] == "  " for line in lines[1:])


def test_a_scenario_is_solved_and_sent(send: Any, robots: List[FakeRobot]) -> None:
    status, out, err = send(SCENARIO, "--computed-poses", "--json")
    assert status == 0, err
    facts = json.loads(out)
    assert facts["done"] is True
    assert [robot.current for robot in robots] == [facts["mission"]] * 3
    assert [robot["now"]["current"] for robot in facts["robots"]] == [facts["mission"]] * 3
    assert [robot["before"]["current"] for robot in facts["robots"]] == [OWN] * 3


def test_the_same_scenario_with_other_options_is_another_mission(send: Any, robots: List[FakeRobot]) -> None:
    first = json.loads(send(SCENARIO, "--computed-poses", "--json")[1])["mission"]
    robots[0].packages.append("controller")
    again = json.loads(send(SCENARIO, "--computed-poses", "--json")[1])
    other = json.loads(send(SCENARIO, "--computed-poses", "--json", "--slack", "1")[1])
    assert again["mission"] == first != other["mission"]
    assert {robot["outcome"] for robot in again["robots"]} == {"had it already"}


def test_points_without_a_place_are_not_sent(send: Any, robots: List[FakeRobot]) -> None:
    scenario = Path("floor.pur")
    text = Path(SCENARIO).read_text()
    scenario.write_text("".join(line.split("//")[0].rstrip() + "\n" for line in text.splitlines()))
    status, _, err = send(str(scenario))
    assert status == 3
    assert "TRN010" in err
    assert not any(robot.requests for robot in robots)


def test_nothing_has_changed_where_one_refuses(send: Any, robots: List[FakeRobot]) -> None:
    robots[2].fault = lambda what, number: REFUSED if what == "prepare" else None
    status, out, err = send("catch.pursue")
    assert status == 7
    assert "TRN034: nothing has changed. bot2: the disk is full" in err
    assert [robot.current for robot in robots] == [OWN] * 3
    assert [row[-1] for row in cells(out)] == ["nothing changed"] * 2 + ["nothing changed: the disk is full"]


def test_robots_that_differ_have_a_status_of_their_own(send: Any, robots: List[FakeRobot]) -> None:
    robots[0].fault = lambda what, number: GONE if what == "commit" else None
    status, out, err = send("catch.pursue", "--json")
    assert status == 8
    assert "TRN035" in err
    facts = json.loads(out)
    assert (facts["done"], facts["unchanged"]) == (False, False)
    assert [robot["same"] for robot in facts["robots"]] == [False, False, False]
    assert [robot["now"] and robot["now"]["current"] for robot in facts["robots"]] == [None, *[facts["mission"]] * 2]


def test_a_package_that_no_robot_has_is_reported_before_anything_is_sent(send: Any, robots: List[FakeRobot]) -> None:
    robots[1].packages = ["observer"]
    status, _, err = send("catch.pursue")
    assert status == 7
    assert "TRN030: no robot has what this mission needs: controller_bot1" in err
    assert "bot1 has observer; bot2 has controller_bot2" in err
    assert all(set(robot.requests) == {"health"} for robot in robots)


def test_a_bundle_that_is_too_large_is_reported_before_anything_is_sent(send: Any, robots: List[FakeRobot]) -> None:
    robots[1].limit = 1000
    status, _, err = send("catch.pursue")
    assert status == 7
    assert "bot1 takes at most 1000" in err
    assert all(set(robot.requests) == {"health"} for robot in robots)
    robots[1].kept = [make_bundle("catch")[0]]
    assert send("catch.pursue")[0] == 0  # what is there needs no upload


def test_some_robots_only(send: Any, robots: List[FakeRobot]) -> None:
    status, out, _ = send("catch.pursue", "--only", "bot2")
    assert status == 0
    assert [robot.current == OWN for robot in robots] == [True, True, False]
    assert len(cells(out)) == 1
    assert send("catch.pursue", "--only", "bot9")[0] == 2


def test_back_and_forth(send: Any, robots: List[FakeRobot]) -> None:
    catch = make_bundle("catch")[0]
    send("catch.pursue")
    status, _, err = send("--back")
    assert status == 0, err
    assert [robot.current for robot in robots] == [OWN] * 3
    assert send("--back", catch[:6])[0] == 0
    assert [robot.current for robot in robots] == [catch] * 3
    assert send("--back", "own")[0] == 0
    assert [robot.current for robot in robots] == [OWN] * 3
    assert [robot.uploads for robot in robots] == [1] * 3


@pytest.mark.parametrize(("words", "code"), [((), "TRN032"), (("abcd",), "TRN033"), (("f" * 64,), "TRN033")])
def test_back_to_what_is_not_there(send: Any, robots: List[FakeRobot], words: Sequence[str], code: str) -> None:
    robots[1].kept, robots[1].history = [A], [A]
    status, _, err = send("--back", *words)
    assert status == 7
    assert code in err
    assert f"bot1 plays own, has {mission_id(A)}; bot2 plays own, has no other" in err
    assert not any("prepare" in robot.requests for robot in robots)


def test_back_with_a_robot_out_of_reach(send: Any, robots: List[FakeRobot]) -> None:
    robots[1].dead = True
    status, out, err = send("--back", "own")
    assert status == 7
    assert "TRN034: cannot reach bot1" in err
    assert cells(out)[1][2:] == ["?", "?", "?", "not reached: it closed the connection without an answer"]


def status_of(history: Sequence[str], current: str, waiting: Any = None, kept: Sequence[str] = (A, B, C)) -> Status:
    return Status("bot", "0" * 32, current, waiting, None, tuple(kept), tuple(history), "", (), False, 0)


@pytest.mark.parametrize(
    ("robots_", "mission"),
    [
        ([status_of([OWN], A)], OWN),
        ([status_of([OWN, A, B, A], B)], A),
        ([status_of([OWN, A], B), status_of([C, A], B)], A),
        ([status_of([OWN, A, C], B), status_of([OWN, A], B)], A),  # one has been elsewhere in between
        ([status_of([OWN], A, B), status_of([OWN, A], B)], A),  # one waits for the end of a mission
        ([status_of([A, C], B, kept=(A, B)), status_of([A, C], B)], A),  # one has deleted the last
        ([status_of([A, C], B), status_of([C, A], B)], None),
        # A desk has died while it told them: some play B already. A was the last that all have played.
        ([status_of([OWN, A], B), status_of([OWN], A)], A),
        ([status_of([OWN, A], B), status_of([OWN], A), status_of([], A, B)], A),
        ([status_of([A, B, C], OWN), status_of([A], B)], B),
        ([status_of([OWN, A], B), status_of([OWN, B], A)], None),
        ([status_of([A], B), status_of([C], B)], None),
        ([status_of([], OWN)], None),
    ],
)
def test_the_mission_before_is_the_last_that_all_agree_on(robots_: List[Status], mission: Any) -> None:
    from pursue_gen.diagnostics import PursueError

    if mission is None:
        with pytest.raises(PursueError):
            previous(robots_)
    else:
        assert previous(robots_) == mission


def test_a_mission_is_named_by_its_first_digits() -> None:
    from pursue_gen.diagnostics import PursueError

    robot = status_of([], OWN)
    assert [mission_digest(one[:12], [robot]) for one in (A, B)] == [A, B]
    assert mission_digest(A, [status_of([], OWN, kept=())]) == A  # that it is not there is told by robot
    for wrong in ("", A[:3], "xyz!", A + "0"):
        with pytest.raises(PursueError):
            mission_digest(wrong, [robot])


def test_status_shows_what_each_plays(send: Any, robots: List[FakeRobot]) -> None:
    assert send("--status")[0] == 0
    robots[1].kept, robots[1].history, robots[1].runs = [A, B], [A, B], True
    robots[1].next, robots[1].prepared = A, B
    status, out, err = send("--status")
    assert status == 8
    assert "TRN035" in err
    assert cells(out)[1][2:] == [
        "own (catch), then " + mission_id(A), mission_id(B), mission_id(B), "a mission is under way"
    ]  # fmt: skip
    robots[2].dead = True
    status, out, _ = send("--status", "--json")
    assert status == 7
    assert [robot["now"] is None for robot in json.loads(out)["robots"]] == [False, False, True]


def test_waiting_ends_with_the_mission_under_way(send: Any, robots: List[FakeRobot]) -> None:
    robots[0].runs = True
    status, out, err = send("catch.pursue")
    assert status == 0
    assert "takes effect as soon as no mission is under way" in out
    assert send("catch.pursue", "--wait", "0.1")[0] == 5

    def end_later() -> None:
        time.sleep(0.3)
        with robots[0].lock:
            robots[0].end_mission()

    thread = threading.Thread(target=end_later)
    thread.start()
    status, out, err = send("catch.pursue", "--wait", str(PATIENCE))
    thread.join()
    assert status == 0, err
    assert cells(out)[0][2] == f"{mission_id(robots[0].current)} (catch)"


@pytest.mark.parametrize(
    ("words", "hint"),
    [
        ((), "a mission is missing"),
        (("--status", "catch.pursue"), "--status sends nothing"),
        (("--status", "--back"), "--status sends nothing"),
        (("catch.pursue", "--reaction", "0"), "there is no scenario"),
        (("--back", "--slack", "2"), "there is no scenario"),
        (("nothing.pursue",), "CLI001"),
        (("nothing.pur",), "nothing.pur"),
        (("catch.pursue", "--key", "nobody"), "TRN002"),
    ],
)
def test_what_does_not_go_together_is_reported(
    send: Any, robots: List[FakeRobot], words: Sequence[str], hint: str
) -> None:
    status, _, err = send(*words)
    assert status in (2, 3)
    assert hint in err
    assert not any("prepare" in robot.requests for robot in robots)


def test_a_bundle_of_an_unknown_key_is_not_sent(send: Any, robots: List[FakeRobot], desk: Path) -> None:
    from fake_robot import STRANGER

    (desk / "theirs.pursue").write_bytes(make_bundle("catch", STRANGER)[1])
    status, _, err = send("theirs.pursue")
    assert status == 2
    assert "TRN014" in err


def test_status_needs_no_key(send: Any, robots: List[FakeRobot], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CONFIG_HOME", os.sep + "nowhere")
    assert send("--status")[0] == 0


class _Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_a_terminal_shows_a_line_per_robot_and_forgets_them(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in (("TERM", "xterm"), ("COLUMNS", "80")):
        monkeypatch.setenv(name, value)
    stream = _Terminal()
    with upload_lines(False, stream) as show:
        assert show is not None
        show(Robot("a", "h"), 5, 10)
        show(Robot("long", "h"), 10, 10)
    assert "a     5 of 10 bytes" in stream.getvalue()
    assert "long  10 of 10 bytes" in stream.getvalue()
    assert stream.getvalue().endswith("\033[2A\r\033[J")


def test_elsewhere_nothing_is_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TERM", "xterm")
    with upload_lines(False, io.StringIO()) as show:
        assert show is None
    with upload_lines(True, _Terminal()) as show:
        assert show is None
