"""Advice on the reaction, the time unit and the observer's tolerance, by how late commands took effect."""

from __future__ import annotations

from math import ceil, log10
from statistics import median
from typing import Any, Dict, Iterator, Sequence

from pursue_gen.diagnostics import counted

TIMES = 2.0
"""The reaction should be so many times what was needed at most: another mission has a busier machine. Not measured."""

ROOMY = 8.0
"""From so many times on it is worth while to say that less would do. Not measured."""

TOLERANCE = 0.1
"""The observer's ~tolerance where nothing else is said, in time units."""

_EXACT = 0.001
"""What stamps and clocks may be off, in time units."""


def reaction_advice(delays: Sequence[float], reaction: float, unit: float) -> Iterator[str]:
    """Sentences on delays in time units, of `unit` seconds each; none where there are no commands."""
    if not delays or reaction <= 0:
        return
    most = max(delays)
    yield (
        f"Reaction: {counted(len(delays), 'command')} took effect {median(delays):.3f} time units after they were due "
        f"(median), {most:.3f} at most ({1000 * most * unit:.0f} ms); the strategy allows {reaction:g}."
    )
    enough = rounded_up(TIMES * most)
    seconds = rounded_up(TIMES * most * unit / reaction)
    if most > reaction / TIMES:
        late = sum(delay > reaction + _EXACT for delay in delays)
        how = f"{late} came too late" if late else "That is near the limit"
        yield (
            f"{how}: allow more with --reaction {enough:g}; or longer time units, time_unit:={seconds:g}, with the "
            "scenario's numbers changed to that unit."
        )
    elif ROOMY * most <= reaction:
        yield f"--reaction {enough:g} would be enough on this machine; less wins more games."
    if most > TOLERANCE + _EXACT:
        yield f"The observer's tolerance should be longer than that, too: tolerance:={enough:g}."


def advice_json(delays: Sequence[float], reaction: float, unit: float) -> Dict[str, Any]:
    """The same for programs; times in time units, `unit` in seconds."""
    found = {"median": median(delays), "most": max(delays)} if delays else {}
    return {"commands": len(delays), "reaction": reaction, "unit": unit, **found}


def rounded_up(value: float) -> float:
    """The number rounded up to one digit that matters: 0.13 → 0.2; 0.001 at least."""
    if value <= _EXACT:
        return _EXACT
    size = 10.0 ** int(ceil(log10(value)) - 1)
    return float(f"{ceil(value / size - _EXACT) * size:.6g}")
