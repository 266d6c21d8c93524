"""Whether a picture of a page is the one that is drawn today."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import List, Tuple

import pytest


def assert_same_picture(svg: str, path: Path, hint: str) -> None:
    """Fails, with this hint, unless the file holds this picture; its numbers may differ a little."""
    ElementTree.fromstring(svg)
    (shape, numbers), (drawn, there) = _apart(svg), _apart(path.read_text(encoding="utf-8"))
    assert shape == drawn, f"{path.name}: {hint}"
    # Computed positions may differ in their last digits from machine to machine.
    assert there == pytest.approx(numbers, abs=2), f"{path.name}: {hint}"


def _apart(svg: str) -> Tuple[str, List[float]]:
    """A picture without its numbers, and its numbers."""
    number = r"-?\d+(?:\.\d+)?"
    return re.sub(number, "#", svg), [float(found) for found in re.findall(number, svg)]
