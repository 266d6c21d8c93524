"""What is decided of a scenario that is too large: its objectives alone and together, each beside its statement."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import List

import pytest

from pursue_gen.diagnostics import Span
from pursue_gen.explanation import decided as decided_module
from pursue_gen.explanation.costs import Cost, Costs, as_json, costs, in_words
from pursue_gen.explanation.decided import Decided, Known, decided, texts
from pursue_gen.language import parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.optional import promised_of
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.rules import Rules, played
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.limits import Limits
from pursue_gen.synthesis.solve import solve
from pursue_gen.tga import scenario_objective, translate

RULES = Rules()

WARDS = """poi "desk"
poi "east"
poi "west"
connect desk and east distance 3
connect desk and west distance 3
event "ringEast"
event "ringWest"
event "lookEast" location east duration 2
event "lookWest" location west duration 2
agent "nora" controllable mobile 1 location desk can_do lookEast, lookWest
agent "otto" controllable mobile 1 location desk
agent "guest" location east can_do ringEast
agent "child" location west can_do ringWest
objective: if ringEast then lookEast within {east}
objective: if ringWest then lookWest within {west}
objective: patrol desk, east every 200 by otto
"""


def wards(east: int = 40, west: int = 40) -> Scenario:
    return parse(WARDS.format(east=east, west=west), "wards.pur")


def found(scenario: Scenario, work: int = 100_000_000) -> Decided:
    known = decided(scenario, RULES, Budget(Limits(work=work)))
    assert known is not None
    return known


def lines(known: Decided) -> List[int]:
    return [span.line for span in known.together]


def line(number: int, member: str = "") -> Span:
    return Span("wards.pur", number, 1, number, 2, member)


def is_won(scenario: Scenario) -> bool:
    return solve(played(translate(scenario), RULES), scenario_objective(scenario), RULES.reaction).won


def test_each_objective_alone_is_decided_beside_its_line_and_its_text() -> None:
    scenario = wards(west=5)
    known = found(scenario)
    assert [(one.span.line, one.text, one.won) for one in known.alone] == [
        (14, "if ringEast then lookEast within 40", True),
        (15, "if ringWest then lookWest within 5", False),
        (16, "patrol desk, east every 200 by otto", True),
    ]
    assert not is_won(replace(scenario, safety=scenario.safety[1:2]))
    assert all(one.states > 0 for one in known.alone)


def test_those_that_are_won_together_are_proven_to_be() -> None:
    scenario = wards()
    known = found(scenario)
    assert lines(known) == [14, 15, 16] and known.following is None
    assert promised_of(scenario, SolveRequest()).solution.strategy.blocks
    assert texts(known)[-1] == "Won together: lines 14, 15 and 16."


def test_what_is_lost_with_another_one_is_named() -> None:
    scenario = wards(9, 9)
    scenario = replace(scenario, safety=scenario.safety[:2])
    known = found(scenario)
    assert [one.won for one in known.alone] == [True, True]
    assert known.lost and lines(known) == [14] and known.following and known.following.line == 15
    assert not is_won(scenario)
    assert texts(known)[-1] == "Lost together with line 14: line 15."


def test_without_work_nothing_is_claimed() -> None:
    known = found(wards(), work=1)
    assert {one.won for one in known.alone} == {None} and known.together == ()
    assert "not decided alone" in texts(known)[0] and len(texts(known)) == 3


def test_one_objective_has_nothing_to_be_compared_with() -> None:
    scenario = wards()
    assert decided(replace(scenario, safety=scenario.safety[:1]), RULES, Budget(Limits(work=1))) is None


def test_the_whole_text_is_never_listed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(decided_module, "_SET", 1e-9)
    found = costs(wards(), RULES)
    text = in_words(replace(found, decided=(), undecided=("nora", "otto", "guest", "child"), cheaper=()))
    assert text.splitlines()[-1] == "Not decided together with line 16: line 14."
    assert "without" not in text.lower()
    many = Costs((), tuple("abcdefgh"))
    assert in_words(many) == "Too large without a or b or c or d or e or one of 3 more, and without all of them."
    assert in_words(Costs((Cost(tuple("abcd"), True, 7, 0.1, 5),), ())) == ""


def test_it_is_in_the_json_too() -> None:
    known = Decided((Known("avoid e", line(3), True, 17),), (line(3),), line(4))
    objectives = json.loads(json.dumps(as_json(Costs((), (), known))))["objectives"]
    assert objectives["alone"] == [{"text": "avoid e", "line": 3, "won": True, "states": 17}]
    assert (objectives["together"], objectives["next_line"], objectives["lost"]) == ([3], 4, False)


def test_a_line_is_named_once_with_those_members_that_are_meant() -> None:
    room1, room2 = line(3, "r is room1"), line(3, "r is room2")
    alone = tuple(Known(f"avoid {n}", span, True, 5) for n, span in enumerate((room1, room2, line(7))))
    whole = texts(Decided(alone, (room1, room2), line(7)))[-1]
    assert whole == "Won together: line 3. Not decided together with these: line 7."
    some = texts(Decided(alone, (room1, line(7)), room2, lost=True))[-1]
    assert some == "Won together: lines 3 (r is room1) and 7. Lost together with these: line 3 (r is room2)."
    found = as_json(Costs((), (), Decided(alone, (room1, room2), line(7))))["objectives"]
    assert (found["together"], found["alone"][1]["member"]) == ([3], "r is room2") and "member" not in found["alone"][2]
