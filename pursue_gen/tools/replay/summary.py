"""The findings as a text for people and as JSON for programs."""

from __future__ import annotations

from typing import Any, Dict, Iterator, List

from pursue_gen.tools.replay.check import Findings
from pursue_gen.tools.replay.finding import FAULT, NOTE, UNRECORDED, WORLD, Finding
from pursue_gen.tools.replay.record import MissionRecord
from pursue_gen.tools.replay.steps import ReplayedStep
from pursue_runtime.model import Model
from pursue_runtime.vocabulary import sentence

_MARKS = {NOTE: "", WORLD: "WORLD: ", FAULT: "FAULT: ", UNRECORDED: "NOT RECORDED: "}


def listed(findings: Findings, model: Model, notes: bool = True) -> Iterator[str]:
    """The mission line by line: each step with its moment in time units, below it what was found there.

    Steps are in the words of the node UI.
    """
    about: Dict[int, List[Finding]] = {}
    for finding in findings.findings:
        if notes or finding.level != NOTE:
            about.setdefault(finding.seq, []).append(finding)
    steps = {step.state.seq: step for step in findings.steps}
    yield f"{'at':>9} {'state':>6}"
    for seq in sorted({*steps, *about}):
        if seq in steps:
            yield f"{_at(findings, steps[seq]):9.2f} {seq:6}  {_step(steps[seq], model)}"
        for finding in about.get(seq, ()):
            head = f"{seq:16}  " if seq not in steps and finding is about[seq][0] else " " * 18
            yield f"{head}{_MARKS[finding.level]}{finding.text}"


def summary(findings: Findings) -> str:
    """How much there was of what."""
    n = findings.counts
    others = n["steps"] - n["commands"] - n["reports"]
    text = f"{n['steps']} steps in {findings.length:.1f} {findings.times_in}: "
    text += f"{n['commands']} by command, {n['reports']} by report"
    text += f", {others} by themselves" if others else ""
    text += f"; {n['dropped']} words led to nothing" if n["dropped"] else ""
    text += f"; {n['plans']} new plans" if n["plans"] else ""
    text += f"; {n['holds']} holds" if n["holds"] else ""
    return text


def verdict(findings: Findings) -> str:
    """Whether the mission kept to the model and was won, in a sentence."""
    faults = [finding for finding in findings.findings if finding.level == FAULT]
    world = [finding for finding in findings.findings if finding.level == WORLD]
    ends = {"won": "was won", "lost": "was lost", "stopped": "was stopped", "waiting": "never began"}
    end = ends.get(findings.status, "had not ended when the recording did")
    end += f" ({findings.reason})" if findings.reason else ""
    if findings.kept:
        return f"The mission kept to the model{' and' if findings.won else ', but'} {end}."
    what = [f"left the model {'once' if len(world) == 1 else f'{len(world)} times'} (the world)"] if world else []
    what += [f"has {len(faults)} faults of nodes or of the recording"] if faults else []
    if not what:
        first = next(finding for finding in findings.findings if finding.level == UNRECORDED)
        kept = "The mission kept to the model as far as it was recorded"
        return f"{kept}{', and' if findings.won else ', but'} {end}. Not recorded: state {first.seq}, {first.text}."
    first = (faults or world)[0]
    return f"The mission {' and '.join(what)}, and {end}. First: state {first.seq}, {first.text}."


def as_json(findings: Findings, record: MissionRecord, file: str) -> Dict[str, Any]:
    """Everything, as a JSON object."""
    return {
        "file": file,
        "kept": findings.kept,
        "won": findings.won,
        "status": findings.status,
        "reason": findings.reason,
        "length": round(findings.length, 6),
        "counts": dict(findings.counts),
        "steps": [
            {
                "seq": step.state.seq,
                "at": round(_at(findings, step), 6),
                "agent": step.state.agent,
                "event": step.state.event,
                "said_by": step.word.node if step.word else None,
                "word": step.word.text if step.word else None,
                "command": step.is_command,
                "plan": step.state.plan,
                "status": step.state.status,
            }
            for step in findings.steps
        ],
        "findings": [vars(finding) for finding in findings.findings],
        "unread": list(record.problems),
        "verdict": verdict(findings),
    }


def _at(findings: Findings, step: ReplayedStep) -> float:
    """Time units since the start."""
    return (step.state.stamp - findings.start) / step.state.unit


def _step(step: ReplayedStep, model: Model) -> str:
    word, what = step.word, sentence(model, step.state, step.before)
    if word is None:
        return what
    return f"{what}, {'command' if step.is_command else 'report'}{f' of {word.node}' if word.node else ''}"
