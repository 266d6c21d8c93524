"""Makes the tables of docs/constants.md: the tuned constants of solver, checker and tools, from their docstrings.

    python -m docs.constants.make

A docstring says what a constant is for; its last sentence begins with "Measured on" or "Not measured".
"""

from __future__ import annotations

import ast
import re
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, Iterator, List, Tuple

from pursue_gen.files import write_texts

ROOT = Path(__file__).resolve().parents[2]
PACKAGE, PAGE = ROOT / "pursue_gen", ROOT / "docs" / "constants.md"

FOLDERS = (
    "zones", "synthesis", "proof", "solving", "explanation", "partition", "tools/authoring", "tools/calibration",
    "tools/play", "tools/replanning", "tools/simulation",
)  # fmt: skip
"""Where numbers decide how far a search goes; in all other tools they are sizes, limits of files, and rounding."""

FIXED = {
    "zones/dbm.py": ["INF", "MOST", "LE_ZERO"],
    "zones/native/dbm.hpp": ["LE_ZERO"],
    "synthesis/game.py": ["NO_CHANNEL"],
    "synthesis/native/engine.py": ["_CLOCKS"],
    "synthesis/native/reach.hpp": ["unlimited"],
    "synthesis/native/relaxed.hpp": ["FIRST"],
    "synthesis/relaxed.py": ["UNRELIABLE"],
    "proof/closed_loop.py": ["_UNBOUNDED"],
    "proof/course.py": ["START"],
    "proof/simplify.py": ["_UNKNOWN"],
    "proof/native/tables.py": ["_MOST", "_MOST_FACTOR"],
    "solving/group_games.py": ["NEEDED"],
    "solving/floors.py": ["_UNITS"],
    "solving/rounds.py": ["_ROUNDING"],
    "solving/routes.py": ["_GAP", "_NEVER"],
    "solving/verifytga.py": ["_LAST_LINES"],
    "solving/walkers.py": ["_UNITS"],
    "explanation/play.py": ["_FINE"],
    "explanation/play_lines.py": ["_MOST_OTHERS"],
    "explanation/repairs.py": ["_FINEST"],
    "partition/yaml_text.py": ["_WIDTH"],
    "tools/authoring/dialog.py": ["_PATIENCE", "LONGEST_LINE"],
    "tools/authoring/requirements.py": ["MOST_PLACES", "MOST_DISTANCE", "BETWEEN"],
    "tools/calibration/advice.py": ["TOLERANCE", "_EXACT"],
    "tools/calibration/picture.py": ["_WIDTH", "_TOP", "_BOLD", "_TICK", "_MOST_LABEL", "_DRAWN", "_LEVELS"],
    "tools/calibration/proposal.py": ["TOLERANCE", "_SHORTEST"],
    "tools/calibration/proposal_report.py": ["_MANY"],
    "tools/calibration/recordings.py": ["_SOME"],
    "tools/calibration/windows.py": ["_NEAR"],
    "tools/play/saving.py": ["_START"],
    "tools/play/state.py": ["GRAIN"],
    "tools/replanning/request.py": ["_LONGEST"],
    "tools/simulation/connections.py": ["DECIMALS"],
    "tools/simulation/mission.py": ["START", "HEARTBEAT"],
    "tools/simulation/nodes.py": ["TICK"],
    "tools/simulation/opponents.py": ["FIRST"],
    "tools/simulation/recorder.py": ["EPSILON"],
    "tools/simulation/remaining.py": ["FOREVER"],
    "tools/simulation/runs.py": ["_LONGEST"],
    "tools/simulation/world.py": ["INSIDE"],
}
"""Not tuned: marks (none, never), limits of formats and of types, rounding, how much is shown; by the first name."""

ELSEWHERE = {
    ("zones/native/effort.hpp", "often"): (
        "Bounds of zones from one call of the hook on limits to the next: some tens of microseconds. Measured on a "
        "corridor with 20 robots."
    ),
    ("zones/native/federation.hpp", "many"): "With more zones than these, a union is reduced at once. Not measured.",
    ("zones/native/memory.hpp", "much"): "MiB that are freed at least before the system gets them back. Not measured.",
    ("synthesis/native/steps.hpp", "STEPS_AHEAD"): "So many commands of a robot are looked at. Not measured.",
    ("synthesis/native/duties.hpp", "ZONES_OF_A_LOOK"): (
        "A look ahead of a robot with a battery takes about as long as so many zones. Measured on a care home with a "
        "battery."
    ),
    ("synthesis/native/moves.hpp", "MOST_KEPT"): "Answers that are kept, some hundred bytes each. Not measured.",
    ("synthesis/native/duties.hpp", "MOST_KEPT"): "Costs of facts that are kept, some 20 bytes each. Not measured.",
    ("synthesis/native/fixpoint.hpp", "most"): "So many zones of a state on plays become their hull. Measured on CT4.",
    ("synthesis/native/limits.hpp", "INTERVAL"): "Zones from one look at the limits to the next. Not measured.",
    ("synthesis/native/reach.hpp", "per_state"): "The work that exploring a state counts as. Not measured.",
    ("synthesis/native/reach.hpp", "cheap"): (
        "The zones of an evaluation with which the exact search goes on alone. Measured on a chase through a ring of "
        "150 places."
    ),
    ("synthesis/native/reach.hpp", "largest"): (
        "The most zones of a state in the search that keeps few. Measured on a story of five places and four agents."
    ),
    ("synthesis/native/safety.hpp", "per_state"): "The work that exploring a state counts as. Not measured.",
    ("synthesis/native/safety.hpp", "largest"): "The most zones of what is lost in a state, likewise. Not measured.",
    ("synthesis/native/guesses.hpp", "ZONES_OF_CALLS"): (
        "So many zones of a state where calls break charges off. Measured on a robot that answers calls and charges."
    ),
    ("synthesis/native/excursions.hpp", "MOST_CHOICES"): (
        "Choices of homes that are looked at, and states on the ways to them. Not measured."
    ),
    ("synthesis/native/guesses.hpp", "FEW_FOLLOWED"): (
        "Zones that a policy may follow at first, where robots may leave their homes in turns. Measured on three "
        "robots on a ring of lanes."
    ),
    ("synthesis/native/tasks.hpp", "BOUNDS_OF_A_STATE"): (
        "A look at a state takes about as long as at so many bounds. Measured on lab scenarios 2 and 41."
    ),
    ("proof/native/search.hpp", "often"): (
        "A discrete state so often on one play of a reach game is searched for a loop that clocks hide. Not measured."
    ),
    ("explanation/decided.py", "_ALONE"): (
        "The part of the budget for single objectives, and of what is left then for a set of them. Not measured."
    ),
    ("explanation/decided.py", "_ONE_ROBOT"): (
        "The part of what a game gets for each robot, the others standing still. Not measured."
    ),
}
"""What is said of constants of C++ and others whose files do not say it."""

_BASIS = re.compile(r"\s*\b(Measured on [^.]*(?:\.\d[^.]*)*|Not measured[^.]*)\.\s*$")
_NATIVE = re.compile(r"^[^/\n]*\bconstexpr [\w:]+ (\w+) = ([\w .<<]+);", re.MULTILINE)
_NUMBERS = (
    ast.BinOp, ast.UnaryOp, ast.operator, ast.unaryop, ast.Constant, ast.Tuple, ast.Name, ast.Load, ast.Call,
)  # fmt: skip
_CALLED = {"Fraction", "range"}
_PART = re.compile(r"(<!-- made: (\S+) -->\n)(.*?)(<!-- end -->)", re.DOTALL)


@dataclass(frozen=True)
class Constant:
    """A tuned constant: `file` in the package, `names` and `value` as they are written, `text`: its docstring."""

    file: str
    names: str
    value: str
    text: str

    @property
    def first(self) -> str:
        """The first of its names."""
        return self.names.split(",")[0]

    @property
    def basis(self) -> str:
        """What it was measured on, or that it was not; "" where its docstring does not say so."""
        found = _BASIS.search(self.text)
        return found.group(1) if found else ""

    def row(self) -> str:
        """Its line in the table."""
        basis = self.basis.replace("Not measured", "chosen, not measured").replace("Measured on ", "")
        cells = (f"`{self.names}`", f"`{self.value}`", _BASIS.sub("", self.text), basis)
        return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def numbers(folder: str) -> Iterator[Constant]:
    """All constants of a folder of the package that are numbers, in the order of files and lines."""
    for path in sorted([*(PACKAGE / folder).rglob("*.py"), *(PACKAGE / folder).rglob("*.hpp")]):
        file = path.relative_to(PACKAGE).as_posix()
        text = path.read_text(encoding="utf-8")
        for names, value, said in _in_native(text) if path.suffix == ".hpp" else _in_python(text):
            yield Constant(file, names, value, ELSEWHERE.get((file, names.split(",")[0]), said))


def constants(folder: str) -> List[Constant]:
    """The tuned ones of them."""
    return [each for each in numbers(folder) if each.first not in FIXED.get(each.file, ())]


def _in_python(text: str) -> Iterator[Tuple[str, str, str]]:
    """Names, value and docstring of each number, and of each tuple of numbers, that a module names in capitals."""
    body, lines = ast.parse(text).body, text.encode().split(b"\n")

    def source(node: ast.expr) -> str:
        return lines[node.lineno - 1][node.col_offset : node.end_col_offset].decode()

    for statement, after in zip(body, [*body[1:], ast.Pass()]):
        if isinstance(statement, ast.Assign) and _is_number(statement.value):
            names = source(statement.targets[0])
            said = after.value if isinstance(after, ast.Expr) else None
            docstring = said.value if isinstance(said, ast.Constant) and isinstance(said.value, str) else ""
            if names.isupper():
                yield names, source(statement.value), " ".join(docstring.split())


def _is_number(value: ast.expr) -> bool:
    """True for numbers, tuples of them, and what is computed of them."""
    nodes = list(ast.walk(value))
    numbers = [node.value for node in nodes if isinstance(node, ast.Constant)]
    called = {node.func.id for node in nodes if isinstance(node, ast.Call) and isinstance(node.func, ast.Name)}
    return (
        all(isinstance(node, _NUMBERS) for node in nodes)
        and bool(numbers)
        and all(type(number) in (int, float) for number in numbers)
        and called <= _CALLED
    )


def _in_native(text: str) -> Iterator[Tuple[str, str, str]]:
    """Names and values of constants of C++ that are numbers."""
    for names, value in _NATIVE.findall(text):
        if value[0].isdigit():
            yield names, value, ""


def page(text: str) -> str:
    """The page with these tables in place of those that it has."""

    def table(match: "re.Match[str]") -> str:
        by_file: Dict[str, List[str]] = {}
        for each in constants(match[2]):
            by_file.setdefault(each.file, []).append(each.row())
        head = "| constant | value | what it is | measured on |\n| --- | --- | --- | --- |\n"
        tables = (f"`{file}`\n\n{head}" + "\n".join(rows) for file, rows in by_file.items())
        return f"{match[1]}\n" + "\n\n".join(tables) + f"\n\n{match[4]}"

    return _PART.sub(table, text)


def main() -> int:
    """Makes the page."""
    write_texts({PAGE: page(PAGE.read_text(encoding="utf-8"))})
    return 0


if __name__ == "__main__":
    sys.exit(main())
