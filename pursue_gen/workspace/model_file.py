"""The network as the nodes of a workspace read it: model.yaml, see docs/run_time.md; and what the generated launch
tests expect, which is taken from the network, not from the nodes' data."""

from __future__ import annotations

import json
from fractions import Fraction
from typing import Any, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.language import network_names as names
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.symbols import Role, role_of
from pursue_gen.partition.strategy_data import number
from pursue_gen.partition.yaml_text import inline, yaml_text
from pursue_gen.tga.event_words import event_word
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Network, Objective
from pursue_gen.tga.objectives import stated


def render(network: Network, objective: Objective, scenario: Scenario, reaction: Fraction, generator: str) -> str:
    """The text of model.yaml: `network` is the one of the game that is played (its ends and slack included), `reaction`
    the delay (time units) that the strategy allows a command."""
    head = (
        f"The automata of {scenario.name}, written by pursue-gen {generator}.",
        "Clocks count time units; an event moves one sender (or owner) and every automaton that can receive it.",
    )
    return yaml_text(model_data(network, objective, scenario, reaction), head)


def model_data(network: Network, objective: Objective, scenario: Scenario, reaction: Fraction) -> Dict[str, Any]:
    """The data of model.yaml, see `render`."""
    partners = _partners(scenario)
    goal, bad = places_data(objective.goal), places_data(objective.bad)
    says = {**_says(scenario, objective), **_given_up(scenario), **_promises(scenario)}
    data: Dict[str, Any] = {
        "format": _format(bool(partners), scenario, objective),
        "scenario": scenario.name,
        "reaction": number(reaction),
        "clocks": inline(network.clocks),
        "variables": inline(dict(network.variables)),
        "automata": [_automaton(each, _kind(each.name, scenario), partners) for each in network.automata],
        "objective": inline({"kind": objective.kind.value, "goal": goal, "bad": bad, **says}),
    }
    for end in scenario.ends:
        after = {} if end.after is None else {"after": number(Fraction(end.after))}
        data["ends"] = inline({**after, "answered": end.answered})
    if scenario.labels:
        data["labels"] = inline(scenario.labels)
    if scenario.assumed:
        data["assumptions"] = [inline(each) for each in _assumptions(scenario, network)]
    return data


def _format(has_partners: bool, scenario: Scenario, objective: Objective) -> int:
    """The format of model.yaml, the oldest that can say all of it."""
    if scenario.orders:
        return 7
    if any(event.split for event in scenario.events) or any(agent.is_somewhere for agent in scenario.agents):
        return 6
    if any(state.is_found_out for state in scenario.states):
        return 5
    if scenario.ends:
        return 4
    return 3 if has_partners else 2 if scenario.assumed or _has_several(objective) else 1


def _promises(scenario: Scenario) -> Dict[str, Any]:
    """What each automaton watches where nothing is to be reached; of what is due, what is said of it when it comes in
    time, and whether an end of the mission waits for it."""
    if scenario.reach:
        return {}
    found: Dict[str, Dict[str, Any]] = {}
    for name, each in stated(scenario).items():
        found[name] = {"says": each.text + each.words.which}
        if each.words.kept:
            found[name].update({"kept": each.words.kept, "answered": each.is_answered})
    return {"promises": found}


def _assumptions(scenario: Scenario, network: Network) -> Iterator[Dict[str, str]]:
    """The variable of each assumption, its clock where it has one, and what it says."""
    for place, assumption in enumerate(scenario.assumed, start=1):
        clock = names.assumption_clock(place)
        timed = {"clock": clock} if clock in network.clocks else {}
        yield {"variable": names.assumption(place), **timed, "says": assumption.clause}


def _has_several(objective: Objective) -> bool:
    """True for what only format 2 can say: several places, or one automaton with a place to reach and one to avoid."""
    watching = [name for name, _ in (*objective.goal, *objective.bad)]
    return len(objective.goal) > 1 or len(objective.bad) > 1 or len(set(watching)) < len(watching)


def _says(scenario: Scenario, objective: Objective) -> Dict[str, Any]:
    """What each automaton watches, in the words of the scenario, where there are several."""
    said = {name: each.text for name, each in stated(scenario).items()}
    return {"says": said} if _has_several(objective) else {}


def _given_up(scenario: Scenario) -> Dict[str, Any]:
    """The optional objectives that the mission does not promise, in the words of the scenario, where there are any."""
    texts = [one.objective.text for one in scenario.given_up]
    return {"given_up": texts} if texts else {}


_WATCHING = dict.fromkeys((Role.SAFETY, Role.WATCHER, Role.TOUR), "safety")
_KINDS = {Role.STATES: "states", Role.FACT: "agent", Role.ORDER_DESK: "orders", Role.REACH: "reach", **_WATCHING}
"""By the role of an automaton its kind; all others but agents follow events as a rule does. Of what a state is that is
not known at first, the world decides, as of what an agent does that nobody controls."""


def _kind(automaton: str, scenario: Scenario) -> str:
    agent = next((agent for agent in scenario.agents if agent.name == automaton), None)
    if agent is None:
        return _KINDS.get(role_of(automaton), "rule")
    return "robot" if agent.is_robot else "human" if agent.controllable else "agent"


def _partners(scenario: Scenario) -> Dict[str, List[str]]:
    """robot → the collaborative events of others in which it takes part, for those that take part in any."""
    robots = (agent for agent in scenario.agents if agent.is_robot and agent.reacts_to)
    return {robot.name: list(dict.fromkeys(ref.name for ref in robot.reacts_to)) for robot in robots}


def _automaton(automaton: Automaton, kind: str, partners: Mapping[str, List[str]]) -> Dict[str, Any]:
    return {
        "name": automaton.name,
        "kind": kind,
        **({"reacts_to": inline(partners[automaton.name])} if automaton.name in partners else {}),
        "initial": automaton.initial,
        "locations": inline({location.name: _bounds(location.invariant) for location in automaton.locations}),
        "edges": [inline(_edge(automaton.name, edge)) for edge in automaton.edges],
    }


def _edge(automaton: str, edge: Edge) -> Dict[str, Any]:
    parts: Dict[str, Any] = {
        "from": edge.source,
        "to": edge.target,
        "word": event_word(automaton, edge),
        "sync": "own" if edge.sync is None else "send" if edge.sync.sends else "receive",
        "when": _bounds(edge.guard.clocks),
        "if": [[f"{test.variable}={test.value}" for test in clause] for clause in edge.guard.integers],
        "set": dict(edge.assign),
        "reset": list(edge.resets),
        "controllable": edge.controllable,
    }
    return {name: value for name, value in parts.items() if value not in ([], {})}


def _bounds(bounds: Sequence[ClockBound]) -> List[str]:
    return [f"{bound.clock} {bound.op} {bound.bound}" for bound in bounds]


def places_data(places: Sequence[Tuple[str, str]]) -> Optional[Sequence[object]]:
    """Automata and locations as data files have them: one pair as it is, several in a list, None for none."""
    return None if not places else list(places[0]) if len(places) == 1 else [list(place) for place in places]


def expected(
    network: Network,
    objective: Objective,
    robots: Mapping[str, str],
    commands: Mapping[str, Sequence[str]],
    nodes: Sequence[str],
) -> bytes:
    """The text of expected.json.

    `robots`: robot → the node that may command it; `commands`: controller → its commands; `nodes`: those that
    must be ready before the mission starts.
    """
    commanded = {word for words in commands.values() for word in words}
    data: Dict[str, Any] = {
        "reach": objective.reaches,
        "bad": places_data(objective.bad),
        "nodes": sorted(nodes),
        "robots": dict(robots),
        "commands": {node: sorted(set(words)) for node, words in commands.items()},
        "ends": [word for word in _ends(network) if word not in commanded],
        "automata": {a.name: [_expected_edge(a, edge) for edge in a.edges] for a in network.automata},
    }
    return (json.dumps(data, indent=1) + "\n").encode()


def _ends(network: Network) -> List[str]:
    ends = (event_word(a.name, edge) for a in network.automata for edge in a.edges if edge.is_end)
    return list(dict.fromkeys(ends))


def _expected_edge(automaton: Automaton, edge: Edge) -> Dict[str, Any]:
    sync = "own" if edge.sync is None else "send" if edge.sync.sends else "receive"
    tests = [[[test.variable, test.value] for test in clause] for clause in edge.guard.integers]
    return {"from": edge.source, "to": edge.target, "word": event_word(automaton.name, edge), "sync": sync, "if": tests}


def first_report(network: Network) -> Optional[str]:
    """An event of an uncontrollable agent that is possible at the start, for a trace; None where there is none."""
    places = {automaton.name: automaton.initial for automaton in network.automata}
    values = dict(network.variables)
    for automaton in network.automata:
        for edge in automaton.edges:
            open_ = all(any(values[t.variable] == t.value for t in clause) for clause in edge.guard.integers)
            reported = edge.sync is not None and edge.sync.sends and not edge.controllable
            if reported and open_ and edge.source == places[automaton.name] and not edge.is_end:
                return f"{automaton.name}:{event_word(automaton.name, edge)}"
    return None
