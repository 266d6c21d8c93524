"""A report is published until it is answered; one that comes late ends nothing that was begun after it."""

from __future__ import annotations

from typing import List, Tuple

import pytest

from pursue_runtime.model import Model
from pursue_runtime.observer.mission import Mission
from pursue_runtime.simulator.simulator import Delays, Simulator
from tests.runtime.models import everywhere, model_data, mover, worker
from tests.together import HOTEL
from tests.together import model as hotel

RIDE = "doing_ride_in_lift"
RIDING = (
    (101.5, "waiter:waiter_lobby2lift"), (103.9, "waiter_going_lobby_to_lift2lift"), (105.0, "porter:ride"),
)  # fmt: skip


def endless(*automata: dict) -> Model:
    """A model of these automata whose goal is out of reach."""
    data = model_data(*automata)
    data["automata"][-1]["edges"] = []
    return Model(data)


class Play:
    """A mission, and its agents simulated; what they report reaches the mission only where a test passes it on."""

    def __init__(self, model: Model, *simulated: str) -> None:
        self.logs: List[Tuple[str, str]] = []
        log = lambda level, text: self.logs.append((level, text))
        self.mission = Mission(model, everywhere(model), log, on_uncovered="warn", lost_after=10.0)
        self.world = Simulator(model, simulated, Delays("middle"))
        self.hear(100.0, "_start_")

    def hear(self, at: float, word: str) -> None:
        """A word reaches the mission, and what follows from it the agents."""
        for state in self.mission.on_word(word, at):
            self.world.on_state(state, at)

    def begin(self, at: float, agent: str, event: str) -> None:
        """The agent is ordered to do the event, and begins it."""
        order = "" if event.startswith(f"{agent}_") else event
        self.hear(at, f"{agent}:{event}@{self.mission.seq}")
        self.world.on_order(agent, at, order)

    def reports(self, at: float) -> List[str]:
        """What the agents publish at this moment."""
        return self.world.due(at, at)

    def location(self, agent: str) -> str:
        return self.mission.state(200.0).locations[agent]


def test_a_report_that_was_held_back_ends_no_action_that_was_begun_after_it() -> None:
    play = Play(endless(worker("bot", "robot")), "bot")
    play.begin(102.0, "bot", "screw")
    (first,), (again,) = play.reports(105.6), play.reports(107.0)
    play.hear(107.1, first)
    assert play.location("bot") == "s"
    play.begin(108.5, "bot", "screw")
    play.hear(108.6, again)
    assert play.location("bot") == "doing_screw_in_s", "it has only just begun"
    assert play.mission.counts["stale"] == 1 and not [text for level, text in play.logs if level != "info"]
    (second,) = play.reports(112.1)
    play.hear(112.1, second)
    assert play.location("bot") == "s"


def test_a_report_that_was_held_back_ends_no_later_movement() -> None:
    play = Play(endless(mover("bot", "robot", 3)), "bot")
    play.begin(102.0, "bot", "bot_a2b")
    (first,), (again,) = play.reports(105.6), play.reports(107.0)
    play.hear(107.1, first)
    play.begin(109.0, "bot", "bot_b2a")
    (back,) = play.reports(112.6)
    play.hear(112.6, back)
    play.begin(115.0, "bot", "bot_a2b")
    play.hear(115.1, again)
    assert play.location("bot") == "going_a_to_b"


def child() -> dict:
    """An agent that nobody controls, and that may ring wherever it is."""
    made = mover("child", "agent", 3)
    ring = {"word": "ring", "sync": "send", "when": ["Cchild > 1"], "reset": ["Cchild"], "controllable": False}
    return {**made, "edges": [*made["edges"], *({"from": here, "to": here, **ring} for here in "ab")]}


def test_what_an_agent_does_at_once_counts_once_though_its_word_comes_twice() -> None:
    play = Play(endless(child()))
    for at in (102.0, 102.01, 103.9):
        play.hear(at, "child:ring#1")
    assert play.mission.seq == 2 and play.mission.counts["stale"] == 2
    play.hear(104.5, "child:ring#2")
    assert play.mission.seq == 3


def test_that_an_agent_has_done_something_at_once_makes_no_other_report_of_it_old() -> None:
    play = Play(endless(child()))
    play.hear(102.0, "child:child_a2b")
    began = play.mission.seq
    play.hear(105.5, f"child_going_a_to_b2b#{began}")
    play.hear(107.0, "child:ring")
    play.hear(109.0, f"child:child_b2a#{play.mission.seq - 1}")
    assert play.location("child") == "going_b_to_a"


def test_the_word_of_a_person_needs_no_number() -> None:
    play = Play(endless(worker("bot", "robot")))
    for at in (102.0, 110.0):
        play.begin(at, "bot", "screw")
        play.hear(at + 3.5, "bot:screwDONE" if at < 105.0 else "screwDONE")
        assert play.location("bot") == "s"


def test_a_later_state_in_which_it_goes_on_is_as_good_as_the_first() -> None:
    """A simulator, or a controller, that was started again knows the newest state."""
    play = Play(endless(worker("bot", "robot"), mover("other", "agent", 3)))
    play.begin(102.0, "bot", "screw")
    play.hear(103.0, "other_a2b")
    play.hear(105.5, f"screwDONE#{play.mission.seq}")
    assert play.location("bot") == "s"


@pytest.mark.parametrize("kind", ["_failed_", "_blocked_"])
def test_a_failure_that_was_held_back_is_none_of_a_later_movement(kind: str) -> None:
    play = Play(endless(mover("bot", "robot", 3)))
    play.begin(102.0, "bot", "bot_a2b")
    begun = play.mission.seq
    play.hear(105.5, "bot_going_a_to_b2b")
    play.begin(107.0, "bot", "bot_b2a")
    play.hear(107.5, f"bot:{kind}#{begun} no way")
    assert not play.mission.lost and not play.mission.ways.blocked
    play.hear(107.6, f"bot:{kind}#{play.mission.seq} no way")
    assert list(play.mission.lost) == ["bot"]


def test_of_what_several_do_together_an_old_report_ends_no_part() -> None:
    play = Play(hotel(HOTEL))
    for at, word in RIDING:
        play.hear(at, word)
    begun = play.mission.seq
    for agent in ("porter", "waiter"):
        play.hear(109.1, f"{agent}:rideDONE#{begun - 1}")
    assert play.mission.state(109.1).finished == () and play.location("waiter") == RIDE
    for agent in ("porter", "waiter"):
        play.hear(109.5, f"{agent}:rideDONE#{begun}")
    assert play.location("porter") == play.location("waiter") == "lift"


def test_a_partner_that_was_lost_counts_again_with_the_report_that_it_owes_and_no_older_one() -> None:
    play = Play(hotel(HOTEL))
    for at, word in RIDING:
        play.hear(at, word)
    begun = play.mission.seq
    play.hear(106.0, "waiter:_failed_")
    play.hear(109.5, f"porter:rideDONE#{begun}")
    assert play.location("waiter") == "lift" and list(play.mission.lost) == ["waiter"]
    play.hear(110.0, f"waiter:rideDONE#{begun - 1}")
    assert list(play.mission.lost) == ["waiter"]
    play.hear(111.0, f"waiter:rideDONE#{begun}")
    assert not play.mission.lost


def test_after_a_state_was_adopted_every_report_counts() -> None:
    """It is not known when what goes on was begun."""
    play = Play(endless(worker("bot", "robot")))
    play.begin(102.0, "bot", "screw")
    state = play.mission.state(103.0)
    play.mission.adopt(state._asdict(), 103.0)
    play.hear(105.5, "screwDONE#1")
    assert play.location("bot") == "s"
