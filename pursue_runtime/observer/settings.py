"""The settings of the observer: parameters of its node, checked before anything is done."""

from __future__ import annotations

from typing import Any, Mapping, NamedTuple

from pursue_runtime.observer.shared_ends import ALL, WHOSE
from pursue_runtime.parameters import choice, command, flag, number, text

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


def read_settings(given: Mapping[str, Any]) -> Settings:
    """Return the settings that these parameters give. Raises ParameterError."""
    return Settings(
        time_unit=number(given, "time_unit", 1.0, above=True),
        tolerance=number(given, "tolerance", 0.1),
        on_uncovered=choice(given, "on_uncovered", "plan", ON_UNCOVERED),
        lost_after=number(given, "lost_after", 30.0),
        silence=number(given, "silence", 20.0, above=True),
        heartbeat=number(given, "heartbeat", 1.0, above=True),
        planner=command(given, "planner", "pursue-gen replan"),
        planning_limit=number(given, "planning_limit", 10.0, above=True),
        journal=text(given, "journal", "on"),
        launch=text(given, "launch"),
        linger=number(given, "linger", 1.0),
        received=flag(given, "received"),
        again=flag(given, "again"),
        shared_ends=choice(given, "shared_ends", ALL, WHOSE),
        plain_words=flag(given, "plain_words"),
    )
