"""What is not promised, in a workspace: its data name it, and whatever works with them leaves it out."""

from __future__ import annotations

import functools
from pathlib import Path
from typing import Any, Dict

import pytest
import yaml

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import load, parse
from pursue_gen.solving.optional import Promised, promised_of
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import guaranteed
from pursue_gen.tools.play.session import opening, session_of
from pursue_gen.tools.replanning import replan
from pursue_gen.tools.replay.game import Source, from_data, game_of
from pursue_gen.workspace import Options, generate
from pursue_gen.workspace.make import options_for
from pursue_runtime.model import Model
from pursue_runtime.state import SystemState
from pursue_runtime.ui.page import FloorPlan, Page

ERRANDS = Path(__file__).resolve().parents[2] / "scenarios/office/errands.pur"
REST = "do water within 24"


@functools.lru_cache(maxsize=None)
def found() -> Promised:
    return promised_of(load(ERRANDS), SolveRequest())


@functools.lru_cache(maxsize=None)
def files() -> Dict[str, bytes]:
    won = found().solution
    return generate(found().scenario, won.network, won.objective, won.strategy, Options())


def data(name: str) -> Dict[str, Any]:
    read: Dict[str, Any] = yaml.safe_load(files()[f"src/observer/config/{name}.yaml"])
    return read


def test_the_numbers_that_are_given_up_stand_beside_the_whole_scenario() -> None:
    game = data("game")
    assert game["given_up"] == [2]
    assert game["scenario"] == ERRANDS.read_text(encoding="utf-8")


def test_the_model_holds_what_is_promised_and_names_the_rest() -> None:
    model = Model(data("model"))
    assert model.goal == (("reachObj", "win"), ("reachObj2", "win"))
    assert model.given_up == (REST,)
    start = SystemState(1, 0.0, dict(model.initial().locations), {}, {}, "_start_", "", "running")
    (note,) = Page(model, FloorPlan({}, ())).on_state(start, 0.0)
    assert note["text"] == f"the mission starts; it does not promise: {REST}"


def test_the_readme_says_what_is_given_up() -> None:
    assert f"had to be given up: `{REST}`." in files()["README.md"].decode()


def test_a_new_plan_is_one_for_what_is_promised() -> None:
    model = Model(data("model"))
    start = model.initial()
    request = {
        "format": 1, "game": data("game"), "locations": start.locations, "values": start.values,
        "clocks": start.clocks, "ahead": 0.0, "excused": [],
    }  # fmt: skip
    assert replan(request)["won"]
    more = dict(data("game"))
    del more["given_up"]
    assert not replan({**request, "game": more, "locations": {**start.locations, "reachObj3": "initial_location"},
                       "clocks": {**start.clocks, "Creach3": 0.0}})["won"]  # fmt: skip


@pytest.mark.parametrize("numbers", [[3], "1", {"2": 1}, [None]])
def test_a_request_with_other_numbers_is_refused(numbers: object) -> None:
    request = {"format": 1, "game": {**data("game"), "given_up": numbers}, "locations": {}, "values": {}, "clocks": {}}
    with pytest.raises(PursueError) as problem:
        replan({**request, "ahead": 0.0, "excused": []})
    assert problem.value.exit_status == 2 and "given_up" in str(problem.value)


def test_a_recording_is_checked_against_what_was_promised() -> None:
    from_workspace = game_of(from_data(data("game"), "game.yaml"))
    from_scenario = game_of(Source("errands", ERRANDS.read_text(encoding="utf-8"), "errands.pur", Rules()))
    for game in (from_workspace, from_scenario):
        assert game.objective == found().solution.objective
        assert game.orders is not None, game.why_not


def test_play_says_what_is_promised() -> None:
    lines = opening(session_of(load(ERRANDS), Rules()))
    assert "  (optional 1 is promised: do fetch within 24.)" in lines
    assert f"  (optional 2 is given up, it cannot be promised together with the rest: {REST}.)" in lines


def test_where_nothing_is_promised_a_person_plays_the_robots_of_what_has_to_be() -> None:
    text = ERRANDS.read_text(encoding="utf-8").replace("mail within 16", "mail within 3")
    session = session_of(parse(text, "x.pur", "x"), Rules())
    assert session.setup.scenario.optional == ()
    assert "The robots cannot be sure of it." in opening(session)


def test_the_page_says_what_is_promised_and_what_is_not_and_the_time_that_it_takes_at_worst() -> None:
    won = found().solution
    options = options_for(SolveRequest(), won)
    assert options.guarantee is not None and options.guarantee == guaranteed(won).worst
    written = generate(found().scenario, won.network, won.objective, won.strategy, options)
    settings = yaml.safe_load(written["src/UI/config/ui.yaml"])
    assert settings["guarantee"] == pytest.approx(float(options.guarantee))
    says = {each["says"]: each["of"] for each in settings["objectives"]}
    assert list(says.values()) == [["reachObj"], ["reachObj2"], []]
    assert list(says)[2].startswith("Optional 2: water happens within 24")
