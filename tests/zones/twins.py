"""The implementations of the zone library, in one form for the tests: Python's, and the native one in two sizes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable, List, Sequence, Tuple

import pytest

from pursue_gen.zones.dbm import INF, Dbm, Number
from pursue_gen.zones.federation import Federation, predt
from tests.oracle import zones as oracle

try:
    from pursue_gen.zones.native import _zones
except ImportError:  # no compiler when the package was installed
    _zones = None  # type: ignore[assignment]

_UNBOUNDED = 1 << 30
"""No bound, for the native zones."""


@dataclass(frozen=True)
class NativeFederation:
    """The native functions on federations, by the names of `Federation`."""

    binding: Any
    zones: Tuple[Any, ...]

    def _made(self, zones: Sequence[Any]) -> NativeFederation:
        return NativeFederation(self.binding, tuple(zones))

    def __bool__(self) -> bool:
        return bool(self.zones)

    def includes_zone(self, zone: Any) -> bool:
        return bool(self.binding.contains(list(self.zones), zone))

    def union(self, other: NativeFederation) -> NativeFederation:
        zones: List[Any] = list(self.zones)
        for zone in other.zones:
            zones = self.binding.inserted(zones, zone)
        return self._made(zones)

    def intersect(self, other: NativeFederation) -> NativeFederation:
        return self._made(self.binding.intersection(list(self.zones), list(other.zones)))

    def minus(self, other: NativeFederation) -> NativeFederation:
        return self._made(self.binding.minus(list(self.zones), list(other.zones)))

    def reduced(self) -> NativeFederation:
        return self._made(self.binding.reduced(list(self.zones)))

    def disjoint(self) -> Tuple[Any, ...]:
        return tuple(self.binding.disjoint(list(self.zones)))

    def lasting(self, delay: int, universe: Any) -> NativeFederation:
        return self._made(self.binding.intersection(self.binding.lasting(list(self.zones), delay), [universe]))


@dataclass(frozen=True)
class Twin:
    """How an implementation makes its own zones and federations of Python's, and its timed predecessor."""

    zone: Callable[[Dbm], Any]
    federation: Callable[[Federation], Any]
    predt: Callable[[Any, Any], Any]


def _native(name: str) -> Twin:
    binding = getattr(_zones, name, None)

    def zone(python: Dbm) -> Any:
        assert binding is not None
        return native_zones(binding, [python])[0]

    def federation(python: Federation) -> NativeFederation:
        return NativeFederation(binding, tuple(map(zone, python.zones)))

    def predecessor(good: NativeFederation, bad: NativeFederation) -> NativeFederation:
        assert binding is not None
        return NativeFederation(binding, tuple(binding.predt(list(good.zones), list(bad.zones))))

    return Twin(zone, federation, predecessor)


def _itself(value: Any) -> Any:
    return value


_built = pytest.mark.skipif(_zones is None, reason="the native zone library is not built here (no compiler)")

twins = pytest.mark.parametrize(
    "twin",
    [
        pytest.param(Twin(_itself, _itself, predt), id="Python"),
        pytest.param(_native("short"), marks=_built, id="native, 16 bits"),
        pytest.param(_native("long"), marks=_built, id="native, 32 bits and padding"),
    ],
)


natives = pytest.mark.parametrize(
    "binding",
    [
        pytest.param(getattr(_zones, "short", None), marks=_built, id="native, 16 bits"),
        pytest.param(getattr(_zones, "long", None), marks=_built, id="native, 32 bits and padding"),
    ],
)


def native_zones(binding: Any, zones: Sequence[Dbm]) -> List[Any]:
    """Python's zones as a native library has them."""
    return [binding.Dbm(zone.dim, tuple(min(bound, _UNBOUNDED) for bound in zone.m)) for zone in zones]


def python(zone: Any) -> Dbm:
    """A zone of any implementation as Python's."""
    return Dbm(zone.dim, tuple(INF if bound >= _UNBOUNDED else bound for bound in zone.m))


def hull(one: Any, other: Any) -> Any:
    """The smallest zone that includes both, by their implementation or the oracle."""
    return oracle.hull(one, other) if isinstance(one, Dbm) else one.hull(other)


def reset(zone: Any, clocks: Sequence[int]) -> Any:
    """The zone after these clocks are set to 0, by its implementation or the oracle."""
    return oracle.reset(zone, clocks) if isinstance(zone, Dbm) else zone.reset(clocks)


def before_reset(zone: Any, clocks: Sequence[int]) -> Any:
    """What setting the clocks to 0 takes into the zone, by its implementation or the oracle."""
    return oracle.before_reset(zone, clocks) if isinstance(zone, Dbm) else zone.before_reset(clocks)


def extrapolated(zone: Any, largest: Sequence[int]) -> Any:
    """The zone without what lies beyond the constants, by its implementation or the oracle."""
    return oracle.extrapolated(zone, largest) if isinstance(zone, Dbm) else zone.extrapolated(largest)


def lasting(federation: Any, delay: int, universe: Any) -> Any:
    """From where every time within the delay stays in it, by its implementation or the oracle."""
    if isinstance(federation, Federation):
        return oracle.lasting(federation, delay, universe)
    return federation.lasting(delay, universe)


def includes_zone(federation: Any, zone: Any) -> bool:
    """True if every point of the zone is in it, by its implementation or the oracle."""
    if isinstance(federation, Federation):
        return oracle.includes_zone(federation, zone)
    return bool(federation.includes_zone(zone))


def includes(federation: Any, other: Any) -> bool:
    """True if every point of the other is in it."""
    return all(includes_zone(federation, zone) for zone in other.zones)


def holds(zones: Any, point: Sequence[Number]) -> bool:
    """True if the point is in the zone, or in one of the federation's zones."""
    parts = zones.zones if hasattr(zones, "zones") else (zones,)
    return any(python(zone).contains(point) for zone in parts)
