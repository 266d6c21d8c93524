"""Promises shared out as in the workspace's plan, but for those of orders: these go to each robot in turn."""

from __future__ import annotations

from contextlib import suppress
from typing import Iterator, Optional

from pursue_gen.language.network_names import AT_RISK
from pursue_gen.outcomes import LimitHit
from pursue_gen.solving.efforts import Effort
from pursue_gen.solving.group_games import Group
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.shares import Known, SharesSearch
from pursue_gen.solving.subgoals import commanded_agents
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga.network import Network, Objective
from pursue_gen.tga.objectives import clock_of
from pursue_gen.tools.replanning.request import Request

_WORK, _GAME = 10_000_000, 4_000_000
"""The work of these shares at most, and of each of their games. Measured on an order in a ward with two robots."""


def shared_as_before(
    network: Network, objective: Objective, request: Request, options: SolveOptions, known: Known
) -> Optional[Strategy]:
    """A proven strategy in such shares that little work finds; None where it finds none. `known`: what that found."""
    groups = tuple(_groups(network, objective, request))
    if not groups:
        return None
    effort = Effort(_WORK, game=_GAME, guess=_GAME // 4, joins=False)
    with suppress(LimitHit):
        return SharesSearch(network, objective, request.rules.reaction, options, effort, known).found(groups)
    return None


def _groups(network: Network, objective: Objective, request: Request) -> Iterator[Group]:
    """Those of the shares, without what nobody has seen to so far and is asked for now."""
    robots = commanded_agents(network)
    asked = {automaton.name for automaton in network.automata if automaton.initial == AT_RISK}
    ordered = {name for name in asked if clock_of(name) in request.sooner}
    for sent, keeps in request.shares:
        team = sent.intersection(robots)
        mine = keeps - (ordered if team else asked)
        bad = tuple(place for place in objective.bad if place[0] in mine)
        if bad:
            yield Group(team, bad)
