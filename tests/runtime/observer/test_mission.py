"""The observer's mission: what can happen happens once and in order; what cannot changes nothing."""

# ruff: noqa: E501 (automata, one edge per line)

from __future__ import annotations

from typing import Any, List, Tuple

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_runtime.data import DataError
from pursue_runtime.model import Model
from pursue_runtime.observer.mission import Mission
from pursue_runtime.strategy import read_cover
from tests.runtime.models import commanding
from tests.runtime.texts import read

CHASE = """
format: 1
scenario: chase
clocks: [Cbot, Cdog, Cthief, Creach]
variables: {Pbot: 1, Pdog: 2, Pthief: 2, Prule: 0, Sopen: 0}
automata:
- name: bot
  kind: robot
  initial: a
  locations: {a: [], b: [], going_a_to_b: [Cbot <= 4], going_b_to_a: [Cbot <= 4]}
  edges:
  - {from: a, to: going_a_to_b, word: bot_a2b, sync: send, when: [Cbot > 1], set: {Pbot: -12}, reset: [Cbot], controllable: true}
  - {from: going_a_to_b, to: b, word: bot_going_a_to_b2b, sync: own, when: [Cbot > 3], set: {Pbot: 2}, reset: [Cbot], controllable: false}
  - {from: b, to: b, word: catch, sync: send, when: [Cbot > 1], if: [[Prule=0, Prule=7], [Pthief=2]], reset: [Cbot], controllable: true}
- name: dog
  kind: robot
  initial: b
  locations: {b: []}
  edges:
  - {from: b, to: b, word: catch, sync: send, when: [Cdog > 1], if: [[Pthief=2]], reset: [Cdog], controllable: true}
- name: thief
  kind: agent
  initial: b
  locations: {b: [], gone: []}
  edges:
  - {from: b, to: b, word: catch, sync: receive, controllable: false}
  - {from: b, to: gone, word: thief_leaves, sync: send, when: [Cthief > 10], set: {Pthief: 9}, reset: [Cthief], controllable: false}
- name: rule
  kind: rule
  initial: first
  locations: {first: [], second: []}
  edges:
  - {from: first, to: second, word: catch, sync: receive, set: {Prule: 1}, controllable: true}
- name: states
  kind: states
  initial: base
  locations: {base: []}
  edges:
  - {from: base, to: base, word: catch, sync: receive, if: [[Prule=1]], set: {Sopen: 5}, controllable: true}
  - {from: base, to: base, word: catch, sync: receive, if: [[Prule=0]], set: {Sopen: 1}, controllable: true}
- name: reachObj
  kind: reach
  initial: initial_location
  locations: {initial_location: [], unlocked: [], win: []}
  edges:
  - {from: initial_location, to: unlocked, word: reachObj_going_initial_location2unlocked, sync: own, when: [Creach > 6], controllable: true}
  - {from: unlocked, to: win, word: catch, sync: receive, controllable: true}
objective: {kind: reach, goal: [reachObj, win], bad: null}
"""

DEADLINE = """
format: 1
scenario: deadline
clocks: [Cbot, Cobj]
variables: {Pbot: 1, Pdog: 2}
automata:
- name: bot
  kind: robot
  initial: a
  locations: {a: [], b: []}
  edges:
  - {from: a, to: a, word: call, sync: send, controllable: false}
  - {from: a, to: a, word: answer, sync: send, controllable: true}
  - {from: a, to: b, word: bot_a2b, sync: send, set: {Pbot: 2}, controllable: true}
- name: obj
  kind: safety
  initial: idle
  locations: {idle: [], atRisk: [Cobj <= 5], lose: []}
  edges:
  - {from: idle, to: atRisk, word: call, sync: receive, reset: [Cobj], controllable: true}
  - {from: atRisk, to: idle, word: answer, sync: receive, controllable: true}
  - {from: atRisk, to: lose, word: obj_atRisk2lose, sync: own, controllable: true}
  - {from: idle, to: lose, word: obj_idle2lose, sync: own, if: [[Pbot=2, Pbot=3], [Pdog=2]], controllable: false}
objective: {kind: safety, goal: null, bad: [obj, lose]}
"""


class Journey:
    """A mission, with what it logged, in a world where a moment is a number."""

    def __init__(self, text: str = CHASE, cover: Any = None, **options: Any) -> None:
        self.logs: List[Tuple[str, str]] = []
        model = Model(read(text))
        table = None if cover is None else read_cover(commanding(read(cover), model))
        log = lambda level, message: self.logs.append((level, message))
        self.mission = Mission(model, table, log, **options)

    def hear(self, word: str, now: float) -> Any:
        """The last state published for the word, None: none."""
        states = self.mission.on_word(word, now)
        return states[-1] if states else None

    def tick(self) -> Any:
        """What happens at the moment that the mission asked to be woken at."""
        return self.tick_from(0.0)

    def tick_from(self, now: float) -> Any:
        """The same, asked at this moment."""
        moment = self.mission.next_moment(now)
        states = self.mission.on_time(moment)
        return moment, (states[-1] if states else None)


@pytest.fixture
def chase() -> Journey:
    journey = Journey()
    journey.hear("_start_", 100.0)
    return journey


def test_nothing_counts_before_the_start() -> None:
    journey = Journey()
    assert journey.hear("bot_a2b", 90.0) is None
    state = journey.hear("_start_", 100.0)
    assert (state.seq, state.status, set(state.clocks.values())) == (1, "running", {0.0})


def test_a_second_start_changes_nothing(chase: Journey) -> None:
    assert chase.hear("_start_", 105.0) is None
    assert chase.hear("_ping_", 106.0).clocks["Creach"] == 6.0
    assert "ignored" in chase.logs[-1][1]


def test_time_alone_does_nothing_before_the_start_and_after_the_end() -> None:
    journey = Journey()
    assert journey.mission.on_time(500.0) == [], "it waits"
    journey.hear("_start_", 1000.0)
    assert journey.hear("_stop_", 1001.0).status == "stopped"
    assert journey.mission.on_time(5000.0) == [], "it is over"


def test_nothing_was_commanded_in_a_state_that_ends_the_mission() -> None:
    journey = Journey(cover=COVER)
    journey.hear("_start_", 1000.0)
    assert journey.hear("bot:bot_a2b@1", 1002.0).commanded
    assert not journey.hear("_stop_", 1003.0).commanded


def test_a_ping_shows_the_clocks_of_now_under_the_same_number(chase: Journey) -> None:
    state = chase.hear("_ping_", 102.5)
    assert (state.seq, state.clocks["Cbot"]) == (1, 2.5)


def test_time_units_may_be_longer_than_seconds() -> None:
    journey = Journey(unit=2.0)
    journey.hear("_start_", 100.0)
    assert journey.hear("_ping_", 103.0).clocks["Cbot"] == 1.5


def test_an_event_moves_its_automaton_and_resets_its_clock(chase: Journey) -> None:
    state = chase.hear("bot:bot_a2b@1", 102.0)
    assert (state.seq, state.event, state.agent) == (2, "bot_a2b", "bot")
    assert (state.locations["bot"], state.values["Pbot"]) == ("going_a_to_b", -12)
    assert (state.clocks["Cbot"], state.clocks["Creach"]) == (0.0, 2.0)


def test_all_receivers_move_and_guards_read_the_state_before(chase: Journey) -> None:
    state = chase.hear("catch", 102.0)
    assert (state.agent, state.locations["rule"], state.values["Prule"]) == ("dog", "second", 1)
    assert state.values["Sopen"] == 1  # Prule was 0 when states decided, though rule comes first in system order
    assert state.locations["reachObj"] == "initial_location"  # it had nothing to receive, and that stops nobody


def test_the_agent_named_in_a_word_does_it(chase: Journey) -> None:
    chase.hear("bot_a2b", 102.0)
    chase.hear("bot_going_a_to_b2b", 105.5)
    assert chase.hear("dog:catch@3", 107.0).agent == "dog"
    chase = Journey()
    chase.hear("_start_", 100.0)
    chase.hear("bot_a2b", 102.0)
    chase.hear("bot_going_a_to_b2b", 105.5)
    assert chase.hear("catch@3", 107.0).agent == "bot"


def test_a_stale_command_is_dropped(chase: Journey) -> None:
    chase.hear("bot:bot_a2b@1", 102.0)
    assert chase.hear("dog:catch@1", 102.001) is None
    assert (chase.mission.counts["stale"], chase.mission.seq) == (1, 2)


def test_a_command_before_its_guard_is_dropped(chase: Journey) -> None:
    assert chase.hear("bot:bot_a2b@1", 100.9) is None
    assert chase.mission.counts["impossible"] == 1
    assert "not at this moment" in chase.logs[-1][1]


def test_the_world_is_right_about_the_time(chase: Journey) -> None:
    chase.hear("bot:bot_a2b@1", 102.0)
    state = chase.hear("bot_going_a_to_b2b", 103.0)  # after 1 unit; the model says more than 3
    assert state.locations["bot"] == "b"
    assert chase.mission.counts["untimely"] == 1


def test_what_cannot_be_changes_nothing_and_says_what_could(chase: Journey) -> None:
    before = chase.mission.state(102.0)
    assert chase.hear("bot_going_a_to_b2b", 102.0) is None
    assert chase.mission.state(102.0) == before
    assert "bot_a2b, catch, thief_leaves" in chase.logs[-1][1]


def test_an_end_that_is_reported_twice_counts_once(chase: Journey) -> None:
    chase.hear("bot_a2b", 102.0)
    assert chase.hear("bot_going_a_to_b2b", 105.5).seq == 3
    assert chase.hear("bot_going_a_to_b2b", 105.5) is None


@settings(deadline=None)
@given(st.lists(st.text(max_size=12) | st.sampled_from(("bot_a2b", "catch@1", "x:catch", "_ping_")), max_size=8))
def test_no_text_harms_the_state(texts: List[str]) -> None:
    journey = Journey()
    journey.hear("_start_", 100.0)
    for text in texts:
        journey.hear(text, 100.5)
    state = journey.mission.state(100.5)
    assert set(state.locations) == {"bot", "dog", "thief", "rule", "states", "reachObj"}
    assert journey.mission.seq - 1 == journey.mission.counts["taken"]


def test_a_word_that_is_far_too_long_is_none_and_is_not_logged(chase: Journey) -> None:
    chase.hear("x" * 1000000, 102.0)
    assert chase.mission.counts["unreadable"] == 1 and len(chase.logs[-1][1]) < 200


@pytest.mark.parametrize("word", ["tb3_0:_order_@3", "tb3_0:catchDONE", "tb3_0:tb3_0_a2b"])
def test_a_word_that_begins_with_a_namespace_is_told_what_it_should_begin_with(chase: Journey, word: str) -> None:
    assert chase.hear(word, 102.0) is None and chase.mission.counts["impossible"] == 1
    said = chase.logs[-1][1]
    assert said.startswith(f"{word}: nobody is called tb3_0; expected the name of an agent of the scenario")
    assert "(bot, dog, thief)" in said


def test_the_goal_wins(chase: Journey) -> None:
    assert chase.hear("reachObj:reachObj_going_initial_location2unlocked@1", 105.0) is None
    assert chase.hear("reachObj:reachObj_going_initial_location2unlocked@1", 106.5).status == "running"
    assert chase.hear("dog:catch@2", 107.0).status == "running"
    assert chase.hear("dog:_order_@3", 107.1).status == "won"
    assert chase.hear("dog:catch@3", 109.0) is None


def test_a_stop_ends_with_its_reason(chase: Journey) -> None:
    state = chase.hear("_stop_", 103.0)
    assert (state.status, state.seq) == ("stopped", 1) and "_stop_" in state.reason
    assert chase.mission.next_moment(103.0) is None
    assert chase.hear("_ping_", 200.0).clocks["Cbot"] == 3.0


def test_finish_from_elsewhere_does_not_win_a_goal(chase: Journey) -> None:
    assert chase.hear("Finish!", 103.0) is None
    assert chase.mission.status == "running"


def test_finish_ends_a_mission_that_only_has_to_be_safe() -> None:
    journey = Journey(DEADLINE)
    journey.hear("_start_", 0.0)
    assert journey.hear("Finish!", 3.0).status == "won"


def test_a_robot_that_is_late_is_reported_once_and_may_still_arrive(chase: Journey) -> None:
    chase.hear("bot_a2b", 102.0)
    moment = chase.mission.next_moment(102.0)
    assert moment == pytest.approx(106.1)
    assert chase.mission.on_time(moment) == [] and chase.mission.late == {"bot"}
    assert chase.mission.next_moment(moment) == pytest.approx(136.0)
    assert chase.hear("bot_going_a_to_b2b", 120.0).locations["bot"] == "b"
    assert not chase.mission.late


# Safety objectives ----------------------------------------------------------------------------------------------------


def test_a_deadline_that_passes_is_lost() -> None:
    journey = Journey(DEADLINE)
    journey.hear("_start_", 0.0)
    assert journey.mission.next_moment(1.0) is None
    journey.hear("call", 1.0)
    moment = journey.mission.next_moment(1.0)
    assert moment == pytest.approx(6.1)
    assert journey.mission.on_time(5.9) == []
    state = journey.mission.on_time(moment)[-1]
    assert (state.status, state.locations["obj"]) == ("lost", "lose") and state.reason == "a deadline has passed"


def test_a_deadline_has_passed_when_the_tolerance_for_late_messages_is_over_and_no_sooner() -> None:
    journey = Journey(DEADLINE)
    journey.hear("_start_", 0.0)
    journey.hear("call", 1.0)
    assert journey.mission.on_time(6.05) == [] and journey.mission.status == "running"
    assert journey.mission.next_moment(6.05) == pytest.approx(6.1)
    assert journey.hear("answer", 6.05).status == "running" and journey.mission.on_time(6.2) == []


def test_the_deadline_of_a_watcher_is_no_loss_of_the_mission() -> None:
    """It is the strategy's own: it has no decision any more, and a new plan is asked for."""
    watched = DEADLINE.replace("bad: [obj, lose]", "bad: null")
    cover = "format: 1\ncover:\n- state: {obj: idle}\n  wait: [always]\n- state: {obj: atRisk}\n  wait: [always]\n"
    journey = Journey(watched, cover, on_uncovered="plan", controllers=("one",))
    journey.hear("_start_", 0.0)
    journey.hear("call", 1.0)
    _, state = journey.tick_from(1.0)
    assert state.locations["obj"] == "lose" and state.status == "holding", state
    assert not journey.mission.late


def test_an_answer_in_time_lifts_the_deadline() -> None:
    journey = Journey(DEADLINE)
    journey.hear("_start_", 0.0)
    journey.hear("call", 1.0)
    assert journey.hear("answer", 5.5).locations["obj"] == "idle"
    assert journey.mission.next_moment(5.5) is None


def test_agents_that_must_never_meet_lose_as_soon_as_they_do() -> None:
    journey = Journey(DEADLINE)
    journey.hear("_start_", 0.0)
    states = journey.mission.on_word("bot_a2b", 1.0)
    assert [(state.seq, state.agent, state.status) for state in states] == [(2, "bot", "running"), (3, "obj", "lost")]


# Several objectives ---------------------------------------------------------------------------------------------------

SEVERAL = """
format: 2
scenario: several
clocks: [Cbot, Creach, Creach2, Cobj]
variables: {Pbot: 1}
automata:
- name: bot
  kind: robot
  initial: a
  locations: {a: []}
  edges:
  - {from: a, to: a, word: load, sync: send, controllable: true}
  - {from: a, to: a, word: wave, sync: send, controllable: true}
  - {from: a, to: a, word: fall, sync: send, controllable: true}
- name: obj
  kind: safety
  initial: idle
  locations: {idle: [], lose: []}
  edges:
  - {from: idle, to: lose, word: fall, sync: receive, controllable: true}
- name: reachObj
  kind: reach
  initial: initial_location
  locations: {initial_location: [Creach <= 9], unlocked: [Creach <= 9], win: [], late: []}
  edges:
  - {from: initial_location, to: unlocked, word: reachObj_going_initial_location2unlocked, sync: own, controllable: true}
  - {from: initial_location, to: late, word: reachObj_going_initial_location2late, sync: own, controllable: true}
  - {from: unlocked, to: win, word: load, sync: receive, controllable: true}
  - {from: unlocked, to: late, word: reachObj_going_unlocked2late, sync: own, controllable: true}
- name: reachObj2
  kind: reach
  initial: initial_location
  locations: {initial_location: [], win: []}
  edges:
  - {from: initial_location, to: win, word: wave, sync: receive, controllable: true}
objective: {kind: reach-while-safe, goal: [[reachObj, win], [reachObj2, win]], bad: [[obj, lose], [reachObj, late]], says: {obj: avoid fall, reachObj: do load within 9, reachObj2: do wave}}
"""
UNLOCK = "reachObj_going_initial_location2unlocked"


@pytest.mark.parametrize("order", [("load", "wave"), ("wave", "load")])
def test_it_is_won_where_all_goals_are_reached_in_any_order(order: Tuple[str, str]) -> None:
    journey = Journey(SEVERAL)
    for word, now in (("_start_", 0.0), (UNLOCK, 1.0), (order[0], 2.0)):
        assert journey.hear(word, now).status == "running"
    assert journey.hear("Finish!", 2.5) is None, "a goal is left"
    assert journey.hear(order[1], 3.0).status == "won"


def test_any_of_several_bad_locations_loses() -> None:
    journey = Journey(SEVERAL)
    journey.hear("_start_", 0.0)
    journey.hear("wave", 1.0)
    state = journey.hear("fall", 2.0)
    assert (state.status, state.reason) == ("lost", "{bot} does {fall} (broken: avoid fall)")


@pytest.mark.parametrize("unlocked", [False, True])
def test_the_deadline_of_a_goal_passes_wherever_it_waits(unlocked: bool) -> None:
    journey = Journey(SEVERAL)
    journey.hear("_start_", 0.0)
    if unlocked:
        journey.hear(UNLOCK, 1.0)
    moment = journey.mission.next_moment(1.0)
    assert moment == pytest.approx(9.1)
    state = journey.mission.on_time(moment)[-1]
    assert (state.status, state.locations["reachObj"]) == ("lost", "late")
    assert state.reason == "a deadline has passed (broken: do load within 9)"


# Cover ----------------------------------------------------------------------------------------------------------------

COVER = """
format: 1
cover:
- state: {bot: a, rule: first}
  wait: [Cbot <= 3]
- state: {bot: going_a_to_b}
  wait: [Cbot - Creach <= -2 && Cbot <= 4]
- state: {bot: b}
  wait: []
"""


def test_a_covered_state_goes_on_and_one_that_is_not_stops() -> None:
    journey = Journey(cover=COVER)
    journey.hear("_start_", 0.0)
    assert journey.hear("bot_a2b", 2.0).status == "running"
    state = journey.hear("bot_going_a_to_b2b", 5.5)
    assert state.status == "stopped" and state.reason == "this happened at another time than the strategy expects; {bot} is at {b}"


def test_clocks_may_be_beside_a_zone_by_the_tolerance_and_no_more() -> None:
    for moment, status in ((1.95, "running"), (1.85, "stopped")):
        journey = Journey(cover=COVER)
        journey.hear("_start_", 0.0)
        assert journey.hear("bot_a2b", moment).status == status


COMMANDING = """
format: 3
cover:
- state: {bot: a}
  wait: [Cbot <= 3]
  commands:
  - {do: bot_a2b, agent: bot, when: [3 < Cbot && Cbot <= 9]}
- state: {bot: going_a_to_b}
  wait: [always]
"""


def commanded() -> Journey:
    """A mission, under way, whose strategy has the bot leave a from 3 on."""
    model = Model(read(CHASE))
    journey = Journey()
    journey.mission = Mission(model, read_cover(read(COMMANDING)), lambda *said: journey.logs.append(said))
    journey.hear("_start_", 0.0)
    return journey


def test_a_command_that_the_strategy_does_not_hold_in_the_state_is_refused() -> None:
    journey = commanded()
    for word in ("bot:catch@1", "thief:thief_leaves@1", "thief_leaves@1"):
        assert journey.hear(word, 4.0) is None
    assert journey.mission.counts["uncommanded"] == 3
    assert journey.logs[-1] == ("warn", "thief_leaves@1: the strategy does not command it here")


DOG_ALONE = """
format: 3
cover:
- state: {thief: b}
  wait: [Cdog <= 3]
  commands:
  - {do: catch, agent: dog, when: [3 < Cdog]}
"""


def test_a_command_without_an_agent_is_for_the_one_whom_the_strategy_commands_it() -> None:
    journey = Journey()
    strategy = read_cover(read(DOG_ALONE))
    journey.mission = Mission(Model(read(CHASE)), strategy, lambda *said: journey.logs.append(said))
    journey.hear("_start_", 0.0)
    journey.hear("bot_a2b", 2.0)
    journey.hear("bot_going_a_to_b2b", 5.5)  # now the bot, the first in system order, could catch as well
    state = journey.hear("catch@3", 7.0)
    assert state.commanded and state.agent == "dog"


def test_a_command_counts_from_when_the_strategy_commands_it_also_if_it_comes_late() -> None:
    journey = commanded()
    assert journey.hear("bot:bot_a2b@1", 2.0) is None
    assert journey.logs[-1] == ("warn", "bot:bot_a2b@1: the strategy does not command it yet")
    assert commanded().hear("bot_a2b@1", 3.1).commanded
    assert commanded().hear("bot:bot_a2b@1", 9.05).locations["bot"] == "going_a_to_b"


def test_it_may_go_on_without_cover() -> None:
    journey = Journey(cover=COVER, on_uncovered="warn")
    journey.hear("_start_", 0.0)
    assert journey.hear("bot_a2b", 1.5).status == "running"
    assert journey.mission.counts["uncovered"] == 1


def test_a_model_with_something_amiss_is_reported() -> None:
    for broken in (CHASE.replace("initial: a", "initial: z"), CHASE.replace("Cbot > 1", "Cbot ~ 1"), "format: 1"):
        with pytest.raises(DataError):
            Model(read(broken))


# Commands of machines whose clocks are ahead --------------------------------------------------------------------------


def test_a_command_that_is_early_by_little_waits_for_its_moment(chase: Journey) -> None:
    assert chase.hear("bot:bot_a2b@1", 100.95) is None
    moment, state = chase.tick_from(100.95)
    assert moment == pytest.approx(101.0, abs=1e-4) and state.locations["bot"] == "going_a_to_b"
    assert chase.mission.counts["impossible"] == 0


def test_a_command_that_is_too_early_is_dropped(chase: Journey) -> None:
    assert chase.hear("bot:bot_a2b@1", 100.5) is None
    assert chase.mission.counts["impossible"] == 1 and chase.mission.next_moment(100.5) is None


def test_an_early_command_that_an_event_overtakes_is_stale(chase: Journey) -> None:
    chase.hear("bot:bot_a2b@1", 100.95)
    chase.hear("bot_a2b", 100.99)
    assert chase.hear("_ping_", 101.1).seq == 2
    assert chase.mission.on_time(101.1) == [] and chase.mission.seq == 2
