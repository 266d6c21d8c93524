"""The picture of measured times: a row for each way, with all times, both windows and outliers."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import pytest

from pursue_gen.language import parse
from pursue_gen.tools.calibration.picture import draw
from pursue_gen.tools.calibration.proposal import Options, propose
from pursue_gen.tools.calibration.samples import Sample, Samples, Way, Work
from tests.cli.test_commands import pursue
from tests.tools.calibration.drive_bags import FLOOR, drives, write_drives

SVG = "{http://www.w3.org/2000/svg}"
TIMES = [Sample(Way("bot", "desk", "shelf"), 5.0 + 0.1 * (n % 4)) for n in range(12)]
TIMES += [Sample(Way("bot", "desk", "shelf"), 9.5), Sample(Work("fetch"), 3.5)]


def test_each_way_and_event_has_a_row_with_its_times_and_windows() -> None:
    scenario = parse(FLOOR.replace('poi "desk"', 'poi "desk" label "R&D <1>"'), "floor.pur", "floor")
    drawn = draw(propose(scenario, Samples(tuple(TIMES), unit=1.0), Options()))
    rows = ElementTree.fromstring(drawn).findall(f".//{SVG}g[@class='times']")
    assert [row.attrib["data-what"] for row in rows] == ["bot from desk to shelf", "fetch"]
    assert [text.text for text in rows[0].iter(f"{SVG}text")] == ["bot: R&D <1> to shelf", "13 times, fitted"]
    titles = [title.text for title in rows[0].iter(f"{SVG}title")]
    assert titles[0] == "model: 3 to 5" and titles[1].startswith("proposal: ") and titles[2] == "outlier: 9.50"
    assert len(rows[0].findall(f"{SVG}circle")) == 13 + 1 and len(rows[1].findall(f"{SVG}polygon")) == 1


def test_of_very_many_times_some_are_drawn_and_all_outliers() -> None:
    many = [Sample(Way("bot", "desk", "shelf"), 5.0 + 0.001 * (n % 100)) for n in range(2000)]
    many += [Sample(Way("bot", "desk", "shelf"), 20.0)]
    drawn = draw(propose(parse(FLOOR, "floor.pur", "floor"), Samples(tuple(many), unit=1.0), Options()))
    assert drawn.count("<circle") == 1 + 300 + 2 and drawn.count('class="outlier"') == 1


def test_the_picture_and_the_page_are_written(tmp_path: Path) -> None:
    (tmp_path / "floor.pur").write_text(FLOOR, encoding="utf-8")
    bag = write_drives(tmp_path / "drives.bag", drives("bot", ("desk", "shelf"), [4.5, 5.0, 5.5]))
    words = ("calibrate", tmp_path / "floor.pur", bag, "--no-solve", "--picture")
    assert pursue(*words, tmp_path / "times.svg").status == 0
    ElementTree.parse(tmp_path / "times.svg")
    assert pursue(*words, tmp_path / "times.html").status == 0
    page = (tmp_path / "times.html").read_text(encoding="utf-8")
    assert "<svg" in page and "3 of 3 times left" not in page and "bot: desk to shelf" in page and "guessed" in page


@pytest.mark.parametrize("name", ["times.png", "times"])
def test_another_kind_of_file_is_refused(tmp_path: Path, name: str) -> None:
    (tmp_path / "floor.pur").write_text(FLOOR, encoding="utf-8")
    done = pursue("calibrate", tmp_path / "floor.pur", "drives.bag", "--picture", tmp_path / name)
    assert done.status == 2 and "CAL004" in done.err
