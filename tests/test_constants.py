"""docs/constants.md: what the docstrings of the tuned constants say, and none of them lacks what it was measured on."""

from __future__ import annotations

import re

import pytest

from docs.constants import make


def test_the_page_is_what_the_program_writes() -> None:
    page = make.PAGE.read_text(encoding="utf-8")
    assert make.page(page) == page, "run: python -m docs.constants.make"
    assert set(re.findall("<!-- made: (.*) -->", page)) == {folder for folder in make.FOLDERS if make.constants(folder)}


@pytest.mark.parametrize("folder", make.FOLDERS)
def test_each_tuned_constant_says_what_it_is_for_and_what_it_was_measured_on(folder: str) -> None:
    """Its docstring ends with "Measured on …" or "Not measured"; or it belongs in make.FIXED."""
    for constant in make.constants(folder):
        assert constant.basis and len(constant.text) > len(constant.basis) + 2, constant


def test_what_is_listed_by_name_exists() -> None:
    found = {(each.file, each.first) for folder in make.FOLDERS for each in make.numbers(folder)}
    assert found >= {(file, name) for file, names in make.FIXED.items() for name in names}
    assert found >= set(make.ELSEWHERE)
