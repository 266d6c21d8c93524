"""UPPAAL_plan.txt, both ways: the raw output of `verifytga`, with a strategy or a counter-strategy at its end.

What stands before the strategy (escape codes, progress, the verdict) is skipped. Each state is a block of lines:

    State: ( police.a thief.d reachObj._unlocked ) Ppolice=1 Pthief=4
    While you are in (Cpolice<=1 && Cthief<Cpolice), wait.
    When you are in (1<Cpolice), take transition police.a->police.b { Cpolice > 1, police_a2b!, Cpolice := 0 }

with the other automata that take part in a transition on the lines after it. A location to which the network gives no
name is printed by its id with an underscore before it. A plan of ours names what it does not speak of above its title
(`plan_parts`).
"""

from __future__ import annotations

import re
from typing import Dict, List, NoReturn, Optional, Sequence, Set, Tuple

from pursue_gen.diagnostics import PursueError, Span, error
from pursue_gen.outcomes import Invalid, NotProven
from pursue_gen.synthesis.plan_parts import (
    left_out_lines,
    read_left_out_clocks,
    read_shares,
    read_stages,
    read_watchers,
    spoken_of,
)
from pursue_gen.synthesis.plan_text import (
    ALWAYS,
    assign_meaning,
    assign_text,
    guard_meaning,
    guard_text,
    read_constraint,
    sync_text,
    zones_text,
)
from pursue_gen.synthesis.strategy import Block, Command, Constraint, DiscreteState, Move, Strategy, Zone
from pursue_gen.tga.network import Edge, Guard, Kind, Network, Objective
from pursue_gen.tga.uppaal_words import with_own_names
from pursue_gen.tga.watchers import with_watchers

_ESCAPE = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")
_HEADER = re.compile(r"^[ \t]*(Strategy|Counter[ -]strategy) to [^\n:]*:[ \t\r]*$", re.MULTILINE | re.IGNORECASE)
_SATISFIED = re.compile(r"Property is (NOT )?satisfied")
_STATE = re.compile(r"State: \((.*?)\)(.*)")
_WAIT = re.compile(r"While you are in[ \t]+(.*?),[ \t]*wait\.")
_COMMAND = re.compile(r"When you are in[ \t]+(.*?),[ \t]*take transition (\S.*)")
_EDGE = re.compile(r"([^\s.]+)\.(\S+?)->([^\s.]+)\.(\S+)\s*\{\s*([^,{}]*),\s*([^,{}\s]*)\s*,([^{}]*)\}")

_OTHER_NETWORK = "read the plan with the network that it was made for"
_RUN_AGAIN = "make the plan again with `verifytga -t0` and keep all of its output"


class _Names:
    """What a plan's words mean in a network; filled once, never changed afterwards."""

    def __init__(self, network: Network) -> None:
        self.clocks = frozenset(network.clocks)
        self.variables = tuple(name for name, _ in network.variables)
        self.automata = tuple(automaton.name for automaton in network.automata)
        self.locations: Dict[str, Dict[str, str]] = {}
        self.edges: Dict[Tuple[str, str, str, str], List[Edge]] = {}
        self.receivers: Dict[str, List[Tuple[str, Edge]]] = {}
        for automaton in network.automata:
            printed = {_printed(loc.name, loc.named): loc.name for loc in automaton.locations}
            # A network whose unnamed locations have got names in the meantime still reads the plan.
            for loc in automaton.locations:
                printed.setdefault(_printed(loc.name, not loc.named), loc.name)
            self.locations[automaton.name] = printed
            for edge in automaton.edges:
                self.edges.setdefault((automaton.name, edge.source, edge.target, sync_text(edge)), []).append(edge)
                if edge.sync and not edge.sync.sends:
                    self.receivers.setdefault(edge.sync.channel, []).append((automaton.name, edge))


class _Reader:
    """Reads one plan, line by line. The caches hold what many lines say alike."""

    def __init__(self, names: _Names, file: str, in_parts: bool) -> None:
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
                _RUN_AGAIN,
            )
        for clock in (constraints[0].left, constraints[0].right):
            if clock is not None and clock not in self.names.clocks:
                self.fail("PLN005", f"the network has no clock '{clock}'", _OTHER_NETWORK)
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
                self.fail("PLN006", f"the state gives two locations of '{automaton}'", _RUN_AGAIN)
            at[automaton] = self.location(automaton, printed)
        value: Dict[str, int] = {}
        for word in values.split():
            match = re.fullmatch(r"([^\s=]+)=(-?\d{1,18})", word)
            if not match:
                self.fail("PLN004", f"'{word}' is no value of a variable; expected one like `P=1`", _RUN_AGAIN)
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
                self.fail("PLN005", f"the network has no {what} '{name}'", _OTHER_NETWORK)
        for name in known:
            if name not in given and not self.in_parts:
                self.fail("PLN006", f"the state says nothing of {what} '{name}'", _OTHER_NETWORK)

    def location(self, automaton: str, printed: str) -> str:
        """The location that is printed so."""
        if automaton not in self.names.locations:
            self.fail("PLN005", f"the network has no automaton '{automaton}'", _OTHER_NETWORK)
        location = self.names.locations[automaton].get(printed)
        if location is None:
            self.fail("PLN005", f"automaton '{automaton}' has no location '{printed}'", _OTHER_NETWORK)
        return location

    def move(self, text: str) -> Move:
        """The network's edge that is printed so, remembered by its text."""
        known = self.moves.get(text)
        if known is not None:
            return known
        match = _EDGE.fullmatch(text.strip())
        if not match:
            self.fail(
                "PLN004", "this is no transition; expected `bot.a->bot.b { guard, sync, assignment }`", _RUN_AGAIN
            )
        automaton, source, other, target, guard, sync, assign = match.groups()
        if automaton != other:
            self.fail(
                "PLN004", f"a transition stays in one automaton; this goes from '{automaton}' to '{other}'", _RUN_AGAIN
            )
        ends = (self.location(automaton, source), self.location(automaton, target))
        edges = self.names.edges.get((automaton, *ends, sync), [])
        if not edges:
            self.fail(
                "PLN007",
                f"the network has no edge {automaton}.{source}->{automaton}.{target} with '{sync}'",
                _OTHER_NETWORK,
            )
        for edge in edges:
            same_guard = guard_meaning(guard_text(edge.guard)) == guard_meaning(guard)
            if same_guard and assign_meaning(assign_text(edge)) == assign_meaning(assign):
                self.moves[text] = Move(automaton, edge)
                return self.moves[text]
        ours = " or ".join(f"{{ {guard_text(e.guard)}, {sync_text(e)}, {assign_text(e)} }}" for e in edges)
        self.fail(
            "PLN007", f"in the network the edge {automaton}.{source}->{automaton}.{target} is {ours}", _OTHER_NETWORK
        )

    def check_joint(self, state: DiscreteState, moves: Tuple[Move, ...]) -> None:
        """Fails unless exactly the automata take part that must in this state; a cut or mixed-up file shows so."""
        at, value = dict(state.locations), dict(state.values)
        for move in moves:
            if at.get(move.automaton) != move.edge.source or not _integers_hold(move.edge.guard, value):
                self.fail("PLN008", f"'{move.automaton}' cannot make this move in the state above", _RUN_AGAIN)
        sync = moves[0].edge.sync
        if sync is not None and not sync.sends:
            self.fail(
                "PLN008",
                f"a transition starts with the automaton that sends, not with a receiver of '{sync.channel}'",
                _RUN_AGAIN,
            )
        taking = [move.automaton for move in moves[1:]]
        due: Set[str] = set()
        for automaton, edge in self.names.receivers.get(sync.channel, []) if sync else []:
            able = at.get(automaton) == edge.source and _integers_hold(edge.guard, value)
            if automaton != moves[0].automaton and able:
                due.add(automaton)
        channels = {move.edge.sync and move.edge.sync.channel for move in moves}
        if len(channels) > 1 or len(taking) != len(set(taking)) or set(taking) != due:
            expected = ", ".join(sorted(due)) or "nobody"
            self.fail(
                "PLN008",
                f"in this state {expected} must receive '{sync_text(moves[0].edge)}', and the plan has "
                f"{', '.join(taking) or 'nobody'}",
                _RUN_AGAIN,
            )


class _Open:
    """The block, and in it the command, that is being read; `place` is the last line of that command."""

    def __init__(self, state: DiscreteState) -> None:
        self.state = state
        self.wait: Tuple[Zone, ...] = ()
        self.commands: List[Command] = []
        self.zones: Tuple[Zone, ...] = ()
        self.moves: Tuple[Move, ...] = ()
        self.place = (0, "")


def read_plan(text: str, network: Network, file: str) -> Strategy:
    """The strategy (or counter-strategy) in the output of verifytga, or in a plan that `write_plan` wrote.

    `file` is the name that errors give. Raises PursueError where there is no strategy (exit status 4 when the file says
    that the property does not hold), where the text is cut or damaged, and where it does not fit the network.
    """
    text = _ESCAPE.sub("", text).replace("\r\n", "\n")
    watchers = read_watchers(text.partition("\nState:")[0], network, file)
    network = with_watchers(network, watchers)
    text = with_own_names(text, network)
    header = _HEADER.search(text)
    if header is None:
        raise _no_strategy(text, file)
    above = text[: header.start()]
    stages, shares = read_stages(above, network, file), read_shares(above, network, file)
    left_out_clocks = read_left_out_clocks(above, network, file)
    reader = _Reader(_Names(spoken_of(above, network, file)), file, bool(stages or shares))
    first = text.count("\n", 0, header.end()) + 1
    blocks: List[Block] = []
    seen: Set[DiscreteState] = set()
    opened: Optional[_Open] = None
    for offset, line in enumerate(text[header.end() :].split("\n")):
        line = line.rstrip()
        if not line:
            continue
        if line.startswith("State:"):
            _close(reader, opened, blocks)
            reader.line, reader.text = first + offset, line
            opened = _start(reader, line, seen)
        else:
            reader.line, reader.text = first + offset, line
            if opened is None:
                reader.fail("PLN004", "expected a line that starts with `State: (`", _RUN_AGAIN)
            _continue(reader, opened, line)
    _close(reader, opened, blocks)
    if not blocks:
        reader.line, reader.text = first, ""
        reader.fail("PLN003", "the strategy is empty: no state follows its title", _RUN_AGAIN)
    counter = header.group(1).lower().startswith("counter")
    return Strategy(tuple(blocks), counter, stages, left_out_clocks, shares, watchers)


def _start(reader: _Reader, line: str, seen: Set[DiscreteState]) -> _Open:
    """The block that a line `State: …` starts."""
    match = _STATE.fullmatch(line)
    if not match:
        reader.fail(
            "PLN004", "this is no state; expected `State: ( automaton.location … ) variable=value …`", _RUN_AGAIN
        )
    state = reader.state(match.group(1), match.group(2))
    if state in seen:
        reader.fail("PLN006", "the plan has this state twice", _RUN_AGAIN)
    seen.add(state)
    return _Open(state)


def _continue(reader: _Reader, opened: _Open, line: str) -> None:
    """Takes a line within a block: a wait, a command, or one more automaton of the command before."""
    command = _COMMAND.fullmatch(line)
    if command:
        _finish_command(reader, opened)
        opened.zones, opened.moves = reader.zones(command.group(1)), (reader.move(command.group(2)),)
        opened.place = (reader.line, reader.text)
        return
    wait = _WAIT.fullmatch(line)
    if wait:
        _finish_command(reader, opened)
        opened.wait += reader.zones(wait.group(1))
    elif opened.moves and "->" in line and not line.startswith(("When", "While")):
        opened.moves += (reader.move(line),)
        opened.place = (reader.line, reader.text)
    else:
        reader.fail(
            "PLN004",
            "this line is cut or damaged; expected `While you are in …, wait.`, "
            "`When you are in …, take transition …` or a transition",
            _RUN_AGAIN,
        )


def _finish_command(reader: _Reader, opened: _Open) -> None:
    """Adds the command whose last line has been read."""
    if opened.moves:
        here = (reader.line, reader.text)
        reader.line, reader.text = opened.place
        reader.check_joint(opened.state, opened.moves)
        reader.line, reader.text = here
        opened.commands.append(Command(opened.zones, opened.moves))
        opened.moves = ()


def _close(reader: _Reader, opened: Optional[_Open], blocks: List[Block]) -> None:
    """Adds the block whose last line has been read."""
    if opened is None:
        return
    _finish_command(reader, opened)
    if not opened.wait and not opened.commands:
        reader.fail("PLN003", "the plan is cut: it does not say what to do in this state", _RUN_AGAIN)
    blocks.append(Block(opened.state, opened.wait, tuple(opened.commands)))


def _integers_hold(guard: Guard, value: Dict[str, int]) -> bool:
    """True where the values satisfy the guard's tests of variables."""
    return all(any(value.get(test.variable) == test.value for test in clause) for clause in guard.integers)


def _no_strategy(text: str, file: str) -> PursueError:
    """Why a text without a strategy has none."""
    verdict = _SATISFIED.search(text)
    if verdict is None:
        span = Span(file, 1, 1, 1, 1)
        what = "the file is empty" if not text.strip() else "this is no plan: no line says `Strategy to …:`"
        return Invalid([error("PLN001", what, span, _RUN_AGAIN)])
    line = text.count("\n", 0, verdict.start()) + 1
    column = verdict.start() - text.rfind("\n", 0, verdict.start())
    span = Span(file, line, column, line, column + len(verdict.group()))
    if verdict.group(1):
        message = "the plan says that the objective cannot be met, and holds no counter-strategy"
        hint = "change the scenario; `verifytga -t0` prints the counter-strategy, which shows why it loses"
        return NotProven([error("PLN002", message, span, hint)])
    message = "the plan says that the objective is met, and holds no strategy"
    return Invalid([error("PLN001", message, span, _RUN_AGAIN)])


def _printed(location: str, named: bool) -> str:
    """The location as UPPAAL prints it."""
    return location if named else f"_{location}"


def _title(strategy: Strategy, objective: Objective) -> str:
    """The line that TIGA puts above such a strategy."""
    if objective.kind is Kind.SAFETY:
        return "Counter strategy to lose:" if strategy.counter else "Strategy to avoid losing:"
    return "Counter strategy to prevent from winning:" if strategy.counter else "Strategy to win:"


def write_plan(strategy: Strategy, network: Network, objective: Objective) -> str:
    """The plan as verifytga prints it, without its progress; `read_plan` makes the same strategy of it.

    A block that says nothing (no zone to wait in and no command) is left out: it covers nothing. Raises ValueError
    where a command has no zone.
    """
    network = with_watchers(network, strategy.watchers)
    printed = {
        automaton.name: {location.name: _printed(location.name, location.named) for location in automaton.locations}
        for automaton in network.automata
    }
    lines = ["Verifying property 1 at line 1", f" -- Property is {'NOT ' if strategy.counter else ''}satisfied."]
    lines += [*left_out_lines(strategy, network), ""]
    lines += [_title(strategy, objective), ""]
    zones: Dict[int, str] = {}
    known: Dict[int, List[str]] = {}
    for block in strategy.blocks:
        if not block.wait and not block.commands:
            continue
        places = " ".join(f"{name}.{printed[name][location]}" for name, location in block.state.locations)
        values = "".join(f"{name}={value} " for name, value in block.state.values)
        lines.append(f"State: ( {places} ) {values}")
        if block.wait:
            lines.append(f"While you are in {zones_text(block.wait, zones)}, wait.")
        for command in block.commands:
            if not command.zones:
                raise ValueError("a command without a zone can never be due")
            moves = known.get(id(command.moves))
            if moves is None:
                moves = known[id(command.moves)] = [_move_text(move, printed[move.automaton]) for move in command.moves]
            lines.append(f"When you are in {zones_text(command.zones, zones)}, take transition {moves[0]}")
            lines += moves[1:]
        lines.append("")
    return "\n".join(lines)


def _move_text(move: Move, printed: Dict[str, str]) -> str:
    """The transition as TIGA prints it."""
    edge, name = move.edge, move.automaton
    ends = f"{name}.{printed[edge.source]}->{name}.{printed[edge.target]}"
    return f"{ends} {{ {guard_text(edge.guard)}, {sync_text(edge)}, {assign_text(edge)} }}"
