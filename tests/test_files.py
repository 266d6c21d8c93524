"""Files that people name: YAML is a tree with places or one error with a place, outputs are written whole or not."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError, Span
from pursue_gen.files import compose_yaml, span_of, write_texts


@given(st.text(max_size=40) | st.text("{}[]:,-&*!|>'\"#%@ \n\tab", max_size=40))
def test_any_text_is_a_tree_or_an_error_with_a_place_in_it(text: str) -> None:
    try:
        root = compose_yaml(text, "some.yaml", "TRN011", "write it so")
    except PursueError as problem:
        (found,) = problem.diagnostics
        assert problem.exit_status == 2 and found.code == "TRN011" and found.hint == "write it so"
        refused = r"this is not YAML: ..|(?:anchors|tags) .*are not read|more than|expected one document"
        assert re.match(refused, found.message)
        assert found.span is not None and 1 <= found.span.line <= len(text.splitlines()) + 1
        return
    span = span_of(root, "some.yaml")
    assert (span.line, span.column) <= (span.end_line, span.end_column)


def test_nodes_know_their_places() -> None:
    root = compose_yaml("a: 1\nbc: [x, yz]\n", "some.yaml", "TRN011", "")
    key, value = root.value[1]
    assert span_of(key, "some.yaml") == Span("some.yaml", 2, 1, 2, 3)
    assert span_of(value.value[1], "some.yaml") == Span("some.yaml", 2, 9, 2, 11)
    assert span_of(None, "some.yaml").line == 1


@pytest.mark.parametrize("text", ["[" * 5000, "{" * 5000])
def test_brackets_without_end_are_an_error(text: str) -> None:
    with pytest.raises(PursueError, match="more than 16 levels are nested"):
        compose_yaml(text, "some.yaml", "TRN011", "")


def refused(file: Path, *others: Path) -> str:
    """Why the file, or one of the others, was not written."""
    with pytest.raises(PursueError) as caught:
        write_texts({file: "new", **dict.fromkeys(others, "new")})
    (found,) = caught.value.diagnostics
    assert (found.code, caught.value.exit_status) == ("CLI003", 2)
    return found.message


@pytest.mark.parametrize("there", [True, False])
def test_nothing_is_written_through_a_link(tmp_path: Path, there: bool) -> None:
    target, link = tmp_path / "precious", tmp_path / "plan.txt"
    if there:
        target.write_text("precious")
    link.symlink_to(target)
    assert f"cannot write {link}: it is a link" in refused(link)
    assert f"cannot write {link}: it is a link" in refused(tmp_path / "other", link)
    assert target.exists() == there and (not there or target.read_text() == "precious")
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(["plan.txt"] + ["precious"] * there)


def test_a_link_to_a_pipe_is_written_to(tmp_path: Path) -> None:
    pipe, link = tmp_path / "pipe", tmp_path / "link"
    os.mkfifo(str(pipe))
    link.symlink_to(pipe)
    reader = os.open(str(pipe), os.O_RDONLY | os.O_NONBLOCK)
    write_texts({link: "new"})
    assert os.read(reader, 10) == b"new"
    os.close(reader)


def test_the_error_names_the_file_that_failed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    replace = os.replace

    def failing(source: str, target: Path) -> None:
        if Path(target).name == "b":
            raise OSError(28, "No space left on device")
        replace(source, target)

    monkeypatch.setattr(os, "replace", failing)
    why = refused(tmp_path / "a", tmp_path / "b", tmp_path / "c")
    assert why == f"cannot write {tmp_path / 'b'}: No space left on device"
    assert [path.name for path in tmp_path.iterdir()] == ["a"]
