"""Quick fixes: what an editor can do at a click about a finding."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, Mapping, Tuple

from pursue_gen.diagnostics import Diagnostic
from pursue_gen.language.document import Edit
from pursue_gen.language.draft import Draft
from pursue_gen.language.syntax import Statement
from pursue_gen.language.tokens import start_of
from pursue_gen.tools.lsp import fixes_meaning as meaning
from pursue_gen.tools.lsp import fixes_numbers as numbers
from pursue_gen.tools.lsp import fixes_syntax as syntax
from pursue_gen.tools.lsp.fixes_syntax import Proposals

_Proposer = Callable[[Draft, Diagnostic, Statement, int], Proposals]

_CODES: Mapping[_Proposer, str] = {
    syntax.unexpected: "PML010",
    syntax.did_you_mean: "PML011",
    syntax.close_name: "PML012",
    syntax.close_comment: "PML013",
    numbers.time_with_unit: "PML014",
    syntax.visible_blank: "PML015",
    syntax.delete_finding: "PML017",
    meaning.delete_spot: "PML022 PML122",
    meaning.fitting_name: "PML101 PML102",
    meaning.delete_statement: "PML103 PML145 PML146 PML202 PML220 PML250 PML252 PML253 PML254 PML422 PML461 PML472",
    meaning.unknown_name: "PML110",
    meaning.add_agent: "PML130",
    meaning.add_controllable: "PML131",
    meaning.add_poi: "PML132",
    meaning.one_instead_of_zero: "PML140 PML141 PML142 PML143",
    meaning.connect_island: "PML147",
    meaning.give_event: "PML150",
    meaning.find_partner: "PML151",
    meaning.make_collaborative: "PML152",
    meaning.get_there: "PML153",
    meaning.not_own_partner: "PML155",
    meaning.delete_listed: "PML156 PML267 PML320",
    meaning.use_event: "PML157",
    meaning.do_together: "PML158",
    meaning.without_together: "PML159",
    meaning.add_objective: "PML171",
    meaning.human_ally: "PML180",
    meaning.sort_statements: "PML190",
    numbers.later_end: "PML200",
    numbers.possible_movement: "PML201",
    numbers.fewer_times: "PML204",
    numbers.bind_others: "PML205",
    numbers.done_or_avoided: "PML221",
    numbers.to_be_done_once: "PML222",
    numbers.later_deadline: "PML223",
    numbers.without_condition: "PML232",
    numbers.possible_number: "PML251",
    meaning.fewer_things: "PML340 PML344",
    meaning.take_or_give: "PML341 PML343",
    meaning.one_of_two_things: "PML342",
    numbers.say_unit: "PML420",
}
"""What is proposed, and for which findings."""

_PROPOSERS = {code: propose for propose, codes in _CODES.items() for code in codes.split()}


@dataclass(frozen=True)
class Fix:
    """A quick fix for a finding: its title, and the edits; `preferred`: the one that an editor may do unasked."""

    title: str
    finding: Diagnostic
    edits: Tuple[Edit, ...]
    preferred: bool


def fixes(document: Draft, start: int, end: int) -> Tuple[Fix, ...]:
    """The quick fixes for the findings whose statements touch text[start:end], in the order of the findings."""
    found = []
    for finding in document.findings:
        proposer = _PROPOSERS.get(finding.code)
        if proposer is None or finding.span is None:
            continue
        first, last = document.lines.of_span(finding.span)
        part = document.statement_at(first)
        if max(last, part.end if part else 0) < start or min(first, part.start if part else first) > end:
            continue
        if part is not None and _of_groups(part, first, last):
            continue
        proposals = proposer(document, finding, part or Statement(()), first)
        for number, (title, edits) in enumerate(proposals):
            if edits:
                found.append(Fix(title, finding, edits, number == 0))
    return tuple(found)


def _of_groups(part: Statement, start: int, end: int) -> bool:
    """True where other statements than the one that stands there were read: a change would be one of all of them."""
    made = any(token.type == "OF" and start <= start_of(token) < end for token in part.tokens)
    return made or part.kind in ("FOR", "GROUP")
