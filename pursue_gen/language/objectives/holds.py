"""`place a holds 1 robot`, `way a to b holds 1 robot`, `lift lift1 holds 1 robot`, and the same for every place and
every way: for how many there is room."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations
from typing import Any, Callable, ClassVar, Iterable, Iterator, Sequence, Tuple, cast

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error, listed
from pursue_gen.language.conditions import AllOf, At, AtMostOf, Atom, Not, OnWay, Who, some_text
from pursue_gen.language.objectives.base import Breaks, Counted, Easier, Safety, StatedObjective
from pursue_gen.language.refs import Ref
from pursue_gen.language.template import Template
from pursue_gen.language.word import Form, Word


class Holds(Safety):
    """There is room for so many robots, agents, or members of a list."""

    most: int
    who: Tuple[Who, ...]
    wants = "There is room for {some} {where}."
    in_one: ClassVar[str] = ""
    """In one of several rooms that have no names, in English; "": the room has one."""

    @property
    def where(self) -> str:
        """Where there is room, in English."""
        raise NotImplementedError

    def there(self, who: Who) -> Sequence[Atom]:
        """That somebody is there."""
        raise NotImplementedError

    @property
    def some(self) -> str:
        """For how many of whom there is room, in English."""
        return some_text(self.most, self.who, shown=True)

    @property
    def rooms(self) -> Tuple[AtMostOf, ...]:
        """The conditions that all hold while it is kept: one where there is one such room."""
        return (AtMostOf(self.most, tuple(atom for who in self.who for atom in self.there(who))),)

    @property
    def breaks(self) -> Breaks:
        rooms = self.rooms
        return Breaks(condition=Not(rooms[0] if len(rooms) == 1 else AllOf(rooms)))

    def easier(self, counted: Counted) -> Iterator[Easier]:
        most = max((len(counted(room)) for room in self.rooms), default=0)
        yield Easier(
            "room", self.where, f"more room {self.where}", self.most, range(self.most + 1, most + 1),
            lambda each, k: replace(each, most=k),
            lambda k: f"room for {replace(cast(Any, self), most=k).some} {self.where} instead of {self.some}",
        )  # fmt: skip

    def broken(self, beside: Callable[[str], str]) -> str:
        return f"more than {self.some} {'is' if self.most == 1 else 'are'} {self.where}"


@dataclass(frozen=True)
class PlaceHolds(Holds):
    """`place a holds 1 robot`: never are more than `most` of `who` there; several places hold so many together, with
    the ways between them."""

    places: Tuple[Ref, ...]
    most: int
    who: Tuple[Who, ...]
    span: Span = NOWHERE
    optional: int = 0

    template = Template("place {places:POIs=a} holds {most,who:some=1 robot}")
    note = "or 2 robots, 2 agents, 1 of bot1, bot2"
    own_words = (
        Word("place", "The places with room for so many; behind each, those to which somebody comes.", True),
        Word("holds", "There is room for so many, and no more.", True),
    )
    forms = (Form("what a place holds", "place {POI} holds {=1} robot"),)

    @property
    def where(self) -> str:
        together = "" if len(self.places) == 1 else "or between "
        return f"at {together}{listed(ref.shown for ref in self.places)}"

    def there(self, who: Who) -> Sequence[Atom]:
        ways = (OnWay(who, a, b, True) for a, b in combinations(self.places, 2))
        return (*(At(who, place) for place in self.places), *ways)

    def apart(self, one: str, other: str, place: str) -> bool:
        here = any(ref.name == place for ref in self.places)
        named = {who.agent.name for who in self.who if who.agent is not None}
        return here and self.most <= 1 and (not named or {one, other} <= named)

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        if kind == "POI" and any(ref.name == name for ref in self.places):
            others = [ref.name for ref in self.places if ref.name != name]
            yield f"holds {some_text(self.most, self.who)}" + (f", together with {listed(others)}" if others else "")


@dataclass(frozen=True)
class WayHolds(Holds):
    """`way a to b holds 1 robot`: never are more than `most` of `who` on it, in both directions together."""

    a: Ref
    b: Ref
    most: int
    who: Tuple[Who, ...]
    span: Span = NOWHERE
    optional: int = 0

    template = Template("way {a:POI=a} to {b:POI=b} holds {most,who:some=1 robot}")
    own_words = (Word("way", "The way between two places, in both directions together.", True),)
    forms = (Form("what a way holds", "way {POI} to {POI} holds {=1} robot"),)

    @property
    def where(self) -> str:
        return f"between {self.a.shown} and {self.b.shown}"

    def there(self, who: Who) -> Sequence[Atom]:
        return (OnWay(who, self.a, self.b, True),)

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        if kind == "POI" and name in (self.a.name, self.b.name):
            other = self.b if self.a.name == name else self.a
            yield f"the way to {other.name} holds {some_text(self.most, self.who)}, in both directions together"


@dataclass(frozen=True)
class LiftHolds(Holds):
    """`lift lift1 holds 1 robot`: never are more than `most` of `who` on the ways by it, all together. `building`:
    these ways.
    """

    lift: Ref
    most: int
    who: Tuple[Who, ...]
    span: Span = NOWHERE
    building: Tuple[Tuple[Ref, Ref], ...] = ()
    optional: int = 0

    template = Template("lift {lift:lift=lift1} holds {most,who:some=1 robot}")
    note = "without it, each lift holds 1 robot"
    forms = (Form("what a lift holds", "lift {lift} holds {=1} robot"),)

    @property
    def where(self) -> str:
        return f"in {self.lift.shown}"

    @property
    def rooms(self) -> Tuple[AtMostOf, ...]:
        return super().rooms if self.building else ()

    def there(self, who: Who) -> Sequence[Atom]:
        return [OnWay(who, a, b, True) for a, b in self.building]

    def in_building(self, places: Sequence[Ref], ways: Sequence[Tuple[Ref, Ref, str]]) -> LiftHolds:
        return replace(self, building=_each_once((a, b) for a, b, lift in ways if lift == self.lift.name))

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        if (kind, name) == ("lift", self.lift.name):
            yield f"holds {some_text(self.most, self.who)}"

    def check(self) -> Iterator[Diagnostic]:
        yield from super().check()
        if self.optional:
            hint = f"delete optional {self.optional}: how long {self.lift.name} takes is true of so many only"
            yield error("PML470", f"what {self.lift.name} holds is kept in any case", self.span, hint)


class EveryHolds(Holds):
    """There is room for so many in each of several rooms, which are those of the building (`in_building`)."""

    def atoms(self) -> Iterator[Sequence[Atom]]:
        """For each room that somebody is in it."""
        raise NotImplementedError

    @property
    def rooms(self) -> Tuple[AtMostOf, ...]:
        return tuple(AtMostOf(self.most, tuple(some)) for some in self.atoms())

    @property
    def where(self) -> str:
        return self.in_one.replace(" one ", " every ")

    def broken(self, beside: Callable[[str], str]) -> str:
        return super().broken(beside).replace(self.where, self.in_one)


@dataclass(frozen=True)
class EveryPlaceHolds(EveryHolds):
    """`every place holds 1 robot`: never are more than `most` of `who` at one place. `building`: its places."""

    most: int
    who: Tuple[Who, ...]
    span: Span = NOWHERE
    building: Tuple[Ref, ...] = ()
    optional: int = 0

    template = Template("every place holds {most,who:some=1 robot}")
    forms = (Form("what every place holds", "every place holds {=1} robot"),)
    in_one = "at one place"

    def in_building(self, places: Sequence[Ref], ways: Sequence[Tuple[Ref, Ref, str]]) -> EveryPlaceHolds:
        return replace(self, building=tuple(places))

    def atoms(self) -> Iterator[Sequence[Atom]]:
        return ([At(who, place) for who in self.who] for place in self.building)

    def apart(self, one: str, other: str, place: str) -> bool:
        named = {who.agent.name for who in self.who if who.agent is not None}
        return self.most <= 1 and (not named or {one, other} <= named)

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        if kind == "POI":
            yield f"holds {some_text(self.most, self.who)}, as every place"


@dataclass(frozen=True)
class EveryWayHolds(EveryHolds):
    """`every way holds 1 robot`: never are more than `most` of `who` on one, in both directions together. `building`:
    its ways."""

    most: int
    who: Tuple[Who, ...]
    span: Span = NOWHERE
    building: Tuple[Tuple[Ref, Ref], ...] = ()
    optional: int = 0

    template = Template("every way holds {most,who:some=1 robot}")
    forms = (Form("what every way holds", "every way holds {=1} robot"),)
    in_one = "on one way"

    def in_building(self, places: Sequence[Ref], ways: Sequence[Tuple[Ref, Ref, str]]) -> EveryWayHolds:
        return replace(self, building=_each_once((a, b) for a, b, _ in ways))

    def atoms(self) -> Iterator[Sequence[Atom]]:
        return ([OnWay(who, a, b, True) for who in self.who] for a, b in self.building)


def _each_once(ways: Iterable[Tuple[Ref, Ref]]) -> Tuple[Tuple[Ref, Ref], ...]:
    """The ways, one for both directions."""
    return tuple({frozenset((a.name, b.name)): (a, b) for a, b in ways}.values())


def rooms_in(objectives: Sequence[StatedObjective]) -> Iterator[Holds]:
    """Those of these objectives that say for how many there is room."""
    return (each for each in objectives if isinstance(each, Holds))


def lifts_in(objectives: Sequence[StatedObjective]) -> Iterator[Tuple[int, LiftHolds]]:
    """Those of them that say what a lift holds, each behind its number among them."""
    return ((k, each) for k, each in enumerate(objectives) if isinstance(each, LiftHolds))
