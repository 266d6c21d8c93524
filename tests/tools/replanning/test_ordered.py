"""Orders of people: what is accepted wins in the exact game, what is refused does not; what could be promised can."""

from __future__ import annotations

from typing import Any, Dict, List, Tuple

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.solving.rules import played
from pursue_gen.synthesis.solve import solve
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tools.replanning import replan
from pursue_gen.tools.replanning.request import read_request
from pursue_gen.tools.replanning.start import network_from
from pursue_runtime.model import Model, Position
from pursue_runtime.observer.ordering import effect, read_order
from pursue_runtime.observer.planning import EXACT, Ordered, PlanRequest
from tests.runtime.observer.test_ordering import DEFAULT, GAME, STORY, WON, model_data, plain

MODEL = Model(plain(model_data(WON.network, WON.objective, STORY, DEFAULT.reaction)))


def asked(age: float, *orders: str) -> Dict[str, Any]:
    """A request for the last of these orders, so long after the start; the others were accepted at once."""
    position, clocks = MODEL.initial().aged(age), {}
    for text in orders:
        done = effect(MODEL, position, read_order(text, 0.0, 1.0, MODEL))
        position, clocks = done.after(position, 0.0), done.clocks
    return {
        "format": 1, "game": GAME, **position._asdict(), "ahead": 1.0, "excused": [], "window": 2.0, "sooner": clocks,
    }  # fmt: skip


def is_won(data: Dict[str, Any]) -> bool:
    """What the solver says of the whole game, without a budget."""
    request = read_request(data)
    network = network_from(played(translate(request.scenario), request.rules), request)
    return solve(network, scenario_objective(request.scenario), request.rules.reaction).strategy is not None


TIMES = st.tuples(st.integers(0, 40), st.integers(5, 60), st.integers(12, 60))


@given(TIMES, st.permutations(["tea1", "tea2"]), st.integers(1, 2))
@settings(max_examples=40, deadline=None)
def test_answers_are_those_of_the_exact_game(times: Tuple[int, int, int], names: List[str], count: int) -> None:
    age, within, other = times
    orders = [f"{names[0]} within {other}", f"{names[1]} within {within}"][2 - count :]
    data = asked(age / 4, *orders)
    answer = replan(data, states=5000)
    assert answer["won"] == is_won(data)
    if "possible" in answer:
        later = [*orders[:-1], f"{names[1]} within {within + answer['possible']:g}"]
        assert is_won(asked(age / 4, *later))
        sooner = within + answer["possible"] - max(1.0, (60 - within) / 50) - 0.2
        assert sooner <= within or not is_won(asked(age / 4, *later[:-1], f"{names[1]} within {sooner:.1f}"))
    elif not answer["won"]:
        assert not is_won(asked(age / 4, *orders[:-1], names[1]))


OFF = st.dictionaries(st.sampled_from(["1", "2", "3"]), st.sampled_from([0.05, 0.5, 1.25]), max_size=3)


@given(st.fixed_dictionaries({"Cbot": OFF, "Cobj2": OFF}), st.lists(st.floats(-0.8, 0.8), min_size=3, max_size=3),
       st.floats(0.0, 2.0))  # fmt: skip
@settings(max_examples=200, deadline=None)
def test_a_plan_for_a_foreseen_state_begins_in_all_that_the_observer_takes_for_it(
    spread: Dict[str, Dict[str, float]], offs: List[float], since: float
) -> None:
    """Whatever the observer takes for the foreseen state is one that the plan is proven for."""
    data = asked(5.0, "tea1")
    start = network_from(played(translate(STORY), DEFAULT), read_request({**data, "spread": spread})).start
    order = Ordered("tea1", 0.0, {}, 2.0, spread)
    state = {key: data[key] for key in ("locations", "values", "clocks")}
    request = PlanRequest(1, **state, stamp=0.0, ahead=1.0, excused=(), order=order)
    moved = dict(zip(("Cbot", "Cobj", "Cobj2"), offs))
    clocks = {name: value + 1.0 + since + moved[name] for name, value in data["clocks"].items()}
    clocks.update({name: data["clocks"][name] + 1.0 + since for name in clocks if not spread.get(name)})
    ahead = request._replace(clocks={name: value + 1.0 for name, value in data["clocks"].items()})
    if ahead.is_of(Position(**{**state, "clocks": clocks}), since):
        for each in start:
            difference = (clocks[each.left] if each.left else 0.0) - (clocks[each.right] if each.right else 0.0)
            assert difference <= each.bound + 2 * EXACT, each


def test_what_is_not_foreseen_so_exactly_is_planned_for_too() -> None:
    data = asked(5.0, "tea1")
    data["locations"]["bot"], data["values"]["Pbot"], data["clocks"]["Cbot"] = "going_kitchen_to_room1", -12, 3.0
    assert replan({**data, "spread": {"Cbot": {"0": 0.5}}}, states=5000)["won"]
    soon = asked(5.0, "tea1 within 15")
    soon["locations"]["bot"], soon["values"]["Pbot"], soon["clocks"]["Cbot"] = "going_kitchen_to_room1", -12, 3.0
    assert replan(soon, states=5000)["won"]
    assert not replan({**soon, "spread": {"Cbot": {"0": 3.0, "1": 2.0}}}, states=5000)["won"]


def test_a_state_that_is_foreseen_to_the_microsecond_is_no_larger_game() -> None:
    spread = {"Cbot": {"0": 0.123457}, "Cobj2": {"1": 1.234567}}
    assert replan({**asked(5.0, "tea1"), "spread": spread}, states=5000)["won"]


def test_an_order_in_a_window_that_ends_with_an_arrival_is_looked_at_before_that() -> None:
    """Clocks above an invariant are no part of the game: a plan comes into force before what is due happens."""
    data = asked(5.0, "tea1")
    data["locations"]["bot"], data["values"]["Pbot"], data["clocks"]["Cbot"] = "going_kitchen_to_room1", -12, 9.5
    assert replan({**data, "window": 20.0}, states=5000)["won"]


@pytest.mark.parametrize(
    ("key", "value", "why"),
    [
        ("window", -1, "window is -1"),
        ("sooner", [], "sooner is"),
        ("sooner", {"Cobj": "x"}, "Cobj is"),
        ("spread", {"Cobj": 1}, "Cobj is 1"),
        ("spread", {"Cobj": {"0": -1}}, "Cobj is|0 is -1"),
    ],
)
def test_a_request_that_cannot_be_used_is_refused(key: str, value: object, why: str) -> None:
    with pytest.raises(PursueError, match=why):
        replan({**asked(2.0, "tea1"), key: value})
