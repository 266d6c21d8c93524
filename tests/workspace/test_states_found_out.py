"""What a workspace says of states that are not known at first."""

from __future__ import annotations

from pathlib import Path
from typing import Dict

from pursue_gen.language import load
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.workspace import Options, generate
from pursue_runtime.data import parse_data

SEARCH = Path(__file__).resolve().parents[2] / "scenarios" / "warehouse" / "which_shelf.pur"


def made() -> Dict[str, bytes]:
    scenario = load(SEARCH)
    won = solve_scenario(scenario, DEFAULT)
    return dict(generate(scenario, won.network, won.objective, won.strategy, Options(reaction=DEFAULT.reaction)))


def test_the_world_says_what_they_are() -> None:
    files = made()
    model = parse_data(files["src/observer/config/model.yaml"], "model.yaml")
    fact = next(each for each in model["automata"] if each["name"] == "onA")
    assert (model["format"], fact["kind"], fact["initial"]) == (5, "agent", "unknown")
    settings = parse_data(files["src/UI/config/ui.yaml"], "ui.yaml")
    assert settings["reports"] == ["bot", "onA"]
    shown = next(each for each in settings["statuses"] if each["of"] == "SonA")
    assert shown["texts"] == {"0": "false", "1": "true", "2": "unknown"}


def test_the_readme_says_which_words_to_publish() -> None:
    readme = made()["README.md"].decode()
    assert "So is what onA is, once it has been shown: `onA_is_true` or `onA_is_false`." in readme
