"""Exact times as integers: the factors that make them so."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import gcd
from typing import Iterable, Tuple

from pursue_gen.language.numbers import Number, exact
from pursue_gen.tga.network import ClockBound, Edge, Location, Network


def least_common_multiple(numbers: Iterable[int]) -> int:
    """The least positive multiple of all of the positive numbers; 1 for none."""
    result = 1
    for number in numbers:
        result = result * number // gcd(result, number)
    return result


def common_denominator(times: Iterable[Number]) -> int:
    """The least scale at which all of the times are integers; 1 for none."""
    return least_common_multiple({time.denominator for time in times})


def scaled(network: Network, factor: Number) -> Network:
    """The same network with all times multiplied: its time unit is `factor` times shorter."""

    def bounds(some: Tuple[ClockBound, ...]) -> Tuple[ClockBound, ...]:
        return tuple(replace(bound, bound=exact(bound.bound * factor)) for bound in some)

    def location(one: Location) -> Location:
        return replace(one, invariant=bounds(one.invariant))

    def edge(one: Edge) -> Edge:
        return replace(one, guard=replace(one.guard, clocks=bounds(one.guard.clocks)))

    start = tuple(replace(constraint, bound=Fraction(constraint.bound * factor)) for constraint in network.start)
    changed = network.with_each(lambda a: a.with_locations(location).with_edges(map(edge, a.edges)))
    return replace(changed, start=start)
