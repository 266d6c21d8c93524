"""What was found out, in words: can the objective be met, how fast, how late may commands come; or why it cannot."""

from __future__ import annotations

from dataclasses import dataclass
from typing import List, Optional, Sequence

from pursue_gen.diagnostics import Diagnostic, listed, units
from pursue_gen.drawing.look import safe
from pursue_gen.explanation.costs import Costs, in_words
from pursue_gen.explanation.explain import Explanation, attempt_texts, endless_texts, how_found, play_title
from pursue_gen.language.numbers import decimal_text, time_text
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.sentences import objective_words, promise_words, speed_words
from pursue_gen.partition import unneeded, unneeded_words
from pursue_gen.solving.answers import answers
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import Solution
from pursue_gen.tools.report.html import Section, table


@dataclass(frozen=True)
class Lost:
    """A scenario that is not won: the solver's findings, and their explanation, None where it is not decided; then
    `costs` are what makes it so large.
    """

    findings: Sequence[Diagnostic]
    explanation: Optional[Explanation]
    costs: Optional[Costs] = None


def section(
    scenario: Scenario, rules: Rules, won: Optional[Solution], margin: str = "", lost: Optional[Lost] = None
) -> Section:
    """The verdict on the page; either `won` or `lost` is there."""
    wanted = "".join(f"<li>{safe(sentence)}</li>" for sentence in objective_words(scenario))
    parts = [f"<p>What is wanted:</p><ul>{wanted}</ul>"]
    if won is not None:
        parts += [f"<p>{safe(sentence)}.</p>" for sentence in promise_words(scenario)]
    if scenario.assumptions:
        assumed = "".join(f"<li>{safe(each.clause)}</li>" for each in scenario.assumptions)
        parts.append(f"<p>What is assumed of others:</p><ul>{assumed}</ul>")
    if won is not None:
        parts += _won(won, margin)
        kept = "".join(f"<li>{safe(answer.in_words())}</li>" for answer in answers(scenario, won))
        parts += [f"<ul>{kept}</ul>"] if kept else []
        words = unneeded_words(unneeded(scenario, won.strategy))
        parts += [f"<p>{safe(words)}</p>"] if words else []
    elif lost is not None:
        parts += _lost(lost, any(not agent.controllable for agent in scenario.agents))
    parts.append(f"<p class='quiet'>{safe(_game(rules))}</p>")
    parts.append(_agents(scenario))
    return Section("verdict", "The verdict", "\n".join(parts))


def _won(won: Solution, margin: str) -> List[str]:
    kept = "" if won.within is None else f" within {decimal_text(won.within)} time units"
    parts = [
        f"<p class='verdict'><strong>It can be met{kept}, whatever the others do.</strong> The strategy that does it "
        "was proven by a second, independent program.</p>"
    ]
    if won.guarantee:
        parts.append(f"<p>{safe(won.guarantee.in_words())}</p>")
    if margin:
        parts.append(f"<p>{safe(margin)}</p>")
    return parts


def _lost(lost: Lost, others: bool) -> List[str]:
    """The verdict; `others`: there are agents whom nobody controls."""
    if lost.explanation is None:
        parts = ["<p class='verdict no'><strong>It was not decided whether it can be met.</strong></p>"]
    else:
        why = ": the others can always prevent it" if others else ""
        parts = [f"<p class='verdict no'><strong>It cannot be met{why}.</strong></p>"]
    for finding in lost.findings:
        sentences = [text for text in (finding.message, finding.hint) if text]
        parts.append("<p>" + " ".join(f"{safe(text[:1].upper() + text[1:])}." for text in sentences) + "</p>")
    if lost.costs is not None:
        parts += [f"<p>{safe(line)}</p>" for line in in_words(lost.costs).splitlines()]
    if lost.explanation is None:
        return parts
    several = (lost.explanation, *lost.explanation.others)
    for one in several:
        parts += [f"<h3>{safe(listed(one.about))}</h3>"] if len(several) > 1 else []
        parts += _explained(one)
    return parts


def _explained(explanation: Explanation) -> List[str]:
    texts = [*endless_texts(explanation), *([explanation.conflict.in_words()] if explanation.conflict else [])]
    parts = [f"<p>{safe(text)}</p>" for text in texts]
    parts.append("<h3>What would change that</h3>")
    if explanation.changes:
        items = []
        for change in explanation.changes:
            notes = [f"line {change.span.line}"] if change.span else []
            if change.next_lost != change.before:
                notes.insert(0, f"{change.next_lost} is not enough")
            note = f" ({'; '.join(notes)})" if notes else ""
            items.append(f"<li>{safe(change.sentence + note)}</li>")
        parts.append(f"<p>Each of these alone, the smallest change first ({how_found(explanation)}):</p>")
        parts.append(f"<ul>{''.join(items)}</ul>")
    else:
        parts.append("<p>No single small change that was tried would change that.</p>")
    for title, entries in (("Not enough alone", explanation.lost), ("Not decided", explanation.undecided)):
        if entries:
            parts.append(f"<p>{title}: {safe('; '.join(entries))}.</p>")
    parts.append(f"<h3>{safe(play_title(explanation))}</h3>")
    rows = [(time_text(line.at), line.who, line.text) for line in explanation.play]
    none = "<p>A play that shows it was not found within the limits.</p>"
    parts.append(table(("time (units)", "who", "what"), rows) if rows else none)
    if explanation.attempts:
        tried = "".join(f"<li>{safe(text)}</li>" for text in attempt_texts(explanation))
        parts.append(f"<p>What else the robots could begin with, and why that fails:</p><ul>{tried}</ul>")
    return parts


def _game(rules: Rules) -> str:
    """The rules of the game, for people."""
    reaction = f"{float(rules.reaction):g}"
    if rules.ends == "reported":
        ends = "Robots report when they have arrived or finished, at any moment of the model's windows"
    else:
        ends = "The plan decides when movements and actions end, within the model's windows (no real robot lets it)"
    slack = "".join(f"; {agent} may be {units(str(late))} later" for agent, late in rules.slack.items())
    return f"{ends}{slack}. A command may take effect up to {reaction} units after it was due."


def _agents(scenario: Scenario) -> str:
    rows = []
    for agent in scenario.agents:
        does = ", ".join(ref.shown for ref in agent.can_do) or "-"
        reacts = ", ".join(ref.shown for ref in agent.reacts_to) or "-"
        speed = speed_words(agent, scenario)
        rows.append((agent.shown, agent.kind_words, agent.location.shown, speed, does, reacts))
    return table(("agent", "is", "starts at", "moves", "can do", "takes part in"), rows, "Who is there")
