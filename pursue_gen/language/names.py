"""Names: each is declared once, for one kind of thing, and can stand in a ROS package, a topic, Python and UPPAAL."""

from __future__ import annotations

from typing import Container, Dict, FrozenSet, Iterator, List, Mapping, Optional, Tuple

from pursue_gen.diagnostics import Diagnostic, Span, error
from pursue_gen.language.collisions import check_collisions
from pursue_gen.language.conditions import names_in
from pursue_gen.language.kinds import RESERVED, STATEMENTS
from pursue_gen.language.labels import LABELLED, why_no_label
from pursue_gen.language.scenario import Ref, Scenario
from pursue_gen.language.similar import Similar, closest
from pursue_gen.language.tokens import shown
from pursue_gen.language.usable import LONGEST, fitting, proposal, reserved, well_formed

_LISTED_IN = {kind.declares: kind.listed_in for kind in STATEMENTS.values() if kind.declares}
KINDS = tuple(_LISTED_IN)
"""The kinds of things that have names."""

_SOME = 12  # known names that a message lists
_COMPARED = 200  # names in broken statements among which a similar one is looked for


def declared(scenario: Scenario, kind: str) -> Dict[str, Span]:
    """The names of one of KINDS with the place of their first declaration."""
    places: Dict[str, Span] = {}
    for part in getattr(scenario, _LISTED_IN[kind]):
        places.setdefault(part.name, part.span)
    return places


def check_names(scenario: Scenario) -> Iterator[Diagnostic]:
    """Findings about declared names: their form, names declared twice, names that collide with generated ones."""
    yield from _file_name(scenario)
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
    meant = {proposal(name, RESERVED, taken) for kind in KINDS for name in known[kind] if not well_formed(name)}
    for kind, ref in _uses(scenario):
        name = ref.name
        if name in known[kind] or name in lost or name in meant:
            continue
        elsewhere = next((other for other in KINDS if name in known[other]), "")
        if elsewhere:
            message = f"{name} is {_a(elsewhere)}, but {_a(kind)} is needed here"
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
        another = f'declare {_a(kind)} with another name: {kind.lower()} "…"'
        return f"write the name of {_a(kind)}: {some}" if some else another
    better = proposal(name, RESERVED, taken)
    declare = "declare it" if better == name else "declare it with another name"
    return f'{declare}: {kind.lower()} "{better}", or use one of: ' + (some or "(none yet)")


def _usable(name: str, taken: Container[str]) -> str:
    """A declared name, or what is proposed for it if it is malformed."""
    return name if well_formed(name) else proposal(name, RESERVED, taken)


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


def _file_name(scenario: Scenario) -> Iterator[Diagnostic]:
    if not well_formed(scenario.name):
        package = shown(scenario.name, 60) + "_bringup"
        message = f"the file's name gives the package {package}, which is no name for a ROS package"
        hint = f"rename the file to {fitting(scenario.name)}.pur: letters, digits and _, a letter first"
        yield error("PML106", message, None, hint)


def _unfit(kind: str, name: str, span: Span, taken: Container[str]) -> Optional[Diagnostic]:
    """Why a name cannot be used; None: it can."""
    if not well_formed(name):
        hint = "use letters, digits and _, a letter first, for example " + proposal(name, RESERVED, taken)
        if kind in LABELLED and not why_no_label(name):
            better = proposal(name, RESERVED, taken)
            hint += f'; people can read it as a label: {kind.lower()} "{better}" label "{name}"'
        message = f'"{shown(name, 60)}" cannot become the name of a ROS topic or a Python name'
        return error("PML101", message, span, hint if name else "give it a name")
    if len(name) > LONGEST:
        return error("PML101", f"this name is longer than {LONGEST} letters", span, "choose a shorter name")
    why = reserved(name, RESERVED)
    if not why:
        return None
    return error("PML102", why, span, f"choose another name, for example {proposal(name, RESERVED, taken)}")


def _again(name: str, kind: str, span: Span, first_kind: str, first: Span) -> Diagnostic:
    if kind == first_kind:
        return error("PML103", f"{name} is declared twice; {first.in_words} declares it already", span, "delete one")
    message = f"{name} is {_a(kind)} here and {_a(first_kind)} in {first.in_words}: a name stands for one thing"
    return error("PML104", message, span, "choose another name for one of them")


def _a(kind: str) -> str:
    return ("an " if kind[0] in "ea" else "a ") + kind
