"""A recording of what several do together: each of their reports counts, and both robots get the action."""

from __future__ import annotations

import functools
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Dict, List, Tuple

import pytest
import yaml

from pursue_gen.drawing.layout import poses
from pursue_gen.solving.rules import Rules
from pursue_gen.tools.replay.check import check
from pursue_gen.tools.replay.finding import FAULT
from pursue_gen.tools.replay.game import Game, Source, game_of
from pursue_gen.tools.replay.journal import Journal as JournalFile
from pursue_gen.tools.replay.journal import read_journal, reconstruct
from pursue_gen.tools.replay.moves import Moves
from pursue_gen.tools.replay.record import MissionRecord, RecordedWord, RobotOrder, read_word
from pursue_runtime.controller.scheduler import CommandScheduler
from pursue_runtime.event_words import format_word
from pursue_runtime.observer.journal import Journal
from pursue_runtime.observer.mission import Mission
from pursue_runtime.state import LIVE, SystemState
from pursue_runtime.strategy import Strategy, read_cover
from tests.together import HOTEL, files, model

ENDS = {"porter": 4.2, "waiter": 4.6}
"""When the robots report the end of the ride, in time units after its start."""


@functools.lru_cache(maxsize=None)
def game() -> Game:
    return game_of(Source("hotel", HOTEL, "hotel.pur", Rules()))


@dataclass
class Played:
    """A mission that its own controllers have played."""

    states: List[SystemState]
    words: List[RecordedWord]
    orders: List[RobotOrder]
    journal: bytes

    @property
    def record(self) -> MissionRecord:
        return MissionRecord(tuple(self.states), tuple(self.words), tuple(self.orders))


def play(path: Path, silent: str = "") -> Played:
    """The mission of the hotel; `silent` reports no end of the ride, and is lost."""
    data = {name: yaml.safe_load(text) for name, text in files(HOTEL).items() if name.endswith("strategy.yaml")}
    schedulers = {text["controller"]: CommandScheduler(Strategy(text), text["controller"]) for text in data.values()}
    cover = read_cover(yaml.safe_load(files(HOTEL)["src/observer/config/cover.yaml"]))
    log = lambda level, text: None
    mission = Mission(model(HOTEL), cover, log, on_uncovered="warn", lost_after=2.0)
    header: Dict[str, Any] = {"scenario": "hotel", "settings": {"time_unit": 1.0}}
    journal = Journal(mission, str(path / "journal.jsonl"), header, log)
    made, pending = Played([], [], [], b""), [(100.0, "_start_", "UI")]
    while mission.status not in ("won", "stopped") and len(made.states) < 60:
        due = [(found.next_wakeup()[0], name) for name, found in schedulers.items()]
        wakes = [(at, "", name) for at, name in due if at is not None]
        tick = mission.next_moment(made.states[-1].stamp) if made.states else None
        at, word, node = min([*pending, *wakes, *([] if tick is None else [(tick, "", "")])], key=lambda each: each[0])
        if node and not word:
            command = schedulers[node].on_timer(at)
            if command is None:
                continue
            word = format_word(command)
        elif word:
            pending.remove((at, word, node))
        if word:
            made.words.append(read_word(at - 0.001, word, node))
        for state in journal.call("hear" if word else "tick", *([word] if word else []), now=at):
            made.states.append(state)
            for name, scheduler in schedulers.items():
                for order in scheduler.on_state(state, at):
                    if order.agent == "reachObj":
                        continue
                    if order.location.startswith("going_"):
                        poi = order.location.split("_to_")[1]
                        pose = poses(game().scenario)[0][poi]
                        made.orders.append(RobotOrder(at + 0.01, order.agent, name, (pose.x, pose.y, pose.z)))
                        pending.append((at + 2.5, f"{order.agent}_{order.location}2{poi}", "sim"))
                    elif order.location.startswith("doing_"):
                        made.orders.append(RobotOrder(at + 0.01, order.agent, name, None, order.event))
                        if order.agent != silent:
                            pending.append((at + ENDS[order.agent], f"{order.agent}:rideDONE", "sim"))
                    else:
                        made.orders.append(RobotOrder(at + 0.01, order.agent, name, None, order.event))
                        pending.append((at + 0.02, f"{order.agent}:_order_@{order.seq}", "sim"))
    made.journal = (path / "journal.jsonl").read_bytes()
    return made


@pytest.fixture
def played(tmp_path: Path) -> Played:
    return play(tmp_path)


def test_nothing_of_it_is_a_fault_and_each_report_counts(played: Played) -> None:
    assert played.states[-1].status == "won"
    found = check(played.record, game())
    assert [finding for finding in found.findings if finding.level == FAULT] == []
    assert found.counts["dropped"] == 0, found.findings
    ended = next(step for step in found.steps if step.state.event == "rideDONE")
    assert ended.word is not None and ended.word.text == "waiter:rideDONE", "the last one leads to the state"


def test_an_order_that_one_of_them_did_not_get_is_a_fault(played: Played) -> None:
    for robot in ("porter", "waiter"):
        orders = [order for order in played.orders if (order.robot, order.action) != (robot, "ride")]
        found = check(replace(played, orders=orders).record, game()).findings
        assert [(f.kind, robot in f.text) for f in found if f.level == FAULT] == [("untold", True)]


def test_a_report_that_alone_ended_nothing_is_explained(played: Played) -> None:
    states = [state for state in played.states if state.event not in ("rideDONE", "serve") and state.status in LIVE]
    last = next(n for n, state in enumerate(states) if state.finished)
    words = [word for word in played.words if word.text != "waiter:rideDONE"]
    found = check(MissionRecord(tuple(states[: last + 1]), tuple(words), ()), game()).findings
    assert any("others had not finished yet" in finding.text for finding in found)


@pytest.mark.parametrize("silent", ["", "waiter"])
def test_the_journal_leads_to_the_same_states(tmp_path: Path, silent: str) -> None:
    made = play(tmp_path, silent)
    journal = read_journal(made.journal)
    assert isinstance(journal, JournalFile) and not journal.problems
    record = reconstruct(journal, Moves(game().network), game().objective)

    def by_number(states: Any) -> Dict[int, Tuple[Any, ...]]:
        return {state.seq: (state.discrete(), state.event) for state in states}

    assert by_number(record.states) == by_number(made.states)
    assert any(state.event == "rideDONE" for state in made.states)
