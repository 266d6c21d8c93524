"""The page that holds everything: names cannot become markup, nothing comes from elsewhere, the bytes are the same."""

from __future__ import annotations

import json
from html.parser import HTMLParser
from typing import Dict, List, Optional, Tuple

import pytest

from pursue_gen.drawing import look
from pursue_gen.tools.report.html import Section, data, figure, page, table

HOSTILE = "<img src=x onerror=\"alert('1')\">&amp;\x00\u2028</script>"


class Seen(HTMLParser):
    """What a browser's parser would find."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: List[Tuple[str, Dict[str, Optional[str]]]] = []
        self.words: List[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: List[Tuple[str, Optional[str]]]) -> None:
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data: str) -> None:
        self.words.append(data)

    def named(self, tag: str) -> List[Dict[str, Optional[str]]]:
        return [attributes for name, attributes in self.tags if name == tag]


def test_a_hostile_name_stays_text() -> None:
    text = page(HOSTILE, [Section("a", HOSTILE, table([HOSTILE], [[HOSTILE]], HOSTILE) + figure("", HOSTILE))])
    seen = Seen(text)
    assert not seen.named("img")
    assert not any("onerror" in attributes for _, attributes in seen.tags)
    assert "".join(seen.words).count("onerror") == 8  # title, h1, link, h2, caption, th, td, figcaption
    assert "\x00" not in text


def test_data_survives_and_cannot_end_its_script() -> None:
    text = data("numbers", {"name": HOSTILE})
    assert text.count("</script>") == 1
    assert json.loads(text[text.index(">") + 1 : text.rindex("<")]) == {"name": HOSTILE}


def test_only_the_scripts_of_sections_may_run() -> None:
    text = page("t", [Section("a", "A", "", script="let one = 1;"), Section("b", "B", "", script="let one = 1;")])
    policy = Seen(text).named("meta")[1]["content"] or ""
    scripts = [attributes for attributes in Seen(text).named("script") if "type" not in attributes]
    assert len(scripts) == policy.count("'sha256-") == 2  # the page's own, and the sections' once
    assert "script-src 'unsafe-inline'" not in policy and "default-src 'none'" in policy


def test_nothing_comes_from_elsewhere_and_links_lead_somewhere() -> None:
    seen = Seen(page("t", [Section("a", "A", ""), Section("b", "B", "")]))
    ids = {attributes["id"] for _, attributes in seen.tags if "id" in attributes}
    for _, attributes in seen.tags:
        for key in ("href", "src"):
            value = attributes.get(key)
            assert value is None or value.startswith("data:") or value[1:] in ids


def test_two_sections_with_one_id_are_refused() -> None:
    with pytest.raises(ValueError, match="one id"):
        page("t", [Section("a", "A", ""), Section("a", "B", "")])


def test_agents_differ_in_more_than_colour() -> None:
    looks = list(look.agent_looks([f"bot{place}" for place in range(60)]).values())
    assert len({(one.colour, one.dash, one.shape) for one in looks}) == len(looks)
    assert len({(one.dash, one.shape) for one in looks[:8]}) == len({one.fill for one in looks[:8]}) == 8


@pytest.mark.parametrize(("value", "shown"), [(0.0, "0"), (-0.001, "0"), (1.5, "1.5"), (10.0, "10"), (2.456, "2.46")])
def test_numbers_are_short(value: float, shown: str) -> None:
    assert look.number(value) == shown
