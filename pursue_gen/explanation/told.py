"""How the commands tell why a scenario is lost."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Dict, Sequence

from pursue_gen import language
from pursue_gen.console import show, tell
from pursue_gen.diagnostics import PursueError
from pursue_gen.explanation.explain import DEFAULT_SECONDS, as_json, explain, render
from pursue_gen.pipeline import Rules

_CANNOT_BE_MET = "SYN021"


def why(problem: PursueError, files: Sequence[Path], rules: Rules, wanted: bool, limit: float = 0.0) -> Dict[str, Any]:
    """Tells the findings of a scenario that is lost and explains them, within `limit` seconds where that is not 0.

    Returns {"explanation": …} for JSON. Nothing is told, and the result empty, where it is not `wanted`, where the
    problem is another one, and for UPPAAL's files: there are no words of a scenario in them.
    """
    lost = any(finding.code == _CANNOT_BE_MET for finding in problem.diagnostics)
    if not wanted or not lost or len(files) != 1 or files[0].suffix == ".xml":
        return {}
    show(problem.diagnostics)
    seconds = min(limit, DEFAULT_SECONDS) if limit else DEFAULT_SECONDS
    tell(f"Looking for what would change that, for at most {seconds:g} s (--no-explain leaves it out) …")
    explanation = explain(language.load(files[0]), rules, seconds)
    tell(render(explanation).rstrip())
    return {"explanation": as_json(explanation)}
