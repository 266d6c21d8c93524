"""The description of the language is true: its examples are read, and it lists every code there is."""

from __future__ import annotations

import re
from pathlib import Path

from pursue_gen.language.parser import read

from .texts import findings

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "language.md").read_text(encoding="utf-8")


def test_whole_examples_have_no_findings() -> None:
    examples = re.findall(r"```pursue\n(.*?)```", PAGE, re.S)
    assert examples
    for example in examples:
        assert findings(example) == []


def test_parts_of_examples_are_well_formed() -> None:
    parts = re.findall(r"```pursue-part\n(.*?)```", PAGE, re.S)
    assert len(parts) >= 8
    for part in parts:
        assert read(part, "part.pur").diagnostics == ()


def test_the_table_lists_every_code_with_its_severity() -> None:
    listed = {code: bool(warns) for code, warns in re.findall(r"^\| (PML\d{3})( \(W\))? \|", PAGE, re.M)}
    used = {}
    for file in (ROOT / "pursue_gen").rglob("*.py"):
        for call, code in re.findall(r"\b(error|warning)\(\s*\"(PML\d{3})\"", file.read_text(encoding="utf-8")):
            used[code] = call == "warning"
    assert listed == used
