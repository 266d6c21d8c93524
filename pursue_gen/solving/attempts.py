"""Several promises at once: methods that find a win, or a loss, are tried in turn, then again with more work.

Most games that any method decides are decided with little work, but nobody knows beforehand by which method.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Optional, Sequence, Tuple, Union

from pursue_gen.solving.cut_off import lost_to_a_stay
from pursue_gen.solving.efforts import EFFORTS, Effort
from pursue_gen.solving.errands import excluded_by_an_errand
from pursue_gen.solving.found import Found
from pursue_gen.solving.lost_promises import lost_alone, lost_promises
from pursue_gen.solving.one_robot import lost_for_one
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.pinned import lost_to_pins
from pursue_gen.solving.policies import won_by_policy
from pursue_gen.solving.shares import Known, can_be_shared, won_in_shares
from pursue_gen.tga.network import Network, Objective


@dataclass(frozen=True)
class Attempt:
    """What one round of attempts tries, and with how much work; 0, False or () leaves a method out.

    `shares`: efforts of the search for shares. `alone`: promises that are lost alone, or because somebody stays at a
    place. `policy`: work for simple policies. `one_robot`: work for promises that one robot cannot keep together, of
    all games and of each. `pinned`: the same for robots that have to stay near others. `lost`: one or two promises that
    are lost.
    """

    shares: Sequence[Effort] = ()
    alone: bool = False
    policy: int = 0
    one_robot: Sequence[int] = ()
    pinned: Sequence[int] = ()
    lost: bool = False


_SHARED = (
    Attempt(EFFORTS[:1], alone=True),
    Attempt(EFFORTS[1:2], one_robot=(40_000_000, 2_500_000)),
    Attempt(EFFORTS[2:4], one_robot=(60_000_000, 20_000_000), pinned=(60_000_000, 40_000_000)),
    Attempt(policy=450_000),
    Attempt(EFFORTS[4:7], one_robot=(200_000_000, 100_000_000), lost=True),
    Attempt(EFFORTS[7:], policy=500_000),
)
"""For promises that several robots may keep. Measured on 200 lab scenarios: what one robot cannot keep took 16 million
units of work at most, and policies of all robots together win none."""

_ONE = (Attempt(alone=True), Attempt(policy=5_000_000, lost=True))
"""For those of one robot."""

BESIDE_A_GOAL = (Attempt(lost=True), Attempt(EFFORTS[2:3]))
"""For those that are to be kept until a goal is reached, where shares with less work do not win."""

_CLOCKS = 11
"""With more clocks a policy gets less work, as a zone costs more then, by the square. Measured on the ninth large lab,
where policies took 14 of 30 s in vain."""


def decided_by_attempts(
    network: Network,
    objective: Objective,
    reaction: Fraction,
    options: SolveOptions,
    attempts: Sequence[Attempt] = (),
) -> Union[Found, Tuple[Objective, ...]]:
    """A proven strategy, or parts of the objective that are lost; () where no attempt finds either. `attempts`: those
    that are made; (): of promises alone, as many robots may keep them."""
    start, known, shared = options.limits.now(), Known(), can_be_shared(network, objective)
    dear = max(1.0, ((len(network.clocks) + 1) / (_CLOCKS + 1)) ** 2) if shared else 1.0
    for each in attempts or (_SHARED if shared else _ONE):
        found: Optional[Found] = None
        lost: Tuple[Objective, ...] = ()
        if each.shares:
            found = won_in_shares(network, objective, reaction, options.since(start), each.shares, known)
        if found is None and each.alone:
            lost = lost_alone(network, objective, reaction, options.since(start))
            stay = None if lost else lost_to_a_stay(network, objective)
            lost = (stay.promises,) if stay else lost or excluded_by_an_errand(network, objective)
        if found is None and each.policy:
            found = won_by_policy(network, objective, reaction, int(each.policy / dear), options.since(start))
        if found is None and not lost and each.one_robot:
            lost = lost_for_one(network, objective, reaction, options.since(start), each.one_robot)
        if found is None and not lost and each.pinned:
            lost = lost_to_pins(network, objective, reaction, options.since(start), each.pinned)
        if found is None and not lost and each.lost:
            lost = lost_promises(network, objective, reaction, options.since(start))
        if found is not None or lost:
            return found or lost
    return ()
