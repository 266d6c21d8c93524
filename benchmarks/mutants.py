"""Do the tests notice small changes? Mutants of run time, proof and partition, drawn by a seed.

    python -m benchmarks.mutants [--count 300] [--seed 1] [--jobs 2] [--only pursue_gen/proof]

Each mutant is one change in one file: a comparison, a number, a truth value, an arithmetic sign, min and max, a
condition, a statement that goes. Texts, annotations and what is written to logs stay as they are. A mutant is killed
where the tests of the folder that mirrors its own fail, or take many times the processor time that they usually take.
Each file of these tests is run once without a mutant; then a mutant gets those alone that execute its line. All that
happens in copies, in build/mutants. The exit status is 0 where at least GOAL of them are killed.
"""

from __future__ import annotations

import argparse
import ast
import collections
import concurrent.futures
import hashlib
import os
import queue
import shutil
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Dict, Iterator, List, Sequence, Tuple, TypeVar

from benchmarks.mutant_tests import Measured, measured, outcome

ROOT = Path(__file__).parents[1]
PARTS = {
    "pursue_runtime": "tests/runtime",
    "pursue_gen/proof": "tests/proof",
    "pursue_gen/partition": "tests/partition",
}
"""Where mutants are drawn from, and the folders of tests that mirror these."""

_ON_ROS = {"tests/runtime/nodes": "tests/ros"}
"""What is tested on a ROS master, too."""

GOAL = 0.95
_SURVIVED = {"passed": "survived", "not executed": "survived (not executed)"}
_LEFT_OUT = shutil.ignore_patterns(".*", "build", "workspace_out", "__pycache__", "node_modules")
_Given = TypeVar("_Given")
_Made = TypeVar("_Made")

_COMPARISONS: Dict[type, type] = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq,
    ast.In: ast.NotIn, ast.NotIn: ast.In, ast.Is: ast.IsNot, ast.IsNot: ast.Is,
}  # fmt: skip
_SIGNS: Dict[type, type] = {ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.FloorDiv, ast.FloorDiv: ast.Mult}
_NAMES = {"min": "max", "max": "min", "any": "all", "all": "any"}


@dataclass(frozen=True)
class Mutant:
    """A change of a file, whose name counts from the root: the text between two offsets (in bytes) becomes another.
    `lines` are those of the statement that it is in; of one with a body, the lines before that."""

    file: str
    line: int
    lines: range
    start: int
    end: int
    before: str
    after: str

    def __str__(self) -> str:
        before, after = (" ".join(text.split())[:60] for text in (self.before, self.after))
        return f"{self.file}:{self.line}  {before}  ->  {after}"

    def applied(self, text: bytes) -> bytes:
        """The file's text with the change."""
        return text[: self.start] + self.after.encode() + text[self.end :]


def mutants_of(file: str, text: str) -> Iterator[Mutant]:
    """All mutants of a file, in its order. Annotations, docstrings and other texts stay as they are."""
    lines = [0]
    for line in text.encode().splitlines(keepends=True):
        lines.append(lines[-1] + len(line))
    data = text.encode()
    for node, around in _nodes(ast.parse(text), range(0)):
        start, end = (
            lines[node.lineno - 1] + node.col_offset,  # type: ignore[attr-defined]
            lines[node.end_lineno - 1] + node.end_col_offset,  # type: ignore[attr-defined]
        )
        before = data[start:end].decode()
        for after in _changed(node):
            yield Mutant(file, node.lineno, around, start, end, before, after)  # type: ignore[attr-defined]


def _nodes(tree: ast.AST, around: range) -> Iterator[Tuple[ast.AST, range]]:
    """The expressions and statements in which something may be changed, in order, with the lines of the statements."""
    for name, value in ast.iter_fields(tree):
        if name in ("annotation", "returns", "decorator_list", "names"):
            continue
        for node in value if isinstance(value, list) else [value]:
            if not isinstance(node, ast.AST) or _only_says(node):
                continue
            lines = _lines(node) if isinstance(node, (ast.stmt, ast.ExceptHandler)) else around
            if hasattr(node, "lineno"):
                yield node, lines
            yield from _nodes(node, lines)


def _only_says(node: ast.AST) -> bool:
    """Whether it is a text, an import, or writes to a log."""
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
        called = node.value.func
        name = called.attr if isinstance(called, ast.Attribute) else called.id if isinstance(called, ast.Name) else ""
        return name.lstrip("_").startswith("log")
    is_representation = isinstance(node, ast.FunctionDef) and node.name == "__repr__"
    return is_representation or isinstance(node, (ast.JoinedStr, ast.Import, ast.ImportFrom))


def _lines(node: ast.AST) -> range:
    """The lines of a statement; of one with a body, the lines before that."""
    first: int = node.lineno  # type: ignore[attr-defined]
    body = getattr(node, "body", None)
    last: int = max(first, body[0].lineno - 1) if body else node.end_lineno  # type: ignore[attr-defined]
    return range(first, last + 1)


def _changed(node: ast.AST) -> Iterator[str]:
    """What may stand in place of a node."""
    if isinstance(node, ast.Compare) and len(node.ops) == 1 and type(node.ops[0]) in _COMPARISONS:
        yield _text(ast.Compare(node.left, [_COMPARISONS[type(node.ops[0])]()], node.comparators))
    elif isinstance(node, ast.Constant) and isinstance(node.value, bool):
        yield str(not node.value)
    elif isinstance(node, ast.Constant) and isinstance(node.value, (int, float)):
        yield repr(node.value + 1)
    elif isinstance(node, ast.BoolOp):
        yield _text(ast.BoolOp(ast.Or() if isinstance(node.op, ast.And) else ast.And(), node.values))
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
        yield _text(node.operand)
    elif isinstance(node, ast.BinOp) and type(node.op) in _SIGNS:
        yield _text(ast.BinOp(node.left, _SIGNS[type(node.op)](), node.right))
    elif isinstance(node, ast.Name) and node.id in _NAMES:
        yield _NAMES[node.id]
    elif isinstance(node, ast.IfExp):
        yield _text(ast.IfExp(ast.UnaryOp(ast.Not(), node.test), node.body, node.orelse))
    elif isinstance(node, ast.Return) and node.value is not None and not _is(node.value, None):
        yield "return None"
    elif isinstance(node, ast.AugAssign) or _is_call(node) or _sets_attributes(node):
        yield "pass"


def _is(node: ast.AST, value: object) -> bool:
    return isinstance(node, ast.Constant) and node.value is value


def _is_call(node: ast.AST) -> bool:
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Call)


def _sets_attributes(node: ast.AST) -> bool:
    return isinstance(node, ast.Assign) and all(isinstance(target, ast.Attribute) for target in node.targets)


def _text(node: ast.expr) -> str:
    return f"({ast.unparse(ast.fix_missing_locations(node))})"


def folders_of(file: str, root: Path = ROOT) -> List[str]:
    """The folder of tests that mirrors the file's own, or the nearest one above it that there is; and, of nodes, the
    tests on ROS."""
    part = next(part for part in PARTS if file.startswith(f"{part}/"))
    rest = Path(file).parent.relative_to(part)
    found = root / PARTS[part] / rest
    while not found.is_dir():
        found = found.parent
    name = found.relative_to(root).as_posix()
    return [name, *([_ON_ROS[name]] if name in _ON_ROS else [])]


def files_of(folder: str, root: Path = ROOT) -> List[str]:
    """The files of tests of a folder."""
    return sorted(path.relative_to(root).as_posix() for path in (root / folder).rglob("test_*.py"))


def drawn(count: int, seed: int, only: Sequence[str] = tuple(PARTS), root: Path = ROOT) -> List[Mutant]:
    """So many mutants of these folders or files. For one seed they stay the same where other lines are changed."""
    files = [file for part in only for file in (root / part, *(root / part).rglob("*.py"))]
    found: List[Tuple[bytes, Mutant]] = []
    for name in sorted({file.relative_to(root).as_posix() for file in files if file.is_file()}):
        seen: "collections.Counter[str]" = collections.Counter()
        for each in mutants_of(name, (root / name).read_text(encoding="utf-8")):
            change = f"{seed}\n{name}\n{each.before}\n{each.after}"
            found.append((hashlib.sha256(f"{change}\n{seen[change]}".encode()).digest(), each))
            seen[change] += 1
    first = sorted(found, key=lambda each: each[0])[:count]
    return sorted((each for _, each in first), key=lambda each: (each.file, each.start))


def copied(folder: Path) -> Path:
    """A fresh copy of the project in the folder."""
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(ROOT, folder, ignore=_LEFT_OUT, symlinks=True)
    return folder


def _asked() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="./run mutants", description="Do the tests notice small changes?")
    parser.add_argument("--count", type=int, default=300, help="how many are drawn (300)")
    parser.add_argument("--seed", type=int, default=1, help="which ones are drawn (1)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="how many at the same time")
    parser.add_argument("--only", action="append", metavar="PATH", help="mutants of this folder or file alone")
    given = parser.parse_args()
    wrong = [path for path in given.only or () if not any(f"{path}/".startswith(f"{part}/") for part in PARTS)]
    if wrong or given.count < 1 or given.jobs < 1:
        parser.error(f"--only takes what is in {', '.join(PARTS)}" if wrong else "--count and --jobs: 1 or more")
    return given


class Copies:
    """Copies of the project, in which so many jobs at a time work."""

    def __init__(self, jobs: int) -> None:
        self._jobs = jobs
        self._free: "queue.Queue[Path]" = queue.Queue()
        for number in range(jobs):
            self._free.put(copied(ROOT / "build" / "mutants" / str(number)))

    def each(self, job: Callable[[Path, _Given], _Made], given: Sequence[_Given]) -> List[_Made]:
        """What the job makes of each of these, in a copy that nobody else uses meanwhile."""

        def in_a_copy(one: _Given) -> _Made:
            folder = self._free.get()
            try:
                return job(folder, one)
            finally:
                self._free.put(folder)

        with concurrent.futures.ThreadPoolExecutor(self._jobs) as pool:
            return list(pool.map(in_a_copy, given))


def tried(folder: Path, mutant: Mutant, tests: Sequence[Measured]) -> str:
    """How the tests of a mutant end in a copy; "not executed" where none of them executes its lines. Prints it."""
    own = [f"{name}/" for name in folders_of(mutant.file)]
    chosen = [each for each in tests if each.name.startswith(tuple(own)) and each.executes(mutant.file, mutant.lines)]
    file = folder / mutant.file
    original = file.read_bytes()
    try:
        file.write_bytes(mutant.applied(original))
        end = outcome(folder, chosen, mutant.file) if chosen else "not executed"
    finally:
        file.write_bytes(original)
    print(f"{_SURVIVED.get(end, 'killed' if end == 'failed' else end)}  {mutant}", flush=True)
    return end


def main() -> int:
    """Prints a line for each mutant, then the survivors; 1 where less than GOAL are killed, 2 where the tests fail."""
    given = _asked()
    start = time.monotonic()
    mutants = drawn(given.count, given.seed, given.only or tuple(PARTS))
    copies = Copies(given.jobs)
    names = sorted({name for each in mutants for folder in folders_of(each.file) for name in files_of(folder)})
    tests = copies.each(measured, names)
    wrong = [f"{each.name} without a mutant: {each.end}" for each in tests if each.end != "passed"]
    if wrong:
        print("\n".join(wrong), file=sys.stderr)
        return 2
    print(f"{len(tests)} files of tests, {time.monotonic() - start:.0f} s", flush=True)
    ends = copies.each(lambda folder, mutant: tried(folder, mutant, tests), mutants)
    survivors = [mutant for mutant, end in zip(mutants, ends) if end in _SURVIVED]
    killed = len(mutants) - len(survivors)
    share = killed / max(1, len(mutants))
    print(f"{killed} of {len(mutants)} killed ({share:.1%}), seed {given.seed}, {time.monotonic() - start:.0f} s")
    for mutant in survivors:
        print(f"  {mutant}")
    return 0 if share >= GOAL else 1


if __name__ == "__main__":
    sys.exit(main())
