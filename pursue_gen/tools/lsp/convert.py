"""Answers in the terms of the language server protocol. Needs lsprotocol."""

from __future__ import annotations

from typing import Dict, Iterable, List, Optional

from lsprotocol import types as lsp

from pursue_gen.diagnostics import Diagnostic, Severity
from pursue_gen.language.document import Edit
from pursue_gen.language.kinds import KEYWORDS, STATEMENTS
from pursue_gen.language.occurrences import Occurrence
from pursue_gen.tools.lsp.completion import Completion
from pursue_gen.tools.lsp.open_document import OpenDocument

_COSTS = "discrete states of the game of this objective alone, which those of others multiply"
"""What a number of states behind an objective means."""

_ITEM_KINDS = {
    "word": lsp.CompletionItemKind.Keyword,
    "sign": lsp.CompletionItemKind.Operator,
    "value": lsp.CompletionItemKind.Value,
    "statement": lsp.CompletionItemKind.Snippet,
}
_SYMBOLS = {kind.declares: kind.symbol for kind in STATEMENTS.values() if kind.declares}
"""The symbol of each kind of thing that has a name."""


def range_of(document: OpenDocument, start: int, end: int) -> lsp.Range:
    """text[start:end] as the editor counts."""
    first, last = document.position(start), document.position(end)
    return lsp.Range(lsp.Position(*first), lsp.Position(*last))


def offset_of(document: OpenDocument, position: lsp.Position) -> int:
    """The offset that an editor's position means."""
    return document.offset(position.line, position.character)


def diagnostic(
    document: OpenDocument, uri: str, finding: Diagnostic, pages: Optional[str], related: bool
) -> lsp.Diagnostic:
    """A finding; its hint as related text where the editor shows that, else in the message.

    `pages`: the address of the folder with a page for each code.
    """
    start, end = document.lines.of_span(finding.span) if finding.span is not None else (0, 0)
    place = range_of(document, start, end)
    severity = lsp.DiagnosticSeverity.Error if finding.severity is Severity.ERROR else lsp.DiagnosticSeverity.Warning
    message, more = finding.message, None
    if finding.hint and related:
        more = [lsp.DiagnosticRelatedInformation(lsp.Location(uri, place), finding.hint)]
    elif finding.hint:
        message = f"{message}\nhelp: {finding.hint}"
    link = lsp.CodeDescription(f"{pages.rstrip('/')}/{finding.code}.md") if pages else None
    return lsp.Diagnostic(place, message, severity, finding.code, link, source="PuRSUE-ML", related_information=more)


def completion_items(document: OpenDocument, items: Iterable[Completion], snippets: bool) -> List[lsp.CompletionItem]:
    """Completions in their order. An editor that knows no snippets gets words instead of them."""
    found = []
    for number, item in enumerate(items):
        insert = item.insert
        if item.snippet and not snippets:
            insert = KEYWORDS[item.token] + " " if item.kind == "statement" else item.label
        form = lsp.InsertTextFormat.Snippet if item.snippet and snippets else lsp.InsertTextFormat.PlainText
        known = lsp.CompletionItemKind
        kind = getattr(known, _SYMBOLS[item.of], known.Variable) if item.of in _SYMBOLS else _ITEM_KINDS.get(item.kind)
        about = lsp.MarkupContent(lsp.MarkupKind.Markdown, item.about) if item.about else None
        found.append(
            lsp.CompletionItem(
                label=item.label,
                kind=kind,
                detail=item.detail or None,
                documentation=about,
                sort_text=f"{number:05}",
                filter_text=KEYWORDS[item.token] if item.kind == "statement" else None,
                insert_text_format=form,
                text_edit=lsp.TextEdit(range_of(document, item.start, item.end), insert),
            )
        )
    return found


def locations(document: OpenDocument, uri: str, places: Iterable[Occurrence]) -> List[lsp.Location]:
    """Where names stand."""
    return [lsp.Location(uri, range_of(document, place.start, place.end)) for place in places]


def text_edits(document: OpenDocument, edits: Iterable[Edit]) -> List[lsp.TextEdit]:
    """Edits of the text."""
    return [lsp.TextEdit(range_of(document, edit.start, edit.end), edit.text) for edit in edits]


def inlay_hints(document: OpenDocument, start: int, end: int) -> List[lsp.InlayHint]:
    """What the objectives between these offsets cost, behind their statements."""
    said: Dict[int, List[str]] = {}  # of what is for each of a group there are several in one place
    for size in document.sizes:
        said.setdefault(document.lines.of_span(size.span)[1], []).append(size.in_words())
    ends = ((at, " or ".join(dict.fromkeys(some)) + " each" * (len(some) > 1)) for at, some in said.items())
    places = ((lsp.Position(*document.position(at)), words) for at, words in ends if start <= at <= end)
    return [lsp.InlayHint(place, words, tooltip=_COSTS, padding_left=True) for place, words in places]
