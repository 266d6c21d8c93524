"""Nobody asks for the kind of a statement, an objective, an assumption or an automaton, or for an exit status: who has
one says what is different with it. So one more kind needs no change elsewhere.
"""

from __future__ import annotations

import ast
import importlib
from pathlib import Path
from typing import Iterator, Sequence

import pytest

import pursue_gen
from pursue_gen.language.statements.base import Written

PACKAGE = Path(pursue_gen.__file__).parent
MODULES = [path for package in ("pursue_gen", "pursue_runtime") for path in (PACKAGE.parent / package).rglob("*.py")]

HOMES = ("language/statements/", "language/objectives/", "language/assumptions/")
"""Where kinds may know each other."""

TOKENS = {
    "language/": "where kinds of tokens, names and clauses are made",
    "tools/lsp/": "a text that is wrong has tokens alone, and nobody who could be asked",
    "tools/draw/": "the same",
}
"""Folders in which kinds of what stands in a text are compared, and why."""

_KINDS, _ENDS = ("kind",), ("exit_status", "returncode")


def _is_literal(node: ast.expr) -> bool:
    if isinstance(node, (ast.Tuple, ast.List, ast.Set)):
        return all(map(_is_literal, node.elts))
    if isinstance(node, ast.UnaryOp):
        return _is_literal(node.operand)
    return isinstance(node, ast.Constant) or (isinstance(node, ast.Starred) or getattr(node, "id", "").isupper())


def _compared(tree: ast.AST, *attributes: str) -> Iterator[str]:
    """Where these attributes, of others than `self`, are compared with a literal or a constant."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Compare):
            sides = [node.left, *node.comparators]
            asked = [each for each in sides if isinstance(each, ast.Attribute) and each.attr in attributes]
            if any(getattr(each.value, "id", "") != "self" for each in asked) and any(map(_is_literal, sides)):
                yield f"line {node.lineno}"


def _told_apart(tree: ast.AST, module: str) -> Iterator[str]:
    """Where it is asked whether something is a statement, an objective or an assumption of a kind."""
    for node in ast.walk(tree):
        asked: Sequence[ast.expr] = ()
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") in ("isinstance", "issubclass"):
            asked = node.args[1:]
        elif isinstance(node, ast.Compare):
            asked = [each for each in node.comparators if not isinstance(each, ast.Call)]
        named = [each.id for one in asked for each in ast.walk(one) if isinstance(each, ast.Name)]
        known = [getattr(importlib.import_module(module), name, None) for name in named]
        if any(isinstance(each, type) and issubclass(each, Written) for each in known):
            yield f"line {getattr(node, 'lineno', 0)}"


def _defines(tree: ast.AST, attribute: str) -> bool:
    """True for the home of something that has this attribute."""
    fields = [each for node in ast.walk(tree) if isinstance(node, ast.ClassDef) for each in node.body]
    return any(isinstance(each, ast.AnnAssign) and getattr(each.target, "id", "") == attribute for each in fields)


@pytest.mark.parametrize(
    "asked",
    [
        "isinstance(each, Request)", "isinstance(each, (Ref, Patrol))", "type(each) is Poi", "type(each) in (Reaches,)",
        "each.kind == 'robot'", "each.kind not in (ROBOT, PERSON)", "run.exit_status != 5", "-9 == run.returncode",
    ],
)  # fmt: skip
def test_who_asks_is_found(asked: str) -> None:
    tree = ast.parse(asked)
    assert len([*_told_apart(tree, "pursue_gen.language.scenario"), *_compared(tree, *_KINDS, *_ENDS)]) == 1


def test_who_asks_something_else_is_not() -> None:
    tree = ast.parse("isinstance(each, Ref); each.kind == other.kind; self.kind == 'robot'; X.of(each) == other")
    assert [*_told_apart(tree, "pursue_gen.language.scenario"), *_compared(tree, *_KINDS, *_ENDS)] == []


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(PACKAGE.parent)))
def test_no_module_asks_for_a_kind_or_an_exit_status(path: Path) -> None:
    tree, within = ast.parse(path.read_text(encoding="utf-8")), path.relative_to(PACKAGE.parent)
    file = "/".join(within.parts[1:])
    found = list(_compared(tree, *_ENDS))
    if not file.startswith(tuple(TOKENS)) and not _defines(tree, *_KINDS):
        found += _compared(tree, *_KINDS)
    if within.parts[0] == PACKAGE.name and not file.startswith(HOMES):
        found += _told_apart(tree, ".".join(each for each in within.with_suffix("").parts if each != "__init__"))
    assert found == []
