"""The outcomes of commands: each type has the exit status that the page on commands documents, and no other code knows
the number.
"""

from __future__ import annotations

import ast
import pickle
from pathlib import Path
from typing import Callable, Dict, List, Type

import pytest
import typer

from pursue_gen import outcomes
from pursue_gen.cli.console import guarded
from pursue_gen.diagnostics import PursueError, error

ROOT = Path(__file__).parents[1]
TYPES = [each for each in vars(outcomes).values() if isinstance(each, type) and issubclass(each, PursueError)]


HOMES = ("pursue_gen/diagnostics.py", "pursue_gen/outcomes.py")
ENDS = ("Exit", "exit", "_exit", "SystemExit")
"""Names of what ends a program with a status."""


def last_name(node: ast.AST) -> str:
    """`exit` of `exit` and of `sys.exit`."""
    return node.attr if isinstance(node, ast.Attribute) else node.id if isinstance(node, ast.Name) else ""


def is_number(node: ast.AST) -> bool:
    """True for a number, and for a choice with one."""
    arms = (node.body, node.orelse) if isinstance(node, ast.IfExp) else (node,)
    return any(isinstance(arm, ast.Constant) for arm in arms)


def compared(node: ast.AST) -> bool:
    """True where an exit status is compared."""
    return isinstance(node, ast.Compare) and any(last_name(n) == "exit_status" for n in (node.left, *node.comparators))


def given(node: ast.AST) -> bool:
    """True where an exit status is set, passed on, or returned by a function of that name."""
    if isinstance(node, ast.Call):
        values = [*node.args, *(keyword.value for keyword in node.keywords)]
        named = any(keyword.arg == "exit_status" for keyword in node.keywords)
        return named or (last_name(node.func) in ENDS and any(map(is_number, values)))
    if isinstance(node, ast.Assign):
        return any(last_name(target) == "exit_status" for target in node.targets)
    if isinstance(node, ast.AnnAssign):
        return last_name(node.target) == "exit_status"
    return isinstance(node, ast.FunctionDef) and node.name == "exit_status"


def lines_with(file: Path, wrong: Callable[[ast.AST], bool]) -> List[int]:
    return [getattr(node, "lineno", 0) for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))) if wrong(node)]


def found_in(folder: str, wrong: Callable[[ast.AST], bool]) -> Dict[str, List[int]]:
    """Files with the lines in which something is wrong."""
    found = {str(f.relative_to(ROOT)): lines_with(f, wrong) for f in sorted((ROOT / folder).rglob("*.py"))}
    return {file: lines for file, lines in found.items() if lines}


@pytest.mark.parametrize("outcome", TYPES)
def test_a_command_that_ends_so_has_the_exit_status_of_the_page(
    outcome: Type[PursueError], capsys: pytest.CaptureFixture[str]
) -> None:
    @guarded
    def command() -> None:
        raise outcome([error("SYN000", "so it ends")])

    with pytest.raises(typer.Exit) as ended:
        command()
    assert "error SYN000: so it ends" in capsys.readouterr().err
    assert f"\n| {ended.value.exit_code} |" in (ROOT / "docs/commands.md").read_text(encoding="utf-8")


def test_each_documented_status_of_an_error_has_an_outcome() -> None:
    assert {outcome.exit_status for outcome in TYPES} == set(range(2, 9))


@pytest.mark.parametrize("folder", ["pursue_gen", "benchmarks"])
def test_a_program_tells_outcomes_apart_by_their_types(folder: str) -> None:
    assert found_in(folder, compared) == {}


def test_the_numbers_stand_in_one_home() -> None:
    assert sorted(found_in("pursue_gen", given)) == sorted(HOMES)


@pytest.mark.parametrize("line", ["if problem.exit_status != 5: pass", "least = 4 <= problem.exit_status"])
def test_a_comparison_would_be_found(tmp_path: Path, line: str) -> None:
    assert found(tmp_path, line, compared) and not found(tmp_path, "if isinstance(problem, Lost): pass", compared)


@pytest.mark.parametrize(
    "line",
    [
        "raise PursueError(findings, exit_status=status)",
        "raise typer.Exit(1)",
        "raise Exit(code=3 if errors else 0)",
        "sys.exit(130)",
        "raise SystemExit(2)",
        "problem.exit_status = status",
        "exit_status: int = 4",
        "def exit_status(): return 2",
    ],
)
def test_a_number_would_be_found(tmp_path: Path, line: str) -> None:
    assert found(tmp_path, line, given) and not found(tmp_path, "raise typer.Exit(problem.exit_status)", given)


def found(folder: Path, line: str, wrong: Callable[[ast.AST], bool]) -> bool:
    (folder / "some.py").write_text(f"{line}\n")
    return lines_with(folder / "some.py", wrong) == [1]


@pytest.mark.parametrize("outcome", TYPES)
def test_an_error_can_be_sent_from_one_process_to_another(outcome: Type[PursueError]) -> None:
    problem = outcome([error("SYN000", "so it ends"), error("SYN001", "and so")])
    again = pickle.loads(pickle.dumps(problem))
    assert type(again) is outcome and again.diagnostics == problem.diagnostics
    assert str(again) == str(problem) == "so it ends; and so"
