"""Parameters of nodes are read, or refused by their name with what was expected."""

from __future__ import annotations

from typing import Any, Callable, Dict, Mapping

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime import parameters
from pursue_runtime.observer.settings import read_settings
from pursue_runtime.parameters import ParameterError
from pursue_runtime.simulator.clock import read_pace
from pursue_runtime.ui.options import read_options

Read = Callable[[Mapping[str, Any]], Any]
NAN, INFINITE = float("nan"), float("inf")


TOLD = {"config": "", "planner": "pursue-gen replan", "journal": "on", "launch": ""}


def observer(params: Mapping[str, Any]) -> Any:
    return read_settings(params, TOLD)


def ui(params: Mapping[str, Any]) -> Any:
    return read_options([], params, False, ())


def test_what_is_not_given_is_as_documented() -> None:
    settings = observer({})
    assert settings._asdict() == {
        "time_unit": 1.0, "tolerance": 0.1, "on_uncovered": "plan", "lost_after": 30.0, "silence": 20.0,
        "heartbeat": 1.0, "planner": "pursue-gen replan", "planning_limit": 10.0, "journal": "on", "launch": "",
        "linger": 1.0, "received": False, "again": False, "shared_ends": "all",
        "plain_words": False,
    }  # fmt: skip


@pytest.mark.parametrize("name, value, found", [
    ("time_unit", 2, 2.0),
    ("time_unit", "1e-1", 0.1),  # what YAML takes for a text
    ("tolerance", 0, 0.0),
    ("lost_after", 0, 0.0),
    ("linger", 0, 0.0),
    ("on_uncovered", "warn", "warn"),
    ("again", True, True),
    ("received", "true", True),
])
def test_a_value_that_can_be_is_taken(name: str, value: object, found: object) -> None:
    assert getattr(observer({name: value}), name) == found


@pytest.mark.parametrize("name, value", [("planner", "reboot"), ("journal", "/etc/passwd"), ("launch", "x")])
def test_what_the_process_was_told_no_parameter_changes(name: str, value: str) -> None:
    assert getattr(observer({name: value}), name) == TOLD[name]
    assert getattr(read_settings({}, {**TOLD, name: value}), name) == value


ABOVE = "expected a number greater than 0"
LEAST = "expected a number of at least 0"


@pytest.mark.parametrize("read, name, values, expected", [
    *((observer, name, (0, -1, NAN, INFINITE, "text", "", None, True, [1]), ABOVE)
      for name in ("time_unit", "silence", "heartbeat", "planning_limit")),
    *((observer, name, (-1, -0.1, NAN, INFINITE, "nan", "text", False), LEAST)
      for name in ("tolerance", "lost_after", "linger")),
    (observer, "on_uncovered", ("nonsense", "", 1, None, []), "expected one of plan, stop, warn"),
    (observer, "again", ("yes", 1, None), "expected true or false"),
    (observer, "received", (0, "x"), "expected true or false"),
    *((read_pace, name, (0, -1, NAN, INFINITE, "text"), ABOVE) for name in ("time_unit", "speed", "step")),
    (read_pace, "hold", (-1, NAN, "text"), LEAST),
    (ui, "wait", (-1, NAN), LEAST),
    (ui, "pace", (0, -1, INFINITE), ABOVE),
    (ui, "seed", (1.5, "x", True, INFINITE), "expected a whole number"),
])
def test_a_value_that_cannot_be_is_refused_by_its_name(read: Read, name: str, values: Any, expected: str) -> None:
    for value in values:
        with pytest.raises(ParameterError) as caught:
            read({name: value})
        assert str(caught.value).startswith(f"~{name} is {value!r}; {expected}"), caught.value


ANY = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=5), st.lists(st.integers(), max_size=2)
)
READERS: Dict[str, Callable[..., object]] = {
    "number": lambda found: parameters.number(found, "x", 1.0),
    "whole": lambda found: parameters.whole(found, "x", 1, least=0, most=9),
    "choice": lambda found: parameters.choice(found, "x", "a", ("a", "b")),
    "flag": lambda found: parameters.flag(found, "x"),
    "text": lambda found: parameters.text(found, "x"),
    "names": lambda found: parameters.names(found, "x"),
}
KINDS: Dict[str, Any] = {"number": float, "whole": int, "flag": bool, "names": tuple}


@pytest.mark.parametrize("reader", sorted(READERS))
@given(value=ANY)
def test_whatever_is_given_it_is_read_or_refused(reader: str, value: object) -> None:
    try:
        found = READERS[reader]({"x": value})
    except ParameterError as problem:
        assert str(problem).startswith("~x is ")
    else:
        assert type(found) is KINDS.get(reader, str)
        assert reader != "number" or 0 <= found < INFINITE  # type: ignore[operator]
        assert reader != "whole" or 0 <= found <= 9  # type: ignore[operator]
