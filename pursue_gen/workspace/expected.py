"""The expectations of the generated launch tests: taken from the network, not from the nodes' data."""

from __future__ import annotations

import json
from typing import Any, Dict, List, Mapping, Optional, Sequence

from pursue_gen.tga.event_words import event_word
from pursue_gen.tga.network import Automaton, Edge, Network, Objective
from pursue_gen.workspace.model_file import places_data


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
        "automata": {a.name: [_edge(a, edge) for edge in a.edges] for a in network.automata},
    }
    return (json.dumps(data, indent=1) + "\n").encode()


def _ends(network: Network) -> List[str]:
    ends = (event_word(a.name, edge) for a in network.automata for edge in a.edges if edge.is_end)
    return list(dict.fromkeys(ends))


def _edge(automaton: Automaton, edge: Edge) -> Dict[str, Any]:
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
