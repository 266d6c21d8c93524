"""What a strategy does in a state, and when its next command is due.

Clocks, bounds and delays are in time units, stamps in seconds of ROS time.
"""

from __future__ import annotations

from typing import (
    Any,
    Dict,
    FrozenSet,
    Generic,
    Iterable,
    Iterator,
    List,
    Mapping,
    NamedTuple,
    Optional,
    Sequence,
    Tuple,
    TypeVar,
)

from pursue_runtime.bounded import BadText, read_json
from pursue_runtime.data import DataError, check_format, reading
from pursue_runtime.locations import automaton_clock
from pursue_runtime.numbers import exact
from pursue_runtime.state import RUNNING, SystemState
from pursue_runtime.zones import EPSILON, INFINITY, Zone, due, parse_zone

OBJECTIVES = ("reachObj", "obj")
"""The automata of objectives where a strategy does not name them."""

Payload = TypeVar("Payload")


Entry = Tuple[Tuple[str, ...], Tuple[str, ...]]
"""The state of an entry: the automata and variables that it names, and the location or value of each."""


class StateTable(Generic[Payload]):
    """Payloads by discrete state. An entry may leave out automata and variables: it then holds whatever they are.

    Entries may name different sets, and several may apply in one state: each then speaks of what matters to a part of
    the strategy. `names`: the automata and variables that any entry names. `left_out_clocks` matter to none of them.
    """

    def __init__(
        self, entries: Iterable[Tuple[Mapping[str, object], Payload]], left_out_clocks: Iterable[str] = ()
    ) -> None:
        self._left_out_clocks = frozenset(left_out_clocks)
        self._tables: Dict[Tuple[str, ...], Dict[Tuple[str, ...], List[Payload]]] = {}
        for state, payload in entries:
            names = tuple(sorted(state))
            table = self._tables.setdefault(names, {})
            table.setdefault(tuple(str(state[name]) for name in names), []).append(payload)
        self.names: FrozenSet[str] = frozenset(name for names in self._tables for name in names)
        # With many sets of names, what all of them name tells the few that are worth a look in a state.
        several = len(self._tables) > 1
        self._common = tuple(sorted(frozenset.intersection(*map(frozenset, self._tables)))) if several else ()
        self._candidates: Dict[Tuple[str, ...], Tuple[Tuple[str, ...], ...]] = {}
        for names, table in self._tables.items():
            places = [names.index(name) for name in self._common]
            for parts in {tuple(parts[place] for place in places) for parts in table}:
                self._candidates[parts] = (*self._candidates.get(parts, ()), names)

    def find(self, state: SystemState) -> List[Payload]:
        """What was entered for this state, in order of entry."""
        return [payload for entry in self.applying(state) for payload in self.entered(entry)]

    def entered(self, entry: Entry) -> List[Payload]:
        """What was entered for a state that `applying` returns, in order of entry."""
        return self._tables[entry[0]][entry[1]]

    def applying(self, state: SystemState) -> List[Entry]:
        """The states of the entries that apply in this state, each once."""
        candidates = self._candidates.get(_parts(state, self._common), ())
        looked_up = ((names, _parts(state, names)) for names in candidates)
        return [(names, parts) for names, parts in looked_up if parts in self._tables[names]]

    def all_entries(self) -> Iterator[Tuple[Entry, List[Payload]]]:
        """All entries, with what was entered for each."""
        for names, table in self._tables.items():
            yield from (((names, parts), payloads) for parts, payloads in table.items())

    def beside(self, entry: Entry) -> Iterator[Tuple[str, str, List[Payload]]]:
        """The entries that differ from this one in the location or value of one name alone: that name, where it is
        there, and what was entered for it."""
        names, parts = entry
        for others, payloads in self._tables[names].items():
            differing = [place for place, value in enumerate(others) if value != parts[place]]
            if len(differing) == 1:
                yield names[differing[0]], others[differing[0]], payloads

    def names_in(self, state: SystemState) -> FrozenSet[str]:
        """The automata and variables that matter in this state: those that the entries name which apply."""
        return frozenset(name for names, _ in self.applying(state) for name in names)

    def standing(self, before: SystemState, state: SystemState) -> List[Entry]:
        """Those of the entries that apply in both of two states in a row for which nothing has changed in between.

        What they name is as it was, and no clock was reset but those of automata that they do not name, and those that
        the strategy leaves out.
        """
        known = self.applying(before)
        both = [entry for entry in self.applying(state) if entry in known]
        aged = before.clocks_at(state.stamp)
        reset = {clock for clock, value in state.clocks.items() if abs(value - aged.get(clock, INFINITY)) >= EPSILON}
        reset -= self._left_out_clocks
        owners = {automaton_clock(name): name for name in state.locations}
        return [entry for entry in both if not any(c not in owners or owners[c] in entry[0] for c in reset)]

    def __len__(self) -> int:
        return sum(len(table) for table in self._tables.values())


def _parts(state: SystemState, names: Iterable[str]) -> Tuple[str, ...]:
    """The location or value of each of these automata and variables."""
    locations, values = state.locations, state.values
    return tuple([locations[name] if name in locations else str(values.get(name, "")) for name in names])


class Command(NamedTuple):
    """In any of the zones `when`, the agent does it: it goes from `origin` to `target`."""

    event: str
    agent: str
    origin: str
    target: str
    when: Tuple[Zone, ...]


class Covered(NamedTuple):
    """What the strategy has for a state: the zones in which it waits or commands, and those of each command, by agent
    and event."""

    zones: Tuple[Zone, ...]
    commands: Mapping[Tuple[str, str], Tuple[Zone, ...]]


class Cover(StateTable[Covered]):
    """For each state the zones in which the strategy knows what to do, and its commands, from cover.yaml.

    `stages`: for each stage of the strategy its milestones, locations of automata or values of variables; the stage
    ends when all are reached. Until then each part of the stage must know what to do. `shares`: for each share the
    places of automata that it avoids; each must know what to do all the time. `agents`: with orders of passage all who
    are commanded; so must each of them. Raises KeyError, TypeError or ValueError.
    """

    def __init__(self, data: Mapping[str, Any]) -> None:
        super().__init__(((entry["state"], _covered(entry)) for entry in data["cover"]), _left_out_clocks(data))
        self._stages = [[(str(name), str(place)) for name, place in stage] for stage in data.get("stages", ())]
        self.in_order = frozenset(map(str, data.get("agents", ())))
        """Who passes places in an order that holds however late each of them is; nobody without such orders."""
        self._always = [*(str(share[0][0]) for share in data.get("shares", ())), *self.in_order]

    def zones(self, state: SystemState) -> List[List[Zone]]:
        """The zones of each entry that applies in this state; () where a part of the stage, or a share, has no entry
        for it."""
        applying = self.applying(state)
        if any(all(name not in names for names, _ in applying) for name in self._awaited(state)):
            return []
        return [[zone for covered in self.entered(entry) for zone in covered.zones] for entry in applying]

    def commands(self, state: SystemState, agent: str, event: str) -> List[Zone]:
        """The zones in which the strategy has the agent do the event in this discrete state; none: it never does."""
        found = (covered.commands.get((agent, event), ()) for covered in self.find(state))
        return [zone for zones in found for zone in zones]

    def holds_command(self, entry: Entry, agent: str, event: str) -> bool:
        """Return True if the entry has the agent do the event."""
        return any((agent, event) in covered.commands for covered in self.entered(entry))

    def _awaited(self, state: SystemState) -> List[str]:
        """The automata and variables that are not at their milestones of the present stage, or one of each share, or
        the agents with orders of passage."""
        for stage in self._stages:
            awaited = [name for name, wanted in stage if _parts(state, (name,)) != (wanted,)]
            if awaited:
                return awaited
        return self._always


def _covered(entry: Mapping[str, Any]) -> Covered:
    if "zones" in entry:
        raise ValueError("zones, as an older pursue-gen wrote them: generate the workspace or the mission again")
    commands: Dict[Tuple[str, str], Tuple[Zone, ...]] = {}
    for command in entry.get("commands", ()):
        what = str(command["agent"]), str(command["do"])
        commands[what] = (*commands.get(what, ()), *map(parse_zone, command["when"]))
    waits = tuple(map(parse_zone, entry.get("wait", ())))
    return Covered((*waits, *(zone for zones in commands.values() for zone in zones)), commands)


def _left_out_clocks(data: Mapping[str, Any]) -> List[str]:
    return list(map(str, data.get("left_out_clocks", ())))


def read_cover(data: Mapping[str, Any]) -> Cover:
    """What cover.yaml says. Raises DataError."""
    with reading("cover.yaml"):
        return Cover(data)


class Strategy:
    """One controller's part of the strategy, from strategy.yaml."""

    def __init__(self, data: Mapping[str, Any]) -> None:
        with reading("strategy.yaml"):
            self.agents: List[str] = list(data["commands_agents"])
            self.objectives = frozenset(map(str, data.get("objectives", OBJECTIVES)))
            """Those of its agents that are no agents: the automata of objectives."""
            self.reaction = float(exact(data["reaction"]))
            entries = [(entry["state"], tuple(map(_command, entry["commands"]))) for entry in data["strategy"]]
            self._table = StateTable(entries, _left_out_clocks(data))
            # What it reads of a state: automata and variables, and clocks.
            self.names = self._table.names
            commands = [command for _, part in entries for command in part]
            self.targets = {(command.agent, command.target) for command in commands}
            """Where its commands lead, each location behind its agent."""
            zones = (zone for command in commands for zone in command.when)
            self.clocks = {clock for zone in zones for bound in zone for clock in (bound.left, bound.right) if clock}

    def commands(self, state: SystemState) -> List[Command]:
        """The commands of this controller in this discrete state."""
        return [command for commands in self._table.find(state) for command in commands]

    def entries(self, state: SystemState) -> List[Tuple[Entry, List[Command]]]:
        """The entries that apply in this discrete state, each with its commands."""
        return [(entry, _joined(self._table.entered(entry))) for entry in self._table.applying(state)]

    def all_entries(self) -> Iterator[Tuple[Entry, List[Command]]]:
        """All entries, each with its commands."""
        return ((entry, _joined(payloads)) for entry, payloads in self._table.all_entries())

    def beside(self, entry: Entry) -> Iterator[Tuple[str, str, List[Command]]]:
        """The entries that differ from this one in the location or value of one name alone: that name, where it is
        there, and their commands."""
        for name, value, payloads in self._table.beside(entry):
            yield name, value, _joined(payloads)

    def next_command(self, state: SystemState, now: float) -> Optional[Tuple[float, Command]]:
        """The first command that is due from `now` (seconds) on, and its moment; None: nothing until the next state."""
        return _first(self._due(self.commands(state), state, now))

    def since(
        self, known: Mapping[Entry, SystemState], before: Optional[SystemState], state: SystemState
    ) -> Dict[Entry, SystemState]:
        """For each entry that applies in a state, the state in which was decided what stands in it.

        `known`: the same for the state before. What was decided stands while the mission runs by the same plan, and an
        event has changed nothing that matters to the entry. An entry that begins to apply is new.
        """
        follows = (state.seq - 1, state.plan, RUNNING, RUNNING)
        standing: List[Entry] = []
        if before is not None and state.event and (before.seq, before.plan, before.status, state.status) == follows:
            standing = self._table.standing(before, state)
        return {entry: known.get(entry, state) if entry in standing else state for entry in self._table.applying(state)}

    def decided(self, since: Mapping[Entry, SystemState], now: float) -> Optional[Tuple[float, Command]]:
        """The first command that is due from where it is decided on (see `since`), and its moment, which may be past.

        It stands until the reaction is over, also where time has left its zone before the state came here: the proof
        takes it for decided. A controller that is later than that takes the first one from `now` on.
        """
        return _first([moment for entry, state in since.items() for moment in self._decided(entry, state, now)])

    def _decided(self, entry: Entry, state: SystemState, now: float) -> List[Tuple[float, Command]]:
        commands = [command for commands in self._table.entered(entry) for command in commands]
        first = _first(self._due(commands, state, state.stamp))
        if first is not None and now > first[0] + self.lateness(state) + EPSILON:
            first = _first(self._due(commands, state, now))
        return [] if first is None else [first]

    def _due(self, commands: Iterable[Command], state: SystemState, now: float) -> List[Tuple[float, Command]]:
        clocks = state.clocks_at(now)
        margin = self.reaction / 4 if self.reaction else 0.02
        moments = [(due(command.when, clocks, margin), command) for command in commands]
        return [(now + delay * state.unit, command) for delay, command in moments if delay is not None]

    def lateness(self, state: SystemState) -> float:
        """Seconds by which a command may be sent after its moment: the reaction that the proof allows for."""
        return max(self.reaction, 0.02) * state.unit

    def __len__(self) -> int:
        return len(self._table)


def read_strategies(data: Mapping[str, Any]) -> List[Strategy]:
    """The strategies of all controllers, as strategies.yaml has them. Raises DataError."""
    controllers = data.get("strategies")
    if not isinstance(controllers, dict):
        raise DataError("strategies.yaml: expected strategies: and a strategy for each controller")
    return [Strategy(part) for part in controllers.values()]


def _joined(payloads: Iterable[Tuple[Command, ...]]) -> List[Command]:
    return [command for commands in payloads for command in commands]


def _first(moments: Sequence[Tuple[float, Command]]) -> Optional[Tuple[float, Command]]:
    return min(moments, key=lambda moment: moment[0], default=None)


class Plans:
    """The strategies of one node by the number of their plan: 0 is the workspace's own, later ones were made during the
    mission. Each state says which plan is in force, so that all nodes switch plans with the same state."""

    def __init__(self, own: Strategy) -> None:
        self._strategies = {0: own}
        self._in_force = 0

    def add(self, number: int, strategy: Strategy) -> None:
        """Keeps a plan for when it is in force, and forgets those that never will be again.

        Not every plan comes into force: the one that is may be older than others.
        """
        self._strategies = {known: old for known, old in self._strategies.items() if known >= self._in_force}
        self._strategies[number] = strategy

    def strategy_for(self, state: SystemState) -> Optional[Strategy]:
        """The strategy that is in force; None where its plan has not come here yet."""
        self._in_force = state.plan
        return self._strategies.get(state.plan)


def _command(data: Mapping[str, Any]) -> Command:
    zones = tuple(parse_zone(zone) for zone in data["when"])
    return Command(str(data["do"]), str(data["agent"]), str(data["from"]), str(data["to"]), zones)


def parse_plan(text: str) -> Dict[str, Any]:
    """The data of a plan on pursue/plan. Raises DataError."""
    try:
        plan = read_json(text)
    except BadText as problem:
        raise DataError(f"not a plan: {problem}") from problem
    data = check_format(plan, "the new plan")
    if not isinstance(data.get("plan"), int):
        raise DataError("not a plan: it has no number")
    return data
