"""What happens in a mission, as a trace for formulas of temporal logic; and random plays that follow no strategy."""

from __future__ import annotations

import functools
import random
from typing import Iterable, List, Mapping, NamedTuple, Optional, Set

from pursue_gen.language import network_names as names
from pursue_gen.language.scenario import Scenario
from pursue_runtime.locations import is_movement, is_under_way, place_of
from pursue_runtime.model import Model, Position
from pursue_runtime.zones import holds
from tests.assumptions import free_model
from tests.scenarios.temporal_logic import Letter, Trace

TICK = 0.5
"""Time units between two moments of a random play; all its times are multiples of it."""


class Happening(NamedTuple):
    """Something that happened: the moment (time units), the event's word and who did it ("": the start), and where
    automata are and which values variables have then."""

    at: float
    event: str
    agent: str
    locations: Mapping[str, str]
    values: Mapping[str, int]


def trace(scenario: Scenario, happenings: Iterable[Happening], end: float, complete: bool) -> Trace:
    """The mission as a trace. Its atoms: places (a robot arrives there, or starts there), events (they happen, or end
    if they have a duration), states that are true, and `at(agent, place)`, `doing(agent, event)`, `begins(agent)`."""
    letters: List[Letter] = []
    before: Mapping[str, str] = {}
    for happening in happenings:
        letters.append(Letter(happening.at, frozenset(_atoms(scenario, happening, before))))
        before = happening.locations
    return Trace(tuple(letters), end, complete)


def _atoms(scenario: Scenario, now: Happening, before: Mapping[str, str]) -> Set[str]:
    pois = [poi.name for poi in scenario.pois]
    found = {event.name for event in scenario.events if names.has_happened(event) == now.event}
    found |= {state.name for state in scenario.states if now.values[names.state_value(state.name)] == 1}
    for agent in scenario.agents:
        here, there = now.locations[agent.name], before.get(agent.name, "")
        if not is_movement(here):
            found.add(f"at({agent.name}, {place_of(here, pois)})")
            if agent.is_robot and (not there or is_movement(there)):
                found.add(here)
        found |= {
            f"doing({agent.name}, {event.name})"
            for event in scenario.events
            if here in {names.doing(event.name, poi) for poi in pois}
        }
        instantly = now.agent == agent.name and now.event in {event.name for event in scenario.events}
        if (there and here != there and is_under_way(here)) or instantly:
            found.add(f"begins({agent.name})")
    return found


@functools.lru_cache(maxsize=None)
def model(text: str) -> Model:
    """The model of a scenario, whether or not it can be won."""
    return free_model(text)


def random_play(scenario: Scenario, seed: int, length: float) -> Optional[Trace]:
    """What happens where robots do anything, up to `length` time units; None where an objective is not met."""
    there, draw = model(scenario.text), random.Random(f"{scenario.name} {seed}")
    zeal = {each.name: draw.choice((0.02, 0.2, 0.5, 0.9)) for each in there.automata}
    position, now = there.initial(), 0.0
    too_late = {edge.word for name, place in there.bad for edge in there.automaton(name).edges if edge.target == place}
    happenings = [Happening(now, "", "", position.locations, position.values)]
    while now < length and not _at_all(there, position):
        aged = position.aged(TICK)
        fits = all(holds(there.bounds_of(each, at, aged.values), aged.clocks) for each, at in aged.locations.items())
        if _is_lost(there, position):
            return None
        some = [there.joint_move(position, word) for word in there.possible(position) if word not in too_late]
        eager = [moves for moves in some if moves and (not fits or draw.random() < zeal[moves[0].automaton])]
        if eager:
            moves = draw.choice(eager)
            position = there.after(moves, position)
            mover, edge = moves[0]
            happenings.append(Happening(now, edge.word, mover, position.locations, position.values))
        elif fits:
            position, now = aged, now + TICK
        else:
            return None  # nobody moves, and time is up: nothing that could be met
    if scenario.reach and not _at_all(there, position):
        return None
    return trace(scenario, happenings, now, complete=bool(scenario.reach))


def _is_lost(there: Model, position: Position) -> bool:
    """True where an objective is broken, or its automaton says so next."""
    edges = ((name, place, edge) for name, place in there.bad for edge in there.automaton(name).edges)
    return any(
        position.locations[name] == edge.source and edge.sync == "own" and not edge.controllable
        and edge.allowed(position.values) and holds(edge.when, position.clocks)
        for name, place, edge in edges
        if edge.target == place
    )  # fmt: skip


def _at_all(there: Model, position: Position) -> bool:
    """True where the goal is reached."""
    return bool(there.goal) and all(position.locations[name] == place for name, place in there.goal)
