"""Measured rows become tables."""

from __future__ import annotations

import csv
import io
from typing import Any, Dict, List

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks import tables
from benchmarks.families import FAMILIES
from benchmarks.page import filled

WON: Dict[str, Any] = {
    "group": "reference", "name": "CT9", "size": None, "game": "ideal", "verdict": "won", "outcome": "",
    "states": 1200, "zones": 1500, "seconds": 0.025, "runs": 7, "decided": 0.03, "proof": 0.31, "memory": 40.2,
    "blocks": 12, "commands": 9, "margin": 0.35, "margin_open": False,
    "tiga_states": 7070, "tiga_rate": 90000, "tiga_blocks": 164, "tiga_commands": 194,
}  # fmt: skip
LATE: Dict[str, Any] = {"group": "reference", "name": "CT9", "size": None, "game": "default", "outcome": "time"}


def member(size: int, game: str, **more: Any) -> Dict[str, Any]:
    """A row of a family."""
    row = {"group": "family", "name": "ring", "size": size, "game": game, "verdict": "won", "outcome": ""}
    return {**row, "states": size**2, "seconds": 0.001 * size**2, "commands": 3, **more}


def cells(line: str) -> List[str]:
    """The cells of a line of a Markdown table."""
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def test_beside_each_figure_of_the_ideal_game_stands_tigas() -> None:
    head, _, line = tables.beside_tiga([WON, LATE]).splitlines()
    named = list(zip(cells(head), cells(line)))
    assert named[:7] == [
        ("scenario", "CT9"), ("verdict", "won"), ("states", "1,200"), ("TIGA", "7,070"),
        ("states/s", "48,000"), ("TIGA", "90,000"), ("seconds", "0.0250"),
    ]  # fmt: skip
    assert named[9:] == [("blocks", "12"), ("TIGA", "164"), ("commands", "9"), ("TIGA", "194"), ("margin", "0.35")]


def test_a_game_that_took_too_long_says_so_and_has_dashes() -> None:
    line = cells(tables.default_game([WON, LATE]).splitlines()[-1])
    assert line[:2] == ["CT9", "too long"]
    assert set(line[2:]) == {"-"}


def test_a_win_that_was_not_proven_in_time_is_distinguished_from_a_proven_one() -> None:
    assert tables.verdict(WON) == "won"
    assert tables.verdict({**WON, "outcome": "proof"}) == "won, not proven in time"
    assert tables.verdict({**WON, "outcome": "refused"}) == "won, refused by the checker"


def test_a_margin_that_was_not_searched_to_its_end_is_a_lower_bound() -> None:
    assert [tables.margin({**WON, "margin_open": bound}) for bound in (False, True)] == ["0.35", ">= 0.35"]


def test_csv_has_all_columns_of_all_rows() -> None:
    read = list(csv.DictReader(io.StringIO(tables.as_csv([WON, LATE]))))
    assert [row["name"] for row in read] == ["CT9", "CT9"]
    assert read[0]["rate"] == "48000"
    assert read[1]["states"] == ""
    assert tuple(read[0]) == tables.COLUMNS


def test_a_family_has_a_line_per_size_with_both_games() -> None:
    ring = next(family for family in FAMILIES if family.name == "ring")
    lines = tables.family_table(ring, [member(8, "ideal"), member(4, "ideal"), member(4, "default")]).splitlines()
    assert [cells(line)[0] for line in lines[2:]] == ["4", "8"]
    assert cells(lines[2])[7] == "won"
    assert cells(lines[3])[7:] == ["-"] * 6


@given(st.floats(-3, 3), st.floats(0.01, 100))
def test_a_power_is_found(k: float, scale: float) -> None:
    found = tables.growth([(n, scale * n**k) for n in (4, 8, 16, 40)])
    assert found is not None
    assert found.kind == "power"
    assert found.k == pytest.approx(k, abs=1e-6)


@given(st.floats(1.3, 9), st.floats(0.01, 100))
def test_a_factor_is_found(k: float, scale: float) -> None:
    for sizes in ((1, 2, 3, 4, 5), (0, 1, 2, 3)):
        found = tables.growth([(n, scale * k**n) for n in sizes])
        assert found is not None
        assert (found.kind, found.points) == ("factor", len(sizes))
        assert found.k == pytest.approx(k)


def test_two_points_tell_no_growth() -> None:
    assert tables.growth([(1, 3.0), (2, 9.0), (3, 0.0)]) is None


def test_a_figure_that_hardly_changes_is_constant_from_none_on() -> None:
    found = tables.growth([(n, 0.5 + 0.01 * (n % 3)) for n in (0, 1, 2, 5, 50)])
    assert str(found) == "constant"


def test_growth_counts_only_what_was_decided() -> None:
    rows = [member(n, "ideal") for n in (4, 8, 12)] + [{**member(16, "ideal"), "verdict": None, "states": None}]
    line = cells(tables.growths(rows).splitlines()[2])
    assert line == ["ring", "POIs", "ideal", "n^2.0", "n^2.0", "constant", "12"]


RESULTS = {"machine": "a machine", "date": "a day", "seconds": 5.0, "memory": 100, "load": 0.1, "rows": [WON, LATE]}


def test_a_page_keeps_its_words_and_gets_new_figures() -> None:
    page = "Words.\n<!-- measured: default game -->\nold\n<!-- end -->\nMore.\n"
    new = filled(page, RESULTS)
    assert new.startswith("Words.\n") and new.endswith("More.\n")
    assert "too long" in new and "old" not in new
    assert filled(new, RESULTS) == new


def test_other_work_on_the_machine_is_mentioned() -> None:
    page = "<!-- measured: machine -->\n<!-- end -->\n"
    assert "load average" not in filled(page, RESULTS)
    assert "load average 2.4" in filled(page, {**RESULTS, "load": 2.4})


def test_without_a_page_there_is_one_of_figures_alone() -> None:
    page = filled(None, RESULTS)
    assert "a machine" in page and "CT9" in page


def test_an_unknown_part_of_a_page_is_an_error() -> None:
    with pytest.raises(ValueError, match="'weather'"):
        filled("<!-- measured: weather -->\n<!-- end -->\n", RESULTS)
