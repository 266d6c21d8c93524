"""A strategy as plain data for the report's page: states, what is done and waited for in them, and where that leads."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Dict, List, Mapping, Tuple

from pursue_gen.explanation.network_words import Words, words_of, zone_texts
from pursue_gen.language.scenario import Scenario
from pursue_gen.partition import partition
from pursue_gen.partition.split import UI
from pursue_gen.solving.solution import Solution
from pursue_gen.synthesis.game import Game, State, compile_game, initial_state, is_goal, joint_moves
from pursue_gen.synthesis.strategy import DiscreteState, Zone
from pursue_gen.tga import names

Key = Tuple[Tuple[str, str, str, str], ...]


@dataclass(frozen=True)
class Step:
    """Something that may be done or happen: by which automaton, in words, when (numbers of zones), and where it leads.

    `when` is empty for what nobody of ours decides. `target` is the number of a state.
    """

    who: int
    words: str
    when: Tuple[int, ...]
    target: int


@dataclass(frozen=True)
class Situation:
    """A discrete state: `places` are locations' numbers, `values` those of the scenario's states (0 or 1).

    `wait`: zones in which nobody is told anything; `commands`: ours; `others`: what else may happen. `goal`: it is
    over, and well.
    """

    places: Tuple[int, ...]
    values: Tuple[int, ...]
    wait: Tuple[int, ...] = ()
    commands: Tuple[Step, ...] = ()
    others: Tuple[Step, ...] = ()
    goal: bool = False


@dataclass(frozen=True)
class Book:
    """All situations, the first one of the play first; zones as (words, exact text).

    `automata`: name, kind (see `_kind`), and for each of its places the words and the parts of `Words`.
    """

    automata: Tuple[Tuple[str, str, Tuple[Tuple[str, Tuple[str, ...]], ...]], ...]
    variables: Tuple[str, ...]
    controllers: Mapping[str, Tuple[str, ...]]
    zones: Tuple[Tuple[str, str], ...]
    situations: Tuple[Situation, ...]


def book_of(scenario: Scenario, won: Solution, reach_obj: str) -> Book:
    """The book of a solution; `reach_obj` as for `partition`, which tells who gives a command."""
    maker = _Maker(scenario, won)
    subs = partition(won.strategy, won.network, scenario.agents, reach_obj=reach_obj)
    owners: Dict[str, Tuple[str, ...]] = {}
    for sub in subs:
        for agent in sub.agents:
            told = "told by the user interface" if sub.controller == UI else sub.controller
            owners[agent] = (*owners.get(agent, ()), told)
    automata = tuple(
        (a.name, _kind(scenario, a.name), tuple(maker.place(a.name, place) for place in a.locations))
        for a in maker.game.automata
    )
    situations = maker.situations()
    variables = tuple(state.name for state in scenario.states)
    return Book(automata, variables, owners, tuple(maker.zones), situations)


def as_json(book: Book) -> Dict[str, Any]:
    """The book for the page's script: short keys, each text once."""
    texts: Dict[str, int] = {}

    def steps(some: Tuple[Step, ...]) -> List[List[Any]]:
        return [[s.who, texts.setdefault(s.words, len(texts)), s.target, list(s.when)] for s in some]

    situations = [
        [list(s.places), list(s.values), list(s.wait), steps(s.commands), steps(s.others), int(s.goal)]
        for s in book.situations
    ]
    return {
        "automata": [
            {"name": name, "shown": shown_name(name, kind), "kind": kind, "places": places}
            for name, kind, places in book.automata
        ],
        "variables": list(book.variables),
        "controllers": {name: list(owners) for name, owners in book.controllers.items()},
        "zones": [list(zone) for zone in book.zones],
        "texts": list(texts),
        "states": situations,
    }


class _Maker:
    """Numbers states and zones as they come."""

    def __init__(self, scenario: Scenario, won: Solution) -> None:
        self.game: Game = compile_game(won.network, won.objective, won.reaction)
        self.words: Words = words_of(scenario, won.network)
        self.zones: List[Tuple[str, str]] = []
        self._zone_numbers: Dict[Zone, int] = {}
        self._places = [{name: k for k, name in enumerate(a.locations)} for a in self.game.automata]
        self._blocks = {self._state(block.state): block for block in won.strategy.blocks}
        shown = [names.state_value(state.name) for state in scenario.states]
        self._shown = [self.game.variables.index(name) for name in shown if name in self.game.variables]

    def place(self, automaton: str, location: str) -> Tuple[str, Tuple[str, ...]]:
        """A place in words, and its parts where it is an agent's."""
        return self.words.place(automaton, location), self.words.parts.get(location, ())

    def situations(self) -> Tuple[Situation, ...]:
        """In the order in which plays meet them, from the start; then, if there are any, the rest."""
        numbers: Dict[State, int] = {initial_state(self.game): 0}
        found: List[Situation] = []
        waiting = [initial_state(self.game)]
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
            told = self.words.move(first.automaton, first.edge)
            commands.append(Step(who, told, self._numbered(command.zones), number(targets[key])))
        others = []
        for move in moves:
            known = move.target in self._blocks or is_goal(self.game, move.target)
            if not move.controllable and known:  # others cannot happen while the strategy is followed
                edge = self.game.origins[move.edges[0]]
                told = self.words.move(self.game.automata[move.owner].name, edge)
                others.append(Step(move.owner, told, (), number(move.target)))
        return Situation(
            state.locations, values, self._numbered(block.wait), tuple(commands), tuple(others), goal=False
        )

    def _numbered(self, zones: Tuple[Zone, ...]) -> Tuple[int, ...]:
        for zone in zones:
            if zone not in self._zone_numbers:
                self._zone_numbers[zone] = len(self.zones)
                self.zones.append((self.words.when(zone), zone_texts(zone)))
        return tuple(dict.fromkeys(self._zone_numbers[zone] for zone in zones))

    def _key(self, edges: Tuple[int, ...]) -> Key:
        game = self.game
        origins = [(game.automata[game.edges[k].automaton].name, game.origins[k]) for k in edges]
        return tuple((name, edge.source, edge.target, str(edge.sync)) for name, edge in origins)

    def _state(self, state: DiscreteState) -> State:
        locations = tuple(self._places[k][place] for k, (_, place) in enumerate(state.locations))
        return State(locations, tuple(value for _, value in state.values))


def size(book: Book) -> Tuple[int, int]:
    """How many situations say what to do, and how many commands there are."""
    told = [s for s in book.situations if s.commands or s.wait]
    return len(told), sum(len(s.commands) for s in told)


def shown_name(name: str, kind: str) -> str:
    """How an automaton is called before people."""
    return {"goal": "the goal", "deadline": "the objective"}.get(kind, name)


def _kind(scenario: Scenario, automaton: str) -> str:
    """robot, person, other (an agent that nobody controls), rule, goal, deadline or states."""
    for agent in scenario.agents:
        if agent.name == automaton:
            return "other" if not agent.controllable else "person" if agent.human else "robot"
    kinds = {names.REACH: "goal", names.OBJECTIVE: "deadline", names.STATES: "states"}
    return kinds.get(automaton, "rule")
