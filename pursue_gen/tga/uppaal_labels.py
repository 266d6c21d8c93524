"""The expressions in UPPAAL's labels, as far as networks of this tool use them: guards, invariants, updates, channels.

Every function here raises ValueError with a sentence; the reader adds the place.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import AbstractSet, List, Optional, Sequence, Tuple, Union

from pursue_gen.tga.network import Clause, ClockBound, Guard, Sync, Test

_TOKEN = re.compile(r"\s*(?:(?P<token>[A-Za-z_]\w*|\d+|&&|\|\||<=|>=|==|!=|:=|[-()<>=!?,+*/.\[\]'])|(?P<other>\S))")
_NAME = re.compile(r"[A-Za-z_]\w*\Z")
_SYNC = re.compile(r"\s*([A-Za-z_]\w*)\s*([!?])\s*\Z")
_OPERATORS = ("<", "<=", ">", ">=", "==")
_WORDS = {"and": "&&", "or": "||"}


@dataclass(frozen=True)
class _Comparison:
    name: str
    op: str
    value: int


@dataclass(frozen=True)
class _Junction:
    """All of the parts (op `&&`) or any of them (op `||`)."""

    op: str
    parts: Tuple[_Expression, ...]


_Expression = Union[_Comparison, _Junction]

_CONSTANTS = {"true": _Junction("&&", ()), "false": _Junction("||", ())}

Update = Tuple[Tuple[Tuple[str, int], ...], Tuple[str, ...]]
"""Assignments of variables, and clocks that are reset."""


@dataclass(frozen=True)
class Names:
    """The declared clocks, integer variables and broadcast channels."""

    clocks: AbstractSet[str]
    variables: AbstractSet[str]
    channels: AbstractSet[str]


def tokens(text: str) -> List[str]:
    """The words and signs of the text. Raises ValueError at a sign that no label has."""
    result = []
    position, text = 0, text.rstrip()
    while position < len(text):
        match = _TOKEN.match(text, position)
        if match is None or match.group("other"):
            sign = match.group("other") if match else text[position]
            raise ValueError(f"'{sign}' was not expected in '{text.strip()}'")
        result.append(match.group("token"))
        position = match.end()
    return result


def parse_guard(text: str, names: Names) -> Guard:
    """The guard of an edge: bounds of clocks and tests of variables, joined by &&; || only between tests."""
    clocks: List[ClockBound] = []
    clauses: List[Clause] = []
    for part in _conjuncts(text):
        if isinstance(part, _Comparison) and part.name in names.clocks:
            clocks.append(ClockBound(part.name, part.op, part.value))
        else:
            clauses.append(tuple(_test(test, names) for test in _alternatives(part)))
    return Guard(tuple(clocks), tuple(clauses))


def parse_invariant(text: str, names: Names) -> Tuple[ClockBound, ...]:
    """The invariant of a location: upper bounds of clocks, joined by &&."""
    bounds = []
    for part in _conjuncts(text):
        if not isinstance(part, _Comparison) or part.name not in names.clocks:
            raise ValueError(f"the invariant '{text.strip()}' is not a conjunction of bounds of declared clocks")
        if part.op not in ("<", "<="):
            raise ValueError(f"'{part.name} {part.op} {part.value}': an invariant can only bound a clock from above")
        bounds.append(ClockBound(part.name, part.op, part.value))
    return tuple(bounds)


def parse_sync(text: str, names: Names) -> Optional[Sync]:
    """The channel of an edge, None for an empty label."""
    if not text.strip():
        return None
    match = _SYNC.match(text)
    if match is None:
        raise ValueError(f"'{text.strip()}' is not 'channel!' or 'channel?'")
    channel, direction = match.groups()
    if channel not in names.channels:
        raise ValueError(f"{channel} is not a declared broadcast channel")
    return Sync(channel, direction == "!")


def parse_update(text: str, names: Names) -> Update:
    """The assignments of integer variables and the clocks that are reset, each in the order written."""
    assign: List[Tuple[str, int]] = []
    resets: List[str] = []
    for statement in _split(tokens(text), ","):
        if len(statement) < 3 or not _NAME.match(statement[0]) or statement[1] not in ("=", ":="):
            raise ValueError(f"'{' '.join(statement)}' is not an assignment 'name = number'")
        name, value = statement[0], integer(statement[2:])
        if name in names.variables:
            assign.append((name, value))
        elif name not in names.clocks:
            raise ValueError(f"{name} is neither a declared clock nor a declared variable")
        elif value != 0:
            raise ValueError(f"'{name} = {value}': a clock can only be reset to 0")
        else:
            resets.append(name)
    return tuple(assign), tuple(resets)


def integer(words: Sequence[str]) -> int:
    """The number that the words make, `-` allowed before it."""
    sign, digits = (-1, words[1:]) if words and words[0] == "-" else (1, words)
    if len(digits) != 1 or not digits[0].isdigit():
        raise ValueError(f"'{' '.join(words)}' stands where a number was expected")
    return sign * int(digits[0])


def _split(words: Sequence[str], separator: str) -> List[List[str]]:
    """The stretches between separators; none for no words."""
    if not words:
        return []
    result: List[List[str]] = [[]]
    for word in words:
        if word == separator:
            result.append([])
        else:
            result[-1].append(word)
    return result


def _conjuncts(text: str) -> Tuple[_Expression, ...]:
    words = [_WORDS.get(word, word) for word in tokens(text)]
    if not words:
        return ()
    expression, rest = _junction(words, "||")
    if rest:
        raise ValueError(f"'{rest[0]}' was not expected in '{text.strip()}'")
    return _parts(expression, "&&")


def _parts(expression: _Expression, op: str) -> Tuple[_Expression, ...]:
    """The operands of nested junctions of that operator; the expression itself where it is none."""
    if isinstance(expression, _Junction) and expression.op == op:
        return tuple(inner for part in expression.parts for inner in _parts(part, op))
    return (expression,)


def _junction(words: List[str], op: str) -> Tuple[_Expression, List[str]]:
    """An expression of operands joined by `op`, and the words after it. `&&` binds closer than `||`."""
    parts = []
    while True:
        part, words = _junction(words, "&&") if op == "||" else _operand(words)
        parts.append(part)
        if words[:1] != [op]:
            return (parts[0] if len(parts) == 1 else _Junction(op, tuple(parts))), words
        words = words[1:]


def _operand(words: List[str]) -> Tuple[_Expression, List[str]]:
    if words[:1] == ["("]:
        expression, rest = _junction(words[1:], "||")
        if rest[:1] != [")"]:
            raise ValueError("a parenthesis is not closed")
        return expression, rest[1:]
    if words and words[0] in _CONSTANTS:
        return _CONSTANTS[words[0]], words[1:]
    if len(words) < 3 or not _NAME.match(words[0]):
        raise ValueError(f"'{' '.join(words[:3])}' stands where 'name operator number' was expected")
    length = 4 if words[2] == "-" else 3
    if words[1] not in _OPERATORS:
        raise ValueError(f"'{' '.join(words[:length])}': the operator {words[1]} is not one of {' '.join(_OPERATORS)}")
    return _Comparison(words[0], words[1], integer(words[2:length])), words[length:]


def _alternatives(expression: _Expression) -> Tuple[_Comparison, ...]:
    parts = _parts(expression, "||")
    comparisons = tuple(part for part in parts if isinstance(part, _Comparison))
    if len(comparisons) < len(parts):
        raise ValueError("an && inside an || is not supported: only tests 'variable == number' may stand there")
    return comparisons


def _test(comparison: _Comparison, names: Names) -> Test:
    shown = f"{comparison.name} {comparison.op} {comparison.value}"
    if comparison.name in names.clocks:
        raise ValueError(f"'{shown}': the bound of a clock cannot stand inside an ||")
    if comparison.name not in names.variables:
        raise ValueError(f"'{shown}': {comparison.name} is neither a declared clock nor a declared variable")
    if comparison.op != "==":
        raise ValueError(f"'{shown}': a variable can only be compared with ==")
    return Test(comparison.name, comparison.value)
