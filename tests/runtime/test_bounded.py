"""The one reader of JSON and YAML: what our programs write comes through, hostile texts are refused with a reason."""

from __future__ import annotations

import json
from fractions import Fraction
from typing import Any, Callable, Dict, Union

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.partition.yaml_text import yaml_text
from pursue_runtime.bounded import (
    DATA,
    SETTINGS,
    BadText,
    Bounds,
    node_value,
    read_json,
    read_yaml,
    yaml_tree,
)
from pursue_runtime.numbers import exact, whole

SMALL = Bounds(size=200, depth=3, values=10)

Read = Callable[[Union[str, bytes]], Any]


def tree_value(text: Union[str, bytes]) -> Any:
    """The value in a text by way of its tree."""
    root = yaml_tree(text if isinstance(text, str) else text.decode("latin-1"), DATA)
    return None if root is None else node_value(root)


READERS: Dict[str, Read] = {"json": read_json, "yaml": read_yaml, "tree": tree_value}


def refused(read: Read, text: Union[str, bytes]) -> BadText:
    with pytest.raises(BadText) as caught:
        read(text)
    assert caught.value.reason
    assert len(str(caught.value)) < 300
    assert "\n" not in str(caught.value)
    return caught.value


scalars = (
    st.none() | st.booleans() | st.integers(-(10**18) + 1, 10**18 - 1)
    | st.floats(allow_nan=False, allow_infinity=False) | st.text(st.characters(codec="utf-8"))
)  # fmt: skip
keys = st.text(st.characters(min_codepoint=32, max_codepoint=0x2000), min_size=1, max_size=90)
values = st.recursive(
    scalars, lambda inner: st.lists(inner, max_size=4) | st.dictionaries(keys, inner, max_size=4), max_leaves=20
)


@given(values)
def test_what_json_holds_comes_through(value: Any) -> None:
    assert read_json(json.dumps(value)) == value
    assert read_json(json.dumps(value, ensure_ascii=False).encode()) == value


@given(st.dictionaries(keys, values, max_size=4))
def test_what_our_programs_write_as_yaml_comes_through(value: Dict[str, Any]) -> None:
    text = yaml_text(value)
    assert read_yaml(text) == value
    assert tree_value(text) == value


@given(st.text(st.sampled_from("ab: -[]{},'\"#\n\t01.~!&*|>?%@`\\x"), max_size=40) | st.text(max_size=40))
def test_any_text_is_read_as_pyyaml_reads_it_or_refused(text: str) -> None:
    try:
        found = read_yaml(text)
    except BadText:
        return
    # Of the same parser: libyaml and PyYAML's own do not agree on everything, such as tabs.
    assert shape(found) == shape(yaml.load(text, Loader=getattr(yaml, "CBaseLoader", yaml.BaseLoader)))


@given(st.text(st.sampled_from("ab: -[]{},'\"#\n\t01.~!&*|>?%@`\\x"), max_size=40) | st.text(max_size=40))
def test_any_text_of_a_person_is_read_as_pyyaml_reads_it_or_refused(text: str) -> None:
    try:
        found = tree_value(text)
    except BadText:
        return
    assert shape(found) == shape(yaml.load(text, Loader=yaml.BaseLoader))


def shape(value: Any) -> Any:
    """The value without its scalars, whose types differ."""
    if isinstance(value, dict):
        return {"keys": [shape(part) for part in value.values()]}
    return [shape(part) for part in value] if isinstance(value, list) else "scalar"


@given(st.binary(max_size=60))
def test_any_bytes_are_read_or_refused(content: bytes) -> None:
    for read in (read_json, read_yaml):
        try:
            read(content)
        except BadText as problem:
            assert problem.reason


@pytest.mark.parametrize("name", READERS)
@pytest.mark.parametrize("text", [
    "[" * 100_000, "[" * 100_000 + "]" * 100_000, '{"a":' * 100_000, '[{"a":' * 50_000, "[0, " * 65 + "0" + "]" * 65,
    '{"a": 1, "a": 2}', '{"b": [{"a": 1, "a": 1}]}', "9" * 19, "[" + "9" * 1_000_000 + "]", "-" + "9" * 19,
    "\ud800", b'"\xff"', "[", "{", '"', '{"a" 1}', "[1 2]]",
])  # fmt: skip
def test_refused_in_every_format(name: str, text: Union[str, bytes]) -> None:
    if isinstance(text, bytes) and name == "tree":
        return
    refused(READERS[name], text)


@pytest.mark.parametrize("text", ["NaN", "[Infinity]", "-Infinity", "1e999", '"\\ud800"', '["\\udc00\\ud800"]', ""])
def test_refused_in_json(text: str) -> None:
    refused(read_json, text)


@pytest.mark.parametrize("text", [
    "a: &x 1", "a: &x [1]\nb: *x", "a: *x", "!!int 3", "!!python/object:os.system {}", "! x", "a: !b c", "- " * 100_000,
    "? " * 100_000, "a\n---\nb", "[1, 2]: 3", "{a: 1}: 3", "a: 1\na: 2", "a: {b: 1, b: 1}", "1: a\n1: b",
    "~: a\nnull: b", "9" * 400 + ".0", "a: [", "a: b: c", "\0", "%TAG ! x\n--- !y z",
])  # fmt: skip
def test_refused_in_yaml(text: str) -> None:
    refused(read_yaml, text)
    refused(tree_value, text)


def test_a_bomb_of_aliases_does_not_go_off() -> None:
    bomb = "a: &a [x]\n" + "".join(f"{b}: &{b} [*{a}, *{a}, *{a}, *{a}]\n" for a, b in zip("abcdefghi", "bcdefghij"))
    assert "aliases" in refused(read_yaml, bomb).reason
    assert "aliases" in refused(tree_value, bomb).reason


@pytest.mark.parametrize("text", [
    "1:30", "1:30:00", "1:30.5", "010", "0x1f", "0b11", "1_000", "2026-01-01", "2026-01-01 10:00:00", ".nan", ".inf",
    "-.inf", "<<", "=", "1e5", "nan", "+", ".", "e5",
])  # fmt: skip
def test_what_only_yaml_takes_for_a_number_is_text(text: str) -> None:
    assert read_yaml(f"a: {text}") == {"a": text}
    assert tree_value(f"a: {text}") == {"a": text}
    assert yaml_tree(text).tag == "tag:yaml.org,2002:str"


@pytest.mark.parametrize("text,value", [
    ("1", 1), ("-7", -7), ("+7", 7), ("1.5", 1.5), ("-.5", "-.5"), (".5", 0.5), ("1.0e+3", 1000.0), ("true", True),
    ("No", False), ("on", True), ("~", None), ("null", None), ("'1'", "1"), ('"yes"', "yes"), ("''", ""), ("", None),
])  # fmt: skip
def test_scalars_have_the_types_of_json(text: str, value: object) -> None:
    for read in (read_yaml, tree_value):
        found = read(text)
        assert found == value
        assert type(found) is type(value)


def test_errors_have_their_place() -> None:
    problem = refused(read_yaml, "a: 1\nb: *c\n")
    assert (problem.line, problem.column) == (2, 4)
    problem = refused(read_json, '{"a": 1,\n "b": ]}')
    assert (problem.line, problem.column) == (2, 7)
    problem = refused(read_json, "[\n" * 100)
    assert (problem.line, problem.column) == (65, 1)
    assert str(problem).startswith("line 65, column 1: more than 64 levels")


@pytest.mark.parametrize("read", [read_json, read_yaml, yaml_tree])
def test_bounds_count(read: Callable[..., Any]) -> None:
    assert read("[[[1]]]", SMALL) is not None
    assert read("[1, 2, 3, 4, 5, 6, 7, 8, 9]", SMALL) is not None
    assert read('["[[[[[[[["]', SMALL) is not None
    for text in ("[[[[1]]]]", "[1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11]", '"' + "ä" * 100 + '"'):
        with pytest.raises(BadText):
            read(text, SMALL)


def test_a_bracket_in_a_text_opens_nothing() -> None:
    text = json.dumps(["[" * 1000, '"[' * 1000, "\\[" * 1000, "{" * 1000])
    assert read_json(text) == json.loads(text)


def test_settings_of_people_are_small() -> None:
    with pytest.raises(BadText):
        yaml_tree("[" + "a," * SETTINGS.values + "]")


@pytest.mark.parametrize("text,value", [("7", 7), ("-007", -7), ("9" * 18, 10**18 - 1)])
def test_whole_numbers(text: str, value: int) -> None:
    assert whole(text) == value


@pytest.mark.parametrize("text", ["", "1.0", "9" * 19, "9" * 1_000_000, "1_0", "٣", " 1", "1e3", "0x1"])
def test_no_whole_numbers(text: str) -> None:
    with pytest.raises(ValueError, match="whole number"):
        whole(text)


@pytest.mark.parametrize("value,number", [
    ("0.1", Fraction(1, 10)), ("1/20", Fraction(1, 20)), (0.1, Fraction(1, 10)), (3, Fraction(3)), ("-2", Fraction(-2)),
    (1e-05, Fraction(1, 100_000)), ("7/010", Fraction(7, 10)),
])  # fmt: skip
def test_exact_numbers(value: object, number: Fraction) -> None:
    assert exact(value) == number


@pytest.mark.parametrize("value", [
    "1e999999999", "1/0", "1/000", "nan", "inf", float("nan"), float("inf"), True, None, "", [], "1 / 2", "9" * 19,
    "1." + "0" * 1_000_000, "1/3.5", "0x1",
])  # fmt: skip
def test_no_exact_numbers(value: object) -> None:
    with pytest.raises(ValueError, match="is not a number"):
        exact(value)
