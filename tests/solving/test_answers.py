"""How late promises are kept at worst: measured in the closed loop, the same as what a shorter deadline would show."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Tuple

import pytest

from benchmarks.lab_scenarios import lab_scenario
from benchmarks.ordinary_families import buildings_apart
from pursue_gen.language import parse
from pursue_gen.language.scenario import Respond, Scenario
from pursue_gen.proof.closed_loop import ClosedLoop, Depth
from pursue_gen.proof.independence import named_part
from pursue_gen.proof.worst_case import INSTANT
from pursue_gen.solving.answers import Answer, answers
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import Solution, solve_scenario
from pursue_gen.synthesis.limits import LimitMonitor
from pursue_gen.tga.network import Network
from pursue_gen.tools.simulation.runs import make_case, simulate
from tests.cli.test_commands import pursue

DESK = """
poi "desk"
poi "shelf"
connect desk and shelf distance 4
event "call"
event "fetch" location shelf duration 3
agent "bot" controllable mobile 1 location desk can_do fetch
agent "guest" location desk can_do call
objective: if call then fetch within 40
"""
WATCH = """
poi "gate"
poi "vault"
connect gate and vault distance 4
agent "guard" controllable mobile 1 location gate
objective: patrol gate, vault every 30 by guard
"""


def won(text: str) -> Tuple[Scenario, Solution]:
    scenario = parse(text, "x.pur", "x")
    return scenario, solve_scenario(scenario, DEFAULT)


def with_deadlines(network: Network, deadline: Fraction) -> Network:
    """The network with another deadline for all objectives."""
    automata = []
    for automaton in network.automata:
        places = [
            replace(place, invariant=tuple(replace(bound, bound=deadline) for bound in place.invariant))
            if place.name == "atRisk" else place
            for place in automaton.locations
        ]  # fmt: skip
        automata.append(replace(automaton, locations=tuple(places)))
    return replace(network, automata=tuple(automata))


def keeps(solution: Solution, deadline: Fraction) -> bool:
    """Whether the strategy, played promptly, keeps a deadline for all objectives."""
    game = with_deadlines(named_part(solution.network, solution.strategy), deadline)
    loop = ClosedLoop(game, solution.objective, solution.strategy, solution.reaction, None, INSTANT)
    return loop.everything(Depth(True, False, 100_000), LimitMonitor()).failure is None


@pytest.mark.parametrize("text", [DESK, WATCH, WATCH.replace("every", "in order every")], ids=range(3))
def test_the_time_is_the_shortest_deadline_that_the_strategy_keeps(text: str) -> None:
    scenario, solution = won(text)
    worst = max(answer.worst for answer in answers(scenario, solution))
    assert worst < 40
    assert keeps(solution, worst + 2 * INSTANT)
    assert not keeps(solution, worst - 2 * INSTANT)


def test_a_call_is_answered_in_what_the_way_and_the_deed_take() -> None:
    scenario, solution = won(DESK)
    (answer,) = answers(scenario, solution)
    assert answer.worst >= Fraction("0.1") + 5 + 1 + Fraction("0.1") + 4  # each command late, the way and the deed long
    assert answer.in_words().startswith("if call then fetch within 40: answered within ")
    assert answer.in_words().endswith(" of 40, at worst.")


def test_each_share_tells_its_own() -> None:
    scenario, solution = won(buildings_apart(2))
    assert len(solution.strategy.shares) == 2
    found = answers(scenario, solution)
    assert [answer.as_json()["deadline"] for answer in found] == [75, 80]
    assert all(0 < answer.worst < 75 for answer in found)


def test_a_promise_whose_watcher_is_followed_is_kept_as_soon() -> None:
    scenario, solution = won(lab_scenario(22))
    assert [watcher.objective for watcher in solution.strategy.watchers] == ["obj3"]
    found = answers(scenario, solution)
    assert [answer.as_json()["deadline"] for answer in found] == [65, 87, 36, 121]


def test_simulated_missions_are_no_later() -> None:
    for text in (DESK, WATCH):
        scenario, solution = won(text)
        case, _ = make_case(scenario, solution, SolveRequest(), "random", (), 400.0)
        simulated = simulate(case, range(1, 21)).answers
        for answer, told in zip(answers(scenario, solution), simulated):
            # Controllers wait a quarter of the reaction at strict bounds, at most a dozen times until the answer.
            assert told.latest is not None and float(answer.worst) - 3 < told.latest < float(answer.worst) + 0.3


@pytest.mark.parametrize(
    ("deadline", "worst", "told"),
    [("40", "11.004", "11.1 of 40"), ("40", "39.97", "40 of 40"), ("11.02", "11.01", "11.02 of 11.02")],
)
def test_tenths_hold_and_are_no_later_than_the_deadline(deadline: str, worst: str, told: str) -> None:
    (promise,) = parse(DESK.replace("within 40", f"within {deadline}"), "x.pur", "x").safety
    assert isinstance(promise, Respond)
    assert f"answered within {told}, at worst" in Answer(promise, Fraction(worst)).in_words()


def test_solve_says_it(tmp_path: Path) -> None:
    (tmp_path / "desk.pur").write_text(DESK)
    told = pursue("solve", tmp_path / "desk.pur", "--json")
    assert "if call then fetch within 40: answered within " in told.err
    assert '"answers"' in told.out and '"deadline": 40.0' in told.out
