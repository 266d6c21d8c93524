"""The checker: small games with good strategies and with each way to fail, and the published plans."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Sequence, Set, Tuple

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from benchmarks.families import clean_by_robots
from pursue_gen.diagnostics import PursueError
from pursue_gen.language import parse
from pursue_gen.proof import checker
from pursue_gen.proof.checker import ProofReport, pruned, verify
from pursue_gen.proof.closed_loop import ClosedLoop, Depth
from pursue_gen.solving.rules import Rules, played
from pursue_gen.synthesis.limits import LimitMonitor
from pursue_gen.synthesis.plan import read_plan
from pursue_gen.synthesis.solve import solve
from pursue_gen.synthesis.strategy import Block, Command, Constraint, DiscreteState, Move, Strategy, Zone
from pursue_gen.tga import scenario_objective, translate
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
)
from pursue_gen.tga.uppaal import read_network, read_query

HALF = Fraction(1, 2)
REACH = Objective(Kind.REACH, goal=(("bot", "win"),))
SAFETY = Objective(Kind.SAFETY, bad=(("bot", "lose"),))
BOTH = Objective(Kind.REACH_WHILE_SAFE, goal=(("bot", "win"),), bad=(("bot", "lose"),))


def zone(text: str) -> Zone:
    """A zone from bounds like `x<=3` or `x>1`, with commas between them."""
    constraints = []
    for bound in filter(None, text.split(",")):
        clock, op, number = next(bound.partition(op) for op in ("<=", ">=", "<", ">") if op in bound)
        if op[0] == "<":
            constraints.append(Constraint(clock, None, Fraction(number), op == "<"))
        else:
            constraints.append(Constraint(None, clock, -Fraction(number), op == ">"))
    return tuple(constraints)


def bounds(text: str) -> Tuple[ClockBound, ...]:
    """Clock bounds of a guard or an invariant from the same notation."""
    parts = (next(b.partition(op) for op in ("<=", ">=", "==", "<", ">") if op in b) for b in text.split(",") if b)
    return tuple(ClockBound(clock, op, int(number)) for clock, op, number in parts)


def edge(source: str, target: str, guard: str = "", sync: str = "", resets: str = "", env: bool = False) -> Edge:
    """An edge; `sync` like `go!` or `go?`."""
    channel = Sync(sync[:-1], sync.endswith("!")) if sync else None
    return Edge(source, target, Guard(bounds(guard)), channel, resets=tuple(resets), controllable=not env)


def automaton(name: str, places: str, *edges: Edge) -> Automaton:
    """An automaton; `places` like `a:x<=3 win`, the first is the initial one."""
    parts = [place.partition(":") for place in places.split()]
    return Automaton(name, tuple(Location(p, bounds(inv)) for p, _, inv in parts), parts[0][0], edges)


def network(*automata: Automaton) -> Network:
    """A network with clocks x and y."""
    channels = {e.sync.channel for a in automata for e in a.edges if e.sync}
    return Network(("x", "y"), (), tuple(sorted(channels)), automata)


def block(net: Network, places: str, wait: Sequence[str] = (), *commands: Tuple[str, Tuple[Move, ...]]) -> Block:
    """A block: locations in order, zones to wait in, (zones with `|` between them, moves)."""
    state = DiscreteState(tuple(zip((a.name for a in net.automata), places.split())), ())
    return Block(
        state,
        tuple(map(zone, wait)),
        tuple(Command(tuple(map(zone, zones.split("|"))), moves) for zones, moves in commands),
    )


def moves(net: Network, *numbers: Tuple[str, int]) -> Tuple[Move, ...]:
    """Moves by the name of the automaton and the number of its edge."""
    return tuple(Move(name, net.automaton(name).edges[k]) for name, k in numbers)


def checked(
    net: Network, objective: Objective, *blocks: Block, reaction: Fraction = Fraction(0), prompt: bool = False
) -> ProofReport:
    return verify(net, objective, Strategy(blocks), reaction, prompt=prompt)


def kind(report: ProofReport) -> str:
    """'ok' or the kind of failure."""
    assert report.ok == (report.reason == "")
    return "ok" if report.ok else report.reason.split(":")[0]


STRAIGHT = network(automaton("bot", "a win", edge("a", "win", "x>1")))
GO = moves(STRAIGHT, ("bot", 0))


@pytest.mark.parametrize(
    ("wait", "command", "reaction", "outcome"),
    [
        (["x<=1"], "x>1", Fraction(0), "ok"),
        (["x<=1"], "x>1", HALF, "ok"),
        (["x<=1"], "x>1,x<=2|x>2,x<3", Fraction(0), "ok"),
        (["x<1", "x>=1,x<=2"], "x>2", Fraction(0), "ok"),
        (["x<1"], "x>1", Fraction(0), "not covered"),
        (["x<=1"], "x>2", Fraction(0), "not covered"),
        ([], "x>1", Fraction(0), "not covered"),
        (["x<1"], "x>=1", Fraction(0), "not enabled"),
        (["x<=2"], "x>1", Fraction(0), "contradiction"),
        ([""], "x>3,x<2", Fraction(0), "waits for ever"),
    ],
)
def test_a_point_is_waited_in_or_acted_in_and_the_guard_holds(
    wait: Sequence[str], command: str, reaction: Fraction, outcome: str
) -> None:
    report = checked(STRAIGHT, REACH, block(STRAIGHT, "a", wait, (command, GO)), reaction=reaction)
    assert kind(report) == outcome


def test_a_failure_says_where() -> None:
    report = checked(STRAIGHT, REACH, block(STRAIGHT, "a", ["x<1"], ("x>1", GO)))
    assert report.play == ("then: bot.a x=1 y=1",)


def test_an_unknown_discrete_state_fails_and_the_play_to_it_is_reported() -> None:
    net = network(automaton("bot", "a b win", edge("a", "b", "x>1", "step!"), edge("b", "win")))
    report = checked(net, REACH, block(net, "a", ["x<=1"], ("x>1", moves(net, ("bot", 0)))))
    assert kind(report) == "no block"
    assert report.play[0] == "controller: step (bot.a -> bot.b)"
    assert report.play[1].startswith("then: bot.b x=")


@pytest.mark.parametrize(("command", "outcome"), [("x>1,x<=5/2", "ok"), ("x>1,x<=3", "may come too late")])
def test_a_command_may_take_effect_late(command: str, outcome: str) -> None:
    net = network(automaton("bot", "a:x<=3 win", edge("a", "win", "x>1")))
    rest = ["x<=1", "x>5/2"] if outcome == "ok" else ["x<=1"]
    plan = block(net, "a", rest, (command, moves(net, ("bot", 0))))
    assert kind(checked(net, REACH, plan, reaction=HALF)) == outcome
    assert kind(checked(net, REACH, plan)) == "ok"


@pytest.mark.parametrize(
    ("objective", "guard", "own", "outcome"),
    [
        (REACH, "y>2", "", "ok"),
        (REACH, "y>3", "", "may come too late"),
        (SAFETY, "y>2", "", "ok"),
        (SAFETY, "y>3", "", "may come too late"),
        (SAFETY, "y>2", ":x<=3", "may come too late"),
    ],
)
def test_a_command_is_not_late_where_somebody_else_has_to_move_before_it_comes(
    objective: Objective, guard: str, own: str, outcome: str
) -> None:
    bot = automaton("bot", f"a{own} win lose", edge("a", "win", "x>1"))
    net = network(bot, automaton("other", "c:y<=3 d", edge("c", "d", guard, env=True)))
    go = moves(net, ("bot", 0))
    plan = [block(net, "a c", ["x<=2"], ("x>2", go)), block(net, "a d", [], ("", go))]
    plan += [block(net, "win c", [""]), block(net, "win d", [""])]
    assert kind(checked(net, objective, *plan, reaction=HALF)) == outcome


@pytest.mark.parametrize(
    ("bot", "other", "reach", "safety"),
    [
        (edge("a", "win", "x>1"), edge("c", "d", "y>9", env=True), "time is blocked", "time is blocked"),
        (edge("a", "win", "x>1"), edge("c", "d", "y>2", env=True), "ok", "time is blocked"),
        (edge("a", "win", "x>1", env=True), edge("c", "d", "y>9", env=True), "ok", "time is blocked"),
        (edge("a", "win", "x>1", env=True), edge("c", "d", "y>2", env=True), "ok", "ok"),
        (edge("a", "win", "x>5", env=True), edge("c", "d", "y>9", env=True), "time is blocked", "time is blocked"),
    ],
)
def test_at_the_end_of_invariants_one_must_be_able_to_move_to_reach_and_all_to_be_safe(
    bot: Edge, other: Edge, reach: str, safety: str
) -> None:
    net = network(automaton("bot", "a:x<=3 win lose", bot), automaton("other", "c:y<=3 d", other))
    go = [("x>2", moves(net, ("bot", 0)))] if bot.controllable else []
    plan = [
        block(net, "a c", ["x<=3"]),
        block(net, "a d", ["x<=2"] if go else ["x<=3"], *go),
        block(net, "win c", [""]),
        block(net, "win d", [""]),
    ]
    assert kind(checked(net, REACH, *plan)) == reach
    assert kind(checked(net, SAFETY, *plan)) == safety


def test_another_automaton_that_must_move_does_not_unblock_the_one_at_its_bound() -> None:
    bot = automaton("bot", "a:x<=3 win", edge("a", "win", "x>1"))
    net = network(bot, automaton("other", "c d", edge("c", "d", "y>2", env=True)))
    plan = [block(net, "a c", ["x<=3"]), block(net, "a d", ["x<=1"], ("x>1", GO))]
    assert kind(checked(net, REACH, *plan)) == "time is blocked"


def test_waiting_for_ever_is_safe() -> None:
    net = network(automaton("bot", "a lose", edge("a", "lose", "x>1")))
    assert kind(checked(net, SAFETY, block(net, "a", [""]))) == "ok"


def test_a_strict_invariant_never_obliges_anyone() -> None:
    net = network(automaton("bot", "a:x<3 win", edge("a", "win", "x>1", env=True)))
    assert kind(checked(net, REACH, block(net, "a", [""]))) == "time is blocked"


@pytest.mark.parametrize(("guard", "outcome"), [("x>2", "ok"), ("x>1", "bad"), ("x>=2", "bad")])
def test_the_environment_wins_races(guard: str, outcome: str) -> None:
    net = network(automaton("bot", "a b lose", edge("a", "b", "x>1"), edge("a", "lose", guard, env=True)))
    plan = [block(net, "a", ["x<=1"], ("x>1,x<=2", moves(net, ("bot", 0)))), block(net, "b", [""])]
    assert kind(checked(net, SAFETY, *plan)) == outcome
    late = checked(net, SAFETY, *plan, reaction=HALF)
    assert kind(late) == "bad"
    assert late.play[0] == "environment: tau (bot.a -> bot.lose)"


def test_a_prompt_player_leaves_an_open_zone_before_something_new_can_happen() -> None:
    net = network(automaton("bot", "a b lose", edge("a", "b", "x>1"), edge("a", "lose", "x>2", env=True)))
    plan = [block(net, "a", ["x<=1"], ("x>1", moves(net, ("bot", 0)))), block(net, "b", [""])]
    assert kind(checked(net, SAFETY, *plan)) == "bad"
    assert kind(checked(net, SAFETY, *plan, prompt=True)) == "ok"
    assert kind(verify(net, SAFETY, Strategy(tuple(plan)))) == "ok"


def test_a_prompt_player_loses_a_race_of_two_open_guards() -> None:
    net = network(automaton("bot", "a b lose", edge("a", "b", "x>1"), edge("a", "lose", "x>1", env=True)))
    plan = [block(net, "a", ["x<=1"], ("x>1", moves(net, ("bot", 0)))), block(net, "b", [""])]
    assert kind(checked(net, SAFETY, *plan, prompt=True)) == "bad"


def test_the_goal_counts_before_the_bad_location() -> None:
    bad = replace(BOTH, bad=(("bot", "win"),))
    plan = block(STRAIGHT, "a", ["x<=1"], ("x>1", GO))
    assert kind(checked(STRAIGHT, bad, plan)) == "ok"
    assert kind(checked(STRAIGHT, replace(bad, bad=(("bot", "a"),)), plan)) == "bad"


def test_the_goal_is_all_of_its_locations_and_any_bad_location_loses() -> None:
    bot, mate = (automaton(name, "a win", edge("a", "win", after)) for name, after in (("bot", "x>1"), ("mate", "x>3")))
    net = network(bot, mate)
    first, second = moves(net, ("bot", 0)), moves(net, ("mate", 0))
    one = block(net, "a a", ["x<=1"], ("x>1", first))
    two = block(net, "win a", ["x<=3"], ("x>3", second))
    both = Objective(Kind.REACH, goal=(("bot", "win"), ("mate", "win")))
    assert kind(checked(net, both, one, two)) == "ok"
    assert kind(checked(net, both, one)) == "no block"
    assert kind(checked(net, REACH, one)) == "ok"
    guarded = Objective(Kind.REACH_WHILE_SAFE, both.goal, bad=(("mate", "lose"), ("bot", "lose")))
    hurt = network(
        automaton("bot", "a win lose", edge("a", "win", "x>1"), edge("win", "lose", "x>5", env=True)),
        automaton("mate", "a win lose", edge("a", "win", "x>3")),
    )
    second = moves(hurt, ("mate", 0))
    soon, late = block(hurt, "win a", ["x<=3"], ("x>3,x<=4", second)), block(hurt, "win a", ["x<=6"], ("x>6", second))
    start = block(hurt, "a a", ["x<=1"], ("x>1,x<=2", moves(hurt, ("bot", 0))))
    assert kind(checked(hurt, guarded, start, soon)) == "ok"
    assert kind(checked(hurt, guarded, start, late)) == "bad"


def test_commands_are_the_controllers_and_everyone_who_can_receive_takes_part() -> None:
    net = network(
        automaton("bot", "a win", edge("a", "win", "x>1", "go!"), edge("a", "win", "x>1", env=True)),
        automaton("one", "c d", edge("c", "d", sync="go?")),
        automaton("two", "c d", edge("c", "d", sync="go?")),
    )

    def outcome(*numbers: Tuple[str, int]) -> str:
        return kind(checked(net, REACH, block(net, "a c c", ["x<=1"], ("x>1", moves(net, *numbers)))))

    assert outcome(("bot", 0), ("one", 0), ("two", 0)) == "ok"
    assert outcome(("bot", 0), ("two", 0), ("one", 0)) == "ok"
    assert outcome(("bot", 0), ("one", 0)) == "not a joint move"
    assert outcome(("bot", 0)) == "not a joint move"
    assert outcome(("one", 0), ("bot", 0), ("two", 0)) == "not a joint move"
    assert outcome(("bot", 1)) == "not controllable"


def test_a_receiver_of_the_environment_makes_the_move_its_own() -> None:
    net = network(
        automaton("bot", "a win", edge("a", "win", "x>1", "go!")),
        automaton("one", "c d", edge("c", "d", "", "go?", env=True)),
    )
    plan = block(net, "a c", ["x<=1"], ("x>1", moves(net, ("bot", 0), ("one", 0))))
    assert kind(checked(net, REACH, plan)) == "not controllable"


def test_a_sender_is_held_up_by_the_invariant_of_a_receivers_target() -> None:
    net = network(
        automaton("bot", "a win", edge("a", "win", "x>1", "go!")),
        automaton("one", "c d:y<=2", edge("c", "d", "", "go?")),
    )
    go = moves(net, ("bot", 0), ("one", 0))
    assert kind(checked(net, REACH, block(net, "a c", ["x<=1"], ("x>1", go)))) == "not enabled"
    assert kind(checked(net, REACH, block(net, "a c", ["x<=1"], ("x>1,x<=2", go)))) == "ok"


@pytest.mark.parametrize("resets", ["x", "xy"])
def test_a_play_that_goes_round_does_not_reach(resets: str) -> None:
    round_trip = (edge("a", "b", "x>1", resets=resets), edge("b", "a", "x>1", resets="x"))
    net = network(automaton("bot", "a b win", *round_trip, edge("a", "win")))
    there, back = moves(net, ("bot", 0)), moves(net, ("bot", 1))
    plan = [block(net, "a", ["x<=1"], ("x>1", there)), block(net, "b", ["x<=1"], ("x>1", back))]
    assert kind(checked(net, REACH, *plan)) == "for ever"


def test_going_round_until_a_clock_is_late_enough_reaches() -> None:
    net = network(automaton("bot", "a win", edge("a", "a", "x>=1", resets="x"), edge("a", "win", "y>=5")))
    again, leave = moves(net, ("bot", 0)), moves(net, ("bot", 1))
    plan = block(net, "a", ["x<1,y<5"], ("x>=1,y<5", again), ("y>=5", leave))
    assert kind(checked(net, REACH, plan)) == "ok"


def test_only_the_command_that_comes_first_counts() -> None:
    net = network(automaton("bot", "a b win lose", edge("a", "win", "x>=1"), edge("a", "lose", "x>=1")))
    good, bad = moves(net, ("bot", 0)), moves(net, ("bot", 1))
    first = block(net, "a", ["x<1", "x>2,x<3"], ("x>=1,x<=2", good), ("x>=3", bad))
    assert kind(checked(net, BOTH, first)) == "ok"
    either = block(net, "a", ["x<1"], ("x>=1,x<=2", good), ("x>=1,x<=2", bad))
    assert kind(checked(net, BOTH, either)) == "bad"
    assert kind(checked(net, BOTH, either, prompt=True)) == "bad"


@pytest.mark.parametrize(("wait", "again", "outcome"), [([], "x>1", "for ever"), (["x>1,x<=3/2"], "x>3/2", "ok")])
@pytest.mark.parametrize("by", ["bot", "mate"])
def test_another_command_may_be_decided_while_one_is_on_its_way(
    wait: Sequence[str], again: str, outcome: str, by: str
) -> None:
    bot = automaton("bot", "a win", edge("a", "win", "x<=3"), edge("a", "a", resets="x"))
    net = network(bot, automaton("mate", "b", edge("b", "b", resets="x"), edge("b", "b", resets="x")))
    plan = block(net, "a b", wait, ("x<=1", moves(net, ("bot", 0))), (again, moves(net, (by, 1))))
    assert kind(checked(net, REACH, plan, reaction=HALF)) == outcome
    assert kind(checked(net, REACH, plan)) == "ok"


def test_limits_and_strategies_of_the_other_side() -> None:
    plan = Strategy((block(STRAIGHT, "a", ["x<=1"], ("x>1", GO)),))
    assert kind(verify(STRAIGHT, REACH, plan, limit=0)) == "limit"
    assert kind(verify(STRAIGHT, REACH, replace(plan, counter=True))) == "counter-strategy"


def test_where_the_hull_of_many_zones_fails_they_are_checked_one_by_one() -> None:
    scenario = parse(clean_by_robots(1), "cleaning.pur", "cleaning")
    net, objective = played(translate(scenario), Rules()), scenario_objective(scenario)
    reaction = Fraction(1, 10)
    strategy = solve(net, objective, reaction).strategy
    assert strategy is not None
    loop = ClosedLoop(net, objective, strategy, reaction, None)
    at_once, one_by_one = (
        loop.everything(Depth(False, False, checker.LIMIT, many), LimitMonitor()) for many in (1, 0)
    )
    assert one_by_one.states > len({b for b, _, _ in one_by_one.used}), "some discrete state has several zones"
    assert at_once == one_by_one and at_once.failure is None


def test_unused_parts_are_pruned() -> None:
    unused = block(STRAIGHT, "win", [""])
    plan = Strategy((unused, block(STRAIGHT, "a", ["x<=1", "y>7,x<1"], ("x>1|x<1,y>2", GO), ("x>1,y<1", GO))))
    report = verify(STRAIGHT, REACH, plan)
    assert report.ok
    less = pruned(plan, report)
    assert less == Strategy((block(STRAIGHT, "a", ["x<=1"], ("x>1", GO)),))
    assert verify(STRAIGHT, REACH, less).ok


def test_networks_and_strategies_that_cannot_be_read_are_reported() -> None:
    plan = Strategy((block(STRAIGHT, "a", ["x<=1"], ("x>1", GO)),))
    hears = network(automaton("bot", "a win", edge("a", "win", "x>1", "go?")))
    lower = network(automaton("bot", "a:x>=0 win", edge("a", "win")))
    for net, objective, strategy, reaction in (
        (hears, REACH, plan, Fraction(0)),
        (lower, REACH, plan, Fraction(0)),
        (STRAIGHT, replace(REACH, goal=(("bot", "nowhere"),)), plan, Fraction(0)),
        (STRAIGHT, replace(REACH, goal=None), plan, Fraction(0)),
        (STRAIGHT, REACH, Strategy((block(STRAIGHT, "a", ["z<=1"]),)), Fraction(0)),
        (STRAIGHT, REACH, plan, Fraction(-1)),
    ):
        with pytest.raises(PursueError):
            verify(net, objective, strategy, reaction)


@pytest.mark.parametrize(("ranks", "outcome"), [((2, 1), "ok"), ((1, 2), "ok"), ((1, 1), "ok")])
def test_ranks_of_one_step_are_no_matter(ranks: Tuple[int, int], outcome: str) -> None:
    plan = Strategy((block(STRAIGHT, "a", ["x<=1"], ("x>1", GO)),))
    given_ranks = {(0, "wait", 0): ranks[0], (0, 0, 0): ranks[1]}
    assert kind(verify(STRAIGHT, REACH, plan, ranks=given_ranks)) == outcome


def test_no_ranks_pass_a_play_that_goes_round() -> None:
    net = network(automaton("bot", "a b win", edge("a", "b", resets="x"), edge("b", "a", resets="x"), edge("a", "win")))
    there, back = moves(net, ("bot", 0)), moves(net, ("bot", 1))
    plan = Strategy((block(net, "a", [], ("", there)), block(net, "b", [], ("", back))))
    for one in range(3):
        for two in range(3):
            assert not verify(net, REACH, plan, ranks={(0, 0, 0): one, (1, 0, 0): two}).ok


def published(reference_dir: Path, name: str) -> Tuple[Network, Objective, Strategy]:
    folder = reference_dir / name
    net = read_network((folder / "TGA.xml").read_text(errors="replace"), f"{name}/TGA.xml")
    objective = read_query((folder / "TCTL.q").read_text(), f"{name}/TCTL.q")
    return net, objective, read_plan((folder / "UPPAAL_plan.txt").read_text(errors="replace"), net, f"{name}/plan")


def used_blocks(report: ProofReport) -> Set[int]:
    return {b for b, _, _ in report.used}


@pytest.mark.parametrize("name", ["CT1", "CT2a", "CT4", "CT5", "WC1", "EB1", "EB2", "EB3"])
def test_published_plans_win_the_ideal_game(reference_dir: Path, name: str, twin: str) -> None:
    if twin == "python" and name in ("CT5", "EB2"):
        pytest.skip("takes the readable twin seconds")
    net, objective, plan = published(reference_dir, name)
    report = verify(net, objective, plan)
    assert report.ok, report
    less = pruned(plan, report)
    assert len(less.blocks) == len(used_blocks(report))
    assert verify(net, objective, less).ok


@pytest.mark.parametrize("prompt", [False, True])
@pytest.mark.parametrize("name", ["CT1", "CT2a", "CT4"])
def test_published_plans_need_a_player_without_delay(reference_dir: Path, name: str, prompt: bool) -> None:
    net, objective, plan = published(reference_dir, name)
    report = verify(net, objective, plan, Fraction(1, 32), prompt=prompt)
    assert kind(report) in ("may come too late", "for ever", "not covered", "no block")


@pytest.mark.parametrize("name", ["WC1", "EB1", "CT1"])
def test_every_command_that_plays_reach_is_needed_in_its_zone(reference_dir: Path, name: str) -> None:
    net, objective, plan = published(reference_dir, name)
    plan = pruned(plan, verify(net, objective, plan))
    for b, one in list(enumerate(plan.blocks))[:8]:
        for k, command in enumerate(one.commands):
            for instead in ((), (replace(command, zones=((),)),))[: 2 if one.wait else 1]:
                changed = replace(one, commands=one.commands[:k] + instead + one.commands[k + 1 :])
                broken = replace(plan, blocks=plan.blocks[:b] + (changed,) + plan.blocks[b + 1 :])
                assert not verify(net, objective, broken).ok


@settings(max_examples=20, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.data())
def test_a_plan_passes_iff_no_block_is_missing_that_plays_reach(reference_dir: Path, data: st.DataObject) -> None:
    net, objective, plan = published(reference_dir, "CT1")
    needed = used_blocks(verify(net, objective, plan))
    spare = sorted(set(range(len(plan.blocks))) - needed)
    missing = set(data.draw(st.lists(st.sampled_from(spare))))
    missing |= set(data.draw(st.lists(st.sampled_from(sorted(needed)), max_size=2)))
    rest = replace(plan, blocks=tuple(one for b, one in enumerate(plan.blocks) if b not in missing))
    assert verify(net, objective, rest).ok == (not missing & needed)


def test_a_command_that_changes_nothing_keeps_no_time_from_passing() -> None:
    stay, renew = edge("a", "a", "x>=1"), edge("a", "a", "x>=1", resets="x")
    net = network(automaton("bot", "a:x<=2 lose", stay, renew), automaton("other", "o"))
    again = block(net, "a o", ("x<1",), ("x>=1", moves(net, ("bot", 0))))
    report = checked(net, SAFETY, again)
    assert kind(report) == "not a joint move" and report.reason.endswith("it changes nothing")
    assert kind(checked(net, SAFETY, block(net, "a o", ("x<1",), ("x>=1", moves(net, ("bot", 1)))))) == "ok"


def test_a_strategy_may_compare_a_clock_of_edges_that_are_never_taken() -> None:
    dead, free = edge("b", "a", "y>1"), edge("o", "p", env=True)
    net = network(automaton("bot", "a b lose", dead), automaton("other", "o:y<=9 p", free))
    named = DiscreteState((("bot", "a"),), ())
    assert checked(net, SAFETY, Block(named, (zone("y<=5"), zone("y>5")), ())).ok
    reset = edge("o", "p", resets="y", env=True)
    noticed = network(automaton("bot", "a b lose", dead), automaton("other", "o p", reset))
    report = checked(noticed, SAFETY, Block(named, (zone("y<=5"), zone("y>5")), ()))
    assert kind(report) == "left out" and report.reason.endswith("other resets y")
