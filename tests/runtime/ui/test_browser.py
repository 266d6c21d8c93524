"""The page in a real browser, without ROS: hostile names, lost connections, phones, nothing that jumps."""

from __future__ import annotations

import os
import struct
import sys
import threading
import time
import zlib
from pathlib import Path
from typing import Any, Callable, Iterator, List, Optional, Sequence

import pytest

from pursue_runtime.model import Model
from pursue_runtime.strategy import Strategy
from pursue_runtime.ui.floor import Floor
from pursue_runtime.ui.mission_view import reporters
from pursue_runtime.ui.page import BAD, NOTE, Facts, FloorPlan, Page
from pursue_runtime.ui.promise import Objective, Promise
from pursue_runtime.ui.statuses import Status
from tests.runtime.models import desk, model_data, mover, state, worker

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


STATUSES = (Status("reachObj", "do screw", {"unlocked": "screw to be done", "win": "reached"}),)
PROMISE = Promise((Objective("screw happens.", ("reachObj",)), Objective("Optional 1: nap happens.", ())), 60.0)
UNREADABLE = """
(() => {
  const channel = (v) => { v /= 255; return v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4; };
  const light = ([r, g, b]) => 0.2126 * channel(r) + 0.7152 * channel(g) + 0.0722 * channel(b);
  const rgb = (text) => (text.match(/[\\d.]+/g) || [0, 0, 0, 0]).map(Number);
  const under = (e) => { // the colour behind it
    for (let at = e; at; at = at.parentElement) {
      const box = at.tagName === "g" && at.querySelector("rect");
      const back = rgb(box ? getComputedStyle(box).fill : getComputedStyle(at).backgroundColor);
      if (back.length === 3 || back[3] > 0) return back;
    }
    return [255, 255, 255];
  };
  const found = [];
  for (const e of document.querySelectorAll("body *")) {
    const own = [...e.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim());
    const style = getComputedStyle(e), box = e.getBoundingClientRect();
    if (!own || !box.width || style.visibility === "hidden" || e.tagName === "title") continue;
    const fore = light(rgb(e.namespaceURI.endsWith("svg") ? style.fill : style.color)), back = light(under(e));
    const ratio = (Math.max(fore, back) + 0.05) / (Math.min(fore, back) + 0.05);
    if (ratio < 4.5) found.push(`${e.tagName} #${e.id} ${e.textContent}: ${ratio.toFixed(2)}`);
  }
  return found;
})()
"""
"""Texts whose contrast with what is behind them is below 4.5, as WCAG 2 computes it."""

COVERED = """
(() => {
  const boxes = [...document.querySelectorAll("#map .poi, #map .mark, #map .length")]
    .filter((e) => getComputedStyle(e).display !== "none" && getComputedStyle(e).visibility !== "hidden")
    .map((e) => [e.textContent, e.getBoundingClientRect()]);
  const apart = (a, b) => a.right <= b.left || b.right <= a.left || a.bottom <= b.top || b.bottom <= a.top;
  const pairs = boxes.flatMap((a, i) => boxes.slice(i + 1).map((b) => [a, b]));
  return pairs.filter(([a, b]) => !apart(a[1], b[1])).map(([a, b]) => `${a[0]} and ${b[0]}`);
})()
"""
"""Labels on the map that cover each other."""


class Node:
    """A node that shows one state after the other."""

    def __init__(
        self, model: Any, places: Any, ways: Any, ends: bool, promise: Promise,
        strategies: Sequence[Strategy] = (), floor: Optional[Floor] = None,
    ) -> None:
        self.lock = threading.RLock()
        self.model, self.wanted = model, []
        self.state: Any = None
        self.clock: Callable[[], float] = time.monotonic
        self.phase, self.verdict, self.shown = "ready", None, self.clock()
        self.answers, self.received, self.offers = True, 0.0, ()
        people, known = reporters(model, ends, {}), {0: strategies}
        page = Page(model, FloorPlan(places, ways), people, STATUSES, promise, known, floor)
        self.board = ui_board.PageServer(page, self)
        self.pictures = {} if floor is None else {ui_board.FLOOR: (floor.picture, "image/png")}

    def serve(self, port: int = 0) -> Any:
        board = self.board
        board.web = ui_web.Web(
            STATIC, "127.0.0.1", port, "", board.first_message, board.on_message, board.present,
            self.pictures,
        )
        board.web.start()
        return board.web

    def facts(self) -> Any:
        at = self.state.stamp - 100.0 if self.state is not None else 0.0
        now = at + (self.clock() - self.shown if self.answers else 0.0)
        known = Facts(self.phase, (), self.state, at, now, self.verdict, self.answers, self.received)
        return known._replace(stays=bool(self.offers), offers=self.offers)

    def on_request(self, request: Any) -> str:
        self.wanted.append(tuple(request))
        return "as you like"

    def answer(self, *answer: Any) -> None:
        self.board.page.on_answer(*answer)
        self.board.show()

    def show(self, seq: int, at: float, clock: float = 50.0, **more: Any) -> None:
        self.phase, self.shown = "running", self.clock()
        facts = {name: more.pop(name) for name in ("commanded", "held", "out_of_service") if name in more}
        self.state = state(self.model, seq, 100.0 + at, dict.fromkeys(self.model.clocks, clock), **more)
        self.state = self.state._replace(**facts)
        self.board.page.on_state(self.state, at)
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
        *automata: Any, places: Any = None, ways: Any = (("a", "b", 9.0),), ends: bool = False,
        promise: Promise = PROMISE, strategies: Sequence[Strategy] = (),
        floor: Optional[Floor] = None, **more: Any
    ) -> Node:
        data = {**model_data(*automata), **more}
        there = places or {"a": (0, 0), "b": (9, 3), "s": (4, 9)}
        node = Node(Model(data), there, ways, ends, promise, strategies, floor)
        nodes.append(node)
        page.complaints.clear()
        page.screen(1100, 800)
        page.dark(False)
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


def matches(page: Browser, selector: str, pattern: str) -> None:
    page.wait(f"/{pattern}/.test(document.querySelector({selector!r}).textContent)")


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


def test_the_page_says_that_the_observer_does_not_answer_and_since_when_and_that_it_is_back(
    page: Browser, show: Callable[..., Node]
) -> None:
    node = show(*everybody())
    node.show(1, 5.0, event="_start_", nurse="doing_screw_in_s")
    page.wait("Number(document.getElementById('now').textContent) > 5.2")
    node.answers, node.received = False, 1.0e9
    node.board.note(5.0, "the observer does not answer", BAD)
    as_of = page.value("new Date(1e12).toLocaleTimeString('en-GB')")
    says(page, "#link", f"the observer does not answer; this is as of {as_of}")
    says(page, "#log", "the observer does not answer")
    assert page.text("#now") == "5.0", "time stands still"
    for button in ("[data-word=thief_a2b]", "#tasks .done"):
        assert page.value(f"document.querySelector('{button}').getAttribute('aria-disabled')") == "true"
    assert page.value("document.getElementById('stop').getAttribute('aria-disabled')") == "false", "it waits there"
    node.answers = True
    node.board.note(5.0, "the observer answers again", NOTE)
    says(page, "#link", "connected")
    says(page, "#log", "the observer answers again")
    page.wait("document.querySelector('#tasks .done').getAttribute('aria-disabled') === 'false'")
    page.wait("Number(document.getElementById('now').textContent) > 5.2")


def test_a_phone_that_was_asleep_connects_anew(page: Browser, show: Callable[..., Node]) -> None:
    """Its connection may be dead, and no message ever comes on it: the browser does not notice that for minutes."""
    node = show(*everybody())
    node.show(1, 0.0, event="_start_")
    says(page, "#log", "the mission starts")
    first = "socket.onmessage = null; window.first = socket; received -= 60000"
    page.value(f"{first}; document.dispatchEvent(new Event('visibilitychange')); true")
    page.wait("socket !== null && socket !== window.first && isConnected()")
    says(page, "#link", "connected")
    assert page.text("#log").count("the mission starts") == 1


def test_all_tabs_show_the_same_also_after_a_reload(page: Browser, show: Callable[..., Node]) -> None:
    node = show(*everybody())
    node.show(1, 0.0, event="_start_")
    node.show(2, 2.0, event="thief_a2b", agent="thief", thief="going_a_to_b")
    says(page, "#log", "thief sets off from a to b")
    shown = "['status', 'why', 'turn', 'log', 'agents'].map((id) => document.getElementById(id).textContent).join('|')"
    steady = f"({shown}).replace(/[0-9.]+/g, '')"
    before = page.value(steady)
    page.open(node.board.web.url)
    page.wait("!document.getElementById('main').hidden")
    assert page.value(steady) == before


def test_what_is_pressed_and_the_map_do_not_jump_while_the_mission_goes_on(
    page: Browser, show: Callable[..., Node]
) -> None:
    node = show(*everybody())
    boxes = (
        "[...document.querySelectorAll('header button, #state, #where, #people li, .group')].map((e) => { "
        "const r = e.getBoundingClientRect(); "
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
    there = "[...document.querySelectorAll('main button')].filter((button) => button.offsetParent !== null)"
    assert min(page.value(f"{there}.map((button) => button.getBoundingClientRect().height)")) >= 44, "for fingers"


def tabs(page: Browser, count: int) -> Any:
    """Where the keyboard comes to with so many tabs from the beginning of the page."""
    page.value("document.body.tabIndex = -1; document.body.focus(); document.body.removeAttribute('tabindex')")
    reached = []
    for _ in range(count):
        page.key("Tab", 9)
        reached.append(page.value("document.activeElement.id || document.activeElement.dataset.word || ''"))
    return reached


def test_the_keyboard_does_everything(page: Browser, show: Callable[..., Node]) -> None:
    node = show(*everybody())
    page.wait("document.getElementById('start').getAttribute('aria-disabled') === 'false'")
    assert tabs(page, 3) == ["stop", "state", "start"]
    page.key("Enter", 13, "\r")
    says(page, "#remark", "as you like")
    for status in ("running", "holding"):  # while a new plan is looked for, too
        node.show(1, 0.0, event="_start_", status=status)
        says(page, "#status", status)
        page.value("document.getElementById('stop').focus()")
        page.key("Enter", 13, "\r")
        page.wait("document.getElementById('sure').open")
        page.key("Escape", 27)
        page.wait("!document.getElementById('sure').open")
    page.wait("document.querySelector('[data-word=thief_a2b]').getAttribute('aria-disabled') === 'false'")
    reached = tabs(page, 9)
    assert reached[0] == "stop" and {"thief_a2b", "boy:screw", "log"} <= set(reached)
    assert "thief_b2a" not in reached, "only what is possible where it is"
    until(lambda: node.wanted == [("start", "", 0)], "what was asked for")


def test_what_is_to_be_achieved_and_the_guaranteed_time_are_said(page: Browser, show: Callable[..., Node]) -> None:
    node = show(*everybody())
    node.clock = lambda: 0.0  # the page goes on by three seconds at most without another word on the time
    says(page, "#objectives li", "to be reached")
    says(page, "#objectives li", "screw to be done screw happens.")
    says(page, "#objectives li:nth-child(2)", "not promised")
    says(page, "#objectives li:nth-child(2)", "Optional 1: nap happens.")
    says(page, "#guarantee", "at most 60 time units from the start")
    node.show(1, 0.0, event="_start_")
    node.show(2, 10.0, clock=2.0, event="bot_a2b", agent="bot", bot="going_a_to_b", thief="going_a_to_b")
    matches(page, "#guarantee", r"at most (50|4[789](\.\d)?) time units from now, 60 in all")
    says(page, "#agents", "bot is on its way from a to b")
    says(page, "#agents", "thief is on its way from a to b")
    matches(page, "#agents", r"is to arrive at b in [4567]\.\d to [5678]\.\d")
    node.show(3, 30.0, clock=15.0, bot="going_a_to_b")
    page.wait("document.querySelector('.agent-row.late') !== null")
    matches(page, ".agent-row.late", r"is to arrive at b: [5678]\.\d late")
    matches(page, "#agents", r"thief is at a.*may go to b now")
    node.show(4, 31.0, reachObj="win", status="won")
    matches(page, "#objectives li", "^reached.*screw happens")
    assert page.complaints == []


def test_what_is_next_and_why_is_what_the_strategy_says(page: Browser, show: Callable[..., Node]) -> None:
    rows = [("a", "a", "bot_a2b", "going_a_to_b"), ("a", "b", "bot_a2c", "going_a_to_c"), ("b", "a", "catch", "b")]
    known = [
        {"state": {"bot": here, "thief": other},
         "commands": [{"do": word, "agent": "bot", "from": here, "to": to, "when": ["4 < Cbot"]}]}
        for here, other, word, to in rows
    ]  # fmt: skip
    robot = mover("bot", "robot", 9)
    more = [{"from": "a", "to": "going_a_to_c", "word": "bot_a2c", "sync": "own", "controllable": True},
            {"from": "going_a_to_c", "to": "c", "word": "bot_going_a_to_c2c", "sync": "own", "controllable": False},
            {"from": "b", "to": "b", "word": "catch", "sync": "own", "controllable": True}]  # fmt: skip
    robot["locations"].update({"going_a_to_c": [], "c": []})
    robot["edges"] += more
    strategy = Strategy({"commands_agents": ["bot"], "reaction": 0.1, "strategy": known})
    node = show(robot, mover("thief", "agent", 20), strategies=[strategy])
    node.clock = lambda: 0.0
    node.show(1, 0.0, clock=0.0, event="_start_", unit=30.0)
    matches(page, "#next", r"Next: bot is to go to b in [34]\.\d, if nobody else begins anything before\.")
    matches(page, "#agents", r"next: go to b in [34]\.\d")
    node.show(2, 4.1, clock=0.0, event="bot_a2b", agent="bot", bot="going_a_to_b", commanded=True, unit=30.0)
    says(page, "#agents", "because thief is at a (if it were at b: go to c); then: do catch in 1")
    says(page, "#agents", "at the earliest")
    node.show(3, 30.0, clock=3.0, unit=30.0)
    says(page, "#agents", "should it go to b: bot is to go to c")
    node.show(4, 40.0, clock=0.0, bot="b", thief="b", unit=30.0)
    says(page, "#next", "Next: what others do. Until then the strategy has no command.")
    says(page, "#agents", "waits: nothing is planned for it until something else happens")
    assert page.complaints == []


def test_labels_never_cover_each_other(page: Browser, show: Callable[..., Node]) -> None:
    crowd = [mover(name, kind, 9) for name, kind in (("polBot1", "robot"), ("polBot2", "robot"), ("thief", "agent"))]
    places = {"a": (0, 0), "b": (4, 0.4), "s": (2, 1.2), "door": (3.6, 0.8)}
    ways = (("a", "b", 9.0), ("b", "s", 2.0), ("b", "door", 1.0))
    node = show(*crowd, worker("nurse", "human"), places=places, ways=ways)
    page.value("Object.defineProperty(calm, 'matches', {value: true}); true")  # nobody glides: labels are there at once
    for width, height in ((1100, 800), (360, 740)):
        page.screen(width, height)
        drawn(page)
        seq = 10 if width > 500 else 20
        for number, clock in enumerate((0.0, 3.0, 8.0, 9.4)):
            moving = {"polBot1": "going_a_to_b", "polBot2": "going_a_to_b", "thief": "going_b_to_a"}
            node.show(seq + number, 10.0, clock=clock, **moving)
            page.wait(f"view.seq === {seq + number}")
            page.wait(f"{COVERED}.length === 0")
        node.show(seq + 8, 20.0, polBot1="b", polBot2="b", thief="b")
        page.wait(f"view.seq === {seq + 8}")
        page.wait(f"{COVERED}.length === 0")


def test_where_there_is_no_room_for_a_label_its_agent_is_a_point(page: Browser, show: Callable[..., Node]) -> None:
    crowd = [mover(f"robot_number_{k}_with_a_name", "robot", 9) for k in range(40)]
    node = show(*crowd)
    page.value("Object.defineProperty(calm, 'matches', {value: true}); true")
    page.screen(360, 740)
    drawn(page)
    node.show(2, 10.0, clock=3.0, **{each["name"]: "going_a_to_b" for each in crowd[::2]})
    page.wait("view.seq === 2")
    page.wait(f"{COVERED}.length === 0")
    seen = "(e) => getComputedStyle(e).display !== 'none'"
    labels = page.value(f"[...document.querySelectorAll('#map .mark')].filter({seen}).length")
    points = page.value(f"[...document.querySelectorAll('#map .dot')].filter({seen}).length")
    assert 2 < labels < 40 <= labels + points


def test_every_text_can_be_read_in_light_and_dark_colours(page: Browser, show: Callable[..., Node]) -> None:
    node = show(*everybody(), ends=True)
    going = {"bot": "going_a_to_b", "thief": "going_a_to_b", "nurse": "doing_screw_in_s"}
    for number, status in enumerate(("running", "holding", "lost", "won")):
        node.verdict = (status != "won", "So it ends.") if status in ("won", "lost") else None
        node.show(2 + number, 20.0, clock=12.0, status=status, reason="for a reason", **going)
        says(page, "#status", status)
        for dark in (False, True):
            page.dark(dark)
            page.wait(f"matchMedia('(prefers-color-scheme: dark)').matches === {'true' if dark else 'false'}")
            assert page.value(UNREADABLE) == [], (status, dark)


def test_a_screen_reader_knows_what_everything_is(page: Browser, show: Callable[..., Node]) -> None:
    node = show(*everybody(), ends=True)
    node.show(1, 0.0, event="_start_")
    node.show(2, 20.0, clock=12.0, bot="going_a_to_b", nurse="doing_screw_in_s")
    says(page, "#agents", "bot is on its way from a to b")
    label = "document.getElementById(e.getAttribute('aria-labelledby') || '')?.textContent"
    nameless = f"(e) => !(e.getAttribute('aria-label') || {label} || e.textContent).trim()"
    for kind in ("button", "section", "progress", "[role=group]", "dialog", "svg", "summary"):
        assert page.value(f"[...document.querySelectorAll('{kind}')].filter({nameless}).length") == 0, kind
    assert page.value("document.documentElement.lang") == "en"
    levels = page.value("[...document.querySelectorAll('h1, h2, h3')].map((e) => e.tagName)")
    assert levels[0] == "H1" and set(levels[1:]) == {"H2"}
    is_list = "(e) => e.parentElement.matches('ul:not([role]), ol:not([role])')"
    assert page.value(f"[...document.querySelectorAll('li')].every({is_list})") is True
    ids = page.value("[...document.querySelectorAll('[id]')].map((e) => e.id)")
    assert len(set(ids)) == len(ids)
    read_aloud = "[...document.querySelectorAll('[aria-live], [role=status], [role=alert], [role=log]')]"
    counting = f"{read_aloud}.filter((e) => e.querySelector('.task-time, .next, progress, small'))"
    assert page.value(f"{counting}.length") == 0, "what changes all the while is not read aloud"
    assert page.value("[...document.querySelectorAll('[tabindex]')].every((e) => e.tabIndex === 0)") is True


def test_done_is_said_once_for_each_task(page: Browser, show: Callable[..., Node]) -> None:
    node = show(*everybody())
    node.show(2, 2.0, clock=3.5, nurse="doing_screw_in_s")
    says(page, "#tasks", "nurse: do screw at s")
    page.value("window.setTimeout = () => 0; true")  # however slow the machine: no time passes between the presses
    page.click(".done")
    page.click(".done")
    says(page, "#remark", "as you like")
    until(lambda: node.wanted == [("done", "nurse:screwDONE", 2)], "what was asked for")


def test_the_report_of_an_end_that_the_model_does_not_have_yet_is_confirmed(
    page: Browser, show: Callable[..., Node]
) -> None:
    node = show(*everybody())
    node.clock = lambda: 0.0
    node.show(2, 2.0, clock=1.0, unit=30.0, nurse="doing_screw_in_s")
    says(page, "#tasks", "nurse: do screw at s")
    page.click(".done")
    page.wait("document.getElementById('sure').open")
    matches(page, "#sure-text", r"nurse: do screw at s\. By the model this ends in [12]\.\d time units at the ear")
    page.click("#stop-no")
    page.wait("!document.getElementById('sure').open")
    page.click(".done")
    page.click("#stop-yes")
    says(page, "#remark", "as you like")
    until(lambda: node.wanted == [("done", "nurse:screwDONE", 2)], "what was asked for")
    page.click("#stop")
    says(page, "#sure-text", "Stop the mission?")


def test_a_mission_without_a_goal_is_finished_with_confirmation_and_any_other_is_not(
    page: Browser, show: Callable[..., Node]
) -> None:
    node = show(*everybody(), objective={"kind": "safety", "goal": None, "bad": ["reachObj", "win"]})
    node.show(2, 2.0, clock=1.0)
    says(page, "#status", "running")
    page.click("#finish")
    says(page, "#sure-text", "What is due is answered first.")
    assert page.value("document.getElementById('stop-yes').className") == "calm"
    page.click("#stop-yes")
    page.wait("!document.getElementById('sure').open")
    says(page, "#remark", "as you like")
    until(lambda: node.wanted == [("finish", "", 0)], "what was asked for")
    waits = "the mission ends as soon as what is due is answered: if x then y within 3"
    node.show(2, 3.0, clock=1.0, reason=waits)
    says(page, "#why", waits)
    says(page, "#log", waits)
    page.click("#stop")
    says(page, "#sure-text", "Stop the mission?")
    assert page.value("document.getElementById('stop-yes').className") == ""
    show(*everybody()).show(2, 2.0, clock=1.0)
    assert page.value("document.getElementById('finish').hidden") is True


def test_a_robot_that_is_held_goes_on_without_another_question(page: Browser, show: Callable[..., Node]) -> None:
    node = show(*everybody(), ends=True)
    node.show(2, 2.0, clock=1.0, unit=30.0, bot="going_a_to_b", held=("bot",))
    says(page, "#ends", "bot: held, until it is to continue")
    says(page, "#agents", "bot is on its way from a to b; held, until it is resumed")
    page.click("#ends .done")
    says(page, "#remark", "as you like")
    until(lambda: node.wanted == [("done", "bot:_resume_", 2)], "what was asked for")


def test_without_a_simulator_arrivals_of_robots_and_others_are_reported_on_the_page(
    page: Browser, show: Callable[..., Node]
) -> None:
    node = show(*everybody(), ends=True)
    page.wait("!document.getElementById('others').hidden")
    says(page, "#ends", "bot: not under way")
    node.show(2, 2.0, clock=20.5, thief="going_a_to_b", boy="doing_screw_in_s")
    says(page, "#ends", "thief: a → b")
    says(page, "#ends", "boy: screw at s")
    labels = page.value("[...document.querySelectorAll('#ends .done')].map((each) => each.textContent).join()")
    assert labels == "Done,Arrived,Done"
    pressed = "document.querySelectorAll('#ends .done')[{}].click()"
    page.value(pressed.format(0))  # the robot stands
    page.value(pressed.format(1))
    says(page, "#remark", "as you like")
    until(lambda: node.wanted == [("done", "thief_going_a_to_b2b", 2)], "what was asked for")


def test_with_a_simulator_only_people_report_their_ends(page: Browser, show: Callable[..., Node]) -> None:
    node = show(*everybody())
    node.show(2, 2.0, clock=2.0, thief="going_a_to_b", nurse="doing_screw_in_s")
    says(page, "#tasks", "nurse: do screw at s")
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
    until(lambda: node.wanted == [("say", "thief_a2b", 1)], "what was asked for")


def test_an_order_is_sent_once_with_the_time_that_is_wanted_and_its_answer_is_shown(
    page: Browser, show: Callable[..., Node]
) -> None:
    node = show(*everybody(), desk("tea", "coffee"), labels={"tea": HOSTILE})
    says(page, "#order-buttons", HOSTILE)
    page.click("#order-buttons [data-word=coffee]")  # nothing runs yet
    node.show(1, 0.0, event="_start_")
    page.wait("document.querySelector('[data-word=coffee]').getAttribute('aria-disabled') === 'false'")
    page.click("#order-buttons [data-word=coffee]")
    page.click("#order-buttons [data-word=coffee]")
    page.wait("document.querySelector('[data-word=coffee]').getAttribute('aria-disabled') === 'true'")
    page.value("document.getElementById('within').value = '90'")
    page.click("#order-buttons [data-word=tea]")
    says(page, "#remark", "as you like")
    until(lambda: node.wanted == [("order", "coffee", 1), ("order", "tea within 90", 1)], "what was asked for")
    node.answer(3.0, "coffee", True, "accepted: answered in 40 s at the latest")
    node.answer(4.0, "tea within 90", False, "refused: {tea} is too late")
    page.wait("document.querySelectorAll('#answers li').length === 2")
    says(page, "#answers .good", "coffee: accepted: answered in 40 s at the latest")
    says(page, "#answers .bad", f"refused: {HOSTILE} is too late")
    says(page, "#log", "coffee: accepted")
    node.show(2, 5.0, event="_start_")
    page.wait("view.seq === 2")
    page.click("#answers .good button")
    page.click("#answers .good button")
    page.wait("document.querySelectorAll('#answers button[aria-disabled=true]').length === 1")
    until(lambda: node.wanted[2:] == [("order", "cancel coffee", 2)], "what was asked for")
    assert not page.value("window.hacked || false") and page.complaints == []


def test_a_robot_is_taken_out_of_service_and_brought_back(page: Browser, show: Callable[..., Node]) -> None:
    node = show(*everybody())
    node.show(1, 0.0, event="_start_")
    page.click("#service summary")
    says(page, "#service-buttons [data-robot=bot]", "Take out bot")
    page.wait("document.querySelector('[data-robot=bot]').getAttribute('aria-disabled') === 'false'")
    page.value("document.querySelector('[data-robot=bot]').click()")
    page.wait("document.querySelector('[data-robot=bot]').getAttribute('aria-disabled') === 'true'")
    node.answer(3.0, "leave bot", True, "{bot} is out of service")
    page.wait("document.querySelectorAll('#answers li').length === 1")
    says(page, "#answers .good", "leave bot: bot is out of service")
    assert page.value("document.querySelectorAll('#answers button').length") == 0
    node.show(2, 4.0, event="_leaves_", agent="bot", out_of_service=("bot",))
    says(page, "[data-robot=bot]", "Bring back bot")
    says(page, "#agents", "out of service")
    says(page, "#log", "bot is out of service")
    page.wait("document.querySelector('[data-robot=bot]').getAttribute('aria-disabled') === 'false'")
    page.value("document.querySelector('[data-robot=bot]').click()")  # the remark of this node may cover it
    page.wait("document.querySelector('[data-robot=bot]').getAttribute('aria-disabled') === 'true'")
    says(page, "#remark", "as you like")
    until(lambda: node.wanted == [("order", "leave bot", 1), ("order", "join bot", 2)], "what was asked for")
    assert page.complaints == []


def test_what_is_written_is_ordered_too(page: Browser, show: Callable[..., Node]) -> None:
    node = show(*everybody())
    node.show(1, 0.0, event="_start_")
    page.wait("document.getElementById('write').getAttribute('aria-disabled') === 'false'")
    page.click("#write")  # nothing is written yet
    page.value("document.getElementById('written').value = ' bot at b '")
    page.value("document.getElementById('within').value = '90'")
    page.click("#write")
    page.click("#write")
    says(page, "#remark", "as you like")
    until(lambda: node.wanted == [("order", "bot at b within 90", 1)], "what was asked for")
    node.answer(3.0, "urgent bot at b within 90", True, "accepted: answered in 40 s at the latest")
    page.wait("document.querySelectorAll('#answers li').length === 1")
    node.show(2, 5.0, event="_start_")
    page.wait("view.seq === 2")
    page.click("#answers .good button")
    page.wait("document.querySelectorAll('#answers button[aria-disabled=true]').length === 1")
    until(lambda: node.wanted[1:] == [("order", "cancel bot at b", 2)], "what was asked for")


@pytest.mark.parametrize("status", ["won", "lost", "stopped"])
def test_the_end_is_reported_and_nothing_can_be_pressed(page: Browser, show: Callable[..., Node], status: str) -> None:
    node = show(*everybody())
    node.verdict = (status != "won", "So it ends.")
    node.show(5, 40.0, status=status)
    says(page, "#status", status)
    says(page, "#why", "So it ends.")
    assert page.value("document.title").startswith(status)
    shown = "[...document.querySelectorAll('#people, #others, #free')].filter((e) => e.getBoundingClientRect().height)"
    page.wait(f"{shown}.length === 0")
    enabled = "document.querySelectorAll('body > :not(dialog) button:not([aria-disabled=true])').length"
    assert page.value(enabled) == 0
    node.board.web.close()
    says(page, "#link", "the mission has ended")


def picture() -> bytes:
    """A floor plan of 40 by 20 pixels: a PNG, all grey."""
    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", 40, 20, 8, 0, 0, 0, 0)
    rows = zlib.compress((b"\x00" + bytes([200]) * 40) * 20)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", rows) + chunk(b"IEND", b"")


def test_robots_are_shown_where_they_really_are_on_the_floor_plan(page: Browser, show: Callable[..., Node]) -> None:
    plan = Floor(picture(), 40, 20, 0.5, -4.0, -3.0, 0.1)
    node = show(*everybody(), floor=plan)
    node.show(2, 2.0, clock=2.0, bot="going_a_to_b")
    page.wait("document.querySelector('#map image') !== null")
    loaded = "fetch(document.querySelector('#map image').href.baseVal).then((answer) => answer.status)"
    assert page.value(loaded) == 200
    assert page.value("document.getElementById('real').hidden") is True, "nobody knows where they really are"
    corner = page.value("(({x, y}) => [x, y])(map.at(-4, -3))")
    box = page.value("(({x, y}) => [x, y])((() => { const i = document.querySelector('#map image'); const p = "
                     "i.ownerSVGElement.createSVGPoint(); p.x = 0; p.y = i.height.baseVal.value; "
                     "return p.matrixTransform(i.getCTM()); })())")  # fmt: skip
    assert box == pytest.approx(corner, abs=0.5), "its lower left corner is at its origin"
    node.board.on_positions({"bot": (3.0, 2.0, 1.5)}, {})
    page.wait("!document.getElementById('real').hidden")
    at = page.value("(({x, y}) => `translate(${x.toFixed(1)} ${y.toFixed(1)})`)(map.at(3, 2))")
    page.wait(f"document.querySelector('.dot.robot').getAttribute('transform').startsWith({at!r})")
    assert page.value("document.querySelector('.path').style.display") == "", "and what is left of its way"
    line = "[...document.querySelector('.path').points].map(({x, y}) => [x, y])"
    assert len(page.value(line)) == 2, "straight, as no plan of its navigation is known"
    node.board.on_positions({"bot": (3.0, 2.0, 1.5)}, {"bot": [(0.0, 0.0), (3.1, 2.0), (3.0, 4.0), (9.0, 4.0)]})
    page.wait(f"{line}.length === 3")
    ends = page.value("[map.at(3, 2), map.at(9, 4)].map(({x, y}) => [x, y])")
    assert page.value(line)[::2] == [pytest.approx(end, abs=0.1) for end in ends], "only what is ahead of it"
    assert page.text("[data-agent=thief] text") == "thief ?" and page.text("[data-agent=bot] text") == "bot"
    for dark in (False, True):
        page.dark(dark)
        page.wait(f"{COVERED}.length === 0")  # as soon as nobody glides any more
    node.show(3, 12.0, bot="b")
    node.show(4, 13.0, clock=0.0, bot="going_b_to_a")
    page.wait(f"{line}.length === 2")  # the plan is that of another movement
    node.board.on_positions({}, {})
    page.wait("document.getElementById('real').hidden")
    assert page.complaints == []


def test_everybody_moves_along_the_paths_of_the_floor_plan(page: Browser, show: Callable[..., Node]) -> None:
    path = ("b", "a", ((9.0, 0.0), (9.0, 12.0), (0.0, 12.0), (0.0, 0.0)))
    node = show(*everybody(), floor=Floor(picture(), 40, 20, 0.5, -4.0, -3.0, 0.1, (path,)))
    node.show(2, 2.0, clock=4.5, bot="going_a_to_b")
    page.wait("document.querySelector('.dot.robot') !== null")
    line = "[...document.querySelector('#map .way').points].map(({x, y}) => [x, y])"
    ends = "[scene.places.a, [0, 12], [9, 12], scene.places.b]"
    bends = page.value(f"{ends}.map(([x, y]) => map.at(x, y)).map(({{x, y}}) => [x, y])")
    assert page.value(line) == [pytest.approx(bend, abs=0.1) for bend in bends]
    assert page.value("map.at(9, 12).y >= 0"), "the picture has room for it"
    dot = "document.querySelector('.dot.robot').getAttribute('transform').match(/[-\\d.]+/g).map(Number)"
    page.wait(f"(([x, y]) => y < map.at(0, 11.5).y)({dot})")  # in its middle it is at the top, between the corners
    assert page.complaints == []


def test_after_the_mission_the_page_says_how_to_replay_it_and_offers_what_there_is(
    page: Browser, show: Callable[..., Node]
) -> None:
    node = show(*everybody(), labels={"boy": HOSTILE})
    node.show(1, 0.0, event="_start_")
    node.show(4, 20.0, boy="doing_screw_in_s")
    assert page.value("document.getElementById('timeline').hidden") is True
    node.verdict, node.offers = (0, "It is won."), ("close",)
    node.show(5, 40.0, status="won")
    page.wait("document.querySelectorAll('#lanes .segment').length === 7")
    names = page.value("[...document.querySelectorAll('#lanes .lane-name')].map((each) => each.textContent)")
    assert names == ["bot", "thief", "nurse", f"{HOSTILE[:23]}…", "screw happens."], "agents, and what is promised"
    says(page, "#lanes .segment.acts", f"{HOSTILE}: screw at s, 20.0 to 40.0")
    for width in (360, 1100):
        page.screen(width, 740)
        lanes = "document.querySelector('#lanes svg').viewBox.baseVal.width"
        page.wait(f"{lanes} === document.getElementById('lanes').clientWidth")
        assert page.value("document.documentElement.scrollWidth <= window.innerWidth")
    command = "pursue-gen replay '/a b/mission.bag'"
    played = {"result": "won", "why": "", "began": 1e9, "units": 12.5, "files": ["/a b/mission.bag", "/j.jsonl"]}
    before = {**played, "result": "damaged", "why": f"its journal: {HOSTILE}", "units": None, "present": False}
    node.board.show_missions([{**played, "replay": command, "present": True}, {**before, "replay": ""}])
    says(page, "#recorded", f"Replay: {command}")
    says(page, "#recorded", "Recorded: /a b/mission.bag, /j.jsonl")
    says(page, "#missions-count", "Missions played here (2)")
    day = page.value("dayTime(1e12)")
    says(page, "#missions-list li", f"won {day}, 12.5 time units, this mission")
    says(page, "#missions-list li:nth-child(2) .why", HOSTILE)
    assert page.value("document.querySelector('#missions img')") is None and page.complaints == []
    assert page.value("document.getElementById('another').getAttribute('aria-disabled')") == "true", "no node waits"
    page.open(node.board.web.url)
    says(page, "#status", "won")
    says(page, "#recorded", f"Replay: {command}")
    node.offers = ("next", "close")
    node.board.show()
    says(page, "#after-text", "It begins with bot at a: bring real robots there before it is started.")
    page.click("#another")
    page.click("#close")
    page.wait("document.getElementById('closing').open")
    page.click("#close-no")
    page.click("#close")
    page.click("#close-yes")
    says(page, "#remark", "as you like")
    until(lambda: node.wanted == [("next", "", 0), ("close", "", 0)], "what was asked for")
    node.board.web.close("another mission is prepared")
    says(page, "#link", "another mission is prepared")


GUARDED = {
    "name": "obj", "kind": "safety", "initial": "idle", "locations": {"idle": [], "atRisk": ["Cobj <= 40"], "lose": []},
    "edges": [{"from": "atRisk", "to": "lose", "word": "obj_atRisk2lose", "sync": "own", "controllable": False}],
}  # fmt: skip
SIZES = ((390, 844), (1400, 900), (1920, 1080))


def many(count: int, show: Callable[..., Node]) -> Node:
    """The page of a mission with so many deadlines, 20 places, 5 robots, 3 others and a person."""
    guards = [{**GUARDED, "name": f"obj{k}", "locations": {"idle": [], "atRisk": [f"C{k} <= 40"], "lose": []}}
              for k in range(count)]
    says = "Whenever call {0} happens, look {0} happens within 40 units, once for all that come before it."
    objectives = tuple(Objective(says.format(k), (f"obj{k}",), name=f"look {k}") for k in range(count))
    agents = [mover(f"bot{k}", "robot", 9) for k in range(5)] + [mover(f"guest{k}", "agent", 20) for k in range(3)]
    bad = [[guard["name"], "lose"] for guard in guards]
    places = {"a": (0, 0), "b": (9, 3), "s": (4, 9), **{f"room {k}": (k % 5, k // 5) for k in range(17)}}
    data = model_data(*agents, worker("nurse", "human"), *guards)
    clocks = [*data["clocks"], *(f"C{k}" for k in range(count))]
    objective = {"kind": "safety", "goal": None, "bad": bad}
    return show(*agents, worker("nurse", "human"), *guards, promise=Promise(objectives), places=places, clocks=clocks,
                objective=objective)


def not_in_sight(page: Browser, *selectors: str) -> List[str]:
    """Those of these elements that are not wholly within the window, or that something covers."""
    hidden = ("(e) => { const r = e.getBoundingClientRect(), over = document.elementFromPoint(r.x + r.width / 2, "
              "r.y + r.height / 2); return !r.height || r.top < 0 || r.left < 0 || r.bottom > innerHeight + 1 || "
              "r.right > innerWidth + 1 || !(over && (e.contains(over) || over.contains(e))); }")
    return [one for one in selectors if page.value(f"({hidden})(document.querySelector({one!r}))")]


def test_stop_what_happens_now_and_the_map_are_in_one_screen_whatever_is_pressed(
    page: Browser, show: Callable[..., Node]
) -> None:
    node = many(8, show)
    node.clock = lambda: 0.0
    node.show(2, 2.0, clock=3.0, bot0="going_a_to_b", guest1="going_a_to_b", nurse="doing_screw_in_s", obj3="atRisk")
    for width, height in SIZES:
        page.screen(width, height)
        drawn(page)
        for pressed in ("#tasks .done", "[data-word=guest0_a2b]", "[data-word=guest2_a2b]"):
            page.value(f"document.querySelector({pressed!r}).scrollIntoView({{block: 'nearest'}})")
            assert not_in_sight(page, "#stop", "#status", "#urgent", "#turn", "#map", pressed) == [], (width, pressed)
        assert page.value("document.documentElement.scrollWidth") <= width
        assert width < 800 or page.value("document.documentElement.scrollHeight") <= height, "nothing to scroll"
        assert page.value("(({scrollHeight, clientHeight}) => scrollHeight <= clientHeight)($('state'))"), width


def test_what_is_due_counts_down_and_the_soonest_comes_first(page: Browser, show: Callable[..., Node]) -> None:
    node, now = many(4, show), [0.0]
    node.clock = lambda: now[0]
    row = "[...document.querySelectorAll('#objectives li')].map((e) => `${e.querySelector('.name').textContent}: "
    shown = f"{row}${{e.querySelector('.left').textContent}}|${{e.dataset.left}}`)"
    node.show(2, 2.0, clock=0.0, unit=30.0, obj2="atRisk")
    page.wait(f"/^look 2: due in (40|39)/.test({shown}[0])")
    assert page.value(f"{shown}.slice(1)") == ["look 0: |", "look 1: |", "look 3: |"]
    matches(page, "#urgent", "^look 2: due in (40|39)")
    node.show(3, 20.0, clock=31.0, unit=30.0, obj2="atRisk", obj3="atRisk")
    page.wait(f"/^look 2: due in [89].*soon$/.test({shown}[0]) && /^look 3: .*soon$/.test({shown}[1])")
    colours = "['', '#objectives .left'].map((e) => getComputedStyle(document.querySelector(e || '#guarantee')).color)"
    assert len(set(page.value(colours))) == 2, "and it has a colour"
    node.show(4, 60.0, clock=41.5, unit=30.0, obj3="lose", obj2="atRisk")
    page.wait(f"{shown}[0] === 'look 3: |' && /^look 2: 1.* late.late$/.test({shown}[1])")
    says(page, "#objectives li", "broken")
    sentence = "document.querySelector('#objectives .says')"
    before = page.value(f"{sentence}.getBoundingClientRect().height")
    page.screen(390, 844)
    page.click("#objectives summary")
    page.wait(f"{sentence}.getBoundingClientRect().height > {before}")
    assert page.complaints == []


def test_who_is_not_placed_yet_is_not_on_the_map(page: Browser, show: Callable[..., Node]) -> None:
    guest = mover("guest", "agent", 9)
    guest["initial"] = "doing_being_somewhere"
    guest["locations"]["doing_being_somewhere"] = []
    guest["edges"] = [
        {"from": "doing_being_somewhere", "to": place, "word": f"guest_{place}", "sync": "own", "controllable": False}
        for place in "ab"
    ] + guest["edges"]
    node = show(mover("bot", "robot", 9), guest)
    node.show(1, 0.0, event="_start_")
    page.wait("view.seq === 1")
    says(page, "#agents", "guest is at a place that nobody has said yet")
    mark = "getComputedStyle(document.querySelector('[data-agent=guest]')).display"
    page.wait(f"{mark} === 'none'")
    node.show(2, 1.0, guest="b")
    page.wait(f"{mark} !== 'none'")


@pytest.mark.skipif(not os.environ.get("PURSUE_AXE"), reason="PURSUE_AXE does not name axe-core's axe.min.js")
def test_axe_finds_nothing(page: Browser, show: Callable[..., Node]) -> None:
    node = many(8, show)
    node.show(2, 2.0, clock=35.0, bot0="going_a_to_b", nurse="doing_screw_in_s", obj3="atRisk")
    for width, height in SIZES:
        for dark in (False, True):
            page.screen(width, height)
            page.dark(dark)
            assert page.axe(os.environ["PURSUE_AXE"]) == [], (width, dark)
