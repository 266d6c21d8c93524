"""Agents of whom it is not known at first where they start, at run time: somebody says it, and the mission goes on."""

from __future__ import annotations

from typing import Any, Dict

from pursue_gen.solving.rules import DEFAULT, played
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.workspace.model_file import model_data
from pursue_runtime.data import NEWEST
from pursue_runtime.locations import SOMEWHERE, is_action, is_under_way
from pursue_runtime.model import Model
from pursue_runtime.observer.mission import Mission
from pursue_runtime.simulator.simulator import Delays, Simulator
from pursue_runtime.ui.environment import RandomEnvironment
from pursue_runtime.ui.mission_view import possible_words
from pursue_runtime.vocabulary import place, sentence
from tests.runtime.models import everywhere
from tests.tga.networks import scenario

HALL = """
poi "hall"
poi "desk"
connect hall and desk distance 3
event "fetch" location hall duration 3
agent "bot" controllable mobile 1 location hall can_do fetch
agent "gerda" label "Gerda" mobile 2 location desk or hall
reach_objective: do fetch
"""
WORDS = ["gerda_starts_at_desk", "gerda_starts_at_hall"]


def data() -> Dict[str, Any]:
    story = scenario(HALL)
    network = played(translate(story), DEFAULT)
    return model_data(network, scenario_objective(story), story, DEFAULT.reaction)


MODEL = Model(data())


def test_an_older_run_time_refuses_it() -> None:
    assert data()["format"] == 6 <= NEWEST["model.yaml"]


def begun() -> Mission:
    mission = Mission(MODEL, everywhere(MODEL), lambda *_: None, on_uncovered="warn")
    mission.on_word("_start_", 100.0)
    return mission


def test_it_is_no_place_and_no_action() -> None:
    assert is_under_way(SOMEWHERE) and not is_action(SOMEWHERE)
    assert MODEL.initial().locations["gerda"] == SOMEWHERE
    assert place(MODEL, MODEL.automaton("gerda"), SOMEWHERE) == "at a place that nobody has said yet"


def test_from_the_word_on_everybody_knows_it() -> None:
    mission = begun()
    before = mission.state(100.2)
    offered = possible_words(MODEL, before, before.clocks_at(100.2))
    assert sorted(offer.word for offer in offered) == WORDS
    (after,) = mission.on_word(WORDS[0], 100.3)
    assert (after.locations["gerda"], after.values["Pgerda"], after.clocks["Cgerda"]) == ("desk", 2, 0.0)
    assert sentence(MODEL, after, before) == "Gerda starts at desk"
    assert mission.on_word(WORDS[1], 100.4) == []


def test_a_word_that_is_late_counts() -> None:
    mission = begun()
    mission.on_time(102.0)
    (after,) = [state for state in mission.on_word(WORDS[1], 105.0) if state.event == WORDS[1]]
    assert after.locations["gerda"] == "hall" and after.status in ("running", "holding")


def test_the_simulator_says_it_the_same_for_the_same_seed() -> None:
    def said(seed: int) -> str:
        world = Simulator(MODEL, ["gerda"], Delays("random", seed))
        world.on_state(begun().state(100.0), 0.0)
        (word,) = world.due(101.0, 0.0)
        return word.partition("#")[0]

    assert {said(seed) for seed in range(12)} == set(WORDS)
    assert [said(seed) for seed in range(4)] == [said(seed) for seed in range(4)]


def test_who_plays_the_others_leaves_it_to_the_simulator() -> None:
    environment = RandomEnvironment(MODEL, 1, 1.0)
    environment.on_state(begun().state(100.0), 100.0, 100.0)
    assert environment.next_moment() is None
