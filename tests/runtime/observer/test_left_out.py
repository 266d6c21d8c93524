"""Agents of whom the plan in force does not speak: what they do counts, and changes nothing for the others."""

from __future__ import annotations

from typing import Any

import pytest

from tests.runtime.observer.test_mission import CHASE, Journey

BEGINNING = """
format: 1
cover:
- state: {bot: a, rule: first, reachObj: initial_location}
  wait: [always]
- state: {bot: going_a_to_b, rule: first, reachObj: initial_location}
  wait: [always]
"""
COVER = BEGINNING + """\
- state: {bot: b, rule: first, reachObj: initial_location}
  wait: [always]
"""
WALKING = CHASE.replace(
    "locations: {b: [], gone: []}", "locations: {b: [], gone: [Cthief <= 4]}"
)


def journey(text: str = CHASE, **options: Any) -> Journey:
    made = Journey(text, COVER, **{"on_uncovered": "plan", "controllers": ("one",), "lost_after": 8.0, **options})
    made.hear("_start_", 0.0)
    return made


def test_a_command_is_not_stale_because_of_them() -> None:
    made = journey()
    assert made.hear("thief_leaves", 12.0).seq == 2
    state = made.hear("bot:bot_a2b@1", 12.05)
    assert (state.seq, state.locations["bot"], state.status) == (3, "going_a_to_b", "running")


def test_a_command_is_stale_once_somebody_moved_who_matters() -> None:
    made = journey()
    made.hear("thief_leaves", 12.0)
    made.hear("bot:bot_a2b@1", 12.05)
    assert made.hear("bot:bot_a2b@2", 12.06) is None and made.mission.counts["stale"] == 1
    assert made.hear("bot:bot_a2b@4", 12.07) is None and made.mission.counts["stale"] == 2


def test_a_command_for_a_state_before_a_hold_is_stale() -> None:
    made = journey()
    made.mission.on_controller_silent("one", 10.0)
    made.mission.on_controller_back("one", 11.0)
    made.hear("thief_leaves", 12.0)
    assert made.hear("bot:bot_a2b@1", 12.05) is None and made.mission.counts["stale"] == 1
    assert made.hear("bot:bot_a2b@3", 12.1).seq == 5


def test_an_early_command_waits_for_its_moment_whatever_they_do() -> None:
    made = journey(CHASE.replace("when: [Cbot > 1], set", "when: [Cbot > 13], set"))
    assert made.hear("bot:bot_a2b@1", 12.95) is None
    made.hear("thief_leaves", 12.97)
    moment, state = made.tick_from(12.98)
    assert moment == pytest.approx(13.0) and state.locations["bot"] == "going_a_to_b"


def test_who_is_lost_among_them_is_not_waited_for() -> None:
    made = journey(WALKING)
    assert made.hear("thief_leaves", 12.0).locations["thief"] == "gone"
    for moment in (16.2, 24.5):
        made.mission.on_time(moment)
    state = made.hear("_ping_", 40.0)
    assert (state.lost, state.status, made.mission.plan_request) == (("thief",), "running", None)
    assert made.hear("bot:bot_a2b@1", 41.0).locations["bot"] == "going_a_to_b"


def test_a_plan_that_names_everybody_is_as_before() -> None:
    made = Journey(CHASE, COVER.replace("{bot:", "{thief: b, bot:"), on_uncovered="warn")
    made.hear("_start_", 0.0)
    made.hear("thief_leaves", 12.0)
    assert made.hear("bot:bot_a2b@1", 12.05) is None and made.mission.counts["stale"] == 1


STAGES = BEGINNING + """\
- state: {bot: b, thief: gone, reachObj: initial_location}
  wait: [Cthief <= 30]
- state: {bot: b, thief: b, reachObj: initial_location}
  wait: [always]
"""
"""Only when the bot is in b does it matter where the thief is."""


def stages(text: str = WALKING) -> Journey:
    made = Journey(text, STAGES, on_uncovered="plan", controllers=("one",), lost_after=8.0)
    made.hear("_start_", 0.0)
    return made


def test_who_is_lost_holds_the_mission_as_soon_as_a_stage_names_it() -> None:
    made = stages()
    assert made.hear("thief_leaves", 12.0).locations["thief"] == "gone"
    for moment in (16.2, 24.5):
        made.mission.on_time(moment)
    state = made.hear("bot:bot_a2b@1", 25.0)
    assert (state.lost, state.status, made.mission.plan_request) == (("thief",), "running", None)
    state = made.hear("bot_going_a_to_b2b", 28.5)
    assert state.status == "holding" and state.reason.startswith("{thief} is late by 8 time units; looking for another")
    assert made.mission.plan_request is not None and made.mission.plan_request.excused == ("thief",)


def test_a_command_is_stale_as_soon_as_another_stage_has_begun() -> None:
    made = stages()
    made.hear("bot:bot_a2b@1", 2.0)
    made.hear("thief_leaves", 4.5)
    assert made.mission.counts["stale"] == 0
    made.hear("bot_going_a_to_b2b", 5.5)
    assert made.hear("bot:catch@3", 6.6) is None and made.mission.counts["stale"] == 1
    assert made.hear("bot:catch@4", 6.6) is None and made.mission.counts["impossible"] == 1  # the thief is gone


def test_what_a_stage_names_makes_commands_stale_in_it_alone() -> None:
    made = stages(CHASE)
    made.hear("bot:bot_a2b@1", 2.0)
    made.hear("bot_going_a_to_b2b", 5.5)
    made.hear("thief_leaves", 10.5)
    assert made.hear("bot:bot_nods@3", 10.6) is None and made.mission.counts["stale"] == 1


def test_clocks_are_covered_by_the_entries_that_apply() -> None:
    made = stages(CHASE)
    made.hear("thief_leaves", 12.0)
    assert made.hear("_ping_", 60.0).status == "running"
    made.hear("bot:bot_a2b@2", 60.0)
    state = made.hear("bot_going_a_to_b2b", 63.5)
    assert state.status == "holding" and "has passed; " in state.reason


def test_where_no_entry_applies_no_command_counts() -> None:
    made = Journey(CHASE, COVER.replace("bot: a", "bot: b"), on_uncovered="warn")
    made.hear("_start_", 0.0)
    made.hear("thief_leaves", 12.0)
    assert made.hear("bot:bot_a2b@1", 12.05) is None and made.mission.counts["stale"] == 1
    assert made.hear("bot:bot_a2b@2", 12.1) is None and made.mission.counts["uncommanded"] == 1


PARTS = """
format: 1
cover:
- state: {bot: a, rule: first}
  wait: [Cbot <= 20]
- state: {bot: going_a_to_b, rule: first}
  wait: [always]
- state: {dog: b, thief: b, rule: first}
  wait: [always]
- state: {dog: b, thief: gone, rule: first}
  wait: [Cthief <= 30]
"""
"""Bot and dog are commanded at the same time, and only to the dog it matters where the thief is."""


def parts(**options: Any) -> Journey:
    made = Journey(CHASE, PARTS, **{"on_uncovered": "warn", **options})
    made.hear("_start_", 0.0)
    return made


def test_what_matters_to_one_part_leaves_commands_of_the_other_alone() -> None:
    made = parts()
    made.hear("thief_leaves", 12.0)
    assert made.hear("dog:catch@1", 12.05) is None and made.mission.counts["stale"] == 1
    assert made.hear("bot:bot_a2b@1", 12.05).locations["bot"] == "going_a_to_b"
    assert made.hear("dog:catch@2", 12.06) is None and made.mission.counts["impossible"] == 1


def test_each_part_has_to_be_covered() -> None:
    made = parts(on_uncovered="plan", controllers=("one",))
    made.hear("thief_leaves", 12.0)
    assert made.hear("_ping_", 19.0).status == "running"
    moment, state = made.tick_from(19.0)
    assert moment == pytest.approx(22.1) and state.status == "holding"
    assert "has passed; " in state.reason


SHOUTING = CHASE.replace(
    "  - {from: b, to: gone,",
    "  - {from: b, to: b, word: shout, sync: send, when: [Cthief > 1], reset: [Cthief], controllable: false}\n"
    "  - {from: b, to: gone,",
    1,
)
NAMED = COVER.replace("bot:", "thief: b, bot:")


@pytest.mark.parametrize("left_out", [True, False])
def test_a_clock_that_is_left_out_makes_no_command_stale(left_out: bool) -> None:
    cover = NAMED.replace("format: 1", "format: 2\nleft_out_clocks: [Cthief]") if left_out else NAMED
    made = Journey(SHOUTING, cover, on_uncovered="plan", controllers=("one",))
    made.hear("_start_", 0.0)
    assert made.hear("shout", 6.0).seq == 2
    state = made.hear("bot:bot_a2b@1", 6.05)
    assert (made.mission.counts["stale"] == 0) is left_out
    assert (state is not None and state.locations["bot"] == "going_a_to_b") is left_out


TWICE = """
format: 1
cover:
- state: {bot: a, rule: first}
  wait: [Cbot <= 20]
- state: {bot: a, thief: b}
  wait: [always]
- state: {bot: a, thief: gone}
  wait: [always]
"""
"""To one part of the strategy for the bot it matters where the thief is, to the other it does not."""


def test_a_command_is_stale_once_anything_has_changed_that_matters_to_its_agent() -> None:
    made = Journey(CHASE, TWICE, on_uncovered="warn")
    made.hear("_start_", 0.0)
    made.hear("thief_leaves", 12.0)
    assert made.hear("bot:bot_a2b@1", 12.05) is None and made.mission.counts["stale"] == 1
    assert made.hear("bot:bot_a2b@2", 12.06).locations["bot"] == "going_a_to_b"
