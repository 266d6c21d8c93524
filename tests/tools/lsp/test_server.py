"""The language server, as an editor meets it."""

from __future__ import annotations

import subprocess
import sys
from importlib.util import find_spec
from typing import Any, Dict, Iterator, List

import pytest

from pursue_gen.language.formatter import format_text
from pursue_gen.language.kinds import STATEMENTS

from .client import SNIPPETS, URI, Editor, Refused, edited
from .scenarios import SMALL

pytest.importorskip("pygls")

EMOJI = SMALL.replace('poi "a"\n', '/* 😀🏥 the ward */ poi "a" // 😀\n').replace("reach_obj", "/*𝄞*/ reach_obj")


@pytest.fixture(scope="module")
def running() -> Iterator[Editor]:
    with Editor(capabilities=SNIPPETS) as editor:
        yield editor
        assert editor.leave() == (0, "")


@pytest.fixture
def editor(running: Editor) -> Iterator[Editor]:
    """An editor with the small scenario open."""
    running.open(EMOJI)
    assert running.findings() == []
    yield running
    assert running.close() == []


def place(text: str, before: str) -> "tuple[int, int]":
    """(line, column in UTF-16) behind some words."""
    lines = text[: text.index(before) + len(before)].split("\n")
    return len(lines) - 1, len(lines[-1].encode("utf-16-le")) // 2


def labels(answer: Dict[str, Any]) -> List[str]:
    return [item["label"] for item in answer["items"]]


def test_what_it_can_do(editor: Editor) -> None:
    for name in ("completion", "hover", "definition", "references", "documentHighlight", "documentSymbol"):
        assert editor.abilities[name + "Provider"]
    assert editor.abilities["renameProvider"] == {"prepareProvider": True}
    assert editor.abilities["foldingRangeProvider"] and editor.abilities["documentFormattingProvider"]
    assert editor.abilities["codeActionProvider"] == {"codeActionKinds": ["quickfix"]}
    assert editor.abilities["inlayHintProvider"]
    assert editor.abilities["positionEncoding"] == "utf-16"


def test_findings_as_one_types(editor: Editor) -> None:
    editor.change(EMOJI.replace("do hand", "do hnd"))
    (finding,) = editor.findings()
    line, column = place(EMOJI, "/*𝄞*/ reach_objective: do ")
    assert finding["range"] == {
        "start": {"line": line, "character": column}, "end": {"line": line, "character": column + 3},
    }  # fmt: skip
    assert (finding["code"], finding["severity"], finding["source"]) == ("PML110", 1, "PuRSUE-ML")
    assert finding["message"] == "there is no event hnd"
    assert [related["message"] for related in finding["relatedInformation"]] == ["did you mean hand?"]
    assert "codeDescription" not in finding
    editor.change(EMOJI)
    assert editor.findings() == []


def test_completion(editor: Editor) -> None:
    assert labels(editor.at("completion", *place(EMOJI, "/*𝄞*/ reach_objective: do ")))[:3] == ["work", "hand", "rest"]
    editor.change(EMOJI + "connect a and ")
    answer = editor.at("completion", 13, len("connect a and "))
    assert labels(answer) == ["b"]
    edit = answer["items"][0]["textEdit"]
    assert edit == {
        "range": {"start": {"line": 13, "character": 14}, "end": {"line": 13, "character": 14}},
        "newText": "b",
    }
    statements = [item for item in editor.at("completion", 0, 0)["items"] if item["insertTextFormat"] == 2]
    assert any("${1|a,b|}" in item["textEdit"]["newText"] for item in statements)
    assert editor.findings()


def test_definition_references_and_highlight(editor: Editor) -> None:
    here = place(EMOJI, "location a")
    declared = editor.at("definition", *here)
    line, column = place(EMOJI, ' poi "')
    assert [(d["uri"], d["range"]["start"]) for d in declared] == [(URI, {"line": line, "character": column})]
    everywhere = editor.at("references", *here, context={"includeDeclaration": True})
    without = editor.at("references", *here, context={"includeDeclaration": False})
    assert len(everywhere) == 3 and everywhere[1:] == without
    assert [h["kind"] for h in editor.at("documentHighlight", *here)] == [3, 2, 2]


def test_rename(editor: Editor) -> None:
    line, column = place(EMOJI, "reach_objective: do h")
    assert editor.at("prepareRename", line, column)["start"] == {"line": line, "character": column - 1}
    assert editor.at("prepareRename", 0, 0) is None
    changes = editor.at("rename", line, column, newName="give")["changes"]
    assert edited(EMOJI, changes[URI]) == EMOJI.replace("hand", "give")
    with pytest.raises(Refused, match="word of the language"):
        editor.at("rename", line, column, newName="event")
    with pytest.raises(Refused, match="bot is taken: line 10"):
        editor.at("rename", line, column, newName="bot")


def test_hover(editor: Editor) -> None:
    answer = editor.at("hover", *place(EMOJI, ' poi "'))
    assert "to b: distance 3" in answer["contents"]["value"]
    assert editor.at("hover", 0, 4) is None


def test_the_states_that_an_objective_costs_stand_behind_it(editor: Editor) -> None:
    lines = EMOJI.split("\n")
    whole = {"start": {"line": 0, "character": 0}, "end": {"line": len(lines), "character": 0}}
    hints = editor.about("inlayHint", range=whole)
    ends = [place(EMOJI, words) for words in (lines[-3], lines[-2])]
    assert [hint["position"] for hint in hints] == [{"line": line, "character": column} for line, column in ends]
    assert all(hint["label"].endswith(" states") for hint in hints)
    first = {"start": {"line": 0, "character": 0}, "end": {"line": 1, "character": 0}}
    assert editor.about("inlayHint", range=first) == []
    editor.change(EMOJI.replace("do hand", "do hnd"))
    assert editor.about("inlayHint", range=whole) == []


def test_each_kind_of_statement_is_in_the_outline(editor: Editor) -> None:
    lines = [kind.form().split(" · ")[0].split(" (")[0] for kind in STATEMENTS.values()]
    editor.change("\n".join([*lines, "controllable: x"]))
    symbols = editor.about("documentSymbol")
    assert len(symbols) == len(lines) and len({symbol["kind"] for symbol in symbols}) == 9


def test_outline_folds_and_formatting(editor: Editor) -> None:
    names = [symbol["name"] for symbol in editor.about("documentSymbol")]
    assert names[:3] == ["a", "b", "connect a and b distance 3"]
    assert {"startLine": 0, "endLine": 1, "kind": "region"} in editor.about("foldingRange")
    options = {"options": {"tabSize": 4, "insertSpaces": True}}
    assert edited(EMOJI, editor.about("formatting", **options)) == format_text(EMOJI, "x.pur")
    editor.change(format_text(EMOJI, "x.pur"))
    assert editor.about("formatting", **options) == []
    editor.change("poi poi")
    assert editor.about("formatting", **options) == []  # it cannot be read: its layout stays


def test_quick_fixes(editor: Editor) -> None:
    text = EMOJI.replace("do hand", "do hnd")
    editor.change(text)
    (finding,) = editor.findings()
    actions = editor.about("codeAction", range=finding["range"], context={"diagnostics": [finding]})
    assert actions[0]["title"] == "Write hand" and actions[0]["isPreferred"]
    assert edited(text, actions[0]["edit"]["changes"][URI]) == EMOJI
    only = {"diagnostics": [finding], "only": ["refactor"]}
    assert editor.about("codeAction", range=finding["range"], context=only) == []


def test_the_map(editor: Editor) -> None:
    assert editor.ask("pursue/map", {"uri": URI})["svg"].startswith("<svg")
    assert "not open" in editor.ask("pursue/map", {"uri": "file:///another.pur"})["message"]
    assert "message" in editor.ask("pursue/map", {}) and "message" in editor.ask("pursue/map", [1])
    editor.change("// nothing yet")
    assert "no place" in editor.ask("pursue/map", {"uri": URI})["message"]


def test_a_text_that_is_not_open_has_no_answers(running: Editor) -> None:
    assert running.at("hover", 0, 0) is None
    assert running.about("documentSymbol") is None


@pytest.mark.parametrize("ends", ["\r\n", "\r"])
def test_other_line_ends(editor: Editor, ends: str) -> None:
    editor.change(EMOJI.replace("\n", ends).replace("do hand", "do hnd"))
    assert [f["range"]["start"]["line"] for f in editor.findings()] == [12]


def test_what_python_takes_for_line_ends_are_none(editor: Editor) -> None:
    editor.change("/* \x0c \x85 \u2028 */ " + EMOJI.replace("do hand", "do hnd"))
    assert [f["range"]["start"]["line"] for f in editor.findings()] == [12]


def test_many_edits_one_after_the_other(editor: Editor) -> None:
    for end in range(0, len(SMALL), 5):
        editor.change(SMALL[:end])
    editor.change(SMALL)
    assert labels(editor.at("completion", 12, 20))[:1] == ["work"]
    editor.change(SMALL + "poi")
    assert [finding["code"] for finding in editor.findings()] == ["PML010"]


def test_an_editor_of_few_abilities() -> None:
    with Editor("--docs", "https://example.org/pages/", capabilities={}) as editor:
        editor.open("poi", "untitled:Untitled-1")
        (finding,) = editor.findings()
        assert "\nhelp: the form is" in finding["message"] and "relatedInformation" not in finding
        assert finding["codeDescription"] == {"href": "https://example.org/pages/PML010.md"}
        editor.open(SMALL)
        items = editor.at("completion", 13, 0)["items"]
        assert {item["insertTextFormat"] for item in items} == {1}
        assert not any("$" in item["textEdit"]["newText"] for item in items)
        assert editor.leave() == (0, "")


def test_options_of_the_start_and_another_way_to_count() -> None:
    bytes_ = {"general": {"positionEncodings": ["utf-8", "utf-16"]}}
    options = {"docs": "https://example.org"}
    with Editor(capabilities=bytes_, initializationOptions=options) as editor:
        editor.open("/*😀*/ pio:")
        (finding,) = editor.findings()
        assert finding["range"]["start"]["character"] == {"utf-8": 9, "utf-16": 7}[editor.abilities["positionEncoding"]]
        assert finding["codeDescription"]["href"] == "https://example.org/PML011.md"


def test_without_leave_the_exit_status_is_1() -> None:
    with Editor(capabilities={}) as editor:
        editor.tell("exit")
        assert editor.end()[0] == 1
    with Editor(capabilities={}) as editor:
        assert editor.process.stdin is not None
        editor.process.stdin.close()
        assert editor.end() == (1, "")


@pytest.mark.skipif(find_spec("pygls.lsp.server") is None, reason="pygls 1 does not find its way out of garbage")
def test_garbage_on_stdin() -> None:
    with Editor() as editor:
        editor.write(b"hello\r\n\r\n\xff\xfe\x00 garbage\r\nContent-Length: 3\r\n\r\n{[}")
        editor.write(b"Content-Length: 4\r\n\r\nnull")
        editor.write(b"Content-Length: 20000\r\n\r\n" + b"[" * 20000)
        start = {"processId": None, "rootUri": None, "capabilities": {}}
        assert editor.ask("initialize", start)["capabilities"]
        editor.tell("initialized", {})
        editor.tell("textDocument/didOpen", {"no": "text"})
        editor.tell("textDocument/didChange", [1, 2])
        with pytest.raises(Refused):
            editor.ask("no/such/thing", {})
        editor.open("\ud83d" * 5 + ' poi "a"')
        assert editor.findings()
        editor.at("hover", 10**9, 10**9)
        assert editor.leave()[0] == 0


def test_ten_thousand_lines_hold_nothing_up() -> None:
    text = "".join(f'poi "p{n}" // é\n' for n in range(10_000))
    with Editor(capabilities={}) as editor:
        editor.open(text)
        for end in range(3):
            editor.change(text + "connect p0 and p1 distance 1\n" * end + "connect p1 and p")
        answer = editor.at("completion", 10_002, len("connect p1 and p"))
        assert len(labels(answer)) == 9_999
        assert editor.leave()[0] == 0


def test_without_pygls_it_says_what_to_install() -> None:
    hidden = "import sys; sys.modules['pygls'] = None; sys.modules['pygls.exceptions'] = None;"
    program = hidden + "sys.argv = ['pursue-gen', 'lsp']; from pursue_gen.cli.app import main; main()"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert done.returncode == 6
    assert "pip install" in done.stderr and "Traceback" not in done.stderr
    assert done.stdout == ""
