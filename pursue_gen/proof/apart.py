"""What a share keeps though its blocks do not name it: automata on whose location its commands do not depend.

Each such automaton is looked at alone, beside those that the blocks name, in a game in which each block is repeated for
each of its locations. The others of that kind are hidden there and have games of their own, so a round of many places
takes as many small games, and not one of all of them.

A command is not made stale by what the strategy does not name: if only the automaton changes, a command on its way
stays on its way. In the game apart it is given anew, and may then be late once more; if nothing tells what to do there,
that game fails. For that, no other advice may follow in a block where a command is due: the block has at most one
command, and waits only before it, by a clock that the automaton does not reset.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Iterator, List, Mapping, Sequence, Tuple

from pursue_gen.proof.independence import why_it_matters
from pursue_gen.proof.stages import StagePart
from pursue_gen.synthesis.strategy import Block, Command, Move, Place, Strategy, Zone
from pursue_gen.tga.network import Automaton, Network
from pursue_gen.tga.part import part_of


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
