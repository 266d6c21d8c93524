"""Every loop over zones is looked after: a round over many zones can be ended within it."""

from __future__ import annotations

from typing import Any, Callable, List

import pytest

from pursue_gen.zones.dbm import Dbm, look_after
from pursue_gen.zones.federation import Federation, predt
from tests.oracle.unions import merged, outside, with_neighbours, without
from tests.oracle.zones import past
from tests.zones.test_few_zones import OPERATIONS, unit_squares
from tests.zones.twins import includes_zone, lasting, native_zones, natives

NATIVE: List[Any] = [
    *OPERATIONS,
    pytest.param(lambda b, z: b.minus(z, z[:1]), id="minus one"),
    pytest.param(lambda b, z: b.touches(z[1:], z[0]), id="touches"),
    pytest.param(lambda b, z: b.contains(z[1:], z[0]), id="contains"),
    pytest.param(lambda b, z: z[0].boxed(z), id="boxed"),
]


@natives
@pytest.mark.parametrize("operation", NATIVE)
def test_native_loops_are_looked_after_where_no_zones_count(
    binding: Any, operation: Callable[[Any, List[Any]], Any]
) -> None:
    from pursue_gen.zones.native import _zones

    few, many = native_zones(binding, unit_squares(2)), native_zones(binding, unit_squares(3000))
    assert _zones.within_effort(0, 0, lambda: operation(binding, few)) is not None
    with pytest.raises(RuntimeError, match="enough"):
        _zones.within_effort(0, 0, lambda: operation(binding, many))


PYTHON: List[Any] = [
    pytest.param(lambda f: f.minus(Federation(f.zones[:1])), id="minus"),
    pytest.param(lambda f: f.union(f), id="union"),
    pytest.param(lambda f: f.intersect(f), id="intersect"),
    pytest.param(past, id="past"),
    pytest.param(lambda f: f.reduced(), id="reduced"),
    pytest.param(lambda f: includes_zone(f, f.zones[0].up()), id="includes"),
    pytest.param(lambda f: lasting(f, 1, f.zones[0].up()), id="lasting"),
    pytest.param(lambda f: predt(f, Federation()), id="predt"),
    pytest.param(lambda f: without(f.zones, f.zones[0]), id="without"),
    pytest.param(lambda f: outside(f.zones[0].up(), f.zones), id="outside"),
    pytest.param(lambda f: merged(f.zones), id="merged"),
    pytest.param(lambda f: with_neighbours(f.zones[0], f.zones), id="with neighbours"),
]


class _Enough(Exception):
    pass


@pytest.mark.parametrize("operation", PYTHON)
def test_loops_in_python_are_looked_after(operation: Callable[[Federation], object]) -> None:
    def looks(zones: List[Dbm], most: int) -> int:
        count = 0

        def look() -> None:
            nonlocal count
            count += 1
            if count > most:
                raise _Enough

        before = look_after(look)
        try:
            operation(Federation(tuple(zones)))
        finally:
            look_after(before)
        return count

    assert looks(unit_squares(3), 1000) > 0
    with pytest.raises(_Enough):
        looks(unit_squares(60), 20)
