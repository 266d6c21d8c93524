"""Random games of several robots, and random strategies in stages for them: for the checker to judge.

Each stage is won by the solver in the game of those whom the stage names, from where the checker's tables say that it
may begin. Who is named is drawn as well: so often something is missing that matters, and the checker has to see it.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import chain
from typing import AbstractSet, Dict, List, Optional, Sequence, Set, Tuple

from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.proof.relaxed_reachability import is_controllers
from pursue_gen.proof.stage_entry import Known, at_start
from pursue_gen.proof.stages import after_stage
from pursue_gen.synthesis.cone import cone_of_influence
from pursue_gen.synthesis.limits import Limits
from pursue_gen.synthesis.solve import solve
from pursue_gen.synthesis.strategy import Block, Place, Strategy, with_edges
from pursue_gen.tga.begin import BEGIN, beginning_in
from pursue_gen.tga.ending import ending_at, is_value
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
from pursue_gen.tga.part import part_of
from tests.choices import member_of

ROBOTS, WALKER, GOAL, BAD = ("R0", "R1"), "E", "G", "B"
DONE = ("a", "b")
"""The channels on which robots say that they have done something; rules listen to them."""

MILESTONES = (
    (("M0", "m1"), ("M0", "m1"), ("t0", "1"), ("R0", "l1"), ("p0", "1")),
    (("M1", "m1"), ("M1", "m1"), ("t1", "1"), ("R1", "l1"), ("p1", "1")),
)
"""What a stage may end with: what a rule has waited for, or where a robot is; as locations and as values."""

LITTLE = Limits(states=4_000, work=3_000_000)

Game = Tuple[Network, Objective]


def _between(clock: str, least: int, most: Optional[int] = None) -> Tuple[ClockBound, ...]:
    upper = () if most is None else (ClockBound(clock, "<=", most),)
    return (ClockBound(clock, ">=", least), *upper)


@st.composite
def games(draw: st.DrawFn) -> Game:
    """Two robots that move and report what they have done, two rules that wait for that, someone who walks about, a
    goal for whoever comes after the rules, and sometimes something to be avoided.

    Positions and turns are in variables, as in the networks of scenarios. Some edges are drawn freely.
    """
    variables = {"p0": 0, "p1": 0, "t0": 0, "t1": 0, "pe": 0, "s": 0}
    automata = [_robot(draw, number) for number in range(2)]
    automata += [_rule(draw, number) for number in range(2)]
    automata.append(_walker(draw))
    automata.append(Automaton(GOAL, (Location("g0"), Location("g1")), "g0", (_listening("g0", "g1", "go"),)))
    safe = draw(st.integers(0, 5)) == 0
    if safe:
        tests = (((Test("p0", 1),), (Test("pe", 1),)) if draw(st.booleans()) else ((Test("s", 1),),),)
        edge = Edge("b0", "b1", Guard((), tests[0]), controllable=False)
        automata.append(Automaton(BAD, (Location("b0"), Location("b1")), "b0", (edge,)))
    clocks = ("x0", "x1", "y")
    for _ in range(draw(member_of((0, 0, 1, 2)))):
        k = draw(st.integers(0, len(automata) - 1))
        automata[k] = replace(automata[k], edges=(*automata[k].edges, _free(draw, automata[k], tuple(variables))))
    network = Network(clocks, tuple(variables.items()), ("a", "b", "go", "e"), tuple(automata))
    bad = ((BAD, "b1"),) if safe else ()
    return network, Objective(Kind.REACH_WHILE_SAFE if safe else Kind.REACH, goal=((GOAL, "g1"),), bad=bad)


def _listening(source: str, target: str, channel: str, assign: Tuple[Tuple[str, int], ...] = ()) -> Edge:
    return Edge(source, target, sync=Sync(channel, False), assign=assign)


def _robot(draw: st.DrawFn, number: int) -> Automaton:
    """It goes from l0 to l1 and back, and does things at both."""
    clock, position = f"x{number}", f"p{number}"
    reported, way = draw(st.integers(0, 2)) > 0, draw(st.integers(1, 3))
    edges = [
        Edge("l0", "w", Guard(_between(clock, draw(st.integers(0, 1)))), assign=((position, 2),), resets=(clock,)),
        Edge("w", "l1", Guard(_between(clock, way)), assign=((position, 1),), resets=(clock,),
             controllable=not reported),
    ]
    if draw(st.integers(0, 3)):
        edges.append(Edge("l1", "l0", Guard(_between(clock, 1)), assign=((position, 0),), resets=(clock,)))
    deeds = [DONE[number]]
    deeds += draw(st.lists(member_of(("a", "b", "go", "e")), max_size=1))
    deeds += ["go"] if number == 0 or draw(st.booleans()) else []
    for deed in deeds:
        place = draw(member_of(("l0", "l1")))
        needs = ((Test("t0", 1),), (Test("t1", 1),))[: draw(st.integers(1, 2))] if deed == "go" else ()
        more = draw(member_of((*(8 * ((),)), ("p0", 0), ("p0", 1), ("p1", 0), ("p1", 1), ("pe", 0), ("s", 0))))
        needs += ((Test(*more),),) if more and more[0] != position else ()
        sets = draw(member_of(((), (), (), (), (("s", 1),))))
        edges.append(Edge(place, place, Guard(_between(clock, 1), needs), Sync(deed, True), sets, (clock,)))
    bound = (ClockBound(clock, "<=", way + 1),)
    return Automaton(ROBOTS[number], (Location("l0"), Location("w", bound), Location("l1")), "l0", tuple(edges))


def _rule(draw: st.DrawFn, number: int) -> Automaton:
    turn = f"t{number}"
    edges = [_listening("m0", "m1", DONE[number], ((turn, 1),))]
    undone = draw(member_of(("", "", "", "", "", "a", "b", "e")))
    edges += [_listening("m1", "m0", undone, ((turn, 0),))] if undone else []
    return Automaton(f"M{number}", (Location("m0"), Location("m1")), "m0", tuple(edges))


def _walker(draw: st.DrawFn) -> Automaton:
    """It walks about, or waits to be sent; and may do something."""
    sends = draw(member_of((None, None, Sync("e", True), Sync("a", False), Sync("b", False))))
    comes = () if sends is not None and not sends.sends else _between("y", draw(st.integers(0, 1)))
    free = draw(st.integers(0, 3)) == 0
    edges = [
        Edge("e0", "e1", Guard(comes), sends, (("pe", 1),), ("y",), controllable=free and sends is not None),
        Edge("e1", "e0", Guard(_between("y", draw(st.integers(1, 2)))), None, (("pe", 0),), ("y",), False),
    ]
    if draw(st.integers(0, 3)) == 0:
        edges.append(Edge("e0", "e0", Guard(_between("y", 1)), Sync("e", True), (("s", 1),), ("y",), False))
    bounded = draw(st.booleans())
    places = (Location("e0"), Location("e1", (ClockBound("y", "<=", 2),) if bounded else ()))
    return Automaton(WALKER, places, "e0", tuple(edges))


def _free(draw: st.DrawFn, automaton: Automaton, variables: Sequence[str]) -> Edge:
    """Any edge of the automaton."""
    places = [location.name for location in automaton.locations]
    clock = {"R0": "x0", "R1": "x1"}.get(automaton.name, "y")
    role = draw(member_of((None, "!", "?")))
    channel = draw(member_of(("a", "b", "go", "e")))
    bounds = () if role == "?" else _between(clock, draw(st.integers(0, 2)))
    tests = draw(member_of(((), ("t0", 1), ("p0", 1), ("p1", 1), ("pe", 1), ("s", 1))))
    assign = draw(member_of((None, None, *variables)))
    return Edge(
        draw(member_of(places)),
        draw(member_of(places)),
        Guard(bounds, ((Test(*tests),),) if tests else ()),
        None if role is None else Sync(channel, role == "!"),
        () if assign is None else ((assign, draw(st.integers(0, 1))),),
        (draw(member_of(("x0", "x1", "y"))),) if draw(st.booleans()) else (),
        controllable=automaton.name != WALKER and draw(st.booleans()),
    )


@st.composite
def staged(draw: st.DrawFn, game: Game, reaction: Fraction = Fraction(0)) -> Optional[Strategy]:
    """A strategy in stages that may win; None where a stage is not won in the game of those whom it names."""
    network, objective = game
    numbers = draw(st.permutations((0, 1)))[: draw(member_of((1, 2, 2, 2)))]
    first = [draw(member_of(MILESTONES[number])) for number in numbers]
    together = draw(st.booleans())
    known: Optional[Known] = at_start(network)
    reached: List[str] = []
    found: List[Block] = []
    milestones: List[Tuple[Place, ...]] = []
    for places in [*([first] if together else [[place] for place in first]), list(objective.goal)]:
        own: Dict[Place, List[Block]] = {}
        for place in places:
            team = {"R1" if place in MILESTONES[1] else "R0"}
            team |= set() if len(places) > 1 else draw(st.sets(member_of(ROBOTS), max_size=1))
            assert known is not None
            blocks = _won(draw, game, reaction, place, team, reached, known)
            if not blocks:
                return None
            own[place] = blocks
        known = after_stage(network, known, own)
        if known is None:
            return None
        reached += [name for name, _ in places]
        milestones.append(tuple(places))
        found += chain.from_iterable(own.values())
    return Strategy(tuple(found), stages=tuple(milestones))


def _won(
    draw: st.DrawFn,
    game: Game,
    reaction: Fraction,
    place: Place,
    team: AbstractSet[str],
    reached: Sequence[str],
    known: Known,
) -> List[Block]:
    """The blocks of a part of a stage, for the team; none where it is not won so."""
    network, objective = game
    alone = commanding(network, team, _for_others(draw, place, reached))
    if not (is_value(alone, place) if place[0] in dict(network.variables) else place[0] in known.owned):
        return []
    goal = ending_at(alone, place).goal
    wanted = replace(objective, goal=(goal,))
    if draw(st.booleans()):  # where it cannot happen in the stage
        wanted = replace(wanted, kind=Kind.REACH, bad=())
    cone = cone_of_influence(alone, wanted)
    needed = {name for name in reached if name in known.owned}.union([goal[0]])
    names = {automaton.name for automaton in cone.automata} | needed
    others = sorted({automaton.name for automaton in network.automata} - needed)
    names ^= draw(st.sets(member_of(others), max_size=draw(member_of((0, 0, 0, 0, 1, 2)))))
    variables = {name for name, _ in cone.variables} | {v for name in names for v in known.owned[name]}
    more = st.sets(member_of([name for name, _ in network.variables]), max_size=2)
    variables ^= draw(more) if draw(st.integers(0, 7)) == 0 else set()
    variables |= {name for name in (*reached, place[0]) if name not in known.owned}
    if any(v not in variables for name in names for v in known.owned[name]):
        return []
    part = part_of(alone, names, variables)
    starts = known.states(part)
    if not starts:
        return []
    try:
        ending = ending_at(part, place)
        played = beginning_in(ending.network, starts) if reached else ending.network
        verdict = solve(played, wanted, reaction, limits=LITTLE, whole=True)
    except (PursueError, ValueError):
        return []
    if verdict.strategy is None:
        return []
    back = {(name, there): here for (name, here), there in ending.changed.items()}
    return list(with_edges(_without_begin(verdict.strategy), back))


def _for_others(draw: st.DrawFn, place: Place, reached: Sequence[str]) -> Set[str]:
    """The channels that are for other milestones; mostly all of them."""
    channels = {"M0": "a", "t0": "a", "M1": "b", "t1": "b", GOAL: "go"}
    own = channels.get(place[0])
    others = {channel for name, channel in channels.items() if name not in reached and channel != own}
    return set() if draw(st.integers(0, 4)) == 0 else others


def commanding(network: Network, team: AbstractSet[str], others: AbstractSet[str]) -> Network:
    """The network without what only the controller does, but for what this team does on other channels than these."""
    taken = network.taken_over

    def stays(automaton: Automaton, edge: Edge) -> bool:
        if automaton.name not in ROBOTS or not is_controllers(edge, taken):
            return True
        return automaton.name in team and (edge.sync is None or edge.sync.channel not in others)

    return replace(
        network, automata=tuple(replace(a, edges=tuple(e for e in a.edges if stays(a, e))) for a in network.automata)
    )


def _without_begin(strategy: Strategy) -> List[Block]:
    blocks = []
    for block in strategy.blocks:
        places = dict(block.state.locations)
        if places.pop(BEGIN, None) != BEGIN:
            blocks.append(replace(block, state=replace(block.state, locations=tuple(places.items()))))
    return blocks


@st.composite
def damaged(draw: st.DrawFn, network: Network, strategy: Strategy) -> Strategy:
    """The strategy with something changed in its blocks, in whom they name, or in its stages."""
    how = draw(member_of((_fewer, _elsewhere, _opened, _unnamed, _swapped, _restaged, None)))
    return _milestone(draw, network, strategy) if how is None else how(draw, strategy)


def _number(draw: st.DrawFn, strategy: Strategy) -> int:
    return draw(st.integers(0, len(strategy.blocks) - 1))


def _with(strategy: Strategy, number: int, *blocks: Block) -> Strategy:
    return replace(strategy, blocks=(*strategy.blocks[:number], *blocks, *strategy.blocks[number + 1 :]))


def _fewer(draw: st.DrawFn, strategy: Strategy) -> Strategy:
    return _with(strategy, _number(draw, strategy))


def _elsewhere(draw: st.DrawFn, strategy: Strategy) -> Strategy:
    """What one block says is said in the state of another."""
    number, other = _number(draw, strategy), _number(draw, strategy)
    return _with(strategy, number, replace(strategy.blocks[other], state=strategy.blocks[number].state))


def _opened(draw: st.DrawFn, strategy: Strategy) -> Strategy:
    """A command or the waiting of a block is for always."""
    number = _number(draw, strategy)
    block = strategy.blocks[number]
    if block.commands and draw(st.booleans()):
        return _with(strategy, number, replace(block, wait=(), commands=(replace(block.commands[0], zones=((),)),)))
    return _with(strategy, number, replace(block, wait=((),), commands=()))


def _unnamed(draw: st.DrawFn, strategy: Strategy) -> Strategy:
    """The blocks of a part no longer name an automaton or a variable."""
    stage, place = draw(member_of([(n, place) for n, places in enumerate(strategy.stages) for place in places]))
    numbers = strategy.numbers_of(stage, place)
    if not numbers:
        return strategy
    state = strategy.blocks[numbers[0]].state
    gone: Set[str] = {draw(member_of([name for name, _ in (*state.locations, *state.values)]))}
    kept: Dict[object, Block] = {}
    for number in numbers:
        block = strategy.blocks[number]
        here = replace(
            block.state,
            locations=tuple(pair for pair in block.state.locations if pair[0] not in gone),
            values=tuple(pair for pair in block.state.values if pair[0] not in gone),
        )
        kept.setdefault(here, replace(block, state=here))
    rest = (block for number, block in enumerate(strategy.blocks) if number not in numbers)
    return replace(strategy, blocks=(*rest, *kept.values()))


def _swapped(draw: st.DrawFn, strategy: Strategy) -> Strategy:
    """A command of one block is given in another as well."""
    number, other = _number(draw, strategy), _number(draw, strategy)
    commands = strategy.blocks[other].commands[:1]
    return _with(strategy, number, replace(strategy.blocks[number], commands=commands))


def _restaged(draw: st.DrawFn, strategy: Strategy) -> Strategy:
    """The stages are joined, put in another order, or one is dropped."""
    stages = list(strategy.stages)
    how = draw(st.integers(0, 2))
    if how == 0 and len(stages) > 2:
        stages[:2] = [(*stages[0], *stages[1])]
    elif how == 1 and len(stages[0]) > 1:
        stages[:1] = [(place,) for place in stages[0]]
    elif how == 2 and len(stages) > 1:
        del stages[draw(st.integers(0, len(stages) - 2))]
    return replace(strategy, stages=tuple(stages))


def _milestone(draw: st.DrawFn, network: Network, strategy: Strategy) -> Strategy:
    """A stage ends elsewhere."""
    number = draw(st.integers(0, len(strategy.stages) - 1))
    places = [(automaton.name, location.name) for automaton in network.automata for location in automaton.locations]
    places += [(n, str(v)) for automaton in network.automata for edge in automaton.edges for n, v in edge.assign]
    place = draw(member_of(places))
    stages = list(strategy.stages)
    stages[number] = (place, *stages[number][1:])
    return replace(strategy, stages=tuple(stages))
