"""What several do together ends when all robots that take part have reported it, or when the one who does it has."""

from __future__ import annotations

from typing import Any, List, Optional, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime.model import Model
from pursue_runtime.observer.mission import Mission
from pursue_runtime.observer.reports import ALL, DOER
from pursue_runtime.state import SystemState, format_state, parse_state
from tests.runtime.models import everywhere
from tests.together import CARRY, HOTEL, model

RIDE = "doing_ride_in_lift"


class Story:
    """A mission of the hotel; the waiter has come to the lift, where the porter begins the ride at 5."""

    def __init__(self, whose: str = ALL, found: Optional[Model] = None) -> None:
        self.logs: List[Tuple[str, str]] = []
        log = lambda level, text: self.logs.append((level, text))
        played = found or model(HOTEL)
        self.mission = Mission(
            played, everywhere(played), log, on_uncovered="warn", lost_after=10.0, shared_ends=whose
        )
        for at, word in (
            (0.0, "_start_"), (1.5, "waiter:waiter_lobby2lift"), (3.9, "waiter_going_lobby_to_lift2lift"),
            (5.0, "porter:ride"),
        ):  # fmt: skip
            self.hear(at, word)

    def hear(self, at: float, word: str) -> List[SystemState]:
        """Takes a word."""
        return self.mission.on_word(word, at)

    def at(self, at: float) -> Tuple[str, str]:
        """Where porter and waiter are."""
        where = self.mission.state(at).locations
        return where["porter"], where["waiter"]

    def state(self, at: float) -> SystemState:
        return self.mission.state(at)


@pytest.fixture
def story() -> Story:
    made = Story()
    assert made.at(5.0) == (RIDE, RIDE)
    return made


def test_it_ends_with_the_last_report(story: Story) -> None:
    (first,) = story.hear(9.2, "porter:rideDONE")
    assert (first.finished, first.seq, first.status) == (("porter",), 4, "running")
    assert story.at(9.2) == (RIDE, RIDE)
    last = story.hear(9.6, "waiter:rideDONE")[0]
    assert (last.finished, last.seq, last.agent, last.event) == ((), 5, "porter", "rideDONE")
    assert story.at(9.6) == ("lift", "lift") and story.mission.counts["untimely"] == 0


def test_the_order_of_the_reports_does_not_matter(story: Story) -> None:
    assert story.hear(9.2, "waiter:rideDONE")[0].finished == ("waiter",)
    assert story.hear(9.3, "waiter:rideDONE")[0].finished == ("waiter",), "published again"
    assert story.hear(9.6, "porter:rideDONE")[0].agent == "porter" and story.at(9.6) == ("lift", "lift")


def test_a_command_that_is_under_way_meanwhile_is_not_stale(story: Story) -> None:
    """The number of the state does not change with a report that changes nothing."""
    before = story.state(9.0).seq
    story.hear(9.2, "waiter:rideDONE")
    assert story.state(9.2).seq == before


def test_a_word_without_an_agent_is_of_the_one_who_does_it(story: Story) -> None:
    assert story.hear(9.2, "rideDONE")[0].finished == ("porter",)
    assert story.at(9.2) == (RIDE, RIDE)


def test_by_the_option_the_one_who_does_it_ends_it() -> None:
    story = Story(DOER)
    assert story.hear(9.2, "waiter:rideDONE")[0].finished == ("waiter",) and story.at(9.2) == (RIDE, RIDE)
    assert story.hear(9.4, "porter:rideDONE")[0].event == "rideDONE" and story.at(9.4) == ("lift", "lift")
    assert Story(DOER).hear(9.4, "porter:rideDONE")[0].event == "rideDONE", "the partner has said nothing"


def test_who_has_not_reported_is_late(story: Story) -> None:
    story.hear(9.2, "porter:rideDONE")
    moment = story.mission.next_moment(9.2)
    assert moment == pytest.approx(10.1, abs=0.01)
    story.mission.on_time(10.2)
    assert story.state(10.2).late == ("waiter",)
    following = story.mission.next_moment(10.2)
    assert following is not None and following > 15.0, "it does not wake up again and again"


def test_both_are_late_where_nobody_has_reported(story: Story) -> None:
    story.mission.on_time(10.2)
    assert story.state(10.2).late == ("porter", "waiter")
    story.hear(11.0, "waiter:rideDONE")
    assert story.state(11.0).late == ("porter",)


def test_it_does_not_wait_for_a_partner_that_is_lost(story: Story) -> None:
    story.hear(9.2, "porter:rideDONE")
    story.mission.on_time(10.2)
    states = story.mission.on_time(20.2)
    assert states[0].event == "rideDONE" and story.at(20.2) == ("lift", "lift")
    assert story.state(20.2).lost == ("waiter",), "that it has ended says nothing of the waiter"
    story.hear(25.0, "waiter:rideDONE")
    assert story.state(25.0).lost == (), "it has reported what it owed"
    assert story.at(25.0) == ("lift", "lift")


@pytest.mark.parametrize("first", ["waiter:_failed_", "porter:rideDONE"])
def test_a_partner_that_fails_is_lost_at_once(story: Story, first: str) -> None:
    words = ["waiter:_failed_", "porter:rideDONE"]
    story.hear(9.1, first)
    assert story.at(9.1) == (RIDE, RIDE)
    story.hear(9.5, next(word for word in words if word != first))
    assert story.at(9.5) == ("lift", "lift") and story.state(9.5).lost == ("waiter",)


def test_one_who_was_lost_and_reports_in_time_counts_again(story: Story) -> None:
    story.hear(7.0, "waiter:_failed_")
    assert story.state(7.0).lost == ("waiter",)
    assert story.hear(9.3, "waiter:rideDONE")[0].lost == ()
    story.hear(9.5, "porter:rideDONE")
    assert story.at(9.5) == ("lift", "lift") and story.state(9.5).lost == ()


def test_where_the_one_who_does_it_fails_its_partner_is_not_free(story: Story) -> None:
    story.hear(9.0, "waiter:rideDONE")
    story.hear(9.1, "porter:_failed_")
    assert story.at(9.1) == (RIDE, RIDE) and story.state(9.1).lost == ("porter",)
    story.hear(15.0, "porter:rideDONE")
    assert story.at(15.0) == ("lift", "lift") and story.state(15.0).lost == ()


def test_who_is_no_robot_reports_nothing() -> None:
    found = model(HOTEL.replace('agent "waiter" controllable', 'agent "waiter" human controllable'))
    story = Story(found=found)
    assert story.at(5.0) == (RIDE, RIDE)
    story.hear(9.2, "waiter:rideDONE")
    assert story.mission.counts["impossible"] == 1 and story.at(9.2) == (RIDE, RIDE)
    story.hear(9.4, "porter:rideDONE")
    assert story.at(9.4) == ("lift", "lift")


def test_only_those_who_take_part_are_waited_for() -> None:
    """bot2 is elsewhere: the child alone takes part, and reports nothing."""
    mission = Mission(model(CARRY), everywhere(model(CARRY)), lambda level, text: None, on_uncovered="warn")
    words = [
        (0.0, "_start_"), (1.2, "child_van2ramp"), (3.5, "child_going_van_to_ramp2ramp"), (4.6, "child_ramp2store"),
        (8.8, "child_going_ramp_to_store2store"), (10.0, "bot1:lift"),
    ]  # fmt: skip
    for at, word in words:
        mission.on_word(word, at)
    where = mission.state(10.0).locations
    assert (where["bot1"], where["child"], where["bot2"]) == ("doing_lift_in_store", "doing_lift_in_store", "ramp")
    mission.on_word("child_store2ramp", 11.5)
    assert mission.state(11.5).locations["child"] == "doing_lift_in_store", "it is busy"
    mission.on_word("bot1:liftDONE", 13.4)
    assert mission.state(13.4).locations["bot1"] == mission.state(13.4).locations["child"] == "store"


def test_the_state_and_its_text_know_who_has_reported(story: Story) -> None:
    story.hear(9.2, "waiter:rideDONE")
    state = story.state(9.2)
    again = parse_state(format_state(state))
    assert again is not None and again.finished == ("waiter",)
    other = Story()
    other.mission.adopt(state._asdict(), 9.4)
    other.hear(9.5, "porter:rideDONE")
    assert other.at(9.5) == ("lift", "lift")


def test_each_report_comes_to_the_journal(story: Story) -> None:
    before = story.mission.revision()
    story.hear(9.2, "waiter:rideDONE")
    between = story.mission.revision()
    story.hear(9.3, "waiter:rideDONE")
    assert between != before and story.mission.revision() == between


WORDS = ("porter:rideDONE", "waiter:rideDONE", "rideDONE", "waiter:_failed_", "porter:_failed_", "guest:call", "junk")
CALLS = st.lists(st.tuples(st.sampled_from((*WORDS, "")), st.floats(0.0, 6.0)), max_size=12)


@given(CALLS, st.sampled_from((ALL, DOER)))
def test_whatever_comes_both_leave_together_and_nobody_is_waited_for_in_vain(calls: Any, whose: str) -> None:
    story, now, reported = Story(whose), 5.0, set()
    for word, later in calls:
        now += later
        before = story.at(now)
        story.hear(now, word) if word else story.mission.on_time(now)
        assert story.at(now) in ((RIDE, RIDE), ("lift", "lift"))
        if before == (RIDE, RIDE):
            reported |= {word.partition(":")[0] or "porter"} if word.endswith("rideDONE") else set()
            reported |= {"porter"} if word == "rideDONE" else set()
            ended = story.at(now) == ("lift", "lift")
            lost = set(story.state(now).lost)
            done = "porter" in reported and (whose == DOER or "waiter" in reported | lost)
            assert ended == done, (word, reported, lost)
        moment = story.mission.next_moment(now)
        if moment is not None and moment <= now:
            story.mission.on_time(now)
            following = story.mission.next_moment(now)
            assert following is None or following > now, "the observer would never sleep"
