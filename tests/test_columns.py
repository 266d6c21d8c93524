"""Tables for the terminal."""

from __future__ import annotations

from typing import List, Tuple

import pytest

from pursue_gen.columns import columns

ROWS = [("what", "times", "basis"), ("a to the bank", "12", "counted"), ("b", "7", "")]


@pytest.mark.parametrize(("how", "lines"), [
    (("<>", False), ["what           times    basis", "a to the bank     12  counted", "b                  7"]),
    (("<><", False), ["what           times  basis", "a to the bank     12  counted", "b                  7"]),
    (("<", True), ["what           times  basis", "-------------  -----  -------", "a to the bank  12     counted",
                   "b              7"]),
])  # fmt: skip
def test_columns_are_as_wide_as_their_texts(how: Tuple[str, bool], lines: List[str]) -> None:
    assert columns(ROWS, *how) == lines
