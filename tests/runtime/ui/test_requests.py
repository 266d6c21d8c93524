"""What pages may ask for, and that each press counts once and ends nothing that has begun since."""

from __future__ import annotations

from typing import Any, List, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime.model import Model
from pursue_runtime.observer.mission import Mission
from pursue_runtime.state import SystemState
from pursue_runtime.ui.mission_view import possible_words, tasks
from pursue_runtime.ui.requests import ANSWERED, PageRequest, Presses, read_request
from tests.runtime.models import everywhere, model_data, mover, state, worker


def bell() -> Any:
    """A person who may ring, as often as the person wants: the event has no duration, and the person stays."""
    ring = {"from": "s", "to": "s", "word": "ring", "sync": "send", "when": [], "set": {}, "reset": ["Cboy"],
            "controllable": False}
    return {"name": "boy", "kind": "agent", "initial": "s", "edges": [ring], "locations": {"s": []}}


def endless() -> Model:
    """A nurse who screws and a boy who rings; the goal is out of reach."""
    data = model_data(worker("nurse", "human"), bell(), mover("thief", "agent", 20))
    data["automata"][-1]["edges"] = []
    return Model(data)


class Play:
    """A mission, and the pages of its UI; what they publish reaches the mission where a test passes it on."""

    def __init__(self) -> None:
        self.model, self.now = endless(), 100.0
        options = {"on_uncovered": "warn", "lost_after": 1000.0}
        self.mission = Mission(self.model, everywhere(self.model), lambda *_: None, **options)
        self.presses = Presses(lambda: self.now)
        self.hear("_start_")

    @property
    def state(self) -> SystemState:
        return self.mission.state(self.now)

    def hear(self, word: str, after: float = 3.5) -> None:
        """A word reaches the mission, and the UI what follows from it."""
        self.now += after
        for each in self.mission.on_word(word, self.now):
            self.presses.on_state(each)

    def press(self, do: str, word: str, seq: int) -> Tuple[str, str]:
        """A page that shows the state of this number has the button pressed."""
        ends: List[str] = [task.word for task in tasks(self.model, self.state, ["nurse"])]
        begins = [offer.word for offer in possible_words(self.model, self.state, self.state.clocks)]
        return self.presses.word(PageRequest(do, word, seq), self.state, ends if do == "done" else begins)

    def location(self, agent: str) -> str:
        return self.state.locations[agent]


def test_a_press_of_done_that_a_cut_link_brings_late_does_not_end_the_next_action() -> None:
    play = Play()
    play.hear("nurse:screw@1")
    begun = play.state.seq
    word, remark = play.press("done", "screwDONE", begun)
    assert (word, remark) == (f"screwDONE#{begun}", "")
    play.hear("screwDONE")  # somebody else has said it; the word of the page is still on its way
    play.hear(f"nurse:screw@{play.state.seq}")
    again = play.state
    play.hear(word)
    assert play.location("nurse") == "doing_screw_in_s" and play.state.seq == again.seq, "the second action goes on"
    assert play.mission.counts["stale"] == 1
    play.hear(play.press("done", "screwDONE", again.seq)[0])
    assert play.location("nurse") == "s"


def test_done_pressed_on_a_page_that_shows_the_action_before_ends_nothing() -> None:
    play = Play()
    play.hear("nurse:screw@1")
    shown = play.state.seq
    play.hear("screwDONE")
    play.hear(f"nurse:screw@{play.state.seq}")
    assert play.press("done", "screwDONE", shown) == ("", "screwDONE has happened meanwhile: nothing was sent.")


@given(st.lists(st.tuples(st.sampled_from(["begin", "press", "arrive"]), st.integers(0, 6)), max_size=30))
def test_a_press_of_done_ends_only_what_its_page_has_shown(steps: List[Tuple[str, int]]) -> None:
    """Pages show states of before, and links bring words late and in any order."""
    play = Play()
    sent: List[Tuple[str, int]] = []  # words on their way, and the state that the page showed
    begun = 0  # the state in which the present action has begun
    for what, number in steps:
        seq = play.state.seq
        if what == "begin" and play.location("nurse") == "s":
            play.hear(f"nurse:screw@{seq}")
            begun = play.state.seq
        elif what == "press":
            shown = max(0, seq - number)
            sent += [(word, shown) for word, _ in [play.press("done", "screwDONE", shown)] if word]
        elif what == "arrive" and sent:
            word, shown = sent.pop(number % len(sent))
            play.hear(word)
            assert play.state.seq == seq or shown >= begun, "this action was not on the page"


def test_a_button_pressed_in_two_tabs_acts_once() -> None:
    play = Play()
    first, second = play.press("say", "ring", 1), play.press("say", "ring", 1)
    assert first == ("ring#1", "") and second == ("", "ring was sent already.")
    play.hear(first[0])
    assert play.state.event == "ring"
    assert play.press("say", "ring", 1)[0] == "", "that tab has not shown yet that it has happened"
    play.now += 2 * ANSWERED
    assert play.press("say", "ring", 1)[0] == "", "however long it takes"
    assert play.press("say", "ring", play.state.seq)[0] == f"ring#{play.state.seq}", "it is meant again"


def test_a_press_that_nothing_has_answered_may_be_repeated() -> None:
    play = Play()
    play.now += 5.0
    assert play.press("say", "thief_a2b", 1)[0] == "thief_a2b#1"
    assert play.press("say", "thief_a2b", 1)[0] == ""
    play.now += ANSWERED
    assert play.press("say", "thief_a2b", 1)[0] == "thief_a2b#1"


@pytest.mark.parametrize("do, word, seq", [
    ("done", "screwDONE", 1), ("say", "thief_b2a", 1), ("say", "screwDONE", 1), ("say", "ring", 2), ("say", "x y", 1),
])
def test_what_is_not_possible_is_not_published(do: str, word: str, seq: int) -> None:
    assert Play().press(do, word, seq) == ("", f"{word} is not possible now.")


@pytest.mark.parametrize("status", ["waiting", "won", "lost", "stopped"])
def test_nothing_is_published_before_the_start_and_after_the_end(status: str) -> None:
    model = endless()
    over = state(model, 4, 100.0, {}, status=status)
    assert Presses().word(PageRequest("say", "ring", 4), over, ["ring"])[0] == ""


@pytest.mark.parametrize("text, request_", [
    ('{"do": "start"}', ("start", "", 0)),
    ('{"do": "stop"}', ("stop", "", 0)),
    ('{"do": "finish"}', ("finish", "", 0)),
    ('{"do": "say", "word": "thief_a2b", "seq": 7}', ("say", "thief_a2b", 7)),
    (b'{"do": "done", "word": "nurse:screwDONE", "seq": 0}', ("done", "nurse:screwDONE", 0)),
])
def test_requests_are_read(text: Any, request_: Any) -> None:
    assert read_request(text) == request_


@pytest.mark.parametrize("text", [
    "", "{", "[]", "7", "null", '"start"', "{}", '{"do": 7}', '{"do": ["start"]}', '{"do": {}}', '{"do": "kill"}',
    '{"do": "say"}', '{"do": "say", "word": 7}', '{"do": "say", "word": ""}', '{"do": "start", "word": "x"}',
    b"\xff\xfe", "[" * 4000, '{"do": "say", "word": null}', '{"do": "say", "word": "x"}',
    '{"do": "done", "word": "x", "seq": -1}', '{"do": "done", "word": "x", "seq": true}',
    '{"do": "done", "word": "x", "seq": "1"}', '{"do": "done", "word": "x", "seq": 1.5}',
])
def test_junk_is_refused_with_what_was_expected(text: Any) -> None:
    with pytest.raises(ValueError, match="expected"):
        read_request(text)
