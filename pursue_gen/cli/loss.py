"""How the commands tell why a scenario is lost."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any, Dict, Sequence

from pursue_gen import language
from pursue_gen.cli.console import show, tell
from pursue_gen.cli.progress import progress_line
from pursue_gen.diagnostics import PursueError
from pursue_gen.explanation.explain import DEFAULT_SECONDS, as_json, explain, render
from pursue_gen.solving.solution import Rules
from pursue_gen.synthesis.limits import Limits

_CANNOT_BE_MET = "SYN021"


def why(
    problem: PursueError, files: Sequence[Path], rules: Rules, wanted: bool, limits: Limits, quiet: bool = False
) -> Dict[str, Any]:
    """Tells the findings of a scenario that is lost and explains them, within the limits and some seconds.

    `quiet`: shows no progress. Returns {"explanation": …} for JSON. Nothing is told, and the result empty, where it is
    not `wanted`, where the problem is another one, and for UPPAAL's files: there are no words of a scenario in them.
    """
    lost = any(finding.code == _CANNOT_BE_MET for finding in problem.diagnostics)
    if not wanted or not lost or len(files) != 1 or files[0].suffix == ".xml":
        return {}
    show(problem.diagnostics)
    seconds = min(limits.seconds, DEFAULT_SECONDS) if limits.seconds else DEFAULT_SECONDS
    tell(f"Looking for what would change that, for at most {seconds:g} s (--no-explain leaves it out) …")
    with progress_line(quiet) as progress:
        explanation = explain(language.load(files[0]), rules, replace(limits, seconds=seconds), progress)
    tell(render(explanation).rstrip())
    return {"explanation": as_json(explanation)}
