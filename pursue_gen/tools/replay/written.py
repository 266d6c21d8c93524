"""Orders that people wrote during a mission: the game that has them, judged by its own reading of their texts."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any, Iterable, List, Mapping, Optional, Tuple

from pursue_gen.language.scenario import Scenario
from pursue_gen.language.symbols import Role, role_of
from pursue_gen.language.written_orders import NoOrder, event_names, with_written
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.event_words import event_word
from pursue_gen.tga.network import Automaton, Edge, Network
from pursue_gen.tools.replay.game import Game
from pursue_gen.tools.replay.record import MissionRecord
from pursue_runtime.state import WAITING, SystemState


def with_what_was_written(record: MissionRecord, game: Game) -> Tuple[MissionRecord, Game]:
    """The record and the game with all that was written during the mission; states have it from the start on, as what
    nobody has ordered yet."""
    try:
        there = with_orders(game, (record.plans.get(state.plan) for state in reversed(record.states)))
    except NoOrder as problem:
        problems = *record.problems, f"an order that was written cannot be read: {problem}"
        return replace(record, problems=problems), game
    return (record if there is game else _padded(record, there)), there


def with_orders(game: Game, plans: Iterable[Optional[Mapping[str, Any]]]) -> Game:
    """The game with what was written by the first of these plans that says that: the newest that was in force. Raises
    NoOrder."""
    said = next(filter(None, map(_said, plans)), [])
    known = {event.name for event in game.scenario.events}
    if known.issuperset(name for name, _, _ in said):
        return game
    scenario = with_written(game.scenario, [(says, within) for _, says, within in said])
    if event_names(game.scenario, len(said)) != tuple(name for name, _, _ in said):
        raise NoOrder("its event is not the one that this scenario gives it")
    network = _network(game.network, scenario)
    return replace(game, scenario=scenario, network=network, objective=scenario_objective(scenario))


def _said(plan: Optional[Mapping[str, Any]]) -> List[Tuple[str, str, Fraction]]:
    """Event, text and time of each order that was written by then."""
    try:
        return [_one(each) for each in plan["adds"]["written"]] if plan and "adds" in plan else []
    except (LookupError, TypeError, ValueError, OverflowError):
        return []


def _one(order: Mapping[str, Any]) -> Tuple[str, str, Fraction]:
    return str(order["event"]), str(order["says"]), Fraction(round(Fraction(float(order["within"])) * 1000), 1000)


def _network(network: Network, scenario: Scenario) -> Network:
    """The network that was played with what was written: what is new, and the steps that somebody hears of now."""
    whole = translate(scenario)
    heard = {
        (automaton.name, edge.source, edge.target): edge
        for automaton in whole.automata
        for edge in automaton.edges
        if edge.sync is not None and edge.sync.sends
    }
    known = {automaton.name for automaton in network.automata}
    desk = {automaton.name: automaton for automaton in whole.automata if role_of(automaton.name) is Role.ORDER_DESK}
    automata = [desk.get(each.name) or _heard(each, heard) for each in network.automata]
    automata += [each for each in whole.automata if each.name not in known]
    variables = dict((*whole.variables, *network.variables))
    return replace(
        network,
        clocks=tuple(dict.fromkeys((*network.clocks, *whole.clocks))),
        variables=tuple(variables.items()),
        channels=tuple(dict.fromkeys((*network.channels, *whole.channels))),
        automata=tuple(automata),
    )


def _heard(automaton: Automaton, heard: Mapping[Tuple[str, str, str], Edge]) -> Automaton:
    edges = []
    for edge in automaton.edges:
        now = heard.get((automaton.name, edge.source, edge.target)) if edge.sync is None else None
        alike = now is not None and event_word(automaton.name, now) == event_word(automaton.name, edge)
        edges.append(replace(edge, sync=now.sync) if now is not None and alike else edge)
    return replace(automaton, edges=tuple(edges))


def _padded(record: MissionRecord, game: Game) -> MissionRecord:
    """The record whose states have all automata, variables and clocks that were added."""
    first = game.moves.initial
    begun = next((state.stamp for state in record.states if state.status != WAITING), 0.0)

    def padded(state: SystemState) -> SystemState:
        passed = max(0.0, state.stamp - begun) / state.unit
        clocks = {**dict.fromkeys(game.network.clocks, passed), **state.clocks}
        return state._replace(
            locations={**first.locations, **state.locations}, values={**first.values, **state.values}, clocks=clocks
        )

    return replace(record, states=tuple(map(padded, record.states)))
