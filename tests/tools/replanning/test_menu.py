"""Which orders would be accepted at the start is told where the scenario is solved."""

from __future__ import annotations

from pursue_gen import api
from tests.runtime.observer.test_ordering import TEA


def test_what_would_be_accepted_and_what_refused_is_told() -> None:
    text = TEA.replace("then serve2 within 60", "then serve2 within 9")
    solved = api.solve(api.parse(text))
    assert solved.orders["tea1"] == "" and "serve2 within 9' cannot be promised" in solved.orders["tea2"]
    lines = solved.in_words()
    assert "Orders that would be accepted at the start, each alone: tea1." in lines
    assert any(line.startswith("tea2 would be refused: ") for line in lines)
    assert solved.as_json()["orders"] == solved.orders


def test_nothing_is_told_where_nothing_is_ordered() -> None:
    text = TEA.replace(" on_order", "").replace("can_do serve1", "can_do tea1, tea2, serve1")
    assert api.solve(api.parse(text)).orders == {}
