"""Linear temporal logic on finite traces with moments: what missions are held against, apart from the judges.

`!`, `&`, `|`, `->`, `<->`; `X` next, `F` eventually, `G` always, `U` until, `W` weak until. `F[20]` and `U[20]`: within
20 time units. An atom is a word, or a word with names in brackets: `at(bot, hall)`.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Dict, FrozenSet, Iterable, Iterator, List, Optional, Tuple

CLOSE = 1e-6
"""Two moments that are closer than this are the same."""

_TOKEN = re.compile(r"\s*(<->|->|[!&|()]|[FU]\[\d+\]|[XFGUW]\b|\w+\([^()]*\)|\w+)")
_BINARY = ("<->", "->", r"\|", "&", r"[UW](?:\[\d+\])?")
"""From the one that binds least to those that bind most."""


@dataclass(frozen=True)
class Letter:
    """What holds at a moment (time units from the start), and until the next letter."""

    at: float
    atoms: FrozenSet[str]


@dataclass(frozen=True)
class Trace:
    """A mission, up to `end` (time units). `complete`: nothing comes after that, and what is not done is missed; else
    it was cut off, and whatever still has time may come."""

    letters: Tuple[Letter, ...]
    end: float
    complete: bool


@dataclass(frozen=True)
class Formula:
    """An operator with its parts and its bound (time units, None: without), or an atom: `operator` is "" then."""

    operator: str
    parts: Tuple[Formula, ...] = ()
    bound: Optional[float] = None
    atom: str = ""

    def atoms(self) -> Iterator[str]:
        """The atoms in it."""
        if self.atom:
            yield self.atom
        for part in self.parts:
            yield from part.atoms()


def read_formula(text: str) -> Formula:
    """The formula of a text. Raises ValueError."""
    tokens: List[str] = []
    place = 0
    while text[place:].strip():
        match = _TOKEN.match(text, place)
        if match is None:
            raise ValueError(f"what is this: {text[place:]}")
        tokens.append(re.sub(r",\s*", ", ", match.group(1)))
        place = match.end()
    formula = _binary(tokens, 0)
    if tokens:
        raise ValueError(f"this is too much: {' '.join(tokens)}")
    _check_bounds(formula, True)
    return formula


def _binary(tokens: List[str], level: int) -> Formula:
    if level == len(_BINARY):
        return _unary(tokens)
    left = _binary(tokens, level + 1)
    if not tokens or not re.fullmatch(_BINARY[level], tokens[0]):
        return left
    operator, bound = _operator(tokens.pop(0))
    return Formula(operator, (left, _binary(tokens, level)), bound)


def _unary(tokens: List[str]) -> Formula:
    if not tokens:
        raise ValueError("something is missing at the end")
    token = tokens.pop(0)
    if token == "(":
        inner = _binary(tokens, 0)
        if not tokens or tokens.pop(0) != ")":
            raise ValueError("a bracket is not closed")
        return inner
    if re.fullmatch(r"[!XG]|F(\[\d+\])?", token):
        operator, bound = _operator(token)
        return Formula(operator, (_unary(tokens),), bound)
    if not re.match(r"\w", token):
        raise ValueError(f"an atom was expected in place of {token}")
    return Formula("", atom=token)


def _operator(token: str) -> Tuple[str, Optional[float]]:
    operator, _, bound = token.rstrip("]").partition("[")
    return operator, float(bound) if bound else None


def _check_bounds(formula: Formula, positive: bool) -> None:
    """A bound that is still open counts as kept, which is wrong where it is negated."""
    if formula.bound is not None and not positive:
        raise ValueError("a bound cannot stand in what is negated")
    for number, part in enumerate(formula.parts):
        negated = formula.operator in ("!", "<->") or (formula.operator == "->" and number == 0)
        _check_bounds(part, positive and not negated)


def is_kept(formula: Formula, trace: Trace) -> bool:
    """True if the mission keeps to the formula, from its first letter on."""
    return _Evaluation(trace).holds(formula, 0)


class _Evaluation:
    def __init__(self, trace: Trace) -> None:
        self._trace, self._letters = trace, trace.letters
        self._known: Dict[Tuple[int, int], bool] = {}  # by the identity of a formula: quicker than by its value

    def holds(self, formula: Formula, at: int) -> bool:
        """True if the formula holds at this letter."""
        key = (id(formula), at)
        if key not in self._known:
            self._known[key] = self._found(formula, at)
        return self._known[key]

    def _found(self, formula: Formula, at: int) -> bool:
        operator, parts = formula.operator, formula.parts
        if not operator:
            return formula.atom in self._letters[at].atoms
        if operator == "!":
            return not self.holds(parts[0], at)
        if operator in ("&", "|"):
            return (all if operator == "&" else any)(self.holds(part, at) for part in parts)
        if operator in ("->", "<->"):
            first, second = (self.holds(part, at) for part in parts)
            return (not first or second) if operator == "->" else first == second
        if operator == "X":
            return self.holds(parts[0], at + 1) if at + 1 < len(self._letters) else not self._trace.complete
        if operator == "G":
            return all(self.holds(parts[0], later) for later in range(at, len(self._letters)))
        return self._until(formula, at)

    def _until(self, formula: Formula, at: int) -> bool:
        """F, U and W: the second part comes, in time, and the first one holds until then."""
        before, then = formula.parts if len(formula.parts) == 2 else (None, formula.parts[0])
        last = float("inf") if formula.bound is None else self._letters[at].at + formula.bound
        for later in range(at, len(self._letters)):
            if self._letters[later].at > last + CLOSE:
                return False
            if self.holds(then, later):
                return True
            if before is not None and not self.holds(before, later):
                return False
        # An end that is open leaves time for what has a bound; without one, F and U want it now.
        open_still = formula.bound is not None and not self._trace.complete and self._trace.end <= last + CLOSE
        return formula.operator == "W" or open_still


def trace_of(words: Iterable[str], complete: bool = True) -> Trace:
    """A trace for examples: a letter a time unit, each word one letter with its atoms joined by `+` (`-`: none)."""
    letters = tuple(Letter(float(at), frozenset(word.split("+")) - {"-"}) for at, word in enumerate(words))
    return Trace(letters, float(len(letters) - 1), complete)
