"""From a network and an objective to the tables of a game, and what of them a game does not support."""

from __future__ import annotations

from fractions import Fraction
from typing import Dict, Iterator, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.diagnostics import Diagnostic, error
from pursue_gen.outcomes import Invalid
from pursue_gen.synthesis.game import NO_CHANNEL, Bound, Clause, Game, GameAutomaton, GameEdge
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Network, Objective
from pursue_gen.tga.scale import common_denominator
from pursue_gen.zones.dbm import Dbm, constant, raw


def compile_game(
    network: Network, objective: Objective, reaction: Fraction = Fraction(0), part: Optional[Network] = None
) -> Game:
    """The tables of a network and an objective, with a reaction delay in time units.

    `part`: the part of the network that can matter, if that is not all of it.

    Raises PursueError with everything that the game does not support: clock guards on receiving edges, invariants that
    are not upper bounds with <=, unknown names, a start that no clock values satisfy.
    """
    problems: List[Diagnostic] = []
    if reaction < 0:
        problems.append(error("SYN001", f"the reaction delay is {reaction}, expected 0 or more time units"))
    scale = common_denominator([reaction, *network.times])
    tables = _Tables(network, scale, problems)
    goal, bad = tables.positions(objective.goal), tables.positions(objective.bad)
    if objective.reaches and not objective.goal:
        problems.append(error("SYN002", "the objective names no location to reach"))
    if objective.avoids and not objective.bad:
        problems.append(error("SYN003", "the objective names no location to avoid"))
    automata: List[GameAutomaton] = []
    edges: List[GameEdge] = []
    for number, automaton in enumerate(network.automata):
        first = len(edges)
        edges += [tables.edge(number, automaton, edge) for edge in automaton.edges]
        automata.append(tables.automaton(automaton, range(first, len(edges))))
    start = tables.start(network)
    if problems:
        raise Invalid(problems)
    return Game(
        kind=objective.kind,
        goal=goal if objective.reaches else (),
        bad=bad if objective.avoids else (),
        scale=tables.scale,
        delta=int(reaction * tables.scale),
        clocks=network.clocks,
        variables=tuple(name for name, _ in network.variables),
        initial_values=tuple(value for _, value in network.variables),
        channels=network.channels,
        automata=tuple(automata),
        edges=tuple(edges),
        origins=tuple(edge for automaton in network.automata for edge in automaton.edges),
        start=start,
        unseen=() if part is None else _unseen(network, part),
        unseen_clocks=() if part is None else tuple(_others(network.clocks, part.clocks, 1)),
    )


def _unseen(network: Network, part: Network) -> Tuple[int, ...]:
    """The indices in a discrete state of what the part does not have."""
    automata, some = [a.name for a in network.automata], [a.name for a in part.automata]
    variables, others = [name for name, _ in network.variables], [name for name, _ in part.variables]
    return (*_others(automata, some), *_others(variables, others, len(automata)))


def _others(names: Sequence[str], some: Sequence[str], first: int = 0) -> Iterator[int]:
    return (k for k, name in enumerate(names, first) if name not in some)


class _Tables:
    """Names to indices, with the problems met on the way; an unknown name becomes index 0 and a problem."""

    def __init__(self, network: Network, scale: int, problems: List[Diagnostic]) -> None:
        self.scale = scale
        self._problems = problems
        self._clocks = {name: k + 1 for k, name in enumerate(network.clocks)}
        self._variables = {name: k for k, (name, _) in enumerate(network.variables)}
        self._channels = {name: k for k, name in enumerate(network.channels)}
        self._automata = {automaton.name: k for k, automaton in enumerate(network.automata)}
        self._locations = [_numbers(automaton) for automaton in network.automata]

    def _index(self, names: Mapping[str, int], kind: str, name: str) -> int:
        if name not in names:
            known = ", ".join(names) or "none"
            self._problems.append(error("SYN004", f"unknown {kind} {name!r}; the network has: {known}"))
        return names.get(name, 0)

    def positions(self, places: Sequence[Tuple[str, str]]) -> Tuple[Tuple[int, int], ...]:
        """Pairs (automaton, location) by their names."""
        found: List[Tuple[int, int]] = []
        for name, location in places:
            automaton = self._index(self._automata, "automaton", name)
            if self._locations:
                found.append((automaton, self._index(self._locations[automaton], f"location of {name}", location)))
        return tuple(found)

    def automaton(self, automaton: Automaton, edges: Sequence[int]) -> GameAutomaton:
        """The table of one automaton whose edges have these indices."""
        number = self._automata[automaton.name]
        invariants: List[Tuple[Tuple[int, int], ...]] = []
        for location in automaton.locations:
            for bound in location.invariant:
                if bound.op != "<=":
                    text = f"{bound.clock} {bound.op} {bound.bound}"
                    place = f"{automaton.name}.{location.name}"
                    hint = "write the invariant as an upper bound, clock <= constant"
                    self._problems.append(error("SYN005", f"invariant {text} of {place} is not supported", hint=hint))
            bounds = [self._bounds(bound)[0] for bound in location.invariant]
            invariants.append(tuple((i, bound) for i, _, bound in bounds))
        return GameAutomaton(
            name=automaton.name,
            locations=tuple(location.name for location in automaton.locations),
            initial=self._place(number, automaton.name, automaton.initial),
            home=self._place(number, automaton.name, automaton.home or automaton.initial),
            invariants=tuple(invariants),
            edges=tuple(edges),
        )

    def start(self, network: Network) -> Tuple[Bound, ...]:
        """The bounds on the clocks at the start."""
        bounds = tuple(
            (
                0 if c.left is None else self._index(self._clocks, "clock", c.left),
                0 if c.right is None else self._index(self._clocks, "clock", c.right),
                raw(int(c.bound * self.scale), c.strict),
            )
            for c in network.start
        )
        if Dbm.of(len(network.clocks) + 1, (bound for bound in bounds if bound[0] != bound[1])) is None:
            hint = "give bounds that the clocks can have together, all of them 0 or more"
            self._problems.append(error("SYN008", "no values of the clocks satisfy the bounds at the start", hint=hint))
        return bounds

    def _place(self, number: int, automaton: str, location: str) -> int:
        return self._index(self._locations[number], f"location of {automaton}", location)

    def edge(self, number: int, automaton: Automaton, edge: Edge) -> GameEdge:
        """The table of one edge."""
        locations = self._locations[number]
        receives = edge.sync is not None and not edge.sync.sends
        if receives and edge.guard.clocks:
            place = f"{automaton.name}: {edge.source} -> {edge.target}"
            hint = "put the clock guard on the sending edge"
            self._problems.append(error("SYN006", f"a receiving edge has a clock guard ({place})", hint=hint))
        bounds = tuple(bound for clock in edge.guard.clocks for bound in self._bounds(clock))
        return GameEdge(
            automaton=number,
            source=self._index(locations, f"location of {automaton.name}", edge.source),
            target=self._index(locations, f"location of {automaton.name}", edge.target),
            bounds=bounds,
            clauses=self._clauses(edge.guard),
            channel=NO_CHANNEL if edge.sync is None else self._index(self._channels, "channel", edge.sync.channel),
            sends=not receives,
            assignments=tuple((self._index(self._variables, "variable", name), value) for name, value in edge.assign),
            resets=tuple(self._index(self._clocks, "clock", name) for name in edge.resets),
            controllable=edge.controllable,
            duration=max((-constant(bound) for i, _, bound in bounds if i == 0), default=0),
            heard=edge.sync is not None and edge.sync.heard,
        )

    def _clauses(self, guard: Guard) -> Tuple[Clause, ...]:
        return tuple(
            tuple((self._index(self._variables, "variable", test.variable), test.value) for test in clause)
            for clause in guard.integers
        )

    def _bounds(self, bound: ClockBound) -> Tuple[Bound, ...]:
        clock, scaled = self._index(self._clocks, "clock", bound.clock), int(bound.bound * self.scale)
        above, below = (clock, 0), (0, clock)
        table: Dict[str, Tuple[Bound, ...]] = {
            "<": ((*above, raw(scaled, True)),),
            "<=": ((*above, raw(scaled, False)),),
            ">": ((*below, raw(-scaled, True)),),
            ">=": ((*below, raw(-scaled, False)),),
            "==": ((*above, raw(scaled, False)), (*below, raw(-scaled, False))),
        }
        if bound.op not in table:
            self._problems.append(
                error("SYN007", f"unknown comparison {bound.op!r}, expected one of {' '.join(table)}")
            )
        return table.get(bound.op, table["<="])


def _numbers(automaton: Automaton) -> Dict[str, int]:
    return {location.name: k for k, location in enumerate(automaton.locations)}
