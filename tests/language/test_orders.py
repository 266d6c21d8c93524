"""Events that people order: which parts they may have, and who must not do them."""

from __future__ import annotations

import pytest

from tests.language.texts import findings

BEFORE = 'poi "kitchen" poi "room" connect kitchen and room distance 5 event "serve" location room duration 3 '
AFTER = 'agent "bot" controllable mobile 1 location kitchen can_do serve{} objective: if tea then serve within 60'


def codes(event: str, does: str = "", more: str = "") -> list:
    return [each.code for each in findings(f'{BEFORE} event "tea" on_order{event} {more} {AFTER.format(does)}')]


@pytest.mark.parametrize("event", ["", " at_most 3 times"])
def test_an_order_may_be_limited(event: str) -> None:
    assert codes(event) == []


@pytest.mark.parametrize(
    "event", [" collaborative", " location room", " duration 3", " duration 3 may_stop", " only_if bot at room"]
)
def test_an_order_is_said_and_not_done(event: str) -> None:
    assert "PML450" in codes(event)


def test_nobody_does_what_people_order() -> None:
    assert codes("", does=", tea") == ["PML451"]


def test_an_order_waits_for_no_state() -> None:
    state = 'state "open": initially true, true_if serve false_if tea stateDependency: tea only_if open is_true'
    assert codes("", more=state) == ["PML451"]


def test_an_order_that_nothing_names_is_told() -> None:
    assert codes("", more='event "milk" on_order') == ["PML157"]
