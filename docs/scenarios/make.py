"""Makes the computed parts of the pages on scenarios: verdicts, times, pictures, and the effects of changes.

    python -m docs.scenarios.make [NAME ...]

The pages, docs/scenarios/<name>.md, are written by hand; the parts between two marks are made here:

    <!-- made: scenario -->     the scenario's text
    <!-- made: verdict -->      can it be won, how fast, how many states and commands
    <!-- made: map -->          the picture of the map
    <!-- made: mission 3 -->    a picture of the simulated mission number 3
    <!-- end -->

and so does the last column of tables whose middle column holds statements in code spans: each takes the place of the
scenario's statement on the same thing, or is added where there is none; behind "without" it is taken away.
"""

from __future__ import annotations

import functools
import math
import re
import sys
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Dict, List, Mapping, Optional, Tuple

from pursue_gen.diagnostics import PursueError, listed
from pursue_gen.drawing import map_svg
from pursue_gen.drawing.layout import poses
from pursue_gen.files import write_texts
from pursue_gen.language import load, parse
from pursue_gen.language.scenario import Scenario, StatedObjective
from pursue_gen.language.sentences import periods_found, promise_words
from pursue_gen.language.times import unit_name
from pursue_gen.outcomes import LimitHit, Lost
from pursue_gen.solving.inputs import game_of
from pursue_gen.solving.least_time import Guarantee
from pursue_gen.solving.optional import promised
from pursue_gen.solving.options import DEFAULT, SolveOptions
from pursue_gen.solving.periods import least_period
from pursue_gen.solving.rules import Rules, played
from pursue_gen.solving.shares import can_be_shared
from pursue_gen.solving.solution import Solution, solution
from pursue_gen.solving.solvers import solved
from pursue_gen.synthesis.limits import NO_LIMITS, Limits
from pursue_gen.synthesis.solve import Verdict, solve
from pursue_gen.tga.network import Kind
from pursue_gen.tools.report import timeline
from pursue_gen.tools.report.recording import ending_text, simulated
from pursue_gen.tools.simulation.outcome import Settings
from pursue_gen.tools.simulation.runs import Case, case_of
from pursue_gen.tools.simulation.stage import Stage, stage_of
from pursue_gen.workspace import Options

ROOT = Path(__file__).resolve().parents[2]

SCENARIOS, DOCS = ROOT / "scenarios", ROOT / "docs"
PAGES, INDEX = DOCS / "scenarios", DOCS / "scenarios.md"
PATTERNS = SCENARIOS / "patterns"
"""These have pages of another kind, which docs/patterns/make.py makes."""

UNTIL = 120.0
"""So long, in time units, a mission is simulated that has no goal."""

_PART = re.compile(r"(<!-- made: (\w+)(?: (\d+))? -->\n)(.*?)(<!-- end -->)", re.DOTALL)
_WHAT_IF = re.compile(r"^(\| [^|\n]+ \| ([^|\n]*`[^|\n]*) \|)([^|\n]*)\|$", re.MULTILINE)
_STATEMENT = re.compile(r"(without )?`([^`]+)`")
_SAME = {"connect": 4, "travel": 6, "assume:": 3, "objective:": 3, "reach_objective:": 3}
"""So many words of a statement tell what it is on; of all others two."""


@dataclass(frozen=True)
class Facts:
    """What was found out about a scenario in the default game; `won` is None where it is lost.

    `settled` is the scenario with the periods that had to be found, and with what can be promised of it.
    """

    name: str
    scenario: Scenario
    settled: Scenario
    states: int
    won: Optional[Solution]
    guarantee: Optional[Guarantee]

    @functools.cached_property
    def case(self) -> Case:
        """What is simulated: the workspace as `pursue-gen ws` writes it, against all kinds of opponents."""
        assert self.won is not None, f"{self.name} is lost"
        goal = self.won.objective.kind is not Kind.SAFETY
        return case_of(self.settled, self.won, Options(), Settings(until=1000.0 if goal else UNTIL))[0]

    @functools.cached_property
    def stage(self) -> Stage:
        """What all its missions have in common."""
        return stage_of(self.case.scenario, self.case.won, self.case.options)


def scenario_files() -> Dict[str, Path]:
    """All scenarios of the project but patterns, by the names of their pages, in the order of their folders."""
    return {path.stem: path for path in sorted(SCENARIOS.rglob("*.pur")) if path.parent != PATTERNS}


def facts(path: Path) -> Facts:
    """Solves a scenario and proves the strategy."""
    scenario = load(path)
    settled = least_period(scenario, Rules())
    whole = _in_one_piece(settled, _WORK)
    if whole is not None and not whole.won:
        return Facts(path.stem, scenario, settled, whole.stats.discrete_states, None, None)
    solutions: List[Solution] = []

    def solve_once(some: Scenario, how: SolveOptions) -> Solution:
        solutions.append(solved(*game_of(some), Rules(), how))
        return solutions[-1]

    try:
        found = promised(settled, DEFAULT, solve_once)
    except Lost:
        return Facts(path.stem, scenario, settled, 0, None, None)
    stats = solutions[0].stats if whole is None else whole.stats
    states = stats.discrete_states if stats is not None else 0
    return Facts(path.stem, scenario, found.scenario, states, found.solution, found.solution.guarantee)


_WORK, _WORK_IF = 20_000_000, 100_000
"""The work for a game of several promises in one piece: about a second; and where nothing but the verdict is wanted, so
that another way to it may be shorter. Measured on care_round, care_home."""


def _in_one_piece(scenario: Scenario, work: int) -> Optional[Verdict]:
    """Who wins the default game, with nothing optional, looked at in one piece: that takes less time than a proof. None
    where it takes more than this work, or where several promises can be shared out."""
    rules, (network, objective) = Rules(), game_of(scenario.giving_up(scenario.optional))
    game, several = played(network, rules), len(objective.bad) > 1
    if several and can_be_shared(game, objective):
        return None
    with suppress(LimitHit):
        return solve(game, objective, rules.reaction, limits=Limits(work=work) if several else NO_LIMITS)
    return None


# Pages ----------------------------------------------------------------------------------------------------------------


def page(text: str, found: Facts) -> Tuple[str, Dict[str, str]]:
    """The page with all that is made here made anew, and its pictures by the names of their files."""
    pictures: Dict[str, str] = {}

    def part(match: "re.Match[str]") -> str:
        made = _PARTS[match.group(2)](found, int(match.group(3) or 0), pictures)
        return f"{match.group(1)}\n{made}\n\n{match.group(5)}"

    def row(match: "re.Match[str]") -> str:
        return f"{match.group(1)} {_if(found.scenario.text, match.group(2))} |"

    return _WHAT_IF.sub(row, _PART.sub(part, text)), pictures


def _scenario_part(found: Facts, number: int, pictures: Dict[str, str]) -> str:
    return f"```pursue\n{found.scenario.text.rstrip()}\n```"


def _verdict_part(found: Facts, number: int, pictures: Dict[str, str]) -> str:
    file = f"scenarios/{_name(found)}.pur"
    looked = f"The solver looked at {found.states:,} states"
    command = f"    pursue-gen solve {file}"
    if found.won is None:
        periods = "".join(f" {text}" for text in periods_found(found.settled, won=False))
        others = any(not agent.controllable for agent in found.scenario.agents)
        why = ": the others can always prevent it" if others else ", whatever the robots do"
        return f"**It cannot be done**{why}.{periods} {looked}.\n\n{command}"
    count = sum(len(block.commands) for block in found.won.strategy.blocks)
    has = f"{looked}; the strategy has {count} commands, and a second program has proven it."
    if found.guarantee is None:
        promise = "**It can be done**, whatever the others do, and for as long as one likes."
        promise += "".join(f" {text}" for text in periods_found(found.settled))
    else:
        counts = unit_name(found.scenario.unit)
        promise = f"**It can be done**, whatever the others do, within **{_time(found)}** {counts} at worst."
    see = f"    pursue-gen sim {file}\n    ./run mission {file} web:=true"
    says = "".join(f"\n- {sentence}" for sentence in promise_words(found.settled))
    return f"{promise} {has}\n{says and says + chr(10)}\n{command}\n{see}"


def _map_part(found: Facts, number: int, pictures: Dict[str, str]) -> str:
    where, computed = poses(found.scenario)
    pictures[f"{found.name}_map.svg"] = map_svg.draw(found.scenario, where, computed)
    return f"![Map of {found.name}]({found.name}_map.svg)"


def _mission_part(found: Facts, number: int, pictures: Dict[str, str]) -> str:
    recording = simulated(found.case, number, found.stage)
    pictures[f"{found.name}_mission.svg"] = timeline.draw(recording)
    how = f"`pursue-gen sim scenarios/{_name(found)}.pur --runs 1 --seed {number} --timeline mission.html`"
    if found.guarantee is None:
        how = how[:-1] + f" --until {UNTIL:g}`"
    picture = f"![A mission of {found.name}]({found.name}_mission.svg)"
    end = ending_text(recording)
    return f"{picture}\n\nSimulated mission {number}, {end} ({how} draws it and moves it on the map)."


_PARTS: Mapping[str, Callable[[Facts, int, Dict[str, str]], str]] = {
    "scenario": _scenario_part,
    "verdict": _verdict_part,
    "map": _map_part,
    "mission": _mission_part,
}


def _name(found: Facts) -> str:
    return Path(found.scenario.file).resolve().relative_to(SCENARIOS).with_suffix("").as_posix()


def _time(found: Facts) -> str:
    """The guaranteed time, for people; rounded up, so that it holds."""
    if found.guarantee is None:
        return "-"
    worst = found.guarantee.worst
    return "not found out" if worst is None else f"{math.ceil(worst * 10) / 10:.1f}"


# What happens if ------------------------------------------------------------------------------------------------------


def _if(text: str, changes: str) -> str:
    """The verdict on a scenario with these statements changed."""
    changed = edited(text, changes)
    if changed == text:
        raise ValueError(f"this changes nothing: {changes}")
    scenario = least_period(parse(changed, "changed.pur", "changed"), Rules())
    whole = _in_one_piece(scenario, _WORK_IF)
    if whole is not None and not (whole.won and scenario.optional):
        return "can be done" if whole.won else "cannot be done"
    try:
        found = promised(scenario, DEFAULT, lambda some, how: solution(*game_of(some), Rules(), how)).scenario
    except Lost:
        return "cannot be done"
    if not scenario.optional:
        return "can be done"
    given_up = dict.fromkeys(f"optional {one.objective.optional}" for one in found.given_up)
    return f"can be done, {f'without {listed(given_up)}' if given_up else 'all of it'}"


def edited(text: str, changes: str) -> str:
    """The scenario's text with the statements in the code spans of `changes`."""
    parts = re.split(r"\n(?!\s)", text)  # what is indented goes on with the statement above it
    for away, statement in _STATEMENT.findall(changes):
        found = [k for k, part in enumerate(parts) if _same(part, statement)] or _only(parts, statement)
        if away and not found:
            raise ValueError(f"there is no such statement: {statement}")
        for k in found:
            parts[k] = "" if away else statement
        if not found:
            parts.append(statement)
    return "\n".join(parts)


def _only(parts: List[str], statement: str) -> List[int]:
    """The objective that another one takes the place of, where there is no other objective of the kind."""
    head, (word, *_) = _of_each(statement)
    alone = [k for k, part in enumerate(parts) if _of_each(part)[0] == head and _of_each(part)[1][:1] == [word]]
    return alone if len(alone) == 1 and word in ("objective:", "reach_objective:") else []


def _same(part: str, statement: str) -> bool:
    """True if both state something on the same thing, or on the same for each of a group."""
    (head, some), (same_head, words) = _of_each(part), _of_each(statement)
    count = _SAME.get(words[0], 2)
    return head == same_head and [w.rstrip(":") for w in some[:count]] == [w.rstrip(":") for w in words[:count]]


def _of_each(statement: str) -> Tuple[List[str], List[str]]:
    """The words of `for each …:`, none where it is not there, and those behind it."""
    head = re.match(r"(for\s+each\s[^:]*:)?", statement)
    return (head[0].split() if head else []), statement[head.end() if head else 0 :].split()


# The index ------------------------------------------------------------------------------------------------------------


HEAD = "| scenario | agents | places | what is wanted | verdict | guaranteed time | states |\n|" + " --- |" * 4 + \
    " --- | ---: | ---: |"


def row(found: Facts) -> str:
    """The scenario's line in the index."""
    agents, count = found.scenario.agents, len(found.scenario.pois)
    names = ", ".join(agent.name if agent.controllable else f"*{agent.name}*" for agent in agents)
    verdict = "can be done" if found.won else "**cannot**"
    wanted = "; ".join(f"`{text}`" for text in _wanted(found.scenario, found.settled))
    link = f"[{_name(found)}](scenarios/{found.name}.md)"
    return f"| {link} | {names} | {count} | {wanted} | {verdict} | {_time(found)} | {found.states:,} |"


def _wanted(scenario: Scenario, settled: Scenario) -> List[str]:
    """The objectives, as the scenario has them, and which of them are given up."""
    given_up = {one.objective.span for one in settled.given_up}
    wanted = [statement[0] for statement in scenario.statements]
    return [f"{_numbered(each)}{' (given up)' if each.span in given_up else ''}" for each in wanted]


def _numbered(objective: StatedObjective) -> str:
    text = objective.text
    return f"optional {objective.optional}: {text}" if objective.optional else text


def index(text: str, rows: Mapping[str, str]) -> str:
    """The index with these lines, by name, in place of those that it has; all in the order of the folders."""
    part = re.search(r"(<!-- made: table -->\n).*?(<!-- end -->)", text, re.DOTALL)
    assert part is not None, "the index has a place for its table"
    known = {name: line for line in part.group(0).split("\n") for name in re.findall(r"\(scenarios/(\w+)\.md\)", line)}
    known.update(rows)
    table = "\n".join([HEAD, *(known[name] for name in scenario_files() if name in known)])
    return f"{text[:part.start()]}{part.group(1)}\n{table}\n\n{part.group(2)}{text[part.end():]}"


def main(names: List[str]) -> int:
    """Makes these pages, or all, and the index."""
    files, rows = scenario_files(), {}
    for name in names or list(files):
        try:
            found = facts(files[name])
        except PursueError as problem:
            print(f"{name}: {problem}", file=sys.stderr)
            return problem.exit_status
        rows[name] = row(found)
        target = PAGES / f"{name}.md"
        made, pictures = page(target.read_text(encoding="utf-8"), found)
        write_texts({target: made, **{PAGES / file: svg for file, svg in pictures.items()}})
        print(target.relative_to(ROOT))
    write_texts({INDEX: index(INDEX.read_text(encoding="utf-8"), rows)})
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
