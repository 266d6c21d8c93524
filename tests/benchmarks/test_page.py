"""The page of results that comes with the project is the one that its data give."""

from __future__ import annotations

import json
import re
from pathlib import Path

from benchmarks import tables
from benchmarks.page import PARTS, filled


def test_the_page_and_the_csv_show_the_data(project_root: Path) -> None:
    data = project_root / "docs" / "benchmarks"
    results = json.loads((data / "results.json").read_text())
    page = (project_root / "docs" / "benchmarks.md").read_text()
    assert set(re.findall(r"<!-- measured: ([a-z ]+) -->", page)) == set(PARTS)
    assert filled(page, results) == page, "run: python -m benchmarks.synthesis --render --out docs"
    assert (data / "results.csv").read_text() == tables.as_csv(results["rows"])


def test_sentences_are_wrapped_and_tables_are_not() -> None:
    sentence, row = "word " * 30 + "end.", "| " + "cell " * 30 + "|"
    page = filled("<!-- measured: machine -->\n<!-- end -->\n", {}, {"machine": lambda _: f"{sentence}\n\n{row}\n"})
    assert " ".join(sentence.split()) in " ".join(page.split()) and row in page.splitlines()
    assert max(len(line) for line in page.splitlines() if line != row) <= 120


def test_every_link_of_the_page_leads_somewhere(project_root: Path) -> None:
    page = (project_root / "docs" / "benchmarks.md").read_text()
    links = re.findall(r"\]\(([^)#]+)\)", page)
    assert len(links) > 5
    assert [link for link in links if not (project_root / "docs" / link).exists()] == []
