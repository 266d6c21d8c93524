"""README.md, CONTRIBUTING.md and docs/: links lead somewhere, paths of the source that pages name exist, there is one
version."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Set

import pytest

from pursue_runtime import __version__
from tests.conftest import ROOT

PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").rglob("*.md"))]
PACKAGES = ("", "pursue_gen", "pursue_gen/language", "pursue_gen/synthesis")
"""Paths in docs/architecture.md start in one of these."""


def prose(page: Path) -> str:
    """The text of a page without its blocks of code."""
    return re.sub(r"^( *)```.*?^ *```$", "", page.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)


def anchors(page: Path) -> Set[str]:
    """The anchors that GitHub gives to the headings of a page."""
    headings = re.findall(r"^#+ (.*)$", prose(page), re.MULTILINE)
    return {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_to_a_file_and_a_heading(page: Path) -> None:
    for target in re.findall(r"\]\(([^)\s]+)\)", prose(page)):
        if re.match(r"\w+:", target):
            continue
        file, _, anchor = target.partition("#")
        found = (page.parent / file).resolve() if file else page
        assert found.exists(), target
        assert not anchor or anchor in anchors(found), target


def test_every_page_is_linked_from_the_readme() -> None:
    linked = set(re.findall(r"\]\(docs/(\w+\.md)", prose(ROOT / "README.md")))
    assert linked == {page.name for page in (ROOT / "docs").glob("*.md")}


@pytest.mark.parametrize("page", ["CONTRIBUTING.md", "docs/architecture.md"])
def test_paths_of_the_source_exist(page: str) -> None:
    named = re.findall(r"`((?:[\w.]+/)*[\w.]+(?:\.py|\.lark|/))`", prose(ROOT / page))
    assert len(named) > 5
    for path in named:
        assert any((ROOT / package / path).exists() for package in PACKAGES), path


def test_every_place_has_the_same_version_and_the_changes_of_it_are_told() -> None:
    read = {name: (ROOT / name).read_text(encoding="utf-8") for name in ("CHANGELOG.md", "package.xml")}
    assert re.findall(r"^## (\S+) \(\d{4}-\d\d-\d\d\)$", read["CHANGELOG.md"], re.MULTILINE)[0] == __version__
    assert f"<version>{__version__}</version>" in read["package.xml"]
    for name in ("package.json", "package-lock.json"):
        assert json.loads((ROOT / "editors" / "vscode" / name).read_text(encoding="utf-8"))["version"] == __version__
