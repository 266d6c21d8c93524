"""Poses that are sound one by one, but cannot be meant together: warnings of `check`."""

from __future__ import annotations

from typing import List, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.diagnostics import Diagnostic, Severity

from .texts import STATEMENTS, findings, text

CODES = ("PML122", "PML123", "PML124", "PML125")
BOTH = STATEMENTS["agent bot"] + '\nagent "bot2" controllable mobile 1 location a can_do work'
REST = "0, 0, 0, 0, 1"


def told(source: str) -> List[Diagnostic]:
    """The warnings about poses; there is nothing else."""
    found = findings(source)
    assert all(finding.code in CODES and finding.severity is Severity.WARNING for finding in found), found
    return found


def placed(behind_a: str, behind_b: str) -> List[Tuple[str, str]]:
    """(code, message) for two places with poses and two robots."""
    source = text(poi_a=f'poi "a" {behind_a}', poi_b=f'poi "b" {behind_b}', agent_bot=BOTH)
    return [(finding.code, finding.message) for finding in told(source)]


def test_sound_poses_have_no_warnings() -> None:
    assert placed(f"//[0, 0, {REST}]", f"//[3, 0, {REST}]") == []
    assert placed(f"//[0, 0, {REST}] bot2 [0, 1, {REST}]", f"//[3, 0, {REST}] bot [3, 1, {REST}]") == []


def test_a_pose_for_an_agent_that_is_no_robot() -> None:
    (finding,) = told(text(poi_a=f'poi "a" //[0, 0, {REST}] man [0, 1, {REST}]', poi_b=f'poi "b" //[3, 0, {REST}]'))
    assert finding.code == "PML122" and finding.message.startswith("man is not a robot")
    assert finding.span is not None and (finding.span.line, finding.span.column) == (1, 33)


@pytest.mark.parametrize(
    ("behind_a", "behind_b", "message"),
    [
        (f"//[1, 2, {REST}]", f"//[1, 2, {REST}]", "b has the same pose as a"),
        (f"//[1, 2, {REST}]", f"//[1.05, 2, {REST}]", "b has the same pose as a"),
        (f"//[1, 2, {REST}] bot2 [1, 2.05, {REST}]", f"//[3, 0, {REST}]", "bot2 at a has the same pose as a"),
        (f"//[1, 2, {REST}]", f"//[3, 0, {REST}] bot2 [1, 2, {REST}]", "bot2 at b has the same pose as a"),
        (
            f"//[9, 9, {REST}] bot [1, 2, {REST}] bot2 [1, 2, {REST}]",
            f"//[3, 0, {REST}]",
            "bot2 at a has the same pose as bot at a",
        ),
    ],
)
def test_a_pose_that_is_used_twice(behind_a: str, behind_b: str, message: str) -> None:
    assert placed(behind_a, behind_b) == [("PML123", message)]


@pytest.mark.parametrize(
    ("behind_a", "behind_b"),
    [
        (f"//[1, 2, {REST}] bot [1, 2, {REST}] bot2 [1, 3, {REST}]", f"//[3, 0, {REST}]"),  # nobody is sent to a's own
        (f"//[1, 2, {REST}]", f"//[1, 2.2, {REST}]"),
        (f"//[1, 2, {REST}]", "//[1, 2, 5, 0, 0, 0, 1]"),  # another floor
        (f"//[0, 0, {REST}] bot [1, 1, {REST}]", f"//[3, 0, {REST}] bot [1, 1, {REST}]"),  # one robot, two places
    ],
)
def test_poses_that_are_no_conflict(behind_a: str, behind_b: str) -> None:
    assert "PML123" not in [code for code, _ in placed(behind_a, behind_b)]


def test_places_without_a_pose_beside_places_with_one() -> None:
    (finding,) = told(text(poi_a=f'poi "a" //[0, 0, {REST}]'))
    assert (finding.code, finding.message.split(",")[0]) == ("PML124", "b has no pose")
    assert finding.span is not None and finding.span.line == 2
    assert told(text(poi_a='poi "a" //[x, y, z, nu, ex, ey , ez],')) == []


def distances(*ways: Tuple[float, int]) -> List[str]:
    """The messages on ways that are so many metres long, each with its distance; the first is from a to b."""
    (metres, distance), *more = ways
    pois = [f'poi "p{k}" //[0, {9 * k}, {REST}]' for k in range(1, len(more) + 1)]
    pois += [f'poi "q{k}" //[{m!r}, {9 * k}, {REST}]' for k, (m, _) in enumerate(more, 1)]
    connections = [f"connect p{k} and q{k} distance {d}" for k, (_, d) in enumerate(more, 1)]
    source = text(
        poi_a=f'poi "a" //[0, 0, {REST}]',
        poi_b="\n".join([f'poi "b" //[{metres!r}, 0, {REST}]', *pois]),
        connect="\n".join([f"connect a and b distance {distance}", *connections]),
    )
    return [finding.message for finding in findings(source) if finding.code == "PML125"]


def test_distances_that_contradict_the_poses() -> None:
    first = "a and b are 3.0 m apart at distance 300, but p1 and q1 are 3.0 m apart at distance 30"
    assert distances((3.0, 300), (3.0, 30), (6.0, 60)) == [f"{first}: these are not of one unit"]
    (second,) = distances((3.0, 30), (3.0, 300))
    assert second.startswith("p1 and q1 are 3.0 m apart at distance 300, but a and b are 3.0 m")
    assert len(distances((3.0, 30), (30.0, 30), (6.0, 60), (40.0, 20), (5.0, 45))) == 2


@pytest.mark.parametrize(
    "ways",
    [
        [(3.0, 300)],
        [(3.0, 30), (3.0, 200), (4.0, 30)],  # a detour
        [(3.0, 300), (4.0, 400), (300.0, 30000)],
        [(0.05, 1), (30.0, 10)],  # two places at one point: that is another warning
    ],
)
def test_distances_that_may_be_meant(ways: List[Tuple[float, int]]) -> None:
    assert distances(*ways) == []


@given(st.lists(st.tuples(st.integers(1, 500), st.floats(1, 7)), min_size=1, max_size=6), st.floats(0.2, 50))
def test_no_unit_and_no_detour_up_to_seven_times_is_a_contradiction(
    ways: List[Tuple[int, float]], metres_per_unit: float
) -> None:
    assert distances(*((distance * metres_per_unit / detour + 1e-9, distance) for distance, detour in ways)) == []
