"""Groups of robots that keep promises, or come to the goal, and the game that each plays."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import FrozenSet, Iterable, Iterator, Sequence, Set, Tuple

from pursue_gen.proof.relaxed_reachability import Commanded, is_controllers, live
from pursue_gen.proof.shares import left_to_others
from pursue_gen.solving.subgoals import commanded_agents
from pursue_gen.solving.useful import useful
from pursue_gen.synthesis.cone import cone_of_influence
from pursue_gen.synthesis.strategy import Place, Strategy
from pursue_gen.tga.ends import is_agent
from pursue_gen.tga.hidden import HIDDEN, is_loosened, why_not_hidden, with_hidden
from pursue_gen.tga.network import Network, Objective
from pursue_gen.tga.part import part_of, without_unnamed_clocks
from pursue_gen.tga.watchers import Watcher, with_watchers

NEEDED, PEOPLE, PLACES, ALL = range(4)
"""Who is shown in a group's game: whoever its commands depend on; those, too, on whose place something else depends, at
first without other robots; all who matter."""

NOBODY: FrozenSet[str] = frozenset()


@dataclass(frozen=True)
class Group:
    """Robots, and the places that they keep from, in the objective's order; of those who come to the goal its places,
    too, behind these."""

    team: FrozenSet[str]
    places: Tuple[Place, ...]


class GroupGames:
    """The games of groups in a network."""

    def __init__(self, network: Network, objective: Objective) -> None:
        self._network, self._objective = network, objective
        self._watching = {name for name, _ in (*objective.goal, *objective.bad)}
        self._robots, self._taken, self._setters = commanded_agents(network), network.taken_over, network.setters

    def wanted(self, group: Group, watchers: Tuple[Watcher, ...] = ()) -> Objective:
        """What the group wants in its game."""
        goal = [place for place in group.places if place in self._objective.goal]
        return Objective.of(goal, [place for place in kept(group.places, watchers) if place not in goal])

    def game(self, group: Group, theirs: Commanded, shown: int = ALL, watchers: Tuple[Watcher, ...] = ()) -> Network:
        """The group's game: what matters to its promises, where it may do what it likes, and others these commands.

        `shown`: how much of the others is in it; the rest is hidden (see `tga.hidden`). `watchers`: followed in place
        of their objectives.
        """
        network, places = with_watchers(self._network, watchers), kept(group.places, watchers)
        wanted = self.wanted(group, watchers)
        mine = {c for c in useful(network, group.team, places) if is_controllers(c[1], self._taken)}
        alive = left_to_others(live(network, mine | theirs)[0], theirs)
        # The automata of other promises only watch.
        names = {automaton.name for automaton in alive.automata}.difference(self._watching)
        names.update(name for name, _ in places)
        alive = part_of(alive, names)
        hidden = {a.name for a in alive.automata if is_agent(a) and a.name not in group.team and shown != ALL}
        tested = {name for _, edge in mine for name in edge.variables}
        while True:
            ignored = {NEEDED: hidden, PEOPLE: hidden.intersection(self._robots)}.get(shown, NOBODY)
            away = {name for name, who in self._setters.items() if who and who <= ignored} - tested
            part = without_unnamed_clocks(part_of(alive, names - hidden, self._setters.keys() - away))
            game = cone_of_influence(with_hidden(alive, part), wanted)
            seen = {name for name in hidden if why_not_hidden(alive.automaton(name), game)}
            seen |= {name for variable, _ in game.variables for name in self._setters[variable] & hidden}
            seen |= {name for variable in _decisive(alive, game) for name in self._setters[variable] & hidden}
            if not seen:
                return game
            hidden -= seen


def each_once(ways: Iterable[Tuple[Group, ...]]) -> Iterator[Tuple[Group, ...]]:
    """The ways to share promises out, each when it first comes."""
    known: Set[Tuple[Group, ...]] = set()
    for groups in ways:
        if groups not in known:
            known.add(groups)
            yield groups


def have(groups: Iterable[Group], some: Iterable[Group]) -> bool:
    """True if these groups have the same teams, with the same promises and perhaps more."""
    return all(any(g.team == each.team and set(each.places) <= set(g.places) for g in groups) for each in some)


def kept(bad: Sequence[Place], watchers: Sequence[Watcher]) -> Tuple[Place, ...]:
    """What is avoided by those who follow watchers in place of their objectives."""
    followed = {watcher.objective: watcher.name for watcher in watchers}
    return tuple((followed.get(name, name), place) for name, place in bad)


def avoided(bad: Sequence[Place], watchers: Sequence[Watcher]) -> Tuple[Place, ...]:
    """The same, and what is avoided so."""
    return tuple(dict.fromkeys((*kept(bad, watchers), *bad)))


def _decisive(network: Network, game: Network) -> Iterator[str]:
    """The tests that cannot be left out, of variables that the game does not have: their variables."""
    for automaton in game.automata:
        if automaton.name != HIDDEN:
            whole, known = network.automaton(automaton.name), set(automaton.edges)
            for edge in whole.edges:
                if edge not in known and not is_loosened(edge, whole, automaton):
                    yield from edge.variables


def without_hidden(strategy: Strategy) -> Strategy:
    """The strategy in the names of the network itself."""
    if not strategy.blocks or strategy.blocks[0].state.locations[-1][0] != HIDDEN:
        return strategy
    return replace(strategy, blocks=tuple(b.with_locations(b.state.locations[:-1]) for b in strategy.blocks))
