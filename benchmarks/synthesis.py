"""Measures what synthesis costs: `python -m benchmarks.synthesis --help` lists the choices.

Each game is decided and proven in a process of its own, with limits on time and memory, so that a slow one does not
stop the table; so is each whole command, and each exploration by TChecker where its program is given. The published
scenarios (and TIGA's figures) are read where they are at hand: beside the project in shared/reference, or where
PURSUE_REFERENCE says. docs/benchmarks.md says what the columns mean.
"""

from __future__ import annotations

import argparse
import datetime
import json
import os
import platform
import subprocess
import sys
from pathlib import Path
from typing import Any, Dict, Iterable, Iterator, List, Optional, Sequence, Set, Tuple

from benchmarks import command, random_page, tables
from benchmarks.families import FAMILIES
from benchmarks.measure import GAMES, Bounds, Case, Row, game_of, measured
from benchmarks.page import filled
from benchmarks.tchecker import TCheckerError, explored
from benchmarks.tiga import NOTHING, Figures, figures
from pursue_gen.diagnostics import PursueError

ROOT = Path(__file__).resolve().parent.parent

STORIES = ROOT / "benchmarks" / "stories"
"""Ordinary tasks: five places, four agents, two rules, and a deadline or something to avoid."""

QUICK = ("CT1", "EB1", "WC1", "WC2a", "scenario 1", "scenario 4")


def reference_folder() -> Path:
    """Where the published scenarios are, if they are there."""
    return Path(os.environ.get("PURSUE_REFERENCE", ROOT.parent / "shared" / "reference")) / "pursue-scenarios"


def scenario_cases() -> Iterator[Case]:
    """The thesis's five, the stories of this folder, and the published ones where they are at hand."""
    for file in sorted((ROOT / "scenarios" / "thesis").glob("*.pur")):
        for game in GAMES:
            yield Case("thesis", file.stem.replace("_", " "), game, file=str(file))
    for file in sorted(STORIES.glob("*.pur")):
        for game in GAMES:
            yield Case("story", f"{file.stem} story", game, file=str(file))
    for file in sorted(reference_folder().glob("*/TGA.xml")):
        for game in GAMES:
            yield Case("reference", file.parent.name, game, file=str(file))


def family_cases(quick: bool) -> Iterator[Case]:
    """All members of all families, a family at a time, small ones first."""
    for family in FAMILIES:
        for game in GAMES:
            for size in family.quick if quick else family.sizes:
                yield Case("family", family.name, game, size=size, text=family.text(size))


def tiga_figures(case: Case) -> Figures:
    """What TIGA logged about the same network."""
    if case.group != "reference" or case.file is None:
        return NOTHING
    for name in ("UPPAAL_plan.txt", "UPPAAL_plan_failed.txt"):
        output = Path(case.file).parent / name
        if output.is_file():
            return figures(output.read_text(errors="replace"))
    return NOTHING


def measurements(cases: Iterable[Case], bounds: Bounds, binary: Optional[Path] = None) -> Iterator[Row]:
    """A row per case, with the figures of TChecker's program `binary` if there is one.

    In a family, what comes after one that was not decided (not explored) is not tried.
    """
    given_up: Set[Tuple[str, str]] = set()
    for case in cases:
        series = (case.name, case.game)
        if case.group == "family" and series in given_up:
            row: Row = {"group": "family", "name": case.name, "size": case.size, "game": case.game}
            row["outcome"] = "skipped"
        else:
            row = measured(case, bounds)
            if case.group == "family" and not row.get("verdict"):
                given_up.add(series)
        if case.group == "reference":
            row.update({f"tiga_{what}": value for what, value in tiga_figures(case).as_json().items()})
        # Who decides what, and how late commands come, makes no difference to an exploration.
        if binary is not None and case.game == "ideal" and (case.name, "TChecker") not in given_up:
            row.update(tchecker_figures(case, binary, bounds))
            if case.group == "family" and row.get("tchecker_outcome"):
                given_up.add((case.name, "TChecker"))
        yield row


def tchecker_figures(case: Case, binary: Path, bounds: Bounds) -> Row:
    """What TChecker takes to explore the same network, or why that is not known."""
    from benchmarks.tchecker_file import written

    try:
        network, objective = game_of(case)
        found = explored(binary, written(network, objective), bounds.seconds, bounds.memory)
    except (TCheckerError, ValueError, PursueError) as problem:
        return {"tchecker_outcome": str(problem).splitlines()[0]}
    return {"tchecker_states": found.states, "tchecker_seconds": found.seconds}


def version() -> str:
    """Return the commit that is played; "" outside a repository, and where there is no git."""
    command_line = ["git", "-C", str(ROOT), "describe", "--always", "--dirty"]
    try:
        found = subprocess.run(command_line, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=False)
    except FileNotFoundError:
        return ""
    return found.stdout.strip()


def machine() -> str:
    """What the times depend on."""
    cpu, system, kind = platform.machine(), platform.system(), "machine"
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        cpu = next(line.split(":")[1].strip() for line in lines if line.startswith("model name"))
        kind = "virtual machine" if any(" hypervisor" in line for line in lines) else kind
        release = dict(line.split("=", 1) for line in Path("/etc/os-release").read_text().splitlines() if "=" in line)
        system = f"{release['NAME']} {release['VERSION_ID']}".replace('"', "").replace(" GNU/Linux", "")
    except (OSError, StopIteration, KeyError, IndexError):
        pass
    python = ".".join(platform.python_version_tuple()[:2])
    return f"a {kind} with {os.cpu_count()} cores ({cpu}), {system}, Python {python}"


def merged(old: Sequence[Row], new: Sequence[Row]) -> List[Row]:
    """The new rows and, of the old ones, those that were not measured again; in the order of a complete run."""

    def key(row: Row) -> Tuple[str, str, int, str]:
        return Case(row["group"], row["name"], row["game"], size=row.get("size")).key

    rows = {**{key(row): row for row in old}, **{key(row): row for row in new}}
    cases = [case.key for case in [*scenario_cases(), *family_cases(quick=False)]]
    cases += [("command", goal.title, -1 if goal.size is None else goal.size, goal.game) for goal in command.GOALS]
    cases += [("random", kind, -1, game) for kind in random_page.KINDS for game in GAMES]
    order = {case: place for place, case in enumerate(cases)}
    return [row for _, row in sorted(rows.items(), key=lambda item: (order.get(item[0], len(order)), item[0]))]


def write(folder: Path, results: Dict[str, Any], plots: bool) -> None:
    """Everything that is made of the results: folder/benchmarks.md and in folder/benchmarks/ data and pictures."""
    from pursue_gen.files import write_texts

    rows = results["rows"]
    page = folder / "benchmarks.md"
    texts = {folder / "benchmarks" / "results.json": json.dumps(results, indent=1) + "\n"}
    texts[folder / "benchmarks" / "results.csv"] = tables.as_csv(rows)
    texts[page] = filled(page.read_text() if page.is_file() else None, results)
    if plots:
        from benchmarks.plots import pictures

        texts.update({folder / "benchmarks" / name: svg for name, svg in pictures(rows).items()})
    write_texts(texts)


def options() -> argparse.ArgumentParser:
    """The command line."""
    parser = argparse.ArgumentParser(description="Measures what synthesis costs, each game in a process of its own.")
    parser.add_argument("files", nargs="*", metavar="FILE", help="a SCENARIO.pur, or a TGA.xml beside its TCTL.q")
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--all", action="store_true", help="everything (otherwise the scenarios alone)")
    what.add_argument("--families", action="store_true", help="the families alone")
    what.add_argument("--commands", action="store_true", help="the whole command solve alone")
    what.add_argument("--random", action="store_true", help="random small games alone")
    what.add_argument("--quick", action="store_true", help="a few scenarios, commands, games, and small families")
    what.add_argument("--render", action="store_true", help="measure nothing, write again what --out holds")
    parser.add_argument("--only", nargs="+", metavar="NAME", help="of these, those named so (as in the tables)")
    parser.add_argument("--games", nargs="+", choices=list(GAMES), default=list(GAMES))
    parser.add_argument("--seconds", type=float, default=20.0, help="of the processor to decide, and to prove (20)")
    parser.add_argument("--memory", type=int, default=4096, metavar="MIB", help="of each process (4096)")
    parser.add_argument("--tchecker", type=Path, metavar="PATH", help="TChecker's tck-reach, to explore the same games")
    parser.add_argument("--out", type=Path, metavar="FOLDER", help="write benchmarks.md, benchmarks/*.json, .csv, .svg")
    parser.add_argument("--no-plots", action="store_true", help="without pictures (matplotlib is not needed then)")
    parser.add_argument("--machine", default=machine(), help="how the results name the machine")
    parser.add_argument("--date", default=datetime.date.today().isoformat(), help="how they give the date (today)")
    return parser


def chosen(given: argparse.Namespace) -> List[Case]:
    """The games that the command line asks for."""
    if given.files:
        cases = [Case("file", file, game, file=str(Path(file).resolve())) for file in given.files for game in GAMES]
    elif given.quick:
        cases = [case for case in scenario_cases() if case.name in QUICK] + list(family_cases(quick=True))
    elif given.commands or given.random:
        cases = []
    else:
        cases = [] if given.families else list(scenario_cases())
        cases += family_cases(quick=False) if given.all or given.families or given.only else []
    names = given.only or [case.name for case in cases]
    return [case for case in cases if case.name in names and case.game in given.games]


def chosen_commands(given: argparse.Namespace) -> List[command.Goal]:
    """The commands that it asks for."""
    if given.files or not (given.all or given.commands or given.quick):
        return []
    goals = [goal for goal in command.GOALS if goal.game in given.games]
    goals = [goal for goal in goals if goal.name in command.QUICK] if given.quick else goals
    return [goal for goal in goals if not given.only or goal.title in given.only]


def chosen_random(given: argparse.Namespace) -> int:
    """How many random games of each kind it asks for."""
    if given.only or given.files:
        return 0
    if given.quick:
        return random_page.GAMES_QUICK
    return random_page.GAMES_EACH if given.all or given.random else 0


def rows_of(given: argparse.Namespace) -> Iterator[Row]:
    """All rows, one at a time."""
    bounds = Bounds(given.seconds, given.memory)
    yield from measurements(chosen(given), bounds, given.tchecker)
    yield from command.commands_measured(chosen_commands(given), reference_folder(), bounds)
    count = chosen_random(given)
    if count:
        yield from random_page.random_measured(count, bounds)


def line(row: Row) -> str:
    """The row for the terminal."""
    show = {"command": command.terminal, "random": random_page.terminal}.get(row["group"], tables.terminal)
    return show(row)


def main(arguments: Optional[Sequence[str]] = None) -> int:
    """Prints the table a row at a time, and writes the results where that is asked for."""
    parser = options()
    given = parser.parse_args(arguments)
    check(parser, given)
    load = os.getloadavg()[0]
    new: List[Row] = []
    try:
        if not given.render:
            print(tables.HEADLINE)
            for row in rows_of(given):
                new.append(row)
                print(line(row), flush=True)
    except KeyboardInterrupt:
        print("interrupted; nothing was written", file=sys.stderr)
        return 130
    if given.out:
        file = given.out / "benchmarks" / "results.json"
        old: Dict[str, Any] = json.loads(file.read_text()) if file.is_file() else {}
        results = {"machine": given.machine, "date": given.date, "seconds": given.seconds, "memory": given.memory}
        results["load"] = round(load, 1)
        others = {key: old[key] for key in old if key not in (*results, "rows")}  # other programs measure them
        if old and not is_complete(given):
            results = {key: old[key] for key in results}  # of most rows; new ones have a date of their own
            new = [{**row, "date": given.date} for row in new]
        else:
            old = {}
        rows = merged(old.get("rows", []), new)
        write(given.out, {**results, "rows": rows, **others}, not given.no_plots)
    return 0


def is_complete(given: argparse.Namespace) -> bool:
    """True if all is measured, so that no older row stays."""
    return bool(given.all) and not given.only and set(given.games) == set(GAMES)


def check(parser: argparse.ArgumentParser, given: argparse.Namespace) -> None:
    """Ends with a message where the command line asks for what there is not."""
    if given.render and not given.out:
        parser.error("--render needs --out")
    if given.render and not (given.out / "benchmarks" / "results.json").is_file():
        parser.error(f"--render needs {given.out / 'benchmarks' / 'results.json'}, and there is none: measure first")
    names = {case.name for case in chosen(given)} | {goal.title for goal in chosen_commands(given)}
    unknown = set(given.only or ()) - names
    if unknown and not given.render:
        parser.error(f"nothing here is called {', '.join(sorted(unknown))}")
    if given.tchecker is not None and not os.access(str(given.tchecker), os.X_OK):
        parser.error(f"{given.tchecker} is no program that can be run; --tchecker is the path of TChecker's tck-reach")
    if given.tchecker is not None and given.tchecker.is_dir():
        parser.error(f"{given.tchecker} is a folder; --tchecker is the path of TChecker's tck-reach")


if __name__ == "__main__":
    sys.exit(main())
