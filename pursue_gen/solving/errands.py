"""Errands: something that a robot may be asked to do, and that keeps it from its patrol for too long.

Nobody but this robot visits a place of the patrol. In the worst case it cannot leave the place, do what somebody may
ask for, and be back within the period. So if somebody asks when the place has just been visited, either the answer or
the next visit comes too late. No game is played to find that out.
"""

from __future__ import annotations

from typing import Optional, Sequence, Tuple

from pursue_gen.language.numbers import Number
from pursue_gen.solving.distances import times_to
from pursue_gen.solving.due_moves import Duty, duties, patrols
from pursue_gen.solving.duties import Duties, are_reported, begins
from pursue_gen.solving.stays import at_home
from pursue_gen.solving.subgoals import commanded_agents
from pursue_gen.tga.network import Automaton, Edge, Kind, Network, Objective

_Patrols = Sequence[Tuple[str, Duty]]
"""The robots that alone visit places, each with the duty of one."""


def excluded_by_an_errand(network: Network, objective: Objective) -> Tuple[Objective, ...]:
    """Promises, places to be avoided, that cannot all be kept because of an errand; () where none are found."""
    robots = commanded_agents(network)
    if objective.reaches or not are_reported(network, robots):
        return ()
    visits = [
        (next(iter(duty.visits)), duty)
        for duty in duties(network, objective, patrols(network))
        if len(duty.visits) == 1 and all(len(places) == 1 for places in duty.visits.values())
    ]
    for asked in Duties(network, objective.bad, robots).at(at_home(network)) if visits else ():
        doers = [(network.automaton(r), e) for r in robots for e in begins(network.automaton(r), asked.ends)]
        missed = [_missed(robot, begin, visits) for robot, begin in doers]
        if missed and None not in missed:
            names = {asked.promise[0], *(each.name for each in missed if each is not None)}
            return (Objective(Kind.SAFETY, bad=tuple(place for place in objective.bad if place[0] in names)),)
    return ()


def _missed(robot: Automaton, begin: Edge, visits: _Patrols) -> Optional[Duty]:
    """A visit that the robot cannot make in time after it has begun this; None: there is none."""
    for name, duty in visits:
        if name == robot.name:
            (place,) = duty.visits[name]
            away = _time_away(robot, place, begin)
            if begin.source != place and (away is None or away > duty.deadline):
                return duty
    return None


def _time_away(robot: Automaton, place: str, begin: Edge) -> Optional[Number]:
    """How long it takes the robot at least to leave the place, do what it begins so, and be back, where everything
    takes as long as it may; None where there is no way."""
    there, back = times_to([begin.target], robot), times_to([place], robot)
    led = [there[edge.target] for edge in robot.edges if edge.source == place and edge.target in there]
    return min(led) + back[begin.target] if led and begin.target in back else None
