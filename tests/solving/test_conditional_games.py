"""`only_if` in the game: won and lost because of it, in simulation, with faults, explained."""

from __future__ import annotations

import pytest

from pursue_gen.explanation.explain import explain
from pursue_gen.language import parse
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.tools.simulation.mission import simulate_mission
from pursue_gen.tools.simulation.outcome import GOAL, HELD, SAFE, Settings
from pursue_gen.tools.simulation.promises import Promises
from pursue_gen.tools.simulation.stage import stage_of
from pursue_gen.workspace import Options
from pursue_runtime.observer.mission import Mission
from pursue_runtime.state import STOPPED, SystemState
from tests.solving.verdicts import SCENARIOS, is_won

STATUE = (SCENARIOS / "museum" / "guarded_statue.pur").read_text(encoding="utf-8")
DOOR = (SCENARIOS / "hotel" / "staff_door.pur").read_text(encoding="utf-8")

# Nobody gets in while the warden inspects the gate, nor when it is shut.
GATE = """\
poi "street"
poi "entrance"
poi "gallery"
connect street and entrance distance 9
connect entrance and gallery distance 2 only_if no robot doing inspect and gate is_true
event "inspect" location entrance duration 2
event "shut" location entrance
event "steal" location gallery
rule "order": inspect before shut
state "gate": initially true, false_if shut
agent "warden" controllable location entrance can_do inspect, shut
agent "burglar" mobile 1 location street can_do steal
objective: avoid steal
"""


KITCHEN = """\
poi "desk"
poi "office"
poi "kitchen"
connect desk and office distance 1
connect desk and kitchen distance 2 only_if clerk at desk
event "fetch" location kitchen
agent "waiter" controllable mobile 1 location desk can_do fetch
agent "clerk" mobile 2 location office
reach_objective: do fetch
"""
EARLY = """\
poi "a"
poi "b"
poi "c"
connect a and b distance 9
connect a and c distance 1
event "work" location c duration 2
agent "bot" controllable mobile 1 location a can_do work
agent "visitor" mobile 1 location b
objective: avoid any robot at a and visitor at a
reach_objective: do work after 3
"""
SHIFT = (SCENARIOS / "museum" / "night_shift.pur").read_text(encoding="utf-8")
CORRIDOR = (SCENARIOS / "hotel" / "quiet_corridor.pur").read_text(encoding="utf-8")


MEETING = "avoid any robot at corridor and guest at corridor"


BUSY = " only_if no robot doing inspect"


@pytest.mark.parametrize(
    ("text", "condition", "won", "without", "engine"),
    [
        (STATUE, " only_if no robot at statue", True, False, "native"),
        (DOOR, " only_if clerk at desk", False, True, "native"),
        (GATE, BUSY + " and gate is_true", True, False, "native"),
        (GATE, BUSY + " and gate is_true", True, False, "python"),
        (GATE.replace(" and gate is_true", ""), BUSY, False, False, "native"),
    ],
    ids=["statue", "door", "gate", "gate in Python", "gate without its state"],
)
def test_what_the_condition_decides(text: str, condition: str, won: bool, without: bool, engine: str) -> None:
    assert condition in text
    assert (is_won(text, engine), is_won(text.replace(condition, ""), engine)) == (won, without)


@pytest.mark.parametrize(
    ("text", "old", "new", "won", "then"),
    [
        (SHIFT, "any robot at gallery", "first at gallery", True, False),
        (CORRIDOR, MEETING, "bot never_with guest at stairs", False, True),
        (CORRIDOR, MEETING, "bot never_with guest at corridor", False, False),
    ],
    ids=["shift", "corridor", "never_with"],
)
def test_what_the_objective_decides(text: str, old: str, new: str, won: bool, then: bool) -> None:
    assert old in text
    assert (is_won(text, "native"), is_won(text.replace(old, new), "native")) == (won, then)


def test_a_lost_objective_is_told_with_its_condition() -> None:
    explanation = explain(parse(CORRIDOR, "x.pur", "x"), DEFAULT)
    assert "any robot is at corridor and guest is at corridor, which must never be" in str(explanation)


def test_the_observer_ends_a_mission_whose_condition_is_broken() -> None:
    """The visitor is back sooner than the model allows, while the robot is still there: the mission is lost."""
    read = parse(EARLY, "x.pur", "x")
    stage = stage_of(read, solve_scenario(read, DEFAULT), Options())
    promises = Promises(read, exact=False)
    mission = Mission(stage.model, stage.cover, lambda level, text: None)
    states: "list[tuple[SystemState, float]]" = []
    for now, word in ((0.0, "_start_"), (1.3, "visitor_b2a"), (1.4, "visitor_going_b_to_a2a")):
        states += [(state, now) for state in mission.on_word(word, now)]
    for state, now in states:
        promises.on_state(state, now)
    last, _ = states[-1]
    assert (last.status, last.locations["obj"]) == ("lost", "lose")
    assert promises.problems == []


def test_what_the_condition_means_is_known() -> None:
    read = parse(EARLY, "x.pur", "x")
    stage = stage_of(read, solve_scenario(read, DEFAULT), Options())
    at = {automaton.name: automaton.initial for automaton in stage.model.automata}
    first = SystemState(1, 0.0, at, dict(stage.model.variables), dict.fromkeys(stage.model.clocks, 0.0))

    def problems(*places: "dict[str, str]") -> str:
        promises = Promises(read, exact=False)
        for number, place in enumerate(places, start=1):
            promises.on_state(first._replace(seq=number, locations={**at, **place}), 0.0)
        return " ".join(promises.problems)

    assert "does not count as lost" in problems({}, {"visitor": "a"}, {"visitor": "a"})
    assert "counts as lost, but" in problems({}, {"obj": "lose"})
    fine = problems({}, {"visitor": "a"}, {"visitor": "a", "obj": "lose"})
    assert "lost" not in fine


def test_the_explanation_names_the_condition() -> None:
    read = parse(KITCHEN, "x.pur", "x")
    explanation = explain(read, DEFAULT)
    labels = [change.sentence for change in explanation.changes]
    assert "the way between desk and kitchen without only_if clerk at desk" in " ".join(labels)


@pytest.mark.parametrize("text", [STATUE, GATE, SHIFT], ids=["statue", "gate", "shift"])
def test_missions_with_random_opponents_end_well(text: str) -> None:
    """The judge takes each step for wrong that is not one of the network, and each command that is not held."""
    read = parse(text, "x.pur", "x")
    stage = stage_of(read, solve_scenario(read, DEFAULT), Options())
    outcomes = [simulate_mission(stage, Settings("random"), seed) for seed in range(30)]
    assert {outcome.end for outcome in outcomes} <= {GOAL, SAFE}, [outcome.reason for outcome in outcomes]


@pytest.mark.parametrize("kinds", [("delay", "loss", "orders"), ("late", "early")], ids="-".join)
def test_with_faults_missions_reach_the_goal_or_stop_safely(kinds: "tuple[str, ...]") -> None:
    read = parse(STATUE, "x.pur", "x")
    stage = stage_of(read, solve_scenario(read, DEFAULT), Options())
    seeds = {*range(13)} - {4}  # its planner takes seven seconds
    outcomes = [simulate_mission(stage, Settings("random", kinds), seed) for seed in sorted(seeds)]
    assert {outcome.end for outcome in outcomes} <= {GOAL, HELD, STOPPED}, [o.reason for o in outcomes]
