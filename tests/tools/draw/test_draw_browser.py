"""The page in a real browser: a scenario from nothing by mouse, changes by keyboard and by finger."""

from __future__ import annotations

import os
import re
import shutil
import sys
import threading
from contextlib import contextmanager
from dataclasses import fields, is_dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Iterator, List, Optional

import pytest

from pursue_gen.language.formatter import format_text
from pursue_gen.language.parser import parse
from pursue_gen.tools.draw.jobs import Jobs
from pursue_gen.tools.draw.page import DrawPage
from pursue_gen.tools.draw.server import DrawServer
from tests.conftest import ROOT
from tests.tools.draw.test_draw_groups import HOTEL

pytest.importorskip("tornado", reason="tornado drives the browser")
sys.path.append(str(ROOT / "tests" / "ros"))
from browser import Browser, browser, program

pytestmark = pytest.mark.skipif(program() is None, reason="there is no Chromium: apt install chromium, or ./run test")

HOSTILE = "<img src=x onerror=window.hacked=1>"
SMALL = f"""poi "a" label "{HOSTILE}" //[0, 0, 0, 0, 0, 0, 1] // the door
poi "b" //[4, 0, 0, 0, 0, 0, 1] bot [4, 1, 0, 0, 0, 0, 1]

connect a and b distance 4

event "work" location b

agent "bot" controllable mobile 1 location a can_do work

reach_objective: do work
"""
ENTER, ARROW_RIGHT, DELETE, CTRL = 13, 39, 46, 2


@pytest.fixture(scope="module")
def there(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    with browser(tmp_path_factory.mktemp("profile")) as opened:
        yield opened


@contextmanager
def drawn(
    there: Browser, file: Path, floor: Optional[Path] = None, width: int = 1400, height: int = 1200
) -> Iterator[Browser]:
    """The page of a scenario's file, open in the browser."""
    jobs = Jobs(file.name, floor, 600, 4096)
    with DrawServer(DrawPage(file, floor, jobs)) as server:
        thread = threading.Thread(target=server.serve_forever, args=(0.02,), daemon=True)
        thread.start()
        there.complaints.clear()
        there.screen(width, height)
        there.open(server.url)
        there.wait("document.body.dataset.ready === 'yes'")
        try:
            yield there
        finally:
            jobs.end()
            there.open("about:blank")
            server.shutdown()
            thread.join()


def text(there: Browser) -> str:
    return str(there.value("document.getElementById('text').value"))


def says(there: Browser, words: str) -> None:
    """Waits until the text has these words."""
    there.wait(f"document.getElementById('text').value.includes({words!r})")


def choose(there: Browser, ident: str, value: str) -> None:
    """Chooses from a list: the menu of a browser is no part of its page."""
    there.value(
        f"(() => {{ const e = document.getElementById({ident!r}); e.value = {value!r}; "
        "e.dispatchEvent(new Event('change', {bubbles: true})); })()"
    )


def tool(there: Browser, name: str) -> None:
    there.click(f"input[value={name}]")


def point(there: Browser, across: float, down: float) -> List[float]:
    """A point of the picture, by the parts of its width and height."""
    found: List[float] = there.value(
        "(() => { scrollTo(0, 0); const r = document.getElementById('plan').getBoundingClientRect(); "
        f"return [r.x + {across} * r.width, r.y + {down} * r.height]; }})()"
    )
    return found


def at(there: Browser, place: str) -> List[float]:
    """Where a place is in the window."""
    found: List[float] = there.value(
        f"(() => {{ scrollTo(0, 0); const r = document.querySelector('#plan [data-key={place}] :is(.dot, .ring)')"
        ".getBoundingClientRect(); return [r.x + r.width / 2, r.y + r.height / 2]; })()"
    )
    return found


def covered(there: Browser) -> int:
    """How many words and places in the picture are covered by others."""
    found: int = there.value(
        "(() => { const boxes = [...document.querySelectorAll('#plan .halo, #plan .dot')]"
        ".map((one) => one.getBoundingClientRect()); return boxes.filter((a, k) => boxes.slice(k + 1).some((b) => "
        "a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom)).length; })()"
    )
    return found


def named(there: Browser, default: str, name: str) -> None:
    """Types a name in place of the one that was proposed."""
    there.wait(f"document.activeElement.id === 'field-name' && document.activeElement.value === {default!r}")
    there.write(name)
    there.key("Enter", ENTER, "\r")
    says(there, f'"{name}"')


def fill(there: Browser, ident: str, value: str) -> None:
    """Types a value into a field."""
    there.value(f"(() => {{ const e = document.getElementById({ident!r}); e.focus(); e.select(); }})()")
    there.write(value)
    there.key("Enter", ENTER, "\r")


def without_places(part: Any) -> Any:
    """A part of a scenario without where it stands in the text, and without poses."""
    if isinstance(part, tuple):
        return tuple(without_places(one) for one in part)
    if not is_dataclass(part):
        return part
    names = (one.name for one in fields(part) if one.name not in ("span", "ends", "pose", "text", "file"))
    return (type(part).__name__, *((name, without_places(getattr(part, name))) for name in names))


def floor_in(folder: Path) -> Path:
    (folder / "map.pgm").write_bytes(b"P5\n120 80\n255\n" + bytes([254]) * 120 * 80)
    (folder / "map.yaml").write_text("image: map.pgm\nresolution: 0.1\norigin: [-2.0, -3.0, 0.0]\n")
    return folder / "map.yaml"


def test_the_tutorials_scenario_is_drawn_from_nothing_and_won(there: Browser, tmp_path: Path) -> None:
    tutorial = (ROOT / "docs" / "tutorial.md").read_text(encoding="utf-8")
    (written,) = re.findall(r"^```pursue\n(.*?)^```", tutorial, re.S | re.M)
    expected = parse(written.replace("fetsh", "fetch"), "night_shift.pur")
    file = tmp_path / "night_shift.pur"
    with drawn(there, file, floor_in(tmp_path)):
        tool(there, "place")
        places = {"pharmacy": (0.2, 0.4), "corridor": (0.5, 0.5), "office": (0.7, 0.4), "room": (0.6, 0.6)}
        for number, (name, where) in enumerate(places.items()):
            there.press(*point(there, *where))
            named(there, "place1", name)
            assert number < 3 or "//[" in text(there)
        tool(there, "way")
        for a, b, distance in (("pharmacy", "corridor", 3), ("corridor", "office", 2), ("corridor", "room", 4)):
            there.press(*at(there, a))
            there.press(*at(there, b))
            says(there, f"connect {a} and {b} distance ")
            fill(there, "field-distance", str(distance))
            says(there, f"connect {a} and {b} distance {distance}\n")
        for name, location, duration in (("light", "corridor", "2"), ("fetch", "pharmacy", "3"), ("handOver", "", "")):
            there.click("#add-event")
            named(there, "work1", name)
            if location:
                choose(there, "field-location", location)
                says(there, f'event "{name}" location {location}')
                fill(there, "field-duration", duration)
                says(there, f"location {location} duration {duration}")
        there.click("#field-collaborative")
        says(there, 'event "handOver" collaborative')
        choose(there, "form", there.value("[...document.querySelectorAll('#form option')]"
                                          ".find((one) => one.textContent === 'three events in turn').value"))
        fill(there, "hole-0", "round")
        for number, name in enumerate(("light", "fetch", "handOver"), 1):
            choose(there, f"hole-{number}", name)
        there.click("#add-form")
        says(there, 'rule "round": light before fetch before handOver')
        tool(there, "agent")
        for name, place in (("lamp", "room"), ("porter", "office"), ("nurse", "room")):
            there.press(*at(there, place))
            named(there, "bot1", name)
            events = {"lamp": ["light"], "porter": ["fetch", "handOver"]}.get(name, [])
            for number, event in enumerate(events, 1):
                there.click(f"#can_do-{event}")
                says(there, f"can_do {', '.join(events[:number])}\n")
        choose(there, "field-kind", "free")
        says(there, 'agent "nurse" mobile 1')
        fill(there, "field-mobile", "3")
        says(there, 'agent "nurse" mobile 3')
        there.click("#reacts_to-handOver")
        says(there, "mobile 3 location room reacts_to handOver")
        choose(there, "form", there.value("[...document.querySelectorAll('#form option')]"
                                          ".find((one) => one.textContent === 'achieve something once').value"))
        choose(there, "hole-0", "handOver")
        there.click("#add-form")
        says(there, "reach_objective: do handOver\n")
        there.wait("document.getElementById('counts').textContent.startsWith('0 errors')")
        assert covered(there) == 0
        made = text(there)
        assert made == format_text(made, "night_shift.pur")
        assert without_places(parse(made, "night_shift.pur")) == without_places(expected)
        if find_spec("scipy"):
            there.click("#measure")
            there.wait("document.getElementById('text').value.includes('// survey: ')")
            assert "pharmacy - corridor" in there.text("#measured")
            there.click("#undo")
            there.wait(f"document.getElementById('text').value === {made!r}")
        there.click("#solve")
        there.wait("document.getElementById('outcome').dataset.verdict === 'won'")
        assert "Time to the goal: at most 34.7 time units" in there.text("#sentences")
        there.click("#cancel")
        there.wait("document.getElementById('cancel').hidden")
        there.click("#save")
        there.wait("document.getElementById('status').textContent.startsWith('Saved')")
        assert file.read_text(encoding="utf-8") == made
        assert there.complaints == []


@pytest.mark.skipif(not find_spec("scipy"), reason="scipy is not installed")
def test_ways_that_were_measured_follow_their_paths_until_a_place_moves(there: Browser, tmp_path: Path) -> None:
    for file in (ROOT / "docs" / "survey").iterdir():
        shutil.copy(file, tmp_path)
    with drawn(there, tmp_path / "three_rooms.pur", tmp_path / "three_rooms.yaml"):
        bends = "[...document.querySelectorAll('#plan polyline.line')].map((one) => one.points.numberOfItems)"
        assert there.value(bends) == [2, 2]
        there.click("#measure")
        there.wait("document.getElementById('text').value.includes('// survey: ')")
        there.wait(f"Math.min(...{bends}) > 2")
        there.press(*at(there, "desk"))
        fill(there, "field-x", "1.5")
        there.wait(f"{bends}.filter((number) => number === 2).length === 2")  # those that end there
        assert max(there.value(bends)) > 2
        assert there.complaints == []


def test_it_is_solved_and_played_and_keys_do_what_the_mouse_does(there: Browser, tmp_path: Path) -> None:
    file = tmp_path / "small.pur"
    file.write_text(SMALL, encoding="utf-8")
    with drawn(there, file):
        assert there.value("document.querySelector('main img')") is None and there.value("window.hacked") is None
        there.click("#solve")
        there.wait("!document.getElementById('read').hidden")
        assert there.value("document.getElementById('outcome').dataset.verdict") == "won"
        there.click("#play")
        there.wait("document.getElementById('game-lines').textContent.includes('The strategy: bot sets off from')")
        there.click("button[data-line=wait]")
        there.wait("document.querySelector('#plan > g.mark title')?.textContent === 'bot'")
        there.click("#choices button")
        there.wait("document.getElementById('game-lines').textContent.includes('bot arrives at b')")
        there.click("#end")
        there.click("text.event-row")
        there.wait("document.querySelector('#inspector h2').textContent === 'Event work'")
        assert there.text("#wishes") == "work happens."
        there.value("document.querySelector('input[value=place]').focus()")
        there.key(" ", 32, " ")
        there.value("document.getElementById('plan').focus()")
        there.key("Enter", ENTER, "\r")
        named(there, "place1", "hall")
        there.value("document.querySelector('input[value=way]').focus()")
        there.key(" ", 32, " ")
        for place in ("hall", "b"):
            there.value(f"document.querySelector('.place[data-key={place}]').focus()")
            there.key("Enter", ENTER, "\r")
        says(there, "connect hall and b distance 2\n")
        there.key("z", 90, modifiers=CTRL)
        there.key("z", 90, modifiers=CTRL)
        there.key("z", 90, modifiers=CTRL)
        there.wait(f"document.getElementById('text').value === {SMALL!r}")
        there.wait("document.querySelector('.place[data-key=hall]') === null")
        there.click("input[value=select]")
        there.value("document.querySelector('.place[data-key=b]').focus()")
        there.key("ArrowRight", ARROW_RIGHT)
        there.key("ArrowRight", ARROW_RIGHT, modifiers=8)
        says(there, " //[5.1, 0, 0, 0, 0, 0, 1]")
        assert there.value("document.activeElement.dataset.key") == "b"
        there.value("document.querySelector('.spot').focus()")
        there.key("ArrowRight", ARROW_RIGHT)
        says(there, " bot [4.1, 1, 0, 0, 0, 0, 1]")
        assert there.value("document.activeElement.dataset.key") == "b bot"
        there.key("z", 90, modifiers=CTRL)
        says(there, " bot [4, 1, 0, 0, 0, 0, 1]")
        there.press(*at(there, '"b bot"'), *point(there, 0.5, 0.25))
        there.wait("!document.getElementById('text').value.includes(' bot [4, 1,')")
        there.key("z", 90, modifiers=CTRL)
        says(there, " //[5.1, 0, 0, 0, 0, 0, 1] bot [4, 1, 0, 0, 0, 0, 1]")
        there.value("document.querySelector('.way').focus()")
        there.key("Delete", DELETE)
        there.wait("!document.getElementById('text').value.includes('connect')")
        there.key("z", 90, modifiers=CTRL)
        says(there, "connect a and b distance 4")
        there.key("z", 90, modifiers=CTRL)
        there.wait(f"document.getElementById('text').value === {SMALL!r}")
        there.value("document.getElementById('text').focus()")
        there.value("document.getElementById('text').setSelectionRange(0, 0)")
        there.write('poi "new" //[2, 2, 0, 0, 0, 0, 1]\npoi missing\n')
        there.wait("document.querySelector('.place[data-key=new]') !== null")
        there.wait("document.querySelector('#findings .error') !== null")
        there.click("#findings .error button")
        start, end = (there.value(f"document.getElementById('text').selection{one}") for one in ("Start", "End"))
        assert text(there)[start:end] == "missing"
        there.click("#item-place-b")
        there.click("#delete")
        there.wait("document.getElementById('status').textContent.startsWith('the text has an error in line 2')")
        x, y = at(there, "b")
        there.press(x, y, x, y - 50)
        there.wait("document.querySelector('.place[data-key=b] .dot').getBoundingClientRect().y > "
                   f"{y - 20} + document.documentElement.getBoundingClientRect().y")
        assert there.complaints == []


def test_what_has_the_focus_keeps_it_and_the_page_stays_where_it_is(there: Browser, tmp_path: Path) -> None:
    file = tmp_path / "small.pur"
    file.write_text(SMALL, encoding="utf-8")
    with drawn(there, file):
        there.screen(1400, 400)
        for ident in ("form", "field-name"):
            there.value("document.getElementById('item-place-b').click()")
            there.value(f"(() => {{ document.getElementById({ident!r}).focus(); scrollTo(0, 0); }})()")
            there.value("import('./state.js').then((page) => page.show())")
            assert there.value("[document.activeElement.id, scrollY]") == [ident, 0]


def test_fingers_move_places_and_the_ground(there: Browser, tmp_path: Path) -> None:
    file = tmp_path / "small.pur"
    file.write_text(SMALL, encoding="utf-8")
    with drawn(there, file, width=420):
        assert there.value("document.documentElement.scrollWidth") <= 420
        bx, by = at(there, "b")
        there.touch([[bx, by], [bx, by - 30], [bx, by - 60]])
        there.wait("!document.getElementById('text').value.includes('//[4, 0,')")
        assert there.value("document.getElementById('text').value.split('\\n')[1]").split(",")[0].endswith("//[4")
        x, y = at(there, '"b bot"')
        there.touch([[x, y], [x - 30, y], [x - 60, y]])
        there.wait("!document.getElementById('text').value.includes(' bot [4, 1,')")
        there.touch([at(there, "a")])
        there.wait("document.getElementById('field-name') && document.getElementById('field-name').value === 'a'")
        before = abs(at(there, "a")[0] - at(there, "b")[0])
        x, y = point(there, 0.5, 0.85)
        there.touch([[x - 20, y], [x - 50, y], [x - 80, y]], [[x + 20, y], [x + 50, y], [x + 80, y]])
        there.wait(
            "Math.abs(document.querySelector('.place[data-key=a] .dot').getBoundingClientRect().x - "
            f"document.querySelector('.place[data-key=b] .dot').getBoundingClientRect().x) > {3 * before}"
        )
        assert there.complaints == []


def test_who_drags_or_deletes_one_is_told_why_it_stays(there: Browser, tmp_path: Path) -> None:
    file = tmp_path / "hotel.pur"
    file.write_text(HOTEL, encoding="utf-8")
    words = "It comes of the statement in line 7, which is for each"
    said = f"document.getElementById('status').textContent.startsWith({words!r})"
    with drawn(there, file):
        place = at(there, "door_room1")
        there.press(*place, *point(there, 0.5, 0.25))
        there.wait(said)
        assert text(there) == HOTEL and at(there, "door_room1") == place
        there.value("document.getElementById('item-place-door_room1').click()")
        there.wait("document.querySelector('#inspector p').textContent.includes('(here r is room1)')")
        assert there.value("document.querySelector('#inspector input')") is None
        there.value("document.querySelector('.place[data-key=door_room2]').focus()")
        there.key("Delete", DELETE)
        there.wait(said)
        there.click("#its-statement")
        there.wait("document.getElementById('field-words').value === 'for each r in rooms: poi \"door\" of r'")
        assert text(there) == HOTEL and there.complaints == []


SCREENS = [(1400, 900), (1920, 1080)]


def is_seen(there: Browser, *selectors: str) -> List[bool]:
    """Which of these elements are wholly in the window, and nothing covers their middle."""
    seen = ("(e) => { const r = e.getBoundingClientRect(), over = document.elementFromPoint(r.x + r.width / 2, r.y + "
            "r.height / 2); return r.height > 0 && r.top >= 0 && r.bottom <= innerHeight && r.left >= 0 && "
            "r.right <= innerWidth && (e.contains(over) || over.contains(e)); }")
    return [bool(there.value(f"({seen})(document.querySelector({one!r}))")) for one in selectors]


@pytest.mark.parametrize("size", SCREENS)
def test_the_plan_stays_while_places_are_added_and_verdict_and_game_are_beside_it(
    there: Browser, tmp_path: Path, size: Any
) -> None:
    file = tmp_path / "small.pur"
    file.write_text(SMALL, encoding="utf-8")
    with drawn(there, file, None, *size):
        tool(there, "place")
        for number in range(1, 9):
            x, y = there.value("(() => { const r = document.getElementById('plan').getBoundingClientRect(); return "
                               f"[r.x + r.width * {0.1 * number}, r.y + r.height * 0.9]; }})()")
            there.press(x, y)
            named(there, "place1", f"room{number}")
            there.key("Tab", 9)
            assert is_seen(there, "#plan", "#field-name", "#tools", "#text") == [True] * 4
            there.value(f"document.getElementById('item-place-room{number}').click()")
            there.wait(f"document.querySelector('#inspector h2').textContent === 'Place room{number}'")
            assert is_seen(there, "#plan", "#inspector h2") == [True, True]
        assert there.value("document.documentElement.scrollHeight <= innerHeight"), "nothing to scroll to"
        for _ in range(16):
            there.key("z", 90, modifiers=CTRL)
        there.wait(f"document.getElementById('text').value === {SMALL!r}")
        there.click("#solve")
        there.wait("document.getElementById('outcome').dataset.verdict === 'won'")
        assert is_seen(there, "#plan", "#outcome", "#sentences li", "#text") == [True] * 4
        there.wait("!document.getElementById('read').hidden")
        there.click("#read")
        there.wait("document.getElementById('reading').open")
        there.click("#unread")
        there.click("#play")
        there.wait("document.querySelector('#choices button') !== null || document.querySelector('#game-lines')"
                   ".textContent.includes('The strategy: bot sets off from')")
        assert is_seen(there, "#plan", "#game-lines", "#end", "[data-line=wait]") == [True] * 4
        assert there.complaints == []


def test_an_empty_page_says_what_to_do_and_goes_on_with_what_is_missing(there: Browser, tmp_path: Path) -> None:
    with drawn(there, tmp_path / "new.pur", None, 1400, 900):
        now = "document.querySelector('#steps .now').firstChild.textContent"
        assert there.value(now) == "Where: add places" and is_seen(there, "#guide") == [True]
        assert there.value("document.querySelectorAll('#findings li').length") == 0, "nothing is wrong yet"
        assert there.text("#counts").startswith("not finished yet")
        there.press(*point(there, 0.3, 0.5))  # the first click adds a place
        named(there, "place1", "hall")
        there.wait(f"{now} === 'Ways: connect places'")
        there.press(*point(there, 0.7, 0.5))
        named(there, "place1", "store")
        there.click("#steps button")
        there.press(*at(there, "hall"), *at(there, "store"))
        says(there, "connect hall and store")
        there.wait(f"{now} === 'Who: add robots and people'")
        there.click("#steps button")
        there.press(*at(there, "hall"))
        named(there, "bot1", "cart")
        there.wait(f"{now} === 'What happens: add events'")
        there.click("#steps button")
        named(there, "work1", "load")
        there.wait(f"{now} === 'What is wanted: choose an objective'")
        there.click("#steps button")
        there.wait("document.activeElement.id === 'form'")
        there.value("document.getElementById('text').focus()")
        there.value("document.getElementById('text').setSelectionRange(1e6, 1e6)")
        there.write("reach_objective: do load\n")
        there.wait("document.getElementById('guide').hidden")
        assert there.complaints == []


def test_a_game_is_played_on_the_plan(there: Browser, tmp_path: Path) -> None:
    file = tmp_path / "chased.pur"
    guest = 'agent "guest" mobile 1 location b\nreach_objective'
    file.write_text(SMALL.replace("reach_objective", guest), encoding="utf-8")
    with drawn(there, file, None, 1400, 900):
        there.click("#play")
        there.wait("document.querySelector('.place.begun') !== null")
        assert "you can go there" in there.value("document.querySelector('.place.begun').getAttribute('aria-label')")
        there.press(*at(there, "a"))
        there.wait("/> [12]/.test(document.getElementById('game-lines').textContent)")
        there.wait("document.getElementById('game-lines').textContent.includes('guest sets off from b to')")
        assert is_seen(there, "#plan", "#game-lines") == [True, True] and there.complaints == []


def test_a_second_way_of_another_length_is_drawn_for_some_agents(there: Browser, tmp_path: Path) -> None:
    file = tmp_path / "small.pur"
    agents = 'agent "bot" controllable mobile 1 location a can_do work\nagent "agv" controllable mobile 2 location a\n'
    one = 'agent "bot" controllable mobile 1 location a can_do work\n'
    file.write_text(SMALL.replace(one, agents), encoding="utf-8")
    with drawn(there, file, None, 1400, 900):
        tool(there, "way")
        there.press(*at(there, "a"), *at(there, "b"))
        there.wait("document.getElementById('status').textContent.startsWith('There is a way already.')")
        assert text(there).count("connect") == 1
        there.click("#second-agv")
        fill(there, "second-distance", "9")
        there.click("#add-second")
        says(there, "connect a and b distance 4 except agv\nconnect a and b distance 9 for agv\n")
        middles = "[...document.querySelectorAll('#plan polyline.line')].map((e) => e.points[0].y)"
        there.wait(f"{middles}.length === 2")
        first, second = there.value(middles)
        assert abs(first - second) > 8, "beside each other"
        assert "9 for agv" in there.text("#plan") and "4 except agv" in there.text("#plan")
        there.wait("document.getElementById('counts').textContent.startsWith('0 errors')")
        assert there.complaints == []


@pytest.mark.skipif(not os.environ.get("PURSUE_AXE"), reason="PURSUE_AXE does not name axe-core's axe.min.js")
@pytest.mark.parametrize("size", [(390, 844), *SCREENS])
def test_axe_finds_nothing(there: Browser, tmp_path: Path, size: Any) -> None:
    for name, words in (("new", ""), ("small", SMALL)):
        file = tmp_path / f"{name}.pur"
        file.write_text(words, encoding="utf-8")
        with drawn(there, file, None, *size):
            if words:
                there.value("document.getElementById('item-way-a b false  ').click()")
            for dark in (False, True):
                there.dark(dark)
                assert there.axe(os.environ["PURSUE_AXE"]) == [], (name, dark)
    there.dark(False)
