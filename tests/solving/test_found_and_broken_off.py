"""What is decided with fewer moves, or by parts, where states are found out and events broken off: as in one piece."""

from __future__ import annotations

import random
from typing import List, Optional

from hypothesis import assume, given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError, Severity
from pursue_gen.language import check, parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.distances import times_to
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.rules import DEFAULT, played
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.synthesis.limits import Limits
from pursue_gen.synthesis.solve import solve
from pursue_gen.tga import scenario_objective, translate
from tests.tga.test_breaking_off import GARDEN
from tests.tga.test_unknown_states import LOST

STATES = ("unknown, shown_by look", "unknown seen_at p0", "unknown, true_if call0 shown_by look", "unknown seen_at p1")
WANTED = (
    "if call0 then ans0 within 25", "if call1 then ans1 within 18", "if call1 then job within 60",
    "patrol p1 every 40 by bot", "avoid s is_true and bot at p1", "if s is_true then job2 within 30",
    "if call0 then s is_true or s is_false within 30", "if guest at hub then not bot doing job within 4",
)  # fmt: skip


def house(draw: random.Random) -> str:
    """One or two robots with jobs that take long, and a guest who calls."""
    lines = ['poi "hub"', *(f'poi "p{k}"' for k in range(2))]
    lines += [f"connect hub and p{k} distance {draw.randint(1, 4)}" for k in range(2)]
    lines += [f'event "job" location p0 duration {draw.randint(5, 25)} may_stop']
    lines += [f'event "job2" location p1 duration {draw.randint(2, 15)}{draw.choice(("", " may_stop"))}']
    lines += [f'event "ans{k}" location {draw.choice(("hub", "p0", "p1"))}' for k in range(2)]
    lines += ['event "call0"', 'event "call1"', f'event "look"{draw.choice(("", " location p0 duration 2"))}']
    lines += [f'state "s": initially {draw.choice(STATES)}']
    for bot in ("bot", "bot2")[: draw.choice((1, 1, 2))]:
        lines += [f'agent "{bot}" controllable mobile 1 location hub can_do job, job2, ans0, ans1, look']
    lines += [f'agent "guest"{draw.choice(("", " mobile 1"))} location p0 can_do call0, call1']
    lines += draw.sample(["assume: guest waits 30 between call0", "assume: guest does call1 at_most 2 times"], 1)
    lines += [f"objective: {each}" for each in draw.sample(WANTED, draw.randint(1, 3))]
    lines += draw.choice(([], ["reach_objective: do job"], ["reach_objective: do job2 and look within 60"]))
    return "\n".join([*lines, ""])


def decided(scenario: Scenario) -> Optional[bool]:
    """Who wins, as the program finds it; None at its limits."""
    try:
        solve_scenario(scenario, DEFAULT, SolveOptions(limits=Limits(states=1500, work=300_000)))
    except PursueError as problem:
        return False if problem.diagnostics[0].code in LOST else None
    return True


@given(st.integers(0, 10**6))
@settings(max_examples=15)
def test_the_verdict_is_that_of_the_game_in_one_piece(seed: int) -> None:
    text = house(random.Random(seed))
    scenario = parse(text, "x.pur", "x")
    findings: List[str] = [each.code for each in check(scenario) if each.severity is Severity.ERROR]
    assume(not findings)
    network, limits = played(translate(scenario), DEFAULT), Limits(states=1500, work=300_000)
    try:
        won = solve(network, scenario_objective(scenario), DEFAULT.reaction, limits=limits, whole=True).won
    except PursueError:
        assume(False)
        raise
    assert decided(scenario) in (won, None), text


def test_who_may_break_off_is_elsewhere_sooner() -> None:
    at_work = "doing_prune_in_tomatoes"
    for text, takes in ((GARDEN, 1), (GARDEN.replace(" may_stop", ""), 21)):
        bot = translate(parse(text, "x.pur", "x")).automaton("bot")
        assert times_to(["bench"], bot)[at_work] == takes + 1 + 4, "a rest, and the way"
