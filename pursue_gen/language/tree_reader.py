"""Names, numbers and conditions from the trees of statements, and what is wrong with them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, List, Mapping, Optional, Tuple

from lark import Token

from pursue_gen.diagnostics import Diagnostic, Span
from pursue_gen.language.conditions import AllOf, AnyOf, At, Condition, Doing, EventOrCondition, Holds, Not, OnWay, Who
from pursue_gen.language.number_messages import no_count, no_number
from pursue_gen.language.numbers import Number, is_fine, read_number
from pursue_gen.language.refs import Ref
from pursue_gen.language.tokens import bare, span_of

MOST = 1_000_000
"""The largest distance, duration, inverse speed or deadline: what comes of it must fit a machine's integers."""


class TreeReader:
    """Reads pieces of statements; `findings`: what is wrong with those that were read. `member`: as in `Span`, of the
    statement that is read."""

    def __init__(self, file: str, labels: Mapping[str, str]) -> None:
        """`labels`: of the names that have one."""
        self.file = file
        self._labels = labels
        self.member = ""
        self.findings: List[Diagnostic] = []

    def at(self, token: Token) -> Span:
        """Where a token stands."""
        return span_of(token, self.file, self.member)

    def span(self, tree: Any) -> Span:
        """Where a tree stands."""
        meta = tree.meta
        return Span(self.file, meta.line, meta.column, meta.end_line, meta.end_column, self.member)

    def ref(self, tree: Any) -> Ref:
        """A name."""
        token = tree.children[0]
        return self._use(str(token), token)

    def refs(self, tree: Any) -> Tuple[Ref, ...]:
        """A list of names; none where there is no list."""
        return tuple(self.ref(child) for child in tree.children) if tree is not None else ()

    def agent_ref(self, agent: Any) -> Ref:
        """An agent's name, with quotes or without."""
        if not isinstance(agent, Token):
            return self.ref(agent)
        ref = self._use(bare(agent), agent)
        within = replace(ref.span, column=ref.span.column + 1, end_column=ref.span.end_column - 1)
        return replace(ref, span=within)

    def _use(self, name: str, token: Token) -> Ref:
        return Ref(name, self.at(token), self._labels.get(name, ""))

    def number(self, token: Token) -> Number:
        """The token's value; 1 after a complaint."""
        value = read_number(token)
        if value is not None and value <= MOST and is_fine(value):
            return value
        self.findings.append(no_number(token, value, MOST, self.at(token)))
        return 1

    def count(self, token: Token) -> int:
        """The token's value, which says how often, or a rank; 1 after a complaint."""
        value = read_number(token)
        if isinstance(value, int) and value <= MOST:
            return value
        self.findings.append(no_count(token, value, MOST, self.at(token)))
        return 1

    def window(self, tree: Any) -> Tuple[Number, Optional[Number]]:
        """The numbers of `5 to 8`; one alone has no second one."""
        low, _, high = tree.children
        return self.number(low), None if high is None else self.number(high)

    def condition(self, tree: Any) -> Condition:
        """A condition."""
        kind, children = tree.data, tree.children
        if kind == "negation":
            return Not(self.condition(children[0]))
        if kind in ("all_of", "any_of"):
            return (AllOf if kind == "all_of" else AnyOf)(tuple(map(self.condition, children)))
        if kind == "holds":
            return Holds(self.ref(children[0]), children[1].type == "IS_TRUE")
        first = children[0].children[0]
        named = not isinstance(first, Token)
        who = Who(self.ref(first)) if named else Who(None, robots=len(children[0].children) > 1)
        condition: Condition = OnWay(who)
        if kind != "on_way":
            condition = (At if kind == "at" else Doing)(who, self.ref(children[1]))
        return condition if named or first.type != "NO" else Not(condition)

    def event_or_condition(self, tree: Any) -> EventOrCondition:
        """The event that is named, or the condition."""
        return self.ref(tree) if tree.data == "ref" else self.condition(tree)
