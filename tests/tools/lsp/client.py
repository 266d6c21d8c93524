"""A small editor: speaks the language server protocol with `pursue-gen lsp` on its stdin and stdout."""

from __future__ import annotations

import json
import subprocess
import sys
import threading
from queue import Queue
from types import TracebackType
from typing import Any, Dict, List, Optional, Tuple, Type

URI = "file:///some%20where/my_floor.pur"
PATIENCE = 300
SNIPPETS = {
    "textDocument": {
        "completion": {"completionItem": {"snippetSupport": True}},
        "publishDiagnostics": {"relatedInformation": True},
        "rename": {"prepareSupport": True},
    }
}


class Refused(Exception):
    """The server answered with an error."""


class Editor:
    """The server's process, and what it has said."""

    def __init__(self, *options: str, capabilities: Optional[Dict[str, Any]] = None, **more: Any) -> None:
        words = [sys.executable, "-m", "pursue_gen", "lsp", *options]
        pipe = subprocess.PIPE
        self.process = subprocess.Popen(words, stdin=pipe, stdout=pipe, stderr=pipe)
        self._messages: "Queue[Optional[Dict[str, Any]]]" = Queue()
        threading.Thread(target=self._listen, daemon=True).start()
        self._number = 0
        self._version = 0
        self._told: List[Dict[str, Any]] = []
        if capabilities is not None:
            start = {"processId": None, "rootUri": None, "capabilities": capabilities, **more}
            self.abilities = self.ask("initialize", start)["capabilities"]
            self.tell("initialized", {})

    def __enter__(self) -> Editor:
        return self

    def __exit__(
        self, kind: Optional[Type[BaseException]], problem: Optional[BaseException], where: Optional[TracebackType]
    ) -> None:
        self.process.kill()
        self.process.wait()
        for stream in (self.process.stdin, self.process.stdout, self.process.stderr):
            if stream is not None:
                stream.close()

    def write(self, data: bytes) -> None:
        """Bytes as they are."""
        assert self.process.stdin is not None
        self.process.stdin.write(data)
        self.process.stdin.flush()

    def tell(self, method: str, params: Any = None) -> None:
        """Something that has no answer."""
        self._send({"method": method, "params": params})

    def ask(self, method: str, params: Any = None) -> Any:
        """The answer. Raises Refused with the server's reason."""
        self._number += 1
        self._send({"id": self._number, "method": method, "params": params})
        while True:
            message = self._messages.get(timeout=PATIENCE)
            assert message is not None, "the server is gone"
            if message.get("id") == self._number:
                if "error" in message:
                    raise Refused(message["error"]["message"])
                return message["result"]
            self._told.append(message)

    def open(self, text: str, uri: str = URI) -> None:
        """Opens a text."""
        self._version += 1
        document = {"uri": uri, "languageId": "pursue", "version": self._version, "text": text}
        self.tell("textDocument/didOpen", {"textDocument": document})

    def change(self, text: str, uri: str = URI) -> None:
        """Replaces the text."""
        self._version += 1
        document = {"uri": uri, "version": self._version}
        self.tell("textDocument/didChange", {"textDocument": document, "contentChanges": [{"text": text}]})

    def findings(self) -> List[Dict[str, Any]]:
        """What the server finds in the text as it is now."""
        return self._published(self._version)

    def close(self) -> List[Dict[str, Any]]:
        """Closes the text; what the server still finds in it."""
        self.tell("textDocument/didClose", {"textDocument": {"uri": URI}})
        return self._published(None)

    def _published(self, version: Optional[int]) -> List[Dict[str, Any]]:
        while True:
            message = self._told.pop(0) if self._told else self._messages.get(timeout=PATIENCE)
            assert message is not None, "the server is gone"
            if message.get("method") == "textDocument/publishDiagnostics":
                found: List[Dict[str, Any]] = message["params"]["diagnostics"]
                if message["params"].get("version") == version:
                    return found  # those of earlier versions come where there is time for them

    def at(self, what: str, line: int, character: int, **more: Any) -> Any:
        """The answer to a question about a place."""
        place = {"textDocument": {"uri": URI}, "position": {"line": line, "character": character}}
        return self.ask("textDocument/" + what, {**place, **more})

    def about(self, what: str, **more: Any) -> Any:
        """The answer to a question about the text."""
        return self.ask("textDocument/" + what, {"textDocument": {"uri": URI}, **more})

    def leave(self) -> Tuple[int, str]:
        """Takes leave; the exit status, and what stands on stderr."""
        assert self.ask("shutdown") is None
        self.tell("exit")
        return self.end()

    def end(self) -> Tuple[int, str]:
        """Waits for the end."""
        assert self.process.stdin is not None and self.process.stderr is not None
        self.process.wait(timeout=PATIENCE)
        return self.process.returncode, self.process.stderr.read().decode()

    def _send(self, message: Dict[str, Any]) -> None:
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self.write(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))

    def _listen(self) -> None:
        stream = self.process.stdout
        assert stream is not None
        while True:
            length = 0
            for line in iter(stream.readline, b"\r\n"):
                if not line:
                    self._messages.put(None)
                    return
                if line.lower().startswith(b"content-length:"):
                    length = int(line.split(b":")[1])
            self._messages.put(json.loads(stream.read(length)))


def edited(text: str, edits: List[Dict[str, Any]]) -> str:
    """A text after an editor's edits, which count columns in UTF-16; no two overlap."""
    lines = [line.encode("utf-16-le", "surrogatepass") for line in text.split("\n")]

    def offset(place: Dict[str, int]) -> int:
        return sum(len(line) + 2 for line in lines[: place["line"]]) + 2 * place["character"]

    data = text.encode("utf-16-le", "surrogatepass")
    for edit in sorted(edits, key=lambda e: offset(e["range"]["start"]), reverse=True):
        start, end = offset(edit["range"]["start"]), offset(edit["range"]["end"])
        data = data[:start] + edit["newText"].encode("utf-16-le") + data[end:]
    return data.decode("utf-16-le", "surrogatepass")
