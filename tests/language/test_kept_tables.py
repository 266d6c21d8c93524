"""The tables of the parser are kept between runs, where nobody else can write to them."""

from __future__ import annotations

from pathlib import Path
from typing import Iterator

import pytest

from pursue_gen.language import syntax
from pursue_gen.language.document import Document
from pursue_gen.language.syntax import grammar

TEXT = 'poi "hall"\nconnect "hall" and\nagent "bot1" controllable mobile 1 location "hall"\n'


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    grammar.cache_clear()
    yield tmp_path / "pursue"
    grammar.cache_clear()


def read() -> object:
    syntax = Document(TEXT, "floor.pur").syntax
    return syntax.trees, [finding.message for finding in syntax.findings]


def test_texts_are_read_as_before_from_kept_tables(cache: Path) -> None:
    first = read()
    (kept,) = cache.iterdir()
    written = kept.stat().st_mtime_ns
    grammar.cache_clear()
    assert read() == first
    assert kept.stat().st_mtime_ns == written


@pytest.mark.parametrize("content", [b"", b"no tables\n", b"0" * 64 + b"\n\x80"])
def test_tables_that_cannot_be_read_are_made_anew(cache: Path, content: bytes) -> None:
    first = read()
    (kept,) = cache.iterdir()
    kept.write_bytes(content)
    grammar.cache_clear()
    assert read() == first
    assert kept.stat().st_size > 10_000


def test_nothing_is_kept_where_others_may_write(cache: Path) -> None:
    cache.mkdir()
    cache.chmod(0o777)
    read()
    assert not list(cache.iterdir())


def test_nothing_is_kept_where_there_can_be_no_folder(cache: Path) -> None:
    cache.write_text("a file")
    assert syntax._kept_tables() is None
    read()
