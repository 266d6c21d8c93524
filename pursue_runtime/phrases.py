"""What agents do, in words for people, or as part of a sentence (`sentences.MARKED` in place of a model)."""

from __future__ import annotations

from typing import NamedTuple, Optional, Sequence

from pursue_runtime.locations import is_action, is_end, is_movement, is_under_way
from pursue_runtime.model import Automaton, Edge, Model
from pursue_runtime.sentences import Names
from pursue_runtime.simulator.simulator import ACTING
from pursue_runtime.state import SystemState
from pursue_runtime.words import START


class Phrase(NamedTuple):
    """An edge in words: on a button, and behind the name of the agent that takes it."""

    label: str
    does: str


def phrase(model: Names, automaton: Automaton, edge: Edge) -> Phrase:
    """An edge of an agent in words."""
    source, target, word = (model.shown(name) for name in (edge.source, edge.target, edge.word))
    if is_end(edge.source, edge.target):
        if is_movement(edge.source):
            return Phrase(f"arrive at {target}", f"arrives at {target}")
        begin = begin_of(automaton, edge.source)
        word = word if begin is None else model.shown(begin.word)
        return Phrase(f"{word} is done", f"ends {word}")
    if is_movement(edge.target):
        to = model.shown(destination(automaton, edge.target))
        return Phrase(f"{source} → {to}", f"sets off from {source} to {to}")
    if is_action(edge.target):
        return Phrase(word, f"begins {word}")
    return Phrase(word, f"does {word}")


def sentence(model: Model, state: SystemState, last: Optional[SystemState]) -> str:
    """What has happened in a state; `last`: the state before it, if that is known."""
    automaton = next((automaton for automaton in model.automata if automaton.name == state.agent), None)
    if automaton is None:
        return "the mission starts" if state.event == START else state.event
    here = state.locations.get(state.agent, "")
    if automaton.kind not in ACTING:
        goals = dict(model.goal)
        counts = goals.get(state.agent, here) != here and (state.agent, here) not in model.bad
        what = model.says.get(state.agent, "the goal" if counts else state.agent)
        return f"{what} counts from now on" if counts else f"{what}: {here}"
    before = last.locations.get(state.agent, "") if last is not None else ""
    edges = [edge for edge in automaton.edges if edge.word == state.event and edge.source != edge.target]
    likely = sorted(edges, key=lambda edge: (edge.target != here, edge.source != before))
    does = phrase(model, automaton, likely[0]).does if likely else f"does {model.shown(state.event)}"
    return f"{model.shown(state.agent)} {does}"


def doing(model: Model, automaton: Automaton, location: str, place: str) -> str:
    """What an agent does at a location, which is at a place (a POI, "" where that is not known).

    Nobody sends one that is not controlled: it is on its way.
    """
    begin = begin_of(automaton, location)
    if begin is None:
        return f"is at {model.shown(place or location)}"
    if is_movement(location):
        goes = "goes" if automaton.kind != "agent" else "is on its way"
        return f"{goes} from {model.shown(begin.source)} to {model.shown(destination(automaton, location))}"
    return f"does {model.shown(begin.word)}, at {model.shown(place or begin.source)}"


def is_there(model: Model, automaton: Automaton, location: str, verb: str) -> str:
    """Where an agent is, behind its name: `is at c`, `is on its way from c to b`, `is doing catch at b`; `verb` is `is`
    or another form of it."""
    begin = begin_of(automaton, location)
    if begin is None:
        return f"{verb} at {model.shown(location)}"
    if is_movement(location):
        to = model.shown(destination(automaton, location))
        return f"{verb} on its way from {model.shown(begin.source)} to {to}"
    return f"{verb} doing {model.shown(begin.word)} at {model.shown(begin.source)}"


def awaited(model: Model, automaton: Automaton, location: str) -> str:
    """What ends what an agent does there, as in `arrive at b`; "" where it does nothing."""
    end = next((edge for edge in automaton.edges_from(location) if is_end(edge.source, edge.target)), None)
    return "" if end is None else possibility(model, automaton, end)


def possibility(model: Model, automaton: Automaton, edge: Edge) -> str:
    """What an agent may do, behind the word may, or to: `go to b`, `do catch`, `arrive at b`, `end catch`."""
    if is_end(edge.source, edge.target):
        if is_movement(edge.source):
            return f"arrive at {model.shown(edge.target)}"
        begin = begin_of(automaton, edge.source)
        return f"end {model.shown(edge.word if begin is None else begin.word)}"
    if is_movement(edge.target):
        return f"go to {model.shown(destination(automaton, edge.target))}"
    return f"do {model.shown(edge.word)}"


def listed(names: Sequence[str], last: str = "and") -> str:
    """`a`, `a and b`, `a, b and c`; at least one."""
    return f"{', '.join(names[:-1])} {last} {names[-1]}" if len(names) > 1 else names[0]


def not_promised(model: Model) -> str:
    """What to say of optional objectives where a mission begins: those that it does not promise; "" for none."""
    return f"; it does not promise: {', '.join(model.given_up)}" if model.given_up else ""


def where(model: Model, automaton: Automaton, location: str) -> str:
    """Where an agent is, in few words: a POI, the way between two, or an action and its POI."""
    begin = begin_of(automaton, location)
    if begin is None:
        return model.shown(location)
    source = model.shown(begin.source)
    if is_movement(location):
        return f"{source} → {model.shown(destination(automaton, location))}"
    return f"{model.shown(begin.word)} at {source}"


def begin_of(automaton: Automaton, location: str) -> Optional[Edge]:
    """The edge that leads into a movement or an action; None for other locations."""
    if not is_under_way(location):
        return None
    return next((edge for edge in automaton.edges if edge.target == location != edge.source), None)


def destination(automaton: Automaton, location: str) -> str:
    """Where a movement leads to."""
    return next((end.target for end in automaton.edges_from(location) if is_end(end.source, end.target)), "?")
