"""What became of missions whose nodes were killed (benchmarks/kills.py): what is kept of them, and docs/kills.md."""

from __future__ import annotations

import collections
import textwrap
from fractions import Fraction
from typing import Any, Dict, List, NamedTuple, Sequence, Tuple

from pursue_gen.solving.rules import Rules

RULES = Rules(reaction=Fraction(1, 2))
"""Commands may come half a time unit late: what a message and a busy machine need, at half a second per time unit."""

UNTIL = 60.0
"""Time units after which a mission that has no goal is ended."""

OTHERS = {
    "lab/17": "promises in three shares",
    "lab/16": "promises in three shares; the patrol by any robot has a watcher for each robot",
    "corridor/4": "four robots with an order of passage",
    "patrol, period given/12": "promises in two shares, each with a tour of three rooms",
    "square/8": "eight robots with an order of passage",
    "callers/3": "a policy for three callers",
}
"""Scenarios whose strategies are not in one piece: lab scenarios (benchmarks/lab_scenarios.py) by their seeds, families
(benchmarks/ordinary_families.py) by their sizes; and what their strategies have."""


class Mission(NamedTuple):
    """What became of one mission: a word of OUTCOMES, the reason or the first fault, and who was killed; `missed`: the
    messages that both recorders have missed, and that were published for certain."""

    number: int
    scenario: str
    outcome: str
    why: str
    kills: Tuple[str, ...]
    missed: Tuple[str, ...] = ()


HEAD = ("seed", "unit", "machine")
"""What missions have in common that are counted together."""

WORD = "the word"
"""How what was missed begins where it is no order."""

BAD = ("wrong", "no end")
"""The words of OUTCOMES that must not be."""

OUTCOMES = {
    "goal": "the goal was reached, or all was kept until the end, and each step was the strategy's or the world's",
    "stopped": "stopped safely, with a reason",
    "lost": "a deadline has passed; before that a robot was late by its model (its simulator was dead), or the mission "
    "held, as there was no plan yet (its controller had been dead)",
    "wrong": "a step, a command or an order that the strategy does not hold, or a verdict that is not true",
    "no end": "no verdict in time",
}


def results(done: Sequence[Mission]) -> Dict[str, Any]:
    """Return what is kept of these missions in kills.json."""
    table: Dict[str, Dict[str, int]] = {}
    for each in done:
        row = table.setdefault(each.scenario, dict.fromkeys(OUTCOMES, 0))
        row[each.outcome] += 1
    reasons = collections.Counter(each.why for each in done if each.outcome in ("stopped", "lost"))
    kills = sum(len(each.kills) for each in done)
    bad = [each._asdict() for each in done if each.outcome in BAD]
    missed = [{"number": each.number, "missed": each.missed} for each in done if each.missed]
    return {
        "missions": len(done),
        "kills": kills,
        "table": table,
        "reasons": dict(reasons.most_common()),
        "bad": bad,
        "missed": missed,
    }


def mismatch(before: Dict[str, Any], head: Dict[str, Any]) -> str:
    """Return why missions of this seed, unit, machine and first number cannot be added to what was found before; ""
    if they can."""
    if head["parts"][0]["first"] == before["missions"] and all(head[key] == before[key] for key in HEAD):
        return ""
    there = f"{before['missions']} missions, " + ", ".join(f"{key} {before[key]}" for key in HEAD)
    return f"missions from {head['parts'][0]['first']} on cannot be added to what is there: {there}"


def together(before: Dict[str, Any], found: Dict[str, Any]) -> Dict[str, Any]:
    """Return the results of missions that were played before, and of the missions that follow them."""
    names = {**before["table"], **found["table"]}
    none = dict.fromkeys(OUTCOMES, 0)
    rows = {name: (before["table"].get(name, none), found["table"].get(name, none)) for name in names}
    reasons = collections.Counter(before["reasons"]) + collections.Counter(found["reasons"])
    return {
        **before,
        **{key: before[key] + found[key] for key in ("missions", "kills", "bad", "missed", "parts")},
        "table": {name: {head: old[head] + new[head] for head in OUTCOMES} for name, (old, new) in rows.items()},
        "reasons": dict(reasons.most_common()),
    }


RECORDERS = (
    "Two recorders that share nothing record each mission: the workspace's own, and `rosbag record`, which is there",
    "before all nodes. What either has was published. A word that both have missed was published if the observer's",
    "journal has it as heard; the judge then does not know who published it. An order that both have missed was given",
    "if the robot's side has acknowledged its number. Any other order or word that is missing is wrong, and so",
    "is an order without acknowledgement in a mission that was won, where one was needed. Where both have missed how a",
    "mission ended, it was won if they have the state of its goal and the observer's `Finish!` behind it.",
)
"""What the page says of the recorders."""


_OTHERS = (
    "Strategies that are not in one piece, or made by a policy. A lab scenario (benchmarks/lab_scenarios.py) has its",
    "seed behind it, a member of a family (benchmarks/ordinary_families.py) its size. Where there are promises alone,",
    f"the mission is ended by `Finish!` after {UNTIL:g} time units; all deadlines until then have to be kept.",
)
"""What the page says of them."""


def _wrapped(item: str) -> List[str]:
    return textwrap.wrap(item, 120, subsequent_indent="  ")


def _part_line(part: Dict[str, Any]) -> str:
    commit = f" with commit {part['commit']}" if part["commit"] else ""
    return f"- missions {part['first']} to {part['first'] + part['missions'] - 1}: played {part['date']}{commit}"


def _missed_line(missed: Sequence[Dict[str, Any]]) -> str:
    found = [what for each in missed for what in each["missed"]]
    words = sum(what.startswith(WORD) for what in found)
    counts = f"words {words}, orders {len(found) - words}"
    return f"both recorders have missed what was published in {len(missed)} of them: {counts}."


def page(found: Dict[str, Any]) -> str:
    """Return the page docs/kills.md."""
    heads = list(OUTCOMES)
    lines = [
        "# Missions whose nodes are killed",
        "",
        "Written by `python -m benchmarks.kills --out docs`. Each mission runs on a ROS master of its own. One to five",
        "times a random node (observer, controllers, simulator, UI) is killed with SIGKILL; roslaunch starts it again",
        "after a second. The mission is recorded, and judged from the recording and the workspace's strategy alone, by",
        "what `pursue-gen replay` does.",
        "",
        *RECORDERS,
        "",
        f"{found['missions']} missions with {found['kills']} kills, seed {found['seed']}, {found['unit']} s per time",
        f"unit, reaction {float(RULES.reaction)}; {found['machine']};",
        _missed_line(found["missed"]),
        "",
        *(_part_line(part) for part in found["parts"]),
        "",
        *([found["remark"], ""] if found.get("remark") else []),
        "| scenario | " + " | ".join(heads) + " |",
        "| --- |" + " --- |" * len(heads),
        *(f"| {name} | " + " | ".join(str(row[head]) for head in heads) + " |" for name, row in found["table"].items()),
        "",
        *(line for head, meaning in OUTCOMES.items() for line in _wrapped(f"- **{head}**: {meaning}.")),
    ]
    others = [f"- {name}: {has}." for name, has in OTHERS.items() if name in found["table"]]
    if others:
        lines += ["", *_OTHERS, "", *others]
    if found["reasons"]:
        lines += ["", "| reason of a stop or a loss | missions |", "| --- | --- |"]
        lines += [f"| {why.replace('|', '/')} | {count} |" for why, count in found["reasons"].items()]
    return "\n".join(lines) + "\n"
