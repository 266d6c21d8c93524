"""Whether commands were the strategy's, given by those who may, while the mission ran, and to no robot out of service.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Iterator, List, Mapping, Sequence

from pursue_gen.language.network_names import ORDER_DESK
from pursue_gen.tools.replay.finding import FAULT, NOTE, UNRECORDED, Finding
from pursue_gen.tools.replay.game import Game
from pursue_gen.tools.replay.orders import Orders, in_time
from pursue_gen.tools.replay.record import MissionRecord
from pursue_gen.tools.replay.steps import ReplayedStep, aged, zones_of
from pursue_runtime.event_words import JOINS, LEAVES
from pursue_runtime.locations import is_end, is_movement
from pursue_runtime.state import HOLDING, SystemState


@dataclass(frozen=True)
class CommandCheck:
    """The commands of one record. `orders`: the strategies by the number of their plan; `late` and `early`: by how many
    time units a command may be beside the reaction, and beside when it is due."""

    record: MissionRecord
    game: Game
    orders: Mapping[int, Orders]
    late: float
    early: float

    def findings(self, steps: Sequence[ReplayedStep]) -> List[Finding]:
        """What is to say of the steps that followed commands, or should have."""
        controllers = {node for orders in self.orders.values() for nodes in orders.owners.values() for node in nodes}
        found: List[Finding] = []
        for step in steps:
            word, seq = step.word, step.state.seq
            if self.game.is_deadline(*step.move[0]) and not step.is_command:
                continue  # it passes by itself, whoever has said so before
            if step.state.agent == ORDER_DESK:
                continue  # people order on another topic, and the observer takes it with the plan for it
            orders = self.orders.get(step.before.plan)
            owners = orders.owners.get(step.move[0][0], frozenset()) if orders is not None else frozenset()
            by_hand = word is not None and (word.seq is None or (bool(word.node) and word.node not in controllers))
            if word is None:
                level = UNRECORDED if step.state.stamp <= self.record.whole_from else FAULT
                found.append(Finding(level, "unsaid", seq, f"no word for {step.state.event} was recorded"))
            elif word.seq is None:
                # A controller reports where its own robots arrive: it sees move_base's results and their positions.
                _, edge = step.move[0]
                is_arrival = is_movement(edge.source) and is_end(edge.source, edge.target)
                if word.node in controllers - {"UI"} and not (is_arrival and word.node in owners):
                    text = f"{word.node} published {word.text}, and ends are reported by robots"
                    found.append(Finding(FAULT, "owner", seq, text))
            else:
                if step.before.status == HOLDING:
                    found.append(Finding(FAULT, "held", seq, f"{word.text} was taken while the mission held"))
                if orders is not None and word.node in controllers and word.node not in owners:
                    whose = " or ".join(sorted(owners)) or "no node"
                    found.append(
                        Finding(FAULT, "owner", seq, f"{word.node} commands {step.move[0][0]}, which is for {whose}")
                    )
            if orders is not None and self._begins(step, orders) and not self._wanted(orders, step):
                text = f"{step.state.event} by {step.move[0][0]} is not what the strategy prescribes"
                text += f" in state {step.before.seq}"
                text += f"; it was published by {word.node or 'nobody known'}" if word and by_hand else self.game.doubt
                found.append(Finding(NOTE if by_hand else FAULT, "command", seq, text))
        return found

    @staticmethod
    def _begins(step: ReplayedStep, orders: Orders) -> bool:
        """True for a step that is for the strategy to begin, whatever was recorded of it."""
        agent, edge = step.move[0]
        return step.is_command or (agent in orders.owners and not edge.is_end)

    def _wanted(self, orders: Orders, step: ReplayedStep) -> bool:
        """True where the strategy has this command at the moment, or had it not longer ago than the reaction, since
        something happened that it sees."""
        before, state, first = step.before, step.state, self.record.states[0]
        back = orders.reaction + self.late
        if not (self.record.is_late and step.since.seq == first.seq):  # else it may have been decided before
            back = min(back, (state.stamp - step.since.stamp) / state.unit)
        return in_time(zones_of(orders, step), aged(before, state), back, self.early)


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
