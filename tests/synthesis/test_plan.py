"""Plans: what TIGA wrote is read whole, what we write reads back equal, and damage is told with its line."""

from __future__ import annotations

import re
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Dict, List, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import load
from pursue_gen.language.numbers import decimal_text
from pursue_gen.synthesis.plan import read_plan, write_plan
from pursue_gen.synthesis.strategy import Block, Constraint, Strategy
from pursue_gen.tga import translate
from pursue_gen.tga.network import ClockBound, Guard, Kind, Network, Objective
from pursue_gen.tga.uppaal import read_network, read_query
from tests.partition.games import QUICK, REACH, SAFETY, game, random_strategies

NAMES = ("CT1", "CT2a", "CT3a", "CT4", "CT5", "WC1", "WC2a", "EB1", "EB2", "EB2x", "EB3")

PLAN = """null\x1b[1;34mGuessed query file: \x1b[0;0mUPPAAL_model.q
Verifying property 1 at line 1
Preparing: 99%\x1b[K
\x1b[2K -- Property is satisfied.

Strategy to win:

State: ( states.base bot1.a bot2.b nurse.a thief.a obj.idle reachObj._unlocked rule._rule0 ) \
Prule=1 Pbot1=1 Pbot2=2 Pnurse=1 Pthief=1 Sopen=0\x20
While you are in (Cbot1<=1 && Cbot1-Cbot2<-2) || (Cnurse==3 && 4/3<Cthief), wait.
When you are in (1.5<Cbot1 && Cbot1==Cthief), take transition bot1.a->bot1.doing_work1_in_a \
{ Cbot1 > 1 && (Prule == 0 || Prule == 1), work1!, Pbot1 := -11, Cbot1 := 0 }
states.base->states.base { 1, work1?, Sopen := 1 }
When you are in true, take transition bot2.b->bot2.going_b_to_a { Cbot2 > 1, bot2_b2a!, Cbot2 := 0, Pbot2 := -21 }
"""


def table(reference_dir: Path) -> Dict[str, Tuple[int, int]]:
    """State blocks and commands of each published plan, as the table beside the plans gives them."""
    rows = re.findall(
        r"^\| (\w+) \|.*\| ([\d,]+) / ([\d,]+) \|$", (reference_dir.parent / "README.md").read_text(), re.MULTILINE
    )
    return {name: (int(blocks.replace(",", "")), int(commands.replace(",", ""))) for name, blocks, commands in rows}


def published(reference_dir: Path, name: str) -> Tuple[str, Network, Objective]:
    """A published plan, its network and its objective."""
    folder = reference_dir / name
    (plan,) = folder.glob("UPPAAL_plan*.txt")
    network = read_network((folder / "TGA.xml").read_text(), "TGA.xml")
    return plan.read_text(), network, read_query((folder / "TCTL.q").read_text(), "TCTL.q")


def fails(text: str) -> PursueError:
    """The error that reading the text in the small game gives."""
    with pytest.raises(PursueError) as caught:
        read_plan(text, game(), "plan.txt")
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.hint
    assert diagnostic.span and diagnostic.span.file == "plan.txt"
    return caught.value


def line_of(problem: PursueError) -> int:
    """The line that an error names."""
    span = problem.diagnostics[0].span
    assert span
    return span.line


@pytest.mark.parametrize("name", NAMES)
def test_published_plans_are_read_whole(reference_dir: Path, name: str) -> None:
    text, network, _ = published(reference_dir, name)
    strategy = read_plan(text, network, name)
    counts = (len(strategy.blocks), sum(len(block.commands) for block in strategy.blocks))
    assert counts == table(reference_dir)[name]
    assert strategy.counter == (name in ("CT3a", "WC2a"))


@pytest.mark.parametrize("name", NAMES)
def test_published_plans_are_written_as_tiga_wrote_them(reference_dir: Path, name: str) -> None:
    text, network, objective = published(reference_dir, name)
    strategy = read_plan(text, network, name)
    ours = write_plan(strategy, network, objective)
    assert read_plan(ours, network, name) == strategy

    def lines(plan: str) -> List[str]:
        # Assignments may stand in another order; the automaton `states` without edges is absent in our networks.
        part = plan[re.search(r"^\w.* to .*:$", plan, re.MULTILINE).start() :]  # type: ignore[union-attr]
        return [line for line in part.replace(" states.base", "").splitlines() if "{" not in line]

    if any(automaton.name == "states" for automaton in network.automata):
        assert "states.base" in ours
    assert lines(ours) == lines(text)


@pytest.mark.parametrize("name", NAMES)
def test_published_plans_fit_the_network_that_we_make_of_the_scenario(reference_dir: Path, name: str) -> None:
    text, network, _ = published(reference_dir, name)
    ours = translate(load(reference_dir / name / "scenario.pur"))
    theirs = read_plan(text, network, name)
    mine = read_plan(text, ours, name)
    assert len(mine.blocks) == len(theirs.blocks)
    assert all(len(a.commands) == len(b.commands) for a, b in zip(mine.blocks, theirs.blocks))


@QUICK
@given(random_strategies())
def test_what_is_written_reads_back_equal(strategy: Strategy) -> None:
    network = game()
    assert read_plan(write_plan(strategy, network, REACH), network, "plan.txt") == strategy


@QUICK
@given(random_strategies(controllable=False))
def test_counter_strategies_read_back_equal(strategy: Strategy) -> None:
    network = game()
    assert read_plan(write_plan(strategy, network, SAFETY), network, "plan.txt") == strategy


@QUICK
@given(random_strategies(), st.data())
def test_a_cut_plan_is_refused_or_is_a_beginning(strategy: Strategy, data: st.DataObject) -> None:
    """A cut between two commands leaves no trace; any other is found."""
    network = game()
    text = write_plan(strategy, network, REACH)
    cut = text[: data.draw(st.integers(0, len(text)))]
    try:
        part = read_plan(cut, network, "plan.txt")
    except PursueError as problem:
        assert problem.diagnostics[0].span
        return
    assert part.blocks[:-1] == strategy.blocks[: len(part.blocks) - 1]
    last, whole = part.blocks[-1], strategy.blocks[len(part.blocks) - 1]
    assert last.wait in (whole.wait, ())
    assert last.commands == whole.commands[: len(last.commands)]


@QUICK
@given(random_strategies(), st.data())
def test_a_damaged_plan_never_breaks_the_reader(strategy: Strategy, data: st.DataObject) -> None:
    text = write_plan(strategy, game(), REACH)
    at = data.draw(st.integers(0, len(text) - 1))
    damaged = text[:at] + data.draw(st.text(max_size=3)) + text[at + data.draw(st.integers(0, 5)) :]
    try:
        assert read_plan(damaged, game(), "plan.txt").blocks
    except PursueError as problem:
        assert problem.diagnostics[0].hint


def test_a_plan_is_understood() -> None:
    (block,) = read_plan(PLAN, game(), "plan.txt").blocks
    assert dict(block.state.locations)["reachObj"] == "unlocked"
    assert dict(block.state.values) == {"Prule": 1, "Pbot1": 1, "Pbot2": 2, "Pnurse": 1, "Pthief": 1, "Sopen": 0}
    three = Fraction(3)
    assert block.wait[1] == (
        Constraint("Cnurse", None, three, False),
        Constraint(None, "Cnurse", -three, False),
        Constraint(None, "Cthief", Fraction(-4, 3), True),
    )
    work, go = block.commands
    assert work.zones[0][0] == Constraint(None, "Cbot1", Fraction(-3, 2), True)
    assert [move.automaton for move in work.moves] == ["bot1", "states"]
    assert work.moves[0].edge.target == "doing_work1_in_a"
    assert go.zones == ((),)


def test_carriage_returns_do_not_matter() -> None:
    assert read_plan(PLAN.replace("\n", "\r\n"), game(), "plan.txt") == read_plan(PLAN, game(), "plan.txt")


def test_parts_of_a_state_may_stand_in_any_order() -> None:
    shuffled = PLAN.replace("bot1.a bot2.b", "bot2.b bot1.a").replace("Prule=1 Pbot1=1", "Pbot1=1 Prule=1")
    assert read_plan(shuffled, game(), "plan.txt") == read_plan(PLAN, game(), "plan.txt")


def test_the_guard_chooses_between_edges_that_are_otherwise_alike() -> None:
    network = game()
    bot2 = network.automaton("bot2")
    (go,) = (edge for edge in bot2.edges if edge.target == "going_b_to_a")
    late = replace(go, guard=Guard((ClockBound("Cbot2", ">", 5),)))
    both = replace(bot2, edges=(late, *bot2.edges))
    network = replace(network, automata=tuple(both if a == bot2 else a for a in network.automata))
    for bound, edge in ((1, go), (5, late)):
        plan = PLAN.replace("Cbot2 > 1, bot2_b2a!", f"Cbot2 > {bound}, bot2_b2a!")
        (block,) = read_plan(plan, network, "plan.txt").blocks
        assert block.commands[-1].moves[0].edge == edge


@pytest.mark.parametrize(
    ("kind", "counter", "title"),
    [
        (Kind.REACH, False, "Strategy to win:"),
        (Kind.SAFETY, False, "Strategy to avoid losing:"),
        (Kind.REACH_WHILE_SAFE, False, "Strategy to win:"),
        (Kind.REACH, True, "Counter strategy to prevent from winning:"),
        (Kind.SAFETY, True, "Counter strategy to lose:"),
    ],
)
def test_titles_are_those_of_tiga(kind: Kind, counter: bool, title: str) -> None:
    blocks = read_plan(PLAN, game(), "plan.txt").blocks
    text = write_plan(Strategy(blocks, counter), game(), Objective(kind))
    assert title in text.splitlines()
    assert f"Property is {'NOT ' if counter else ''}satisfied." in text


def test_a_block_that_says_nothing_is_left_out() -> None:
    (block,) = read_plan(PLAN, game(), "plan.txt").blocks
    silent = Block(block.state, (), ())
    assert write_plan(Strategy((silent, block)), game(), REACH) == write_plan(Strategy((block,)), game(), REACH)


def test_lost_without_counter_strategy() -> None:
    problem = fails("Verifying property 1 at line 1\n\x1b[2K -- Property is NOT satisfied.\n")
    assert problem.exit_status == 4
    assert line_of(problem) == 2


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "empty"),
        (" \n\n", "empty"),
        ("what is this?\n", "no plan"),
        (" -- Property is satisfied.\n", "holds no strategy"),
        ("Strategy to win:\n\n", "empty"),
    ],
)
def test_text_without_a_strategy(text: str, message: str) -> None:
    assert message in fails(text).diagnostics[0].message


@pytest.mark.parametrize(
    ("old", "new", "line", "message"),
    [
        ("bot1.a bot2.b", "bot1.a bot9.b", 8, "no automaton 'bot9'"),
        ("bot1.a bot2.b", "bot1.a bot2.z", 8, "no location 'z'"),
        ("bot1.a bot2.b", "bot1.a", 8, "nothing of automaton 'bot2'"),
        ("bot1.a bot2.b", "bot1.a bot1.b bot2.b", 8, "two locations"),
        ("Sopen=0", "Sopen=x", 8, "no value"),
        ("Sopen=0", "Sopen=0 Sshut=1", 8, "no variable 'Sshut'"),
        (" Sopen=0", "", 8, "nothing of variable 'Sopen'"),
        ("( states", "states", 8, "no state"),
        ("State: ", "Stat: ", 8, "expected a line"),
        ("Cbot1<=1", "Cbot7<=1", 9, "no clock 'Cbot7'"),
        ("Cbot1<=1", "Cbot1<=1/0", 9, "no constraint"),
        ("Cbot1<=1", "Cbot1!=1", 9, "no constraint"),
        (", wait.", "", 9, "cut or damaged"),
        ("bot1.a->bot1.doing", "bot2.a->bot1.doing", 10, "stays in one automaton"),
        ("bot1.a->bot1.doing", "bot9.a->bot9.doing", 10, "no automaton 'bot9'"),
        ("work1!", "work2!", 10, "no edge bot1.a->bot1.doing_work1_in_a with 'work2!'"),
        ("{ Cbot1 > 1 &&", "{ Cbot1 > 7 &&", 10, "in the network the edge"),
        ("Pbot1 := -11", "Pbot1 := -22", 10, "in the network the edge"),
        (" }\nstates.base", "\nstates.base", 10, "no transition"),
        ("states.base->states.base { 1, work1?, Sopen := 1 }\n", "", 10, "must receive"),
        ("work1?, Sopen := 1", "work2?, Sopen := 0", 11, "must receive"),
        ("bot2.b->bot2.going_b_to_a", "bot2.a->bot2.going_a_to_b", 12, "no edge"),
    ],
)
def test_damage_is_reported_with_its_line(old: str, new: str, line: int, message: str) -> None:
    assert PLAN.count(old) >= 1
    problem = fails(PLAN.replace(old, new, 1))
    assert message in problem.diagnostics[0].message
    assert line_of(problem) == line


def test_a_state_twice() -> None:
    block = PLAN[PLAN.index("State:") :]
    problem = fails(f"{PLAN}\n{block}")
    assert "twice" in problem.diagnostics[0].message
    assert line_of(problem) == 14


def test_a_state_with_nothing_to_do_is_a_cut_plan() -> None:
    problem = fails(PLAN[: PLAN.index("While")])
    assert "cut" in problem.diagnostics[0].message
    assert line_of(problem) == 8


@given(st.integers(-(10**6), 10**6), st.integers(1, 2000))
def test_numbers_are_exact(numerator: int, denominator: int) -> None:
    number = Fraction(numerator, denominator)
    assert Fraction(decimal_text(number)) == number
