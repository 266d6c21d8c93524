"""Quick fixes for windows, limits, ways of travel, things to be done, conditions and assumptions."""

from __future__ import annotations

from pursue_gen.diagnostics import Diagnostic
from pursue_gen.language.assumptions import NUMBERED
from pursue_gen.language.document import Edit, behind, written
from pursue_gen.language.draft import Draft
from pursue_gen.language.measures import LENGTHS
from pursue_gen.language.numbers import exact
from pursue_gen.language.statements.event import MOST_TIMES
from pursue_gen.language.syntax import Statement
from pursue_gen.language.times import TIMES, has_unit, like, written_time
from pursue_gen.language.tokens import bare, start_of
from pursue_gen.tools.lsp.fixes_syntax import Proposals
from pursue_gen.tools.lsp.hover import read_time


def later_end(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """A window whose first number is the smaller one."""
    tokens = part.tokens
    for low, to, high in zip(tokens, tokens[1:], tokens[2:]):
        if (low.type, to.type, high.type) != ("NUMBER", "TO", "NUMBER"):
            continue
        earliest, latest = read_time(document, high), read_time(document, low)
        if earliest is not None and latest is not None:
            latest = like(exact(earliest + 1), earliest) if earliest == latest else latest
            first, last = written_time(earliest), written_time(latest)
            yield f"Write {first} to {last}", (written(low, first), written(high, last))
        return
    takes = part.pair("TAKES")
    if takes is not None:
        yield "Write takes 1", (written(takes[1], "1"),)


def possible_movement(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """Lets the movement be possible of which a travel time speaks, or deletes that."""
    span = finding.span
    travel = next((each for each in document.scenario.travels if span is not None and each.span == span), None)
    if travel is None:
        return
    agent = next((each for each in document.scenario.agents if each.name == travel.agent.name), None)
    back = next((way for way in document.scenario.connections if (way.b, way.a) == travel.way and way.one_way), None)
    declared = next((p for p in document.statements if p.kind == "AGENT" and bare(p.name) == travel.agent.name), None)
    if agent is not None and agent.mobile is None and declared is not None:
        last = [token for token in declared.tokens if token.type in ("NAME", "HUMAN", "CONTROLLABLE")][-1]
        yield f"Make {agent.name} mobile", (behind(last, " mobile 1"),)
    elif back is not None:
        way = document.statement_at(document.lines.of_span(back.span)[0])
        word = way.first("ONE_WAY") if way is not None else None
        if word is not None:
            yield f"Let the way from {back.a} to {back.b} go both ways", (document.cut(word, word),)
    else:
        statement = f"connect {travel.way[0]} and {travel.way[1]} distance 1"
        yield f"Add a way: {statement}", (document.inserted(statement),)
    yield "Delete this statement", (document.deleted(part),)


def fewer_times(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """A limit that can be counted, or none."""
    found, times = part.pair("AT_MOST"), part.first("TIMES")
    if found is None or times is None:
        return
    if found[1].isdigit() and int(found[1]) > MOST_TIMES:
        yield f"Write at_most {MOST_TIMES} times", (written(found[1], str(MOST_TIMES)),)
    yield "Delete the limit", (document.cut(found[0], times),)


def bind_others(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """A rule for each agent in the place of each robot, or one for all."""
    word, robot = part.first("FOR"), part.first("ROBOT")
    each = part.first("EACH")
    if word is None or each is None:
        return
    last = part.tokens[part.tokens.index(each) + 1]
    if robot is last and any(not agent.is_robot for agent in document.scenario.agents):
        yield "Write for each agent", (written(robot, "agent"),)
    yield f"Let the rule {bare(part.name)} be one for all", (document.cut(word, last),)


def to_be_done_once(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """Takes an event out of what is to be done; if nothing else is to be done, deletes the objective."""
    tokens = part.tokens
    index = next((i for i, token in enumerate(tokens) if token.start_pos == at), None)
    if index is None:
        return
    after = tokens[index + 1] if index + 1 < len(tokens) else None
    if tokens[index - 1].type == "AND":
        yield f"Take {tokens[index]} out", (document.cut(tokens[index - 1], tokens[index]),)
    elif after is not None and after.type == "AND":
        yield f"Take {tokens[index]} out", (Edit(at, start_of(tokens[index + 2]), ""),)
    else:
        yield "Delete this statement", (document.deleted(part),)


def done_or_avoided(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """Deletes one of two objectives that contradict each other."""
    yield from to_be_done_once(document, finding, part, at)
    for safety in document.scenario.safety:
        other = document.statement_at(document.lines.of_span(safety.span)[0])
        event = safety.breaks.event
        if other is not None and event is not None and event.name == str(document.token_at(at)):
            yield f"Delete the objective to avoid {event.name}", (document.deleted(other),)


def later_deadline(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """A deadline that ends after what is to be done begins to count."""
    after, within = part.pair("AFTER"), part.pair("WITHIN")
    start = read_time(document, after[1]) if after is not None else None
    if start is not None and within is not None and part.first("APART") is None:
        number = written_time(like(exact(start + 1), start))
        yield f"Write within {number}", (written(within[1], number),)


def without_condition(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """Deletes a condition that says nothing."""
    word = part.first("ONLY_IF")
    if word is not None:
        yield "Delete the condition", (document.cut(word, part.tokens[-1]),)
    else:
        yield "Delete this statement", (document.deleted(part),)


def possible_number(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """The nearest number that can be assumed."""
    for word, kind in NUMBERED.items():
        found = part.pair(word)
        if found is not None:
            often = document.scenario.rest if kind.in_rests else 1
            nearest = written_time(like(exact(kind.nearest * often), read_time(document, found[1])))
            yield f"Write {found[0]} {nearest}", (written(found[1], nearest),)
    yield "Delete this statement", (document.deleted(part),)


def say_unit(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """Says what a unit of time is."""
    yield "Add unit second", (document.inserted("unit second"),)


def time_with_unit(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """A time, or a length, as it is written here, where the number is another one."""
    token = next((token for token in part.tokens if token.start_pos == at), None)
    if token is not None and token.type == "NUMBER":
        texts = (units.read(token).instead if has_unit(token) else units.apart(token) for units in (TIMES, LENGTHS))
        text = next(filter(None, texts), None)
        if text:
            yield f"Write {text}", (written(token, text),)
