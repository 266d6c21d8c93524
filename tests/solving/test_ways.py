"""Statements on ways and times in the game: won and lost because of them, by both engines, and in simulation."""

from __future__ import annotations

import pytest

from pursue_gen.language import parse
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.tools.report.recording import simulated
from pursue_gen.tools.simulation.mission import simulate_mission
from pursue_gen.tools.simulation.outcome import GOAL, SAFE, Settings
from pursue_gen.tools.simulation.runs import case_of
from pursue_gen.tools.simulation.stage import stage_of
from pursue_gen.workspace import Options
from tests.solving.verdicts import is_won, text

TRAVEL = "travel visitor from gallery to hall takes 12 to 20\n"


@pytest.mark.parametrize("engine", ["native", "python"])
@pytest.mark.parametrize(
    ("name", "words", "instead", "won"),
    [
        ("museum/one_way_tour", " one_way", "", True),
        ("airport/roundabout", " one_way", "", False),
        ("museum/slow_visitor", TRAVEL, "", True),
        ("hotel/early_breakfast", " to 9", "", False),
        ("hotel/one_call", " at_most 1 times", "", True),
        ("museum/extinguisher", " at_most 2 times", "", False),
        ("hotel/laundry", " for each robot", "", True),
        ("airport/own_load", " for each robot", "", False),
        ("airport/turnaround", "fuel and load", "fuel before load", True),
        ("hotel/room_service", "takeTowels and takeSoap", "takeTowels or takeSoap", False),
    ],
)
def test_what_the_words_decide(name: str, words: str, instead: str, won: bool, engine: str) -> None:
    assert words in text(name)
    assert (is_won(text(name), engine), is_won(text(name).replace(words, instead), engine)) == (won, not won)


WON = [
    text("museum/one_way_tour"),
    text("airport/roundabout").replace("within 14", "within 20"),
    text("museum/slow_visitor").replace("duration 2", "duration 1 to 4"),
    text("hotel/early_breakfast").replace("within 17", "within 20"),
    text("airport/turnaround"),
    text("hotel/laundry"),
    text("airport/own_load").replace("within 6", "within 9"),
    text("hotel/one_call"),
    text("museum/extinguisher").replace('"fire"', '"fire" at_most 2 times'),
    text("hotel/room_service").replace("within 22", "within 24"),
]


@pytest.mark.parametrize("source", WON, ids=range(len(WON)))
def test_missions_with_random_opponents_end_well(source: str) -> None:
    """The judge takes each step for wrong that is not one of the network, and each command that is not held."""
    read = parse(source, "x.pur", "x")
    stage = stage_of(read, solve_scenario(read, DEFAULT), Options())
    settings = Settings("random", until=200.0)  # so long are missions that have no goal
    outcomes = [simulate_mission(stage, settings, seed) for seed in range(15)]
    assert {outcome.end for outcome in outcomes} <= {GOAL, SAFE}, [outcome.reason for outcome in outcomes]


def test_ends_are_drawn_from_the_whole_window() -> None:
    read = parse(WON[3], "x.pur", "x")
    case, _ = case_of(read, solve_scenario(read, DEFAULT), Options(), Settings("random"))
    stage = stage_of(read, case.won, Options())
    lasted = []
    for seed in range(8):
        begun = 0.0
        for step in simulated(case, seed, stage).steps:
            begun = step.at if step.event == "boil" else begun
            lasted += [step.at - begun] if step.event == "boilDONE" else []
    assert 4 < min(lasted) < 5 and 8 < max(lasted) < 9.5


def test_who_has_loaded_unloads() -> None:
    """In recorded missions each unload is of the cart that loaded last before it and has not unloaded since."""
    read = parse(text("airport/own_load").replace("within 6", "within 9"), "x.pur", "x")
    case, _ = case_of(read, solve_scenario(read, DEFAULT), Options(), Settings("random"))
    stage = stage_of(read, case.won, Options())
    for seed in range(5):
        loaded = set()
        for step in simulated(case, seed, stage).steps:
            if step.event == "load":
                assert step.agent not in loaded
                loaded.add(step.agent)
            elif step.event == "unload":
                loaded.remove(step.agent)
