"""Names: each is declared once, for one kind of thing, and can stand in a ROS package, a topic, Python and UPPAAL; and
of two that are fine alone, the generator must not make one text for two things."""

from __future__ import annotations

import keyword
import re
import unicodedata
from itertools import chain, count
from typing import Container, Dict, FrozenSet, Iterator, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.diagnostics import Diagnostic, Span, an, error
from pursue_gen.language import network_names as names
from pursue_gen.language.conditions import names_in
from pursue_gen.language.kinds import RESERVED, STATEMENTS
from pursue_gen.language.labels import LABELLED, why_no_label
from pursue_gen.language.loads import carriers
from pursue_gen.language.objectives.endurance import batteries_in
from pursue_gen.language.scenario import Ref, Scenario
from pursue_gen.language.similar import Similar, closest
from pursue_gen.language.symbols import Role, Symbol
from pursue_gen.language.tokens import shown

GENERATED = frozenset("observer UI controllerObj controller simulator reachObj obj states".split())
_FORM = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
LONGEST = 60
"""Letters of a name: with what is added to it a name becomes a file name and a topic."""
_PREFIXES = ("going_", "doing_")

_LISTED_IN = {kind.declares: kind.listed_in for kind in STATEMENTS.values() if kind.declares}
KINDS = tuple(_LISTED_IN)
"""The kinds of things that have names."""

_Stated = Tuple[Span, Sequence[Symbol]]
"""The span of a statement, and the symbols that come from it."""

_SOME = 12  # known names that a message lists
_COMPARED = 200  # names in broken statements among which a similar one is looked for


def well_formed(name: str) -> bool:
    """True for a name that can stand in a ROS topic, Python and UPPAAL (whose own words get another name there)."""
    return _FORM.fullmatch(name) is not None


def reserved(name: str) -> str:
    """Why a well-formed name cannot be used; the empty string: it can."""
    if name in GENERATED:
        return f"{name} is the name of a generated part of every mission"
    if name in RESERVED:
        return f"{name} is a word of the language and cannot be a name"
    if keyword.iskeyword(name):
        return f"{name} is a word of Python and cannot be a name"
    if name.endswith("DONE"):
        return f"{name} ends in DONE, as the words for the ends of actions do"
    if name.startswith(_PREFIXES):
        return f"{name} begins as the words for movements (going_…) and actions (doing_…) do"
    return ""


def fitting(name: str) -> str:
    """A well-formed name like this one; it may be reserved, or too long."""
    letters = unicodedata.normalize("NFKD", name)
    plain = "".join(letter for letter in letters if not unicodedata.combining(letter))
    changed = re.sub(r"[^A-Za-z0-9]+", "_", plain).strip("_")
    return changed if well_formed(changed) else ("n_" + changed).rstrip("_")


def proposal(name: str, taken: Container[str] = ()) -> str:
    """A name like this one that the language accepts and that is not taken; if that is so, the name itself."""
    start = (name if well_formed(name) else fitting(name[:LONGEST]))[:LONGEST]
    while start.startswith(_PREFIXES):
        start = fitting(start[len(_PREFIXES[0]) :])
    numbered = (f"{start[: LONGEST - 6]}{number}" for number in count(1))
    return next(word for word in chain([start], numbered) if not reserved(word) and word not in taken)


def declared(scenario: Scenario, kind: str) -> Dict[str, Span]:
    """The names of one of KINDS with the place of their first declaration."""
    places: Dict[str, Span] = {}
    for part in getattr(scenario, _LISTED_IN[kind]):
        places.setdefault(part.name, part.span)
    return places


def check_names(scenario: Scenario) -> Iterator[Diagnostic]:
    """Findings about declared names: their form, names declared twice, names that collide with generated ones."""
    if not well_formed(scenario.name):
        package = shown(scenario.name, 60) + "_bringup"
        message = f"the file's name gives the package {package}, which is no name for a ROS package"
        hint = f"rename the file to {fitting(scenario.name)}.pur: letters, digits and _, a letter first"
        yield error("PML106", message, None, hint)
    seen: Dict[str, Tuple[str, Span]] = {}
    sound = True
    taken = _taken(scenario)
    for kind, name, span in _declarations(scenario):
        finding = _unfit(kind, name, span, taken)
        if finding is None and name in seen:
            finding = _again(name, kind, span, *seen[name])
        seen.setdefault(name, (kind, span))
        if finding is not None:
            sound = False
            yield finding
    if sound:
        yield from check_collisions(scenario)


def check_references(scenario: Scenario, lost: FrozenSet[str] = frozenset()) -> Iterator[Diagnostic]:
    """An error for each name that is used but not declared as what it is used for.

    Names that are `lost` in statements with errors may be declared there; the same holds for names that would be well
    formed if their declaration were.
    """
    known = {kind: declared(scenario, kind) for kind in KINDS}
    similar = {kind: Similar(known[kind]) for kind in KINDS}
    taken = _taken(scenario)
    meant = {proposal(name, taken) for kind in KINDS for name in known[kind] if not well_formed(name)}
    for kind, ref in _uses(scenario):
        name = ref.name
        if name in known[kind] or name in lost or name in meant:
            continue
        elsewhere = next((other for other in KINDS if name in known[other]), "")
        if elsewhere:
            message = f"{name} is {an(elsewhere)}, but {an(kind)} is needed here"
        else:
            message = f"there is no {kind} {shown(name, 60)}"
        yield error("PML110", message, ref.span, _instead(kind, name, elsewhere, known, similar[kind], lost, taken))


def _instead(
    kind: str,
    name: str,
    elsewhere: str,
    known: Mapping[str, Mapping[str, Span]],
    similar: Similar,
    lost: FrozenSet[str],
    taken: Container[str],
) -> str:
    """What to write in place of a name that is not known as this kind of thing."""
    declared = known[kind]
    agent, _, rest = name.partition("_")
    if kind == "event" and rest in declared and agent in known["agent"]:
        return f"write {rest}: an event is named without its agent"
    if kind == "event" and name[: -len("DONE")] in declared and name.endswith("DONE"):
        return f"write {name[: -len('DONE')]}: with an event that takes time, its end counts by itself"
    close = similar.to(name) or closest(name, tuple(sorted(lost)[:_COMPARED]))
    if close:
        capitals = " (capitals matter)" if close.lower() == name.lower() else ""
        return f"did you mean {_usable(close, taken)}?{capitals}"
    some = ", ".join(_usable(known, taken) for known in list(declared)[:_SOME])
    some += ", …" if len(declared) > _SOME else ""
    if elsewhere:
        another = f'declare {an(kind)} with another name: {kind.lower()} "…"'
        return f"write the name of {an(kind)}: {some}" if some else another
    better = proposal(name, taken)
    declare = "declare it" if better == name else "declare it with another name"
    return f'{declare}: {kind.lower()} "{better}", or use one of: ' + (some or "(none yet)")


def _usable(name: str, taken: Container[str]) -> str:
    """A declared name, or what is proposed for it if it is malformed."""
    return name if well_formed(name) else proposal(name, taken)


def _taken(scenario: Scenario) -> FrozenSet[str]:
    """The declared names."""
    return frozenset(name for kind in KINDS for name in declared(scenario, kind))


def events_used(scenario: Scenario) -> FrozenSet[str]:
    """The events that a rule, a state, a condition, an agent or an objective names."""
    return frozenset(ref.name for kind, ref in _uses(scenario) if kind == "event")


def _declarations(scenario: Scenario) -> List[Tuple[str, str, Span]]:
    """(kind, name, place) of each declaration, in file order, so that the later one of two is the one at fault."""
    parts = [(kind, part.name, part.span) for kind, field in _LISTED_IN.items() for part in getattr(scenario, field)]
    return sorted(parts, key=lambda part: (part[2].line, part[2].column))


def _uses(scenario: Scenario) -> Iterator[Tuple[str, Ref]]:
    """Each use of a name, behind the kind of thing that is needed there."""
    for kind in STATEMENTS.values():
        for part in getattr(scenario, kind.listed_in) if kind.listed_in else ():
            yield from part.names()
    for objective in scenario.objectives:
        yield from objective.names()
    for condition, _ in scenario.conditions():
        yield from names_in(condition)


def _unfit(kind: str, name: str, span: Span, taken: Container[str]) -> Optional[Diagnostic]:
    """Why a name cannot be used; None: it can."""
    if not well_formed(name):
        hint = "use letters, digits and _, a letter first, for example " + proposal(name, taken)
        if kind in LABELLED and not why_no_label(name):
            better = proposal(name, taken)
            hint += f'; people can read it as a label: {kind.lower()} "{better}" label "{name}"'
        message = f'"{shown(name, 60)}" cannot become the name of a ROS topic or a Python name'
        return error("PML101", message, span, hint if name else "give it a name")
    if len(name) > LONGEST:
        return error("PML101", f"this name is longer than {LONGEST} letters", span, "choose a shorter name")
    why = reserved(name)
    if not why:
        return None
    return error("PML102", why, span, f"choose another name, for example {proposal(name, taken)}")


def _again(name: str, kind: str, span: Span, first_kind: str, first: Span) -> Diagnostic:
    if kind == first_kind:
        return error("PML103", f"{name} is declared twice; {first.in_words} declares it already", span, "delete one")
    message = f"{name} is {an(kind)} here and {an(first_kind)} in {first.in_words}: a name stands for one thing"
    return error("PML104", message, span, "choose another name for one of them")




# What is generated ----------------------------------------------------------------------------------------------------


def check_collisions(scenario: Scenario) -> Iterator[Diagnostic]:
    """An error for each space of names in which a text would mean two things; one pair often collides in many texts."""
    for stated in (_in_network(scenario), _among_locations(scenario), _packages(scenario)):
        seen: Dict[str, Symbol] = {}
        clashes = (
            (seen[symbol], symbol, span)
            for span, symbols in stated
            for symbol in symbols
            if seen.setdefault(symbol, symbol) is not symbol and seen[symbol].meaning != symbol.meaning
        )
        for first, second, span in clashes:
            message = f"{second} would mean both {first.meaning} and {second.meaning}"
            yield error("PML105", message, span, "rename one of them so that the two words differ")
            break


def _in_network(scenario: Scenario) -> Iterator[_Stated]:
    """Whatever shares the names of the network's declarations and of the system state."""
    ways = [way for connection in scenario.connections for way in connection.directions]
    for agent in (agent for agent in scenario.agents if agent.mobile is not None):
        yield agent.span, [make(agent.name, *way) for way in ways for make in (names.movement, names.arrival)]
    yield from _numbered(scenario)
    yield from ((poi.span, [names.at(poi.name)]) for poi in scenario.pois)
    for event in scenario.events:
        yield event.span, [names.event(event.name), names.done(event.name)]
        yield event.span, [names.ORDER_DESK, names.DESK_OPEN] if event.on_order else []
        yield event.span, [names.broken_off(event.name)] if event.may_stop else []
        yield event.span, [names.busy(event.name)] if event.is_shared or event.split else []
        parts = (names.part_done(event.name), names.parts(event.name), names.parts_done(event.name))
        yield event.span, parts if event.split else []
        yield event.span, [names.count(event.name), names.times(event.name)] if event.at_most is not None else []
    for rule in scenario.rules:
        yield rule.span, [names.rule(rule.name), names.rule_turn(rule.name), names.rule_clock(rule.name)]
        yield rule.span, [names.own_turn(rule.name, agent.name) for agent in scenario.bound_by(rule)]
    for state in scenario.states:
        automaton = [names.finding(state.name), names.finding_clock(state.name)]
        automaton += [names.found(state.name, value) for value in (True, False)]
        yield state.span, automaton if state.is_found_out else [names.state(state.name)]
        yield state.span, [names.state_value(state.name)]
    for agent in scenario.agents:
        yield agent.span, [names.agent(agent.name), names.agent_position(agent.name), names.agent_clock(agent.name)]
        starts = [names.starts(agent.name, ref.name) for ref in agent.starts] if agent.is_somewhere else []
        yield agent.span, starts
        yield agent.span, [names.busy_with(agent.name)] if any(scenario.conditions()) else []
    yield from ((battery.span, [names.level(battery.agent.name)]) for battery in scenario.batteries)
    yield from ((carrier.agent.span, [names.load(carrier.agent.name)]) for carrier in carriers(scenario))


def _numbered(scenario: Scenario) -> Iterator[_Stated]:
    """What is made for objectives and assumptions, which have numbers and no names."""
    charged = dict(batteries_in(scenario.safety))
    for number, safety in enumerate(scenario.safety):
        automaton = names.safety_objective(number)
        turn = [names.safety_turn(number), names.safety_oldest(number)] if safety.order else []
        charge = [names.charge_clock(number)] if number in charged else []
        made = [automaton, names.safety_clock(number), names.safety_pause(number), *turn, *charge]
        yield safety.span, made
    for number, reach in enumerate(scenario.reach):
        made = [names.reach_objective(number), names.reach_clock(number), names.unlocking(number)]
        yield reach.span, [*made, *([] if reach.apart is None else [names.reach_apart(number)])]
    for number, assumption in enumerate(scenario.assumed, start=1):
        made = [names.assumption(number), names.assumption_count(number), names.assumption_clock(number)]
        yield assumption.span, [*made, names.assumed_way(number)]


def _among_locations(scenario: Scenario) -> Iterator[_Stated]:
    """The names of an agent's locations, with which its commands are found."""
    for way in scenario.connections:
        yield way.span, [names.going(a, b) for a, b in way.directions]
    for event in (event for event in scenario.events if event.duration is not None):
        yield event.span, [names.doing(event.name, poi.name) for poi in scenario.pois]


def _packages(scenario: Scenario) -> Iterator[_Stated]:
    for agent in scenario.agents:
        yield agent.span, [Role.PACKAGE(agent.name)]
    for agent in scenario.agents[:1]:
        yield agent.span, [Role.BRINGUP(scenario.name)]
