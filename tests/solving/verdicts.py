"""Whether a scenario is won, for tests of what its words decide."""

from __future__ import annotations

from pathlib import Path

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import parse
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solution
from pursue_gen.tga import scenario_objective, translate
from tests.oracle import ENGINES

SCENARIOS = Path(__file__).resolve().parents[2] / "scenarios"


def text(name: str) -> str:
    """The text of one of the project's scenarios, as in `hotel/two_bells`."""
    return (SCENARIOS / f"{name}.pur").read_text(encoding="utf-8")


def is_won(source: str, engine: str = "native") -> bool:
    """Whether the default game is won, with a strategy that is proven."""
    read = parse(source, "x.pur", "x")
    try:
        solution(translate(read), scenario_objective(read), DEFAULT, SolveOptions(engine=ENGINES[engine]))
    except PursueError as problem:
        assert problem.exit_status == 4, problem
        return False
    return True
