"""An observer that was away takes reports at the times that they carry, before it lets a deadline pass."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any, List, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime.model import Model
from pursue_runtime.observer.journal import Journal
from pursue_runtime.observer.mission import Mission
from pursue_runtime.observer.records import read_records
from pursue_runtime.observer.returning import PATIENCE, Inbox, Returning, take_up
from pursue_runtime.strategy import read_cover
from tests.runtime.observer.test_holding import COVER
from tests.runtime.observer.test_mission import CHASE, DEADLINE
from tests.runtime.texts import read

HEADER = {"scenario": "x", "model": "1", "launch": "x"}

CALLED = [("_start_", 100.0), ("call", 110.0)]
"""The robot is called at 110, and has to answer until 115; the observer dies then."""


class Observer:
    """An observer with its journal, as the node has them."""

    def __init__(self, path: Path, model: str = DEADLINE, cover: str = "", **options: Any) -> None:
        self.logs: List[Tuple[str, str]] = []
        log = lambda level, text: self.logs.append((level, text))
        table = read_cover(read(cover)) if cover else None
        self.path = path
        self.mission = Mission(Model(read(model)), table, log, **options)
        self.journal = Journal(self.mission, str(path), HEADER, log)

    def hear(self, *words: Tuple[str, float]) -> None:
        """Words, each at its moment."""
        for word, now in words:
            self.journal.call("hear", word, now=now)

    def returns(self, floor: float, now: float, *words: str) -> List[Any]:
        """The observer is back at `now`, hears these words, and goes on; what it publishes."""
        self.journal.call("restarted", now=floor)
        returning = Returning(floor, ["/controller"], 0.0)
        for word in words:
            returning.hear(word, now)
        return returning.settle(self.mission, self.journal)

    def listens(self) -> Inbox:
        """The observer is back, and waits for what a controller has to report since 110.5."""
        self.journal.call("restarted", now=110.5)
        log = lambda level, text: self.logs.append((level, text))
        return Inbox(self.mission, self.journal, log, Returning(110.5, ["/controller"], 0.0))

    def tick(self, now: float) -> None:
        """The alarm rings."""
        self.journal.call("tick", now=now)


@pytest.fixture
def away(tmp_path: Path) -> Observer:
    """An observer that was killed after the call, and has read its journal."""
    path = tmp_path / "journal.jsonl"
    Observer(path).hear(*CALLED)
    return Observer(path)


def test_who_was_in_time_has_met_the_deadline_though_the_observer_returns_after_it(away: Observer) -> None:
    (state,) = away.returns(110.5, 130.0, "answer#2~114.200000")
    assert (state.status, state.stamp, state.locations["obj"]) == ("running", 114.2, "idle")
    away.tick(130.0)
    assert away.mission.status == "running"


@pytest.mark.parametrize("words", [(), ("answer#2",), ("answer",), ("answer#2~116.000000",), ("answer#2~900.000000",)])
def test_who_was_not_in_time_or_does_not_say_when_has_missed_it(away: Observer, words: Tuple[str, ...]) -> None:
    states = away.returns(110.5, 130.0, *words)
    away.tick(130.0)
    assert away.mission.status == "lost" and "a deadline has passed" in away.mission.reason
    assert all(115.0 < state.stamp <= 115.2 for state in states), "it is lost at the deadline, not when that is noticed"


class Suspended:
    """An observer that looked at the time at 110.5, was suspended, and goes on 20 seconds later."""

    def __init__(self, path: Path) -> None:
        self.observer = Observer(path)
        self.observer.hear(*CALLED)
        self.passed = 0.0
        log = lambda level, text: self.observer.logs.append((level, text))
        self.inbox = Inbox(self.observer.mission, self.observer.journal, log, clock=lambda: self.passed)
        assert self.inbox.next_moments(110.5)[0] == pytest.approx(115.1)
        self.passed = 20.0


@pytest.mark.parametrize("is_first", [True, False], ids=["words-first", "time-first"])
@pytest.mark.parametrize(
    "words, status",
    [
        (["answer#2", "answer#2~114.200000"], "running"),
        (["answer#2", "answer#2~115.500000"], "lost"),
        (["answer"], "lost"),
        ([], "lost"),
    ],
)
def test_an_observer_that_was_suspended_hears_first_what_was_reported_meanwhile(
    tmp_path: Path, words: List[str], status: str, is_first: bool
) -> None:
    suspended = Suspended(tmp_path / "journal.jsonl")
    inbox, mission = suspended.inbox, suspended.observer.mission
    if not is_first:
        assert inbox.on_alarm(130.5, time.monotonic()) == []
    for word in words:
        assert inbox.call("hear", word, now=130.5) == []
    inbox.on_alarm(131.0, time.monotonic())
    inbox.on_alarm(131.6, time.monotonic() + 2.0)
    inbox.on_alarm(131.7, time.monotonic() + 2.0)
    assert mission.status == status and inbox.returning is None
    assert "warn" in dict(suspended.observer.logs) and ("deadline" in mission.reason) == (status == "lost")


def test_a_word_that_comes_after_a_deadline_does_not_meet_it_though_nobody_has_looked_at_the_time(
    tmp_path: Path,
) -> None:
    suspended = Suspended(tmp_path / "journal.jsonl")
    suspended.passed = 0.5  # not for long enough to hear first what was reported
    states = suspended.inbox.call("hear", "answer", now=115.4)
    assert [state.status for state in states] == ["lost"] and 115.0 < states[0].stamp <= 115.2
    assert suspended.observer.mission.status == "lost"


def test_nothing_counts_before_the_newest_state_that_anybody_has_seen(away: Observer) -> None:
    (state,) = away.returns(112.0, 130.0, "answer#2~110.100000")
    assert (state.status, state.stamp) == ("running", 112.0)
    assert away.returns(116.0, 130.0, "bot_a2b#3~100.000000")[0].stamp == 116.0


def test_reports_count_in_the_order_of_their_times_whoever_is_heard_first(away: Observer) -> None:
    states = away.returns(110.5, 130.0, "call#2~120.000000", "answer#2~114.000000", "answer#4~121.000000")
    assert [(state.event, state.stamp, state.status) for state in states] == [
        ("answer", 114.0, "running"), ("call", 120.0, "running"), ("answer", 121.0, "running"),
    ]


def test_a_second_death_while_it_listens_loses_nothing(away: Observer, tmp_path: Path) -> None:
    away.journal.call("restarted", now=110.5)
    Returning(110.5, ["/controller"], 0.0).hear("answer#2~114.000000", 130.0)
    again = Observer(away.path)
    assert again.returns(110.5, 140.0, "answer#2~114.000000")[-1].status == "running"


def test_the_journal_leads_to_the_same_state_and_its_times_never_go_back(away: Observer) -> None:
    away.returns(110.5, 130.0, "answer#2~114.000000", "call", "nonsense#9~111.000000")
    away.tick(131.0)
    moments = [record["at"] for record in read_records(str(away.path)).records[1:]]
    assert moments == sorted(moments) and 114.0 in moments
    again = Observer(away.path)
    assert again.mission.state(140.0) == away.mission.state(140.0)


def test_who_is_late_is_late_at_its_moment_and_in_time_with_a_report_of_before(tmp_path: Path) -> None:
    options = {"on_uncovered": "plan", "lost_after": 8.0}
    for at, status in ((5.5, "running"), (13.9, "holding")):
        observer = Observer(tmp_path / f"{at}.jsonl", CHASE, COVER, **options)
        observer.hear(("_start_", 0.0), ("bot_a2b", 2.0))
        states = observer.returns(2.5, 14.0, f"bot_going_a_to_b2b#2~{at:.6f}")
        assert states[-1].locations["bot"] == "b" and states[-1].stamp == at
        assert any("late" in text for _, text in observer.logs) == (at > 6)
        assert status in [state.status for state in states]


def test_it_waits_until_everybody_has_reported_but_not_for_ever() -> None:
    returning = Returning(0.0, ["/one", "/two"], 100.0)
    assert not returning.is_over(100.0) and returning.missing() == ["/one", "/two"]
    returning.on_reported("/one")
    returning.on_reported("/somebody")
    assert not returning.is_over(100.0) and returning.missing() == ["/two"]
    assert returning.is_over(100.0 + PATIENCE)
    returning.on_reported("/two")
    assert returning.is_over(100.0)


def test_what_comes_while_it_listens_waits_until_all_have_reported(away: Observer) -> None:
    inbox = away.listens()
    assert inbox.call("hear", "answer#2~114.000000", now=130.0) == [] == inbox.on_alarm(130.0, 1.0)
    assert inbox.next_moments(130.0) == (None, PATIENCE), "no deadline of the mission is handled"
    assert inbox.on_reported("/somebody", 1.0) == [] and away.mission.seq == 2
    (state,) = inbox.on_reported("/controller", 1.0)
    assert (state.event, state.stamp, inbox.returning) == ("answer", 114.0, None)


@pytest.mark.parametrize("call", [("hear", "_stop_"), ("back", "controller"), ("tick",)])
def test_anything_but_a_word_ends_the_wait_and_comes_after_what_was_heard(
    away: Observer, call: Tuple[str, ...]
) -> None:
    inbox = away.listens()
    inbox.call("hear", "answer#2~114.000000", now=130.0)
    states = inbox.call(*call, now=130.0)
    assert (states[0].event, states[0].stamp, inbox.returning) == ("answer", 114.0, None)
    assert away.mission.status == ("stopped" if "_stop_" in call else "running")


def test_who_does_not_report_is_not_waited_for_longer_than_its_patience(away: Observer) -> None:
    inbox = away.listens()
    inbox.call("hear", "answer#2~114.000000", now=130.0)
    assert inbox.on_alarm(130.0 + PATIENCE, PATIENCE)[0].stamp == 114.0
    assert any("no answer" in text and "/controller" in text for _, text in away.logs)


def test_an_observer_listens_only_to_those_that_have_seen_the_mission(away: Observer) -> None:
    seen = {"/controller": away.mission.state(112.0), "/page": away.mission.state(111.0)}
    returning = take_up(away.mission, away.journal, seen, ["/controller"], 130.0, 0.0)
    assert returning is not None
    assert (returning.floor, returning.missing()) == (112.0, ["/controller"])
    assert take_up(away.mission, away.journal, seen, [], 130.0, 0.0) is None


def test_a_state_that_the_journal_does_not_know_stops_a_mission_at_once(away: Observer) -> None:
    other = away.mission.state(112.0)
    seen = {"/controller": other._replace(locations={**other.locations, "bot": "b"})}
    assert take_up(away.mission, away.journal, seen, ["/controller"], 130.0, 0.0) is None
    assert away.mission.status == "stopped" and "/controller knows of a state 2" in away.mission.reason


WORDS = ("call", "answer", "bot_a2b", "_failed_", "nonsense", "bot:bot_a2b@2", "_ping_", "bot:_failed_#2~113.000000 x")
TIMES = st.none() | st.floats(90, 150).map(lambda at: f"#2~{at:.6f}")


@given(st.lists(st.tuples(st.sampled_from(WORDS), TIMES), max_size=8), st.floats(110.0, 130.0))
def test_whatever_is_heard_stamps_and_journal_are_in_order_and_lead_to_the_same_state(
    tmp_path_factory: pytest.TempPathFactory, words: List[Tuple[str, Any]], floor: float
) -> None:
    path = tmp_path_factory.mktemp("returning") / "journal.jsonl"
    Observer(path).hear(*CALLED)
    away = Observer(path)
    states = away.returns(floor, 131.0, *(word + (at or "") for word, at in words))
    stamps = [floor, *(state.stamp for state in states), 131.0]
    assert stamps == sorted(stamps)
    away.tick(131.0)
    again = Observer(path)
    assert again.mission.state(140.0) == away.mission.state(140.0)
