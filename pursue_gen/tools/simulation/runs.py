"""Many simulated missions, on several cores where that is wanted, and what they came to."""

from __future__ import annotations

import multiprocessing
import signal
from collections import Counter
from dataclasses import dataclass, field, replace
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection
from statistics import median
from typing import Any, Callable, Dict, Iterable, Iterator, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.diagnostics import error, usage_error
from pursue_gen.language.scenario import Scenario
from pursue_gen.outcomes import Unfinished
from pursue_gen.proof.margin import USUAL, strategy_margin
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.solution import Solution
from pursue_gen.tools.simulation.duties import Duty
from pursue_gen.tools.simulation.mission import simulate_mission
from pursue_gen.tools.simulation.outcome import FAILED, GOAL, HELD, SAFE, Outcome, Settings
from pursue_gen.tools.simulation.promises import duties_of
from pursue_gen.tools.simulation.remaining import Remaining
from pursue_gen.tools.simulation.stage import Stage, stage_of
from pursue_gen.workspace import Options
from pursue_gen.workspace.make import options_for
from pursue_runtime.state import LOST, STOPPED

_LONG, _SHORT = 1000.0, 200.0
"""The default time after which a mission is over, in time units: with a goal, and without one. Not measured."""

_SPARE = 2
"""With a goal it is at least so many times as long as the strategy takes at worst. Not measured."""

_LONGEST = 1e6

ENDS = (GOAL, SAFE, STOPPED, HELD, LOST, FAILED)
"""In the order of tables."""

SHARE = 20
"""So many missions are given to a process at once. Not measured."""

_SPAN, _PART = 50.0, 0.6
"""Faults begin within so many time units, or within this part of the longest that a mission may take. Not measured."""


@dataclass(frozen=True)
class Case:
    """What is simulated: everything that another process needs to make its own stage of it.

    `remaining` is found out anew where it is not there, and in another process.
    """

    scenario: Scenario
    won: Solution
    options: Options
    settings: Settings
    remaining: Optional[Remaining] = field(default=None, compare=False, repr=False)

    def worst_times(self) -> Optional[Remaining]:
        """What the opponent needs who makes plays as long as it can; None for others."""
        if self.settings.opponent not in ("worst", "mixed"):
            return None
        return self.remaining or Remaining(self.won)


@dataclass(frozen=True)
class Row:
    """The missions that ended in one way: how many, and their times in time units."""

    end: str
    missions: int
    least: float
    median: float
    worst: float


@dataclass(frozen=True)
class Answers:
    """How an objective was answered: its text and its limit (time units), how often it was called upon, how late it was
    answered at worst (None: never), and in how many missions it was never called upon."""

    objective: str
    limit: float
    calls: int
    latest: Optional[float]
    untried: int


@dataclass(frozen=True)
class Summary:
    """What the missions of a case came to. `failures`: the first few that must never be, with their plays; `failed`:
    how many there are; `happened`: how often which fault did; `planned`: missions in which a new plan came into force;
    `answers`: one for each objective that is called upon with a limit; `driven`: how far each robot drove
    on average, in units of distance."""

    case: Case = field(repr=False)
    missions: int
    rows: Tuple[Row, ...]
    failures: Tuple[Outcome, ...]
    failed: int
    happened: Dict[str, int]
    planned: int
    bound: Optional[float]
    remaining: bool
    answers: Tuple[Answers, ...] = ()
    driven: Mapping[str, float] = field(default_factory=dict)


def case_of(scenario: Scenario, won: Solution, options: Options, settings: Settings) -> Tuple[Case, bool]:
    """The case with the longest time that a mission takes, and the time within which faults begin. Also whether the
    worst opponent can compare the lengths of plays."""
    remaining = Remaining(won)
    bound = remaining.bound()
    span = _SPAN if bound is None else _PART * bound
    margin = float(won.reaction)
    if settings.faults:
        margin = float(strategy_margin(won.network, won.objective, won.strategy, won.reaction, USUAL).wins)
    known = replace(settings, bound=bound, span=span, margin=margin)
    return Case(scenario, won, options, known, remaining), remaining.works


def check_until(until: Optional[float]) -> None:
    """Raises PursueError (exit status 2) for what is no end of a mission, in time units."""
    if until is not None and not 0 < until < _LONGEST:
        raise usage_error(f"--until is {until:g}", "a number of time units greater than 0, such as 200")


def usual_end(won: Solution) -> float:
    """When a mission is over if nobody says so, in time units."""
    if not won.objective.reaches:
        return _SHORT
    worst = None if won.guarantee is None else won.guarantee.worst
    return max(_LONG, float(_SPARE * (worst or 0)))


def make_case(
    scenario: Scenario,
    won: Solution,
    request: SolveRequest,
    opponent: str,
    faults: Tuple[str, ...],
    until: Optional[float],
) -> Tuple[Case, bool]:
    """The case to simulate, and whether its worst opponent knows how long plays can be.

    `opponent` and `faults` as for `Settings`; `until`: when a mission is over, in time units; None for the default. It
    does not know where the game is too large or the strategy has stages: then it does anything.
    """
    check_until(until)
    goal = won.objective.reaches
    settings = Settings(opponent, faults, until or usual_end(won))
    case, knows = case_of(scenario, won, options_for(request, won), settings)
    return case, knows or not goal or opponent not in ("worst", "mixed")


class MissionRunner:
    """A stage, and what the missions on it share."""

    def __init__(self, case: Case) -> None:
        self.stage: Stage = stage_of(case.scenario, case.won, case.options)
        self._settings = case.settings
        self.remaining = case.worst_times()

    def run(self, seed: int, record: bool = False) -> Outcome:
        """One mission."""
        return simulate_mission(self.stage, self._settings, seed, self.remaining, record)


def outcomes(case: Case, seeds: Sequence[int], jobs: int) -> Iterator[Outcome]:
    """The outcomes of these missions, in their order, whatever the number of jobs (processes)."""
    shares = [list(seeds[k : k + SHARE]) for k in range(0, len(seeds), SHARE)]
    jobs = min(jobs, len(shares))
    if jobs <= 1:
        players = MissionRunner(case)
        yield from (players.run(seed) for seed in seeds)
        return
    context = multiprocessing.get_context("spawn")
    resource_tracker.ensure_running()  # it would lift the block of Ctrl-C below
    ends, workers = [], []
    try:
        for job in range(jobs):
            ours, theirs = context.Pipe(duplex=False)
            worker = context.Process(target=_work, args=(case, shares[job::jobs], theirs), daemon=True)
            workers.append(worker)  # before it starts: Ctrl-C may come at once
            # Ctrl-C is for the process that was started first; the others have that blocked from their birth.
            mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
            try:
                worker.start()
            finally:
                signal.pthread_sigmask(signal.SIG_SETMASK, mask)
            theirs.close()
            ends.append(ours)
        for number in range(len(shares)):
            yield from _received(ends[number % jobs])
    finally:
        started = [worker for worker in workers if worker.pid is not None]
        for worker in started:
            worker.terminate()
        for worker in started:
            worker.join()


def _work(case: Case, shares: Sequence[Sequence[int]], end: Connection) -> None:
    """A process: plays its shares, and sends the outcomes of each; or else, what went wrong."""
    try:
        players = MissionRunner(case)
        for share in shares:
            end.send([players.run(seed) for seed in share])
    except Exception as problem:
        end.send(problem)


def _received(end: Connection) -> List[Outcome]:
    try:
        found: Any = end.recv()
    except EOFError:
        raise Unfinished([error("SIM003", "a process that simulates has died", hint="use fewer --jobs")]) from None
    if isinstance(found, Exception):
        raise found
    return list(found)


def simulate(case: Case, seeds: Sequence[int], jobs: int = 1, progress: Callable[[int], Any] = lambda done: None,
             shown: int = 1, remaining: bool = True, played: Optional[Iterable[Outcome]] = None) -> Summary:
    """Plays the missions; `progress` is called with the number of missions that are done. The first `shown`
    failures come with their plays. `played`: the outcomes of these missions, if other machines play them."""
    times: Dict[str, List[float]] = {}
    happened: Counter[str] = Counter()
    driven: Counter[str] = Counter()
    failed: List[Outcome] = []
    count = planned = done = 0
    duties: List[Tuple[Duty, ...]] = []
    for outcome in outcomes(case, seeds, jobs) if played is None else played:
        times.setdefault(outcome.end, []).append(outcome.time)
        happened.update(outcome.happened)
        driven.update(outcome.driven)
        planned += outcome.plan > 0
        duties.append(outcome.duties)
        if outcome.end == FAILED:
            count += 1
            failed += [outcome] if len(failed) < shown else []
        done += 1
        progress(done)
    rows = tuple(
        Row(end, len(times[end]), min(times[end]), median(times[end]), max(times[end])) for end in ENDS if end in times
    )
    players = MissionRunner(case) if failed else None
    plays = tuple(players.run(outcome.seed, record=True) for outcome in failed) if players else ()
    kinds, answers = dict(sorted(happened.items())), _answers(case.scenario, duties)
    average = {name: units / max(1, done) for name, units in driven.items()}
    return Summary(case, done, rows, plays, count, kinds, planned, case.settings.bound, remaining, answers, average)


def _answers(scenario: Scenario, missions: Sequence[Sequence[Duty]]) -> Tuple[Answers, ...]:
    found = []
    for place, (_, objective) in enumerate(duties_of(scenario)):
        own = [duties[place] for duties in missions]
        calls = sum(duty.calls for duty in own)
        latest = max((duty.latest for duty in own if duty.latest is not None), default=None)
        untried = sum(not duty.calls for duty in own)
        found.append(Answers(objective.text, float(objective.known_limit), calls, latest, untried))
    return tuple(found)
