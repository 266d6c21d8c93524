"""The scenario as it is and with the proposal, each solved: what changes in the verdict and the guaranteed time."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Dict, Optional, Tuple

from pursue_gen import api
from pursue_gen.language.numbers import Number, at_most
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.times import written_time
from pursue_gen.outcomes import LimitHit, Lost
from pursue_gen.solving.request import SolveRequest
from pursue_gen.synthesis.limits import Listener

WON, LOST, UNDECIDED = "won", "lost", "not decided"


@dataclass(frozen=True)
class Verdict:
    """WON, LOST or UNDECIDED, with the reason for the last two; `takes`: time units to the goal at worst, None where
    there is no goal or it was not found out; `period`: what was found for patrols that name none; `margin`: how late
    commands may be, in a sentence; `given_up`: the numbers of the optional objectives that are not promised.
    """

    verdict: str
    reason: str = ""
    takes: Optional[Fraction] = None
    has_goal: bool = False
    period: Optional[Number] = None
    margin: str = ""
    given_up: Tuple[int, ...] = ()

    @property
    def words(self) -> str:
        """In half a sentence."""
        text = self.verdict
        if self.verdict == WON and self.has_goal:
            worst = "not found out" if self.takes is None else f"at most {at_most(self.takes)} time units"
            text += f", to the goal {worst}"
        if self.period is not None:
            text += f", patrols every {written_time(self.period)}"
        if self.given_up:
            text += f", without optional {', '.join(map(str, self.given_up))}"
        return text

    def as_json(self) -> Dict[str, Any]:
        """For programs."""
        takes = None if self.takes is None else float(self.takes)
        data = {"verdict": self.verdict, "reason": self.reason, "takes": takes, "margin": self.margin}
        period = None if self.period is None else float(self.period)
        return {**data, "period": period, "given_up": list(self.given_up)}


def verdict_of(scenario: Scenario, request: SolveRequest, progress: Optional[Listener] = None) -> Verdict:
    """Solves the scenario within the limits of the request. Raises PursueError for what is no verdict."""
    try:
        solved = api.solve(scenario, request, progress)
    except (Lost, LimitHit) as problem:
        return Verdict(LOST if isinstance(problem, Lost) else UNDECIDED, problem.diagnostics[0].message)
    given_up = tuple(sorted({each.objective.optional for each in solved.scenario.given_up}))
    period = next((each.every for each in solved.scenario.patrols if each.least), None)
    has_goal = solved.solution.objective.reaches
    return Verdict(WON, "", solved.worst_time, has_goal, period, solved.margin_text(), given_up)


def compared(
    scenario: Scenario, proposed: Scenario, request: SolveRequest, progress: Optional[Listener] = None
) -> Tuple[Verdict, Verdict]:
    """The verdict as it is, slack included, and with the proposal, which needs no slack."""
    return verdict_of(scenario, request, progress), verdict_of(proposed, replace(request, slack=()), progress)
