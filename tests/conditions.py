"""Random conditions about one scenario in which agents move, work alone and together, and states change."""

from __future__ import annotations

from typing import Dict

from hypothesis import strategies as st

from pursue_gen.diagnostics import Span
from pursue_gen.language.conditions import AllOf, AnyOf, At, Condition, Doing, Holds, Not, OnWay, Who
from pursue_gen.language.scenario import Ref

NOWHERE = Span("", 1, 1, 1, 1)

PLACES = """\
poi "hall"
poi "shop"
poi "yard"
connect hall and shop distance 2
connect shop and yard distance 1
"""
EVENTS = """\
event "clean" location shop duration 3
event "paint" duration 2
event "carry" collaborative together location shop duration 2
event "open"
event "close" location hall
"""
AGENTS = """\
rule "order": open before close
state "light": initially true, true_if open false_if close, paint
agent "anna" controllable mobile 1 location hall can_do clean, paint, open, close
agent "bert" controllable mobile 2 location yard can_do carry reacts_to open
agent "cleo" human controllable location shop can_do paint reacts_to carry
agent "dora" mobile 1 location shop can_do clean, open reacts_to carry
"""
OBJECTIVE = "reach_objective: do close\n"

SCENARIO = PLACES + EVENTS + AGENTS + OBJECTIVE


def ref(name: str) -> Ref:
    return Ref(name, NOWHERE)


WHO = st.sampled_from([Who(ref(name)) for name in ("anna", "bert", "cleo", "dora")] + [Who(None), Who(None, True)])
POIS = st.sampled_from(["hall", "shop", "yard"]).map(ref)
ATOMS: st.SearchStrategy[Condition] = (
    st.builds(At, WHO, POIS)
    | st.builds(OnWay, WHO)
    | st.builds(Doing, WHO, st.sampled_from(["clean", "paint", "carry"]).map(ref))
    | st.builds(Holds, st.just(ref("light")), st.booleans())
)


def _extended(parts: st.SearchStrategy[Condition]) -> st.SearchStrategy[Condition]:
    plain = parts.filter(lambda part: not isinstance(part, Not))
    several = st.lists(parts, min_size=2, max_size=3).map(tuple)
    return plain.map(Not) | several.map(AllOf) | several.map(AnyOf)


CONDITIONS: st.SearchStrategy[Condition] = st.recursive(ATOMS, _extended, max_leaves=6)
"""Any condition, also such as ask for what never is."""


def without_places(condition: Condition) -> Condition:
    """The condition with all names nowhere in the text, as those that are drawn."""
    if isinstance(condition, Not):
        return Not(without_places(condition.part))
    if isinstance(condition, AllOf):
        return AllOf(tuple(without_places(part) for part in condition.parts))
    if isinstance(condition, AnyOf):
        return AnyOf(tuple(without_places(part) for part in condition.parts))
    if isinstance(condition, Holds):
        return Holds(ref(condition.state.name), condition.value)
    who = condition.who if condition.who.agent is None else Who(ref(condition.who.agent.name))
    if isinstance(condition, At):
        return At(who, ref(condition.place.name))
    return OnWay(who) if isinstance(condition, OnWay) else Doing(who, ref(condition.event.name))


def with_only_if(conditions: Dict[str, str]) -> str:
    """SCENARIO with these conditions behind the statements that declare these events, or behind the first way (`way`).
    """
    lines = []
    for line in SCENARIO.splitlines():
        name = line.split('"')[1] if line.startswith("event") else "way" if line.startswith("connect hall") else ""
        lines.append(f"{line} only_if {conditions[name]}" if name in conditions else line)
    return "\n".join(lines) + "\n"
