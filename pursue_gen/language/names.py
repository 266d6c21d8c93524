"""Names: each is declared once, for one kind of thing, and can stand in a ROS package, a topic, Python and UPPAAL."""

from __future__ import annotations

import difflib
import keyword
import re
from typing import Any, Dict, Iterable, Iterator, List, Optional, Tuple

from pursue_gen.diagnostics import Diagnostic, Span, error
from pursue_gen.language.messages import KEYWORDS
from pursue_gen.language.scenario import Ref, RuleBody, Scenario

KINDS = ("POI", "event", "rule", "state", "agent")
GENERATED = frozenset("observer UI controllerObj controller simulator reachObj obj states".split())
_UPPAAL = frozenset(
    "chan clock bool int commit const urgent broadcast init process state guard sync assign system trans deadlock "
    "imply forall exists typedef struct rate before_update after_update meta priority progress scalar select void "
    "default switch case enum string double hybrid dynamic spawn exit branchpoint".split()
)
_FORM = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_LONGEST = 60  # with what is added to it a name becomes a file name and a topic


def declared(scenario: Scenario, kind: str) -> Dict[str, Span]:
    """The names of one of KINDS with the place of their first declaration."""
    kinds: Dict[str, Tuple[Any, ...]] = {
        "POI": scenario.pois,
        "event": scenario.events,
        "rule": scenario.rules,
        "state": scenario.states,
        "agent": scenario.agents,
    }
    places: Dict[str, Span] = {}
    for part in kinds[kind]:
        places.setdefault(part.name, part.span)
    return places


def check_names(scenario: Scenario) -> Iterator[Diagnostic]:
    """Findings about declared names: their form, names declared twice, names that collide with generated ones."""
    yield from _file_name(scenario)
    seen: Dict[str, Tuple[str, Span]] = {}
    sound = True
    for kind, name, span in _declarations(scenario):
        finding = _unfit(name, kind, span)
        if finding is None and name in seen:
            finding = _again(name, kind, span, *seen[name])
        seen.setdefault(name, (kind, span))
        if finding is not None:
            sound = False
            yield finding
    if sound:
        yield from _collisions(scenario)


def check_references(scenario: Scenario) -> Iterator[Diagnostic]:
    """An error for each name that is used but not declared as what it is used for."""
    known = {kind: declared(scenario, kind) for kind in KINDS}
    for kind, name, span in _uses(scenario):
        if name in known[kind]:
            continue
        elsewhere = next((other for other in KINDS if name in known[other]), "")
        close = difflib.get_close_matches(name, list(known[kind]), n=1)
        if elsewhere:
            message = f"{name} is {_a(elsewhere)}, but {_a(kind)} is needed here"
        else:
            message = f"there is no {kind} {name}"
        if close:
            hint = f"did you mean {close[0]}?"
        else:
            hint = f'declare it: {_keyword(kind)} "{name}", or use one of: ' + (", ".join(known[kind]) or "(none yet)")
        yield error("PML110", message, span, hint)


def refs_of(body: RuleBody) -> List[Ref]:
    """The events that a rule names, from left to right."""
    return [body] if isinstance(body, Ref) else refs_of(body.first) + refs_of(body.second)


def _declarations(scenario: Scenario) -> List[Tuple[str, str, Span]]:
    """(kind, name, place) of each declaration, in file order, so that the later one of two is the one at fault."""
    parts: List[Tuple[str, str, Span]] = [("POI", poi.name, poi.span) for poi in scenario.pois]
    parts += [("event", event.name, event.span) for event in scenario.events]
    parts += [("rule", rule.name, rule.span) for rule in scenario.rules]
    parts += [("state", state.name, state.span) for state in scenario.states]
    parts += [("agent", agent.name, agent.span) for agent in scenario.agents]
    return sorted(parts, key=lambda part: (part[2].line, part[2].column))


def _uses(scenario: Scenario) -> Iterator[Tuple[str, str, Span]]:
    """(kind, name, place) of each use of a name."""

    def all_of(kind: str, refs: Iterable[Optional[Ref]]) -> Iterator[Tuple[str, str, Span]]:
        return ((kind, ref.name, ref.span) for ref in refs if ref is not None)

    for way in scenario.connections:
        yield "POI", way.a, way.span
        yield "POI", way.b, way.span
    for rule in scenario.rules:
        yield from all_of("event", refs_of(rule.body))
    yield from all_of("POI", [event.location for event in scenario.events])
    for state in scenario.states:
        yield from all_of("event", state.true_if + state.false_if)
    for dependency in scenario.dependencies:
        yield from all_of("event", [dependency.event])
        yield from all_of("state", [dependency.state])
    for agent in scenario.agents:
        yield from all_of("POI", [agent.location])
        yield from all_of("event", agent.can_do + agent.reacts_to)
    for objective in (scenario.safety, scenario.reach):
        for field in ("trigger", "response", "event"):
            yield from all_of("event", [getattr(objective, field, None)])
        for field in ("first", "second"):
            yield from all_of("agent", [getattr(objective, field, None)])


def _file_name(scenario: Scenario) -> Iterator[Diagnostic]:
    if not _FORM.fullmatch(scenario.name):
        message = f"the file's name gives the package {scenario.name}_bringup, which is no name for a ROS package"
        hint = f"rename the file to {_fitting(scenario.name)}.pur: letters, digits and _, a letter first"
        yield error("PML106", message, None, hint)


def _fitting(name: str) -> str:
    fitting = re.sub(r"[^A-Za-z0-9]+", "_", name).strip("_")
    return fitting if _FORM.fullmatch(fitting) else ("n_" + fitting).rstrip("_")


def _unfit(name: str, kind: str, span: Span) -> Optional[Diagnostic]:
    """Why a name cannot be used; None: it can."""
    another = "choose another name"
    if not _FORM.fullmatch(name):
        hint = f"use letters, digits and _, a letter first, for example {_fitting(name)}" if name else "give it a name"
        return error("PML101", f'"{name}" cannot become the name of a ROS topic or a Python name', span, hint)
    if len(name) > _LONGEST:
        return error("PML101", f"this name is longer than {_LONGEST} letters", span, "choose a shorter name")
    if name in GENERATED:
        return error("PML102", f"{name} is the name of a generated part of every mission", span, another)
    if name in KEYWORDS.values() and name != "human":
        return error("PML102", f"{name} is a word of the language and cannot be a name", span, another)
    if keyword.iskeyword(name):
        return error("PML102", f"{name} is a word of Python and cannot be a name", span, another)
    if name in _UPPAAL:
        return error("PML102", f"{name} is a word of UPPAAL's models and cannot be a name", span, another)
    if name.endswith("DONE"):
        return error("PML102", f"{name} ends in DONE, as the words for the ends of actions do", span, another)
    if name.startswith(("going_", "doing_")):
        message = f"{name} begins as the words for movements (going_…) and actions (doing_…) do"
        return error("PML102", message, span, another)
    return None


def _again(name: str, kind: str, span: Span, first_kind: str, first: Span) -> Diagnostic:
    if kind == first_kind:
        return error("PML103", f"{name} is declared twice; line {first.line} declares it already", span, "delete one")
    message = f"{name} is {_a(kind)} here and {_a(first_kind)} in line {first.line}: a name stands for one thing"
    return error("PML104", message, span, "choose another name for one of them")


def _a(kind: str) -> str:
    return ("an " if kind[0] in "ea" else "a ") + kind


def _keyword(kind: str) -> str:
    return kind.lower()


def _collisions(scenario: Scenario) -> Iterator[Diagnostic]:
    """Names that are fine alone, but from which the generator would make one word twice."""
    for words in (_network_words(scenario), _location_words(scenario), _package_words(scenario)):
        seen: Dict[str, str] = {}
        for word, meaning, span in words:
            if word in seen and seen[word] != meaning:
                message = f"{word} would mean both {seen[word]} and {meaning}"
                yield error("PML105", message, span, "rename one of them so that the two words differ")
                return  # one pair of names often collides in many words
            seen.setdefault(word, meaning)


def _ways(scenario: Scenario) -> Iterator[Tuple[str, str]]:
    for way in scenario.connections:
        yield way.a, way.b
        yield way.b, way.a


def _network_words(scenario: Scenario) -> Iterator[Tuple[str, str, Span]]:
    """Whatever shares the names of the network's declarations and of the system state: (word, its meaning, place)."""
    for poi in scenario.pois:
        yield poi.name, f"the POI {poi.name}", poi.span
    for event in scenario.events:
        yield event.name, f"the event {event.name}", event.span
        yield event.name + "DONE", f"the end of {event.name}", event.span
    for rule in scenario.rules:
        yield rule.name, f"the rule {rule.name}", rule.span
        yield "P" + rule.name, f"the position of the rule {rule.name}", rule.span
        yield "C" + rule.name, f"the clock of the rule {rule.name}", rule.span
    for state in scenario.states:
        yield state.name, f"the state {state.name}", state.span
        yield "S" + state.name, f"the value of the state {state.name}", state.span
    for agent in scenario.agents:
        yield agent.name, f"the agent {agent.name}", agent.span
        yield "P" + agent.name, f"the position of {agent.name}", agent.span
        yield "C" + agent.name, f"the clock of {agent.name}", agent.span
        for a, b in _ways(scenario) if agent.mobile is not None else ():
            yield f"{agent.name}_{a}2{b}", f"{agent.name} leaving {a} for {b}", agent.span
            yield f"{agent.name}_going_{a}_to_{b}2{b}", f"{agent.name} arriving at {b} from {a}", agent.span
    end = scenario.agents[-1].span if scenario.agents else Span(scenario.file, 1, 1, 1, 1)
    for word in ("Creach", "CreachObj", "PreachObj", "Cobj", "reachObj_going_initial_location2unlocked"):
        yield word, "a part of the objective", end


def _location_words(scenario: Scenario) -> Iterator[Tuple[str, str, Span]]:
    """The names of an agent's locations, with which its commands are found."""
    for way in scenario.connections:
        for a, b in ((way.a, way.b), (way.b, way.a)):
            yield f"going_{a}_to_{b}", f"the way from {a} to {b}", way.span
    for event in scenario.events:
        for poi in scenario.pois if event.duration is not None else ():
            yield f"doing_{event.name}_in_{poi.name}", f"{event.name} in {poi.name}", event.span


def _package_words(scenario: Scenario) -> Iterator[Tuple[str, str, Span]]:
    for agent in scenario.agents:
        yield f"controller_{agent.name}", f"the package of {agent.name}", agent.span
        yield f"{scenario.name}_bringup", "the package that starts the mission", agent.span
