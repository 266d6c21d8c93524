"""verifytga as a solver, played by a program that replays its recorded outputs, or fails as such a tool can fail."""

from __future__ import annotations

import contextlib
import fcntl
import json
import shlex
import signal
import subprocess
import sys
import threading
import time
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Callable, Iterator, Tuple
from unittest import mock

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError, render
from pursue_gen.language import load, parse
from pursue_gen.proof.checker import verify
from pursue_gen.solving.verifytga import ToolError, find_verifytga, run_verifytga
from pursue_gen.synthesis.limits import Limits
from pursue_gen.synthesis.plan import read_plan, write_plan
from pursue_gen.synthesis.solve import solve
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Network, Objective
from pursue_gen.tga.scale import scaled
from pursue_gen.tga.uppaal import read_network, read_query

ROOT = Path(__file__).resolve().parent.parent.parent

CALLED = """poi "desk"
poi "shelf"
connect desk and shelf distance 2
event "callBot"
event "fetch" location shelf
agent "bot" controllable mobile 1 location desk can_do fetch
agent "visitor" location desk can_do callBot
objective: if callBot then fetch within 4
"""
"""Won, but not where a command may take effect late."""

BEFORE = (
    "\x1b[1;34mOptions for the verification:\x1b[0;0m\n  Generating some trace\n  Seed is 7\n\x1b[2K\n"
    "Verifying property 1 at line 1\n"
    " -- \x1b[1;34mThroughput: 7591 states/sec\x1b[0;0m, Size: 15 states, Load: 6 states\x1b[K\n"
    " -- \x1b[1;34mThroughput: 9000 states/sec\x1b[0;0m, Size: 42 states, Load: 7 states\x1b[K\n"
    "Preparing: 0%\x1b[K\nPreparing: 99%\x1b[K\n"
)
"""What the tool prints before its verdict."""

SATISFIED, LOST, PERHAPS = (f"\x1b[2K -- Property {word} satisfied.\n" for word in ("is", "is NOT", "MAY be"))

Game = Tuple[Network, Objective]
Tool = Callable[[str], Path]


@pytest.fixture(scope="module")
def game() -> Game:
    scenario = parse(CALLED, "called.pur")
    return translate(scenario), scenario_objective(scenario)


@pytest.fixture(scope="module")
def strategy(game: Game) -> Strategy:
    found = solve(*game).strategy
    assert found is not None
    return found


@pytest.fixture
def tool(tmp_path: Path) -> Tool:
    """Makes a verifytga of Python statements; `say(text)` prints, `option` is what it was called with."""

    def make(body: str) -> Path:
        code = tmp_path / "verifytga.py"
        start = "import os, signal, sys, time\noption = sys.argv[1]\n"
        say = "def say(text, to=sys.stdout):\n    to.write(text)\n    to.flush()\n"
        code.write_text(f"{start}{say}{body}\n", encoding="utf-8")
        program = tmp_path / "verifytga"
        program.write_text(f'#!/bin/sh\nexec {shlex.quote(sys.executable)} -S {shlex.quote(str(code))} "$@"\n')
        program.chmod(0o755)
        return program

    return make


def replaying(text: str) -> str:
    return f"say({text!r})"


def winning(game: Game, strategy: Strategy) -> str:
    return BEFORE + SATISFIED + "\n" + write_plan(strategy, *game).split("satisfied.\n", 1)[1]


def losing(game: Game, strategy: Strategy) -> str:
    return BEFORE + LOST + "\n" + write_plan(replace(strategy, counter=True), *game).split("satisfied.\n", 1)[1]


def told(problem: PursueError) -> str:
    return "\n".join(render(diagnostic) for diagnostic in problem.diagnostics)


def failure(game: Game, program: Path, seconds: float = 0.0, reaction: Fraction = Fraction(0)) -> ToolError:
    with pytest.raises(ToolError) as caught:
        run_verifytga(*game, path=program, limits=Limits(seconds), reaction=reaction)
    return caught.value


# A strategy is found -------------------------------------------------------------------------------------------------


def test_its_strategy_is_read_and_proven(game: Game, strategy: Strategy, tool: Tool) -> None:
    verdict = run_verifytga(*game, path=tool(replaying(winning(game, strategy))))
    assert verdict.won and verdict.strategy is not None
    assert verify(*game, verdict.strategy).ok
    assert (verdict.stats.engine, verdict.stats.zones) == ("verifytga", 42)
    assert verdict.stats.discrete_states == len(strategy.blocks)


def test_decimals_are_multiplied_for_it_and_divided_in_its_strategy(tool: Tool, tmp_path: Path) -> None:
    scenario = parse(CALLED.replace("distance 2", "distance 1.25").replace("within 4", "within 3.5"), "called.pur")
    network, objective = translate(scenario), scenario_objective(scenario)
    large = scaled(network, 4)
    strategy = solve(large, objective).strategy
    assert strategy is not None
    program = tool(
        f"open({str(tmp_path / 'given')!r}, 'w').write(open('TGA.xml').read())\n"
        + replaying(winning((large, objective), strategy))
    )
    verdict = run_verifytga(network, objective, path=program)
    assert verdict.strategy is not None
    assert verify(network, objective, verdict.strategy).ok
    assert "multiplied by 4" in (tmp_path / "given").read_text()


def test_what_no_play_reaches_is_left_out(game: Game, strategy: Strategy, tool: Tool) -> None:
    lean = run_verifytga(*game, path=tool(replaying(winning(game, strategy)))).strategy
    assert lean is not None
    away = replace(lean.blocks[0].state, values=tuple((name, -999) for name, _ in lean.blocks[0].state.values))
    padded = replace(lean, blocks=(*lean.blocks, replace(lean.blocks[0], state=away, wait=((),), commands=())))
    assert run_verifytga(*game, path=tool(replaying(winning(game, padded)))).strategy == lean


def test_the_tool_gets_the_network_and_the_query(game: Game, strategy: Strategy, tool: Tool, tmp_path: Path) -> None:
    program = tool(
        f"import shutil\nassert sys.argv[1:] == ['-t0', 'TGA.xml', 'TCTL.q']\n"
        f"shutil.copytree('.', {str(tmp_path / 'given')!r})\n" + replaying(winning(game, strategy))
    )
    run_verifytga(*game, path=program)
    given_network = read_network((tmp_path / "given" / "TGA.xml").read_text(encoding="utf-8"), "TGA.xml")
    assert [a.edges for a in given_network.automata] == [a.edges for a in game[0].automata]
    assert all(location.named for automaton in given_network.automata for location in automaton.locations)
    assert read_query((tmp_path / "given" / "TCTL.q").read_text(encoding="utf-8"), "TCTL.q") == game[1]


@pytest.mark.parametrize("outcome", ["won", "failed"])
def test_its_folder_does_not_stay(game: Game, strategy: Strategy, tool: Tool, tmp_path: Path, outcome: str) -> None:
    place = tmp_path / "place"
    output = winning(game, strategy) if outcome == "won" else "nothing"
    program = tool(f"open({str(place)!r}, 'w').write(os.getcwd())\n" + replaying(output))
    if outcome == "won":
        run_verifytga(*game, path=program)
    else:
        failure(game, program)
    assert not Path(place.read_text()).exists()


@pytest.mark.parametrize(
    "first", [replaying(BEFORE + SATISFIED), "say('verifytga: invalid option -- t', sys.stderr)\nsys.exit(1)"]
)
def test_a_version_that_wants_another_option_gets_it(game: Game, strategy: Strategy, tool: Tool, first: str) -> None:
    indented = "\n".join("    " + line for line in first.splitlines())
    program = tool(f"if option == '-t0':\n{indented}\nelif option == '-w0':\n    {replaying(winning(game, strategy))}")
    assert run_verifytga(*game, path=program).won


def test_an_exit_status_takes_nothing_from_a_proven_strategy(game: Game, strategy: Strategy, tool: Tool) -> None:
    assert run_verifytga(*game, path=tool(replaying(winning(game, strategy)) + "\nsys.exit(1)")).won


def test_the_tool_is_found_on_the_path(
    game: Game, strategy: Strategy, tool: Tool, monkeypatch: pytest.MonkeyPatch
) -> None:
    program = tool(replaying(winning(game, strategy)))
    monkeypatch.setenv("PATH", f"{program.parent}:/usr/bin:/bin")
    assert find_verifytga() == str(program)
    assert run_verifytga(*game).won


def test_a_named_tool_is_not_looked_for_on_the_path(
    tool: Tool, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    program = tool("")
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.setenv("PATH", str(program.parent))
    monkeypatch.chdir(tmp_path / "elsewhere")
    with pytest.raises(PursueError):
        find_verifytga(Path("verifytga"))
    monkeypatch.chdir(tmp_path)
    assert find_verifytga(Path("verifytga")) == str(program)


# There is none, or none that wins ------------------------------------------------------------------------------------


def test_an_objective_that_cannot_be_met_keeps_the_counter_strategy(game: Game, strategy: Strategy, tool: Tool) -> None:
    problem = failure(game, tool(replaying(losing(game, strategy))))
    assert problem.exit_status == 4
    assert "the objective cannot be met" in told(problem)
    assert problem.counter == replace(strategy, counter=True)


@pytest.mark.parametrize("second", ["sys.exit(1)", "say('invalid option -- w')\nsys.exit(1)", "time.sleep(1000)"])
def test_it_cannot_be_met_and_nobody_says_why(game: Game, tool: Tool, second: str) -> None:
    indented = "\n".join("    " + line for line in second.splitlines())
    program = tool(f"if option == '-w0':\n{indented}\n" + replaying(BEFORE + LOST))
    for seconds in (2, 20, 200):  # on a busy machine the time may be over before the verdict is said
        problem = failure(game, program, seconds)
        if problem.exit_status != 5:
            break
    assert (problem.exit_status, problem.counter) == (4, None)
    assert "no counter-strategy" in told(problem)


def test_a_strategy_that_does_not_win_is_refused(game: Game, strategy: Strategy, tool: Tool) -> None:
    holes = replace(strategy, blocks=strategy.blocks[: len(strategy.blocks) // 2])
    problem = failure(game, tool(replaying(winning(game, holes))))
    assert problem.exit_status == 4
    assert "does not win" in told(problem) and "the play that shows it" in told(problem)
    assert "cannot be met" not in told(problem)


def test_a_strategy_that_stands_no_delay_is_reported(game: Game, strategy: Strategy, tool: Tool) -> None:
    problem = failure(game, tool(replaying(winning(game, strategy))), reaction=Fraction(1, 10))
    assert problem.exit_status == 4
    assert "wins only where commands take effect at once, not up to 0.1 time units later" in told(problem)
    assert "--reaction 0" in told(problem)


# It fails ------------------------------------------------------------------------------------------------------------

MEMORY = BEFORE + " -- Throughput: 9000 states/sec, Size: 5502014 states, Load: 2317115 states\n"

FAILURES = {
    "memory": (MEMORY, "say('Out of memory\\n', sys.stderr)\nsys.exit(1)", 5, "ran out of memory"),
    "bad_alloc": (MEMORY, "say('std::bad_alloc', sys.stderr)\nos.abort()", 5, "ran out of memory"),
    "memory at the strategy": (BEFORE + SATISFIED, "say('Out of memory\\n')", 5, "ran out of memory"),
    "killed": (MEMORY, "os.kill(os.getpid(), signal.SIGKILL)", 5, "for want of memory"),
    "time of the shell": (BEFORE, "os.kill(os.getpid(), signal.SIGXCPU)", 5, "ulimit -t"),
    "no licence": ("", "say('License key is missing.\\n', sys.stderr)\nsys.exit(1)", 6, "asks for a licence"),
    "old licence": ("Your licence has expired.\n", "", 6, "asks for a licence"),
    "status": ("TGA.xml:5: [error] Unknown identifier.\n", "sys.exit(3)", 6, "failed"),
    "crash": (BEFORE, "os.kill(os.getpid(), signal.SIGSEGV)", 6, "crashed"),
    "crash after the verdict": (BEFORE + LOST, "os.kill(os.getpid(), signal.SIGSEGV)", 6, "crashed"),
    "garbage": ("\x00\x07\x1b]0;mine\x07 pizza\n", "", 6, "no verdict"),
    "silence": ("", "", 6, "no verdict"),
    "perhaps": (BEFORE + PERHAPS, "", 6, "no verdict"),
    "no strategy": (BEFORE + SATISFIED, "", 6, "prints no strategy"),
    "empty strategy": (BEFORE + SATISFIED + "\nStrategy to win:\n", "", 6, "cannot be read"),
    "other words": (BEFORE + SATISFIED + "\nStrategy to win:\n\nState: ( a.b )\n", "", 6, "cannot be read"),
}


@pytest.mark.parametrize("name", FAILURES)
def test_every_failure_is_reported_with_the_tools_own_words(game: Game, tool: Tool, name: str) -> None:
    output, end, status, message = FAILURES[name]
    program = tool(f"{replaying(output)}\n{end}")
    problem = failure(game, program)
    assert problem.exit_status == status
    assert message in problem.diagnostics[0].message
    hint = problem.diagnostics[0].hint
    assert f"command: {program} -" in hint and "TGA.xml TCTL.q" in hint
    assert f"exit status {problem.run.status};" in hint or f"ended by signal {-(problem.run.status or 0)} (" in hint
    assert "built-in solver" in hint
    assert all(character.isprintable() or character == "\n" for character in told(problem))


def test_the_last_lines_are_those_that_say_something(game: Game, tool: Tool) -> None:
    many = "".join(f"line {n}\n" for n in range(30)) + "Preparing: 98%\nPreparing: 99%\n" + "x" * 5000
    hint = failure(game, tool(replaying(many) + "\nsay('on the other stream', sys.stderr)")).diagnostics[0].hint
    assert "line 29" in hint and "on the other stream" in hint
    assert "line 3\n" not in hint and "Preparing" not in hint
    assert max(map(len, hint.splitlines())) < 300


def test_a_cut_strategy_is_not_used(game: Game, strategy: Strategy, tool: Tool) -> None:
    output = winning(game, strategy)
    problem = failure(game, tool(replaying(output[: len(output) * 3 // 4])))
    assert problem.exit_status in (4, 6)


def test_a_limit_on_memory_is_one_for_the_tool(game: Game, strategy: Strategy, tool: Tool) -> None:
    despair = f"    {replaying('std::bad_alloc')}\n    os.abort()"
    greedy = f"try:\n    much = bytearray(1 << 30)\nexcept MemoryError:\n{despair}"
    program = tool(f"{greedy}\n{replaying(winning(game, strategy))}")
    assert run_verifytga(*game, path=program).won
    with pytest.raises(ToolError) as failure:
        run_verifytga(*game, path=program, limits=Limits(memory=600))
    assert failure.value.exit_status == 5
    assert "verifytga ran out of memory (the limit is 600 MiB)" in told(failure.value)


def test_what_is_left_of_the_time_is_for_the_proof(game: Game, strategy: Strategy, tool: Tool) -> None:
    program = tool(replaying(winning(game, strategy)))
    with mock.patch("pursue_gen.solving.verifytga.verify", wraps=verify) as checker:
        run_verifytga(*game, path=program, limits=Limits(600))
    left = checker.call_args[1]["limits"]
    assert left.seconds == 600 and left.spent > 0


def test_a_limit_on_time_is_one_of_processor_time(game: Game, strategy: Strategy, tool: Tool) -> None:
    slept = f"time.sleep(2.5)\n{replaying(winning(game, strategy))}"
    assert run_verifytga(*game, path=tool(slept), limits=Limits(2.0)).won
    problem = failure(game, tool(f"{replaying(BEFORE)}\nwhile True:\n    pass"), 1)
    assert problem.exit_status == 5
    assert "no verdict of verifytga within the limit of 1 seconds of processor time" in told(problem)


@pytest.mark.parametrize("reason", ["limit", "Ctrl-C"])
def test_a_tool_that_hangs_is_ended_with_all_it_started(game: Game, tool: Tool, tmp_path: Path, reason: str) -> None:
    lock, hanging = tmp_path / "lock", tmp_path / "hanging"
    program = tool(
        f"import fcntl\nlock = open({str(lock)!r}, 'w')\nfcntl.flock(lock, fcntl.LOCK_EX)\n"
        "os.fork()\nsignal.signal(signal.SIGTERM, signal.SIG_IGN)\n"
        f"{replaying(BEFORE)}\nopen({str(hanging)!r}, 'w').close()\ntime.sleep(1000)"
    )
    if reason == "limit":
        for seconds in (0.5, 5, 50):  # on a busy machine the time may be over before it hangs
            problem = failure(game, program, seconds)
            if hanging.exists():
                break
        assert problem.exit_status == 5
        assert f"no verdict of verifytga within the limit of {seconds:g} seconds" in told(problem)
        assert "ended at the limit on time" in told(problem) and "Size: 42 states" in told(problem)
    else:
        with pytest.raises(KeyboardInterrupt), interrupted_once(hanging):
            run_verifytga(*game, path=program)
    assert hanging.exists()
    free_at_last(lock)


@contextlib.contextmanager
def interrupted_once(file: Path) -> Iterator[None]:
    """Ctrl-C as soon as the file is there."""
    here, over = threading.get_ident(), threading.Event()

    def interrupt() -> None:
        while not (file.exists() or over.wait(0.05)):
            pass
        if not over.is_set():
            signal.pthread_kill(here, signal.SIGINT)

    watcher = threading.Thread(target=interrupt)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    watcher.start()
    try:
        yield
    finally:
        over.set()
        watcher.join()
        signal.signal(signal.SIGINT, before)


def free_at_last(lock: Path) -> None:
    """Fails unless the lock gets free: as long as a process that shares it lives, it is not."""
    until = time.monotonic() + 300
    with open(lock, "w", encoding="utf-8") as stream:
        while True:
            try:
                fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
                return
            except BlockingIOError:
                assert time.monotonic() < until, "a process was left behind"
                time.sleep(0.05)


# It is not there -----------------------------------------------------------------------------------------------------


def test_an_absent_tool_is_reported(game: Game, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(PursueError) as caught:
        run_verifytga(*game)
    assert caught.value.exit_status == 6
    for words in ("not on PATH", "https://uppaal.org", "--verifytga PATH", "built-in solver"):
        assert words in told(caught.value)


@pytest.mark.parametrize("what, words", [("nothing", "there is no"), ("folder", "is a folder"), ("text", "chmod +x")])
def test_a_path_that_is_no_program_is_reported(game: Game, tmp_path: Path, what: str, words: str) -> None:
    path = tmp_path / "verifytga"
    if what == "folder":
        path.mkdir()
    elif what == "text":
        path.write_text("hello", encoding="utf-8")
    with pytest.raises(PursueError) as caught:
        run_verifytga(*game, path=path)
    assert caught.value.exit_status == 6
    assert words in told(caught.value) and str(path) in told(caught.value)


def test_a_program_for_another_machine_is_reported(game: Game, tmp_path: Path) -> None:
    path = tmp_path / "verifytga"
    path.write_bytes(b"\x7fELF" + bytes(60))
    path.chmod(0o755)
    problem = failure(game, path)
    assert problem.exit_status == 6
    assert "cannot be started" in told(problem) and "32-bit" in told(problem)


# Whatever it prints --------------------------------------------------------------------------------------------------

QUICK = settings(max_examples=25, deadline=None, suppress_health_check=list(HealthCheck))


def printing(tool: Tool, tmp_path: Path, output: bytes) -> Path:
    (tmp_path / "bytes").write_bytes(output)
    program = tool("")
    program.write_text(f"#!/bin/sh\nexec cat {shlex.quote(str(tmp_path / 'bytes'))}\n", encoding="utf-8")
    return program


@QUICK
@given(noise=st.binary(max_size=200), verdict=st.sampled_from(["", SATISFIED, LOST, SATISFIED + "Strategy to win:\n"]))
def test_noise_is_never_a_strategy(game: Game, tool: Tool, tmp_path: Path, noise: bytes, verdict: str) -> None:
    problem = failure(game, printing(tool, tmp_path, verdict.encode() + noise))
    assert problem.exit_status in (4, 5, 6)


@QUICK
@given(data=st.data())
def test_a_damaged_output_is_refused_or_still_wins(
    game: Game, strategy: Strategy, tool: Tool, tmp_path: Path, data: st.DataObject
) -> None:
    output = winning(game, strategy).encode()
    start = data.draw(st.integers(0, len(output)))
    end = data.draw(st.integers(start, len(output)))
    program = printing(tool, tmp_path, output[:start] + output[end:])
    try:
        verdict = run_verifytga(*game, path=program)
    except ToolError as problem:
        assert problem.exit_status in (4, 5, 6)
    else:
        assert verdict.strategy is not None
        assert verify(*game, verdict.strategy).ok


# The recorded runs ---------------------------------------------------------------------------------------------------


def replay(reference_dir: Path, name: str, plan: str) -> Tuple[Game, Path]:
    scenario = load(str(reference_dir / name / "scenario.pur"))
    return (translate(scenario), scenario_objective(scenario)), reference_dir / name / plan


@pytest.mark.parametrize("name", ["CT1", "CT2a", "WC1", "EB1", "EB3"])
def test_recorded_wins_are_proven_and_get_smaller(reference_dir: Path, tool: Tool, tmp_path: Path, name: str) -> None:
    recorded, plan = replay(reference_dir, name, "UPPAAL_plan.txt")
    verdict = run_verifytga(*recorded, path=printing(tool, tmp_path, plan.read_bytes()))
    assert verdict.strategy is not None
    theirs = read_plan(plan.read_text(encoding="utf-8"), recorded[0], str(plan))
    assert 0 < len(verdict.strategy.blocks) <= len(theirs.blocks) == verdict.stats.discrete_states
    assert verify(*recorded, verdict.strategy).ok


@pytest.mark.parametrize("name, blocks", [("WC2a", 7), ("CT3a", 3456)])
def test_recorded_losses_keep_their_counter_strategy(
    reference_dir: Path, tool: Tool, tmp_path: Path, name: str, blocks: int
) -> None:
    recorded, plan = replay(reference_dir, name, "UPPAAL_plan_failed.txt")
    problem = failure(recorded, printing(tool, tmp_path, plan.read_bytes()))
    assert problem.exit_status == 4
    assert problem.counter is not None and len(problem.counter.blocks) == blocks


# On the command line -------------------------------------------------------------------------------------------------


@pytest.fixture
def called(tmp_path: Path) -> Path:
    file = tmp_path / "called.pur"
    file.write_text(CALLED, encoding="utf-8")
    return file


def pursue(*arguments: object) -> "subprocess.CompletedProcess[str]":
    words = [sys.executable, "-m", "pursue_gen", *map(str, arguments)]
    return subprocess.run(words, capture_output=True, text=True, encoding="utf-8", cwd=ROOT, check=False)


IDEAL = ("--ends", "controllable", "--reaction", "0")


def test_solve_prints_the_tools_proven_plan(game: Game, strategy: Strategy, tool: Tool, called: Path) -> None:
    program = tool(replaying(winning(game, strategy)))
    done = pursue("solve", called, "--plan", "-", *IDEAL, "--solver", "verifytga", "--verifytga", program)
    assert done.returncode == 0, done.stderr
    assert read_plan(done.stdout, game[0], "plan").blocks
    assert "verifytga engine" in done.stderr and "proven" in done.stderr


def test_ws_takes_the_tools_strategy(game: Game, strategy: Strategy, tool: Tool, called: Path, tmp_path: Path) -> None:
    program = tool(replaying(winning(game, strategy)))
    options = ("-o", tmp_path / "ws", *IDEAL, "--solver", "verifytga", "--verifytga", program)
    assert pursue("ws", called, *options).returncode == 0
    assert (tmp_path / "ws" / "src" / "observer").is_dir()


def test_the_counter_strategy_stands_beside_the_plan(
    game: Game, strategy: Strategy, tool: Tool, called: Path, tmp_path: Path
) -> None:
    program = tool(replaying(losing(game, strategy)))
    options = ("-o", tmp_path / "plan.txt", *IDEAL, "--solver", "verifytga", "--verifytga", program)
    done = pursue("solve", called, *options)
    assert (done.returncode, done.stdout) == (4, "")
    assert not (tmp_path / "plan.txt").exists()
    kept = read_plan((tmp_path / "plan_failed.txt").read_text(encoding="utf-8"), game[0], "kept")
    assert kept == replace(strategy, counter=True)


def test_a_strategy_that_does_not_win_is_no_verdict(game: Game, strategy: Strategy, tool: Tool, called: Path) -> None:
    program = tool(replaying(winning(game, strategy)))
    options = ("--ends", "controllable", "--solver", "verifytga", "--verifytga", program)
    done = pursue("solve", called, "--json", *options)
    assert done.returncode == 4
    assert json.loads(done.stdout)["won"] is None


@pytest.mark.parametrize(
    "options",
    [
        ("solve", "--verifytga", "verifytga"),
        ("ws", "--solver", "verifytga", "--plan", "plan.txt"),
    ],
)
def test_options_that_contradict_each_other_are_reported(called: Path, options: Tuple[str, ...]) -> None:
    done = pursue(options[0], called, *options[1:])
    assert (done.returncode, done.stdout) == (2, "")
    assert "--solver" in done.stderr
