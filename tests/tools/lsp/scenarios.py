"""What the tests of the language server are tried on."""

from __future__ import annotations

from pathlib import Path
from typing import Dict, Tuple

ROOT = Path(__file__).resolve().parents[3]
SCENARIOS: Dict[str, str] = {
    path.stem: path.read_text(encoding="utf-8") for path in sorted((ROOT / "scenarios").rglob("*.pur"))
}

SMALL = """\
poi "a"
poi "b"
connect a and b distance 3
event "work" location b duration 3
event "hand" collaborative
event "rest"
rule "order": work before hand
state "tired": initially false, true_if work false_if rest
stateDependency: hand only_if tired is_true
agent "bot" controllable mobile 2 location a can_do work, hand
agent "man" location b can_do rest reacts_to hand
objective: if work then hand within 20
reach_objective: do hand after 4
"""
"""A sound scenario with every kind of statement."""


def marked(text: str) -> Tuple[str, int]:
    """A text without its mark `|`, and where the mark was."""
    assert text.count("|") == 1
    at = text.index("|")
    return text.replace("|", ""), at
