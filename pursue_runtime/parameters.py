"""Parameters of nodes: each is checked by its name, and refused with what was expected.

`given` are a node's private parameters as they were read, by name: values of any type.
"""

from __future__ import annotations

from typing import Any, Mapping, Optional, Sequence, Tuple

from pursue_runtime.data import DataError


class ParameterError(DataError):
    """A parameter has a value that it cannot have; the message names it and says what was expected."""


def number(given: Mapping[str, Any], name: str, default: float, least: float = 0.0, above: bool = False) -> float:
    """Return a finite number that is at least `least`, or `above` it; a text of digits counts. Raises
    ParameterError."""
    value = given.get(name, default)
    try:
        found = float("nan") if isinstance(value, bool) else float(value)
    except (TypeError, ValueError, OverflowError):
        found = float("nan")
    if not least <= found < float("inf") or (above and found == least):
        bound = f" greater than {least:g}" if above else f" of at least {least:g}" if least > float("-inf") else ""
        raise ParameterError(f"~{name} is {value!r}; expected a number{bound}")
    return found


def whole(
    given: Mapping[str, Any], name: str, default: int, least: Optional[int] = 0, most: Optional[int] = None
) -> int:
    """Return a whole number between these bounds; a text of digits counts. Raises ParameterError."""
    value = given.get(name, default)
    try:
        found = None if isinstance(value, bool) or (isinstance(value, float) and value % 1) else int(value)
    except (TypeError, ValueError, OverflowError):
        found = None
    if found is None or (least is not None and found < least) or (most is not None and found > most):
        bounds = [f"at least {least}"] * (least is not None) + [f"at most {most}"] * (most is not None)
        raise ParameterError(f"~{name} is {value!r}; expected a whole number{' of ' * bool(bounds)}{', '.join(bounds)}")
    return found


def choice(given: Mapping[str, Any], name: str, default: str, known: Sequence[str]) -> str:
    """Return one of the known texts. Raises ParameterError."""
    value = given.get(name, default)
    if value not in known:
        raise ParameterError(f"~{name} is {value!r}; expected one of {', '.join(known)}")
    return str(value)


def flag(given: Mapping[str, Any], name: str, default: bool = False) -> bool:
    """Return True or False. Raises ParameterError."""
    value = given.get(name, default)
    if isinstance(value, str) and value.lower() in ("true", "false"):
        value = value.lower() == "true"
    if not isinstance(value, bool):
        raise ParameterError(f"~{name} is {value!r}; expected true or false")
    return value


def text(given: Mapping[str, Any], name: str, default: str = "") -> str:
    """Return a text; for ROS on and off are true and false. Raises ParameterError."""
    value = given.get(name, default)
    if isinstance(value, bool):
        return "on" if value else "off"
    if not isinstance(value, (str, int, float)):
        raise ParameterError(f"~{name} is {value!r}; expected a text")
    return str(value)


def names(given: Mapping[str, Any], name: str, default: Sequence[str] = ()) -> Tuple[str, ...]:
    """Return a list of names; a text has commas or blanks between them. Raises ParameterError."""
    value = given.get(name, default)
    if isinstance(value, str):
        value = value.replace(",", " ").split()
    if not isinstance(value, (list, tuple)) or not all(isinstance(each, str) for each in value):
        raise ParameterError(f"~{name} is {value!r}; expected a list of names")
    return tuple(value)
