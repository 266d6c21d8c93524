"""Scenarios and games solved, plans proven, and why a scenario is not won; what is made of a solved scenario: a
workspace, simulated missions; and new plans on the way."""

from __future__ import annotations

import traceback
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, Dict, Iterable, List, Mapping, Optional, Tuple

from pursue_gen.api.scenarios import File, Game, check_words, default_request, game, settle
from pursue_gen.diagnostics import PursueError
from pursue_gen.language.numbers import Number
from pursue_gen.language.scenario import Agent, Scenario
from pursue_gen.outcomes import LimitHit, Lost

if TYPE_CHECKING:
    from pursue_gen.proof.margin import Margin
    from pursue_gen.solving.answers import Answer
    from pursue_gen.solving.given_plan import Trial
    from pursue_gen.solving.request import SolveRequest
    from pursue_gen.solving.solution import Solution
    from pursue_gen.synthesis.limits import Listener
    from pursue_gen.tools.simulation.runs import Summary
    from pursue_gen.workspace.make import Extras, Made

Margins = Tuple["Margin", Optional["Margin"]]
"""How late commands may come: with this strategy, and in this game with one that is made for it."""


@dataclass(frozen=True, repr=False)
class SolvedGame:
    """A game that is won: the solution, whose strategy is proven, and what was asked for."""

    solution: Solution
    request: SolveRequest

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {self.in_words()[0]}>"

    @property
    def plan(self) -> str:
        """The strategy in the format of UPPAAL-TIGA's."""
        from pursue_gen.synthesis.plan import write_plan

        return write_plan(self.solution.strategy, self.solution.network, self.solution.objective)

    @cached_property
    def worst_time(self) -> Optional[Fraction]:
        """In how many time units it comes to the goal at worst; None without a goal, or where that is not found out."""
        from pursue_gen.solving.solution import guaranteed

        known = self.solution.guarantee
        if not self.solution.objective.reaches or (known is not None and known.worst is not None):
            return None if known is None else known.worst
        return guaranteed(self.solution, limits=self.request.options.limits).worst

    @property
    def _unit(self) -> Optional[Number]:
        """The seconds of a time unit; None: nothing says that."""
        return None

    def margins(self, thorough: bool = False) -> Margins:
        """How late commands may come, as far as it is quickly found; `thorough`: all of it, and for the game, too."""
        from pursue_gen.solving.verdict import margins

        return margins(self.solution, thorough, self.request.options.limits)

    def margin_text(self, margins: Optional[Margins] = None) -> str:
        """The margins, by default those that are quickly found, in sentences."""
        from pursue_gen.solving.verdict import margin_text

        return margin_text(self.solution, *(margins or self.margins()), unit=self._unit)

    def in_words(self) -> List[str]:
        """The verdict, and what else there is to know, in lines for people."""
        from pursue_gen.solving.rules import rules_text
        from pursue_gen.solving.verdict import verdict_text

        if self.request.plan is None:
            return [verdict_text(self.solution, self._unit)]
        return [] if self.solution.warnings else [f"{self.request.plan} wins: {rules_text(self.solution.rules)}"]

    def as_json(self, margins: Optional[Margins] = None) -> Dict[str, Any]:
        """The verdict as `pursue-gen solve --json` prints it; without margins where there are none."""
        from pursue_gen.solving.verdict import verdict_json

        return verdict_json(self.solution.rules, self.solution, *(margins or ()))


@dataclass(frozen=True, repr=False)
class Solved(SolvedGame):
    """A scenario that is won: `scenario` has what is promised, `given_up` in it is what is optional and is not."""

    scenario: Scenario

    @property
    def _unit(self) -> Optional[Number]:
        return self.scenario.unit

    @cached_property
    def answers(self) -> List[Answer]:
        """How late promises with a deadline are kept at worst, where a fixed amount of work tells."""
        from pursue_gen.solving.answers import answers

        return answers(self.scenario, self.solution, self.request.options.limits)

    @cached_property
    def unneeded(self) -> Tuple[Agent, ...]:
        """The robots and allies that the strategy does without."""
        from pursue_gen.partition import unneeded

        return unneeded(self.scenario, self.solution.strategy)

    @cached_property
    def orders(self) -> Mapping[str, str]:
        """What people may order during a mission, with why it would be refused at its start, "" where it would not."""
        if not self.scenario.orders:
            return {}
        from pursue_gen.tools.replanning.menu import at_start

        return dict(at_start(self.scenario, self.solution))

    def _orders_in_words(self) -> List[str]:
        taken = [self.scenario.shown(name) for name, why in self.orders.items() if not why]
        lines = [f"Orders that would be accepted at the start, each alone: {', '.join(taken)}."] if taken else []
        refused = ((self.scenario.shown(name), why) for name, why in self.orders.items() if why)
        return lines + [f"{name} would be refused: {why}." for name, why in refused]

    def in_words(self) -> List[str]:
        """The verdict, answers, promises, orders, what is assumed and who is not needed, in lines for people."""
        from pursue_gen.language.sentences import condition_of_promise
        from pursue_gen.partition import unneeded_words

        assumed = condition_of_promise(self.scenario) if self.request.plan is None else ""
        lines = [*super().in_words(), *(answer.in_words() for answer in self.answers), *promises_of(self.scenario)]
        lines += self._orders_in_words() if self.request.plan is None else []
        lines += [f"This holds {assumed}."] if assumed else []
        return [line for line in (*lines, unneeded_words(self.unneeded)) if line]

    def as_json(self, margins: Optional[Margins] = None) -> Dict[str, Any]:
        """As for a game, with answers, periods, what is promised and who is not needed."""
        from pursue_gen.solving.verdict import optional_json, periods_json

        late = {"answers": [answer.as_json() for answer in self.answers]}
        alone = {"not_needed": [agent.name for agent in self.unneeded]}
        more = {**periods_json(self.scenario), **optional_json(self.scenario)}
        ordered = {"orders": self.orders} if self.orders else {}
        return {**super().as_json(margins), **late, **alone, **more, **ordered}


def promises_of(scenario: Scenario, won: bool = True) -> List[str]:
    """Which periods were found for patrols, and which optional objectives are promised, in sentences.

    Of a scenario that is not won, what is known of periods.
    """
    from pursue_gen.language.sentences import periods_found, promise_words

    promised = promise_words(scenario) if won else []
    return [*periods_found(scenario, won), *(f"{sentence}." for sentence in promised)]


def solve(scenario: Scenario, request: Optional[SolveRequest] = None, progress: Optional[Listener] = None) -> Solved:
    """The scenario with a strategy that wins whatever the others do, proven by a second, independent program.

    `progress` is called a few times a second. Raises Lost where the objective cannot be met, TooSlow where not within
    the time that was asked for, NotProven where the checker refuses a strategy, LimitHit at a limit, Invalid for a
    scenario with errors, and another PursueError for a request that has no meaning.

    >>> solved = solve(read("scenarios/thesis/scenario_1.pur"), request(seconds=30))
    >>> float(solved.worst_time)
    23.302
    >>> solved.solution.warnings, solved.answers
    ((), [])
    """
    from pursue_gen.solving.optional import promised_of

    wanted = request or default_request()
    start = wanted.options.limits.now()
    settled = settle(scenario, wanted, progress)
    found = promised_of(settled, wanted.since(start), progress)
    return Solved(found.solution, wanted, found.scenario)


def solve_game(game: Game, request: Optional[SolveRequest] = None, progress: Optional[Listener] = None) -> SolvedGame:
    """As `solve`, for a game that `read_game` has read. Raises as it."""
    from pursue_gen.solving.request import solution_of

    wanted = request or default_request()
    return SolvedGame(solution_of(*game, wanted, progress), wanted)


def verdict_of(problem: PursueError, game: Game, request: Optional[SolveRequest] = None) -> Dict[str, Any]:
    """The verdict as `Solved.as_json` has it, on a game for which `solve` or `solve_game` raised this."""
    from pursue_gen.solving.verdict import verdict_json

    return verdict_json((request or default_request()).rules(game[0]), problem)


def verify(
    scenario: Scenario, plan: File, request: Optional[SolveRequest] = None, progress: Optional[Listener] = None
) -> Tuple[Scenario, Tuple[Trial, ...]]:
    """A plan's trials: in the game of the request, then in the ideal one unless the request rules that out.

    The first scenario of which it wins, with fewer and fewer optional objectives, comes with them.

    >>> import tempfile, pathlib
    >>> floor = read("scenarios/thesis/scenario_1.pur")
    >>> file = pathlib.Path(tempfile.mkdtemp()) / "plan.txt"
    >>> _ = file.write_text(solve(floor).plan)
    >>> [trial.outcome for trial in verify(floor, file)[1]]
    ['the plan wins']
    """
    from pursue_gen.solving.optional import try_plan_of

    wanted = request or default_request()
    return try_plan_of(settle(scenario, wanted), Path(plan), wanted, replace(wanted.options, progress=progress))


def verify_game(
    game: Game, plan: File, request: Optional[SolveRequest] = None, progress: Optional[Listener] = None
) -> Tuple[Trial, ...]:
    """As `verify`, for a game that `read_game` has read."""
    from pursue_gen.solving.given_plan import try_plan

    wanted = request or default_request()
    return try_plan(Path(plan), *game, wanted.games(game[0]), replace(wanted.options, progress=progress))


def problem_of(trials: Iterable[Trial]) -> Optional[PursueError]:
    """Why a plan is not proven in any of these games: a NotProven or LimitHit; None where it wins one."""
    from pursue_gen.solving.given_plan import problem_of

    return problem_of(tuple(trials))


@dataclass(frozen=True)
class Why:
    """Why a scenario is not won, or not decided: in words, and as JSON."""

    text: str
    data: Dict[str, Any]


def can_explain(problem: PursueError, request: Optional[SolveRequest] = None) -> bool:
    """True for a scenario that the built-in solver finds lost, or does not decide within a limit."""
    from pursue_gen.synthesis.limits import UNDECIDED

    wanted = request or default_request()
    undecided = isinstance(problem, LimitHit) and problem.diagnostics[0].code == UNDECIDED and wanted.plan is None
    return wanted.options.solver is None and (undecided or isinstance(problem, Lost))


def explain(
    scenario: Scenario,
    problem: PursueError,
    request: Optional[SolveRequest] = None,
    progress: Optional[Listener] = None,
) -> Why:
    """Why `solve` raised this, found with a fixed amount of work, for a problem that `can_explain` knows.

    Of a scenario that is lost: which changes would win it, and a play that is lost. Of one that was not decided: what
    makes it so large.

    >>> bot = 'poi "desk" event "call" event "come" duration 3 agent "bot" controllable location desk can_do come '
    >>> lost = parse(bot + 'agent "man" location desk can_do call objective: if call then come within 3')
    >>> try:
    ...     solve(lost)
    ... except Lost as problem:
    ...     print(explain(lost, problem).text)
    How it goes wrong, for example: man prevents it ...
    Each of these alone would change that, the smallest change first (found by solving again):
      - a deadline of 6 instead of 3 for come (5 is not enough; line 1)
    ...
    """
    from pursue_gen.explanation import costs
    from pursue_gen.explanation import explain as lost

    traceback.clear_frames(problem.__traceback__)  # what the search that has ended holds, else counts as in use
    wanted = request or default_request()
    scenario = settle(scenario, wanted, progress)
    scenario = scenario.giving_up(scenario.optional)
    rules, limits = wanted.rules(game(scenario)[0]), wanted.options.limits
    if isinstance(problem, Lost):
        found = lost.explain(scenario, rules, limits, progress, problem.parts)
        return Why(lost.render(found).rstrip(), {"explanation": lost.as_json(found)})
    large = costs.costs(scenario, rules, limits, progress, "" if wanted.within is None else f"--within {wanted.within}")
    return Why(costs.in_words(large), {"costs": costs.as_json(large)})


def write_workspace(
    solved: Solved, folder: Optional[File] = None, extras: Optional[Extras] = None, force: bool = False
) -> Made:
    """Writes a ROS 1 workspace, to `workspace_out/<scenario>` where no folder is given.

    `extras`: machines, containers, services, and where robots stand; `force`: files that a person has edited are
    replaced. Raises PursueError, with nothing written, where they are in the way.

    >>> import tempfile
    >>> made = write_workspace(solve(read("scenarios/thesis/scenario_1.pur")), tempfile.mkdtemp())
    >>> sorted(package.name for package in (made.folder / "src").glob("controller_*"))
    ['controller_bot1', 'controller_bot2']
    """
    from pursue_gen.workspace.make import Extras, make_workspace

    place = None if folder is None else Path(folder)
    return make_workspace(solved.scenario, solved.solution, solved.request, extras or Extras(), place, force)


def simulate(
    solved: Solved,
    runs: int = 1000,
    seed: int = 1,
    opponent: str = "mixed",
    faults: str = "none",
    until: Optional[float] = None,
    *,
    jobs: int = 1,
    scheduler: Optional[str] = None,
    progress: Callable[[int], Any] = lambda done: None,
) -> Summary:
    """Missions with the generated code in a simulated world, each judged; the same for the same seeds on all machines.

    `seed`: the number of the first mission. `opponent`: "random", "worst", "still" or "mixed"; `faults`: as for
    `pursue-gen sim`; `until`: when a mission is over (time units; None: 1000 with a goal, or twice the
    time to it if that is more; else 200); `jobs`: so many processes; `scheduler`: the address of a Dask scheduler
    instead. `progress`: called with how many are done. Raises PursueError.

    >>> summary = simulate(solve(read("scenarios/thesis/scenario_1.pur")), runs=20)
    >>> summary.missions, summary.failed, [row.end for row in summary.rows]
    (20, 0, ['goal'])
    """
    from pursue_gen.tools.simulation.cluster import cluster, outcomes_on
    from pursue_gen.tools.simulation.faults import read_faults
    from pursue_gen.tools.simulation.runs import make_case, simulate

    kinds = read_faults(faults)
    check_words(opponent=opponent)
    case, knows = make_case(solved.scenario, solved.solution, solved.request, opponent, kinds, until)
    seeds = range(seed, seed + runs)
    played = None if scheduler is None else outcomes_on(cluster(scheduler), case, seeds)
    return simulate(case, seeds, jobs, progress, remaining=knows, played=played)


def replan(data: Mapping[str, Any], states: int = 0) -> Dict[str, Any]:
    """The answer to a request for a new plan in a mission that is under way, as docs/run_time.md has both.

    `states`: a limit on the work in place of time and memory. Raises PursueError for a request that cannot be used.
    """
    from pursue_gen.tools.replanning import replan

    return replan(data, states)
