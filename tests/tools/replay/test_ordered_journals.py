"""Journals of missions in which people order: what was ordered is in the states that they lead to, and judged."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Dict, List, Tuple

import pytest

from pursue_gen.tools.replay import check
from pursue_gen.tools.replay.finding import NOTE
from pursue_gen.tools.replay.game import Game, from_data, game_of
from pursue_gen.tools.replay.journal import Journal, read_journal, reconstruct
from pursue_gen.tools.replay.moves import Moves
from pursue_gen.tools.replay.record import MissionRecord
from pursue_gen.tools.replay.written import with_orders
from pursue_runtime.observer.journal import Journal as Written
from tests.runtime.observer.test_ordering import GAME, Counter


@pytest.fixture
def game() -> Game:
    """The game of the mission."""
    return game_of(from_data(GAME, "game.yaml"))


def recorded(folder: Path, *texts: str) -> Journal:
    """The journal of a mission with these orders, the plan for each of which is found; the robot drives to room1."""
    counter = Counter()
    counter.mission, counter.now = counter.fresh(), 100.0
    said: List[str] = []
    file = Written(counter.mission, str(folder / "journal"), {"scenario": "tea"}, lambda _, text: said.append(text))

    def call(name: str, *args: object) -> None:
        file.call(name, *args, now=counter.now)

    call("hear", "_start_")
    for number, text in enumerate(texts):
        call("order", text)
        request, answer = counter.mission.plan_request, counter.plan()
        assert request is not None and answer["won"]
        counter.now += 1.0
        call("planned", request.number, answer)
        call("hear", f"controller_bot:_plan_@{request.number}")
        call("tick")
        if number == 0:
            call("hear", f"bot:bot_kitchen2room1@{counter.mission.seq}")
    counter.now += 10.6 - counter.mission.position(counter.now).clocks["Cbot"]
    call("hear", "bot:bot_going_kitchen_to_room12room1")
    call("stop", "enough")
    found = read_journal((folder / "journal").read_bytes())
    assert isinstance(found, Journal) and said == []
    return found


def record_of(found: Journal, game: Game) -> MissionRecord:
    """The states that it leads to."""
    return reconstruct(found, Moves(game.network), game.objective)


@pytest.mark.parametrize(
    ("texts", "events", "places"),
    [
        (("tea1 within 50",), ["tea1"], {"obj": "atRisk", "obj2": "idle"}),
        (("tea1", "tea2", "cancel tea1"), ["tea1", "tea2", "tea1_cancelled_"], {"obj": "idle", "obj2": "atRisk"}),
        (("bot at room1 within 60",), ["order1"], {"obj": "idle", "obj3": "idle"}),
        (("bot at room1 within 60", "do serve2 within 80"), ["order1", "order2"], {"obj3": "idle", "obj4": "atRisk"}),
    ],
)
def test_what_was_ordered_is_found_in_a_journal(
    game: Game, tmp_path: Path, texts: Tuple[str, ...], events: List[str], places: Dict[str, str]
) -> None:
    found = recorded(tmp_path, *texts)
    game = with_orders(game, found.plans_of_orders)
    record = record_of(found, game)
    assert [state.event for state in record.states if state.agent == "order_desk"] == events
    last = record.states[-1]
    assert places.items() <= last.locations.items() and last.locations["bot"] == "room1"
    findings = check(record, game).findings
    assert [each for each in findings if each.level != NOTE] == [] and record.problems == ()
    within = [float(text.split()[-1]) for text in texts if "tea1 within" in text]
    for state in [each for each in record.states if each.event == "tea1" and within]:
        assert state.clocks["Cobj"] == pytest.approx(60 - within[0] + 1.0)  # it is due sooner, and came before


def test_a_journal_that_does_not_say_what_was_ordered_is_not_whole(game: Game, tmp_path: Path) -> None:
    found = recorded(tmp_path, "tea1")
    for ordered in ({"event": "tea7"}, {"event": "serve1"}):
        entries = [
            each if each.ordered is None else replace(each, ordered=each.ordered._replace(**ordered))
            for each in found.entries
        ]
        record = record_of(replace(found, entries=tuple(entries)), game)
        assert any("cannot be ordered here" in each for each in record.problems)
