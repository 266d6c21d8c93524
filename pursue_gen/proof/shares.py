"""A strategy in shares, taken apart: each share is a game of its own, and all are played at the same time.

A share is to avoid some of what is to be avoided. Its blocks name what matters to that, and its commands are for agents
whom no other share commands. In its game the commands of the others are moves of the environment, which may come at any
time but need not come: so it wins whatever the others do. Only what they command at all can happen (see
`relaxed_reachability`): who is never sent to a place is not there. Whom a share does not name may be anywhere, and do
at any time what he can do to those whom it names (see `tga.hidden`), but must not stop time (see `independence`); that
those whom another share names do not is shown there. Then each play of the network shows each share one of its plays.

What a share keeps though its blocks do not name it, automata on whose location its commands do not depend, is looked at
apart: each alone, beside those that the blocks name, in a game in which each block is repeated for each of its
locations. The others of that kind are hidden there and have games of their own, so a round of many places takes as many
small games, and not one of all of them.

A command is not made stale by what the strategy does not name: if only the automaton changes, a command on its way
stays on its way. In the game apart it is given anew, and may then be late once more; if nothing tells what to do there,
that game fails. For that, no other advice may follow in a block where a command is due: the block has at most one
command, and waits only before it, by a clock that the automaton does not reset.
"""

from __future__ import annotations

from dataclasses import replace
from typing import AbstractSet, Iterator, List, Mapping, Sequence, Set, Tuple, Union

from pursue_gen.language.network_names import AT_RISK, LOSE
from pursue_gen.proof.independence import why_it_matters, with_clocks_of
from pursue_gen.proof.moves import Arena, State
from pursue_gen.proof.relaxed_reachability import Commanded, Extent, commanded, live
from pursue_gen.proof.stages import StagePart
from pursue_gen.synthesis.strategy import Block, Command, Move, Place, Strategy, Zone
from pursue_gen.tga.hidden import HIDDEN, has_hidden, with_hidden
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Kind, Network, Objective, with_controllability
from pursue_gen.tga.part import part_of, without_unnamed_clocks
from pursue_gen.tga.scale import common_denominator
from pursue_gen.tga.tours import Tour
from pursue_gen.tga.watchers import Watcher
from pursue_gen.zones.dbm import raw


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


_MOST = 100_000
"""So many discrete states are looked at. Measured on 40 lab scenarios."""


def why_it_may_miss(network: Network, watcher: Watcher, automata: AbstractSet[str], variables: AbstractSet[str]) -> str:
    """Why the objective may be broken though the watcher is kept; "" if it cannot: whenever the objective's automaton
    waits with a deadline, so does the watcher's, with a clock that is at least as large and a deadline that is no
    longer. All plays are looked at, whatever the clocks are.

    `automata` and `variables` are seen, the others may be anywhere (see `tga.hidden`). Requires that the watcher is one
    of the network's automata, and seen.
    """
    assert watcher.name in automata
    watched, narrower = network.automaton(watcher.objective), network.automaton(watcher.name)
    fault = _why_it_is_none(watched, narrower)
    if fault:
        return fault
    freed = network.with_each(lambda a: a.with_edges(_with_any(a, variables)) if a is watched else a)
    game = with_hidden(freed, part_of(freed, automata | {watcher.objective}, variables))
    arena = Arena(game, common_denominator(game.times))
    places = {automaton.name: k for k, automaton in enumerate(game.automata)}
    theirs, own = places[watcher.objective], places[watcher.name]
    since, own_since = (arena.clock[_deadline(automaton).clock] for automaton in (watched, narrower))

    def is_missed(state: State) -> bool:
        return state[0][theirs] == AT_RISK != state[0][own]

    found, waiting = {arena.initial}, [arena.initial]
    if is_missed(arena.initial):
        return "the objective is at risk before it is"
    longer = arena.start.m[since * arena.start.dim + own_since] > raw(0, strict=False)
    if arena.initial[0][theirs] == AT_RISK and longer:  # in the middle of a play
        return "the objective may have been at risk for longer"
    while waiting:
        state = waiting.pop()
        for move in arena.situation(state).moves:
            target = move.target
            if move.enabled is None or LOSE in (target[0][theirs], target[0][own]):
                continue  # how long each is at risk is compared by the clocks
            if is_missed(target):
                return "the objective may be at risk when it is not"
            stays = state[0][theirs] == AT_RISK and own_since not in move.resets
            if target[0][theirs] == AT_RISK and since not in move.resets and not stays:
                return "the objective may be at risk for longer"
            if target not in found:
                found.add(target)
                waiting.append(target)
        if len(found) > _MOST:
            return "there are too many states to look at"
    return ""


def _why_it_is_none(watched: Automaton, own: Automaton) -> str:
    """Why these are no automata of an objective with a deadline and its watcher; "" if they are."""
    for automaton in (watched, own):
        bounds = automaton.stays.get(AT_RISK, ())
        if len(bounds) != 1 or bounds[0].op != "<=":
            return f"{automaton.name} has no deadline"
        for edge in automaton.edges:
            if edge.target == LOSE and (edge.source != AT_RISK or edge.sync is not None or not edge.controllable):
                return f"{automaton.name} is lost otherwise than by its deadline"
            if edge.assign or edge.guard.clocks or edge.sent is not None:
                return f"{automaton.name} does more than watch"
    if _deadline(watched).bound < _deadline(own).bound:
        return f"{own.name} has a longer deadline"
    return ""


def _deadline(automaton: Automaton) -> ClockBound:
    (bound,) = automaton.stays[AT_RISK]
    return bound


def _with_any(watched: Automaton, variables: AbstractSet[str]) -> Iterator[Edge]:
    """The automaton's edges, where other variables may have any value: what tests them may happen, or not."""
    for edge in watched.edges:
        tests = tuple(c for c in edge.guard.integers if all(test.variable in variables for test in c))
        yield replace(edge, guard=Guard(edge.guard.clocks, tests))
        if len(tests) < len(edge.guard.integers):
            yield Edge(edge.source, edge.source, sync=edge.sync)


def kept_apart(strategy: Strategy, share: int) -> Sequence[str]:
    """The automata that a share keeps and its blocks do not name, without those of objectives that watchers have in
    their place. Requires the number of a share that names what it avoids."""
    assert strategy.shares[share]
    avoided = strategy.shares[share]
    named = {name for n in strategy.numbers_of(share, avoided[0]) for name in strategy.blocks[n].state.names[0]}
    kept = {name for name, _ in avoided} | named
    watched = {watcher.objective for watcher in strategy.watchers if watcher.name in kept}
    return tuple(dict.fromkeys(name for name, _ in avoided if name not in named | watched))


def games_apart(share: StagePart, names: Sequence[str]) -> Iterator[StagePart]:
    """A game for each of these automata, beside those that the share's blocks name. Requires automata of the share's
    game; if the strategy wins all the games, and there is no fault, it wins that one."""
    fault = _why_not_apart(share.strategy.blocks, [share.game.automaton(name) for name in names])
    for name in names:
        others = set(names) - {name}
        kept = {automaton.name for automaton in share.game.automata} - others
        game = part_of(share.game, kept)
        wanted = replace(share.objective, bad=tuple(place for place in share.objective.bad if place[0] not in others))
        fault = fault or why_it_matters(share.game, wanted, game, {each: set() for each in others})
        blocks, numbers = _lifted(share.strategy.blocks, game, name, wanted.bad)
        clocks = tuple(clock for clock in share.strategy.left_out_clocks if clock in game.clocks)
        own = replace(share.strategy, blocks=blocks, left_out_clocks=clocks)
        yield StagePart(share.stage, game, wanted, own, tuple(share.numbers[k] for k in numbers), fault)


def _why_not_apart(blocks: Sequence[Block], automata: Sequence[Automaton]) -> str:
    """Why a move of one of these automata may end a command of the blocks; "" if it cannot."""
    own = {clock for automaton in automata for clock in automaton.clocks}
    for block in blocks:
        due = [zone for command in block.commands for zone in command.zones]
        if any(bound.left in own or bound.right in own for zone in block.zones for bound in zone):
            return "it compares clocks of what it keeps and does not name"
        if len(block.commands) > 1 or not all(_is_before(wait, zone) for wait in block.wait for zone in due):
            return "what it keeps and does not name may change while a command is on its way, and is not the last word"
    return ""


def _is_before(zone: Zone, other: Zone) -> bool:
    """True if a clock is smaller in all of the zone than anywhere in the other one."""
    for above in (bound for bound in zone if bound.right is None):
        for below in (bound for bound in other if bound.left is None and bound.right == above.left):
            if above.bound < -below.bound or (above.bound == -below.bound and (above.strict or below.strict)):
                return True
    return False


def _lifted(
    blocks: Sequence[Block], game: Network, name: str, bad: Sequence[Place]
) -> Tuple[Tuple[Block, ...], Tuple[int, ...]]:
    """The blocks for each location of this automaton of the game, but for those that are to be avoided, and for each
    the number of the one that it comes from.

    Where the automaton may receive a command in several ways, the command is none in its game.
    """
    place = next(k for k, automaton in enumerate(game.automata) if automaton.name == name)
    own = game.automata[place]
    found: List[Block] = []
    numbers: List[int] = []
    before = {automaton.name for automaton in game.automata[:place]}
    for number, block in enumerate(blocks):
        locations = block.state.locations
        at = sum(each in before for each, _ in locations)
        for location in (each.name for each in own.locations if (name, each.name) not in bad):
            moved = block.with_locations((*locations[:at], (name, location), *locations[at:]))
            commands = tuple(_heard(command, own, location, dict(block.state.values)) for command in block.commands)
            found.append(replace(moved, commands=commands))
            numbers.append(number)
    return tuple(found), tuple(numbers)


def _heard(command: Command, automaton: Automaton, location: str, values: Mapping[str, int]) -> Command:
    """The command with the edges on which the automaton receives it there."""
    sent = command.moves[0].edge.sent
    there = (edge for edge in automaton.edges if edge.source == location and edge.received is not None)
    received = (Move(automaton.name, edge) for edge in there if edge.received == sent and edge.guard.holds(values))
    return replace(command, moves=(*command.moves, *received))
