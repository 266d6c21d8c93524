"""A play in plain words: who is where, what is due, what may happen."""

from __future__ import annotations

from fractions import Fraction
from typing import Dict, Iterator, List, Mapping, Optional, Sequence

from pursue_gen.diagnostics import listed
from pursue_gen.explanation.policy import Window
from pursue_gen.language import network_names as names
from pursue_gen.language.conditions import condition_words
from pursue_gen.language.numbers import time_text
from pursue_gen.language.scenario import Connection, Scenario
from pursue_gen.language.symbols import Role, Symbol, role_of
from pursue_gen.language.times import unit_name, written_time
from pursue_gen.synthesis.game import Game
from pursue_gen.tga.objectives import clock_of, stated
from pursue_gen.tools.play.state import LOST, WON, PlayState, Setup
from pursue_gen.vocabulary.losses import loss
from pursue_gen.vocabulary.statuses import courses
from pursue_gen.vocabulary.words import Words

# What there is --------------------------------------------------------------------------------------------------------


def situation(setup: Setup, words: Words, play: PlayState) -> Iterator[str]:
    """Where the agents are, what lasts and until when, the states, the rules' turns, the deadline."""
    where = {automaton.name: k for k, automaton in enumerate(setup.game.automata)}
    shown = setup.scenario.shown
    widest = max((len(shown(agent)) for agent in setup.agents), default=0)
    for agent in setup.agents:
        place = setup.game.automata[where[agent]].locations[play.position.state.locations[where[agent]]]
        yield f"  {shown(agent):<{widest}}  {words.place(agent, place)}{_lasting(setup, play, where[agent])}"
    values = dict(zip(setup.game.variables, play.position.state.values))
    locations = {name: setup.game.automata[k].locations[play.position.state.locations[k]] for name, k in where.items()}
    for status in courses(setup.scenario, setup.network):
        text = status.text(locations, values)
        if text is not None:
            yield f"  {status.label}: {text}"
    yield from (f"  {line}" for line in _objective(setup, play, where))


def _lasting(setup: Setup, play: PlayState, number: int) -> str:
    """Between which moments a movement or an action ends."""
    game, here = setup.game, play.position
    place = here.state.locations[number]
    bounds = game.automata[number].invariants[place]
    if not bounds:
        doer = _doer(game, here.state.locations, number)
        return "" if doer is None else _lasting(setup, play, doer)
    clock, high = bounds[0]
    begun = play.now - here.clocks[clock - 1]
    ends = (game.edges[k] for k in game.automata[number].edges)
    lows = [Fraction(edge.duration, game.scale) for edge in ends if edge.source == place]
    low = begun + max(lows, default=Fraction(0))
    verb = "arrives" if role_of(game.automata[number].locations[place]) is Role.WAY else "ends"
    return f" since {time_text(begun)}; {verb} between {time_text(low)} and {time_text(begun + game.time(high))}"


def _doer(game: Game, places: Sequence[int], number: int) -> Optional[int]:
    """Who does what this agent takes part in until it ends; None where it does nothing together with others."""
    location = game.automata[number].locations[places[number]]
    if role_of(location) is not Role.WORK:
        return None
    others = (k for k, automaton in enumerate(game.automata) if automaton.locations[places[k]] == location)
    return next((k for k in others if game.automata[k].invariants[places[k]]), None)


def _objective(setup: Setup, play: PlayState, where: Mapping[str, int]) -> Iterator[str]:
    clocks = dict(zip(setup.game.clocks, play.position.clocks))
    for automaton, objective in stated(setup.scenario).items():
        number = where[automaton]
        place = setup.game.automata[number].locations[play.position.state.locations[number]]
        limit = objective.limit_in(place)
        if limit is not None:
            due = play.now - clocks[clock_of(automaton)] + limit
            yield f"deadline: {objective.words.due_by or objective.words.due} by {time_text(due)} at the latest"
    for k, reach in enumerate(setup.scenario.reach):
        number = where[names.reach_objective(k)]
        place = setup.game.automata[number].locations[play.position.state.locations[number]]
        if reach.after and play.now <= reach.after:
            yield f"{reach.words.due} counts after {written_time(reach.after)}"
        if reach.within is not None and place != names.WIN:
            done = {ref.name for ref in reach.done_in(place)}
            left = listed(ref.shown for ref in reach.events if ref.name not in done)
            yield f"deadline: {left} by {time_text(Fraction(reach.within))} at the latest"


def window_text(now: Fraction, open_: Window) -> str:
    """When something can be done: `now`, `now, until 4`, `after 3`, `after 3, until 4`."""
    high = "" if open_.high is None else f"{'before' if open_.high_open else 'until'} {time_text(now + open_.high)}"
    if open_.holds(Fraction(0)):
        return f"now, {high}" if high else "now or later"
    low = f"{'after' if open_.low_open else 'from'} {time_text(now + open_.low)}{'' if open_.low_open else ' on'}"
    return f"{low}, {high}" if high else low


# The end --------------------------------------------------------------------------------------------------------------


def ending(setup: Setup, play: PlayState) -> str:
    """How a game ended, in a sentence."""
    at, late = f"{time_text(play.now)} {unit_name(setup.scenario.unit)}", setup.overdue(play)
    if play.status == WON:
        done = dict.fromkeys(ref.shown for reach in setup.scenario.reach for ref in reach.events)
        what = f": {listed(done)}" if done else ""
        return f"The robots have done it after {at}{what}."
    if play.status == LOST:
        why = loss(setup.scenario, setup.game, play.position.state, late)
        return f"The robots have lost after {at}: {why}."
    who = ", ".join(map(setup.scenario.shown, late))
    return f"Nothing can go on after {at}: {who} ought to move and cannot. The robots have not lost."


def _only(scenario: Scenario, way: Connection) -> str:
    """Behind the length of a way: its doors, for whom it is, and while what it is open; nothing where it always is for
    all."""
    whom = "".join(f", {said}" for said in scenario.words_on(way))
    whom += f", {way.whom_words}" if way.whom_words else ""
    return whom if way.only_if is None else f"{whom}, only while {condition_words(way.only_if)}"


def overview(setup: Setup, words: Words, play: PlayState) -> Iterator[str]:
    """The map in text: each POI with who is there, and its ways with their distances; then who is on the way."""
    shown = setup.scenario.shown
    at: Dict[str, List[str]] = {}
    away: Dict[str, List[str]] = {}
    for automaton, number in zip(setup.game.automata, play.position.state.locations):
        if automaton.name not in setup.agents:
            continue
        location = automaton.locations[number]
        symbol = Symbol.of(location)
        is_away = symbol.role in (Role.WAY, Role.SOMEWHERE)
        group, key = (away, words.place(automaton.name, location)) if is_away else (at, symbol.parts[-1])
        group.setdefault(key, []).append(shown(automaton.name))
    widest = max((len(poi.shown) for poi in setup.scenario.pois), default=0)
    for poi in setup.scenario.pois:
        ways = [
            f"{shown(to)} ({written_time(c.distance)}{_only(setup.scenario, c)})"
            for c in setup.scenario.connections
            for a, to in c.directions
            if a == poi.name
        ]
        here = f"   here: {', '.join(at[poi.name])}" if poi.name in at else ""
        yield f"  {poi.shown:<{widest}}  to {', '.join(ways) or 'nowhere'}{here}"
    for place, people in away.items():
        yield f"  {place}: {', '.join(people)}"
