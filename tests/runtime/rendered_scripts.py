"""Generated scripts without ROS: written to a folder, and to be imported from there."""

from __future__ import annotations

import atexit
import shutil
import sys
import tempfile
from pathlib import Path
from typing import List

from pursue_gen.simulation.code import rendered
from pursue_gen.workspace.packages import desk_modules

TEMPLATES = Path(__file__).resolve().parents[2] / "templates" / "catkin"
NAMES = {"scenario": "example", "generator": "0", "package": "controller_bot"}


def render(folder: Path, *kinds: str, package: str = NAMES["package"]) -> List[Path]:
    """Writes the scripts of these kinds of packages to the folder, as they stand in a workspace but for their names."""
    written = []
    for name, text in rendered(kinds, {**NAMES, "package": package}).items():
        written.append(folder / name)
        written[-1].write_text(text, encoding="utf-8")
    return written


def importable(*kinds: str, package: str = NAMES["package"]) -> Path:
    """A folder with the common scripts, those of these kinds and the desk's; modules are found there from now on."""
    folder = Path(tempfile.mkdtemp(prefix="rendered_scripts_"))
    atexit.register(shutil.rmtree, str(folder), ignore_errors=True)
    render(folder, "common", *kinds, package=package)
    for name, content in desk_modules({**NAMES, "package": package}).items():
        (folder / name).write_bytes(content)
    sys.path.insert(0, str(folder))
    return folder
