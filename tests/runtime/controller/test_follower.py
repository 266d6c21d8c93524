"""A controller plays the mission of the states and never another one: what it reads, when, and what it does without."""

from __future__ import annotations

from typing import Any, Dict, List, Optional, Tuple

import pytest

from pursue_runtime import missions as pursue_missions
from pursue_runtime.controller.follower import Follower
from pursue_runtime.data import DataError
from pursue_runtime.event_words import Word, format_word
from pursue_runtime.missions import Missions
from pursue_runtime.state import SystemState
from pursue_runtime.strategy import Strategy
from tests.runtime.texts import read

A, B, C = "a" * 12, "b" * 12, "c" * 12
POSES = {"x": [0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]}


def strategy(word: str) -> Dict[str, Any]:
    return read(f"""
format: 1
controller: controller_bot
commands_agents: [bot, reachObj]
reaction: 0.1
strategy:
- state: {{bot: x}}
  commands:
  - {{do: {word}, agent: bot, from: x, to: doing_{word}_in_x, when: ["1 <= Cbot && Cbot <= 5"]}}
""")


class Source:
    """One mission's data."""

    def __init__(self, mission: str, **files: Any) -> None:
        self.mission, self.folder, self.empty = mission, f"/{mission}", not files
        self.files = files

    def read(self, name: str) -> Any:
        found = self.files[name.partition(".")[0]]
        if isinstance(found, Exception):
            raise found
        return found


class Shelf:
    """The missions of a machine: A is the workspace's own."""

    def __init__(self, *others: Source) -> None:
        self.own = Source(A, strategy=strategy("a"), poses={"poses": POSES})
        self.here = {"": self.own, A: self.own, **{source.mission: source for source in others}}
        self.first: Any = self.own

    def current(self) -> Any:
        if isinstance(self.first, Exception):
            raise self.first
        return self.first

    def find(self, mission: str) -> Optional[Source]:
        return self.here.get(mission)

    def moved(self, mission: str, source: Source) -> bool:
        return self.here.get(mission) not in (None, source)


SECOND = Source(B, strategy=strategy("b"), poses={"poses": {"y": POSES["x"]}})
NO_PART = Source(C)


class Controller:
    """A follower, what it has logged, and its words as if each were due."""

    def __init__(self, shelf: Shelf, again: bool = False) -> None:
        self.logs: List[Tuple[str, str]] = []
        self.real = 0.0
        log = lambda level, text: self.logs.append((level, text))
        clock = lambda: self.real
        self.follower = Follower(shelf, "controller_bot", "controller_bot", log, again, clock)

    def see(self, seq: int, stamp: float, mission: str, status: str = "running", plan: int = 0) -> str:
        """A state; what it was."""
        here = SystemState(
            seq, stamp, {"bot": "x"}, {}, {"Cbot": 2.0}, status=status, plan=plan, mission=mission
        )
        verdict: str = self.follower.on_state(here)
        if verdict == "ours" and self.follower.scheduler:
            self.follower.scheduler.on_state(here, stamp)
        return verdict

    def says(self, now: float) -> str:
        """The word of the command that is due."""
        player = self.follower.scheduler
        word = player.on_timer(now) if player else None
        return format_word(word) if word else ""

    @property
    def mission(self) -> Optional[str]:
        return self.follower.part.mission if self.follower.part else None


def begun(*others: Source, again: bool = False) -> Controller:
    made = Controller(Shelf(*others), again)
    made.follower.load_current()
    return made


def test_it_begins_with_the_current_mission() -> None:
    shelf = Shelf(SECOND)
    shelf.first = SECOND
    bot = Controller(shelf)
    bot.follower.load_current()
    assert (bot.mission, bot.follower.part.robots, list(bot.follower.part.poses.places)) == (B, ["bot"], ["y"])


def test_a_strategy_names_the_objectives_among_its_agents_where_their_names_do_not_tell() -> None:
    data = {**strategy("a"), "commands_agents": ["bot", "reachObj", "reachObj2"]}
    for named, robots in ({}, ["bot", "reachObj2"]), ({"objectives": ["reachObj", "reachObj2"]}, ["bot"]):
        shelf = Shelf()
        shelf.first = Source(A, strategy={**data, **named}, poses={"poses": POSES})
        bot = Controller(shelf)
        bot.follower.load_current()
        assert bot.follower.part is not None and bot.follower.part.robots == robots


def test_it_plays_the_mission_of_the_states_with_all_that_belongs_to_it() -> None:
    bot = begun(SECOND)
    assert bot.see(3, 10.0, A) == "ours" and bot.says(10.0) == "bot:a@3"
    assert bot.see(3, 20.0, B) == "ours" and bot.says(20.0) == "bot:b@3"
    assert list(bot.follower.part.poses.places) == ["y"]
    assert bot.see(4, 30.0, "") == "ours" and bot.says(30.0) == "bot:a@4", "no name: the workspace's own"


def test_where_the_own_mission_is_sent_as_well_it_is_read_anew_before_it_begins_and_not_later() -> None:
    shelf = Shelf()
    bot = Controller(shelf)
    bot.follower.load_current()
    bot.see(0, 10.0, A, "waiting")
    before = bot.follower.part
    bot.see(0, 11.0, A, "waiting")
    assert bot.follower.part is before, "nothing has changed"
    shelf.here[A] = Source(A, strategy=strategy("sent"), poses={"poses": POSES})
    assert bot.see(1, 12.0, A) == "ours" and bot.says(12.0) == "bot:a@1", "a mission that runs is left alone"
    assert bot.see(1, 13.0, A, "stopped") == "ours"
    assert bot.see(0, 20.0, A, "waiting") == "ours"
    assert bot.see(1, 21.0, A) == "ours" and bot.says(21.0) == "bot:sent@1"


def test_a_mission_that_is_not_here_is_never_played_and_looked_for_with_each_state() -> None:
    shelf = Shelf()
    bot = Controller(shelf)
    bot.follower.load_current()
    assert bot.see(3, 10.0, A) == "ours"
    for stamp in (11.0, 12.0, 13.0):
        assert bot.see(3, stamp, B) == "other"
        assert (bot.says(stamp), bot.mission, bot.follower.scheduler) == ("", None, None)
        assert B in bot.follower.trouble and bot.follower.trouble == bot.follower.report()[3]
    assert [level for level, _ in bot.logs] == ["err"], "it is said once"
    shelf.here[B] = SECOND
    assert bot.see(3, 14.0, B) == "ours"
    assert (bot.says(14.0), bot.follower.trouble) == ("bot:b@3", "")


def test_a_delayed_state_does_not_bring_back_the_mission_before() -> None:
    bot = begun(SECOND)
    bot.see(7, 10.0, A)
    bot.see(1, 12.0, B)
    assert bot.see(8, 11.0, A) == "old"
    assert (bot.mission, bot.says(12.0), bot.follower.scheduler.counts["old"]) == (B, "bot:b@1", 1)


def test_a_delayed_state_is_left_aside_while_the_new_mission_is_not_here_too() -> None:
    bot = begun()
    bot.see(7, 10.0, A)
    bot.see(1, 12.0, B)
    assert bot.see(8, 11.0, A) == "old" and bot.mission is None
    assert bot.see(8, 13.0, A) == "ours", "the observer has gone back to it"
    assert (bot.mission, bot.says(13.0)) == (A, "bot:a@8")


@pytest.mark.parametrize("mission", [A, B])
def test_after_the_observers_clock_was_set_back_nothing_of_before_is_played(mission: str) -> None:
    bot = begun(SECOND)
    bot.see(3, 5000.0, A)
    before = bot.follower.part
    assert bot.says(5000.0) == "bot:a@3"
    bot.real = 59.0
    assert bot.see(0, 1000.0, mission, "waiting") == "old"
    bot.real = 61.0
    assert bot.see(0, 1002.0, mission, "waiting") == "ours"
    assert bot.says(5100.0) == "" and bot.follower.part is not before, "its robots are told that this is over"
    assert bot.see(1, 1003.0, mission) == "ours"
    assert bot.says(1003.0) == ("bot:a@1" if mission == A else "bot:b@1")


def test_who_has_no_part_in_a_mission_commands_nothing_and_is_well() -> None:
    bot = begun(NO_PART)
    assert bot.see(1, 10.0, C) == "ours"
    assert (bot.mission, bot.follower.scheduler, bot.follower.part.robots, bot.follower.trouble) == (C, None, [], "")


def test_an_empty_strategy_is_a_part_all_the_same() -> None:
    idle = {**strategy("b"), "strategy": []}
    bot = begun(Source(B, strategy=idle, poses={"poses": POSES}))
    assert bot.see(1, 10.0, B) == "ours"
    assert bot.follower.scheduler is not None and bot.follower.part.robots == ["bot"]


@pytest.mark.parametrize("broken", [
    {"strategy": {"format": 1}, "poses": {"poses": POSES}},
    {"strategy": strategy("b"), "poses": {"poses": {"x": [1.0]}}},
    {"strategy": strategy("b"), "poses": {"poses": {"x": "there"}}},
    {"strategy": strategy("b"), "poses": DataError("damaged")},
    {"strategy": DataError("damaged"), "poses": {"poses": POSES}},
])
def test_a_mission_that_cannot_be_read_is_not_played_in_part(broken: Any) -> None:
    bot = begun(Source(B, **broken))
    bot.see(1, 10.0, A)
    assert bot.see(1, 11.0, B) == "other"
    assert bot.mission is None and bot.follower.trouble and bot.says(11.0) == ""


def test_a_damaged_current_mission_is_said_and_the_next_one_is_played() -> None:
    shelf = Shelf(SECOND)
    shelf.first = DataError("damaged")
    bot = Controller(shelf)
    with pytest.raises(DataError):
        bot.follower.load_current()
    bot.follower.reject("damaged")
    assert bot.follower.report()[3] == "damaged"
    assert bot.see(1, 10.0, A) == "ours" and bot.says(10.0) == "bot:a@1"


def plan(word: str, mission: Optional[str]) -> Dict[str, Any]:
    data = {"format": 1, "plan": 1, "strategies": {"controller_bot": strategy(word)}}
    return data if mission is None else {**data, "mission": mission}


def learn(bot: Controller, data: Dict[str, Any], now: float) -> Any:
    bot.follower.plan = data
    return bot.follower.take_plan(now)


def test_a_plan_is_learned_for_its_own_mission_only() -> None:
    bot = begun(SECOND)
    bot.see(3, 10.0, A, plan=1)
    assert learn(bot, plan("wrong", B), 10.0) is None and bot.says(10.0) == ""
    assert learn(bot, plan("right", A), 10.0) == Word("controller_bot", "_plan_", 1)
    assert bot.says(10.0) == "bot:right@3"


def test_a_plan_that_comes_before_the_states_of_its_mission_waits_for_them() -> None:
    bot = begun(SECOND)
    assert learn(bot, plan("later", B), 10.0) is None
    bot.see(3, 11.0, B, plan=1)
    assert bot.follower.take_plan(11.0) and bot.says(11.0) == "bot:later@3"
    assert bot.follower.take_plan(11.0) is None, "once"


def test_a_plan_without_a_name_is_the_workspaces() -> None:
    assert learn(begun(), plan("a", None), 10.0)


def test_plans_do_not_outlive_their_mission() -> None:
    bot = begun()
    bot.see(3, 10.0, A)
    learn(bot, plan("old", A), 10.0)
    bot.see(4, 19.0, A, "stopped")
    bot.see(0, 20.0, A, "waiting")
    bot.see(5, 21.0, A, "holding")
    assert bot.follower.scheduler.repeated_receipt() is None, "it does not have the plan that this mission may make"
    bot.see(6, 22.0, A, plan=1)
    assert bot.says(22.0) == ""


def test_a_plan_that_waits_for_its_mission_is_forgotten_where_that_begins() -> None:
    bot = begun(SECOND)
    learn(bot, plan("old", B), 10.0)
    bot.see(0, 11.0, B, "waiting")
    assert bot.follower.take_plan(12.0) is None


@pytest.mark.parametrize("data", [{"strategies": {}}, {"strategies": 7}, {}])
def test_a_plan_that_cannot_be_read_is_refused(data: Any) -> None:
    with pytest.raises(DataError):
        learn(begun(), {"format": 1, "plan": 1, **data}, 10.0)


def test_who_begins_anew_after_the_end_waits_for_the_next_mission() -> None:
    bot = begun(again=True)
    assert bot.see(40, 10.0, A, "won") == "over" and "waits" in bot.follower.report()[3]
    assert bot.see(0, 12.0, A, "waiting") == "ours" and bot.follower.report()[3] == ""
    assert bot.see(9, 13.0, A, "won") == "ours"


def test_the_doubles_of_this_test_are_like_what_they_stand_for() -> None:
    assert hasattr(pursue_missions.Source, "read") and hasattr(pursue_missions.Source, "empty")
    assert {"current", "find", "moved"} <= set(dir(Missions))
    assert Strategy(strategy("a"))
