"""Several objectives, several things to do, and deadlines: won and lost because of them, and what is said of it."""

from __future__ import annotations

from typing import List

import pytest

from pursue_gen.explanation.explain import explain, render
from pursue_gen.language import parse
from pursue_gen.proof.checker import verify
from pursue_gen.solving.deadlines import fastest_solution
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import guaranteed, solve_scenario
from pursue_gen.synthesis.plan import read_plan, write_plan
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tools.simulation.mission import simulate_mission
from pursue_gen.tools.simulation.outcome import GOAL, SAFE, Settings
from pursue_gen.tools.simulation.stage import stage_of
from pursue_gen.workspace import Options
from tests.solving.verdicts import is_won, text


@pytest.mark.parametrize("engine", ["native", "python"])
@pytest.mark.parametrize(
    ("name", "words", "instead", "won"),
    [
        ("hotel/two_bells", "within 20", "within 12", True),
        ("hotel/two_hasty_bells", "objective: if ringWest then serveWest within 12", "", False),
        ("hotel/two_hasty_bells", "objective: if ringEast then serveEast within 12", "", False),
        ("airport/last_call", "within 26", "within 22", True),
        ("airport/closed_gate", " within 22", "", False),
        ("airport/closed_gate", "stamp and ", "", False),
    ],
)
def test_what_the_objectives_decide(name: str, words: str, instead: str, won: bool, engine: str) -> None:
    assert words in text(name)
    assert (is_won(text(name), engine), is_won(text(name).replace(words, instead), engine)) == (won, not won)


LATER = text("airport/last_call").replace("within 26", "after 30 within 60")
KENNEL = 'poi "kennel"\nconnect counter and kennel distance 9\nagent "dog" location kennel\n'
BOTH = f"""{text("airport/last_call")}{KENNEL}
reach_objective: do fetch after 30 within 50
objective: porter never_with dog
"""


@pytest.mark.parametrize("source", [text("hotel/two_bells"), text("airport/last_call"), LATER, BOTH], ids=range(4))
def test_missions_with_random_opponents_end_well(source: str) -> None:
    read = parse(source, "x.pur", "x")
    stage = stage_of(read, solve_scenario(read, DEFAULT), Options())
    outcomes = [simulate_mission(stage, Settings("random", until=200.0), seed) for seed in range(20)]
    assert {outcome.end for outcome in outcomes} <= {GOAL, SAFE}, [outcome.reason for outcome in outcomes]


def test_what_is_done_counts_for_every_goal() -> None:
    """Nothing is done again because a goal did not count yet."""
    ward = '''
    poi "ward"
    event "look" location ward
    event "wash" location ward duration 1
    agent "nurse" controllable mobile 1 location ward can_do look, wash
    reach_objective: do wash{0}
    reach_objective: do look and wash{0}
    reach_objective: do look{0} within 60
    '''
    for after in ("", " after 5"):
        won = solve_scenario(parse(ward.format(after), "x.pur", "x"), DEFAULT)
        for block in won.strategy.blocks:
            locked = [name for name, place in block.state.locations if place == "initial_location"]
            senders = {command.moves[0].automaton for command in block.commands}
            assert not locked or "nurse" not in senders, block.state


def test_a_goal_with_a_deadline_is_guaranteed_by_then() -> None:
    for source, deadline in ((text("airport/last_call"), 26), (LATER, 60)):
        won = solve_scenario(parse(source, "x.pur", "x"), DEFAULT)
        worst = guaranteed(won, 10_000).worst
        assert worst is not None and worst <= deadline


def test_what_happens_too_early_does_not_count() -> None:
    won = solve_scenario(parse(LATER, "x.pur", "x"), DEFAULT)
    assert guaranteed(won, 10_000).least > 30


def test_a_plan_of_several_objectives_is_read_back() -> None:
    won = solve_scenario(parse(BOTH, "x.pur", "x"), DEFAULT)
    again = read_plan(write_plan(won.strategy, won.network, won.objective), won.network, "plan.txt")
    assert verify(won.network, won.objective, again, won.reaction).ok
    assert [name for name, _ in won.objective.goal] == ["reachObj", "reachObj2"]
    assert won.objective.bad == (("obj", "lose"), ("reachObj", "late"), ("reachObj2", "late"))


def explained(source: str) -> List[str]:
    """The lines of an explanation, in one piece each."""
    return render(explain(parse(source, "x.pur", "x"), DEFAULT), width=10_000).splitlines()


def test_objectives_that_exclude_each_other_are_named() -> None:
    east, west = (f"'objective: if ring{side} then serve{side} within 12'" for side in ("East", "West"))
    assert explained(text("hotel/two_hasty_bells"))[0] == (
        f"Of {east} and {west} each alone can be promised, both together cannot."
    )


def test_an_objective_that_is_lost_alone_is_named() -> None:
    source = text("hotel/two_bells").replace("then serveWest within 20", "then serveWest within 3")
    expected = "'objective: if ringWest then serveWest within 3' cannot be promised, even as the only objective."
    assert explained(source)[0] == expected


def test_of_three_objectives_those_that_exclude_each_other_are_named() -> None:
    kennel = KENNEL.replace("counter", "west")
    first = explained(f"""{text("hotel/two_hasty_bells")}{kennel}objective: waiter never_with dog\n""")[0]
    assert "cannot be promised together" in first and "never_with" not in first


def test_the_play_names_the_objective_that_is_broken_and_its_deadline() -> None:
    lines = explained(text("airport/closed_gate"))
    assert any("stamp and fetch not done within 22 of the start" in line for line in lines)
    assert any("stamp and fetch within 24 instead of 22" in line for line in lines)


def test_the_least_time_of_several_goals_is_found() -> None:
    source = text("airport/last_call").replace(" within 26", "").replace("stamp and fetch", "stamp")
    read = parse(f"{source}reach_objective: do fetch\n", "x.pur", "x")
    found = fastest_solution(translate(read), scenario_objective(read), DEFAULT).guarantee
    assert found is not None and found.worst is not None
    assert 22 < found.least <= found.worst < 24
