"""From what a person typed to the game that is played, and from its outcome to words."""

from __future__ import annotations

from fractions import Fraction
from typing import Any, Dict, Optional, Sequence, Tuple

from pursue_gen.diagnostics import Diagnostic, as_json, counted, usage_error
from pursue_gen.proof.margin import Margin, decides_ends, told
from pursue_gen.proof.margin import as_json as margin_json
from pursue_gen.proof.margin import in_words as margin_in_words
from pursue_gen.solving.solution import CONTROLLABLE, IDEAL, REPORTED, Rules, Solution
from pursue_gen.synthesis.limits import UNDECIDED, Limits, careful_memory
from pursue_gen.tga.network import Network, is_end

DEFAULT = Rules()
"""What is played where the options say nothing."""


def asked_rules(network: Network, ends: Optional[str], reaction: Optional[str], slack: Sequence[str]) -> Rules:
    """The game that the options ask for; the defaults are those of Rules. Raises PursueError (exit status 2)."""
    delay = DEFAULT.reaction if reaction is None else _fraction(reaction)
    rules = Rules(ends or DEFAULT.ends, delay, _slack(network, slack))
    if rules.slack and rules.ends == CONTROLLABLE:
        raise usage_error("slack has no meaning where the plan decides the ends", "use it with --ends reported")
    return rules


def asked_limits(seconds: float, memory: Optional[int]) -> Limits:
    """The limits that the options ask for; None: the memory that leaves the machine some."""
    return Limits(seconds, careful_memory() if memory is None else memory)


def games_to_try(
    network: Network, ends: Optional[str], reaction: Optional[str], slack: Sequence[str]
) -> Tuple[Rules, ...]:
    """The games to try a plan in: the one that the options ask for; and the ideal one, if they do not rule it out."""
    rules = asked_rules(network, ends, reaction, slack)
    asked = reaction is not None or bool(slack) or ends == REPORTED
    return (rules,) if asked else (rules, IDEAL)


def _fraction(text: str) -> Fraction:
    hint = "a number of time units from 0 on, such as 0.1, 1/20 or 0"
    try:
        value = Fraction(text)
    except (ValueError, ZeroDivisionError):
        raise usage_error(f"the reaction is '{text}'", hint) from None
    if value < 0 or value > 1000 or value.denominator > 1000:
        raise usage_error(f"the reaction is {text}; expected 0 to 1000, in steps of at least 1/1000", hint)
    return value


def _slack(network: Network, options: Sequence[str]) -> Dict[str, int]:
    """The slack per agent; a number alone is for every agent that the plan controls."""
    slack: Dict[str, int] = {}
    for option in options:
        agent, named, number = option.rpartition("=")
        if not (number.isascii() and number.isdigit()) or (named and not agent):
            raise usage_error(f"the slack is '{option}'", "a number of time units such as 2, or for one agent bot1=2")
        controlled = [a.name for a in network.automata if any(is_end(edge) and edge.controllable for edge in a.edges)]
        slack.update((name, int(number)) for name in ([agent] if named else controlled))
    return slack


def verdict_text(rules: Rules, won: Solution) -> str:
    """What is said about a game that is won: what it took, and how long a play takes, where that is known."""
    stats = won.stats
    took = f"; {stats.discrete_states} states in {stats.seconds:.3f} s, {stats.engine} engine" if stats else ""
    text = f"won: {in_words(rules)}{took}; {counted(_commands(won), 'command')}, proven"
    return text if won.guarantee is None else f"{text}\n{won.guarantee.in_words()}"


def margins_told(won: Solution, margin: Margin, game: Optional[Margin] = None) -> str:
    """Lines about how late commands may come; `game` is the game's margin, where it was asked for."""
    lines = [told(margin, won.strategy)]
    if game is not None:
        lines.append(f"Margin of the game, with a strategy that is made for it (--reaction): {margin_in_words(game)}.")
    return "\n".join(lines)


def verdict_json(
    rules: Rules,
    won: Optional[Solution],
    findings: Sequence[Diagnostic],
    margin: Optional[Margin] = None,
    game_margin: Optional[Margin] = None,
) -> Dict[str, Any]:
    """The outcome as a JSON object; `findings` say why `won` is not true; margins where they were looked for.

    It is null where nobody knows: a limit was hit, or the strategy of another tool does not win.
    """
    result: Dict[str, Any] = {
        "won": True if won else None if any(f.code in (UNDECIDED, "SYN035") for f in findings) else False,
        "ends": rules.ends,
        "reaction": str(rules.reaction),
        "slack": dict(rules.slack),
    }
    if won and won.stats:
        stats = won.stats
        result.update(
            engine=stats.engine, states=stats.discrete_states, zones=stats.zones, seconds=round(stats.seconds, 6)
        )
    if won:
        result.update(blocks=len(won.strategy.blocks), commands=_commands(won))
    if won and margin:
        playable = margin.wins > 0 and not decides_ends(won.strategy)
        result.update(margin=margin_json(margin), playable=playable)
    if won and won.guarantee:
        result["time"] = won.guarantee.as_json()
    if game_margin:
        result["game_margin"] = margin_json(game_margin)
    result["diagnostics"] = [as_json(finding) for finding in findings]
    return result


def _commands(won: Solution) -> int:
    return sum(len(block.commands) for block in won.strategy.blocks)


def in_words(rules: Rules) -> str:
    """The game's parameters."""
    slack = "".join(f", {agent} late by {units}" for agent, units in rules.slack.items())
    return f"ends {rules.ends}, reaction {float(rules.reaction):g}{slack}"
