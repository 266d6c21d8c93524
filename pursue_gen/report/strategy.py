"""The strategy: a tree that unfolds, a search that answers questions, and a picture where it is small."""

from __future__ import annotations

from typing import List, Optional

from pursue_gen.drawing.look import safe
from pursue_gen.report import graphviz
from pursue_gen.report.graphviz import Graph, arrow, node
from pursue_gen.report.html import Section, asset, data, figure
from pursue_gen.report.strategy_data import Book, Situation, as_json, shown_name, size

MOST_STATES = 40
"""A strategy with more situations is no picture that anybody can read; the tree and the search have no such limit."""


def section(book: Book) -> Section:
    """The part of the page; its script makes situations when somebody looks at them, so large ones stay usable."""
    states, commands = size(book)
    parts = [
        f"<p>The strategy knows {states:,} situations and gives {commands:,} commands in them. Open a situation to see "
        "what is commanded, under which clocks, what is waited for, and where each of these leads.</p>",
        "<noscript><p>The search and the tree need JavaScript, which is switched off in this browser.</p></noscript>",
        '<div id="strategy-live" hidden>',
        _form(book),
        '<div id="strategy-found" aria-live="polite"></div>',
        "<h3>From the start</h3>",
        '<div id="strategy-tree"></div>',
        "</div>",
        "<p class='quiet'>Times are in units of the scenario. “Last step” of an agent: when it last set off, arrived, "
        "began or finished something.</p>",
        *_picture(book),
        data("strategy-data", as_json(book)),
    ]
    body = "\n".join(parts)
    return Section("strategy", "The strategy", body, asset("strategy.css"), asset("strategy.js"))


def graph(book: Book) -> Optional[Graph]:
    """The whole strategy as a graph; None where it is too large to be read."""
    if len(book.situations) > MOST_STATES:
        return None
    lines = [_state(book, k, situation) for k, situation in enumerate(book.situations)]
    count = 0
    for k, situation in enumerate(book.situations):
        for step in (*situation.commands, *situation.others):
            ours = bool(step.when)
            who = shown_name(*book.automata[step.who][:2])
            when = "\nor ".join(book.zones[zone][1] for zone in step.when)
            label = f"{who} {step.words}" + (f"\n{when}" if ours else "")
            names = f"strategy-graph-s{k}", f"strategy-graph-s{step.target}", f"strategy-graph-e{count}"
            lines.append(arrow(*names, label, style="solid" if ours else "dashed", penwidth=1.6 if ours else 1))
            count += 1
    return Graph("strategy-graph", "The strategy", "Full arrows are commands, dashed ones what may happen", lines)


def example(book: Book) -> str:
    """A question that can be asked of this strategy."""
    robots = [name for name, kind, _ in book.automata if kind == "robot"]
    movers = [(name, kind, [p for _, p in places if p[:1] == ("way",)]) for name, kind, places in book.automata]
    others = [(f"the {name}", ways) for name, kind, ways in movers if kind == "other" and ways]
    others += [(name, ways) for name, kind, ways in movers if kind == "robot" and name not in robots[-1:] and ways]
    if not robots or not others:
        return ""
    name, ways = others[0]
    asked = next((robot for robot in reversed(robots) if robot != name), robots[0])
    return f"what will {asked} do if {name} goes to {ways[0][2]}?"


def _form(book: Book) -> str:
    hint = example(book)
    places = f' placeholder="{safe(hint)}"' if hint else ""
    told = f" For example: <em>{safe(hint)}</em>" if hint else ""
    return (
        '<form id="strategy-form" role="search">'
        f'<label for="strategy-question">Ask the strategy.{told}</label>'
        f'<div class="strategy-ask"><input id="strategy-question" type="search" autocomplete="off"{places}>'
        '<button type="submit">Find</button></div>'
        "<details><summary>Choose places</summary>"
        '<div id="strategy-choose" class="strategy-choose"></div></details></form>'
    )


def _picture(book: Book) -> List[str]:
    drawn = graph(book)
    picture = None if drawn is None else graphviz.draw(drawn)
    if drawn is None:
        return []
    if picture is None:
        return [f"<p>There is no picture of it: {safe(graphviz.HOW_TO_GET)}.</p>"]
    caption = "The whole strategy. Full arrows: commands, with their clocks; dashed arrows: what may happen."
    return [f"<details open><summary>As a picture</summary>{figure(picture, caption)}</details>"]


def _state(book: Book, number: int, situation: Situation) -> str:
    lines = [f"#{number}"]
    for (name, kind, places), place in zip(book.automata, situation.places):
        if kind in ("robot", "person", "other"):
            lines.append(f"{name} {places[place][0]}")
    if situation.goal:
        lines[0] += " goal reached"
    if situation.wait or (not situation.commands and not situation.goal):
        lines.append("(wait)" if not situation.commands else "(else wait)")
    return node(f"strategy-graph-s{number}", "\n".join(lines), peripheries=2 if number == 0 or situation.goal else 1)
