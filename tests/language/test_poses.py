"""Poses behind points of interest."""

from __future__ import annotations

import math
from typing import Dict, List, Optional, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.diagnostics import Severity
from pursue_gen.language import parse
from pursue_gen.language.scenario import Pose

from .texts import findings, syntax_errors, text

HERE, THERE = "[1, 2, 3, 0, 0, 0, 1]", "[1, 3, 3, 0, 0, 0, 1]"


def pose(comment: str) -> Optional[Pose]:
    return parse('poi "a" ' + comment, "test.pur").pois[0].pose


def test_the_thesis_pose_is_a_position_and_a_turn_about_z() -> None:
    found = pose("//[3.0, 1.54, 0.0, 0.0, 0.0, 0.67, 0.73],")
    assert found is not None
    assert (found.x, found.y, found.z, found.qx, found.qy) == (3.0, 1.54, 0.0, 0.0, 0.0)
    assert math.isclose(math.hypot(found.qz, found.qw), 1)
    assert math.isclose(found.qz / found.qw, 0.67 / 0.73)


@pytest.mark.parametrize(
    "comment",
    ["//[x, y, z, nu, ex, ey , ez],", "//[x,y,z,qx,qy,qz,qw]", "//[kitchen]", "// text", "/* [1, 2] */", "", "// [x"],
)
def test_placeholders_and_other_comments_are_no_pose(comment: str) -> None:
    assert pose(comment) is None
    assert syntax_errors('poi "a" ' + comment) == []


@pytest.mark.parametrize(
    "comment", ["//[1,2,3,0,0,0,1]", "// [1, 2, 3, 0, 0, 0, 1], the hall", "//[+1, 2., 3e0, 0, 0, -0, 1,]"]
)
def test_forms_of_numbers_and_what_may_follow(comment: str) -> None:
    assert pose(comment) == Pose(1, 2, 3, 0, 0, 0, 1)


def test_only_the_line_of_a_poi_holds_its_pose() -> None:
    scenario = parse('poi "a"\n//[1, 2, 3, 0, 0, 0, 1]\nevent "e" //[nonsense 1]\n', "test.pur")
    assert scenario.pois[0].pose is None


@pytest.mark.parametrize(
    ("comment", "code", "message"),
    [
        ("//[1, 2, 3]", "PML020", "seven numbers, here are 3"),
        ("//[1, 2, 3, 0, 0, 0, 1, 1]", "PML020", "seven numbers, here are 8"),
        ("//[1, 2, 3, four, 0, 0, 1]", "PML020", "its item 4 is 'four'"),
        ("//[1, 2, 3, nan, 0, 0, 1]", "PML020", "its item 4 is 'nan'"),
        ("//[1, , 3, 0, 0, 0, 1]", "PML020", "its item 2 is empty"),
        ("//[]", "PML020", "its item 1 is empty"),
        ("//[1, 2, 3, 0, 0, 0, 1", "PML020", "not closed"),
        ("//[1e9, 2, 3, 0, 0, 0, 1]", "PML020", "off the map: farther than 1,000,000 m"),
        ("//[1e999, 2, 3, 0, 0, 0, 1]", "PML020", "off the map: farther than 1,000,000 m"),
        ("//[1, 2, 3, 0, 0, 0, 0]", "PML021", "no direction"),
    ],
)
def test_broken_poses_are_errors(comment: str, code: str, message: str) -> None:
    (finding,) = syntax_errors('poi "a" ' + comment)
    assert finding.code == code and message in finding.message
    assert finding.span is not None and finding.span.column == 9
    assert "x, y, z, qx, qy, qz, qw" in finding.hint


@pytest.mark.parametrize(
    ("numbers", "codes"),
    [
        ("0, 0, 0, 0, 0, 0.67, 0.73", []),
        ("0, 0, 0, 0, 0, 0.5, 0.5", ["PML120"]),
        ("0, 0, 0, 1, 0, 0, 0", ["PML121"]),
        ("0, 0, 0, 0.7, 0.1, 0, 0", ["PML120", "PML121"]),
    ],
)
def test_doubtful_orientations_are_warnings_and_are_normalised(numbers: str, codes: list) -> None:  # type: ignore[type-arg]
    source = text(poi_a=f'poi "a" //[{numbers}]', poi_b='poi "b" //[3, 0, 0, 0, 0, 0, 1]')
    found = findings(source)
    assert [finding.code for finding in found] == codes
    assert all(finding.severity is Severity.WARNING for finding in found)
    place = parse(source, "test.pur").pois[0].pose
    assert place is not None
    assert math.isclose(place.qx**2 + place.qy**2 + place.qz**2 + place.qw**2, 1)


def test_a_quaternion_with_the_scalar_in_front_gets_the_hint() -> None:
    (finding,) = findings(text(poi_a='poi "a" //[0, 0, 0, 0.73, 0, 0, 0.67]', poi_b='poi "b" //[3, 0, 0, 0, 0, 0, 1]'))
    assert "w, x, y, z" in finding.hint


def spots(comment: str) -> Dict[str, Pose]:
    return {spot.robot.name: spot.pose for spot in parse('poi "a" ' + comment, "test.pur").pois[0].spots}


@pytest.mark.parametrize(
    "comment",
    [
        f"//{HERE} bot2 {THERE}",
        f"// {HERE},bot2{THERE},",
        f"//{HERE}, bot2 {THERE} beside the door, see [1] and [2, 3]",
        f"//[x, y, z, nu, ex, ey , ez], bot2 {THERE}",
        f"//{HERE} bot1 [x, y, z, nu, ex, ey, ez] bot2 {THERE} bot3 [y]",
    ],
)
def test_a_robot_may_have_a_pose_of_its_own_behind_that_of_the_place(comment: str) -> None:
    assert spots(comment) == {"bot2": Pose(1, 3, 3, 0, 0, 0, 1)}
    assert pose(comment) == (None if "nu, ex, ey , ez" in comment else Pose(1, 2, 3, 0, 0, 0, 1))


@pytest.mark.parametrize(
    "comment",
    [f"//{HERE}", f"//{HERE} the hall [west]", f"//{HERE} see [1]", "// see [1, 2]", "//bot2 [x, y, z]", "//plan [A2"],
)
def test_other_comments_behind_a_place_are_no_poses_of_robots(comment: str) -> None:
    assert spots(comment) == {}
    assert syntax_errors('poi "a" ' + comment) == []


@pytest.mark.parametrize(
    ("comment", "code", "column", "message"),
    [
        (f"//{HERE} bot2 [1, 3, 3]", "PML020", 33, "the pose of bot2 has seven numbers, here are 3"),
        (f"//{HERE} bot2 [1, 3", "PML020", 33, "the pose of bot2 is not closed"),
        (f"//{HERE} bot2 [1, 3, 3, 0, 0, 0, east]", "PML020", 33, "the pose of bot2 holds numbers only"),
        (f"//{HERE} bot2 [1, 3, 3, 0, 0, 0, 0]", "PML021", 33, "no direction"),
        (f"//{HERE} bot2 {THERE} bot2 {HERE}", "PML022", 60, "bot2 has two poses at this place"),
        (f"//{HERE} {THERE}", "PML020", 33, "a robot's name is expected before this list"),
        (f"//{HERE} bot2: {THERE}", "PML020", 39, "a robot's name is expected before this list"),
        (f"//bot2 {THERE}", "PML020", 11, "the pose of the place has to come before the one of bot2"),
        (f"// bot2 {THERE} {HERE}", "PML020", 12, "the pose of the place has to come before the one of bot2"),
    ],
)
def test_broken_poses_of_robots_are_errors_with_their_place(comment: str, code: str, column: int, message: str) -> None:
    (finding,) = syntax_errors('poi "a" ' + comment)
    assert finding.code == code and message in finding.message
    assert finding.span is not None and finding.span.column == column
    assert finding.hint


def test_a_robot_in_a_pose_has_to_be_declared() -> None:
    source = text(poi_a=f'poi "a" //{HERE} bto {THERE}', poi_b='poi "b" //[9, 0, 0, 0, 0, 0, 1]')
    (finding,) = findings(source)
    assert (finding.code, finding.message, finding.hint) == ("PML110", "there is no agent bto", "did you mean bot?")
    assert finding.span is not None and source.splitlines()[0][finding.span.column - 1 :].startswith("bto [")


@given(st.lists(st.tuples(st.floats(-1000, 1000), st.floats(-1000, 1000)), min_size=1, max_size=5))
def test_all_poses_of_robots_are_read_as_they_are(points: List[Tuple[float, float]]) -> None:
    lists = [f"[{x!r}, {y!r}, 0, 0, 0, 0, 1]" for x, y in points]
    comment = f"//{HERE}" + "".join(f" bot{number} {one}" for number, one in enumerate(lists))
    assert spots(comment) == {f"bot{number}": Pose(x, y, 0, 0, 0, 0, 1) for number, (x, y) in enumerate(points)}


@given(st.text(alphabet="[], ab12.\"-:", max_size=60))
def test_no_comment_behind_a_place_stops_the_reader(comment: str) -> None:
    for finding in syntax_errors(f'poi "a" //[{comment}'):
        assert finding.code in ("PML020", "PML021", "PML022")


@given(st.floats(-1000, 1000), st.floats(-1000, 1000), st.floats(-math.pi, math.pi))
def test_any_pose_on_a_floor_is_read_as_it_is(x: float, y: float, yaw: float) -> None:
    found = pose(f"//[{x!r}, {y!r}, 0, 0, 0, {math.sin(yaw / 2)!r}, {math.cos(yaw / 2)!r}]")
    assert found is not None
    assert (found.x, found.y) == (x, y)
    assert math.isclose(found.qz, math.sin(yaw / 2), abs_tol=1e-9)
