"""What the page says of the strategy: what is next, why robots do what they do, how it answers what others may do.

A reason is found in the strategy alone: what would have to be different for it to do something else with a robot. In
the state of the decision, one agent, rule or state is put elsewhere and all else is kept; where the strategy knows that
state, and does other things only with the robot, that agent is a reason. Where there is none, nothing is said.

Moments are time units since the start of the mission.
"""

from __future__ import annotations

from typing import Any, Dict, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Tuple

from pursue_runtime.event_words import event_in
from pursue_runtime.locations import is_under_way
from pursue_runtime.model import Automaton, Model, Position
from pursue_runtime.state import SystemState
from pursue_runtime.strategy import Command, Strategy
from pursue_runtime.ui.course import Step, course, first_commands, is_certain, next_command
from pursue_runtime.ui.mission_view import PossibleWord
from pursue_runtime.ui.statuses import Status
from pursue_runtime.ui.strategies import Strategies
from pursue_runtime.ui.waits import Turns
from pursue_runtime.vocabulary import deed, place

_NEXT = "next: "
_SHOWN = 2
"""So many reasons are said."""

_KINDS = ("agent", "human", "robot")
"""Those first that nobody controls."""


class Reason(NamedTuple):
    """`of` (an agent, an automaton or a variable) decides; `instead`: where else it might be, and what the robot would
    then be sent to do."""

    of: str
    instead: Tuple[Tuple[str, Command], ...]


def reasons(strategy: Strategy, state: SystemState, agent: str, event: str) -> List[Reason]:
    """The reasons for this command in the state in which it was decided, in the order of the entry's names."""
    found: Dict[str, List[Tuple[str, Command]]] = {}
    for entry, commands in strategy.entries(state):
        if not any((each.agent, each.event) == (agent, event) for each in commands):
            continue
        for name, value, others in strategy.beside(entry):
            own = [each for each in others if each.agent == agent]
            if name != agent and own and all(each.event != event for each in own):
                found.setdefault(name, []).append((value, own[0]))
    return [Reason(name, tuple(instead)) for name, instead in found.items()]


def reason_text(model: Model, statuses: Sequence[Status], state: SystemState, found: Sequence[Reason]) -> str:
    """Reasons in words, those first that nobody controls: `because thief is at c (if it were at d: go to a)`."""
    automata = {automaton.name: automaton for automaton in model.automata}
    words = {status.of: status for status in statuses}

    def rank(reason: Reason) -> int:
        return _KINDS.index(automata[reason.of].kind) if _acts(automata, reason.of) else len(_KINDS)

    order = sorted(found, key=rank)
    texts = [_text(model, automata, words, state, each) for each in order]
    parts = [text for text in texts if text][:_SHOWN]
    return f"because {', and because '.join(parts)}" if parts else ""


def _acts(automata: Mapping[str, Automaton], name: str) -> bool:
    return name in automata and automata[name].acts


def _text(
    model: Model, automata: Mapping[str, Automaton], words: Mapping[str, Status], state: SystemState, reason: Reason
) -> str:
    """One reason; "" where there are no words for what decides."""
    name = reason.of
    if not _acts(automata, name):
        status = words.get(name)
        text = status and status.text(state.locations, state.values)
        if status and status.inside and text and text.startswith(_NEXT):
            return f"{text[len(_NEXT):]} is next"  # whatever the rule is called
        return f"{status.label}: {text}" if status and text else ""
    automaton = automata[name]
    text = f"{model.shown(name)} is {place(model, automaton, state.locations[name])}"
    other, command = min(reason.instead, key=lambda each: is_under_way(each[0]))
    does = _does(model, automata, command)
    return f"{text} (if it were {place(model, automaton, other)}: {does})" if does else text


def _does(model: Model, automata: Mapping[str, Automaton], command: Command) -> Optional[str]:
    """What a command has its agent do."""
    edges = automata[command.agent].edges_from(command.origin)
    edge = next((edge for edge in edges if (edge.word, edge.target) == (command.event, command.target)), None)
    return None if edge is None else deed(model, automata[command.agent], edge).do


class Why:
    """Why each agent does what it does, from the states of a mission and the strategy of the plan in force."""

    def __init__(self, model: Model, statuses: Sequence[Status], strategies: Strategies) -> None:
        self._model, self._statuses, self._strategies = model, statuses, strategies
        self._last: Optional[SystemState] = None
        self._texts: Dict[str, Tuple[str, str]] = {}  # agent → where it has been sent, and why

    def on_state(self, state: SystemState) -> None:
        """A state came."""
        last, self._last = self._last, state
        self._texts = {name: each for name, each in self._texts.items() if state.locations.get(name) == each[0]}
        follows = last is not None and last.seq == state.seq - 1 and state.commanded
        if last is None or not follows or state.agent not in state.locations:
            return
        for strategy in self._strategies.get(last.plan, ()):
            if state.agent in strategy.agents:
                found = reasons(strategy, last, state.agent, state.event)
                text = reason_text(self._model, self._statuses, last, found)
                self._texts[state.agent] = state.locations[state.agent], text

    def of(self, agent: str) -> str:
        """Return why the agent does what it does, "" where that is not known."""
        return self._texts.get(agent, ("", ""))[1]


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
