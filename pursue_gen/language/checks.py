"""What is wrong with a scenario that is well formed: every finding at once, in file order."""

from __future__ import annotations

from typing import Tuple

from pursue_gen.diagnostics import Diagnostic
from pursue_gen.language.parser import Reading, read
from pursue_gen.language.scenario import Scenario


def check(scenario: Scenario) -> Tuple[Diagnostic, ...]:
    """Every error and warning about a scenario, in file order; those about its text (poses, objectives) too."""
    return check_reading(read(scenario.text, scenario.file, scenario.name))


def check_reading(reading: Reading) -> Tuple[Diagnostic, ...]:
    """Every finding about a text that was read; only those about its syntax where there are errors in that."""
    return reading.diagnostics
