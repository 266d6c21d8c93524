"""YAML as it is written: any reader finds the very data, and the same bytes come from both of PyYAML's emitters."""

from __future__ import annotations

from typing import Any

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.partition.yaml_text import EMITTER, inline, yaml_text

LOADERS = [yaml.SafeLoader, getattr(yaml, "CSafeLoader", yaml.SafeLoader)]

MISREAD = (
    "on", "off", "y", "n", "yes", "No", "TRUE", "null", "~", "12", "-1", "0x1", "012", "1e3", "1.0e+3", "12:30", ".inf",
    "2024-01-01", "=", "<<", "_", "-", "- a", "a-b", "a: b", "a #b", "#", "&a", "*a", "!a", "%a", "@a", "`a", "'", '"',
    "{}", "[a", "a, b", "?", "|", ">", "...", "---", " a", "a ", "\t", "a\tb", "é", "a\n", "\na", "a\n\n", " a\nb\n",
    "a \nb", "a\r\nb", "\x85", "\u2028", "\ufeff", "\x00", "\U0001f916", "1/3", "C <= 5", "C - D < -1 && x == 3",
)  # fmt: skip
"""Texts that readers of YAML take for something else when they stand without quotes, and texts that break lines."""

TEXTS = st.sampled_from(MISREAD) | st.text(st.characters(blacklist_categories=["Cs"]), max_size=40)
KEYS = (st.sampled_from(MISREAD) | st.text(" -_:#{}[],&*!|>'\"%@`?abyn01\té", min_size=1, max_size=100)).filter(
    lambda text: "\n" not in text and "\r" not in text
)
SCALARS = st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | TEXTS


def collections(parts: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    """Lists and maps of these parts, in one line or in several."""
    plain = st.lists(parts, max_size=4) | st.dictionaries(KEYS, parts, max_size=4)
    return plain | plain.map(inline)


DATA = st.dictionaries(KEYS, st.recursive(SCALARS, collections, max_leaves=12), max_size=5)


@given(DATA)
def test_what_is_written_is_read_back(data: Any) -> None:
    text = yaml_text(data, ["One line.", "And another: # [é"])
    for loader in LOADERS:
        found = yaml.load(text, Loader=loader)
        assert found == data and list(found) == list(data)
        assert repr(found) == repr(plain(data)), "1, 1.0 and true are equal"


def plain(value: Any) -> Any:
    """The value without marks of where it stands."""
    if isinstance(value, dict):
        return {key: plain(part) for key, part in value.items()}
    return [plain(part) for part in value] if isinstance(value, list) else value


@pytest.mark.skipif(EMITTER is yaml.SafeDumper, reason="PyYAML was built without libyaml")
@given(DATA)
def test_both_emitters_write_the_same_bytes(data: Any) -> None:
    assert yaml_text(data) == yaml_text(data, emitter=yaml.SafeDumper)


def test_one_key_a_line_but_for_what_is_inline() -> None:
    rows = [{"state": inline({"bot": "on", "values": [1, {"open": True}]}), "zones": ["1 < C && C <= 5", "always"]}]
    text = yaml_text({"format": 1, "empty": [], "rows": rows, "text": "a\n\n  b\n"}, ["What this is."])
    assert text.splitlines() == [
        "# What this is.",
        "format: 1",
        "empty: []",
        "rows:",
        "- state: {bot: 'on', values: [1, {open: true}]}",
        "  zones:",
        "  - 1 < C && C <= 5",
        "  - always",
        "text: |",
        "  a",
        "",
        "    b",
    ]


def test_long_values_are_not_folded() -> None:
    words = " ".join(["C <= 5"] * 1000)
    assert yaml_text({"zone": words, "row": inline([words])}).count("\n") == 2


def test_a_value_that_occurs_twice_is_written_twice() -> None:
    poses = inline([0.0, 1.5])
    assert yaml_text({"a": poses, "b": poses}) == "a: [0.0, 1.5]\nb: [0.0, 1.5]\n"
