"""Random robots that change places, and what their strategies are as blocks of the whole game."""

from __future__ import annotations

from dataclasses import replace
from random import Random
from typing import Dict, List, Optional, Tuple

from hypothesis import strategies as st

from pursue_gen.language import parse
from pursue_gen.solving.rules import DEFAULT, Rules, played
from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.synthesis.game import Game as Tables
from pursue_gen.synthesis.game import State, initial_state, is_goal, joint_moves
from pursue_gen.synthesis.strategy import Block, Command, DiscreteState, Strategy, Zone, with_automata_of
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Network, Objective
from tests.choices import member_of

Game = Tuple[Network, Objective]

_MOST = 6_000
"""So many discrete states may be met."""


@st.composite
def passing_texts(draw: st.DrawFn) -> str:
    """Two or three robots on a small floor, each with work somewhere else; no two are ever at one place, or at some."""
    count, robots = draw(st.integers(4, 6)), draw(st.integers(2, 3))
    places = [f"p{k}" for k in range(count)]
    ways = {(draw(st.integers(0, k - 1)), k) for k in range(1, count)}
    ways |= {tuple(sorted(pair)) for pair in draw(st.sets(member_of(_pairs(count)), max_size=2))}
    order = Random(draw(st.integers(0, 10**6)))
    starts, works = order.sample(places, robots), order.sample(places, robots)
    where = draw(member_of(("", "", "", f" at {draw(member_of(places))}")))
    lines = [f'poi "{place}"' for place in places]
    lines += [f"connect p{a} and p{b} distance {draw(st.integers(1, 3))}" for a, b in sorted(ways)]
    lines += [f'event "work{k}" location {place} duration 2' for k, place in enumerate(works)]
    ordered = draw(st.booleans())
    if ordered:
        lines += ['event "done"', *(f'rule "rule{k}": work{k} before done' for k in range(robots))]
    for k, place in enumerate(starts):
        more = ", done" if ordered and k == 0 else ""
        lines.append(f'agent "bot{k}" controllable mobile 1 location {place} can_do work{k}{more}')
    if draw(st.booleans()):
        lines += [f"objective: bot{a} never_with bot{b}{where}" for a, b in _pairs(robots)]
    else:
        lines += [f"objective: place {place} holds 1 robot" for place in places if where in ("", f" at {place}")]
        lines += [f"objective: way p{a} to p{b} holds 1 robot" for a, b in sorted(ways) if not where]
    lines += ["reach_objective: do done"] if ordered else [f"reach_objective: do work{k}" for k in range(robots)]
    return "\n".join(lines)


@st.composite
def patrolling_texts(draw: st.DrawFn) -> str:
    """Two robots that patrol places of a small floor, each of whose places holds one."""
    count = draw(st.integers(3, 5))
    ways = {(draw(st.integers(0, k - 1)), k) for k in range(1, count)}
    ways |= {tuple(sorted(pair)) for pair in draw(st.sets(member_of(_pairs(count)), max_size=2))}
    order = Random(draw(st.integers(0, 10**6)))
    starts = order.sample(range(count), 2)
    lines = [f'poi "p{k}"' for k in range(count)]
    lines += [f"connect p{a} and p{b} distance {draw(st.integers(1, 3))}" for a, b in sorted(ways)]
    lines += [f'agent "bot{k}" controllable mobile 1 location p{place}' for k, place in enumerate(starts)]
    lines += ["objective: every place holds 1 robot", "objective: every way holds 1 robot"]
    visits = draw(st.lists(st.integers(0, count - 1), min_size=1, max_size=3, unique=True))
    who = member_of(("any robot", "any robot", "bot0", "bot1"))
    return "\n".join([*lines, *(f"objective: patrol p{place} every EVERY by {draw(who)}" for place in visits)])


def _pairs(count: int) -> List[Tuple[int, int]]:
    return [(a, b) for b in range(count) for a in range(b)]


def game_of(text: str, rules: Rules = DEFAULT) -> Game:
    """A game of a scenario."""
    scenario = parse(text, "passing.pur", "passing")
    return played(translate(scenario), rules), scenario_objective(scenario)


def of_the_whole(game: Game, strategy: Strategy) -> Optional[Tuple[Network, Strategy]]:
    """The same strategy in blocks that name everything, in the network with its orders of passage; None where it meets
    too many states."""
    network, objective = with_automata_of(game[0], strategy), game[1]
    tables = compile_game(network, objective)
    blocks: Dict[State, Block] = {}
    waiting = [initial_state(tables)]
    while waiting:
        state = waiting.pop()
        if state in blocks or is_goal(tables, state):
            continue
        if len(blocks) > _MOST:
            return None
        blocks[state] = block = _block(tables, strategy, state)
        edges = [command.moves[0].edge for command in block.commands]
        for move in joint_moves(tables, state):
            if not move.controllable or tables.origins[move.edges[0]] in edges:
                waiting.append(move.target)
    return network, Strategy(tuple(blocks.values()))


def _block(tables: Tables, strategy: Strategy, state: State) -> Block:
    """What all blocks say that hold in a state: to wait as long as each of them does, or what any of them commands."""
    here = DiscreteState(
        tuple((a.name, a.locations[k]) for a, k in zip(tables.automata, state.locations)),
        tuple(zip(tables.variables, state.values)),
    )
    named = {*here.locations, *here.values}
    wait: Zone = ()
    commands: List[Command] = []
    for block in strategy.blocks:
        if block.commands and named.issuperset((*block.state.locations, *block.state.values)):
            wait += block.wait[0] if block.wait else ()
            commands += block.commands
    return Block(here, (wait,), tuple(dict.fromkeys(commands)))


@st.composite
def damaged(draw: st.DrawFn, strategy: Strategy) -> Strategy:
    """The strategy with one thing changed: an order of passage, what a block names or commands, or a block less."""
    what = draw(member_of(("swap", "drop visit", "rename", "unname", "elsewhere", "reroute", "unsay", "hurry")))
    blocks = list(strategy.blocks)
    orders = [k for k, passage in enumerate(strategy.passages) if passage.robots]
    if what in ("swap", "drop visit", "rename") and orders:
        k = draw(member_of(orders))
        robots = list(strategy.passages[k].robots)
        a, b = (draw(st.integers(0, len(robots) - 1)) for _ in range(2))
        if what == "swap":
            robots[a], robots[b] = robots[b], robots[a]
        elif what == "drop visit":
            del robots[a]
        else:
            robots[a] = draw(member_of([f"bot{n}" for n in range(3)]))
        passages = list(strategy.passages)
        passages[k] = replace(passages[k], robots=tuple(robots))
        return replace(strategy, passages=tuple(passages))
    commanding = [k for k, block in enumerate(blocks) if block.commands]
    k = draw(member_of(commanding))
    state = blocks[k].state
    if not state.locations:
        return strategy
    if what == "unsay":
        del blocks[k]
    elif what == "hurry":
        commands = tuple(replace(command, zones=((),)) for command in blocks[k].commands)
        blocks[k] = replace(blocks[k], wait=draw(member_of(((), ((),)))), commands=commands)
    elif what == "elsewhere":
        name, place = draw(member_of(state.locations))
        others = [p for block in blocks for n, p in block.state.locations if n == name and p != place]
        where = draw(member_of(others or [place]))
        places = tuple((n, where if n == name else p) for n, p in state.locations)
        blocks[k] = replace(blocks[k], state=DiscreteState(places, state.values))
    elif what == "reroute":
        sender = blocks[k].commands[0].moves[0].automaton
        theirs = [blocks[n].commands for n in commanding if blocks[n].commands[0].moves[0].automaton == sender]
        blocks[k] = replace(blocks[k], commands=draw(member_of(theirs)))
    else:
        gone = draw(member_of(state.locations))
        kept = tuple(place for place in state.locations if place != gone)
        blocks[k] = replace(blocks[k], state=DiscreteState(kept, state.values))
    return replace(strategy, blocks=tuple(blocks))
