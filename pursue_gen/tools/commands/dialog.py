"""Questions to a person on a terminal, or to whatever stands on stdin."""

from __future__ import annotations

from typing import Callable, TextIO

from pursue_gen.diagnostics import PursueError, usage_error
from pursue_gen.tools.authoring.dialog import Answer, Dialog

_PATIENCE = 20  # bad answers in a row: then it is no person who answers
LONGEST_LINE = 10_000
"""Letters of what a person types before Enter."""


class StreamDialog(Dialog):
    """Writes to one stream and reads from another; with `quiet` it takes every suggestion instead."""

    def __init__(self, source: TextIO, screen: TextIO, quiet: bool = False) -> None:
        self._source, self._screen, self._quiet = source, screen, quiet

    def show(self, text: str) -> None:
        if not self._quiet:
            print(text, file=self._screen)

    def ask(self, question: str, suggestion: str, accept: Callable[[str], Answer]) -> Answer:
        if self._quiet:
            return accept(suggestion)
        for _ in range(_PATIENCE):
            print(f"{question} [{suggestion or 'nobody'}] ", end="", file=self._screen, flush=True)
            try:
                return accept(self._line() or suggestion)
            except ValueError as problem:
                self.show(f"  {problem}")
        raise _ended(f"{_PATIENCE} answers in a row could not be used")

    def _line(self) -> str:
        try:
            line = self._source.readline(LONGEST_LINE)
        except UnicodeDecodeError:
            raise _ended("what was typed is not text in UTF-8") from None
        if len(line) == LONGEST_LINE:
            raise _ended("what was typed is no answer: its line does not end")
        if not line:
            print(file=self._screen)
            raise _ended("the answers ended before the questions did")
        if not self._source.isatty():  # a terminal has shown the answer already
            self.show(line.strip())
        return line.strip()


def _ended(message: str) -> PursueError:
    return usage_error(message, "nothing was written; answer all questions, or take the suggestions with --yes")
