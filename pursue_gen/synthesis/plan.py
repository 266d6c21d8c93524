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
from dataclasses import replace
from typing import Collection, Dict, Iterator, List, Sequence, Tuple

from pursue_gen.diagnostics import PursueError, Span, error
from pursue_gen.outcomes import Invalid, NotProven
from pursue_gen.synthesis.plan_parts import left_out_lines, read_own, read_parts, spoken_of
from pursue_gen.synthesis.plan_reader import RUN_AGAIN, Names, Reader, printed_location
from pursue_gen.synthesis.plan_text import assign_text, guard_text, sync_text, zones_text
from pursue_gen.synthesis.strategy import Block, Command, DiscreteState, Move, Strategy, Zone, with_automata_of
from pursue_gen.tga.network import Network, Objective
from pursue_gen.tga.uppaal_write import with_own_names

_ESCAPE = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")
_HEADER = re.compile(r"^[ \t]*(Strategy|Counter[ -]strategy) to [^\n:]*:[ \t\r]*$", re.MULTILINE | re.IGNORECASE)
_SATISFIED = re.compile(r"Property is (NOT )?satisfied")
_STATE = re.compile(r"State: \((.*?)\)(.*)")
_WAIT = re.compile(r"While you are in[ \t]+(.*?),[ \t]*wait\.")
_COMMAND = re.compile(r"When you are in[ \t]+(.*?),[ \t]*take transition (\S.*)")

_Line = Tuple[int, str]
"""A line of the file, behind its number."""


def read_plan(text: str, network: Network, file: str) -> Strategy:
    """The strategy (or counter-strategy) in the output of verifytga, or in a plan that `write_plan` wrote.

    `file` is the name that errors give. Raises PursueError where there is no strategy (exit status 4 when the file says
    that the property does not hold), where the text is cut or damaged, and where it does not fit the network.
    """
    text = _ESCAPE.sub("", text).replace("\r\n", "\n")
    own = read_own(text.partition("\nState:")[0], network, file)
    network = with_automata_of(network, own)
    text = with_own_names(text, network)
    header = _HEADER.search(text)
    if header is None:
        raise _no_strategy(text, file)
    above = text[: header.start()]
    strategy = read_parts(above, network, file, own)
    reader = Reader(Names(spoken_of(above, network, file)), file, strategy.in_parts)
    first = text.count("\n", 0, header.end()) + 1
    groups: List[List[_Line]] = []
    for number, line in enumerate(map(str.rstrip, text[header.end() :].split("\n")), first):
        if line.startswith("State:"):
            groups.append([])
        elif line and not groups:
            reader.line, reader.text = number, line
            reader.fail("PLN004", "expected a line that starts with `State: (`", RUN_AGAIN)
        if line:
            groups[-1].append((number, line))
    blocks: Dict[DiscreteState, Block] = {}
    for group in groups:
        state = _state(reader, group[0], blocks)
        blocks[state] = _block(reader, state, group[1:])
    if not blocks:
        reader.line, reader.text = first, ""
        reader.fail("PLN003", "the strategy is empty: no state follows its title", RUN_AGAIN)
    counter = header.group(1).lower().startswith("counter")
    return replace(strategy, blocks=tuple(blocks.values()), counter=counter)


def _state(reader: Reader, line: _Line, known: Collection[DiscreteState]) -> DiscreteState:
    """The discrete state that a line `State: …` names."""
    reader.line, reader.text = line
    match = _STATE.fullmatch(line[1])
    if not match:
        reader.fail(
            "PLN004", "this is no state; expected `State: ( automaton.location … ) variable=value …`", RUN_AGAIN
        )
    state = reader.state(match.group(1), match.group(2))
    if state in known:
        reader.fail("PLN006", "the plan has this state twice", RUN_AGAIN)
    return state


def _block(reader: Reader, state: DiscreteState, lines: Sequence[_Line]) -> Block:
    """What these lines say is to be done: each a wait, a command, or one more automaton of the command before."""
    wait: Tuple[Zone, ...] = ()
    commands: List[Command] = []
    zones: Tuple[Zone, ...] = ()
    moves: Tuple[Move, ...] = ()
    for line in lines:
        command, waits = _COMMAND.fullmatch(line[1]), _WAIT.fullmatch(line[1])
        if command or waits:
            commands += _joint(reader, state, zones, moves)
            moves = ()
        reader.line, reader.text = line
        if command:
            zones, moves = reader.zones(command.group(1)), (reader.move(command.group(2)),)
        elif waits:
            wait += reader.zones(waits.group(1))
        elif moves and "->" in line[1] and not line[1].startswith(("When", "While")):
            moves += (reader.move(line[1]),)
        else:
            reader.fail(
                "PLN004",
                "this line is cut or damaged; expected `While you are in …, wait.`, "
                "`When you are in …, take transition …` or a transition",
                RUN_AGAIN,
            )
    commands += _joint(reader, state, zones, moves)
    if not wait and not commands:
        reader.fail("PLN003", "the plan is cut: it does not say what to do in this state", RUN_AGAIN)
    return Block(state, wait, tuple(commands))


def _joint(reader: Reader, state: DiscreteState, zones: Tuple[Zone, ...], moves: Tuple[Move, ...]) -> Iterator[Command]:
    """The command of these moves, whose last line has been read; none of no moves."""
    if moves:
        reader.check_joint(state, moves)
        yield Command(zones, moves)


def _no_strategy(text: str, file: str) -> PursueError:
    """Why a text without a strategy has none."""
    verdict = _SATISFIED.search(text)
    if verdict is None:
        span = Span(file, 1, 1, 1, 1)
        what = "the file is empty" if not text.strip() else "this is no plan: no line says `Strategy to …:`"
        return Invalid([error("PLN001", what, span, RUN_AGAIN)])
    line = text.count("\n", 0, verdict.start()) + 1
    column = verdict.start() - text.rfind("\n", 0, verdict.start())
    span = Span(file, line, column, line, column + len(verdict.group()))
    if verdict.group(1):
        message = "the plan says that the objective cannot be met, and holds no counter-strategy"
        hint = "change the scenario; `verifytga -t0` prints the counter-strategy, which shows why it loses"
        return NotProven([error("PLN002", message, span, hint)])
    message = "the plan says that the objective is met, and holds no strategy"
    return Invalid([error("PLN001", message, span, RUN_AGAIN)])


def _title(strategy: Strategy, objective: Objective) -> str:
    """The line that TIGA puts above such a strategy."""
    if not objective.reaches:
        return "Counter strategy to lose:" if strategy.counter else "Strategy to avoid losing:"
    return "Counter strategy to prevent from winning:" if strategy.counter else "Strategy to win:"


def write_plan(strategy: Strategy, network: Network, objective: Objective) -> str:
    """The plan as verifytga prints it, without its progress; `read_plan` makes the same strategy of it.

    A block that says nothing (no zone to wait in and no command) is left out: it covers nothing. Raises ValueError
    where a command has no zone.
    """
    network = with_automata_of(network, strategy)
    printed = {
        automaton.name: {
            location.name: printed_location(location.name, location.named) for location in automaton.locations
        }
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
