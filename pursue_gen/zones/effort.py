"""The hook by which whoever started long work on zones looks after it."""

from __future__ import annotations

import threading
from typing import Callable, Optional


class _Hook(threading.local):
    look: Optional[Callable[[], None]] = None


_HOOK = _Hook()


def look_after(look: Optional[Callable[[], None]]) -> Optional[Callable[[], None]]:
    """Sets what `attend` calls in this thread (None: nothing); it may raise to end the work. Returns what it was."""
    before, _HOOK.look = _HOOK.look, look
    return before


def attend() -> None:
    """Called by whatever loops over zones, for each of them or for all that one is compared with."""
    if _HOOK.look is not None:
        _HOOK.look()
