"""What is wrong with a scenario that is well formed: every finding at once, in file order."""

from __future__ import annotations

import os
from dataclasses import replace
from fractions import Fraction
from typing import Any, Dict, FrozenSet, Iterable, Iterator, List, Optional, Sequence, Set, Tuple, Union

from pursue_gen.diagnostics import Diagnostic, Severity, Span, error, in_order, listed, warning
from pursue_gen.language.assumption_checks import check_assumptions
from pursue_gen.language.batteries import check_batteries
from pursue_gen.language.behaviour import check_events, check_rules, components
from pursue_gen.language.condition_checks import check_conditions, check_unknown
from pursue_gen.language.labels import check_labels
from pursue_gen.language.lifts import check_doors, check_lifts, is_said
from pursue_gen.language.loads import check_loads
from pursue_gen.language.names import check_names, check_references, events_used
from pursue_gen.language.numbers import MOST_DIGITS, exact, is_fine
from pursue_gen.language.parser import Reading, read, read_text, without_errors
from pursue_gen.language.pose_checks import check_poses
from pursue_gen.language.scenario import Agent, Connection, Scenario
from pursue_gen.language.syntax import MOST_FINDINGS, too_many
from pursue_gen.language.times import in_units, written_time
from pursue_gen.language.tokens import shown

_OF_THE_WHOLE = frozenset(("PML105", "PML130", "PML131", "PML132", "PML171", "PML190"))
"""Codes of findings that need a scenario that was read as a whole."""

_UNREAD = frozenset(("PML014", "PML280", "PML420"))
"""Codes of findings on numbers that could not be read."""

MOST_OPTIONAL = 6
"""So many different numbers stand behind `optional` at most: each takes a game of its own."""

_LONGEST = 10_000_000
"""The longest time of a movement in time units: ten times that must fit a solver's 32 bits."""


def load(path: Union[str, os.PathLike[str]]) -> Scenario:
    """The scenario in a file, checked. Raises PursueError with every error; warnings are left to `check`."""
    file = os.fspath(path)
    return checked(read_text(file), file)


def checked(text: str, file: str, name: Optional[str] = None) -> Scenario:
    """The scenario in a text, checked. Raises PursueError as `load`; `file` and `name` as for `parse`."""
    reading = read(text, file, name)
    return without_errors(reading.scenario, check_reading(reading))


def check(scenario: Scenario) -> Tuple[Diagnostic, ...]:
    """Every error and warning about a scenario, in file order; those about its text (poses, objectives) too."""
    findings = read(scenario.text, scenario.file, scenario.name).diagnostics if scenario.text else ()
    return check_reading(Reading(scenario, findings, scenario))


def check_reading(reading: Reading) -> Tuple[Diagnostic, ...]:
    """Every finding about a text that was read.

    Where statements could not be read, the others are looked at as far as that makes sense: what seems to be missing
    may stand in one of those.
    """
    scenario = reading.partial
    findings: List[Diagnostic] = list(reading.diagnostics)
    if not reading.whole or {f.code for f in findings} & {"PML003", "PML018"}:
        return reading.diagnostics
    findings += check_names(scenario)
    findings += check_references(scenario, reading.lost)
    for check_part in (
        check_labels, _beside, _alone, _units, _starts, _too_long, _too_fine, _connections, _travels, _missing, _order
    ):  # fmt: skip
        findings += check_part(scenario)
    codes = {f.code for f in findings}
    if reading.scenario is None:
        return _presentable(in_order(_of_what_was_read(reading, (f for f in findings if f.code not in _OF_THE_WHOLE))))
    if not codes & {"PML103", "PML104"}:  # the rest stands on names that mean one thing
        doubtful = _doubtful(scenario) if "PML110" in codes else frozenset()
        findings += [finding for finding in check_events(scenario) if finding.code not in doubtful]
        if "PML110" not in codes:
            findings += check_rules(scenario)
            of_loads = list(check_loads(scenario))
            if not {f.code for f in of_loads} & {"PML340", "PML342", "PML345"}:  # conditions stand on loads
                findings += check_conditions(scenario)
                findings += check_assumptions(scenario)
            for check_part in (check_poses, check_doors, check_lifts, check_unknown, check_batteries):
                findings += check_part(scenario)
            findings += of_loads
        if not any(f.severity is Severity.ERROR for f in findings):
            findings += _islands(scenario)
    findings = list(dict.fromkeys(findings))  # a statement may be several objectives
    return _presentable(in_order(_of_what_was_read(reading, findings)))


def _of_what_was_read(reading: Reading, findings: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
    """Without what checks find in the line of a number that could not be read: they saw another one in its place."""
    unread = {f.span.line for f in reading.diagnostics if f.code in _UNREAD and f.span is not None}
    return (f for f in findings if f in reading.diagnostics or f.span is None or f.span.line not in unread)


def _presentable(findings: Tuple[Diagnostic, ...]) -> Tuple[Diagnostic, ...]:
    """The first MOST_FINDINGS findings with printable texts: names may hold any character, and be long."""
    findings = tuple(replace(f, message=shown(f.message, 300), hint=shown(f.hint, 900)) for f in findings)
    rest = findings[MOST_FINDINGS:]
    if not any(f.severity is Severity.ERROR for f in rest):
        return findings
    return (*findings[:MOST_FINDINGS], too_many(rest[0].span))


def _doubtful(scenario: Scenario) -> FrozenSet[str]:
    """The codes of findings that may be no more than the consequence of a name that is declared nowhere (a typo)."""
    events, pois = {event.name for event in scenario.events}, {poi.name for poi in scenario.pois}
    places = [name for way in scenario.connections for name in (way.a, way.b)]
    places += [ref.name for agent in scenario.agents for ref in agent.starts]
    places += [event.location.name for event in scenario.events if event.location is not None]
    codes: Set[str] = set() if events_used(scenario) <= events else {"PML157"}
    if not all(ref.name in events for agent in scenario.agents for ref in agent.can_do):
        codes |= {"PML150", "PML154"}
    if not all(ref.name in events for agent in scenario.agents for ref in agent.reacts_to):
        codes |= {"PML151", "PML154"}
    if not pois.issuperset(places):
        codes |= {"PML153", "PML154"}
    return frozenset(codes)


def _alone(scenario: Scenario) -> Iterator[Diagnostic]:
    """What is wrong with single statements."""
    parts = (*scenario.pois, *scenario.connections, *scenario.events, *scenario.states, *scenario.agents)
    for part in (*scenario.units, *scenario.rests, *scenario.doors, *scenario.lifts, *parts, *scenario.travels):
        yield from part.check()


def _units(scenario: Scenario) -> Iterator[Diagnostic]:
    """A unit of time, or a rest, that is said twice."""
    for more in scenario.rests[1:]:
        message = f"{scenario.rests[0].span.in_words} says already how long agents rest"
        yield error("PML425", message, more.span, "delete one of the two: it is the same for all agents")
    for again in scenario.units[1:]:
        message = f"{scenario.units[0].span.in_words} says already what a unit of time is"
        yield error("PML422", message, again.span, "delete one of the two; times may have other units: 2 min, 8 h")


def _starts(scenario: Scenario) -> Iterator[Diagnostic]:
    """Agents that start where they may never be, or that are on patrol from a place that is not known."""
    for patrol in scenario.patrols:
        for agent in (each for each in scenario.on_patrol(patrol) if each.is_somewhere):
            message = f"{agent.name} is on patrol, and starts at {agent.starts_text}: nobody knows what it has visited"
            yield error("PML441", message, patrol.span, f"let {agent.name} start at one place, or let others patrol")
    for agent in scenario.agents:
        closed = scenario.closed_places(agent.name)
        for start in (ref for ref in agent.starts if ref.name in closed):
            message = f"{agent.name} starts in {start.name}, which is not for {agent.name}"
            hint = f"let it start somewhere else, or let poi {start.name} be for {agent.name}, too"
            yield error("PML149", message, start.span, hint)


def _too_long(scenario: Scenario) -> Iterator[Diagnostic]:
    longest = max((way.distance for way in scenario.connections), default=0)
    for agent in scenario.agents:
        if agent.mobile is not None and longest * agent.mobile > _LONGEST:
            message = f"{agent.name} takes more than {_LONGEST} time units for the longest way"
            yield error("PML144", message, agent.span, "choose a larger unit of time or of distance")


def _too_fine(scenario: Scenario) -> Iterator[Diagnostic]:
    """Ways on which an agent needs a time with too many digits after the point."""
    for agent in scenario.agents:
        if not isinstance(agent.mobile, Fraction):  # then no time has more digits than the author wrote
            continue
        if agent.speed is not None:
            yield from _rounded(scenario, agent)
            continue
        for (a, b), (time, _) in scenario.movements(agent).items():
            if not is_fine(time):
                digits = f"more than {MOST_DIGITS} digits after the point"
                message = f"{agent.name} needs {time} time units from {a} to {b}: {digits}"
                rounded = exact(max(round(Fraction(time), MOST_DIGITS), Fraction(1, 10**MOST_DIGITS)))
                hint = f"round its mobile or the distance, or write travel {agent.name} from {a} to {b} takes {rounded}"
                yield error("PML281", message, agent.span, hint)
                break


def _rounded(scenario: Scenario, agent: Agent) -> Iterator[Diagnostic]:
    """A way whose time, which comes of a speed, is rounded."""
    own = {travel.way for travel in scenario.travels if travel.agent.name == agent.name}
    for way in scenario.ways_of(agent.name):
        time = exact(way.distance * (agent.mobile or 0))
        for a, b in way.directions:
            if (a, b) not in own and not is_fine(time):
                low, high = (written_time(in_units(end, scenario.unit)) for end in agent.window_on(way.distance))
                about = written_time(in_units(exact(round(Fraction(time), MOST_DIGITS)), scenario.unit))
                message = f"{agent.name} needs about {about} from {a} to {b}: {low} to {high} is taken"
                hint = f"that is on the safe side; for another window write travel {agent.name} from {a} to {b} takes …"
                yield warning("PML424", message, agent.span, hint)
                return


def _travels(scenario: Scenario) -> Iterator[Diagnostic]:
    agents = {agent.name: agent for agent in scenario.agents}
    pois = {poi.name for poi in scenario.pois}
    ways = {way for connection in scenario.connections for way in connection.directions}
    seen: Dict[Tuple[str, Tuple[str, str]], Span] = {}
    for travel in scenario.travels:
        agent, (a, b) = agents.get(travel.agent.name), travel.way
        if agent is not None and agent.mobile is None:
            message = f"{agent.name} does not move, so it does not go from {a} to {b}"
            yield error("PML201", message, travel.span, f"write mobile 1 behind {agent.name}, or delete this line")
        elif travel.way not in ways and {a, b} <= pois:
            back = f" (it is one_way, from {b} to {a})" if (b, a) in ways else ""
            message = f"no way leads from {a} to {b}{back}"
            hint = f"connect them: connect {a} and {b} distance …, or delete this line"
            yield error("PML201", message, travel.span, hint)
        elif agent is not None and travel.way in ways and travel.way not in scenario.movements(agent):
            message = f"{agent.name} never goes from {a} to {b}: the way, or one of its ends, is not for {agent.name}"
            hint = f"let it be for {agent.name}, too, or delete this line"
            yield error("PML201", message, travel.span, hint)
        elif (travel.agent.name, travel.way) in seen:
            message = f"{seen[travel.agent.name, travel.way].in_words} says already how long {travel.movement} takes"
            yield error("PML202", message, travel.span, "delete one of the two lines")
        seen.setdefault((travel.agent.name, travel.way), travel.span)


def _connections(scenario: Scenario) -> Iterator[Diagnostic]:
    """Places that are connected twice for an agent."""
    seen: Dict[Tuple[str, str], List[Connection]] = {}
    for way in scenario.connections:
        known = [other for direction in way.directions for other in seen.get(direction, ()) if way.a != way.b]
        for other in known:
            both = [agent.name for agent in scenario.agents if way.admits(agent.name) and other.admits(agent.name)]
            if both or not (way.whom_words or other.whom_words):
                yield _twice(way, other, both)
                break
        for direction in way.directions:
            seen.setdefault(direction, []).append(way)


def _twice(way: Connection, other: Connection, both: Sequence[str]) -> Diagnostic:
    """The error on two ways between two places, which `both` may take."""
    message, hint = f"{way.a} and {way.b} are connected twice", "write one_way behind both"
    if way.whom_words or other.whom_words:
        message += f" for {listed(both)}"
        hint = f"write behind one for whom it is, and behind the other except {', '.join(both)}"
    message += f"; {other.span.in_words} does it already"
    return error("PML146", message, way.span, f"delete one: a connection goes both ways; or {hint}")


def _missing(scenario: Scenario) -> Iterator[Diagnostic]:
    """What a scenario needs and has not."""
    if not scenario.pois:
        yield error("PML132", "the scenario has no POI", _end(scenario), 'add a place: poi "room"')
    if not scenario.agents:
        hint = 'add one: agent "bot" controllable mobile 1 location a can_do …'
        yield error("PML130", "the scenario has no agent", _end(scenario), hint)
    elif not any(agent.controllable for agent in scenario.agents):
        message = "nobody in this scenario can be controlled: there is nothing to plan"
        yield error("PML131", message, scenario.agents[0].span, "write controllable behind the name of each robot")
    if not scenario.objectives:
        hint = "add one: reach_objective: do e after 0, or objective: if e1 then e2 within 20"
        yield error("PML171", "the scenario has no objective", _end(scenario), hint)


def _beside(scenario: Scenario) -> Iterator[Diagnostic]:
    """Objectives that stand there twice or contradict each other, and those that can never be reached as they stand."""
    yield from _optional(scenario)
    yield from _ends(scenario)
    places: Dict[str, Span] = {}
    statements = [statement[0] for statement in scenario.statements]
    for objective in sorted(statements, key=lambda each: (each.span.line, each.span.column)):
        text = objective.text
        if text in places:
            message = f"the same objective stands in {places[text].in_words} already"
            if len(objective.statement(scenario.objectives).objectives) > 1:
                message = f"{next(objective.names())[1].name} stands twice in this patrol"
            yield error("PML220", message, objective.span, "delete one of the two")
        places.setdefault(text, objective.span)
    for objective in statements:
        yield from objective.check()
    start = {agent.name: {ref.name for ref in agent.starts} for agent in scenario.agents}
    for safety in scenario.safety:
        first, second = safety.breaks.pair or ("", "")
        both = start.get(first, set()) & start.get(second, set()) if first != second else set()
        at = next((place for place in sorted(both) if safety.breaks.place in (None, place)), None)
        if at is not None:
            message = f"{first} and {second} both start in {at}: the objective is lost before anything moves"
            yield error("PML174", message, safety.span, "let one of them start somewhere else")
    avoided = {each.breaks.event.name: each for each in scenario.safety if each.breaks.event is not None}
    for reach in scenario.reach:
        for ref in reach.events:
            if ref.name in avoided:
                message = f"{ref.name} is to be done, and {avoided[ref.name].span.in_words} has it avoided"
                yield error("PML221", message, ref.span, "delete one of the two, or name another event")


def _optional(scenario: Scenario) -> Iterator[Diagnostic]:
    """Something has to be met in any case, and each number behind optional is a game to solve."""
    if scenario.objectives and all(each.optional for each in scenario.objectives):
        hint = "delete the optional of what matters most; whoever gives that up as well has nothing left to do"
        yield error("PML301", "every objective is optional", scenario.objectives[0].span, hint)
    for span in dict.fromkeys(each.span for each in scenario.patrols if each.optional and each.every is None):
        message = "an optional patrol without every: the least period is found for what has to be promised"
        yield error("PML303", message, span, "write how often, as in every 60, or delete optional")
    for number in scenario.optional[MOST_OPTIONAL:]:
        first = next(each for each in scenario.objectives if each.optional == number)
        message = f"more than {MOST_OPTIONAL} different numbers behind optional"
        hint = "objectives with one number are kept or given up together: use a number for several of them"
        yield error("PML302", message, first.span, hint)


def _ends(scenario: Scenario) -> Iterator[Diagnostic]:
    """An end of the mission beside another one, or one that never comes."""
    for end in scenario.ends:
        yield from end.check()
        if end is not scenario.ends[0]:
            message = f"{scenario.ends[0].span.in_words} says already when the mission ends"
            yield error("PML330", message, end.span, "delete one of the two")
        elif scenario.reach:
            message = "a mission with a reach_objective ends when all of them are reached"
            yield error("PML330", message, end.span, "delete this line; for a deadline write within behind do")
        elif end.answered and not any(each.is_answered for each in scenario.safety):
            message = "nothing has to be answered: there is no objective with if and then"
            hint = "write mission ends after …, or add an objective: if e1 then e2 within 20"
            yield error("PML331", message, end.span, hint)


def _order(scenario: Scenario) -> Iterator[Diagnostic]:
    """The original's tools read a scenario in one order only."""
    parts: Dict[str, Tuple[Any, ...]] = {
        "poi": scenario.pois, "connect": scenario.connections, "event": scenario.events, "rule": scenario.rules,
        "state": scenario.states, "stateDependency": scenario.dependencies, "agent": scenario.agents,
        "objective": tuple(each for each in scenario.objectives if is_said(scenario, each)),
    }  # fmt: skip
    order = list(parts)
    ranked = [(rank, part.span) for rank, kind in enumerate(parts.values()) for part in kind]
    latest = 0
    for rank, span in sorted(ranked, key=lambda one: (one[1].line, one[1].column, one[0])):
        if rank < latest:
            message = f"the original PuRSUE reads {order[rank]} statements only before {order[latest]} statements"
            yield warning("PML190", message, span, "if that matters to you, move it up; here the order is free")
            return
        latest = rank


def _islands(scenario: Scenario) -> Iterator[Diagnostic]:
    """POIs that are not connected with the first one, where somebody moves."""
    if not any(agent.mobile is not None for agent in scenario.agents):
        return
    connected = components(scenario)
    start = scenario.pois[0].name
    reached = {connected[start]}
    for poi in scenario.pois:
        if connected[poi.name] not in reached:
            message = f"no way leads from {start} to {poi.name}"
            yield warning("PML147", message, poi.span, f"connect it: connect {poi.name} and … distance …")
            reached.add(connected[poi.name])


def _end(scenario: Scenario) -> Optional[Span]:
    """Where something that is missing would be added: the end of the text."""
    lines = scenario.text.split("\n")
    return Span(scenario.file, len(lines), len(lines[-1]) + 1, len(lines), len(lines[-1]) + 2)
