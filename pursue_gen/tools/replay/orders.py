"""What a strategy wants in a state: the workspace's own, or one that was made during the mission (pursue/plan)."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, Dict, FrozenSet, Iterable, List, Mapping, Optional, Tuple, TypeVar

from pursue_gen.synthesis.lookup import Entry, StateTable
from pursue_gen.synthesis.plan_text import read_constraint
from pursue_gen.synthesis.strategy import Constraint, Strategy, Zone
from pursue_gen.tga.event_words import event_word
from pursue_gen.tools.replay.moves import DiscreteState, Move, Moves, after
from pursue_runtime.numbers import exact

EPSILON = 1e-6
Since = TypeVar("Since")


@dataclass(frozen=True)
class Command:
    """In one of the zones the agent is to do the event."""

    agent: str
    event: str
    zones: Tuple[Zone, ...]


@dataclass(frozen=True)
class Orders:
    """A strategy by state. `owners`: the nodes that command an agent; `reaction`: how late a command may come, in time
    units; `left_out_clocks`: those that do not matter to it."""

    commands: StateTable[Command] = field(default_factory=StateTable)
    cover: StateTable[Tuple[Zone, ...]] = field(default_factory=StateTable)
    owners: Mapping[str, FrozenSet[str]] = field(default_factory=dict)
    reaction: float = 0.1
    left_out_clocks: FrozenSet[str] = frozenset()

    def after(
        self, move: Move, place: DiscreteState, moves: Moves, since: Mapping[Entry, Since], before: Since, now: Since
    ) -> Dict[Entry, Since]:
        """For each block that holds after a move, since when what it decides stands: as before it (`since`; `before`
        where that says nothing), or from `now` on. Clocks that the strategy leaves out do not matter."""
        there, resets = after(move, place)
        stands = self.cover.standing(place.facts, there.facts, set(resets) - self.left_out_clocks, moves.clocks)
        return {block: since.get(block, before) if known else now for block, known in stands.items()}


def since_for(agent: str, orders: Optional[Orders], since: Mapping[Entry, Since], now: Since) -> List[Since]:
    """Since when what the blocks decide that may command the agent stands: those that do, else those that name it, else
    all; `now` where none holds."""
    commanding = [
        value
        for entry, value in since.items()
        if orders is not None and any(command.agent == agent for command in orders.commands.entered(entry))
    ]
    named = [value for (names, _), value in since.items() if agent in names]
    return commanding or named or list(since.values()) or [now]


def of_strategy(strategy: Strategy, commands_of: Iterable[Tuple[str, Iterable[str]]], reaction: Fraction) -> Orders:
    """The workspace's own strategy. `commands_of`: controllers, and the agents that each commands."""
    owners, left_out = _owners(commands_of), frozenset(strategy.left_out_clocks)
    orders = Orders(owners=owners, reaction=float(reaction), left_out_clocks=left_out)
    for block in strategy.blocks:
        state = block.state.facts
        for command in block.commands:
            first = command.moves[0]
            orders.commands.add(state, Command(first.automaton, event_word(first.automaton, first.edge), command.zones))
        orders.cover.add(state, (*block.wait, *(zone for command in block.commands for zone in command.zones)))
    return orders


def of_plan(data: Mapping[str, Any]) -> Orders:
    """A strategy as it stands on pursue/plan. Raises ValueError where it cannot be read."""
    try:
        strategies = {**data["strategies"], **({"UI": data["people"]} if data.get("people") else {})}
        owners = _owners((name, part["commands_agents"]) for name, part in strategies.items())
        reaction = max((exact(part["reaction"]) for part in strategies.values()), default=Fraction(1, 10))
        left_out = frozenset(map(str, data["cover"].get("left_out_clocks", ())))
        orders = Orders(owners=owners, reaction=float(reaction), left_out_clocks=left_out)
        for part in strategies.values():
            for entry in part["strategy"]:
                for command in entry["commands"]:
                    zones = tuple(read_zone(zone) for zone in command["when"])
                    orders.commands.add(entry["state"], Command(str(command["agent"]), str(command["do"]), zones))
        for entry in data["cover"]["cover"]:
            texts = [*entry.get("wait", ()), *(text for each in entry.get("commands", ()) for text in each["when"])]
            orders.cover.add(entry["state"], tuple(map(read_zone, texts)))
    except (KeyError, TypeError, AttributeError) as problem:
        raise ValueError(f"it lacks or misspells something: {problem!r}") from None
    return orders


def _owners(parts: Iterable[Tuple[str, Iterable[str]]]) -> Dict[str, FrozenSet[str]]:
    owners: Dict[str, FrozenSet[str]] = {}
    for controller, agents in parts:
        for agent in agents:
            owners[agent] = owners.get(agent, frozenset()) | {controller}
    return owners


def read_zone(text: str) -> Zone:
    """A zone as it stands in strategy.yaml. Raises ValueError."""
    if text.strip() == "always":
        return ()
    zone: List[Constraint] = []
    for part in text.split("&&"):
        found = read_constraint("".join(part.split()))
        if found is None:
            raise ValueError(f"not a comparison of clocks: {part.strip()[:60]!r}")
        zone += found
    return tuple(zone)


def in_time(zones: Iterable[Zone], clocks: Mapping[str, float], back: float, slack: float) -> bool:
    """True if the clocks are in one of the zones, or were within the last `back` time units, but for `slack`."""
    return any(earliest <= latest for earliest, latest in (_stay(zone, clocks, back, slack) for zone in zones))


def due_since(zones: Iterable[Zone], clocks: Mapping[str, float], back: float, least: float = 0.0) -> Optional[float]:
    """How many time units ago the clocks came into one of the zones, in the last `back` ones, for as many as `least`;
    None: they did not."""
    stays = (_stay(zone, clocks, back, 0.0) for zone in zones)
    return max((latest for earliest, latest in stays if latest - earliest >= least), default=None)


def _stay(zone: Zone, clocks: Mapping[str, float], back: float, slack: float) -> Tuple[float, float]:
    """How many time units ago the clocks left a zone, and came into it; the first is more where they were not in it."""
    earliest, latest = 0.0, max(0.0, back)
    for constraint in zone:
        value = clocks.get(constraint.left or "", 0.0) - clocks.get(constraint.right or "", 0.0)
        excess = value - float(constraint.bound) - slack - EPSILON
        if constraint.right is None:  # clock - delay <= bound
            earliest = max(earliest, excess)
        elif constraint.left is None:  # -(clock - delay) <= bound
            latest = min(latest, -excess)
        elif excess > 0:
            return math.inf, 0.0
    return earliest, latest
