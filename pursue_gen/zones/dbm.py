"""Zones: convex sets of clock valuations as difference bound matrices (Dill 1989; Bengtsson and Yi 2004).

A bound `x_i - x_j < c` or `<= c` is one integer, its *raw* form: `2*c + 1` for `<=`, `2*c` for `<`. So a smaller raw
bound is a tighter one, and the bound that says the opposite, seen from the other side, is `1 - raw`. Index 0 is the
constant 0, indices from 1 are clocks. Every zone lies in the valuations with all clocks >= 0, is canonical (all bounds
as tight as they can be) and holds at least one point: operations that may leave nothing return None.
"""

from __future__ import annotations

import operator
import threading
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import Callable, Iterable, List, Optional, Sequence, Tuple, Union

from pursue_gen.diagnostics import error
from pursue_gen.outcomes import Invalid


class _Hook(threading.local):
    look: Optional[Callable[[], None]] = None


_HOOK = _Hook()


def look_after(look: Optional[Callable[[], None]]) -> Optional[Callable[[], None]]:
    """Sets what `attend` calls in this thread (None: nothing); it may raise to end the work. Returns what it was."""
    before, _HOOK.look = _HOOK.look, look
    return before


def attend() -> None:
    """Called by whatever loops over zones, for each of them or for all that one is compared with."""
    if _HOOK.look is not None:
        _HOOK.look()


INF = 1 << 256
"""The raw bound of "no bound". Finite raw bounds are far smaller: `raw` makes none beyond `MOST`, and sums of as many
as there can be in a zone stay below."""

MOST = 1 << 200
"""The constants of bounds are below."""

LE_ZERO = 1
"""The raw bound `<= 0`."""

Number = Union[int, Fraction]


def raw(c: int, strict: bool) -> int:
    """The raw form of `< c` (strict) or `<= c`. Raises PursueError for a number that no zone can hold."""
    if not -MOST < c < MOST:
        hint = "use smaller times, or fractions with smaller denominators"
        raise Invalid([error("SYN013", "the times are too large, or too fine, to compute with", hint=hint)])
    return 2 * c + (0 if strict else 1)


def constant(bound: int) -> int:
    """The c of a finite raw bound."""
    return bound >> 1


def is_strict(bound: int) -> bool:
    """True for `<`, false for `<=`."""
    return not bound & 1


def add(a: int, b: int) -> int:
    """The bound of a sum from the bounds of its terms."""
    if a >= INF or b >= INF:
        return INF
    return a + b - ((a | b) & 1)


def complement(bound: int) -> int:
    """The raw bound of `x_j - x_i` that holds exactly where `x_i - x_j` is not within the (finite) bound."""
    return 1 - bound


@lru_cache(maxsize=None)
def _transposition(dim: int) -> Callable[[Tuple[int, ...]], Tuple[int, ...]]:
    """What transposes a matrix: each bound is replaced by that of the opposite difference."""
    if dim == 1:
        return lambda m: m
    return operator.itemgetter(*(j * dim + i for i in range(dim) for j in range(dim)))


def _tighten(m: List[int], dim: int, i: int, j: int, bound: int) -> None:
    """Take a bound into a canonical matrix, in place. Requires: it is tighter than the old one, and leaves a point."""
    # The new bound is used on ways to i and on from j only.
    onward = [(q, m_jq) for q, m_jq in enumerate(m[j * dim : j * dim + dim]) if m_jq < INF]
    for p in range(dim):
        at = p * dim
        to_i = m[at + i]
        if to_i >= INF:
            continue
        to_j = to_i + bound - ((to_i | bound) & 1)
        if to_j >= m[at + j]:
            continue  # the way there was as short before, and so are all that go on from j
        for q, m_jq in onward:
            through = to_j + m_jq - ((to_j | m_jq) & 1)
            if through < m[at + q]:
                m[at + q] = through


@dataclass(frozen=True)
class Dbm:
    """A zone: `m[i * dim + j]` is the raw bound of `x_i - x_j`, row by row. `dim` is the number of clocks plus one.

    Make one from `universe` or `zero` and the operations; the matrix must be canonical and not empty, and so are those
    that operations return. An operation on two zones requires one dimension; clocks are 1 to dim - 1; delays are scaled
    times, 0 or more.
    """

    dim: int
    m: Tuple[int, ...]

    @cached_property
    def _transposed(self) -> Tuple[int, ...]:
        """The transposed matrix: kept, as a strategy's zones are compared with very many others."""
        return _transposition(self.dim)(self.m)

    @staticmethod
    def universe(dim: int) -> Dbm:
        """All valuations: every clock >= 0."""
        m = [INF] * (dim * dim)
        for i in range(dim):
            m[i] = m[i * dim + i] = LE_ZERO
        return Dbm(dim, tuple(m))

    @staticmethod
    def zero(dim: int) -> Dbm:
        """The one valuation with all clocks 0."""
        return Dbm(dim, (LE_ZERO,) * (dim * dim))

    @staticmethod
    def of(dim: int, constraints: Iterable[Tuple[int, int, int]]) -> Optional[Dbm]:
        """The valuations that satisfy all `(i, j, raw)`; None if there are none."""
        return Dbm.universe(dim).constrained_all(constraints)

    def constrained(self, i: int, j: int, bound: int) -> Optional[Dbm]:
        """The points with `x_i - x_j` within the raw bound; None if there are none."""
        dim, old = self.dim, self.m
        if bound >= old[i * dim + j]:
            return self
        if add(old[j * dim + i], bound) < LE_ZERO:
            return None
        m = list(old)
        _tighten(m, dim, i, j, bound)
        return Dbm(dim, tuple(m))

    def constrained_all(self, constraints: Iterable[Tuple[int, int, int]]) -> Optional[Dbm]:
        """The points that satisfy all `(i, j, raw)`; None if there are none."""
        zone: Optional[Dbm] = self
        for i, j, bound in constraints:
            if zone is None:
                return None
            zone = zone.constrained(i, j, bound)
        return zone

    def is_disjoint(self, other: Dbm) -> bool:
        """True if the two have no point in common, as one pair of opposite bounds shows (may miss; never wrong)."""
        # Opposite bounds leave no point where their sum is below `<= 0`: where their raw forms add up to less than 2.
        return bool(min(map(operator.add, self.m, other._transposed)) < 2)

    def has_gap(self, other: Dbm) -> bool:
        """True if points not in either lie between the two, as one pair of opposite bounds shows."""
        # Two strict bounds at one constant leave a gap; `<=` and `<` there touch: their raw sum is 1.
        return bool(min(map(operator.add, self.m, other._transposed)) < 1)

    def intersect(self, other: Dbm) -> Optional[Dbm]:
        """The points in both; None if there are none."""
        assert self.dim == other.dim
        if self.is_disjoint(other):
            return None
        its = sum(map(operator.lt, other.m, self.m))
        if not its:
            return self
        mine = sum(map(operator.lt, self.m, other.m))
        if not mine:
            return other
        # The bounds of the one, one by one, on the other: most of them are implied by then.
        dim, m, bounds = self.dim, list(self.m), other.m
        if mine < its:
            m, bounds = list(other.m), self.m
        for k, bound in enumerate(bounds):
            if bound < m[k]:
                i, j = divmod(k, dim)
                if add(m[j * dim + i], bound) < LE_ZERO:
                    return None
                _tighten(m, dim, i, j, bound)
        return Dbm(dim, tuple(m))

    def joined(self, other: Dbm) -> Optional[Dbm]:
        """The points in either, if they make one zone; else None.

        They do where no point of the hull breaks a bound of the one and a bound of the other. The hull is canonical, so
        two more bounds leave a point unless the way round through both of them is shorter than 0.
        """
        attend()
        if self.has_gap(other):
            return None
        dim, m = self.dim, tuple(map(max, self.m, other.m))
        if m == self.m:
            return self
        if m == other.m:
            return other
        mine = [(k // dim, k % dim, 1 - bound) for k, bound in enumerate(self.m) if bound < m[k]]
        for k, bound in enumerate(other.m):
            if bound < m[k]:
                broken, p, q = 1 - bound, k // dim, k % dim
                for i, j, outside in mine:
                    there, back = m[i * dim + q], m[p * dim + j]
                    if there >= INF or back >= INF:
                        return None
                    # add(outside, add(there, add(broken, back))) < LE_ZERO, written out
                    odd = outside & there & broken & back & 1
                    if ((outside >> 1) + (there >> 1) + (broken >> 1) + (back >> 1)) * 2 + odd >= LE_ZERO:
                        return None
        return Dbm(dim, m)

    def includes(self, other: Dbm) -> bool:
        """True if every point of the other is in this one."""
        return all(map(operator.ge, self.m, other.m))

    def contains(self, point: Sequence[Number]) -> bool:
        """True if the valuation is in the zone; `point[k]` is the value of clock k + 1."""
        dim = self.dim
        values = (Fraction(0), *point)
        for i in range(dim):
            for j in range(dim):
                bound = self.m[i * dim + j]
                if bound < INF:
                    difference = values[i] - values[j]
                    if not (difference < bound >> 1 or (bound & 1 and difference == bound >> 1)):
                        return False
        return True

    def minus(self, other: Dbm) -> Tuple[Dbm, ...]:
        """The points that are not in the other, as disjoint zones."""
        assert self.dim == other.dim
        attend()
        if self.is_disjoint(other):
            return (self,)
        dim, theirs = self.dim, other.m
        rest: Optional[Dbm] = self
        pieces: List[Dbm] = []
        for k, mine in enumerate(self.m):
            bound = theirs[k]
            if bound >= mine or rest is None or bound >= rest.m[k]:
                continue
            i, j = divmod(k, dim)
            outside = rest.constrained(j, i, complement(bound))
            if outside is not None:
                pieces.append(outside)
            rest = rest.constrained(i, j, bound)
        # No common point after all: then it is the whole, in one piece.
        return tuple(pieces) if rest is not None else (self,)

    def up(self) -> Dbm:
        """The future: the valuations that some time leads to from the zone."""
        m = list(self.m)
        for i in range(1, self.dim):
            m[i * self.dim] = INF
        return Dbm(self.dim, tuple(m))

    def up_within(self, delay: int) -> Dbm:
        """The future by a time in [0, delay]."""
        assert delay >= 0
        m = list(self.m)
        for at in range(self.dim, self.dim * self.dim, self.dim):
            if m[at] < INF:
                m[at] += 2 * delay
        return Dbm(self.dim, tuple(m))

    def down(self) -> Dbm:
        """The past: the valuations from which some time leads into the zone."""
        dim, m = self.dim, list(self.m)
        for i in range(1, dim):
            # Nothing bounds a clock from below but 0 and the other clocks' being >= 0.
            m[i] = min(LE_ZERO, *(m[j * dim + i] for j in range(1, dim)))
        return Dbm(dim, tuple(m))

    def down_within(self, delay: int) -> Dbm:
        """The past by a time in [0, delay]."""
        assert delay >= 0
        dim, m = self.dim, list(self.m)
        for i in range(1, dim):
            m[i] = min(LE_ZERO, self.m[i] + 2 * delay, *(m[j * dim + i] for j in range(1, dim)))
        return Dbm(dim, tuple(m))
