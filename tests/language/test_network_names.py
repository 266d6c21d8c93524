"""The names of the network say what they stand for, as they are made and as they are read from files."""

from __future__ import annotations

import copy
import pickle
from typing import Any, Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.language import network_names as names
from pursue_gen.language.symbols import UNDER_WAY, Role, Symbol, role_of

MADE = [
    (names.going("a", "b"), Role.WAY, ("a", "b")),
    (names.doing("catch", "b"), Role.WORK, ("catch", "b")),
    (names.at("a"), Role.AT, ("a",)),
    (names.at("along_the_way"), Role.AT, ("along_the_way",)),
    (names.at("win"), Role.AT, ("win",)),
]


@pytest.mark.parametrize(("location", "role", "parts"), MADE)
def test_a_location_says_what_its_agent_does(location: Symbol, role: Role, parts: Any) -> None:
    assert (location.role, location.parts) == (role, parts)
    assert (role in UNDER_WAY) == (role is not Role.AT)


READ = [
    names.going("a", "b_to"),
    names.doing("hand_in_hand", "b"),
    names.did(1, 12),
    names.IDLE,
    names.AT_RISK,
    names.LOSE,
    names.START,
    names.UNLOCKED,
    names.WIN,
    names.LATE,
    names.safety_objective(0),
    names.safety_objective(11),
    names.reach_objective(0),
    names.reach_objective(1),
    names.done("catch"),
    names.assumption(3),
]


@pytest.mark.parametrize("symbol", READ)
def test_what_a_name_of_a_file_stands_for_is_read_as_it_was_made(symbol: Symbol) -> None:
    read = Symbol.of(str(symbol))
    assert (read, read.role, read.parts) == (symbol, symbol.role, symbol.parts)


@pytest.mark.parametrize("text", ["hall", "obj1", "reachObj0", "did_", "DONE", "assumed", "going", "objective"])
def test_any_other_name_stands_for_itself_alone(text: str) -> None:
    assert role_of(text) is Role.NAME


@given(st.text(min_size=1))
def test_a_symbol_is_its_text(text: str) -> None:
    symbol = Symbol(text, Role.AT, (text,))
    assert symbol == text and hash(symbol) == hash(text) and {symbol: 1}[text] == 1
    assert sorted([symbol, text + "a"]) == [text, text + "a"]


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))])
def test_a_symbol_is_the_same_in_another_process(again: Callable[[Symbol], Symbol]) -> None:
    symbol = names.movement("bot", "a", "b")
    other = again(symbol)
    assert other == symbol and type(other) is Symbol
    assert (other.role, other.parts) == (symbol.role, symbol.parts)


def test_a_symbol_is_frozen_and_keeps_its_role_by_another_name() -> None:
    symbol = names.going("a", "b")
    with pytest.raises(AttributeError):
        symbol.role = Role.AT
    assert (symbol.called("elsewhere"), symbol.called("elsewhere").role) == ("elsewhere", Role.WAY)
