"""The command line: what it prints where, its exit statuses, and that nothing a person does ends in a traceback."""

from __future__ import annotations

import contextlib
import functools
import io
import json
import os
import re
import shlex
import signal
import subprocess
import sys
import time
import weakref
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, Iterator, List, Tuple, Type
from unittest import mock

import pytest
import typer.main
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from pursue_gen import __version__
from pursue_gen.cli.app import main
from pursue_gen.cli.inputs import explained
from pursue_gen.diagnostics import error
from pursue_gen.explanation import costs as costs_module
from pursue_gen.explanation.costs import Costs
from pursue_gen.language import load
from pursue_gen.outcomes import LimitHit
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.rules import Rules, played
from pursue_gen.synthesis.limits import UNDECIDED
from pursue_gen.synthesis.plan import read_plan
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.uppaal import read_network, read_query
from pursue_gen.workspace.packages import DEPENDS

ROOT = Path(__file__).resolve().parents[2]
THESIS = ROOT / "scenarios" / "thesis"
FIRST = str(THESIS / "scenario_1.pur")

CALLED = """poi "desk"
poi "shelf"
connect desk and shelf distance 2
event "callBot"
event "fetch" location shelf
agent "bot" controllable mobile 1 location desk can_do fetch
agent "visitor" location desk can_do callBot
objective: if callBot then fetch within {deadline}
"""
"""Won with a deadline of 5, only ideally with 4, lost with 3: the way takes 2 to 3, and 1 passes before and after."""

NOT_DECIDED = "ends reported, reaction 0.1: not decided\nends controllable, reaction 0: not decided\n"


@dataclass(frozen=True)
class Outcome:
    """What a command left behind."""

    status: int
    out: str
    err: str


class Terminal(io.TextIOWrapper):
    """A stream that says it is a terminal."""

    def isatty(self) -> bool:
        return True


command_of = functools.lru_cache(maxsize=None)(typer.main.get_command)
"""What typer makes of the program's functions, made once: a process calls the program many times here."""


def pursue(*arguments: object, stream: Type[io.TextIOWrapper] = io.TextIOWrapper, **environment: str) -> Outcome:
    """Runs the program in this process."""
    out, err = (stream(io.BytesIO(), encoding="utf-8", newline="") for _ in range(2))
    words = ["pursue-gen", *map(str, arguments)]
    status = 0
    with contextlib.ExitStack() as changed:
        changed.enter_context(contextlib.redirect_stdout(out))
        changed.enter_context(contextlib.redirect_stderr(err))
        changed.enter_context(mock.patch.object(sys, "argv", words))
        changed.enter_context(mock.patch.dict(os.environ, environment))
        changed.enter_context(mock.patch.object(typer.main, "get_command", command_of))
        try:
            main()
        except SystemExit as end:
            status = int(end.code or 0)
    texts = []
    for stream in (out, err):
        stream.flush()
        stream.seek(0)
        texts.append(stream.read())
    return Outcome(status, *texts)


def program(*arguments: object, **environment: str) -> subprocess.CompletedProcess[str]:
    """Runs it as a program of its own."""
    words = [sys.executable, "-m", "pursue_gen", *map(str, arguments)]
    variables = {**os.environ, **environment}
    return subprocess.run(words, cwd=str(ROOT), env=variables, capture_output=True, text=True, timeout=600, check=False)


def called(folder: Path, deadline: int) -> Path:
    file = folder / "called.pur"
    file.write_text(CALLED.format(deadline=deadline), encoding="utf-8")
    return file


def tree(folder: Path) -> Dict[str, bytes]:
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


# Around all commands -------------------------------------------------------------------------------------------------


def test_version() -> None:
    assert pursue("--version").out == f"pursue-gen {__version__}\n"


def test_as_a_module_it_is_the_same_program() -> None:
    assert program("--version").stdout == f"pursue-gen {__version__}\n"


@pytest.mark.parametrize("command", ["check", "tga", "solve", "verify", "report", "ws"])
def test_every_command_explains_itself_with_an_example(command: str) -> None:
    told = pursue(command, "--help")
    assert told.status == 0
    assert f"pursue-gen {command}" in " ".join(told.out.split("For example:")[1].split())


def test_without_a_command_it_lists_them() -> None:
    told = pursue()
    assert "solve" in told.out + told.err


@pytest.mark.parametrize("words", [["frobnicate"], ["ws"], ["ws", FIRST, "--ends", "never"], ["check", "--frob"]])
def test_a_wrong_command_line_is_reported_on_stderr(words: List[str]) -> None:
    told = pursue(*words)
    assert (told.status, told.out) == (2, "")
    assert "Error" in told.err


@pytest.mark.parametrize(
    ("words", "proposal"),
    [
        (["slove", FIRST], "No such command 'slove'. Did you mean 'solve'?"),
        (["simulate", FIRST], "Did you mean 'sim'?"),
        (["Check", FIRST], "Did you mean 'check'?"),
        (["exam"], "Did you mean 'examples'?"),
        (["keys", "lst"], "No such command 'lst'. Did you mean 'list'?"),
        (["frobnicate"], "No such command 'frobnicate'. 'pursue-gen -h' lists them."),
        (["keys", "frobnicate"], "'pursue-gen keys -h' lists them."),
        (["solve", FIRST, "--withn", "3"], "--within"),
    ],
)
def test_a_misspelt_command_or_option_gets_a_proposal(words: List[str], proposal: str) -> None:
    done = pursue(*words)
    assert (done.status, done.out) == (2, "")
    assert proposal in " ".join(done.err.split())


def test_a_fault_of_ours_is_one_sentence() -> None:
    with mock.patch("pursue_gen.language.load", side_effect=ZeroDivisionError("oops")):
        told = pursue("solve", FIRST)
    assert told.status == 1
    assert "internal error of pursue-gen: ZeroDivisionError: oops" in told.err and has_internal_error(told.err)
    assert "Traceback" not in told.err


def test_colour_is_for_terminals_that_want_it(tmp_path: Path) -> None:
    broken = tmp_path / "broken.pur"
    broken.write_text('poi "a"\n', encoding="utf-8")
    assert "\033[31;1merror PML" in pursue("check", broken, stream=Terminal, NO_COLOR="", TERM="xterm").out
    assert "\033" not in pursue("check", broken, stream=Terminal, NO_COLOR="1", TERM="xterm").out
    assert "\033" not in pursue("check", broken, NO_COLOR="", TERM="xterm").out


def test_nobody_reads_what_it_prints() -> None:
    words = [sys.executable, "-m", "pursue_gen", "solve", str(THESIS / "catch_the_thief.pur"), "--plan", "-"]
    ours, its = os.pipe()
    os.close(ours)  # before it starts: it may be quick, and we slow
    try:
        done = subprocess.run(words, cwd=str(ROOT), stdout=its, stderr=subprocess.PIPE, text=True, check=False)
    finally:
        os.close(its)
    assert "Error" not in done.stderr
    assert done.returncode == 141


def test_ctrl_c_ends_it_with_130(tmp_path: Path) -> None:
    pipe = tmp_path / "never.pur"
    os.mkfifo(str(pipe))
    patient = "import sys, pursue_gen.language.parser as parser; parser._PATIENCE = 1000"
    code = f"{patient}; from pursue_gen.cli.app import main; sys.exit(main())"
    words = [sys.executable, "-c", code, "check", str(pipe)]
    with subprocess.Popen(words, cwd=str(ROOT), stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        with open(pipe, "w", encoding="utf-8"):  # open for writing: it reads by now, and waits for more
            time.sleep(0.2)
            process.send_signal(signal.SIGINT)
            process.wait(300)
        told = process.stderr.read()
    assert (process.returncode, told) == (130, "interrupted\n")


def test_letters_that_the_terminal_cannot_show_do_not_stop_it(tmp_path: Path) -> None:
    broken = tmp_path / "broken.pur"
    broken.write_text('poi "a"\npoi "ü€"\n', encoding="utf-8")
    told = program("check", broken, PYTHONIOENCODING="ascii")
    assert told.returncode == 3
    assert "Traceback" not in told.stderr and "PML" in told.stdout


def has_internal_error(told: str) -> bool:
    """True where it reports an internal error; a line of a file may hold these words, but not at the beginning."""
    return any(line.startswith(("Traceback", "error: internal error of pursue-gen")) for line in told.split("\n"))


def test_an_internal_error_is_distinguished_from_words_in_a_file(tmp_path: Path) -> None:
    file = tmp_path / "some.pur"
    for word in ("internal error", "Traceback", "error: internal error of pursue-gen"):
        file.write_text(f"{word}\n{word}\n", encoding="utf-8")
        told = pursue("check", file)
        assert told.status == 3 and word.split()[0] in told.out
        assert not has_internal_error(told.err) and not has_internal_error(told.out)


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(content=st.binary(max_size=300), command=st.sampled_from(["check", "solve", "tga", "report", "ws"]))
def test_no_file_content_gives_a_traceback(tmp_path: Path, content: bytes, command: str) -> None:
    file = tmp_path / "some.pur"
    file.write_bytes(content)
    told = pursue(command, file)
    assert told.status in (2, 3)
    assert not has_internal_error(told.err)


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(model=st.binary(max_size=200), query=st.binary(max_size=50), plan=st.binary(max_size=200))
def test_no_content_of_other_files_gives_a_traceback(tmp_path: Path, model: bytes, query: bytes, plan: bytes) -> None:
    for name, content in (("TGA.xml", model), ("TCTL.q", query), ("plan.txt", plan)):
        (tmp_path / name).write_bytes(content)
    for words in (["solve", tmp_path / "TGA.xml", tmp_path / "TCTL.q"], ["verify", FIRST, tmp_path / "plan.txt"]):
        told = pursue(*words)
        assert told.status in (2, 3)
        assert not has_internal_error(told.err)


@pytest.mark.parametrize("command", ["tga", "solve", "report", "ws"])
def test_files_that_cannot_be_read_are_named(tmp_path: Path, command: str) -> None:
    for place in (tmp_path, tmp_path / "missing.pur"):
        told = pursue(command, place)
        assert (told.status, told.out) == (2, "")
        assert str(place) in told.err


# check ---------------------------------------------------------------------------------------------------------------


def test_check_finds_nothing_wrong_and_suggests_the_next_command() -> None:
    told = pursue("check", FIRST, THESIS / "scenario_3.pur")
    assert (told.status, told.out) == (0, "")
    assert "2 files: 0 errors, 0 warnings" in told.err
    assert f"next: pursue-gen ws {shlex.quote(FIRST)}" in told.err


def test_check_shows_the_place_of_every_error_in_every_file(tmp_path: Path) -> None:
    good = Path(FIRST).read_text(encoding="utf-8")
    for name, wrong, right in (("one", "connect c and x", "connect c and b"), ("two", "do nothing", "do bot2_ina")):
        (tmp_path / f"{name}.pur").write_text(good.replace(right, wrong), encoding="utf-8")
    told = pursue("check", tmp_path / "one.pur", tmp_path / "two.pur", tmp_path / "three.pur")
    assert told.status == 2, "one file cannot be read"
    assert f"{tmp_path}/one.pur:10:15: error PML110" in told.out
    assert "    connect c and x distance 3\n                  ^" in told.out
    assert f"{tmp_path}/two.pur:" in told.out
    assert f"cannot read {tmp_path}/three.pur" in told.out


def test_check_in_json(tmp_path: Path) -> None:
    file = tmp_path / "island.pur"
    text = Path(FIRST).read_text(encoding="utf-8")
    file.write_text(text.replace('poi "b"', 'poi "island"\npoi "b"'), encoding="utf-8")
    told = pursue("check", "--json", file)
    (finding,) = json.loads(told.out)
    assert told.status == 0
    assert (finding["severity"], finding["file"], finding["line"]) == ("warning", str(file), 5)


def test_warnings_do_not_stop_other_commands_but_are_reported(tmp_path: Path) -> None:
    file = tmp_path / "island.pur"
    text = Path(FIRST).read_text(encoding="utf-8")
    file.write_text(text.replace('poi "b"', 'poi "island"\npoi "b"'), encoding="utf-8")
    told = pursue("solve", file, "-o", tmp_path / "plan.txt")
    assert told.status == 0
    assert "warning PML147" in told.err


def test_an_event_that_nothing_uses_changes_no_plan(tmp_path: Path) -> None:
    file = tmp_path / "more.pur"
    file.write_text(
        Path(FIRST).read_text(encoding="utf-8").replace("rule ", 'event "wave" collaborative duration 3\n\nrule ', 1),
        encoding="utf-8",
    )
    assert pursue("check", file).status == 0
    for scenario, plan in ((FIRST, "plan.txt"), (file, "more.txt")):
        assert pursue("solve", scenario, "-o", tmp_path / plan).status == 0
    assert tree(tmp_path)["more.txt"] == tree(tmp_path)["plan.txt"]
    assert pursue("sim", file, "--runs", "3").status == 0
    assert pursue("ws", file, "-o", tmp_path / "ws").status == 0
    assert "warning PML157" in pursue("verify", file, tmp_path / "plan.txt").err


# tga -----------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("ends", ["controllable", "reported"])
def test_tga_writes_what_uppaal_reads(tmp_path: Path, ends: str) -> None:
    told = pursue("tga", FIRST, "-o", tmp_path / "new" / "folder", "--ends", ends)
    model, query = map(Path, told.out.splitlines())
    assert [model.name, query.name] == ["TGA.xml", "TCTL.q"]
    scenario = load(FIRST)
    expected = played(translate(scenario), Rules(ends))
    network = read_network(model.read_text(encoding="utf-8"), str(model))
    assert [a.edges for a in network.automata] == [a.edges for a in expected.automata]
    assert read_query(query.read_text(encoding="utf-8"), str(query)) == scenario_objective(scenario)
    assert f"next: pursue-gen solve {model} {query}" in told.err


def test_tga_writes_both_files_or_none(tmp_path: Path) -> None:
    (tmp_path / "TCTL.q").mkdir()
    told = pursue("tga", FIRST, "-o", tmp_path)
    assert told.status == 2
    assert "cannot write" in told.err and "TCTL.q" in told.err
    assert [p.name for p in tmp_path.iterdir()] == ["TCTL.q"]


def test_tga_does_not_write_into_a_file(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("mine", encoding="utf-8")
    assert pursue("tga", FIRST, "-o", tmp_path / "file").status == 2
    assert (tmp_path / "file").read_text(encoding="utf-8") == "mine"


# solve ---------------------------------------------------------------------------------------------------------------


def test_solve_prints_a_summary() -> None:
    told = pursue("solve", FIRST)
    assert (told.status, told.out) == (0, "")
    assert told.err.startswith("won: ends reported, reaction 0.1")
    assert "Time to the goal: at most 23.4 time units; nothing below 23.3" in told.err
    assert "Margin: it still wins" in told.err
    assert f"next: pursue-gen ws {shlex.quote(FIRST)}" in told.err


@pytest.mark.parametrize("words", [("--plan", "-"), ("--plan=-",), ("-o", "-")])
def test_solve_prints_the_plan_when_it_is_asked_to(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, words: Tuple[str, ...]
) -> None:
    monkeypatch.chdir(tmp_path)
    told = pursue("solve", FIRST, *words)
    assert told.status == 0
    assert read_plan(told.out, played(translate(load(FIRST)), Rules()), "plan").blocks
    assert "won: ends reported, reaction 0.1" in told.err
    assert pursue("solve", FIRST, "-o", "plan.txt").status == 0
    assert tree(tmp_path) == {"plan.txt": told.out.encode("utf-8")}


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--plan", "plan.txt"), "to write the plan: -o FILE"),
        (("--plan", "-", "--json"), "stdout cannot have both"),
        (("-o", "-", "--json"), "stdout cannot have both"),
    ],
)
def test_solve_refuses_what_would_mix_its_output(words: Tuple[str, ...], message: str) -> None:
    told = pursue("solve", FIRST, *words)
    assert (told.status, told.out) == (2, "")
    assert message in told.err


@pytest.mark.parametrize(
    ("command", "missing"),
    [
        ("solve", "synthesis.native.engine._core"),
        ("solve", "proof.native.tables._proof"),
        ("ws", "synthesis.native.engine._core"),
        ("verify", "proof.native.tables._proof"),
    ],
)
def test_without_the_native_solver_or_checker_it_says_what_to_do(tmp_path: Path, command: str, missing: str) -> None:
    plan = tmp_path / "plan.txt"
    assert pursue("solve", FIRST, "-o", plan).status == 0
    words = {"solve": [], "ws": ["-o", tmp_path / "ws"], "verify": [plan]}[command]
    with mock.patch(f"pursue_gen.{missing}", None):
        told = pursue(command, FIRST, *words)
        assert pursue("check", FIRST).status == 0, "what needs neither goes on"
    assert (told.status, told.out) == (6, "")
    assert "SYN011" in told.err and "./run setup" in told.err
    assert not (tmp_path / "ws").exists()


def test_solve_in_json(tmp_path: Path) -> None:
    told = pursue("solve", FIRST, "--json", "--reaction", "1/20", "--slack", "2", "--slack", "bot1=3")
    verdict = json.loads(told.out)
    assert told.status == 0
    assert verdict["won"] is True
    assert verdict["slack"] == {"bot1": 3, "bot2": 2}
    assert verdict["reaction"] == 0.05
    assert verdict["states"] > 0 and verdict["commands"] > 0 and verdict["seconds"] >= 0


def test_what_is_optional_is_promised_or_given_up(tmp_path: Path) -> None:
    errands, plan = ROOT / "scenarios/office/errands.pur", tmp_path / "plan.txt"
    promised = "optional 1 is promised: do fetch within 24.\n"
    given_up = "optional 2 is given up, it cannot be promised together with the rest: do water within 24.\n"
    solved = pursue("solve", errands, "--json", "-o", plan)
    verdict = json.loads(solved.out)
    assert verdict["won"] is True
    assert verdict["optional"] == {"promised": [1], "given_up": [2], "undecided": []}
    proven = pursue("verify", errands, plan)
    assert proven.out == "ends reported, reaction 0.1: the plan wins\n"
    missions = pursue("sim", errands, "--runs", "1", "--plan", plan)
    written = pursue("ws", errands, "-o", tmp_path / "ws")
    for outcome in (solved, proven, missions, written):
        assert outcome.status == 0 and promised + given_up in outcome.err


def test_nothing_optional_helps_where_the_rest_is_lost() -> None:
    lost = pursue("solve", ROOT / "scenarios/office/two_errands.pur", "--json")
    assert lost.status == 4 and "optional" not in lost.err
    conflict = ["reach_objective: do mail within 9", "reach_objective: do water within 9"]
    assert json.loads(lost.out)["explanation"]["conflict"] == conflict


def _texts(value: object) -> Iterator[str]:
    """Every text in a JSON value."""
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list):
        for part in value:
            yield from _texts(part)
    elif isinstance(value, str):
        yield value


@pytest.mark.parametrize(
    "words",
    [
        ["solve", FIRST, "--reaction", "1/20", "--margin"],
        ["solve", FIRST, "--within", "47/2"],
        ["solve", "LOST"],
        ["report", FIRST],
        ["sim", FIRST, "--runs", "2"],
    ],
    ids=lambda words: " ".join(str(word) for word in words if word != FIRST),
)
def test_numbers_in_json_are_numbers(tmp_path: Path, words: List[str]) -> None:
    done = pursue(*(called(tmp_path, 3) if word == "LOST" else word for word in words), "--json")
    numbers = [text for text in _texts(json.loads(done.out)) if re.fullmatch(r"-?[\d./]*\d", text)]
    assert numbers == []


def test_solve_takes_uppaals_files(tmp_path: Path) -> None:
    files = pursue("tga", FIRST, "-o", tmp_path).out.splitlines()
    assert pursue("solve", *files, "--plan", "-").out == pursue("solve", FIRST, "--plan", "-").out != ""


def test_an_objective_that_cannot_be_met_has_its_own_status(tmp_path: Path) -> None:
    told = pursue("solve", called(tmp_path, 3), "-o", tmp_path / "plan.txt")
    assert (told.status, told.out) == (4, "")
    assert "the objective cannot be met" in told.err
    assert "ideal" not in told.err
    assert not (tmp_path / "plan.txt").exists()


def test_a_win_in_the_ideal_game_only_is_said(tmp_path: Path) -> None:
    file = called(tmp_path, 4)
    told = pursue("solve", file, "--json")
    assert told.status == 4
    assert "only the ideal game" in told.err
    verdict = json.loads(told.out)
    assert verdict["won"] is False
    assert "only the ideal game" in verdict["diagnostics"][0]["message"]
    assert pursue("solve", file, "--ends", "controllable", "--reaction", "0").status == 0


@pytest.mark.parametrize("option", [["--limit", "0.000001"], ["--memory", "1"]])
def test_a_limit_is_no_verdict(option: List[str]) -> None:
    told = pursue("solve", FIRST, *option, "--json")
    assert told.status == 5
    verdict = json.loads(told.out)
    assert verdict["won"] is None
    assert [finding["code"] for finding in verdict["diagnostics"]] == ["SYN010"]
    assert option[0] in told.err and "states were reached" in told.err
    assert "decided" in verdict["costs"]
    assert "costs" not in json.loads(pursue("solve", FIRST, *option, "--json", "--no-explain").out)


@pytest.mark.parametrize("command", ["solve", "ws", "report", "sim", "play"])
def test_after_a_limit_it_is_said_what_is_large(command: str, tmp_path: Path) -> None:
    output = ["-o", str(tmp_path / "out")] if command == "ws" else []
    told = pursue(command, FIRST, *output, "--memory", "1")
    assert (told.status, told.out) == (5, "")
    assert told.err.count("SYN010") == 1
    assert "Without bot1 it is decided in " in told.err.split("Looking for what makes it so large …\n")[1]


def test_what_a_search_has_held_is_gone_when_it_is_said_what_is_large() -> None:
    held: List[weakref.ReferenceType[mock.Mock]] = []

    def search() -> None:
        large = mock.Mock()
        held.append(weakref.ref(large))
        raise LimitHit([error(UNDECIDED, "no verdict")])

    def look(*_: object) -> Costs:
        assert held[0]() is None
        return Costs((), ())

    with pytest.raises(LimitHit) as problem:
        search()
    with mock.patch.object(costs_module, "costs", side_effect=look) as looked:
        explained(problem.value, load(FIRST), SolveRequest(), quiet=True)
    assert looked.called


@pytest.mark.parametrize("option", [["--limit", "0.000001"], ["--memory", "1"]])
@pytest.mark.parametrize("command", ["report", "ws", "ws --plan", "verify"])
def test_a_limit_ends_every_command_that_may_take_long(command: str, option: List[str], tmp_path: Path) -> None:
    name, *given = command.split()
    plan = tmp_path / "plan.txt"
    if given or name == "verify":
        assert pursue("solve", FIRST, "-o", plan).status == 0
        given = [*given, str(plan)]
    given += ["-o", str(tmp_path / "ws")] if name == "ws" else []
    told = pursue(name, FIRST, *given, *option)
    assert told.status == 5
    assert "error SYN010" in told.err and option[0] in told.err
    assert told.out == ("" if name != "verify" else NOT_DECIDED)
    assert not (tmp_path / "ws").exists()


def test_limits_that_are_no_limits_change_nothing() -> None:
    free = pursue("solve", FIRST, "--limit", "0", "--memory", "0", "--plan", "-")
    assert (free.status, free.out) == (0, pursue("solve", FIRST, "--plan", "-").out)
    for option in ("--limit=-1", "--memory=-1", "--memory=much"):
        assert pursue("solve", FIRST, option).status == 2


def test_memory_is_limited_where_nobody_says_anything() -> None:
    with mock.patch("pursue_gen.synthesis.limits.careful_memory", return_value=1):
        told = pursue("solve", FIRST)
    assert told.status == 5
    assert "the limit of 1 MiB of memory" in told.err


@pytest.mark.parametrize("reaction", ["soon", "1/0", "-1", "nan", "1e-9", "1e9", "", "0.1.1"])
def test_a_reaction_that_cannot_be_is_reported(reaction: str) -> None:
    told = pursue("solve", FIRST, f"--reaction={reaction}")
    assert (told.status, told.out) == (2, "")
    assert "the reaction is" in told.err


@pytest.mark.parametrize("slack", ["late", "bot1=", "=3", "bot1=-1", "1.5"])
def test_a_slack_that_cannot_be_is_reported(slack: str) -> None:
    told = pursue("solve", FIRST, f"--slack={slack}")
    assert (told.status, told.out) == (2, "")
    assert "the slack is" in told.err


def test_a_slack_for_nobody_is_reported() -> None:
    told = pursue("solve", FIRST, "--slack=bot9=1")
    assert told.status in (2, 3)
    assert "bot9" in told.err


def test_slack_where_the_plan_decides_the_ends_is_reported() -> None:
    told = pursue("solve", FIRST, "--slack", "1", "--ends", "controllable")
    assert told.status == 2
    assert "--ends reported" in told.err


def test_a_network_without_its_query_is_reported(tmp_path: Path) -> None:
    told = pursue("solve", tmp_path / "TGA.xml")
    assert told.status == 2
    assert "its query" in told.err


# verify --------------------------------------------------------------------------------------------------------------


def test_a_plan_that_is_not_whole_does_not_win(tmp_path: Path) -> None:
    plan = pursue("solve", FIRST, "--plan", "-").out
    blocks = plan.split("\nState: ")
    (tmp_path / "plan.txt").write_text("\nState: ".join(blocks[:4]), encoding="utf-8")
    told = pursue("verify", FIRST, tmp_path / "plan.txt")
    assert told.status == 4
    assert told.out.splitlines() == [
        "ends reported, reaction 0.1: the plan does not win",
        "ends controllable, reaction 0: the plan does not win",
    ]
    assert "the play that shows it" in told.err


def test_verify_says_in_which_game_a_plan_wins(tmp_path: Path) -> None:
    file, plan = called(tmp_path, 4), tmp_path / "plan.txt"
    assert pursue("solve", file, "--ends", "controllable", "--reaction", "0", "-o", plan).status == 0
    told = pursue("verify", file, plan)
    assert (told.status, told.out.splitlines()[-1]) == (0, "ends controllable, reaction 0: the plan wins")
    assert pursue("verify", file, plan, "--ends", "reported").status == 4


def test_a_plan_of_another_scenario_is_reported(tmp_path: Path) -> None:
    pursue("solve", FIRST, "-o", tmp_path / "plan.txt")
    told = pursue("verify", THESIS / "scenario_2.pur", tmp_path / "plan.txt")
    assert told.status == 3
    assert f"{tmp_path}/plan.txt:" in told.err


def test_verify_without_a_plan_is_reported() -> None:
    told = pursue("verify", FIRST)
    assert told.status == 2
    assert "plan is missing" in told.err


def test_check_says_that_robots_are_sent_beside_a_given_pose(tmp_path: Path) -> None:
    text = Path(FIRST).read_text(encoding="utf-8").replace('poi "a"', 'poi "a" //[1, 2, 0, 0, 0, 0, 1]', 1)
    file = tmp_path / "placed.pur"
    file.write_text(text, encoding="utf-8")
    told = pursue("check", file, "--spot-distance", "0.5")
    assert told.status == 0
    assert f"{file}: at a bot1 has the pose of the place; beside it: bot2 0.5 m" in told.err
    assert "beside it" not in pursue("check", FIRST).err


# report --------------------------------------------------------------------------------------------------------------


def test_report_has_the_thesis_beside_ours() -> None:
    told = pursue("report", FIRST)
    assert told.status == 0
    assert "controller_bot2" in told.out and "thesis: commands" in told.out
    table = json.loads(pursue("report", FIRST, "--json").out)
    assert table["controllers"][0]["thesis"] == {"commands": 17, "lines": 425}
    by_name = {row["controller"]: row["commands"] for row in table["controllers"]}
    assert by_name["controller_bot1"] + by_name["controller_bot2"] == by_name["Centralized"]


# ws ------------------------------------------------------------------------------------------------------------------


def test_ws_writes_a_workspace_and_says_how_to_go_on(tmp_path: Path) -> None:
    folder = tmp_path / "my work"
    told = pursue("ws", FIRST, "-o", folder)
    assert (told.status, told.out) == (0, f"{folder}\n")
    assert f"cd '{folder}' && catkin_make" in told.err
    assert "rosrun scenario_1_bringup run_mission" in told.err
    packages = {p.name for p in (folder / "src").iterdir()}
    mission = {"UI", "controllerObj", "controller_bot1", "controller_bot2", "observer", "scenario_1_bringup"}
    assert packages == mission | {"communication_manager", "pursue_reader", "pursue_msgs", "pursue_runtime"}
    once = tree(folder)
    assert pursue("ws", FIRST, "-o", folder).status == 0
    assert tree(folder) == once


def test_a_manifest_that_catkin_refuses_is_an_internal_error_and_nothing_is_written(tmp_path: Path) -> None:
    with mock.patch.dict(DEPENDS, {"observer": ("observer",)}):
        told = pursue("ws", FIRST, "-o", tmp_path / "ws")
    assert told.status == 1
    assert "internal error of pursue-gen: InvalidPackage" in told.err and "src/observer/package.xml" in told.err
    assert not (tmp_path / "ws").exists()


def test_ws_does_not_replace_what_a_person_edited(tmp_path: Path) -> None:
    folder = tmp_path / "ws"
    pursue("ws", FIRST, "-o", folder)
    edited = folder / "README.md"
    original = edited.read_text(encoding="utf-8")
    edited.write_text("mine", encoding="utf-8")
    told = pursue("ws", FIRST, "-o", folder)
    assert told.status == 2
    assert "README.md" in told.err and "--force" in told.err
    assert edited.read_text(encoding="utf-8") == "mine"
    assert pursue("ws", FIRST, "-o", folder, "--force").status == 0
    assert edited.read_text(encoding="utf-8") == original


def test_ws_in_another_shape(tmp_path: Path) -> None:
    pursue("ws", FIRST, "-o", tmp_path / "one", "--controllers", "centralized")
    assert (tmp_path / "one" / "src" / "controller").is_dir()
    pursue("ws", FIRST, "-o", tmp_path / "two", "--reach-obj", "bot2")
    assert not (tmp_path / "two" / "src" / "controllerObj").exists()
    told = pursue("ws", FIRST, "-o", tmp_path / "three", "--reach-obj", "bot9")
    assert told.status == 2
    assert not (tmp_path / "three").exists()


def test_a_general_controller_decides_the_ends(tmp_path: Path) -> None:
    told = pursue("ws", FIRST, "-o", tmp_path / "ws", "--controllers", "general")
    assert told.status == 0
    assert "ends: controllable, since" in told.err
    assert "bot1_inbDONE" in (tmp_path / "ws/src/controller/config/strategy.yaml").read_text(encoding="utf-8")


def test_ws_takes_a_plan_that_wins(tmp_path: Path) -> None:
    pursue("solve", FIRST, "-o", tmp_path / "plan.txt")
    told = pursue("ws", FIRST, "-o", tmp_path / "ws", "--plan", tmp_path / "plan.txt")
    assert told.status == 0
    assert "wins: ends reported, reaction 0.1" in told.err
    pursue("ws", FIRST, "-o", tmp_path / "own")
    assert tree(tmp_path / "ws") == tree(tmp_path / "own")


def test_ws_warns_of_a_plan_that_wins_ideally_only(tmp_path: Path) -> None:
    plan = tmp_path / "plan.txt"
    pursue("solve", FIRST, "--ends", "controllable", "--reaction", "0", "-o", plan)
    told = pursue("ws", FIRST, "-o", tmp_path / "ws", "--plan", plan)
    assert told.status == 0
    assert "warning CLI010" in told.err and "ideal game only" in told.err
    asked = pursue("ws", FIRST, "-o", tmp_path / "asked", "--plan", plan, "--ends", "reported")
    assert asked.status == 4
    assert not (tmp_path / "asked").exists()


def test_ws_takes_a_plan_of_tigas(tmp_path: Path, reference_dir: Path) -> None:
    file = tmp_path / "ct1.pur"
    file.write_bytes((reference_dir / "CT1" / "scenario.pur").read_bytes())
    plan = reference_dir / "CT1" / "UPPAAL_plan.txt"
    told = pursue("ws", file, "-o", tmp_path / "ws", "--plan", plan)
    assert told.status == 0, told.err
    assert "ideal game only" in told.err
    assert (tmp_path / "ws" / "src" / "observer").is_dir()


def test_ws_refuses_a_plan_that_does_not_win(tmp_path: Path) -> None:
    blocks = pursue("solve", FIRST, "--plan", "-").out.split("\nState: ")
    (tmp_path / "plan.txt").write_text("\nState: ".join(blocks[:4]), encoding="utf-8")
    told = pursue("ws", FIRST, "-o", tmp_path / "ws", "--plan", tmp_path / "plan.txt")
    assert told.status == 4
    assert not (tmp_path / "ws").exists()


def test_ws_of_a_lost_game_writes_nothing(tmp_path: Path) -> None:
    told = pursue("ws", called(tmp_path, 4), "-o", tmp_path / "ws")
    assert told.status == 4
    assert "only the ideal game" in told.err
    assert not (tmp_path / "ws").exists()


# What README.md shows ------------------------------------------------------------------------------------------------


def test_the_first_own_scenario_of_the_readme(tmp_path: Path) -> None:
    blocks = (ROOT / "README.md").read_text(encoding="utf-8").split("```")
    (text,) = [block for block in blocks if block.startswith('\npoi "door"')]
    example = (ROOT / "scenarios/office/lab_floor.pur").read_text(encoding="utf-8")
    assert text.strip() == example.partition("\n")[2].strip(), "beside its first line, a comment, it is the example"
    file = tmp_path / "lab_floor.pur"
    file.write_text(text, encoding="utf-8")
    assert pursue("check", file).err.startswith("1 file: 0 errors, 0 warnings")
    won = pursue("solve", file)
    assert won.status == 0 and "if order then unload within 45: answered within 31.8 of 45, at worst." in won.err
    file.write_text(text.replace("within 45", "within 30"), encoding="utf-8")
    lost = pursue("solve", file)
    assert lost.status == 4 and "cannot be promised, even if nothing else is" in lost.err
    assert "a deadline of 32 instead of 30 for unload" in lost.err


# --optimize -----------------------------------------------------------------------------------------------------------


def test_the_least_time_is_reported_and_kept(tmp_path: Path) -> None:
    plan = tmp_path / "plan.txt"
    outcome = pursue("solve", FIRST, "--optimize", "time", "--json", "-o", plan)
    found = json.loads(outcome.out)["time"]
    assert found["optimal"] is True
    assert (found["least"], found["most"]) == (23.3, 23.3)
    assert "nothing below 23.3 can be promised" in outcome.err
    assert pursue("verify", FIRST, plan).status == 0


def test_every_command_that_solves_looks_for_the_least_time(tmp_path: Path) -> None:
    told = "nothing below 20 can be promised"
    assert told in pursue("report", FIRST, "--optimize", "time").out
    options = ("--ends", "controllable", "--reaction", "0", "--optimize", "time", "-o", tmp_path / "ws")
    assert told in pursue("ws", FIRST, *options).err


def test_a_strategy_that_is_not_the_fastest_is_not_called_so() -> None:
    outcome = pursue("solve", FIRST, "--ends", "controllable", "--reaction", "0", "--json")
    found = json.loads(outcome.out)["time"]
    assert found["optimal"] is False
    assert found["least"] == 20
    assert "nothing below 20 can be promised" in outcome.err


def test_what_has_no_least_time_is_reported(tmp_path: Path) -> None:
    safety = tmp_path / "box.pur"
    safety.write_text(CALLED.format(deadline=5))
    outcome = pursue("solve", safety, "--optimize", "time")
    assert outcome.status == 2
    assert "no time to the goal" in outcome.err
    assert pursue("solve", FIRST, "--optimize", "time", "--solver", "verifytga").status == 2
