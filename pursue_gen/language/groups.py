"""Groups, and what is for each member of one: statements written out word by word, before they are parsed.

The words keep their places in the text, so whatever is said of a statement points at what its author wrote.
"""

from __future__ import annotations

from itertools import combinations, product
from typing import Container, Dict, Iterable, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Set, Tuple

from lark import Token

from pursue_gen.diagnostics import Diagnostic, Span, an, error
from pursue_gen.language.for_each import NAMES, Range, body_of, ranges_of, with_groups
from pursue_gen.language.kinds import DECLARED, MAY_BE_NAMES, STATEMENTS
from pursue_gen.language.members import ROBOTS, Refused, Tokens, Words, between
from pursue_gen.language.names import fitting, well_formed
from pursue_gen.language.similar import closest
from pursue_gen.language.tokens import bare, span_of

Written = Tuple[Tokens, str]
"""A statement as it is written out, and the member of which it speaks, as in `Span`; "" for others."""


class Expansion(NamedTuple):
    """The statements of a text, those for each member of a group written out; `groups`: name → members; `robots`: those
    of `each robot`. `whole` is False where statements are missing."""

    statements: Tuple[Written, ...]
    groups: Mapping[str, Tokens]
    robots: Tokens = ()
    findings: Tuple[Diagnostic, ...] = ()
    whole: bool = True


def written_out(statements: Sequence[Tokens], file: str, most: int) -> Expansion:
    """All statements, written out; the same where nothing of groups is in them. `most`: words and signs."""
    if not with_groups(statements):
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
                message = f"{member} is {an(kind)}, and {known[0][0]} is {an(known[0][1])}"
                hint = "the members of a group are of one kind: make two groups of them"
                yield error("PML402", message, span_of(member, file), hint)


class _Groups:
    """The groups of a text, and the statements that come of them."""

    def __init__(self, statements: Sequence[Tokens], file: str, most: int) -> None:
        self._statements, self._file, self._declared = statements, file, _declared(statements)
        self._groups: Dict[str, Tokens] = {}
        self._words = Words(self._groups, file, most)
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
            if step == 1:
                names = [tokens[1] for some in found for tokens, _ in some if _is_robot(tokens)]
                self._groups[""] = tuple(between("WORD", bare(name), name, name) for name in names)
                if not {ROBOTS} & {*self._declared, *self._groups, *self._broken}:
                    self._groups[ROBOTS] = self._groups[""]
        statements = tuple(one for some in found for one in some)
        declared = {name: members for name, members in self._groups.items() if name in self._lines}
        whole = not self._broken and not self._findings
        return Expansion(statements, declared, self._groups[""], tuple(self._findings), whole)

    def _tried(self, tokens: Tokens) -> List[Written]:
        """What comes of a statement; nothing after a complaint. One that is not well formed stays as it is."""
        if self._words.spent or any(str(token) in self._broken for token in tokens):
            self._broken |= {bare(token) for token in tokens[1:2] if tokens[0].type == "GROUP"}
            return []
        try:
            if tokens[0].type == "GROUP":
                return [(self._add(tokens), "")]
            if tokens[0].type == "FOR":
                return self._each(tokens)
            if tokens[0].type in STATEMENTS:
                return [(self._words.filled(tokens, {}), "")]
        except Refused as refused:
            self._findings.append(refused.args[0])
            return []
        return [(tokens, "")]

    def _add(self, tokens: Tokens) -> Tokens:
        """Notes a group; the statement with its members in place of what is `of` groups."""
        kinds = [token.type for token in tokens[1:3]]
        name = bare(tokens[1]) if kinds[:1] == ["NAME"] else ""
        self._broken.add(name)
        if kinds != ["NAME", "COLON"]:
            return tokens
        if not well_formed(name):
            hint = f"use letters, digits and _, a letter first, for example {fitting(name)}"
            raise Refused(error("PML101", f'"{name}" cannot be the name of a group', self._at(tokens[1]), hint))
        if name in MAY_BE_NAMES.values() and name not in (ROBOTS, "robot"):  # which are told apart where they stand
            message = f"{name} is a word of the language and cannot be the name of a group"
            hint = f"choose another name: else each {name} of a sentence would be taken for the group"
            raise Refused(error("PML102", message, self._at(tokens[1]), hint))
        if name in self._declared:
            kind, first = self._declared[name]
            message = f"{name} is {an(kind)} in line {first.line} and a group here: a name stands for one thing"
            raise Refused(error("PML104", message, self._at(tokens[1]), "choose another name for one of them"))
        if name in self._lines:
            message = f"{name} is declared twice; line {self._lines[name]} declares it already"
            raise Refused(error("PML103", message, self._at(tokens[1]), "delete one"))
        self._lines[name] = tokens[1].line
        listed = self._words.filled(tokens[3:], {})
        members, commas = listed[::2], listed[1::2]
        if not members:
            hint = f'name its members: group "{name}": room1, room2'
            raise Refused(error("PML401", f"nothing is in {name}", self._at(tokens[1]), hint))
        if any(one.type not in NAMES for one in members) or any(one.type != "COMMA" for one in commas):
            return tokens
        seen: Set[Token] = set()
        for member in members:
            if member in seen:
                message = f"{member} is in {name} twice"
                raise Refused(error("PML403", message, self._at(member), "delete one of the two"))
            seen.add(member)
        self._broken.remove(name)
        self._groups[name] = members
        return (*tokens[:3], *listed)

    def _each(self, tokens: Tokens) -> List[Written]:
        """The statements that are for each member of groups."""
        body, ranges = tuple(body_of(tokens)), ranges_of(tokens)
        if not body or not ranges:
            self._broken.add("")
            return [(tokens, "")]
        if body[0].type in ("FOR", "GROUP"):
            hint = "write both groups into one: for each a in rooms, b in carts: …"
            raise Refused(error("PML410", f"`{body[0]}` stands behind a for each", self._at(body[0]), hint))
        variables = [variable for one in ranges for variable in one.variables]
        self._check_variables(variables, body)
        choices = [self._members(one, body) for one in ranges]
        (*_, two), group, _ = ranges[0]
        if two is not variables[0] and len(choices[0]) < 2:
            message = f"{group} has one member: there is no pair"
            raise Refused(error("PML407", message, self._at(group), "add a member, or delete this line"))
        found: List[Written] = []
        for chosen in product(*choices) if two is variables[0] else combinations(choices[0], 2):
            members = dict(zip(map(str, variables), chosen))
            note = ", ".join(f"{variable} is {member}" for variable, member in members.items())
            found.append((self._words.filled(body, members), note))
        return found

    def _check_variables(self, variables: Sequence[Token], body: Tokens) -> None:
        used = {str(token) for token in body if token.type in NAMES}
        for number, variable in enumerate(variables):
            kind, first = self._declared.get(str(variable), ("", variable))
            line = first.line if kind else self._lines.get(str(variable))
            if line is not None:
                message = f"{variable} is {an(kind or 'group')} already, of line {line}"
                raise Refused(error("PML404", message, self._at(variable), "choose another name for the variable"))
            if variable in variables[:number]:
                hint = "choose another name for one of them"
                raise Refused(error("PML404", f"{variable} stands here twice", self._at(variable), hint))
            if variable not in used:
                message = f"{variable} is not used: the statement is the same for each"
                hint = f'name it, as in event "call" of {variable} location {variable}, or delete the for each'
                raise Refused(error("PML405", message, self._at(variable), hint))

    def _members(self, chosen: Range, body: Tokens) -> Tokens:
        """The members of a group, for each of which a statement is."""
        group, name = chosen.group, "" if chosen.robots else str(chosen.group)
        if name in self._groups:
            return self._words.members(name, group)
        kind, first = self._declared.get(name, ("", group))
        if name in ("", ROBOTS) and not kind:
            hint = 'name those that are meant: group "carts": cart1, cart2, and for each c in carts: …'
            raise Refused(error("PML414", "what declares agents cannot be for each robot", self._at(group), hint))
        close = closest(name, tuple(self._lines))
        hint = f"did you mean {close}?" if close else f'declare it: group "{group}": …'
        message = f"{group} is {an(kind)}, of line {first.line}, and no group" if kind else f"there is no group {group}"
        raise Refused(error("PML400", message, self._at(group), hint))

    def _at(self, token: Token) -> Span:
        return span_of(token, self._file)


def _step(tokens: Tokens) -> int:
    """When a statement is written out: groups first, then what may make robots, then the rest."""
    makes_agents = [token.type for token in body_of(tokens)[:1]] == ["AGENT"]
    return {"GROUP": 0, "FOR": 2 - makes_agents}.get(tokens[0].type, 2)


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
