"""Games that are easier for the controller than the real one: what is lost there is lost.

The controller may do more, or the environment less. A rule, for example, says when something may begin. Where only the
controller begins it, and the objective does not depend on it, a game without the rule is no harder for the controller,
and often much smaller: agents that take part only because of the rule no longer matter.
"""

from __future__ import annotations

from collections import deque
from dataclasses import replace
from itertools import chain
from typing import AbstractSet, Collection, Dict, Iterator, List, Sequence, Set, Tuple

from pursue_gen.language.symbols import Role
from pursue_gen.synthesis.strategy import Place
from pursue_gen.tga.ends import is_agent
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Network, Test
from pursue_gen.tga.part import part_of
from pursue_gen.tga.pauses import pauses

_MOMENTS = (1, 2)
"""So many time units after a robot has come to a place somebody calls: no sooner, as a robot rests for one itself.
Measured on large lab 7 and lab 21."""


def without_turns(game: Network, watching: Collection[str]) -> Network:
    """The network without the rules that only restrict when the controller may begin something, and on which these
    automata do not depend; the network itself where there are none."""
    heard = {channel for name in watching for channel in _channels(game.automaton(name))}
    rules = [each for each in game.automata if each.name not in watching and _is_rule(each)]
    testing: Dict[str, List[Tuple[Automaton, Edge]]] = {}
    for automaton in game.automata:
        for edge in automaton.edges:
            for variable in dict.fromkeys(_tested(edge)):
                testing.setdefault(variable, []).append((automaton, edge))
    unheard = (rule for rule in rules if heard.isdisjoint(_channels(rule)))
    gone = [rule for rule in unheard if _binds_commands_alone(rule, testing.get(_assigned(rule)[0], ()))]
    if not gone:
        return game
    variables = {name for rule in gone for name in _assigned(rule)}
    automata = tuple(replace(a, edges=tuple(_free_of(edge, variables) for edge in a.edges)) for a in game.automata)
    kept = {name for name, _ in game.variables} - variables
    return part_of(replace(game, automata=automata), {a.name for a in automata} - {rule.name for rule in gone}, kept)


def without_others(game: Network, bad: Collection[Place], others: AbstractSet[str]) -> Network:
    """The network in which other agents bring nothing to what is to be avoided: where each of several may bring it on
    ("any robot at room6") these do not, and where it takes one of them it never comes."""
    variables = {name for each in game.automata if each.name in others for name in _assigned(each)}

    def freed(edge: Edge) -> Iterator[Edge]:
        clauses = tuple(tuple(t for t in clause if t.variable not in variables) for clause in edge.guard.integers)
        if all(clauses):
            yield replace(edge, guard=replace(edge.guard, integers=clauses))

    def watching(automaton: Automaton) -> Automaton:
        edges: List[Edge] = []
        for edge in automaton.edges:
            comes = (automaton.name, edge.target) in bad and edge.sync is None and not edge.controllable
            edges += freed(edge) if comes else [edge]
        return replace(automaton, edges=tuple(edges))

    return replace(game, automata=tuple(map(watching, game.automata)))


def with_one_walk(game: Network, watching: Collection[str], hurried: bool = False) -> Iterator[Network]:
    """Networks in which one agent whom nobody controls goes to a place that these automata ask about, by the fewest
    ways, and stays there; all the others stay where they are unless they have to leave in time. `hurried`: it sets off
    within the first time unit in which it may.

    The environment need not begin any movement, so what it wins so it wins.
    """
    asked = {t for name in watching for e in game.automaton(name).edges for clause in e.guard.integers for t in clause}
    for automaton in game.automata:
        if is_agent(automaton) and not any(edge.controllable for edge in automaton.edges):
            ways = (_way(automaton, test) for test in sorted(asked, key=lambda t: (t.variable, t.value)))
            walks = ((_standing(game, way), way) for way in dict.fromkeys(ways) if way)
            yield from (_hurried(walk, automaton.name, way) if hurried else walk for walk, way in walks)


def _hurried(game: Network, name: str, way: Collection[Edge]) -> Network:
    """The network in which an agent does not linger before the movements of its way.

    It could do so anyway. Each way into such a location resets the clock, so that time goes on, and the agent can leave
    whatever the others do.
    """
    agent = game.automaton(name)
    until: Dict[str, ClockBound] = {}
    for edge in way:
        enters = [each for each in agent.edges if each.target == edge.source]
        bounds = edge.guard.clocks
        if edge.enters is Role.WAY and len(bounds) == 1 and bounds[0].op in (">", ">=") and not edge.guard.integers:
            starts = edge.source != agent.initial or not game.start
            if starts and all(bounds[0].clock in each.resets for each in enters):
                until[edge.source] = ClockBound(bounds[0].clock, "<=", bounds[0].bound + 1)
    places = (
        replace(place, invariant=(until[place.name],)) if place.name in until and not place.invariant else place
        for place in agent.locations
    )
    changed = replace(agent, locations=tuple(places))
    return replace(game, automata=tuple(changed if each is agent else each for each in game.automata))


def punctual(game: Network, robot: str) -> Network:
    """The network in which everything ends as late as it may, and who rests between calls (see `pauses`) calls only so
    many time units after a robot has come to a place: the environment has fewer moves at fewer times, but waits for the
    robot again and again."""
    clocks = frozenset(pauses(game))
    automaton = game.automaton(robot)
    bounded = {place.name for place in automaton.locations if place.invariant}
    own = {bound.clock for place in automaton.locations for bound in place.invariant}
    arrived = {Test(*each) for edge in automaton.edges if edge.target not in bounded for each in edge.assign}
    if len(own) != 1 or not arrived:
        return game
    (clock,) = own
    at_a_place = tuple(sorted(arrived, key=lambda test: (test.variable, test.value)))

    def late(edge: Edge, bounds: Sequence[ClockBound]) -> Edge:
        listens = edge.sync is not None and not edge.sync.sends
        if edge.controllable or listens or edge.guard.integers or len(bounds) != 1 or bounds[0].op != "<=":
            return edge
        if any(test.clock != bounds[0].clock or test.op not in (">", ">=") for test in edge.guard.clocks):
            return edge
        return replace(edge, guard=Guard((ClockBound(bounds[0].clock, ">=", bounds[0].bound),)))

    def calls(edge: Edge) -> Iterator[Edge]:
        for moment in _MOMENTS if any(test.clock in clocks for test in edge.guard.clocks) else ():
            then = (*edge.guard.clocks, ClockBound(clock, ">=", moment), ClockBound(clock, "<=", moment))
            yield replace(edge, guard=Guard(then, (*edge.guard.integers, at_a_place)))

    def less(automaton: Automaton) -> Automaton:
        bounds = {place.name: place.invariant for place in automaton.locations}
        edges = (tuple(calls(edge)) or (late(edge, bounds[edge.source]),) for edge in automaton.edges)
        return replace(automaton, edges=tuple(chain.from_iterable(edges)))

    return replace(game, automata=tuple(map(less, game.automata)))


def asking_only(game: Network, watching: Collection[str]) -> Network:
    """The network in which agents whom nobody controls begin nothing of which these automata do not hear, other than
    movements, unless they have to in time."""
    heard = {channel for name in watching for channel in _channels(game.automaton(name))}

    def quiet(automaton: Automaton) -> Automaton:
        bounded = {place.name for place in automaton.locations if place.invariant}
        known = {e.source for e in automaton.edges if e.sync is not None and e.sync.channel in heard}

        def is_kept(edge: Edge) -> bool:
            if edge.sync is None or not edge.sync.sends or edge.sync.channel in heard:
                return True
            if edge.source == edge.target:
                return False
            doing = edge.target in bounded and edge.target in known
            return edge.source in bounded or edge.enters is Role.WAY or doing

        edges = (edge for edge in automaton.edges if is_kept(edge))
        return replace(automaton, edges=tuple(edges))

    nobodys = {a.name for a in game.automata if is_agent(a) and not any(edge.controllable for edge in a.edges)}
    return replace(game, automata=tuple(quiet(a) if a.name in nobodys else a for a in game.automata))


def standing(game: Network) -> Network:
    """The network in which agents whom nobody controls go nowhere unless they have to leave in time."""
    return _standing(game, ())


def _standing(game: Network, kept: Collection[Edge]) -> Network:
    def still(automaton: Automaton) -> Automaton:
        bounded = {place.name for place in automaton.locations if place.invariant}
        edges = (
            e
            for e in automaton.edges
            if e.controllable or e.enters is not Role.WAY or e.source in bounded or e in kept
        )
        return replace(automaton, edges=tuple(edges))

    return replace(game, automata=tuple(map(still, game.automata)))


def _way(automaton: Automaton, to: Test) -> Tuple[Edge, ...]:
    """The fewest edges from where the automaton starts to one that makes the test hold; () where there is no way."""
    known: Dict[str, Tuple[Edge, ...]] = {automaton.initial: ()}
    waiting = deque(known)
    while waiting:
        here = waiting.popleft()
        for edge in automaton.edges:
            if edge.source == here and edge.target not in known:
                known[edge.target] = (*known[here], edge)
                if (to.variable, to.value) in edge.assign:
                    return known[edge.target]
                waiting.append(edge.target)
    return ()


def _is_rule(automaton: Automaton) -> bool:
    """True if the automaton only receives, tests nothing, and has one variable that says where it is."""
    listens = all(edge.sync is not None and not edge.sync.sends for edge in automaton.edges)
    tests = any(edge.guard.integers or edge.guard.clocks for edge in automaton.edges)
    bounded = any(place.invariant for place in automaton.locations)
    return not is_agent(automaton) and listens and not tests and not bounded and len(_assigned(automaton)) == 1


def _binds_commands_alone(rule: Automaton, testing: Sequence[Tuple[Automaton, Edge]]) -> bool:
    """True if the rule's variable is tested, by these edges, only where the controller begins something, and at the
    ends of that, at which it is then always true: an end is no freer without the rule."""
    for automaton, edge in testing:
        if _is_command(edge):
            continue
        if not edge.is_end or edge.sync is None or not edge.sync.sends:
            return False
        begins = [begin for begin in automaton.edges if begin.target == edge.source]
        if not all(_is_command(begin) and _is_followed(rule, begin, edge.sync.channel, edge) for begin in begins):
            return False
    return True


def _is_followed(rule: Automaton, begin: Edge, ending: str, end: Edge) -> bool:
    """True if the rule takes part in the begin, and from then on stays where it allows the end."""
    if begin.sync is None:
        return False
    channel = begin.sync.channel
    there = {edge.target for edge in rule.edges if edge.sync is not None and edge.sync.channel == channel}
    before = -1
    while before < len(there):
        before = len(there)
        there |= {e.target for e in rule.edges if e.source in there and e.sync is not None and e.sync.channel != ending}
    starts = {edge.source for edge in rule.edges if edge.sync is not None and edge.sync.channel == channel}
    return _turns(rule, begin) <= starts and there <= _turns(rule, end)


def _turns(rule: Automaton, edge: Edge) -> Set[str]:
    """The locations of the rule at which the edge may be taken."""
    (variable,) = _assigned(rule)
    places = {place.name for place in rule.locations}
    numbers = {e.target: value for e in rule.edges for _, value in e.assign}
    for clause in edge.guard.integers:
        if any(test.variable == variable for test in clause):
            values = {test.value for test in clause if test.variable == variable}
            places &= {name for name, value in numbers.items() if value in values}
    return places


def _is_command(edge: Edge) -> bool:
    return edge.controllable and (edge.sync is None or edge.sync.sends)


def _channels(automaton: Automaton) -> Set[str]:
    return {edge.sync.channel for edge in automaton.edges if edge.sync is not None}


def _assigned(automaton: Automaton) -> Tuple[str, ...]:
    return tuple(dict.fromkeys(name for edge in automaton.edges for name, _ in edge.assign))


def _tested(edge: Edge) -> Iterator[str]:
    return (test.variable for clause in edge.guard.integers for test in clause)


def _free_of(edge: Edge, variables: AbstractSet[str]) -> Edge:
    """The edge without what its guard says of these variables."""
    clauses = tuple(c for c in edge.guard.integers if variables.isdisjoint(test.variable for test in c))
    return edge if clauses == edge.guard.integers else replace(edge, guard=replace(edge.guard, integers=clauses))
