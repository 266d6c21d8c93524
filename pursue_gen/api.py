"""What programs and notebooks call, and the commands too: read, check, solve, explain, simulate, write a workspace.

`import pursue_gen` has all these names. Functions take and return frozen values, print nothing and never exit; what
goes wrong is a PursueError with its findings (code, message, hint, place), of a type of its own for each outcome
(Invalid, Lost, TooSlow, NotProven, LimitHit …). Scenarios are read, or built of the values in `language.scenario`.
Ctrl-C ends whatever is done. docs/api.md shows all of it at work. What a function needs is imported when it is called.
"""

from __future__ import annotations

import math
import traceback
from dataclasses import dataclass
from dataclasses import replace as _replace
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, Dict, Iterable, List, Mapping, Optional, Tuple, Union

from pursue_gen.diagnostics import Diagnostic, PursueError, Severity, Span, usage_error
from pursue_gen.language import scenario as _parts
from pursue_gen.language.scenario import *  # noqa: F403 (the values that scenarios are built of)
from pursue_gen.language.scenario import Scenario
from pursue_gen.outcomes import Invalid, LimitHit, Lost, NotProven, TooSlow, Unavailable

if TYPE_CHECKING:
    from pursue_gen.proof.margin import Margin
    from pursue_gen.solving.answers import Answer
    from pursue_gen.solving.given_plan import Trial
    from pursue_gen.solving.request import SolveRequest
    from pursue_gen.solving.solution import Solution
    from pursue_gen.synthesis.limits import Listener
    from pursue_gen.tga.network import Network, Objective
    from pursue_gen.tools.simulation.runs import Summary
    from pursue_gen.workspace.make import Extras, Made

__all__ = [
    "Diagnostic", "Invalid", "LimitHit", "Lost", "NotProven", "PursueError", "Severity", "Solved", "SolvedGame",
    "Span", "TooSlow", "Unavailable", "Why", "as_text", "as_uppaal", "can_explain", "check", "explain", "game",
    "parse", "problem_of", "promises_of", "read", "read_game", "replan", "request", "settle", "simulate", "solve",
    "solve_game", "verdict_of", "verify", "verify_game", "write_workspace",
]  # fmt: skip
__all__ += _parts.__all__

Game = Tuple["Network", "Objective"]
"""A network of timed automata, and what is wanted in it."""

Margins = Tuple["Margin", Optional["Margin"]]
"""How late commands may come: with this strategy, and in this game with one that is made for it."""

File = Union[str, Path]


# Scenarios ------------------------------------------------------------------------------------------------------------


def read(file: File) -> Scenario:
    """The scenario in a file. Raises PursueError with every error; warnings are left to `check`.

    >>> floor = read("scenarios/thesis/scenario_1.pur")
    >>> [agent.name for agent in floor.agents]
    ['bot1', 'bot2']
    """
    from pursue_gen.solving.inputs import load_scenario

    return load_scenario(Path(file))


def parse(text: str, name: str = "scenario") -> Scenario:
    """The scenario in a text; `name` is what it is called, as a file's stem. Raises as `read`.

    >>> try:
    ...     parse('poi "hall" agent "bot" controllable location attic objective: avoid bot at hall', "tiny")
    ... except Invalid as problem:
    ...     print(*((finding.code, finding.message, finding.span.line) for finding in problem.diagnostics))
    ('PML110', 'there is no POI attic', 1)
    """
    from pursue_gen.language import parser

    return _sound(parser.parse(text, f"{name}.pur", name))


def check(scenario: Union[Scenario, File]) -> Tuple[Diagnostic, ...]:
    """All errors and warnings of a scenario, or of a file, in the order of the text; never raises.

    >>> check("scenarios/thesis/scenario_1.pur")
    ()
    """
    from pursue_gen.language.parser import Reading
    from pursue_gen.language.parser import read as read_text
    from pursue_gen.language.writer import written
    from pursue_gen.solving.inputs import findings_in, findings_of

    if not isinstance(scenario, Scenario):
        return findings_in(Path(scenario))
    try:
        scenario = written(scenario)
    except PursueError as problem:
        return problem.diagnostics
    return findings_of(Reading(scenario, read_text(scenario.text, scenario.file, scenario.name).diagnostics))


def as_text(scenario: Scenario) -> str:
    """The scenario in PuRSUE-ML: its own text if that says the same as its values, else one that is written anew.

    Raises PursueError where no text can say it.

    >>> print(as_text(Scenario("tiny", pois=(Poi("hall"), Poi("lab")), connections=(Connection("hall", "lab", 2),))))
    poi "hall"
    poi "lab"
    <BLANKLINE>
    connect hall and lab distance 2
    <BLANKLINE>
    """
    from pursue_gen.language.writer import written

    return written(scenario).text


def settle(scenario: Scenario, request: Optional[SolveRequest] = None, progress: Optional[Listener] = None) -> Scenario:
    """The scenario with the least period that can be promised for patrols that name none; `solve` does this first.

    Raises as `solve`.
    """
    from pursue_gen.solving.inputs import settled

    return settled(_sound(scenario), request or _default(), progress)


# Games ----------------------------------------------------------------------------------------------------------------


def request(
    *,
    ends: Optional[str] = None,
    reaction: Union[str, float, Fraction, None] = None,
    slack: Union[Mapping[str, int], Iterable[str]] = (),
    within: Union[str, float, Fraction, None] = None,
    optimize: Optional[str] = None,
    controllers: str = "distributed",
    reach_obj: str = "dedicated",
    plan: Optional[File] = None,
    seconds: Optional[float] = None,
    memory: Optional[int] = None,
    work: int = 0,
    whole: bool = False,
    solver: Optional[str] = None,
    verifytga: Optional[File] = None,
) -> SolveRequest:
    """What `solve`, `simulate` and `write_workspace` are asked for; by default what the commands do by default.

    The game: `ends` "reported" (robots report them) or "controllable" (the original's game), `reaction` (time units:
    how late a command may take effect, 0.1 by default), `slack` (agent → time units: how much later than the model it
    may end). `within`: the goal has to be reached in so many time units; `optimize`: "time" for the least worst-case
    time, "none" for the first strategy found. `controllers` ("distributed", "centralized", "general") and `reach_obj`
    ("dedicated", "all", a robot): who commands what. `plan`: a file with a plan to use instead of solving.

    Limits: `seconds` of processor time (60 by default, 0: none), `memory` of the process in MiB (0: none; by
    default 1024 beside what it holds already, or 80 % of what there is), `work` of a game in one piece (0: no limit):
    the same everywhere.
    `whole`, `solver`, `verifytga`: as the command line has them. Raises PursueError for what has no meaning.

    >>> request(reaction=0.05, slack={"bot1": 2}, seconds=10).slack
    ('bot1=2',)
    """
    from pursue_gen.solving.options import SolveOptions
    from pursue_gen.solving.request import SolveRequest
    from pursue_gen.synthesis.limits import DEFAULT_SECONDS, Limits, careful_memory

    _check_words(ends=ends, optimize=optimize, controllers=controllers, solver=solver)
    for name, number in {"seconds": seconds, "memory": memory, "work": work}.items():
        if number is not None and not 0 <= number < math.inf:
            raise usage_error(f"{name} is {number}", "expected a number, 0 for no limit")
    memory = careful_memory() if memory is None else memory
    limits = Limits(DEFAULT_SECONDS, memory, by_default=True) if seconds is None else Limits(seconds, memory)
    path = None if verifytga is None else Path(verifytga)
    how = SolveOptions(limits, optimize=optimize, whole=whole, solver=solver, verifytga=path, most_work=work)
    late = tuple(f"{agent}={units}" for agent, units in slack.items()) if isinstance(slack, Mapping) else tuple(slack)
    times = (None if time is None else str(time) for time in (reaction, within))
    file = None if plan is None else Path(plan)
    return SolveRequest(controllers, reach_obj, ends, next(times), late, next(times), file, how)


_WORDS = {
    "ends": ("reported", "controllable"),
    "optimize": ("time", "none"),
    "controllers": ("distributed", "centralized", "general"),
    "solver": ("verifytga",),
    "opponent": ("random", "worst", "still", "mixed"),
}


def _check_words(**values: Optional[str]) -> None:
    """Raises PursueError for what is none of the words that there are."""
    for name, value in values.items():
        if value is not None and value not in _WORDS[name]:
            raise usage_error(f"{name} is {value!r}", f"expected one of {', '.join(_WORDS[name])}")


def game(scenario: Scenario, request: Optional[SolveRequest] = None) -> Game:
    """The network of timed game automata that is played, and its objective, with all that is optional.

    By default the ideal game, as UPPAAL-TIGA plays it: with the rules of the request where there is one.

    >>> network, objective = game(read("scenarios/thesis/scenario_1.pur"))
    >>> [automaton.name for automaton in network.automata]
    ['bot1', 'bot2', 'reachObj', 'rule1']
    """
    from pursue_gen.solving.inputs import game_of
    from pursue_gen.solving.rules import played

    network, objective = game_of(_sound(scenario))
    return (network if request is None else played(network, request.rules(network))), objective


def as_uppaal(scenario: Scenario, request: Optional[SolveRequest] = None) -> Tuple[str, str]:
    """The `game` as UPPAAL's files: the texts of TGA.xml and of TCTL.q.

    >>> network, query = as_uppaal(read("scenarios/thesis/scenario_1.pur"))
    >>> query.strip()
    'control: A<> reachObj.win'
    """
    from pursue_gen.tga.uppaal import write_network, write_query

    network, objective = game(scenario, request)
    return write_network(network, objective), write_query(objective)


def read_game(*files: File) -> Game:
    """The ideal game of UPPAAL's two files, a network and its query. Raises PursueError."""
    from pursue_gen.solving.inputs import load_game

    return load_game([Path(file) for file in files])


# Solutions ------------------------------------------------------------------------------------------------------------


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

    def margins(self, thorough: bool = False) -> Margins:
        """How late commands may come, as far as it is quickly found; `thorough`: all of it, and for the game, too."""
        from pursue_gen.solving.verdict import margins

        return margins(self.solution, thorough, self.request.options.limits)

    def margin_text(self, margins: Optional[Margins] = None) -> str:
        """The margins, by default those that are quickly found, in sentences."""
        from pursue_gen.solving.verdict import margin_text

        return margin_text(self.solution, *(margins or self.margins()))

    def in_words(self) -> List[str]:
        """The verdict, and what else there is to know, in lines for people."""
        from pursue_gen.solving.rules import rules_text
        from pursue_gen.solving.verdict import verdict_text

        if self.request.plan is None:
            return [verdict_text(self.solution)]
        return [] if self.solution.warnings else [f"{self.request.plan} wins: {rules_text(self.solution.rules)}"]

    def as_json(self, margins: Optional[Margins] = None) -> Dict[str, Any]:
        """The verdict as `pursue-gen solve --json` prints it; without margins where there are none."""
        from pursue_gen.solving.verdict import verdict_json

        return verdict_json(self.solution.rules, self.solution, *(margins or ()))


@dataclass(frozen=True, repr=False)
class Solved(SolvedGame):
    """A scenario that is won: `scenario` has what is promised, `given_up` in it is what is optional and is not."""

    scenario: Scenario

    @cached_property
    def answers(self) -> List[Answer]:
        """How late promises with a deadline are kept at worst, where a fixed amount of work tells."""
        from pursue_gen.solving.answers import answers

        return answers(self.scenario, self.solution, self.request.options.limits)

    @cached_property
    def unneeded(self) -> Tuple[Agent, ...]:  # noqa: F405
        """The robots and allies that the strategy does without."""
        from pursue_gen.partition import unneeded

        return unneeded(self.scenario, self.solution.strategy)

    def promises(self) -> List[str]:
        """Which periods were found for patrols, and which optional objectives are promised, in sentences."""
        return promises_of(self.scenario)

    def in_words(self) -> List[str]:
        """The verdict, answers, promises, what is assumed of others and who is not needed, in lines for people."""
        from pursue_gen.language.wording import condition_of_promise
        from pursue_gen.partition import unneeded_words

        assumed = condition_of_promise(self.scenario) if self.request.plan is None else ""
        lines = [*super().in_words(), *(answer.in_words() for answer in self.answers), *self.promises()]
        lines += [f"This holds {assumed}."] if assumed else []
        return [line for line in (*lines, unneeded_words(self.unneeded)) if line]

    def as_json(self, margins: Optional[Margins] = None) -> Dict[str, Any]:
        """As for a game, with answers, periods, what is promised and who is not needed."""
        from pursue_gen.solving.verdict import optional_json, periods_json

        late = {"answers": [answer.as_json() for answer in self.answers]}
        alone = {"not_needed": [agent.name for agent in self.unneeded]}
        more = {**periods_json(self.scenario), **optional_json(self.scenario)}
        return {**super().as_json(margins), **late, **alone, **more}


def promises_of(scenario: Scenario, won: bool = True) -> List[str]:
    """As `Solved.promises`; of a scenario that is not won, what is known of periods."""
    from pursue_gen.language.wording import periods_found, promise_words

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

    wanted = request or _default()
    start = wanted.options.limits.now()
    settled = settle(scenario, wanted, progress)
    found = promised_of(settled, wanted.since(start), progress)
    return Solved(found.solution, wanted, found.scenario)


def solve_game(game: Game, request: Optional[SolveRequest] = None, progress: Optional[Listener] = None) -> SolvedGame:
    """As `solve`, for a game that `read_game` has read. Raises as it."""
    from pursue_gen.solving.request import solution_of

    wanted = request or _default()
    return SolvedGame(solution_of(*game, wanted, progress), wanted)


def verdict_of(problem: PursueError, game: Game, request: Optional[SolveRequest] = None) -> Dict[str, Any]:
    """The verdict as `Solved.as_json` has it, on a game for which `solve` or `solve_game` raised this."""
    from pursue_gen.solving.verdict import verdict_json

    return verdict_json((request or _default()).rules(game[0]), problem)


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

    wanted = request or _default()
    return try_plan_of(_sound(scenario), Path(plan), wanted, _replace(wanted.options, progress=progress))


def verify_game(
    game: Game, plan: File, request: Optional[SolveRequest] = None, progress: Optional[Listener] = None
) -> Tuple[Trial, ...]:
    """As `verify`, for a game that `read_game` has read."""
    from pursue_gen.solving.given_plan import try_plan

    wanted = request or _default()
    return try_plan(Path(plan), *game, wanted.games(game[0]), _replace(wanted.options, progress=progress))


def problem_of(trials: Iterable[Trial]) -> Optional[PursueError]:
    """Why a plan is not proven in any of these games: a NotProven or LimitHit; None where it wins one."""
    from pursue_gen.solving.given_plan import problem_of

    return problem_of(tuple(trials))


# What else is made of scenarios ---------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Why:
    """Why a scenario is not won, or not decided: in words, and as JSON."""

    text: str
    data: Dict[str, Any]


def can_explain(problem: PursueError, request: Optional[SolveRequest] = None) -> bool:
    """True for a scenario that the built-in solver finds lost, or does not decide within a limit."""
    from pursue_gen.synthesis.limits import UNDECIDED

    wanted = request or _default()
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
    wanted, scenario = request or _default(), _sound(scenario)
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
    `pursue-gen sim`; `until`: when a mission is over (time units; None: 1000 with a goal, else 200); `jobs`: so many
    processes; `scheduler`: the address of a Dask scheduler instead. `progress`: called with how many are done.
    Raises PursueError.

    >>> summary = simulate(solve(read("scenarios/thesis/scenario_1.pur")), runs=20)
    >>> summary.missions, summary.failed, [row.end for row in summary.rows]
    (20, 0, ['goal'])
    """
    from pursue_gen.tools.simulation.cluster import cluster, outcomes_on
    from pursue_gen.tools.simulation.faults import read_faults
    from pursue_gen.tools.simulation.make import make_case
    from pursue_gen.tools.simulation.runs import simulate

    kinds = read_faults(faults)
    _check_words(opponent=opponent)
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


def _sound(scenario: Scenario) -> Scenario:
    """The scenario with a text that says the same. Raises PursueError with its errors."""
    from pursue_gen.language.checks import check
    from pursue_gen.language.parser import without_errors
    from pursue_gen.language.writer import written

    scenario = written(scenario)
    return without_errors(scenario, check(scenario))


def _default() -> SolveRequest:
    return request()
