"""Robots out of service: nothing is sent to them, and they count where they stand."""

from __future__ import annotations

from fractions import Fraction
from typing import Dict, FrozenSet, Iterator, List, Mapping, Sequence, Tuple

from pursue_gen.language.network_names import event
from pursue_gen.language.scenario import Scenario, StatedObjective
from pursue_gen.solving.lost_promises import lost_alone, lost_promises
from pursue_gen.solving.options import SolveOptions
from pursue_gen.synthesis.limits import Limits
from pursue_gen.tga.network import Automaton, Edge, Network, Objective
from pursue_gen.tga.objectives import stated
from pursue_runtime.sentences import marked

Shared = Mapping[Tuple[str, str], str]
"""Where robots out of service stand, or will, with the events of others in which they take part there: each with the
robot."""


def without_commands(
    automata: Sequence[Automaton], scenario: Scenario, robots: FrozenSet[str]
) -> Tuple[Automaton, ...]:
    """The automata, each in its initial location, without the commands to these robots.

    They end what they do, but for that they get none, nor begins anybody who is commanded what they take part in.
    """
    shared = _shared(automata, scenario, robots)

    def stays(name: str, edge: Edge) -> bool:
        if not edge.is_command:
            return True
        return edge.is_end if name in robots else (edge.source, edge.sent) not in shared

    return tuple(each.with_edges(edge for edge in each.edges if stays(each.name, edge)) for each in automata)


def drawn_in(automata: Sequence[Automaton], scenario: Scenario, robots: FrozenSet[str]) -> str:
    """What somebody whom nobody commands may begin with one of these robots, as a part of a sentence; "": nothing."""
    shared = _shared(automata, scenario, robots)
    for automaton in automata:
        for edge in automaton.edges:
            robot = shared.get((edge.source, edge.sent or ""))
            if robot is not None and automaton.name != robot and not edge.controllable:
                return f"{marked(automaton.name)} may do {marked(edge.sent or '')} with {marked(robot)} where it stands"
    return ""


def kept_no_more(
    network: Network, objective: Objective, scenario: Scenario, reaction: Fraction, limits: Limits, quick: bool
) -> List[StatedObjective]:
    """An objective that cannot be kept in this game even if it is the only one, or two that exclude each other, as far
    as little work finds that, with `quick` very little; none where it takes more of them."""
    lost = (lost_alone if quick else lost_promises)(network, objective, reaction, SolveOptions(limits))
    watching = {name for each in lost[:1] for name, _ in (*each.goal, *each.bad)}
    return [objective for name, objective in stated(scenario).items() if name in watching]


def _shared(automata: Sequence[Automaton], scenario: Scenario, robots: FrozenSet[str]) -> Shared:
    found: Dict[Tuple[str, str], str] = {}
    places = {each.name: tuple(_stands(each)) for each in automata if each.name in robots}
    for agent in scenario.agents:
        for place in places.get(agent.name, ()):
            found.update(((place, event(ref.name)), agent.name) for ref in agent.reacts_to)
    return found


def _stands(automaton: Automaton) -> Iterator[str]:
    """Where it is once it has ended what it does."""
    ends = [edge.target for edge in automaton.edges if edge.source == automaton.initial and edge.is_end]
    yield from ends or [automaton.initial]
