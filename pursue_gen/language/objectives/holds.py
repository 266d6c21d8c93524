"""`place a holds 1 robot` and `way a to b holds 1 robot`: for how many there is room."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations
from typing import Any, Callable, ClassVar, Iterator, Sequence, Tuple, cast

from pursue_gen.diagnostics import NOWHERE, Span, listed
from pursue_gen.language.conditions import At, AtMostOf, Atom, Not, OnWay, Who, some_text
from pursue_gen.language.objectives.base import Breaks, Safety
from pursue_gen.language.refs import Ref
from pursue_gen.language.template import Template
from pursue_gen.language.word import Form, Word


class Holds(Safety):
    """There is room for so many robots, agents, or members of a list."""

    most: int
    who: Tuple[Who, ...]
    ends: ClassVar[Tuple[str, ...]] = ()

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
    def kept_if(self) -> AtMostOf:
        """The condition that holds while it is kept."""
        return AtMostOf(self.most, tuple(atom for who in self.who for atom in self.there(who)))

    @property
    def breaks(self) -> Breaks:
        return Breaks(condition=Not(self.kept_if))

    def with_room(self, most: int) -> Holds:
        """The same with room for another number."""
        return replace(cast(Any, self), most=most)  # type: ignore[no-any-return]

    def sentence(self, shown: Callable[[str], str]) -> str:
        return f"There is room for {self.some} {self.where}."

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

    template: ClassVar[Template] = Template("place {places:POIs=a} holds {most,who:some=1 robot}")
    note: ClassVar[str] = "or 2 robots, 2 agents, 1 of bot1, bot2"
    own_words: ClassVar[Tuple[Word, ...]] = (
        Word("place", "The places with room for so many; behind each, those to which somebody comes.", True),
        Word("holds", "There is room for so many, and no more.", True),
    )
    forms: ClassVar[Tuple[Form, ...]] = (Form("what a place holds", "place {POI} holds {=1} robot"),)

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

    template: ClassVar[Template] = Template("way {a:POI=a} to {b:POI=b} holds {most,who:some=1 robot}")
    own_words: ClassVar[Tuple[Word, ...]] = (
        Word("way", "The way between two places, in both directions together.", True),
    )
    forms: ClassVar[Tuple[Form, ...]] = (Form("what a way holds", "way {POI} to {POI} holds {=1} robot"),)

    @property
    def where(self) -> str:
        return f"between {self.a.shown} and {self.b.shown}"

    def there(self, who: Who) -> Sequence[Atom]:
        return (OnWay(who, self.a, self.b, True),)

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        if kind == "POI" and name in (self.a.name, self.b.name):
            other = self.b if self.a.name == name else self.a
            yield f"the way to {other.name} holds {some_text(self.most, self.who)}, in both directions together"
