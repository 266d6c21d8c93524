"""From a PuRSUE-ML text to a Scenario."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, FrozenSet, Iterable, Iterator, List, Mapping, Optional, Tuple, Union, cast

from lark import Token, Tree

from pursue_gen.diagnostics import Diagnostic, PursueError, Severity, Span, error, in_order
from pursue_gen.language import scenario as pml
from pursue_gen.language.assumptions import KINDS, NAMES
from pursue_gen.language.condition_trees import condition_of
from pursue_gen.language.conditions import Condition, Who
from pursue_gen.language.document import Document
from pursue_gen.language.number_messages import no_count, no_number
from pursue_gen.language.numbers import Number, is_fine, read_number
from pursue_gen.language.poses import PoseComment, read_poses
from pursue_gen.language.syntax import MOST_LETTERS, bare, span_of, too_large
from pursue_gen.outcomes import Invalid
from pursue_runtime.named_files import read_start

MOST = 1_000_000
"""The largest distance, duration, inverse speed or deadline: what comes of it must fit a machine's integers."""

MOST_BYTES = MOST_LETTERS * 4  # bytes of a letter
"""The most bytes of a scenario."""

_PATIENCE = 5
"""Seconds in which something has to come where the file is a pipe."""


@dataclass(frozen=True)
class Reading:
    """A text as far as it could be read: the scenario (None after a syntax error) and what was found on the way.

    `partial` is the scenario that the sound statements make, with errors or without; `lost` are the names that the
    others may have declared.
    """

    scenario: Optional[pml.Scenario]
    diagnostics: Tuple[Diagnostic, ...]
    partial: pml.Scenario
    lost: FrozenSet[str] = frozenset()


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
    builder = _Builder(file, dict(_labels(syntax.trees)))
    parts = [part for tree in syntax.trees for part in builder.parts(tree)]
    findings = (*syntax.findings, *builder.findings)

    def only(*kinds: type) -> Tuple[Any, ...]:
        return tuple(part for part in parts if isinstance(part, kinds))

    value = pml.Scenario(
        name=Path(file).stem if name is None else name,
        file=file,
        text=document.text,
        pois=only(pml.Poi),
        connections=only(pml.Connection),
        events=only(pml.Event),
        rules=only(pml.Rule),
        states=only(pml.State),
        dependencies=only(pml.Dependency),
        agents=only(pml.Agent),
        safety=only(pml.Safety),
        reach=only(pml.Reach),
        travels=only(pml.Travel),
        assumptions=only(pml.Assumption),
        batteries=only(pml.Battery),
    )
    broken = any(finding.severity is Severity.ERROR for finding in syntax.findings)
    return Reading(None if broken else value, in_order(findings), value, syntax.lost if broken else frozenset())


def without_errors(scenario: Optional[pml.Scenario], findings: Tuple[Diagnostic, ...]) -> pml.Scenario:
    """The scenario. Raises PursueError with the errors among the findings, if there are any."""
    errors = [finding for finding in findings if finding.severity is Severity.ERROR]
    if errors or scenario is None:
        raise Invalid(errors)
    return scenario


class _Builder:
    """Makes the scenario's parts from the trees of statements, and notes what is wrong with their numbers and poses."""

    def __init__(self, file: str, labels: Mapping[str, str]) -> None:
        """`labels`: of the names that have one."""
        self.file = file
        self._labels = labels
        self.findings: List[Diagnostic] = []

    def parts(self, tree: Any) -> Tuple[Any, ...]:
        """The parts that a statement declares: a patrol of several places is several objectives."""
        part = self.part(tree)
        return part if isinstance(part, tuple) else () if part is None else (part,)

    def part(self, tree: Any) -> Any:
        """The part that a statement declares; None for the tail that the original's tools leave."""
        if isinstance(tree, Token):
            return None
        return getattr(self, "_" + tree.data)(*tree.children, span=self._span(tree))

    def _span(self, tree: Any) -> Span:
        meta = tree.meta
        return Span(self.file, meta.line, meta.column, meta.end_line, meta.end_column)

    def _ref(self, tree: Any) -> pml.Ref:
        token = tree.children[0]
        return self._use(str(token), token)

    def _use(self, name: str, token: Token) -> pml.Ref:
        return pml.Ref(name, span_of(token, self.file), self._labels.get(name, ""))

    def _refs(self, tree: Any) -> Tuple[pml.Ref, ...]:
        return tuple(self._ref(child) for child in tree.children) if tree is not None else ()

    def _number(self, token: Token) -> Number:
        """The token's value; 1 after a complaint."""
        value = read_number(token)
        if value is not None and value <= MOST and is_fine(value):
            return value
        self.findings.append(no_number(token, value, MOST, span_of(token, self.file)))
        return 1

    def _count(self, token: Token) -> int:
        """The token's value, which says how often, or a rank; 1 after a complaint."""
        value = read_number(token)
        if isinstance(value, int) and value <= MOST:
            return value
        self.findings.append(no_count(token, value, MOST, span_of(token, self.file)))
        return 1

    def _poi(self, name: Token, _: Any, label: Optional[Token], pose: Optional[Token], span: Span) -> pml.Poi:
        found = PoseComment(None) if pose is None else read_poses(str(pose), span_of(pose, self.file))
        self.findings += found.findings
        return pml.Poi(bare(name), found.pose, span_of(name, self.file), found.spots, _bare_or_none(label))

    def _connection(self, a: Any, b: Any, distance: Token, one_way: Any, only_if: Any, span: Span) -> pml.Connection:
        first, second = self._ref(a), self._ref(b)
        ends, condition = (first.span, second.span), self._condition(only_if)
        length = self._number(distance)
        return pml.Connection(first.name, second.name, length, span, ends, one_way is not None, condition)

    def _event(
        self, name: Token, _label: Any, label: Any, collaborative: Any, together: Any, location: Any, duration: Any,
        _: Any, most: Any, _times: Any, only_if: Any, span: Span,
    ) -> pml.Event:
        earliest, latest = (None, None) if duration is None else self._window(duration)
        return pml.Event(
            bare(name),
            collaborative is not None,
            None if location is None else self._ref(location),
            earliest,
            span_of(name, self.file),
            together is not None,
            latest,
            None if most is None else self._count(most),
            self._condition(only_if),
            _bare_or_none(label),
        )

    def _condition(self, tree: Any) -> Optional[Condition]:
        return None if tree is None else condition_of(tree, self._ref)

    def _event_or(self, tree: Any) -> Union[pml.Ref, Condition]:
        """The event that is named, or the condition."""
        return self._ref(tree) if tree.data == "ref" else condition_of(tree, self._ref)

    def _window(self, tree: Any) -> Tuple[Number, Optional[Number]]:
        """The numbers of `5 to 8`; one alone has no second one."""
        low, _, high = tree.children
        return self._number(low), None if high is None else self._number(high)

    def _travel(self, _: Any, agent: Any, a: Any, _to: Any, b: Any, _takes: Any, takes: Any, span: Span) -> pml.Travel:
        return pml.Travel(self._agent_ref(agent), self._ref(a), self._ref(b), *self._window(takes), span)

    def _agent_ref(self, agent: Any) -> pml.Ref:
        """An agent's name, with quotes or without."""
        if not isinstance(agent, Token):
            return self._ref(agent)
        ref = self._use(bare(agent), agent)
        within = replace(ref.span, column=ref.span.column + 1, end_column=ref.span.end_column - 1)
        return replace(ref, span=within)

    def _battery(
        self, _: Any, agent: Any, capacity: Token, uses: Token, recharges: Optional[Token], dock: Any, span: Span
    ) -> pml.Battery:
        return pml.Battery(
            self._agent_ref(agent),
            self._count(capacity),
            self._number(uses),
            0 if recharges is None else self._number(recharges),
            None if dock is None else self._ref(dock),
            span,
        )

    def _rule(self, name: Token, each: Any, body: Any, span: Span) -> pml.Rule:
        who = "" if each is None else str(each.data)[len("each_") :]
        return pml.Rule(bare(name), self._body(body), span_of(name, self.file), who)

    def _body(self, tree: Any) -> pml.RuleBody:
        if tree.data == "ref":
            return self._ref(tree)
        first, second = (self._body(child) for child in tree.children)
        if tree.data == "both":
            return pml.Both(first, second, self._span(tree))
        kind = pml.Sequence if tree.data == "sequence" else pml.Choice
        return kind(first, second, self._span(tree))

    def _state(self, name: Token, initially: Token, sets: Any, span: Span) -> pml.State:
        true_if = false_if = None
        if sets is not None and sets.data == "sets":
            true_if, false_if = sets.children
        elif sets is not None:
            (false_if,) = sets.children
        place = span_of(name, self.file)
        return pml.State(bare(name), initially.type == "TRUE", self._refs(true_if), self._refs(false_if), place)

    def _dependency(self, event: Any, state: Any, value: Token, span: Span) -> pml.Dependency:
        return pml.Dependency(self._ref(event), self._ref(state), value.type == "IS_TRUE", span)

    def _assumption(self, tree: Any, span: Span) -> pml.Assumption:
        kind: Any = KINDS[tree.data]
        fields = zip((field for _, field in kind.fields()), tree.children)
        return cast(pml.Assumption, kind(**{field: self._field(field, child) for field, child in fields}, span=span))

    def _field(self, name: str, tree: Any) -> Any:
        """The value of a field of an assumption."""
        if name == "condition":
            return condition_of(tree, self._ref)
        return self._ref(tree) if name in NAMES else self._count(tree) if name == "times" else self._number(tree)

    def _agent(
        self, name: Token, _: Any, label: Any, human: Any, controllable: Any, mobile: Any, radius: Any, tolerance: Any,
        inflation: Any, location: Any, can: Any, reacts: Any, span: Span,
    ) -> pml.Agent:
        mobile, radius, tolerance, inflation = (
            None if number is None else self._number(number) for number in (mobile, radius, tolerance, inflation)
        )
        return pml.Agent(
            name=bare(name),
            human=human is not None,
            controllable=controllable is not None,
            mobile=mobile,
            location=self._ref(location),
            can_do=self._refs(can),
            reacts_to=self._refs(reacts),
            span=span_of(name, self.file),
            label=_bare_or_none(label),
            radius=radius,
            tolerance=tolerance,
            inflation=inflation,
        )

    def _optional(self, _: Any, number: Token, tree: Any, span: Span) -> Tuple[pml.StatedObjective, ...]:
        rank = self._count(number)
        if not rank:
            hint = "1 is kept longest, then 2, and so on; without optional it has to be met in any case"
            message = "the number behind optional is 0; expected 1 or more"
            self.findings.append(error("PML300", message, span_of(number, self.file), hint))
        return tuple(replace(part, optional=rank or 1, span=span) for part in self.parts(tree))

    def _safety(self, objective: Any, span: Span) -> Union[pml.Safety, Tuple[pml.Patrol, ...]]:
        children = objective.children
        if objective.data == "patrol":
            return self._patrol(children, span)
        if objective.data == "respond":
            trigger, response, deadline = children
            return pml.Respond(self._event_or(trigger), self._event_or(response), self._number(deadline), span)
        if objective.data == "avoid" and children[0].data == "ref":
            return pml.Avoid(self._ref(children[0]), span)
        if objective.data in ("avoid", "always"):
            return pml.Always(condition_of(children[0], self._ref), objective.data == "always", span)
        place = None if children[2] is None else self._ref(children[2])
        return pml.NeverWith(self._ref(children[0]), self._ref(children[1]), span, place)

    def _patrol(self, children: List[Any], span: Span) -> Tuple[pml.Patrol, ...]:
        refs, in_order, _, every, by = children
        places, first = self._refs(refs), by.children[0]
        time = None if every is None else self._number(every)
        agent = None if isinstance(first, Token) else self._ref(first)
        order = () if in_order is None else tuple(place.name for place in places)
        return tuple(pml.Patrol(place, time, Who(agent, agent is None), span, order) for place in places)

    def _reach(self, events: Any, after: Optional[Token], within: Optional[Token], span: Span) -> pml.Reach:
        return pml.Reach(
            self._refs(events),
            0 if after is None else self._number(after),
            span,
            None if within is None else self._number(within),
        )


def _labels(trees: Iterable[Tree[Token]]) -> Iterator[Tuple[str, str]]:
    """Names with their labels, where they have one; the first declaration counts."""
    for tree in reversed(list(trees)):
        if isinstance(tree, Tree) and tree.data in ("poi", "event", "agent"):
            name, _, label, *_ = tree.children
            if isinstance(name, Token) and isinstance(label, Token):
                yield bare(name), bare(label)


def _bare_or_none(label: Optional[Token]) -> Optional[str]:
    return None if label is None else bare(label)
