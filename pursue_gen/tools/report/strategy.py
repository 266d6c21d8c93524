"""The strategy: a tree that unfolds, a search that answers questions, and a picture where it is small."""

from __future__ import annotations

from typing import List, Optional

from pursue_gen.diagnostics import counted
from pursue_gen.drawing.look import safe
from pursue_gen.tools.report import graphviz
from pursue_gen.tools.report.graphviz import Graph, arrow, node
from pursue_gen.tools.report.html import Section, asset, data, figure
from pursue_gen.tools.report.strategy_data import Situation, StrategyData, as_json, shown_name, size

MOST_STATES = 40
"""A strategy with more situations is no picture that anybody can read; the tree and the search have no such limit."""


def section(strategy: StrategyData) -> Section:
    """The section of the page; its script builds a situation only when it is opened, since there may be many."""
    states, commands = size(strategy)
    parts = [
        f"<p>The strategy knows {states:,} situations and gives {commands:,} commands in them. Open a situation to see "
        "what is commanded, under which clocks, what is waited for, and where each of these leads.</p>",
        *_stages(strategy),
        *_left_out(strategy),
        "<noscript><p>The search and the tree need JavaScript, which is switched off in this browser.</p></noscript>",
        '<div id="strategy-live" hidden>',
        _form(strategy),
        '<div id="strategy-found" aria-live="polite"></div>',
        "<h3>From the start</h3>",
        '<div id="strategy-tree"></div>',
        "</div>",
        "<p class='quiet'>Times are in units of the scenario. “Last step” of an agent: when it last set off, arrived, "
        "began or finished something.</p>",
        *_picture(strategy),
        data("strategy-data", as_json(strategy)),
    ]
    body = "\n".join(parts)
    return Section("strategy", "The strategy", body, asset("strategy.css"), asset("strategy.js"))


def _stages(strategy: StrategyData) -> List[str]:
    if not strategy.parts:
        return []
    stages = strategy.parts[-1].stage + 1
    in_stages, called = f"in {counted(stages, 'stage')}, one after the other", "part of a stage"
    if not any(part.until for part in strategy.parts):
        in_stages, called = f"in {counted(len(strategy.parts), 'share')}, all at the same time", "share"
    if strategy.ordered:
        text = (
            "All agents play their steps at the same time. Where two must not meet they pass a place in an order: "
            "whoever sets off for it has it until it sets off from there."
        )
        return [f"<p>{text}</p>"]
    text = (
        f"It is played {in_stages}. A {called} speaks only of those who matter to it: all others may be anywhere and "
        "do whatever they can, and its commands are right all the same."
    )
    return [f"<p>{text}</p>"]


def _left_out(strategy: StrategyData) -> List[str]:
    names = ", ".join(safe(name) for name in strategy.left_out)
    return [f"<p>Not mentioned, because what they do cannot matter: {names}.</p>"] if names else []


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


def _form(strategy: StrategyData) -> str:
    hint = example(strategy)
    places = f' placeholder="{safe(hint)}"' if hint else ""
    example_html = f" For example: <em>{safe(hint)}</em>" if hint else ""
    return (
        '<form id="strategy-form" role="search">'
        f'<label for="strategy-question">Ask the strategy.{example_html}</label>'
        f'<div class="strategy-ask"><input id="strategy-question" type="search" autocomplete="off"{places}>'
        '<button type="submit">Find</button></div>'
        "<details><summary>Choose places</summary>"
        '<div id="strategy-choose" class="strategy-choose"></div></details></form>'
    )


def _picture(strategy: StrategyData) -> List[str]:
    drawn = graph(strategy)
    picture = None if drawn is None else graphviz.draw(drawn)
    if drawn is None:
        return []
    if picture is None:
        return [f"<p>There is no picture of it: {safe(graphviz.HOW_TO_GET)}.</p>"]
    caption = "The whole strategy. Full arrows: commands, with their clocks; dashed arrows: what may happen."
    return [f"<details open><summary>As a picture</summary>{figure(picture, caption)}</details>"]


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
