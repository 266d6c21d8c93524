"""The small texts of a plan, both ways: numbers, clock constraints, zones, guards and assignments.

A constraint stands as UPPAAL-TIGA prints it: `1<C`, `C<=5`, `A-B<-2`, `A<=B`, `C==3`. Bounds of our own plans need not
be whole: they stand as decimals where that is exact (`1.1`), else as fractions (`4/3`).
"""

from __future__ import annotations

import re
from fractions import Fraction
from typing import Dict, FrozenSet, Iterator, List, Optional, Tuple

from pursue_gen.language.numbers import decimal_text
from pursue_gen.synthesis.strategy import Constraint, Zone
from pursue_gen.tga.network import Edge, Guard

ALWAYS = "true"
"""How the zone without constraints is written."""

# Eighteen digits are more than any model has, and bound the work on a damaged file.
_NUMBER = r"-?\d{1,18}(?:\.\d{1,18}|/0{0,17}[1-9]\d{0,17})?"
_CLOCKS = r"([A-Za-z_]\w*)(?:-([A-Za-z_]\w*))?"
_CONSTRAINT = re.compile(rf"(?:({_NUMBER})|{_CLOCKS})(<=|<|==|>=|>)(?:({_NUMBER})|{_CLOCKS})")


def constraint_text(constraint: Constraint, space: str = "") -> str:
    """The constraint as TIGA prints it; `space` stands around the operators."""
    left, right, bound = constraint.left, constraint.right, constraint.bound
    op = f"{space}{'<' if constraint.strict else '<='}{space}"
    if left is None:
        return f"{decimal_text(-bound)}{op}{right}"
    if right is None:
        return f"{left}{op}{decimal_text(bound)}"
    if bound == 0:
        return f"{left}{op}{right}"
    return f"{left}{space}-{space}{right}{op}{decimal_text(bound)}"


def _is_equality(one: Constraint, other: Constraint) -> bool:
    """True where `one` and then `other` is what the reader makes of an equality."""
    return (
        one.left is not None
        and not (one.strict or other.strict)
        and (other.left, other.right) == (one.right, one.left)
        and other.bound == -one.bound
    )


def constraint_texts(zone: Zone, space: str = "", known: Optional[Dict[int, str]] = None) -> Iterator[str]:
    """The zone's constraints as texts, in order; a pair that fixes a value becomes one equality.

    `known`: the texts of constraints by their identity, for constraints that stand in many zones.
    """
    texts = {} if known is None else known
    index = 0
    while index < len(zone):
        if index + 1 < len(zone) and _is_equality(zone[index], zone[index + 1]):
            yield constraint_text(zone[index], space).replace("<=", "==")
            index += 2
        else:
            constraint = zone[index]
            yield texts.get(id(constraint)) or texts.setdefault(id(constraint), constraint_text(constraint, space))
            index += 1


def zones_text(zones: Tuple[Zone, ...], known: Optional[Dict[int, str]] = None) -> str:
    """The zones as TIGA prints a federation: `(a && b) || (c)`, or `true`.

    `known`: the texts of zones and of constraints by their identity, for those that stand in many places.
    """
    if zones == ((),):
        return ALWAYS
    texts = {} if known is None else known
    return " || ".join(texts.get(id(zone)) or texts.setdefault(id(zone), _zone_text(zone, texts)) for zone in zones)


def _zone_text(zone: Zone, known: Dict[int, str]) -> str:
    return f"({' && '.join(constraint_texts(zone, known=known)) or ALWAYS})"


def read_constraint(text: str) -> Optional[Tuple[Constraint, ...]]:
    """The constraint in a text without blanks (an equality makes two); None where it is no constraint on clocks."""
    match = _CONSTRAINT.fullmatch(text)
    if not match:
        return None
    low, a, b, op, high, c, d = match.groups()
    plus: List[str] = [clock for clock in (a, d) if clock]
    minus: List[str] = [clock for clock in (b, c) if clock]
    if len(plus) > 1 or len(minus) > 1 or not plus + minus or plus == minus:
        return None
    left, right = (plus[0] if plus else None), (minus[0] if minus else None)
    bound = Fraction(high or 0) - Fraction(low or 0)
    upper = Constraint(left, right, bound, op == "<")
    lower = Constraint(right, left, -bound, op == ">")
    if op == "==":
        # `3 == C` means `C == 3`: one order, so that what was read is written the same.
        return (upper, lower) if left is not None else (lower, upper)
    return (upper,) if op in ("<", "<=") else (lower,)


def guard_text(guard: Guard) -> str:
    """The guard as TIGA prints it (`C > 1 && P == 2`), `1` where there is none."""
    parts = [f"{bound.clock} {bound.op} {decimal_text(bound.bound)}" for bound in guard.clocks]
    for clause in guard.integers:
        tests = " || ".join(f"{test.variable} == {test.value}" for test in clause)
        parts.append(f"({tests})" if len(clause) > 1 else tests)
    return " && ".join(parts) or "1"


def assign_text(edge: Edge) -> str:
    """The edge's assignments and resets as TIGA prints them (`P := 2, C := 0`), `1` where there are none."""
    parts = [f"{variable} := {value}" for variable, value in edge.assign]
    return ", ".join(parts + [f"{clock} := 0" for clock in edge.resets]) or "1"


def sync_text(edge: Edge) -> str:
    """`channel!`, `channel?` or `tau`."""
    return "tau" if edge.sync is None else f"{edge.sync.channel}{'!' if edge.sync.sends else '?'}"


def guard_meaning(text: str) -> FrozenSet[FrozenSet[str]]:
    """What a guard's text says, whatever its order, blanks and parentheses: the set of its clauses."""
    bare = re.sub(r"[\s()]", "", text)
    clauses = (frozenset(part.split("||")) for part in bare.split("&&"))
    return frozenset(clauses) - {frozenset(("1",)), frozenset((ALWAYS,)), frozenset(("",))}


def assign_meaning(text: str) -> FrozenSet[str]:
    """What an assignment's text says, whatever its order and blanks."""
    return frozenset(re.sub(r"\s", "", text).replace(":=", "=").split(",")) - {"1", ""}
