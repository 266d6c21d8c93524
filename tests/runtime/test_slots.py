"""Whose connection goes for a new one: never that of somebody who is alone at an address while another one floods."""

from __future__ import annotations

from typing import Dict, List, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime.slots import Slots, is_loopback

FLOOD, OPERATOR, HERE = "10.0.0.66", "10.0.0.2", "127.0.0.1"


def fill(slots: "Slots[int]", address: str, *keys: int) -> List[int]:
    """Adds connections of an address; those that went for them."""
    gone = [slots.take(key, address) for key in keys]
    return [key for key in gone if key is not None]


def test_an_address_has_half_of_the_places_and_its_oldest_goes_first() -> None:
    slots: Slots[int] = Slots(8)
    assert fill(slots, FLOOD, *range(6)) == [0, 1] and len(slots) == 4
    assert fill(slots, OPERATOR, 100) == []
    assert fill(slots, FLOOD, 6) == [2]


def test_with_many_addresses_the_oldest_of_the_one_with_the_most_goes() -> None:
    slots: Slots[int] = Slots(8)
    fill(slots, OPERATOR, 100)
    fill(slots, FLOOD, 0, 1, 2, 3)
    fill(slots, "10.0.0.67", 10)
    assert fill(slots, "10.0.0.3", 101) == [0]


def test_other_machines_never_take_the_places_of_this_one() -> None:
    slots: Slots[int] = Slots(8)
    for number in range(50):
        slots.take(number, f"10.0.0.{number}")
    assert len(slots) == 6
    assert fill(slots, HERE, 100) == fill(slots, "::1", 101) == []
    for number in range(50):
        assert slots.take(200 + number, f"10.0.1.{number}") not in (100, 101)


def test_the_first_look_at_who_would_go_changes_nothing() -> None:
    slots: Slots[int] = Slots(1)
    assert slots.victim(HERE) is None and len(slots) == 0
    slots.take(1, HERE)
    assert slots.victim(HERE) == slots.victim(OPERATOR) == 1 and list(slots) == [1]


def test_who_may_be_here_stays_at_a_flood_of_its_own_address_too() -> None:
    slots: Slots[int] = Slots(8)
    slots.take(100, FLOOD)
    slots.trust(100)
    assert 100 not in fill(slots, FLOOD, *range(50))
    slots.free(100)
    slots.trust(100)
    assert 100 not in slots


def test_one_network_of_ipv6_is_one_sender_and_a_mapped_address_is_itself() -> None:
    slots: Slots[int] = Slots(4)
    assert [slots.take(number, f"2001:db8::{number + 1}") for number in range(3)] == [None, None, 0]
    slots = Slots(4)
    assert fill(slots, "::ffff:127.0.0.1", 10) == fill(slots, HERE, 11) == []
    assert fill(slots, HERE, 12) == [10]


ADDRESSES = [HERE, "127.0.0.2", "::1", FLOOD, OPERATOR, "10.0.0.3", "fe80::1%eth0"]


@given(st.lists(st.tuples(st.sampled_from(ADDRESSES), st.sampled_from(["take", "take", "trust", "free"])), max_size=60))
def test_all_limits_hold_and_only_who_was_here_goes(calls: List[Tuple[str, str]]) -> None:
    slots: Slots[int] = Slots(8)
    here: Dict[int, str] = {}
    for key, (address, call) in enumerate(calls):
        if call == "take":
            victim = slots.take(key, address)
            assert victim is None or here.pop(victim)
            here[key] = address
        elif here and call == "trust":
            slots.trust(min(here))
        elif here:
            slots.free(min(here))
            del here[min(here)]
        assert list(slots) == list(here) and len(slots) <= 8
        senders = list(here.values())
        assert all(senders.count(each) <= 4 for each in senders)
        assert sum(not is_loopback(each) for each in senders) <= 6


@pytest.mark.parametrize("host, loopback", [
    ("127.0.0.1", True), ("localhost", True), ("::1", True), ("127.9.9.9", True), ("0.0.0.0", False), ("::", False),
    ("", False), ("10.0.0.1", False), ("robot", False), ("localhost.example", False),
])
def test_loopback_is_distinguished_from_other_addresses(host: str, loopback: bool) -> None:
    assert is_loopback(host) is loopback
