"""The whole page, and in a real browser: nothing complains, the strategy answers, phones need not scroll sideways."""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path
from typing import Iterator, List

import pytest

from benchmarks.families import deliver_by_robots
from pursue_gen.diagnostics import PursueError
from pursue_gen.explanation.explain import Explanation
from pursue_gen.language import load, parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.rules import Rules
from pursue_gen.synthesis.limits import NO_LIMITS
from pursue_gen.tools.report.verdict import Lost, section
from pursue_gen.tools.report.whole import ReportOptions, lost_report, report_page, solved_both, won_report

pytest.importorskip("tornado", reason="tornado drives the browser")
sys.path.append(str(Path(__file__).resolve().parents[2] / "ros"))
from browser import Browser, browser, program

needs_browser = pytest.mark.skipif(
    program() is None, reason="there is no Chromium: apt install chromium, or ./run test"
)
CATCH = load(Path(__file__).resolve().parents[3] / "scenarios" / "thesis" / "catch_the_thief.pur")

DELIVERY = """
// <script>window.hacked=1</script> <img src=x onerror="window.hacked=1">
poi "store" poi "ward"
connect store and ward distance 2
event "ask"
event "bring" location ward duration 2
state "waiting": initially false, true_if ask false_if bring
stateDependency: ask only_if waiting is_false
stateDependency: bring only_if waiting is_true
agent "helper" controllable mobile 1 location store can_do bring
agent "nurse" location ward can_do ask
objective: if ask then bring within %d
"""


def delivery(deadline: int) -> Scenario:
    return parse(DELIVERY % deadline, "delivery.pur", "delivery")


def won_page(scenario: Scenario, runs: int = 0) -> str:
    first = SolveOptions(optimize="none")
    return report_page(won_report(*solved_both(scenario, first), ReportOptions(runs=runs), NO_LIMITS))


@pytest.fixture(scope="module")
def catch() -> str:
    return won_page(CATCH, 3)


@pytest.fixture(scope="module")
def there(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    with browser(tmp_path_factory.mktemp("profile")) as opened:
        yield opened


def opened(there: Browser, folder: Path, text: str) -> Browser:
    file = folder / "page.html"
    file.write_text(text, encoding="utf-8")
    there.complaints.clear()
    there.screen(1100, 900)
    there.open(file.as_uri())
    return there


def answer_to(there: Browser, question: str) -> str:
    """What the strategy answers, the situations left out."""
    there.value("document.getElementById('strategy-question').value = " + repr(question))
    there.click("#strategy-form button")
    return there.text(".strategy-answer")


# Without a browser ----------------------------------------------------------------------------------------------------


def test_it_says_how_far_each_robot_drove(catch: str) -> None:
    driven = re.search(r"<p>Driven in a mission, on average, in units of distance: (.*?)\.</p>", catch)
    assert driven is not None
    units = dict(robot.split() for robot in driven[1].split(", "))
    assert units.keys() == {"polBot1", "polBot2"} and all(float(far) >= 0 for far in units.values())
    assert any(map(float, units.values()))


def test_two_runs_give_the_same_bytes_without_paths_or_dates(catch: str) -> None:
    assert catch == won_page(CATCH, 3)
    assert str(Path.cwd()) not in catch and not re.search(r"\b20\d\d-\d\d-\d\d\b", catch)


def test_every_section_is_there_and_every_id_once(catch: str) -> None:
    sections = re.findall(r'<section id="([a-z]+)"', catch)
    parts = {"verdict", "map", "timeline", "animation", "strategy", "tables", "automata", "ros", "scenario"}
    assert parts == set(sections)
    ids: List[str] = re.findall(r'\sid="([^"]+)"', catch)
    assert len(ids) == len(set(ids))


def test_nothing_is_fetched(catch: str) -> None:
    for url in re.findall(r'(?:href|src|action)="([^"]*)"', catch):
        assert url.startswith(("#", "data:"))
    assert not re.search(r"url\(['\"]?(?!#)|@import", catch)


def test_ours_and_the_thesis_figures_stand_side_by_side(catch: str) -> None:
    rows = re.findall(r"<tr>(.*?)</tr>", catch)
    cells = [re.sub(r"<[^>]+>", "|", row).replace("||", "|").strip("|").split("|") for row in rows]
    general = next(row for row in cells if row[0] == "General")
    assert general[5:] == ["779", "100.0", "14,697", "100.0"]
    distributed = next(row for row in cells if row[0].startswith("simulated, distributed (3 missions)"))
    assert distributed[-1] == "6.79" or distributed[-1] == "6.80"
    least, median, worst = map(float, distributed[1:4])
    guaranteed = next(row for row in cells if row[0] == "guaranteed")
    assert 0 < least <= median <= worst <= float(guaranteed[-2] or guaranteed[-1]) + 0.1


def test_the_page_compares_in_one_game_too(catch: str) -> None:
    """General and Centralized of one strategy: there Centralized has General's commands without the ends."""
    _, folded = catch.split("All controllers in the ideal game, as the thesis compares them", 1)
    rows = re.findall(r"<tr>(.*?)</tr>", folded.split("</details>", 1)[0])
    cells = [re.sub(r"<[^>]+>", "|", row).replace("||", "|").strip("|").split("|") for row in rows]
    commands = {row[0]: int(row[1]) for row in cells if row[1].isdigit()}
    assert 0 < commands["Centralized"] < commands["General"]
    assert commands["Centralized"] == sum(commands[name] for name in commands if name.startswith("controller"))


def test_a_scenario_that_cannot_be_won_is_explained() -> None:
    lost = delivery(3)
    with pytest.raises(PursueError) as problem:
        solved_both(lost, SolveOptions())
    text = report_page(lost_report(lost, problem.value, NO_LIMITS))
    assert "It cannot be met" in text and "What would change that" in text and 'id="strategy"' not in text
    assert "a deadline of 8 instead of 3 for bring (7 is not enough; line 12)" in text


def test_the_others_prevent_it_only_where_there_are_any() -> None:
    alone = parse('poi "a"\nagent "bot" controllable location a\nobjective: patrol a every 9 by bot\n', "x.pur")
    lost = Lost((), Explanation((), (), (), ()))
    assert "the others can always prevent it" in section(delivery(3), Rules(), None, lost=lost).body_html
    assert "It cannot be met.</strong>" in section(alone, Rules(), None, lost=lost).body_html


# In a browser ---------------------------------------------------------------------------------------------------------


@needs_browser
def test_a_question_in_plain_words_is_answered(there: Browser, tmp_path: Path, catch: str) -> None:
    opened(there, tmp_path, catch)
    answer = answer_to(there, "What will polBot2 do if the thief goes to d?")
    assert "thief is on its way from c to d or on its way from a to d" in answer
    assert "polBot2 (controller_polBot2)" in answer and "polBot2 sets off from a to d" in answer
    shown = there.value(
        "[...document.querySelectorAll('#strategy-found > .state > summary')].map((s) => s.textContent)"
    )
    assert shown and all(re.search("thief on its way from [ac] to d", one) for one in shown)
    assert "thief is at c" in answer_to(there, "polBot1 when thief is at c")
    assert "thief is at c or at a" in answer_to(there, "what happens when the thief is at c or a?")
    for question in ("polBot1 if the thief goes from c to d", "polBot1 while the thief is on its way from c to d"):
        answer = answer_to(there, question)
        assert "thief is on its way from c to d." in answer and "Not understood" not in answer
    assert "Not understood: dragon" in answer_to(there, "what will polBot1 do if the dragon goes to d?")
    assert "never happens" in answer_to(there, "polBot1 at a and polBot2 at a and thief at b")
    assert there.complaints == []


@needs_browser
def test_the_answer_is_that_of_the_data(there: Browser, tmp_path: Path, catch: str) -> None:
    """Counted once more, without the page's own search."""
    opened(there, tmp_path, catch)
    answer = answer_to(there, "polBot1 if the thief is at c")
    count = there.value(
        "(() => { const b = JSON.parse(document.getElementById('strategy-data').textContent);"
        "const k = b.automata.findIndex((a) => a.name === 'thief');"
        "const c = b.automata[k].places.findIndex((p) => p[0] === 'at c');"
        "return b.states.filter((s) => s[0][k] === c).length; })()"
    )
    assert f"{count} situations" in answer


@needs_browser
def test_the_tree_unfolds_by_keyboard_and_is_made_when_it_is_looked_at(
    there: Browser, tmp_path: Path, catch: str
) -> None:
    opened(there, tmp_path, catch)
    first = there.value("document.querySelectorAll('#strategy-tree .state').length")
    there.value("document.querySelector('#strategy-tree .state .state summary').focus()")
    there.key("Enter", 13, "\r")
    there.wait(f"document.querySelectorAll('#strategy-tree .state').length > {first}")
    assert there.value("document.querySelectorAll('.state').length") < 20
    assert there.complaints == []


@needs_browser
def test_places_can_be_chosen_from_lists(there: Browser, tmp_path: Path) -> None:
    opened(there, tmp_path, won_page(delivery(30)))
    there.value(
        "(() => { const s = [...document.querySelectorAll('#strategy-choose label')]"
        ".find((l) => l.firstChild.textContent === 'waiting').querySelector('select');"
        "s.value = '1'; s.dispatchEvent(new Event('change', { bubbles: true })); })()"
    )
    assert "waiting is true" in there.text(".strategy-answer")
    assert "helper (controller_helper): " in answer_to(there, "helper when waiting is true").replace(":", ": ")
    assert "helper is doing bring at ward." in answer_to(there, "helper doing bring")
    assert there.value("window.hacked === undefined") and there.complaints == []


@needs_browser
@pytest.mark.parametrize("width", [360, 1100])
def test_nothing_is_wider_than_the_screen(there: Browser, tmp_path: Path, catch: str, width: int) -> None:
    opened(there, tmp_path, catch)
    there.screen(width, 800)
    answer_to(there, "polBot2 if the thief goes to d")
    there.value("document.querySelectorAll('details').forEach((d) => { d.open = true; })")
    there.wait("document.querySelectorAll('#strategy-found .state ul').length > 0")
    assert there.value("document.documentElement.scrollWidth <= innerWidth")
    assert there.picture(True).startswith(b"\x89PNG") and there.complaints == []


@needs_browser
def test_stages_are_shown_one_after_the_other_with_those_they_speak_of(there: Browser, tmp_path: Path) -> None:
    opened(there, tmp_path, won_page(parse(deliver_by_robots(3), "delivery.pur", "delivery")))
    tree = there.text("#strategy-tree")
    assert "Stage 1 of 2, from the start; its 3 parts are played at the same time" in tree
    assert "bot2 plays until “rule2: next: report”." in tree
    assert "bot2 at depot; the others wherever they are" in tree and "anywhere" not in tree
    assert "Stage 2 of 2, when stage 1 is done" in tree and "It begins in one of these 2 situations" in tree
    assert "never happens" in answer_to(there, "bot2 at room1")
    answer = answer_to(there, "what will bot2 do if bot1 goes to hub?")
    assert "9 situations" in answer and "bot2 sets off from hub to room2" in answer and "anywhere" not in answer
    assert "no command: it is at room2" not in answer, "its part is done there"
    there.value("document.querySelectorAll('details').forEach((d) => { d.open = true; })")
    there.wait("document.querySelectorAll('#strategy-found .state ul').length > 0")
    assert there.value("document.documentElement.scrollWidth <= innerWidth") and there.complaints == []


@pytest.mark.skipif(not os.environ.get("PURSUE_AXE"), reason="PURSUE_AXE does not name axe-core's axe.min.js")
def test_axe_finds_nothing(there: Browser, tmp_path: Path, catch: str) -> None:
    opened(there, tmp_path, catch)
    for width, height in ((390, 844), (1400, 900), (1920, 1080)):
        there.screen(width, height)
        assert there.axe(os.environ["PURSUE_AXE"]) == [], width
