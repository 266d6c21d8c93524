"""What the statements of objectives cost."""

from __future__ import annotations

import pytest

from pursue_gen.explanation import decided as module
from pursue_gen.explanation.decided import Size, sizes
from pursue_gen.language import parse

PARCELS = """poi "gate"
poi "shelf"
connect gate and shelf distance 2
event "ring"
event "fetch" location shelf
event "knock"
event "open" location gate
agent "porter" controllable mobile 1 location gate can_do fetch, open
agent "guest" location gate can_do ring, knock
objective: if ring then fetch within 30
objective: porter never_with guest at shelf
"""

PORTER, CALL = 2 + 2, 2
"""The porter is at one of two places or on one of two ways; a call waits or not."""


def told(text: str) -> "list[tuple[int, int, bool]]":
    return [(size.span.line, size.states, size.more) for size in sizes(parse(text, "parcels.pur"))]


def test_each_objective_counts_the_states_of_its_own_game() -> None:
    # A call that waits too long is one more state for each.
    assert told(PARCELS)[0] == (10, PORTER * CALL + PORTER, False)


def test_what_does_not_matter_to_an_objective_costs_it_nothing() -> None:
    more = PARCELS + "objective: if knock then open within 30\n"
    assert told(more)[0] == told(PARCELS)[0]


def test_counting_ends_where_there_are_too_many(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_STATES", 5)
    monkeypatch.setattr(module, "_OF_ALL", 9)
    assert told(PARCELS) == [(10, 5, True)]


def test_it_is_said_in_few_words() -> None:
    span = parse(PARCELS, "parcels.pur").objectives[0].span
    assert Size(span, 1234, False).in_words() == "1,234 states"
    assert Size(span, 2000, True).in_words() == "over 2,000 states"
