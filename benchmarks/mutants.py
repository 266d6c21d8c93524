"""Do the tests notice small changes? Mutants of run time, proof and partition, drawn by a seed.

    python -m benchmarks.mutants [--count 300] [--seed 1] [--jobs 2] [--only pursue_gen/proof]

Each mutant is one change in one file: a comparison, a number, a truth value, an arithmetic sign, min and max, a
condition, a statement that goes. It is killed where the tests of the folder that mirrors its own fail, or take many
times the processor time that they usually take. All that happens in copies, in build/mutants. The exit status is 0
where at least GOAL of them are killed.
"""

from __future__ import annotations

import argparse
import ast
import concurrent.futures
import contextlib
import os
import queue
import random
import resource
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, Iterator, List, Optional, Sequence, Tuple

ROOT = Path(__file__).parents[1]
PARTS = {
    "pursue_runtime": "tests/runtime",
    "pursue_gen/proof": "tests/proof",
    "pursue_gen/partition": "tests/partition",
}
"""Where mutants are drawn from, and the folders of tests that mirror these."""

GOAL = 0.95
_LEFT_OUT = shutil.ignore_patterns(".*", "build", "workspace_out", "__pycache__", "node_modules")
_TIMES, _MORE = 5.0, 20.0
"""A mutant may take so many times the processor time of its tests, and so many seconds more."""

_WALL = 20.0
"""By the clock it may take so many times that: it may wait for ever without computing."""

_COMPARISONS: Dict[type, type] = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq,
    ast.In: ast.NotIn, ast.NotIn: ast.In, ast.Is: ast.IsNot, ast.IsNot: ast.Is,
}  # fmt: skip
_SIGNS: Dict[type, type] = {ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.FloorDiv, ast.FloorDiv: ast.Mult}
_NAMES = {"min": "max", "max": "min", "any": "all", "all": "any"}


@dataclass(frozen=True)
class Mutant:
    """A change of a file, whose name counts from the root: the text between two offsets (in bytes) becomes another."""

    file: str
    line: int
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
    for node in _nodes(ast.parse(text)):
        start, end = (
            lines[node.lineno - 1] + node.col_offset,  # type: ignore[attr-defined]
            lines[node.end_lineno - 1] + node.end_col_offset,  # type: ignore[attr-defined]
        )
        before = data[start:end].decode()
        for after in _changed(node):
            yield Mutant(file, node.lineno, start, end, before, after)  # type: ignore[attr-defined]


def _nodes(tree: ast.AST) -> Iterator[ast.AST]:
    """The expressions and statements in which something may be changed, in order."""
    for name, value in ast.iter_fields(tree):
        if name in ("annotation", "returns", "decorator_list", "names"):
            continue
        for node in value if isinstance(value, list) else [value]:
            if isinstance(node, (ast.JoinedStr, ast.Import, ast.ImportFrom)) or not isinstance(node, ast.AST):
                continue
            if hasattr(node, "lineno"):
                yield node
            yield from _nodes(node)


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


def folder_of(file: str, root: Path = ROOT) -> str:
    """The folder of tests that mirrors the file's own, or the nearest one above it that there is."""
    part = next(part for part in PARTS if file.startswith(f"{part}/"))
    rest = Path(file).parent.relative_to(part)
    found = root / PARTS[part] / rest
    while not found.is_dir():
        found = found.parent
    return found.relative_to(root).as_posix()


def drawn(count: int, seed: int, only: Sequence[str] = tuple(PARTS), root: Path = ROOT) -> List[Mutant]:
    """So many mutants of these folders or files; the same ones for the same seed and code."""
    files = [file for part in only for file in (root / part, *(root / part).rglob("*.py"))]
    names = sorted({file.relative_to(root).as_posix() for file in files if file.is_file()})
    every = [each for name in names for each in mutants_of(name, (root / name).read_text(encoding="utf-8"))]
    return sorted(random.Random(seed).sample(every, min(count, len(every))), key=lambda each: (each.file, each.start))


def ran(folder: Path, tests: str, cpu: Optional[float] = None) -> Tuple[str, float]:
    """How the tests end in a copy ("passed", "failed", "too long", or what pytest says), and their processor time."""
    most = resource.RLIM_INFINITY if cpu is None else int(cpu) + 1
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    environment = {**os.environ, "PYTHONPATH": str(folder), "PYTHONDONTWRITEBYTECODE": "1"}
    command = [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", "-p", "no:xdist", tests]
    process = subprocess.Popen(
        command, cwd=folder, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        start_new_session=True, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (most, most)),
    )  # fmt: skip
    try:
        status: Optional[int] = process.wait(None if cpu is None else _WALL * cpu)
    except subprocess.TimeoutExpired:
        status = None
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    taken = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    ends = {0: "passed", 1: "failed", 2: "failed", 4: "failed", None: "too long", -signal.SIGKILL: "too long"}
    ends[-signal.SIGXCPU] = "too long"
    return ends.get(status, f"pytest ended with {status}"), taken


def copied(folder: Path) -> Path:
    """A fresh copy of the project in the folder."""
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(ROOT, folder, ignore=_LEFT_OUT, symlinks=True)
    return folder


def main() -> int:
    """Prints a line for each mutant, then the survivors; 1 where less than GOAL are killed, 2 where the tests fail."""
    parser = argparse.ArgumentParser(prog="./run mutants", description="Do the tests notice small changes?")
    parser.add_argument("--count", type=int, default=300, help="how many are drawn (300)")
    parser.add_argument("--seed", type=int, default=1, help="which ones are drawn (1)")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="how many at the same time")
    parser.add_argument("--only", action="append", metavar="PATH", help="mutants of this folder or file alone")
    given = parser.parse_args()
    wrong = [path for path in given.only or () if not any(f"{path}/".startswith(f"{part}/") for part in PARTS)]
    if wrong or given.count < 1 or given.jobs < 1:
        parser.error(f"--only takes what is in {', '.join(PARTS)}" if wrong else "--count and --jobs: 1 or more")
    mutants = drawn(given.count, given.seed, given.only or tuple(PARTS))
    folders: "queue.Queue[Path]" = queue.Queue()
    for number in range(min(given.jobs, len(mutants))):
        folders.put(copied(ROOT / "build" / "mutants" / str(number)))
    first, usual = folders.get(), {}
    for tests in sorted({folder_of(each.file) for each in mutants}):
        end, usual[tests] = ran(first, tests)
        if end != "passed":
            print(f"{tests} without a mutant: {end}", file=sys.stderr)
            return 2
    folders.put(first)

    def outcome(mutant: Mutant) -> str:
        folder, tests = folders.get(), folder_of(mutant.file)
        file = folder / mutant.file
        original = file.read_bytes()
        try:
            file.write_bytes(mutant.applied(original))
            end, _ = ran(folder, tests, _TIMES * usual[tests] + _MORE)
        finally:
            file.write_bytes(original)
            folders.put(folder)
        line = f"{'survived' if end == 'passed' else 'killed' if end == 'failed' else end}  {mutant}"
        print(line, flush=True)
        return end

    start = time.monotonic()
    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        ends = list(pool.map(outcome, mutants))
    survivors = [mutant for mutant, end in zip(mutants, ends) if end == "passed"]
    killed = len(mutants) - len(survivors)
    share = killed / max(1, len(mutants))
    print(f"{killed} of {len(mutants)} killed ({share:.1%}), seed {given.seed}, {time.monotonic() - start:.0f} s")
    for mutant in survivors:
        print(f"  {mutant}")
    return 0 if share >= GOAL else 1


if __name__ == "__main__":
    sys.exit(main())
