"""A strategy in shares, taken apart: each share is a game of its own, and all are played at the same time.

A share is to avoid some of what is to be avoided. Its blocks name what matters to that, and its commands are for agents
whom no other share commands. In its game the commands of the others are moves of the environment, which may come at any
time but need not come: so it wins whatever the others do. Only what they command at all can happen (see
`relaxed_reachability`): who is never sent to a place is not there. Whom a share does not name may be anywhere, and do
at any time what he can do to those whom it names (see `tga.hidden`), but must not stop time (see `independence`); that
those whom another share names do not is shown there. Then each play of the network shows each share one of its plays.

What a share is to avoid and its blocks do not name is looked at apart, in a game for each of these (see `apart`).
"""

from __future__ import annotations

from dataclasses import replace
from typing import AbstractSet, Iterator, List, Sequence, Set, Tuple, Union

from pursue_gen.language.network_names import LOSE
from pursue_gen.proof.apart import games_apart, kept_apart
from pursue_gen.proof.independence import why_it_matters, with_clocks_of
from pursue_gen.proof.relaxed_reachability import Commanded, Extent, commanded, live
from pursue_gen.proof.stages import StagePart
from pursue_gen.proof.watched import why_it_may_miss
from pursue_gen.synthesis.strategy import Block, Place, Strategy
from pursue_gen.tga.hidden import HIDDEN, has_hidden, with_hidden
from pursue_gen.tga.network import Automaton, Kind, Network, Objective, with_controllability
from pursue_gen.tga.part import part_of, without_unnamed_clocks
from pursue_gen.tga.tours import Tour
from pursue_gen.tga.watchers import Watcher


def shares_of(network: Network, objective: Objective, strategy: Strategy) -> Iterator[StagePart]:
    """The shares as games of their own, in their order (`StagePart.stage` is the number of the share, from 0). After
    one with a fault there are no more. Requires a strategy in shares; if it wins all the games, and there is no fault,
    it wins in the network."""
    assert strategy.shares
    for known, parts in _latest:
        if known[2] is strategy and known == (network, objective, strategy):
            yield from parts
            return
    parts = []
    for part in _taken_apart(network, objective, strategy):
        parts.append(part)
        yield part
    _latest[:] = [((network, objective, strategy), parts)]


_latest: List[Tuple[Tuple[Network, Objective, Strategy], List[StagePart]]] = []
"""What was taken apart last: one strategy is checked several times in a row."""


def _taken_apart(network: Network, objective: Objective, strategy: Strategy) -> Iterator[StagePart]:
    """The same, looked at anew."""
    fault = _misplaced(network, objective, strategy)
    numbers = [strategy.numbers_of(k, avoided[0]) for k, avoided in enumerate(strategy.shares) if avoided]
    shares = [[strategy.blocks[n] for n in some] for some in numbers]
    alive, extent = live(network, commanded(strategy.blocks))
    fault = fault or _misnamed(network, shares)
    apart = [] if fault else [kept_apart(strategy, k) for k in range(len(shares))]
    named = [blocks[0].state.names[0].union(some) for blocks, some in zip(shares, apart)]
    watchers = [_watchers_of(strategy, k, some) for k, some in enumerate(named)]
    watched = {watcher.objective for some in watchers for watcher in some}
    fault = fault or _unguarded(objective, watched.union(*named), extent)
    if fault:
        yield StagePart(0, network, objective, strategy, (), fault)
        return
    for k, blocks in enumerate(shares):
        automata, variables = named[k], blocks[0].state.names[1]
        others = watched.union(*(some for some in named if some is not automata))
        game = left_to_others(alive, commanded(b for some in shares if some is not blocks for b in some))
        own = Strategy(tuple(blocks))
        part = with_clocks_of(without_unnamed_clocks(part_of(game, automata, variables)), network, own)
        own = replace(own, left_out_clocks=tuple(clock for clock in strategy.left_out_clocks if clock in part.clocks))
        known = (*objective.bad, *map(_place_of, watchers[k]), *map(_place_of, strategy.tours))
        wanted = Objective(Kind.SAFETY, bad=tuple(place for place in known if place[0] in automata))
        stays = {name: set() if name in others else places for name, places in extent.places.items()}
        fault = why_it_matters(game, wanted, part, stays, hiding=True)
        for watcher in watchers[k]:
            beside = automata.difference(apart[k]) | {watcher.name}
            fault = fault or why_it_may_miss(game, watcher, beside, variables)
        seen = with_hidden(game, part)
        whole = StagePart(k, seen, wanted, _beside_hidden(own) if has_hidden(seen) else own, numbers[k], fault)
        for own_game in games_apart(whole, apart[k]) if apart[k] and not fault else (whole,):
            yield own_game
            if own_game.fault:
                return


def left_to_others(network: Network, commands: Commanded) -> Network:
    """The network in which the environment decides when these commands come."""
    senders = {name for name, _ in commands}

    def left(automaton: Automaton) -> Automaton:
        if automaton.name not in senders:
            return automaton
        owned = ((edge, edge.controllable and (automaton.name, edge) not in commands) for edge in automaton.edges)
        return automaton.with_edges(with_controllability(*one) for one in owned)

    return network.with_each(left)


def _beside_hidden(strategy: Strategy) -> Strategy:
    """The strategy in the network that has an automaton for those whom it does not name."""
    blocks = (block.with_locations((*block.state.locations, (HIDDEN, HIDDEN))) for block in strategy.blocks)
    return replace(strategy, blocks=tuple(blocks))


def _watchers_of(strategy: Strategy, share: int, named: AbstractSet[str]) -> List[Watcher]:
    """The watchers among those whom the share keeps, and whose objectives it keeps so."""
    avoided = strategy.shares[share]
    kept = (w for w in strategy.watchers if w.name in named and w.objective not in named)
    return [watcher for watcher in kept if (watcher.objective, LOSE) in avoided]


def _place_of(own: Union[Watcher, Tour]) -> Place:
    """What a watcher's robots have to avoid, or the robot of a tour."""
    return own.name, LOSE


def _misplaced(network: Network, objective: Objective, strategy: Strategy) -> str:
    """Why these shares cannot be those of a strategy for the objective; "" if they may."""
    if any(automaton.name.startswith(HIDDEN) for automaton in network.automata):
        return f"a name begins with {HIDDEN}"
    if objective.reaches:
        return "an objective with a goal has no shares"
    if strategy.stages:
        return "a strategy has stages or shares, not both"
    known = {*objective.bad, *map(_place_of, strategy.watchers), *map(_place_of, strategy.tours)}
    unknown = [place for avoided in strategy.shares for place in avoided if place not in known]
    if unknown:
        return f"{'.'.join(unknown[0])} is not to be avoided"
    if not all(strategy.shares):
        return "a share has nothing to avoid"
    if None in strategy.parts:
        state = strategy.blocks[strategy.parts.index(None)].state
        return f"the block for {', '.join(map('.'.join, state.locations))} belongs to no share"
    return ""


def _misnamed(network: Network, shares: Sequence[Sequence[Block]]) -> str:
    """Why these blocks cannot be those of shares; "" if they may."""
    known: AbstractSet[str] = {automaton.name for automaton in network.automata}
    variables = dict(network.variables)
    commanding: Set[str] = set()
    for number, blocks in enumerate(shares, start=1):
        if not blocks:
            return f"no block belongs to share {number}"
        names = blocks[0].state.names
        if any(block.state.names != names for block in blocks):
            return f"the blocks of share {number} do not all name the same"
        if not names[0] <= known or not names[1] <= variables.keys():
            return "blocks name what the network does not have"
        own = {name for name, _ in commanded(blocks)}
        if own & commanding:
            return f"{min(own & commanding)} is commanded in two shares"
        commanding |= own
    return ""


def _unguarded(objective: Objective, kept: AbstractSet[str], extent: Extent) -> str:
    """What is to be avoided and may happen, though no share guards against it; "" if there is nothing. `kept`: by
    shares, or because watchers are."""
    open_ones: List[str] = [
        f"{name}.{place}" for name, place in objective.bad if name not in kept and place in extent.places[name]
    ]
    return f"no share guards against {open_ones[0]}" if open_ones else ""
