"""A strategy as plain data for the report's page: states, what is done and waited for in them, and where that leads."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple

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
from pursue_gen.tga.network import Objective
from pursue_gen.vocabulary.words import Words, words_of

Key = Tuple[Tuple[str, str, str, str], ...]


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
    builder = _Builder(scenario, won)
    owners = _owners(scenario, won, reach_obj)
    automata = tuple(
        (a.name, _kind(scenario, a.name), tuple(builder.place(a.name, place) for place in a.locations))
        for a in builder.game.automata
    )
    situations = builder.situations()
    left_out = tuple(a.name for a in won.network.automata if a.name not in {a.name for a in builder.game.automata})
    shown = tuple(builder.shown)
    return StrategyData(automata, shown, owners, tuple(builder.zones), situations, left_out, scenario.labels)


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
        own = tuple(place for place in avoided if place[0] not in watched and place[0] in named)
        yield 0, avoided[0], replace(won.objective, bad=own), True
    for stage, milestones in enumerate(won.strategy.stages):
        for place in milestones:
            yield stage, place, replace(won.objective, goal=(place,)), stage == len(won.strategy.stages) - 1


def _in_parts(scenario: Scenario, won: Solution, reach_obj: str) -> StrategyData:
    """The situations of each part, one after the other; whom a part does not name may be anywhere."""
    named = {name for block in won.strategy.blocks for name, _ in block.state.locations}
    every = [automaton.name for automaton in won.network.automata if automaton.name in named]
    words = _Builder(scenario, replace(won, strategy=Strategy(())))
    automata = tuple(
        (a.name, _kind(scenario, a.name), (*(words.place(a.name, place) for place in a.locations), _ANYWHERE))
        for a in words.game.automata
        if a.name in named
    )
    values = {name for block in won.strategy.blocks for name, _ in block.state.values}
    shown = [state.name for state in scenario.states if names.state_value(state.name) in values]
    free = Situation(tuple(len(places) - 1 for _, _, places in automata), (UNKNOWN,) * len(shown))
    zones: List[Tuple[str, str]] = []
    situations: List[Situation] = []
    parts: List[StagePart] = []
    for k, agent in enumerate(won.strategy.commanded if won.strategy.passages else ()):
        blocks = tuple(won.strategy.blocks[n] for n in won.strategy.numbers_of(k, (agent, "")))
        parts.append(StagePart(0, (agent,), "", len(situations)))
        situations += _Steps(words, every, automata, free).of(agent, blocks, len(situations))
    zones += words.zones
    for number, (stage, place, wanted, is_last) in enumerate(_objectives(won)):
        key = number if won.strategy.shares else stage
        blocks = tuple(won.strategy.blocks[n] for n in won.strategy.numbers_of(key, place))
        own = replace(won, objective=wanted, strategy=Strategy(blocks))
        builder = _Builder(scenario, replace(own, network=own.part), words.words)
        at = [every.index(automaton.name) for automaton in builder.game.automata]
        which = [shown.index(name) for name in builder.shown]
        moving = {name for name, _ in commanded(blocks)}
        who = tuple(name for name, kind, _ in (automata[k] for k in at) if kind == "robot" and name in moving)
        until = "" if won.strategy.shares else _until(scenario, words.words, place)
        parts.append(StagePart(stage, who, until, len(situations)))
        moved = _Moved(free, at, which, len(zones), len(situations), is_last)
        situations += [moved.situation(some) for some in builder.situations()]
        zones += builder.zones
    named.update(name for name, _ in won.objective.bad if won.strategy.passages or won.strategy.tours)
    left_out = tuple(automaton.name for automaton in won.network.automata if automaton.name not in named)
    owners = _owners(scenario, won, reach_obj)
    found = tuple(zones), tuple(situations), left_out, scenario.labels, tuple(parts)
    return StrategyData(automata, tuple(shown), owners, *found, ordered=bool(won.strategy.passages))


def _until(scenario: Scenario, words: Words, place: Place) -> str:
    """The words for what ends a part of a stage."""
    name, value = place
    states: Dict[str, str] = {names.state_value(state.name): state.name for state in scenario.states}
    return f"{states.get(name) or shown_name(name, _kind(scenario, name))}: {words.place(name, value)}"


@dataclass(frozen=True)
class _Moved:
    """Situations of a part among those of all: numbers of zones and situations count on, automata have others."""

    free: Situation
    at: Sequence[int]
    which: Sequence[int]
    zones: int
    before: int
    is_last: bool

    def situation(self, some: Situation) -> Situation:
        """The situation; of whom the part does not name nothing is known."""
        places, values = list(self.free.places), list(self.free.values)
        for k, place in zip(self.at, some.places):
            places[k] = place
        for k, value in zip(self.which, some.values):
            values[k] = value
        wait = tuple(n + self.zones for n in some.wait)
        ours, others = self._steps(some.commands), self._steps(some.others)
        return Situation(tuple(places), tuple(values), wait, ours, others, some.goal and self.is_last, some.goal)

    def _steps(self, steps: Sequence[Transition]) -> Tuple[Transition, ...]:
        return tuple(
            Transition(self.at[s.who], s.words, tuple(n + self.zones for n in s.when), s.target + self.before)
            for s in steps
        )


@dataclass(frozen=True)
class _Steps:
    """What one agent is commanded, step by step, in a strategy with orders of passage."""

    words: _Builder
    every: Sequence[str]
    automata: Sequence[Tuple[str, str, Tuple[Tuple[str, Tuple[str, ...]], ...]]]
    free: Situation

    def of(self, agent: str, blocks: Sequence[Block], before: int) -> List[Situation]:
        """A situation for each command, in their order, each of which leads to the next; `before`: so many are before
        the first one."""
        commanding = [block for block in blocks if block.commands]
        found: List[Situation] = []
        for block in commanding:
            command = block.commands[0]
            text = self.words.words.move(agent, command.moves[0].edge)
            when, target = self.words.numbered(command.zones), before + len(found) + 1
            step = Transition(self.every.index(agent), text, when, target)
            wait = self.words.numbered(block.wait)
            found.append(Situation(self._places(block.state), self.free.values, wait, (step,)))
        last = commanding[-1].commands[0].moves[0]
        end = DiscreteState(((agent, last.edge.target),), ())
        return [*found, Situation(self._places(end), self.free.values, done=True)]

    def _places(self, state: DiscreteState) -> Tuple[int, ...]:
        places = list(self.free.places)
        for name, location in state.locations:
            places[self.every.index(name)] = self.words.number(name, location)
        return tuple(places)


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
    """Numbers situations and zones in the order in which they are met."""

    def __init__(self, scenario: Scenario, won: Solution, words: Optional[Words] = None) -> None:
        self.game: Game = compile_game(won.part, won.objective, won.reaction)
        self.words: Words = words or words_of(scenario, won.network)
        self.zones: List[Tuple[str, str]] = []
        self._zone_numbers: Dict[Zone, int] = {}
        self._places = [{name: k for k, name in enumerate(a.locations)} for a in self.game.automata]
        self._blocks = {self._state(block.state): block for block in won.strategy.blocks}
        variables = self.game.variables
        self.shown = [state.name for state in scenario.states if names.state_value(state.name) in variables]
        self._shown = [variables.index(names.state_value(name)) for name in self.shown]

    def place(self, automaton: str, location: str) -> Tuple[str, Tuple[str, ...]]:
        """A place in words, and its parts where it is an agent's."""
        return self.words.place(automaton, location), _parts(location)

    def number(self, automaton: str, location: str) -> int:
        """The number of a location."""
        k = next(k for k, each in enumerate(self.game.automata) if each.name == automaton)
        return self._places[k][location]

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
        values = tuple(state.values[k] for k in self._shown)
        block = self._blocks.get(state)
        if block is None:
            return Situation(state.locations, values, goal=is_goal(self.game, state))
        moves = list(joint_moves(self.game, state))
        targets = {self._key(move.edges): move.target for move in moves}

        def number(target: State) -> int:
            if target not in numbers:
                numbers[target] = len(numbers)
                waiting.append(target)
            return numbers[target]

        commands = []
        for command in block.commands:
            first = command.moves[0]
            key = tuple((m.automaton, m.edge.source, m.edge.target, str(m.edge.sync)) for m in command.moves)
            who = next(k for k, a in enumerate(self.game.automata) if a.name == first.automaton)
            text = self.words.move(first.automaton, first.edge)
            commands.append(Transition(who, text, self.numbered(command.zones), number(targets[key])))
        others = []
        for move in moves:
            known = move.target in self._blocks or is_goal(self.game, move.target)
            if not move.controllable and known:  # others cannot happen while the strategy is followed
                edge = self.game.origins[move.edges[0]]
                text = self.words.move(self.game.automata[move.owner].name, edge)
                others.append(Transition(move.owner, text, (), number(move.target)))
        return Situation(state.locations, values, self.numbered(block.wait), tuple(commands), tuple(others), goal=False)

    def numbered(self, zones: Tuple[Zone, ...]) -> Tuple[int, ...]:
        for zone in zones:
            if zone not in self._zone_numbers:
                self._zone_numbers[zone] = len(self.zones)
                self.zones.append((self.words.when(zone), zone_text(zone)))
        return tuple(dict.fromkeys(self._zone_numbers[zone] for zone in zones))

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
