"""Nobody asks for the kind of a statement, an objective, an assumption or an automaton, or for an exit status: who has
one says what is different with it. So one more kind needs no change elsewhere.
"""

from __future__ import annotations

import ast
import importlib
from pathlib import Path
from typing import Iterator, List, Sequence

import pytest

import pursue_gen
from pursue_gen.language.statements.base import Written

PACKAGE = Path(pursue_gen.__file__).parent

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


def _told_apart(tree: ast.AST) -> Iterator[str]:
    """Where it is asked whether something is a statement, an objective or an assumption of a kind."""
    nodes = list(ast.walk(tree))
    imported = {
        each.asname or each.name: (node.module, each.name)
        for node in nodes
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("pursue_gen.language")
        for each in node.names
    }

    def meant(node: ast.expr) -> object:
        if isinstance(node, ast.Attribute):
            return getattr(meant(node.value), node.attr, None)
        module, name = imported.get(getattr(node, "id", ""), (None, ""))
        if module is None:
            return None
        return getattr(importlib.import_module(module), name, None) or importlib.import_module(f"{module}.{name}")

    for node in nodes:
        asked: Sequence[ast.expr] = ()
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") in ("isinstance", "issubclass"):
            asked = node.args[1:]
        elif isinstance(node, ast.Compare):
            asked = [each for each in node.comparators if not isinstance(each, ast.Call)]
        known = [meant(each) for one in asked for each in ast.walk(one) if isinstance(each, (ast.Name, ast.Attribute))]
        if any(isinstance(each, type) and issubclass(each, Written) for each in known):
            yield f"line {getattr(node, 'lineno', 0)}"


def _defines(tree: ast.AST, attribute: str) -> bool:
    """True for the home of something that has this attribute."""
    fields = [each for node in ast.walk(tree) if isinstance(node, ast.ClassDef) for each in node.body]
    return any(isinstance(each, ast.AnnAssign) and getattr(each.target, "id", "") == attribute for each in fields)


IMPORTED = """
from pursue_gen.language import scenario as pml
from pursue_gen.language.objectives.holds import Holds as Room
from pursue_gen.language.scenario import Reaches, Ref, Request
"""


@pytest.mark.parametrize(
    "asked",
    [
        "isinstance(each, Request)", "isinstance(each, (Ref, Room))", "type(each) is pml.Poi",
        "type(each) in (Reaches,)", "each.kind == 'robot'", "each.kind not in (ROBOT, PERSON)",
        "run.exit_status != 5", "-9 == run.returncode",
    ],
)  # fmt: skip
def test_who_asks_is_found(asked: str) -> None:
    tree = ast.parse(IMPORTED + asked)
    assert len([*_told_apart(tree), *_compared(tree, *_KINDS, *_ENDS)]) == 1


def test_who_asks_something_else_is_not() -> None:
    asked = "isinstance(each, Ref); each.kind == other.kind; self.kind == 'robot'; Request.of(each) == other"
    tree = ast.parse(IMPORTED + asked)
    assert [*_told_apart(tree), *_compared(tree, *_KINDS, *_ENDS)] == []


def _asked(path: Path) -> List[str]:
    """What a module asks that is not for it to ask."""
    tree, within = ast.parse(path.read_text(encoding="utf-8")), path.relative_to(PACKAGE.parent)
    file = "/".join(within.parts[1:])
    found = list(_compared(tree, *_ENDS))
    if not file.startswith(tuple(TOKENS)) and not _defines(tree, *_KINDS):
        found += _compared(tree, *_KINDS)
    return found if file.startswith(HOMES) else [*found, *_told_apart(tree)]


def test_no_module_asks_for_a_kind_or_an_exit_status() -> None:
    modules = (path for name in ("pursue_gen", "pursue_runtime") for path in (PACKAGE.parent / name).rglob("*.py"))
    found = {str(path.relative_to(PACKAGE.parent)): _asked(path) for path in modules}
    assert {file: asked for file, asked in found.items() if asked} == {}
