"""Plans that come from elsewhere: read for a network, and proven before anything is made of them."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Optional, Sequence, Tuple

from pursue_gen.diagnostics import Diagnostic, PursueError, warning
from pursue_gen.files import LARGEST_TEXT, read_text
from pursue_gen.outcomes import LimitHit, NotProven, Unavailable
from pursue_gen.solving.least_time import unscaled
from pursue_gen.solving.options import DEFAULT, SolveOptions
from pursue_gen.solving.proving import prove
from pursue_gen.solving.rules import Rules, played, rules_text
from pursue_gen.solving.solution import Solution
from pursue_gen.synthesis.enforced import enforced
from pursue_gen.synthesis.limits import PROVING
from pursue_gen.synthesis.plan import read_plan
from pursue_gen.synthesis.strategy import Strategy, with_automata_of
from pursue_gen.tga.network import Network, Objective
from pursue_gen.tga.scale import common_denominator, scaled


@dataclass(frozen=True)
class Trial:
    """A plan in one game: the proven solution, or what was found why it does not win there, or is not proven to."""

    rules: Rules
    solution: Optional[Solution]
    problem: Optional[PursueError] = None

    @property
    def findings(self) -> Tuple[Diagnostic, ...]:
        """Why it is not proven."""
        return () if self.problem is None else self.problem.diagnostics

    @property
    def outcome(self) -> str:
        """In words."""
        if self.solution:
            return "the plan wins"
        return "not decided" if isinstance(self.problem, LimitHit) else "the plan does not win"

    def in_words(self) -> str:
        """The game, and the outcome in it."""
        return f"{rules_text(self.rules)}: {self.outcome}"


def problem_of(tried: Sequence[Trial]) -> Optional[PursueError]:
    """Why a plan is not proven in any of these games; None where it wins one."""
    if any(trial.solution for trial in tried):
        return None
    at_limit = any(isinstance(trial.problem, LimitHit) for trial in tried)
    return (LimitHit if at_limit else NotProven)(finding for trial in tried for finding in trial.findings)


def trials(
    text: str,
    file: str,
    network: Network,
    objective: Objective,
    games: Sequence[Rules],
    options: SolveOptions = DEFAULT,
) -> Tuple[Trial, ...]:
    """The plan in each of the games, in order, until it wins one.

    `network` is the original's (ends controllable); `file` is what messages call the plan; the options' limits are for
    all games together. Raises PursueError for a text that is no plan for this network.
    """
    start = options.limits.now()
    done = []
    for rules in games:
        game = played(network, rules)
        strategy = _read(text, game, file)
        try:
            left = options.since(start)
            with enforced(left.limits, PROVING):
                proven = prove(game, objective, strategy, rules.reaction, None, left, simpler=False)
        except Unavailable:
            raise
        except PursueError as problem:
            done.append(Trial(rules, None, problem))
            continue
        watched = with_automata_of(game, proven)
        done.append(Trial(rules, Solution(watched, objective, proven, rules.reaction, rules=rules)))
        break
    return tuple(done)


def _read(text: str, network: Network, file: str) -> Strategy:
    """The strategy in a plan, in times of the scenario or in those of its TGA.xml, where decimals are multiplied."""
    factor = common_denominator(network.times)
    try:
        return read_plan(text, network, file)
    except PursueError:
        if factor == 1:
            raise
        with suppress(PursueError):
            return unscaled(read_plan(text, scaled(network, factor), file), network, factor)
        raise


def try_plan(
    plan: Path, network: Network, objective: Objective, games: Sequence[Rules], options: SolveOptions = DEFAULT
) -> Tuple[Trial, ...]:
    """The plan in a file, tried as `trials` does."""
    text = read_text(plan, "a plan, such as UPPAAL_plan.txt", LARGEST_TEXT)
    return trials(text, str(plan), network, objective, games, options)


def take_plan(
    plan: Path, network: Network, objective: Objective, games: Sequence[Rules], options: SolveOptions = DEFAULT
) -> Solution:
    """A plan of the user's, proven; one that wins in the ideal game only has a warning.

    Raises NotProven or LimitHit for one that does not win, or that is not decided.
    """
    tried = try_plan(plan, network, objective, games, options)
    problem, won = problem_of(tried), tried[-1].solution
    if problem is not None:
        raise problem
    assert won is not None
    if len(tried) == 1:
        return won
    ideal, default = rules_text(tried[-1].rules), rules_text(tried[0].rules)
    message = f"{plan} wins in the ideal game only ({ideal}), not with {default}"
    hint = "it may lose when a message is late or a robot needs longer; without --plan a better one is looked for"
    return replace(won, warnings=(warning("CLI010", message, hint=hint),))
