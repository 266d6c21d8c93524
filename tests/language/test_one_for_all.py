"""Where one answer may be enough for several of an event, sentences say so, and nowhere else."""

from __future__ import annotations

from typing import Dict

import pytest

from pursue_gen.language import parse
from pursue_gen.language.sentences import is_one_for_all, objective_words
from pursue_runtime.observer.automata import Automata
from tests.stories import free_model, scenario

HOME = """\
poi "hall"
event "ring"{event}
event "look" location hall
event "sweep" location hall
{rule}
agent "bot" controllable location hall can_do look, sweep
agent "anna" location hall can_do ring
{said}
objective: if ring then look within 10
"""
PLAIN = {"event": "", "rule": "", "said": ""}


def home(**parts: str) -> str:
    return HOME.format(**{**PLAIN, **parts})


AGAIN = [
    {},
    {"event": " location hall"},
    {"event": " at_most 2 times"},
    {"said": "assume: anna waits 9 between ring"},
    {"said": "assume: anna does ring at_most 2 times"},
    {"said": "assume: anna does ring after 30"},
    {"rule": 'rule "r": look before sweep'},
    {"said": "objective: if ring then sweep within 30, at_most 2 open"},
]
NOT_AGAIN = [
    {"event": " at_most 1 times"},
    {"event": " duration 3"},
    {"event": " only_if bot at hall"},
    {"said": "assume: anna waits 10 between ring"},
    {"said": "assume: anna does ring at_most 1 times"},
    {"said": "assume: at_most 1 of ring in all"},
    {"rule": 'rule "r": ring before look'},
    {"said": "objective: if ring then sweep within 30, at_most 1 open"},
]


@pytest.mark.parametrize("parts", AGAIN)
def test_somebody_may_ask_again_before_the_answer(parts: Dict[str, str]) -> None:
    text = home(**parts)
    assert is_one_for_all(scenario(text).safety[-1], scenario(text))
    assert "Whenever ring happens, look happens within 10 units, once for all that come before it." in objective_words(
        scenario(text)
    )
    model = free_model(text)
    watched, asked = Automata(model, 1.0), []
    watched.start(0.0)
    for step in range(1, 1000):
        now = step * 0.1
        move = model.joint_move(watched.position(now), "ring", "anna")
        if move:
            watched.take(move, now)
            asked.append(now)
    assert 0 < asked[1] - asked[0] < 10


@pytest.mark.parametrize("parts", NOT_AGAIN)
def test_elsewhere_nothing_is_said_of_that(parts: Dict[str, str]) -> None:
    text = home(**parts)
    assert "Whenever ring happens, look happens within 10 units." in objective_words(scenario(text))


def test_nothing_is_said_of_conditions_nor_of_what_robots_do() -> None:
    text = home().replace("if ring then look", "if anna at hall then look")
    assert not is_one_for_all(parse(text, "x.pur").safety[0], parse(text, "x.pur"))
    text = home().replace("if ring then look", "if sweep then look")
    assert not is_one_for_all(parse(text, "x.pur").safety[0], parse(text, "x.pur"))
