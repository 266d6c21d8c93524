"""States that are not known at first, at run time: who says what they are, and in which words."""

from __future__ import annotations

from typing import Any, Dict

from pursue_runtime.model import Model
from pursue_runtime.observer.mission import Mission
from pursue_runtime.simulator.simulator import Delays, Simulator
from pursue_runtime.state import SystemState
from pursue_runtime.strategy import Strategy
from pursue_runtime.ui.course import course
from pursue_runtime.ui.environment import RandomEnvironment
from pursue_runtime.ui.mission_view import possible_words, reporters
from pursue_runtime.ui.page import Facts, FloorPlan, Page
from pursue_runtime.vocabulary import awaited, deed, place, sentence
from tests.runtime.models import model_data, state, worker

SHOWN = "doing_finding_out"


def fact(name: str) -> Dict[str, Any]:
    """A state that screwing shows."""
    clock = f"C{name}"
    found = [
        {"from": SHOWN, "to": "known", "word": f"{name}_is_{word}", "sync": "send", "set": {f"S{name}": value},
         "controllable": False}
        for word, value in (("true", 1), ("false", 0))
    ]
    shows = {"from": "unknown", "to": SHOWN, "word": "screwDONE", "sync": "receive", "reset": [clock],
             "controllable": True}
    return {"name": name, "kind": "agent", "initial": "unknown", "edges": [shows, *found],
            "locations": {"unknown": [], SHOWN: [f"{clock} <= 1"], "known": []}}


def made() -> Model:
    data = model_data(worker("bot", "robot"), fact("loose"))
    data["variables"] = {"Prule": 0, "Pbot": 1, "Sloose": 2}
    data["automata"][-1]["edges"][0]["word"] = "loose_is_true"
    return Model({**data, "format": 5})


MODEL = made()


def shown(seq: int = 3, event: str = "screwDONE", **places: str) -> SystemState:
    """The state in which it has just been shown."""
    found: SystemState = state(MODEL, seq, 110.0, {}, event=event, agent="bot", **{"loose": SHOWN, **places})
    return found


def test_what_a_state_is_at_is_said_in_words() -> None:
    loose = MODEL.automaton("loose")
    said = [place(MODEL, loose, here) for here in ("unknown", SHOWN, "known")]
    assert said == ["unknown", "being found out", "known"]
    deeds = [deed(MODEL, loose, edge).does for edge in loose.edges_from(SHOWN)]
    assert deeds == ["is found to be true", "is found to be false"]
    assert awaited(MODEL, loose, SHOWN) == "be found out"
    now = shown(4, "loose_is_false", loose="known")._replace(agent="loose")
    assert sentence(MODEL, now, shown()) == "loose is found to be false"


def test_the_simulator_draws_what_it_is_and_says_it_in_time() -> None:
    words = set()
    for seed in range(20):
        world = Simulator(MODEL, ["loose"], Delays("random", seed))
        world.on_state(state(MODEL, 1, 100.0, {}, event="_start_"), 0.0)
        assert world.next_moments() == (None, None)
        world.on_state(shown(), 1.0)
        moment = world.next_moments()[0]
        assert moment is not None and 110.0 < moment < 111.0
        words.update(world.due(111.0, 2.0))
        assert world.due(111.0, 2.0) == []
    assert words == {"loose_is_true#3", "loose_is_false#3"}


def test_a_person_says_it_with_a_button() -> None:
    page = Page(MODEL, FloorPlan({"s": (0.0, 0.0)}, ()))
    labels = {button["word"]: (button["label"], button["from"]) for button in page.scene()["buttons"]}
    assert labels == {"loose_is_true": ("is true", [SHOWN]), "loose_is_false": ("is false", [SHOWN])}
    before = page.view(Facts("running", (), state(MODEL, 2, 105.0, {}), 5.0, 5.0))
    assert not set(labels) & set(before["open"])
    view = page.view(Facts("running", (), shown(), 10.0, 10.0))
    assert set(labels) <= set(view["open"])
    row = next(agent for agent in view["agents"] if agent["name"] == "loose")
    assert (row["doing"], row["awaited"]) == ("is being found out", "be found out")
    assert [each["may"] for each in row["next"]] == ["be found to be true", "be found to be false"]


def test_it_is_no_task_of_an_agent_and_no_player_says_it() -> None:
    assert reporters(MODEL, True, {}) == ["bot"]
    offers = possible_words(MODEL, shown(), shown().clocks)
    assert [offer.word for offer in offers] == ["loose_is_true", "loose_is_false"]
    player = RandomEnvironment(MODEL, seed=1, pace=0.1)
    player.on_state(shown(), 100.0, 110.0)
    assert player.next_moment() is None


def test_nobody_foresees_what_it_is() -> None:
    strategy = Strategy({"commands_agents": ["bot"], "reaction": 0, "strategy": []})
    assert course(MODEL, [strategy], shown()) == []


def test_the_observer_takes_it_once_it_is_shown_and_waits_for_it() -> None:
    mission = Mission(MODEL, None, lambda *_: None, on_uncovered="warn", lost_after=20.0)
    (first,) = mission.on_word("_start_", 100.0)[:1]
    assert (first.locations["loose"], first.values["Sloose"]) == ("unknown", 2)
    assert mission.on_word("loose_is_true", 101.0) == []
    mission.on_word("bot:screw@1", 102.0)
    mission.on_word("screwDONE", 105.5)
    assert mission.state(105.5).locations["loose"] == SHOWN
    mission.on_time(107.0)
    assert mission.late == {"loose"}
    (now,) = mission.on_word("loose_is_false", 108.0)
    assert (now.locations["loose"], now.values["Sloose"], mission.late) == ("known", 0, set())
