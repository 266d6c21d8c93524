"""The strategy: a tree that unfolds, a search that answers questions, and a picture where it is small."""

from __future__ import annotations

from typing import Any, Dict, Optional

from pursue_gen.diagnostics import counted
from pursue_gen.tools.report import graphviz
from pursue_gen.tools.report.graphviz import Graph, arrow, node
from pursue_gen.tools.report.html import Section, asset, data, rendered
from pursue_gen.tools.report.strategy_data import Situation, StrategyData, as_json, shown_name, size

MOST_STATES = 40
"""A strategy with more situations is no picture that anybody can read; the tree and the search have no such limit."""


def section(strategy: StrategyData) -> Section:
    """The section of the page; its script builds a situation only when it is opened, since there may be many."""
    states, commands = size(strategy)
    drawn = graph(strategy)
    values: Dict[str, Any] = {"strategy": strategy, "states": states, "commands": commands, "hint": example(strategy)}
    if any(part.until for part in strategy.parts):
        stages = counted(strategy.parts[-1].stage + 1, "stage")
        values.update(how=f"in {stages}, one after the other", part="part of a stage")
    else:
        values.update(how=f"in {counted(len(strategy.parts), 'share')}, all at the same time", part="share")
    values.update(is_small=drawn is not None, picture=drawn and graphviz.draw(drawn), how_to_get=graphviz.HOW_TO_GET)
    body = rendered("strategy", **values, data=data("strategy-data", as_json(strategy)))
    return Section("strategy", "The strategy", body, asset("strategy.css"), asset("strategy.js"))


def graph(strategy: StrategyData) -> Optional[Graph]:
    """The whole strategy as a graph; None where it is too large to be read."""
    if len(strategy.situations) > MOST_STATES:
        return None
    lines = [_state(strategy, k, situation) for k, situation in enumerate(strategy.situations)]
    count = 0
    for k, situation in enumerate(strategy.situations):
        for step in (*situation.commands, *situation.others):
            commanded = bool(step.when)
            who = shown_name(*strategy.automata[step.who][:2])
            when = "\nor ".join(strategy.zones[zone][1] for zone in step.when)
            label = f"{who} {step.words}" + (f"\n{when}" if commanded else "")
            names = f"strategy-graph-s{k}", f"strategy-graph-s{step.target}", f"strategy-graph-e{count}"
            style, width = ("solid", 1.6) if commanded else ("dashed", 1)
            lines.append(arrow(*names, label, style=style, penwidth=width))
            count += 1
    return Graph("strategy-graph", "The strategy", "Full arrows are commands, dashed ones what may happen", lines)


def example(strategy: StrategyData) -> str:
    """An example of a question about this strategy; "" where there is none."""
    robots = [name for name, kind, _ in strategy.automata if kind == "robot"]
    movers = [(name, kind, [p for _, p in places if p[:1] == ("way",)]) for name, kind, places in strategy.automata]
    others = [(f"the {name}", ways) for name, kind, ways in movers if kind == "other" and ways]
    others += [(name, ways) for name, kind, ways in movers if kind == "robot" and name not in robots[-1:] and ways]
    if not robots or not others:
        return ""
    name, ways = others[0]
    subject = next((robot for robot in reversed(robots) if robot != name), robots[0])
    return f"what will {subject} do if {name} goes to {ways[0][2]}?"


def _state(strategy: StrategyData, number: int, situation: Situation) -> str:
    lines = [f"#{number}"]
    for k, ((name, kind, places), place) in enumerate(zip(strategy.automata, situation.places)):
        if kind in ("robot", "person", "other") and not strategy.is_free(k, place):
            lines.append(f"{strategy.labels.get(name, name)} {places[place][0]}")
    if situation.goal:
        lines[0] += " goal reached"
    elif situation.done:
        lines[0] += " part done"
    ended = situation.goal or situation.done
    if situation.wait or (not situation.commands and not ended):
        lines.append("(wait)" if not situation.commands else "(else wait)")
    begins = number in {0, *(part.first for part in strategy.parts if part.stage == 0)}
    return node(f"strategy-graph-s{number}", "\n".join(lines), peripheries=2 if begins or ended else 1)
