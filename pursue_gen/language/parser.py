"""From a PuRSUE-ML text to a Scenario."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Dict, FrozenSet, Iterable, Iterator, List, Optional, Tuple

from lark import Token, Tree

from pursue_gen.diagnostics import Diagnostic, PursueError, Severity, error, in_order
from pursue_gen.language import scenario as pml
from pursue_gen.language.document import Document
from pursue_gen.language.kinds import BY_RULE
from pursue_gen.language.lifts import in_building
from pursue_gen.language.numbers import Number
from pursue_gen.language.statements.unit import Unit, seconds_in
from pursue_gen.language.syntax import MOST_LETTERS, too_large
from pursue_gen.language.tokens import bare
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.outcomes import Invalid
from pursue_runtime.named_files import read_start

MOST_BYTES = MOST_LETTERS * 4  # bytes of a letter
"""The most bytes of a scenario."""

_PATIENCE = 5
"""Seconds in which something has to come where the file is a pipe."""


@dataclass(frozen=True)
class Reading:
    """A text as far as it could be read: the scenario (None after a syntax error) and what was found on the way.

    `partial` is the scenario that the sound statements make, with errors or without; `lost` are the names that the
    others may have declared; `whole` is as in `Syntax`.
    """

    scenario: Optional[pml.Scenario]
    diagnostics: Tuple[Diagnostic, ...]
    partial: pml.Scenario
    lost: FrozenSet[str] = frozenset()
    whole: bool = True


def parse(text: str, file: str, name: Optional[str] = None) -> pml.Scenario:
    """The scenario in a text, not checked: `file` is what messages call it, `name` is its stem unless given.

    Raises PursueError with every syntax error.
    """
    reading = read(text, file, name)
    return without_errors(reading.scenario, reading.diagnostics)


def read_text(file: str) -> str:
    """The text of a scenario file. Raises PursueError where it cannot be read or is not text."""
    return text_of(read_bytes(file), file)


def read_bytes(file: str) -> bytes:
    """The bytes of a scenario file, no more than it may have and one; from a pipe they have to come soon.

    Raises PursueError (exit status 2).
    """
    try:
        return read_start(file, MOST_BYTES, patience=_PATIENCE)
    except (OSError, ValueError) as problem:
        reason = getattr(problem, "strerror", None) or str(problem)
        hint = "name a scenario file, by convention *.pur"
        raise PursueError([error("PML001", f"cannot read {file}: {reason}", hint=hint)]) from None


def text_of(content: bytes, file: str) -> str:
    """The text in the bytes of a scenario. Raises PursueError where there are too many, or they are not text."""
    if len(content) > MOST_BYTES and b"\0" not in content:  # of a program or a picture that it is large says less
        raise Invalid([too_large(file)])
    hint = "save the scenario as plain text in UTF-8; a word processor's file is not plain text"
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as problem:
        if content[:2] in (b"\xff\xfe", b"\xfe\xff"):
            hint = "it is text in UTF-16: save it as UTF-8"
        message = f"{file} is not text in UTF-8 (byte {problem.start + 1})"
        raise PursueError([error("PML002", message, hint=hint)]) from None
    if "\0" in text:
        message = f"{file} is not plain text: it holds bytes that are 0 (the first is byte {content.index(0) + 1})"
        raise PursueError([error("PML002", message, hint=hint)])
    return text


def read(text: str, file: str, name: Optional[str] = None) -> Reading:
    """The scenario in a text and every finding about its syntax, in file order; never raises."""
    return read_document(Document(text.replace("\r\n", "\n").replace("\r", "\n"), file), name)


def read_document(document: Document, name: Optional[str] = None) -> Reading:
    """As `read`."""
    syntax, file = document.syntax, document.file
    reader = TreeReader(file, dict(_labels(syntax.trees)), _unit(document))
    parts: Dict[str, List[Any]] = defaultdict(list)
    for tree in syntax.trees:
        for part in _parts(tree, reader):
            parts[part.listed_in].append(part)
    findings = (*syntax.findings, *reader.findings)
    written = pml.Scenario(
        name=Path(file).stem if name is None else name,
        file=file,
        text=document.text,
        **{field: tuple(some) for field, some in parts.items()},
    )
    value = in_building(written)
    broken = any(finding.severity is Severity.ERROR for finding in syntax.findings)
    lost = syntax.lost if broken else frozenset()
    return Reading(None if broken else value, in_order(findings), value, lost, syntax.whole)


def without_errors(scenario: Optional[pml.Scenario], findings: Tuple[Diagnostic, ...]) -> pml.Scenario:
    """The scenario. Raises PursueError with the errors among the findings, if there are any."""
    errors = [finding for finding in findings if finding.severity is Severity.ERROR]
    if errors or scenario is None:
        raise Invalid(errors)
    return scenario


def _parts(tree: Any, reader: TreeReader) -> Tuple[Any, ...]:
    """The parts that a statement declares: a patrol of several places is several objectives. None of the tail that the
    original's tools leave."""
    if isinstance(tree, Token):
        return ()
    reader.member = getattr(tree.meta, "member", "")
    found = BY_RULE[tree.data].read(reader, *tree.children, span=reader.span(tree))
    return found if isinstance(found, tuple) else (found,)


def _unit(document: Document) -> Optional[Number]:
    """The seconds of a time unit, where a statement says that, be it right or wrong; the first one counts."""
    found = [part.tokens[1:2] for part in document.statements if part.kind == Unit.token()]
    return next((seconds_in(word) or 1 for words in found for word in words), 1 if found else None)


def _labels(trees: Iterable[Tree[Token]]) -> Iterator[Tuple[str, str]]:
    """Names with their labels, where they have one; the first declaration counts."""
    for tree in reversed(list(trees)):
        if isinstance(tree, Tree) and BY_RULE[tree.data].labelled:
            name, label, *_ = tree.children
            if isinstance(name, Token) and isinstance(label, Token):
                yield bare(name), bare(label)
