"""The generated controllers and observer are code that people read: it passes a linter and runs on Python 3.8."""

from __future__ import annotations

import ast
import os
import subprocess
import sys
from pathlib import Path

import pytest
from rendered_scripts import NAMES, render


@pytest.mark.parametrize("kind", ["common", "controller", "observer", "pursue_reader", "communication_manager"])
def test_it_is_lint_free_python_3_8_that_says_where_it_comes_from(kind: str, tmp_path: Path) -> None:
    written = render(tmp_path, kind)
    assert written
    for path in written:
        text = path.read_text(encoding="utf-8")
        ast.parse(text, feature_version=(3, 8))
        assert f"pursue-gen {NAMES['generator']} from {NAMES['scenario']}.pur" in "".join(text.splitlines(True)[:2])
        assert text.startswith("#!/usr/bin/env python3\n") is (path.suffix == "")
    ruff = [sys.executable, "-m", "ruff", "check", "--isolated", "--no-cache", "--line-length", "120"]
    ruff += ["--target-version", "py38", "--select", "E,F,W,B,SIM,C4"]
    found = subprocess.run([*ruff, *map(os.fspath, written)], capture_output=True, text=True, check=False)
    assert found.returncode == 0, found.stdout
