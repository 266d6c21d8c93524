"""Plans that come from elsewhere: read for a network, and proven before anything is made of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional, Sequence, Tuple

from pursue_gen.diagnostics import Diagnostic, PursueError
from pursue_gen.pipeline import Rules, Solution, played, prove
from pursue_gen.synthesis.plan import read_plan
from pursue_gen.tga.network import Network, Objective


@dataclass(frozen=True)
class Trial:
    """A plan in one game: the proven solution, or what was found why it does not win there."""

    rules: Rules
    solution: Optional[Solution]
    findings: Tuple[Diagnostic, ...] = ()


def trials(text: str, file: str, network: Network, objective: Objective, games: Sequence[Rules]) -> Tuple[Trial, ...]:
    """The plan in each of the games, in order, until it wins one.

    `network` is the original's (ends controllable); `file` is what messages call the plan. Raises PursueError for a
    text that is no plan for this network.
    """
    done = []
    for rules in games:
        game = played(network, rules)
        strategy = read_plan(text, game, file)
        try:
            proven = prove(game, objective, strategy, rules.reaction)
        except PursueError as problem:
            done.append(Trial(rules, None, problem.diagnostics))
            continue
        done.append(Trial(rules, Solution(game, objective, proven, rules.reaction)))
        break
    return tuple(done)
