"""Robots that were taken out of service, and brought back: each with a plan that is proven for that, and no command."""

from __future__ import annotations

from typing import Any, Iterator, Mapping, Sequence

from pursue_gen.tools.replay.finding import FAULT, NOTE, Finding
from pursue_gen.tools.replay.steps import ReplayedStep
from pursue_runtime.event_words import JOINS, LEAVES
from pursue_runtime.state import SystemState


def changed_service(
    before: SystemState, state: SystemState, plans: Mapping[int, Mapping[str, Any]]
) -> Iterator[Finding]:
    """What is to say of the robots that one state has out of service and the other has not."""
    was, now = set(before.out_of_service), set(state.out_of_service)
    plan, is_new = plans.get(state.plan, {}), state.plan != before.plan
    if is_new and not was & now <= set(plan.get("out_of_service", ())):
        text = f"plan {state.plan} is not proven to do without {' and '.join(sorted(was & now))}, out of service"
        yield Finding(FAULT, "service", state.seq, text)
    for robot in sorted(now - was):
        yield Finding(NOTE, "service", state.seq, f"{robot} is out of service: nothing is sent to it")
        proven = is_new and plan.get("order") == LEAVES and robot in plan.get("out_of_service", ())
        if not proven or (state.event, state.agent) != (LEAVES, robot):
            text = f"{robot} was taken out of service without a plan that is proven to do without it"
            yield Finding(FAULT, "service", state.seq, text)
    for robot in sorted(was - now):
        yield Finding(NOTE, "service", state.seq, f"{robot} is in service again")
        if (state.event, state.agent) != (JOINS, robot):
            yield Finding(FAULT, "service", state.seq, f"{robot} is in service again, and nobody brought it back")


def commands_out_of_service(steps: Sequence[ReplayedStep]) -> Iterator[Finding]:
    """The commands that had a robot out of service begin something."""
    for step in steps:
        for name, edge in step.move if step.is_command else ():
            if name in step.before.out_of_service and not edge.is_end:
                text = f"{step.state.event} was commanded, and {name}, which takes part in it, is out of service"
                yield Finding(FAULT, "service", step.state.seq, text)
