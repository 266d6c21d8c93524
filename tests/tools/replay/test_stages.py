"""Recordings of a mission by a strategy whose first stage does not name the visitor."""

from __future__ import annotations

import functools
from typing import List, Sequence, Tuple

import pytest

from pursue_gen.partition import partition
from pursue_gen.tools.replay import MissionRecord, check
from pursue_gen.tools.replay.finding import FAULT, WORLD
from pursue_gen.tools.replay.game import Game
from pursue_gen.tools.replay.orders import of_strategy
from pursue_gen.tools.replay.record import read_word
from pursue_gen.tools.simulation.stage import stage_of
from pursue_gen.workspace import Options
from pursue_runtime.observer.mission import Mission
from pursue_runtime.state import SystemState
from tests.two_stages import solved_in_stages

Play = Sequence[Tuple[float, str, str]]
"""Moment, word, node."""

FIRST_STAGE: Play = (
    (0.0, "_start_", "UI"),
    (0.03, "reachObj:reachObj_going_initial_location2unlocked@1", "controllerObj"),
    (1.06, "visitor_gate2hub", "UI"),
    (1.12, "bot:bot_hub2depot@2", "controller_bot"),
    (3.6, "bot_going_hub_to_depot2depot", "simulator"),
    (4.64, "bot:load@5", "controller_bot"),
    (7.0, "loadDONE", "simulator"),
)


@functools.lru_cache(maxsize=None)
def game() -> Game:
    scenario, won = solved_in_stages()
    subs = partition(won.strategy, won.network, scenario.agents)
    orders = of_strategy(won.strategy, ((sub.controller, sub.agents) for sub in subs), won.reaction)
    return Game(scenario, won.network, won.objective, orders, given=True)


def states(play: Play) -> List[SystemState]:
    """What the observer publishes when it takes these words."""
    scenario, won = solved_in_stages()
    on = stage_of(scenario, won, Options(reaction=won.reaction))
    observer = Mission(on.model, on.cover, lambda level, text: None)
    return [state for at, text, _ in play for state in observer.on_word(text, at)]


def found(play: Play, shown: Sequence[SystemState]) -> List[Tuple[str, int]]:
    """What is found that is worse than a note."""
    words = tuple(read_word(at, text, node) for at, text, node in play)
    findings = check(MissionRecord(tuple(shown), words, problems=()), game()).findings
    return [(f.kind, f.seq) for f in findings if f.level in (WORLD, FAULT) and f.kind != "untold"]


def test_a_command_of_the_first_stage_stands_whatever_the_visitor_does() -> None:
    shown = states(FIRST_STAGE)
    assert [state.seq for state in shown] == [1, 2, 3, 4, 5, 6, 7]
    assert found(FIRST_STAGE, shown) == []


def test_a_command_that_comes_later_than_the_reaction_is_a_fault() -> None:
    late = tuple((1.4, text, node) if at == 1.12 else (at, text, node) for at, text, node in FIRST_STAGE)
    assert ("command", 4) in found(late, states(late))


def test_a_state_that_is_published_again_begins_nothing() -> None:
    play: Play = (FIRST_STAGE[0], (0.19, *FIRST_STAGE[1][1:]))
    first, then = states(play)
    again = first._replace(stamp=0.185, clocks=first.clocks_at(0.185))
    assert found(play, [first, again, then]) == found(play, [first, then]) == []


def test_a_word_that_led_to_nothing_names_what_came_first_and_mattered() -> None:
    play: Play = (*FIRST_STAGE, (7.02, "bot:bot_hub2depot@2", "controller_bot"), (7.03, "bot:load@2", "controller_bot"))
    words = tuple(read_word(at, text, node) for at, text, node in play)
    findings = check(MissionRecord(tuple(states(FIRST_STAGE)), words), game()).findings
    texts = [finding.text for finding in findings if finding.kind == "dropped"]
    assert [text.rsplit(": ", 1)[1] for text in texts] == [
        "it was published again, and had been taken", "bot_hub2depot by bot came first"
    ]  # fmt: skip


@pytest.mark.parametrize("missing", [(3,), (4,), (3, 4), (4, 5, 6)])
def test_missing_states_follow_from_words_that_stand(missing: Tuple[int, ...]) -> None:
    shown = states(FIRST_STAGE)
    assert found(FIRST_STAGE, [state for state in shown if state.seq not in missing]) == []


def test_a_word_of_an_earlier_number_explains_no_gap_in_the_second_stage() -> None:
    play: Play = (
        *FIRST_STAGE, (8.1, "visitor_going_gate_to_hub2hub", "UI"), (8.2, "bot:bot_depot2hub@8", "controller_bot"),
        (10.4, "bot_going_depot_to_hub2hub", "simulator"),
    )  # fmt: skip
    shown = states(play)
    assert found(play, shown) == []
    assert found(play, [state for state in shown if state.seq != 9]) == []
    stale = tuple((at, text.replace("@8", "@7"), node) for at, text, node in play)
    assert ("gap", 10) in found(stale, [state for state in shown if state.seq != 9])
