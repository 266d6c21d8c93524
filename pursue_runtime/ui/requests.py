"""What pages may ask for, and which word a press on a page publishes: each press once, and only while it is meant.

Several pages show the same button, and a page shows a state that may be over when the button is pressed.
"""

from __future__ import annotations

import time
from typing import Any, Callable, Collection, Dict, NamedTuple, Tuple

from pursue_runtime.bounded import BadText, read_json
from pursue_runtime.event_words import parse_word
from pursue_runtime.state import LIVE, SystemState

REQUESTS = {"start": False, "stop": False, "finish": False, "next": False, "close": False, "say": True, "done": True,
            "order": True}
"""What a page may ask for, and whether a word, and the number of the state that the page shows, belong to it."""

ANSWERED = 2.0
"""Seconds after which a press that no state has answered may be repeated: its word may be lost."""


class PageRequest(NamedTuple):
    """A request from a page; `seq` is the number of the state that the page showed."""

    do: str
    word: str = ""
    seq: int = 0


def read_request(text: Any) -> PageRequest:
    """Reads a message of the page. Raises ValueError with what was expected."""
    try:
        data = read_json(text)
    except (TypeError, BadText) as problem:
        raise ValueError(f"not JSON; {_expected()}") from problem
    known = isinstance(data, dict) and isinstance(data.get("do"), str) and data["do"] in REQUESTS
    word, seq = (data.get("word", ""), data.get("seq", -1)) if known else (None, -1)
    if not isinstance(word, str) or bool(word) != REQUESTS[data["do"]]:
        raise ValueError(_expected())
    if not word:
        return PageRequest(data["do"])
    if type(seq) is not int or seq < 0:
        raise ValueError(_expected())
    return PageRequest(data["do"], word, seq)


def _expected() -> str:
    plain, words = (" or ".join(do for do in REQUESTS if REQUESTS[do] is on) for on in (False, True))
    return f'expected {{"do": …}} with {plain}, or {{"do": …, "word": …, "seq": <the number of a state>}} with {words}'


class Presses:
    """Decides which presses count. `clock` gives seconds that only grow."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._pressed: Dict[str, Tuple[int, float]] = {}  # by word: the state of the last press, and its moment
        self._happened: Dict[Tuple[str, str], int] = {}  # by agent and event: the state to which it led last

    def on_state(self, state: SystemState) -> None:
        """Take a state."""
        if state.event:
            self._happened[state.agent, state.event] = state.seq

    def word(self, request: PageRequest, state: SystemState, possible: Collection[str]) -> Tuple[str, str]:
        """Return the word to publish ("": none), and a remark for the page. `possible` are the words of now.

        The word has the number of the state that the page showed: what its agent has begun since then is not meant.
        """
        word = parse_word(request.word)
        if state.status not in LIVE or request.word not in possible or request.seq > state.seq or word is None:
            return "", f"{request.word} is not possible now."
        if any(seq > request.seq for (agent, event), seq in self._happened.items()
               if event == word.event and word.agent in ("", agent)):
            return "", f"{request.word} has happened meanwhile: nothing was sent."
        seq, moment = self._pressed.get(request.word, (-1, 0.0))
        if seq >= request.seq and self._clock() < moment + ANSWERED:
            return "", f"{request.word} was sent already."
        self._pressed[request.word] = (request.seq, self._clock())
        return numbered(request.word, request.seq), ""


def numbered(word: str, seq: int) -> str:
    """Return a report with the number of a state in which what it is about went on; see docs/run_time.md, Words."""
    return f"{word}#{seq}"
