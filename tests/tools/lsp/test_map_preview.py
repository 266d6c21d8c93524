"""The map beside a text that is being written."""

from __future__ import annotations

from pursue_gen.language.draft import Draft
from pursue_gen.tools.lsp.open_document import picture


def test_a_way_that_is_shorter_than_a_unit_is_shown_with_its_length() -> None:
    assert ">0.5</text>" in picture(Draft('poi "a"\npoi "b"\nconnect a and b distance 0.5\n'))
