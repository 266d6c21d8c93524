"""A request for a plan: the game of a workspace and the state of its mission. Read from JSON, see docs/run_time.md."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache
from typing import Any, Dict, FrozenSet, Iterable, Iterator, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.diagnostics import PursueError, error
from pursue_gen.language.checks import checked
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.written_orders import NoOrder, WrittenOrder, with_written
from pursue_gen.solving.rules import CONTROLLABLE, REPORTED, Rules
from pursue_runtime.numbers import exact

_LONGEST = 1e9
"""The largest value of a clock, in time units."""


@dataclass(frozen=True)
class Request:
    """A plan is wanted for this scenario, from this place, by controllers of that shape (see `partition`).

    Clocks are in time units, `ahead` of which pass before the plan begins. Nothing is expected of the agents that are
    `excused`, nobody is sent along the ways in `blocked` (in alphabetical order; the agent behind a way, if there is
    one, alone is not), who is `turning` may be back at any time, and who is in `awaited` is late, and goes on within so
    many time units. It may take so many `seconds`, 0: any number. `follows`: the watchers and tours of the workspace's
    plan, in its lines; their automata are in the state. The plan may come into force up to `window` time units after
    its begin. `sooner`: the clocks that an order of a person has started, with how much sooner it is to be answered
    than the scenario promises. `shares`: the automata of robots that keep those promises by the workspace's plan, for
    each of its shares. `spread`: the state is foreseen, and by so much more or less its clocks may be: for each
    the parts of that, and those that two have in common are the same for both. Nothing is sent to the robots that are
    `out_of_service`. `written`: the orders that people have written, which the scenario has; `asked`: one that it does
    not have, which was written so many time units before the plan begins.
    """

    scenario: Scenario
    rules: Rules
    controllers: str
    reach_obj: str
    locations: Mapping[str, str]
    values: Mapping[str, int]
    clocks: Mapping[str, Fraction]
    ahead: Fraction
    excused: FrozenSet[str]
    blocked: FrozenSet[Tuple[str, ...]]
    turning: FrozenSet[str]
    awaited: Mapping[str, Fraction]
    seconds: float
    follows: Tuple[str, ...] = ()
    shares: Tuple[Tuple[FrozenSet[str], FrozenSet[str]], ...] = ()
    window: Fraction = Fraction(0)
    sooner: Mapping[str, Fraction] = field(default_factory=dict)
    spread: Mapping[str, Mapping[str, Fraction]] = field(default_factory=dict)
    out_of_service: FrozenSet[str] = frozenset()
    written: Tuple[WrittenOrder, ...] = ()
    asked: Optional[Tuple[WrittenOrder, Fraction]] = None


def read_request(data: object) -> Request:
    """The request in the JSON data. Raises PursueError (exit status 2) with what was expected where."""
    request = _object(data, "the request")
    _format(request, "the request")
    game = _object(_of(request, "game", "the request"), "game")
    _format(game, "game")
    name, text = _text(game, "name", "game"), _text(game, "scenario", "game")
    seconds = request.get("limit", 0.0)
    if "limit" in request and not (_is_number(seconds) and 0 < seconds < _LONGEST):
        raise wrong(f"limit is {_shown(seconds)}", "a number of seconds above 0, or none for a search without a limit")
    locations, values = (_object(_of(request, key, "the request"), key) for key in ("locations", "values"))
    for table, kind, what in ((locations, str, "the name of a location"), (values, int, "a whole number")):
        for key, value in table.items():
            if not isinstance(value, kind) or isinstance(value, bool):
                raise wrong(f"{key} is {_shown(value)}", what)
    clocks = _object(_of(request, "clocks", "the request"), "clocks")
    scenario = _scenario(name, text)
    scenario = scenario.giving_up(_numbers(game.get("given_up", ()), scenario))
    written = tuple(_written(each) for each in _list(request.get("written", ()), "written"))
    asked = request.get("asked")
    return Request(
        scenario=_with_written(scenario, written),
        rules=_rules(_object(_of(game, "rules", "game"), "rules")),
        controllers=_text(game, "controllers", "game"),
        reach_obj=_text(game, "reach_obj", "game"),
        locations=locations,
        values=values,
        clocks={key: _time(value, key) for key, value in clocks.items()},
        ahead=_time(_of(request, "ahead", "the request"), "ahead"),
        excused=_agents(_of(request, "excused", "the request"), "excused", scenario),
        blocked=_ways(request.get("blocked", ()), scenario),
        turning=_agents(request.get("turning", ()), "turning", scenario),
        awaited=_awaited(request.get("awaited"), scenario),
        seconds=float(seconds),
        follows=_lines(game.get("follows", ()), "follows", "a list of lines of a plan, [] for none"),
        shares=tuple(_shares(game.get("shares", ()))),
        window=_time(request.get("window", 0), "window"),
        sooner=_times(request, "sooner"),
        spread={key: _times(each, key) for key, each in _tables(request, "spread")},
        out_of_service=_agents(request.get("out_of_service", ()), "out_of_service", scenario),
        written=written,
        asked=None if asked is None else (_written(asked), _time(_object(asked, "asked").get("waited"), "waited")),
    )


def wrong(message: str, expected: str) -> PursueError:
    """What is wrong with a request."""
    return PursueError([error("RPL001", f"the request cannot be used: {message}", hint=f"expected {expected}")])


@lru_cache(maxsize=4)  # simulated missions look for many plans of one scenario
def _scenario(name: str, text: str) -> Scenario:
    try:
        return checked(text, f"{name}.pur", name)
    except PursueError as problem:  # its exit status is that of a scenario
        raise PursueError(problem.diagnostics) from None


def _numbers(data: object, scenario: Scenario) -> FrozenSet[int]:
    """The numbers of the optional objectives that are given up."""
    if not isinstance(data, (list, tuple)) or any(number not in scenario.optional for number in data):
        raise wrong(f"given_up is {_shown(data)}", f"a list of numbers behind optional: {scenario.optional}")
    return frozenset(data)


def _written(data: object) -> WrittenOrder:
    order = _object(data, "an order that was written")
    return _text(order, "says", "the order"), _time(_of(order, "within", "the order"), "within")


def _with_written(scenario: Scenario, orders: Tuple[WrittenOrder, ...]) -> Scenario:
    try:
        return with_written(scenario, orders)
    except NoOrder as problem:
        raise wrong(f"written: {problem}", "orders that were accepted") from None


def _list(data: object, name: str) -> Sequence[object]:
    if not isinstance(data, (list, tuple)):
        raise wrong(f"{name} is {_shown(data)}", "a list")
    return data


def _lines(data: object, name: str, expected: str) -> Tuple[str, ...]:
    if not isinstance(data, (list, tuple)) or not all(isinstance(line, str) for line in data):
        raise wrong(f"{name} is {_shown(data)}", expected)
    return tuple(data)


def _shares(data: object) -> Iterator[Tuple[FrozenSet[str], FrozenSet[str]]]:
    expected = "for each share a list of robots, and one of promises"
    for share in data if isinstance(data, (list, tuple)) else [None]:
        if not isinstance(share, (list, tuple)) or len(share) != 2:
            raise wrong(f"shares is {_shown(data)}", expected)
        robots, kept = (frozenset(_lines(names, "shares", expected)) for names in share)
        yield robots, kept


def _agents(data: object, name: str, scenario: Scenario) -> FrozenSet[str]:
    if not isinstance(data, (list, tuple)) or not all(isinstance(agent, str) for agent in data):
        raise wrong(f"{name} is {_shown(data)}", "a list of names of agents, [] for none")
    agents = [*(agent.name for agent in scenario.agents), *scenario.facts]
    for agent in sorted(set(data) - set(agents)):
        raise wrong(f"{agent} is {name}", f"agents: {', '.join(agents)}")
    return frozenset(data)


def _awaited(data: object, scenario: Scenario) -> Mapping[str, Fraction]:
    late = {} if data is None else _object(data, "awaited")
    return {name: _time(late[name], name) for name in sorted(_agents(list(late), "awaited", scenario))}


def _ways(data: object, scenario: Scenario) -> FrozenSet[Tuple[str, ...]]:
    known = {tuple(sorted((way.a, way.b))) for way in scenario.connections}
    behind = {(), *((agent.name,) for agent in scenario.agents)}
    found: List[Tuple[str, ...]] = []
    for way in data if isinstance(data, (list, tuple)) else [None]:
        names = way if isinstance(way, (list, tuple)) and all(isinstance(name, str) for name in way) else ()
        if tuple(sorted(names[:2])) not in known or tuple(names[2:]) not in behind:
            expected = "a list of pairs of places that are connected, some with an agent behind them; [] for none"
            raise wrong(f"blocked is {_shown(data)}", expected)
        found.append((*sorted(names[:2]), *names[2:]))
    return frozenset(found)


def _rules(data: Mapping[str, Any]) -> Rules:
    ends = _text(data, "ends", "rules")
    if ends not in (REPORTED, CONTROLLABLE):
        raise wrong(f"ends is {_shown(ends)}", f"{REPORTED} or {CONTROLLABLE}")
    slack = _object(data.get("slack", {}), "slack")
    for agent, late in slack.items():
        if not isinstance(late, int) or isinstance(late, bool) or late < 0:
            raise wrong(f"the slack of {agent} is {_shown(late)}", "a whole number of time units")
    given = _of(data, "reaction", "rules")
    try:
        reaction = exact(given)
    except ValueError:
        reaction = Fraction(-1)
    if not 0 <= reaction <= 1000 or reaction.denominator > 1000:
        raise wrong(f"reaction is {_shown(given)}", "a number of time units from 0 to 1000, such as 0.1 or 1/20")
    return Rules(ends, reaction, dict(slack))


def _object(data: object, name: str) -> Dict[str, Any]:
    if not isinstance(data, dict) or not all(isinstance(key, str) for key in data):
        raise wrong(f"{name} is {_shown(data)}", "an object with names")
    return data


def _format(data: Mapping[str, Any], name: str) -> None:
    if _of(data, "format", name) != 1:
        raise wrong(f"the format of {name} is {_shown(data['format'])}", "1: generate the workspace again")


def _of(data: Mapping[str, Any], key: str, name: str) -> Any:
    if key not in data:
        raise wrong(f"{name} has no {key}", f"it beside {', '.join(data) or 'nothing'}")
    return data[key]


def _text(data: Mapping[str, Any], key: str, name: str) -> str:
    value = _of(data, key, name)
    if not isinstance(value, str):
        raise wrong(f"{key} is {_shown(value)}", "text")
    return value


def _times(request: Mapping[str, Any], name: str) -> Dict[str, Fraction]:
    return {key: _time(value, key) for key, value in _object(request.get(name, {}), name).items()}


def _tables(request: Mapping[str, Any], name: str) -> Iterable[Tuple[str, Dict[str, Any]]]:
    return [(key, {key: _object(each, key)}) for key, each in _object(request.get(name, {}), name).items()]


def _time(value: Any, name: str) -> Fraction:
    """Exact to a millionth of a time unit: times that differ by less are equal."""
    if not _is_number(value) or not 0 <= value <= _LONGEST:
        raise wrong(f"{name} is {_shown(value)}", "a number of time units, 0 or more")
    return Fraction(round(Fraction(value) * 1_000_000), 1_000_000)


def _is_number(value: Any) -> bool:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return False
    return isinstance(value, int) or math.isfinite(value)


def _shown(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 40 else text[:37] + "..."
