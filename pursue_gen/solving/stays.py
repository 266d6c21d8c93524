"""Where agents whom nobody controls may stay for ever, and what must not happen while they do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import AbstractSet, Dict, Iterator, Mapping, Optional, Tuple

from pursue_gen.solving.duties import Standing, is_free
from pursue_gen.synthesis.strategy import Place
from pursue_gen.tga.ends import has_to_come, is_nobodys
from pursue_gen.tga.network import Automaton, Edge, Network, Objective


@dataclass(frozen=True)
class LostToAStay:
    """Promises that cannot all be kept where an agent whom nobody controls stays at a place for ever.

    `comes`: but leaves it as soon as a robot sets off for where it can be before the robot is gone.
    """

    promises: Objective
    agent: str
    place: str
    comes: bool = False


def at_home(network: Network) -> Dict[str, str]:
    """The agents whom nobody controls that may be for ever where they begin, and these places."""
    agents = (each for each in network.automata if is_nobodys(each) and not has_to_come(each))
    return {agent.name: agent.initial for agent in agents if agent.initial not in agent.stays}


def arrivals(agent: Automaton) -> Iterator[Edge]:
    """The edges by which an agent whom nobody controls comes to places where it may stay for ever, each by a way that
    it can take in any case."""
    met, waiting = {agent.initial}, [agent.initial]
    while waiting:
        here = waiting.pop()
        for edge in agent.edges:
            if edge.source == here and edge.target not in met and is_free(edge):
                met.add(edge.target)
                waiting.append(edge.target)
                if edge.target not in agent.stays and edge.assign:
                    yield edge


def standings(network: Network) -> Iterator[Tuple[Standing, Optional[Edge]]]:
    """Where those whom nobody controls may be for ever: all where they begin, or one where an edge has led it."""
    home = at_home(network)
    yield home, None
    for name in home:
        for arrival in arrivals(network.automaton(name)):
            yield {**home, name: arrival.target}, arrival


def is_reached(network: Network, bad: Place, known: Mapping[str, AbstractSet[int]]) -> bool:
    """True if the environment can at once make happen what is to be avoided while variables have some of these values,
    whatever else holds."""
    automaton = network.automaton(bad[0])
    sure = {edge.source for edge in automaton.edges if edge.target == bad[1] and _is_taken(edge, known)}
    return sure == {place.name for place in automaton.locations if place.name != bad[1]}


def _is_taken(edge: Edge, known: Mapping[str, AbstractSet[int]]) -> bool:
    """True if the environment can take the edge whichever of these values hold."""
    if edge.controllable or edge.sync is not None or edge.guard.clocks:
        return False
    return all(
        any(some <= {test.value for test in clause if test.variable == name} for name, some in known.items())
        for clause in edge.guard.integers
    )
