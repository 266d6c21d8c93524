"""What rviz shows: the map, where everybody is and goes, who is late or lost, and how the mission is."""

from __future__ import annotations

import math
from typing import Any, List

import pytest

from pursue_runtime.data import DataError
from pursue_runtime.model import Model
from pursue_runtime.strategy import Strategy
from pursue_runtime.ui.markers import (
    ARROW,
    BALL,
    COLOURS,
    DISC,
    LATE,
    LINES,
    LOST,
    TEXT,
    WAITS,
    Mark,
    Picture,
    read_spots,
)
from pursue_runtime.ui.page import FloorPlan
from tests.runtime.models import model_data, mover, state, worker

ROBOTS = mover("bot", "robot", 9), mover("bot2", "robot", 9)
DATA = model_data(*ROBOTS, mover("thief", "agent", 20), worker("boy", "agent"))
MODEL = Model({**DATA, "labels": {"b": "the bank", "thief": "the thief", "screw": "mend it"}})
PLACES = {"a": (0.0, 0.0), "b": (9.0, 0.0), "s": (3.0, 4.0)}
PLAN = FloorPlan(PLACES, (("a", "b", 9.0), ("b", "s", 7.0)), (("b", "s"),))
SPOTS = {"bot2": {"b": (9.0, 0.8)}}


def shown(now: Any, group: str, picture: Any = None) -> List[Mark]:
    """What is shown in a group."""
    return [mark for mark in (picture or Picture(MODEL, PLAN, SPOTS, {})).marks(now) if mark.group == group]


def at(status: str = "running", reason: str = "", **more: Any) -> Any:
    """A state, with `lists` of agents and locations."""
    named = ("late", "lost", "held", "displaced", "returning", "out_of_service")
    lists = {key: more.pop(key) for key in named if key in more}
    return state(MODEL, 3, 100.0, {}, status, reason=reason, **more)._replace(**lists)


def text_of(now: Any, agent: str) -> Mark:
    """The text at an agent."""
    return next(mark for mark in shown(now, "names") if mark.text.partition(" (")[0].partition(":")[0] == agent)


def test_the_map_is_shown_before_the_first_state() -> None:
    for now in (None, at()):
        assert [mark.points for mark in shown(now, "places")] == [(place,) for place in PLACES.values()]
        assert [mark.text for mark in shown(now, "labels")] == ["a", "the bank", "s"]
        lines, one_way = shown(now, "ways")
        assert (lines.kind, lines.points) == (LINES, (PLACES["a"], PLACES["b"]))
        assert (one_way.kind, one_way.points) == (ARROW, (PLACES["b"], PLACES["s"]))
        assert [(mark.kind, mark.points) for mark in shown(now, "spots")] == [(DISC, ((9.0, 0.8),))]
    assert shown(None, "agents") == [] and shown(None, "mission")[0].text == "example: no state from the observer yet"


def test_who_stands_is_at_its_spot_and_nobody_hides_another() -> None:
    now = at(bot="b", bot2="b", thief="b")
    balls = shown(now, "agents")
    assert [mark.kind for mark in balls] == [BALL] * 4
    assert [mark.points[0] for mark in balls[:2]] == [PLACES["b"], SPOTS["bot2"]["b"]]
    every = [mark.points[0] for mark in balls]
    assert all(math.dist(p, q) >= 0.5 * balls[0].size for n, p in enumerate(every) for q in every[:n])
    assert [mark.text for mark in shown(now, "names")] == ["bot", "bot2", "the thief", "boy"]
    assert [mark.colour for mark in balls] == [COLOURS["robot"]] * 2 + [COLOURS["agent"]] * 2


def test_a_command_is_an_arrow_to_where_the_robot_goes() -> None:
    now = at(bot="going_a_to_b", bot2="going_b_to_a", boy="doing_screw_in_s")
    arrows = shown(now, "movements")
    assert [mark.points for mark in arrows] == [(PLACES["a"], PLACES["b"]), (SPOTS["bot2"]["b"], PLACES["a"])]
    texts = [mark.text for mark in shown(now, "names")]
    assert texts == ["bot: to the bank", "bot2: to a", "the thief", "boy: mend it"]


def test_the_next_command_of_the_strategy_is_a_pale_arrow_and_stands_behind_what_the_robot_does() -> None:
    back = {"do": "bot_b2a", "agent": "bot", "from": "b", "to": "going_b_to_a", "when": ["2 < Cbot"]}
    there = {"do": "bot2_a2b", "agent": "bot2", "from": "a", "to": "going_a_to_b", "when": ["always"]}
    table = [{"state": {"bot": "b", "bot2": "a"}, "commands": [there]},
             {"state": {"bot": "b", "bot2": "going_a_to_b"}, "commands": [back]}]  # fmt: skip
    given = {"commands_agents": ["bot", "bot2"], "reaction": "1/10", "strategy": table}
    known = {0: [Strategy(given)]}
    picture = Picture(MODEL, PLAN, SPOTS, known)
    now = at(bot="going_a_to_b")
    to_b, to_a = shown(now, "next", picture)[::-1]
    assert (to_b.kind, to_b.points) == (ARROW, (PLACES["a"], SPOTS["bot2"]["b"]))
    assert to_a.points == (PLACES["b"], PLACES["a"]) and to_a.size < shown(now, "movements")[0].size
    assert to_a.colour not in COLOURS.values()
    names = [mark.text for mark in shown(now, "names", picture)]
    assert names[:2] == ["bot: to the bank, then go to a", "bot2, next: go to the bank"]
    assert shown(at("holding", bot="going_a_to_b"), "next", picture) == []
    other = now._replace(plan=7)
    assert shown(other, "next", picture) == [], "the strategy of a plan that has not come is not known"
    known[7] = [Strategy({**given, "strategy": table[:1]})]
    assert [mark.points for mark in shown(other, "next", picture)] == [to_b.points]


@pytest.mark.parametrize(("lists", "colour", "why"), [
    ({"late": ("bot",)}, LATE, " (late)"),
    ({"late": ("bot",), "lost": ("bot",)}, LOST, " (lost)"),
    ({"late": ("bot",), "held": ("bot",)}, WAITS, " (held)"),
    ({"displaced": ("bot",), "out_of_service": ("bot",)}, WAITS, " (out of service)"),
    ({"displaced": ("bot",)}, WAITS, " (displaced)"),
    ({"displaced": ("bot",), "returning": ("bot",)}, WAITS, " (returning)"),
])  # fmt: skip
def test_who_does_not_do_what_it_should_has_another_colour_and_the_text_says_why(
    lists: Any, colour: Any, why: str
) -> None:
    now = at(bot="going_a_to_b", **lists)
    assert text_of(now, "bot").text == f"bot: to the bank{why}"
    assert text_of(now, "bot").colour == shown(now, "movements")[0].colour == colour
    assert text_of(now, "bot2").colour == COLOURS["robot"]


def test_the_status_and_its_reason_stand_above_the_map() -> None:
    (mark,) = shown(at("holding", "{bot} on its way to {b}: preempted by another node 3 times; " * 2), "mission")
    lines = mark.text.splitlines()
    assert lines[0] == "example: holding" and lines[1].startswith("bot on its way to the bank:")
    assert max(map(len, lines)) <= 60
    assert mark.points[0][1] > 4.0 and shown(at("won"), "mission")[0].text == "example: won"


@pytest.mark.parametrize(("scale", "size"), [(0.01, 0.15), (1.0, 0.6), (100.0, 1.5)])
def test_marks_fit_the_size_of_the_map(scale: float, size: float) -> None:
    places = {name: (x * scale, y * scale) for name, (x, y) in PLACES.items()}
    picture = Picture(MODEL, FloorPlan(places, ()), {}, {})
    assert [mark.size for mark in shown(None, "places", picture)] == pytest.approx([size] * 3)
    assert shown(None, "ways", picture) == []


def test_a_map_without_places_shows_nothing() -> None:
    assert Picture(MODEL, FloorPlan({}, ()), {}, {}).marks(at()) == []


def test_a_group_has_one_kind_of_thing_and_texts_have_words() -> None:
    for mark in Picture(MODEL, PLAN, SPOTS, {}).marks(at(bot="going_a_to_b")):
        assert bool(mark.text) == (mark.kind == TEXT) and mark.size > 0.0 and mark.points


def test_spots_are_read_and_wrong_ones_refused() -> None:
    assert read_spots({"spots": {"bot": {"b": [1, "2e0"], "elsewhere": [0, 0]}}}, PLAN) == {"bot": {"b": (1.0, 2.0)}}
    assert read_spots({}, PLAN) == read_spots({"spots": None}, PLAN) == {}
    for wrong in (7, [1], {"bot": 7}, {"bot": {"b": 1}}, {"bot": {"b": [1]}}, {"bot": {"b": ["x", 1]}},
                  {"bot": {"b": [float("nan"), 1]}}, {"bot": {"b": [10**400, 1]}}):  # fmt: skip
        with pytest.raises(DataError, match="spot"):
            read_spots({"spots": wrong}, PLAN)
