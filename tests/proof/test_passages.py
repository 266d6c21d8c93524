"""Orders of passage: what the checker takes as one course of events wins the game as a whole."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import ceil
from typing import Optional, Tuple

import pytest
from hypothesis import HealthCheck, event, given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.proof.checker import ProofReport, verify
from pursue_gen.proof.passage_times import latest
from pursue_gen.proof.passages import Fault
from pursue_gen.proof.passages import played as played_course
from pursue_gen.proof.worst_case import with_counter, with_deadline, worst_case
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.passages import crowd_of, won_by_passages
from pursue_gen.solving.rules import DEFAULT, IDEAL, Rules
from pursue_gen.synthesis.limits import LimitMonitor
from pursue_gen.synthesis.strategy import Block, Command, Constraint, DiscreteState, Move, Strategy
from pursue_gen.tga.network import (
    Automaton,
    ClockBound,
    Edge,
    Guard,
    Kind,
    Location,
    Network,
    Objective,
    Sync,
    Test,
)
from pursue_gen.tga.passages import Passage
from tests.proof.passing_games import Game, damaged, game_of, of_the_whole, passing_texts

DELAY = Fraction(1, 10)
RANDOM = settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))

CORRIDOR = """
poi "a"
poi "b"
poi "c"
poi "bay"
connect a and b distance 2
connect b and c distance 2
connect b and bay distance 1
event "work1" location c duration 2
event "work2" location a duration 2
agent "bot1" controllable mobile 1 location a can_do work1
agent "bot2" controllable mobile 1 location c can_do work2
objective: bot1 never_with bot2
reach_objective: do work1
reach_objective: do work2
"""


@pytest.fixture(scope="module", autouse=True)
def twin() -> None:
    """The course of events is followed in Python alone."""


def strategy_for(game: Game, reaction: Fraction = DELAY) -> Optional[Strategy]:
    crowd = crowd_of(*game)
    return None if crowd is None else won_by_passages(*game, crowd, reaction, SolveOptions())


def judged(game: Game, strategy: Strategy, reaction: Fraction = DELAY) -> Optional[ProofReport]:
    try:
        return verify(*game, strategy, reaction)
    except PursueError:
        return None


def wins_as_a_whole(game: Game, strategy: Strategy, reaction: Fraction = DELAY) -> None:
    whole = of_the_whole(game, strategy)
    if whole is not None:
        report = verify(whole[0], game[1], whole[1], reaction)
        assert report.ok, (report.reason, report.play)


@RANDOM
@given(text=passing_texts(), rules=st.sampled_from((DEFAULT, IDEAL)))
def test_what_is_found_wins_as_a_whole(text: str, rules: Rules) -> None:
    game = game_of(text, rules)
    strategy = strategy_for(game, rules.reaction)
    event("found" if strategy else "not found")
    if strategy is not None:
        wins_as_a_whole(game, strategy, rules.reaction)


@RANDOM
@given(data=st.data(), text=passing_texts(), rules=st.sampled_from((DEFAULT, IDEAL)))
def test_what_is_damaged_and_passes_still_wins_as_a_whole(data: st.DataObject, text: str, rules: Rules) -> None:
    game = game_of(text, rules)
    strategy = strategy_for(game, rules.reaction)
    for _ in range(data.draw(st.integers(1, 2)) if strategy else 0):
        assert strategy is not None
        strategy = data.draw(damaged(strategy))
    report = None if strategy is None else judged(game, strategy, rules.reaction)
    event("none" if report is None else "passes" if report.ok else report.reason.split(" ")[1])
    if strategy is not None and report is not None and report.ok:
        wins_as_a_whole(game, strategy, rules.reaction)


def corridor() -> Tuple[Game, Strategy]:
    game = game_of(CORRIDOR)
    strategy = strategy_for(game)
    assert strategy is not None
    return game, strategy


def test_robots_pass_each_other_with_a_bay() -> None:
    game, strategy = corridor()
    assert [passage.place for passage in strategy.passages].count("b") == 1
    assert verify(*game, strategy, DELAY).ok
    wins_as_a_whole(game, strategy)


def test_who_does_not_wait_for_its_turn_is_refused() -> None:
    game, strategy = corridor()
    refused = 0
    for k, block in enumerate(strategy.blocks):
        for gone in block.state.locations if block.commands else ():
            if gone[0] != "b_passage" or not gone[1].startswith("awaits") or gone[1].endswith("_1"):
                continue  # nobody else was there before
            kept = tuple(place for place in block.state.locations if place != gone)
            blocks = list(strategy.blocks)
            blocks[k] = replace(block, state=DiscreteState(kept, block.state.values))
            assert not verify(*game, replace(strategy, blocks=tuple(blocks)), DELAY).ok
            refused += 1
    assert refused == 2


def test_another_order_is_refused() -> None:
    game, strategy = corridor()
    for k, passage in enumerate(strategy.passages):
        for other in ((*passage.robots[1:], passage.robots[0]), passage.robots[:-1]):
            if other == passage.robots or not other:
                continue
            passages = (*strategy.passages[:k], Passage(passage.place, other), *strategy.passages[k + 1 :])
            report = judged(game, replace(strategy, passages=passages))
            assert report is None or not report.ok


def test_a_command_before_its_time_is_refused() -> None:
    game, strategy = corridor()
    k = next(k for k, block in enumerate(strategy.blocks) if block.commands)
    block = strategy.blocks[k]
    soon = (Constraint(None, "Cbot1", Fraction(-1, 2), True),)
    late = (*block.commands[0].zones[0], Constraint("Cbot1", None, Fraction(9), False))
    for zone, reason in ((soon, "too soon"), (late, "lower bounds"), ((), "too soon")):
        blocks = list(strategy.blocks)
        blocks[k] = replace(block, wait=((),), commands=(replace(block.commands[0], zones=(zone,)),))
        report = verify(*game, replace(strategy, blocks=tuple(blocks)), DELAY)
        assert not report.ok
        assert reason in report.reason


def test_an_agent_without_a_block_for_where_it_is_is_refused() -> None:
    game, strategy = corridor()
    for k, block in enumerate(strategy.blocks):
        if "going" in block.state.locations[0][1]:
            blocks = (*strategy.blocks[:k], *strategy.blocks[k + 1 :])
            assert "no block says what" in verify(*game, replace(strategy, blocks=blocks), DELAY).reason


def test_the_guaranteed_time_is_that_of_the_whole_game() -> None:
    game, strategy = corridor()
    whole = of_the_whole(game, strategy)
    assert whole is not None
    assert worst_case(*game, strategy) == worst_case(whole[0], game[1], whole[1])
    # With a reaction no command grows stale because of others, as it does in blocks that name everybody.
    took, exact = worst_case(*game, strategy, DELAY), worst_case(whole[0], game[1], whole[1], DELAY)
    assert took is not None
    assert exact is not None
    assert took <= exact


@RANDOM
@given(text=passing_texts())
def test_guaranteed_times_are_never_too_short(text: str) -> None:
    game = game_of(text)
    strategy = strategy_for(game)
    whole = None if strategy is None else of_the_whole(game, strategy)
    if strategy is not None and whole is not None:
        took, exact = worst_case(*game, strategy), worst_case(whole[0], game[1], whole[1], limit=5_000)
        event("compared" if exact is not None else "not compared")
        assert took is not None
        assert exact is None or took <= exact + Fraction(1, 100)  # where zones become hulls it may come out too long
        timed = with_deadline(with_counter(whole[0]), game[1], ceil(took))
        assert verify(timed, game[1], whole[1], prompt=True).ok


def test_a_deadline_is_kept_or_the_strategy_is_refused() -> None:
    def within(time: int) -> ProofReport:
        text = CORRIDOR.replace("reach_objective: do work2", f"reach_objective: do work2 within {time}")
        return verify(*game_of(text), corridor()[1], DELAY)

    takes = ceil(worst_case(*corridor()[0], corridor()[1], DELAY) or 0)
    assert within(takes + 1).ok
    assert "may be missed" in within(takes // 2).reason
    late = game_of(CORRIDOR.replace("reach_objective: do work2", f"reach_objective: do work2 within {takes + 1}"))
    whole = of_the_whole(late, corridor()[1])
    assert whole is not None
    assert verify(whole[0], late[1], whole[1], DELAY, prompt=True).ok


def test_a_clock_that_somebody_else_resets_is_not_waited_for() -> None:
    text = CORRIDOR + 'event "call"\nagent "guest" location bay can_do call\n'
    game = game_of(text)
    strategy = strategy_for(game)
    assert strategy is not None
    assert verify(*game, strategy, DELAY).ok
    k = next(k for k, block in enumerate(strategy.blocks) if block.commands)
    block = strategy.blocks[k]
    zone = (*block.commands[0].zones[0], Constraint(None, "Cguest", Fraction(-5), True))
    blocks = list(strategy.blocks)
    blocks[k] = replace(block, wait=((),), commands=(replace(block.commands[0], zones=(zone,)),))
    report = verify(*game, replace(strategy, blocks=tuple(blocks)), DELAY)
    assert not report.ok
    assert "Cguest" in report.reason


def test_who_may_receive_in_another_way_in_another_play_is_seen() -> None:
    """The first play sends before the other one sets the variable."""
    go, first = Sync("go", sends=True), Guard((ClockBound("C", ">=", 0),))
    heard = Sync("go", sends=False)
    sender = Automaton("one", (Location("a"), Location("b")), "a", (Edge("a", "b", first, go, resets=("C",)),))
    setter = Automaton("two", (Location("c"), Location("d")), "c", (Edge("c", "d", Guard(), None, (("v", 1),)),))
    rival = Edge("r0", "r2", Guard(integers=((Test("v", 1),),)), heard)
    locations = (Location("r0"), Location("r1"), Location("r2"))
    for rivals in ((), (rival,)):
        watcher = Automaton("three", locations, "r0", (Edge("r0", "r1", Guard(), heard), *rivals))
        network = Network(("C",), (("v", 0),), ("go",), (sender, setter, watcher))
        objective = Objective(Kind.REACH, (("two", "d"), ("three", "r1")))
        sent = (Move("one", sender.edges[0]), Move("three", watcher.edges[0]))
        zone = (Constraint(None, "C", Fraction(0), False),)
        before = (Constraint("C", None, Fraction(0), True),)
        blocks = (
            Block(DiscreteState((("one", "a"), ("three", "r0")), ()), (before,), (Command((zone,), sent),)),
            Block(DiscreteState((("one", "b"),), ()), ((),), ()),
            Block(DiscreteState((("two", "c"),), (("v", 0),)), (), (Command(((),), (Move("two", setter.edges[0]),)),)),
            Block(DiscreteState((("two", "d"),), ()), ((),), ()),
        )
        if rivals:
            with pytest.raises(Fault, match="three may receive go"):
                played_course(network, objective, Strategy(blocks), LimitMonitor())
        else:
            found = played_course(network, objective, Strategy(blocks), LimitMonitor())
            assert latest(found, Strategy(blocks), Fraction(0)) == 0


def test_what_a_guard_tests_has_to_be_named() -> None:
    """Else a command might not be enabled where its block holds."""
    text = CORRIDOR.replace("reach_objective", 'event "ready"\nrule "turn": ready before work1\nreach_objective', 1)
    game = game_of(text.replace("can_do work2", "can_do work2, ready"))
    strategy = strategy_for(game)
    assert strategy is not None
    k = next(k for k, block in enumerate(strategy.blocks) if "doing_work1" in str(block.commands))
    state = strategy.blocks[k].state
    assert [name for name, _ in state.values] == ["Pturn"]
    blocks = list(strategy.blocks)
    blocks[k] = replace(blocks[k], state=replace(state, values=()))
    report = verify(*game, replace(strategy, blocks=tuple(blocks)), DELAY)
    assert not report.ok
    assert "does not name" in report.reason
