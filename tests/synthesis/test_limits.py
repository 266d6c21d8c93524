"""Limits on time and memory: engines and checker keep them, and say which it was, how far they were, what to do."""

from __future__ import annotations

import subprocess
import sys
import threading
import time
from fractions import Fraction
from pathlib import Path
from typing import Any, Iterator, List, Tuple
from unittest import mock

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError, render
from pursue_gen.language import load, parse
from pursue_gen.proof.checker import ProofReport, verify
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.proving import prove
from pursue_gen.solving.rules import IDEAL
from pursue_gen.solving.solution import solution
from pursue_gen.synthesis import limits as limits_module
from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.synthesis.limits import (
    CAREFUL,
    PROVING,
    SOLVING,
    LimitMonitor,
    Limits,
    Progress,
    careful_memory,
    limit_reached,
    memory_in_use,
    processor_time,
)
from pursue_gen.synthesis.native import engine as native
from pursue_gen.synthesis.solve import solve
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Network, Objective
from tests.conftest import thesis_scenario
from tests.large_scenarios import many_walkers
from tests.oracle import ENGINES
from tests.oracle import engine as reference

Game = Tuple[Network, Objective]
AT_ONCE = {"seconds": Limits(seconds=1e-9), "memory": Limits(memory=1)}

engines = pytest.mark.parametrize("engine", ENGINES)


@pytest.fixture(scope="module")
def game() -> Game:
    scenario = load(thesis_scenario("1"))
    return translate(scenario), scenario_objective(scenario)


@pytest.fixture(scope="module")
def strategy(game: Game) -> Strategy:
    found = solve(*game).strategy
    assert found is not None
    return found


@pytest.fixture
def eager(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whoever asks a watch is looked at and told of, every time."""
    monkeypatch.setattr(limits_module, "_CHECK_INTERVAL", 0.0)
    monkeypatch.setattr(limits_module, "_REPORT_INTERVAL", 0.0)


def told(problem: PursueError) -> str:
    assert problem.exit_status == 5
    assert [finding.code for finding in problem.diagnostics] == ["SYN010"]
    return render(problem.diagnostics[0])


# Engines --------------------------------------------------------------------------------------------------------------


@engines
@pytest.mark.parametrize("which", AT_ONCE)
def test_a_limit_ends_an_engine(game: Game, engine: str, which: str) -> None:
    with pytest.raises(PursueError) as failure:
        solve(*game, engine=ENGINES[engine], limits=AT_ONCE[which])
    text = told(failure.value)
    assert {"seconds": "1e-09 seconds of processor time", "memory": "the limit of 1 MiB of memory"}[which] in text
    assert {"seconds": "--limit", "memory": "--memory"}[which] in text
    assert "states were reached" in text and "make the scenario smaller" in text


@engines
def test_limits_that_are_not_hit_change_nothing(game: Game, engine: str) -> None:
    limits = Limits(600, memory_in_use() + 4096)
    free, kept = solve(*game, engine=ENGINES[engine]), solve(*game, engine=ENGINES[engine], limits=limits)
    assert (kept.won, kept.strategy) == (free.won, free.strategy)
    assert kept.stats.discrete_states == free.stats.discrete_states


@engines
def test_the_progress_is_reported(game: Game, engine: str, eager: None) -> None:
    heard: List[Progress] = []
    solve(*game, engine=ENGINES[engine], progress=heard.append)
    assert heard
    assert all(p.phase == SOLVING and p.memory > 0 and p.seconds >= 0 and p.states >= 0 for p in heard)
    assert [p.states for p in heard] == sorted(p.states for p in heard)


@engines
def test_ctrl_c_while_the_progress_is_reported_ends_an_engine(game: Game, engine: str) -> None:
    with pytest.raises(KeyboardInterrupt):
        solve(*game, engine=ENGINES[engine], progress=mock.Mock(side_effect=KeyboardInterrupt))


@engines
@pytest.mark.parametrize("wall", [False, True])
def test_what_others_do_meanwhile_counts_for_who_waits_alone(game: Game, engine: str, wall: bool) -> None:
    rests = iter([1.5])

    def rest(_: Progress) -> None:
        time.sleep(next(rests, 0.0))

    limits = Limits(1.0, wall=wall)
    if not wall:
        assert solve(*game, engine=ENGINES[engine], limits=limits, progress=rest).won
        return
    with mock.patch.object(limits_module, "_CHECK_INTERVAL", 0.0), pytest.raises(PursueError) as failure:
        solve(*game, engine=ENGINES[engine], limits=limits, progress=rest)
    assert "the limit of 1 seconds;" in told(failure.value)


@engines
def test_of_a_large_game_it_is_reported_how_far_it_got(engine: str) -> None:
    scenario = parse(many_walkers(), "crowd.pur")
    for seconds in (0.5, 5.0, 50.0):  # on a busy machine the time may be over before much is done
        with pytest.raises(PursueError) as failure:
            solve(translate(scenario), scenario_objective(scenario), engine=ENGINES[engine], limits=Limits(seconds))
        words = told(failure.value).split("; ")[1].split()
        if int(words[0]) > 1:
            break
    assert words[1:4] == ["discrete", "states", "were"] and int(words[0]) > 1
    assert words[6] == "waiting," and int(words[5]) > 0


@engines
def test_a_limit_on_memory_ends_a_large_game(engine: str) -> None:
    scenario = parse(many_walkers(), "crowd.pur")
    most = memory_in_use() + 12
    with pytest.raises(PursueError) as failure:
        solve(translate(scenario), scenario_objective(scenario), engine=ENGINES[engine], limits=Limits(1200, most))
    assert f"the limit of {most} MiB of memory" in told(failure.value)


def test_memory_is_looked_at_while_python_loads_a_codec() -> None:
    """A signal asks for it at any moment, also within that import: the name of the codec is not known then."""
    loading = "import sys; from pursue_gen.synthesis.limits import memory_in_use; sys.modules['encodings.ascii'] = None"
    asked = subprocess.run([sys.executable, "-c", f"{loading}; print(memory_in_use())"], stdout=subprocess.PIPE)
    assert int(asked.stdout) > 0


def test_other_threads_go_on_while_the_native_engine_solves() -> None:
    scenario = parse(many_walkers(), "crowd.pur")
    game = compile_game(translate(scenario), scenario_objective(scenario))
    enough, ended = threading.Event(), threading.Event()

    def report(progress: Progress) -> None:
        if enough.is_set():
            raise KeyboardInterrupt

    def work() -> None:
        with pytest.raises(KeyboardInterrupt):
            native.NativeEngine().solve(game, Limits(seconds=600), report)
        ended.set()

    interval = sys.getswitchinterval()
    sys.setswitchinterval(600)  # so that a thread has the interpreter until it gives it away
    try:
        thread = threading.Thread(target=work)
        thread.start()
        enough.set()
        thread.join(500)
    finally:
        sys.setswitchinterval(interval)
    assert ended.is_set()


def test_the_last_of_the_memory_ends_the_native_engine_with_a_message() -> None:
    code = f"""if True:
        import resource
        from pursue_gen.diagnostics import PursueError
        from pursue_gen.language import parse
        from pursue_gen.synthesis.native import engine as native
        from pursue_gen.synthesis.compile_game import compile_game
        from pursue_gen.tga import scenario_objective, translate
        scenario = parse({many_walkers()!r}, "crowd.pur")
        game = compile_game(translate(scenario), scenario_objective(scenario))
        used = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (used + (64 << 20), resource.RLIM_INFINITY))
        try:
            native.NativeEngine().solve(game)
        except PursueError as problem:
            print(problem.exit_status, problem.diagnostics[0].message)
    """
    if not Path("/proc/self/statm").exists():
        pytest.skip("this system does not tell how much memory a process has")
    root = Path(__file__).resolve().parents[2]
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=str(root), stdout=subprocess.PIPE, timeout=600, universal_newlines=True
    )
    assert done.stdout.startswith("5 no verdict with the memory that there is")


@pytest.mark.parametrize("engine", ENGINES)
def test_memory_that_is_not_given_is_reported_as_a_limit(game: Game, engine: str) -> None:
    core = mock.Mock(solve=mock.Mock(side_effect=MemoryError), LimitReached=ZeroDivisionError)
    with mock.patch.object(native, "_core", core), mock.patch.object(reference, "_assign", side_effect=MemoryError):
        with pytest.raises(PursueError) as failure:
            solve(*game, engine=ENGINES[engine])
        assert "with the memory that there is" in told(failure.value)
        with pytest.raises(PursueError) as failure:
            solve(*game, engine=ENGINES[engine], limits=Limits(memory=1 << 20))
        assert "the limit of 1048576 MiB" in told(failure.value)


# The checker ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("which", AT_ONCE)
def test_a_limit_ends_the_checker(game: Game, strategy: Strategy, which: str) -> None:
    with pytest.raises(PursueError) as failure:
        verify(*game, strategy, limits=AT_ONCE[which])
    text = told(failure.value)
    assert "no proof within the limit of" in text and "only what is proven is used" in text


def test_the_checker_tells_its_progress(game: Game, strategy: Strategy, eager: None) -> None:
    heard: List[Progress] = []
    assert verify(*game, strategy, progress=heard.append).ok
    assert heard and {p.phase for p in heard} == {PROVING}


def test_one_allowance_is_for_the_solver_and_the_checker(game: Game, eager: None) -> None:
    heard: List[Progress] = []
    solution(*game, IDEAL, SolveOptions(Limits(600, 1 << 20), progress=heard.append))
    phases = [p.phase for p in heard]
    assert phases == sorted(phases, reverse=True) and set(phases) == {SOLVING, PROVING}
    report = ProofReport(True, "", (), frozenset(), 1)
    with mock.patch("pursue_gen.solving.proving.verify", return_value=report) as checker:
        solution(*game, IDEAL, SolveOptions(Limits(600)))
    given_limits = checker.call_args[1]["limits"]
    assert given_limits.seconds == 600 and 0 < given_limits.spent < 600


def test_what_the_checker_does_not_decide_is_no_defeat(game: Game, strategy: Strategy) -> None:
    undecided = ProofReport(False, "limit: not decided within 7 symbolic states", (), frozenset(), 7)
    checker = mock.patch("pursue_gen.solving.proving.verify", return_value=undecided)
    with checker, pytest.raises(PursueError) as failure:
        prove(*game, strategy, Fraction(0))
    assert "not proven: limit: not decided within 7 symbolic states" in told(failure.value)


# Limits and memory ----------------------------------------------------------------------------------------------------


@given(seconds=st.floats(0.001, 1e6), spent=st.floats(0, 1e7))
def test_what_is_left_is_never_no_limit(seconds: float, spent: float) -> None:
    left = Limits(seconds, 0, spent).left
    assert 0 < left <= seconds
    assert left == pytest.approx(max(seconds - spent, 1e-9))


@given(spent=st.floats(0, 1e7))
def test_no_limit_stays_none(spent: float) -> None:
    assert Limits(0.0, 0, spent).left == 0.0


@pytest.mark.parametrize("wall", [False, True])
def test_time_that_was_spent_is_kept_in_mind(wall: bool) -> None:
    limits = Limits(10.0, 5, wall=wall)
    now = limits.now()
    later = limits.since(now - 4.0).since(now - 3.0)
    assert (later.seconds, later.memory, later.wall) == (10.0, 5, wall)
    assert later.spent >= 7.0 and later.left <= 3.0


def test_seconds_are_those_that_this_process_and_its_children_work() -> None:
    begin, there = processor_time(), Limits(wall=True).now()
    time.sleep(0.2)
    slept = processor_time() - begin
    work = "import time\nwhile time.process_time() < 0.3: pass"
    subprocess.run([sys.executable, "-c", work], check=True)
    assert slept < 0.2 <= Limits(wall=True).now() - there
    assert processor_time() - begin - slept >= 0.3


def test_the_message_names_the_whole_limit() -> None:
    text = told(limit_reached("seconds", Limits(10.0, 0, 9.5), Progress(12, 3, 0.5, 40)))
    assert "within the limit of 10 seconds of processor time; 12 discrete states were reached, 3 waiting" in text
    text = told(limit_reached("seconds", Limits(10.0, wall=True), Progress(12, 3, 0.5, 40)))
    assert "within the limit of 10 seconds; 12 discrete states were reached, 3 waiting, 40 MiB in use" in text


def test_a_watch_is_quiet_between_two_reports() -> None:
    heard: List[Progress] = []
    clock = iter([0.0, 0.0, 0.01, 0.1, 0.19, 0.25])
    with mock.patch.object(limits_module, "processor_time", side_effect=lambda: next(clock)):
        watch = LimitMonitor(listener=heard.append)
        for states in range(5):
            watch.check(states, 0)
    assert [p.states for p in heard] == [0, 4]


def test_memory_in_use_is_that_of_this_process() -> None:
    before = memory_in_use()
    ballast = b"x" * (96 << 20)
    assert memory_in_use() - before > 64
    del ballast


def test_where_the_system_does_not_tell_the_peak_counts() -> None:
    with mock.patch("builtins.open", side_effect=FileNotFoundError):
        peak = memory_in_use()
    assert peak >= memory_in_use() // 2 > 0


@pytest.mark.parametrize(
    ("free", "limit"), [([], CAREFUL), ([10**6], CAREFUL), ([1000], 800), ([1000, 500], 400), ([0], 1)]
)
def test_no_more_than_the_machine_has(free: List[int], limit: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(limits_module, "_available", lambda: iter(free))
    monkeypatch.setattr(limits_module, "memory_in_use", lambda: 40)
    assert careful_memory() == limit


def test_what_a_process_holds_of_earlier_work_does_not_count(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(limits_module, "_available", lambda: iter([10**6]))
    monkeypatch.setattr(limits_module, "memory_in_use", lambda: 2000)
    assert careful_memory() - 2000 > CAREFUL - 200


def test_what_is_available_is_read_from_the_machine_and_the_container() -> None:
    files = {
        "/proc/meminfo": "MemTotal: 8000000 kB\nMemAvailable:  2048000 kB\n",
        "/sys/fs/cgroup/memory.max": "max\n",
        "/sys/fs/cgroup/memory/memory.limit_in_bytes": f"{300 << 20}\n",
    }

    def opened(path: str, *_: Any, **__: Any) -> Any:
        if path not in files:
            raise FileNotFoundError(path)
        return mock.mock_open(read_data=files[path])()

    with mock.patch("builtins.open", opened), mock.patch.object(limits_module, "memory_in_use", return_value=50):
        found: Iterator[int] = limits_module._available()
        assert list(found) == [2050, 300]
