"""What was found out, in words: can the objective be met, how fast, how late may commands come; or why it cannot."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Dict, Optional, Sequence

from pursue_gen.diagnostics import Diagnostic
from pursue_gen.explanation import explain
from pursue_gen.explanation.changes import Change
from pursue_gen.explanation.costs import Costs, in_words
from pursue_gen.explanation.explain import Explanation
from pursue_gen.language.numbers import Number, time_text
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.sentences import end_words, objective_words, promise_words, speed_words
from pursue_gen.language.times import in_unit, words_for
from pursue_gen.partition import unneeded, unneeded_words
from pursue_gen.solving.answers import answers
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import Solution
from pursue_gen.tools.report.html import Section, rendered, table


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
    values: Dict[str, Any] = {
        "explain": explain,
        "wanted": [*objective_words(scenario), *end_words(scenario)],
        "assumed": [each.clause for each in scenario.assumed],
        "won": won,
        "within": "" if won is None or won.within is None else words_for(won.within, scenario.unit),
        "lost": lost,
        "game": _game(rules, scenario.unit),
        "agents": _agents(scenario),
    }
    if won is not None:
        values["promised"] = promise_words(scenario)
        values["kept"] = [text for text in (won.guarantee and won.guarantee.in_words(scenario.unit), margin) if text]
        values["answers"] = [answer.in_words() for answer in answers(scenario, won)]
        values["unneeded"] = unneeded_words(unneeded(scenario, won.strategy))
    elif lost is not None:
        values["others"] = any(not agent.controllable for agent in scenario.agents)
        values["costs"] = [] if lost.costs is None else in_words(lost.costs).splitlines()
        several = [] if lost.explanation is None else [lost.explanation, *lost.explanation.others]
        values["explained"] = [(one, list(map(_change, one.changes)), _play(one)) for one in several]
    return Section("verdict", "The verdict", rendered("verdict", **values))


def _change(change: Change) -> str:
    """A change that helps, where it is made, and what alone is not enough."""
    notes = [f"{change.not_enough} is not enough"] if change.not_enough else []
    notes += [change.span.in_words] if change.span else []
    return change.sentence + (f" ({'; '.join(notes)})" if notes else "")


def _play(explanation: Explanation) -> str:
    rows = [(time_text(line.at), line.who, line.text) for line in explanation.play]
    return table((f"time ({explanation.times_in})", "who", "what"), rows) if rows else ""


def _game(rules: Rules, unit: Optional[Number]) -> str:
    """The rules of the game, for people."""
    reaction = f"{float(rules.reaction):g} units" if unit is None else words_for(rules.reaction, unit)
    if rules.ends == "reported":
        ends = "Robots report when they have arrived or finished, at any moment of the model's windows"
    else:
        ends = "The plan decides when movements and actions end, within the model's windows (no real robot lets it)"
    slack = "".join(f"; {agent} may be {in_unit(str(late), unit)} later" for agent, late in rules.slack.items())
    return f"{ends}{slack}. A command may take effect up to {reaction} after it was due."


def _agents(scenario: Scenario) -> str:
    rows = []
    for agent in scenario.agents:
        does = ", ".join(ref.shown for ref in agent.can_do) or "-"
        reacts = ", ".join(ref.shown for ref in agent.reacts_to) or "-"
        speed = speed_words(agent, scenario)
        starts = " or ".join(ref.shown for ref in agent.starts)
        rows.append((agent.shown, agent.kind_words, starts, speed, does, reacts))
    return table(("agent", "is", "starts at", "moves", "can do", "takes part in"), rows, "Who is there")
