"""Groups of robots that keep promises, and the game that each plays."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import FrozenSet, Iterator, Sequence, Tuple

from pursue_gen.proof.relaxed_reachability import Commanded, is_controllers, live
from pursue_gen.proof.shares import left_to_others
from pursue_gen.solving.subgoals import commanded_agents
from pursue_gen.solving.useful import useful
from pursue_gen.synthesis.cone import cone_of_influence
from pursue_gen.synthesis.strategy import Place, Strategy
from pursue_gen.tga.ends import is_agent
from pursue_gen.tga.hidden import HIDDEN, is_loosened, why_not_hidden, with_hidden
from pursue_gen.tga.network import Kind, Network, Objective
from pursue_gen.tga.part import part_of, without_unnamed_clocks
from pursue_gen.tga.watchers import Watcher, with_watchers

NEEDED, PEOPLE, PLACES, ALL = range(4)
"""Who is shown in a group's game: whoever its commands depend on; those, too, on whose place something else depends, at
first without other robots; all who matter."""

NOBODY: FrozenSet[str] = frozenset()


@dataclass(frozen=True)
class Group:
    """Robots, and what they keep from happening, in the objective's order."""

    team: FrozenSet[str]
    bad: Tuple[Place, ...]


class GroupGames:
    """The games of groups in a network."""

    def __init__(self, network: Network, objective: Objective) -> None:
        self._network, self._objective = network, objective
        self._robots, self._taken, self._setters = commanded_agents(network), network.taken_over, network.setters

    def game(self, group: Group, theirs: Commanded, shown: int = ALL, watchers: Tuple[Watcher, ...] = ()) -> Network:
        """The group's game: what matters to its promises, where it may do what it likes, and others these commands.

        `shown`: how much of the others is in it; the rest is hidden (see `tga.hidden`). `watchers`: followed in place
        of their objectives.
        """
        network, bad = with_watchers(self._network, watchers), kept(group.bad, watchers)
        mine = {c for c in useful(network, group.team, bad) if is_controllers(c[1], self._taken)}
        alive = left_to_others(live(network, mine | theirs)[0], theirs)
        # The automata of other promises only watch.
        names = {automaton.name for automaton in alive.automata}.difference(name for name, _ in self._objective.bad)
        names.update(name for name, _ in bad)
        alive = part_of(alive, names)
        hidden = {a.name for a in alive.automata if is_agent(a) and a.name not in group.team and shown != ALL}
        tested = {name for _, edge in mine for name in edge.variables}
        while True:
            ignored = {NEEDED: hidden, PEOPLE: hidden.intersection(self._robots)}.get(shown, NOBODY)
            away = {name for name, who in self._setters.items() if who and who <= ignored} - tested
            part = without_unnamed_clocks(part_of(alive, names - hidden, self._setters.keys() - away))
            game = cone_of_influence(with_hidden(alive, part), Objective(Kind.SAFETY, bad=bad))
            seen = {name for name in hidden if why_not_hidden(alive.automaton(name), game)}
            seen |= {name for variable, _ in game.variables for name in self._setters[variable] & hidden}
            seen |= {name for variable in _decisive(alive, game) for name in self._setters[variable] & hidden}
            if not seen:
                return game
            hidden -= seen


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
