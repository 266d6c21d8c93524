"""The expressions in UPPAAL's labels, as far as networks of this tool use them: guards, invariants, updates, channels.

Every function here raises ValueError with a sentence; the reader adds the place.
"""

from __future__ import annotations

import re
from collections import deque
from dataclasses import dataclass
from itertools import islice
from typing import AbstractSet, Deque, List, Optional, Sequence, Tuple, Union

from pursue_gen.tga.network import Clause, ClockBound, Guard, Sync, Test

_TOKEN = re.compile(r"\s*(?:(?P<token>[A-Za-z_]\w*|\d+|&&|\|\||<=|>=|==|!=|:=|[-()<>=!?,+*/.\[\]'])|(?P<other>\S))")
_NAME = re.compile(r"[A-Za-z_]\w*\Z")
_SYNC = re.compile(r"\s*([A-Za-z_]\w*)\s*([!?])\s*\Z")
_OPERATORS = ("<", "<=", ">", ">=", "==")
_WORDS = {"and": "&&", "or": "||"}
_DEPTH = 50
"""So many parentheses may be open at once."""
_DIGITS = 18
"""The longest number; it fits 64 bits."""


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
    if len(digits[0]) > _DIGITS:
        raise ValueError(f"a number has more than {_DIGITS} digits")
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
    words = deque(_WORDS.get(word, word) for word in tokens(text))
    if not words:
        return ()
    expression = _junction(words, "||", 0)
    if words:
        raise ValueError(f"'{words[0]}' was not expected in '{text.strip()}'")
    return _parts(expression, "&&")


def _parts(expression: _Expression, op: str) -> Tuple[_Expression, ...]:
    """The operands of nested junctions of that operator; the expression itself where it is none."""
    if isinstance(expression, _Junction) and expression.op == op:
        return tuple(inner for part in expression.parts for inner in _parts(part, op))
    return (expression,)


def _junction(words: Deque[str], op: str, depth: int) -> _Expression:
    """Takes an expression of operands joined by `op` from the words. `&&` binds closer than `||`."""
    parts: List[_Expression] = []
    while True:
        parts.append(_junction(words, "&&", depth) if op == "||" else _operand(words, depth))
        if not words or words[0] != op:
            return parts[0] if len(parts) == 1 else _Junction(op, tuple(parts))
        words.popleft()


def _operand(words: Deque[str], depth: int) -> _Expression:
    """Takes a comparison, a constant or an expression in parentheses from the words; `depth` of them are open."""
    if words and words[0] == "(":
        if depth == _DEPTH:
            raise ValueError(f"more than {_DEPTH} parentheses are open at once")
        words.popleft()
        expression = _junction(words, "||", depth + 1)
        if not words or words.popleft() != ")":
            raise ValueError("a parenthesis is not closed")
        return expression
    if words and words[0] in _CONSTANTS:
        return _CONSTANTS[words.popleft()]
    parts = list(islice(words, 4))
    if len(parts) < 3 or not _NAME.match(parts[0]):
        raise ValueError(f"'{' '.join(parts[:3])}' stands where 'name operator number' was expected")
    length = 4 if parts[2] == "-" else 3
    if parts[1] not in _OPERATORS:
        raise ValueError(f"'{' '.join(parts[:length])}': the operator {parts[1]} is not one of {' '.join(_OPERATORS)}")
    for _ in parts[:length]:
        words.popleft()
    return _Comparison(parts[0], parts[1], integer(parts[2:length]))


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
