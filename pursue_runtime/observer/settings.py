"""The settings of the observer: parameters of its node and arguments of its process, checked at its start."""

from __future__ import annotations

from typing import Any, Mapping, NamedTuple

from pursue_runtime.arguments import CONFIG, Argument, command
from pursue_runtime.observer.reports import ALL, WHOSE
from pursue_runtime.parameters import choice, flag, number

ARGUMENTS = (
    CONFIG,
    Argument("planner", "COMMAND", "the command that computes a plan; off: no planning", "pursue-gen replan"),
    Argument("journal", "FILE", "on (default), off, or the path of the journal", "on"),
    Argument("launch", "NAME", "identifies the launch: only a mission of this launch is continued"),
)

ON_UNCOVERED = ("plan", "stop", "warn")
"""What may follow in a state that no strategy covers."""


class Settings(NamedTuple):
    """`time_unit`, `silence`, `heartbeat`, `planning_limit` and `linger` are seconds; `tolerance` and `lost_after` are
    time units."""

    time_unit: float
    tolerance: float
    on_uncovered: str
    lost_after: float
    silence: float
    heartbeat: float
    planner: str
    planning_limit: float
    journal: str
    launch: str
    linger: float
    received: bool
    again: bool
    shared_ends: str
    plain_words: bool


def read_settings(given: Mapping[str, Any], told: Mapping[str, str]) -> Settings:
    """Return the settings that these parameters and `told`, the values of ARGUMENTS, give. Raises ParameterError."""
    return Settings(
        time_unit=number(given, "time_unit", 1.0, above=True),
        tolerance=number(given, "tolerance", 0.1),
        on_uncovered=choice(given, "on_uncovered", "plan", ON_UNCOVERED),
        lost_after=number(given, "lost_after", 30.0),
        silence=number(given, "silence", 20.0, above=True),
        heartbeat=number(given, "heartbeat", 1.0, above=True),
        planner=command(told, "planner"),
        planning_limit=number(given, "planning_limit", 10.0, above=True),
        journal=told["journal"],
        launch=told["launch"],
        linger=number(given, "linger", 1.0),
        received=flag(given, "received"),
        again=flag(given, "again"),
        shared_ends=choice(given, "shared_ends", ALL, WHOSE),
        plain_words=flag(given, "plain_words"),
    )
