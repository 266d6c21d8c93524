"""A text in an editor with what is derived from it; each part is computed once, when it is first used."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Dict, Optional, Tuple

from lark import Token

from pursue_gen.diagnostics import Diagnostic, Severity
from pursue_gen.language.checks import check_reading
from pursue_gen.language.names import KINDS
from pursue_gen.language.parser import Reading, read
from pursue_gen.language.scenario import Scenario
from pursue_gen.tools.lsp.positions import UTF_16, Positions, plain
from pursue_gen.tools.lsp.tokens import COMMENTS, Occurrence, Statement, all_tokens, occurrences, statements

if TYPE_CHECKING:
    from pursue_gen.explanation.sizes import Size


@dataclass(frozen=True)
class Document:
    """A scenario as it is being written. `file` is what messages call it; `text` has newlines as its line ends.

    `named`: it has a file name that can be wrong; `encoding`: what the editor counts columns in; `version`: the
    editor's number for this state of the text.
    """

    text: str
    file: str = "scenario.pur"
    named: bool = True
    encoding: str = UTF_16
    version: Optional[int] = None

    @classmethod
    def of(
        cls, source: str, file: str, named: bool = True, encoding: str = UTF_16, version: Optional[int] = None
    ) -> Document:
        """The document for an editor's text, whatever its line ends."""
        return cls(plain(source), file, named, encoding, version)

    @cached_property
    def positions(self) -> Positions:
        """Offsets and positions of the text."""
        return Positions(self.text, self.encoding)

    @cached_property
    def tokens(self) -> Tuple[Token, ...]:
        """Every word, sign and comment."""
        return all_tokens(self.text)

    @cached_property
    def comments(self) -> Tuple[Token, ...]:
        """The comments, without poses behind places."""
        poses = {id(token) for part in self.statements for token in part.tokens if token.type == "POSE"}
        return tuple(t for t in self.tokens if t.type in COMMENTS or (t.type == "POSE" and id(t) not in poses))

    @cached_property
    def statements(self) -> Tuple[Statement, ...]:
        """The statements, right or wrong."""
        return statements(self.tokens)

    @cached_property
    def occurrences(self) -> Tuple[Occurrence, ...]:
        """Every name where one may stand."""
        return occurrences(self.statements)

    @cached_property
    def declared(self) -> Dict[str, Dict[str, Occurrence]]:
        """kind → name → its first declaration."""
        found: Dict[str, Dict[str, Occurrence]] = {kind: {} for kind in KINDS}
        for occurrence in self.occurrences:
            if occurrence.declares:
                found[occurrence.kind].setdefault(occurrence.name, occurrence)
        return found

    @cached_property
    def reading(self) -> Reading:
        """What the parser makes of it."""
        return read(self.text, self.file, self._name)

    @cached_property
    def findings(self) -> Tuple[Diagnostic, ...]:
        """Everything that is wrong with it."""
        return check_reading(self.reading)

    @cached_property
    def scenario(self) -> Scenario:
        """The scenario that its sound statements make; those with a syntax error are left out."""
        if self.reading.partial is not None:
            return self.reading.partial
        return Scenario(self._name or "", self.file, self.text, (), (), (), (), (), (), (), (), ())

    @cached_property
    def sizes(self) -> Tuple[Size, ...]:
        """What the statements of its objectives cost; () while something is wrong with it, or there is none."""
        from pursue_gen.explanation.sizes import sizes

        wrong = any(finding.severity is Severity.ERROR for finding in self.findings)
        return () if wrong or self.reading.partial is None else sizes(self.reading.partial)

    def statement_at(self, offset: int) -> Optional[Statement]:
        """The statement that an offset is in, or right behind of."""
        latest = None
        for part in self.statements:
            if part.start > offset:
                break
            latest = part
        return latest if latest is not None and offset <= latest.end else None

    def occurrence_at(self, offset: int) -> Optional[Occurrence]:
        """The name that an offset is in, or right behind of."""
        for occurrence in self.occurrences:
            if occurrence.start <= offset <= occurrence.end:
                return occurrence
        return None

    def token_at(self, offset: int) -> Optional[Token]:
        """The word, sign or comment that an offset is in, or right behind of; the one that begins there first."""
        found = None
        for token in self.tokens:
            start = token.start_pos or 0
            if start > offset:
                break
            if offset <= start + len(token):
                found = token
        return found

    def in_comment(self, offset: int) -> bool:
        """Would a letter that is typed here belong to a comment?"""
        for token in self.tokens:
            start = token.start_pos or 0
            if token.type in COMMENTS or token.type == "POSE":
                open_end = token.type != "BLOCK_COMMENT"  # the others go on when one types at their end
                if start + 1 < offset and (offset < start + len(token) or (open_end and offset == start + len(token))):
                    return True
        return False

    @property
    def _name(self) -> Optional[str]:
        return PurePosixPath(self.file).stem if self.named else "untitled"
