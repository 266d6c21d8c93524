"""UPPAAL-TIGA's `verifytga` as a solver, for those who have it: its strategy is read, proven here, and then used.

The tool gets the network and the query as files in a folder of its own and prints what `plan.read_plan` reads. It
knows no reaction delay: it plays with a delay of 0, and the checker holds its strategy against the required delay.
What is known of its output comes from recorded runs of the original tool chain. There `-t0` prints the strategy; the
thesis found versions that want `-w0` instead.
"""

from __future__ import annotations

import contextlib
import os
import re
import resource
import shutil
import signal
import subprocess
import tempfile
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from math import ceil
from pathlib import Path
from typing import Dict, Mapping, Optional, Sequence, Tuple, Type

from pursue_gen.diagnostics import Diagnostic, PursueError, error
from pursue_gen.outcomes import LimitHit, Lost, NotProven, Unavailable
from pursue_gen.proof.checker import verify
from pursue_gen.solving.least_time import unscaled
from pursue_gen.solving.proving import play_that_shows, reached_part
from pursue_gen.synthesis.limits import NO_LIMITS, Limits, Listener
from pursue_gen.synthesis.plan import read_plan, write_plan
from pursue_gen.synthesis.solve import Stats, Verdict
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga.network import Network, Objective
from pursue_gen.tga.scale import common_denominator, scaled
from pursue_gen.tga.uppaal import write_network, write_query

TOOL = "verifytga"
_OPTIONS = ("-t0", "-w0")
_MODEL, _QUERY = "TGA.xml", "TCTL.q"
_LAST_LINES, _LAST_COLUMNS = 6, 200

_SLEEPS = 10
"""A tool that waits takes no processor time: it is ended after so many times the limit of real time. Not measured."""

_ESCAPE = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")
_HEADER = re.compile(r"^[ \t]*(?:Counter[ -])?strategy to [^\n:]*:", re.MULTILINE | re.IGNORECASE)
_VERDICT = re.compile(r"(?:Property|Formula) is (NOT )?satisfied")
_SIZE = re.compile(r"Size: (\d+) states")
_PROGRESS = re.compile(r"Preparing: \d+%|Verifying property \d+ at line \d+")
_MEMORY = re.compile(r"out of memory|memory (?:is )?exhausted|bad_alloc|cannot allocate memory", re.IGNORECASE)
_LICENCE = re.compile(r"licen[cs]e|has expired|not registered", re.IGNORECASE)
_OPTION = re.compile(r"(?:unknown|unrecogni[sz]ed|invalid|illegal) option", re.IGNORECASE)

_LOST = (
    "the agents that nobody controls can always prevent it, even where commands take effect at once: give the robots "
    "more time or speed, or fewer duties"
)
_OURS = "without --solver the built-in solver is used"
_GET_IT = (
    "UPPAAL-TIGA is at https://uppaal.org (free for academic use, under a licence of its own); put verifytga on PATH, "
    f"or name it with --verifytga PATH; {_OURS}"
)
_START_IT = f"try it by hand; a 32-bit program needs 32-bit libraries (Debian: libc6-i386 lib32stdc++6); {_OURS}"


@dataclass(frozen=True)
class Run:
    """What one run of the tool was: its command, all that it printed, and how it ended.

    `status` is the exit status, negative for the signal that ended it; None where it did not start, or had to be ended
    at the limit on time.
    """

    command: Tuple[str, ...]
    output: str
    messages: str
    status: Optional[int]

    @property
    def before(self) -> str:
        """What it printed before the strategy, on both of its streams: where its error messages are."""
        header = _HEADER.search(self.output)
        return f"{self.output[: header.start()] if header else self.output}\n{self.messages}"

    @property
    def decided(self) -> bool:
        """True where it ended by itself, with a verdict and with memory left to print a strategy."""
        ended = self.status is not None and self.status >= 0
        return ended and _VERDICT.search(self.output) is not None and not _MEMORY.search(self.before)


class ToolError(PursueError):
    """A run of the tool that gave no strategy to use.

    `run` is that run; `counter` the counter-strategy, where the tool found that the objective cannot be met and why,
    and `counter_plan` its text.
    """

    def __init__(
        self, diagnostics: Sequence[Diagnostic], run: Run, counter: Optional[Strategy] = None, counter_plan: str = ""
    ) -> None:
        super().__init__(diagnostics)
        self.run = run
        self.counter, self.counter_plan = counter, counter_plan


class ToolLost(ToolError, Lost):
    """It found that the objective cannot be met."""


class ToolRefused(ToolError, NotProven):
    """The checker refuses its strategy."""


class ToolLimit(ToolError, LimitHit):
    """It ran out of time or memory, or its strategy is too large to be proven."""


class ToolFailed(ToolError, Unavailable):
    """It does not start, crashes, or says what cannot be read."""


def run_verifytga(
    network: Network,
    objective: Objective,
    path: Optional[Path] = None,
    limits: Limits = NO_LIMITS,
    reaction: Fraction = Fraction(0),
    progress: Optional[Listener] = None,
) -> Verdict:
    """The strategy of verifytga for the game on the network as it stands: proven, and without what no play reaches.

    `path` is the program (default: the verifytga on PATH), `limits` hold for it and, with the time that is left, for
    the proof, which calls `progress`; `reaction` is the delay of commands, in time units, under which its strategy
    has to win. In the statistics the discrete states are those of its plan, the zones those on its last line of
    progress.

    Raises Unavailable where there is no tool, and a ToolError: ToolLost where it finds that the objective cannot be
    met, ToolRefused where its strategy does not win, ToolLimit where it runs out of time or memory, else ToolFailed.
    """
    tool = find_verifytga(path)
    start = limits.now()
    run = _first_with_strategy(tool, network, objective, limits)
    taken = limits.now() - start
    strategy = _strategy(run, network, objective)
    sizes = _SIZE.findall(run.before)
    proven = _proven(run, network, objective, strategy, reaction, limits.since(start), progress)
    return Verdict(True, proven, Stats(TOOL, len(strategy.blocks), int(sizes[-1]) if sizes else 0, taken))


def find_verifytga(path: Optional[Path] = None) -> str:
    """The program to start, as an absolute path: the one that is named, else the verifytga on PATH.

    Raises Unavailable.
    """
    if path is None:
        found = shutil.which(TOOL)
        problem = f"{TOOL}, the solver of UPPAAL-TIGA, is not on PATH"
        hint = _GET_IT
    else:
        # which() does not look on PATH for what has a folder before it.
        found = shutil.which(os.path.join(".", str(path)))
        if not path.exists():
            problem, hint = f"there is no {path}", _GET_IT
        elif path.is_dir():
            problem, hint = f"{path} is a folder", f"name the program in it, such as {path / TOOL}"
        else:
            problem, hint = f"{path} may not be started", f"chmod +x {path}, if that is the program"
    if found is None:
        raise Unavailable([error("SYN030", problem, hint=hint)])
    return os.path.abspath(found)


def _first_with_strategy(tool: str, network: Network, objective: Objective, limits: Limits) -> Run:
    """The first run, one per option, that prints a strategy. Raises ToolError where none does."""
    start = limits.now()
    runs = []
    with tempfile.TemporaryDirectory(prefix="pursue-gen-") as name:
        folder = Path(name)
        (folder / _MODEL).write_text(write_network(_all_named(network), objective), encoding="utf-8")
        (folder / _QUERY).write_text(write_query(objective), encoding="utf-8")
        for option in _OPTIONS:
            run = _run((tool, option, _MODEL, _QUERY), folder, limits.since(start))
            if run.decided and _HEADER.search(run.output):
                return run
            runs.append(run)
            if not (run.decided or _OPTION.search(run.before)):
                break
    raise _failure(next((run for run in runs if run.decided), runs[-1]), limits)


def _all_named(network: Network) -> Network:
    """The network with a name for each location, so that nothing depends on how a version prints ids."""
    return network.with_each(lambda each: each.with_locations(lambda location: replace(location, named=True)))


def _run(command: Tuple[str, ...], folder: Path, limits: Limits) -> Run:
    """Runs the tool until it ends, or its time is up; then, and at Ctrl-C, it and all that it started is ended."""
    outputs, bounds = (folder / "output", folder / "messages"), _bounds(limits)
    with contextlib.ExitStack() as stack:
        out, err = (stack.enter_context(open(file, "wb")) for file in outputs)
        try:
            # In files, not pipes: plans are large. In a session of its own: its children can be ended with it.
            process = subprocess.Popen(
                command,
                cwd=folder,
                stdin=subprocess.DEVNULL,
                stdout=out,
                stderr=err,
                start_new_session=True,
                preexec_fn=partial(_bind, bounds),
            )
        except OSError as problem:
            run = Run(command, "", "", None)
            message = f"{command[0]} cannot be started: {problem.strerror or problem}"
            raise ToolFailed([error("SYN031", message, hint=_START_IT)], run) from None
        try:
            status: Optional[int] = process.wait(_SLEEPS * limits.left or None)
        except subprocess.TimeoutExpired:
            status = None
        finally:
            if process.poll() in (None, -signal.SIGXCPU):
                with contextlib.suppress(ProcessLookupError):
                    os.killpg(process.pid, signal.SIGKILL)
                process.wait()
    if status == -signal.SIGXCPU and resource.RLIMIT_CPU in bounds:
        status = None
    output, messages = (_ESCAPE.sub("", file.read_bytes().decode("utf-8", "replace")) for file in outputs)
    return Run(command, output, messages, status)


def _bounds(limits: Limits) -> Dict[int, Tuple[int, int]]:
    """What the system is to allow a new process where that is less than what it allows this one: memory, of which it
    then gets no more, and reports that itself; seconds of processor time, after which it is ended."""
    found = {}
    for which, most in ((resource.RLIMIT_AS, limits.memory << 20), (resource.RLIMIT_CPU, ceil(limits.left))):
        soft, hard = resource.getrlimit(which)
        if most and (soft == resource.RLIM_INFINITY or most < soft):
            found[which] = (most, hard)
    return found


def _bind(bounds: Mapping[int, Tuple[int, int]]) -> None:
    for which, bound in bounds.items():
        resource.setrlimit(which, bound)


def _failure(run: Run, limits: Limits) -> ToolError:
    """What went wrong in a run that printed no strategy."""
    text = run.before
    verdict = _VERDICT.search(run.output)
    outcome: Type[ToolError] = ToolFailed
    code = "SYN032"
    hint = f"try it by hand with the files that `pursue-gen tga` writes; {_OURS}"
    if run.status is None:
        code, outcome = "SYN010", ToolLimit
        message = f"no verdict of {TOOL} within the limit of {limits.seconds:g} seconds of processor time"
        hint = f"allow more; {_OURS}"
    elif _MEMORY.search(text) or run.status == -signal.SIGKILL:
        code, outcome = "SYN010", ToolLimit
        surely = "ran out of memory" if _MEMORY.search(text) else "was killed, most likely for want of memory"
        of = f" (the limit is {limits.memory} MiB)" if limits.memory else ""
        smaller = "make the scenario smaller: fewer agents, POIs or events"
        message, hint = f"{TOOL} {surely}{of}", f"{'allow more (--memory), or ' if of else ''}{smaller}; {_OURS}"
    elif run.status == -signal.SIGXCPU:
        code, outcome = "SYN010", ToolLimit
        message, hint = f"{TOOL} reached the limit on time of this shell (ulimit -t)", f"allow more; {_OURS}"
    elif not verdict and _LICENCE.search(text):
        message, hint = f"{TOOL} asks for a licence", f"start it by hand once and do what it asks for; {_OURS}"
    elif run.status < 0:
        message = f"{TOOL} crashed"
    elif verdict and verdict.group(1):
        code, outcome = "SYN033", ToolLost
        message, hint = f"{TOOL} finds that the objective cannot be met, and prints no counter-strategy", _LOST
    elif verdict:
        message = f"{TOOL} finds that the objective can be met, but prints no strategy"
    elif run.status:
        message = f"{TOOL} failed"
    else:
        message = f"{TOOL} printed no verdict"
    return outcome([error(code, message, hint=hint + _particulars(run))], run)


def _strategy(run: Run, network: Network, objective: Objective) -> Strategy:
    """The strategy in the output. Raises ToolError for a counter-strategy, and for a text that cannot be read."""
    try:
        factor = common_denominator(network.times)
        strategy = read_plan(run.output, scaled(network, factor), f"output of {TOOL}")
    except PursueError as problem:
        message = f"{TOOL} printed a strategy that cannot be read"
        hint = f"its output may be cut, or that version prints it otherwise; {_OURS}{_particulars(run)}"
        raise ToolFailed([error("SYN034", message, hint=hint), *problem.diagnostics], run) from None
    strategy = unscaled(strategy, network, factor)
    if strategy.counter:
        message = f"{TOOL} finds that the objective cannot be met"
        hint = f"{_LOST}; solve -o FILE keeps its counter-strategy ({len(strategy.blocks)} states) beside that file"
        plan = write_plan(strategy, network, objective)
        raise ToolLost([error("SYN033", message, hint=hint + _particulars(run))], run, strategy, plan)
    return strategy


def _proven(
    run: Run,
    network: Network,
    objective: Objective,
    strategy: Strategy,
    reaction: Fraction,
    limits: Limits,
    progress: Optional[Listener],
) -> Strategy:
    """The part of the strategy that plays reach, once the checker finds it winning. Raises ToolError."""
    start = limits.now()
    report = verify(network, objective, strategy, reaction, limits=limits, progress=progress)
    if report.ok:
        return reached_part(network, objective, strategy, report, reaction, limits.since(start))
    if report.reason.startswith("limit"):
        message, hint = f"the strategy of {TOOL} is not proven: {report.reason}", f"it is too large; {_OURS}"
        raise ToolLimit([error("SYN010", message, hint=hint)], run)
    if reaction and verify(network, objective, strategy, limits=limits.since(start), progress=progress).ok:
        delay = f"{float(reaction):g} time units"
        message = f"the strategy of {TOOL} wins only where commands take effect at once, not up to {delay} later"
        hint = f"{TOOL} knows no reaction: --reaction 0 takes its strategy as it is; {_OURS}, which knows it"
    else:
        message, hint = f"the strategy of {TOOL} does not win: {report.reason}", _OURS
    raise ToolRefused([error("SYN035", message, hint=hint + play_that_shows(report))], run)


def _particulars(run: Run) -> str:
    """The command, its end and its last words, as more lines of a hint."""
    ended = "ended at the limit on time" if run.status is None else f"exit status {run.status}"
    if run.status is not None and run.status < 0:
        ended = f"ended by signal {-run.status} ({signal.strsignal(-run.status)})"
    lines = [f"      command: {' '.join(run.command)}", f"      {ended}; its last lines:"]
    lines += [f"        {line}" for line in _last_lines(run.before)] or ["        (no output)"]
    return "\n" + "\n".join(lines)


def _last_lines(text: str) -> Tuple[str, ...]:
    """The last lines with content, made fit for a terminal."""
    printable = ("".join(c if c.isprintable() else " " for c in line).strip() for line in text.splitlines())
    kept = [line for line in printable if line and not _PROGRESS.fullmatch(line)]
    return tuple(line[:_LAST_COLUMNS] for line in kept[-_LAST_LINES:])
