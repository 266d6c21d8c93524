"""What a syntax error is called: what stands there, what was expected, and what to do."""

from __future__ import annotations

import re
from dataclasses import replace
from fractions import Fraction
from itertools import takewhile
from typing import FrozenSet, List, Optional, Sequence, Tuple

from lark import Token

from pursue_gen.diagnostics import Diagnostic, Span, error
from pursue_gen.language.kinds import KEYWORDS, MAY_BE_NAMES, STATEMENTS
from pursue_gen.language.names import proposal
from pursue_gen.language.numbers import MOST_DIGITS, at_least, decimal_text, read_number
from pursue_gen.language.similar import closest
from pursue_gen.language.tokens import shown

_SIGNS = {"COLON": "`:`", "COMMA": "`,`", "LPAR": "`(`", "RPAR": "`)`"}
_OTHERS = {"NAME": "a name in quotes", "WORD": "a name", "NUMBER": "a number", "POSE": "a pose comment"}
_COMMENT = "a comment begins with //"
QUOTES = "\u201c\u201d\u201e\u201f\u00ab\u00bb\u2018\u2019\u201a'`\u00b4"
"""Quotation marks that word processors and other languages put in place of straight ones."""
_SHORT_NUMBER = 20
"""Digits: numbers that a message repeats have fewer."""
_SHORT_LINE = 100
"""Letters: what a message repeats of a line is not longer."""
_STARTERS = tuple(KEYWORDS[kind] for kind in STATEMENTS)
_SHORT = frozenset(("any", "at", "no", "not", "robot"))
"""Words of conditions that too many other words resemble."""
_INNER = tuple(word for kind, word in KEYWORDS.items() if kind not in STATEMENTS and word not in _SHORT)
_MEANT = {
    "place": "poi", "room": "poi", "point": "poi", "robot": "agent", "person": "agent", "path": "connect",
    "way": "connect", "road": "connect", "action": "event", "task": "event", "order": "rule", "goal": "reach_objective",
    "dependency": "stateDependency", "at": "location", "in": "location", "takes": "duration", "time": "duration",
    "moves": "mobile", "length": "distance", "can": "can_do", "reacts": "reacts_to",
    "never": "never_with", "is": "is_true", "to": "and", "then": "before", "starts": "location",
}  # fmt: skip
"""Other words that people try, and the word of the language they most likely mean."""
_ESCORT = "escort visitor at rooms within 5 by bot1, where rooms may be a group of all places"
_MEETING = (
    "two meet in a collaborative event, which one can_do and the other reacts_to: reach_objective: do meet within 60, "
    "or objective: if call then meet within 60"
)
_SAID_OTHERWISE = {
    "follow": f"to follow somebody write {_ESCORT}", "follows": f"to follow somebody write {_ESCORT}",
    "meet": _MEETING, "meets": _MEETING,
}  # fmt: skip
"""Words with which people begin an objective that is said in another way, and how."""


def kind_of(chunk: Sequence[Token]) -> str:
    """The token that says which statement it is: the first one, but that of the objective behind `optional 1`;
    "" where there is none."""
    kinds = [token.type for token in chunk[:3]]
    optional = kinds[:2] == ["OPTIONAL", "NUMBER"] and kinds[2:] in (["OBJECTIVE"], ["REACH_OBJECTIVE"])
    return kinds[2] if optional else "".join(kinds[:1])


def looks_like_statement(token: Token) -> bool:
    """Whether a word at the start of a line is one that begins a statement, misspelled."""
    meant = _MEANT.get(str(token).lower()) or closest(str(token), _STARTERS + _INNER)
    return meant in _STARTERS


def unknown_statement(chunk: Sequence[Token], span: Span) -> Diagnostic:
    """A statement that begins with no word that begins one."""
    token = chunk[0]
    unread = _unread(token, span)
    if unread is not None:
        return unread
    if token.type in ("HUMAN", "CONTROLLABLE", "MOBILE", "SPEED", "RADIUS", "TOLERANCE", "INFLATION"):
        hint = f"it belongs to an agent: {STATEMENTS['AGENT'].form()}"
    elif str(token) == "#":
        hint = _COMMENT
    elif token.type in KEYWORDS and _MEANT.get(str(token)) not in _STARTERS:
        hint = f"{token} stands inside a statement; one begins with " + _list(list(_STARTERS))
    else:
        close = _near(str(token), _STARTERS)
        hint = f"did you mean {close}?" if close else "a statement begins with " + _list(list(_STARTERS))
    return error("PML011", f"expected a statement, found {_shown(token)}", span, hint)


def bare_objective(line: Sequence[Token], prefix: str, span: Span) -> Diagnostic:
    """A line that is an objective but for the word in front of it."""
    text = re.sub(r" ([,):])", r"\1", " ".join(line)).replace("( ", "(")
    written = f"write {prefix}: {text}" if len(text) <= _SHORT_LINE else f"write {prefix}: in front of it"
    return error("PML011", f"expected a statement, found {_shown(line[0])}", span, f"this is an objective; {written}")


def explain(chunk: Sequence[Token], index: int, expected: FrozenSet[str], span: Span) -> Diagnostic:
    """The token at `index` of the statement is none of the expected ones."""
    token = chunk[index]
    unread = _unread(token, span)
    if unread is not None:
        return unread
    message = f"expected {_in_words(expected)} after {_shown(chunk[index - 1])}, found {_shown(token)}"
    return error("PML010", message, span, _hint(chunk, index, expected) or _form(chunk[: index + 1]))


def of_a_comment(finding: Diagnostic, lines: Sequence[str]) -> Diagnostic:
    """The finding; with a question about the comment on the line above, where it seems to go on without `//`."""
    span = finding.span
    if finding.code not in ("PML010", "PML011") or span is None or not 2 <= span.line <= len(lines):
        return finding
    begins = not lines[span.line - 1][: span.column - 1].strip()
    if not begins or not lines[span.line - 2].lstrip().startswith("//") or not finding.hint.startswith(_GENERAL):
        return finding
    question = f"did the comment of line {span.line - 1} go on here? start the line with //"
    return replace(finding, hint=f"{question}; if not, {finding.hint}")


def unfinished(chunk: Sequence[Token], expected: FrozenSet[str], span: Span) -> Diagnostic:
    """The statement ends too early; the span is that of its last token."""
    end = Span(span.file, span.end_line, span.end_column, span.end_line, span.end_column + 1)
    message = f"expected {_in_words(expected)} after {_shown(chunk[-1])}, but the statement ends here"
    hint = "put a `)` for each `(`" if "RPAR" in expected else _form(chunk)
    return error("PML010", message, end, hint)


_GENERAL = ("the form is", "a statement begins with")
"""How hints begin that know nothing of what was meant."""


def _unread(token: Token, span: Span) -> Optional[Diagnostic]:
    """What is wrong with a token that is never closed, or cannot be seen (as it comes with text from web pages and word
    processors); None: it is another one."""
    if token.type == "UNCLOSED_NAME":
        return error("PML012", "this name has no closing quote on its line", span, 'write it as "name"')
    if token.type == "UNCLOSED_COMMENT":
        span = Span(span.file, span.line, span.column, span.line, span.column + 2)
        hint = "close it with */, or use // for one line"
        return error("PML013", "this comment is never closed: expected `*/`", span, hint)
    if token.type == "STRAY" and not str(token)[0].isprintable():
        message = f"a sign that cannot be seen stands here: {shown(str(token)[0])}"
        return error("PML015", message, span, "delete it, or put an ordinary blank in its place")
    return None


def _hint(chunk: Sequence[Token], index: int, expected: FrozenSet[str]) -> str:
    """What to do about the most frequent slips; empty where the form of the statement says it best."""
    token, statement = chunk[index], kind_of(chunk)
    text = str(token)
    if token.type == "STRAY":
        return _stray(chunk, index)
    if (token.type == "WORD" or token.type in MAY_BE_NAMES) and "NAME" in expected and token.line == chunk[0].line:
        meant, last = name_meant(chunk, index)
        name = shown(meant)
        if chunk[index - 1].type == "LABEL":
            return f'put the label in quotes: label "{name}"'
        words = [str(word) for word in chunk[index:] if word.end_pos is None or word.end_pos <= (last.end_pos or 0)]
        label = f' label "{shown(" ".join(words))}"' if len(words) > 1 else ""
        return f'put the name in quotes where it is declared: {KEYWORDS[statement]} "{name}"{label}'
    if token.type == "NAME" and "WORD" in expected:
        name = proposal(text.strip('"'))
        return f"quotes stand only where a name is declared: write {shown(name)} without them"
    if statement in ("OBJECTIVE", "REACH_OBJECTIVE"):
        otherwise = _otherwise(chunk, index)
        if otherwise:
            return otherwise
    if statement == "OBJECTIVE" and token.type == "DO":
        return "to have something done write reach_objective: do …"
    if token.type in KEYWORDS and "WORD" in expected and statement != "FOR":
        return f"{text} is a word of the language and cannot be a name; choose another name"
    if token.type == "COMMA" and [one.type for one in chunk[index - 1 : index + 2 : 2]] == ["NUMBER", "NUMBER"]:
        whole, rest = str(chunk[index - 1]), str(chunk[index + 1])
        if len(whole + rest) < _SHORT_NUMBER and (whole + rest).isdigit():
            return _with_comma(whole, rest)
    if token.type == "NUMBER" and "WORD" in expected:
        return "a name begins with a letter"
    if token.type in ("AND", "OR") and expected & {"AND", "OR"} and statement != "RULE":
        return "put brackets around what belongs together: (bot1 at a and bot2 at b) or open is_true"
    if token.type in ("BEFORE", "OR", "AND") and statement == "RULE":
        return "put brackets around what belongs together: (first or second) before third"
    if token.type == "RPAR":
        return "this `)` has no `(`"
    if token.type in ("TRUE_IF", "FALSE_IF") and "COMMA" in expected:
        return "put a comma behind true or false: " + STATEMENTS["STATE"].form()
    if statement == "FOR" and "IN" in expected and "IN" in [one.type for one in chunk[:index]]:
        return _listed(chunk)
    if token.type == "COLON" and "COLON" not in expected:
        return f"delete the colon behind {chunk[index - 1]}; {_form(chunk[: index + 1])}"
    return _meant(chunk, index, expected)


def _otherwise(chunk: Sequence[Token], index: int) -> str:
    """How an objective is written that has been said in another way; "" where nothing is known of it."""
    token, before, kinds = chunk[index], chunk[index - 1], [one.type for one in chunk]
    for word in (token, before):
        if word.type == "WORD" and str(word).lower() in _SAID_OTHERWISE:
            return _SAID_OTHERWISE[str(word).lower()]
    if "PATROL" in kinds and (token.type == "TWICE" or kinds[index : index + 2] == ["NUMBER", "TIMES"]):
        return _oftener(chunk, "2" if token.type == "TWICE" else str(token))
    if "BY" in kinds[:index] and token.type in ("COMMA", "AND") and {"PATROL", "ESCORT"} & {*kinds}:
        return f"put `or` between them: by {before} or {''.join(chunk[index + 1 : index + 2])}"
    if "ESCORT" in kinds and token.type == "WITHIN" and before.type == "WORD":
        return f"name the places: {_ESCORT}"
    return ""


def _listed(chunk: Sequence[Token]) -> str:
    """How a statement is written for each of a list of things."""
    kinds = [one.type for one in chunk]
    first = kinds.index("IN") + 1
    words = takewhile(lambda one: one.type in ("WORD", "COMMA"), chunk[first:])
    named = [str(one) for one in words if one.type == "WORD"]
    return f'write a line before it, group "some": {", ".join(named)}; then: for each {chunk[first - 2]} in some: …'


def _oftener(chunk: Sequence[Token], times: str) -> str:
    """How it is written that somebody comes so many times in a period."""
    found = next((number for word, number in zip(chunk, chunk[1:]) if word.type == "EVERY"), "60")
    period, often = read_number(str(found)), read_number(times)
    if not period or not often:
        period, often = 60, 2
    said = "twice" if often == 2 else f"{decimal_text(often)} times"
    every = at_least(Fraction(period) / often)
    return f"write the time between two visits: {said} in {decimal_text(period)} is every {every}"


def _with_comma(whole: str, rest: str) -> str:
    """What to write in place of two numbers with a comma between them."""
    if len(rest) == MOST_DIGITS:  # it may group thousands
        return f"decimals have a point, and thousands no sign: write {whole}.{rest} or {whole}{rest}"
    return f"write {whole}.{rest}: decimals have a point"


def name_meant(chunk: Sequence[Token], index: int) -> Tuple[str, Token]:
    """A usable name for the words at `index`, where a name in quotes is expected, and the last of these words.

    It is one word; for a POI, whose name ends its statement, it is all words on the line. For a label, which may be any
    text, it is the words themselves.
    """
    words = [chunk[index]]
    if chunk[0].type == "POI":
        plain = {"WORD", *MAY_BE_NAMES} - {"LABEL", "EXCEPT"}
        words += takewhile(lambda word: word.type in plain and word.line == words[0].line, chunk[index + 1 :])
    text = " ".join(words)
    return (text if chunk[index - 1].type == "LABEL" else proposal(text)), words[-1]


def _stray(chunk: Sequence[Token], index: int) -> str:
    """What to do about a sign that the language does not know."""
    text, before = str(chunk[index]), chunk[index - 1]
    if text == "#":
        return _COMMENT
    if text[0] in QUOTES:
        return 'use straight double quotes: "name"'
    if text == "." and before.type == "WORD" and index + 1 < len(chunk):
        return f"a name stands alone, without the agent it belongs to: write {shown(str(chunk[index + 1]))}"
    if text in (";", ".") and index + 1 == len(chunk):
        return f"delete it: nothing stands behind a statement; {_form(chunk[: index + 1])}"
    return ""


def _meant(chunk: Sequence[Token], index: int, expected: FrozenSet[str]) -> str:
    """Which word was meant, or what is missing before it."""
    token, statement = chunk[index], kind_of(chunk)
    if statement in ("EVENT", "AGENT") and f" {token} " in STATEMENTS[statement].form():
        return f"{_too_late(chunk, index)}its parts come in this order: {STATEMENTS[statement].form()}"
    if statement == "EVENT" and chunk[index - 1].type == "IN":
        return "did you mean location? behind in stands a number of parts, as in may_stop in 4 parts"
    meant = _MEANT.get(str(token).lower(), "")
    if any(KEYWORDS.get(kind) == meant for kind in expected):
        return f"did you mean {meant}?"
    if token.type == "WORD":
        opens_line = token.line != chunk[index - 1].line
        close = _near(str(token), tuple(KEYWORDS[kind] for kind in sorted(expected) if kind in KEYWORDS)
                      + (_STARTERS if opens_line and "$END" in expected else ()))  # fmt: skip
        if close:
            return f"did you mean {close}?"
        if chunk[index - 1].type == "NUMBER":
            return f"delete it: a number stands alone, in the unit of your choice; {_form(chunk[: index + 1])}"
        if "COMMA" in expected and chunk[index - 1].line == token.line:
            return "put a comma between two names"
    if statement == "REACH_OBJECTIVE" and token.type in ("IF", "AVOID"):
        return "what must always hold is an objective: if … then … within … or avoid …"
    return ""


def _too_late(chunk: Sequence[Token], index: int) -> str:
    """Before which word of the statement the one at `index` stands; "" where it stands behind all that are there."""
    order = [word.lower() for word in re.findall(r"[a-z_]{2,}|[A-Z_]{2,}", STATEMENTS[kind_of(chunk)].grammar())]
    word, places = str(chunk[index]), {word: place for place, word in reversed(list(enumerate(order)))}
    later = (str(one) for one in chunk[1:index] if places.get(str(one), -1) > places.get(word, len(order)))
    return next((f"write {word} before {other}; " for other in later), "")


def _form(chunk: Sequence[Token]) -> str:
    """How the statement is written of which this is the right beginning."""
    kind = STATEMENTS.get(kind_of(chunk))
    return "delete it" if kind is None else f"the form is: {kind.form_behind(chunk)}"


def _near(word: str, words: Tuple[str, ...]) -> str:
    meant = _MEANT.get(word.lower(), "")
    return meant if meant in words else closest(word, words)


def _in_words(expected: FrozenSet[str]) -> str:
    """The expected tokens as a person names them, in a fixed order, the end of the statement last."""
    kinds = [kind for kind in (*_OTHERS, *_SIGNS, *KEYWORDS) if kind in expected]
    if "COLLABORATIVE" in expected:
        kinds.remove("TOGETHER")  # it says something behind collaborative only
    if "WORD" in expected:
        kinds = [kind for kind in kinds if kind not in MAY_BE_NAMES and kind != "NAME"]
    words = [_OTHERS.get(kind) or _SIGNS.get(kind) or f"`{KEYWORDS[kind]}`" for kind in kinds if kind != "POSE"]
    return _list(words + (["the end of the statement"] if "$END" in expected else []))


def _list(words: List[str]) -> str:
    return words[0] if len(words) == 1 else ", ".join(words[:-1]) + " or " + words[-1]


def _shown(token: Token) -> str:
    text = shown(str(token))
    return {"NAME": f"the name {text}", "WORD": f"`{text}`", "POSE": "the pose"}.get(token.type, f"`{text}`")
