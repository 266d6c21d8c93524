"""What the page says of the strategy: what is next, why robots do what they do, how it answers what others may do.

Moments are time units since the start of the mission.
"""

from __future__ import annotations

from typing import Any, Dict, Iterator, List, NamedTuple, Optional, Sequence, Tuple

from pursue_runtime.event_words import event_in
from pursue_runtime.locations import is_under_way
from pursue_runtime.model import Model, Position
from pursue_runtime.state import SystemState
from pursue_runtime.ui.course import Step, course, first_commands, is_certain, next_command
from pursue_runtime.ui.mission_view import PossibleWord
from pursue_runtime.ui.reasons import Why
from pursue_runtime.ui.statuses import Status
from pursue_runtime.ui.strategies import Strategies
from pursue_runtime.ui.turns import Turns


class Sight(NamedTuple):
    """What is to be seen in one state, as values for JSON.

    `planned`: the strategy is known here. `next`: the next command. `agents`: for each agent why it does what it does,
    or for whom it waits, and its first command (`then`). `answers`: by the word that an agent may begin with that
    nobody controls, the next command if it does, where that is another one.
    """

    planned: bool
    next: Optional[Dict[str, Any]]
    agents: Dict[str, Dict[str, Any]]
    answers: Dict[str, str]


class Outlook:
    """What the strategies of a mission have in store."""

    def __init__(self, model: Model, statuses: Sequence[Status], strategies: Strategies) -> None:
        self._model, self._strategies = model, strategies
        self._why = Why(model, statuses, strategies)
        self._turns = Turns(model, strategies)
        self._seen: Tuple[object, Optional[Sight]] = (None, None)  # of which state

    def on_state(self, state: SystemState) -> None:
        """A state came."""
        self._why.on_state(state)

    def sight(self, state: SystemState, at: float, offers: Sequence[PossibleWord]) -> Sight:
        """What is to be seen in a state that began at `at`; `offers`: what agents can begin or end in it."""
        known = self._strategies.get(state.plan)
        key = known, state.seq, state.stamp, state.plan, state.status, state.lost, at
        found = self._seen[1] if self._seen[0] == key else None
        if found is None:
            found = self._look(state, at, offers)
            self._seen = key, found
        return found

    def _look(self, state: SystemState, at: float, offers: Sequence[PossibleWord]) -> Sight:
        strategies = self._strategies.get(state.plan, ())
        steps = course(self._model, strategies, state) if strategies else []
        first = first_commands(steps)
        waits = self._turns.waits(state)
        agents = {
            name: {"why": waits.get(name) or self._why.of(name), "then": self._then(steps, first.get(name), at)}
            for name in state.locations
        }
        answers = dict(self._answers(state, offers, steps)) if strategies else {}
        return Sight(bool(strategies), self._command(steps, at), agents, answers)

    def _answers(
        self, state: SystemState, offers: Sequence[PossibleWord], steps: Sequence[Step]
    ) -> Iterator[Tuple[str, str]]:
        """How the strategy answers each of these offers that its agent begins something with, as early as it may."""
        usual = next_command(steps)
        alone = {automaton.name for automaton in self._model.of_kind("agent")}
        for offer in offers:
            if offer.agent not in alone or is_under_way(state.locations[offer.agent]):
                continue
            position = Position(state.locations, state.values, state.clocks).aged(offer.opens)
            moves = self._model.joint_move(position, event_in(offer.word), offer.agent, timed=False)
            if moves is None:
                continue
            after = self._model.after(moves, position)
            there = state._replace(locations=after.locations, values=after.values, clocks=after.clocks)
            step = next_command(course(self._model, self._strategies.get(state.plan, ()), there))
            if step is not None and (usual is None or (step.agent, step.does) != (usual.agent, usual.does)):
                yield offer.word, self._says(step)

    def _command(self, steps: Sequence[Step], at: float) -> Optional[Dict[str, Any]]:
        """The first command of a course that begins at `at`, and when it is due."""
        step = next_command(steps)
        if step is None:
            return None
        return {"says": self._says(step), **_due(steps, step, at)}

    def _says(self, step: Step) -> str:
        return f"{self._model.shown(step.agent)} is to {step.does}"

    @staticmethod
    def _then(steps: List[Step], step: Optional[Step], at: float) -> Optional[Dict[str, Any]]:
        return None if step is None else {"does": step.does, **_due(steps, step, at)}


def _due(steps: Sequence[Step], step: Step, at: float) -> Dict[str, Any]:
    """When a step comes; `certain`: nothing has to end before."""
    return {"at": round(at + step.after, 3), "certain": is_certain(steps, step)}
