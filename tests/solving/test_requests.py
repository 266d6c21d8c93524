"""Requests that come again: who wins, what would change a loss, missions that keep the promise, and one that cannot."""

from __future__ import annotations

from pathlib import Path
from typing import Optional

import pytest
import yaml

from pursue_gen.explanation.explain import explain
from pursue_gen.language import check
from pursue_gen.outcomes import Lost
from pursue_gen.proof.checker import verify
from pursue_gen.solving.answers import answers
from pursue_gen.solving.lost_promises import in_words
from pursue_gen.solving.rules import Rules
from pursue_gen.synthesis.limits import Limits
from pursue_gen.tools.simulation.opponents import OPPONENTS
from pursue_gen.tools.simulation.outcome import SAFE, Settings
from pursue_gen.vocabulary.statuses import statuses
from pursue_runtime.observer.mission import Mission
from pursue_runtime.state import HOLDING, RUNNING, WON
from pursue_runtime.strategy import read_cover
from tests.stories import files, missions, model, scenario, solved

SHOP = """\
poi "desk"
poi "shelf"
connect desk and shelf distance 3
event "order" location desk
event "pack" location shelf duration 2
agent "bot" controllable mobile 1 location desk can_do pack
agent "shop" location desk can_do order
objective: if order then pack within {}{}
"""
OPEN = ", at_most {} open"


def is_won(within: int, most: Optional[int]) -> bool:
    try:
        won = solved(SHOP.format(within, "" if most is None else OPEN.format(most)))
    except Lost:
        return False
    assert verify(won.network, won.objective, won.strategy, won.reaction).ok
    return True


@pytest.mark.parametrize(
    ("within", "most", "won"),
    [
        # The first way to the shelf takes 4, each pack 3, and a rest 1.1 before each.
        (9, None, True), (9, 1, True), (7, 1, False),
        (9, 2, False), (12, 2, True), (12, 3, False), (17, 3, True), (20, 4, True),
    ],
)  # fmt: skip
def test_who_wins(within: int, most: Optional[int], won: bool) -> None:
    assert is_won(within, most) == won


def test_a_loss_names_the_statement_once_and_what_would_change_it() -> None:
    text = SHOP.format(9, OPEN.format(2))
    with pytest.raises(Lost) as lost:
        solved(text)
    told = in_words(lost.value, scenario(text))
    assert len(told.diagnostics) == 1 == max(1, len(told.parts))
    sentences = [each.sentence for each in explain(scenario(text), Rules(), Limits(1200.0), parts=told.parts).changes]
    assert any(each.startswith("a deadline of ") and "instead of 9 for each pack" in each for each in sentences)
    assert "at_most 1 of order open instead of 2" in sentences


def test_how_late_the_answers_are_is_told_for_all_of_them() -> None:
    text = SHOP.format(30, OPEN.format(3))
    (answer,) = answers(scenario(text), solved(text))
    assert 9 < answer.worst <= 30 and answer.in_words().startswith("if order then pack within 30, at_most 3 open: ")


def test_pages_say_which_is_next() -> None:
    text = SHOP.format(30, OPEN.format(2))
    found = {each.of: each.texts for each in statuses(scenario(text), solved(text).network)}
    assert found["Pobj"] == {"0": "the next one is 1 of 2", "1": "the next one is 2 of 2", "2": "no more may come"}
    assert found["obj2"]["atRisk"] == "pack is due" and found["assume1"]["1"] == "assumed"


@pytest.mark.parametrize("most", [1, 2, 3])
@pytest.mark.parametrize("kind", sorted(OPPONENTS))
def test_simulated_missions_answer_each(most: int, kind: str) -> None:
    text = SHOP.format(30, OPEN.format(most))
    outcomes = missions(text, 3, Settings(kind, until=150.0))
    assert {outcome.end for outcome in outcomes} == {SAFE} and not any(each.problems for each in outcomes)
    assert all(len(outcome.duties) == 1 for outcome in outcomes)


def mission(most: int) -> Mission:
    text = SHOP.format(30, OPEN.format(most))
    cover = read_cover(yaml.safe_load(files(text)["src/observer/config/cover.yaml"]))
    return Mission(model(text), cover, lambda level, line: None, on_uncovered="plan", lost_after=10.0)


def test_one_more_than_may_be_open_breaks_what_is_assumed_and_the_mission_says_so() -> None:
    under_way = mission(2)
    under_way.on_word("_start_", 0.0)
    for at in (2.0, 4.0):
        under_way.on_word("shop:order", at)
    state = under_way.state(4.0)
    assert (state.status, state.values["Pobj"], state.values["assume1"]) == (RUNNING, 2, 1)
    under_way.on_word("shop:order", 6.0)
    state = under_way.state(6.0)
    assert (state.status, state.values["assume1"]) == (HOLDING, 0)
    assert "order happens only while fewer than 2 wait for pack" in state.reason


def test_a_mission_that_ends_when_all_is_answered_waits_for_each() -> None:
    text = SHOP.format(30, OPEN.format(2)) + "mission ends when all is answered\n"
    assert list(check(scenario(text))) == []
    assert [each.is_answered for each in model(text).promises.values()] == [True, True]
    cover = read_cover(yaml.safe_load(files(text)["src/observer/config/cover.yaml"]))
    under_way = Mission(model(text), cover, lambda level, line: None, on_uncovered="plan", lost_after=10.0)
    under_way.on_word("_start_", 0.0)
    for at, word in (
        (2.0, "shop:order"), (2.0, "bot_desk2shelf"), (4.0, "shop:order"), (5.5, "bot_going_desk_to_shelf2shelf"),
        (7.0, "pack"), (9.5, "packDONE"),
    ):  # fmt: skip
        under_way.on_word(word, at)
    state = under_way.state(9.5)
    assert (state.status, state.locations["obj"], state.locations["obj2"]) == (RUNNING, "idle", "atRisk")
    under_way.on_word("pack", 11.0)
    under_way.on_word("packDONE", 13.5)
    assert under_way.state(13.5).status == WON


STORIES = Path(__file__).resolve().parents[2] / "scenarios"


def test_the_stories_are_won_and_lost_because_each_is_answered() -> None:
    shop, trays = ((STORIES / name).read_text() for name in ("warehouse/web_shop.pur", "hotel/trays.pur"))
    assert solved(shop) and solved(trays.replace(", at_most 2 open", "")) and solved(trays.replace("2 open", "1 open"))
    with pytest.raises(Lost):
        solved(trays)
