"""Answers in the terms of the language server protocol. Needs lsprotocol."""

from __future__ import annotations

from typing import Dict, Iterable, List, Optional, Sequence

from lsprotocol import types as lsp

from pursue_gen.diagnostics import Diagnostic, Severity
from pursue_gen.language.document import Edit
from pursue_gen.language.kinds import KEYWORDS, STATEMENTS
from pursue_gen.language.occurrences import Occurrence
from pursue_gen.tools.lsp.completion import Completion
from pursue_gen.tools.lsp.fixes import Fix
from pursue_gen.tools.lsp.open_document import OpenDocument
from pursue_gen.tools.lsp.outline import Fold, Symbol

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
    first, last = document.positions.position(start), document.positions.position(end)
    return lsp.Range(lsp.Position(*first), lsp.Position(*last))


def offset_of(document: OpenDocument, position: lsp.Position) -> int:
    """The offset that an editor's position means."""
    return document.positions.offset(position.line, position.character)


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


def highlights(document: OpenDocument, places: Iterable[Occurrence]) -> List[lsp.DocumentHighlight]:
    """Where names stand, declarations marked as writing."""
    kinds = lsp.DocumentHighlightKind
    return [
        lsp.DocumentHighlight(range_of(document, o.start, o.end), kinds.Write if o.declares else kinds.Read)
        for o in places
    ]


def text_edits(document: OpenDocument, edits: Iterable[Edit]) -> List[lsp.TextEdit]:
    """Edits of the text."""
    return [lsp.TextEdit(range_of(document, edit.start, edit.end), edit.text) for edit in edits]


def document_symbols(document: OpenDocument, symbols: Iterable[Symbol]) -> List[lsp.DocumentSymbol]:
    """The outline."""
    return [
        lsp.DocumentSymbol(
            name=symbol.name,
            kind=getattr(lsp.SymbolKind, STATEMENTS[symbol.kind].symbol),
            range=range_of(document, symbol.start, symbol.end),
            selection_range=range_of(document, symbol.name_start, symbol.name_end),
            detail=symbol.detail or None,
        )
        for symbol in symbols
    ]


def folding_ranges(folds: Iterable[Fold]) -> List[lsp.FoldingRange]:
    """What can be folded away."""
    kinds = lsp.FoldingRangeKind
    return [lsp.FoldingRange(f.first, f.last, kind=kinds.Comment if f.comment else kinds.Region) for f in folds]


def inlay_hints(document: OpenDocument, start: int, end: int) -> List[lsp.InlayHint]:
    """What the objectives between these offsets cost, behind their statements."""
    said: Dict[int, List[str]] = {}  # of what is for each of a group there are several in one place
    for size in document.sizes:
        said.setdefault(document.lines.of_span(size.span)[1], []).append(size.in_words())
    ends = ((at, " or ".join(dict.fromkeys(some)) + " each" * (len(some) > 1)) for at, some in said.items())
    places = ((lsp.Position(*document.positions.position(at)), words) for at, words in ends if start <= at <= end)
    return [lsp.InlayHint(place, words, tooltip=_COSTS, padding_left=True) for place, words in places]


def code_actions(document: OpenDocument, uri: str, found: Sequence[Fix], pages: Optional[str]) -> List[lsp.CodeAction]:
    """Quick fixes, each with the finding that it is about."""
    return [
        lsp.CodeAction(
            title=fix.title,
            kind=lsp.CodeActionKind.QuickFix,
            diagnostics=[diagnostic(document, uri, fix.finding, pages, related=True)],
            is_preferred=fix.preferred,
            edit=lsp.WorkspaceEdit(changes={uri: text_edits(document, fix.edits)}),
        )
        for fix in found
    ]
