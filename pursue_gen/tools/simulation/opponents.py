"""What uncontrollable agents do, and when: nothing, anything, or what is worst for the strategy."""

from __future__ import annotations

import random
from typing import List, NamedTuple, Optional, Tuple

from pursue_gen.language.symbols import UNDER_WAY, Role, role_of
from pursue_gen.proof.moves import JointMove, State
from pursue_gen.tga.assumptions import who_awaited
from pursue_gen.tga.event_words import event_word
from pursue_gen.tools.simulation.recorder import EPSILON
from pursue_gen.tools.simulation.remaining import Remaining
from pursue_gen.tools.simulation.stage import Stage
from pursue_gen.zones.dbm import INF, Dbm, constant, is_strict

OPPONENTS = {
    "random": "each does any of what it may do, or nothing, at any moment; the first and the last one often",
    "worst": "each does what leaves the strategy the longest way to the goal, as far as it guarantees any",
    "still": "they stand still",
    "mixed": "one of these three in each mission, seldom the one who stands still; the worst as looking ahead costs",
}

FIRST = 1e-3
"""Time units by which the first or last moment is inside a window that begins or ends with a strict bound."""

_STILL = 0.3
"""Of the missions of mixed opponents that a fair draw gives to those who stand still, which is a third, the part that
they keep: one mission in ten. Not measured."""

SPANS = (0.5, 3.0, 10.0, 40.0)
"""Where an agent may wait for ever, it waits up to one of these, in time units. Not measured."""


class Option(NamedTuple):
    """Something that an agent may do in a state, from `first` to `last` time units from now."""

    agent: str
    word: str
    move: JointMove
    first: float
    last: float


class OpponentMove(NamedTuple):
    """What an agent does, so many time units from now; with the word "" nothing: then it looks again."""

    word: str
    delay: float


def options(stage: Stage, state: State, point: Tuple[float, ...]) -> List[Option]:
    """What the uncontrollable agents may do in this state, from these clocks (0 first) on, but for ends."""
    found = []
    for move in stage.arena.situation(state).moves:
        first = move.moves[0]
        if move.controllable or first.edge.is_end or first.automaton not in stage.opponents or move.enabled is None:
            continue
        window = _window(move.enabled, stage.arena.scale, point)
        if window is not None:
            found.append(Option(first.automaton, event_word(first.automaton, first.edge), move, *window))
    return found


def _window(zone: Dbm, scale: int, point: Tuple[float, ...]) -> Optional[Tuple[float, float]]:
    """The first and the last delay after which the point is in the zone (of that scale), as time passes."""
    dim, first, last = zone.dim, 0.0, float("inf")
    for k, bound in enumerate(zone.m):
        i, j = divmod(k, dim)
        if i == j or bound >= INF:
            continue
        room = constant(bound) / scale - (point[i] - point[j])
        if i == 0:
            first = max(first, -room + (FIRST if is_strict(bound) and room <= 0 else 0.0))
        elif j == 0:
            last = min(last, room - (FIRST if is_strict(bound) else 0.0))
        elif room < -EPSILON:
            return None
    return (first, max(first, last)) if first <= last + EPSILON else None


class Opponent:
    """Plays in one mission."""

    def __init__(self, stage: Stage, kind: str, seed: str, remaining: Optional[Remaining] = None) -> None:
        """`kind`: random, worst or still; `remaining` is for the worst."""
        self.kind = kind
        self._stage, self._remaining = stage, remaining
        self._draw = random.Random(f"{seed}/opponent")
        self._zeal = self._draw.uniform(0.1, 1.0)  # how often something is done where it could be

    def next(self, state: State, point: Tuple[float, ...]) -> Optional[OpponentMove]:
        """What is done next, if no other event comes first; asked anew in each state."""
        able = options(self._stage, state, point)
        if not able:
            return None
        obliged = self._obliged(able, state, point)
        if self.kind == "still":
            return obliged
        worst = self.kind == "worst" and self._draw.random() < 0.8
        chosen = self._worst(able, point) if worst else self._any(able)
        return obliged if obliged is not None and obliged.delay < chosen.delay else chosen

    def _obliged(self, able: List[Option], state: State, point: Tuple[float, ...]) -> Optional[OpponentMove]:
        """What the one does that must leave its place first, or do something again, as is assumed of it; None where
        nobody must."""
        network, clock = self._stage.arena.network, self._stage.arena.clock
        latest: List[Tuple[float, str, str]] = []
        under_way = {each.name for each, here in zip(network.automata, state[0]) if role_of(here) in UNDER_WAY}
        for automaton, here in zip(network.automata, state[0]):
            agent = who_awaited(automaton.name, self._stage.scenario) or automaton.name
            if agent in self._stage.opponents and agent not in under_way:
                bounds = next(place.invariant for place in automaton.locations if place.name == here)
                latest += [(bound.bound - point[clock[bound.clock]], agent, bound.clock) for bound in bounds]
        if not latest:
            return None
        moment, agent, since = min(latest)
        edges = ((option, option.move.moves[0].edge) for option in able if option.agent == agent)
        ending = [option for option, edge in edges if edge.enters is Role.WAY or since in edge.resets]
        ending = [option for option in ending if option.first <= moment + EPSILON]
        if not ending:
            return None
        option = self._draw.choice(ending)
        return self._deed(option, max(option.first, min(option.last, moment)))

    def _any(self, able: List[Option]) -> OpponentMove:
        if self._draw.random() > self._zeal:
            return OpponentMove("", self._draw.choice(SPANS) * self._draw.uniform(0.1, 1.0))
        option = self._draw.choice(able)
        return self._deed(option, self._draw.choice(self._moments(option)))

    def _worst(self, able: List[Option], point: Tuple[float, ...]) -> OpponentMove:
        """The deed after which the strategy may need longest to the goal, counted from now; where a deed leads out of
        what the strategy knows, that is the longest of all. It looks at the first and at the last moment of each. Where
        nothing is known of times (a safety objective, a game too large), any deed."""
        assert self._remaining is not None
        best, longest = None, -1.0
        for option in able:
            for moment in self._moments(option)[:2]:
                left = self._remaining.after(option.move, point, moment)
                if left is not None and moment + left > longest:
                    best, longest = self._deed(option, moment), moment + left
        return best or self._any(able)

    def _moments(self, option: Option) -> List[float]:
        """The first moment, the last one (or, without any, one at some time), and one in between."""
        last = option.last
        if last == float("inf"):
            last = option.first + self._draw.choice(SPANS) * self._draw.random()
        return [option.first, last, self._draw.uniform(option.first, last)]

    def _deed(self, option: Option, moment: float) -> OpponentMove:
        return OpponentMove(f"{option.agent}:{option.word}", moment)


def kind_in_mission(kind: str, seed: str, remaining: Optional[Remaining]) -> str:
    """The kind of opponent in this mission; of mixed ones, the worst as often as looking ahead may cost."""
    if kind != "mixed":
        return kind
    draw = random.Random(f"{seed}/kind")
    chosen = draw.choice([k for k in OPPONENTS if k != "mixed"])
    if chosen == "still" and draw.random() >= _STILL:  # nothing is asked of the robots then
        chosen = "random"
    rare = chosen == "worst" and remaining is not None and draw.random() >= remaining.ease
    return "random" if rare else chosen
