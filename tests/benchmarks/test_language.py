"""What the benchmark of the language measures is what it says: sound floors, and floors with mistakes."""

from __future__ import annotations

import pytest

from benchmarks.language import TEXTS, floor, row, with_slips, with_unknown_names
from pursue_gen.language.checks import check_reading
from pursue_gen.language.parser import read

pytestmark = pytest.mark.benchmark


def codes(text: str) -> "set[str]":
    return {finding.code for finding in check_reading(read(text, "floor.pur"))}


def test_floors_are_sound_and_slips_are_slips() -> None:
    text = floor(30, 4)
    assert codes(text) == set()
    assert "PML011" in codes(with_slips(text, 5))
    assert codes(with_unknown_names(text)) == {"PML110"}


def test_the_sizes_are_those_of_the_names() -> None:
    texts = {name: make() for name, make in TEXTS}
    for name, text in texts.items():
        if name.startswith("500 lines"):
            assert 480 <= text.count("\n") <= 520
        else:
            assert text.count('poi "') == int(name.split()[0].replace(",", ""))


def test_a_row_has_the_findings_and_the_times() -> None:
    name, lines, findings, *times = row("small", floor(30, 4), 1)
    assert (name, lines, findings) == ("small", str(floor(30, 4).count("\n")), "0")
    assert len(times) == 4 and all(time.isdigit() for time in times)
