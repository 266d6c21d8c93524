"""Conditions from the trees of statements."""

from __future__ import annotations

from typing import Any, Callable, Tuple

from pursue_gen.language.conditions import AllOf, AnyOf, At, Condition, Doing, Holds, Not, OnWay, Who
from pursue_gen.language.refs import Ref

RefOf = Callable[[Any], Ref]
"""From the tree of a name to the name and its place."""


def condition_of(tree: Any, ref: RefOf) -> Condition:
    """The condition that a tree of the grammar's `condition` holds."""
    if tree.data == "negation":
        return Not(condition_of(tree.children[0], ref))
    if tree.data in ("all_of", "any_of"):
        parts = tuple(condition_of(child, ref) for child in tree.children)
        return AllOf(parts) if tree.data == "all_of" else AnyOf(parts)
    if tree.data == "holds":
        state, value = tree.children
        return Holds(ref(state), value.type == "IS_TRUE")
    who, none = _who(tree.children[0], ref)
    condition: Condition = OnWay(who)
    if tree.data == "at":
        condition = At(who, ref(tree.children[1]))
    elif tree.data == "doing":
        condition = Doing(who, ref(tree.children[1]))
    return Not(condition) if none else condition


def _who(tree: Any, ref: RefOf) -> Tuple[Who, bool]:
    """Of whom a condition speaks; True behind it: of none of them."""
    first = tree.children[0]
    if getattr(first, "data", "") == "ref":
        return Who(ref(first)), False
    return Who(None, robots=len(tree.children) > 1), first.type == "NO"
