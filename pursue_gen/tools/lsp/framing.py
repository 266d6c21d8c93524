"""What an editor sends, within bounds: heads of messages are checked before anything is read because of them."""

from __future__ import annotations

import re
from typing import BinaryIO, Optional

from pursue_gen.diagnostics import Diagnostic, error

LARGEST_MESSAGE = 32 << 20
"""Bytes of a message: more than the largest scenario takes with each letter written as two numbers of JSON."""

LONGEST_HEADER = 8192
"""Bytes of a line of a message's head."""

_LENGTH = re.compile(rb"\s*Content-Length\s*:(.*)", re.IGNORECASE | re.DOTALL)


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
