"""Strategies without moves that no promise needs: proven like any other, and at rest while nothing is owed."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import List, Tuple

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from benchmarks.lab_scenarios import Size, lab_scenario
from pursue_gen.language import load, parse
from pursue_gen.language.network_names import AT_RISK
from pursue_gen.language.scenario import Patrol, Respond, Scenario
from pursue_gen.language.symbols import Role, role_of
from pursue_gen.outcomes import LimitHit, Lost, NotProven
from pursue_gen.proof.checker import verify
from pursue_gen.solving.answers import answers
from pursue_gen.solving.calm import calm
from pursue_gen.solving.due_moves import duties, only_due, patrols
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.shares import won_in_shares
from pursue_gen.solving.solution import Solution, solution
from pursue_gen.solving.solvers import solved
from pursue_gen.synthesis.limits import Limits
from pursue_gen.synthesis.strategy import with_automata_of
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tools.simulation.mission import SimulatedMission
from pursue_gen.tools.simulation.outcome import SAFE
from pursue_gen.tools.simulation.runs import MissionRunner, make_case
from pursue_runtime.state import SystemState
from tests.patrols import game_of

SCENARIOS = Path(__file__).parents[2] / "scenarios"

ROUNDS = """
poi "hall"
poi "east"
poi "west"
poi "attic"
connect hall and east distance 3
connect hall and west distance 3
connect west and attic distance 4
agent "guard" controllable mobile 1 location hall
objective: patrol east, west, attic every 100 by guard
"""

ERRAND = """
poi "dock"
poi "shelf"
connect dock and shelf distance 4
event "ring"
event "bring" location shelf duration 2
agent "porter" controllable mobile 1 location dock can_do bring
agent "guest" location dock can_do ring
objective: if ring then bring within 40
"""

LITTLE = Limits(seconds=10, states=3_000)
"""What is not decided with that is no example."""

NEAR = """
poi "gate"
poi "yard"
poi "house"
connect gate and yard distance 2
connect yard and house distance 3
agent "dog" controllable mobile 1 location house
agent "thief" mobile 4 location gate
objective: always not thief at yard or dog at yard
"""


def won(text: str, quiet: bool = True) -> Tuple[Scenario, Solution]:
    """The scenario and its solution; `quiet`: without moves that no promise needs."""
    scenario = parse(text, "calm.pur", "calm")
    how = SolveOptions(optimize=None if quiet else "none")
    return scenario, solved(translate(scenario), scenario_objective(scenario), DEFAULT, how)


class Watched(SimulatedMission):
    """A mission that notes when robots set off: the state before, and the agent."""

    def publish(self, state: SystemState) -> None:
        before = self._latched
        super().publish(state)
        if before is not None:
            for name, place in state.locations.items():
                if role_of(place) is Role.WAY and role_of(before.locations[name]) is not Role.WAY:
                    self.departures.append((before, name))

    departures: List[Tuple[SystemState, str]]


def departures(scenario: Scenario, some: Solution, seed: int = 1) -> List[Tuple[SystemState, str]]:
    """When robots set off in a mission in which the others stand still."""
    case, _ = make_case(scenario, some, SolveRequest(), "still", (), 400.0)
    mission = Watched(MissionRunner(case).stage, case.settings, seed, None)
    mission.departures = []
    assert mission.run().end == SAFE
    return mission.departures


def test_a_patrol_makes_a_round_when_it_is_due_and_waits_in_between() -> None:
    some = len(departures(*won(ROUNDS)))
    # From the attic to the east and back there are six ways. Each of the two has to be seen within 100 after it was
    # left, so this takes 170 at most if the guard waits at both, and at the start it is in the hall: 15 ways in 400.
    assert 15 <= some <= 1.2 * 15
    assert len(departures(*won(ROUNDS, quiet=False))) > 4 * some


BOTH_ENDS = """
poi "hall"
poi "east"
poi "west"
connect hall and east distance 3
connect hall and west distance 3
agent "guard" controllable mobile 1 location hall
objective: patrol east, west every 30 by guard
"""

RELIEVED = """
poi "gate"
poi "hall"
poi "east"
poi "west"
connect gate and hall distance 2
connect hall and east distance 3
connect hall and west distance 3
agent "guard" controllable mobile 1 location gate
agent "porter" controllable mobile 1 location east
objective: always any robot at gate
objective: patrol east, west every 40 by guard
"""
"""The guard can leave the gate once the porter is there."""


def test_two_places_that_are_due_at_once_make_nobody_go_round_more_often_than_it_takes() -> None:
    some = len(departures(*won(BOTH_ENDS)))
    # From one end to the other it takes 10 at worst: it may leave one 20 after it left the other one, each time by two
    # ways.
    assert some <= 1.2 * 2 * 400 / 20


def test_a_patrol_waits_whose_robot_is_relieved_by_another() -> None:
    driving = departures(*won(RELIEVED))
    assert sum(name == "porter" for _, name in driving) == 2
    assert len(driving) <= 2 + 1.2 * 2 * 400 / 30


def test_who_waits_with_a_patrol_goes_to_a_call_at_once() -> None:
    text = BOTH_ENDS.replace("every 30", "every 90").replace("location hall", "location hall can_do help")
    text = text.replace("agent", 'event "call"\nevent "help" location hall duration 1\nagent', 1)
    text += 'agent "guest" location hall can_do call\nobjective: if call then help within 85\n'
    scenario, some = won(text)
    assert len(departures(scenario, some)) <= 1.2 * 2 * 400 / 80
    (late,) = (answer.worst for answer in answers(scenario, some) if isinstance(answer.promise, Respond))
    # Where it has set off it goes to both ends first: of 85 it would take most if calls came after what is put off.
    assert late <= 30


def test_a_patrol_waits_which_others_may_begin_as_well() -> None:
    """In a share where the porter is hidden, as whatever he does."""
    text = BOTH_ENDS.replace("every 30 by guard", "every 60 by any robot").replace("agent", """poi "far"
connect west and far distance 9
event "call"
event "help" location far duration 1
agent "porter" controllable mobile 1 location far can_do help
agent""", 1)
    text += 'agent "guest" location hall can_do call\nobjective: if call then help within 20\n'
    network, objective = game_of(text)
    found = won_in_shares(network, objective, DEFAULT.reaction, SolveOptions())
    assert found is not None
    some = Solution(network, objective, found.strategy, DEFAULT.reaction)
    watched = replace(some, network=with_automata_of(network, found.strategy))
    driving = departures(parse(text, "calm.pur"), calm(watched, SolveOptions()))
    assert len(driving) <= 1.2 * 2 * 400 / 50


def test_every_move_of_a_patrol_leads_nearer_to_a_place_that_is_due() -> None:
    network, objective = translate(parse(ROUNDS, "calm.pur")), scenario_objective(parse(ROUNDS, "calm.pur"))
    visited = patrols(network)
    assert [(duty.deadline, duty.visits) for duty in duties(network, objective, visited)] == [
        (100, {"guard": (place,)}) for place in ("east", "west", "attic")
    ]
    due = only_due(network, objective, visited, Fraction(1, 10))
    assert due is not None
    ways = {
        (edge.source, edge.target, bound.bound)
        for edge in due.network.automaton("guard").edges
        for bound in edge.guard.clocks
        if bound.clock.startswith("Cobj")
    }
    leg, attic = 1 + 4, 1 + 5  # a rest, and the latest arrival
    assert ways == {
        ("hall", "going_hall_to_east", 90 - leg),
        ("west", "going_west_to_hall", 90 - 2 * leg),
        ("attic", "going_attic_to_west", 90 - 2 * leg - attic),
        ("attic", "going_attic_to_west", 90 - attic),
        ("hall", "going_hall_to_west", 90 - leg),
        ("east", "going_east_to_hall", 90 - 2 * leg),
        ("east", "going_east_to_hall", 90 - 2 * leg - attic),
        ("hall", "going_hall_to_west", 90 - leg - attic),
        ("west", "going_west_to_attic", 90 - attic),
    }


def test_who_is_never_called_stays_where_he_is() -> None:
    assert departures(*won(ERRAND)) == []


def test_who_has_to_be_there_first_goes_though_nothing_is_owed_yet() -> None:
    _, some = won(NEAR)
    assert any(block.commands for block in some.strategy.blocks)
    assert verify(some.network, some.objective, some.strategy, some.reaction).ok


def idle_commands(some: Solution) -> int:
    """How many commands are given while no deadline is running."""
    blocks = [
        block
        for block in some.strategy.blocks
        if not any(place == AT_RISK for _, place in block.state.locations)
    ]
    return sum(len(block.commands) for block in blocks)


def test_commands_that_are_given_while_nothing_is_owed_are_left_out() -> None:
    scenario = load(SCENARIOS / "airport" / "luggage.pur")
    first = solution(translate(scenario), scenario_objective(scenario), DEFAULT)
    quiet = calm(first, SolveOptions())
    # The loader still goes to the gate of the next bag before that comes out.
    assert idle_commands(quiet) <= idle_commands(first) - 5
    assert verify(quiet.network, quiet.objective, quiet.strategy, quiet.reaction).ok


@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much])
@given(st.integers(0, 10_000))
def test_random_scenarios_are_won_as_before_and_nobody_moves_without_a_duty(seed: int) -> None:
    scenario = parse(lab_scenario(seed, Size(places=5, robots=2, people=1, promises=2)), "lab.pur")
    network, objective = translate(scenario), scenario_objective(scenario)
    try:
        first = solution(network, objective, DEFAULT, SolveOptions(LITTLE))
    except (Lost, LimitHit, NotProven):
        return
    quiet = calm(first, SolveOptions())
    assert verify(quiet.network, quiet.objective, quiet.strategy, quiet.reaction, 100_000).ok
    assert idle_commands(quiet) <= idle_commands(first)
    if all(isinstance(each, (Respond, Patrol)) for each in scenario.safety):
        for before, name in departures(scenario, quiet):
            owed = [who for who, place in before.locations.items() if place == AT_RISK]
            assert owed, f"{name} sets off while nothing is owed"
