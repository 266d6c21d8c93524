"""The desk works with the run time it was installed with, whatever workspace is sourced."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

import pursue_gen
import pursue_runtime

ROOT = Path(pursue_gen.__file__).resolve().parent.parent


@pytest.mark.parametrize("first", ["", "import pursue_runtime; "])
def test_the_copy_of_a_sourced_workspace_is_not_imported(first: str, tmp_path: Path) -> None:
    """Neither where it stands first on the path, nor where somebody has imported it already."""
    (tmp_path / "pursue_runtime").mkdir()
    (tmp_path / "pursue_runtime" / "__init__.py").write_text('__version__ = "0.0.1"\n')
    code = first + "import pursue_gen, pursue_runtime.data; print(pursue_gen.__version__, pursue_runtime.__file__)"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), str(ROOT)])}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
    assert done.stdout.split() == [pursue_runtime.__version__, str(ROOT / "pursue_runtime" / "__init__.py")]
