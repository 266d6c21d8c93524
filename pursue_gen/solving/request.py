"""Requests as text from a command line, and the proven solution of one."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import Dict, Optional, Sequence, Tuple

from pursue_gen.diagnostics import usage_error
from pursue_gen.solving.given_plan import take_plan
from pursue_gen.solving.options import DEFAULT, SolveOptions
from pursue_gen.solving.rules import CONTROLLABLE, IDEAL, REPORTED, Rules
from pursue_gen.solving.rules import DEFAULT as DEFAULT_RULES
from pursue_gen.solving.solution import Solution
from pursue_gen.solving.solvers import solved
from pursue_gen.synthesis.limits import NO_LIMITS, Listener
from pursue_gen.tga.network import Network, Objective
from pursue_runtime.numbers import DIGITS, exact

_GENERAL = "general"


@dataclass(frozen=True)
class SolveRequest:
    """Which controllers for which game, and where its strategy comes from.

    `controllers` and `reach_obj`: as for `partition`. `ends`, `reaction`, `slack`: the game, as typed; None or empty
    for the defaults of `Rules`. `within`: the time to the goal, as typed. `plan`: a file with a plan to use instead of
    solving. `options`: how to solve.
    """

    controllers: str = "distributed"
    reach_obj: str = "dedicated"
    ends: Optional[str] = None
    reaction: Optional[str] = None
    slack: Tuple[str, ...] = ()
    within: Optional[str] = None
    plan: Optional[Path] = None
    options: SolveOptions = DEFAULT

    @property
    def is_default(self) -> bool:
        """True if nothing but limits was asked for."""
        return replace(self, options=replace(self.options, limits=NO_LIMITS)) == SolveRequest()

    def since(self, start: float) -> SolveRequest:
        """The same with the limits that are left of work that began at `start` (of `limits.now`)."""
        return replace(self, options=self.options.since(start))

    @property
    def deadline(self) -> Optional[Fraction]:
        """The time units within which the goal has to be reached; None: some time. Raises PursueError (status 2)."""
        return None if self.within is None else _time("within", self.within, 1_000_000)

    @property
    def decides_ends(self) -> bool:
        """A general controller decides the ends itself, unless something else is asked for."""
        return self.ends is None and self.controllers == _GENERAL

    def rules(self, network: Network) -> Rules:
        """The game; the slack's agents are those of the network. Raises PursueError (exit status 2)."""
        reaction = DEFAULT_RULES.reaction if self.reaction is None else _time("reaction", self.reaction, 1000)
        ends = CONTROLLABLE if self.decides_ends else self.ends or DEFAULT_RULES.ends
        rules = Rules(ends, reaction, _slack(network, self.slack))
        if rules.slack and rules.ends == CONTROLLABLE:
            raise usage_error("slack has no meaning where the plan decides the ends", "use it with --ends reported")
        return rules

    def games(self, network: Network) -> Tuple[Rules, ...]:
        """The games to try a plan in: that of `rules`, and the ideal one unless it is ruled out. Raises as `rules`."""
        rules = self.rules(network)
        ruled_out = self.reaction is not None or bool(self.slack) or self.ends == REPORTED
        return (rules,) if ruled_out else (rules, IDEAL)


def solution_of(
    network: Network, objective: Objective, request: SolveRequest, progress: Optional[Listener] = None
) -> Solution:
    """The proven solution: of the plan that is given, or of a solver. `progress` replaces the options' listener.

    Raises what `take_plan` and `solved` do; with exit status 2 for options that contradict each other.
    """
    options = replace(request.options, progress=progress, within=request.deadline)
    if request.plan is None:
        return solved(network, objective, request.rules(network), options)
    if options.solver is not None or options.verifytga is not None:
        raise usage_error("there is a plan, and a solver to make one", "use --plan or --solver, not both")
    if options.within is not None:
        raise usage_error("there is a plan, and a time for one to be made", "use --plan or --within, not both")
    return take_plan(request.plan, network, objective, request.games(network), options)


def _time(name: str, text: str, most: int) -> Fraction:
    """A number of time units. Raises PursueError (exit status 2)."""
    hint = "a number of time units from 0 on, such as 0.1, 1/20 or 0"
    try:
        value = exact(text)
    except ValueError:
        raise usage_error(f"the {name} is '{text}'", hint) from None
    if value < 0 or value > most or value.denominator > 1000:
        raise usage_error(f"the {name} is {text}; expected 0 to {most}, in steps of at least 1/1000", hint)
    return value


def _slack(network: Network, texts: Sequence[str]) -> Dict[str, int]:
    """The slack per agent; a number alone is for every agent that the plan controls."""
    slack: Dict[str, int] = {}
    for text in texts:
        agent, named, number = text.rpartition("=")
        if not (number.isascii() and number.isdigit() and len(number) <= DIGITS) or (named and not agent):
            raise usage_error(f"the slack is '{text}'", "a number of time units such as 2, or for one agent bot1=2")
        controlled = [a.name for a in network.automata if any(edge.is_end and edge.controllable for edge in a.edges)]
        slack.update((name, int(number)) for name in ([agent] if named else controlled))
    return slack
