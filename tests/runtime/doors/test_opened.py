"""What is published of doors, and read again."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime.doors.opened import NONE_OPENED, Opened, opened_text, read_opened

NAMES = st.text("abc_1", min_size=1, max_size=5)


@given(NAMES, st.integers(-1, 10**6), st.dictionaries(NAMES, st.frozensets(NAMES)))
def test_what_is_written_is_read_as_it_was(mission: str, seq: int, doors: "dict[str, frozenset[str]]") -> None:
    opened = Opened(mission, seq, doors)
    assert read_opened(opened_text(opened)) == opened


@pytest.mark.parametrize(
    "text",
    [
        "", "[]", "{}", "open", '{"format": 2, "mission": "m", "seq": 1, "open": {}}',
        '{"format": 1, "mission": "m", "seq": true, "open": {}}', '{"format": 1, "mission": "m", "seq": 1, "open": []}',
        '{"format": 1, "mission": "m", "seq": 1, "open": {"d1": "bot"}}',
    ],
)  # fmt: skip
def test_any_other_text_says_nothing(text: str) -> None:
    assert read_opened(text) is None


def test_it_counts_for_who_is_named_and_has_set_off_by_then() -> None:
    opened = Opened("m", 5, {"d1": frozenset({"bot"}), "d2": frozenset()})
    one, both = frozenset({"d1"}), frozenset({"d1", "d2"})
    assert opened.all_for("bot", one, 5) and opened.all_for("bot", one, 4)
    assert not opened.all_for("bot", one, 6), "it was said before it set off"
    assert not opened.all_for("bot", both, 5) and not opened.all_for("other", one, 5)
    assert not NONE_OPENED.all_for("bot", one, 0)
