"""The checker exists twice, in C++ and in Python: every test of this folder is for both."""

from __future__ import annotations

from typing import Iterator
from unittest import mock

import pytest

from pursue_gen.proof.native import tables

built = pytest.mark.skipif(not tables.available(), reason="the native checker is not built here (no compiler)")


@pytest.fixture(scope="module", autouse=True, params=[pytest.param("native", marks=built), "python"])
def twin(request: pytest.FixtureRequest) -> Iterator[str]:
    """The checker that is used: "native" or "python"."""
    name: str = request.param
    if name == "native":
        yield name
    else:
        with mock.patch.object(tables, "_proof", None):
            yield name
