"""The native checker and the one in Python say the same: of what wins, of what loses, and how it comes about."""

from __future__ import annotations

import contextlib
import functools
from dataclasses import replace
from fractions import Fraction
from itertools import count
from typing import Callable, Optional, Tuple, TypeVar
from unittest import mock

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import load
from pursue_gen.outcomes import LimitHit
from pursue_gen.proof import checker, simplify
from pursue_gen.proof.checker import ProofReport, pruned, pruned_ranks, verify
from pursue_gen.proof.closed_loop import ClosedLoop, Latest
from pursue_gen.proof.independence import named_part
from pursue_gen.proof.margin import strategy_margin
from pursue_gen.proof.worst_case import INSTANT, worst_case
from pursue_gen.solving.rules import IDEAL, Rules, played
from pursue_gen.synthesis.limits import NO_LIMITS, LimitMonitor
from pursue_gen.synthesis.solve import solve
from pursue_gen.synthesis.strategy import Constraint, Strategy
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Kind, Network, Objective
from tests.choices import member_of
from tests.conftest import thesis_scenario
from tests.oracle.checker import in_python
from tests.oracle.closed_loop import LoopInPython
from tests.oracle.delays import Broken
from tests.proof.test_checker import REACH, STRAIGHT, automaton, block, edge, moves, network
from tests.proof.test_checker_random import NEVER_L2, OBJECTIVES, _all_keys, _changed, networks
from tests.synthesis import random_games
from tests.synthesis.test_verdicts import published

T = TypeVar("T")
Look = Tuple[Network, Objective, Strategy, Fraction, Optional[bool], bool]
KINDS = (Kind.REACH, Kind.REACH_WHILE_SAFE, Kind.SAFETY)
REACTIONS = st.sampled_from((Fraction(0), Fraction(1, 3), Fraction(1, 2), Fraction(1)))
RANDOM = settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))


@pytest.fixture(scope="module", autouse=True)
def twin() -> None:
    """Each test uses both."""


def both(look: Callable[[], T]) -> T:
    """What both say."""
    with in_python():
        expected = look()
    assert look() == expected
    return expected


@st.composite
def looks(draw: st.DrawFn) -> Look:
    """A game, a strategy that wins it or is changed a little, how it is played, and whether ranks help."""
    if draw(st.booleans()):
        net, objective = draw(random_games.started(KINDS))
    else:
        net, objective = draw(networks()), draw(OBJECTIVES)
    reaction = draw(REACTIONS)
    verdict = solve(net, objective, draw(member_of((Fraction(0), reaction))))
    strategy = verdict.strategy or Strategy(())
    for _ in range(draw(st.integers(0, 3))):
        if _all_keys(strategy):
            strategy = _changed(draw, strategy)
    return net, objective, strategy, reaction, draw(member_of((None, False, True))), draw(st.booleans())


@RANDOM
@given(looks(), st.sampled_from((0, 2, 10, 300_000)), st.sampled_from((1, 8)))
def test_they_agree_on_strategies_that_win_or_lose(look: Look, limit: int, many: int) -> None:
    net, objective, strategy, reaction, prompt, ranked = look
    ranks = {key: n % 5 for n, key in enumerate(_all_keys(strategy))} if ranked else None
    with mock.patch.object(checker, "_MANY_ZONES", many):
        both(lambda: verify(net, objective, strategy, reaction, limit=limit, prompt=prompt, ranks=ranks))


@RANDOM
@given(networks(), OBJECTIVES, REACTIONS, st.booleans())
def test_they_agree_with_the_solver_s_ranks_and_on_fewer_zones(
    net: Network, objective: Objective, reaction: Fraction, ranked: bool
) -> None:
    verdict = solve(net, objective, reaction)
    if verdict.strategy is None:
        return
    strategy, ranks = verdict.strategy, verdict.ranks if ranked else None
    report = both(lambda: verify(net, objective, strategy, reaction, prompt=False, ranks=ranks))
    assert report.ok
    kept, left = pruned(strategy, report), None if ranks is None else pruned_ranks(strategy, report, ranks)
    both(lambda: simplify.simplified(net, kept, reaction, left))


@RANDOM
@given(looks())
def test_they_agree_on_what_covers_itself(look: Look) -> None:
    net, _, strategy, reaction, _, _ = look
    with mock.patch.object(checker, "_LARGE", 0):
        both(lambda: verify(net, NEVER_L2, strategy, reaction, prompt=False))


@RANDOM
@given(looks())
def test_they_agree_on_the_worst_time(look: Look) -> None:
    net, objective, strategy, reaction, _, _ = look
    both(lambda: worst_case(net, objective, strategy, reaction))


@RANDOM
@given(st.data(), looks(), st.sampled_from((2, 1_000)))
def test_they_agree_on_the_worst_time_from_the_middle_of_a_play(data: st.DataObject, look: Look, limit: int) -> None:
    net, objective, strategy, reaction, _, _ = look
    loop = ClosedLoop(net, objective, strategy, reaction, None, INSTANT)
    played_in_python, entry = LoopInPython(loop), loop.start
    with contextlib.suppress(Broken):
        for _ in range(data.draw(st.integers(0, 4))):
            entry = data.draw(member_of([after for _, after in played_in_python.successors(entry)] or [entry]))
    both(lambda: loop.latest(1, limit, LimitMonitor(), start=entry))


@RANDOM
@given(looks(), st.sampled_from((0, 1, 4)))
def test_they_agree_on_how_long_a_location_is_not_left(look: Look, many: int) -> None:
    net, objective, strategy, reaction, _, _ = look
    left = 0, net.automata[0].locations[0].name

    def latest() -> Latest:
        loop = ClosedLoop(net, objective, strategy, reaction, None, INSTANT)
        return loop.latest(1, 1_000, LimitMonitor(NO_LIMITS), left, many)

    both(latest)


@settings(RANDOM, max_examples=40)
@given(networks(), OBJECTIVES, st.sampled_from((10, 300_000)))
def test_they_agree_on_the_margin(net: Network, objective: Objective, states: int) -> None:
    strategy = solve(net, objective).strategy
    if strategy is not None:
        both(lambda: strategy_margin(net, objective, strategy, Fraction(0), states))


def slower(net: Network, strategy: Strategy, factor: int) -> Tuple[Network, Strategy]:
    """Both with every time multiplied."""

    def bounds(some: Tuple[ClockBound, ...]) -> Tuple[ClockBound, ...]:
        return tuple(replace(bound, bound=bound.bound * factor) for bound in some)

    def constraints(some: Tuple[Constraint, ...]) -> Tuple[Constraint, ...]:
        return tuple(replace(c, bound=c.bound * factor) for c in some)

    def automaton_of(one: Automaton) -> Automaton:
        locations = tuple(replace(place, invariant=bounds(place.invariant)) for place in one.locations)
        edges = tuple(replace(e, guard=replace(e.guard, clocks=bounds(e.guard.clocks))) for e in one.edges)
        return replace(one, locations=locations, edges=edges)

    longer = replace(net, start=constraints(net.start), automata=tuple(map(automaton_of, net.automata)))
    edges = {
        (old.name, before): after
        for old, new in zip(net.automata, longer.automata)
        for before, after in zip(old.edges, new.edges)
    }
    blocks = tuple(
        replace(
            one,
            wait=tuple(map(constraints, one.wait)),
            commands=tuple(
                replace(
                    c,
                    zones=tuple(map(constraints, c.zones)),
                    moves=tuple(replace(m, edge=edges[m.automaton, m.edge]) for m in c.moves),
                )
                for c in one.commands
            ),
        )
        for one in strategy.blocks
    )
    return longer, replace(strategy, blocks=blocks)


@RANDOM
@given(looks(), st.sampled_from([10**3, 10**4, 10**5, 10**6, 2**25, 2**27, 10**9, 2**40, 2**48, 2**55, 10**30]))
def test_times_of_any_size_change_nothing(look: Look, factor: int) -> None:
    """32 bits hold the first, 64 bits more; the rest is refused."""
    net, objective, strategy, reaction, prompt, _ = look
    longer, plan = slower(net, strategy, factor)
    late = reaction * factor
    try:
        found = verify(longer, objective, plan, late, prompt=prompt)
    except LimitHit as problem:
        assert problem.diagnostics[0].code == "SYN012" and factor > 10**6
        return
    with in_python():
        assert verify(longer, objective, plan, late, prompt=prompt) == found
    if prompt is False:  # the instants after another do not grow with the times
        short = verify(net, objective, strategy, reaction, prompt=prompt)
        assert (short.ok, short.reason, short.used) == (found.ok, found.reason, found.used)


@pytest.mark.parametrize("rules", [IDEAL, Rules()], ids=["ideal", "default"])
@pytest.mark.parametrize("number", ["1", "2", "3", "4"])
def test_they_agree_on_the_thesis_s_scenarios(number: str, rules: Rules) -> None:
    scenario = load(thesis_scenario(number))
    net, objective = played(translate(scenario), rules), scenario_objective(scenario)
    verdict = solve(net, objective, rules.reaction)
    assert verdict.strategy is not None
    strategy, ranks = verdict.strategy, verdict.ranks
    report = both(lambda: verify(net, objective, strategy, rules.reaction, ranks=ranks))
    assert report.ok
    few = both(lambda: simplify.simplified(net, pruned(strategy, report), rules.reaction))
    assert both(lambda: worst_case(net, objective, few, rules.reaction)) is not None
    assert both(lambda: strategy_margin(net, objective, few, rules.reaction, 3_000)).wins > 0


@pytest.mark.parametrize("name", ["CT1", "EB1", "WC1"])
def test_they_agree_on_published_games(reference_dir, name: str) -> None:
    net, objective = published(reference_dir, name)
    strategy = solve(net, objective).strategy
    assert strategy is not None
    assert both(lambda: verify(net, objective, strategy)).ok
    for b in range(0, len(strategy.blocks), 1 + len(strategy.blocks) // 6):
        worse = replace(strategy, blocks=strategy.blocks[:b] + strategy.blocks[b + 1 :])
        both(functools.partial(verify, net, objective, worse))


GO = moves(STRAIGHT, ("bot", 0))
CAT = network(automaton("cat", "a win", edge("a", "win")))


@pytest.mark.parametrize(
    "one",
    [
        block(STRAIGHT, "a", ["z<=1"]),
        block(STRAIGHT, "a", ["x<=1"], ("z>1", GO)),
        block(STRAIGHT, "nowhere", ["x<=1"], ("x>1", GO)),
        block(STRAIGHT, "a b", ["x<=1"]),
        block(STRAIGHT, "a", ["x<=1"], ("x>1", ())),
        block(STRAIGHT, "a", ["x<=1"], ("x>1", moves(CAT, ("cat", 0)))),
    ],
)
def test_what_does_not_fit_together_is_refused_by_both_with_the_same_words(one: object) -> None:
    def outcome() -> object:
        try:
            return verify(STRAIGHT, REACH, Strategy((one,)))  # type: ignore[arg-type]
        except PursueError as problem:
            return problem.diagnostics

    with in_python():
        expected = outcome()
    found = outcome()
    assert found == expected and not (isinstance(found, ProofReport) and found.ok)


@st.composite
def crowded(draw: st.DrawFn) -> Network:
    """A game with many clocks more, which edges reset, in between."""
    net, more = draw(networks()), [f"z{k}" for k in range(draw(member_of((37, 38, 62, 94, 125))))]
    numbers = count()

    def resetting(one: Edge) -> Edge:
        return replace(one, resets=(*one.resets, *more[next(numbers) :: 7]))

    clocks = draw(st.permutations((*net.clocks, *more)))
    return replace(net.with_each(lambda a: a.with_edges(map(resetting, a.edges))), clocks=tuple(clocks))


@settings(RANDOM, max_examples=4)
@given(st.data(), crowded(), OBJECTIVES, REACTIONS)
def test_they_agree_however_many_clocks_there_are(
    data: st.DataObject, net: Network, objective: Objective, reaction: Fraction
) -> None:
    strategy = solve(net, objective, reaction).strategy
    if strategy is None:
        return
    report = both(lambda: verify(net, objective, strategy, reaction, prompt=False))
    assert report.ok
    both(lambda: simplify.simplified(named_part(net, strategy), pruned(strategy, report), reaction))
    both(lambda: worst_case(net, objective, strategy, reaction))
    if _all_keys(strategy):
        changed = _changed(data.draw, strategy)
        both(lambda: verify(net, objective, changed, reaction))


@pytest.mark.parametrize(("clocks", "time"), [(136, 1), (2, 10**30)])
def test_what_the_checker_cannot_hold_it_refuses(clocks: int, time: int) -> None:
    many = replace(STRAIGHT, clocks=(*STRAIGHT.clocks, *(f"z{k}" for k in range(clocks - len(STRAIGHT.clocks)))))
    net, plan = slower(many, Strategy((block(STRAIGHT, "a", ["x<=1"], ("x>1", GO)),)), time)
    uses: Tuple[Callable[[], object], ...] = (
        lambda: verify(net, REACH, plan),
        lambda: simplify.simplified(net, plan, Fraction(0)),
    )
    for use in uses:
        with pytest.raises(LimitHit, match="the checker cannot hold the game"):
            use()
    assert worst_case(net, REACH, plan) is None
