"""What may be written at a place of a text: words, names that fit there, whole statements to fill in."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Dict, FrozenSet, Iterator, List, Optional, Tuple

from lark import Token

from pursue_gen.language.draft import Draft
from pursue_gen.language.for_each import Range, body_of, ranges_of
from pursue_gen.language.kinds import DECLARED, KEYWORDS, MAY_BE_NAMES, MEANINGS, STATEMENTS
from pursue_gen.language.occurrences import GROUP, MEMBERS, SUBJECTS, VARIABLE, are_names, condition_start, kinds_behind
from pursue_gen.language.poses import robots_in
from pursue_gen.language.syntax import accepts, statements_of, tokens_of
from pursue_gen.language.template import FILLINGS, Template
from pursue_gen.language.times import has_unit
from pursue_gen.language.tokens import bare, start_of
from pursue_gen.language.word import HOLE

_SIGNS = {"COLON": ":", "COMMA": ",", "LPAR": "(", "RPAR": ")"}
_POSE = "//[0, 0, 0, 0, 0, 0, 1]"
_WORD_BEFORE = re.compile(r"[\w-]*\Z")
_BEHIND_POSE = re.compile(r"\][ \t]*,?[ \t]*(\w*)\Z")
_WORD_AFTER = re.compile(r"\w*")
_SPECIAL = re.compile(r"[$},|\\]")
_UNITS_OF_TIME = {"s": "seconds", "min": "minutes", "h": "hours"}
_UNITS_OF_LENGTH = {"m": "metres", "cm": "centimetres"}
_MOST_CHOICES = 50
_DECLARING = {GROUP: STATEMENTS["GROUP"], **{kind.declares: kind for kind in STATEMENTS.values() if kind.declares}}


def _words_before(*fillings: str) -> FrozenSet[str]:
    """The words behind which one of these stands."""
    return frozenset(
        hole.behind.upper()
        for statement in STATEMENTS.values()
        for kind in getattr(statement, "kinds", {"": statement}).values()
        for hole in getattr(kind, "template", Template("")).holes
        if hole.filling in [FILLINGS[filling] for filling in fillings]
    )


_TIMED = _words_before("time", "window") | {"TO"}
_LONG = _words_before("distance")
_IN_METRES = _words_before("metres")
_EXAMPLES = {thing: kind.form().split('"')[1] for thing, kind in _DECLARING.items()}


@dataclass(frozen=True)
class Completion:
    """Something that may be written for text[start:end].

    `token`: the kind of token that it begins with; `kind`: "name" (with `of` saying a name of what), "word", "sign",
    "value" or "statement"; `insert`: in the form of editors' snippets where `snippet`.
    """

    label: str
    insert: str
    token: str
    kind: str
    start: int
    end: int
    detail: str = ""
    about: str = ""
    of: str = ""
    snippet: bool = False


def complete(document: Draft, offset: int) -> Tuple[Completion, ...]:
    """What may be written at an offset; the likeliest first."""
    if document.in_comment(offset):
        return tuple(_robots(document, offset))
    place = _place(document, offset)
    if place.quoted is not None:
        return tuple(_missing(document, place, place.quoted))
    expected = accepts(place.behind)
    grouped = bool(document.syntax.groups)
    items = [*_names(document, place, expected), *_words(place, expected, grouped)]
    items += _units(place, with_times=document.scenario.unit is not None)
    if not place.behind or "$END" in expected or place.opens_line:
        items += _statements(document, place)
    return tuple(items)


@dataclass(frozen=True)
class _Place:
    """Where something is to be written: behind which tokens of its statement, in place of which stretch of text.

    `opens_line`: nothing stands before it in its line; `quoted`: the statement that declares the name which is begun
    here, if its opening quote stands already; `same_line`: it is on the line of the token before.
    """

    behind: Tuple[Token, ...]
    start: int
    end: int
    opens_line: bool
    same_line: bool
    quoted: Optional[str] = None


def _place(document: Draft, offset: int) -> _Place:
    text = document.text
    before = [part.start for part in document.statements if part.start < offset]
    begin = before[-2] if len(before) > 1 else 0  # the cutter has to see one statement that is complete
    word = _WORD_BEFORE.search(text, begin, offset)
    start = word.start() if word else offset
    after = _WORD_AFTER.match(text, offset)
    end = after.end() if after and start < offset else offset
    tokens = tokens_of(text[begin:offset]) or ()
    quoted = None
    if tokens and tokens[-1].type == "UNCLOSED_NAME":
        start, tokens = begin + start_of(tokens[-1]) + 1, tokens[:-1]
        closing = text.find('"', offset, document.lines.end_at(offset))
        end = closing if closing >= 0 else offset
        quoted = ""
    else:
        tokens = tuple(token for token in tokens if begin + start_of(token) < start)
    parts = statements_of(tokens)
    behind = parts[-1].tokens if parts else ()
    if quoted is not None and len(behind) == 1:
        quoted = behind[0].type
    line = document.lines.start_at(start)
    same_line = bool(behind) and "\n" not in text[begin + start_of(behind[-1]) : start]
    return _Place(behind, start, end, not text[line:start].strip(), same_line, quoted)


def _missing(document: Draft, place: _Place, opens: str) -> Iterator[Completion]:
    """Names that are used as what this statement declares, but are declared nowhere."""
    kind = DECLARED.get(opens, "")
    known = document.declared.get(kind, {})
    closed = document.text[place.end : place.end + 1] == '"'
    for name in sorted({o.name for o in document.occurrences if o.kind == kind and o.name not in known}):
        insert = name if closed else name + '"'
        yield Completion(name, insert, "NAME", "name", place.start, place.end, f"{kind}, declared nowhere", of=kind)


def _names(document: Draft, place: _Place, expected: FrozenSet[str]) -> Iterator[Completion]:
    """Declared names that fit here."""
    kinds = kinds_behind(place.behind) if "WORD" in expected else ()
    in_condition = condition_start(place.behind) is not None
    yield from _of_groups(document, place, kinds)
    for kind in kinds:
        if kind in document.declared and kind != GROUP:
            yield from _names_of(document, place, kind, repeated=in_condition)


def _of_groups(document: Draft, place: _Place, kinds: Tuple[str, ...]) -> Iterator[Completion]:
    """Variables of the statement, and groups, whose members fit here, and what is of them; groups where a list may
    stand."""
    lists = GROUP in kinds or (kinds and "COMMA" in accepts((*place.behind, Token("WORD", "x"))))
    owners = [(str(variable), _group_of(one)) for one in ranges_of(place.behind) for variable in one.variables]
    groups = [(name, name) for name in document.declared[GROUP]] if lists else []
    some = [(VARIABLE, *one) for one in owners if {VARIABLE, _kind_of(document, one[1])} & {*kinds}]
    some += [(GROUP, *one) for one in groups if {GROUP, _kind_of(document, one[1])} & {*kinds}]
    for part in document.statements:
        name = next(iter(part.body.tokens[1:2]), None)
        if part.kind == "FOR" and name is not None and DECLARED.get(part.body.kind) in kinds:
            own, kind = {_group_of(one) for one in ranges_of(part.tokens)}, DECLARED[part.body.kind]
            some += [(kind, f"{bare(name)} of {one}", group) for one, group in owners + groups if group in own]
    for kind, text, group in dict.fromkeys(some):
        about = ", ".join(document.syntax.groups.get(group, ()))
        yield Completion(text, text, "WORD", "name", place.start, place.end, kind, about, of=kind)


def _group_of(chosen: Range) -> str:
    return "" if chosen.robots else str(chosen.group)


def _kind_of(document: Draft, group: str) -> str:
    """What the members of a group are."""
    members = document.syntax.groups.get(group, ())
    return next((kind for kind in MEMBERS if members and members[0] in document.declared[kind]), "")


def _names_of(document: Draft, place: _Place, kind: str, repeated: bool) -> Iterator[Completion]:
    """Declared names of a kind; without `repeated` only those that the statement does not use yet."""
    used = {str(token) for token, is_name in zip(place.behind, are_names(place.behind)) if is_name}
    known = document.declared[kind]
    fitting = [name for name in known if repeated or name not in used]
    last = next((token.type for token in reversed(place.behind) if token.type in KEYWORDS), "")
    if kind == "event" and place.behind[0].type == "AGENT" and last == "REACTS_TO":
        together = [name for name in fitting if document.statements[known[name].statement].first("COLLABORATIVE")]
        fitting = together or fitting
    for name in fitting:
        part = document.statements[known[name].statement]
        about = " ".join(document.text[part.start : part.end].split())[:200]
        token = next((kind for kind, word in MAY_BE_NAMES.items() if word == name), "WORD")
        yield Completion(name, name, token, "name", place.start, place.end, kind, about, of=kind)


def _robots(document: Draft, offset: int) -> Iterator[Completion]:
    """The robots that may get a pose behind the others in the comment of a place."""
    for part in document.statements:
        for token in part.tokens:
            start = start_of(token)
            if token.type == "POSE" and start < offset <= start + len(token):
                before = _BEHIND_POSE.search(document.text, start, offset)
                after = _WORD_AFTER.match(document.text, offset)
                if before is None or after is None:
                    return
                pose = str(token).partition("[")[2].partition("]")[0]
                used = [name for name, *_ in robots_in(str(token))]
                for agent in document.scenario.agents:
                    if agent.is_robot and agent.name not in used:
                        insert, span = f"{agent.name} [{pose}]", (before.start(1), after.end())
                        yield Completion(agent.name, insert, "WORD", "name", *span, "its pose here", of="agent")


def _words(place: _Place, expected: FrozenSet[str], grouped: bool) -> Iterator[Completion]:
    """Words and signs of the language, and values, that may come next within the statement. `grouped`: the text has
    groups, or speaks of them."""
    if not place.behind:
        return
    span = (place.start, place.end)
    names_hide = set(MAY_BE_NAMES) if "WORD" in expected else set()
    kinds, last, ends = kinds_behind(place.behind), place.behind[-1].type, [one.type for one in place.behind[-2:]]
    in_rule = grouped and [token.type for token in body_of(place.behind)[:1]] == ["RULE"]
    in_condition = grouped and condition_start(place.behind) is not None
    if set(SUBJECTS) <= set(kinds) and last not in ("COMMA", "OF"):
        names_hide -= {"ANY", "NO", "AT_MOST", *(("ALL", "NONE") if grouped else ())}
    elif in_rule and kinds == ("event",):
        names_hide -= {"ANY", "ALL"}
    elif in_condition and last in ("AT", "DOING"):
        names_hide.discard("ANY")
    elif GROUP in kinds or ends == ["NUMBER", "OF"] or (kinds == ("agent",) and last in ("FOR", "EXCEPT")):
        names_hide.discard("ROBOTS")
    elif place.behind[0].type == "FOR" and not body_of(place.behind):
        names_hide = set()
    if ends == ["OBJECTIVE", "COLON"]:
        names_hide -= {"ALWAYS", "AT_LEAST", "ESCORT", "PATROL", "PLACE", "WAY"}
    if ends == ["ASSUME", "COLON"]:
        names_hide.discard("AT_MOST")
    if last == "BY":
        names_hide.discard("ANY")
    by_any = grouped and ends == ["BY", "ANY"]
    if by_any or ((in_rule or in_condition) and last in ("ANY", "ALL", "NONE")):
        yield Completion("of", "of", "OF", "word", *span, about=MEANINGS["OF"])
    for token, word in KEYWORDS.items():
        if token == "TOGETHER" and "COLLABORATIVE" in expected:
            continue  # it says something behind collaborative only
        # an agent may be called human: then its name is offered
        if token in expected and token not in names_hide:
            yield Completion(word, word, token, "word", *span, about=MEANINGS[token])
    if "NUMBER" in expected:
        yield Completion("1", "${1:1}", "NUMBER", "value", *span, "a number", snippet=True)
    if "NAME" in expected and last == "LABEL":
        yield Completion('"…"', '"${1:what people read}"', "NAME", "value", *span, "what people read", snippet=True)
    elif "NAME" in expected and place.behind[0].type in DECLARED:
        example = _EXAMPLES[DECLARED[place.behind[0].type]]
        yield Completion(f'"{example}"', f'"${{1:{example}}}"', "NAME", "value", *span, "a new name", snippet=True)
    if "POSE" in expected and place.same_line:
        about = "x, y, z in metres on the robot's map, then the orientation as a unit quaternion qx, qy, qz, qw"
        yield Completion(_POSE, _POSE, "POSE", "value", *span, "a pose", about)
    for token, sign in _SIGNS.items():
        if token in expected:
            yield Completion(sign, sign, token, "sign", *span)


def _units(place: _Place, with_times: bool) -> Iterator[Completion]:
    """What may stand behind the number of a time or a length. `with_times`: the scenario has a `unit`."""
    *_, word, number = (None, None, *place.behind)
    if word is None or number is None or number.type != "NUMBER" or has_unit(number):
        return
    long = word.type in _IN_METRES or (with_times and word.type in _LONG)
    timed = _UNITS_OF_TIME if with_times and word.type in _TIMED else {}
    for unit, about in (_UNITS_OF_LENGTH if long else timed).items():
        yield Completion(unit, unit, "NUMBER", "value", place.start, place.end, about)


def _statements(document: Draft, place: _Place) -> List[Completion]:
    """Whole statements, with choices of names where names belong."""
    items = []
    for token, statement in STATEMENTS.items():
        for form in statement.forms:
            label = f"{KEYWORDS[token]} … {form.title}"
            insert = fill_in(form.words, {kind: list(names) for kind, names in document.declared.items()})
            span = (place.start, place.end)
            about = f"{MEANINGS[token]}\n\n    {fill_in(form.words, {}, plain=True)}"
            items.append(Completion(label, insert, token, "statement", *span, form.title, about, snippet=True))
    return items


def fill_in(words: str, names: Dict[str, List[str]], plain: bool = False) -> str:
    """A form as an editor's snippet, with choices of names; `plain`: as text, with examples in its holes."""
    number = 0

    def hole(match: re.Match[str]) -> str:
        nonlocal number
        number += 1
        given, what = match.groups()
        example = what if given else _EXAMPLES[what]
        if plain:
            return example
        choices = [] if given else names.get(what, [])[:_MOST_CHOICES]
        if not choices:
            return f"${{{number}:{example}}}"
        # where a name belongs twice, the second hole begins with another name than the first
        turn = words[: match.start()].count(match.group()) % len(choices)
        turned = choices[turn:] + choices[:turn]
        return f"${{{number}|" + ",".join(_SPECIAL.sub(r"\\\g<0>", name) for name in turned) + "|}"

    return HOLE.sub(hole, words)
