"""Do all who can tell who wins say the same? `python -m benchmarks.agreement --games 10000 --scenarios 3000 --out docs`

So many random games, and games of random scenarios, a kind and a game after the other; what differs is printed at once.
`--labs` adds small lab scenarios, `--varied` smaller ones with statements of all kinds. `--out docs` writes the counts
into docs/benchmarks.md. The same numbers give the same games and the same outcome on every machine: all limits are on
work. What is compared is in opinions.py, what is drawn in random_games.py, random_stories.py, lab_scenarios.py and
random_wishes.py.
"""

from __future__ import annotations

import argparse
import datetime
import json
import multiprocessing
import random
import sys
from fractions import Fraction
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List, NamedTuple, Optional, Sequence

from benchmarks.lab_scenarios import Size, lab_scenario
from benchmarks.measure import Row
from benchmarks.opinions import Opinions, on_game, on_scenario, on_varied
from benchmarks.random_games import random_game
from benchmarks.random_stories import random_story
from benchmarks.random_wishes import random_wishes
from pursue_gen.diagnostics import PursueError
from pursue_gen.language.checks import checked
from pursue_gen.solving.rules import DEFAULT, IDEAL, Rules
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Kind

LEAST = 3
"""Games with fewer discrete states are not counted."""

GAMES = {"ideal": IDEAL, "default": DEFAULT, "late": Rules(reaction=Fraction(1))}
"""Random games are played as these; in the last one commands take effect up to one time unit late."""

SCENARIO, LAB, VARIED = "scenario", "lab scenario", "varied scenario"
"""How groups of random scenarios are called; others are called as their kind of objective."""

SMALL_LAB = Size(places=3, robots=2, people=1, promises=2)
"""Of lab scenarios of this size about half are decided in one piece within the limits."""


TINY = (
    Size(places=3, robots=2, people=1, promises=1),
    Size(places=3, robots=2, people=1, promises=2),
    Size(places=3, robots=1, people=1, promises=2),
    Size(places=3, robots=1, people=2, promises=1),
    Size(places=4, robots=1, people=1, promises=1),
    Size(places=4, robots=1, people=1, promises=2),
)
"""The sizes of varied scenarios, in turn. Of those without errors about six in ten are decided in one piece."""


class Job(NamedTuple):
    """A game: its group's name (a kind of objective, or a key of DRAWN), a key of GAMES, its number."""

    name: str
    game: str
    number: int


def opinions_of(job: Job) -> Optional[Opinions]:
    """Everybody's verdict; None for a game of the wrong size, or a scenario with errors."""
    rules = GAMES[job.game]
    if job.name not in DRAWN:
        network, objective = random_game(job.number, Kind(job.name))
        return on_game(network, objective, rules, LEAST)
    try:
        scenario = checked(DRAWN[job.name](job.number), "story.pur", "story")
        network, objective = translate(scenario), scenario_objective(scenario)
    except PursueError:
        return None
    return (on_varied if job.name == VARIED else on_scenario)(network, objective, rules)


def story(number: int) -> str:
    """The text of the random scenario of this number."""
    return random_story(random.Random(f"story {number}"))


def lab(number: int) -> str:
    """The text of the small lab scenario of this number."""
    return lab_scenario(number, SMALL_LAB)


def varied(number: int) -> str:
    """The text of the varied scenario of this number."""
    return random_wishes(number, TINY[number % len(TINY)])


DRAWN: Dict[str, Callable[[int], str]] = {SCENARIO: story, LAB: lab, VARIED: varied}
"""The text of a random scenario by its number, by how its group is called."""


def compared(name: str, game: str, count: int, processes: int) -> Row:
    """The counts of the first so many games of a group; what differs is printed."""
    row: Row = {"name": name, "game": game, "games": 0, "most_states": 0, "won": 0, "lost": 0, "undecided": 0}
    row.update({"undecided_by": {}, "decided_by": {}, "proven": 0, "half_proven": 0, "unproven": 0, "stages": 0})
    row["differ"] = []
    jobs = (Job(name, game, number) for number in range(100 * count))
    with multiprocessing.Pool(processes) as pool:
        for number, found in enumerate(pool.imap(opinions_of, jobs) if count else ()):
            if found is None:
                continue
            add(row, number, found)
            if row["games"] >= count:
                pool.terminate()
                break
    return row


def add(row: Row, number: int, found: Opinions) -> None:
    """Counts a game in the row of its group."""
    row["games"] += 1
    row["most_states"] = max(row["most_states"], found.states)
    row["won" if found.won else "undecided" if found.won is None else "lost"] += 1
    for who, verdict in found.verdicts.items():
        counts = row["undecided_by" if verdict is None else "decided_by"]
        counts[who] = counts.get(who, 0) + 1
    for what in ("proven", "half_proven", "unproven"):
        row[what] += getattr(found, what)
    row["stages"] += found.stages
    if not found.agreed:
        row["differ"].append(number)
        print(f"{row['name']}, {row['game']}, number {number}: {found.verdicts} {found.faults}", flush=True)


def groups(games: int, scenarios: int, labs: int = 0, varied: int = 0) -> Iterator[Any]:
    """(name, game, count) of each group."""
    for kind in Kind:
        for game in GAMES:
            yield kind.value, game, -(-games // (len(Kind) * len(GAMES)))
    for name, count in ((SCENARIO, scenarios), (LAB, labs), (VARIED, varied)):
        for game in ("ideal", "default"):
            yield name, game, -(-count // 2)


def main(arguments: Optional[Sequence[str]] = None) -> int:
    """Prints a row of JSON for each group; status 1 where something differs."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--games", type=int, default=900, help="random games (900)")
    parser.add_argument("--scenarios", type=int, default=100, help="games of random scenarios (100)")
    parser.add_argument("--labs", type=int, default=0, help="games of small random lab scenarios (0)")
    parser.add_argument("--varied", type=int, default=0, help="games of small scenarios with all statements (0)")
    parser.add_argument("--processes", type=int, default=1, help="that work at the same time (1)")
    parser.add_argument("--out", type=Path, metavar="FOLDER", help="write the counts to benchmarks.md there")
    given = parser.parse_args(arguments)
    rows: List[Row] = []
    for name, game, count in groups(given.games, given.scenarios, given.labs, given.varied):
        if count:
            rows.append(compared(name, game, count, given.processes))
            print(json.dumps(rows[-1]), flush=True)
    if given.out:
        keep(given.out, rows)
    return int(any(row["differ"] for row in rows))


def keep(folder: Path, rows: List[Row]) -> None:
    """Writes the rows into the results of the benchmarks, in place of those of the same groups, each with the version
    that it is of; and the page again."""
    from benchmarks.synthesis import version, write

    file = folder / "benchmarks" / "results.json"
    results: Dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    known = {(row["name"], row["game"]): row for row in results.get("agreement", {}).get("rows", [])}
    now = {"date": f"{datetime.date.today()}", "version": version()}
    known.update({(row["name"], row["game"]): {**row, **now} for row in rows})
    results["agreement"] = {"rows": list(known.values())}
    write(folder, results, plots=False)


if __name__ == "__main__":
    sys.exit(main())
