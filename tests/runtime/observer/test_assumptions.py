"""Assumptions in a mission: what breaks one has happened, is reported by name, and another plan does not rely on it."""

from __future__ import annotations

from typing import Any, Dict, List, Tuple

import pytest
import yaml

from pursue_gen.tools.replanning import replan
from pursue_runtime.model import Model
from pursue_runtime.observer.mission import Mission
from pursue_runtime.state import HOLDING, RUNNING, STOPPED, SystemState, rewinds
from pursue_runtime.strategy import read_cover
from tests.assumptions import (
    APART,
    AWAY,
    CAFE,
    GOODBYE,
    LEAVES,
    MUSEUM,
    ONCE,
    PLAYROOM,
    ROOMS,
    SPACED,
    TWICE,
    files,
    model,
)


class Story:
    """A mission with the plan of its workspace and a planner that answers when it is told to."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.logs: List[str] = []
        self.mission = self.anew()

    def anew(self) -> Mission:
        cover = read_cover(yaml.safe_load(files(self.text)["src/observer/config/cover.yaml"]))
        log = lambda level, text: self.logs.append(text)
        return Mission(model(self.text), cover, log, on_uncovered="plan", lost_after=10.0)

    def hear(self, *words: Tuple[float, str]) -> SystemState:
        for at, word in words:
            self.mission.on_word(word, at)
        return self.mission.state(at)

    def planned(self, now: float) -> Dict[str, Any]:
        """The planner's answer to the request, which goes to the observer."""
        request = self.mission.plan_request
        assert request is not None
        game = yaml.safe_load(files(self.text)["src/observer/config/game.yaml"])
        names = ("locations", "values", "clocks", "ahead", "excused")
        answer = replan({"format": 1, "game": game, **{name: getattr(request, name) for name in names}})
        if answer["won"]:
            self.mission.on_plan(request.number, answer, now)
        else:
            self.mission.on_no_plan(request.number, answer["why"], now)
        return answer


def test_what_is_within_the_assumption_changes_nothing() -> None:
    story = Story(PLAYROOM.format(TWICE))
    state = story.hear((0.0, "_start_"), (1.5, "spill"), (3.0, "spill"))
    assert (state.status, state.reason, state.values["assume1"]) == (RUNNING, "", 1)
    assert state.values["assume1count"] == 2


def test_one_time_too_many_has_happened_and_is_reported_by_name() -> None:
    story = Story(PLAYROOM.format(TWICE))
    state = story.hear((0.0, "_start_"), (1.5, "spill"), (3.0, "spill"), (4.5, "spill"))
    assert (state.status, state.event, state.values["assume1"]) == (HOLDING, "spill", 0)
    assert state.reason.startswith("what was assumed is broken: child does spill at most 2 times; looking for another")
    assert "an assumption is broken: child does spill at most 2 times" in story.logs
    assert story.mission.counts["impossible"] == 0


def test_where_nothing_can_be_promised_without_it_the_mission_stops() -> None:
    story = Story(PLAYROOM.format(TWICE))
    story.hear((0.0, "_start_"), (1.5, "spill"), (3.0, "spill"), (4.5, "spill"))
    assert not story.planned(5.0)["won"]
    state = story.mission.state(5.0)
    assert state.status == STOPPED and "child does spill at most 2 times" in state.reason


def test_where_it_can_another_plan_does_not_rely_on_it() -> None:
    story = Story(CAFE.format(ONCE))
    state = story.hear((0.0, "_start_"), (1.5, "call"), (3.0, "call"))
    assert (state.status, state.values["assume1"]) == (HOLDING, 0)
    assert story.planned(3.2)["won"]
    assert story.mission.state(3.2).status == RUNNING and story.mission.plan == 1
    state = story.hear((5.0, "call"), (7.0, "call"))
    assert (state.status, state.seq > 4) == (RUNNING, True), "it is broken once"


def test_a_report_that_comes_too_soon_breaks_the_assumption_and_not_the_time_window() -> None:
    story = Story(PLAYROOM.format(SPACED))
    state = story.hear((0.0, "_start_"), (1.5, "spill"), (9.0, "spill"))
    assert state.values["assume1"] == 0 and story.mission.counts["untimely"] == 0
    assert "child waits 20 units between one spill and the next" in state.reason


def test_whoever_goes_where_he_is_never_assumed_to_be_has_gone_there() -> None:
    story = Story(MUSEUM.format(f"{LEAVES}\n{AWAY}\n{GOODBYE}"))
    state = story.hear((0.0, "_start_"), (2.0, "visitor_gallery2store"))
    assert state.locations["visitor"] == "going_gallery_to_store"
    assert (state.values["assume1"], state.values["assume2"]) == (1, 0)
    assert "visitor is never at store" in state.reason


def test_whoever_stays_too_long_breaks_the_assumption_and_is_not_late() -> None:
    story = Story(MUSEUM.format(f"{LEAVES}\n{AWAY}\n{GOODBYE}"))
    story.hear((0.0, "_start_"),)
    moment = story.mission.next_moment(0.0)
    assert moment == pytest.approx(30.1)
    story.mission.on_time(moment)
    state = story.mission.state(moment)
    assert (state.values["assume1"], state.late, state.status) == (0, (), HOLDING)
    assert "visitor leaves gallery within 30 units" in state.reason
    assert story.mission.next_moment(30.2) is None, "nothing is awaited any more but the planner's answer"


MOVING = MUSEUM.replace('"bot" controllable', '"bot" controllable mobile 1')


@pytest.mark.parametrize("held", [False, True])
def test_a_state_in_which_an_assumption_is_broken_has_a_number_of_its_own(held: bool) -> None:
    """Nodes refuse a state that has the number of another one, and other values: that would stop the mission."""
    story = Story(MOVING.format(f"{LEAVES}\n{AWAY}\n{GOODBYE}"))
    before = story.hear((0.0, "_start_"), (2.0, "bot_hall2gallery"))
    if held:  # the reason of the hold stays the same
        before = story.hear((2.5, "bot:_held_"))
    states = story.mission.on_time(30.2)
    assert states and states[-1].values["assume1"] == 0 and states[-1].status == HOLDING
    assert states[0].seq == before.seq + 1 and not rewinds(states[0], before)
    assert story.mission.state(31.0).values == states[-1].values and story.mission.seq == states[-1].seq


def test_what_no_assumption_excludes_is_impossible_as_before() -> None:
    story = Story(PLAYROOM.format(TWICE))
    state = story.hear((0.0, "_start_"), (1.5, "inspectDONE"))
    assert state.values["assume1"] == 1 and story.mission.counts["impossible"] == 1


def test_a_command_breaks_no_assumption() -> None:
    """Only what others do is assumed: a word with a state's number is a controller's."""
    story = Story(PLAYROOM.format(TWICE))
    story.hear((0.0, "_start_"), (1.5, "spill"), (3.0, "spill"), (4.5, f"child:spill:{3}"))
    assert story.mission.state(4.5).values["assume1"] == 1


def test_a_state_of_a_broken_assumption_is_adopted() -> None:
    story = Story(CAFE.format(ONCE))
    seen = story.hear((0.0, "_start_"), (1.5, "call"), (3.0, "call"))
    other = story.anew()
    other.adopt(seen._asdict(), 4.0)
    assert other.state(4.0).values["assume1"] == 0 and other.plan_request is not None


def test_data_without_assumptions_are_read() -> None:
    assert model(CAFE.format("")).assumptions == ()
    data = yaml.safe_load(files(CAFE.format(ONCE))["src/observer/config/model.yaml"])
    assert [each.says for each in Model(data).assumptions] == ["guest does call at most once"]


def test_who_sets_off_to_where_nobody_is_assumed_to_be_breaks_it() -> None:
    text = ROOMS.format(APART)
    story = Story(text)
    state = story.hear((0.0, "_start_"), (1.5, "ben_east2west"))
    assert (state.status, state.values["assume1"]) == (RUNNING, 1)
    state = story.hear((3.0, "anna_west2east"))
    assert (state.status, state.event, state.values["assume1"]) == (HOLDING, "anna_west2east", 0)
    assert state.reason.startswith(
        "what was assumed is broken: it never holds that anna is at east and ben is at west; looking for another"
    )
    assert not story.planned(3.2)["won"]
    assert story.mission.state(3.2).status == STOPPED
