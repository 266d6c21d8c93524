"""What the process beside the page does: solves a text, plays it or measures its ways, and sends what comes of it."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import threading
import time
from dataclasses import dataclass, field, replace
from multiprocessing.connection import Connection, wait
from pathlib import Path
from typing import Any, Dict, Iterable, Iterator, List, Optional, Sequence

from pursue_gen.diagnostics import Diagnostic, PursueError
from pursue_gen.drawing.floor import Floor
from pursue_gen.drawing.floor_picture import read_floor
from pursue_gen.drawing.ground import read_ground
from pursue_gen.language.checks import checked
from pursue_gen.language.formatter import format_text
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.sentences import condition_of_promise, end_words, objective_words, periods_found, promise_words
from pursue_gen.language.symbols import Role, Symbol
from pursue_gen.outcomes import INTERRUPTED, LimitHit, Lost
from pursue_gen.solving.answers import answers
from pursue_gen.solving.inputs import game_of, settled
from pursue_gen.solving.optional import Promised, promised_of
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.rules import IDEAL, Rules
from pursue_gen.solving.solvers import solved
from pursue_gen.synthesis.limits import Limits, Progress
from pursue_gen.tools.play.session import Session, answer, choices, opening, session_of
from pursue_gen.tools.report.whole import ReportOptions, lost_report, report_page, won_report
from pursue_gen.workspace.levels import Level
from pursue_gen.workspace.map_check import read_placed
from pursue_gen.workspace.map_spots import with_spots
from pursue_gen.workspace.robot_size import Told, sizes_of
from pursue_gen.workspace.spots import SPOT_DISTANCE

WON, LOST, UNDECIDED, ERRORS, SURVEYED = "won", "lost", "undecided", "errors", "surveyed"
_NOT_HERE = ("save", "quit", "exit")
"""Commands of `pursue-gen play` that the page has no use for."""
_INTERVAL = 0.3
"""Seconds from one word on the progress to the next."""


@dataclass(frozen=True)
class Work:
    """A text to solve; `file`: what messages call it, `floor`: the map under pictures; limits in seconds and MiB;
    `told`: what was told of the sizes of robots."""

    text: str
    file: str
    floor: Optional[Path]
    seconds: float
    memory: int
    told: Told = field(default_factory=dict)


class Progressing:
    """A listener that sends {"progress": …} now and then."""

    def __init__(self, pipe: Connection) -> None:
        self._pipe, self._last = pipe, 0.0

    def __call__(self, far: Progress) -> None:
        """As listeners are called."""
        if time.monotonic() - self._last > _INTERVAL:
            self._last = time.monotonic()
            self._pipe.send({"progress": f"{far.phase}: {far.states} states, {far.waiting} waiting, {far.memory} MiB"})


@contextlib.contextmanager
def working(pipe: Connection) -> Iterator[None]:
    """Ends this process with the server; an error, be it of the program, is sent, and never looks like a verdict."""
    _end_with_parent()
    try:
        yield
    except (BrokenPipeError, EOFError):  # the server has gone
        pass
    except PursueError as problem:
        pipe.send({"verdict": ERRORS, "lines": sentences(problem.diagnostics)})
    except Exception as problem:
        pipe.send({"verdict": ERRORS, "lines": [f"internal error of pursue-gen: {type(problem).__name__}: {problem}"]})


def solve(given: Work, pipe: Connection) -> None:
    """Sends {"progress": …} now and then, {"verdict": …, "lines": […]} once, and {"page": …} where it can be made."""
    with working(pipe):
        _solve(given, pipe)


def _end_with_parent() -> None:
    """Sees to it that this process ends when the server has ended, however that came."""
    parent = multiprocessing.parent_process()
    if parent is not None:

        def watch() -> None:
            wait([parent.sentinel])
            os._exit(INTERRUPTED)

        threading.Thread(target=watch, daemon=True).start()


def _solve(given: Work, pipe: Connection) -> None:
    floor = None if given.floor is None else read_floor(given.floor)
    limits = Limits(given.seconds, given.memory)
    start = limits.now()
    progress = Progressing(pipe)
    request = SolveRequest(options=SolveOptions(limits=limits, progress=progress))
    scenario = settled(checked(given.text, given.file), request, progress)
    request = request.since(start)
    if given.floor is not None:
        level = Level(read_ground(given.floor), given.floor)
        scenario = with_spots(scenario, (level,), SPOT_DISTANCE, sizes_of(scenario, given.told))
    try:
        found = promised_of(scenario, request, progress)
    except (Lost, LimitHit) as problem:
        verdict = LOST if isinstance(problem, Lost) else UNDECIDED
        pipe.send({"verdict": verdict, "lines": sentences(problem.diagnostics)})
        pipe.send({"progress": "looking for what would change that"})
        lost = lost_report(scenario, problem, limits.since(start), progress, floor)
        pipe.send({"page": report_page(lost)})
        return
    pipe.send({"verdict": WON, "lines": _promise(found)})
    pipe.send({"progress": "making the pictures"})
    pipe.send({"page": _won_page(found, request, floor)})


def _won_page(found: Promised, request: SolveRequest, floor: Optional[Floor]) -> str:
    """The report: the strategy, a mission in time and on the map, what each controller does."""
    ideal = solved(*game_of(found.scenario), IDEAL, replace(request.options, progress=None))
    both = found.solution, ideal
    report = won_report(found.scenario, both, ReportOptions(floor=floor), request.options.limits)
    return report_page(report)


def _promise(found: Promised) -> List[str]:
    """What is guaranteed, in sentences."""
    scenario: Scenario = found.scenario
    lines = [*objective_words(scenario), *end_words(scenario)]
    if found.solution.guarantee is not None:
        lines += [found.solution.guarantee.in_words(scenario.unit)]
    lines += [answer.in_words() for answer in answers(scenario, found.solution)]
    lines += [*periods_found(scenario), *(f"{sentence}." for sentence in promise_words(scenario))]
    assumed = condition_of_promise(scenario)
    return [*lines, f"This holds {assumed}."] if assumed else lines


def sentences(findings: Iterable[Diagnostic]) -> List[str]:
    """A sentence for each finding, with what to do."""
    return [f"{one.message} ({one.hint})" if one.hint else one.message for one in findings]


# Play -----------------------------------------------------------------------------------------------------------------


def play(given: Work, pipe: Connection) -> None:
    """Sends {"game": …} for the beginning and after each line that comes; ends where nothing comes any more."""
    with working(pipe):
        session = _begun(given, pipe)
        lines: Sequence[str] = opening(session)
        for turn in range(1, 1_000_000):
            pipe.send({"game": _shown(session, lines, turn)})
            line = str(pipe.recv())
            if line.split()[:1] and line.split()[0].lower() in _NOT_HERE:
                lines = ("A game on the page is not saved; End the game ends it.",)
            else:
                reply = answer(session, line)
                session, lines = reply.session, reply.lines


def _begun(given: Work, pipe: Connection) -> Session:
    progress = Progressing(pipe)
    limits = Limits(given.seconds, given.memory)
    request = SolveRequest(options=SolveOptions(limits=limits, progress=progress))
    scenario = settled(checked(given.text, given.file), request, progress)
    return session_of(scenario, Rules(), 1, limits, progress)


def _shown(session: Session, lines: Sequence[str], turn: int) -> Dict[str, Any]:
    """What the page shows: lines, what can be done, the place that each of these leads to ("": to none), and where
    everybody is: [place], or [from, to] on a way."""
    setup, play_ = session.setup, session.play
    at: Dict[str, List[str]] = {}
    for number, automaton in enumerate(setup.game.automata):
        if automaton.name in setup.agents:
            location = automaton.locations[play_.position.state.locations[number]]
            here = Symbol.of(location)
            if here.parts:  # else nobody has said yet where it starts
                at[automaton.name] = list(here.parts if here.role is Role.WAY else here.parts[-1:])
    said = [] if play_.over else choices(session)
    found: Dict[str, Any] = {"turn": turn, "lines": list(lines), "choices": [list(one) for one in said]}
    return {**found, "to": _destinations(session), "over": play_.over, "at": at}


def _destinations(session: Session) -> List[str]:
    """For each thing that can be done, the place to which somebody sets off with it; "" where nobody does."""
    offers = () if session.play.over else session.game.offers(session.play)
    targets = [Symbol.of(session.setup.game.origins[offer.move.edges[0]].target) for offer in offers]
    return [target.parts[-1] if target.role is Role.WAY else "" for target in targets]


# Survey ---------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class SurveyWork(Work):
    """A text whose ways are to be measured, on the map `floor`.

    `radius`: that of all robots, in metres; None: as it is said or was told; `speed`: metres per second of all robots,
    None: no travel times; `ways`: those that are missing are added.
    """

    radius: Optional[float] = None
    speed: Optional[float] = None
    ways: bool = False


def survey(given: SurveyWork, pipe: Connection) -> None:
    """Sends {"verdict": "surveyed", "lines": …, "surveyed": the text with what was measured, "paths": of the ways, with
    their bends in metres}, or why not."""
    with working(pipe):
        pipe.send({"progress": "measuring"})
        try:
            assert given.floor is not None, "the page offers this with a map only"
            pipe.send(_measured(given, given.floor))
        except ImportError as problem:
            what = f"this needs the Python packages numpy and scipy, which are not installed here ({problem})"
            pipe.send({"verdict": ERRORS, "lines": [f"{what}: pip install 'pursue-gen[survey]'"]})


def _measured(given: SurveyWork, floor: Path) -> Dict[str, Any]:
    from pursue_gen.survey.copying import with_sizes
    from pursue_gen.survey.make import Options, surveyed  # needs numpy and scipy
    from pursue_gen.survey.routes import Drive
    from pursue_gen.survey.survey_table import table

    scenario = read_placed(given.text, given.file)
    scenario = read_placed(with_sizes(scenario, sizes_of(scenario, given.told)), given.file)
    robots = [agent.name for agent in scenario.agents if agent.is_robot and agent.mobile is not None]
    speeds = {} if given.speed is None else dict.fromkeys(robots, given.speed)
    drive = Drive(speeds, float(scenario.unit or 1))
    options = Options(sizes_of(scenario).with_radius(given.radius), ways=given.ways, drive=drive)
    found = surveyed(scenario, (Level(read_ground(floor, whole=True), floor),), options)
    lines = [*sentences(found.findings), *table(found)]
    paths = [{"a": way.a, "b": way.b, "line": way.line} for way in found.ways if way.line]
    return {"verdict": SURVEYED, "lines": lines, "surveyed": format_text(found.text, given.file), "paths": paths}
