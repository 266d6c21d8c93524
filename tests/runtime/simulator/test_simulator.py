"""The simulator ends what agents do, inside the model's window, once, and only after it was begun."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime.model import Model
from pursue_runtime.simulator.simulator import DELAYS, Delays, Simulator, end_window
from pursue_runtime.state import SystemState
from tests.runtime.models import model_data, mover, state, worker
from tests.together import HOTEL
from tests.together import model as hotel

MODEL = Model(model_data(mover("bot", "robot", 9), mover("thief", "agent", 20), worker("nurse", "human")))
EVERYBODY = ["bot", "thief", "nurse"]
ARRIVAL = "bot_going_a_to_b2b"
THIEF_ARRIVES = "thief_going_a_to_b2b#2"
"""With the number of the state in which it set off."""


def simulator(reports=EVERYBODY, delays: str = "middle", seed: int = 0, model=MODEL):
    made = Simulator(model, reports, Delays(delays, seed))
    made.on_state(state(model, 1, 100.0, {}, event="_start_"), real=0.0)
    return made


def leaves(seq: int = 2, stamp: float = 105.0, **locations: str):
    return state(MODEL, seq, stamp, {"Cbot": 0.0, "Cthief": 0.0, "Cnurse": 0.0},
                 **(locations or {"bot": "going_a_to_b"}))


def test_a_robot_stays_until_its_goal_comes() -> None:
    world = simulator()
    world.on_state(leaves(), real=1.0)
    assert world.next_moments() == (None, None)
    assert world.due(200.0, 2.0) == []
    world.on_order("bot", 105.0)
    assert world.due(113.9, 3.0) == []
    assert world.due(115.0, 3.0) == [f"{ARRIVAL}#2"]


def test_a_goal_may_be_received_before_the_state() -> None:
    world = simulator()
    world.on_order("bot", 105.0)
    world.on_state(leaves(), real=1.0)
    assert world.next_moments()[0] == pytest.approx(114.45)


def test_the_clock_may_be_behind_when_a_goal_is_received() -> None:
    """In fast simulated time a busy node hears of the time late; its robot must not stay for ever."""
    world = simulator()
    world.on_order("bot", 104.0)
    world.on_state(leaves(), real=1.0)
    assert world.next_moments()[0] is not None


def test_a_goal_starts_one_movement() -> None:
    world = simulator()
    world.on_order("bot", 105.0)
    world.on_state(leaves(), real=1.0)
    world.on_state(leaves(seq=3, stamp=105.6, bot="b"), real=2.0)
    world.on_state(leaves(seq=4, stamp=106.2), real=3.0)
    assert world.next_moments()[0] is None


def test_an_old_goal_starts_no_new_movement() -> None:
    world = simulator()
    world.on_order("bot", 103.0)
    world.on_state(leaves(), real=1.0)
    assert world.next_moments()[0] is None


DOER = Model(model_data(worker("bot", "robot")))


def at_work(stamp: float = 105.0):
    return state(DOER, 2, stamp, {"Cbot": 0.0}, bot="doing_screw_in_s")


def test_a_goal_that_is_received_again_begins_no_action() -> None:
    """A restarted controller sends its robot the goal of the movement that it knows of once more."""
    world = simulator(["bot"], model=DOER)
    world.on_order("bot", 104.9)
    world.on_state(at_work(), real=1.0)
    world.on_order("bot", 105.1)
    assert world.next_moments() == (None, None)
    world.on_order("bot", 108.0, "screw")
    assert world.next_moments()[0] == pytest.approx(111.0)


def test_an_action_may_be_received_before_the_state_and_a_goal_in_between() -> None:
    world = simulator(["bot"], model=DOER)
    world.on_order("bot", 105.0, "screw")
    world.on_order("bot", 105.0)
    world.on_state(at_work(), real=1.0)
    assert world.next_moments()[0] == pytest.approx(108.45)


def test_an_action_begins_no_movement() -> None:
    """One that is done at once, and the next command of the strategy is to go on."""
    world = simulator()
    world.on_order("bot", 104.5, "screw")
    world.on_state(leaves(), real=1.0)
    world.on_order("bot", 105.1, "screw")
    assert world.next_moments()[0] is None


def test_a_late_goal_makes_the_robot_late() -> None:
    world = simulator()
    world.on_state(leaves(), real=1.0)
    world.on_order("bot", 108.0)
    assert world.next_moments()[0] == pytest.approx(117.0)


def test_people_and_agents_need_no_goal() -> None:
    world = simulator()
    world.on_state(leaves(bot="a", thief="going_a_to_b", nurse="doing_screw_in_s"), real=1.0)
    assert world.due(109.0, 2.0) == ["screwDONE#2"]
    assert world.due(126.0, 2.0) == [THIEF_ARRIVES]


def test_only_those_that_it_reports_for() -> None:
    world = simulator(reports=["thief"])
    world.on_order("bot", 105.0)
    world.on_state(leaves(bot="going_a_to_b", nurse="doing_screw_in_s"), real=1.0)
    assert world.due(500.0, 2.0) == []


def test_an_unknown_agent_to_report_for_is_refused() -> None:
    with pytest.raises(ValueError, match="bott; the agents are bot, thief, nurse"):
        simulator(reports=["bott"])


def test_an_unknown_choice_of_delays_is_refused() -> None:
    with pytest.raises(ValueError, match="random, early, middle, late"):
        Delays("slow")


def test_each_end_is_reported_once_when_the_state_follows() -> None:
    world = simulator()
    world.on_state(leaves(bot="a", thief="going_a_to_b"), real=1.0)
    assert world.due(126.0, 2.0) == [THIEF_ARRIVES]
    assert world.due(126.0, 2.1) == []
    world.on_state(state(MODEL, 3, 126.0, {"Cthief": 0.0}, thief="b"), real=2.2)
    assert world.due(200.0, 60.0) == []
    assert world.next_moments() == (None, None)


def test_without_a_receipt_the_report_is_repeated_ever_more_slowly_until_a_state_shows_it() -> None:
    world = simulator()
    world.on_state(leaves(bot="a", thief="going_a_to_b"), real=1.0)
    assert world.due(126.0, 2.0)
    assert world.next_moments() == (None, 2.5)
    assert world.due(126.0, 2.4) == []
    assert [tenth for tenth in range(25, 200) if world.due(126.0, tenth / 10)] == [25, 35, 55, 95, 135, 175]
    world.on_state(state(MODEL, 3, 126.0, {"Cthief": 0.0}, thief="b"), real=20.0)
    assert world.due(200.0, 60.0) == [] and world.next_moments() == (None, None)


def test_a_report_is_repeated_within_the_reaction_of_the_strategy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(MODEL, "reaction", 0.1)
    world = simulator()
    world.on_state(leaves(bot="a", thief="going_a_to_b"), real=1.0)
    moments = [k / 1000 for k in range(2000, 2100) if world.due(200.0, k / 1000)]
    assert moments == pytest.approx([2.0, 2.02, 2.04, 2.06], abs=0.002)


def test_news_of_others_give_the_report_more_time() -> None:
    world = simulator()
    world.on_state(leaves(bot="a", thief="going_a_to_b"), real=1.0)
    assert world.due(126.0, 2.0)
    world.on_state(state(MODEL, 3, 126.0, {"Cthief": 21.0}, thief="going_a_to_b"), real=2.4)
    assert world.due(126.0, 2.6) == []
    assert world.due(126.0, 2.9) == [f"{THIEF_ARRIVES}~125.450000"]


def test_a_report_is_published_again_at_once_for_an_observer_that_appears_with_the_time_of_the_end() -> None:
    world = simulator()
    world.on_state(leaves(bot="a", thief="going_a_to_b"), real=1.0)
    world.say_again()
    assert world.due(124.0, 1.5) == [], "there is nothing to report"
    assert world.due(126.0, 2.0) == [THIEF_ARRIVES]
    for real in (2.0, 2.001, 700.0):
        world.say_again()
        assert world.next_moments()[1] <= real
        assert world.due(126.0 + real, real) == [f"{THIEF_ARRIVES}~125.450000"]
        assert world.due(126.0 + real, real) == []


def test_the_same_state_again_changes_nothing() -> None:
    world = simulator()
    world.on_state(leaves(bot="a", thief="going_a_to_b"), real=1.0)
    before = world.next_moments()
    world.on_state(state(MODEL, 2, 107.0, {"Cthief": 2.0}, thief="going_a_to_b"), real=3.0)
    assert world.next_moments() == before


def test_the_same_movement_again_is_a_new_one() -> None:
    world = simulator()
    world.on_state(leaves(bot="a", thief="going_a_to_b"), real=1.0)
    assert world.due(126.0, 2.0)
    world.on_state(state(MODEL, 9, 170.0, {"Cthief": 0.0}, thief="going_a_to_b"), real=3.0)
    assert world.due(171.0, 9.0) == []
    assert world.due(191.0, 9.0) == ["thief_going_a_to_b2b#9"], "with a number of its own"


def test_a_restarted_simulator_goes_on_with_robots_that_are_on_their_way() -> None:
    world = Simulator(MODEL, EVERYBODY, Delays("middle"))
    world.on_state(state(MODEL, 7, 108.0, {"Cbot": 3.0}, bot="going_a_to_b"), real=0.0)
    assert world.next_moments()[0] == pytest.approx(105.0 + 9.45)


@pytest.mark.parametrize("status", ["won", "lost", "stopped"])
def test_nobody_reports_after_the_end(status: str) -> None:
    world = simulator()
    world.on_state(leaves(bot="a", thief="going_a_to_b"), real=1.0)
    world.on_state(state(MODEL, 3, 110.0, {"Cthief": 5.0}, status, thief="going_a_to_b"), real=2.0)
    assert world.due(500.0, 9.0) == []


def test_the_agent_is_named_where_two_could_mean_it() -> None:
    model = Model(model_data(worker("bot", "robot"), worker("human", "agent")))
    world = simulator(["human"], model=model)
    world.on_state(state(model, 2, 105.0, {}, human="doing_screw_in_s"), real=1.0)
    assert world.due(109.0, 1.0) == ["human:screwDONE#2"]


def test_time_units_are_not_seconds() -> None:
    world = simulator()
    world.on_state(leaves(bot="a", thief="going_a_to_b")._replace(unit=0.1), real=1.0)
    assert world.next_moments()[0] == pytest.approx(105.0 + 2.045)


@given(st.sampled_from(DELAYS), st.integers(), st.integers(1, 50))
def test_ends_fall_inside_the_window(choice: str, seed: int, number: int) -> None:
    window = end_window(MODEL, MODEL.automaton("bot"), "going_a_to_b")
    drawn = Delays(choice, seed).draw(window, "bot", number)
    assert window == (ARRIVAL, "Cbot", 9, 10)
    assert 9 < drawn < 10
    assert drawn == Delays(choice, seed).draw(window, "bot", number)


def test_early_middle_and_late_are_in_that_order_and_seeds_differ() -> None:
    window = end_window(MODEL, MODEL.automaton("bot"), "going_a_to_b")
    early, middle, late = (Delays(c).draw(window, "bot", 1) for c in ("early", "middle", "late"))
    assert early < middle < late
    assert len({Delays("random", seed).draw(window, "bot", 1) for seed in range(5)}) == 5


@given(st.lists(st.tuples(st.floats(0, 400), st.floats(0, 30)), max_size=30))
def test_no_end_before_its_window_whenever_it_is_asked(asked: list) -> None:
    world = simulator(delays="random")
    world.on_state(leaves(bot="a", thief="going_a_to_b"), real=0.0)
    for now, real in asked:
        if world.due(now, real):
            assert now > 125.0


def test_a_state_that_comes_late_starts_nothing() -> None:
    world = simulator()
    world.on_order("bot", 105.0)
    world.on_state(leaves(), real=1.0)
    world.on_state(leaves(seq=3, stamp=115.0, bot="b"), real=2.0)
    world.on_state(leaves(), real=3.0)
    assert world.due(200.0, 4.0) == []


# What several do together ---------------------------------------------------------------------------------------------

HOUSE = hotel(HOTEL)
RIDE = "doing_ride_in_lift"
RIDING = {"porter": RIDE, "waiter": RIDE}


def riding(seq: int = 2, stamp: float = 105.0, **more: Any) -> SystemState:
    known = HOUSE.initial()
    clocks = {**known.clocks, "Cporter": stamp - 105.0, "Cwaiter": stamp - 105.0}
    return SystemState(seq, stamp, {**known.locations, **RIDING}, known.values, clocks)._replace(**more)


def test_each_robot_that_takes_part_reports_the_end_for_itself() -> None:
    world = Simulator(HOUSE, ["porter", "waiter"], Delays("middle"))
    world.on_state(SystemState(1, 100.0, HOUSE.initial().locations, {}, {}), real=0.0)
    for robot in RIDING:
        world.on_order(robot, 105.0, "ride")
    world.on_state(riding(), real=1.0)
    assert world.due(108.9, 2.0) == []
    assert sorted(world.due(109.5, 2.0)) == ["porter:rideDONE#2", "waiter:rideDONE#2"]
    assert world.next_moments()[1] is not None, "they are published again"
    world.on_state(riding(stamp=109.6, finished=("porter",)), real=2.1)
    assert world.due(120.0, 100.0) == ["waiter:rideDONE#2~109.450000"], "the state shows that the porter has finished"


def test_who_is_no_robot_does_not_report_what_another_one_does() -> None:
    people = hotel(HOTEL.replace('agent "waiter" controllable', 'agent "waiter" human controllable'))
    world = Simulator(people, ["porter", "waiter"], Delays("middle"))
    world.on_state(riding(), real=1.0)
    assert world.due(120.0, 2.0) == ["rideDONE#2"]
    window = end_window(people, people.automaton("waiter"), RIDE)
    assert window is not None and (window.clock, window.low, window.high) == ("Cwaiter", 4.0, 5.0)
