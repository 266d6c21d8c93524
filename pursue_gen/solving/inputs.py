"""The files that a person names, read: scenarios with their findings, and games."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Optional, Sequence, Tuple

from pursue_gen.diagnostics import Diagnostic, PursueError, Severity, in_order, usage_error
from pursue_gen.files import LARGEST_TEXT, read_text
from pursue_gen.language.checks import check_reading
from pursue_gen.language.parser import Reading, read
from pursue_gen.language.parser import read_text as read_scenario
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.forbidden import check_forbidden
from pursue_gen.solving.periods import least_period, longest, with_period, without_period
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.vacuity import check_assumed_alone
from pursue_gen.synthesis.limits import Listener
from pursue_gen.tga import scenario_objective, translate, translation_notes
from pursue_gen.tga.network import Network, Objective


def findings_in(file: Path) -> Tuple[Diagnostic, ...]:
    """All errors and warnings of a scenario's file, in order."""
    try:
        reading = read(read_scenario(str(file)), str(file))
    except PursueError as problem:
        return problem.diagnostics
    return findings_of(reading)


def findings_of(reading: Reading) -> Tuple[Diagnostic, ...]:
    """All errors and warnings of a text that was read, in order."""
    findings = check_reading(reading)
    if reading.scenario is None or any(finding.severity is Severity.ERROR for finding in findings):
        return findings
    scenario = reading.scenario
    return in_order(
        (*findings, *translation_notes(scenario), *check_assumed_alone(scenario), *check_forbidden(scenario))
    )


def settled(scenario: Scenario, request: SolveRequest, progress: Optional[Listener] = None) -> Scenario:
    """The scenario with the least period that can be promised for patrols that name none, in the game of the request.

    Raises PursueError (exit status 2) for a request that makes no sense.
    """
    if not without_period(scenario):
        return scenario
    rules = request.rules(translate(with_period(scenario, longest(scenario))))
    return least_period(scenario, rules, replace(request.options, progress=progress))


def game_of(scenario: Scenario) -> Tuple[Network, Objective]:
    """The ideal game of a scenario."""
    return translate(scenario), scenario_objective(scenario)


def load_game(files: Sequence[Path]) -> Tuple[Network, Objective]:
    """The ideal game of UPPAAL's two files. Raises PursueError."""
    if len(files) != 2:
        message = "expected one scenario, or a network and its query"
        raise usage_error(message, "pursue-gen solve SCENARIO | TGA.xml TCTL.q")
    from pursue_gen.tga.uppaal_read import read_network, read_query

    model, query = files
    network = read_network(read_text(model, "a network of UPPAAL, such as TGA.xml", LARGEST_TEXT), str(model))
    return network, read_query(read_text(query, "a query of UPPAAL-TIGA, such as TCTL.q"), str(query))
