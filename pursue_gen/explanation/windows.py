"""How the windows that an author wrote could change: of events that take `3 to 5`, and of an agent's travel times."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Callable, Iterator, Sequence

from pursue_gen.diagnostics import Span
from pursue_gen.language.scenario import Event, Scenario, Travel

SLOWER = 32
"""How many times slower an agent, or longer an event, is tried."""


@dataclass(frozen=True)
class WindowEnd:
    """An end of a window that may be another one of `values`, the smallest change first; times are in time units.

    `make` is the scenario with that value, `say` describes it. `what`: latest, earliest or travel; `name`: whose.
    """

    what: str
    name: str
    label: str
    before: int
    values: Sequence[int]
    make: Callable[[int], Scenario]
    say: Callable[[int], str]
    span: Span


def event_windows(scenario: Scenario, event: Event) -> Iterator[WindowEnd]:
    """An event that ends earlier at the latest; one of the environment that ends later at the earliest."""
    if event.window is None:
        return
    name, span, (low, high) = event.name, event.span, event.window

    def make(earliest: int, latest: int) -> Scenario:
        changed = replace(event, duration=earliest, latest=latest)
        return replace(scenario, events=tuple(changed if e == event else e for e in scenario.events))

    def say(earliest: int, latest: int) -> str:
        return f"{name} lasting {earliest} to {latest} instead of {low} to {high}"

    doers = [agent for agent in scenario.agents if any(ref.name == name for ref in agent.can_do)]
    if high - low > 1:
        yield WindowEnd(
            "latest", name, f"a {name} that ends earlier", high, range(high - 1, low, -1),
            lambda k: make(low, k), lambda k: say(low, k), span,
        )  # fmt: skip
    if high - low > 1 and doers and not any(agent.controllable for agent in doers):
        yield WindowEnd(
            "earliest", name, f"a {name} that ends later", low, range(low + 1, high),
            lambda k: make(k, high), lambda k: say(k, high), span,
        )  # fmt: skip


def travel_windows(scenario: Scenario, travel: Travel) -> Iterator[WindowEnd]:
    """A way that an agent takes in less time; one that is not controllable: in more."""
    low, high = travel.window
    name, (a, b), span = travel.agent.name, travel.way, travel.span

    def make(earliest: int, latest: int) -> Scenario:
        changed = replace(travel, earliest=earliest, latest=latest)
        return replace(scenario, travels=tuple(changed if t == travel else t for t in scenario.travels))

    def say(earliest: int, latest: int) -> str:
        return f"{name} going from {a} to {b} in {earliest} to {latest} instead of {low} to {high}"

    if any(agent.controllable for agent in scenario.agents if agent.name == name):
        if high > 1:
            yield WindowEnd(
                "travel", name, f"{name} going faster from {a} to {b}", high, range(high - 1, 0, -1),
                lambda k: make(min(low, k - 1), k), lambda k: say(min(low, k - 1), k), span,
            )  # fmt: skip
    else:
        yield WindowEnd(
            "travel", name, f"{name} going slower from {a} to {b}", low, range(low + 1, SLOWER * max(low, 1) + 1),
            lambda k: make(k, max(high, k + 1)), lambda k: say(k, max(high, k + 1)), span,
        )  # fmt: skip
