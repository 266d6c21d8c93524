"""The outcomes of commands: each type has the exit status that the page on commands documents, and no code asks for the
number.
"""

from __future__ import annotations

import ast
import pickle
from pathlib import Path
from typing import Iterator, Type

import pytest
import typer

from pursue_gen import outcomes
from pursue_gen.cli.console import guarded
from pursue_gen.diagnostics import PursueError, error

ROOT = Path(__file__).parents[1]
TYPES = [PursueError, *(each for each in vars(outcomes).values() if isinstance(each, type) and each is not PursueError)]


def numbers_compared(file: Path) -> Iterator[int]:
    """The lines in which an exit status is compared."""
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Compare):
            sides = (node.left, *node.comparators)
            if any(isinstance(side, ast.Attribute) and side.attr == "exit_status" for side in sides):
                yield node.lineno


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
    assert {outcome.exit_status for outcome in TYPES} == set(range(3, 9))


def test_a_program_tells_outcomes_apart_by_their_types() -> None:
    files = [file for folder in ("pursue_gen", "benchmarks") for file in sorted((ROOT / folder).rglob("*.py"))]
    assert [f"{file.relative_to(ROOT)}:{line}" for file in files for line in numbers_compared(file)] == []


def test_a_comparison_would_be_found(tmp_path: Path) -> None:
    file = tmp_path / "some.py"
    file.write_text("try:\n    solve()\nexcept Wrong as problem:\n    if problem.exit_status != 5:\n        raise\n")
    assert list(numbers_compared(file)) == [4]


@pytest.mark.parametrize("outcome", TYPES)
def test_an_error_can_be_sent_from_one_process_to_another(outcome: Type[PursueError]) -> None:
    problem = outcome([error("SYN000", "so it ends"), error("SYN001", "and so")])
    again = pickle.loads(pickle.dumps(problem))
    assert type(again) is outcome and again.diagnostics == problem.diagnostics
    assert str(again) == str(problem) == "so it ends; and so"
