"""A strategy in stages, taken apart: each part of a stage is a game of its own, from all that may be when it begins.

A stage ends when its milestones are reached, locations of automata or values of variables, and the next one begins
there. Its parts, one for each milestone, are played at the same time, by different agents. The blocks of a part name
the agents that matter to it and the milestones of the stages before, which holds them apart from the blocks of other
stages. While a stage lasts, nobody commands what only other stages command (see `relaxed_reachability`); what a part
does not name must not matter to it (see `independence`). Of where a stage begins nothing is used but what `stage_entry`
says: so a part that is won from all these points is won, whatever was before, and every play goes through all stages to
the goal. What is to be avoided, and cannot happen any more in a stage, needs no guard there.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import AbstractSet, Dict, Iterable, Iterator, List, Mapping, Optional, Sequence, Set, Tuple

from pursue_gen.proof.independence import why_it_matters
from pursue_gen.proof.moves import Arena, Situation, joint_move
from pursue_gen.proof.relaxed_reachability import Extent, commanded, live
from pursue_gen.proof.stage_entry import Known, State, after_part, at_start, moved
from pursue_gen.synthesis.strategy import Block, DiscreteState, Place, Strategy, with_edges
from pursue_gen.tga.begin import BEGIN, BEGUN, beginning_in
from pursue_gen.tga.ending import REACHED, ending_at, is_value, owner_of
from pursue_gen.tga.network import Edge, Kind, Network, Objective
from pursue_gen.tga.part import part_of
from pursue_gen.tga.scale import common_denominator


@dataclass(frozen=True)
class StagePart:
    """A part of a stage as a game: it is won if the strategy wins the game, unless there is a `fault`.

    `stage` counts from 0. `numbers`: for each block of the strategy its number in the whole one; -1 for the one in
    which the stage begins.
    """

    stage: int
    game: Network
    objective: Objective
    strategy: Strategy
    numbers: Tuple[int, ...]
    fault: str = ""


def parts_of(network: Network, objective: Objective, strategy: Strategy) -> Iterator[StagePart]:
    """The parts of all stages, in the order of the stages. After one with a fault there are no more.

    Requires a strategy in stages; if it wins all the games, and there is no fault, it wins in the network.
    """
    assert strategy.stages
    fault = _misplaced(network, objective, strategy)
    known = at_start(network)
    for stage, milestones in enumerate(strategy.stages):
        numbers = {place: strategy.numbers_of(stage, place) for place in milestones}
        blocks = {place: [strategy.blocks[n] for n in numbers[place]] for place in milestones}
        fault = fault or _misnamed(network, strategy, stage, blocks, known)
        if fault:
            yield StagePart(stage, network, objective, strategy, (), fault)
            return
        alive, extent = live(network, commanded(block for some in blocks.values() for block in some), known.extent)
        following = after_stage(network, known, blocks)
        if following is None:
            yield StagePart(stage, network, objective, strategy, (), "it may begin in too many states")
            return
        # The proof of each part shows that its agents do not stop time before it ends.
        busy = {name for own in blocks.values() for name in own[0].state.names[0]}
        resting = {**extent.places, **{name: following.extent.places[name] for name in busy}}
        for place in milestones:
            part = part_of(alive, *blocks[place][0].state.names)
            ending = ending_at(part, place, owner_of(network, place[0]))
            wanted = stage_objective(objective, ending.goal, extent)
            starts = known.states(part)
            assert starts is not None
            fault = why_it_matters(alive, wanted, part, resting, network if stage else None)
            if wanted.avoids and len(milestones) > 1:
                fault = "where one part has ended before the others, nobody guards against what is to be avoided"
            if fault:
                yield StagePart(stage, part, wanted, strategy, (), fault)
                return
            own = with_edges(blocks[place], ending.changed)
            if stage == 0:
                yield StagePart(stage, ending.network, wanted, Strategy(own), numbers[place])
            else:
                game = beginning_in(ending.network, starts)
                yield StagePart(stage, game, wanted, _begun(ending.network, own), (-1, *numbers[place]))
        known = following
        lost = [place for place in milestones if not is_sure(known, place)]
        fault = f"{'.'.join(lost[0])} may be lost before the stage ends" if lost else ""


def stage_objective(objective: Objective, goal: Place, extent: Extent) -> Objective:
    """What is wanted in a part of a stage: to come to its goal, and to avoid what may happen at all in the stage."""
    if not (objective.reaches and objective.avoids):
        return replace(objective, goal=(goal,))
    bad = tuple((name, location) for name, location in objective.bad if location in extent.places[name])
    return Objective(Kind.REACH_WHILE_SAFE if bad else Kind.REACH, (goal,), bad)


def is_sure(known: Known, milestone: Place) -> bool:
    """True if the milestone is reached wherever the network may be."""
    name, value = milestone
    if name in known.extent.places:
        return known.extent.places[name] == {value}
    return known.extent.values[name] == {int(value)}


def after_stage(network: Network, known: Known, blocks: Mapping[Place, Sequence[Block]]) -> Optional[Known]:
    """What is known after a stage with these blocks for each of its milestones, that began with what is `known`.

    None where a part of it may begin in too many states. Requires a block for each milestone, and that all of those for
    one name the same.
    """
    assert all(blocks.values())
    alive, extent = live(network, commanded(block for some in blocks.values() for block in some), known.extent)
    following = moved(known, alive)
    for place, own in blocks.items():
        part = part_of(alive, *own[0].state.names)
        starts = known.states(part)
        if starts is None:
            return None
        idle = None if len(blocks) == 1 else live(network, _others(blocks, place), extent)[0]
        following = after_part(following, part, _ends(part, place, own, starts), idle)
    return following


def _ends(part: Network, milestone: Place, blocks: Iterable[Block], starts: Sequence[State]) -> List[State]:
    """The discrete states at the milestone to which the commands of the blocks may lead, whatever the clocks are."""
    timeless = replace(part, start=())
    arena = Arena(timeless, common_denominator(timeless.times))
    names = [*(automaton.name for automaton in part.automata), *(name for name, _ in part.variables)]
    number = names.index(milestone[0])
    said: Dict[State, List[Block]] = {}
    for block in blocks:
        state = arena.state_of(block.state)
        if state is not None:
            said.setdefault(state, []).append(block)
    met: Set[State] = set(starts)
    pending = list(starts)
    ends: List[State] = []
    while pending:
        state = pending.pop()
        if (*state[0], *map(str, state[1]))[number] == milestone[1]:
            ends.append(state)
            continue
        for target in _next(arena.situation(state), said.get(state, ())):
            if target not in met:
                met.add(target)
                pending.append(target)
    return ends


def _next(situation: Situation, blocks: Iterable[Block]) -> Iterator[State]:
    for move in situation.moves:
        if not move.controllable and move.enabled is not None:
            yield move.target
    for block in blocks:
        for command in block.commands:
            made, _ = joint_move(command, situation)
            if made is not None and made.enabled is not None:
                yield made.target


def _others(blocks: Mapping[Place, Sequence[Block]], place: Place) -> AbstractSet[Tuple[str, Edge]]:
    """What the other parts of the stage command."""
    return commanded(block for other, some in blocks.items() if other != place for block in some)


def _misplaced(network: Network, objective: Objective, strategy: Strategy) -> str:
    """Why these stages cannot be those of a strategy for the objective; "" if they may."""
    if not objective.reaches:
        return "an objective without a goal has no stages"
    milestones = [place for stage in strategy.stages for place in stage]
    if len({name for name, _ in milestones}) != len(milestones):
        return "an automaton has two milestones"
    if len(objective.goal) != 1 or strategy.stages[-1] != objective.goal:
        return "the last stage does not end at the goal"
    if None in strategy.parts:
        state = strategy.blocks[strategy.parts.index(None)].state
        where = ", ".join(map(".".join, state.locations))
        return f"the block for {where} leads to no milestone"
    names_in_use = [*network.clocks, *network.channels, *(automaton.name for automaton in network.automata)]
    names_in_use += [location.name for automaton in network.automata for location in automaton.locations]
    for reserved in (BEGIN, REACHED):
        if any(name.startswith(reserved) for name in names_in_use):
            return f"a name begins with {reserved}"
    known = {(automaton.name, location.name) for automaton in network.automata for location in automaton.locations}
    return next((f"there is no {'.'.join(m)}" for m in milestones if m not in known and not is_value(network, m)), "")


def _misnamed(
    network: Network, strategy: Strategy, stage: int, blocks: Mapping[Place, Sequence[Block]], known: Known
) -> str:
    """Why these blocks cannot be those of the parts of a stage; "" if they may."""
    before = {name for milestones in strategy.stages[:stage] for name, _ in milestones}
    owner = {name: owner_of(network, name) or name for name, _ in blocks}
    busy: Set[str] = set()
    for place, own in blocks.items():
        if not own:
            return f"no block leads to {place[0]}.{place[1]}"
        automata, variables = own[0].state.names
        if any(block.state.names != (automata, variables) for block in own):
            return f"the blocks that lead to {place[0]}.{place[1]} do not all name the same"
        if not automata.issubset(a.name for a in network.automata) or not variables.issubset(dict(network.variables)):
            return "blocks name what the network does not have"
        if place[0] in variables and int(place[1]) in known.extent.values[place[0]]:
            return f"{place[0]} may be {place[1]} before"
        missing = sorted(before.union([place[0], owner[place[0]]]) - automata - variables)
        missing += [name for a in sorted(automata) for name in known.owned[a] if name not in variables]
        if missing:
            return f"the blocks that lead to {place[0]}.{place[1]} do not name {missing[0]}"
        busy.update({name for name, _ in _others(blocks, place)} & automata)
        busy.update({owner[other] for other, _ in blocks if other != place[0]} & automata)
    return f"{min(busy)} matters to two parts of a stage" if busy else ""


def _begun(part: Network, blocks: Iterable[Block]) -> Strategy:
    """The blocks in the network in which the stage begins anywhere, behind one for its beginning."""
    first = DiscreteState((*((a.name, BEGIN) for a in part.automata), (BEGIN, BEGIN)), part.variables)
    said = (block.with_locations((*block.state.locations, (BEGIN, BEGUN))) for block in blocks)
    return Strategy((Block(first, ((),), ()), *said))
