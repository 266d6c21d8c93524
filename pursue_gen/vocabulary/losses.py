"""How plays are lost, in words."""

from __future__ import annotations

from typing import Sequence

from pursue_gen.language.scenario import Scenario
from pursue_gen.synthesis.game import Game, State
from pursue_gen.tga.assumptions import who_awaited
from pursue_gen.tga.objectives import stated
from pursue_gen.vocabulary.agents import place


def loss(scenario: Scenario, game: Game, state: State, late: Sequence[str]) -> str:
    """Why a play is lost in a state of its game: what is broken, else which of the automata that are `late`, at their
    bounds, cannot go on."""
    here = {automaton.name: automaton.locations[k] for automaton, k in zip(game.automata, state.locations)}
    broken, objectives = (game.automata[k].name for k, bad in game.bad if state.locations[k] == bad), stated(scenario)
    found = next((objectives[name] for name in (*late, *broken) if name in objectives), None)
    if found is not None:
        return found.broken(lambda agent: f", both {place(scenario, here[agent])}")
    agents = dict.fromkeys(who_awaited(name, scenario) or name for name in late)
    doing = ", ".join(f"{scenario.shown(name)} ({place(scenario, here[name])})" for name in agents)
    return f"{doing} ought to be done by now and cannot be, so nothing goes on" if late else "the objective is broken"
