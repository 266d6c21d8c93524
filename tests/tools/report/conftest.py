"""Fixtures for the tests of reports."""

from __future__ import annotations

from typing import Iterator

import pytest

from pursue_gen.tools.report import graphviz, png


@pytest.fixture(scope="module", autouse=True)
def patient() -> Iterator[None]:
    """Pictures are not left out because the machine is busy, or makes its first one and looks for fonts."""
    with pytest.MonkeyPatch.context() as patch:
        for module in (graphviz, png):
            patch.setattr(module, "_SECONDS", 600)
        yield
