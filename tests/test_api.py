"""The Python API: its examples and its page are true, and functions return or raise what they say."""

from __future__ import annotations

import doctest
import io
import os
import pickle
import re
import signal
import subprocess
import sys
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import replace
from pathlib import Path
from threading import Timer
from types import FunctionType
from typing import Any, Dict
from unittest import mock

import pytest

import pursue_gen
from pursue_gen import api
from pursue_gen.api import scenarios, solutions
from pursue_gen.language import scenario as language_scenario
from tests.conftest import ROOT, thesis_scenario
from tests.large_scenarios import many_walkers

PAGE = ROOT / "docs" / "api.md"
FIRST = thesis_scenario("1")


@pytest.fixture(autouse=True)
def in_the_checkout(monkeypatch: pytest.MonkeyPatch) -> None:
    """Examples name scenarios by their paths in the checkout."""
    monkeypatch.chdir(ROOT)


# Examples -------------------------------------------------------------------------------------------------------------

PARTS = (scenarios, solutions)
FLAGS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


def test_the_examples_of_functions_are_true() -> None:
    found = [doctest.testmod(part, extraglobs=vars(api), optionflags=FLAGS) for part in PARTS]
    assert sum(one.attempted for one in found) > 20 and not any(one.failed for one in found)


def test_the_page_is_true(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Blocks of code are run one after the other; a block of text behind one is what it prints."""
    monkeypatch.chdir(tmp_path)
    names: Dict[str, Any] = {}
    printed = io.StringIO()
    blocks = re.findall(r"^```(\w+)\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
    assert len(blocks) > 10
    for kind, text in blocks:
        if kind == "text":
            assert printed.getvalue() == text
            continue
        printed = io.StringIO()
        with redirect_stdout(printed):
            exec(compile(text, str(PAGE), "exec"), names)


def test_the_page_names_every_function() -> None:
    functions = [name for name in api.__all__ if isinstance(getattr(api, name), FunctionType)]
    assert len(functions) > 12
    assert [name for name in functions if f"`{name}" not in PAGE.read_text(encoding="utf-8")] == []


def test_each_function_is_documented() -> None:
    assert all(getattr(api, name).__doc__ for name in api.__all__ if isinstance(getattr(api, name), FunctionType))


# The module -----------------------------------------------------------------------------------------------------------


def test_all_names_are_those_of_the_package() -> None:
    for name in api.__all__:
        assert getattr(pursue_gen, name) is getattr(api, name)
    assert set(api.__all__) <= set(dir(pursue_gen))
    with pytest.raises(AttributeError):
        _ = pursue_gen.dataclass
    with pytest.raises(AttributeError):
        _ = pursue_gen.nothing


def test_importing_the_package_imports_nothing_else_of_it() -> None:
    """Else the command line, and `import pursue_gen.zones`, would wait for all stages."""
    code = "import sys, pursue_gen; from pursue_gen import diagnostics; print(*sys.modules, sep=chr(10))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=str(ROOT))
    assert [name for name in done.stdout.split() if name.startswith("pursue_gen")] == [
        "pursue_gen",
        "pursue_gen.diagnostics",
    ]


def test_scenarios_can_be_built_of_all_values_of_the_language() -> None:
    assert set(language_scenario.__all__) < set(api.__all__)


def test_types_are_there_for_type_checkers() -> None:
    assert (ROOT / "pursue_gen" / "py.typed").is_file()


# Functions ------------------------------------------------------------------------------------------------------------

CALLED = """poi "desk"
poi "shelf"
connect desk and shelf distance 2
event "callBot"
event "fetch" location shelf
agent "bot" controllable mobile 1 location desk can_do fetch
agent "visitor" location desk can_do callBot
objective: if callBot then fetch within {deadline}
"""


def called(deadline: int) -> pursue_gen.Scenario:
    return pursue_gen.parse(CALLED.format(deadline=deadline), "called")


def test_nothing_is_printed() -> None:
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err):
        solved = pursue_gen.solve(called(5))
        pursue_gen.simulate(solved, 10)
        with pytest.raises(pursue_gen.Lost) as lost:
            pursue_gen.solve(called(3))
        pursue_gen.explain(called(3), lost.value)
    assert out.getvalue() == err.getvalue() == ""


def test_what_is_changed_in_python_is_what_is_solved_and_what_robots_get(tmp_path: Path) -> None:
    read = called(5)
    (objective,) = read.safety
    slower = replace(read, safety=(replace(objective, deadline=3),))
    with pytest.raises(pursue_gen.Lost):
        pursue_gen.solve(slower)
    looser = replace(read, safety=(replace(objective, deadline=50),))
    solved = pursue_gen.solve(looser)
    assert "within 50" in solved.scenario.text
    made = pursue_gen.write_workspace(solved, tmp_path / "ws")
    texts = [file.read_text("utf-8", "replace") for file in made.folder.rglob("*") if file.is_file()]
    assert any("if callBot then fetch within 50" in text for text in texts)
    assert not any("if callBot then fetch within 5\n" in text for text in texts)


def test_a_solution_is_shown_in_a_line() -> None:
    assert repr(pursue_gen.solve(called(5))).startswith("<Solved: won: ends reported, reaction 0.1; ")
    assert len(repr(pursue_gen.simulate(pursue_gen.solve(called(5)), 2))) < 1000


def test_a_notebook_shows_the_text_of_a_scenario() -> None:
    printer = mock.Mock()
    called(5)._repr_pretty_(printer, False)
    printer.text.assert_called_once_with(CALLED.format(deadline=5))


def test_ctrl_c_ends_a_search() -> None:
    large = pursue_gen.parse(many_walkers(), "large")
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # who runs the tests may ignore it
    Timer(1, os.kill, (os.getpid(), signal.SIGINT)).start()
    try:
        with pytest.raises(KeyboardInterrupt):
            pursue_gen.solve(large, pursue_gen.request(seconds=300, memory=0, whole=True))
    finally:
        signal.signal(signal.SIGINT, before)


def test_answers_and_verdict_are_those_of_the_command() -> None:
    solved = pursue_gen.solve(called(5))
    (answer,) = solved.answers
    assert answer.worst <= 5
    assert solved.worst_time is None
    words = [sys.executable, "-m", "pursue_gen", "solve", "/dev/stdin", "--json"]
    done = subprocess.run(words, input=CALLED.format(deadline=5), capture_output=True, text=True, check=True)
    assert done.stdout.count('"worst"') == 1
    assert solved.as_json()["answers"][0]["worst"] == float(answer.worst)


def test_errors_carry_findings_with_places() -> None:
    broken = CALLED.format(deadline=5).replace("location shelf", "location attic")
    with pytest.raises(pursue_gen.Invalid) as caught:
        pursue_gen.parse(broken)
    (finding,) = caught.value.diagnostics
    assert (finding.code, finding.severity) == ("PML110", pursue_gen.Severity.ERROR)
    assert finding.span is not None and finding.span.line == 5 and finding.hint
    assert pursue_gen.check(pursue_gen.Scenario("empty"))
    assert pursue_gen.check("nowhere.pur")[0].code == "PML001"
    assert pursue_gen.check(pursue_gen.Scenario("a", pois=(pursue_gen.Poi('"'),)))[0].hint


def test_limits_end_what_is_solved() -> None:
    for limits in ({"seconds": 1e-6}, {"memory": 1}):
        with pytest.raises(pursue_gen.LimitHit):
            pursue_gen.solve(called(5), pursue_gen.request(**limits))
    large = pursue_gen.read("scenarios/drug_delivery/drug_delivery.pur")
    with pytest.raises(pursue_gen.LimitHit):
        pursue_gen.solve(large, pursue_gen.request(work=10, seconds=0, whole=True))


@pytest.mark.parametrize(
    "options",
    [{"ends": "never"}, {"optimize": "all"}, {"controllers": "two"}, {"solver": "mine"}, {"seconds": -1},
     {"memory": float("inf")}, {"work": float("nan")}],
)  # fmt: skip
def test_a_request_without_a_meaning_is_an_error(options: Dict[str, Any]) -> None:
    with pytest.raises(pursue_gen.PursueError):
        pursue_gen.request(**options)


@pytest.mark.parametrize("options", [{"reaction": -1}, {"slack": {"nobody": 1}}, {"within": "soon"}])
def test_so_is_one_that_has_none_for_a_scenario(options: Dict[str, Any]) -> None:
    with pytest.raises(pursue_gen.PursueError):
        pursue_gen.solve(called(5), pursue_gen.request(**options))


def test_values_go_from_one_process_to_another() -> None:
    solved = pursue_gen.solve(called(5))
    again = pickle.loads(pickle.dumps(solved))
    assert again.scenario == solved.scenario and again.plan == solved.plan
    with pytest.raises(pursue_gen.Lost) as lost:
        pursue_gen.solve(called(3))
    assert str(pickle.loads(pickle.dumps(lost.value))) == str(lost.value)


def test_periods_that_nobody_named_are_found() -> None:
    rooms = 'poi "a" poi "b" connect a and b distance 2 agent "bot" controllable mobile 1 location a'
    patrol = pursue_gen.parse(f"{rooms} objective: patrol a, b by bot")
    solved = pursue_gen.solve(patrol)
    assert "least period" in pursue_gen.promises_of(solved.scenario)[0]
    assert pursue_gen.solve(solved.scenario).scenario.safety == solved.scenario.safety


def test_a_scenario_without_periods_is_explained_and_written_for_uppaal() -> None:
    """Its periods are found first: there is no game before."""
    rooms = 'poi "a" poi "b" connect a and b distance 2 agent "bot" controllable mobile 1 location a'
    guest = 'event "come" location b agent "guest" mobile 1 location b can_do come'
    lost = pursue_gen.parse(f"{rooms} {guest} objective: patrol a, b by bot objective: avoid come")
    with pytest.raises(pursue_gen.Lost) as problem:
        pursue_gen.solve(lost)
    assert pursue_gen.explain(lost, problem.value).text
    assert "control" in pursue_gen.as_uppaal(lost)[1]


def test_a_game_of_uppaal_is_solved_and_verified(tmp_path: Path) -> None:
    from pursue_gen.tga.uppaal import write_network, write_query

    network, objective = pursue_gen.game(called(5))
    model, query, plan = (tmp_path / name for name in ("TGA.xml", "TCTL.q", "plan.txt"))
    model.write_text(write_network(network, objective))
    query.write_text(write_query(objective))
    read = pursue_gen.read_game(model, query)
    plan.write_text(pursue_gen.solve_game(read).plan)
    assert [trial.outcome for trial in pursue_gen.verify_game(read, plan)] == ["the plan wins"]
