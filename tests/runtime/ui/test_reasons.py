"""The page says what the strategy does next, and why: as far as the strategy says so, and no further."""

from __future__ import annotations

from typing import Any, Dict, List, Tuple

import pytest

from pursue_runtime.data import DataError
from pursue_runtime.model import Model
from pursue_runtime.strategy import Strategy
from pursue_runtime.ui.course import course
from pursue_runtime.ui.outlook import Outlook, reason_text, reasons
from pursue_runtime.ui.page import Facts, FloorPlan, Page
from pursue_runtime.ui.statuses import Status
from pursue_runtime.ui.strategies import strategies_in, strategies_of
from tests.runtime.models import model_data, mover, state, worker

DATA = model_data(mover("bot", "robot", 9), mover("thief", "agent", 20), worker("arm", "robot"))
DATA["automata"][0]["edges"].append({"from": "a", "to": "a", "word": "rest", "sync": "own", "controllable": True})
MODEL = Model(DATA)
RULE = Status("Prule", "bag", {"0": "next: screw", "1": "screw done"})

Place = Tuple[str, str, int]
"""Where bot and thief are, and the rule."""


def strategy(entries: Dict[Place, List[Tuple[str, str, str, str, str]]]) -> Strategy:
    """`entries`: place → commands (event, agent, from, to, when)."""
    names = ("do", "agent", "from", "to")
    table = [
        {"state": dict(zip(("bot", "thief", "Prule"), place)),
         "commands": [{**dict(zip(names, command)), "when": [command[4]]} for command in commands]}
        for place, commands in entries.items()
    ]  # fmt: skip
    return Strategy({"commands_agents": ["bot", "arm"], "reaction": "1/10", "strategy": table})


GO = ("bot_a2b", "bot", "a", "going_a_to_b", "2 < Cbot")
BACK = ("bot_b2a", "bot", "b", "going_b_to_a", "2 < Cbot")
SCREW = ("screw", "arm", "s", "doing_screw_in_s", "1 < Carm")
REST = ("rest", "bot", "a", "a", "always")
ASKED = ("a", "a", 0)


def why(entries: Dict[Place, List[Tuple[str, str, str, str, str]]], **values: int) -> str:
    now = state(MODEL, 1, 0.0, {}, values=values)
    return reason_text(MODEL, (RULE,), now, reasons(strategy(entries), now, "bot", "bot_a2b"))


def test_an_agent_is_a_reason_where_the_strategy_does_something_else_if_it_is_elsewhere() -> None:
    assert why({ASKED: [GO], ("a", "b", 0): [REST]}) == "because thief is at a (if it were at b: do rest)"
    under_way = {("a", "going_a_to_b", 0): [REST], ("a", "b", 0): [REST]}
    assert why({ASKED: [GO], **under_way}) == "because thief is at a (if it were at b: do rest)"


def test_a_rule_is_a_reason_in_its_own_words() -> None:
    assert why({ASKED: [GO], ("a", "a", 1): [REST]}) == "because bag: next: screw"


@pytest.mark.parametrize("other", [
    {("a", "b", 0): [GO]},  # the same command
    {("a", "b", 0): [REST, GO]},  # the same command, later
    {("a", "b", 0): [SCREW]},  # nothing for this robot: another one comes first
    {("a", "b", 0): []},
    {("a", "b", 1): [REST]},  # two things differ
    {("b", "a", 0): [BACK]},  # the robot itself is elsewhere
    {},
])
def test_no_reason_is_invented(other: Any) -> None:
    assert why({ASKED: [GO], **other}) == ""


def test_two_reasons_are_said_and_agents_come_first() -> None:
    both = {ASKED: [GO], ("a", "a", 1): [REST], ("a", "b", 0): [REST]}
    assert why(both) == "because thief is at a (if it were at b: do rest), and because bag: next: screw"


def test_the_course_is_what_comes_if_nobody_else_begins_anything() -> None:
    known = strategy({ASKED: [GO], ("b", "a", 0): [SCREW]})
    steps = course(MODEL, [known], state(MODEL, 1, 50.0, {}))
    assert [(step.agent, step.does, step.commanded) for step in steps] == [
        ("bot", "go to b", True), ("bot", "arrive at b", False), ("arm", "begin screw", True),
    ]  # fmt: skip
    assert 2.0 < steps[0].after < 2.1 and 11.0 < steps[1].after < 11.2, "as early as the model allows"
    assert steps[2].after == pytest.approx(steps[1].after), "and no further than the goal"


def test_the_course_goes_on_with_what_is_under_way_and_does_not_wait_for_the_lost() -> None:
    known = strategy({("b", "a", 0): [BACK], ("b", "b", 0): [SCREW]})
    both = state(MODEL, 5, 50.0, {"Cbot": 4.0, "Cthief": 19.0}, bot="going_a_to_b", thief="going_a_to_b")
    assert [step.does for step in course(MODEL, [known], both)] == ["arrive at b", "arrive at b", "begin screw"]
    alone = course(MODEL, [known], both._replace(lost=("bot",)))
    assert [(step.agent, step.does) for step in alone] == [("thief", "arrive at b")]
    late = state(MODEL, 5, 50.0, {"Cbot": 14.0}, bot="going_a_to_b")
    assert course(MODEL, [known], late)[0].after == 0.0


@pytest.mark.parametrize("status", ["waiting", "holding", "won", "stopped"])
def test_a_mission_that_does_not_run_has_no_course(status: str) -> None:
    assert course(MODEL, [strategy({ASKED: [GO]})], state(MODEL, 1, 50.0, {}, status=status)) == []


def test_the_course_ends_where_somebody_else_has_to_act() -> None:
    data = model_data(mover("bot", "robot", 9), mover("thief", "agent", 20))
    data["automata"][1]["locations"]["a"] = ["Cthief <= 1"]
    waiting = strategy({ASKED: [GO]})
    assert course(Model(data), [waiting], state(Model(data), 1, 50.0, {})) == []


def sight(page: Page, now: Any) -> Tuple[Dict[str, Any], Dict[str, Any]]:
    """The view, and the row of bot in it."""
    page.on_state(now, now.stamp)
    view = page.view(Facts("running", (), now, now.stamp, now.stamp))
    return view, next(agent for agent in view["agents"] if agent["name"] == "bot")


GOES = strategy({ASKED: [GO], ("a", "b", 0): [REST], ("b", "a", 0): [SCREW], ("going_a_to_b", "b", 0): []})


def test_the_page_keeps_the_reason_as_long_as_the_robot_does_what_it_was_sent_for() -> None:
    page = Page(MODEL, FloorPlan({}, ()), strategies={0: (GOES,)})
    view, bot = sight(page, state(MODEL, 1, 0.0, {}))
    assert bot["then"]["does"] == "go to b" and 2.0 < bot["then"]["at"] < 2.1 and bot["why"] == ""
    assert bot["then"]["certain"]
    assert view["next"]["says"] == "bot is to go to b" and view["planned"]
    away = state(MODEL, 2, 3.0, {"Cbot": 0.0}, event="bot_a2b", agent="bot", bot="going_a_to_b")
    away = away._replace(commanded=True)
    view, bot = sight(page, away)
    assert bot["why"] == "because thief is at a (if it were at b: do rest)"
    assert view["next"]["says"] == "arm is to begin screw" and not view["next"]["certain"], "bot has to arrive before"
    _, bot = sight(page, away._replace(seq=3, stamp=4.0, event="thief_a2b", agent="thief", commanded=False))
    assert bot["why"], "that was the reason"
    _, bot = sight(page, state(MODEL, 4, 13.0, {}, event="bot_going_a_to_b2b", agent="bot", bot="b"))
    assert bot["why"] == ""


def test_what_is_seen_in_a_state_is_found_once() -> None:
    known = {0: (GOES,)}
    outlook = Outlook(MODEL, (), known)
    now = state(MODEL, 1, 0.0, {})
    seen = outlook.sight(now, 0.0, ())
    assert seen.planned and outlook.sight(now, 0.0, ()) is seen
    assert outlook.sight(now, 1.0, ()) is not seen
    later = outlook.sight(now._replace(seq=2), 1.0, ())
    known[0] = (strategy({}),)
    assert outlook.sight(now._replace(seq=2), 1.0, ()) is not later


def answer(known: Strategy, now: Any) -> Any:
    """What the page says that the strategy does if the thief goes to b."""
    view, _ = sight(Page(MODEL, FloorPlan({}, ()), strategies={0: (known,)}), now)
    thief = next(agent for agent in view["agents"] if agent["name"] == "thief")
    (found,) = [each["answer"] for each in thief["next"] if each["may"] == "go to b"]
    return found


def test_the_answer_to_what_another_may_do_is_said_where_it_changes_what_is_next() -> None:
    changed = strategy({ASKED: [GO], ("a", "going_a_to_b", 0): [REST]})
    assert answer(changed, state(MODEL, 1, 0.0, {"Cthief": 0.0})) == "bot is to do rest"
    assert answer(strategy({ASKED: [GO], ("a", "going_a_to_b", 0): [GO]}), state(MODEL, 1, 0.0, {})) is None
    assert answer(strategy({ASKED: [GO]}), state(MODEL, 1, 0.0, {})) is None, "nothing is known of that"


def test_without_the_state_of_the_decision_no_reason_is_known() -> None:
    page = Page(MODEL, FloorPlan({}, ()), strategies={0: (GOES,)})
    sight(page, state(MODEL, 1, 0.0, {}))
    away = state(MODEL, 3, 3.0, {"Cbot": 0.0}, event="bot_a2b", agent="bot", bot="going_a_to_b")
    assert sight(page, away._replace(commanded=True))[1]["why"] == ""


def test_a_new_plan_has_its_own_reasons_and_one_that_is_not_known_has_none() -> None:
    known: Dict[int, Any] = {0: (GOES,)}
    page = Page(MODEL, FloorPlan({}, ()), strategies=known)
    planned = state(MODEL, 5, 20.0, {}, bot="b")._replace(plan=1)
    view, bot = sight(page, planned)
    assert (view["next"], bot["then"], view["planned"]) == (None, None, False)
    back = {"do": BACK[0], "agent": "bot", "from": "b", "to": BACK[3], "when": [BACK[4]]}
    entry = {"state": {"bot": "b", "thief": "a", "Prule": 0}, "commands": [back]}
    data = {"commands_agents": ["bot"], "reaction": 0.1, "strategy": [entry]}
    with pytest.raises(DataError, match="strateg"):
        strategies_in({"plan": 1, "strategies": {"controller_bot": {"reaction": "x"}}, "people": None})
    known[1] = strategies_in({"plan": 1, "strategies": {"controller_bot": data}, "people": None})
    assert sight(page, planned)[0]["next"]["says"] == "bot is to go to a"


class Files:
    """Data files by name."""

    def __init__(self, **files: Any) -> None:
        self._files = {f"{name}.yaml": content for name, content in files.items()}

    def has(self, name: str) -> bool:
        return name in self._files

    def read(self, name: str) -> Any:
        return self._files[name]


def test_a_mission_without_strategies_can_be_shown_and_wrong_ones_are_refused() -> None:
    part = {"commands_agents": ["bot"], "reaction": 0.1, "strategy": []}
    given: Any = Files(people=part)
    assert strategies_of(given) == []
    given = Files(people=part, strategies={"strategies": {"controller_bot": part}})
    assert [each.agents for each in strategies_of(given)] == [["bot"], ["bot"]]
    for wrong in ({}, {"strategies": 7}, {"strategies": {"controller_bot": 7}}):
        given = Files(strategies=wrong)
        with pytest.raises(DataError, match="strateg"):
            strategies_of(given)
