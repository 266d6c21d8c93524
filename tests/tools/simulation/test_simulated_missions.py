"""What the solver has won is won by the generated code, whatever robots, agents and messages do within the promises;
and where a fault breaks these, the mission stops or holds, and no robot gets a wrong command."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest
from stages import SCENARIOS, THESIS, THIEF, margin, missions, remaining, sabotaged, solved, stage

from pursue_gen.language import load
from pursue_gen.proof.worst_case import worst_case
from pursue_gen.solving.solution import Rules, solve_scenario
from pursue_gen.tools.simulation.faults import FAULTS, HARMLESS
from pursue_gen.tools.simulation.mission import LOST, STOPPED, simulate_mission
from pursue_gen.tools.simulation.opponents import kind_in_mission
from pursue_gen.tools.simulation.outcome import FAILED, GOAL, HELD, SAFE, Settings
from pursue_gen.tools.simulation.remaining import Remaining
from pursue_gen.tools.simulation.stage import stage_of
from pursue_gen.workspace import Options


@pytest.mark.parametrize("name", [f"thesis/{name}" for name in THESIS])
def test_without_faults_every_mission_reaches_the_goal_in_time(name: str) -> None:
    outcomes = missions(name, 120, Settings("mixed"))
    assert {outcome.end for outcome in outcomes} == {GOAL}, [o.reason for o in outcomes if o.end != GOAL][:3]
    assert {outcome.opponent for outcome in outcomes} == {"random", "worst", "still"}
    assert len({outcome.time for outcome in outcomes}) > 60
    assert not any(outcome.off_model or outcome.happened for outcome in outcomes)


@pytest.mark.parametrize(
    ("rules", "options"),
    [
        (Rules(), Options(controllers="centralized", reach_obj="all")),
        (Rules(ends="controllable"), Options(controllers="general", ends="controllable")),
        (Rules(reaction=Fraction(1)), Options(reaction=Fraction(1))),
        (Rules(reaction=Fraction(0)), Options(reaction=Fraction(0))),
        (Rules(slack={"bot1": 2}), Options(slack={"bot1": 2})),
    ],
)
def test_other_games_and_controllers_win_too_and_people_follow(rules: Rules, options: Options, tmp_path: Path) -> None:
    text = (SCENARIOS / "thesis" / "scenario_1.pur").read_text()
    (tmp_path / "nurse.pur").write_text(text.replace('"bot2" controllable', '"bot2" human controllable'))
    scenario = load(tmp_path / "nurse.pur")
    won = solve_scenario(scenario, rules)
    on, times = stage_of(scenario, won, options), Remaining(won)
    assert on.people is not None
    outcomes = [simulate_mission(on, Settings("random", bound=times.bound()), seed) for seed in range(25)]
    assert {outcome.end for outcome in outcomes} == {GOAL}, [o.reason for o in outcomes if o.end != GOAL][:3]


@pytest.mark.parametrize("name", ["ecobot/ecobot", "work_cell/work_cell"])
def test_without_faults_every_mission_stays_safe(name: str) -> None:
    outcomes = missions(name, 40, Settings("mixed", until=150.0))
    assert {outcome.end for outcome in outcomes} == {SAFE}, [o.reason for o in outcomes if o.end != SAFE][:3]
    assert {outcome.time for outcome in outcomes} == {150.0}
    assert max(outcome.steps for outcome in outcomes) > 10


@pytest.mark.parametrize("kind", [kind for kind in FAULTS if kind not in HARMLESS])
def test_with_a_fault_missions_reach_the_goal_or_stop_safely(kind: str) -> None:
    outcomes = missions(THIEF, 10, Settings("random", (kind,)))
    assert {outcome.end for outcome in outcomes} <= {GOAL, STOPPED, HELD, LOST}, [
        (o.seed, o.reason) for o in outcomes if o.end == FAILED
    ]
    assert any(outcome.happened.get(kind) for outcome in outcomes)
    assert all(set(outcome.happened) <= {kind} for outcome in outcomes)


@pytest.mark.parametrize("kind", HARMLESS)
def test_a_fault_that_delays_no_agent_changes_no_outcome(kind: str) -> None:
    outcomes = missions(THIEF, 40, Settings("random", (kind,)))
    assert {outcome.end for outcome in outcomes} == {GOAL}, [(o.seed, o.reason) for o in outcomes if o.end == FAILED]
    assert sum(outcome.happened.get(kind, 0) for outcome in outcomes) > 20


@pytest.mark.parametrize("kind", ["loss", "orders", "restart"])
def test_lost_messages_and_short_absences_are_made_good(kind: str) -> None:
    names = (THIEF, "thesis/scenario_4", "work_cell/work_cell", "catch_the_thief/burglary")
    outcomes = [o for name in names for o in missions(name, 12, Settings("random", (kind,), until=150.0))]
    assert {outcome.end for outcome in outcomes} <= {GOAL, SAFE}, [(o.seed, o.end, o.cause, o.reason) for o in outcomes]
    assert sum(outcome.happened.get(kind, 0) for outcome in outcomes) > 5


def test_with_lost_messages_commands_take_effect_about_as_soon_as_without() -> None:
    outcomes = missions(THIEF, 40, Settings("random", ("loss",)))
    assert 0.02 < max(outcome.lateness for outcome in outcomes) < 0.2


def test_a_mission_that_is_lost_without_a_fault_that_was_too_long_is_a_failure() -> None:
    """A strategy for another deadline: the commands come in time, and the mission is lost."""
    name = "work_cell/work_cell"
    path = "src/observer/config/model.yaml"
    outcomes = missions(name, 10, Settings("random", ("junk", "orders"), until=100.0), sabotaged(
        name, path, "Cobj <= 30", "Cobj <= 3"
    ))
    assert FAILED in {outcome.end for outcome in outcomes}


def test_what_was_too_long_is_stated_with_a_mission_that_is_not_won() -> None:
    outcomes = missions("work_cell/work_cell", 40, Settings("random", ("cut",), until=200.0))
    others = [outcome for outcome in outcomes if outcome.end not in (SAFE, HELD)]
    assert others and not any(outcome.end == FAILED for outcome in outcomes)
    assert any("was due for" in outcome.cause and "the margin is" in outcome.cause for outcome in others)


def test_a_command_as_late_as_without_faults_is_no_cause() -> None:
    """The strategy's margin is the reaction; controllers wait a quarter of it more at strict bounds."""
    name = "ecobot/paper_and_plastic"
    settings = Settings("mixed", ("orders",), 200.0, margin=margin(name))
    outcome = simulate_mission(stage(name), settings, 31, remaining(name))
    assert (outcome.end, round(outcome.lateness, 3)) == (LOST, 0.125)
    assert "was due for" not in outcome.cause and "outside the model's window" in outcome.cause


@pytest.mark.parametrize("seed", [17, 37, 187, 260, 316, 357, 392])
def test_a_report_that_comes_late_does_not_end_what_was_begun_after_it(seed: int) -> None:
    """In these missions the end of `clean` came once more when the robot had begun to clean again."""
    on, times, settings = stage("home/spills"), remaining("home/spills"), Settings(faults=tuple(FAULTS))
    bound = times.bound()
    settings = replace(settings, bound=bound, span=0.6 * (bound or 0.0), margin=margin("home/spills"))
    outcome = simulate_mission(on, settings, seed, times)
    assert outcome.end in (GOAL, STOPPED), outcome.reason


def test_robots_off_their_model_are_no_wrong_commands() -> None:
    outcomes = missions(THIEF, 10, Settings("random", ("late",)))  # played already, above
    assert sum(outcome.off_model for outcome in outcomes) > 0
    assert not any(outcome.problems for outcome in outcomes)


def test_a_robot_that_fails_is_replaced_by_a_new_plan() -> None:
    assert any(o.plan > 0 and o.end == GOAL for o in missions(THIEF, 12, Settings("random", ("failed",))))


def test_a_mission_is_the_same_again_with_and_without_its_record() -> None:
    settings = Settings("mixed", tuple(kind for kind in FAULTS if kind not in ("failed", "silent")))
    for seed in range(2):  # the second one gets a new plan
        first = simulate_mission(stage(THIEF), settings, seed, remaining(THIEF))
        again = simulate_mission(stage(THIEF), settings, seed, remaining(THIEF), record=True)
        assert again.play and not first.play
        assert replace(again, play=()) == first


def test_the_worst_opponent_takes_longer_than_others() -> None:
    times = {
        kind: sorted(outcome.time for outcome in missions(THIEF, 40, Settings(kind))) for kind in ("still", "worst")
    }
    assert times["worst"][20] > times["still"][20]
    bound = remaining(THIEF).bound()
    assert bound is not None and times["worst"][-1] <= bound + 1e-3


def test_where_looking_ahead_costs_much_the_worst_opponent_of_mixed_ones_is_rare() -> None:
    on, (_, won) = stage("thesis/scenario_1"), solved("thesis/scenario_1")
    times = Remaining(won)
    assert times.ease == 1.0, "a small game"
    for ease, some in ((1.0, True), (0.0, False)):
        times.ease = ease
        kinds = {simulate_mission(on, Settings("mixed"), seed, times).opponent for seed in range(20)}
        assert kinds == ({"random", "still", "worst"} if some else {"random", "still"})
        assert simulate_mission(on, Settings("worst"), 1, times).opponent == "worst"


def test_mixed_opponents_seldom_stand_still_and_the_others_are_who_they_were() -> None:
    kinds = [kind_in_mission("mixed", str(seed), None) for seed in range(1000)]
    assert 0.07 < kinds.count("still") / 1000 < 0.13
    assert min(kinds.count("random"), kinds.count("worst")) > 250
    assert kinds[1:6] == ["worst", "worst", "random", "random", "worst"]


def test_the_bound_is_that_of_the_checker_and_a_quarter_of_the_reaction_for_each_command() -> None:
    _, won = solved("thesis/scenario_1")
    prompt = worst_case(won.network, won.objective, won.strategy, won.reaction)
    bound = remaining("thesis/scenario_1").bound()
    assert prompt is not None and bound is not None
    assert float(prompt) < bound <= float(prompt) + 4 * float(won.reaction) / 4


def test_a_mission_that_takes_longer_than_guaranteed_fails() -> None:
    outcome = simulate_mission(stage(THIEF), Settings("still", bound=3.0), 1)
    assert outcome.end == FAILED
    assert "more than the guaranteed 3.000" in outcome.reason


def test_a_mission_that_comes_to_no_end_fails() -> None:
    outcome = simulate_mission(stage(THIEF), Settings("still", until=5.0), 1)
    assert (outcome.end, outcome.time) == (FAILED, 5.0)
    assert outcome.reason == "it neither reached the goal nor stopped"
