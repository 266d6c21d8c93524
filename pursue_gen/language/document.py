"""A text in PuRSUE-ML with its statements, right or wrong: nothing of it is lost, and a change is an edit of its text.

Words, comments and blanks stay as they were read; an edit changes its own stretch and no other.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Dict, Iterable, List, Optional, Tuple, TypeVar

from lark import Token

from pursue_gen.diagnostics import Span
from pursue_gen.language.chunks import COMMENTS
from pursue_gen.language.kinds import STATEMENTS
from pursue_gen.language.syntax import Statement, Syntax, statements_of, syntax_of, tokens_of, too_large
from pursue_gen.language.tokens import Lines, end_of, start_of

Block = Tuple[Token, ...]
"""A statement with the comments in it and behind it on its line, or comments on a line without a statement before."""

_RANK: Dict[str, int] = {kind: rank for rank, kind in enumerate(STATEMENTS)}

AnyDocument = TypeVar("AnyDocument", bound="Document")


@dataclass(frozen=True)
class Edit:
    """text[start:end] is replaced by `text`."""

    start: int
    end: int
    text: str


def edited(text: str, edits: Iterable[Edit]) -> str:
    """The text after all the edits, whose offsets are those of the text before; they do not overlap."""
    parts: List[str] = []
    done = 0
    for edit in sorted(edits, key=lambda one: (one.start, one.end)):
        assert edit.start >= done, "edits overlap"
        parts += [text[done : edit.start], edit.text]
        done = edit.end
    return "".join([*parts, text[done:]])


def written(token: Token, text: str) -> Edit:
    """Writes a text in the place of a token."""
    return Edit(start_of(token), end_of(token), text)


def behind(token: Token, text: str) -> Edit:
    """Adds a text behind a token."""
    return Edit(end_of(token), end_of(token), text)


def statement_text(text: str, span: Span) -> str:
    """The statement at a span of a text on one line, without its comments; with the member of a group that is meant."""
    begin, end = Lines(text).of_span(span)
    alone = Document(text[begin:end])
    words = " ".join(alone.changed(*(written(comment, " ") for comment in alone.comments)).text.split())
    return f"{words} ({span.member})" if span.member else words


def rank(statement: Statement) -> int:
    """The place of a statement's kind in the order that the original reads; all kinds of objectives have one place, and
    what is for each of a group stands among those of its kind.
    """
    return min(_RANK.get(statement.body.kind, _RANK["OBJECTIVE"]), _RANK["OBJECTIVE"])


@dataclass(frozen=True)
class Document:
    """A text whose line ends are newlines; `file` is what messages call it. What is derived is computed once, when it
    is first used.
    """

    text: str
    file: str = "scenario.pur"

    @cached_property
    def lines(self) -> Lines:
        """Where its lines begin and end."""
        return Lines(self.text)

    @cached_property
    def _tokens(self) -> Optional[Tuple[Token, ...]]:
        return tokens_of(self.text)

    @property
    def tokens(self) -> Tuple[Token, ...]:
        """Every word, sign and comment; none of a text that is too large to be a scenario."""
        return self._tokens or ()

    @cached_property
    def statements(self) -> Tuple[Statement, ...]:
        """The statements, right or wrong."""
        return statements_of(self.tokens)

    @cached_property
    def syntax(self) -> Syntax:
        """The trees of the statements that are well formed, and what is wrong with the others."""
        if self._tokens is None:
            return Syntax((), (too_large(self.file),))
        return syntax_of(self.statements, self.text, self.file)

    @cached_property
    def comments(self) -> Tuple[Token, ...]:
        """The comments, without poses behind places."""
        poses = {start_of(token) for one in self.statements for token in one.tokens if token.type == "POSE"}
        return tuple(t for t in self.tokens if t.type in COMMENTS or (t.type == "POSE" and start_of(t) not in poses))

    @cached_property
    def blocks(self) -> Tuple[Block, ...]:
        """The whole text but for its blanks, statement by statement, each with its comments."""
        ends = {statement.start: statement.end for statement in self.statements}
        found: List[List[Token]] = []
        end = 0  # of the latest statement
        for token in self.tokens:
            start = start_of(token)
            goes_on = found and (start < end or found[-1][-1].end_line == token.line)
            if goes_on and start not in ends:
                found[-1].append(token)
            else:
                found.append([token])
            end = ends.get(start, end)
        return tuple(map(tuple, found))

    @cached_property
    def _block_at(self) -> Dict[int, Block]:
        return {start_of(block[0]): block for block in self.blocks}

    def comments_in(self, statement: Statement) -> Tuple[Token, ...]:
        """The comments between the words of a statement."""
        words = {start_of(token) for token in statement.tokens}
        block = self._block_at[statement.start]
        return tuple(one for one in block if start_of(one) < statement.end and start_of(one) not in words)

    def comments_behind(self, statement: Statement) -> Tuple[Token, ...]:
        """The comments behind a statement on its line."""
        return tuple(one for one in self._block_at[statement.start] if start_of(one) >= statement.end)

    def statement_at(self, offset: int) -> Optional[Statement]:
        """The statement that an offset is in, or right behind of."""
        latest = next((part for part in reversed(self.statements) if part.start <= offset), None)
        return latest if latest is not None and offset <= latest.end else None

    def token_at(self, offset: int) -> Optional[Token]:
        """The word, sign or comment that an offset is in, or right behind of; the one that begins there first."""
        return next((token for token in reversed(self.tokens) if start_of(token) <= offset <= end_of(token)), None)

    def in_comment(self, offset: int) -> bool:
        """Would a letter that is typed here belong to a comment?"""
        for token in self.tokens:
            if token.type in COMMENTS or token.type == "POSE":
                open_end = token.type != "BLOCK_COMMENT"  # the others go on when one types at their end
                end = end_of(token)
                if start_of(token) + 1 < offset and (offset < end or (open_end and offset == end)):
                    return True
        return False

    # Edits ------------------------------------------------------------------------------------------------------------

    def changed(self: AnyDocument, *edits: Edit) -> AnyDocument:
        """The document after edits that do not overlap."""
        return replace(self, text=edited(self.text, edits))

    def line_end(self, offset: int) -> int:
        """The end of the line that an offset is in; further down where a comment that begins behind it goes on."""
        end = self.lines.end_at(offset)
        for token in self.comments:
            if offset <= start_of(token) < end < end_of(token):
                end = self.lines.end_at(end_of(token))
        return end

    def cut(self, first: Token, last: Token) -> Edit:
        """Deletes from a token to another, with the blanks before."""
        return Edit(len(self.text[: start_of(first)].rstrip(" \t")), end_of(last), "")

    def inserted(self, words: str) -> Edit:
        """Adds a statement, behind the last one of its kind or of a kind that goes before."""
        new = rank(Document(words).statements[0])
        before = [one for one in self.statements if rank(one) <= new]
        if before:
            at = self.line_end(before[-1].end)
            return Edit(at, at, ("\n" if rank(before[-1]) == new else "\n\n") + words)
        if self.statements:
            at = self.lines.start_at(self.statements[0].start)
            return Edit(at, at, words + "\n\n")
        end = len(self.text)
        return Edit(end, end, ("\n" if self.text.strip() else "") + words + "\n")

    def deleted(self, statement: Statement) -> Edit:
        """Deletes a statement, with its line where nothing else stands in that."""
        start, end = statement.start, statement.end
        line, rest = self.lines.start_at(start), self.lines.end_at(end)
        if not self.text[line:start].strip() and not self.text[end:rest].strip():
            start, end = line, min(rest + 1, len(self.text))
        return Edit(start, end, "")
