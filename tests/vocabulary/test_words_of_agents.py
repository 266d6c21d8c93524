"""Agents in words: the desk says the same as robots and the UI, which have nothing but names and the model."""

from __future__ import annotations

from fractions import Fraction

from pursue_gen.language import parse
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.event_words import event_word
from pursue_gen.vocabulary import agents
from pursue_gen.workspace import model_file
from pursue_runtime.model import Model
from pursue_runtime.vocabulary import deed, place

TEXT = """
poi "a" label "front desk" poi "b"
connect a and b distance 3
event "load" location a duration 2
event "shout" label "call out"
event "ask"
agent "bot" label "Porter 1" controllable mobile 1 location a can_do load, ask reacts_to shout
agent "cat" mobile 1 location b can_do shout
reach_objective: do load
"""


def test_the_desk_and_robots_say_the_same_of_every_step_and_place() -> None:
    scenario = parse(TEXT, "house.pur", "house")
    network = translate(scenario)
    model = Model(model_file.model_data(network, scenario_objective(scenario), scenario, Fraction(1)))
    for agent in scenario.agents:
        automaton, desk = model.automaton(agent.name), network.automaton(agent.name)
        assert len(automaton.edges) == len(desk.edges) >= 8
        for edge, same in zip(automaton.edges, desk.edges):
            assert edge.word == event_word(agent.name, same)
            assert deed(model, automaton, edge) == agents.deed(scenario, agent.name, same)
        for location in desk.locations:
            assert place(model, automaton, location.name) == agents.place(scenario, location.name)
