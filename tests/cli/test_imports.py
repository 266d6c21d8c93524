"""A command imports the stages that it uses, when it runs: starting the program costs as much as many a solution."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

SCENARIO = Path(__file__).resolve().parents[2] / "scenarios" / "thesis" / "scenario_1.pur"
PROGRAM = """
import sys
from pursue_gen.cli.app import main
try:
    main()
except SystemExit as end:
    assert not end.code, end.code
print(*(name for name in sys.modules if name.startswith("pursue_gen.")), file=sys.stderr)
"""
UNUSED = re.compile(r"pursue_gen\.(explanation|survey|tools|cli\.(check|explain|fmt|solve|tga|verify))\b")
"""What a workspace of a scenario that is won does not need: other commands are not even imported."""


def test_a_workspace_is_made_without_the_stages_that_it_does_not_need(tmp_path: Path) -> None:
    command = [sys.executable, "-c", PROGRAM, "ws", str(SCENARIO), "-o", str(tmp_path / "ws")]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    modules = done.stderr.splitlines()[-1].split()
    assert "pursue_gen.workspace.generate" in modules
    assert [name for name in modules if UNUSED.match(name)] == []
    assert "pursue_gen.solving.verifytga" not in modules and "pursue_gen.tga.uppaal_read" not in modules
