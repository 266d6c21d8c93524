"""The page in a real browser, without ROS: hostile names, lost connections, phones, nothing that jumps."""

from __future__ import annotations

import sys
import threading
import time
from pathlib import Path
from typing import Any, Callable, Iterator

import pytest

from pursue_runtime.model import Model
from pursue_runtime.ui.mission_view import reporters
from pursue_runtime.ui.page import Facts, FloorPlan, Page
from tests.runtime.models import model_data, mover, state, worker

pytest.importorskip("tornado", reason="tornado is not installed")
sys.path.append(str(Path(__file__).resolve().parents[2] / "ros"))
from browser import Browser, browser, program

from pursue_runtime.ui import page_server as ui_board
from pursue_runtime.ui import web as ui_web
from pursue_runtime.ui.page_server import STATIC
from tests.waiting import until

pytestmark = pytest.mark.skipif(program() is None, reason="there is no Chromium: apt install chromium, or ./run test")

HOSTILE = "<img src=x onerror=window.hacked=1>"
LONG = "the_very_long_name_of_an_agent_that_somebody_has_invented_on_a_rainy_day"


class Node:
    """A node that shows one state after the other."""

    def __init__(self, model: Any, places: Any, ways: Any, ends: bool) -> None:
        self.lock = threading.RLock()
        self.model, self.wanted = model, []
        self.state: Any = None
        self.clock: Callable[[], float] = time.monotonic
        self.phase, self.verdict, self.shown = "ready", None, self.clock()
        self.board = ui_board.PageServer(Page(model, FloorPlan(places, ways), reporters(model, ends, {})), self)

    def serve(self, port: int = 0) -> Any:
        board = self.board
        board.web = ui_web.Web(
            STATIC, "127.0.0.1", port, "", board.first_message, board.on_message, board.present
        )
        board.web.start()
        return board.web

    def facts(self) -> Any:
        at = self.state.stamp - 100.0 if self.state is not None else 0.0
        return Facts(self.phase, (), self.state, at, at + self.clock() - self.shown, self.verdict)

    def on_request(self, request: Any) -> str:
        self.wanted.append(tuple(request))
        return "as you like"

    def show(self, seq: int, at: float, clock: float = 50.0, **more: Any) -> None:
        self.phase, self.shown = "running", self.clock()
        self.state = state(self.model, seq, 100.0 + at, dict.fromkeys(self.model.clocks, clock), **more)
        self.board.on_state(self.state, at)
        self.board.show()


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    with browser(tmp_path_factory.mktemp("profile")) as there:
        yield there


@pytest.fixture
def show(page: Browser) -> Iterator[Callable[..., Node]]:
    """`show(*automata)`: their page, opened."""
    nodes = []

    def start(
        *automata: Any, places: Any = None, ways: Any = (("a", "b", 9.0),), ends: bool = False, **more: Any
    ) -> Node:
        data = {**model_data(*automata), **more}
        node = Node(Model(data), places or {"a": (0, 0), "b": (9, 3), "s": (4, 9)}, ways, ends)
        nodes.append(node)
        page.complaints.clear()
        page.screen(1100, 800)
        page.open(node.serve().url)
        page.wait("!document.getElementById('main').hidden")
        return node

    yield start
    for node in nodes:
        node.board.web.close()
    page.open("about:blank")


def everybody() -> Any:
    return mover("bot", "robot", 9), mover("thief", "agent", 20), worker("nurse", "human"), worker("boy", "agent")


def says(page: Browser, selector: str, text: str) -> None:
    page.wait(f"document.querySelector({selector!r}).textContent.includes({text!r})")


def drawn(page: Browser) -> None:
    """Waits until the map is as wide as the screen lets it be now."""
    width = "document.querySelector('svg').viewBox.baseVal.width"
    page.wait(f"{width} === document.getElementById('map').clientWidth")


def refuses(page: Browser) -> bool:
    """True once the browser has complained of what the page's own rules forbid."""
    page.value("true")  # complaints come with answers
    return any("Content Security Policy" in complaint for complaint in page.complaints)


def test_labels_are_shown_as_text_and_names_are_sent(page: Browser, show: Callable[..., Node]) -> None:
    labels = {"bot": HOSTILE, "boy": f"boy {HOSTILE}", "a": f"at {HOSTILE}", "screw": f"screw {HOSTILE}"}
    node = show(*everybody(), labels=labels)
    node.show(1, 1.0, event="bot_a2b", agent="bot", bot="going_a_to_b")
    says(page, "#log", f"{HOSTILE} sets off from at {HOSTILE} to b")
    says(page, "#agents", f"from at {HOSTILE} to b")
    says(page, "#map", f"at {HOSTILE[:10]}")
    says(page, "#buttons", f"boy {HOSTILE}")
    says(page, "#buttons", f"screw {HOSTILE}")
    assert page.value("document.querySelector('main img, main script')") is None
    assert page.value("window.hacked") is None
    buttons = "[...document.querySelectorAll('#buttons button')]"
    words = page.value(f"{buttons}.map((button) => button.dataset.word).join(' ')")
    assert HOSTILE not in words and "boy:screw" in words
    assert page.complaints == []


def test_names_and_words_are_text_whatever_is_in_them(page: Browser, show: Callable[..., Node]) -> None:
    robot = {**mover("bot", "robot", 9), "name": HOSTILE}
    thief = {**mover("thief", "agent", 9), "name": "__proto__"}
    thief["edges"] = [{**edge, "word": f"{edge['word']}{HOSTILE}"} for edge in thief["edges"]]
    node = show(
        robot, thief, {**worker("nurse", "human"), "name": "constructor"},
        places={"a": (0, 0), "b": (1, 1), "s": (2, 0), HOSTILE: (2, 2), "__proto__": (3, 3)},
        ways=(("a", HOSTILE, 2.0),),
        clocks=["Cbot", "Cthief", "Cnurse"],
    )
    node.show(1, 1.0, event=HOSTILE, agent=HOSTILE, reason=HOSTILE, status="holding",
              constructor="doing_screw_in_s", **{HOSTILE: "going_a_to_b"})
    for selector in ("#why", "#log", "#agents", "#map"):
        says(page, selector, HOSTILE)
    says(page, "#tasks", "constructor: do screw")
    says(page, "#buttons", "__proto__")
    page.click("#buttons button")
    assert page.value("document.querySelector('main img, main script')") is None
    assert page.value("window.hacked") is None
    assert page.complaints == []


def test_scripts_in_the_page_would_not_run(page: Browser, show: Callable[..., Node]) -> None:
    show(*everybody())
    page.value("document.body.insertAdjacentHTML('beforeend', '<img src=x onerror=\"window.hacked=1\">'); "
               "new Promise((done) => document.body.lastChild.addEventListener('error', () => done()))")
    page.value("{ const s = document.createElement('script'); s.text = 'window.hacked=1'; document.body.append(s); }")
    until(lambda: refuses(page), "complaints")
    assert page.value("window.hacked") is None


def test_other_pages_cannot_speak_for_us(page: Browser, show: Callable[..., Node]) -> None:
    node = show(*everybody())
    address = node.board.web.url.replace("http", "ws") + "live"
    attempt = (f"new Promise((done) => {{ const s = new WebSocket('{address}'); s.onopen = () => done('open'); "
               "s.onerror = () => done('refused'); })")
    assert page.value(attempt) == "open", "our own page can"
    page.open("data:text/html,elsewhere")
    assert page.value(attempt) == "refused"


def test_the_page_says_that_the_connection_is_lost_and_comes_back(page: Browser, show: Callable[..., Node]) -> None:
    node = show(*everybody())
    node.show(1, 0.0, event="_start_")
    says(page, "#log", "the mission starts")
    port = node.board.web.port
    node.board.web.close()
    says(page, "#link", "connection lost")
    assert page.value("document.getElementById('stop').getAttribute('aria-disabled')") == "true"
    node.serve(port)
    says(page, "#link", "connected")
    node.show(2, 3.0, event="thief_a2b", agent="thief", thief="going_a_to_b")
    says(page, "#log", "thief sets off from a to b")
    assert page.text("#log").count("the mission starts") == 1, "nothing twice"
    page.wait("document.getElementById('stop').getAttribute('aria-disabled') === 'false'")


def test_nothing_jumps_while_the_mission_goes_on(page: Browser, show: Callable[..., Node]) -> None:
    node = show(*everybody())
    boxes = (
        "[...document.querySelectorAll('section, button')].map((e) => { const r = e.getBoundingClientRect(); "
        "return [e.id, Math.round(r.y + window.scrollY), Math.round(r.height)].join(' '); }).join('; ')"
    )
    for width, height in ((1100, 800), (360, 740)):
        page.screen(width, height)
        drawn(page)
        before = page.value(boxes)
        node.show(1, 0.0, event="_start_")
        says(page, "#status", "running")
        assert page.value(boxes) == before
        node.show(2, 2.0, clock=2.0, thief="going_a_to_b", bot="going_b_to_a", nurse="doing_screw_in_s")
        says(page, "#agents", "from b to a")
        assert page.value(boxes) == before
        node.show(3, 4.0, clock=2.0, boy="doing_screw_in_s", status="holding", reason="somebody is late")
        says(page, "#why", "somebody is late")
        assert page.value(boxes) == before


def test_long_names_fit_on_a_phone(page: Browser, show: Callable[..., Node]) -> None:
    node = show(mover(LONG, "robot", 9), mover("y" + LONG, "agent", 20), worker("z" + LONG, "human"))
    page.screen(360, 740)
    drawn(page)
    node.show(1, 0.0, event=f"{LONG}_a2b", agent=LONG, reason=LONG, **{"z" + LONG: "doing_screw_in_s"})
    says(page, "#why", LONG)
    assert page.value("document.documentElement.scrollWidth") <= 360
    lowest = "Math.min(...[...document.querySelectorAll('main button')].map((b) => b.getBoundingClientRect().height))"
    assert page.value(lowest) >= 44, "buttons are for fingers"


def test_the_keyboard_does_everything(page: Browser, show: Callable[..., Node]) -> None:
    node = show(*everybody())
    page.wait("document.getElementById('start').getAttribute('aria-disabled') === 'false'")
    reached = []
    for _ in range(12):
        page.key("Tab", 9)
        reached.append(page.value("document.activeElement.id || document.activeElement.dataset.word || ''"))
    assert reached[:2] == ["start", "stop"] and {"thief_a2b", "boy:screw", "log"} <= set(reached)
    page.value("document.getElementById('start').focus()")
    page.key("Enter", 13, "\r")
    says(page, "#remark", "as you like")
    page.value("document.getElementById('stop').focus()")
    page.key("Enter", 13, "\r")
    page.wait("document.getElementById('sure').open")
    page.key("Escape", 27)
    page.wait("!document.getElementById('sure').open")
    assert node.wanted == [("start", "")]


def test_done_is_said_once_for_each_task(page: Browser, show: Callable[..., Node]) -> None:
    node = show(*everybody())
    node.show(2, 2.0, clock=2.0, nurse="doing_screw_in_s")
    says(page, "#tasks", "nurse: do screw, at s")
    page.value("window.setTimeout = () => 0; true")  # however slow the machine: no time passes between the presses
    page.click(".done")
    page.click(".done")
    says(page, "#remark", "as you like")
    assert node.wanted == [("done", "nurse:screwDONE")]


def test_without_a_simulator_arrivals_of_robots_and_others_are_reported_on_the_page(
    page: Browser, show: Callable[..., Node]
) -> None:
    node = show(*everybody(), ends=True)
    page.wait("!document.getElementById('others').hidden")
    says(page, "#ends", "bot: not under way")
    node.show(2, 2.0, clock=2.0, thief="going_a_to_b", boy="doing_screw_in_s")
    says(page, "#ends", "thief: from a to b")
    says(page, "#ends", "boy: screw, at s")
    labels = page.value("[...document.querySelectorAll('#ends .done')].map((each) => each.textContent).join()")
    assert labels == "Done,Arrived,Done"
    pressed = "document.querySelectorAll('#ends .done')[{}].click()"
    page.value(pressed.format(0))  # the robot stands
    page.value(pressed.format(1))
    says(page, "#remark", "as you like")
    assert node.wanted == [("done", "thief_going_a_to_b2b")]


def test_with_a_simulator_only_people_report_their_ends(page: Browser, show: Callable[..., Node]) -> None:
    node = show(*everybody())
    node.show(2, 2.0, clock=2.0, thief="going_a_to_b", nurse="doing_screw_in_s")
    says(page, "#tasks", "nurse: do screw, at s")
    assert page.value("document.getElementById('others').hidden") is True


def test_what_is_possible_in_a_while_becomes_possible(page: Browser, show: Callable[..., Node]) -> None:
    node, now = show(*everybody()), [0.0]
    node.clock = lambda: now[0]
    node.show(1, 0.0, clock=0.0, event="_start_", unit=30.0)
    page.wait("document.querySelector('[data-word=thief_a2b]').textContent.includes('in ')")
    page.click("[data-word=thief_a2b]")
    now[0] = 2.0
    page.wait("document.querySelector('[data-word=thief_a2b]').getAttribute('aria-disabled') === 'false'")
    page.click("[data-word=thief_a2b]")
    says(page, "#remark", "as you like")
    assert node.wanted == [("say", "thief_a2b")]


@pytest.mark.parametrize("status", ["won", "lost", "stopped"])
def test_the_end_is_reported_and_nothing_can_be_pressed(page: Browser, show: Callable[..., Node], status: str) -> None:
    node = show(*everybody())
    node.verdict = (status != "won", "So it ends.")
    node.show(5, 40.0, status=status)
    says(page, "#status", status)
    says(page, "#why", "So it ends.")
    assert page.value("document.title").startswith(status)
    enabled = "document.querySelectorAll('main button:not([aria-disabled=true])').length"
    assert page.value(enabled) == 0
    node.board.web.close()
    says(page, "#link", "the mission has ended")
