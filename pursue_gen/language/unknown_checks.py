"""States that are not known at first: an answer to what nobody need find out."""

from __future__ import annotations

from typing import AbstractSet, Iterator, Tuple

from pursue_gen.diagnostics import Diagnostic, warning
from pursue_gen.language.conditions import Holds, atoms, names_in
from pursue_gen.language.scenario import Ref, Scenario, State, StatedObjective


def check_unknown(scenario: Scenario) -> Iterator[Diagnostic]:
    """A warning where what has to be answered is found out by robots alone, and nothing has them do that: they keep
    such an objective if they never look."""
    unknown = {state.name: state for state in scenario.states if state.is_found_out}
    for each in scenario.safety if unknown else ():
        begins = each.breaks.begins
        if begins is None or isinstance(begins, Ref):
            continue
        asked = dict.fromkeys(atom.state.name for atom in atoms(begins) if isinstance(atom, Holds))
        others = {name for other in scenario.objectives if other is not each for name in _named(other)}
        places = (event.location for event in scenario.events if event.name in others)
        others |= {place.name for place in places if place is not None}
        for state in (unknown[name] for name in asked if name in unknown):
            if not _is_found_out(state, scenario, others):
                how, wanted = _how(state)
                message = f"nothing has the robots find out whether {state.name} is true: they need not {how}"
                yield warning("PML434", message, each.span, f"ask for that, too, as in objective: {wanted}")


def _how(state: State) -> Tuple[str, str]:
    """How robots find it out, and an objective that has them do that."""
    if state.seen_at is not None:
        return f"be at {state.seen_at.name}", f"patrol {state.seen_at.name} every 600 by any robot"
    shows = ", ".join(ref.name for ref in state.shown_by[:1])
    return f"do {shows}", f"if call then {shows} within 60"


def _is_found_out(state: State, scenario: Scenario, wanted: AbstractSet[str]) -> bool:
    """True where others than robots show what the state is, or set it, or where something of this is wanted that leads
    to it."""
    shows = {ref.name for ref in state.shown_by}
    events = shows.union(ref.name for ref in (*state.true_if, *state.false_if))
    others = {ref.name for agent in scenario.agents if not agent.controllable for ref in agent.can_do}
    place = "" if state.seen_at is None else state.seen_at.name
    starts = any(agent.is_robot and agent.location.name == place for agent in scenario.agents)
    return bool(events & others or shows & wanted) or starts or place in wanted


def _named(objective: StatedObjective) -> Iterator[str]:
    """The events, places and all else that an objective names."""
    yield from (ref.name for _, ref in objective.names())
    yield from (ref.name for one in objective.conditions for _, ref in names_in(one))
