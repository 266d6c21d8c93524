"""Labels wherever people read: in full, and never as markup or code; and names wherever machines do."""

from __future__ import annotations

import json
import re
import xml.etree.ElementTree as ElementTree
from collections import Counter
from functools import lru_cache
from html.parser import HTMLParser
from typing import Dict, List, Optional, Set, Tuple

from pursue_gen.explanation.explain import explain, render
from pursue_gen.language import parse
from pursue_gen.language.checks import check
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import Solution, solution
from pursue_gen.synthesis.limits import Limits
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tools.play.session import opening, session_of
from pursue_gen.tools.report.whole import Report, ReportOptions, pictures, report_page, won_report
from pursue_gen.workspace import Options, generate
from pursue_runtime.data import parse_data
from pursue_runtime.model import Model
from pursue_runtime.state import RUNNING, SystemState
from pursue_runtime.ui.mission_view import possible_words
from pursue_runtime.ui.page import Facts, FloorPlan, Page
from pursue_runtime.vocabulary import sentence

DESK, SHELF = "<script>alert('d')</script>", "]]> & <b>it's</b>"
FETCH, RING = "fetch [it](javascript:x) {{ 7*7 }}", "`ring` *now* ${HOME} %s"
BOT, GUEST = "</title><i>Porter</i> \\1", "!!python/object: {a: b} # visitor"
LABELS = {"desk": DESK, "shelf": SHELF, "fetch": FETCH, "ring": RING, "bot": BOT, "guest": GUEST}
TEXT = f"""\
poi "desk" label "{DESK}"
poi "shelf" label "{SHELF}"
connect desk and shelf distance 2
event "fetch" label "{FETCH}" location shelf duration 2
event "ring" label "{RING}"
event "sign" location desk
rule "order": fetch before sign
agent "bot" label "{BOT}" controllable mobile 1 location desk can_do fetch, sign
agent "guest" label "{GUEST}" mobile 2 location desk can_do ring
assume: guest does ring at_most 3 times
reach_objective: do sign within WITHIN
"""
BARE = re.sub(r' label "[^"]*"', "", TEXT)


@lru_cache(maxsize=None)
def scenario(text: str = TEXT, within: int = 30) -> Scenario:
    found = parse(text.replace("WITHIN", str(within)), "labels.pur")
    assert not [finding for finding in check(found) if finding.severity.value == "error"]
    return found


@lru_cache(maxsize=None)
def solved(text: str = TEXT) -> Solution:
    return solution(translate(scenario(text)), scenario_objective(scenario(text)), Rules())


@lru_cache(maxsize=None)
def files(text: str = TEXT) -> Dict[str, bytes]:
    won = solved(text)
    return dict(generate(scenario(text), won.network, won.objective, won.strategy, Options()))


class Reader(HTMLParser):
    """The elements of a page, and its text."""

    def __init__(self, markup: str) -> None:
        super().__init__()
        self.elements: Counter[str] = Counter()
        self.attributes: Set[str] = set()
        self.text = ""
        self.feed(markup)

    def handle_starttag(self, tag: str, attrs: List[Tuple[str, Optional[str]]]) -> None:
        self.elements[tag] += 1
        self.attributes |= {name for name, _ in attrs}

    def handle_data(self, data: str) -> None:
        self.text += data


@lru_cache(maxsize=None)
def report(text: str = TEXT) -> Report:
    return won_report(scenario(text), (solved(text), solved(text)), ReportOptions(), Limits(60.0))


def test_a_report_shows_labels_as_text() -> None:
    page, bare = Reader(report_page(report())), Reader(report_page(report(BARE)))
    for label in (DESK, SHELF, FETCH, BOT, GUEST):
        assert label in page.text
    for tag in ("script", "style", "b", "i", "iframe"):
        assert page.elements[tag] == bare.elements[tag], tag
    assert page.elements["title"] == bare.elements["title"] + 1, "of the lane whose name has no room"
    assert page.attributes == bare.attributes


def test_pictures_are_well_formed_and_show_labels() -> None:
    drawn = pictures(report())
    texts = {name: "".join(ElementTree.fromstring(svg).itertext()) for name, svg in drawn.items()}
    assert len(texts) >= 2
    assert all(any(DESK in text for text in texts.values()) for _ in texts)
    timeline = next(text for name, text in texts.items() if "timeline" in name or "mission" in name)
    assert FETCH in timeline
    assert BOT[:10] in timeline


def test_machines_have_names() -> None:
    labelled, bare = files(), files(BARE)
    assert set(labelled) == set(bare)
    differing = {path for path in bare if labelled[path] != bare[path]}
    shown = {"README.md", "map.svg", "model.yaml", "ui.yaml"}
    digests = {"labels.pur", "game.yaml", "mission.yaml"}
    assert {path.split("/")[-1] for path in differing} <= shown | digests
    assert {"TGA.xml", "TCTL.q", "UPPAAL_plan.txt"}.isdisjoint(differing)
    path = "src/observer/config/model.yaml"
    with_labels, without = parse_data(labelled[path], path), parse_data(bare[path], path)
    assert with_labels.pop("labels") == LABELS
    assert {**with_labels, "assumptions": ()} == {**without, "assumptions": ()}


def test_a_readme_shows_labels_as_text() -> None:
    readme = files()["README.md"].decode()
    assert r"\!\!python\/object\: \{a\: b\} \# visitor does \`ring\` \*now\* \$\{HOME\} \%s at most 3 times" in readme


def test_an_explanation_shows_labels() -> None:
    found = render(explain(scenario(within=4), Rules(), Limits(20.0, work=2_000_000)), 1000)
    assert f"{BOT}: sets off from {DESK} to {SHELF}" in found
    words = re.sub(r"assume: [^;(\n]*", "", found)  # a statement, to be written into the scenario, has names
    assert not re.search(r"\b(desk|shelf|bot:|guest)\b", words)


def test_a_game_shows_labels() -> None:
    shown = "\n".join(opening(session_of(scenario(), Rules())))
    assert f"{BOT}" in shown
    assert f"{GUEST}: do {RING}" in shown
    assert f"sets off from {DESK} to {SHELF}" in shown


def test_a_mission_shows_labels_and_listens_to_names() -> None:
    model = Model(parse_data(files()["src/observer/config/model.yaml"], "model.yaml"))
    start = model.initial()
    before = SystemState(0, 0.0, start.locations, start.values, start.clocks, status=RUNNING)
    under_way = {**start.locations, "bot": "going_desk_to_shelf"}
    gone = SystemState(1, 2.0, under_way, start.values, start.clocks, "bot_desk2shelf", "bot", RUNNING)
    assert sentence(model, gone, before) == f"{BOT} sets off from {DESK} to {SHELF}"
    offers = possible_words(model, before, dict.fromkeys(start.clocks, 5.0), ["agent"])
    assert [(offer.word, offer.text) for offer in offers if "ring" in offer.word] == [("ring", f"{GUEST} does {RING}")]
    page = Page(model, FloorPlan({"desk": (0.0, 0.0), "shelf": (1.0, 0.0)}, (("desk", "shelf", 2.0),)), ["bot"])
    scene = page.scene()
    assert scene["labels"] == LABELS
    assert {("guest", "ring", RING)} <= {(each["agent"], each["word"], each["label"]) for each in scene["buttons"]}
    seen = page.view(Facts("running", (), gone, 2.0, 2.0))
    assert seen["agents"][0]["doing"] == f"is on its way from {DESK} to {SHELF}"
    assert seen["tasks"][0]["shown"] == BOT
    assert BOT in seen["turn"]
    json.dumps([scene, seen])
