"""The strategies of a whole mission, for nodes that show what comes next."""

from __future__ import annotations

from typing import Any, List, Mapping, Sequence

from pursue_runtime.data import reading
from pursue_runtime.missions import Source
from pursue_runtime.strategy import Strategy, read_strategies

STRATEGIES = "strategies.yaml"
"""The data file with the strategies of all controllers; missions with large ones have none."""

Strategies = Mapping[int, Sequence[Strategy]]
"""The strategies of all controllers by the number of their plan, as far as they are known: 0 is the workspace's own,
later ones are added."""


def strategies_of(source: Source) -> List[Strategy]:
    """The strategies of all controllers, and of people, where the mission's data have them. Raises DataError."""
    if not source.has(STRATEGIES):
        return []
    people = [Strategy(source.read("people.yaml"))] if source.has("people.yaml") else []
    return [*read_strategies(source.read(STRATEGIES)), *people]


def strategies_in(plan: Mapping[str, Any]) -> List[Strategy]:
    """The strategies of a new plan, as `parse_plan` returns it. Raises DataError."""
    with reading("not a plan: it"):
        parts = [*dict(plan["strategies"]).values(), *([plan["people"]] if plan.get("people") else [])]
        return [Strategy(part) for part in parts]
