"""Mutants: what is changed, which ones are drawn, and how their tests end."""

from __future__ import annotations

import ast
import sys
import textwrap
from pathlib import Path
from typing import Optional

import pytest

pytest.importorskip("coverage")

from benchmarks.mutant_tests import Measured, batches, measured, outcome, ran
from benchmarks.mutants import PARTS, ROOT, drawn, files_of, folders_of, mutants_of, tried

pytestmark = [
    pytest.mark.benchmark,
    pytest.mark.skipif(sys.version_info < (3, 9), reason="writes Python code as only 3.9 and newer can"),
]


@pytest.fixture(autouse=True)
def _no_plugins(monkeypatch: pytest.MonkeyPatch) -> None:
    """The small projects here need no plugin of pytest, and loading them is most of what their tests cost."""
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")


CODE = '''"""A docstring of 3 words."""
from typing import List
LIMIT: int = 4


def late(moments: List[float], now: float = 0) -> bool:
    """Whether a moment has passed, é."""
    self.count += 1
    self.seen = now
    publish("late")
    if not moments or now < LIMIT:
        return min(moments) - 2 if now else True
    self._log_problem("late", 1)
    return None


def __repr__(self) -> str:
    return "late" + "!"


NAMES = (
    "a", 7,
    "b",
)
'''

CHANGES = [
    "3: 4 -> 5",
    "6: 0 -> 1",
    "8: self.count += 1 -> pass",
    "8: 1 -> 2",
    "9: self.seen = now -> pass",
    '10: publish("late") -> pass',
    "11: not moments or now < LIMIT -> (not moments and now < LIMIT)",
    "11: not moments -> (moments)",
    "11: now < LIMIT -> (now <= LIMIT)",
    "12: return min(moments) - 2 if now else True -> return None",
    "12: min(moments) - 2 if now else True -> (min(moments) - 2 if not now else True)",
    "12: min(moments) - 2 -> (min(moments) + 2)",
    "12: min -> max",
    "12: 2 -> 3",
    "12: True -> False",
    "22: 7 -> 8",
]


def test_what_is_changed_and_what_stays() -> None:
    found = list(mutants_of("some.py", CODE))
    assert sorted(f"{each.line}: {each.before} -> {each.after}" for each in found) == sorted(CHANGES)
    for each in found:
        lines = zip(CODE.splitlines(), each.applied(CODE.encode()).decode().splitlines())
        assert [number for number, (old, new) in enumerate(lines, 1) if old != new] == [each.line]


def test_what_a_mutant_is_executed_with_are_the_lines_of_its_statement() -> None:
    lines = {each.line: each.lines for each in mutants_of("some.py", CODE)}
    assert lines[3] == range(3, 4) and lines[6] == range(6, 7) and lines[11] == range(11, 12)
    assert lines[22] == range(21, 25)


def test_the_same_seed_draws_the_same_and_another_seed_others() -> None:
    part = ["pursue_gen/partition"]
    assert drawn(50, 1, part) == drawn(50, 1, part) != drawn(50, 2, part)
    assert set(drawn(20, 1, part)) < set(drawn(50, 1, part)), "fewer are the first ones of more"
    assert all(each.file.startswith("pursue_gen/partition/") for each in drawn(20, 1, part))
    assert {each.file for each in drawn(5, 1, ["pursue_gen/partition/split.py"])} == {"pursue_gen/partition/split.py"}


def test_a_changed_file_changes_no_draw_of_the_others(tmp_path: Path) -> None:
    folder = tmp_path / "pursue_gen" / "partition"
    folder.mkdir(parents=True)
    for name in ("a", "b"):
        (folder / f"{name}.py").write_text("".join(f"x{name}{k} = x > {k}\n" for k in range(50)))
    before = drawn(40, 1, ["pursue_gen/partition"], tmp_path)
    (folder / "a.py").write_text("\n\ny = 3\n" + (folder / "a.py").read_text())
    after = drawn(40, 1, ["pursue_gen/partition"], tmp_path)
    changes = [[f"{each.file} {each.before} {each.after}" for each in draw] for draw in (before, after)]
    assert len(set(changes[0]) ^ set(changes[1])) <= 2


def test_each_that_is_drawn_is_a_program_and_another_one() -> None:
    for each in drawn(30, 7):
        text = (ROOT / each.file).read_bytes()
        assert ast.dump(ast.parse(each.applied(text))) != ast.dump(ast.parse(text)), str(each)
        assert each.line in each.lines and all(files_of(folder) for folder in folders_of(each.file))


def test_they_are_killed_by_the_files_of_the_folder_that_mirrors_theirs_and_nodes_on_ros_too() -> None:
    assert folders_of("pursue_runtime/controller/goal.py") == ["tests/runtime/controller"]
    assert folders_of("pursue_runtime/state.py") == [PARTS["pursue_runtime"]]
    assert folders_of("pursue_gen/proof/native/search.py") == ["tests/proof"]
    assert folders_of("pursue_runtime/nodes/ui.py") == ["tests/runtime/nodes", "tests/ros"]


def test_first_come_the_tests_of_its_name_then_the_quickest_in_batches_that_take_longer_and_longer() -> None:
    files = [Measured(f"test_{seconds}.py", "passed", seconds, {}) for seconds in (30.0, 0.5, 5.0, 0.75, 1.0, 4.0)]
    own = Measured("tests/runtime/test_late.py", "passed", 9.0, {})
    found = batches([*files, own], "pursue_runtime/late.py")
    assert [[each.seconds for each in batch] for batch in found] == [[9.0], [0.5, 0.75], [1.0, 4.0], [5.0], [30.0]]
    assert batches([files[0]], "late.py") == [[files[0]]] and batches([], "late.py") == []


PROJECT = {
    "pursue_gen/__init__.py": "",
    "pursue_gen/partition/__init__.py": "",
    "pursue_gen/partition/late.py": """
        def late(n):
            if n > 3:
                return True
            return n == 9 and n > 5

        def told(n):
            return n > 1

        def unused(n):
            return n + 1
        """,
    "tests/partition/test_late.py": """
        import subprocess, sys
        from pursue_gen.partition.late import late

        def test_it():
            assert late(4) and not late(3)

        def test_in_a_process_of_its_own():
            told = "from pursue_gen.partition.late import told; exit(not told(2) or told(1))"
            assert subprocess.run([sys.executable, "-c", told]).returncode == 0
        """,
    "tests/partition/test_other.py": """
        from pursue_gen.partition import late

        def test_it():
            assert late
        """,
}


@pytest.fixture
def project(tmp_path: Path) -> Path:
    for name, text in PROJECT.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(textwrap.dedent(text))
    return tmp_path


def test_a_mutant_gets_the_tests_that_execute_its_line_also_in_another_process(
    project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    tests = [measured(project, name) for name in files_of("tests/partition", project)]
    assert [(each.name, each.end) for each in tests] == [
        ("tests/partition/test_late.py", "passed"), ("tests/partition/test_other.py", "passed"),
    ]  # fmt: skip
    name = "pursue_gen/partition/late.py"
    assert [each.executes(name, range(5, 6)) for each in tests] == [True, False]
    original = (project / name).read_text()
    changes = {f"{each.line}: {each.before} -> {each.after}": each for each in mutants_of(name, original)}
    ends = {
        "3: n > 3 -> (n >= 3)": "failed", "8: n > 1 -> (n >= 1)": "failed",
        "5: n > 5 -> (n >= 5)": "passed", "11: n + 1 -> (n - 1)": "not executed",
    }  # fmt: skip
    assert {change: tried(project, changes[change], tests) for change in ends} == ends
    assert (project / name).read_text() == original
    assert f"survived (not executed)  {name}:11  n + 1  ->  (n - 1)" in capsys.readouterr().out


def test_no_test_that_is_not_chosen_is_run(project: Path) -> None:
    (project / "tests" / "partition" / "test_other.py").write_text("def test_it():\n    assert False\n")
    late, other = (Measured(f"tests/partition/test_{name}.py", "passed", 1.0, {}) for name in ("late", "other"))
    assert (outcome(project, [late], "a.py"), outcome(project, [late, other], "a.py")) == ("passed", "failed")


@pytest.mark.parametrize(
    ("body", "cpu", "end"),
    [("n < 3", None, "passed"), ("n <= 3", None, "failed"), ("wait()", 1.0, "too long"), ("n <", None, "failed")],
)
def test_how_the_files_of_a_copy_end(tmp_path: Path, body: str, cpu: Optional[float], end: str) -> None:
    wait = "def wait():\n    while True:\n        pass\n"
    (tmp_path / "some_code.py").write_text(f"{wait}\n\ndef late(n):\n    return {body}\n")
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests" / "test_some_code.py").write_text(
        "from some_code import late\n\ndef test_it():\n    assert late(2) and not late(3)\n"
    )
    assert ran(tmp_path, ["tests"], cpu) == end
