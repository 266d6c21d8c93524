"""Makes the computed parts of the pages on the catalogue of patterns, and the table that lists them.

    python -m docs.patterns.make [NAME ...]

The pages, docs/patterns/<name>.md, are made as those on scenarios are (docs/scenarios/make.py). Each has three lines
that the table repeats: what says the pattern, its formula in the catalogue, and the one that the tests evaluate.
"""

from __future__ import annotations

import json
import re
import sys
from itertools import starmap
from pathlib import Path
from typing import Dict, List, Mapping

from benchmarks.missions import STATEMENTS
from docs.scenarios import make as scenarios
from pursue_gen.diagnostics import PursueError
from pursue_gen.files import write_texts

PAGES = scenarios.DOCS / "patterns"
INDEX = PAGES / "README.md"
STORIES = sorted((scenarios.SCENARIOS / "industry").glob("*.pur"))
ON_ROS = scenarios.DOCS / "benchmarks" / "missions.json"

GROUPS: Mapping[str, List[str]] = {
    "Coverage": ["visit", "sequenced_visit", "ordered_visit", "strict_ordered_visit", "fair_visit"],
    "Surveillance": [
        "patrolling", "sequenced_patrolling", "ordered_patrolling", "strict_ordered_patrolling", "fair_patrolling",
    ],
    "Avoidance": [
        "past_avoidance", "global_avoidance", "future_avoidance", "upper_restricted_avoidance",
        "lower_restricted_avoidance", "exact_restricted_avoidance",
    ],
    "Reaction": [
        "instantaneous_reaction", "delayed_reaction", "prompt_reaction", "bound_reaction", "bound_delay", "wait",
    ],
}  # fmt: skip
"""The patterns, in the order of the catalogue."""

SAID, CATALOGUE, HERE = "Said with", "In the catalogue", "Here"
HEAD = f"| pattern | {SAID.lower()} | {CATALOGUE.lower()} | {HERE.lower()} | verdict | on ROS |\n|" + " --- |" * 6


def pattern_files() -> Dict[str, Path]:
    """The scenarios of all patterns by name, in the order of the catalogue."""
    return {name: scenarios.PATTERNS / f"{name}.pur" for names in GROUPS.values() for name in names}


def written(name: str) -> str:
    """The page on a pattern, as it is."""
    return (PAGES / f"{name}.md").read_text(encoding="utf-8")


def line(page: str, head: str) -> str:
    """What a page has behind one of the three heads. Raises ValueError where there is no such line."""
    found = re.search(rf"^- {head}: (.*)$", page, re.MULTILINE)
    if found is None:
        raise ValueError(f"the page has no line '- {head}: …'")
    return found.group(1)


def formula(name: str) -> str:
    """The formula that missions of a pattern are held against."""
    return line(written(name), HERE).strip("`")


def row(name: str, won: bool) -> str:
    """A pattern's line in the table."""
    page = written(name)
    cells = [f"[{title(name)}]({name}.md)", *(line(page, head) for head in (SAID, CATALOGUE, HERE))]
    return "| " + " | ".join([*cells, "can be done" if won else "**cannot**", on_ros(f"patterns/{name}")]) + " |"


def on_ros(name: str) -> str:
    """How the mission of a scenario (folder/name) ended on ROS, "-" where it was not played."""
    found = json.loads(ON_ROS.read_text(encoding="utf-8"))["missions"] if ON_ROS.is_file() else {}
    return str(found.get(name, {}).get("outcome", "-"))


def story(path: Path) -> str:
    """The line of a story of industry."""
    name = f"{path.parent.name}/{path.stem}"
    return f"| [{title(path.stem)}](../scenarios/{path.stem}.md) | `{name}` | {on_ros(name)} |"


def statement(words: str, name: str) -> str:
    """The line of a statement that a scenario (folder/name) is won because of."""
    return f"| `{words}` | [{name}](../scenarios/{Path(name).name}.md) | {on_ros(name)} |"


def title(name: str) -> str:
    """A pattern's name as a heading."""
    return name.replace("_", " ").capitalize()


def index(text: str, rows: Mapping[str, str]) -> str:
    """The list with these lines in place of those that it has, by name."""
    known = {name: each for each in text.split("\n") for name in re.findall(r"^\| \[[\w ]+\]\((\w+)\.md\)", each)}
    known.update(rows)
    tables = {group: [HEAD, *(known[name] for name in names if name in known)] for group, names in GROUPS.items()}
    tables["Stories"] = ["| story | scenario | on ROS |\n| --- | --- | --- |", *map(story, STORIES)]
    said = starmap(statement, STATEMENTS.items())
    tables["Statements"] = ["| statement | scenario | on ROS |\n| --- | --- | --- |", *said]
    for group, lines in tables.items():
        table = "\n".join(lines)
        begin = f"<!-- made: {group} -->\n"
        before, _, rest = text.partition(begin)
        _, end, after = rest.partition("<!-- end -->")
        text = f"{before}{begin}\n{table}\n\n{end}{after}"
    return text


def main(names: List[str]) -> int:
    """Makes these pages, or all, and the list."""
    files, rows = pattern_files(), {}
    for name in names or list(files):
        try:
            found = scenarios.facts(files[name])
        except PursueError as problem:
            print(f"{name}: {problem}", file=sys.stderr)
            return problem.exit_status
        made, pictures = scenarios.page(written(name), found)
        write_texts({PAGES / f"{name}.md": made, **{PAGES / file: svg for file, svg in pictures.items()}})
        rows[name] = row(name, found.won is not None)
        print(f"docs/patterns/{name}.md")
    write_texts({INDEX: index(INDEX.read_text(encoding="utf-8"), rows)})
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
