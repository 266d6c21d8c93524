"""A mission on the map: a still picture of the beginning, and in a browser everybody where they were at each moment."""

from __future__ import annotations

import sys
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from pathlib import Path
from typing import Iterator, List, Tuple

import pytest
from missions import made_up, mission

from pursue_gen.drawing.floor import Floor
from pursue_gen.language.scenario import Pose
from pursue_gen.tools.report import animation
from pursue_gen.tools.report.html import page
from pursue_runtime.state import RUNNING

sys.path.append(str(Path(__file__).resolve().parents[2] / "ros"))

SVG = "{http://www.w3.org/2000/svg}"
MOVES = (
    (1.0, "bot1", "bot1_c2b", {"bot1": "going_c_to_b"}, RUNNING),
    (11.0, "bot1", "bot1_going_c_to_b2b", {"bot1": "b"}, RUNNING),
    (12.0, "bot1", "bot1_inb", {"bot1": "doing_bot1_inb_in_b"}, RUNNING),
    (15.0, "bot1", "bot1_inbDONE", {"bot1": "b"}, RUNNING),
    (16.0, "bot2", "bot2_c2a", {"bot2": "going_c_to_a"}, RUNNING),
)


def marks(svg: str) -> List[Tuple[str, str]]:
    """Agents that are drawn, and where."""
    groups = (g for g in ElementTree.fromstring(svg).iter(f"{SVG}g") if g.get("class") == "agent")
    return [(g.find(f"{SVG}text").text or "", g.get("transform", "")) for g in groups]  # type: ignore[union-attr]


def test_without_scripts_it_shows_the_beginning() -> None:
    made = mission("thesis/catch_the_thief")
    found = dict(marks(animation.draw(made.scenario, made)))
    assert list(found) == ["polBot1", "polBot2", "thief"]
    assert found["polBot1"] == found["polBot2"] != found["thief"]


def test_agents_at_one_place_do_not_hide_each_other() -> None:
    sides = [animation._offset(number, 4) for number in range(4)]
    assert len({(round(x), round(y)) for x, y in sides}) == 4
    assert all(y < 0 for _, y in sides)


def test_a_page_with_it_needs_nothing_else() -> None:
    made = mission("thesis/scenario_1")
    text = page("t", [animation.section(made.scenario, made)])
    assert "http://www.w3.org/2000/svg" in text
    assert "src=" not in text.replace("script-src", "")


# In a browser ---------------------------------------------------------------------------------------------------------

browsers = pytest.importorskip("browser", reason="tornado is not installed")
in_browser = pytest.mark.skipif(browsers.program() is None, reason="there is no Chromium: apt install chromium")


@pytest.fixture(scope="module")
def window(tmp_path_factory: pytest.TempPathFactory) -> Iterator["browsers.Browser"]:
    file = tmp_path_factory.mktemp("page") / "mission.html"
    animation.write(made_up(*MOVES), file)
    with browsers.browser(tmp_path_factory.mktemp("profile")) as there:
        there.screen(1100, 900)
        there.open(file.as_uri())
        there.wait("!document.querySelector('.animation-controls').hidden")
        yield there


def place(window: "browsers.Browser", number: int) -> Tuple[float, float]:
    """Where an agent is on the picture."""
    text = window.value(f"document.getElementById('animation-agent-{number}').getAttribute('transform')")
    x, y = text[len("translate("):-1].split()
    return float(x), float(y)


def go(window: "browsers.Browser", moment: float) -> None:
    """Moves the slider, as a person does."""
    window.value(
        "(() => { const slider = document.getElementById('animation-time'); "
        f"slider.value = {moment}; slider.dispatchEvent(new Event('input')); }})()"
    )


@in_browser
def test_the_slider_moves_the_agents_along_their_ways(window: "browsers.Browser") -> None:
    go(window, 0.5)
    at_c, other = place(window, 0), place(window, 1)
    go(window, 6.0)
    half, still = place(window, 0), place(window, 1)
    go(window, 13.0)
    at_b = place(window, 0)
    assert at_c != at_b and still == other
    # Half of the way, but for the step aside that keeps marks off the places.
    for k in (0, 1):
        assert half[k] == pytest.approx((at_c[k] + at_b[k]) / 2, abs=30)
    assert window.value("document.querySelector('#animation-agent-0 .busy').getAttribute('visibility')") == "visible"
    assert "bot1 begins bot1_inb" in window.text("#animation-caption")
    assert "doing bot1_inb at b" in window.text("#animation-where")
    assert window.complaints == []


def test_everybody_moves_along_the_paths_of_a_floor_plan() -> None:
    made = made_up(*MOVES)
    around = {"c": (0.0, 0.0), "b": (4.0, 0.0), "a": (0.0, 9.0)}
    poses = {name: Pose(x, y, 0.0, 0.0, 0.0, 0.0, 1.0) for name, (x, y) in around.items()}
    pois = tuple(replace(poi, pose=poses.get(poi.name)) for poi in made.scenario.pois if poi.name in poses)
    scenario = replace(made.scenario, pois=pois)
    paths = {
        ("b", "c"): ((4.0, 0.0), (4.0, 3.0), (0.0, 3.0), (0.0, 0.0)),
        ("c", "a"): ((0.0, 0.0), (1.0, 0.0), (1.0, 9.0), (0.0, 9.0)),
    }
    floor = Floor("data:image/png;base64,", 20, 20, 0.5, -0.5, -0.5, 0.0, paths)
    segments = animation._segments(scenario, made, floor)
    (x0, y0), (x1, y1), (x2, y2), (x3, y3) = segments["bot1"][1].line
    assert (x0, x2, y1, y0) == pytest.approx((x1, x3, y2, y3)) and (x2 - x0) / (y1 - y0) == pytest.approx(-4 / 3)
    start, bend, end = segments["bot2"][-1].line  # it is not there yet
    assert (start[1], bend[0]) == pytest.approx((bend[1], end[0])) and end[1] < bend[1]
    assert floor.uri in animation.draw(scenario, made, floor)


@in_browser
def test_who_is_still_under_way_at_the_end_has_not_arrived(window: "browsers.Browser") -> None:
    go(window, 16.0)
    start = place(window, 1)
    go(window, 20.0)
    end = place(window, 1)
    assert start != end
    assert "on its way from c to a" in window.text("#animation-where")


@in_browser
def test_steps_go_from_event_to_event(window: "browsers.Browser") -> None:
    go(window, 0.0)
    window.click("#animation-on")
    assert window.text("#animation-now") == "1"
    window.click("#animation-on")
    assert window.text("#animation-now") == "11"
    window.click("#animation-back")
    assert window.text("#animation-now") == "1"
    assert "bot1 sets off from c to b" in window.text("#animation-caption")


@in_browser
def test_it_plays_to_the_end_and_pauses(window: "browsers.Browser") -> None:
    go(window, 0.0)
    window.value("document.getElementById('animation-speed').value = '10'")
    window.click("#animation-play")
    window.wait("Number(document.getElementById('animation-time').value) > 2")
    window.click("#animation-play")
    window.wait("document.getElementById('animation-play').textContent.includes('play')")
    stopped = window.text("#animation-now")
    window.value("new Promise((done) => setTimeout(done, 150))")
    assert window.text("#animation-now") == stopped
    window.click("#animation-play")
    window.wait("document.getElementById('animation-now').textContent === '20'")
    window.wait("document.getElementById('animation-play').textContent.includes('play')")
    assert window.complaints == []


@in_browser
def test_it_fits_a_phone(window: "browsers.Browser") -> None:
    window.screen(380, 700)
    assert window.value("document.documentElement.scrollWidth <= window.innerWidth")
    window.screen(1100, 900)
