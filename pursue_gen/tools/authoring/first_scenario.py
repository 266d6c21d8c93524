"""The text of a first scenario, with the comments that a beginner needs."""

from __future__ import annotations

from pathlib import Path
from typing import List, Optional

from pursue_gen.diagnostics import usage_error
from pursue_gen.language.formatter import format_text
from pursue_gen.language.names import check_names
from pursue_gen.language.parser import parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.synthesis.limits import Limits, Listener, careful_memory
from pursue_gen.tools.authoring.goals import GOALS
from pursue_gen.tools.authoring.requirements import Requirements, Task, unused

_WORK = 50_000_000
"""Enough for a first scenario: ten seconds or so. Not measured."""


def scenario_text(given: Requirements, file: str) -> str:
    """A scenario that meets the requirements, laid out; `file` is its name in the comments."""
    goal = GOALS[given.kind]
    parts = [_head(given, file), _places(given), _events(given), _order(given), _agents(given)]
    parts += [_assumption(given), goal.wanted(given)]
    return format_text("\n\n".join("\n".join(part) for part in parts if part), file)


def _head(given: Requirements, file: str) -> List[str]:
    return [
        f"// A first scenario: {GOALS[given.kind].meaning}.",
        "// Change whatever you like, then ask again:",
        f"//   pursue-gen check {file}   is anything wrong with it?",
        f"//   pursue-gen solve {file}   can it be done, and how fast?",
    ]


def _places(given: Requirements) -> List[str]:
    lines = ["// Places. Names stand in quotes here, and without quotes wherever they are used."]
    lines += [f'poi "{place}"' for place in given.places]
    if given.distances:
        lines += ["", "// Ways, in both directions. The unit of distance is yours to choose."]
    for a, b, distance in zip(given.places, given.places[1:], given.distances):
        lines.append(f"connect {a} and {b} distance {distance}")
    return lines


def _event(task: Task) -> str:
    return f'event "{task.event}" location {task.place}' + (f" duration {task.duration}" if task.duration else "")


def _events(given: Requirements) -> List[str]:
    lines = [*map(_event, given.tasks), *GOALS[given.kind].events(given)]
    head = "// What can happen. Without a location: anywhere. Without a duration: it takes no time."
    return [head, *lines] if lines else []


def _order(given: Requirements) -> List[str]:
    """The rule, and what the goal has in its place or beside it."""
    goal = GOALS[given.kind]
    lines, steps = goal.order(given), goal.steps(given)
    if len(steps) < 2:
        return lines
    body = steps[0]
    for number, step in enumerate(steps[1:]):
        body = f"({body}) before {step}" if number else f"{body} before {step}"
    rule = unused("order", given.names)
    return [*lines, "// The order, round after round: each of these waits for its turn.", f'rule "{rule}": {body}']


def _agents(given: Requirements) -> List[str]:
    goal, first, last = GOALS[given.kind], given.places[0], given.places[-1]
    lines = [
        "// Who is there. What is controllable does what the plan says.",
        "// mobile 2: needs 2 units of time for one unit of distance; so a larger number is slower.",
    ]
    for number, robot in enumerate(given.robots):
        can = [robot.task.event] if robot.task is not None else []
        if goal.does(given, number):
            can.append(given.event)
        start = last if goal.apart and number == 1 else first
        if robot.mobile is None and robot.task is not None:
            start = robot.task.place
        part = f"can_do {', '.join(can)}" if can else ""
        lines.append(_agent(robot.name, "controllable", robot.mobile, start, part))
    if given.other:
        lines += ["", "// Not controllable: does what it likes, also the worst."]
        part = f"{goal.takes_part} {given.event}" if goal.takes_part else ""
        lines.append(_agent(given.other, "", given.mobile, last, part))
    return lines


def _assumption(given: Requirements) -> List[str]:
    if given.waits is None:
        return []
    return [
        "// What the plan may rely on. A mission watches it: if it is broken, another plan is looked for.",
        f"assume: {given.other} waits {given.waits} between {given.event}",
    ]


def _agent(name: str, controllable: str, mobile: Optional[int], location: str, part: str) -> str:
    moves = "" if mobile is None else f"mobile {mobile}"
    return " ".join(filter(None, (f'agent "{name}"', controllable, moves, f"location {location}", part)))


def place_for(name: str, output: Optional[Path]) -> Path:
    """The file of a scenario with this name, in the folder or the file `output`, else here.

    Raises PursueError (exit status 2) for a name that cannot be a scenario's.
    """
    place = Path(name if name.endswith(".pur") else name + ".pur")
    file = place if output is None else output / place.name if output.is_dir() else output
    for word in (place.stem, file.stem):
        if any(check_names(parse("", file=word, name=word))):
            hint = "use letters, digits and _, a letter first: pursue-gen new my_floor"
            raise usage_error(f"{word!r} cannot be the name of a scenario", hint)
    return file


def tried(scenario: Scenario, progress: Optional[Listener] = None) -> None:
    """Solves it in the default game. Raises PursueError where it is lost, or not decided with so much `_WORK`."""
    solve_scenario(scenario, Rules(), SolveOptions(Limits(work=_WORK, memory=careful_memory()), progress=progress))
