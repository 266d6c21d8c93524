"""Groups, and what is for each member of one: statements written out word by word, before they are parsed.

The words keep their places in the text, so whatever is said of a statement points at what its author wrote.
"""

from __future__ import annotations

import re
from itertools import combinations, product
from typing import (
    Container,
    Dict,
    FrozenSet,
    Iterable,
    Iterator,
    List,
    Mapping,
    NamedTuple,
    Optional,
    Sequence,
    Set,
    Tuple,
)

from lark import Token

from pursue_gen.diagnostics import Diagnostic, Span, error
from pursue_gen.language.kinds import DECLARED, MAY_BE_NAMES
from pursue_gen.language.similar import closest
from pursue_gen.language.tokens import bare, span_of
from pursue_gen.language.usable import fitting, well_formed

Tokens = Tuple[Token, ...]
Written = Tuple[Tokens, str]
"""A statement as it is written out, and the member of which it speaks, as in `Span`; "" for others."""

ROBOTS = "robots"
"""The group of all agents that are controllable and not human, where nothing else is called so."""

_NAMES = frozenset(("WORD", *MAY_BE_NAMES))
_RANGES = re.compile(r"TWO WORD COMMA WORD IN (WORD|NAME)|WORD IN (WORD|NAME)( COMMA WORD IN (WORD|NAME))*")
_EACH = "write for each … in {0}: before the statement, and the variable in place of {0}"


class Expansion(NamedTuple):
    """The statements of a text, those for each member of a group written out; `groups`: name → members. `whole` is
    False where statements are missing."""

    statements: Tuple[Written, ...]
    groups: Mapping[str, Tokens]
    findings: Tuple[Diagnostic, ...] = ()
    whole: bool = True


class _Refused(Exception):
    """What cannot be written out, with the finding about it."""


def body_of(tokens: Sequence[Token]) -> Sequence[Token]:
    """The tokens of a statement without `for each … :`; none where there is nothing behind the colon."""
    if not tokens or tokens[0].type != "FOR":
        return tokens
    return tokens[next((n for n, token in enumerate(tokens) if token.type == "COLON"), len(tokens)) + 1 :]


def variables_of(tokens: Sequence[Token]) -> FrozenSet[str]:
    """The variables of a statement that is for each of a group."""
    head = tokens[: len(tokens) - len(body_of(tokens))]
    pairs = zip(head, head[1:])
    return frozenset(str(token) for before, token in pairs if token.type == "WORD" and before.type != "IN")


def around_of(tokens: Sequence[Token]) -> Iterator[Token]:
    """The words before and behind each `of`."""
    for before, token, behind in zip(tokens, tokens[1:], tokens[2:]):
        if token.type == "OF":
            yield from (before, behind)


def without_owners(tokens: Sequence[Token]) -> List[Token]:
    """The tokens without `of r` behind names."""
    pairs = zip(tokens, tokens[1:])
    of = [False, *(token.type == "OF" and before.type in ("NAME", *_NAMES) for before, token in pairs)]
    return [token for token, is_of, behind in zip(tokens, of, [False, *of]) if not is_of and not behind]


def written_out(statements: Sequence[Tokens], file: str, most: int) -> Expansion:
    """All statements, written out; the same where there is no group and no `for each`. `most`: words and signs."""
    if not any(tokens[0].type in ("GROUP", "FOR") for tokens in statements):
        return Expansion(tuple((tokens, "") for tokens in statements), {})
    return _Groups(statements, file, most).expansion()


def check_groups(expansion: Expansion, lost: Container[str], file: str) -> Iterator[Diagnostic]:
    """What is wrong with the members of groups. Names that are `lost` in statements with errors may be declared
    there."""
    kinds = _declared(tokens for tokens, _ in expansion.statements)
    for members in expansion.groups.values():
        known = [(member, kinds[member][0]) for member in members if member in kinds]
        for member in members:
            if member not in kinds and member not in lost:
                close = closest(str(member), tuple(kinds))
                hint = f"did you mean {close}?" if close else f'declare it, as in poi "{member}", or take it out'
                yield error("PML110", f"nothing is called {member}", span_of(member, file), hint)
        for member, kind in known:
            if kind != known[0][1]:
                message = f"{member} is {_a(kind)}, and {known[0][0]} is {_a(known[0][1])}"
                hint = "the members of a group are of one kind: make two groups of them"
                yield error("PML402", message, span_of(member, file), hint)


class _Groups:
    """The groups of a text, and the statements that come of them."""

    def __init__(self, statements: Sequence[Tokens], file: str, most: int) -> None:
        self._statements, self._file, self._most, self._left = statements, file, most, most
        self._declared = _declared(statements)
        self._groups: Dict[str, Tokens] = {}
        self._lines: Dict[str, Optional[int]] = {}  # of groups
        self._broken: Set[str] = set()
        self._findings: List[Diagnostic] = []

    def expansion(self) -> Expansion:
        """All that comes of the text: groups first, then agents, as robots are a group, then the rest."""
        found: List[List[Written]] = [[(tokens, "")] for tokens in self._statements]
        for step in range(3):
            for number, tokens in enumerate(self._statements):
                if step == _step(tokens):
                    found[number] = self._tried(tokens)
            if step == 1 and not {ROBOTS} & {*self._declared, *self._groups, *self._broken}:
                names = [tokens[1] for some in found for tokens, _ in some if _is_robot(tokens)]
                self._groups[ROBOTS] = tuple(_between("WORD", bare(name), name, name) for name in names)
        statements = tuple(one for some in found for one in some)
        declared = {name: members for name, members in self._groups.items() if name in self._lines}
        return Expansion(statements, declared, tuple(self._findings), not self._broken and not self._findings)

    def _tried(self, tokens: Tokens) -> List[Written]:
        """What comes of a statement; nothing after a complaint. One that is not well formed stays as it is."""
        if self._left < 0 or any(str(token) in self._broken for token in tokens):
            self._broken |= {bare(token) for token in tokens[1:2] if tokens[0].type == "GROUP"}
            return []
        try:
            if tokens[0].type == "GROUP":
                self._add(tokens)
            elif tokens[0].type == "FOR":
                return self._each(tokens)
            else:
                return [(self._filled(tokens, {}), "")]
        except _Refused as refused:
            self._findings.append(refused.args[0])
            return []
        return [(tokens, "")]

    def _add(self, tokens: Tokens) -> None:
        """Notes a group."""
        kinds = [token.type for token in tokens[1:3]]
        name = bare(tokens[1]) if kinds[:1] == ["NAME"] else ""
        self._broken.add(name)
        if kinds != ["NAME", "COLON"]:
            return
        if not well_formed(name):
            hint = f"use letters, digits and _, a letter first, for example {fitting(name)}"
            raise _Refused(error("PML101", f'"{name}" cannot be the name of a group', self._at(tokens[1]), hint))
        if name in self._declared:
            kind, first = self._declared[name]
            message = f"{name} is {_a(kind)} in line {first.line} and a group here: a name stands for one thing"
            raise _Refused(error("PML104", message, self._at(tokens[1]), "choose another name for one of them"))
        if name in self._lines:
            message = f"{name} is declared twice; line {self._lines[name]} declares it already"
            raise _Refused(error("PML103", message, self._at(tokens[1]), "delete one"))
        self._lines[name] = tokens[1].line
        listed = self._filled(tokens[3:], {})
        members, commas = listed[::2], listed[1::2]
        if not members:
            hint = f'name its members: group "{name}": room1, room2'
            raise _Refused(error("PML401", f"nothing is in {name}", self._at(tokens[1]), hint))
        if any(one.type not in _NAMES for one in members) or any(one.type != "COMMA" for one in commas):
            return
        for number, member in enumerate(members):
            if member in members[:number]:
                message = f"{member} is in {name} twice"
                raise _Refused(error("PML403", message, self._at(member), "delete one of the two"))
        self._broken.remove(name)
        self._groups[name] = members

    def _each(self, tokens: Tokens) -> List[Written]:
        """The statements that are for each member of groups."""
        body = tuple(body_of(tokens))
        ranges = _ranges(tokens[2 : len(tokens) - len(body) - 1]) if tokens[1:2] and tokens[1].type == "EACH" else []
        if not body or not ranges:
            self._broken.add("")
            return [(tokens, "")]
        if body[0].type in ("FOR", "GROUP"):
            hint = "write both groups into one: for each a in rooms, b in carts: …"
            raise _Refused(error("PML410", f"`{body[0]}` stands behind a for each", self._at(body[0]), hint))
        self._check_variables([variable for some, _ in ranges for variable in some], body)
        choices = [self._members(group) for _, group in ranges]
        variables = [str(variable) for some, _ in ranges for variable in some]
        two = len(ranges[0][0]) > 1
        if two and len(choices[0]) < 2:
            message = f"{ranges[0][1]} has one member: there is no pair"
            raise _Refused(error("PML407", message, self._at(ranges[0][1]), "add a member, or delete this line"))
        found: List[Written] = []
        for chosen in combinations(choices[0], 2) if two else product(*choices):
            members = dict(zip(variables, chosen))
            note = ", ".join(f"{variable} is {member}" for variable, member in members.items())
            found.append((self._filled(body, members), note))
        return found

    def _check_variables(self, variables: Sequence[Token], body: Tokens) -> None:
        used = {str(token) for token in body if token.type in _NAMES}
        for number, variable in enumerate(variables):
            kind, first = self._declared.get(str(variable), ("", variable))
            line = first.line if kind else self._lines.get(str(variable))
            if line is not None:
                message = f"{variable} is {_a(kind or 'group')} already, of line {line}"
                raise _Refused(error("PML404", message, self._at(variable), "choose another name for the variable"))
            if variable in variables[:number]:
                hint = "choose another name for one of them"
                raise _Refused(error("PML404", f"{variable} stands here twice", self._at(variable), hint))
            if variable not in used:
                message = f"{variable} is not used: the statement is the same for each"
                hint = f'name it, as in event "call" of {variable} location {variable}, or delete the for each'
                raise _Refused(error("PML405", message, self._at(variable), hint))

    def _members(self, group: Token) -> Tokens:
        """The members of a group of which each is meant."""
        members = self._groups.get(str(group))
        if members is None:
            kind, first = self._declared.get(str(group), ("", group))
            close = closest(str(group), tuple(name for name in self._groups if name != ROBOTS))
            hint = f"did you mean {close}?" if close else f'declare it: group "{group}": …'
            message = f"there is no group {group}"
            if kind:
                message = f"{group} is {_a(kind)}, of line {first.line}, and no group"
            raise _Refused(error("PML400", message, self._at(group), hint))
        if not members:
            hint = "there is no agent that is controllable and not human: declare one, or delete this line"
            raise _Refused(error("PML401", f"nothing is in {group}", self._at(group), hint))
        return members

    # Words ------------------------------------------------------------------------------------------------------------

    def _filled(self, tokens: Tokens, members: Mapping[str, Token]) -> Tokens:
        """The words with members in place of variables, and of groups, which stand in lists."""
        found: List[Token] = []
        index = 0
        while index < len(tokens):
            kinds = [token.type for token in tokens[index : index + 4]]
            if kinds[:2] in (["ANY", "OF"], ["ALL", "OF"]):
                index = self._quantified(tokens, index, members, found)
            elif kinds[0] == "NUMBER" and kinds[1:2] in (["ROBOTS"], ["AGENTS"]):
                found += tokens[index : index + 2]  # so many of them, whoever they are
                index += 2
            elif kinds[0] in ("NAME", *_NAMES):
                names, index = self._names_at(tokens, index, members)
                found += _listed(names, str(tokens[index - 1]))
            else:
                found.append(tokens[index])
                index += 1
        if found:
            self._spend(len(found), found[0])
        return tuple(found)

    def _names_at(self, tokens: Tokens, index: int, members: Mapping[str, Token]) -> Tuple[Tokens, int]:
        """What the name at an index stands for, with what it is of; and the index behind that."""
        token = tokens[index]
        found = self._meant(token, members) or (token,)
        index += 1
        while index + 1 < len(tokens) and tokens[index].type == "OF" and tokens[index + 1].type in _NAMES:
            owner = tokens[index + 1]
            owners = self._meant(owner, members)
            if not owners:
                message = f"{owner} is no group, and no variable of a for each"
                hint = f"write {_owned(token, owner)}, or a group or a variable behind of"
                raise _Refused(error("PML406", message, self._at(owner), hint))
            if token.type == "NAME" and len(owners) > 1:
                message = f"{owner} is a group, and a statement declares one thing"
                raise _Refused(error("PML409", message, self._at(owner), _EACH.format(owner)))
            self._spend(len(found) * len(owners), token)
            found = tuple(_owned(one, owned) for one in found for owned in owners)
            index += 2
        return found, index

    def _meant(self, token: Token, members: Mapping[str, Token]) -> Tokens:
        """The member that a variable stands for, or the members of a group, at its place; (): it is neither."""
        if token.type not in _NAMES:
            return ()
        name = str(token)
        meant = (members[name],) if name in members else self._members(token) if name in self._groups else ()
        self._spend(len(meant), token)
        return tuple(_between("WORD", str(one), token, token) for one in meant)

    def _quantified(self, tokens: Tokens, index: int, members: Mapping[str, Token], found: List[Token]) -> int:
        """Writes `any of carts at door` as `(cart1 at door or cart2 at door)`; the index behind it."""
        first = tokens[index]
        if index + 2 == len(tokens) or tokens[index + 2].type not in _NAMES:
            found.append(first)
            return index + 1
        names, index = self._names_at(tokens, index + 2, members)
        rest = tokens[index : index + 1]
        if rest and rest[0].type in ("AT", "DOING") and index + 1 < len(tokens):
            things, index = self._names_at(tokens, index + 1, members)
            rest += _listed(things, str(tokens[index - 1]))
        elif rest and rest[0].type in ("ON_WAY", "IS_TRUE", "IS_FALSE"):
            index += 1
        else:
            hint = "write what holds of them, as in any of carts at door"
            raise _Refused(error("PML411", f"`{first} of` stands in conditions only", self._at(first), hint))
        self._spend(len(names) * (len(rest) + 2), first)
        word = _between(*(("OR", "or") if first.type == "ANY" else ("AND", "and")), first, first)
        found.append(_between("LPAR", "(", first, first))
        for number, name in enumerate(names):
            found += [*([word] if number else []), name, *rest]
        found.append(_between("RPAR", ")", first, first))
        return index

    def _spend(self, words: int, token: Token) -> None:
        self._left -= words
        if self._left < 0:
            message = f"written out, the text has more than {self._most:,} words and signs"
            hint = "make the groups smaller, or split the scenario into several"
            raise _Refused(error("PML408", message, self._at(token), hint))

    def _at(self, token: Token) -> Span:
        return span_of(token, self._file)


def _step(tokens: Tokens) -> int:
    """When a statement is written out: groups first, then what may make robots, then the rest."""
    makes_agents = [token.type for token in body_of(tokens)[:1]] == ["AGENT"]
    return {"GROUP": 0, "FOR": 2 - makes_agents}.get(tokens[0].type, 2)


def _ranges(head: Tokens) -> List[Tuple[Tokens, Token]]:
    """The variables and the group of each part of `r in rooms, b in carts`; [] where that is not well formed."""
    kinds = " ".join("NAME" if token.type in _NAMES - {"TWO", "WORD"} else token.type for token in head)
    if not _RANGES.fullmatch(kinds):
        return []
    if head[0].type == "TWO":
        return [((head[1], head[3]), head[5])]
    return [((head[n],), head[n + 2]) for n in range(0, len(head), 4)]


def _declared(statements: Iterable[Tokens]) -> Dict[str, Tuple[str, Token]]:
    """What is declared: name → its kind, and where."""
    found: Dict[str, Tuple[str, Token]] = {}
    for tokens in statements:
        kind = DECLARED.get(tokens[0].type, "")
        if kind and len(tokens) > 1 and tokens[1].type == "NAME":
            found.setdefault(bare(tokens[1]), (kind, tokens[1]))
    return found


def _is_robot(tokens: Tokens) -> bool:
    kinds = [token.type for token in tokens]
    return kinds[:2] == ["AGENT", "NAME"] and "CONTROLLABLE" in kinds and "HUMAN" not in kinds


def _between(kind: str, text: str, first: Token, last: Token) -> Token:
    """A token in the place of those from one to another."""
    return Token(kind, text, first.start_pos, first.line, first.column, last.end_line, last.end_column, last.end_pos)


def _owned(name: Token, owner: Token) -> Token:
    """The name of what belongs to a member."""
    text = f'"{bare(name)}_{owner}"' if name.type == "NAME" else f"{name}_{owner}"
    return _between(name.type if name.type == "NAME" else "WORD", text, name, owner)


def no_list(comma: Token, file: str) -> Diagnostic:
    """What is wrong where a comma may not stand that a group's members brought."""
    message = f"{comma} is a group, and one thing is needed here"
    return error("PML409", message, span_of(comma, file), _EACH.format(comma))


def _listed(names: Tokens, group: str) -> Tokens:
    """The names with commas between them, which say for which group they stand."""
    commas = (_between("COMMA", group, name, name) for name in names)
    return tuple(token for pair in zip(commas, names) for token in pair)[1:]


def _a(kind: str) -> str:
    return f"{'an' if kind[0] in 'ae' else 'a'} {kind}"
