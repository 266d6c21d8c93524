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
from pursue_gen.tools.authoring.requirements import (
    AVOID,
    CATCH,
    KINDS,
    NEVER_WITH,
    PATROL,
    REACH,
    RESPOND,
    Requirements,
    Task,
    deadline,
    unused,
)

_WORK = 50_000_000
"""Enough for a first scenario: ten seconds or so. Not measured."""


def scenario_text(given: Requirements, file: str) -> str:
    """A scenario that meets the requirements, laid out; `file` is its name in the comments."""
    parts = [_head(given, file), _places(given), _events(given), _order(given), _agents(given)]
    parts += [_assumption(given), _goal(given)]
    return format_text("\n\n".join("\n".join(part) for part in parts if part), file)


def _head(given: Requirements, file: str) -> List[str]:
    return [
        f"// A first scenario: {KINDS[given.kind]}.",
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
    if given.kind == PATROL:
        return []
    lines = ["// What can happen. Without a location: anywhere. Without a duration: it takes no time."]
    lines += [_event(task) for task in given.tasks]
    if given.kind == RESPOND:
        lines.append(f'event "{given.event}"')
    elif given.kind == AVOID:
        lines.append(f'event "{given.event}" location {given.tasks[0].place}')
    elif given.event:
        lines += [
            "// It takes two: one who can do it, and one who reacts to it.",
            f'event "{given.event}" collaborative',
        ]
    return lines


def _order(given: Requirements) -> List[str]:
    """The rule, or for avoid the state."""
    if given.kind == AVOID:
        state, prevents = unused("safe", given.names), given.tasks[0].event
        return [
            f"// A state is true or false. When {prevents} has made this one true, {given.event} is not possible.",
            f'state "{state}": initially false, true_if {prevents}',
            f"stateDependency: {given.event} only_if {state} is_false",
        ]
    steps = [task.event for task in given.tasks]
    if given.kind == RESPOND:
        steps.insert(0, given.event)
    elif given.kind == REACH and given.event:
        steps.append(given.event)
    if len(steps) < 2:
        return []
    body = steps[0]
    for number, step in enumerate(steps[1:]):
        body = f"({body}) before {step}" if number else f"{body} before {step}"
    rule = unused("order", given.names)
    return ["// The order, round after round: each of these waits for its turn.", f'rule "{rule}": {body}']


def _agents(given: Requirements) -> List[str]:
    first, last = given.places[0], given.places[-1]
    lines = [
        "// Who is there. What is controllable does what the plan says.",
        "// mobile 2: needs 2 units of time for one unit of distance; so a larger number is slower.",
    ]
    for number, robot in enumerate(given.robots):
        can = [robot.task.event] if robot.task is not None else []
        if given.kind == CATCH or (given.kind == REACH and given.event and number == len(given.robots) - 1):
            can.append(given.event)
        start = last if given.kind == NEVER_WITH and number == 1 else first
        if robot.mobile is None and robot.task is not None:
            start = robot.task.place
        part = f"can_do {', '.join(can)}" if can else ""
        lines.append(_agent(robot.name, "controllable", robot.mobile, start, part))
    if given.other:
        lines += ["", "// Not controllable: does what it likes, also the worst."]
        part = {RESPOND: "can_do", AVOID: "can_do", REACH: "reacts_to", CATCH: "reacts_to"}.get(given.kind, "")
        lines.append(_agent(given.other, "", given.mobile, last, f"{part} {given.event}" if part else ""))
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


def _goal(given: Requirements) -> List[str]:
    tasks = given.tasks
    if given.kind == RESPOND:
        time = deadline(given.distances, given.robots)
        return [
            "// What has to hold always. Try a shorter time: when it is too short, solve says so, and what would help.",
            f"objective: if {given.event} then {tasks[-1].event} within {time}",
        ]
    if given.kind == AVOID:
        return ["// What must never happen.", f"objective: avoid {given.event}"]
    if given.kind == NEVER_WITH:
        second = given.other or given.robots[1].name
        return [
            "// What must always hold (never at one place, and never face to face on a way), and what has to be done.",
            f"objective: {given.robots[0].name} never_with {second}",
            f"reach_objective: do {tasks[-1].event}",
        ]
    if given.kind == PATROL:
        who = given.robots[0].name if len(given.robots) == 1 else "any robot"
        return [
            "// What has to hold always: in each place again, at most so many units of time after it was left.",
            f"objective: patrol {', '.join(given.places)} every {given.every} by {who}",
        ]
    within = f" within {given.within}" if given.within is not None else ""
    return ["// What is wanted.", f"reach_objective: do {given.event or tasks[-1].event}{within}"]


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
