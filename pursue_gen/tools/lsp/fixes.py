"""Quick fixes: what an editor can do at a click about a finding."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, Dict, Tuple

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

_PROPOSERS: Dict[str, _Proposer] = {
    "PML010": syntax.unexpected,
    "PML011": syntax.did_you_mean,
    "PML012": syntax.close_name,
    "PML013": syntax.close_comment,
    "PML014": numbers.time_with_unit,
    "PML015": syntax.visible_blank,
    "PML017": syntax.delete_finding,
    "PML022": meaning.delete_spot,
    "PML101": meaning.fitting_name,
    "PML102": meaning.fitting_name,
    "PML103": meaning.delete_statement,
    "PML110": meaning.unknown_name,
    "PML122": meaning.delete_spot,
    "PML130": meaning.add_agent,
    "PML131": meaning.add_controllable,
    "PML132": meaning.add_poi,
    "PML140": meaning.one_instead_of_zero,
    "PML141": meaning.one_instead_of_zero,
    "PML142": meaning.one_instead_of_zero,
    "PML143": meaning.one_instead_of_zero,
    "PML145": meaning.delete_statement,
    "PML146": meaning.delete_statement,
    "PML147": meaning.connect_island,
    "PML150": meaning.give_event,
    "PML151": meaning.find_partner,
    "PML152": meaning.make_collaborative,
    "PML153": meaning.get_there,
    "PML155": meaning.not_own_partner,
    "PML156": meaning.delete_listed,
    "PML157": meaning.use_event,
    "PML158": meaning.do_together,
    "PML159": meaning.without_together,
    "PML171": meaning.add_objective,
    "PML180": meaning.human_ally,
    "PML190": meaning.sort_statements,
    "PML200": numbers.later_end,
    "PML201": numbers.possible_movement,
    "PML202": meaning.delete_statement,
    "PML204": numbers.fewer_times,
    "PML205": numbers.bind_others,
    "PML220": meaning.delete_statement,
    "PML221": numbers.done_or_avoided,
    "PML222": numbers.to_be_done_once,
    "PML223": numbers.later_deadline,
    "PML232": numbers.without_condition,
    "PML250": meaning.delete_statement,
    "PML251": numbers.possible_number,
    "PML252": meaning.delete_statement,
    "PML253": meaning.delete_statement,
    "PML254": meaning.delete_statement,
    "PML267": meaning.delete_listed,
    "PML320": meaning.delete_listed,
    "PML340": meaning.fewer_things,
    "PML341": meaning.take_or_give,
    "PML342": meaning.one_of_two_things,
    "PML343": meaning.take_or_give,
    "PML344": meaning.fewer_things,
    "PML420": numbers.say_unit,
    "PML422": meaning.delete_statement,
    "PML461": meaning.delete_statement,
    "PML472": meaning.delete_statement,
}


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
