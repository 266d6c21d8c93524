"""Makes what repeats the words of the language: the table in docs/language.md, and the words in the files for editors.

    python -m docs.language.make
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from textwrap import fill
from typing import Dict, List

from pursue_gen.files import write_texts
from pursue_gen.language.kinds import KEYWORDS, MAY_BE_NAMES, MEANINGS, STATEMENTS, VALUES

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "language.md"
SYNTAX, INDENT = (ROOT / "editors" / "vim" / folder / "pursue.vim" for folder in ("syntax", "indent"))
TEXTMATE = ROOT / "editors" / "vscode" / "syntaxes" / "pursue.tmLanguage.json"

WIDTH = 120

_OTHERS = KEYWORDS.keys() - STATEMENTS.keys() - VALUES
GROUPS: Dict[str, List[str]] = {
    group: sorted(KEYWORDS[token] for token in tokens)
    for group, tokens in (("statement", STATEMENTS), ("constant", VALUES), ("keyword", _OTHERS))
}
"""The words, each in the group that has its colour."""


def page(text: str) -> str:
    """The page on the language, with the table of its words."""
    rows = (
        f"| `{word}` | {MEANINGS[token]} | {'yes' if token in MAY_BE_NAMES else ''} |"
        for token, word in sorted(KEYWORDS.items(), key=lambda item: item[1].lower())
    )
    table = "\n".join(("| word | meaning | may be a name |\n| --- | --- | --- |", *rows))
    return _between("<!-- made: words -->\n", f"\n{table}\n\n", "<!-- end -->", text)


def vim_syntax(text: str) -> str:
    """Vim's colours."""
    for group, words in GROUPS.items():
        head = f"syntax keyword pursue{group.capitalize()} "
        lines = fill(" ".join(words), WIDTH, initial_indent=head, subsequent_indent=head)
        text = re.sub(rf"(^{head}.*\n)+", f"{lines}\n", text, flags=re.M)
    return text


def vim_indent(text: str) -> str:
    """Vim's indentation."""
    for name, words in (("statement", GROUPS["statement"]), ("goes_on", GROUPS["constant"] + GROUPS["keyword"])):
        lines = fill(" ".join(sorted(words)), WIDTH - 2, initial_indent="      \\ ", subsequent_indent="      \\ ")
        text = _between(f"let s:{name} = split('", f"\n{lines}", "')", text)
    return text


def textmate(text: str) -> str:
    """The colours of VS Code, and of all who read grammars of TextMate."""
    for group, words in GROUPS.items():
        text = re.sub(rf'("{group}": {{\s*"match": "[^(]*\([^)]*\)\()[^)]*', rf"\g<1>{'|'.join(words)}", text)
    return text


def _between(begin: str, made: str, end: str, text: str) -> str:
    """The text with what is made between the two marks."""
    before, _, rest = text.partition(begin)
    return f"{before}{begin}{made}{end}{rest.partition(end)[2]}"


WRITTEN = {PAGE: page, SYNTAX: vim_syntax, INDENT: vim_indent, TEXTMATE: textmate}
"""By file, what makes its text from the text that it has."""


def main() -> int:
    """Makes all of them."""
    write_texts({path: make(path.read_text(encoding="utf-8")) for path, make in WRITTEN.items()})
    return 0


if __name__ == "__main__":
    sys.exit(main())
