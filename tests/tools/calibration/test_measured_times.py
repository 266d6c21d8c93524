"""Times in recordings of missions and of drives, what cannot be measured, and the messages about it."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Dict, List, Tuple

import pytest
from rosbags.rosbag1 import Writer

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import load, parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.tools.calibration.recordings import samples_in
from pursue_gen.tools.calibration.samples import Samples, Way, Work, of_record
from pursue_gen.tools.replay.record import MissionRecord
from pursue_runtime.drives.report import Drive
from pursue_runtime.state import SystemState
from tests.tools.calibration.drive_bags import FLOOR, drives, write_drives
from tests.tools.replay.recordings import PLAY, SCENARIO, Mission, mission, write_bag, write_journal

EXPECTED = {"bot1 from c to b": 9.3, "bot2 from c to a": 9.8, "bot1_inb": 3.3, "bot2_ina": 6.4}
"""Of the mission that is played, in time units."""


def floor() -> Scenario:
    return parse(FLOOR, "floor.pur", "floor")


def seconds(samples: Samples) -> Dict[str, float]:
    return {str(sample.what): round(sample.seconds, 3) for sample in samples.measured}


def measured(made: Mission) -> Samples:
    return of_record(MissionRecord(tuple(made.states)), load(str(SCENARIO)), "mission.bag")


@pytest.mark.parametrize("unit", [1.0, 0.5])
def test_a_bag_and_a_journal_tell_the_same_times(tmp_path: Path, unit: float) -> None:
    scenario = load(str(SCENARIO))
    bag = write_bag(mission(unit=unit), tmp_path / "mission.bag")
    journal = write_journal(PLAY, tmp_path / "journal-1.jsonl", unit)
    for file in (bag, journal):
        found, findings = samples_in([file], scenario)
        assert seconds(found) == {what: round(time * unit, 3) for what, time in EXPECTED.items()}
        assert found.unit == unit and findings == ()


def test_a_state_that_is_missing_at_a_beginning_does_no_harm() -> None:
    made = mission()
    begins = next(state.seq for state in made.states if state.locations["bot1"] == "going_c_to_b")
    made.states = [state for state in made.states if state.seq != begins]
    assert seconds(measured(made)) == EXPECTED


def test_a_state_that_is_missing_at_an_end_leaves_that_time_out() -> None:
    made = mission()
    ends = next(state.seq for state in made.states if state.locations["bot1"] == "b")
    made.states = [state for state in made.states if state.seq != ends]
    found = measured(made)
    assert "bot1 from c to b" not in seconds(found)
    assert [(str(each.what), each.why) for each in found.unused] == [
        ("bot1 from c to b", "the recording lacks its end")
    ]


@pytest.mark.parametrize("flaw", ["lost", "held", "displaced"])
def test_a_robot_that_a_person_holds_or_that_is_lost_measures_nothing(flaw: str) -> None:
    made = mission()
    first = next(state.seq for state in made.states if state.locations["bot2"] == "going_c_to_a")
    made.change(first + 1, **{flaw: ("bot2",)})
    found = measured(made)
    assert "bot2 from c to a" not in seconds(found) and "bot1 from c to b" in seconds(found)
    assert [(str(each.what), each.why) for each in found.unused] == [("bot2 from c to a", flaw)]


def test_what_goes_on_when_the_recording_ends_has_no_time() -> None:
    made = mission()
    made.states = made.states[:6]  # bot2 is on its way
    found = measured(made)
    assert seconds(found) == {"bot1 from c to b": 9.3}
    assert [(str(each.what), each.why) for each in found.unused] == [
        ("bot2 from c to a", "it had not ended when the mission did")
    ]


def test_what_several_do_together_counts_once() -> None:
    text = """\
poi "dock"
event "lift" collaborative together location dock duration 4
agent "cart" controllable location dock can_do lift
agent "arm" controllable location dock reacts_to lift
reach_objective: do lift
"""
    at, work = "doing_lift_in_dock", {"Ccart": 0.0, "Carm": 0.0}

    def state(seq: int, stamp: float, where: str, clocks: Dict[str, float]) -> SystemState:
        return SystemState(seq, stamp, {"cart": where, "arm": where}, {}, clocks)

    idle = {"Ccart": 2.0, "Carm": 2.0}
    states = (state(1, 10.0, "dock", idle), state(2, 12.0, at, work), state(3, 16.5, "dock", work))
    found = of_record(MissionRecord(states), parse(text, "dock.pur", "dock"))
    assert [(sample.what, sample.seconds) for sample in found.measured] == [(Work("lift"), 4.5)]


def test_what_is_broken_off_is_no_measure_of_how_long_it_takes() -> None:
    at = "doing_fetch_in_shelf"

    def state(seq: int, stamp: float, event: str, where: str) -> SystemState:
        return SystemState(seq, stamp, {"bot": where}, {}, {"Cbot": 0.0}, event, "bot")

    states = (state(1, 10.0, "", "shelf"), state(2, 12.0, "fetch", at), state(3, 14.0, "fetchSTOP", "shelf"))
    found = of_record(MissionRecord(states), floor(), "mission.bag")
    assert found.measured == () and [each.why for each in found.unused] == ["it was broken off"]


def test_actions_without_a_mission_are_measured_like_drives(tmp_path: Path) -> None:
    done = Drive("bot", "shelf", "shelf", 100.0, 103.5, action="fetch")
    other = Drive("bot", "shelf", "shelf", 200.0, 201.0, action="dance")
    file = write_drives(tmp_path / "drives.bag", [done, done._replace(outcome="late"), other])
    found, _ = samples_in([file], floor())
    assert [(sample.what, sample.seconds) for sample in found.measured] == [(Work("fetch"), 3.5)]
    assert [(each.what, each.why) for each in found.unused] == [(Work("fetch"), "late")]
    assert found.strangers == ("dance",)


def test_drives_are_measured_and_failed_ones_are_listed(tmp_path: Path) -> None:
    failed = Drive("bot", "shelf", "desk", 200.0, 260.0, "failed", 3, "aborted")
    cut = Drive("bot", "shelf", "desk", 300.0, 301.0, "interrupted")
    file = write_drives(tmp_path / "drives.bag", [*drives("bot", ("desk", "shelf"), [4.5, 5.5]), failed, cut])
    found, findings = samples_in([file], floor())
    assert [(sample.what, round(sample.seconds, 6), sample.at) for sample in found.measured] == [
        (Way("bot", "desk", "shelf"), 4.5, 0.0), (Way("bot", "desk", "shelf"), 5.5, 5.5),
    ]  # fmt: skip
    assert [each.why for each in found.unused] == ["failed: aborted", "interrupted"]
    assert found.unit == 1.0 and findings == ()


def refused(files: List[Path], scenario: Scenario) -> Tuple[str, str]:
    with pytest.raises(PursueError) as caught:
        samples_in(files, scenario)
    assert caught.value.exit_status == 2
    (finding,) = caught.value.diagnostics
    assert finding.hint
    return finding.code, finding.message


def test_a_recording_of_another_scenario_is_refused(tmp_path: Path) -> None:
    bag = write_bag(mission(), tmp_path / "mission.bag")
    code, message = refused([bag], floor())
    assert code == "CAL001" and "bot1" in message and "floor.pur" in message


def test_a_recording_without_times_is_refused(tmp_path: Path) -> None:
    game = {"name": "floor", "scenario": FLOOR, "rules": {}}
    nothing = write_drives(tmp_path / "nothing.bag", [], game)
    assert refused([nothing], floor())[0] == "CAL002"
    failed = write_drives(tmp_path / "failed.bag", [Drive("bot", "desk", "shelf", 1.0, 9.0, "failed")])
    assert refused([failed], floor()) == (
        "CAL002", "no drive and no action was measured in failed.bag: 1 was begun, and none ended",
    )  # fmt: skip


def test_recordings_with_different_units_need_one_to_be_named(tmp_path: Path) -> None:
    files = [write_bag(mission(unit=unit), tmp_path / f"{unit}.bag") for unit in (1.0, 0.5)]
    code, message = refused(files, load(str(SCENARIO)))
    assert code == "CAL003" and "1 s in 1.0.bag, 0.5 s in 0.5.bag" in message
    assert samples_in(files, load(str(SCENARIO)), 0.5)[0].unit == 0.5


def test_a_file_that_is_no_recording_is_refused(tmp_path: Path) -> None:
    empty = tmp_path / "empty.bag"
    empty.write_bytes(b"")
    assert refused([empty], floor())[0] == "RPL002"
    assert refused([tmp_path / "missing.bag"], floor())[0] == "RPL001"


@pytest.mark.parametrize(("begin", "what"), [
    (b"#ROSRECORD V1.2\n", "a bag of ROS 1 before version 2.0"), (b"SQLite format 3\0....", "a bag of ROS 2 (sqlite3)"),
    (b"\x89MCAP0\r\n....", "a bag of ROS 2 (mcap)"),
])
def test_a_bag_of_another_kind_is_named_as_what_it_is(tmp_path: Path, begin: bytes, what: str) -> None:
    foreign = tmp_path / "foreign"
    foreign.write_bytes(begin)
    assert refused([foreign], floor()) == ("RPL003", f"{foreign} is {what}")
    folder = tmp_path / "rosbag2_2026"
    folder.mkdir()
    (folder / "metadata.yaml").write_text("rosbag2_bagfile_information: {version: 5}\n")
    assert refused([folder], floor()) == ("RPL003", f"{folder} is a bag of ROS 2, a folder")
    assert refused([tmp_path], floor())[0] == "RPL001", "a folder that is none"


def test_a_bag_of_something_else_is_named_by_what_it_has(tmp_path: Path) -> None:
    with Writer(tmp_path / "scans.bag") as writer:
        for topic in ("/bot1/scan", "/bot1/odom"):
            kind = writer.add_connection(topic, "std_msgs/msg/String", msgdef="string data", md5sum="0" * 32)
            writer.write(kind, 10**9, b"\0\0\0\0")
    code, message = refused([tmp_path / "scans.bag"], floor())
    holds = "holds no state of a mission on pursue/system_state and no drives on pursue/drives"
    assert code == "RPL004" and message.endswith(f"{holds}; it has /bot1/odom, /bot1/scan")


def test_a_damaged_bag_counts_as_far_as_it_can_be_read(tmp_path: Path) -> None:
    file = write_drives(tmp_path / "drives.bag", drives("bot", ("desk", "shelf"), [4.5] * 400))
    whole = file.read_bytes()
    file.write_bytes(whole[: len(whole) // 2])
    found, (finding,) = samples_in([file], floor())
    assert 0 < len(found.measured) < 400
    assert finding.code == "CAL011" and "not whole" in finding.message


def test_ways_that_the_scenario_has_no_more_are_passed_over_with_a_warning(tmp_path: Path) -> None:
    more = drives("bot", ("desk", "attic"), [9.0])
    file = write_drives(tmp_path / "drives.bag", [*drives("bot", ("desk", "shelf"), [4.5]), *more])
    found, (finding,) = samples_in([file], floor())
    assert seconds(found) == {"bot from desk to shelf": 4.5}
    assert finding.code == "CAL010" and "bot from desk to attic" in finding.message


def test_a_mission_recorded_with_an_older_text_counts_for_what_is_still_there() -> None:
    old = load(str(SCENARIO))
    fewer = dataclasses.replace(old, events=tuple(event for event in old.events if event.name != "bot2_ina"))
    found = of_record(MissionRecord(tuple(mission().states)), fewer, "mission.bag")
    assert set(seconds(found)) == set(EXPECTED) - {"bot2_ina"}
    assert found.strangers == ("bot2 doing bot2_ina at a",)
