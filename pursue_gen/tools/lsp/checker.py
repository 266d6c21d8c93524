"""Checks texts in a thread of its own: the latest version of each, one at a time."""

from __future__ import annotations

import threading
import time
from typing import Callable, Dict

from pursue_gen.tools.lsp.open_document import OpenDocument

PAUSE = 0.1
"""Seconds between a change of a text and its check: one types faster than one reads."""


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
