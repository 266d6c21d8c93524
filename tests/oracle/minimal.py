"""The bounds of a zone that the others do not imply, as `minimal.hpp` finds them."""

from __future__ import annotations

from typing import List, Tuple

from pursue_gen.zones.dbm import INF, LE_ZERO


def minimal_in_python(dim: int, matrix: Tuple[int, ...]) -> List[Tuple[int, int, int]]:
    """The bounds (i, j, raw) of a canonical matrix that the others, and clocks being >= 0, do not imply.

    Larsen, Larsson, Pettersson and Yi 1997: clocks at fixed differences form a class; each is bound to the first of its
    class, and between the first ones a bound is left out where a way round is as tight.
    """
    rows = [matrix[i * dim : i * dim + dim] for i in range(dim)]
    first = list(range(dim))
    for i, row in enumerate(rows):
        for j in range(i):
            # The difference of the two clocks is one number: each bound is `<=` and they add up to `<= 0`.
            if row[j] + rows[j][i] == 2 and row[j] & 1:
                first[i] = j
                break
    heads = [i for i in range(dim) if first[i] == i]
    from_zero = {first[k] for k in range(1, dim) if rows[0][k] == LE_ZERO}
    kept: List[Tuple[int, int, int]] = []
    for i, row in enumerate(rows):
        of_class = first[i]
        ways = [(k, row[k], rows[k]) for k in heads if k != i and row[k] < INF] if of_class == i else []
        for j, bound in enumerate(row):
            # That a clock is >= 0 goes without saying, also where it tells how large another of its class is at least.
            if i == j or bound >= INF or (i == 0 and (bound == LE_ZERO or j in from_zero)):
                continue
            if of_class == first[j]:
                if of_class in (i, j):
                    kept.append((i, j, bound))
            elif of_class == i and first[j] == j:
                for k, there, onward in ways:
                    if k != j and there + onward[j] - ((there | onward[j]) & 1) <= bound:
                        break
                else:
                    kept.append((i, j, bound))
    return kept
