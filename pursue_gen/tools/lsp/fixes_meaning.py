"""Quick fixes for scenarios that can be read, but do not make sense."""

from __future__ import annotations

import difflib
import re
from typing import Iterator, List, Tuple

from pursue_gen.diagnostics import Diagnostic, PursueError
from pursue_gen.language.behaviour import destinations_from
from pursue_gen.language.document import Edit, behind, rank, written
from pursue_gen.language.draft import Draft, rename
from pursue_gen.language.kinds import MAY_BE_NAMES, STATEMENTS
from pursue_gen.language.names import proposal, well_formed
from pursue_gen.language.occurrences import Occurrence
from pursue_gen.language.poses import robots_in
from pursue_gen.language.syntax import Statement
from pursue_gen.language.tokens import bare, end_of, start_of
from pursue_gen.tools.lsp.fixes_syntax import Proposals

_EXAMPLE = re.compile(r"for example (\w+)")
_MOST = 3
_SHORTEST = {kind.declares: kind.shortest for kind in STATEMENTS.values()}


def fitting_name(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """Renames to the example that the finding gives, everywhere; people may still read the old name."""
    example = _EXAMPLE.search(finding.hint)
    if example is not None:
        try:
            edits = rename(document, at + 1, example.group(1))
        except PursueError:
            return  # that name is taken
        yield f"Rename it to {example.group(1)}", edits
        if finding.code == "PML101" and " label " in finding.hint and part.name is not None:
            labelled = Edit(end_of(part.name), end_of(part.name), f" label {part.name}")
            yield f"Rename it to {example.group(1)}, with label {part.name}", (*edits, labelled)


def delete_statement(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """Deletes the statement."""
    if part.tokens:
        yield "Delete this statement", (document.deleted(part),)


def unknown_name(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """A name like it, or a declaration of it."""
    if finding.span is None:
        return
    start, end = document.lines.of_span(finding.span)
    for occurrence in _uses(document, part):
        known = document.declared[occurrence.kind]
        if occurrence.name in known or not start <= occurrence.start <= end:
            continue
        for close in difflib.get_close_matches(occurrence.name, filter(well_formed, known), n=_MOST):
            yield f"Write {close}", (Edit(occurrence.start, occurrence.end, close),)
        elsewhere = any(occurrence.name in names for names in document.declared.values())
        places = list(document.declared["POI"])
        shortest = _SHORTEST[occurrence.kind]
        if not elsewhere and shortest and (places or "{place}" not in shortest):
            statement = shortest.format(name=occurrence.name, place=next(iter(places), ""))
            if proposal(occurrence.name) == occurrence.name:
                yield f"Declare it: {statement}", (document.inserted(statement),)


def add_agent(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """A robot that starts at the first place and can do every event."""
    places, events = list(document.declared["POI"]), list(document.declared["event"])
    if places:
        can_do = " can_do " + ", ".join(events) if events else ""
        statement = f'agent "{_new_name(document, "bot")}" controllable mobile 1 location {places[0]}{can_do}'
        yield f"Add a robot at {places[0]}", (document.inserted(statement),)


def add_poi(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """A place."""
    statement = f'poi "{_new_name(document, "room")}"'
    yield f"Add {statement}", (document.inserted(statement),)


def add_objective(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """To achieve one of the events: the last of them first, which is often what all the others lead to."""
    done = {ref.name for agent in document.scenario.agents for ref in agent.can_do}
    events = [event.name for event in document.scenario.events if event.name in done]
    for name in list(reversed(events))[:_MOST]:
        yield f"Add the objective to achieve {name}", (document.inserted(f"reach_objective: do {name}"),)


def add_controllable(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """Makes one of the agents a robot."""
    for agent in [part for part in document.statements if part.kind == "AGENT"][:_MOST]:
        if agent.name is not None:
            after = agent.first("HUMAN") or agent.name
            yield f"Make {bare(agent.name)} controllable", (behind(after, " controllable"),)


def one_instead_of_zero(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """The smallest number that there may be; or nothing, where the number may be left out."""
    word = {"PML140": "DISTANCE", "PML141": "DURATION", "PML142": "MOBILE", "PML143": "WITHIN"}[finding.code]
    pair = part.pair(word)
    if pair is None:
        return
    yield f"Write {pair[0]} 1", (written(pair[1], "1"),)
    if word in ("DURATION", "MOBILE"):
        means = "it takes no time" if word == "DURATION" else "it does not move"
        yield f"Delete {pair[0]}: {means}", (document.cut(pair[0], pair[1]),)


def connect_island(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """A way to the place that none leads to."""
    first = next(iter(document.declared["POI"]), None)
    if part.name is not None and first is not None:
        statement = f"connect {first} and {bare(part.name)} distance 1"
        yield f"Add a way: {statement}", (document.inserted(statement),)


def give_event(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """Lets an agent do the event: robots first."""
    event = bare(part.name)
    agents = [agent for agent in document.statements if agent.kind == "AGENT" and agent.name is not None]
    for agent in sorted(agents, key=lambda a: not a.first("CONTROLLABLE"))[:_MOST]:
        yield f"Let {bare(agent.name)} do {event}", (_listed(agent, "CAN_DO", event),)


def use_event(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """Lets an agent do the event, or deletes it."""
    yield from give_event(document, finding, part, at)
    yield from delete_statement(document, finding, part, at)


def find_partner(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """Lets another agent react to the event, or makes it one that needs no partner."""
    event = bare(part.name)
    doers = {agent.name for agent in document.scenario.doers(event)}
    others = [a for a in document.statements if a.kind == "AGENT" and a.name is not None and bare(a.name) not in doers]
    for agent in others[:_MOST]:
        yield f"Let {bare(agent.name)} react to {event}", (_listed(agent, "REACTS_TO", event),)
    first = part.first("COLLABORATIVE")
    if first is not None:
        yield f"Let {event} need no partner", (document.cut(first, part.first("TOGETHER") or first),)


def make_collaborative(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """Makes the event that an agent reacts to one that needs a partner."""
    here = document.occurrence_at(at)
    event = document.declared["event"].get(here.name) if here is not None else None
    if here is not None and event is not None:
        name = document.statements[event.statement].name
        if name is not None:
            yield f"Make {here.name} collaborative", (behind(name, " collaborative"),)
        yield from delete_listed(document, finding, part, at)


def do_together(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """Keeps the partners busy until the event ends."""
    token = part.first("COLLABORATIVE")
    if token is not None:
        yield f"Let both be busy until {bare(part.name)} ends", (behind(token, " together"),)


def without_together(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """Adds what `together` lacks, or deletes it."""
    together = part.first("TOGETHER")
    if part.name is None or together is None:
        return
    if part.first("COLLABORATIVE") is not None:
        yield "Delete together", (document.cut(together, together),)
        behind_it = (k for k, token in enumerate(part.tokens) if token.type in ("AT_MOST", "ONLY_IF"))
        last = next(behind_it, len(part.tokens)) - 1
        yield "Add a duration", (behind(part.tokens[last], " duration 1"),)
    else:
        yield "Delete together", (document.cut(together, together),)
        yield f"Make {bare(part.name)} collaborative", (behind(part.name, " collaborative"),)


def get_there(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """Gets an agent to the place of an event that it never reaches, or takes the event away from it."""
    here = document.occurrence_at(at)
    agent = next((a for a in document.scenario.agents if a.name == bare(part.name)), None)
    event = next((e for e in document.scenario.events if here is not None and e.name == here.name), None)
    if agent is None or event is None or event.location is None:
        return
    place, start = event.location.name, agent.location.name
    if agent.mobile is None:
        after = [token for token in part.tokens if token.type in ("NAME", "HUMAN", "CONTROLLABLE")][-1]
        if place in destinations_from(document.scenario, start, agent.name):
            yield f"Make {agent.name} mobile", (behind(after, " mobile 1"),)
        location = agent.location.span
        yield f"Let {agent.name} start in {place}", (Edit(*document.lines.of_span(location), place),)
    else:
        statement = f"connect {start} and {place} distance 1"
        yield f"Add a way: {statement}", (document.inserted(statement),)
    yield from delete_listed(document, finding, part, at)


def not_own_partner(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """Takes the event that an agent both does and reacts to out of its reactions."""
    done: List[str] = []
    for occurrence in _uses(document, part):
        if occurrence.kind == "event" and occurrence.name in done:
            yield from delete_listed(document, finding, part, occurrence.start)
            return
        done.append(occurrence.name)


def delete_listed(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """Takes a name out of a list, with its comma; the last one with the word before the list."""
    index = next((i for i, token in enumerate(part.tokens) if token.start_pos == at), None)
    if index is None:
        return
    before, token = part.tokens[index - 1], part.tokens[index]
    after = part.tokens[index + 1] if index + 1 < len(part.tokens) else None
    if before.type != "COMMA" and after is not None and after.type == "COMMA":
        edit = Edit(at, start_of(part.tokens[index + 2]), "") if index + 2 < len(part.tokens) else None
    else:
        edit = document.cut(before, token)
    if edit is not None:
        yield f"Take {token} out of this list", (edit,)


def delete_spot(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """Deletes the pose of one agent behind that of the place, with its name and what separates it."""
    for token in part.tokens:
        start = start_of(token)
        for name, begin, end in robots_in(str(token)) if token.type == "POSE" else ():
            if start + begin == at:
                before = document.text[:at].rstrip(", \t")
                yield f"Delete this pose of {name}", (Edit(len(before), start + end, ""),)


def human_ally(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """A person who follows instructions, or the word deleted."""
    human = part.first("HUMAN")
    if human is not None:
        yield "Make this person an ally who follows instructions", (behind(human, " controllable"),)
        yield "Delete human", (document.cut(human, human),)


def sort_statements(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """All statements in the original's order."""
    yield "Put all statements in the original's order", ordered(document)


def _uses(document: Draft, part: Statement) -> Iterator[Occurrence]:
    number = next((number for number, one in enumerate(document.statements) if one is part), None)
    return (o for o in document.occurrences if o.statement == number and not o.declares)


def _listed(agent: Statement, word: str, event: str) -> Edit:
    """Adds an event to one of an agent's two lists."""
    at = next((i for i, token in enumerate(agent.tokens) if token.type == word), None)
    if at is not None:
        last = at
        while last + 1 < len(agent.tokens) and agent.tokens[last + 1].type in ("WORD", "COMMA", *MAY_BE_NAMES):
            last += 1
        return behind(agent.tokens[last], f", {event}")
    last = len(agent.tokens)
    if word == "CAN_DO":
        last = next((i for i, token in enumerate(agent.tokens) if token.type == "REACTS_TO"), last)
    return behind(agent.tokens[last - 1], f" {word.lower()} {event}")


def _new_name(document: Draft, name: str) -> str:
    """The name, or with a number behind it the first one that is not taken."""
    taken = {known for names in document.declared.values() for known in names}
    return next(new for new in (name, *(f"{name}{n}" for n in range(2, 10_000))) if new not in taken)


def fewer_things(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """An agent that carries what it does without a number; a thing that nothing takes deleted."""
    carries = part.pair("CARRIES")
    if carries is not None:
        yield "Delete carries", (document.cut(*carries),)
    elif part.kind == "THING":
        yield from delete_statement(document, finding, part, at)


def one_of_two_things(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """An event that takes a thing, or gives it, where it does both."""
    for word in map(part.first, ("GIVES", "TAKES")):
        if word is not None and part.first("MOUNTS") is None:
            thing = next(token for token in part.tokens[part.tokens.index(word) + 1 :] if token.type != "NUMBER")
            yield f"Delete {word} {thing}", (document.cut(word, thing),)


def take_or_give(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """Lets an agent do what takes, or mounts, the things of an event, or gives them; or not do the event."""
    token = next((token for token in part.tokens if token.start_pos == at), None)
    event = next((one for one in document.scenario.events if one.name == token), None)
    if event is None or part.name is None:
        return
    first = finding.code == "PML341"
    wanted = [ref.name for ref in ((event.gives, event.needs) if first else (event.takes,)) if ref is not None]
    for other in document.scenario.events:
        given = (other.takes, other.mounts) if first else (other.gives,)
        can_give = any(ref is not None and ref.name in wanted for ref in given)
        if can_give and other is not event and other.name not in part.tokens:
            yield f"Let {bare(part.name)} do {other.name}", (_listed(part, "CAN_DO", other.name),)
    yield from delete_listed(document, finding, part, at)


def ordered(document: Draft) -> Tuple[Edit, ...]:
    """The edit that brings the statements into the original's order; comments stay with the statement they precede.

    None where a statement cannot be read: its end is not known.
    """
    if document.reading.scenario is None:
        return ()
    pieces = _pieces(document)
    parts = [piece for piece in pieces if piece[0] >= 0]
    in_order = sorted(parts, key=lambda piece: piece[0])
    if parts == in_order:
        return ()
    text = "".join(piece[1] for piece in pieces if piece[0] < 0)
    for number, (at, piece) in enumerate(in_order):
        new_kind = number > 0 and at != in_order[number - 1][0]
        body = piece.strip("\n") if new_kind or number == 0 else piece.rstrip("\n").lstrip("\n")
        text += ("\n" if new_kind else "") + body + "\n"
    return (Edit(0, len(document.text), text),)


def _pieces(document: Draft) -> List[Tuple[int, str]]:
    """(rank, text) of each statement with the comments above it and behind it; -1 for the text's head."""
    found: List[Tuple[int, str]] = []
    at = 0
    for number, part in enumerate(document.statements):
        if number == 0:
            head = _head_end(document, part.start)
            if head:
                found.append((-1, document.text[:head]))
            at = head
        following = document.statements[number + 1].start if number + 1 < len(document.statements) else None
        end = document.line_end(part.end)
        end = len(document.text) if following is None else min(end + 1, following)
        if part.kind == "TAIL" and found:
            found[-1] = (found[-1][0], found[-1][1].rstrip("\n") + "\n" + document.text[at:end].lstrip("\n"))
        else:
            found.append((rank(part), document.text[at:end]))
        at = end
    return found


def _head_end(document: Draft, first: int) -> int:
    """Where the comment about the whole text ends: at the first empty line, if that is above the first statement."""
    gap = document.text.find("\n\n", 0, first)
    return gap + 2 if gap >= 0 and not document.in_comment(gap + 1) else 0
