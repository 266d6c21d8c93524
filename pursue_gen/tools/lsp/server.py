"""The language server itself, on stdin and stdout. Needs pygls (1.3 or newer; 2 on Python 3.9 and newer)."""

from __future__ import annotations

import logging
import os
import re
import sys
import threading
import time
from contextlib import suppress
from typing import Any, BinaryIO, Callable, Dict, List, Optional
from urllib.parse import unquote, urlsplit

from lsprotocol import types as lsp
from pygls.exceptions import JsonRpcException

from pursue_gen import __version__
from pursue_gen.diagnostics import Diagnostic, PursueError, error
from pursue_gen.language.document import Edit
from pursue_gen.language.draft import definition, rename, same_name
from pursue_gen.language.formatter import formatted
from pursue_gen.language.kinds import STATEMENTS
from pursue_gen.language.tokens import plain
from pursue_gen.tools.lsp import convert
from pursue_gen.tools.lsp.completion import complete
from pursue_gen.tools.lsp.fixes import fixes
from pursue_gen.tools.lsp.hover import hover
from pursue_gen.tools.lsp.open_document import OpenDocument, picture
from pursue_gen.tools.lsp.outline import folds, symbols

MAP = "pursue/map"
"""Our own request, {"uri": …}: the map as {"svg": …}, or why there is none as {"message": …}."""

_REQUEST_FAILED = -32803

LARGEST_MESSAGE = 32 << 20
"""Bytes of a message: more than the largest scenario takes with each letter written as two numbers of JSON."""

LONGEST_HEADER = 8192
"""Bytes of a line of a message's head."""

_LENGTH = re.compile(rb"\s*Content-Length\s*:(.*)", re.IGNORECASE | re.DOTALL)

PAUSE = 0.1
"""Seconds between a change of a text and its check: one types faster than one reads."""


def serve(pages: Optional[str] = None) -> bool:
    """Serve an editor until it exits; return True after the protocol's shutdown request.

    Raises PursueError for a message that is refused (`BoundedInput`).
    """
    logging.disable(logging.CRITICAL)  # what goes wrong is answered; on stderr editors show it as a failure
    session, messages = Session(pages), BoundedInput(sys.stdin.buffer)
    with suppress(SystemExit), os.fdopen(os.dup(sys.stdout.fileno()), "wb") as answers:  # how pygls 1 ends
        session.server.start_io(messages, answers)  # which it closes
    if messages.refusal is not None:
        raise PursueError([messages.refusal])
    return session.is_shut_down


class Session:
    """An editor, its open scenarios, and its capabilities."""

    def __init__(self, pages: Optional[str] = None) -> None:
        self.pages = pages
        self.is_shut_down = False
        self.documents: Dict[str, OpenDocument] = {}
        self._publishing = threading.Lock()  # a text that was closed has no findings any more, not even late ones
        self.server = _language_server()
        self.checker = Checker(self._publish)
        self._related = self._snippets = False
        self._encoding = "utf-16"
        self._register()

    # Notifications ----------------------------------------------------------------------------------------------------

    def initialize(self, params: lsp.InitializeParams) -> None:
        """Store the capabilities of the editor."""
        options = _as_dict(params.initialization_options)
        self.pages = str(options["docs"]) if options.get("docs") else self.pages
        text = params.capabilities.text_document
        if text is not None and text.publish_diagnostics is not None:
            self._related = bool(text.publish_diagnostics.related_information)
        item = text.completion.completion_item if text is not None and text.completion is not None else None
        self._snippets = item is not None and bool(item.snippet_support)

    def initialized(self, _params: lsp.InitializedParams) -> None:
        """Store how the editor counts columns, which is negotiated by now."""
        encoding = self.server.workspace.position_encoding
        self._encoding = str(getattr(encoding, "value", encoding))

    def opened(self, params: Any) -> None:
        """Check a text that was opened or changed."""
        uri = params.text_document.uri
        source = self.server.workspace.get_text_document(uri).source
        address = urlsplit(uri)
        name = unquote(address.path).rsplit("/", 1)[-1]
        version = params.text_document.version
        document = OpenDocument(plain(source), name, address.scheme == "file", self._encoding, version)
        self.documents[uri] = document
        self.checker.request(uri, document)

    def closed(self, params: lsp.DidCloseTextDocumentParams) -> None:
        """Clear the findings of a text that was closed."""
        uri = params.text_document.uri
        self.checker.cancel(uri)
        with self._publishing:
            self.documents.pop(uri, None)
            self._send(uri, None, [])

    def shutdown(self, _params: None) -> None:
        """The protocol's shutdown request."""
        self.is_shut_down = True

    # Requests ---------------------------------------------------------------------------------------------------------

    def complete(self, document: OpenDocument, params: lsp.CompletionParams) -> lsp.CompletionList:
        """Proposals for the text at a position."""
        items = complete(document, convert.offset_of(document, params.position))
        return lsp.CompletionList(False, convert.completion_items(document, items, self._snippets))

    def hover(self, document: OpenDocument, params: lsp.HoverParams) -> Optional[lsp.Hover]:
        """The explanation of the word at a position."""
        found = hover(document, convert.offset_of(document, params.position))
        if found is None:
            return None
        text = lsp.MarkupContent(lsp.MarkupKind.Markdown, found.markdown)
        return lsp.Hover(text, convert.range_of(document, found.start, found.end))

    def define(self, document: OpenDocument, params: lsp.DefinitionParams) -> List[lsp.Location]:
        """The declaration of the name at a position."""
        places = definition(document, convert.offset_of(document, params.position))
        return convert.locations(document, params.text_document.uri, places)

    def refer(self, document: OpenDocument, params: lsp.ReferenceParams) -> List[lsp.Location]:
        """The uses of the name at a position."""
        places = same_name(document, convert.offset_of(document, params.position))
        wanted = [place for place in places if params.context.include_declaration or not place.declares]
        return convert.locations(document, params.text_document.uri, wanted)

    def highlight(self, document: OpenDocument, params: lsp.DocumentHighlightParams) -> List[lsp.DocumentHighlight]:
        """All places of the name at a position."""
        kinds = lsp.DocumentHighlightKind
        places = same_name(document, convert.offset_of(document, params.position))
        spans = ((place, convert.range_of(document, place.start, place.end)) for place in places)
        return [lsp.DocumentHighlight(span, kinds.Write if place.declares else kinds.Read) for place, span in spans]

    def prepare_rename(self, document: OpenDocument, params: lsp.PrepareRenameParams) -> Optional[lsp.Range]:
        """The range of the name that would be renamed."""
        here = document.occurrence_at(convert.offset_of(document, params.position))
        return convert.range_of(document, here.start, here.end) if here is not None else None

    def rename(self, document: OpenDocument, params: lsp.RenameParams) -> lsp.WorkspaceEdit:
        """The edits that rename the name at a position."""
        edits = rename(document, convert.offset_of(document, params.position), params.new_name)
        return lsp.WorkspaceEdit(changes={params.text_document.uri: convert.text_edits(document, edits)})

    def outline(self, document: OpenDocument, _params: lsp.DocumentSymbolParams) -> List[lsp.DocumentSymbol]:
        """The declarations as an outline."""
        return [
            lsp.DocumentSymbol(
                name=symbol.name,
                kind=getattr(lsp.SymbolKind, STATEMENTS[symbol.kind].symbol),
                range=convert.range_of(document, symbol.start, symbol.end),
                selection_range=convert.range_of(document, symbol.name_start, symbol.name_end),
                detail=symbol.detail or None,
            )
            for symbol in symbols(document)
        ]

    def fold(self, document: OpenDocument, _params: lsp.FoldingRangeParams) -> List[lsp.FoldingRange]:
        """The ranges that can be folded."""
        kinds = lsp.FoldingRangeKind
        found = ((fold, kinds.Comment if fold.comment else kinds.Region) for fold in folds(document))
        return [lsp.FoldingRange(fold.first, fold.last, kind=kind) for fold, kind in found]

    def count(self, document: OpenDocument, params: lsp.InlayHintParams) -> List[lsp.InlayHint]:
        """How many states the objectives in a range cost."""
        start, end = (convert.offset_of(document, place) for place in (params.range.start, params.range.end))
        return convert.inlay_hints(document, start, end)

    def format(self, document: OpenDocument, _params: lsp.DocumentFormattingParams) -> List[lsp.TextEdit]:
        """The edit that formats the text; none while it has syntax errors, which are shown anyway."""
        try:
            text = formatted(document)
        except PursueError:
            return []
        edits = [] if text == document.text else [Edit(0, len(document.text), text)]
        return convert.text_edits(document, edits)

    def fix(self, document: OpenDocument, params: lsp.CodeActionParams) -> List[lsp.CodeAction]:
        """The quick fixes for the findings in a range."""
        wanted = params.context.only
        if wanted is not None and not any(str(getattr(k, "value", k)) in ("", "quickfix") for k in wanted):
            return []
        start, end = (convert.offset_of(document, place) for place in (params.range.start, params.range.end))
        uri = params.text_document.uri
        return [
            lsp.CodeAction(
                title=fix.title,
                kind=lsp.CodeActionKind.QuickFix,
                diagnostics=[convert.diagnostic(document, uri, fix.finding, self.pages, related=True)],
                is_preferred=fix.preferred,
                edit=lsp.WorkspaceEdit(changes={uri: convert.text_edits(document, fix.edits)}),
            )
            for fix in fixes(document, start, end)
        ]

    def draw(self, params: Any) -> Dict[str, str]:
        """The map as SVG, or the reason why there is none."""
        document = self.documents.get(str(_as_dict(params).get("uri")))
        if document is None:
            return {"message": "this scenario is not open"}
        try:
            return {"svg": picture(document)}
        except PursueError as problem:
            return {"message": _message(problem)}

    # Registration -----------------------------------------------------------------------------------------------------

    def _register(self) -> None:
        def notification(method: str) -> Callable[[Callable[[Any], None]], None]:
            # pygls sets attributes on its callbacks, which bound methods do not have
            return lambda call: self.server.feature(method)(lambda params: call(params))

        notification(lsp.INITIALIZE)(self.initialize)
        notification(lsp.INITIALIZED)(self.initialized)
        notification(lsp.TEXT_DOCUMENT_DID_OPEN)(self.opened)
        notification(lsp.TEXT_DOCUMENT_DID_CHANGE)(self.opened)
        notification(lsp.TEXT_DOCUMENT_DID_CLOSE)(self.closed)
        notification(lsp.SHUTDOWN)(self.shutdown)
        self._register_answer(MAP, self.draw)
        triggers = lsp.CompletionOptions(trigger_characters=[" ", '"'])
        self._register_request(lsp.TEXT_DOCUMENT_COMPLETION, self.complete, triggers)
        self._register_request(lsp.TEXT_DOCUMENT_HOVER, self.hover)
        self._register_request(lsp.TEXT_DOCUMENT_DEFINITION, self.define)
        self._register_request(lsp.TEXT_DOCUMENT_REFERENCES, self.refer)
        self._register_request(lsp.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT, self.highlight)
        self._register_request(lsp.TEXT_DOCUMENT_PREPARE_RENAME, self.prepare_rename)
        self._register_request(lsp.TEXT_DOCUMENT_RENAME, self.rename, lsp.RenameOptions(prepare_provider=True))
        self._register_request(lsp.TEXT_DOCUMENT_DOCUMENT_SYMBOL, self.outline)
        self._register_request(lsp.TEXT_DOCUMENT_FOLDING_RANGE, self.fold)
        self._register_request(lsp.TEXT_DOCUMENT_INLAY_HINT, self.count)
        self._register_request(lsp.TEXT_DOCUMENT_FORMATTING, self.format)
        kinds = [lsp.CodeActionKind.QuickFix]
        self._register_request(lsp.TEXT_DOCUMENT_CODE_ACTION, self.fix, lsp.CodeActionOptions(code_action_kinds=kinds))

    def _register_request(self, method: str, answer: Callable[[OpenDocument, Any], Any], options: Any = None) -> None:
        """Register a request about an open text; the answer for any other text is null."""

        def answered(params: Any) -> Any:
            document = self.documents.get(params.text_document.uri)
            try:
                return None if document is None else answer(document, params)
            except PursueError as problem:
                raise JsonRpcException(_message(problem), _REQUEST_FAILED) from None

        self._register_answer(method, answered, options)

    def _register_answer(self, method: str, answer: Callable[[Any], Any], options: Any = None) -> None:
        """Register a request that is answered in a worker thread, so that a long one delays no other."""

        def answered(params: Any) -> Any:
            return answer(params)

        self.server.feature(method, options)(self.server.thread()(answered))

    def _publish(self, uri: str, document: OpenDocument) -> None:
        """Send the findings of a text, if it is still the one in the editor."""
        found = [convert.diagnostic(document, uri, f, self.pages, self._related) for f in document.findings]
        with self._publishing:
            if self.documents.get(uri) is document:
                self._send(uri, document.version, found)

    def _send(self, uri: str, version: Optional[int], found: List[lsp.Diagnostic]) -> None:
        protocol = getattr(self.server, "protocol", None) or self.server.lsp  # pygls 2, pygls 1
        protocol.notify(lsp.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS, lsp.PublishDiagnosticsParams(uri, found, version))


def _language_server() -> Any:
    try:
        from pygls.lsp.server import LanguageServer
    except ImportError:  # pygls 1
        from pygls.server import LanguageServer  # type: ignore[attr-defined,no-redef] # as above
    # The whole text with each change: pygls and editors do not agree on what ends a line in every text.
    return LanguageServer("pursue-gen", __version__, text_document_sync_kind=lsp.TextDocumentSyncKind.Full)


def _message(problem: PursueError) -> str:
    first = problem.diagnostics[0]
    return f"{first.message} ({first.hint})" if first.hint else first.message


def _as_dict(value: Any) -> Dict[str, Any]:
    """What an editor sent as an object, however pygls has read it; {} for anything else."""
    if hasattr(value, "_asdict"):
        value = value._asdict()
    elif not isinstance(value, dict) and hasattr(value, "__dict__"):
        value = vars(value)
    return dict(value) if isinstance(value, dict) else {}


class Checker:
    """A daemon thread that passes texts to `publish(uri, document)`, which checks them and sends the findings."""

    def __init__(self, publish: Callable[[str, OpenDocument], None]) -> None:
        self._publish = publish
        self._waiting: Dict[str, OpenDocument] = {}
        self._wake = threading.Condition()
        threading.Thread(target=self._work, daemon=True).start()

    def request(self, uri: str, document: OpenDocument) -> None:
        """Queue a text for its check; it replaces an older version that still waits."""
        with self._wake:
            self._waiting[uri] = document
            self._wake.notify()

    def cancel(self, uri: str) -> None:
        """Remove a text from the queue."""
        with self._wake:
            self._waiting.pop(uri, None)

    def _work(self) -> None:
        while True:
            with self._wake:
                while not self._waiting:
                    self._wake.wait()
            time.sleep(PAUSE)
            with self._wake:
                texts, self._waiting = self._waiting, {}
            for uri, document in texts.items():
                try:
                    self._publish(uri, document)
                except Exception:  # a text that cannot be checked must not end the thread
                    continue


class BoundedInput:
    """A stream of messages, as pygls reads it: line by line the head, then the body.

    It is at its end before a message whose head is refused; `refusal` then says why.
    """

    def __init__(self, stream: BinaryIO) -> None:
        self.refusal: Optional[Diagnostic] = None
        self._stream = stream

    @property
    def closed(self) -> bool:
        """True where nothing more can be read."""
        return self._stream.closed

    def readline(self) -> bytes:
        """The next line of a head, b"" at the end. A length is written as pygls knows it."""
        if self.refusal is not None:
            return b""
        line = self._stream.readline(LONGEST_HEADER + 1)
        if len(line) > LONGEST_HEADER:
            return self._refuse(f"a line of its head has more than {LONGEST_HEADER} bytes")
        found = _LENGTH.fullmatch(line)
        if found is None:
            return line
        length = found.group(1).strip()
        if not re.fullmatch(rb"[0-9]{1,12}", length) or not 0 < int(length) <= LARGEST_MESSAGE:
            shown = length[:40].decode("ascii", "replace")
            return self._refuse(f"its Content-Length is {shown!r}; expected 1 to {LARGEST_MESSAGE}")
        return b"Content-Length: %d\r\n" % int(length)

    def read(self, size: int) -> bytes:
        """The body of a message."""
        return self._stream.read(size)

    def _refuse(self, why: str) -> bytes:
        hint = "the editor has to speak the language server protocol: restart the server there"
        self.refusal = error("LSP005", f"a message of the editor is refused: {why}", hint=hint)
        return b""
