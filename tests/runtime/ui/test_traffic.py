"""What the terminal prints of a message on a topic: the thesis's modes e and f."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime.ui.mission_view import traffic_lines


def test_a_word_is_printed_as_it_was_published() -> None:
    assert traffic_lines("pursue/events", "bot1:bot1_c2b@2", 3.25) == ["     3.2  on pursue/events: bot1:bot1_c2b@2"]
    assert traffic_lines("pursue/events", "_ping_", 3.25) == [], "as in the thesis"


def test_a_state_has_its_lines_below_the_first_one() -> None:
    assert traffic_lines("pursue/system_state", "seq=1\nbot1=c\n\nCbot1=0.5", 0.0) == [
        "     0.0  on pursue/system_state: seq=1", "          bot1=c", "          ", "          Cbot1=0.5",
    ]


@given(st.text())
def test_no_text_of_another_node_moves_the_cursor(text: str) -> None:
    """Whoever reaches the topics would write over what the UI says, or set colours."""
    assert all(line.isprintable() for line in traffic_lines("pursue/events", text, 1.0))
