"""robots.yaml: what it may say, and that everything wrong with it is told with its place."""

from __future__ import annotations

from pathlib import Path
from typing import Any, List, Tuple

import pytest
from fake_robot import certificate
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.tools.transport.client import Robot
from pursue_gen.tools.transport.robots_file import chosen, read_robots

GOOD = """format: 1
robots:
  bot1: {host: bot1.local}                # port 13000 by default
  bot2: {host: 10.0.0.12, port: 13001, tls: true, ca: lab.pem}
  base: {host: localhost}
timeout: 2.5
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "lab.pem").write_bytes(certificate("10.0.0.12"))
    return tmp_path


def read(folder: Path, text: str) -> Tuple[Robot, ...]:
    file = folder / "robots.yaml"
    file.write_text(text, encoding="utf-8")
    return read_robots(file)


def findings(folder: Path, text: str) -> List[Tuple[str, int, int, str]]:
    """Code, line, column, and message with its hint."""
    with pytest.raises(PursueError) as problem:
        read(folder, text)
    assert problem.value.exit_status == 2
    found = []
    for one in problem.value.diagnostics:
        assert one.span is not None
        assert one.hint
        found.append((one.code, one.span.line, one.span.column, f"{one.message}; {one.hint}"))
    return found


def test_robots_are_read_in_their_order(folder: Path) -> None:
    assert read(folder, GOOD) == (
        Robot("bot1", "bot1.local", 13000, False, None, 2.5),
        Robot("bot2", "10.0.0.12", 13001, True, folder / "lab.pem", 2.5),
        Robot("base", "localhost", 13000, False, None, 2.5),
    )


def test_without_a_timeout_it_is_five_seconds(folder: Path) -> None:
    assert read(folder, "format: 1\nrobots: {a: {host: '::1'}}")[0].timeout == 5.0


def test_addresses_are_written_as_people_write_them() -> None:
    assert Robot("a", "::1").address == "[::1]:13000"
    assert Robot("a", "bot1.local", 1, True).address == "https://bot1.local:1"


@pytest.mark.parametrize(
    ("before", "after", "code", "line", "column", "words"),
    [
        ("format: 1", "format: 2", "TRN023", 1, 9, "write   format: 1"),
        ("format: 1\n", "", "TRN023", 1, 1, "begin it with   format: 1"),
        ("format: 1", "fromat: 1", "TRN022", 1, 1, "did you mean format?"),
        ("robots:", "robot:", "TRN022", 2, 1, "did you mean robots?"),
        ("host: bot1.local", "hots: bot1.local", "TRN022", 3, 10, "did you mean host?"),
        ("{host: bot1.local}", "{port: 13000}", "TRN022", 3, 9, "robot bot1 has no host"),
        ("{host: bot1.local}", "bot1.local", "TRN022", 3, 9, "write {host: bot1.local}"),
        ("{host: bot1.local}", "[host, bot1.local]", "TRN022", 3, 9, "write {host: bot1.local}"),
        ("host: bot1.local", "host: http://bot1.local", "TRN022", 3, 16, "host is not as it should be"),
        ("host: bot1.local", "host: [a]", "TRN022", 3, 16, "host is not as it should be"),
        ("host: bot1.local", 'host: "bot1 "', "TRN022", 3, 16, "host is not as it should be"),
        ("13001", "0", "TRN022", 4, 33, "from 1 to 65535"),
        ("13001", "65536", "TRN022", 4, 33, "from 1 to 65535"),
        ("13001", "'13001'", "TRN022", 4, 33, "from 1 to 65535"),
        ("13001", "0x10", "TRN022", 4, 33, "from 1 to 65535"),
        ("tls: true", "tls: maybe", "TRN022", 4, 45, "true or false"),
        ("tls: true, ", "", "TRN022", 4, 40, "add   tls: true"),
        ("lab.pem", "nothing.pem", "TRN026", 4, 55, "cannot be used: No such file"),
        ("lab.pem", "robots.yaml", "TRN026", 4, 55, "there is no certificate in it"),
        ("base:", "bot1:", "TRN024", 5, 3, "bot1 stands twice in robots; the first is in line 3"),
        ("localhost", "Bot1.local", "TRN024", 5, 9, "base has the address of bot1"),
        ("base:", "the-base:", "TRN022", 5, 3, "not a robot's name: the-base"),
        ("2.5", "-1", "TRN022", 6, 10, "seconds"),
        ("2.5", ".nan", "TRN022", 6, 10, "seconds"),
        ("2.5", ".inf", "TRN022", 6, 10, "seconds"),
        ("2.5", "soon", "TRN022", 6, 10, "seconds"),
        ("2.5", "1\ntimeout: 2", "TRN024", 7, 1, "timeout stands twice in the file; the first is in line 6"),
        ("bot1.local}", "bot1.local", "TRN021", 4, 3, "is not YAML"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_reported_with_its_place(
    folder: Path, before: str, after: str, code: str, line: int, column: int, words: str
) -> None:
    assert before in GOOD
    found = findings(folder, GOOD.replace(before, after, 1))
    assert (code, line, column) == found[0][:3]
    assert words in found[0][3]


def test_all_findings_are_reported_at_once(folder: Path) -> None:
    text = GOOD.replace("13001", "0").replace("2.5", "0").replace("localhost", "a b")
    assert [line for _, line, _, _ in sorted(findings(folder, text), key=lambda one: one[1])] == [4, 5, 6]


@pytest.mark.parametrize("text", ["", "# nothing", "[]", "robots", "format: 1\nrobots:\n", "format: 1\nrobots: {}"])
def test_a_file_without_robots_shows_how_one_looks(folder: Path, text: str) -> None:
    assert any("bot1: {host: bot1.local}" in words for *_, words in findings(folder, text))


@pytest.mark.parametrize("text", ["[" * 5000, "format: 1\x07", "a: &a [*a]", "<<: 1", "? [1]\n: 2", "!!python/none x"])
def test_strange_yaml_is_reported_too(folder: Path, text: str) -> None:
    with pytest.raises(PursueError) as problem:
        read(folder, text)
    assert problem.value.exit_status == 2


def test_a_file_that_is_not_there_is_reported(tmp_path: Path) -> None:
    with pytest.raises(PursueError) as problem:
        read_robots(tmp_path / "robots.yaml")
    assert problem.value.diagnostics[0].code == "CLI001"


@given(data=st.data())
def test_no_text_ends_in_anything_else_than_findings(tmp_path_factory: Any, data: st.DataObject) -> None:
    start, end = sorted(data.draw(st.tuples(st.integers(0, len(GOOD)), st.integers(0, len(GOOD)))))
    text = GOOD[:start] + data.draw(st.text(max_size=8)) + GOOD[end:]
    try:
        robots = read(tmp_path_factory.getbasetemp(), text.encode("utf-8", "ignore").decode())
    except PursueError as problem:
        assert problem.diagnostics
    else:
        assert robots
        assert len({(robot.host, robot.port) for robot in robots}) == len(robots)


def test_some_robots_are_chosen_in_the_order_of_the_file(folder: Path) -> None:
    robots = read(folder, GOOD)
    assert [robot.name for robot in chosen(robots, "base, bot1", Path("robots.yaml"))] == ["bot1", "base"]


@pytest.mark.parametrize(("names", "hint"), [("bot3", "did you mean bot"), ("", "known: bot1, bot2, base")])
def test_a_robot_that_is_not_in_the_file_cannot_be_chosen(folder: Path, names: str, hint: str) -> None:
    with pytest.raises(PursueError) as problem:
        chosen(read(folder, GOOD), names, Path("robots.yaml"))
    assert problem.value.diagnostics[0].code == "TRN025"
    assert problem.value.diagnostics[0].hint.startswith(hint)


def test_the_file_in_the_docs_is_read(tmp_path: Path, project_root: Path) -> None:
    page = (project_root / "docs" / "transport.md").read_text(encoding="utf-8")
    example = page.split("```yaml\n")[1].split("```")[0]
    (tmp_path / "bot2.pem").write_bytes(certificate("10.0.0.12"))
    robots = read(tmp_path, "".join(f"{line[3:]}\n" for line in example.splitlines()))
    assert [(robot.name, robot.port, robot.tls) for robot in robots] == [
        ("bot1", 13000, False), ("bot2", 13000, True), ("base", 13000, False)
    ]  # fmt: skip
