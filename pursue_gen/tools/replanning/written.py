"""Orders that people write as an objective: what they are in the game, and what a mission's model has of them."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any, Dict, Iterator, List, Mapping

from pursue_gen.language import network_names as names
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.written_orders import NoOrder, event_names, with_written
from pursue_gen.solving.rules import played
from pursue_gen.synthesis.strategy import with_automata_of
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Network
from pursue_gen.tools.replanning.request import Request
from pursue_gen.tools.replanning.tours import followers
from pursue_gen.workspace.model_file import model_data
from pursue_runtime.model import ORDER_DESK, Model, Position
from pursue_runtime.observer.ordering import PersonOrder, effect

MOST_LONGER = 2
"""So many times as long an order may take of which it is looked at what could be promised, or so many times the longest
time of the game. Not measured."""


def with_asked(request: Request, longer: bool = False) -> Request:
    """The request from the state behind the order that it asks for. `longer`: with an objective that gives it much more
    time than is wanted. Raises NoOrder, and Refused where it cannot be taken."""
    if request.asked is None:
        return request
    (says, within), waited = request.asked
    game = _game(request, request.scenario)
    ahead = MOST_LONGER * max(Fraction(max(game.times)), within) - within if longer else Fraction(0)
    written = (*request.written, (says, within + ahead))
    before = _data(request, request.scenario)
    scenario = with_written(_alone(request), written)
    there = replace(request, scenario=scenario, written=written, asked=None)
    data = _data(there, scenario)
    _check_added(before, data)
    model = Model(data)
    clocks = {name: float(value) for name, value in request.clocks.items()}
    here = model.completed(Position(dict(request.locations), dict(request.values), clocks))
    done = effect(model, here, PersonOrder(event_names(_alone(request), len(written))[-1], None, 0.0, says))
    after = Model.after(done.moves, here)
    return replace(
        there,
        locations=after.locations,
        values=after.values,
        clocks={
            **dict.fromkeys(model.clocks, Fraction(0)), **request.clocks, **dict.fromkeys(done.clocks, ahead + waited)
        },
        sooner=dict.fromkeys(done.clocks, ahead),
    )


def additions(request: Request) -> Dict[str, Any]:
    """What the model of a mission has more than that of its workspace, with all orders that were written."""
    base = _alone(request)
    before, data = _data(request, base), _data(request, request.scenario)
    known = {each["name"]: each for each in before["automata"]}
    new = [each for each in data["automata"] if each["name"] not in known or each["kind"] == ORDER_DESK]
    events = event_names(base, len(request.written))
    return {
        "automata": new,
        "heard": [list(each) for each in _heard(known, data["automata"])],
        "clocks": [name for name in data["clocks"] if name not in before["clocks"]],
        "variables": {key: value for key, value in data["variables"].items() if key not in before["variables"]},
        "objective": _named(data["objective"], request),
        "written": [
            {"event": event, "says": says, "within": float(within)}
            for event, (says, within) in zip(events, request.written)
        ],
    }


def as_written(text: str, request: Request) -> str:
    """The text of objectives without the events of orders that were written."""
    for event in event_names(_alone(request), len(request.written)):
        text = text.replace(f"if {event} then ", "")
    return text


def _named(objective: Mapping[str, Any], request: Request) -> Dict[str, Any]:
    """What a model says of the objectives, without these events."""
    says = {name: as_written(text, request) for name, text in objective.get("says", {}).items()}
    promises = {name: dict(each) for name, each in objective.get("promises", {}).items()}
    for each in promises.values():
        each["says"] = as_written(each["says"], request)
    return {**objective, "says": says, "promises": promises}


def _alone(request: Request) -> Scenario:
    """The scenario without what people have written."""
    scenario, count = request.scenario, len(request.written)
    if not count:
        return scenario
    text = "".join(scenario.text.splitlines(keepends=True)[: -2 * count])
    return replace(scenario, events=scenario.events[:-count], safety=scenario.safety[:-count], text=text)


def _game(request: Request, scenario: Scenario) -> Network:
    game = played(translate(scenario), request.rules)
    return with_automata_of(game, followers(game, request))


def _data(request: Request, scenario: Scenario) -> Dict[str, Any]:
    network = _game(request, scenario)
    return model_data(network, scenario_objective(scenario), scenario, request.rules.reaction)


def _check_added(before: Mapping[str, Any], data: Mapping[str, Any]) -> None:
    """That a mission can go on with what an order adds: whoever was there is as before, but for who hears of it. Raises
    NoOrder."""
    there = {each["name"]: _unheard(each) for each in data["automata"]}
    changed = [each for each in before["automata"] if _unheard(each) != there[each["name"]]]
    more = set(data["variables"]) - set(before["variables"])
    if any(each["kind"] != ORDER_DESK for each in changed) or not more <= {names.DESK_OPEN}:
        raise NoOrder("a mission that is under way cannot begin to tell this apart; say where, not what is done there")


def _unheard(automaton: Mapping[str, Any]) -> Dict[str, Any]:
    """An automaton, whoever hears of its steps."""
    return {**automaton, "edges": [{**edge, "sync": ""} for edge in automaton["edges"]]}


def _heard(known: Mapping[str, Any], automata: List[Dict[str, Any]]) -> Iterator[List[str]]:
    """The steps of which nobody but who takes them knew before, and somebody does now."""
    for each in automata:
        if each["name"] in known and each["kind"] != ORDER_DESK:
            for edge, was in zip(each["edges"], known[each["name"]]["edges"]):
                if edge["sync"] != was["sync"]:
                    yield [each["name"], edge["from"], edge["to"], edge["word"]]
