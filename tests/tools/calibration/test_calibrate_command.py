"""`pursue-gen calibrate` as a person calls it: the table, the copy of the scenario, what changes."""

from __future__ import annotations

import json
import re
from fractions import Fraction
from pathlib import Path
from typing import Any, List

import pytest

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import load, parse
from pursue_gen.tools.calibration import proposal_report, recordings
from pursue_gen.tools.calibration.proposal import Options, Proposal, propose
from pursue_gen.tools.calibration.samples import Sample, Samples, Way, Work
from pursue_runtime.drives.report import Drive
from tests.cli.test_commands import Outcome, pursue
from tests.tools.calibration.drive_bags import FLOOR, drives, noisy, write_drives

OUT, BACK = Way("bot", "desk", "shelf"), Way("bot", "shelf", "desk")


def called(*words: Any) -> Outcome:
    done = pursue("calibrate", *words)
    assert "Traceback" not in done.err, done.err
    return done


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A scenario, and a bag with eighteen drives there and three back."""
    place = tmp_path_factory.mktemp("floor")
    (place / "floor.pur").write_text(FLOOR, encoding="utf-8")
    there, back = drives("bot", OUT_WAY, noisy(5.0, 18, 1)), drives("bot", BACK_WAY, noisy(5.5, 3, 2), 300.0)
    write_drives(place / "drives.bag", [*there, *back])
    return place


OUT_WAY, BACK_WAY = ("desk", "shelf"), ("shelf", "desk")


def proposal(samples: List[Sample], text: str = FLOOR, **options: Any) -> Proposal:
    scenario = parse(text, "floor.pur", "floor")
    return propose(scenario, Samples(tuple(samples), unit=1.0), Options(**options))


def test_the_proposal_is_written_into_a_copy_with_where_it_comes_from(folder: Path, tmp_path: Path) -> None:
    copy = tmp_path / "copy.pur"
    done = called(folder / "floor.pur", folder / "drives.bag", "-o", copy)
    assert done.status == 0, done.err
    text = copy.read_text(encoding="utf-8")
    assert "travel bot from desk to shelf takes 3.8 to 6.8 /* calibrate: 18 drives, 4.6 to 5.7 */ // paced\n" in text
    assert "travel bot from shelf to desk takes 2.8 to 13.1 // calibrate: 3 drives, 5.7 to 6.5, too few" in text
    assert text.startswith("// the floor of the tests\n")
    assert (folder / "floor.pur").read_text(encoding="utf-8") == FLOOR
    assert load(str(copy)).travels[0].window[1] == Fraction(34, 5)
    again = tmp_path / "again.pur"
    sized = text.replace(" location desk", " radius 0.2 inflation 0.55 location desk")
    copy.write_text(sized, encoding="utf-8")
    called(copy, folder / "drives.bag", "-o", again, "--no-solve")
    assert again.read_text(encoding="utf-8") == sized != text


def test_what_changes_is_said(folder: Path) -> None:
    done = called(folder / "floor.pur", folder / "drives.bag")
    assert "9 by 0.7" in done.out and "12 of 21 times left the present model" in done.out
    assert "as it is:          won, to the goal at most 11.3" in done.out
    assert "with the proposal: won, to the goal at most 13.1" in done.out
    assert "-o floor_calibrated.pur" in done.err


def test_a_proposal_with_which_the_objective_is_lost_says_so(folder: Path, tmp_path: Path) -> None:
    tight = tmp_path / "tight.pur"
    tight.write_text(FLOOR.replace("within 20", "within 12"), encoding="utf-8")
    done = called(tight, folder / "drives.bag", "-o", tmp_path / "copy.pur")
    assert done.status == 0
    assert "with the proposal: lost" in done.out and "cannot be met" in done.out


def test_a_longer_period_of_a_patrol_is_a_change_too(folder: Path, tmp_path: Path) -> None:
    patrol = tmp_path / "patrol.pur"
    patrol.write_text(FLOOR.replace("reach_objective: do fetch within 20", "objective: patrol desk, shelf by bot"))
    done = called(patrol, folder / "drives.bag", "-o", tmp_path / "copy.pur")
    lines = [line for line in done.out.splitlines() if "patrols every" in line]
    before, after = (int(line.rpartition(" ")[2]) for line in lines)
    assert before < after
    assert "patrol desk, shelf by bot\n" in (tmp_path / "copy.pur").read_text(encoding="utf-8")


def test_a_program_gets_the_same_as_numbers(folder: Path) -> None:
    data = json.loads(called(folder / "floor.pur", folder / "drives.bag", "--json", "--time-unit", 2).out)
    first, second = data["times"]
    assert (first["agent"], first["a"], first["b"], first["count"], second["count"]) == ("bot", "desk", "shelf", 18, 3)
    assert first["most"] == pytest.approx(max(noisy(5.0, 18, 1)) / 2, abs=1e-5) and data["unit"] == 2
    assert data["left"] == {"times": 21, "of": 21} and first["early"] == 18
    assert (data["before"]["verdict"], data["after"]["verdict"]) == ("won", "won")


def test_no_file_that_is_there_is_replaced_unless_that_is_wanted(folder: Path, tmp_path: Path) -> None:
    scenario = tmp_path / "floor.pur"
    scenario.write_text(FLOOR, encoding="utf-8")
    link = tmp_path / "link.pur"
    link.symlink_to(scenario)
    for target in (scenario, link):
        done = called(scenario, folder / "drives.bag", "-o", target, "--no-solve")
        assert done.status == 2 and "CLI003" in done.err
    assert called(scenario, folder / "drives.bag", "-o", link, "--no-solve", "--force").status == 2
    assert scenario.read_text(encoding="utf-8") == FLOOR
    assert called(scenario, folder / "drives.bag", "-o", scenario, "--no-solve", "--force").status == 0
    assert "calibrate: 18 drives" in scenario.read_text(encoding="utf-8")


def test_no_picture_that_is_there_is_replaced_unless_that_is_wanted(folder: Path, tmp_path: Path) -> None:
    words = [folder / "floor.pur", folder / "drives.bag", "--no-solve", "--picture"]
    there, link = tmp_path / "there.svg", tmp_path / "link.svg"
    there.write_text("a picture of mine", encoding="utf-8")
    link.symlink_to(there)
    for target in (there, link):
        done = called(*words, target)
        assert done.status == 2 and "CLI003" in done.err and str(target) in done.err
    assert there.read_text(encoding="utf-8") == "a picture of mine"
    assert called(*words, there, "--force").status == 0
    assert there.read_text(encoding="utf-8").startswith("<svg")


@pytest.mark.parametrize("words", [["--time-unit", "0"], ["--step", "0"], ["--step", "x"], ["--share", "1"]])
def test_options_that_cannot_be_meant_are_reported(folder: Path, words: List[str]) -> None:
    done = called(folder / "floor.pur", folder / "drives.bag", *words)
    assert done.status == 2 and "CLI004" in done.err


def test_windows_of_agents_that_are_not_controlled_are_only_widened() -> None:
    text = FLOOR.replace("reach_objective", 'agent "guest" mobile 2 location desk\nreach_objective', 1)
    walk = Way("guest", "desk", "shelf")
    (found,) = proposal([Sample(walk, 8.5) for _ in range(6)], text).findings
    assert found.widened and found.proposed == (8, 9)
    (found,) = proposal([Sample(walk, 8.0 + n) for n in range(6)], text).findings
    assert found.proposed[0] < 8 and found.proposed[1] > 13


def test_slack_belongs_to_the_present_model() -> None:
    times = [Sample(OUT, 4.0), Sample(OUT, 5.8)]
    assert proposal(times).left == (1, 2) and proposal(times).slack == {"bot": 1}
    assert proposal(times, slack={"bot": 1}).left == (0, 2) and proposal(times, slack={"bot": 1}).slack == {}


def test_outliers_count_unless_they_are_left_out() -> None:
    times = [Sample(OUT, 5.0 + 0.1 * (n % 4)) for n in range(12)] + [Sample(OUT, 30.0, "drives.bag", 77.0)]
    (found,) = proposal(times).findings
    assert found.far == (12,) and found.proposed[1] >= 30 and found.source.endswith("1 far out")
    (less,) = proposal(times, outliers=False).findings
    assert less.proposed[1] < 7 and less.spread.most == 30.0
    assert proposal([*times, Sample(BACK, 6.0)]).lost_after == 30


def test_what_is_not_known_is_said_first_and_then_nothing_is_claimed(folder: Path, tmp_path: Path) -> None:
    write_drives(tmp_path / "drives.bag", drives("bot", OUT_WAY, [4.5, 5.5, 5.0]))
    done = called(folder / "floor.pur", tmp_path / "drives.bag")
    lines = done.out.splitlines()
    assert lines[:2] == [
        "1 of 2 ways of robots not measured: their windows stay as they are.",
        "Nothing can be claimed: what was measured was measured less than 5 times, and its windows are guesses.",
    ]
    assert "With windows that are guesses (above) neither verdict says what these robots will do:" in lines
    assert "lost_after" not in done.out and "% of later times" not in done.out
    data = json.loads(called(folder / "floor.pur", tmp_path / "drives.bag", "--json", "--no-solve").out)
    assert data["lost_after"] is None and data["not_measured"] == {"ways": 1, "of": 2}


def test_where_all_was_measured_often_nothing_of_that_is_said() -> None:
    found = proposal([Sample(way, 5.0 + 0.1 * n) for way in (OUT, BACK) for n in range(6)])
    assert next(proposal_report.report(found)) == "1 time unit = 1 s; times in time units" and found.claims


def test_how_long_a_robot_tried_in_vain_says_nothing_of_how_long_to_wait(folder: Path, tmp_path: Path) -> None:
    failed = [Drive("bot", *way, 1000.0, 1280.0, "failed", 3, "it finds no way") for way in (OUT_WAY, BACK_WAY)]
    there, back = drives("bot", OUT_WAY, [5.0] * 6), drives("bot", BACK_WAY, [6.5] * 6, 300.0)
    write_drives(tmp_path / "drives.bag", [*there, *back, *failed])
    done = called(folder / "floor.pur", tmp_path / "drives.bag", "--no-solve")
    assert "lost_after:=7 waits for a late agent as long as the slowest took in all." in done.out
    assert "Not used: bot: shelf to desk, 1 time (failed: it finds no way)." in done.out


def test_what_robots_alone_cannot_do_is_for_recorded_missions() -> None:
    carry = """event "carry" collaborative together location desk duration 2
agent "mate" controllable mobile 1 location desk can_do carry reacts_to carry
"""
    text = FLOOR.replace("reach_objective", f"{carry}reach_objective", 1)
    text = text.replace("can_do fetch", "can_do fetch, carry")
    for whose, of_others in (("", ()), ("human ", (Work("carry"),))):
        found = proposal([Sample(OUT, 4.0)], text.replace('"mate" controllable', f'"mate" {whose}controllable'))
        assert found.missing_events == (Work("fetch"), Work("carry")) and found.of_others == of_others
        told = "Not robots alone do this, so only recorded missions measure it: carry."
        assert (told in list(proposal_report.report(found))) is bool(whose)


def test_durations_of_actions_are_proposed_too() -> None:
    found = proposal([Sample(Work("fetch"), 2.0 + 0.1 * n) for n in range(10)])
    text = found.checked().text
    assert 'event "fetch" location shelf duration ' in text and "// calibrate: 10 actions, 2.0 to 2.9\n" in text
    assert found.missing == (OUT, BACK) and found.missing_events == ()


def test_actions_that_were_not_measured_are_named() -> None:
    found = proposal([Sample(OUT, 4.0), Sample(BACK, 4.0)])
    assert found.missing == () and found.missing_events == (Work("fetch"),)
    assert any(line.startswith("Not measured, so durations stay: fetch. (") for line in proposal_report.report(found))
    assert proposal_report.as_json(found, ())["missing_events"] == ["fetch"]


def test_an_action_that_takes_hardly_any_time_keeps_a_duration() -> None:
    (found,) = proposal([Sample(Work("fetch"), 0.02)] * 6).findings
    assert 0 < found.proposed[0] < 0.02 < found.proposed[1]


def test_a_few_times_that_keep_to_a_narrow_window_widen_it() -> None:
    found = proposal([Sample(Work("fetch"), 3.9)])  # of a guess of 3, which is 3 to 4
    (fetch,) = found.findings
    assert (fetch.basis, fetch.present, fetch.early + fetch.late) == ("guessed", (3, 4), 0)
    assert fetch.proposed == (Fraction("1.9"), Fraction("7.8"))
    assert "duration 1.9 to 7.8 // calibrate: 1 action, 3.9, too few for more than a guess" in found.text()


def test_a_few_times_in_a_window_that_is_wide_change_nothing() -> None:
    wide = FLOOR.replace("takes 3 to 5", "takes 1 to 12")
    found = proposal([Sample(OUT, 4.0), Sample(OUT, 4.5), Sample(BACK, 9.0)], wide)
    assert [(each.what, each.basis) for each in found.findings] == [(OUT, "kept"), (BACK, "guessed")]
    assert found.findings[0].proposed == found.findings[0].present == (1, 12)
    assert "travel bot from desk to shelf takes 1 to 12 // paced\n" in found.text() and found.held == (0, 0)


def test_a_window_that_holds_the_few_times_is_never_narrowed() -> None:
    found = proposal([Sample(OUT, 4.0)], FLOOR.replace("takes 3 to 5", "takes 3 to 20"))
    assert found.findings[0].proposed == (Fraction("1.9"), 20)


def test_windows_are_rounded_to_the_step() -> None:
    (found,) = proposal([Sample(OUT, 5.0 + 0.1 * n) for n in range(10)], step=Fraction(1)).findings
    assert all(end == int(end) for end in found.proposed)


def test_windows_have_units_where_the_scenario_has_them(folder: Path, tmp_path: Path) -> None:
    timed, copy = tmp_path / "timed.pur", tmp_path / "copy.pur"
    timed.write_text("unit second\n" + FLOOR.replace("takes 4 to 6", "takes 4 s to 6 s"), encoding="utf-8")
    done = called(timed, folder / "drives.bag", "-o", copy, "--no-solve", "--time-unit", 1)
    assert done.status == 0, done.err
    assert re.search(r"desk to shelf takes 3\.8 (s )?to 6\.8( s)? /\*", copy.read_text(encoding="utf-8"))
    assert "travel bot from shelf to desk takes 2.8 s to 13.1 s // calibrate" in copy.read_text(encoding="utf-8")


def test_recordings_with_another_time_unit_than_the_scenario(tmp_path: Path) -> None:
    timed = parse("unit 10 s\n" + FLOOR, "floor.pur", "floor")
    assert recordings._unit([Path("a.bag")], [Samples((), unit=10.0)], timed) == 10
    assert recordings._unit([Path("a.bag")], [Samples((), unit=None)], timed) == 10
    with pytest.raises(PursueError, match="a.bag has time units of 1 s, and the scenario says unit 10 s"):
        recordings._unit([Path("a.bag")], [Samples((), unit=1.0)], timed)
