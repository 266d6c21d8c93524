"""Games that are easier for the controller than the real one: what is lost there is lost.

The controller may do more, or the environment less. A rule, for example, says when something may begin. Where only the
controller begins it, and the objective does not depend on it, a game without the rule is no harder for the controller,
and often much smaller: agents that take part only because of the rule no longer matter.
"""

from __future__ import annotations

from collections import deque
from dataclasses import replace
from typing import AbstractSet, Collection, Dict, Iterable, Iterator, List, Sequence, Set, Tuple

from pursue_gen.language.symbols import Role
from pursue_gen.synthesis.strategy import Place
from pursue_gen.tga.ends import has_to_come, is_agent, is_nobodys
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Location, Network, Test
from pursue_gen.tga.part import part_of
from pursue_gen.tga.pauses import pauses

_MOMENTS = (1, 2)
"""So many time units after a robot has come to a place somebody calls: no sooner, as a robot rests for one itself.
Measured on large lab 7 and lab 21."""


def without_turns(game: Network, watching: Collection[str]) -> Network:
    """The network without the rules that only restrict when the controller may begin something, and on which these
    automata do not depend; the network itself where there are none."""
    heard = {channel for name in watching for channel in game.automaton(name).channels}
    rules = [each for each in game.automata if each.name not in watching and _is_rule(each)]
    testing: Dict[str, List[Tuple[str, Edge]]] = {}
    for name, edge in game.edges:
        for variable in edge.tested:
            testing.setdefault(variable, []).append((name, edge))
    unheard = (rule for rule in rules if heard.isdisjoint(rule.channels))
    gone = [rule for rule in unheard if _binds_commands_alone(game, rule, testing.get(rule.assigned[0], ()))]
    variables = {name for rule in gone for name in rule.assigned}
    freed = game.with_each(lambda a: a.with_edges(_free_of(edge, variables) for edge in a.edges))
    names = {automaton.name for automaton in game.automata} - {rule.name for rule in gone}
    return part_of(freed, names, dict(game.variables).keys() - variables)


def without_others(game: Network, bad: Collection[Place], others: AbstractSet[str]) -> Network:
    """The network in which other agents bring nothing to what is to be avoided: where each of several may bring it on
    ("any robot at room6") these do not, and where it takes one of them it never comes."""
    variables = {name for each in game.automata if each.name in others for name in each.assigned}

    def freed(edge: Edge) -> Iterator[Edge]:
        clauses = tuple(tuple(t for t in clause if t.variable not in variables) for clause in edge.guard.integers)
        if all(clauses):
            yield replace(edge, guard=replace(edge.guard, integers=clauses))

    def watching(automaton: Automaton) -> Automaton:
        def edges(edge: Edge) -> Iterable[Edge]:
            comes = (automaton.name, edge.target) in bad and edge.sync is None and not edge.controllable
            return freed(edge) if comes else (edge,)

        return automaton.with_each(edges)

    return game.with_each(watching)


def with_one_walk(game: Network, watching: Collection[str], hurried: bool = False) -> Iterator[Network]:
    """Networks in which one agent whom nobody controls goes to a place that these automata ask about, by the fewest
    ways, and stays there; all the others stay where they are unless they have to leave in time. `hurried`: it sets off
    within the first time unit in which it may.

    The environment need not begin any movement, so what it wins so it wins.
    """
    asked = {t for name in watching for e in game.automaton(name).edges for clause in e.guard.integers for t in clause}
    for automaton in filter(is_nobodys, game.automata):
        ways = (_way(automaton, test) for test in sorted(asked, key=lambda t: (t.variable, t.value)))
        walks = ((standing(game, way), way) for way in dict.fromkeys(ways) if way)
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

    def bounded(place: Location) -> Location:
        return replace(place, invariant=(until[place.name],)) if place.name in until and not place.invariant else place

    return game.with_each(lambda each: each.with_locations(bounded) if each is agent else each)


def punctual(game: Network, robot: str) -> Network:
    """The network in which everything ends as late as it may, and who rests between calls (see `pauses`) calls only so
    many time units after a robot has come to a place: the environment has fewer moves at fewer times, but waits for the
    robot again and again."""
    clocks = frozenset(pauses(game))
    automaton = game.automaton(robot)
    own = {bound.clock for bounds in automaton.stays.values() for bound in bounds}
    arrived = {Test(*each) for edge in automaton.edges if edge.target not in automaton.stays for each in edge.assign}
    if len(own) != 1 or not arrived:
        return game
    (clock,) = own
    at_a_place = tuple(sorted(arrived, key=lambda test: (test.variable, test.value)))

    def late(edge: Edge, bounds: Sequence[ClockBound]) -> Edge:
        own_move = not edge.controllable and edge.received is None and not edge.guard.integers
        if not own_move or len(bounds) != 1 or bounds[0].op != "<=":
            return edge
        if any(test.clock != bounds[0].clock or test.op not in (">", ">=") for test in edge.guard.clocks):
            return edge
        return replace(edge, guard=Guard((ClockBound(bounds[0].clock, ">=", bounds[0].bound),)))

    def calls(edge: Edge) -> Iterator[Edge]:
        for moment in _MOMENTS if any(test.clock in clocks for test in edge.guard.clocks) else ():
            yield edge.plus(at_a_place, bounds=(ClockBound(clock, ">=", moment), ClockBound(clock, "<=", moment)))

    def less(automaton: Automaton) -> Automaton:
        return automaton.with_each(lambda e: tuple(calls(e)) or (late(e, automaton.stays.get(e.source, ())),))

    return game.with_each(less)


def asking_only(game: Network, watching: Collection[str]) -> Network:
    """The network in which agents whom nobody controls begin nothing of which these automata do not hear, other than
    movements, unless they have to in time."""
    heard = {channel for name in watching for channel in game.automaton(name).channels}

    def quiet(automaton: Automaton) -> Automaton:
        stays = automaton.stays
        known = {e.source for e in automaton.edges if e.channel in heard}

        def is_kept(edge: Edge) -> bool:
            if edge.sent is None or edge.sent in heard:
                return True
            if edge.source == edge.target:
                return False
            doing = edge.target in stays and edge.target in known
            return edge.source in stays or edge.enters is Role.WAY or doing

        return automaton.with_edges(filter(is_kept, automaton.edges))

    return game.with_each(lambda automaton: quiet(automaton) if is_nobodys(automaton) else automaton)


def standing(game: Network, kept: Collection[Edge] = ()) -> Network:
    """The network in which agents whom nobody controls go nowhere unless they have to leave in time, other than by
    these edges."""

    def still(automaton: Automaton) -> Automaton:
        def is_kept(edge: Edge) -> bool:
            return edge.controllable or edge.enters is not Role.WAY or edge.source in automaton.stays or edge in kept

        return automaton if has_to_come(automaton) else automaton.with_edges(filter(is_kept, automaton.edges))

    return game.with_each(still)


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
    listens = all(edge.received is not None for edge in automaton.edges)
    tests = any(edge.guard.integers or edge.guard.clocks for edge in automaton.edges)
    return not (is_agent(automaton) or tests or automaton.stays) and listens and len(automaton.assigned) == 1


def _binds_commands_alone(game: Network, rule: Automaton, testing: Sequence[Tuple[str, Edge]]) -> bool:
    """True if the rule's variable is tested, by these edges, only where the controller begins something, and at the
    ends of that, at which it is then always true: an end is no freer without the rule."""
    for name, edge in testing:
        if edge.is_command:
            continue
        if not edge.is_end or edge.sent is None:
            return False
        begins = [begin for begin in game.automaton(name).edges if begin.target == edge.source]
        if not all(begin.is_command and _is_followed(rule, begin, edge) for begin in begins):
            return False
    return True


def _is_followed(rule: Automaton, begin: Edge, end: Edge) -> bool:
    """True if the rule takes part in the begin, and from then on stays where it allows the end."""
    led = [edge for edge in rule.edges if edge.received == begin.sent]
    there = {edge.target for edge in led}
    before = -1
    while before < len(there):
        before = len(there)
        there |= {edge.target for edge in rule.edges if edge.source in there and edge.received != end.sent}
    starts = {edge.source for edge in led}
    return begin.sent is not None and _turns(rule, begin) <= starts and there <= _turns(rule, end)


def _turns(rule: Automaton, edge: Edge) -> Set[str]:
    """The locations of the rule at which the edge may be taken."""
    (variable,) = rule.assigned
    places = {place.name for place in rule.locations}
    numbers = {e.target: value for e in rule.edges for _, value in e.assign}
    for clause in edge.guard.integers:
        if any(test.variable == variable for test in clause):
            values = {test.value for test in clause if test.variable == variable}
            places &= {name for name, value in numbers.items() if value in values}
    return places


def _free_of(edge: Edge, variables: AbstractSet[str]) -> Edge:
    """The edge without what its guard says of these variables."""
    clauses = tuple(c for c in edge.guard.integers if variables.isdisjoint(test.variable for test in c))
    return edge if clauses == edge.guard.integers else replace(edge, guard=replace(edge.guard, integers=clauses))
