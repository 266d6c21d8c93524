"""Quick fixes for windows, limits, ways of travel, things to be done, conditions and assumptions."""

from __future__ import annotations

from typing import Iterator, Optional, Tuple

from lark import Token

from pursue_gen.diagnostics import Diagnostic
from pursue_gen.language.assumption_checks import MOST_TIMES as MOST_ASSUMED
from pursue_gen.language.assumption_checks import SHORTEST_STAY
from pursue_gen.language.checks import MOST_TIMES
from pursue_gen.language.edits import Edit
from pursue_gen.language.numbers import exact, read_number
from pursue_gen.tools.lsp.document import Document
from pursue_gen.tools.lsp.edits import bare, cut, first, pair, written
from pursue_gen.tools.lsp.edits import behind as added
from pursue_gen.tools.lsp.statements import deleted, inserted
from pursue_gen.tools.lsp.tokens import Statement

Proposal = Tuple[str, Tuple[Edit, ...]]


def later_end(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """A window whose first number is the smaller one."""
    tokens = part.tokens if part is not None else ()
    for low, to, high in zip(tokens, tokens[1:], tokens[2:]):
        if (low.type, to.type, high.type) != ("NUMBER", "TO", "NUMBER"):
            continue
        earliest, latest = read_number(high), read_number(low)
        if earliest is not None and latest is not None:
            latest = exact(earliest + 1) if earliest == latest else latest
            yield f"Write {earliest} to {latest}", (written(low, str(earliest)), written(high, str(latest)))
        return
    takes = pair(part, "TAKES")
    if takes is not None:
        yield "Write takes 1", (written(takes[1], "1"),)


def possible_movement(
    document: Document, finding: Diagnostic, part: Optional[Statement], at: int
) -> Iterator[Proposal]:
    """Lets the movement be possible of which a travel time speaks, or deletes that."""
    span = finding.span
    travel = next((each for each in document.scenario.travels if span is not None and each.span == span), None)
    if part is None or travel is None:
        return
    agent = next((each for each in document.scenario.agents if each.name == travel.agent.name), None)
    back = next((way for way in document.scenario.connections if (way.b, way.a) == travel.way and way.one_way), None)
    declared = next((p for p in document.statements if p.kind == "AGENT" and bare(p.name) == travel.agent.name), None)
    if agent is not None and agent.mobile is None and declared is not None:
        last = [token for token in declared.tokens if token.type in ("NAME", "HUMAN", "CONTROLLABLE")][-1]
        yield f"Make {agent.name} mobile", (added(last, " mobile 1"),)
    elif back is not None:
        way = document.statement_at(document.positions.of_span(back.span)[0])
        word = first(way, "ONE_WAY")
        if word is not None:
            yield f"Let the way from {back.a} to {back.b} go both ways", (cut(document, word, word),)
    else:
        statement = f"connect {travel.way[0]} and {travel.way[1]} distance 1"
        yield f"Add a way: {statement}", inserted(document, statement)
    yield "Delete this statement", deleted(document, part)


def fewer_times(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """A limit that can be counted, or none."""
    found, times = pair(part, "AT_MOST"), first(part, "TIMES")
    if found is None or times is None:
        return
    if found[1].isdigit() and int(found[1]) > MOST_TIMES:
        yield f"Write at_most {MOST_TIMES} times", (written(found[1], str(MOST_TIMES)),)
    yield "Delete the limit", (cut(document, found[0], times),)


def bind_others(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """A rule for each agent in the place of each robot, or one for all."""
    word, robot = first(part, "FOR"), first(part, "ROBOT")
    each = first(part, "EACH")
    if part is None or word is None or each is None:
        return
    last = part.tokens[part.tokens.index(each) + 1]
    if robot is last and any(not agent.is_robot for agent in document.scenario.agents):
        yield "Write for each agent", (written(robot, "agent"),)
    yield f"Let the rule {bare(part.name)} be one for all", (cut(document, word, last),)


def to_be_done_once(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """Takes an event out of what is to be done; if nothing else is to be done, deletes the objective."""
    tokens = part.tokens if part is not None else ()
    index = next((i for i, token in enumerate(tokens) if token.start_pos == at), None)
    if part is None or index is None:
        return
    after = tokens[index + 1] if index + 1 < len(tokens) else None
    if tokens[index - 1].type == "AND":
        yield f"Take {tokens[index]} out", (cut(document, tokens[index - 1], tokens[index]),)
    elif after is not None and after.type == "AND":
        yield f"Take {tokens[index]} out", (Edit(at, tokens[index + 2].start_pos or 0, ""),)
    else:
        yield "Delete this statement", deleted(document, part)


def done_or_avoided(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """Deletes one of two objectives that contradict each other."""
    yield from to_be_done_once(document, finding, part, at)
    for safety in document.scenario.safety:
        other = document.statement_at(document.positions.of_span(safety.span)[0])
        if safety.breaks.event is not None and other is not None and _is_named(document, safety.breaks.event.name, at):
            yield f"Delete the objective to avoid {safety.breaks.event.name}", deleted(document, other)


def later_deadline(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """A deadline that ends after what is to be done begins to count."""
    after, within = pair(part, "AFTER"), pair(part, "WITHIN")
    start = read_number(after[1]) if after is not None else None
    if start is not None and within is not None:
        number = exact(start + 1)
        yield f"Write within {number}", (written(within[1], str(number)),)


def without_condition(
    document: Document, finding: Diagnostic, part: Optional[Statement], at: int
) -> Iterator[Proposal]:
    """Deletes a condition that says nothing."""
    word = first(part, "ONLY_IF")
    if part is not None and word is not None:
        yield "Delete the condition", (cut(document, word, part.tokens[-1]),)
    elif part is not None:
        yield "Delete this statement", deleted(document, part)


def possible_number(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """The nearest number that can be assumed."""
    for word, number in (("AT_MOST", MOST_ASSUMED), ("WAITS", 1), ("WITHIN", SHORTEST_STAY)):
        found = pair(part, word)
        if found is not None:
            yield f"Write {found[0]} {number}", (written(found[1], str(number)),)
    if part is not None:
        yield "Delete this statement", deleted(document, part)


def _is_named(document: Document, name: str, at: int) -> bool:
    """True if this name stands at the offset."""
    here: Optional[Token] = next((t for p in document.statements for t in p.tokens if t.start_pos == at), None)
    return here is not None and str(here) == name
