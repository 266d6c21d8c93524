"""More time for a scenario that is not decided: all is won with the limits that are proposed."""

from __future__ import annotations

import json
from typing import List

import pytest

from pursue_gen.diagnostics import error
from pursue_gen.explanation import costs as costs_module
from pursue_gen.explanation import offers as longer_module
from pursue_gen.explanation.costs import Costs, as_json, costs, in_words
from pursue_gen.explanation.offers import Longer, longer
from pursue_gen.language import parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.outcomes import LimitHit, Lost
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import Solution, solution, solve_scenario
from pursue_gen.synthesis.limits import Limits
from pursue_gen.tga.network import Network, Objective

RULES = Rules()

HOUSE = """poi "hall"
poi "east"
poi "west"
connect hall and east distance 3
connect hall and west distance 3
event "ring"
event "look" location east duration 2
agent "otto" controllable mobile 1 location west can_do look
agent "guest" location hall can_do ring
objective: if ring then look within {look}
objective: patrol west, hall every {every} by otto
reach_objective: do look within {first}
"""


def house(look: int = 14, every: int = 60, first: int = 50) -> Scenario:
    return parse(HOUSE.format(look=look, every=every, first=first), "house.pur", "house")


def promises(scenario: Scenario) -> Scenario:
    return parse(scenario.text[: scenario.text.index("reach_objective")], "house.pur", "house")


def changed(scenario: Scenario, longer: Longer) -> str:
    lines = scenario.text.split("\n")
    lines[longer.line - 1] = f"objective: {longer.text}"
    return "\n".join(lines)


@pytest.mark.parametrize(("look", "every"), [(14, 60), (30, 20), (9, 15)])
def test_all_is_won_with_what_is_proposed_and_a_promise_that_is_kept_stays(look: int, every: int) -> None:
    scenario = promises(house(look, every))
    with pytest.raises(Lost):
        solve_scenario(scenario, RULES)
    found = longer(scenario, RULES, Limits(60.0))
    assert found
    for each in found:
        scenario = parse(changed(scenario, each), "house.pur", "house")
        assert scenario.safety[each.line - 10].known_limit > each.asked
    assert solve_scenario(scenario, RULES).strategy.blocks


def test_one_statement_with_several_promises_is_one_line() -> None:
    (only,) = longer(promises(house(40, 20)), RULES, Limits(60.0))
    assert only.text.startswith("patrol west, hall every ") and (only.line, only.asked) == (11, 20)
    assert only.in_words() == f"  line 11, {only.text} (20 is asked for)"


def test_limits_that_are_too_much_work_to_win_with_are_not_told(monkeypatch: pytest.MonkeyPatch) -> None:
    tried: List[Objective] = []

    def little_work(network: Network, objective: Objective, rules: Rules, options: SolveOptions) -> Solution:
        tried.append(objective)
        if len(tried) > 1:
            raise LimitHit([error("SYN010", "no verdict")])
        return solution(network, objective, rules, options)

    monkeypatch.setattr(longer_module, "solution", little_work)
    found = longer(promises(house()), RULES, Limits(60.0))
    assert [each.text for each in found] == ["if ring then look within 28", "patrol west, hall every 120 by otto"]


def test_where_nothing_has_a_limit_or_there_is_no_time_nothing_is_found() -> None:
    scenario = house()
    without = parse(scenario.text.replace(" within 14", " within 90").replace(" within 50", ""), "h.pur", "h")
    goal = parse(
        "\n".join(line for line in without.text.split("\n") if not line.startswith("objective")), "h.pur", "h"
    )
    assert longer(goal, RULES, Limits(60.0)) == ()
    assert longer(promises(house()), RULES, Limits(1e-6)) == ()


def test_it_is_the_first_that_is_said_of_a_scenario_that_is_not_decided(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(costs_module, "WORK", 2_000)
    found = costs(promises(house()), RULES)
    first, second, *_ = in_words(found).split("\n")
    assert first == "All is won with more time:" and second.startswith("  line 10, if ring then look within ")
    assert json.loads(json.dumps(as_json(found)))["longer"][0]["asked"] == 14
    assert "longer" not in as_json(Costs((), ())) and in_words(Costs((), ())) == ""
