"""`pursue-gen fmt`: what it writes where, and that it never harms a file."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from pursue_gen.language.formatter import layout_of, replace_text

from .commands import pursue

UNTIDY = 'poi   "a"\n\n\n\nconnect a and b distance 3 // far\n'
TIDY = 'poi "a"\n\nconnect a and b distance 3 // far\n'
BROKEN = 'poi   "a"\npoi b\n'


@pytest.fixture
def file(tmp_path: Path) -> Path:
    place = tmp_path / "floor.pur"
    place.write_text(UNTIDY, encoding="utf-8")
    return place


def test_a_file_is_laid_out_in_its_place(file: Path) -> None:
    done = pursue("fmt", file)
    assert (done.status, done.out) == (0, "")
    assert str(file) in done.err and "1 changed" in done.err
    assert file.read_text(encoding="utf-8") == TIDY
    before = file.stat()
    again = pursue("fmt", file)
    assert again.status == 0 and "0 changed, 1 unchanged" in again.err
    assert (file.stat().st_mtime_ns, file.stat().st_ino) == (before.st_mtime_ns, before.st_ino)


def test_check_lists_and_changes_nothing(file: Path, tmp_path: Path) -> None:
    other = tmp_path / "other.pur"
    other.write_text(TIDY, encoding="utf-8")
    done = pursue("fmt", "--check", file, other)
    assert (done.status, done.out) == (1, f"{file}\n")
    assert file.read_text(encoding="utf-8") == UNTIDY
    assert pursue("fmt", "--check", other).status == 0


def test_diff_shows_and_changes_nothing(file: Path) -> None:
    done = pursue("fmt", "--diff", file)
    assert done.status == 0
    assert done.out.startswith(f"--- {file}\n+++ {file}\n@@ ")
    assert '-poi   "a"\n' in done.out and '+poi "a"\n' in done.out
    assert file.read_text(encoding="utf-8") == UNTIDY
    both = pursue("fmt", "--diff", "--check", file)
    assert (both.status, both.out) == (1, done.out)


def test_a_missing_line_end_is_seen_in_the_difference(file: Path) -> None:
    file.write_text('poi "a"', encoding="utf-8")
    assert pursue("fmt", "--diff", file).out.endswith('-poi "a"\n\\ No newline at end of file\n+poi "a"\n')


def test_stdin_goes_to_stdout() -> None:
    done = pursue("fmt", "-", stdin=UNTIDY.encode())
    assert (done.status, done.out, done.err) == (0, TIDY, "")
    assert pursue("fmt", "-", "--check", stdin=UNTIDY.encode()).out == "<stdin>\n"
    assert pursue("fmt", "-", "--check", stdin=TIDY.encode()).status == 0


def test_stdin_with_errors_gives_no_text() -> None:
    done = pursue("fmt", "-", stdin=BROKEN.encode())
    assert (done.status, done.out) == (3, "")
    assert "<stdin>:2:5: error PML010" in done.err
    assert pursue("fmt", "-", stdin=b"\xff").status == 2


def test_stdin_and_files_do_not_mix(file: Path) -> None:
    done = pursue("fmt", "-", file)
    assert done.status == 2 and "- alone" in done.err
    assert file.read_text(encoding="utf-8") == UNTIDY


def test_a_file_with_syntax_errors_is_left_alone_and_the_others_are_not(file: Path, tmp_path: Path) -> None:
    broken, missing = tmp_path / "broken.pur", tmp_path / "missing.pur"
    broken.write_text(BROKEN, encoding="utf-8")
    assert pursue("fmt", broken, file).status == 3
    file.write_text(UNTIDY, encoding="utf-8")
    done = pursue("fmt", broken, file, missing, tmp_path)
    assert done.status == 2, "two of them cannot be read"
    assert f"{broken}:2:5: error PML010" in done.err and str(missing) in done.err
    assert broken.read_text(encoding="utf-8") == BROKEN
    assert file.read_text(encoding="utf-8") == TIDY
    assert not missing.exists()
    assert pursue("fmt", missing).status == 2
    assert pursue("fmt", "--check", broken).status == 3


@pytest.mark.parametrize("before", [TIDY.replace("\n", "\r\n"), TIDY.replace("\n", "\r"), "\ufeff" + TIDY, TIDY[:-1]])
def test_line_ends_and_marks_of_other_systems_are_a_matter_of_layout(file: Path, before: str) -> None:
    file.write_bytes(before.encode("utf-8"))
    assert pursue("fmt", "--check", file).status == 1
    assert pursue("fmt", file).status == 0
    assert file.read_bytes() == TIDY.encode("utf-8")


def test_mode_and_link_stay(file: Path, tmp_path: Path) -> None:
    folder = tmp_path / "links"
    folder.mkdir()
    link = folder / "link.pur"
    link.symlink_to(os.path.relpath(str(file), str(folder)))
    file.chmod(0o640)
    assert pursue("fmt", link).status == 0
    assert link.is_symlink()
    assert file.read_text(encoding="utf-8") == TIDY
    assert file.stat().st_mode & 0o777 == 0o640
    assert sorted(path.name for path in tmp_path.iterdir()) == ["floor.pur", "links"]
    assert [path.name for path in folder.iterdir()] == ["link.pur"]


def test_a_write_that_fails_leaves_the_file_and_nothing_else(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    layout = layout_of(str(file))
    monkeypatch.setattr(os, "replace", full)
    done = pursue("fmt", file)
    assert done.status == 2 and "No space left" in done.err
    assert [path.name for path in file.parent.iterdir()] == [file.name]
    assert file.read_text(encoding="utf-8") == UNTIDY
    monkeypatch.undo()
    replace_text(layout)
    assert file.read_text(encoding="utf-8") == TIDY


def test_a_protected_file_is_not_replaced(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "access", lambda place, mode, **_: mode != os.W_OK)  # root may write
    done = pursue("fmt", file)
    assert done.status == 2 and "write-protected" in done.err
    assert file.read_text(encoding="utf-8") == UNTIDY
