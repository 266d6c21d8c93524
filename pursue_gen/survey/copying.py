"""The copy of a scenario: distances, travel times, spots and ways of the survey written into its text."""

from __future__ import annotations

from dataclasses import astuple
from fractions import Fraction
from typing import FrozenSet, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.diagnostics import listed
from pursue_gen.language.document import Edit, edited
from pursue_gen.language.numbers import Number, exact, is_fine
from pursue_gen.language.rewriting import Movement, Rewriting
from pursue_gen.language.scenario import Connection, Pose, Scenario
from pursue_gen.language.statements.agent import SIZE
from pursue_gen.language.times import written_time
from pursue_gen.workspace.robot_size import Sizes, sizes_of

SURVEY = "survey"
"""The word that begins the remarks of this command."""


def rounded(metres: float, unit: float, scenario: Scenario) -> Number:
    """A length in units of distance (`unit`: metres), to a tenth; to a whole number where a tenth is too fine.

    Too fine is a distance that takes one of the agents, whose times are not rounded, a time of more than three
    decimals. It is never 0.
    """
    speeds = [agent.mobile for agent in scenario.agents if agent.mobile is not None and agent.speed is None]
    for step in (Fraction(1, 10), Fraction(1)):
        found = max(step, round(Fraction(metres / unit) / step) * step)
        if all(is_fine(found * Fraction(one)) for one in speeds):
            break
    return exact(found)


def with_ways(scenario: Scenario, ways: Sequence[Tuple[str, str, Number, str]]) -> str:
    """The text with further ways: from, to, distance, remark."""
    as_text = {distance: written_time(scenario.as_distance(distance)) for _, _, distance, _ in ways}
    lines = [f"connect {a} and {b} distance {as_text[distance]} // {remark}" for a, b, distance, remark in ways]
    return edited(scenario.text, Rewriting(scenario).statements(("CONNECT", "POI"), lines))


def with_sizes(scenario: Scenario, sizes: Sizes) -> str:
    """The text with the sizes of its robots, as far as it does not have them."""
    rewriting, known = Rewriting(scenario), sizes_of(scenario)
    edits: List[Edit] = []
    for agent in scenario.agents:
        size, said = (astuple(each.of([agent.name])) for each in (sizes, known))
        numbers = {word: exact(Fraction(f"{new:.3f}")) for word, new, old in zip(SIZE, size, said) if new != old}
        if agent.is_robot and numbers:
            edits += rewriting.size(agent, numbers, f"{SURVEY}: its {listed(list(numbers))} by --robot")
    return edited(scenario.text, edits)


def written(
    scenario: Scenario,
    distances: Mapping[Connection, Tuple[Number, str]],
    windows: Mapping[Movement, Tuple[int, int, str]],
    spots: Mapping[str, Sequence[Tuple[str, Optional[Pose]]]],
    maps: Mapping[str, str],
) -> str:
    """The text with distances of ways, windows of movements and spots, each with a remark (`survey: …`).

    Windows of movements that have a `travel` replace it. `maps`: place → its map's file, for the remarks of spots.
    """
    rewriting = Rewriting(scenario)
    edits: List[Edit] = []
    for way, (distance, remark) in distances.items():
        edits += rewriting.distance(way, distance, remark)
    edits += rewriting.windows(windows)
    for poi in scenario.pois:
        found = [(robot, pose) for robot, pose in spots.get(poi.name, ()) if pose is not None]
        if found:
            names = " and ".join(robot for robot, _ in found)
            edits += rewriting.spots(poi, found, f"{SURVEY}: {names} beside it on {maps[poi.name]}")
    return edited(scenario.text, edits)


def others_windows(scenario: Scenario) -> FrozenSet[Movement]:
    """The movements whose window was not written by a survey: it is a person's, or has been measured."""
    rewriting = Rewriting(scenario)
    others = [travel for travel in scenario.travels if rewriting.written_by(travel.span) != SURVEY]
    return frozenset((travel.agent.name, *travel.way) for travel in others)
