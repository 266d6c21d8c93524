"""What agents do and where they are, in words for people, or as part of a sentence (`sentences.MARKED` in place of a
model). The desk has the same words from here."""

from __future__ import annotations

from typing import NamedTuple, Optional, Tuple

from pursue_runtime.event_words import CANCELLED, JOINS, LEAVES, START
from pursue_runtime.locations import FINDING_OUT, SOMEWHERE, action_of, is_action, is_end, is_movement, is_under_way
from pursue_runtime.model import ORDER_DESK, Automaton, Edge, Model
from pursue_runtime.sentences import Names
from pursue_runtime.state import SystemState


class Deed(NamedTuple):
    """What an agent does: behind its name, and behind the word may, or to. `{}` are what people read for names."""

    does: str
    do: str

    def of(self, *names: str) -> Deed:
        """The same with these names in it."""
        return Deed(self.does.format(*names), self.do.format(*names))


SETS_OFF = Deed("sets off from {} to {}", "go to {1}")
ARRIVES = Deed("arrives at {}", "arrive at {}")
DOES = Deed("does {}", "do {}")
STARTS = Deed("starts at {}", "start at {}")
FOUND = Deed("is found to be {}", "be found to be {}")
BREAKS_OFF = Deed("breaks off {}", "break off {}")
BEGINS, FINISHES = Deed("begins {}", "begin {}"), Deed("finishes {}", "finish {}")  # what takes time
FINISHES_PART = Deed("finishes a part of {}", "finish a part of {}")

AT, ON_WAY, AT_WORK = "at {}", "on its way from {} to {}", "doing {} at {}"
UNPLACED = "at a place that nobody has said yet"
"""Where an agent is, behind `is`."""


def deed(model: Names, automaton: Automaton, edge: Edge) -> Deed:
    """An edge of an agent in words."""
    if edge.source == FINDING_OUT:
        return FOUND.of(value_found(edge))
    if edge.source == SOMEWHERE:
        return STARTS.of(model.shown(edge.target))
    source, target, word = (model.shown(name) for name in (edge.source, edge.target, edge.word))
    if edge.source == edge.target:  # also on its way
        return DOES.of(word)
    if edge.breaks_off:
        return BREAKS_OFF.of(model.shown(action_of(edge.source)))
    if edge.ends_part:
        return FINISHES_PART.of(model.shown(action_of(edge.source)))
    if edge.is_end:
        begin = begin_of(automaton, edge.source)
        arrives = is_movement(edge.source)
        return ARRIVES.of(target) if arrives else FINISHES.of(word if begin is None else model.shown(begin.word))
    if is_movement(edge.target):
        return SETS_OFF.of(source, model.shown(destination(automaton, edge.target)))
    return (BEGINS if is_action(edge.target) else DOES).of(word)


def value_found(edge: Edge) -> str:
    """What a state is found to be by this edge: `true` or `false`."""
    return "true" if any(edge.assign.values()) else "false"


def is_fact(automaton: Automaton) -> bool:
    """Return True for the automaton of a state that is not known at first."""
    return FINDING_OUT in automaton.invariants


def sentence(model: Model, state: SystemState, last: Optional[SystemState]) -> str:
    """What has happened in a state; `last`: the state before it, if that is known."""
    automaton = next((automaton for automaton in model.automata if automaton.name == state.agent), None)
    if automaton is None:
        return "the mission starts" if state.event == START else state.event
    here = state.locations.get(state.agent, "")
    if state.event in (LEAVES, JOINS):
        return f"{model.shown(state.agent)} is {'out of service' if state.event == LEAVES else 'in service again'}"
    if automaton in model.of_kind(ORDER_DESK):
        if state.event not in model.orders and state.event.endswith(CANCELLED):
            return f"{model.shown(state.event[: -len(CANCELLED)])} is cancelled"
        return f"{model.shown(state.event)} is ordered, and accepted"
    if not automaton.acts:
        goals = dict(model.goal)
        counts = goals.get(state.agent, here) != here and (state.agent, here) not in model.bad
        what = model.says.get(state.agent, "the goal" if counts else state.agent)
        return f"{what} counts from now on" if counts else f"{what}: {here}"
    before = last.locations.get(state.agent, "") if last is not None else ""
    edges = [edge for edge in automaton.edges if edge.word == state.event and edge.source != edge.target]
    likely = sorted(edges, key=lambda edge: (edge.target != here, edge.source != before))
    done = deed(model, automaton, likely[0]) if likely else DOES.of(model.shown(state.event))
    return f"{model.shown(state.agent)} {done.does}"


def place(model: Names, automaton: Automaton, location: str) -> str:
    """Where an agent is, behind `is`: `at c`, `on its way from c to b`, `doing catch at b`."""
    return _placed(model, automaton, location, (AT, ON_WAY, AT_WORK))


def where(model: Names, automaton: Automaton, location: str) -> str:
    """The same in few words: a POI, the way between two, or an action and its POI."""
    return _placed(model, automaton, location, ("{}", "{} → {}", "{} at {}"))


def _placed(model: Names, automaton: Automaton, location: str, words: Tuple[str, str, str]) -> str:
    """Where an agent is, in the words for who stands, moves, or acts."""
    if is_fact(automaton):
        return "being found out" if location == FINDING_OUT else location
    if location == SOMEWHERE:
        return UNPLACED
    begin, (stands, moves, acts) = begin_of(automaton, location), words
    if begin is None:
        return stands.format(model.shown(location))
    if is_movement(location):
        return moves.format(model.shown(begin.source), model.shown(destination(automaton, location)))
    return acts.format(model.shown(begin.word), model.shown(begin.source))


def instruction(model: Names, automaton: Automaton, edge: Edge) -> str:
    """What a person is to do who takes this edge: `go to b`, `do load at b`."""
    return f"do {where(model, automaton, edge.target)}" if is_action(edge.target) else deed(model, automaton, edge).do


def awaited(model: Model, automaton: Automaton, location: str) -> str:
    """What ends what an agent does there, as in `arrive at b`; "" where it does nothing."""
    end = next((edge for edge in automaton.edges_from(location) if edge.is_end), None)
    if end is not None and location == FINDING_OUT:
        return "be found out"
    return "" if end is None else deed(model, automaton, end).do


def said_at_start(model: Model) -> str:
    """What to say where a mission begins: when it ends, and the optional objectives that it does not promise; "" where
    there is nothing to say."""
    ends = "" if model.ends is None or model.ends.after is None else f" after {model.ends.after:g} time units"
    ends += " when all is answered" if model.ends is not None and model.ends.answered else ""
    given_up = f"; it does not promise: {', '.join(model.given_up)}" if model.given_up else ""
    return f"{ends and f'; it ends{ends}'}{given_up}"


def begin_of(automaton: Automaton, location: str) -> Optional[Edge]:
    """The edge that leads into a movement or an action; None for other locations."""
    if not is_under_way(location):
        return None
    return next((edge for edge in automaton.edges if edge.target == location != edge.source), None)


def destination(automaton: Automaton, location: str) -> str:
    """Where a movement leads to."""
    return next((end.target for end in automaton.edges_from(location) if is_end(end.source, end.target)), "?")
