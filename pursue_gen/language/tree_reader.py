"""Names and numbers from the trees of statements, and what is wrong with them."""

from __future__ import annotations

import re
from dataclasses import replace
from fractions import Fraction
from typing import Any, List, Mapping, Optional, Tuple

from lark import Token

from pursue_gen.diagnostics import Diagnostic, Span, error
from pursue_gen.language.measures import LENGTHS, Length, Units
from pursue_gen.language.numbers import MOST_DIGITS, Number, decimal_text, exact, is_fine, read_number
from pursue_gen.language.refs import Ref
from pursue_gen.language.times import TIMES, Time, has_unit
from pursue_gen.language.tokens import bare, shown, span_of

MOST = 1_000_000
"""The largest distance, duration, inverse speed or deadline: what comes of it must fit a machine's integers."""

_OTHER_TIME = "another time, or a unit of which it is a whole number, as in unit second"

_LARGEST_POWER = 6
"""The largest number has so many zeros."""


class TreeReader:
    """Reads pieces of statements; `findings`: what is wrong with those that were read. `member`: as in `Span`, of the
    statement that is read."""

    def __init__(self, file: str, labels: Mapping[str, str], unit: Optional[Number] = None) -> None:
        """`labels`: of the names that have one; `unit`: the seconds of a time unit, None: the scenario does not say."""
        self.file = file
        self._labels = labels
        self.member = ""
        self.unit = unit
        self.findings: List[Diagnostic] = []

    def at(self, token: Token) -> Span:
        """Where a token stands."""
        return span_of(token, self.file, self.member)

    def span(self, tree: Any) -> Span:
        """Where a tree stands."""
        meta = tree.meta
        return Span(self.file, meta.line, meta.column, meta.end_line, meta.end_column, self.member)

    def ref(self, tree: Any) -> Ref:
        """A name."""
        token = tree.children[0]
        return self._use(str(token), token)

    def refs(self, tree: Any) -> Tuple[Ref, ...]:
        """A list of names; none where there is no list."""
        return tuple(self.ref(child) for child in tree.children) if tree is not None else ()

    def agent_ref(self, agent: Any) -> Ref:
        """An agent's name, with quotes or without."""
        if not isinstance(agent, Token):
            return self.ref(agent)
        ref = self._use(bare(agent), agent)
        within = replace(ref.span, column=ref.span.column + 1, end_column=ref.span.end_column - 1)
        return replace(ref, span=within)

    def _use(self, name: str, token: Token) -> Ref:
        return Ref(name, self.at(token), self._labels.get(name, ""))

    def number(self, token: Token) -> Number:
        """The token's value; 1 after a complaint."""
        value = read_number(token)
        if value is not None and value <= MOST and is_fine(value):
            return value
        if value is not None and value > MOST:
            return self._too_large(token)
        finding = error("PML014", f"expected a number, found {shown(token)}", self.at(token), _instead(token))
        if value is not None:
            message = f"{shown(token, 20)} has more than {MOST_DIGITS} digits after the point"
            finding = error("PML280", message, self.at(token), "round it, or choose a smaller unit")
        self.findings.append(finding)
        return 1

    def time(self, token: Token) -> Number:
        """The token's time units, as in `20` or `2 min`; 1 after a complaint."""
        if not has_unit(token):
            value = self.number(token)
            return value if self.unit is None else Time(value, self.unit, decimal_text(value))
        seconds = self.seconds(token)
        if seconds is None:
            return 1
        if self.unit is None:
            self._no_unit(token, "a time", "a number without a unit is one of seconds")
            return 1
        value = exact(Fraction(seconds) / Fraction(self.unit))
        if not self._counts(token, value, "units of time", _OTHER_TIME):
            return 1
        return Time(value, self.unit, _blanks(token))

    def seconds(self, token: Token) -> Optional[Number]:
        """The seconds of a time with its unit; None after a complaint."""
        return self._measured(token, TIMES)

    def distance(self, token: Token) -> Number:
        """The token's units of distance, as in `12`, or `12 m` where time has a unit; 1 after a complaint."""
        if has_unit(token) and self.unit is None and LENGTHS.knows(token):
            self._no_unit(token, "a length", "distances are metres")
            return 1
        return self.metres(token)

    def metres(self, token: Token) -> Number:
        """The token's metres, as in `0.3` or `30 cm`; 1 after a complaint."""
        if not has_unit(token):
            return self.number(token)
        value = self._measured(token, LENGTHS)
        if value is None or not self._counts(token, value, "metres", "it with fewer digits"):
            return 1
        return Length(value, 1, _blanks(token))

    def _measured(self, token: Token, units: Units) -> Optional[Number]:
        """The value of a number with a unit of this kind behind it; None after a complaint."""
        value, instead = units.read(token)
        if value is None:
            instead = instead or f"a number with its unit, such as {units.examples}"
            if units is TIMES and token.split()[1:] == ["m"]:
                instead = f"{token.split()[0]} min where these are minutes: m is a metre"
            message = f"expected {units.called}, found {shown(token)}"
            self.findings.append(error("PML014", message, self.at(token), f"write {instead}"))
        return value

    def _no_unit(self, token: Token, called: str, then: str) -> None:
        message = f"{_blanks(token)} is {called}, and the scenario does not say what a unit of time is"
        hint = f"write a line above all others: unit second (then {then})"
        self.findings.append(error("PML420", message, self.at(token), hint))

    def _counts(self, token: Token, value: Number, units: str, other: str) -> bool:
        """False after a complaint: it is too large, or no number of these units with few digits."""
        if value > MOST:
            self._too_large(token)
        elif not is_fine(value):
            message = f"{_blanks(token)} is {decimal_text(value)} {units}: more than {MOST_DIGITS} digits"
            hint = f"nothing is rounded: write {other}"
            self.findings.append(error("PML280", f"{message} after the point", self.at(token), hint))
        return value <= MOST and is_fine(value)

    def count(self, token: Token) -> int:
        """The token's value, which says how often, or a rank; 1 after a complaint."""
        value = read_number(token)
        if isinstance(value, int) and value <= MOST:
            return value
        if value is not None and value > MOST:
            return self._too_large(token)
        hint = "write digits only" if value is None else "write it without decimals"
        self.findings.append(error("PML014", f"expected a whole number, found {shown(token)}", self.at(token), hint))
        return 1

    def _too_large(self, token: Token) -> int:
        message = f"{shown(token, 20)} is too large: {MOST} is the largest number"
        self.findings.append(error("PML014", message, self.at(token), "choose a larger unit"))
        return 1

    def window(self, tree: Any) -> Tuple[Number, Optional[Number]]:
        """The numbers of `5 to 8`; one alone has no second one."""
        low, _, high = tree.children
        return self.time(low), None if high is None else self.time(high)


def _blanks(text: str) -> str:
    """The text with one blank between its words."""
    return " ".join(text.split())


def _instead(text: str) -> str:
    """What to write in place of what is no number."""
    if re.fullmatch(r"[0-9]{1,9}\.", text):
        return f"write {text[:-1]}: a point stands between digits"
    if re.fullmatch(r"\.[0-9]{1,9}", text):
        return f"write 0{text}: a point stands between digits"
    power = re.fullmatch(r"([1-9])[eE]([0-9])", text)
    if power and int(power.group(2)) <= _LARGEST_POWER:
        return f"write {power.group(1)}{'0' * int(power.group(2))}: all digits of it"
    for units in (TIMES, LENGTHS):
        measure = units.apart(text)
        if measure:
            return f"write {measure}, with a blank, where it is {units.called}; else the number alone"
    if has_unit(text):
        return f"write {text.split()[0]}: a unit stands behind times and lengths only"
    unit = re.fullmatch(r"([0-9]{1,9}(?:\.[0-9]{1,9})?)[^\W\d]+", text)
    if unit:
        return f"write {unit.group(1)}: a number stands alone, in the unit of your choice"
    return "write digits only, with a point before decimals: 3 or 2.5"
