"""The line of a plan that names what it does not speak of, written and read:

    -- Left out: visitor Pvisitor
"""

from __future__ import annotations

import re
from typing import List, Set

from pursue_gen.diagnostics import PursueError, Span, error
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga.network import Network
from pursue_gen.tga.part import part_of

_LEFT_OUT = re.compile(r"^ -- Left out:(.*)$", re.MULTILINE)


def left_out_lines(strategy: Strategy, network: Network) -> List[str]:
    """The line with the automata and variables that the strategy does not name; none where it names everything."""
    if not strategy.blocks:
        return []
    state = strategy.blocks[0].state
    named = {name for name, _ in (*state.locations, *state.values)}
    every = (*(automaton.name for automaton in network.automata), *(name for name, _ in network.variables))
    left = [name for name in every if name not in named]
    return [f" -- Left out: {' '.join(left)}"] if left else []


def spoken_of(text: str, network: Network, file: str) -> Network:
    """The part of the network that a plan speaks of, whose text above its title this is.

    Raises PursueError where it leaves out what the network does not have.
    """
    left: Set[str] = set()
    automata, variables = {a.name for a in network.automata}, {name for name, _ in network.variables}
    for match in _LEFT_OUT.finditer(text):
        left.update(match.group(1).split())
        unknown = sorted(left - automata - variables)
        if unknown:
            line = text.count("\n", 0, match.start()) + 1
            span = Span(file, line, 1, line, len(match.group()) + 1)
            message = f"the plan leaves out '{unknown[0]}', which the network does not have"
            hint = "read the plan with the network that it was made for"
            raise PursueError([error("PLN005", message, span, hint)])
    return part_of(network, automata - left, variables - left)
