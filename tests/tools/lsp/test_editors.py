"""What editors, and the page on the language, are told of its words agrees with its grammar."""

from __future__ import annotations

import json
import re
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Dict, Iterator, List, Set, Tuple

import pytest

from docs.language import make
from pursue_gen.language.draft import Draft
from pursue_gen.language.kinds import KEYWORDS, STATEMENTS, VALUES
from pursue_gen.language.parser import read
from pursue_gen.language.syntax import grammar_text

from .scenarios import ROOT, SCENARIOS
from .test_completion import expanded

VSCODE = ROOT / "editors" / "vscode"
VIM = ROOT / "editors" / "vim"


def grammar_words() -> Set[str]:
    """Every word in quotes in the grammar."""
    rules = "\n".join(line for line in grammar_text().split("\n") if not line.startswith("//"))
    rules = re.sub(r": /.*/$", "", rules, flags=re.M)
    return set(re.findall(r'"([A-Za-z_]+)"', rules))


def test_the_words_are_those_of_the_grammar() -> None:
    assert set(KEYWORDS.values()) == grammar_words()
    assert len(KEYWORDS) > 30


@pytest.mark.parametrize("path", make.WRITTEN, ids=lambda path: str(path.relative_to(ROOT)))
def test_the_words_are_written_by_the_program(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert make.WRITTEN[path](text) == text, "run: python -m docs.language.make"
    for word in ("travel", "is_true", "tolerance"):
        without = re.sub(rf"^\| `{word}` .*\n" if path == make.PAGE else rf"[ |]{word}\b", "", text, flags=re.M)
        assert without != text and make.WRITTEN[path](without) == text


# VS Code --------------------------------------------------------------------------------------------------------------


def read_json(*path: str) -> Any:
    return json.loads(VSCODE.joinpath(*path).read_text(encoding="utf-8"))


TEXTMATE = read_json("syntaxes", "pursue.tmLanguage.json")


def rules() -> Iterator[Tuple[str, str]]:
    """(pattern, scope) in the order in which they are tried; a region as one pattern."""
    for include in TEXTMATE["patterns"]:
        rule = TEXTMATE["repository"][include["include"][1:]]
        for part in rule.get("patterns", [rule]):
            pattern = part["match"] if "match" in part else f"{part['begin']}[\\s\\S]*?{part['end']}"
            yield pattern, part["name"]


def textmate(text: str) -> List[Tuple[int, str, str]]:
    """(offset, piece, scope) as an editor finds them: the earliest match, and of several the first rule's."""
    compiled = [(re.compile(pattern), scope) for pattern, scope in rules()]
    found, at = [], 0
    while True:
        matches = [
            (match.start(), n, match, scope) for n, (p, scope) in enumerate(compiled) if (match := p.search(text, at))
        ]
        if not matches:
            return found
        _, _, match, scope = min(matches, key=lambda m: m[:2])
        found.append((match.start(), match.group(), scope))
        at = match.end()


SCOPES = {
    "NAME": "string.quoted.double.pursue",
    "POSE": "comment.line.pose.pursue",
    "LINE_COMMENT": "comment.line.double-slash.pursue",
    "BLOCK_COMMENT": "comment.block.pursue",
    "TAIL": "meta.preprocessor.pursue",
    "NUMBER": "constant.numeric.pursue",
    "WORD": "variable.other.pursue",
    "COLON": "punctuation.pursue", "COMMA": "punctuation.pursue", "LPAR": "punctuation.pursue",
    "RPAR": "punctuation.pursue",
}  # fmt: skip


def scope_of(kind: str) -> str:
    if kind not in KEYWORDS:
        return SCOPES[kind]
    if kind in VALUES:
        return "constant.language.pursue"
    return "keyword.control.pursue" if kind in STATEMENTS else "keyword.other.pursue"


@pytest.mark.parametrize("name", sorted(SCENARIOS))
def test_textmate_sees_the_words_that_the_parser_sees(name: str) -> None:
    document = Draft.of(SCENARIOS[name], name)
    ours = [(t.start_pos, str(t), scope_of(t.type)) for t in document.tokens]
    assert textmate(document.text) == ours


def test_snippets_are_well_formed() -> None:
    for name, snippet in read_json("snippets", "pursue.json").items():
        text = "\n".join(snippet["body"])
        values: Dict[str, str] = dict(re.findall(r"\$\{(\d+):([^}]*)\}", text))
        text = expanded(text)
        for number in sorted(values, key=int, reverse=True):
            text = text.replace("$" + number, values[number])
        text = text.replace("$0", "")
        assert read(text, "x.pur").diagnostics == (), name
        if snippet["prefix"] == "scenario":
            assert Draft.of(text, "x.pur").findings == ()


def test_the_manifest_names_files_that_are_there() -> None:
    manifest = read_json("package.json")
    contributes = manifest["contributes"]
    paths = [
        manifest["main"],
        *(g["path"] for g in contributes["grammars"]),
        *(s["path"] for s in contributes["snippets"]),
    ]
    paths += [language["configuration"] for language in contributes["languages"]]
    assert all((VSCODE / path).is_file() for path in paths)
    assert (VSCODE / "LICENSE").read_bytes() == (ROOT / "LICENSE").read_bytes()
    source = (VSCODE / "extension.js").read_text(encoding="utf-8")
    assert all(f'"{command["command"]}"' in source for command in contributes["commands"])
    assert contributes["languages"][0]["extensions"] == [".pur"]
    assert TEXTMATE["scopeName"] == contributes["grammars"][0]["scopeName"]


def test_the_lock_names_no_place_of_a_machine() -> None:
    lock = read_json("package-lock.json")
    assert lock["packages"][""]["dependencies"] == read_json("package.json")["dependencies"]
    assert all(
        p.get("resolved", "https://registry.npmjs.org/").startswith("https://registry.npmjs.org/")
        for p in lock["packages"].values()
    )


# Vim ------------------------------------------------------------------------------------------------------------------


def test_vim_knows_the_file_names() -> None:
    assert "*.pur setfiletype pursue" in (VIM / "ftdetect" / "pursue.vim").read_text(encoding="utf-8")


# Pygments -------------------------------------------------------------------------------------------------------------


def token_types(text: str) -> List[Tuple[str, str]]:
    from pursue_gen.language.lexer import PursueLexer

    tokens = PursueLexer().get_tokens(text)
    return [(str(kind)[6:], value) for kind, value in tokens if str(kind) != "Token.Text.Whitespace"]


def type_of(kind: str, value: str) -> str:
    if kind in KEYWORDS:
        return "Keyword.Declaration" if kind in STATEMENTS else "Keyword.Constant" if kind in VALUES else "Keyword"
    names = {"NAME": "Literal.String", "POSE": "Comment.Special", "LINE_COMMENT": "Comment.Single", "WORD": "Name"}
    number = f"Literal.Number.{'Float' if '.' in value else 'Integer'}"
    more = {"BLOCK_COMMENT": "Comment.Multiline", "TAIL": "Comment.Preproc", "NUMBER": number}
    return {**names, **more}.get(kind, "Punctuation")


@pytest.mark.skipif(find_spec("pygments") is None, reason="pygments is not installed")
@pytest.mark.parametrize("name", sorted(SCENARIOS))
def test_pygments_sees_the_words_that_the_parser_sees(name: str) -> None:
    document = Draft.of(SCENARIOS[name], name)
    assert token_types(document.text) == [(type_of(t.type, str(t)), str(t)) for t in document.tokens]


@pytest.mark.skipif(find_spec("pygments") is None, reason="pygments is not installed")
def test_pygments_gives_back_every_text() -> None:
    for text in ('poi "a', "/* never", "x\u200by \x00 é😀", "wait-for it", "12abc 1.5"):
        from pursue_gen.language.lexer import PursueLexer

        assert "".join(value for _, value in PursueLexer(ensurenl=False, stripnl=False).get_tokens(text)) == text


def test_pygments_finds_it_by_the_entry_point() -> None:
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    assert '[project.entry-points."pygments.lexers"]\npursue = "pursue_gen.language.lexer:PursueLexer"\n' in text
    source = Path(ROOT / "pursue_gen" / "language" / "lexer.py").read_text(encoding="utf-8")
    assert "class PursueLexer(" in source
