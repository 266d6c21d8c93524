"""Random plays that a network and the statements of its scenario see at once (`tests.course`)."""

from __future__ import annotations

import random
from typing import List, Tuple

from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.rules import DEFAULT, played
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.workspace.model_file import model_data
from pursue_runtime.locations import FINDING_OUT
from pursue_runtime.model import Model, Position
from pursue_runtime.zones import due
from tests.course import Course

STILL = 0.05
"""Time units by which a play is past a strict bound."""


def model_of(scenario: Scenario) -> Model:
    """The network as the run time reads it."""
    network = played(translate(scenario), DEFAULT)
    return Model(model_data(network, scenario_objective(scenario), scenario, DEFAULT.reaction))


class Play:
    """A play that both sides see. Each step is a word that the network permits."""

    def __init__(self, scenario: Scenario) -> None:
        self.model, self.course, self.scenario = model_of(scenario), Course(scenario), scenario
        self.position = self.model.initial()
        self.lines: List[str] = []
        self._facts = [state.name for state in scenario.states if state.initially is None]

    def check(self) -> None:
        """Both have everybody in the same place, and let begin the same, once it is known where they start."""
        there = {name: self.position.locations[name] for name in self.course.agents}
        assert there == self.course.locations, self.lines
        if any(stay.unplaced for stay in self.course.stays.values()):
            return
        facts = {name: self.position.locations[name] for name in self._facts}
        told = {name: "unknown" if self.course.states[name] is None else "known" for name in self._facts}
        assert facts == {**told, **dict.fromkeys(self.course.shown, FINDING_OUT)}, self.lines
        for agent in self.scenario.agents:
            for ref in agent.can_do:
                possible = self.model.joint_move(self.position, ref.name, agent.name, timed=False) is not None
                assert possible == self.course.may_begin(agent.name, ref.name), (agent.name, ref.name, self.lines)
                off = self.model.joint_move(self.position, f"{ref.name}STOP", agent.name, timed=False) is not None
                assert off == self.course.may_stop(agent.name, ref.name), (agent.name, ref.name, self.lines)
            for a in self.scenario.pois:
                for b in self.scenario.pois:
                    word = f"{agent.name}_{a.name}2{b.name}"
                    possible = self.model.joint_move(self.position, word, agent.name, timed=False) is not None
                    may = a is not b and self.course.may_set_off(agent.name, a.name, b.name)
                    assert possible == may, (word, self.lines)

    def moves(self) -> List[Tuple[float, str, str]]:
        """In how many time units which agent can do what, if nothing else happens before."""
        found, last = [], self._longest()
        for name in (*self.course.agents, *self._facts):
            automaton, place = self.model.automaton(name), self.position.locations[name]
            for edge in automaton.edges_from(place):
                if edge.sync == "receive" or not edge.allowed(self.position.values):
                    continue
                delay = due([edge.when], self.position.clocks, STILL)
                if delay is not None and delay <= last:
                    found.append((delay, name, edge.word))
        return found

    def _longest(self) -> float:
        """The time units until somebody has to have ended what it does, or to have left."""
        bounds = [
            bound.bound - self.position.clocks[bound.left]
            for name in (*self.course.agents, *self._facts, *(each.name for each in self.model.of_kind("rule")))
            for bound in self.model.bounds_of(name, self.position.locations[name], self.position.values)
        ]
        return min(bounds, default=1e9)

    def take(self, agent: str, word: str, delay: float) -> bool:
        """Time passes, and the agent does it; False if it is not possible there after all."""
        position: Position = self.position.aged(delay)
        moves = self.model.joint_move(position, word, agent)
        if moves is None:
            return False
        self.course.now += delay
        self.lines.append(f"{self.course.now:.2f} {agent}: {word}")
        self.course.take(agent, word, moves[0].edge.target)
        self.position = Model.after(moves, position)
        return True

    def run(self, steps: int, seed: int) -> None:
        """Checks so many steps, each of which is possible, by chance."""
        chance = random.Random(seed)
        self.check()
        for _ in range(steps):
            options = self.moves()
            if not options:
                break
            least, agent, word = chance.choice(options)
            room = min(self._longest(), least + chance.choice((1.0, 3.0, 30.0))) - least
            if self.take(agent, word, least + chance.choice((0.0, chance.random(), 1.0)) * max(0.0, room)):
                self.check()
