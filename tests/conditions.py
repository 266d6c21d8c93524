"""Random conditions about one scenario in which agents move, work alone and together, and states change."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Dict, List, Tuple

from hypothesis import strategies as st

from pursue_gen.diagnostics import Span
from pursue_gen.language.conditions import AllOf, AnyOf, At, AtMostOf, Condition, Doing, Holds, Not, OnWay, Who
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
ENDS = st.permutations(["hall", "shop", "yard"]).map(lambda pois: tuple(map(ref, pois[:2])))


def said_of(who: Who) -> st.SearchStrategy[Condition]:
    """What may be said of somebody."""
    way = st.builds(lambda ends, either: OnWay(who, *ends, either_way=either), ENDS, st.booleans())
    doing = st.builds(Doing, st.just(who), st.sampled_from(["clean", "paint", "carry"]).map(ref))
    return st.builds(At, st.just(who), POIS) | st.just(OnWay(who)) | way | doing


def _of_each(atom: Any, names: List[str]) -> Tuple[Any, ...]:
    return tuple(replace(atom, who=Who(ref(name))) for name in names)


def _at_one(who: Who) -> Tuple[At, ...]:
    """That somebody is at one of two places."""
    return tuple(At(who, ref(poi)) for poi in ("yard", "shop"))


SEVERAL = st.lists(st.sampled_from(["anna", "bert", "cleo", "dora"]), min_size=1, unique=True)
COUNTED = st.builds(_of_each, said_of(Who(None)), SEVERAL) | WHO.filter(lambda who: who.agent is None).flatmap(
    lambda who: st.tuples(said_of(who))
)
ATOMS: st.SearchStrategy[Condition] = (
    WHO.flatmap(said_of)
    | st.builds(Holds, st.just(ref("light")), st.booleans())
    | st.builds(AtMostOf, st.integers(0, 3), COUNTED)
    | st.builds(AtMostOf, st.integers(0, 2), st.sampled_from([Who(None), Who(None, True)]).map(_at_one))
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
    if isinstance(condition, (AllOf, AnyOf, AtMostOf)):
        parts: Any = tuple(without_places(part) for part in condition.parts)
        return replace(condition, parts=parts)
    if isinstance(condition, Holds):
        return Holds(ref(condition.state.name), condition.value)
    who = condition.who if condition.who.agent is None else Who(ref(condition.who.agent.name))
    if isinstance(condition, At):
        return At(who, ref(condition.place.name))
    if isinstance(condition, OnWay):
        return OnWay(who, *(ref(end.name) for end in condition.ends), either_way=condition.either_way)
    return Doing(who, ref(condition.event.name))


def with_only_if(conditions: Dict[str, str]) -> str:
    """SCENARIO with these conditions behind the statements that declare these events, or behind the first way (`way`).
    """
    lines = []
    for line in SCENARIO.splitlines():
        name = line.split('"')[1] if line.startswith("event") else "way" if line.startswith("connect hall") else ""
        lines.append(f"{line} only_if {conditions[name]}" if name in conditions else line)
    return "\n".join(lines) + "\n"
