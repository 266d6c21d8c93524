"""A strategy as plain data for the report's page: states, what is done and waited for in them, and where that leads."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any, Collection, Dict, Iterable, Iterator, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.language import network_names as names
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.symbols import Role, Symbol, role_of
from pursue_gen.partition import partition
from pursue_gen.partition.split import UI
from pursue_gen.partition.strategy_data import zone_text
from pursue_gen.proof.relaxed_reachability import commanded
from pursue_gen.solving.solution import Solution
from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.synthesis.game import Game, State, initial_state, is_goal, joint_moves
from pursue_gen.synthesis.strategy import Block, DiscreteState, Place, Strategy, Zone
from pursue_gen.tga.network import Edge, Network, Objective
from pursue_gen.tga.part import part_of
from pursue_gen.vocabulary.words import Words, words_of

Key = Tuple[Tuple[str, str, str, str], ...]
Numbers = Tuple[Tuple[int, ...], Tuple[int, ...]]


@dataclass(frozen=True)
class Transition:
    """A command, or an uncontrollable move: its automaton's number, its text, the numbers of its zones, its target.

    `when` is empty for an uncontrollable move. `target` is the number of a situation.
    """

    who: int
    words: str
    when: Tuple[int, ...]
    target: int


@dataclass(frozen=True)
class Situation:
    """A discrete state: `places` are locations' numbers, `values` those of the scenario's states: 0, 1, 2 where
    it is not known yet, or UNKNOWN.

    `wait`: zones in which no command is due; `others`: the uncontrollable moves. `goal`: the goal is reached; `done`:
    so is what the part of a stage is played for.
    """

    places: Tuple[int, ...]
    values: Tuple[int, ...]
    wait: Tuple[int, ...] = ()
    commands: Tuple[Transition, ...] = ()
    others: Tuple[Transition, ...] = ()
    goal: bool = False
    done: bool = False


@dataclass(frozen=True)
class StagePart:
    """A part of a stage (counted from 0), or a share: the robots that play it, the words for what ends it ("" of a
    share: nothing does), its first situation."""

    stage: int
    who: Tuple[str, ...]
    until: str
    first: int


@dataclass(frozen=True)
class StrategyData:
    """All situations, the initial one first; zones as (words, exact text).

    `automata`: name, kind (see `_kind`), and for each of its places the words and the parts of `Words`. `left_out`: the
    automata that the strategy does not speak of, as they cannot matter. `parts`: of a strategy in stages or shares; the
    last place of each automaton then stands for all: the part does not speak of it. `ordered`: with orders of passage;
    a part then is what one agent does, step by step.
    """

    automata: Tuple[Tuple[str, str, Tuple[Tuple[str, Tuple[str, ...]], ...]], ...]
    variables: Tuple[str, ...]
    controllers: Mapping[str, Tuple[str, ...]]
    zones: Tuple[Tuple[str, str], ...]
    situations: Tuple[Situation, ...]
    left_out: Tuple[str, ...] = ()
    labels: Mapping[str, str] = field(default_factory=dict)
    parts: Tuple[StagePart, ...] = ()
    ordered: bool = False

    def is_free(self, automaton: int, place: int) -> bool:
        """True if a situation with this place does not speak of the automaton."""
        return bool(self.parts) and place == len(self.automata[automaton][2]) - 1


UNKNOWN = -1
"""The value of a state that a part does not speak of."""

_ANYWHERE: Tuple[str, Tuple[str, ...]] = ("anywhere", ())
"""The place of an automaton that a part does not name."""


def strategy_data_of(scenario: Scenario, won: Solution, reach_obj: str) -> StrategyData:
    """The data of a solution's strategy; `reach_obj` as for `partition`, which decides the controller of a command."""
    if won.strategy.in_parts:
        return _in_parts(scenario, won, reach_obj)
    builder = _Builder(_Frame(scenario, won.network, won.part), won)
    named = {automaton.name for automaton in won.part.automata}
    return builder.frame.data(scenario, won, reach_obj, named, builder.situations())


def _owners(scenario: Scenario, won: Solution, reach_obj: str) -> Dict[str, Tuple[str, ...]]:
    """The controllers that command each agent."""
    owners: Dict[str, Tuple[str, ...]] = {}
    for sub in partition(won.strategy, won.network, scenario.agents, reach_obj=reach_obj):
        for agent in sub.agents:
            owner = "instructed by the user interface" if sub.controller == UI else sub.controller
            owners[agent] = (*owners.get(agent, ()), owner)
    return owners


def _objectives(won: Solution) -> Iterator[Tuple[int, Place, Objective, bool]]:
    """The parts of the strategy: the number of each one's stage, its place, its objective, whether it is in the last
    stage. Shares are all in the first one."""
    watched = {watcher.objective for watcher in won.strategy.watchers}
    named = {name for block in won.strategy.blocks for name, _ in block.state.locations}
    for avoided in won.strategy.shares:
        own = [place for place in avoided if place[0] not in watched and place[0] in named]
        goal = [place for place in own if place in won.objective.goal]
        yield 0, avoided[0], Objective.of(goal, [place for place in own if place not in goal]), True
    for stage, milestones in enumerate(won.strategy.stages):
        for place in milestones:
            yield stage, place, replace(won.objective, goal=(place,)), stage == len(won.strategy.stages) - 1


def _in_parts(scenario: Scenario, won: Solution, reach_obj: str) -> StrategyData:
    """The situations of each part, one after the other; whom a part does not name may be anywhere."""
    strategy = won.strategy
    named = {name for block in strategy.blocks for name, _ in block.state.locations}
    values = {name for block in strategy.blocks for name, _ in block.state.values}
    frame = _Frame(scenario, won.network, part_of(won.network, named, values))
    situations: List[Situation] = []
    parts: List[StagePart] = []
    for k, agent in enumerate(strategy.commanded if strategy.passages else ()):
        blocks = tuple(strategy.blocks[n] for n in strategy.numbers_of(k, (agent, "")))
        parts.append(StagePart(0, (agent,), "", len(situations)))
        situations += _steps(frame, agent, blocks, len(situations))
    for number, (stage, place, wanted, is_last) in enumerate(_objectives(won)):
        blocks = tuple(strategy.blocks[n] for n in strategy.numbers_of(number if strategy.shares else stage, place))
        builder = _Builder(frame, replace(won, objective=wanted, strategy=Strategy(blocks)), len(situations), is_last)
        moving = {name for name, _ in commanded(blocks)}
        who = (a.name for a in builder.game.automata if a.name in moving and _kind(scenario, a.name) == "robot")
        until = "" if strategy.shares else _until(scenario, frame.words, place)
        parts.append(StagePart(stage, tuple(who), until, len(situations)))
        situations += builder.situations()
    named.update(name for name, _ in won.objective.bad if strategy.passages or strategy.tours)
    return frame.data(scenario, won, reach_obj, named, situations, parts)


def _until(scenario: Scenario, words: Words, place: Place) -> str:
    """The words for what ends a part of a stage."""
    name, value = place
    states: Dict[str, str] = {names.state_value(state.name): state.name for state in scenario.states}
    return f"{states.get(name) or shown_name(name, _kind(scenario, name))}: {words.place(name, value)}"


class _Frame:
    """What situations are written in: words, automata with their places, the scenario's states, the zones met."""

    def __init__(self, scenario: Scenario, network: Network, shown: Network) -> None:
        """`shown`: the part of the network that situations speak of."""
        self.words: Words = words_of(scenario, network)
        self.automata = {a.name: {place.name: k for k, place in enumerate(a.locations)} for a in shown.automata}
        values = [name for name, _ in shown.variables]
        self.states = [state.name for state in scenario.states if names.state_value(state.name) in values]
        self.who = {name: k for k, name in enumerate(self.automata)}
        self._zones: Dict[Zone, int] = {}

    def at(self, places: Iterable[Tuple[str, str]], values: Iterable[Tuple[str, int]] = ()) -> Numbers:
        """The numbers of places and values; of whom is not named nothing is known."""
        place, value = dict(places), dict(values)
        numbers = tuple(of.get(place.get(name, ""), len(of)) for name, of in self.automata.items())
        return numbers, tuple(value.get(names.state_value(name), UNKNOWN) for name in self.states)

    def zones(self, zones: Sequence[Zone]) -> Tuple[int, ...]:
        """The numbers of zones."""
        return tuple(dict.fromkeys(self._zones.setdefault(zone, len(self._zones)) for zone in zones))

    def data(
        self,
        scenario: Scenario,
        won: Solution,
        reach_obj: str,
        named: Collection[str],
        situations: Sequence[Situation],
        parts: Sequence[StagePart] = (),
    ) -> StrategyData:
        """The data with these situations; `named`: the automata that are not left out."""
        free = (_ANYWHERE,) if parts else ()
        automata = tuple(
            (name, _kind(scenario, name), (*((self.words.place(name, place), _parts(place)) for place in of), *free))
            for name, of in self.automata.items()
        )
        return StrategyData(
            automata,
            tuple(self.states),
            _owners(scenario, won, reach_obj),
            tuple((self.words.when(zone), zone_text(zone)) for zone in self._zones),
            tuple(situations),
            tuple(automaton.name for automaton in won.network.automata if automaton.name not in named),
            scenario.labels,
            tuple(parts),
            ordered=bool(won.strategy.passages),
        )


def _steps(frame: _Frame, agent: str, blocks: Sequence[Block], before: int) -> List[Situation]:
    """What one agent is commanded, step by step, in a strategy with orders of passage: a situation for each command,
    each of which leads to the next; `before`: so many situations are before the first one."""
    found: List[Situation] = []
    place = ""
    for block in blocks:
        for command in block.commands[:1]:
            edge = command.moves[0].edge
            when, target = frame.zones(command.zones), before + len(found) + 1
            step = Transition(frame.who[agent], frame.words.move(agent, edge), when, target)
            found.append(Situation(*frame.at(block.state.locations), frame.zones(block.wait), (step,)))
            place = edge.target
    return [*found, Situation(*frame.at([(agent, place)]), done=True)]


def as_json(data: StrategyData) -> Dict[str, Any]:
    """The data for the page's script: short keys, each text once."""
    texts: Dict[str, int] = {}

    def steps(some: Tuple[Transition, ...]) -> List[List[Any]]:
        return [[s.who, texts.setdefault(s.words, len(texts)), s.target, list(s.when)] for s in some]

    situations = [
        [list(s.places), list(s.values), list(s.wait), steps(s.commands), steps(s.others), int(s.goal), int(s.done)]
        for s in data.situations
    ]
    return {
        "ordered": data.ordered,
        "parts": [[part.stage, list(part.who), part.until, part.first] for part in data.parts],
        "automata": [
            {"name": name, "shown": data.labels.get(name) or shown_name(name, kind), "kind": kind, "places": places}
            for name, kind, places in data.automata
        ],
        "variables": list(data.variables),
        "controllers": {name: list(owners) for name, owners in data.controllers.items()},
        "zones": [list(zone) for zone in data.zones],
        "texts": list(texts),
        "states": situations,
    }


class _Builder:
    """Numbers situations in the order in which they are met: those of a strategy, or of a part that has its own.

    `before`: so many situations of other parts are before its own; `is_last`: the part leads to the goal.
    """

    def __init__(self, frame: _Frame, won: Solution, before: int = 0, is_last: Optional[bool] = None) -> None:
        self.frame, self._before, self._is_last = frame, before, is_last
        self.game: Game = compile_game(won.part, won.objective, won.reaction)
        self._places = [{name: k for k, name in enumerate(a.locations)} for a in self.game.automata]
        self._blocks = {self._state(block.state): block for block in won.strategy.blocks}

    def situations(self) -> Tuple[Situation, ...]:
        """In the order in which plays meet them, from the start; then, if there are any, the rest."""
        start = initial_state(self.game)
        start = next(iter(self._blocks), start) if start not in self._blocks else start
        numbers: Dict[State, int] = {start: 0}
        found: List[Situation] = []
        waiting = [start]
        rest = iter(self._blocks)
        while True:
            for state in waiting:  # grows meanwhile
                found.append(self._situation(state, numbers, waiting))
            left = next((state for state in rest if state not in numbers), None)
            if left is None:
                return tuple(found)
            numbers[left] = len(numbers)
            waiting = [left]

    def _situation(self, state: State, numbers: Dict[State, int], waiting: List[State]) -> Situation:
        game, frame = self.game, self.frame
        places = ((a.name, a.locations[place]) for a, place in zip(game.automata, state.locations))
        at = frame.at(places, zip(game.variables, state.values))
        block = self._blocks.get(state)
        if block is None:
            reached, last = is_goal(game, state), self._is_last
            return Situation(*at, goal=reached and last is not False, done=reached and last is not None)
        moves = list(joint_moves(game, state))
        targets = {self._key(move.edges): move.target for move in moves}

        def step(automaton: str, edge: Edge, zones: Sequence[Zone], target: State) -> Transition:
            if target not in numbers:
                numbers[target] = len(numbers)
                waiting.append(target)
            text, number = frame.words.move(automaton, edge), self._before + numbers[target]
            return Transition(frame.who[automaton], text, frame.zones(zones), number)

        commands = []
        for command in block.commands:
            first = command.moves[0]
            key = tuple((m.automaton, m.edge.source, m.edge.target, str(m.edge.sync)) for m in command.moves)
            commands.append(step(first.automaton, first.edge, command.zones, targets[key]))
        others = []
        for move in moves:
            known = move.target in self._blocks or is_goal(game, move.target)
            if not move.controllable and known:  # others cannot happen while the strategy is followed
                others.append(step(game.automata[move.owner].name, game.origins[move.edges[0]], (), move.target))
        return Situation(*at, frame.zones(block.wait), tuple(commands), tuple(others))

    def _key(self, edges: Tuple[int, ...]) -> Key:
        game = self.game
        origins = [(game.automata[game.edges[k].automaton].name, game.origins[k]) for k in edges]
        return tuple((name, edge.source, edge.target, str(edge.sync)) for name, edge in origins)

    def _state(self, state: DiscreteState) -> State:
        locations = tuple(self._places[k][place] for k, (_, place) in enumerate(state.locations))
        return State(locations, tuple(value for _, value in state.values))


def size(data: StrategyData) -> Tuple[int, int]:
    """How many situations the strategy covers, and how many commands it has."""
    covered = [s for s in data.situations if s.commands or s.wait]
    return len(covered), sum(len(s.commands) for s in covered)


def shown_name(name: str, kind: str) -> str:
    """The name of an automaton on the page; the second objective of a kind and the following have numbers."""
    if kind not in ("goal", "deadline"):
        return name
    what, *robots = _watched(name)
    (number,) = Symbol.of(what).parts
    word = "goal" if kind == "goal" else "objective"
    shown = f"the {word}" if number == "1" else f"{word} {number}"
    return f"{shown} for {' and '.join(robots)}" if robots else shown


def _parts(location: str) -> Tuple[str, ...]:
    """Where an agent is, for the page: (at, place), (way, from, to) or (doing, place, event); () of other locations."""
    symbol = Symbol.of(location)
    kind = {Role.AT: "at", Role.WAY: "way", Role.WORK: "doing"}.get(symbol.role)
    parts = symbol.parts if symbol.role is Role.WAY else symbol.parts[::-1]
    return (kind, *parts) if kind else ()


def _watched(automaton: str) -> Tuple[str, ...]:
    """The objective's automaton that it is, or that it is for some robots, and these."""
    symbol = Symbol.of(automaton)
    return symbol.parts if symbol.role is Role.WATCHER else (symbol,)


def _kind(scenario: Scenario, automaton: str) -> str:
    """robot, person, other (an agent that nobody controls), rule, goal, deadline or states."""
    for agent in scenario.agents:
        if agent.name == automaton:
            return "other" if not agent.controllable else "person" if agent.human else "robot"
    kinds = {Role.REACH: "goal", Role.SAFETY: "deadline", Role.STATES: "states"}
    return kinds.get(role_of(_watched(automaton)[0]), "rule")
