"""The files for Vim, in Vim itself."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path
from typing import Dict, Set, Tuple

import pytest

from pursue_gen.language.draft import Draft
from pursue_gen.language.kinds import KEYWORDS, STATEMENTS, VALUES

from .scenarios import ROOT, SCENARIOS

VIM = shutil.which("vim")
GROUPS = {
    "NAME": "pursueName", "NUMBER": "pursueNumber", "TAIL": "pursueTail", "POSE": "pursuePose",
    "LINE_COMMENT": "pursueComment", "BLOCK_COMMENT": "pursueComment",
}  # fmt: skip
LIST = r"""
redir! > out
echo &filetype
for l in range(1, line('$'))
  for c in range(1, len(getline(l)))
    let g = synIDattr(synID(l, c, 0), 'name')
    if g != ''
      echo l . ' ' . c . ' ' . g
    endif
  endfor
endfor
redir END
normal! gg=G
write! indented
qall!
"""


def run(folder: Path, text: str) -> "Tuple[str, Set[Tuple[int, int, str]], str]":
    """Vim's name of the kind of file, (line, column in bytes, group) of what is coloured, the text as indented."""
    assert VIM is not None
    (folder / "text.pur").write_text(text, encoding="utf-8")
    (folder / "list.vim").write_text(LIST, encoding="utf-8")
    start = [VIM, "-N", "-u", "NONE", "-i", "NONE", "-n", "-es", "--cmd", f"set encoding=utf-8 rtp^={ROOT}/editors/vim"]
    commands = ["-c", "filetype plugin indent on", "-c", "syntax on", "-c", "edit text.pur", "-S", "list.vim"]
    nothing, pipe = subprocess.DEVNULL, subprocess.PIPE
    done = subprocess.run(
        [*start, *commands], cwd=str(folder), stdin=nothing, stdout=pipe, stderr=pipe, timeout=600, check=False
    )
    if not (folder / "out").is_file():
        pytest.skip(f"this Vim is too small: {done.stdout[:200]!r}")
    kind, *lines = (folder / "out").read_text(encoding="utf-8").split("\n")[1:]
    found = {(int(line), int(column), group) for line, column, group in (line.split() for line in lines if line)}
    return kind, found, (folder / "indented").read_text(encoding="utf-8")


def expected(text: str) -> Set[Tuple[int, int, str]]:
    found: Set[Tuple[int, int, str]] = set()
    document = Draft.of(text, "x.pur")
    for token in document.tokens:
        word = (
            "pursueConstant"
            if token.type in VALUES
            else "pursueStatement"
            if token.type in STATEMENTS
            else "pursueKeyword"
        )
        groups: Dict[str, str] = {**GROUPS, **{kind: word for kind in KEYWORDS}}
        if token.type in groups:
            start = token.start_pos or 0
            for offset in range(start, start + len(token)):
                line, column = document.lines.of(offset), 0
                column = len(text[document.lines.start(line) : offset].encode()) + 1
                if text[offset] != "\n":
                    found.add((line + 1, column, groups[token.type]))
    return found


@pytest.mark.skipif(VIM is None, reason="Vim is not installed")
def test_colours_and_indentation(tmp_path: Path) -> None:
    more = 'state "s": initially true, false_if a\ncontrol : A<> x\npoi "q" //[1, 2]\n/* a\nb */\n'
    text = "\n".join(SCENARIOS.values()).replace("…", "...") + more
    kind, found, indented = run(tmp_path, text)
    assert kind == "pursue"
    lines = text.split("\n")
    ascii_only = {place for place in found if lines[place[0] - 1].isascii()}
    assert ascii_only == {place for place in expected(text) if lines[place[0] - 1].isascii()}
    assert indented == text


@pytest.mark.skipif(VIM is None, reason="Vim is not installed")
def test_what_goes_on_of_a_statement_stands_further_in(tmp_path: Path) -> None:
    text = 'agent "b" location a\ncan_do e,\nf\n  poi "a"\nrule "r": a\nbefore b\n'
    _, _, indented = run(tmp_path, text)
    assert indented == 'agent "b" location a\n    can_do e,\n    f\npoi "a"\nrule "r": a\n    before b\n'
