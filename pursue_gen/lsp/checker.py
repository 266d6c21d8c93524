"""Checks texts beside the server's main thread: the latest version of each, and never two at once."""

from __future__ import annotations

import threading
import time
from typing import Callable, Dict

from pursue_gen.lsp.document import Document

PAUSE = 0.1
"""Seconds that a text rests before it is checked: one types faster than one reads."""


class Checker:
    """A thread of its own, which ends with the program, that hands checked texts to `tell(uri, document)`."""

    def __init__(self, tell: Callable[[str, Document], None]) -> None:
        self._tell = tell
        self._waiting: Dict[str, Document] = {}
        self._wake = threading.Condition()
        threading.Thread(target=self._work, daemon=True).start()

    def ask(self, uri: str, document: Document) -> None:
        """Checks a text soon; an older one of the same address that still waits is left out."""
        with self._wake:
            self._waiting[uri] = document
            self._wake.notify()

    def forget(self, uri: str) -> None:
        """Leaves out what waits."""
        with self._wake:
            self._waiting.pop(uri, None)

    def _work(self) -> None:
        while True:
            with self._wake:
                while not self._waiting:
                    self._wake.wait()
            time.sleep(PAUSE)
            with self._wake:
                asked, self._waiting = self._waiting, {}
            for uri, document in asked.items():
                try:
                    self._tell(uri, document)
                except Exception:  # a text that cannot be checked must not end the thread
                    continue
