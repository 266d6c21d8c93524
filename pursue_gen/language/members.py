"""The words of a statement with members of groups in place of variables and groups; `any of`, `all of` and `none of`.

The words keep their places in the text.
"""

from __future__ import annotations

from typing import Dict, List, Mapping, Sequence, Tuple

from lark import Token

from pursue_gen.diagnostics import Diagnostic, Span, error
from pursue_gen.language.for_each import NAMES
from pursue_gen.language.tokens import bare, span_of

Tokens = Tuple[Token, ...]

ROBOTS = "robots"
"""The group of all agents that are controllable and not human, where nothing else is called so."""

_EACH = "write for each … in {0}: before the statement, and the variable in place of {0}"
_QUANTIFIERS: Mapping[str, str] = {"ANY": "or", "ALL": "and", "NONE": "and"}
"""Words before `of`, and what stands between the conditions on members."""

_SO_MANY = [["ROBOTS"], ["AGENTS"]]
_BEFORE_CONDITIONS = [[kind] for kind in "COLON COMMA LPAR AND OR NOT IF THEN AVOID ALWAYS ONLY_IF".split()]
"""Behind them a part of a condition may begin; behind a comma, that a group brought, none may, which is said later."""


class Refused(Exception):
    """What cannot be written out, with the finding about it."""


class Words:
    """Writes statements out. `groups`: name → members, which may grow, and "" → those of `each robot`; `most`: words
    and signs of all statements."""

    def __init__(self, groups: Dict[str, Tokens], file: str, most: int) -> None:
        self._groups, self._file, self._most, self._left = groups, file, most, most

    @property
    def spent(self) -> bool:
        """True where the text is too large by now."""
        return self._left < 0

    def filled(self, tokens: Tokens, members: Mapping[str, Token]) -> Tokens:
        """The words with members in place of variables, and of groups, which stand in lists. Raises Refused."""
        found: List[Token] = []
        index = 0
        while index < len(tokens):
            kind = tokens[index].type
            if kind == "ANY" and tokens[index - 1].type in ("BY", "LOCATION") and _quantifies(tokens, index):
                names, index = self._names_at(tokens, index + 2, members)
                found += _listed(names, "or", "OR")  # one of them
            elif _quantifies(tokens, index):
                index = self._quantified(tokens, index, members, found)
            elif kind in ("AT", "DOING", "HAS") and _quantifies(tokens, index + 1):
                index = self._at_any(tokens, index, members, found)
            elif kind == "NO" and [token.type for token in tokens[index + 1 : index + 2]] == ["OF"]:
                message = "expected `robot` or `agent` after `no`, found `of`"
                raise Refused(error("PML010", message, self._at(tokens[index + 1]), "write none of"))
            elif kind == "NUMBER" and [token.type for token in tokens[index + 1 : index + 2]] in _SO_MANY:
                found += tokens[index : index + 2]  # so many of them, whoever they are
                index += 2
            elif kind in ("NAME", *NAMES):
                names, index = self._names_at(tokens, index, members)
                found += _listed(names, str(tokens[index - 1]))
            else:
                found.append(tokens[index])
                index += 1
        if found:
            self._spend(len(found), found[0])
        return tuple(found)

    # Names ------------------------------------------------------------------------------------------------------------

    def _names_at(self, tokens: Tokens, index: int, members: Mapping[str, Token]) -> Tuple[Tokens, int]:
        """What the name at an index stands for, with what it is of; and the index behind that."""
        token = tokens[index]
        found = self._meant(token, members) or (token,)
        index += 1
        while index + 1 < len(tokens) and tokens[index].type == "OF" and tokens[index + 1].type in NAMES:
            owner = tokens[index + 1]
            owners = self._meant(owner, members) or self._member(owner)
            if not owners:
                message = f"{owner} is no group, in none, and no variable of a for each"
                hint = f"write {_owned(token, owner)}, or a group or a variable behind of"
                raise Refused(error("PML406", message, self._at(owner), hint))
            if token.type == "NAME" and len(owners) > 1:
                message = f"{owner} is a group, and a statement declares one thing"
                raise Refused(error("PML409", message, self._at(owner), _EACH.format(owner)))
            self._spend(len(found) * len(owners), token)
            found = tuple(_owned(one, owned) for one in found for owned in owners)
            index += 2
        return found, index

    def _meant(self, token: Token, members: Mapping[str, Token]) -> Tokens:
        """The member that a variable stands for, or the members of a group, at its place; (): it is neither."""
        if token.type not in NAMES:
            return ()
        name = str(token)
        meant = (members[name],) if name in members else self.members(name, token) if name in self._groups else ()
        self._spend(len(meant), token)
        return tuple(between("WORD", str(one), token, token) for one in meant)

    def _member(self, token: Token) -> Tokens:
        """A member of some group, which is called by its own name; (): it is none."""
        return (token,) if any(token == one for group in self._groups.values() for one in group) else ()

    def members(self, name: str, group: Token) -> Tokens:
        """The members of a group that there is, named by a word. Raises Refused where nothing is in it."""
        members = self._groups[name]
        if not members:
            hint = "there is no agent that is controllable and not human: declare one, or delete this line"
            raise Refused(error("PML401", f"nothing is in {name or ROBOTS}", self._at(group), hint))
        return members

    # Conditions -------------------------------------------------------------------------------------------------------

    def _quantified(self, tokens: Tokens, index: int, members: Mapping[str, Token], found: List[Token]) -> int:
        """Writes `any of carts at door` as `(cart1 at door or cart2 at door)`, and in a rule `any of trays` as
        `(tray1 or tray2)`; the index behind it."""
        first = tokens[index]
        names, index = self._names_at(tokens, index + 2, members)
        held, index = self._held(tokens, index, members)
        if tokens[0].type == "RULE" and first.type != "NONE" and not held:
            held = [()]
        if not held:
            raise Refused(self._no_condition(first))
        self._spend(len(names) * sum(len(part) + 3 for part in held), first)
        negated = (between("NOT", "not", first, first),) if first.type == "NONE" else ()
        found += _joined([(*negated, *_each_held((name,), held)) for name in names], _QUANTIFIERS[first.type])
        return index

    def _at_any(self, tokens: Tokens, index: int, members: Mapping[str, Token], found: List[Token]) -> int:
        """Writes `guest at any of rooms`, of which `guest` is found, as `(guest at room1 or guest at room2)`; the index
        behind it. Behind `at_most 1 of carts` it is written `at room1, room2`."""
        held, end = self._held(tokens, index, members)
        if _are_counted(found) and tokens[index].type == "AT":
            names, end = self._names_at(tokens, index + 3, members)
            found += [tokens[index], *_listed(names, str(tokens[end - 1]))]
            return end
        whom = [token.type for token in found[-2:]]
        length = 2 if whom[:1] in (["ANY"], ["NO"]) and whom[1:] in (["ROBOT"], ["AGENT"]) else 1
        subject = tuple(found[-length:])
        if [token.type for token in found[-length - 1 : -length]] not in _BEFORE_CONDITIONS:
            raise Refused(self._no_condition(tokens[index + 1]))
        self._spend(len(held) * (length + 3), tokens[index])
        found[-length:] = _each_held(subject, held)
        return end

    def _held(self, tokens: Tokens, index: int, members: Mapping[str, Token]) -> Tuple[List[Tokens], int]:
        """What holds, from the verb at an index on: `at door`, or each of `at any of rooms`; [] where no verb of a
        condition stands there. And the index behind it."""
        verb = tokens[index : index + 1]
        if [token.type for token in tokens[index : index + 2]] == ["ON_WAY", "FROM"] or (
            verb and verb[0].type == "BETWEEN"
        ):
            return self._on_one_way(tokens, index, members)
        if verb and verb[0].type in ("ON_WAY", "IS_TRUE", "IS_FALSE"):
            return [verb], index + 1
        if not verb or verb[0].type not in ("AT", "DOING", "HAS") or index + 1 == len(tokens):
            return [], index
        if not _quantifies(tokens, index + 1):
            names, end = self._names_at(tokens, index + 1, members)
            return [(*verb, *_listed(names, str(tokens[end - 1])))], end
        quantifier = tokens[index + 1]
        if quantifier.type != "ANY":
            message = f"`{quantifier} of` stands behind `{verb[0]}`, where only `any of` does"
            hint = f"write {verb[0]} any of, and not or none of before it if nobody may be"
            raise Refused(error("PML413", message, self._at(quantifier), hint))
        names, end = self._names_at(tokens, index + 3, members)
        return [(*verb, name) for name in names], end

    def _on_one_way(self, tokens: Tokens, index: int, members: Mapping[str, Token]) -> Tuple[List[Tokens], int]:
        """`between hall and r`, or `on_way from hall to r`; and the index behind it."""
        held: Tokens = ()
        for words in (1, 1) if tokens[index].type == "BETWEEN" else (2, 1):
            held, index = (*held, *tokens[index : index + words]), index + words
            if index < len(tokens):
                names, index = self._names_at(tokens, index, members)
                held += _listed(names, str(tokens[index - 1]))
        return [held], index

    def _no_condition(self, quantifier: Token) -> Diagnostic:
        hint = "write what holds of them, as in any of carts at door; elsewhere, for each … before the statement"
        where = "conditions only" if quantifier.type == "NONE" else "conditions and rules only"
        return error("PML411", f"`{quantifier} of` stands in {where}", self._at(quantifier), hint)

    # Limits and places ------------------------------------------------------------------------------------------------

    def _spend(self, words: int, token: Token) -> None:
        self._left -= words
        if self._left < 0:
            message = f"written out, the text has more than {self._most:,} words and signs"
            hint = "make the groups smaller, or split the scenario into several"
            raise Refused(error("PML408", message, self._at(token), hint))

    def _at(self, token: Token) -> Span:
        return span_of(token, self._file)


def between(kind: str, text: str, first: Token, last: Token) -> Token:
    """A token in the place of those from one to another."""
    return Token(kind, text, first.start_pos, first.line, first.column, last.end_line, last.end_column, last.end_pos)


def no_list(comma: Token, of_condition: bool, file: str) -> Diagnostic:
    """What is wrong where a comma may not stand that a group's members brought."""
    message = f"{comma} is a group, and one thing is needed here"
    hint = _EACH.format(comma)
    return error("PML409", message, span_of(comma, file), f"write any of {comma}; or {hint}" if of_condition else hint)


def _quantifies(tokens: Tokens, index: int) -> bool:
    """True where `any of carts` stands, or so."""
    kinds = [token.type for token in tokens[index : index + 3]]
    return kinds[:1] != [] and kinds[0] in _QUANTIFIERS and kinds[1:2] == ["OF"] and kinds[-1] in NAMES - {"OF"}


def _are_counted(found: Sequence[Token]) -> bool:
    """True behind `at_most 2 robots` and `at_most 2 of cart1, cart2`."""
    kinds = [token.type for token in found]
    while kinds[-2:-1] == ["COMMA"]:
        kinds = kinds[:-2]
    return kinds[-3:-1] == ["NUMBER", "OF"] or kinds[-2:-1] == ["NUMBER"]


def _each_held(subject: Tokens, held: Sequence[Tokens]) -> Tokens:
    """That one of several things holds of a subject; of `no robot`, that none of them does."""
    parts = [(*subject, *one) for one in held]
    return parts[0] if len(parts) == 1 else _joined(parts, "and" if subject[:-1] and subject[0].type == "NO" else "or")


def _joined(parts: Sequence[Tokens], word: str) -> Tokens:
    """Parts of a condition with a word between them, in brackets."""
    first = parts[0][0]
    words = (between(word.upper(), word, first, first), between("LPAR", "(", first, first))
    listed = [token for number, part in enumerate(parts) for token in (words[not number], *part)]
    return (*listed, between("RPAR", ")", first, first))


def _owned(name: Token, owner: Token) -> Token:
    """The name of what belongs to a member."""
    text = f'"{bare(name)}_{owner}"' if name.type == "NAME" else f"{name}_{owner}"
    return between(name.type if name.type == "NAME" else "WORD", text, name, owner)


def _listed(names: Tokens, group: str, kind: str = "COMMA") -> Tokens:
    """The names with commas between them, which say for which group they stand; or with other words."""
    commas = (between(kind, group, name, name) for name in names)
    return tuple(token for pair in zip(commas, names) for token in pair)[1:]
