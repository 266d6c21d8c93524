"""What a robot begins and ends at one place, unheard, is left out of the game, and nothing is decided otherwise."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Tuple

import pytest
from hypothesis import HealthCheck, event, given, settings
from hypothesis import strategies as st

from pursue_gen.language import parse
from pursue_gen.proof.checker import verify
from pursue_gen.solving.rules import DEFAULT, played
from pursue_gen.synthesis.cone import cone_of_influence
from pursue_gen.synthesis.solve import solve
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
    Test,
)
from tests.choices import member_of
from tests.synthesis.play_by_play import broken
from tests.synthesis.random_games import networks

HOUSE = """poi "hall"
poi "shop"
connect hall and shop distance 3
event "ring"
event "mop" location shop duration 2
event "beep" location hall
event "serve" location hall duration 1
{more}
agent "bot" controllable mobile 1 location hall can_do mop, beep, serve
agent "guest" location hall can_do ring
objective: if ring then serve within 40
"""


def _taken(more: str) -> set:
    """The channels on which the bot may send in the game."""
    scenario = parse(HOUSE.format(more=more), "house.pur", "house")
    part = cone_of_influence(played(translate(scenario), DEFAULT), scenario_objective(scenario))
    bot = next(a for a in part.automata if a.name == "bot")
    return {str(edge.sync.channel) for edge in bot.edges if edge.sync is not None}


@pytest.mark.parametrize(
    ("more", "taken"),
    [
        ("", {"serve"}),
        ('state "clean": initially false, true_if mop', {"serve"}),
        ('state "clean": initially false, true_if mop\nstateDependency: serve only_if clean is_true', {"serve", "mop"}),
        ('state "wet": initially false, true_if ring\nstateDependency: mop only_if wet is_true', {"serve"}),
        ('rule "first": beep before serve', {"serve", "beep"}),
        ("objective: if ring then mop within 90", {"serve", "mop"}),
    ],
)
def test_what_a_promise_does_not_need_is_no_command_of_its_game(more: str, taken: set) -> None:
    names = {name for name in _taken(more) if name in ("serve", "mop", "beep")}
    assert names == taken


# By hand --------------------------------------------------------------------------------------------------------------

AFTER = Guard((ClockBound("z", ">", 1),))
BEGIN = Edge("home", "work", AFTER, Sync("mop", True), (("d", 2),), ("z",))
END = Edge("work", "home", AFTER, Sync("mopped", True), (("d", 1),), ("z",), controllable=False)
AWAY = Edge("home", "far", AFTER, None, (("d", 3),), ("z",))
BACK = Edge("far", "home", AFTER, None, (("d", 1),), ("z",), controllable=False)
SHORT = (ClockBound("z", "<=", 3),)
LOCATIONS = (Location("home"), Location("work", SHORT), Location("far", SHORT))
WATCHED = Edge("safe", "bad", Guard((ClockBound("x", ">", 3),), ((Test("d", 3),),)), controllable=False)


def _house(*edges: Edge, watch: Tuple[Edge, ...] = (WATCHED,), locations: Tuple[Location, ...] = LOCATIONS) -> Network:
    robot = Automaton("bot", locations, "home", edges)
    watcher = Automaton("watch", (Location("safe"), Location("bad")), "safe", watch)
    return Network(("x", "z"), (("d", 1), ("v", 0)), ("mop", "mopped"), (robot, watcher))


NEVER = Objective(Kind.SAFETY, bad=(("watch", "bad"),))


def _begins(network: Network, objective: Objective = NEVER) -> bool:
    robot = cone_of_influence(network, objective).automaton("bot")
    return any(edge.target == "work" for edge in robot.edges)


def test_work_that_nobody_notices_is_left_out() -> None:
    assert not _begins(_house(BEGIN, END, AWAY, BACK))


@pytest.mark.parametrize(
    "network",
    [
        _house(BEGIN, END, AWAY, BACK, watch=(WATCHED, Edge("safe", "safe", sync=Sync("mop", False), resets=("x",)))),
        _house(BEGIN, END, AWAY, BACK, watch=(WATCHED, Edge("safe", "bad", sync=Sync("mopped", False)))),
        _house(BEGIN, END, AWAY, BACK, watch=(WATCHED, Edge("safe", "bad", Guard((), ((Test("d", 1),),))))),
        _house(BEGIN, END, AWAY, BACK, watch=(WATCHED, Edge("safe", "bad", Guard((ClockBound("z", ">", 9),))))),
        _house(BEGIN, END, AWAY, BACK, replace(AWAY, controllable=False)),
        _house(BEGIN, END, AWAY, BACK, replace(AWAY, sync=Sync("call", False))),
        _house(BEGIN, END, replace(AWAY, resets=()), BACK),
        _house(BEGIN, END, replace(AWAY, guard=Guard((ClockBound("z", "<", 9),))), BACK),
        _house(BEGIN, END, AWAY, replace(BACK, assign=())),
        _house(BEGIN, replace(END, target="far", assign=(("d", 3),)), AWAY, BACK),
        _house(BEGIN, replace(END, controllable=True), AWAY, BACK),
        _house(BEGIN, replace(END, guard=Guard((), ((Test("v", 1),),))), AWAY, BACK),
        _house(BEGIN, END, AWAY, BACK, locations=(Location("home", (ClockBound("z", "<=", 9),)), *LOCATIONS[1:])),
    ],
    ids=[
        "its beginning is heard", "its end is heard", "its place is tested", "its clock is tested",
        "it may be sent away", "it may be called", "the clock goes on", "it comes too late",
        "its place is not always the same",
        "it ends elsewhere", "it ends by a command", "its end has to wait", "it may not stay",
    ],
)  # fmt: skip
def test_work_that_may_make_a_difference_stays(network: Network) -> None:
    network = replace(network, channels=(*network.channels, "call"))
    assert _begins(network)


def test_work_at_which_the_objective_looks_stays() -> None:
    assert _begins(_house(BEGIN, END, AWAY, BACK), Objective(Kind.SAFETY, bad=(("watch", "bad"), ("bot", "home"))))
    assert _begins(_house(BEGIN, END, AWAY, BACK), Objective(Kind.REACH, goal=(("bot", "work"),)))


def test_work_that_others_may_begin_stays_and_so_does_that_which_goes_on() -> None:
    network = _house(BEGIN, END, AWAY, BACK)
    tells = Automaton("other", (Location("o"),), "o", (Edge("o", "o", sync=Sync("mop", False), controllable=False),))
    assert _begins(replace(network, automata=(*network.automata, tells)))
    at_work = replace(network.automata[0], initial="work")
    part = cone_of_influence(replace(network, automata=(at_work, network.automata[1])), NEVER).automaton("bot")
    assert END in part.edges and BEGIN not in part.edges


# Random networks ------------------------------------------------------------------------------------------------------


@st.composite
def with_robot(draw: st.DrawFn) -> Tuple[Network, Objective]:
    """A random game with a robot more, which goes away and back and has work to do; others may hear of it, or see it.
    """
    network, objective = draw(networks((Kind.SAFETY, Kind.REACH, Kind.REACH_WHILE_SAFE), most_clocks=1))

    def after(most: int) -> Guard:
        tests = draw(member_of(((), ((Test("v", 1),),))))
        return Guard((ClockBound("z", ">", draw(st.integers(0, most))),), tests)

    channel = draw(member_of(("b", "b", "b", "a")))
    sets = draw(member_of(((), (), (("v", 1),))))
    begin = Edge("home", "work", after(1), Sync(channel, True), (("d", 2),), ("z",))
    end = Edge("work", "home", AFTER, None, (("d", 1),), ("z",), controllable=False)
    away = Edge("home", "far", after(1), draw(member_of((None, Sync("a", True)))), (("d", 3), *sets), ("z",))
    back = Edge("far", "home", AFTER, draw(member_of((None, Sync("a", True)))), (("d", 1),), ("z",), False)
    loop = (Edge("home", "home", AFTER, None, (), ("z",)),) if draw(st.booleans()) else ()
    robot = Automaton("bot", LOCATIONS, "home", (begin, end, away, back, *loop))
    looks = draw(member_of(((), ((Test("d", 1), Test("d", 2)),), ((Test("d", 3),),), ((Test("d", 2),),))))
    first, second = network.automata
    edges = tuple(
        replace(edge, guard=replace(edge.guard, integers=(*edge.guard.integers, *looks)))
        if draw(st.booleans()) else edge
        for edge in second.edges
    )  # fmt: skip
    more = replace(
        network,
        clocks=(*network.clocks, "z"),
        variables=(*network.variables, ("d", 1)),
        channels=("a", "b"),
        automata=(first, replace(second, edges=edges), robot),
    )
    return more, objective


def _is_shorter(network: Network, objective: Objective) -> bool:
    part = cone_of_influence(network, objective)
    return any(a.name == "bot" and all(e.target != "work" for e in a.edges) for a in part.automata)


@settings(max_examples=30, deadline=None, suppress_health_check=list(HealthCheck))
@given(with_robot(), st.sampled_from((Fraction(0), Fraction(1, 2))))
def test_the_verdict_is_that_of_the_whole_game_and_the_strategy_wins_it(
    game: Tuple[Network, Objective], reaction: Fraction
) -> None:
    network, objective = game
    shorter = _is_shorter(network, objective)
    verdict = solve(network, objective, reaction)
    event(f"shorter: {shorter}, won: {verdict.won}")
    # A robot that is left out altogether delays no command of others in the part, and may in the whole game.
    if shorter or not reaction:
        assert verdict.won is solve(network, objective, reaction, whole=True).won
    if verdict.strategy is None or not verdict.strategy.blocks:
        return
    assert verify(network, objective, verdict.strategy, reaction, prompt=False).ok
    assert broken(network, objective, verdict.strategy, reaction) in (None, "cycle")
