"""What the strategy does next, if nobody who is not controlled begins anything: the model is played with it.

Times are time units from the state on from which is played. Ends are taken as early as their windows allow.
"""

from __future__ import annotations

from typing import Dict, Iterator, List, NamedTuple, Optional, Sequence, Tuple

from pursue_runtime.locations import TO_BE_SAID
from pursue_runtime.model import Model, Position
from pursue_runtime.state import RUNNING, SystemState
from pursue_runtime.strategy import Strategy
from pursue_runtime.vocabulary import deed
from pursue_runtime.zones import EPSILON, due

MOST = 16
"""So many events are looked ahead."""

_MARGIN = 0.05  # time units inside an open bound, as in mission_view


class Step(NamedTuple):
    """An event to come: when, whose it is, what that is (`go to b`, `arrive at b`), whether it is a command, and the
    agent's location then."""

    after: float
    agent: str
    does: str
    commanded: bool
    location: str


def course(model: Model, strategies: Sequence[Strategy], state: SystemState) -> List[Step]:
    """The next events by these strategies, one for each controller, in order; none where the mission does not run.

    It ends at the goal, where the strategies know nothing more to do, where somebody who is not controlled has to act,
    and where somebody has to say what a state is, or where an agent starts.
    """
    if state.status != RUNNING:
        return []
    return list(_steps(model, strategies, Position(state.locations, state.values, state.clocks), set(state.lost)))


def _steps(model: Model, strategies: Sequence[Strategy], here: Position, lost: "set[str]") -> Iterator[Step]:
    passed = 0.0
    for _ in range(MOST):
        if model.goal and all(here.locations[name] == place for name, place in model.goal):
            return
        moves = [*_commands(strategies, here), *_ends(model, here, lost)]
        if not moves:
            return
        delay, agent, word, commanded = min(moves, key=lambda move: move[0])
        if delay > _patience(model, here) + EPSILON:
            return
        before, here = here, here.aged(delay)
        taken = model.joint_move(here, word, agent, timed=False)
        if taken is None:
            return
        passed += delay
        automaton = model.automaton(agent)
        if automaton.acts:
            edge = taken[0].edge
            yield Step(passed, agent, deed(model, automaton, edge).do, commanded, edge.target)
        here = model.after(taken, here)
        if here == before:
            return


_Move = Tuple[float, str, str, bool]
"""After what time, whose, which word, and whether it is a command."""


def _commands(strategies: Sequence[Strategy], here: Position) -> Iterator[_Move]:
    """The next command of each controller."""
    now = SystemState(0, 0.0, *here)
    for strategy in strategies:
        found = strategy.next_command(now, 0.0)
        if found is not None:
            yield found[0], found[1].agent, found[1].event, True


def _ends(model: Model, here: Position, lost: "set[str]") -> Iterator[_Move]:
    """The ends of what goes on; one that is overdue comes at once."""
    for automaton in model.acting:
        location = here.locations[automaton.name]
        for edge in automaton.edges_from(location):
            if edge.sync == "receive" or edge.controllable or not edge.is_end:
                continue
            if location in TO_BE_SAID:
                yield 0.0, automaton.name, "", False  # nobody knows what comes of it
                break
            if automaton.name not in lost and edge.allowed(here.values):
                yield due([edge.when], here.clocks, _MARGIN) or 0.0, automaton.name, edge.word, False
                break


def _patience(model: Model, here: Position) -> float:
    """How long those may stay where they are who are not under way: then they have to begin something."""
    rooms = [float("inf")]
    for automaton in model.of_kind("agent"):
        location = here.locations[automaton.name]
        if not any(edge.is_end for edge in automaton.edges_from(location)):
            bounds = model.bounds_of(automaton.name, location, here.values)
            rooms += [bound.bound - here.clocks[bound.left] for bound in bounds if bound.left]
    return min(rooms)


def first_commands(steps: Sequence[Step]) -> Dict[str, Step]:
    """The first command of each agent."""
    found: Dict[str, Step] = {}
    for step in steps:
        if step.commanded:
            found.setdefault(step.agent, step)
    return found


def is_certain(steps: Sequence[Step], step: Step) -> bool:
    """Return True if nothing has to end before a step: its moment is known then, not only the earliest one."""
    return all(each.commanded for each in steps[: list(steps).index(step)])


def next_command(steps: Sequence[Step]) -> Optional[Step]:
    """The first command; None where there is none."""
    return next((step for step in steps if step.commanded), None)
