"""Conditions: what may hold at a moment of a mission, as `only_if` and objectives name it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Callable, Collection, Iterator, List, Mapping, Optional, Tuple, Union

from lark import Token

from pursue_gen.diagnostics import listed
from pursue_gen.language.refs import Ref
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Word

WORDS = (
    Word("only_if", "What has to hold when the event begins, or when an agent sets off on the way.", may_break=True),
    Word("is_true", "The state is true."),
    Word("is_false", "The state is false."),
    Word("at", "The place; in a condition: the agent stands there, idle or at work.", True),
    Word("not", "What follows does not hold."),
    Word("on_way", "The agent is between two places.", True),
    Word(
        "between",
        "The agent is on the way from one of the two to the other; of an event: from its end to its next beginning.",
        True,
    ),
    Word("doing", "The agent is busy with this event.", True),
    Word("has", "What an agent carries, or has mounted: at the start, or in a condition at a moment.", True),
    Word("any", "At least one of them: any robot, any agent.", True),
    Word("no", "None of them: no robot, no agent.", True),
    Word("robot", "The agents that are controllable and not human.", True),
    Word("agents", "A number of agents: robots, people and all others.", True),
)
"""The words of conditions, and before them, which several kinds of statements have."""


@dataclass(frozen=True)
class Who:
    """The agent that is named, or one of `others`, where there are any; None: any agent, or with `robots` any robot."""

    agent: Optional[Ref]
    robots: bool = False
    others: Tuple[Ref, ...] = ()

    @property
    def named(self) -> Tuple[Ref, ...]:
        """The agents that are named."""
        return () if self.agent is None else (self.agent, *self.others)


@dataclass(frozen=True)
class At:
    """`who at place`: it stands there, idle or at work."""

    who: Who
    place: Ref


@dataclass(frozen=True)
class OnWay:
    """`who on_way`: it is between two places; `who on_way from origin to target`: on this way; with `either_way`
    `who between origin and target`: on it in either direction.
    """

    who: Who
    origin: Optional[Ref] = None
    target: Optional[Ref] = None
    either_way: bool = False

    @property
    def ends(self) -> Tuple[Ref, ...]:
        """The places that are named."""
        return () if self.origin is None or self.target is None else (self.origin, self.target)

    def includes(self, a: str, b: str) -> bool:
        """True on the way from a to b."""
        named = tuple(ref.name for ref in self.ends)
        return named in ((), (a, b)) or (self.either_way and named == (b, a))


@dataclass(frozen=True)
class Doing:
    """`who doing event`: it does an event that takes time, or takes part in one until it ends."""

    who: Who
    event: Ref


@dataclass(frozen=True)
class Holds:
    """`state is_true`, or `is_false`."""

    state: Ref
    value: bool


@dataclass(frozen=True)
class Not:
    """`not part`; `no robot …` is `not any robot …`."""

    part: Condition


@dataclass(frozen=True)
class AllOf:
    """`first and second and …`."""

    parts: Tuple[Condition, ...]


@dataclass(frozen=True)
class AnyOf:
    """`first or second or …`."""

    parts: Tuple[Condition, ...]


@dataclass(frozen=True)
class Has:
    """`who has thing`: it carries it, or has mounted it."""

    who: Who
    thing: Ref


Atom = Union[At, OnWay, Doing, Holds, Has]

_SAID = {At: ("at", "POI", "place"), Doing: ("doing", "event", "event"), Has: ("has", "thing", "thing")}
"""What is said of somebody: the verb, the kind of its object, and the field that has it."""
_BY_VERB: Mapping[str, Any] = {verb: kind for kind, (verb, _, _) in _SAID.items()}


@dataclass(frozen=True)
class AtMostOf:
    """`at_most most robots at place, other`: of so many agents, or states, one of the parts is true, and of no more."""

    most: int
    parts: Tuple[Atom, ...]


Condition = Union[At, OnWay, Doing, Holds, Has, Not, AllOf, AnyOf, AtMostOf]
EventOrCondition = Union[Ref, Condition]


def atoms(condition: Condition) -> Iterator[Atom]:
    """The parts of a condition that have no parts, from left to right."""
    if isinstance(condition, Not):
        yield from atoms(condition.part)
    elif isinstance(condition, (AllOf, AnyOf, AtMostOf)):
        for part in condition.parts:
            yield from atoms(part)
    else:
        yield condition


def names_in(condition: Condition) -> Iterator[Tuple[str, Ref]]:
    """Each name in a condition behind the kind of thing that it stands for, from left to right."""
    for atom in atoms(condition):
        if isinstance(atom, Holds):
            yield "state", atom.state
            continue
        if atom.who.agent is not None:
            yield "agent", atom.who.agent
        if isinstance(atom, OnWay):
            yield from (("POI", ref) for ref in atom.ends)
        else:
            _, kind, field = _SAID[type(atom)]
            yield kind, getattr(atom, field)


def held_by(condition: Condition, robot: Ref) -> Condition:
    """A condition that holds only while the first one does: where any robot would do, it is this one."""
    if isinstance(condition, (AllOf, AnyOf)):
        return replace(condition, parts=tuple(held_by(part, robot) for part in condition.parts))
    if isinstance(condition, (At, OnWay, Doing, Has)):
        return replace(condition, who=by_robot(condition.who, robot))
    return condition


def by_robot(who: Who, robot: Ref) -> Who:
    """This robot where any robot would do; else the same."""
    return Who(robot) if who.agent is None and who.robots else who


def one_at(who: Who, place: Ref) -> Condition:
    """That one of them is at a place."""
    return AnyOf(stands_at(who, place)) if who.others else At(who, place)


def stands_at(who: Who, place: Ref) -> Tuple[At, ...]:
    """That each of them is at a place: of those that are named each alone."""
    return tuple(At(Who(agent), place) for agent in who.named) or (At(who, place),)


def condition_text(condition: Condition) -> str:
    """A condition as it is written in a scenario."""
    if isinstance(condition, Not):
        part = condition.part
        if isinstance(part, (At, OnWay, Doing, Has)) and part.who.agent is None:
            return "no" + condition_text(part)[len("any") :]
        return f"not {_bracketed(part, condition_text)}"
    if isinstance(condition, (AllOf, AnyOf)):
        return _joined(condition, condition_text)
    if isinstance(condition, AtMostOf):
        some = some_text(condition.most, _subjects(condition))
        others = dict.fromkeys(atom.place.name for atom in condition.parts if isinstance(atom, At))
        return f"at_most {some} {', '.join([predicate_text(condition.parts[0]), *list(others)[1:]])}"
    subject = condition.state.name if isinstance(condition, Holds) else who_text(condition.who)
    return f"{subject} {predicate_text(condition)}"


def _predicate(atom: Atom, on_way: str, name: Callable[[Ref], str]) -> str:
    """What is said of an agent. `on_way`: that it is between two places; `name`: what stands for a name."""
    if isinstance(atom, OnWay):
        form = "between {} and {}" if atom.either_way else f"{on_way} from {{}} to {{}}" if atom.ends else on_way
        return form.format(*map(name, atom.ends))
    verb, _, field = _SAID[type(atom)]
    return f"{verb} {name(getattr(atom, field))}"


def predicate_text(atom: Atom) -> str:
    """What is said of an agent, or of a state, as it is written: `at shelf`."""
    if isinstance(atom, Holds):
        return f"is_{str(atom.value).lower()}"
    return _predicate(atom, "on_way", lambda ref: ref.name)


def condition_words(condition: Condition, holds: bool = True) -> str:
    """A condition in English, as in "bot1 is at a and open is true"; with `holds` False its negation."""
    if isinstance(condition, Not):
        return condition_words(condition.part, not holds)
    if isinstance(condition, (AllOf, AnyOf)):
        return _joined(condition, condition_words) if holds else f"not ({_joined(condition, condition_words)})"
    if isinstance(condition, AtMostOf):
        few = "at most" if holds else "more than"
        verb, its = ("is", "its") if condition.most == 1 else ("are", "their")
        words = dict.fromkeys(predicate_words(atom, its) for atom in condition.parts)
        some = some_text(condition.most, _subjects(condition), shown=True)
        return f"{few} {some} {verb} {' or '.join(words)}"
    if isinstance(condition, Holds):
        return f"{condition.state.name} is {'true' if condition.value is holds else 'false'}"
    who, verb = who_text(condition.who, shown=True), "is" if holds else "is not"
    if condition.who.agent is None and not holds:
        who, verb, holds = "no" + who[len("any") :], "is", True
    if isinstance(condition, Has):
        return f"{who} {predicate_words(condition) if holds else f'does not have {condition.thing.shown}'}"
    return f"{who} {verb} {predicate_words(condition)}"


def predicate_words(atom: Atom, its: str = "its") -> str:
    """What is said of an agent, or of a state, in English, as in "at the shelf"."""
    if isinstance(atom, Holds):
        return str(atom.value).lower()
    return _predicate(atom, f"on {its} way", lambda ref: ref.shown)


def some_text(most: int, everybody: Collection[Union[Who, Ref]], shown: bool = False) -> str:
    """A number of these agents, or states: `2 robots`, `2 of cart1, cart2`; with `shown` as people read it."""
    refs = [one.agent if isinstance(one, Who) else one for one in everybody]
    named = dict.fromkeys((ref.shown if shown else ref.name) for ref in refs if ref is not None)
    if named:
        return f"{most} of {listed(named) if shown else ', '.join(named)}"
    robots = any(isinstance(one, Who) and one.robots for one in everybody)
    return f"{most} {'robot' if robots else 'agent'}{'' if most == 1 else 's'}"


def _subjects(condition: AtMostOf) -> List[Union[Who, Ref]]:
    return [atom.state if isinstance(atom, Holds) else atom.who for atom in condition.parts]


def _joined(condition: Union[AllOf, AnyOf], say: Callable[[Condition], str]) -> str:
    sign = " and " if isinstance(condition, AllOf) else " or "
    return sign.join(_bracketed(part, say) for part in condition.parts)


def _bracketed(part: Condition, say: Callable[[Condition], str]) -> str:
    return f"({say(part)})" if isinstance(part, (AllOf, AnyOf)) else say(part)


def who_text(who: Who, shown: bool = False) -> str:
    """Of whom a condition speaks; with `shown` what people read for an agent."""
    if who.agent is None:
        return f"any {'robot' if who.robots else 'agent'}"
    return " or ".join(agent.shown if shown else agent.name for agent in who.named)


def read_condition(reader: TreeReader, tree: Any) -> Condition:
    """A condition from its tree."""
    kind, children = tree.data, tree.children
    if kind == "negation":
        return Not(read_condition(reader, children[0]))
    if kind in ("all_of", "any_of"):
        return (AllOf if kind == "all_of" else AnyOf)(tuple(read_condition(reader, child) for child in children))
    if kind == "holds":
        return Holds(reader.ref(children[0]), children[1].type == "IS_TRUE")
    if kind == "few" and len(children) > 2:
        number, refs, value = children
        states = (Holds(ref, value.type == "IS_TRUE") for ref in reader.refs(refs))
        return AtMostOf(reader.count(number), tuple(states))
    if kind == "few":
        most, everybody = read_some(reader, children[0])
        if children[1].data == "at_one":
            places = reader.refs(children[1])
            return AtMostOf(most, tuple(At(who, place) for who in everybody for place in places))
        return AtMostOf(most, tuple(_read_predicate(reader, who, children[1]) for who in everybody))
    first = children[0].children[0]
    named = not isinstance(first, Token)
    who = Who(reader.ref(first)) if named else Who(None, robots=len(children[0].children) > 1)
    condition = _read_predicate(reader, who, children[1])
    return condition if named or first.type != "NO" else Not(condition)


def read_some(reader: TreeReader, tree: Any) -> Tuple[int, Tuple[Who, ...]]:
    """The number in `2 robots`, `2 agents` or `2 of cart1, cart2, cart3`, and of whom it is one."""
    number, *who = tree.children
    if who and not isinstance(who[0], Token):
        return reader.count(number), tuple(map(Who, reader.refs(who[0])))
    return reader.count(number), (Who(None, robots=bool(who) and who[0].type != "AGENTS"),)


def _read_predicate(reader: TreeReader, who: Who, tree: Any) -> Atom:
    """What is said of somebody."""
    refs = [reader.ref(child) for child in tree.children if child is not None]
    if tree.data in _BY_VERB:
        said: Atom = _BY_VERB[tree.data](who, *refs)
        return said
    origin, target = refs or (None, None)
    return OnWay(who, origin, target, tree.data == "between")
