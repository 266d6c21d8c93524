"""What cannot matter to an objective is left out of the game, and nothing else is."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import List, Set, Tuple

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from benchmarks.families import pass_bystanders
from pursue_gen.language import parse
from pursue_gen.language.numbers import Number
from pursue_gen.language.scenario import Scenario
from pursue_gen.proof.checker import verify
from pursue_gen.proof.independence import named_part, why_it_matters
from pursue_gen.proof.relaxed_reachability import live
from pursue_gen.solving.rules import DEFAULT, IDEAL, Rules, played
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.synthesis.cone import cone_of_influence
from pursue_gen.synthesis.solve import solve
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import (
    Automaton,
    ClockBound,
    Constraint,
    Edge,
    Guard,
    Kind,
    Location,
    Network,
    Objective,
    Sync,
    Test,
)
from pursue_gen.tga.part import part_of
from tests.choices import member_of
from tests.oracle import ENGINES
from tests.synthesis.play_by_play import broken
from tests.synthesis.random_games import networks

EVERY_KIND = (Kind.REACH, Kind.REACH_WHILE_SAFE, Kind.SAFETY)
RANDOM = settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))

HALL = """
poi "hall"
poi "shop"
connect hall and shop distance 5
event "serve" location hall
event "shout"
event "clap"
event "mop" location shop duration 3
event "dry" location shop
{rules}
agent "bot" controllable mobile 1 location shop can_do serve
{agents}
reach_objective: do serve after 0
"""


def _scenario(agents: str, rules: str = "") -> Scenario:
    return parse(HALL.format(agents=agents, rules=rules), "hall.pur", "hall")


def _named(scenario: Scenario, rules: Rules = DEFAULT) -> Set[str]:
    network = played(translate(scenario), rules)
    return {automaton.name for automaton in cone_of_influence(network, scenario_objective(scenario)).automata}


def _won(scenario: Scenario, reaction: Fraction, engine: str, whole: bool = False) -> bool:
    network = played(translate(scenario), replace(DEFAULT, reaction=reaction))
    return solve(network, scenario_objective(scenario), reaction, ENGINES[engine], whole=whole).won


# By hand --------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("rules", [DEFAULT, IDEAL])
@pytest.mark.parametrize(
    ("agents", "rule", "kept"),
    [
        ('agent "guest" mobile 2 location hall', "", {"bot", "reachObj"}),
        ('agent "guest" mobile 2 location hall can_do shout', "", {"bot", "reachObj"}),
        ('agent "helper" controllable mobile 2 location hall can_do clap', "", {"bot", "reachObj"}),
        ('agent "guest" location hall can_do shout, clap', 'rule "turns": shout before clap', {"bot", "reachObj"}),
        (
            'agent "guest" location hall can_do shout',
            'rule "order": shout before serve',
            {"bot", "reachObj", "order", "guest"},
        ),
        (
            'agent "guest" location hall can_do shout\nagent "child" location hall can_do clap',
            'rule "order": shout before serve\nrule "turns": clap before shout',
            {"bot", "reachObj", "order", "guest", "turns", "child"},
        ),
    ],
)
def test_what_the_objective_depends_on_is_kept_and_nothing_else(
    agents: str, rule: str, kept: Set[str], rules: Rules
) -> None:
    assert _named(_scenario(agents, rule), rules) == kept


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("reaction", [Fraction(0), Fraction(1, 10), Fraction(1, 2)])
@pytest.mark.parametrize("whole", [False, True])
def test_whoever_shouts_without_end_does_no_harm(engine: str, reaction: Fraction, whole: bool) -> None:
    guest = _scenario('agent "guest" mobile 2 location hall can_do shout')
    assert _won(guest, reaction, engine, whole)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_move_that_changes_nothing_makes_no_command_stale(engine: str) -> None:
    # The thief matters: the bot serves when they meet. On its way it may say anything as often as it likes.
    scenario = parse(
        HALL.format(agents='agent "guest" mobile 2 location hall can_do shout reacts_to serve', rules="").replace(
            'event "serve" location hall', 'event "serve" collaborative'
        ),
        "hall.pur",
        "hall",
    )
    network, objective = played(translate(scenario), DEFAULT), scenario_objective(scenario)
    assert cone_of_influence(network, objective) is network
    verdict = solve(network, objective, DEFAULT.reaction, ENGINES[engine])
    assert verdict.strategy is not None
    assert verify(network, objective, verdict.strategy, DEFAULT.reaction, ranks=verdict.ranks).ok


SOON_OVER = (Location("here", (ClockBound("x", "<=", 1),)), Location("there"), Location("bad"))
AWAY = Edge("here", "there", Guard((ClockBound("x", "<", 1),)), controllable=False)
NEVER_BAD = Objective(Kind.SAFETY, bad=(("A", "bad"),))

IDLE = Edge("here", "here")
GO, BACK = Edge("here", "there"), Edge("there", "here")
CALLING = Edge("here", "here", sync=Sync("a", True))
HEARING = (Edge("here", "there", sync=Sync("a", False)), Edge("there", "here", sync=Sync("a", False)))
OTHERS_CALL = replace(CALLING, controllable=False)
NOTING = Edge("here", "here", sync=Sync("a", False), resets=("z",))


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("whole", [False, True])
@pytest.mark.parametrize(
    ("own", "others"),
    [
        ((), ()),
        ((), (IDLE,)),
        ((), (GO, BACK)),
        ((IDLE,), ()),
        ((CALLING,), ()),
        ((CALLING,), HEARING),
        ((replace(IDLE, assign=(("w", 0),)),), ()),
        ((OTHERS_CALL,), ()),
        ((OTHERS_CALL,), HEARING),
        ((OTHERS_CALL,), (NOTING,)),
    ],
    ids=[
        "nobody", "idle", "to and fro", "itself", "calling", "calling, heard", "the same again",
        "called", "called, heard", "called, noted",
    ],
)
def test_no_move_that_changes_nothing_keeps_time_from_passing(
    engine: str, whole: bool, own: Tuple[Edge, ...], others: Tuple[Edge, ...]
) -> None:
    # Whoever has to be away before the end of his time and is not must not be saved by moves without end.
    late = Automaton("A", SOON_OVER, "here", (AWAY, *own))
    bystander = Automaton("B", (Location("here"), Location("there")), "here", others)
    network = Network(("x", "z"), (("w", 0),), ("a",), (late, bystander))
    assert not solve(network, NEVER_BAD, engine=ENGINES[engine], whole=whole).won
    saved = replace(network, automata=(replace(late, edges=(*late.edges, GO)), bystander))
    assert solve(saved, NEVER_BAD, engine=ENGINES[engine], whole=whole).won


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("whole", [False, True])
def test_a_robot_that_talks_to_itself_meets_no_deadline(engine: str, whole: bool) -> None:
    text = """
poi "desk"
poi "shelf"
connect desk and shelf distance 2
event "call"
event "beep"
event "fetch" location shelf
agent "bot" controllable mobile 1 location desk can_do fetch, beep
agent "visitor" location desk can_do call
objective: if call then fetch within 2
"""
    scenario = parse(text, "desk.pur", "desk")
    assert not solve(translate(scenario), scenario_objective(scenario), engine=ENGINES[engine], whole=whole).won


def test_many_bystanders_cost_no_states() -> None:
    def states(bystanders: int) -> int:
        scenario = parse(pass_bystanders(bystanders), "crowd.pur", "crowd")
        network = played(translate(scenario), DEFAULT)
        return solve(network, scenario_objective(scenario), DEFAULT.reaction).stats.discrete_states

    assert states(50) == states(0)


def _walker(*edges: Edge, bound: Number = 5, initial: str = "here") -> Automaton:
    locations = (Location("here"), Location("there", (ClockBound("z", "<=", bound),)))
    return Automaton("walker", locations, initial, edges)


IN = Edge("here", "there", resets=("z",), controllable=False)
OUT = Edge("there", "here", Guard((ClockBound("z", ">", 2),)), resets=("z",), controllable=False)
GOAL = Automaton("A", (Location("start"), Location("goal")), "start", (Edge("start", "goal"),))
REACH = Objective(Kind.REACH, goal=(("A", "goal"),))


@pytest.mark.parametrize(
    ("walker", "why"),
    [
        (_walker(IN), "there is no way out"),
        (_walker(IN, replace(OUT, controllable=True)), "only the controller could lead it out"),
        (_walker(IN, replace(OUT, guard=Guard((ClockBound("z", ">", 5),)))), "the way out opens too late"),
        (_walker(IN, replace(OUT, guard=Guard((ClockBound("z", "<", 5),)))), "the way out closes too soon"),
        (_walker(IN, replace(OUT, guard=Guard((ClockBound("x", ">", 5),)))), "the way out needs another clock"),
        (_walker(IN, replace(OUT, guard=Guard((), ((Test("v", 1),),)))), "the way out needs a variable"),
        (_walker(IN, replace(OUT, sync=Sync("a", False), guard=Guard())), "it leaves when it is told only"),
        (_walker(replace(IN, resets=()), OUT), "it may come in too late to stay"),
        (_walker(IN, replace(OUT, guard=Guard()), bound=0), "it cannot stay at all"),
        (_walker(IN, replace(OUT, resets=("x",))), "it resets a clock that matters"),
        (_walker(IN, replace(OUT, assign=(("w", 1),))), "it sets a variable that matters"),
        (_walker(IN, OUT, Edge("here", "here", sync=Sync("b", False), controllable=False)), "it takes a command away"),
    ],
)
def test_whoever_may_stop_time_or_is_seen_is_kept(walker: Automaton, why: str) -> None:
    tests = Guard((ClockBound("x", ">", 1),), ((Test("w", 0),),))
    goal = replace(GOAL, edges=(Edge("start", "goal", tests, Sync("b", True)),))
    network = Network(("x", "z"), (("v", 0), ("w", 0)), ("a", "b"), (goal, walker))
    assert {a.name for a in cone_of_influence(network, REACH).automata} == {"A", "walker"}, why
    assert why_it_matters(network, REACH, part_of(network, {"A"}, {"w"})).startswith("walker"), why
    for harmless in (_walker(IN, OUT), _walker(IN, replace(OUT, guard=Guard()), bound=Fraction(1, 2))):
        free = replace(network, automata=(goal, harmless))
        assert {a.name for a in cone_of_influence(free, REACH).automata} == {"A"}
        assert why_it_matters(free, REACH, part_of(free, {"A"}, {"w"})) == ""


REST = Edge("there", "here", Guard((ClockBound("y", ">", 2),)), resets=("y",), controllable=False)


def _waves(*bounds: ClockBound, resets: Tuple[str, ...] = ("y",)) -> Edge:
    return Edge("there", "there", Guard(bounds), resets=resets, controllable=False)


@pytest.mark.parametrize(
    ("walker", "may_stop"),
    [
        (_walker(IN, REST), False),
        (_walker(replace(IN, resets=("z", "y")), REST), False),
        (_walker(IN, REST, _waves(ClockBound("z", "<", 3))), False),
        (_walker(IN, REST, _waves(resets=("z", "y"))), False),
        (_walker(IN, REST, bound=2), True),
        (_walker(IN, REST, _waves()), True),
        (_walker(IN, REST, _waves(ClockBound("z", "<=", 3))), True),
        (_walker(IN, REST, _waves(ClockBound("z", "<", 4))), True),
        (_walker(IN, replace(REST, guard=Guard((ClockBound("y", "<", 9),)))), True),
    ],
)
def test_who_has_rested_by_the_end_of_a_stay_does_not_stop_time(walker: Automaton, may_stop: bool) -> None:
    def matters(network: Network) -> bool:
        kept = {automaton.name for automaton in cone_of_influence(network, REACH).automata}
        assert (why_it_matters(network, REACH, part_of(network, {"A"}, set())) != "") == (kept == {"A", "walker"})
        return kept == {"A", "walker"}

    network = Network(("y", "z"), (), (), (GOAL, walker))
    assert matters(network) == may_stop
    other = Automaton("other", (Location("on"),), "on", (Edge("on", "on", resets=("y",), controllable=False),))
    seen = replace(network, automata=(*network.automata, other))
    assert cone_of_influence(seen, REACH).automata == seen.automata
    assert why_it_matters(seen, REACH, part_of(seen, {"A", "other"}, set())).startswith("walker")
    there = replace(network, automata=(GOAL, replace(walker, initial="there")))
    assert matters(there) == may_stop
    assert matters(replace(there, start=(Constraint("z", None, Fraction(3), False),)))


@pytest.mark.parametrize("does", ["", "can_do shout", "can_do mop"])
def test_a_visitor_who_is_assumed_to_leave_in_time_does_not_matter(does: str) -> None:
    """What somebody does at the place itself and takes its time goes on in the stay, which is not seen through."""
    visitor = f'agent "guest" mobile 2 location hall {does}\nassume: guest leaves shop within 30'
    scenario = _scenario(visitor)
    assert _named(scenario) == {"bot", "reachObj", *(["guest"] if "mop" in does else [])}
    won = solve_scenario(scenario, DEFAULT)
    assert verify(won.network, won.objective, won.strategy, won.reaction).ok


def test_what_was_done_before_the_middle_of_a_play_counts() -> None:
    """What resets the clock of the rest may not be possible any more: it may just have been done."""
    network, later = (
        Network(("y", "z"), (), (), (GOAL, _walker(IN, REST, *loops)))
        for loops in ((_waves(ClockBound("z", "<", Fraction(7, 2))),), ())
    )
    part = part_of(later, {"A"}, set())
    assert why_it_matters(later, REACH, part, before=later) == ""
    assert why_it_matters(later, REACH, part, before=network).startswith("walker")


def test_whoever_starts_beyond_its_time_is_kept() -> None:
    network = Network(("z",), (), (), (GOAL, _walker(IN, OUT, initial="there")))
    assert len(cone_of_influence(network, REACH).automata) == 1
    late = replace(network, start=(Constraint(None, "z", Fraction(-6), False),))
    assert cone_of_influence(late, REACH) is late
    assert why_it_matters(late, REACH, part_of(late, {"A"}, set())) != ""
    early = replace(network, start=(Constraint("z", None, Fraction(3), False),))
    assert len(cone_of_influence(early, REACH).automata) == 1


def test_a_state_that_nothing_depends_on_is_left_out() -> None:
    text = HALL.format(agents='agent "guest" location hall can_do shout', rules="").replace(
        'agent "bot"',
        'state "loud": initially false, true_if shout\nstate "open": initially true, false_if serve\n'
        'stateDependency: serve only_if open is_true\nagent "bot"',
    )
    scenario = parse(text, "hall.pur", "hall")
    part = cone_of_influence(played(translate(scenario), DEFAULT), scenario_objective(scenario))
    assert {a.name for a in part.automata} == {"states", "bot", "reachObj"}
    assert {name for name, _ in part.variables} == {"Pbot", "Sopen"}


# Random networks ------------------------------------------------------------------------------------------------------


@st.composite
def with_walker(draw: st.DrawFn, kinds: Tuple[Kind, ...], receives: bool = True) -> Tuple[Network, Objective]:
    """A random game with one more automaton, which has a clock of its own, takes at least one time unit for every move
    of its own, reads the others' variable, and often is not seen itself.

    Where it `receives`, it notes with its clock what changes nothing for the others: without end, if they like.
    """
    network, objective = draw(networks(kinds))
    edges: List[Edge] = []
    for _ in range(draw(st.integers(1, 3))):
        role = draw(member_of(("tau", "b!", "a!", *(("a?", "a?") if receives else ()))))
        bounds = () if role == "a?" else (ClockBound("z", draw(member_of((">", ">="))), draw(st.integers(1, 2))),)
        test = ((Test("v", draw(st.integers(0, 1))),),) if draw(st.integers(0, 3)) == 0 else ()
        assign = draw(member_of(((), (), (("w", 1),), (("v", 1),))))
        edges.append(
            Edge(
                draw(member_of(("m0", "m1"))),
                draw(member_of(("m0", "m1"))),
                Guard(bounds, test),
                None if role == "tau" else Sync(role[0], role[1] == "!"),
                assign,
                ("z",),
                controllable=draw(st.integers(0, 2)) == 0 or role == "a?",
            )
        )
    bound = draw(st.integers(0, 4))
    locations = (Location("m0"), Location("m1", (ClockBound("z", "<=", bound),) if draw(st.booleans()) else ()))
    walker = Automaton("B", locations, "m0", tuple(edges))
    more = replace(
        network,
        clocks=(*network.clocks, "z"),
        variables=(*network.variables, ("w", 0)),
        channels=("a", "b"),
        automata=(*network.automata, walker),
    )
    return more, objective


@RANDOM
@given(game=st.one_of(with_walker(EVERY_KIND, receives=False), with_walker((Kind.SAFETY,))))
def test_the_verdict_is_that_of_the_whole_game(game: Tuple[Network, Objective]) -> None:
    network, objective = game
    assert solve(network, objective).won == solve(network, objective, whole=True).won


@RANDOM
@given(game=with_walker(EVERY_KIND))
def test_a_win_of_the_whole_game_is_one_of_the_part_whatever_the_reaction(game: Tuple[Network, Objective]) -> None:
    network, objective = game
    if solve(network, objective, Fraction(1, 2), whole=True).won:
        assert solve(network, objective, Fraction(1, 2)).won


@RANDOM
@given(game=st.one_of(with_walker(EVERY_KIND, receives=False), with_walker((Kind.SAFETY,))))
def test_a_strategy_for_the_part_wins_in_the_whole_game(game: Tuple[Network, Objective]) -> None:
    network, objective = game
    verdict = solve(network, objective)
    if verdict.strategy is None or not verdict.strategy.blocks:
        return
    assert verify(network, objective, verdict.strategy, prompt=False).ok
    assert broken(network, objective, verdict.strategy, Fraction(0)) is None


@RANDOM
@given(data=st.data(), game=with_walker(EVERY_KIND))
def test_the_checker_passes_no_part_in_which_something_is_missing(
    data: st.DataObject, game: Tuple[Network, Objective]
) -> None:
    network, objective = game
    keep = {name for name, _ in (*objective.goal, *objective.bad)}
    keep |= data.draw(st.sets(member_of(("A0", "A1", "B"))))
    part = part_of(network, keep, data.draw(st.sets(member_of(("v", "w")))))
    strategy = solve(part, objective, whole=True).strategy
    if strategy is None or not strategy.blocks:
        return
    assert named_part(network, strategy) == part
    why = broken(network, objective, strategy, Fraction(0))
    if why not in (None, "cycle"):  # a cycle without time is no play of the world
        assert not verify(network, objective, strategy, prompt=False).ok, why


@RANDOM
@given(game=with_walker(EVERY_KIND))
def test_the_checker_finds_nothing_in_the_cone_that_matters(game: Tuple[Network, Objective]) -> None:
    network, objective = game
    part = cone_of_influence(network, objective)
    commands = {(a.name, edge) for a in part.automata for edge in a.edges if edge.controllable}
    alive, extent = live(network, commands)  # without the detours, which the part does not have
    part = part_of(alive, {a.name for a in part.automata}, {name for name, _ in part.variables})
    assert why_it_matters(alive, objective, part, extent.places) == ""


def test_a_strategy_that_leaves_out_what_matters_is_refused() -> None:
    scenario = _scenario('agent "guest" location hall can_do shout', 'rule "order": shout before serve')
    network, objective = played(translate(scenario), DEFAULT), scenario_objective(scenario)
    part = part_of(network, {"bot", "reachObj", "order"}, {name for name, _ in network.variables})
    shouted = replace(
        part, automata=tuple(a if a.name != "order" else replace(a, initial=a.locations[1].name) for a in part.automata)
    )
    shouted = replace(shouted, variables=tuple((n, 1) if n == "Porder" else (n, v) for n, v in part.variables))
    strategy = solve(shouted, objective, DEFAULT.reaction).strategy or Strategy(())
    report = verify(network, objective, strategy, DEFAULT.reaction)
    assert report.reason.startswith("left out: ") and "guest" in report.reason
