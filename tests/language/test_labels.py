"""Labels: what people read in place of names."""

from __future__ import annotations

import json
import re
from typing import List

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.language import parse
from pursue_gen.language.document import edited
from pursue_gen.language.draft import Draft, rename
from pursue_gen.language.formatter import format_text
from pursue_gen.language.labels import LONGEST_LABEL, markdown, why_no_label
from pursue_gen.language.sentences import objective_words
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.uppaal import write_network
from pursue_gen.tools.lsp.fixes import fixes
from pursue_gen.tools.lsp.hover import hover
from tests.language.texts import findings

TEXT = """\
poi "desk" label "front desk" //[1, 2, 0, 0, 0, 0, 1]
poi "shelf"
    label "a shelf, 'high'" //[4, 2, 0, 0, 0, 0, 1]
connect desk and shelf distance 3
event "ring" label "ring the bell"
event "fetch" label "fetch <it>" location shelf duration 2
agent "bot" label "Porter 1" controllable mobile 1 location desk can_do fetch
agent "guest" label "a guest" mobile 2 location desk can_do ring
assume: guest leaves shelf within 20
objective: if ring then fetch within 30
objective: avoid guest at shelf and not bot at shelf
objective: patrol shelf, desk in order every 40 by bot
"""
BARE = re.sub(r'\s+label "[^"]*"', "", TEXT)


def codes(source: str) -> List[str]:
    return [finding.code for finding in findings(source)]


def test_people_read_labels_and_the_network_has_names() -> None:
    scenario, bare = parse(TEXT, "text.pur"), parse(BARE, "text.pur")
    assert scenario.pois[0].pose is not None
    assert (scenario.pois[1].shown, scenario.shown("bot"), scenario.shown("other")) == (
        "a shelf, 'high'", "Porter 1", "other"
    )
    assert objective_words(scenario) == [
        "Whenever ring the bell happens, fetch <it> happens within 30 units, once for all that come before it.",
        "It never holds that a guest is at a shelf, 'high' and Porter 1 is not at a shelf, 'high'.",
        "Porter 1 visits a shelf, 'high' and front desk in this order, each at least every 40 units.",
    ]
    assert [each.text for each in scenario.objectives] == [e.text for e in bare.objectives]
    assert translate(scenario) == translate(bare)
    assert write_network(translate(scenario), scenario_objective(scenario)) == write_network(
        translate(bare), scenario_objective(bare)
    )


def test_the_layout_keeps_labels() -> None:
    text = format_text(TEXT, "text.pur")
    assert format_text(text, "text.pur") == text
    assert parse(text, "text.pur").labels == parse(TEXT, "text.pur").labels
    assert 'poi "desk" label "front desk"' in text


FILLERS = "\u3164\u115f\u1160\uffa0\u2800\u17b4\u17b5\u180b\u180f\u034f\U0001d159"


@pytest.mark.parametrize(
    ("label", "why"),
    [
        ("", "empty"), ("  ", "empty"), (" a", "blank"), ("a" * 61, "longer than 60"), ("a\u202eb", "cannot be seen"),
        ("a\tb", "cannot be seen"), ("a\u200bb", "cannot be seen"),
        *((letter, "show nothing") for letter in FILLERS),
        ("Porter\u31641", "show nothing"), ("Porter\U000e0101", "nothing|cannot be seen"),
        ("\u0301", "no letter or sign"), ("\ufe0f \u0301", "no letter or sign"),
    ],
)  # fmt: skip
def test_what_cannot_be_shown_is_an_error(label: str, why: str) -> None:
    (finding,) = [one for one in findings(TEXT.replace("front desk", label)) if one.code != "PML190"]
    assert finding.code == "PML282"
    assert re.search(why, finding.message)


LABELS = ["a", "security door", "<b>'&", "`x` [y](z) {{ }} ${a} %s \\n", "\N{HEBREW LETTER QOF}", "\u6249", "a" * 60]
LABELS += ["\u2764\ufe0f", "e\u0301"]


@pytest.mark.parametrize("label", LABELS)
def test_any_text_that_can_be_seen_is_a_label(label: str) -> None:
    assert "PML282" not in codes(TEXT.replace("front desk", label))


def test_labels_that_people_cannot_tell_apart() -> None:
    assert codes(TEXT.replace("Porter 1", "a guest")) == ["PML283"]
    assert codes(TEXT.replace("a shelf, 'high'", "desk")) == []
    assert codes(TEXT.replace(' label "front desk"', "").replace("a shelf, 'high'", "desk")) == ["PML283"]
    assert codes(TEXT.replace("Porter 1", "front desk")) == []


def test_label_is_still_a_name() -> None:
    text = TEXT.replace("fetch", "label").replace('label "label <it>"', 'label "fetch"')
    assert parse(text, "text.pur").events[1].name == "label"


def test_a_label_on_a_line_of_its_own_belongs_to_the_statement_above() -> None:
    assert parse(TEXT, "text.pur").pois[1].label == "a shelf, 'high'"


def test_a_name_that_cannot_be_one_may_be_a_label() -> None:
    text = BARE.replace("shelf", "high_shelf").replace('poi "high_shelf"', 'poi "high shelf"')
    (finding,) = [one for one in findings(text) if one.code == "PML101"]
    assert 'poi "high_shelf" label "high shelf"' in finding.hint
    document = Draft.of(text, "text.pur")
    fix = next(fix for fix in fixes(document, 0, len(text)) if "with label" in fix.title)
    mended = edited(text, fix.edits)
    assert 'poi "high_shelf" label "high shelf"' in mended
    assert codes(mended) == []


def test_a_rename_leaves_labels_alone() -> None:
    document = Draft.of(TEXT, "text.pur")
    text = edited(TEXT, rename(document, TEXT.index("desk") + 1, "counter"))
    assert 'poi "counter" label "front desk"' in text


def test_hovering_shows_a_label_as_text() -> None:
    text = TEXT.replace("Porter 1", "*P* <b>[x](y)")
    found = hover(Draft.of(text, "text.pur"), text.index('"bot"') + 2)
    assert found is not None
    assert "people read \u201c\\*P\\* \\<b\\>\\[x\\]\\(y\\)\u201d" in found.markdown


@given(st.text(max_size=20))
def test_markdown_shows_just_the_text(text: str) -> None:
    assert re.sub(r"\\([!-/:-@\[-`{-~])", r"\1", markdown(text)) == text


@given(st.text(max_size=70))
def test_a_label_is_printable_and_short(text: str) -> None:
    if not why_no_label(text):
        assert text.isprintable() and text.strip() == text and 0 < len(text) <= LONGEST_LABEL
        assert json.loads(json.dumps(text)) == text
