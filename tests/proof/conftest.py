"""The checker exists twice, in C++ and in Python: every test of this folder is for both."""

from __future__ import annotations

from typing import Iterator

import pytest

from tests.oracle.checker import in_python


@pytest.fixture(scope="module", autouse=True, params=["native", "python"])
def twin(request: pytest.FixtureRequest) -> Iterator[str]:
    """The checker that is used: "native" or "python"."""
    name: str = request.param
    if name == "native":
        yield name
    else:
        with in_python():
            yield name
