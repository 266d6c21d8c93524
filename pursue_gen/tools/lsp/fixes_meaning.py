"""Quick fixes for scenarios that can be read, but do not make sense."""

from __future__ import annotations

import difflib
import re
from typing import Iterator, List, Optional, Tuple

from pursue_gen.diagnostics import Diagnostic, PursueError
from pursue_gen.language.behaviour import destinations_from
from pursue_gen.language.edits import Edit
from pursue_gen.language.messages import MAY_BE_NAMES, RESERVED
from pursue_gen.language.poses import robots_in
from pursue_gen.language.usable import proposal, well_formed
from pursue_gen.tools.lsp.document import Document
from pursue_gen.tools.lsp.edits import bare as _bare
from pursue_gen.tools.lsp.edits import behind as _behind
from pursue_gen.tools.lsp.edits import cut as _cut
from pursue_gen.tools.lsp.edits import first as _token
from pursue_gen.tools.lsp.edits import pair as _pair
from pursue_gen.tools.lsp.edits import written
from pursue_gen.tools.lsp.navigation import rename
from pursue_gen.tools.lsp.statements import deleted, inserted, ordered
from pursue_gen.tools.lsp.tokens import Occurrence, Statement, end_of

Proposal = Tuple[str, Tuple[Edit, ...]]
_EXAMPLE = re.compile(r"for example (\w+)")
_MOST = 3
_DECLARATIONS = {
    "POI": 'poi "{}"',
    "event": 'event "{}"',
    "rule": 'rule "{}": ',
    "state": 'state "{}": initially false',
    "agent": 'agent "{}" location {}',
}


def fitting_name(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """Renames to the example that the finding gives, everywhere; people may still read the old name."""
    example = _EXAMPLE.search(finding.hint)
    if example is not None:
        try:
            edits = rename(document, at + 1, example.group(1))
        except PursueError:
            return  # that name is taken
        yield f"Rename it to {example.group(1)}", edits
        if finding.code == "PML101" and " label " in finding.hint and part is not None and part.name is not None:
            labelled = Edit(end_of(part.name), end_of(part.name), f" label {part.name}")
            yield f"Rename it to {example.group(1)}, with label {part.name}", (*edits, labelled)


def delete_statement(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """Deletes the statement."""
    if part is not None:
        yield "Delete this statement", deleted(document, part)


def unknown_name(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """A name like it, or a declaration of it."""
    if part is None or finding.span is None:
        return
    start, end = document.positions.of_span(finding.span)
    for occurrence in _uses(document, part):
        known = document.declared[occurrence.kind]
        if occurrence.name in known or not start <= occurrence.start <= end:
            continue
        for close in difflib.get_close_matches(occurrence.name, filter(well_formed, known), n=_MOST):
            yield f"Write {close}", (Edit(occurrence.start, occurrence.end, close),)
        elsewhere = any(occurrence.name in names for names in document.declared.values())
        places = list(document.declared["POI"])
        if not elsewhere and occurrence.kind != "rule" and (places or occurrence.kind != "agent"):
            statement = _DECLARATIONS[occurrence.kind].format(occurrence.name, *places[:1])
            if proposal(occurrence.name, RESERVED) == occurrence.name:
                yield f"Declare it: {statement}", inserted(document, statement)


def add_agent(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """A robot that starts at the first place and can do every event."""
    places, events = list(document.declared["POI"]), list(document.declared["event"])
    if places:
        can_do = " can_do " + ", ".join(events) if events else ""
        statement = f'agent "{_new_name(document, "bot")}" controllable mobile 1 location {places[0]}{can_do}'
        yield f"Add a robot at {places[0]}", inserted(document, statement)


def add_poi(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """A place."""
    statement = f'poi "{_new_name(document, "room")}"'
    yield f"Add {statement}", inserted(document, statement)


def add_objective(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """To achieve one of the events: the last of them first, which is often what all the others lead to."""
    done = {ref.name for agent in document.scenario.agents for ref in agent.can_do}
    events = [event.name for event in document.scenario.events if event.name in done]
    for name in list(reversed(events))[:_MOST]:
        yield f"Add the objective to achieve {name}", inserted(document, f"reach_objective: do {name}")


def add_controllable(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """Makes one of the agents a robot."""
    for agent in [part for part in document.statements if part.kind == "AGENT"][:_MOST]:
        if agent.name is not None:
            after = next((token for token in agent.tokens if token.type == "HUMAN"), agent.name)
            yield f"Make {_bare(agent.name)} controllable", (_behind(after, " controllable"),)


def one_instead_of_zero(
    document: Document, finding: Diagnostic, part: Optional[Statement], at: int
) -> Iterator[Proposal]:
    """The smallest number that there may be; or nothing, where the number may be left out."""
    word = {"PML140": "DISTANCE", "PML141": "DURATION", "PML142": "MOBILE", "PML143": "WITHIN"}[finding.code]
    pair = _pair(part, word)
    if pair is None:
        return
    yield f"Write {pair[0]} 1", (written(pair[1], "1"),)
    if word in ("DURATION", "MOBILE"):
        means = "it takes no time" if word == "DURATION" else "it does not move"
        yield f"Delete {pair[0]}: {means}", (_cut(document, pair[0], pair[1]),)


def connect_island(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """A way to the place that none leads to."""
    first = next(iter(document.declared["POI"]), None)
    if part is not None and part.name is not None and first is not None:
        statement = f"connect {first} and {_bare(part.name)} distance 1"
        yield f"Add a way: {statement}", inserted(document, statement)


def give_event(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """Lets an agent do the event: robots first."""
    if part is None or part.name is None:
        return
    event = _bare(part.name)
    agents = [agent for agent in document.statements if agent.kind == "AGENT" and agent.name is not None]
    for agent in sorted(agents, key=lambda a: not a.has("CONTROLLABLE"))[:_MOST]:
        yield f"Let {_bare(agent.name)} do {event}", (_listed(agent, "CAN_DO", event),)


def use_event(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """Lets an agent do the event, or deletes it."""
    yield from give_event(document, finding, part, at)
    yield from delete_statement(document, finding, part, at)


def find_partner(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """Lets another agent react to the event, or makes it one that needs no partner."""
    if part is None or part.name is None:
        return
    event = _bare(part.name)
    doers = {agent.name for agent in document.scenario.agents if any(ref.name == event for ref in agent.can_do)}
    others = [a for a in document.statements if a.kind == "AGENT" and a.name is not None and _bare(a.name) not in doers]
    for agent in others[:_MOST]:
        yield f"Let {_bare(agent.name)} react to {event}", (_listed(agent, "REACTS_TO", event),)
    first = _token(part, "COLLABORATIVE")
    if first is not None:
        yield f"Let {event} need no partner", (_cut(document, first, _token(part, "TOGETHER") or first),)


def make_collaborative(
    document: Document, finding: Diagnostic, part: Optional[Statement], at: int
) -> Iterator[Proposal]:
    """Makes the event that an agent reacts to one that needs a partner."""
    here = document.occurrence_at(at)
    event = document.declared["event"].get(here.name) if here is not None else None
    if here is not None and event is not None:
        name = document.statements[event.statement].name
        if name is not None:
            yield f"Make {here.name} collaborative", (_behind(name, " collaborative"),)
        yield from delete_listed(document, finding, part, at)


def do_together(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """Keeps the partners busy until the event ends."""
    token = _token(part, "COLLABORATIVE")
    if token is not None and part is not None:
        yield f"Let both be busy until {_bare(part.name)} ends", (_behind(token, " together"),)


def without_together(
    document: Document, finding: Diagnostic, part: Optional[Statement], at: int
) -> Iterator[Proposal]:
    """Adds what `together` lacks, or deletes it."""
    together = _token(part, "TOGETHER")
    if part is None or part.name is None or together is None:
        return
    if _token(part, "COLLABORATIVE") is not None:
        yield "Delete together", (_cut(document, together, together),)
        last = next((k for k, token in enumerate(part.tokens) if token.type == "AT_MOST"), len(part.tokens)) - 1
        yield "Add a duration", (_behind(part.tokens[last], " duration 1"),)
    else:
        yield "Delete together", (_cut(document, together, together),)
        yield f"Make {_bare(part.name)} collaborative", (_behind(part.name, " collaborative"),)


def get_there(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """Gets an agent to the place of an event that it never reaches, or takes the event away from it."""
    here = document.occurrence_at(at)
    agent = next((a for a in document.scenario.agents if part is not None and _is(a.name, part)), None)
    event = next((e for e in document.scenario.events if here is not None and e.name == here.name), None)
    if part is None or part.name is None or agent is None or event is None or event.location is None:
        return
    place, start = event.location.name, agent.location.name
    if agent.mobile is None:
        after = [token for token in part.tokens if token.type in ("NAME", "HUMAN", "CONTROLLABLE")][-1]
        if place in destinations_from(document.scenario, start):
            yield f"Make {agent.name} mobile", (_behind(after, " mobile 1"),)
        location = agent.location.span
        yield f"Let {agent.name} start in {place}", (Edit(*document.positions.of_span(location), place),)
    else:
        statement = f"connect {start} and {place} distance 1"
        yield f"Add a way: {statement}", inserted(document, statement)
    yield from delete_listed(document, finding, part, at)


def not_own_partner(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """Takes the event that an agent both does and reacts to out of its reactions."""
    if part is None:
        return
    done: List[str] = []
    for occurrence in _uses(document, part):
        if occurrence.kind == "event" and occurrence.name in done:
            yield from delete_listed(document, finding, part, occurrence.start)
            return
        done.append(occurrence.name)


def delete_listed(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """Takes a name out of a list, with its comma; the last one with the word before the list."""
    if part is None:
        return
    index = next((i for i, token in enumerate(part.tokens) if token.start_pos == at), None)
    if index is None:
        return
    before, token = part.tokens[index - 1], part.tokens[index]
    after = part.tokens[index + 1] if index + 1 < len(part.tokens) else None
    if before.type != "COMMA" and after is not None and after.type == "COMMA":
        edit = Edit(at, part.tokens[index + 2].start_pos or 0, "") if index + 2 < len(part.tokens) else None
    else:
        edit = _cut(document, before, token)
    if edit is not None:
        yield f"Take {token} out of this list", (edit,)


def delete_spot(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """Deletes the pose of one agent behind that of the place, with its name and what separates it."""
    for token in part.tokens if part is not None else ():
        start = token.start_pos or 0
        for name, begin, end in robots_in(str(token)) if token.type == "POSE" else ():
            if start + begin == at:
                before = document.text[:at].rstrip(", \t")
                yield f"Delete this pose of {name}", (Edit(len(before), start + end, ""),)


def human_ally(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """A person who follows instructions, or the word deleted."""
    human = next((token for token in part.tokens if token.type == "HUMAN"), None) if part is not None else None
    if human is not None:
        yield "Make this person an ally who follows instructions", (_behind(human, " controllable"),)
        yield "Delete human", (_cut(document, human, human),)


def sort_statements(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """All statements in the original's order."""
    yield "Put all statements in the original's order", ordered(document)


def _uses(document: Document, part: Statement) -> Iterator[Occurrence]:
    number = document.statements.index(part)
    return (o for o in document.occurrences if o.statement == number and not o.declares)



def _is(name: str, part: Statement) -> bool:
    return _bare(part.name) == name






def _listed(agent: Statement, word: str, event: str) -> Edit:
    """Adds an event to one of an agent's two lists."""
    at = next((i for i, token in enumerate(agent.tokens) if token.type == word), None)
    if at is not None:
        last = at
        while last + 1 < len(agent.tokens) and agent.tokens[last + 1].type in ("WORD", "COMMA", *MAY_BE_NAMES):
            last += 1
        return _behind(agent.tokens[last], f", {event}")
    behind = agent.tokens[-1]
    if word == "CAN_DO" and agent.has("REACTS_TO"):
        index = next(i for i, token in enumerate(agent.tokens) if token.type == "REACTS_TO")
        behind = agent.tokens[index - 1]
    return _behind(behind, f" {word.lower()} {event}")


def _new_name(document: Document, name: str) -> str:
    """The name, or with a number behind it the first one that is not taken."""
    taken = {known for names in document.declared.values() for known in names}
    return next(new for new in (name, *(f"{name}{n}" for n in range(2, 10_000))) if new not in taken)
