"""The lines of a plan in the words of a network: locations, zones and transitions, and what is wrong with them."""

from __future__ import annotations

import re
from typing import Dict, List, NoReturn, Sequence, Set, Tuple

from pursue_gen.diagnostics import Span, error
from pursue_gen.outcomes import Invalid
from pursue_gen.synthesis.plan_text import (
    ALWAYS,
    assign_meaning,
    assign_text,
    guard_meaning,
    guard_text,
    read_constraint,
    sync_text,
)
from pursue_gen.synthesis.strategy import Constraint, DiscreteState, Move, Zone
from pursue_gen.tga.network import Edge, Network

_EDGE = re.compile(r"([^\s.]+)\.(\S+?)->([^\s.]+)\.(\S+)\s*\{\s*([^,{}]*),\s*([^,{}\s]*)\s*,([^{}]*)\}")

OTHER_NETWORK = "read the plan with the network that it was made for"
RUN_AGAIN = "make the plan again with `verifytga -t0` and keep all of its output"


class Names:
    """What a plan's words mean in a network; filled once, never changed afterwards."""

    def __init__(self, network: Network) -> None:
        self.clocks = frozenset(network.clocks)
        self.variables = tuple(name for name, _ in network.variables)
        self.automata = tuple(automaton.name for automaton in network.automata)
        self.locations: Dict[str, Dict[str, str]] = {}
        self.edges: Dict[Tuple[str, str, str, str], List[Edge]] = {}
        self.receivers = network.receivers
        for automaton in network.automata:
            printed = {printed_location(loc.name, loc.named): loc.name for loc in automaton.locations}
            # A network whose unnamed locations have got names in the meantime still reads the plan.
            for loc in automaton.locations:
                printed.setdefault(printed_location(loc.name, not loc.named), loc.name)
            self.locations[automaton.name] = printed
            for edge in automaton.edges:
                self.edges.setdefault((automaton.name, edge.source, edge.target, sync_text(edge)), []).append(edge)


class Reader:
    """Reads one plan, line by line. The caches hold what many lines say alike."""

    def __init__(self, names: Names, file: str, in_parts: bool) -> None:
        """`in_parts`: a state may leave out automata and variables."""
        self.names = names
        self.in_parts = in_parts
        self.file = file
        self.line = 1
        self.text = ""
        self.constraints: Dict[str, Tuple[Constraint, ...]] = {}
        self.moves: Dict[str, Move] = {}

    def fail(self, code: str, message: str, hint: str) -> NoReturn:
        """Raises a PursueError at the line that is being read."""
        span = Span(self.file, self.line, 1, self.line, len(self.text) + 1)
        raise Invalid([error(code, message, span, hint)])

    def zones(self, text: str) -> Tuple[Zone, ...]:
        """The zones in `(a && b) || (c)`."""
        return tuple(self.zone(part.strip()) for part in text.split("||"))

    def zone(self, text: str) -> Zone:
        """The zone in `(a && b)`."""
        if text.startswith("(") and text.endswith(")"):
            text = text[1:-1]
        if text.strip() == ALWAYS:
            return ()
        zone: Tuple[Constraint, ...] = ()
        for part in text.split("&&"):
            known = self.constraints.get(part)
            zone += self.constraint(part) if known is None else known
        return zone

    def constraint(self, text: str) -> Tuple[Constraint, ...]:
        """The constraint, remembered by its text."""
        constraints = read_constraint(re.sub(r"[ \t]", "", text))
        if constraints is None:
            self.fail(
                "PLN004",
                f"'{text.strip()}' is no constraint on clocks; expected one like `1<C`, `C<=5` or `A-B<2`",
                RUN_AGAIN,
            )
        for clock in (constraints[0].left, constraints[0].right):
            if clock is not None and clock not in self.names.clocks:
                self.fail("PLN005", f"the network has no clock '{clock}'", OTHER_NETWORK)
        self.constraints[text] = constraints
        return constraints

    def state(self, places: str, values: str) -> DiscreteState:
        """The discrete state, its parts in the network's order whatever theirs is."""
        at: Dict[str, str] = {}
        for word in places.split():
            automaton, _, printed = word.partition(".")
            if word == "states.base" and automaton not in self.names.locations:
                continue  # an older translator wrote this automaton also where nothing can happen in it
            if automaton in at:
                self.fail("PLN006", f"the state gives two locations of '{automaton}'", RUN_AGAIN)
            at[automaton] = self.location(automaton, printed)
        value: Dict[str, int] = {}
        for word in values.split():
            match = re.fullmatch(r"([^\s=]+)=(-?\d{1,18})", word)
            if not match:
                self.fail("PLN004", f"'{word}' is no value of a variable; expected one like `P=1`", RUN_AGAIN)
            value[match.group(1)] = int(match.group(2))
        self.compare("automaton", self.names.automata, tuple(at))
        self.compare("variable", self.names.variables, tuple(value))
        return DiscreteState(
            tuple((name, at[name]) for name in self.names.automata if name in at),
            tuple((name, value[name]) for name in self.names.variables if name in value),
        )

    def compare(self, what: str, known: Tuple[str, ...], given: Sequence[str]) -> None:
        """Fails where a state says too much or too little."""
        for name in given:
            if name not in known:
                self.fail("PLN005", f"the network has no {what} '{name}'", OTHER_NETWORK)
        for name in known:
            if name not in given and not self.in_parts:
                self.fail("PLN006", f"the state says nothing of {what} '{name}'", OTHER_NETWORK)

    def location(self, automaton: str, printed: str) -> str:
        """The location that is printed so."""
        if automaton not in self.names.locations:
            self.fail("PLN005", f"the network has no automaton '{automaton}'", OTHER_NETWORK)
        location = self.names.locations[automaton].get(printed)
        if location is None:
            self.fail("PLN005", f"automaton '{automaton}' has no location '{printed}'", OTHER_NETWORK)
        return location

    def move(self, text: str) -> Move:
        """The network's edge that is printed so, remembered by its text."""
        known = self.moves.get(text)
        if known is not None:
            return known
        match = _EDGE.fullmatch(text.strip())
        if not match:
            self.fail("PLN004", "this is no transition; expected `bot.a->bot.b { guard, sync, assignment }`", RUN_AGAIN)
        automaton, source, other, target, guard, sync, assign = match.groups()
        if automaton != other:
            self.fail(
                "PLN004", f"a transition stays in one automaton; this goes from '{automaton}' to '{other}'", RUN_AGAIN
            )
        ends = (self.location(automaton, source), self.location(automaton, target))
        edges = self.names.edges.get((automaton, *ends, sync), [])
        if not edges:
            self.fail(
                "PLN007",
                f"the network has no edge {automaton}.{source}->{automaton}.{target} with '{sync}'",
                OTHER_NETWORK,
            )
        for edge in edges:
            same_guard = guard_meaning(guard_text(edge.guard)) == guard_meaning(guard)
            if same_guard and assign_meaning(assign_text(edge)) == assign_meaning(assign):
                self.moves[text] = Move(automaton, edge)
                return self.moves[text]
        ours = " or ".join(f"{{ {guard_text(e.guard)}, {sync_text(e)}, {assign_text(e)} }}" for e in edges)
        self.fail(
            "PLN007", f"in the network the edge {automaton}.{source}->{automaton}.{target} is {ours}", OTHER_NETWORK
        )

    def check_joint(self, state: DiscreteState, moves: Tuple[Move, ...]) -> None:
        """Fails unless exactly the automata take part that must in this state; a cut or mixed-up file shows so."""
        at, value = dict(state.locations), dict(state.values)
        for move in moves:
            if at.get(move.automaton) != move.edge.source or not move.edge.guard.may_hold(value):
                self.fail("PLN008", f"'{move.automaton}' cannot make this move in the state above", RUN_AGAIN)
        sync = moves[0].edge.sync
        if sync is not None and not sync.sends:
            self.fail(
                "PLN008",
                f"a transition starts with the automaton that sends, not with a receiver of '{sync.channel}'",
                RUN_AGAIN,
            )
        taking = [move.automaton for move in moves[1:]]
        due: Set[str] = set()
        possible: Set[str] = set()
        for automaton, edge in self.names.receivers.get(sync.channel, []) if sync else []:
            if automaton != moves[0].automaton and at.get(automaton) == edge.source:
                due.update([automaton] if edge.guard.holds(value) else ())
                possible.update([automaton] if edge.guard.may_hold(value) else ())
        channels = {move.edge.sync and move.edge.sync.channel for move in moves}
        if len(channels) > 1 or len(taking) != len(set(taking)) or not due <= set(taking) <= possible:
            expected = ", ".join(sorted(due)) or "nobody"
            self.fail(
                "PLN008",
                f"in this state {expected} must receive '{sync_text(moves[0].edge)}', and the plan has "
                f"{', '.join(taking) or 'nobody'}",
                RUN_AGAIN,
            )


def printed_location(location: str, named: bool) -> str:
    """The location as UPPAAL prints it."""
    return location if named else f"_{location}"
