"""Simple policies for robots with several duties, tried in front of the exact solver (docs/solver.md#policies)."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from fractions import Fraction
from typing import Optional

from pursue_gen.outcomes import LimitHit, NotProven
from pursue_gen.solving.due_moves import patrols
from pursue_gen.solving.found import Found
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.proving import prove
from pursue_gen.synthesis.solve import guess
from pursue_gen.tga.network import Network, Objective
from pursue_gen.tga.pauses import pauses


def won_by_policy(
    game: Network, objective: Objective, reaction: Fraction, work: int, options: SolveOptions
) -> Optional[Found]:
    """A proven strategy by a simple policy (see `Engine.guess`), without the clocks of pauses where they do not matter;
    None where so much work for each finds none. Where not only patrols are asked for, policies by which these
    wait until they are due are tried, too."""
    start, names = options.limits.now(), {name for name, _ in objective.bad}
    late = patrols(game) & names
    for free in (True, False) if pauses(game) else (False,):
        for put_off in (frozenset(), late) if late and late < names else (frozenset(),):
            how = options.engine, replace(options.limits.since(start), work=work), options.progress
            with suppress(NotProven, LimitHit):
                strategy, stats = guess(game, objective, reaction, *how, without_pauses=free, late=put_off)
                if strategy is not None:
                    proven = prove(game, objective, strategy, reaction, options=options.since(start), closed=True)
                    return Found(proven, stats)
    return None
