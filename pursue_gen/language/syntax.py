"""From a text to its words and comments, its statements and their trees, with every syntax error of it in words."""

from __future__ import annotations

import os
import re
import sys
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import groupby
from pathlib import Path
from typing import Any, Dict, FrozenSet, Iterable, List, Mapping, Optional, Sequence, Set, Tuple

from lark import Lark, Token, UnexpectedToken

from pursue_gen.diagnostics import Diagnostic, Span, error
from pursue_gen.language.chunks import BLANKS, chunks_of, significant
from pursue_gen.language.for_each import NAMES, behind_of, body_of, with_groups, without_owners
from pursue_gen.language.groups import check_groups, written_out
from pursue_gen.language.kinds import BY_RULE, DECLARED, KEYWORDS, MAY_BE_NAMES, STATEMENTS, TAIL
from pursue_gen.language.members import no_list
from pursue_gen.language.messages import bare_objective, explain, kind_of, of_a_comment, unfinished, unknown_statement
from pursue_gen.language.tokens import end_of, span_of, start_of

MOST_LETTERS = 1_000_000
MOST_WORDS = 100_000
"""The largest text that is read: many times a floor with 1,000 places, and still read in seconds."""

_DEEPEST = 40
"""Brackets within brackets in a rule or a condition; beyond it is no scenario, and Python's own stack has an end."""
_WIDEST = 500
"""Events in one rule, parts of one condition."""
_SPLIT = "split the rule into several rules"
_SHORTEN = "say it with fewer of them; a state that events set can stand for much"
_ATOMS = frozenset(("AT", "ON_WAY", "BETWEEN", "DOING", "HAS", "IS_TRUE", "IS_FALSE"))
MOST_FINDINGS = 1000
"""The most errors that are reported; with more of them the file is no scenario."""

_PREFIXES = ("OBJECTIVE", "REACH_OBJECTIVE")


@dataclass(frozen=True)
class Statement:
    """A statement, right or wrong: its tokens (no comments but poses) and its stretch of the text, which one without
    tokens does not have.
    """

    tokens: Tuple[Token, ...]

    @property
    def kind(self) -> str:
        """The token that says which statement it is; anything where no statement begins like this."""
        return kind_of(self.tokens)

    @property
    def body(self) -> Statement:
        """What stands behind `for each … :`; else the statement itself."""
        return Statement(tuple(body_of(self.tokens)))

    @property
    def start(self) -> int:
        """Offset of its first character."""
        return start_of(self.tokens[0])

    @property
    def end(self) -> int:
        """Offset behind its last character."""
        return end_of(self.tokens[-1])

    @property
    def name(self) -> Optional[Token]:
        """The quoted name that it declares, as far as there is one."""
        named = self.kind in DECLARED and len(self.tokens) > 1 and self.tokens[1].type == "NAME"
        return self.tokens[1] if named else None

    def first(self, kind: str) -> Optional[Token]:
        """The first token of a kind."""
        return next((token for token in self.tokens if token.type == kind), None)

    def pair(self, kind: str) -> Optional[Tuple[Token, Token]]:
        """The word of a kind and the number behind it."""
        pairs = zip(self.tokens, self.tokens[1:])
        return next(((word, number) for word, number in pairs if (word.type, number.type) == (kind, "NUMBER")), None)


@dataclass(frozen=True)
class Syntax:
    """What the statements of a text are: the trees of those that are well formed, an error for each other one, in file
    order.

    `lost` are the names in the others: they may have been declared there. `whole` is False where statements are
    missing, as a group or what is for each of it is not right; `groups`: name → members, "" those of `each robot`; none
    where nothing is said of groups.
    """

    trees: Tuple[Any, ...]
    findings: Tuple[Diagnostic, ...]
    lost: FrozenSet[str] = frozenset()
    whole: bool = True
    groups: Mapping[str, Tuple[str, ...]] = field(default_factory=dict)


@lru_cache(maxsize=None)
def grammar() -> Lark:
    """The parser; made once, at the first text, so that to import the package costs nothing."""
    how: Dict[str, Any] = {"start": ["statement", "wrong", "comment"], "propagate_positions": True}
    return Lark(grammar_text(), parser="lalr", lexer="basic", cache=_kept_tables() or False, **how)


def grammar_text() -> str:
    """The grammar: grammar.lark, and what follows from the kinds of statements and their words."""
    rules = [
        (Path(__file__).parent / "grammar.lark").read_text(encoding="utf-8"),
        f"?statement: {' | '.join((*BY_RULE, TAIL))}",
        f"_each: {' | '.join(rule for rule in BY_RULE if rule not in ('group', 'foreach'))}",
        *(kind.grammar() for kind in STATEMENTS.values()),
        f"ref: WORD | {' | '.join(MAY_BE_NAMES)}",
        *(f'{token}: "{word}"' for token, word in KEYWORDS.items()),
    ]
    return "\n".join(rules) + "\n"


def _kept_tables() -> Optional[str]:
    """The file in which Lark keeps the parser's tables between runs, as making them takes longer than most texts do.

    They are made anew where they are those of another grammar, or cannot be read or written. None where there is no
    folder that only this user writes to: Lark's file may make Python run anything.
    """
    cache = os.environ.get("XDG_CACHE_HOME", "")
    folder = (Path(cache) if os.path.isabs(cache) else Path(os.path.expanduser("~")) / ".cache") / "pursue"
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        known = folder.stat()
    except OSError:
        return None
    if known.st_uid != os.getuid() or known.st_mode & 0o022:
        return None
    return str(folder / f"grammar_{sys.version_info[0]}.{sys.version_info[1]}")


def tokens_of(text: str) -> Optional[Tuple[Token, ...]]:
    """Every word, sign and comment of a text, in order; None of one that is too large to be a scenario."""
    if len(text) > MOST_LETTERS:
        return None
    # `Lark.lex` would make a lexer for each text, which takes longer than most texts do
    parser: Any = grammar().parse_interactive(text, start="statement")
    found: List[Token] = []
    words = 0
    for token in parser.lexer_thread.lex(None):
        words += token.type not in BLANKS
        if words > MOST_WORDS:
            return None
        found.append(token)
    return tuple(found)


def statements_of(tokens: Iterable[Token]) -> Tuple[Statement, ...]:
    """The statements that tokens make, comments left out."""
    return tuple(Statement(tuple(chunk)) for chunk in chunks_of(significant(tokens)))


def syntax_of(statements: Sequence[Statement], text: str, file: str) -> Syntax:
    """What the statements of a text are."""
    reader = _Reader(file)
    expansion = written_out([statement.tokens for statement in statements], file, MOST_WORDS)
    for number, (tokens, member) in enumerate(expansion.statements):
        reader.take(tokens, member)
        if len(reader.findings) >= MOST_FINDINGS and number + 1 < len(expansion.statements):
            reader.findings.append(too_many(span_of(expansion.statements[number + 1][0][0], file)))
            break
    lines = text.split("\n") if reader.findings else []
    findings = tuple(of_a_comment(finding, lines) for finding in reader.findings)
    of_groups = expansion.findings or tuple(check_groups(expansion, reader.lost, file))
    whole = expansion.whole and not of_groups
    groups = {name: tuple(map(str, members)) for name, members in {"": expansion.robots, **expansion.groups}.items()}
    groups = groups if with_groups(part.tokens for part in statements) else {}
    return Syntax(tuple(reader.trees), (*findings, *of_groups), frozenset(reader.lost), whole, groups)


def too_large(file: str) -> Diagnostic:
    """A text that is no scenario any more."""
    message = f"the text is too large: expected at most {MOST_LETTERS:,} letters, and {MOST_WORDS:,} words and signs"
    return error("PML003", message, Span(file, 1, 1, 1, 2), "is this a scenario? If so, split it into several")


def too_many(span: Optional[Span]) -> Diagnostic:
    """More errors than anybody reads."""
    hint = "is this a scenario? If so, mend the first errors and check again"
    return error("PML018", f"there are more than {MOST_FINDINGS} errors; the rest is not reported", span, hint)


class _Reader:
    """Parses statements one by one; what may come next in a state of the parser is found out once."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.trees: List[Any] = []
        self.findings: List[Diagnostic] = []
        self.lost: Set[str] = set()
        self._after_objective = False
        self._next: Dict[Tuple[Any, ...], FrozenSet[str]] = {}

    def take(self, chunk: Sequence[Token], member: str = "") -> None:
        """Parses one statement; notes its tree, or what is wrong with it. `member`: as in `Span`."""
        finding = self._finding(chunk)
        parts = _bare_objectives(chunk) if finding is not None else []
        if any(prefix for _, prefix in parts):
            for part, prefix in parts:
                if prefix:
                    self.findings.append(bare_objective(part, prefix, span_of(part[0], self.file)).at_member(member))
                else:
                    self.take(part, member)
            return
        if finding is not None:
            self.findings.append(finding if finding.span is None else finding.at_member(member))
            self.lost |= _declared(chunk)
        elif member:
            self.trees[-1].meta.member = member
        self._after_objective = kind_of(chunk) in ("OBJECTIVE", "REACH_OBJECTIVE")

    def _finding(self, chunk: Sequence[Token]) -> Optional[Diagnostic]:
        first = chunk[0]
        if first.type not in (*STATEMENTS, TAIL):
            return unknown_statement(chunk, span_of(first, self.file))
        if first.type == TAIL and not self._after_objective:
            message = "a query of the original's tools (control: …) stands only behind an objective"
            return error("PML017", message, span_of(first, self.file), "delete it")
        return self._parse(chunk)

    def _parse(self, chunk: Sequence[Token]) -> Optional[Diagnostic]:
        parser: Any = grammar().parse_interactive(start="statement")
        depth = 0
        for index, token in enumerate(chunk):
            if token.type in ("LPAR", "RPAR"):
                depth += 1 if token.type == "LPAR" else -1
                if depth > _DEEPEST:
                    message = f"more than {_DEEPEST} brackets within brackets"
                    hint = _SPLIT if chunk[0].type == "RULE" else _SHORTEN
                    return error("PML016", message, span_of(token, self.file), hint)
            try:
                parser.feed_token(token)
            except UnexpectedToken:
                if token.type == "COMMA" and token != ",":
                    return no_list(token, any(one.type in _ATOMS or one.type == "BY" for one in chunk), self.file)
                return explain(chunk, index, self._expected(parser), span_of(token, self.file))
        try:
            tree = parser.feed_eof(chunk[-1])
        except UnexpectedToken:  # on the way it may have left the state of which we have to tell
            return unfinished(chunk, self._expected(_parser_after(chunk)), span_of(chunk[-1], self.file))
        if chunk[0].type == "RULE" and sum(token.type == "WORD" for token in chunk) > _WIDEST:
            message = f"more than {_WIDEST} events in one rule"
            return error("PML016", message, span_of(chunk[1], self.file), _SPLIT)
        if chunk[0].type != "RULE" and sum(token.type in _ATOMS for token in chunk) > _WIDEST:
            message = f"more than {_WIDEST} parts of one condition"
            return error("PML016", message, span_of(chunk[0], self.file), _SHORTEN)
        self.trees.append(tree)
        return None

    def _expected(self, parser: Any) -> FrozenSet[str]:
        state = tuple(parser.parser_state.state_stack)
        if state not in self._next:
            self._next[state] = frozenset(parser.accepts())
        return self._next[state]


def _parser_after(tokens: Iterable[Token]) -> Any:
    """The parser when it has read these words of a statement."""
    parser: Any = grammar().parse_interactive(start="statement")
    for token in tokens:
        parser.feed_token(token)
    return parser


def _bare_objectives(chunk: Sequence[Token]) -> List[Tuple[List[Token], str]]:
    """The statement cut at each line that would be an objective with `objective` or `reach_objective`, and that word;
    "" with the rest."""
    found: List[Tuple[List[Token], str]] = []
    for _, tokens in groupby(chunk, lambda token: token.line):
        line = list(tokens)
        prefix = "" if line[0].type in _PREFIXES else next((word for word in _PREFIXES if _is_read(word, line)), "")
        if not found or prefix or found[-1][1]:
            found.append(([], KEYWORDS.get(prefix, "")))
        found[-1][0].extend(line)
    return found


def _is_read(prefix: str, tokens: Iterable[Token]) -> bool:
    """True if the words are a statement with this word and a colon before them."""
    try:
        return "$END" in _parser_after([Token(prefix, KEYWORDS[prefix]), Token("COLON", ":"), *tokens]).accepts()
    except UnexpectedToken:
        return False


def _declared(chunk: Sequence[Token]) -> Set[str]:
    """The names that a statement with an error in it perhaps declares."""
    kind = kind_of(chunk)
    declares = STATEMENTS[kind].declares if kind in STATEMENTS else "POI"  # one that is not known may declare anything
    if not declares:
        tokens = [token for token in chunk if token.type == "UNCLOSED_COMMENT"]
    elif declares != "POI":  # of a place the name may be several words, without quotes
        tokens = [token for token in chunk if token in chunk[1:3] or token.type == "UNCLOSED_COMMENT"]
    else:
        tokens = list(chunk)
    return {word for token in tokens for word in re.findall(r"\w+", token)}


def accepts(tokens: Sequence[Token]) -> FrozenSet[str]:
    """The kinds of tokens that may follow these of one statement, "$END" among them; none after a wrong one."""
    if not tokens:
        return frozenset(STATEMENTS)
    if tokens[0].type not in (*STATEMENTS, TAIL):
        return frozenset()
    if behind_of(tokens):
        return NAMES
    try:
        return frozenset(_parser_after(without_owners(tokens)).accepts())
    except UnexpectedToken:
        return frozenset()
