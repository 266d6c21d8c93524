"""The part of a scenario in which promises are lost: explained alone where all is too large, or several are lost."""

from __future__ import annotations

import json
import re
from contextlib import suppress
from typing import Any

import pytest

from benchmarks.lab_scenarios import Size, lab_scenario
from pursue_gen.explanation.explain import Explanation, as_json, explain, render
from pursue_gen.explanation.part import part_of_scenario, statements_of, with_objectives
from pursue_gen.explanation.play import counter_plays
from pursue_gen.explanation.play_lines import TimedLine, describe
from pursue_gen.language import parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.outcomes import LimitHit
from pursue_gen.solving.rules import Rules, played
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.limits import Limits
from pursue_gen.synthesis.solve import Verdict, solve
from pursue_gen.tga import scenario_objective, translate
from tests.stories import CARE_HOME

RULES = Rules()

SHOP = """poi "dock"
poi "aisle"
poi "rackA"
poi "rackB"
poi "packing"
connect dock and aisle distance 3
connect aisle and rackA distance 4
connect aisle and rackB distance 9
connect aisle and packing distance 5
event "orderA"
event "orderB"
event "pickA" location rackA duration 6
event "packA" location packing duration 5
event "pickB" location rackB duration 8
event "packB" location packing duration 5
event "sweep" location dock duration 2
event "dust" location aisle duration 2
rule "serveA": pickA before packA
rule "serveB": pickB before packB
rule "tidy": sweep before dust
agent "cart1" controllable mobile 1 location packing can_do pickA, packA, pickB, packB
agent "cart2" controllable mobile 1 location dock can_do pickA, packA, sweep, dust
agent "shop" location packing can_do orderA, orderB
agent "worker" mobile 2 location dock can_do orderA
objective: if orderA then packA within 90
objective: if orderB then packB within {deadline}
objective: avoid any robot at rackA and worker at rackA
"""


def shop(deadline: int) -> Scenario:
    return parse(SHOP.format(deadline=deadline), "shop.pur")


def part_of(deadline: int) -> Scenario:
    scenario = shop(deadline)
    return part_of_scenario(scenario, statements_of(scenario, ("obj2",)), RULES)


def is_won(scenario: Scenario, work: int = 0) -> bool:
    limits = Limits(work=work)
    return solve(played(translate(scenario), RULES), scenario_objective(scenario), RULES.reaction, limits=limits).won


def test_the_part_has_what_matters_to_the_promise_and_nothing_else() -> None:
    part = part_of(60)
    assert [event.name for event in part.events] == ["orderA", "orderB", "pickB", "packB"]
    assert [agent.name for agent in part.agents] == ["cart1", "shop"]
    assert [rule.name for rule in part.rules] == ["serveB"]
    assert len(part.objectives) == 1


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("pickB, packB\n", "pickB, packB reacts_to wave\n"),
        ("pickA before packA", "pickA before packB"),
        ("if orderB then", "if cart1 doing pickA then"),
        ("location shelf", ""),
    ],
)
def test_an_event_that_may_matter_stays(before: str, after: str) -> None:
    text = SHOP.format(deadline=60).replace('event "sweep"', 'event "wave" collaborative\nevent "sweep"')
    text = text.replace("can_do orderA\n", "can_do orderA, wave\n").replace(before, after)
    if not after:
        text = text.replace("objective", 'battery "cart1" capacity 60 uses 1 per unit\nobjective', 1)
    scenario = parse(text, "shop.pur")
    part = part_of_scenario(scenario, statements_of(scenario, ("obj2",)), RULES)
    assert "pickA" in {event.name for event in part.events}


def test_the_least_deadline_is_that_of_the_part_and_of_the_promise_in_the_whole_game() -> None:
    explanation = explain(shop(40), RULES, parts=(("obj2",), ("obj2",)))
    (change,) = (one for one in explanation.changes if one.what == "deadline")
    assert explanation.about == ('"if orderB then packB within 40" (line 26)',)
    assert change.least and (change.before, change.after, change.next_lost) == ("40", "54", "53")
    assert not is_won(part_of(int(change.next_lost))) and is_won(part_of(int(change.after)))
    text = render(explanation)
    assert "with nothing else promised" in text and "How it goes wrong, for example: shop prevents it" in text
    assert json.loads(json.dumps(as_json(explanation)))["preventing"] == ["shop"]


def test_a_small_scenario_is_explained_as_a_whole() -> None:
    left_out = "orderA then", "worker", "cart2"
    lines = (line for line in SHOP.format(deadline=40).splitlines() if not any(word in line for word in left_out))
    text = "\n".join(lines) + "\nobjective: patrol packing every 500 by cart1"
    explanation = explain(parse(text, "shop.pur"), RULES, parts=(("obj",),))
    assert not explanation.about and "deadline" in {change.what for change in explanation.changes}


def test_each_of_several_that_are_lost_alone_is_explained() -> None:
    scenario = parse(CARE.replace("within 40", "within 8").replace("within 30", "within 16"), "care.pur")
    explanation = explain(scenario, RULES, parts=(("obj",), ("obj2",)))
    text = render(explanation)
    first, second = text.split('"if ring3 then nora at room3 within 16" (line 14):\n')
    assert first.startswith('"if ring1 then nora at room1 within 8" (line 13):\n')
    for part, least in ((first, "a deadline of 13 instead of 8"), (second, "a deadline of 21 instead of 16")):
        assert least in part and "not once" in part
    (other,) = as_json(explanation)["others"]
    assert other["about"] == ['"if ring3 then nora at room3 within 16" (line 14)']
    assert other["preventing"] == ["resident3"]


def test_where_no_change_is_enough_for_all_what_is_lost_alone_is_explained() -> None:
    text = CARE.replace("within 40", "within 8") + "objective: avoid ring3\n"
    explanation = explain(parse(text, "care.pur"), RULES, parts=(("obj3",),))
    assert explanation.about == ('"avoid ring3" (line 15)',)
    assert explanation.play[-1].text == "ring3 has happened, which was to be avoided"


def test_a_long_play_is_told_by_its_beginning_and_its_end() -> None:
    play = tuple(TimedLine(k, "bot", f"step {k}") for k in range(30))  # type: ignore[arg-type]
    lines = render(Explanation((), (), (), play)).split("units):\n")[1].splitlines()[:-1]
    assert [line.split(" step ")[-1] for line in lines] == [
        "0", "1", "2", "   …  (21 more steps)", "24", "25", "26", "27", "28", "29",
    ]  # fmt: skip


def test_changes_that_do_not_help_are_named_once_and_not_all_of_them() -> None:
    text = render(Explanation((), tuple("abcdefgh"), ("later", "later"), ()))
    assert "Not enough alone: a; b; c; d; e; f; and 2 more." in text
    assert "Not decided within the limits: a play that shows it; later." in text


CARE = CARE_HOME + """agent "nora" controllable mobile 1 location station
agent "resident1" location room1 can_do ring1
agent "resident3" location room3 can_do ring3
objective: if ring1 then nora at room1 within 40
objective: if ring3 then nora at room3 within 30
"""


def test_a_play_against_few_calls_is_found_where_the_game_of_all_calls_is_too_large() -> None:
    scenario = parse(CARE, "care.pur")
    network, objective = played(translate(scenario), RULES), scenario_objective(scenario)
    play = next(counter_plays(network, objective, RULES.reaction, Budget(Limits(work=60_000_000))))
    assert play.end == "overdue" and describe(scenario, play)[-1].text.startswith("not once")


@pytest.mark.parametrize("seed", range(6))
def test_an_objective_of_a_random_scenario_is_won_in_its_part_where_it_is_won_alone(seed: int) -> None:
    text = lab_scenario(seed, Size(places=4, robots=2, people=1, promises=3))
    for factor in (1, 4):
        scenario = parse(shortened(text, factor), "lab.pur")
        for statement in scenario.statements:
            part = part_of_scenario(scenario, statement, RULES)
            with suppress(LimitHit):
                assert is_won(part, 5_000_000) is is_won(with_objectives(scenario, statement), 5_000_000)


def shortened(text: str, factor: int) -> str:
    return re.sub(r"within (\d+)", lambda found: f"within {int(found.group(1)) // factor}", text)


def test_a_large_scenario_is_not_searched_for_long_and_what_says_most_is_tried_first(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    reached = []

    def counting(*given: Any, **how: Any) -> Verdict:
        try:
            return solve(*given, **how)
        except LimitHit as problem:
            reached.extend(map(int, re.findall(r"(\d+) discrete states were reached", problem.diagnostics[0].message)))
            raise

    monkeypatch.setattr("pursue_gen.synthesis.budget.solve", counting)
    scenario = parse(lab_scenario(8), "lab.pur")
    explanation = explain(scenario, RULES, parts=[("obj", "obj2")])
    assert max(reached) <= 50_000
    assert explanation.conflict is not None and len(explanation.conflict.objectives) == 2
    assert "assume: person1 never at room2" in [change.sentence for change in explanation.changes]
    assert any("a deadline of" in text for text in explanation.lost), "she stays in the other room"
    assert explanation.preventing == ("person1",) and explanation.undecided
    text = render(explanation)
    assert text.index("both together cannot") < text.index("person1 prevents it") < text.index("assume: person1")
