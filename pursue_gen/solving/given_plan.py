"""Plans that come from elsewhere: read for a network, and proven before anything is made of them."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path
from typing import Optional, Sequence, Tuple

from pursue_gen.cli.console import show, tell
from pursue_gen.cli.progress import progress_line
from pursue_gen.diagnostics import Diagnostic, PursueError, warning
from pursue_gen.files import read_text
from pursue_gen.solving.options import in_words
from pursue_gen.solving.solution import Rules, Solution, played, prove
from pursue_gen.synthesis.limits import NO_LIMITS, UNDECIDED, Limits, Listener
from pursue_gen.synthesis.plan import read_plan
from pursue_gen.tga.network import Network, Objective


@dataclass(frozen=True)
class Trial:
    """A plan in one game: the proven solution, or what was found why it does not win there, or is not proven to."""

    rules: Rules
    solution: Optional[Solution]
    findings: Tuple[Diagnostic, ...] = ()

    @property
    def outcome(self) -> str:
        """In words."""
        if self.solution:
            return "the plan wins"
        return "not decided" if UNDECIDED in (finding.code for finding in self.findings) else "the plan does not win"


def exit_status(tried: Sequence[Trial]) -> int:
    """0: the plan wins; 4: it does not; 5: a limit was hit before that was known."""
    if any(trial.solution for trial in tried):
        return 0
    return 5 if any(finding.code == UNDECIDED for trial in tried for finding in trial.findings) else 4


def trials(
    text: str,
    file: str,
    network: Network,
    objective: Objective,
    games: Sequence[Rules],
    limits: Limits = NO_LIMITS,
    progress: Optional[Listener] = None,
) -> Tuple[Trial, ...]:
    """The plan in each of the games, in order, until it wins one.

    `network` is the original's (ends controllable); `file` is what messages call the plan; the limits are for all games
    together. Raises PursueError for a text that is no plan for this network.
    """
    start = time.monotonic()
    done = []
    for rules in games:
        game = played(network, rules)
        strategy = read_plan(text, game, file)
        try:
            left = limits.since(start)
            proven = prove(game, objective, strategy, rules.reaction, None, left, progress, simpler=False)
        except PursueError as problem:
            done.append(Trial(rules, None, problem.diagnostics))
            continue
        done.append(Trial(rules, Solution(game, objective, proven, rules.reaction, rules=rules)))
        break
    return tuple(done)


def try_plan(
    plan: Path, network: Network, objective: Objective, games: Sequence[Rules], limits: Limits
) -> Tuple[Trial, ...]:
    """The plan in a file, tried as `trials` does, with a line of progress on a terminal."""
    text = read_text(plan, "a plan, such as UPPAAL_plan.txt")
    with progress_line() as progress:
        return trials(text, str(plan), network, objective, games, limits, progress)


def take_plan(
    plan: Path, network: Network, objective: Objective, games: Sequence[Rules], limits: Limits
) -> Solution:
    """A plan of the user's, proven; one that wins in the ideal game only is taken with a warning.

    Raises PursueError with exit status 4 or 5 for one that does not win, or that is not decided.
    """
    tried = try_plan(plan, network, objective, games, limits)
    won = tried[-1].solution
    if won is None:
        raise PursueError([finding for trial in tried for finding in trial.findings], exit_status(tried))
    if len(tried) > 1:
        ideal, default = in_words(tried[-1].rules), in_words(tried[0].rules)
        message = f"{plan} wins in the ideal game only ({ideal}), not with {default}"
        hint = "it may lose when a message is late or a robot needs longer; without --plan a better one is looked for"
        show([warning("CLI010", message, hint=hint)])
    else:
        tell(f"{plan} wins: {in_words(tried[0].rules)}")
    return won
