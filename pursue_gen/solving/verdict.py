"""The outcome of a game for people and for programs: the verdict, what it took, and how late commands may come."""

from __future__ import annotations

from typing import Any, Dict, List, Optional, Tuple, Union

from pursue_gen.diagnostics import PursueError, as_json, counted
from pursue_gen.language.numbers import Number
from pursue_gen.language.objectives import WhyGivenUp
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.times import words_for
from pursue_gen.outcomes import LimitHit, NotProven
from pursue_gen.proof.checker import LIMIT
from pursue_gen.proof.margin import USUAL, Margin, decides_ends, describe, game_margin, strategy_margin
from pursue_gen.proof.margin import in_words as margin_in_words
from pursue_gen.solving.rules import Rules, rules_text
from pursue_gen.solving.solution import Solution
from pursue_gen.synthesis.limits import Limits


def margins(won: Solution, thorough: bool, limits: Limits) -> Tuple[Margin, Optional[Margin]]:
    """The margin of the strategy, as far as it is quickly found; `thorough`: all of it, and the game's as well, however
    long that takes unless somebody has set a limit.
    """
    states, limits = (LIMIT, limits.chosen) if thorough else (USUAL, limits)
    margin = strategy_margin(won.network, won.objective, won.strategy, won.reaction, states, limits)
    return margin, game_margin(won.network, won.objective, won.reaction, limits=limits) if thorough else None


def verdict_text(won: Solution, unit: Optional[Number] = None) -> str:
    """The verdict of a game that is won: what it took, and how long a play takes, where that is known.

    `unit`: the seconds of a time unit, where the scenario says that.
    """
    stats = won.stats
    took = f"; {stats.discrete_states} states in {stats.seconds:.3f} s, {stats.engine} engine" if stats else ""
    kept = "" if won.within is None else f" within {words_for(won.within, unit)}"
    stages, shares, passages = (len(some) for some in (won.strategy.stages, won.strategy.shares, won.strategy.passages))
    order = f" in {counted(stages, 'stage')}" if stages else f" in {counted(shares, 'share')}" if shares else ""
    order = f" with the order of passage at {counted(passages, 'place')}" if passages else order
    text = f"won{kept}: {rules_text(won.rules)}{took}; {counted(won.strategy.size, 'command')}{order}, proven"
    return text if won.guarantee is None else f"{text}\n{won.guarantee.in_words(unit)}"


def margin_text(won: Solution, margin: Margin, game: Optional[Margin] = None, unit: Optional[Number] = None) -> str:
    """Lines about how late commands may come; `game` is the game's margin, where it was computed. `unit` as above."""
    lines = [describe(margin, won.strategy, unit)]
    if game is not None:
        lines.append(f"Margin of the game, with a strategy that is made for it (--reaction): {margin_in_words(game)}.")
    return "\n".join(lines)


def verdict_json(
    rules: Rules,
    outcome: Union[Solution, PursueError],
    margin: Optional[Margin] = None,
    game_margin: Optional[Margin] = None,
) -> Dict[str, Any]:
    """The outcome as a JSON object, with margins where they were looked for.

    `won` is null in it where it is not decided: a limit was hit, or the checker refuses the strategy.
    """
    won = outcome if isinstance(outcome, Solution) else None
    findings = outcome.diagnostics if isinstance(outcome, PursueError) else ()
    result: Dict[str, Any] = {
        "won": None if isinstance(outcome, (LimitHit, NotProven)) else won is not None,
        "ends": rules.ends,
        "reaction": float(rules.reaction),
        "slack": dict(rules.slack),
    }
    if won and won.stats:
        stats = won.stats
        result.update(
            engine=stats.engine, states=stats.discrete_states, zones=stats.zones, seconds=round(stats.seconds, 6)
        )
    if won:
        result.update(blocks=len(won.strategy.blocks), commands=won.strategy.size, left_out=_left_out(won))
    if won and margin:
        playable = margin.wins > 0 and not decides_ends(won.strategy)
        result.update(margin=margin.as_json(), playable=playable)
    if won and won.guarantee:
        result["time"] = won.guarantee.as_json()
    if won and won.within is not None:
        result["within"] = float(won.within)
    if game_margin:
        result["game_margin"] = game_margin.as_json()
    result["diagnostics"] = [as_json(finding) for finding in findings]
    return result


def periods_json(scenario: Scenario) -> Dict[str, Any]:
    """The period that was found for patrols that name none, as an entry of the JSON object; else nothing.

    It is `every` time units; nothing below `least` can be promised.
    """
    patrols = [each for each in scenario.patrols if each.least is not None]
    found = [{"every": int(each.known_limit), "least": each.least} for each in patrols]
    return {"period": found[0]} if found else {}


def optional_json(scenario: Scenario) -> Dict[str, Any]:
    """What has become of the numbers behind `optional` in a scenario that is solved; nothing where there are none."""
    given_up = {one.objective.optional: one.why for one in scenario.given_up}
    if not scenario.optional and not given_up:
        return {}
    undecided = sorted(number for number, why in given_up.items() if why is not WhyGivenUp.IMPOSSIBLE)
    known = {"promised": list(scenario.optional), "given_up": sorted(given_up), "undecided": undecided}
    return {"optional": known}


def _left_out(won: Solution) -> List[str]:
    """The automata of which the strategy never speaks: they cannot matter."""
    named = {name for block in won.strategy.blocks for name, _ in block.state.locations}
    if won.strategy.passages or won.strategy.tours:
        named.update(name for name, _ in won.objective.bad)  # kept, though no block names them
    return [automaton.name for automaton in won.network.automata if automaton.name not in named]
