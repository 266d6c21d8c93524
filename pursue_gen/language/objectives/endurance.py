"""`battery agent lasts T, charges in T at place`: a robot that has to be at its charger in time."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Callable, Iterator, Optional, Sequence, Tuple

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error, listed, units
from pursue_gen.language.conditions import At, Not, Who
from pursue_gen.language.numbers import Number, decimal_text, exact, is_fine, whole_below
from pursue_gen.language.objectives.base import Breaks, Counted, Easier, Safety, StatedObjective, Whole, Words
from pursue_gen.language.refs import Ref
from pursue_gen.language.symbols import Role, Symbol
from pursue_gen.language.template import Template
from pursue_gen.language.times import instead, written_time
from pursue_gen.language.word import Form, Word

MOST_BATTERY_PARTS = 20
"""The most parts of a battery by time: its automaton has some four locations for each. Measured on night_bell: 152
discrete states with 5 of them, 460 with 16; 0.6 and 0.9 s for solving and proving."""


@dataclass(frozen=True)
class Endurance(Safety):
    """A robot's battery by time, full at the start: it lasts `lasts` time units away from `dock` since it was full, and
    is full when the robot has been there, idle or at work, for `charge` time units without a break.

    A charge that is broken off counts for nothing: the time since it was full goes on as if the robot had been away.
    With `parts`, each of so many equal parts counts: at the charger the whole parts that are left become one more after
    each `charge / parts` there, and a robot that leaves with some of them is back within as many `lasts / parts`.
    """

    agent: Ref
    lasts: Number
    charge: Number
    dock: Ref
    parts: int = 1
    span: Span = NOWHERE
    optional: int = 0
    word = ""
    limited_by = "lasts"
    last = True
    template = Template(
        '{agent:"agent"=bot} lasts {lasts:time=1200}, charges in {charge:time=300} [in {parts:count} parts]'
        " at {dock:POI=dock}"
    )
    own_words = (
        Word("lasts", "How long the robot may be away from the charger since its battery was full.", True),
        Word(
            "charges",
            "How long the robot has to be at the charger, without a break, until the battery is full again.",
            True,
        ),
        Word("parts", "So many equal parts, each of which counts when it is done, and nothing before.", True),
    )
    numbers = {
        "lasts": "Since it was full at the charger, the robot is back there within {}.".format,
        "in": "It is full again after {} at the charger, if the robot does not leave before.".format,
    }
    forms = (
        Form("a battery that lasts some time", template.to_fill_in),
        Form("a battery of which parts of a charge count", template.to_fill_in.replace(" at ", " in {=5} parts at ")),
    )

    @property
    def text(self) -> str:
        return f"battery {self.template.written(self)}"

    @property
    def full_text(self) -> str:
        return self.text

    @property
    def part(self) -> Number:
        """How long a part lasts."""
        return exact(Fraction(self.lasts) / self.parts)

    @property
    def part_charge(self) -> Number:
        """How long it takes to charge one."""
        return exact(Fraction(self.charge) / self.parts)

    @property
    def in_words(self) -> str:
        """How long it lasts, and where it is charged."""
        each = f" in {self.parts} parts" if self.parts > 1 else ""
        charged = f"full after {written_time(self.charge)}{each} at {self.dock.shown}"
        return f"battery lasts {written_time(self.lasts)}, {charged}"

    def sentence(self, shown: Callable[[str], str]) -> str:
        each = f"; each of {self.parts} equal parts of that counts" if self.parts > 1 else ""
        return (
            f"The battery of {self.agent.shown} lasts {units(self.lasts)} away from {self.dock.shown}, and is full "
            f"after {units(self.charge)} there{each}."
        )

    def broken(self, beside: Callable[[str], str]) -> str:
        lasted = f"{written_time(self.lasts)} since it was full"
        return f"the battery of {self.agent.shown} is empty: not at {self.dock.shown} within {lasted}"

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        if (kind, name) == ("agent", self.agent.name):
            yield shown(self.in_words)

    def check(self) -> Iterator[Diagnostic]:
        for word, number in (("lasts", self.lasts), ("charges in", self.charge)):
            if number <= 0:
                message = f"{word} {written_time(number)}: expected more than 0"
                yield error("PML312", message, self.span, "delete this line if the battery does not matter")
                return
        if not 1 <= self.parts <= MOST_BATTERY_PARTS:
            message = f"in {self.parts} parts: expected 1 to {MOST_BATTERY_PARTS}"
            yield error("PML312", message, self.span, "each part makes the game larger; write fewer, or leave in … out")
        elif not self.is_even:
            message = f"in {self.parts} parts: one would be {decimal_text(self.part)} of lasts"
            message += f" {written_time(self.lasts)}, charged in {decimal_text(self.part_charge)}"
            fits = [str(n) for n in range(2, MOST_BATTERY_PARTS + 1) if replace(self, parts=n).is_even]
            hint = f"write times that can be divided, or in {listed(fits, 'or')} parts; nothing is rounded"
            yield error("PML312", message, self.span, hint)

    @property
    def is_even(self) -> bool:
        """True where parts last, and are charged in, times that can be written."""
        return is_fine(self.part) and is_fine(self.part_charge)

    def possible_limits(self, limits: Sequence[int]) -> Sequence[int]:
        return [limit for limit in limits if is_fine(Fraction(limit) / self.parts)]

    def easier(self, counted: Counted) -> Iterator[Easier]:
        name, before, parts = self.agent.name, self.charge, self.parts
        yield Easier(
            "charges", name, f"a battery of {name} that is full sooner", before,
            self.possible_limits(whole_below(before, 1)), lambda each, k: replace(each, charge=k),
            lambda k: f"a battery of {name} that charges in {instead(k, before)}", 1,
        )  # fmt: skip
        possible = (n for n in (2 * parts, 4 * parts, 8 * parts) if n <= MOST_BATTERY_PARTS)
        finer = [n for n in possible if replace(self, parts=n).is_even]
        yield Easier(
            "parts", name, f"a battery of {name} that counts smaller parts of a charge", parts, finer,
            lambda each, k: replace(each, parts=k),
            lambda k: f"a battery of {name} that is charged in {k} parts instead of {parts}", 1,
        )  # fmt: skip

    def limit_in(self, location: str) -> Optional[Number]:
        symbol = Symbol.of(location)
        return exact(self.part * int(symbol.parts[0])) if symbol.role is Role.LEFT else super().limit_in(location)

    def status(self, location: str) -> str:
        symbol, agent, dock = Symbol.of(location), self.agent.shown, self.dock.shown
        parts, charges = f"{''.join(symbol.parts)} of {self.parts} parts", f"{agent} charges at {dock}"
        said = {
            Role.LEFT: f"{agent} has to be back at {dock} in time, since it left with {parts}",
            Role.CAME: f"{charges}; no part is done yet since it left with {parts}",
            Role.CAME_LATE: f"{charges}, and has to stay there until a part is done",
            Role.CHARGED: f"{charges}; {parts} are full",
        }
        return said.get(symbol.role) or super().status(location)

    def statement(self, objectives: Sequence[StatedObjective]) -> Whole:
        before = f"a battery of {self.agent.name} that lasts"
        return Whole((self,), self.text, "lasts", self.agent.name, "a battery that lasts longer", before)

    @property
    def words(self) -> Words:
        name, dock = self.agent.shown, self.dock.shown
        since = f"{name}'s battery was full at {dock}, or the start"
        if self.parts > 1:
            since = f"{name} left {dock} after a charge, or the start"
        return Words(
            due=f"{name}'s return to {dock}",
            due_by=f"{name} at {dock}",
            lane=f"battery: {name}",
            since=since,
            statuses={
                Role.IDLE: f"full, {name} is at {dock}",
                Role.CHARGING: f"{name} charges at {dock}",
                Role.EMPTY: f"{name} charges at {dock}, and has to stay there until it is full",
                Role.AT_RISK: f"{name} has to be back at {dock} in time",
                Role.LOSE: "empty",
            },
            must=f"{name} has to be back at {dock}",
            there="full",
            kept="back at the charger",
        )

    @property
    def breaks(self) -> Breaks:
        there = At(Who(self.agent), self.dock)
        return Breaks(begins=Not(there), by_robots=True, stands=(there,))


def batteries_in(objectives: Sequence[StatedObjective]) -> Iterator[Tuple[int, Endurance]]:
    """The batteries by time, each behind its number among these objectives."""
    return ((k, each) for k, each in enumerate(objectives) if isinstance(each, Endurance))
