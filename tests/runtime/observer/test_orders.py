"""Orders follow from commands of the strategy alone; what is done at once counts when its robot has acknowledged it."""

# ruff: noqa: E501 (automata, one edge per line)

from __future__ import annotations

from typing import Any, List

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime.orders import Order, format_order, order_text, parse_order, parse_orders
from pursue_runtime.state import format_state, parse_state
from tests.runtime.observer.test_mission import Journey

HANDOVER = """
format: 3
scenario: handover
clocks: [Cgiver, Ctaker, Creach]
variables: {Pgiver: 1, Ptaker: 1}
automata:
- name: giver
  kind: robot
  initial: mid
  locations: {mid: [], going_mid_to_end: [Cgiver <= 4], end: [], doing_lift_in_mid: [Cgiver <= 5]}
  edges:
  - {from: mid, to: mid, word: handOver, sync: send, when: [Cgiver > 1], if: [[Ptaker=1]], reset: [Cgiver], controllable: true}
  - {from: mid, to: doing_lift_in_mid, word: lift, sync: send, when: [Cgiver > 1], set: {Pgiver: 11}, reset: [Cgiver], controllable: true}
  - {from: doing_lift_in_mid, to: mid, word: liftDONE, sync: send, set: {Pgiver: 1}, reset: [Cgiver], controllable: false}
  - {from: mid, to: going_mid_to_end, word: giver_mid2end, sync: send, when: [Cgiver > 1], set: {Pgiver: -12}, reset: [Cgiver], controllable: true}
  - {from: going_mid_to_end, to: end, word: giver_going_mid_to_end2end, sync: own, when: [Cgiver > 3], set: {Pgiver: 2}, reset: [Cgiver], controllable: false}
- name: taker
  kind: robot
  reacts_to: [handOver, lift, greet]
  initial: mid
  locations: {mid: [], end: []}
  edges:
  - {from: mid, to: end, word: taker_mid2end, sync: send, set: {Ptaker: 2}, controllable: true}
- name: visitor
  kind: agent
  initial: mid
  locations: {mid: []}
  edges:
  - {from: mid, to: mid, word: greet, sync: send, controllable: false}
- name: reachObj
  kind: reach
  initial: unlocked
  locations: {unlocked: [], win: []}
  edges:
  - {from: unlocked, to: win, word: handOver, sync: receive, controllable: true}
objective: {kind: reach, goal: [reachObj, win], bad: null}
"""
EVERYWHERE = "{format: 3, cover: [{state: {}, wait: [always]}]}"


@pytest.fixture
def made() -> Journey:
    """A mission in which giver hands over to taker."""
    journey = Journey(HANDOVER, EVERYWHERE, on_uncovered="warn", lost_after=8.0)
    journey.hear("_start_", 0.0)
    return journey


def orders(state: Any) -> List[str]:
    """The orders that stand in a state, without the times at which they were given."""
    return [format_order(order._replace(given=0.0)) for order in parse_orders(state.orders)]


def sent(state: Any) -> List[str]:
    """What the controllers send for them: with the order's number, by which one that comes again is known."""
    return [order_text(order) for order in parse_orders(state.orders)]


# What is an order -----------------------------------------------------------------------------------------------------


def test_what_goes_on_stands_until_its_end_whether_acknowledged_or_not(made: Journey) -> None:
    assert orders(made.hear("giver:giver_mid2end@1", 2.0)) == ["giver:giver_mid2end@2/going_mid_to_end"]
    assert orders(made.hear("greet", 3.0))[0] == "giver:giver_mid2end@2/going_mid_to_end"
    state = made.hear("giver:_order_@2", 3.1)
    assert (state.seq, orders(state)[0]) == (3, "giver:giver_mid2end@2/going_mid_to_end+")
    assert orders(made.hear("giver_going_mid_to_end2end", 5.5)) == ["taker:greet@3/mid!"]


def test_a_partner_gets_an_order_too(made: Journey) -> None:
    assert orders(made.hear("giver:lift@1", 2.0)) == ["giver:lift@2/doing_lift_in_mid", "taker:lift@2/mid!"]


def test_what_an_uncontrollable_agent_does_with_a_robot_is_an_order_to_it(made: Journey) -> None:
    assert orders(made.hear("greet", 2.0)) == ["taker:greet@2/mid!"]


def test_who_is_elsewhere_or_lost_is_no_partner(made: Journey) -> None:
    made.hear("taker_mid2end", 1.0)
    assert orders(made.hear("greet", 2.0)) == []
    other = Journey(HANDOVER, EVERYWHERE, on_uncovered="warn")
    other.hear("_start_", 0.0)
    other.mission.lost["taker"] = "is late"
    assert orders(other.hear("greet", 2.0)) == []


@pytest.mark.parametrize("word", ["giver:giver_mid2end", "giver:lift", "giver:handOver"])
def test_what_somebody_publishes_by_hand_is_no_order(made: Journey, word: str) -> None:
    state = made.hear(word, 2.0)
    assert (state.commanded, orders(state)) == (False, [])


# When it counts -------------------------------------------------------------------------------------------------------


def test_the_mission_is_won_when_all_that_was_ordered_is_acknowledged(made: Journey) -> None:
    state = made.hear("giver:handOver@1", 2.0)
    assert (state.status, state.locations["reachObj"]) == ("running", "win")
    assert orders(state) == ["giver:handOver@2/mid!", "taker:handOver@2/mid!"]
    state = made.hear("taker:_order_@2", 2.1)
    assert (state.status, state.seq, orders(state)) == ("running", 2, ["giver:handOver@2/mid!"])
    assert made.hear("giver:_order_@1", 2.2).status == "running", "another order"
    state = made.hear("giver:_order_@2", 2.3)
    assert (state.status, state.seq, orders(state), made.mission.goal_at) == ("won", 2, [], 2.0)


def test_what_is_ordered_in_another_mission_is_no_repetition_though_its_state_has_the_same_number() -> None:
    """Whoever carries out actions goes on when a mission is over, and knows the numbers of its orders."""
    texts, receipts = [], []
    for start in (0.0, 1000.0):
        journey = Journey(HANDOVER, EVERYWHERE, on_uncovered="warn")
        journey.hear("_start_", start)
        texts.append(sent(journey.hear("giver:handOver@1", start + 2.0)))
        receipts.append([f"{name}:_order_@{text.partition('@')[2]}" for name, text in zip(("giver", "taker"), texts[-1])])
    assert texts[0] == ["handOver@2~2.000000"] * 2 and texts[1] == ["handOver@2~1002.000000"] * 2
    for receipt in receipts[0]:
        assert journey.hear(receipt, 1002.1).status == "running", "the receipt of an order of the mission before"
    assert [journey.hear(receipt, 1002.2).status for receipt in receipts[1]] == ["running", "won"]


def test_at_the_goal_nothing_but_acknowledgements_counts(made: Journey) -> None:
    made.hear("giver:handOver@1", 2.0)
    assert made.hear("greet", 2.5) is None and made.hear("giver:lift@2", 3.5) is None
    assert made.hear("taker:_failed_", 3.6) is None
    assert made.mission.on_controller_silent("controller_giver", 4.0) == []
    assert made.hear("_ping_", 5.0).status == "running"
    assert made.hear("_stop_", 5.0).status == "stopped"


def test_a_goal_whose_order_nobody_acknowledges_is_not_won(made: Journey) -> None:
    made.hear("giver:handOver@1", 2.0)
    made.hear("giver:_order_@2", 2.1)
    moment, state = made.tick_from(2.1)
    assert (moment, state.status) == (10.0, "stopped")
    assert state.reason == "{taker} has not acknowledged {handOver}"


def test_a_robot_that_acknowledges_nothing_counts_as_lost_until_it_does(made: Journey) -> None:
    made.hear("greet", 2.0)
    made.mission.on_time(10.0)
    assert made.hear("_ping_", 10.1).lost == ("taker",)
    assert made.mission.lost["taker"] == "has not acknowledged {greet}"
    assert made.hear("taker:_order_@2", 11.0).lost == ()


def test_a_mission_without_a_goal_is_not_finished_while_an_order_is_open(made: Journey) -> None:
    endless = Journey(HANDOVER.replace("goal: [reachObj, win]", "goal: null"), EVERYWHERE, on_uncovered="warn")
    endless.hear("_start_", 0.0)
    endless.hear("giver:handOver@1", 2.0)
    assert endless.hear("Finish!", 2.1).status == "running"
    assert endless.hear("taker:_order_@2", 2.2).status == "running", "one has not acknowledged yet"
    assert endless.hear("giver:_order_@2", 2.3).status == "won"


def test_a_restarted_observer_knows_what_was_not_acknowledged(made: Journey) -> None:
    state = made.hear("giver:handOver@1", 2.0)
    again = Journey(HANDOVER, EVERYWHERE, on_uncovered="warn", lost_after=8.0)
    again.mission.adopt(state._asdict(), 3.0)
    assert orders(again.hear("giver:_order_@2", 3.1)) == ["taker:handOver@2/mid!"]
    assert again.hear("taker:_order_@2", 3.2).status == "won"


def test_orders_stand_in_the_text_of_the_state(made: Journey) -> None:
    state = made.hear("giver:lift@1", 2.0)
    assert parse_state(format_state(state)).orders == state.orders


NAMES = st.from_regex(r"[A-Za-z_][A-Za-z0-9_]{0,9}", fullmatch=True)


GIVEN = st.integers(0, 10**15).map(lambda millionths: millionths / 1e6)


@given(st.builds(Order, NAMES, NAMES, st.integers(0, 10**9), NAMES, st.booleans(), st.booleans(), GIVEN))
def test_an_order_is_read_as_it_was_written(order: Order) -> None:
    assert parse_order(format_order(order)) == order


@given(st.text(max_size=30))
def test_other_texts_are_no_orders(text: str) -> None:
    found = parse_order(text)
    assert found is None or format_order(found).lstrip("0") == format_order(found)
