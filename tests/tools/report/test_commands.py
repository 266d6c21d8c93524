"""The table of commands and lines per controller counts what the controllers have, and quotes the thesis exactly."""

from __future__ import annotations

import re
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Dict, List, Optional, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen import __version__
from pursue_gen.partition import partition
from pursue_gen.partition.strategy_data import render
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import Solution
from pursue_gen.synthesis.strategy import Block, Strategy
from pursue_gen.tga.network import Network
from pursue_gen.tools.report.commands import TABLES, as_json, commands_table, render_table, thesis_table
from tests.partition.games import AGENTS, QUICK, REACH, agent, game, random_strategies

TENTH = Fraction(1, 10)


def won(network: Network, strategy: Strategy, reaction: Fraction = Fraction(0), ends: str = "reported") -> Solution:
    """A strategy as the solution of its game."""
    return Solution(network, REACH, strategy, reaction, rules=Rules(ends, reaction))


def published(text: str) -> Dict[str, List[Tuple[int, Optional[int]]]]:
    """From the number of a scenario to the commands and lines of its columns, in the thesis's order."""
    result = {}
    for row in re.findall(r"^\| (\d|catch the thief, simple) \|([^\n]*)\|$", text, re.MULTILINE):
        pairs = re.findall(r"([\d,]+) / ([\d,]+)", row[1])
        if pairs:
            result[row[0]] = [tuple(int(n.replace(",", "")) for n in pair) for pair in pairs]
    return result  # type: ignore[return-value]


def test_the_thesis_is_quoted_exactly(reference_dir: Path) -> None:
    rows = published((reference_dir.parent / "thesis-tables.md").read_text())
    assert len(rows) == len(TABLES)
    for table, key in zip(TABLES, ("1", "2", "3", "4", "catch the thief, simple")):
        assert [(figure.commands, figure.lines) for figure in table.figures] == rows[key]


@QUICK
@given(random_strategies(), random_strategies(), st.sampled_from(("dedicated", "all", "bot1")))
def test_rows_are_what_the_controllers_have(strategy: Strategy, ideal: Strategy, policy: str) -> None:
    network = game()
    table = commands_table("game", AGENTS, won(network, strategy, TENTH), won(network, ideal), policy)
    rows = {row.controller: row for row in table.rows}
    assert list(rows)[:2] == ["General", "Centralized"]
    subs = partition(strategy, network, AGENTS, "distributed", policy)
    assert list(rows)[2:] == [sub.controller for sub in subs]
    for sub in subs:
        assert rows[sub.controller].commands == sub.commands
        assert rows[sub.controller].lines == len(render(sub, "game", __version__, TENTH).splitlines())
    general = [c for block in ideal.blocks for c in block.commands if c.moves[0].automaton != "nurse"]
    assert rows["General"].commands == len(general)
    ours = [c for block in strategy.blocks for c in block.commands if c.moves[0].automaton != "nurse"]
    assert rows["Centralized"].commands == sum(not c.moves[0].edge.is_end for c in ours)


@QUICK
@given(random_strategies())
def test_without_an_ideal_game_general_is_of_the_same_strategy(strategy: Strategy) -> None:
    played = won(game(), strategy)
    table = commands_table("game", AGENTS, played)
    assert table.rows == commands_table("game", AGENTS, played, played).rows


def test_two_games_are_said_to_be_two() -> None:
    played, ideal = won(game(), Strategy(())), won(game(), Strategy(()), ends="controllable")
    two = commands_table("game", AGENTS, played, ideal)
    assert "a strategy each" in render_table(two) and as_json(two)["ends"] is None
    for one, said in ((played, "default game"), (ideal, "ideal game")):
        table = commands_table("game", AGENTS, one)
        text = render_table(table)
        assert f"One strategy of the {said}" in text and "a strategy each" not in text
        assert as_json(table)["ends"] == one.rules.ends


@QUICK
@given(random_strategies())
def test_text_and_json_say_the_same(strategy: Strategy) -> None:
    table = commands_table("game", AGENTS, won(game(), strategy))
    data = as_json(table)
    lines = render_table(table).splitlines()
    assert data["scenario"] == "game" and "game" in lines[0] and "dedicated" in lines[0]
    assert len(lines) == 6 + len(data["controllers"])
    for line, row in zip(lines[4:], data["controllers"]):
        words = line.split()
        shown = [row["controller"], row["commands"], row["commands_percent"], row["lines"], row["lines_percent"]]
        assert words == ["-" if word is None else str(word) for word in shown]
        assert row["thesis"] is None


def test_percentages_are_of_general() -> None:
    table = commands_table("game", AGENTS, won(game(), Strategy(())))
    first = as_json(table)["controllers"][0]
    assert (first["commands_percent"], first["lines_percent"]) == (None, 100.0)


BOTS = (agent("bot1"), agent("bot2"))


def test_the_thesis_stands_beside_its_own_scenarios() -> None:
    table = commands_table("scenario_1", BOTS, won(game(), Strategy(())))
    assert (table.reach_obj, table.thesis_reach_obj) == ("bot2", "bot2")
    lines = render_table(table).splitlines()
    assert lines[4].split()[-4:] == ["17", "100.0", "425", "100.0"]
    assert lines[6].split()[0] == "controller_bot1"
    assert lines[6].split()[-4:] == ["4", "23.5", "182", "42.8"]
    assert as_json(table)["controllers"][2]["thesis"] == {"commands": 4, "lines": 182}


def test_another_policy_than_the_thesis_is_said() -> None:
    table = commands_table("scenario_1", BOTS, won(game(), Strategy(())), reach_obj="dedicated")
    text = render_table(table)
    assert "in the thesis: bot2" in text
    (obj,) = [line for line in text.splitlines() if line.startswith("controllerObj")]
    assert obj.split()[-4:] == ["-"] * 4


@pytest.mark.parametrize(("name", "robots"), [("scenario_9", ("bot1", "bot2")), ("scenario_1", ("bot1", "rover"))])
def test_other_scenarios_are_not_compared(name: str, robots: Tuple[str, ...]) -> None:
    assert thesis_table(name, robots) is None


def test_instructions_for_people_are_counted_once() -> None:
    controllers = [row.controller for row in commands_table("game", AGENTS, won(game(), Strategy(()))).rows]
    assert controllers.count("UI") == 1
    robots_only = tuple(replace(a, human=False) for a in AGENTS)
    controllers = [row.controller for row in commands_table("game", robots_only, won(game(), Strategy(()))).rows]
    assert "UI" not in controllers


@QUICK
@given(random_strategies())
def test_more_to_do_never_takes_fewer_lines(strategy: Strategy) -> None:
    network = game()
    less = Strategy(tuple(Block(b.state, b.wait, b.commands[1:]) for b in strategy.blocks))
    more_rows = commands_table("game", AGENTS, won(network, strategy)).rows
    for fewer, row in zip(commands_table("game", AGENTS, won(network, less)).rows, more_rows):
        assert (fewer.commands, fewer.lines) <= (row.commands, row.lines)
        assert fewer.lines <= row.lines
