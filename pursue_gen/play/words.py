"""A table in plain words: who is where, what is due, what may happen."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Dict, Iterator, List, Mapping, Tuple

from pursue_gen.explanation import network_words
from pursue_gen.explanation.policy import Window
from pursue_gen.explanation.words import time_text
from pursue_gen.language.scenario import Avoid, NeverWith, Respond, Scenario
from pursue_gen.play.table import LOST, WON, Board, Deed, Table, overdue
from pursue_gen.synthesis.game import JointMove
from pursue_gen.tga import names
from pursue_gen.tga.network import Edge, Network
from pursue_gen.tga.positions import directions


@dataclass(frozen=True)
class Words:
    """The words of one scenario: those of reports (`network`), and commands ("set off from a to b") by
    (automaton, channel or "", location left by a step of its own)."""

    network: network_words.Words
    orders: Mapping[Tuple[str, str, str], str]

    def order(self, owner: str, edge: Edge) -> str:
        """The command for this edge of that automaton."""
        key = (owner, edge.sync.channel, "") if edge.sync else (owner, "", edge.source)
        return self.orders.get(key, self.network.move(owner, edge))


def words_of(scenario: Scenario, network: Network) -> Words:
    """The words of a scenario and its network."""
    orders: Dict[Tuple[str, str, str], str] = {}
    ways = [way for connection in scenario.connections for way in directions(connection)]
    for agent in scenario.agents:
        for event in scenario.events:
            orders[agent.name, event.name, ""] = f"{'do' if event.duration is None else 'begin'} {event.name}"
            orders[agent.name, names.done(event.name), ""] = f"finish {event.name}"
        for a, b in ways:
            orders[agent.name, names.movement(agent.name, a, b), ""] = f"set off from {a} to {b}"
            orders[agent.name, "", names.going(a, b)] = f"arrive at {b}"
    return Words(network_words.words_of(scenario, network), orders)


# What there is --------------------------------------------------------------------------------------------------------


def situation(board: Board, words: Words, table: Table) -> Iterator[str]:
    """Where everybody is, what lasts and until when, the states, the rules' turns, the deadline."""
    where = {automaton.name: k for k, automaton in enumerate(board.game.automata)}
    widest = max(map(len, board.agents), default=0)
    for agent in board.agents:
        place = board.game.automata[where[agent]].locations[table.here.state.locations[where[agent]]]
        yield f"  {agent:<{widest}}  {words.network.place(agent, place)}{_lasting(board, table, where[agent])}"
    values = dict(zip(board.game.variables, table.here.state.values))
    for state in board.scenario.states:
        value = values.get(names.state_value(state.name), int(state.initially))
        yield f"  {state.name} is {'true' if value else 'false'}"
    for rule in board.scenario.rules:
        yield f"  rule {rule.name}: {_place(board, words, table, rule.name)}"
    yield from (f"  {line}" for line in _objective(board, table, where))


def _lasting(board: Board, table: Table, number: int) -> str:
    """Between which moments a movement or an action ends."""
    game, here = board.game, table.here
    place = here.state.locations[number]
    bounds = game.automata[number].invariants[place]
    if not bounds:
        return ""
    clock, high = bounds[0]
    begun = table.now - here.clocks[clock - 1]
    lows = [e.duration for e in (game.edges[k] for k in game.automata[number].edges) if e.source == place]
    low = begun + max(lows, default=0)
    verb = "arrives" if names.is_going(game.automata[number].locations[place]) else "ends"
    return f" since {time_text(begun)}; {verb} between {time_text(low)} and {time_text(begun + (high >> 1))}"


def _objective(board: Board, table: Table, where: Mapping[str, int]) -> Iterator[str]:
    safety, clocks = board.scenario.safety, dict(zip(board.game.clocks, table.here.clocks))
    if isinstance(safety, Respond):
        number = where[names.OBJECTIVE]
        place = board.game.automata[number].locations[table.here.state.locations[number]]
        if place == names.AT_RISK:
            due = table.now - clocks[names.CLOCK_OBJECTIVE] + safety.deadline
            yield f"deadline: {safety.response.name} by {time_text(due)} at the latest"
    reach = board.scenario.reach
    if reach is not None and reach.after and table.now <= reach.after:
        yield f"{reach.event.name} counts after {reach.after}"


def deed_text(board: Board, words: Words, deed: Deed) -> str:
    """A step that was made."""
    said = words.network.move(deed.agent, board.game.origins[deed.edges[0]])
    return said if deed.agent not in board.agents else f"{deed.agent} {said}"


def move_text(board: Board, words: Words, move: JointMove) -> str:
    """A step that will be made: who, and what."""
    owner = board.owner(move)
    said = words.network.move(owner, board.game.origins[move.edges[0]])
    return said if owner not in board.agents else f"{owner} {said}"


def window_text(now: Fraction, open_: Window) -> str:
    """When something can be done: `now`, `now, until 4`, `after 3`, `after 3, until 4`."""
    high = "" if open_.high is None else f"{'before' if open_.high_open else 'until'} {time_text(now + open_.high)}"
    if open_.holds(Fraction(0)):
        return f"now, {high}" if high else "now or later"
    low = f"{'after' if open_.low_open else 'from'} {time_text(now + open_.low)}{'' if open_.low_open else ' on'}"
    return f"{low}, {high}" if high else low


# The end --------------------------------------------------------------------------------------------------------------


def ending(board: Board, words: Words, table: Table) -> str:
    """How a game ended, in a sentence."""
    at = time_text(table.now)
    if table.status == WON:
        what = f": {board.scenario.reach.event.name}" if board.scenario.reach else ""
        return f"The robots have done it after {at} time units{what}."
    if table.status == LOST:
        return f"The robots have lost after {at} time units: {_lost(board, words, table)}."
    late = ", ".join(overdue(board, table))
    return f"Nothing can go on after {at} time units: {late} ought to move and cannot. The robots have not lost."


def _lost(board: Board, words: Words, table: Table) -> str:
    safety, late = board.scenario.safety, overdue(board, table)
    if isinstance(safety, Respond) and names.OBJECTIVE in (*late, table.deeds[-1].agent if table.deeds else ""):
        return f"no {safety.response.name} within {safety.deadline} of {safety.trigger.name}"
    if late:
        doing = ", ".join(f"{name} ({_place(board, words, table, name)})" for name in late)
        return f"{doing} ought to be done by now and cannot be, so nothing goes on"
    if isinstance(safety, Avoid):
        return f"{safety.event.name} has happened, which was to be avoided"
    if isinstance(safety, NeverWith):
        place = _place(board, words, table, safety.first.name)
        return f"{safety.first.name} and {safety.second.name} are together, both {place}"
    return "the objective is broken"


def _place(board: Board, words: Words, table: Table, name: str) -> str:
    for automaton, location in zip(board.game.automata, table.here.state.locations):
        if automaton.name == name:
            return words.network.place(name, automaton.locations[location])
    return name


def overview(board: Board, words: Words, table: Table) -> Iterator[str]:
    """The map in text: each POI with who is there, and its ways with their distances; then who is on the way."""
    at: Dict[str, List[str]] = {}
    for agent in board.agents:
        at.setdefault(_place(board, words, table, agent), []).append(agent)
    widest = max((len(poi.name) for poi in board.scenario.pois), default=0)
    for poi in board.scenario.pois:
        ways = [
            f"{c.b if c.a == poi.name else c.a} ({c.distance})"
            for c in board.scenario.connections
            if poi.name in (c.a, c.b)
        ]
        there = [a for place, people in at.items() if f" {place}".endswith(f" at {poi.name}") for a in people]
        here = f"   here: {', '.join(there)}" if there else ""
        yield f"  {poi.name:<{widest}}  to {', '.join(ways) or 'nowhere'}{here}"
    for place, people in at.items():
        if place.startswith("on the way"):
            yield f"  {place}: {', '.join(people)}"
