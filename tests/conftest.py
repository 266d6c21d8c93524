"""Fixtures that every test may use."""

from __future__ import annotations

import os
from pathlib import Path
from typing import List

import pytest

ROOT = Path(__file__).resolve().parent.parent


@pytest.fixture(scope="session")
def project_root() -> Path:
    """The checkout that is tested."""
    return ROOT


@pytest.fixture(scope="session")
def reference_dir() -> Path:
    """The published scenarios with TIGA's outputs; the test is skipped where they are not at hand."""
    folder = Path(os.environ.get("PURSUE_REFERENCE", ROOT.parent / "shared" / "reference")) / "pursue-scenarios"
    if not folder.is_dir():
        pytest.skip(f"the published scenarios are not here ({folder}); set PURSUE_REFERENCE to their folder")
    return folder


def thesis_scenario(number: str) -> Path:
    """The path of one of the thesis's five scenarios: '1' to '4' or 'catch_the_thief'."""
    stem = number if number.startswith("catch") else f"scenario_{number}"
    return ROOT / "scenarios" / "thesis" / f"{stem}.pur"


def pytest_collection_modifyitems(items: List[pytest.Item]) -> None:
    """Tests on ROS share what they build, and need a processor for themselves: they run one after the other."""
    for item in items:
        if item.get_closest_marker("ros"):
            item.add_marker(pytest.mark.xdist_group("ros"))
