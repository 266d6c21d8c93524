"""Commands that share the options of a request get them as one value."""

from __future__ import annotations

from pathlib import Path
from typing import List

import pytest
import typer
from typer.testing import CliRunner

from pursue_gen.cli.options import MISSION, REQUEST, with_request
from pursue_gen.solving.request import SolveRequest

ALL = (*MISSION, "whole")
AFTER = typer.Option(Path("."))


def requests(*names: str, arguments: str = "", **own: object) -> List[object]:
    """What a command with these options gets for these arguments: its own option, and the request."""
    app, seen = typer.Typer(), []

    @app.command()
    @with_request(*names, **own)
    def command(before: int = 1, request: SolveRequest = REQUEST, after: Path = AFTER) -> None:
        seen.extend((before, request, after))

    done = CliRunner().invoke(app, arguments.split())
    assert done.exit_code == 0, done.output
    return seen


def test_without_arguments_it_is_the_default_request() -> None:
    before, request, after = requests(*ALL)
    assert (before, after) == (1, Path("."))
    assert isinstance(request, SolveRequest) and request.is_default
    assert request.options.limits.memory > 0
    limits = request.options.limits
    assert (limits.seconds, limits.by_default, limits.chosen.seconds) == (60, True, 0)


def test_every_option_arrives_in_the_request() -> None:
    game = "--controllers general --reach-obj all --ends reported --reaction 1/20 --slack 2 --slack bot1=5 --plan p.txt"
    how = "--solver verifytga --verifytga /bin/tiga --optimize time --limit 3 --memory 7"
    _, request, _ = requests(*ALL, arguments=f"{game} {how}")
    assert isinstance(request, SolveRequest) and not request.is_default
    assert (request.controllers, request.reach_obj, request.ends) == ("general", "all", "reported")
    assert (request.reaction, request.slack, request.plan) == ("1/20", ("2", "bot1=5"), Path("p.txt"))
    options = request.options
    assert (options.solver, options.verifytga, options.optimize) == ("verifytga", Path("/bin/tiga"), "time")
    assert (options.limits.seconds, options.limits.memory) == (3, 7)


@pytest.mark.parametrize("name", MISSION)
def test_a_command_has_only_the_options_that_it_names(name: str) -> None:
    flag = f"--{name.replace('_', '-')}"
    with pytest.raises(AssertionError, match="No such option"):
        requests(*(other for other in MISSION if other != name), arguments=f"{flag} 1")


def test_a_command_may_declare_an_option_in_its_own_way() -> None:
    _, request, _ = requests("reaction", reaction=typer.Option("0.5"))
    assert isinstance(request, SolveRequest) and request.reaction == "0.5"


def test_limits_alone_leave_a_request_the_default_one() -> None:
    _, request, _ = requests("limit", "memory", arguments="--limit 5 --memory 9")
    assert isinstance(request, SolveRequest) and request.is_default


@pytest.mark.parametrize(("text", "seconds"), [("none", 0), ("0", 0), ("4", 4), ("0.5", 0.5), ("1e3", 1000)])
def test_a_limit_on_time_is_a_number_of_seconds_or_none(text: str, seconds: float) -> None:
    _, request, _ = requests("limit", "memory", arguments=f"--limit {text}")
    assert isinstance(request, SolveRequest)
    limits = request.options.limits
    assert (limits.seconds, limits.by_default, limits.chosen) == (seconds, False, limits)


@pytest.mark.parametrize("text", ["-1", "nan", "inf", "soon", "1s", ""])
def test_anything_else_is_no_limit_on_time(text: str) -> None:
    app = typer.Typer()

    @app.command()
    @with_request("limit")
    def command(request: SolveRequest = REQUEST) -> None:
        pytest.fail(f"it is taken for {request.options.limits}")

    done = CliRunner().invoke(app, [f"--limit={text}"])
    assert done.exit_code == 2
    assert f"'{text}'" in done.output and "none" in done.output
